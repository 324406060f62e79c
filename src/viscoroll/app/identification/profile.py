"""Intervals by the likelihood's profile: how far a combination may go while all others follow."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .problem import Found, Problem, Vector

#: of a coordinate, first and longest step: farther ones land in other minima
_FIRST, _STEP = 0.25, 0.7
#: of the height at an end, how near it is found
_CLOSE = 3e-3
#: places at an end and beyond that are looked at, as shares of the way to the bound, and how often
_BEYOND, _OFTEN = (0.0, 0.15, 0.4, 0.8), 3
#: of the rise at an end, what shows that another branch lies below
_LOWER = 0.98
#: tolerance and steps of a place on the way
_LOOSE, _FEW = 1e-5, 30
#: rise over what is asked from which no search leads down to another piece
_HOPELESS = 1e3
#: share of the rise that an unknown at the end of its range must cost to make an end
_MAKES = 0.02


class Profile(NamedTuple):
    """How far a combination may go, and where it may be.

    ends : coordinates, None on a side that is open; made_by : of each end, unknowns whose range makes it; pieces :
    whether another branch led on where a walk ended; best : that was met; within : places met that fit, (k, n).
    """

    ends: list[float | None]
    made_by: list[list[str]]
    pieces: bool
    best: Found
    within: Vector


class Walk:
    """A walk outwards from the best fit along a combination, each step from the last one's place."""

    def __init__(self, fit: Any, powers: Vector) -> None:
        self.problem: Problem = fit._problem
        self.best: Found = fit._best
        self.powers, along = powers, fit._cov @ powers
        self.sd, self.slope = math.sqrt(powers @ along), along / (powers @ along)
        self.passed = [self.best]

    def way(self, u: Vector) -> float:
        """How far a place is from the best."""
        return float(self.powers @ (u - self.best.u))

    def rise(self, found: Found) -> float:
        """By how much chi2 is above the best."""
        return max(found.chi2 - self.best.chi2, 0.0)

    def moved(self, d: float, u: Vector) -> Vector:
        """A place so far from the best: ``u`` moved along the covariance."""
        return u + self.slope * (d - self.way(u))

    def at(self, d: float, u: Vector) -> Found:
        """The least chi2 so far from the best, near ``u``."""
        self.passed.append(self.problem.least(self.moved(d, u), self.powers, _LOOSE, _FEW))
        return self.passed[-1]

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
            f = math.sqrt(self.rise(known[d])) - goal
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

    def beyond(self, d: float, reach: float, rise: float, fit: Any) -> list[Found]:
        """Places at an end or behind it, met from elsewhere, where chi2 has risen by less, the farthest last."""
        found = []
        for u, shares in [*((u, _BEYOND) for u in fit._others), *((u, _BEYOND[:1]) for u in fit._ends)]:
            own = self.way(u)
            for place in [d + share * (reach - d) for share in shares] + [own] * ((own - d) * (reach - d) > 0.0):
                seen = np.clip(self.moved(place, u), self.problem.low, self.problem.high)
                if self.problem.cost(seen) - self.best.chi2 < _HOPELESS * rise:
                    found.append(self.at(place, u))
        return sorted((one for one in found if self.rise(one) < _LOWER * rise), key=lambda one: abs(self.way(one.u)))


def profile(fit: Any, powers: Vector, rise: float) -> Profile:
    """The interval of a combination within which chi2 rises by no more than ``rise``.

    Beyond the ends that a walk finds it looks from other minima, the start, and the ends of other unknowns.
    """
    walk, problem, found = Walk(fit, powers), fit._problem, Profile([], [], False, fit._best, np.empty(0))
    for near, far in ((problem.low, problem.high), (problem.high, problem.low)):
        reach = walk.way(np.where(powers > 0.0, near, far))
        d, last = walk.out(reach, rise, fit._best)
        for _ in range(_OFTEN):
            if d is None or not (seen := walk.beyond(d, reach, rise, fit)):
                break
            found = found._replace(pieces=True)
            d, last = walk.out(reach, rise, seen[-1])
        found.ends.append(None if d is None else float(powers @ fit._best.u) + d)
        found.made_by.append([] if d is None else _made_by(problem, last.u, powers, rise))
    within = np.array([one.u for one in walk.passed if walk.rise(one) <= rise])
    return found._replace(best=min(walk.passed, key=lambda one: one.chi2), within=within)


def _made_by(problem: Problem, u: Vector, powers: Vector, rise: float) -> list[str]:
    """Unknowns at an end of their range that would lower chi2 by going beyond, by slopes, the combination held."""
    at = [i for i in problem.at_end(u) if not powers[i]]
    if not at:
        return []
    r, J = problem.weighed(u)
    own = without(J, at, [i for i in problem.live if i not in at and i != np.flatnonzero(powers)[0]])
    gains = (r @ own) ** 2 / np.maximum((own**2).sum(axis=0), 1e-300)
    return [problem.names[i] for i, gain in zip(at, gains, strict=True) if gain > _MAKES * rise]


def without(J: Vector, which: list[int], others: list[int]) -> Vector:
    """Columns of slopes without what ``others`` take of them."""
    return J[:, which] - J[:, others] @ np.linalg.lstsq(J[:, others], J[:, which], rcond=None)[0]
