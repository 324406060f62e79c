"""Titles of the paper's figures: the parameters of the scene."""

from __future__ import annotations

from viscoroll import Scene
from viscoroll.core.scale import SYMBOLS


def describe(scene: Scene, *names: str) -> str:
    """The named parameters of a scene, for a title line."""
    return ", ".join(f"${SYMBOLS[name].latex} = {number(getattr(scene, name))}$" for name in names)


def number(value: float, digits: int = 4) -> str:
    """A number as mathematics, to stand between dollar signs."""
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    if not exponent:
        return mantissa
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa}\times {power}"


def scaled(name: str, exponent: int) -> str:
    """Axis label of a quantity whose values are shown times 10^exponent."""
    return rf"${SYMBOLS[name].latex}\times 10^{{{exponent}}}$"
