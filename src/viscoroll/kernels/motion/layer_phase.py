"""The boundary layer as far as it carries: panel control, outputs."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import N, place, rise_at
from .control import SHARE, creep_weight, path_error
from .layer import (
    D_TAU,
    D_TURN,
    D_X,
    D_Y,
    ROWS,
    Y,
    decays_throughout,
    layer_dense_terms,
    layer_node,
    layer_rise,
    layer_solve,
    manifold,
    slow_creep,
)  # fmt: skip
from .output import put
from .partial_slip import creep_speeds, signed_D, slow_D
from .slow import creep_slope
from .slow_phase import NEWTON, note_nodes
from .stepper import PARTIAL

#: longest panel in e-folds, shortest beside the first guess, and most growth from one to the next
_LONGEST, _SHORTEST, _GROWTH = 6.0, 1e-2, 6.0
#: near eta = 0 the law bends on the scale 1/alpha: share of it in the first panel at rtol = 1, whose nodes lie as
#: this power, and by how much longer the next is
_FIRST, _GRADED, _SECOND = 50.0, 3, 3.0
#: substitution stops at this share of the tolerance of a panel: what it leaves spoils the next estimate
_SUBSTITUTION = 1e-3
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.02
#: a panel that would end this little short of delta = 0 or of the end of the layer, or behind, ends there
_NEARLY = 1.3
#: distance from the manifold at which the layer is over, over its tolerance
_OVER = 0.3
#: e over zeta below which the layer is left where a panel fails: rounding spoils the rate of e
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
    error = max(y_off, tau_off * rate, path_error(X, X_off, X + turn, turn_off, travelled, _OVERSTATED))
    return _OVERSTATED * error / (SHARE * rtol)


@kernel
def layer_outputs(tau_out, at, tau, rise, u, e, length, power, direction, slow, powers, scene, gamma, offset, out):
    """Outputs within the panel; the next column."""
    v = 0.0
    while at < tau_out.size and tau_out[at] <= tau + rise:
        since = tau_out[at] - tau
        v = place(since, max(v, 2.0 * max(since / rise, 0.0) ** (1.0 / power)), powers, 0)
        y, X = u[0] + rise_at(v, powers, 3), rise_at(v, powers, 1)
        V, delta = creep_speeds(y, slow_creep(y, slow)[0] + e * np.exp(-length * (0.5 * v) ** power), scene)
        put(out, at, direction, PARTIAL, V, V * (1.0 + delta), delta,
            offset[0] + direction * (u[2] + X),
            offset[1] + direction * (u[3] + X + rise_at(v, powers, 2)), gamma)  # fmt: skip
        at += 1
    return at


@kernel
def above_manifold(y, D, rtol, slow, work, scene):
    """e at (y, D), with the manifold around it solved for; NaN if there is none."""
    values, matrix, right, _ = work
    if not manifold(y, D, max(NEWTON * SHARE * rtol, 1e-12), values, matrix, right, slow, scene):
        return np.nan
    return D - slow_creep(y, slow)[0]


@kernel
def tolerated(y, rtol, slow, work):
    """Distance from the manifold that no longer matters."""
    per = np.exp(-y)
    share = slow_creep(y, slow)[0] * per
    return _OVER * SHARE * rtol / max(creep_weight(share) * per, creep_slope(1, work[0]))


@kernel
def panel_size(e, length, power, to_zero, rtol, travelled, nodes, slow, scene):
    """(Length, error over its tolerance) of the panel from node 0; infinite where it failed."""
    solved = layer_solve(e, length, power, to_zero, max(_SUBSTITUTION * SHARE * rtol, 1e-14), nodes, slow, scene)
    if not (solved > 0.0 and decays_throughout(nodes)):
        return length, np.inf
    return solved, panel_error(solved, rtol, travelled, nodes)


@kernel
def next_panel(length, power, size):
    """Length of the panel that should meet the tolerance, after one with this error."""
    if not size < 1e300:
        return 0.3 * length
    if power == 1:
        return length * max(0.1, min(_GROWTH, 0.9 * (size + 1e-30) ** (-1.0 / N)))
    # the bend at eta = 0 sets the error of graded nodes, and is left behind with them
    return length * (_SECOND if size <= 1.0 else max(0.1, 0.9 * size ** (-1.0 / 3.0)))


@kernel
def pass_on(length, power, u, travelled, nodes):
    """Put u and node 0 at the end of the panel."""
    X, _ = layer_rise(D_X, 0.5 * length, nodes)
    turn, _ = layer_rise(D_TURN, 0.5 * length, nodes)
    u[0] = nodes[Y, N]
    u[2] += X
    u[3] += X + turn
    travelled[0] += abs(X)
    travelled[1] += abs(X + turn)
    nodes[Y, 0] = nodes[Y, N]
    for row in range(D_Y, ROWS):
        nodes[row, 0] = nodes[row, N] / power


@kernel
def fastest(nodes):
    """max(V, omega) at the right end."""
    V = nodes[D_X, N] / nodes[D_TAU, N]
    return V * max(1.0, 1.0 + nodes[D_TURN, N] / nodes[D_X, N])


@kernel
def layer_phase(u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, max_steps, steps,
                out, step_ends, ends, work, nodes, slow):  # fmt: skip
    """Follow the layer from u until it is over, outputs end, or a panel fails.

    Returns (whether it is over, tau, next column, steps, ends noted).
    """
    D, zeta = signed_D(u[0], u[1], scene), np.exp(u[0])
    e = above_manifold(u[0], D, rtol, slow, work, scene)
    if np.isnan(e):
        return False, tau, at, steps, ends
    known, crosses = u[0], D * (D - e) < 0.0
    left = np.log(abs(e) / tolerated(u[0], rtol, slow, work))
    length = _FIRST * rtol ** (1.0 / 3.0) * (zeta - abs(D) + 1.0 / scene.material.alpha) / abs(e)
    shortest, stretch, power = _SHORTEST * length, _NEARLY, _GRADED
    nodes[Y, 0] = u[0]
    for row in range(D_Y, ROWS):
        nodes[row, 0] = 0.0
    while at < tau_out.size and steps < max_steps and left > 0.0:
        # delta = 0, where the law bends, and the end of the layer are ends of panels
        zero = np.log(-e / slow_creep(u[0], slow)[0]) if crosses else left
        length = min(length, _LONGEST)
        if stretch * length >= min(zero, left):
            length = min(zero, left)
        to_zero = crosses and length == zero
        length, size = panel_size(e, length, power, to_zero, rtol, travelled, nodes, slow, scene)
        steps += 1
        if not size <= 1.0 and abs(e) > _ROUNDING * zeta:
            stretch = 1.0
            if size == np.inf and u[0] != known:
                # perhaps the panel ends where the manifold is not known yet
                known = u[0]
                renewed = above_manifold(known, slow_creep(known, slow)[0] + e, rtol, slow, work, scene)
                if renewed * e > 0.0:
                    e, left = renewed, np.log(renewed / e) + left
                    layer_node(0, e, 1.0, nodes, slow, scene)
                    continue
            length = next_panel(length, power, size)
            if length >= shortest:
                continue
        if not size <= 1.0 or (rest > 0.0 and fastest(nodes) < rest):
            break
        rise, _ = layer_rise(D_TAU, 0.5 * length, nodes)
        if tau_out[at] <= tau + rise or ends < step_ends.size:
            powers = work[3]
            layer_dense_terms(0.5 * length, nodes, powers)
            at = layer_outputs(
                tau_out, at, tau, rise, u, e, length, power, direction, slow, powers, scene, gamma, offset, out
            )
            ends = note_nodes(tau, powers, gamma, step_ends, ends)
        pass_on(length, power, u, travelled, nodes)
        tau += rise
        left -= length
        e *= np.exp(-length)
        crosses, stretch = crosses and not to_zero, _NEARLY
        length, power = next_panel(length, power, size), 1
    u[1] = slow_creep(u[0], slow)[0] + e - slow_D(u[0], scene)[0]
    return left <= 0.0 or abs(e) <= _ROUNDING * zeta, tau, at, steps, ends
