"""Layout of the workspace of one motion: rows of numbers at the nodes of a step, and functions of records.

The nodes of a step are stored by rows of ROW_LENGTH numbers in ``Workspace.nodes``: row ROW_X holds x at node i in
``nodes[ROW_X + i]``; node 0 is the left end of the step.  In the names of rows and matrices D stands for the second
unknown, omega or d (:mod:`records`).

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d = delta/delta_star in
  partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega under a brake;
  whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of steps, length of
  the next step.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in full slip
  (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

from ..compile.jit import inline_kernel
from .collocation import NODE_FRACTIONS, ROW_LENGTH, evaluate_dense_output
from .records import N_NODE_FUNCTIONS, N_QUADRATURES, Regime, State, Step, StepState

#: Row of V, dimensionless as all rows.
ROW_V = ROW_LENGTH * 0
#: Row of the second unknown, omega or d.
ROW_OMEGA_OR_D = ROW_LENGTH * 1
#: Row of p'.
ROW_P_RATE = ROW_LENGTH * 2
#: Row of the weight (V in partial slip, 1 in full slip) times the slope in tau of the second unknown.
ROW_WEIGHTED_RATE = ROW_LENGTH * 3
#: Row of V', at node 0 only.
ROW_V_RATE = ROW_LENGTH * 4
#: Row of max(|V|, |omega|).
ROW_SPEED = ROW_LENGTH * 5
#: Row of p, the collocated combination of V and omega (:mod:`rhs`).
ROW_P = ROW_LENGTH * 6
#: Row of dV/dp, inverse of dp/dV.
ROW_DV_DP = ROW_LENGTH * 7
#: Row of dp/dd, 0 in full slip.
ROW_DP_DD = ROW_LENGTH * 8
#: Row of the derivative in p of the residual of the second unknown, with the opposite sign.
ROW_COUPLING = ROW_LENGTH * 9
#: Row of the derivative of the slope of the second unknown in itself, per unit of tau: below 0 it relaxes.
ROW_RELAXATION = ROW_LENGTH * 10
#: Row of the slopes of the interpolant of p in t on [-1, 1].
ROW_P_SLOPE = ROW_LENGTH * 11
#: Row of the slopes of the interpolant of the second unknown in t on [-1, 1].
ROW_D_SLOPE = ROW_LENGTH * 12
#: Row of the residual of the equation of p.
ROW_P_RESIDUAL = ROW_LENGTH * 13
#: Row of the residual of the equation of the second unknown.
ROW_D_RESIDUAL = ROW_LENGTH * 14
#: Row of the Newton update of p.
ROW_P_UPDATE = ROW_LENGTH * 15
#: Row of the Newton update of the second unknown.
ROW_D_UPDATE = ROW_LENGTH * 16
#: Row of ones, the weights of the equation of p.
ROW_ONES = ROW_LENGTH * 17
#: Row of the weights of the equation of the second unknown.
ROW_WEIGHT = ROW_LENGTH * 18
#: Row of the diagonal that the Newton matrix of p subtracts; dp'/dp at node 0 before a step, half the length times
#: dp'/dp at the other nodes.
ROW_P_DIAGONAL = ROW_LENGTH * 19
#: Row of the diagonal that the Newton matrix of the second unknown subtracts.
ROW_D_DIAGONAL = ROW_LENGTH * 20
#: Row of the derivative of p' in the second unknown, times half the length of the step.
ROW_FEEDBACK = ROW_LENGTH * 21
#: First of N_QUADRATURES rows of the integrands of the quadratures.
ROW_INTEGRANDS = ROW_LENGTH * 22
#: Event, and row of its function: in full slip the stick zone forms, in partial slip it vanishes.
STICK_EDGE = ROW_INTEGRANDS + ROW_LENGTH * N_QUADRATURES
#: Event, and row of its function: delta, less that of free rolling, passes 0 in partial slip.
DELTA_ZERO = STICK_EDGE + ROW_LENGTH
#: Event, and row of its function: V passes 0.
V_ZERO = DELTA_ZERO + ROW_LENGTH
#: Event, and row of its function: omega passes 0 under a brake.
OMEGA_ZERO = V_ZERO + ROW_LENGTH
#: Event, and row of its function: both speeds fall below the rest threshold.
BELOW_REST_SPEED = OMEGA_ZERO + ROW_LENGTH
#: Event, and row of its function: a brake that holds omega at 0 lets go.
BRAKE_RELEASE = BELOW_REST_SPEED + ROW_LENGTH
#: Code beside the events: the segment of the drive or the allowed number of steps ended.
NO_EVENT = 0
#: Code beside the events: all trials of one step, ever shorter, were rejected.
STEP_FAILED = -1
#: First of N_NODE_FUNCTIONS rows of the functions of the drive.
ROW_DRIVE = BRAKE_RELEASE + ROW_LENGTH
#: Row of the dense output of V: coefficients, as of all rows of dense output.
ROW_DENSE_V = ROW_DRIVE + ROW_LENGTH * N_NODE_FUNCTIONS
#: Row of the dense output of the second unknown.
ROW_DENSE_OMEGA_OR_D = ROW_DENSE_V + ROW_LENGTH
#: First of N_QUADRATURES rows of the dense output of the quadratures.
ROW_DENSE_QUADRATURES = ROW_DENSE_V + ROW_LENGTH * 2
#: Row of the interpolant of one event function.
ROW_DENSE_EVENT = ROW_DENSE_QUADRATURES + ROW_LENGTH * N_QUADRATURES
#: N_QUADRATURES numbers: quadratures up to the last accepted step.
QUADRATURE_TOTALS = ROW_DENSE_EVENT + ROW_LENGTH
#: A number: regime changes so far.
N_SWITCHES = QUADRATURE_TOTALS + N_QUADRATURES
#: A number: entries of ``switches`` so far, reversals of direction among them.
N_RECORDED = N_SWITCHES + 1
#: A number: t of the onset of stick, NaN before it.
ONSET_TIME = N_SWITCHES + 2
#: A number: t at which the motion came to rest, NaN if it did not.
REST_TIME = N_SWITCHES + 3
#: Number of doubles in ``Workspace.nodes``.
WORKSPACE_SIZE = N_SWITCHES + 4


@inline_kernel
def change_slip(regime, full_slip, sigma):
    """Return the Regime with full or partial slip and another sigma; direction, spin_sign and locked stay.

    regime: Regime, the present one.
    full_slip: bool, whether the whole contact slips.
    sigma: float, 1 or -1, sign of the excess slip (:func:`.law.excess_slip`) in full slip, of d in partial slip.
    """
    return Regime(full_slip, regime.direction, sigma, regime.spin_sign, regime.locked)


@inline_kernel
def last_output_tau(work):
    """Return tau of the last output, at which the motion ends, a float.

    work: Workspace, of the motion, with at least one output time.
    """
    return work.output_tau[work.output_tau.size - 1]


@inline_kernel
def shorten_step(step, h):
    """Return the Step with the same left end and the length ``h``, a float in tau.

    step: Step, the one to shorten, whose other fields stay.
    """
    return Step(step.tau, h, step.segment, step.initial_slope_known, step.undriven)


@inline_kernel
def node_time(step, i):
    """Return tau at a node of a step, a float.

    step: Step, of which tau at its left end, node 0, and ``h`` are read.
    i: int, the node, 0 ... N.
    """
    return step.tau + step.h * NODE_FRACTIONS[i]


@inline_kernel
def dense_position(tau, step):
    """Return the position v of a time on a step: 0 at its left end, 2 at its right end, more beyond it; a float.

    tau: float, the time; times before the left end, as rounding may leave them, count as the left end.
    step: Step, with a length above 0; ``tau`` and ``h`` are read.
    """
    return 2.0 * (max(tau - step.tau, 0.0) / step.h)


@inline_kernel
def set_step_length(h, n_trials, step_state):
    """Return the StepState with ``h`` as the length of the next trial step and ``n_trials`` added to ``n_steps``.

    h: float, that length in tau, dimensionless, at least 0; 0 if it is not chosen yet.
    n_trials: int, number added to ``n_steps``, the number of trial steps so far: 1 after a trial step, 0 where only the
    length changes.
    step_state: StepState, the present one; its other fields stay, the number of accepted steps among them.
    """
    tau, next_output, segment, n_steps, n_accepted, _ = step_state
    return StepState(tau, next_output, segment, n_steps + n_trials, n_accepted, h)


@inline_kernel
def dense_state(v, nodes):
    """Return the State at a position of a step by its dense output.

    v: float, position: 0 at the left end, 2 at the right end; outside the polynomials are extrapolated.
    nodes: Workspace.nodes, with the dense output of the step, and V and the second unknown at its node 0.
    Returns a State in the direction and with the second unknown of the regime of the step; nothing limits its V or d,
    which may lie outside the regime by the error of the polynomials.
    """
    return State(
        nodes[ROW_V] + evaluate_dense_output(v, nodes, ROW_DENSE_V),
        nodes[ROW_OMEGA_OR_D] + evaluate_dense_output(v, nodes, ROW_DENSE_OMEGA_OR_D),
    )
