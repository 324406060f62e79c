"""Benchmark: time against error of Eq. (22) from tables and from root solves -> out/benchmark.csv,
its figure.

    python -m pipeline.benchmark [--config FILE] [-o FOLDER]

The paper's motions and random ones, in one compiled integrator (:mod:`benchmark_integrator`): from
splines in grids of Q and M over V and delta, from the rows of the law, and from root solves at
every call; beside them ``vr.roll``.  The truth is out/direct.nc, root solves of the printed
equations in SciPy's integrators, and for random starts ``vr.ensemble`` at a tight tolerance.  Size
and error of every table stand beside.  Peers of other houses stand in pipeline/evidence/bench.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.contact_mechanics.coupled_tables import coupled_law
from viscoroll.core.plots import new_figure, save
from viscoroll.materials.checked_netcdf import stated_errors
from viscoroll.roller_toml import read_roller

from . import benchmark_integrator, stage
from .runtime import least_seconds
from .validate import loaded

#: Tolerance of the truth of random starts, far below what is compared.
TRUTH_RTOL = 1e-11
#: Every so many of the times of out/direct.nc are compared, the last among them: the integrator
#: stops at each.
TIMES = 20


class Coupled(msgspec.Struct, forbid_unknown_fields=True):
    """[benchmark.coupled]: the file of a roller, numbers of nodes of its tables of the coupled
    solution, and how many states are timed.
    """

    roller: str
    nodes: list[tuple[int, int]]
    states: int


class Benchmark(msgspec.Struct, forbid_unknown_fields=True):
    """[benchmark]: the file of rows; sizes of the grids, of n by n nodes, and ends of their V;
    tolerances of all, and of root solves; random starts, even in [-speed, speed], and their seed;
    tables of the coupled solution.
    """

    law: str
    sizes: list[int]
    V: tuple[float, float]
    rtol: list[float]
    root_solves: list[float]
    motions: int
    speed: float
    seed: int
    coupled: Coupled | None = None


class Law(NamedTuple):
    """A law in compiled code: its name, what is called, the tolerances, size of its file in kB and
    error of Q there.
    """

    name: str
    call: Any
    rtol: list[float]
    size: float = np.nan
    error: float = np.nan


def laws(scene: vr.Scene, settings: Benchmark) -> Iterator[Law]:
    """The laws that are compared."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "grid.nc"
        for n in settings.sizes:
            V = vr.tables.spread(*settings.V, n, "log")
            grid = vr.tables.build(scene, V, delta=vr.tables.creep_nodes(scene, V, n))
            vr.tables.save(grid, path)
            splines = vr.law(vr.load_law(path)).jitted
            yield Law(
                f"grid, {n} by {n}",
                splines,
                settings.rtol,
                path.stat().st_size / 1e3,
                grid.Q.spline_error,
            )
    path = stage.ROOT / settings.law
    rows = vr.law(scene.replace(material=vr.load_law(path))).jitted
    worst = max(stated_errors(vr.tables.load(path)).values())
    yield Law("law file", rows, settings.rtol, path.stat().st_size / 1e3, worst)
    yield Law("numerical roots", benchmark_integrator.RootSolves(scene), settings.root_solves)


def ways(
    scene: vr.Scene, settings: Benchmark, V0: NDArray, omega0: NDArray, t: NDArray
) -> Iterator[tuple[Law, float, Callable[[], NDArray]]]:
    """(Law, tolerance, what gives V and omega of all motions, (2, starts, times))."""

    def integrated(law: Law, rtol: float) -> NDArray:
        out = np.empty((2, V0.size, t.size))
        benchmark_integrator.motions(
            law.call, scene.gamma, scene.j, scene.mu / scene.kappa, V0, omega0, t, rtol, out
        )
        return out

    def rolled(rtol: float) -> NDArray:
        found = [
            vr.roll(scene, *start, t, rtol=rtol)
            for start in zip(V0.tolist(), omega0.tolist(), strict=True)
        ]
        return np.array([[one.V for one in found], [one.omega for one in found]])

    for law in laws(scene, settings):
        for rtol in law.rtol:
            yield law, rtol, partial(integrated, law, rtol)
    for rtol in settings.rtol:
        yield Law("vr.roll", None, settings.rtol), rtol, partial(rolled, rtol)


def coupled_rows(settings: Coupled, seed: int) -> Iterator[dict[str, Any]]:
    """Tables of the coupled solution: time of making one and of Q and M of a state, and errors."""
    scene = read_roller(stage.ROOT / settings.roller).scene()
    random = np.random.default_rng(seed)
    for nodes in settings.nodes:
        law, seconds = least_seconds(partial(coupled_law, scene, nodes=nodes), True)
        u = np.exp(random.uniform(*np.log(law.coupled.u[[0, -1]]), settings.states))
        creep = random.uniform(*law.coupled.edges[1, 1:3], settings.states)
        table = vr.Scene(material=law, kappa=scene.kappa, mu=scene.mu)
        V = u / scene.kappa
        delta = 0.5 * creep / scene.kappa
        ask = partial(vr.contact, table, V, delta=delta, fields=("Q", "M"))
        _, time = least_seconds(ask, False)
        yield {
            "nodes": "{} by {}".format(*nodes),
            "s to make": seconds,
            "ns a state": 1e9 * time / settings.states,
        } | {name: law.coupled.errors[name] for name in ("Q_over_mu", "M_half_space", "epsilon")}


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Time against error of motions, and size against error of the tables."""
    figure, (left, right) = new_figure(
        "Time and error of motions; size and error of the tables", 1, 2, 4.0
    )
    names = dict.fromkeys(row["law by"] for row in rows)
    for marker, name in zip("osd^vP*X", names, strict=False):
        own = [row for row in rows if row["law by"] == name]
        left.loglog(
            [row["error, random"] for row in own],
            [row["ms a motion"] for row in own],
            f"-{marker}",
            label=name,
        )
        right.loglog(own[0]["kB"], own[0]["error of Q"], marker)
    left.set(xlabel="largest error of V and ω / initial speed", ylabel="time of a motion, ms")
    right.set(xlabel="size of the file, kB", ylabel="largest error of Q / load")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    save(figure, path)


def work(settings: Benchmark, out: Path) -> stage.Outcome:
    scene = vr.presets.PAPER_SECTION_5
    direct = loaded(out / "direct.nc")
    direct = direct.isel(t=np.arange(direct.t.size - 1, 0, -TIMES)[::-1])
    starts = np.random.default_rng(settings.seed).uniform(
        -settings.speed, settings.speed, (2, settings.motions)
    )
    exact = vr.ensemble(scene, *starts, direct.t.values, rtol=TRUTH_RTOL, method="integrate")
    truth = np.concatenate([[direct.V, direct.omega], [exact.V, exact.omega]], axis=1)
    V0, omega0 = np.concatenate([np.transpose([*vr.presets.PAPER_STARTS.values()]), starts], axis=1)
    first = np.maximum(abs(V0), abs(omega0))
    paper = len(vr.presets.PAPER_STARTS)
    rows: list[dict[str, Any]] = []
    for law, rtol, way in ways(scene, settings, V0, omega0, direct.t.values):
        found, seconds = least_seconds(way, rtol != law.rtol[0])
        errors = np.abs(found - truth).max(axis=(0, 2)) / first
        rows.append(
            {
                "law by": law.name,
                "rtol": rtol,
                "ms a motion": 1e3 * seconds / V0.size,
                "error, paper": errors[:paper].max(),
                "error, random": errors[paper:].max(),
                "kB": law.size,
                "error of Q": law.error,
            }
        )
    stage.write_rows(out / "benchmark.csv", rows)
    picture = stage.make_folder(out / "figures") / "benchmark.png"
    draw(rows, picture)
    said = "{law by}, rtol {rtol:g}", "{ms a motion:.3g} ms, error {error, random:.2g}"
    headline = {said[0].format_map(row): said[1].format_map(row) for row in rows}
    files = [out / "benchmark.csv", picture]
    if settings.coupled is not None:
        tables = list(coupled_rows(settings.coupled, settings.seed))
        files.append(out / "benchmark_coupled.csv")
        stage.write_rows(files[-1], tables)
        text = "{s to make:.3g} s, {ns a state:.3g} ns a state, error of Q/mu {Q_over_mu:.2g}"
        headline |= {f"coupled table, {row['nodes']}": text.format_map(row) for row in tables}
    return stage.Outcome(files, headline)


if __name__ == "__main__":
    sys.exit(stage.run("benchmark", Benchmark, work, __doc__))
