"""The drive at a time: force, torque, brake and prescribed speed, polynomials on each segment.

A segment is a row of numbers (COL_* of :mod:`.records`): its start, the scale of its time and the
coefficients of five polynomials of x = (tau - start) scale - 1, which runs from -1 to 1 over the
segment.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Drive: force, torque, brake and prescribed speed, polynomials of tau on each segment; gains of the
  feedback.  An index of a segment counts from 0 and is not checked.
- Load: the drive at one time in the direction of the Regime: force, torque, slopes of a prescribed
  V or omega, largest torque of the brake, inverse_mass (1, or 0 where V is prescribed),
  inverse_inertia (1/j, or 0 where omega is prescribed or held by the brake) and the gains of the
  feedback.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

from typing import Any, NamedTuple

from ..numerics.intrinsics import copy
from ..numerics.jit import inline_kernel, kernel
from ..records import (
    COL_COEFFICIENTS,
    COL_SCALE,
    COL_START,
    DRIVE_BRAKE,
    DRIVE_FORCE,
    DRIVE_RATE,
    DRIVE_SPEED,
    DRIVE_TORQUE,
    N_DRIVE_FUNCTIONS,
    N_NODE_FUNCTIONS,
    NOT_PRESCRIBED,
    PRESCRIBED_OMEGA,
    PRESCRIBED_V,
    ROUNDING,
    Gains,
    Load,
)
from .collocation import ROW_DRIVE, ROW_LENGTH, N, last_output_tau, node_time

#: Relative jump of a function or of its slope at the end of a segment, up to which it counts as
#: smooth: the polynomials fitted to a callable leave smaller ones.
_SMOOTH_JUMP = 1e-4
#: A prescribed speed counts as 0 below this number of units of rounding of its coefficients: a
#: polynomial of up to 14 terms, moved to a part of its segment, is wrong by some of them.
_ZERO_SPEED_ROUNDINGS = 30.0


@inline_kernel
def n_coefficients(row):
    """Return the number of coefficients of each of the five functions of a segment, an int.

    It is not stored: it follows from the length of the row, two columns and five times that number.

    row: (columns,), the segment.
    """
    return (row.size - COL_COEFFICIENTS) // N_DRIVE_FUNCTIONS


@inline_kernel
def evaluate_polynomial(row, function, x):
    """Return one function of a segment at a position by Horner's scheme, a float, dimensionless, in
    fixed directions.

    The torque of the brake may come out below 0.

    row: (columns,), the segment; its coefficients, in ascending powers of x, are read.
    function: int, DRIVE_FORCE 0, DRIVE_TORQUE 1, DRIVE_RATE 2 (slope in tau of the prescribed
    speed), DRIVE_BRAKE 3 or DRIVE_SPEED 4 (prescribed speed).
    x: float, position in [-1, 1] on the segment; outside the polynomial is extrapolated.
    """
    n_terms = n_coefficients(row)
    first = COL_COEFFICIENTS + function * n_terms
    total = 0.0
    for n in range(n_terms - 1, -1, -1):
        total = row[first + n] + x * total
    return total


@inline_kernel
def _sum_of_moduli(row, first, last):
    """Return the sum of the moduli of the coefficients of some functions of a segment,
    dimensionless.

    It is an upper bound of the modulus of each of them on the segment, and 0 only if all are 0.

    row: (columns,), the segment; its coefficients are read.
    first, last: int, index DRIVE_* of the first function and of the one after the last, ``first`` <
    ``last``.
    """
    n_terms = n_coefficients(row)
    total = 0.0
    for n in range(COL_COEFFICIENTS + first * n_terms, COL_COEFFICIENTS + last * n_terms):
        total += abs(row[n])
    return total


@kernel
def evaluate_drive(tau, segment, drive):
    """Return the drive at one time, in fixed directions, not in those of the regime, without
    feedback; dimensionless.

    tau: float, the time.
    segment: int, index of the segment that contains tau; outside it its polynomials are
    extrapolated.
    drive: Drive, of which ``segments`` and ``prescribed`` are read.
    Returns (force, torque of the motor, slope in tau of the prescribed speed, largest torque of the
    brake), floats; the slope is 0 without a prescribed speed; the torque of the brake is at least
    0, as values below 0 count as 0.
    """
    row = drive.segments[segment]
    x = (tau - row[COL_START]) * row[COL_SCALE] - 1.0
    # without a prescribed speed its coefficients are not read
    rate = evaluate_polynomial(row, DRIVE_RATE, x) if drive.prescribed != NOT_PRESCRIBED else 0.0
    return (
        evaluate_polynomial(row, DRIVE_FORCE, x),
        evaluate_polynomial(row, DRIVE_TORQUE, x),
        rate,
        max(evaluate_polynomial(row, DRIVE_BRAKE, x), 0.0),
    )


@kernel
def prescribed_speed(tau, segment, drive):
    """Return the prescribed speed at one time, V or omega, as ``drive.prescribed`` tells.

    tau: float, the time.
    segment: int, index of the segment that contains tau; outside it the polynomial is extrapolated.
    drive: Drive, with a prescribed speed; without one the result is 0.
    Returns a float, dimensionless, in a fixed direction, not in that of the regime; exactly 0 where
    it is rounding: at most 30 units of rounding of the sum of its coefficients' moduli on the
    segment.
    """
    row = drive.segments[segment]
    speed = evaluate_polynomial(row, DRIVE_SPEED, (tau - row[COL_START]) * row[COL_SCALE] - 1.0)
    size = _sum_of_moduli(row, DRIVE_SPEED, N_DRIVE_FUNCTIONS)
    return speed if abs(speed) > _ZERO_SPEED_ROUNDINGS * ROUNDING * size else 0.0


@inline_kernel
def load_from_values(values, regime, work):
    """Return the Load for given values of the drive, in the direction of the regime.

    Force, torque and the slope of the prescribed speed are multiplied by the direction; the slope
    is that of V or of omega, and the other one is 0.  The torque of the brake has no direction: it
    gets the sign against omega where forces are applied.  Feedback is not in force and torque; its
    gains are a field.  ``inverse_mass`` is 0 where V is prescribed, else 1; ``inverse_inertia`` is
    0 where omega is prescribed or held by the brake, else 1/j.

    values: (force, torque, slope of the prescribed speed, torque of the brake), as
    :func:`evaluate_drive` returns them.
    regime: Regime, of which ``direction`` and ``locked`` are read.
    work: Workspace, of which ``drive.prescribed``, ``drive.gains`` and ``scene.j`` are read.
    """
    force, torque, rate, brake = values
    drive = work.drive
    direction = regime.direction
    omega_given = drive.prescribed == PRESCRIBED_OMEGA
    V_given = drive.prescribed == PRESCRIBED_V
    return Load(
        force=direction * force,
        torque=direction * torque,
        prescribed_V_rate=direction * rate if V_given else 0.0,
        prescribed_omega_rate=direction * rate if omega_given else 0.0,
        brake=brake,
        inverse_mass=0.0 if V_given else 1.0,
        inverse_inertia=0.0 if omega_given or regime.locked else 1.0 / work.scene.j,
        gains=drive.gains,
    )


@kernel
def evaluate_load(tau, segment, regime, work):
    """Return the Load at one time, in the direction of the regime; its fields are set as by
    :func:`load_from_values`.

    tau: float, the time.
    segment: int, index of the segment that contains tau.
    regime: Regime, at that time; ``direction`` and ``locked`` are read.
    work: Workspace, of which the Drive and j are read.
    """
    return load_from_values(evaluate_drive(tau, segment, work.drive), regime, work)


@kernel
def current_load(regime, step_state, work):
    """Return the Load at the time reached, in the direction of the regime; its fields are set as by
    :func:`load_from_values`.

    regime: Regime, the present one; ``direction`` and ``locked`` are read.
    step_state: StepState, with that time and its segment.
    work: Workspace, of which the Drive and j are read.
    """
    return evaluate_load(step_state.tau, step_state.segment, regime, work)


@kernel
def store_drive(step, work):
    """Store force, torque, slope of the prescribed speed and torque of the brake at all nodes of a
    step.

    They are in fixed directions, not in those of the regime, and without feedback.

    step: Step, within one segment; tau, h, segment and undriven are read.
    work: Workspace; the four rows from ROW_DRIVE on are written, nodes 0 ... N.  They are left as
    they are where nothing drives from the first segment on: they are 0 from the start of the motion
    then.  Returns nothing.
    """
    nodes = work.nodes
    if step.undriven and step.segment == 0:  # The rows are 0 from the start of the motion.
        return
    # of a constant drive one evaluation serves all nodes
    values = evaluate_drive(step.tau, step.segment, work.drive)
    changes = not is_constant(step.segment, work.drive)
    for i in range(N + 1):
        if changes:
            values = evaluate_drive(node_time(step, i), step.segment, work.drive)
        for n in range(N_NODE_FUNCTIONS):
            nodes[ROW_DRIVE + ROW_LENGTH * n + i] = values[n]


@inline_kernel
def load_at_node(i, regime, work):
    """Return the Load at a node of a step whose drive is stored, in the direction of the regime.

    Its fields are set as by :func:`load_from_values`.

    i: int, the node, 0 ... N.
    regime: Regime, that of the step; ``direction`` and ``locked`` are read.
    work: Workspace, with the drive at the nodes (:func:`store_drive`); its Drive and j are read
    too.
    """
    nodes = work.nodes
    # rows in the order DRIVE_FORCE, DRIVE_TORQUE, DRIVE_RATE, DRIVE_BRAKE, as store_drive writes
    # them
    values = (
        nodes[ROW_DRIVE + i],
        nodes[ROW_DRIVE + ROW_LENGTH + i],
        nodes[ROW_DRIVE + ROW_LENGTH * 2 + i],
        nodes[ROW_DRIVE + ROW_LENGTH * 3 + i],
    )
    return load_from_values(values, regime, work)


@kernel
def segment_end(segment, work):
    """Return tau at the end of a segment of the drive or of the motion, whichever comes first; a
    float.

    The last segment has no end of its own: it ends with the motion, at the last output time.

    segment: int, index of the segment.
    work: Workspace, of which the output times and the starts of the segments are read.
    """
    end = last_output_tau(work)
    return (
        min(work.drive.segments[segment + 1, COL_START], end)
        if segment + 1 < work.drive.segments.shape[0]
        else end
    )


@kernel
def drive_rounding(segment, drive):
    """Return a bound of the rounding errors of force, torque and slope of the prescribed speed on a
    segment, taken together.

    They are sums of terms that may nearly cancel: the error is a unit of rounding times the sum of
    the coefficients' moduli.

    segment: int, index of the segment.
    drive: Drive, of which ``segments`` is read.
    Returns a float, dimensionless; 0 where all of these functions are 0.
    """
    return ROUNDING * _sum_of_moduli(drive.segments[segment], DRIVE_FORCE, DRIVE_RATE + 1)


@kernel
def continues_smoothly(segment, drive):
    """Return whether the drive continues at the end of a segment without a jump or kink, a bool.

    Force, torque, slope of the prescribed speed and torque of the brake are compared; the
    prescribed speed itself is not.  A jump does not count up to _SMOOTH_JUMP times the sum of the
    moduli of the function's coefficients on both segments; a kink does not count up to that limit
    divided by half the length of the shorter segment.  If the drive is smooth the length of the
    last step is a good one for the next.

    segment: int, index of a segment that another one follows; the last one is not allowed.
    drive: Drive, of which ``segments`` is read.
    Returns True if every function passes both tests, a difference equal to its limit included, else
    False.
    """
    row = drive.segments[segment]
    next_row = drive.segments[segment + 1]
    terms = n_coefficients(row)
    for function in range(N_NODE_FUNCTIONS):
        size = jump = kink = 0.0
        # Values and slopes in tau at x = 1 of the segment less those at x = -1 of the next one,
        # where the power n of x is (-1)^n and its slope -n (-1)^n.
        for n in range(terms):
            column = COL_COEFFICIENTS + function * terms + n
            left = row[column]
            right = next_row[column]
            sign = 1.0 if n % 2 == 0 else -1.0
            jump += left - sign * right
            kink += n * (left * row[COL_SCALE] + sign * right * next_row[COL_SCALE])
            size += abs(left) + abs(right)
        if abs(jump) > _SMOOTH_JUMP * size or abs(kink) > _SMOOTH_JUMP * size * max(
            row[COL_SCALE], next_row[COL_SCALE]
        ):
            return False
    return True


@kernel
def is_constant(segment, drive):
    """Return whether force, torque, slope of the prescribed speed and torque of the brake are
    constant on a segment, a bool.

    All their coefficients but the constant ones are exactly 0 then.  The prescribed speed itself
    may be linear in time.  Functions that are 0 are constant.  Only on such a segment is an
    equilibrium of the motion sought, which is then continued in closed form.

    segment: int, index of the segment.
    drive: Drive, of which ``segments`` is read.
    """
    row = drive.segments[segment]
    variation = 0.0  # sum of the moduli of all coefficients of x and its powers
    terms = n_coefficients(row)
    # the functions that are stored at nodes come first; n % terms is the power of a coefficient
    for n in range(N_NODE_FUNCTIONS * terms):
        variation += abs(row[COL_COEFFICIENTS + n]) if n % terms > 0 else 0.0
    return variation == 0.0


@kernel
def has_brake(segment, drive):
    """Return whether a brake acts anywhere on a segment: whether a coefficient of its largest
    torque is not 0; a bool.

    segment: int, index of the segment.
    drive: Drive, of which ``segments`` is read.
    """
    return _sum_of_moduli(drive.segments[segment], DRIVE_BRAKE, DRIVE_BRAKE + 1) > 0.0


@kernel
def is_unloaded(segment, drive):
    """Return whether from a segment on there is no force, torque, brake or prescribed speed;
    feedback may act; a bool.

    segment: int, index of the segment; all later ones are considered too.
    drive: Drive, of which ``segments`` and ``prescribed`` are read.
    Returns False with a prescribed speed, even if it is 0.
    """
    for n in range(segment, drive.segments.shape[0]):
        if _sum_of_moduli(drive.segments[n], DRIVE_FORCE, N_DRIVE_FUNCTIONS) > 0.0:
            return False
    return drive.prescribed == NOT_PRESCRIBED


@kernel
def is_undriven(segment, drive):
    """Return whether from a segment on there is no force, torque, brake, prescribed speed or
    feedback, a bool.

    It is :func:`is_unloaded` with all gains of the feedback 0; "nothing drives" means this.

    segment: int, index of the segment; all later ones are considered too.
    drive: Drive, of which ``segments``, ``prescribed`` and ``gains`` are read.
    Returns False with a prescribed speed, even if it is 0.
    """
    gains = drive.gains
    size = (
        abs(gains.force_V) + abs(gains.force_omega) + abs(gains.torque_V) + abs(gains.torque_omega)
    )
    return size == 0.0 and is_unloaded(segment, drive)


@kernel
def rest_threshold(segment, work):
    """Return the speed below which the motion ends at rest, dimensionless; 0 while something drives
    or will.

    Feedback drives too (:func:`is_undriven`).  It is 0 also if no threshold is given.

    segment: int, index of the present segment of the drive.
    work: Workspace, of the motion; its Drive and the threshold in ``options`` are read.
    """
    return (
        work.options.rest_speed
        if work.options.rest_speed > 0.0 and is_undriven(segment, work.drive)
        else 0.0
    )


class Drives(NamedTuple):
    """Drives of many motions.

    segments : (m, k, columns) over t, m = 1 for all motions or one for each; columns as COL_* of
        :mod:`.records`, with times and slopes in t, not in tau
    gains : (4, 1) or (4, n), dimensionless, in the order of :class:`Gains`
    prescribed : NOT_PRESCRIBED, PRESCRIBED_OMEGA or PRESCRIBED_V, the same for all
    """

    segments: Any
    gains: Any
    prescribed: int


@kernel
def drive_of_motion(drives, gamma, i, segments):
    """Write the segments of one motion as functions of tau = gamma t.

    Start, scale of time and the slope of the prescribed speed are converted from t to tau; forces,
    torques and the prescribed speed are copied.

    drives: Drives, over t; one for all motions, or one for each.
    gamma: float, tau = gamma t, dimensionless, above 0.
    i: int, index of the motion.
    segments: (k, columns), written: k segments over tau, columns as COL_* of :mod:`.records`, k and
    columns as in ``drives.segments``.
    Returns the Gains of the motion, those of the last one given if there are fewer; they are not
    converted.
    """
    last = drives.segments.shape[0] - 1
    source = drives.segments[i if i < last else last]
    for k in range(segments.shape[0]):
        copy(source[k], segments[k])
        # x = (tau - start) scale - 1 stays the same number, and so do the coefficients of functions
        # of it; d(speed)/dtau = d(speed)/dt/gamma
        segments[k, COL_START] *= gamma
        segments[k, COL_SCALE] /= gamma
        n_terms = n_coefficients(segments[k])
        for n in range(DRIVE_RATE * n_terms, (DRIVE_RATE + 1) * n_terms):
            segments[k, COL_COEFFICIENTS + n] *= 1.0 / gamma
    gains = drives.gains
    last = gains.shape[1] - 1
    n = i if i < last else last
    return Gains(gains[0, n], gains[1, n], gains[2, n], gains[3, n])
