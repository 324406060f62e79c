"""The slow manifold as far as it carries: interval control, outputs, rest."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy
from .collocation import NODES, SLOPES, N, place, rise_at
from .control import SHARE, creep_weight, path_error, slip_share
from .events import AT_REST, NO_EVENT
from .output import put
from .slow import (
    REACHED,
    project,
    slow_dense_terms,
    slow_quadratures,
    slow_solve,
    slow_start,
    slow_state,
    sticks_throughout,
)  # fmt: skip
from .stepper import PARTIAL

#: first, longest and shortest interval in ln zeta
_FIRST, _LONGEST, _SHORTEST = 0.5, 2.5, 0.02
#: relaxation over an interval, in e-folds, below which it is no business of this module
_STIFF = 20.0
#: Newton stops at this share of the tolerance of an interval
NEWTON = 0.05
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.05


@kernel
def attempt(u, length, rtol, travelled, values, matrix, right, scene):
    """One interval: (error of its interpolants, and of the offset at its left end, over their tolerances;
    rise of tau, X and angle).  The errors are infinite where it failed."""
    solved = slow_solve(u[0], length, NEWTON * SHARE * rtol, SLOPES, values, matrix, right, scene)
    if not (solved and sticks_throughout(u[0], length, values)):
        return np.inf, np.inf, 0.0, 0.0, 0.0
    rest = abs(project(values))
    tau, X, angle, tau_off, X_off, turn_off = slow_quadratures(length, values)
    error = max(tau_off * values[0, 1], path_error(X, X_off, angle, turn_off, travelled, _OVERSTATED))
    per = 1.0 / (SHARE * rtol)
    offset_error = rest * max(creep_weight(slip_share(u, scene)) * np.exp(-u[0]), values[0, 8])
    return _OVERSTATED * error * per, offset_error * per, tau, X, angle


@kernel
def next_interval(length, size):
    """Length of the interval that should meet the tolerance, after one with this error."""
    if not size < 1e300:
        return 0.3 * length
    return length * max(0.2, min(4.0, 0.9 * (size + 1e-30) ** (-1.0 / N)))


@kernel
def to_rest(u, length, rtol, rest, travelled, values, matrix, right, scene):
    """Length of the interval at whose end max(V, omega) = rest, by Newton on its logarithm; its rises."""
    result = attempt(u, length, rtol, travelled, values, matrix, right, scene)
    for _ in range(8):
        excess = np.log(_fastest(values) / rest)
        change = -excess * values[N, 1] / values[N, 5]
        length += change
        result = attempt(u, length, rtol, travelled, values, matrix, right, scene)
        if abs(change) < 1e-15 * abs(u[0]) + 1e-15:
            break
    return length, result[2], result[3], result[4]


@kernel
def _fastest(values):
    """max(V, omega) at the right end."""
    return values[N, 3] * max(1.0, 1.0 + values[N, 4])


@kernel
def slow_outputs(tau_out, at, tau, rise, u, length, direction, powers, gamma, offset, out):
    """Outputs within the interval; the next column."""
    v = 0.0
    while at < tau_out.size and tau_out[at] <= tau + rise:
        since = tau_out[at] - tau
        v = place(since, max(v, 2.0 * since / rise), powers, 0)
        V, delta, X, angle = slow_state(v, length, powers)
        put(out, at, direction, PARTIAL, V, V * (1.0 + delta), delta,
            offset[0] + direction * (u[2] + X), offset[1] + direction * (u[3] + angle), gamma)  # fmt: skip
        at += 1
    return at


@kernel
def note_nodes(tau, powers, gamma, step_ends, ends):
    """Times of the nodes among the ends of steps; how many there are now."""
    for i in range(1, N + 1):
        if ends < step_ends.size:
            step_ends[ends] = (tau + rise_at(1.0 + NODES[i], powers, 0)) / gamma
            ends += 1
    return ends


@kernel
def slow_phase(u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, far, max_steps, steps,
               out, step_ends, ends, work):  # fmt: skip
    """Follow the slow manifold from u until outputs end, zeta exceeds exp(far), or an interval fails.

    Returns (event, tau, next column, steps, ends noted, time to try again).
    """
    values, matrix, right, powers = work
    tau_end = tau_out[tau_out.size - 1]
    length, entering, before = _FIRST, True, np.inf
    slow_start(u[0], u[1], values, scene)
    relaxation = -values[REACHED, 7]
    while at < tau_out.size and u[0] < far and steps < max_steps:
        length = min(length, _LONGEST, max(1.1 * (tau_end - tau) * values[REACHED, 1], 0.05))
        size, offset_size, rise, X, angle = attempt(u, length, rtol, travelled, values, matrix, right, scene)
        steps += 1
        # what is left of the layer stays as the interval is shortened; what the interval does not resolve falls
        if size <= 1.0 < offset_size and entering and offset_size > 0.5 * before:
            return NO_EVENT, tau, at, steps, ends, tau + max(np.log(offset_size), 1.0) / relaxation
        size, before = max(size, offset_size), offset_size
        if not size <= 1.0:
            length = next_interval(length, size)
            if length < _SHORTEST or relaxation * length < _STIFF * values[REACHED, 1]:
                return NO_EVENT, tau, at, steps, ends, tau + _STIFF / relaxation
            continue
        entering = False
        ahead = next_interval(length, size)
        rested = rest > 0.0 and _fastest(values) < rest
        if rested:
            length, rise, X, angle = to_rest(u, length, rtol, rest, travelled, values, matrix, right, scene)
        inside = tau_out[at] <= tau + rise or ends < step_ends.size
        if inside:
            slow_dense_terms(length, values, powers)
            at = slow_outputs(tau_out, at, tau, rise, u, length, direction, powers, gamma, offset, out)
            ends = note_nodes(tau, powers, gamma, step_ends, ends)
        u[0] += length
        u[1] = values[N, 0]
        u[2] += X
        u[3] += angle
        travelled[0] += abs(X)
        travelled[1] += abs(angle)
        tau += rise
        if rested:
            return AT_REST, tau, at, steps, ends, tau
        copy(values[N], values[REACHED])
        relaxation = -values[REACHED, 7]
        length = ahead
    return NO_EVENT, tau, at, steps, ends, tau
