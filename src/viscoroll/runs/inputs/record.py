"""Uncertain inputs: points of the unit cube -> a column of values for every input.

An input is a number, a :class:`Distribution`, or a column of a joint sample.  Each distribution is
one dimension of the cube, and so is each file: its columns share the row that is drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: No design draws a point closer to 0 or 1 than this (see :mod:`draws`).
SMALLEST, LARGEST = 2.0**-54, 1.0 - 2.0**-53


@dataclass(frozen=True)
class Distribution:
    """A frozen distribution of scipy.stats, cut to [low, high]."""

    law: Any
    low: float
    high: float

    @np.errstate(all="ignore")  # what overflows is infinite, which a motion refuses
    def ppf(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Inverse of the distribution function; from above where that keeps the digits of a cut tail."""
        if (self.low, self.high) == self.law.support():
            return self.law.ppf(u)
        if self.law.cdf(self.low) > 0.5:
            top, bottom = self.law.sf(self.low), self.law.sf(self.high)
            values = self.law.isf(bottom + (1.0 - u) * (top - bottom))
        else:
            bottom, top = self.law.cdf(self.low), self.law.cdf(self.high)
            values = self.law.ppf(bottom + u * (top - bottom))
        return np.clip(values, self.low, self.high)  # ppf and cdf are inverse only to rounding


@dataclass(frozen=True)
class Joint:
    """Columns of one file, drawn row by row with replacement."""

    columns: dict[str, NDArray[np.float64]]

    def rows(self, u: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """The columns at the rows that ``u`` picks."""
        size = next(iter(self.columns.values())).size
        picked = np.minimum((u * size).astype(np.int64), size - 1)
        return {name: values[picked] for name, values in self.columns.items()}


@dataclass(frozen=True)
class Inputs:
    """Every input of a run by name.

    Attributes
    ----------
    fixed : numbers.
    random : distributions, a dimension each.
    joint : samples by file, a dimension each.
    correlated, mixing : names of the distributions under the Gaussian copula, and the Cholesky
        factor of their correlation matrix.
    """

    fixed: dict[str, float]
    random: dict[str, Distribution] = field(default_factory=dict)
    joint: dict[str, Joint] = field(default_factory=dict)
    correlated: tuple[str, ...] = ()
    mixing: NDArray[np.float64] | None = None

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions of the cube: distributions, then files."""
        return (*self.random, *self.joint)

    @property
    def uncertain(self) -> tuple[str, ...]:
        """Names of the inputs that are not one number."""
        return (*self.random, *(name for sample in self.joint.values() for name in sample.columns))

    @property
    def si(self) -> bool:
        """Whether they are those of a cylinder, in SI units."""
        return "R" in (*self.fixed, *self.uncertain)

    def values(self, points: NDArray[np.float64]) -> dict[str, Any]:
        """Every input at ``points`` (dimensions, n) in (0, 1): a number, or an array (n,)."""
        rows = dict(zip(self.dimensions, points, strict=True))
        if self.mixing is not None:
            rows |= dict(zip(self.correlated, self._mixed([rows[name] for name in self.correlated]), strict=True))
        values: dict[str, Any] = dict(self.fixed)
        values |= {name: law.ppf(rows[name]) for name, law in self.random.items()}
        for name, sample in self.joint.items():
            values |= sample.rows(rows[name])
        return values

    def _mixed(self, rows: list[NDArray]) -> list[NDArray]:
        """Independent uniform rows -> uniform rows under the copula, sums in a fixed order."""
        from scipy.special import ndtr, ndtri

        assert self.mixing is not None
        normal = [ndtri(row) for row in rows]
        mixed = []
        for n in range(len(rows)):
            total = self.mixing[n, 0] * normal[0]
            for k in range(1, n + 1):
                total = total + self.mixing[n, k] * normal[k]
            mixed.append(np.clip(ndtr(total), SMALLEST, LARGEST))
        return mixed

    def largest(self, *names: str) -> float:
        """The largest size of these inputs, but for a millionth of the draws at each end."""
        ends = np.array([1e-6, 1.0 - 1e-6])
        sizes = [abs(self.fixed[name]) for name in names if name in self.fixed]
        sizes += [np.abs(self.random[name].ppf(ends)).max() for name in names if name in self.random]
        for sample in self.joint.values():
            sizes += [np.abs(sample.columns[name]).max() for name in names if name in sample.columns]
        return float(max(sizes))
