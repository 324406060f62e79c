"""Partial slip in time: Radau IIA collocation of y = ln zeta and D, with distance and angle alongside.

It serves wherever the boundary layer and the slow manifold are not far enough apart for methods of their own, and
asks nothing of the motion but its rates.  On one side of delta = 0 the law goes on smoothly beyond it: a panel keeps
the sign of delta that it starts with, and is cut where that changes.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.linear import factorize, substitute
from .collocation import INTEGRALS, NODES, TO_START, N
from .control import SHARE, creep_weight
from .partial_slip import stiff_rates
from .path import D_D, D_TAU, D_TURN, D_X, D_Y, D, Y, grade, path_mismatch

_MOST_ITERATIONS = 12
#: length over the time of relaxation up to which substitution is tried, and gain of an iteration from which on new
#: slopes are taken
_MILD, _SLOW = 0.1, 0.1
#: Newton stops at this share of the tolerance
_NEWTON = 0.01
#: a mismatch of the rates at the left end overstates the error of their interpolants
_OVERSTATED = 0.05
#: step in y of the difference quotients
_STEP = 1e-7


@kernel
def _stage(i, weight, sign, scene, nodes):
    """Fill node i from its y and D; slopes of both rates in D, all times ``weight``."""
    dy, dD, V, delta, dy_D, dD_D = stiff_rates(nodes[Y, i], nodes[D, i], sign, scene)
    nodes[D_Y, i], nodes[D_D, i] = weight * dy, weight * dD
    nodes[D_TAU, i], nodes[D_X, i], nodes[D_TURN, i] = weight, weight * V, weight * V * delta
    return weight * dy_D, weight * dD_D


@kernel
def _put_slopes(n, half, weight, in_D, sign, scene, work):
    """Columns of Newton's matrix for node n, whose rates have the slopes ``in_D``; those in y are differences."""
    nodes, matrix = work.nodes, work.matrix
    i, column = n + 1, 2 * n
    dy, dD, _, _, _, _ = stiff_rates(nodes[Y, i] + _STEP, nodes[D, i], sign, scene)
    in_y = (weight * dy - nodes[D_Y, i]) / _STEP, (weight * dD - nodes[D_D, i]) / _STEP
    for m in range(N):
        share = half * INTEGRALS[m, n]
        matrix[2 * m, column], matrix[2 * m, column + 1] = -share * in_y[0], -share * in_D[0]
        matrix[2 * m + 1, column], matrix[2 * m + 1, column + 1] = -share * in_y[1], -share * in_D[1]
    matrix[column, column] += 1.0
    matrix[column + 1, column + 1] += 1.0


@kernel
def _put_residuals(half, nodes, right):
    """What the unknowns at the nodes lack."""
    for i in range(N):
        y_rise = D_rise = 0.0
        for n in range(N):
            y_rise += INTEGRALS[i, n] * nodes[D_Y, n + 1]
            D_rise += INTEGRALS[i, n] * nodes[D_D, n + 1]
        right[2 * i] = nodes[Y, 0] + half * y_rise - nodes[Y, i + 1]
        right[2 * i + 1] = nodes[D, 0] + half * D_rise - nodes[D, i + 1]


@kernel
def radau_start(y, D_here, sign, power, scene, nodes):
    """Fill node 0; (y', D', slope of D' in D)."""
    nodes[Y, 0], nodes[D, 0] = y, D_here
    _, slope = _stage(0, 1.0, sign, scene, nodes)
    rates = nodes[D_Y, 0], nodes[D_D, 0], slope
    if power > 1:
        for row in (D_Y, D_D, D_TAU, D_X, D_TURN):
            nodes[row, 0] = 0.0
    return rates


@kernel
def _guess(length, power, rates, nodes):
    """y and D at the nodes: y at its pace, D on its way to where it comes to stand."""
    dy, dD, relaxation = rates
    for i in range(1, N + 1):
        since = length * (0.5 * (1.0 + NODES[i])) ** power
        nodes[Y, i] = nodes[Y, 0] + dy * since
        fall = relaxation * since
        nodes[D, i] = nodes[D, 0] + dD * (np.expm1(fall) / relaxation if abs(fall) > 1e-8 else since)


@kernel
def radau_solve(length, power, sign, rates, rtol, scene, work):
    """Collocate over ``length`` from node 0, with its ``rates`` (y', D', slope of D' in D).  Whether it converged.

    By Newton's iteration on both unknowns of all stages, with new slopes where it gains little; where nothing is stiff,
    by substitution as long as that gains.
    """
    nodes, right = work.nodes, work.right
    _guess(length, power, rates, nodes)
    half, before, by_Newton = 0.5 * length, np.inf, False
    anew = length * abs(rates[2]) > _MILD
    for _ in range(_MOST_ITERATIONS):
        for n in range(N):
            weight = grade(0.5 * (1.0 + NODES[n + 1]), power)
            in_D = _stage(n + 1, weight, sign, scene, nodes)
            if anew:
                _put_slopes(n, half, weight, in_D, sign, scene, work)
        if anew:
            factorize(work.matrix, 2 * N)
        by_Newton = by_Newton or anew
        _put_residuals(half, nodes, right)
        if by_Newton:
            substitute(work.matrix, right, 2 * N)
        change = 0.0 * (right[0] + right[1])  # a NaN is in all of them, and lost in any other argument of max
        for i in range(N):
            change = max(change, abs(right[2 * i]), abs(right[2 * i + 1]) * np.exp(-nodes[Y, 0]))
            nodes[Y, i + 1] += right[2 * i]
            nodes[D, i + 1] += right[2 * i + 1]
        first = before == np.inf
        gain = 1.0 if first else change / before
        if not (change < 1e3 and gain < 2.0):
            return False
        # distance and angle are integrated from what the unknowns were before this change
        if change <= SHARE * rtol and change * gain <= _NEWTON * SHARE * rtol:
            return True
        anew = gain > _SLOW and not first
        before = change
    return False


@kernel
def radau_error(length, relaxation, rtol, state, nodes):
    """Error of the interpolants over their tolerances; of D only what its relaxation leaves of it counts."""
    D_off = nodes[D_D, 0]
    for i in range(N):
        D_off -= TO_START[i] * nodes[D_D, i + 1]
    D_off *= length / (1.0 + length * abs(relaxation))
    per = np.exp(-nodes[Y, N])
    error = abs(D_off) * per * creep_weight(nodes[D, N] * per)
    return _OVERSTATED * max(error, path_mismatch(length, 0.0, state, nodes)) / (SHARE * rtol)
