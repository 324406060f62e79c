"""What the law of steady rolling leaves out at the start and on the way: a rest before it, and the added mass."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..contact_law.contact import contact
from ..contact_law.parameters import Parameters
from ..contact_law.steadiness import CAUGHT
from ..core.checks import checked
from ..core.errors import ParameterError
from .driven import Prepared


def time_of_rest(rested: bool | float) -> float:
    """The time of the rest, infinite for a long one.

    Raises
    ------
    ParameterError
        What is not one number >= 0.
    """
    if isinstance(rested, bool):
        return math.inf if rested else 0.0
    if checked("rested", rested, low=0.0).ndim:
        raise ParameterError("rested", rested, "one time >= 0, or True")
    return float(rested)


def refuse_unlike(scene: Parameters) -> None:
    """Raise ParameterError where the added mass is asked for of bodies that differ."""
    if not scene.like_bodies:
        sentence = "unsteady = True: the bodies differ, and what either has of the added mass is not known then"
        raise ParameterError("unsteady", True, "False where bodies differ", sentence)


def climbed(ready: Prepared, scene: Parameters, rested: float) -> tuple[Prepared, Any]:
    """(What is rolled once the cylinder has left the imprint of a rest, whether it was caught there).

    Raises
    ------
    ParameterError
        A prescribed speed, or a start in full slip, of which the cost is not known.
    """
    if rested == 0.0:
        return ready, False
    V = np.asarray(ready.V0, np.float64)
    limit = np.abs(V) * contact(scene, V, delta=0.0, fields="delta_star").delta_star
    if ready.prescribed or np.any(np.abs(ready.omega0 - V) > limit):
        what = "a speed is prescribed" if ready.prescribed else "it starts in full slip"
        sentence = f"rested is given, but {what}: what leaving the imprint costs is not known then"
        raise ParameterError("rested", rested, "left out", sentence)
    lost = scene.freely(V).start(rested).speed / np.where(V == 0.0, 1.0, np.abs(V))
    return ready._replace(V0=V * (1.0 - lost), omega0=ready.omega0 * (1.0 - lost)), lost > CAUGHT
