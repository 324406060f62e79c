"""Flow map, starts inside the stick zone: each is a point of a motion that entered it earlier."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.bracket import narrowed, secant
from . import layout
from .read import CROSS, LAYER_SKIP, LOWEST, MINUS, PLUS, layer_place, layer_value, manifold_delta

#: creep ratios nearer to the slow manifold than this are on it: an error of that size in omega
_ON_MANIFOLD = 1e-10
#: the same for creep that the table cannot tell from the manifold's
_NEARLY = 1e-9
#: where the search has not come so near, relative in V, the motion is left to the integrator: with little between the
#: two rates V changes much within the boundary layer
_RESIDUAL = 1e-10
_SOLVER_CAP = 60


@kernel
def _layer_speeds(family, v, E, flow):
    """(ln V/V0, delta) behind the entry of a family at v = kappa V0."""
    at, t, s = layer_place(family, v, E, flow)
    return (
        layer_value(flow.table, layout.LAYER_LN_V, at, t, s),
        layer_value(flow.table, layout.LAYER_CREEP, at, t, s),
    )


@kernel
def earlier_entry(V, delta, flow):
    """(family, kappa V at entry, E since then, served) of a state inside the stick zone.

    On the slow manifold E is infinite and the speed its own.  Illinois on the logarithm of
    the distance to it, which falls nearly linearly in E, with the speed at entry corrected
    alongside.
    """
    v = flow.scene.kappa * V
    lowest, highest = 2.0 ** (flow.first + LAYER_SKIP), 2.0 ** (flow.first + layout.ENTRY_OCTAVES)
    if not LOWEST <= v < highest:
        return PLUS, v, 0.0, False
    slow = manifold_delta(v, flow.table)
    if abs(delta - slow) < _ON_MANIFOLD:
        return PLUS, v, np.inf, True
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
            a, reached = _layer_speeds(family, v0, E, flow)
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
    a, reached = _layer_speeds(family, v0, E, flow)
    found = abs(v0 * np.exp(a) - v) <= _RESIDUAL * v and abs(reached - delta) <= _RESIDUAL
    return family, v0, E, found
