"""A tensor spline over V, delta and alpha at one point: its value and its slopes.

A spline is one vector of doubles: a head, its three axes, its coefficients.  An axis is a head, the edges of its
intervals, and for each interval the basis splines that are not 0 there, as polynomials of the distance from its left
edge.  An axis may run in the logarithm of its coordinate.  An axis on which the field does not depend has no interval,
and one basis spline, which is 1.  ``viscoroll.materials.law.splines`` writes the vector.
"""

from typing import NamedTuple

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import inline_kernel, kernel

# Indices in the head of a spline.
#: Lower bound, to which values are clipped.
LOW = 0
#: Upper bound, to which values are clipped.
HIGH = 1
#: Where the axis of V begins.
V_AXIS = 2
#: Where the axis of delta begins.
DELTA_AXIS = 3
#: Where the axis of alpha begins.
ALPHA_AXIS = 4
#: Where the coefficients begin.
COEFFICIENTS = 5
# Indices in the head of an axis.
#: Number of intervals; 0 if the field does not depend on the coordinate.
INTERVALS = 0
#: Number of basis splines that are not 0 in an interval.
ORDER = 1
#: 1 if the coordinate is the logarithm, else 0.
IS_LOG = 2
#: Number of coefficients between neighbours along the axis.
STRIDE = 3
#: Where the edges of the intervals begin.
EDGES = 4
#: Coefficients of the polynomial of a basis spline; of a lower degree some are 0.
TERMS = 4


class Value(NamedTuple):
    """A field at a point and its slopes over V, delta and alpha, in the units of the grid.

    All four are NaN outside of the axes.  The slope over an axis on which the field does not depend is 0, and so are
    all slopes where the value is clipped to the bounds.
    """

    value: float
    dV: float
    ddelta: float
    dalpha: float


class AxisPosition(NamedTuple):
    """Position of a coordinate on an axis.

    axis : int, where the axis begins in the spline.
    interval : int, number of the interval, from 0.
    t : distance from its left edge, in the coordinate or in its logarithm; NaN outside of the axis.
    slope : derivative of the logarithm over the coordinate; 1 where the axis does not run in it.
    """

    axis: int
    interval: int
    t: float
    slope: float


@inline_kernel
def _number_at(spline, n):
    """Return number ``n`` of a spline; unsigned, as numba would test for negative ones."""
    return spline[np.uint64(n)]


@inline_kernel
def _integer_at(spline, n):
    """Return number ``n`` of a spline as an integer."""
    return np.int64(_number_at(spline, n))


@inline_kernel
def _locate(spline, name, x):
    """Return the position of a coordinate on an axis of the spline.

    spline : vector of the spline: bounds, axes and coefficients.
    name : V_AXIS, DELTA_AXIS or ALPHA_AXIS, index in the head of the spline.
    x : float, the coordinate itself, also of a logarithmic axis, in the units of the grid; it is ignored if the field
        does not depend on it.

    Returns :class:`AxisPosition`.  A coordinate on an inner edge is at the left end of its interval, one at the upper
    end of the axis is in the last interval.  Outside of the axis, and for NaN, t is NaN and the interval 0.  If the
    field does not depend on the coordinate, interval and t are 0 and the slope is 1.
    """
    axis = _integer_at(spline, name)
    interval = np.int64(0)
    count = _integer_at(spline, axis + INTERVALS)
    slope = 1.0
    if count == 0:
        return AxisPosition(axis, interval, 0.0, slope)
    if _number_at(spline, axis + IS_LOG) > 0.0:
        slope = 1.0 / x
        x = np.log(x)
    if not _number_at(spline, axis + EDGES) <= x <= _number_at(spline, axis + EDGES + count):
        return AxisPosition(axis, interval, np.nan, slope)
    while count > 1:
        half = count >> 1
        interval += half * np.int64(x >= _number_at(spline, axis + EDGES + interval + half))
        count -= half
    return AxisPosition(axis, interval, x - _number_at(spline, axis + EDGES + interval), slope)


@inline_kernel
def _basis(spline, position, n):
    """Return one basis spline at a position: value, slope and offset of its coefficient.

    spline : vector of the spline: bounds, axes and coefficients.
    position : the :class:`AxisPosition`.
    n : int, 0 ... 3, index of the basis spline among those that are not 0 in the interval; those beyond the degree of
        the axis are 0.

    Returns (value, slope, offset): value, a float, dimensionless; slope over the coordinate itself, also of a
    logarithmic axis, a float; int that is added to the position of a coefficient in the vector.  Value and slope are
    NaN outside of the axis.
    """
    axis = position.axis
    at = (position.interval * TERMS + n) * TERMS + EDGES + 1 + _integer_at(spline, axis + INTERVALS) + axis
    c0 = _number_at(spline, at)
    c1 = _number_at(spline, at + 1)
    c2 = _number_at(spline, at + 2)
    c3 = _number_at(spline, at + 3)
    t = position.t
    start = (position.interval + n) * _integer_at(spline, axis + STRIDE)
    return fma(t, fma(t, fma(t, c3, c2), c1), c0), fma(t, fma(t, 3.0 * c3, 2.0 * c2), c1) * position.slope, start


@inline_kernel
def evaluate(spline, V, delta, alpha):
    """Return the :class:`Value` of a field at a point, for kernels that inline it.

    spline : vector of the spline: bounds, axes and coefficients.
    V, delta, alpha : float, coordinates in the units of the grid.  A coordinate on which the field does not depend is
        ignored.

    Returns value and slopes over V, delta and alpha, floats in the units of the grid: all NaN if a coordinate is NaN or
    outside of its axis; a value beyond the bounds of the field is clipped to them, and all its slopes are 0.  The slope
    over a coordinate that is ignored is 0.
    """
    over_V = _locate(spline, V_AXIS, V)
    over_delta = _locate(spline, DELTA_AXIS, delta)
    over_alpha = _locate(spline, ALPHA_AXIS, alpha)
    value = dV = ddelta = dalpha = 0.0 * (over_V.t + over_delta.t + over_alpha.t)
    for k in range(_integer_at(spline, over_alpha.axis + ORDER)):
        c, dc, plane = _basis(spline, over_alpha, k)
        for i in range(TERMS):
            b, db, row = _basis(spline, over_V, i)
            row += plane + _integer_at(spline, COEFFICIENTS)
            f = df = 0.0
            for j in range(TERMS):
                a, da, column = _basis(spline, over_delta, j)
                coefficient = _number_at(spline, row + column)
                f = fma(a, coefficient, f)
                df = fma(da, coefficient, df)
            value = fma(c * b, f, value)
            dV = fma(c * db, f, dV)
            ddelta = fma(c * b, df, ddelta)
            dalpha = fma(dc * b, f, dalpha)
    low = _number_at(spline, LOW)
    high = _number_at(spline, HIGH)
    if value < low or value > high:
        return Value(min(max(value, low), high), 0.0, 0.0, 0.0)
    return Value(value, dV, ddelta, dalpha)


@kernel
def spline_at(spline, V, delta, alpha):
    """Return the :class:`Value` of a field at a point: value and slopes over V, delta and alpha, in the units of the
    grid.

    It is :func:`evaluate` for callers outside of this folder, compiled once.

    spline : vector of doubles of :meth:`viscoroll.io.tables.Interpolant.jitted`: bounds, axes and coefficients.
    V, delta, alpha : float, coordinates in the units of the grid.  Where the field does not depend on one of them, that
        argument is ignored, and any number may be given.

    Returns NaN, the slopes too, if a coordinate that is not ignored is NaN or outside of its axis.  A value beyond
    the bounds of the field is clipped to them, and its slopes are 0.  The slope over a coordinate that is ignored is 0.
    """
    return evaluate(spline, V, delta, alpha)
