"""A heading of a column: its name, its unit, and the base of its logarithms."""

from __future__ import annotations

import math
import re
import tomllib
from importlib.resources import files
from typing import NamedTuple

from ...core.errors import ParameterError
from ...core.units import conversion_factor

#: signs that stand where a ratio has no unit
NO_UNIT = ("", "1", "-", "--", "–", "—", "/", "none")
#: a unit in brackets, which may have parentheses of its own
_BRACKETS = re.compile(r"[\[({<]\s*([^\[\](){}<>]*?)\s*[\])}>]|\(\s*([^()]*\([^()]*\)[^()]*?)\s*\)")
#: separators of a name and a unit without brackets, the slash of DIN 1313 first
_BETWEEN = re.compile(r"\s*/\s*|\s+in\s+|[\s_,]+")
#: a heading of logarithms to base 10 or, of ln, e
_LOGARITHM = re.compile(r"(?P<kind>(?i:log|lg|ln))(?![a-z]{2})[\s_-]*(?:10(?!\d))?[\s_]*(?P<of>.+)")
#: the same in brackets behind the name, as in "E' (log)"
_LOG_BEHIND = re.compile(r"(?i)^(.+?)[\s,_]*[\[(]\s*(log|lg|ln)(?:10)?\s*[\])]")
#: a text in parentheses, and what follows
_PARENTHESES = re.compile(r"\(((?:[^()]|\([^()]*\))*)\)(.*)", re.DOTALL)
#: digits of a power after a symbol: the only ones that a unit has, but for its leading 1
_POWERS = re.compile(r"(?<=[A-Za-z%°µμ)])\s*(?:\^|\*\*)?\s*[({]?[-+−]?\d(?!\d)[)}]?")
#: rounding of factors of conversion
_ROUNDING = 1e-9
#: longest text that may be a unit
_LONGEST = 24
#: unit in small letters and without blanks, degrees and points -> unit of pint, read from units.toml
_SPELLINGS = {
    spelling: unit
    for unit, spellings in tomllib.loads((files(__package__) / "units.toml").read_text(encoding="utf-8")).items()
    for spelling in spellings.split()
}
#: brackets and slash of Japanese keyboards
_WIDE = str.maketrans("（）［］【】／", "()[][]/")


class Reading(NamedTuple):
    """One way to read a heading.

    name : the heading without unit and without the word for a logarithm.
    unit : unit in the heading, else in the row of units, as the file spells it; "" without.
    log : base of the logarithms of which the column is, 10 or e; 0 of numbers.
    sure : whether the unit stands in brackets, behind a slash or "in", or in the row of units, where a unit is stated
        even if it is not understood.
    """

    name: str
    unit: str
    log: float = 0.0
    sure: bool = False


def readings(heading: str, row: str = "") -> list[Reading]:
    """Return all ways to read a heading, the likeliest first.

    They are: as a name alone, then with a unit in brackets or at its end.

    heading : text of the heading, e.g. "E' [MPa]", "Frequency/Hz", "T_C", "log10(f/Hz)"; blanks within become one.
    row : the cell of a row of units for this column, "" without; a way of reading without a unit in the heading takes
        this one, without brackets around it.
    Returns a list of :class:`Reading`, of "Frequency/Hz" ("Frequency/Hz", "") and ("Frequency", "Hz").  Each has
    ``log`` set if the heading begins with log, lg, log10 or ln, which its name leaves out.  The list is [] for an empty
    heading.  Where the heading and the row give different units of one dimension, all have both as unit, as "Hz and
    rad/s", which is no unit.
    """
    log = 0.0
    heading = _LOG_BEHIND.sub(r"\2 \1", heading.translate(_WIDE))
    if found := _LOGARITHM.fullmatch(heading.strip()):
        heading, log = found["of"], math.e if found["kind"].lower() == "ln" else 10.0
        if inner := _PARENTHESES.fullmatch(heading):
            heading = f"{inner[1]} {inner[2]}".rstrip()
    ways = [(heading, "", False)]
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
        Reading(" ".join(name.split()), differing or unit or row, log, sure or (not unit and bool(row)))
        for name, unit, sure in ways if name
    ]  # fmt: skip


def _differ(unit: str, row: str) -> bool:
    """Return whether a heading and the row of units give two units of one dimension that are not equal.

    unit, row : texts of both; what is no unit, and units of two dimensions, as of "Temperature (T)" and "°C", where the
        one is a symbol, do not count.
    """
    if not (may_be_unit(unit) and may_be_unit(row)):
        return False
    try:
        factor, offset = conversion(unit, row)
    except ParameterError:
        return False
    return abs(factor - 1.0) + abs(offset) > _ROUNDING


def may_be_unit(text: str) -> bool:
    """Return whether a text has the form of a unit; whether it is one pint decides.

    A unit has 1 to 24 characters, a letter or one of % ° ℃ º, and no digits but powers of one digit after a symbol and
    a leading "1/".  So pint does not compute numbers and towers of powers, which may take very long.

    text : the text, without brackets around it.
    """
    rest = _POWERS.sub("", re.sub(r"^\s*1\s*/", "", text))
    return (
        0 < len(text.strip()) <= _LONGEST
        and not re.search(r"[\d^]|\*\*", rest)
        and bool(re.search(r"[A-Za-z%°℃º]", text))
    )


def conversion(unit: str, wanted: str) -> tuple[float, float]:
    """Return the conversion of a unit as files spell it to another: number in ``wanted`` = factor * number + offset.

    It reads more spellings than :func:`.units.conversion_factor`, and refuses texts that pint would compute.

    unit : unit as a file spells it; the texts of :data:`NO_UNIT`, as "" and "-", are that of a ratio.  "mpa", "U/min",
        "C", "Nm" are read as MPa, rpm, degC, N m where pint does not know the text, or reads a unit of another
        dimension than ``wanted``.
    wanted : unit in pint's spelling, "1" of a ratio.
    Returns (factor, offset), floats; the offset is in the unit ``wanted``, and 0 but for temperatures.

    Raises
    ------
    ParameterError
        A unit that is not known, has no form of a unit (:func:`may_be_unit`), or is of another dimension.
    """
    if unit in NO_UNIT:
        unit = "1"
    elif not may_be_unit(unit):
        raise ParameterError("unit", unit, f"a unit that pint knows, of the dimension of {wanted}")
    try:
        return conversion_factor(unit, wanted)
    except ParameterError:
        plain = re.sub(r"[\s°º.]", "", unit)
        spelled = _SPELLINGS.get(plain) or _SPELLINGS.get(plain.lower())
        if spelled is None:
            raise
        return conversion_factor(spelled, wanted)
