"""A panel of time by Radau IIA collocation of both unknowns, with what is integrated along the way.

A node holds the unknowns, the integrands of the path, and the functions whose zeros end a regime.  Collocation is
written with the slopes of the interpolants, so that the equation of b may be multiplied by V, which vanishes where a
panel ends at V = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import INTEGRAL, NODES, SLOPES, TO_START, N
from ..motion.control import SHARE, creep_weight
from ..motion.path import grade
from ..numerics.linear import factorize, substitute
from .load import load_at, needed
from .origin import departing
from .rates import rates_at
from .records import EDGE, EVENTS, FREED, KINK, SLOW, STOP, TURN

#: rows of the values at the nodes: unknowns, their rates, speed scale; what the path is made of; its integrands;
#: functions of events
S, SECOND, S_RATE, RATE, SPEED, OF_V, OF_OMEGA, OF_DELTA, OF_Q, OF_HALF_SPACE, OF_CYLINDER = range(11)
PATH = 11
#: of the path: x, angle, work of force and of torque, losses in the brake, in slip and in rolling
PATHS = 7
EVENT = PATH + PATHS
ROWS = EVENT + EVENTS
#: rows of the interpolants: of s, of the second unknown, of the path, of the function of an event
OF_S, OF_SECOND, OF_PATH, OF_EVENT = 0, 1, 2, 2 + PATHS
INTERPOLANTS = OF_EVENT + 1

_MOST_ITERATIONS = 12
#: gain of an iteration from which on new slopes are taken; the least that Newton's iteration can leave
_SLOW, _LEAST = 0.1, 1e-14
#: it stops at this share of the tolerance
NEWTON = 0.01
#: step of the difference quotients in s, relative
_STEP = 1e-7
#: a mismatch of the rates at the left end overstates the error of their interpolants
_OVERSTATED = 0.02


class Panel(NamedTuple):
    """A stretch of time within a piece of the drive; it grows as (v/2)^power, v in [0, 2].

    free : whether the slope of the second unknown at the left end is known
    """

    tau: float
    length: float
    power: int
    piece: int
    free: bool


class Slopes(NamedTuple):
    """Of the rates at a node in the second unknown, and the weight of the slope of that."""

    s: float
    rate: float
    weight: float


@kernel(inline=True)
def put_node(i, tau, weight, piece, frame, case):
    """Fill node i from its unknowns, rates times ``weight``: their slopes, times that too."""
    nodes = case.work.nodes
    rates = rates_at(nodes[S, i], nodes[SECOND, i], load_at(tau, piece, frame, case), frame, case.scene)
    nodes[S_RATE, i], nodes[RATE, i] = weight * rates.s_rate, weight * rates.rate
    nodes[SPEED, i] = max(abs(rates.V), abs(rates.omega))
    nodes[OF_V, i], nodes[OF_OMEGA, i], nodes[OF_DELTA, i] = rates.V, rates.omega, rates.delta
    nodes[OF_Q, i], nodes[OF_HALF_SPACE, i], nodes[OF_CYLINDER, i] = rates.Q, rates.M_half_space, rates.M_cylinder
    nodes[EVENT + EDGE, i] = rates.edge
    return Slopes(weight * rates.s_slope, weight * rates.rate_slope, rates.weight)


@kernel
def put_path(panel, frame, case):
    """Fill the integrands of the path and the functions of events at all nodes of a panel that is solved."""
    nodes, rest = case.work.nodes, case.limits.rest
    for i in range(N + 1):
        tau, weight = time_at(panel, i)
        V, omega, Q = nodes[OF_V, i], nodes[OF_OMEGA, i], nodes[OF_Q, i]
        M_half_space, M_cylinder = nodes[OF_HALF_SPACE, i], nodes[OF_CYLINDER, i]
        load = load_at(tau, panel.piece, frame, case)
        force, torque, brake = needed((V, omega), (Q, M_half_space, M_cylinder), load, frame, case.scene.j)
        slip = omega - V if frame.slips else V * nodes[OF_DELTA, i]
        nodes[PATH, i], nodes[PATH + 1, i] = weight * V, weight * omega
        nodes[PATH + 2, i], nodes[PATH + 3, i] = weight * (force * V), weight * (torque * omega)
        nodes[PATH + 4, i], nodes[PATH + 5, i] = -weight * (brake * omega), weight * (slip * Q)
        nodes[PATH + 6, i] = weight * (V * M_half_space + omega * M_cylinder)
        nodes[EVENT + KINK, i] = 1.0 if frame.slips else frame.sigma * nodes[SECOND, i]
        nodes[EVENT + TURN, i] = nodes[S, i]
        nodes[EVENT + STOP, i] = frame.spin * omega if frame.spin != 0.0 and not frame.locked else 1.0
        nodes[EVENT + SLOW, i] = nodes[SPEED, i] - rest if rest > 0.0 else 1.0
        nodes[EVENT + FREED, i] = load.brake - abs(brake) if frame.locked else 1.0


@kernel(inline=True)
def time_at(panel, i):
    """(tau, weight of the rates) at node i."""
    share = 0.5 * (1.0 + NODES[i])
    return panel.tau + panel.length * share**panel.power, grade(share, panel.power)


@kernel
def _guess(panel, slopes, frame, nodes):
    """Unknowns at the nodes: s at its pace, the other on its way to where it comes to stand."""
    most = np.inf if frame.slips else 1.0
    weight = slopes.weight
    pace, fall = nodes[RATE, 0] / weight, slopes.rate / weight
    for i in range(1, N + 1):
        since = panel.length * (0.5 * (1.0 + NODES[i])) ** panel.power
        lasting = np.expm1(fall * since) / fall if fall < 0.0 and fall * since < -1e-8 else since
        nodes[S, i] = nodes[S, 0] + nodes[S_RATE, 0] * since
        nodes[SECOND, i] = min(max(nodes[SECOND, 0] + pace * lasting, -most), most)


@kernel
def _guess_from_rest(panel, frame, case):
    """Unknowns at the nodes from V = 0 in partial slip on, where b follows the drive and s may start at no pace."""
    nodes = case.work.nodes
    load = load_at(panel.tau + panel.length, panel.piece, frame, case)
    sticks, b = departing(load, case.scene)
    if not sticks:
        b = nodes[SECOND, 0]
    late = rates_at(0.0, b, load, frame, case.scene).s_rate
    for i in range(1, N + 1):
        share = 0.5 * (1.0 + NODES[i])
        mean = nodes[S_RATE, 0] + 0.5 * share * (max(late, 0.0) - nodes[S_RATE, 0])
        nodes[S, i] = mean * share * panel.length
        nodes[SECOND, i] = nodes[SECOND, 0] + share * (b - nodes[SECOND, 0])


@kernel(inline=True)
def slope_at(i, row, nodes):
    """Slope in t of the interpolant of a row at node i."""
    total = 0.0
    for k in range(N + 1):
        total += SLOPES[i - 1, k] * nodes[row, k]
    return total


@kernel
def _put_matrix(i, half, slopes, panel, frame, case):
    """Rows of Newton's matrix for node i; the slopes in s are differences."""
    nodes, matrix = case.work.nodes, case.work.matrix
    tau, weight = time_at(panel, i)
    s, step = nodes[S, i], _STEP * max(abs(nodes[S, i]), 0.01 * abs(nodes[S, 0]), abs(nodes[S_RATE, i]) * half)
    at = rates_at(s + step, nodes[SECOND, i], load_at(tau, panel.piece, frame, case), frame, case.scene)
    s_s = (weight * at.s_rate - nodes[S_RATE, i]) / step
    rate_s = (weight * at.rate - nodes[RATE, i]) / step
    weight_s = (at.weight - slopes.weight) / step
    row = 2 * (i - 1)
    for k in range(N):
        matrix[row, 2 * k], matrix[row, 2 * k + 1] = SLOPES[i - 1, k + 1], 0.0
        matrix[row + 1, 2 * k], matrix[row + 1, 2 * k + 1] = 0.0, slopes.weight * SLOPES[i - 1, k + 1]
    matrix[row, row] -= half * s_s
    matrix[row, row + 1] -= half * slopes.s
    matrix[row + 1, row] += weight_s * slope_at(i, SECOND, nodes) - half * rate_s
    matrix[row + 1, row + 1] -= half * slopes.rate


@kernel
def scales(frame, case):
    """(Of s, of the second unknown): what errors are measured by; speeds by the largest of the panel."""
    nodes = case.work.nodes
    largest = fastest = 0.0
    for i in range(N + 1):
        largest, fastest = max(largest, abs(nodes[S, i])), max(fastest, nodes[SPEED, i])
    if frame.slips:
        return max(largest, 2.0 * case.scene.kappa * fastest), fastest
    return largest, 1.0 / creep_weight(nodes[SECOND, N])


@kernel
def solve(share, panel, slopes, frame, case):
    """Collocate from node 0, where the rates have these ``slopes``, to a share of the tolerance.  Whether it did."""
    work, tolerance, half = case.work, SHARE * case.limits.rtol, 0.5 * panel.length
    left = max(share * tolerance, _LEAST)
    nodes, right = work.nodes, work.right
    if panel.free:
        _guess(panel, slopes, frame, nodes)
    else:
        _guess_from_rest(panel, frame, case)
    before, anew = np.inf, True
    for _ in range(_MOST_ITERATIONS):
        for i in range(1, N + 1):
            tau, weight = time_at(panel, i)
            here = put_node(i, tau, weight, panel.piece, frame, case)
            if anew:
                _put_matrix(i, half, here, panel, frame, case)
            right[2 * i - 2] = half * nodes[S_RATE, i] - slope_at(i, S, nodes)
            right[2 * i - 1] = half * nodes[RATE, i] - here.weight * slope_at(i, SECOND, nodes)
        if anew:
            factorize(work.matrix, 2 * N)
        substitute(work.matrix, right, 2 * N)
        per_s, per_second = scales(frame, case)
        change = 0.0 * (right[0] + right[1])  # a NaN is in all of them, and lost in any other argument of max
        for i in range(N):
            change = max(change, abs(right[2 * i]) / per_s, abs(right[2 * i + 1]) / per_second)
            nodes[S, i + 1] += right[2 * i]
            nodes[SECOND, i + 1] += right[2 * i + 1]
        first = before == np.inf
        gain = 1.0 if first else change / before
        if not (change < 1e6 and gain < 2.0):
            return False
        # what is integrated stays as it was before this change
        if change <= max(tolerance, _LEAST) and change * gain <= left:
            put_path(panel, frame, case)
            return True
        anew = gain > _SLOW and not first
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
    return least / largest


@kernel
def panel_error(panel, slopes, frame, case):
    """Error of the interpolants over their tolerance; of b only what its relaxation leaves of it counts."""
    nodes, half, smooth = case.work.nodes, 0.5 * panel.length, panel.power == 1
    per_s, per_second = scales(frame, case)
    error = _mismatch(S_RATE, nodes[S_RATE, 0] if smooth else 0.0, half, nodes) / per_s
    if nodes[SPEED, 0] == 0.0:
        error /= _least(panel, case)
    if panel.free:
        off = nodes[RATE, 0] / slopes.weight * half if smooth else 0.0
        for i in range(N):
            off -= TO_START[i] * slope_at(i + 1, SECOND, nodes)
        lasting = 1.0 + panel.length * abs(slopes.rate / slopes.weight)
        error = max(error, 2.0 * abs(off) / (lasting * per_second))
    return _OVERSTATED * error / (SHARE * case.limits.rtol)


@kernel
def risen(row, panel, nodes):
    """Integral of a row over the panel."""
    total = 0.0
    for i in range(N):
        total += INTEGRAL[i] * nodes[row, i + 1]
    return 0.5 * panel.length * total
