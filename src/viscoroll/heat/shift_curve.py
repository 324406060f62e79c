"""The shift of a material over temperature, for arrays: :class:`ShiftCurve`.

Time-temperature superposition makes the law at a temperature that of the reference at the speed V
a_T.  A vertical shift b_T multiplies all moduli, so that kappa, with the contact length at rest,
has the factor sqrt(b_T).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ..core import Floats, ModelWarning, ParameterError, ViscorollError, described_error
from ..materials.material import Material
from ..materials.measured_data import WLF, Arrhenius, relative_shift, vertical_factor

#: nodes in an octave of a_T, as of the scan over speed of ``steady``: kappa M has at most one
#: extremum between two
NODES = 16
#: size of log2 of a_T and of kappa V a_T beyond which no contact is evaluated
FARTHEST = 900
#: temperatures, degrees Celsius, between which a function without a ``range`` is sampled: from the
#: coldest at which rubbers are measured to far beyond the hottest at which one lasts
_SAMPLED_RANGE = -150.0, 1000.0
#: samples of such a function; a step is then 0.23 K, over which ln a_T is straight to 1e-3
_SAMPLES = 5001
#: rise of log2 a_T between samples that is rounding
_ROUNDING = 1e-12
#: smallest divisor: the quotient for a divisor <= 0 is then larger than any other
_LEAST = 1e-300


@dataclass(frozen=True, eq=False)
class ShiftCurve:
    """a_T and sqrt(b_T), relative to the reference, at many temperatures.

    material : the material at its reference.
    low, high : temperatures between which the shift is defined and a double holds a_T, degrees
        Celsius; high is inf of a WLF and an Arrhenius.
    temperature_of : function of log2 a_T, (n,), that returns temperatures between low and high; of
        a function interpolated between samples.
    slope, pole, own : log2 a_T = slope/(theta - pole) - own, K, degrees Celsius and dimensionless,
        of a WLF or Arrhenius without vertical shift; slope is 0 of others.
    ends : slopes of log2 a_T at low and high, 1/K, with which others are extrapolated.
    """

    material: Material
    low: float
    high: float
    temperature_of: Callable[[Floats], Floats]
    slope: float = 0.0
    pole: float = 0.0
    own: float = 0.0
    ends: tuple[float, float] = (0.0, 0.0)

    def factors(self, theta: Floats) -> tuple[Floats, Floats]:
        """Return a_T and sqrt(b_T) relative to the reference at temperatures (n,), to the bits of
        ``Material.at``; outside of low to high those of the nearer end.
        """
        shift: Any = self.material.shift
        vertical = self.material.vertical_shift
        reference = self.material.temperature
        inside = theta.clip(self.low, self.high)
        different, index = (
            np.unique(inside, return_inverse=True) if inside.size > 1 else (inside, ...)
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # of temperatures that look like kelvin
            unit = 1.0 if reference is None else shift(reference)
            found = [
                (shift(at) / unit, math.sqrt(vertical_factor(vertical, at, reference)))
                for at in different.tolist()
            ]
        a_T, root_b = np.reshape(found, (-1, 2)).T
        return a_T[index], root_b[index]

    def at(self, theta: Floats) -> tuple[Floats, Any]:
        """Return :meth:`factors` at temperatures (n,), of a WLF or Arrhenius to rounding, and
        beyond the range extrapolated: ln a_T as a straight line, b_T as a constant.
        """
        if self.slope:
            log2 = self.slope / np.maximum(theta - self.pole, _LEAST) - self.own
            return np.exp2(log2.clip(-FARTHEST, FARTHEST)), 1.0
        a_T, root_b = self.factors(theta)
        below = self.ends[0] * np.minimum(theta - self.low, 0.0)
        above = self.ends[1] * np.maximum(theta - self.high, 0.0)
        return np.exp2((np.log2(a_T) + below + above).clip(-FARTHEST, FARTHEST)), root_b

    def nodes(self, cold: float, hot: float) -> Floats:
        """Return temperatures from ``cold`` to ``hot``, ascending, between which log2 a_T falls by
        at most 1/16 within the range of the shift, (m,).
        """
        least, most = NODES * np.log2(self.at(np.array([hot, cold]))[0])
        inner = self.temperature_of(np.arange(math.floor(least), math.ceil(most) + 1) / NODES)
        return np.unique(np.concatenate([[cold, hot], inner[(inner > cold) & (inner < hot)]]))


def shift_curve(material: Material) -> ShiftCurve:
    """Return the curve of a material's shift, which is kept.

    Raises ParameterError for a material without a shift, for a shift that is not defined at the
    reference or does not fall with temperature.
    """
    return _make_curve(material, material.shift, material.vertical_shift)


@lru_cache(maxsize=64)
def _make_curve(material: Material, shift: Any, vertical: Any) -> ShiftCurve:
    """Return :func:`shift_curve` of a material with these shifts, by which materials do not
    differ.
    """
    reference = material.temperature
    if shift is None:
        allowed = "given to the Material of a body that relaxes: a WLF, an Arrhenius or a function"
        raise ParameterError("shift", None, allowed)
    if isinstance(shift, WLF | Arrhenius) and vertical is None:
        pole = shift.pole
        slope = shift.slope / math.log(2.0)
        own = slope / ((shift.T0 if reference is None else reference) - pole)

        def temperature_of(x: Floats) -> Floats:
            return pole + slope / np.maximum(x + own, _LEAST)

        low = pole + slope / (FARTHEST + own)
        return ShiftCurve(material, low, math.inf, temperature_of, slope, pole, own)
    theta, a_T = _sampled(shift, reference)
    log2 = np.log2(a_T)
    if (rises := np.flatnonzero(np.diff(log2) > _ROUNDING)).size:
        found = f"rises at {theta[rises[0]]:.4g} degrees Celsius"
        raise described_error("shift", found, "a function that does not rise with temperature")
    slopes = np.diff(log2) / np.diff(theta)
    return ShiftCurve(
        material=material,
        low=float(theta[0]),
        high=float(theta[-1]),
        temperature_of=lambda x: np.interp(x, log2[::-1], theta[::-1]),
        ends=(float(slopes[0]), float(slopes[-1])),
    )


def _sampled(shift: Any, reference: float | None) -> tuple[Floats, Floats]:
    """Sample a shift in the range around the reference in which it is defined.

    shift: function of a temperature in degrees Celsius, whose attribute ``range``, if it has one,
        is (lowest, highest) temperature.
    reference: temperature of the material; None: that at which a_T is 1.
    Raises ParameterError for a shift that is not defined at the reference.
    """
    low, high = getattr(shift, "range", _SAMPLED_RANGE)
    theta = np.linspace(low, high, _SAMPLES)
    a_T = np.full(theta.size, np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        for n, at in enumerate(theta.tolist()):
            try:
                a_T[n] = relative_shift(shift, at, reference)
            except (ViscorollError, ArithmeticError, ValueError):
                continue
    unknown = np.flatnonzero(np.isnan(a_T))
    if unknown.size == theta.size:
        raise described_error(
            "shift", "is not defined at the temperature of the material", "defined there"
        )
    own = np.nanargmin(np.abs(np.log(a_T)))  # at the reference a_T is 1
    first = unknown[unknown < own].max(initial=-1) + 1
    last = unknown[unknown > own].min(initial=theta.size)
    return theta[first:last], a_T[first:last]
