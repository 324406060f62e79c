"""Error estimate of a step, its scales and tolerances.

The error of the dense output is estimated by the defect at the left end, the difference between the right-hand side and
the extrapolated slope of the interpolant, and by the last coefficient of the interpolant.
"""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import kernel
from .collocation import DIFFERENTIATION, EXTRAPOLATION_TO_START, N, multiply_matrix
from .drive import drive_rounding, load_at_node
from .rhs import has_strong_friction
from .workspace import (
    ROUNDING,
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

#: tolerance of the error of one step, divided by rtol: the error of a motion is a sum over steps
ERROR_FRACTION = 0.25
#: tolerance of Newton's iteration, divided by that of the error of the step
NEWTON_FRACTION = 0.016
#: smallest tolerance that rounding allows, dimensionless
LEAST_TOLERANCE = 1e-14
#: relative rounding error of Q in a defect of V', divided by mu: some tens of units, as the extrapolation enlarges it
_STRONG_FRICTION_ROUNDING = 30.0 * ROUNDING
#: error of the interpolants divided by the defect at the left end, which overestimates it
_DEFECT_FACTOR = 0.02 * (9.0 / N) ** 2
#: a defect above 1/30 of the variation of p' along the step is not reduced by the whole of _DEFECT_FACTOR: the step
#: does not resolve the solution
_UNRESOLVED_DEFECT = 30.0
#: error divided by the last coefficient of the interpolant: ratio of successive coefficients, 0.1, times that of a
#: power and its Chebyshev polynomial
_LAST_COEFFICIENT_FACTOR = 0.1 / (_DEFECT_FACTOR * 2.0 ** (N - 1))
#: |d| below which errors of d are weighted as absolute ones
_D_WEIGHT_FLOOR = 0.04


@kernel(inline=True)
def _d_weight(d):
    """Return the weight of an error of d at this d, dimensionless.

    d acts through omega - V and V', whose error is that of V, and its errors decay.  The error is held relative to the
    critical creepage, as an error of Q/mu, and less strictly relative to d itself.
    """
    return max(_D_WEIGHT_FLOOR, d * d) / (abs(d) + _D_WEIGHT_FLOOR)


@kernel
def _rounding_scale_of_V(step, work):
    """Return the V of full slip below which rounding of V' exceeds the tolerance of Newton's iteration.

    step: Step; work: Workspace with the values at its nodes. V' = Q - M + f may be a small difference of Q and f.
    Its rounding changes V during the step, or during the relaxation time of V if that is shorter.
    """
    nodes = work.nodes
    V_error = ROUNDING * (work.scene.mu + abs(nodes[ROW_DRIVE + N])) * 0.5 * step.h
    V_error /= 1.0 + abs(nodes[ROW_P_DIAGONAL + N])
    return V_error / max(NEWTON_FRACTION * ERROR_FRACTION * work.options.rtol, LEAST_TOLERANCE)


@kernel(inline=True)
def error_scales(step, regime, work):
    """Return (scale of V, scale of the second unknown) by which errors and updates of a step are divided.

    step: Step; regime: Regime; work: Workspace with the values at its nodes.
    Speeds are measured by the largest one of the step; d by its weight.
    """
    nodes, largest_speed, largest_V, V_change = work.nodes, 0.0, 0.0, 0.0
    for i in range(N + 1):
        largest_speed, largest_V = max(largest_speed, nodes[ROW_SPEED + i]), max(largest_V, abs(nodes[ROW_V + i]))
    largest_speed = max(largest_speed, largest_V)
    if regime.full_slip:
        # without feedback of omega on V', V is measured relative to itself: omega may be larger by any factor, and a V
        # that is accurate relative to omega alone may leave its equilibrium
        if step.undriven:
            return largest_V, largest_speed
        if work.drive.gains.force_omega != 0.0:
            return largest_speed, largest_speed
        return max(largest_V, _rounding_scale_of_V(step, work)), largest_speed
    # an error of d is an error of omega, and at given p an error of V
    for i in range(1, N + 1):
        V_change = max(V_change, abs(nodes[ROW_DP_DD + i] * nodes[ROW_DV_DP + i]))
    V_change = max(V_change, 0.5 * work.scene.mu / work.scene.kappa * largest_V) / largest_speed
    return largest_speed, 1.0 / max(_d_weight(nodes[ROW_OMEGA_OR_D + N]), V_change)


@kernel(inline=True)
def _defect_at_start(row, slope_row, initial_slope, nodes):
    """Return the defect at the left end: its slope less that extrapolated from the nodes, times the length of the step.

    row: values; slope_row: row that receives the slopes of the interpolant; initial_slope: slope in t at the left end.
    """
    multiply_matrix(DIFFERENTIATION, row, nodes[row], nodes, slope_row, nodes)
    defect = initial_slope
    for i in range(N):
        defect -= EXTRAPOLATION_TO_START[i] * nodes[slope_row + i + 1]
    return 2.0 * abs(defect)


@kernel(inline=True)
def _variation_of_p_rate(half, nodes):
    """Return the largest difference of p' between nodes 1 ... N, times ``half`` (half the length of the step)."""
    smallest = largest = nodes[ROW_P_RATE + 1]
    for i in range(2, N + 1):
        smallest, largest = min(smallest, nodes[ROW_P_RATE + i]), max(largest, nodes[ROW_P_RATE + i])
    return half * (largest - smallest)


@kernel
def _relative_speed_at_first_output(step, work):
    """Return V at the first output time of a step divided by the largest V of the step: V is accurate relative to
    itself there.

    step: Step from V = 0 on; work: Workspace with the values at its nodes.
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
    """Return the rounding error of a defect of V' under strong friction, per length of the step; 0 elsewhere.

    V' may be a small difference of Q and f.  Friction is strong only where mu > kappa.
    """
    strong = has_strong_friction(load_at_node(0, regime, work), regime, work.scene)
    return _STRONG_FRICTION_ROUNDING * work.scene.mu if strong else 0.0


@kernel(inline=True)
def estimate_error(step, regime, work):
    """Return the estimated error of the dense output of a step divided by its tolerance; 1 is the limit of
    acceptance.

    step: Step that is solved; regime: Regime; work: Workspace with the values at its nodes.
    Of an error of d only the part that its relaxation leaves at the end of the step counts.
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
    # the defect may be small by chance where the last Chebyshev coefficient is not
    error = max(error, _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_V + N - 1]))
    # shorter steps do not reduce the change of V by the rounding of the drive
    rounding = 0.0 if step.undriven else drive_rounding(step.segment, work.drive)
    error = max(error - step.h * rounding, 0.0) / scale_V
    if nodes[ROW_SPEED] == 0.0:
        error /= _relative_speed_at_first_output(step, work)
    elif not step.undriven:  # speeds that grow are accurate relative to those at the left end
        error *= np.sqrt(max(nodes[ROW_SPEED + N] / nodes[ROW_SPEED], 1.0))
    if step.initial_slope_known:
        weight = 1.0 if regime.full_slip else nodes[ROW_V]
        defect = _defect_at_start(ROW_OMEGA_OR_D, ROW_D_SLOPE, nodes[ROW_WEIGHTED_RATE] / weight * half, nodes)
        # the relaxation of d reduces its error; near the edge of the stick zone it ends
        error = max(error, defect / ((1.0 + step.h * abs(nodes[ROW_RELAXATION])) * scale_d))
    if not regime.full_slip:  # error of d between the nodes
        error = max(error, _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_OMEGA_OR_D + N - 1]) / scale_d)
    return _DEFECT_FACTOR * error / (ERROR_FRACTION * work.options.rtol)
