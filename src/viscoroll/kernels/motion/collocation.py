"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from ..compile.arrays import fill
from ..compile.fma import fma
from ..compile.jit import kernel

#: collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N
N = 9


def _radau_nodes() -> np.ndarray:
    """-1 and the zeros of P_N - P_(N-1), of which the last is 1."""
    series = np.zeros(N + 1)
    series[N - 1 :] = -1.0, 1.0
    roots = np.sort(legendre.legroots(series).real)
    slope = legendre.legder(series)
    for _ in range(3):
        roots -= legendre.legval(roots, series) / legendre.legval(roots, slope)
    roots[-1] = 1.0
    return np.concatenate(([-1.0], roots))


NODES = _radau_nodes()
_POWERS = np.vander(NODES, increasing=True)
#: values at all nodes to the coefficients of powers
TO_POWERS = np.linalg.inv(_POWERS)
#: the same, node by node
BY_NODE = np.ascontiguousarray(TO_POWERS.T)
_SLOPES = np.hstack((np.zeros((N + 1, 1)), _POWERS[:, :-1] * np.arange(1, N + 1)))
#: values at all nodes to slopes at nodes 1 ... N
SLOPES = (_SLOPES @ TO_POWERS)[1:]
_INNER = np.linalg.inv(_POWERS[1:, :-1])
#: values at nodes 1 ... N to the coefficients of powers, to slopes there (column 0 is that of node 0)
INNER_POWERS = _INNER
SMOOTH_SLOPES = np.hstack((np.zeros((N, 1)), _SLOPES[1:, :-1] @ _INNER))
#: values at nodes 1 ... N to the integrals from -1 to each of them, and to the value at -1
INTEGRALS = np.array([[(x ** (k + 1) - (-1.0) ** (k + 1)) / (k + 1) for k in range(N)] for x in NODES[1:]]) @ _INNER
INTEGRAL = INTEGRALS[N - 1].copy()
TO_START = (-1.0) ** np.arange(N) @ _INNER


@kernel
def polynomial(t, powers, row):
    """Polynomial with the coefficients ``powers[row]``."""
    total = 0.0
    for k in range(powers.shape[1] - 1, -1, -1):
        total = fma(t, total, powers[row, k])
    return total


@kernel
def fit_terms(values, powers):
    """Coefficients for :func:`polynomial` of the interpolant of all nodes; the sums of all powers side by side."""
    fill(0.0, powers)
    for i in range(N + 1):
        for k in range(N + 1):
            powers[k] += BY_NODE[i, k] * values[i]


@kernel
def integral_terms(values, half, powers, row):
    """Coefficients for :func:`rise_at` of the integral of the interpolant of all nodes, scaled by ``half``."""
    fit_terms(values, powers[row])
    for k in range(N, -1, -1):
        powers[row, k + 1] = powers[row, k] * half / (k + 1.0)
    _divide(powers, row)


@kernel
def rise_terms(values, powers, row):
    """Coefficients for :func:`rise_at` of the interpolant of all nodes less its value at the left end."""
    fit_terms(values, powers[row])
    _divide(powers, row)


@kernel
def _divide(powers, row):
    """Divide by 1 + t a polynomial of degree N + 1 that vanishes at t = -1, whatever its first coefficient:
    near the left end it would itself be a difference of large terms."""
    quotient = 0.0
    for k in range(N + 1, 0, -1):
        term = powers[row, k]
        powers[row, k] = quotient
        quotient = term - quotient
    powers[row, 0] = quotient


@kernel
def rise_at(v, powers, row):
    """The integral in this row from the left end to v = 1 + t."""
    return v * polynomial(v - 1.0, powers, row)


@kernel
def place(value, v, powers, row):
    """v = 1 + t in [0, 2] where the rising integral in this row has this value, by Newton's iteration from v."""
    for _ in range(20):
        t = v - 1.0
        quotient = slope = 0.0
        for k in range(powers.shape[1] - 1, -1, -1):
            slope = quotient + t * slope
            quotient = powers[row, k] + t * quotient
        reached = v * quotient
        if reached == value:
            break
        change = (value - reached) / (quotient + v * slope)
        v = min(max(v + change, 0.0), 2.0)
        if abs(change) <= 1e-9 * v:
            break
    return v


@kernel(inline=True)
def factorize(matrix, count):
    """Two triangular factors in place of a matrix, without pivoting: what that spoils, Newton's convergence shows."""
    for i in range(count):
        inverse = 1.0 / matrix[i, i]
        for row in range(i + 1, count):
            share = matrix[row, i] * inverse
            matrix[row, i] = share
            for column in range(i + 1, count):
                matrix[row, column] -= share * matrix[i, column]


@kernel(inline=True)
def substitute(matrix, right, count):
    """Solve a linear system in place of its right side, from the factors of the matrix."""
    for row in range(1, count):
        total = right[row]
        for i in range(row):
            total -= matrix[row, i] * right[i]
        right[row] = total
    for i in range(count - 1, -1, -1):
        total = right[i]
        for column in range(i + 1, count):
            total -= matrix[i, column] * right[column]
        right[i] = total / matrix[i, i]
