"""Curves at several temperatures as one master curve, by horizontal shifts."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.checks import checked, number
from ...core.errors import ParameterError
from ...core.quantities import in_unit
from ...core.scale import SI
from ...core.typed import Floats
from .curve import UNITS, Curve, curve_of

#: points of both curves that must lie in the overlap, and share of the shorter range
_POINTS, _SHARE = 3, 0.15
#: step in ln a_T of the search, and the rms mismatch of ln E', ln E'' from which on curves do not overlap
_STEP, _APART = 0.05, 0.3
#: mean square mismatch that stands for no overlap at all
_NONE = 1e6


class Shifts(NamedTuple):
    """Shift factors of the curves.

    temperature : of each curve, ascending, degrees Celsius.
    a_T : times at this temperature over those at the reference.
    reference : degrees Celsius.
    mismatch : between each curve and its warmer neighbour, rms of the difference of ln E' and ln E''; NaN where
        they do not overlap or the factors were given.
    """

    temperature: Floats
    a_T: Floats
    reference: float
    mismatch: Floats


def master_curve(
    omega: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    temperature: ArrayLike,
    reference: float | None,
    shift: ArrayLike | Callable[[float], float] | None,
) -> tuple[Curve, Shifts]:
    """All points at the reference temperature, frequencies times a_T.

    Raises
    ------
    ParameterError
        As for curves; a temperature for each point or curve is missing; the reference lies outside the
        temperatures; neighbouring curves that do not overlap; shift factors that do not fit.
    """
    at, columns = _points(temperature, omega, storage, loss)
    whole = [checked(name, column, low=0.0, strict=True) for name, column in zip(Curve._fields, columns, strict=True)]
    temperatures, which = np.unique(at, return_inverse=True)
    middle = float(temperatures[temperatures.size // 2])
    base = middle if reference is None else number("reference", reference, unit="degC")
    if not callable(shift) and not temperatures[0] <= base <= temperatures[-1]:
        raise ParameterError("reference", base, f"within [{temperatures[0]:g}, {temperatures[-1]:g}]")
    if shift is None:
        parts = (Curve(*(column[at == T] for column in whole)) for T in temperatures)
        curves = (curve_of(part.omega, part.storage, part.loss, fewest=2) for part in parts)
        logs, mismatch = _by_overlap([_Smooth(curve) for curve in curves], temperatures)
        factor = np.exp(logs - np.interp(base, temperatures, logs))
    else:
        values = [float(shift(T)) for T in temperatures.tolist()] if callable(shift) else shift
        factor, mismatch = checked("shift", values, low=0.0, strict=True), np.full(temperatures.size - 1, math.nan)
        if factor.shape != temperatures.shape:
            allowed = f"a factor each of {temperatures.size} temperatures"
            raise ParameterError("shift", f"of shape {factor.shape}", allowed)
    return curve_of(whole[0] * factor[which], whole[1], whole[2]), Shifts(temperatures, factor, base, mismatch)


def _points(temperature: Any, *columns: Any) -> tuple[Floats, list[Floats]]:
    """A temperature each point, and the columns; of lists of curves as well."""
    given = checked("temperature", temperature, unit=SI)
    columns = tuple(in_unit(name, each, UNITS[name]) for name, each in zip(Curve._fields, columns, strict=True))
    if given.ndim != 1:
        raise ParameterError("temperature", f"of shape {given.shape}", "one column, or one a curve")
    if isinstance(columns[0], (list, tuple)) and columns[0] and np.ndim(columns[0][0]) == 1:
        sizes, *others = ([np.size(curve) for curve in column] for column in columns)
        if others != [sizes, sizes] or len(sizes) != given.size:
            found = f"{given.size} temperatures"
            raise ParameterError("temperature", found, f"one a curve, here {len(sizes)} curves")
        return np.repeat(given, sizes), [np.concatenate(column) for column in columns]
    flat = [np.asarray(column) for column in columns]
    for name, column in zip(Curve._fields, flat, strict=True):
        if column.shape != given.shape:
            raise ParameterError(name, f"of shape {column.shape}", f"one a temperature, of shape {given.shape}")
    return given, flat


def _by_overlap(curves: list[_Smooth], temperatures: Floats) -> tuple[Floats, Floats]:
    """ln a_T from the coldest on, and the mismatch of neighbours."""
    found = [_aligned(*both) for both in pairwise(curves)]
    for (_, error), pair in zip(found, pairwise(temperatures), strict=True):
        if not error <= _APART:
            allowed = "those of neighbouring curves that overlap when shifted"
            raise ParameterError("temperature", "{:g} and {:g}".format(*pair), allowed)
    steps, mismatch = np.reshape(found, (-1, 2)).T
    return np.append(0.0, np.cumsum(steps)), mismatch


class _Smooth:
    """ln E' and ln E'' over ln omega: the points, repeated frequencies averaged, and an interpolant."""

    def __init__(self, curve: Curve) -> None:
        from scipy.interpolate import CubicSpline, PchipInterpolator

        self.x, which = np.unique(np.log(curve.omega), return_inverse=True)
        count = np.bincount(which)
        self.y = np.stack([np.bincount(which, np.log(column)) / count for column in curve[1:]], axis=1)
        if self.x.size < 2:
            raise ParameterError("omega", f"{self.x.size} frequency at a temperature", "at least 2 at each")
        self.at = CubicSpline(self.x, self.y) if self.x.size > 3 else PchipInterpolator(self.x, self.y)


def _aligned(cold: _Smooth, warm: _Smooth) -> tuple[float, float]:
    """The shift of ln omega that lays the warm curve on the cold one, and the rms mismatch then."""
    from scipy.optimize import minimize_scalar

    low, high = cold.x[0] - warm.x[-1], cold.x[-1] - warm.x[0]
    steps = np.linspace(low, high, 2 + int((high - low) / _STEP))
    errors = np.array([_mismatch(step, cold, warm) for step in steps])
    best = int(np.argmin(errors))
    if errors[best] >= _NONE:
        return math.nan, math.nan
    around = steps[max(best - 1, 0)], steps[min(best + 1, steps.size - 1)]
    done = minimize_scalar(_mismatch, bounds=around, args=(cold, warm), method="bounded", options={"xatol": 1e-9})
    error, step = min((done.fun, done.x), (errors[best], steps[best]))
    return float(step), math.sqrt(error)


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
