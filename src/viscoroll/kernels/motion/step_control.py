"""The error of a step, and the length of the next one.

The error of the dense output is estimated by two numbers: the defect at the left end, which is the
difference between the right-hand side and the extrapolated slope of the interpolant, and the last
coefficient of the interpolant.  Lengths are chosen for the first step of a regime and for the step
after an accepted or rejected one.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in
  full slip (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
"""

import math

import numpy as np

from ..law.law_record import ALPHA, E0
from ..numerics.intrinsics import unlikely
from ..numerics.jit import inline_kernel, kernel
from ..records import ROUNDING, ZERO_SPEED, State
from .collocation import (
    DIFFERENTIATION,
    EXTRAPOLATION_TO_START,
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
    ROW_V_RATE,
    ROW_WEIGHTED_RATE,
    N,
    last_output_tau,
    multiply_matrix,
    node_time,
)
from .departure_from_rest import solve_d_at_departure
from .drive import current_load, drive_rounding, evaluate_load, load_at_node, segment_end
from .rhs import evaluate_rhs, has_strong_friction

# --- Error estimate of a step, its scales and tolerances ---

#: Tolerance of the error of one step, divided by rtol: the error of a motion is a sum over steps.
#: With 0.25 the error of V and omega of 2400 motions was below 0.6 rtol at rtol 1e-6 and 1e-9, with
#: 1 up to 4 rtol.
ERROR_FRACTION = 0.25
#: Tolerance of Newton's iteration, divided by that of the error of the step: with larger last
#: updates than 0.004 rtol, which is the product with ERROR_FRACTION, losses of motions from rest
#: were wrong by 60 to 100 rtol.
NEWTON_FRACTION = 0.016
#: Smallest tolerance of a step or of Newton's iteration, dimensionless: rounding of the residuals
#: leaves updates of this size.
LEAST_TOLERANCE = 1e-14
#: Rounding error of Q in a defect of V', divided by mu: some tens of units, as the extrapolation to
#: the left end enlarges it.  No shorter step would reduce it.
_STRONG_FRICTION_ROUNDING = 30.0 * ROUNDING
#: Time in relaxation times of V, in full slip without a drive, above which V is at its equilibrium:
#: traction and rolling moment cancel, and V' is their rounding or due to the error of V.
_RELAXED_V = 1e3
#: Error of the interpolants divided by the defect at the left end, which overestimates it: 0.02
#: with nine nodes, and in proportion to (9/N)^2 errors for a given rtol were the same with five,
#: seven and nine nodes.  With 0.005 errors of motions grow two to seven times, up to 3 rtol; with
#: 0.2 motions take 20 to 28 % more trial steps.
_DEFECT_FACTOR = 0.02 * (9.0 / N) ** 2
#: A defect above 1/30 of the variation of p' along the step is not reduced by the whole of
#: _DEFECT_FACTOR: the step does not resolve the solution.  Without it one of 20,000 free motions
#: was wrong at rtol 1e-4.
_UNRESOLVED_DEFECT = 30.0
#: Error divided by the last coefficient of the interpolant: ratio of successive Chebyshev
#: coefficients, taken as 0.1, times that of a power and its Chebyshev polynomial; divided by
#: _DEFECT_FACTOR, which multiplies the sum.
_LAST_COEFFICIENT_FACTOR = 0.1 / (_DEFECT_FACTOR * 2.0 ** (N - 1))
#: |d| below which errors of d are weighted as absolute ones, and square of the |d| of the smallest
#: weight, dimensionless. Errors of V and omega do not depend on it; with 0.004 motions take up to
#: 10 % fewer trial steps, with 0.4 up to 4 % more.
_D_WEIGHT_FLOOR = 0.04


@inline_kernel
def error_scales(step, regime, work):
    """Return the scales by which errors of V and of the second unknown on a step are divided.

    In full slip an error of omega is divided by the largest of |V| and |omega| on the step.  An
    error of V is divided by the largest |V| of the step, and under a drive at least by the V below
    which rounding of V' exceeds the tolerance of Newton's iteration; where a feedback of omega acts
    on V', it is divided by the largest speed as that of omega.  V' = Q - M + f, traction less
    rolling moment plus force, may be a small difference of Q and f.  Its rounding changes V during
    the step, or during the relaxation time of V if that is shorter.

    In partial slip an error of V is divided by the largest speed.  An error of d is multiplied by
    its weight at the last node, or by the relative change of the speed that a unit of d causes if
    that is larger.  The weight is 1 at d = 0, 1/6 at |d| = 0.2, 0.96 at |d| = 1: d acts on the
    motion through omega - V and V', whose error is that of V, and its errors decay.  An error of d
    is measured by the critical creepage, as an error of Q/mu, and less strictly relative to d
    itself.

    step: Step, the trial step; ``h`` and ``undriven`` are read.
    regime: Regime, that of the step; ``full_slip`` is read.
    work: Workspace, with V and the larger speeds at its nodes, the force and the Newton diagonal of
    p at the last one; in partial slip also with d at the last one and with the derivatives of p.
    Returns (scale of V, scale of the second unknown), floats, dimensionless.  A scale of a speed is
    0 where that speed is 0 at all nodes: the update or error that is divided by it is then inf or
    NaN, and the step is rejected.  A NaN at a node is passed over, but for d at the last node, with
    which the second scale is NaN in partial slip.
    """
    nodes = work.nodes
    largest_speed = 0.0
    largest_V = 0.0
    V_change = 0.0
    for i in range(N + 1):
        largest_speed = max(largest_speed, nodes[ROW_SPEED + i])
        largest_V = max(largest_V, abs(nodes[ROW_V + i]))
    largest_speed = max(largest_speed, largest_V)
    if regime.full_slip:
        # Without feedback of omega on V', V is measured relative to itself: omega may be larger by
        # any factor, and a V that is accurate relative to omega alone may leave its equilibrium.
        if step.undriven:
            return largest_V, largest_speed
        if work.drive.gains.force_omega != 0.0:
            return largest_speed, largest_speed
        # rounding of V', |Q| = mu and the force, the first row of the drive, times half the length;
        # the diagonal is dV'/dV times half the length, so that the sum takes the shorter of both
        # times
        V_error = ROUNDING * (work.scene.mu + abs(nodes[ROW_DRIVE + N])) * 0.5 * step.h
        V_error /= 1.0 + abs(nodes[ROW_P_DIAGONAL + N])
        stop = max(NEWTON_FRACTION * ERROR_FRACTION * work.options.rtol, LEAST_TOLERANCE)
        return max(largest_V, V_error / stop), largest_speed
    # An error of d is an error of omega, and at given p an error of V.
    for i in range(1, N + 1):
        V_change = max(V_change, abs(nodes[ROW_DP_DD + i] * nodes[ROW_DV_DP + i]))
    # change of omega by a unit of d, about delta_star V = (mu/(2 kappa)) V, or of V at given p
    V_change = max(V_change, 0.5 * work.scene.mu / work.scene.kappa * largest_V) / largest_speed
    d = nodes[ROW_OMEGA_OR_D + N]
    weight = max(_D_WEIGHT_FLOOR, d * d) / (abs(d) + _D_WEIGHT_FLOOR)
    return largest_speed, 1.0 / max(weight, V_change)


@inline_kernel
def _defect_at_start(row, slope_row, initial_slope, nodes):
    """Return the defect of an interpolant at the left end of a step.

    With t the position on the step, in [-1, 1], it is the slope there by the right-hand side less
    the slope of the interpolant, extrapolated from nodes 1 ... N; both slopes are in t.  The
    difference is multiplied by 2, the length of the step in t.

    row: int, index in ``nodes`` of the value at node 0 of the row; the values at all nodes are
    read.
    slope_row: int, index in ``nodes`` of node 0 of the row in which the slopes of the interpolant
    in t are written; its entry of node 0 is set to 0.
    initial_slope: float, slope in t at the left end by the right-hand side, in the unit of the row.
    nodes: Workspace.nodes.
    Returns the modulus of the defect, a float >= 0 in the unit of the row; NaN if a value of the
    row is NaN.
    """
    multiply_matrix(DIFFERENTIATION, row, nodes[row], nodes, slope_row, nodes)
    # slopes at nodes 1 ... N are those of the equations; their extrapolation tests node 0
    defect = initial_slope
    for i in range(N):
        defect -= EXTRAPOLATION_TO_START[i] * nodes[slope_row + i + 1]
    return 2.0 * abs(defect)


@kernel
def _relative_speed_at_first_output(step, work):
    """Return |V| at about the first output time of a step that starts at V = omega = 0, divided by
    the largest |V| at nodes 1 ... N.

    The error of the step is divided by this number, so that V is accurate relative to itself at its
    first output.  V is taken at the last node that is not after the first output time after the
    left end; at node 1 if all are after it, or at the next node where V is 0 there.  With no node
    after the output time, V at the end of the step is taken.

    step: Step, from V = omega = 0 on; tau and ``h`` are read.
    work: Workspace, with V at nodes 1 ... N and the output times.
    Returns a float in [0, 1], dimensionless; 1 where V is 0 at all nodes.  It is 0 only if V has
    come back to exactly 0 at the last node, and the step is then rejected, as its error is inf or
    NaN.  A NaN of V at the node that is taken makes it NaN, unless no |V| is above 0; at another
    node it is passed over.
    """
    nodes = work.nodes
    output_time = last_output_tau(work)
    for i in range(work.output_tau.size):  # the first one after the left end
        if work.output_tau[i] > step.tau:
            output_time = work.output_tau[i]
            break
    largest = smallest = 0.0
    for i in range(1, N + 1):
        largest = max(largest, abs(nodes[ROW_V + i]))
        if smallest == 0.0 or node_time(step, i) <= output_time:
            smallest = abs(nodes[ROW_V + i])
    return smallest / largest if largest > 0.0 else 1.0


@inline_kernel
def estimate_error(step, regime, work):
    """Return the estimated error of the dense output of a step divided by its tolerance; a step is
    accepted up to 1.

    The error is the largest of these, each divided by the scale of its unknown
    (:func:`error_scales`):

    - that of p, by its defect at the left end or by the last coefficient of V, whichever is larger,
      less what rounding of the drive and of strong friction causes; a defect above 1/30 of the
      variation of p' on the step counts more, as the step does not resolve the solution; of the
      defect only the part counts that a fast relaxation of V in free full slip leaves;
    - the defect of the second unknown, of which only the part counts that its relaxation leaves at
      the end of the step; left out where its slope at the left end is not known (V = 0 in partial
      slip);
    - in partial slip the last coefficient of d.

    The first one is divided by :func:`_relative_speed_at_first_output` where both speeds are 0 at
    the left end, and else, under a drive, multiplied by the square root of the growth of the larger
    speed.

    step: Step, the solved trial step; h, segment, undriven and initial_slope_known are read.
    regime: Regime, that of the step; ``full_slip``, ``sigma`` and ``locked`` are read.
    work: Workspace, with the solution at its nodes and the dense output; ROW_P_SLOPE and, where its
    defect is evaluated, ROW_D_SLOPE are written.
    Returns a float >= 0, dimensionless; inf or NaN, which the caller rejects too, where the scale
    of V is 0 or p is not finite.  A NaN of the second unknown or of V with a finite p may be passed
    over.
    """
    nodes = work.nodes
    half_h = 0.5 * step.h
    scale_V, scale_d = error_scales(step, regime, work)
    dV_dp = abs(nodes[ROW_DV_DP + N])
    error = _defect_at_start(ROW_P, ROW_P_SLOPE, nodes[ROW_P_RATE] * half_h, nodes)
    # Friction is strong only where k = mu/(2 kappa) > 0.8 (1 + 1/j) or, with omega given, > 0.8:
    # mu > kappa is necessary, and cheap to test.
    if unlikely(work.scene.mu > work.scene.kappa):
        # V' may be a small difference of Q and f, in which 30 units of rounding of mu are left.
        if has_strong_friction(load_at_node(0, regime, work), regime, work.scene):
            error = max(error - _STRONG_FRICTION_ROUNDING * work.scene.mu * step.h, 0.0)
    # As for d below: where V relaxes to its equilibrium within the step, its error does so too.
    relaxation = -nodes[ROW_P_DIAGONAL + N]
    if unlikely(relaxation > _RELAXED_V) and regime.full_slip and step.undriven:
        error /= relaxation
    error *= dV_dp  # From here on an error of V; ``variation`` too.
    # by how much p' varies between the nodes at which the equations are met
    smallest = largest = nodes[ROW_P_RATE + 1]
    for i in range(2, N + 1):
        smallest = min(smallest, nodes[ROW_P_RATE + i])
        largest = max(largest, nodes[ROW_P_RATE + i])
    variation = half_h * (largest - smallest) * dV_dp + work.options.rtol * scale_V
    # The result is multiplied by _DEFECT_FACTOR < 1.  This factor, between 1 and its inverse, takes
    # the reduction back in proportion to the defect relative to the variation.
    error *= min(max(_UNRESOLVED_DEFECT * error / variation, 1.0), 1.0 / _DEFECT_FACTOR)
    # The defect may be small by chance where the last Chebyshev coefficient is not.
    error = max(error, _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_V + N - 1]))
    # Shorter steps do not reduce the change of V by the rounding of the drive.
    rounding = 0.0 if step.undriven else drive_rounding(step.segment, work.drive)
    error = max(error - step.h * rounding, 0.0) / scale_V
    if nodes[ROW_SPEED] == 0.0:  # From rest V must be accurate relative to itself at an output.
        error /= _relative_speed_at_first_output(step, work)
    elif not step.undriven:  # Speeds that grow are accurate relative to those at the left end.
        error *= np.sqrt(max(nodes[ROW_SPEED + N] / nodes[ROW_SPEED], 1.0))
    if step.initial_slope_known:
        weight = 1.0 if regime.full_slip else nodes[ROW_V]
        defect = _defect_at_start(
            ROW_OMEGA_OR_D, ROW_D_SLOPE, nodes[ROW_WEIGHTED_RATE] / weight * half_h, nodes
        )
        # The relaxation of d reduces its error; near the edge of the stick zone it ends.
        error = max(error, defect / ((1.0 + step.h * abs(nodes[ROW_RELAXATION])) * scale_d))
    if not regime.full_slip:  # The last coefficient estimates the error of d between the nodes.
        error = max(
            error,
            _LAST_COEFFICIENT_FACTOR * abs(work.nodes[ROW_DENSE_OMEGA_OR_D + N - 1]) / scale_d,
        )
    return _DEFECT_FACTOR * error / (ERROR_FRACTION * work.options.rtol)


# --- Step lengths ---

#: Relative change of the unknowns in the first step of a regime.
_FIRST_CHANGE = 0.4
#: Length of the first step in partial slip, in relaxation times of d.
_FIRST_RELAXATION_TIMES = 3.0
#: Change of d in the first step after the onset of stick, in units of (rtol V d'/(alpha
#: feedback))^(1/3), on whose scale the law bends there.
_ONSET_CHANGE = 24.0
#: Number of octaves from the first row of a law to the rate of the longest time of its material, by
#: the construction of the rows.
_ROWS_BELOW_LONGEST_TIME = 4
#: V reached in the first step from V = 0 on, in units of rtol^(1/7) times the moderate speed, as
#: the error estimate is of the order of the seventh power of the length.
_START_SPEED = 0.25
#: Time after which the slope of the drive is evaluated, divided by the time to the end of the
#: segment.
_LOOKAHEAD = 1e-3
#: Number of relaxation times of d in a step, above which d follows V at its end: exp(-6) = 0.002 of
#: a disturbance is left.  With 2 a motion takes 25 to 62 % more trial steps, with 20 3 to 14 %
#: more.
_RELAXED_TIMES = 6.0
#: Relative change of V in the step after the relaxation of d, divided by rtol^(1/8), as the
#: interpolant has eight coefficients.  With 1 a motion takes up to 5 % more trial steps, with 16 up
#: to 34 % more.
_RELAXED_CHANGE = 4.0
#: Largest ratio of successive step lengths by the error of the last step.  With 3 or 12 the trial
#: steps of motions change by less than 1 %.
_MAX_GROWTH = 6.0
#: Smallest ratio of successive step lengths by the error of the last step.
_MAX_SHRINKAGE = 0.1
#: Ratio of successive step lengths where Newton's iteration did not converge.
_NEWTON_FAILURE = 0.3
#: Safety factor of the step length, so that few steps are rejected.
_SAFETY = 0.9
#: Largest additional growth where errors decrease although steps grow, as after a boundary layer.
_MAX_EXTRA_GROWTH = 1.3
#: Error divided by its tolerance that is added in ratios of errors, so that none is 0.
_ERROR_FLOOR = 1e-12
#: Largest ratio of a step length to that of a rejected step, at the first rejection.
_FIRST_REJECTION = 0.7
#: Largest ratio of a step length to that of a rejected step, at later rejections.
_LATER_REJECTION = 0.4


@inline_kernel
def moderate_speed(scene):
    """Return the V that divides slow from fast rolling, a float above 0, dimensionless.

    It is 2^(e0 + 4)/kappa, with 2^e0 the end of the first row of the law in kappa |V|: between 0.5
    and 1 times 1/kappa divided by the longest time of the material in units of T_epsilon.

    Steps from V = 0 and the limit of exponential decay (:func:`.asymptotics.is_coasting`) are
    measured by it.

    scene: Scene, of which kappa > 0 and e0 in the marks of ``law`` are read.
    """
    return math.ldexp(1.0, scene.law.marks[E0] + _ROWS_BELOW_LONGEST_TIME) / scene.kappa


@kernel
def _time_to_reach_V(V_change, step_state, regime, work):
    """Return the time in tau in which V rises from 0 to a small value, with V' linear as the drive
    makes it.

    V' is V'(0) of node 0, at least 0, plus a slope from a second V' a thousandth of the rest of the
    segment later, in which d is that of a departure under the drive there, or that of node 0 if the
    equation of d has no root.

    V_change: float, that V, above 0, dimensionless.
    step_state: StepState, at V = 0, before the end of its segment.
    regime: Regime, of partial slip, at that state.
    work: Workspace, with V' and d at node 0; Scene, Drive and the last output time are read too.
    Returns a float, at least 0: the time at which V has its maximum if V does not reach V_change,
    which is 0 if V' falls from 0; a very large number or inf if V' and its slope are 0.
    """
    # Time until the drive is evaluated again.
    lookahead = _LOOKAHEAD * (segment_end(step_state.segment, work) - step_state.tau)
    V_rate = work.nodes[ROW_V_RATE]
    load = evaluate_load(step_state.tau + lookahead, step_state.segment, regime, work)
    _, d = solve_d_at_departure(load, regime.spin_sign, work.scene)
    rates = evaluate_rhs(
        State(0.0, d if d != 0.0 else work.nodes[ROW_OMEGA_OR_D]), load, regime, work.scene
    )
    # At V = 0 and fixed d, p' = dp/dV V'.
    V_rate_slope = (rates.p_rate / rates.dp_dV - V_rate) / lookahead
    V_rate = max(V_rate, 0.0)
    # V_rate t + V_rate_slope t^2/2 = V_change, solved for the smaller t > 0 in the form without
    # cancellation.
    discriminant = V_rate * V_rate + 2.0 * V_rate_slope * V_change
    if discriminant < 0.0:  # V does not reach V_change: the step ends at its maximum.
        return -V_rate / V_rate_slope
    # At d = 1 both rates may be 0: 1e-300 makes the time very large then, not a division by 0.
    return 2.0 * V_change / (V_rate + np.sqrt(discriminant) + 1e-300)


@kernel
def first_step_length(stick_formed, step_state, regime, work):
    """Return the length in tau of the first step of a regime; inf if nothing limits it.

    In full slip the larger speed changes by 0.4 of itself at the rates of the start, and V by V
    plus the moderate speed at most.  In partial slip the step is three relaxation times of d, and V
    changes by 0.4 of itself at most; if the stick zone has just formed, d changes by a small part
    instead, as d' bends there.  From V = 0 on in partial slip the step ends at a small V
    (:func:`_time_to_reach_V`).

    stick_formed: bool, whether the stick zone has just formed: then d' changes within a small part
    of the remaining slip; ignored in full slip and at V = 0.
    step_state: StepState, at the start of the regime.
    regime: Regime, the new one.
    work: Workspace, with V, V', the weighted rate, ROW_SPEED and the relaxation rate at node 0;
    Scene, Drive, rtol and the last output time are read too.
    Returns a float, at least 0; it is 0 where the stick zone has just formed and d' is exactly 0,
    and inf in full slip at rest or without any rate.  The caller limits it to the rest of the
    segment and to 1e-14 of the time from below.
    """
    nodes = work.nodes
    scene = work.scene
    V = nodes[ROW_V]
    V_rate = abs(nodes[ROW_V_RATE])
    rate = abs(nodes[ROW_WEIGHTED_RATE])
    if regime.full_slip:
        largest_speed = nodes[ROW_SPEED]
        largest_rate = max(V_rate, rate)
        if not (largest_speed > 0.0 and largest_rate > 0.0):  # Nothing to compare, or NaN.
            return np.inf
        h = _FIRST_CHANGE * largest_speed / largest_rate
        return min(h, (V + moderate_speed(scene)) / V_rate) if V_rate > 0.0 else h
    if not V > ZERO_SPEED:  # The step starts from V = 0.
        V_end = _START_SPEED * work.options.rtol ** (1.0 / N) * moderate_speed(scene)
        return _time_to_reach_V(V_end, step_state, regime, work)
    h = _FIRST_RELAXATION_TIMES / abs(nodes[ROW_RELAXATION])
    if stick_formed:
        # With x = 1 - |d|, L = 1 and H = alpha, its limit for a small stick zone, Q = +-mu (1 -
        # alpha x^2).  By the equation of d (rhs) the term alpha x^2 changes V d' by 2 kappa (1/m +
        # 1/J) alpha x^2 = 2 feedback alpha x^2, with 1/m and 1/J the inverse mass and inertia,
        # whose sum is taken as at least 1.  While x grows from 0 to x_1 at the rate V x' = rate, in
        # the time x_1 V/rate, this changes d by 2 feedback alpha x_1^3/(3 rate): by about rtol at
        # x_1 = (rtol rate/(feedback alpha))^(1/3), d_scale.
        # ``feedback`` is kappa (1/m + 1/J); alpha is the first number of the head of the rows.
        load = current_load(regime, step_state, work)
        feedback = scene.kappa * max(load.inverse_mass + load.inverse_inertia, 1.0)
        d_scale = (work.options.rtol * rate / (feedback * scene.law.rows[ALPHA])) ** (1.0 / 3.0)
        # V/(4 feedback) is the relaxation time of d at d = 0 with H = 1, where the slope of 2
        # feedback x^2 is 4 feedback.  A rate of 0 makes d_scale and the length 0; 1e-300 keeps 0/0
        # away.
        h = min(h, _ONSET_CHANGE * d_scale * V / max(rate, 1e-300))
        return min(h, V / (4.0 * feedback))
    return min(h, _FIRST_CHANGE * V / V_rate) if V_rate > 0.0 else h


@inline_kernel
def step_length_after_relaxation(step, regime, work):
    """Return the length in tau of the step after one along which d has relaxed.

    After it d follows V, which changes slowly: V may change by 4 rtol^(1/8) of itself, at the rate
    p' dV/dp or, if that is larger, at the rate V dp'/dp.

    step: Step, the accepted one; ``h`` is read.
    regime: Regime, that of the step; ``full_slip`` is read.
    work: Workspace, with V, p', dV/dp, the Newton diagonal of p and the relaxation rate at its last
    node, and rtol.
    Returns a float, at least 0; the caller takes it if it is larger than the length by the error.
    It is 0 in full slip, if the step spans six relaxation times of d or fewer, and where V is 0 at
    the last node (NaN if p' is 0 too); inf where p' and dp'/dp are 0.
    """
    nodes = work.nodes
    # ``not <`` is True for a NaN of the relaxation rate too.
    if regime.full_slip or not nodes[ROW_RELAXATION + N] * step.h < -_RELAXED_TIMES:
        return 0.0
    relative_rate = abs(nodes[ROW_P_RATE + N] * nodes[ROW_DV_DP + N] / nodes[ROW_V + N])
    # The Newton diagonal is dp'/dp times half the length of the step.
    relative_rate = max(relative_rate, abs(2.0 * nodes[ROW_P_DIAGONAL + N] / step.h))
    return _RELAXED_CHANGE * work.options.rtol ** (1.0 / (N + 1)) / relative_rate


@inline_kernel
def next_step_length(step, error, n_rejected, last_h, last_error):
    """Return the length in tau of the step after a trial step, by its error.

    The length is that of the trial step times 0.9 error^(-1/7), a factor limited to [0.1, 6].
    After a boundary layer errors stay small although steps grow: after an accepted step the length
    is then multiplied by (h/last_h) (last_error/error)^(1/7) too, a factor limited to [1, 1.3].
    After a rejected one it is at most 0.7 of that of the trial step at the first rejection and 0.4
    at later ones.

    step: Step, the trial step; its length h is read.
    error: float, at least 0, its error divided by its tolerance, accepted up to 1; inf if Newton's
    iteration did not converge.  From 1e300 on, or with NaN, the length is that of the trial step
    times 0.3.
    n_rejected: int, number of rejected trial steps with the same left end before it.
    last_h: float, length in tau of the last accepted step; 0 without one.
    last_error: float, error of that step divided by its tolerance; ignored without one.
    Returns a float above 0, at least 0.1 times h; the end of the segment does not limit it.
    """
    h = _NEWTON_FAILURE * step.h
    if error < 1e300:  # False for inf and NaN.  1e-30 keeps an error of 0 from a division by 0.
        h = step.h * max(_MAX_SHRINKAGE, min(_MAX_GROWTH, _SAFETY * (error + 1e-30) ** (-1.0 / N)))
    if not error <= 1.0:  # Rejected, by NaN too.
        return min(h, (_FIRST_REJECTION if n_rejected == 0 else _LATER_REJECTION) * step.h)
    if last_h == 0.0:
        return h
    extra_growth = (
        step.h / last_h * ((last_error + _ERROR_FLOOR) / (error + _ERROR_FLOOR)) ** (1.0 / N)
    )
    return h * min(max(extra_growth, 1.0), _MAX_EXTRA_GROWTH)
