"""Conversion between units by pint, which is loaded at the first conversion."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from .errors import ParameterError

#: signs of units that pint does not know, with the words that it does
_SIGNS = {
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
#: a symbol of a unit and its power, with or without a sign for the power: "m-1", "mm^2", "s**-2"
_POWER = re.compile(r"([A-Za-z_%]+)\s*(?:\^|\*\*)?\s*\(?([+-]?\d+)\)?")


@lru_cache(maxsize=1)
def registry() -> Any:
    """The pint registry of this package, in which 1 Hz is 2 pi rad/s and 1 rpm is 2 pi/60 rad/s."""
    import pint

    found: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, on_redefinition="ignore")
    found.define("hertz = 2 * pi * radian / second = Hz")
    return found


@lru_cache(maxsize=256)
def conversion_factor(unit: str, wanted: str) -> tuple[float, float]:
    """Factor and offset that convert a number in ``unit`` to ``wanted``: wanted = factor * number + offset.

    Parameters
    ----------
    unit, wanted : units as files and people write them: "km/h", "N/mm²", "m s-1", "1/min", "°C".

    Returns
    -------
    factor, offset : the offset is 0 but for temperatures.

    Raises
    ------
    ParameterError
        A unit that is not known, or of another dimension than ``wanted``.
    """
    import pint

    units = registry()
    try:
        zero, one = (
            units.Quantity(value, pint_spelling(unit)).to(pint_spelling(wanted)).magnitude for value in (0.0, 1.0)
        )
    except pint.DimensionalityError:
        raise ParameterError("unit", unit, f"a unit of the dimension of {wanted}") from None
    except Exception as error:  # pint raises errors of its parser and of Python's
        raise ParameterError("unit", unit, f"a unit that pint knows, of the dimension of {wanted}") from error
    offset = zero if zero else 0.0
    if offset:
        return one - zero, offset
    # one division for exact factors: 1e6, not 1/1e-6
    return one, 0.0


def is_unit(text: str) -> bool:
    """Whether pint reads a text as a unit of whatever dimension; degrees Celsius as "C" are coulombs to it."""
    try:
        registry().parse_units(pint_spelling(text))
    except Exception:  # pint raises errors of its parser and of Python's
        return False
    return True


def pint_spelling(unit: str) -> str:
    """A unit in pint's spelling: signs as words, and powers with ``**``."""
    text = unit.strip()
    for sign, word in _SIGNS.items():
        text = text.replace(sign, word)
    return _POWER.sub(r"\1**\2", text) or "1"
