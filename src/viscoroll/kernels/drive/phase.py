"""One regime, panel after panel, to an event or to the end of a piece of the drive."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import N
from ..motion.control import next_length
from .events import cut, first_event, length_until
from .load import load_at, piece_end
from .output import pass_panel
from .records import NO_EVENT, STUCK, TURN, Clock, Frame, State
from .solve import NEWTON, RATE, S_RATE, SECOND, SPEED, Panel, S, panel_error, put_node, solve

#: first panel: share of what the unknowns may change by, and time over that of relaxation
_FIRST, _RELAXED = 0.1, 3.0
#: in full slip s may change by this, 1/zeta that divides slow from fast rolling being 1
_SMOOTH = 2.0
#: behind the onset of stick the law bends on the scale tau: nodes of the first panel lie as this power
_GRADED, _BEND = 3, 50.0
#: panels rejected in a row
_MOST_REJECTIONS = 60
#: s at the end of a panel, over that at its start, from which on V = 0 is sought
_NEARLY = 0.2
#: V that stands for 0
_NO_SPEED = 1e-90
#: error over the tolerance up to which a panel shows where its regime ends
_CUTTABLE = 1e6


@kernel
def _first_length(fresh, slopes, clock, frame, case):
    """Length to try first."""
    nodes, scene = case.work.nodes, case.scene
    pace, rate, weight = abs(nodes[S_RATE, 0]), abs(nodes[RATE, 0]), slopes.weight
    if frame.slips:
        change = 2.0 * scene.kappa * nodes[SPEED, 0]
        if nodes[SPEED, 0] == 0.0:
            return np.inf
        slowest = max(pace / max(change, nodes[S, 0]), rate / nodes[SPEED, 0])
        length = _FIRST / slowest if slowest > 0.0 else np.inf
        return min(length, (nodes[S, 0] + _SMOOTH) / pace) if pace > 0.0 else length
    if not weight > _NO_SPEED:  # from V = 0 on
        return np.inf
    length = _RELAXED * weight / abs(slopes.rate)
    if fresh:
        # as far as b may go at the bend of the law near eta = 0
        near = 1.0 - abs(nodes[SECOND, 0]) + scene.material.tau * nodes[S, 0]
        length = min(length, _BEND * case.limits.rtol ** (1.0 / 3.0) * near * weight / max(rate, 1e-300))
        load = load_at(clock.tau, clock.piece, frame, case)
        return min(length, weight / (4.0 * scene.kappa * max(load.per_V + load.per_omega, 1.0)))
    return min(length, _FIRST * nodes[S, 0] / pace) if pace > 0.0 else length


@kernel(inline=True)
def _pace_to_zero(panel, state, frame, case):
    """Time until V = 0 at the pace at the start: there the law bends, and that of partial slip ends.

    In partial slip V only comes to 0 against the drive.
    """
    pace = case.work.nodes[S_RATE, 0]
    if not pace < 0.0:
        return np.inf
    if frame.slips:
        return -state.s / pace
    load = load_at(panel.tau, panel.piece, frame, case)
    against = load.V_rate + load.omega_rate
    if against > 0.0 or (against == 0.0 and load.force + load.torque >= 0.0):
        return np.inf
    return -state.s / pace


@kernel(inline=True)
def _attempt(panel, left, aimed, slopes, frame, case):
    """(Event, panel, error over its tolerance, length to go on with) of a panel, cut where the regime ends."""
    nodes, power = case.work.nodes, panel.power
    size, event = np.inf, NO_EVENT
    if solve(NEWTON, panel, slopes, frame, case):
        size = panel_error(panel, slopes, frame, case)
    ahead = next_length(panel.length, size, power)
    if not size <= _CUTTABLE:
        return event, panel, size, ahead
    # where the regime ends the law bends: the panel that ends there may be good where this one is not
    event, node = first_event(NO_EVENT, nodes)
    at = longest = panel.length
    if event != NO_EVENT:
        at = length_until(event, node, panel, case)
    elif aimed and size <= 1.0 and nodes[S, N] < _NEARLY * nodes[S, 0]:
        event, longest = TURN, left
    if event != NO_EVENT:
        event, panel, size = cut(event, at, longest, panel, slopes, frame, case)
        ahead = next_length(panel.length, size, power)
    return event, panel, size, ahead


@kernel
def _begin(state, frame, clock, case):
    """(Frame, slopes) with node 0 filled; from delta = 0 on the branch is that which b turns to."""
    nodes = case.work.nodes
    nodes[S, 0], nodes[SECOND, 0] = state.s, state.second
    slopes = put_node(0, clock.tau, 1.0, clock.piece, frame, case)
    if not frame.slips and state.second == 0.0 and frame.sigma * nodes[RATE, 0] < 0.0:
        frame = Frame(False, frame.direction, -frame.sigma, frame.spin, frame.locked)
        slopes = put_node(0, clock.tau, 1.0, clock.piece, frame, case)
    return frame, slopes


@kernel
def phase(fresh, state, frame, clock, case):
    """Follow a regime: (event, state, frame, clock).  ``fresh``: the stick zone has just formed."""
    nodes, limits = case.work.nodes, case.limits
    end, length, rejected = piece_end(clock.piece, case), 0.0, 0
    power = _GRADED if fresh else 1
    while clock.tau < end and clock.steps < limits.max_steps:
        frame, slopes = _begin(state, frame, clock, case)
        if length == 0.0:
            length = _first_length(fresh, slopes, clock, frame, case)
        left = end - clock.tau
        panel = Panel(clock.tau, min(length, left), power, clock.piece, frame.slips or slopes.weight > _NO_SPEED)
        zero = _pace_to_zero(panel, state, frame, case)
        aimed = zero < panel.length and rejected == 0
        if zero < panel.length:
            panel = Panel(panel.tau, zero, power, panel.piece, panel.free)
        clock = Clock(clock.tau, clock.at, clock.piece, clock.steps + 1, clock.ends)
        event, panel, size, length = _attempt(panel, left, aimed, slopes, frame, case)
        rejected += 1
        if not size <= 1.0:
            if rejected > _MOST_REJECTIONS or not clock.tau + length > clock.tau:
                return STUCK, state, frame, clock
            continue
        last = panel.length == left and event == NO_EVENT
        clock = pass_panel(end if last else panel.tau + panel.length, panel, frame, clock, case)
        state = State(nodes[S, N], nodes[SECOND, N])
        if event != NO_EVENT:
            return event, state, frame, clock
        power, rejected = 1, 0
    return NO_EVENT, state, frame, clock
