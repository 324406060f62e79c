"""Units of each quantity: the one table of dimensions, and the units in which a roller counts (:class:`Scale`).

Quantities of a scene are dimensionless: each is divided by a unit that is made of the radius R, the time T_epsilon, the
load P, the mass m, the contact length at rest l0 and the modulus E'.  Quantities of a cylinder are in SI units, and a
material may have a unit of time of its own (T_ref).
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple, Protocol, TypeAlias


class Dimension(NamedTuple):
    """A dimension, and the quantities that have it.

    formula : product of R, T, P, m, l0, E_prime and rad, as "P T/R"; of temperatures and energies another name.
    si_unit : as "N s m-2".
    divisor : words that follow the name of a quantity of a scene: the unit by which it is divided.
    names : quantities, separated by spaces.
    """

    formula: str
    si_unit: str
    divisor: str
    names: str


_TABLE = (
    Dimension(
        "T", "s", ", divided by T_epsilon",
        "t t0 onset_time rest_time rested zeta resolve T_epsilon T_sigma T_ref",
    ),
    Dimension("R", "m", ", divided by R", "R thickness x"),
    Dimension("l0", "m", ", divided by l0", "length depth"),
    Dimension("m", "kg m-1", ", divided by m", "m"),
    Dimension("m/R2", "kg m-3", ", divided by m/R^2", "density"),
    Dimension("R/T", "m s-1", ", divided by R/T_epsilon", "V V0 rest speed"),
    Dimension("R/T2", "m s-2", ", divided by R/T_epsilon^2", "g"),
    Dimension("rad", "rad", ", radians", "angle slope"),
    Dimension("rad/T", "rad s-1", ", multiplied by T_epsilon", "omega omega0"),
    Dimension("E_prime", "Pa", ", divided by E'", "E E0 G G0 G_inf bulk p tau"),
    Dimension("P", "N m-1", ", divided by the load P", "load force Q dQ_ddelta"),
    Dimension("P R", "N m m-1", ", divided by P R", "torque brake M M_half_space M_cylinder dM_ddelta"),
    Dimension("P T", "N s m-1", ", divided by P T_epsilon", "dM_dV dM_half_space_dV dM_cylinder_dV dQ_domega"),
    Dimension("P T/R", "N s m-2", ", divided by P T_epsilon/R", "dQ_dV"),
    Dimension("P T2", "N s2 m-1", ", divided by P T_epsilon^2", "N"),
    Dimension("P R T", "N m s m-1", ", divided by P R T_epsilon", "drag dM_domega dM_half_space_domega dM_cylinder_domega"),
    Dimension("P R/T", "W m-1", ", divided by P R/T_epsilon", "loss_slip loss_half_space loss_cylinder"),
    Dimension("P T/m R", "s-1", ", divided by gamma/T_epsilon", "rate_fast rate_slow"),
    Dimension(
        "m R2/T2", "J m-1", ", divided by m (R/T_epsilon)^2",
        "work_force work_torque brake_loss slip_loss rolling_loss",
    ),
    Dimension("theta", "degC", "", "temperature T0"),
    Dimension("delta theta", "K", "", "C2"),
    Dimension("molar energy", "J mol-1", "", "energy"),
)  # fmt: skip
#: Quantity -> its dimension.  A quantity that is not here is a ratio.
DIMENSIONS = {name: dimension for dimension in _TABLE for name in dimension.names.split()}


def dimension_powers(dimension: str) -> dict[str, int]:
    """Return the powers of the factors of a dimension or a unit.

    dimension: product of symbols, as "P T/R", "N m/m" or "N m m-1"; an integer after a symbol is its power, with or
        without "^" between, and all symbols after the first "/" are divisors.  The symbol "l0" ends with a digit.
    Returns a dict from symbol to power, an int other than 0: symbols whose powers cancel are left out; {} of "".
    """
    found: dict[str, int] = {}
    for n, part in enumerate(dimension.split("/")):
        for symbol, power in re.findall(r"([^\W\d]+0?|%)\^?(-?\d+)?", part):
            found[symbol] = found.get(symbol, 0) + (-1 if n else 1) * int(power or 1)
    return {symbol: power for symbol, power in found.items() if power}


#: Quantity -> powers of the factors of its dimension.
_POWERS = {name: dimension_powers(dimension.formula) for name, dimension in DIMENSIONS.items()}
#: Quantity -> power of time in its dimension, where that is not 0.
TIME_POWERS = {name: powers["T"] for name, powers in _POWERS.items() if "T" in powers}


class Scale(dict[str, Any]):
    """Unit of each quantity by its name: ``scale["V"]`` is the m/s of one unit of speed, 1 for a scene.

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
        """Keep the units of which all others are products, by name, and that of angles, 1 rad.

        R, T, P, m, l0, E_prime : radius, time, load, mass, contact length at rest and modulus, as the class states.
        si : whether these are SI units, else 1 each.
        """
        super().__init__(R=R, T=T, P=P, m=m, l0=l0, E_prime=E_prime, rad=1.0)
        self.si = si

    # The units may be arrays, whose comparison gives no truth value.
    __eq__, __hash__ = object.__eq__, object.__hash__  # type: ignore[assignment]

    def __missing__(self, name: str) -> Any:
        """Compute the unit of a quantity at its first use, and keep it.

        Python calls it for ``scale[name]`` where the dict has no entry.

        name: name of the quantity, as "V".
        Returns the factor by which a dimensionless value is multiplied to be in SI units, a float, or an array (n,) of
        many cylinders; 1.0 for a ratio, a temperature, a molar energy, a name that the table of dimensions does not
        have, and for a scene.
        """
        numerator, denominator = 1.0, 1.0
        for factor, power in _POWERS.get(name, {}).items():
            if power > 0:
                numerator = numerator * self[factor] ** power
            else:
                denominator = denominator * self[factor] ** -power
        self[name] = unit = numerator / denominator
        return unit

    def unit(self, name: str) -> str:
        """Name of the unit of a quantity, as "m s-1"; "1" for a ratio, and for all quantities of a scene but angles."""
        return si_unit(name) if self.si or name in ("angle", "slope") else "1"


class HasUnits(Protocol):
    """An object with a unit for each quantity by name: a :class:`Scale`, a record of measurements."""

    def unit(self, name: str) -> str:
        """Name of the unit of a quantity."""


#: Unit of an argument, or an object that gives it by the name of the argument.
Units: TypeAlias = str | HasUnits

#: Scale of a scene: every unit is 1.
DIMENSIONLESS = Scale(si=False)
#: Scale of functions that take and return SI units and have no cylinder.
SI = Scale()


def si_unit(name: str) -> str:
    """SI unit of a quantity, as "m s-1"; "1" for a ratio."""
    return DIMENSIONS[name].si_unit if name in DIMENSIONS else "1"
