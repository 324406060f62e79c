"""The contact law: a rubber roller in SI units, counterparts of the paper's Figs. 2 and 3, the grid of make tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscoroll.contact_law.contact import contact
from viscoroll.core.plots.style import LINES, THIN, axis_label, new_figure
from viscoroll.presets import PAPER_FIGURES_2_3, RUBBER_CYLINDER

from .title import describe, scaled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST_SPEED, _MOST_CREEP = 0.4, 4e-3


def figure_2() -> Figure:
    """Critical creep ratio delta_star over V, one line an alpha."""
    scene = PAPER_FIGURES_2_3
    V = np.linspace(0.0, _MOST_SPEED, 401)
    figure, axes = new_figure(f"Critical creep ratio, Eq. (9), for {describe(scene, 'mu', 'kappa')}")
    for alpha, line in zip((1.0, 1.5, 21.5, 81.5), LINES, strict=True):
        star = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="delta_star").delta_star
        axes.plot(V, 1e3 * star, label=rf"{axis_label('alpha')} = {alpha:g}", **line)
    axes.set(xlabel=axis_label("V"), ylabel=r"$\delta^*_\alpha\times 10^3$", xlim=(0.0, _MOST_SPEED), ylim=(0.0, None))
    axes.legend(frameon=False)
    return figure


def figure_3() -> Figure:
    """(a) traction Q over delta at some speeds; (b) moment M over V at some alphas."""
    scene = PAPER_FIGURES_2_3
    title = f"Traction and rolling resistance, Eqs. (17), (18), for {describe(scene, 'mu', 'kappa')}"
    figure, (left, right) = new_figure(title, 1, 2, (9.0, 4.0))
    delta, V = np.linspace(-_MOST_CREEP, _MOST_CREEP, 801), np.linspace(-_MOST_SPEED, _MOST_SPEED, 801)
    for speed, line in zip((0.1, 0.2, 0.4), LINES, strict=False):
        Q = contact(scene, speed, delta=delta, fields="Q").Q
        left.plot(1e3 * delta, Q, label=f"{axis_label('V')} = {speed:g}", **line)
    for alpha, line in zip((1.5, 21.5, 81.5), LINES, strict=False):
        M = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="M").M
        right.plot(V, 1e3 * M, label=f"{axis_label('alpha')} = {alpha:g}", **line)
    left.set(xlabel=scaled("delta", 3), ylabel=axis_label("Q"), title=f"a) {describe(scene, 'alpha')}")
    right.set(xlabel=axis_label("V"), ylabel=scaled("M", 3), title=f"b) any {axis_label('delta')}")
    for axes in (left, right):
        axes.axhline(0.0, **THIN)
        axes.axvline(0.0, **THIN)
        axes.legend(frameon=False, loc="upper left")
    return figure


def grid(table: xr.Dataset) -> Figure:
    """Q over V and delta as ``make tables`` wrote it, at three alphas: the surface whose slices are Fig. 3a."""
    table = table.sel(alpha=[1.5, 11.0, 81.5])
    drawn = table.Q.plot(x="V", y="delta", col="alpha", xscale="log", figsize=(9.6, 3.4))
    for axes, star in zip(drawn.axs.flat, table.delta_star.T, strict=True):
        axes.plot(table.V, star, color="black")
    return drawn.fig


def rubber_roller() -> Figure:
    """A rubber roller in SI units, launched without rotation."""
    return RUBBER_CYLINDER.roll(2.0, 0.0, np.linspace(0.0, 0.4, 401)).plot()
