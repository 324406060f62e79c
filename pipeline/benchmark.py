"""Benchmark: time against error of Eq. (22) from tables and from root solves -> out/benchmark.csv,
its figure.

    python -m pipeline.benchmark [--config FILE] [-o FOLDER]

The paper's motions and random ones, in one compiled integrator: from
splines in grids of Q and M over V and delta, from the rows of the law, and from root solves at
every call; beside them ``vr.roll``.  The truth is out/direct.nc, root solves of the printed
equations in SciPy's integrators, and for random starts ``vr.ensemble`` at a tight tolerance.  Size
and error of every table stand beside.  Peers of other houses stand in pipeline/evidence/bench.
"""

import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import msgspec
import numba
import numpy as np
from numba import carray
from numba.core import types
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.contact_mechanics.coupled_tables import coupled_law
from viscoroll.core.plots import new_figure, save
from viscoroll.kernels.law.law_callables import RESULTS, LawType
from viscoroll.kernels.law.printed_law import (
    direct_contact_length,
    direct_delta_star,
    direct_moment,
    direct_stick,
    direct_traction,
)
from viscoroll.kernels.numerics.deferred_compilation import EntryPipeline
from viscoroll.kernels.numerics.intrinsics import function_address, record_at
from viscoroll.kernels.numerics.jit import kernel
from viscoroll.materials.checked_netcdf import stated_errors
from viscoroll.presets import read_roller

from . import stage
from .runtime import least_seconds
from .stage import Row
from .validate import loaded

# --- the integrator, RODAS3, on any law that compiled code may call; the law by root solves ---

#: Steps of a motion before it is given up: some hundred times what the paper's motions take at the
#: tightest tolerance.
MOST_STEPS = 100_000
#: Speeds below this part of the first count as this, in what the tolerance is of.
_FLOOR = 1e-10
#: Relative step of the differences that slopes of root solves are: it costs half of the digits.
_STEP = 1e-8
#: User data of the root solves: address of their function, and the scene.
_SCENE = np.dtype(
    [("function", np.int64), ("alpha", np.float64), ("kappa", np.float64), ("mu", np.float64)]
)


@numba.njit(error_model="numpy")
def _rates(f, gamma, j):
    """dV/dt and d(slip)/dt of Eq. (22) as one complex number, of a law's
    :class:`LoadsAndSlopes`.
    """
    return gamma * complex(f.Q - f.M_half_space, f.M_half_space - f.Q - (f.Q + f.M_cylinder) / j)


@numba.njit(error_model="numpy")
def _solve(k, matrix):
    """Solution of a system of two equations, (p, q; r, s), whose right side and unknowns are
    complex numbers.
    """
    p, q, r, s = matrix
    return complex(s * k.real - q * k.imag, p * k.imag - r * k.real) / (p * s - q * r)


@numba.njit(error_model="numpy")
def motions(law, gamma, j, mu_over_kappa, V0, omega0, t, rtol, out):
    """Integrate Eq. (22) from each start, and put V and omega at the times ``t`` into ``out``; NaN
    where it gives up.

    law : of ``vr.law(...).jitted``, or a :class:`RootSolves`.
    gamma, j, mu_over_kappa : of the scene.
    V0, omega0 : starts.
    out : (2, starts, times).
    """
    for m in range(V0.size):
        y = complex(V0[m], omega0[m] - V0[m])
        now = 0.0
        h = 1e-6 * t[-1]
        steps = 0
        floor = _FLOOR * (abs(y.real) + abs(y.imag))
        for n in range(t.size):
            while now < t[n] and steps < MOST_STEPS:
                steps += 1
                step = min(h, t[n] - now)
                f = law(y.real, y.real + y.imag)
                over_V = f.dQ_dV + f.dQ_domega
                over_slip = f.dQ_domega
                a = over_V - f.dM_half_space_dV
                b = over_V + f.dM_cylinder_dV
                matrix = (
                    2 / step - gamma * a,
                    -gamma * over_slip,
                    gamma * (a + b / j),
                    2 / step + gamma * (1 + 1 / j) * over_slip,
                )
                rates = _rates(f, gamma, j)
                k1 = _solve(rates, matrix)
                k2 = _solve(rates + 4 * k1 / step, matrix)
                z = y + 2 * k1
                rates = _rates(law(z.real, z.real + z.imag), gamma, j)
                k3 = _solve(rates + (k1 - k2) / step, matrix)
                z += k3
                rates = _rates(law(z.real, z.real + z.imag), gamma, j)
                k4 = _solve(rates + (k1 - k2 - 8 / 3 * k3) / step, matrix)
                z += k4
                size = max(abs(y.real), abs(z.real), floor)
                band = max(abs(y.imag), abs(z.imag), mu_over_kappa * size)
                error = max(abs(k4.real) / size, abs(k4.imag) / band) / rtol
                if error <= 1:
                    y = z
                    now = t[n] if step == t[n] - now else now + step
                grown = (
                    step * min(max(0.9 * error ** (-1 / 3), 0.2), 5.0) if error >= 0 else 0.2 * step
                )
                h = max(h, grown) if error <= 1 and step < h else grown
            done = now >= t[n]
            out[0, m, n], out[1, m, n] = (y.real, y.real + y.imag) if done else (np.nan, np.nan)


@kernel
def _loads(V, omega, scene):
    """(Q, M) by two root solves of the printed equations."""
    alpha = scene.alpha
    kappa = scene.kappa
    mu = scene.mu
    speed = abs(V)
    delta = abs((omega - V) / V)
    lam, zeta, epsilon, _ = direct_contact_length(kappa * speed, alpha)
    Q = mu
    if delta < direct_delta_star(kappa, mu, lam, epsilon):
        beta, _ = direct_stick(delta, kappa, mu, lam, epsilon, zeta, alpha)
        Q = direct_traction(beta, delta, kappa, mu, lam, epsilon, zeta)
    return np.copysign(Q, omega - V), np.copysign(
        direct_moment(kappa, lam, epsilon, zeta, alpha), V
    )


# as a kernel that Python calls, for kernels below it are compiled as parts of it; but not kept on
# disk
@numba.njit(pipeline_class=EntryPipeline, error_model="numpy")
def _root_solves(V, omega, to, scenes):
    out = carray(to, RESULTS)
    scene = record_at(scenes)
    h = _STEP * abs(V)
    Q, M = _loads(V, omega, scene)
    Q_V, M_V = _loads(V + h, omega, scene)
    Q_omega, _ = _loads(V, omega + h, scene)
    out[0] = Q
    out[1] = M
    out[2] = 0.5 * M
    out[3] = 0.5 * M
    out[4] = (Q_V - Q) / h
    out[5] = (Q_omega - Q) / h
    out[6] = out[7] = 0.5 * (M_V - M) / h
    out[8] = out[9] = 0.0  # M of half-spaces depends on V alone
    return 0


class RootSolves:
    """The law of a scene by root solves at every call, slopes by differences, to stand for
    ``vr.law(scene).jitted``.
    """

    _numba_type_ = LawType()

    def __init__(self, scene: vr.Scene) -> None:
        kinds = types.int32, types.float64, types.float64, types.CPointer(types.float64)
        address = function_address(_root_solves, _SCENE, *kinds)
        self._scene = np.array([(address, scene.alpha, scene.kappa, scene.mu)], _SCENE)
        self.address = int(self._scene.ctypes.data)


# --- what is compared ---

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
    yield Law("numerical roots", RootSolves(scene), settings.root_solves)


def ways(
    scene: vr.Scene, settings: Benchmark, V0: NDArray, omega0: NDArray, t: NDArray
) -> Iterator[tuple[Law, float, Callable[[], NDArray]]]:
    """(Law, tolerance, what gives V and omega of all motions, (2, starts, times))."""

    def integrated(law, rtol):
        out = np.empty((2, V0.size, t.size))
        motions(law.call, scene.gamma, scene.j, scene.mu / scene.kappa, V0, omega0, t, rtol, out)
        return out

    def rolled(rtol):
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


def coupled_rows(settings: Coupled, seed: int) -> Iterator[Row]:
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


def draw(rows: list[Row], path: Path) -> None:
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


def work(settings, out):
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
    rows = []
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
