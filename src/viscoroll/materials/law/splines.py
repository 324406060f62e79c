"""Tensor splines on grids, by scipy, and in the form that compiled code reads (``kernels.splines``)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...core.array_types import Floats


def fit_spline(values: Floats, axes: list[Floats], degree: int) -> Any:
    """Return the not-a-knot tensor spline through values on a grid, of lower degree along axes of few nodes.

    Parameters
    ----------
    values : values at the nodes, (nodes of the first axis, nodes of the second, ...); without axes a number or array.
    axes : coordinates of the nodes, increasing, at least two, one array (nodes,) for each axis of ``values``, in that
        order; an empty list for a single value.
    degree : 1 or 3; along an axis of fewer than degree + 1 nodes it is the number of nodes less 1.

    Returns
    -------
    scipy.interpolate.NdBSpline
        Over all axes, in their order; it takes points (..., axes) and returns values (...).  Without axes ``values``
        itself.

    Raises
    ------
    ValueError
        Of scipy, for values that are not finite, coordinates that do not increase, and an axis of a single node.
    """
    from scipy.interpolate import NdBSpline, make_interp_spline

    knots, degrees = [], tuple(min(degree, axis.size - 1) for axis in axes)
    for n, axis in enumerate(axes):
        one = make_interp_spline(axis, values, k=degrees[n], axis=n)
        knots.append(one.t)
        values = np.moveaxis(one.c, 0, n)
    return NdBSpline(tuple(knots), np.ascontiguousarray(values), degrees) if axes else values


def _axis(knots: Floats, degree: int, log: bool, stride: int) -> Floats:
    """Return an axis of a spline in the form that ``kernels.splines.spline`` reads.

    knots: knots of a not-a-knot spline, ascending, with ``degree`` + 1 equal ones at either end, in the unit of the
        coordinate, or its logarithm.
    degree: 1 to 3, the degree of the spline.
    log: whether the spline runs in the logarithm of the coordinate; the knots are logarithms then.
    stride: number of coefficients that one step along the axis is.
    Returns one vector of 5 + 17 n numbers for n intervals between the different knots: n, degree + 1, log (0 or 1) and
    stride; the n + 1 ends of the intervals; then for each interval four basis splines with four Taylor coefficients
    each about its left end, of which those from ``degree`` + 1 on are 0.
    """
    from scipy.interpolate import BSpline

    from ...kernels.splines.spline import TERMS

    edges = knots[degree : knots.size - degree]
    of, own = np.arange(edges.size - 1)[:, np.newaxis], np.arange(degree + 1)
    basis = np.zeros((edges.size - 1, TERMS, TERMS))
    every = BSpline(knots, np.eye(knots.size - degree - 1), degree)
    for power in own:
        basis[:, own, power] = every(edges[:-1], nu=power)[of, of + own] / math.factorial(power)
    return np.concatenate([[edges.size - 1, degree + 1, log, stride], edges, basis.ravel()])


def pack_spline(found: Any, axes: tuple[str, ...], logs: tuple[str, ...], bounds: tuple[float, float]) -> Floats:
    """Return a spline over some of V, delta and alpha as the vector that ``kernels.splines.spline`` reads.

    Parameters
    ----------
    found : a spline of :func:`fit_spline`, or the value, a number, of a field over no axis.
    axes : names of its axes, in their order, of "V", "delta" and "alpha".
    logs : names of the axes in whose logarithm it runs; other names in it have no effect.
    bounds : lowest and highest value, to which kernels clip results, in the unit of the values; infinite for none.

    Returns
    -------
    vector
        Six numbers: the bounds, and the indices in the vector where the axes V, delta and alpha and the coefficients
        begin; the three axes as of :func:`_axis`, with no interval and one basis spline, the constant 1, for an axis
        that the field does not depend on; the coefficients, last axis fastest, with 3 - degree zeros after the last
        ones of each axis.
    """
    # an axis that the field is not over: no interval, one basis spline, which is 1
    vectors = dict.fromkeys(("V", "delta", "alpha"), np.array([0.0, 1.0, 0.0, 0.0, 0.0, 1.0] + [0.0] * 15))
    values = np.pad(found.c, [(0, 3 - degree) for degree in found.k]) if axes else np.asarray(found)
    for n, name in enumerate(axes):
        vectors[name] = _axis(found.t[n], found.k[n], name in logs, values.strides[n] // values.itemsize)
    begin = np.cumsum([6, *(each.size for each in vectors.values())])
    return np.concatenate([bounds, begin, *vectors.values(), values.ravel()])
