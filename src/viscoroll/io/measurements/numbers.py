"""Cells of a table: which are numbers, gaps or texts, and the numbers of a column."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats

#: a number with a decimal point or comma, perhaps with an exponent of Python (e) or Fortran (d)
_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD][+-]?\d{1,3})?")
#: a number with separators of thousands, as "1,234.5" and "1.234.567"; "1.234" may be one, or have three decimals
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:[,.'\u202f’]\d{3})+(?:[.,]\d*)?")
#: marks that instruments and spreadsheets write in place of a number that was not measured
_GAP = re.compile(r"(?i)-*|nan|n/?a|null|none|\*+|#n/?a|#wert!|#value!|[+-]?inf(inity)?|\?+")
#: words, dates and times, which may stand in a row of numbers
_TEXT = re.compile(r".*[^\W\d_].*|\d+[-:./]\d+[-:./]\d+.*|\d+:\d+.*")
#: decimal mark and exponent as Python reads them
_PYTHON = str.maketrans(",dD", ".ee")
#: decimal mark, "" for an unknown one -> words of a message
_MARKS = {"": "", ".": " with a decimal point", ",": " with a decimal comma"}
#: largest power of ten of a last digit: doubles end at 1e308
_MOST = 300


class Numbers(NamedTuple):
    """Numbers of a column.

    values : as written, shape (n,).
    half : half a unit of the last digit that each was written with, by which it may be off, shape (n,).
    """

    values: Floats
    half: Floats


def is_number(cell: str) -> bool:
    """Return whether a cell is a number, perhaps with separators of thousands."""
    return bool(_NUMBER.fullmatch(cell) or _THOUSANDS.fullmatch(cell))


def are_numbers(cells: list[str]) -> bool:
    """Return whether the cells that are not empty are two numbers or more, without words between them."""
    filled = [cell for cell in cells if cell]
    return len(filled) > 1 and all(map(_NUMBER.fullmatch, filled))


def is_row_of_numbers(cells: list[str]) -> bool:
    """Return whether cells are a row of numbers: at least as many numbers as words, dates and times, and gaps."""
    others = [cell for cell in cells if not (is_number(cell) or _GAP.fullmatch(cell))]
    return 0 < sum(map(is_number, cells)) >= len(others) and all(map(_TEXT.fullmatch, others))


def decimal_mark(cells: list[str], doubtful: str) -> str:
    """Return the decimal mark of cells, "" where the marks may be separators of thousands.

    They may be where both marks occur, or where three digits stand after each mark, as in "1,234".

    cells : cells of a table or a column; those that are no numbers with a single mark do not count.
    doubtful : the marks, "", ",", or ",.", that are taken for separators of thousands if three digits stand after each
        of them: the comma where commas also separate cells; both where the column has a cell of three digits alone, as
        "567".  For other marks three digits after each are no reason to doubt.
    Returns "." or ",", the mark of all cells; "" where it is in doubt; "." where no cell has a mark.
    """
    marked = [cell for cell in cells if _NUMBER.fullmatch(cell) and set(cell) & set(",.")]
    marks = set("".join(marked)) & set(",.")
    if len(marks) > 1 or (marks & set(doubtful) and all(map(_THOUSANDS.fullmatch, marked))):
        return ""
    return marks.pop() if marks else "."


def fault_of(cell: str, decimal: str) -> str:
    """Return why a cell cannot be read as a number, in words that continue a message; "" if it can.

    cell : text of the cell; an empty one and marks as "nan", "---" and "inf" are missing values.
    decimal : the decimal mark, "." or ","; "": unknown, so that numbers must have none.
    Returns "" for a number without a mark, or with that decimal mark alone; else the reason: a missing value, a
    possible separator of thousands, no number with that mark, or a number beyond 1.8e308.
    """
    if _GAP.fullmatch(cell):
        return "is a missing value: remove its row"
    if _NUMBER.fullmatch(cell) and set(cell) & set(",.") <= {decimal}:
        return "is larger than a double can be" if np.isinf(float(cell.translate(_PYTHON))) else ""
    if _THOUSANDS.fullmatch(cell) or (not decimal and _NUMBER.fullmatch(cell)):
        return (
            "may contain a separator of thousands, since both marks occur or all groups have three digits: "
            "write only decimal marks"
        )
    return f"is not a number{_MARKS[decimal]}"


def numbers_of(cells: list[str]) -> Numbers:
    """Return the numbers of cells, and half a unit of the last digit of each.

    cells: texts without a fault (:func:`fault_of`), with a decimal point or comma; exponents may be written with e or
        d.
    Returns :class:`Numbers`, two arrays (n,): of "0,25" 0.25 and 0.005, of "3" 3.0 and 0.5, of "1e3" 1000.0 and 500.0.
    A number beyond the doubles is infinite; half a unit is at most 0.5e300.
    Raises decimal.InvalidOperation for another text.
    """
    exact = [Decimal(cell.translate(_PYTHON)) for cell in cells]
    half = [0.5 * 10.0 ** min(int(number.as_tuple().exponent), _MOST) for number in exact]
    return Numbers(np.array(exact, np.float64), np.array(half))
