"""A rubber: its master curve with the fit, and its rolling resistance over speed at some temperatures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..dma import Fit, fit_prony
from ..plots.style import LINES, dashed, new_figure
from ..rolling_contact import contact
from ..scene import Scene
from ..symbols import label
from ..validity import held_speeds

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: a_T against 20 C of a rubber whose glass transition is at -60 C, with the universal constants of Williams, Landel
#: and Ferry, 17.44 and 51.6 K
_TEMPERATURES = {"-20 °C": 952.0, "20 °C": 1.0, "60 °C": 0.0254}
_SPEEDS = (1e-3, 1e2)


def rolling_resistance(
    fit: Fit | None = None,
    factors: Mapping[str, float] = _TEMPERATURES,
    R: float = 0.1,
    kappa: float = 10.0,
    unit: str = "Pa",
) -> Figure:
    """(a) storage and loss modulus with their fit; (b) M over the speed, a line a temperature (at most four).

    Parameters
    ----------
    fit : of :func:`viscoroll.fit_prony`; default: that of a rubber made up for the picture, 0.5 % noise.
    factors : label of a temperature and its shift factor a_T, times over those of the fit.
    R : radius of the cylinder, m.
    kappa : R/l0 with the long-time modulus of the fit.
    unit : of the moduli, as a label.
    """
    fit = _made_up() if fit is None else fit
    what = f"Rubber, Prony series of {fit.prony.E.size} modes: R = {R:g} m, R/l0 = {kappa:g} at rest"
    figure, (left, right) = new_figure(what, 1, 2, (9.0, 4.0))
    omega = np.geomspace(fit.omega[0], fit.omega[-1], 400)
    shown = (("E'", "o", fit.storage), ("E''", "s", fit.loss))
    for (name, marker, data), fitted, line in zip(shown, fit.modulus(omega), LINES, strict=False):
        left.loglog(fit.omega, data, marker, color=line["color"], markersize=3, fillstyle="none", label=f"${name}$")
        left.loglog(omega, fitted, label=f"${name}$, fit", **line)
    V = np.geomspace(*_SPEEDS, 241)
    low, high = held_speeds(fit.prony, fit.omega[0] * fit.T_ref, fit.omega[-1] * fit.T_ref)
    for (name, a_T), line in zip(factors.items(), LINES, strict=False):
        scene, speed = Scene(material=fit.prony.slower(a_T), kappa=kappa, mu=1.0), R / (kappa * a_T * fit.T_ref)
        M = contact(scene, V * fit.T_ref / R, delta=0.0, fields="M").M
        dashed(right, V, M, (low * speed, high * speed), label=name, **line)
    right.set(xscale="log", ylim=(0.0, None))
    left.set(xlabel=r"$\omega$, rad/s", ylabel=f"$E'$, $E''$, {unit}", title="a) master curve")
    right.set(title="b) rolling resistance; dashed: no data", xlabel="speed, m/s", ylabel=label("M"))
    for axes in (left, right):
        axes.legend(frameon=False)
    return figure


def _made_up() -> Fit:
    """A rubber from its plateau to its glass: strengths that rise towards short times, five points a decade."""
    tau = np.logspace(3, -9, 25)
    strength = 1e6 * (0.06 + 1.2e3 / (1.0 + (tau / 1e-7) ** 0.9))
    omega, noise = np.logspace(-4, 10, 71), np.random.default_rng(0)
    z = np.multiply.outer(omega, tau)
    storage, loss = 2e6 + (z**2 / (1.0 + z**2)) @ strength, (z / (1.0 + z**2)) @ strength
    error = 1.0 + 0.005 * noise.standard_normal((2, omega.size))
    return fit_prony(omega, storage * error[0], loss * error[1])
