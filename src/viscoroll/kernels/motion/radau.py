"""Partial slip in time: Radau IIA collocation of y = ln zeta and D, with distance and angle alongside.

It serves wherever the boundary layer and the slow manifold are not far enough apart for methods of their own, and
asks nothing of the motion but its rates.  On one side of delta = 0 the law goes on smoothly beyond it: a panel keeps
the sign of delta that it starts with, and is cut where that changes.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import INTEGRALS, NODES, TO_START, N, eliminate
from .control import SHARE, creep_weight
from .partial_slip import stiff_rates
from .path import D_D, D_TAU, D_TURN, D_X, D_Y, OVERSTATED, D, Y, path_mismatch

_MOST_ITERATIONS = 8
#: Newton stops at this share of the tolerance
_NEWTON = 0.05
#: step in y of the difference quotients
_STEP = 1e-7


@kernel
def _stage(i, weight, sign, scene, nodes):
    """Fill node i from its y and D; (slopes of both rates in D, in y), times ``weight``."""
    y, D_here = nodes[Y, i], nodes[D, i]
    dy, dD, V, delta, dy_D, dD_D = stiff_rates(y, D_here, sign, scene)
    dy_after, dD_after, _, _, _, _ = stiff_rates(y + _STEP, D_here, sign, scene)
    nodes[D_Y, i], nodes[D_D, i] = weight * dy, weight * dD
    nodes[D_TAU, i], nodes[D_X, i], nodes[D_TURN, i] = weight, weight * V, weight * V * delta
    per = weight / _STEP
    return weight * dy_D, weight * dD_D, per * (dy_after - dy), per * (dD_after - dD)


@kernel
def radau_start(y, D_here, sign, power, scene, nodes):
    """Fill node 0 for a first panel; (y', D', slope of D' in D)."""
    nodes[Y, 0], nodes[D, 0] = y, D_here
    _, relaxation, _, _ = _stage(0, 1.0, sign, scene, nodes)
    dy, dD = nodes[D_Y, 0], nodes[D_D, 0]
    if power > 1.0:
        for row in (D_Y, D_D, D_TAU, D_X, D_TURN):
            nodes[row, 0] = 0.0
    return dy, dD, relaxation


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

    By Newton's iteration on both unknowns of all stages.
    """
    nodes, matrix, right = work.nodes, work.matrix, work.right
    _guess(length, power, rates, nodes)
    half, before = 0.5 * length, 0.0
    for iteration in range(_MOST_ITERATIONS):
        for n in range(N):
            weight = power * (0.5 * (1.0 + NODES[n + 1])) ** (power - 1.0)
            y_D, D_D_slope, y_y, D_y = _stage(n + 1, weight, sign, scene, nodes)
            for i in range(N):
                share = half * INTEGRALS[i, n]
                matrix[2 * i, 2 * n], matrix[2 * i, 2 * n + 1] = -share * y_y, -share * y_D
                matrix[2 * i + 1, 2 * n], matrix[2 * i + 1, 2 * n + 1] = -share * D_y, -share * D_D_slope
            matrix[2 * n, 2 * n] += 1.0
            matrix[2 * n + 1, 2 * n + 1] += 1.0
        for i in range(N):
            y_rise = D_rise = 0.0
            for n in range(N):
                y_rise += INTEGRALS[i, n] * nodes[D_Y, n + 1]
                D_rise += INTEGRALS[i, n] * nodes[D_D, n + 1]
            right[2 * i] = nodes[Y, 0] + half * y_rise - nodes[Y, i + 1]
            right[2 * i + 1] = nodes[D, 0] + half * D_rise - nodes[D, i + 1]
        eliminate(matrix, right, 2 * N)
        change = 0.0
        for i in range(N):
            change = max(change, abs(right[2 * i]), abs(right[2 * i + 1]) * np.exp(-nodes[Y, 0]))
            nodes[Y, i + 1] += right[2 * i]
            nodes[D, i + 1] += right[2 * i + 1]
        gain = change / before if iteration > 0 else 0.1
        if not (change < 1e3 and gain < 2.0):
            return False
        if change * gain <= _NEWTON * SHARE * rtol:
            return True
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
    return OVERSTATED * max(error, path_mismatch(length, 0.0, state, nodes)) / (SHARE * rtol)
