"""Output of a motion: columns, the closed form of the last decay, rest."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .full_slip import sliding_speed
from .partial_slip import creep_speeds
from .records import FULL, REST, Clock, Frame

#: rows of the output: V, omega, x, angle, delta, regime
OUTPUTS = 6


@kernel
def speeds(state, regime, scene):
    """(V, omega, delta) in the frame of the state."""
    if regime != FULL:
        V, delta = creep_speeds(state.first, state.second, scene)
        return V, V * (1.0 + delta), delta
    V = sliding_speed(state.first, scene)
    omega = (V - state.second) / scene.j
    slip = omega - V
    return V, omega, np.copysign(np.inf, slip) if V == 0.0 else slip / V


@kernel
def put(sink, column, frame, moving, X, angle):
    """One output column, back in the frame and units of the caller; ``moving`` = (V, omega, delta)."""
    out, gamma, direction = sink.out, sink.gamma, frame.direction
    V, omega, delta = moving
    out[0, column], out[1, column] = direction * V, direction * omega
    out[2, column], out[3, column] = direction * X / gamma, direction * angle / gamma
    out[4, column], out[5, column] = delta, frame.regime


@kernel
def put_to_end(state, frame, clock, case):
    """All outputs that are left, of a motion that is where it ends."""
    moving = speeds(state, frame.regime, case.scene)
    for column in range(clock.at, case.sink.tau.size):
        put(case.sink, column, frame, moving, state.X, state.angle)
    return Clock(clock.tau, case.sink.tau.size, clock.steps, clock.ends)


@kernel
def put_rest(state, frame, clock, case):
    """Outputs after rest: V = omega = 0 at the place where the threshold was crossed."""
    direction = frame.direction
    for column in range(clock.at, case.sink.tau.size):
        put(case.sink, column, Frame(REST, 1.0, 0.0), (0.0, 0.0, 0.0), direction * state.X, direction * state.angle)


@kernel
def relaxation_at_rest(V, scene):
    """Rate at which delta decays at alpha = 1, where D is small: Q = 2 mu D/zeta, delta = mu V D."""
    return 4.0 * scene.kappa * (1.0 + 1.0 / scene.j) / V


@kernel
def coast(state, frame, clock, case):
    """Outputs of the last decay, in closed form: V' = -c V/(1 + j), delta/V constant.

    Relative corrections are of the order of kappa V < 1e-17, or of what is left of delta at alpha = 1: there V stays,
    and delta decays.  Returns (clock, time at which the rest threshold is crossed or infinity, distance until there).
    """
    scene, sink, rest = case.scene, case.sink, case.limits.rest
    rate = scene.material.T_mean / (1.0 + scene.j)
    V, omega, delta = speeds(state, frame.regime, scene)
    creep_rate = rate if rate > 0.0 else relaxation_at_rest(V, scene)
    crossing, fastest, at = np.inf, max(abs(V), abs(omega)), clock.at
    if rest > 0.0 and rate > 0.0:
        crossing = clock.tau + np.log(fastest / rest) / rate
    while at < sink.tau.size and sink.tau[at] <= crossing:
        since = sink.tau[at] - clock.tau
        decay, creep = np.exp(-rate * since), delta * np.exp(-creep_rate * since)
        way = V * since if rate == 0.0 else -V * np.expm1(-rate * since) / rate
        put(sink, at, frame, (V * decay, V * decay * (1.0 + creep), creep), state.X + way, state.angle + way)
        at += 1
    return Clock(clock.tau, at, clock.steps, clock.ends), crossing, (V - rest) / rate if rate > 0.0 else np.inf
