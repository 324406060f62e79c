"""The pressure of a cover along its contact, and the mean strain of the surface that it makes as on half-spaces.

Notation as in :mod:`.cover_solve`: z is half the contact length over V T_ref, with T_ref the unit of time of the
cover's series; x is the position from the middle of the contact over half its length, 1 at the front edge; the pressure
p is sqrt(1 - x^2) sum q_m U_(m-1)(x).
"""

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
    """Return the pressure along the contact over 2 P/(pi a), the largest pressure of Hertz for the load P on the half
    length a.

    modes: :class:`CoverModes` of the cover and the other body.
    z: a divided by V T_ref, dimensionless, > 0; infinite for V = 0, where the bodies are taken as elastic with their
        long-time moduli.
    theta: a divided by the thickness, dimensionless, in (0, 6].
    x: positions divided by a, from the middle of the contact, positive along V, any shape.
    Returns the pressure, dimensionless, in the shape of x; 0 at the ends of and outside [-1, 1].
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


def local_strain(modes: CoverModes, z: float, state: CoverState) -> float:
    """Return the mean strain of the layer's surface by the coupling of half-spaces, less that of the other body.

    The strain at each point is -C J p: C = (1 - 2 nu)/(2 - 2 nu), J the compliance of the body with its memory, p the
    pressure; the mean over the contact has the pressure as weight.  It is accurate to 1e-5 of itself, as the pressure
    is taken as linear between points.
    modes: :class:`CoverModes` of the cover and the other body.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of the contact of that length.
    Returns a float, the strain in units of V T_ref/R, positive where the layer's surface is stretched relative to the
    other.  It is exactly 0.0 for nu = 1/2 of the layer beside a rigid body or one of nu = 1/2.
    """
    local = modes.nodes.local
    if local == 0.0 and modes.other_local == 0.0:
        return 0.0
    squared, remembered = _pressure_products(modes, z, state)
    own = local * (modes.layer_instant * squared + modes.layer_J @ remembered)
    return float(2.0 / (math.pi * state.q[0]) * (modes.other_local * squared - own))


def _pressure_products(modes: CoverModes, z: float, state: CoverState) -> tuple[float, Floats]:
    """Return the integrals over the contact of p^2, and of p times the memory of p of each creep mode of the layer.

    The memory is f_j(x) = int_0^inf beta_j exp(-beta_j s) p(x + s) ds with beta_j = b_j z; it runs from the front edge
    x = 1 to the rear.  p is linear between 513 points that are equidistant in arccos x.
    modes: :class:`CoverModes` of the cover and the other body.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of the contact of that length.
    Returns (int p^2 dx, a float; int p f_j dx, (creep modes of the layer,), empty for an elastic layer), x from -1 to
    1, with p in the unit of the coefficients q.
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
