"""Sensitivity of a fit to its grid of times: modulus, alpha and rolling resistance with a wider grid.

Speeds, moments and kappa are those of a :class:`viscoroll.Scene`: V in units of R/T_ref, M divided by P R.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...contact_law.contact import contact
from ...contact_law.validity.assumptions import transit_frequency
from ...core.array_types import Floats
from ...materials.measured import Measured
from ...materials.prony import Prony
from ...scene import Scene
from .mode_selection import grid_of_times
from .spectrum import Data, on_times

#: times of the wider grid a decade: twice as many as modes that a fit needs
_TIMES = 2.0
#: speeds a decade at which M is compared
_SPEEDS = 4


class ExtendedGridFit(NamedTuple):
    """A fit by non-negative least squares on the times of another fit and on a wider grid, beside that other fit.

    decades : number of decades by which the grid is wider on either side.
    E : long-time modulus of the wider fit, in the unit of the data.
    alpha : its instantaneous over its long-time modulus.
    prony : its series, strengths divided by its E and times over the T_ref of the fit.
    V : kappa V, V in R/T_ref and kappa of the fit, dimensionless, (n,): speeds at which the transit frequency of the
        contact lies in ``transit_band`` of the data (:class:`viscoroll.Measured`); n may be 0.
    M, M_fit : kappa M of the wider fit and of the fit at these speeds and the same load, dimensionless, (n,).
    """

    decades: float
    E: float
    alpha: float
    prony: Prony
    V: Floats
    M: Floats
    M_fit: Floats

    @property
    def M_changes(self) -> Floats:
        """Relative change of M at the lowest, the middle and the highest of these speeds, (3,); of fewer speeds (n,).

        It is NaN or infinite where M is 0.
        """
        n = self.V.size
        return (self.M / self.M_fit - 1.0)[[*range(n)] if n < 3 else [0, n // 2, -1]]


def fit_on_extended_grid(
    data: Data, prony: Prony, E: float, T_ref: float, grid: tuple[float, float], decades: float
) -> ExtendedGridFit:
    """Fit strengths on the times of a fit and on a wider grid together, to see what the data leave open outside their
    range.

    No mode is left out to save modes: a fit with as few modes as possible would leave out those outside the data first,
    though the data allow them.  Modes to which non-negative least squares give no strength are left out.

    data : measured moduli, a :class:`.curve.Curve` or a :class:`.curve.Relaxation`.
    prony : :class:`Prony`, series of the fit, strengths divided by E, times over T_ref.
    E, T_ref : long-time modulus of the fit, in the unit of the data, and unit of its times, s.
    grid : (shortest, longest) time of its grid, s.
    decades : number of decades by which the grid becomes wider on either side, > 0; of a :class:`Relaxation` the
        shortest time stays at least half the first time of the data.
    Returns the :class:`ExtendedGridFit`, with kappa M of both fits at kappa V within the data, dimensionless, with the
    kappa of ``prony``, at the same load and radius: kappa of the wider fit is sqrt(its E / E) times that of the fit.
    Raises RuntimeError as :func:`.spectrum.on_times` does, ParameterError for modes that make no :class:`Prony`, as
    more than 64.
    """
    reach = 10.0**decades
    times = grid_of_times((max(grid[0] / reach, data.shortest), grid[1] * reach), _TIMES)
    found = on_times(data, np.concatenate([times, prony.tau * T_ref]))
    other = Prony(found.strength / found.E, found.tau / T_ref)
    V, M_fit = _moments_within_data(prony, *(rate * T_ref for rate in Measured(*data.band, 0.0).transit_band))
    M = _contact_of(other, float(np.sqrt(found.E / E)), V).M
    return ExtendedGridFit(decades, found.E, other.alpha, other, V, M, M_fit)


def _moments_within_data(prony: Prony, slow: float, fast: float) -> tuple[Floats, Floats]:
    """Compute the rolling moment of free rolling at speeds whose transit frequency |V|/(lam l0) lies in a band.

    prony : :class:`Prony`, series of the fit.
    slow, fast : lowest and highest transit frequency, times T_ref, dimensionless.
    Returns (kappa V, kappa M), (n,) each, dimensionless, in ascending order of V, about four speeds a decade; n may be
    0.  They are computed with kappa = 1 and mu = 1.
    """
    low, high = np.log10(slow / np.sqrt(prony.alpha)), np.log10(fast)
    V = np.logspace(low, high, 2 + int(_SPEEDS * (high - low)))
    state = _contact_of(prony, 1.0, V)
    passed = transit_frequency(V, state.lam)
    within = (passed >= slow) & (passed <= fast)
    return V[within], state.M[within]


def _contact_of(prony: Prony, kappa: float, V: Floats) -> Any:
    """Compute the contact in free rolling, delta = 0, at mu = 1.

    prony : :class:`Prony`, series of cylinder and half-space.
    kappa : slenderness R/l0, > 0, dimensionless: 1, or relative to that of another fit.
    V : speeds in units of R/T_ref, dimensionless, (n,); n may be 0.
    Returns the state with ``.lam`` (contact length divided by l0) and ``.M`` (rolling moment divided by P R), (n,)
    each, dimensionless.
    """
    return contact(Scene(material=prony, kappa=kappa, mu=1.0), V, delta=0.0, fields=("lam", "M"))
