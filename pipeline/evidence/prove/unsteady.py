"""Motions of one, two and four relaxation times by a transient solver, beside the law of steady
rolling.

Each is let go from steady contact, and from a contact at rest; without slip.  e is V over that of
the law at the same time, less 1, where the law has reached the speed at which the unsteadiness was
0.003 to 1; also over that of ``roll(unsteady=True, rested=...)``, to where that ends.  From rest
the law begins at the speed that leaving the imprint leaves.

The motions are those of data/reference/unsteady.json; data/README.md says how they were made.

python -m pipeline.evidence.prove.unsteady [-o FILE]: data/results/transient.json, in seconds.
"""

import json
import sys
import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator

import viscoroll as vr

from ...stage import ROOT, Row
from ..results import run

Array = NDArray

REFERENCE = ROOT / "data/reference/unsteady.json"
LEVELS = (0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 1.0)
#: of V at the start, what a start from rest has to leave: below, the formula for it is short by a
#: tenth and more
_CLEAR = 0.9
#: of what is rolled with N: creep is then as small as in the solver, which has none
_KAPPA = 1e4


class Laws:
    """Free rolling over speeds downward: by quadrature of M, and, with N, as it is rolled."""

    def __init__(self, scene: vr.Scene, u0: float, rested: bool = False) -> None:
        g = scene.gamma / (1.0 + scene.j)
        V0 = u0 / _KAPPA
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
        """Level of the unsteadiness, e of a motion by the law, with N where it comes so far, and
        when, by the law.
        """
        found = []
        solved = PchipInterpolator(t, u)
        for level in LEVELS:
            if self.nu[0] < level < self.nu[-1]:
                at = int(np.searchsorted(self.nu, level))
                law, added = (
                    solved(when[at]) / self.u[at] - 1.0 for when in (self.t, self.t_added)
                )
                found.append((level, law, None if np.isnan(added) else added, float(self.t[at])))
        return found


def compared(motion: Row) -> Row:
    """Return what is kept of a motion: its numbers, and from either start the largest error, the
    shift and e by level.

    motion: E, tau, u, g and, from either start, times and speeds, as in the file.
    """
    # kappa is 1: lengths over R are contact lengths, and speeds are u
    material = vr.Prony(motion["E"], motion["tau"])
    scene = vr.Scene(material=material, kappa=1.0, mu=0.2, gamma=1.5 * motion["g"], j=0.5)
    u0 = motion["u"]
    steady = scene.validity(u0).steady
    whole = Laws(scene, u0)
    row = {
        "modes": len(motion["E"]),
        "u": u0,
        "g": motion["g"],
        "unsteadiness": float(steady.value),
        "way": float(steady.whole),
        "start": float(steady.start.distance),
    }
    for start in ("steady", "rest"):
        t, u = (np.array(motion[start][name]) for name in ("t", "u"))
        law = np.interp(t, whole.t, whole.u, right=0.0)
        row[start] = {
            "error": np.abs(u - law).max() / u0,
            "shift": np.trapezoid(u, t) - steady.whole,
            "e": whole.errors(t, u) if start == "steady" else [],
        }
    if u0 - float(steady.start.speed) > _CLEAR * u0:
        row["rest"]["e"] = Laws(scene, u0, rested=True).errors(t, u)
    return row


def found() -> Row:
    """Return rows of all motions of the file, and the cell of its grid."""
    content = json.loads(REFERENCE.read_text(encoding="utf-8"))
    return {"rows": [compared(motion) for motion in content["motions"]], "h": content["h"]}


if __name__ == "__main__":
    sys.exit(run("prove.unsteady", found, __doc__, "transient.json", sizes=False))
