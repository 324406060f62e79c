"""Nodes, weights and matrices of polynomial interpolation and quadrature, computed in 40 digits and
rounded once.

No library of linear algebra takes part: its last digits differ from machine to machine, and so
would all that is computed with them.  numpy's polynomials work on arrays of
:class:`decimal.Decimal` as they do on floats.

The polynomial through values at nodes is the sum of the values times Lagrange's polynomials, each
of which is 1 at one node and 0 at the others.  Its coefficients, values, slopes and integrals
therefore are matrices times the values.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from decimal import Context, Decimal, localcontext
from functools import wraps

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly
from numpy.polynomial.legendre import leg2poly
from numpy.polynomial.polynomial import polyder, polyfromroots, polyint, polyval
from numpy.typing import NDArray

#: Digits of the Decimals: without cancellation half of them would suffice.
_DIGITS = 40
#: Digits in the search for zeros, where polynomials of degree 36 lose fourteen to cancellation.
_DIGITS_OF_SEARCH = 60
#: Digits after the point to which zeros are rounded: further digits depend on how the machine
#: computes a cosine.
_DIGITS_OF_ZEROS = 36
#: Newton steps from a start with two correct digits: each doubles their number.
_NEWTON_STEPS = 5
_Floats = NDArray[np.float64]


def in_40_digits(function: Callable) -> Callable:
    """Decorate a function so that it computes with Decimals of 40 digits, whatever the decimal
    context of its caller.

    function : any function of positional arguments; it must finish its work, since a generator
        would run in the context of its caller.
    Returns the decorated function, which returns the same value, takes its arguments by position
    only, and leaves the context of the caller as it was.
    """

    @wraps(function)
    def precise(*arguments):
        with localcontext(Context(prec=_DIGITS)):
            return function(*arguments)

    return precise


class Interpolation:
    """Matrices from values at nodes to coefficients, values, slopes and integrals of the polynomial
    through them.

    Arguments are given by position only (:func:`in_40_digits`).

    Parameters
    ----------
    nodes : n distinct numbers, Decimals or integers.

    Attributes
    ----------
    exact : the nodes that were passed, a tuple of n.
    nodes : the nodes as doubles, (n,).
    """

    @in_40_digits
    def __init__(self, nodes: Sequence[Decimal | int]) -> None:
        """Compute the coefficients of Lagrange's polynomials of the nodes, with 40 digits.

        nodes : at least two distinct Decimals or integers; kept as ``exact`` and, rounded, as
        ``nodes``.
        Raises decimal.DivisionByZero where two nodes are equal, or decimal.InvalidOperation if 0 is
        a node besides.
        """
        self.exact = tuple(nodes)
        self.nodes = to_doubles(nodes)
        lagrange = []
        for i, node in enumerate(nodes):
            others = [*nodes[:i], *nodes[i + 1 :]]
            lagrange.append(polyfromroots(others) / math.prod(node - other for other in others))
        # [power, node]
        self._basis = np.array(lagrange).T

    def powers(self) -> _Floats:
        """Return the matrix from values at the nodes to the coefficients of the powers of x, the
        constant first: doubles, (n, n), [power, node].
        """
        return to_doubles(self._basis)

    @in_40_digits
    def values(self, points: Iterable[Decimal]) -> _Floats:
        """Return the matrix from values at the nodes to values at other points.

        points : m Decimals or integers, between the nodes or beyond them.
        Returns doubles, (m, n), [point, node].
        """
        return _values(self._basis, points)

    @in_40_digits
    def slopes(self, points: Iterable[Decimal]) -> _Floats:
        """Return the matrix from values at the nodes to slopes, derivatives with respect to x, at
        other points.

        points : m Decimals or integers, between the nodes or beyond them.
        Returns doubles, (m, n), [point, node].
        """
        return _values(polyder(self._basis), points)

    @in_40_digits
    def integrals(self, points: Iterable[Decimal]) -> _Floats:
        """Return the matrix from values at the nodes to integrals over x from -1 to other points,
        for any nodes.

        points : m Decimals or integers; below -1 the integral has the opposite sign.
        Returns doubles, (m, n), [point, node].
        """
        return _values(polyint(self._basis, lbnd=-1), points)

    @in_40_digits
    def coefficients(self, values: Sequence[Decimal]) -> _Floats:
        """Return the coefficients of the powers of x of the polynomial through given values, the
        constant first.

        values : values at the nodes, n Decimals or integers.
        Returns doubles, (n,).
        """
        return to_doubles(self._basis @ np.array(values))


@in_40_digits
def radau(n: int) -> list[Decimal]:
    """Return the nodes of Radau's rule on [-1, 1] with the end 1: n - 1 nodes inside, and 1.

    n : number of nodes, the end included, an int > 1, by position only.
    Returns n Decimals, ascending, rounded to 36 digits after the point.
    """
    # Legendre's P_(n-1) + P_n vanishes at the nodes of the rule with the end -1, and the starts are
    # near all of them but -1 itself.  With opposite signs they are the nodes of the rule with the
    # end 1.
    inner = _zeros(leg2poly(_unit_series(n - 1, 1, 1)), [(k - 0.25) / n for k in range(1, n)])
    return sorted([Decimal(1), *(-x for x in inner)])


@in_40_digits
def gauss(n: int) -> tuple[_Floats, _Floats]:
    """Return nodes and weights of the Gauss-Legendre rule on [0, 1].

    n : number of points, int, 1 to about 70, by position only: with more, cancellation takes more
        than the spare digits of 40 (1e-13 is lost at 80).
    Returns (nodes, ascending; weights in their order, which add up to 1), doubles, (n,) each.
    """
    legendre = leg2poly(_unit_series(n, 1))
    nodes = np.array(_zeros(legendre, [(k - 0.25) / (n + 0.5) for k in range(1, n + 1)]))
    # On [-1, 1] a weight is 2/((1 - x^2) P_n'(x)^2), on [0, 1] half of that.
    weights = 1 / ((1 - nodes * nodes) * polyval(nodes, polyder(legendre)) ** 2)
    return to_doubles((1 + nodes) / 2), to_doubles(weights)


@in_40_digits
def chebyshev(n: int) -> list[Decimal]:
    """Return the zeros of the Chebyshev polynomial T_n on [-1, 1].

    n : number of zeros, an int >= 1, by position only.
    Returns n Decimals, ascending, rounded to 36 digits after the point.
    """
    return _zeros(cheb2poly(_unit_series(n, 1)), [(k - 0.5) / n for k in range(1, n + 1)])


@in_40_digits
def to_chebyshev(n: int) -> _Floats:
    """Return the matrix from values at the zeros of T_n, ascending, to the coefficients of T_0 ...
    T_(n-1).

    It gives the series of the polynomial of degree n - 1 through the values.

    n : number of nodes and terms, an int > 1, by position only.
    Returns doubles, (n, n), [term, node], the term of T_0 first.
    """
    # At these nodes x_k the sum of f(x_k) T_m(x_k), times 2/n, is the coefficient of T_m; for m = 0
    # it is twice the coefficient.
    x = np.array(chebyshev(n))
    terms = [1 + 0 * x, x]
    for _ in range(n - 2):
        terms.append(2 * x * terms[-1] - terms[-2])
    terms[0] /= 2
    return to_doubles(2 * np.array(terms) / n)


def powers_of_chebyshev(n: int, shift: float, scale: float) -> _Floats:
    """Return the powers of t in shifted Chebyshev polynomials T_m(scale t - shift), m < n, computed
    in doubles.

    n : number of polynomials, > 1.
    shift, scale : floats, shift and scale of the argument, dimensionless.
    Returns (n, n), [m, k]: the coefficient of t^k in T_m(scale t - shift), 0 for k > m.
    """
    matrix = np.zeros((n, n))
    matrix[0, 0] = 1.0
    matrix[1, :2] = [-shift, scale]
    # T_m = 2 (scale t - shift) T_(m-1) - T_(m-2); t moves coefficients up by one power.  0.0 - 2.0
    # shift is 0.0 for a shift of 0, where -2.0 shift would be -0.0.
    for m in range(2, n):
        matrix[m] = (0.0 - 2.0 * shift) * matrix[m - 1] - matrix[m - 2]
        matrix[m, 1:] += 2.0 * scale * matrix[m - 1, :-1]
    return matrix


def to_doubles(values) -> _Floats:
    """Return Decimals as the nearest doubles, of the same shape, in C order: einsum's sums depend
    on the order.
    """
    return np.array(values, dtype=np.float64, order="C")


def _unit_series(degree: int, *last: int) -> list[Decimal]:
    """Return the coefficients of a Legendre or Chebyshev series: ``degree`` zeros, then the numbers
    given.

    With the arguments (n, 1) the series is the polynomial of degree n itself.

    degree : int, number of zeros, the coefficients of the polynomials of degree 0 ... degree - 1.
    last : integers, the coefficients of the polynomials of degree ``degree`` and above.
    Returns ``degree`` + len(last) Decimals, the coefficient of the polynomial of degree 0 first.
    """
    return [Decimal(c) for c in (*[0] * degree, *last)]


def _zeros(polynomial: NDArray, half_turns: Iterable[float]) -> list[Decimal]:
    """Return zeros of a polynomial by five steps of Newton's iteration with 60 digits.

    polynomial : coefficients of the powers of x, the constant first, Decimals.
    half_turns : for each zero an angle whose cosine is near it, to two digits, divided by pi.
    Returns one Decimal for each angle, in ascending order of the zeros, whatever the order of the
    angles, rounded to 36 digits after the point.  It is not checked that the iteration has
    converged.
    """
    # the cosine is only a start: its last digits, which may differ from machine to machine, have no
    # effect on the result
    x = np.array([Decimal(math.cos(math.pi * turn)) for turn in half_turns])
    slope = polyder(polynomial)
    with localcontext(Context(prec=_DIGITS_OF_SEARCH)):
        for _ in range(_NEWTON_STEPS):
            x = x - polyval(x, polynomial) / polyval(x, slope)
    return sorted(round(zero, _DIGITS_OF_ZEROS) + 0 for zero in x)  # + 0 turns -0 into 0


def _values(polynomials: NDArray, points: Iterable[Decimal]) -> _Floats:
    """Return values [point, polynomial] of polynomials whose coefficients are [power,
    polynomial].
    """
    return to_doubles(polyval(np.array([*points]), polynomials).T)
