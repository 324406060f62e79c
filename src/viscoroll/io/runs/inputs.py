"""Uncertain inputs: values of each input at points of the unit cube, and the sections of a run file with these values.

An input is a :class:`Distribution`, or a column of a joint sample.  Each distribution is one dimension of the cube, and
so is each file: its columns share the row that is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ..sampling import LARGEST, SMALLEST

#: Word in place of a time of a drive: the same time again, so that the value jumps.
SAME = "same"
#: Share of the draws at either end that a flow map of the start speeds does not reach: those few are integrated.
_TAIL = 1e-6


@dataclass(frozen=True)
class Input:
    """An uncertain number of a run file.

    Attributes
    ----------
    name : name of the input, as in the columns of the results ("mu", "base_E", "tau_2", "drive_torque_time_1").
    section, key : where it stands in the file; of a number within a table the section is "section.key".
    """

    name: str
    section: str
    key: str


@dataclass(frozen=True)
class Distribution:
    """A distribution of scipy.stats, truncated to an interval.

    Attributes
    ----------
    law : frozen distribution.
    low, high : ends of the interval, which may be infinite.
    """

    law: Any
    low: float
    high: float

    @np.errstate(all="ignore")  # an overflow is infinite, which a motion refuses
    def ppf(self, u: Floats) -> Floats:
        """Return the quantiles of the truncated distribution, in the unit of the input.

        An upper tail is inverted from above, by the survival function, so that it keeps its digits.

        u: probabilities in (0, 1), of any shape, which the result has too.
        """
        law = self.law
        if (self.low, self.high) == law.support():
            return law.ppf(u)
        upper = law.cdf(self.low) > 0.5
        below, inverse = (law.sf, law.isf) if upper else (law.cdf, law.ppf)
        first, last = (below(end) for end in ((self.high, self.low) if upper else (self.low, self.high)))
        # ppf and cdf are inverse to rounding only
        return np.clip(inverse(first + ((1.0 - u) if upper else u) * (last - first)), self.low, self.high)


@dataclass(frozen=True)
class Inputs:
    """The inputs of a run.

    Attributes
    ----------
    content : name of a section of the file -> its content, with an :class:`Input` in place of each uncertain number.
    random : name -> distribution; one dimension of the unit cube each.
    joint : file -> name -> its column, (rows,); one dimension for each file: rows are drawn with replacement.
    correlated : names of the distributions under the Gaussian copula.
    mixing : Cholesky factor of their correlation matrix, lower triangular, (correlated, correlated); None without
        correlation.
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
        """Median of each input; of a file the row in its middle."""
        middle = self.values(np.full((len(self.dimensions), 1), 0.5))
        return {name: values.item() for name, values in middle.items()}

    def values(self, points: Floats) -> dict[str, Floats]:
        """Return the value of each input at points of the unit cube: name -> values, (n,), in the units of the file.

        points: (dimensions, n), in (0, 1), in the order of :attr:`dimensions`.
        """
        rows = dict(zip(self.dimensions, points, strict=True))
        if self.mixing is not None:
            from scipy.special import ndtr, ndtri

            normal = [ndtri(rows[name]) for name in self.correlated]
            # a sum in a fixed order, so that bits do not depend on the number of points
            mixed: Any = sum(part[:, np.newaxis] * row for part, row in zip(self.mixing.T, normal, strict=True))
            rows |= dict(zip(self.correlated, np.clip(ndtr(mixed), SMALLEST, LARGEST), strict=True))
        values = {name: law.ppf(rows[name]) for name, law in self.random.items()}
        for file, columns in self.joint.items():
            size = next(iter(columns.values())).size
            row = np.minimum((rows[file] * size).astype(np.int64), size - 1)
            values |= {name: column[row] for name, column in columns.items()}
        return values

    def ends(self, name: str, low: float = SMALLEST, high: float = LARGEST) -> Floats:
        """Return the smallest and the largest draw of an input, (2,), in the unit of the file.

        name: name of the input.
        low, high: probabilities whose quantiles are the ends of a distribution; a column of a file has its extremes.
        """
        if name in self.random:
            return self.random[name].ppf(np.array([low, high]))
        column = next(columns[name] for columns in self.joint.values() if name in columns)
        return np.array([column.min(), column.max()])

    def corners(self) -> dict[str, Floats]:
        """Return extreme inputs, name -> (n,): each input at one end and all others at the other, and all at one end.

        Columns of a file with several keep their medians, as their ends need not occur together.
        """
        names = [*self.random, *(name for columns in self.joint.values() if len(columns) == 1 for name in columns)]
        at_low = np.eye(len(names), len(names) + 1, dtype=bool)
        ends = {name: self.ends(name)[np.r_[row, ~row].astype(int)] for name, row in zip(names, at_low, strict=True)}
        return self.medians | ends

    def largest(self, name: str) -> float:
        """Return the largest magnitude of a start speed that a run file lets occur.

        name: "V0" or "omega0", which the file must give.
        Returns a float in the unit of the file: of a distribution without a millionth of the draws at each end; of a
        column of a data file its largest magnitude; of a fixed number that.
        """
        start = self.content["start"][name]
        return float(np.abs(self.ends(name, _TAIL, 1.0 - _TAIL) if isinstance(start, Input) else start).max())

    def filled(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the sections of the run file with values in place of the inputs: name of a section -> content.

        values: name of an input -> number or (n,), for every input.
        """
        return _fill_in(self.content, values)


def _fill_in(part: Any, values: Mapping[str, Any]) -> Any:
    """Return a part of the content with values in place of its inputs; in a list "same" repeats the number before.

    part: an input, or a section, list or number of the file.
    values: name of an input -> number or (n,).
    Returns a new part of the same kind.
    """
    if isinstance(part, Input):
        return values[part.name]
    if isinstance(part, dict):
        return {key: _fill_in(member, values) for key, member in part.items()}
    if not isinstance(part, list):
        return part
    numbers: list[Any] = []
    for member in part:
        numbers.append(numbers[-1] if numbers and member == SAME else _fill_in(member, values))
    return numbers


def inputs_in(part: Any) -> list[Input]:
    """Return the inputs within a part of the content of a run file."""
    members = part.values() if isinstance(part, dict) else part if isinstance(part, list) else ()
    return [part] if isinstance(part, Input) else [found for member in members for found in inputs_in(member)]
