"""What the data do not say: unknowns that do not act, those that cannot be told apart, residuals that are no noise."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import Problem
from .profile import Profile

#: of the largest column of slopes, what counts as none
_NONE = 1e-5
#: places beside the start at which slopes are looked at
_PLACES = 4
#: width of an interval of a coordinate from which on it counts as not determined, and of a product
_WIDE, NARROW = 2.0, 1.0
#: exponents are rounded to whole numbers, halves, ... where places stay as near to each other as by this factor
_PARTS, _AS_NEAR = (1, 2, 10, 100), 1.5


class Noise(NamedTuple):
    """Residuals of a column: rms over sigma, lag-1 correlation in the order of its places, what noise allows of it."""

    rms: float
    lag: float
    allowed: float
    #: whether sigma was given, so that rms says something
    given: bool

    @property
    def is_noise(self) -> bool:
        """Within three standard deviations of what noise does; what is far below sigma may go together."""
        large = self.given and self.rms > 1.0 + self.allowed / math.sqrt(2.0)
        return self.lag * self.rms**2 <= self.allowed and not large


def noise_of(problem: Problem, r: NDArray[np.float64]) -> dict[str, Noise]:
    """Of each column, by record and quantity."""
    found = {}
    for one in problem.columns:
        part = r[one.at][problem.records[one.record].order()]
        power = float(part @ part)
        lag = float(part[1:] @ part[:-1]) / power if power > 0.0 else 0.0
        found[str(one)] = Noise(math.sqrt(power / part.size), lag, 3.0 / math.sqrt(part.size), not one.estimated)
    return found


def flat(problem: Problem) -> tuple[str, ...]:
    """Unknowns that act nowhere: at the start an unknown may have ceased to, so that other places are asked too."""
    rng, middle = np.random.default_rng(0), 0.5 * (problem.low + problem.high)
    others = middle + 0.25 * (problem.high - problem.low) * rng.uniform(-1.0, 1.0, (_PLACES, middle.size))
    most = np.zeros(middle.size)
    for u in (problem.start, *others):
        size = np.linalg.norm(problem.jacobian(u)[: problem.y.size], axis=0)
        most = np.maximum(most, size / max(size.max(), 1e-300))
    prior = {problem.names[i] for i, *_ in problem.prior}
    return tuple(name for name, share in zip(problem.names, most, strict=True) if share < _NONE and name not in prior)


def wide(problem: Problem, which: int, sides: Profile) -> bool:
    """Whether an interval, with the range's ends for open sides, tells little: a factor of e^2, or half the range."""
    low = problem.low[which] if sides.low.at is None else sides.low.at
    high = problem.high[which] if sides.high.at is None else sides.high.at
    return bool(high - low > min(_WIDE, 0.5 * (problem.high[which] - problem.low[which])))


def directions(within: NDArray[np.float64], J: NDArray[np.float64]) -> list[list[NDArray[np.float64]]]:
    """Combinations that the data may determine, best first: by places that all fit (k, n), and by slopes at the best.

    The former are those in which the places lie nearest to each other, with exponents as round as that allows; the
    latter are where J, without what other unknowns take of it, is largest.
    """
    far, near = [], []
    for v in np.linalg.svd(within - within.mean(axis=0), full_matrices=True)[2][::-1]:
        exact = v / v[np.argmax(np.abs(v))]
        width = np.ptp(within @ exact)
        rounded = (np.round(exact * parts) / parts for parts in _PARTS)
        far.append(next((p for p in rounded if np.ptp(within @ p) <= _AS_NEAR * width), np.round(exact, 2)))
    for v in np.linalg.svd(J, full_matrices=False)[2]:
        near.append(np.round(v / v[np.argmax(np.abs(v))], 2))
    return [far, near]


def without(J: NDArray[np.float64], which: list[int], rest: list[int]) -> NDArray[np.float64]:
    """Slopes over some unknowns, without what the ``rest`` can take of them."""
    return J[:, which] - J[:, rest] @ np.linalg.lstsq(J[:, rest], J[:, which], rcond=None)[0] if rest else J[:, which]
