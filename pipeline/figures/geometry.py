"""The drawing behind the symbols: the cylinder with what acts on it, and its contact enlarged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from viscoroll.contact_mechanics.contact import contact
from viscoroll.contact_mechanics.stress import stress
from viscoroll.core.plots import LINES, THIN, axis_label, new_figure
from viscoroll.rollers import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: a driven cylinder at the hump of M; half the critical creep
_SCENE = Scene(alpha=11.0, kappa=1.0, mu=0.6)
_V = 0.35
_SHARE = 0.55
#: height of the axis over R, so that the contact can be seen
_HEIGHT = 0.955
_GROUND = "0.88"
_BODY = "0.96"
_EDGE = "0.35"
_ARROW = {
    "arrowstyle": "-|>",
    "color": "black",
    "shrinkA": 0,
    "shrinkB": 0,
    "linewidth": 1.3,
    "mutation_scale": 14,
}
_TEXT: dict[str, Any] = {"textcoords": "offset points", "fontsize": "large"}
_SPAN = {"arrowstyle": "<|-|>", "color": "black", "shrinkA": 0, "shrinkB": 0, "linewidth": 0.8}


def geometry() -> Figure:
    """Above: the cylinder on the half-space; below: its contact with lam, epsilon, beta, pressure
    and shear.
    """
    figure, (top, bottom) = new_figure(
        "Cylinder and half-space, and the contact between them, enlarged",
        2,
        1,
        6.0,
        height_ratios=(1.0, 1.1),
    )
    _body(top)
    _contact(bottom, _SCENE, _V, _SHARE * contact(_SCENE, _V, delta=0.0).delta_star)
    return figure


def _arrow(
    axes: Any, start: tuple[float, float], end: tuple[float, float], text: str = "", **style: Any
) -> None:
    axes.annotate("", end, start, arrowprops=_ARROW, **style)
    axes.annotate(text, end, (5, 3), **_TEXT, **style)


def _body(axes: Any) -> None:
    """Circle, half-space, the speeds and the loads."""
    from matplotlib.patches import Circle

    axes.add_patch(Circle((0.0, _HEIGHT), 1.0, facecolor=_BODY, edgecolor=_EDGE, linewidth=1.2))
    axes.fill_between([-1.7, 1.9], [-0.45, -0.45], [0.0, 0.0], color=_GROUND, zorder=2)
    half = np.sqrt(1.0 - _HEIGHT**2)
    turn = np.radians(np.linspace(150.0, 60.0, 60))
    down = np.radians(215.0)
    x = 0.62 * np.cos(turn)
    y = _HEIGHT + 0.62 * np.sin(turn)
    axes.plot([-1.7, 1.9], [0.0, 0.0], color=_EDGE, linewidth=1.2, zorder=3)
    axes.plot(
        [-half, half],
        [0.0, 0.0],
        color=LINES[2]["color"],
        linewidth=3.5,
        zorder=4,
        solid_capstyle="butt",
    )
    axes.plot(0.0, _HEIGHT, "o", color="black", markersize=4)
    axes.plot(x[:-3], y[:-3], color="black", linewidth=1.3)
    axes.plot([0.0, np.cos(down)], [_HEIGHT, _HEIGHT + np.sin(down)], color="0.5", linewidth=0.8)
    _arrow(axes, (0.0, _HEIGHT), (1.45, _HEIGHT), axis_label("V"))
    _arrow(axes, (0.0, 2.45), (0.0, 2.0), "load $P$")
    _arrow(axes, (x[-4], y[-4]), (x[-1], y[-1]), axis_label("omega"))
    _arrow(axes, (half + 0.12, -0.17), (half + 0.75, -0.17), "$QP$", zorder=6)
    axes.annotate("$R$", (0.5 * np.cos(down), _HEIGHT + 0.5 * np.sin(down)), (-3, 5), **_TEXT)
    axes.annotate(
        "contact", (0.0, 0.0), (0, -16), textcoords="offset points", ha="center", zorder=5
    )
    axes.set(xlim=(-1.7, 1.9), ylim=(-0.45, 2.55), aspect="equal")
    axes.set_axis_off()


def _contact(axes: Any, scene: Scene, V: float, delta: float) -> None:
    """Pressure, its share mu, and shear, over x/l0, with the lengths that the law speaks of."""
    c = contact(scene, V, delta=delta)
    rear = 0.5 * c.lam * (c.epsilon - 1.0)
    front = 0.5 * c.lam * (c.epsilon + 1.0)
    x = 0.5 * (rear + front) - 0.5 * (front - rear) * np.cos(np.linspace(0.0, np.pi, 801))
    s = stress(scene, x, V, delta=delta)
    top = float(s.p.max())
    edge = front - c.beta * c.lam
    middle = 0.5 * (rear + front)
    axes.axvspan(edge, front, color="0.92", linewidth=0.0)
    axes.plot(x, s.p / top, label="pressure $p$", **LINES[0])
    axes.plot(x, scene.mu * s.p / top, label=rf"{axis_label('mu')} $p$", **LINES[1])
    axes.plot(x, s.tau / top, label=r"shear $\tau$", **LINES[2])
    axes.axvline(0.0, **THIN | {"linestyle": "--"})
    axes.annotate(
        "below the axis",
        (0.0, 1.3),
        (-4, 0),
        textcoords="offset points",
        ha="right",
        fontsize="small",
    )
    for n, (low, high, text) in enumerate(
        (
            (rear, front, f"{axis_label('lam')} $l_0$: contact"),
            (edge, front, f"{axis_label('beta')} {axis_label('lam')} $l_0$: stick"),
            (0.0, middle, f"{axis_label('epsilon')} {axis_label('lam')} $l_0/2$: shift"),
        )
    ):
        height = -0.12 - 0.2 * n
        axes.annotate("", (high, height), (low, height), arrowprops=_SPAN)
        axes.annotate(
            text, (front, height), (8, 0), textcoords="offset points", va="center", fontsize="small"
        )
    for place in (rear, front, edge, middle):
        axes.plot([place, place], [-0.58, 0.0], **THIN)
    axes.annotate("slip", (0.5 * (rear + edge), 0.08), ha="center", fontsize="small")
    axes.annotate("stick", (0.5 * (edge + front), 0.08), ha="center", fontsize="small")
    axes.set(xlim=(rear - 0.06, front + 0.34), ylim=(-0.62, 1.4), yticks=[])
    axes.set_xticks(np.arange(np.ceil(5.0 * rear), np.floor(5.0 * front) + 1.0) / 5.0)
    axes.set_xlabel("$x/l_0$, along the motion", x=0.38)
    axes.set_ylabel("stress", y=0.6)
    axes.legend(frameon=False, loc="upper right")
    for side in ("left", "right", "top"):
        axes.spines[side].set_visible(False)
