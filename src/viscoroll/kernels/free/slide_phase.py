"""Full slip to its end: panel control, the end of slip."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import contact_length
from .collocation import NODES, N
from .control import SHARE, next_length
from .full_slip import sliding, sliding_scale, standstill
from .panel import pass_panel, rest_place
from .path import moved
from .records import AT_REST, NO_EVENT, REVERSAL, SLIDE, STICK, STUCK, Clock, Panel
from .slide import (
    BEYOND,
    FASTEST,
    SLIP,
    SPEED_V,
    dip,
    locate_slide,
    s_at,
    slide_error,
    slide_rates,
    slide_rise,
    slide_state,
    slide_sums,
    slide_terms,
    slip_at,
    standing_panel,
)  # fmt: skip

#: the first panel at rtol = 1, the longest, and the shortest
_FIRST, _LONGEST, _SHORTEST = 4.8, 4.0, 1e-9
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.03
#: errors of V weigh more than its share of the speeds says: what is left of V + j omega at onset may be small
_SLIDING = 150.0
#: change of V over V up to which s changes in proportion
_NEAR = 0.1
#: slip less its limit, over the speeds, at which a start is on the edge; halvings of a panel searched for an opening
_ON_EDGE, _HALVINGS = 1e-12, 40
#: share of rtol by which V may still be off where it is taken to stand still
_HELD = 0.1


@kernel
def choose_pole(s, sigma, scene):
    """The pole of the panels from s on."""
    material, kappa, mu, _ = scene
    c = material.T_mean
    standing = standstill(s, scene) if sigma > 0.0 else np.nan
    if standing > 0.0:
        return standing
    return -1.0 if 4.0 * kappa * mu >= c else -4.0 * kappa * mu / c


@kernel
def _duration(closing, omega, V, sigma, left):
    """Time until the slip has gone at this rate, at most ``left``."""
    slip = sigma * (omega - V)
    return min(slip / closing, left) if closing > 0.0 else left


@kernel
def aim(here, omega, s, pole, left, sigma, scene):
    """(Length, s at the end) of the panel that goes a little beyond the end of slip, or of ``left``, or to V = 0."""
    material, kappa, mu, j = scene
    V, rate, per_s, half_M, _ = here
    closing, less = mu * (1.0 + 1.0 / j), sigma * (1.0 / j - 1.0)
    duration = _duration(closing + less * half_M, omega, V, sigma, left)
    if pole > 0.0:
        length = -BEYOND * duration * rate / (per_s * (pole - s))
        return length, s + (s - pole) * np.expm1(length)
    ahead = V + rate * duration
    if ahead <= 0.0:
        return -np.log1p(-s / pole), 0.0
    change = rate * duration * BEYOND
    end = s + change / per_s
    if abs(change) > _NEAR * V:
        lam, _ = contact_length(kappa * ahead, material)
        end = 2.0 * kappa * ahead / lam
        mean = 0.5 * (half_M + sliding(end, sigma, scene)[3])
        change = (sigma * mu - mean) * _duration(closing + less * mean, omega, V, sigma, left) * BEYOND
        if change * rate > 0.0:
            end *= max(V + change, 0.0) / ahead
        change = (end - s) * per_s
    return np.log1p(change / (per_s * (s - pole))), end


@kernel
def opening(high, panel, sigma, scene, powers):
    """v before ``high`` at which slip that starts on its limit is beyond it, if only for a moment; 0 if nowhere."""
    v = high
    for _ in range(_HALVINGS):
        v *= 0.5
        if slip_at(v, panel, sigma, scene, powers) > 0.0:
            return v
    return 0.0


@kernel
def end_of_slip(slipped, panel, sigma, scene, work):
    """(event, v): where the stick zone forms on the panel, else none and its end.

    Where it has just gone (``slipped``), slip that rounding keeps below its limit does not end at once.
    """
    nodes, powers = work.nodes, work.powers
    low, high = 0.0, 0.0
    for i in range(1, N + 1):
        if nodes[SLIP, i] < 0.0:
            low, high = 1.0 + NODES[i - 1], 1.0 + NODES[i]
            break
    if high == 0.0:
        high = dip(nodes, powers)
        if not (0.0 < high < 2.0 and slip_at(high, panel, sigma, scene, powers) < 0.0):
            return NO_EVENT, 2.0
        for i in range(1, N):
            low = 1.0 + NODES[i] if 1.0 + NODES[i] < high else low
    if low == 0.0 and nodes[SLIP, 0] <= _ON_EDGE * nodes[FASTEST, 0]:
        low = opening(high, panel, sigma, scene, powers)
        if low == 0.0:
            return (NO_EVENT, 2.0) if slipped else (STICK, 0.0)
    return STICK, locate_slide(low, high, panel, sigma, scene, work)


@kernel(inline=True)
def chosen_panel(state, here, pole, longest, left, sigma, case):
    """The next panel, and whether it is ready; where V stands still its rates are filled in already."""
    scene, nodes = case.scene, case.work.nodes
    s = state.first
    speed, rate, per_s, _, _ = here
    held = _HELD * case.limits.rtol * sliding_scale(speed, state.second, scene)
    if rate == 0.0 or (pole > 0.0 and (abs(s - pole) * per_s <= held or rate * (pole - s) <= 0.0)):
        return standing_panel(state, pole if pole > 0.0 else s, left, sigma, scene, nodes), True
    omega = (speed - state.second) / scene.j
    length, end = aim(here, omega, s, pole, left, sigma, scene)
    most = min(longest, np.log(abs(s - pole) * per_s / (0.5 * held)) if pole > 0.0 else longest)
    if abs(length) > most:
        length = np.copysign(most, length)
        end = s + (s - pole) * np.expm1(length)
    panel = Panel(SLIDE, s, state.second, length, 1, pole, end, speed, omega)
    return panel, slide_rates(panel, sigma, scene, nodes)


@kernel(inline=True)
def panel_size(rise, state, panel, sigma, case):
    """Error of the panel over its tolerance."""
    w = state.second + 2.0 * sigma * case.scene.mu * rise
    scale = case.limits.rtol * sliding_scale(case.work.nodes[SPEED_V, N], w, case.scene)
    return _SLIDING * _OVERSTATED * slide_error(abs(panel.length), case.work.nodes) / (SHARE * scale)


@kernel(inline=True)
def panel_event(slipped, tau_left, panel, sigma, case):
    """(event, v, time until there): the first event on the panel, else none and its end."""
    scene, work = case.scene, case.work
    event, v = end_of_slip(slipped, panel, sigma, scene, work)
    rested = rest_place(v, panel, sigma, case) if case.limits.rest > 0.0 and v > 0.0 else np.nan
    if not np.isnan(rested):
        event, v = AT_REST, rested
    if event == NO_EVENT and panel.end == 0.0:
        event = REVERSAL
    rise = slide_rise(v, panel, sigma, scene, work.powers)[2] if v > 0.0 else 0.0
    return NO_EVENT if rise > tau_left else event, v, rise


@kernel(inline=True)
def slide_on(v, rise, state, panel, sigma, case):
    """The state at v, after the time ``rise``."""
    _, _, X, angle = slide_state(v, rise, panel, sigma, case.scene, case.work.powers)
    return moved(s_at(v, panel), panel.second + 2.0 * sigma * case.scene.mu * rise, X, angle, state)


@kernel
def slide_phase(slipped, state, frame, clock, case):
    """Slide to an event, or until outputs end: (event, state, clock).  ``slipped``: the stick zone has just gone."""
    sigma, limits, sink = frame.sigma, case.limits, case.sink
    tau_end = sink.tau[sink.tau.size - 1]
    longest = min(_FIRST * limits.rtol ** (1.0 / (N + 1.0)), _LONGEST)
    pole = choose_pole(state.first, sigma, case.scene)
    while clock.at < sink.tau.size and clock.steps < limits.max_steps:
        clock = Clock(clock.tau, clock.at, clock.steps + 1, clock.ends)
        here = sliding(state.first, sigma, case.scene)
        if sigma * ((here[0] - state.second) / case.scene.j - here[0]) <= 0.0:
            return STICK, state, clock
        panel, ready = chosen_panel(state, here, pole, longest, tau_end - clock.tau, sigma, case)
        rise, size = 0.0, np.inf
        if ready:
            rise = slide_sums(panel, sigma, case.scene, case.work.nodes)
            size = panel_size(rise, state, panel, sigma, case)
        longest = min(_LONGEST, next_length(abs(panel.length), size, 1))
        if not size <= 1.0:
            if longest < _SHORTEST:
                return STUCK, state, clock
            continue
        slide_terms(panel.length, case.work.nodes, case.work.powers)
        event, v, rise = panel_event(slipped, tau_end - clock.tau, panel, sigma, case)
        clock = pass_panel(v, rise, event == NO_EVENT, panel, state, frame, clock, case)
        state, slipped = slide_on(v, rise, state, panel, sigma, case), False
        if event != NO_EVENT:
            return event, state, clock
    return NO_EVENT, state, clock
