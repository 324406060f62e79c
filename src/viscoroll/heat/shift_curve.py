"""The shift of a material over temperature, for arrays: :class:`ShiftCurve`, the factor of speed
and its inverse.

Time-temperature superposition makes the law at a temperature that of the reference at the speed V
a_T.  A vertical shift b_T multiplies all moduli, so that kappa, with the contact length at rest,
has the factor sqrt(b_T): of half-spaces the law at a temperature is that of the reference at kappa
V a_T sqrt(b_T), divided by kappa.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.checks import Floats
from ..core.errors import ModelWarning, ParameterError, ViscorollError, described_error
from ..materials.material import Material
from ..materials.measured_data import WLF, Arrhenius, relative_shift, vertical_factor

#: temperatures, degrees Celsius, between which a function without a ``range`` is sampled: from the
#: coldest at which rubbers are measured to far beyond the hottest at which one lasts
_SAMPLED_RANGE = -150.0, 1000.0
#: samples of such a function; a step is then 0.23 K, over which ln a_T is straight to 1e-3
_SAMPLES = 5001
#: slope, 1/K, that makes a constant shift invertible; equilibria are refined with the exact shift
_TILT = 1e-9
#: distance beyond the ends of the samples, K, over which they are extrapolated
_BEYOND = 1e4
#: smallest divisor: the quotient for a divisor <= 0 is then larger than any other
_LEAST = 1e-300


@dataclass(frozen=True, eq=False)
class ShiftCurve:
    """log2 of the factor of kappa V at a temperature, a_T sqrt(b_T) relative to the reference, and
    its inverse.

    material : the material at its reference.
    low, high : temperatures between which the shift is defined, degrees Celsius; -inf and inf of
    none.
    log2_of : function of temperatures, degrees Celsius, any shape; outside of ``low`` to ``high``
    extrapolated.
    temperature_of : its inverse, +inf where the factor has no such value.
    sampled_root_b : function of temperatures that returns sqrt(b_T) relative to the reference;
        None: both functions are those of the shift itself, and b_T = 1, else they interpolate
        samples.
    slope, pole, own : log2_of(theta) = slope/(theta - pole) - own, K, degrees Celsius and
        dimensionless; 0 where they interpolate samples.
    """

    material: Material
    low: float
    high: float
    log2_of: Callable[[Floats], Floats]
    temperature_of: Callable[[Floats], Floats]
    sampled_root_b: Callable[[Floats], Floats] | None = None
    slope: float = 0.0
    pole: float = 0.0
    own: float = 0.0

    def root_b(self, theta: Floats) -> Any:
        """Return sqrt(b_T) relative to the reference at temperatures of any shape; 1.0 without
        samples.
        """
        return 1.0 if self.sampled_root_b is None else self.sampled_root_b(theta)

    def factors(self, theta: Floats) -> tuple[Floats, Floats]:
        """Return a_T and sqrt(b_T) relative to the reference, with the bits of ``Material.at``.

        theta: temperatures, degrees Celsius, (n,).
        Returns (a_T, sqrt(b_T)), (n,) each, dimensionless; NaN where the shift is not defined.
        """
        found = np.full((2, theta.size), np.nan)
        shift = self.material.shift
        vertical = self.material.vertical_shift
        reference = self.material.temperature
        assert shift is not None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # of temperatures that look like kelvin
            unit = 1.0 if reference is None else shift(reference)
            for n, at in enumerate(theta.tolist()):
                if self.low <= at <= self.high:
                    found[:, n] = (
                        shift(at) / unit,
                        math.sqrt(vertical_factor(vertical, at, reference)),
                    )
        return found[0], found[1]

    def exactly(self, theta: Floats) -> tuple[Floats, Any]:
        """Return ``log2_of`` and ``root_b`` without interpolation of samples.

        theta: temperatures, degrees Celsius, (n,).
        Returns (log2 of the factor of kappa V; sqrt(b_T)), dimensionless, (n,), the second 1.0 for
        b_T = 1; extrapolated from the samples where the shift is not defined.
        """
        log2 = self.log2_of(theta)
        root_b = self.root_b(theta)
        if self.sampled_root_b is None:
            return log2, root_b
        a_T, exact = self.factors(theta)
        known = np.isfinite(a_T)
        return np.where(known, np.log2(a_T * exact), log2), np.where(known, exact, root_b)


def shift_curve(material: Material) -> ShiftCurve:
    """Return the :class:`ShiftCurve` of a material, computed at the first call.

    material: the material, which stores the curve.

    Raises ParameterError for a material without a shift, for a shift that is not defined at the
    reference or does not fall with temperature.
    """
    found: Any = material.__dict__.get("_shift_curve")
    if found is None:
        found = material.__dict__["_shift_curve"] = _make_curve(
            material, material.shift, material.vertical_shift
        )
    return found


def _make_curve(material: Material, shift: Any, vertical: Any) -> ShiftCurve:
    """Return the :class:`ShiftCurve` of a material; errors as in :func:`shift_curve`.

    material: the material, whose reference temperature is read.
    shift: a_T: a WLF, an Arrhenius, a function of degrees Celsius, or None, which is refused.
    vertical: b_T, as ``vertical_shift`` of the material.
    """
    if shift is None:
        allowed = "given to the Material of a body that relaxes: a WLF, an Arrhenius or a function"
        raise ParameterError("shift", None, allowed)
    reference = material.temperature
    if isinstance(shift, WLF | Arrhenius) and vertical is None:
        pole = shift.pole
        slope = shift.slope / math.log(2.0)
        own = slope / ((shift.T0 if reference is None else reference) - pole)
        low, high = _range_of(shift, (pole, math.inf))
        return ShiftCurve(
            material=material,
            low=low,
            high=high,
            log2_of=lambda theta: slope / np.maximum(theta - pole, _LEAST) - own,
            temperature_of=lambda x: pole + slope / np.maximum(x + own, _LEAST),
            slope=slope,
            pole=pole,
            own=own,
        )
    theta, a_T = _sampled(shift, *_range_of(shift, _SAMPLED_RANGE), reference)
    roots = np.sqrt([vertical_factor(vertical, at, reference) for at in theta.tolist()])
    log2 = np.log2(a_T * roots)
    if (rises := np.flatnonzero(np.diff(log2) > 0.0)).size:
        found = f"rises at {theta[rises[0]]:.4g} degrees Celsius"
        raise described_error("shift", found, "a function that does not rise with temperature")
    log2 = log2 - _TILT * (theta - theta[0])
    slopes = np.diff(log2)[[0, -1]] / np.diff(theta)[[0, -1]]
    beyond = _BEYOND * np.array([-1.0, 1.0])
    logs = np.insert(log2, [0, log2.size], log2[[0, -1]] + beyond * slopes)
    whole = np.insert(theta, [0, theta.size], theta[[0, -1]] + beyond)
    return ShiftCurve(
        material=material,
        low=float(theta[0]),
        high=float(theta[-1]),
        log2_of=lambda at: np.interp(at, whole, logs),
        temperature_of=lambda x: np.where(
            x < logs[-1], np.inf, np.interp(x, logs[::-1], whole[::-1])
        ),
        sampled_root_b=lambda at: np.interp(at, theta, roots),
    )


def _range_of(shift: Any, default: tuple[float, float]) -> tuple[float, float]:
    """Return (lowest, highest) temperature of a shift by its attribute or method ``range``, else
    the default.
    """
    found = getattr(shift, "range", None)
    found = found() if callable(found) else found
    return default if found is None else (float(found[0]), float(found[1]))


def _sampled(shift: Any, low: float, high: float, reference: float | None) -> tuple[Floats, Floats]:
    """Sample a shift in the range around the reference in which it is defined.

    shift: function of a temperature in degrees Celsius.
    low, high: temperatures between which it is sampled.
    reference: temperature of the material; None: that at which a_T is nearest to 1.
    Returns (temperatures, degrees Celsius; a_T relative to the reference), (n,) each.
    Raises ParameterError for a shift that is not defined at the reference.
    """
    theta = np.linspace(low, high, _SAMPLES)
    a_T = np.full(theta.size, np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        for n, at in enumerate(theta.tolist()):
            try:
                a_T[n] = relative_shift(shift, at, reference)
            except (ViscorollError, ArithmeticError, ValueError):
                continue
    known = np.isfinite(a_T)
    at = int(
        np.argmin(np.abs(theta - reference))
        if reference is not None
        else np.nanargmin(np.abs(np.log(a_T)))
    )
    if not known[at]:
        raise described_error(
            "shift", "is not defined at the temperature of the material", "defined there"
        )
    ends = np.flatnonzero(~known)
    first = ends[ends < at].max(initial=-1) + 1
    last = ends[ends > at].min(initial=theta.size)
    return theta[first:last], a_T[first:last]
