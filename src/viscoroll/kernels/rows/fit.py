"""Polynomials of a row from values and slopes at its nodes.

Slopes are fitted and integrated, and one constant is added: value, slope and secant of a polynomial are then all good
to rounding, where one fitted to values has lost three digits in its slopes.  Powers come by way of the rapidly falling
Chebyshev coefficients, which keeps rounding out of them.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.nodes import chebyshev, rounded, to_chebyshev
from .lanes import TERMS

#: Chebyshev's nodes in [-1, 1], upward
NODES = rounded(chebyshev(TERMS))
#: t of the nodes of the slow row, in [0, 1], and of the others
SLOW_NODES = 0.5 + 0.5 * NODES
#: a row a node: what its value adds to the coefficients
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T)
#: in the slow row what follows a coefficient below this share of the largest is rounding, which would grow by 5.8^n
ROUNDING = 1e-16


def _powers(slow: bool) -> np.ndarray:
    """[n, k]: coefficient of t^k in T_n(t), or in T_n(2 t - 1) = T_2n(sqrt t)."""
    found, step = np.zeros((TERMS, TERMS)), 2 if slow else 1
    for n in range(TERMS):
        found[n, : n + 1] = np.polynomial.chebyshev.cheb2poly(np.eye(step * n + 1)[step * n])[::step]
    return found


_POWERS, _SLOW_POWERS = _powers(False), _powers(True)


@kernel
def node(row, k):
    """t of node k."""
    return SLOW_NODES[k] if row == 0 else NODES[k]


@kernel
def fit(row, count, rounding, values, fitted, scratch):
    """Powers of the polynomial with these ``values`` at the nodes, of the first ``count`` Chebyshev coefficients.

    ``rounding``: of the values, over the largest coefficient.
    """
    for n in range(TERMS):
        scratch[n], fitted[n] = 0.0, 0.0
    for k in range(TERMS):
        for n in range(TERMS):
            scratch[n] += _TO_CHEBYSHEV[k, n] * values[k]
    least = 0.0
    if row == 0:
        for n in range(TERMS):
            least = max(least, rounding * abs(scratch[n]))
    powers = _SLOW_POWERS if row == 0 else _POWERS
    for n in range(count):
        if abs(scratch[n]) < least:
            break
        for k in range(TERMS):
            fitted[k] += powers[n, k] * scratch[n]


@kernel
def fit_slopes(row, values, slopes, fitted, scratch):
    """Powers of the polynomial with these ``slopes`` over t at the nodes, and in the mean these ``values``."""
    fit(row, TERMS - 1, ROUNDING, slopes, fitted, scratch)
    for k in range(TERMS - 1, 0, -1):
        fitted[k] = fitted[k - 1] / k
    fitted[0] = 0.0
    mean = 0.0
    for k in range(TERMS):
        t, total = node(row, k), 0.0
        for n in range(TERMS - 1, -1, -1):
            total = total * t + fitted[n]
        mean += values[k] - total
    fitted[0] = mean / TERMS
