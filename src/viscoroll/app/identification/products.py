"""Unknowns that the data cannot tell apart, and the products of their powers that they do determine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .problem import Vector
from .profile import without

#: width of an interval of a coordinate from which on it counts as not determined, and of a product
_WIDE, _NARROW = 2.0, 1.0
#: correlation beyond which unknowns go together
_TOGETHER = 0.95
#: exponents are rounded to whole numbers, halves, ... where places stay as near to each other as by this factor
_PARTS, _AS_NEAR = (1, 2, 10, 100), 2.0


class Product(NamedTuple):
    """A product of powers of unknowns that the data determine where they cannot tell these apart.

    powers : exponents by name; those of brake, drag, V0, omega0 and t0 hold near the values found.
    value : of the product.
    low, high : ends of its interval over ``value``.
    near : whether this holds near the values found alone, by slopes; elsewhere in the ranges other exponents do.
    """

    powers: dict[str, float]
    value: float
    low: float
    high: float
    near: bool


def undetermined(fit: Any) -> list[int]:
    """Unknowns whose interval tells little, and what is correlated with these."""
    problem, wide = fit._problem, []
    for i, one in fit._axes().items():
        bounds = problem.low[i], problem.high[i]
        low, high = (bound if end is None else end for end, bound in zip(one.ends, bounds, strict=True))
        if high - low > min(_WIDE, 0.5 * (bounds[1] - bounds[0])):
            wide.append(i)
    return [i for i in problem.live if (np.abs(fit.correlations[i, wide]) > _TOGETHER).any()]


def products(fit: Any, level: float) -> list[Product]:
    """What is determined of the undetermined: by places that all fit, else by slopes at the best.

    Where neither has an interval, by slopes with what these say of their interval.
    """
    which = undetermined(fit)
    if len(which) < 2:
        return []
    steep = [*_by_slopes(fit, which)]
    return (
        _narrow(fit, _by_places(fit, which), level, False) or _narrow(fit, steep, level, False)
        or _narrow(fit, steep, level, True)
    )  # fmt: skip


def _narrow(fit: Any, family: Any, level: float, near: bool) -> list[Product]:
    """Products with their intervals, by profiles or ``near`` the best, up to the first one that is open or wide."""
    found = []
    for powers in family:
        half = math.sqrt(fit._rise(level) * (powers @ fit._cov @ powers))
        low, high = (-half, half) if near else fit._profile(powers, level).ends
        if low is None or high is None or high - low > _NARROW:
            break
        centre = 0.0 if near else powers @ fit._best.u
        each = [
            (one, fit.values[one.name], p) for one, p in zip(fit._problem.unknowns, powers.tolist(), strict=True) if p
        ]
        exponents = {one.name: p * (value / one.spread(value)) for one, value, p in each}
        value = math.prod(fit.values[name] ** p for name, p in exponents.items())
        found.append(Product(exponents, value, math.exp(low - centre), math.exp(high - centre), near))
    return found


def _by_places(fit: Any, which: list[int]) -> Iterator[Vector]:
    """Combinations in which all places that fit lie nearest to each other, best first, and as round as that allows."""
    within = np.concatenate([fit._axes()[i].within for i in which])[:, which]
    for v in np.linalg.svd(within - within.mean(axis=0))[2][::-1]:
        exact = v / v[np.argmax(np.abs(v))]
        rounded = (np.round(exact * parts) / parts for parts in _PARTS)
        width = _AS_NEAR * np.ptp(within @ exact)
        yield next((p for p in rounded if np.ptp(within @ p) <= width), np.round(exact, 2)) @ fit._axis(which)


def _by_slopes(fit: Any, which: list[int]) -> Iterator[Vector]:
    """Combinations along which slopes are largest, without what other unknowns take of them."""
    problem = fit._problem
    own = without(problem.weighed(fit._best.u)[1], which, [i for i in problem.live if i not in which])
    for v in np.linalg.svd(own, full_matrices=False)[2]:
        yield np.round(v / v[np.argmax(np.abs(v))], 2) @ fit._axis(which)
