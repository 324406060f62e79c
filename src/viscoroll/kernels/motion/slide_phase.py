"""Full slip to its end: panel control, events, outputs."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import contact_length
from .collocation import NODES, N, place, rise_at
from .control import SHARE
from .events import AT_REST, NO_EVENT, REVERSAL, STICK
from .full_slip import sliding, sliding_scale, sliding_speed, standstill
from .output import put
from .slide import (
    SLIP,
    SPEED,
    TAU,
    V,
    dip,
    event_at,
    locate_slide,
    s_at,
    slide_error,
    slide_rates,
    slide_rise,
    slide_state,
    slide_sums,
    slide_terms,
    standing_rates,
)  # fmt: skip
from .slow_phase import next_interval
from .stepper import FULL

#: the first panel at rtol = 1, the longest, and the shortest
_FIRST, _LONGEST, _SHORTEST = 4.8, 4.0, 1e-9
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.03
#: errors of V weigh more than its share of the speeds says: what is left of V + j omega at onset may be small
_SLIDING = 150.0
#: how much beyond the place that is expected for its end a panel goes
_BEYOND = 1.05
#: change of V over V up to which s changes in proportion
_NEAR = 0.1
#: slip less its limit, over the speeds, at which a start is on the edge; halvings of a panel searched for an opening
_ON_EDGE, _HALVINGS = 1e-12, 40
#: share of the whole time that rounding may leave of it behind an event
_AT_THE_END = 2.0**-51
#: share of rtol by which V may still be off where it is taken to stand still
_HELD = 0.1


@kernel
def choose_pole(s, sigma, scene):
    """The pole of the panels from s on."""
    material, kappa, mu, _ = scene
    c = material.c
    standing = standstill(scene) if sigma > 0.0 else np.nan
    # beyond a second such speed V rises
    if (standing - s) * sliding(s, sigma, scene)[1] >= 0.0:
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
        length = -_BEYOND * duration * rate / (per_s * (pole - s))
        return length, s + (s - pole) * np.expm1(length)
    ahead = V + rate * duration
    if ahead <= 0.0:
        return -np.log1p(-s / pole), 0.0
    change = rate * duration * _BEYOND
    end = s + change / per_s
    if abs(change) > _NEAR * V:
        lam, _ = contact_length(kappa * ahead, material)
        end = 2.0 * kappa * ahead / lam
        mean = 0.5 * (half_M + sliding(end, sigma, scene)[3])
        change = (sigma * mu - mean) * _duration(closing + less * mean, omega, V, sigma, left) * _BEYOND
        if change * rate > 0.0:
            end *= max(V + change, 0.0) / ahead
        change = (end - s) * per_s
    return np.log1p(change / (per_s * (s - pole))), end


@kernel
def opening(high, panel, sigma, scene, rest, powers):
    """v before ``high`` at which slip that starts on its limit is beyond it, if only for a moment; 0 if nowhere."""
    v = high
    for _ in range(_HALVINGS):
        v *= 0.5
        if event_at(STICK, v, panel, sigma, scene, rest, powers) > 0.0:
            return v
    return 0.0


@kernel
def panel_event(slipped, panel, sigma, scene, rest, nodes, powers):
    """(event, v): the first event on the panel, else none and its end.

    Where the stick zone has just gone (``slipped``), slip that rounding keeps below its limit does not end at once.
    """
    event, low, high = NO_EVENT, 0.0, 2.0
    for i in range(1, N + 1):
        if nodes[SLIP, i] < 0.0 or nodes[SPEED, i] < rest:
            event, low, high = STICK if nodes[SLIP, i] < 0.0 else AT_REST, 1.0 + NODES[i - 1], 1.0 + NODES[i]
            break
    if event == NO_EVENT:
        v = dip(nodes, powers)
        if not (0.0 < v < 2.0 and event_at(STICK, v, panel, sigma, scene, rest, powers) < 0.0):
            return NO_EVENT, 2.0
        event, high = STICK, v
        for i in range(1, N):
            low = 1.0 + NODES[i] if 1.0 + NODES[i] < v else low
    if event == STICK and low == 0.0 and nodes[SLIP, 0] <= _ON_EDGE * nodes[SPEED, 0]:
        low = opening(high, panel, sigma, scene, rest, powers)
        if low == 0.0:
            return (NO_EVENT, 2.0) if slipped else (STICK, 0.0)
    v = locate_slide(event, low, high, panel, sigma, scene, rest, nodes, powers)
    if event == STICK and rest > 0.0 and event_at(AT_REST, v, panel, sigma, scene, rest, powers) < 0.0:
        return AT_REST, locate_slide(AT_REST, low, v, panel, sigma, scene, rest, nodes, powers)
    return event, v


@kernel
def slide_outputs(tau_out, at, tau, end, closed, panel, direction, sigma, powers, u, scene, gamma, offset, out):
    """Outputs before ``end``, and, if ``closed``, on it; the next column."""
    v = 0.0
    while at < tau_out.size and (tau_out[at] < tau + end or (closed and tau_out[at] == tau + end)):
        since = tau_out[at] - tau
        v = place(since, max(v, 2.0 * since / end if since > 0.0 else 0.0), powers, TAU)
        V, omega, X, angle = slide_state(v, since, panel, sigma, scene, powers)
        slip = omega - V
        delta = np.copysign(np.inf, slip) if V == 0.0 else slip / V
        put(out, at, direction, FULL, V, omega, delta,
            offset[0] + direction * (u[2] + X), offset[1] + direction * (u[3] + angle), gamma)  # fmt: skip
        at += 1
    return at


@kernel
def stand(u, left, sigma, scene, nodes):
    """The panel on which V stands still until the slip has gone, or for the time ``left``, with its rates filled in."""
    _, _, mu, j = scene
    # the spin may fall by any factor yet, so V is that where it stands
    V = sliding_speed(u[0], scene)
    omega = (V - u[1]) / j
    panel = (u[0], u[0], 1.0, u[0], V, omega)
    standing_rates(min(_BEYOND * left, 0.5 * j * sigma * (omega - V) / mu), panel, sigma, scene, nodes)
    return panel


@kernel
def slide_on(u, v, rise, travelled, panel, sigma, scene, powers):
    """Put u at v, after the time ``rise``."""
    _, _, X, angle = slide_state(v, rise, panel, sigma, scene, powers)
    u[0] = s_at(v, panel)[0]
    u[1] += 2.0 * sigma * scene.mu * rise
    u[2] += X
    u[3] += angle
    travelled[0] += abs(X)
    travelled[1] += abs(angle)


@kernel
def slide_phase(u, tau, slipped, tau_out, at, direction, sigma, scene, gamma, offset, travelled, rtol, rest, max_steps,
                steps, out, step_ends, ends, powers, nodes):  # fmt: skip
    """Slide from u to an event, or until outputs end.  Returns (event, tau, next column, steps, ends noted).

    ``slipped``: u is where the stick zone has gone.
    """
    _, _, mu, j = scene
    tau_end = tau_out[tau_out.size - 1]
    longest, pole = min(_FIRST * rtol ** (1.0 / (N + 1.0)), _LONGEST), choose_pole(u[0], sigma, scene)
    while at < tau_out.size and steps < max_steps:
        steps += 1
        s = u[0]
        here = sliding(s, sigma, scene)
        speed, rate, per_s, _, _ = here
        omega = (speed - u[1]) / j
        if sigma * (omega - speed) <= 0.0:
            return STICK, tau, at, steps, ends
        if tau_end - tau <= _AT_THE_END * tau_end:
            slip = omega - speed
            delta = np.copysign(np.inf, slip) if speed == 0.0 else slip / speed
            for column in range(at, tau_out.size):
                put(out, column, direction, FULL, speed, omega, delta,
                    offset[0] + direction * u[2], offset[1] + direction * u[3], gamma)  # fmt: skip
            return NO_EVENT, tau_end, tau_out.size, steps, ends
        scale = rtol * sliding_scale(speed, u[1], scene)
        if rate == 0.0 or (pole > 0.0 and (abs(s - pole) * per_s <= _HELD * scale or rate * (pole - s) <= 0.0)):
            u[0] = pole if pole > 0.0 else s
            panel = stand(u, tau_end - tau, sigma, scene, nodes)
        else:
            length, end = aim(here, omega, s, pole, tau_end - tau, sigma, scene)
            most = min(longest, np.log(abs(s - pole) * per_s / (0.5 * _HELD * scale)) if pole > 0.0 else longest)
            if abs(length) > most:
                length = np.copysign(most, length)
                end = s + (s - pole) * np.expm1(length)
            panel = (s, pole, length, end, speed, omega)
            if not slide_rates(panel, sigma, scene, nodes):
                longest = next_interval(abs(length), np.inf)
                if longest < _SHORTEST:
                    break
                continue
        length = abs(panel[2])
        rise = slide_sums(panel, sigma, scene, nodes)
        scale = rtol * sliding_scale(nodes[V, N], u[1] + 2.0 * sigma * mu * rise, scene)
        size = _SLIDING * _OVERSTATED * slide_error(length, nodes) / (SHARE * scale)
        if not size <= 1.0:
            longest = next_interval(length, size)
            if longest < _SHORTEST:
                break
            continue
        longest = min(_LONGEST, next_interval(length, size))
        slide_terms(panel[2], nodes, powers)
        event, v = panel_event(slipped, panel, sigma, scene, rest, nodes, powers)
        rise = slide_rise(v, panel, sigma, scene, powers)[2] if v > 0.0 else 0.0
        if event == NO_EVENT and panel[3] == 0.0:
            event = REVERSAL
        if tau + rise > tau_end:
            event = NO_EVENT
        at = slide_outputs(tau_out, at, tau, rise, event == NO_EVENT, panel, direction, sigma, powers, u, scene, gamma,
                           offset, out)  # fmt: skip
        ends = note_panel(tau, rise, v, powers, gamma, step_ends, ends)
        slide_on(u, v, rise, travelled, panel, sigma, scene, powers)
        tau += rise
        slipped = False
        if event != NO_EVENT:
            return event, tau, at, steps, ends
    return NO_EVENT, tau, at, steps, ends


@kernel
def note_panel(tau, rise, v, powers, gamma, step_ends, ends):
    """Times of the nodes before v, and that of v, among the ends of steps; how many there are now."""
    for i in range(1, N + 1):
        if ends < step_ends.size and 1.0 + NODES[i] < v:
            step_ends[ends] = (tau + rise_at(1.0 + NODES[i], powers, TAU)) / gamma
            ends += 1
    if ends < step_ends.size and rise > 0.0:
        step_ends[ends] = (tau + rise) / gamma
        ends += 1
    return ends
