"""A tensor spline over V, delta and alpha at one point: its value and its slopes.

A spline is one vector of doubles: a head, its three axes, its coefficients.  An axis is a head, the edges of its
intervals, and for each interval the basis splines that are not 0 there, as polynomials of the distance from its left
edge.  ``viscoroll.materials.grid_splines`` writes it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import kernel

#: Places in the head of a spline: bounds to which values are clipped; where the axes and the coefficients begin.
LOW, HIGH, V_AXIS, DELTA_AXIS, ALPHA_AXIS, COEFFICIENTS = range(6)
#: Places in the head of an axis: number of its intervals, 0 where the field is not over it; how many basis splines are
#: not 0 in one; 1 where the coordinate is a logarithm; how many coefficients a step along it is; where the edges begin.
INTERVALS, ORDER, IS_LOG, STRIDE, EDGES = range(5)
#: Coefficients of the polynomial of a basis spline; of a lower degree some are 0.
TERMS = 4


class Value(NamedTuple):
    """A field at a point and its slopes over V, delta and alpha; NaN outside of the axes."""

    value: float
    dV: float
    ddelta: float
    dalpha: float


class Place(NamedTuple):
    """Where a coordinate lies: the axis; its interval there; the distance from the left edge of that, NaN outside of
    the axis; and the slope of what the spline runs in.
    """

    axis: int
    interval: int
    t: float
    slope: float


@kernel(inline=True)
def _at(spline, n):
    """Number n of a spline; unsigned, as numba would look for negative ones."""
    return spline[np.uint64(n)]


@kernel(inline=True)
def _whole(spline, n):
    """The same, where it is a whole number."""
    return np.int64(spline[np.uint64(n)])


@kernel(inline=True)
def _place(spline, name, x):
    """The :class:`Place` of a coordinate on the axis ``name``, a place in the head of the spline."""
    axis = _whole(spline, name)
    interval, count, slope = np.int64(0), _whole(spline, axis + INTERVALS), 1.0
    if count == 0:
        return Place(axis, interval, 0.0, slope)
    if _at(spline, axis + IS_LOG) > 0.0:
        x, slope = np.log(x), 1.0 / x
    if not _at(spline, axis + EDGES) <= x <= _at(spline, axis + EDGES + count):
        return Place(axis, interval, np.nan, slope)
    while count > 1:
        half = count >> 1
        interval += half * np.int64(x >= _at(spline, axis + EDGES + interval + half))
        count -= half
    return Place(axis, interval, x - _at(spline, axis + EDGES + interval), slope)


@kernel(inline=True)
def _basis(spline, place, n):
    """(Basis spline n at a place, its slope, what it adds to the number of a coefficient)."""
    axis = place.axis
    at = (place.interval * TERMS + n) * TERMS + EDGES + 1 + _whole(spline, axis + INTERVALS) + axis
    c0, c1, c2, c3 = _at(spline, at), _at(spline, at + 1), _at(spline, at + 2), _at(spline, at + 3)
    t, start = place.t, (place.interval + n) * _whole(spline, axis + STRIDE)
    return fma(t, fma(t, fma(t, c3, c2), c1), c0), fma(t, fma(t, 3.0 * c3, 2.0 * c2), c1) * place.slope, start


@kernel(inline=True)
def evaluate(spline, V, delta, alpha):
    """The :class:`Value` of a field at a point: :func:`spline_at` for kernels."""
    over_V, over_delta = _place(spline, V_AXIS, V), _place(spline, DELTA_AXIS, delta)
    over_alpha = _place(spline, ALPHA_AXIS, alpha)
    value = dV = ddelta = dalpha = 0.0 * (over_V.t + over_delta.t + over_alpha.t)
    for k in range(_whole(spline, over_alpha.axis + ORDER)):
        c, dc, plane = _basis(spline, over_alpha, k)
        for i in range(TERMS):
            b, db, row = _basis(spline, over_V, i)
            row += plane + _whole(spline, COEFFICIENTS)
            f = df = 0.0
            for j in range(TERMS):
                a, da, column = _basis(spline, over_delta, j)
                f, df = fma(a, _at(spline, row + column), f), fma(da, _at(spline, row + column), df)
            value, dV = fma(c * b, f, value), fma(c * db, f, dV)
            ddelta, dalpha = fma(c * b, df, ddelta), fma(dc * b, f, dalpha)
    low, high = _at(spline, LOW), _at(spline, HIGH)
    if value < low or value > high:
        return Value(min(max(value, low), high), 0.0, 0.0, 0.0)
    return Value(value, dV, ddelta, dalpha)


@kernel
def spline_at(spline, V, delta, alpha):
    """The :class:`Value` of a field at a point.

    spline : of :meth:`viscoroll.io.tables.Interpolant.jitted`.
    V, delta, alpha : coordinates in the units of the grid; for an axis that the field is not over any number does.
    """
    return evaluate(spline, V, delta, alpha)
