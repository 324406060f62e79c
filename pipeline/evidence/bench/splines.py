"""Cubic splines with not-a-knot ends over uniform nodes, evaluated in compiled code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .jit import compiled


def spline(values: NDArray, axes: list[NDArray]) -> tuple[tuple[NDArray, ...], NDArray]:
    """Knots and coefficients of the tensor spline through ``values`` on uniform ``axes``."""
    from scipy.interpolate import make_interp_spline

    knots = []
    for n, axis in enumerate(axes):
        one = make_interp_spline(axis, values, k=3, axis=n)
        knots.append(one.t)
        values = np.moveaxis(one.c, 0, n)
    return tuple(knots), np.ascontiguousarray(values)


@compiled
def basis(knots, x, weights):
    """The four B-splines that are not zero at x, clamped to the axis; returns the index of the first."""
    nodes = knots.size - 4
    low, high = knots[0], knots[knots.size - 1]
    x = min(max(x, low), high)
    cell = int((x - low) * ((nodes - 1) / (high - low)))
    span = min(max(cell + 2, 3), nodes - 1)
    # a cell boundary may round either way
    if x < knots[span] and span > 3:
        span -= 1
    weights[0] = 1.0
    for degree in range(1, 4):
        carried = 0.0
        for n in range(degree):
            right = knots[span + n + 1]
            left = knots[span + 1 - degree + n]
            share = weights[n] / (right - left)
            weights[n] = carried + (right - x) * share
            carried = (x - left) * share
        weights[degree] = carried
    return span - 3


@compiled
def at_1(first, weights, coefficients):
    """A one-dimensional spline from its basis."""
    total = 0.0
    for n in range(4):
        total += weights[n] * coefficients[first + n]
    return total


@compiled
def at_2(i, wi, k, wk, coefficients):
    """A two-dimensional one."""
    total = 0.0
    for n in range(4):
        row = coefficients[i + n]
        for m in range(4):
            total += wi[n] * wk[m] * row[k + m]
    return total


@compiled
def at_3(i, wi, k, wk, s, ws, coefficients):
    """A three-dimensional one."""
    total = 0.0
    for n in range(4):
        total += wi[n] * at_2(k, wk, s, ws, coefficients[i + n])
    return total


def scratch() -> NDArray[np.float64]:
    """Room for the bases of three axes."""
    return np.empty((3, 4))
