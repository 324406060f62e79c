"""The contact during a deceleration: counterpart of the paper's Fig. 7."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscoroll.contact_mechanics.stress import stress
from viscoroll.core.plots import LINES, THIN, axis_label, new_figure
from viscoroll.motion.roll import roll
from viscoroll.presets import PAPER_SECTION_5, PAPER_STARTS

from .title import describe, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The times of the paper's Fig. 7.
PAPER_TIMES = (1.52e-4, 4e-4, 24e-4, 30e-4)
_SCENE = ("alpha", "kappa", "mu", "gamma")
#: Times are shown in units of 1e-4.
_UNIT = 1e4


def figure_7() -> Figure:
    """Shear stress and mu p along the contact at four times of the paper's first motion."""
    scene = PAPER_SECTION_5
    start = PAPER_STARTS["IC1"]
    figure, panels = new_figure(
        f"Stresses during IC1, Eqs. (11)-(13), {describe(scene, *_SCENE)}",
        2,
        2,
        5.4,
        sharex=True,
        sharey=True,
    )
    motion = roll(scene, *start, PAPER_TIMES)
    state = motion.contact(("lam", "epsilon", "beta"))
    for n, axes in enumerate(panels.flat):
        rear, front = 0.5 * state.lam[n] * (state.epsilon[n] + np.array([-1.0, 1.0]))
        x = 0.5 * (rear + front) - 0.5 * (front - rear) * np.cos(np.linspace(0.0, np.pi, 801))
        found = stress(scene, x, motion.V[n], delta=motion.delta[n])
        axes.plot(x, 1e3 * np.abs(found.tau), label=r"$|\tau|/E'$", **LINES[0])
        axes.plot(x, 1e3 * scene.mu * found.p, label=r"$\mu p/E'$", **LINES[1])
        axes.axvline(front - state.lam[n] * state.beta[n], **THIN, label="slip | stick")
        axes.axvline(0.0, color="0.7", linewidth=0.6, linestyle=":")
        text = (
            f"{axis_label('delta')} = ${number(motion.delta[n], 2)}$, {axis_label('beta')} = "
            f"{state.beta[n]:.3f}"
        )
        time = rf"{axis_label('t')} = ${_UNIT * motion.t[n]:.3g}\times 10^{{-4}}$"
        axes.set_title(f"{time}:\n{text}", fontsize="medium")
    for axes in panels[1]:
        axes.set_xlabel("$x/l_0$")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"$|\tau|/E'$, $\mu p/E'$  ($\times 10^3$)")
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=3,
        frameon=False,
    )
    return figure
