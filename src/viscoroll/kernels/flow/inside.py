"""Flow map, starts inside the stick zone: each is a point of a motion that entered it earlier."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from . import layout
from .layout import LAYER_CREEP, LAYER_LN_V, MINUS, PLUS
from .read import HIGHEST, LOWEST, SPEEDS, entry_of, layer_place, layer_slopes, manifold_at

#: creep ratios nearer to the slow manifold than this are on it: an error of that size in omega
_ON_MANIFOLD = 1e-10
#: the same for creep that the table cannot tell from the manifold's
_NEARLY = 1e-9
#: where the search has not come so near, relative in V, the motion is left to the integrator
_RESIDUAL = 1e-10
#: of Newton's iteration; a step after which only the square of its size is left
_MOST_STEPS, _FOUND = 12, 1e-7
_LEAST_U, _LAST_U = 2.0**layout.LAYER_LOW, 2.0**layout.LAYER_HIGH * (1.0 - 2.0**-50)


@kernel
def _first_guess(size, slow, turns):
    """u where |delta| has fallen to ``size`` on its way to ``slow``, both over delta_star, by Carter's law.

    Both are negative on the other side of delta = 0.  With r = 1 - |delta|/delta_star the traction is 1 - r^2, so that
    dr/dE = (a^2 - r^2)/2 where a^2 = 1 less the traction on the slow manifold.
    """
    traction = np.copysign(1.0 - (1.0 - abs(slow)) ** 2, slow)
    a = np.sqrt(1.0 - traction)
    if size > 0.0:
        r = 1.0 - size
        E = np.log((a + r) / max(a - r, 1e-14)) / a
        split = np.log((a + 1.0) / max(a - 1.0, 1e-14)) / a if turns else 1.0
        return _LEAST_U + (1.0 - _LEAST_U) * E / split if E < split else 1.0 + E - split
    r, b = 1.0 + size, max(1.0 + slow, 1e-3)
    return 1.0 + np.log((1.0 - b) / (1.0 + b) * (r + b) / max(r - b, 1e-14)) / b


@kernel(inline=True)
def _within(x, low, high):
    """x, or the nearer end; of NaN the lower one."""
    x = x if x > low else low
    return x if x < high else high


@kernel
def earlier_entry(V, delta, edge, flow):
    """(family, kappa V at entry, E since then, served) of a state inside the stick zone, where delta_star = ``edge``.

    On the slow manifold E is infinite and the speed its own.  Newton's iteration in ln V at entry and u, on the
    logarithm of the distance from it, which falls nearly linearly in E.
    """
    v = flow.kappa * V
    lowest, highest = 2.0**flow.first, 2.0 ** (flow.first + layout.OCTAVES)
    if not LOWEST <= v < min(highest, HIGHEST):
        return PLUS, v, 0.0, False
    _, slow = manifold_at(v, flow.table)
    gap = delta - slow
    if abs(gap) < _ON_MANIFOLD:
        return PLUS, v, np.inf, True
    if not 2.0 * lowest <= v <= 0.5 * highest:
        return PLUS, v, 0.0, False
    family, sign = (PLUS, 1.0) if gap > 0.0 else (MINUS, -1.0)
    turns = entry_of(family, v, SPEEDS, flow).split != 1.0
    u = _first_guess(sign * delta / edge, sign * slow / edge, turns)
    v0, ln_v0, change = v, 0.0, np.inf
    for _ in range(_MOST_STEPS):
        u = _within(u, _LEAST_U, _LAST_U)
        at, t, s = layer_place(family, v0, u, flow)
        ln_V, ln_t, ln_s = layer_slopes(flow.table, LAYER_LN_V, at, t, s)
        creep, creep_t, creep_s = layer_slopes(flow.table, LAYER_CREEP, at, t, s)
        if change < _FOUND:
            break
        away = (creep - slow) / gap
        if not away > 0.0:
            u = 0.5 * (u + _LEAST_U)
            continue
        # slopes over ln v0 and u: s and t are 2 m - 3 with a mantissa m
        per_v, per_u, per = t + 3.0, (s + 3.0) / u, 1.0 / (creep - slow)
        first, second = ln_v0 + ln_V, np.log(away)
        a, b, c, d = 1.0 + ln_t * per_v, ln_s * per_u, creep_t * per_v * per, creep_s * per_u * per
        determinant = a * d - b * c
        shift, step = (first * d - b * second) / determinant, (a * second - c * first) / determinant
        v0 = _within(v * np.exp(ln_v0 - shift), lowest, 0.99 * highest)
        ln_v0, u = ln_v0 - shift, u - step
        change = abs(shift) + abs(second) * np.sqrt(abs(gap))
    split = entry_of(family, v0, SPEEDS, flow).split
    E = (u - _LEAST_U) / (1.0 - _LEAST_U) * split if u < 1.0 else u - 1.0 + split
    found = abs(v0 * np.exp(ln_V) - v) <= _RESIDUAL * v and abs(creep - delta) <= _RESIDUAL
    if found and E <= layout.LAYER_END:
        return family, v0, E, True
    return PLUS, v, np.inf, abs(gap) < _NEARLY
