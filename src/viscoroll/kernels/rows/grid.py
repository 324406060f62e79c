"""Rows of a series or a pair each, by a grid of z that all rows of one material share: no root, no slope.

At z = 2^(n/10) the modes' formulas give lam and share = z/(z + g), and with them a point of every function over
u = lam/(2 z) and over v = share/z.  Newton's polynomial of ln u or ln v through the 36 points around an octave is read
at the nodes of that octave, and turned into powers of t.  That of the slow row goes through points at Chebyshev's
places of 1/z and is one of t.  A row depends on its material alone, not on the rows that were made before.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..compile.address import doubles, integers, record_at
from ..compile.jit import kernel
from ..material.series import AT_CYLINDER, AT_G, AT_H, AT_HALF_SPACE, AT_M, shares, unpacked, values
from ..numerics.four import LANES, divide, fused, load, multiply, slide, spread, store, subtract
from ..numerics.nodes import chebyshev, rounded, to_chebyshev
from .lanes import TERMS
from .record import BODIES, COUNT, E0, LENGTHS, OWN, OWN_MARKS, PART, PARTS, PRESS, STAMP, WIDTH

#: nodes of an octave of z; points of a polynomial; octaves behind the shortest time where the fast limit begins
PER, POINTS, FAST = 10, 36, 34
#: functions at the nodes: ln lam and, over it, L, u m, u lam, epsilon, u m of either body; ln share and, over it, press
#: and share
_LN_LAM, _L, _M, _LAM, _EPSILON, _HALF_SPACE, _CYLINDER, _LN_SHARE, _PRESS, _SHARE = range(10)
_FUNCTIONS = 10
#: where scratch begins in ``numbers``: arguments of the points, four in front that are no points, then twice values and
#: their differences; values at the nodes of a row, Chebyshev coefficients; the functions at the nodes of the grid
_ROOM = LANES + POINTS
_X, _D, _V, _C, _GRID = 0, _ROOM, 5 * _ROOM, 5 * _ROOM + TERMS, 5 * _ROOM + 2 * TERMS
#: in the slow row a Chebyshev coefficient below this share of the function is rounding
_ROUNDING = 4e-16
_STEP = math.log(2.0) / PER

_FRACTIONS = np.exp2(np.arange(PER) / PER)
_NODES = rounded(chebyshev(TERMS))
_SLOW_NODES = 0.5 + 0.5 * _NODES
_LN_NODES, _PER_NODES = np.log(0.25 * (_NODES + 3.0)), 4.0 / (_NODES + 3.0)
#: a row a node: what its value adds to the coefficients
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T).ravel()
#: from the middle outwards
_OUTWARDS = np.array([POINTS // 2 + (n + 1) // 2 * (-1) ** n for n in range(POINTS)])


def _powers(slow: bool) -> np.ndarray:
    """[n, k]: coefficient of t^k in T_n(t), or in T_n(2 t - 1) = T_2n(sqrt t); row after row."""
    found, step = np.zeros((TERMS, TERMS)), 2 if slow else 1
    for n in range(TERMS):
        found[n, : n + 1] = np.polynomial.chebyshev.cheb2poly(np.eye(step * n + 1)[step * n])[::step]
    return found.ravel()


def _leja(places: np.ndarray) -> np.ndarray:
    """Places in an order in which differences stay small: each is the farthest from those before."""
    found = [places.argmax()]
    while len(found) < places.size:
        found.append(np.prod(np.abs(4.0 * (places[:, None] - places[found])), axis=1).argmax())
    return np.asarray(places[found])


_POWERS, _SLOW_POWERS = _powers(False), _powers(True)
_SLOW_PLACES = _leja(0.5 + 0.5 * rounded(chebyshev(POINTS)))

#: what these kernels know: addresses of the record's arrays; of states or motions the material of each, and how many;
#: of materials their modes (:func:`..material.series.unpacked`), the numbers in front of rows, and first row, rows and
#: modes; room for the grid of one material, how many numbers, and by which stamp it was made; room for its modes, how
#: many numbers these are, and the most of any material; whether parts of M are asked for
SOURCE = np.dtype(
    [(name, np.int64) for name in ("rows", "marks", "of", "count", "packed", "limits", "counts")]
    + [(name, np.int64) for name in ("numbers", "nodes", "made", "series", "working", "columns", "pair")]
)
#: numbers in front of rows, and those of them that are sums J_j T_j of half-space and cylinder
LIMITS = OWN + 2
_T_HALF_SPACE, _T_CYLINDER = OWN, OWN + 1
#: marks: the material that is held, and its modes
HELD, _MODES = OWN_MARKS, OWN_MARKS + 1


class Grid(NamedTuple):
    """The grid of the material that is held, and the rows that are made of it."""

    rows: Any
    marks: Any
    numbers: Any
    nodes: int
    made: Any
    series: Any
    modes: int
    pair: bool
    e0: int
    stamp: int


def grid_size(count: int, alpha: float) -> int:
    """How many nodes the grid of a law has, of which so many rows are made."""
    return PER * (count + math.ceil(0.5 * math.log2(alpha)) + 4) + 2 * POINTS


def numbers_size(nodes: int) -> int:
    """How many ``numbers`` a grid of so many nodes has."""
    return _GRID + _FUNCTIONS * nodes


@kernel(allocates=True)
def hold(n, source):
    """:func:`record.hold`."""
    given = record_at(source)
    marks = integers(given.marks, PARTS)
    row = integers(given.of, given.count)[min(n, given.count - 1)]
    if marks[HELD] != row:
        marks[HELD] = row
        marks[STAMP] += 1
        counts = integers(given.counts + 8 * 3 * row, 3)
        marks[E0], marks[COUNT], marks[_MODES] = counts[0], counts[1], counts[2]
        rows, limits = doubles(given.rows, WIDTH), doubles(given.limits + 8 * LIMITS * row, LIMITS)
        for k in range(LIMITS):
            rows[k] = limits[k]
        series = doubles(given.series, given.working)
        packed = doubles(given.packed + 8 * given.columns * row, given.columns)
        for k in range(given.columns):
            series[k] = packed[k]


@kernel(allocates=True)
def make(start, source):
    """A part of a row."""
    given = record_at(source)
    marks = integers(given.marks, start // PART + 1)
    grid = Grid(
        doubles(given.rows, start + 2 * PART), marks, doubles(given.numbers, _GRID + _FUNCTIONS * given.nodes),
        given.nodes, integers(given.made, given.nodes // LANES), doubles(given.series, given.working), marks[_MODES],
        given.pair != 0 and marks[_MODES] > 0, marks[E0], marks[STAMP],
    )  # fmt: skip
    _make(start % WIDTH, start // WIDTH - 1, grid)
    marks[start // PART] = marks[STAMP]


@kernel
def _make(part, row, grid):
    """One function of a row or a pair of them."""
    over_v = part >= PRESS
    first = _L
    if part == LENGTHS:
        first = _LAM
    elif part == BODIES:
        first = _HALF_SPACE
    elif over_v:
        first = _PRESS if part == PRESS else _SHARE
    if row == 0:
        _slow_points(first, over_v, grid)
    else:
        _points(row, first, over_v, grid)
    count, numbers = 1 if over_v else 2, grid.numbers
    _differences(count, numbers)
    for which in range(count):
        _read(_SLOW_NODES if row == 0 else _LN_NODES, _D + (2 * which + 1) * _ROOM, numbers)
        if row > 0 and not (over_v or first + which == _L or first + which == _EPSILON):
            scale = math.ldexp(1.0, int(-grid.e0 - row))
            for k in range(TERMS):
                numbers[_V + k] *= _PER_NODES[k] * scale
        step, to = (1, (row + 1) * WIDTH + part) if over_v else (2, (row + 1) * WIDTH + part + 2 * which)
        if row == 0:
            _turn_slow(_limit_of(first + which, grid), numbers)
            _limit(first + which, grid)
        else:
            _turn(numbers)
        for k in range(TERMS):
            grid.rows[to + (k // 2) * (2 * step) + k % 2] = numbers[_V + k]


@kernel(inline=True)
def _limit(function, grid):
    """In the slow row functions go without their limits: put these in."""
    numbers, limit = grid.numbers, _limit_of(function, grid)
    if function == _EPSILON:  # is over t
        for k in range(TERMS - 1, 0, -1):
            numbers[_V + k] = numbers[_V + k - 1]
        numbers[_V], numbers[_V + 1] = 0.0, numbers[_V + 1] + limit
    else:
        numbers[_V] += limit


@kernel(inline=True)
def _limit_of(function, grid):
    """As u or v -> 0; of epsilon over t."""
    T_mean = grid.rows[_T_HALF_SPACE] + grid.rows[_T_CYLINDER]
    if function == _EPSILON:
        return math.ldexp(T_mean, int(grid.e0))
    if function == _M:
        return T_mean
    if function == _HALF_SPACE:
        return grid.rows[_T_HALF_SPACE]
    return grid.rows[_T_CYLINDER] if function == _CYLINDER else 1.0


# --- points ---


@kernel
def _solve(places, pair, series, work):
    """g, h, m and what either body takes of m at four places."""
    values(places, False, series, work)
    if pair:
        shares(places, series, work)
    else:
        for c in range(LANES):
            work.found[AT_HALF_SPACE + c] = work.found[AT_CYLINDER + c] = 0.5 * work.found[AT_M + c]


@kernel
def _fill(n, at, grid):
    """The functions at four nodes from n on, which are nodes ``at`` of the grid."""
    series, work = unpacked(grid.series, grid.modes)
    z0, z1 = _place(n), _place(n + 1)
    z2, z3 = _place(n + 2), _place(n + 3)
    places = (z0, z1, z2, z3)
    _solve(places, grid.pair, series, work)
    nodes = grid.nodes
    for c in range(LANES):
        z, to = places[c], _GRID + at + c
        shift, rise = work.found[AT_G + c] / z, work.found[AT_H + c] / z
        lam, share = 1.0 / np.sqrt(1.0 + 2.0 * rise), 1.0 / (1.0 + shift)
        half_space, cylinder = work.found[AT_HALF_SPACE + c], work.found[AT_CYLINDER + c]
        u, ratio = 0.5 * lam / z, share / lam
        grid.numbers[to + nodes * _LN_LAM], grid.numbers[to + nodes * _LN_SHARE] = np.log(lam), np.log(share)
        grid.numbers[to + nodes * _L], grid.numbers[to + nodes * _M] = lam * (1.0 + shift), u * work.found[AT_M + c]
        grid.numbers[to + nodes * _LAM], grid.numbers[to + nodes * _EPSILON] = u * lam, shift
        grid.numbers[to + nodes * _HALF_SPACE], grid.numbers[to + nodes * _CYLINDER] = u * half_space, u * cylinder
        grid.numbers[to + nodes * _PRESS], grid.numbers[to + nodes * _SHARE] = ratio * ratio, share


@kernel(inline=True)
def _place(n):
    """z of node n."""
    return math.ldexp(_FRACTIONS[n % PER], int(n // PER))


@kernel(inline=True)
def _need(first, stop, grid):
    """Have nodes first ... stop - 1."""
    lowest = _lowest(grid)
    for n in range(first - first % LANES, stop, LANES):
        at = n - lowest
        if grid.made[at // LANES] != grid.stamp:
            grid.made[at // LANES] = grid.stamp
            _fill(n, at, grid)


@kernel(inline=True)
def _lowest(grid):
    """The first node of the grid, a multiple of four."""
    return PER * (2 - grid.e0) + POINTS - grid.nodes


@kernel(inline=True)
def _function(function, n, grid):
    """A function at node n."""
    return grid.numbers[_GRID + grid.nodes * function + n - _lowest(grid)]


@kernel(inline=True)
def _from_end(n, row, over_v, grid):
    """ln of u or v at node n over the end of an octave."""
    end = (n + PER * (grid.e0 + row)) * _STEP
    if over_v:
        return _function(_LN_SHARE, n, grid) - end
    return _function(_LN_LAM, n, grid) - (end + PER * _STEP)


@kernel(inline=True)
def _met(n, row, over_v, grid):
    """The same, of a node that may not be there yet."""
    _need(n, n + 1, grid)
    return _from_end(n, row, over_v, grid)


@kernel
def _points(row, first, over_v, grid):
    """The points around an octave."""
    middle = -0.5 * PER * _STEP
    n = -PER * (grid.e0 + row)
    steps = PER
    while abs(steps) > 1:  # u and v fall with z, by half an octave to two an octave
        steps = int(0.5 * (_met(n, row, over_v, grid) - middle) / _STEP)
        n += steps
    while not _met(n, row, over_v, grid) > middle:
        n -= 1
    while _met(n + 1, row, over_v, grid) > middle:
        n += 1
    n += 1 - POINTS // 2
    _need(n, n + POINTS, grid)
    for k in range(POINTS):
        at = n + _OUTWARDS[k]
        grid.numbers[_X + LANES + k] = _from_end(at, row, over_v, grid)
        grid.numbers[_D + LANES + k] = _function(first, at, grid)
        if not over_v:
            grid.numbers[_D + 2 * _ROOM + LANES + k] = _function(first + 1, at, grid)


@kernel
def _slow_points(first, over_v, grid):
    """Points over t of the slow row, from 1/z = 0 to a little beyond its end; functions less their limits."""
    series, work = unpacked(grid.series, grid.modes)
    top, numbers = math.ldexp(1.0, int(grid.e0)), grid.numbers
    w = top if over_v else 2.0 * top
    w *= 1.0 + 1.25 * (grid.rows[_T_HALF_SPACE] + grid.rows[_T_CYLINDER]) * w
    for n in range(0, POINTS, LANES):
        z0, z1 = 1.0 / (w * _SLOW_PLACES[n]), 1.0 / (w * _SLOW_PLACES[n + 1])
        z2, z3 = 1.0 / (w * _SLOW_PLACES[n + 2]), 1.0 / (w * _SLOW_PLACES[n + 3])
        places = (z0, z1, z2, z3)
        _solve(places, grid.pair, series, work)
        for c in range(LANES):
            z, at = places[c], LANES + n + c
            shift, rise = work.found[AT_G + c] / z, work.found[AT_H + c] / z
            lam, share = 1.0 / np.sqrt(1.0 + 2.0 * rise), 1.0 / (1.0 + shift)
            numbers[_X + at] = (share if over_v else 0.5 * lam) / (z * top)
            for which in range(2):
                value = _slow_value(first + which, lam, shift, share, numbers[_X + at], c, grid, work)
                numbers[_D + 2 * which * _ROOM + at] = value


@kernel(inline=True)
def _slow_value(function, lam, shift, share, t, c, grid, work):
    """A function less its limit."""
    limit = _limit_of(function, grid)
    if function == _M:
        return work.found[AT_M + c] - limit
    if function == _HALF_SPACE:
        return work.found[AT_HALF_SPACE + c] - limit
    if function == _CYLINDER:
        return work.found[AT_CYLINDER + c] - limit
    if function == _L:
        return lam * (1.0 + shift) - limit
    if function == _LAM:
        return lam - limit
    if function == _EPSILON:
        return shift / t - limit
    return (share / lam) * (share / lam) - limit if function == _PRESS else share - limit


# --- polynomials ---


@kernel
def _differences(count, numbers):
    """Newton's divided differences, four at a time, from the last point down: behind the values of every function.

    What lies below an order's first difference is spoilt, and not asked for any more.
    """
    for which in range(count):
        at = _D + 2 * which * _ROOM + LANES
        numbers[at + _ROOM] = numbers[at]
    for order in range(1, POINTS):
        first = POINTS - LANES
        while first > order - LANES:
            here = _X + LANES + first
            apart = subtract(load(numbers, here), load(numbers, here - order))
            per = divide(spread(1.0), apart)
            for which in range(count):
                at = _D + 2 * which * _ROOM + LANES + first
                known = load(numbers, at)
                store(numbers, at, multiply(subtract(known, slide(load(numbers, at - LANES), known)), per))
            first -= LANES
        for which in range(count):
            at = _D + 2 * which * _ROOM + LANES + order
            numbers[at + _ROOM] = numbers[at]


@kernel
def _read(nodes, at, numbers):
    """Values of Newton's polynomial at the nodes of a row."""
    for k in range(0, TERMS, 3 * LANES):
        x0, x1, x2 = load(nodes, k), load(nodes, k + LANES), load(nodes, k + 2 * LANES)
        a0 = a1 = a2 = spread(numbers[at + LANES + POINTS - 1])
        for n in range(POINTS - 2, -1, -1):
            x, d = spread(numbers[_X + LANES + n]), spread(numbers[at + LANES + n])
            a0, a1, a2 = fused(subtract(x0, x), a0, d), fused(subtract(x1, x), a1, d), fused(subtract(x2, x), a2, d)
        store(numbers, _V + k, a0)
        store(numbers, _V + k + LANES, a1)
        store(numbers, _V + k + 2 * LANES, a2)


@kernel(inline=True)
def _product(matrix, given, to, numbers):
    """Of a vector and a matrix, row after row."""
    for k in range(0, TERMS, 3 * LANES):
        a0 = a1 = a2 = spread(0.0)
        for n in range(TERMS):
            x, at = spread(numbers[given + n]), TERMS * n + k
            a0, a1 = fused(load(matrix, at), x, a0), fused(load(matrix, at + LANES), x, a1)
            a2 = fused(load(matrix, at + 2 * LANES), x, a2)
        store(numbers, to + k, a0)
        store(numbers, to + k + LANES, a1)
        store(numbers, to + k + 2 * LANES, a2)


@kernel
def _turn(numbers):
    """From values at the nodes of an octave to powers of t."""
    mean = numbers[_V + TERMS // 2]
    for k in range(TERMS):
        numbers[_V + k] -= mean
    _product(_TO_CHEBYSHEV, _V, _C, numbers)
    _product(_POWERS, _C, _V, numbers)
    numbers[_V] += mean


@kernel
def _turn_slow(limit, numbers):
    """The same in the slow row, of a function less its limit: rounding is left out, which would grow by 5.8^n."""
    _product(_TO_CHEBYSHEV, _V, _C, numbers)
    least = limit
    for n in range(TERMS):
        least = max(least, abs(numbers[_C + n]))
    for n in range(TERMS):
        if n == TERMS - 1 or abs(numbers[_C + n]) < _ROUNDING * least:
            numbers[_C + n] = 0.0
    _product(_SLOW_POWERS, _C, _V, numbers)
