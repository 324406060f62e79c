"""One regime, panel after panel, to an event or to the end of a piece of the drive."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..rows.record import ALPHA, E0
from .collocation import N, rise_at
from .events import NOWHERE, ends_on, first_event, located, passed_over, place_of
from .load import constant, load_at, piece_end, rounding, undriven, unloaded
from .nodes import (
    DIAGONAL,
    OF_SECOND,
    OF_V,
    P_RATE,
    PER_P,
    RATE,
    SECOND,
    SLOPE,
    SPEED,
    V_RATE,
    P,
    Panel,
    V,
    cut,
    extremes,
    put_events,
    put_node,
)
from .origin import departing
from .output import pass_panel
from .rates import last_pulls, rates_of
from .records import EDGE, NO_EVENT, SLOW, STUCK, TURN, Clock, Frame, State
from .records import SPEED as VELOCITY
from .solve import panel_error, solve
from .steady import nearness, stay_steady

#: first panel: share of what the unknowns may change by, and time over that of relaxation
_FIRST, _RELAXED = 0.4, 3.0
#: behind the onset of stick the law bends: how far d may go on the first panel there, over what slip feeds back by
_BEND = 12.0
#: unit of rounding
_ROUNDING = 2.2e-16
#: distance from an equilibrium of V over that up to which a motion has come to it, below which this is looked at
_NEARLY_STEADY = 2.0
#: panels rejected in a row
_MOST_REJECTIONS = 60
#: error over the tolerance up to which a panel is taken where a shorter one could not be told from none: the error of a
#: motion grows by 2 to 3 rtol at most
_SHORTEST = 10.0
#: V at the end of a panel, over that at its start, from which on V = 0 is sought
_NEARLY = 0.2
#: V that stands for 0
NO_SPEED = 1e-200
#: octaves from the first row of a law to the rate of its longest time
_ROWS_BELOW = 4
#: error over the tolerance up to which a panel shows where its regime ends
_CUTTABLE = 1e6
#: panels solved at most until one ends on the event, and the error over the tolerance given to one that does not
_CUTS, _HOPELESS = 8, 10.0
#: v up to which a place in full slip is found anew, on a panel that ends a little behind it: early on interpolants are
#: off by more beside the time so far
_EARLY, _BEHIND_IT = 0.5, 1.1
#: length, over the time so far and to come, of a regime that ends where it begins
_INSTANT = 1e-14
#: share of the way to the end of a piece beyond which a prescribed V that comes to 0 does so at that end: where it goes
#: from there the next piece knows
_BEFORE_END = 1.0 - 1e-13
#: growth of panels beyond that by the last error, and what keeps an error from being 0
_FASTER, _TINY = 1.3, 1e-12
#: shrinkage, at least, of a panel that is rejected, and of the next ones
_LESS, _FAR_LESS = 0.7, 0.4
#: share of the speed that divides slow from fast rolling, over rtol^(1/7), that the first panel from V = 0 on may rise
#: to
_RISE = 0.25
#: share of the time until the drive changes in which its slope shows
_SOON = 1e-3
#: relaxation times behind which d follows V, and what V may then change by, over rtol^(1/8)
_OVER, _SLOW = 6.0, 4.0
#: growth and shrinkage of panels
_GROW, _SHRINK, _FAILED, _SAFETY = 6.0, 0.1, 0.3, 0.9
#: V over the speed that divides slow from fast rolling, and |d|, both over rtol, below which V decays exponentially
_SLOWEST, _SETTLED = 1e-4, 1e-2


@kernel(inline=True)
def moderate_speed(scene):
    """V that divides slow from fast rolling: 1/kappa over the longest time of the material, or half of that."""
    return 2.0 ** (scene.law.marks[E0] + _ROWS_BELOW) / scene.kappa


@kernel
def _rise_time(rise, clock, frame, case):
    """Time in which V rises from 0 to about this: its pace changes as the drive does."""
    soon, pace = _SOON * (piece_end(clock.piece, case) - clock.tau), case.nodes[V_RATE]
    load = load_at(clock.tau + soon, clock.piece, frame, case)
    _, d = departing(load, frame.spin, case.scene)
    later = rates_of(State(0.0, d if d != 0.0 else case.nodes[SECOND]), load, frame, case.scene)
    pace, gain = max(pace, 0.0), (later.p_rate / later.p_V - pace) / soon
    square = pace**2 + 2.0 * gain * rise
    if square < 0.0:  # it does not rise so far, and falls from here on
        return -pace / gain
    # at d = 1 there may be neither
    return 2.0 * rise / (pace + np.sqrt(square) + 1e-300)


@kernel
def _first_length(fresh, clock, frame, case):
    """Length to try first."""
    nodes, scene = case.nodes, case.scene
    speed, fastest, pace, rate = nodes[V], nodes[SPEED], abs(nodes[V_RATE]), abs(nodes[RATE])
    if frame.slips:
        length = _FIRST * fastest / max(pace, rate) if fastest > 0.0 and max(pace, rate) > 0.0 else np.inf
        return min(length, (speed + moderate_speed(scene)) / pace) if pace > 0.0 and fastest > 0.0 else length
    if not speed > NO_SPEED:  # from V = 0 on
        return _rise_time(_RISE * case.limits.rtol ** (1.0 / N) * moderate_speed(scene), clock, frame, case)
    length = _RELAXED / abs(nodes[SLOPE])
    if fresh:
        # as far as d may go until what is left of slip feeds back on it
        load = load_at(clock.tau, clock.piece, frame, case)
        feeds = scene.kappa * max(load.per_V + load.per_omega, 1.0)
        near = (case.limits.rtol * rate / (feeds * scene.law.rows[ALPHA])) ** (1.0 / 3.0)
        return min(length, _BEND * near * speed / max(rate, 1e-300), speed / (4.0 * feeds))
    return min(length, _FIRST * speed / pace) if pace > 0.0 else length


@kernel(inline=True)
def _pace_to_zero(panel, state, frame, case):
    """Time until V = 0 at the pace at the start: there the law bends, and that of partial slip ends.

    In partial slip V only comes to 0 against the drive.
    """
    pace = case.nodes[V_RATE]
    if not pace < 0.0:
        return np.inf
    if frame.slips:
        return -state.V / pace
    load = load_at(panel.tau, panel.piece, frame, case)
    against = load.V_rate + load.omega_rate
    if against > 0.0 or (against == 0.0 and load.force + load.torque >= 0.0):
        return np.inf
    return -state.V / pace


@kernel(inline=True)
def _attempt(panel, left, aimed, track, frame, case):
    """(Event, v where the regime ends, panel, error of that over its tolerance, panel of the interpolants there are).

    Where a panel is too long for its tolerance and the regime ends on it, the law bends there: one that ends there may
    be good.
    """
    nodes, event, size, longest = case.nodes, NO_EVENT, np.inf, left
    for _ in range(_CUTS):
        if not solve(panel, nodes[SLOPE], track, frame, case):
            return NO_EVENT, 2.0, panel, np.inf, track
        size, track = panel_error(panel, frame, case), panel
        if not size <= _CUTTABLE:
            break
        put_events(panel, frame, case)
        found, v = first_event(panel, frame, case)
        if found == TURN and v > 2.0 * _BEFORE_END and panel.length == left and case.drive.prescribed == VELOCITY:
            found = NO_EVENT
        # in partial slip there is no motion behind V = 0, and none that goes on from there
        behind = extremes(V, nodes)[0] < 0.0
        missed = passed_over(panel, frame, case)
        if missed != NO_EVENT and panel.length <= _INSTANT * (panel.tau + left):
            return missed, 2.0, panel, min(size, 1.0), track
        if missed != NO_EVENT or (found == NO_EVENT and behind and not frame.slips):
            break
        if found != NO_EVENT:
            event = found
        elif event == NO_EVENT and aimed and size <= 1.0 and nodes[V + N] < _NEARLY * nodes[V]:
            event = TURN
        if event == NO_EVENT or (found == NO_EVENT and ends_on(event, nodes, case.limits.rtol)):
            return event, 2.0, panel, size, track
        # partial slip does not go on beyond V = 0, and |V| in the edge and in the speeds of full slip has a kink there
        kinked = behind and (not frame.slips or found == EDGE or found == SLOW)
        if found != NO_EVENT and size <= 1.0 and not kinked and found != TURN:
            if v > _EARLY or not frame.slips:
                return event, located(event, v, frame, case), panel, size, track
            v *= _BEHIND_IT
        if found == NO_EVENT:
            v = place_of(event, 0, nodes)
            if v >= NOWHERE:  # nowhere near
                return NO_EVENT, 2.0, panel, size, track
        length = min(panel.length * 0.5 * v, longest)
        if not (size <= 1.0 or longest == left) or not 0.0 < length < np.inf or length == panel.length:
            return NO_EVENT, 2.0, panel, max(size, _HOPELESS), track
        longest = panel.length if found != NO_EVENT else longest
        panel = cut(panel, length)
    return NO_EVENT, 2.0, panel, max(size, _HOPELESS), track


@kernel(inline=True)
def _slow_length(panel, frame, case):
    """Length to try behind a panel along which d has relaxed: from there on it follows V, which changes slowly."""
    nodes = case.nodes
    if frame.slips or not nodes[SLOPE + N] * panel.length < -_OVER:
        return 0.0
    pace = max(abs(nodes[P_RATE + N] * nodes[PER_P + N] / nodes[V + N]), abs(2.0 * nodes[DIAGONAL + N] / panel.length))
    return _SLOW * case.limits.rtol ** (1.0 / (N + 1)) / pace


@kernel(inline=True)
def _next_length(panel, size, rejected, last, last_size):
    """Length to try behind a panel with this error over its tolerance, the last good one before having had its own.

    Where a layer is left behind errors stay small although panels grow: they may as well grow faster.
    """
    length = _FAILED * panel.length
    if size < 1e300:
        length = panel.length * max(_SHRINK, min(_GROW, _SAFETY * (size + 1e-30) ** (-1.0 / N)))
    if not size <= 1.0:
        return min(length, (_LESS if rejected == 0 else _FAR_LESS) * panel.length)
    if last == 0.0:
        return length
    faster = panel.length / last * ((last_size + _TINY) / (size + _TINY)) ** (1.0 / N)
    return length * min(max(faster, 1.0), _FASTER)


@kernel(inline=True)
def _begin(state, frame, clock, case):
    """The frame with node 0 filled; from delta = 0 on the branch is that which d turns to."""
    nodes = case.nodes
    nodes[V], nodes[SECOND] = state.V, state.second
    rates = rates_of(state, load_at(clock.tau, clock.piece, frame, case), frame, case.scene)
    put_node(0, rates, nodes)
    # at V = 0 d stands where it relaxes to, and Q is what rounding leaves of it
    nodes[V_RATE] = rates.V_rate if state.V > 0.0 else rates.p_rate / rates.p_V
    nodes[SLOPE], nodes[DIAGONAL] = rates.rate_second / rates.weight, rates.p_rate_V / rates.p_V
    if not frame.slips and state.second == 0.0 and frame.sigma * rates.rate < 0.0:
        # both branches say the same here
        return Frame(False, frame.direction, -frame.sigma, frame.spin, frame.locked)
    return frame


@kernel(inline=True)
def creeps(state, frame, case):
    """Whether V is so small that, under no load but by gains, it decays exponentially to a share of the tolerance."""
    rtol = case.limits.rtol
    if frame.slips or not 0.0 < state.V < _SLOWEST * rtol * moderate_speed(case.scene):
        return False
    half_space, cylinder, force, torque = last_pulls(case)
    return half_space + cylinder > force + torque and abs(state.second) < _SETTLED * rtol


@kernel(inline=True)
def _slows(noise, case):
    """Whether V at node 0 may be at its equilibrium, by the slope of p' over V alone; ``noise`` as in
    :func:`stay_steady`."""
    nodes = case.nodes
    # p is about its slope over V times V
    return abs(nodes[P_RATE]) - noise <= -_NEARLY_STEADY * nearness(case.limits.rtol) * nodes[DIAGONAL] * abs(nodes[P])


@kernel
def phase(fresh, state, frame, clock, case):
    """Follow a regime: (event, state, frame, clock).  ``fresh``: the stick zone has just formed."""
    nodes, limits = case.nodes, case.limits
    end, length, rejected, last, last_size = piece_end(clock.piece, case), clock.length, 0, 0.0, 1.0
    length = max(length, _INSTANT * clock.tau) if length > 0.0 else length
    alone, free = undriven(clock.piece, case.drive), unloaded(clock.piece, case.drive)
    lasting, noise = not free and constant(clock.piece, case.drive.pieces), 0.0
    if lasting:
        # of p', which in full slip holds Q = mu
        noise = rounding(clock.piece, case.drive.pieces) + (_ROUNDING * case.scene.mu if frame.slips else 0.0)
    track = Panel(clock.tau, 0.0, clock.piece, False, alone)
    while clock.tau < end and clock.steps < limits.max_steps and not (free and creeps(state, frame, case)):
        frame = _begin(state, frame, clock, case)
        if lasting and _slows(noise, case):
            steady, state, clock = stay_steady(end, noise, state, frame, clock, case)
            if steady:
                return NO_EVENT, state, frame, clock
        if length == 0.0:
            length = max(_first_length(fresh, clock, frame, case), _INSTANT * clock.tau)
        left = end - clock.tau
        panel = Panel(clock.tau, min(length, left), clock.piece, frame.slips or state.V > NO_SPEED, alone)
        zero = _pace_to_zero(panel, state, frame, case)
        if zero > _BEFORE_END * left and case.drive.prescribed == VELOCITY:
            zero = np.inf
        aimed = zero <= panel.length and rejected == 0
        if zero < panel.length:
            panel = cut(panel, zero)
        event, v, panel, size, track = _attempt(panel, left, aimed, track, frame, case)
        wanted, length = length, _next_length(panel, size, rejected, last, last_size)
        length = max(length, wanted) if size <= 1.0 and panel.length == left else length
        clock = Clock(clock.tau, clock.at, clock.piece, clock.steps + 1, clock.ends, length)
        rejected += 1
        if not size <= 1.0:
            if rejected <= _MOST_REJECTIONS and clock.tau + length > clock.tau:
                continue
            if not size <= _SHORTEST:
                return STUCK, state, frame, clock
            length = panel.length
        whole = v == 2.0 and panel.length == left
        clock = pass_panel(end if whole else panel.tau + panel.length * 0.5 * v, v, panel, frame, clock, case)
        state = State(nodes[V + N], nodes[SECOND + N])
        if v < 2.0:
            state = State(nodes[V] + rise_at(v, nodes, OF_V), nodes[SECOND] + rise_at(v, nodes, OF_SECOND))
        if event != NO_EVENT:
            return event, state, frame, clock
        length = max(length, _slow_length(panel, frame, case))
        rejected, last, last_size = 0, panel.length, size
    return NO_EVENT, state, frame, clock
