"""Reports of fits: of an identification, and of a series fitted to measured moduli.

The report of an identification has the noise of the residuals first, then values, then limits of
the data; it is also made as a dataset, and for JSON.  Of its argument ``fit`` the functions read
the public attributes, ``_problem`` (:class:`.least_squares.Problem`), ``_likelihood``
(:class:`.profile.Likelihood`) and ``_delta_chi2``.  Their sentences are texts without a full stop.
Functions of the other report read the public attributes of a :class:`.fit_results.SeriesFit` alone.
"""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import __version__
from ..core import Dataset, SummaryRow, attributes
from .master_curve import undetermined_shifts
from .measurement_records import ROLLING
from .spectrum import FLOOR
from .unknowns import Unknown

#: points of full slip in a motion below which the report says that mu rests on few
_FEW = 5
#: what residuals that are no noise may mean
_INADEQUATE = "the model does not describe the test, and the intervals mean nothing"
#: correlation from which on the report names it
_CLOSE = 0.9
#: where a product by slopes holds
_NEAR = " (a linear approximation, valid where each unknown changes by less than a fifth)"
#: word behind the name of a column -> what it says of the quantity
_ENDS = {
    "low": "lower end of the band",
    "high": "upper end of the band",
    "fit": "by the best fit",
    "sigma": "standard deviation",
}
#: fall of chi2 below the best fit from which on the report names a point of a profile
_BETTER = 0.1


def report(fit: Any) -> str:
    """Return the report that ``print(fit)`` shows: the fit in one line, warnings of the noise,
    values, limits of the data.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`.
    Returns a text of several lines, without a line break at its end.  The first call computes the
    profiles of the intervals, which take about as long as the fit for each unknown.
    """
    width = max(map(len, fit.values))
    rows = []
    for name, ends in fit.intervals().items():
        low, high = ("unbounded" if end is None else f"{end:.6g}" for end in ends)
        rows.append(
            f"  {name:<{width}}  {fit.values[name]:<12.6g} +- {fit.stderr[name]:<9.2g} 95%: {low} "
            f"to {high}"
        )
    noise, limits = ([f"  ! {line}" for line in lines] for lines in (_noise(fit), _limits(fit)))
    return "\n".join([_heading(fit), *noise, *rows, *limits])


def _heading(fit: Any) -> str:
    """Return the first line of the report: number of unknowns and points, and chi2 or the estimated
    standard deviations.

    Of a plan it says that the standard deviations are those to expect.  Where any standard
    deviation was estimated it lists the estimates, each after its column's "QUANTITY of RECORD":
    that of the first point, in SI units, to three digits; standard deviations that were given, and
    chi2, are then left out.  Else it has chi2 and the degrees of freedom and, unless the fit is
    robust or has no degree of freedom, p, the probability that noise gives a larger chi2.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`, of which values,
        planned, sigma, chi2, dof and, of ``_problem``, y, columns and robust are read.
    Returns a str without a line break.
    """
    from scipy import stats

    problem = fit._problem
    head = (
        f"{len(fit.values)} unknown{'s' * (len(fit.values) > 1)} in SI units, {problem.y.size} "
        f"point{'s' * (problem.y.size > 1)}"
    )
    if fit.planned:
        return (
            f"{head}, planned (not measured): the standard deviations are those to expect if the "
            "values of the cylinder are true"
        )
    if estimated := [
        f"{column} {fit.sigma[str(column)][0]:.3g}"
        for column in problem.columns
        if column.estimated
    ]:
        return (
            f"{head}; standard deviation of the measured values, estimated from the fit: "
            f"{', '.join(estimated)}"
        )
    chance = (
        " (outliers count less)" * problem.robust
        if problem.robust or not fit.dof
        else f" (probability that noise gives more: {stats.chi2.sf(fit.chi2, fit.dof):.2g})"
    )
    return (
        f"{head}; chi2, the sum of ((predicted - measured)/sigma)^2, is {fit.chi2:.1f}; noise "
        f"alone gives about {fit.dof}{chance}"
    )


def _noise(fit: Any) -> Iterator[str]:
    """Yield a sentence for each quantity of a record whose residuals are no noise, as
    ``fit.misfit`` names them, or are autocorrelated.

    A sentence has the rms of the residuals in units of sigma, of a robust fit as found by their
    median, and where they are autocorrelated the lag-1 correlation, its limit and the effective
    number of points; none is yielded where all are noise.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`, of which misfit,
        noise and ``_problem.robust`` are read.
    """
    for name, noise in fit.noise.items():
        rms, lag, allowed, _ = noise
        size = f"their rms is {rms:.2f} sigma" + ", by their median" * fit._problem.robust
        if noise.repeats != 1.0:
            # allowed is 3/sqrt(points)
            points = 9.0 / allowed**2
            yield (
                f"neighbouring residuals (predicted minus measured) of {name} correlate by "
                f"{lag:.2f} ({size}); independent noise gives at most {allowed * 2.0 / 3.0:.2f}.  "
                "Plot the residuals.  If they are correlated noise, the intervals hold: they are "
                f"already widened as if the number of points were {points / noise.repeats:.0f} in "
                f"place of {points:.0f}.  Otherwise {_INADEQUATE}"
            )
        elif name in fit.misfit:
            yield (
                f"the residuals (predicted minus measured) of {name} are larger than noise "
                f"({size}): sigma is too small, or {_INADEQUATE}"
            )


def _limits(fit: Any) -> Iterator[str]:
    """Yield sentences on what the data do not determine; none where they determine all unknowns.

    They are on unknowns that do not act; unknowns that cannot be separated, or a single one that is
    undetermined; what :func:`_interval_limits` says; further minima; motions with few points in
    full slip; and correlations beyond +-0.9, but for pairs of unknowns that the first two name: in
    this order.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`.
    """
    for name in fit.does_not_act:
        rolling = name == "mu" and any(
            getattr(each, "omega0", None) == ROLLING for each in fit.records.values()
        )
        advice = (
            ": omega0 was taken as V0/R, without slip; give omega0 if the cylinder slipped "
            "at the start"
        )
        yield f"the data do not depend on {name}{advice * rolling}"
    *names, last = fit.undetermined or ("",)
    if names:
        yield f"these data cannot separate {', '.join(names)} and {last}: {_products(fit)}"
    elif last:
        yield f"these data do not determine {last}"
    yield from _interval_limits(fit)
    for chi2, values in fit.minima[1:]:
        yield (
            f"other values fit too, with a chi2 that is {chi2 - fit.chi2:.1f} higher: "
            f"{_values_text(values)}"
        )
    yield from _phases(fit)
    loose = {*fit.does_not_act, *fit.undetermined}
    names = list(fit.values)
    # below the diagonal: each pair once
    for i, k in np.argwhere(np.tril(np.abs(fit.correlations) > _CLOSE, -1)):
        if not {names[i], names[k]} <= loose:
            yield (
                f"an error of {names[k]} is nearly compensated by one of {names[i]} (correlation "
                f"of these errors: {fit.correlations[i, k]:+.4f})"
            )


def _products(fit: Any) -> str:
    """Return a sentence on the products of powers of unknowns that the data determine.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`.
    Returns a sentence.  It names the products that are determined over the whole confidence
    intervals, and then those that are determined only near the values found, with the distance
    from these values.  Without products of the first kind it names the second kind alone; without
    both it says that there are none.
    """
    found = fit.products()
    sure, near = (
        " and ".join(
            _product_text(product, fit.values) for product in found if product.near is by_slopes
        )
        for by_slopes in (False, True)
    )
    if not found:
        return "the data determine no product of powers of these either"
    # of those that stand first in the sentence: near is False of the sure ones
    limited = any(any(product.limited_by) for product in found if product.near is not bool(sure))
    within = " within the ranges given" * limited
    text = f"only products of powers are determined{within}: {sure or near}"
    more = (
        f"; near the values found also {near}, more precisely"
        if sure
        else ", and only near the values found"
    )
    return text + f"{more}{_NEAR}" * bool(near)


def _product_text(product: Any, values: dict[str, float]) -> str:
    """Return a product as text, as "E T_ref^0.5 = 1200 (95%: -2 % to +2 %)", the exponent of
    largest absolute value first.

    The value is in SI units without their names, the ends of the interval are relative to it.  An
    end that the range of an unknown limits is named, as "the lower end set by the range of nu".
    Exponents of equal absolute value stay in the order of the product; an exponent of 1 is not
    written.

    product : a :class:`.profile.Product`, whose low and high are ratios to its value; its interval
        is at the level 0.95.
    values : name -> value of the unknowns, SI; the name of a negative one is put between bars, as
        "|V0|^0.5".
    """
    powers = sorted(product.powers.items(), key=lambda item: -abs(item[1]))
    names = {name: f"|{name}|" if values[name] < 0.0 else name for name in product.powers}
    text = " ".join(names[name] if p == 1.0 else f"{names[name]}^{p:.3g}" for name, p in powers)
    low, high = (f"{100.0 * (end - 1.0):+.2g} %" for end in (product.low, product.high))
    lower, upper = (" and ".join(bounds) for bounds in product.limited_by)
    ends = (
        {"both ends": lower} if lower == upper else {"the lower end": lower, "the upper end": upper}
    )
    limits = "".join(
        f", {end} set by the range given for {bounds}" for end, bounds in ends.items() if bounds
    )
    return f"{text} = {product.value:.4g} (95%: {low} to {high}{limits})"


def _interval_limits(fit: Any) -> Iterator[str]:
    """Yield sentences on intervals at 0.95 that the data do not limit, and on faults that their
    profiles show.

    For each unknown that acts they are on ends that are open, several branches of the fit in the
    interval, and a point of the profile whose chi2 is more than 0.1 below that of the best fit.
    Then follow unknowns that are at an end of their range at the best fit, and unknowns whose range
    limits the interval of another one.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`.
    """
    limited: dict[str, list[str]] = {}
    problem = fit._problem
    for i, found in fit._likelihood.unknown_profiles(fit._delta_chi2()).items():
        name = problem.names[i]
        for side, end, bounds in zip(("lower", "upper"), found.ends, found.limited_by):
            if end is None:
                yield (
                    f"the interval of {name} has no {side} end: all values to the {side} end of "
                    "the range given for it fit the data"
                )
            for bound in bounds:
                limited.setdefault(bound, []).append(f"the {side} end of the interval of {name}")
        if found.pieces:
            yield (
                f"the interval of {name} joins separate ranges that fit the data: values between "
                "them may fit worse"
            )
        if found.best.chi2 < fit.chi2 - _BETTER:
            listed = _values_text(problem.values(found.best.u))
            yield (
                f"a better fit was found, with chi2 {found.best.chi2:.1f} at {listed}: repeat "
                "identify with a cylinder of these values, or with more searches (starts)"
            )
    for i in problem.at_bounds(fit._likelihood.best.u):
        yield (
            f"the best fit is at an end of the range given for {problem.names[i]}: extend this "
            "range if possible"
        )
    for bound, ends in limited.items():
        yield f"the range given for {bound}, not the data, determines {', '.join(ends)}"


def _values_text(values: dict[str, float]) -> str:
    """Return values by name in one line, as "E = 1e+06, mu = 0.3"."""
    return ", ".join(f"{name} = {value:.4g}" for name, value in values.items())


def _phases(fit: Any) -> Iterator[str]:
    """Yield a sentence for each motion with one to four points in full slip, which alone determine
    mu.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`; nothing is yielded
        where mu is no unknown, and for records that are no motions.
    """
    for record_name, record in fit.records.items() if "mu" in fit.values else ():
        predicted = fit._problem.predicted(record, fit._likelihood.best.u, record_name)
        slips = np.sum(predicted.get("slips", 0))
        if 0 < slips < _FEW:
            yield (
                f"{record_name} has few points in full slip ({slips}), which alone determine mu: "
                "record that phase with more points"
            )


def as_dataset(fit: Any) -> Dataset:
    """Return an identification as a dataset, for files.

    Parameters
    ----------
    fit : a :class:`viscoroll.measurements.identification_result.Identification`; as its method
        ``to_xarray`` there is no argument.

    Returns
    -------
    xarray.Dataset
        In SI units.  Over ``unknown``: value, stderr (infinite for an unknown that does not act),
        and low and high of the 95 % interval, NaN on a side that is open; all in ``unit``, a
        coordinate over ``unknown``.  Over (``unknown``,
        ``other``): correlation.  Over "RECORD point", for each record, with its name for RECORD and
        that of a coordinate or quantity for NAME: "RECORD NAME" of coordinates and data (a plan has
        no data), and "RECORD NAME fit" and "RECORD NAME sigma" of each quantity that was measured
        or planned.  Attributes: title, source, report (the text), chi2, dof.  Points of a record
        are flat, in the order given.

    Examples
    --------
    >>> import viscoroll as vr
    >>> plan = vr.Traction(V=1.0, delta=[-0.05, 0.05], sigma=0.1)
    >>> data = vr.identify(vr.presets.RUBBER_CYLINDER, {"mu": (0.1, 1.0)}, [plan]).to_xarray()
    >>> data["stderr"].dims, data["traction Q fit"].dims
    (('unknown',), ('traction point',))
    """
    import xarray as xr

    names = np.array(list(fit.values), object)
    low, high = np.array(list(fit.intervals().values()), float).T
    data: dict[str, Any] = {
        "value": ("unknown", list(fit.values.values())),
        "stderr": ("unknown", list(fit.stderr.values())),
        "low": (
            "unknown",
            low,
            {"long_name": "lower end of the 95 % interval, NaN if unbounded"},
        ),
        "high": (
            "unknown",
            high,
            {"long_name": "upper end of the 95 % interval, NaN if unbounded"},
        ),
        "correlation": (("unknown", "other"), fit.correlations),
    }
    for record_name, record in fit.records.items():
        columns = {name: getattr(record, name) for name in (*record.COORDINATES, *record.measured)}
        for name in record.sigma:
            columns[f"{name} fit"] = fit.predicted[record_name][name].value
            columns[f"{name} sigma"] = fit.sigma[f"{name} of {record_name}"]
        for name, values in columns.items():
            data[f"{record_name} {name}"] = (
                f"{record_name} point",
                np.ravel(values),
                column_attributes(name),
            )
    about = {
        "title": "Identification",
        "source": f"viscoroll {__version__}",
        "report": report(fit),
        "chi2": fit.chi2,
        "dof": fit.dof,
    }
    units = [Unknown.bounds(name)["unit"] for name in fit.values]
    coords = {"unknown": names, "other": names, "unit": ("unknown", np.array(units, object))}
    return xr.Dataset(data, coords, about)


def column_attributes(name: str) -> dict[str, str]:
    """Return long_name, units and what else :func:`.quantities.attributes` gives of a column of a
    record in a dataset.

    name: a field of the record, alone or with a key of :data:`_ENDS`, as "F", "Q_low" or "V fit".
    """
    quantity, *end = re.split("[_ ]", name)
    found = attributes(quantity, si=True)
    return found | {"long_name": ", ".join([found["long_name"], *(_ENDS[each] for each in end)])}


def as_json(fit: Any) -> dict[str, Any]:
    """Return the content of the report as numbers and texts that JSON has.

    fit : a :class:`viscoroll.measurements.identification_result.Identification`.
    Returns a dict, in SI units: chi2, dof, planned, does_not_act, undetermined, misfit and minima,
    as of the fit; "source", name and version of this package; "unknowns", name -> {"value",
    "stderr", "interval"} (the interval at 95 %, two numbers, None on a side that is open; stderr
    None of an unknown that does not act); "says", a list of the sentences of the report on noise
    and limits; "products", a list of dicts with the fields of :class:`.profile.Product` (powers,
    value, low, high, near, limited_by); "correlations", a list of rows; "noise", "QUANTITY of
    RECORD" -> a dict with the fields of :class:`.least_squares.Noise` (rms, lag, allowed,
    is_noise); and "sigma", "QUANTITY of RECORD" -> standard deviation of the first point.
    """
    fields = ("chi2", "dof", "planned", "does_not_act", "undetermined", "misfit", "minima")
    unknowns = {
        name: {
            "value": fit.values[name],
            "stderr": sd if np.isfinite(sd := fit.stderr[name]) else None,
            "interval": ends,
        }
        for name, ends in fit.intervals().items()
    }
    return {name: getattr(fit, name) for name in fields} | {
        "source": f"viscoroll {__version__}",
        "unknowns": unknowns,
        "says": [*_noise(fit), *_limits(fit)],
        "products": [product._asdict() for product in fit.products()],
        "correlations": fit.correlations.tolist(),
        "noise": {name: noise._asdict() for name, noise in fit.noise.items()},
        "sigma": {name: float(values[0]) for name, values in fit.sigma.items()},
    }


# --- Report of a series fitted to measured moduli ---

#: range of the median of the Kramers-Kronig ratio of data in which storage and loss go together
_CONSISTENT = (0.8, 1.25)
#: such a median above which the storage modulus does not rise but by rounding
_FLAT = 1e9
#: Poisson's ratio of the factor that the report gives of shear: the default of material()
_NU = 0.49


def summarize_fit(fit: Any) -> tuple[str, list[SummaryRow]]:
    """Return the title and the lines that ``print(fit)`` shows.

    fit : a :class:`viscoroll.measurements.fit_results.SeriesFit`.
    Returns (title, a sentence with the number of modes and of measured points and the range of
    omega or t; the lines below, a list of :class:`SummaryRow` in order).  The first call computes
    ``fit.admissible``.
    """
    low, high = fit.band
    span = (
        f"t = {1.0 / high:.3g} to {1.0 / low:.3g} s"
        if hasattr(fit, "t")
        else f"omega = {low:.3g} to {high:.3g} rad/s"
    )
    rows = [SummaryRow(*row) for row in _rows(fit)]
    return f"Prony series for {fit.points} points, {span}; modes (terms): {fit.prony.E.size}", rows


def _rows(fit: Any) -> Iterator[tuple[str, str]]:
    """Yield the lines of the report below its title, each as (name, text).

    They are: constants (with the factor to Young's modulus where the data are of shear, and the
    temperature where it is known), thinning where points were thinned, misfit, the lines of this
    kind of fit, modes outside the data, accuracy of M, and the table of modes with strengths
    divided by the long-time modulus and times in s.

    fit : a :class:`viscoroll.measurements.fit_results.SeriesFit`.
    Yields pairs (name, text); name is "" of a line that continues the one before.
    """
    prony = fit.prony
    symbol = fit.symbols[0][0]
    floor = (
        f"; the data do not determine it: this is the least allowed, {FLOOR:.0%} of the lowest "
        f"{fit.symbols[0]}" * (not fit.plateau)
    )
    yield symbol, f"{fit.E:.6g} (long-time modulus, unit of the data){floor}"
    if fit.mode == "shear":
        yield (
            "shear",
            "the data are of shear: fit.material(nu) takes E = 2 (1 + nu) G, which is "
            f"{2.0 * (1.0 + _NU):.4g} G at nu = {_NU:g}",
        )
    yield "alpha", f"{prony.alpha:.6g} (instantaneous modulus divided by long-time modulus)"
    yield "T_ref", f"{fit.T_ref:.6g} s (the longest relaxation time)"
    if fit.temperature is not None:
        yield "temperature", f"{fit.temperature:g} °C, at which the relaxation times hold"
    if getattr(fit, "strain", None) is not None:
        yield "strain", f"{fit.strain:.3g}, the amplitude of the test"
    if fit.points > fit.data[0].size:
        yield (
            "thinned",
            f"the fit uses the means of the points in {fit.data[0].size} logarithmic bins, not the "
            "single points",
        )
    target = f"target {fit.target:.2%}{'' if fit.reached else ', not reached'}"
    yield "misfit", f"{fit.misfit_text(2)} (rms, relative); {target}"
    if hasattr(fit, "t"):
        yield (
            "",
            f"{symbol}'' follows from the slope of {symbol}(t); its error is at least ten times "
            f"that of {symbol}(t)",
        )
    else:
        yield from _of_dynamic(fit, symbol)
    yield "outside", _outside(fit)
    found = fit.admissible
    if count := found.rate.size:
        errors = ", ".join(f"+-{error:.2%}" for error in found.error[[0, count // 2, -1]])
        yield (
            "accuracy",
            f"of the rolling moment M: {errors} at the lowest, middle and highest speed that the "
            "data cover; M of other series that fit the data as well differs by no more",
        )
        (low, high), (least, most) = (
            (part.min(), part.max()) for part in (found.E / fit.E, found.alpha / prony.alpha)
        )
        yield (
            "",
            f"in the series with the least and the most M, {symbol} is {low:.3g} to {high:.3g} "
            f"times the {symbol} above, and alpha {least:.3g} to {most:.3g} times the alpha above",
        )
    else:
        yield (
            "accuracy",
            "of the rolling moment M: not known, as the data show no relaxation or span less than "
            "a factor of 3; a contact needs data from f to 3 f in rad/s, with f = speed/contact "
            "length in 1/s",
        )
    yield "modes", f"{symbol}_i/{symbol}      tau_i, s"
    for E, tau, out in zip(prony.E, prony.tau * fit.T_ref, fit.outside):
        yield "", f"{E:<10.4g} {tau:<10.4g}{' outside the range of the data' if out else ''}"


def _of_dynamic(fit: Any, symbol: str) -> Iterator[tuple[str, str]]:
    """Yield the lines of the report on the consistency of storage and loss modulus, and on the
    shifts of a master curve, each as (name, text).

    They are one on Kramers-Kronig; of curves at two or more temperatures also the shift factors, a
    line where temperatures were combined into fewer curves, the largest mismatch of neighbours
    where shifts were found by their overlap, and a line for each shift that the overlap leaves
    open.

    fit : a :class:`viscoroll.Fit`.
    symbol : "E" or "G".
    """
    yield f"{symbol}''", _kramers_kronig(fit.kramers_kronig.median, symbol)
    shifts = fit.shifts
    count = len(shifts.temperature) if shifts else 0
    if count < 2:
        return
    factors = ", ".join(
        f"{T:.4g} °C {np.log10(a):+.3f}" for T, a in zip(shifts.temperature, shifts.a_T)
    )
    yield "shifts", f"to {shifts.reference:g} °C, log10 a_T: {factors}"
    if shifts.distinct > count:
        yield (
            "",
            f"temperatures at most 0.5 K apart were combined: {shifts.distinct} temperatures into "
            f"{count} curves",
        )
    if np.isfinite(shifts.mismatch).any():
        most = np.nanmax(shifts.mismatch)
        yield "", f"neighbouring curves differ by up to {most:.2%} where they overlap (rms)"
    for pair in undetermined_shifts(shifts):
        yield "", f"the overlap does not determine the shift {pair}: the curves are flat there"


def _kramers_kronig(median: float, symbol: str) -> str:
    """Return a sentence on whether storage and loss modulus can be of one material.

    median : median of the Kramers-Kronig ratio, measured over computed loss modulus, dimensionless;
        NaN where it could not be computed, infinite where the storage modulus does not rise.
    symbol : "E" or "G".
    Returns a text without a subject, which follows the symbol of the loss modulus.  It warns of a
    median outside of 0.8 to 1.25, and of NaN says that there are too few frequencies.
    """
    if np.isnan(median):
        return f"cannot be compared with {symbol}': too few different frequencies (Kramers-Kronig)"
    low, high = _CONSISTENT
    if median > _FLAT:
        return (
            f"is above 0, but {symbol}' does not rise with the frequency: the moduli contradict "
            "each other (Kramers-Kronig)"
        )
    return (
        f"is {median:.2f} times the value from the slope of {symbol}' (Kramers-Kronig, median)"
        + f", usual are {low} to {high}: the moduli contradict each other or rise steeply, or "
        "relaxation times are far apart" * (not low <= median <= high)
    )


def _outside(fit: Any) -> str:
    """Return a sentence on the modes whose times lie outside the data, with their share of the sum
    of all strengths.

    Where there are none, the sentence says so; so it does of a series without modes.

    fit : a :class:`viscoroll.measurements.fit_results.SeriesFit`.
    """
    range_of = f"the data's range of {'times' if hasattr(fit, 't') else '1/omega'}"
    if not (count := fit.outside.sum()):
        return f"no relaxation time lies outside {range_of}"
    share = fit.prony.E[fit.outside].sum() / (fit.prony.alpha - 1.0)
    return (
        f"relaxation times outside {range_of}: {count} of {fit.prony.E.size}, with {share:.1%} of "
        "the total relaxation strength"
    )
