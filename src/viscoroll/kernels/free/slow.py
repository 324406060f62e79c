"""The slow manifold of partial slip by collocation in y = ln zeta.

Once the boundary layer is over, D - D0(y) hardly moves and y rises steadily, so that y can
serve as the independent variable: the offset solves the stiff scalar equation
d offset/dy = offset'/y', here by Radau IIA collocation on long intervals (dense Newton on N
values), and time, distance and angle are quadratures of functions of y.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy
from ..numerics.linear import factorize, substitute
from .collocation import NODES, TO_START, N, fit_terms, polynomial
from .partial_slip import partial_rates
from .path import D_TAU, D_TURN, D_X, D_Y, RISE_D, RISE_Y, ROWS, Y, time_terms
from .records import Workspace

#: columns of the values at the nodes: y', offset', V, delta; the slopes of y', offset' and delta in the offset; D
_OFFSET, RATE, _DRIFT, _V, _DELTA, RATE_D, DRIFT_D, DELTA_D, NODE_D = range(9)
COLUMNS = 9
#: row behind the nodes: the left end as it was reached, before :func:`project`
REACHED = N + 1
_MOST_ITERATIONS = 6
#: rows of the interpolants in place of y and D
LN_V, CREEP = RISE_Y, RISE_D
#: the stick zone must stay longer than this share of the contact
_LEAST_STICK = 1e-3


@kernel(allocates=True)
def workspace():
    """Arrays for panels in partial slip."""
    return Workspace(
        np.empty((ROWS, N + 1)), np.empty((5, N + 2)), np.empty((N + 2, COLUMNS)), np.empty(N + 2),
        np.empty((2 * N, 2 * N)), np.empty(2 * N),
    )  # fmt: skip


@kernel
def _evaluate(i, y, values, scene):
    """Fill node i at y from its offset."""
    (
        values[i, RATE], values[i, _DRIFT], values[i, _V], values[i, _DELTA],
        values[i, RATE_D], values[i, DRIFT_D], values[i, DELTA_D], values[i, NODE_D],
    ) = partial_rates(y, values[i, _OFFSET], scene)  # fmt: skip


@kernel
def slow_solve(y, length, tolerance, slopes, scene, work):
    """Collocate on [y, y + length] from the left end in ``values[REACHED]``.  Whether it converged.

    ``tolerance`` bounds the remaining errors of y' (relative) and of the creep ratio.  ``slopes``
    turns values at nodes into slopes; without a column for node 0, that is the first guess only.
    """
    values, matrix, right = work.values, work.matrix, work.right
    half = 0.5 * length
    copy(values[REACHED], values[0])
    for i in range(1, N + 1):
        values[i, _OFFSET] = values[0, _OFFSET]
    before = 0.0
    for iteration in range(_MOST_ITERATIONS):
        for i in range(1, N + 1):
            _evaluate(i, y + half * (1.0 + NODES[i]), values, scene)
        for i in range(N):
            slope = 0.0
            for n in range(N + 1):
                slope += slopes[i, n] * values[n, _OFFSET]
            slope /= half
            rate = values[i + 1, RATE]
            for n in range(N):
                matrix[i, n] = rate * slopes[i, n + 1] / half
            matrix[i, i] += slope * values[i + 1, RATE_D] - values[i + 1, DRIFT_D]
            right[i] = values[i + 1, _DRIFT] - rate * slope
        factorize(matrix, N)
        substitute(matrix, right, N)
        change = 0.0 * right[0]  # a NaN is in all of them, and lost in any other argument of max
        for i in range(N):
            shift = right[i]
            row = i + 1
            factor = 1.0 + values[row, RATE_D] * shift / values[row, RATE]
            creep = values[row, DELTA_D] * shift
            change = max(change, abs(factor - 1.0), abs(creep))
            values[row, _OFFSET] += shift
            values[row, NODE_D] += shift
            values[row, RATE] *= factor
            values[row, _DELTA] += creep
        gain = change / before if iteration > 0 else 0.1
        if not (gain < 0.5 and change < np.inf):
            return False
        if change * gain <= tolerance:
            return True
        before = change
    return False


@kernel
def slow_start(y, offset, values, scene):
    """Fill the left end."""
    values[REACHED, _OFFSET] = offset
    _evaluate(REACHED, y, values, scene)


@kernel
def slow_go_on(values):
    """Put the left end where the right one was."""
    copy(values[N], values[REACHED])


@kernel
def sticks_throughout(y, length, values):
    """Whether y rises and the stick zone lasts at all nodes."""
    for i in range(1, N + 1):
        zeta = np.exp(y + 0.5 * length * (1.0 + NODES[i]))
        if not (values[i, RATE] > 0.0 and abs(values[i, NODE_D]) < (1.0 - _LEAST_STICK) * zeta):
            return False
    return True


@kernel
def stiffness(i, values):
    """Relaxation of the offset over a rise of y by 1 at node i."""
    return -values[i, DRIFT_D] / values[i, RATE]


@kernel
def project(values):
    """Put node 0 on the slow manifold, where the other nodes extrapolate to; the offset it had from there.

    That is what is left of the boundary layer, or what the interval does not resolve.
    """
    rest = values[REACHED, _OFFSET]
    for i in range(1, N + 1):
        rest -= TO_START[i - 1] * values[i, _OFFSET]
    values[0, _OFFSET] -= rest
    values[0, NODE_D] -= rest
    values[0, RATE] -= values[0, RATE_D] * rest
    values[0, _DELTA] -= values[0, DELTA_D] * rest
    return rest


@kernel
def slow_path(values, nodes):
    """Put what is integrated over y into the rows of :mod:`path`."""
    for i in range(N + 1):
        per_rate = 1.0 / values[i, RATE]
        travel = values[i, _V] * per_rate
        nodes[D_Y, i], nodes[D_TAU, i], nodes[D_X, i], nodes[D_TURN, i] = (
            1.0,
            per_rate,
            travel,
            travel * values[i, _DELTA],
        )


@kernel
def slow_terms(half, values, nodes, powers):
    """Interpolants of tau, X, angle - X, ln V, delta/V."""
    time_terms(half, nodes, powers)
    for i in range(N + 1):
        # y is the independent variable here, and its row free
        nodes[Y, i] = np.log(values[i, _V])
        nodes[D_Y, i] = values[i, _DELTA] / values[i, _V]
    fit_terms(nodes[Y], powers[LN_V])
    fit_terms(nodes[D_Y], powers[CREEP])


@kernel
def slow_speeds(v, powers):
    """(V, delta) at v = 1 + t."""
    V = np.exp(polynomial(v - 1.0, powers, LN_V))
    return V, V * polynomial(v - 1.0, powers, CREEP)
