"""The boundary layer behind the onset of stick, beside the slow manifold.

In partial slip D decays to the slow manifold D = S(y), y = ln zeta (:mod:`slow`).  The distance
e = D - S falls all the while, so that theta = -ln |e| can serve as the independent variable:

    dy/dtheta = y'/m    dtau/dtheta = 1/m    dX/dtheta = V/m    d(angle - X)/dtheta = V delta/m
    m = -e'/e           e' = D' - S'(y) y'

The stiffness is gone: m is nearly constant over the last e-folds, and y, the only one of these
that the right-hand sides know, hardly moves.  On a panel in theta they are integrated by
collocation at the Radau nodes, solved by substitution.  Where eta starts from 0 the law has terms
of eta ln eta: the nodes of the first panel are graded toward its left end, as powers of the place.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import fill
from .collocation import INNER_POWERS, INTEGRALS, NODES, SMOOTH_SLOPES, N
from .partial_slip import branch_rates, stiff_rates
from .path import D_TAU, D_TURN, D_X, D_Y, Y, grade
from .slow import DRIFT_D, NODE_D, RATE, REACHED, slow_solve, slow_start, sticks_throughout, stiffness

_MOST_ITERATIONS = 8
#: substitution stops at this share of the tolerance of a panel: what it leaves spoils the next estimate; and at the
#: least that it can leave
_SUBSTITUTION, _ACHIEVED = 1e-3, 1e-14
#: the interval in y that the manifold is solved for: so many e-folds at the pace of y on the manifold, and of
#: that at the start; longest, and shortest
_LATE, _EARLY, _LONGEST, _SHORTEST = 100.0, 4.0, 0.5, 0.15
#: relaxation over the rise of y below which there is no manifold to speak of
_STIFF = 20.0
#: y is never as large
_EVERYWHERE = 1e3
#: e over zeta up to which it is small
_LINEAR = 3e-7
#: rounding of m is this over e/zeta: what it moves y by no substitution brings to rest, which no longer gains then
_NOISE, _STALLED = 1e-16, 0.3


@kernel
def manifold(y, D, tolerance, scene, work):
    """S around y as powers of t in [-1, 1], in ``slow``, with the ends of its interval behind.  Whether there is one.

    Collocation at nodes 1 ... N alone: no left end, so that nothing of the fast motion enters.
    """
    values, slow = work.values, work.slow
    slow_start(y, 0.0, values, scene)
    if scene.material.T_mean == 0.0:  # without rolling resistance S = 0
        fill(0.0, slow)
        slow[N], slow[N + 1] = -_EVERYWHERE, _EVERYWHERE
        return True
    rise = 1.0 / stiffness(REACHED, values)
    dy, dD, _, _, _, _ = stiff_rates(y, D, np.sign(D), scene)
    early = _EARLY * dy / dD * (values[REACHED, NODE_D] - D)
    left = y - min(max(-early, 0.0), 0.5 * _LONGEST)
    reach = max(min(y - left + _LATE * rise + abs(early), _LONGEST), _SHORTEST)
    if not 0.0 < rise < 1.0 / _STIFF:
        return False
    if not slow_solve(left, reach, tolerance, SMOOTH_SLOPES, scene, work):
        return False
    for i in range(1, N + 1):
        if not stiffness(i, values) > _STIFF:
            return False
    if not sticks_throughout(left, reach, values):
        return False
    for k in range(N):
        slow[k] = 0.0
        for i in range(N):
            slow[k] += INNER_POWERS[k, i] * values[i + 1, NODE_D]
    slow[N], slow[N + 1] = left, left + reach
    return True


@kernel
def slow_creep(y, slow):
    """(S, dS/dy) at y."""
    per_half = 2.0 / (slow[N + 1] - slow[N])
    t = (y - slow[N]) * per_half - 1.0
    S = slope = 0.0
    for k in range(N - 1, -1, -1):
        slope = S + t * slope
        S = slow[k] + t * S
    return S, slope * per_half


@kernel
def within(y, slow):
    """Whether the manifold is known at y."""
    return slow[N] <= y <= slow[N + 1]


@kernel
def layer_node(i, e, weight, nodes, slow, scene):
    """Fill node i from its y; ``weight``: slope of theta there."""
    y = nodes[Y, i]
    S, slope = slow_creep(y, slow)
    # close to the manifold m is a difference of rates that rounding spoils, and all is linear in e
    aside = np.copysign(max(abs(e), _LINEAR * np.exp(y)), e)
    dy, dD, V, delta, _, dy_D, _, delta_D, _ = branch_rates(y, S + aside, np.sign(S + e), scene)
    per = -weight * aside / (dD - slope * dy)
    dy, delta = dy - dy_D * (aside - e), delta - delta_D * (aside - e)
    nodes[D_Y, i], nodes[D_TAU, i], nodes[D_X, i], nodes[D_TURN, i] = per * dy, per, per * V, per * V * delta


@kernel
def _first_y(length, power, work):
    """y at the nodes: its slope over theta falls like e to that on the manifold."""
    nodes, late = work.nodes, -work.values[REACHED, RATE] / work.values[REACHED, DRIFT_D]
    early = nodes[D_Y, 0] if power == 1 else late
    for i in range(1, N + 1):
        since = length * (0.5 * (1.0 + NODES[i])) ** power
        nodes[Y, i] = nodes[Y, 0] + late * since + (early - late) * (1.0 - np.exp(-since))


@kernel
def layer_solve(e, length, power, to_zero, tolerance, scene, work):
    """Collocate over ``length`` e-folds from node 0, where e is given; returns the length, NaN where it failed.

    With ``to_zero`` the panel ends where D = 0.  ``tolerance`` is that of what is integrated: its integrands stay as
    they were before the last change of y.
    """
    nodes, slow, left = work.nodes, work.slow, max(_SUBSTITUTION * tolerance, _ACHIEVED)
    start = nodes[Y, 0]
    _first_y(length, power, work)
    before = first = 0.0
    noise = _NOISE / max(abs(e) * np.exp(-start - length), _LINEAR)
    for iteration in range(_MOST_ITERATIONS):
        half = 0.5 * length
        for i in range(1, N + 1):
            v = 0.5 * (1.0 + NODES[i])
            layer_node(i, e * np.exp(-length * v**power), grade(v, power), nodes, slow, scene)
        change = 0.0
        for i in range(N):
            rise = 0.0
            for n in range(N):
                rise += INTEGRALS[i, n] * nodes[D_Y, n + 1]
            y = start + half * rise
            change = max(change, abs(y - nodes[Y, i + 1]))
            nodes[Y, i + 1] = y
        if not (change < 1.0 and within(nodes[Y, N], slow)):
            return np.nan
        if to_zero:
            length = np.log(-e / slow_creep(nodes[Y, N], slow)[0])
        first = change if iteration == 0 else first
        gain = change / before if iteration > 0 else 0.1
        if (change <= tolerance and change * gain <= left) or (gain > _STALLED and change <= noise * first):
            return length
        before = change
    return np.nan


@kernel
def decays_throughout(nodes):
    """Whether e falls at all nodes."""
    slowest = np.inf
    for i in range(1, N + 1):
        slowest = min(slowest, nodes[D_TAU, i])
    return slowest > 0.0
