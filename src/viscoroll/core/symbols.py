"""Symbols of all quantities: name in code, LaTeX symbol, meaning, range, equation of the paper, read from symbols.csv.

Files, figures and ``docs/symbols.md`` take their words from here, and the units from :mod:`.scale`.
"""

from __future__ import annotations

import csv
from importlib.resources import files
from typing import NamedTuple

from .scale import DIMENSIONS, si_unit

PAPER = (
    "A. A. Zobova and I. G. Goryacheva, Dynamics of a viscoelastic cylinder on a viscoelastic half-space, "
    "Acta Mechanica (2020), doi:10.1007/s00707-020-02643-5"
)

#: Attribute of a dataset over V: the lowest and the highest speed at which the material was measured.
MEASURED = "measured_V"


class Symbol(NamedTuple):
    """A quantity.

    latex : symbol.
    long_name : meaning.
    range : allowed values.
    equation : its place in the paper, "" without one.
    """

    latex: str
    long_name: str
    range: str
    equation: str


#: Name in code -> symbol; the rows of symbols.csv.
with (files(__package__) / "symbols.csv").open(encoding="utf-8") as _file:
    SYMBOLS = {name: Symbol(*cells) for name, *cells in [*csv.reader(_file)][1:]}


#: Name in code -> meaning, of quantities without a symbol.
_MEANINGS = {
    "full_slip": "1 in full slip, else 0",
    "stable": "1 if small disturbances decay, else 0",
    "rest_time": "time at which the rest threshold was crossed",
    "loss": "power lost in rolling and slip",
    "loss_slip": "power lost: slip",
    "loss_half_space": "power lost: half-space",
    "loss_cylinder": "power lost: cylinder",
    "length": "contact length",
    "thickness": "thickness of the layer",
    "temperature": "temperature of the material",
    "base_temperature": "temperature of the base",
    "ambient": "temperature of the surroundings",
    "heat": "heat that the losses gave the body since t = 0",
    "given_off": "heat that the body gave off since t = 0",
    "conductance": "heat given off per kelvin and length of the cylinder",
    "capacity": "heat stored per kelvin and length of the cylinder",
    "measured": "1 where the material was measured at the rates of the contact, else 0",
    "V0": "initial velocity of the axis",
    "omega0": "initial angular velocity",
    "count": "number of equilibria",
    "coefficient": "all losses divided by load and distance",
    "efficiency": "output power divided by input power",
}


def attributes(name: str, si: bool = False) -> dict[str, str]:
    """Return the attributes of a quantity in a dataset.

    name: name of the quantity in code, as "delta_star".
    si: whether it is in SI units, else dimensionless.
    Returns a dict with long_name ("" of an unknown name) and units ("1" of a dimensionless quantity and of an unknown
    name).  It also has symbol (LaTeX) and equation ("" for none) if the table of symbols has the name, unless the
    quantity is in SI units and has a dimension, as symbols stand for dimensionless quantities.
    """
    found = {"long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1"}
    if name in SYMBOLS and not (si and name in DIMENSIONS):
        found |= {"symbol": SYMBOLS[name].latex, "equation": SYMBOLS[name].equation}
    return found


def describe_quantity(name: str, si: bool = False) -> str:
    """Return the meaning of a quantity in words, as for long_name of a dataset; "" where it is not known.

    name: name of the quantity in code, or of a slope as "dQ_dV".
    si: whether it is in SI units; a quantity whose unit is per m, as a force in N/m, ends with ", per length of the
        cylinder" then.  Else the words end with the unit by which the quantity is divided, as ", divided by R", of an
        angular velocity with ", multiplied by T_epsilon", of an angle with ", radians".  A ratio, and a temperature,
        has no such ending in either case.
    """
    if name in SYMBOLS:
        text = SYMBOLS[name].long_name
        if si and name == "delta":
            text = text.replace("omega", "omega R")
    elif name.startswith("d") and "_d" in name:
        dependent, _, variable = name[1:].partition("_d")
        text = f"partial derivative of {dependent} with respect to {variable}"
    else:
        text = _MEANINGS.get(name, "")
    if not text or name not in DIMENSIONS:
        return text
    dimension = DIMENSIONS[name]
    return text + (", per length of the cylinder" * dimension.si_unit.endswith(" m-1") if si else dimension.divisor)
