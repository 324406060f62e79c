"""Outputs of a driven motion."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import integral_terms, rise_at
from ..motion.records import FULL, PARTIAL, REST
from .load import load_at, needed
from .nodes import OF_PATH, OF_S, OF_SECOND, PATH, PATHS, SECOND, S, risen
from .rates import rates_at
from .records import LOCKED, Clock, Frame

#: rows: V, omega, x, angle, delta, regime; force, torque; work of either, losses in the brake, in slip, in rolling
OUTPUTS = 13
PATH_FROM, FORCE, WORK = 2, 6, 8


@kernel
def paths_in(rows):
    """How many of what adds up are among these rows: all, or none."""
    for row in rows:
        if PATH_FROM <= row < PATH_FROM + 2 or row >= WORK:
            return PATHS
    return 0


@kernel
def regime_of(frame):
    """The regime that outputs give."""
    return LOCKED if frame.locked else FULL if frame.slips else PARTIAL


@kernel(inline=True)
def _put_moving(column, moving, regime, out):
    """(V, omega, delta) and the regime, in one column."""
    out[0, column], out[1, column], out[4, column] = moving
    out[5, column] = regime


@kernel(inline=True)
def _put_acting(column, force, torque, out):
    out[FORCE, column], out[FORCE + 1, column] = force, torque


@kernel
def _put_path(column, n, value, case):
    """Number ``n`` of what adds up, in one column; distance and angle are integrals over t, the rest are energies."""
    if n < 2:
        case.out[PATH_FROM + n, column] = value / case.gamma
    else:
        case.out[WORK + n - 2, column] = value


@kernel
def put_still(until, closed, regime, clock, case):
    """Outputs before ``until``, or on it too, of a cylinder that does not move; the clock then."""
    at, out, still = clock.at, case.out, Frame(False, 1.0, 1.0, 0.0, False)
    while at < case.tau.size and (case.tau[at] < until or (closed and case.tau[at] == until)):
        load = load_at(case.tau[at], clock.piece, still, case)
        _put_moving(at, (0.0, 0.0, 0.0), regime, out)
        _put_acting(at, load.force, load.torque, out)
        for n in range(PATHS):
            _put_path(at, n, case.work.totals[n], case)
        at += 1
    return Clock(until, at, clock.piece, clock.steps + 1, clock.ends, 0.0)


@kernel
def _put_state(column, s, second, piece, frame, case):
    """One column but for what adds up."""
    out, direction = case.out, frame.direction
    load = load_at(case.tau[column], piece, frame, case)
    rates = rates_at(s, second, load, frame, case.scene)
    moments = rates.Q, rates.M_half_space, rates.M_cylinder
    force, torque, _ = needed((rates.V, rates.omega), moments, load, frame, case.scene.j)
    _put_moving(column, (direction * rates.V, direction * rates.omega, rates.delta), regime_of(frame), out)
    _put_acting(column, direction * force, direction * torque, out)


@kernel
def put_to_end(state, frame, clock, case):
    """All outputs that are left, of a motion that is where it ends; the clock then."""
    for column in range(clock.at, case.tau.size):
        _put_state(column, state.s, state.second, clock.piece, frame, case)
        for n in range(PATHS):
            _put_path(column, n, case.work.totals[n], case)
    return Clock(clock.tau, case.tau.size, clock.piece, clock.steps, clock.ends, 0.0)


@kernel
def _put(column, v, panel, frame, case):
    """One column from the interpolants of a panel."""
    nodes, powers, direction = case.work.nodes, case.work.powers, frame.direction
    s = nodes[S, 0] + rise_at(v, powers, OF_S)
    second = nodes[SECOND, 0] + rise_at(v, powers, OF_SECOND)
    _put_state(column, s, second, panel.piece, frame, case)
    for n in range(case.paths):
        way = rise_at(v, powers, OF_PATH + n)
        _put_path(column, n, case.work.totals[n] + (direction * way if n < 2 else way), case)


@kernel
def pass_panel(end, v, panel, frame, clock, case):
    """Outputs before the ``end`` of a panel or of what ends at ``v`` on it, and what adds up until then; the clock.

    At its end, where the drive may jump, what follows tells; but the last of the outputs is there.
    """
    tau, at = case.tau, clock.at
    closed = end == tau[tau.size - 1]
    outputs = at < tau.size and (tau[at] < end or closed)
    if outputs or v < 2.0:
        for n in range(case.paths):
            integral_terms(case.work.nodes[PATH + n], 0.5 * panel.length, case.work.powers, OF_PATH + n)
    if outputs:
        while at < tau.size and (tau[at] < end or closed):
            share = min(max(tau[at] - panel.tau, 0.0) / panel.length, 1.0)
            _put(at, 2.0 * share ** (1.0 / panel.power), panel, frame, case)
            at += 1
    if clock.ends < case.notes.ends.size:
        case.notes.ends[clock.ends] = end / case.gamma
    for n in range(case.paths):
        way = rise_at(v, case.work.powers, OF_PATH + n) if v < 2.0 else risen(PATH + n, panel, case.work.nodes)
        case.work.totals[n] += frame.direction * way if n < 2 else way
    return Clock(end, at, clock.piece, clock.steps, clock.ends + 1, clock.length)


@kernel
def coast(state, frame, clock, case):
    """Outputs of the last decay, V' = -T_mean V/(1 + j) with delta/V constant: (clock, time of rest or NaN)."""
    scene, out, direction, totals = case.scene, case.out, frame.direction, case.work.totals
    rate = scene.material.T_mean / (1.0 + scene.j)
    rates = rates_at(state.s, state.second, load_at(clock.tau, clock.piece, frame, case), frame, scene)
    fastest, rest, end = max(rates.V, abs(rates.omega)), case.limits.rest, np.inf
    if rest > 0.0:
        end = clock.tau + max(np.log(fastest / rest) / rate, 0.0)
    start = clock.tau
    for at in range(clock.at, case.tau.size):
        moves = case.tau[at] <= end
        since = min(case.tau[at], end) - start
        decay = np.exp(-rate * since)
        way = -rates.V * np.expm1(-rate * since) / rate
        V = rates.V * decay if moves else 0.0
        delta = rates.delta * decay if moves else 0.0
        regime = PARTIAL if moves else REST
        _put_moving(at, (direction * V, direction * (V * (1.0 + delta)), delta), regime, out)
        _put_acting(at, 0.0, 0.0, out)
        for n in range(PATHS):
            _put_path(at, n, totals[n] + (direction * way if n < 2 else 0.0), case)
    last = case.tau[case.tau.size - 1]
    clock = Clock(last, case.tau.size, clock.piece, clock.steps, clock.ends, 0.0)
    return clock, end / case.gamma if end <= last else np.nan
