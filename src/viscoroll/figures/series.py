"""The law for one to many relaxation times and for two bodies, and the stresses of a broad material."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..contact_stress import stress
from ..materials.bodies import Bodies
from ..materials.prony import Prony
from ..plots.style import LINES, THIN, new_figure, number
from ..rolling_contact import contact
from ..scene import Scene
from ..symbols import label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: alpha of the materials that are shown
_ALPHA = 11.0
_SHOWN = ("lam", "epsilon", "delta_star", "M")


def broad(modes: int, decades: float, alpha: float = _ALPHA) -> Prony:
    """Modes of equal strength, their times even in their logarithm from 1 down."""
    times = np.logspace(0.0, -decades, modes) if modes > 1 else np.ones(1)
    return Prony(np.full(modes, (alpha - 1.0) / modes), times)


def _modes() -> dict[str, Prony]:
    return {
        "1 mode": broad(1, 0.0), "2 modes, 5 decades": broad(2, 5.0), "5 modes, 5 decades": broad(5, 5.0),
        "10 modes, 10 decades": broad(10, 10.0),
    }  # fmt: skip


def _pairs() -> dict[str, Prony | Bodies]:
    soft, stiff = broad(5, 5.0), broad(3, 2.0, 3.0)
    return {
        "rubber on its like": soft, "rubber on a rigid base": Bodies(soft, Prony.elastic(), 1.0),
        "rubber on an elastic base, equally stiff": Bodies(soft, Prony.elastic(), 0.5),
        "rubber on another, three times as stiff": Bodies(soft, stiff, 0.75),
    }  # fmt: skip


def law_of_materials(
    materials: Mapping[str, Prony | Bodies] | None = None, title: str = "", *, halves: bool = False
) -> Figure:
    """lam, epsilon, kappa delta_star/mu and kappa M over kappa V, a line a material (at most four).

    Parameters
    ----------
    materials : by their labels; default: of one mode and of several, all of alpha = 11.
    title : default: says that.
    halves : draw the part of M in the half-space too, thin.
    """
    materials = _modes() if materials is None else materials
    title = title or rf"Equal strengths, times even over decades below the longest, {label('alpha')} = {_ALPHA:g}"
    figure, axes = new_figure(title, 2, 2, (9.0, 6.4), sharex=True)
    V = np.logspace(-3.0, 9.0, 601)
    for (name, material), line in zip(materials.items(), LINES, strict=False):
        found = contact(Scene(material=material, kappa=1.0, mu=1.0), V, delta=0.0, fields=(*_SHOWN, "M_half_space"))
        for each, field in zip(axes.flat, _SHOWN, strict=True):
            each.semilogx(V, getattr(found, field), label=name, **line)
        if halves:
            axes[1, 1].semilogx(V, found.M_half_space, **line | {"linewidth": 0.7, "alpha": 0.8})
    labels = (label("lam"), label("epsilon"), r"$\kappa\delta^*/\mu$", label("kappa_M"))
    for each, text in zip(axes.flat, labels, strict=True):
        each.set(ylabel=text, ylim=(0.0, None))
    for each in axes[1]:
        each.set(xlabel=label("kappa_V"), xlim=(V[0], V[-1]))
    axes[0, 1].legend(frameon=False, fontsize="small")
    return figure


def law_of_pairs() -> Figure:
    """The same for a rubber on its like, on a rigid and on an elastic base, and on another rubber."""
    title = f"A rubber of 5 modes over 5 decades on four bases; thin: the part of {label('M')} in the half-space"
    return law_of_materials(_pairs(), title, halves=True)


def broad_stresses(material: Prony | None = None, speeds: tuple[float, ...] = (1e-2, 1.0, 1e3, 1e7)) -> Figure:
    """(a) pressure and (b) shear over the contact, a line a speed kappa V (at most four), at half the critical creep.

    Parameters
    ----------
    material : default: ten modes over ten decades.
    speeds : kappa V.
    """
    material = broad(10, 10.0) if material is None else material
    scene = Scene(material=material, kappa=1.0, mu=1.0)
    title = rf"{material.E.size} modes, $\alpha = {material.alpha:g}$, at $\delta = \delta^*/2$"
    figure, axes = new_figure(title, 1, 2, (9.0, 4.0), sharex=True)
    peak = 1.0 / (8.0 * np.pi)  # p_0 kappa/E' of the contact at rest, 4/pi of its mean pressure
    for V, line in zip(speeds, LINES, strict=False):
        state = contact(scene, V, delta=0.0)
        middle, half = 0.5 * state.lam * state.epsilon, 0.5 * state.lam
        x = middle + half * np.cos(np.linspace(np.pi, 0.0, 801))
        found = stress(scene, x, V, delta=0.5 * state.delta_star)
        for each, values in zip(axes, (found.p, found.tau), strict=True):
            each.plot(x, values / peak, label=rf"{label('kappa_V')} = ${number(V)}$", **line)
    for each, text, name in zip(axes, (r"$p/p_0$", r"$\tau/(\mu p_0)$"), ("a) pressure", "b) shear"), strict=True):
        each.axvline(0.0, **THIN)
        each.set(xlabel=r"$x/l_0$", ylabel=text, title=name, ylim=(0.0, None))
    axes[0].legend(frameon=False, fontsize="small")
    return figure
