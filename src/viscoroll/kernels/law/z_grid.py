"""Rows for one series or pair after another, from a grid of z that all rows of a material share.

Terms of this file (g, h and the formulas of the modes are those of :mod:`.material_series`):

- z: half the transit time of the contact or of its stick zone, in the unit of time of the material.
- u = kappa |V|, dimensionless speed, and v = 1/F(eta) of a stick zone with the half transit time
  eta (:mod:`.law_functions`).  Functions of u: L = 2 kappa delta_star/mu, M/V and its parts, lam
  (length of the contact divided by l0), epsilon (shift in half contact lengths); of v: H/F^2 and
  eta/F.
- Row 0, the slow row, spans 0 <= u, v < 2^e0 with t = u 2^-e0 or v 2^-e0; row n > 0 is the octave
  that ends at 2^(e0 + n), with t in [-1, 1).
- Part: the place of one function in a row, PART_SIZE numbers; a pair of functions takes two.
- Head: numbers of the law as a whole, in front of its rows, and likewise in front of the marks of
  its parts.
- Marks: integers beside the rows, some for the law as a whole, then for each part of each row the
  version of the material for which it was computed.
- Selected material: that of which the law holds the rows at present; each new one gets the next
  version number.
- J_j, T_j: strengths and times of the creep modes of a material.

At the nodes z = 2^(n/10) the formulas of the modes give lam and eta/F = z/(z + g), and with them a
point of every function over u = lam/(2 z) and over v = (eta/F)/z.  The polynomial in ln u or ln v
through the 36 points around an octave (:mod:`.newton_polynomial`) is evaluated at the nodes of that
octave.  The polynomial of the slow row goes through points at Chebyshev nodes of 1/z and is one in
t.  No root is solved for and no slope is needed (docs/internals_law.md, Series and pairs).  A row
depends on its material alone, not on the rows that were made before.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..numerics.interpolation import chebyshev, to_doubles
from ..numerics.intrinsics import floats_at, integers_at, record_at, record_type
from ..numerics.jit import inline_kernel, kernel
from ..numerics.newton_polynomial import (
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
from ..numerics.simd import LANES, TERMS, pack, unpack
from .law_record import (
    E0,
    H_OVER_F2,
    MAKER_MARKS,
    MAKER_NUMBERS,
    PART_SIZE,
    PARTS_PER_ROW,
    ROW_COUNT,
    ROW_SIZE,
    VERSION,
    select_index,
)
from .material_series import (
    G_OVER_Z,
    H_OVER_Z,
    M_CYLINDER,
    M_HALF_SPACE,
    evaluate_functions,
    evaluate_ratios,
    split_workspace,
    unpack_series,
)

#: Nodes of an octave of z: 6 of them leave an error of 3e-12 in lam, 10 that of rounding (against
#: 40 digits).
NODES_PER_OCTAVE = 10
#: Octaves beyond the inverse of the shortest time, after which the fast limit begins: there it is
#: good to rounding.
FAST_LIMIT_OCTAVES = 34

# Functions at a node, in the order of the parts of a row.
#: L over u.
_L = 0
#: u m, with m = M/V.
_M = 1
#: u lam.
_LAM = 2
#: epsilon over u.
_EPSILON = 3
#: u m of the half-space.
_HALF_SPACE = 4
#: u m of the cylinder.
_CYLINDER = 5
#: H/F^2 over v.
_H_OVER_F2 = 6
#: eta/F over v.
_ETA_OVER_F = 7
#: The variable u itself.
_U = 8
#: The variable v itself.
_V = 9
#: ln lam, by which u is located: ln u = ln lam - ln(2 z).
_LN_LAM = 10
#: ln(eta/F), by which v is located: ln v = ln(eta/F) - ln z.
_LN_ETA_OVER_F = 11
#: Numbers of a node.
_FUNCTIONS = 12

#: Difference of ln z between nodes.
_STEP = math.log(2.0) / NODES_PER_OCTAVE
#: Nodes in [1, 2).
_FRACTIONS = np.exp2(np.arange(NODES_PER_OCTAVE) / NODES_PER_OCTAVE)
#: Nodes of the slow row in its t, which is in [0, 1].
_SLOW_NODES = 0.5 + 0.5 * NODES
#: ln of the nodes of a row, as fractions of the end of its octave.
_LN_NODES = np.log(0.25 * (NODES + 3.0))
#: Inverse of the nodes of a row, as fractions of the end of its octave.
_INVERSE_NODES = 4.0 / (NODES + 3.0)
#: Numbers 0 to 35 from the middle outwards, the order of the points in Newton's polynomial.
_OUTWARDS = np.array([POINT_COUNT // 2 + (n + 1) // 2 * (-1) ** n for n in range(POINT_COUNT)])


def _leja_order(points: np.ndarray) -> np.ndarray:
    """Return points in an order in which divided differences stay small.

    The first is the largest.  Each further one has the largest product of distances from those
    before it (Leja's order).

    points : (n,) floats, different from each other, n > 0, in [0, 1] (distances are scaled for that
        range).
    Returns a new array, (n,), of the same numbers in this order; of equal products the one earlier
    in ``points``.
    """
    order = [points.argmax()]
    while len(order) < points.size:
        order.append(np.prod(np.abs(4.0 * (points[:, None] - points[order])), axis=1).argmax())
    return np.asarray(points[order])


#: Points of the slow row as fractions of the end of 1/z, in their order in Newton's polynomial.
_SLOW_POINTS = _leja_order(0.5 + 0.5 * to_doubles(chebyshev(POINT_COUNT)))

#: What these kernels read.  Addresses: rows and marks of the law; the index of the material of each
#: state; the numbers of the materials; scratch for the grid (``numbers``); the versions of its
#: blocks of four nodes; the workspace of the modes.  state_count: length of the indices, 1 or one
#: for each state.  material_size: numbers of a material.
#: node_count: nodes of the grid.  workspace_size: numbers of the workspace.  unlike: whether the
#: bodies differ.
SOURCE = record_type(
    "rows marks material_index state_count materials material_size "
    "numbers node_count node_versions workspace workspace_size unlike"
)
#: Number of a material, and of the head of rows: sum J_j T_j of the half-space; after it that of
#: the cylinder.
_T_HALF_SPACE = MAKER_NUMBERS
#: Number of a material: exponent e0 of its first row; after it the number of rows, and the number
#: of modes.
FIRST_EXPONENT = MAKER_NUMBERS + 2
#: Number of a material where its modes begin (:func:`.material_series.unpack_series`).
SERIES_START = FIRST_EXPONENT + 3
#: Mark that is the number of modes of the selected material.
_MODES = MAKER_MARKS
#: Mark that is the address of its numbers.
_MATERIAL = MAKER_MARKS + 1


class Grid(NamedTuple):
    """The grid of the selected material, and the rows that are made from it.

    rows : vector of the law with its head, up to the part that is made and one more, written.
    scratch : vector of :mod:`.newton_polynomial`.
    functions : (node_count, 12), values at the nodes in the order of _L to _LN_ETA_OVER_F; the last
        36 nodes are the points of the slow row.
    node_count : int.
    node_versions : version for which each block of four nodes was made, (node_count/4,).
    series, workspace, modes, unlike : arguments of :func:`.material_series.unpack_series` and
        :func:`.material_series.split_workspace`.
    e0 : exponent of the first row, [0, 2^e0).
    version : that of the selected material.
    lowest : n of node 0, where z = 2^(n/10), a multiple of four.
    """

    rows: Any
    scratch: Any
    functions: Any
    node_count: int
    node_versions: Any
    series: Any
    workspace: Any
    modes: int
    unlike: bool
    e0: int
    version: int
    lowest: int


def grid_size(count: int, alpha: float) -> int:
    """Return the number of nodes of a grid from which rows of a law can be made.

    count : int, number of rows, >= 1; the largest one of many materials.
    alpha : float, instantaneous divided by long-time modulus of the material, >= 1; the largest one
        of many materials.
    Returns an int, a multiple of four, which includes the 36 points of the slow row: ten nodes for
    each octave of z that the rows need, and reserves at both ends for the 36 points around an
    octave.
    """
    # lam = 2 u z falls from 1 to alpha^(-1/2): z spans as many octaves as u and half those of alpha
    # more.  Two octaves are spare at either end, and there the points around the first and the last
    # octave reach on; the third POINT_COUNT is the points of the slow row, LANES the rounding of
    # the first node to a multiple of four (make_part).
    nodes = (
        NODES_PER_OCTAVE * (count + math.ceil(0.5 * math.log2(alpha)) + 4) + 3 * POINT_COUNT + LANES
    )
    return nodes + -nodes % LANES


def work_size(nodes: int) -> int:
    """Return the number of doubles of the scratch of a grid: that of
    :mod:`.newton_polynomial`, then twelve functions at each node; an int.

    nodes : int, number of nodes, as of :func:`grid_size`.
    """
    return SCRATCH_SIZE + _FUNCTIONS * nodes


@kernel(allocates=True)
def select_series(n, source):
    """Make the material of a state the selected one: write its data into the heads of rows and
    marks.

    n : int, index of the state, >= 0, of those for which the law was made; not checked.
    source : pointer to a SOURCE record, of which the addresses of the materials, their indices,
        rows and marks are read, with state_count and material_size.  If that material is selected
        already, nothing is written.  Else the first ten numbers of the material (alpha, lam_fast, W
        and C three times, sums J_j T_j of both bodies) are written into the head of rows, and into
        that of marks its exponent e0, its number of rows and of modes, the address of its numbers,
        its index and a new version.

    Rows of the law are then computed when they are first read (:func:`make_part`).  Returns
    nothing.
    """
    source = record_at(source)
    marks = integers_at(source.marks, PARTS_PER_ROW)
    index = select_index(n, source.material_index, source.state_count, marks)
    if index >= 0:
        marks[_MATERIAL] = source.materials + 8 * source.material_size * index  # bytes of doubles
        rows = floats_at(source.rows, ROW_SIZE)
        numbers = floats_at(marks[_MATERIAL], SERIES_START)
        # the first numbers of a material are in the order of the head of rows, up to T of the
        # cylinder; the next three are integers stored as doubles, exactly
        for k in range(FIRST_EXPONENT):
            rows[k] = numbers[k]
        marks[E0] = numbers[FIRST_EXPONENT]
        marks[ROW_COUNT] = numbers[FIRST_EXPONENT + 1]
        marks[_MODES] = numbers[FIRST_EXPONENT + 2]


@kernel(allocates=True)
def make_part(number, source):
    """Compute a part of a row of the selected material, and write it into the rows of the law.

    number : int, index of the part among the marks: (row + 1) PARTS_PER_ROW + k, with the row from
        0 and k, the number of the part in its row; of a pair of functions that of its first part.
    source : pointer to a SOURCE record, of which all fields are read but material_index,
        state_count, and materials, since the marks hold the address of the selected one.

    Returns nothing.  Written are the 24 coefficients of the function, or 48 of a pair, in the rows;
    the version of the material as mark ``number``, of a pair at its first part only; functions and
    versions of those nodes of the grid that belonged to another material; and the scratch.
    """
    source = record_at(source)
    marks = integers_at(source.marks, number + 1)
    start = PART_SIZE * number  # parts follow each other in rows as their marks do, head included
    nodes = source.node_count
    modes = marks[_MODES]
    # The first octave, from u or v = 2^e0 on, has z up to 2^-e0.  Two octaves and POINT_COUNT +
    # LANES nodes above that the grid ends; its last POINT_COUNT nodes are the points of the slow
    # row.  So n of node 0 follows from the number of nodes (grid_size).
    lowest = NODES_PER_OCTAVE * (2 - marks[E0]) + 2 * POINT_COUNT + LANES - nodes
    numbers = floats_at(source.numbers, SCRATCH_SIZE + _FUNCTIONS * nodes)
    series = floats_at(marks[_MATERIAL] + 8 * SERIES_START, source.material_size - SERIES_START)
    # blocks begin at multiples of four: the next below
    grid = Grid(
        rows=floats_at(source.rows, start + 2 * PART_SIZE),
        scratch=numbers,
        functions=numbers[SCRATCH_SIZE:].reshape(nodes, _FUNCTIONS),
        node_count=nodes,
        node_versions=integers_at(source.node_versions, nodes // LANES),
        series=series,
        workspace=floats_at(source.workspace, source.workspace_size),
        modes=modes,
        unlike=source.unlike != 0,
        e0=marks[E0],
        version=marks[VERSION],
        lowest=lowest - lowest % LANES,
    )
    _make_functions(start % ROW_SIZE, start // ROW_SIZE - 1, grid)
    marks[number] = marks[VERSION]


@kernel
def _make_functions(part, row, grid):
    """Compute one function of v, or a pair of functions of u, for one row, and write the
    coefficients of the powers of t.

    part : int, offset in a row: LENGTH_MOMENT, LAM_EPSILON or BODY_MOMENTS of a pair of functions
        of u, H_OVER_F2 or ETA_OVER_F of a function of v.
    row : int, index of the row, from 0; row 0 is the slow row, where t is in [0, 1], else t is in
        [-1, 1].
    grid : :class:`Grid` of function values over ln z of the selected material.  Into its ``rows``
        24 coefficients are written, the constant first, or 48 of a pair, interleaved by two
        (:mod:`.simd`).  In the slow row the constant is the exact limit at rest (0 of
        epsilon).  Nodes that hold values of another material are computed, and the scratch is
        overwritten.  Returns nothing.
    """
    over_v = part >= H_OVER_F2  # the parts of single functions, of v, are behind those of pairs
    slow = row == 0
    scratch = grid.scratch
    first = part // PART_SIZE  # column of the (first) function in the grid
    count = 1 if over_v else 2
    if slow:
        _collect_slow_points(first, count, over_v, grid)
    else:
        _collect_points(row, first, count, over_v, grid)
    divided_differences(count, scratch)
    for which in range(count):
        function = first + which
        limit = 0.0
        evaluate_at_nodes(_SLOW_NODES if slow else _LN_NODES, which, scratch)
        if slow:
            limit = _slow_limit(function, grid)
        elif _is_times_u(function):  # Values at the nodes are divided by u again.
            # 1/u at a node: 1 over its fraction of the end of the octave, over that end
            scale = math.ldexp(1.0, int(-grid.e0 - row))
            for k in range(TERMS):
                scratch[NODE_VALUES + k] *= _INVERSE_NODES[k] * scale
        to_powers(slow, limit, scratch)
        shift = 1 if slow and function == _EPSILON else 0  # the polynomial is that of epsilon/t
        # Coefficients of a pair are interleaved by two: c0 c1 of one, c0 c1 of the other, c2 c3 ...
        # With ``shift`` the constant is 0 and the highest power of epsilon/t, which to_powers has
        # set to 0 in Chebyshev form, is left out; row + 1, as the head is in front of row 0.
        to = (row + 1) * ROW_SIZE + part + 2 * which
        grid.rows[to] = 0.0
        for k in range(shift, TERMS):
            grid.rows[to + (k // 2) * (2 * count) + k % 2] = scratch[NODE_VALUES + k - shift]


@inline_kernel
def _is_times_u(function):
    """Return whether a function is stored at the nodes of the grid as its product with u, a bool.

    function : int, column of the function in the grid: True for _M, _LAM, _HALF_SPACE and
        _CYLINDER, else False.
    """
    return function == _M or function == _LAM or function == _HALF_SPACE or function == _CYLINDER


@inline_kernel
def _slow_limit(function, grid):
    """Return the limit of a function as u or v -> 0; for epsilon, which vanishes, that of
    epsilon/t, t = u 2^-e0.

    function : int, column of the function in the grid: _L, _M, _LAM, _EPSILON, _HALF_SPACE,
        _CYLINDER, _H_OVER_F2 or _ETA_OVER_F.
    grid : :class:`Grid` of the selected material, of which e0 and, in the head, the sums J_j T_j of
        both bodies are read.
    Returns a float, dimensionless: of M/V the sum J_j T_j of both bodies, of its parts that of one;
    of epsilon/t that of both times 2^e0; 1.0 of the other functions, L, lam, H/F^2 and eta/F.
    """
    half_space = grid.rows[_T_HALF_SPACE]
    cylinder = grid.rows[_T_HALF_SPACE + 1]
    # epsilon -> u times both sums, and t = u 2^-e0
    if function == _EPSILON:
        return math.ldexp(half_space + cylinder, int(grid.e0))
    if function == _M:
        return half_space + cylinder
    return half_space if function == _HALF_SPACE else cylinder if function == _CYLINDER else 1.0


# --- points ---


@inline_kernel
def _z_of_node(node, grid):
    """Return z, a half transit time, of a node: a power of 2^(1/10), or, of the last 36 nodes, a
    point of the slow row.

    node : int, index of the node, from 0 to node_count - 1.
    grid : :class:`Grid` of function values over ln z of the selected material.
    Returns a float, > 0, in the unit of time of the material.  Points of the slow row have 1/z
    between 0 and 2^(e0 + 1) (1 + 2.5 T), T = sum J_j T_j 2^e0 of both bodies, which is beyond the
    end of that row in u = lam/(2 z), by less than 2.5 T as lam < 1, and at about twice the end in
    v = (eta/F)/z; they are zeros of T_36 in 1/z, in Leja's order.
    """
    slow = node - (grid.node_count - POINT_COUNT)  # index of a point of the slow row; < 0: none
    n = node + grid.lowest
    if slow < 0:
        # 2^(n/10) by its fraction and its octave; % and // of a negative n round down
        return math.ldexp(_FRACTIONS[n % NODES_PER_OCTAVE], int(n // NODES_PER_OCTAVE))
    end = math.ldexp(1.0, int(grid.e0))
    T_mean = grid.rows[_T_HALF_SPACE] + grid.rows[_T_HALF_SPACE + 1]
    # the factor beside ``end`` makes up for lam, which falls below 1 with 1/z
    return 0.5 / (end * (1.0 + 2.5 * T_mean * end) * _SLOW_POINTS[slow])


@kernel
def _fill_block(first, grid):
    """Compute the 12 functions at four nodes by the formulas of the modes, and write them into
    ``grid.functions``.

    first : int, index of the first node, a multiple of four.
    grid : :class:`Grid` of the selected material.  Four rows of its ``functions`` are written,
        dimensionless, in the order of the columns: L, u M/V, u lam, epsilon, u times M/V of
        half-space and cylinder, H/F^2, eta/F, u, v, ln lam, ln(eta/F), with z as zeta of the
        contact for functions of u, as eta of its stick zone for those of v.  Its workspace is
        scratch.  Returns nothing.
    """
    places = pack(
        _z_of_node(first, grid),
        _z_of_node(first + 1, grid),
        _z_of_node(first + 2, grid),
        _z_of_node(first + 3, grid),
    )
    z = unpack(places)
    series = unpack_series(grid.series, grid.modes, grid.unlike)
    work = split_workspace(grid.workspace, grid.modes)
    evaluate_ratios(places, series, work)
    evaluate_functions(False, places, series, work)
    for c in range(LANES):
        shift = work.functions[G_OVER_Z + c]
        half_space = work.functions[M_HALF_SPACE + c]
        cylinder = work.functions[M_CYLINDER + c]
        inverse_z = 1.0 / z[c]
        # lam^-2 = 1 + 2 h/z, eta/F = z/(z + g) and H/F^2 = (eta/F)^2 (1 + 2 h/z)
        inverse_lam = np.sqrt(1.0 + 2.0 * work.functions[H_OVER_Z + c])
        eta_over_F = 1.0 / (1.0 + shift)
        lam = 1.0 / inverse_lam
        root_of_H_over_F2 = eta_over_F * inverse_lam
        u = 0.5 * lam * inverse_z
        # ``shift`` is g/z, which is epsilon, F = z (1 + g/z), H = z^2 (1 + 2 h/z) and lam =
        # z/sqrt(H).
        node = grid.functions[first + c]
        node[_L] = lam * (1.0 + shift)
        node[_M] = u * (half_space + cylinder)
        node[_LAM] = u * lam
        node[_EPSILON] = shift
        node[_HALF_SPACE] = u * half_space
        node[_CYLINDER] = u * cylinder
        node[_H_OVER_F2] = root_of_H_over_F2 * root_of_H_over_F2
        node[_ETA_OVER_F] = eta_over_F
        node[_U] = u
        node[_V] = eta_over_F * inverse_z
        node[_LN_LAM] = np.log(lam)
        node[_LN_ETA_OVER_F] = np.log(eta_over_F)


@inline_kernel
def _ensure_nodes(first, stop, grid):
    """Compute those nodes of the grid, in blocks of four, that still hold values of another
    material.

    first, stop : int, index of the first node that is needed, and of the one after the last.
    grid : :class:`Grid` of the selected material, whose ``functions`` and ``node_versions`` are
        written for blocks whose version is not that of the material; others stay.  Returns nothing.
    """
    # a node never changes within one version, so that a row does not depend on which rows were made
    # before it
    for block in range(first // LANES, (stop - 1) // LANES + 1):
        if grid.node_versions[block] != grid.version:
            grid.node_versions[block] = grid.version
            _fill_block(LANES * block, grid)


@inline_kernel
def _ln_from_end(node, row, over_v, grid):
    """Return ln(u/end) or ln(v/end) at a node of the grid, where end is the right end of an octave
    of u or v.

    node : int, index of the node, not one of the slow row.
    row : int, index of the row that spans the octave, whose end is 2^(e0 + row).
    over_v : bool, True for v, False for u.
    grid : :class:`Grid` of the selected material, in which the node is computed if it holds values
        of another one.
    Returns a float, dimensionless: 0 at the end of the octave, -ln 2 at its begin, > 0 beyond the
    end; it falls with growing ``node``.
    """
    _ensure_nodes(node, node + 1, grid)
    # ln z + ln of the end of the octave; the sum of integers is exact, so that only one rounding
    # is left.  ln v = ln(eta/F) - ln z, ln u = ln lam - ln z - ln 2, where ln 2 is an octave of
    # nodes.
    end = (node + grid.lowest + NODES_PER_OCTAVE * (grid.e0 + row)) * _STEP
    if over_v:
        return grid.functions[node, _LN_ETA_OVER_F] - end
    return grid.functions[node, _LN_LAM] - (end + NODES_PER_OCTAVE * _STEP)


@kernel
def _collect_points(row, first, count, over_v, grid):
    """Write the 36 points around an octave of u or v into the scratch of ``grid``, as arguments and
    values.

    Arguments are ln u or ln v, counted from the end of the octave.  The points are 36 nodes of the
    grid in sequence, 18 on either side of the middle of the octave in ln u or ln v, from the middle
    outwards.  That the grid reaches so far is not checked (:func:`grid_size`).

    row : int, index of the row that spans the octave, > 0.
    first : int, column of the first function in the grid, _L to _ETA_OVER_F.
    count : int, number of functions, 1, or 2 with neighbouring columns.
    over_v : bool, True if they are functions of v, False for u.
    grid : :class:`Grid` of the selected material.  Its ``scratch`` is written: 36 arguments from
        ARGUMENTS on and 36 values of each function from VALUES on, one FUNCTION_STRIDE apart:
        values as the grid has them, so that M/V, its parts and lam are multiplied by u.  Nodes that
        hold values of another material are computed.  Returns nothing.
    """
    # The node next to the middle of the octave: first by steps of half the distance in ln u or ln
    # v, then one by one.  u and v fall with z, by half an octave to two octaves in one octave of z:
    # whole distances might go back and forth where it is two.
    middle = -0.5 * NODES_PER_OCTAVE * _STEP
    node = -NODES_PER_OCTAVE * (grid.e0 + row) - grid.lowest  # z is 1/end: v = end where eta/F = 1
    steps = NODES_PER_OCTAVE  # any number above 1, to enter the loop
    while abs(steps) > 1:
        steps = int(0.5 * (_ln_from_end(node, row, over_v, grid) - middle) / _STEP)
        node += steps
    # now to the last node above the middle, whichever side the loop ended on
    while not _ln_from_end(node, row, over_v, grid) > middle:
        node -= 1
    while _ln_from_end(node + 1, row, over_v, grid) > middle:
        node += 1
    node += 1 - POINT_COUNT // 2  # the first of the 36 points
    # from the middle outwards, the order of the points in Newton's polynomial
    for k in range(POINT_COUNT):
        point = node + _OUTWARDS[k]
        grid.scratch[ARGUMENTS + k] = _ln_from_end(point, row, over_v, grid)
        for which in range(count):
            grid.scratch[VALUES + FUNCTION_STRIDE * which + k] = grid.functions[
                point, first + which
            ]


@kernel
def _collect_slow_points(first, count, over_v, grid):
    """Write the 36 points of the slow row, from 1/z near 0 to beyond its end, into the scratch of
    ``grid``: the last 36 nodes of the grid, in Leja's order (:func:`_z_of_node`).

    Arguments are t = u or v divided by the end of the row, 2^e0.  Values count from the limit t ->
    0 (:func:`_slow_limit`); epsilon is divided by t, and functions that the grid has as products
    with u are divided by u.

    first : int, column of the first function in the grid, _L to _ETA_OVER_F.
    count : int, number of functions, 1, or 2 with neighbouring columns.
    over_v : bool, True if they are functions of v, False for u.
    grid : :class:`Grid` of the selected material.  Its ``scratch`` is written: 36 arguments from
        ARGUMENTS on and 36 values of each function from VALUES on, one FUNCTION_STRIDE apart.
        Nodes that hold values of another material are computed.  Returns nothing.
    """
    end = math.ldexp(1.0, int(grid.e0))
    _ensure_nodes(grid.node_count - POINT_COUNT, grid.node_count, grid)
    for k in range(POINT_COUNT):
        node = grid.functions[grid.node_count - POINT_COUNT + k]
        x = node[_V] if over_v else node[_U]
        grid.scratch[ARGUMENTS + k] = x / end
        for which in range(count):
            function = first + which
            # the slow row is a polynomial in t, through the value at t = 0, for which the products
            # with u, which vanish there, are of no use; x is u for all of these functions
            scale = x if _is_times_u(function) else x / end if function == _EPSILON else 1.0
            grid.scratch[VALUES + FUNCTION_STRIDE * which + k] = node[
                function
            ] / scale - _slow_limit(function, grid)
