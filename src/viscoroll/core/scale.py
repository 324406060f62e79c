"""What each quantity is counted in: the one table of dimensions, and the units of what rolls (:class:`Scale`).

A scene's numbers are over its units, a cylinder's are in SI units, and a material may count time in its own.
"""

from __future__ import annotations

import re
from typing import Any, Protocol, TypeAlias

import numpy as np

#: quantity -> its dimension in radius R, time T, load P (N/m), mass m (kg/m), contact length at rest l0, modulus E';
#: what is not here is a ratio; temperatures and what belongs to them have no part in a scale
DIMENSIONS = {
    **dict.fromkeys(
        ("t", "t0", "onset_time", "rest_time", "rested", "zeta", "resolve", "T_epsilon", "T_sigma", "T_ref"), "T"
    ),
    **dict.fromkeys(("R", "thickness"), "R"),
    **dict.fromkeys(("E", "E0", "G", "G0", "G_inf", "bulk"), "E_prime"),
    "load": "P",
    **dict.fromkeys(("temperature", "T0"), "theta"),
    "C2": "delta theta",
    "energy": "molar energy",
    "m": "m",
    "g": "R/T2",
    "density": "m/R2",
    **dict.fromkeys(("V", "V0", "rest", "speed"), "R/T"),
    **dict.fromkeys(("omega", "omega0"), "rad/T"),
    **dict.fromkeys(("angle", "slope"), "rad"),
    "x": "R",
    "length": "l0",
    **dict.fromkeys(("p", "tau"), "E_prime"),
    **dict.fromkeys(("force", "Q", "dQ_ddelta"), "P"),
    **dict.fromkeys(("torque", "brake", "M", "M_half_space", "M_cylinder"), "P R"),
    **dict.fromkeys(("dM_dV", "dM_half_space_dV", "dM_cylinder_dV", "dQ_domega"), "P T"),
    "dQ_dV": "P T/R",
    "N": "P T2",
    "drag": "P R T",
    **dict.fromkeys(("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"), "m R2/T2"),
    **dict.fromkeys(("loss_slip", "loss_half_space", "loss_cylinder"), "P R/T"),
    **dict.fromkeys(("rate_fast", "rate_slow"), "P T/m R"),
}
#: dimension -> its SI unit, and the words for a number without dimension
DIMENSION_UNITS = {
    "T": ("s", " over T_epsilon"),
    "R/T": ("m s-1", " times T_epsilon/R"),
    "rad/T": ("rad s-1", " times T_epsilon"),
    "rad": ("rad", ", radians"),
    "R": ("m", " over R"),
    "R/T2": ("m s-2", " times T_epsilon^2/R"),
    "m": ("kg m-1", " over m"),
    "m/R2": ("kg m-3", " over m/R^2"),
    "l0": ("m", " over l0"),
    "E_prime": ("Pa", " over E'"),
    "P": ("N m-1", " over load"),
    "P R": ("N m m-1", " over load times radius"),
    "P T": ("N s m-1", " over P T_epsilon"),
    "P R T": ("N m s m-1", " over P R T_epsilon"),
    "P T/R": ("N s m-2", " over P T_epsilon/R"),
    "P T2": ("N s2 m-1", " over P T_epsilon^2"),
    "m R2/T2": ("J m-1", " over m (R/T_epsilon)^2"),
    "P R/T": ("W m-1", " over P R/T_epsilon"),
    "P T/m R": ("s-1", " over gamma"),
    "theta": ("degC", ""),
    "delta theta": ("K", ""),
    "molar energy": ("J mol-1", ""),
}


def dimension_powers(dimension: str) -> dict[str, int]:
    """Powers of what a dimension, or a unit as "N m/m" or "N m m-1", is made of."""
    found: dict[str, int] = {}
    for n, part in enumerate(dimension.split("/")):
        for symbol, power in re.findall(r"([^\W\d]+0?|%)\^?(-?\d+)?", part):
            found[symbol] = found.get(symbol, 0) + (-1 if n else 1) * int(power or 1)
    return {symbol: power for symbol, power in found.items() if power}


#: what each dimension is made of
_PARTS = {dimension: dimension_powers(dimension) for dimension in DIMENSION_UNITS}
#: quantity -> the power of time in it
TIME_POWERS = {name: power for name, dimension in DIMENSIONS.items() if (power := _PARTS[dimension].get("T", 0))}


class Scale(dict[str, Any]):
    """What 1 of each quantity is to who asked, by name: ``scale["V"]`` in m/s of a cylinder, 1 of a scene.

    Parameters
    ----------
    R, T, P, m, l0, E_prime : radius (m), time (s), load (N/m), mass (kg/m), contact length at rest (m) and modulus
        (Pa); numbers, or arrays of many cylinders.
    si : whether these are SI units.
    """

    si: bool

    def __init__(
        self, R: Any = 1.0, T: Any = 1.0, P: Any = 1.0, m: Any = 1.0, l0: Any = 1.0, E_prime: Any = 1.0,
        *, si: bool = True,
    ) -> None:  # fmt: skip
        super().__init__(R=R, T=T, P=P, m=m, l0=l0, E_prime=E_prime, rad=1.0)
        self.si = si

    # its numbers may be arrays
    __eq__, __hash__ = object.__eq__, object.__hash__  # type: ignore[assignment]

    def __missing__(self, name: str) -> Any:
        above, below = 1.0, 1.0
        for part, power in _PARTS.get(DIMENSIONS.get(name, ""), {}).items():
            if power > 0:
                above = above * self[part] ** power
            else:
                below = below * self[part] ** -power
        self[name] = found = above / below
        return found

    def of(self, name: str, value: Any) -> Any:
        """A number without dimension, in these units; a ratio as it is."""
        if not self.si or name not in DIMENSIONS:
            return value
        found = np.asarray(value) * self[name]
        return found if found.ndim else float(found)

    def unit(self, name: str) -> str:
        """The unit of a quantity, as "m s-1"; "1" of a ratio, and of all of a scene but its angles."""
        return si_unit(name) if self.si or DIMENSIONS.get(name) == "rad" else "1"


class HasUnits(Protocol):
    """What has a unit for each quantity by name: a :class:`Scale`, a record of measurements."""

    def unit(self, name: str) -> str:
        """The unit of a quantity."""


#: the unit of an argument, or what has one by the argument's name
Units: TypeAlias = str | HasUnits

#: of a scene
DIMENSIONLESS = Scale(si=False)
#: of SI units themselves: what takes and gives them without a cylinder
SI = Scale()


def si_unit(name: str) -> str:
    """The SI unit of a quantity, as "m s-1"; "1" of a ratio."""
    return DIMENSION_UNITS[DIMENSIONS[name]][0] if name in DIMENSIONS else "1"
