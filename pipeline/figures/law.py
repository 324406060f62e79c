"""The contact law: a rubber roller in SI units, counterparts of the paper's Figs. 2 and 3, the grid
of make tables.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscoroll.contact_mechanics.contact import contact
from viscoroll.core.plots import LINES, THIN, axis_label, new_figure
from viscoroll.presets import PAPER_FIGURES_2_3, RUBBER_CYLINDER

from .title import describe, scaled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST_SPEED = 0.4
_MOST_CREEP = 4e-3
#: label of the axis of speeds, dimensionless
_SPEED = r"speed $V T_\varepsilon/R$"
#: alphas of the grid that are drawn
_GRID_ALPHAS = (1.5, 11.0, 81.5)
#: levels of Q/P, up to mu of the grid
_LEVELS = np.linspace(-0.2, 0.2, 17)


def figure_2() -> Figure:
    """Critical creepage delta_star as a function of V, one line an alpha."""
    scene = PAPER_FIGURES_2_3
    V = np.linspace(0.0, _MOST_SPEED, 401)
    figure, axes = new_figure(f"Critical creepage, Eq. (9), for {describe(scene, 'mu', 'kappa')}")
    for alpha, line in zip((1.0, 1.5, 21.5, 81.5), LINES, strict=True):
        star = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="delta_star").delta_star
        axes.plot(V, 1e3 * star, label=rf"{axis_label('alpha')} = {alpha:g}", **line)
    axes.set(
        xlabel=_SPEED,
        ylabel=r"$\delta^*_\alpha\times 10^3$",
        xlim=(0.0, _MOST_SPEED),
        ylim=(0.0, None),
    )
    axes.legend(frameon=False)
    return figure


def figure_3() -> Figure:
    """(a) traction Q over delta at some speeds; (b) moment M over V at some alphas."""
    scene = PAPER_FIGURES_2_3
    title = (
        f"Traction and rolling resistance, Eqs. (17), (18), for {describe(scene, 'mu', 'kappa')}"
    )
    figure, (left, right) = new_figure(title, 1, 2, 3.6)
    delta = np.linspace(-_MOST_CREEP, _MOST_CREEP, 801)
    V = np.linspace(-_MOST_SPEED, _MOST_SPEED, 801)
    for speed, line in zip((0.1, 0.2, 0.4), LINES, strict=False):
        Q = contact(scene, speed, delta=delta, fields="Q").Q
        left.plot(1e3 * delta, Q, label=f"{axis_label('V')} = {speed:g}", **line)
    for alpha, line in zip((1.5, 21.5, 81.5), LINES, strict=False):
        M = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="M").M
        right.plot(V, 1e3 * M, label=f"{axis_label('alpha')} = {alpha:g}", **line)
    left.set(
        xlabel=scaled("delta", 3),
        ylabel="creep force $Q/P$",
        title=f"a) {describe(scene, 'alpha')}",
    )
    right.set(
        xlabel=_SPEED,
        ylabel=r"rolling resistance $M/(PR)\times 10^3$",
        title=f"b) any {axis_label('delta')}",
    )
    for axes in (left, right):
        axes.axhline(0.0, **THIN)
        axes.axvline(0.0, **THIN)
        axes.legend(frameon=False, loc="upper left")
    return figure


def grid(table: xr.Dataset) -> Figure:
    """Q over V and delta as ``make tables`` wrote it, at three alphas: the surface whose slices are
    Fig. 3a.
    """
    figure, panels = new_figure(
        "Creep force of the grid; dashed: critical creepage", 1, 3, 3.2, sharey=True
    )
    for axes, alpha in zip(panels, _GRID_ALPHAS, strict=True):
        plane = table.sel(alpha=alpha)
        filled = axes.contourf(
            plane.V, plane.delta, plane.Q.transpose("delta", "V"), _LEVELS, cmap="cividis"
        )
        for sign, color in ((1.0, "black"), (-1.0, "white")):
            axes.plot(plane.V, sign * plane.delta_star, color=color, linestyle="--", linewidth=1.2)
        axes.set(xscale="log", xlabel=r"speed $V T_\varepsilon/R$", title=rf"$\alpha = {alpha:g}$")
        axes.set_ylim(float(plane.delta[0]), float(plane.delta[-1]))
    panels[0].set_ylabel(rf"creepage {axis_label('delta')}")
    figure.colorbar(filled, ax=panels, label="creep force $Q/P$")
    return figure


def rubber_roller() -> Figure:
    """A rubber roller in SI units, launched without rotation."""
    return RUBBER_CYLINDER.roll(2.0, 0.0, np.linspace(0.0, 0.4, 401)).plot()
