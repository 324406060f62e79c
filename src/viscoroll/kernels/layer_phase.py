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
from .slow_phase import NEWTON, note_nodes
from .stepper import PARTIAL

#: panels in e-folds: longest, and shortest beside the first guess
_LONGEST, _SHORTEST = 6.0, 1e-2
#: near eta = 0 the law bends on the scale 1/alpha: share of it in the first panel at rtol = 1
_FIRST = 50.0
_GROWTH = 6.0
_GRADED = 3
#: substitution stops at this share of the tolerance of a panel: what it leaves spoils the next estimate
_SUBSTITUTION = 1e-3
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.01
#: a panel that would end this little short of delta = 0 or of the end of the layer, or behind, ends there
_NEARLY = 1.3
#: distance from the manifold at which the layer is over, over its tolerance
_OVER = 0.3
#: e over zeta below which a panel that fails is no longer tried again: rounding spoils the rate of e
_ROUNDING = 1e-6


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
    return _OVERSTATED * error / (SHARE * rtol)


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
def above_manifold(y, D, rtol, values, matrix, right, slow, par):
    """e at (y, D), with the manifold around it solved for; NaN if there is none."""
    if not manifold(y, D, max(NEWTON * SHARE * rtol, 1e-12), values, matrix, right, slow, par):
        return np.nan
    return D - slow_creep(y, slow)[0]


@kernel
def layer_phase(u, tau, tau_out, at, direction, par, gamma, offset, travelled, rtol, rest, max_steps, steps,
                out, step_ends, ends, work):  # fmt: skip
    """Follow the layer from u until it is over, outputs end, or a panel fails.

    Returns (whether it is over, tau, next column, steps, ends noted).
    """
    values, matrix, right, powers, nodes, slow = work
    tolerance = max(_SUBSTITUTION * SHARE * rtol, 1e-14)
    D = signed_D(u[0], u[1], par)
    e = above_manifold(u[0], D, rtol, values, matrix, right, slow, par)
    if np.isnan(e):
        return False, tau, at, steps, ends
    known, S = u[0], D - e
    per = np.exp(-u[0])
    over = _OVER * SHARE * rtol / max(creep_weight(S * per) * per, values[1, 8])
    length = _FIRST * rtol ** (1.0 / 3.0) * (1.0 / per - abs(D) + 1.0 / par[0]) / abs(e)
    shortest = _SHORTEST * length
    nodes[Y, 0] = u[0]
    for row in range(D_Y, ROWS):
        nodes[row, 0] = 0.0
    power = _GRADED
    crosses, left, stretch = D * S < 0.0, np.log(abs(e) / over), _NEARLY
    while at < tau_out.size and steps < max_steps and left > 0.0:
        zero = np.log(-e / slow_creep(u[0], slow)[0]) if crosses else left
        length = min(length, _LONGEST)
        if stretch * length >= min(zero, left):
            length = min(zero, left)
        to_zero = crosses and length == zero
        solved = layer_solve(e, length, power, to_zero, tolerance, nodes, slow, par)
        steps += 1
        size = np.inf
        if solved > 0.0 and decays_throughout(nodes):
            length = solved
            size = panel_error(length, rtol, travelled, nodes)
        if not size <= 1.0:
            stretch = 1.0
            if abs(e) * per < _ROUNDING:
                break
            if size == np.inf and u[0] != known:
                # perhaps the panel ends where the manifold is not known
                known, D = u[0], slow_creep(u[0], slow)[0] + e
                renewed = above_manifold(u[0], D, rtol, values, matrix, right, slow, par)
                if not renewed * e > 0.0:
                    break
                e, left = renewed, np.log(abs(renewed) / over)
                continue
            order = N if power == 1 else 3
            length *= max(0.1, 0.9 * size ** (-1.0 / order)) if size < 1e300 else 0.3
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
        crosses, stretch = crosses and not to_zero, _NEARLY
        # what graded nodes are for, the law's bend at eta = 0, is left behind
        length *= _GROWTH / 2 if power > 1 else max(0.2, min(_GROWTH, 0.9 * (size + 1e-30) ** (-1.0 / N)))
        power = 1
    u[1] = slow_creep(u[0], slow)[0] + e - slow_D(u[0], par)[0]
    return left <= 0.0, tau, at, steps, ends


@kernel
def fastest(nodes):
    """max(V, omega) at the right end."""
    V = nodes[D_X, N] / nodes[D_TAU, N]
    return V * max(1.0, 1.0 + nodes[D_TURN, N] / nodes[D_X, N])
