"""Benchmark: time against error of Eq. (22), by every way from the law to a motion -> out/benchmark.csv, its figure.

    python -m pipeline.benchmark [--config FILE] [-o FOLDER]

``vr.roll``; ``vr.law`` in SciPy's Radau; and splines in a grid of Q and M over (V, delta), as look-up blocks have it,
likewise.  The truth is out/direct.nc, root
solves of the printed equations.  Peers of other houses stand in pipeline/evidence/bench.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import viscoroll as vr
from viscoroll.core.plots.style import new_figure, save

from . import stage
from .runtime import Way, by_roll, motions
from .validate import errors, loaded

Rates = Callable[[float, NDArray], Any]


class Benchmark(msgspec.Struct, forbid_unknown_fields=True):
    """[benchmark]: the tolerances, those that splines are tried at; ends and nodes of their grid."""

    rtol: list[float]
    splines: list[float]
    V: tuple[float, float, int]
    delta: tuple[float, int]


def by_law(scene: vr.Scene) -> Rates:
    """Rates of (V, omega) by the law of a scene."""
    law, g, j = vr.law(scene), scene.gamma, scene.j

    def rates(_: float, y: NDArray) -> Any:
        f = law(*y)
        return g * (f.Q - f.M_half_space), g / j * (-f.Q - f.M_cylinder)

    return rates


def by_radau(rates: Rates, t: NDArray, rtol: float) -> Way:
    """SciPy's Radau; NaN where it gives up.

    V falls by eight decades: its absolute tolerance lies below its end, else its sign, and M with it, flips for ever.
    """

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        found = solve_ivp(rates, (0.0, t[-1]), (V0, omega0), "Radau", t, rtol=rtol, atol=1e-6 * rtol)
        return (found.y[0], found.y[1]) if found.success else (np.full(t.size, np.nan), np.full(t.size, np.nan))

    return way


def by_grid(scene: vr.Scene, V: NDArray, delta: NDArray) -> Rates:
    """Rates by splines in a grid of Q and M; at the edges its last values are held."""
    look_up, g, j = vr.tables.Interpolant(vr.tables.build(scene, V, delta=delta)), scene.gamma, scene.j

    def rates(_: float, y: NDArray) -> Any:
        speed, turn = np.clip(abs(y[0]), V[0], V[-1]), np.sign(y[0])
        creep = np.clip((y[1] - y[0]) / y[0], delta[0], delta[-1])
        f = look_up(("Q", "M"), V=speed, delta=creep)
        Q, half = turn * f.Q, 0.5 * turn * f.M
        return g * (Q - half), g / j * (-Q - half)

    return rates


def ways(settings: Benchmark, t: NDArray) -> Iterator[tuple[str, float, Way]]:
    """(By what, tolerance, way) of all."""
    scene = vr.presets.PAPER_SECTION_5
    V, delta = vr.tables.spread(*settings.V, "log"), np.linspace(-settings.delta[0], *settings.delta)
    law, grid = by_law(scene), by_grid(scene, V, delta)
    for rtol in settings.rtol:
        yield "roll", rtol, by_roll(scene, t, rtol)
        yield "vr.law, SciPy's Radau", rtol, by_radau(law, t, rtol)
    for rtol in settings.splines:
        yield f"splines in {V.size} by {delta.size}, SciPy's Radau", rtol, by_radau(grid, t, rtol)


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Time against error."""
    figure, axes = new_figure("Time against error of the paper's motions")
    for marker, name in zip("os^", dict.fromkeys(row["law by"] for row in rows), strict=True):
        own = [row for row in rows if row["law by"] == name]
        axes.loglog([row["error"] for row in own], [row["ms a motion"] for row in own], f"-{marker}", label=name)
    axes.set(xlabel="largest error of V and ω over the first speed", ylabel="time of a motion, ms")
    figure.legend(loc="outside upper center", ncols=2)
    save(figure, path)


def work(settings: Benchmark, out: Path) -> stage.Outcome:
    truth = loaded(out / "direct.nc")
    rows: list[dict[str, Any]] = []
    for name, rtol, way in ways(settings, truth.t.values):
        found = motions(way, truth.t.values, name)
        error = max(errors(found, truth).values())
        rows.append({"law by": name, "rtol": rtol, "ms a motion": 1e3 * float(found.seconds.mean()), "error": error})
    stage.write_rows(out / "benchmark.csv", rows)
    picture = stage.make_folder(out / "figures") / "benchmark.png"
    draw(rows, picture)
    said = "{law by}, rtol {rtol:g}", "{ms a motion:.3g} ms, error {error:.2g}"
    headline = {said[0].format_map(row): said[1].format_map(row) for row in rows}
    return stage.Outcome([out / "benchmark.csv", picture], headline)


if __name__ == "__main__":
    sys.exit(stage.run("benchmark", Benchmark, work, __doc__))
