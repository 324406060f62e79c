"""Factors of conversion between units, by pint, which is imported at the first conversion."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from .errors import ParameterError

#: Character of a unit that pint does not read -> spelling that it reads.
_SPELLINGS = {
    "²": "2",
    "³": "3",
    "⁻": "-",
    "¹": "1",
    "·": " ",
    "⋅": " ",
    "°C": "degC",
    "°F": "degF",
    "°": "deg",
    "µ": "u",
    "μ": "u",
}
#: Symbol of a unit and its power, with or without an operator between: "m-1", "mm^2", "s**-2".
_POWER = re.compile(r"([A-Za-z_%]+)\s*(?:\^|\*\*)?\s*\(?([+-]?\d+)\)?")


@lru_cache(maxsize=1)
def registry() -> Any:
    """Return the pint registry of this package, in which 1 Hz is 2 pi rad/s and 1 rpm is 2 pi/60 rad/s."""
    import pint

    units: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, on_redefinition="ignore")
    units.define("hertz = 2 * pi * radian / second = Hz")
    return units


@lru_cache(maxsize=256)
def conversion_factor(unit: str, target: str) -> tuple[float, float]:
    """Return factor and offset of a conversion: number in ``target`` = factor * number in ``unit`` + offset.

    Parameters
    ----------
    unit, target : units as files and people write them: "km/h", "N/mm²", "m s-1", "1/min", "°C"; "" and "1" of a ratio;
        1 Hz is 2 pi rad/s.

    Returns
    -------
    factor, offset : floats, the offset in ``target``; it is 0 unless the units are temperatures with different zeros.

    Raises
    ------
    ParameterError
        A unit that pint does not know, or of another dimension than ``target``.
    """
    import pint

    quantity = registry().Quantity
    try:
        at_0, at_1 = (
            quantity(number, pint_spelling(unit)).to(pint_spelling(target)).magnitude for number in (0.0, 1.0)
        )
    except pint.DimensionalityError:
        raise ParameterError("unit", unit, f"a unit of the dimension of {target}") from None
    except Exception as error:  # pint raises errors of its own parser and of Python's
        raise ParameterError("unit", unit, f"a unit that pint knows, of the dimension of {target}") from error
    # Without an offset the factor is the converted 1 itself, so that exact factors stay exact: 1e6, not 1/1e-6.
    return (at_1 - at_0, at_0) if at_0 else (at_1, 0.0)


def is_unit(text: str) -> bool:
    """Whether pint reads a text as a unit, of any dimension.  It reads "C" as coulomb, not as degree Celsius."""
    try:
        registry().parse_units(pint_spelling(text))
    except Exception:  # pint raises errors of its own parser and of Python's
        return False
    return True


def pint_spelling(unit: str) -> str:
    """Return a ``unit`` in the spelling of pint: superscripts and signs as ASCII, powers with ``**``; "1" of ""."""
    text = unit.strip()
    for character, spelling in _SPELLINGS.items():
        text = text.replace(character, spelling)
    return _POWER.sub(r"\1**\2", text) or "1"
