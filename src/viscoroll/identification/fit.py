"""From measurements to parameters: :func:`identify`, and what it finds, :class:`Identification`."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..checks import number
from ..cylinder import Cylinder
from ..errors import ParameterError, unknown
from ..results import Row, Shown
from .predict import Prediction, predicted
from .problem import Column, Found, Problem
from .profile import Profile, profile
from .records import Record
from .said import NARROW, Noise, directions, flat, noise_of, wide, without
from .search import minima
from .unknowns import Shift, cylinder_of, refuse_unshifted, unknowns_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_LEVEL = 0.95
#: how much wider the interval of a product with rounder exponents may be
_ROUNDER = 5.0
#: of coordinates, what is one place
_SAME = 1e-6


class Product(NamedTuple):
    """A product of powers of unknowns that the data determine where they cannot tell these apart.

    powers : exponents by name; those of brake, drag, V0, omega0 and t0 hold near the values found.
    value : of the product.
    low, high : ends of its interval over ``value``.
    """

    powers: dict[str, float]
    value: float
    low: float
    high: float


class Identification(Shown):
    """Values that fit measurements best, how well they are known, and what the data do not say.

    ``print`` shows a report; its intervals are profiles, which take about as long as the fit for each unknown.

    Attributes
    ----------
    cylinder : the :class:`Cylinder` of the best values.
    values : of the unknowns by name, SI.
    stderr : their standard deviations by the slopes at the best fit; infinite where nothing acts.
    correlations : (n, n), in the order of ``values``.
    chi2, dof : sum of the squared residuals over sigma, and what it should be; of robust fits outliers count less.
    sigma : standard deviation of each record's quantity, as given or as estimated.
    minima : (chi2, values) of all minima near the best, the best first.
    does_not_act : names of unknowns that do not change what was measured.
    undetermined : names of those whose interval tells little: wider than a factor of e^2, or than half their range;
        :meth:`products` says what of them is determined.
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
        # left to the user's eye: what the search passed through is not told
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
        width = float(np.sqrt(self._rise(_LEVEL)))
        given = self._problem, self._best.u, self._within, _LEVEL, width
        return {called: predicted(*given, record, called) for called, record in self.records.items()}

    @property
    def sigma(self) -> dict[str, Any]:
        """See above."""
        return {str(one): self._problem.sigma[one.at].copy() for one in self._problem.columns}

    @cached_property
    def _cov(self) -> NDArray[np.float64]:
        """Of the coordinates, by slopes alone; infinite where nothing acts."""
        live = self._problem.live
        cov = np.diag(np.full(len(self._problem.names), np.inf))
        _, s, Vt = np.linalg.svd(self._J[:, live], full_matrices=False)
        if live:
            s = np.maximum(s, 1e-12 * s[0])
            cov[np.ix_(live, live)] = (Vt.T / s**2) @ Vt
        return cov

    @cached_property
    def _within(self) -> Any:
        """Of the coordinates, by slopes and as far as the ranges let them."""
        problem = self._problem
        return np.linalg.inv(self._J.T @ self._J + np.diag(12.0 / (problem.high - problem.low) ** 2))

    @property
    def stderr(self) -> dict[str, float]:
        """See above."""
        sd = np.sqrt(np.diag(self._cov))
        spread = (one.spread(self.values[one.name]) for one in self._problem.unknowns)
        return {name: float(size * each) for name, size, each in zip(self.values, sd, spread, strict=True)}

    @property
    def correlations(self) -> NDArray[np.float64]:
        """See above."""
        cov = np.where(np.isfinite(self._cov), self._cov, 1.0)
        sd = np.sqrt(np.diag(cov))
        return cov / np.outer(sd, sd)

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
                problem, self._best, self._within, powers, self._rise(level), [*self._others, *begun]
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
        range, or to a factor of a hundred.  If another piece is found beyond an end, the interval reaches over it.

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
        return tuple(self._problem.names[i] for i in self._undetermined(_LEVEL))

    def _undetermined(self, level: float) -> list[int]:
        problem = self._problem
        return [i for i in problem.live if wide(problem, i, self.profile(problem.names[i], level))]

    def products(self, level: float = _LEVEL) -> list[Product]:
        """What is determined of the :attr:`undetermined` unknowns: products of powers, with profiles as intervals.

        Exponents are those in which all that fits lies nearest to each other; the interval is of just these.
        """
        problem, which = self._problem, self._undetermined(level)
        if len(which) < 2:
            return []
        within = np.concatenate([self.profile(problem.names[i], level).within[:, which] for i in which])
        J = without(self._J, which, [i for i in problem.live if i not in which])
        far, near = (self._products(which, family, level) for family in directions(within, J))
        rounder = far and (not near or np.log(far[0].high / far[0].low) < _ROUNDER * np.log(near[0].high / near[0].low))
        return far if rounder else near

    def _products(self, which: list[int], family: list[NDArray[np.float64]], level: float) -> list[Product]:
        """Those of a family, up to the first one that is open or wide."""
        problem, found = self._problem, []
        for direction in family:
            powers = np.zeros(len(problem.names))
            powers[which] = direction
            sides, centre = self._profile(powers, level), float(powers @ self._best.u)
            if sides.low.at is None or sides.high.at is None or sides.high.at - sides.low.at > NARROW:
                break
            exponents = {
                one.name: float(p if one.unit is None else p * self.values[one.name] / one.unit)
                for one, p in zip(problem.unknowns, powers, strict=True) if p
            }  # fmt: skip
            value = np.prod([self.values[name] ** p for name, p in exponents.items()])
            ends = (float(np.exp(end - centre)) for end in (sides.low.at, sides.high.at))
            found.append(Product(exponents, float(value), *ends))
        return found

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
        if getattr(record, "V0", 0.0) is None:
            raise ParameterError("V0", None, "a number", "V0 of the record is not given: a prediction starts with it")
        width = float(np.sqrt(self._rise(level)))
        given = self._problem, self._best.u, self._within, level, width
        return predicted(*given, record, draws=draws, seed=seed)

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


def identify(
    cylinder: Cylinder,
    unknown: Mapping[str, tuple[float, float]],
    data: Sequence[Record],
    *,
    prior: Mapping[str, tuple[float, float]] | None = None,
    shift: Shift | Mapping[str, Shift] | None = None,
    robust: bool = False,
    starts: int = 8,
    seed: int = 0,
    progress: bool = False,
) -> Identification:
    """Fit what is unknown of a cylinder and its bearing to measurements, and say what they do not tell.

    Parameters
    ----------
    cylinder : what is known, and where the search starts.
    unknown : range (low, high) of each, SI, by the names of run files: R, m, mu, j, g, load; E, nu, T_ref of the
        material, E_1, tau_1 of its first, longest mode, over T_ref; the same of another half-space as base_E, base_E_1;
        brake, a constant torque of the bearing, N m/m, and drag, N m s/m, one that grows with omega; V0, omega0 and t0
        of a record "run" as "V0:run".  E multiplies the whole relaxation curve and T_ref all its times: with mu they
        are the whole job for a material of a DMA.
    data : :class:`Resistance`, :class:`Traction` and :class:`Coastdown`, all with values, or none: then what would be
        learnt if the cylinder were the truth.
    prior : (value, standard deviation) of what is known beforehand; that of the logarithm, but for brake, drag, nu
        and unknowns of records.
    shift : a_T over the temperature of records: :class:`WLF`, :class:`Arrhenius` or a function, 1 at the temperature
        of the cylinder; where its bodies differ {"material": ..., "base": ...}.
    robust : let outliers count less, as |r| in place of r^2.
    starts : searches, the first from the cylinder, the others spread over the ranges.
    seed : of the latter.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Identification

    Raises
    ------
    ParameterError
        A name that is none, a range that does not hold the start, more unknowns than points, records without
        standard deviations where values are missing, records with and without values, two records of one name.
    """
    given = {"material": shift, "base": shift} if callable(shift) else shift or {}
    records = _called(cylinder, data, given)
    unknowns = unknowns_of(cylinder, unknown, records)
    if not unknowns:
        raise ParameterError("unknown", "nothing", "at least one name and its range")
    problem = Problem(cylinder, unknowns, records, _priors(prior or {}, unknowns), bool(robust), given)
    if problem.y.size + len(problem.prior) < len(unknowns):
        sentence = f"{len(unknowns)} unknowns, but {problem.y.size} points: measure more, or leave unknowns out"
        raise ParameterError("unknown", len(unknowns), f"at most {problem.y.size}", sentence)
    idle = flat(problem)
    problem.live = [i for i, name in enumerate(problem.names) if name not in idle]
    if next(iter(records.values())).planned:
        return Identification(problem, [Found(problem.start, problem.cost(problem.residuals(problem.start)))])
    if not (isinstance(starts, (int, np.integer)) and starts >= 1):
        raise ParameterError("starts", starts, "a whole number >= 1")
    return Identification(problem, minima(problem, int(starts), seed, progress))


def _called(cylinder: Cylinder, data: Sequence[Record], shifts: Mapping[str, Shift]) -> dict[str, Record]:
    """The records by name; those without one are called by their kind."""
    found: dict[str, Record] = {}
    for record in data:
        if not isinstance(record, Record):
            raise ParameterError("data", f"{record!r:.60}", "a list of Resistance, Traction and Coastdown")
        called, n = record.name or record.KIND, 1
        while called in found:
            n += 1
            if record.name:
                raise ParameterError("name", repr(record.name), "another for each record")
            called = f"{record.KIND} {n}"
        if record.planned and not record.sigma:
            raise ParameterError(f"{called}: sigma", None, "given where there are no values")
        if record.temperature is not None:
            refuse_unshifted(cylinder, called, record.temperature, shifts)
        found[called] = record
    if not found:
        raise ParameterError("data", "no record", "at least one")
    if len({record.planned for record in found.values()}) > 1:
        sentence = "some records have values and some have none: fit those first, then plan with its cylinder"
        raise ParameterError("data", "mixed", "all with values, or none", sentence)
    return found


def _priors(given: Mapping[str, tuple[float, float]], unknowns: list[Any]) -> list[tuple[int, float, float]]:
    """(Which coordinate, its mean, its standard deviation)."""
    found, names = [], [one.name for one in unknowns]
    for name, pair in given.items():
        if name not in names:
            raise unknown("prior", name, names, "an unknown")
        one = unknowns[names.index(name)]
        if np.shape(pair) != (2,):
            raise ParameterError(f"prior {name}", f"{pair!r:.40}", "(value, standard deviation)")
        low = -np.inf if one.unit is not None else 0.0
        mean = number(f"prior {name}", pair[0], low=low, strict=True)
        sd = number(f"standard deviation of prior {name}", pair[1], low=0.0, strict=True)
        found.append((names.index(name), float(one.to_u(mean)), sd if one.unit is None else sd / one.unit))
    return found
