"""Where Newton's iteration on a panel begins."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import NODES, N, rise_at
from .load import load_at
from .nodes import OF_S, OF_SECOND, RATE, S_RATE, SECOND, SPEED, S, time_at
from .origin import departing
from .rates import rates_at

#: how far beyond the end of a panel its interpolants are followed, over its length
_REACH = 1.5
#: share of one that was too long up to which they say less of a panel than its rates at the start do: what is off by
#: less than the tolerance of Newton's iteration stays, and may have the sign of an event
_SHORT = 1e-3


@kernel
def guess(panel, slopes, track, frame, case):
    """Fill the unknowns at the nodes, where they reach by the interpolants of the panel ``track``: of the last one, or
    of one that was too long."""
    alike = panel.tau > track.tau or panel.length > _SHORT * track.length
    if alike and panel.tau + panel.length <= track.tau + (1.0 + _REACH) * track.length:
        _follow(panel, track, frame, case.work)
    elif frame.slips and case.work.nodes[SPEED, 0] == 0.0:
        _slide_out(panel, frame, case)
    elif panel.free:
        _set_out(panel, slopes, frame, case.work.nodes)
    else:
        _set_out_from_rest(panel, frame, case)


@kernel(inline=True)
def _along(tau, panel):
    """v at a time."""
    share = max(tau - panel.tau, 0.0) / panel.length
    return 2.0 * (share if panel.power == 1 else share ** (1.0 / panel.power))


@kernel
def _follow(panel, track, frame, work):
    """Along the interpolants of a panel."""
    nodes, powers = work.nodes, work.powers
    most = np.inf if frame.slips else 1.0
    start = _along(panel.tau, track)
    s, second = nodes[S, 0] - rise_at(start, powers, OF_S), nodes[SECOND, 0] - rise_at(start, powers, OF_SECOND)
    for i in range(1, N + 1):
        v = _along(time_at(panel, i)[0], track)
        nodes[S, i] = s + rise_at(v, powers, OF_S)
        nodes[SECOND, i] = min(max(second + rise_at(v, powers, OF_SECOND), -most), most)


@kernel
def _set_out(panel, slopes, frame, nodes):
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
def _set_out_from_rest(panel, frame, case):
    """Unknowns at the nodes from V = 0 in partial slip on, where b follows the drive and s may start at no pace."""
    nodes = case.work.nodes
    load = load_at(panel.tau + panel.length, panel.piece, frame, case)
    sticks, b = departing(load, frame.spin, case.scene)
    if not sticks:
        b = nodes[SECOND, 0]
    late = rates_at(0.0, b, load, frame, case.scene).s_rate
    for i in range(1, N + 1):
        share = 0.5 * (1.0 + NODES[i])
        mean = nodes[S_RATE, 0] + 0.5 * share * (max(late, 0.0) - nodes[S_RATE, 0])
        nodes[S, i] = mean * share * panel.length
        nodes[SECOND, i] = nodes[SECOND, 0] + share * (b - nodes[SECOND, 0])


@kernel
def _slide_out(panel, frame, case):
    """Unknowns at the nodes from V = omega = 0 in full slip on, where speeds may start at no pace and follow the
    drive."""
    nodes = case.work.nodes
    load = load_at(panel.tau + panel.length, panel.piece, frame, case)
    late = rates_at(0.0, 0.0, load, frame, case.scene)
    for i in range(1, N + 1):
        share = 0.5 * (1.0 + NODES[i])
        s_rate = nodes[S_RATE, 0] + 0.5 * share * (late.s_rate - nodes[S_RATE, 0])
        rate = nodes[RATE, 0] + 0.5 * share * (late.rate - nodes[RATE, 0])
        nodes[S, i], nodes[SECOND, i] = s_rate * share * panel.length, rate * share * panel.length
