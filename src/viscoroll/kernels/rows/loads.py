"""What a bound law returns, to Python and to jitted code alike."""

from typing import Generic, NamedTuple, TypeVar

#: numbers, or arrays
T = TypeVar("T")


class Loads(NamedTuple, Generic[T]):
    """Dimensionless loads, Q divided by P and M divided by P R, with the parts of M that half-space and cylinder take;
    or, of a law in SI units, forces and moments per length.
    """

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T


class LoadsAndSlopes(NamedTuple, Generic[T]):
    """As :class:`Loads`, in the same units; then dQ/dV at fixed omega, dQ/domega at fixed V, and the slopes of the two
    parts of M over V at fixed omega and over omega at fixed V.  Of half-spaces M does not depend on omega.
    """

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T
    dQ_dV: T
    dQ_domega: T
    dM_half_space_dV: T
    dM_cylinder_dV: T
    dM_half_space_domega: T
    dM_cylinder_domega: T
