"""The boundary layers of a flow map after the onset of partial slip: :func:`fill_layers`.

After the onset omega - V relaxes at the rate k0, until the motion follows the slow manifold (:mod:`.flow_manifold`).
E = k0 (tau - tau_onset), tau = gamma t, is the time since the onset in units of 1/k0.  The law has a kink at delta = 0.
Each layer is therefore divided at a value of E, its split: that at which delta passes 0, or 1 where delta does not.
The layer coordinate u grows with E, linearly on either side of the split, from 2^LAYER_LOW at the onset over 1 at the
split to 2^LAYER_HIGH at the end.  The two families are the motions with omega > V and with omega < V at the onset.  V0
is the speed at the onset.  All is dimensionless.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..core.array_types import Floats
from ..kernels.flow import layout
from ..kernels.flow.states import DELTA_STAR, MOMENT, STIFFNESS, TRACTION
from ..materials.law.pack import interleave_pairs
from .flow_manifold import SlowManifold
from .flow_problem import SPEEDS, STICK_ENDS, FlowProblem
from .flow_rows import NODES, Nodes, Rows, octaves

#: Nodes of the coordinates of a layer.
_COARSE = Nodes(layout.LAYER_TERMS)
#: Octaves of the layer coordinate u.
_LAYER = octaves(layout.LAYER_LOW, layout.LAYER_HIGH)
#: Number of these octaves before the split.
_OCTAVES_BEFORE_SPLIT = -layout.LAYER_LOW
#: Lower end of u.
_LOWEST_U = 2.0**layout.LAYER_LOW
#: E after the split at which a motion has reached the slow manifold, dimensionless.
_JOIN_E = 2.0**layout.LAYER_HIGH - 1.0
#: Time before the onset of partial slip at which a motion of the layer starts, divided by that from onset to split, or
#: by 1/k0 where the split is still sought: the change of state in it is near the rounding of the integrator.
_LEAD = 1e-6
#: Values of E between which a zero of delta is searched; beyond them the kink of the law is below rounding.
_CROSSINGS = np.linspace(0.0, 14.0, 71)[1:]
#: Nodes of an octave of kappa V at onset for the polynomial of the split, which is smooth.
_SPLIT_NODES = Nodes(6)


def fill_layers(
    problem: FlowProblem, sign: float, first: int, slow: SlowManifold, asymptote: Floats, layer: Floats
) -> None:
    """Fill the tables of the boundary layers, and of the motions on the slow manifold that follow them, of one family.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.
    first : binary exponent of the lowest kappa V at onset.
    slow : the :class:`SlowManifold`.
    asymptote : (octave of kappa V at onset, numbers of a row), written: the slow logarithm at onset and k0; the split;
    distance and angle, and slip loss, in excess of the motion on the slow manifold.
    layer : (octave of kappa V at onset, octave of u, column, powers of u and kappa V), written; columns: ln(V/V0),
    delta, distance and angle beyond those at constant speed V0, divided by V0/k0, and slip loss divided by V0^2.
    Returns nothing.  Raises :class:`NoFlowMap`, with nothing written, for the reason STICK_ENDS where a motion of the
    layer leaves partial slip, and for OUT_OF_RANGE where its start is not finite or k0 not positive.
    """
    kappa, onsets = problem.parameters[1], octaves(first, first + layout.OCTAVES)
    V0 = onsets.node_positions(_COARSE) / kappa
    k0 = _stiff_rate(problem, V0)
    split_powers = _split_powers(problem, sign, onsets)
    split = np.asarray(polyval(_COARSE.t, split_powers.T), np.float64)
    V, delta, V_end = _layer_motions(problem, sign, V0, k0, split)
    # over (octave, V, octave of u, u)
    width = np.where(np.arange(_LAYER.half.size) < _OCTAVES_BEFORE_SPLIT, split[..., None] / (1.0 - _LOWEST_U), 1.0)
    half, V_ratio = width * _LAYER.half, V / V0[..., None, None]
    loss = delta * V_ratio * problem.contact_states(V, delta)[TRACTION] / (V0 * k0)[..., None, None]
    slopes = V_ratio - 1.0, V_ratio * (1.0 + delta) - 1.0, loss
    columns = [np.log(V_ratio), delta, *(_COARSE.integrals(slope, half) for slope in slopes)]
    for column, values in enumerate(columns):
        powers = _COARSE.powers(np.moveaxis(_COARSE.powers(values), 1, -1))
        layer[:, :, column] = powers.reshape(*layer.shape[:2], -1)
    # the motion on the slow manifold that they have reached at the end of the layer
    E = split + _JOIN_E
    x, angle, lost = (_COARSE.end(slope, half) for slope in slopes)
    end = SPEEDS.value(slow.slow_log, kappa * V_end)
    span = problem.slow_rate * E / k0
    slow_log = end + span
    slow_x, slow_angle = slow.path_between(slow_log, span, problem.slow_rate)
    x, angle = V0 / k0 * (E + x) - slow_x, V0 / k0 * (E + angle) - slow_angle
    lost = V0 * V0 * lost - (slow.rows.value(slow.loss, slow_log) - slow.rows.value(slow.loss, end))
    slow_log_at_V = slow.slow_log[first - layout.LOW :][: layout.OCTAVES]
    above = _COARSE.powers(slow_log - SPEEDS.value(slow.slow_log, kappa * V0))
    rates = NODES.powers(_stiff_rate(problem, onsets.x / kappa))
    excess = [_pad(_COARSE.powers(value)) for value in (x, angle, lost)]
    asymptote[:] = np.concatenate(
        [
            interleave_pairs(slow_log_at_V + _pad(above), rates),
            _pad(split_powers),
            interleave_pairs(*excess[:2]),
            excess[2],
        ],
        axis=-1,
    )


def _stiff_rate(problem: FlowProblem, V: Floats) -> Floats:
    """Return k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes in time gamma t.

    problem : the :class:`FlowProblem`; kappa, j and the law matter.
    V : speeds, > 0, dimensionless, of any shape.
    Returns the rates, > 0, dimensionless, in the shape of V.
    """
    return (1.0 + 1.0 / problem.parameters[3]) * problem.contact_states(V, np.zeros(V.shape))[STIFFNESS] / V


def _state_before_onset(problem: FlowProblem, sign: float, V: Floats, gamma: Floats) -> tuple[Floats, Floats]:
    """Return the state in full slip the time :data:`_LEAD` times ``gamma`` (in gamma t) before the onset of partial
    slip.

    A motion of the layer starts there, so that the integrator finds the onset itself.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V, 1.0 or -1.0.
    V : speeds at onset, > 0, (n,), dimensionless.
    gamma : unit of the times with which each motion is integrated, in gamma t: the time from onset to split, or 1/k0
    where the split is still sought; > 0, (n,), dimensionless.
    Returns (V, delta), (n,) each, dimensionless, to first order in that time.
    """
    _, _, mu, j = problem.parameters
    state = problem.contact_states(V, np.zeros(V.shape))
    push, half_moment, tau = sign * mu, 0.5 * state[MOMENT], _LEAD * gamma
    before = V - tau * (push - half_moment)
    return before, (V * (1.0 + sign * state[DELTA_STAR]) + tau * (push + half_moment) / j) / before - 1.0


def _layer_motions(
    problem: FlowProblem, sign: float, V0: Floats, k0: Floats, split: Floats
) -> tuple[Floats, Floats, Floats]:
    """Integrate the motions of a boundary layer, and return them at the nodes of its tables.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.
    V0 : speeds at onset, (octaves, nodes), dimensionless.
    k0 : relaxation rates of omega - V at these onsets, (octaves, nodes).
    split : E, the time since the onset in units of 1/k0, at which the table is divided, from :func:`_split_powers`,
    (octaves, nodes).
    Raises :class:`NoFlowMap` where a motion leaves partial slip, or its numbers are not finite.
    Returns (V; delta, both (octave, node of V, octave of u, node of u); V at the end of the layer, (octave, node of
    V)), dimensionless.
    """
    u, gamma = _LAYER.node_positions(_COARSE), (split / k0).ravel()
    starts = _state_before_onset(problem, sign, V0.ravel(), gamma)
    before = _LEAD + np.append((u[:_OCTAVES_BEFORE_SPLIT] - _LOWEST_U) / (1.0 - _LOWEST_U), 1.0)
    V, delta = problem.integrate(*starts, gamma, before, STICK_ENDS)
    V_on, delta_on = problem.integrate(
        V[:, -1], delta[:, -1], 1.0 / k0.ravel(), np.append(u[_OCTAVES_BEFORE_SPLIT:] - 1.0, _JOIN_E), STICK_ENDS
    )
    shape = (*V0.shape, _LAYER.half.size, _COARSE.t.size)
    V_whole, delta_whole = (
        np.concatenate([a[:, :-1], b[:, :-1]], axis=1).reshape(shape) for a, b in ((V, V_on), (delta, delta_on))
    )
    return V_whole, delta_whole, V_on[:, -1].reshape(V0.shape)


def _split_powers(problem: FlowProblem, sign: float, onsets: Rows) -> Floats:
    """Fit the value of E at which delta passes 0 by polynomials of kappa V at onset, one for each octave.

    In an octave in which delta does not pass 0 up to E = 14 at every node, the value is 1.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.  delta passes 0 only in motions of the sign of 1 - j, so that for
    the other sign, and for j = 1, all values are 1.
    onsets : :class:`Rows`, octaves of kappa V at onset.
    Raises :class:`NoFlowMap` where a motion leaves partial slip, or its numbers are not finite.
    Returns coefficients of powers of t in [-1, 1] on each octave, ascending, (octaves, powers), for E, dimensionless.
    """
    powers = np.zeros((onsets.half.size, _SPLIT_NODES.t.size))
    powers[:, 0] = 1.0
    if sign != np.sign(1.0 - problem.parameters[3]):
        return powers
    V = (onsets.node_positions(_SPLIT_NODES) / problem.parameters[1]).ravel()
    gamma = 1.0 / _stiff_rate(problem, V)
    _, delta = problem.integrate(*_state_before_onset(problem, sign, V, gamma), gamma, _LEAD + _CROSSINGS, STICK_ENDS)
    passed = sign * delta < 0.0
    index = np.clip(passed.argmax(axis=1), 2, _CROSSINGS.size - 2)[:, None] + np.arange(-2, 2)
    E, delta = _CROSSINGS[index], np.take_along_axis(delta, index, axis=1)
    # the inverse of a cubic
    split = np.zeros(V.size)
    for n in range(4):
        others = [delta[:, m] / (delta[:, m] - delta[:, n]) for m in range(4) if m != n]
        split += E[:, n] * np.prod(others, axis=0)
    split = split.reshape(powers.shape)
    turns = np.all(passed.any(axis=1).reshape(powers.shape), axis=1)
    powers[turns] = _SPLIT_NODES.powers(split[turns])
    return powers


def _pad(powers: Floats) -> Floats:
    """Return coefficients padded with zeros to the number of powers of functions of one variable.

    powers : coefficients, ascending, (rows, powers), at most as many powers as :data:`NODES` has nodes.
    Returns a new array (rows, nodes).
    """
    return np.pad(powers, [(0, 0), (0, NODES.t.size - powers.shape[-1])])
