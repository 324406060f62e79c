"""Units and symbols of all quantities: the one table of dimensions, the units in which a roller
counts (:class:`Scale`), and symbols, meanings and equations, read from symbols.csv.

Quantities of a scene are dimensionless: each is divided by a unit that is made of the radius R, the
time T_epsilon, the load P, the mass m, the contact length at rest l0 and the modulus E'.
Quantities of a cylinder are in SI units, and a material may have a unit of time of its own (T_ref).

Files, figures and ``docs/symbols.md`` take their words and units from here.
"""

from __future__ import annotations

import csv
import re
from importlib.resources import files
from typing import Any, NamedTuple, Protocol, TypeAlias

# --- Units of each quantity ---


def _rows(table: str) -> list[list[str]]:
    """Return the rows of a ``table`` beside this module, without its head."""
    with (files(__package__) / table).open(encoding="utf-8") as file:
        return [*csv.reader(file)][1:]


class Dimension(NamedTuple):
    """A dimension, and the quantities that have it.

    formula : product of R, T, P, m, l0, E_prime and rad, as "P T/R"; of temperatures and energies
    another name.
    si_unit : as "N s m-2".
    divisor : words that follow the name of a quantity of a scene: the unit by which it is divided.
    names : quantities, separated by spaces.
    """

    formula: str
    si_unit: str
    divisor: str
    names: str


#: Quantity -> its dimension, from the rows of dimensions.csv.  A quantity that is not here is a
#: ratio.
DIMENSIONS = {
    name: dimension
    for dimension in (Dimension(*row) for row in _rows("dimensions.csv"))
    for name in dimension.names.split()
}


def dimension_powers(dimension: str) -> dict[str, int]:
    """Return the powers of the factors of a dimension or a unit.

    dimension: product of symbols, as "P T/R", "N m/m" or "N m m-1"; an integer after a symbol is
        its power, with or without "^" between, and all symbols after the first "/" are divisors.
        The symbol "l0" ends with a digit.
    Returns a dict from symbol to power, an int other than 0: symbols whose powers cancel are left
    out; {} of "".
    """
    found: dict[str, int] = {}
    for n, part in enumerate(dimension.split("/")):
        # letters, of l0 with its digit, then perhaps a power
        for symbol, power in re.findall(r"([^\W\d]+0?|%)\^?(-?\d+)?", part):
            found[symbol] = found.get(symbol, 0) + (-1 if n else 1) * int(power or 1)
    return {symbol: power for symbol, power in found.items() if power}


#: Quantity -> powers of the factors of its dimension.
_POWERS = {name: dimension_powers(dimension.formula) for name, dimension in DIMENSIONS.items()}
#: Quantity -> power of time in its dimension, where that is not 0.
TIME_POWERS = {name: powers["T"] for name, powers in _POWERS.items() if "T" in powers}


class Scale(dict[str, Any]):
    """Unit of each quantity by its name: ``scale["V"]`` is the m/s of one unit of speed, 1 for a
    scene.

    Parameters
    ----------
    R, T, P, m, l0, E_prime : radius (m), time (s), load (N/m), mass (kg/m), contact length at rest
        (m) and modulus (Pa); numbers, or arrays of many cylinders.
    si : whether these are SI units.
    """

    si: bool

    def __init__(
        self,
        R: Any = 1.0,
        T: Any = 1.0,
        P: Any = 1.0,
        m: Any = 1.0,
        l0: Any = 1.0,
        E_prime: Any = 1.0,
        *,
        si: bool = True,
    ) -> None:
        """Keep the units of which all others are products, by name, and that of angles, 1 rad.

        R, T, P, m, l0, E_prime : radius, time, load, mass, contact length at rest and modulus, as
        the class states.
        si : whether these are SI units, else 1 each.
        """
        super().__init__(R=R, T=T, P=P, m=m, l0=l0, E_prime=E_prime, rad=1.0)
        self.si = si

    # The units may be arrays, whose comparison gives no truth value.
    __eq__ = object.__eq__
    __hash__ = object.__hash__  # type: ignore[assignment]

    def __missing__(self, name: str) -> Any:
        """Compute the unit of a quantity at its first use, and keep it.

        Python calls it for ``scale[name]`` where the dict has no entry.

        name: name of the quantity, as "V".
        Returns the factor by which a dimensionless value is multiplied to be in SI units, a float,
        or an array (n,) of many cylinders; 1.0 for a ratio, a temperature, a molar energy, a name
        that the table of dimensions does not have, and for a scene.
        """
        # one division in place of negative powers, each of which would round
        numerator = 1.0
        denominator = 1.0
        for factor, power in _POWERS.get(name, {}).items():
            if power > 0:
                numerator = numerator * self[factor] ** power
            else:
                denominator = denominator * self[factor] ** -power
        self[name] = unit = numerator / denominator
        return unit

    def unit(self, name: str) -> str:
        """Name of the unit of a quantity, as "m s-1"; "1" for a ratio, and for all quantities of a
        scene but angles.
        """
        return si_unit(name) if self.si or name in ("angle", "slope") else "1"


class HasUnits(Protocol):
    """An object with a unit for each quantity by name: a :class:`Scale`, a record of
    measurements.
    """

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


# --- Symbols of all quantities ---

PAPER = (
    "A. A. Zobova and I. G. Goryacheva, Dynamics of a viscoelastic cylinder on a viscoelastic "
    "half-space, "
    "Acta Mechanica (2020), doi:10.1007/s00707-020-02643-5"
)

#: Attribute of a dataset over V: the lowest and the highest speed at which the material was
#: measured.
MEASURED = "measured_V"


class Symbol(NamedTuple):
    """A quantity.

    latex : symbol, "" of a quantity without one, whose range and equation are "" too.
    long_name : meaning.
    range : allowed values.
    equation : its place in the paper, "" without one.
    """

    latex: str
    long_name: str
    range: str
    equation: str


_WORDS = {name: Symbol(*cells) for name, *cells in _rows("symbols.csv")}
#: Name in code -> symbol; the rows of symbols.csv that have one.
SYMBOLS = {name: symbol for name, symbol in _WORDS.items() if symbol.latex}


def attributes(name: str, si: bool = False) -> dict[str, str]:
    """Return the attributes of a quantity in a dataset.

    name: name of the quantity in code, as "delta_star".
    si: whether it is in SI units, else dimensionless.
    Returns a dict with long_name ("" of an unknown name) and units ("1" of a dimensionless quantity
    and of an unknown name).  It also has symbol (LaTeX) and equation ("" for none) if the table of
    symbols has the name, unless the quantity is in SI units and has a dimension, as symbols stand
    for dimensionless quantities.
    """
    found = {"long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1"}
    if name in SYMBOLS and not (si and name in DIMENSIONS):
        found |= {"symbol": SYMBOLS[name].latex, "equation": SYMBOLS[name].equation}
    return found


def describe_quantity(name: str, si: bool = False) -> str:
    """Return the meaning of a quantity in words, as for long_name of a dataset; "" where it is not
    known.

    name: name of the quantity in code, or of a slope as "dQ_dV".
    si: whether it is in SI units; a quantity whose unit is per m, as a force in N/m, ends with ",
        per length of the cylinder" then.  Else the words end with the unit by which the quantity is
        divided, as ", divided by R", of an angular velocity with ", multiplied by T_epsilon", of an
        angle with ", radians".  A ratio, and a temperature, has no such ending in either case.
    """
    if name in _WORDS:
        text = _WORDS[name].long_name
        if si and name == "delta":
            # the creepage of a scene is in units where R = 1
            text = text.replace("omega", "omega R")
    elif name.startswith("d") and "_d" in name:
        dependent, _, variable = name[1:].partition("_d")
        text = f"partial derivative of {dependent} with respect to {variable}"
    else:
        text = ""
    if not text or name not in DIMENSIONS:
        return text
    dimension = DIMENSIONS[name]
    return text + (
        ", per length of the cylinder" * dimension.si_unit.endswith(" m-1")
        if si
        else dimension.divisor
    )
