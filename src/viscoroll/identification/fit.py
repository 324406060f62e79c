"""What was found: :class:`Identification`."""

from __future__ import annotations

import html
from collections.abc import Mapping
from functools import cached_property, partial
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..checks import number
from ..errors import ParameterError, unknown
from ..results import Row, Shown
from .predict import Prediction, predicted
from .problem import Column, Found, Problem
from .products import Product, Ties
from .profile import Profile, profile
from .records import Record
from .said import Noise, noise_of
from .unknowns import OF_RECORDS, cylinder_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_LEVEL = 0.95
#: of coordinates, what is one place
_SAME = 1e-6


class Identification(Shown):
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
    noise : of each record's quantity ``.rms`` of the residuals over sigma and ``.lag``, their lag-1 correlation.
    misfit : names of those whose residuals are no noise: lag-1 beyond 3/sqrt(n), or rms that far above 1.  Intervals
        mean nothing then.
    planned : whether the records hold no values: standard deviations and intervals are what to expect.
    """

    def __init__(self, problem: Problem, found: list[Found]) -> None:
        self._problem, self._best = problem, found[0]
        self.values = problem.values(self._best.u)
        self.minima = [(one.chi2, problem.values(one.u)) for one in found]
        self._others = [one.u for one in found[1:]]
        r = problem.residuals(self._best.u)
        self._J = problem.weighed(r, problem.jacobian(self._best.u))
        self.chi2, self.dof = self._best.chi2, r.size - self._best.u.size
        self.does_not_act = tuple(name for i, name in enumerate(problem.names) if i not in problem.live)
        self.planned = all(record.planned for record in problem.records.values())
        self.noise: dict[str, Noise] = {} if self.planned else noise_of(problem, r)
        self.misfit = tuple(name for name, noise in self.noise.items() if not noise.is_noise)
        self._profiles: dict[tuple[Any, ...], Profile] = {}
        self.cylinder = cylinder_of(problem.cylinder, {n: v for n, v in self.values.items() if ":" not in n})

    @property
    def evaluations(self) -> int:
        """How often all records were computed."""
        return self._problem.evaluations

    @property
    def columns(self) -> list[Column]:
        """Of which record and quantity the residuals are, in their order."""
        return self._problem.columns

    @property
    def records(self) -> dict[str, Record]:
        """The data by name."""
        return self._problem.records

    @cached_property
    def predicted(self) -> dict[str, Prediction]:
        """The best fit to each record, with its bands."""
        return {called: self._predicted(record, called, _LEVEL) for called, record in self.records.items()}

    @property
    def sigma(self) -> dict[str, Any]:
        """See above."""
        return {str(one): self._problem.sigma[one.at].copy() for one in self._problem.columns}

    @cached_property
    def _cov(self) -> Any:
        """Of the coordinates, by slopes and as far as the ranges let them."""
        problem = self._problem
        return np.linalg.inv(self._J.T @ self._J + np.diag(12.0 / (problem.high - problem.low) ** 2))

    @property
    def stderr(self) -> dict[str, float]:
        """See above."""
        sd = np.sqrt(np.diag(self._cov))
        sd[[i for i, name in enumerate(self.values) if name in self.does_not_act]] = np.inf
        spread = (one.spread(self.values[one.name]) for one in self._problem.unknowns)
        return {name: float(size * each) for name, size, each in zip(self.values, sd, spread, strict=True)}

    @property
    def correlations(self) -> Any:
        """See above."""
        sd = np.sqrt(np.diag(self._cov))
        return self._cov / np.outer(sd, sd)

    def profile(self, name: str, level: float = _LEVEL) -> Profile:
        """The walk behind an interval, in coordinates (logarithms): ends, whose range makes them, further pieces."""
        if name not in self.values:
            raise unknown("name", name, self.values, "an unknown")
        powers = np.zeros(len(self.values))
        powers[self._problem.names.index(name)] = 1.0
        return self._profile(powers, level)

    def _profile(self, powers: NDArray[np.float64], level: float) -> Profile:
        key = (level, *powers)
        if key not in self._profiles:
            problem = self._problem
            begun = [problem.start] * bool(np.abs(problem.start - self._best.u).max() > _SAME)
            self._profiles[key] = profile(
                problem, self._best, self._cov, powers, self._rise(level), [*self._others, *begun]
            )
        return self._profiles[key]

    def _rise(self, level: float) -> float:
        """What chi2 may rise by: chi-squared where sigma is given, F where it is estimated."""
        from scipy import stats

        level = number("level", level, low=0.0, strict=True, high=0.9999)
        if any(one.estimated for one in self._problem.columns):
            return float(stats.f.ppf(level, 1, self.dof))
        return float(stats.chi2.ppf(level, 1))

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
        found: dict[str, tuple[float | None, float | None]] = {}
        for one in self._problem.unknowns:
            if one.name in self.does_not_act:
                found[one.name] = (None, None)
                continue
            sides = self.profile(one.name, level)
            low, high = (None if end.at is None else float(one.to_value(end.at)) for end in (sides.low, sides.high))
            found[one.name] = (low, high)
        return found

    @property
    def undetermined(self) -> tuple[str, ...]:
        """See above."""
        return tuple(self._problem.names[i] for i in self._ties(_LEVEL).which)

    def products(self, level: float = _LEVEL) -> list[Product]:
        """What is determined of the :attr:`undetermined` unknowns: products of powers, with profiles as intervals.

        Exponents are those in which all that fits lies nearest to each other; the interval is of just these.  Where no
        exponents do, those by slopes at the best fit.
        """
        return self._ties(level).products()

    def _ties(self, level: float) -> Ties:
        return Ties(
            self._problem, self._best.u, self._J, self._cov, partial(self._profile, level=level), self._rise(level)
        )

    def predict(self, record: Record, *, draws: int = 0, level: float = _LEVEL, seed: int = 0) -> Prediction:
        """What a record would show, with bands.

        Parameters
        ----------
        record : places, load and temperature; for a motion with V0, which may be another than those fitted.
        draws : random values of the unknowns to take the bands from; 0: from slopes, which takes two computations an
            unknown.  Either by the normal law within the ranges: of what is undetermined a band is a guess.
        level : of the bands.
        seed : of the draws.

        Returns
        -------
        Prediction
            ``.M``, ``.F``, ``.Q``, ``.V``, ``.omega``, ``.x``, as of the record, each with ``.value``, ``.low`` and
            ``.high``.

        Raises
        ------
        ParameterError
            A record without a start.
        """
        if not isinstance(record, Record):
            raise ParameterError("record", f"{record!r:.60}", "a Resistance, Traction or Coastdown")
        for name in OF_RECORDS:
            if isinstance(getattr(record, name, 0.0), tuple | None):
                raise ParameterError(
                    name, None, "a number", f"{name} of the record is not given: a prediction needs it"
                )
        return self._predicted(record, "", level, draws, seed)

    def _predicted(self, record: Record, called: str, level: float, draws: int = 0, seed: int = 0) -> Prediction:
        width = float(np.sqrt(self._rise(level)))
        return predicted(self._problem, record, called, self._best.u, self._cov, level, width, draws, seed)

    def residuals(self, values: Mapping[str, float]) -> NDArray[np.float64]:
        """Residuals over sigma of all records, in their order, and of the prior, at values by name.

        What is not named is at its start.  For optimisers and samplers of one's own; a motion that fails is 1e6 off.
        """
        return self._problem.residuals(self._problem.coordinates(self._named(values)))

    def jacobian(self, values: Mapping[str, float]) -> NDArray[np.float64]:
        """Slopes of :meth:`residuals` over the values, (residuals, unknowns), by central differences."""
        values = self._named(values)
        J = self._problem.jacobian(self._problem.coordinates(values))
        return J / [one.spread(values.get(one.name, one.start)) for one in self._problem.unknowns]

    def _named(self, values: Mapping[str, float]) -> Mapping[str, float]:
        for name in values:
            if name not in self.values:
                raise unknown("values", name, self.values, "an unknown")
        return values

    def _card(self) -> tuple[str, list[Row]]:
        title = f"Identification of {len(self.values)} unknowns from {self._problem.y.size} points"
        rows = [Row(name, f"{value:.6g} +- {self.stderr[name]:.2g}") for name, value in self.values.items()]
        return title, [*rows, Row("chi2", f"{self.chi2:.1f} of {self.dof}")]

    def __str__(self) -> str:
        from .report import report

        return report(self)

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"

    def plot(self, path: str | PathLike[str] | None = None) -> Figure:
        """Data, best fit and its band, and below them residuals over sigma, a column for each quantity of a record.

        Parameters
        ----------
        path : also write it there, in the format of the suffix.

        Raises
        ------
        OutputError
            If it cannot be written there.
        """
        from ..plots.identification import compared
        from ..plots.style import saved

        return saved(compared(self), path)

    def to_xarray(self) -> xr.Dataset:
        """Values, standard deviations, intervals and correlations over ``unknown``, data and fit over their places."""
        from .export import as_dataset

        return as_dataset(self)
