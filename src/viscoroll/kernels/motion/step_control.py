"""Step lengths: the first step of a regime, the next step after an accepted or rejected one.

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d = delta/delta_star in
  partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega under a brake;
  whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of steps, length of
  the next step.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in full slip
  (:mod:`rhs`).  p' is its slope in tau.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import inline_kernel, kernel
from ..rows.record import ALPHA, E0
from .collocation import N
from .departure_from_rest import solve_d_at_departure
from .drive import current_load, evaluate_load, segment_end
from .records import ZERO_SPEED, State
from .rhs import evaluate_rhs
from .workspace import (
    ROW_DV_DP,
    ROW_OMEGA_OR_D,
    ROW_P_DIAGONAL,
    ROW_P_RATE,
    ROW_RELAXATION,
    ROW_SPEED,
    ROW_V,
    ROW_V_RATE,
    ROW_WEIGHTED_RATE,
)

#: Relative change of the unknowns in the first step of a regime.
_FIRST_CHANGE = 0.4
#: Length of the first step in partial slip, in relaxation times of d.
_FIRST_RELAXATION_TIMES = 3.0
#: Change of d in the first step after the onset of stick, in units of (rtol V d'/(alpha feedback))^(1/3), on whose
#: scale the law bends there.
_ONSET_CHANGE = 24.0
#: Number of octaves from the first row of a law to the rate of the longest time of its material, by the construction of
#: the rows.
_ROWS_BELOW_LONGEST_TIME = 4
#: V reached in the first step from V = 0 on, in units of rtol^(1/7) times the moderate speed, as the error estimate is
#: of the order of the seventh power of the length.
_START_SPEED = 0.25
#: Time after which the slope of the drive is evaluated, divided by the time to the end of the segment.
_LOOKAHEAD = 1e-3
#: Number of relaxation times of d in a step, above which d follows V at its end: exp(-6) = 0.002 of a disturbance is
#: left.  With 2 a motion takes 25 to 62 % more trial steps, with 20 3 to 14 % more.
_RELAXED_TIMES = 6.0
#: Relative change of V in the step after the relaxation of d, divided by rtol^(1/8), as the interpolant has eight
#: coefficients.  With 1 a motion takes up to 5 % more trial steps, with 16 up to 34 % more.
_RELAXED_CHANGE = 4.0
#: Largest ratio of successive step lengths by the error of the last step.  With 3 or 12 the trial steps of motions
#: change by less than 1 %.
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

    It is 2^(e0 + 4)/kappa, with 2^e0 the end of the first row of the law in kappa |V|: between 0.5 and 1 times 1/kappa
    divided by the longest time of the material in units of T_epsilon.

    Steps from V = 0 and the limit of exponential decay (:func:`.asymptotics.is_coasting`) are measured by it.

    scene: Scene, of which kappa > 0 and e0 in the marks of ``law`` are read.
    """
    return 2.0 ** (scene.law.marks[E0] + _ROWS_BELOW_LONGEST_TIME) / scene.kappa


@kernel
def _time_to_reach_V(V_change, step_state, regime, work):
    """Return the time in tau in which V rises from 0 to a small value, with V' linear as the drive makes it.

    V' is V'(0) of node 0, at least 0, plus a slope from a second V' a thousandth of the rest of the segment later, in
    which d is that of a departure under the drive there, or that of node 0 if the equation of d has no root.

    V_change: float, that V, above 0, dimensionless.
    step_state: StepState, at V = 0, before the end of its segment.
    regime: Regime, of partial slip, at that state.
    work: Workspace, with V' and d at node 0; Scene, Drive and the last output time are read too.
    Returns a float, at least 0: the time at which V has its maximum if V does not reach V_change, which is 0 if V'
    falls from 0; a very large number or inf if V' and its slope are 0.
    """
    lookahead, V_rate = _LOOKAHEAD * (segment_end(step_state.segment, work) - step_state.tau), work.nodes[ROW_V_RATE]
    load = evaluate_load(step_state.tau + lookahead, step_state.segment, regime, work)
    _, d = solve_d_at_departure(load, regime.spin_sign, work.scene)
    rates = evaluate_rhs(State(0.0, d if d != 0.0 else work.nodes[ROW_OMEGA_OR_D]), load, regime, work.scene)
    V_rate, V_rate_slope = max(V_rate, 0.0), (rates.p_rate / rates.dp_dV - V_rate) / lookahead
    discriminant = V_rate**2 + 2.0 * V_rate_slope * V_change
    if discriminant < 0.0:  # V does not reach V_change: the step ends at its maximum.
        return -V_rate / V_rate_slope
    # At d = 1 both rates may be 0.
    return 2.0 * V_change / (V_rate + np.sqrt(discriminant) + 1e-300)


@kernel
def first_step_length(stick_formed, step_state, regime, work):
    """Return the length in tau of the first step of a regime; inf if nothing limits it.

    In full slip the larger speed changes by 0.4 of itself at the rates of the start, and V by V plus the moderate speed
    at most.  In partial slip the step is three relaxation times of d, and V changes by 0.4 of itself at most; if the
    stick zone has just formed, d changes by a small part instead, as d' bends there.  From V = 0 on in partial slip the
    step ends at a small V (:func:`_time_to_reach_V`).

    stick_formed: bool, whether the stick zone has just formed: then d' changes within a small part of the remaining
    slip; ignored in full slip and at V = 0.
    step_state: StepState, at the start of the regime.
    regime: Regime, the new one.
    work: Workspace, with V, V', the weighted rate, ROW_SPEED and the relaxation rate at node 0; Scene, Drive, rtol
    and the last output time are read too.
    Returns a float, at least 0; it is 0 where the stick zone has just formed and d' is exactly 0, and inf in full slip
    at rest or without any rate.  The caller limits it to the rest of the segment and to 1e-14 of the time from below.
    """
    nodes, scene = work.nodes, work.scene
    V, V_rate, rate = nodes[ROW_V], abs(nodes[ROW_V_RATE]), abs(nodes[ROW_WEIGHTED_RATE])
    if regime.full_slip:
        largest_speed, largest_rate = nodes[ROW_SPEED], max(V_rate, rate)
        if not (largest_speed > 0.0 and largest_rate > 0.0):
            return np.inf
        h = _FIRST_CHANGE * largest_speed / largest_rate
        return min(h, (V + moderate_speed(scene)) / V_rate) if V_rate > 0.0 else h
    if not V > ZERO_SPEED:  # The step starts from V = 0.
        V_end = _START_SPEED * work.options.rtol ** (1.0 / N) * moderate_speed(scene)
        return _time_to_reach_V(V_end, step_state, regime, work)
    h = _FIRST_RELAXATION_TIMES / abs(nodes[ROW_RELAXATION])
    if stick_formed:
        # d may change until the slip that is left feeds back on it.
        load = current_load(regime, step_state, work)
        feedback = scene.kappa * max(load.inverse_mass + load.inverse_inertia, 1.0)
        d_scale = (work.options.rtol * rate / (feedback * scene.law.rows[ALPHA])) ** (1.0 / 3.0)
        return min(h, _ONSET_CHANGE * d_scale * V / max(rate, 1e-300), V / (4.0 * feedback))
    return min(h, _FIRST_CHANGE * V / V_rate) if V_rate > 0.0 else h


@inline_kernel
def time_to_V_zero(step, state, regime, work):
    """Return the time in tau until V = 0 at the initial V', which is V/|V'|; inf if V does not decrease.

    At V = 0 the law has a kink, which no step may contain.  In partial slip V comes to 0 only against the drive: there
    the result is inf too if nothing drives, and if the prescribed slopes or, where they are 0, force plus torque
    without feedback do not act against V.

    step: Step, the trial step; tau, segment and undriven are read.
    state: State, at its left end; V is read.
    regime: Regime, that of the step; full_slip, direction and locked are read.
    work: Workspace, with V' at node 0; the Drive and j are read too.
    Returns a float, at least 0; 0 at V = 0 if V' < 0 and, in partial slip, the drive acts against V; inf for a V' of
    NaN.
    """
    V_rate = work.nodes[ROW_V_RATE]
    if not V_rate < 0.0:
        return np.inf
    if regime.full_slip:
        return -state.V / V_rate
    if step.undriven:
        return np.inf
    load = evaluate_load(step.tau, step.segment, regime, work)
    driving = load.prescribed_V_rate + load.prescribed_omega_rate
    if driving > 0.0 or (driving == 0.0 and load.force + load.torque >= 0.0):
        return np.inf
    return -state.V / V_rate


@inline_kernel
def step_length_after_relaxation(step, regime, work):
    """Return the length in tau of the step after one along which d has relaxed.

    After it d follows V, which changes slowly: V may change by 4 rtol^(1/8) of itself, at the rate p' dV/dp or, if
    that is larger, at the rate V dp'/dp.

    step: Step, the accepted one; ``h`` is read.
    regime: Regime, that of the step; ``full_slip`` is read.
    work: Workspace, with V, p', dV/dp, the Newton diagonal of p and the relaxation rate at its last node, and rtol.
    Returns a float, at least 0; the caller takes it if it is larger than the length by the error.  It is 0 in full
    slip, if the step spans six relaxation times of d or fewer, and where V is 0 at the last node (NaN if p' is 0 too);
    inf where p' and dp'/dp are 0.
    """
    nodes = work.nodes
    if regime.full_slip or not nodes[ROW_RELAXATION + N] * step.h < -_RELAXED_TIMES:
        return 0.0
    relative_rate = abs(nodes[ROW_P_RATE + N] * nodes[ROW_DV_DP + N] / nodes[ROW_V + N])
    relative_rate = max(relative_rate, abs(2.0 * nodes[ROW_P_DIAGONAL + N] / step.h))
    return _RELAXED_CHANGE * work.options.rtol ** (1.0 / (N + 1)) / relative_rate


@inline_kernel
def next_step_length(step, error, n_rejected, last_h, last_error):
    """Return the length in tau of the step after a trial step, by its error.

    The length is that of the trial step times 0.9 error^(-1/7), a factor limited to [0.1, 6].  After a boundary layer
    errors stay small although steps grow: after an accepted step the length is then multiplied by (h/last_h)
    (last_error/error)^(1/7) too, a factor limited to [1, 1.3].  After a rejected one it is at most 0.7 of that of the
    trial step at the first rejection and 0.4 at later ones.

    step: Step, the trial step; its length h is read.
    error: float, at least 0, its error divided by its tolerance, accepted up to 1; inf if Newton's iteration did not
    converge.  From 1e300 on, or with NaN, the length is that of the trial step times 0.3.
    n_rejected: int, number of rejected trial steps with the same left end before it.
    last_h: float, length in tau of the last accepted step; 0 without one.
    last_error: float, error of that step divided by its tolerance; ignored without one.
    Returns a float above 0, at least 0.1 times h; the end of the segment does not limit it.
    """
    h = _NEWTON_FAILURE * step.h
    if error < 1e300:
        h = step.h * max(_MAX_SHRINKAGE, min(_MAX_GROWTH, _SAFETY * (error + 1e-30) ** (-1.0 / N)))
    if not error <= 1.0:
        return min(h, (_FIRST_REJECTION if n_rejected == 0 else _LATER_REJECTION) * step.h)
    if last_h == 0.0:
        return h
    extra_growth = step.h / last_h * ((last_error + _ERROR_FLOOR) / (error + _ERROR_FLOOR)) ** (1.0 / N)
    return h * min(max(extra_growth, 1.0), _MAX_EXTRA_GROWTH)
