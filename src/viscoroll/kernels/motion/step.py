"""One step: predictor, and solution by Radau IIA collocation with a simplified Newton iteration.

The predictor gives the values of the unknowns at the nodes from which the iteration starts.

Collocation is written with the slopes of the interpolants, so that the equation of the second
unknown d may be multiplied by V, which vanishes where a step ends at V = 0.  With p collocated in
place of V (:mod:`rhs`), D the differentiation matrix in t on [-1, 1], h half the length of the step
in tau, and b = V d', the equations at the nodes are

    h p' - D p = 0      h b - V (D d) = 0

An index V or d stands for the partial derivative with respect to V or d: p'_V is that of p'.  With
c = D d - h b_V, Newton's updates dp of p and dd of d solve

    (D - h diag(p'_V/p_V)) dp = h p' - D p
    [diag(V) D - diag(h b_d + c p_d/p_V)] dd = h b - V (D d) - c dp/p_V

and dV = (dp - p_d dd)/p_V: two N x N systems an iteration, as p' depends on d only by feedback,
which is neglected.  Their inverses are kept while updates are small.  In full slip p is V, the
second unknown omega, and 1 stands for the V that multiplies its equation.  Where friction is strong
p is V too, but d enters its rate by F = h dV'/dd, as omega does by feedback: with S the matrix of
the second system, dd is eliminated,

    [D - h diag(dV'/dV) + diag(F) S^-1 diag(c)] dV = h V' - D V + F S^-1 (h b - V (D d))

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau (in ``Step.h``; the h of the
  equations is half of it), its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in
  full slip.  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
- Rates: the right-hand side at a State and its derivatives (:mod:`rhs`).
"""

import numpy as np

from ..numerics.intrinsics import by_reference, by_value
from ..numerics.jit import inline_kernel, kernel
from ..records import State
from .collocation import (
    DIFFERENTIATION,
    NODE_FRACTIONS,
    ROW_COUPLING,
    ROW_D_DIAGONAL,
    ROW_D_RESIDUAL,
    ROW_D_SLOPE,
    ROW_D_UPDATE,
    ROW_DENSE_OMEGA_OR_D,
    ROW_DENSE_V,
    ROW_DP_DD,
    ROW_DV_DP,
    ROW_FEEDBACK,
    ROW_LENGTH,
    ROW_OMEGA_OR_D,
    ROW_ONES,
    ROW_P,
    ROW_P_DIAGONAL,
    ROW_P_RATE,
    ROW_P_RESIDUAL,
    ROW_P_SLOPE,
    ROW_P_UPDATE,
    ROW_RELAXATION,
    ROW_SPEED,
    ROW_V,
    ROW_V_RATE,
    ROW_WEIGHT,
    ROW_WEIGHTED_RATE,
    N,
    assemble_newton_matrix,
    dense_position,
    evaluate_dense_output,
    fit_dense_output,
    invert_matrix,
    invert_two_matrices,
    multiply_matrix,
    node_time,
)
from .departure_from_rest import solve_d_at_departure
from .drive import evaluate_load, load_at_node, store_drive
from .rhs import evaluate_rhs, evaluate_rhs_inline, has_strong_friction
from .step_control import ERROR_FRACTION, LEAST_TOLERANCE, NEWTON_FRACTION, error_scales

# --- Predictor ---

#: Distance beyond the right end of a step up to which its dense output is extrapolated, divided by
#: its length.  Between 0.7 and 4 steps and errors of a motion hardly change.
_EXTRAPOLATION = 1.5
#: Length of a step relative to one with the same left end, below which the dense output of that one
#: is not used: an error below the tolerance of Newton's iteration stays, and may have the sign of
#: an event.
_SHORTER_STEP = 1e-3


@kernel
def predict(step, relaxation, dense_step, regime, work):
    """Store the unknowns at nodes 1 ... N from which Newton's iteration of a step starts.

    The first of these that applies is taken:

    - the stored dense output, where the step ends at most 1.5 lengths of the dense step beyond its
      right end; not if the step has the same left end and at most a thousandth of its length;
    - V linear in time and the second unknown relaxing exponentially (:func:`_predict_relaxation`),
      where ``initial_slope_known`` is True (in full slip, and in partial slip for V > ZERO_SPEED)
      and V or omega is not 0 at the left end;
    - the departure from rest (:func:`_predict_from_rest`).

    step: Step, the trial step; ``tau``, ``h``, ``segment`` and ``initial_slope_known`` are read.
    relaxation: float, derivative of x' with respect to x at the left end, x the second unknown, per
    unit of tau.
    dense_step: Step, whose dense output is stored: the last accepted one, or a longer one that was
    rejected; its h is 0 if there is none.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with node 0 of the step (V, the second unknown, V', the weighted rate and
    ROW_SPEED); V and the second unknown are written at nodes 1 ... N, in partial slip with V >= 0
    and |d| <= 1.
    Returns nothing.
    """
    # The dense output is not used for a step with the same left end that is far shorter.
    usable = step.tau > dense_step.tau or step.h > _SHORTER_STEP * dense_step.h
    if (
        usable
        and dense_step.h > 0.0
        and step.tau + step.h <= dense_step.tau + (1.0 + _EXTRAPOLATION) * dense_step.h
    ):
        _extrapolate(step, dense_step, regime, work.nodes)
    elif step.initial_slope_known and work.nodes[ROW_SPEED] > 0.0:
        _predict_relaxation(step, relaxation, regime, work.nodes)
    else:
        _predict_from_rest(step, regime, work)


@inline_kernel
def _store_unknowns(i, V, omega_or_d, full_slip, nodes):
    """Store V and the second unknown at a node; in partial slip they are limited to V >= 0 and |d|
    <= 1, the range in which the law of partial slip is defined.  A prediction may leave it.

    i: int, the node, 1 ... N.
    V: float, speed of the axis, dimensionless.
    omega_or_d: float, second unknown, dimensionless: omega in full slip, d in partial slip.
    full_slip: bool, whether the whole contact slips; then both are stored without limits.
    nodes: Workspace.nodes; entry ``i`` of ROW_V and ROW_OMEGA_OR_D is written.  A NaN of either is
    stored as NaN.
    Returns nothing.
    """
    nodes[ROW_V + i] = V if full_slip else max(V, 0.0)
    nodes[ROW_OMEGA_OR_D + i] = omega_or_d if full_slip else min(max(omega_or_d, -1.0), 1.0)


@kernel
def _extrapolate(step, dense_step, regime, nodes):
    """Predict the unknowns at nodes 1 ... N of a step by the dense output of another step, usually
    extrapolated beyond the right end of that step.

    Both unknowns are shifted by constants, so that they continue the values at node 0.

    step: Step, the one to predict; its left end lies on ``dense_step`` or at one of the ends of
    ``dense_step``.
    dense_step: Step, whose dense output is stored; its length is above 0.
    regime: Regime, that of both steps; ``full_slip`` is read.
    nodes: Workspace.nodes, with node 0 of ``step`` and the dense output; V and the second unknown
    are written at nodes 1 ... N, limited as by :func:`_store_unknowns`.
    Returns nothing.
    """
    # The dense output is 0 at v = 0 of ``dense_step``.  V0 and omega_or_d0 are the constants with
    # which it has the values of node 0 at v_start.
    v_start = dense_position(step.tau, dense_step)
    V0 = nodes[ROW_V] - evaluate_dense_output(v_start, nodes, ROW_DENSE_V)
    omega_or_d0 = nodes[ROW_OMEGA_OR_D] - evaluate_dense_output(
        v_start, nodes, ROW_DENSE_OMEGA_OR_D
    )
    for i in range(1, N + 1):
        v = dense_position(node_time(step, i), dense_step)
        V = V0 + evaluate_dense_output(v, nodes, ROW_DENSE_V)
        omega_or_d = omega_or_d0 + evaluate_dense_output(v, nodes, ROW_DENSE_OMEGA_OR_D)
        _store_unknowns(i, V, omega_or_d, regime.full_slip, nodes)


@kernel
def _predict_relaxation(step, relaxation, regime, nodes):
    """Predict the unknowns at nodes 1 ... N: V linear in time, the second unknown relaxing
    exponentially from its value at the left end.

    Where relaxation * time is -1e-8 or above, the second unknown is linear in time too.

    step: Step, the one to predict, with V > 0 at its left end or in full slip; ``h`` is read.
    relaxation: float, derivative of x' with respect to x, x the second unknown, per unit of tau;
    where it is below 0, x relaxes.
    regime: Regime, that of the step; ``full_slip`` is read.
    nodes: Workspace.nodes, with V, V', the second unknown and its weighted rate (omega' in full
    slip, V d' in partial slip) at node 0; V and the second unknown are written at nodes 1 ... N,
    limited as by :func:`_store_unknowns`.
    Returns nothing.
    """
    omega_or_d_rate = (
        nodes[ROW_WEIGHTED_RATE] if regime.full_slip else nodes[ROW_WEIGHTED_RATE] / nodes[ROW_V]
    )
    for i in range(1, N + 1):
        time = step.h * NODE_FRACTIONS[i]
        # With x' = r + relaxation (x - x_0), x - x_0 = r (exp(relaxation time) - 1)/relaxation.
        # Exponential growth is not extrapolated, and 0 is not a divisor: where |relaxation time| is
        # at most 1e-8 the factor of r is ``time`` with a relative error of 5e-9.
        effective_time = (
            np.expm1(relaxation * time) / relaxation if relaxation * time < -1e-8 else time
        )
        V = nodes[ROW_V] + nodes[ROW_V_RATE] * time
        _store_unknowns(
            i, V, nodes[ROW_OMEGA_OR_D] + omega_or_d_rate * effective_time, regime.full_slip, nodes
        )


@kernel
def _predict_from_rest(step, regime, work):
    """Predict the unknowns at nodes 1 ... N of a step that starts at V = 0, in full slip at V =
    omega = 0.

    V' changes linearly from its value at the left end, which may be 0, to that at V = 0 under the
    drive at the right end; V is its integral.  In full slip omega' does the same, evaluated at
    omega = 0.  In partial slip d changes linearly to its value at a departure under the drive at
    the right end, or stays if no departure in partial slip is possible there; V' at the right end
    is p'/(dp/dV) at this d, or 0 if that is below 0.

    step: Step, the one to predict; ``tau``, ``h`` and ``segment`` are read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V', the weighted rate and d at node 0; Scene and Drive are read.  V and
    the second unknown are written at nodes 1 ... N, limited as by :func:`_store_unknowns`.
    Returns nothing.
    """
    nodes = work.nodes
    load = evaluate_load(step.tau + step.h, step.segment, regime, work)
    d = 0.0
    if not regime.full_slip:
        sticks, d = solve_d_at_departure(load, regime.spin_sign, work.scene)
        d = d if sticks else nodes[ROW_OMEGA_OR_D]
    rates = evaluate_rhs(State(0.0, d), load, regime, work.scene)
    # at V = 0 and fixed d, p' = dp/dV V'
    V_rate_end = rates.V_rate if regime.full_slip else max(rates.p_rate / rates.dp_dV, 0.0)
    for i in range(1, N + 1):
        time = NODE_FRACTIONS[i] * step.h
        # The integral of a rate that changes linearly from r_0 to r_1 over the step is (r_0 +
        # (r_1 - r_0) fraction/2) time; the name half_h stands for half the fraction of the step.
        half_h = 0.5 * NODE_FRACTIONS[i]
        change = (
            nodes[ROW_WEIGHTED_RATE] + half_h * (rates.weighted_rate - nodes[ROW_WEIGHTED_RATE])
        ) * time
        V = (nodes[ROW_V_RATE] + half_h * (V_rate_end - nodes[ROW_V_RATE])) * time
        d_i = nodes[ROW_OMEGA_OR_D] + NODE_FRACTIONS[i] * (d - nodes[ROW_OMEGA_OR_D])
        _store_unknowns(i, V, change if regime.full_slip else d_i, regime.full_slip, nodes)


# --- Solution of one step by Radau IIA collocation of p and of the second unknown ---

#: Largest number of Newton iterations of a step; a step that needs more is repeated with a shorter
#: length.
_MAX_ITERATIONS = 12
#: Relative update above which the Newton matrices are evaluated again.  With 1e-3 a motion takes 5
#: to 10 % longer; between 1e-3 and 1e-1 its steps and errors hardly change.
_REFACTOR_UPDATE = 0.1
#: Ratio of successive updates above which the Newton matrices are evaluated again.  Between 1e-4
#: and 1e-2 neither steps nor errors of a motion change.
_REFACTOR_CONTRACTION = 1e-3
#: Largest assumed ratio of the second update to the first, which is not known: with 0.1 an accurate
#: prediction ends after one iteration, with 0.01 losses of motions from rest were wrong by 60 rtol.
_FIRST_CONTRACTION = 0.1
#: Assumed contraction of the first iteration divided by its update, as Newton's iteration converges
#: quadratically.  Between 1 and 100 neither steps nor errors of a motion change.
_QUADRATIC_CONTRACTION = 10.0


@inline_kernel
def store_rhs(i, rates, nodes):
    """Store p, p', the weighted rate of the second unknown and max(|V|, |omega|) at a node.

    i: int, the node, 0 ... N.
    rates: Rates, the right-hand side at the node; p, p_rate, weighted_rate and omega are read.
    nodes: Workspace.nodes, with V at the node; entry ``i`` of ROW_P, ROW_P_RATE, ROW_WEIGHTED_RATE
    and ROW_SPEED is written.
    Returns nothing.
    """
    nodes[ROW_P_RATE + i] = rates.p_rate
    nodes[ROW_WEIGHTED_RATE + i] = rates.weighted_rate
    nodes[ROW_P + i] = rates.p
    nodes[ROW_SPEED + i] = max(abs(nodes[ROW_V + i]), abs(rates.omega))


@inline_kernel
def _evaluate_residuals(refactor, step, regime, work):
    """Evaluate the right-hand side and the residuals of both collocation equations at nodes 1 ...
    N.

    With h half of ``step.h`` and D the differentiation matrix, the residuals are h p' - D p, and h
    b - weight (D x) for the second unknown x, where b is its weighted rate.  They are in the units
    of p and of weight times x.

    refactor: bool, whether the derivatives that the Newton matrices consist of are stored too.
    step: Step, the trial step; ``h`` is read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown and the drive at the nodes, and p at node 0.
    Entries 1 ... N of ROW_P_RESIDUAL, ROW_D_RESIDUAL, ROW_P, ROW_P_RATE, ROW_WEIGHTED_RATE and
    ROW_SPEED are written; with ``refactor`` also, in the letters of the module, those of ROW_DV_DP
    (dV/dp), ROW_DP_DD (p_d), ROW_COUPLING (c/p_V), ROW_WEIGHT (V, or 1 in full slip),
    ROW_RELAXATION (b_d over that weight), ROW_FEEDBACK (h dp'/dd), ROW_P_DIAGONAL (h p'_V/p_V) and
    ROW_D_DIAGONAL (h b_d + c p_d/p_V).  ROW_P_SLOPE and ROW_D_SLOPE are written whole, with 0 at
    node 0 (NaN if p or the second unknown is not finite at a node).  ROW_RELAXATION is not finite
    where V is 0 in partial slip.
    Returns nothing.
    """
    # a copy, as LLVM would read ``work`` itself again after each number that is stored
    values = by_reference(by_value(work))
    nodes = work.nodes
    half_h = 0.5 * step.h
    # D x: slopes of the interpolant; the value of node 0 is subtracted, which changes no slope but
    # keeps the digits of small changes
    multiply_matrix(
        DIFFERENTIATION, ROW_OMEGA_OR_D, nodes[ROW_OMEGA_OR_D], nodes, ROW_D_SLOPE, nodes
    )
    for i in range(1, ROW_LENGTH):
        load = load_at_node(i, regime, values)
        rates = evaluate_rhs_inline(
            nodes[ROW_V + i], nodes[ROW_OMEGA_OR_D + i], load, regime, values.scene
        )
        store_rhs(i, rates, nodes)
        slope = nodes[ROW_D_SLOPE + i]
        nodes[ROW_D_RESIDUAL + i] = half_h * rates.weighted_rate - rates.weight * slope
        if refactor:
            # p is the unknown of the first system: derivatives with respect to V become those with
            # respect to p
            dV_dp = 1.0 / rates.dp_dV
            coupling = dV_dp * (rates.dweight_dV * slope - half_h * rates.drate_dV)
            nodes[ROW_DV_DP + i] = dV_dp
            nodes[ROW_DP_DD + i] = rates.dp_dd
            nodes[ROW_COUPLING + i] = coupling
            nodes[ROW_WEIGHT + i] = rates.weight
            nodes[ROW_RELAXATION + i] = rates.drate_dd / rates.weight
            nodes[ROW_P_DIAGONAL + i] = half_h * rates.dp_rate_dV * dV_dp
            nodes[ROW_FEEDBACK + i] = half_h * rates.dp_rate_dd
            nodes[ROW_D_DIAGONAL + i] = half_h * rates.drate_dd + coupling * rates.dp_dd
    multiply_matrix(DIFFERENTIATION, ROW_P, nodes[ROW_P], nodes, ROW_P_SLOPE, nodes)
    for i in range(1, ROW_LENGTH):
        nodes[ROW_P_RESIDUAL + i] = half_h * nodes[ROW_P_RATE + i] - nodes[ROW_P_SLOPE + i]


@kernel
def _add_feedback_to_matrix(work):
    """Add the effect of the second unknown on p', diag(F) S^-1 diag(c) of the module, to the Newton
    matrix of p.

    work: Workspace, with S^-1 in ``d_matrix``, F in ROW_FEEDBACK and c in ROW_COUPLING; rows and
    columns 1 ... N of ``p_matrix`` are changed.  Both matrices are flat vectors by columns, element
    (i, k) at ROW_LENGTH k + i; row and column 0 are not used.
    Returns nothing.
    """
    for k in range(1, ROW_LENGTH):
        for i in range(1, ROW_LENGTH):
            feedback = work.nodes[ROW_FEEDBACK + i] * work.d_matrix[ROW_LENGTH * k + i]
            work.p_matrix[ROW_LENGTH * k + i] += feedback * work.nodes[ROW_COUPLING + k]


@inline_kernel
def _newton_iteration(refactor, coupled, step, regime, work):
    """Do one Newton iteration of both collocation equations at nodes 1 ... N, and update the
    unknowns.

    refactor: bool, whether to evaluate and invert the Newton matrices again; if not, the stored
    inverses are used, with the rows ROW_DV_DP, ROW_DP_DD, ROW_COUPLING and ROW_FEEDBACK of the
    iteration that made them.
    coupled: bool, whether p' depends on the second unknown, so that the system of p contains
    feedback.
    step: Step, the trial step; ``h`` and ``undriven`` are read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown and the drive at all nodes, and p and ROW_SPEED,
    max(|V|, |omega|), at node 0.  Written at nodes 1 ... N are the unknowns ROW_V, ROW_OMEGA_OR_D
    and ROW_P after the update; ROW_P_RESIDUAL and ROW_D_RESIDUAL, the residuals with terms of the
    other equation; and, of the unknowns before the update, ROW_P_RATE, ROW_WEIGHTED_RATE and
    ROW_SPEED.
    ROW_P_UPDATE, ROW_D_UPDATE and, before the update, ROW_P_SLOPE and ROW_D_SLOPE are written
    whole, with 0 at node 0 (NaN if the row that is multiplied has a NaN or inf).  With ``refactor``
    also ``p_matrix``, ``d_matrix`` and, at nodes 1 ... N, the derivatives before the update:
    ROW_DV_DP, ROW_DP_DD, ROW_COUPLING, ROW_WEIGHT, ROW_RELAXATION, ROW_FEEDBACK, ROW_P_DIAGONAL and
    ROW_D_DIAGONAL.
    Returns the largest update of V or of the second unknown, each divided by its error scale
    (:func:`error_scales`, of the updated unknowns), a float >= 0, dimensionless; NaN if an update
    is NaN.
    """
    nodes = work.nodes
    p_matrix = work.p_matrix
    d_matrix = work.d_matrix
    if refactor:
        _evaluate_residuals(True, step, regime, work)
        assemble_newton_matrix(ROW_ONES, ROW_P_DIAGONAL, nodes, p_matrix)
        assemble_newton_matrix(ROW_WEIGHT, ROW_D_DIAGONAL, nodes, d_matrix)
        if coupled:
            invert_matrix(d_matrix)
            _add_feedback_to_matrix(work)
            invert_matrix(p_matrix)
        else:
            invert_two_matrices(d_matrix, p_matrix)
    else:
        _evaluate_residuals(False, step, regime, work)
    if coupled:
        # F S^-1 (h b - V (D d)) of the module; ROW_P_UPDATE holds S^-1 (...) until it is solved.
        multiply_matrix(d_matrix, ROW_D_RESIDUAL, 0.0, nodes, ROW_P_UPDATE, nodes)
        for i in range(1, ROW_LENGTH):
            nodes[ROW_P_RESIDUAL + i] += nodes[ROW_FEEDBACK + i] * nodes[ROW_P_UPDATE + i]
    # dp, then the right side of the second system, which contains dp, then dd
    multiply_matrix(p_matrix, ROW_P_RESIDUAL, 0.0, nodes, ROW_P_UPDATE, nodes)
    for i in range(1, ROW_LENGTH):
        nodes[ROW_D_RESIDUAL + i] -= nodes[ROW_COUPLING + i] * nodes[ROW_P_UPDATE + i]
    multiply_matrix(d_matrix, ROW_D_RESIDUAL, 0.0, nodes, ROW_D_UPDATE, nodes)
    # A NaN of an update must reach the result: max() ignores a NaN in its second argument, so
    # change_d is the first argument below.
    change_d = 0.0 * (nodes[ROW_P_UPDATE + N] + nodes[ROW_D_UPDATE + N])
    change_V = 0.0
    for i in range(1, ROW_LENGTH):
        d_update = nodes[ROW_D_UPDATE + i]
        # dV = (dp - p_d dd)/p_V of the module
        V_update = (nodes[ROW_P_UPDATE + i] - nodes[ROW_DP_DD + i] * d_update) * nodes[
            ROW_DV_DP + i
        ]
        change_V = max(change_V, abs(V_update))
        change_d = max(change_d, abs(d_update))
        nodes[ROW_V + i] += V_update
        nodes[ROW_OMEGA_OR_D + i] += d_update
        nodes[ROW_P + i] += nodes[ROW_P_UPDATE + i]
    scale_V, scale_d = error_scales(step, regime, work)
    return max(change_d / scale_d, change_V / scale_V)


@inline_kernel
def solve_step(step, relaxation, dense_step, regime, work):
    """Solve a trial step from node 0 on by a simplified Newton iteration and store its dense
    output.

    An update counts by the largest change of V and of the second unknown, each divided by its error
    scale.  The iteration has converged when the last update times the ratio of the last two
    updates, an estimate of the remaining error, is at most 0.016 times the tolerance of the
    step, max(0.25 rtol, 1e-14), or at most 1e-14.  At the first iteration the ratio is taken to be
    at most 0.1, less for a small update.

    step: Step, the trial step; all fields are read.
    relaxation: float, derivative of x' with respect to x at node 0, x the second unknown, per unit
    of tau; only the predictor reads it.
    dense_step: Step, whose dense output is stored on entry, for the predictor; its h is 0 if there
    is none.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown, p, V', the weighted rate and max(|V|, |omega|) at
    node 0; the drive at all nodes, nodes 1 ... N of all rows of :func:`_newton_iteration` and the
    Newton matrices are written.  The rates, slopes, residuals and ROW_SPEED there are those before
    the last update, the derivatives those of the last matrices.
    Returns True if the iteration converged: the dense output of V and of the second unknown is then
    that of ``step``.
    Returns False if it did not within _MAX_ITERATIONS, or if an update was 1e6 or more, at least
    twice the one before, or NaN: nodes 1 ... N then hold the last iterate, and the dense output is
    still that of ``dense_step``.
    """
    nodes = work.nodes
    tolerance = max(ERROR_FRACTION * work.options.rtol, LEAST_TOLERANCE)
    stop = max(NEWTON_FRACTION * tolerance, LEAST_TOLERANCE)
    store_drive(step, work)
    predict(step, relaxation, dense_step, regime, work)
    last_change = np.inf
    refactor = True
    # whether p' depends on the second unknown: under strong friction, and in full slip with a
    # feedback of omega on V'
    coupled = has_strong_friction(load_at_node(0, regime, work), regime, work.scene)
    if regime.full_slip:
        coupled = work.drive.gains.force_omega != 0.0
    for n in range(_MAX_ITERATIONS):
        change = _newton_iteration(refactor, coupled, step, regime, work)
        contraction = change / last_change
        # the first ratio is not known; in a quadratic iteration it is small for a small update
        if n == 0:
            contraction = min(
                _FIRST_CONTRACTION, _QUADRATIC_CONTRACTION * change + _REFACTOR_CONTRACTION
            )
        # Divergence, or a NaN: an update of a million scales, or one twice as large as the last.
        if not (change < 1e6 and contraction < 2.0):
            return False
        if change * contraction <= stop:
            fit_dense_output(ROW_V, ROW_DENSE_V, nodes)
            fit_dense_output(ROW_OMEGA_OR_D, ROW_DENSE_OMEGA_OR_D, nodes)
            return True
        # new matrices only where updates are large and the old ones no longer reduce them well
        refactor = change > _REFACTOR_UPDATE and (n == 0 or contraction > _REFACTOR_CONTRACTION)
        last_change = change
    return False
