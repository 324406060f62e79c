"""Values of the law by the modes of a material, and rows of polynomials that are fitted to values.

**Rows** are polynomials of one variable over octaves, which :class:`Rows` reads and fits.  The
variable is u = kappa |V|, v = 1/F(eta) or w = 1/z (:mod:`.law_tables`), dimensionless.

Slopes are fitted and integrated, and one constant is added: value, slope and secant of a polynomial
are then all accurate to rounding, where a polynomial fitted to values has lost three digits in its
slopes.  Powers are computed from the rapidly decreasing Chebyshev coefficients, which keeps
rounding errors small.  No library of linear algebra is used: its last digits differ from machine to
machine.

**Values** by the modes of a material, without a table (:func:`evaluate_by_modes`): from these all
rows are made.  T_ref is the unit of time of the material, in which its rates and times are given;
for a material that is given by alpha alone it is T_epsilon.  z is half the transit time of the
contact in units of T_ref (zeta of the paper).  The functions g(z) and h(z) of the material
(:mod:`.material_series`) give the shift of the contact over half its length, g/z, and the contact
length over that at rest, (1 + 2 h/z)^(-1/2).

**Nodes** of the law of one scene over speed and creep, of a table of the coupled solution or of a
grid: :class:`CoupledRows`, with the vector of splines that kernels read (:mod:`.coupled_splines`).
"""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats, described_error
from ..kernels.numerics.interpolation import (
    chebyshev,
    powers_of_chebyshev,
    to_chebyshev,
    to_doubles,
)
from ..materials import COUPLED, KINDS, Bodies, Modes, Prony, lock_array, series_of_alpha

# --- Polynomials of one variable over octaves ---

#: number of powers of a row, and of nodes of an octave; with 24 the law is accurate to rounding
#: (tests/tables)
TERMS = 24
#: those of what shear does on covers (``SHORT_TERMS`` of :mod:`..kernels.numerics.simd`)
SHORT_TERMS = 16
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

    @property
    def last(self) -> float:
        """Largest double within the rows, beyond which they cannot be read."""
        return math.nextafter(math.ldexp(1.0, self.e0 + self.count - 1), 0.0)

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
        # x = mantissa 2^exponent, mantissa in [1/2, 1): an octave is one exponent
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
        # dt/d ln x = x dt/dx, which is t in the first row and t + 3 in an octave
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

    def fit_slopes(self, values: Floats, slopes: Floats, *, terms: int = TERMS) -> Floats:
        """Fit polynomials to slopes at the nodes, integrate them over t, and fit the constant to
        the values in the mean.

        values: values of the functions at the nodes ``x``, (..., rows, 24 nodes); not changed.
        slopes: derivatives of the values with respect to ln x, in the same shape; of these
            ``terms`` - 1 Chebyshev coefficients are kept.
        terms: number of coefficients, 2 to 24.
        Returns coefficients of powers of t, (..., rows, 24 powers); from power ``terms`` on they
        are 0.
        """
        # one term less: integration gives it back
        derivative = self.fit(slopes * self.dlnx_dt, terms - 1)
        powers = np.zeros_like(derivative)
        powers[..., 1:] = derivative[..., :-1] / np.arange(1, TERMS)
        # values at the nodes of the integral without its constant
        by_power = np.moveaxis(powers, -1, 0)[..., None]
        integral = np.polynomial.polynomial.polyval(self.t, by_power, tensor=False)
        # the differences are nearly equal: the mean of their deviations from the first keeps the
        # last digits
        difference = values - integral
        first = difference[..., :1]
        powers[..., 0] = (first + _multiply(difference - first, np.full((TERMS, 1), 1.0 / TERMS)))[
            ..., 0
        ]
        return powers


def e0_and_row_count(slowest: Any, fastest: Any) -> tuple[Any, Any]:
    """Return where the rows of a law begin and how many there are, so that beyond the last one the
    fast limit is accurate to rounding.

    They are rows of u = kappa |V|, and of v = 1/F(eta) too.

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


# --- Rows from values at nodes of the speed ---

#: nodes an octave of u at which a cover is solved; with 12 and the neighbours below rows agree with
#: the solve to 1e-11
PER_OCTAVE = 12
#: nodes on either side of an octave that take part in its polynomial; with 18 it is accurate to
#: rounding
_ASIDE = 18
#: imaginary step for derivatives, relative or of log2 u; its square is far below rounding,
#: dimensionless
_TINY = 1e-30


#: (quantities of a cover, degree of their polynomials at either end of the speeds): lam to the
#: moments; and those by shear, with terms in ln u at low speed for nu < 1/2, from the memory of the
#: pressure near the edges: where the first octave begins they jump by 4e-12 of 2 kappa
#: delta_star/mu, with 12 by 4e-10, and their slopes by 1e-6, with 18 by 1e-4 for the noise of the
#: solve
_DEGREES = (slice(0, 5), 12), (slice(5, None), 14)


def fit_end(
    y: Floats, values: Floats, limits: Floats, wanted: Floats, log_terms: int = 0
) -> tuple[Floats, Floats, Floats]:
    """Fit values = limit + y (P(y) + R(y) ln y) with polynomials P and R, by least squares, at one
    end of the speeds.

    y: nodes, proportional to u at the slow end and to 1/u at the fast end, in [0.05, 1], (n,).
    values: quantities of a cover (:mod:`.cover_rows`) at the nodes (at the fast end M/(V y)), (k,
        n), k = 11.
    limits: values for y -> 0, (k,); for NaN the value at 0 of a polynomial through the values is
        taken.
    wanted: points in (0, 1], (m,), m >= 1.
    log_terms: number of terms of R; 0: none.
    Returns (limits, (k,), with the values at 0 in place of NaN; P + R ln y at the last of the
    points, (k,); values and derivatives with respect to ln y at the points, (2, k, m)).
    """

    def basis(y: Any, degree: int, log_terms: int) -> Any:
        """Return the terms at points ``y``, (points,), real or complex, (points, terms): Chebyshev
        polynomials of 2 y - 1 up to ``degree``, then the first ``log_terms`` of them times ln y.
        """
        terms = np.polynomial.chebyshev.chebvander(2.0 * y - 1.0, degree)
        return np.hstack([terms, np.log(y)[:, None] * terms[:, :log_terms]])

    def fit(values: Floats, at: Any, log_terms: int) -> Any:
        """Fit each quantity by least squares, and return the fits at other points.

        values: quantities at the nodes y, (k, n).
        at: points, (points,); complex ones give derivatives.
        log_terms: number of terms times ln y, as in :func:`basis`.
        Returns (k, points), complex where ``at`` is.
        """
        found = []
        for some, n in _DEGREES:
            factors = np.linalg.lstsq(basis(y, n, log_terms), values[some].T, rcond=None)[0]
            found.append((basis(at, n, log_terms) @ factors).T)
        return np.concatenate(found)

    # 1e-30 in place of 0, whose logarithm :func:`basis` takes also where no term has it
    limits = np.where(np.isnan(limits), fit(values, np.array([_TINY]), 0)[:, 0], limits)[:, None]
    # slopes by a step in the imaginary direction, which cancels no digits
    P = fit((values - limits) / y, wanted * (1.0 + 1j * _TINY), log_terms)
    value = P.real
    slope = P.imag / _TINY
    return limits[:, 0], value[:, -1], np.stack([wanted * value + limits, wanted * (value + slope)])


def interpolate_octaves(values: Floats, begin: int, count: int) -> Floats:
    """Interpolate from the nodes of the solve to those of octaves, by polynomials through 49 nodes,
    barycentric.

    values: the quantities at the nodes of the solve, which are evenly spaced in log2 u, 12 an
        octave, (k, n).
    begin: index of the node where the first octave begins, at least 18; 18 nodes before each octave
        and 18 after it are used.
    count: number of octaves.
    Returns values and slopes over ln u at the 24 nodes of each octave, (2, k, octaves, 24).
    """
    points = PER_OCTAVE + 2 * _ASIDE + 1
    nodes = (np.arange(points) - _ASIDE) / PER_OCTAVE
    # barycentric weights of equidistant nodes
    weights = np.array([(-1.0) ** k * math.comb(points - 1, k) for k in range(points)])
    # slopes by a step in the imaginary direction, which cancels no digits
    # the node t of an octave lies at log2((t + 3)/2) octaves from its begin
    terms = weights[:, None] / (np.log2(0.5 * (NODES + 3.0)) + 1j * _TINY - nodes[:, None])
    basis = terms / terms.sum(axis=0)
    windows = np.lib.stride_tricks.sliding_window_view(values, points, axis=1)
    around = windows[:, begin - _ASIDE + PER_OCTAVE * np.arange(count)]
    return np.stack([around @ basis.real, around @ basis.imag / (_TINY * math.log(2.0))])


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
        raise described_error(
            "times of relaxation and creep",
            f"range from {1.0 / fastest:g} to {1.0 / slowest:g} times T_ref",
            f"within {1.0 / _LONGEST:g} to {_LONGEST:g} times T_ref",
        )


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

    # [..., j, i]: creep modes by relaxation modes, as modes.gap, which is a_i - b_j
    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    return Series(
        a=modes.a,
        b=modes.b,
        e=np.sqrt(modes.E / modes.a),
        t=np.sqrt(modes.J / modes.b),
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
    if isinstance(material, Bodies):
        # the kernel writes into the record, and the weights of a pair are read only
        return modes_record(material.total.modes, material.half_space_weights.copy()), np.empty(0)
    if isinstance(material, Prony):
        return modes_record(material.modes), np.empty(0)
    # any series of one mode
    return modes_record(series_of_alpha(2.0).modes), np.array(material, dtype=float).reshape(-1)


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
    if series.a.size:
        # kernels are compiled for arguments that are read only
        modes_loop(series, alpha, new_workspace(series.a.size), lock_array(z.view()), values)
    return ModesValues(values[:FUNCTIONS], values[FUNCTIONS:-1], values[-1])


# --- Nodes of the coupled law of one scene, and the splines that kernels read of them ---

#: fields in the order of :attr:`CoupledRows.fields`: Q_over_mu, M_half_space, M_cylinder, lam,
#: epsilon, beta, work_half_space, work_cylinder
FIELDS = tuple(KINDS[COUPLED].functions)


@dataclass(frozen=True, eq=False)
class CoupledRows:
    """The law of one scene at one coefficient of friction, at nodes; arrays are read only, all is
    dimensionless.

    mu : coefficient of friction.
    u : nodes of kappa |V|, (n,), > 0, ascending.
    t : nodes of the coordinate t of the creepage, (m,): -1 at the negative onset of full slip, 0 in
    the middle, which is a node where ``graded``, 1 at the positive onset.
    edges : 2 kappa times the creepages that divide the states of a speed: the middle, both onsets
        of full slip and free rolling, (n + 2, 4): first for u = 0, last for u infinite.
    fields : :data:`FIELDS`, (n + 2, m, 8): M times kappa; work is 2 kappa times that of shear on
    the strain of a body.
    graded : whether the creepage at t lies at the part w = grade(t) of the distance from the middle
    to the onset on its side, and splines over t are clamped at 0 and +-1; else w = |t|.
    fastest : largest u that is allowed; 1e300 where the last row is the limit of u infinite.
    slips : whether the contact slips fully beyond the onsets; False: nothing is known there.
    limit : largest abs(Q/mu): 1, or infinite where it is not known.
    errors : field -> largest error found beside the nodes, absolute.
    """

    mu: float
    u: Floats
    t: Floats
    edges: Floats
    fields: Floats
    graded: bool = True
    fastest: float = 1e300
    slips: bool = True
    limit: float = 1.0
    errors: dict[str, float] = field(default_factory=dict)

    @cached_property
    def vector(self) -> Floats:
        """The splines over speed and creep as one vector, which kernels read: (k,), float64,
        read-only, dimensionless.

        It has a head, ln u, t, the edges with their slopes over ln u, and of each field at each
        node the value, both slopes and the mixed derivative (:mod:`.coupled_splines`).  Of a graded
        table the slip loss (:meth:`_friction`) is a further field.
        """
        from ..kernels.law import coupled_splines as layout

        ln_u = np.log(self.u)
        fields = self.fields
        if self.graded:
            fields = np.concatenate([fields, self._friction()[..., None]], axis=-1)
        slopes_in_t = self._slopes_in_t(fields)
        # in the order of a JET of the layout: value, slopes over ln u and over t, mixed derivative
        jets = [fields, self._slopes_in_u(fields), slopes_in_t, self._slopes_in_u(slopes_in_t)]
        edges = np.stack([self.edges, self._slopes_in_u(self.edges)], axis=-1)
        # in the order of the indices of the layout
        head = [
            self.u.size + 2,  # ROWS
            self.t.size,  # NODES
            self.graded,  # GRADED
            self.u[0],  # FIRST
            self.u[-1],  # LAST
            *_equal_step(ln_u),  # U_STEP
            *_equal_step(self.t),  # T_STEP
            # T_BEGIN, EDGES, FIELDS
            *(layout.HEAD + np.cumsum([ln_u.size, self.t.size, edges.size])),
            fields.shape[-1],  # FIELD_COUNT
            self.fastest,  # MOST
            self.slips,  # SLIPS
            self.limit,  # LIMIT
        ]
        # (fields, n + 2, m, 4), field by field: a kernel reads all nodes of one field
        planes = np.moveaxis(np.stack(jets, axis=-1), 2, 0)
        return lock_array(np.concatenate([head, ln_u, self.t, edges.ravel(), planes.ravel()]))

    def _slopes_in_u(self, values: Floats) -> Floats:
        """Return slopes over ln u, by cubic splines that join the limits smoothly where the nodes
        are graded.

        values: values in the limit u = 0, at the nodes, and in the limit u -> infinity, (n + 2,
            ...).
        Returns the slopes in the shape of ``values``, 0 in both limits; of graded nodes the slope
        at an end node is the difference of its value from that of the limit beside it.
        """
        from scipy import interpolate

        # 1: a condition on the first derivative; from an end node to its limit fields are linear in
        # u or 1/u, and the slope over ln u at the node is this difference
        ends = (1, values[1] - values[0]), (1, values[-1] - values[-2])
        ln_u = np.log(self.u)
        nodes = values[1:-1]
        slopes = np.zeros_like(values)
        slopes[1:-1] = (
            interpolate.CubicSpline(ln_u, nodes, bc_type=ends)(ln_u, 1)
            if self.graded
            else _slopes(ln_u, nodes)
        )
        return slopes

    def _friction(self) -> Floats:
        """Return 2 kappa times the slip loss at the nodes, divided by P V, (n + 2, m), >= 0.

        It is mu (Q/mu) times the reduced creepage, less the work of shear on the strains.
        """
        middle, low, high = (edge[:, None] for edge in self.edges[:, :3].T)
        # the creepage at t: the middle plus w(t) times the distance to the onset on its side
        creep = middle + np.where(self.t < 0.0, low - middle, high - middle) * grade(self.t)
        # work_half_space and work_cylinder of FIELDS
        work = self.fields[..., 6] + self.fields[..., 7]
        return np.maximum(self.mu * self.fields[..., 0] * creep - work, 0.0)

    def _slopes_in_t(self, fields: Floats) -> Floats:
        """Return derivatives of fields with respect to t at the nodes, in the shape of ``fields``.

        fields: values at the nodes, (n + 2, m, fields).
        The derivatives are 0 at t = 0 and +-1 if the nodes are graded.
        """
        from scipy import interpolate

        if not self.graded:
            slopes = _slopes(self.t, fields, axis=1)
            # a field that does not depend on creep has slopes of exactly 0, not of rounding
            return np.where(np.ptp(fields, axis=1, keepdims=True) > 0.0, slopes, 0.0)
        middle = self.t.size // 2
        slopes = np.zeros_like(fields)
        # each side by itself: fields have a corner in the middle, which the grading of t makes flat
        for side in (slice(0, middle + 1), slice(middle, None)):
            spline = interpolate.CubicSpline(
                self.t[side], fields[:, side], axis=1, bc_type="clamped"
            )
            slopes[:, side] = spline(self.t[side], 1)
        return slopes


def grade(t: Any) -> Any:
    """Return w = 1 - (1 - t^2)^(3/2), the part of the distance from the middle creepage to an onset
    of full slip at which the creepage at t lies in a graded table.
    """
    return 1.0 - (1.0 - np.square(t)) ** 1.5


def _slopes(x: Floats, values: Floats, axis: int = 0) -> Floats:
    """Return slopes at nodes ``x`` along an axis of ``values``, in their shape, of the not-a-knot
    spline, of lower degree for few nodes.
    """
    from scipy import interpolate

    return np.asarray(
        interpolate.make_interp_spline(x, values, k=min(3, x.size - 1), axis=axis)(x, 1)
    )


def _equal_step(x: Any) -> tuple[float, float]:
    """Return the step of ascending coordinates in equal steps and its inverse, else two zeros."""
    steps = np.diff(x)
    step = float(steps.mean())
    equal = np.ptp(steps) <= 1e-12 * steps.max() * x.size
    return (step, 1.0 / step) if equal else (0.0, 0.0)
