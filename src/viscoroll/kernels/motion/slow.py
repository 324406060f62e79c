"""The slow manifold of partial slip by collocation in y = ln zeta.

Once the boundary layer is over, D - D0(y) hardly moves and y rises steadily, so that y can
serve as the independent variable: the offset solves the stiff scalar equation
d offset/dy = offset'/y', here by Radau IIA collocation on long intervals (dense Newton on N
values), and time, distance and angle are quadratures of functions of y.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy, fill
from ..numerics.linear import eliminate
from .collocation import INTEGRAL, NODES, TO_POWERS, TO_START, N, integral_terms, polynomial, rise_at
from .partial_slip import partial_rates

#: columns of the values at the nodes
_OFFSET, _RATE, _DRIFT, _V, _DELTA, _DECAY, _RATE_D, _DRIFT_D, _DELTA_D, _D = range(10)
COLUMNS = 10
#: row behind the nodes: the left end as it was reached, before :func:`project`
REACHED = N + 1
_MOST_ITERATIONS = 6
#: the stick zone must stay longer than this share of the contact
_LEAST_STICK = 1e-3


@kernel
def _evaluate(i, y, values, scene):
    """Fill node i at y from its offset."""
    (
        values[i, _RATE], values[i, _DRIFT], values[i, _V], values[i, _DELTA], values[i, _DECAY],
        values[i, _RATE_D], values[i, _DRIFT_D], values[i, _DELTA_D], values[i, _D],
    ) = partial_rates(y, values[i, _OFFSET], scene)  # fmt: skip


@kernel
def slow_solve(y, length, tolerance, slopes, values, matrix, right, scene):
    """Collocate on [y, y + length] from the left end in ``values[REACHED]``.  Whether it converged.

    ``tolerance`` bounds the remaining errors of y' (relative) and of the creep ratio.  ``slopes``
    turns values at nodes into slopes; without a column for node 0, that is the first guess only.
    """
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
            rate = values[i + 1, _RATE]
            for n in range(N):
                matrix[i, n] = rate * slopes[i, n + 1] / half
            matrix[i, i] += slope * values[i + 1, _RATE_D] - values[i + 1, _DRIFT_D]
            right[i] = values[i + 1, _DRIFT] - rate * slope
        eliminate(matrix, right)
        change = 0.0
        for i in range(N):
            shift = right[i]
            row = i + 1
            factor = 1.0 + values[row, _RATE_D] * shift / values[row, _RATE]
            creep = values[row, _DELTA_D] * shift
            change = max(change, abs(factor - 1.0), abs(creep))
            values[row, _OFFSET] += shift
            values[row, _D] += shift
            values[row, _RATE] *= factor
            values[row, _DECAY] *= factor
            values[row, _DELTA] += creep
        gain = change / before if iteration > 0 else 0.1
        if not gain < 0.5:
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
def sticks_throughout(y, length, values):
    """Whether y rises and the stick zone lasts at all nodes."""
    for i in range(1, N + 1):
        zeta = np.exp(y + 0.5 * length * (1.0 + NODES[i]))
        if not (values[i, _RATE] > 0.0 and abs(values[i, _D]) < (1.0 - _LEAST_STICK) * zeta):
            return False
    return True


@kernel
def stiffness(i, values):
    """Relaxation of the offset over a rise of y by 1 at node i."""
    return -values[i, _DRIFT_D] / values[i, _RATE]


@kernel
def creep_slope(i, values):
    """d delta/dD at node i."""
    return values[i, _DELTA_D]


@kernel
def node_D(i, values):
    """D at node i."""
    return values[i, _D]


@kernel
def project(values):
    """Put node 0 on the slow manifold, where the other nodes extrapolate to; the offset it had from there.

    That is what is left of the boundary layer, or what the interval does not resolve.
    """
    rest = values[REACHED, _OFFSET]
    for i in range(1, N + 1):
        rest -= TO_START[i - 1] * values[i, _OFFSET]
    values[0, _OFFSET] -= rest
    values[0, _D] -= rest
    values[0, _RATE] -= values[0, _RATE_D] * rest
    values[0, _DELTA] -= values[0, _DELTA_D] * rest
    return rest


@kernel
def _integrands(i, values):
    """(d tau/dy, dX/dy, d(angle - X)/dy) at node i."""
    per_rate = 1.0 / values[i, _RATE]
    travel = values[i, _V] * per_rate
    return per_rate, travel, travel * values[i, _DELTA]


@kernel
def slow_quadratures(length, values):
    """(rise of tau, of X, of the angle; mismatches of the three integrands at the left end)."""
    tau = X = turn = 0.0
    tau_off, X_off, turn_off = _integrands(0, values)
    for i in range(1, N + 1):
        f, v, w = _integrands(i, values)
        tau += INTEGRAL[i - 1] * f
        X += INTEGRAL[i - 1] * v
        turn += INTEGRAL[i - 1] * w
        tau_off -= TO_START[i - 1] * f
        X_off -= TO_START[i - 1] * v
        turn_off -= TO_START[i - 1] * w
    half = 0.5 * length
    return half * tau, half * X, half * (X + turn), length * abs(tau_off), length * abs(X_off), length * abs(turn_off)


@kernel(allocates=True)
def slow_dense_terms(length, values, powers):
    """Coefficients in t in [-1, 1]: tau, X and angle - X for ``rise_at``, ln V + y and delta/V."""
    half = 0.5 * length
    integrands = np.empty((3, N + 1))
    fill(0.0, powers[3])
    fill(0.0, powers[4])
    for i in range(N + 1):
        integrands[0, i], integrands[1, i], integrands[2, i] = _integrands(i, values)
        shape = np.log(values[i, _V]) + half * (1.0 + NODES[i])
        creep = values[i, _DELTA] / values[i, _V]
        for k in range(N + 1):
            powers[3, k] += TO_POWERS[k, i] * shape
            powers[4, k] += TO_POWERS[k, i] * creep
    for row in range(3):
        integral_terms(integrands[row], half, powers, row)


@kernel
def slow_state(v, length, powers):
    """(V, delta, X and angle since the left end) at v = 1 + t."""
    V = np.exp(polynomial(v - 1.0, powers, 3) - 0.5 * length * v)
    X = rise_at(v, powers, 1)
    return V, V * polynomial(v - 1.0, powers, 4), X, X + rise_at(v, powers, 2)
