"""Events of a motion; those of steps in partial slip: their functions, and their location to rounding.

An event is located on the dense output first, then by repeating the step with that length,
corrected once or twice, until its own end lies on the event: the located state is as accurate
as any other step and not an interpolation.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy
from ..numerics.bracket import narrowed, secant
from .explicit import explicit_dense_terms, explicit_step, slope_at
from .full_slip import sliding_speed
from .partial_slip import partial_speeds, signed_D
from .stepper import PARTIAL, REST, dense, dense_terms, stiff_step

EXPLICIT, STIFF = range(2)
NO_EVENT, STICK, SLIP, REVERSAL, AT_REST = range(5)
_LOCATE_CAP = 80
#: how close to the event the dense output is searched, and the share of a step its slope there is taken over
_NEAR, _DIFFERENCE = 1e-9, 1e-4
#: steps repeated at most: each gains the error of that slope, 1e-4 or less
_CORRECTIONS = 4
#: a correction of this share of the step leaves no more than rounding, so that the next is not needed
_LAST = 1e-11
#: a stick zone that starts at eta = 0 may round to below it before it grows
_ROUNDING = 1e-15


@kernel
def speeds(regime, u0, u1, scene):
    """(V, omega, delta) in the frame of the unknowns."""
    if regime == PARTIAL:
        V, delta = partial_speeds(u0, u1, scene)
        return V, V * (1.0 + delta), delta
    if regime == REST:
        return 0.0, 0.0, 0.0
    V = sliding_speed(u0, scene)
    omega = (V - u1) / scene.j
    slip = omega - V
    return V, omega, np.copysign(np.inf, slip) if V == 0.0 else slip / V


@kernel
def event_value(event, u0, u1, scene, rest):
    """Positive before the event, negative after it."""
    if event == SLIP:
        return 1.0 - abs(signed_D(u0, u1, scene)) * np.exp(-u0)
    V, delta = partial_speeds(u0, u1, scene)
    return V * max(1.0, abs(1.0 + delta)) - rest


@kernel
def advance(method, u, slope, h, scene, K, new, error):
    """One step by the method, with the slope at its end in K[12]; the rate at which the offset relaxes there."""
    if method == EXPLICIT:
        copy(slope, K[0])
        explicit_step(u, h, scene, K, new, error)
    else:
        stiff_step(u, h, scene, K, new, error)
    return slope_at(new, scene, K[12])


@kernel
def interpolant(method, u, new, h, scene, K, terms):
    """Coefficients of the dense output of the step just taken."""
    if method == EXPLICIT:
        explicit_dense_terms(u, new, h, scene, K, terms)
    else:
        dense_terms(K, terms)


@kernel
def _value_within(theta, event, u, new, terms, scene, rest):
    """Event value at the fraction theta of the step, by its dense output."""
    u0, u1 = dense(theta, u, new, terms, 0), dense(theta, u, new, terms, 1)
    return event_value(event, u0, u1, scene, rest)


@kernel
def _root(event, u, new, terms, scene, rest):
    """(theta, d value/d theta) where the dense output meets the event, by the Illinois method."""
    low, high = 0.0, 1.0
    at_low = event_value(event, u[0], u[1], scene, rest)
    at_high = event_value(event, new[0], new[1], scene, rest)
    side = 0
    for _ in range(_LOCATE_CAP):
        if high - low <= _NEAR * high or at_high == 0.0:
            break
        middle = secant(low, high, at_low, at_high)
        if not (low < middle < high):
            middle = 0.5 * (low + high)
        value = _value_within(middle, event, u, new, terms, scene, rest)
        if abs(value) <= _NEAR * abs(at_low - at_high):
            high, at_high = middle, value
            break
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, middle, value)
    near, far = max(high - _DIFFERENCE, 0.0), min(high + _DIFFERENCE, 1.0)
    before = _value_within(near, event, u, new, terms, scene, rest)
    after = _value_within(far, event, u, new, terms, scene, rest)
    return high, (after - before) / (far - near)


@kernel
def locate(event, method, u, slope, h, scene, rest, K, new, error, terms):
    """Length of the step whose end lies on the event; fills ``new``."""
    interpolant(method, u, new, h, scene, K, terms)
    theta, fall = _root(event, u, new, terms, scene, rest)
    length = theta * h
    for _ in range(_CORRECTIONS):
        advance(method, u, slope, length, scene, K, new, error)
        change = event_value(event, new[0], new[1], scene, rest) * h / fall
        if not abs(change) > _ROUNDING * length:
            return length
        length = min(max(length - change, 0.0), h)
        if abs(change) <= _LAST * length:
            break
    advance(method, u, slope, length, scene, K, new, error)
    return length


@kernel
def first_event(method, u, slope, h, scene, rest, share, K, new, error, terms):
    """(event, length): the first event within the step in partial slip, if any, with ``new`` on it.

    ``share`` is D/zeta at the end of the step; the stick zone has gone where it exceeds 1.
    """
    event = NO_EVENT
    if abs(share) > 1.0 + _ROUNDING:
        h = locate(SLIP, method, u, slope, h, scene, rest, K, new, error, terms)
        event = SLIP
    if rest > 0.0 and event_value(AT_REST, new[0], new[1], scene, rest) < 0.0:
        h = locate(AT_REST, method, u, slope, h, scene, rest, K, new, error, terms)
        event = AT_REST
    return event, h
