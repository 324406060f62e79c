"""Which columns of a table are frequency, moduli and temperature, and their numbers: :func:`choose_columns`."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.errors import FileError, ParameterError
from ...core.sections import hint
from ...io.measurements import NO_UNIT, Numbers, Table, conversion, find, readings
from .names import UNITS, Meaning, meanings

#: degrees; temperatures without a unit that go above it are taken to be kelvins
_KELVIN = 200.0
#: units of frequency that say revolutions or cycles, or radians; "1/s" and "1/min" say neither
_CYCLES = re.compile(r"(?i)hz|rpm|rad|rev|cycle|u/|r/|upm|deg|°")
_ANGLE = re.compile(r"(?i)rad|deg|°|º|grad")


@dataclass
class Columns:
    """Columns of a table by their meaning.

    table : the table.
    found : meaning -> its columns, as index and what the heading says.
    aside : headings of the others -> why, "" where nothing is to be said.
    given : meaning -> unit that overrules the file; default : units of frequency and moduli that have none, or None.
    assumed : "frequency", "moduli" -> unit that was assumed, for a warning.
    """

    table: Table
    given: Mapping[str, str]
    default: tuple[str, str] | None
    found: dict[str, list[tuple[int, Meaning]]] = field(default_factory=dict)
    aside: dict[str, str] = field(default_factory=dict)
    assumed: dict[str, str] = field(default_factory=dict)

    def heading(self, meaning: str) -> str:
        """The heading of the first column of a meaning."""
        return self.table.headings[self.found[meaning][0][0]]

    def unit(self, meaning: str, place: int = 0) -> str:
        """The unit in which a column is read: as given, as the file says, else as assumed."""
        name, unit = self.found[meaning][place][1].name, self.found[meaning][place][1].unit
        if meaning in self.given or unit not in NO_UNIT:
            return self.given.get(meaning, unit)
        if name == "temperature":
            return "degC"
        if name in ("tan delta", "phase angle"):
            return "1" if name == "tan delta" else "deg"
        if UNITS[name] == "rad/s":
            if self.default:
                return self.default[0]
            self.assumed["frequency"] = "rad/s" if name.endswith("angular frequency") else "Hz"
            return self.assumed["frequency"]
        others = [n for n in self.found if UNITS[n] == UNITS[name] for _, m in self.found[n] if m.unit not in NO_UNIT]
        if UNITS[name] != "Pa" or (others and not self.default):
            beside = f" beside {others[0]}, which has one" if others else ""
            raise FileError(
                self.table.path,
                f"column {self.heading(meaning)!r} has no unit{beside}: give units={{{meaning!r}: ...}}",
            )
        if self.default:
            return self.default[1]
        self.assumed["moduli"] = "Pa"
        return "Pa"

    def numbers(self, meaning: str, place: int = 0) -> Numbers:
        """The numbers of a column in the unit of :data:`UNITS`, with half a unit of their last digit.

        Raises
        ------
        FileError
            Cells that are no numbers; a unit that is missing.
        """
        index, said = self.found[meaning][place]
        values, half = self.table.numbers(index)
        unit, stated = self.unit(meaning, place), said.unit not in NO_UNIT or meaning in self.given
        if meaning == "phase angle" and not stated and values.max() <= 0.5 * math.pi:
            problem = f"{self.table.headings[index]!r} has no unit: give units={{{meaning!r}: 'deg'}}, or 'rad'"
            raise FileError(self.table.path, problem)
        if said.log:
            values = 10.0**values
            half = values * math.log(10.0) * half
        factor, offset = conversion(unit, UNITS[meaning])
        if UNITS[meaning] == "rad/s" and not meaning.endswith("angular frequency") and not _CYCLES.search(unit):
            factor *= 2.0 * math.pi
        if meaning == "temperature" and not stated and values.max() > _KELVIN:
            problem = f"{self.table.headings[index]!r} goes to {values.max():g} without a unit"
            raise FileError(self.table.path, f"{problem}: give units={{'temperature': 'K'}}, or 'degC'")
        return Numbers(factor * values + offset, factor * half)


def choose_columns(
    table: Table, named: Mapping[str, str], given: Mapping[str, str], default: tuple[str, str] | None
) -> Columns:
    """Columns by what their headings say.

    Parameters
    ----------
    table : with headings.
    named : meaning -> heading, of those that the user named.
    given : meaning -> unit that overrules the file.
    default : units of frequency and of moduli without one, or None.

    Raises
    ------
    ParameterError
        A heading that the table does not have.
    """
    columns = Columns(table, given, default)
    owners = {_index(table, heading): meaning for meaning, heading in named.items()}
    for index, (heading, row) in enumerate(zip(table.headings, table.units, strict=True)):
        if index in owners:
            columns.found[owners[index]] = [(index, _as_named(owners[index], heading, row))]
        elif table.empty(index):
            if heading:
                columns.aside[heading] = "empty"
        elif table.textual(index):
            columns.aside[heading or f"column {index}"] = "words"
        else:
            _file(columns, index, heading, row, set(named))
    return columns


def _file(columns: Columns, index: int, heading: str, row: str, named: set[str]) -> None:
    """File a column under its meaning, or leave it aside."""
    said, problem = meanings(heading, row), ""
    for meaning in said:
        problem = _contradiction(meaning, columns.given)
        if not problem and meaning.name not in named:
            columns.found.setdefault(meaning.name, []).append((index, meaning))
            return
    columns.aside[heading or f"column {index}"] = problem


def _contradiction(meaning: Meaning, given: Mapping[str, str]) -> str:
    """Why a unit does not go with what a name says, "" where it does."""
    unit = meaning.unit
    if meaning.name in given or unit in NO_UNIT:
        return ""
    try:
        conversion(unit, UNITS[meaning.name])
    except ParameterError:
        return f"unit {unit!r} is none of {meaning.name}"
    angle = bool(_ANGLE.search(unit))
    if (meaning.name == "tan delta" and angle) or (meaning.name == "phase angle" and not angle):
        return f"unit {unit!r} is none of {meaning.name}"
    if meaning.name.endswith("angular frequency") and unit.lower().endswith("hz"):
        return f"an angular frequency in {unit}: rename it, or give units="
    return ""


def _as_named(meaning: str, heading: str, row: str) -> Meaning:
    """What a heading says of a column whose meaning the user named: its unit, logarithm, and mode if it has one."""
    modes = [said.mode for said in meanings(heading, row) if said.mode]
    for reading in readings(heading, row):
        said = Meaning(meaning, modes[0] if modes else "", reading.unit, reading.log)
        if reading.unit not in NO_UNIT and not _contradiction(said, {}):
            return said
    return Meaning(meaning, modes[0] if modes else "", row, readings(heading, row)[0].log if heading else False)


def _index(table: Table, heading: str) -> int:
    """Index of the column with a heading, with its unit or without; raises ParameterError."""
    found = find(table, heading)
    if found is None:
        allowed = f"one of {', '.join(map(repr, table.headings))}{hint(str(heading), table.headings)}"
        raise ParameterError("columns", f"{heading!r:.60}", allowed)
    return found
