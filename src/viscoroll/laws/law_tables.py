"""The law of one material, one pair, or every alpha, as a table of rows.

:class:`LawTable` is the law of one material or pair; :func:`law_table` makes it once a process.
Its functions, in the order of the coefficients (:data:`.row_layout.FUNCTIONS`), are lam, epsilon,
M/V of half-space and of cylinder, N, eta/F and H/F^2.  :class:`LawAxis` is the law of one
relaxation time for all alpha, by Chebyshev polynomials of ln alpha, one an octave of alpha.

Rows are fitted to the formulas of the modes of a material.  The formulas are evaluated once, at 24
nodes an octave of w = 1/z, with z half the transit time of the contact in units of T_ref, the unit
of time of the material.  The polynomials of w are then
inverted: for the functions of u = kappa |V|, w = 2 u (1 + 2 h/z)^(1/2), for those of v = 1/F(eta),
w = v (1 + g/z), with the functions g and h of the material (:mod:`.material_series`).  They
give F(z) = z + g and H(z) = z^2 + 2 z h, the contact length over that at rest lam = (1 + 2
h/z)^(-1/2), and its shift over half the length epsilon = g/z; eta is z of the stick zone.  All
quantities are dimensionless; M/V is in units of P T_ref.
"""

import math
import threading
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ..core import Floats, ParameterError, check_number, described_error
from ..kernels.numerics.interpolation import chebyshev, to_chebyshev, to_doubles
from ..materials import HIGHEST_ALPHA, Bodies, Cover, Pair, Prony, lock_array, total_series
from .cover_rows import cover_rows
from .law_rows import CoupledRows, Rows, e0_and_row_count, evaluate_by_modes, refuse_distant_times
from .row_layout import (
    FUNCTIONS,
    N_COLUMN,
    CoverRows,
    constant_rows,
    from_axis,
    pack_record,
    pack_unsteady,
    steady_table,
    to_axis,
)

# --- Rows of the law of one material or pair, fitted to the formulas of its modes ---

#: as rows._ROUNDING, for N, whose formula has larger rounding errors; dimensionless
_ROUNDING_OF_N = 3e-15
#: Newton steps for w from an error of 1e-3: two leave 1e-13, whose effect is of second order and
#: below rounding
_NEWTON_STEPS = 2


def _solve_for_w(
    rows: Rows, powers: Floats, values: Floats, x: Floats, n: int
) -> tuple[Floats, Floats]:
    """Return the functions of w = 1/z where w = x (1 + g/z) (n = 1) or w = 2 x (1 + 2 h/z)^(1/2) (n
    = 2), that is w = n x (1 + n f)^(1/n), by Newton's method.

    Two steps are made from an interpolated start; the error that is left is subtracted to first
    order from the values.
    rows: octaves of w, as :class:`.law_rows.Rows`.
    powers: coefficients of g/z, h/z, and M/V of half-space and cylinder, (4, rows, 24 powers).
    values: values of these at the nodes, (4, nodes), the nodes of all rows one after another.
    x: v = 1/F(eta) for n = 1, u = kappa |V| for n = 2, dimensionless, > 0, (points,), such that w
        lies within ``rows``, which is not checked.
    n: 1 or 2; f is the n-th of the functions.
    Returns (values of the four functions; their derivatives with respect to ln x), (4, points)
    each, dimensionless.
    """
    nodes = rows.x.ravel()
    x_of_nodes = nodes * (1.0 / (n * (1.0 + n * values[n - 1]) ** (1.0 / n)))
    w = np.exp(np.interp(np.log(x), np.log(x_of_nodes), np.log(nodes)))
    for _ in range(_NEWTON_STEPS):
        (value,), (slope,) = rows.read(powers[[n - 1]], w)
        whole = 1.0 + n * value
        # for both n the relative change of w/x with ln w is slope/whole, since the root halves the
        # factor 2 of 2 h/z
        w += (x * (n * whole ** (1.0 / n)) - w) / (1.0 - slope / whole)
    found, slopes = rows.read(powers, w)
    whole = 1.0 + n * found[n - 1]
    dlnw_dlnx = 1.0 / (1.0 - slopes[n - 1] / whole)
    error = x * (n * whole ** (1.0 / n)) / w - 1.0
    return found + slopes * (error * dlnw_dlnx), slopes * dlnw_dlnx


def fit_rows(material: Any, rows: Rows, alpha: float, T_mean: Floats) -> Floats:
    """Fit the rows of the law of steady rolling, one polynomial for each function and octave.

    material: alpha > 1 as a float, a :class:`.prony.Prony` of one material or a
        :class:`.bodies.Bodies` of one pair; not elastic, as without modes there is nothing to fit.
    rows: octaves of u = kappa |V| and of v = 1/F(eta), as :class:`.law_rows.Rows`.
    alpha: instantaneous divided by long-time stiffness, a number > 1, dimensionless.
    T_mean: sums J_j T_j of half-space and cylinder, in units of T_ref, (2,): the limits of M/V at
        rest.
    Returns the table (rows, 24 powers, 7 functions) with NaN for N; functions as
    :data:`.row_layout.FUNCTIONS`.  In the first row the limits at rest are set, not fitted: lam =
    eta/F = H/F^2 = 1, epsilon = 0 with its slope T_mean, and M/V = ``T_mean``.
    """
    e0 = rows.e0
    mean = float(T_mean.sum())
    # w = 2 u (1 + 2 h/z)^(1/2) reaches 2 sqrt(alpha) times the largest u; one octave is spare
    w = Rows(e0, rows.count + 2 + math.ceil(0.5 * math.log2(alpha)))
    by_modes = evaluate_by_modes(material, 1.0 / w.x.ravel())
    powers = w.fit_slopes(*(part.reshape(-1, *w.x.shape) for part in by_modes[:2]))
    # at low speed g/z and h/z are T_mean w/2, with w = t 2^e0
    powers[:2, 0, :2] = [0.0, math.ldexp(0.5 * mean, e0)]
    powers[2:, 0, 0] = T_mean
    x = rows.x.ravel()
    # lam, epsilon and M/V at u = x
    of_w = w, powers, by_modes.values
    (shift, rise, *parts), (d_shift, d_rise, *d_parts) = _solve_for_w(*of_w, x, 2)
    lam = 1.0 / np.sqrt(1.0 + 2.0 * rise)
    values = [lam, shift, *parts]
    derivatives = [-(lam**3) * d_rise, d_shift, *d_parts]
    # eta/F and H/F^2 at v = x
    (shift, rise, *_), (d_shift, d_rise, *_) = _solve_for_w(*of_w, x, 1)
    share = 1.0 / (1.0 + shift)
    press = (1.0 + 2.0 * rise) * share**2
    fall = share * d_shift
    values += [share, press]
    derivatives += [-share * fall, 2.0 * (d_rise * share**2 - press * fall)]
    powers = rows.fit_slopes(*np.reshape([values, derivatives], (2, -1, *rows.x.shape)))
    powers[[0, 4, 5], 0, 0] = 1.0
    powers[1, 0, :2] = [0.0, math.ldexp(mean, e0)]
    powers[2:4, 0, 0] = T_mean
    return steady_table(powers)


# --- The law of one material or pair as a table ---

#: number of tables that a process keeps; each takes about 0.2 MB
_KEPT_TABLES = 32


@dataclass(frozen=True, eq=False, repr=False)
class LawTable:
    """The law of one material or pair for any load, speed, creep, radius and friction; arrays are
    read only.

    The variables are u = kappa |V| and v = 1/F(eta) (:mod:`.row_layout`).  All numbers are
    dimensionless, with times in units of ``T_ref``.

    Attributes
    ----------
    material : material whose law this is: alpha as a float, with T_epsilon for the unit of time; a
        :class:`.prony.Prony` series; or :class:`.bodies.Bodies`, of which :class:`.bodies.Cover`
        is one.  Like bodies and elastic ones are stored as one series or as 1.0.
    steady_coefficients : as :attr:`coefficients`, with NaN where N was not computed yet.
    e0 : exponent of the end of the first row, which is the interval [0, 2^e0); 0 for elastic
        bodies, which have one row.
    alpha : instantaneous divided by long-time stiffness, dimensionless.
    T_mean : limit of M/V for V -> 0, in units of P ``T_ref``: the sum of J_j T_j, except for a
        cover against a body that deforms.
    unlike : whether the bodies differ; True for a cover.
    fast_limit : W = sum J_j/T_j and C = sum J_j/T_j (ln(2 T_j) - 0.5772...) of both bodies
        together, of the half-space and of the cylinder, shape (3, 2); of a cover those of the
        bodies as half-spaces, which its law does not use.
    relaxation_strength, relaxation_time, creep_strength, retardation_time : both forms of the
        series of both bodies together, (modes,), slowest mode first, times in units of ``T_ref``.
    half_space_weight : part of each creep strength that is the half-space's, dimensionless,
        (modes,); 0.5 of like bodies.
    T_ref : unit of time, s; 1 where the material was given without units.
    pair : the bodies in SI units, if the table was made of such; else None.
    cover : rows that a cover of finite thickness has in addition, :class:`.row_layout.CoverRows`;
        None for half-spaces.
    coupled : the solution in which shear acts on pressure, at one mu,
        :class:`.law_rows.CoupledRows`, which is then the law; None without.  All but
        ``material``, ``unlike``, ``pair`` and ``T_ref`` are those of half-spaces then.
    """

    material: float | Prony | Bodies
    steady_coefficients: Floats
    e0: int
    alpha: float
    T_mean: float
    unlike: bool
    fast_limit: Floats
    relaxation_strength: Floats
    relaxation_time: Floats
    creep_strength: Floats
    retardation_time: Floats
    half_space_weight: Floats
    T_ref: float = 1.0
    pair: Pair | None = None
    cover: CoverRows | None = None
    coupled: CoupledRows | None = None

    def __repr__(self) -> str:
        return f"LawTable({self.pair or self.material!r})"

    @cached_property
    def coefficients(self) -> Floats:
        """Return the coefficients (rows, 24 powers, 7 functions), functions in the order of
        :data:`.row_layout.FUNCTIONS`.

        Those of N in M = M(V) + N dV/dt, in units of P T_ref^2, are computed at the first use; the
        value at rest is set to the exact limit.  For a cover N is not known: its column is NaN.
        """
        table = self.steady_coefficients
        if self.cover is not None or not np.isnan(table[0, 0, N_COLUMN]):
            return table
        rows = Rows(self.e0, len(table))
        (lam,), _ = rows.read(table[None, ..., FUNCTIONS.index("lam")], rows.x.ravel())
        # z = lam/(2 u), and infinite at rest
        z = np.append(0.5 * lam / rows.x.ravel(), np.inf)
        *N, at_rest = evaluate_by_modes(self.material, z).N
        whole = table.copy()
        whole[..., N_COLUMN] = rows.fit(np.reshape(N, rows.x.shape), rounding=_ROUNDING_OF_N)
        whole[0, 0, N_COLUMN] = at_rest
        return lock_array(whole)

    def pair_with(self, base: Any, plane: Any) -> Pair:
        """Return the bodies of the law in SI units, which it has in ``pair``, in ``plane``.

        base, plane: of a cylinder to which the law is given: None, and "strain" or "stress".
        Raises ParameterError for a dimensionless law, a base beside it, and another plane than that
        of a law of two different bodies.
        """
        if self.pair is None:
            raise described_error(
                "material",
                "is a dimensionless law",
                "the law of a Material in SI units; a dimensionless one is for a Scene",
            )
        if base is not None:
            raise described_error(
                "base", "is given", "left out: the law already contains both bodies"
            )
        if plane != self.pair.plane and not self.pair.like:
            raise ParameterError(
                "plane", repr(plane), f"{self.pair.plane!r}, for which the law was computed"
            )
        return Pair(self.pair.cylinder, self.pair.base, plane)

    @cached_property
    def moment_of_speed_alone(self) -> bool:
        """Whether M depends on the speed alone, and free rolling has no creepage: by rows of
        half-spaces, neither of a cover nor by a table of the coupled solution.
        """
        return self.cover is None and self.coupled is None

    @cached_property
    def gridded(self) -> bool:
        """Whether the law is a grid of Q and M, which states nothing of its bodies."""
        return self.coupled is not None and not self.coupled.graded

    @cached_property
    def elastic(self) -> bool:
        """Whether no body relaxes; the alpha 1 of a grid stands for bodies that are not known."""
        return self.alpha == 1.0 and not self.gridded

    @cached_property
    def record(self) -> Any:
        """Record of the law that kernels read (:class:`.law_record.Law`)."""
        return pack_record(self)

    @cached_property
    def unsteady_record(self) -> Any:
        """As :attr:`record`, with the rows of N (:func:`.row_layout.pack_unsteady`), which are NaN
        for a cover.
        """
        return self.record._replace(
            N_rows=lock_array(pack_unsteady(self.coefficients, self.e0, self.alpha))
        )


def law_table(
    material: float | Prony | Bodies | LawTable, coefficients: Floats | None = None
) -> LawTable:
    """Return the table of the law of a material; it is made once a process and shared by all its
    threads.

    The last 32 tables are kept.

    Parameters
    ----------
    material : alpha >= 1 as a number, with T_epsilon for the unit of time; a :class:`.prony.Prony`
        series; :class:`.bodies.Bodies`, which are one material if they are alike or both elastic,
        or a :class:`.bodies.Cover`; or a :class:`LawTable`, which is returned.
    coefficients : rows of the law, as read from a file, (rows, 24 powers, 7 functions), from which
        a new table is made, which is not kept; None: they are computed.  Ignored for a table, a
        cover and elastic bodies.

    Returns
    -------
    LawTable
        With times in the unit of the material, T_ref = 1 and no ``pair``.

    Raises
    ------
    ParameterError
        Many materials; times beyond 1e-100 to 1e100 of their unit (of half-spaces), which is also
        the message for an alpha in (0, 1) or NaN; a pair of more than 64 modes; a cover that is too
        thin.  :func:`.law_netcdf.law_table_of` refuses an alpha by its range.
    """
    if isinstance(material, LawTable):
        return material
    if not isinstance(material, Prony | Bodies):
        material = float(material)
    elif material.shape:
        raise ParameterError("material", repr(material), "a single material: make a call for each")
    elif type(material) is Bodies and (material.like or material.alpha == 1.0):
        material = material.total if material.total.E.size else 1.0
    if coefficients is not None:
        return make_table(material, coefficients)
    # threads wait for the one that makes a table, in place of making it again
    with _lock:
        return _made(material)


def coupled_table(material: Any, rows: CoupledRows) -> LawTable:
    """Return the law of a table of the coupled solution as a :class:`LawTable`.

    material: alpha, a series, bodies or a cover, of one scene.
    rows: :class:`.law_rows.CoupledRows` of it, which become ``coupled``.
    Returns a new table, whose other functions are those of half-spaces without coupling.
    """
    base = law_table(total_series(material))
    return replace(base, material=material, unlike=True, coupled=rows)


_lock = threading.Lock()


def make_table(
    material: float | Prony | Bodies,
    coefficients: Floats | None = None,
    cover: CoverRows | None = None,
) -> LawTable:
    """Make the table of the law of a material, without looking for one that was kept; rows that are
    not given are computed.

    material: alpha >= 1 as a float, a :class:`.prony.Prony` of one material,
        :class:`.bodies.Bodies` of one pair, or one :class:`.bodies.Cover`.  Bodies are taken as
        unlike: :func:`law_table` replaces alike or elastic ones.
    coefficients: rows of the law, (rows, 24 powers, 7 functions); None: they are computed.  Ignored
        for a cover and for elastic bodies, whose functions are the constants 1 and 0.
    cover: :class:`.row_layout.CoverRows`, rows of the law of a cover; None: they are computed if
        ``material`` is one.  Ignored for other materials.
    Returns the :class:`LawTable`, whose arrays are read-only, with T_ref = 1; N is computed at
    first use, but of elastic bodies it is 0.
    Raises ParameterError for times of half-spaces beyond 1e-100 to 1e100 of their unit, for a pair
    of more than 64 modes, and for a cover that is too thin.
    """
    total = total_series(material)
    modes = total.modes
    weights = (
        material.half_space_weights if isinstance(material, Bodies) else np.full(modes.J.size, 0.5)
    )
    W = modes.J * modes.b
    # terms of W, C and T_mean; for both bodies, the half-space, the cylinder
    terms = W, W * (math.log(2.0) - np.log(modes.b) - np.euler_gamma), modes.J / modes.b
    sums = np.array(
        # fsum rounds once, whatever the order of the modes
        [[math.fsum(part * term) for term in terms] for part in (1.0, weights, 1.0 - weights)]
    )
    e0 = 0
    T_mean = total.T_mean
    if isinstance(material, Cover):
        cover = cover or cover_rows(material)
        coefficients = cover.coefficients
        e0 = cover.e0
        # M/V at rest, power 0 of the first row, of both bodies
        T_mean = float(cover.coefficients[0, 0, 2:4].sum())
    elif modes.a.size:
        refuse_distant_times(modes.b[0], modes.a[-1])
        e0, count = map(int, e0_and_row_count(modes.b[0], modes.a[-1]))
        if coefficients is None:
            coefficients = fit_rows(material, Rows(e0, count), total.alpha, sums[1:, 2])
    else:  # elastic bodies: lam = eta/F = H/F^2 = 1, and neither shift nor moment
        coefficients = steady_table(constant_rows(1.0, 0.0, 0.0, 0.0, 1.0, 1.0), N=0.0)
    return LawTable(
        material=material,
        steady_coefficients=lock_array(coefficients),
        e0=e0,
        alpha=total.alpha,
        T_mean=T_mean,
        unlike=isinstance(material, Bodies),
        fast_limit=lock_array(sums[:, :2]),
        relaxation_strength=lock_array(modes.E),
        relaxation_time=lock_array(1.0 / modes.a),
        creep_strength=lock_array(modes.J),
        retardation_time=lock_array(1.0 / modes.b),
        half_space_weight=lock_array(weights),
        cover=cover,
    )


_made = lru_cache(maxsize=_KEPT_TABLES)(make_table)


# --- The law of one relaxation time for all alpha ---

#: Chebyshev terms of an octave of alpha; 16 leave an error of rounding
#: (tests/tables/test_law.py)
TERMS_OF_ALPHA = 16
#: octaves of alpha from 1 to the highest alpha
OCTAVES: int = math.frexp(HIGHEST_ALPHA)[1]


@dataclass(frozen=True, eq=False)
class LawAxis:
    """The law of one relaxation time, with unit of time T_epsilon, for all alpha of some octaves;
    arrays are read only.

    alpha is the instantaneous divided by the long-time modulus, dimensionless.

    Attributes
    ----------
    coefficients : (octaves of alpha, 16 terms, rows, 24 powers, 6 functions), the functions as
        :data:`.row_layout.AXIS_FUNCTIONS`, of which epsilon, M/V and N are divided by (alpha -
        1)/alpha.  For alpha in [2^n, 2^(n+1)) a row is the sum of its terms times T_j(2
        log2(alpha/2^n) - 1).
        All octaves have equal numbers of
        rows: those beyond the last of an octave, in the fast limit, are zero.
    rows : number of rows of each octave of alpha.
    first : log2 of the lowest alpha.
    e0 : exponent of the end of the first row.
    """

    coefficients: Floats
    rows: tuple[int, ...]
    first: int
    e0: int

    @property
    def alpha(self) -> tuple[float, float]:
        """Lowest and highest alpha."""
        return 2.0**self.first, 2.0 ** (self.first + len(self.rows))

    def at(self, alpha: float) -> LawTable:
        """Return the law of one ``alpha``, with T_epsilon for the unit of time.

        alpha: instantaneous divided by long-time modulus, dimensionless, from the lowest to the
            highest alpha of the axis (:attr:`alpha`), both included; not checked.
        Returns the :class:`LawTable`, whose rows are interpolated in ln alpha to rounding; of 1
        that of elastic bodies, a single row of constants.
        """
        if alpha == 1.0:
            return law_table(1.0)
        # the highest alpha is the end of the last octave, not the begin of another
        n = min(math.frexp(alpha)[1] - 1 - self.first, len(self.rows) - 1)
        s = 2.0 * (math.log2(alpha / 2.0 ** (n + self.first))) - 1.0
        columns: Any = np.polynomial.chebyshev.chebval(s, self.coefficients[n, :, : self.rows[n]])
        return make_table(alpha, from_axis(columns, (alpha - 1.0) / alpha))


def law_axis(low: float, high: float) -> LawAxis:
    """Compute the law of one relaxation time for all alpha of the octaves in which two values lie.

    low, high: alpha, dimensionless, 1 <= low < high <= 1e12.
    Returns the :class:`LawAxis`, from the octave [2^n, 2^(n+1)) of ``low`` to that which ends at or
    above ``high``: its range includes both values and is mostly wider.

    Raises
    ------
    ParameterError
        Values outside this range, or low >= high.
    """
    low, high = (check_number("alpha", value, low=1.0, high=HIGHEST_ALPHA) for value in (low, high))
    if not low < high:
        raise ParameterError(
            "alpha", f"{low:g} to {high:g}", "two different numbers, the lower one first"
        )
    first = math.frexp(low)[1] - 1
    pieces = []
    for octave in range(first, math.ceil(math.log2(high))):
        tables = tables_of_octave(octave)
        # T_mean of one relaxation time is (alpha - 1)/alpha, in units of T_epsilon
        c = np.array([table.T_mean for table in tables])[:, None, None, None]
        columns = to_axis(np.array([table.coefficients for table in tables]), c)
        # coefficients of T_0 to T_15 in s = 2 log2(alpha/2^n) - 1
        pieces.append(np.einsum("jk,k...->j...", to_chebyshev(TERMS_OF_ALPHA), columns))
    rows = tuple(piece.shape[1] for piece in pieces)
    padded = [
        np.pad(piece, [(0, 0), (0, max(rows) - len(piece[0])), (0, 0), (0, 0)]) for piece in pieces
    ]
    # the slowest rate of creep is 1/T_epsilon for every alpha, and so e0 is the same
    return LawAxis(lock_array(np.array(padded)), rows, first, tables[0].e0)


def tables_of_octave(octave: int) -> list[LawTable]:
    """Return the tables at the 16 Chebyshev nodes of an octave of alpha, from which it is
    interpolated.

    octave: n of the octave [2^n, 2^(n+1)), from 0 to 39.
    Returns a list of :class:`LawTable`, in the order of the nodes, all with equal numbers of
    rows.
    """
    nodes = to_doubles(chebyshev(TERMS_OF_ALPHA))
    return [make_table(alpha) for alpha in np.exp2(octave + 0.5 + 0.5 * nodes).tolist()]
