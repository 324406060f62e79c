"""Where Newton's iteration on a panel begins."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import SHARES, N, rise_at
from .load import load_at
from .nodes import OF_SECOND, OF_V, RATE, SECOND, SPEED, V_RATE, V, time_at
from .origin import departing
from .rates import rates_at

#: how far beyond the end of a panel its interpolants are followed, over its length
_REACH = 1.5
#: share of one that was too long up to which they say less of a panel than its rates at the start do: what is off by
#: less than the tolerance of Newton's iteration stays, and may have the sign of an event
_SHORT = 1e-3


@kernel
def guess(panel, slope, track, frame, case):
    """Fill the unknowns at the nodes, where they reach by the interpolants of the panel ``track``: of the last one, or
    of one that was too long.

    ``slope`` : over tau at which the second unknown relaxes.
    """
    alike = panel.tau > track.tau or panel.length > _SHORT * track.length
    if alike and track.length > 0.0 and panel.tau + panel.length <= track.tau + (1.0 + _REACH) * track.length:
        _follow(panel, track, frame, case.work)
    elif frame.slips and case.work.nodes[SPEED] == 0.0:
        _slide_out(panel, frame, case)
    elif panel.known:
        _set_out(panel, slope, frame, case.work.nodes)
    else:
        _set_out_from_rest(panel, frame, case)


@kernel(inline=True)
def _along(tau, panel):
    """v at a time."""
    share = max(tau - panel.tau, 0.0) / panel.length
    return 2.0 * (share if panel.power == 1 else share ** (1.0 / panel.power))


@kernel(inline=True)
def _keep(i, speed, second, slips, nodes):
    """Unknowns at a node; in partial slip V >= 0, |d| <= 1."""
    nodes[V + i] = speed if slips else max(speed, 0.0)
    nodes[SECOND + i] = second if slips else min(max(second, -1.0), 1.0)


@kernel
def _follow(panel, track, frame, work):
    """Along the interpolants of a panel."""
    nodes, powers = work.nodes, work.powers
    start = _along(panel.tau, track)
    speed, second = nodes[V] - rise_at(start, powers, OF_V), nodes[SECOND] - rise_at(start, powers, OF_SECOND)
    for i in range(1, N + 1):
        v = _along(time_at(panel, i), track)
        _keep(i, speed + rise_at(v, powers, OF_V), second + rise_at(v, powers, OF_SECOND), frame.slips, nodes)


@kernel
def _set_out(panel, slope, frame, nodes):
    """Unknowns at the nodes: V at its pace, the other on its way to where it comes to stand."""
    pace = nodes[RATE] if frame.slips else nodes[RATE] / nodes[V]
    for i in range(1, N + 1):
        since = panel.length * (SHARES[i] if panel.power == 1 else SHARES[i] ** panel.power)
        lasting = np.expm1(slope * since) / slope if slope < 0.0 and slope * since < -1e-8 else since
        _keep(i, nodes[V] + nodes[V_RATE] * since, nodes[SECOND] + pace * lasting, frame.slips, nodes)


@kernel
def _set_out_from_rest(panel, frame, case):
    """Unknowns at the nodes from V = 0 in partial slip on, where d follows the drive and V may start at no pace."""
    nodes = case.work.nodes
    load = load_at(panel.tau + panel.length, panel.piece, frame, case)
    sticks, d = departing(load, frame.spin, case.scene)
    if not sticks:
        d = nodes[SECOND]
    rates = rates_at(0.0, d, load, frame, case.scene)
    late = max(rates.p_rate / rates.p_V, 0.0)
    for i in range(1, N + 1):
        share = SHARES[i]
        mean = nodes[V_RATE] + 0.5 * share * (late - nodes[V_RATE])
        _keep(i, mean * share * panel.length, nodes[SECOND] + share * (d - nodes[SECOND]), False, nodes)


@kernel
def _slide_out(panel, frame, case):
    """Unknowns at the nodes from V = omega = 0 in full slip on, where speeds may start at no pace and follow the
    drive."""
    nodes = case.work.nodes
    load = load_at(panel.tau + panel.length, panel.piece, frame, case)
    late = rates_at(0.0, 0.0, load, frame, case.scene)
    for i in range(1, N + 1):
        share, since = 0.5 * SHARES[i], SHARES[i] * panel.length
        V_rate = nodes[V_RATE] + share * (late.V_rate - nodes[V_RATE])
        rate = nodes[RATE] + share * (late.rate - nodes[RATE])
        _keep(i, V_rate * since, rate * since, True, nodes)
