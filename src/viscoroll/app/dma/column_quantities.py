"""Which columns of a table are frequency, moduli and temperature, and their numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ...core.errors import FileError, ParameterError
from ...core.sections import suggestion
from ...io.measurements import NO_UNIT, Numbers, Table, conversion, find_column, readings
from ...materials.shift import ABSOLUTE_ZERO
from .vocabulary import ASSUMED, QUANTITIES, UNITS, Meaning, meanings

#: degrees; temperatures without a unit that go above it are taken to be kelvins, in which DMA seldom goes below
_KELVIN = 200.0
#: quantity -> bounds of its numbers, and these in words
_RANGES = {
    "phase angle": (-math.inf, 0.5 * math.pi, "below 90 degrees"),
    "temperature": (ABSOLUTE_ZERO, math.inf, f"finite and above {ABSOLUTE_ZERO} °C"),
}
#: units of frequency that say revolutions or cycles, or radians; "1/s" and "1/min" say neither
_CYCLES = re.compile(r"(?i)hz|rpm|cpm|rad|rev|cyc|osc|giri|tours|[ucr]/|upm|u\s*min|deg|°")
#: a heading that begins with G and at most three further letters or digits
_OF_G = re.compile(r"\W*[Gg][^\W_]{0,3}(?![^\W_])")
#: a power of ten in a heading
_POWER_OF_TEN = re.compile(r"(?<!\d)10\s*(?:\^|\*\*|[⁰¹²³⁴-⁹⁻])|\b1[eE][+-]?\d")
#: units of angles
_ANGLE = re.compile(r"(?i)rad|deg|°|º|grad")


class Column(NamedTuple):
    """A column of a known quantity.

    position, heading : index from 0 and heading in its table.
    name : name of its quantity, a key of :data:`.vocabulary.UNITS`.
    mode : mode of its modulus, "tension", "shear", or "" where the heading does not say.
    log : base of the logarithms that its numbers are, 0 of others.
    unit : unit in which its numbers are written, of the file, the user, or assumed; "" where none can be assumed.
    stated : whether the file or the user gives the unit; False: it is assumed.
    """

    position: int
    heading: str
    name: str
    mode: str
    log: float
    unit: str
    stated: bool

    @property
    def quantity(self) -> str:
        """Name of what its numbers are converted to, as "storage" or "frequency".

        An angular frequency counts as a frequency, a compliance as the modulus of the same name, a phase angle as tan
        delta; "reduced" stays in the name.
        """
        return _quantity(self.name)


def columns_of(
    table: Table, test: str, named: Mapping[str, str], overruling: Mapping[str, str], defaults: Mapping[str, str]
) -> tuple[list[Column], dict[str, str]]:
    """Find the columns of a table whose quantity is known: the user named it, or the heading says it and its unit fits.

    table : :class:`Table`, table with headings.
    test : "dma" or "relaxation", whose quantities are looked for.
    named : quantity -> heading, of columns that the user named; keys of :data:`.vocabulary.UNITS`, here and below.
    overruling : quantity -> unit in place of that of the file.
    defaults : quantity -> unit where the file gives none.
    Returns (a list of :class:`Column`, the columns of known quantities, in the order of the table; a dict, heading of
    each other column, or "column INDEX" without one -> why it is left out: "no numbers", a unit that does not fit, or
    "" where no quantity is known of it).  Headings of what the user named by another column are left out.
    Raises ParameterError for a heading that the table does not have, FileError for one that several columns have, and
    for a column that the user named and whose unit is not understood.
    """
    owners = {_index(table, heading): name for name, heading in named.items()}
    taken = {_quantity(name) for name in named}
    columns: list[Column] = []
    others: dict[str, str] = {}
    for index, (heading, row) in enumerate(zip(table.headings, table.units, strict=True)):
        if index in owners:
            found = _named(owners[index], heading, row, overruling)
        else:
            found = [each for each in meanings(heading, row) if each.name in QUANTITIES[test]]
            found = [each for each in found if _quantity(each.name) not in taken]
        faults = [_contradiction(each, heading, overruling) for each in found]
        if not table.has_numbers(index):
            faults = ["no numbers"]
        if "" in faults:
            name, mode, unit, log, _ = found[faults.index("")]
            sign = (
                "1" if name == "strain" and any(each.unit for each in found) else ""
            )  # of a ratio, where per cent are as usual
            unit = overruling.get(name) or (sign if unit in NO_UNIT else unit) or defaults.get(name, "")
            columns.append(Column(index, heading, name, mode, log, unit or ASSUMED[name], bool(unit)))
        elif index in owners:
            raise FileError(table.path, f"column {heading!r}: {faults[0]}")
        else:
            others[heading or f"column {index}"] = faults[0] if faults else ""
    return columns, others


def _named(name: str, heading: str, row: str, overruling: Mapping[str, str]) -> list[Meaning]:
    """Return the ways to read a heading of a column whose quantity the user named, those with a unit first.

    name : the quantity.
    heading, row : text of the heading, and the cell of a row of units.
    overruling : quantity -> unit in place of that of the file.
    Returns a list of :class:`Meaning`.  A modulus is of shear where the heading begins with G and at most three further
    letters or digits, as "Gp"; a heading that says "angular" is of an angular frequency.  A heading that states a unit
    cannot be read without one, and one with a power of ten has no known unit, if ``overruling`` has none.
    """
    known = meanings(heading, row)
    mode = next((each.mode for each in known if each.mode), "shear" if _OF_G.match(heading) else "")
    if any("angular " + name == each.name for each in known):
        name = "angular " + name
    mode = mode if "Pa" in UNITS[name] else ""
    ways = [Meaning(name, mode, each.unit, each.log, each.sure) for each in readings(heading or "column", row)]
    ways.sort(key=lambda each: each.unit in NO_UNIT)
    if name not in overruling and _POWER_OF_TEN.search(heading):
        return [ways[0]._replace(unit=heading)]
    stated = [each for each in ways if each.sure and each.unit not in NO_UNIT]
    return [each for each in ways if not stated or each.unit not in NO_UNIT]


def _index(table: Table, heading: str) -> int:
    """Return the index of the column that the user named by its heading.

    table : :class:`Table`, table with headings.
    heading : the heading, with its unit or without.
    Returns the index, from 0.
    Raises ParameterError, with the headings of the table, where the table does not have it; FileError where several
    columns have it.
    """
    found = find_column(table, heading)
    if found is None:
        allowed = f"one of {', '.join(map(repr, table.headings))}{suggestion(str(heading), table.headings)}"
        raise ParameterError("columns", f"{heading!r:.60}", allowed)
    return found


def _quantity(name: str) -> str:
    """Return :attr:`Column.quantity` of a quantity by its name."""
    name = name.replace("angular ", "").removesuffix(" compliance")
    return "tan delta" if name == "phase angle" else name


def _contradiction(meaning: Meaning, heading: str, overruling: Mapping[str, str]) -> str:
    """Return why the unit of a heading contradicts the quantity that the heading may name, and what helps.

    meaning : :class:`Meaning`, the quantity that the heading may name, with the unit that stands in the heading.
    heading : text of the heading.
    overruling : quantity -> unit that the user gives in place of that of the file; these are not checked.
    Returns a text for the user: the unit is unknown or of another dimension, is Hz of an angular frequency, or is an
    angle of tan delta or none of a phase angle.  "" where the unit fits, is missing, or is replaced by the user.
    """
    name, unit = meaning.name, meaning.unit
    if name in overruling or unit in NO_UNIT:
        return ""
    problem = f"unit {unit!r} is not a unit of {name}: give units={{{name!r}: ...}}"
    try:
        conversion(unit, UNITS[name])
    except ParameterError:
        return problem
    if "angular" in name and unit.lower().endswith("hz"):
        plain = name.replace("angular ", "")
        return f"an angular frequency in {unit}: rename it {plain!r}, or give units={{{name!r}: ...}}"
    angle = {"1": False, "rad": True}.get(UNITS[name])  # pint converts the one to the other
    return "" if angle in (None, bool(_ANGLE.search(unit))) else problem


@np.errstate(all="ignore")  # a number beyond the doubles is infinite, which is refused
def numbers_of(table: Table, column: Column) -> Numbers:
    """Return the numbers of a column, converted to the unit of its quantity.

    Logarithms become numbers, frequencies in cycles angular ones, and phase angles their tangents.

    table : :class:`Table`, the table that has the column.
    column : :class:`Column`, a column whose quantity is known.
    Returns :class:`Numbers` in rad/s, Pa, 1/Pa, degrees Celsius, or dimensionless for tan delta: the values, (n,), and
    half a unit of the last digit that the file states of each, converted in the same way, (n,).
    Raises FileError for cells that are no numbers, and for a unit that is missing and cannot be assumed: of
    compliances, of temperatures above 200, and of phase angles that may be in radians; for a phase angle of
    90 degrees and more, and a temperature at or below absolute zero.  Other values are not checked: they may be
    infinite.
    """
    name, unit = column.name, column.unit
    values, half = table.numbers(column.position)
    # a phase angle of rubber in degrees goes above pi/2
    open_unit = not unit or values.max() <= {"phase angle": 0.5 * math.pi}.get(name, -math.inf)
    if not column.stated and (open_unit or (name == "temperature" and values.max() > _KELVIN)):
        problem = (
            f"column {column.heading!r} has no unit, and its largest value is {values.max():g}: give "
            f"units={{{name!r}: ...}}"
        )
        raise FileError(table.path, problem)
    if column.log:
        values = column.log**values
        half = values * math.log(column.log) * half
    factor, offset = conversion(unit, UNITS[name])
    if column.quantity.endswith("frequency") and "angular" not in name and not _CYCLES.search(unit):
        factor *= 2.0 * math.pi
    values, half = factor * values + offset, factor * half
    if name in _RANGES:
        low, high, words = _RANGES[name]
        table.require((values > low) & (values < high), f"the {name} is not {words}: remove the row")
    return Numbers(np.tan(values), half / np.cos(values) ** 2) if name == "phase angle" else Numbers(values, half)
