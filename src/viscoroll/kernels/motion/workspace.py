"""Records, codes and array layouts of the solver of motions.

Times are tau = gamma t, dimensionless.  `omega_or_d` is the second unknown: omega in full slip, d = delta/delta_star in
partial slip.  In the names of rows and matrices D stands for it.

The nodes of a step are stored by rows of ROW_LENGTH numbers in ``Workspace.nodes``: row ROW_X holds x at node i in
``nodes[ROW_X + i]``; node 0 is the left end of the step.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.jit import kernel
from .collocation import NODE_FRACTIONS, ROW_LENGTH, evaluate_dense_output

#: regime of an output: full slip
FULL_SLIP = 0
#: regime of an output: partial slip (stick and slip)
PARTIAL_SLIP = 1
#: regime of an output: V = omega = 0 without a brake
AT_REST = 2
#: regime of an output: a brake holds omega at 0 while V is not 0
OMEGA_LOCKED = 3
#: regime of an output: V = omega = 0, held by a brake or by a prescribed speed
HELD_AT_REST = 4
#: entry among the regime changes: V changed its sign
DIRECTION_REVERSED = -1

#: neither speed is prescribed
NOT_PRESCRIBED = 0
#: omega is prescribed
PRESCRIBED_OMEGA = 1
#: V is prescribed
PRESCRIBED_V = 2

#: status of a motion: integrated to its last output time
COMPLETED = 0
#: status of a motion: came below the rest threshold
CAME_TO_REST = 1
#: status of a motion: the allowed number of steps was used up
STEP_LIMIT = 2
#: status of a motion: every step, however short, was rejected
STEP_TOO_SMALL = 3
#: status of a motion: the departure from rest is not unique
NOT_UNIQUE = 4
#: status of a motion: the added mass left the range in which the equations hold
ADDED_MASS_EXHAUSTED = 5

#: unit of rounding of a double, dimensionless
ROUNDING = 2.2e-16
#: V below which it counts as 0 in partial slip, dimensionless: far below every speed that an output can tell from 0
ZERO_SPEED = 1e-200


class Scene(NamedTuple):
    """Parameters of Eq. (22) of one motion.

    law : rows of the law (:mod:`..rows.evaluate`)
    moments_differ : whether half-space and cylinder take unequal parts of M
    kappa, mu, j : slenderness, coefficient of friction, moment of inertia, dimensionless
    gamma : tau = gamma t; also the factor of the added mass N
    """

    law: Any
    moments_differ: bool
    kappa: float
    mu: float
    gamma: float
    j: float


class Gains(NamedTuple):
    """Feedback: derivatives of force and torque in V and omega, dimensionless."""

    force_V: float
    force_omega: float
    torque_V: float
    torque_omega: float


class Drive(NamedTuple):
    """External actions on one motion.

    segments : one row for each segment of the drive, columns as COL_* below
    gains : feedback
    prescribed : NOT_PRESCRIBED, PRESCRIBED_OMEGA or PRESCRIBED_V
    """

    segments: Any
    gains: Gains
    prescribed: int


class Load(NamedTuple):
    """The drive at one time, in the direction of the regime, dimensionless.

    V' = inverse_mass (Q - M_half_space + force) + prescribed_V_rate
    omega' = inverse_inertia (-Q - M_cylinder + torque) + prescribed_omega_rate
    brake : largest torque of the brake, at least 0
    """

    force: float
    torque: float
    prescribed_V_rate: float
    prescribed_omega_rate: float
    brake: float
    inverse_mass: float
    inverse_inertia: float
    gains: Gains


class Regime(NamedTuple):
    """Regime of a motion and the orientation in which its V is at least 0.

    full_slip : whether the whole contact slips
    direction : 1 or -1; speeds times this are those of the regime, with V >= 0
    sigma : sign of omega - V in full slip, sign of d of the branch of the law in partial slip
    spin_sign : sign of omega where a brake acts, 0 where none does
    locked : whether a brake holds omega at 0
    """

    full_slip: bool
    direction: float
    sigma: float
    spin_sign: float
    locked: bool


#: regime of a cylinder at rest, before its departure is known
REGIME_AT_REST = Regime(False, 1.0, 1.0, 0.0, False)


class State(NamedTuple):
    """Unknowns: V, and omega in full slip or d = delta/delta_star in partial slip; dimensionless."""

    V: float
    omega_or_d: float


class StepState(NamedTuple):
    """Progress of the integration.

    tau : time reached
    next_output : index of the next output time
    segment : index of the segment of the drive
    n_steps : trial steps so far
    n_ended : accepted steps so far
    h : length of the next trial step; 0: not known
    """

    tau: float
    next_output: int
    segment: int
    n_steps: int
    n_ended: int
    h: float


class Step(NamedTuple):
    """One collocation step.

    tau, h : left end and length
    segment : segment of the drive in which it lies
    initial_slope_known : whether the slope of the second unknown at the left end is finite and known (V > 0)
    undriven : whether nothing drives from there on: then V is measured relative to itself and may come to rest
    """

    tau: float
    h: float
    segment: int
    initial_slope_known: bool
    undriven: bool


class Options(NamedTuple):
    """Relative tolerance, rest threshold of the speeds (0: none), largest number of trial steps."""

    rtol: float
    rest_speed: float
    max_steps: int


class Workspace(NamedTuple):
    """The problem of one motion and the arrays that its solution uses.

    scene, drive, options : the problem
    output_tau : times of the outputs, increasing
    outputs : [quantity, time], filled
    with_quadratures, with_forces : whether distance, angle and energies, and whether force and torque are requested
    switches : (k, 2), filled with t and the regime behind each regime change
    step_ends : filled with the end t of each accepted step, as far as it has room
    nodes : pointer to WORKSPACE_SIZE numbers, rows ROW_* and single numbers below
    p_matrix, d_matrix : pointers to the inverse Newton matrices of p and of the second unknown, column by column
    """

    scene: Scene
    drive: Drive
    options: Options
    output_tau: Any
    outputs: Any
    with_quadratures: bool
    with_forces: bool
    switches: Any
    step_ends: Any
    nodes: Any
    p_matrix: Any
    d_matrix: Any


class Batch(NamedTuple):
    """Parameters and starts of many motions: arrays of one value for all, or of one for each motion.

    law : of one material for all, or of each motion in turn (:mod:`..rows.record`)
    moments_differ : as in ``Scene``
    """

    law: Any
    moments_differ: bool
    kappa: Any
    mu: Any
    gamma: Any
    j: Any
    V0: Any
    omega0: Any


#: column of a segment: tau of its left end
COL_START = 0
#: column of a segment: scale of its time, x = (tau - start) scale - 1 runs from -1 to 1
COL_SCALE = 1
#: first column of the coefficients in x: as many for each function below as there are terms
COL_COEFFICIENTS = 2
#: function of a segment: force
DRIVE_FORCE = 0
#: function of a segment: torque of the motor
DRIVE_TORQUE = 1
#: function of a segment: slope in tau of the prescribed speed
DRIVE_RATE = 2
#: function of a segment: largest torque of the brake
DRIVE_BRAKE = 3
#: function of a segment: prescribed speed
DRIVE_SPEED = 4
#: number of functions of a segment
N_DRIVE_FUNCTIONS = 5
#: functions that are stored at the nodes of a step: all but the prescribed speed
N_NODE_FUNCTIONS = 4
#: quadrature: loss in rolling
ROLLING_LOSS = 3
#: number of quadratures that a free motion has: distance, angle, losses in slip and in rolling
N_FREE_QUADRATURES = 4
#: number of quadratures: those, then work of force and of torque and the loss in the brake, 0 unless something drives
N_QUADRATURES = 7

#: row: V
ROW_V = ROW_LENGTH * 0
#: row: second unknown, omega or d
ROW_OMEGA_OR_D = ROW_LENGTH * 1
#: row: p'
ROW_P_RATE = ROW_LENGTH * 2
#: row: weight times the slope of the second unknown
ROW_WEIGHTED_RATE = ROW_LENGTH * 3
#: row: V', at node 0 only
ROW_V_RATE = ROW_LENGTH * 4
#: row: max(|V|, |omega|)
ROW_SPEED = ROW_LENGTH * 5
#: row: p, the collocated combination of V and omega (:mod:`rhs`)
ROW_P = ROW_LENGTH * 6
#: row: dV/dp, inverse of dp/dV
ROW_DV_DP = ROW_LENGTH * 7
#: row: dp/dd, 0 in full slip
ROW_DP_DD = ROW_LENGTH * 8
#: row: derivative in p of the residual of the second unknown, negative
ROW_COUPLING = ROW_LENGTH * 9
#: row: rate at which the second unknown relaxes, its derivative of its own slope
ROW_RELAXATION = ROW_LENGTH * 10
#: row: slopes of the interpolant of p
ROW_P_SLOPE = ROW_LENGTH * 11
#: row: slopes of the interpolant of the second unknown
ROW_D_SLOPE = ROW_LENGTH * 12
#: row: residual of p
ROW_P_RESIDUAL = ROW_LENGTH * 13
#: row: residual of the second unknown
ROW_D_RESIDUAL = ROW_LENGTH * 14
#: row: Newton update of p
ROW_P_UPDATE = ROW_LENGTH * 15
#: row: Newton update of the second unknown
ROW_D_UPDATE = ROW_LENGTH * 16
#: row: ones, the weights of the equation of p
ROW_ONES = ROW_LENGTH * 17
#: row: weights of the equation of the second unknown
ROW_WEIGHT = ROW_LENGTH * 18
#: row: diagonal that the Newton matrix of p subtracts
ROW_P_DIAGONAL = ROW_LENGTH * 19
#: row: diagonal that the Newton matrix of the second unknown subtracts
ROW_D_DIAGONAL = ROW_LENGTH * 20
#: row: derivative of p' in the second unknown, times h/2
ROW_FEEDBACK = ROW_LENGTH * 21
#: rows: integrands of the quadratures
ROW_INTEGRANDS = ROW_LENGTH * 22
#: event, and row of its function: in full slip the stick zone forms, in partial slip it vanishes
STICK_EDGE = ROW_INTEGRANDS + ROW_LENGTH * N_QUADRATURES
#: event and row: delta, less that of free rolling, passes 0 in partial slip
DELTA_ZERO = STICK_EDGE + ROW_LENGTH
#: event and row: V passes 0
V_ZERO = DELTA_ZERO + ROW_LENGTH
#: event and row: omega passes 0 under a brake
OMEGA_ZERO = V_ZERO + ROW_LENGTH
#: event and row: both speeds fall below the rest threshold
BELOW_REST_SPEED = OMEGA_ZERO + ROW_LENGTH
#: event and row: a brake that holds omega at 0 lets go
BRAKE_RELEASE = BELOW_REST_SPEED + ROW_LENGTH
#: no event: the segment of the drive or the allowed number of steps ended
NO_EVENT = 0
#: no event: every step, however short, was rejected
STEP_FAILED = -1
#: rows: functions of the drive
ROW_DRIVE = BRAKE_RELEASE + ROW_LENGTH
#: row: dense output of V
ROW_DENSE_V = ROW_DRIVE + ROW_LENGTH * N_NODE_FUNCTIONS
#: row: dense output of the second unknown
ROW_DENSE_OMEGA_OR_D = ROW_DENSE_V + ROW_LENGTH
#: rows: dense output of the quadratures
ROW_DENSE_QUADRATURES = ROW_DENSE_V + ROW_LENGTH * 2
#: row: interpolant of one event function
ROW_DENSE_EVENT = ROW_DENSE_QUADRATURES + ROW_LENGTH * N_QUADRATURES
#: N_QUADRATURES numbers: quadratures up to the last accepted step
QUADRATURE_TOTALS = ROW_DENSE_EVENT + ROW_LENGTH
#: number: regime changes so far
N_SWITCHES = QUADRATURE_TOTALS + N_QUADRATURES
#: number: entries of ``switches`` so far, reversals of direction among them
N_RECORDED = N_SWITCHES + 1
#: number: t of the onset of stick, NaN before it
ONSET_TIME = N_SWITCHES + 2
#: number: t at which the motion came to rest, NaN if it did not
REST_TIME = N_SWITCHES + 3
#: numbers of ``Workspace.nodes``
WORKSPACE_SIZE = N_SWITCHES + 4


@kernel(inline=True)
def change_slip(regime, full_slip, sigma):
    """Return the Regime with full or partial slip and another ``sigma``; direction and brake stay."""
    return Regime(full_slip, regime.direction, sigma, regime.spin_sign, regime.locked)


@kernel(inline=True)
def last_output_tau(work):
    """Return tau of the last output, at which the motion ends; work: Workspace."""
    return work.output_tau[work.output_tau.size - 1]


@kernel(inline=True)
def shorten_step(step, h):
    """Return the step with another length ``length`` in tau."""
    return Step(step.tau, h, step.segment, step.initial_slope_known, step.undriven)


@kernel(inline=True)
def node_time(step, i):
    """Return tau at node i of the step."""
    return step.tau + step.h * NODE_FRACTIONS[i]


@kernel(inline=True)
def dense_position(tau, step):
    """Return the position v in [0, 2] of the time tau on the step: v = 0 is its left end, v = 2 its right end."""
    return 2.0 * (max(tau - step.tau, 0.0) / step.h)


@kernel(inline=True)
def count_step(h, step_state):
    """Return the step state after one more trial step, with ``h`` as the length of the next one; 0: not known."""
    tau, next_output, segment, n_steps, n_ended, _ = step_state
    return StepState(tau, next_output, segment, n_steps + 1, n_ended, h)


@kernel(inline=True)
def with_step_length(h, step_state):
    """Return the step state with ``h`` as the length of the next trial step; 0: not known."""
    tau, next_output, segment, n_steps, n_ended, _ = step_state
    return StepState(tau, next_output, segment, n_steps, n_ended, h)


@kernel(inline=True)
def dense_state(v, nodes):
    """Return the State at position v in [0, 2] of the step whose dense output is stored in ``nodes``."""
    return State(
        nodes[ROW_V] + evaluate_dense_output(v, nodes, ROW_DENSE_V),
        nodes[ROW_OMEGA_OR_D] + evaluate_dense_output(v, nodes, ROW_DENSE_OMEGA_OR_D),
    )
