"""Titles of the paper's figures: parameters of the scene, and whether the motion is that of a cylinder."""

from __future__ import annotations

from viscoroll import Scene
from viscoroll.core.plots.style import number
from viscoroll.core.symbols import SYMBOLS


def describe(scene: Scene, *names: str) -> str:
    """The named parameters of a scene, for a title line."""
    return ", ".join(f"${SYMBOLS[name].latex} = {number(getattr(scene, name))}$" for name in names)


def caveat(scene: Scene, V: float) -> str:
    """A line for the title of a motion that the law of steady rolling may not drive; else nothing."""
    steady = scene.validity(V).steady
    much = f"{float(f'{steady.value:.1g}'):g}"
    return "" if steady.holds else f"\n(unsteadiness {much}: Eq. (22) solved, not how such a cylinder would move)"
