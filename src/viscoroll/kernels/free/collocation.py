"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants."""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from ..compile.fma import fma
from ..compile.jit import kernel
from ..numerics.arrays import fill
from ..numerics.nodes import Interpolation, radau

#: collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N
N = 9


_INNER = Interpolation(radau(N, 1))
_ALL = Interpolation((Decimal(-1), *_INNER.exact))
NODES = _ALL.nodes
#: values at all nodes to the coefficients of powers
TO_POWERS = _ALL.powers()
#: the same, node by node
BY_NODE = np.ascontiguousarray(TO_POWERS.T)
#: values at all nodes to slopes at nodes 1 ... N
SLOPES = _ALL.slopes(_INNER.exact)
#: values at nodes 1 ... N to the coefficients of powers, to slopes there (column 0 is that of node 0)
INNER_POWERS = _INNER.powers()
SMOOTH_SLOPES = np.hstack((np.zeros((N, 1)), _INNER.slopes(_INNER.exact)))
#: values at nodes 1 ... N to the integrals from -1 to each of them, and to the value at -1
INTEGRALS = _INNER.integrals(_INNER.exact)
INTEGRAL = INTEGRALS[N - 1].copy()
TO_START = _INNER.values([Decimal(-1)])[0]


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
