"""Events of a motion: their functions, and their location to rounding.

An event is located by repeating the step with other lengths until its own end lies on the
event, so that the located state is as accurate as any other step and not an interpolation.
"""

from __future__ import annotations

import numpy as np

from .full_slip import onset, onset_slope
from .jit import kernel
from .partial_slip import partial_speeds, signed_D
from .stepper import FULL, PARTIAL, REST, step

NO_EVENT, STICK, SLIP, REVERSAL, AT_REST = range(5)
_LOCATE_CAP = 80
#: a stick zone that starts at eta = 0 may round to below it before it grows
_ROUNDING = 1e-15


@kernel
def speeds(regime, u0, u1, par):
    """(V, omega, delta) in the frame of the unknowns."""
    if regime == PARTIAL:
        V, delta = partial_speeds(u0, u1, par)
        return V, V * (1.0 + delta), delta
    if regime == REST:
        return 0.0, 0.0, 0.0
    omega = (u0 - u1) / par[4]
    slip = omega - u0
    if u0 == 0.0:
        return u0, omega, np.copysign(np.inf, slip)
    return u0, omega, slip / u0


@kernel
def event_value(event, regime, u, sigma, par, rest):
    """Positive before the event, negative after it."""
    if event == REVERSAL:
        return u[0]
    if event == STICK:
        return onset(u[0], u[1], sigma, par)
    if event == SLIP:
        return 1.0 - abs(signed_D(u[0], u[1], par)) * np.exp(-u[0])
    V, omega, _ = speeds(regime, u[0], u[1], par)
    return max(abs(V), abs(omega)) - rest


@kernel
def locate(event, regime, u, h, J, sigma, par, rest, K, new):
    """Length of the step whose end lies on the event, by the Illinois method; fills ``new``."""
    low, high = 0.0, h
    at_low = event_value(event, regime, u, sigma, par, rest)
    at_high = event_value(event, regime, new, sigma, par, rest)
    side = 0
    for _ in range(_LOCATE_CAP):
        if high - low <= 4e-16 * high or at_high == 0.0:
            break
        middle = (at_low * high - at_high * low) / (at_low - at_high)
        if not (low < middle < high):
            middle = 0.5 * (low + high)
            if not (low < middle < high):
                break
        step(regime, u, middle, J, sigma, par, K, new)
        value = event_value(event, regime, new, sigma, par, rest)
        if value > 0.0:
            low, at_low = middle, value
            if side == 1:
                at_high *= 0.5
            side = 1
        else:
            high, at_high = middle, value
            if side == -1:
                at_low *= 0.5
            side = -1
    step(regime, u, high, J, sigma, par, K, new)
    return high


@kernel
def first_event(regime, u, h, J, sigma, par, rest, stick_end, K, new):
    """(event, length): the first event within the step, if any, with ``new`` on it.

    ``stick_end`` is |D|/zeta at the end of the step; the stick zone has gone where it exceeds 1.
    """
    event = NO_EVENT
    if regime == FULL:
        if new[0] < 0.0:
            h = locate(REVERSAL, regime, u, h, J, sigma, par, rest, K, new)
            event = REVERSAL
            new[0] = 0.0
        if onset(new[0], new[1], sigma, par) < 0.0:
            h = locate(STICK, regime, u, h, J, sigma, par, rest, K, new)
            event = STICK
        elif event == NO_EVENT and dips(u, new, h, sigma, par):
            return STICK, -1.0
    elif stick_end > 1.0 + _ROUNDING:
        h = locate(SLIP, regime, u, h, J, sigma, par, rest, K, new)
        event = SLIP
    if rest > 0.0 and event_value(AT_REST, regime, new, sigma, par, rest) < 0.0:
        h = locate(AT_REST, regime, u, h, J, sigma, par, rest, K, new)
        event = AT_REST
    return event, h


@kernel
def dips(u, new, h, sigma, par):
    """Whether the onset function may have gone below zero and back within the step."""
    before = onset_slope(u[0], u[1], sigma, par)
    after = onset_slope(new[0], new[1], sigma, par)
    if not (before < 0.0 < after):
        return False
    lowest = onset(u[0], u[1], sigma, par) + 0.5 * before * h * before / (before - after)
    return lowest < 0.0
