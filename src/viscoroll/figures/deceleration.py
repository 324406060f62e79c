"""The deceleration: counterparts of the paper's Figs. 5, 6 and 7."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, roll
from ..rolling_contact import stress
from ..scene import PAPER_SECTION_5, PAPER_STARTS, Scene
from ..symbols import label
from .style import LINES, SHADE, describe, math, new_figure, number, time_axis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The times of the paper's Fig. 7, circles in Fig. 6.
PAPER_TIMES = (1.52e-4, 4e-4, 24e-4, 30e-4)
_FACTOR = 1e4
_END = 4e-3
_SCENE = ("alpha", "kappa", "mu", "gamma")


def _times(onset: float) -> NDArray:
    """Output times: even ones, and closer ones around the onset of stick."""
    return np.unique(np.concatenate([np.linspace(0.0, _END, 801), np.linspace(0.9 * onset, 1.3 * onset, 401)]))


def _rolled(scene: Scene, start: tuple[float, float]) -> Motion:
    onset = roll(scene, *start, np.array([_END])).onset_time
    return roll(scene, *start, _times(onset))


def figure_5(scene: Scene = PAPER_SECTION_5, starts: dict[str, tuple[float, float]] = PAPER_STARTS) -> Figure:
    """V and omega over time for each start; the inset shows the onset of stick of the first."""
    figure, axes = new_figure(f"Deceleration, Eq. (22): {describe(scene, *_SCENE)}", size=(7.6, 5.0))
    motions = {name: _rolled(scene, start) for name, start in starts.items()}
    inset = axes.inset_axes((0.5, 0.64, 0.46, 0.33))
    for (name, motion), line in zip(motions.items(), LINES, strict=False):
        for box in (axes, inset):
            box.plot(_FACTOR * motion.t, motion.V, color=line["color"], label=f"{name}: {label('V')}")
            box.plot(_FACTOR * motion.t, motion.omega, color=line["color"], linestyle="--", label=f"{name}: {label('omega')}")
        for quantity, shift in (("V", 0.02), ("omega", -0.02)):
            start = getattr(motion, quantity)[0]
            axes.annotate(f"{name} {label(quantity)}", (0.0, start), (-4, 0), textcoords="offset points", ha="right", va="center", fontsize="small")
            del shift
    first = next(iter(motions.values()))
    onset = first.onset_time
    middle = np.interp(onset, first.t, first.V)
    inset.set(xlim=(0.9 * onset * _FACTOR, 1.2 * onset * _FACTOR), ylim=(middle - 0.08, middle + 0.05))
    inset.axvline(_FACTOR * onset, color="0.6", linewidth=0.8)
    inset.tick_params(labelsize="x-small")
    axes.indicate_inset_zoom(inset, edgecolor="0.4")
    axes.axhline(0.0, color="0.7", linewidth=0.6)
    axes.set(xlim=(0.0, _FACTOR * _END), ylabel=rf"{label('V')}, {label('omega')}")
    axes.yaxis.tick_right()
    axes.yaxis.set_label_position("right")
    time_axis(axes, _FACTOR)
    return figure
