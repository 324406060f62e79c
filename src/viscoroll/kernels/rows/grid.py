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
from ..numerics.four import LANES, four, fused, load, slide, spread, store
from ..numerics.nodes import chebyshev, powers_of_chebyshev, rounded, to_chebyshev
from .lanes import TERMS
from .record import COUNT, E0, OWN, OWN_MARKS, PART, PARTS, PRESS, STAMP, WIDTH
from .series import CYLINDER, HALF_SPACE, RISE, SHIFT, ratios, room_in, unpacked, values

#: nodes of an octave of z; points of a polynomial; octaves behind the shortest time where the fast limit begins
PER, POINTS, FAST = 10, 36, 34
#: functions at the nodes: over u, L, u m, u lam, epsilon, u m of either body; over v, press and share; all in the order
#: of the parts of a row; then u, v and the logarithms that these are placed by, of lam and share
_L, _M, _LAM, _EPSILON, _HALF_SPACE, _CYLINDER, _PRESS, _SHARE, _U, _V, _LN_LAM, _LN_SHARE = range(12)
_FUNCTIONS = 12
#: where scratch begins in ``numbers``: arguments of the points, four in front that are no points, then twice values and
#: their differences; values at the nodes of a row, Chebyshev coefficients; the functions at the nodes of the grid
_ROOM = LANES + POINTS
_X, _D, _Y, _C, _GRID = 0, _ROOM, 5 * _ROOM, 5 * _ROOM + TERMS, 5 * _ROOM + 2 * TERMS
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


def _leja(places: np.ndarray) -> np.ndarray:
    """Places in an order in which differences stay small: each is the farthest from those before."""
    found = [places.argmax()]
    while len(found) < places.size:
        found.append(np.prod(np.abs(4.0 * (places[:, None] - places[found])), axis=1).argmax())
    return np.asarray(places[found])


_POWERS, _SLOW_POWERS = (powers_of_chebyshev(TERMS, shift, 1.0 + shift).ravel() for shift in (0.0, 1.0))
_SLOW_PLACES = _leja(0.5 + 0.5 * rounded(chebyshev(POINTS)))

#: what these kernels know: addresses of the record's arrays; of states or motions the material of each, and how many;
#: of materials their numbers, and how many; room for the grid of one material, how many nodes, and by which stamp they
#: were made; room for its modes, and how many numbers; whether parts of M are asked for
SOURCE = np.dtype(
    [(name, np.int64) for name in ("rows", "marks", "of", "count", "materials", "columns")]
    + [(name, np.int64) for name in ("numbers", "nodes", "made", "room", "working", "unlike")]
)
#: numbers of a material: those in front of rows, of which the last are sums J_j T_j of half-space and cylinder; first
#: row, rows, modes; then its modes (:func:`.series.unpacked`)
_T_HALF_SPACE, _T_CYLINDER, LIMITS = OWN, OWN + 1, OWN + 2
FRONT = LIMITS + 3
#: marks: the material that is held, its modes, and where its numbers lie
HELD, _MODES, _MATERIAL = OWN_MARKS, OWN_MARKS + 1, OWN_MARKS + 2


class Grid(NamedTuple):
    """The grid of the material that is held, and the rows that are made of it."""

    rows: Any
    numbers: Any
    nodes: int
    made: Any
    series: Any
    room: Any
    modes: int
    unlike: bool
    e0: int
    stamp: int
    lowest: int


def grid_size(count: int, alpha: float) -> int:
    """How many nodes the grid of a law has, of which so many rows are made: the last are those of the slow row."""
    nodes = PER * (count + math.ceil(0.5 * math.log2(alpha)) + 4) + 3 * POINTS + LANES
    return nodes + -nodes % LANES


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
        marks[_MATERIAL] = given.materials + 8 * given.columns * row
        rows, numbers = doubles(given.rows, WIDTH), doubles(marks[_MATERIAL], FRONT)
        for k in range(LIMITS):
            rows[k] = numbers[k]
        marks[E0], marks[COUNT], marks[_MODES] = numbers[LIMITS], numbers[LIMITS + 1], numbers[LIMITS + 2]


@kernel(allocates=True)
def make(start, source):
    """A part of a row."""
    given = record_at(source)
    marks = integers(given.marks, start // PART + 1)
    e0, nodes = marks[E0], given.nodes
    lowest = PER * (2 - e0) + 2 * POINTS + LANES - nodes  # the next below it that is a multiple of four
    grid = Grid(
        doubles(given.rows, start + 2 * PART), doubles(given.numbers, _GRID + _FUNCTIONS * nodes), nodes,
        integers(given.made, nodes // LANES), doubles(marks[_MATERIAL] + 8 * FRONT, given.columns - FRONT),
        doubles(given.room, given.working), marks[_MODES], given.unlike != 0 and marks[_MODES] > 0, e0, marks[STAMP],
        lowest - lowest % LANES,
    )  # fmt: skip
    _make(start % WIDTH, start // WIDTH - 1, grid)
    marks[start // PART] = marks[STAMP]


@kernel
def _make(part, row, grid):
    """One function of a row or a pair of them."""
    over_v, numbers = part >= PRESS, grid.numbers
    first, count = part // PART, 1 if over_v else 2
    if row == 0:
        _slow_points(first, count, over_v, grid)
    else:
        _points(row, first, count, over_v, grid)
    _differences(count, numbers)
    for which in range(count):
        function = first + which
        _read(_SLOW_NODES if row == 0 else _LN_NODES, _D + (2 * which + 1) * _ROOM, numbers)
        if row == 0:
            _turn_slow(function, _limit(function, grid), numbers)
        else:
            if _over_u(function):
                scale = math.ldexp(1.0, int(-grid.e0 - row))
                for k in range(TERMS):
                    numbers[_Y + k] *= _PER_NODES[k] * scale
            _turn(numbers)
        to = (row + 1) * WIDTH + part + 2 * which
        for k in range(TERMS):
            grid.rows[to + (k // 2) * (2 * count) + k % 2] = numbers[_Y + k]


@kernel(inline=True)
def _over_u(function):
    """Whether a function is known times u."""
    return function == _M or function == _LAM or function == _HALF_SPACE or function == _CYLINDER


@kernel(inline=True)
def _limit(function, grid):
    """As u or v -> 0; of epsilon over t."""
    half_space, cylinder = grid.rows[_T_HALF_SPACE], grid.rows[_T_CYLINDER]
    if function == _EPSILON:
        return math.ldexp(half_space + cylinder, int(grid.e0))
    if function == _M:
        return half_space + cylinder
    return half_space if function == _HALF_SPACE else cylinder if function == _CYLINDER else 1.0


# --- points ---


@kernel
def _fill(places, at, grid):
    """The functions at four places of z, which are nodes ``at`` of the grid."""
    series, work = unpacked(grid.series, grid.modes, grid.unlike), room_in(grid.room, grid.modes)
    ratios(places, series, work)
    values(False, four(places[0], places[1], places[2], places[3]), series, work)
    numbers, nodes = grid.numbers, grid.nodes
    for c in range(LANES):
        z, to = places[c], _GRID + at + c
        shift, rise = work.found[LANES * SHIFT + c], work.found[LANES * RISE + c]
        half_space, cylinder = work.found[LANES * HALF_SPACE + c], work.found[LANES * CYLINDER + c]
        lam, share = 1.0 / np.sqrt(1.0 + 2.0 * rise), 1.0 / (1.0 + shift)
        u, ratio = 0.5 * lam / z, share / lam
        numbers[to + nodes * _L], numbers[to + nodes * _M] = lam * (1.0 + shift), u * (half_space + cylinder)
        numbers[to + nodes * _LAM], numbers[to + nodes * _EPSILON] = u * lam, shift
        numbers[to + nodes * _HALF_SPACE], numbers[to + nodes * _CYLINDER] = u * half_space, u * cylinder
        numbers[to + nodes * _PRESS], numbers[to + nodes * _SHARE] = ratio * ratio, share
        numbers[to + nodes * _U], numbers[to + nodes * _V] = u, share / z
        numbers[to + nodes * _LN_LAM], numbers[to + nodes * _LN_SHARE] = np.log(lam), np.log(share)


@kernel(inline=True)
def _missing(at, grid):
    """Whether four nodes are to be filled; they count as filled from now on."""
    missing = grid.made[at // LANES] != grid.stamp
    grid.made[at // LANES] = grid.stamp
    return missing


@kernel(inline=True)
def _place(n):
    """z of node n."""
    return math.ldexp(_FRACTIONS[n % PER], int(n // PER))


@kernel(inline=True)
def _need(first, stop, grid):
    """Have nodes first ... stop - 1."""
    for n in range(first - first % LANES, stop, LANES):
        if _missing(n - grid.lowest, grid):
            _fill((_place(n), _place(n + 1), _place(n + 2), _place(n + 3)), n - grid.lowest, grid)


@kernel(inline=True)
def _from_end(n, row, over_v, grid):
    """ln of u or v at node n, which is there, over the end of an octave."""
    end, at = (n + PER * (grid.e0 + row)) * _STEP, _GRID + n - grid.lowest
    if over_v:
        return grid.numbers[at + grid.nodes * _LN_SHARE] - end
    return grid.numbers[at + grid.nodes * _LN_LAM] - (end + PER * _STEP)


@kernel(inline=True)
def _met(n, row, over_v, grid):
    """The same, of a node that may not be there yet."""
    _need(n, n + 1, grid)
    return _from_end(n, row, over_v, grid)


@kernel
def _points(row, first, count, over_v, grid):
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
        for which in range(count):
            value = grid.numbers[_GRID + at - grid.lowest + grid.nodes * (first + which)]
            grid.numbers[_D + 2 * which * _ROOM + LANES + k] = value


@kernel
def _slow_points(first, count, over_v, grid):
    """Points over t of the slow row, from 1/z = 0 to a little beyond its end; functions less their limits."""
    numbers, end = grid.numbers, math.ldexp(1.0, int(grid.e0))
    w = 2.0 * end * (1.0 + 2.5 * (grid.rows[_T_HALF_SPACE] + grid.rows[_T_CYLINDER]) * end)
    for n in range(0, POINTS, LANES):
        at = grid.nodes - POINTS + n
        if _missing(at, grid):
            z0, z1 = 1.0 / (w * _SLOW_PLACES[n]), 1.0 / (w * _SLOW_PLACES[n + 1])
            z2, z3 = 1.0 / (w * _SLOW_PLACES[n + 2]), 1.0 / (w * _SLOW_PLACES[n + 3])
            _fill((z0, z1, z2, z3), at, grid)
        for k in range(LANES):
            from_, to = _GRID + at + k, LANES + n + k
            x = numbers[from_ + grid.nodes * (_V if over_v else _U)]
            numbers[_X + to] = x / end
            for which in range(count):
                function = first + which
                value = numbers[from_ + grid.nodes * function]
                if _over_u(function):
                    value /= x
                elif function == _EPSILON:
                    value /= x / end
                numbers[_D + 2 * which * _ROOM + to] = value - _limit(function, grid)


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
            per = 1.0 / (load(numbers, here) - load(numbers, here - order))
            for which in range(count):
                at = _D + 2 * which * _ROOM + LANES + first
                known = load(numbers, at)
                store(numbers, at, (known - slide(load(numbers, at - LANES), known)) * per)
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
            a0, a1, a2 = fused(x0 - x, a0, d), fused(x1 - x, a1, d), fused(x2 - x, a2, d)
        store(numbers, _Y + k, a0)
        store(numbers, _Y + k + LANES, a1)
        store(numbers, _Y + k + 2 * LANES, a2)


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
    mean = numbers[_Y + TERMS // 2]
    for k in range(TERMS):
        numbers[_Y + k] -= mean
    _product(_TO_CHEBYSHEV, _Y, _C, numbers)
    _product(_POWERS, _C, _Y, numbers)
    numbers[_Y] += mean


@kernel
def _turn_slow(function, limit, numbers):
    """The same in the slow row, of a function less its limit: rounding is left out, which would grow by 5.8^n."""
    _product(_TO_CHEBYSHEV, _Y, _C, numbers)
    least = limit
    for n in range(TERMS):
        least = max(least, abs(numbers[_C + n]))
    for n in range(TERMS):
        if n == TERMS - 1 or abs(numbers[_C + n]) < _ROUNDING * least:
            numbers[_C + n] = 0.0
    _product(_SLOW_POWERS, _C, _Y, numbers)
    numbers[_Y] += limit
    if function == _EPSILON:  # over t
        for k in range(TERMS - 1, 0, -1):
            numbers[_Y + k] = numbers[_Y + k - 1]
        numbers[_Y] = 0.0
