"""Step lengths: the first step of a regime, the next step after an accepted or rejected one."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..rows.record import ALPHA, E0
from .collocation import N
from .departure_from_rest import solve_d_at_departure
from .drive import current_load, evaluate_load, segment_end
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
    ZERO_SPEED,
    State,
)

#: relative change of the unknowns in the first step of a regime
_FIRST_CHANGE = 0.4
#: length of the first step in partial slip, in relaxation times of d
_FIRST_RELAXATION_TIMES = 3.0
#: change of d in the first step behind the onset of stick, in units of (rtol V d'/(alpha feedback))^(1/3)
_ONSET_CHANGE = 24.0
#: octaves from the first row of a law to the rate of the longest time of its material
_ROWS_BELOW_LONGEST_TIME = 4
#: V reached in the first step from V = 0 on, in units of rtol^(1/7) times the moderate speed
_START_SPEED = 0.25
#: time after which the slope of the drive is evaluated, divided by the time to the end of the segment
_LOOKAHEAD = 1e-3
#: relaxation times of d in a step, above which d follows V at its end
_RELAXED_TIMES = 6.0
#: relative change of V in the step after the relaxation of d, divided by rtol^(1/8)
_RELAXED_CHANGE = 4.0
#: largest ratio of successive step lengths by the error of the last step
_MAX_GROWTH = 6.0
#: smallest ratio of successive step lengths by the error of the last step
_MAX_SHRINKAGE = 0.1
#: ratio of successive step lengths where Newton's iteration failed
_NEWTON_FAILURE = 0.3
#: safety factor of the step length
_SAFETY = 0.9
#: largest additional growth where errors decrease although steps grow (behind a boundary layer)
_MAX_EXTRA_GROWTH = 1.3
#: error added in ratios of errors, so that none is 0
_ERROR_FLOOR = 1e-12
#: largest ratio of a step length to that of a rejected step, at the first rejection
_FIRST_REJECTION = 0.7
#: largest ratio of a step length to that of a rejected step, at later rejections
_LATER_REJECTION = 0.4


@kernel(inline=True)
def moderate_speed(scene):
    """Return the V that divides slow from fast rolling: 1/kappa divided by the longest time of the material, or half
    of it.
    """
    return 2.0 ** (scene.law.marks[E0] + _ROWS_BELOW_LONGEST_TIME) / scene.kappa


@kernel
def _time_to_reach_V(V_change, step_state, regime, work):
    """Return the time in which V rises from 0 to about ``V_change``, with V' changing linearly as the drive does.

    step_state, regime: StepState and Regime at V = 0; work: Workspace with node 0.
    """
    lookahead, V_rate = _LOOKAHEAD * (segment_end(step_state.segment, work) - step_state.tau), work.nodes[ROW_V_RATE]
    load = evaluate_load(step_state.tau + lookahead, step_state.segment, regime, work)
    _, d = solve_d_at_departure(load, regime.spin_sign, work.scene)
    rates = evaluate_rhs(State(0.0, d if d != 0.0 else work.nodes[ROW_OMEGA_OR_D]), load, regime, work.scene)
    V_rate, V_rate_slope = max(V_rate, 0.0), (rates.p_rate / rates.dp_dV - V_rate) / lookahead
    discriminant = V_rate**2 + 2.0 * V_rate_slope * V_change
    if discriminant < 0.0:  # V does not reach V_change: the step ends at its maximum
        return -V_rate / V_rate_slope
    # at d = 1 both rates may be 0
    return 2.0 * V_change / (V_rate + np.sqrt(discriminant) + 1e-300)


@kernel
def first_step_length(stick_formed, step_state, regime, work):
    """Return the length of the first step of a regime, inf if nothing limits it.

    stick_formed: whether the stick zone has just formed; step_state: StepState; regime: Regime; work: Workspace with
    node 0 stored.
    """
    nodes, scene = work.nodes, work.scene
    V, V_rate, rate = nodes[ROW_V], abs(nodes[ROW_V_RATE]), abs(nodes[ROW_WEIGHTED_RATE])
    if regime.full_slip:
        largest_speed, largest_rate = nodes[ROW_SPEED], max(V_rate, rate)
        if not (largest_speed > 0.0 and largest_rate > 0.0):
            return np.inf
        h = _FIRST_CHANGE * largest_speed / largest_rate
        return min(h, (V + moderate_speed(scene)) / V_rate) if V_rate > 0.0 else h
    if not V > ZERO_SPEED:  # the step starts from V = 0
        V_end = _START_SPEED * work.options.rtol ** (1.0 / N) * moderate_speed(scene)
        return _time_to_reach_V(V_end, step_state, regime, work)
    h = _FIRST_RELAXATION_TIMES / abs(nodes[ROW_RELAXATION])
    if stick_formed:
        # d may change until the slip that is left feeds back on it
        load = current_load(regime, step_state, work)
        feedback = scene.kappa * max(load.inverse_mass + load.inverse_inertia, 1.0)
        d_scale = (work.options.rtol * rate / (feedback * scene.law.rows[ALPHA])) ** (1.0 / 3.0)
        return min(h, _ONSET_CHANGE * d_scale * V / max(rate, 1e-300), V / (4.0 * feedback))
    return min(h, _FIRST_CHANGE * V / V_rate) if V_rate > 0.0 else h


@kernel(inline=True)
def time_to_V_zero(step, state, regime, work):
    """Return the time until V = 0 at the initial V', inf if V does not decrease; there the law has a kink.

    step: Step; state: State at its left end; regime: Regime; work: Workspace with node 0.
    In partial slip V only comes to 0 against the drive.
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


@kernel(inline=True)
def step_length_after_relaxation(step, regime, work):
    """Return the length of the step after one along which d has relaxed: there d follows V, which changes slowly.

    step: Step that was accepted; regime: Regime; work: Workspace with its nodes.
    Returns 0 in full slip, or if d has not relaxed.
    """
    nodes = work.nodes
    if regime.full_slip or not nodes[ROW_RELAXATION + N] * step.h < -_RELAXED_TIMES:
        return 0.0
    relative_rate = abs(nodes[ROW_P_RATE + N] * nodes[ROW_DV_DP + N] / nodes[ROW_V + N])
    relative_rate = max(relative_rate, abs(2.0 * nodes[ROW_P_DIAGONAL + N] / step.h))
    return _RELAXED_CHANGE * work.options.rtol ** (1.0 / (N + 1)) / relative_rate


@kernel(inline=True)
def next_step_length(step, error, n_rejected, last_h, last_error):
    """Return the length of the step after ``step``, whose error divided by its tolerance is ``error`` (inf: Newton
    failed).

    n_rejected: rejections before it; last_h, last_error: those of the last accepted step, last_h = 0 without one.
    Behind a boundary layer errors stay small although steps grow: then they may grow faster.
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
