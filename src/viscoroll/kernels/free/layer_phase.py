"""The boundary layer as far as it carries: panel control."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import N
from .control import SHARE, creep_weight, next_length
from .layer import decays_throughout, layer_node, layer_solve, manifold, slow_creep
from .panel import pass_path
from .path import D_TAU, D_TURN, D_X, D_Y, OVERSTATED, Y, next_start, path_mismatch
from .records import LAYER, NO_EVENT, Clock, Panel
from .slow import DELTA_D, REACHED
from .slow_phase import NEWTON

#: longest panel in e-folds, and shortest beside the first guess
_LONGEST, _SHORTEST = 6.0, 1e-2
#: near eta = 0 the law bends on the scale 1/alpha: share of it in the first panel at rtol = 1, whose nodes lie as
#: this power
_FIRST, GRADED = 50.0, 3
#: a panel that would end this little short of delta = 0 or of the end of the layer, or behind, ends there
_NEARLY = 1.3
#: distance from the manifold at which the layer is over, over its tolerance
_OVER = 0.3
#: e over zeta below which the layer is left where a panel fails: rounding spoils the rate of e
_ROUNDING = 1e-6


@kernel
def first_bend(y, D, rtol, scene):
    """How far D may go on a first panel, at the bend of the law near eta = 0."""
    return _FIRST * rtol ** (1.0 / 3.0) * (np.exp(y) - abs(D) + scene.material.tau)


@kernel
def above_manifold(y, D, case):
    """e at (y, D), with the manifold around it solved for; NaN if there is none."""
    if not manifold(y, D, max(NEWTON * SHARE * case.limits.rtol, 1e-12), case.scene, case.work):
        return np.nan
    return D - slow_creep(y, case.work.slow)[0]


@kernel
def tolerated(y, case):
    """Distance from the manifold that no longer matters."""
    per = np.exp(-y)
    share = slow_creep(y, case.work.slow)[0] * per
    return _OVER * SHARE * case.limits.rtol / max(creep_weight(share) * per, case.work.values[REACHED, DELTA_D])


@kernel(inline=True)
def panel_size(e, length, power, to_zero, state, case):
    """(Length, error over its tolerance) of the panel from node 0; infinite where it failed."""
    tolerance, work = SHARE * case.limits.rtol, case.work
    solved = layer_solve(e, length, power, to_zero, tolerance, case.scene, work)
    if not (solved > 0.0 and decays_throughout(work.nodes)):
        return length, np.inf
    creep = abs(e) * work.values[REACHED, DELTA_D]
    return solved, OVERSTATED * path_mismatch(solved, creep, state, work.nodes) / tolerance


@kernel
def layer_start(e, state, nodes):
    """Put node 0 of the first panel, whose nodes are graded, at the state."""
    nodes[Y, 0] = state.first
    for row in (D_Y, D_TAU, D_X, D_TURN):
        nodes[row, 0] = 0.0


@kernel
def layer_phase(state, frame, clock, case):
    """Follow the layer until it is over, outputs end, or a panel fails: (whether it is over, event, state, clock)."""
    limits, sink, work = case.limits, case.sink, case.work
    nodes, zeta = work.nodes, np.exp(state.first)
    e = above_manifold(state.first, state.second, case)
    if np.isnan(e):
        return False, NO_EVENT, state, clock
    known, crosses = state.first, state.second * (state.second - e) < 0.0
    left = np.log(abs(e) / tolerated(known, case))
    length = first_bend(known, state.second, limits.rtol, case.scene) / abs(e)
    shortest, stretch, power = _SHORTEST * length, _NEARLY, GRADED
    layer_start(e, state, nodes)
    while clock.at < sink.tau.size and clock.steps < limits.max_steps and left > 0.0:
        # delta = 0, where the law bends, and the end of the layer are ends of panels
        zero = np.log(-e / slow_creep(state.first, work.slow)[0]) if crosses else left
        length = min(length, _LONGEST)
        if stretch * length >= min(zero, left):
            length = min(zero, left)
        to_zero = crosses and length == zero
        length, size = panel_size(e, length, power, to_zero, state, case)
        clock = Clock(clock.tau, clock.at, clock.steps + 1, clock.ends)
        if not size <= 1.0 and abs(e) > _ROUNDING * zeta:
            stretch = 1.0
            if size == np.inf and state.first != known:
                # perhaps the panel ends where the manifold is not known yet
                known = state.first
                renewed = above_manifold(known, state.second, case)
                if renewed * e > 0.0:
                    e, left = renewed, np.log(renewed / e) + left
                    layer_node(0, e, 1.0, nodes, work.slow, case.scene)
                    continue
            length = next_length(length, size, power)
            if length >= shortest:
                continue
        if not size <= 1.0:
            break
        panel = Panel(LAYER, state.first, e, length, power, 0.0, 0.0, 0.0, 0.0)
        left -= length
        e *= np.exp(-length)
        y = nodes[Y, N]
        event, state, clock = pass_path(y, slow_creep(y, work.slow)[0] + e, panel, state, frame, clock, case)
        if event != NO_EVENT:
            return False, event, state, clock
        next_start(power, nodes)
        crosses, stretch = crosses and not to_zero, _NEARLY
        length, power = next_length(length, size, power), 1
    return left <= 0.0 or abs(e) <= _ROUNDING * zeta, NO_EVENT, state, clock
