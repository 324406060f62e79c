"""Driven motions: a start with wheel spin, and braking through V = 0."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, roll
from ..plots.style import LINES, SHADES, THIN, caveat, describe, new_figure, scaled
from ..presets import PAPER_SECTION_5
from ..scene import Scene
from ..symbols import label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SCENE = ("alpha", "kappa", "mu", "gamma", "j")
#: times are shown in units of 1e-4
_EXPONENT, _UNIT = 4, 1e4
#: a ramp beyond the grip, (1 + j) mu, in gamma t and units of it, and an end at which the throttle is let go
_RAMP = ([0.0, 5.0, 8.0, 8.0], [0.0, 2.0, 2.0, 0.25])
_END = 16.0
#: torque of the braking, over the grip; how near V = 0 the inset looks, over the time of the reversal
_BRAKING, _NEAR = -0.85, 0.06


def wheel_spin(scene: Scene = PAPER_SECTION_5) -> Figure:
    """A start from rest by a ramp of torque: V and omega, Q and the torque over time; full slip is shaded."""
    grip = (1.0 + scene.j) * scene.mu
    times, torque = np.array(_RAMP[0]) / scene.gamma, np.array(_RAMP[1]) * grip
    t = np.unique(np.concatenate([np.linspace(0.0, _END / scene.gamma, 801), times]))
    motion = roll(scene, 0.0, 0.0, t, torque=(times, torque))
    title = f"A start with wheel spin for {describe(scene, *_SCENE)}" + caveat(scene, float(motion.V.max()))
    figure, (top, bottom) = new_figure(title, 2, 1, (7.2, 5.6), sharex=True)
    _speeds(top, motion)
    Q = motion.contact("Q").Q
    bottom.plot(_UNIT * t, Q, label=label("Q"), **LINES[0])
    bottom.plot(_UNIT * t, motion.torque, label=f"{label('torque')}", **LINES[1])
    for limit in (scene.mu, grip):
        bottom.axhline(limit, **THIN, zorder=1.5)
    bottom.annotate(label("mu"), (_UNIT * t[-1], scene.mu), (-4, 2), textcoords="offset points", ha="right")
    bottom.annotate(r"$(1+j)\mu$", (_UNIT * t[-1], grip), (-4, 2), textcoords="offset points", ha="right")
    bottom.set(xlabel=scaled("t", _EXPONENT), ylabel=f"{label('Q')}, {label('torque')}", ylim=(None, 2.15 * grip))
    for axes in (top, bottom):
        _shade_slip(axes, motion)
        axes.legend(frameon=True, framealpha=1.0, loc="upper left")
    return figure


def _speeds(axes: Any, motion: Motion) -> None:
    """V and omega over time."""
    for name, line in zip(("V", "omega"), LINES, strict=False):
        axes.plot(_UNIT * motion.t, getattr(motion, name), label=label(name), **line)
    axes.axhline(0.0, **THIN)
    axes.set(xlim=(0.0, _UNIT * motion.t[-1]), ylabel=f"{label('V')}, {label('omega')}")


def _shade_slip(axes: Any, motion: Motion) -> None:
    """Full slip in grey."""
    ends = [*(switch.t for switch in motion.switches[1:]), motion.t[-1]]
    for switch, end in zip(motion.switches, ends, strict=True):
        if switch.regime == "full slip":
            axes.axvspan(_UNIT * switch.t, _UNIT * end, color=SHADES["full slip"], linewidth=0.0)


def reversal(scene: Scene = PAPER_SECTION_5, V0: float = 0.5) -> Figure:
    """A torque brakes a rolling cylinder through V = 0: (a) V and omega, (b) Q, which jumps there."""
    torque = _BRAKING * (1.0 + scene.j) * scene.mu
    end = 3.0 * V0 / (scene.gamma * abs(torque))
    turn = float(roll(scene, V0, V0, end, torque=torque).reversals[0])
    apart = turn * np.geomspace(1e-9, 0.5, 200)
    t = np.unique(np.concatenate([turn - apart, turn + apart, np.linspace(0.0, end, 801)]))
    motion = roll(scene, V0, V0, t, torque=torque)
    Q = motion.contact("Q").Q
    title = f"Braked through V = 0 by a torque of {torque:.3g} over load times radius\nfor {describe(scene, *_SCENE)}"
    title += caveat(scene, V0)
    figure, (left, right) = new_figure(title, 1, 2, (9.6, 4.2))
    _speeds(left, motion)
    left.axvline(_UNIT * turn, **THIN)
    left.set(xlabel=scaled("t", _EXPONENT), title="a) speeds")
    left.legend(frameon=False)
    inset = right.inset_axes((0.5, 0.5, 0.46, 0.44))
    sides = t < turn, t > turn
    for axes in (right, inset):
        for side in sides:
            axes.plot(_UNIT * t[side], Q[side], **LINES[0])
        for value, face in zip(sides_of_reversal(scene, torque), ("white", "black"), strict=True):
            axes.plot(_UNIT * turn, value, "o", color="black", markerfacecolor=face, markersize=4.5)
    near = np.abs(t - turn) < _NEAR * turn
    inset.set(xlim=(_UNIT * turn * (1.0 - _NEAR), _UNIT * turn * (1.0 + _NEAR)), ylim=_room(Q[near]))
    inset.tick_params(labelsize="small")
    right.axhline(-scene.mu, **THIN)
    right.set(xlabel=scaled("t", _EXPONENT), ylabel=label("Q"), xlim=(0.0, _UNIT * end))
    right.set(ylim=(-1.05 * scene.mu, 0.02 * scene.mu), title="b) traction; circles: its limits at V = 0")
    right.indicate_inset_zoom(inset, edgecolor="0.3")
    return figure


def _room(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = values.min(), values.max()
    return low - 0.2 * (high - low), high + 0.2 * (high - low)


def sides_of_reversal(scene: Scene, torque: float) -> tuple[float, float]:
    """Q at V = 0 in stick under a torque, in the limits from before and from after.

    There (1 + j) Q + j s d Q = q and Q = 4 kappa d (1 - kappa |d|/mu), d = (omega - V)/|V|, with s = -sgn q before V
    changes its sign and sgn q behind.
    """
    from scipy.optimize import brentq

    mu, kappa, j = scene.mu, scene.kappa, scene.j
    edge = 0.5 * mu / kappa

    def traction(d: float) -> float:
        return 4.0 * kappa * d * (1.0 - kappa * abs(d) / mu)

    found = []
    for s in (-np.sign(torque), np.sign(torque)):
        d = brentq(lambda d, s=s: (1.0 + j + j * s * d) * traction(d) - torque, -edge, edge, xtol=1e-15)
        found.append(float(traction(d)))
    return found[0], found[1]
