"""Radau IIA collocation on [-1, 1], with the left end as node 0: nodes, matrices, interpolants."""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from ..compile.fma import fma
from ..compile.jit import kernel
from ..numerics.arrays import fill
from ..numerics.nodes import Interpolation, radau

#: collocation nodes; the quadrature is of order 2 N - 1, the interpolant of degree N
N = 7


_INNER = Interpolation(radau(N, 1))
_ALL = Interpolation((Decimal(-1), *_INNER.exact))
NODES = _ALL.nodes
#: how far along a panel the nodes lie
SHARES = 0.5 * (1.0 + NODES)
#: values at all nodes to the coefficients of powers, node by node
_BY_NODE = np.ascontiguousarray(_ALL.powers().T)
#: values at all nodes to slopes at nodes 1 ... N
SLOPES = _ALL.slopes(_INNER.exact)
#: values at nodes 1 ... N to the integral from -1 to 1, and to the value at -1
INTEGRAL = _INNER.integrals(_INNER.exact)[N - 1].copy()
TO_START = _INNER.values([Decimal(-1)])[0]


@kernel
def _fit_terms(values, first, powers):
    """Coefficients of the interpolant of all nodes less ``first``; the sums of all powers side by side."""
    fill(0.0, powers)
    for i in range(N + 1):
        rise = values[i] - first
        for k in range(N + 1):
            powers[k] = fma(_BY_NODE[i, k], rise, powers[k])


@kernel
def integral_terms(values, half, powers, row):
    """Coefficients for :func:`rise_at` of the integral of the interpolant of all nodes, scaled by ``half``."""
    _fit_terms(values, 0.0, powers[row])
    for k in range(N, -1, -1):
        powers[row, k + 1] = powers[row, k] * half / (k + 1.0)
    _divide(powers, row)


@kernel
def rise_terms(values, powers, row):
    """Coefficients for :func:`rise_at` of the interpolant of all nodes less its value at the left end."""
    _fit_terms(values, values[0], powers[row])
    _divide(powers, row)


@kernel(inline=True)
def _divide(powers, row):
    """Divide by 1 + t a polynomial of degree N + 1 that vanishes at t = -1, whatever its first coefficient:
    near the left end it would itself be a difference of large terms."""
    quotient = 0.0
    for k in range(N + 1, 0, -1):
        term = powers[row, k]
        powers[row, k] = quotient
        quotient = term - quotient
    powers[row, 0] = quotient


@kernel(inline=True)
def rise_at(v, powers, row):
    """The rise, or the integral, in this row from the left end to v = 1 + t."""
    t, total = v - 1.0, 0.0
    for k in range(N + 1, -1, -1):
        total = fma(t, total, powers[row, k])
    return v * total
