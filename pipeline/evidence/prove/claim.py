"""One row of a proof: a claim, its domain and bound, and the errors that were found, as they come."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


class Claim:
    """Keeps the worst error and where it was, the mean, and the number of points.

    A NaN counts as infinite: it must neither pass a bound nor be forgotten behind a later number.
    """

    def __init__(self, claim: str, domain: str, bound: float) -> None:
        self.claim, self.domain, self.bound = claim, domain, bound
        self.worst, self.where = 0.0, ""
        self.points, self._sum = 0, 0.0

    def add(self, errors: ArrayLike, where: str = "") -> None:
        """One error or an array of them; negative ones, which are within what was allowed for, count as 0."""
        found = np.asarray(errors, dtype=float)
        found = np.where(np.isnan(found), np.inf, np.maximum(found, 0.0))
        self.points += found.size
        self._sum += float(np.sum(found))
        worst = float(np.max(found, initial=0.0))
        if worst > self.worst or not self.where:
            self.worst, self.where = max(worst, self.worst), where

    @property
    def row(self) -> dict[str, Any]:
        """The row as proofs.json has it."""
        mean = self._sum / self.points if self.points else math.nan
        return {
            "claim": self.claim, "domain": self.domain, "bound": self.bound, "points": self.points,
            "worst": self.worst, "mean": mean, "where": self.where,
        }  # fmt: skip


def at(**values: float) -> str:
    """Where an error was found, to the last digit."""
    return ", ".join(f"{name} = {value!r}" for name, value in values.items())
