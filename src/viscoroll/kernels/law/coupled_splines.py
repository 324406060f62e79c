"""The law of one scene as a table: cubic splines over speed and creep, with first derivatives, one
state at a time.

A table is one vector of doubles: a head, nodes, edges, fields.  Its speed is u = kappa |V|, its
creep D = 2 kappa delta.
Three creeps divide the states of a speed, each a cubic spline of ln u: the onset of full slip of
negative sign, D_-, a creep D_0 between, and the onset of positive sign, D_+.  With sigma = 1 above
D_0 and -1 below, a state has the place

    w = (D - D_0)/(D_sigma - D_0),   0 <= w <= 1 in partial slip,   t = sigma w   or   t = sigma sqrt(1 - (1 - w)^(2/3))

and each field is a tensor spline in (ln u, t), the second form of t where the table is graded:
there fields of a contact in which shear acts on pressure are smooth at D_0 and at the onsets.
Below the first node a field is linear in u between the limit of u = 0 and that node, beyond the
last one linear in 1/u between it and the limit of u infinite.

``materials.law.coupled_table`` writes the vector.  All quantities are dimensionless.
"""  # noqa: E501

from typing import NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel

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
#: Step of equal steps in ln u; 0 where they are not equal.
U_STEP = 5
#: Step of equal steps in t; 0 where they are not equal.
T_STEP = 6
#: Where the nodes of t begin; those of ln u begin at :data:`HEAD`.
T_BEGIN = 7
#: Where the edges begin.
EDGES = 8
#: Where the fields begin.
FIELDS = 9
#: Number of fields.
FIELD_COUNT = 10
#: Largest u: infinite, or LAST for a table without the limit of u infinite.
MOST = 11
#: 1 if slip is full beyond the onsets, 0 where nothing is known there.
SLIPS = 12
#: Largest |Q/mu|: 1, or infinite where it is not known.
LIMIT = 13
#: Numbers of the head.
HEAD = 14

#: Edge: the creep D_0 between the signs.
MIDDLE = 0
#: Edge: the onset of full slip of negative sign; that of positive sign follows.
ONSET = 1
#: Edge: the creep of free rolling, at which Q = 0.
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
#: Field: 2 kappa times the work of shear on the strain of the half-space; of the cylinder follows.
WORK = 6
#: Numbers of a field at a node: its value, slopes over ln u and t, and the mixed one.
JET = 4

#: 1 - w below which a place counts as this far from the onset: slopes there are 0 to rounding.
_ONSET_DISTANCE = 1e-24
#: |t| below which a place counts as this far from D_0: slopes there are those of D_0 to rounding.
_MIDDLE_DISTANCE = 1e-9


class Weights(NamedTuple):
    """Weights of the numbers at both ends of an interval in a spline: of values (a), of slopes (b).

    first : int, number of the row or node at the left end.
    a0, a1, b0, b1 : weights of value and slope at the left end (0) and the right one (1).
    da0 ... db1 : their derivatives over u, or over w.
    """

    first: int
    a0: float
    a1: float
    b0: float
    b1: float
    da0: float
    da1: float
    db0: float
    db1: float


class FieldValue(NamedTuple):
    """A field of the table, or an edge: its value, and its slopes over u at fixed w and over w at
    fixed u.

    Of an edge the third number is the second derivative over u.
    """

    value: float
    du: float
    dw: float


@inline_kernel
def _interval(begin, count, step, x, table):
    """Return the number of the interval of a coordinate, 0 ... count - 2, between nodes that begin
    at ``begin``.

    step : float, the step of equal steps, 0 where they are not equal.
    x : float, coordinate; one outside of the nodes gets the first or the last interval.
    """
    if step > 0.0:
        return min(max(np.int64((x - table[np.uint64(begin)]) / step), 0), count - 2)
    low = np.int64(0)
    span = count - 1
    while span > 1:
        half = span >> 1
        low += half * np.int64(x >= table[np.uint64(begin + low + half)])
        span -= half
    return low


@inline_kernel
def _cubic(first, x, left, right, dx):
    """Return the :class:`Weights` of a cubic between two nodes, with derivatives multiplied by
    ``dx``.
    """
    h = right - left
    s = (x - left) / h
    r = 1.0 - s
    slope = 6.0 * s * r * dx / h
    return Weights(
        first=first,
        a0=(1.0 + 2.0 * s) * r * r,
        a1=s * s * (3.0 - 2.0 * s),
        b0=s * r * r * h,
        b1=-s * s * r * h,
        da0=-slope,
        da1=slope,
        db0=r * (1.0 - 3.0 * s) * dx,
        db1=s * (3.0 * s - 2.0) * dx,
    )


@inline_kernel
def locate_speed(u, table):
    """Return the :class:`Weights` of the rows at a speed, with derivatives over u; u >= 0, which
    may be infinite.
    """
    rows = np.int64(table[ROWS])
    if u <= table[FIRST]:
        part = u / table[FIRST]
        slope = 1.0 / table[FIRST]
        return Weights(
            first=0, a0=1.0 - part, a1=part, b0=0.0, b1=0.0, da0=-slope, da1=slope, db0=0.0, db1=0.0
        )
    if u >= table[LAST]:
        part = table[LAST] / u
        return Weights(
            first=rows - 2,
            a0=part,
            a1=1.0 - part,
            b0=0.0,
            b1=0.0,
            da0=-part / u,
            da1=part / u,
            db0=0.0,
            db1=0.0,
        )
    x = np.log(u)
    first = _interval(HEAD, rows - 2, table[U_STEP], x, table)
    return _cubic(
        first + 1, x, table[np.uint64(HEAD + first)], table[np.uint64(HEAD + first + 1)], 1.0 / u
    )


@inline_kernel
def edge_at(name, u, speed, table):
    """Return an edge, one of the creeps of the module, as :class:`FieldValue` with its second
    derivative over u.

    name : MIDDLE, ONSET, ONSET + 1 or FREE.
    u : float, the speed of ``speed``, of :func:`locate_speed`.
    """
    at = np.int64(table[EDGES]) + (speed.first * EDGE_COUNT + name) * 2
    f0 = table[np.uint64(at)]
    g0 = table[np.uint64(at + 1)]
    f1 = table[np.uint64(at + 2 * EDGE_COUNT)]
    g1 = table[np.uint64(at + 2 * EDGE_COUNT + 1)]
    value = speed.a0 * f0 + speed.a1 * f1 + speed.b0 * g0 + speed.b1 * g1
    slope = speed.da0 * f0 + speed.da1 * f1 + speed.db0 * g0 + speed.db1 * g1
    if u <= table[FIRST]:
        return FieldValue(value, slope, 0.0)
    if u >= table[LAST]:
        return FieldValue(value, slope, -2.0 * slope / u)
    left = table[np.uint64(HEAD + speed.first - 1)]
    h = table[np.uint64(HEAD + speed.first)] - left
    s = (np.log(u) - left) / h
    bend = (6.0 - 12.0 * s) * (f1 - f0) / (h * h) + (
        (6.0 * s - 4.0) * g0 + (6.0 * s - 2.0) * g1
    ) / h
    return FieldValue(value, slope, (bend / u - slope) / u)


@inline_kernel
def locate_creep(w, sigma, table):
    """Return the :class:`Weights` of the nodes in t at a place, with derivatives over w.

    w : float, place of the module, clipped to [0, 1]; beyond 1, in full slip, derivatives are 0.
    sigma : 1.0 or -1.0, the side.
    """
    rest = max(1.0 - max(w, 0.0), 0.0)
    t = 1.0 - rest
    slope = 1.0
    if table[GRADED] > 0.0:
        root = np.cbrt(max(rest, _ONSET_DISTANCE))
        t = max(np.sqrt(max(1.0 - root * root, 0.0)), _MIDDLE_DISTANCE)
        slope = 1.0 / (3.0 * t * root)
    if rest == 0.0:
        t = 1.0
        slope = 0.0
    begin = np.int64(table[T_BEGIN])
    t = sigma * t
    first = _interval(begin, np.int64(table[NODES]), table[T_STEP], t, table)
    return _cubic(
        first,
        t,
        table[np.uint64(begin + first)],
        table[np.uint64(begin + first + 1)],
        sigma * slope,
    )


@inline_kernel
def field_at(name, w, speed, place, table):
    """Return a field as :class:`FieldValue`, continued along its tangent for w < 0.

    name : TRACTION to WORK + 1.
    w : float, place of ``place``, of :func:`locate_creep`; ``speed``: of :func:`locate_speed`.
    """
    fields = np.int64(table[FIELD_COUNT])
    across = fields * JET
    down = np.int64(table[NODES]) * across
    at = np.int64(table[FIELDS]) + speed.first * down + place.first * across + name * JET
    value = du = dw = 0.0
    for n in range(2):
        left = at + n * down
        right = left + across
        f0 = table[np.uint64(left)]
        f1 = table[np.uint64(right)]
        t0 = table[np.uint64(left + 2)]
        t1 = table[np.uint64(right + 2)]
        f = place.a0 * f0 + place.a1 * f1 + place.b0 * t0 + place.b1 * t1
        df = place.da0 * f0 + place.da1 * f1 + place.db0 * t0 + place.db1 * t1
        x0 = table[np.uint64(left + 1)]
        x1 = table[np.uint64(right + 1)]
        m0 = table[np.uint64(left + 3)]
        m1 = table[np.uint64(right + 3)]
        g = place.a0 * x0 + place.a1 * x1 + place.b0 * m0 + place.b1 * m1
        dg = place.da0 * x0 + place.da1 * x1 + place.db0 * m0 + place.db1 * m1
        a = speed.a1 if n else speed.a0
        b = speed.b1 if n else speed.b0
        value += a * f + b * g
        dw += a * df + b * dg
        du += (speed.da1 if n else speed.da0) * f + (speed.db1 if n else speed.db0) * g
    return FieldValue(value + min(w, 0.0) * dw, du, dw)


class Place(NamedTuple):
    """Where a creep D lies at one speed.

    sigma : side, 1.0 or -1.0.  w : place, above 1 in full slip.
    dw_dD, dw_du : derivatives of w at fixed u and at fixed D.
    """

    sigma: float
    w: float
    dw_dD: float
    dw_du: float


@inline_kernel
def place_of(D, u, speed, table):
    """Return the :class:`Place` of a creep.

    D : float, 2 kappa delta, which may be infinite.  u, speed : speed, and its weights of
    :func:`locate_speed`.
    """
    middle = edge_at(MIDDLE, u, speed, table)
    sigma = 1.0 if D >= middle.value else -1.0
    onset = edge_at(ONSET + np.int64(D >= middle.value), u, speed, table)
    width = onset.value - middle.value
    w = (D - middle.value) / width
    return Place(sigma, w, 1.0 / width, -(middle.du + min(w, 1.0) * (onset.du - middle.du)) / width)
