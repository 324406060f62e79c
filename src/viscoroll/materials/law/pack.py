"""The layout of rows: the only module that knows where a function stands in a table or in the record of a law.

A table is an array (rows, 24 powers, 7 functions) with the functions in the order of :data:`FUNCTIONS`.  Kernels read
the same rows from a record (:mod:`...kernels.rows.record`), where functions that are needed together lie side by side.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats, Integers
from ..prony import Block, lock_array
from .evaluate import modes_record
from .rows import TERMS, Rows, row_range

#: functions of a table in their order: the first five depend on u = kappa |V|, the others on v = 1/F(eta)
FUNCTIONS = ("lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press")
#: columns of the functions of steady rolling, all but N
_STEADY = [n for n, name in enumerate(FUNCTIONS) if name != "N"]
#: functions of a table over alpha in their order; m is M/V of both bodies, which are alike
AXIS_FUNCTIONS = ("lam", "epsilon", "m", "N", "share", "press")
#: columns of a table that those are taken from
_AXIS_COLUMNS = [FUNCTIONS.index(name) for name in ("lam", "epsilon", "m_half_space", "N", "share", "press")]
#: functions of a table over alpha that are divided by c = (alpha - 1)/alpha, as their limits for alpha -> 1 are then
#: finite
_DIVIDED_BY_C = [AXIS_FUNCTIONS.index(name) for name in ("epsilon", "m", "N")]
#: coefficient of Chebyshev polynomials of t and s, divided by the least value of its function in the row, below which
#: it is dropped: the sum of some hundred of them is below the rounding of a double
_NEGLIGIBLE = 4e-17
#: the same of functions whose slopes enter those of Q, multiplied by k^2, the slope of T_k at the ends of a row: with
#: the bound above alone dQ_dV was off by 3e-13 of mu/V where a row ends, with this one by 1.6e-14; a quarter of it
#: leaves 6e-15, at a tenth more of all terms
_NEGLIGIBLE_SLOPE = 4e-16
#: L and H/F^2, the functions with that bound, among L, m, lam, epsilon, H/F^2 and eta/F
_FUNCTIONS_WITH_SLOPES = [0, 4]
#: column of M/V of the half-space in a table over alpha
_AXIS_M = AXIS_FUNCTIONS.index("m")


class CoverRows(NamedTuple):
    """The law of a cover over u = kappa |V|.

    e0 : exponent of the end of the first row.
    coefficients : table (rows, 24 powers, 7 functions) with NaN for N, which is not known for covers.
    creep : rows of L = 2 kappa delta_star/mu and of 2 kappa delta_0, shape (2, rows, 24 powers).
    limits : for u -> infinity L, lam and 2 kappa delta_0; then the factors of 1/u of their first order; then
        epsilon u and M u^2/V; shape (8,).
    """

    e0: int
    coefficients: Floats
    creep: Floats
    limits: Floats


def steady_table(powers: Any, N: float = math.nan) -> Floats:
    """Return a table made of the functions of steady rolling.

    powers: six arrays (rows, 24 powers), of lam, epsilon, m_half_space, m_cylinder, share and press.
    N: constant that fills the column of N; NaN: N is not known.
    Returns the table (rows, 24 powers, 7 functions).
    """
    powers = np.stack(powers, axis=-1)
    table = np.full((*powers.shape[:-1], len(FUNCTIONS)), N)
    table[..., _STEADY] = powers
    return table


def steady_columns(table: Floats) -> Floats:
    """Return a table without N, (rows, 24 powers, 6 functions); the reverse of :func:`steady_table`."""
    return table[..., _STEADY]


def constant_rows(*values: float) -> Floats:
    """Return one row for each of several constants ``values``, shape (values, 1, 24 powers)."""
    rows = np.zeros((len(values), 1, TERMS))
    rows[:, 0, 0] = values
    return rows


def to_axis(table: Floats, c: Floats) -> Floats:
    """Convert tables of a standard linear solid to functions that have finite limits for alpha -> 1.

    table: coefficients of the functions, (..., rows, 24 powers, 7 functions), in the order of :data:`FUNCTIONS`; not
    changed.
    c: (alpha - 1)/alpha of each table, > 0, in a shape that broadcasts with (..., rows, 24 powers, functions).
    Returns (..., rows, 24 powers, 6 functions), as :data:`AXIS_FUNCTIONS`: epsilon, M/V and N divided by c.
    """
    columns = table[..., _AXIS_COLUMNS]
    columns[..., _AXIS_M] *= 2.0
    columns[..., _DIVIDED_BY_C] /= c
    return columns


def from_axis(columns: Floats, c: float) -> Floats:
    """Convert functions over alpha to a table; the reverse of :func:`to_axis`.

    columns: coefficients of the functions over alpha, (rows, 24 powers, 6 functions); changed in place.
    c: (alpha - 1)/alpha.
    Returns the table (rows, 24 powers, 7 functions); each body has half of M.
    """
    columns[..., _DIVIDED_BY_C] *= c
    columns[..., _AXIS_M] *= 0.5
    return columns[..., [AXIS_FUNCTIONS.index(name if name in AXIS_FUNCTIONS else "m") for name in FUNCTIONS]]


def interleave_pairs(a: Floats, b: Floats) -> Floats:
    """Return rows in which two powers of one function are followed by the same two of the other: a0 a1 b0 b1 a2 ...

    a, b: coefficients, (rows, powers) each, with an even number of powers.
    Returns an array with twice as many columns.
    """
    both = np.stack([a.reshape(len(a), -1, 2), b.reshape(len(b), -1, 2)], axis=2)
    return both.reshape(len(a), -1)


def align_vector(numbers: Floats) -> Floats:
    """Return a copy of a vector ``numbers`` that begins at a line of the cache, 64 bytes.

    Elsewhere every vector of eight numbers that a kernel loads, and up to half of those of four, would span two lines.
    """
    room = np.empty(numbers.size + 8)
    first = -room.ctypes.data // 8 % 8
    room[first : first + numbers.size] = numbers
    return room[first : first + numbers.size]


def allocate_rows(count: int) -> tuple[Floats, Integers]:
    """Return numbers and marks of a record of ``count`` rows, with those in front, zeroed; no material is selected."""
    from ...kernels.rows.record import PARTS_PER_ROW, ROW_SIZE, SELECTED

    marks = np.zeros((count + 1) * PARTS_PER_ROW, np.int64)
    marks[SELECTED] = -1
    return align_vector(np.zeros((count + 1) * ROW_SIZE)), marks


def pack_record(table: Floats, e0: int, alpha: float, fast_limit: Floats, cover: CoverRows | None = None) -> Any:
    """Return the record of a law that kernels read, with all rows in place.

    table: coefficients of the functions, (rows, 24 powers, 7 functions), in the order of :data:`FUNCTIONS`.
    e0: exponent of the end of the first row, which is [0, 2^e0).
    alpha: instantaneous divided by long-time stiffness.
    fast_limit: W and C of the fast limit (:class:`.table.LawTable`), of both bodies, half-space and cylinder, (3, 2).
    cover: rows of a cover of finite thickness; None for half-spaces.
    Returns :class:`...kernels.rows.record.Law`, read-only, without the rows of N.
    """
    from ...kernels.rows.record import E0, ROW_COUNT, ROW_SIZE, Law

    count, front, L, cover_rows = len(table), np.append([alpha, 1.0 / math.sqrt(alpha)], fast_limit), None, None
    if cover is not None:
        front, cover_rows, L = _pack_cover_front(cover), lock_array(_pack_cover(cover)), cover.creep[0]
    rows, marks = allocate_rows(count)
    rows[: front.size] = front
    rows[ROW_SIZE:] = _pack_rows(table, e0, front[0], front[2:4], L).ravel()
    marks[[ROW_COUNT, E0]] = count, e0
    return Law(lock_array(rows), lock_array(marks), lock_array(np.empty(0)), 0, 0, 0, cover_rows)


def _pack_rows(table: Floats, e0: int, alpha: float, fast: Floats, cover_L: Floats | None) -> Floats:
    """Return the rows of a record in the order in which kernels read them (:mod:`...kernels.rows.evaluate`).

    L^2 press(2 u/L) = 1 is made to hold to rounding, as Q would lose digits by an error in it.
    table: coefficients of the functions, (rows, 24 powers, 7 functions), in the order of :data:`FUNCTIONS`.
    e0: exponent of the end of the first row.
    alpha: value of press for v -> infinity.
    fast: W and C of the fast limit of both bodies together, (2,).
    cover_L: rows of L = 2 kappa delta_star/mu of a cover, (rows, 24 powers); None: L = lam (1 + epsilon).
    Returns (rows, numbers of a row): pairs of powers of L and M/V, lam and epsilon, M/V of half-space and cylinder,
    then H/F^2 and eta/F.
    """
    rows = Rows(e0, len(table))
    lam, epsilon, half_space, cylinder, _, share, press = np.moveaxis(table, -1, 0)
    u = rows.x.ravel()
    (lam_at, epsilon_at), _ = rows.read(np.stack([lam, epsilon]), u)
    L = lam_at * (1.0 + epsilon_at) if cover_L is None else rows.read(cover_L[None], u)[0][0]
    for _ in range(2):
        value, slope = _read_press(rows, press, 2.0 * u / L, alpha, fast)
        # Newton's method for L^2 press(2 u/L) = 1
        A = value - 0.5 * slope
        L, dL = L - 0.5 * (L * value - 1.0 / L) / A, -0.5 * L * slope / A
    lengths = rows.fit_slopes(L.reshape(rows.x.shape), dL.reshape(rows.x.shape))
    lengths[0, 0] = 1.0 if cover_L is None else cover_L[0, 0]
    pairs = (lengths, half_space + cylinder), (lam, epsilon), (half_space, cylinder)
    return np.concatenate([*(interleave_pairs(*pair) for pair in pairs), press, share], axis=1)


def _read_press(rows: Rows, press: Floats, v: Floats, alpha: float, fast: Floats) -> tuple[Floats, Floats]:
    """Return H/F^2 and its derivative with respect to ln v, by the rows or, beyond these, by the fast limit.

    rows: octaves of v.
    press: coefficients of H/F^2, (rows, 24 powers).
    v: 1/F(eta), (n,).
    alpha: value for v -> infinity.
    fast: W and C of the fast limit, (2,).
    Returns (values, derivatives), (n,) each, dimensionless.
    """
    last = np.minimum(v, math.nextafter(math.ldexp(1.0, rows.e0 + rows.count - 1), 0.0))
    (value,), (slope,) = rows.read(press[None], last)
    bracket = fast[1] + fast[0] * np.log(v)
    share, share_slope = 1.0 - 0.5 * alpha * bracket / v, alpha**2 * (bracket - fast[0]) / v
    beyond = v > last
    return np.where(beyond, alpha * share**2, value), np.where(beyond, share_slope * share, slope)


def pack_unsteady(table: Floats, e0: int, alpha: float) -> Floats:
    """Return the rows of N of a record, with those of its integral over u.

    table: coefficients of the functions, N among them, (rows, 24 powers, 7 functions).
    e0: exponent of the end of the first row.
    alpha: instantaneous divided by long-time modulus.
    Returns one vector: rows of N and of its integral from the point t = 0 of each row, two powers of one and two of
    the other in turn; then the integral from infinity down to that point, for each row, and to the end of the last
    row; then likewise the integral from u = 0 up to it.
    """
    N = table[..., FUNCTIONS.index("N")]
    du_dt, integral = np.ldexp(0.25, e0 + np.arange(len(N))), np.zeros_like(N)
    du_dt[0] = math.ldexp(1.0, e0)
    integral[:, 1:] = du_dt[:, None] * N[:, :-1] / np.arange(1.0, TERMS)
    to_end, to_begin = integral.sum(axis=1), integral @ (-1.0) ** np.arange(TERMS)
    to_begin[0] = 0.0  # the first row begins at t = 0
    beyond = (alpha - 1.0) / (16.0 * alpha * math.ldexp(1.0, e0 + len(N) - 1))
    parts = np.append(to_end - to_begin, beyond)
    from_top, from_rest = -np.cumsum(parts[::-1])[::-1] - np.append(to_begin, 0.0), np.append(0.0, np.cumsum(parts))
    from_top[-1], from_rest[:-2] = 0.0, from_rest[:-2] - to_begin
    pairs = np.stack([N, integral], axis=1).reshape(len(N), 2, -1, 2).swapaxes(1, 2)
    return np.concatenate([pairs.ravel(), from_top, np.delete(from_rest, -2)])


def _pack_cover_front(cover: CoverRows) -> Floats:
    """Return the numbers in front of the rows of a ``cover``, shape (8,).

    With them the formulas of the fast limit of half-spaces give that of the cover, L = L_1 (1 + a/u) and M = b V/u^2,
    without logarithms.
    """
    L, _, _, L_slope, _, _, _, moment = cover.limits
    on_base = bool(cover.coefficients[0, 0, FUNCTIONS.index("m_half_space")])
    half_space, cylinder = (moment, 0.0) if on_base else (0.0, moment)
    return np.array([1.0 / (L * L), L, 0.0, 4.0 * L_slope, 0.0, 8.0 * half_space, 0.0, 8.0 * cylinder])


def _pack_cover(cover: CoverRows) -> Floats:
    """Return the numbers of a ``cover`` that kernels read in addition to its rows (:mod:`...kernels.rows.cover`)."""
    L, lam, free, L_slope, lam_slope, free_slope, epsilon, moment = cover.limits
    share_slope = 2.0 * (lam_slope * L - lam * L_slope) / L**3
    front = [lam, lam_slope, free, free_slope, epsilon, 2.0 * moment / L, lam / L, share_slope]
    return np.append(front, interleave_pairs(cover.creep[1], cover.creep[1]))


class AxisRows(NamedTuple):
    """The rows of an octave of alpha as groups of terms in s (:mod:`...kernels.rows.alpha_axis`).

    numbers : blocks of eight numbers; of each block its groups of terms in s, the group of the highest degrees first.
    starts : index of the first group of each function or pair of functions, (rows * functions + 1,).
    rows : number of rows.
    """

    numbers: Floats
    starts: Integers
    rows: int


def pack_axis(records: list[Any], c: Floats) -> AxisRows:
    """Return the rows of several alphas as the alpha axis of the kernels has them (:mod:`...kernels.rows.alpha_axis`).

    records: records of the laws of standard linear solids at the 16 nodes of an octave of alpha, with equal numbers of
    rows.
    c: (alpha - 1)/alpha of each, (16,), by which M/V and epsilon are divided.
    Returns :class:`AxisRows`: terms of Chebyshev polynomials in s, the place of alpha in its octave, in groups of
    four; groups of zeros at high degrees are left out.
    """
    from ...kernels.rows.alpha_axis import ALPHA_TERMS, BLOCK_SIZE, FULL, GROUP, SHORT
    from ...kernels.rows.record import BODY_MOMENTS, H_OVER_F2, PART_SIZE, ROW_SIZE

    values = np.array([record.rows[ROW_SIZE:].reshape(-1, ROW_SIZE) for record in records])
    nodes, rows = values.shape[:2]
    # a pair stores two powers of one function, then of the other: its functions are taken apart
    pairs = values[..., :BODY_MOMENTS].reshape(nodes, rows, 2, PART_SIZE // 2, 2, 2).swapaxes(3, 4)
    pairs = pairs.reshape(nodes, rows, 4, PART_SIZE)
    pairs[:, :, 1::2] /= c[:, None, None, None]
    singles = values[..., H_OVER_F2:].reshape(nodes, rows, 2, PART_SIZE)
    terms = _significant_terms(np.concatenate([pairs, singles], axis=2))
    pairs = terms[:, :, :4].reshape(ALPHA_TERMS, rows, 2, 2, PART_SIZE // 2, 2).swapaxes(3, 4)
    terms = np.concatenate([pairs.reshape(ALPHA_TERMS, rows, 4, PART_SIZE), terms[:, :, 4:]], axis=2)
    terms = _grouped_terms(terms, GROUP)
    groups = np.moveaxis(terms.reshape(FULL, GROUP, rows, -1, BLOCK_SIZE), 0, 2)
    groups = np.moveaxis(groups, (1, 3, 2), (0, 1, 2))[:, :, ::-1]  # (rows, blocks, groups, terms, numbers)
    numbers, counts = [], []
    for row in groups:
        first = 0
        for short in SHORT:
            blocks = row[first : first + len(short)]
            first += len(short)
            needs_all = any(block[: FULL - length].any() for block, length in zip(blocks, short))
            lengths = (FULL,) * len(short) if needs_all else short
            numbers += [block[FULL - length :].ravel() for block, length in zip(blocks, lengths)]
            counts.append(sum(lengths))
    starts = np.append(0, np.cumsum(counts))
    return AxisRows(lock_array(align_vector(np.concatenate(numbers))), lock_array(starts), rows)


def _grouped_terms(terms: Floats, size: int) -> Floats:
    """Return sums of T_j(s) as sums of T_4g(s) times cubic polynomials in s.

    terms: coefficients of T_0 to T_15, (16, ...); not changed.
    size: terms of a group; it must be 4.
    Returns coefficients of the same shape: those of T_4g s^i at index 4 g + i.
    """
    terms = terms.copy()
    for start in range(len(terms) - size, 0, -size):
        for i in range(1, size):  # T_(4g+i) = 2 T_4g T_i - T_(4g-i)
            terms[start - i] -= terms[start + i]
            terms[start + i] *= 2.0
    groups = terms.reshape(-1, size, *terms.shape[1:])
    groups[:, 0] -= groups[:, 2]  # T_2 = 2 s^2 - 1, T_3 = 4 s^3 - 3 s
    groups[:, 1] -= 3.0 * groups[:, 3]
    groups[:, 2] *= 2.0
    groups[:, 3] *= 4.0
    return terms


def _significant_terms(values: Floats) -> Floats:
    """Return the terms in Chebyshev polynomials of s of functions of s and t, without terms below their rounding.

    values: powers of t at the nodes of s, (nodes, rows, functions, powers), the functions L, M/V, lam, epsilon, H/F^2
        and eta/F.
    Returns (terms of s, rows, functions, powers of t).  A coefficient of the Chebyshev polynomials of both that is
    negligible is zero, except in the first row, which holds the limits at rest.
    """
    from numpy.polynomial.chebyshev import poly2cheb

    from ...kernels.numerics.interpolation import powers_of_chebyshev, to_chebyshev

    nodes, count = len(values), values.shape[-1]
    ends = values @ np.array([[(-1.0) ** k, k == 0, 1.0] for k in range(count)])  # values at t = -1, 0 and 1
    least = np.abs(ends).min(axis=(0, 3))
    terms = np.einsum("jk,k...->j...", to_chebyshev(nodes), values)
    units = [[0.0] * k + [1.0] for k in range(count)]
    # from powers to Chebyshev polynomials exactly: an inverse matrix would lose eight digits
    to_terms = np.array([np.pad(poly2cheb(power), (0, count - 1 - k)) for k, power in enumerate(units)])
    of_both = terms[:, 1:] @ to_terms
    allowed = np.full(values.shape[2:], _NEGLIGIBLE)
    allowed[_FUNCTIONS_WITH_SLOPES, 1:] = np.minimum(_NEGLIGIBLE, _NEGLIGIBLE_SLOPE / np.arange(1, count) ** 2)
    dropped = np.where(np.abs(of_both) < allowed * least[1:, :, None], of_both, 0.0)
    # dropped terms are subtracted: converting the others to Chebyshev polynomials and back would add rounding errors
    terms[:, 1:] -= dropped @ powers_of_chebyshev(count, 0.0, 1.0)
    kept = np.where(of_both != dropped, np.arange(1, count + 1), 0).max(axis=-1, keepdims=True)
    terms[:, 1:][np.arange(count) >= kept] = 0.0
    constant = (values == values[0]).all(axis=0)  # as lam = 1 at rest, which rounding must not change
    terms[0, constant], terms[1:, constant] = values[0, constant], 0.0
    return terms


def pack_materials(block: Block) -> Floats:
    """Return the numbers of materials from which kernels make rows by a grid of z (:mod:`...kernels.rows.z_grid`).

    block: materials of equal numbers of modes; without weights each body has half of each mode.
    Returns (materials, numbers), of each: alpha, 1/sqrt(alpha); W and C of the fast limit of both bodies, of the
    half-space, of the cylinder; sums J_j T_j of half-space and cylinder; e0, number of rows, number of modes; then the
    vectors and the matrix of the modes, as of :func:`.evaluate.modes_record`.
    """
    modes, count = block.modes, block.rows.size
    weights = np.full(modes.J.shape, 0.5) if block.weights is None else block.weights
    alpha, W = np.broadcast_to(modes.alpha, count), modes.J * modes.b
    C = W * (math.log(2.0) - np.log(modes.b) - np.euler_gamma)
    sums = [(share * term).sum(axis=-1) for share in (1.0, weights, 1.0 - weights) for term in (W, C)]
    means = [(share * modes.J / modes.b).sum(axis=-1) for share in (weights, 1.0 - weights)]
    e0, rows, mode_count = np.zeros(count), np.ones(count), np.full(count, modes.a.shape[-1])
    if modes.a.shape[-1]:
        e0, rows = row_range(modes.b[:, 0], modes.a[:, -1])
    *vectors, Q = modes_record(modes, weights)
    front = [alpha, 1.0 / np.sqrt(alpha), *sums, *means, e0, rows, mode_count]
    return np.concatenate([np.stack(front, axis=1), *vectors, Q.reshape(count, -1)], axis=1)
