"""Solution of one step by Radau IIA collocation of p and of the second unknown, with a simplified Newton iteration.

Collocation is written with the slopes of the interpolants, so that the equation of d may be multiplied by V, which
vanishes where a step ends at V = 0.  At the nodes, with D the differentiation matrix and h half the length,

    (D - h diag(p'_V/p_V)) dp = h p' - D p       [diag(V) D - diag(h b_d + c p_d/p_V)] dd = h b - V (D d) - c dp/p_V

b = V d', c = D d - h b_V, dV = (dp - p_d dd)/p_V: two N x N systems an iteration.  Their inverses are kept while
updates are small.  In full slip p is V, the second unknown omega, and 1 stands for the V that multiplies its equation.
Where friction is strong p is V too, but d enters its rate by F = h dV'/dd, as omega does by feedback: with S the second
matrix,

    [D - h diag(dV'/dV) + diag(F) S^-1 diag(c)] dV = h V' - D V + F S^-1 (h b - V (D d))

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega under a brake;
  whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- Rates: the right-hand side at a State and its derivatives (:mod:`rhs`).
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in full slip
  (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.jit import inline_kernel, kernel
from .collocation import (
    DIFFERENTIATION,
    ROW_LENGTH,
    N,
    assemble_newton_matrix,
    fit_dense_output,
    invert_matrix,
    invert_two_matrices,
    multiply_matrix,
)
from .drive import load_at_node, store_drive
from .error_estimate import ERROR_FRACTION, LEAST_TOLERANCE, NEWTON_FRACTION, error_scales
from .predictor import predict
from .rhs import evaluate_rhs_inline, has_strong_friction
from .workspace import (
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
    ROW_WEIGHT,
    ROW_WEIGHTED_RATE,
)

#: Largest number of Newton iterations of a step; a step that needs more is repeated with a shorter length.
_MAX_ITERATIONS = 12
#: Relative update above which the Newton matrices are evaluated again.  With 1e-3 a motion takes 5 to 10 % longer;
#: between 1e-3 and 1e-1 its steps and errors hardly change.
_REFACTOR_UPDATE = 0.1
#: Ratio of successive updates above which the Newton matrices are evaluated again.  Between 1e-4 and 1e-2 neither steps
#: nor errors of a motion change.
_REFACTOR_CONTRACTION = 1e-3
#: Largest assumed ratio of the second update to the first, which is not known: with 0.1 an accurate prediction ends
#: after one iteration, with 0.01 losses of motions from rest were wrong by 60 rtol.
_FIRST_CONTRACTION = 0.1
#: Assumed contraction of the first iteration divided by its update, as Newton's iteration converges quadratically.
#: Between 1 and 100 neither steps nor errors of a motion change.
_QUADRATIC_CONTRACTION = 10.0


@inline_kernel
def store_rhs(i, rates, nodes):
    """Store p, p', the weighted rate of the second unknown and max(|V|, |omega|) at a node.

    i: int, the node, 0 ... N.
    rates: Rates, the right-hand side at the node; p, p_rate, weighted_rate and omega are read.
    nodes: Workspace.nodes, with V at the node; entry ``i`` of ROW_P, ROW_P_RATE, ROW_WEIGHTED_RATE and ROW_SPEED is
    written.  Returns nothing.
    """
    nodes[ROW_P_RATE + i], nodes[ROW_WEIGHTED_RATE + i] = rates.p_rate, rates.weighted_rate
    nodes[ROW_P + i], nodes[ROW_SPEED + i] = rates.p, max(abs(nodes[ROW_V + i]), abs(rates.omega))


@inline_kernel
def _evaluate_residuals(refactor, step, regime, work):
    """Evaluate the right-hand side and the residuals of both collocation equations at nodes 1 ... N.

    With h half of ``step.h`` and D the differentiation matrix, the residuals are h p' - D p, and h b - weight (D x) for
    the second unknown x with its weighted rate b.  They are in the units of p and of weight times x.

    refactor: bool, whether the derivatives that the Newton matrices consist of are stored too.
    step: Step, the trial step; ``h`` is read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown and the drive at the nodes, and p at node 0.  Entries 1 ... N of
    ROW_P_RESIDUAL, ROW_D_RESIDUAL, ROW_P, ROW_P_RATE, ROW_WEIGHTED_RATE and ROW_SPEED are written; with ``refactor``
    also, in the letters of the module, those of ROW_DV_DP (dV/dp), ROW_DP_DD (p_d), ROW_COUPLING (c/p_V), ROW_WEIGHT
    (V, or 1 in full slip), ROW_RELAXATION (b_d over that weight), ROW_FEEDBACK (h dp'/dd), ROW_P_DIAGONAL (h p'_V/p_V)
    and ROW_D_DIAGONAL (h b_d + c p_d/p_V).  ROW_P_SLOPE and ROW_D_SLOPE are written whole, with 0 at node 0 (NaN if p
    or the second unknown is not finite at a node).  ROW_RELAXATION is not finite where V is 0 in partial slip.
    Returns nothing.
    """
    values, nodes, half = by_value(work), work.nodes, 0.5 * step.h
    multiply_matrix(DIFFERENTIATION, ROW_OMEGA_OR_D, nodes[ROW_OMEGA_OR_D], nodes, ROW_D_SLOPE, nodes)
    for i in range(1, ROW_LENGTH):
        load = load_at_node(i, regime, values)
        rates = evaluate_rhs_inline(nodes[ROW_V + i], nodes[ROW_OMEGA_OR_D + i], load, regime, values.scene)
        store_rhs(i, rates, nodes)
        slope = nodes[ROW_D_SLOPE + i]
        nodes[ROW_D_RESIDUAL + i] = half * rates.weighted_rate - rates.weight * slope
        if refactor:
            dV_dp = 1.0 / rates.dp_dV
            coupling = dV_dp * (rates.dweight_dV * slope - half * rates.drate_dV)
            nodes[ROW_DV_DP + i], nodes[ROW_DP_DD + i], nodes[ROW_COUPLING + i] = dV_dp, rates.dp_dd, coupling
            nodes[ROW_WEIGHT + i], nodes[ROW_RELAXATION + i] = rates.weight, rates.drate_dd / rates.weight
            nodes[ROW_P_DIAGONAL + i] = half * rates.dp_rate_dV * dV_dp
            nodes[ROW_FEEDBACK + i] = half * rates.dp_rate_dd
            nodes[ROW_D_DIAGONAL + i] = half * rates.drate_dd + coupling * rates.dp_dd
    multiply_matrix(DIFFERENTIATION, ROW_P, nodes[ROW_P], nodes, ROW_P_SLOPE, nodes)
    for i in range(1, ROW_LENGTH):
        nodes[ROW_P_RESIDUAL + i] = half * nodes[ROW_P_RATE + i] - nodes[ROW_P_SLOPE + i]


@kernel
def _add_feedback_to_matrix(work):
    """Add the effect of the second unknown on p', diag(F) S^-1 diag(c) of the module, to the Newton matrix of p.

    work: Workspace, with S^-1 in ``d_matrix``, F in ROW_FEEDBACK and c in ROW_COUPLING; rows and columns 1 ... N of
    ``p_matrix`` are changed.  Both matrices are flat vectors by columns, element (i, k) at ROW_LENGTH k + i; row and
    column 0 are not used.  Returns nothing.
    """
    for k in range(1, ROW_LENGTH):
        for i in range(1, ROW_LENGTH):
            feedback = work.nodes[ROW_FEEDBACK + i] * work.d_matrix[ROW_LENGTH * k + i]
            work.p_matrix[ROW_LENGTH * k + i] += feedback * work.nodes[ROW_COUPLING + k]


@inline_kernel
def _newton_iteration(refactor, coupled, step, regime, work):
    """Do one Newton iteration of both collocation equations at nodes 1 ... N, and update the unknowns.

    refactor: bool, whether to evaluate and invert the Newton matrices again; False: the stored inverses are used, with
    the rows ROW_DV_DP, ROW_DP_DD, ROW_COUPLING and ROW_FEEDBACK of the iteration that made them.
    coupled: bool, whether p' depends on the second unknown, so that the system of p contains feedback.
    step: Step, the trial step; ``h`` and ``undriven`` are read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown and the drive at all nodes, and p and the larger speed at node 0.
    Written at nodes 1 ... N are the unknowns ROW_V, ROW_OMEGA_OR_D and ROW_P after the update; ROW_P_RESIDUAL and
    ROW_D_RESIDUAL, the residuals with terms of the other equation; and, of the unknowns before the update, ROW_P_RATE,
    ROW_WEIGHTED_RATE and ROW_SPEED.  ROW_P_UPDATE, ROW_D_UPDATE and, before the update, ROW_P_SLOPE and ROW_D_SLOPE are
    written whole, with 0 at node 0 (NaN if the row that is multiplied has a NaN or inf).  With ``refactor`` also
    ``p_matrix``, ``d_matrix`` and, at nodes 1 ... N, the derivatives before the update: ROW_DV_DP, ROW_DP_DD,
    ROW_COUPLING, ROW_WEIGHT, ROW_RELAXATION, ROW_FEEDBACK, ROW_P_DIAGONAL and ROW_D_DIAGONAL.
    Returns the largest update of V or of the second unknown, each divided by its error scale (:func:`error_scales`, of
    the updated unknowns), a float >= 0, dimensionless; NaN if an update is NaN.
    """
    nodes, p_matrix, d_matrix = work.nodes, work.p_matrix, work.d_matrix
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
        multiply_matrix(d_matrix, ROW_D_RESIDUAL, 0.0, nodes, ROW_P_UPDATE, nodes)
        for i in range(1, ROW_LENGTH):
            nodes[ROW_P_RESIDUAL + i] += nodes[ROW_FEEDBACK + i] * nodes[ROW_P_UPDATE + i]
    multiply_matrix(p_matrix, ROW_P_RESIDUAL, 0.0, nodes, ROW_P_UPDATE, nodes)
    for i in range(1, ROW_LENGTH):
        nodes[ROW_D_RESIDUAL + i] -= nodes[ROW_COUPLING + i] * nodes[ROW_P_UPDATE + i]
    multiply_matrix(d_matrix, ROW_D_RESIDUAL, 0.0, nodes, ROW_D_UPDATE, nodes)
    # A NaN of an update must reach the result: max() loses it in its second argument, so change_d is the first below.
    change_d, change_V = 0.0 * (nodes[ROW_P_UPDATE + N] + nodes[ROW_D_UPDATE + N]), 0.0
    for i in range(1, ROW_LENGTH):
        d_update = nodes[ROW_D_UPDATE + i]
        V_update = (nodes[ROW_P_UPDATE + i] - nodes[ROW_DP_DD + i] * d_update) * nodes[ROW_DV_DP + i]
        change_V, change_d = max(change_V, abs(V_update)), max(change_d, abs(d_update))
        nodes[ROW_V + i] += V_update
        nodes[ROW_OMEGA_OR_D + i] += d_update
        nodes[ROW_P + i] += nodes[ROW_P_UPDATE + i]
    scale_V, scale_d = error_scales(step, regime, work)
    return max(change_d / scale_d, change_V / scale_V)


@inline_kernel
def solve_step(step, relaxation, dense_step, regime, work):
    """Solve a trial step from node 0 on by a simplified Newton iteration and store its dense output.

    An update counts by the largest change of V and of the second unknown, each divided by its error scale.  The
    iteration has converged when the last update times the ratio of the last two updates, an estimate of the error that
    is left, is at most 0.016 times the tolerance of the step, max(0.25 rtol, 1e-14), or at most 1e-14.  At the first
    iteration the ratio is taken to be at most 0.1, less for a small update.

    step: Step, the trial step; all fields are read.
    relaxation: float, derivative of the slope of the second unknown in itself at node 0, per unit of tau; only the
    predictor reads it.
    dense_step: Step, whose dense output is stored on entry, for the predictor; one with h = 0 if none is.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with V, the second unknown, p, V', the weighted rate and the larger speed at node 0; the drive at
    all nodes, nodes 1 ... N of all rows of :func:`_newton_iteration` and the Newton matrices are written.  The rates,
    slopes, residuals and ROW_SPEED there are those before the last update, the derivatives those of the last matrices.
    Returns True if the iteration converged: the dense output of V and of the second unknown is then that of ``step``.
    Returns False if it did not within _MAX_ITERATIONS, or if an update was 1e6 or more, at least twice the one before,
    or NaN: nodes 1 ... N then hold the last iterate, and the dense output is still that of
    ``dense_step``.
    """
    nodes, tolerance = work.nodes, max(ERROR_FRACTION * work.options.rtol, LEAST_TOLERANCE)
    stop = max(NEWTON_FRACTION * tolerance, LEAST_TOLERANCE)
    store_drive(step, work)
    predict(step, relaxation, dense_step, regime, work)
    last_change, refactor = np.inf, True
    coupled = has_strong_friction(load_at_node(0, regime, work), regime, work.scene)
    if regime.full_slip:
        coupled = work.drive.gains.force_omega != 0.0
    for n in range(_MAX_ITERATIONS):
        change = _newton_iteration(refactor, coupled, step, regime, work)
        contraction = change / last_change
        if n == 0:
            contraction = min(_FIRST_CONTRACTION, _QUADRATIC_CONTRACTION * change + _REFACTOR_CONTRACTION)
        if not (change < 1e6 and contraction < 2.0):
            return False
        if change * contraction <= stop:
            fit_dense_output(ROW_V, ROW_DENSE_V, nodes)
            fit_dense_output(ROW_OMEGA_OR_D, ROW_DENSE_OMEGA_OR_D, nodes)
            return True
        refactor = change > _REFACTOR_UPDATE and (n == 0 or contraction > _REFACTOR_CONTRACTION)
        last_change = change
    return False
