"""The table in a text file: its headings, its row of units and its rows of numbers
(:func:`read_table`); and columns by the name that the user gives (:func:`named_table`,
:func:`find_column`).
"""

import re
import statistics
from collections.abc import Callable, Collection
from itertools import pairwise
from typing import Any, NamedTuple

from ..core import FileError, FilePath, ParameterError, is_unit, suggestion
from .text_cells import (
    NO_UNIT,
    SEPARATORS,
    Line,
    Numbers,
    are_numbers,
    cut_by_blanks,
    cut_lines,
    decimal_mark,
    fault_of,
    is_number,
    may_be_unit,
    numbers_of,
    read_lines,
    readings,
    separator_of,
)

# --- The table in a text file ---

#: blanks between words of one heading, where blanks separate headings
_PHRASE = re.compile(
    r"(?i)\s+(?=[\[(])|(?<=\bstorage)\s+|(?<=\bloss)\s+|(?<=\bangular)\s+|(?<=\bcomplex)\s+|(?<=\btan)\s+(?=d)"
    r"|(?<=\bphase)\s+|(?<=\breduced)\s+|(?<=\belastic)\s+|(?<=\bviscous)\s+|(?<=\bpoint)\s+(?=no)"
)
#: function of the cells of a line that returns whether they are headings
HeadingTest = Callable[[list[str]], bool]


class Table(NamedTuple):
    """A table of a text file.

    path : path of the file.
    headings : one a column; "column 0" and so on where the file has none.
    units : the cell of a row of units below each heading, "" without; one a column.
    rows : the lines of numbers, :class:`Line` each, of which all cells beyond the headings are
    empty.
    starts : numbers of the first lines of rows of the tables of the file, with the same headings,
        of which these are the rows.
    without_headings : whether the file has no headings.
    decimal : the decimal mark, "" where it cannot be told from a separator of thousands.
    titles : number -> text of the lines that are neither rows nor headings, nor blank.
    """

    path: FilePath
    headings: list[str]
    units: list[str]
    rows: list[Line]
    starts: list[int]
    without_headings: bool
    decimal: str
    titles: dict[int, str]

    def error(self, problem: str) -> FileError:
        """Return the error, not raised, of the file with a ``problem``."""
        return FileError(self.path, problem)

    def has_numbers(self, column: int) -> bool:
        """Return whether any cell of the column with an index is a number."""
        return any(is_number(row.cells[column]) for row in self.rows)

    def numbers(self, column: int) -> Numbers:
        """Return the numbers of a column, with half a unit of their last digits.

        column : index of the column, from 0; one beyond the headings raises IndexError.
        Returns :class:`text_cells.Numbers`, two arrays (rows,), in the unit of the file; numbers
        beyond the doubles are infinite.
        Raises FileError, with the number of the line, for a gap, a text, the other decimal mark,
        and a mark that may be a separator of thousands: both marks in one column, or three digits
        after each mark beside a cell of three digits.
        """
        cells = [row.cells[column] for row in self.rows]
        # beside "567" a "1.234" may be the next thousand
        threes = any(len(cell) == 3 and cell.isdigit() for cell in cells)
        decimal = decimal_mark(cells, ",." * threes) and self.decimal
        for row, cell in zip(self.rows, cells):
            if fault := fault_of(cell, decimal):
                raise self.error(
                    f"line {row.number}, column {self.headings[column]!r}: {cell!r} {fault}"
                )
        return numbers_of(cells)

    def refuse_several(self) -> None:
        """Raise FileError for a file with several tables."""
        if len(self.starts) > 1:
            raise self.error(
                f"has {len(self.starts)} tables (their rows begin in lines "
                f"{', '.join(map(str, self.starts))}): keep one of them in the file"
            )

    def require(self, holds: Any, problem: str) -> None:
        """Raise FileError, with the number and the cells of its line, for the first row for which a
        condition does not hold.

        holds : whether it holds for each row, shape (rows,), an array of truth values.
        problem : words on the fault where it does not hold, which end the message.
        """
        if not holds.all():
            row = self.rows[holds.argmin()]
            raise self.error(f"line {row.number} ({'; '.join(row.cells):.60}): {problem}")


def read_table(
    path: FilePath,
    is_heading_line: HeadingTest,
    decimal: str | None,
    encoding: str | None,
    is_title: Callable[[str], Any] = lambda text: False,
    footers: bool = True,
) -> Table:
    """Read the table of a text file, which may have a preamble, comments, and several tables with
    the same headings.

    The separator is that by which most lines are rows of numbers.  Headings are the last line above
    the numbers that ``is_heading_line`` accepts; if it accepts none, the last line above the first
    row of numbers that has no number, is no comment and no row of units; if there is none either,
    columns are named "column 0", "column 1" and so on.  Lines below the last row, as the footers of
    instruments, are titles.

    Parameters
    ----------
    path : a text file in UTF-8, UTF-16, cp1252 or Latin-1.
    is_heading_line : a function of the cells of a line, a list of texts, that returns whether they
        are headings.
    decimal : "." or ","; None: the mark that is there.  Where a mark may be a separator of
        thousands too, the table is returned with ``decimal`` "", and :meth:`Table.numbers` refuses
        numbers with a mark.
    encoding : name of the encoding, as Python calls it; None: as in :func:`.text_cells.read_lines`.
    is_title : a function of the text of a line that returns whether the line may stand between
        rows, as one that states the temperature of those below; lines with two numbers and more in
        cells of their own are rows all the same.
    footers : whether lines below the last row may be other than rows; False: they are refused.

    Returns
    -------
    Table
        The rows of all tables of the file, one after the other.

    Raises
    ------
    FileError
        A file that cannot be read, that is no text, or has no row of numbers; several tables with
        different headings or rows of units; rows or headings of unlike numbers of cells; rows of
        numbers above the headings; a line among the rows, or between them and the headings, that is
        neither numbers nor units, and no comment and no title (``is_title``); no headings, but a
        comment with names of columns whose separators are not those of the numbers.
    ParameterError
        A decimal mark that is neither; an encoding that Python does not know.
    """
    if decimal not in (None, ".", ","):
        raise ParameterError("decimal", f"{decimal!r:.20}", "'.' or ','")
    text = read_lines(path, encoding)
    separator = separator_of(text, decimal)
    lines = [
        line._replace(
            numeric=line.numeric
            and not (sum(map(is_number, line.cells)) < 2 and is_title(line.text))
        )
        for line in cut_lines(text, separator)
    ]
    widths = [len(line.cells) for line in lines if line.numeric]
    if not widths:
        raise FileError(
            path,
            "has no line of numbers: choose a text file with columns of numbers, separated by "
            "tabs, semicolons, bars, commas or blanks",
        )
    layout = _Layout(
        path=path,
        lines=lines,
        separator=separator,
        width=statistics.mode(widths),
        cut=f"separated by {SEPARATORS[separator]}",
        is_heading_line=is_heading_line,
        is_title=is_title,
        footers=footers,
    )
    heads = layout.heads()
    parts = [layout.part(*ends) for ends in pairwise([*heads, len(lines)])]
    headings, units, _ = parts[0]
    starts = [rows[0].number for *_, rows in parts]
    if any(part[:2] != (headings, units) for part in parts):
        raise FileError(
            path,
            f"has {len(parts)} tables with different headings (their rows begin in lines "
            f"{', '.join(map(str, starts))}): keep one of them in the file",
        )
    rows = [row for *_, rows in parts for row in rows]
    known = {line.number for line in (*rows, *(lines[head] for head in heads))}
    titles = {n: line for n, line in enumerate(text, 1) if n not in known and line.strip()}
    decimal = decimal or decimal_mark(
        [cell for row in rows for cell in row.cells], "," if separator == "," else ""
    )
    without_headings = lines[heads[0]].number == starts[0]
    return Table(
        path=path,
        headings=headings,
        units=units,
        rows=rows,
        starts=starts,
        without_headings=without_headings,
        decimal=decimal,
        titles=titles,
    )


class _Layout(NamedTuple):
    """Where the tables of a file are: their lines of headings, rows of units and rows of numbers.

    path : path of the file.
    lines : lines of the file with their cells.
    separator : separator of the cells, a key of ``SEPARATORS``.
    width : most frequent number of cells of rows of numbers, of several that are as frequent the
        one that occurs first.
    cut : words on the separator, for messages.
    is_heading_line, is_title, footers : as in :func:`read_table`.
    """

    path: FilePath
    lines: list[Line]
    separator: str
    width: int
    cut: str
    is_heading_line: HeadingTest
    is_title: Callable[[str], Any]
    footers: bool

    def fault(self, line: Line, problem: str) -> FileError:
        """Return the error, not raised, that names a ``line``, states a ``problem`` and quotes 60
        characters of it.
        """
        return FileError(self.path, f"line {line.number} ({line.text[:60]!r}) {problem}")

    def is_row(self, line: Line) -> bool:
        """Return whether a line is a row of numbers, and either as wide as most of these, or of two
        numbers and more without texts.

        line: the line with its cells.
        """
        return line.numeric and (len(line.cells) == self.width or are_numbers(line.cells))

    def heads(self) -> list[int]:
        """Return the index, in ``lines``, of the line of headings of each table of the file,
        ascending, at least one.

        Lines that ``is_heading_line`` accepts and that have numbers below them begin a table each.
        If there is none, the last line above the numbers that has none and is no comment is taken
        for headings, or the line before if it is a row of units.  If there is none either,
        ``lines`` is changed: a new line "column 0", "column 1" and so on replaces all lines above
        the numbers, and [0] is returned.

        Raises FileError for rows of numbers above the headings; in a file without headings for a
        line above the numbers that has as many cells and is no comment, and for a comment with
        names of columns whose separators are not those of the numbers.
        """
        lines = self.lines
        width = self.width
        heads = [
            n
            for n, line in enumerate(lines)
            if not line.numeric and self.is_heading_line(self.headings(line))
        ]
        # of several lines of headings above the same numbers the last one counts
        # (line of headings, next such line or the end of the file)
        ends = pairwise([*heads, len(lines)])
        heads = [head for head, end in ends if any(line.numeric for line in lines[head:end])]
        if heads:
            for line in lines[: heads[0]]:
                if line.numeric and len(line.cells) == width and are_numbers(line.cells):
                    raise self.fault(
                        line,
                        "has numbers above the headings: keep one table, and remove the lines "
                        "above its headings",
                    )
            return heads
        first = next(n for n, line in enumerate(lines) if line.numeric and len(line.cells) == width)
        above = [
            n
            for n, line in enumerate(lines[:first])
            if not (line.comment or any(map(is_number, line.cells)))
        ]
        if above:
            last = above[-1]
            alike = len(above) > 1 and len(lines[last - 1].cells) == len(lines[last].cells)
            # the last line above the numbers may be the row of units of the line before
            return [last - 1 if alike and _are_units(self.headings(lines[last])) else last]
        for line in lines[:first]:
            if not line.comment and len(line.cells) == width:
                raise self.fault(
                    line,
                    "has numbers and more texts, so that it is neither a line of headings nor one "
                    "of numbers: correct it, remove it, or begin it with #",
                )
        for line in lines:
            if line.comment and self.is_heading_line(re.split(r"[\s,;|]+", line.text)):
                raise self.fault(
                    line,
                    "contains column names, but its separators differ from those of the numbers: "
                    f"write {width} names {self.cut}",
                )
        names = [f"column {n}" for n in range(width)]
        lines[:first] = [lines[first]._replace(cells=names, numeric=False)]
        return [0]

    def part(self, head: int, end: int) -> tuple[list[str], list[str], list[Line]]:
        """Read one table of the file.

        head, end : index, in ``lines``, of its line of headings, and of the first line after the
            table: the headings of the next table, or the end of the file.
        Returns (headings, without empty ones at the end; units as the file spells them, "" where
        none is given, as many as headings; rows, a list of :class:`Line` without comments, of which
        lines before the next headings that are no rows, as a title, are left out).
        Raises FileError for a line among the rows that is no row, no comment and no title, for rows
        with fewer cells than headings or with texts beyond the last heading, and as :meth:`units`
        for a line above them.
        """
        line, *body = self.lines[head:end]
        names = self.headings(line)
        first = [each.numeric for each in body].index(True)
        while not names[-1]:  # separators at the end of a line make empty cells
            names.pop()
        rows = [
            row
            for row in body[first:]
            if row.numeric or not (row.comment or self.is_title(row.text))
        ]
        # titles of the next table, or a footer
        while self.footers and len(rows) > 1 and not self.is_row(rows[-1]):
            rows.pop()
        for row in rows:
            if not row.numeric:
                advice = "; if it is the temperature of the lines below, write 'Temperature 20 °C'"
                raise self.fault(
                    row,
                    "is not a line of numbers: remove it, or begin it with #"
                    f"{advice * self.footers}",
                )
            if any(row.cells[len(names) :]) or len(row.cells) < len(names):
                raise self.fault(
                    row,
                    f"has {len(row.cells)} cell{'s' * (len(row.cells) > 1)} {self.cut}, but line "
                    f"{line.number}, the first of the table, has {len(names)}: correct one of them",
                )
        return names, self.units(body[:first], len(names)), rows

    def headings(self, line: Line) -> list[str]:
        """Return the cells of a line of headings or of units, a new list of texts.

        Where blanks separate and the line has another number of cells than the rows, it is cut
        again: first with words of one name, as "storage modulus", kept together, then only at two
        blanks and more.  The first of these that gives as many cells as the rows have is taken,
        else the first.  A blank within brackets becomes "·".

        line : :class:`Line`, a line of headings or of units.
        """
        if self.separator != " " or len(line.cells) == self.width:
            return [*line.cells]
        text = re.sub(r"[\[(][^\])]*[\])]", lambda found: found[0].replace(" ", "·"), line.text)
        cuts = [cut_by_blanks(_PHRASE.sub("", text)), re.split(r"\s{2,}|\t", text)]
        return next((cells for cells in cuts if len(cells) == self.width), cuts[0])

    def units(self, between: list[Line], width: int) -> list[str]:
        """Find the row of units between headings and numbers: a line in which at least half of the
        texts are units.

        between : lines between headings and numbers, comments too, :class:`Line` each, which may be
        none.
        width : number of columns, those of the headings.
        Returns a list of ``width`` texts, the unit of each column as the file spells it, with its
        brackets; "" for a column without one, and for all columns if there is no row of units.
        Raises FileError for another line there that is neither a comment nor a title
        (``is_title``); a second row of units is such a line.
        """
        units = [""] * width
        for line in between:
            # a row of units is cut as headings are
            cells = self.headings(line)
            fits = len(cells) == width or (self.separator != " " and not any(cells[width:]))
            if fits and _are_units(cells) and not any(units):
                units = (cells + units)[:width]  # "" behind a line that is shorter
            elif not (line.comment or self.is_title(line.text)):
                raise self.fault(
                    line,
                    "below the headings is neither a line of numbers nor the only line of known "
                    f"units {self.cut}: correct it, remove it, or begin it with #",
                )
        return units


def _are_units(cells: list[str]) -> bool:
    """Return whether at least half of the ``cells`` that are not empty are units."""
    texts = [cell.strip("[](){}<> ") for cell in cells if cell]
    units = [text in NO_UNIT or (may_be_unit(text) and is_unit(text)) for text in texts]
    return 2 * sum(units) >= len(texts)


# --- Columns of a table by the name that the user gives ---


def named_table(
    path: FilePath, names: Collection[str], decimal: str | None = None, encoding: str | None = None
) -> Table:
    """Read a table of which the user has named columns: its headings are the line that has one of
    these names.

    A cell has a name if it is the name, alone or with a unit.

    path : path of the file.
    names : names of columns; where no line has any, headings are found as in :func:`read_table`,
    above the numbers.
    decimal : decimal mark, "." or ","; None: the one that the file has.
    encoding : name of the encoding, as Python calls it; None: UTF-16 by the first bytes, else the
        first of UTF-8, cp1252 and Latin-1 that fits.
    Returns the :class:`Table`; raises the errors of :func:`read_table`, and none for names that are
    missing.  A line below the last row that is no row is an error too.
    """
    return read_table(
        path,
        lambda cells: any(_is_named(cell, name) for name in names for cell in cells if cell),
        decimal,
        encoding,
        footers=False,
    )


def _is_named(heading: str, name: str) -> bool:
    """Return whether a heading of a file is a name, alone or with a unit.

    A heading of logarithms, as "log10(f/Hz)", must be equal to the name, so that who names it has
    seen what it is.

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
        headings = [table.headings[n] for n in found]
        alike = exact or len({*headings}) < len(headings)
        advice = "rename or remove one of them" if alike else "give the heading with its unit"
        raise table.error(
            f"columns {' and '.join(map(repr, headings))} have the same name {name!r}: {advice}"
        )
    return found[0] if found else None


def missing_column(table: Table, name: str, advice: str = "") -> FileError:
    """Return the FileError, not raised, where no column of a table has a name; it lists the
    headings of the table, and names the most similar one if any is similar.

    table: :class:`Table`, whose path and headings are read.
    name: the name that the user gives.
    advice: words with their punctuation that end the message, as ": name one of these"; "" for
    none.
    """
    return table.error(
        f"has no column {name!r}; its columns are {', '.join(map(repr, table.headings))}"
        f"{suggestion(name, table.headings)}{advice}"
    )
