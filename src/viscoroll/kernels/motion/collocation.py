"""Collocation of one step: nodes, matrices, interpolants, and the layout of its workspace.

Collocation is Radau IIA on [-1, 1] (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
II*, Springer 1996, Sect. IV.5), with the left end as node 0.  A row holds the values at the eight
nodes of a step: eight numbers, two vectors of four.  A matrix is stored by its eight columns, one
after the other.  In the names of rows and matrices D stands for the second unknown, omega or d.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t of a motion.
- t: position on a step in [-1, 1], and v = 1 + t: 0 at its left end and 2 at its right end.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in
  full slip (:mod:`rhs`).  p' is its slope in tau.
"""

import numpy as np

from ..numerics.interpolation import Interpolation, radau
from ..numerics.intrinsics import fma
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import LANES, broadcast, fma4, make_load, store
from ..records import N_NODE_FUNCTIONS, N_QUADRATURES, Regime, State, Step, StepState

# --- Radau IIA collocation on [-1, 1], with the left end as node 0 ---

#: Number of collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N.
#: With five, errors of 1e-11 were not reached; with nine, motions took a twentieth to a tenth
#: longer.
N = 7
#: Length of a row: node 0 and the N collocation nodes, two vectors of four numbers.
ROW_LENGTH = N + 1
assert ROW_LENGTH == 2 * LANES

#: Interpolation through nodes 1 ... N.
_INNER = Interpolation(radau(N))
#: Interpolation through all nodes; node 0 is at -1.
_ALL = Interpolation((-1, *_INNER.exact))
#: Positions t of all nodes on [-1, 1].
NODES = _ALL.nodes
#: Positions of all nodes as fractions of the step.
NODE_FRACTIONS = 0.5 * (1.0 + NODES)
#: Weights of the values at nodes 1 ... N in the integral from -1 to 1.
QUADRATURE_WEIGHTS = _INNER.integrals([1])[0]
#: Weights of the values at nodes 1 ... N in the value that their interpolant has at -1.
EXTRAPOLATION_TO_START = _INNER.values([-1])[0]


def _divide_by_linear(powers: np.ndarray) -> np.ndarray:
    """Divide polynomials in t that vanish at t = -1 by 1 + t, by synthetic division.

    powers: (n, m), coefficients of m polynomials in ascending powers of t.
    Returns (n, m), coefficients of the quotients in ascending powers, the last of which is 0; the
    remainder of a polynomial that does not vanish at -1 is dropped.
    """
    found = np.zeros_like(powers)
    quotient = 0.0  # coefficient of the quotient, from the highest power down
    for k in range(len(powers) - 1, 0, -1):
        found[k - 1] = quotient = powers[k] - quotient
    return found


# Kernels load the matrices as vectors, column after column.
#: The matrix takes values at all nodes to slopes of the interpolant there; its row of node 0 is 0,
#: as no slope is needed there.
DIFFERENTIATION = np.vstack([np.zeros(ROW_LENGTH), _ALL.slopes(_INNER.exact)]).ravel("F")
#: The matrix takes values at all nodes, less that at node 0, to the coefficients of
#: :func:`evaluate_dense_output`.
_DENSE_MATRIX = _divide_by_linear(_ALL.powers()).ravel("F")
#: Coefficients [power, node] of the integrals from t = 0 of the polynomials that are 1 at one node
#: and 0 at the others.
_INTEGRALS = np.vstack(
    [np.zeros(ROW_LENGTH), _ALL.powers() / np.arange(1.0, ROW_LENGTH + 1.0)[:, None]]
)
#: The matrix takes values at all nodes, less that at node 0, to the coefficients of
#: :func:`.output._quadrature_at`.
INTEGRAL_MATRIX = _divide_by_linear(_divide_by_linear(_INTEGRALS))[:-1].ravel("F")
#: Identity matrix, column by column.
_IDENTITY = np.eye(ROW_LENGTH).ravel()
#: Matrix of 1 off the diagonal and 0 on it, column by column.
_OFF_DIAGONAL = 1.0 - _IDENTITY
#: Added to a product, it changes no bit of the product, nor its sign: fma4(a, b, this) is the
#: product a b of columns, for which LLVM makes a multiplication.
_NOTHING = -0.0
#: (array, start) -> a row, or a column of a matrix, as two vectors.
_load_column = make_load(ROW_LENGTH // LANES)


@inline_kernel
def multiply_matrix(matrix, row, offset, values, target, result):
    """Write the product of a matrix and a row, from whose values ``offset`` is subtracted.

    matrix: array or pointer of ROW_LENGTH^2 numbers, column by column.
    row: int, index in ``values`` at which the row of ROW_LENGTH numbers begins.
    offset: float, subtracted from each value of the row.
    values: array or pointer that contains the row.
    target: int, index in ``result`` from which the product is written.
    result: array or pointer, ROW_LENGTH numbers of which are written; it may be ``values``, as all
    are read before.  A NaN or inf in the row makes the whole product NaN or inf, even where the
    matrix is 0.
    Returns nothing.
    """
    # two vectors, rows 0 ... 3 of the product and rows 4 ... 7: a column times a number each
    product = broadcast(0.0), broadcast(0.0)
    for k in range(ROW_LENGTH):
        column = _load_column(matrix, ROW_LENGTH * k)
        product = fma4(column, broadcast(values[row + k] - offset), product)
    store(result, target, product)


@inline_kernel
def assemble_newton_matrix(weights, diagonal, nodes, matrix):
    """Write diag(weights) D - diag(diagonal), the matrix of a linear system of :mod:`step`.

    D is the differentiation matrix.  Node 0 is given, not an unknown: the column of node 0 is not
    written, and in the other columns the entry of node 0 is 0.

    weights: int, index in ``nodes`` at which the row of the weights begins; that of node 0 must be
    finite.
    diagonal: int, index in ``nodes`` at which the row of the subtracted diagonal begins; its node 0
    is not read.
    nodes: Workspace.nodes.
    matrix: pointer to ROW_LENGTH^2 numbers, of which columns 1 ... N are written; column 0 keeps
    its values, 0 from the start of the motion.
    Returns nothing.
    """
    # row 0 of DIFFERENTIATION and of columns 1 ... N of the identity is 0, so that the entry of
    # node 0 becomes 0
    factors = _load_column(nodes, weights)
    for k in range(1, ROW_LENGTH):
        column = ROW_LENGTH * k
        weighted = fma4(_load_column(DIFFERENTIATION, column), factors, broadcast(_NOTHING))
        subtracted = broadcast(-nodes[diagonal + k])
        store(matrix, column, fma4(subtracted, _load_column(_IDENTITY, column), weighted))


@inline_kernel
def _eliminate(i, matrix):
    """Do one step of the inversion of a Newton matrix in place, by Gauss and Jordan with the pivot
    on the diagonal.

    After the steps 1 ... N the matrix holds its inverse.  Only whole vectors are stored: a vector
    load after the store of a single number into it would wait for that store.

    i: int, 1 ... N, number of the step and index of the row and column of its pivot; row and column
    of node 0 are left out.
    matrix: pointer to ROW_LENGTH^2 numbers, column by column; columns 1 ... N are changed, their
    entries of node 0 stay 0.  A pivot of 0 leaves inf and NaN.
    Returns nothing.
    """
    column = ROW_LENGTH * i
    # With element a_rk in row r and column k, the new column i is a_ri/a_ii, but 1/a_ii at r = i.
    # From each other column k, in which a_ik is set to 0, a_ik times the new column i is
    # subtracted.
    pivot = broadcast(1.0 / matrix[column + i])
    nothing = broadcast(_NOTHING)
    off = _load_column(_OFF_DIAGONAL, column)
    others = fma4(_load_column(matrix, column), off, nothing)
    new = fma4(_load_column(_IDENTITY, column), pivot, fma4(others, pivot, nothing))
    for k in range(1, ROW_LENGTH):
        if k != i:
            factor = broadcast(-matrix[ROW_LENGTH * k + i])
            others = fma4(_load_column(matrix, ROW_LENGTH * k), off, nothing)
            store(matrix, ROW_LENGTH * k, fma4(factor, new, others))
    store(matrix, column, new)


@inline_kernel
def invert_matrix(matrix):
    """Invert a Newton matrix in place, by Gauss-Jordan elimination without pivoting.

    Row and column of node 0 are left out.  Where a small pivot costs digits, Newton's iteration
    does not converge, and the step is repeated shorter; a pivot of 0 leaves inf and NaN in the
    matrix, with the same effect.

    matrix: pointer to ROW_LENGTH^2 numbers, column by column, as :func:`assemble_newton_matrix`
    writes them; overwritten by the inverse.
    Returns nothing.
    """
    for i in range(1, ROW_LENGTH):
        _eliminate(i, matrix)


@inline_kernel
def invert_two_matrices(first, second):
    """Invert two Newton matrices in place, with the steps of both in alternation: the processor
    works on one matrix while the other waits.

    first, second: pointers to ROW_LENGTH^2 numbers each, column by column, overwritten as by
    :func:`invert_matrix`.
    Returns nothing.
    """
    for i in range(1, ROW_LENGTH):
        _eliminate(i, first)
        _eliminate(i, second)


@inline_kernel
def fit_dense_output(row, target, nodes):
    """Store the coefficients of the interpolant of a row, less its value at the left end.

    With t in [-1, 1] on the step and v = 1 + t the interpolant through all nodes is

        nodes[row] + v (c_0 + c_1 t + ... + c_(N-1) t^(N-1))

    The value nodes[row] at the left end is not among the coefficients.

    row: int, index in ``nodes`` of the value at node 0 of the row; the values at all nodes are
    read.
    target: int, index in ``nodes`` from which ROW_LENGTH numbers are written: c_0 ... c_(N-1) in
    the unit of the row, and a 0.
    nodes: Workspace.nodes.
    Returns nothing.
    """
    multiply_matrix(_DENSE_MATRIX, row, nodes[row], nodes, target, nodes)


@inline_kernel
def evaluate_dense_output(v, nodes, row):
    """Return the interpolant of a row at a position, less its value at the left end; a float in the
    unit of the row.

    The caller adds that value where it needs it; without it the result is accurate relative to
    itself as v -> 0.

    v: float, position on the step, 0 at its left end, where the result is 0, and 2 at its right
    end; outside of the step the polynomial is extrapolated.
    nodes: Workspace.nodes.
    row: int, index in ``nodes`` of the first of the ROW_LENGTH coefficients of
    :func:`fit_dense_output`.
    """
    # Horner's scheme in t; the last coefficient is the 0 that fills the row
    t = v - 1.0
    value = 0.0
    for k in range(ROW_LENGTH - 1, -1, -1):
        value = fma(t, value, nodes[row + k])
    return v * value


@kernel
def row_range(row, nodes):
    """Return the smallest and the largest of the values of a row at all nodes.

    Callers need them as the scale of an event function or of V, and for their signs.

    row: int, index in ``nodes`` at which the row begins.
    nodes: Workspace.nodes.
    Returns (smallest, largest), floats in the unit of the row.  Both are NaN if node 0 is; a NaN at
    another node is passed over.
    """
    # a NaN is passed over in the second argument of min and max, and kept in the first
    smallest = largest = nodes[row]
    for i in range(1, N + 1):
        smallest = min(smallest, nodes[row + i])
        largest = max(largest, nodes[row + i])
    return smallest, largest


# --- Layout of the workspace of one motion ---

#: Row of V, dimensionless as all rows.
ROW_V = ROW_LENGTH * 0
#: Row of the second unknown, omega or d.
ROW_OMEGA_OR_D = ROW_LENGTH * 1
#: Row of p'.
ROW_P_RATE = ROW_LENGTH * 2
#: Row of the weight (V in partial slip, 1 in full slip) times the slope in tau of the second
#: unknown.
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
#: Row of the derivative of the residual of the second unknown with respect to p, with the opposite
#: sign.
ROW_COUPLING = ROW_LENGTH * 9
#: Row of the derivative of x' with respect to x, x the second unknown, per unit of tau; where it is
#: below 0, x relaxes.
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
#: Row of two quantities.  At nodes 1 ... N: half the length of the step times dp'/dp, the diagonal
#: that is subtracted in the Newton matrix of p.  At node 0: dp'/dp without this factor, from which
#: :func:`.asymptotics.may_be_at_equilibrium` estimates the distance from the equilibrium.
ROW_P_DIAGONAL = ROW_LENGTH * 19
#: Row of the diagonal that is subtracted in the Newton matrix of the second unknown.
ROW_D_DIAGONAL = ROW_LENGTH * 20
#: Row of the derivative of p' with respect to the second unknown, times half the length of the
#: step.
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
#: Event, and row of its function: a brake no longer holds omega at 0.
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
    """Return the Regime with full or partial slip and another sigma; direction, spin_sign and
    locked stay.

    regime: Regime, the present one.
    full_slip: bool, whether the whole contact slips.
    sigma: float, 1 or -1, sign of the excess slip (:func:`.motion_law.excess_slip`) in full slip,
    of d in partial slip.
    """
    return Regime(
        full_slip=full_slip,
        direction=regime.direction,
        sigma=sigma,
        spin_sign=regime.spin_sign,
        locked=regime.locked,
    )


@inline_kernel
def last_output_tau(work):
    """Return tau of the last output, at which the motion ends, a float.

    work: Workspace, of the motion, with at least one output time.
    """
    return work.output_tau[-1]


@inline_kernel
def shorten_step(step, h):
    """Return the Step with the same left end and the length ``h``, a float in tau.

    step: Step, the one to shorten, whose other fields stay.
    """
    return Step(
        tau=step.tau,
        h=h,
        segment=step.segment,
        initial_slope_known=step.initial_slope_known,
        undriven=step.undriven,
    )


@inline_kernel
def node_time(step, i):
    """Return tau at a node of a step, a float.

    step: Step, of which tau at its left end, node 0, and ``h`` are read.
    i: int, the node, 0 ... N.
    """
    return step.tau + step.h * NODE_FRACTIONS[i]


@inline_kernel
def dense_position(tau, step):
    """Return the position v of a time on a step: 0 at its left end, 2 at its right end, more beyond
    it; a float.

    tau: float, the time; times before the left end, as rounding may leave them, count as the left
    end.
    step: Step, with a length above 0; ``tau`` and ``h`` are read.
    """
    return 2.0 * (max(tau - step.tau, 0.0) / step.h)


@inline_kernel
def set_step_length(h, n_trials, step_state):
    """Return the StepState with ``h`` as the length of the next trial step and ``n_trials`` added
    to ``n_steps``.

    h: float, that length in tau, dimensionless, at least 0; 0 if it is not chosen yet.
    n_trials: int, number added to ``n_steps``, the number of trial steps so far: 1 after a trial
    step, 0 where only the length changes.
    step_state: StepState, the present one; its other fields stay, the number of accepted steps
    among them.
    """
    return StepState(
        tau=step_state.tau,
        next_output=step_state.next_output,
        segment=step_state.segment,
        n_steps=step_state.n_steps + n_trials,
        n_accepted=step_state.n_accepted,
        h=h,
    )


@inline_kernel
def dense_state(v, nodes):
    """Return the State at a position of a step by its dense output.

    v: float, position: 0 at the left end, 2 at the right end; outside of the step the polynomials
    are extrapolated.
    nodes: Workspace.nodes, with the dense output of the step, and V and the second unknown at its
    node 0.
    Returns a State in the direction and with the second unknown of the regime of the step; nothing
    limits its V or d, which may lie outside the regime by the error of the polynomials.
    """
    return State(
        nodes[ROW_V] + evaluate_dense_output(v, nodes, ROW_DENSE_V),
        nodes[ROW_OMEGA_OR_D] + evaluate_dense_output(v, nodes, ROW_DENSE_OMEGA_OR_D),
    )
