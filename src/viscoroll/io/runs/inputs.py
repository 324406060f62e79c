"""Uncertain inputs: values of each input at points of the unit cube, and the sections of a run file with these values.

An input is a :class:`Distribution`, or a column of a joint sample.  Each distribution is one dimension of the cube, and
so is each file: its columns share the row that is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
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

        If more than half of the whole distribution lies below the interval, it is inverted from above, by the survival
        function, so that the upper tail keeps its digits.

        u: probabilities in (0, 1), not checked, of any shape.
        Returns an array of that shape, within [low, high]; where the interval is the support of the law, the quantiles
        of the law as scipy computes them, which may overflow to an infinity.  A NaN of scipy is passed on.
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
        """Median of each input, name -> float in the unit of the file; of N rows of a file the row floor(N/2)."""
        middle = self.values(np.full((len(self.dimensions), 1), 0.5))
        return {name: values.item() for name, values in middle.items()}

    def values(self, points: Floats) -> dict[str, Floats]:
        """Map points of the unit cube to the values of all inputs.

        Under the copula the coordinates of correlated inputs are first replaced by those of normal variables with the
        stated correlations.  A distribution takes its quantile at its coordinate u, a file of N rows the row floor(u N)
        for all its columns.

        points: (dimensions, n), in (0, 1), not checked, a row for each of :attr:`dimensions` in their order; another
            number of rows raises ValueError.
        Returns name -> values, (n,), float64, in the units of the file: distributions, then columns.  A quantile that
        overflows is infinite.
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
        """Return the ends of the draws of an input.

        name: name of the input; another name raises StopIteration.
        low, high: probabilities in (0, 1) of the ends of a distribution, by default the smallest and the largest
            coordinate that a point has, 2^-54 and 1 - 2^-53; ignored for a column of a file.
        Returns [lower, upper], (2,), in the unit of the file: quantiles of a distribution, which may be infinite; the
        smallest and the largest number of a column.
        """
        if name in self.random:
            return self.random[name].ppf(np.array([low, high]))
        column = next(columns[name] for columns in self.joint.values() if name in columns)
        return np.array([column.min(), column.max()])

    def corners(self) -> dict[str, Floats]:
        """Return combinations of extreme inputs, for which the checks of a run file make motions.

        With k inputs that are distributions or the only column of their file there are n = 2 (k + 1) combinations: each
        of the k inputs at its upper end with all others at their lower ends; all at their lower ends; then the same
        with the ends exchanged.
        Returns name -> values, (n,), in the units of the file.  The columns of a file with several are at their
        medians, a number each, as their ends need not occur together; if all inputs are such, no value is an array.
        """
        names = [*self.random, *(name for columns in self.joint.values() if len(columns) == 1 for name in columns)]
        at_low = np.eye(len(names), len(names) + 1, dtype=bool)
        ends = {name: self.ends(name)[np.r_[row, ~row].astype(int)] for name, row in zip(names, at_low, strict=True)}
        return self.medians | ends

    def largest(self, name: str) -> float:
        """Return the largest magnitude of a start speed up to which a flow map, tables of the motions, is made.

        name: "V0" or "omega0"; KeyError if the section [start] does not give it.
        Returns a float >= 0 in the unit of the file.  A distribution may be unbounded: its quantiles at 1e-6 and
        1 - 1e-6 are taken, which two in a million draws exceed.  Of a column of a data file all rows count; of a fixed
        number its magnitude is returned.  A larger start speed is allowed: its motion is integrated.
        """
        start = self.content["start"][name]
        return float(np.abs(self.ends(name, _TAIL, 1.0 - _TAIL) if isinstance(start, Input) else start).max())

    def filled(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the sections of the run file with values in place of the inputs, and omega0 in that of "rolling".

        values: name of an input -> number or (n,), for every input, else KeyError; other names have no effect.
        Returns name of a section -> content, all of it new but for parts that are neither tables nor lists.  An omega0
        "rolling" is V0/R, in a dimensionless file V0; it stays where V0 or R is no number, which checks refuse later.
        """
        content = _fill_in(self.content, values)
        if self.rolls:
            with suppress(TypeError, KeyError, AttributeError), np.errstate(all="ignore"):
                R = content["cylinder"]["R"] if "cylinder" in content else 1.0
                omega0 = np.divide(content["start"]["V0"], R)
                content["start"]["omega0"] = omega0 if omega0.ndim else omega0.item()
        return content

    @property
    def rolls(self) -> bool:
        """Whether the motions start in pure rolling, by omega0 = "rolling" in the file."""
        start = self.content.get("start")
        return isinstance(start, dict) and start.get("omega0") == "rolling"


def _fill_in(part: Any, values: Mapping[str, Any]) -> Any:
    """Return a part of the content with values in place of its inputs; in a list "same" repeats the number before.

    part: an :class:`Input`, or a section, list, number, text or material of the file; it is not changed.
    values: name of an input -> number or (n,); KeyError for an input that it does not have.
    Returns the value of an input; a new dict of a section; a new list of a list, in which a first "same" stays as it
    is; any other part itself.
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
    """Return the inputs within a part of the content of a run file, a list of :class:`Input` in the order of the file.

    part: a section, table, list, number or any other value; what is neither table, list nor input gives an empty list.
    """
    members = part.values() if isinstance(part, dict) else part if isinstance(part, list) else ()
    return [part] if isinstance(part, Input) else [found for member in members for found in inputs_in(member)]
