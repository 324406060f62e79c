"""A text file as lines (encodings, comments), lines as cells (separators), cells as numbers, gaps
or texts, and a heading of a column as its name, its unit and the base of its logarithms.
"""

import collections
import csv
import math
import pathlib
import re
import tomllib
from contextlib import suppress
from decimal import Decimal
from importlib import resources
from typing import NamedTuple

import numpy as np

from ..core import FileError, FilePath, Floats, ParameterError, as_file_error, conversion_factor

# --- Cells of a table ---

#: a number with a decimal point or comma, perhaps with an exponent of Python (e) or Fortran (d)
_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD][+-]?\d{1,3})?")
#: a number with separators of thousands, as "1,234.5" and "1.234.567"; "1.234" may be one, or have
#: three decimals
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:[,.'\u202f’]\d{3})+(?:[.,]\d*)?")
#: marks that instruments and spreadsheets write in place of a number that was not measured
_GAP = re.compile(r"(?i)-*|nan|n/?a|null|none|\*+|#n/?a|#wert!|#value!|[+-]?inf(inity)?|\?+")
#: words, dates and times, which may stand in a row of numbers
_TEXT = re.compile(r".*[^\W\d_].*|\d+[-:./]\d+[-:./]\d+.*|\d+:\d+.*")
#: decimal mark and exponent as Python reads them
_PYTHON = str.maketrans(",dD", ".ee")
#: decimal mark, "" for an unknown one -> words of a message
_MARKS = {
    "": "; correct it",
    ".": " with a decimal point; correct it, or give decimal=','",
    ",": " with a decimal comma; correct it, or give decimal='.'",
}


class Numbers(NamedTuple):
    """Numbers of a column.

    values : as written, shape (n,).
    half : half a unit of the last digit that each was written with, by which it may be off, shape
    (n,).
    """

    values: Floats
    half: Floats


def is_number(cell: str) -> bool:
    """Return whether a cell is a number, perhaps with separators of thousands."""
    return bool(_NUMBER.fullmatch(cell) or _THOUSANDS.fullmatch(cell))


def are_numbers(cells: list[str]) -> bool:
    """Return whether the cells that are not empty are two numbers or more, without words between
    them.
    """
    filled = [cell for cell in cells if cell]
    return len(filled) > 1 and all(map(_NUMBER.fullmatch, filled))


def is_row_of_numbers(cells: list[str]) -> bool:
    """Return whether cells are a row of numbers: at least as many numbers as words, dates and
    times, and gaps.
    """
    others = [cell for cell in cells if not (is_number(cell) or _GAP.fullmatch(cell))]
    return 0 < sum(map(is_number, cells)) >= len(others) and all(map(_TEXT.fullmatch, others))


def decimal_mark(cells: list[str], doubtful: str) -> str:
    """Return the decimal mark of cells, "" where the marks may be separators of thousands.

    They may be where both marks occur, or where three digits stand after each mark, as in "1,234".

    cells : cells of a table or a column; those that are no numbers with a single mark do not count.
    doubtful : the marks, "", ",", or ",.", that are taken for separators of thousands if three
        digits stand after each of them: the comma where commas also separate cells; both where the
        column has a cell of three digits alone, as "567".  For other marks three digits after each
        are no reason to doubt.
    Returns "." or ",", the mark of all cells; "" where it is in doubt; "." where no cell has a
    mark.
    """
    marked = [cell for cell in cells if _NUMBER.fullmatch(cell) and set(cell) & set(",.")]
    marks = set("".join(marked)) & set(",.")
    # both marks, or each has three digits behind it; without any mark the set is empty
    if len(marks) > 1 or (marks & set(doubtful) and all(map(_THOUSANDS.fullmatch, marked))):
        return ""
    return marks.pop() if marks else "."


def fault_of(cell: str, decimal: str) -> str:
    """Return why a cell cannot be read as a number, in words that continue a message; "" if it can.

    cell : text of the cell; an empty one and marks such as "nan", "---" and "inf" are missing
        values.
    decimal : the decimal mark, "." or ","; "": unknown, so that numbers must have none.
    Returns "" for a number without a mark, or with that decimal mark alone; else the reason: a
    missing value, a possible separator of thousands, no number with that mark, or a number beyond
    1.8e308.
    """
    if _GAP.fullmatch(cell):
        return "is a missing value; write the number, or remove this line"
    # a number without a mark, or whose only mark is ``decimal``; for decimal "" without a mark
    if _NUMBER.fullmatch(cell) and set(cell) & set(",.") <= {decimal}:
        return "is too large, above 1.8e308" if np.isinf(float(cell.translate(_PYTHON))) else ""
    # separators of thousands, or a mark that the unknown decimal mark leaves open
    if _THOUSANDS.fullmatch(cell) or (not decimal and _NUMBER.fullmatch(cell)):
        return (
            "has a comma or point that may mark decimals or thousands; write for example "
            "1150 or 1.15 in place of 1.150, and one decimal mark in the whole file"
        )
    advice = "; remove this line, or choose another column"
    return f"is not a number{_MARKS[decimal] if re.search(r'[0-9]', cell) else advice}"


def numbers_of(cells: list[str]) -> Numbers:
    """Return the numbers of cells, and half a unit of the last digit of each.

    cells: texts without a fault (:func:`fault_of`), with a decimal point or comma; exponents may be
        written with e or d.
    Returns :class:`Numbers`, two arrays (n,): of "0,25" 0.25 and 0.005, of "3" 3.0 and 0.5, of
    "1e3" 1000.0 and 500.0.  A number beyond the doubles is infinite; half a unit is at most
    0.5e300.
    Raises decimal.InvalidOperation for another text.
    """
    exact = [Decimal(cell.translate(_PYTHON)) for cell in cells]
    # the exponent of a Decimal is the power of ten of its last digit: -2 of 0.25, 3 of 1e3
    # of the largest ones no more than 300, as doubles end at 1e308
    half = [0.5 * 10.0 ** min(int(number.as_tuple().exponent), 300) for number in exact]
    return Numbers(np.array(exact, np.float64), np.array(half))


# --- A text file as lines, and lines as cells ---

#: separators of cells and their names in messages, those that are least often part of a cell first
SEPARATORS = {"\t": "tabs", ";": "semicolons", "|": "bars", ",": "commas", " ": "blanks"}
#: mark of a comment at the beginning of a line; none is a first cell of a mark alone: "%" is a
#: unit, "#" a point number
_COMMENT = r"^[^\S{0}]*(?:[#%!]+|//)[^\S{0}]*(?=[^\s{0}]|$)"
#: first bytes of a file and the encoding that they show: byte order marks, or a null beside a
#: letter
_ENCODINGS = {rb"\xff\xfe|\xfe\xff": "utf-16", rb"(?s).\0": "utf-16-le", rb"\0": "utf-16-be"}
#: encodings that are tried without such bytes: that of today, that of Windows, and one that has all
#: bytes
_USUAL = ("utf-8-sig", "cp1252", "latin-1")
#: the same with that of Windows in Japan, before encodings that almost any bytes fit, and what
#: shows it: three characters in a row of two bytes each, of which the first is a sign of typography
#: in cp1252
_JAPANESE = ("utf-8-sig", "cp932", "cp1252", "latin-1")
_KANJI = re.compile(rb"(?:[\x81-\x9f][\x40-\x7e\x80-\xfc]){3}")
#: first bytes of Excel's workbooks, of today and of before 2007
_WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


class Line(NamedTuple):
    """A line that is not blank.

    number : number of the line in the file, from 1.
    text : the line without the mark of a comment.
    cells : its cells.
    comment : whether it has such a mark.
    numeric : whether it is a row of numbers.
    """

    number: int
    text: str
    cells: list[str]
    comment: bool
    numeric: bool


def read_lines(path: FilePath, encoding: str | None) -> list[str]:
    """Return the lines of a text file, without their ends.

    Minus signs of typography become "-"; a first line "sep=;" of Excel becomes empty, so that line
    numbers stay.

    path : path of the file.
    encoding : name of the encoding, as Python calls it; None or "": UTF-16 by the first bytes (a
        byte order mark, or a null among the first two), else the first of UTF-8, cp932 (where
        characters of Japanese show it), cp1252 and Latin-1 that fits.
    Returns a list of texts, [""] of an empty file; lines may end by CR LF, CR or LF, and the text
    after the last end is a line too.
    Raises FileError for a file that cannot be read or decoded, for workbooks and archives, and for
    a text with null characters, as in binary files; ParameterError for an encoding that Python does
    not know.
    """
    with as_file_error(path, "cannot be read"):
        raw = pathlib.Path(path).read_bytes()
    if raw.startswith(_WORKBOOKS):
        raise FileError(
            path, "is a spreadsheet or an archive, not a text file: save the sheet as CSV"
        )
    shown = [name for first, name in _ENCODINGS.items() if re.match(first, raw)]
    usual = _JAPANESE if _KANJI.search(raw) else _USUAL
    for name in [encoding] if encoding else shown[:1] or usual:
        try:
            text = raw.decode(name).removeprefix("\ufeff").replace("\u2212", "-")
        except (LookupError, TypeError):
            raise ParameterError(
                "encoding", f"{name!r:.40}", "an encoding that Python knows, as 'utf-8'"
            ) from None
        except UnicodeError:
            problem = f"is not in the encoding {name}: give the right one, as encoding='cp1252'"
            continue
        if "\0" in text:
            raise FileError(path, "is not a text file (it contains null bytes): export it as CSV")
        # without Excel's own line on the separator
        text = re.sub(r"(?i)\Asep=[^\r\n][^\S\r\n]*(?=[\r\n]|\Z)", "", text)
        return re.split(r"\r\n|\r|\n", text)
    raise FileError(path, problem)


def cut_lines(text: list[str], separator: str) -> list[Line]:
    """Cut lines into cells, and leave out blank ones; quoted cells may go on over several lines.

    text : lines of a file, without their ends; not changed.
    separator : a key of :data:`SEPARATORS`; a blank stands for any number of blanks and tabs.
    Returns a list of :class:`Line`, up to the first line that Python's csv cannot cut; nothing is
    raised.  A line with the mark of a comment is cut too, without the mark, and never counts as a
    row of numbers.  The number of a row whose quoted cells go on over several lines is that of its
    last line.  (pandas would require that all lines of a file, its preamble too, are as wide as its
    table.)
    """
    # the separator ends a first cell; a blank does not, since "# 1 2" is a comment
    mark = re.compile(_COMMENT.format(separator.strip(" ")))
    plain = [mark.sub("", line) for line in text]
    found = []
    reader = csv.reader(
        (line + "\n" for line in plain), delimiter=separator, skipinitialspace=separator != "\t"
    )
    by_csv = ((reader.line_num, [" ".join(cell.split()) for cell in row]) for row in reader)
    with suppress(csv.Error):
        for number, cells in (
            enumerate(map(cut_by_blanks, plain), 1) if separator == " " else by_csv
        ):
            line = plain[number - 1]
            comment = line != text[number - 1]  # a mark was taken off
            if any(cells):
                numeric = not comment and is_row_of_numbers(cells)
                found.append(
                    Line(
                        number=number,
                        text=line.strip(),
                        cells=cells,
                        comment=comment,
                        numeric=numeric,
                    )
                )
    return found


def cut_by_blanks(text: str) -> list[str]:
    """Cut a text at blanks that are not in quotes."""
    return [quoted or plain for quoted, plain in re.findall(r'"([^"]*)"|(\S+)', text)]


def separator_of(text: list[str], decimal: str | None) -> str:
    """Return the separator that cuts most lines into rows of numbers of one width, of two cells and
    more.

    text : lines of a file, without their ends, of which the first 2000 are examined: enough to
        outvote a preamble.
    decimal : the decimal mark, "." or ",", which is then not tried as a separator; None: not given.
    Returns a key of :data:`SEPARATORS`, the first of several that give as many rows; a tab where
    none gives any, as in a file with a single column.
    """
    # separator -> number of cells of a row -> how many rows have as many
    widths = {
        separator: collections.Counter(
            len(line.cells)
            for line in cut_lines(text[:2000], separator)
            if line.numeric and len(line.cells) > 1
        )
        for separator in SEPARATORS
        if separator != decimal
    }
    return max(widths, key=lambda separator: max(widths[separator].values(), default=0))


# --- A heading of a column ---

#: signs that stand where a ratio has no unit
NO_UNIT = ("", "1", "-", "--", "–", "—", "/", "none")
#: a unit in brackets, which may have parentheses of its own
_BRACKETS = re.compile(r"[\[({<]\s*([^\[\](){}<>]*?)\s*[\])}>]|\(\s*([^()]*\([^()]*\)[^()]*?)\s*\)")
#: separators of a name and a unit without brackets, the slash of DIN 1313 first
_BETWEEN = re.compile(r"\s*/\s*|\s+in\s+|[\s_,]+")
#: a heading of logarithms to base 10, 2 or, of ln and loge, e
_LOGARITHM = re.compile(
    r"(?P<kind>(?i:loge(?=[\s(])|log|lg|ln))(?![a-z]{2})[\s_-]*(?P<base>10|2)?(?!\d)[\s_]*(?P<of>.+)"
)
#: the same in brackets behind the name, as in "E' (log)"
_LOG_BEHIND = re.compile(r"(?i)^(.+?)[\s,_]*[\[(]\s*((?:loge|log|lg|ln)(?:10|2)?)\s*[\])]")
#: a factor in a heading, as a power of ten or "*1000", or a logarithm of a base that is not read
MULTIPLIED = re.compile(
    r"(?<!\d)10\s*(?:\^|\*\*|[⁰¹²³⁴-⁹⁻])|(?:\b1|[*x×·]\s*)[eE][+-]?\d|(?i:\blog_?(?!(?:10|2)(?!\d))\d)"
    r"|(?:[*×·/÷]|(?<=[\s\])('])x|\bin)\s*\d|(?i:\b(?:thousand|million)s?\b)|^\s*\d[\d.]*\s*(?:[*×·]|x(?![^\W\d_]))|^\s*10{2,}\s+[^\W\d_]['(\[\s]"
)
#: a text in parentheses, and what follows
_PARENTHESES = re.compile(r"\(((?:[^()]|\([^()]*\))*)\)(.*)", re.DOTALL)
#: digits of a power after a symbol: the only ones that a unit has, but for its leading 1
_POWERS = re.compile(r"(?<=[A-Za-z%°µμ)])\s*(?:\^|\*\*)?\s*[({]?[-+−]?\d(?!\d)[)}]?")
#: words of headings in seven languages, the quantities that they mean, and spellings of units
DATA = tomllib.loads((resources.files(__package__) / "headings.toml").read_text(encoding="utf-8"))
#: unit in small letters and without blanks, degrees and points -> unit of pint
_SPELLINGS = {
    spelling: unit for unit, spellings in DATA["units"].items() for spelling in spellings.split()
}
#: brackets and slash of Japanese keyboards
_WIDE = str.maketrans("（）［］【】／", "()[][]/")


class Reading(NamedTuple):
    """One way to read a heading.

    name : the heading without unit and without the word for a logarithm.
    unit : unit in the heading, else in the row of units, as the file spells it; "" without.
    log : base of the logarithms of which the column is, 10 or e; 0 of numbers.
    sure : whether the unit stands in brackets, behind a slash or "in", or in the row of units,
        where a unit is stated even if it is not understood.
    mode : mode of a modulus, "tension" or "shear", of a name that is understood; "" where the
        heading does not say, and of other readings.
    """

    name: str
    unit: str
    log: float
    sure: bool
    mode: str = ""


def readings(heading: str, row: str = "") -> list[Reading]:
    """Return all ways to read a heading, the likeliest first.

    They are: as a name alone, then with a unit in brackets or at its end.

    heading : text of the heading, e.g. "E' [MPa]", "Frequency/Hz", "T_C", "log10(f/Hz)"; blanks
        within become one.
    row : the cell of a row of units for this column, "" without; a way of reading without a unit in
        the heading takes this one, without brackets around it.
    Returns a list of :class:`Reading`, of "Frequency/Hz" ("Frequency/Hz", "") and ("Frequency",
    "Hz").  Each has ``log`` set if the heading begins with log, lg, log10 or ln, which its name
    leaves out.  The list is [] for an empty heading.  Where the heading and the row give different
    units of one dimension, all have both as unit, as "Hz and rad/s", which is no unit.
    """
    log = 0.0
    heading = _LOG_BEHIND.sub(r"\2 \1", heading.translate(_WIDE))
    if found := _LOGARITHM.fullmatch(heading.strip()):
        heading = found["of"]
        log = math.e if found["kind"].lower() in ("ln", "loge") else float(found["base"] or 10.0)
        if inner := _PARENTHESES.fullmatch(heading):
            heading = f"{inner[1]} {inner[2]}".rstrip()
    ways = [(heading, "", False)]
    # the last brackets first: a unit stands behind symbols, as in "Modulus (E') [MPa]"
    for group in reversed([*_BRACKETS.finditer(heading)]):
        name = heading[: group.start()].rstrip(" /") + " " + heading[group.end() :]
        ways.append((name, group[1] or group[2] or "", True))
    for gap in _BETWEEN.finditer(heading):
        unit = heading[gap.end() :]
        if unit in NO_UNIT[1:] or (may_be_unit(unit) and not re.search(r"[\[\](){}]", unit)):
            ways.append((heading[: gap.start()], unit, bool(gap[0].strip(" _,"))))
    row = (row[1:-1] if row[:1] in ("[", "(") and row.count("(") <= 1 else row).strip()
    differing = next((f"{unit} and {row}" for _, unit, _ in ways if _differ(unit, row)), "")
    return [
        Reading(
            name=" ".join(name.split()),
            unit=differing or unit or row,
            log=log,
            sure=sure or bool(row and not unit),
        )
        for name, unit, sure in ways
        if name
    ]


def _differ(unit: str, row: str) -> bool:
    """Return whether a heading and the row of units give two units of one dimension that are not
    equal.

    unit, row : texts of both.  Texts that are no unit, and units of two dimensions, are not
        compared: in "Temperature (T)" above "°C" the T is a symbol.
    """
    if may_be_unit(unit) and may_be_unit(row):
        with suppress(ParameterError):
            # beyond the rounding of factors of conversion
            return math.dist(conversion(unit, row), (1.0, 0.0)) > 1e-9
    return False


def may_be_unit(text: str) -> bool:
    """Return whether a text has the form of a unit; whether it is one pint decides.

    A unit has 1 to 24 characters, a letter or one of % ° ℃ º, and no digits but powers of one digit
    after a symbol and a leading "1/".  So pint does not compute numbers and towers of powers, which
    may take very long.

    text : the text, without brackets around it.
    """
    rest = _POWERS.sub("", re.sub(r"^\s*1\s*/", "", text))
    return (
        0 < len(text.strip()) <= 24
        and not re.search(r"[\d^]|\*\*", rest)
        and bool(re.search(r"[A-Za-z%°℃º]", text))
    )


def conversion(unit: str, wanted: str) -> tuple[float, float]:
    """Return the conversion of a unit as files spell it to another: number in ``wanted`` = factor *
    number + offset.

    It reads more spellings than :func:`.quantities.conversion_factor`, and refuses texts that pint
    would compute.

    unit : unit as a file spells it; the texts of :data:`NO_UNIT`, as "" and "-", are that of a
        ratio.  "mpa", "U/min", "C", "Nm" are read as MPa, rpm, degC, N m where pint does not know
        the text, or reads a unit of another dimension than ``wanted``.
    wanted : unit in pint's spelling, "1" of a ratio.
    Returns (factor, offset), floats; the offset is in the unit ``wanted``, and 0 but for
    temperatures.

    Raises
    ------
    ParameterError
        A unit that is not known, has no form of a unit (:func:`may_be_unit`), or is of another
        dimension.
    """
    if unit in NO_UNIT:
        unit = "1"
    elif not may_be_unit(unit):
        raise ParameterError("unit", unit, f"a known unit of the dimension of {wanted}")
    try:
        return conversion_factor(unit, wanted)
    except ParameterError:
        plain = re.sub(r"[\s°º.]", "", unit)
        spelled = _SPELLINGS.get(plain) or _SPELLINGS.get(plain.lower())
        if spelled is None:
            raise
        return conversion_factor(spelled, wanted)
