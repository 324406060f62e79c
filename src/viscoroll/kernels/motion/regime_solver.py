"""Integration within one regime, step after step, to an event or to the end of a segment of the
drive.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in
  full slip (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from ..records import PRESCRIBED_V, ROUNDING, ZERO_SPEED, State, Step
from .asymptotics import continue_at_equilibrium, is_coasting, may_be_at_equilibrium
from .collocation import (
    BELOW_REST_SPEED,
    NO_EVENT,
    ROW_OMEGA_OR_D,
    ROW_P_DIAGONAL,
    ROW_RELAXATION,
    ROW_V,
    ROW_V_RATE,
    STEP_FAILED,
    STICK_EDGE,
    V_ZERO,
    N,
    change_slip,
    dense_state,
    row_range,
    set_step_length,
    shorten_step,
)
from .drive import drive_rounding, evaluate_load, is_constant, is_undriven, is_unloaded, segment_end
from .events import (
    EXTRAPOLATION_END,
    NOT_FOUND,
    ends_at_event,
    evaluate_event_functions,
    find_first_event,
    find_missed_event,
    locate_zero,
    refine_event,
)
from .output import accept_step
from .rhs import current_rates
from .step import solve_step, store_rhs
from .step_control import (
    estimate_error,
    first_step_length,
    next_step_length,
    step_length_after_relaxation,
)

#: Largest number of successive rejections: as each shortens the step to 0.7 or 0.4 of its length at
#: most, the step is then below 1e-23 of the first.
_MAX_REJECTIONS = 60
#: Error divided by its tolerance up to which a step is accepted where it cannot be shortened: the
#: error of a motion grows by 2 to 3 rtol at most.
_ACCEPTED_AT_SHORTEST = 10.0
#: V at the right end of a step divided by V at its left end, below which V = 0 is taken for the
#: event of a step that was aimed at it and on which no event function changes its sign.
_V_ZERO_DROP = 0.2
#: Error divided by its tolerance up to which a step shows where its regime ends; a step with a
#: larger one is repeated.
_MAX_ERROR_FOR_EVENTS = 1e6
#: Largest number of trials until a step ends at the event.
_MAX_TRIALS = 8
#: Error divided by its tolerance that is assigned to a step that did not end at its event: the next
#: step is then shorter, as after any rejection.
_ERROR_OF_FAILED_TRIAL = 10.0
#: Position v of an event in full slip, up to which the step is solved again with an end after the
#: event: early on a step the interpolants are less accurate relative to the time since its left
#: end; without this the time of the onset had a relative error of 7e-12.
_EARLY_EVENT = 0.5
#: Length of that step divided by the time to the event: above 1, so that the event lies on the
#: step.
_BEYOND_EARLY_EVENT = 1.1
#: Shortest step divided by the time so far and to come: a regime that is over at all nodes of such
#: a step ends there.
SHORTEST_STEP = 1e-14
#: Fraction of the time from the left end of a step to the end of its segment, beyond which a zero
#: of a prescribed V counts as at the end of the segment and belongs to the next one: 1 but for
#: rounding of the time.
BEFORE_SEGMENT_END = 1.0 - 1e-13


@inline_kernel
def _start_step(state, regime, step_state, work):
    """Store the state and the right-hand side at node 0 of the next step, and choose the branch of
    the law at d = 0.

    state: State, at the time reached.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with that time and its segment.
    work: Workspace; node 0 of V, the second unknown x, p, p', the weighted rate, max(|V|, |omega|),
    V', the derivative of x' with respect to x (ROW_RELAXATION) and dp'/dp (ROW_P_DIAGONAL) is
    written.  At V = 0 in partial slip V' is p'/(dp/dV), and the entry of ROW_RELAXATION is not
    finite.
    Returns the Regime: at d = 0 in partial slip with sigma d' < 0 the one with the opposite sigma,
    since d moves to that branch; else ``regime`` unchanged.
    """
    nodes = work.nodes
    nodes[ROW_V] = state.V
    nodes[ROW_OMEGA_OR_D] = state.omega_or_d
    rates = current_rates(state, regime, step_state, work)
    store_rhs(0, rates, nodes)
    # At V = 0 in partial slip d has its relaxed value and the rounding of d changes Q: V' then
    # follows from p'.  In full slip, where V may be below 0 too, p is V: both values are the same.
    nodes[ROW_V_RATE] = rates.V_rate if state.V > 0.0 else rates.p_rate / rates.dp_dV
    # derivative of x' with respect to the second unknown x, for the predictor, the error estimate
    # and the length of the first step
    nodes[ROW_RELAXATION] = rates.drate_dd / rates.weight
    # dp'/dp, for ``may_be_at_equilibrium``; the Newton matrices do not read it at node 0
    nodes[ROW_P_DIAGONAL] = rates.dp_rate_dV / rates.dp_dV
    if (
        not regime.full_slip
        and state.omega_or_d == 0.0
        and regime.sigma * rates.weighted_rate < 0.0
    ):
        # Both branches agree at d = 0.
        return change_slip(regime, False, -regime.sigma)
    return regime


@inline_kernel
def _end_at_V_zero(step, remaining, state, regime, work):
    """Shorten a trial step to the time at which V is expected to be 0, if that lies on it.

    At V = 0 the law has a kink, which no step may contain.  V is expected to be 0 after V/|V'| at
    the initial V', and nowhere if V does not decrease.  In partial slip V comes to 0 only against
    the drive: no zero is expected if nothing drives, or if the prescribed slopes (where they are 0,
    force plus torque without feedback) do not act against V.  A prescribed V that comes to 0 at the
    end of the segment, or after it, needs no shorter step.

    step: Step, the trial step; ``tau``, ``h``, ``segment`` and ``undriven`` are read.
    remaining: float, time in tau to the end of the segment.
    state: State, at the left end; V is read.
    regime: Regime, at that state; full_slip, direction and locked are read.
    work: Workspace, with V' at node 0; the Drive and j are read too.
    Returns (Step, whether it ends at the expected time of V = 0, a bool); the Step is unchanged
    where that time is after its end, or V' is NaN, and then the second is False; at V = 0 with
    V' < 0 its length is 0.
    """
    V_rate = work.nodes[ROW_V_RATE]
    if not V_rate < 0.0 or (step.undriven and not regime.full_slip):  # True for NaN too.
        return step, False
    if not regime.full_slip:
        load = evaluate_load(step.tau, step.segment, regime, work)
        driving = load.prescribed_V_rate + load.prescribed_omega_rate  # at most one is not 0
        if driving > 0.0 or (driving == 0.0 and load.force + load.torque >= 0.0):
            return step, False
    time = -state.V / V_rate
    if time > BEFORE_SEGMENT_END * remaining and work.drive.prescribed == PRESCRIBED_V:
        return step, False
    # in the second value ``step.h`` is the length before it is shortened
    return shorten_step(step, min(time, step.h)), time <= step.h


@inline_kernel
def _find_crossed_event(step, remaining, regime, work):
    """Return the event whose function is the first to fall below 0 on a solved step, and its
    position.

    A prescribed V that is 0 at the end of its segment does not count: the next segment decides its
    direction.

    step: Step, the solved one; ``h`` and ``undriven`` are read.
    remaining: float, time in tau to the end of the segment.
    regime: Regime, that of the step; ``full_slip``, ``spin_sign`` and ``locked`` are read.
    work: Workspace, with the event functions, ROW_SPEED, Drive and rest threshold; ROW_DENSE_EVENT
    is written.
    Returns (event, v): code of the event and its position in [0, 2]; NO_EVENT if there is none, and
    then v has no meaning.
    """
    event, v = find_first_event(step, regime, work)
    # A step that ends with its segment has ``remaining`` itself as its length: == is exact.  v/2 is
    # the fraction of the step, here of the time to the end of the segment.
    at_segment_end = step.h == remaining and v > 2.0 * BEFORE_SEGMENT_END
    if event == V_ZERO and at_segment_end and work.drive.prescribed == PRESCRIBED_V:
        return NO_EVENT, v
    return event, v


@inline_kernel
def solve_trial_step(step, remaining, targets_V_zero, dense_step, regime, work):
    """Solve a trial step; on an event shorten it until it ends there, at most _MAX_TRIALS times.

    A step on which the regime ends may be inaccurate because the law has a kink at the event.  It
    gets one shorter trial, which ends at the event: if that one is inaccurate too, the length is
    the reason, and the caller chooses it by the error.  An accurate step across an event without a
    kink is kept whole, and the regime ends at a position v on it.

    step: Step, the trial step; all fields are read.
    remaining: float, time in tau to the end of the segment.
    targets_V_zero: bool, whether the length was chosen to reach V = 0.
    dense_step: Step, whose dense output is stored; its h is 0 if there is none.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with node 0; nodes, event functions and dense output are written.
    Returns (event, v, Step, error, dense_step):

    - event: code of the event that ends the regime, NO_EVENT for none;
    - v: position at which the regime ends: on the step, or 2, its right end;
    - Step: the last one tried, whose solution is at the nodes;
    - error: its error divided by its tolerance (:func:`estimate_error`); the caller rejects a step
      with an error above 1, whatever the event.  In four cases it is not the estimate: inf where
      Newton's iteration did not converge; at most 1 where the regime had ended before the first
      node of the shortest step that time resolves; at least 10 where the trials were given up with
      NO_EVENT; NaN, or the estimate itself, where they were given up for an error that is NaN or
      above 1e6;
    - dense_step: the Step whose dense output is stored now: the last one whose iteration converged,
      or the one passed if none did.
    """
    nodes = work.nodes
    event = NO_EVENT  # the event at which the step should end, kept from trial to trial
    error = np.inf
    # Largest length of the next trial: the rest of the segment until an event has been crossed,
    # from then on the length of the last trial that crossed it.
    upper = remaining
    for _ in range(_MAX_TRIALS):
        if not solve_step(step, nodes[ROW_RELAXATION], dense_step, regime, work):
            return NO_EVENT, 2.0, step, np.inf, dense_step
        error = estimate_error(step, regime, work)
        dense_step = step
        if not error <= _MAX_ERROR_FOR_EVENTS:  # True for NaN too.
            break
        evaluate_event_functions(step, regime, work)
        first_event, v = _find_crossed_event(step, remaining, regime, work)
        # In partial slip the motion ends at V = 0: the equations have no continuation.
        V_negative = row_range(ROW_V, nodes)[0] < 0.0
        missed_event = find_missed_event(step, regime, work)
        # The regime ended before the first node.  Time does not resolve a shorter step: this one is
        # accepted, whatever its error, so that the next regime begins.
        if missed_event != NO_EVENT and step.h <= SHORTEST_STEP * (step.tau + remaining):
            return missed_event, 2.0, step, min(error, 1.0), dense_step
        # A missed event, or V < 0 without an event that was positive before: nothing on this step
        # locates the end of the regime, and the caller shortens it.
        if missed_event != NO_EVENT or (
            first_event == NO_EVENT and V_negative and not regime.full_slip
        ):
            break
        if first_event != NO_EVENT:
            event = first_event
        # A step aimed at V = 0 may end just before it, without a change of sign.
        elif (
            event == NO_EVENT
            and targets_V_zero
            and error <= 1.0
            and nodes[ROW_V + N] < _V_ZERO_DROP * nodes[ROW_V]
        ):
            event = V_ZERO
        # Without an event the step is complete; a step shortened to an event is, if the function
        # of the event has fallen to 0 at its end.
        if event == NO_EVENT or (
            first_event == NO_EVENT and ends_at_event(event, nodes, work.options.rtol)
        ):
            return event, 2.0, step, error, dense_step
        # Partial slip ends at V = 0, and |V| in two event functions of full slip has a kink there.
        has_kink = V_negative and (
            not regime.full_slip or first_event == STICK_EDGE or first_event == BELOW_REST_SPEED
        )
        # Without a kink the law of the regime continues smoothly past the event, and the dense
        # output of an accurate step gives its position: the step need not end there.  At V = 0 it
        # must, as |V| in the law has a kink there.
        if first_event != NO_EVENT and error <= 1.0 and not has_kink and first_event != V_ZERO:
            if v > _EARLY_EVENT or not regime.full_slip:
                return event, refine_event(event, v, regime, work), step, error, dense_step
            v *= _BEYOND_EARLY_EVENT
        if first_event == NO_EVENT:
            # An earlier trial crossed the event, or the step was aimed at V = 0, and this one ends
            # before the event: its function is extrapolated.  If it has no zero near, the step
            # counts as one without an event, with its own error, and a later step meets the event.
            v = locate_zero(event, 2.0, EXTRAPOLATION_END, nodes)
            if v >= NOT_FOUND:
                return NO_EVENT, 2.0, step, error, dense_step
        h = min(step.h * 0.5 * v, upper)
        # An inaccurate step is shortened only while ``upper`` is the rest of the segment, so that
        # one shorter trial follows (two, of a step as long as that rest); the other two conditions
        # leave no different length to try.
        if not (error <= 1.0 or upper == remaining) or not 0.0 < h < np.inf or h == step.h:
            break
        upper = step.h if first_event != NO_EVENT else upper
        step = shorten_step(step, h)
    return NO_EVENT, 2.0, step, max(error, _ERROR_OF_FAILED_TRIAL), dense_step


@kernel
def integrate_regime(stick_formed, state, regime, step_state, work):
    """Integrate one regime, step after step, to an event or to the end of the segment.

    A step whose error exceeds its tolerance is repeated shorter.  One that cannot be shortened is
    accepted with up to ten times its tolerance.  At an equilibrium under a constant drive the rest
    of the segment is one step in closed form; that is not tried where from this segment on no
    force, torque, brake or prescribed speed acts.

    stick_formed: bool, whether the stick zone has just formed; it affects only the first step.
    state: State, at the start.
    regime: Regime, to integrate.
    step_state: StepState, at the start; if its h is 0 the length of the first step is chosen here;
    an h above 0 is raised to 1e-14 tau (SHORTEST_STEP) where it is shorter.
    work: Workspace, of the motion; nodes, Newton matrices, dense output, outputs, quadratures and
    ends of steps are written.
    Returns (event, State, Regime, StepState) at the end of the last accepted step, or at the start
    if there was none.  The StepState counts the rejected steps too; its h is the length that
    follows from the error of the last trial step, the h passed if there was none, and 0 after an
    equilibrium.  The
    Regime is still the one that ends, but sigma may have changed at d = 0.  The event is its code
    (:mod:`collocation`), or

    - NO_EVENT at the end of the segment, if the allowed steps are used up, or if the rest of the
      motion is exponential (:func:`is_coasting`);
    - STEP_FAILED if all trials of one step were rejected and the error of the last one, the 61st or
      one after which a shorter step would not change tau, was above ten times its tolerance, or
      NaN.
    """
    nodes = work.nodes
    segment = step_state.segment
    drive = work.drive
    end = segment_end(segment, work)
    h = step_state.h
    n_rejected = 0  # trial steps rejected at the present left end
    last_h = 0.0  # length of the last accepted step; 0 if there is none
    last_error = 1.0  # its error divided by its tolerance
    h = max(h, SHORTEST_STEP * step_state.tau) if h > 0.0 else h
    undriven = is_undriven(segment, drive)
    # An equilibrium with V > 0 needs a drive; without one V decays exponentially in the end.
    constant = is_constant(segment, drive) and not is_unloaded(segment, drive)
    # Rounding error of p', up to which p' = 0 counts as an equilibrium: in full slip p' contains
    # Q = +-mu.
    noise = drive_rounding(segment, drive) + (ROUNDING * work.scene.mu if regime.full_slip else 0.0)
    dense_step = Step(
        tau=step_state.tau, h=0.0, segment=segment, initial_slope_known=False, undriven=undriven
    )
    while step_state.tau < end and step_state.n_steps < work.options.max_steps:
        if is_coasting(state, regime, step_state, work):
            break
        regime = _start_step(state, regime, step_state, work)
        if constant and may_be_at_equilibrium(noise, work):
            steady, state, step_state = continue_at_equilibrium(
                end, noise, state, regime, step_state, work
            )
            if steady:
                return NO_EVENT, state, regime, step_state
        if h == 0.0:  # The length is not chosen yet.
            h = max(
                first_step_length(stick_formed, step_state, regime, work),
                SHORTEST_STEP * step_state.tau,
            )
        remaining = end - step_state.tau
        slope_known = regime.full_slip or state.V > ZERO_SPEED
        step = Step(
            tau=step_state.tau,
            h=min(h, remaining),
            segment=segment,
            initial_slope_known=slope_known,
            undriven=undriven,
        )
        step, targets_V_zero = _end_at_V_zero(step, remaining, state, regime, work)
        # After a rejection the length is that of the error, shorter than the time to V = 0.
        targets_V_zero = targets_V_zero and n_rejected == 0
        event, v, step, error, dense_step = solve_trial_step(
            step, remaining, targets_V_zero, dense_step, regime, work
        )
        h_tried = h  # the length chosen before the end of the segment or an event cut it
        h = next_step_length(step, error, n_rejected, last_h, last_error)
        # An accepted step that the end of the segment has cut is no reason for a shorter next one.
        h = max(h, h_tried) if error <= 1.0 and step.h == remaining else h
        step_state = set_step_length(h, 1, step_state)
        n_rejected += 1  # back to 0 below, where the step is accepted
        if not error <= 1.0:  # or NaN
            if n_rejected <= _MAX_REJECTIONS and step_state.tau + h > step_state.tau:
                continue
            if not error <= _ACCEPTED_AT_SHORTEST:
                return STEP_FAILED, state, regime, step_state
            h = step.h  # Accepted although it could not be shortened: the next is as long.
        # tau + (end - tau) may differ from ``end`` by rounding.
        tau = end if v == 2.0 and step.h == remaining else step.tau + step.h * 0.5 * v
        step_state = accept_step(tau, v, step, regime, step_state, work)
        state = (
            dense_state(v, nodes) if v < 2.0 else State(nodes[ROW_V + N], nodes[ROW_OMEGA_OR_D + N])
        )
        if event != NO_EVENT:
            return event, state, regime, step_state
        h = max(h, step_length_after_relaxation(step, regime, work))
        n_rejected = 0
        last_h = step.h
        last_error = error
    return NO_EVENT, state, regime, step_state
