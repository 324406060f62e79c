"""Unknowns that the data cannot tell apart, and the products of their powers that they do determine."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import Problem
from .profile import Profile

#: width of an interval of a coordinate from which on it counts as not determined, and of a product
_WIDE, _NARROW = 2.0, 1.0
#: correlation beyond which unknowns go together
_TOGETHER = 0.95
#: exponents are rounded to whole numbers, halves, ... where places stay as near to each other as by this factor
_PARTS, _AS_NEAR = (1, 2, 10, 100), 1.5
#: how much wider the interval of a product with rounder exponents may be
_ROUNDER = 5.0


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


@dataclass(eq=False)
class Ties:
    """What goes together at coordinates u with slopes J; ``profile_of`` a combination, ``rise`` of chi2 at its ends."""

    problem: Problem
    u: NDArray[np.float64]
    J: NDArray[np.float64]
    cov: NDArray[np.float64]
    profile_of: Callable[[NDArray[np.float64]], Profile]
    rise: float

    @cached_property
    def which(self) -> list[int]:
        """Unknowns whose interval tells little, and what is correlated with these."""
        sd = np.sqrt(np.diag(self.cov))
        together = np.abs(self.cov) > _TOGETHER * np.outer(sd, sd)
        wide = [i for i in self.problem.live if self._is_wide(i)]
        return [i for i in self.problem.live if together[i, wide].any()]

    def products(self) -> list[Product]:
        """By places that all fit, by slopes where these are narrower by far, or near the best alone."""
        if len(self.which) < 2:
            return []
        far, near = (list(self._determined(family)) for family in self._directions())
        rounder = far and (not near or np.log(far[0].high / far[0].low) < _ROUNDER * np.log(near[0].high / near[0].low))
        return (far if rounder else near) or list(self._determined(self._directions()[1], near=True))

    def _is_wide(self, i: int) -> bool:
        """Whether an interval, to the range's ends where open, is wider than a factor of e^2 or half the range."""
        problem, sides = self.problem, self._single(i)
        low = problem.low[i] if sides.low.at is None else sides.low.at
        high = problem.high[i] if sides.high.at is None else sides.high.at
        return bool(high - low > min(_WIDE, 0.5 * (problem.high[i] - problem.low[i])))

    def _single(self, i: int) -> Profile:
        return self.profile_of(np.eye(self.u.size)[i])

    def _directions(self) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]]:
        """Combinations that may be determined, best first: by places that all fit, and by slopes.

        The former are those in which the places lie nearest to each other, with exponents as round as that allows: what
        is printed is what is meant.  The latter are where J, without what other unknowns take of it, is largest.
        """
        within = np.concatenate([self._single(i).within[:, self.which] for i in self.which])
        far = []
        for v in np.linalg.svd(within - within.mean(axis=0), full_matrices=True)[2][::-1]:
            exact = v / v[np.argmax(np.abs(v))]
            width = np.ptp(within @ exact)
            rounded = (np.round(exact * parts) / parts for parts in _PARTS)
            far.append(next((p for p in rounded if np.ptp(within @ p) <= _AS_NEAR * width), np.round(exact, 2)))
        J, rest = self.J[:, self.which], self.J[:, [i for i in self.problem.live if i not in self.which]]
        Vt = np.linalg.svd(J - rest @ np.linalg.lstsq(rest, J, rcond=None)[0], full_matrices=False)[2]
        return far, [np.round(v / v[np.argmax(np.abs(v))], 2) for v in Vt]

    def _determined(self, family: list[NDArray[np.float64]], near: bool = False) -> Iterator[Product]:
        """Those of a family, up to the first one that is open or wide."""
        for direction in family:
            powers = np.zeros(self.u.size)
            powers[self.which] = direction
            if near:
                half = float(np.sqrt(self.rise * (powers @ self.cov @ powers)))
                low, high = -half, half
            else:
                sides, centre = self.profile_of(powers), float(powers @ self.u)
                if sides.low.at is None or sides.high.at is None:
                    return
                low, high = sides.low.at - centre, sides.high.at - centre
            if high - low > _NARROW:
                return
            values = self.problem.values(self.u)
            exponents = {
                one.name: float(p if one.unit is None else p * values[one.name] / one.unit)
                for one, p in zip(self.problem.unknowns, powers, strict=True) if p
            }  # fmt: skip
            value = float(np.prod([values[name] ** p for name, p in exponents.items()]))
            yield Product(exponents, value, float(np.exp(low)), float(np.exp(high)), near)
