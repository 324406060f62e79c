"""A heading of a column: its name, its unit, and whether it is of logarithms."""

from __future__ import annotations

import re
from typing import NamedTuple

from ...core.errors import ParameterError
from ...core.units import conversion_factor

#: signs that stand where a ratio has no unit
NO_UNIT = ("", "1", "-", "--", "–", "—", "/", "none")
_BRACKETS = re.compile(r"[\[({<]\s*([^\[\](){}<>]*?)\s*[\])}>]|\(\s*([^()]*\([^()]*\)[^()]*?)\s*\)")
#: what may stand between a name and a unit without brackets, the slash of DIN 1313 first
_BETWEEN = re.compile(r"\s*/\s*|\s+in\s+|[\s_,]+")
_LOGARITHM = re.compile(r"(?i)(?:log|lg)(?![a-z])[\s_]*(?:10(?!\d))?[\s_]*(?P<of>.+)")
_PARENTHESES = re.compile(r"\(((?:[^()]|\([^()]*\))*)\)(.*)", re.DOTALL)
#: digits of a power behind a symbol: the only ones that a unit has, but for its leading 1
_POWERS = re.compile(r"(?<=[A-Za-z%°µμ)])\s*(?:\^|\*\*)?\s*[({]?[-+−]?\d(?!\d)[)}]?")
#: longest text that is looked at as a unit
_LONGEST = 24
#: units in other spellings than pint's -> pint's
_SPELLED = [(re.compile(pattern), unit) for pattern, unit in (
    (r"(?i)(?:u|r|rev|umdr\.?)\s*/\s*min|upm|u\s*min-1", "rpm"),
    (r"(?i)(?:deg|°|º|grad)?\s*c(?:elsius)?", "degC"),
    (r"(?i)(?:deg|°|º)?\s*f(?:ahrenheit)?", "degF"),
    (r"(?i)hz", "Hz"), (r"(?i)khz", "kHz"),
    (r"(?i)pa", "Pa"), (r"(?i)kpa", "kPa"), (r"(?i)mpa", "MPa"), (r"(?i)gpa", "GPa"), (r"(?i)psi", "psi"),
    (r"(?i)rpm", "rpm"), (r"(?i)rad\s*/\s*s(?:ec)?", "rad/s"), (r"(?i)1\s*/\s*s(?:ec)?", "1/s"),
    (r"Nm", "N m"), (r"Nm\s*/\s*m", "N m/m"), (r"(?i)deg(?:rees?)?|grad", "deg"),
)]  # fmt: skip


class Reading(NamedTuple):
    """One way to read a heading.

    name : without unit and logarithm; unit : "" where the heading gives none; log : of logarithms to base 10.
    """

    name: str
    unit: str
    log: bool = False


def readings(heading: str, row: str = "") -> list[Reading]:
    """All ways to read a heading, the likeliest first: as a name alone, then with a unit in brackets or at its end.

    Parameters
    ----------
    heading : as the file has it, e.g. "E' [MPa]", "Frequency/Hz", "T_C", "log10(f/Hz)".
    row : the unit that a row of units has for this column, "" without; then a heading may be a name alone.
    """
    log = False
    if found := _LOGARITHM.fullmatch(heading.strip()):
        heading, log = found["of"], True
        if inner := _PARENTHESES.fullmatch(heading):
            heading = inner[1] + " " + inner[2]
    ways = [(heading, "")]
    for group in reversed([*_BRACKETS.finditer(heading)]):
        ways.append((heading[: group.start()].rstrip(" /") + " " + heading[group.end() :], group[1] or group[2] or ""))
    for gap in _BETWEEN.finditer(heading):
        unit = heading[gap.end() :]
        if unit in NO_UNIT[1:] or (looks_like_unit(unit) and not re.search(r"[\[\](){}]", unit)):
            ways.append((heading[: gap.start()], unit))
    row = row[1:-1] if row[:1] in ("[", "(") and row.count("(") <= 1 else row
    return [Reading(" ".join(name.split()), unit or row.strip(), log) for name, unit in ways if name]


def looks_like_unit(text: str) -> bool:
    """Whether a text may be handed to pint: short, of symbols and their powers (no sums, no towers of powers)."""
    rest = _POWERS.sub("", re.sub(r"^\s*1\s*/", "", text))
    return (
        0 < len(text.strip()) <= _LONGEST
        and not re.search(r"[\d^]|\*\*", rest)
        and bool(re.search(r"[A-Za-z%°℃º]", text))
    )


def conversion(unit: str, wanted: str) -> tuple[float, float]:
    """Factor and offset from a unit as files spell it: wanted = factor * number + offset.

    Parameters
    ----------
    unit : "" and "-" of a ratio; "mpa", "U/min", "C", "Nm" are read as MPa, rpm, degC, N m where pint's own reading
        has another dimension.
    wanted : in pint's spelling.

    Raises
    ------
    ParameterError
        A unit that is not known, or of another dimension.
    """
    if unit in NO_UNIT:
        unit = "1"
    elif not looks_like_unit(unit):
        raise ParameterError("unit", unit, f"a unit that pint knows, of the dimension of {wanted}")
    try:
        return conversion_factor(unit, wanted)
    except ParameterError:
        for pattern, spelled in _SPELLED:
            if pattern.fullmatch(unit.strip()):
                return conversion_factor(spelled, wanted)
        raise
