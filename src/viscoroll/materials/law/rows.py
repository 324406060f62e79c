"""Polynomials of one variable over octaves: :class:`Rows`, which reads and fits them.

The variable is u = kappa |V|, v = 1/F(eta) or w = 1/z (:mod:`.fit`), dimensionless.  T_ref is the unit of time of the
material, in which its rates are given.

Slopes are fitted and integrated, and one constant is added: value, slope and secant of a polynomial are then all
accurate to rounding, where a polynomial fitted to values has lost three digits in its slopes.  Powers are computed from
the rapidly decreasing Chebyshev coefficients, which keeps rounding errors small.  No library of linear algebra is used:
its last digits differ from machine to machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...kernels.numerics.interpolation import chebyshev, powers_of_chebyshev, to_chebyshev, to_doubles

#: number of powers of a row, and of nodes of an octave; with 24 the law is accurate to rounding (tests/tables)
TERMS = 24
#: octaves from that of the slowest rate of creep down to the end of the first row: below it the law is one polynomial
_SLOW_OCTAVES = 5
#: Chebyshev coefficients of the first row below this fraction of the largest are rounding and are set to 0, as powers
#: would amplify coefficient n by 5.8^n; dimensionless
_ROUNDING = 1e-16
#: Chebyshev points of [-1, 1], the nodes of an octave
NODES = to_doubles(chebyshev(TERMS))
#: matrix from values at the nodes to Chebyshev coefficients
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T)
#: matrix from coefficients of T_n(t) to powers of t, t in [-1, 1]
_POWERS = powers_of_chebyshev(TERMS, 0.0, 1.0)
#: matrix from coefficients of T_n(2 t - 1) to powers of t, t in [0, 1], as the first row has them
_SLOW_POWERS = powers_of_chebyshev(TERMS, 1.0, 2.0)


@dataclass(frozen=True)
class Rows:
    """Octaves of a variable x >= 0 with a polynomial of 24 powers on each.

    Row 0 is the interval [0, 2^e0), with t = x 2^-e0 in [0, 1).  Row n > 0 is the octave [2^(e0+n-1), 2^(e0+n)), with t
    = 4 x 2^-(e0+n) - 3 in [-1, 1).

    e0 : exponent of the end of the first row, an integer of any sign.
    count : number of rows, row 0 included.
    """

    e0: int
    count: int

    @cached_property
    def t(self) -> Floats:
        """Nodes in the variable t of the polynomials, [row, node]."""
        nodes = np.tile(NODES, (self.count, 1))
        nodes[0] = 0.5 + 0.5 * NODES
        return nodes

    @cached_property
    def x(self) -> Floats:
        """Nodes in the variable x, [row, node]."""
        nodes = np.ldexp(0.25 * (self.t + 3.0), self.e0 + np.arange(self.count)[:, None])
        nodes[0] = np.ldexp(self.t[0], self.e0)
        return nodes

    @cached_property
    def dlnx_dt(self) -> Floats:
        """Derivative of ln x with respect to t at the nodes, [row, node]."""
        derivative = 1.0 / (self.t + 3.0)
        derivative[0] = 1.0 / self.t[0]
        return derivative

    def read(self, powers: Floats, x: Floats) -> tuple[Floats, Floats]:
        """Evaluate polynomials and their slopes, by Horner's scheme.

        powers: coefficients, (functions, rows, 24 powers).
        x: points, > 0 and below the end of the last row, (n,).  They are not checked: 0 is not found in row 0 if e0 <
            0, and a point beyond the last row raises IndexError.
        Returns (values; derivatives with respect to ln x, in the unit of the values), new arrays (functions, n) each,
        functions in the order of ``powers``.
        """
        mantissa, exponent = np.frexp(x)
        row = np.maximum(exponent - self.e0, 0)
        slow = row == 0
        t = np.where(slow, np.ldexp(x, -self.e0), 4.0 * mantissa - 3.0)
        by_power = np.take(np.ascontiguousarray(np.moveaxis(powers, -1, 0)), row, axis=-1)
        value, slope = by_power[TERMS - 1], np.zeros((len(powers), x.size))
        for k in range(TERMS - 2, -1, -1):
            slope *= t
            slope += value
            value *= t
            value += by_power[k]
        return value, slope * np.where(slow, t, t + 3.0)

    def fit(self, values: Floats, terms: int = TERMS, rounding: float = _ROUNDING) -> Floats:
        """Fit polynomials to values at the nodes: of each row the one of degree ``terms`` - 1.

        values: values of the functions at the nodes ``x``, (..., rows, 24 nodes); not changed.
        terms: number of Chebyshev coefficients to keep, 1 to 24; with 24 the polynomial goes through all values.
        rounding: fraction of the largest coefficient of a function in the first row; there the first coefficient that
            is smaller, and all after it, are set to 0.  Other rows keep all ``terms``.
        Returns coefficients of powers of t, (..., rows, 24 powers); from power ``terms`` on they are 0.
        """
        chebyshev_terms = _multiply(values, _TO_CHEBYSHEV)
        chebyshev_terms[..., terms:] = 0.0
        slow = chebyshev_terms[..., 0, :]
        small = np.abs(slow) < rounding * np.abs(slow).max(axis=-1, keepdims=True)
        slow[np.logical_or.accumulate(small, axis=-1)] = 0.0
        powers = _multiply(chebyshev_terms, _POWERS)
        powers[..., 0, :] = _multiply(slow, _SLOW_POWERS)
        return powers

    def fit_slopes(self, values: Floats, slopes: Floats) -> Floats:
        """Fit polynomials to slopes at the nodes, integrate them over t, and fit the constant to the values in the
        mean.

        values: values of the functions at the nodes ``x``, (..., rows, 24 nodes); not changed.
        slopes: derivatives of the values with respect to ln x, in the same shape; of these 23 Chebyshev coefficients
            are kept.
        Returns coefficients of powers of t, (..., rows, 24 powers).
        """
        derivative = self.fit(slopes * self.dlnx_dt, TERMS - 1)
        powers = np.zeros_like(derivative)
        powers[..., 1:] = derivative[..., :-1] / np.arange(1, TERMS)
        integral = np.zeros_like(values)
        for k in range(TERMS - 1, -1, -1):
            integral = integral * self.t + powers[..., k, None]
        # the differences are nearly equal: the mean of their deviations from the first keeps the last digits
        difference = values - integral
        first = difference[..., :1]
        powers[..., 0] = (first + _multiply(difference - first, np.full((TERMS, 1), 1.0 / TERMS)))[..., 0]
        return powers


def row_range(slowest: Any, fastest: Any) -> tuple[Any, Any]:
    """Return the range of the rows of a law, beyond whose last row its fast limit is accurate to rounding.

    slowest: slowest rate of creep b_1, > 0, in units of 1/T_ref; a number or an array.
    fastest: fastest rate of relaxation a_N, > 0, in units of 1/T_ref, in the same shape.
    Returns (e0, number of rows), integers in that shape.  For ``slowest`` in [2^(n-1), 2^n) and ``fastest`` in
    [2^(m-1), 2^m) the first row is the interval [0, 2^e0) with e0 = n - 5, and the last row ends at 2^(m+34).
    """
    from ...kernels.rows.z_grid import FAST_LIMIT_OCTAVES

    e0 = np.frexp(slowest)[1] - _SLOW_OCTAVES
    return e0, np.frexp(fastest)[1] + FAST_LIMIT_OCTAVES - e0 + 1


def _multiply(values: Floats, matrix: Floats) -> Floats:
    """Return ``values @ matrix``, summed in the order of the terms, so that every machine finds the same bits.

    values: factors on the left, (..., terms), at least one term.
    matrix: factors on the right, (terms, columns).
    Returns the products, a new array (..., columns).
    """
    product = values[..., :1] * matrix[0]
    for k in range(1, len(matrix)):
        product += values[..., k, None] * matrix[k]
    return product
