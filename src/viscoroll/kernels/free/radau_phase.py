"""Partial slip in time: where the boundary layer is not followed, and the slow manifold not reached yet."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import NODES, N, place, rise_terms
from .control import SHARE, creep_weight, next_length
from .layer_phase import GRADED, first_bend
from .panel import pass_path
from .partial_slip import slow_D
from .path import D_D, D_TAU, D_Y, RISE_D, SHARE_D, D, Y
from .radau import radau_error, radau_solve, radau_start
from .records import NO_EVENT, SLIP, STUCK, TIME, Clock, Panel
from .slow_phase import FAR

#: panels rejected in a row
_MOST_REJECTIONS = 60
#: relaxation over the rise of y from which on there is a slow manifold
_STIFF = 20.0
#: distance from the manifold over its tolerance from which on it may be tried
_NEAR = 10.0
#: a stick zone that starts at eta = 0 may round to below it before it grows
_ROUNDING = 1e-15
#: share of rtol that the square of D/zeta may be on the wrong side of delta = 0
_KINK = 0.01
#: panels solved at most until one ends on an edge of the stick zone, and how close that is in units of zeta
_CUTS, _HIT = 5, 4e-16
#: and a correction of the length that is none
_LAST = 1e-15
#: longest first panel in relaxation times
_FIRST = 3.0
#: slip that returns from the start on is looked at closer: so often, each time in a panel of this share
_MOST_RETRIES, _CLOSER = 6, 0.1


@kernel
def settled(state, rates, case):
    """Whether the slow manifold seems near, so that following it may be tried."""
    dy, dD, slope = rates
    relaxation = -slope
    if relaxation <= _STIFF * abs(dy):
        return False
    D0, D0_y = slow_D(state.first, case.scene)
    drift, per = abs(dD - D0_y * dy), np.exp(-state.first)
    if drift <= 5.0 * dy * abs(state.second - D0):
        return True
    return drift * creep_weight(state.second * per) * per <= _NEAR * SHARE * case.limits.rtol * relaxation


@kernel
def panel_size(length, power, sign, rates, state, case):
    """Error of the panel from node 0 over its tolerance; infinite where it failed."""
    if not radau_solve(length, power, sign, rates, case.limits.rtol, case.scene, case.work):
        return np.inf
    return radau_error(length, rates[2], case.limits.rtol, state, case.work.nodes)


@kernel
def fill_shares(sign, nodes):
    """D/zeta at the nodes, positive on this side of delta = 0."""
    for i in range(N + 1):
        nodes[SHARE_D, i] = sign * nodes[D, i] * np.exp(-nodes[Y, i])


@kernel
def first_edge(rtol, nodes):
    """(Edge of the stick zone met, node behind it): 0 where delta = 0, 1 where the zone is lost; -1 for none.

    Node 0 where the zone is lost from the start on.  So little beyond delta = 0 that the square of D/zeta is no error,
    the side does not matter.
    """
    beyond = -np.sqrt(_KINK * rtol)
    inside = nodes[SHARE_D, 0] < 1.0 - _ROUNDING
    for i in range(1, N + 1):
        share = nodes[SHARE_D, i]
        if share < beyond:
            return 0.0, i
        if share > 1.0 + _ROUNDING:
            return 1.0, i if inside else 0
        inside = inside or share < 1.0
    return -1.0, N


@kernel
def cut_at(edge, node, length, power, sign, rates, state, case):
    """(Length, error) of the panel that ends on the edge; the error is infinite where it is not found.

    On the interpolant first, then by solving panels of that length, corrected by the slope at their ends.
    """
    nodes, powers = case.work.nodes, case.work.powers
    rise_terms(nodes[SHARE_D], powers, RISE_D)
    v = place(edge - nodes[SHARE_D, 0], 1.0 + NODES[node], powers, RISE_D)
    length *= (0.5 * v) ** power
    for _ in range(_CUTS):
        size = panel_size(length, power, sign, rates, state, case)
        fill_shares(sign, nodes)
        off = nodes[SHARE_D, N] - edge
        if not size < np.inf or abs(off) <= _HIT:
            return length, size
        rise = (sign * nodes[D_D, N] * np.exp(-nodes[Y, N]) - nodes[SHARE_D, N] * nodes[D_Y, N]) / nodes[D_TAU, N]
        change = off / rise
        if abs(change) <= _LAST * length:
            return length, size
        length -= change
        if not length > 0.0:
            break
    return length, np.inf


@kernel
def radau_start_of(sign, power, state, case):
    """(Sign of delta on the next panel, y', D' and its slope in D), with node 0 filled."""
    sign = np.sign(state.second) if state.second != 0.0 else sign
    rates = radau_start(state.first, state.second, sign, power, case.scene, case.work.nodes)
    if state.second == 0.0 and rates[1] * sign < 0.0:
        sign = -sign
        rates = radau_start(state.first, state.second, sign, power, case.scene, case.work.nodes)
    return sign, rates


@kernel
def radau_phase(try_at, state, frame, clock, case):
    """Partial slip to an event, until outputs end, to y = FAR, or from ``try_at`` on near the slow manifold.

    Returns (event, whether the slow manifold seems near, state, clock).
    """
    limits, sink, nodes = case.limits, case.sink, case.work.nodes
    tau_end = sink.tau[sink.tau.size - 1]
    power, rejected = GRADED, 0
    sign, rates = radau_start_of(1.0, power, state, case)
    length = first_bend(state.first, state.second, limits.rtol, case.scene) / abs(rates[1])
    length = min(length, _FIRST / abs(rates[2])) if rates[2] != 0.0 else length
    while clock.at < sink.tau.size and clock.steps < limits.max_steps and state.first < FAR:
        if rejected == 0 and clock.tau >= try_at and settled(state, rates, case):
            return NO_EVENT, True, state, clock
        length = min(length, tau_end - clock.tau)
        size = panel_size(length, power, sign, rates, state, case)
        clock = Clock(clock.tau, clock.at, clock.steps + 1, clock.ends)
        rejected += 1
        ahead, edge = next_length(length, size, power), -1.0
        if size <= 1.0:
            fill_shares(sign, nodes)
            edge, node = first_edge(limits.rtol, nodes)
            if edge == 1.0 and node == 0:
                if rejected > _MOST_RETRIES:
                    return SLIP, False, state, clock
                ahead, size = _CLOSER * length, np.inf
            elif edge >= 0.0:
                length, size = cut_at(edge, node, length, power, sign, rates, state, case)
                ahead = next_length(length, size, power)
        if not size <= 1.0:
            length = ahead
            if rejected > _MOST_REJECTIONS or not clock.tau + length > clock.tau:
                return STUCK, False, state, clock
            continue
        panel = Panel(TIME, state.first, state.second, length, power, 0.0, 0.0, 0.0, 0.0)
        D_end = 0.0 if edge == 0.0 else sign * np.exp(nodes[Y, N]) if edge == 1.0 else nodes[D, N]
        event, state, clock = pass_path(nodes[Y, N], D_end, panel, state, frame, clock, case)
        if event != NO_EVENT or edge == 1.0:
            return event if event != NO_EVENT else SLIP, False, state, clock
        power, rejected, length = 1, 0, ahead
        sign, rates = radau_start_of(-sign if edge == 0.0 else sign, power, state, case)
    return NO_EVENT, False, state, clock
