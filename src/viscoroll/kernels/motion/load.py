"""The drive at a time.  A piece of it is a row of numbers: when it begins, the scale of its time, and the coefficients
of five polynomials of x = (tau - start) scale - 1, which runs from -1 to 1 over the piece; tau = gamma t."""

from __future__ import annotations

from ..compile.jit import kernel
from .records import NEITHER, OMEGA, SPEED, Load

#: columns: start, scale, and from here on as many coefficients for each function as there are terms
START, SCALE, FIRST = 0, 1, 2
#: the functions: force and torque; the slope over tau of the speed that is prescribed; most that the brake can take;
#: the prescribed speed itself
FORCE, TORQUE, RATE, BRAKE, PRESCRIBED, FUNCTIONS = range(6)
#: functions whose values a panel keeps at its nodes: all but the prescribed speed, which is read at single times
AT_NODES = PRESCRIBED
#: unit of rounding
_ROUNDING = 2.2e-16
#: a jump or a corner up to this share is what the fit of a callable leaves
_SMOOTH = 1e-4
#: units of rounding of a piece's coefficients up to which a prescribed speed counts as 0: a polynomial of up to 14
#: terms, moved to a part of its piece, is off by some of them
_ROUNDINGS = 30.0


@kernel(inline=True)
def terms_of(row):
    """Number of coefficients of each function."""
    return (row.size - FIRST) // FUNCTIONS


@kernel(inline=True)
def value(row, function, x):
    """One of the functions of a piece."""
    terms = terms_of(row)
    first, total = FIRST + function * terms, 0.0
    for n in range(terms - 1, -1, -1):
        total = row[first + n] + x * total
    return total


@kernel
def values_at(tau, piece, drive):
    """Force, torque, slope of a prescribed speed, most that the brake takes."""
    row = drive.pieces[piece]
    x = (tau - row[START]) * row[SCALE] - 1.0
    rate = value(row, RATE, x) if drive.prescribed != NEITHER else 0.0
    return value(row, FORCE, x), value(row, TORQUE, x), rate, max(value(row, BRAKE, x), 0.0)


@kernel
def prescribed_speed(tau, piece, drive):
    """The speed that is prescribed, at one time.

    Parameters
    ----------
    tau : float
        The time, within the piece.
    piece : int
        Number of the piece of the drive.
    drive : Drive
        With a prescribed speed.

    Returns
    -------
    float
        V or omega, dimensionless, not turned into the frame of the motion; 0 where it is rounding beside the
        coefficients of its own piece, whatever the speeds were before.
    """
    row = drive.pieces[piece]
    terms = terms_of(row)
    speed, size = value(row, PRESCRIBED, (tau - row[START]) * row[SCALE] - 1.0), 0.0
    for n in range(terms):
        size += abs(row[FIRST + PRESCRIBED * terms + n])
    return speed if abs(speed) > _ROUNDINGS * _ROUNDING * size else 0.0


@kernel(inline=True)
def load_of(values, frame, case):
    """The drive with these values, in the frame of the motion, without feedback."""
    force, torque, rate, brake = values
    drive, direction = case.drive, frame.direction
    by_omega, by_V = drive.prescribed == OMEGA, drive.prescribed == SPEED
    return Load(
        direction * force,
        direction * torque,
        direction * rate if by_V else 0.0,
        direction * rate if by_omega else 0.0,
        brake,
        0.0 if by_V else 1.0,
        0.0 if by_omega or frame.locked else 1.0 / case.scene.j,
        drive.gains,
    )


@kernel
def load_at(tau, piece, frame, case):
    """The drive at tau in the frame of the motion, without feedback."""
    return load_of(values_at(tau, piece, case.drive), frame, case)


@kernel
def piece_end(piece, case):
    """When a piece of the drive, or the motion, ends."""
    end = case.tau[case.tau.size - 1]
    return min(case.drive.pieces[piece + 1, START], end) if piece + 1 < case.drive.pieces.shape[0] else end


@kernel
def rounding(piece, pieces):
    """What rounding leaves of force, torque and slope of a prescribed speed: sums of terms that may nearly cancel."""
    row, size = pieces[piece], 0.0
    for n in range(FIRST, FIRST + (RATE + 1) * terms_of(row)):
        size += abs(row[n])
    return _ROUNDING * size


@kernel
def goes_on(piece, pieces):
    """Whether the drive neither jumps nor turns a corner at the end of a piece, to the accuracy of a step's length."""
    row, then = pieces[piece], pieces[piece + 1]
    terms = terms_of(row)
    for function in range(AT_NODES):
        size = jump = turn = 0.0
        for n in range(terms):
            before, behind = row[FIRST + function * terms + n], then[FIRST + function * terms + n]
            sign = 1.0 if n % 2 == 0 else -1.0
            jump += before - sign * behind
            turn += n * (before * row[SCALE] + sign * behind * then[SCALE])
            size += abs(before) + abs(behind)
        if abs(jump) > _SMOOTH * size or abs(turn) > _SMOOTH * size * max(row[SCALE], then[SCALE]):
            return False
    return True


@kernel
def constant(piece, pieces):
    """Whether the drive stays as it is within a piece."""
    row, change = pieces[piece], 0.0
    terms = terms_of(row)
    for function in range(AT_NODES):
        for n in range(1, terms):
            change += abs(row[FIRST + function * terms + n])
    return change == 0.0


@kernel
def brakes(piece, pieces):
    """Whether there is a brake within a piece, if only later on."""
    row, size = pieces[piece], 0.0
    for n in range(FIRST + BRAKE * terms_of(row), FIRST + (BRAKE + 1) * terms_of(row)):
        size += abs(row[n])
    return size > 0.0


@kernel
def unloaded(piece, drive):
    """Whether at most gains drive from this piece on."""
    for row in drive.pieces[piece:]:
        for n in range(FIRST, row.size):
            if row[n] != 0.0:
                return False
    return drive.prescribed == NEITHER


@kernel
def undriven(piece, drive):
    """Whether nothing drives from this piece on."""
    gains = drive.gains
    acting = abs(gains.force_V) + abs(gains.force_omega) + abs(gains.torque_V) + abs(gains.torque_omega)
    return acting == 0.0 and unloaded(piece, drive)


@kernel
def threshold(piece, case):
    """Speed below which the motion ends at rest, from this piece of the drive on; 0 while something drives or will."""
    return case.limits.rest if case.limits.rest > 0.0 and undriven(piece, case.drive) else 0.0


@kernel(inline=True)
def acting(V, omega, load, frame):
    """(Force, torque of the motor, torque with the brake's) where both are given, in the frame of the motion."""
    gains = load.gains
    force = load.force + gains.force_V * V + gains.force_omega * omega
    torque = load.torque + gains.torque_V * V + gains.torque_omega * omega
    return force, torque, torque - load.brake * frame.spin


@kernel(inline=True)
def needed(speeds, moments, load, frame, j):
    """(Force, torque of the motor, torque of the brake): what is given, or what a prescribed speed asks for.

    ``speeds`` : V and omega; ``moments`` : Q and the parts of M.
    """
    Q, M_half_space, M_cylinder = moments
    force, torque, _ = acting(speeds[0], speeds[1], load, frame)
    brake = -load.brake * frame.spin
    if frame.locked:
        brake = Q + M_cylinder - torque
    elif load.per_omega == 0.0:
        torque = j * load.omega_rate + Q + M_cylinder - brake
    if load.per_V == 0.0:
        force = load.V_rate - Q + M_half_space
    return force, torque, brake
