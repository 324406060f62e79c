"""A driven motion from start to end: one regime after the other, one piece of the drive after the other.

A regime changes only at a located event, or where the drive jumps and the cylinder is at rest or held by its brake.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import OK, contact_length
from ..law.stick import stick_length
from ..material.functions import generators
from ..motion.collocation import N
from ..motion.integrate import DONE, NOT_CONVERGED, RESTED, STEP_LIMIT, STEP_TOO_SMALL
from ..motion.records import REST
from .load import acting, brakes, goes_on, load_at, piece_end, risen_by, undriven
from .nodes import INTERPOLANTS, PATHS, ROWS, S
from .nodes import SPEED as FASTEST
from .origin import STAYS, STICKS, depart, leaving_time
from .output import coast, put_still, put_to_end, regime_of
from .phase import phase
from .rates import rates_at
from .records import (
    EDGE,
    HELD,
    KINK,
    NEITHER,
    NO_EVENT,
    REVERSED,
    SLOW,
    SPEED,
    STOP,
    STUCK,
    TURN,
    Case,
    Clock,
    Frame,
    Notes,
    State,
    Work,
)  # fmt: skip

#: speed over the larger one below which V counts as 0 at the start
_TINY = 1e-150
#: 1/zeta at the end of a panel, over that at its start, below which V is 0 there
_CLOSED = 1e-7
#: what rounding leaves of a prescribed speed that has come to 0, over what it has changed by
_DRIFT = 1e-12
#: what an event may be off by, over rtol
_OFF = 10.0
#: time of relaxation over the time so far that no panel can follow
_ROUNDING = 1e-13
#: share of the length of panels that is kept where the law bends at delta = 0
_PAST = 0.3
#: 1/zeta over T_mean below which V decays exponentially to rounding
_SLOWEST = 1e-17


@kernel
def _here(state, frame, clock, case):
    """(The drive, what the equations say) at a state."""
    load = load_at(clock.tau, clock.piece, frame, case)
    return load, rates_at(state.s, state.second, load, frame, case.scene)


@kernel
def _excess(state, frame, clock, case):
    """(Torque that would turn a wheel held at omega = 0, the most that the brake can take of it)."""
    load, rates = _here(state, frame, clock, case)
    _, torque, _ = acting(rates.V, 0.0, load, frame)
    return torque - rates.Q - rates.M_cylinder, load.brake


@kernel
def enter(V, omega, clock, case):
    """The regime of a start with V or omega not 0, but for its brake: (state, frame, status)."""
    scene = case.scene
    material, kappa, mu, _ = scene
    direction = 1.0 if V > 0.0 or (V == 0.0 and omega >= 0.0) else -1.0
    V, omega = direction * V, direction * omega
    slip, s, limit = omega - V, 0.0, 0.0
    sigma = 1.0 if slip >= 0.0 else -1.0
    if V > 0.0:
        lam, _ = contact_length(kappa * V, material)
        s = 2.0 * kappa * V / lam
        g, _ = generators(1.0 / s, material)
        limit = 0.5 * mu * lam * (1.0 + g * s) / kappa * V
    frame = Frame(True, direction, sigma, 0.0, False)
    if V == 0.0 or abs(slip) >= limit:
        # at V = 0 the frame is that which V turns to
        if V == 0.0 and _here(State(s, omega), frame, clock, case)[1].s_rate < 0.0:
            direction, omega, sigma = -direction, -omega, -sigma
        return State(s, omega), Frame(True, direction, sigma, 0.0, False), OK
    zeta = 1.0 / s
    _, D, status = stick_length(zeta, abs(slip) / V / (mu * V), material)
    return State(s, sigma * (D * s)), Frame(False, direction, sigma, 0.0, False), status


@kernel
def locks(state, frame, clock, case):
    """Whether the brake holds omega, which has just become 0."""
    excess, most = _excess(state, frame, clock, case)
    return abs(excess) <= most


@kernel
def released(state, frame, clock, case):
    """The frame once a brake that held omega lets go, or the sign of omega changes under it."""
    excess, _ = _excess(state, frame, clock, case)
    spin = np.sign(excess) if brakes(clock.piece, case.drive.pieces) else 0.0
    return Frame(frame.slips, frame.direction, frame.sigma, spin, False)


@kernel
def closed(state, locked, case):
    """Whether the stick band closes at V = 0, where omega is 0 too."""
    nodes = case.work.nodes
    if not locked:
        return state.s <= _CLOSED * nodes[S, 0]
    largest = 0.0  # slip with omega = 0 ends with V, which is 0 but for the tolerance
    for i in range(N + 1):
        largest = max(largest, nodes[S, i])
    return state.s <= max(_CLOSED, _OFF * case.limits.rtol) * largest


@kernel
def drift(fastest, clock, case):
    """What the integration of a prescribed speed may leave of it where it has come to 0."""
    return (case.limits.rtol + _DRIFT) * max(fastest, risen_by(clock.piece, case.drive.pieces))


@kernel
def turned(state, frame):
    """Full slip at V = 0 as seen in the other direction."""
    slips, direction, sigma, spin, locked = frame
    return State(0.0, -state.second), Frame(slips, -direction, -sigma, -spin, locked)


@kernel
def stands(state, frame, clock, case):
    """Whether V and omega, one of them prescribed, are 0 but for what the integration of that one leaves."""
    if case.drive.prescribed == NEITHER:
        return False
    rates, fastest = _here(state, frame, clock, case)[1], 0.0
    for i in range(N + 1):
        fastest = max(fastest, case.work.nodes[FASTEST, i])
    return max(abs(rates.V), abs(rates.omega)) <= drift(fastest, clock, case)


@kernel
def switch(event, state, frame, clock, case):
    """(State, frame, whether V = omega = 0) behind an event that changes the regime."""
    slips, direction, sigma, spin, locked = frame
    if slips and stands(state, frame, clock, case):
        return state, frame, True
    if event == EDGE and slips:
        if closed(state, locked, case):
            return state, frame, True
        return State(state.s, sigma), Frame(False, direction, sigma, spin, locked), False
    if event == EDGE:
        omega = _here(state, frame, clock, case)[1].omega
        return State(state.s, omega), Frame(True, direction, sigma, spin, locked), False
    if event == KINK:
        return State(state.s, 0.0), Frame(False, direction, -sigma, spin, locked), False
    if event == TURN:
        if not slips or state.second == 0.0:
            return state, frame, True
        state, frame = turned(state, frame)
        return state, frame, False
    if event == STOP:
        still = State(state.s, 0.0) if slips else state
        if locks(still, frame, clock, case):
            return still, Frame(slips, direction, sigma, spin, True), False
        return still, released(still, frame, clock, case), False
    return state, released(state, frame, clock, case), False


@kernel
def _still_regime(clock, case):
    """The regime of V = omega = 0."""
    braked = brakes(clock.piece, case.drive.pieces)
    return HELD if braked or case.drive.prescribed != NEITHER else REST


@kernel
def stay(clock, case):
    """At V = omega = 0: (state, frame, clock) once the cylinder departs, or the piece of the drive ends."""
    state = State(0.0, 0.0)
    kind, frame, b = depart(clock.tau, clock.piece, case)
    if kind == STAYS:
        until = leaving_time(clock.tau, clock.piece, case)
        closed = until == case.tau[case.tau.size - 1]
        clock = put_still(until, closed, _still_regime(clock, case), clock, case)
        return False, state, frame, clock
    clock = Clock(clock.tau, clock.at, clock.piece, clock.steps, clock.ends, 0.0)
    return True, State(0.0, b if kind == STICKS else 0.0), frame, clock


@kernel
def note(what, noted, clock, case):
    """Note a change of regime or of the sign of V; how many there were."""
    switches = case.notes.switches
    if noted < switches.shape[0]:
        switches[noted, 0], switches[noted, 1] = clock.tau / case.gamma, what
    return noted + 1


@kernel
def setting_out(state, frame, clock, case):
    """(State, frame) of full slip where a piece of the drive begins: seen from where V goes if it is 0."""
    _, rates = _here(state, frame, clock, case)
    if case.drive.prescribed == SPEED and abs(rates.V) <= drift(0.0, clock, case):
        state = State(0.0, state.second)
        _, rates = _here(state, frame, clock, case)
    return turned(state, frame) if state.s == 0.0 and rates.s_rate < 0.0 else (state, frame)


@kernel
def at_new_piece(state, frame, clock, case):
    """(State, frame) where a piece of the drive begins: brakes take hold or let go, V may turn."""
    if frame.slips:
        state, frame = setting_out(state, frame, clock, case)
    slips, direction, sigma, spin, locked = frame
    braked, omega = brakes(clock.piece, case.drive.pieces), _here(state, frame, clock, case)[1].omega
    if locked or omega == 0.0:
        if braked and locks(state, frame, clock, case):
            return state, Frame(slips, direction, sigma, spin, True)
        return state, released(state, frame, clock, case)
    return state, Frame(slips, direction, sigma, np.sign(omega) if braked else 0.0, False)


@kernel
def coasts(state, frame, clock, case):
    """Whether nothing drives any more, and V decays exponentially to rounding."""
    T_mean = case.scene.material.T_mean
    return not frame.slips and 0.0 < state.s * T_mean < _SLOWEST and undriven(clock.piece, case.drive)


@kernel
def unresolved(state, frame, clock, case):
    """Whether V is so small that b relaxes within the rounding of time: then it may as well be 0."""
    if frame.slips:
        return False
    _, rates = _here(state, frame, clock, case)
    return rates.weight < _ROUNDING * clock.tau * abs(rates.rate_slope)


@kernel
def follow(moving, state, frame, clock, case):
    """From phase to phase until outputs end: (status, clock, changes of regime, onset time, rest time)."""
    onset_time, turns, noted, fresh = np.nan, 0, 0, False
    regime, end = regime_of(frame) if moving else -1, case.tau[case.tau.size - 1]
    while clock.at < case.tau.size:
        if clock.steps >= case.limits.max_steps:
            return STEP_LIMIT, clock, turns, onset_time, np.nan
        if clock.tau >= piece_end(clock.piece, case) and clock.piece + 1 < case.drive.pieces.shape[0]:
            length = clock.length if goes_on(clock.piece, case.drive.pieces) else 0.0
            clock = Clock(clock.tau, clock.at, clock.piece + 1, clock.steps, clock.ends, length)
            if moving:
                state, frame = at_new_piece(state, frame, clock, case)
                moving = not frame.slips or state.s != 0.0 or state.second != 0.0
        event, direction, before = NO_EVENT, frame.direction, clock
        if moving and clock.tau >= end:
            clock = put_to_end(state, frame, clock, case)
        elif not moving:
            moving, state, frame, clock = stay(clock, case)
        elif coasts(state, frame, clock, case):
            clock, rest_time = coast(state, frame, clock, case)
            return DONE if np.isnan(rest_time) else RESTED, clock, turns, onset_time, rest_time
        else:
            event, state, frame, clock = phase(fresh, state, frame, clock, case)
        fresh = event == EDGE and frame.slips
        if event == STUCK and unresolved(state, frame, clock, case):
            moving = False
            continue
        if event == STUCK:
            return STEP_TOO_SMALL, clock, turns, onset_time, np.nan
        if event == SLOW:
            note(REST, noted, clock, case)
            rest_time = clock.tau / case.gamma
            return RESTED, put_still(end, True, REST, clock, case), turns + 1, onset_time, rest_time
        if event != NO_EVENT:
            state, frame, still = switch(event, state, frame, clock, case)
            moving = not still
            length = _PAST * clock.length if event == KINK else 0.0
            clock = Clock(clock.tau, clock.at, clock.piece, clock.steps, clock.ends, length)
        if moving and regime >= 0 and frame.direction != direction:
            noted = note(REVERSED, noted, clock, case)
        now = regime_of(frame) if moving else _still_regime(clock, case)
        if now != regime and (moving or event == NO_EVENT):
            if regime >= 0:
                turns, noted = turns + 1, note(now, noted, clock if moving else before, case)
            onset_time = clock.tau / case.gamma if fresh and np.isnan(onset_time) else onset_time
            regime = now
    return DONE, clock, turns, onset_time, np.nan


@kernel(allocates=True)
def integrate(scene, drive, gamma, V0, omega0, t, limits, sink):
    """Roll one motion from t = 0 to t[-1], t ascending: (status, steps, switches, onset time, rest time).

    ``sink`` : room for the outputs, (OUTPUTS, n), how many of what adds up are asked for, and room for the changes of
    regime and for the ends of panels (Notes).
    """
    out, paths, switches, ends = sink
    tau = np.empty(t.size)
    for i in range(tau.size):
        tau[i] = t[i] * gamma
    matrix, right = np.empty((2 * N, 2 * N)), np.empty(2 * N)
    work = Work(np.empty((ROWS, N + 1)), np.empty((INTERPOLANTS, N + 2)), matrix, right, np.zeros(PATHS))
    case = Case(scene, drive, limits, tau, out, gamma, paths, Notes(switches, ends), work)
    clock = Clock(0.0, 0, 0, 0, 0, 0.0)
    state, frame, status, moving = State(0.0, 0.0), Frame(False, 1.0, 1.0, 0.0, False), OK, False
    if V0 != 0.0 or omega0 != 0.0:
        moving = True
        state, frame, status = enter(V0 if abs(V0) > _TINY * abs(omega0) else 0.0, omega0, clock, case)
    if status != OK:
        return NOT_CONVERGED, 0, 0, np.nan, np.nan
    if moving:
        state, frame = at_new_piece(state, frame, clock, case)
    status, clock, turns, onset_time, rest_time = follow(moving, state, frame, clock, case)
    return status, clock.steps, turns, onset_time, rest_time
