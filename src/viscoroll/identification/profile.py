"""Intervals by the likelihood's profile: how far a combination may go while all others follow."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import Found, Held, Problem

#: of a coordinate, first and longest step: farther ones land in other minima
_FIRST, _STEP = 0.25, 0.7
#: share of the s.d. that an end is found to
_CLOSE = 5e-3
#: places beyond an end that are looked at, as shares of the way to the bound
_BEYOND = (0.15, 0.4, 0.8)
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
    """Both sides; whether another piece lies beyond what rises; the best that was met; coordinates within (k, n)."""

    low: End
    high: End
    pieces: bool
    best: Found
    within: NDArray[np.float64]


class Walk:
    """A walk outwards from the best fit along a combination, each step from the last one's place."""

    def __init__(self, problem: Problem, best: Found, cov: NDArray[np.float64], powers: NDArray[np.float64]) -> None:
        self.problem, self.best, self.powers = problem, best, powers
        along = cov @ powers
        variance = float(powers @ along)
        self.sd, self.slope = math.sqrt(variance), along / variance
        self.passed = [best]

    def at(self, target: float, u: NDArray[np.float64], steps: int = _FEW) -> Found:
        """The least chi2 with the combination held, from ``u`` moved along the covariance."""
        moved = u + self.slope * (target - self.powers @ u)
        found = self.problem.least(moved, Held(self.powers, target, min(self.sd, 1.0)), _LOOSE, steps)
        self.passed.append(found)
        return found

    def look(self, target: float, u: NDArray[np.float64], rise: float) -> Found:
        """As :meth:`at`, given up where a few steps end far above."""
        found = self.at(target, u, _LOOK)
        return found if found.chi2 - self.best.chi2 > _HOPELESS * rise else self.at(target, found.u)

    def out(self, sign: float, reach: float, rise: float, start: Found | None = None) -> tuple[float | None, Found]:
        """(Distance from the best at which chi2 has risen, None if it has not within ``reach``; the last place).

        start : a place where it has not, from which to walk in place of the best.
        """
        centre, goal = float(self.powers @ self.best.u), math.sqrt(rise)
        last = start or self.best

        def height(d: float) -> float:
            nonlocal last
            last = self.at(centre + sign * d, last.u)
            return math.sqrt(max(last.chi2 - self.best.chi2, 0.0))

        a = 0.0 if start is None else sign * (float(self.powers @ start.u) - centre)
        fa = 0.0 if start is None else math.sqrt(max(start.chi2 - self.best.chi2, 0.0))
        d = min(a + min(goal * self.sd, _FIRST), reach)
        while (f := height(d)) < goal:
            if d >= reach * (1.0 - 1e-12):
                return None, last
            step = d - a
            rate = max((f - fa) / step, 0.05 * goal / step)
            a, fa = d, f
            d = min(d + min(max(1.05 * (goal - f) / rate, 0.3 * step), 3.0 * step, _STEP), reach)
        return self._between(height, (a, fa), (d, f), goal), last

    def _between(
        self, height: Callable[[float], float], low: tuple[float, float], high: tuple[float, float], goal: float
    ) -> float:
        """Where the height is that of the goal, by secants that stay inside."""
        (a, fa), (b, fb) = low, high
        while min(goal - fa, fb - goal) > _CLOSE * goal and b - a > _CLOSE * min(self.sd, b):
            d = a + (goal - fa) * (b - a) / (fb - fa)
            d = min(max(d, a + 0.05 * (b - a)), b - 0.05 * (b - a))
            f = height(d)
            if f < goal:
                a, fa = d, f
            else:
                b, fb = d, f
        return a + (goal - fa) * (b - a) / (fb - fa)


def profile(
    problem: Problem, best: Found, cov: NDArray[np.float64], powers: NDArray[np.float64], rise: float,
    others: Sequence[NDArray[np.float64]] = (),
) -> Profile:  # fmt: skip
    """The interval of a combination within which chi2 rises by no more than ``rise``.

    others : places from which to look beyond its ends: other minima, and the start.
    """
    walk = Walk(problem, best, cov, powers)
    centre = float(powers @ best.u)
    ends: list[End] = []
    pieces = False
    for sign in (-1.0, 1.0):
        edge = _edge(problem, powers, sign) - centre
        reach = abs(edge)
        if reach < 1e-9:
            ends.append(End(None))
            continue
        d, last = walk.out(sign, reach, rise)
        if d is not None:
            seen = []
            for u in others:
                own = sign * (float(powers @ u) - centre)
                places = [d + share * (reach - d) for share in _BEYOND] + [own] * (own > d)
                seen += [walk.look(centre + sign * x, u, rise) for x in places]
            lower = [one for one in seen if one.chi2 - best.chi2 < rise]
            if lower:
                pieces = True
                farthest = max(lower, key=lambda one: sign * float(powers @ one.u))
                d, last = walk.out(sign, reach, rise, farthest)
        made = () if d is None else tuple(
            name for name, gain in problem.pushes(last.u, powers).items() if gain > _MAKES * rise
        )  # fmt: skip
        ends.append(End(None if d is None else centre + sign * d, made))
    within = np.array([one.u for one in walk.passed if one.chi2 - best.chi2 <= rise])
    return Profile(ends[0], ends[1], pieces, min(walk.passed, key=lambda one: one.chi2), within)


def _edge(problem: Problem, powers: NDArray[np.float64], sign: float) -> float:
    """How far the ranges let a combination go."""
    return float(np.where(sign * powers > 0.0, problem.high, problem.low) @ powers)
