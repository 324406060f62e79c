"""Flow map, starts inside the stick zone: each is a point of a motion that entered it earlier."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.bracket import narrowed, secant
from . import layout
from .read import CROSS, LAYER_SKIP, LOWEST, MINUS, PLUS, SPEEDS, layer_state, slow_creep

#: creep ratios nearer to the slow manifold than this are on it: an error of that size in omega
_ON_MANIFOLD = 1e-10
#: the same for creep that the table cannot tell from the manifold's
_NEARLY = 1e-9
#: where the search has not come so near, relative in V, the motion is left to the integrator: with little between the
#: two rates V changes much within the boundary layer
_RESIDUAL = 1e-10
_SOLVER_CAP = 60


@kernel
def earlier_entry(V, delta, first, table, scene):
    """(family, kappa V at entry, E since then, served) of a state inside the stick zone.

    On the slow manifold E is infinite and the speed its own.  Illinois on the logarithm of
    the distance to it, which falls nearly linearly in E, with the speed at entry corrected
    alongside.
    """
    v = scene.kappa * V
    if not LOWEST <= v < 2.0 ** (first + layout.ENTRY_OCTAVES):
        return PLUS, v, 0.0, False
    slow = slow_creep(v, table)
    if abs(delta - slow) < _ON_MANIFOLD:
        return PLUS, v, np.inf, True
    lowest, highest = 2.0 ** (first + LAYER_SKIP), 2.0 ** (first + layout.ENTRY_OCTAVES)
    if not 2.0 * lowest <= v <= 0.5 * highest:
        return PLUS, v, 0.0, False
    if delta * slow > 0.0 and abs(delta) < abs(slow):
        family = CROSS
    else:
        family = PLUS if delta > slow else MINUS
    size = np.log(abs(delta - slow))
    low, high, v0, side = 0.0, layout.LAYER_END, v, 0
    E, at_low, at_high = low, 0.0, 0.0
    for n in range(_SOLVER_CAP):
        reached = slow
        for _ in range(3):
            a, reached, _, _, _ = layer_state(family, v0, E, first, SPEEDS, table)
            v0 = max(lowest, min(v * np.exp(-a), 0.99 * highest))
        gap = reached - slow
        excess = np.log(abs(gap)) - size if gap * (delta - slow) > 0.0 else -1.0
        if n == 0:
            if excess <= 0.0:
                return family, v0, 0.0, True
            at_low, E = excess, high
            continue
        if n == 1:
            if excess > 0.0:  # nearer to the manifold than any motion of the table
                return PLUS, v, np.inf, abs(delta - slow) < _NEARLY
            at_high = excess
        else:
            low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, E, excess)
        if abs(excess) < 1e-12 or high - low < 1e-13 * high:
            break
        E = secant(low, high, at_low, at_high)
    a, reached, _, _, _ = layer_state(family, v0, E, first, SPEEDS, table)
    found = abs(v0 * np.exp(a) - v) <= _RESIDUAL * v and abs(reached - delta) <= _RESIDUAL
    return family, v0, E, found
