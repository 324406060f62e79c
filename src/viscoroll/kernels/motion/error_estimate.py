"""Error estimate of a step, its scales and tolerances.

The error of the dense output is estimated by the defect at the left end, the difference between the right-hand side and
the extrapolated slope of the interpolant, and by the last coefficient of the interpolant.

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega under a brake;
  whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in full slip
  (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import inline_kernel, kernel
from .collocation import DIFFERENTIATION, EXTRAPOLATION_TO_START, N, multiply_matrix
from .drive import drive_rounding, load_at_node
from .records import ROUNDING
from .rhs import has_strong_friction
from .workspace import (
    ROW_D_SLOPE,
    ROW_DENSE_OMEGA_OR_D,
    ROW_DENSE_V,
    ROW_DP_DD,
    ROW_DRIVE,
    ROW_DV_DP,
    ROW_OMEGA_OR_D,
    ROW_P,
    ROW_P_DIAGONAL,
    ROW_P_RATE,
    ROW_P_SLOPE,
    ROW_RELAXATION,
    ROW_SPEED,
    ROW_V,
    ROW_WEIGHTED_RATE,
    last_output_tau,
    node_time,
)

#: Tolerance of the error of one step, divided by rtol: the error of a motion is a sum over steps.  With 0.25 the error
#: of V and omega of 2400 motions was below 0.6 rtol at rtol 1e-6 and 1e-9, with 1 up to 4 rtol.
ERROR_FRACTION = 0.25
#: Tolerance of Newton's iteration, divided by that of the error of the step: with larger last updates than 0.004 rtol,
#: which is the product with ERROR_FRACTION, losses of motions from rest were wrong by 60 to 100 rtol.
NEWTON_FRACTION = 0.016
#: Smallest tolerance of a step or of Newton's iteration, dimensionless: rounding of the residuals leaves updates of
#: this size.
LEAST_TOLERANCE = 1e-14
#: Rounding error of Q in a defect of V', divided by mu: some tens of units, as the extrapolation to the left end
#: enlarges it.  No shorter step would reduce it.
_STRONG_FRICTION_ROUNDING = 30.0 * ROUNDING
#: Error of the interpolants divided by the defect at the left end, which overestimates it: 0.02 with nine nodes, and in
#: proportion to (9/N)^2 errors for a given rtol were the same with five, seven and nine nodes.  With 0.005 errors of
#: motions grow two to seven times, up to 3 rtol; with 0.2 motions take 20 to 28 % more trial steps.
_DEFECT_FACTOR = 0.02 * (9.0 / N) ** 2
#: A defect above 1/30 of the variation of p' along the step is not reduced by the whole of _DEFECT_FACTOR: the step
#: does not resolve the solution.  Without it one of 20,000 free motions was wrong at rtol 1e-4.
_UNRESOLVED_DEFECT = 30.0
#: Error divided by the last coefficient of the interpolant: ratio of successive Chebyshev coefficients, taken as 0.1,
#: times that of a power and its Chebyshev polynomial; divided by _DEFECT_FACTOR, which multiplies the sum.
_LAST_COEFFICIENT_FACTOR = 0.1 / (_DEFECT_FACTOR * 2.0 ** (N - 1))
#: |d| below which errors of d are weighted as absolute ones, and square of the |d| of the smallest weight,
#: dimensionless. Errors of V and omega do not depend on it; with 0.004 motions take up to 10 % fewer trial steps, with
#: 0.4 up to 4 % more.
_D_WEIGHT_FLOOR = 0.04


@inline_kernel
def _d_weight(d):
    """Return the weight of an error of d, dimensionless: 1 at d = 0, 1/6 at |d| = 0.2, 0.96 at |d| = 1.

    d acts on the motion through omega - V and V', whose error is that of V, and its errors decay.  An error of d is
    measured by the critical creepage, as an error of Q/mu, and less strictly relative to d itself.

    d: float, delta/delta_star, |d| <= 1; the weight is then in [1/6, 1].
    """
    return max(_D_WEIGHT_FLOOR, d * d) / (abs(d) + _D_WEIGHT_FLOOR)


@kernel
def _rounding_scale_of_V(step, work):
    """Return the V of full slip below which rounding of V' exceeds the tolerance of Newton's iteration.

    V' = Q - M + f, traction less rolling moment plus force, may be a small difference of Q and f.  Its rounding changes
    V during the step, or during the relaxation time of V if that is shorter.  It is used under a drive without feedback
    of omega on V'.

    step: Step, the trial step; ``h`` is read.
    work: Workspace, with the force and the Newton diagonal of p at the last node, mu and rtol.
    Returns a float above 0, dimensionless.
    """
    nodes = work.nodes
    V_error = ROUNDING * (work.scene.mu + abs(nodes[ROW_DRIVE + N])) * 0.5 * step.h
    V_error /= 1.0 + abs(nodes[ROW_P_DIAGONAL + N])
    return V_error / max(NEWTON_FRACTION * ERROR_FRACTION * work.options.rtol, LEAST_TOLERANCE)


@inline_kernel
def error_scales(step, regime, work):
    """Return the scales by which errors of V and of the second unknown on a step are divided.

    In full slip an error of omega is divided by the largest of |V| and |omega| on the step.  An error of V is divided
    by the largest |V| of the step, and under a drive at least by the V that rounding leaves
    (:func:`_rounding_scale_of_V`); where a feedback of omega acts on V', it is divided by the largest speed as that of
    omega.

    In partial slip an error of V is divided by the largest speed.  An error of d is multiplied by its weight
    (:func:`_d_weight` at the last node), or by the relative change of the speed that a unit of d causes if that is
    larger.

    step: Step, the trial step; ``h`` and ``undriven`` are read.
    regime: Regime, that of the step; ``full_slip`` is read.
    work: Workspace, with V and the larger speeds at its nodes; in partial slip also with d at the last one and with the
    derivatives of p.
    Returns (scale of V, scale of the second unknown), floats, dimensionless.  A scale of a speed is 0 where that speed
    is 0 at all nodes: the update or error that is divided by it is then inf or NaN, and the step is rejected.  A NaN at
    a node is passed over, but for d at the last node, with which the second scale is NaN in partial slip.
    """
    nodes, largest_speed, largest_V, V_change = work.nodes, 0.0, 0.0, 0.0
    for i in range(N + 1):
        largest_speed, largest_V = max(largest_speed, nodes[ROW_SPEED + i]), max(largest_V, abs(nodes[ROW_V + i]))
    largest_speed = max(largest_speed, largest_V)
    if regime.full_slip:
        # Without feedback of omega on V', V is measured relative to itself: omega may be larger by any factor, and a V
        # that is accurate relative to omega alone may leave its equilibrium.
        if step.undriven:
            return largest_V, largest_speed
        if work.drive.gains.force_omega != 0.0:
            return largest_speed, largest_speed
        return max(largest_V, _rounding_scale_of_V(step, work)), largest_speed
    # An error of d is an error of omega, and at given p an error of V.
    for i in range(1, N + 1):
        V_change = max(V_change, abs(nodes[ROW_DP_DD + i] * nodes[ROW_DV_DP + i]))
    V_change = max(V_change, 0.5 * work.scene.mu / work.scene.kappa * largest_V) / largest_speed
    return largest_speed, 1.0 / max(_d_weight(nodes[ROW_OMEGA_OR_D + N]), V_change)


@inline_kernel
def _defect_at_start(row, slope_row, initial_slope, nodes):
    """Return the defect of an interpolant at the left end of a step.

    It is the slope there by the right-hand side, less the slope of the interpolant extrapolated from nodes 1 ... N,
    times 2, the length of the step in t, which here is the position on the step, in [-1, 1].

    row: int, index in ``nodes`` of the value at node 0 of the row; the values at all nodes are read.
    slope_row: int, index in ``nodes`` of node 0 of the row in which the slopes of the interpolant in t are
    written; its entry of node 0 is set to 0.
    initial_slope: float, slope in t at the left end by the right-hand side, in the unit of the row.
    nodes: Workspace.nodes.
    Returns the modulus of the defect, a float >= 0 in the unit of the row; NaN if a value of the row is NaN.
    """
    multiply_matrix(DIFFERENTIATION, row, nodes[row], nodes, slope_row, nodes)
    defect = initial_slope
    for i in range(N):
        defect -= EXTRAPOLATION_TO_START[i] * nodes[slope_row + i + 1]
    return 2.0 * abs(defect)


@inline_kernel
def _variation_of_p_rate(half, nodes):
    """Return the largest difference of p' between nodes 1 ... N, times half the length of the step; a float >= 0 in the
    unit of p.

    It tells :func:`estimate_error` by how much p' varies on the step, beside which a defect counts as small or not.

    half: float, half the length of the step in tau.
    nodes: Workspace.nodes, with p' at nodes 1 ... N; one that is NaN is passed over unless it is at node 1.
    """
    smallest = largest = nodes[ROW_P_RATE + 1]
    for i in range(2, N + 1):
        smallest, largest = min(smallest, nodes[ROW_P_RATE + i]), max(largest, nodes[ROW_P_RATE + i])
    return half * (largest - smallest)


@kernel
def _relative_speed_at_first_output(step, work):
    """Return |V| at about the first output time of a step that starts at V = omega = 0, divided by the largest |V| at
    nodes 1 ... N.

    The error of the step is divided by this number, so that V is accurate relative to itself at its first output.  V is
    taken at the last node that is not after the first output time after the left end; at node 1 if all are after it,
    or at the next node where V is 0 there.  With no node after the output time, V at the end of the step is taken.

    step: Step, from V = omega = 0 on; tau and ``h`` are read.
    work: Workspace, with V at nodes 1 ... N and the output times.
    Returns a float in [0, 1], dimensionless; 1 where V is 0 at all nodes.  It is 0 only if V has come back to exactly 0
    at the last node, and the step is then rejected, as its error is inf or NaN.  A NaN of V at the node that is taken
    makes it NaN, unless no |V| is above 0; at another node it is passed over.
    """
    nodes, output_time = work.nodes, last_output_tau(work)
    for i in range(work.output_tau.size):
        if work.output_tau[i] > step.tau:
            output_time = work.output_tau[i]
            break
    largest = smallest = 0.0
    for i in range(1, N + 1):
        largest = max(largest, abs(nodes[ROW_V + i]))
        if smallest == 0.0 or node_time(step, i) <= output_time:
            smallest = abs(nodes[ROW_V + i])
    return smallest / largest if largest > 0.0 else 1.0


@kernel
def _strong_friction_rounding(regime, work):
    """Return the rounding error of a defect of V' under strong friction, per unit of tau, dimensionless; 0 elsewhere.

    V' may be a small difference of Q and f, so that 30 units of rounding of mu are left in it.  Friction is strong
    (:func:`has_strong_friction`) only where mu > kappa, so that other scenes need not ask.

    regime: Regime, that of the step; ``full_slip``, ``sigma`` and ``locked`` are read.
    work: Workspace, with Scene and Drive, and the drive at node 0, of which only the inverse mass and inertia matter.
    Returns a float: 6.6e-15 mu under strong friction in partial slip with sigma < 0, else 0.0.
    """
    strong = has_strong_friction(load_at_node(0, regime, work), regime, work.scene)
    return _STRONG_FRICTION_ROUNDING * work.scene.mu if strong else 0.0


@inline_kernel
def estimate_error(step, regime, work):
    """Return the estimated error of the dense output of a step divided by its tolerance; a step is accepted up to 1.

    The error is the largest of these, each divided by the scale of its unknown (:func:`error_scales`):

    - that of p, by its defect at the left end or by the last coefficient of V, whichever is larger, less what rounding
      of the drive and of strong friction causes; a defect above 1/30 of the variation of p' on the step counts more, as
      the step does not resolve the solution;
    - the defect of the second unknown, of which only the part counts that its relaxation leaves at the end of the step;
      left out where its slope at the left end is not known (V = 0 in partial slip);
    - in partial slip the last coefficient of d.

    The first one is divided by :func:`_relative_speed_at_first_output` where both speeds are 0 at the left end, and
    else, under a drive, multiplied by the square root of the growth of the larger speed.

    step: Step, the solved trial step; h, segment, undriven and initial_slope_known are read.
    regime: Regime, that of the step; ``full_slip``, ``sigma`` and ``locked`` are read.
    work: Workspace, with the solution at its nodes and the dense output; ROW_P_SLOPE and, where its defect is
    evaluated, ROW_D_SLOPE are written.
    Returns a float >= 0, dimensionless; inf or NaN, which the caller rejects too, where the scale of V is 0 or p is not
    finite.  A NaN of the second unknown or of V with a finite p may be passed over.
    """
    nodes, half = work.nodes, 0.5 * step.h
    scale_V, scale_d = error_scales(step, regime, work)
    dV_dp = abs(nodes[ROW_DV_DP + N])
    error = _defect_at_start(ROW_P, ROW_P_SLOPE, nodes[ROW_P_RATE] * half, nodes)
    if unlikely(work.scene.mu > work.scene.kappa):
        error = max(error - _strong_friction_rounding(regime, work) * step.h, 0.0)
    error *= dV_dp
    variation = _variation_of_p_rate(half, nodes) * dV_dp + work.options.rtol * scale_V
    error *= min(max(_UNRESOLVED_DEFECT * error / variation, 1.0), 1.0 / _DEFECT_FACTOR)
    # The defect may be small by chance where the last Chebyshev coefficient is not.
    error = max(error, _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_V + N - 1]))
    # Shorter steps do not reduce the change of V by the rounding of the drive.
    rounding = 0.0 if step.undriven else drive_rounding(step.segment, work.drive)
    error = max(error - step.h * rounding, 0.0) / scale_V
    if nodes[ROW_SPEED] == 0.0:
        error /= _relative_speed_at_first_output(step, work)
    elif not step.undriven:  # Speeds that grow are accurate relative to those at the left end.
        error *= np.sqrt(max(nodes[ROW_SPEED + N] / nodes[ROW_SPEED], 1.0))
    if step.initial_slope_known:
        weight = 1.0 if regime.full_slip else nodes[ROW_V]
        defect = _defect_at_start(ROW_OMEGA_OR_D, ROW_D_SLOPE, nodes[ROW_WEIGHTED_RATE] / weight * half, nodes)
        # The relaxation of d reduces its error; near the edge of the stick zone it ends.
        error = max(error, defect / ((1.0 + step.h * abs(nodes[ROW_RELAXATION])) * scale_d))
    if not regime.full_slip:  # The last coefficient estimates the error of d between the nodes.
        error = max(error, _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_OMEGA_OR_D + N - 1]) / scale_d)
    return _DEFECT_FACTOR * error / (ERROR_FRACTION * work.options.rtol)
