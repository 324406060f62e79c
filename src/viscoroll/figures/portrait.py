"""The phase portrait in (V, omega): regimes, fast motions from a ring of starts, the slow manifold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..motion import Motion, roll
from ..plots.style import SHADES, caveat, describe, new_figure
from ..presets import PAPER_SECTION_5
from ..rolling_contact import contact
from ..scene import Scene
from ..symbols import SYMBOLS, label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RADIUS, _STARTS = 2.0, 24
_STRETCH = 1e3
_EDGE = {"color": "0.35", "linewidth": 0.8, "linestyle": "--"}
_FAST = {"color": "#1f5fa8", "linewidth": 0.9}
_SLOW = {"color": "black", "linewidth": 1.6}


def phase_portrait(scene: Scene = PAPER_SECTION_5) -> Figure:
    """Left: the plane; right: the same over V with omega - V stretched, where partial slip has room."""
    title = f"Phase portrait of Eq. (22) for {describe(scene, 'alpha', 'kappa', 'mu', 'j')}" + caveat(scene, _RADIUS)
    figure, (left, right) = new_figure(title, 1, 2, (10.0, 5.4))
    V = np.linspace(-1.25 * _RADIUS, 1.25 * _RADIUS, 801)
    half = contact(scene, V, delta=0.0, fields="delta_star").delta_star * np.abs(V)
    fast, slow = _ring(scene), _slow_manifold(scene)
    for axes, diagonal, unit in ((left, 1.0, 1.0), (right, 0.0, _STRETCH)):
        # the height over V: omega itself, or omega - V stretched
        axes.set_facecolor(SHADES["full slip"])
        low, high = (diagonal * V + side * unit * half for side in (-1.0, 1.0))
        axes.fill_between(V, low, high, color=SHADES["partial slip"])
        axes.plot(V, low, V, high, **_EDGE)
        for motion in fast:
            axes.plot(motion.V, unit * (motion.omega - motion.V) + diagonal * motion.V, **_FAST)
        for sign in (1.0, -1.0):
            axes.plot(sign * slow.V, sign * (unit * (slow.omega - slow.V) + diagonal * slow.V), **_SLOW, zorder=3)
    for motion in fast:
        _arrow(left, motion)
    limit = 1.15 * _RADIUS
    left.plot([m.V[0] for m in fast], [m.omega[0] for m in fast], ".", color=_FAST["color"], markersize=4)
    left.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal", xlabel=label("V"), ylabel=label("omega"))
    stretched = 1.15 * _STRETCH * float(np.max(half[np.abs(V) <= _RADIUS]))
    right.set(xlim=(-_RADIUS, _RADIUS), ylim=(-stretched, stretched), xlabel=label("V"))
    right.set_ylabel(r"$(\omega - V)\times 10^3$")
    figure.legend(handles=_legend(), loc="outside lower center", ncols=5, frameon=False, fontsize="small")
    return figure


def _legend() -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    shades: list[Any] = [Patch(facecolor=grey, edgecolor="0.5", label=regime) for regime, grey in SHADES.items()]
    edge = rf"$|\delta| = {SYMBOLS['delta_star'].latex}$"
    lines: dict[str, dict[str, Any]] = {edge: _EDGE, "motions from a circle of starts": _FAST, "slow manifold": _SLOW}
    return shades + [Line2D([], [], label=text, **style) for text, style in lines.items()]


def _ring(scene: Scene) -> list[Motion]:
    """Motions from a circle of starts, with the steps of the integrator as output times."""
    angles = (np.arange(_STARTS) + 0.5) * (2.0 * np.pi / _STARTS)
    starts = _RADIUS * np.cos(angles), _RADIUS * np.sin(angles)
    end = 60.0 / scene.gamma
    return [_fine(roll(scene, V, omega, end)) for V, omega in zip(*starts, strict=True)]


def _fine(motion: Motion) -> Motion:
    """The motion at its output times, and at four times between neighbours."""
    return motion.at(np.unique(np.linspace(motion.t[:-1], motion.t[1:], 6)))


def _slow_manifold(scene: Scene) -> Motion:
    """Where motions in partial slip end up: one that starts without creep, its fast beginning left out."""
    start = (scene, 1.25 * _RADIUS, 1.25 * _RADIUS)
    # an elastic cylinder rolls for ever: any end will do
    rest = roll(*start, np.array([1e6 / scene.gamma]), rest=1e-3 * _RADIUS).rest_time
    motion = roll(*start, rest if np.isfinite(rest) else 1.0 / scene.gamma)
    late = motion.t > 0.05 / scene.gamma
    late[-2:] = True  # an elastic cylinder's motion has no steps so late
    return _fine(motion.at(motion.t[late]))


def _arrow(axes: Any, motion: Motion) -> None:
    """An arrowhead halfway from the start to the onset of stick."""
    end = motion.onset_time if np.isfinite(motion.onset_time) else motion.t[-1]
    V, omega = (np.interp(np.array([0.45, 0.5]) * end, motion.t, values) for values in (motion.V, motion.omega))
    style = {"arrowstyle": "-|>", "color": _FAST["color"], "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (V[1], omega[1]), (V[0], omega[0]), arrowprops=style)
