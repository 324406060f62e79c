"""Results of an identification: :class:`Identification`, and :class:`Prediction`."""

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..core import (
    Floats,
    ParameterError,
    Result,
    SummaryRow,
    Values,
    check_integer,
    check_names,
    check_number,
    describe_value,
    described_error,
)
from ..core.plots.result_figures import identification
from .identification_report import as_dataset, column_attributes, report
from .least_squares import Minimum, Problem
from .measurement_records import Record
from .profile import Likelihood, Product
from .unknowns import cylinder_of

#: confidence level of intervals and bands
_LEVEL = 0.95
#: most draws of a band
_DRAWS = 100_000
#: candidates of each draw: those outside of the ranges are rejected
_CANDIDATES = 50


#: (low, high) of an interval, None on a side that is open
Interval: TypeAlias = tuple[float | None, float | None]


class Band(NamedTuple):
    """A quantity at the best values, and the ends of its confidence band.

    value, low, high : SI units, each of the shape of the points of the record.
    """

    value: Any
    low: Any
    high: Any


class Prediction(Values):
    """Quantities of a record by name, as ``.Q``, each a :class:`Band` with ``.value``, ``.low`` and
    ``.high``.

    The three are arrays over the points of the record, in SI units, of xarray or pandas where those
    of the record are; NaN at times that a motion did not reach.
    """

    def __getattr__(self, name: str) -> Band:
        """Return the :class:`Band` of a quantity of the record; AttributeError for other names."""
        return Band(
            *(super(Prediction, self).__getattr__(name + end) for end in ("", "_low", "_high"))
        )


class Identification(Result):
    """Best values of the unknowns, their standard deviations and intervals, and the limits of the
    data.

    ``print`` shows a report; its intervals are profiles, which take about as long as the fit for
    each unknown.

    Attributes
    ----------
    cylinder : the :class:`Cylinder` of the best values.
    values : name of each unknown -> its value, SI.
    stderr : name -> standard deviation of the value, SI, by the slopes at the best fit, limited by
        the ranges; infinite for an unknown that changes no residual.
    correlations : of the coordinates of the unknowns (logarithms of the values, or of brake, drag,
        nu and unknowns of records the values), (unknowns, unknowns), in the order of ``values``.
    chi2 : sum of the squared residuals, each divided by sigma, those of priors included; of robust
        fits outliers count less.  0 of a plan.
    dof : its expectation, the degrees of freedom: number of points and priors minus number of
        unknowns, >= 0.
    sigma : "QUANTITY of RECORD" -> standard deviation of each point, as given or as estimated, SI,
        (points,).
    minima : list of (chi2, name -> value) of the minima whose chi2 is less than 15 above the least,
        the best first.
    does_not_act : names of unknowns that do not change what was measured; they stay at their start.
    undetermined : names of unknowns whose interval at 0.95 is wider than a factor of e^2 or than
        half their range, and of those whose correlation with these is beyond +-0.95;
        :meth:`products` gives the products that are determined.
    noise : "QUANTITY of RECORD" -> ``.rms`` of the residuals over sigma, ``.lag``, their lag-1
        correlation, ``.allowed``, the largest one of noise, and ``.is_noise``; of robust fits rms
        and lag as a tenth of outliers changes them little.
    misfit : names "QUANTITY of RECORD" whose residuals are no noise: lag-1 beyond 3/sqrt(n), or rms
        that far above 1, or, of robust fits, above what noise and a tenth of outliers give.  Where
        it is the lag, standard deviations and intervals are those of the effective number of points
        (``.repeats`` of ``noise``); where the model is inadequate they mean nothing.
    predicted : name of each record -> :class:`Prediction` of the best fit.
    records : the data: name -> record, with arrays in SI units.
    planned : whether the records have no values: standard deviations and intervals are those to
        expect.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.presets.RUBBER_CYLINDER
    >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
    >>> result = vr.identify(roller, {"mu": (0.1, 1.0)}, [plan])
    >>> result.planned, result.stderr["mu"] < 1e-3
    (True, True)
    """

    def __init__(self, problem: Problem, found: list[Minimum]) -> None:
        """Collect the values and statistics of the best fit.

        problem : :class:`Problem`, the least squares, with its standard deviations as estimated at
            the best minimum.
        found : list of :class:`Minimum`, the minima of chi2, the best first, at least one.

        The attributes of the class are set but for ``predicted`` and ``undetermined``, which are
        computed when they are first used.
        """
        self._problem = problem
        self._likelihood = Likelihood(problem, found)
        u, self.chi2 = found[0]
        self.values = problem.values(u)
        self.minima = [(minimum.chi2, problem.values(minimum.u)) for minimum in found]
        self.dof = problem.points - u.size
        self.records = problem.records
        self.planned = problem.planned
        self.sigma = {str(column): problem.sigma[column.at].copy() for column in problem.columns}
        self.noise = problem.noise(u)
        self.misfit = tuple(name for name, noise in self.noise.items() if not noise.is_noise)
        self.cylinder = cylinder_of(problem.cylinder, self.values)
        self.does_not_act = tuple(
            name for i, name in enumerate(self.values) if i not in problem.active
        )
        self.correlations = self._likelihood.correlations
        # of a value that of its coordinate times d value/d coordinate
        self.stderr = {
            unknown.name: float(unknown.slope(self.values[unknown.name]) * sd)
            for unknown, sd in zip(problem.unknowns, self._likelihood.sd)
        } | dict.fromkeys(self.does_not_act, math.inf)

    @cached_property
    def predicted(self) -> dict[str, Prediction]:
        """The best fit to each record with its bands at the level 0.95: name of the record ->
        :class:`Prediction`.

        The bands are from slopes, as in :meth:`predict` with ``draws`` = 0.
        """
        return {
            record_name: self._predict(record, record_name, _LEVEL)
            for record_name, record in self.records.items()
        }

    def _delta_chi2(self, level: float = _LEVEL) -> float:
        """Return the rise of chi2 above its minimum at the ends of a confidence interval,
        dimensionless.

        It is a quantile of the chi-squared distribution with one degree of freedom where sigma is
        given, 3.84 at 0.95, and of the F distribution with (1, dof) where any sigma is estimated
        or residuals are autocorrelated; the effective number of points then counts.

        level : confidence level, in (0, 0.9999].
        Returns the rise, > 0, a float.
        Raises ParameterError for another level.
        """
        from scipy import stats

        level = check_number("level", level, above=0.0, high=0.9999)
        lost = self._problem.points - self._likelihood.points
        if not lost and not any(column.estimated for column in self._problem.columns):
            return float(stats.chi2.ppf(level, 1))
        return float(stats.f.ppf(level, 1, max(self.dof - lost, 1.0)))

    def intervals(self, level: float = _LEVEL) -> dict[str, Interval]:
        """Return the interval of each unknown by its profile: (low, high), None on a side that is
        open.

        One unknown is varied while all others are fitted to each of its values, until chi2 is above
        its minimum by the quantile of ``level``: of the chi-squared distribution with one degree of
        freedom, 3.84 at 0.95, or, where any sigma was estimated, of the F distribution with (1,
        ``dof``).  A side is open where chi2 does not rise so far up to the end of the range.  If
        another branch of the fit is found beyond an end, the interval includes it, and all between.

        Parameters
        ----------
        level : confidence level, in (0, 0.9999].

        Returns
        -------
        dict of str to (float or None, float or None)
            Name of each unknown -> (low, high) of its interval, SI units; None on a side that is
            open, (None, None) of an unknown that does not act.

        Raises
        ------
        ParameterError
            Another level.

        Examples
        --------
        >>> import viscoroll as vr
        >>> roller = vr.presets.RUBBER_CYLINDER
        >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
        >>> low, high = vr.identify(roller, {"mu": (0.1, 1.0)}, [plan]).intervals()["mu"]
        >>> low < 0.3 < high
        True
        """
        found: dict[str, Interval] = dict.fromkeys(self.values, (None, None))
        for i, sides in self._likelihood.unknown_profiles(self._delta_chi2(level)).items():
            unknown = self._problem.unknowns[i]
            low, high = (
                None if end is None else float(unknown.to_value(end)) for end in sides.ends
            )
            found[unknown.name] = low, high
        return found

    @cached_property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the unknowns whose interval at 0.95 is wide, and of those that are correlated
        with them.

        The limits are those of the class.  Unknowns that do not act are not among them; () where
        all are determined.
        """
        return tuple(
            self._problem.names[i] for i in self._likelihood.undetermined(self._delta_chi2())
        )

    def products(self, level: float = _LEVEL) -> list[Product]:
        """Return products of powers of the :attr:`undetermined` unknowns that the data determine,
        with their intervals.

        First the products that hold over the whole intervals are returned; their exponents are
        those on which all points that fit agree best (or, if these give none, those of the slopes
        at the best fit), and their intervals are profiles.  Then follow products that hold near the
        values found only, by the slopes there, if their ``high - low`` is below a third of the
        least one before, or there is none before.

        Parameters
        ----------
        level : confidence level of the intervals of the products, in (0, 0.9999]; which unknowns
            are undetermined is decided at 0.95.

        Returns
        -------
        list[Product]
            :class:`.profile.Product`, each with ``.powers`` (name -> exponent), ``.value`` (at the
            best fit, of the magnitudes of SI values), ``.low`` and ``.high`` (both divided by
            ``value``), ``.near`` (whether it holds near the values found only) and ``.limited_by``
            (for each end the names of unknowns whose range, not the data, limits it); of either
            kind the best determined first.  It is empty where fewer than two unknowns are
            undetermined, or no product has an interval that is closed and at most a factor of e
            long.

        Raises
        ------
        ParameterError
            For another level.

        Examples
        --------
        The rolling resistance at one speed does not tell the modulus from the times of the rubber:

        >>> import viscoroll as vr
        >>> drum = vr.Resistance(V=[0.5, 0.5], sigma=0.01)
        >>> result = vr.identify(
        ...     vr.presets.RUBBER_CYLINDER, {"E": (2e6, 4e6), "T_ref": (0.5, 2.0)}, [drum]
        ... )
        >>> [list(product.powers) for product in result.products()]
        [['E', 'T_ref']]
        """
        return self._likelihood.products(
            self._likelihood.undetermined(self._delta_chi2()), self._delta_chi2(level)
        )

    def predict(
        self, record: Record, *, draws: int = 0, level: float = _LEVEL, seed: int = 0
    ) -> Prediction:
        """Predict a record, with bands.

        Parameters
        ----------
        record : a :class:`measurement_records.Resistance`, :class:`measurement_records.Traction` or
            :class:`measurement_records.Coastdown` with coordinates, and load and temperature if
            they differ from those of the cylinder; a motion needs
            numbers for V0 and t0, and for omega0 a number or "rolling", which may be others than
            those fitted.  Its values are not used.
        draws : number of random values of the unknowns to take the bands from, at most 100000;
            those outside of the ranges are drawn again, 50 times on average at most, and without
            any inside the band has no width.  0: the band is from slopes, symmetric about the
            value, and takes two computations an unknown.  Both suppose the normal law: of what is
            undetermined a band is a guess.
        level : confidence level of the bands, in (0, 0.9999].
        seed : seed of the draws, >= 0.

        Returns
        -------
        Prediction
            ``.M`` and ``.F`` of a Resistance, ``.Q`` of a Traction, or ``.V``, ``.omega`` and
            ``.x`` of a Coastdown, each with ``.value``, ``.low`` and ``.high`` over its points, SI;
            NaN at times that the motion does not reach.

        Raises
        ------
        ParameterError
            What is no record; a motion without V0, or with an omega0 or a t0 that is unknown;
            draws, level or seed out of range; a temperature without a shift; values of the record,
            or of a draw, that make no contact or no motion.

        Examples
        --------
        >>> import viscoroll as vr
        >>> roller = vr.presets.RUBBER_CYLINDER
        >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
        >>> band = (
        ...     vr.identify(roller, {"mu": (0.1, 1.0)}, [plan])
        ...     .predict(vr.Traction(V=1.0, delta=[0.1]))
        ...     .Q
        ... )
        >>> bool(band.low < band.value < band.high)
        True
        """
        if not isinstance(record, Record):
            raise ParameterError(
                "record", describe_value(record), "a vr.Resistance, vr.Traction or vr.Coastdown"
            )
        for name, (_, span) in record.initial_values(self.cylinder.R).items():
            if span is not None:
                raise described_error(
                    f"{name} of the record", "is not given", "given for a prediction"
                )
        return self._predict(
            record,
            "",
            level,
            check_integer("draws", draws, 0, _DRAWS),
            check_integer("seed", seed, 0),
        )

    def _predict(
        self, record: Record, record_name: str, level: float, draws: int = 0, seed: int = 0
    ) -> Prediction:
        """Predict the quantities of a record, with confidence bands.

        The coordinates of the unknowns (logarithms of most, :class:`.unknowns.Unknown`) are taken
        to be normal about the best fit, with the covariance of its slopes.

        record : :class:`.measurement_records.Record`, the record.
        record_name : name of the record among the data, which its own unknowns bear, as V0:NAME; ""
            of a record that was not fitted.
        level : confidence level of the bands, in (0, 0.9999].
        draws : number, >= 0, of random values of the unknowns, of whose predictions the ends of the
            bands are quantiles.  Of 50 candidates for each those within the ranges are taken, at
            most ``draws``, so that there may be fewer; where there are none the ends are the value
            itself.  0: the bands are from slopes at the best fit, the value -+ its standard
            deviation times sqrt(:meth:`_delta_chi2`).
        seed : seed of the draws, >= 0; not used for slopes.
        Returns the :class:`Prediction`: QUANTITY, QUANTITY_low and QUANTITY_high for each of the
        ``QUANTITIES`` of the record, SI units, in the shape of its points, with its coordinates and
        labels.  Where the value is NaN, at points that a motion did not reach, the band from slopes
        is NaN too; a quantile is NaN only where all draws are.
        Raises ParameterError for another level, and ViscorollError where the best values, those of
        a draw or of a step of the slopes make no contact or no motion.
        """
        problem = self._problem
        cov = self._likelihood.cov
        u = self._likelihood.best.u

        def predict(u: Floats) -> Floats:
            """Return the quantities at the coordinates u, SI, shape (quantities, *shape of the
            points).
            """
            values = problem.predicted(record, u, record_name)
            return np.array([values[name] for name in record.QUANTITIES])

        value = predict(u)
        factor = math.sqrt(self._delta_chi2(level))
        if draws:
            drawn = np.random.default_rng(seed).multivariate_normal(
                u, cov, draws * _CANDIDATES, method="eigh"
            )
            inside = drawn[((drawn >= problem.low) & (drawn <= problem.high)).all(axis=1)][:draws]
            predictions = [predict(point) for point in (inside if len(inside) else [u])]
            low, high = np.nanquantile(predictions, (0.5 - 0.5 * level, 0.5 + 0.5 * level), axis=0)
        else:
            # slopes() has its axes in reverse order: here (unknowns, quantities, *shape of points)
            J = problem.slopes(predict, u, range(u.size)).T
            half = factor * np.sqrt(np.maximum(np.einsum("i...,ij,j...", J, cov, J), 0.0))
            low = value - half
            high = value + half
        found = {
            name + end: row
            for end, rows in {"": value, "_low": low, "_high": high}.items()
            for name, row in zip(record.QUANTITIES, rows)
        }
        coordinates = {name: getattr(record, name) for name in record.COORDINATES}
        return Prediction(
            found,
            coordinates,
            {name: column_attributes(name) for name in (*found, *coordinates)},
            f"Prediction, {level:.0%} bands",
            si=True,
            labels=record.labels,
        )

    def residuals(self, values: Mapping[str, float]) -> Floats:
        """Return the residuals at values of the unknowns, for optimisers and samplers of other
        packages.

        A residual is predicted minus measured value, divided by sigma (of a plan, the value
        predicted at the start counts as measured); robust fits weigh it later, not here.  Where the
        values make no cylinder or no motion, all residuals of the data are 1e6, and so are those at
        times that a motion does not reach; elsewhere they are within -+1e6.

        Parameters
        ----------
        values : name -> value of unknowns, SI; others are at their start, not at the best fit.

        Returns
        -------
        array of shape (residuals,)
            Residuals, dimensionless: of the records in their order, then one for each prior.

        Raises
        ------
        ParameterError
            Unknown names, and values that the unknown cannot have.

        Examples
        --------
        >>> import viscoroll as vr
        >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
        >>> result = vr.identify(vr.presets.RUBBER_CYLINDER, {"mu": (0.1, 1.0)}, [plan])
        >>> result.residuals({"mu": 0.3})  # the start
        array([0., 0.])
        """
        return self._problem.residuals(self._coordinates(values))

    def jacobian(self, values: Mapping[str, float]) -> Floats:
        """Return the derivatives of :meth:`residuals` by the values, by central differences.

        At an end of the range of an unknown, and outside of its range, the difference is one-sided,
        towards the range.

        Parameters
        ----------
        values : name -> value of unknowns, SI; others are at their start, not at the best fit.

        Returns
        -------
        array of shape (residuals, unknowns)
            Derivatives, in one over the SI unit of each unknown, in the order of the attribute
            ``values``; the column of an unknown that does not act is (nearly) 0.

        Raises
        ------
        ParameterError
            As :meth:`residuals`.

        Examples
        --------
        >>> import viscoroll as vr
        >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
        >>> result = vr.identify(vr.presets.RUBBER_CYLINDER, {"mu": (0.1, 1.0)}, [plan])
        >>> result.jacobian({"mu": 0.3}).shape
        (2, 1)
        """
        u = self._coordinates(values)
        scales = [
            unknown.slope(unknown.to_value(x)) for unknown, x in zip(self._problem.unknowns, u)
        ]
        return self._problem.jacobian(u) / scales

    def _coordinates(self, values: Mapping[str, float]) -> Floats:
        """Return the coordinates of the unknowns that belong to values.

        values : name -> value of unknowns, SI or with a unit; others are at their start.
        Returns a vector, (unknowns,): the logarithm of each value, or of linear unknowns the value
        in their unit.
        Raises ParameterError for unknown names, and for values that the unknown cannot have, as
        negative ones; values outside of the range of the search are allowed.
        """
        check_names("values", values, self.values, "an unknown")
        found = []
        for unknown in self._problem.unknowns:
            value = values.get(unknown.name, unknown.start)
            found.append(
                unknown.to_u(check_number(unknown.name, value, **unknown.bounds(unknown.name)))
            )
        return np.array(found)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the short summary.

        The rows are :class:`SummaryRow`: one for each unknown with its value and standard deviation
        ("inf" where it does not act), in SI units without their names, and the last with chi2 and
        the degrees of freedom, or that a standard deviation was estimated.
        """
        title = f"Identification, unknowns: {len(self.values)}, points: {self._problem.y.size}"
        rows = [
            SummaryRow(name, f"{value:.6g} +- {self.stderr[name]:.2g}")
            for name, value in self.values.items()
        ]
        if any(column.estimated for column in self._problem.columns):  # then chi2 is about dof
            return title, [*rows, SummaryRow("sigma", "estimated from the residuals")]
        return title, [*rows, SummaryRow("chi2", f"{self.chi2:.1f} (noise: about {self.dof})")]

    __str__ = report
    to_xarray = as_dataset
    _figure = identification
