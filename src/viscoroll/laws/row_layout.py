"""The layout of rows: the only module that knows where a function stands in a table or in the
record of a law.

A table is an array (rows, 24 powers, 7 functions) with the functions in the order of
:data:`FUNCTIONS`.  Kernels read the same rows from a record (:mod:`.law_record`), where
functions that are needed together lie side by side.

Terms of this file (docs/symbols.md has the symbols of the paper).  All quantities are
dimensionless: times are divided by T_ref, the unit of time of the material.

- Row: the polynomial of one interval of a variable, in powers of its argument t.  Row 0 is the
  interval [0, 2^e0), with t in [0, 1); row n > 0 is the octave [2^(e0+n-1), 2^(e0+n)), with t in
  [-1, 1) (:class:`.law_rows.Rows`).
- u = kappa |V| is the variable of lam, epsilon, M/V and N; v = 1/F(eta) that of share = eta/F and
  press = H/F^2, with eta half the transit time of the stick zone, and F(z) = z + g(z) and H(z) =
  z^2 + 2 z h(z) by functions g and h of the material (:mod:`.material_series`).
- L = lam (1 + epsilon) = 2 kappa delta_star/mu of half-spaces; of a cover it is 2 kappa
  delta_star/mu.
- Fast limit: the expansion of the functions for large u or v, which replaces the rows beyond the
  last one.  Its coefficients are W = sum J_j/T_j and C = sum J_j/T_j (ln(2 T_j) - 0.5772...), each
  of both bodies together, of the half-space and of the cylinder.
- s: position of alpha in its octave [2^n, 2^(n+1)), s = 2 log2(alpha/2^n) - 1, in [-1, 1].
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats, Integers
from ..kernels.numerics.interpolation import powers_of_chebyshev, to_chebyshev
from ..materials import AXIS, COVER, KINDS, LAW, Block, lock_array
from .law_rows import SHORT_TERMS, TERMS, Rows, e0_and_row_count, modes_record, refuse_distant_times

#: functions of a table in their order, lam, epsilon, m_half_space, m_cylinder, N, share and press:
#: the first five depend on u = kappa |V|, the others on v = 1/F(eta)
FUNCTIONS = tuple(KINDS[LAW].functions)
#: column of N
N_COLUMN = FUNCTIONS.index("N")
#: columns of the functions of steady rolling, all but N
STEADY = np.delete(np.arange(len(FUNCTIONS)), N_COLUMN)
#: functions that only covers have (:mod:`.cover_law`), in the file after those of steady rolling:
#: limit, L = 2 kappa delta_star/mu; free_half_space and free_cylinder, f, whose sum is 2 kappa
#: delta_f; excess_half_space and excess_cylinder, g, whose sum is 2 kappa (delta_0* - delta_f);
#: lam_Q and epsilon_Q, slopes of lam and epsilon in Q
COVER_FUNCTIONS = tuple(KINDS[COVER].functions)[STEADY.size :]
#: functions of a table over alpha in their order, lam, epsilon, m, N, share and press; m is M/V of
#: both bodies, which are alike
AXIS_FUNCTIONS = tuple(KINDS[AXIS].functions)
#: functions of a table over alpha that are divided by c = (alpha - 1)/alpha, as their limits for
#: alpha -> 1 are then finite
_DIVIDED_BY_C = [AXIS_FUNCTIONS.index(name) for name in ("epsilon", "m", "N")]
#: coefficient of Chebyshev polynomials of t and s, divided by the least value of its function in
#: the row, below which it is dropped: the sum of some hundred of them is below the rounding of a
#: double
_NEGLIGIBLE = 4e-17
#: the same of functions whose slopes enter those of Q, multiplied by k^2, the slope of T_k at the
#: ends of a row: with the bound above alone dQ_dV was off by 3e-13 of mu/V where a row ends, with
#: this one by 1.6e-14; a quarter of it leaves 6e-15, at a tenth more of all terms
_NEGLIGIBLE_SLOPE = 4e-16
#: L and H/F^2, the functions with that bound, among L, m, lam, epsilon, H/F^2 and eta/F
_FUNCTIONS_WITH_SLOPES = [0, 4]
#: column of M/V in a table over alpha, and of that of the half-space in a table, where that of the
#: cylinder follows
_AXIS_M = AXIS_FUNCTIONS.index("m")


class CoverRows(NamedTuple):
    """The law of a cover over u = kappa |V|, by :func:`.cover_rows.cover_rows`; all numbers are
    dimensionless.

    e0 : exponent of the end of the first row, which is [0, 2^e0); 0 for elastic bodies, which have
        a single row.
    coefficients : table (rows, 24 powers, 7 functions) with NaN for N, which is not known for
        covers.
    creep : rows of the functions that only covers have, in the order of :data:`COVER_FUNCTIONS`,
        (7, rows, 24 powers).
    limits : shape (19,): limits of L, lam and the other six of these functions for u -> infinity;
        then the factors of 1/u in their first order; then the limits of epsilon u, and of M u^2/V
        of half-space and cylinder.  The last eleven are 0 for elastic bodies.
    """

    e0: int
    coefficients: Floats
    creep: Floats
    limits: Floats


def steady_table(powers: Any, N: float = math.nan) -> Floats:
    """Return a table made of the functions of steady rolling, with a constant in the column of N.

    powers: six arrays (rows, 24 powers), of lam, epsilon, m_half_space, m_cylinder, share and
        press, as a sequence or as one array (6, rows, 24 powers).
    N: the number that all entries of the column of N have; NaN (default): N is not known.
    Returns a new table (rows, 24 powers, 7 functions), functions in the order of :data:`FUNCTIONS`.
    """
    powers = np.stack(powers, axis=-1)
    table = np.full((*powers.shape[:-1], len(FUNCTIONS)), N)
    table[..., STEADY] = powers
    return table


def constant_rows(*values: float) -> Floats:
    """Return one row for each of several constants, the polynomials of functions that do not depend
    on the speed.

    values: the constants, one for each function.
    Returns a new array with the axes (function, row, power), of shape (number of values, 1, 24),
    functions in the order of the arguments: power 0 is the constant, all others are 0.
    """
    rows = np.zeros((len(values), 1, TERMS))
    rows[:, 0, 0] = values
    return rows


def to_axis(table: Floats, c: Floats) -> Floats:
    """Convert tables of a standard linear solid to functions that have finite limits for alpha ->
    1.

    table: coefficients of the functions, (..., rows, 24 powers, 7 functions), in the order of
        :data:`FUNCTIONS`; not changed.
    c: (alpha - 1)/alpha of each table, > 0, in a shape that broadcasts with (..., rows, 24 powers,
        3 functions).
    Returns a new array (..., rows, 24 powers, 6 functions), functions as :data:`AXIS_FUNCTIONS`:
    epsilon, M/V and N are divided by c, and M/V is twice that of the half-space, as both bodies are
    alike; lam, share and press are copied.
    """
    columns = np.delete(table, _AXIS_M + 1, axis=-1)
    columns[..., _AXIS_M] *= 2.0
    columns[..., _DIVIDED_BY_C] /= c
    return columns


def from_axis(columns: Floats, c: float) -> Floats:
    """Convert functions over alpha to a table; the reverse of :func:`to_axis`.

    columns: coefficients of the functions over alpha, (rows, 24 powers, 6 functions), as
        :data:`AXIS_FUNCTIONS`; epsilon, M/V and N in it are overwritten.
    c: (alpha - 1)/alpha, a number.
    Returns a new table (rows, 24 powers, 7 functions), as :data:`FUNCTIONS`; half-space and
    cylinder each have half of M/V.
    """
    columns[..., _DIVIDED_BY_C] *= c
    columns[..., _AXIS_M] *= 0.5
    return np.insert(columns, _AXIS_M, columns[..., _AXIS_M], axis=-1)


def interleave_pairs(a: Floats, b: Floats) -> Floats:
    """Return rows that hold two powers of one function, the same two of the other, and so on: a0 a1
    b0 b1 a2 a3 b2 b3
    ...

    Kernels evaluate two functions at once from this order.
    a, b: coefficients, (rows, powers) each, of one shape, with an even number of powers.
    Returns a new array (rows, 2 * powers).
    """
    return _interleave(np.stack([a, b], axis=1), 2)


def _interleave(functions: Floats, paired: int) -> Floats:
    """Return functions in the order of a row: pairs as in :func:`interleave_pairs`, then single
    functions.

    functions: coefficients, (..., functions, powers), with an even number of powers.
    paired: number of functions that are in pairs, the first ones, even.
    Returns a new array (..., functions * powers).
    """
    front = functions.shape[:-2]
    pairs = functions[..., :paired, :].reshape(*front, paired // 2, 2, -1, 2).swapaxes(-3, -2)
    parts = pairs, functions[..., paired:, :]
    return np.concatenate([part.reshape(*front, -1) for part in parts], axis=-1)


def align_vector(numbers: Floats) -> Floats:
    """Return a copy of a vector that begins where a cache line (64 bytes) begins.

    Otherwise each group of eight numbers that a kernel loads at once, and up to half of the groups
    of four, would straddle two cache lines.
    numbers: doubles, (n,).
    Returns the copy, (n,), writable: a view into a longer array.
    """
    buffer = np.empty(numbers.size + 8)
    # number of doubles, 0 to 7, from the address of the buffer, a multiple of 8 bytes, to the next
    # multiple of 64 bytes: (-address/8) modulo 8
    first = -buffer.ctypes.data // 8 % 8
    buffer[first : first + numbers.size] = numbers
    return buffer[first : first + numbers.size]


def allocate_rows(count: int) -> tuple[Floats, Integers]:
    """Return the two arrays of a record of ``count`` rows, with their heads in front, and no
    material selected.

    Returns (rows, marks) as in :class:`.law_record.Law`: (count + 1) * ROW_SIZE doubles,
    all 0 and aligned to 64 bytes; (count + 1) * PARTS_PER_ROW integers, all 0 but the mark
    SELECTED, which is -1.  Both are writable.
    """
    from ..kernels.law.law_record import PARTS_PER_ROW, ROW_SIZE, SELECTED

    marks = np.zeros((count + 1) * PARTS_PER_ROW, np.int64)
    marks[SELECTED] = -1
    return align_vector(np.zeros((count + 1) * ROW_SIZE)), marks


def pack_record(law: Any) -> Any:
    """Return the record of a law of steady rolling that kernels read, with all its rows computed.

    In contrast to the records of :mod:`.laws_per_element`, whose rows kernels compute where they
    read them, it can be shared by threads.
    law: :class:`.law_tables.LawTable`; the column of N is not read, and of a cover, whose
        ``limits`` take their place, neither alpha nor ``fast_limit``.
    Returns a :class:`.law_record.Law` with read-only arrays.  ``N_rows`` is empty, as N
    is packed by :func:`pack_unsteady`; ``selector``, ``maker`` and ``source`` are 0, since no row
    is left to be made; ``cover_rows`` is None for half-spaces, ``table`` but for a table of the
    coupled solution.
    """
    from ..kernels.law.law_record import E0, ROW_COUNT, ROW_SIZE, Law

    table = law.steady_coefficients
    # the limits for u -> infinity of H/F^2, alpha, and of lam, then the fast limit
    front = np.append([law.alpha, 1.0 / math.sqrt(law.alpha)], law.fast_limit)
    L = None
    cover_rows = None
    if law.cover is not None:
        front = _pack_cover_front(law.cover)
        cover_rows = lock_array(_pack_cover(law.cover))
        L = law.cover.creep[0]
    rows, marks = allocate_rows(len(table))
    rows[: front.size] = front
    functions = _row_functions(table, law.e0, alpha=front[0], fast=front[2:4], cover_L=L)
    rows[ROW_SIZE:] = _interleave(functions, 6).ravel()
    marks[[ROW_COUNT, E0]] = len(table), law.e0
    return Law(
        rows=lock_array(rows),
        marks=lock_array(marks),
        N_rows=lock_array(np.empty(0)),
        selector=0,
        maker=0,
        source=0,
        cover_rows=cover_rows,
        table=None if law.coupled is None else law.coupled.vector,
    )


def _row_functions(
    table: Floats, e0: int, alpha: float, fast: Floats, cover_L: Floats | None = None
) -> Floats:
    """Return the functions of the rows of a record in the order in which kernels read them
    (:mod:`.law_functions`).

    L is not taken from the table: two steps of Newton's method from lam (1 + epsilon), or from
    ``cover_L``, make L^2 press(2 u/L) = 1 hold to rounding, as Q would lose digits by an error in
    L; L at rest is set to its exact limit.
    table: coefficients of the functions, (rows, 24 powers, 7 functions), in the order of
        :data:`FUNCTIONS`; N is not read.
    e0: exponent of the end of the first row.
    alpha: value of press for v -> infinity: alpha of half-spaces, 1/L^2 with the limit of L of a
        cover.
    fast: W and C of the fast limit of both bodies together, (2,); of a cover 0 and four times the
        factor of 1/u in L.
    cover_L: rows of L = 2 kappa delta_star/mu of a cover, (rows, 24 powers); None: L = lam (1 +
        epsilon).
    Returns (rows, 8 functions, 24 powers): L and M/V of both bodies together, lam and epsilon, M/V
    of half-space and cylinder, three pairs in a row; then H/F^2 and eta/F.
    """
    rows = Rows(e0, len(table))
    lam, epsilon, half_space, cylinder, _, share, press = np.moveaxis(table, -1, 0)
    u = rows.x.ravel()
    (lam_at, epsilon_at), _ = rows.read(np.stack([lam, epsilon]), u)
    L = lam_at * (1.0 + epsilon_at) if cover_L is None else rows.read(cover_L[None], u)[0][0]
    for _ in range(2):
        value, slope = _read_press(rows, press, v=2.0 * u / L, alpha=alpha, fast=fast)
        # Newton's step for L^2 press(2 u/L) - 1, whose slope over L is 2 L A; dL, the slope of its
        # root over ln u, follows from the same equation
        A = value - 0.5 * slope
        dL = -0.5 * L * slope / A
        L = L - 0.5 * (L * value - 1.0 / L) / A
    lengths = rows.fit_slopes(L.reshape(rows.x.shape), dL.reshape(rows.x.shape))
    # L at rest: l0 itself on half-spaces
    lengths[0, 0] = 1.0 if cover_L is None else cover_L[0, 0]
    pairs = [lengths, half_space + cylinder, lam, epsilon, half_space, cylinder]
    return np.stack([*pairs, press, share], axis=1)


def _read_press(
    rows: Rows, press: Floats, v: Floats, alpha: float, fast: Floats
) -> tuple[Floats, Floats]:
    """Return H/F^2 and its derivative with respect to ln v, by the rows or, beyond these, by the
    fast limit.

    rows: :class:`Rows`, octaves of v.
    press: coefficients of H/F^2, (rows, 24 powers).
    v: 1/F(eta), > 0, (n,).
    alpha: value for v -> infinity, dimensionless.
    fast: W and C of the fast limit, (2,).
    Returns (values, derivatives), (n,) each, dimensionless.
    """
    (value,), (slope,) = rows.read(press[None], np.minimum(v, rows.last))
    bracket = fast[1] + fast[0] * np.log(v)
    share = 1.0 - 0.5 * alpha * bracket / v
    # 2 alpha times the slope of eta/F, as H/F^2 = alpha (eta/F)^2 beyond the rows
    share_slope = alpha**2 * (bracket - fast[0]) / v
    beyond = v > rows.last
    return np.where(beyond, alpha * share**2, value), np.where(beyond, share_slope * share, slope)


def pack_unsteady(table: Floats, e0: int, alpha: float) -> Floats:
    """Return the rows of N of a record, with those of its integral over u, from which kernels take
    the added mass.

    N is the first-order term of M = M(V) + N(V) V', the rolling moment at slowly changing speed.

    The origin of a row is the point where its argument t is 0: u = 0 in the first row, three
    quarters of the end of the octave in the others.  Beyond the last row N is (alpha - 1)/(16 alpha
    u^2), and the origin is infinity.
    table: coefficients of the functions, N among them, (rows, 24 powers, 7 functions).  Of a cover
        N is NaN, and so is the result.
    e0: exponent of the end of the first row.
    alpha: instantaneous divided by long-time modulus, a number, dimensionless.
    Returns one vector of 48 rows + 2 (rows + 1) numbers, N in units of T_ref^2: for each row 48
    coefficients of N and of its integral from the origin of the row, two powers of one and two of
    the other in turn; then, for each row, the integral of N from infinity to its origin, and 0 for
    the interval beyond the last row; then, for each row, the integral from u = 0 to its origin, and
    that from 0 to infinity.
    """
    N = table[..., N_COLUMN]
    du_dt = np.ldexp(0.25, e0 + np.arange(len(N)))
    # du/dt of an octave is a quarter of its end, of the first row its whole end; the highest power
    # of the integral would be one too many and is dropped
    integral = np.zeros_like(N)
    du_dt[0] = math.ldexp(1.0, e0)
    integral[:, 1:] = du_dt[:, None] * N[:, :-1] / np.arange(1.0, TERMS)
    # integrals from the origin t = 0 to t = 1 and to t = -1
    to_end = integral.sum(axis=1)
    to_begin = integral @ (-1.0) ** np.arange(TERMS)
    to_begin[0] = 0.0  # the first row begins at t = 0
    beyond = (alpha - 1.0) / (16.0 * alpha * math.ldexp(1.0, e0 + len(N) - 1))
    # the integral over each row, then over all speeds beyond the last
    parts = np.append(to_end - to_begin, beyond)
    # minus the integral from each origin to infinity: that from the begin of the row, and that from
    # the origin back to the begin
    from_top = -np.cumsum(parts[::-1])[::-1] - np.append(to_begin, 0.0)
    from_rest = np.append(0.0, np.cumsum(parts))
    from_top[-1] = 0.0
    # its last but one entry, up to the end of the last row, belongs to no origin and is deleted
    # below
    from_rest[:-2] -= to_begin
    pairs = interleave_pairs(N, integral).ravel()
    return np.concatenate([pairs, from_top, np.delete(from_rest, -2)])


def _pack_cover_front(cover: CoverRows) -> Floats:
    """Return the numbers of a cover that stand in front of the rows of its record.

    They are chosen so that the formulas of the fast limit of half-spaces give that of the cover,
    without logarithms: L = L_1 (1 + a/u) and M = b V/u^2, with limits L_1, L_1 a and b of the
    cover.
    cover: :class:`CoverRows`, law of the cover, of which ``limits`` are read.
    Returns shape (8,), in place of alpha, lam, and W and C of both bodies, of the half-space and of
    the cylinder: 1/L_1^2, L_1, 0, 4 L_1 a; then 0, 8 b for each body.
    """
    # the limit of L and, after the limits of lam and of the other functions, its factor of 1/u
    L, L_slope = cover.limits[[0, 1 + len(COVER_FUNCTIONS)]]
    half_space, cylinder = cover.limits[-2:]
    return np.array(
        [1.0 / (L * L), L, 0.0, 4.0 * L_slope, 0.0, 8.0 * half_space, 0.0, 8.0 * cylinder]
    )


def _pack_cover(cover: CoverRows) -> Floats:
    """Return the numbers of a cover that kernels read in addition to its rows
    (:mod:`.cover_law`).

    cover: law of the cover, as :class:`CoverRows`.
    Returns one vector of 24 + 96 rows numbers, aligned: the head of :mod:`.cover_law`, limits
    for u -> infinity, the part of the cylinder and zeros; then for each row the 16 coefficients of
    f and g of both bodies together, of f and g of the cylinder, and of both slopes, each pair
    interleaved.
    """
    from ..kernels.law.cover_law import COVER_FRONT_SIZE, CYLINDER_PART

    # each limit with its factor of 1/u
    limits = cover.limits[:-3].reshape(2, -1).T
    (L, L_slope), (lam, lam_slope) = limits[:2]
    # eta/F for v -> infinity and its factor of 1/v, with 1/u = 2/(L v)
    share = lam / L, 2.0 * (lam_slope * L - lam * L_slope) / L**3
    _, free_base, free, excess_base, excess, *tilts = cover.creep[..., :SHORT_TERMS]
    # a body without a layer has f = 0 at all speeds; -1: both have one, and kernels read the
    # cylinder's
    on_base = free_base.any()
    part = -1.0 if on_base and free.any() else float(not on_base)
    front = [
        # L is in the head of the rows (_pack_cover_front)
        *limits[1:].ravel(),
        *share,
        cover.limits[-3],
        # 2 M u^2/(V L), the form in which kernels take the moment of both bodies
        2.0 * sum(cover.limits[-2:]) / L,
        part,
        *np.zeros(COVER_FRONT_SIZE - CYLINDER_PART - 1),
    ]
    functions = [free_base + free, excess_base + excess, free, excess, *tilts]
    return align_vector(np.append(front, _interleave(np.stack(functions, axis=1), len(functions))))


class AxisRows(NamedTuple):
    """The rows of an octave of alpha as groups of terms in s (:mod:`.alpha_axis`),
    read-only.

    A group is the four coefficients of T_4g(s) s^i, i = 0 to 3, of eight neighbouring numbers of a
    row (a block).
    numbers : one vector, in which group n begins at 32 n, 4 x 8 numbers, i outermost: of each block
        its groups, that of the highest degrees first; of most blocks fewer than four, as those of
        high degrees are 0.
    starts : index of the first group of each function or pair of functions of each row, then the
        number of all groups, (4 rows + 1,): L with M/V, lam with epsilon, H/F^2, eta/F.
    rows : number of rows.
    """

    numbers: Floats
    starts: Integers
    rows: int


def pack_axis(tables: list[Any]) -> AxisRows:
    """Interpolate the coefficients of 16 laws over alpha, and pack the result for the kernels of an
    alpha each.

    The interpolation is by Chebyshev polynomials in s in [-1, 1], the position of alpha in its
    octave; the kernels are those of :mod:`.alpha_axis`.
    tables: laws of standard linear solids (:class:`.law_tables.LawTable`) at the 16 Chebyshev nodes
        of s, in the order of :func:`.interpolation.chebyshev`, with equal numbers of rows.
    Returns :class:`AxisRows`: ``numbers``, the terms of these polynomials, in groups of four;
    ``starts``, the index of the first group of each function or pair of each row; ``rows``, their
    number.
    Groups of high degrees are left out where all blocks of the function need no more than
    :data:`.alpha_axis.SHORT` states; else all four groups of all its blocks are
    kept.  M/V and epsilon are divided by (alpha - 1)/alpha, which is ``T_mean`` of these laws.  M/V
    of half-space and cylinder are not packed: each is half of M/V.
    """
    from ..kernels.law.alpha_axis import BLOCK_SIZE, FULL, GROUP, SHORT

    functions = [
        _row_functions(table.steady_coefficients, table.e0, table.alpha, table.fast_limit[0])
        for table in tables
    ]
    # L, M/V, lam, epsilon, H/F^2 and eta/F, without M/V of the bodies
    values = np.ascontiguousarray(np.delete(functions, [4, 5], axis=2))
    rows = values.shape[1]
    # M/V and epsilon go to 0 with c = (alpha - 1)/alpha
    values[:, :, 1:4:2] /= np.array([table.T_mean for table in tables])[:, None, None, None]
    terms = _grouped_terms(_interleave(_significant_terms(values), 4))
    # (rows, blocks, groups, terms, numbers), groups of the highest degrees first
    groups = terms.reshape(FULL, GROUP, rows, -1, BLOCK_SIZE).transpose(2, 3, 0, 1, 4)[:, :, ::-1]
    numbers = []
    counts = []
    for row in groups:
        first = 0
        # SHORT: for each function or pair of a row, the groups that each of its blocks usually
        # needs
        for short in SHORT:
            blocks = row[first : first + len(short)]
            first += len(short)
            # groups are ordered from the highest degrees: those that a short block leaves out come
            # first
            needs_all = any(block[: FULL - length].any() for block, length in zip(blocks, short))
            lengths = (FULL,) * len(short) if needs_all else short
            numbers += [block[FULL - length :].ravel() for block, length in zip(blocks, lengths)]
            counts.append(sum(lengths))
    starts = np.append(0, np.cumsum(counts))
    return AxisRows(lock_array(align_vector(np.concatenate(numbers))), lock_array(starts), rows)


def _grouped_terms(terms: Floats) -> Floats:
    """Return sums of Chebyshev polynomials T_j(s) as sums of T_4g(s) times cubic polynomials in s.

    Kernels evaluate these faster.  A group has :data:`.alpha_axis.GROUP` terms, four.

    terms: coefficients of T_0 to T_15, (16, ...); not changed.
    Returns a new array of the same shape: the coefficient of T_4g s^i at index 4 g + i.
    """
    from ..kernels.law.alpha_axis import GROUP

    terms = terms.copy()
    # from the highest group down, as each changes the one below it
    for start in range(len(terms) - GROUP, 0, -GROUP):
        for i in range(1, GROUP):  # T_(4g+i) = 2 T_4g T_i - T_(4g-i)
            terms[start - i] -= terms[start + i]
            terms[start + i] *= 2.0
    groups = terms.reshape(-1, GROUP, *terms.shape[1:])
    groups[:, 0] -= groups[:, 2]  # T_2 = 2 s^2 - 1, T_3 = 4 s^3 - 3 s
    groups[:, 1] -= 3.0 * groups[:, 3]
    groups[:, 2] *= 2.0
    groups[:, 3] *= 4.0
    return terms


def _significant_terms(values: Floats) -> Floats:
    """Return the terms in Chebyshev polynomials of s of functions of s and t, without terms below
    their rounding.

    A coefficient of the product of Chebyshev polynomials T_j(s) T_k(t) is dropped if it is below
    :data:`_NEGLIGIBLE` times the least absolute value of its function at t = -1, 0 and 1, and of L
    and H/F^2 also below :data:`_NEGLIGIBLE_SLOPE`/k^2 times that value.  The first row, which holds
    the limits at rest, keeps all terms.
    values: coefficients of powers of t at the nodes of s, (nodes, rows, functions, powers), of the
        functions L, M/V, lam, epsilon, H/F^2 and eta/F, M/V and epsilon divided by (alpha -
        1)/alpha; not changed.
    Returns a new array (terms of s, rows, functions, powers of t).  In each row but the first,
    powers of t above the last Chebyshev polynomial that is kept are exactly 0; a coefficient that
    is the same at all nodes has that value as its term T_0, and 0 after it.
    """

    count = values.shape[-1]
    ends = values @ np.array(
        [[(-1.0) ** k, k == 0, 1.0] for k in range(count)]
    )  # values at t = -1, 0 and 1
    least = np.abs(ends).min(axis=(0, 3))
    terms = np.einsum("jk,k...->j...", to_chebyshev(len(values)), values)
    # from powers to Chebyshev polynomials exactly: an inverse matrix would lose eight digits
    to_terms = np.array(
        [
            np.pad(np.polynomial.chebyshev.poly2cheb(unit), (0, count - 1 - k))
            for k, unit in enumerate(np.eye(count))
        ]
    )
    of_both = terms[:, 1:] @ to_terms
    allowed = np.full(values.shape[2:], _NEGLIGIBLE)
    allowed[_FUNCTIONS_WITH_SLOPES, 1:] = np.minimum(
        _NEGLIGIBLE, _NEGLIGIBLE_SLOPE / np.arange(1, count) ** 2
    )
    dropped = np.where(np.abs(of_both) < allowed * least[1:, :, None], of_both, 0.0)
    # dropped terms are subtracted: converting the others to Chebyshev polynomials and back would
    # add rounding errors
    terms[:, 1:] -= dropped @ powers_of_chebyshev(count, 0.0, 1.0)
    kept = np.where(of_both != dropped, np.arange(1, count + 1), 0).max(axis=-1, keepdims=True)
    terms[:, 1:][np.arange(count) >= kept] = 0.0
    constant = (values == values[0]).all(
        axis=0
    )  # as lam = 1 at rest, which rounding must not change
    terms[0, constant] = values[0, constant]
    terms[1:, constant] = 0.0
    return terms


def pack_materials(block: Block) -> Floats:
    """Return the numbers of materials from which kernels make rows by a grid of z
    (:mod:`.z_grid`).

    block: materials of equal numbers of modes, as :class:`.prony.Block`; without weights each body
        has half of each mode.
    Returns (materials, 13 + (5 + modes) modes), of each: alpha, 1/sqrt(alpha); W and C of the fast
    limit of both bodies, of the half-space, of the cylinder; sums J_j T_j of half-space and
    cylinder; e0, number of rows, number of modes (0, 1 and 0 for elastic ones); then the vectors a,
    b, e, t and weights and the matrix Q of the modes, as in :func:`.law_rows.modes_record`.  Times
    are in units of T_ref.
    Raises ParameterError for times beyond 1e-100 to 1e100 times T_ref.
    """
    modes = block.modes
    count = block.rows.size
    weights = np.full(modes.J.shape, 0.5) if block.weights is None else block.weights
    W = modes.J * modes.b
    C = W * (math.log(2.0) - np.log(modes.b) - np.euler_gamma)
    sums = [
        (share * term).sum(axis=-1) for share in (1.0, weights, 1.0 - weights) for term in (W, C)
    ]
    means = [(share * modes.J / modes.b).sum(axis=-1) for share in (weights, 1.0 - weights)]
    e0 = np.zeros(count)
    rows = np.ones(count)
    # elastic ones: one row from e0 = 0, without modes
    mode_count = np.full(count, modes.a.shape[-1])
    if modes.a.size:
        refuse_distant_times(modes.b.min(), modes.a.max())
        e0, rows = e0_and_row_count(modes.b[:, 0], modes.a[:, -1])
    *vectors, Q = modes_record(modes, weights)
    front = [modes.alpha, 1.0 / np.sqrt(modes.alpha), *sums, *means, e0, rows, mode_count]
    return np.concatenate([np.stack(front, axis=1), *vectors, Q.reshape(count, -1)], axis=1)
