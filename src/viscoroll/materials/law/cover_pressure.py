"""The pressure of a cover along its contact, and the strain of the surfaces that it makes as on half-spaces.

Notation as in :mod:`.cover_solve`: z is half the contact length over V T_ref, with T_ref the unit of time of the
cover's series; x is the position from the middle of the contact over half its length, 1 at the front edge; the pressure
p is sqrt(1 - x^2) sum q_m U_(m-1)(x).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from .cover_solve import LARGE_ALPHA, CoverModes, CoverState, solve

#: intervals in arccos x for the integral of the local strain; accurate to 1e-5
_INTERVALS = 512
#: exponent of the decay over an interval above which nothing is left in double precision
_DECAYED = 700.0


def pressure(modes: CoverModes, z: float, half: float, x: Floats) -> Floats:
    """Return the pressure along the contact over 2 P/(pi a), the largest pressure of Hertz for the load P on the half
    length a.

    modes: :class:`CoverModes` of the bodies.
    z: a divided by V T_ref, dimensionless, > 0; infinite for V = 0, where the bodies are taken as elastic with their
        long-time moduli.
    half: a divided by l0, dimensionless, at most six times the thickness of each layer.
    x: positions divided by a, from the middle of the contact, positive along V, any shape.
    Returns the pressure, dimensionless, in the shape of x; 0 at the ends of and outside [-1, 1].
    """
    from numpy.polynomial.chebyshev import chebder, chebval

    if z == np.inf:
        modes, z = modes.elastic(modes.cover.share), 1.0
    state = solve(modes, z, half)
    # I_n/I_0 is below rounding from n = 9 sqrt(alpha) on
    width = math.sqrt(min(z * modes.series.a.max(initial=0.0), LARGE_ALPHA))
    terms = _pressure_terms(modes, z, state, max(state.q.size, math.ceil(9.0 * width)) + 40)
    # U_(m-1) is the derivative of T_m/m
    series = chebder(np.append(0.0, terms / np.arange(1, terms.size + 1)))
    inside = np.clip(x, -1.0, 1.0)
    return np.sqrt((1.0 - inside) * (1.0 + inside)) * chebval(inside, series) / state.q[0]


def _pressure_terms(modes: CoverModes, z: float, state: CoverState, count: int) -> Floats:
    """Return the first coefficients of the pressure, more of them than the solve has.

    The pressure is sqrt(1 - x^2) sum q_m U_(m-1)(x), x in [-1, 1].
    modes: :class:`CoverModes` of the cover and the other body.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of the contact of that length; its own coefficients are taken, further ones follow from
        its relaxation modes and are 0 without such modes.
    count: number of coefficients, not below that of ``state``.
    Returns q_m for m = 1, 2, ..., (count,).
    """
    from scipy.special import ive

    alpha = np.minimum(modes.series.a * z, LARGE_ALPHA)
    terms = 2.0 * (ive(np.arange(1, count + 1)[:, None], alpha) / ive(0, alpha)) @ state.X
    terms[: state.q.size] = state.q
    return terms


class LocalPressure(NamedTuple):
    """The coupling C of short waves, that of half-spaces, of each body, times its compliance, of the pressure.

    terms : coefficients of T_n(x), over the compliance of both bodies, on the contact, (intervals + 1, 2).
    mirrored : mean of the coupling, mirrored about the middle of the contact, with the pressure as weight, (2,).
    """

    terms: Floats
    mirrored: Floats


def local_pressure(modes: CoverModes, z: float, state: CoverState) -> LocalPressure:
    """Return the coupling of the pressure as on half-spaces, by values at 513 points that are equidistant in arccos x.

    At each point it is C J p: C = (1 - 2 nu)/(2 - 2 nu), J the compliance of the body with its memory.  The mean is
    accurate to 1e-5 of itself, as the pressure is taken as linear between points.
    modes: :class:`CoverModes` of the bodies.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of the contact of that length.
    Returns :class:`LocalPressure`, with the base first; 0 of a body of nu = 1/2 and of a rigid one.
    """
    from scipy.fft import dct, dst

    p = np.zeros(_INTERVALS + 1)
    p[1:-1] = 0.5 * dst(_pressure_terms(modes, z, state, _INTERVALS - 1), type=1)
    t = np.arange(_INTERVALS + 1) * (math.pi / _INTERVALS)
    x, weights = np.cos(t), np.sin(t) * (math.pi / _INTERVALS) * p[::-1]
    a, _, e, _, _, _ = modes.series
    values, mirrored = np.zeros((2, p.size)), np.zeros(2)
    for n, body in enumerate(modes.bodies):
        if not body.local:
            continue
        own = body.instant * p + body.J @ _memory(p, x, body.b * z)
        mirrored[n] = 2.0 / (math.pi * state.q[0]) * body.local * (weights @ own)
        if modes.shares[n] == 1.0:
            values[n] = body.local * p
            continue
        # its compliance over that of both has poles at the relaxation rates of both
        J = body.instant - modes.weights[n] * modes.J * modes.series.b @ (1.0 / modes.gap)
        strengths = -(e * e * a) * J
        values[n] = body.local * (body.instant * modes.alpha * p + strengths @ _memory(p, x, a * z))
    terms = dct(values, type=1, axis=1).T / _INTERVALS
    terms[0] *= 0.5
    return LocalPressure(terms, mirrored)


def _memory(p: Floats, x: Floats, rates: Floats) -> Floats:
    """Return the memory that modes have of the pressure, f(x) = int_0^inf beta exp(-beta s) p(x + s) ds.

    It runs from the front edge x = 1 to the rear; p is linear between points.
    p: pressure at the points, 0 at both ends, in any unit, (n + 1,).
    x: points, descending from 1 to -1.
    rates: beta of each mode, times half the contact length over V, > 0, (modes,).
    Returns f in the unit of p, (modes, n + 1).
    """
    step = np.minimum(rates[:, None] * (x[:-1] - x[1:]), _DECAYED)
    decay, gone = np.exp(-step), -np.expm1(-step)
    # for a linear p: its value at the near end, and its increase towards the far end, times the mean distance
    mean = gone / step - decay
    f, reach = np.zeros((rates.size, p.size)), 1
    f[:, 1:] = gone * p[1:] + (p[:-1] - p[1:]) * mean
    while reach < p.size - 1:  # f_{k+1} = decay_k f_k + gain_k, for all k at once by doubling
        f[:, 1 + reach :] += decay[:, reach:] * f[:, 1:-reach].copy()
        decay[:, reach:] *= decay[:, :-reach].copy()
        reach *= 2
    return f
