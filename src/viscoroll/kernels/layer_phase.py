"""The boundary layer as far as it carries: panel control, outputs."""

from __future__ import annotations

import numpy as np

from .collocation import N, place, polynomial
from .control import SHARE, creep_weight
from .jit import kernel
from .layer import (
    D_TAU,
    D_TURN,
    D_X,
    D_Y,
    ROWS,
    Y,
    decays_throughout,
    layer_dense_terms,
    layer_rise,
    layer_solve,
    manifold,
    slow_creep,
)  # fmt: skip
from .motion_output import put
from .partial_slip import creep_speeds, signed_D, slow_D
from .slow_phase import note_nodes, NEWTON, OVERSTATED
from .stepper import PARTIAL

#: panels in e-folds: longest, and shortest beside the first guess
_FIRST, _LONGEST, _SHORTEST = 0.5, 6.0, 1e-2
_GROWTH = 6.0
_GRADED = 3
#: a panel that would end this little short of delta = 0 or of the end of the layer, or behind, ends there
_NEARLY = 1.3
#: distance from the manifold at which the layer is over, over its tolerance
_OVER = 0.3


@kernel
def first_panel(u, D, e, par):
    """Length of the first panel: near eta = 0 the law bends on the scale 1/alpha."""
    return _FIRST * (np.exp(u[0]) - abs(D) + 1.0 / par[0]) / abs(e)


@kernel
def panel_error(length, rtol, travelled, nodes):
    """Error of the interpolants over their tolerances."""
    half = 0.5 * length
    _, y_off = layer_rise(D_Y, half, nodes)
    _, tau_off = layer_rise(D_TAU, half, nodes)
    X, X_off = layer_rise(D_X, half, nodes)
    turn, turn_off = layer_rise(D_TURN, half, nodes)
    rate = abs(nodes[D_Y, N] / nodes[D_TAU, N])
    error = max(y_off, tau_off * rate, X_off / (travelled[0] + X), turn_off / (travelled[1] + abs(X + turn)))
    return OVERSTATED * error / (SHARE * rtol)


@kernel
def layer_outputs(tau_out, at, tau, rise, u, e, length, power, direction, slow, powers, par, gamma, offset, out):
    """Outputs within the panel; the next column."""
    t = -1.0
    while at < tau_out.size and tau_out[at] <= tau + rise:
        since = tau_out[at] - tau
        t = place(since, max(t, 2.0 * since / rise - 1.0), powers, 0)
        y, X = u[0] + polynomial(t, powers, 3), polynomial(t, powers, 1)
        V, delta = creep_speeds(y, slow_creep(y, slow)[0] + e * np.exp(-length * (0.5 * (1.0 + t)) ** power), par)
        put(out, at, direction, PARTIAL, V, V * (1.0 + delta), delta,
            offset[0] + direction * (u[2] + X),
            offset[1] + direction * (u[3] + X + polynomial(t, powers, 2)), gamma)  # fmt: skip
        at += 1
    return at


@kernel
def layer_phase(u, tau, tau_out, at, direction, par, gamma, offset, travelled, rtol, rest, max_steps, steps,
                out, step_ends, ends, work):  # fmt: skip
    """Follow the layer from u until it is over, outputs end, or a panel fails.

    Returns (whether it is over, tau, next column, steps, ends noted).
    """
    values, matrix, right, powers, nodes, slow = work
    tolerance = NEWTON * SHARE * rtol
    if not manifold(u[0], tolerance, values, matrix, right, slow, par):
        return False, tau, at, steps, ends
    S, _ = slow_creep(u[0], slow)
    D = signed_D(u[0], u[1], par)
    e = D - S
    over = _OVER * SHARE * rtol / max(creep_weight(S * np.exp(-u[0])) * np.exp(-u[0]), values[1, 8])
    length = first_panel(u, D, e, par)
    shortest = _SHORTEST * length
    nodes[Y, 0] = u[0]
    for row in range(D_Y, ROWS):
        nodes[row, 0] = 0.0
    power = _GRADED
    crosses, left = D * S < 0.0, np.log(abs(e) / over)
    while at < tau_out.size and steps < max_steps and left > 0.0:
        length = min(length, _LONGEST)
        length = left if _NEARLY * length > left else length
        zero = np.log(-e / slow_creep(u[0], slow)[0]) if crosses else np.inf
        to_zero = _NEARLY * length > zero
        if to_zero:
            length = zero
        solved = layer_solve(e, length, power, to_zero, tolerance, nodes, slow, par)
        steps += 1
        size = np.inf
        if solved > 0.0 and decays_throughout(nodes):
            length = solved
            size = panel_error(length, rtol, travelled, nodes)
        if not size <= 1.0:
            length *= max(0.2, 0.9 * size ** (-1.0 / N)) if size < 1e300 else 0.3
            length = min(length, 0.5 * zero)
            if length < shortest:
                break
            continue
        if rest > 0.0 and fastest(nodes) < rest:
            break
        half = 0.5 * length
        rise, X, turn = layer_rise(D_TAU, half, nodes)[0], layer_rise(D_X, half, nodes)[0], layer_rise(D_TURN, half, nodes)[0]
        if tau_out[at] <= tau + rise or ends < step_ends.size:
            layer_dense_terms(half, nodes, powers)
            at = layer_outputs(tau_out, at, tau, rise, u, e, length, power, direction, slow, powers, par, gamma, offset, out)
            ends = note_nodes(tau, powers, gamma, step_ends, ends)
        u[0] = nodes[Y, N]
        u[2] += X
        u[3] += X + turn
        travelled[0] += abs(X)
        travelled[1] += abs(X + turn)
        tau += rise
        e *= np.exp(-length)
        left -= length
        nodes[Y, 0] = nodes[Y, N]
        for row in range(D_Y, ROWS):
            nodes[row, 0] = nodes[row, N] / power
        power = 1
        crosses = crosses and not to_zero
        length *= max(0.2, min(_GROWTH, 0.9 * (size + 1e-30) ** (-1.0 / N)))
    u[1] = slow_creep(u[0], slow)[0] + e - slow_D(u[0], par)[0]
    return left <= 0.0, tau, at, steps, ends


@kernel
def fastest(nodes):
    """max(V, omega) at the right end."""
    V = nodes[D_X, N] / nodes[D_TAU, N]
    return V * max(1.0, 1.0 + nodes[D_TURN, N] / nodes[D_X, N])
