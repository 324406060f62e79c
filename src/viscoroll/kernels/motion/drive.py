"""The drive at a time: force, torque, brake and prescribed speed, polynomials on each segment.

A segment is a row of numbers (COL_* of :mod:`workspace`): its start, the scale of its time and the coefficients of five
polynomials of x = (tau - start) scale - 1, which runs from -1 to 1 over the segment.
"""

from __future__ import annotations

from ..compile.jit import kernel
from .collocation import ROW_LENGTH, N
from .workspace import (
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
    ROW_DRIVE,
    Load,
    last_output_tau,
    node_time,
)

#: relative jump of a function or of its slope at the end of a segment, up to which it counts as smooth: fits of
#: callables leave smaller ones
_SMOOTH_JUMP = 1e-4
#: units of rounding of a segment's coefficients up to which a prescribed speed counts as 0: a polynomial of up to 14
#: terms, moved to a part of its segment, is wrong by some of them
_ZERO_SPEED_ROUNDINGS = 30.0


@kernel(inline=True)
def n_coefficients(row):
    """Return the number of coefficients of each function of a segment; row: the segment."""
    return (row.size - COL_COEFFICIENTS) // N_DRIVE_FUNCTIONS


@kernel(inline=True)
def evaluate_polynomial(row, function, x):
    """Return one function of a segment at x.

    row: the segment; function: DRIVE_*; x: position in [-1, 1].
    """
    n_terms = n_coefficients(row)
    first, total = COL_COEFFICIENTS + function * n_terms, 0.0
    for n in range(n_terms - 1, -1, -1):
        total = row[first + n] + x * total
    return total


@kernel(inline=True)
def _sum_of_moduli(row, first, last):
    """Return the sum of the moduli of the coefficients of functions ``first`` up to before ``last`` of a segment."""
    n_terms, total = n_coefficients(row), 0.0
    for n in range(COL_COEFFICIENTS + first * n_terms, COL_COEFFICIENTS + last * n_terms):
        total += abs(row[n])
    return total


@kernel
def evaluate_drive(tau, segment, drive):
    """Return (force, torque, slope of the prescribed speed in tau, largest torque of the brake) at tau, not oriented.

    segment: index of the segment that holds tau; drive: Drive.  The slope is 0 without a prescribed speed.
    """
    row = drive.segments[segment]
    x = (tau - row[COL_START]) * row[COL_SCALE] - 1.0
    rate = evaluate_polynomial(row, DRIVE_RATE, x) if drive.prescribed != NOT_PRESCRIBED else 0.0
    return (
        evaluate_polynomial(row, DRIVE_FORCE, x),
        evaluate_polynomial(row, DRIVE_TORQUE, x),
        rate,
        max(evaluate_polynomial(row, DRIVE_BRAKE, x), 0.0),
    )


@kernel
def prescribed_speed(tau, segment, drive):
    """Return the prescribed speed at one time.

    Parameters
    ----------
    tau : float
        The time, within the segment.
    segment : int
        Index of the segment of the drive.
    drive : Drive
        With a prescribed speed.

    Returns
    -------
    float
        V or omega, dimensionless, not oriented by the regime; 0 where it is rounding relative to the coefficients of
        its own segment.
    """
    row = drive.segments[segment]
    speed = evaluate_polynomial(row, DRIVE_SPEED, (tau - row[COL_START]) * row[COL_SCALE] - 1.0)
    size = _sum_of_moduli(row, DRIVE_SPEED, N_DRIVE_FUNCTIONS)
    return speed if abs(speed) > _ZERO_SPEED_ROUNDINGS * ROUNDING * size else 0.0


@kernel(inline=True)
def load_from_values(values, regime, work):
    """Return the Load with these values of the drive, oriented by the regime, without feedback.

    values: as :func:`evaluate_drive` returns them; regime: Regime; work: Workspace.
    """
    force, torque, rate, brake = values
    drive, direction = work.drive, regime.direction
    omega_given, V_given = drive.prescribed == PRESCRIBED_OMEGA, drive.prescribed == PRESCRIBED_V
    return Load(
        direction * force,
        direction * torque,
        direction * rate if V_given else 0.0,
        direction * rate if omega_given else 0.0,
        brake,
        0.0 if V_given else 1.0,
        0.0 if omega_given or regime.locked else 1.0 / work.scene.j,
        drive.gains,
    )


@kernel
def evaluate_load(tau, segment, regime, work):
    """Return the Load at tau, oriented by the regime, without feedback; segment: index of the segment that holds
    tau.
    """
    return load_from_values(evaluate_drive(tau, segment, work.drive), regime, work)


@kernel
def current_load(regime, step_state, work):
    """Return the Load at the time of the step state, oriented by the regime, without feedback."""
    return evaluate_load(step_state.tau, step_state.segment, regime, work)


@kernel
def store_drive(step, work):
    """Store the functions of the drive at all nodes of a step; work: Workspace."""
    nodes = work.nodes
    if step.undriven and step.segment == 0:  # the rows are 0 from the start of the motion
        return
    values = evaluate_drive(step.tau, step.segment, work.drive)
    changes = not is_constant(step.segment, work.drive)
    for i in range(N + 1):
        if changes:
            values = evaluate_drive(node_time(step, i), step.segment, work.drive)
        for n in range(N_NODE_FUNCTIONS):
            nodes[ROW_DRIVE + ROW_LENGTH * n + i] = values[n]


@kernel(inline=True)
def load_at_node(i, regime, work):
    """Return the Load at node i of the step whose drive is stored, oriented by the regime.

    regime: Regime; work: Workspace.
    """
    nodes = work.nodes
    values = (
        nodes[ROW_DRIVE + i],
        nodes[ROW_DRIVE + ROW_LENGTH + i],
        nodes[ROW_DRIVE + ROW_LENGTH * 2 + i],
        nodes[ROW_DRIVE + ROW_LENGTH * 3 + i],
    )
    return load_from_values(values, regime, work)


@kernel
def segment_end(segment, work):
    """Return tau at the end of a segment of the drive or of the motion, whichever comes first."""
    end = last_output_tau(work)
    return min(work.drive.segments[segment + 1, COL_START], end) if segment + 1 < work.drive.segments.shape[0] else end


@kernel
def drive_rounding(segment, drive):
    """Return the rounding error of force, torque and slope of the prescribed speed on a segment, dimensionless.

    They are sums of terms that may nearly cancel: the error is relative to the sum of the coefficients' moduli.
    """
    return ROUNDING * _sum_of_moduli(drive.segments[segment], DRIVE_FORCE, DRIVE_RATE + 1)


@kernel
def continues_smoothly(segment, drive):
    """Return whether no function of the drive jumps or has a kink at the end of a segment.

    A jump or kink below _SMOOTH_JUMP does not count: the length of the last step is then a good one for the next.
    """
    row, next_row = drive.segments[segment], drive.segments[segment + 1]
    terms = n_coefficients(row)
    for function in range(N_NODE_FUNCTIONS):
        size = jump = kink = 0.0
        for n in range(terms):
            column = COL_COEFFICIENTS + function * terms + n
            left, right = row[column], next_row[column]
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
    """Return whether all functions of the drive are constant on a segment."""
    row, variation = drive.segments[segment], 0.0
    terms = n_coefficients(row)
    for function in range(N_NODE_FUNCTIONS):
        for n in range(1, terms):
            variation += abs(row[COL_COEFFICIENTS + function * terms + n])
    return variation == 0.0


@kernel
def has_brake(segment, drive):
    """Return whether a brake acts anywhere on a segment."""
    return _sum_of_moduli(drive.segments[segment], DRIVE_BRAKE, DRIVE_BRAKE + 1) > 0.0


@kernel
def is_unloaded(segment, drive):
    """Return whether from this segment on there is no force, torque, brake or prescribed speed; feedback may act."""
    for row in drive.segments[segment:]:
        if _sum_of_moduli(row, DRIVE_FORCE, N_DRIVE_FUNCTIONS) > 0.0:
            return False
    return drive.prescribed == NOT_PRESCRIBED


@kernel
def is_undriven(segment, drive):
    """Return whether from this segment on nothing drives, feedback included."""
    gains = drive.gains
    size = abs(gains.force_V) + abs(gains.force_omega) + abs(gains.torque_V) + abs(gains.torque_omega)
    return size == 0.0 and is_unloaded(segment, drive)


@kernel
def rest_threshold(segment, work):
    """Return the speed below which the motion ends at rest from this segment on; 0 while something drives or will."""
    return work.options.rest_speed if work.options.rest_speed > 0.0 and is_undriven(segment, work.drive) else 0.0


@kernel(inline=True)
def applied_forces(V, omega, load, regime):
    """Return (force, torque of the motor, torque of motor and brake) where both are given, oriented by the regime.

    V, omega: speeds; load: Load; regime: Regime.  Feedback is included.
    """
    gains = load.gains
    force = load.force + gains.force_V * V + gains.force_omega * omega
    torque = load.torque + gains.torque_V * V + gains.torque_omega * omega
    return force, torque, torque - load.brake * regime.spin_sign


@kernel(inline=True)
def required_forces(V, omega, rates, load, regime, j):
    """Return (force, torque of the motor, torque of the brake): the given ones, or those that hold a prescribed speed.

    V, omega: speeds; rates: Rates there; load: Load; regime: Regime; j: moment of inertia.
    """
    force, torque, _ = applied_forces(V, omega, load, regime)
    brake = -load.brake * regime.spin_sign
    if regime.locked:
        brake = rates.Q + rates.M_cylinder - torque
    elif load.inverse_inertia == 0.0:
        torque = j * load.prescribed_omega_rate + rates.Q + rates.M_cylinder - brake
    if load.inverse_mass == 0.0:
        force = load.prescribed_V_rate - rates.Q + rates.M_half_space
    return force, torque, brake
