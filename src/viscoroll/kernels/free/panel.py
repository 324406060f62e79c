"""What all panels have in common: the state within, where a motion comes to rest, outputs, ends of steps."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.bracket import narrowed, secant
from .collocation import NODES, N, integral_terms, place, rise_at, rise_terms
from .layer import slow_creep
from .output import put
from .partial_slip import creep_speeds
from .path import D_TAU, D_TURN, D_X, D_Y, RISE_D, RISE_Y, TAU, TURN, D, X, moved, rise_and_mismatch, time_terms
from .records import AT_REST, LAYER, NO_EVENT, SLIDE, SLOW, TIME, Clock
from .slide import FASTEST, slide_state
from .slow import slow_speeds, slow_terms

#: how closely rest is located, and in how many iterations at most
_NEAR, _MOST_ITERATIONS = 1e-15, 80


@kernel
def within_panel(v, since, panel, sigma, scene, powers, slow):
    """(V, omega, delta, X, angle) at v, the time ``since`` behind the left end; X and angle since there."""
    if panel.kind == SLIDE:
        V, omega, X_rise, angle = slide_state(v, since, panel, sigma, scene, powers)
        slip = omega - V
        return V, omega, np.copysign(np.inf, slip) if V == 0.0 else slip / V, X_rise, angle
    if panel.kind == SLOW:
        V, delta = slow_speeds(v, powers)
    else:
        y = panel.first + rise_at(v, powers, RISE_Y)
        if panel.kind == LAYER:
            creep = slow_creep(y, slow)[0] + panel.second * np.exp(-panel.length * (0.5 * v) ** panel.power)
        else:
            creep = panel.second + rise_at(v, powers, RISE_D)
        V, delta = creep_speeds(y, creep, scene)
    X_rise = rise_at(v, powers, X)
    return V, V * (1.0 + delta), delta, X_rise, X_rise + rise_at(v, powers, TURN)


@kernel
def _excess(v, panel, sigma, case):
    """The larger speed less the threshold of rest."""
    V, omega, _, _, _ = within_panel(
        v, rise_at(v, case.work.powers, TAU), panel, sigma, case.scene, case.work.powers, case.work.slow
    )
    return max(abs(V), abs(omega)) - case.limits.rest


@kernel
def rest_place(high, panel, sigma, case):
    """v up to ``high`` at which both speeds have fallen to the threshold; NaN if they have not."""
    low = 0.0
    if panel.kind == SLIDE:
        for i in range(N, 0, -1):
            high = 1.0 + NODES[i] if case.work.nodes[FASTEST, i] < case.limits.rest and NODES[i] + 1.0 < high else high
    at_high = _excess(high, panel, sigma, case)
    if not at_high < 0.0:
        return np.nan
    at_low, side = _excess(low, panel, sigma, case), 0
    if at_low <= 0.0:
        return low
    for _ in range(_MOST_ITERATIONS):
        if high - low <= _NEAR * high or at_high == 0.0:
            break
        middle = secant(low, high, at_low, at_high)
        if not (low < middle < high):
            middle = 0.5 * (low + high)
        value = _excess(middle, panel, sigma, case)
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, middle, value)
    return high


@kernel(inline=True)
def write(end, closed, panel, state, frame, clock, case):
    """Outputs before the time ``end`` of the panel, and, if ``closed``, on it; the next column."""
    sink, tau, at = case.sink, clock.tau, clock.at
    powers, slow = case.work.powers, case.work.slow
    v = 0.0
    while at < sink.tau.size and (sink.tau[at] < tau + end or (closed and sink.tau[at] == tau + end)):
        since = sink.tau[at] - tau
        share = since / end if since > 0.0 else 0.0
        v = place(since, max(v, 2.0 * (share if panel.power == 1 else share ** (1.0 / panel.power))), powers, TAU)
        V, omega, delta, X_rise, angle = within_panel(v, since, panel, frame.sigma, case.scene, powers, slow)
        put(sink, at, frame, (V, omega, delta), state.X + X_rise, state.angle + angle)
        at += 1
    return at


@kernel(inline=True)
def pass_panel(v, end, closed, panel, state, frame, clock, case):
    """Outputs up to v, at the time ``end`` of the panel, and ends of steps there; the clock behind."""
    sink, ends = case.sink, clock.ends
    at = write(end, closed, panel, state, frame, clock, case)
    for i in range(1, N + 1):
        if ends < sink.step_ends.size and 1.0 + NODES[i] < v:
            sink.step_ends[ends] = (clock.tau + rise_at(1.0 + NODES[i], case.work.powers, TAU)) / sink.gamma
            ends += 1
    if ends < sink.step_ends.size and end > 0.0:
        sink.step_ends[ends] = (clock.tau + end) / sink.gamma
        ends += 1
    return Clock(clock.tau + end, at, clock.steps, ends)


@kernel
def _terms(panel, work):
    """Interpolants of a panel in partial slip."""
    half = 0.5 * panel.length
    if panel.kind == SLOW:
        slow_terms(half, work.values, work.nodes, work.powers)
        return
    time_terms(half, work.nodes, work.powers)
    integral_terms(work.nodes[D_Y], half, work.powers, RISE_Y)
    if panel.kind == TIME:
        rise_terms(work.nodes[D], work.powers, RISE_D)


@kernel
def pass_path(first, second, panel, state, frame, clock, case):
    """Pass a panel in partial slip, at whose end y and D are given, or as far as to rest: (event, state, clock)."""
    half, nodes, powers = 0.5 * panel.length, case.work.nodes, case.work.powers
    end, _ = rise_and_mismatch(D_TAU, half, nodes)
    X_rise, _ = rise_and_mismatch(D_X, half, nodes)
    turn, _ = rise_and_mismatch(D_TURN, half, nodes)
    v, event = 2.0, NO_EVENT
    if case.limits.rest > 0.0 or case.sink.tau[clock.at] <= clock.tau + end or clock.ends < case.sink.step_ends.size:
        _terms(panel, case.work)
        rested = rest_place(2.0, panel, frame.sigma, case) if case.limits.rest > 0.0 else np.nan
        if not np.isnan(rested):
            v, event = rested, AT_REST
            end, X_rise, turn = rise_at(v, powers, TAU), rise_at(v, powers, X), rise_at(v, powers, TURN)
    clock = pass_panel(v, end, True, panel, state, frame, clock, case)
    return event, moved(first, second, X_rise, X_rise + turn, state), clock
