"""Flow map, starts in partial slip: the search for the onset of partial slip that the start would have come from.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.

Terms of this file:

- Flow: record of the flow map of one scene: ``table``, the vector of all its tables; kappa, mu, j; ``first``, the
  exponent from which kappa V at onset is tabulated.
- Slow manifold: the creepage delta as a function of V that all motions in partial slip approach and then keep.
- Boundary layer: the time after the onset of partial slip in which delta approaches the manifold.  E = k0 (tau -
  tau_onset) is its stiff time, k0 the relaxation rate at onset.
- Layer coordinate u: a function of E, 2^LAYER_LOW at the onset; u = 1 at the split, an E near the place where motions
  of the family pass delta = 0, or 1 where they do not.
- Family: PLUS (0) if omega > V at the onset, MINUS (1) if omega < V; V > 0.
"""

import numpy as np

from ..compile.jit import inline_kernel, kernel
from . import layout
from .layout import LAYER_CREEP, LAYER_LN_V, MINUS, PLUS
from .lookup import HIGHEST, LOWEST, SPEEDS, layer_value_and_slopes, locate_in_layer, manifold_at_speed, read_asymptote

#: a creepage closer to that of the slow manifold lies on it; the error of omega/V is as small
_ON_MANIFOLD = 1e-10
#: creepage difference below which the polynomials of the layer cannot separate a state from the slow manifold
_INDISTINGUISHABLE = 1e-9
#: largest relative residual in V of a solution; motions with a larger one are left to the integrator
_RESIDUAL = 1e-10
#: largest number of steps of Newton's iteration
_MAX_ITERATIONS = 12
#: step after which the iteration ends: the error that remains is about its square
_CONVERGED = 1e-7
#: lower end of the layer coordinate u
_LOWEST_U = 2.0**layout.LAYER_LOW
#: upper end of the layer coordinate u, one rounding below the table's edge
_HIGHEST_U = 2.0**layout.LAYER_HIGH * (1.0 - 2.0**-50)


@kernel
def _initial_u(size, slow, turns):
    """Return the first guess of the layer coordinate u at which delta has fallen to a given value, by Carter's law.

    size : float, delta/delta_star of the start, in [-1, 1], times 1 for PLUS and -1 for MINUS: negative beyond delta =
        0.
    slow : float, delta/delta_star on the slow manifold at the speed of the start, times the same sign; less than
        ``size``, in (-1, 1).
    turns : bool, whether motions of this family pass delta = 0 (then the layer has a split there).

    Returns u, a float from 2^LAYER_LOW on, below 1 before the split of the layer; it may lie beyond the end of the
    layer, to which the caller limits it.

    Carter's law is that of elastic bodies: with r = 1 - |delta|/delta_star the traction is 1 - r^2, so that dr/dE =
    (a^2 - r^2)/2 where a^2 is 1 minus the traction on the slow manifold.
    """
    traction = np.copysign(1.0 - (1.0 - abs(slow)) ** 2, slow)
    a = np.sqrt(1.0 - traction)
    if size > 0.0:
        r = 1.0 - size
        E = np.log((a + r) / max(a - r, 1e-14)) / a
        split = np.log((a + 1.0) / max(a - 1.0, 1e-14)) / a if turns else 1.0
        return _LOWEST_U + (1.0 - _LOWEST_U) * E / split if E < split else 1.0 + E - split
    r, b = 1.0 + size, max(1.0 + slow, 1e-3)
    return 1.0 + np.log((1.0 - b) / (1.0 + b) * (r + b) / max(r - b, 1e-14)) / b


@inline_kernel
def _clamp(x, low, high):
    """Return the nearest value to x in [low, high], floats with low < high; low if x is NaN."""
    x = x if x > low else low
    return x if x < high else high


@kernel
def find_onset(V, delta, edge, flow):
    """Find the onset of partial slip from which a state in partial slip would have come.

    V : float, speed of the axis, > 0.
    delta : float, creepage, |delta| < delta_star.
    edge : float, delta_star at V, > 0; it serves the first guess only.
    flow : Flow, of the scene; ``table``, ``first`` and kappa are read.

    Returns (family, kappa V at that onset, E, whether the map covers the state): int, float, float, bool.  family is
    PLUS or MINUS; E is the stiff time since that onset, in [0, LAYER_END].  A state on the slow manifold has family
    PLUS, kappa V of the state itself, and an infinite E.  The tests are made in this order:

    1. kappa V below LOWEST, or at least the smaller of HIGHEST and 2^(first + OCTAVES), or NaN: not covered.
    2. delta within 1e-10 of the manifold: covered, on the manifold.
    3. kappa V below 2^(first + 1) or above 2^(first + OCTAVES - 1), an octave inside of the tabulated onsets: not
       covered.
    4. An onset is found, with E at most LAYER_END: covered.
    5. Else, an E above LAYER_END included: covered, on the manifold, if delta is within 1e-9 of it; otherwise not.

    Where the state is not covered, a NaN of delta included, the first three have no meaning.

    Method: Newton's iteration in ln V at onset and in u, of at most 12 steps, applied to the logarithm of the distance
        from the manifold, which decreases nearly linearly in E; a solution counts if V (relative) and delta (absolute)
        are met to 1e-10.
    """
    v = flow.kappa * V
    lowest, highest = 2.0**flow.first, 2.0 ** (flow.first + layout.OCTAVES)
    if not LOWEST <= v < min(highest, HIGHEST):
        return PLUS, v, 0.0, False
    _, slow = manifold_at_speed(v, flow.table)
    gap = delta - slow
    if abs(gap) < _ON_MANIFOLD:
        return PLUS, v, np.inf, True
    if not 2.0 * lowest <= v <= 0.5 * highest:
        return PLUS, v, 0.0, False
    family, sign = (PLUS, 1.0) if gap > 0.0 else (MINUS, -1.0)
    turns = read_asymptote(family, v, SPEEDS, flow).split != 1.0
    u = _initial_u(sign * delta / edge, sign * slow / edge, turns)
    v0, ln_v0, change = v, 0.0, np.inf
    for _ in range(_MAX_ITERATIONS):
        u = _clamp(u, _LOWEST_U, _HIGHEST_U)
        at, t, s = locate_in_layer(family, v0, u, flow)
        ln_V, ln_t, ln_s = layer_value_and_slopes(flow.table, LAYER_LN_V, at, t, s)
        creep, creep_t, creep_s = layer_value_and_slopes(flow.table, LAYER_CREEP, at, t, s)
        if change < _CONVERGED:
            break
        away = (creep - slow) / gap
        if not away > 0.0:
            u = 0.5 * (u + _LOWEST_U)
            continue
        # slopes in ln v0 and u: s and t are 4 m - 3 with the mantissa m of v0 and of u
        per_v, per_u, per = t + 3.0, (s + 3.0) / u, 1.0 / (creep - slow)
        first, second = ln_v0 + ln_V, np.log(away)
        a, b, c, d = 1.0 + ln_t * per_v, ln_s * per_u, creep_t * per_v * per, creep_s * per_u * per
        determinant = a * d - b * c
        shift, step = (first * d - b * second) / determinant, (a * second - c * first) / determinant
        v0 = _clamp(v * np.exp(ln_v0 - shift), lowest, 0.99 * highest)
        ln_v0, u = ln_v0 - shift, u - step
        change = abs(shift) + abs(second) * np.sqrt(abs(gap))
    split = read_asymptote(family, v0, SPEEDS, flow).split
    E = (u - _LOWEST_U) / (1.0 - _LOWEST_U) * split if u < 1.0 else u - 1.0 + split
    found = abs(v0 * np.exp(ln_V) - v) <= _RESIDUAL * v and abs(creep - delta) <= _RESIDUAL
    if found and E <= layout.LAYER_END:
        return family, v0, E, True
    return PLUS, v, np.inf, abs(gap) < _INDISTINGUISHABLE
