"""Outputs of a motion: V, omega, delta and the regime; what acts; what adds up along the way."""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from ..rows.cover import is_cover
from ..rows.evaluate import limits_at_rest
from .collocation import WIDE, integral_at, integral_terms, rise_at
from .load import load_at, needed, threshold
from .nodes import (
    NOTED,
    OF_PATH,
    OF_SECOND,
    OF_V,
    PATH,
    PATHS,
    REST_TIME,
    SECOND,
    TOTALS,
    TURNS,
    V,
    along,
    put_path,
    risen,
)
from .rates import inertia_at, last_pulls, rates_of, speeds
from .records import DONE, FULL, LOCKED, PARTIAL, REST, RESTED, REVERSED, Clock, Frame, State

#: rows: V, omega, x, angle, delta, regime; force, torque; work of either, losses in the brake, in slip, in rolling
OUTPUTS = 13
PATH_FROM, FORCE, WORK = 2, 6, 8


@kernel
def asked_by(rows):
    """(Whether anything that adds up is asked for, whether what acts)."""
    paths = acting = False
    for row in rows:
        paths = paths or PATH_FROM <= row < PATH_FROM + 2 or row >= WORK
        acting = acting or FORCE <= row < WORK
    return paths, acting


@kernel
def regime_of(frame):
    """The regime that outputs give."""
    return LOCKED if frame.locked else FULL if frame.slips else PARTIAL


@kernel
def _put(column, moving, regime, driving, case):
    """(V, omega, delta), the regime, and (force, torque), in one column."""
    out, (speed, omega, delta), (force, torque) = case.out, moving, driving
    out[0, column], out[1, column], out[4, column], out[5, column] = speed, omega, delta, regime
    out[FORCE, column], out[FORCE + 1, column] = force, torque


@kernel
def _put_path(column, n, rise, case):
    """Number ``n`` of what adds up, that has risen by this beyond what is kept of it, in one column."""
    case.out[PATH_FROM + n if n < 2 else WORK + n - 2, column] = case.nodes[TOTALS + n] + rise


@kernel
def _put_totals(column, case):
    """What has added up so far, in one column."""
    for n in range(PATHS):
        _put_path(column, n, 0.0, case)


@kernel
def note(what, clock, case):
    """Note a change of regime or of the sign of V."""
    nodes, switches = case.nodes, case.switches
    noted = int(nodes[NOTED])
    if noted < switches.shape[0]:
        switches[noted, 0], switches[noted, 1] = clock.tau / case.scene.gamma, what
    nodes[NOTED] += 1.0
    nodes[TURNS] += 0.0 if what == REVERSED else 1.0


@kernel
def put_still(until, closed, regime, clock, case):
    """Outputs before ``until``, or on it too, of a cylinder that does not move; the clock then."""
    at, still = clock.at, Frame(False, 1.0, 1.0, 0.0, False)
    while at < case.tau.size and (case.tau[at] < until or (closed and case.tau[at] == until)):
        load = load_at(case.tau[at], clock.piece, still, case)
        _put(at, (0.0, 0.0, 0.0), regime, (load.force, load.torque), case)
        _put_totals(at, case)
        at += 1
    return Clock(until, at, clock.piece, clock.steps + 1, clock.ends, 0.0)


@kernel
def _put_state(column, state, piece, frame, case):
    """One column but for what adds up."""
    direction, force, torque = frame.direction, 0.0, 0.0
    omega, delta = speeds(state, frame, case.scene)
    if case.acting:
        load = load_at(case.tau[column], piece, frame, case)
        rates = rates_of(state, load, frame, case.scene)
        moments = rates.Q, rates.M_half_space, rates.M_cylinder
        force, torque, _ = needed((state.V, omega), moments, load, frame, case.scene.j)
    moving, driving = (direction * state.V, direction * omega, delta), (direction * force, direction * torque)
    _put(column, moving, regime_of(frame), driving, case)


@kernel
def put_here(state, frame, clock, case):
    """The outputs at the time that it is, to the tolerance; the clock then."""
    at = clock.at
    while at < case.tau.size and case.tau[at] <= clock.tau * (1.0 + case.limits.rtol):
        _put_state(at, state, clock.piece, frame, case)
        _put_totals(at, case)
        at += 1
    return Clock(clock.tau, at, clock.piece, clock.steps, clock.ends, 0.0)


@kernel(inline=True)
def _way(n, v, panel, nodes):
    """What number ``n`` of what adds up has risen by at v."""
    first = nodes[PATH + WIDE * n]
    return 0.5 * panel.length * integral_at(v, first, nodes, OF_PATH + WIDE * n)


@kernel(inline=True)
def _put_along(column, v, panel, frame, case):
    """One column from the interpolants of a panel."""
    nodes = case.nodes
    state = State(nodes[V] + rise_at(v, nodes, OF_V), nodes[SECOND] + rise_at(v, nodes, OF_SECOND))
    _put_state(column, state, panel.piece, frame, case)
    for n in range(PATHS if case.paths else 0):
        _put_path(column, n, _way(n, v, panel, nodes), case)


@kernel(inline=True)
def pass_panel(end, v, panel, frame, clock, case):
    """Outputs before the ``end`` of a panel or of what ends at ``v`` on it, and what adds up until then; the clock.

    At its end, where the drive may jump, what follows tells; but the last of the outputs is there.
    """
    tau, at = case.tau, clock.at
    closed = end == tau[tau.size - 1]
    outputs = at < tau.size and (tau[at] < end or closed)
    paths = PATHS if case.paths else 0
    if paths > 0:
        put_path(frame, case)
    if outputs or v < 2.0:
        for n in range(paths):
            integral_terms(PATH + WIDE * n, OF_PATH + WIDE * n, case.nodes)
    if outputs:
        while at < tau.size and (tau[at] < end or closed):
            _put_along(at, min(along(tau[at], panel), 2.0), panel, frame, case)
            at += 1
    if clock.ends < case.ends.size:
        case.ends[clock.ends] = end / case.scene.gamma
    for n in range(paths):
        way = _way(n, v, panel, case.nodes) if v < 2.0 else risen(PATH + WIDE * n, panel, case.nodes)
        case.nodes[TOTALS + n] += way
    return Clock(end, at, clock.piece, clock.steps, clock.ends + 1, clock.length)


@kernel
def coast(state, frame, clock, case):
    """Outputs of the last decay, (1 + j + gamma N) V' = -rate V with delta/V constant: (status, clock)."""
    scene, direction = case.scene, frame.direction
    half_space, cylinder, force, torque = last_pulls(case)
    L, free = limits_at_rest(scene.kappa, by_value(scene.law))
    spin = 1.0 + free
    inertia = 1.0 + scene.j * spin + inertia_at(0.0, scene)[0]
    # V and omega fall together: Q = 4 kappa (delta - delta_0)/L takes what the moments differ by
    rate, per = (half_space + cylinder - force - torque) / inertia, 4.0 * scene.kappa * inertia
    pull = scene.j * spin * (half_space - force) - cylinder + torque
    creep = state.V * pull / per * L
    fastest, rest, end = max(state.V, abs(state.V * (spin + creep))), threshold(clock.piece, case), np.inf
    if rest > 0.0:
        end = clock.tau + max(np.log(fastest / rest) / rate, 0.0)
    by_force, by_torque = force / rate, torque / rate
    energies = 0.0, 0.0, by_force, by_torque, 0.0, 0.0, 1.0 + scene.j + by_force + by_torque
    if is_cover(by_value(scene.law).cover_rows):
        rolling, slipping = (half_space + cylinder * spin) / rate, free * pull / (inertia * rate)
        energies = 0.0, 0.0, by_force, by_torque * spin, 0.0, slipping, rolling
    for at in range(clock.at, case.tau.size):
        moves = case.tau[at] <= end
        gone = np.expm1(-rate * (min(case.tau[at], end) - clock.tau))
        decay = 1.0 + gone if gone > -0.5 else np.exp(-rate * (case.tau[at] - clock.tau))
        V, delta = (state.V * decay, creep * decay) if moves else (0.0, 0.0)
        moving = direction * V, direction * (V * (spin + delta)), delta + free
        _put(at, moving, PARTIAL if moves else REST, (force * direction * V, torque * direction * V), case)
        way = -direction * state.V * gone / (rate * scene.gamma)
        lost = 0.5 * state.V * state.V * (-gone * (1.0 + decay) if moves else 1.0)
        for n in range(PATHS):
            _put_path(at, n, way * (spin if n == 1 else 1.0) if n < 2 else energies[n] * lost, case)
    last = case.tau[case.tau.size - 1]
    clock = Clock(last, case.tau.size, clock.piece, clock.steps, clock.ends, 0.0)
    if end <= last:
        case.nodes[REST_TIME] = end / scene.gamma
    return RESTED if end <= last else DONE, clock
