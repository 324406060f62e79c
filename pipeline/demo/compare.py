"""Stage 5: motions from the file of the law, by ``roll`` and from a grid, against root solves -> out/compare.csv.

    python -m pipeline.demo.compare [--config FILE] [-o FOLDER]

Stages 3 and 4 left what is compared.  The grid of Q and M over (V, delta), as look-up blocks have it, is built here and
read by splines in SciPy's Radau, which takes the law as well, for a fair comparison.  Exit code 1 where the file's
motions are further from those of root solves than allowed.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import viscoroll as vr
from viscoroll.errors import FileProblem

from .. import stage
from .runtime import Way, motions

Rates = Callable[[float, NDArray], Any]


class Compare(msgspec.Struct, forbid_unknown_fields=True):
    """[compare]: ends and nodes of the grid, the tolerance of its integrator and of ``roll``, the error allowed."""

    V: tuple[float, float, int]
    delta: tuple[float, int]
    rtol: float
    allowed: float


def by_law(scene: vr.Scene) -> tuple[Rates, Rates]:
    """Rates of (V, omega) and their Jacobian by the law of a scene."""
    law, g, j = vr.law(scene), scene.gamma, scene.j

    def rates(_: float, y: NDArray) -> Any:
        f = law(*y)
        return g * (f.Q - f.M_half_space), g / j * (-f.Q - f.M_cylinder)

    def jacobian(_: float, y: NDArray) -> Any:
        f = law(*y, slopes=True)
        return [
            [g * (f.dQ_dV - f.dM_half_space_dV), g * f.dQ_domega],
            [g / j * (-f.dQ_dV - f.dM_cylinder_dV), -g / j * f.dQ_domega],
        ]

    return rates, jacobian


def by_radau(rates: Rates, jacobian: Rates | None, t: NDArray, rtol: float) -> Way:
    """SciPy's Radau; NaN where it gives up."""

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        found = solve_ivp(rates, (0.0, t[-1]), (V0, omega0), "Radau", t, jac=jacobian, rtol=rtol, atol=1e-3 * rtol)
        return (found.y[0], found.y[1]) if found.success else (np.full(t.size, np.nan), np.full(t.size, np.nan))

    return way


def by_grid(scene: vr.Scene, V: NDArray, delta: NDArray) -> Rates:
    """Rates by splines in a grid of Q and M; at the edges its last values are held."""
    look_up, g, j = vr.tables.Interpolant(vr.tables.build(scene, V, delta)), scene.gamma, scene.j

    def rates(_: float, y: NDArray) -> Any:
        speed, turn = np.clip(abs(y[0]), V[0], V[-1]), np.sign(y[0])
        creep = np.clip((y[1] - y[0]) / y[0], delta[0], delta[-1])
        f = look_up(("Q", "M"), V=speed, delta=creep)
        Q, half = turn * f.Q, 0.5 * turn * f.M
        return g * (Q - half), g / j * (-Q - half)

    return rates


def loaded(path: Path) -> xr.Dataset:
    """What stage 3 or 4 left; raises FileProblem."""
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise FileProblem(path, f"cannot be read ({error}); run pipeline.demo.{path.stem} first") from error


def errors(found: xr.Dataset, truth: xr.Dataset) -> dict[str, float]:
    """Largest error of V and omega over the first speed, by start."""
    off = np.maximum(abs(found.V - truth.V), abs(found.omega - truth.omega)).max("t", skipna=False)
    return dict(zip(map(str, truth.ic.values), (off / abs(truth.V[:, 0])).values.tolist(), strict=True))


def work(settings: Compare, out: Path) -> stage.Outcome:
    of_file, truth = (loaded(out / f"{name}.nc") for name in ("runtime", "direct"))
    if not np.array_equal(of_file.t, truth.t):
        raise FileProblem(out / "direct.nc", "has other times than runtime.nc; run pipeline.demo.direct again")
    scene, t, rtol = vr.PAPER_SECTION_5, truth.t.values, settings.rtol
    V, delta = vr.tables.spread(*settings.V, "log"), np.linspace(-settings.delta[0], *settings.delta)

    def roll(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        found = vr.roll(scene, V0, omega0, t, rtol)
        return found.V, found.omega

    ways = (
        truth, of_file, motions(roll, t, "roll"),
        motions(by_radau(*by_law(scene), t, rtol), t, "vr.law, by SciPy's Radau"),
        motions(by_radau(by_grid(scene, V, delta), None, t, rtol), t, f"splines in {V.size} by {delta.size}, likewise"),
    )  # fmt: skip
    rows = [
        {"law by": way.law, "milliseconds a motion": 1e3 * float(way.seconds.mean())} | errors(way, truth)
        for way in ways
    ]
    stage.write_rows(out / "compare.csv", rows)
    worst = {row["law by"]: max(row[start] for start in vr.PAPER_STARTS) for row in rows[1:]}
    headline = {f"{name}: largest error of V and omega over the first speed": error for name, error in worst.items()}
    return stage.Outcome([out / "compare.csv"], headline, not worst[of_file.law] <= settings.allowed)


if __name__ == "__main__":
    sys.exit(stage.run("compare", Compare, work, __doc__))
