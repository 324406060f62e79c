"""Nodes, weights and matrices of polynomial interpolation and quadrature, in 40 digits and rounded once.

No library of linear algebra takes part: its last digits differ from machine to machine, and so
would all that is computed with them.  A polynomial through values at nodes is the sum of the
values times Lagrange's polynomials, each 1 at one node and 0 at the others; what is wanted of it
(coefficients, slopes, integrals) is a matrix on the values, from the coefficients of these.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from decimal import Context, Decimal, localcontext
from functools import wraps
from typing import Any

import numpy as np
from numpy.typing import NDArray

_DIGITS = 40
_Floats = NDArray[np.float64]


def in_40_digits(function: Callable) -> Callable:
    """``function`` with so many digits of its Decimals, whatever the caller's context."""

    @wraps(function)
    def precise(*arguments: Any) -> Any:
        with localcontext(Context(prec=_DIGITS)):
            return function(*arguments)

    return precise


class Interpolation:
    """Polynomials through values at ``nodes``, of which a matrix wants these in its columns."""

    @in_40_digits
    def __init__(self, nodes: Sequence[Decimal]) -> None:
        self.exact = tuple(nodes)
        self.nodes = to_doubles(nodes)
        self._basis = [_lagrange(self.exact, i) for i in range(len(self.exact))]

    @in_40_digits
    def powers(self) -> _Floats:
        """To the coefficients of the powers of x, the constant first."""
        return to_doubles([*zip(*self._basis)])

    @in_40_digits
    def values(self, points: Iterable[Decimal]) -> _Floats:
        """To the values at these points."""
        return _table(self._basis, points)

    @in_40_digits
    def slopes(self, points: Iterable[Decimal]) -> _Floats:
        """To the slopes at these points."""
        return _table([[k * c for k, c in enumerate(p)][1:] for p in self._basis], points)

    @in_40_digits
    def integrals(self, points: Iterable[Decimal]) -> _Floats:
        """To the integrals from -1 to these points."""
        whole = [[Decimal(0), *(c / (k + 1) for k, c in enumerate(p))] for p in self._basis]
        return _table([[-horner(p, Decimal(-1)), *p[1:]] for p in whole], points)

    @in_40_digits
    def coefficients(self, values: Sequence[Decimal]) -> _Floats:
        """Of the powers of x, for these values at the nodes."""
        return to_doubles([sum(v * c for v, c in zip(values, row)) for row in zip(*self._basis)])


@in_40_digits
def radau(n: int, side: int) -> list[Decimal]:
    """Nodes of Radau's rule on [-1, 1]: the end ``side`` (-1 or 1) and n - 1 inside, upward."""

    inner = [_zero(_jacobi, n, (k - 0.25) / n) for k in range(1, n)]
    return sorted([Decimal(side), *(-side * x for x in inner)])


@in_40_digits
def gauss(n: int) -> tuple[_Floats, _Floats]:
    """Nodes and weights of Gauss's and Legendre's rule on [0, 1]."""
    nodes = _symmetric(n, _legendre, [(k - 0.25) / (n + 0.5) for k in range(1, n // 2 + 1)])
    weights = [1 / ((1 - x * x) * _legendre(n, x)[1] ** 2) for x in nodes]
    return to_doubles([(1 + x) / 2 for x in nodes]), to_doubles(weights)


@in_40_digits
def chebyshev(n: int) -> list[Decimal]:
    """Zeros of T_n, upward."""
    return _symmetric(n, _chebyshev, [(k - 0.5) / n for k in range(1, n // 2 + 1)])


@in_40_digits
def to_chebyshev(n: int) -> _Floats:
    """From values at the zeros of T_n to the coefficients of T_0 ... T_(n-1)."""
    columns = []
    for x in chebyshev(n):
        values = [Decimal(1), x]
        for _ in range(n - 2):
            values.append(2 * x * values[-1] - values[-2])
        columns.append([values[0] / n, *(2 * value / n for value in values[1:n])])
    return to_doubles(columns).T.copy()


def powers_of_chebyshev(n: int, shift: float, scale: float) -> _Floats:
    """[m, k]: coefficient of t^k in T_m(scale t - shift), m < n."""
    found = np.zeros((n, n))
    found[0, 0], found[1, :2] = 1.0, [-shift, scale]
    for m in range(2, n):
        found[m] = (0.0 - 2.0 * shift) * found[m - 1] - found[m - 2]
        found[m, 1:] += 2.0 * scale * found[m - 1, :-1]
    return found


def to_doubles(values: Any) -> _Floats:
    """The nearest doubles."""
    return np.array(values, dtype=np.float64)


def _symmetric(n: int, family: Callable, turns: list[float]) -> list[Decimal]:
    """Zeros of an even or odd polynomial, from the cosines of the upper ones, in half turns."""
    upper = [_zero(family, n, turn) for turn in turns]
    return [*(-x for x in upper), *([Decimal(0)] if n % 2 else []), *reversed(upper)]


def _zero(family: Callable, n: int, turn: float) -> Decimal:
    """By Newton's iteration, first in double precision; ``family`` gives value and slope."""
    x: Any = math.cos(turn * math.pi)
    for kind in (float, float, float, Decimal, Decimal):
        value, slope = family(n, kind(x))
        x = kind(x) - value / slope
    return round(x, _DIGITS - 4)  # the last digits would tell how this machine takes a cosine


def _legendre(n: int, x: Any) -> tuple[Any, Any]:
    """P_n and its slope inside (-1, 1)."""
    before, value = 0 * x, 1 + 0 * x
    for k in range(n):
        before, value = value, ((2 * k + 1) * x * value - k * before) / (k + 1)
    return value, n * (before - x * value) / (1 - x * x)


def _jacobi(n: int, x: Any) -> tuple[Any, Any]:
    """P_(n-1) + P_n and its slope."""
    (before, rise), (value, slope) = _legendre(n - 1, x), _legendre(n, x)
    return before + value, rise + slope


def _chebyshev(n: int, x: Any) -> tuple[Any, Any]:
    """T_n and its slope inside (-1, 1)."""
    before, value = x, 1 + 0 * x
    for _ in range(n):
        before, value = value, 2 * x * value - before
    return value, n * (before - x * value) / (1 - x * x)


def _lagrange(nodes: Sequence[Decimal], i: int) -> list[Decimal]:
    """Coefficients of the polynomial that is 1 at node ``i`` and 0 at the others."""
    product, scale = [Decimal(1)], Decimal(1)
    for node in (*nodes[:i], *nodes[i + 1 :]):
        product = [a - node * b for a, b in zip([Decimal(0), *product], [*product, Decimal(0)])]
        scale *= nodes[i] - node
    return [c / scale for c in product]


def horner(polynomial: Sequence[Decimal], x: Decimal) -> Decimal:
    """The polynomial with these coefficients, the constant first."""
    total = Decimal(0)
    for c in reversed(polynomial):
        total = c + x * total
    return total


def _table(polynomials: Sequence[Sequence[Decimal]], points: Iterable[Decimal]) -> _Floats:
    """Values [point, polynomial]."""
    return to_doubles([[horner(p, x) for p in polynomials] for x in points])
