"""One motion from start to end: one phase after the other, and the switches between full and partial slip.

The regime changes only at a located event; nothing re-tests it between.  Full slip is :mod:`slide_phase`.  Partial
slip is entered through its boundary layer (:mod:`layer_phase`) and left for the slow manifold (:mod:`slow_phase`),
then for the closed form of the last decay; :mod:`radau_phase` is for where the two give up.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import OK
from ..law.stick import stick_length
from .full_slip import sliding_speed, stick_limit
from .layer_phase import layer_phase
from .output import coast, put, put_rest, put_to_end, speeds
from .partial_slip import slow_D
from .radau_phase import radau_phase
from .records import (
    AT_REST,
    FULL,
    NO_EVENT,
    PARTIAL,
    REST,
    REVERSAL,
    SLIP,
    STICK,
    STUCK,
    Case,
    Clock,
    Frame,
    Sink,
    State,
)  # fmt: skip
from .slide_phase import slide_phase
from .slow import workspace
from .slow_phase import FAR, slow_phase

DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, NOT_CONVERGED, UNDECIDED = range(6)

#: speeds below this count as 0 beside others, and as already rolling among themselves
_TINY = 1e-150
#: least 1/zeta at which stick begins
_LEAST = 1e-300
#: share of the whole time that rounding may leave of it behind an event
_AT_THE_END = 2.0**-51
#: time until the slow manifold is tried again, over that of the steps before it was tried in vain
_PATIENCE = 3.0


@kernel
def rolling(momentum, scene):
    """(y, D) once the fast transient is over, which at vanishing speed lasts a time of order V: V + j omega is kept."""
    y = -np.log(2.0 * scene.kappa * momentum / (1.0 + scene.j))
    return y, slow_D(y, scene)[0]


@kernel
def start(V, omega, scene):
    """(V, omega) in the unknowns of its regime: (state, frame, status)."""
    material, _, mu, j = scene
    if max(abs(V), abs(omega)) < _TINY:
        # sliding ends within a time of that order: V + j omega is kept
        V = omega = (V + j * omega) / (1.0 + j)
    elif abs(V) < _TINY:
        V = 0.0
    if V == 0.0 and omega == 0.0:
        return State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Frame(REST, 1.0, 0.0), OK
    direction = np.sign(V) if V != 0.0 else np.sign(omega)
    V, omega = direction * V, direction * omega
    slip = omega - V
    sigma = 1.0 if slip >= 0.0 else -1.0
    limit, zeta, status = stick_limit(V, scene)
    if V == 0.0 or abs(slip) >= limit:
        s = 1.0 / zeta if V > 0.0 else 0.0
        return State(s, V - j * omega, 0.0, 0.0, 0.0, 0.0), Frame(FULL, direction, sigma), status
    if np.log(zeta) > FAR:
        y, D = rolling(V + j * omega, scene)
    else:
        y = np.log(zeta)
        _, D, stick_status = stick_length(zeta, abs(slip) / V / (mu * V), material)
        D, status = D * sigma, max(status, stick_status)
    return State(y, D, 0.0, 0.0, 0.0, 0.0), Frame(PARTIAL, direction, sigma), status


@kernel
def switch(event, state, frame, scene):
    """Enter the regime behind an event: (state, frame)."""
    first, second, X, angle, way, turned = state
    if event == STICK:
        # both speeds may end at once, to rounding
        y = -np.log(max(first, _LEAST))
        D = frame.sigma * np.exp(y)
        momentum = 2.0 * sliding_speed(first, scene) - second
        if y > FAR and momentum > 0.0:
            y, D = rolling(momentum, scene)
        return State(y, D, X, angle, way, turned), Frame(PARTIAL, frame.direction, frame.sigma)
    if event == SLIP:
        V, omega, _ = speeds(state, PARTIAL, scene)
        w = V - scene.j * omega
        return State(np.exp(-first), w, X, angle, way, turned), Frame(FULL, frame.direction, np.sign(second))
    # REVERSAL: V = 0; look from the other side, where V rises
    return State(0.0, -second, -X, -angle, way, turned), Frame(FULL, -frame.direction, -frame.sigma)


@kernel
def finish_coasting(state, frame, clock, case):
    """Outputs of the closed form from here on: (status, rest time)."""
    sink = case.sink
    clock, crossing, way = coast(state, frame, clock, case)
    if crossing > sink.tau[sink.tau.size - 1]:
        return DONE, np.nan
    there = State(0.0, 0.0, state.X + way, state.angle + way, 0.0, 0.0)
    put_rest(there, frame, clock, case)
    return RESTED, crossing / sink.gamma


@kernel(inline=True)
def partial_phase(entering, try_at, state, frame, clock, case):
    """Partial slip: (event, state, clock, when to try the slow manifold again, whether the closed form holds).

    The boundary layer where it is ``entering``, else steps; from there the slow manifold, where it is near.
    """
    start = clock.tau
    if entering:
        near, event, state, clock = layer_phase(state, frame, clock, case)
    else:
        event, near, state, clock = radau_phase(try_at, state, frame, clock, case)
    # without rolling resistance nothing moves on the slow manifold
    coasts = near and case.scene.material.T_mean == 0.0
    if near and not coasts:
        left = clock.tau
        event, state, clock, try_at = slow_phase(state, frame, clock, case)
        if clock.tau == left:  # in vain: steps that begin anew are short, and are to grow
            try_at = max(try_at, left + _PATIENCE * (left - start))
    return event, state, clock, try_at, coasts or state.first >= FAR


@kernel
def follow(state, frame, clock, case, switches):
    """From phase to phase until outputs end: (status, clock, switches, onset time, rest time)."""
    sink, gamma = case.sink, case.sink.gamma
    tau_end = sink.tau[sink.tau.size - 1]
    onset_time, turns, try_at = np.nan, 0, 0.0
    slipped, entering, coasts = False, True, frame.regime == PARTIAL and state.first >= FAR
    while clock.at < sink.tau.size:
        if coasts:
            status, rest_time = finish_coasting(state, frame, clock, case)
            return status, clock, turns, onset_time, rest_time
        if tau_end - clock.tau <= _AT_THE_END * tau_end:
            clock = put_to_end(state, frame, clock, case)
            break
        if clock.steps >= case.limits.max_steps:
            return STEP_LIMIT, clock, turns, onset_time, np.nan
        if frame.regime == FULL:
            event, state, clock = slide_phase(slipped, state, frame, clock, case)
        else:
            event, state, clock, try_at, coasts = partial_phase(entering, try_at, state, frame, clock, case)
            entering = False
        if event == AT_REST:
            put_rest(state, frame, clock, case)
            return RESTED, clock, turns, onset_time, clock.tau / gamma
        if event == STUCK:
            return STEP_TOO_SMALL, clock, turns, onset_time, np.nan
        if event == NO_EVENT:
            continue
        state, frame = switch(event, state, frame, case.scene)
        slipped, entering, coasts = event == SLIP, event == STICK, frame.regime == PARTIAL and state.first >= FAR
        if event == REVERSAL:
            continue
        if turns < switches.shape[0]:
            switches[turns, 0], switches[turns, 1] = clock.tau / gamma, frame.regime
        turns += 1
        onset_time = clock.tau / gamma if event == STICK and np.isnan(onset_time) else onset_time
    return DONE, clock, turns, onset_time, np.nan


@kernel(allocates=True)
def integrate(scene, gamma, V0, omega0, t_out, limits, out, notes):
    """Roll one motion from t = 0 to t_out[-1]; t_out ascending, out of shape (OUTPUTS, n).

    The notes receive the regime changes, and the times behind the panels and at their nodes; what does not fit is not
    kept.  Returns (status, steps, switches, onset time, rest time).
    """
    tau = np.empty(t_out.size)
    for i in range(tau.size):
        tau[i] = t_out[i] * gamma
    case = Case(scene, limits, Sink(tau, out, notes.step_ends, gamma), workspace())
    clock = Clock(0.0, 0, 0, 0)
    origin, still = State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Frame(REST, 1.0, 0.0)
    if max(abs(V0), abs(omega0)) < limits.rest:
        put_rest(origin, still, clock, case)
        return RESTED, 0, 0, np.nan, 0.0
    state, frame, status = start(V0, omega0, scene)
    if status != OK:
        return NOT_CONVERGED, 0, 0, np.nan, np.nan
    if frame.regime == REST:
        put_rest(origin, still, clock, case)
        return DONE, 0, 0, np.nan, np.nan
    first = Frame(frame.regime, 1.0, frame.sigma)
    while clock.at < t_out.size and t_out[clock.at] == 0.0:
        delta = speeds(state, frame.regime, scene)[2]
        put(case.sink, clock.at, first, (V0, omega0, delta), 0.0, 0.0)
        clock = Clock(0.0, clock.at + 1, 0, 0)
    status, clock, turns, onset_time, rest_time = follow(state, frame, clock, case, notes.switches)
    return status, clock.steps, turns, onset_time, rest_time
