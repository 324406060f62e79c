"""A panel of time by Radau IIA collocation of p and of the second unknown.

Collocation is written with the slopes of the interpolants, so that the equation of d may be multiplied by V, which
vanishes where a panel ends at V = 0.  At the nodes, with D the slopes of the interpolants and h half the length,

    (D - h diag(p'_V/p_V)) dp = h p' - D p       [diag(V) D - diag(h b_d + c p_d/p_V)] dd = h b - V (D d) - c dp/p_V

b = V d', c = D d - h b_V, dV = (dp - p_d dd)/p_V: two N x N systems an iteration.  Their factors are kept while
changes are small.  In full slip p is V, the second unknown omega, and 1 stands for the V that multiplies its equation.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.linear import factorize, substitute
from .collocation import SLOPES, TO_START, N, rise_terms
from .guess import guess
from .load import rounding
from .nodes import (
    COUPLED,
    OF_OMEGA,
    OF_SECOND,
    OF_V,
    P_RATE,
    P_SECOND,
    PER_P,
    RATE,
    SECOND,
    SLOPE,
    SPEED,
    P,
    V,
    grade,
    load_there,
    put_drive,
    put_node,
    slope_at,
    time_at,
)
from .rates import rates_at

_MOST_ITERATIONS = 12
#: error per panel is kept at this share of rtol; Newton's iteration stops at this share of that; the least that it can
#: leave
SHARE, _NEWTON, _LEAST = 0.4, 0.01, 1e-14
#: change of the unknowns, and gain by the last iteration, above which new slopes are taken; gain by the first, which
#: nothing tells yet
_ANEW, _SLOWED, _FIRST_GAIN = 1e-3, 1e-3, 0.1
#: a mismatch of the rates at the left end overstates the error of their interpolants
_OVERSTATED = 0.02 * (9.0 / N) ** 2
#: the last term's share of the error: the next one over this one, and the coefficient of a power over that
_LAST = 0.1 / (_OVERSTATED * 2.0 ** (N - 1))
_D_SHARE = 0.04


@kernel(inline=True)
def _creep_weight(share):
    """Weight of an error of d, at this |d|.

    d matters through omega - V and through V', whose error V carries, and its errors decay: it is held relative to the
    contact, as an error of Q/mu, and more loosely relative to itself; but not where it decides on the end of stick.
    """
    return max(_D_SHARE, share * share) / (abs(share) + _D_SHARE)


@kernel(inline=True)
def scales(panel, frame, case):
    """(Of V, of the second unknown): what errors are measured by; speeds by the largest of the panel."""
    nodes, fastest, own, moved = case.work.nodes, 0.0, 0.0, 0.0
    for i in range(N + 1):
        fastest, own = max(fastest, nodes[SPEED, i]), max(own, abs(nodes[V, i]))
    fastest = max(fastest, own)
    if frame.slips:
        return own if panel.alone else fastest, fastest
    # an error of d is one of omega, and of V where p is given
    for i in range(1, N + 1):
        moved = max(moved, abs(nodes[P_SECOND, i] * nodes[PER_P, i]))
    moved = max(moved, 0.5 * case.scene.mu / case.scene.kappa * own) / fastest
    return fastest, 1.0 / max(_creep_weight(nodes[SECOND, N]), moved)


@kernel(inline=True)
def _put_rows(i, half, rates, slope, case):
    """Rows of both of Newton's matrices for node i; ``slope``: of the interpolant of the second unknown."""
    work, n, per = case.work, i - 1, 1.0 / rates.p_V
    coupled = per * (rates.weight_V * slope - half * rates.rate_V)
    for k in range(N):
        work.matrix[n, k] = SLOPES[n, k + 1]
        work.second_matrix[n, k] = rates.weight * SLOPES[n, k + 1]
    work.matrix[n, n] -= half * rates.p_rate_V * per
    work.second_matrix[n, n] -= half * rates.rate_second + coupled * rates.p_second
    work.nodes[PER_P, i], work.nodes[P_SECOND, i], work.nodes[COUPLED, i] = per, rates.p_second, coupled
    work.nodes[SLOPE, i] = rates.rate_second / rates.weight


@kernel(inline=True)
def _put_equations(anew, panel, frame, case):
    """Fill the nodes from their unknowns, the right side of the second, and, ``anew``, both matrices."""
    work, half = case.work, 0.5 * panel.length
    for i in range(1, N + 1):
        weight, slope = grade(i, panel.power), slope_at(i, SECOND, work.nodes)
        rates = rates_at(work.nodes[V, i], work.nodes[SECOND, i], load_there(i, frame, case), frame, case.scene)
        put_node(i, rates, weight, work.nodes)
        work.second_right[i - 1] = half * weight * rates.rate - rates.weight * slope
        if anew:
            _put_rows(i, half * weight, rates, slope, case)


@kernel(inline=True)
def _newton(anew, panel, frame, case):
    """One iteration; the largest change over what it is measured by."""
    work, half = case.work, 0.5 * panel.length
    nodes, right, second_right = work.nodes, work.right, work.second_right
    if anew:
        _put_equations(True, panel, frame, case)
        factorize(work.matrix, N)
        factorize(work.second_matrix, N)
    else:
        _put_equations(False, panel, frame, case)
    for i in range(1, N + 1):
        right[i - 1] = half * nodes[P_RATE, i] - slope_at(i, P, nodes)
    substitute(work.matrix, right, N)
    for i in range(N):
        second_right[i] -= nodes[COUPLED, i + 1] * right[i]
    substitute(work.second_matrix, second_right, N)
    change, rise = 0.0 * (right[0] + second_right[0]), 0.0  # a NaN is in all of them, and lost in any other place
    for i in range(N):
        right[i] = (right[i] - nodes[P_SECOND, i + 1] * second_right[i]) * nodes[PER_P, i + 1]
        rise, change = max(rise, abs(right[i])), max(change, abs(second_right[i]))
        nodes[V, i + 1] += right[i]
        nodes[SECOND, i + 1] += second_right[i]
    of_V, of_second = scales(panel, frame, case)
    return max(rise / of_V, change / of_second)


@kernel(inline=True)
def solve(panel, slope, track, frame, case):
    """Collocate from node 0, where the second unknown relaxes with this ``slope``, to a share of the tolerance.
    Whether it did.

    ``track`` : the panel whose interpolants are there; afterwards they are those of this one.
    """
    work, tolerance = case.work, max(SHARE * case.limits.rtol, _LEAST)
    left = max(_NEWTON * tolerance, _LEAST)
    put_drive(panel, case)
    guess(panel, slope, track, frame, case)
    before, anew = np.inf, True
    for n in range(_MOST_ITERATIONS):
        change = _newton(anew, panel, frame, case)
        gain = _FIRST_GAIN if n == 0 else change / before
        if not (change < 1e6 and gain < 2.0):
            return False
        # what is integrated stays as it was before this change
        if change <= tolerance and change * gain <= left:
            rise_terms(work.nodes[V], work.powers, OF_V)
            rise_terms(work.nodes[SECOND], work.powers, OF_SECOND)
            return True
        anew = change > _ANEW and (n == 0 or gain > _SLOWED)
        before = change
    return False


@kernel(inline=True)
def _mismatch(row, first, half, nodes):
    """Rate at the left end less that which the nodes extrapolate to, over the panel."""
    off = first
    for i in range(N):
        off -= TO_START[i] * nodes[row, i + 1]
    return 2.0 * half * abs(off)


@kernel
def _least(panel, case):
    """V where the first output lies, over the largest: speeds there are to be right beside themselves."""
    nodes, at = case.work.nodes, case.tau[case.tau.size - 1]
    for i in range(case.tau.size):
        if case.tau[i] > panel.tau:
            at = case.tau[i]
            break
    largest = least = 0.0
    for i in range(1, N + 1):
        largest = max(largest, abs(nodes[V, i]))
        if least == 0.0 or time_at(panel, i) <= at:
            least = abs(nodes[V, i])
    return least / largest if largest > 0.0 else 1.0


@kernel(inline=True)
def panel_error(panel, frame, case):
    """Error of the interpolants over their tolerance; of d only what its relaxation leaves of it counts."""
    nodes, half, smooth = case.work.nodes, 0.5 * panel.length, panel.power == 1
    of_V, of_second = scales(panel, frame, case)
    # a mismatch may happen to be small where the last of Chebyshev's terms is not
    error = _mismatch(P_RATE, nodes[P_RATE, 0] if smooth else 0.0, half, nodes) * abs(nodes[PER_P, N])
    error = max(error, _LAST * abs(case.work.powers[OF_V, N - 1]))
    # shorter panels do not mend what the rounding of the drive moves V by
    error = max(error - panel.length * rounding(panel.piece, case.drive.pieces), 0.0) / of_V
    if nodes[SPEED, 0] == 0.0:
        error /= _least(panel, case)
    elif not panel.alone:  # early on speeds are to be right beside those so far
        error *= np.sqrt(max(nodes[SPEED, N] / nodes[SPEED, 0], 1.0))
    if panel.known:
        weight = 1.0 if frame.slips else nodes[V, 0]
        off = nodes[RATE, 0] / weight * half if smooth else 0.0
        # near the edge of the stick zone relaxation comes to an end
        slowest = abs(nodes[SLOPE, 0])
        for i in range(N):
            off -= TO_START[i] * slope_at(i + 1, SECOND, nodes)
            slowest = min(slowest, abs(nodes[SLOPE, i + 1]))
        error = max(error, 2.0 * abs(off) / ((1.0 + panel.length * slowest) * of_second))
    return _OVERSTATED * error / (SHARE * case.limits.rtol)
