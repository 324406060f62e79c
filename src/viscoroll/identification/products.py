"""Unknowns that the data cannot tell apart, and the products of their powers that they do determine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from .problem import Problem, Vector
from .profile import Profile

#: width of an interval of a coordinate from which on it counts as not determined, and of a product
_WIDE, _NARROW = 2.0, 1.0
#: correlation beyond which unknowns go together
_TOGETHER = 0.95
#: exponents are rounded to whole numbers, halves, ... where places stay as near to each other as by this factor
_PARTS, _AS_NEAR = (1, 2, 10, 100), 1.5
#: how much wider the interval of a product with rounder exponents may be
_ROUNDER = 5.0

#: the profile of a combination, and ends of its interval over what it is, if it has both
ProfileOf = Callable[[Vector], Profile]
EndsOf = Callable[[Vector], tuple[float, float] | None]


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


def undetermined(problem: Problem, cov: Vector, profile_of: ProfileOf) -> list[int]:
    """Unknowns whose interval tells little, and what is correlated with these."""
    wide, sd = [], np.sqrt(np.diag(cov))
    for i in problem.live:
        low, high = profile_of(np.eye(sd.size)[i]).ends
        width = (problem.high[i] if high.at is None else high.at) - (problem.low[i] if low.at is None else low.at)
        if width > min(_WIDE, 0.5 * (problem.high[i] - problem.low[i])):
            wide.append(i)
    return [i for i in problem.live if (np.abs(cov[i, wide]) > _TOGETHER * sd[i] * sd[wide]).any()]


def products(
    problem: Problem, u: Vector, cov: Vector, which: list[int], profile_of: ProfileOf, rise: float
) -> list[Product]:
    """What is determined of ``which``: by places that all fit, by slopes at u where that is narrower by far.

    Where neither has an interval, by slopes with what these say of their interval, at a ``rise`` of chi2.
    """
    if len(which) < 2:
        return []
    steep = _by_slopes(problem, u, which)

    def asked(powers: Vector) -> tuple[float, float] | None:
        low, high = profile_of(powers).ends
        centre = float(powers @ u)
        return None if low.at is None or high.at is None else (low.at - centre, high.at - centre)

    def guessed(powers: Vector) -> tuple[float, float]:
        half = math.sqrt(rise * (powers @ cov @ powers))
        return -half, half

    by_places = _narrow(problem, u, _by_places(which, profile_of, u.size), asked)
    by_slopes = _narrow(problem, u, steep, asked)
    widths = [math.log(family[0].high / family[0].low) if family else math.inf for family in (by_places, by_slopes)]
    if by_places and widths[0] < _ROUNDER * widths[1]:
        return by_places
    return by_slopes or [one._replace(near=True) for one in _narrow(problem, u, steep, guessed)]


def _narrow(problem: Problem, u: Vector, family: Iterable[Vector], ends_of: EndsOf) -> list[Product]:
    """Products with their intervals, up to the first one that is open or wide."""
    found, values = [], problem.values(u)
    for powers in family:
        ends = ends_of(powers)
        if ends is None or ends[1] - ends[0] > _NARROW:
            break
        exponents = {
            one.name: float(p if one.unit is None else p * values[one.name] / one.unit)
            for one, p in zip(problem.unknowns, powers, strict=True) if p
        }  # fmt: skip
        value = math.prod(values[name] ** p for name, p in exponents.items())
        found.append(Product(exponents, value, math.exp(ends[0]), math.exp(ends[1]), False))
    return found


def _by_places(which: list[int], profile_of: ProfileOf, n: int) -> Iterator[Vector]:
    """Combinations in which all places that fit lie nearest to each other, best first, and as round as that allows."""
    within = np.concatenate([profile_of(np.eye(n)[i]).within for i in which])[:, which]
    for v in np.linalg.svd(within - within.mean(axis=0), full_matrices=True)[2][::-1]:
        exact = v / v[np.argmax(np.abs(v))]
        rounded = (np.round(exact * parts) / parts for parts in _PARTS)
        width = _AS_NEAR * np.ptp(within @ exact)
        yield _among(which, n, next((p for p in rounded if np.ptp(within @ p) <= width), np.round(exact, 2)))


def _by_slopes(problem: Problem, u: Vector, which: list[int]) -> list[Vector]:
    """Combinations along which slopes are largest, without what other unknowns take of them."""
    J, others = problem.weighed(u)[1], [i for i in problem.live if i not in which]
    own = J[:, which] - J[:, others] @ np.linalg.lstsq(J[:, others], J[:, which], rcond=None)[0]
    Vt = np.linalg.svd(own, full_matrices=False)[2]
    return [_among(which, u.size, np.round(v / v[np.argmax(np.abs(v))], 2)) for v in Vt]


def _among(which: list[int], n: int, powers: Vector) -> Vector:
    whole = np.zeros(n)
    whole[which] = powers
    return whole
