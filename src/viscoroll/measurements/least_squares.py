"""Least squares: residuals of all records over the coordinates of the unknowns, their slopes, and
minima of chi2.
"""

import contextlib
import dataclasses
import functools
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..core import Floats, ViscorollError
from ..rollers import Cylinder
from .measurement_records import Record
from .unknowns import Shift, Unknown, cylinder_of

#: step of central differences in a coordinate: their error is 1e-8 of the largest slope (1e-7 where
#: motions are driven)
_STEP = 3e-4
#: step of one-sided differences in a search: below, the last digits of a motion show, and the
#: search stops early
_ONE_SIDED_STEP = 1e-5
#: residual where the values make no cylinder or no motion, and the largest one
FAILED = 1e6
#: weight of the rule that keeps a combination of coordinates fixed, far above those of the data
_STIFF = 1e6
#: ratios of a standard deviation that was not given, as a start, to that of the values and to the
#: largest of them: the second keeps predictions that are far from nearly equal values within the
#: largest residual
_FIRST_SIGMA = 1e-3, 1e-4
#: least ratio of an estimated standard deviation to the largest value: rounding of the predictions
_LEAST_SIGMA = 1e-14
#: most rounds in which standard deviations are estimated
_ROUNDS = 20
#: relative change of the standard deviations at which the rounds end
_SIGMA_CHANGE = 1e-3
#: median of |x| of the normal law of standard deviation 1
_MEDIAN = 0.6745
#: largest ratio of the median of |x| with outliers to that of noise alone: a tenth of the points
#: may be outliers, and the median of all is then the quantile 0.5/0.9 of the noise
_BY_OUTLIERS = 1.134
#: ratio of three standard deviations of the median of |x| to that median, times sqrt(points)
_BY_CHANCE = 3.5
#: norm of a column of slopes below which an unknown does not act: a factor of e changes all
#: residuals by less
_INACTIVE = 1e-2
#: distance to a bound, in units of the range, below which a value is at the bound
_AT_BOUND = 1e-6


class Column(NamedTuple):
    """The residuals of one quantity of a record; its text is "QUANTITY of RECORD".

    record, quantity : names of the record and of the quantity, as "run" and "V".
    at : rows of the residuals, of ``Problem.y`` and of ``Problem.sigma``, a slice.
    estimated : whether its standard deviation was not given, and is estimated from the residuals.
    """

    record: str
    quantity: str
    at: slice
    estimated: bool

    def __str__(self) -> str:
        return f"{self.quantity} of {self.record}"


class Noise(NamedTuple):
    """Statistics of the residuals of a column, by which a model that is inadequate shows.

    rms : root mean square of the residuals over sigma, dimensionless; 0 of a plan.
    lag : lag-1 correlation of the residuals in the order of the coordinates, as for the times, in
        [-1, 1]; 0 of a single point and of a plan.
    allowed : largest lag-1 correlation of noise: three standard deviations, 3/sqrt(points).
    is_noise : whether lag rms^2 <= ``allowed``, so that residuals far below sigma may correlate,
        and, where sigma was given, rms is at most 1 + 3/sqrt(2 points).  A negative lag and a small
        rms count as noise, and an estimated sigma makes any rms right.
    Of a robust fit ``rms`` is the median of the absolute residuals over that of normal noise, at
    most 1.134 + 3.5/ sqrt(points), and ``lag`` is the correlation of the weighted residuals
    r/sqrt(1 + r^2), which are below 1: few outliers change neither much.
    """

    rms: float
    lag: float
    allowed: float
    is_noise: bool

    @property
    def repeats(self) -> float:
        """Points that count as one: (1 + c)/(1 - c), of an autoregressive noise with the lag-1
        correlation c.

        c is ``lag`` without its bias by few points, -(1 + 4 c)/points, at most 0.95; 1.0 is
        returned where c, or c rms^2, is at most two thirds of ``allowed``, two standard deviations:
        with three half of the correlated noise of 40 points is not noticed.
        """
        c = min(self.lag + (1.0 + 4.0 * self.lag) * self.allowed**2 / 9.0, 0.95)
        if c * min(1.0, self.rms**2) <= self.allowed * 2.0 / 3.0:
            return 1.0
        return (1.0 + c) / (1.0 - c)


class Minimum(NamedTuple):
    """A minimum of chi2: coordinates u of the unknowns, shape (unknowns,), and chi2 there,
    dimensionless.
    """

    u: Floats
    chi2: float


def _largest(values: Floats) -> float:
    """Return the largest magnitude of the values of a column, SI; 1 where all are 0."""
    return float(np.abs(values).max()) or 1.0


@dataclasses.dataclass(eq=False)
class Problem:
    """The least squares of an identification: chi2 over the coordinates of the unknowns.

    The coordinate of an unknown is the logarithm of its value, or of linear unknowns the value in a
    unit (:class:`.unknowns.Unknown`); it is dimensionless.

    cylinder : :class:`Cylinder` with the values that are fixed.
    unknowns : list of :class:`Unknown`, with start, range and prior.
    records : name -> :class:`.measurement_records.Record`; all of them have values, or none.
    robust : whether outliers count less.
    shifts : "material" or "base" -> function of the temperature in degrees Celsius that returns
        a_T; {} where no record has a temperature.
    planned : whether the records have no values.
    names : names of the unknowns.
    start, low, high : coordinates of start and bounds, shape (unknowns,).
    y : all data, SI, one column after the other, shape (n,); of a plan the predictions at the
        start.
    sigma : their standard deviations, SI, shape (n,).  Those that were not given begin at 1e-3 of
        the standard deviation of the values of their column, at least at 1e-4 of the largest;
        :meth:`estimate_sigma` changes them.
    columns : list of :class:`Column`, the columns of y.
    points : number of residuals: n data, and one for each prior.
    active : indices of the unknowns that are varied, ascending; the others change no residual and
        stay at their start.
    """

    cylinder: Cylinder
    unknowns: list[Unknown]
    records: dict[str, Record]
    robust: bool
    shifts: Mapping[str, Shift]

    def __post_init__(self) -> None:
        """Collect the data of all records and find the active unknowns.

        Raises ViscorollError where the records are a plan and the start makes no cylinder or no
        motion.
        """
        self.names = [unknown.name for unknown in self.unknowns]
        self.planned = not any(record.measured for record in self.records.values())
        self.start, self.low, self.high = np.array(
            [unknown.to_u(np.array(unknown[1:4])) for unknown in self.unknowns]
        ).T
        self._mean, self._sd = np.array([unknown[5:] for unknown in self.unknowns]).T
        self._has_prior = np.isfinite(self._sd)
        self._model = functools.lru_cache(16)(self._predict_all)
        self.columns = []
        y = []
        sigma = []
        size = 0
        for record_name, record in self.records.items():
            # a plan has the predictions at the start for data
            values = (
                vars(record) if record.measured else self.predicted(record, self.start, record_name)
            )
            for quantity, given in record.sigma.items():
                own = np.ravel(values[quantity])
                first = np.max(np.multiply(_FIRST_SIGMA, (np.std(own), _largest(own))))
                spread = first if given is None else np.ravel(given)
                y.append(own)
                sigma.append(np.broadcast_to(spread, own.shape))
                self.columns.append(
                    Column(record_name, quantity, slice(size, size + own.size), given is None)
                )
                size += own.size
        self.points = size + int(self._has_prior.sum())
        self.y = np.concatenate(y)
        self.sigma = np.concatenate(sigma)
        self.active = self._find_active()

    def _find_active(self) -> list[int]:
        """Return the unknowns that change the residuals at the start or at one of four other
        points, drawn over the middle half of the ranges with a fixed seed.

        An unknown changes them if the vector of their derivatives by its coordinate has a norm of
        at least 0.01; one with a prior nearly always does, since its prior is a residual.  Others
        would make the least squares singular.

        Returns a list of the indices of these unknowns, ascending; [] where none acts.
        """
        rng = np.random.default_rng(0)
        middle = 0.5 * (self.low + self.high)
        others = middle + 0.25 * (self.high - self.low) * rng.uniform(-1.0, 1.0, (4, middle.size))
        idle = [*range(middle.size)]
        for u in (self.start, *others):
            # those that have acted at an earlier point are not tried again
            J = self.slopes(self.residuals, u, idle)
            idle = [i for i, column in zip(idle, J.T) if np.linalg.norm(column) < _INACTIVE]
        return [i for i in range(middle.size) if i not in idle]

    def values(self, u: Floats) -> dict[str, float]:
        """Return the values of the unknowns: name -> value, SI.

        u : coordinates of the unknowns, (unknowns,).
        """
        return {unknown.name: float(unknown.to_value(x)) for unknown, x in zip(self.unknowns, u)}

    def predicted(self, record: Record, u: Floats, record_name: str) -> dict[str, Floats]:
        """Return the prediction of a record.

        record : :class:`.measurement_records.Record`, the record, of these data or another one.
        u : coordinates of the unknowns, (unknowns,).
        record_name : name of the record, by which its own unknowns are found, as V0 by "V0:NAME";
            "" of a record that was not fitted, which must have numbers for them.
        Returns quantity -> values, SI units, in the shape of the coordinates of the record, NaN at
        times that a motion does not reach; of a motion also "slips", truth values.
        Raises ViscorollError where the coordinates make no cylinder or no motion.
        """
        values = self.values(u)
        own = {name.removesuffix(f":{record_name}"): value for name, value in values.items()}
        return record.model(cylinder_of(self.cylinder, values, record, self.shifts), own)

    def _predict_all(self, u: bytes) -> Floats:
        """Return the predictions of all data, in the order of ``y``.

        It is called through ``self._model``, a cache of the last 16 results.  Warnings are
        suppressed, since a search passes through values of which the model warns.

        u : coordinates of the unknowns, (unknowns,), as the bytes of the float64 array, which the
            cache can look up.
        Returns values in SI units, shape (n,), NaN at times that a motion does not reach; all n are
        NaN where any record makes no cylinder or no motion.
        """
        # warnings: of what the search passes through
        with (
            np.errstate(all="ignore"),
            warnings.catch_warnings(action="ignore"),
            contextlib.suppress(ViscorollError, ArithmeticError),
        ):
            seen = {
                name: self.predicted(record, np.frombuffer(u), name)
                for name, record in self.records.items()
            }
            return np.concatenate(
                [np.ravel(seen[column.record][column.quantity]) for column in self.columns]
            )
        return np.full(self.y.size, np.nan)

    def residuals(self, u: Floats) -> Floats:
        """Return the residuals: (predicted - measured)/sigma of the data, then (u - mean)/sd of
        each prior.

        u : coordinates of the unknowns, (unknowns,).
        Returns shape (points,), dimensionless.  Residuals of the data are within -+:data:`FAILED`,
        1e6, and +1e6 where the prediction is NaN; those of priors, in the order of the unknowns,
        are not limited.
        """
        r = np.clip(
            np.nan_to_num((self._model(u.tobytes()) - self.y) / self.sigma, nan=FAILED),
            -FAILED,
            FAILED,
        )
        return np.append(r, ((u - self._mean) / self._sd)[self._has_prior])

    def slopes(
        self,
        function: Callable[[Floats], Floats],
        u: Floats,
        which: Sequence[int],
        step: float = _STEP,
    ) -> Floats:
        """Return the derivatives of a function of the coordinates by some of them, by differences
        within the ranges.

        function : function that takes coordinates, (unknowns,), and returns an array, as the
            residuals, (points,).
        u : coordinates at which the derivatives are taken, (unknowns,), perhaps outside of the
            ranges.
        which : indices of the coordinates by which they are taken.
        step : length of a step of a coordinate.  :data:`_STEP`, the default, is taken to both
            sides; any other one upwards alone, and downwards too where the upper end of the range
            is nearer than the step.  A step ends at the end of the range; from a coordinate outside
            of its range there is only the step towards it.
        Returns shape (points, which); of a function whose result has several axes these are in
        reverse order, before that of ``which``; (0,) where ``which`` is empty.
        """
        columns = []
        for i in which:
            up = u.copy()
            down = u.copy()
            up[i] = min(u[i] + step, max(self.high[i], u[i]))
            # to both sides, or where the upper end of the range cuts the step, downwards too
            if step == _STEP or up[i] < u[i] + step:
                down[i] = max(u[i] - step, min(self.low[i], u[i]))
            columns.append((function(up) - function(down)) / (up[i] - down[i]))
        return np.array(columns).T

    def jacobian(self, u: Floats) -> Floats:
        """Return the derivatives of the residuals by all coordinates, dimensionless, (points,
        unknowns).

        u : coordinates of the unknowns, (unknowns,).
        """
        return self.slopes(self.residuals, u, range(u.size))

    def cost(self, u: Floats) -> float:
        """Return chi2, which the fit minimises.

        It is the sum over all residuals r of r^2, or in a robust fit of 2 (sqrt(1 + r^2) - 1).

        u : coordinates of the unknowns, (unknowns,), dimensionless.
        Returns a float >= 0, dimensionless.
        """
        squares = self.residuals(u) ** 2
        return float((2.0 * (np.sqrt(1.0 + squares) - 1.0) if self.robust else squares).sum())

    def weighted(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the residuals r and their derivatives, each row multiplied by the square root of
        its weight.

        The weight is 1, in a robust fit 1/sqrt(1 + r^2): with it the slope of chi2 is that of
        ordinary least squares.

        u : coordinates of the unknowns, shape (unknowns,).
        Returns (residuals, (points,); derivatives with respect to the coordinates, (points,
        unknowns)), dimensionless.
        """
        r = self.residuals(u)
        J = self.jacobian(u)
        weight = (1.0 + r * r) ** -0.25 if self.robust else np.ones_like(r)
        return r * weight, J * weight[:, np.newaxis]

    def minimize(
        self, u: Floats, fixed: Floats | None = None, tolerance: float = 1e-10, steps: int = 200
    ) -> Minimum:
        """Find the minimum of chi2 near a point, within the ranges, by the least squares of SciPy.

        u : coordinates of the point, (unknowns,); those outside of the ranges are moved to their
            ends.
        fixed : powers p of the combination sum(p u) that keeps its value at u, (unknowns,).  A
            single coordinate (one power that is not 0) is left out of the search; a combination of
            several is kept by a residual of large weight, as far as the ranges allow.  None: all
            active coordinates are free.
        tolerance : ``ftol``, ``xtol`` and ``gtol`` of :func:`scipy.optimize.least_squares`,
            dimensionless: the relative changes of chi2 and coordinates and the scaled gradient at
            which the search ends.
        steps : largest number of evaluations of the residuals, those for derivatives not counted;
            beyond it the best point found is returned.
        Returns the :class:`Minimum`, whose chi2 is without the residual of large weight.  Unknowns
        that are not active stay at u, or at the end of their range nearest to it; where no
        coordinate is free all do.
        """
        from scipy import optimize

        powers = np.zeros_like(u) if fixed is None else fixed
        single = np.count_nonzero(powers) == 1
        free = [i for i in self.active if not (single and powers[i])]
        # one more row of the residuals and their derivatives, or none
        rule = _STIFF * powers[np.newaxis, free]
        rule = rule[rule.any(axis=1)]
        whole = np.clip(u, self.low, self.high)

        def at(v: Floats) -> Floats:
            """Return all coordinates, (unknowns,), from those that are free, v."""
            inside = whole.copy()
            inside[free] = v
            return inside

        def residuals(v: Floats) -> Floats:
            """Return the residuals at the free coordinates v, and those of the rule that keeps the
            combination.
            """
            return np.append(self.residuals(at(v)), rule @ (v - u[free]))

        def jacobian(v: Floats) -> Floats:
            """Return the derivatives of these residuals by the free coordinates, (rows, free), at
            v.
            """
            return np.vstack([self.slopes(self.residuals, at(v), free, _ONE_SIDED_STEP), rule])

        if free:
            found = optimize.least_squares(
                residuals,
                whole[free],
                jacobian,
                (self.low[free], self.high[free]),
                x_scale="jac",
                ftol=tolerance,
                xtol=tolerance,
                gtol=tolerance,
                loss="soft_l1" if self.robust else "linear",
                max_nfev=steps,
            )
            whole = at(found.x)
        return Minimum(whole, self.cost(whole))

    def estimate_sigma(self, best: Minimum) -> Minimum:
        """Estimate the standard deviations that were not given from their residuals and fit again,
        in turns.

        A column has one standard deviation: the root mean square of its residuals, divided by the
        root of 1 - (number of active unknowns)/(number of all residuals), which is taken as at
        least 0.1; in a robust fit their median absolute value over that of normal noise; it is at
        least 1e-14 of the largest value.  The rounds end when no standard deviation changes by 0.1
        %, at the latest after 20; there are none where all standard deviations were given.
        ``sigma`` is changed in place.

        best : :class:`Minimum`, minimum with the present standard deviations.
        Returns the :class:`Minimum` of the last round, with the standard deviations estimated in
        it; ``best`` itself if none is estimated.
        """
        estimated = [column for column in self.columns if column.estimated]
        for _ in range(_ROUNDS if estimated else 0):
            r = self.residuals(best.u)
            before = self.sigma.copy()
            share = 1.0 - min(len(self.active) / r.size, 0.9)
            for column in estimated:
                own = r[column.at]
                size = (
                    np.median(np.abs(own)) / _MEDIAN
                    if self.robust
                    else np.sqrt(np.mean(own**2) / share)
                )
                floor = _LEAST_SIGMA * _largest(self.y[column.at])
                # residuals are divided by the present sigma
                self.sigma[column.at] = np.maximum(self.sigma[column.at] * size, floor)
            best = self.minimize(best.u)
            if np.abs(self.sigma / before - 1.0).max() < _SIGMA_CHANGE:
                break
        return best

    def noise(self, u: Floats) -> dict[str, Noise]:
        """Return statistics of the residuals of each column, by which a model that is inadequate
        shows.

        The residuals of a column are put into the order of the coordinates of its record first, of
        a traction by speed, then by creepage; those of equal coordinates stay in the order given.

        u : coordinates of the unknowns, (unknowns,).
        Returns a dict, "QUANTITY of RECORD" -> :class:`Noise`, in the order of ``columns``.
        """
        found = {}
        r = self.residuals(u)
        for column in self.columns:
            record = self.records[column.record]
            # lexsort sorts by its last key first: the first coordinate
            part = r[column.at][
                np.lexsort(
                    [np.ravel(getattr(record, name)) for name in reversed(record.COORDINATES)]
                )
            ]
            allowed = 3.0 / math.sqrt(part.size)
            if self.robust:
                rms = float(np.median(np.abs(part))) / _MEDIAN
                most = _BY_OUTLIERS + _BY_CHANCE / math.sqrt(part.size)
                part = part / np.sqrt(1.0 + part**2)
            else:
                rms = math.sqrt(np.mean(part**2))
                most = 1.0 + allowed / math.sqrt(2.0)
            lag = float(part[1:] @ part[:-1]) / max(float(part @ part), 1e-300)
            large = not column.estimated and rms > most
            found[str(column)] = Noise(rms, lag, allowed, lag * rms**2 <= allowed and not large)
        return found

    def at_bounds(self, u: Floats) -> list[int]:
        """Return the indices of the unknowns that lie at an end of their range, within 1e-6 of its
        width, ascending.

        u : coordinates of the unknowns, (unknowns,).
        """
        width = self.high - self.low
        return np.flatnonzero(np.minimum(u - self.low, self.high - u) <= _AT_BOUND * width).tolist()
