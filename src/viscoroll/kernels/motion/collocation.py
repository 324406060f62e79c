"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants.

What a panel holds of its eight nodes is a row of eight numbers, two vectors of four; a matrix is eight of these, its
columns one after the other.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import kernel
from ..numerics.interpolation import Interpolation, radau
from ..numerics.simd4 import LANES, broadcast, fma4, load, store

#: collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N
N = 7
#: numbers of a row
WIDE = N + 1
assert WIDE == 2 * LANES


_INNER = Interpolation(radau(N, 1))
_ALL = Interpolation((Decimal(-1), *_INNER.exact))
NODES = _ALL.nodes
#: how far along a panel the nodes lie
SHARES = 0.5 * (1.0 + NODES)
#: values at nodes 1 ... N to the integral from -1 to 1, and to the value at -1
INTEGRAL = _INNER.integrals(_INNER.exact)[N - 1].copy()
TO_START = _INNER.values([Decimal(-1)])[0]


def _divided(powers: np.ndarray) -> np.ndarray:
    """Coefficients of polynomials that vanish at -1, [power, which], divided by 1 + t."""
    found, quotient = np.zeros_like(powers[1:]), 0.0
    for k in range(len(powers) - 1, 0, -1):
        found[k - 1] = quotient = powers[k] - quotient
    return found


def _columns(matrix: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(matrix.T).ravel()


#: values at all nodes to slopes there, of which that at node 0 is not asked for
SLOPES = _columns(np.vstack([np.zeros(WIDE), _ALL.slopes(_INNER.exact)]))
#: values at all nodes, less that at node 0, to what :func:`rise_at` takes
_RISES = _columns(np.vstack([_divided(_ALL.powers()), np.zeros(WIDE)]))
#: values at all nodes, less that at node 0, to what :func:`integral_at` takes; that of node 0 is then 0
_INTEGRALS = np.vstack([np.zeros(WIDE), _ALL.powers() / np.arange(1.0, WIDE + 1.0)[:, None]])
_TO_INTEGRAL = _columns(np.vstack([_divided(_divided(_INTEGRALS)), np.zeros(WIDE)]))


#: of every column, the number on the diagonal, and all others
_ONE = np.eye(WIDE).ravel()
_OTHERS = 1.0 - _ONE


@kernel(inline=True)
def product(matrix, row, first, values, to, found):
    """Put the product of a matrix with the ``row`` of values, less ``first``, where ``to`` says."""
    low = high = broadcast(0.0)
    for k in range(WIDE):
        x = broadcast(values[row + k] - first)
        low = fma4(load(matrix, WIDE * k), x, low)
        high = fma4(load(matrix, WIDE * k + LANES), x, high)
    store(found, to, low)
    store(found, to + LANES, high)


@kernel(inline=True)
def weighted_slopes(weights, diagonal, nodes, matrix):
    """The matrix of the slopes, rows times ``weights``, less a ``diagonal``; row and column of node 0 are 0."""
    low, high = load(nodes, weights), load(nodes, weights + LANES)
    for k in range(1, WIDE):
        at, less = WIDE * k, broadcast(-nodes[diagonal + k])
        store(matrix, at, fma4(less, load(_ONE, at), load(SLOPES, at) * low))
        store(matrix, at + LANES, fma4(less, load(_ONE, at + LANES), load(SLOPES, at + LANES) * high))


@kernel(inline=True)
def invert(matrix):
    """Put the inverse in place, without pivoting: what that spoils, Newton's convergence shows.

    By vectors alone: one that is loaded behind a number that was just put into it waits for that.
    """
    for i in range(1, WIDE):
        at = WIDE * i
        pivot = broadcast(1.0 / matrix[at + i])
        others, rest = load(_OTHERS, at), load(_OTHERS, at + LANES)
        low = fma4(load(_ONE, at), pivot, load(matrix, at) * others * pivot)
        high = fma4(load(_ONE, at + LANES), pivot, load(matrix, at + LANES) * rest * pivot)
        for k in range(1, WIDE):
            if k != i:
                less = broadcast(-matrix[WIDE * k + i])
                store(matrix, WIDE * k, fma4(less, low, load(matrix, WIDE * k) * others))
                store(matrix, WIDE * k + LANES, fma4(less, high, load(matrix, WIDE * k + LANES) * rest))
        store(matrix, at, low)
        store(matrix, at + LANES, high)


@kernel(inline=True)
def rise_terms(row, to, nodes):
    """Coefficients for :func:`rise_at` of the interpolant of all nodes less its value at the left end."""
    product(_RISES, row, nodes[row], nodes, to, nodes)


@kernel
def integral_terms(row, to, nodes):
    """Coefficients for :func:`integral_at` of the interpolant of all nodes."""
    product(_TO_INTEGRAL, row, nodes[row], nodes, to, nodes)


@kernel(inline=True)
def integral_at(v, first, nodes, row):
    """The integral from the left end, where what is integrated is ``first``, to v = 1 + t: right beside itself."""
    return v * (first + rise_at(v, nodes, row))


@kernel(inline=True)
def rise_at(v, nodes, row):
    """The rise in this row from the left end to v = 1 + t."""
    t, total = v - 1.0, 0.0
    for k in range(WIDE - 1, -1, -1):
        total = fma(t, total, nodes[row + k])
    return v * total
