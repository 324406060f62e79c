"""One regime, panel after panel, to an event or to the end of a piece of the drive."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import N, rise_at
from ..motion.control import next_length
from .events import NOWHERE, ends_on, first_event, goes_behind, passed_over, place_of
from .load import load_at, piece_end, undriven
from .nodes import OF_S, OF_SECOND, RATE, S_RATE, SECOND, SPEED, Panel, S, put_node
from .origin import departing
from .output import pass_panel
from .rates import rates_at
from .records import EDGE, NO_EVENT, SLOW, STUCK, TURN, Clock, Frame, State
from .solve import panel_error, solve

#: first panel: share of what the unknowns may change by, and time over that of relaxation
_FIRST, _RELAXED = 0.4, 3.0
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
#: panels solved at most until one ends on the event, and the error over the tolerance given to one that does not
_CUTS, _HOPELESS = 8, 10.0
#: length, over the time so far and to come, of a regime that ends where it begins
_INSTANT = 1e-14
#: growth of panels beyond that by the last error, and what keeps an error from being 0
_FASTER, _TINY = 2.5, 1e-12
#: shrinkage, at least, of a panel that is rejected, and of the next ones
_LESS, _FAR_LESS = 0.7, 0.4
#: share of s, over rtol^(1/9), that the first panel from V = 0 on may rise to
_RISE = 0.5
#: share of the time until the drive changes in which its slope shows
_SOON = 1e-3
#: 1/zeta over T_mean below which V decays exponentially to rounding
_SLOWEST = 1e-17


@kernel
def _rise_time(s, clock, frame, case):
    """Time in which s rises from 0 to about this: its pace changes as the drive does."""
    soon, pace = _SOON * (piece_end(clock.piece, case) - clock.tau), case.work.nodes[S_RATE, 0]
    load = load_at(clock.tau + soon, clock.piece, frame, case)
    _, b = departing(load, frame.spin, case.scene)
    later = rates_at(0.0, b if b != 0.0 else case.work.nodes[SECOND, 0], load, frame, case.scene).s_rate
    pace, gain = max(pace, 0.0), (later - pace) / soon
    square = pace**2 + 2.0 * gain * s
    if square < 0.0:  # it does not rise so far, and falls from here on
        return -pace / gain
    # at b = 1 there may be neither
    return 2.0 * s / (pace + np.sqrt(square) + 1e-300)


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
        return _rise_time(_RISE * case.limits.rtol ** (1.0 / N), clock, frame, case)
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


@kernel
def _attempt(panel, left, aimed, slopes, track, frame, case):
    """(Event, v where the regime ends, panel, error of that over its tolerance, panel of the interpolants there are).

    Where a panel is too long for its tolerance and the regime ends on it, the law bends there: one that ends there may
    be good.
    """
    nodes, event, size, longest = case.work.nodes, NO_EVENT, np.inf, left
    for _ in range(_CUTS):
        if not solve(panel, slopes, track, frame, case):
            return NO_EVENT, 2.0, panel, np.inf, track
        size, track = panel_error(panel, slopes, frame, case), panel
        if not size <= _CUTTABLE:
            break
        found, v = first_event(case.work)
        behind = goes_behind(nodes)
        missed = passed_over(frame, case)
        if missed != NO_EVENT and panel.length <= _INSTANT * (panel.tau + left):
            return missed, 2.0, panel, min(size, 1.0), track
        if missed != NO_EVENT or (found == NO_EVENT and behind and not frame.slips):
            break
        if found != NO_EVENT:
            event = found
        elif event == NO_EVENT and aimed and size <= 1.0 and nodes[S, N] < _NEARLY * nodes[S, 0]:
            event = TURN
        if event == NO_EVENT or (found == NO_EVENT and ends_on(event, nodes, case.limits.rtol)):
            return event, 2.0, panel, size, track
        # partial slip does not go on beyond V = 0, and |V| in the edge and in the speeds of full slip has a kink there
        kinked = behind and (not frame.slips or found == EDGE or found == SLOW)
        if found != NO_EVENT and size <= 1.0 and not kinked and found != TURN:
            return event, v, panel, size, track
        if found == NO_EVENT:
            v = place_of(event, 0, case.work)
            if v >= NOWHERE:  # nowhere near
                return NO_EVENT, 2.0, panel, size, track
        length = min(panel.length * (0.5 * v) ** panel.power, longest)
        if not (size <= 1.0 or longest == left) or not 0.0 < length < np.inf or length == panel.length:
            return NO_EVENT, 2.0, panel, max(size, _HOPELESS), track
        longest = panel.length if found != NO_EVENT else longest
        panel = Panel(panel.tau, length, panel.power, panel.piece, panel.free)
    return NO_EVENT, 2.0, panel, max(size, _HOPELESS), track


@kernel
def _next_length(panel, size, rejected, last, last_size):
    """Length to try behind a panel with this error over its tolerance, the last good one before having had its own.

    Where a layer is left behind errors stay small although panels grow: they may as well grow faster.
    """
    length = next_length(panel.length, size, panel.power)
    if not size <= 1.0:
        return min(length, (_LESS if rejected == 0 else _FAR_LESS) * panel.length)
    if panel.power > 1 or last == 0.0:
        return length
    faster = panel.length / last * ((last_size + _TINY) / (size + _TINY)) ** (1.0 / N)
    return length * min(max(faster, 1.0), _FASTER)


@kernel
def _begin(state, frame, clock, case):
    """(Frame, slopes) with node 0 filled; from delta = 0 on the branch is that which b turns to."""
    nodes = case.work.nodes
    nodes[S, 0], nodes[SECOND, 0] = state.s, state.second
    slopes = put_node(0, 1.0, load_at(clock.tau, clock.piece, frame, case), frame, case)
    if not frame.slips and state.second == 0.0 and frame.sigma * nodes[RATE, 0] < 0.0:
        frame = Frame(False, frame.direction, -frame.sigma, frame.spin, frame.locked)
        slopes = put_node(0, 1.0, load_at(clock.tau, clock.piece, frame, case), frame, case)
    return frame, slopes


@kernel(inline=True)
def creeps(state, frame, case):
    """Whether V is so small that, where nothing drives, it decays exponentially to rounding."""
    return not frame.slips and 0.0 < state.s * case.scene.material.T_mean < _SLOWEST


@kernel
def phase(fresh, state, frame, clock, case):
    """Follow a regime: (event, state, frame, clock).  ``fresh``: the stick zone has just formed."""
    nodes, powers, limits = case.work.nodes, case.work.powers, case.limits
    end, length, rejected, last, last_size = piece_end(clock.piece, case), clock.length, 0, 0.0, 1.0
    power = _GRADED if fresh else 1
    track, coasts = Panel(clock.tau, 0.0, 1, clock.piece, False), undriven(clock.piece, case.drive)
    while clock.tau < end and clock.steps < limits.max_steps and not (coasts and creeps(state, frame, case)):
        frame, slopes = _begin(state, frame, clock, case)
        if length == 0.0:
            length = max(_first_length(fresh, slopes, clock, frame, case), _INSTANT * clock.tau)
        left = end - clock.tau
        panel = Panel(clock.tau, min(length, left), power, clock.piece, frame.slips or slopes.weight > _NO_SPEED)
        zero = _pace_to_zero(panel, state, frame, case)
        aimed = zero < panel.length and rejected == 0
        if zero < panel.length:
            panel = Panel(panel.tau, zero, power, panel.piece, panel.free)
        event, v, panel, size, track = _attempt(panel, left, aimed, slopes, track, frame, case)
        wanted, length = length, _next_length(panel, size, rejected, last, last_size)
        length = max(length, wanted) if size <= 1.0 and panel.length == left else length
        clock = Clock(clock.tau, clock.at, clock.piece, clock.steps + 1, clock.ends, length)
        rejected += 1
        if not size <= 1.0:
            if rejected > _MOST_REJECTIONS or not clock.tau + length > clock.tau:
                return STUCK, state, frame, clock
            continue
        whole = v == 2.0 and panel.length == left
        clock = pass_panel(
            end if whole else panel.tau + panel.length * (0.5 * v) ** power, v, panel, frame, clock, case
        )
        state = State(nodes[S, N], nodes[SECOND, N])
        if v < 2.0:
            state = State(nodes[S, 0] + rise_at(v, powers, OF_S), nodes[SECOND, 0] + rise_at(v, powers, OF_SECOND))
        if event != NO_EVENT:
            return event, state, frame, clock
        power, rejected, last, last_size = 1, 0, panel.length, size
    return NO_EVENT, state, frame, clock
