"""The table in a text file: its headings, its row of units, its cells, and numbers of a column."""

from __future__ import annotations

import codecs
import csv
import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.errors import FileError, ParameterError
from ...core.typed import Floats
from ...core.units import is_unit
from .headings import NO_UNIT, looks_like_unit

#: separators of cells, the surest first; then blanks
_SEPARATORS = {"\t": "tabs", ";": "semicolons", "|": "bars", ",": "commas", " ": "blanks"}
_NUMBER = re.compile(r"[+-]?(\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD]([+-]?\d+))?")
#: numbers with separators of thousands, "1,234.5", "1.234.567", "1 234,5", or a lone "1,234"
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:[,.' \xa0\u202f’]\d{3})+(?:[.,]\d*)?")
_THOUSAND = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")
#: what stands in place of a number that was not measured
_GAP = re.compile(r"(?i)-*|nan|n/?a|null|none|\*+|#n/?a|#wert!|#value!|[+-]?inf(inity)?|\?+")
#: cells that are neither numbers nor gaps in a row of numbers: words, dates, times
_TEXT = re.compile(r".*[^\W\d_].*|\d+[-:./]\d+[-:./]\d+.*|\d+:\d+.*")
_COMMENT = re.compile(r"\s*(?:[#%!]+|//)\s*")
#: words of one heading in a line that blanks part
_PHRASE = re.compile(
    r"(?i)\s+(?=[\[(])|(?<=\bstorage)\s+|(?<=\bloss)\s+|(?<=\bangular)\s+|(?<=\bcomplex)\s+|(?<=\btan)\s+(?=d)"
    r"|(?<=\bphase)\s+|(?<=\breduced)\s+|(?<=\belastic)\s+|(?<=\bviscous)\s+|(?<=\bpoint)\s+(?=no)"
)


class Numbers(NamedTuple):
    """Numbers of a column, shape (n,).

    values : as written; half : half a unit of the last digit that each was written with, by which it may be off.
    """

    values: Floats
    half: Floats


class _Line(NamedTuple):
    """A line that is not blank: its number, its cells, whether it is a comment, and whether a row of numbers."""

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

    def empty(self, column: int) -> bool:
        """Whether a column has no cell with anything in it."""
        return not any(row[column] for row in self.rows)

    def textual(self, column: int) -> bool:
        """Whether no cell of a column is a number."""
        return not any(_NUMBER.fullmatch(row[column]) or _THOUSANDS.fullmatch(row[column]) for row in self.rows)

    def numbers(self, column: int) -> Numbers:
        """The numbers of a column.

        Raises
        ------
        FileError
            A gap, a text, a separator of thousands, or the other decimal mark, with its line.
        """
        values, half = np.empty((2, len(self.rows)))
        cells = [row[column] for row in self.rows]
        self._refuse_thousands(column, cells)
        for n, cell in enumerate(cells):
            found = _NUMBER.fullmatch(cell)
            if found is None or (self.decimal == "." and "," in cell) or (self.decimal == "," and "." in cell):
                raise self._fault(n, column, f"is {self._word(cell)}")
            digits = found[1].replace(",", ".")
            power = int(found[2] or 0)
            text = f"{'-' * cell.startswith('-')}{digits}e{power}"
            values[n] = float(text)
            half[n] = 0.5 * 10.0 ** min(power - len(digits.partition(".")[2]), 300)
            if not np.isfinite(values[n]):
                raise self._fault(n, column, "is beyond the range of numbers")
        return Numbers(values, half)

    def _word(self, cell: str) -> str:
        """What is wrong with a cell that must be a number."""
        if _GAP.fullmatch(cell):
            return "a gap: leave out its row"
        if _THOUSANDS.fullmatch(cell) and not _NUMBER.fullmatch(cell):
            return "written with separators of thousands: write it without"
        return f"no number with a decimal {'comma' if self.decimal == ',' else 'point'}"

    def _refuse_thousands(self, column: int, cells: list[str]) -> None:
        """Refuse "1,234" beside "567": three digits behind each mark, and whole numbers of three digits."""
        marked = [n for n, cell in enumerate(cells) if re.search("[.,]", cell)]
        if (
            marked
            and all(_THOUSAND.fullmatch(cells[n]) for n in marked)
            and any(len(c) == 3 and c.isdigit() for c in cells)
        ):
            raise self._fault(marked[0], column, "may have a separator of thousands: write it without")

    def _fault(self, row: int, column: int, problem: str) -> FileError:
        cell = self.rows[row][column]
        return FileError(self.path, f"line {self.lines[row]}, column {self.headings[column]!r}: {cell!r} {problem}")


def read_table(
    path: str | PathLike[str], known: Callable[[list[str]], bool], *,
    decimal: str | None = None, encoding: str | None = None,
) -> Table:  # fmt: skip
    """Read the table of a text file: preambles, comments, several tables with the same headings.

    The separator is that by which most lines are rows of numbers.  Headings are the last line before the numbers whose
    cells are ``known``, else the line above the longest table.  Python's csv cuts lines into cells: pandas expects
    all lines of a file to be as wide as its table.

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
    text = _text(path, encoding).replace("\r\n", "\n").replace("\r", "\n").replace("\u2212", "-").split("\n")
    if text[0].lower().startswith("sep=") and len(text[0].strip()) == 5:  # a line by which Excel is told
        text[0] = ""
    separator = max((sep for sep in _SEPARATORS if sep != decimal), key=lambda sep: _fitting(text, sep))
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
    return replace(whole, decimal=decimal or _mark(path, whole, separator))


def _text(path: str | PathLike[str], encoding: str | None) -> str:
    """The text of a file; workbooks and other binary files are refused."""
    try:
        raw = Path(path).read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})") from error
    if raw[:4] in (b"PK\x03\x04", b"\xd0\xcf\x11\xe0"):
        raise FileError(path, "is a workbook or an archive, no text: save its sheet as CSV")
    if encoding is None:
        if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            encoding = "utf-16"
        elif b"\0" in raw[:2]:
            encoding = "utf-16-le" if raw[1:2] == b"\0" else "utf-16-be"
    try:
        found = _decoded(raw, encoding)
    except LookupError:
        raise ParameterError("encoding", f"{encoding!r:.40}", "an encoding that Python knows, as 'utf-8'") from None
    except (UnicodeError, TypeError) as error:
        raise FileError(path, f"cannot be read in {encoding} ({error})") from error
    if "\0" in found:
        raise FileError(path, "is no text: it has null bytes")
    return found


def _decoded(raw: bytes, encoding: str | None) -> str:
    if encoding is not None:
        return raw.decode(encoding).lstrip("\ufeff")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        # of Windows where all its bytes are, else of ISO 8859-1, which has a sign for every byte
        return raw.decode("cp1252", errors="ignore") if _windows(raw) else raw.decode("latin-1")


def _windows(raw: bytes) -> bool:
    return not set(raw) & {0x81, 0x8D, 0x8F, 0x90, 0x9D}


def _cut(text: list[str], separator: str) -> Iterable[_Line]:
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
        yield _Line(number, line.strip(), cells, mark is not None, mark is None and _numeric(cells))


def _by_blanks(line: str) -> list[str]:
    return [quoted or bare for quoted, bare in re.findall(r'"([^"]*)"|(\S+)', line)]


def _numeric(cells: list[str]) -> bool:
    """Whether a line is a row of numbers, perhaps beside words, gaps, and numbers with separators of thousands."""
    numbers = sum(1 for cell in cells if _NUMBER.fullmatch(cell) or _THOUSANDS.fullmatch(cell))
    others = [
        cell for cell in cells if not (_NUMBER.fullmatch(cell) or _THOUSANDS.fullmatch(cell) or _GAP.fullmatch(cell))
    ]
    return numbers > 0 and len(others) <= numbers and all(_TEXT.fullmatch(cell) for cell in others)


def _fitting(text: list[str], separator: str) -> tuple[int, int]:
    """How many lines of a file a separator cuts into rows of numbers alike: of plain ones, and of any."""
    try:
        rows = [line.cells for line in _cut(text[:_SOME], separator) if line.numeric]
    except csv.Error:
        return 0, 0
    plain = [len(row) for row in rows if not any(_THOUSANDS.fullmatch(c) and not _NUMBER.fullmatch(c) for c in row)]
    widths = [Counter(size for size in sizes if size > 1) for sizes in (plain, [len(row) for row in rows])]
    most, any_kind = (max(found.values(), default=0) for found in widths)
    return most, any_kind


#: lines of a file by which its separator is found
_SOME = 2000


def _tables(path: str | PathLike[str], lines: list[_Line], known: Callable[[list[str]], bool], by: str) -> list[Table]:
    """The tables of a file: one below each line of headings that are known, else all rows of numbers."""
    width = Counter(len(line.cells) for line in lines if line.numeric).most_common(1)[0][0]
    heads = [n for n, line in enumerate(lines) if not line.numeric and known(_headings(line, width, by))]
    # of several lines of headings above the same numbers the last is meant
    ends = zip(heads, [*heads, len(lines)][1:])
    spans = [(head, end) for head, end in ends if any(line.numeric for line in lines[head:end])]
    if not spans:
        spans = [(_above(lines, width, by), len(lines))]
        for line in lines if spans[0][0] < 0 else ():
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
    return len(filled) > 1 and all(_NUMBER.fullmatch(cell) for cell in filled)


def _above(lines: list[_Line], width: int, by: str) -> int:
    """Index of the line of headings above the first row of the table, -1 where there is none."""
    first = next(n for n, line in enumerate(lines) if line.numeric and len(line.cells) == width)
    above = [n for n, line in enumerate(lines[:first]) if not line.comment and not line.numeric]
    while len(above) > 1 and _are_units(_headings(lines[above[-1]], width, by)):
        above.pop()
    return above[-1] if above else -1


def _table(path: str | PathLike[str], lines: list[_Line], head: int, end: int, width: int, by: str) -> Table:
    """The rows of numbers between a line of headings (-1: none) and the next one or the end of the file."""
    body = lines[head + 1 : end]
    first = next(n for n, line in enumerate(body) if line.numeric and (head >= 0 or len(line.cells) == width))
    rows: list[_Line] = []
    title = None
    for line in body[first:]:
        # between two tables of a file may be their titles, with numbers of points
        if line.numeric and (len(line.cells) == width or end == len(lines) or _plain(line.cells)):
            if title:
                raise FileError(path, f"line {title.number} is no row of numbers: {title.text[:60]!r}")
            if rows and len(line.cells) != len(rows[0].cells):
                problem = f"has {len(line.cells)} columns, those before it {len(rows[0].cells)}"
                raise FileError(path, f"line {line.number} {problem}, cut by {by}")
            rows.append(line)
        elif not line.comment:
            title = title or line
    if title and end == len(lines):
        raise FileError(path, f"line {title.number} is no row of numbers: {title.text[:60]!r}")
    names = _headings(lines[head], len(rows[0].cells), by) if head >= 0 else []
    width = _filled(rows, names)
    while len(names) > width and not names[-1]:
        names.pop()
    if head >= 0 and len(names) != width:
        problem = f"line {lines[head].number} has {len(names)} headings, the rows below it {width} columns, cut by {by}"
        raise FileError(path, f"{problem}: {', '.join(names)[:200]}")
    return Table(
        path, tuple(names) or tuple(f"column {n}" for n in range(width)),
        _units(path, body[:first] if head >= 0 else [], width, by),
        [row.cells[:width] for row in rows], [row.number for row in rows], bare=head < 0,
    )  # fmt: skip


def _filled(rows: list[_Line], names: list[str]) -> int:
    """Columns of a table without those behind trailing separators, which have neither a heading nor a cell."""
    width = len(rows[0].cells)
    while width > 1 and not any(row.cells[width - 1] for row in rows) and not any(names[width - 1 :]):
        width -= 1
    return width


def _headings(line: _Line, width: int, by: str) -> list[str]:
    """The cells of a line of headings; where blanks part them, words of one name go together if that fits."""
    if by != _SEPARATORS[" "]:
        return [*line.cells]
    text = _COMMENT.sub("", line.text, count=1) if line.comment else line.text
    text = re.sub(r"[\[(][^\])]*[\])]", lambda found: found[0].replace(" ", "·"), text)
    ways = [_by_blanks(_PHRASE.sub("", text)), re.split(r"\s{2,}|\t", text), _by_blanks(text)]
    return next((cells for cells in ways if len(cells) == width), ways[0])


def _units(path: str | PathLike[str], between: list[_Line], width: int, by: str) -> tuple[str, ...]:
    """The row of units between headings and numbers, "" without one."""
    found = [""] * width
    for line in between:
        cells = _headings(line, width, by)
        fits = len(cells) == width or (by != _SEPARATORS[" "] and not any(cells[width:]))
        if fits and _are_units(cells) and not any(found):
            found = (cells + found)[:width]
        elif not line.comment:
            raise FileError(path, f"line {line.number} is neither units nor numbers, cut by {by}: {line.text[:60]!r}")
    return tuple(found)


def _are_units(cells: list[str]) -> bool:
    """Whether at least half of the cells of a line that have anything in them are units."""
    texts = [cell.strip("[](){}<> ") for cell in cells if cell]
    units = [text for text in texts if text in NO_UNIT or (looks_like_unit(text) and is_unit(text))]
    return bool(texts) and 2 * len(units) >= len(texts)


def _mark(path: str | PathLike[str], table: Table, separator: str) -> str:
    """The decimal mark of the numbers of a table, "." where there is none."""
    marked = [
        (line, cell) for line, row in zip(table.lines, table.rows, strict=True) for cell in row
        if ("," in cell or "." in cell) and _NUMBER.fullmatch(cell)
    ]  # fmt: skip
    commas = [each for each in marked if "," in each[1]]
    if not commas:
        return "."
    (line, cell), points = commas[0], [each for each in marked if "." in each[1]]
    if points:
        both = f"{cell!r} in line {line} and {points[0][1]!r} in line {points[0][0]}"
        raise FileError(path, f"has commas and points in numbers ({both}): separators of thousands? Write them without")
    if separator == "," and all(_THOUSAND.fullmatch(cell) for _, cell in commas):
        raise FileError(path, f"line {line}: {cell!r} may have a separator of thousands: write it without")
    return ","
