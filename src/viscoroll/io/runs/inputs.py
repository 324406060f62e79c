"""Uncertain inputs: points of the unit cube -> a column of values for every input, and sections with these in them.

An input is a :class:`Distribution`, or a column of a joint sample.  Each distribution is one dimension of the cube,
and so is each file: its columns share the row that is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ..sampling import LARGEST, SMALLEST

#: in place of a time of a drive: that before once more, so that the value jumps
SAME = "same"


@dataclass(frozen=True)
class Input:
    """The place of an uncertain number in a file: a key of a section."""

    name: str
    section: str
    key: str


@dataclass(frozen=True)
class Distribution:
    """A frozen distribution of scipy.stats, cut to [low, high]."""

    law: Any
    low: float
    high: float

    @np.errstate(all="ignore")  # what overflows is infinite, which a motion refuses
    def ppf(self, u: Floats) -> Floats:
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
class Inputs:
    """The inputs of a run.

    Attributes
    ----------
    content : sections of the file, with an :class:`Input` in place of every uncertain number.
    random : distributions, a dimension each.
    joint : columns of each file, a dimension: rows are drawn with replacement.
    correlated, mixing : names of the distributions under the Gaussian copula, and the Cholesky
        factor of their correlation matrix.
    """

    content: dict[str, Any]
    random: dict[str, Distribution] = field(default_factory=dict)
    joint: dict[str, dict[str, Floats]] = field(default_factory=dict)
    correlated: tuple[str, ...] = ()
    mixing: Floats | None = None

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions of the cube: distributions, then files."""
        return (*self.random, *self.joint)

    @property
    def uncertain(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return (*self.random, *(name for columns in self.joint.values() for name in columns))

    @property
    def medians(self) -> dict[str, Any]:
        """Every input in the middle of its draws; of a file the row in its middle."""
        return {name: each.item() for name, each in self.values(np.full((len(self.dimensions), 1), 0.5)).items()}

    def values(self, points: Floats) -> dict[str, Floats]:
        """Every input (n,) at ``points`` (dimensions, n) in (0, 1)."""
        rows = dict(zip(self.dimensions, points, strict=True))
        if self.mixing is not None:
            from scipy.special import ndtr, ndtri

            normal = [ndtri(rows[name]) for name in self.correlated]
            # a sum in a fixed order, whatever the number of points
            mixed: Any = sum(part[:, np.newaxis] * row for part, row in zip(self.mixing.T, normal, strict=True))
            rows |= dict(zip(self.correlated, np.clip(ndtr(mixed), SMALLEST, LARGEST), strict=True))
        values = {name: law.ppf(rows[name]) for name, law in self.random.items()}
        for name, columns in self.joint.items():
            size = next(iter(columns.values())).size
            picked = np.minimum((rows[name] * size).astype(np.int64), size - 1)
            values |= {each: column[picked] for each, column in columns.items()}
        return values

    def ends(self, name: str, low: float = SMALLEST, high: float = LARGEST) -> Floats:
        """The least and the largest draw of an input, or those of these shares."""
        if name in self.random:
            return self.random[name].ppf(np.array([low, high]))
        column = next(columns[name] for columns in self.joint.values() if name in columns)
        return np.array([column.min(), column.max()])

    def corners(self) -> dict[str, Floats]:
        """Each input at its one end while all others are at their other, and all at the same."""
        names = [*self.random, *(name for columns in self.joint.values() if len(columns) == 1 for name in columns)]
        own = np.hstack([np.eye(len(names), dtype=bool), np.zeros((len(names), 1), dtype=bool)])
        ends = {name: self.ends(name)[np.r_[one, ~one].astype(int)] for name, one in zip(names, own, strict=True)}
        return self.medians | ends

    def largest(self, name: str) -> float:
        """The largest size of a start speed, but for a millionth of the draws at each end."""
        given = self.content["start"][name]
        return float(np.abs(self.ends(name, 1e-6, 1.0 - 1e-6) if isinstance(given, Input) else given).max())

    def filled(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The sections with these values in place of the inputs."""
        return _filled(self.content, values)


def _filled(part: Any, values: Mapping[str, Any]) -> Any:
    if isinstance(part, Input):
        return values[part.name]
    if isinstance(part, dict):
        return {key: _filled(each, values) for key, each in part.items()}
    if not isinstance(part, list):
        return part
    found: list[Any] = []
    for each in part:
        found.append(found[-1] if found and each == SAME else _filled(each, values))
    return found


def inputs_in(part: Any) -> list[Input]:
    """The uncertain numbers within a section, or in all."""
    parts = part.values() if isinstance(part, dict) else part if isinstance(part, list) else ()
    return [part] if isinstance(part, Input) else [each for one in parts for each in inputs_in(one)]
