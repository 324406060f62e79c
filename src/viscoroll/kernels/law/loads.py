"""What a bound law returns, to Python and to jitted code alike."""

from __future__ import annotations

from typing import NamedTuple


class Loads(NamedTuple):
    """Q over P, and M over P l0 with its parts in half-space and cylinder."""

    Q: float
    M: float
    M_half_space: float
    M_cylinder: float


class LoadsAndSlopes(NamedTuple):
    """As :class:`Loads`; dQ/dV at fixed omega, dQ/domega at fixed V, and the slopes of the parts of M."""

    Q: float
    M: float
    M_half_space: float
    M_cylinder: float
    dQ_dV: float
    dQ_domega: float
    dM_half_space_dV: float
    dM_cylinder_dV: float
