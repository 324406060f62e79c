"""The law of one scene as a table: cubic splines over speed and creep, with first derivatives, one
state at a time.

A table is one vector of doubles: a head, nodes, edges of each row, fields, each with its rows and
in them nodes.  Its speed is u = kappa |V|, its creep D = 2 kappa delta, with the slenderness kappa
= R/l0 and the creepage delta.  Three creeps divide the states of a speed, each a cubic spline of
ln u: the onset of full slip of negative sign, D_-, a creep D_0 between, and the onset of positive
sign, D_+.  With sigma = 1 above D_0 and -1 below, a state has the relative distance w from D_0 and
the coordinate t:

    w = (D - D_0)/(D_sigma - D_0),   0 <= w <= 1 in partial slip,
    t = sigma w   or   t = sigma sqrt(1 - (1 - w)^(2/3))

Each field is a tensor spline in (ln u, t), with the second form of t where the table is graded:
with this t the fields of a contact in which shear acts on pressure are smooth at D_0 and at the
onsets.
Below the first node a field is linear in u between the limit of u = 0 and that node, beyond the
last one linear in 1/u between it and the limit of u infinite.

``viscoroll.laws.law_rows`` writes the vector.  All quantities are dimensionless.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import fma4, load, pack, unpack

# Indices in the head.
#: Number of rows: limit of u = 0, nodes of ln u, limit of u infinite.
ROWS = 0
#: Number of nodes in t.
NODES = 1
#: 1 if t is graded, else 0.
GRADED = 2
#: First node of u.
FIRST = 3
#: Last node of u.
LAST = 4
#: Step of the nodes in ln u if all steps are equal, and after it the inverse; else 0.
U_STEP = 5
#: Step of the nodes in t if all steps are equal, and after it the inverse; else 0.
T_STEP = 7
#: Where the nodes of t begin; those of ln u begin at :data:`HEAD`.
T_BEGIN = 9
#: Where the edges begin.
EDGES = 10
#: Where the fields begin.
FIELDS = 11
#: Number of fields.
FIELD_COUNT = 12
#: Largest u that is allowed: 1e300, in place of infinity, for a table with the limit of u infinite;
#: else the number at LAST.
MOST = 13
#: 1 if slip is full beyond the onsets, 0 where nothing is known there.
SLIPS = 14
#: Largest |Q/mu|: 1, or infinite if the limit of friction is not known.
LIMIT = 15
#: Numbers of the head.
HEAD = 16

#: Edge: the creep D_0 between the signs.
MIDDLE = 0
#: Edge: the onset of full slip of negative sign; that of positive sign follows.
ONSET = 1
#: Edge: the creep at which Q = 0.
FREE = 3
#: Number of edges; each has a value and a slope over ln u in a row.
EDGE_COUNT = 4

#: Field: Q/mu.
TRACTION = 0
#: Field: kappa M_half_space.
HALF_SPACE = 1
#: Field: kappa M_cylinder.
CYLINDER = 2
#: Field: lam; epsilon and beta follow.
LENGTH = 3
#: Field: epsilon.
SHIFT = 4
#: Field: beta.
STICK = 5
#: Field: 2 kappa times the work of shear on the strain of the half-space; that of the cylinder
#: follows.
WORK = 6
#: Field that only graded tables have: 2 kappa times the slip loss per unit of V.
FRICTION = 8
#: Numbers of a field at a node: its value, its slopes over ln u and t, and its mixed derivative; a
#: vector of :mod:`..numerics.simd`.
JET = 4

#: Least 1 - w, the distance from the onset, for which slopes are computed: it stands for smaller
#: distances, where slopes are 0 to rounding.
_ONSET_DISTANCE = 1e-24
#: Least |t|, which stands for smaller ones: 1/|t| stays finite, and fields, which are quadratic in
#: t there, are those at D_0 exactly.
_MIDDLE_DISTANCE = 1e-170
#: Bisections of d in [-1, 1], to rounding.
_HALVINGS = 53


class Weights(NamedTuple):
    """Weights of the numbers at both ends of an interval in a spline.

    first : int, number of the row or node at the left end.
    values : weights (a0, a1, b0, b1) of the values at the left end (0) and the right one (1), then
        of the slopes there.
    slopes : their derivatives over u, or over w.
    """

    first: int
    values: tuple
    slopes: tuple


class FieldValue(NamedTuple):
    """A field of the table at a state: its value, and its derivatives with respect to u at fixed w
    and to w at fixed u.
    """

    value: float
    du: float
    dw: float


class Edge(NamedTuple):
    """A creep that divides the states of a speed, and its first and second derivative with respect
    to u.
    """

    value: float
    du: float
    ddu: float


class Interval(NamedTuple):
    """An interval between two nodes of an axis, and a coordinate in it.

    first : int, number of the left node.
    h, inverse : length of the interval, and its inverse.
    s, r : fractions of the interval to the left and to the right of the coordinate, each without
        loss of digits where it is small; outside of the nodes one is below 0, the other above 1.
    """

    first: int
    h: float
    inverse: float
    s: float
    r: float


@inline_kernel
def _interval(begin, count, step, x, table):
    """Return the :class:`Interval` of a coordinate; outside of the nodes it is the first or the
    last interval.

    begin, count : ints, where the nodes begin in the vector, and their number, >= 2.
    step : int, index in the head of the step of the axis: U_STEP or T_STEP; the inverse of the step
        follows it.
    x : float, coordinate, ln u or t, not a NaN.
    table : vector of the module.
    """
    # Indices of the vector are unsigned: numba would test signed ones for negative numbers.
    h = table[np.uint64(step)]
    if h > 0.0:  # Equal steps: the interval follows from the coordinate.
        inverse = table[np.uint64(step + 1)]
        # Steps from the node in the middle, which is t = 0 of a graded table: the distance from it
        # has all its digits.
        middle = count >> 1
        y = (x - table[np.uint64(begin + middle)]) * inverse
        # From the first node to the last interval, count - 2: its middle, count - 1.5, is rounded
        # down to it, while the last node would begin an interval that does not exist.
        left = np.floor(min(max(y, -np.float64(middle)), count - 1.5 - middle))
        return Interval(middle + np.int64(left), h, inverse, y - left, left + 1.0 - y)
    # Else it is found by bisection: ``low`` is the left node and ``span`` the number of the
    # intervals among which it is.
    low = np.int64(0)
    span = count - 1
    while span > 1:
        half = span >> 1
        # A product in place of a branch.  Of an odd span the left part counts one interval too
        # many, which no later test reaches.
        low += half * np.int64(x >= table[np.uint64(begin + low + half)])
        span -= half
    left = table[np.uint64(begin + low)]
    right = table[np.uint64(begin + low + 1)]
    h = right - left
    return Interval(low, h, 1.0 / h, (x - left) / h, (right - x) / h)


@inline_kernel
def _cubic(first, at, dx):
    """Return the :class:`Weights` of the cubic of Hermite between two nodes.

    first : int, number of the row or node at the left end.
    at : :class:`Interval` of the coordinate between them.
    dx : float, derivative of the coordinate with respect to u or w, the variable of the slopes that
        are returned.
    """
    h = at.h
    s = at.s
    r = at.r
    slope = 6.0 * s * r * dx * at.inverse  # derivative of a1, and minus that of a0
    # b0 and b1 multiply slopes, and have the factor h, which their derivatives do not have
    values = (1.0 + 2.0 * s) * r * r, s * s * (3.0 - 2.0 * s), s * r * r * h, -s * s * r * h
    slopes = -slope, slope, r * (1.0 - 3.0 * s) * dx, s * (3.0 * s - 2.0) * dx
    return Weights(first, values, slopes)


@inline_kernel
def locate_speed(u, table):
    """Return the :class:`Weights` of the rows at a speed, with derivatives over u.

    u : float, kappa |V|, >= 0, which may be infinite.
    table : vector of the module.
    """
    # Row 0 is the limit of u = 0, row n the node n - 1 of ln u, the last row the limit of u
    # infinite.  Outside of the nodes two rows are weighted without their slopes.
    rows = np.int64(table[ROWS])
    if u <= table[FIRST]:  # linear in u from row 0, the limit of u = 0
        first = 0
        right = u / table[FIRST]
        left = 1.0 - right
        slope = 1.0 / table[FIRST]
    elif u >= table[LAST]:  # linear in 1/u to the last row, the limit of u infinite
        first = rows - 2
        left = table[LAST] / u
        right = 1.0 - left
        slope = left / u
    else:
        at = _interval(HEAD, rows - 2, U_STEP, np.log(u), table)
        return _cubic(at.first + 1, at, 1.0 / u)
    return Weights(first, (left, right, 0.0, 0.0), (-slope, slope, 0.0, 0.0))


@inline_kernel
def edge_at(name, u, speed, table):
    """Return an edge, one of the creeps of the module, as :class:`Edge`.

    name : int, MIDDLE, ONSET, ONSET + 1 or FREE.
    u : float, kappa |V|, >= 0, which may be infinite.
    speed : :class:`Weights` of u, of :func:`locate_speed`.
    table : vector of the module.
    """
    # edges have rows of EDGE_COUNT pairs, value and slope; the next row is 2 EDGE_COUNT further
    at = np.int64(table[EDGES]) + (speed.first * EDGE_COUNT + name) * 2
    # Values f and slopes g over ln u in the two rows of the interval.
    f0 = table[np.uint64(at)]
    g0 = table[np.uint64(at + 1)]
    f1 = table[np.uint64(at + 2 * EDGE_COUNT)]
    g1 = table[np.uint64(at + 2 * EDGE_COUNT + 1)]
    a0, a1, b0, b1 = speed.values
    value = a0 * f0 + a1 * f1 + b0 * g0 + b1 * g1
    da0, da1, db0, db1 = speed.slopes
    slope = da0 * f0 + da1 * f1 + db0 * g0 + db1 * g1
    # Second derivative with respect to u, in this order: of a function linear in u, of one linear
    # in 1/u, and of the cubic in x = ln u, (f'' - f')/u^2 with f' = u slope.
    if u <= table[FIRST]:
        return Edge(value, slope, 0.0)
    if u >= table[LAST]:
        return Edge(value, slope, -2.0 * slope / u)
    # row ``first`` is the node first - 1 of ln u, as row 0 is the limit of u = 0
    left = table[np.uint64(HEAD + speed.first - 1)]
    h = table[np.uint64(HEAD + speed.first)] - left
    s = (np.log(u) - left) / h
    bend = (6.0 - 12.0 * s) * (f1 - f0) / (h * h) + (
        (6.0 * s - 4.0) * g0 + (6.0 * s - 2.0) * g1
    ) / h
    return Edge(value, slope, (bend / u - slope) / u)


@inline_kernel
def locate_creep(w, sigma, table):
    """Return the :class:`Weights` of the nodes in t at a relative distance w from D_0, with
    derivatives with respect to w.

    w : float, as in the module, clipped to [0, 1]; from 1 on, in full slip, derivatives are 0.
    sigma : float, 1.0 or -1.0, the side.
    table : vector of the module.
    """
    rest = max(1.0 - max(w, 0.0), 0.0)  # 1 - w
    t = 1.0 - rest  # |t|
    slope = 1.0  # d|t|/dw
    # With root = (1 - w)^(1/3), |t| = sqrt(1 - root^2) has the slope 1/(3 |t| root).  Both are kept
    # above 0, so that the slope is finite.  1 - root^2 = w (1 + root)/(1 + root + root^2) has all
    # digits of w.
    if table[GRADED] > 0.0:
        root = np.cbrt(max(rest, _ONSET_DISTANCE))
        square = min(max(w, 0.0), 1.0) * (1.0 + root) / (1.0 + root + root * root)
        t = max(np.sqrt(square), _MIDDLE_DISTANCE)
        slope = 1.0 / (3.0 * t * root)
    if rest == 0.0:  # from the onset on exactly the outer node, and nothing depends on w
        t = 1.0
        slope = 0.0
    begin = np.int64(table[T_BEGIN])
    at = _interval(begin, np.int64(table[NODES]), T_STEP, sigma * t, table)
    return _cubic(at.first, at, sigma * slope)


class Cell(NamedTuple):
    """The four nodes around a state, ordered by rows and within a row by nodes, and their weights.

    at : int, index of the first node of the cell in the first field.
    down, plane : int, distance, in numbers, from a row to the next one, and from a field to the
        next one.
    corners : four vectors of four numbers, weights of the JET numbers of a field at each node.
    speed, place : :class:`Weights` of the rows, and of the nodes.
    """

    at: int
    down: int
    plane: int
    corners: tuple
    speed: Weights
    place: Weights


@inline_kernel
def _corners(rows, nodes):
    """Return the weights of a bicubic Hermite interpolation at the four corners of a cell.

    rows : weights (a0, a1, b0, b1) in the direction of the speed, ``values`` or
        ``slopes`` of a :class:`Weights`: of the values at both rows, then of the slopes there.
    nodes : the same in the direction of the creepage, (c0, c1, d0, d1).
    Returns four vectors of four numbers, for (row 0, node 0), (row 0, node 1), (row 1, node 0) and
    (row 1, node 1): the weights of value, slope in speed, slope in creepage and mixed derivative.
    """
    a0, a1, b0, b1 = rows
    c0, c1, d0, d1 = nodes
    # each vector in the order of a JET: value, slopes over ln u and over t, mixed derivative
    return (
        pack(a0 * c0, b0 * c0, a0 * d0, b0 * d0),
        pack(a0 * c1, b0 * c1, a0 * d1, b0 * d1),
        pack(a1 * c0, b1 * c0, a1 * d0, b1 * d0),
        pack(a1 * c1, b1 * c1, a1 * d1, b1 * d1),
    )


@inline_kernel
def cell_at(speed, place, table):
    """Return the :class:`Cell` of a state.

    speed : :class:`Weights` of the rows, of :func:`locate_speed`.
    place : :class:`Weights` of the nodes, of :func:`locate_creep`.
    table : vector of the module.
    """
    # a field is ROWS rows of NODES nodes of JET numbers, and fields follow each other
    down = np.int64(table[NODES]) * JET
    return Cell(
        at=np.int64(table[FIELDS]) + speed.first * down + place.first * JET,
        down=down,
        plane=np.int64(table[ROWS]) * down,
        corners=_corners(speed.values, place.values),
        speed=speed,
        place=place,
    )


@inline_kernel
def _nodes_of(name, cell, table):
    """Return the JET numbers of a field at the four nodes of a cell, four vectors of four in the
    order of ``corners`` of :class:`Cell`.

    name : int, number of the field, TRACTION to FRICTION, as far as the table has it; not checked.
    cell : :class:`Cell` of :func:`cell_at`.
    table : vector of the module.
    """
    at = cell.at + name * cell.plane
    below = at + cell.down
    return load(table, at), load(table, at + JET), load(table, below), load(table, below + JET)


@inline_kernel
def _combined(weights, nodes):
    """Return the sum over four nodes of weights times the JET numbers of a field, a float.

    weights : four vectors of four, of :func:`_corners`.
    nodes : four vectors of four in the same order, of :func:`_nodes_of`.
    """
    # two products that do not wait for one another, then the four numbers of the sum
    a, b, c, d = unpack(
        fma4(nodes[0], weights[0], nodes[1] * weights[1])
        + fma4(nodes[2], weights[2], nodes[3] * weights[3])
    )
    return (a + b) + (c + d)


@inline_kernel
def value_at(name, cell, table):
    """Return the value of a field, a float; for w < 0 the value at w = 0.

    name : int, number of the field, TRACTION to FRICTION, as far as the table has it; not checked.
    cell : :class:`Cell` of :func:`cell_at`.
    table : vector of the module.
    """
    return _combined(cell.corners, _nodes_of(name, cell, table))


@inline_kernel
def field_at(name, w, cell, table):
    """Return a field as :class:`FieldValue`, continued along its tangent for w < 0.

    name : int, TRACTION to WORK + 1.
    w : float, relative distance of the state from D_0, as in the module.
    cell : :class:`Cell` of :func:`cell_at`.
    table : vector of the module.
    """
    nodes = _nodes_of(name, cell, table)
    # the weights of a slope: those of derivatives in one direction, of values in the other
    dw = _combined(_corners(cell.speed.values, cell.place.slopes), nodes)
    return FieldValue(
        _combined(cell.corners, nodes) + min(w, 0.0) * dw,
        _combined(_corners(cell.speed.slopes, cell.place.values), nodes),
        dw,
    )


class Place(NamedTuple):
    """Side and relative distance from D_0 of a creep D at one speed, as in the module.

    sigma : side, 1.0 or -1.0.
    w : relative distance; 1 or more in full slip.
    dw_dD, dw_du : derivatives of w with respect to D at fixed u and to u at fixed D.
    """

    sigma: float
    w: float
    dw_dD: float
    dw_du: float


@inline_kernel
def place_of(D, u, speed, table):
    """Return the :class:`Place` of a creep.

    D : float, 2 kappa delta, which may be infinite.
    u : float, kappa |V|.
    speed : :class:`Weights` of u, of :func:`locate_speed`.
    table : vector of the module.
    """
    middle = edge_at(MIDDLE, u, speed, table)
    sigma = 1.0 if D >= middle.value else -1.0
    # ONSET + 0 is that of sigma = -1, ONSET + 1 that of 1; D less the middle, and ``width``, both
    # have the sign of sigma, so that w >= 0
    onset = edge_at(ONSET + np.int64(D >= middle.value), u, speed, table)
    width = onset.value - middle.value
    w = (D - middle.value) / width
    # In dw/du w counts as at most 1, so that it is finite for an infinite D too.
    return Place(sigma, w, 1.0 / width, -(middle.du + min(w, 1.0) * (onset.du - middle.du)) / width)


@kernel
def balance_loop(table, kappa, mu, u, load, of_spin, out):
    """Find the creepages at which friction balances given loads, by bisection of d = sigma w.

    table : vector of the module.
    kappa, mu : slenderness and coefficient of friction of each state, > 0, (n,).
    u : kappa V of each state, >= 0, (n,).
    load : required value of Q - M_half_space, or if ``of_spin`` of Q + M_cylinder, (n,).
    of_spin : bool, whether the cylinder is balanced, instead of the axis.
    out : (n, 2), written: 2 kappa delta, between the onsets of full slip or at one of them; the
        part of ``load`` that friction cannot balance, 0 between the onsets.
    Returns nothing.
    """
    for n in range(u.size):
        speed = locate_speed(u[n], table)
        low = -1.0
        high = 1.0
        d = 0.0
        found = 0.0
        # Steps 0 and 1 evaluate both onsets, d = -1 and 1; a load beyond them ends the search
        # there.
        for step in range(_HALVINGS + 2):
            d = 2.0 * step - 1.0 if step < 2 else 0.5 * (low + high)
            sigma = 1.0 if d >= 0.0 else -1.0
            cell = cell_at(speed, locate_creep(abs(d), sigma, table), table)
            found = mu[n] * value_at(TRACTION, cell, table)
            if of_spin:
                found += value_at(CYLINDER, cell, table) / kappa[n]
            else:
                found -= value_at(HALF_SPACE, cell, table) / kappa[n]
            if step < 2:
                if d * found <= d * load[n]:
                    break
            elif found < load[n]:  # the load of friction grows with d
                low = d
            else:
                high = d
        middle = edge_at(MIDDLE, u[n], speed, table).value
        onset = edge_at(ONSET + np.int64(d >= 0.0), u[n], speed, table).value
        # 2 kappa delta from w = |d| on the side of d; |d| = 1 exactly only in steps 0 and 1
        out[n, 0] = middle + abs(d) * (onset - middle)
        out[n, 1] = load[n] - found if abs(d) == 1.0 else 0.0
