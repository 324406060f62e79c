"""What a bound law returns, to Python and to jitted code alike."""

from typing import Generic, NamedTuple, TypeVar

#: numbers, or arrays
T = TypeVar("T")


class Loads(NamedTuple, Generic[T]):
    """Q over P, and M over P R with its parts in half-space and cylinder."""

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T


class LoadsAndSlopes(NamedTuple, Generic[T]):
    """As :class:`Loads`; dQ/dV at fixed omega, dQ/domega at fixed V, and the slopes of the parts of M."""

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T
    dQ_dV: T
    dQ_domega: T
    dM_half_space_dV: T
    dM_cylinder_dV: T
