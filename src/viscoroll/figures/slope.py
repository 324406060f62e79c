"""The phase portrait of a slope: equilibria, what runs to the stable one, what runs away, and what parts them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..equilibria import steady
from ..motion import Motion, ensemble, roll
from ..plots.style import LINES, SHADES, caveat, describe, new_figure
from ..presets import PAPER_SECTION_5
from ..rolling_contact import contact
from ..scene import Scene
from ..symbols import SYMBOLS, label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STRETCH = 1e3
#: starts on the separatrix, halvings that find each, e-foldings of the saddle in which a start shows where it goes
_POINTS, _HALVINGS, _FOLDINGS = 81, 40, 30.0
#: starts on each side of the plane, and for how long they are followed, in gamma t
_STARTS, _FOLLOWED = 9, 150.0
_EDGE = {"color": "0.35", "linewidth": 0.8, "linestyle": "--"}
_MOTION = {"color": LINES[1]["color"], "linewidth": 0.9}
_SEPARATRIX = {"color": LINES[2]["color"], "linewidth": 1.6}
_SLOW = {"color": "black", "linewidth": 1.4}


def slope_portrait(scene: Scene = PAPER_SECTION_5, slope: float = np.radians(3.0)) -> Figure:
    """Left: the plane (V, omega); right: omega - V stretched, where partial slip has room.

    Parameters
    ----------
    scene : one with a single hump of M.
    slope : rad, > 0 and below the critical one.
    """
    found = steady(scene, slope=slope)
    node, saddle = found.V
    plane = -0.5 * saddle, 2.0 * saddle
    V = np.linspace(*plane, 801)
    half = contact(scene, V, delta=0.0, fields="delta_star").delta_star * np.abs(V)
    across = np.linspace(*plane, _POINTS)
    border = separatrix(scene, slope, across)
    motions, slow = _motions(scene, slope, plane), _slow_manifold(scene, slope, saddle, plane)
    angle = f"${np.degrees(slope):.3g}^\\circ$"
    title = f"A slope of {angle} for {describe(scene, 'alpha', 'kappa', 'mu', 'j')}" + caveat(scene, saddle)
    figure, (left, right) = new_figure(title, 1, 2, (10.0, 5.4))
    for axes, diagonal, unit in ((left, 1.0, 1.0), (right, 0.0, _STRETCH)):
        # the height over V: omega itself, or omega - V stretched
        axes.set_facecolor(SHADES["full slip"])
        low, high = (diagonal * V + side * unit * half for side in (-1.0, 1.0))
        axes.fill_between(V, low, high, color=SHADES["partial slip"])
        axes.plot(V, low, V, high, **_EDGE)

        def height(V: Any, omega: Any, diagonal: float = diagonal, unit: float = unit) -> Any:
            return unit * (omega - V) + diagonal * V

        for motion in motions:
            axes.plot(motion.V, height(motion.V, motion.omega), **_MOTION)
        for motion in slow:
            axes.plot(motion.V, height(motion.V, motion.omega), **_SLOW)
        axes.plot(border, height(border, across), **_SEPARATRIX)
        for at, face in zip((0, 1), ("black", "white"), strict=True):
            point = found.V[at], height(found.V[at], found.omega[at])
            axes.plot(*point, "o", color="black", markerfacecolor=face, markersize=6, zorder=4)
    for motion in (*motions, *slow):
        _arrow(left, motion, plane)
    left.set(xlim=plane, ylim=plane, aspect="equal", xlabel=label("V"), ylabel=label("omega"))
    inside = (V > -0.2 * saddle) & (V < 1.6 * saddle)
    stretched = 1.2 * _STRETCH * float(half[inside].max())
    right.set(xlim=(-0.2 * saddle, 1.6 * saddle), ylim=(-stretched, stretched), xlabel=label("V"))
    right.set_ylabel(r"$(\omega - V)\times 10^3$")
    figure.legend(handles=_legend(node, saddle), loc="outside lower center", ncols=4, frameon=False, fontsize="small")
    return figure


def _arrow(axes: Any, motion: Motion, plane: tuple[float, float]) -> None:
    """An arrowhead halfway along what the plane shows of a motion, or of its slip where it begins with that."""
    inside = (motion.V > plane[0]) & (motion.V < plane[1])
    inside &= motion.regime == motion.regime[0]
    V, omega = motion.V[inside], motion.omega[inside]
    way = np.append(0.0, np.cumsum(np.hypot(np.diff(V), np.diff(omega))))
    ends = [[np.interp(share * way[-1], way, along) for along in (V, omega)] for share in (0.45, 0.5)]
    style = {"arrowstyle": "-|>", "color": "0.1", "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", ends[1], ends[0], arrowprops=style)


def _legend(node: float, saddle: float) -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    shades: list[Any] = [Patch(facecolor=grey, edgecolor="0.5", label=regime) for regime, grey in SHADES.items()]
    lines: dict[str, dict[str, Any]] = {
        rf"$|\delta| = {SYMBOLS['delta_star'].latex}$": _EDGE,
        "motions": _MOTION,
        "slow manifold": _SLOW,
        "separatrix: beyond it all run away": _SEPARATRIX,
        f"stable, V = {node:.3g}": {"marker": "o", "linestyle": "", "color": "black"},
        f"saddle, V = {saddle:.3g}": {"marker": "o", "linestyle": "", "color": "black", "markerfacecolor": "white"},
    }
    return shades + [Line2D([], [], label=text, **style) for text, style in lines.items()]


def separatrix(scene: Scene, slope: float, omega: NDArray[np.float64]) -> NDArray[np.float64]:
    """V of the starts that end at the saddle: from less V motions run to the node, from more they run away."""
    found = steady(scene, slope=slope)
    V2, omega2 = found.V[1], found.omega[1]
    rate = found.eigenvalues[1].real.max() * scene.gamma * np.cos(slope)
    # V + j omega hardly changes while slip is fast
    guess = V2 + scene.j * (omega2 - omega)
    low, high = guess - V2, guess + V2
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        end = ensemble(scene, middle, omega, _FOLDINGS / rate, slope=slope, rtol=1e-6, fields=("V",))
        runs_away = np.ravel(np.asarray(end.V)) > V2
        low, high = np.where(runs_away, low, middle), np.where(runs_away, middle, high)
    return 0.5 * (low + high)


def _motions(scene: Scene, slope: float, plane: tuple[float, float]) -> list[Motion]:
    """From the upper and the lower edge of the plane, at the steps of the integrator and between."""
    starts = np.linspace(*plane, _STARTS + 2)[1:-1]
    end = _FOLLOWED / scene.gamma
    return [_fine(roll(scene, V, omega, end, 1e-6, slope=slope)) for V in starts for omega in plane]


def _slow_manifold(scene: Scene, slope: float, saddle: float, plane: tuple[float, float]) -> list[Motion]:
    """Both ways from beside the saddle, and from V < 0 on."""
    equilibrium = steady(scene, slope=slope)
    creep, end = equilibrium.omega[1] / saddle, _FOLLOWED / scene.gamma
    return [
        _fine(roll(scene, V, creep * V, 4.0 * end, 1e-6, slope=slope)) for V in (0.999 * saddle, 1.001 * saddle)
    ] + [_fine(roll(scene, plane[0], plane[0], end, 1e-6, slope=slope))]


def _fine(motion: Motion) -> Motion:
    """The motion at its output times, and at four times between neighbours."""
    return motion.at(np.unique(np.linspace(motion.t[:-1], motion.t[1:], 6)))
