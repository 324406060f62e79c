"""How chi2 rises about the best fit: intervals by profiles, and what is determined of what cannot be told apart."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cache
from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from .problem import Found, Problem

#: of a coordinate, first and longest step: farther ones land in other minima
_FIRST, _STEP = 0.25, 0.7
#: of the height at an end, how near it is found
_CLOSE = 3e-3
#: places at an end and beyond that are looked at, as shares of the way to the bound, and how often
_BEYOND, _OFTEN = (0.0, 0.15, 0.4, 0.8), 3
#: tolerance and steps of a place on the way
_LOOSE, _FEW = 1e-5, 30
#: over the rise at an end, what shows that another branch lies below, and from what no search leads down to one
_LOWER, _HOPELESS = 0.98, 1e3
#: share of the rise that an unknown at the end of its range must cost to make an end
_MAKES = 0.02
#: of coordinates, what is one place
_SAME = 1e-6
#: width of an interval of a coordinate from which on it counts as not determined, and correlation with such a one from
#: which on others do; width of a product from which on that does
_WIDE, _TOGETHER, _NARROW = 2.0, 0.95, 1.0
#: exponents are rounded to whole numbers, halves, ... where places stay as near to each other as by this factor
_PARTS, _AS_NEAR = (1, 2, 10, 100), 2.0
#: width of what holds near the best values alone, over the least of what holds everywhere, to be worth a word
_SHARPER = 1.0 / 3.0


class Profile(NamedTuple):
    """How far a combination may go, and where it may be.

    ends : coordinates, None on a side that is open; made_by : of each end, unknowns whose range makes it; pieces :
    whether another branch led on where a walk ended; best : that was met; within : places met that fit, (k, n).
    """

    ends: list[float | None]
    made_by: list[list[str]]
    pieces: bool
    best: Found
    within: Floats


class Product(NamedTuple):
    """A product of powers of unknowns that the data determine where they cannot tell these apart.

    powers : exponents by name; those of brake, drag, V0, omega0 and t0 hold near the values found.
    value : of the product.
    low, high : ends of its interval over ``value``.
    near : whether this holds by slopes, within about a fifth of the values found, and other exponents farther off.
    """

    powers: dict[str, float]
    value: float
    low: float
    high: float
    near: bool


class Likelihood:
    """chi2 about the best of the minima ``found``; ``cov`` : by slopes there, and as far as the ranges let it."""

    def __init__(self, problem: Problem, found: list[Found]) -> None:
        self.problem, self.best, (u, _) = problem, found[0], found[0]
        J = problem.weighed(u)[1]
        self.cov = np.linalg.inv(J.T @ J + np.diag(12.0 / (problem.high - problem.low) ** 2))
        self.others = [v for v in (*(one.u for one in found[1:]), problem.start) if np.abs(v - u).max() > _SAME]
        self.ends: list[Floats] = []
        self._walked = cache(lambda rise, *powers: Walk(self, np.array(powers)).both_ways(rise))

    def profile(self, powers: Floats, rise: float) -> Profile:
        """The interval of a combination within which chi2 rises by no more than ``rise``.

        Beyond the ends that a walk finds it looks from other minima, the start, and the ends of other unknowns.
        """
        return self._walked(rise, *powers.tolist())

    def axes(self, rise: float) -> dict[int, Profile]:
        """Of each unknown that acts; where a side is open, as seen from the ends of what fits of the others too."""
        found = {i: self.profile(np.eye(self.best.u.size)[i], rise) for i in self.problem.live}
        if not self.ends and any(None in one.ends for one in found.values()):
            ways = ((one.within, one.within[:, i]) for i, one in found.items())
            self.ends = [within[n] for within, way in ways for n in (np.argmin(way), np.argmax(way))]
            self._walked.cache_clear()
            return self.axes(rise)
        return found

    def undetermined(self, rise: float) -> list[int]:
        """Unknowns whose interval tells little, and what is correlated with these."""
        problem, sd, wide = self.problem, np.sqrt(np.diag(self.cov)), []
        for i, one in self.axes(rise).items():
            least, most = problem.low[i], problem.high[i]
            low, high = (bound if end is None else end for end, bound in zip(one.ends, (least, most), strict=True))
            if high - low > min(_WIDE, 0.5 * (most - least)):
                wide.append(i)
        together = np.abs(self.cov / np.outer(sd, sd))[:, wide] > _TOGETHER
        return [i for i in problem.live if together[i].any()]

    def products(self, which: list[int], rise: float) -> list[Product]:
        """What is determined of undetermined unknowns: by places that all fit, else by slopes at the best.

        And what these say of its neighbourhood where that is much more, or where none holds over the whole interval.
        """
        if len(which) < 2:
            return []
        steep = [*self._by_slopes(which)]
        found = self._narrow(self._by_places(which, rise), rise) or self._narrow(steep, rise)
        least = min((one.high - one.low for one in found), default=math.inf)
        near = self._narrow(steep, rise, near=True)
        return found + [one for one in near if one.high - one.low < _SHARPER * least]

    def _narrow(self, family: Iterable[Floats], rise: float, near: bool = False) -> list[Product]:
        """Products with their intervals, by profiles or ``near`` the best, up to the first one that is open or wide."""
        found, values = [], self.problem.values(self.best.u)
        for powers in family:
            half, centre = math.sqrt(rise * (powers @ self.cov @ powers)), powers @ self.best.u
            low, high = (centre - half, centre + half) if near else self.profile(powers, rise).ends
            if low is None or high is None or high - low > _NARROW:
                break
            exponents = {
                one.name: p * (values[one.name] / one.spread(values[one.name]))
                for one, p in zip(self.problem.unknowns, powers.tolist(), strict=True) if p
            }  # fmt: skip
            value = math.prod(values[name] ** p for name, p in exponents.items())
            found.append(Product(exponents, value, math.exp(low - centre), math.exp(high - centre), near))
        return found

    def _by_places(self, which: list[int], rise: float) -> Iterator[Floats]:
        """Combinations in which all places that fit lie nearest to each other, best first, as round as that allows."""
        axes = self.axes(rise)
        within = np.concatenate([axes[i].within for i in which])[:, which]
        for v in np.linalg.svd(within - within.mean(axis=0))[2][::-1]:
            exact = v / v[np.argmax(np.abs(v))]
            rounded = (np.round(exact * parts) / parts for parts in _PARTS)
            width = _AS_NEAR * np.ptp(within @ exact)
            powers = next((p for p in rounded if np.ptp(within @ p) <= width), np.round(exact, 2))
            yield powers @ np.eye(self.best.u.size)[which]

    def _by_slopes(self, which: list[int]) -> Iterator[Floats]:
        """Combinations that are known best, whatever other unknowns are."""
        for v in np.linalg.eigh(self.cov[np.ix_(which, which)])[1].T:
            yield np.round(v / v[np.argmax(np.abs(v))], 2) @ np.eye(self.best.u.size)[which]


class Walk:
    """A walk outwards from the best fit along a combination, each step from the last one's place."""

    def __init__(self, about: Likelihood, powers: Floats) -> None:
        self.about, self.problem, self.best = about, about.problem, about.best
        self.powers, along = powers, about.cov @ powers
        self.sd, self.slope = math.sqrt(powers @ along), along / (powers @ along)
        self.passed = [self.best]

    def way(self, u: Floats) -> float:
        """How far a place is from the best."""
        return float(self.powers @ (u - self.best.u))

    def moved(self, d: float, u: Floats) -> Floats:
        """A place so far from the best: ``u`` moved along the covariance."""
        return u + self.slope * (d - self.way(u))

    def at(self, d: float, u: Floats) -> Found:
        """The least chi2 so far from the best, near ``u``."""
        self.passed.append(self.problem.least(self.moved(d, u), self.powers, _LOOSE, _FEW))
        return self.passed[-1]

    def both_ways(self, rise: float) -> Profile:
        """As :meth:`Likelihood.profile`."""
        problem, ends, made_by, pieces = self.problem, [], [], False
        for near, far in ((problem.low, problem.high), (problem.high, problem.low)):
            reach = self.way(np.where(self.powers > 0.0, near, far))
            d, last = self.out(reach, rise, self.best)
            for _ in range(_OFTEN):
                if d is None or not (seen := self.beyond(d, reach, rise)):
                    break
                pieces = True
                d, last = self.out(reach, rise, seen[-1])
            ends.append(None if d is None else float(self.powers @ self.best.u) + d)
            made_by.append([] if d is None else self.made_by(last.u, rise))
        within = np.array([one.u for one in self.passed if one.chi2 - self.best.chi2 <= rise])
        return Profile(ends, made_by, pieces, min(self.passed, key=lambda one: one.chi2), within)

    def out(self, reach: float, rise: float, low: Found) -> tuple[float | None, Found]:
        """(Where chi2 has risen by so much, None if less up to ``reach``; the place there), from a lower one."""
        from scipy.optimize import brentq

        goal, d = math.sqrt(rise), self.way(low.u)
        step, known = min(goal * self.sd, _FIRST), {d: low}

        def over(d: float) -> float:  # the root of the rise grows as the way
            if d not in known:
                b, *more = sorted(known, key=lambda b: abs(d - b))
                u = known[b].u
                known[d] = self.at(d, u + (u - known[more[0]].u) * ((d - b) / (b - more[0])) if more else u)
            f = math.sqrt(max(known[d].chi2 - self.best.chi2, 0.0)) - goal
            return 0.0 if abs(f) < _CLOSE * goal else f

        f = over(d)
        while f < 0.0:
            if abs(reach - d) < 1e-9:
                return None, known[d]
            a, fa = d, f
            d = a + math.copysign(min(step, abs(reach - a)), reach)
            f = over(d)
            rate = max((f - fa) / step, 0.05 * goal / step)
            step = min(max(-1.05 * f / rate, 0.3 * step), 3.0 * step, _STEP)
        end = brentq(over, a, d, xtol=_CLOSE * min(self.sd, 1.0))
        return end, known[min(known, key=lambda d: abs(d - end))]

    def beyond(self, d: float, reach: float, rise: float) -> list[Found]:
        """Places at an end or behind it, met from elsewhere, where chi2 has risen by less, the farthest last."""
        found, about = [], self.about
        for u, shares in [*((u, _BEYOND) for u in about.others), *((u, _BEYOND[:1]) for u in about.ends)]:
            own = self.way(u)
            for place in [d + share * (reach - d) for share in shares] + [own] * ((own - d) * (reach - d) > 0.0):
                seen = np.clip(self.moved(place, u), self.problem.low, self.problem.high)
                if self.problem.cost(seen) - self.best.chi2 < _HOPELESS * rise:
                    found.append(self.at(place, u))
        lower = [one for one in found if one.chi2 - self.best.chi2 < _LOWER * rise]
        return sorted(lower, key=lambda one: abs(self.way(one.u)))

    def made_by(self, u: Floats, rise: float) -> list[str]:
        """Unknowns at an end of their range that would lower chi2 by going beyond, by slopes, the combination held."""
        problem = self.problem
        if not (at := [i for i in problem.at_end(u) if not self.powers[i]]):
            return []
        (r, J), others = problem.weighed(u), [i for i in problem.live if i not in at]
        others.remove(np.flatnonzero(self.powers)[0])
        own = J[:, at] - J[:, others] @ np.linalg.lstsq(J[:, others], J[:, at], rcond=None)[0]
        gains = (r @ own) ** 2 / np.maximum((own**2).sum(axis=0), 1e-300)
        return [problem.names[i] for i, gain in zip(at, gains, strict=True) if gain > _MAKES * rise]
