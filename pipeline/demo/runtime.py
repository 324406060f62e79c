"""Stage 3: Eq. (22) from the file of the law, from direct root solves, and from a grid by splines -> out/runtime.csv.

    python -m pipeline.demo.runtime [--config FILE] [-o FOLDER]

What `make tables` wrote offline is read here: the same motions by SciPy's Radau on the law of the file and on a grid,
with root solves of the printed equations for the truth.  Exit code 1 where the file's are further from it than allowed.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import viscoroll as vr
from viscoroll.validation.direct_motion import roll_direct

from .. import stage

Rates = Callable[[float, NDArray], Any]


class Runtime(msgspec.Struct, forbid_unknown_fields=True):
    """[runtime]: a law of the paper's material, ``times`` even times up to ``end``, the grid, the error allowed."""

    law: str
    end: float
    times: int
    rtol: float
    V: tuple[float, float, int]
    delta: tuple[float, int]
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


def work(settings: Runtime, out: Path) -> stage.Outcome:
    paper = vr.PAPER_SECTION_5
    scene = paper.replace(material=vr.load_law(stage.ROOT / settings.law))
    t = np.linspace(0.0, settings.end, settings.times)
    V = vr.tables.spread(*settings.V, "log")
    delta = np.linspace(-settings.delta[0], settings.delta[0], settings.delta[1])
    rates, jacobian = by_law(scene)
    ways: dict[str, Any] = {
        "the file of the law": {"fun": rates, "jac": jacobian},
        "a grid of Q and M, splines": {"fun": by_grid(paper, V, delta)},
    }
    rows, worst = [], dict.fromkeys(ways, 0.0)
    for start, (V0, omega0) in vr.PAPER_STARTS.items():
        began = time.perf_counter()
        truth = roll_direct(paper, V0, omega0, t)
        rows.append({"start": start, "law by": "root solves", "seconds": time.perf_counter() - began, "error": 0.0})
        for name, way in ways.items():
            began = time.perf_counter()
            found = solve_ivp(
                t_span=(0.0, t[-1]), y0=(V0, omega0), method="Radau", t_eval=t, rtol=settings.rtol,
                atol=1e-3 * settings.rtol, **way,
            )  # fmt: skip
            seconds = time.perf_counter() - began
            off = [np.abs(found.y[n] - speed).max() for n, speed in enumerate((truth.V, truth.omega))]
            error = float(max(off)) / abs(V0) if found.success else np.inf
            worst[name] = max(worst[name], error)
            rows.append({"start": start, "law by": name, "seconds": seconds, "error": error})
    stage.write_rows(out / "runtime.csv", rows)
    headline: dict[str, float | int | str] = {}
    for name in ("root solves", *ways):
        own = [row for row in rows if row["law by"] == name]
        headline[f"{name}: seconds, IC1-IC3"] = sum(row["seconds"] for row in own)
        if name in worst:
            headline[f"{name}: largest error of V and omega over the first speed"] = worst[name]
    return stage.Outcome([out / "runtime.csv"], headline, worst["the file of the law"] > settings.allowed)


if __name__ == "__main__":
    sys.exit(stage.run("runtime", Runtime, work, __doc__))
