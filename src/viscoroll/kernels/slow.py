"""The slow manifold of partial slip by collocation in y = ln zeta.

Once the boundary layer is over, D - D0(y) hardly moves and y rises steadily, so that y can
serve as the independent variable: the offset solves the stiff scalar equation
d offset/dy = offset'/y', here by Radau IIA collocation on long intervals (dense Newton on N
values), and time, distance and angle are quadratures of functions of y.
"""

from __future__ import annotations

import numpy as np

from .collocation import INTEGRAL, NODES, SLOPES, TO_POWERS, TO_START, N
from .jit import kernel
from .partial_slip import partial_rates, signed_D

#: columns of the values at the nodes
_OFFSET, _RATE, _DRIFT, _V, _DELTA, _DECAY, _RATE_D, _DRIFT_D, _DELTA_D = range(9)
COLUMNS = 9
#: row behind the nodes: the left end as it was reached, before :func:`project`
REACHED = N + 1
_MOST_ITERATIONS = 6
#: the stick zone must stay longer than this share of the contact
_LEAST_STICK = 1e-3


@kernel
def _evaluate(i, y, values, par):
    """Fill node i at y from its offset."""
    rates = partial_rates(y, values[i, _OFFSET], par)
    values[i, _RATE], values[i, _DRIFT], values[i, _V], values[i, _DELTA] = rates[0], rates[1], rates[2], rates[3]
    values[i, _DECAY], values[i, _RATE_D], values[i, _DRIFT_D], values[i, _DELTA_D] = (
        rates[4], rates[5], rates[6], rates[7],
    )  # fmt: skip


@kernel
def _eliminate(matrix, right):
    """Solve in place, without pivoting: what that spoils, Newton's convergence shows."""
    for i in range(N):
        inverse = 1.0 / matrix[i, i]
        for row in range(i + 1, N):
            factor = matrix[row, i] * inverse
            for column in range(i + 1, N):
                matrix[row, column] -= factor * matrix[i, column]
            right[row] -= factor * right[i]
    for i in range(N - 1, -1, -1):
        total = right[i]
        for column in range(i + 1, N):
            total -= matrix[i, column] * right[column]
        right[i] = total / matrix[i, i]


@kernel
def slow_solve(y, length, tolerance, values, matrix, right, par):
    """Collocate on [y, y + length] from the left end in ``values[REACHED]``.  Whether it converged.

    ``tolerance`` bounds the remaining errors of y' (relative) and of the creep ratio.
    """
    half = 0.5 * length
    values[0] = values[REACHED]
    for i in range(1, N + 1):
        values[i, _OFFSET] = values[0, _OFFSET]
    before = 0.0
    for iteration in range(_MOST_ITERATIONS):
        for i in range(1, N + 1):
            _evaluate(i, y + half * (1.0 + NODES[i]), values, par)
        for i in range(N):
            slope = 0.0
            for n in range(N + 1):
                slope += SLOPES[i, n] * values[n, _OFFSET]
            slope /= half
            rate = values[i + 1, _RATE]
            for n in range(N):
                matrix[i, n] = rate * SLOPES[i, n + 1] / half
            matrix[i, i] += slope * values[i + 1, _RATE_D] - values[i + 1, _DRIFT_D]
            right[i] = values[i + 1, _DRIFT] - rate * slope
        _eliminate(matrix, right)
        change = 0.0
        for i in range(N):
            shift = right[i]
            row = i + 1
            factor = 1.0 + values[row, _RATE_D] * shift / values[row, _RATE]
            creep = values[row, _DELTA_D] * shift
            change = max(change, abs(factor - 1.0), abs(creep))
            values[row, _OFFSET] += shift
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
def slow_start(y, offset, values, par):
    """Fill the left end."""
    values[REACHED, _OFFSET] = offset
    _evaluate(REACHED, y, values, par)


@kernel
def sticks_throughout(y, length, values, par):
    """Whether y rises and the stick zone lasts at all nodes."""
    for i in range(1, N + 1):
        place = y + 0.5 * length * (1.0 + NODES[i])
        if not values[i, _RATE] > 0.0:
            return False
        if not abs(signed_D(place, values[i, _OFFSET], par)) * np.exp(-place) < 1.0 - _LEAST_STICK:
            return False
    return True


@kernel
def project(values):
    """Put node 0 on the slow manifold, where the other nodes extrapolate to; the offset it had from there.

    That is what is left of the boundary layer, or what the interval does not resolve.
    """
    rest = values[REACHED, _OFFSET]
    for i in range(1, N + 1):
        rest -= TO_START[i - 1] * values[i, _OFFSET]
    values[0, _OFFSET] -= rest
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


@kernel
def slow_dense_terms(y, length, values, powers):
    """Coefficients in t in [-1, 1]: tau and X, angle - X as integrals from -1, ln V + y and delta/V."""
    half = 0.5 * length
    powers[:] = 0.0
    for i in range(N + 1):
        f, v, w = _integrands(i, values)
        shape = np.log(values[i, _V]) + half * (1.0 + NODES[i])
        creep = values[i, _DELTA] / values[i, _V]
        for k in range(N + 1):
            weight = TO_POWERS[k, i]
            powers[0, k + 1] += weight * f
            powers[1, k + 1] += weight * v
            powers[2, k + 1] += weight * w
            powers[3, k] += weight * shape
            powers[4, k] += weight * creep
    for row in range(3):
        for k in range(N + 1):
            powers[row, k + 1] *= half / (k + 1.0)
        powers[row, 0] = -_polynomial(-1.0, powers, row)


@kernel
def _polynomial(t, powers, row):
    total = powers[row, N + 1]
    for k in range(N, -1, -1):
        total = powers[row, k] + t * total
    return total


@kernel
def slow_time(t, powers):
    """Time since the left end."""
    return _polynomial(t, powers, 0)


@kernel
def slow_place(tau, t, powers):
    """t in [-1, 1] where the time since the left end is tau, by Newton from t."""
    for _ in range(20):
        value = slope = 0.0
        for k in range(N + 1, -1, -1):
            slope = value + t * slope
            value = powers[0, k] + t * value
        change = (tau - value) / slope
        t = min(max(t + change, -1.0), 1.0)
        if abs(change) <= 1e-9:
            break
    return t


@kernel
def slow_state(t, length, powers):
    """(V, delta, X and angle since the left end) at t."""
    V = np.exp(_polynomial(t, powers, 3) - 0.5 * length * (1.0 + t))
    X = _polynomial(t, powers, 1)
    return V, V * _polynomial(t, powers, 4), X, X + _polynomial(t, powers, 2)
