"""Values of the law by the modes of a material, and rows of polynomials that are fitted to values.

Polynomials of one variable over octaves: :class:`Rows`, which reads and fits them.

The variable is u = kappa |V|, v = 1/F(eta) or w = 1/z (:mod:`.law_table`), dimensionless.  T_ref is
the unit of time of the material, in which its rates are given.

Slopes are fitted and integrated, and one constant is added: value, slope and secant of a polynomial
are then all accurate to rounding, where a polynomial fitted to values has lost three digits in its
slopes.  Powers are computed from the rapidly decreasing Chebyshev coefficients, which keeps
rounding errors small.  No library of linear algebra is used: its last digits differ from machine to
machine.

Values of the law by its modes, without a table: from these all rows are made.

T_ref is the unit of time of a material, in which its rates and times are given; for a material that
is given by alpha alone it is T_epsilon.  z is half the transit time of the contact in units of
T_ref (zeta of the paper).  The functions g(z) and h(z) of the material
(:mod:`.material_series`) give the shift of the contact over half its length, g/z, and the
contact length over that at rest, (1 + 2 h/z)^(-1/2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core.checks import Floats
from ..core.errors import ParameterError
from ..kernels.numerics.interpolation import (
    chebyshev,
    powers_of_chebyshev,
    to_chebyshev,
    to_doubles,
)
from ..materials.bodies import Bodies
from ..materials.prony import Prony
from ..materials.prony_forms import Modes

# --- Polynomials of one variable over octaves ---

#: number of powers of a row, and of nodes of an octave; with 24 the law is accurate to rounding
#: (tests/tables)
TERMS = 24
#: octaves from that of the slowest rate of creep down to the end of the first row: below it the law
#: is one polynomial
_SLOW_OCTAVES = 5
#: Chebyshev coefficients of the first row below this fraction of the largest are rounding and are
#: set to 0, as powers would amplify coefficient n by 5.8^n; dimensionless
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

    Row 0 is the interval [0, 2^e0), with t = x 2^-e0 in [0, 1).  Row n > 0 is the octave
    [2^(e0+n-1), 2^(e0+n)), with t
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
        x: points, > 0 and below the end of the last row, (n,).  They are not checked: 0 is not
            found in row 0 if e0 < 0, and a point beyond the last row raises IndexError.
        Returns (values; derivatives with respect to ln x, in the unit of the values), new arrays
        (functions, n) each, functions in the order of ``powers``.
        """
        mantissa, exponent = np.frexp(x)
        row = np.maximum(exponent - self.e0, 0)
        slow = row == 0
        t = np.where(slow, np.ldexp(x, -self.e0), 4.0 * mantissa - 3.0)
        by_power = np.take(np.ascontiguousarray(np.moveaxis(powers, -1, 0)), row, axis=-1)
        value = by_power[TERMS - 1]
        slope = np.zeros((len(powers), x.size))
        for k in range(TERMS - 2, -1, -1):
            slope *= t
            slope += value
            value *= t
            value += by_power[k]
        return value, slope * np.where(slow, t, t + 3.0)

    def fit(self, values: Floats, terms: int = TERMS, rounding: float = _ROUNDING) -> Floats:
        """Fit polynomials to values at the nodes: of each row the one of degree ``terms`` - 1.

        values: values of the functions at the nodes ``x``, (..., rows, 24 nodes); not changed.
        terms: number of Chebyshev coefficients to keep, 1 to 24; with 24 the polynomial goes
        through all values.
        rounding: fraction of the largest coefficient of a function in the first row; there the
            first coefficient that is smaller, and all after it, are set to 0.  Other rows keep all
            ``terms``.
        Returns coefficients of powers of t, (..., rows, 24 powers); from power ``terms`` on they
        are 0.
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
        """Fit polynomials to slopes at the nodes, integrate them over t, and fit the constant to
        the values in the mean.

        values: values of the functions at the nodes ``x``, (..., rows, 24 nodes); not changed.
        slopes: derivatives of the values with respect to ln x, in the same shape; of these 23
            Chebyshev coefficients are kept.
        Returns coefficients of powers of t, (..., rows, 24 powers).
        """
        derivative = self.fit(slopes * self.dlnx_dt, TERMS - 1)
        powers = np.zeros_like(derivative)
        powers[..., 1:] = derivative[..., :-1] / np.arange(1, TERMS)
        integral = np.zeros_like(values)
        for k in range(TERMS - 1, -1, -1):
            integral = integral * self.t + powers[..., k, None]
        # the differences are nearly equal: the mean of their deviations from the first keeps the
        # last digits
        difference = values - integral
        first = difference[..., :1]
        powers[..., 0] = (first + _multiply(difference - first, np.full((TERMS, 1), 1.0 / TERMS)))[
            ..., 0
        ]
        return powers


def row_range(slowest: Any, fastest: Any) -> tuple[Any, Any]:
    """Return the range of the rows of a law, beyond whose last row its fast limit is accurate to
    rounding.

    slowest: slowest rate of creep b_1, > 0, in units of 1/T_ref; a number or an array.
    fastest: fastest rate of relaxation a_N, > 0, in units of 1/T_ref, in the same shape.
    Returns (e0, number of rows), integers in that shape.  For ``slowest`` in [2^(n-1), 2^n) and
    ``fastest`` in [2^(m-1), 2^m) the first row is the interval [0, 2^e0) with e0 = n - 5, and the
    last row ends at 2^(m+34).
    """
    from ..kernels.law.z_grid import FAST_LIMIT_OCTAVES

    e0 = np.frexp(slowest)[1] - _SLOW_OCTAVES
    return e0, np.frexp(fastest)[1] + FAST_LIMIT_OCTAVES - e0 + 1


def _multiply(values: Floats, matrix: Floats) -> Floats:
    """Return ``values @ matrix``, summed in the order of the terms, so that every machine finds the
    same bits.

    values: factors on the left, (..., terms), at least one term.
    matrix: factors on the right, (terms, columns).
    Returns the products, a new array (..., columns).
    """
    product = values[..., :1] * matrix[0]
    for k in range(1, len(matrix)):
        product += values[..., k, None] * matrix[k]
    return product


# --- Values of the law by its modes, without a table ---

#: longest time, in units of T_ref, and inverse of the shortest one; beyond it numbers of rows
#: overflow or vanish
_LONGEST = 1e100


def refuse_distant_times(slowest: float, fastest: float) -> None:
    """Raise ParameterError for times that rows cannot hold: shorter than 1e-100 T_ref or longer
    than 1e100 T_ref.

    slowest: slowest rate of creep b_1, > 0, in units of 1/T_ref.
    fastest: fastest rate of relaxation a_N, >= ``slowest``, in units of 1/T_ref; a smaller one and
        NaN are refused too.
    Returns None for other times.
    """
    if not 1.0 / _LONGEST <= slowest <= fastest <= _LONGEST:
        allowed = f"within {1.0 / _LONGEST:g} to {_LONGEST:g} times T_ref"
        raise ParameterError("times", f"{1.0 / fastest:g} to {1.0 / slowest:g}", allowed)


def modes_record(modes: Modes, weights: Floats | None = None) -> Any:
    """Return the record of a series that kernels read (:class:`.material_series.Series`).

    modes: :class:`.prony_forms.Modes`, strengths and rates of relaxation and of creep of one
        series, or of many along leading axes.
    weights: part of each creep mode that is the half-space's, 0 to 1, (..., modes), for two bodies
        that differ; None: they are alike, and the record has an empty array of weights.
    Returns a Series (a, b, e, t, weights, Q): rates a and b in units of 1/T_ref, ascending, those
    of ``modes`` themselves; vectors e = sqrt(E_i/a_i) and t = sqrt(J_j/b_j), in T_ref^(1/2), (...,
    modes) each; ``weights``; and the dimensionless matrix Q = sqrt(J_j b_j E_i a_i)/(a_i - b_j),
    (..., modes, modes), [..., j, i].  All are empty along these axes for an elastic material.
    """
    from ..kernels.law.material_series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e = np.sqrt(modes.E / modes.a)
    t = np.sqrt(modes.J / modes.b)
    return Series(
        a=modes.a,
        b=modes.b,
        e=e,
        t=t,
        weights=np.empty(0) if weights is None else weights,
        Q=np.sqrt(strengths) / modes.gap,
    )


def series_record(material: Any) -> tuple[Any, Floats]:
    """Return the arguments of the kernel that evaluates a law by its modes, for use by one thread.

    material: a :class:`.prony.Prony` of one material, a :class:`.bodies.Bodies` of one pair, or
        alphas >= 1: a number, or one for each element that the kernel is called for, (n,).
    Returns (record of the series, :class:`.material_series.Series`, as in
    :func:`modes_record`; alphas).  For a series or bodies the alphas are an empty array; those of
    bodies have weights, also if they are alike.  For alphas they are a copy, (n,), (1,) of a
    number, and the record has one mode, which the kernel overwrites with each alpha in turn.
    """
    from ..kernels.law.material_series import Series

    if isinstance(material, Bodies):
        # the kernel writes into the record, and the weights of a pair are read only
        return modes_record(material.total.modes, material.half_space_weights.copy()), np.empty(0)
    if isinstance(material, Prony):
        return modes_record(material.modes), np.empty(0)
    one = Series(
        a=np.ones(1),
        b=np.ones(1),
        e=np.ones(1),
        t=np.ones(1),
        weights=np.empty(0),
        Q=np.ones((1, 1)),
    )
    return one, np.array(material, dtype=np.float64).reshape(-1)


class ModesValues(NamedTuple):
    """Functions of z = zeta from which rows are made, dimensionless, T_ref being the unit of time.

    values : g/z, h/z, and M/V of half-space and cylinder (in units of P T_ref), (4, n).
    slopes : their derivatives with respect to ln(1/z), (4, n).
    N : factor of dV/dt in M = M(V) + N dV/dt, in units of P T_ref^2, (n,).
    """

    values: Floats
    slopes: Floats
    N: Floats


def evaluate_by_modes(material: Any, z: Floats) -> ModesValues:
    """Evaluate the law by the formulas of its modes.

    material: a :class:`.prony.Prony` of one material, a :class:`.bodies.Bodies` of one pair, or
        alphas >= 1: a number, or one for each z, (n,).
    z: half contact length divided by V T_ref, zeta of the paper, > 0, (n,); infinite for the limit
        at rest.
    Returns :class:`ModesValues`: ``values``, g/z, h/z, and M/V of half-space and cylinder, (4, n);
    ``slopes``, their derivatives with respect to ln(1/z), (4, n); ``N`` of M = M(V) + N dV/dt,
    (n,); dimensionless, M/V in units of P T_ref, N of P T_ref^2.  Where z is infinite, values and N
    are the limits at rest and slopes are NaN.  Of elastic bodies all are 0 (alpha = 1 has slopes
    NaN at infinite z too).
    """
    from ..kernels.law.material_series import FUNCTIONS, new_workspace
    from ..kernels.law.modes import modes_loop

    series, alpha = series_record(material)
    values = np.zeros((2 * FUNCTIONS + 1, z.size))
    z = z.view()
    z.flags.writeable = False  # kernels are compiled for arguments that are read only
    if series.a.size:
        modes_loop(series, alpha, new_workspace(series.a.size), z, values)
    return ModesValues(values[:FUNCTIONS], values[FUNCTIONS:-1], values[-1])
