"""Nodes and matrices of Radau IIA collocation on [-1, 1], with the left end as node 0."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

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
_SLOPES = np.hstack((np.zeros((N + 1, 1)), _POWERS[:, :-1] * np.arange(1, N + 1)))
#: values at all nodes to slopes at nodes 1 ... N
SLOPES = (_SLOPES @ TO_POWERS)[1:]
_INNER = np.linalg.inv(_POWERS[1:, :-1])
#: values at nodes 1 ... N to the integral over [-1, 1], and to the value at -1
INTEGRAL = np.array([(1.0 - (-1.0) ** (k + 1)) / (k + 1) for k in range(N)]) @ _INNER
TO_START = (-1.0) ** np.arange(N) @ _INNER
