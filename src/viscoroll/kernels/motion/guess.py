"""Where Newton's iteration on a panel begins."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import SHARES, N, rise_at
from .load import load_at
from .nodes import OF_SECOND, OF_V, RATE, SECOND, SPEED, V_RATE, V, along, time_at
from .origin import departing
from .rates import rates_of
from .records import State

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
        _follow(panel, track, frame, case.nodes)
    elif panel.known and case.nodes[SPEED] > 0.0:
        _set_out(panel, slope, frame, case.nodes)
    else:
        _set_out_from_rest(panel, frame, case)


@kernel(inline=True)
def _keep(i, speed, second, slips, nodes):
    """Unknowns at a node; in partial slip V >= 0, |d| <= 1."""
    nodes[V + i] = speed if slips else max(speed, 0.0)
    nodes[SECOND + i] = second if slips else min(max(second, -1.0), 1.0)


@kernel
def _follow(panel, track, frame, nodes):
    """Along the interpolants of a panel."""
    start = along(panel.tau, track)
    speed, second = nodes[V] - rise_at(start, nodes, OF_V), nodes[SECOND] - rise_at(start, nodes, OF_SECOND)
    for i in range(1, N + 1):
        v = along(time_at(panel, i), track)
        _keep(i, speed + rise_at(v, nodes, OF_V), second + rise_at(v, nodes, OF_SECOND), frame.slips, nodes)


@kernel
def _set_out(panel, slope, frame, nodes):
    """Unknowns at the nodes: the second on its way to where it comes to stand."""
    pace = nodes[RATE] if frame.slips else nodes[RATE] / nodes[V]
    for i in range(1, N + 1):
        since = panel.length * SHARES[i]
        lasting = np.expm1(slope * since) / slope if slope * since < -1e-8 else since
        _keep(i, nodes[V] + nodes[V_RATE] * since, nodes[SECOND] + pace * lasting, frame.slips, nodes)


@kernel
def _set_out_from_rest(panel, frame, case):
    """Unknowns at the nodes from V = 0 on, where speeds may start at no pace and follow the drive, as d does."""
    nodes = case.nodes
    load, d = load_at(panel.tau + panel.length, panel.piece, frame, case), 0.0
    if not frame.slips:
        sticks, d = departing(load, frame.spin, case.scene)
        d = d if sticks else nodes[SECOND]
    rates = rates_of(State(0.0, d), load, frame, case.scene)
    late = rates.V_rate if frame.slips else max(rates.p_rate / rates.p_V, 0.0)
    for i in range(1, N + 1):
        since, half = SHARES[i] * panel.length, 0.5 * SHARES[i]
        rise = (nodes[RATE] + half * (rates.rate - nodes[RATE])) * since
        second = rise if frame.slips else nodes[SECOND] + SHARES[i] * (d - nodes[SECOND])
        _keep(i, (nodes[V_RATE] + half * (late - nodes[V_RATE])) * since, second, frame.slips, nodes)
