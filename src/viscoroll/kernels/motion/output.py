"""Outputs of a driven motion."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import WIDE, integral_at, integral_terms, rise_at
from .load import load_at, needed, threshold
from .nodes import OF_PATH, OF_SECOND, OF_V, PATH, PATHS, SECOND, TOTALS, V, put_path, risen
from .rates import inertia_at, last_pulls, rates_of, speeds
from .records import FULL, LOCKED, PARTIAL, REST, Clock, Frame, State

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


@kernel(inline=True)
def _put_moving(column, moving, regime, case):
    """(V, omega, delta) and the regime, in one column."""
    out, (speed, omega, delta) = case.out, moving
    out[0, column], out[1, column], out[4, column], out[5, column] = speed, omega, delta, regime


@kernel(inline=True)
def _put_acting(column, force, torque, out):
    out[FORCE, column], out[FORCE + 1, column] = force, torque


@kernel
def _put_path(column, n, value, case):
    """Number ``n`` of what adds up, in one column; distance and angle are integrals over t, the rest are energies."""
    if n < 2:
        case.out[PATH_FROM + n, column] = value / case.scene.gamma
    else:
        case.out[WORK + n - 2, column] = value


@kernel
def _put_totals(column, case):
    """What has added up so far, in one column."""
    for n in range(PATHS):
        _put_path(column, n, case.nodes[TOTALS + n], case)


@kernel
def put_still(until, closed, regime, clock, case):
    """Outputs before ``until``, or on it too, of a cylinder that does not move; the clock then."""
    at, out, still = clock.at, case.out, Frame(False, 1.0, 1.0, 0.0, False)
    while at < case.tau.size and (case.tau[at] < until or (closed and case.tau[at] == until)):
        load = load_at(case.tau[at], clock.piece, still, case)
        _put_moving(at, (0.0, 0.0, 0.0), regime, case)
        _put_acting(at, load.force, load.torque, out)
        _put_totals(at, case)
        at += 1
    return Clock(until, at, clock.piece, clock.steps + 1, clock.ends, 0.0)


@kernel
def _put_state(column, state, piece, frame, case):
    """One column but for what adds up."""
    out, direction = case.out, frame.direction
    omega, delta = speeds(state, frame, case.scene)
    _put_moving(column, (direction * state.V, direction * omega, delta), regime_of(frame), case)
    if case.acting:
        load = load_at(case.tau[column], piece, frame, case)
        rates = rates_of(state, load, frame, case.scene)
        moments = rates.Q, rates.M_half_space, rates.M_cylinder
        force, torque, _ = needed((state.V, omega), moments, load, frame, case.scene.j)
        _put_acting(column, direction * force, direction * torque, out)


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
def _put(column, v, panel, frame, case):
    """One column from the interpolants of a panel."""
    nodes, direction = case.nodes, frame.direction
    state = State(nodes[V] + rise_at(v, nodes, OF_V), nodes[SECOND] + rise_at(v, nodes, OF_SECOND))
    _put_state(column, state, panel.piece, frame, case)
    for n in range(PATHS if case.paths else 0):
        way = _way(n, v, panel, case.nodes)
        _put_path(column, n, case.nodes[TOTALS + n] + (direction * way if n < 2 else way), case)


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
        put_path(panel, frame, case)
    if outputs or v < 2.0:
        for n in range(paths):
            integral_terms(PATH + WIDE * n, OF_PATH + WIDE * n, case.nodes)
    if outputs:
        while at < tau.size and (tau[at] < end or closed):
            share = min(max(tau[at] - panel.tau, 0.0) / panel.length, 1.0)
            _put(at, 2.0 * (share if panel.power == 1 else share ** (1.0 / panel.power)), panel, frame, case)
            at += 1
    if clock.ends < case.ends.size:
        case.ends[clock.ends] = end / case.scene.gamma
    for n in range(paths):
        way = _way(n, v, panel, case.nodes) if v < 2.0 else risen(PATH + WIDE * n, panel, case.nodes)
        case.nodes[TOTALS + n] += frame.direction * way if n < 2 else way
    return Clock(end, at, clock.piece, clock.steps, clock.ends + 1, clock.length)


@kernel
def coast(state, frame, clock, case):
    """Outputs of the last decay, (1 + j + gamma N) V' = -rate V with delta/V constant: (clock, time of rest)."""
    scene, out, direction, nodes = case.scene, case.out, frame.direction, case.nodes
    half_space, cylinder, force, torque = last_pulls(case)
    inertia = 1.0 + scene.j + inertia_at(0.0, scene)[0]
    # V and omega fall together: Q = 4 kappa delta takes what the moments differ by
    rate, per = (half_space + cylinder - force - torque) / inertia, 4.0 * scene.kappa * inertia
    creep = state.V * (scene.j * (half_space - force) - cylinder + torque) / per
    fastest, rest, end = max(state.V, abs(state.V * (1.0 + creep))), threshold(clock.piece, case), np.inf
    if rest > 0.0:
        end = clock.tau + max(np.log(fastest / rest) / rate, 0.0)
    by_force, by_torque = force / rate, torque / rate
    energies = 0.0, 0.0, by_force, by_torque, 0.0, 0.0, 1.0 + scene.j + by_force + by_torque
    for at in range(clock.at, case.tau.size):
        moves = case.tau[at] <= end
        gone = np.expm1(-rate * (min(case.tau[at], end) - clock.tau))
        decay = 1.0 + gone if gone > -0.5 else np.exp(-rate * (case.tau[at] - clock.tau))
        V, delta = (state.V * decay, creep * decay) if moves else (0.0, 0.0)
        _put_moving(at, (direction * V, direction * (V * (1.0 + delta)), delta), PARTIAL if moves else REST, case)
        _put_acting(at, force * direction * V, torque * direction * V, out)
        way = -direction * state.V * gone / rate
        lost = 0.5 * state.V * state.V * (-gone * (1.0 + decay) if moves else 1.0)
        for n in range(PATHS):
            _put_path(at, n, nodes[TOTALS + n] + (way if n < 2 else energies[n] * lost), case)
    last = case.tau[case.tau.size - 1]
    clock = Clock(last, case.tau.size, clock.piece, clock.steps, clock.ends, 0.0)
    return clock, end / case.scene.gamma if end <= last else np.nan
