"""Titles of the paper's figures: parameters of the scene, and whether the motion is that of a cylinder."""

from __future__ import annotations

from viscoroll import Scene
from viscoroll.core.symbols import SYMBOLS


def describe(scene: Scene, *names: str) -> str:
    """The named parameters of a scene, for a title line."""
    return ", ".join(f"${SYMBOLS[name].latex} = {number(getattr(scene, name))}$" for name in names)


def caveat(scene: Scene, V: float) -> str:
    """A line for the title of a motion that the law of steady rolling may not drive; else nothing."""
    steady = scene.validity(V).steady
    much = f"{float(f'{steady.value:.1g}'):g}"
    return "" if steady.holds else f"\n(unsteadiness {much}: Eq. (22) solved, not how such a cylinder would move)"


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
