"""Motions of one, two and four relaxation times by a transient solver, beside the law of steady rolling.

Each is let go from steady contact, and from a contact at rest; without slip.  e is V over that of the law at the same
time, less 1, where the law has reached the speed at which the unsteadiness was 0.003 to 1; also over that of
``roll(unsteady=True, rested=...)``, to where that ends.  From rest the law begins at the speed that leaving the
imprint leaves.

python -m pipeline.evidence.prove.unsteady [-o FILE]: data/results/transient.json, in some minutes.
"""

from __future__ import annotations

import sys
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

import viscoroll as vr

from ..results import run
from .transient import Contact, grid

Array = NDArray[np.float64]

ALPHA_3, ALPHA_11 = ([2.0], [1.0 / 3.0]), ([10.0], [1.0 / 11.0])
WEAK, STRONG = ([0.2, 3.0], [1.0, 0.01]), ([3.0, 1.0], [1.0, 0.01])
#: as src/viscoroll/datasets/dma.csv; 0.1 m, T_ref 3 s: g 583, u 318 is 1 m/s
DMA = ([0.3, 0.5, 0.8, 1.3], [1.0, 0.1, 0.01, 0.001])
#: E and tau, u = kappa V and g = gamma/(1 + j) at the start
MOTIONS = [
    *((ALPHA_11, 4.365, gamma / 1.5) for gamma in (0.32, 1.07, 3.2, 10.7, 32.0, 107.0)),
    (ALPHA_3, 10.0, 4.5), (ALPHA_3, 30.0, 45.0), (ALPHA_11, 10.0, 12.0), (ALPHA_11, 10.0, 120.0),
    (ALPHA_11, 30.0, 120.0), (WEAK, 30.0, 30.0), (WEAK, 100.0, 1000.0), (STRONG, 30.0, 30.0), (STRONG, 100.0, 1000.0),
    (DMA, 30.0, 583.0), (DMA, 100.0, 583.0), (DMA, 318.0, 5000.0),
]  # fmt: skip
LEVELS = (0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 1.0)
#: of V at the start, what a start from rest has to leave: below, the formula for it is short by a tenth and more
_CLEAR = 0.9
#: cell of the grid, over half the contact length at rest
H = 0.02
#: of what is rolled with N: creep is then as small as in the solver, which has none
_KAPPA = 1e4
#: of the start, down to which a motion is followed, and what is waited for behind
_LAST, _WAIT = 2e-3, 5.0


class Laws:
    """Free rolling over speeds downward: by quadrature of M, and, with N, as it is rolled."""

    def __init__(self, scene: vr.Scene, u0: float, rested: bool = False) -> None:
        g, V0 = scene.gamma / (1.0 + scene.j), u0 / _KAPPA
        first = u0 - float(scene.validity(u0).steady.start.speed) if rested else u0
        self.u = np.geomspace(first, 1e-4 * u0, 8001)
        c = vr.contact(scene, self.u, delta=0.0, fields=("M", "N"))
        steady = -self.u / (g * c.M)
        s = np.log(self.u)
        self.nu = np.maximum.accumulate(g * np.abs(c.N))
        self.t = cumulative_trapezoid(steady, s, initial=0.0)
        fast = scene.replace(kappa=_KAPPA)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # it ends where the unsteadiness is 1
            added = vr.roll(fast, V0, V0, self.t, unsteady=True, rested=rested)
        reached = added.regime >= 0
        self.t_added = np.interp(-self.u, -_KAPPA * added.V[reached], self.t[reached], right=np.nan)

    def errors(self, t: Array, u: Array) -> list[tuple[float, float, float | None, float]]:
        """Level of the unsteadiness, e of a motion by the law, with N where it comes so far, and when, by the law."""
        found = []
        for level in LEVELS:
            if self.nu[0] < level < self.nu[-1]:
                at = int(np.searchsorted(self.nu, level))
                law, added = (float(np.interp(when[at], t, u) / self.u[at] - 1.0) for when in (self.t, self.t_added))
                found.append((level, law, None if np.isnan(added) else added, float(self.t[at])))
        return found


def scene_of(motion: tuple[Any, float, float]) -> vr.Scene:
    """kappa is 1, so that lengths over R are contact lengths, and speeds are u."""
    (E, tau), _, g = motion
    return vr.Scene(material=vr.Prony(E, tau), kappa=1.0, mu=0.2, gamma=1.5 * g, j=0.5)


def rolled(motion: tuple[Any, float, float], h: float) -> tuple[dict[str, Any], dict[str, Array]]:
    """(What is kept of a motion, t, X and u from either start)."""
    scene, (_, u0, g) = scene_of(motion), motion
    series, steady = scene.material, scene.validity(u0).steady
    whole, left = Laws(scene, u0), u0 - float(steady.start.speed)
    end = 1.1 * float(np.interp(-_LAST * u0, -whole.u, whole.t)) + _WAIT
    row = {
        "modes": len(series.T), "u": u0, "g": g, "unsteadiness": float(steady.value), "way": float(steady.whole),
        "start": float(steady.start.way),
    }  # fmt: skip
    rows, lam = {}, float(vr.contact(scene, u0, delta=0.0, fields="lam").lam)
    for start in ("steady", "rest"):
        path = 2.4 * steady.whole + 20.0
        contact = Contact((series.J, series.T, series.alpha), grid(h), path, *([u0, lam] if start == "steady" else []))
        contact.u = u0
        rows[start] = out = contact.roll(g, t_end=end)
        t, X, u = out.T
        law = np.interp(t, whole.t, whole.u, right=0.0)
        row[start] = {
            "error": float(np.abs(u - law).max() / u0),
            "shift": float(X[-1] / 2.0 - steady.whole),
            "e": whole.errors(t, u) if start == "steady" else [],
        }
    if left > _CLEAR * u0:
        row["rest"]["e"] = Laws(scene, u0, rested=True).errors(*rows["rest"].T[::2])
    return row, rows


def found() -> dict[str, Any]:
    rows = []
    for motion in MOTIONS:
        rows.append(rolled(motion, H)[0])
        print(rows[-1], flush=True)
    return {"rows": rows, "h": H}


if __name__ == "__main__":
    sys.exit(run("prove.unsteady", found, __doc__, "transient.json", sizes=False))
