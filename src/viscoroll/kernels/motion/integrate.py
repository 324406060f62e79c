"""A motion, free or driven, from start to end: one regime after the other, one piece of the drive after the other.

A regime changes only at a located event, or where the drive jumps and the cylinder is at rest or held by its brake.
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_reference
from ..compile.jit import kernel
from .load import brakes, goes_on, piece_end, threshold, undriven, unloaded
from .nodes import ONSET, PATHS, REST_TIME, TOTALS, TURNS
from .origin import EITHER, SLIDES, STAYS, STICKS, depart, leaving_time
from .output import coast, note, put_here, put_still, regime_of
from .phase import creeps, phase
from .rates import creep_at, creep_limit, inertia_at, room, sliding, speeds
from .records import (
    DONE,
    EDGE,
    HELD,
    KINK,
    NEITHER,
    NO_EVENT,
    REST,
    RESTED,
    REVERSED,
    SLOW,
    STEP_LIMIT,
    STEP_TOO_SMALL,
    STUCK,
    UNDECIDED,
    UNSTEADY,
    Clock,
    Frame,
    State,
)  # fmt: skip
from .switch import at_new_piece, here, switch, turned

#: speed over the larger one below which V counts as 0 at the start
_TINY = 1e-150
#: distance from the edge of the stick zone, over the speeds, that is rounding
_ON_EDGE = 2e-14
#: time of relaxation over the time so far that no panel can follow
_ROUNDING = 1e-13
#: speeds that count as 0 where something drives, or will
_STILL = 1e-75
#: length of the panel behind that, over the time so far
_SETTLING = 1e-11


@kernel
def enter(V, omega, clock, case):
    """The regime of a start with V or omega not 0, but for its brake: (state, frame, whether stick just forms)."""
    if undriven(0, case.drive) and max(abs(V), abs(omega)) < _TINY:
        # sliding ends within a time of that order: V + j omega is kept
        V = omega = (V + case.scene.j * omega) / (1.0 + case.scene.j)
    direction = 1.0 if V > 0.0 or (V == 0.0 and omega >= 0.0) else -1.0
    V, omega = direction * V, direction * omega
    slip, limit = sliding(omega - V, V, case.scene), creep_limit(V, case.scene) * V
    sigma = 1.0 if slip >= 0.0 else -1.0
    state, frame = State(V, omega), Frame(True, direction, sigma, 0.0, False)
    if V == 0.0:
        if here(state, frame, clock, case)[1].V_rate < 0.0:  # the frame is that which V turns to
            state, frame = turned(state, frame)
        return state, frame, False
    on_edge = abs(abs(slip) - limit) <= _ON_EDGE * max(V, abs(omega))
    inside, stick = State(V, sigma if on_edge else slip / limit), Frame(False, direction, sigma, 0.0, False)
    if on_edge:
        on_edge = sigma * here(inside, stick, clock, case)[1].rate < 0.0
    elif abs(slip) < limit:
        return inside, stick, False
    return (inside, stick, True) if on_edge else (state, frame, False)


@kernel
def _still_regime(clock, case):
    """The regime of V = omega = 0."""
    braked = brakes(clock.piece, case.drive.pieces)
    return HELD if braked or case.drive.prescribed != NEITHER else REST


@kernel
def stay(clock, case):
    """At V = omega = 0: (how, state, frame, clock) once the cylinder departs, or the piece of the drive ends."""
    kind, frame, d = depart(clock.tau, clock.piece, case)
    if kind == STICKS or kind == SLIDES:
        return kind, State(0.0, d), frame, clock_at(0.0, clock)
    until = leaving_time(clock.tau, clock.piece, case) if kind == STAYS else clock.tau
    closed = kind == EITHER or until == case.tau[case.tau.size - 1]
    return kind, State(0.0, 0.0), frame, put_still(until, closed, _still_regime(clock, case), clock, case)


@kernel(inline=True)
def clock_at(length, clock):
    """The same clock, with this length to try."""
    return Clock(clock.tau, clock.at, clock.piece, clock.steps, clock.ends, length)


@kernel
def coasts(state, frame, clock, case):
    """Whether at most gains drive any more, and V decays exponentially to rounding."""
    return creeps(state, frame, case) and unloaded(clock.piece, case.drive)


@kernel
def rests(moving, state, frame, clock, case):
    """Whether nothing drives any more and both speeds are below the threshold."""
    rest = threshold(clock.piece, case)
    if rest == 0.0 or not moving:
        return rest > 0.0
    return max(abs(state.V), abs(speeds(state, frame, case.scene)[0])) <= rest


@kernel
def spent(event, state, frame, case):
    """Whether the added mass is beyond its range, or this event is that it has come to the end of it."""
    left = room(inertia_at(state.V, case.scene)[0], case.scene.j)
    at_end = event == EDGE and left < 1.0 - frame.sigma * state.second
    return not frame.slips and (left <= 0.0 or at_end)


@kernel
def unresolved(state, frame, clock, case):
    """Whether d relaxes within the rounding of time: then it may as well have come to where it does."""
    if frame.slips:
        return False
    _, rates = here(state, frame, clock, case)
    return state.V < _ROUNDING * clock.tau * max(abs(rates.rate_second), abs(rates.rate))


@kernel
def vanishes(state, frame, clock, case):
    """Whether V falls to 0 within the rounding of time, or stands for 0 where something drives."""
    if state.V <= _STILL and not undriven(clock.piece, case.drive):
        return True
    return state.V < -_ROUNDING * clock.tau * here(state, frame, clock, case)[1].V_rate


@kernel
def settled(state, frame, clock, case):
    """(Whether V is left, state, frame, clock) once d has relaxed at a time: p stays as it is."""
    if vanishes(state, frame, clock, case):
        return False, state, frame, clock
    load, rates = here(state, frame, clock, case)
    n = inertia_at(state.V, case.scene)[0]
    inertia = load.per_omega + load.per_V * load.per_omega * n
    p, d, low, high = inertia * state.V + load.per_V * rates.omega, 0.0, -1.0, 1.0
    while low < d < high:
        delta = creep_at(state.V, d, case.scene)
        state = State(p / (inertia + load.per_V * (1.0 + delta)), d)
        frame = Frame(False, frame.direction, 1.0 if d >= 0.0 else -1.0, frame.spin, frame.locked)
        if here(state, frame, clock, case)[1].rate > 0.0:
            low = d
        else:
            high = d
        d = 0.5 * (low + high)
    clock = clock_at(_SETTLING * clock.tau, clock)
    if low > -1.0 and high < 1.0:
        return True, state, frame, clock
    omega = state.V * (1.0 + creep_at(state.V, frame.sigma, case.scene))
    return True, State(state.V, omega), Frame(True, frame.direction, frame.sigma, frame.spin, frame.locked), clock


@kernel
def next_piece(moving, state, frame, clock, case):
    """(Whether the cylinder moves, state, frame, clock) where a piece of the drive ends and there is a next one."""
    pieces = case.drive.pieces
    if clock.tau < piece_end(clock.piece, case) or clock.piece + 1 == pieces.shape[0]:
        return moving, state, frame, clock
    length = clock.length if goes_on(clock.piece, pieces) else 0.0
    clock = Clock(clock.tau, clock.at, clock.piece + 1, clock.steps, clock.ends, length)
    if moving:
        state, frame = at_new_piece(state, frame, clock, case)
        # in partial slip omega is 0 where V is
        moving = state.V != 0.0 or (frame.slips and state.second != 0.0)
    return moving, state, frame, clock


@kernel
def come_to_rest(regime, state, frame, clock, case):
    """The clock at the end of a motion that comes below the threshold of rest now."""
    nodes, omega = case.nodes, speeds(state, frame, case.scene)[0]
    if regime >= 0 and regime != REST:
        note(REST, clock, case)
    nodes[REST_TIME] = clock.tau / case.scene.gamma
    nodes[TOTALS + PATHS - 1] += 0.5 * (state.V * state.V + case.scene.j * omega * omega)
    return put_still(case.tau[case.tau.size - 1], True, REST, clock, case)


@kernel
def follow(moving, fresh, state, frame, clock, case):
    """From phase to phase until outputs end: (status, clock)."""
    event, settled_at, nodes, regime = NO_EVENT, -1.0, case.nodes, regime_of(frame) if moving else -1
    while clock.at < case.tau.size:
        if clock.steps >= case.limits.max_steps:
            return STEP_LIMIT, clock
        direction = frame.direction
        moving, state, frame, clock = next_piece(moving, state, frame, clock, case)
        if frame.direction != direction:
            note(REVERSED, clock, case)
        if moving and spent(event, state, frame, case):
            return UNSTEADY, put_here(state, frame, clock, case)
        event, direction, before = NO_EVENT, frame.direction, clock
        if rests(moving, state, frame, clock, case):
            event = SLOW
        elif not moving:
            kind, state, frame, clock = stay(clock, case)
            if kind == EITHER:
                return UNDECIDED, clock
            moving = kind != STAYS
        elif clock.tau >= case.tau[case.tau.size - 1]:
            clock = put_here(state, frame, clock, case)
        elif coasts(state, frame, clock, case):
            return coast(state, frame, clock, case)
        else:
            event, state, frame, clock = phase(fresh, state, frame, clock, case)
        if event == SLOW:
            return RESTED, come_to_rest(regime, state, frame, clock, case)
        fresh = event == EDGE and frame.slips
        if event == STUCK:
            if clock.tau <= settled_at or not unresolved(state, frame, clock, case):
                return STEP_TOO_SMALL, clock
            settled_at = clock.tau
            moving, state, frame, clock = settled(state, frame, clock, case)
            continue
        if event != NO_EVENT and not spent(event, state, frame, case):
            moving, state, frame = switch(event, state, frame, clock, case)
            clock = clock_at(clock.length if event == KINK else 0.0, clock)
        if moving and regime >= 0 and frame.direction != direction:
            note(REVERSED, clock, case)
        now = regime_of(frame) if moving else _still_regime(clock, case)
        if now != regime and (moving or event == NO_EVENT):
            if regime >= 0:
                note(now, clock if moving else before, case)
            if fresh and np.isnan(nodes[ONSET]):
                nodes[ONSET] = clock.tau / case.scene.gamma
            regime = now
    return DONE, clock


@kernel
def integrate(V0, omega0, given):
    """Roll one motion from t = 0 to the last of its times: (status, steps, switches, onset time, rest time)."""
    case = by_reference(given)
    nodes, clock = case.nodes, Clock(0.0, 0, 0, 0, 0, 0.0)
    nodes[ONSET] = nodes[REST_TIME] = np.nan
    state, frame, fresh = State(0.0, 0.0), Frame(False, 1.0, 1.0, 0.0, False), False
    fastest = max(abs(V0), abs(omega0))
    moving = fastest >= _STILL or (fastest > 0.0 and undriven(0, case.drive))
    if moving:
        state, frame, fresh = enter(V0 if abs(V0) > _TINY * abs(omega0) else 0.0, omega0, clock, case)
        state, frame = at_new_piece(state, frame, clock, case)
    status, clock = follow(moving, fresh, state, frame, clock, case)
    return status, clock.steps, nodes[TURNS], nodes[ONSET], nodes[REST_TIME]
