"""The contact law: counterparts of the paper's Figs. 2 and 3."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..rolling_contact import contact
from ..scene import PAPER_FIGURES_2_3, Scene
from ..symbols import label
from .style import LINES, describe, math, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_2(scene: Scene = PAPER_FIGURES_2_3, alphas: tuple[float, ...] = (1.0, 1.5, 21.5, 81.5)) -> Figure:
    """Critical creep ratio delta_star over V, one line an alpha."""
    V = np.linspace(0.0, 0.4, 401)
    figure, axes = new_figure(f"Critical creep ratio, Eq. (9): {describe(scene, 'mu', 'kappa')}")
    for alpha, line in zip(alphas, LINES, strict=False):
        star = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="delta_star").delta_star
        axes.plot(V, 1e3 * star, label=rf"${math('alpha')} = {alpha:g}$", **line)
    axes.set(xlabel=label("V"), ylabel=rf"${math('delta_star')}_\alpha\times 10^3$", xlim=(0.0, V[-1]), ylim=(0.0, None))
    axes.legend(frameon=False)
    return figure


def figure_3(
    scene: Scene = PAPER_FIGURES_2_3,
    speeds: tuple[float, ...] = (0.1, 0.2, 0.4),
    alphas: tuple[float, ...] = (1.5, 21.5, 81.5),
) -> Figure:
    """(a) traction Q over delta at three speeds; (b) moment M over V at three alphas."""
    figure, (left, right) = new_figure(
        f"Traction and rolling moment, Eqs. (17), (18): {describe(scene, 'mu', 'kappa')}", 1, 2, (9.0, 4.0)
    )
    delta = np.linspace(-4e-3, 4e-3, 801)
    for V, line in zip(speeds, LINES, strict=False):
        left.plot(1e3 * delta, contact(scene, V, delta=delta, fields="Q").Q, label=rf"$V = {V:g}$", **line)
    left.set(xlabel=rf"${math('delta')}\times 10^3$", ylabel=label("Q"), title=rf"a) ${math('alpha')} = {scene.alpha:g}$")
    V = np.linspace(-0.4, 0.4, 801)
    for alpha, line in zip(alphas, LINES, strict=False):
        M = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="M").M
        right.plot(V, 1e3 * M, label=rf"${math('alpha')} = {alpha:g}$", **line)
    right.set(xlabel=label("V"), ylabel=rf"${math('M')}\times 10^3$", title="b)")
    for axes in (left, right):
        axes.axhline(0.0, color="0.7", linewidth=0.6)
        axes.axvline(0.0, color="0.7", linewidth=0.6)
        axes.legend(frameon=False, loc="upper left")
    return figure
