"""Columns of a table by the name that the user gives: :func:`named_table`, :func:`column_in_unit`."""

from __future__ import annotations

import warnings
from collections.abc import Collection
from os import PathLike

from ...core.array_types import Floats
from ...core.errors import FileError, ModelWarning, caller_level
from ...core.sections import suggestion
from .headings import NO_UNIT, conversion, readings
from .table import Table, read_table


def named_table(
    path: str | PathLike[str], names: Collection[str], decimal: str | None = None, encoding: str | None = None
) -> Table:
    """Read a table of which the user has named columns: its headings are the line that has one of these names.

    A cell has a name if it is the name, alone or with a unit.

    path : path of the file.
    names : names of columns; where no line has any, headings are found as of :func:`read_table`, above the numbers.
    decimal : decimal mark, "." or ","; None: the one that the file has.
    encoding : name of the encoding, as Python calls it; None: UTF-16 by the first bytes, else the first of UTF-8,
        cp1252 and Latin-1 that fits.
    Returns the :class:`Table`; raises the errors of :func:`read_table`, and none for names that are missing.
    """
    return read_table(
        path, lambda cells: any(_is_named(cell, name) for name in names for cell in cells if cell),
        decimal=decimal, encoding=encoding,
    )  # fmt: skip


def _is_named(heading: str, name: str) -> bool:
    """Return whether a heading of a file is a name, alone or with a unit.

    A heading of logarithms, as "log10(f/Hz)", must be equal to the name, so that who names it has seen what it is.

    heading: text of the heading.
    name: the name that the user gives.
    """
    return name == heading or any(not each.log and each.name == name for each in readings(heading))


def find_column(table: Table, name: str) -> int | None:
    """Return the index of the column with a name, from 0; None where there is none.

    Columns whose whole heading is the name are preferred to those with the name and a unit.

    table : :class:`Table`, whose headings are searched.
    name : a heading as the file has it, or without its unit; "column 0" and so on of an empty one.

    Raises
    ------
    FileError
        Several columns have that name.
    """
    exact = [n for n, heading in enumerate(table.headings) if (heading or f"column {n}") == name]
    found = exact or [n for n, heading in enumerate(table.headings) if _is_named(heading, name)]
    if len(found) > 1:
        headings = " and ".join(repr(table.headings[n]) for n in found)
        advice = "rename or remove one in the file" if exact else "name one of them with its unit"
        raise FileError(table.path, f"columns {headings} are both named {name!r}: {advice}")
    return found[0] if found else None


def missing_column(table: Table, name: str, advice: str = "") -> FileError:
    """Return the FileError, not raised, where no column of a table has a name; it lists the headings of the table, and
    names the most similar one if any is similar.

    table: :class:`Table`, whose path and headings are read.
    name: the name that the user gives.
    advice: words with their punctuation that end the message, as ": name one of these"; "" for none.
    """
    found = f"{', '.join(table.headings)}{suggestion(name, table.headings)}"
    return FileError(table.path, f"has no column {name!r}, but {found}{advice}")


def column_in_unit(table: Table, name: str, wanted: str, unit: str = "") -> Floats:
    """Return the numbers of the column with a name, converted to a unit.

    Parameters
    ----------
    table : :class:`Table`, a table with headings.
    name : name of the column, with its unit or without.
    wanted : unit of the result in pint's spelling, "1" of a ratio.
    unit : unit of the numbers in the file, in place of the one that the file gives; "": that of the heading or of the
        row of units.  Where none is given, or it is a sign as "-" or "1", the numbers are taken to be in ``wanted``,
        with a warning unless that is "1" or "" itself.

    Returns
    -------
    array of shape (n,)
        The numbers, in the unit ``wanted``, float64; of a heading of logarithms the numbers of which they are.

    Raises
    ------
    FileError
        No such column, several columns of that name, several tables in the file, cells that are no numbers, gaps, or
        marks that may be separators of thousands (:meth:`Table.numbers`).
    ParameterError
        A unit that is unknown or of another dimension.

    Warns
    -----
    ModelWarning
        A column without a unit, whose numbers are taken to be in ``wanted``.
    """
    index = find_column(table, name)
    if index is None:
        raise missing_column(table, name)
    if len(table.starts) > 1:
        raise FileError(table.path, f"has {len(table.starts)} tables: keep one of them")
    found = readings(table.headings[index], table.units[index])
    named = [each for each in found if each.name == name]
    unit = unit or next((each.unit for each in [*named, *found] if each.unit not in NO_UNIT), "")
    if unit in NO_UNIT and wanted not in ("", "1"):
        heading = table.headings[index]
        advice = f"write its unit in the heading, as in '{heading} [{wanted}]'"
        text = f"{table.path}: column {heading!r} has no unit, and is taken in {wanted}: {advice}"
        warnings.warn(text, ModelWarning, stacklevel=caller_level())
    factor, offset = (1.0, 0.0) if unit in NO_UNIT else conversion(unit, wanted)
    values = table.numbers(index).values
    base = found[0].log if found else 0.0
    return factor * (base**values if base else values) + offset
