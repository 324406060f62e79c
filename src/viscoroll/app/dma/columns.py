"""Which columns of a table are frequency, moduli and temperature, and their numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ...core.errors import FileError, ParameterError
from ...core.sections import suggestion
from ...io.measurements import NO_UNIT, Numbers, Table, conversion, find, readings
from .names import UNITS, Meaning, meanings

#: unit of :data:`UNITS` -> the one that is assumed where neither the file nor the user says any
_ASSUMED = {"rad/s": "Hz", "Pa": "Pa", "1": "1", "rad": "deg", "degC": "degC"}
#: degrees; temperatures without a unit that go above it are taken to be kelvins
_KELVIN = 200.0
#: units of frequency that say revolutions or cycles, or radians; "1/s" and "1/min" say neither
_CYCLES = re.compile(r"(?i)hz|rpm|rad|rev|cycle|u/|r/|upm|deg|°")
_ANGLE = re.compile(r"(?i)rad|deg|°|º|grad")


class Column(NamedTuple):
    """A column whose meaning is known.

    place, heading : in its table; meaning : what its heading says; unit : in which it is read; stated : whether the
    file or the user says it.
    """

    place: int
    heading: str
    meaning: Meaning
    unit: str
    stated: bool

    @property
    def quantity(self) -> str:
        """What its numbers are of: angular frequencies are frequencies, a phase angle gives tan delta."""
        return "tan delta" if self.meaning.name == "phase angle" else self.meaning.name.replace("angular ", "")


def columns_of(
    table: Table, named: Mapping[str, str], given: Mapping[str, str], fills: Mapping[str, str]
) -> tuple[list[Column], dict[str, str]]:
    """The columns whose meaning is known, and headings of the others -> why they are left aside ("": unknown).

    Parameters
    ----------
    table : with headings.
    named : meaning -> heading, of those that the user named.
    given : meaning -> unit that overrules the file.
    fills : unit of :data:`UNITS` -> unit of columns that have none.

    Raises
    ------
    ParameterError
        A heading that the table does not have.
    """
    owners = {_index(table, heading): name for name, heading in named.items()}
    columns: list[Column] = []
    aside: dict[str, str] = {}
    for index, (heading, row) in enumerate(zip(table.headings, table.units, strict=True)):
        said = meanings(heading, row)
        if index in owners:
            modes = [each.mode for each in said if each.mode] or [""]
            ways = sorted(readings(heading, row), key=lambda way: way.unit in NO_UNIT)
            said = [Meaning(owners[index], modes[0], way.unit, way.log) for way in ways]
        else:
            said = [meaning for meaning in said if meaning.name not in named]
        faults = [_contradiction(meaning, given) for meaning in said]
        if table.textual(index):
            aside[heading or f"column {index}"] = "no numbers"
        elif "" in faults:
            meaning = said[faults.index("")]
            stated = meaning.unit not in NO_UNIT or meaning.name in given
            columns.append(Column(index, heading, meaning, _unit(meaning, given, fills), stated))
        else:
            aside[heading or f"column {index}"] = (faults or [""])[0]
    return columns, aside


def _index(table: Table, heading: str) -> int:
    """Index of the column with a heading, with its unit or without; raises ParameterError."""
    found = find(table, heading)
    if found is None:
        allowed = f"one of {', '.join(map(repr, table.headings))}{suggestion(str(heading), table.headings)}"
        raise ParameterError("columns", f"{heading!r:.60}", allowed)
    return found


def _contradiction(meaning: Meaning, given: Mapping[str, str]) -> str:
    """Why a unit does not go with what a name says, "" where it does."""
    name, _, unit, _ = meaning
    if name in given or unit in NO_UNIT:
        return ""
    try:
        conversion(unit, UNITS[name])
    except ParameterError:
        return f"unit {unit!r} is none of {name}"
    if name in ("tan delta", "phase angle") and bool(_ANGLE.search(unit)) != (name == "phase angle"):
        return f"unit {unit!r} is none of {name}"
    if "angular" in name and unit.lower().endswith("hz"):
        return f"an angular frequency in {unit}: rename it, or give units="
    return ""


def _unit(meaning: Meaning, given: Mapping[str, str], fills: Mapping[str, str]) -> str:
    """The unit in which a column is read: as given, as the file says, as is given for all, else as assumed."""
    if meaning.name in given or meaning.unit not in NO_UNIT:
        return given.get(meaning.name, meaning.unit)
    assumed = "rad/s" if "angular" in meaning.name else _ASSUMED.get(UNITS[meaning.name], "")
    return fills.get(UNITS[meaning.name], assumed)


def numbers_of(table: Table, column: Column) -> Numbers:
    """The numbers of a column's quantity: rad/s, Pa, 1/Pa, tan delta, degC; with half a unit of their last digit.

    Raises
    ------
    FileError
        Cells that are no numbers; a unit that is missing and cannot be assumed.
    """
    name, unit = column.meaning.name, column.unit
    values, half = table.numbers(column.place)
    open_angle = name == "phase angle" and values.max() <= 0.5 * math.pi
    if not column.stated and (not unit or open_angle or (name == "temperature" and values.max() > _KELVIN)):
        problem = f"column {column.heading!r} has no unit, and goes to {values.max():g}: give units={{{name!r}: ...}}"
        raise FileError(table.path, problem)
    if column.meaning.log:
        values = 10.0**values
        half = values * math.log(10.0) * half
    factor, offset = conversion(unit, UNITS[name])
    if column.quantity.endswith("frequency") and "angular" not in name and not _CYCLES.search(unit):
        factor *= 2.0 * math.pi
    values, half = factor * values + offset, factor * half
    return Numbers(np.tan(values), half / np.cos(values) ** 2) if name == "phase angle" else Numbers(values, half)
