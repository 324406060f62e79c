"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants.

A row holds the values at the eight nodes of a step: eight numbers, two vectors of four.  A matrix is stored by its
eight columns, one after the other.  Positions on a step are v = 1 + t in [0, 2].
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import kernel
from ..numerics.interpolation import Interpolation, radau
from ..numerics.simd4 import LANES, broadcast, fma4, load, store

#: number of collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N
N = 7
#: length of a row: node 0 and the N collocation nodes
ROW_LENGTH = N + 1
assert ROW_LENGTH == 2 * LANES

_INNER = Interpolation(radau(N, 1))
_ALL = Interpolation((Decimal(-1), *_INNER.exact))
#: positions t of all nodes on [-1, 1]
NODES = _ALL.nodes
#: positions of all nodes as fractions of the step
NODE_FRACTIONS = 0.5 * (1.0 + NODES)
#: weights of the values at nodes 1 ... N in the integral from -1 to 1
QUADRATURE_WEIGHTS = _INNER.integrals(_INNER.exact)[N - 1].copy()
#: weights of the values at nodes 1 ... N in the value that their interpolant has at -1
EXTRAPOLATION_TO_START = _INNER.values([Decimal(-1)])[0]


def _divide_by_linear(powers: np.ndarray) -> np.ndarray:
    """Divide polynomials that vanish at -1 by 1 + t; powers: coefficients [power, polynomial]."""
    found, quotient = np.zeros_like(powers[1:]), 0.0
    for k in range(len(powers) - 1, 0, -1):
        found[k - 1] = quotient = powers[k] - quotient
    return found


def _column_major(matrix: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(matrix.T).ravel()


#: matrix: values at all nodes to slopes of the interpolant there; its row of node 0 is 0, as no slope is needed there
DIFFERENTIATION = _column_major(np.vstack([np.zeros(ROW_LENGTH), _ALL.slopes(_INNER.exact)]))
#: matrix: values at all nodes, less that at node 0, to the coefficients of :func:`evaluate_dense_output`
_DENSE_MATRIX = _column_major(np.vstack([_divide_by_linear(_ALL.powers()), np.zeros(ROW_LENGTH)]))
_INTEGRALS = np.vstack([np.zeros(ROW_LENGTH), _ALL.powers() / np.arange(1.0, ROW_LENGTH + 1.0)[:, None]])
#: matrix: values at all nodes, less that at node 0, to the coefficients of :func:`evaluate_integral`
_INTEGRAL_MATRIX = _column_major(np.vstack([_divide_by_linear(_divide_by_linear(_INTEGRALS)), np.zeros(ROW_LENGTH)]))
#: the identity matrix
_IDENTITY = np.eye(ROW_LENGTH).ravel()
#: 1 off the diagonal, 0 on it
_OFF_DIAGONAL = 1.0 - _IDENTITY


@kernel(inline=True)
def multiply_matrix(matrix, row, offset, values, target, result):
    """Write the product of a matrix and a row, less ``offset``, to ``result`` from index ``target`` on.

    matrix: by columns; row: index in ``values`` at which the row begins.
    """
    low = high = broadcast(0.0)
    for k in range(ROW_LENGTH):
        x = broadcast(values[row + k] - offset)
        low = fma4(load(matrix, ROW_LENGTH * k), x, low)
        high = fma4(load(matrix, ROW_LENGTH * k + LANES), x, high)
    store(result, target, low)
    store(result, target + LANES, high)


@kernel(inline=True)
def assemble_newton_matrix(weights, diagonal, nodes, matrix):
    """Write diag(weights) D - diag(diagonal) to ``matrix``, D the differentiation matrix; row and column of node 0
    are 0.

    weights, diagonal: rows of ``nodes``.
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


@kernel(inline=True)
def _eliminate(i, matrix):
    """Do step i of the inversion of a matrix in place, by Gauss and Jordan with the pivot on the diagonal.

    Only whole vectors are stored: a vector load behind the store of a single number into it would wait for that store.
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


@kernel(inline=True)
def invert_matrix(matrix):
    """Invert a matrix in place, without pivoting: where that loses digits, Newton's iteration does not converge."""
    for i in range(1, ROW_LENGTH):
        _eliminate(i, matrix)


@kernel(inline=True)
def invert_two_matrices(first, second):
    """Invert two matrices in place, step by step in turn: the processor works on one while the other waits."""
    for i in range(1, ROW_LENGTH):
        _eliminate(i, first)
        _eliminate(i, second)


@kernel(inline=True)
def fit_dense_output(row, target, nodes):
    """Store the coefficients of the interpolant of a row, less its value at the left end, for
    :func:`evaluate_dense_output`.

    row, target: indices in ``nodes`` of the values and of the coefficients.
    """
    multiply_matrix(_DENSE_MATRIX, row, nodes[row], nodes, target, nodes)


@kernel
def fit_integral(row, target, nodes):
    """Store the coefficients of the integral of the interpolant of a row for :func:`evaluate_integral`."""
    multiply_matrix(_INTEGRAL_MATRIX, row, nodes[row], nodes, target, nodes)


@kernel(inline=True)
def evaluate_dense_output(v, nodes, row):
    """Return the value at v of the interpolant whose coefficients are in ``row``, less its value at the left end.

    v: position in [0, 2]; nodes: array; row: index of the coefficients.
    """
    t, value = v - 1.0, 0.0
    for k in range(ROW_LENGTH - 1, -1, -1):
        value = fma(t, value, nodes[row + k])
    return v * value


@kernel(inline=True)
def evaluate_integral(v, first, nodes, row):
    """Return the integral over t from the left end to v of the interpolant with value ``first`` at the left end.

    It is accurate relative to itself as v -> 0.  row: index of the coefficients of :func:`fit_integral`.
    """
    return v * (first + evaluate_dense_output(v, nodes, row))


@kernel
def row_range(row, nodes):
    """Return (smallest, largest) value of a row."""
    smallest = largest = nodes[row]
    for i in range(1, N + 1):
        smallest, largest = min(smallest, nodes[row + i]), max(largest, nodes[row + i])
    return smallest, largest
