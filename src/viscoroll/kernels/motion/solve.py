"""A panel of time by Radau IIA collocation of p and of the second unknown.

Collocation is written with the slopes of the interpolants, so that the equation of d may be multiplied by V, which
vanishes where a panel ends at V = 0.  At the nodes, with D the slopes of the interpolants and h half the length,

    (D - h diag(p'_V/p_V)) dp = h p' - D p       [diag(V) D - diag(h b_d + c p_d/p_V)] dd = h b - V (D d) - c dp/p_V

b = V d', c = D d - h b_V, dV = (dp - p_d dd)/p_V: two N x N systems an iteration.  Their factors are kept while
changes are small.  In full slip p is V, the second unknown omega, and 1 stands for the V that multiplies its equation.
Where friction is strong p is V too, but d feeds it by F = h dV'/dd, as omega does by a gain: with S the second matrix,

    [D - h diag(dV'/dV) + diag(F) S^-1 diag(c)] dV = h V' - D V + F S^-1 (h b - V (D d))
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.intrinsics import unlikely
from ..compile.jit import kernel
from .collocation import SLOPES, TO_START, WIDE, N, invert, product, rise_terms, weighted_slopes
from .guess import guess
from .load import rounding
from .nodes import (
    CHANGE,
    COUPLED,
    DIAGONAL,
    DRIVE,
    FED,
    OF_SECOND,
    OF_V,
    ONES,
    P_RATE,
    P_SECOND,
    P_SLOPE,
    PER_P,
    RATE,
    RIGHT,
    SECOND,
    SECOND_CHANGE,
    SECOND_DIAGONAL,
    SECOND_RIGHT,
    SECOND_SLOPE,
    SLOPE,
    SPEED,
    WEIGHTS,
    P,
    V,
    load_there,
    put_drive,
    put_node,
    time_at,
)
from .rates import rates_at, strong

_MOST_ITERATIONS = 12
#: error per panel is kept at this share of rtol; Newton's iteration stops at this share of that; the least that it can
#: leave
SHARE, _NEWTON, _LEAST = 0.25, 0.016, 1e-14
#: change of the unknowns, and gain by the last iteration, above which new slopes are taken; gain by the first, at most,
#: and over its change
_ANEW, _SLOWED, _FIRST_GAIN, _SQUARED = 1e-2, 1e-3, 0.1, 10.0
#: unit of rounding
_ROUNDING = 2.2e-16
#: what the rounding of Q makes of a mismatch of V', over mu: some tens of units, as its extrapolation enlarges it
_RATE_NOISE = 30.0 * _ROUNDING
#: a mismatch of the rates at the left end overstates the error of their interpolants
_OVERSTATED = 0.02 * (9.0 / N) ** 2
#: a mismatch that is no small share of how the rates vary does not overstate it: over that share
_UNRESOLVED = 30.0
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


@kernel
def _least_speed(panel, case):
    """The V of full slip that rounding of V' leaves a share of the tolerance of Newton's iteration of.

    V' = Q - M + f may be a small difference of Q and f.  Its rounding moves V for the length of the panel, or for the
    time in which V relaxes where that is shorter.
    """
    nodes = case.nodes
    moved = _ROUNDING * (case.scene.mu + abs(nodes[DRIVE + N])) * 0.5 * panel.length / (1.0 + abs(nodes[DIAGONAL + N]))
    return moved / max(_NEWTON * SHARE * case.limits.rtol, _LEAST)


@kernel(inline=True)
def scales(panel, frame, case):
    """(Of V, of the second unknown): what errors are measured by; speeds by the largest of the panel."""
    nodes, fastest, own, moved = case.nodes, 0.0, 0.0, 0.0
    for i in range(N + 1):
        fastest, own = max(fastest, nodes[SPEED + i]), max(own, abs(nodes[V + i]))
    fastest = max(fastest, own)
    if frame.slips:
        # where no gain feeds omega into V', V is measured beside itself: omega may be larger by any factor, and a V
        # that is right beside omega alone may leave the speed at which it settles
        if panel.alone:
            return own, fastest
        return fastest if case.drive.gains.force_omega != 0.0 else max(own, _least_speed(panel, case)), fastest
    # an error of d is one of omega, and of V where p is given
    for i in range(1, N + 1):
        moved = max(moved, abs(nodes[P_SECOND + i] * nodes[PER_P + i]))
    moved = max(moved, 0.5 * case.scene.mu / case.scene.kappa * own) / fastest
    return fastest, 1.0 / max(_creep_weight(nodes[SECOND + N]), moved)


@kernel(inline=True)
def _put_equations(anew, panel, frame, case):
    """Fill the nodes from their unknowns, the right side of the second, and, ``anew``, what both matrices take."""
    own, nodes, half = by_value(case), case.nodes, 0.5 * panel.length
    product(SLOPES, SECOND, nodes[SECOND], nodes, SECOND_SLOPE, nodes)
    for i in range(1, WIDE):
        rates = rates_at(nodes[V + i], nodes[SECOND + i], load_there(i, frame, own), frame, own.scene)
        put_node(i, rates, nodes)
        slope = nodes[SECOND_SLOPE + i]
        nodes[SECOND_RIGHT + i] = half * rates.rate - rates.weight * slope
        if anew:
            per = 1.0 / rates.p_V
            coupled = per * (rates.weight_V * slope - half * rates.rate_V)
            nodes[PER_P + i], nodes[P_SECOND + i], nodes[COUPLED + i] = per, rates.p_second, coupled
            nodes[WEIGHTS + i], nodes[SLOPE + i] = rates.weight, rates.rate_second / rates.weight
            nodes[DIAGONAL + i], nodes[FED + i] = half * rates.p_rate_V * per, half * rates.p_rate_second
            nodes[SECOND_DIAGONAL + i] = half * rates.rate_second + coupled * rates.p_second
    product(SLOPES, P, nodes[P], nodes, P_SLOPE, nodes)
    for i in range(1, WIDE):
        nodes[RIGHT + i] = half * nodes[P_RATE + i] - nodes[P_SLOPE + i]


@kernel
def _feed_matrix(case):
    """Add what d feeds to the matrix of V."""
    for k in range(1, WIDE):
        for i in range(1, WIDE):
            fed = case.nodes[FED + i] * case.second_matrix[WIDE * k + i]
            case.matrix[WIDE * k + i] += fed * case.nodes[COUPLED + k]


@kernel(inline=True)
def _newton(anew, fed, panel, frame, case):
    """One iteration; the largest change over what it is measured by."""
    nodes, matrix, second_matrix = case.nodes, case.matrix, case.second_matrix
    if anew:
        _put_equations(True, panel, frame, case)
        weighted_slopes(ONES, DIAGONAL, nodes, matrix)
        weighted_slopes(WEIGHTS, SECOND_DIAGONAL, nodes, second_matrix)
        invert(second_matrix)
        if fed:
            _feed_matrix(case)
        invert(matrix)
    else:
        _put_equations(False, panel, frame, case)
    if fed:
        product(second_matrix, SECOND_RIGHT, 0.0, nodes, CHANGE, nodes)
        for i in range(1, WIDE):
            nodes[RIGHT + i] += nodes[FED + i] * nodes[CHANGE + i]
    product(matrix, RIGHT, 0.0, nodes, CHANGE, nodes)
    for i in range(1, WIDE):
        nodes[SECOND_RIGHT + i] -= nodes[COUPLED + i] * nodes[CHANGE + i]
    product(second_matrix, SECOND_RIGHT, 0.0, nodes, SECOND_CHANGE, nodes)
    change, rise = 0.0 * (nodes[CHANGE + N] + nodes[SECOND_CHANGE + N]), 0.0  # a NaN is lost in any other place
    for i in range(1, WIDE):
        second = nodes[SECOND_CHANGE + i]
        step = (nodes[CHANGE + i] - nodes[P_SECOND + i] * second) * nodes[PER_P + i]
        rise, change = max(rise, abs(step)), max(change, abs(second))
        nodes[V + i] += step
        nodes[SECOND + i] += second
        nodes[P + i] += nodes[CHANGE + i]
    of_V, of_second = scales(panel, frame, case)
    return max(rise / of_V, change / of_second)


@kernel(inline=True)
def solve(panel, slope, track, frame, case):
    """Collocate from node 0, where the second unknown relaxes with this ``slope``, to a share of the tolerance.
    Whether it did.

    ``track`` : the panel whose interpolants are there; afterwards they are those of this one.
    """
    nodes, tolerance = case.nodes, max(SHARE * case.limits.rtol, _LEAST)
    left = max(_NEWTON * tolerance, _LEAST)
    put_drive(panel, case)
    guess(panel, slope, track, frame, case)
    before, anew = np.inf, True
    fed = case.drive.gains.force_omega != 0.0 if frame.slips else strong(load_there(0, frame, case), frame, case.scene)
    for n in range(_MOST_ITERATIONS):
        change = _newton(anew, fed, panel, frame, case)
        gain = min(_FIRST_GAIN, _SQUARED * change + _SLOWED) if n == 0 else change / before
        if not (change < 1e6 and gain < 2.0):
            return False
        if change * gain <= left:
            rise_terms(V, OF_V, nodes)
            rise_terms(SECOND, OF_SECOND, nodes)
            return True
        anew = change > _ANEW and (n == 0 or gain > _SLOWED)
        before = change
    return False


@kernel(inline=True)
def _mismatch(row, slopes, first, nodes):
    """Slope at the left end less that which those of the interpolant at the nodes extrapolate to, over the panel."""
    product(SLOPES, row, nodes[row], nodes, slopes, nodes)
    off = first
    for i in range(N):
        off -= TO_START[i] * nodes[slopes + i + 1]
    return 2.0 * abs(off)


@kernel(inline=True)
def _variation(half, nodes):
    """By how much the rates of p differ along the panel, times half its length."""
    least = most = nodes[P_RATE + 1]
    for i in range(2, N + 1):
        least, most = min(least, nodes[P_RATE + i]), max(most, nodes[P_RATE + i])
    return half * (most - least)


@kernel
def _least(panel, case):
    """V where the first output lies, over the largest: speeds there are to be right beside themselves."""
    nodes, at = case.nodes, case.tau[case.tau.size - 1]
    for i in range(case.tau.size):
        if case.tau[i] > panel.tau:
            at = case.tau[i]
            break
    largest = least = 0.0
    for i in range(1, N + 1):
        largest = max(largest, abs(nodes[V + i]))
        if least == 0.0 or time_at(panel, i) <= at:
            least = abs(nodes[V + i])
    return least / largest if largest > 0.0 else 1.0


@kernel
def _strong_noise(frame, case):
    """What rounding makes of a mismatch of V' where friction is strong, per length of the panel: V' may be a small
    difference of Q and f.  0 elsewhere, so wherever mu <= kappa."""
    return _RATE_NOISE * case.scene.mu if strong(load_there(0, frame, case), frame, case.scene) else 0.0


@kernel(inline=True)
def panel_error(panel, frame, case):
    """Error of the interpolants over their tolerance; of d only what its relaxation leaves of it counts."""
    nodes, half = case.nodes, 0.5 * panel.length
    of_V, of_second = scales(panel, frame, case)
    per = abs(nodes[PER_P + N])
    error = _mismatch(P, P_SLOPE, nodes[P_RATE] * half, nodes)
    if unlikely(case.scene.mu > case.scene.kappa):
        error = max(error - _strong_noise(frame, case) * panel.length, 0.0)
    error *= per
    varies = _variation(half, nodes) * per + case.limits.rtol * of_V
    error *= min(max(_UNRESOLVED * error / varies, 1.0), 1.0 / _OVERSTATED)
    # a mismatch may happen to be small where the last of Chebyshev's terms is not
    error = max(error, _LAST * abs(case.nodes[OF_V + N - 1]))
    # shorter panels do not mend what the rounding of the drive moves V by
    error = max(error - panel.length * rounding(panel.piece, case.drive.pieces), 0.0) / of_V
    if nodes[SPEED] == 0.0:
        error /= _least(panel, case)
    elif not panel.alone:  # early on speeds are to be right beside those so far
        error *= np.sqrt(max(nodes[SPEED + N] / nodes[SPEED], 1.0))
    if panel.known:
        weight = 1.0 if frame.slips else nodes[V]
        off = _mismatch(SECOND, SECOND_SLOPE, nodes[RATE] / weight * half, nodes)
        # near the edge of the stick zone relaxation comes to an end
        error = max(error, off / ((1.0 + panel.length * abs(nodes[SLOPE])) * of_second))
    if not frame.slips:  # between the nodes
        error = max(error, _LAST * abs(case.nodes[OF_SECOND + N - 1]) / of_second)
    return _OVERSTATED * error / (SHARE * case.limits.rtol)
