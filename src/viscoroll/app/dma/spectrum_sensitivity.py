"""Accuracy of a fit: rolling resistance by all spectra that meet the data as well (:func:`admissible_spectra`).

Data over a limited band do not determine a spectrum.  For each speed the non-negative spectra are sought by which M is
smallest and largest, among those that meet the data as well as the fit does; the fit is one of them, and so is the
true spectrum, but for noise.  How far M is off for rubbers that are known is measured by
``pipeline/evidence/measure/fits.py``.

Speeds, moments and kappa are those of a :class:`viscoroll.Scene`: V in units of R/T_ref, M divided by P R.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...contact_law.contact import contact
from ...contact_law.validity.assumptions import transit_speeds
from ...core.array_types import Floats
from ...materials.measured import Measured
from ...materials.prony import Prony
from ...materials.prony_forms import LARGEST_TIME_RATIO, MOST_MODES
from ...scene import Scene
from .mode_selection import grid_of_times
from .spectrum import Data, LeastSquares, Spectrum, misfits

#: factor beyond the data on either side up to which times are allowed: slower and faster modes act as a constant and as
#: a dashpot there
_REACH = 100.0
#: times a decade: on three a spectrum of any modes meets exact data to 0.1 %
_TIMES = 3.0
#: speeds a decade
_SPEEDS = 2
#: rise of the sum of squares, in variances of a residual, within which spectra count as equally good: two standard
#: deviations
_RISE = 4.0
#: halvings of the weight of the pull on M
_HALVINGS = 9
#: decades of the weight, about the fourth root of the sum of squares that is allowed
_WEIGHTS = -3.0, 3.0
#: half the contact length times the wavenumber, at which the loss of a contact is summed: beyond lie 3 % of it
_WAVES = np.geomspace(0.02, 12.0, 80)


class AdmissibleSpectra(NamedTuple):
    """Spectra that meet the data of a fit as well as the fit: those with the smallest and the largest M at each speed.

    rate : transit frequencies of the contact, 1/s, (n,): those of the speeds, from the first to the last within
        :attr:`viscoroll.Measured.transit_band` of the data; n is 0 where that is empty, or where nothing relaxes.
    V, M : kappa V, V in R/T_ref, and kappa M of the fit at these speeds, both with the kappa of the fit, dimensionless,
        (n,).
    M_changes : M by each spectrum divided by M of the fit, at the same load, minus 1, (2 n, n).
    E : long-time modulus of each spectrum, in the unit of the data, (2 n,).
    alpha : instantaneous modulus of each spectrum divided by its long-time modulus, (2 n,).
    """

    rate: Floats
    V: Floats
    M: Floats
    M_changes: Floats
    E: Floats
    alpha: Floats

    @property
    def error(self) -> Floats:
        """Largest relative change of M at each speed, (n,), dimensionless: its accuracy as +-."""
        return np.abs(self.M_changes).max(axis=0, initial=0.0)


def admissible_spectra(data: Data, fit: Spectrum) -> AdmissibleSpectra:
    """Find the spectra with the smallest and the largest rolling moment at each of some speeds.

    A spectrum is admissible if its times are within two decades of the data (of a :class:`.curve.Relaxation` not below
    half the first time), its strengths are not negative, and the sum of the squared relative errors is at most that of
    the fit, or four variances of a residual above the least one, if that is more.

    data : measured moduli, a :class:`.curve.Curve` or a :class:`.curve.Relaxation`.
    fit : :class:`.spectrum.Spectrum`, the fit, whose times are allowed too.
    Returns the :class:`AdmissibleSpectra`.
    Raises RuntimeError as :func:`.spectrum.on_times` does.
    """
    (low, high), (slow, fast) = data.band, Measured(*data.band, 0.0).transit_band
    n = 2 + int(_SPEEDS * math.log10(fast / slow)) if fit.tau.size and slow < fast else 0
    rate, T_ref = np.geomspace(slow, fast, n), float(np.max(fit.tau)) if fit.tau.size else 1.0
    prony = Prony(fit.strength / fit.E, fit.tau / T_ref)
    V = transit_speeds(prony, rate * T_ref)
    M = _moments(prony, 1.0, V)
    reach = min(_REACH, math.sqrt(LARGEST_TIME_RATIO * low / high))
    times = grid_of_times((max(1.0 / (high * reach), data.shortest), reach / low), _TIMES)
    problem = LeastSquares(data, np.concatenate([times, fit.tau]))
    best = problem.solve()
    freedom = max(1, problem.right.size - int(np.count_nonzero(best)))
    own = data[0].size * sum(misfit * misfit for misfit in misfits(data, fit))
    allowed = max(own, problem.cost(best) * (1.0 + _RISE / freedom))
    changes, E, alpha = [], [], []
    for at in rate.tolist():
        pull = _slopes_of_moment(problem, best, at)
        for sign in (-1.0, 1.0):
            found = problem.spectrum(_pulled(problem, best, pull, sign, allowed), MOST_MODES)
            series = Prony(found.strength / found.E, found.tau / T_ref)
            changes.append(_moments(series, math.sqrt(found.E / fit.E), V) / M - 1.0)
            E.append(found.E)
            alpha.append(series.alpha)
    return AdmissibleSpectra(rate, V, M, np.reshape(changes, (2 * n, n)), np.array(E), np.array(alpha))


def _slopes_of_moment(problem: LeastSquares, best: Floats, rate: float) -> Floats:
    """Return the derivatives of ln M by the unknowns, of a contact with the pressure of Hertz.

    Its loss is the integral of the loss compliance at omega = 2 rate u, times (J_1(u)/u)^2 du, since the transform of
    the pressure is proportional to J_1(u)/u at the wavenumber u over half the contact length.

    problem : :class:`LeastSquares`, n unknowns: excess of the long-time modulus over the least one, and strengths.
    best : values of the unknowns at which the derivatives are taken, (n,).
    rate : transit frequency, 1/s.
    Returns them in the inverse of the unit of the unknowns, (n,).
    """
    from scipy.special import j1

    z = 2.0j * rate * _WAVES[:, None] * problem.tau
    parts = np.concatenate([np.ones((_WAVES.size, 1)), z / (1.0 + z)], axis=1) / problem.size
    modulus = problem.floor + parts @ best
    weight = j1(_WAVES) ** 2 / _WAVES  # in equal steps of ln u
    slopes: Floats = weight @ (parts / modulus[:, None] ** 2).imag / -(weight @ (1.0 / modulus).imag)
    return slopes


def _pulled(problem: LeastSquares, best: Floats, pull: Floats, sign: float, allowed: float) -> Floats:
    """Return the unknowns with a linear form as small or large as a sum of squares allows.

    The form is pulled towards a change of 1 by a further residual, whose weight is halved between what is allowed and
    what is not, in its logarithm.

    problem : :class:`LeastSquares`, n unknowns.
    best : values of the unknowns with the least sum of squares, (n,).
    pull : coefficients of the form, (n,).
    sign : 1.0 for the largest, -1.0 for the smallest value.
    allowed : largest sum of squares, dimensionless.
    """
    (low, high), found = _WEIGHTS, best
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        weight = 10.0**middle * allowed**0.25
        tried = problem.solve(weight * pull, weight * (pull @ best + sign))
        if problem.cost(tried) <= allowed:
            low, found = middle, tried
        else:
            high = middle
    return found


def _moments(prony: Prony, kappa: float, V: Floats) -> Any:
    """Compute the rolling moment in free rolling, delta = 0, at mu = 1.

    prony : :class:`Prony`, series of cylinder and half-space.
    kappa : slenderness R/l0, > 0, dimensionless: 1, or relative to that of another fit.
    V : speeds in units of R/T_ref, dimensionless, (n,); n may be 0.
    Returns M divided by P R, (n,).
    """
    return contact(Scene(material=prony, kappa=kappa, mu=1.0), V, delta=0.0, fields="M").M
