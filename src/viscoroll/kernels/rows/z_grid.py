"""Rows of a series or a pair each, by a grid of z that all rows of one material share: no root, no slope.

At z = 2^(n/10) the modes' formulas give lam and share = z/(z + g), and with them a point of every function over
u = lam/(2 z) and over v = share/z.  The polynomial of ln u or ln v through the 36 points around an octave
(:mod:`newton_interpolation`) is read at the nodes of that octave.  That of the slow row goes through points at
Chebyshev's places of 1/z and is one of t.  A row depends on its material alone, not on the rows that were made before.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..compile.intrinsics import floats_at, integers_at, record_at
from ..compile.jit import kernel
from ..numerics.interpolation import chebyshev, to_doubles
from ..numerics.simd4 import LANES, pack
from .contact_states import element
from .newton_interpolation import (
    ARGUMENTS,
    FUNCTION_STRIDE,
    NODE_VALUES,
    NODES,
    POINT_COUNT,
    SCRATCH_SIZE,
    VALUES,
    divided_differences,
    evaluate_at_nodes,
    to_powers,
)
from .record import E0, H_OVER_F2, MAKER_MARKS, MAKER_NUMBERS, PART_SIZE, PARTS_PER_ROW, ROW_COUNT, ROW_SIZE, VERSION
from .series import (
    G_OVER_Z,
    H_OVER_Z,
    M_CYLINDER,
    M_HALF_SPACE,
    evaluate_functions,
    evaluate_ratios,
    split_workspace,
    unpack_series,
)
from .simd_polynomial import TERMS

#: nodes of an octave of z; octaves behind the shortest time where the fast limit begins
NODES_PER_OCTAVE, FAST_LIMIT_OCTAVES = 10, 34
#: functions at the nodes: over u, L, u m, u lam, epsilon, u m of either body; over v, press and share; all in the order
#: of the parts of a row; then u, v and the logarithms that these are placed by, of lam and share
_L, _M, _LAM, _EPSILON, _HALF_SPACE, _CYLINDER, _PRESS, _SHARE, _U, _V, _LN_LAM, _LN_SHARE = range(12)
_FUNCTIONS = 12
_STEP = math.log(2.0) / NODES_PER_OCTAVE

_FRACTIONS = np.exp2(np.arange(NODES_PER_OCTAVE) / NODES_PER_OCTAVE)
_SLOW_NODES = 0.5 + 0.5 * NODES
_LN_NODES, _PER_NODES = np.log(0.25 * (NODES + 3.0)), 4.0 / (NODES + 3.0)
#: from the middle outwards
_OUTWARDS = np.array([POINT_COUNT // 2 + (n + 1) // 2 * (-1) ** n for n in range(POINT_COUNT)])


def _leja(places: np.ndarray) -> np.ndarray:
    """Places in an order in which differences stay small: each is the farthest from those before."""
    found = [places.argmax()]
    while len(found) < places.size:
        found.append(np.prod(np.abs(4.0 * (places[:, None] - places[found])), axis=1).argmax())
    return np.asarray(places[found])


_SLOW_PLACES = _leja(0.5 + 0.5 * to_doubles(chebyshev(POINT_COUNT)))

#: what these kernels know: addresses of the record's arrays; of states or motions the material of each, and how many;
#: of materials their numbers, and how many; room for the grid of one material, how many nodes, and by which stamp they
#: were made; room for its modes, and how many numbers; whether parts of M are asked for
SOURCE = np.dtype(
    [(name, np.int64) for name in ("rows", "marks", "material_index", "state_count", "materials", "material_size")]
    + [(name, np.int64) for name in ("numbers", "node_count", "node_versions", "workspace", "workspace_size", "unlike")]
)
#: numbers of a material: those in front of rows, of which the last are sums J_j T_j of half-space and cylinder; first
#: row, rows, modes; then its modes (:func:`.series.unpacked`)
_T_HALF_SPACE, _T_CYLINDER, FIRST_EXPONENT = range(MAKER_NUMBERS, MAKER_NUMBERS + 3)
SERIES_START = FIRST_EXPONENT + 3
#: marks: the material that is held, its modes, and where its numbers lie
SELECTED, _MODES, _MATERIAL = range(MAKER_MARKS, MAKER_MARKS + 3)


class Grid(NamedTuple):
    """The grid of the material that is held, and the rows that are made of it."""

    rows: Any
    numbers: Any
    functions: Any
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
    nodes = NODES_PER_OCTAVE * (count + math.ceil(0.5 * math.log2(alpha)) + 4) + 3 * POINT_COUNT + LANES
    return nodes + -nodes % LANES


def work_size(nodes: int) -> int:
    """How many ``numbers`` a grid of so many nodes has."""
    return SCRATCH_SIZE + _FUNCTIONS * nodes


@kernel(allocates=True)
def select_series(n, source):
    """:func:`record.hold`."""
    given = record_at(source)
    marks = integers_at(given.marks, PARTS_PER_ROW)
    row = element(integers_at(given.material_index, given.state_count), n)
    if marks[SELECTED] != row:
        marks[SELECTED] = row
        marks[VERSION] += 1
        marks[_MATERIAL] = given.materials + 8 * given.material_size * row
        rows, numbers = floats_at(given.rows, ROW_SIZE), floats_at(marks[_MATERIAL], SERIES_START)
        for k in range(FIRST_EXPONENT):
            rows[k] = numbers[k]
        marks[E0], marks[ROW_COUNT], marks[_MODES] = (
            numbers[FIRST_EXPONENT],
            numbers[FIRST_EXPONENT + 1],
            numbers[FIRST_EXPONENT + 2],
        )


@kernel(allocates=True)
def make_part(start, source):
    """A part of a row."""
    given = record_at(source)
    marks = integers_at(given.marks, start // PART_SIZE + 1)
    e0, nodes = marks[E0], given.node_count
    lowest = (
        NODES_PER_OCTAVE * (2 - e0) + 2 * POINT_COUNT + LANES - nodes
    )  # the next below it that is a multiple of four
    numbers = floats_at(given.numbers, SCRATCH_SIZE + _FUNCTIONS * nodes)
    grid = Grid(
        floats_at(given.rows, start + 2 * PART_SIZE), numbers, numbers[SCRATCH_SIZE:].reshape(nodes, _FUNCTIONS), nodes,
        integers_at(given.node_versions, nodes // LANES),
        floats_at(marks[_MATERIAL] + 8 * SERIES_START, given.material_size - SERIES_START),
        floats_at(given.workspace, given.workspace_size), marks[_MODES], given.unlike != 0 and marks[_MODES] > 0, e0,
        marks[VERSION], lowest - lowest % LANES,
    )  # fmt: skip
    _make(start % ROW_SIZE, start // ROW_SIZE - 1, grid)
    marks[start // PART_SIZE] = marks[VERSION]


@kernel
def _make(part, row, grid):
    """One function of a row or a pair of them."""
    over_v, slow, numbers = part >= H_OVER_F2, row == 0, grid.numbers
    first, count = part // PART_SIZE, 1 if over_v else 2
    if slow:
        _slow_points(first, count, over_v, grid)
    else:
        _points(row, first, count, over_v, grid)
    divided_differences(count, numbers)
    for which in range(count):
        function, limit = first + which, 0.0
        evaluate_at_nodes(_SLOW_NODES if slow else _LN_NODES, which, numbers)
        if slow:
            limit = _limit(function, grid)
        elif _over_u(function):
            scale = math.ldexp(1.0, int(-grid.e0 - row))
            for k in range(TERMS):
                numbers[NODE_VALUES + k] *= _PER_NODES[k] * scale
        to_powers(slow, limit, numbers)
        shift = 1 if slow and function == _EPSILON else 0  # it is over t
        to = (row + 1) * ROW_SIZE + part + 2 * which
        grid.rows[to] = 0.0
        for k in range(shift, TERMS):
            grid.rows[to + (k // 2) * (2 * count) + k % 2] = numbers[NODE_VALUES + k - shift]


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


@kernel(inline=True)
def _place(at, grid):
    """z of a node."""
    slow, n = at - (grid.nodes - POINT_COUNT), at + grid.lowest
    if slow < 0:
        return math.ldexp(_FRACTIONS[n % NODES_PER_OCTAVE], int(n // NODES_PER_OCTAVE))
    end = math.ldexp(1.0, int(grid.e0))
    return 0.5 / (end * (1.0 + 2.5 * (grid.rows[_T_HALF_SPACE] + grid.rows[_T_CYLINDER]) * end) * _SLOW_PLACES[slow])


@kernel
def _fill(at, grid):
    """The functions at the four nodes from ``at`` on."""
    places = _place(at, grid), _place(at + 1, grid), _place(at + 2, grid), _place(at + 3, grid)
    series, work = unpack_series(grid.series, grid.modes, grid.unlike), split_workspace(grid.room, grid.modes)
    evaluate_ratios(places, series, work)
    evaluate_functions(False, pack(places[0], places[1], places[2], places[3]), series, work)
    for c in range(LANES):
        shift, rise = work.found[LANES * G_OVER_Z + c], work.found[LANES * H_OVER_Z + c]
        half_space, cylinder = work.found[LANES * M_HALF_SPACE + c], work.found[LANES * M_CYLINDER + c]
        per_z, per_lam, share = 1.0 / places[c], np.sqrt(1.0 + 2.0 * rise), 1.0 / (1.0 + shift)
        lam, ratio, node = 1.0 / per_lam, share * per_lam, grid.functions[at + c]
        u = 0.5 * lam * per_z
        node[_L], node[_M], node[_LAM], node[_EPSILON] = (
            lam * (1.0 + shift),
            u * (half_space + cylinder),
            u * lam,
            shift,
        )
        node[_HALF_SPACE], node[_CYLINDER] = u * half_space, u * cylinder
        node[_PRESS], node[_SHARE], node[_U], node[_V] = ratio * ratio, share, u, share * per_z
        node[_LN_LAM], node[_LN_SHARE] = np.log(lam), np.log(share)


@kernel(inline=True)
def _need(first, stop, grid):
    """Have nodes first ... stop - 1."""
    for block in range(first // LANES, (stop - 1) // LANES + 1):
        if grid.made[block] != grid.stamp:
            grid.made[block] = grid.stamp
            _fill(LANES * block, grid)


@kernel(inline=True)
def _from_end(at, row, over_v, grid):
    """ln of u or v at a node over the end of an octave."""
    _need(at, at + 1, grid)
    end = (at + grid.lowest + NODES_PER_OCTAVE * (grid.e0 + row)) * _STEP
    return (
        grid.functions[at, _LN_SHARE] - end
        if over_v
        else grid.functions[at, _LN_LAM] - (end + NODES_PER_OCTAVE * _STEP)
    )


@kernel
def _points(row, first, count, over_v, grid):
    """The points around an octave."""
    middle = -0.5 * NODES_PER_OCTAVE * _STEP
    at = -NODES_PER_OCTAVE * (grid.e0 + row) - grid.lowest
    steps = NODES_PER_OCTAVE
    while abs(steps) > 1:  # u and v fall with z, by half an octave to two an octave
        steps = int(0.5 * (_from_end(at, row, over_v, grid) - middle) / _STEP)
        at += steps
    while not _from_end(at, row, over_v, grid) > middle:
        at -= 1
    while _from_end(at + 1, row, over_v, grid) > middle:
        at += 1
    at += 1 - POINT_COUNT // 2
    for k in range(POINT_COUNT):
        there = at + _OUTWARDS[k]
        grid.numbers[ARGUMENTS + k] = _from_end(there, row, over_v, grid)
        for which in range(count):
            grid.numbers[VALUES + FUNCTION_STRIDE * which + k] = grid.functions[there, first + which]


@kernel
def _slow_points(first, count, over_v, grid):
    """Points over t of the slow row, from 1/z = 0 to a little beyond its end; functions less their limits."""
    numbers, end = grid.numbers, math.ldexp(1.0, int(grid.e0))
    _need(grid.nodes - POINT_COUNT, grid.nodes, grid)
    for k in range(POINT_COUNT):
        node = grid.functions[grid.nodes - POINT_COUNT + k]
        x = node[_V] if over_v else node[_U]
        numbers[ARGUMENTS + k] = x / end
        for which in range(count):
            function = first + which
            scale = x if _over_u(function) else x / end if function == _EPSILON else 1.0
            numbers[VALUES + FUNCTION_STRIDE * which + k] = node[function] / scale - _limit(function, grid)
