"""Curves at several temperatures as one master curve, by horizontal shifts."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.array_types import Floats
from ...core.checks import check_array
from ...core.errors import ModelWarning, ParameterError, caller_level
from ...materials.shift import USUAL_RANGE, check_celsius, relative_shift
from .curve import Curve, curve_of, thinned
from .sweeps import default_reference, listed_factors, nearest, points_of, sets_of

#: points of both curves that must lie in the overlap, and share of the shorter range
_POINTS, _SHARE = 3, 0.15
#: step in ln a_T of the search, and the rms mismatch of ln E', ln E'' from which on curves do not overlap
_STEP, _TOO_FAR = 0.05, 0.3
#: mean square mismatch that stands for no overlap at all
_NONE = 1e6
#: rms mismatch by which two shifts count as equally good: the accuracy of usual DMA
_AS_GOOD = 0.01
#: decades over which all shifts are as good, from which on a plateau is said to leave the shift open: a factor of
#: three either way
LOOSE = 1.0


class Shifts(NamedTuple):
    """Shift factors of the curves.

    temperature : of each curve, ascending, degrees Celsius; the median of those of its points.
    a_T : times at this temperature over those at the reference.
    reference : degrees Celsius; a_T is 1 there.
    mismatch : between each curve and its warmer neighbour, rms of the difference of ln E' and ln E''; NaN where
        they do not overlap or the factors were given.
    freedom : between the same, decades over which the shift may be moved before the mismatch rises by 1 %: large where
        the curves are flat (a plateau fixes no shift); NaN where the factors were given.
    distinct : number of different temperatures that were given.
    """

    temperature: Floats
    a_T: Floats
    reference: float
    mismatch: Floats
    freedom: Floats
    distinct: int


def master_curve(
    omega: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    temperature: ArrayLike,
    reference: float | None,
    shift: ArrayLike | Callable[[float], float] | None,
    on: Literal["both", "storage"] = "both",
) -> tuple[Curve, Shifts]:
    """All points at the reference temperature, frequencies times a_T.

    Parameters
    ----------
    omega, storage, loss : columns of one length, or lists of curves; rad/s, and one unit of moduli.
    temperature : degrees Celsius, one of all points, one a point, or one a curve.
    reference : degrees Celsius; default: where a given shift is 1, else the middle one of the curves.
    shift : factors in the order of the curves, a function of the temperature, or None: by the overlap of neighbours.
    on : the moduli by whose overlap shifts are found.

    Raises
    ------
    ParameterError
        As for curves; a temperature for each point or curve is missing; temperatures that cannot be told apart; a
        reference that the shift says nothing of; neighbouring curves that do not overlap; shift factors that do not
        fit, or rise with the temperature.

    Warns
    -----
    ModelWarning
        Curves so flat that their overlap does not fix the shift; temperatures that look like kelvin.
    """
    at, columns, first = points_of(temperature, omega, storage, loss)
    whole = [
        check_array(name, column, low=0.0, strict=True) for name, column in zip(Curve._fields, columns, strict=True)
    ]
    sets = sets_of(at, first)
    temperatures = sets.temperature
    check_celsius("temperature", temperatures[-1] if temperatures[-1] > USUAL_RANGE[1] else temperatures[0])
    base = None if reference is None else check_celsius("reference", reference)
    unknown = np.full(temperatures.size - 1, math.nan)
    mismatch = freedom = unknown
    if callable(shift):
        base = default_reference(temperatures, [getattr(shift, "T0", math.nan)]) if base is None else base
        factor = np.array([relative_shift(shift, T, base) for T in temperatures.tolist()])
    elif shift is not None:
        factor, base = listed_factors(shift, sets, base)
    else:
        base = default_reference(temperatures, []) if base is None else base
        nearest(base, temperatures, "reference")
        parts = (Curve(*(column[sets.which == n] for column in whole)) for n in range(temperatures.size))
        curves = (thinned(curve_of(*part, fewest=2)) for part in parts)
        logs, mismatch, freedom = _by_overlap([_Smooth(curve, on) for curve in curves], temperatures)
        factor = np.exp(logs - np.interp(base, temperatures, logs))
    if shift is not None and factor[-1] > factor[0]:
        ends = f"{factor[0]:.3g} at {temperatures[0]:g} C and {factor[-1]:.3g} at {temperatures[-1]:g} C"
        allowed = "a_T, times over those at the reference, which fall as it gets warmer, in the order of the curves"
        raise ParameterError("shift", ends, allowed)
    shifts = Shifts(temperatures, factor, base, mismatch, freedom, np.unique(at).size)
    if loose := loose_pairs(shifts):
        text = f"overlap does not fix the shift {'; '.join(loose)}: curves on a plateau; give shift="
        warnings.warn(text + (', or try on="storage"' if on == "both" else ""), ModelWarning, stacklevel=caller_level())
    return curve_of(whole[0] * factor[sets.which], whole[1], whole[2]), shifts


def loose_pairs(shifts: Shifts) -> list[str]:
    """For each pair of neighbours whose shift their overlap leaves open, both temperatures and how far, in words."""
    pairs = zip(pairwise(shifts.temperature), shifts.freedom, strict=True)
    return [f"from {cold:g} to {warm:g} C (within {free:.1f} decades)" for (cold, warm), free in pairs if free > LOOSE]


def _by_overlap(curves: list[_Smooth], temperatures: Floats) -> tuple[Floats, Floats, Floats]:
    """ln a_T from the coldest on; of neighbours the mismatch and the decades of freedom."""
    found = [_aligned(*both) for both in pairwise(curves)]
    for one, pair in zip(found, pairwise(temperatures), strict=True):
        if not one.mismatch <= _TOO_FAR:
            allowed = "those of neighbouring curves that overlap when shifted"
            raise ParameterError("temperature", "{:g} and {:g}".format(*pair), allowed)
    steps, mismatch, freedom = np.reshape(found, (-1, 3)).T
    return np.append(0.0, np.cumsum(steps)), mismatch, freedom


class _Smooth:
    """ln E' and, unless ``on`` is "storage", ln E'' over ln omega: the points, repeated frequencies averaged, and an
    interpolant.
    """

    def __init__(self, curve: Curve, on: str) -> None:
        from scipy.interpolate import CubicSpline, PchipInterpolator

        self.x, which = np.unique(np.log(curve.omega), return_inverse=True)
        count = np.bincount(which)
        columns = curve[1:2] if on == "storage" else curve[1:]
        self.y = np.stack([np.bincount(which, np.log(column)) / count for column in columns], axis=1)
        if self.x.size < 2:
            raise ParameterError("omega", f"{self.x.size} frequency at a temperature", "at least 2 at each")
        self.at = CubicSpline(self.x, self.y) if self.x.size > 3 else PchipInterpolator(self.x, self.y)


class _Aligned(NamedTuple):
    """The shift of ln omega that lays the warm curve on the cold one, the rms mismatch then, and decades of freedom."""

    step: float
    mismatch: float
    freedom: float


def _aligned(cold: _Smooth, warm: _Smooth) -> _Aligned:
    """By a search over all shifts that leave an overlap; NaN where there is none."""
    from scipy.optimize import minimize_scalar

    low, high = cold.x[0] - warm.x[-1], cold.x[-1] - warm.x[0]
    steps = np.linspace(low, high, 2 + int((high - low) / _STEP))
    errors = np.array([_mismatch(step, cold, warm) for step in steps])
    best = int(np.argmin(errors))
    if errors[best] >= _NONE:
        return _Aligned(math.nan, math.nan, math.nan)
    around = steps[max(best - 1, 0)], steps[min(best + 1, steps.size - 1)]
    done = minimize_scalar(_mismatch, bounds=around, args=(cold, warm), method="bounded", options={"xatol": 1e-9})
    error, step = min((done.fun, done.x), (errors[best], steps[best]))
    worse = np.flatnonzero(np.sqrt(errors) > math.sqrt(error) + _AS_GOOD)
    before, behind = worse[worse < best], worse[worse > best]
    ends = before[-1] if before.size else 0, behind[0] if behind.size else steps.size - 1
    return _Aligned(float(step), math.sqrt(error), (steps[ends[1]] - steps[ends[0]]) / math.log(10.0))


def _mismatch(step: float, cold: _Smooth, warm: _Smooth) -> float:
    """Mean square difference of the curves where they overlap, each at its points; :data:`_NONE` without overlap."""
    low, high = max(cold.x[0], warm.x[0] + step), min(cold.x[-1], warm.x[-1] + step)
    if high - low < _SHARE * min(cold.x[-1] - cold.x[0], warm.x[-1] - warm.x[0]):
        return _NONE
    of_warm, of_cold = (warm.x + step >= low) & (warm.x + step <= high), (cold.x >= low) & (cold.x <= high)
    if of_warm.sum() + of_cold.sum() < _POINTS:
        return _NONE
    apart = np.concatenate([
        warm.y[of_warm] - cold.at(warm.x[of_warm] + step), cold.y[of_cold] - warm.at(cold.x[of_cold] - step),
    ])  # fmt: skip
    return float(np.mean(apart * apart))
