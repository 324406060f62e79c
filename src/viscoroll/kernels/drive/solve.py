"""A panel of time by Radau IIA collocation of both unknowns, with what is integrated along the way.

Collocation is written with the slopes of the interpolants, so that the equation of b may be multiplied by V, which
vanishes where a panel ends at V = 0.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import SLOPES, TO_START, N, rise_terms
from ..motion.control import SHARE, creep_weight
from ..numerics.linear import factorize, substitute
from .guess import guess
from .load import rounding
from .nodes import (
    OF_S,
    OF_SECOND,
    PER_V,
    RATE,
    S_RATE,
    SECOND,
    SLOPE,
    SPEED,
    S,
    load_there,
    put_drive,
    put_node,
    put_path,
    slope_at,
    time_at,
)
from .rates import rates_at

_MOST_ITERATIONS = 12
#: iterations that are still to come from which on new slopes are taken
_PATIENCE = 4
#: Newton's iteration stops at this share of the tolerance; the least that it can leave
_NEWTON, _LEAST = 0.01, 1e-14
#: step of the difference quotients in s, relative
_STEP = 1e-7
#: a mismatch of the rates at the left end overstates the error of their interpolants
_OVERSTATED = 0.02
#: the last term's share of the error: the next one over this one, and the coefficient of a power over that
_LAST = 0.1 / (_OVERSTATED * 2.0 ** (N - 1))


@kernel
def _put_matrix(i, half, weight, slopes, frame, case):
    """Rows of Newton's matrix for node i; the slopes in s are differences."""
    nodes, matrix = case.work.nodes, case.work.matrix
    s, step = nodes[S, i], _STEP * max(abs(nodes[S, i]), 0.01 * abs(nodes[S, 0]), abs(nodes[S_RATE, i]) * half)
    step = step if step > 0.0 else _STEP  # V is prescribed to stay 0
    at = rates_at(s + step, nodes[SECOND, i], load_there(i, frame, case), frame, case.scene)
    s_s = (weight * at.s_rate - nodes[S_RATE, i]) / step
    rate_s = (weight * at.rate - nodes[RATE, i]) / step
    weight_s = (at.weight - slopes.weight) / step
    n = i - 1
    for k in range(N):
        matrix[n, k], matrix[n, N + k] = SLOPES[n, k + 1], 0.0
        matrix[N + n, k], matrix[N + n, N + k] = 0.0, slopes.weight * SLOPES[n, k + 1]
    matrix[n, n] -= half * s_s
    matrix[n, N + n] -= half * slopes.s
    matrix[N + n, n] += weight_s * slope_at(i, SECOND, nodes) - half * rate_s
    matrix[N + n, N + n] -= half * slopes.rate


@kernel
def scales(frame, case):
    """(Of s, of the second unknown): what errors are measured by; speeds by the largest of the panel."""
    nodes = case.work.nodes
    # an error of s is one of V by no more than V/s, which is largest for small s: 1/(2 kappa) at V = 0
    fastest, per = 0.0, 2.0 * case.scene.kappa if nodes[S, 0] * nodes[S, N] <= 0.0 else np.inf
    for i in range(N + 1):
        fastest = max(fastest, nodes[SPEED, i])
        if nodes[PER_V, i] < per:
            per = nodes[PER_V, i]
    if frame.slips:
        return per * fastest, fastest
    return per * fastest, 1.0 / creep_weight(nodes[SECOND, N])


@kernel
def solve(panel, slopes, track, frame, case):
    """Collocate from node 0, where the rates have these ``slopes``, to a share of the tolerance.  Whether it did.

    ``track`` : the panel whose interpolants are there; afterwards they are those of this one.
    """
    work, tolerance, half = case.work, SHARE * case.limits.rtol, 0.5 * panel.length
    left = max(_NEWTON * tolerance, _LEAST)
    nodes, right = work.nodes, work.right
    put_drive(panel, case)
    guess(panel, slopes, track, frame, case)
    before, anew = np.inf, True
    for _ in range(_MOST_ITERATIONS):
        for i in range(1, N + 1):
            _, weight = time_at(panel, i)
            here = put_node(i, weight, load_there(i, frame, case), frame, case)
            if anew:
                _put_matrix(i, half, weight, here, frame, case)
            right[i - 1] = half * nodes[S_RATE, i] - slope_at(i, S, nodes)
            right[N + i - 1] = half * nodes[RATE, i] - here.weight * slope_at(i, SECOND, nodes)
        if anew:
            factorize(work.matrix, 2 * N)
        substitute(work.matrix, right, 2 * N)
        per_s, per_second = scales(frame, case)
        change = 0.0 * (right[0] + right[N])  # a NaN is in all of them, and lost in any other argument of max
        for i in range(N):
            change = max(change, abs(right[i]) / per_s, abs(right[N + i]) / per_second)
            nodes[S, i + 1] += right[i]
            nodes[SECOND, i + 1] += right[N + i]
        first = before == np.inf
        gain = 1.0 if first else change / before
        if not (change < 1e6 and gain < 2.0):
            return False
        # what is integrated stays as it was before this change
        if change <= max(tolerance, _LEAST) and change * gain <= left:
            put_path(panel, frame, case)
            rise_terms(nodes[S], work.powers, OF_S)
            rise_terms(nodes[SECOND], work.powers, OF_SECOND)
            return True
        # new slopes cost as much as three more iterations
        anew = change * gain**_PATIENCE > left and not first
        before = change
    return False


@kernel
def _mismatch(row, first, half, nodes):
    """Rate at the left end less that which the nodes extrapolate to, over the panel."""
    off = first
    for i in range(N):
        off -= TO_START[i] * nodes[row, i + 1]
    return 2.0 * half * abs(off)


@kernel
def _least(panel, case):
    """s where the first output lies, over the largest: speeds there are to be right beside themselves."""
    nodes, at = case.work.nodes, case.tau[case.tau.size - 1]
    for i in range(case.tau.size):
        if case.tau[i] > panel.tau:
            at = case.tau[i]
            break
    largest = least = 0.0
    for i in range(1, N + 1):
        largest = max(largest, abs(nodes[S, i]))
        if least == 0.0 or time_at(panel, i)[0] <= at:
            least = abs(nodes[S, i])
    return least / largest if largest > 0.0 else 1.0


@kernel
def panel_error(panel, slopes, frame, case):
    """Error of the interpolants over their tolerance; of b only what its relaxation leaves of it counts."""
    nodes, half, smooth = case.work.nodes, 0.5 * panel.length, panel.power == 1
    per_s, per_second = scales(frame, case)
    # a mismatch may happen to be small where the last of Chebyshev's terms is not
    error = _mismatch(S_RATE, nodes[S_RATE, 0] if smooth else 0.0, half, nodes)
    error = max(error, _LAST * abs(case.work.powers[OF_S, N - 1]))
    # shorter panels do not mend what the rounding of the drive moves V by
    error = max(error - 2.0 * case.scene.kappa * panel.length * rounding(panel.piece, case.drive.pieces), 0.0) / per_s
    if nodes[SPEED, 0] == 0.0:
        error /= _least(panel, case)
    else:  # early on speeds are to be right beside those so far
        error *= np.sqrt(max(nodes[SPEED, N] / nodes[SPEED, 0], 1.0))
    if panel.free:
        off = nodes[RATE, 0] / slopes.weight * half if smooth else 0.0
        for i in range(N):
            off -= TO_START[i] * slope_at(i + 1, SECOND, nodes)
        # near the edge of the stick zone relaxation comes to an end
        slowest = abs(nodes[SLOPE, 0])
        for i in range(1, N + 1):
            if abs(nodes[SLOPE, i]) < slowest:
                slowest = abs(nodes[SLOPE, i])
        lasting = 1.0 + panel.length * slowest
        error = max(error, 2.0 * abs(off) / (lasting * per_second))
    return _OVERSTATED * error / (SHARE * case.limits.rtol)
