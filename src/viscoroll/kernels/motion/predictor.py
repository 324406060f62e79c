"""Predictor: the values of the unknowns at the nodes from which Newton's iteration of a step starts.

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d = delta/delta_star in
  partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega under a brake;
  whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in full slip
  (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import inline_kernel, kernel
from .collocation import NODE_FRACTIONS, N, evaluate_dense_output
from .departure_from_rest import solve_d_at_departure
from .drive import evaluate_load
from .records import State
from .rhs import evaluate_rhs
from .workspace import (
    ROW_DENSE_OMEGA_OR_D,
    ROW_DENSE_V,
    ROW_OMEGA_OR_D,
    ROW_SPEED,
    ROW_V,
    ROW_V_RATE,
    ROW_WEIGHTED_RATE,
    dense_position,
    node_time,
)

#: Distance beyond the right end of a step up to which its dense output is extrapolated, divided by its length.  Between
#: 0.7 and 4 steps and errors of a motion hardly change.
_EXTRAPOLATION = 1.5
#: Length of a step relative to one with the same left end, below which the dense output of that one is not used: an
#: error below the tolerance of Newton's iteration stays, and may have the sign of an event.
_SHORTER_STEP = 1e-3


@kernel
def predict(step, relaxation, dense_step, regime, work):
    """Store the unknowns at nodes 1 ... N from which Newton's iteration of a step starts.

    The first of these that applies is taken:

    - the stored dense output, where the step ends at most 1.5 lengths of the dense step beyond its right end; not if
      the step has the same left end and at most a thousandth of its length;
    - V linear in time and the second unknown relaxing exponentially (:func:`_predict_relaxation`), in partial slip from
      V > 1e-200 on (``initial_slope_known``), in full slip if V or omega is not 0;
    - the departure from rest (:func:`_predict_from_rest`).

    step: Step, the trial step; ``tau``, ``h``, ``segment`` and ``initial_slope_known`` are read.
    relaxation: float, derivative of the slope of the second unknown in itself at the left end, per unit of tau.
    dense_step: Step, whose dense output is stored: the last accepted one, or a longer one that was rejected; h = 0:
    none.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with node 0 of the step (V, the second unknown, V', the weighted rate and ROW_SPEED); V and the
    second unknown are written at nodes 1 ... N, in partial slip with V >= 0 and |d| <= 1.  Returns nothing.
    """
    usable = step.tau > dense_step.tau or step.h > _SHORTER_STEP * dense_step.h
    if usable and dense_step.h > 0.0 and step.tau + step.h <= dense_step.tau + (1.0 + _EXTRAPOLATION) * dense_step.h:
        _extrapolate(step, dense_step, regime, work.nodes)
    elif step.initial_slope_known and work.nodes[ROW_SPEED] > 0.0:
        _predict_relaxation(step, relaxation, regime, work.nodes)
    else:
        _predict_from_rest(step, regime, work)


@inline_kernel
def _store_unknowns(i, V, omega_or_d, full_slip, nodes):
    """Store V and the second unknown at a node; in partial slip limited to V >= 0 and |d| <= 1.

    That is the range in which the law of partial slip is defined; a prediction may leave it.

    i: int, the node, 1 ... N.
    V: float, speed of the axis, dimensionless.
    omega_or_d: float, second unknown, dimensionless: omega in full slip, d in partial slip.
    full_slip: bool, whether the whole contact slips; True: both are stored as they are.
    nodes: Workspace.nodes; entry ``i`` of ROW_V and ROW_OMEGA_OR_D is written.  A NaN of either is stored as NaN.
    Returns nothing.
    """
    nodes[ROW_V + i] = V if full_slip else max(V, 0.0)
    nodes[ROW_OMEGA_OR_D + i] = omega_or_d if full_slip else min(max(omega_or_d, -1.0), 1.0)


@kernel
def _extrapolate(step, dense_step, regime, nodes):
    """Store the unknowns of a step by the dense output of another one, usually extrapolated beyond its right end.

    Both are shifted by constants, so that they continue the values at node 0.

    step: Step, the one to predict; its left end lies on ``dense_step`` or at either of its ends.
    dense_step: Step, whose dense output is stored; its length is above 0.
    regime: Regime, that of both steps; ``full_slip`` is read.
    nodes: Workspace.nodes, with node 0 of ``step`` and the dense output; V and the second unknown are written at nodes
    1 ... N, limited as by :func:`_store_unknowns`.  Returns nothing.
    """
    v_start = dense_position(step.tau, dense_step)
    V0 = nodes[ROW_V] - evaluate_dense_output(v_start, nodes, ROW_DENSE_V)
    omega_or_d0 = nodes[ROW_OMEGA_OR_D] - evaluate_dense_output(v_start, nodes, ROW_DENSE_OMEGA_OR_D)
    for i in range(1, N + 1):
        v = dense_position(node_time(step, i), dense_step)
        V = V0 + evaluate_dense_output(v, nodes, ROW_DENSE_V)
        omega_or_d = omega_or_d0 + evaluate_dense_output(v, nodes, ROW_DENSE_OMEGA_OR_D)
        _store_unknowns(i, V, omega_or_d, regime.full_slip, nodes)


@kernel
def _predict_relaxation(step, relaxation, regime, nodes):
    """Store the unknowns with V linear in time and the second unknown relaxing exponentially from the left end on.

    Where the second unknown does not relax, ``relaxation`` times the time being above -1e-8, it is linear in time too.

    step: Step, the one to predict, with V > 0 or in full slip at its left end; ``h`` is read.
    relaxation: float, derivative of the slope of the second unknown in itself, per unit of tau; below 0 it relaxes.
    regime: Regime, that of the step; ``full_slip`` is read.
    nodes: Workspace.nodes, with V, V', the second unknown and its weighted rate (omega' in full slip, V d' in partial
    slip) at node 0; V and the second unknown are written at nodes 1 ... N, limited as by :func:`_store_unknowns`.
    Returns nothing.
    """
    omega_or_d_rate = nodes[ROW_WEIGHTED_RATE] if regime.full_slip else nodes[ROW_WEIGHTED_RATE] / nodes[ROW_V]
    for i in range(1, N + 1):
        time = step.h * NODE_FRACTIONS[i]
        effective_time = np.expm1(relaxation * time) / relaxation if relaxation * time < -1e-8 else time
        V = nodes[ROW_V] + nodes[ROW_V_RATE] * time
        _store_unknowns(i, V, nodes[ROW_OMEGA_OR_D] + omega_or_d_rate * effective_time, regime.full_slip, nodes)


@kernel
def _predict_from_rest(step, regime, work):
    """Store the unknowns of a step that starts at V = 0, in full slip at V = omega = 0.

    V' changes linearly from its value at the left end, which may be 0, to that at V = 0 under the drive at the right
    end; V is its integral.  In full slip omega' does the same, evaluated at omega = 0.  In partial slip d changes
    linearly to its value at a departure under the drive at the right end, or stays if no departure in partial slip is
    possible there; V' at the right end is that of p' at this d, but taken as at least 0.

    step: Step, the one to predict; ``tau``, ``h`` and ``segment`` are read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V', the weighted rate and d at node 0; Scene and Drive are read.  V and the second unknown are
    written at nodes 1 ... N, limited as by :func:`_store_unknowns`.  Returns nothing.
    """
    nodes = work.nodes
    load, d = evaluate_load(step.tau + step.h, step.segment, regime, work), 0.0
    if not regime.full_slip:
        sticks, d = solve_d_at_departure(load, regime.spin_sign, work.scene)
        d = d if sticks else nodes[ROW_OMEGA_OR_D]
    rates = evaluate_rhs(State(0.0, d), load, regime, work.scene)
    V_rate_end = rates.V_rate if regime.full_slip else max(rates.p_rate / rates.dp_dV, 0.0)
    for i in range(1, N + 1):
        time, half = NODE_FRACTIONS[i] * step.h, 0.5 * NODE_FRACTIONS[i]
        change = (nodes[ROW_WEIGHTED_RATE] + half * (rates.weighted_rate - nodes[ROW_WEIGHTED_RATE])) * time
        V = (nodes[ROW_V_RATE] + half * (V_rate_end - nodes[ROW_V_RATE])) * time
        d_i = nodes[ROW_OMEGA_OR_D] + NODE_FRACTIONS[i] * (d - nodes[ROW_OMEGA_OR_D])
        _store_unknowns(i, V, change if regime.full_slip else d_i, regime.full_slip, nodes)
