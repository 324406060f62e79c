"""Integration of one motion from regime to regime, and of many motions: the entry from Python.

A motion, free or driven, is integrated from regime to regime and from segment to segment of the
drive.  A regime changes only at a located event, or where the drive jumps and the cylinder is at
rest or held by its brake.  Of many motions each has its own start and, where given, its own scene
and drive.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
- Drive: force, torque, brake and prescribed speed, polynomials of tau on each segment; gains of the
  feedback.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
"""

import numpy as np

from ..law.law_record import element, select_material
from ..numerics.intrinsics import by_reference, by_value, copy, data_pointer, fill
from ..numerics.jit import kernel
from ..records import (
    ADDED_MASS_EXHAUSTED,
    AT_REST,
    CAME_TO_REST,
    COMPLETED,
    DIRECTION_REVERSED,
    NOT_UNIQUE,
    REGIME_AT_REST,
    ROLLING_LOSS,
    STEP_LIMIT,
    STEP_TOO_SMALL,
    Batch,
    Drive,
    Options,
    Scene,
    State,
    StepState,
    Workspace,
)
from .asymptotics import coast_to_end, is_coasting
from .collocation import (
    BELOW_REST_SPEED,
    DELTA_ZERO,
    N_SWITCHES,
    NO_EVENT,
    ONSET_TIME,
    QUADRATURE_TOTALS,
    REST_TIME,
    ROW_LENGTH,
    ROW_ONES,
    STEP_FAILED,
    STICK_EDGE,
    WORKSPACE_SIZE,
    change_slip,
    last_output_tau,
    set_step_length,
)
from .departure_from_rest import (
    AMBIGUOUS,
    NO_DEPARTURE,
    ROLLS_OFF,
    SLIDES_OFF,
    STAYS_AT_REST,
    depart_from_rest,
    find_departure_time,
)
from .drive import (
    Drives,
    continues_smoothly,
    current_load,
    drive_of_motion,
    is_undriven,
    rest_threshold,
    segment_end,
)
from .motion_law import added_inertia, added_mass_margin, creepage, omega_and_delta
from .output import (
    N_OUTPUTS,
    record_switch,
    requested_groups,
    write_due_outputs,
    write_outputs_at_rest,
)
from .regime_solver import integrate_regime
from .regimes import (
    ZERO_V_RATIO,
    apply_event,
    enter_segment,
    initial_regime,
    regime_code,
    rest_code,
)
from .rhs import current_rates
from .table_law import sticks_at_rest

# --- Integration of a motion, free or driven ---

#: Relaxation time of d, or time to V = 0, divided by the time so far, that no step can resolve: 450
#: units of rounding.
_TIME_ROUNDING = 1e-13
#: Speeds that count as 0 where something drives or will, dimensionless: as _NEGLIGIBLE_FORCE in
#: :mod:`departure_from_rest`.
_NEGLIGIBLE_SPEED = 1e-75
#: Length of the step after a relaxation of d within rounding, divided by the time so far: a hundred
#: times the time that no step can resolve.
_STEP_AFTER_RELAXATION = 1e-11


@kernel
def _advance_at_rest(step_state, work):
    """Advance a cylinder at V = omega = 0 until it departs or the segment ends, and write the
    outputs on the way.

    step_state: StepState, at the time reached.
    work: Workspace, of the motion; Scene, Drive and output times are read, outputs are written.
    Returns (kind, State, Regime, StepState):

    - ROLLS_OFF, SLIDES_OFF: it departs now; State with V = 0 and d in partial slip, omega = 0 in
      full slip; the Regime of the departure; the time and the number of trial steps stay, the
      length of the next step is not chosen;
    - STAYS_AT_REST: State of zeros, REGIME_AT_REST; the StepState at the time at which the drive
      will move it (:func:`find_departure_time`), or at the end of the segment or of the motion,
      with one trial step more, the outputs before that time written, and at the last output time
      that one too;
    - AMBIGUOUS: the equations allow a departure in both directions, or rolling off as well as
      sliding, so that the motion is not unique; State of zeros, REGIME_AT_REST; the StepState at
      the present time, with one trial step more; an output at that time is written;
    - NO_DEPARTURE: the drive moves the cylinder, but with the added mass no departure satisfies the
      equations; the rest as with AMBIGUOUS.
    """
    # d of partial slip; 0 in full slip, where it stands for omega.
    kind, regime, d = depart_from_rest(step_state.tau, step_state.segment, work)
    if kind == ROLLS_OFF or kind == SLIDES_OFF:
        return kind, State(0.0, d), regime, set_step_length(0.0, 0, step_state)
    end = (
        find_departure_time(step_state.tau, step_state.segment, work)
        if kind == STAYS_AT_REST
        else step_state.tau
    )
    closed = kind != STAYS_AT_REST or end == last_output_tau(work)
    step_state = write_outputs_at_rest(end, closed, rest_code(step_state, work), step_state, work)
    return kind, State(0.0, 0.0), regime, step_state


@kernel
def _is_below_rest_speed(moving, state, regime, step_state, work):
    """Return whether nothing drives any more and both speeds are at most the rest threshold; a
    bool.

    It is asked where a regime begins; within a regime the event BELOW_REST_SPEED is located.  It is
    False without a threshold and while something drives or will; a cylinder that does not move
    counts as below.

    moving: bool, whether the cylinder moves.
    state: State, the present one; ignored unless it moves, as is ``regime``.
    regime: Regime, at that state; ``full_slip`` is read.
    step_state: StepState, of which the segment is read.
    work: Workspace, of which Scene, Drive and the rest threshold in ``options`` are read.
    """
    rest_speed = rest_threshold(step_state.segment, work)
    if rest_speed == 0.0 or not moving:
        return rest_speed > 0.0
    return max(abs(state.V), abs(omega_and_delta(state, regime, work.scene)[0])) <= rest_speed


@kernel
def _ends_stick_zone(stick_formed, state, regime, step_state, work):
    """Return whether the added mass ends a stick zone in the instant in which it forms; a bool.

    The added mass acts in partial slip only.  Where it is large it may let |d| grow at |d| = 1,
    although the slip without it falls there: neither regime can then follow.

    stick_formed: bool, whether the stick zone has just formed; else the result is False, as it is
    for a law without added mass.
    state, regime: State and Regime in which it formed: partial slip with d = sigma.
    step_state: StepState, with the time and its segment.
    work: Workspace, of the motion; Scene and Drive are read.
    """
    return (
        stick_formed
        and added_inertia(state.V, work.scene)[0] != 0.0
        and regime.sigma * current_rates(state, regime, step_state, work).weighted_rate > 0.0
    )


@kernel
def added_mass_exhausted(event, state, regime, work):
    """Return whether the added mass in partial slip is so large that the equations are no longer
    regular; a bool.

    It is so where its margin (:func:`added_mass_margin`) is at most 0, or where the event
    STICK_EDGE, whose function is the product of the margin and 1 - |d|, is due to the margin, the
    smaller factor of the two.  In full slip it is False.  A law without added mass has a margin of
    1: the result is False then, as sigma d is about 1 at STICK_EDGE.

    event: int, code of the last event (:mod:`collocation`), or NO_EVENT.
    state: State, the present one.
    regime: Regime, at that state; ``full_slip`` and ``sigma`` are read.
    work: Workspace, of the motion; its Scene is read.
    """
    margin = added_mass_margin(added_inertia(state.V, work.scene)[0], work.scene.j)
    at_end = event == STICK_EDGE and margin < 1.0 - regime.sigma * state.omega_or_d
    return not regime.full_slip and (margin <= 0.0 or at_end)


@kernel
def relax_creep(state, regime, step_state, work):
    """Relax d to its equilibrium at a fixed time and fixed p, by bisection, where no step can
    resolve its relaxation.

    That is in partial slip where d relaxes, or changes by 1, within the rounding of time, 1e-13 of
    the time so far.  The relaxation time is V divided by the modulus of the derivative of V d' in
    d, the time of a change by 1 is V/|V d'|; neither is so short at tau = 0, or where both moduli
    are 0.  The equilibrium is the zero of V d', which is positive for smaller d; the added mass n
    in p stays that of ``state``.

    state: State, the present one.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with the time and its segment.
    work: Workspace, of which Scene and Drive are read.
    Returns (relaxes, moves, State, Regime, StepState):

    - relaxes: False in full slip, and where d takes longer: the last three are unchanged then;
    - moves: False where V falls to 0 within that rounding too, in the time V/|V'| with V' below 0,
      or is negligible, at 1e-75 and below, while something drives or will: the last three are
      unchanged then;
    - State, Regime: at the equilibrium of d in partial slip, with sigma = 1 for d >= 0 and -1 else,
      and with the V that keeps p; in full slip with the slip of |d| = 1 where there is no
      equilibrium with |d| < 1;
    - StepState: the same time, with the length 1e-11 tau of the next step.
    """
    rates = current_rates(state, regime, step_state, work)
    rounding = _TIME_ROUNDING * step_state.tau
    # V over the moduli, multiplied out: they may be 0
    relaxes = state.V < rounding * max(abs(rates.drate_dd), abs(rates.weighted_rate))
    if regime.full_slip or not relaxes:
        return False, True, state, regime, step_state
    negligible = state.V <= _NEGLIGIBLE_SPEED and not is_undriven(step_state.segment, work.drive)
    # V/|V'|, multiplied out with the sign of V': False for V' >= 0
    if negligible or state.V < -rounding * rates.V_rate:
        return True, False, state, regime, step_state
    load = current_load(regime, step_state, work)
    n = added_inertia(state.V, work.scene)[0]
    # p = inertia V + inverse_mass omega with n of ``state``, n V for the integral of n over V; V
    # follows from it with omega = V (1 + delta).
    inertia = load.inverse_inertia + load.inverse_mass * load.inverse_inertia * n
    p = inertia * state.V + load.inverse_mass * rates.omega
    d = 0.0
    low = -1.0
    high = 1.0
    while low < d < high:  # until the middle is rounded to an end
        delta = creepage(state.V, d, work.scene)
        state = State(p / (inertia + load.inverse_mass * (1.0 + delta)), d)
        regime = change_slip(regime, False, 1.0 if d >= 0.0 else -1.0)
        if current_rates(state, regime, step_state, work).weighted_rate > 0.0:
            low = d
        else:
            high = d
        d = 0.5 * (low + high)
    step_state = set_step_length(_STEP_AFTER_RELAXATION * step_state.tau, 0, step_state)
    if low > -1.0 and high < 1.0:
        return True, True, state, regime, step_state
    # One end of the bracket never moved: V d' has no zero with |d| < 1, and slip is full.
    omega = state.V * (1.0 + creepage(state.V, regime.sigma, work.scene))
    regime = change_slip(regime, True, regime.sigma)
    return True, True, State(state.V, omega), regime, step_state


@kernel
def _advance_segment(moving, state, regime, step_state, work):
    """Enter the next segment of the drive if one ends at the time reached and there is a next one.

    moving: bool, whether the cylinder moves.
    state, regime: State and Regime, the present ones; all fields are read.
    step_state: StepState, with the time and its segment.
    work: Workspace, of the motion; Scene, Drive and output times are read; a change of
    ``direction`` is recorded in ``switches`` as DIRECTION_REVERSED (:func:`record_switch`).
    Returns (moves, State, Regime, StepState), unchanged where no segment ends or the last one does.
    Else StepState has the next segment and keeps the length of the next step only where the drive
    continues smoothly; elsewhere it is 0, not chosen yet.  Of a cylinder that moves, State and
    Regime are those of :func:`enter_segment`, and it still moves unless V is 0 in partial slip or
    both speeds are 0; of one at rest they are unchanged.  The time stays; one call enters one
    segment at most.
    """
    drive = work.drive
    if (
        step_state.tau < segment_end(step_state.segment, work)
        or step_state.segment + 1 == drive.segments.shape[0]
    ):
        return moving, state, regime, step_state
    h = step_state.h if continues_smoothly(step_state.segment, drive) else 0.0
    tau, next_output, segment, n_steps, n_accepted, _ = step_state
    step_state = StepState(
        tau=tau,
        next_output=next_output,
        segment=segment + 1,
        n_steps=n_steps,
        n_accepted=n_accepted,
        h=h,
    )
    if moving:
        direction = regime.direction
        state, regime = enter_segment(state, regime, step_state, work)
        if regime.direction != direction:
            record_switch(DIRECTION_REVERSED, step_state, work)
        # In partial slip omega is 0 where V is 0.
        moving = state.V != 0.0 or (regime.full_slip and state.omega_or_d != 0.0)
    # one segment a call: the caller's loop enters others that end at the same time
    return moving, state, regime, step_state


@kernel
def _come_to_rest(code, state, regime, step_state, work):
    """Write the outputs of a motion whose speeds fall below the rest threshold now, up to its last
    output time.

    The kinetic energy that is left is added to the loss in rolling, and the time is recorded as
    that of coming to rest.  The change of regime to AT_REST is recorded unless ``code`` is -1 or
    AT_REST.

    code: int, regime in the outputs before; -1 before the first one.
    state, regime: State and Regime, the present ones; of a cylinder at rest State(0, 0).
    step_state: StepState, with the time and its segment.
    work: Workspace, of the motion; Scene and Drive are read; outputs, switches, REST_TIME (t =
    tau/gamma) and the total of the loss in rolling are written.
    Returns the StepState at the last output time, with one trial step more and all outputs written.
    """
    nodes = work.nodes
    omega = omega_and_delta(state, regime, work.scene)[0]
    if code >= 0 and code != AT_REST:
        record_switch(AT_REST, step_state, work)
    nodes[REST_TIME] = step_state.tau / work.scene.gamma
    # so that energies balance: what is left, in units of m (R/T_epsilon)^2, counts as rolled away
    nodes[QUADRATURE_TOTALS + ROLLING_LOSS] += 0.5 * (
        state.V * state.V + work.scene.j * omega * omega
    )
    return write_outputs_at_rest(last_output_tau(work), True, AT_REST, step_state, work)


@kernel
def _record_regime(code, new_code, stick_formed, step_state, work):
    """Record a change of the regime, and the time at which the stick zone first forms.

    While a brake holds omega at 0 the code is the same in full and in partial slip: a stick zone
    that forms then is recorded by its time alone.

    code: int, regime in the outputs before; -1 before the first one, which is no change.
    new_code: int, regime in the outputs from now on.
    stick_formed: bool, whether the stick zone has just formed; t = tau/gamma is then written to
    ONSET_TIME if that is NaN, whether or not the code changes.
    step_state: StepState, with the time of the change.
    work: Workspace, of the motion; switches, their numbers and ONSET_TIME are written.
    Returns ``new_code``, an int, also where it equals ``code``.
    """
    if new_code != code and code >= 0:
        record_switch(new_code, step_state, work)
    if stick_formed and np.isnan(work.nodes[ONSET_TIME]):
        work.nodes[ONSET_TIME] = step_state.tau / work.scene.gamma
    return new_code


@kernel
def _integrate_regimes(moving, stick_formed, state, regime, step_state, work):
    """Integrate regime after regime until the last output time.

    moving: bool, whether the cylinder moves; False: it is at rest, and ``state`` and ``regime`` are
    ignored.
    stick_formed: bool, whether the stick zone has just formed.
    state: State, at the start.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, at the start.
    work: Workspace, of the motion; outputs, switches and times of events are written.
    Returns (status, StepState): the StepState at the end of the integration, and why it ended:

    - COMPLETED: the last output time is reached;
    - CAME_TO_REST: both speeds fell below the rest threshold; all outputs are written;
    - STEP_LIMIT: the allowed number of trial steps is used up;
    - STEP_TOO_SMALL: all trials of one step were rejected, and d does not relax within the rounding
      of time there, or has been relaxed at this time already;
    - NOT_UNIQUE: the departure from rest is ambiguous;
    - ADDED_MASS_EXHAUSTED: the added mass leaves the range in which the equations are regular, or
      with it neither partial nor full slip can follow, in motion or from rest.

    With the last four, outputs beyond the end of the integration are not written.
    """
    event = NO_EVENT
    relaxed_at = -1.0  # tau of the last relaxation of d within rounding; -1 before one
    code = regime_code(regime) if moving else -1
    while step_state.next_output < work.output_tau.size:
        if step_state.n_steps >= work.options.max_steps:
            return STEP_LIMIT, step_state
        moving, state, regime, step_state = _advance_segment(
            moving, state, regime, step_state, work
        )
        if moving and (
            added_mass_exhausted(event, state, regime, work)
            or _ends_stick_zone(stick_formed, state, regime, step_state, work)
        ):
            return ADDED_MASS_EXHAUSTED, write_due_outputs(state, regime, step_state, work)
        event = NO_EVENT
        direction = regime.direction
        last_state = step_state  # with the time at which a cylinder that stays at rest came to rest
        if _is_below_rest_speed(moving, state, regime, step_state, work):
            event = BELOW_REST_SPEED
        elif not moving:
            departure, state, regime, step_state = _advance_at_rest(step_state, work)
            if departure == AMBIGUOUS:
                return NOT_UNIQUE, step_state
            if departure == NO_DEPARTURE:
                return ADDED_MASS_EXHAUSTED, step_state
            moving = departure != STAYS_AT_REST
        elif step_state.tau >= last_output_tau(work):
            step_state = write_due_outputs(state, regime, step_state, work)
        elif is_coasting(state, regime, step_state, work):
            return coast_to_end(state, regime, step_state, work)
        else:
            event, state, regime, step_state = integrate_regime(
                stick_formed, state, regime, step_state, work
            )
        if event == BELOW_REST_SPEED:
            return CAME_TO_REST, _come_to_rest(code, state, regime, step_state, work)
        # ``regime`` is still the one that the event ends
        stick_formed = event == STICK_EDGE and regime.full_slip
        if event == STEP_FAILED:
            # Where d relaxes faster than time resolves it is set to its equilibrium, once at a
            # time.
            relaxes = step_state.tau > relaxed_at
            if relaxes:
                relaxed_at = step_state.tau
                relaxes, moving, state, regime, step_state = relax_creep(
                    state, regime, step_state, work
                )
            if not relaxes:
                return STEP_TOO_SMALL, step_state
            continue
        # An event of exhausted added mass is not applied: the next turn of the loop ends the
        # motion.
        if event != NO_EVENT and not added_mass_exhausted(event, state, regime, work):
            moving, state, regime = apply_event(event, state, regime, step_state, work)
            # At d = 0 the law is smooth but for its second derivative, so that the length of the
            # step stays; else it is chosen anew.
            step_state = set_step_length(
                step_state.h if event == DELTA_ZERO else 0.0, 0, step_state
            )
        if moving and code >= 0 and regime.direction != direction:
            record_switch(DIRECTION_REVERSED, step_state, work)
        # A cylinder that an event has brought to V = 0 may depart again at this time: its code is
        # recorded in the next turn, when that is decided.
        if moving or event == NO_EVENT:
            new_code = regime_code(regime) if moving else rest_code(step_state, work)
            code = _record_regime(
                code, new_code, stick_formed, step_state if moving else last_state, work
            )
    return COMPLETED, step_state


@kernel
def integrate_motion(V0, omega0, record):
    """Integrate the equations of motion of V and omega, Eq. (22) of the paper, with a drive from
    t = 0 to the last output time.

    Two speeds below 1e-75 count as 0 where something drives or will, or where slip remains in free
    rolling at rest, by which the cylinder stops at once; elsewhere two
    speeds below 1e-150 are replaced by those of the free rolling in which sliding ends
    (:func:`.regimes.speeds_after_sliding`).  V0 counts as 0 up to 1e-150 of |omega0|.  From V =
    omega = 0 the cylinder stays at rest until the drive moves it.

    V0, omega0: float, initial speeds of either sign, in units of R/T_epsilon and 1/T_epsilon.
    record: Workspace, by value; ``nodes`` are 0 on entry, but for the row of ones, and the matrices
    are 0.  Outputs (units as of :func:`motion_loop`), switches and ends of steps are written;
    outputs beyond an early end keep their values.
    Returns (status, number of trial steps, number of regime changes, t of the onset of stick, t of
    coming to rest): the status is COMPLETED (0), CAME_TO_REST (1), STEP_LIMIT (2), STEP_TOO_SMALL
    (3), NOT_UNIQUE (4) or ADDED_MASS_EXHAUSTED (5) of :mod:`.records`, an int as the number of
    trial steps; all others are floats.  Reversals of direction are no regime changes; the times t =
    tau/gamma are in units of T_epsilon, NaN where the event does not occur.  The onset is the first
    time at which a stick zone forms in full slip; a start or a departure from rest in partial slip
    is none.  Coming to rest is that below the rest threshold, NaN without one.
    """
    work = by_reference(record)
    nodes = work.nodes
    step_state = StepState(tau=0.0, next_output=0, segment=0, n_steps=0, n_accepted=0, h=0.0)
    nodes[ONSET_TIME] = nodes[REST_TIME] = np.nan  # NaN where the event does not occur
    state = State(0.0, 0.0)
    regime = REGIME_AT_REST
    stick_formed = False
    largest_speed = max(abs(V0), abs(omega0))
    moving = largest_speed >= _NEGLIGIBLE_SPEED or (
        largest_speed > 0.0
        and is_undriven(0, work.drive)
        and sticks_at_rest(work.scene.kappa, work.scene.mu, by_value(work.scene.law).table)
    )
    if moving:
        V0 = V0 if abs(V0) > ZERO_V_RATIO * abs(omega0) else 0.0
        state, regime, stick_formed = initial_regime(V0, omega0, step_state, work)
        state, regime = enter_segment(state, regime, step_state, work)
    status, step_state = _integrate_regimes(moving, stick_formed, state, regime, step_state, work)
    return status, step_state.n_steps, nodes[N_SWITCHES], nodes[ONSET_TIME], nodes[REST_TIME]


# --- Many motions, each with its own start and, where given, its own scene and drive ---

#: Columns of the information on each motion.
INFO_COLUMNS = ("status", "steps", "switches", "onset_time", "rest_time")
#: Number of these columns.
N_INFO_COLUMNS = len(INFO_COLUMNS)


@kernel(allocates=True)
def motion_loop(batch, drives, t, options, rows, out, info, notes):
    """Integrate all motions of a batch.

    Batch, Drives and Options come as plain tuples: numba needs microseconds to find the type of a
    record.  Times are in units of T_epsilon, V in R/T_epsilon, omega in 1/T_epsilon; the T_epsilon
    of a series of relaxation times is the unit of time of its law.

    batch: fields of a :class:`Batch`: law, moments_differ, and kappa, mu, gamma, j, V0 and omega0,
    arrays (1,) or (n,), of n motions; n is the length of the second axis of ``out``.
    drives: fields of :class:`Drives`, over t: segments, gains, prescribed.
    t: (k,), output times, increasing, k >= 1, the first at least 0.
    options: fields of :class:`Options`: rtol, rest_speed (a V and omega; 0: no rest threshold),
    max_steps of a motion.
    rows: (q,) int, requested output rows, unchecked: V 0 (unit R/T_epsilon), omega 1 (1/T_epsilon),
    x 2 (R), angle 3 (rad), delta 4 (1), regime 5 (code), force 6 (P), torque 7 (P R), work of force
    8 and of torque 9, losses in the brake 10, in slip 11, in rolling 12 (m (R/T_epsilon)^2).
    out: (q, n, k), [quantity, motion, time], filled; NaN at times that a motion did not reach.
    info: (n, 5), [motion, INFO_COLUMNS], filled: status (COMPLETED 0, CAME_TO_REST 1, STEP_LIMIT 2,
    STEP_TOO_SMALL 3, NOT_UNIQUE 4, ADDED_MASS_EXHAUSTED 5), trial steps, regime changes, and t of
    the onset of stick and of coming to rest, NaN where they do not occur.  A motion that fails has
    its status here; the others are not affected.
    notes: (switches, step_ends), arrays (m, 2) and (l,).  Each motion writes its regime changes, t
    and code (FULL_SLIP 0, PARTIAL_SLIP 1, AT_REST 2, OMEGA_LOCKED 3, HELD_AT_REST 4;
    DIRECTION_REVERSED -1), and the ends t of its steps from their starts on, as far as they have
    room: they are meant for a single motion, as entries that a motion does not write are left as
    they were.  Returns nothing.
    """
    motions = Batch(*batch)
    drives = Drives(*drives)
    options = Options(*options)
    (with_quadratures, with_forces) = requested_groups(rows)
    (switches, step_ends) = notes
    tau = np.empty(t.size)
    quantities = np.empty((N_OUTPUTS, t.size))
    segments = np.empty(drives.segments.shape[1:])
    nodes = np.empty(WORKSPACE_SIZE)
    p_matrix = np.empty(ROW_LENGTH * ROW_LENGTH)
    d_matrix = np.empty(ROW_LENGTH * ROW_LENGTH)
    for i in range(out.shape[1]):
        # As before the first motion, so that no bit depends on which motion came before: NaN for
        # outputs that are not reached; 0 for column 0 of the matrices and for the drive of an
        # undriven motion, which nobody writes.
        for row in range(N_OUTPUTS):
            fill(np.nan, quantities[row])
        for array in (nodes, p_matrix, d_matrix):
            fill(0.0, array)
        fill(1.0, nodes[ROW_ONES : ROW_ONES + ROW_LENGTH])
        select_material(motions.law, i)
        gamma = element(motions.gamma, i)
        for k in range(t.size):
            tau[k] = t[k] * gamma
        scene = Scene(
            law=motions.law,
            moments_differ=motions.moments_differ,
            kappa=element(motions.kappa, i),
            mu=element(motions.mu, i),
            gamma=gamma,
            j=element(motions.j, i),
        )
        drive = Drive(segments, drive_of_motion(drives, gamma, i, segments), drives.prescribed)
        work = Workspace(
            scene=scene,
            drive=drive,
            options=options,
            output_tau=tau,
            outputs=quantities,
            with_quadratures=with_quadratures,
            with_forces=with_forces,
            switches=switches,
            step_ends=step_ends,
            nodes=data_pointer(nodes),
            p_matrix=data_pointer(p_matrix),
            d_matrix=data_pointer(d_matrix),
        )
        result = integrate_motion(element(motions.V0, i), element(motions.omega0, i), work)
        for n in range(rows.size):
            copy(quantities[rows[n]], out[n, i])
        info[i, 0], info[i, 1], info[i, 2], info[i, 3], info[i, 4] = result
