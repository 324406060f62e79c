"""Intervals by the likelihood's profile: how far a combination may go while all others follow."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .problem import Found, Problem, Vector

#: of a coordinate, first and longest step: farther ones land in other minima
_FIRST, _STEP = 0.25, 0.7
#: of the height at an end, how near it is found
_CLOSE = 3e-3
#: places beyond an end that are looked at, as shares of the way to the bound
_BEYOND = (0.15, 0.4, 0.8)
#: steps of a search that ended above the height of an end, to be sure of it
_MANY = 100
#: tolerance and steps of a place on the way; steps of a look, and the rise over what is asked that ends it
_LOOSE, _FEW = 1e-5, 15
_LOOK, _HOPELESS = 4, 20.0
#: share of the rise that an unknown at the end of its range must cost to make an end
_MAKES = 0.02


class End(NamedTuple):
    """One side of an interval, in coordinates: None where it is open; ``bounds``: unknowns whose range makes it."""

    at: float | None
    bounds: tuple[str, ...] = ()


class Profile(NamedTuple):
    """Low and high end; whether another piece lies beyond them; the best that was met; coordinates within (k, n)."""

    ends: tuple[End, End]
    pieces: bool
    best: Found
    within: Vector


class Walk:
    """A walk outwards from the best fit along a combination, each step from the last one's place."""

    def __init__(self, problem: Problem, best: Found, cov: Vector, powers: Vector) -> None:
        self.problem, self.best, self.powers = problem, best, powers
        along = cov @ powers
        self.sd, self.slope = math.sqrt(powers @ along), along / (powers @ along)
        self.passed = [best]

    def way(self, u: Vector) -> float:
        """How far a place is from the best."""
        return float(self.powers @ (u - self.best.u))

    def height(self, found: Found) -> float:
        """Root of what chi2 has risen by, which grows as the way."""
        return math.sqrt(max(found.chi2 - self.best.chi2, 0.0))

    def at(self, d: float, u: Vector, steps: int = _FEW) -> Found:
        """The least chi2 so far from the best, from ``u`` moved along the covariance."""
        found = self.problem.least(u + self.slope * (d - self.way(u)), self.powers, _LOOSE, steps)
        self.passed.append(found)
        return found

    def out(self, reach: float, goal: float, start: Found | None = None) -> tuple[float | None, Found]:
        """(Where the height is the goal, None if it is less up to ``reach``; the place there), from a lower one."""
        from scipy.optimize import brentq

        low = start or self.best
        d, step, known = self.way(low.u), min(goal * self.sd, _FIRST), {}

        def over(d: float) -> float:
            nonlocal low
            if d not in known:
                found = self.at(d, low.u)
                if self.height(found) > goal:
                    found = self.at(d, found.u, _MANY)
                known[d] = found
                low = found if self.height(found) < goal else low
            f = self.height(known[d]) - goal
            return 0.0 if abs(f) < _CLOSE * goal else f

        known[d] = low
        f = over(d)
        while f < 0.0:
            if abs(reach - d) < 1e-9:
                return None, low
            a, fa = d, f
            d = a + math.copysign(min(step, abs(reach - a)), reach)
            f = over(d)
            rate = max((f - fa) / step, 0.05 * goal / step)
            step = min(max(-1.05 * f / rate, 0.3 * step), 3.0 * step, _STEP)
        end = brentq(over, a, d, xtol=_CLOSE * min(self.sd, 1.0))
        return end, known[min(known, key=lambda d: abs(d - end))]

    def beyond(self, d: float, reach: float, rise: float, others: list[Vector]) -> list[Found]:
        """Places behind an end, met from elsewhere, where chi2 has risen by less."""
        found = []
        for u in others:
            own = self.way(u)
            for place in [d + share * (reach - d) for share in _BEYOND] + [own] * ((own - d) * (reach - d) > 0.0):
                look = self.at(place, u, _LOOK)
                if look.chi2 - self.best.chi2 < _HOPELESS * rise:
                    found.append(self.at(place, look.u))
        return [one for one in found if one.chi2 - self.best.chi2 < rise]


def profile(problem: Problem, best: Found, cov: Vector, powers: Vector, rise: float, others: list[Vector]) -> Profile:
    """The interval of a combination within which chi2 rises by no more than ``rise``.

    others : places from which to look beyond its ends: other minima, and the start.
    """
    walk, pieces = Walk(problem, best, cov, powers), False
    ends: list[End] = []
    for near, far in ((problem.low, problem.high), (problem.high, problem.low)):
        reach = walk.way(np.where(powers > 0.0, near, far))
        d, last = walk.out(reach, math.sqrt(rise))
        if d is not None and (seen := walk.beyond(d, reach, rise, others)):
            pieces = True
            d, last = walk.out(reach, math.sqrt(rise), max(seen, key=lambda one: abs(walk.way(one.u))))
        made = {} if d is None else problem.pushes(last.u, powers)
        bounds = tuple(name for name, gain in made.items() if gain > _MAKES * rise)
        ends.append(End(None if d is None else float(powers @ best.u) + d, bounds))
    within = np.array([one.u for one in walk.passed if one.chi2 - best.chi2 <= rise])
    return Profile((ends[0], ends[1]), pieces, min(walk.passed, key=lambda one: one.chi2), within)
