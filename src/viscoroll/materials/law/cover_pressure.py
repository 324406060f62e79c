"""The pressure of a cover along its contact, and the mean strain of the surface that it makes as on half-spaces."""

from __future__ import annotations

import math

import numpy as np

from ...core.array_types import Floats
from .cover_solve import LARGE_ALPHA, CoverModes, CoverState, solve

#: intervals in arccos x for the integral of the local strain; accurate to 1e-5
_INTERVALS = 512
#: exponent of the decay over an interval above which nothing is left in double precision
_DECAYED = 700.0


def pressure(modes: CoverModes, z: float, theta: float, x: Floats) -> Floats:
    """Return the pressure along the contact, divided by 2 P/(pi a), the largest pressure of Hertz on half length a.

    modes: of the cover.
    z: a divided by V T_ref, > 0; infinite for V = 0.
    theta: a divided by the thickness.
    x: positions divided by a, from the middle of the contact, positive along V, any shape.
    Returns the pressure, dimensionless, in the shape of x; 0 outside [-1, 1].
    """
    from numpy.polynomial.chebyshev import chebder, chebval

    if z == np.inf:
        modes, z = modes.elastic(modes.share), 1.0
    state = solve(modes, z, theta)
    # I_n/I_0 is below rounding from n = 9 sqrt(alpha) on
    width = math.sqrt(min(z * modes.series.a.max(initial=0.0), LARGE_ALPHA))
    terms = _pressure_terms(modes, z, state, max(state.q.size, math.ceil(9.0 * width)) + 40)
    # U_(m-1) is the derivative of T_m/m
    series = chebder(np.append(0.0, terms / np.arange(1, terms.size + 1)))
    inside = np.clip(x, -1.0, 1.0)
    return np.sqrt((1.0 - inside) * (1.0 + inside)) * chebval(inside, series) / state.q[0]


def _pressure_terms(modes: CoverModes, z: float, state: CoverState, count: int) -> Floats:
    """Return the first coefficients of the pressure, q_m for m = 1, 2, ..., (count,).

    The pressure is sqrt(1 - x^2) sum q_m U_(m-1)(x), x in [-1, 1].
    modes: of the cover.
    z: half contact length divided by V T_ref.
    state: contact of that length; its own coefficients are taken, further ones follow from its relaxation modes.
    count: number of coefficients, not below that of ``state``.
    """
    from scipy.special import ive

    alpha = np.minimum(modes.series.a * z, LARGE_ALPHA)
    terms = 2.0 * (ive(np.arange(1, count + 1)[:, None], alpha) / ive(0, alpha)) @ state.X
    terms[: state.q.size] = state.q
    return terms


def local_strain(modes: CoverModes, z: float, state: CoverState) -> float:
    """Return the mean strain by the coupling of half-spaces, -C J p at each point, less that of the other body.

    The mean over the contact has the pressure as weight.  It is 0 for nu = 1/2 of both bodies, and accurate to 1e-5 of
    itself: the pressure is taken as linear between points.
    modes: of the cover.
    z: half contact length divided by V T_ref.
    state: contact of that length.
    Returns the strain in units of V T_ref/R, positive where the surface is stretched.
    """
    local = modes.nodes.local
    if local == 0.0 and modes.other_local == 0.0:
        return 0.0
    squared, remembered = _pressure_products(modes, z, state)
    own = local * (modes.layer_instant * squared + modes.layer_J @ remembered)
    return float(2.0 / (math.pi * state.q[0]) * (modes.other_local * squared - own))


def _pressure_products(modes: CoverModes, z: float, state: CoverState) -> tuple[float, Floats]:
    """Return int p^2 dx, and int p f_j dx with f_j = int_0^inf beta_j exp(-beta_j s) p(x + s) ds of each creep mode.

    p is linear between points that are equidistant in arccos x; the memory runs from the front edge x = 1 to the rear.
    modes: of the cover.
    z: half contact length divided by V T_ref.
    state: contact of that length.
    Returns (the first integral; the second ones, (creep modes of the layer,)), with p in the unit of the coefficients
    q.
    """
    from scipy.fft import dst

    terms = _pressure_terms(modes, z, state, _INTERVALS - 1)
    p = np.concatenate([[0.0], 0.5 * dst(terms, type=1), [0.0]])
    t = np.arange(_INTERVALS + 1) * (math.pi / _INTERVALS)
    x, weights = np.cos(t), np.sin(t) * (math.pi / _INTERVALS)
    step = np.minimum(modes.layer_b[:, None] * z * (x[:-1] - x[1:]), _DECAYED)
    decay, gone = np.exp(-step), -np.expm1(-step)
    # for a linear p: its value at the near end, and its increase towards the far end, times the mean distance
    mean = gone / step - decay
    f, reach = gone * p[1:] + (p[:-1] - p[1:]) * mean, 1
    while reach < _INTERVALS:  # f_{k+1} = decay_k f_k + gain_k, for all k at once by doubling
        f[:, reach:] += decay[:, reach:] * f[:, :-reach].copy()
        decay[:, reach:] *= decay[:, :-reach].copy()
        reach *= 2
    return float(weights @ (p * p)), (f * p[1:]) @ weights[1:]
