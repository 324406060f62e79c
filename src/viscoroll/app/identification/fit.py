"""What was found: :class:`Identification`, and :class:`Prediction`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats
from ...core.checks import check_integer, check_number
from ...core.errors import ParameterError, check_names
from ...core.plots.measurements import identification
from ...core.results import Result, SummaryRow, Values
from .problem import Found, Problem
from .profile import Likelihood, Product
from .records import Record
from .report import as_dataset, report
from .unknowns import cylinder_of

_LEVEL = 0.95
#: most draws of a band, and of them that are thrown away, at most, for one that lies within the ranges
_DRAWS, _TRIES = 100_000, 50


class Band(NamedTuple):
    """A quantity at the best values, and the ends of its band."""

    value: Any
    low: Any
    high: Any


class Prediction(Values):
    """Quantities of a record by name, each with ``.value``, ``.low`` and ``.high``, of the shape of its places."""

    def __getattr__(self, name: str) -> Band:
        return Band(*(super(Prediction, self).__getattr__(name + end) for end in ("", "_low", "_high")))


class Identification(Result):
    """Values that fit measurements best, how well they are known, and what the data do not say.

    ``print`` shows a report; its intervals are profiles, which take about as long as the fit for each unknown.

    Attributes
    ----------
    cylinder : the :class:`Cylinder` of the best values.
    values : of the unknowns by name, SI.
    stderr : their standard deviations by the slopes at the best fit, and as far as ranges go; infinite where one does
        not act.
    correlations : (n, n), in the order of ``values``.
    chi2, dof : sum of the squared residuals over sigma, and what it should be; of robust fits outliers count less.
    sigma : standard deviation of each record's quantity, as given or as estimated.
    minima : (chi2, values) of all minima near the best, the best first.
    does_not_act : names of unknowns that do not change what was measured.
    undetermined : names of those whose interval tells little, wider than a factor of e^2 or than half their range, and
        of what is correlated with these beyond 0.95; :meth:`products` says what of them is determined.
    noise : of each record's quantity ``.rms`` of the residuals over sigma and ``.lag``, their lag-1 correlation; of
        robust fits both as a tenth of outliers changes them little.
    misfit : names of those whose residuals are no noise: lag-1 beyond 3/sqrt(n), or rms that far above 1, or, of robust
        fits, above what noise and a tenth of outliers give.  Intervals mean nothing then.
    records : the data by name.
    planned : whether the records hold no values: standard deviations and intervals are what to expect.
    """

    def __init__(self, problem: Problem, found: list[Found]) -> None:
        self._problem, self._about, (u, self.chi2) = problem, Likelihood(problem, found), found[0]
        self.values = problem.values(u)
        self.minima = [(one.chi2, problem.values(one.u)) for one in found]
        self.dof, self.records = problem.points - u.size, problem.records
        self.planned = not any(one.measured for one in self.records.values())
        self.sigma = {str(one): problem.sigma[one.at].copy() for one in problem.columns}
        self.noise = problem.noise(u)
        self.misfit = tuple(name for name, noise in self.noise.items() if not noise.is_noise)
        self.cylinder = cylinder_of(problem.cylinder, self.values)
        self.does_not_act = tuple(name for i, name in enumerate(self.values) if i not in problem.live)
        sd = np.sqrt(np.diag(self._about.cov))
        self.correlations = self._about.cov / np.outer(sd, sd)
        sizes = zip(problem.unknowns, sd.tolist(), strict=True)
        self.stderr = {one.name: one.spread(self.values[one.name]) * size for one, size in sizes}
        self.stderr |= dict.fromkeys(self.does_not_act, math.inf)

    @cached_property
    def predicted(self) -> dict[str, Prediction]:
        """The best fit to each record, with its bands."""
        return {called: self._predicted(record, called, _LEVEL) for called, record in self.records.items()}

    def _rise(self, level: float = _LEVEL) -> float:
        """What chi2 may rise by: chi-squared where sigma is given, F where it is estimated."""
        from scipy import stats

        level = check_number("level", level, low=0.0, strict=True, high=0.9999)
        estimated = any(one.estimated for one in self._problem.columns)
        return float(stats.f.ppf(level, 1, self.dof) if estimated else stats.chi2.ppf(level, 1))

    def intervals(self, level: float = _LEVEL) -> dict[str, tuple[float | None, float | None]]:
        """Where each unknown lies, by its profile: (low, high), None on a side that is open.

        All other unknowns follow while one is moved, until chi2 has risen by what ``level`` asks: 3.84 at 0.95 where
        sigma was given, by F where it was estimated.  A side is open where it does not rise up to the end of the
        range.  If another piece is found beyond an end, the interval reaches over it.

        Parameters
        ----------
        level : in (0, 0.9999].

        Raises
        ------
        ParameterError
            Another level.
        """
        found: dict[str, tuple[float | None, float | None]] = dict.fromkeys(self.values, (None, None))
        for i, sides in self._about.axes(self._rise(level)).items():
            one = self._problem.unknowns[i]
            low, high = (None if end is None else float(one.to_value(end)) for end in sides.ends)
            found[one.name] = low, high
        return found

    @cached_property
    def undetermined(self) -> tuple[str, ...]:
        """See above."""
        return tuple(self._problem.names[i] for i in self._about.undetermined(self._rise()))

    def products(self, level: float = _LEVEL) -> list[Product]:
        """What is determined of the :attr:`undetermined` unknowns: products of powers, with their intervals.

        First those that hold over the whole intervals: exponents in which all that fits lies nearest to each other,
        and the profile of just these.  Then, where it is much sharper, what holds near the values found alone, by the
        slopes there.
        """
        return self._about.products(self._about.undetermined(self._rise()), self._rise(level))

    def predict(self, record: Record, *, draws: int = 0, level: float = _LEVEL, seed: int = 0) -> Prediction:
        """What a record would show, with bands.

        Parameters
        ----------
        record : places, load and temperature; for a motion with V0, which may be another than those fitted.
        draws : random values of the unknowns to take the bands from; 0: from slopes, which takes two computations an
            unknown.  Either by the normal law within the ranges: of what is undetermined a band is a guess.
        level : of the bands, in (0, 0.9999].
        seed : of the draws, >= 0.

        Returns
        -------
        Prediction
            ``.M``, ``.F``, ``.Q``, ``.V``, ``.omega``, ``.x``, as of the record, each with ``.value``, ``.low`` and
            ``.high``.

        Raises
        ------
        ParameterError
            A record without a start, draws, level or seed out of range.
        """
        if not isinstance(record, Record):
            raise ParameterError("record", f"{record!r:.60}", "a Resistance, Traction or Coastdown")
        for name, (_, span) in record.starts(self.cylinder.R).items():
            if span is not None:
                raise ParameterError(name, None, "a number", f"{name} of the record is open: a prediction needs it")
        return self._predicted(
            record, "", level, check_integer("draws", draws, 0, _DRAWS), check_integer("seed", seed, 0)
        )

    def _predicted(self, record: Record, called: str, level: float, draws: int = 0, seed: int = 0) -> Prediction:
        problem, cov, u = self._problem, self._about.cov, self._about.best.u

        def seen(u: Floats) -> Floats:
            values = problem.predicted(record, u, called)
            return np.array([values[name] for name in record.KINDS])

        value, half = seen(u), math.sqrt(self._rise(level))
        if draws:
            many = np.random.default_rng(seed).multivariate_normal(u, cov, draws * _TRIES, method="eigh")
            inside = many[((many >= problem.low) & (many <= problem.high)).all(axis=1)][:draws]
            drawn = [seen(at) for at in (inside if len(inside) else [u])]
            low, high = np.nanquantile(drawn, (0.5 - 0.5 * level, 0.5 + 0.5 * level), axis=0)
        else:
            J = problem.slopes(seen, u, range(u.size)).T
            spread = half * np.sqrt(np.maximum(np.einsum("i...,ij,j...", J, cov, J), 0.0))
            low, high = value - spread, value + spread
        ends = (("", value), ("_low", low), ("_high", high))
        found = {name + end: rows[n] for end, rows in ends for n, name in enumerate(record.KINDS)}
        places = {name: np.asarray(getattr(record, name)) for name in record.PLACES}
        units = {name: record.unit(name.split("_")[0]) for name in (*found, *places)}
        return Prediction(found, places, units, f"Prediction, {level:.0%} bands", labels=record.labels)

    def residuals(self, values: Mapping[str, float]) -> Floats:
        """Residuals over sigma of all records, in their order, and of the prior, at values by name.

        What is not named is at its start.  For optimisers and samplers of one's own; a motion that fails is 1e6 off.
        """
        return self._problem.residuals(self._coordinates(values))

    def jacobian(self, values: Mapping[str, float]) -> Floats:
        """Slopes of :meth:`residuals` over the values, (residuals, unknowns), by central differences."""
        J = self._problem.jacobian(self._coordinates(values))
        return J / [one.spread(values.get(one.name, one.start)) for one in self._problem.unknowns]

    def _coordinates(self, values: Mapping[str, float]) -> Floats:
        check_names("values", values, self.values, "an unknown")
        given = ((one, values.get(one.name, one.start)) for one in self._problem.unknowns)
        return np.array([one.to_u(check_number(one.name, value, **one.bounds(one.name))) for one, value in given])

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        title = f"Identification of {len(self.values)} unknowns from {self._problem.y.size} points"
        rows = [SummaryRow(name, f"{value:.6g} +- {self.stderr[name]:.2g}") for name, value in self.values.items()]
        return title, [*rows, SummaryRow("chi2", f"{self.chi2:.1f} of {self.dof}")]

    __str__, to_xarray = report, as_dataset
    _figure = identification
