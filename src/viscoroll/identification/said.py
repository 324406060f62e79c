"""What is said before any interval: residuals that are no noise, unknowns that do not act."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import Problem

#: norm of a column of slopes that counts as none: a factor of e moves all residuals by so small a part of sigma
_NONE = 1e-2
#: places beside the start at which slopes are looked at
_PLACES = 4


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
        most = np.maximum(most, np.linalg.norm(problem.jacobian(u), axis=0))
    return tuple(name for name, size in zip(problem.names, most, strict=True) if size < _NONE)
