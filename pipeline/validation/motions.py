"""Motions of :func:`viscoroll.roll` against motions on direct solves (:mod:`direct_motion`)."""

from __future__ import annotations

import numpy as np

from viscoroll.motion.roll import roll
from viscoroll.presets import PAPER_SECTION_5_ROUNDED, PAPER_STARTS
from viscoroll.rollers import Scene
from viscoroll.tables.law_dataset import Check

from .direct_motion import roll_direct

#: What the package promises at rtol 1e-8, relative to max(|V|, |omega|), down to |V| = 1e-6.
SPEED_ALLOWED = 1e-7
#: A tenth of rtol: 1e-11 seen where the motion starts in full slip, 1.2e-10 where it comes back to
#: it.
ONSET_ALLOWED = 1e-9
RTOL = 1e-8
_LEAST_SPEED = 1e-6
#: Friction too weak for the slow manifold: the stick zone vanishes again, V turns its sign while
#: sliding.
_SLIP_RETURNS = Scene(alpha=11.0, kappa=2.91, mu=0.01, gamma=1.1e4, j=0.5)


def motion_checks(times: int) -> list[Check]:
    """IC1-IC3 down to |V| = 1e-6, and a motion in which full slip returns, at ``times`` times
    each.
    """
    cases = {name: (PAPER_SECTION_5_ROUNDED, *start) for name, start in PAPER_STARTS.items()}
    cases["slip returns"] = (_SLIP_RETURNS, 1.0, 1.0)
    return [check for name, case in cases.items() for check in _compare(name, *case, times)]


def _compare(name: str, scene: Scene, V0: float, omega0: float, times: int) -> list[Check]:
    end = roll(scene, V0, omega0, np.array([1.0]), rtol=RTOL, rest=_LEAST_SPEED).rest_time
    motion = roll(scene, V0, omega0, np.linspace(0.0, end, times), rtol=RTOL)
    direct = roll_direct(scene, V0, omega0, motion.t)
    size = np.maximum(np.abs(direct.V), np.abs(direct.omega))
    # a NaN on either side must fail the check
    worst = {
        quantity: float(
            np.max(np.abs(getattr(motion, quantity) - getattr(direct, quantity)) / size)
        )
        for quantity in ("V", "omega")
    }
    onset = abs(motion.onset_time / direct.onset_time - 1.0)
    versus = f"roll at rtol {RTOL:g} against direct solves"
    return [
        *(
            Check(
                f"motion {name}: {quantity}",
                error,
                SPEED_ALLOWED,
                f"divided by max(|V|, |omega|) >= 1e-6; {versus}",
            )
            for quantity, error in worst.items()
        ),
        Check(f"motion {name}: onset time", onset, ONSET_ALLOWED, f"relative; {versus}"),
    ]
