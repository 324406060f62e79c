"""What the kernels of a motion hand to one another."""

from __future__ import annotations

from typing import Any, NamedTuple


class Scene(NamedTuple):
    """What Eq. (22) asks of a scene beside gamma, which only scales time."""

    material: Any
    kappa: float
    mu: float
    j: float
