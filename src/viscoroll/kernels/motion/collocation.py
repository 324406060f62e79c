"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants.

A row holds the values at the eight nodes of a step: eight numbers, two vectors of four.  A matrix is stored by its
eight columns, one after the other.  Positions on a step are v = 1 + t in [0, 2].

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- v: position on a step, 0 at its left end and 2 at its right end.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import inline_kernel, kernel
from ..numerics.interpolation import Interpolation, radau
from ..numerics.simd4 import LANES, broadcast, fma4, load, store

#: Number of collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N.  With five, errors of
#: 1e-11 were not reached; with nine, motions took a twentieth to a tenth longer.
N = 7
#: Length of a row: node 0 and the N collocation nodes, two vectors of four numbers.
ROW_LENGTH = N + 1
assert ROW_LENGTH == 2 * LANES

#: Interpolation through nodes 1 ... N.
_INNER = Interpolation(radau(N, 1))
#: Interpolation through all nodes; node 0 is at -1.
_ALL = Interpolation((Decimal(-1), *_INNER.exact))
#: Positions t of all nodes on [-1, 1].
NODES = _ALL.nodes
#: Positions of all nodes as fractions of the step.
NODE_FRACTIONS = 0.5 * (1.0 + NODES)
#: Weights of the values at nodes 1 ... N in the integral from -1 to 1.
QUADRATURE_WEIGHTS = _INNER.integrals(_INNER.exact)[N - 1].copy()
#: Weights of the values at nodes 1 ... N in the value that their interpolant has at -1.
EXTRAPOLATION_TO_START = _INNER.values([Decimal(-1)])[0]


def _divide_by_linear(powers: np.ndarray) -> np.ndarray:
    """Divide polynomials in t that vanish at t = -1 by 1 + t, by synthetic division.

    powers: (n, m), coefficients of m polynomials in ascending powers of t.
    Returns (n - 1, m), coefficients of the quotients in ascending powers; the remainder of a polynomial that does not
    vanish at -1 is dropped.
    """
    found, quotient = np.zeros_like(powers[1:]), 0.0
    for k in range(len(powers) - 1, 0, -1):
        found[k - 1] = quotient = powers[k] - quotient
    return found


def _column_major(matrix: np.ndarray) -> np.ndarray:
    """Return a matrix, (ROW_LENGTH, ROW_LENGTH), as a vector, column after column, as the kernels load it."""
    return np.ascontiguousarray(matrix.T).ravel()


#: The matrix takes values at all nodes to slopes of the interpolant there; its row of node 0 is 0, as no slope is
#: needed there.
DIFFERENTIATION = _column_major(np.vstack([np.zeros(ROW_LENGTH), _ALL.slopes(_INNER.exact)]))
#: The matrix takes values at all nodes, less that at node 0, to the coefficients of :func:`evaluate_dense_output`.
_DENSE_MATRIX = _column_major(np.vstack([_divide_by_linear(_ALL.powers()), np.zeros(ROW_LENGTH)]))
#: Coefficients [power, node] of the integrals from t = 0 of the polynomials that are 1 at one node and 0 at the others.
_INTEGRALS = np.vstack([np.zeros(ROW_LENGTH), _ALL.powers() / np.arange(1.0, ROW_LENGTH + 1.0)[:, None]])
#: The matrix takes values at all nodes, less that at node 0, to the coefficients of :func:`evaluate_integral`.
_INTEGRAL_MATRIX = _column_major(np.vstack([_divide_by_linear(_divide_by_linear(_INTEGRALS)), np.zeros(ROW_LENGTH)]))
#: Identity matrix, column by column.
_IDENTITY = np.eye(ROW_LENGTH).ravel()
#: Matrix of 1 off the diagonal and 0 on it, column by column.
_OFF_DIAGONAL = 1.0 - _IDENTITY


@inline_kernel
def multiply_matrix(matrix, row, offset, values, target, result):
    """Write the product of a matrix and a row, from whose values ``offset`` is subtracted.

    matrix: array or pointer of ROW_LENGTH^2 numbers, column by column.
    row: int, index in ``values`` at which the row of ROW_LENGTH numbers begins.
    offset: float, subtracted from each value of the row.
    values: array or pointer that contains the row.
    target: int, index in ``result`` from which the product is written.
    result: array or pointer, ROW_LENGTH numbers of which are written; it may be ``values``, as all are read before.  A
    NaN or inf in the row makes the whole product NaN or inf, even where the matrix is 0.  Returns nothing.
    """
    low = high = broadcast(0.0)
    for k in range(ROW_LENGTH):
        x = broadcast(values[row + k] - offset)
        low = fma4(load(matrix, ROW_LENGTH * k), x, low)
        high = fma4(load(matrix, ROW_LENGTH * k + LANES), x, high)
    store(result, target, low)
    store(result, target + LANES, high)


@inline_kernel
def assemble_newton_matrix(weights, diagonal, nodes, matrix):
    """Write diag(weights) D - diag(diagonal), the matrix of a linear system of :mod:`step`.

    D is the differentiation matrix.  Node 0 is given, not an unknown: the column of node 0 is not written, and in the
    other columns the entry of node 0 is 0.

    weights: int, index in ``nodes`` at which the row of the weights begins; that of node 0 must be finite.
    diagonal: int, index in ``nodes`` at which the row of the subtracted diagonal begins; its node 0 is not read.
    nodes: Workspace.nodes.
    matrix: pointer to ROW_LENGTH^2 numbers, of which columns 1 ... N are written; column 0 keeps its values, 0 from the
    start of the motion.  Returns nothing.
    """
    low, high = load(nodes, weights), load(nodes, weights + LANES)
    for k in range(1, ROW_LENGTH):
        column, subtracted = ROW_LENGTH * k, broadcast(-nodes[diagonal + k])
        store(matrix, column, fma4(subtracted, load(_IDENTITY, column), load(DIFFERENTIATION, column) * low))
        store(
            matrix,
            column + LANES,
            fma4(subtracted, load(_IDENTITY, column + LANES), load(DIFFERENTIATION, column + LANES) * high),
        )


@inline_kernel
def _eliminate(i, matrix):
    """Do one step of the inversion of a Newton matrix in place, by Gauss and Jordan with the pivot on the diagonal.

    After the steps 1 ... N the matrix holds its inverse.  Only whole vectors are stored: a vector load after the store
    of a single number into it would wait for that store.

    i: int, 1 ... N, number of the step and index of the row and column of its pivot; row and column of node 0 are left
    out.
    matrix: pointer to ROW_LENGTH^2 numbers, column by column; columns 1 ... N are changed, their entries of node 0 stay
    0.  A pivot of 0 leaves inf and NaN.  Returns nothing.
    """
    column = ROW_LENGTH * i
    pivot = broadcast(1.0 / matrix[column + i])
    off_low, off_high = load(_OFF_DIAGONAL, column), load(_OFF_DIAGONAL, column + LANES)
    low = fma4(load(_IDENTITY, column), pivot, load(matrix, column) * off_low * pivot)
    high = fma4(load(_IDENTITY, column + LANES), pivot, load(matrix, column + LANES) * off_high * pivot)
    for k in range(1, ROW_LENGTH):
        if k != i:
            factor = broadcast(-matrix[ROW_LENGTH * k + i])
            store(matrix, ROW_LENGTH * k, fma4(factor, low, load(matrix, ROW_LENGTH * k) * off_low))
            store(matrix, ROW_LENGTH * k + LANES, fma4(factor, high, load(matrix, ROW_LENGTH * k + LANES) * off_high))
    store(matrix, column, low)
    store(matrix, column + LANES, high)


@inline_kernel
def invert_matrix(matrix):
    """Invert a Newton matrix in place, by Gauss-Jordan elimination without pivoting.

    Row and column of node 0 are left out.  Where a small pivot costs digits, Newton's iteration does not converge, and
    the step is repeated shorter; a pivot of 0 leaves inf and NaN in the matrix, with the same effect.

    matrix: pointer to ROW_LENGTH^2 numbers, column by column, as :func:`assemble_newton_matrix` writes them;
    overwritten by the inverse.  Returns nothing.
    """
    for i in range(1, ROW_LENGTH):
        _eliminate(i, matrix)


@inline_kernel
def invert_two_matrices(first, second):
    """Invert two Newton matrices in place, step by step in turn: the processor works on one while the other waits.

    first, second: pointers to ROW_LENGTH^2 numbers each, column by column, overwritten as by :func:`invert_matrix`.
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

    row: int, index in ``nodes`` of the value at node 0 of the row; the values at all nodes are read.
    target: int, index in ``nodes`` from which ROW_LENGTH numbers are written: c_0 ... c_(N-1) in the unit of the row,
    and a 0.
    nodes: Workspace.nodes.  Returns nothing.
    """
    multiply_matrix(_DENSE_MATRIX, row, nodes[row], nodes, target, nodes)


@kernel
def fit_integral(row, target, nodes):
    """Store the coefficients of the integral of the interpolant of a row.

    With t in [-1, 1] on the step and v = 1 + t the integral over t from the left end is

        v (nodes[row] + v (c_0 + c_1 t + ... + c_(N-1) t^(N-1)))

    It is over t, so that half the length of the step is still to be multiplied.  The value nodes[row] at the left end
    is not among the coefficients: :func:`evaluate_integral` takes it as an argument.

    row: int, index in ``nodes`` of the value at node 0 of the row; the values at all nodes are read.
    target: int, index in ``nodes`` from which ROW_LENGTH numbers are written: c_0 ... c_(N-1) in the unit of the row,
    and a 0.
    nodes: Workspace.nodes.  Returns nothing.
    """
    multiply_matrix(_INTEGRAL_MATRIX, row, nodes[row], nodes, target, nodes)


@inline_kernel
def evaluate_dense_output(v, nodes, row):
    """Return the interpolant of a row at a position, less its value at the left end; a float in the unit of the row.

    The caller adds that value where it needs it; without it the result is accurate relative to itself as v -> 0.

    v: float, position on the step, 0 at its left end, where the result is 0, and 2 at its right end; outside the
    polynomial is extrapolated.
    nodes: Workspace.nodes.
    row: int, index in ``nodes`` of the first of the ROW_LENGTH coefficients of :func:`fit_dense_output`.
    """
    t, value = v - 1.0, 0.0
    for k in range(ROW_LENGTH - 1, -1, -1):
        value = fma(t, value, nodes[row + k])
    return v * value


@inline_kernel
def evaluate_integral(v, first, nodes, row):
    """Return the integral of the interpolant of a row from the left end to a position; a float in the unit of the row.

    It is over t in [-1, 1]: times half the length of the step it is the integral over tau.  It is accurate relative to
    itself as v -> 0.

    v: float, position in [0, 2] on the step.
    first: float, value of the row at the left end, which is not among the coefficients.
    nodes: Workspace.nodes.
    row: int, index in ``nodes`` of the first of the ROW_LENGTH coefficients of :func:`fit_integral`.
    """
    return v * (first + evaluate_dense_output(v, nodes, row))


@kernel
def row_range(row, nodes):
    """Return the smallest and the largest of the values of a row at all nodes.

    Event functions are compared with their range, and V with its largest value.

    row: int, index in ``nodes`` at which the row begins.
    nodes: Workspace.nodes.
    Returns (smallest, largest), floats in the unit of the row.  Both are NaN if node 0 is; a NaN at another node is
    passed over.
    """
    smallest = largest = nodes[row]
    for i in range(1, N + 1):
        smallest, largest = min(smallest, nodes[row + i]), max(largest, nodes[row + i])
    return smallest, largest
