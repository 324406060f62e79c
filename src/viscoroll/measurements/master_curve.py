"""Sweeps at several temperatures, shifted to one :func:`master_curve`: the points of each sweep
(:func:`sets_of`), the reference temperature, and the factors a_T of the shifts (:class:`Shifts`).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    ArrayLike,
    Floats,
    Integers,
    ParameterError,
    check_array,
    described_error,
    shape_error,
    to_unit,
    warn_of_model,
)
from ..materials import (
    NEAR,
    USUAL_RANGE,
    ShiftFactors,
    VerticalShift,
    check_celsius,
    relative_shift,
    vertical_factor,
)
from .dynamic_moduli import SAME_TEMPERATURE, UNITS, Curve, data_of, thinned

# --- Sweeps at several temperatures ---

#: K; least distance of the temperatures of two sets: sweeps are made 5 or 10 K apart
LEAST_DISTANCE = NEAR
#: distance from 1 up to which a factor counts as 1: rounding of factors in files
_ONE = 1e-9


def points_of(temperature: Any, *columns: Any) -> tuple[Floats, list[Floats], Integers | None]:
    """Return measured moduli as flat columns, with a temperature for each point.

    temperature : of columns of points one number for all of them, or (n,), number i of point i; of
        lists of curves (curves,), number k of vector k of each column, also if it is the only one;
        degrees Celsius.
    *columns : omega, storage and loss, three, each a column of points, (n,), or each a list or
        tuple of ``curves`` vectors, those of curve k equally long, or a 2-D array of one curve a
        row; with units or without.  They count as lists of curves if omega is a 2-D array, or a
        list or tuple whose first element is a vector.
    Returns (temperature of each point, degrees Celsius, (n,); [omega, storage, loss], (n,) each,
    curve after curve, in rad/s and the unit of the moduli (Pa, if they have units); index of the
    first point of each curve, (curves,), or None of columns of points).
    Raises ParameterError for shapes that do not go together, a curve without points, a unit of
    another dimension, columns that are not numbers, finite and > 0, and for temperatures that are
    no finite numbers.
    """
    given = check_array("temperature", temperature, unit="degC")
    named = {
        name: to_unit(name, column, UNITS[name]) for name, column in zip(Curve._fields, columns)
    }
    omega = named["omega"]
    several = isinstance(omega, (list, tuple)) and omega and np.ndim(omega[0]) == 1
    first = None
    if several or getattr(omega, "ndim", 0) == 2:
        sizes = [*map(np.size, omega)]
        for name, column in named.items():
            own = [*map(np.size, column)]
            if own != sizes:
                raise described_error(
                    name, f"has curves of {own} points", f"as many as omega has, {sizes}"
                )
        if given.shape != (len(sizes),):
            raise shape_error(
                "temperature", given.shape, f"one number for each curve; omega has {len(sizes)}"
            )
        if 0 in sizes:
            raise described_error(
                "omega",
                f"has no points for curve {sizes.index(0) + 1}",
                "a list with points for each curve",
            )
        first = np.cumsum([0, *sizes[:-1]])
        given = np.repeat(given, sizes)
        named = {name: np.concatenate(column) for name, column in named.items()}
    elif given.ndim == 0:
        given = np.full(np.shape(omega), given)
    if given.ndim != 1:
        raise shape_error(
            "temperature",
            given.shape,
            "a plain list of one dimension, with one number for each point or for each curve",
        )
    flat = [check_array(name, column, above=0.0) for name, column in named.items()]
    for name, column in zip(named, flat):
        if column.shape != given.shape:
            others = f"of shape {given.shape}, as temperature or, if that is one number, omega"
            raise shape_error(name, column.shape, f"one number for each point, {others}")
    return given, flat, first


def sets_of(temperature: Floats, first: Integers | None) -> tuple[list[float], Integers, Integers]:
    """Divide points into sets of one temperature.

    In ascending order, a temperature at most :data:`LEAST_DISTANCE`, 0.5 K, above the one before is
    of the same set.

    temperature : temperature of each point, degrees Celsius, shape (n,), in any order.
    first : index of the first point of each curve, each < n, (curves,), as in :func:`points_of`;
        None: each set counts as a curve, in the order in which their first points come.
    Returns (temperature of each set, ascending, degrees Celsius: the median of its points; index of
    the set of each point, (n,); index of the set of each curve, (curves,), of which several may be
    of one set).
    Raises ParameterError for no points, and a set whose temperatures span more than
    :data:`.dynamic_moduli.SAME_TEMPERATURE`, 1 K.
    """
    if not temperature.size:
        raise described_error("temperature", "is empty", "one number for each point")
    order = np.argsort(temperature, kind="stable")
    ascending = temperature[order]
    label = np.cumsum(np.diff(ascending, prepend=ascending[0]) > LEAST_DISTANCE, dtype=np.int64)
    of_point = label[np.argsort(order)]
    parts = np.split(ascending, np.flatnonzero(np.diff(label)) + 1)
    for part in parts:
        if part[-1] - part[0] > SAME_TEMPERATURE:
            raise described_error(
                "temperature",
                f"rises from {part[0]:g} to {part[-1]:g} °C in steps of at most "
                f"{LEAST_DISTANCE:g} K",
                f"equal within {SAME_TEMPERATURE:g} K in each sweep, with larger steps between "
                "sweeps; give each point the nominal temperature of its sweep",
            )
    if first is None:  # in the order in which the sets come
        first = np.sort(np.unique(of_point, return_index=True)[1])
    return [float(np.median(part)) for part in parts], of_point, of_point[first]


def reference_of(base: float | None, temperatures: list[float], unshifted: list[float]) -> float:
    """Return the reference temperature of a master curve.

    base : the one that the user gives, degrees Celsius, or None.
    temperatures : temperatures of the sets, at least one, ascending, degrees Celsius.
    unshifted : temperatures at which the given shift is 1, degrees Celsius; empty, or NaN, where
        none is known.
    Returns degrees Celsius: ``base``; if it is None the first of ``unshifted`` from the lowest to
    the highest set, else the temperature of the middle set, of an even number the warmer one of the
    two.
    """
    if base is not None:
        return base
    inside = (T for T in unshifted if temperatures[0] <= T <= temperatures[-1])
    return next(inside, temperatures[len(temperatures) // 2])


def listed_factors(
    shift: Any, temperatures: list[float], of_curve: Integers, base: float | None
) -> tuple[Floats, float]:
    """Sort listed shift factors by sets, and divide them by that of the reference.

    shift : factors a_T > 0, dimensionless, (curves,), in the order of the curves.
    temperatures, of_curve : temperature of each set, degrees Celsius, and index of the set of each
        curve, (curves,), as in :func:`sets_of`.
    base : reference, degrees Celsius; None: the temperature of the coldest set whose factor is 1 to
        1e-9, else that of the middle set, of an even number the warmer one.
    Returns (factors of the sets relative to the reference, (sets,); reference, degrees Celsius).
    Raises ParameterError for factors that are not finite and > 0, of another number than the
    curves, or different for curves of one set, and for a reference more than 0.5 K from all sets.
    """
    factors = check_array("shift", shift)
    if (factors <= 0.0).any():
        raise ParameterError(
            "shift", f"{factors.min():g}", "> 0: give the factors a_T, not their logarithms"
        )
    if factors.shape != of_curve.shape:
        raise shape_error(
            "shift",
            factors.shape,
            f"one factor for each of {of_curve.size} temperatures or curves, in their order",
        )
    found = np.empty(len(temperatures))
    # of several curves of a set the last factor stays, with which all are compared
    found[of_curve] = factors
    if (differs := found[of_curve] != factors).any():
        at = temperatures[of_curve[differs.argmax()]]
        raise described_error(
            "shift",
            f"has different factors for the temperature {at:g} °C",
            f"one factor for each temperature (two within {LEAST_DISTANCE:g} K count as one)",
        )
    base = reference_of(
        base, temperatures, [T for T, a_T in zip(temperatures, found) if abs(a_T - 1.0) <= _ONE]
    )
    index = np.argmin(np.abs(np.subtract(temperatures, base)))
    if abs(temperatures[index] - base) > LEAST_DISTANCE:
        raise ParameterError(
            "reference",
            base,
            f"one of {', '.join(map(str, temperatures))} °C, which have a factor in shift; for "
            "others give shift as a function of the temperature, as vr.WLF(T0=20.0)",
        )
    return found / found[index], base


# --- Curves at several temperatures as one master curve, by horizontal shifts ---

#: least number of points of both curves in their overlap
_POINTS = 3
#: least ratio of the overlap to the shorter range of the two curves, in ln omega
_OVERLAP = 0.15
#: step in ln a_T of the search: within it the mismatch has one minimum
_STEP = 0.05
#: rms mismatch of a modulus below which it counts as no better: the accuracy of the best DMA
_FLOOR = 2e-3
#: rms mismatch of ln E' and ln E'' above which curves do not overlap: a third of the moduli
_LARGEST_MISMATCH = 0.3
#: ratio of the rms mismatch of one modulus to its least above which the moduli disagree on the
#: shift
_DISAGREES = 1.5
#: difference of rms mismatches up to which two shifts are equally good: the accuracy of usual DMA
_EQUALLY_GOOD = 0.01
#: decades over which all shifts are equally good above which a plateau leaves the shift open: a
#: factor of three either way
LARGEST_FREEDOM = 1.0


@dataclass(frozen=True, kw_only=True)
class Shifts(ShiftFactors):
    """Shift factors that lay the curves of several temperatures on one; as a function a_T at any
    temperature between.

    temperature : median temperature of the points of each curve, ascending, degrees Celsius,
        (curves,).
    a_T : times at this temperature over those at the reference: factor of frequencies, (curves,).
    T0, reference : temperature of the master curve, degrees Celsius, at which a_T is 1; it need not
        be one of ``temperature``.
    mismatch : between each curve and its warmer neighbour, root mean square of the differences of
        ln E' and ln E'' after the shift, (curves - 1,); NaN where the factors were given.
    freedom : between the same, decades over which the shift may be moved before the mismatch of E'
        or of E'' rises by 0.01 (1 % of the modulus), (curves - 1,): large where the curves are flat
        (a plateau fixes no shift); NaN where the factors were given.
    distinct : number of different temperatures that were given.
    """

    mismatch: Floats = field(compare=False)
    freedom: Floats = field(compare=False)
    distinct: int

    @property
    def reference(self) -> float:
        """Temperature of the master curve, degrees Celsius."""
        return self.T0


def master_curve(
    omega: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    temperature: ArrayLike,
    reference: float | None,
    shift: ArrayLike | Callable[[float], float] | None,
    on: str,
    vertical_shift: VerticalShift,
) -> tuple[Curve, Shifts]:
    """Shift the curves of several temperatures to one, by frequencies times a_T.

    Parameters
    ----------
    omega, storage, loss : columns, (n,), or lists of curves, one vector a temperature; rad/s, and
        one unit of moduli.
    temperature : degrees Celsius, one of all points, one a point, (n,), or one a curve, (curves,).
    reference : degrees Celsius; None: where a given shift is 1 (T0 of a :class:`viscoroll.WLF` or
        :class:`viscoroll.Arrhenius`, the temperature of a factor of 1), if it is within the
        temperatures, else the temperature of the middle curve, of an even number the warmer one.
    shift : factors a_T > 0, dimensionless, in the order of the curves, (curves,); a function of the
        temperature in degrees Celsius that returns a_T; or None: found by the overlap of
        neighbouring curves, and interpolated to the reference (:class:`viscoroll.ShiftFactors`).
        All are divided by that of the reference.
    on : "both" or "storage": the moduli by whose overlap shifts are found, if none are given.
    vertical_shift : b_T by which moduli are divided, relative to the reference, as in
        :class:`viscoroll.Material`.

    Returns
    -------
    tuple
        (The master curve, a :class:`Curve` of all n points at the reference temperature, sorted by
        frequency; the :class:`Shifts` of the temperatures, whose ``mismatch`` and ``freedom`` are
        NaN where the shifts were given.) Of a single temperature the factor is 1, unless ``shift``
        is a function and the reference another temperature.

    Raises
    ------
    ParameterError
        Moduli or frequencies that are not > 0 and finite, or fewer than 3 points; temperatures of
        another number than points or curves; temperatures that drift, so that sweeps cannot be told
        apart; a reference more than 0.5 K outside of the temperatures where the overlap gives the
        shifts, or with listed factors at none of them; a curve of a single frequency, where the
        overlap gives the shifts; neighbouring curves that do not overlap, or whose best shift is
        the last that leaves an overlap; shift factors of another number than the curves, not > 0,
        or larger at the highest temperature than at the lowest, also those of the overlap.

    Warns
    -----
    ModelWarning
        Curves so flat that their overlap leaves more than a decade for the shift; E' and E'' that
        overlap best at different shifts; a factor that rises with temperature; kelvins.
    """
    point_temperatures, (x, *moduli), first = points_of(temperature, omega, storage, loss)
    temperatures, of_point, of_curve = sets_of(point_temperatures, first)
    low = temperatures[0]
    high = temperatures[-1]
    check_celsius("temperature", high if high > USUAL_RANGE[1] else low)
    base = None if reference is None else check_celsius("reference", reference)
    # relative to the coldest curve, as the reference may not be known yet
    b_T = np.array([vertical_factor(vertical_shift, T, low) for T in temperatures])
    moduli = [each / b_T[of_point] for each in moduli]
    mismatch = freedom = np.full(len(temperatures) - 1, math.nan)
    if callable(shift) and not isinstance(shift, type):
        base = reference_of(base, temperatures, [getattr(shift, "T0", math.nan)])
        factor = np.array([relative_shift(shift, T, base) for T in temperatures])
    elif shift is not None:
        factor, base = listed_factors(shift, temperatures, of_curve, base)
    else:
        base = reference_of(base, temperatures, [])
        if not low - LEAST_DISTANCE <= base <= high + LEAST_DISTANCE:
            raise ParameterError(
                "reference",
                base,
                f"from {low} to {high} °C, the range of temperature, or at most 0.5 K beyond",
            )
        curves = []
        for n, T in enumerate(temperatures):
            part = [column[of_point == n] for column in (x, *moduli)]
            where = f" at {T:g} °C"
            curve = data_of(Curve, *part, fewest=2, where=where)
            curves.append(_LogCurve(thinned(curve), on, where))
        a_T, mismatch, freedom = _shifts_by_overlap(curves, temperatures)
        found = ShiftFactors(temperature=tuple(temperatures), a_T=tuple(a_T), T0=base)
        # relative to the coldest curve so far, now to the reference, which may lie between curves
        factor = a_T / found(base) if len(curves) > 1 else a_T
    shifts = Shifts(
        temperature=tuple(temperatures),
        a_T=tuple(factor),
        T0=base,
        mismatch=mismatch,
        freedom=freedom,
        distinct=np.unique(point_temperatures).size,
    )
    open_shifts = undetermined_shifts(shifts)
    rises = [
        f"from {cold:g} to {warm:g} °C (by a factor of {ratio:.3g})"
        for cold, warm, ratio in zip(temperatures, temperatures[1:], factor[1:] / factor[:-1])
        if ratio > 1.0
    ]
    if factor[-1] > factor[0] and not open_shifts:
        raise ParameterError(
            "shift" if shift is not None else "shift found by the overlap",
            f"{factor[0]:.3g} at {low:g} °C and {factor[-1]:.3g} at {high:g} °C",
            "shift factors a_T (relaxation time divided by that at reference), which fall with "
            f"temperature; {'in a list they have the order of the curves; ' * (shift is not None)}"
            f"check the {'curves' if shift is None else 'factors'}, since a_T rises "
            f"{', '.join(rises)}",
        )
    if rises:
        warn_of_model(
            f"the shift factor a_T rises {'; '.join(rises)}, but should fall: check these curves"
        )
    if open_shifts:
        warn_of_model(
            f"the overlap does not determine the shift {'; '.join(open_shifts)}, where the "
            "curves are flat: give known factors by shift= (in a shell: --wlf)"
            + ', or try on="storage"'
            * (on == "both")
        )
    moduli = [each * vertical_factor(vertical_shift, base, low) for each in moduli]
    return data_of(Curve, x * factor[of_point], *moduli), shifts


def undetermined_shifts(shifts: Shifts) -> list[str]:
    """Return the pairs of neighbouring curves whose shift their overlap leaves open, in words.

    shifts : :class:`Shifts` of the curves, of which temperature and freedom are read.
    Returns a text for each pair whose ``freedom``, the decades over which its shift may be moved,
    is above :data:`LARGEST_FREEDOM`, one decade, with both temperatures and these decades, coldest
    first; [] where there is none, as for factors that were given.
    """
    pairs = zip(pairwise(shifts.temperature), shifts.freedom)
    return [
        f"from {cold:g} to {warm:g} °C (all shifts within {free:.1f} decades fit)"
        for (cold, warm), free in pairs
        if free > LARGEST_FREEDOM
    ]


def _shifts_by_overlap(
    curves: "list[_LogCurve]", temperatures: list[float]
) -> tuple[Floats, Floats, Floats]:
    """Find the shifts of neighbouring curves by their overlap.

    curves : list of :class:`_LogCurve`, one for each temperature, at least one, the coldest first.
    temperatures : temperatures of the curves, degrees Celsius, ascending, for messages.
    Returns (a_T of each curve relative to the coldest, (curves,), the first is 1; rms difference
    of the logarithms of the moduli of each pair of neighbours, (curves - 1,); decades by which the
    shift of each pair may vary, (curves - 1,)); of a single curve the last two are empty.
    Raises ParameterError for neighbours that do not overlap, differ by more than 0.3 in ln E' and
    ln E'', or agree best at the end of the search where the curves are not flat.  Warns with
    ModelWarning of neighbours whose moduli disagree on the shift.
    """
    found = [_align(*pair) for pair in pairwise(curves)]
    torn = []
    for alignment, (cold, warm) in zip(found, pairwise(temperatures)):
        name = f"curves at {cold:g} and {warm:g} °C"
        if not alignment.mismatch <= _LARGEST_MISMATCH:
            raise described_error(
                name,
                "do not agree after any shift",
                "equal where they overlap, after a shift; leave one of the curves out, or give "
                "factors by shift= (in a shell: --wlf)",
            )
        if alignment.at_end and alignment.freedom <= LARGEST_FREEDOM:
            raise described_error(
                name,
                f"agree best with the least overlap that is allowed, {_OVERLAP:.0%} of a curve",
                "closer in temperature, so that they overlap more; measure between these "
                "temperatures, or give known factors by shift= (in a shell: --wlf)",
            )
        if alignment.disagree:
            torn.append(f"from {cold:g} to {warm:g} °C")
    if torn:
        warn_of_model(
            f"storage and loss modulus overlap best at different shifts {', '.join(torn)}; the "
            'one that agrees better decides: compare with a fit with on="storage" (in a shell: '
            "--on storage)"
        )
    # reshaped, since found is empty of a single curve
    steps, mismatch, freedom, *_ = np.reshape(found, (-1, len(_Alignment._fields))).T
    return np.exp(np.append(0.0, np.cumsum(steps))), mismatch, freedom


class _LogCurve:
    """Logarithms of moduli over ln omega, with an interpolant, of the curve of one temperature.

    x : ln omega, ascending, each once, shape (n,).
    y : ln E' and, unless the shift is found on the storage modulus alone, ln E'', shape (n, 2) or
        (n, 1); the mean at repeated frequencies.
    interpolate : the interpolant of y: a function of ln omega, (k,), that returns y there.
    """

    def __init__(self, curve: Curve, on: str, where: str) -> None:
        """Take logarithms, average those of repeated frequencies, and make the interpolant.

        It is a cubic spline, of two or three different frequencies a monotone one (PCHIP).

        curve : :class:`Curve`, storage and loss modulus.
        on : "storage" or "both": the moduli that are kept.
        where : words for the temperature of the curve, for the error.
        Raises ParameterError for a single frequency.
        """
        from scipy import interpolate

        self.x, which = np.unique(np.log(curve.omega), return_inverse=True)
        count = np.bincount(which)
        columns = curve[1:2] if on == "storage" else curve[1:]
        # the mean of the logarithms at each frequency, (frequencies, moduli)
        self.y = np.stack(
            [np.bincount(which, np.log(column)) / count for column in columns], axis=1
        )
        if self.x.size < 2:
            raise described_error(
                "omega",
                f"has only one value{where}",
                "two frequencies or more at each temperature",
            )
        kind = interpolate.CubicSpline if self.x.size > 3 else interpolate.PchipInterpolator
        self.interpolate = kind(self.x, self.y)


class _Alignment(NamedTuple):
    """The shift that lays the warm curve on the cold one; the numbers are NaN where no shift leaves
    an overlap.

    step : what is added to ln omega of the warm curve; a factor a_T below 1 gives a step below 0.
    mismatch : root mean square difference of ln E' (and of ln E'', if it is kept) after the shift.
    freedom : decades over which the shift may be moved before the mismatch of a modulus rises by
        :data:`_EQUALLY_GOOD`.
    at_end : whether the shift is the first or last that leaves an overlap.
    disagree : whether one modulus by itself overlaps much better at another shift.
    """

    step: float
    mismatch: float
    freedom: float
    at_end: bool
    disagree: bool


def _align(cold: _LogCurve, warm: _LogCurve) -> _Alignment:
    """Find the shift of a pair of curves: by a search in steps over all shifts that leave an
    overlap, then by Brent's method.

    The product of the mismatches of E' and E'' is least at the shift: that is the most likely one
    where both have normal errors of unknown size, so that each counts by how well it overlaps
    there, and a part of E'' that does not shift leaves the shift to E'.  Mismatches below
    :data:`_FLOOR` count as equal.

    cold, warm : :class:`_LogCurve`, curve of the lower and of the higher temperature.
    Returns the :class:`_Alignment`, of NaN where no shift leaves enough overlap
    (:func:`_mismatch`).  Of equal mismatches in the search the most negative shift is refined.
    ``freedom`` is measured in the steps of the search, at most 0.05 in ln omega, between the
    nearest steps on either side at which the mismatch of a modulus is more than 0.01 above that at
    the best one, or the ends of the search.
    """
    from scipy import optimize

    def cost(squares: Floats) -> Floats:
        """Return the log of the product of mismatches, from mean ``squares``, (..., moduli)."""
        return np.log(squares + _FLOOR**2).sum(axis=-1)

    low = cold.x[0] - warm.x[-1]
    high = cold.x[-1] - warm.x[0]
    steps = np.linspace(low, high, 2 + int((high - low) / _STEP))
    squares = np.array([_mismatch(step, cold, warm) for step in steps])
    inside = ~np.isnan(squares[:, 0])
    steps = steps[inside]
    squares = squares[inside]
    if not steps.size:
        return _Alignment(math.nan, math.nan, math.nan, at_end=False, disagree=False)
    best = int(np.argmin(cost(squares)))
    around = steps[max(best - 1, 0)], steps[min(best + 1, steps.size - 1)]
    step = optimize.minimize_scalar(
        lambda step: cost(_mismatch(step, cold, warm)),
        bounds=around,
        options={"xatol": 1e-9},
    ).x
    # worse than the best step of the search, or NaN, as beside the last overlap
    if not cost(found := _mismatch(step, cold, warm)) < cost(squares[best]):
        step = steps[best]
        found = squares[best]
    rms = np.sqrt(squares)
    least = np.sqrt(found)
    worse = np.flatnonzero((rms > least + _EQUALLY_GOOD).any(axis=1))
    first = max(worse[worse < best], default=0)
    last = min(worse[worse > best], default=steps.size - 1)
    own = rms.min(axis=0)
    return _Alignment(
        step=step,
        mismatch=math.sqrt(np.mean(found)),
        freedom=(steps[last] - steps[first]) / math.log(10.0),
        at_end=best in (0, steps.size - 1),
        disagree=(least > np.maximum(_DISAGREES * own, own + _EQUALLY_GOOD)).any(),
    )


def _mismatch(step: float, cold: _LogCurve, warm: _LogCurve) -> Floats:
    """Return the mean square difference of two curves where they overlap, each at its points
    against the other's interpolant.

    step : what is added to ln omega of the warm curve, signed.
    cold, warm : :class:`_LogCurve` of the lower and of the higher temperature, of the same moduli.
    Returns the mean of the squared differences of ln E' (and of ln E'', if it is kept),
    dimensionless, (moduli,); NaN where they overlap by less than 15 % of the shorter range in ln
    omega, or with fewer than three points of both together.
    """
    moved = warm.x + step
    low = max(cold.x[0], moved[0])
    high = min(cold.x[-1], moved[-1])
    of_warm = (moved >= low) & (moved <= high)
    of_cold = (cold.x >= low) & (cold.x <= high)
    short = high - low < _OVERLAP * min(np.ptp(cold.x), np.ptp(warm.x))
    if short or of_warm.sum() + of_cold.sum() < _POINTS:
        return np.full(cold.y.shape[1], math.nan)
    # both ways, since either curve may have the finer points
    at_warm = warm.y[of_warm] - cold.interpolate(moved[of_warm])
    at_cold = cold.y[of_cold] - warm.interpolate(cold.x[of_cold] - step)
    difference = np.concatenate([at_warm, at_cold])
    return np.mean(difference * difference, axis=0)
