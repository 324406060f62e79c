"""Piecewise polynomials of one variable, one for each octave: fit, integral, value, inverse."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.array_types import Floats
from ..kernels.numerics.interpolation import Interpolation, chebyshev, powers_of_chebyshev, to_chebyshev
from ..kernels.rows.simd_polynomial import TERMS

#: limit of Newton's iteration for the inverse function
_MAX_ITERATIONS = 20
#: relative step after which the iteration ends: the error that remains is about its square
_CONVERGED = 1e-8


class Nodes:
    """Chebyshev nodes in [-1, 1], and linear maps of the values of functions there, along the last axis.

    An integral is fitted through its values; this drops its highest Chebyshev term, which the values do not determine.

    count : number of nodes.
    t : the nodes, ascending, (count,).
    """

    def __init__(self, count: int) -> None:
        rule = Interpolation(chebyshev(count))
        self.t = rule.nodes
        self._integrals = rule.integrals([*rule.exact, 1])
        self._chebyshev, self._powers = to_chebyshev(count), powers_of_chebyshev(count, 0.0, 1.0).T.copy()

    def powers(self, values: Floats) -> Floats:
        """Return the coefficients of the powers of t in [-1, 1] of the polynomials through values at the nodes.

        They are computed by way of Chebyshev coefficients, which limits the rounding errors.

        values : values at the nodes, (..., nodes).
        Returns the coefficients, ascending, (..., nodes).
        """
        return _multiply(self._powers, _multiply(self._chebyshev, values))

    def integrals(self, slopes: Floats, half: Any, start: Any = 0.0) -> Floats:
        """Return the integral of a piecewise polynomial at the nodes, continuous over all rows.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, a number, (rows,) or (..., rows).
        start : value of the integral at the left end of the first row, a number.
        Returns the integral from that end to each node plus ``start``, in the shape of ``slopes``.
        """
        whole = _multiply(self._integrals, slopes) * np.asarray(half)[..., None]
        rises = np.cumsum(whole[..., -1], axis=-1) - whole[..., -1]
        return whole[..., :-1] + (start + rises)[..., None]

    def end(self, slopes: Floats, half: Any) -> Floats:
        """Return the integral over all rows together.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, (rows,) or (..., rows).
        Returns one integral for each function, (...), a number for slopes of shape (rows, nodes).
        """
        return (_multiply(self._integrals[-1:], slopes)[..., 0] * half).sum(axis=-1)


def _multiply(matrix: Floats, values: Floats) -> Floats:
    """Return the products of a matrix with vectors along the last axis.

    BLAS is not used, as its last bits differ between machines.

    matrix : (m, n).
    values : vectors, (..., n).
    Returns the products, (..., m).
    """
    return np.einsum("...n,mn->...m", values, matrix)


NODES = Nodes(TERMS)


class Rows:
    """Consecutive intervals of one variable, the rows, with a polynomial in each.

    edges : ends of the rows, ascending, (rows + 1,).
    half : half the length of each row, (rows,).
    x : interpolation nodes of all rows, (rows, nodes).
    """

    def __init__(self, edges: Floats) -> None:
        self.edges, self.half = edges, 0.5 * np.diff(edges)
        self.x = self.node_positions(NODES)

    def node_positions(self, nodes: Nodes) -> Floats:
        """Return interpolation nodes of all rows, (rows, nodes), ascending; nodes: :class:`Nodes` in [-1, 1]."""
        return self.edges[:-1, None] + self.half[:, None] * (1.0 + nodes.t)

    def value(self, powers: Floats, x: Floats) -> Floats:
        """Evaluate a piecewise polynomial.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers).
        x : arguments, an array of any shape; beyond the ends the polynomial of the first or last row is continued, and
        an inner edge belongs to the row on its right.
        Returns the values, of the shape of x.
        """
        row = np.searchsorted(self.edges[1:-1], x, side="right")
        t, total = (x - self.edges[row]) / self.half[row] - 1.0, np.zeros(x.shape)
        for k in range(powers.shape[1] - 1, -1, -1):
            total = total * t + powers[row, k]
        return total

    def inverse(self, powers: Floats, target: Floats) -> Floats:
        """Return the arguments at which an increasing piecewise polynomial takes given values, by Newton's iteration.

        It ends when all relative steps are at most :data:`_CONVERGED`, or after :data:`_MAX_ITERATIONS` steps without
        an error.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers); its values are > 0.
        target : values, > 0, of any shape.
        Returns the arguments, of the shape of ``target``; the upper end of the last row for values beyond it; for
        values below those of the first row, those of its polynomial continued.
        """
        slopes = powers[:, 1:] * np.arange(1, powers.shape[1]) / self.half[:, None]
        x = np.interp(np.log(target), np.log(self.value(powers, self.x).ravel()), self.x.ravel())
        for _ in range(_MAX_ITERATIONS):
            change = (self.value(powers, x) - target) / self.value(slopes, x)
            x = np.minimum(x - change, self.edges[-1])
            if (np.abs(change) <= _CONVERGED * np.abs(x)).all():
                break
        return x


def octaves(low: int, high: int) -> Rows:
    """Return the :class:`Rows` of the high - low octaves from 2^low to 2^high; low, high: ints, low < high."""
    return Rows(np.ldexp(1.0, np.arange(low, high + 1)))
