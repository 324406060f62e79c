"""What all figures share: size, line styles that differ in grey, titles, labels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..scene import Scene
from ..symbols import SYMBOLS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Colour, dashes: the colours differ in lightness too, from black to light.
LINES: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "#1f5fa8", "linestyle": "--"},
    {"color": "#c44e1d", "linestyle": "-."},
    {"color": "#5d9c3a", "linestyle": (0, (1, 1.2))},
    {"color": "#8b8b8b", "linestyle": (0, (5, 1, 1, 1, 1, 1))},
)
#: Shades of the regimes: white is partial slip.
SHADE = {"full slip": "0.88", "partial slip": "1.0"}


def new_figure(title: str, rows: int = 1, columns: int = 1, size: tuple[float, float] = (6.4, 4.2), **options: Any) -> tuple[Figure, Any]:
    """A figure with a title and its axes; drawn without any global state."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, dpi=150, layout="constrained")
    figure.suptitle(title, fontsize="medium")
    return figure, figure.subplots(rows, columns, **options)


def math(name: str) -> str:
    """Symbol of a quantity without dollar signs."""
    return SYMBOLS[name].latex


def describe(scene: Scene, *names: str) -> str:
    """The named parameters of a scene, as a line of a title."""
    return ", ".join(f"${math(name)} = {number(getattr(scene, name))}$" for name in names)


def number(value: float, digits: int = 4) -> str:
    """A number in mathematical notation, within dollar signs."""
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, _, exponent = text.partition("e")
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa}\times {power}"


def time_axis(axes: Axes, factor: float = 1e4) -> None:
    """Label of a time axis whose values are t times ``factor``."""
    axes.set_xlabel(rf"${math('t')}\times {number(factor)}$")


def break_at_jumps(values: np.ndarray, jump: float) -> np.ndarray:
    """``values`` with a NaN where neighbours differ by more than ``jump``: no line is drawn across."""
    broken = np.array(values, dtype=float)
    broken[1:][np.abs(np.diff(values)) > jump] = np.nan
    return broken
