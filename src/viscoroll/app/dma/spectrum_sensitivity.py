"""Sensitivity of a fit to its grid of times: modulus, alpha and rolling resistance with a wider grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...contact_law.contact import contact
from ...contact_law.validity.assumptions import transit_frequency
from ...core.array_types import Floats
from ...materials.prony import Prony
from ...scene import Scene
from .mode_selection import grid_of_times
from .spectrum import Data, on_times

#: times of the wider grid a decade: twice as many as modes that a fit needs
_TIMES = 2.0
#: speeds a decade at which M is compared
_SPEEDS = 4


@dataclass(frozen=True, eq=False)
class ExtendedGridFit:
    """Non-negative least squares on the times of a fit and on two a decade that reach further beyond the data.

    decades : by which the grid is wider on either side.
    E, alpha, prony : its long-time modulus, ratio of moduli and series, the latter over the T_ref of the fit.
    V : speeds in R/T_ref times kappa of the fit; the transit times of the contact lie within the data.
    M, M_fit : kappa M of the wider fit and of the fit, at the same load; kappa is that of the fit.
    """

    decades: float
    E: float
    alpha: float
    prony: Prony
    V: Floats
    M: Floats
    M_fit: Floats

    @property
    def M_change(self) -> float:
        """Largest relative change of M at these speeds; NaN where there are none."""
        return float(np.abs(self.M / self.M_fit - 1.0).max()) if self.V.size else float("nan")


def fit_on_extended_grid(
    data: Data, prony: Prony, E: float, T_ref: float, grid: tuple[float, float], decades: float
) -> ExtendedGridFit:
    """Fit strengths on the times of a fit and of a wider grid together; no mode is left out.

    data : the curve.
    prony, E, T_ref : series, long-time modulus and reference time of the fit.
    grid : shortest and longest time of its grid.
    decades : number of decades by which the grid becomes wider on either side.
    Returns the wider fit.  A fit with as few modes as possible would leave out those outside the data first, though the
    data allow them.
    """
    reach = 10.0**decades
    times = grid_of_times((max(grid[0] / reach, data.shortest), grid[1] * reach), _TIMES)
    found = on_times(data, np.concatenate([times, prony.tau * T_ref]))
    other = Prony(found.strength / found.E, found.tau / T_ref)
    V, M_fit = _moments_within_data(prony, *(rate * T_ref for rate in data.band))
    M = _contact_of(other, float(np.sqrt(found.E / E)), V).M
    return ExtendedGridFit(decades, found.E, other.alpha, other, V, M, M_fit)


def _moments_within_data(prony: Prony, slow: float, fast: float) -> tuple[Floats, Floats]:
    """Return kappa V and kappa M at speeds whose transit frequencies |V|/(lam l0) lie within the data.

    prony : series of the fit.
    slow, fast : lowest and highest frequency of the data, times T_ref.
    Returns kappa V and kappa M, (n,) each, dimensionless.
    """
    low, high = np.log10(slow / np.sqrt(prony.alpha)), np.log10(fast)
    V = np.logspace(low, high, 2 + int(_SPEEDS * (high - low)))
    state = _contact_of(prony, 1.0, V)
    passed = transit_frequency(V, state.lam)
    within = (passed >= slow) & (passed <= fast)
    return V[within], state.M[within]


def _contact_of(prony: Prony, kappa: float, V: Floats) -> Any:
    """Return lam and M of free rolling of a series at speeds V, for a slenderness kappa."""
    return contact(Scene(material=prony, kappa=kappa, mu=1.0), V, delta=0.0, fields=("lam", "M"))
