"""The table in a text file: its headings, its row of units, its cells, and numbers of a column."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from ...core.errors import FileError, ParameterError
from ...core.units import is_unit
from .headings import NO_UNIT, looks_like_unit

#: separators of cells, the surest first; then blanks
_SEPARATORS = {"\t": "tabs", ";": "semicolons", "|": "bars", ",": "commas", " ": "blanks"}
_NUMBER = re.compile(r"[+-]?(\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD]([+-]?\d+))?")
#: numbers with separators of thousands, as "1,234.5" and "1.234.567"
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:[,.'\u202f’]\d{3})+(?:[.,]\d*)?")
#: what may be a number with a separator of thousands, or with three decimals
_THOUSAND = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")
#: what stands in place of a number that was not measured
_GAP = re.compile(r"(?i)-*|nan|n/?a|null|none|\*+|#n/?a|#wert!|#value!|[+-]?inf(inity)?|\?+")
#: cells that are neither numbers nor gaps in a row of numbers: words, dates, times
_TEXT = re.compile(r".*[^\W\d_].*|\d+[-:./]\d+[-:./]\d+.*|\d+:\d+.*")
_COMMENT = re.compile(r"\s*(?:[#%!]+|//)\s*")
#: blanks between words of one heading, where blanks part headings
_PHRASE = re.compile(
    r"(?i)\s+(?=[\[(])|(?<=\bstorage)\s+|(?<=\bloss)\s+|(?<=\bangular)\s+|(?<=\bcomplex)\s+|(?<=\btan)\s+(?=d)"
    r"|(?<=\bphase)\s+|(?<=\breduced)\s+|(?<=\belastic)\s+|(?<=\bviscous)\s+|(?<=\bpoint)\s+(?=no)"
)
#: lines of a file by which its separator is found
_SOME = 2000
#: first bytes -> encoding; without any of them UTF-8, else that of Windows, else ISO 8859-1, which has all bytes
_MARKS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
_WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


class Numbers(NamedTuple):
    """Numbers of a column, shape (n,).

    values : as written; half : half a unit of the last digit that each was written with, by which it may be off.
    """

    values: Floats
    half: Floats


class _Line(NamedTuple):
    """A line that is not blank: its number, its text, its cells, whether a comment, whether a row of numbers."""

    number: int
    text: str
    cells: list[str]
    comment: bool
    numeric: bool


@dataclass(frozen=True)
class Table:
    """A table of a text file.

    path : of the file.
    headings : one a column; "column 0" and so on where the file has ``bare`` numbers.
    units : what a row of units below the headings has, "" elsewhere, one a column.
    rows, lines : cells of each row of numbers, and the number of its line.
    parts : number of tables of the file that these rows are from.
    bare, decimal : whether there are no headings; the decimal mark.
    """

    path: str | PathLike[str]
    headings: tuple[str, ...]
    units: tuple[str, ...]
    rows: list[list[str]]
    lines: list[int]
    parts: int = 1
    bare: bool = False
    decimal: str = "."

    def textual(self, column: int) -> bool:
        """Whether no cell of a column is a number."""
        return not any(_is_number(row[column]) for row in self.rows)

    def numbers(self, column: int) -> Numbers:
        """The numbers of a column.

        Raises
        ------
        FileError
            A gap, a text, a separator of thousands, or the other decimal mark, with its line.
        """
        values, half = np.empty((2, len(self.rows)))
        cells = [row[column] for row in self.rows]
        marked = [cell for cell in cells if "," in cell or "." in cell]
        # "1,234" beside "567": three digits behind each mark, and whole numbers of three digits
        doubtful = all(map(_THOUSAND.fullmatch, marked)) and any(len(cell) == 3 and cell.isdigit() for cell in cells)
        for n, cell in enumerate(cells):
            found = _NUMBER.fullmatch(cell)
            if found is None or ".,".replace(self.decimal, "") in cell or (doubtful and cell in marked):
                at = f"line {self.lines[n]}, column {self.headings[column]!r}: {cell!r}"
                raise FileError(self.path, f"{at} {_fault_of(cell, self.decimal)}")
            digits, power = found[1].replace(",", "."), int(found[2] or 0)
            values[n] = float(f"{'-' * cell.startswith('-')}{digits}e{power}")
            half[n] = 0.5 * 10.0 ** min(power - len(digits.partition(".")[2]), 300)
        return Numbers(values, half)


def _fault_of(cell: str, decimal: str) -> str:
    """Why a cell is no number."""
    if _GAP.fullmatch(cell):
        return "is a gap: leave out its row"
    if _THOUSANDS.fullmatch(cell):
        return "may have a separator of thousands: write it without"
    return f"is no number with a decimal {'comma' if decimal == ',' else 'point'}"


def _is_number(cell: str) -> bool:
    """Whether a cell is a number, perhaps with separators of thousands."""
    return bool(_NUMBER.fullmatch(cell) or _THOUSANDS.fullmatch(cell))


def read_table(
    path: str | PathLike[str], known: Callable[[list[str]], bool], *,
    decimal: str | None = None, encoding: str | None = None,
) -> Table:  # fmt: skip
    """Read the table of a text file: preambles, comments, several tables with the same headings.

    The separator is that by which most lines are rows of numbers.  Headings are the last line before the numbers whose
    cells are ``known``, else the line above the first row.  Python's csv cuts lines into cells: pandas expects all
    lines of a file to be as wide as its table.

    Parameters
    ----------
    path : a text file in UTF-8, UTF-16 or Latin-1.
    known : cells of a line -> whether they are headings.
    decimal : "." or ","; default: the mark that is there, both are refused.
    encoding : as Python calls it; default: by the first bytes.

    Returns
    -------
    Table

    Raises
    ------
    FileError
        A file that cannot be read, that is no text, or has no table; rows or headings of unlike numbers of cells.
    ParameterError
        A decimal mark or an encoding that is none.
    """
    if decimal not in (None, ".", ","):
        raise ParameterError("decimal", f"{decimal!r:.20}", "'.' or ','")
    text = re.split(r"\r\n|\r|\n", _text(path, encoding).replace("\u2212", "-"))
    if re.fullmatch(r"(?i)sep=.\s*", text[0]):  # a line by which Excel is told
        text[0] = ""
    separator = max((each for each in _SEPARATORS if each != decimal), key=lambda each: _fitting(text, each))
    lines = [line for line in _cut(text, separator) if any(line.cells)]
    if not any(line.numeric for line in lines):
        raise FileError(path, "has no row of numbers")
    tables = _tables(path, lines, known, _SEPARATORS[separator])
    first = tables[0]
    if any((table.headings, table.units) != (first.headings, first.units) for table in tables):
        starts = ", ".join(str(table.lines[0]) for table in tables)
        raise FileError(path, f"has {len(tables)} tables with unlike headings (from lines {starts}): keep one of them")
    rows = [row for table in tables for row in table.rows]
    numbers = [line for table in tables for line in table.lines]
    whole = replace(first, rows=rows, lines=numbers, parts=len(tables))
    return replace(whole, decimal=decimal or _mark(whole, separator))


def _text(path: str | PathLike[str], encoding: str | None) -> str:
    """The text of a file; workbooks and other binary files are refused."""
    try:
        raw = Path(path).read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})") from error
    if raw.startswith(_WORKBOOKS):
        raise FileError(path, "is a workbook or an archive, no text: save its sheet as CSV")
    marked = "utf-16-le" if raw[1:2] == b"\0" else "utf-16-be" if raw[:1] == b"\0" else None
    given = encoding or _MARKS.get(raw[:2], marked)
    for name in [given] if given else ["utf-8-sig", "cp1252", "latin-1"]:
        try:
            found = raw.decode(name).removeprefix("\ufeff")
        except LookupError:
            raise ParameterError("encoding", f"{name!r:.40}", "an encoding that Python knows, as 'utf-8'") from None
        except UnicodeError as error:
            problem = f"cannot be read in {name} ({error})"
            continue
        if "\0" in found:
            raise FileError(path, "is no text: it has null bytes")
        return found
    raise FileError(path, problem)


def _cut(text: list[str], separator: str) -> Iterator[_Line]:
    """Lines with their cells; quoted cells may go on over several lines."""
    if separator == " ":
        cut = ((n, line, _by_blanks(line)) for n, line in enumerate(text, 1))
    else:
        reader = csv.reader((line + "\n" for line in text), delimiter=separator, skipinitialspace=separator != "\t")
        cut = ((reader.line_num, text[reader.line_num - 1], [" ".join(c.split()) for c in row]) for row in reader)
    for number, line, cells in cut:
        mark = _COMMENT.match(line)
        if mark and separator == " ":
            cells = _by_blanks(line[mark.end() :])  # noqa: PLW2901
        elif mark and cells and (bare := _COMMENT.sub("", cells[0], count=1)):
            cells[0] = bare
        else:  # a first cell of "%" alone is a unit, of "#" a number of points
            mark = None
        others = [cell for cell in cells if not _is_number(cell) and not _GAP.fullmatch(cell)]
        numbers = sum(map(_is_number, cells))
        numeric = not mark and 0 < numbers >= len(others) and all(map(_TEXT.fullmatch, others))
        yield _Line(number, line.strip(), cells, bool(mark), numeric)


def _by_blanks(line: str) -> list[str]:
    return [quoted or bare for quoted, bare in re.findall(r'"([^"]*)"|(\S+)', line)]


def _fitting(text: list[str], separator: str) -> int:
    """How many lines of a file a separator cuts into rows of numbers of one width, of two cells and more."""
    try:
        widths = Counter(len(line.cells) for line in _cut(text[:_SOME], separator) if line.numeric)
    except csv.Error:
        return 0
    return max((count for width, count in widths.items() if width > 1), default=0)


def _tables(path: str | PathLike[str], lines: list[_Line], known: Callable[[list[str]], bool], by: str) -> list[Table]:
    """The tables of a file: one below each line of headings that are known, else all rows of numbers."""
    width = Counter(len(line.cells) for line in lines if line.numeric).most_common(1)[0][0]
    heads = [n for n, line in enumerate(lines) if not line.numeric and known(_headings(line, width, by))]
    # of several lines of headings above the same numbers the last is meant
    ends = zip(heads, [*heads, len(lines)][1:])
    spans = [(head, end) for head, end in ends if any(line.numeric for line in lines[head:end])]
    if not spans:
        first = next(n for n, line in enumerate(lines) if line.numeric and len(line.cells) == width)
        above = [n for n, line in enumerate(lines[:first]) if not line.comment and not line.numeric]
        spans = [(above[-1] if above else -1, len(lines))]
        for line in lines if not above else ():
            if line.comment and known(re.split(r"[\s,;|]+", line.text)):
                problem = f"line {line.number} names columns, but is not cut by {by} into {width} as the rows"
                raise FileError(path, f"{problem}: {line.text[:60]!r}")
    for line in lines[: max(spans[0][0], 0)]:
        if line.numeric and len(line.cells) == width and _plain(line.cells):
            raise FileError(path, f"line {line.number} has numbers above the headings: keep one table of the file")
    return [_table(path, lines, *span, width, by) for span in spans]


def _plain(cells: list[str]) -> bool:
    """Whether cells are two numbers and more, without words between them."""
    filled = [cell for cell in cells if cell]
    return len(filled) > 1 and all(map(_NUMBER.fullmatch, filled))


def _table(path: str | PathLike[str], lines: list[_Line], head: int, end: int, width: int, by: str) -> Table:
    """The rows of numbers between a line of headings (-1: none) and the next one or the end of the file."""
    body, last = lines[head + 1 : end], end == len(lines)
    first = next(n for n, line in enumerate(body) if line.numeric and (head >= 0 or len(line.cells) == width))
    names = _headings(lines[head], width, by) if head >= 0 else [f"column {n}" for n in range(width)]
    while not names[-1]:
        names.pop()
    rows: list[_Line] = []
    title = None
    for line in body[first:]:
        # between two tables of a file may be their titles, with numbers of points
        if not line.numeric or not (last or len(line.cells) == width or _plain(line.cells)):
            title = title or (None if line.comment else line)
        elif title is None:
            if any(line.cells[len(names) :]) or len(line.cells) < len(names):
                above = f"the headings in line {lines[head].number}" if head >= 0 else f"line {body[first].number}"
                problem = f"line {line.number} has {len(line.cells)} columns, {above} {len(names)}, cut by {by}"
                raise FileError(path, f"{problem}: {line.text[:60]!r}")
            rows.append(line)
        else:
            last = True
    if title and last:
        raise FileError(path, f"line {title.number} is no row of numbers: {title.text[:60]!r}")
    units = _units(path, body[:first] if head >= 0 else [], len(names), by)
    cells = [row.cells[: len(names)] for row in rows]
    return Table(path, tuple(names), units, cells, [row.number for row in rows], bare=head < 0)


def _headings(line: _Line, width: int, by: str) -> list[str]:
    """The cells of a line of headings; where blanks part them, words of one name go together if that fits."""
    if by != _SEPARATORS[" "]:
        return [*line.cells]
    text = _COMMENT.sub("", line.text, count=1) if line.comment else line.text
    text = re.sub(r"[\[(][^\])]*[\])]", lambda found: found[0].replace(" ", "·"), text)
    ways = [_by_blanks(_PHRASE.sub("", text)), re.split(r"\s{2,}|\t", text), _by_blanks(text)]
    return next((cells for cells in ways if len(cells) == width), ways[0])


def _units(path: str | PathLike[str], between: list[_Line], width: int, by: str) -> tuple[str, ...]:
    """The row of units between headings and numbers, at least half of its texts units; "" without one."""
    found = [""] * width
    for line in between:
        cells = _headings(line, width, by)
        texts = [cell.strip("[](){}<> ") for cell in cells if cell]
        units = [text for text in texts if text in NO_UNIT or (looks_like_unit(text) and is_unit(text))]
        fits = len(cells) == width or (by != _SEPARATORS[" "] and not any(cells[width:]))
        if fits and 2 * len(units) >= len(texts) and not any(found):
            found = (cells + found)[:width]
        elif not line.comment:
            raise FileError(path, f"line {line.number} is neither units nor numbers, cut by {by}: {line.text[:60]!r}")
    return tuple(found)


def _mark(table: Table, separator: str) -> str:
    """The decimal mark of the numbers of a table, "." where there is none; raises FileError where there are both."""
    numbers = [cell for row in table.rows for cell in row if _NUMBER.fullmatch(cell)]
    commas, points = ([cell for cell in numbers if mark in cell] for mark in ",.")
    if commas and (points or (separator == "," and all(map(_THOUSAND.fullmatch, commas)))):
        both = " and ".join(repr(cells[0]) for cells in (commas, points) if cells)
        raise FileError(table.path, f"has {both}: may have separators of thousands, write numbers without them")
    return "," if commas else "."
