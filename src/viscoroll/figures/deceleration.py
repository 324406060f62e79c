"""The deceleration: counterparts of the paper's Figs. 5, 6 and 7."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..contact_stress import stress
from ..motion import Motion, roll
from ..plots.style import LINES, MARKERS, THIN, caveat, describe, new_figure, number, scaled
from ..presets import PAPER_SECTION_5, PAPER_STARTS
from ..scene import Scene
from ..symbols import label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The times of the paper's Fig. 7, circles in Fig. 6.
PAPER_TIMES = (1.52e-4, 4e-4, 24e-4, 30e-4)
#: beta as the paper prints it at the first of these times
PAPER_BETA = 0.45
_SCENE = ("alpha", "kappa", "mu", "gamma")
_END, _TIMES = 4e-3, 2001
#: Times are shown in units of 1e-4.
_EXPONENT, _UNIT = 4, 1e4
#: Fig. 7: points of 801 that make the front edge, and how much of x/l0 its inset shows
_FRONT, _NEAR = 30, 0.02


def _rolled(scene: Scene, start: tuple[float, float]) -> Motion:
    """A motion with even output times, and closer ones around the onset of stick if there is one."""
    motion = roll(scene, *start, np.linspace(0.0, _END, _TIMES))
    if np.isnan(motion.onset_time):
        return motion
    close = motion.onset_time * np.linspace(0.9, 1.3, 401)
    return motion.at(np.unique(np.concatenate([motion.t, close[close < _END]])))


def figure_5(scene: Scene = PAPER_SECTION_5, starts: dict[str, tuple[float, float]] = PAPER_STARTS) -> Figure:
    """V and omega over time for each start (at most three); the inset shows the onset of stick of the first."""
    fastest = max(abs(start[0]) for start in starts.values())
    title = f"Deceleration, Eq. (22), for {describe(scene, *_SCENE)}" + caveat(scene, fastest)
    figure, axes = new_figure(title, size=(7.6, 5.4))
    motions = {name: _rolled(scene, start) for name, start in starts.items()}
    first = next(iter(motions.values()))
    inset = _inset(axes, (0.42, 0.69, 0.55, 0.28), first, (0.96, 1.06))
    for box, every in ((axes, 0.1), (inset, 0.4))[: 1 if inset is None else 2]:
        for (name, motion), line, marker in zip(motions.items(), LINES, MARKERS, strict=False):
            for quantity, dashes in (("V", "-"), ("omega", (0, (4, 2)))):
                style = {"color": line["color"], "linestyle": dashes, "marker": marker, "markevery": every}
                hollow = {"markersize": 4.5, "markerfacecolor": line["color"] if quantity == "V" else "white"}
                text = f"{name}: {label(quantity)}"
                box.plot(_UNIT * motion.t, getattr(motion, quantity), label=text, **style, **hollow)
    if inset is not None:
        middle, onset = np.interp(first.onset_time, first.t, first.V), _UNIT * first.onset_time
        inset.set_ylim(middle - 0.03, middle + 0.02)
        inset.axvline(onset, **THIN)
        inset.annotate(label("onset_time"), (onset, 0.06), (3, 0), ("data", "axes fraction"), "offset points")
        axes.indicate_inset_zoom(inset, edgecolor="0.3")
    axes.axhline(0.0, **THIN)
    low, high = axes.get_ylim()
    axes.set(xlim=(0.0, _UNIT * _END), ylim=(low, high + 0.2 * (high - low)))  # room for the inset
    axes.set(xlabel=scaled("t", _EXPONENT), ylabel=f"{label('V')}, {label('omega')}")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(motions), frameon=False)
    return figure


def _inset(axes: Any, place: tuple[float, ...], motion: Motion, span: tuple[float, float]) -> Any:
    """An inset over times from ``span[0]`` to ``span[1]`` times the onset of stick; None where there is no onset."""
    if np.isnan(motion.onset_time):
        return None
    inset = axes.inset_axes(place)
    inset.set_xlim(*(_UNIT * motion.onset_time * share for share in span))
    inset.locator_params(axis="x", nbins=5)
    inset.tick_params(labelsize="small")
    return inset


def figure_6(
    scene: Scene = PAPER_SECTION_5,
    start: tuple[float, float] = PAPER_STARTS["IC1"],
    times: tuple[float, ...] = PAPER_TIMES,
) -> Figure:
    """delta, lam, epsilon and beta over time (b), and around the onset of stick (a); circles at ``times``."""
    title = f"Contact during deceleration from {_start(start)} for {describe(scene, *_SCENE)}" + caveat(scene, start[0])
    motion, marked = _rolled(scene, start), roll(scene, *start, times)
    onset = _UNIT * motion.onset_time
    if np.isnan(onset):
        figure, axes = new_figure(title, size=(7.6, 4.4))
        panels = [(axes, "", _UNIT * _END)]
    else:
        figure, (near, whole) = new_figure(title, 1, 2, (9.6, 4.4), sharey=True, width_ratios=(1.0, 1.6))
        panels = [(near, "a) around the onset of stick", 1.25 * onset), (whole, "b) to rest", _UNIT * _END)]
    for axes, name, end in panels:
        for quantity, line in zip(("delta", "lam", "epsilon", "beta"), LINES, strict=True):
            along, at_times = (
                m.delta if quantity == "delta" else getattr(m.contact(quantity), quantity) for m in (motion, marked)
            )
            axes.plot(_UNIT * motion.t, along, label=label(quantity), **line)
            axes.plot(_UNIT * marked.t, at_times, "o", color=line["color"], markerfacecolor="none", markersize=5.5)
        axes.axhline(0.0, **THIN)
        axes.set(xlim=(0.0, end), ylim=(-0.75, 1.1), xlabel=scaled("t", _EXPONENT), title=name)
    panels[0][0].set_ylabel(", ".join(label(name) for name in ("delta", "lam", "epsilon", "beta")))
    panels[-1][0].legend(frameon=False, loc="lower right")
    return figure


def figure_7(
    scene: Scene = PAPER_SECTION_5,
    start: tuple[float, float] = PAPER_STARTS["IC1"],
    times: tuple[float, ...] = PAPER_TIMES,
) -> Figure:
    """Shear stress and mu p along the contact at four times of a motion."""
    title = (
        f"Stresses, Eqs. (11)-(13), during deceleration from {_start(start)}\nfor {describe(scene, *_SCENE)}"
        + caveat(scene, start[0])
    )
    figure, panels = new_figure(title, 2, 2, (8.4, 6.0), sharex=True, sharey=True)
    motion = roll(scene, *start, times)
    state = motion.contact(("lam", "epsilon", "beta"))
    for n, axes in enumerate(panels.flat):
        rear, front = 0.5 * state.lam[n] * (state.epsilon[n] + np.array([-1.0, 1.0]))
        x = 0.5 * (rear + front) - 0.5 * (front - rear) * np.cos(np.linspace(0.0, np.pi, 801))
        found = stress(scene, x, motion.V[n], delta=motion.delta[n])
        axes.plot(x, 1e3 * np.abs(found.tau), label=r"$|\tau|/E'$", **LINES[0])
        axes.plot(x, 1e3 * scene.mu * found.p, label=r"$\mu p/E'$", **LINES[1])
        axes.axvline(front - state.lam[n] * state.beta[n], **THIN, label="slip | stick")
        axes.axvline(0.0, color="0.7", linewidth=0.6, linestyle=":")
        text = f"{label('delta')} = ${number(motion.delta[n], 2)}$, {label('beta')} = {state.beta[n]:.3f}"
        axes.set_title(rf"{label('t')} = ${_UNIT * motion.t[n]:.3g}\times 10^{{-4}}$: {text}", fontsize="medium")
        if found.p[-_FRONT:].max() > found.p[-2 * _FRONT]:  # pressure rises towards the front edge
            _front_edge(axes, x, found, scene.mu)
    for axes in panels[1]:
        axes.set_xlabel("$x/l_0$")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"$|\tau|/E'$, $\mu p/E'$  ($\times 10^3$)")
    panels[0, 0].legend(frameon=False, loc="upper left")
    if (scene, start, times) == (PAPER_SECTION_5, PAPER_STARTS["IC1"], PAPER_TIMES):
        panels[0, 0].text(0.02, 0.6, _printed(motion), transform=panels[0, 0].transAxes, va="top", fontsize="small")
    return figure


def _printed(motion: Motion) -> str:
    """Why beta at the first of the paper's times is not what the paper prints."""
    near = motion.at(np.linspace(motion.onset_time, PAPER_TIMES[0], 101))
    beta = near.contact("beta").beta
    passed, rise = np.interp(PAPER_BETA, beta, near.t), (beta[-1] - beta[-2]) / (near.t[-1] - near.t[-2])
    return (
        f"the paper prints {label('beta')} = {PAPER_BETA},\n"
        rf"passed at {label('t')} = ${_UNIT * passed:.4g}\times 10^{{-4}}$:"
        f"\n{label('beta')} climbs here by\n{1e-6 * rise:.1g} in $10^{{-6}}$ of {label('t')}"
    )


def _front_edge(axes: Any, x: NDArray, found: Any, mu: float) -> None:
    """An inset of the front edge: material that has not relaxed yet makes a narrow peak there."""
    inset = axes.inset_axes((0.52, 0.5, 0.4, 0.42))
    inset.plot(x, 1e3 * mu * found.p, **LINES[1])
    inset.plot(x, 1e3 * np.abs(found.tau), **LINES[0])
    near = x > x[-1] - _NEAR
    inset.set(xlim=(x[-1] - _NEAR, x[-1] + 0.15 * _NEAR), ylim=(0.0, 1.3e3 * mu * float(found.p[near].max())))
    inset.set_title("front edge", fontsize="small")
    inset.locator_params(nbins=3)
    inset.tick_params(labelsize="small")


def _start(start: tuple[float, float]) -> str:
    return f"$V(0) = {start[0]:g}$, {label('omega')}$(0) = {start[1]:g}$"
