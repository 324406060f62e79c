"""Columns of a table by the name that the user gives: :func:`find` and :func:`quantity`."""

from __future__ import annotations

from collections.abc import Iterable

from ...core.array_types import Floats
from ...core.errors import FileError
from ...core.sections import suggestion
from .cells import Table
from .headings import NO_UNIT, conversion, readings


def named(name: str, heading: str) -> bool:
    """Whether a heading is a name, or that name with a unit."""
    return name == heading or any(not way.log and way.name == name for way in readings(heading))


def is_heading(names: Iterable[str], cells: list[str]) -> bool:
    """Whether one of the cells of a line is one of these names, with a unit or without."""
    return any(named(name, cell) for name in names for cell in cells if cell)


def find(table: Table, name: str) -> int | None:
    """Index of the column of a name: of that very heading, else of one that has a unit beside; None where none is.

    Raises
    ------
    FileError
        Several columns of that name.
    """
    exact = [n for n, heading in enumerate(table.headings) if heading == name]
    found = exact or [n for n, heading in enumerate(table.headings) if named(name, heading)]
    if len(found) > 1:
        both = " and ".join(repr(table.headings[n]) for n in found)
        raise FileError(table.path, f"columns {both} are both named {name!r}: name one of them with its unit")
    return found[0] if found else None


def missing(table: Table, name: str) -> FileError:
    """The error where no column has a name; it lists those that there are."""
    return FileError(
        table.path, f"has no column {name!r}, but {', '.join(table.headings)}{suggestion(name, table.headings)}"
    )


def quantity(table: Table, name: str, wanted: str, unit: str = "") -> Floats:
    """The numbers of the column of a name in the unit that is wanted.

    Parameters
    ----------
    table : with headings.
    name : of the column, with its unit or without.
    wanted : unit in pint's spelling, "1" of a ratio.
    unit : in place of the one that the file gives.

    Returns
    -------
    values, shape (n,)

    Raises
    ------
    FileError
        No such column, cells that are no numbers.
    ParameterError
        A unit that is unknown or of another dimension.
    """
    index = find(table, name)
    if index is None:
        raise missing(table, name)
    if table.parts > 1:
        raise FileError(table.path, f"has {table.parts} tables: keep one of them")
    ways = readings(table.headings[index], table.units[index])
    own = next((way.unit for way in ways if way.name == name), "")
    own = own or next((way.unit for way in ways if way.unit not in NO_UNIT), "")
    given = unit or own
    factor, offset = (1.0, 0.0) if given in NO_UNIT else conversion(given, wanted)
    return factor * table.numbers(index).values + offset
