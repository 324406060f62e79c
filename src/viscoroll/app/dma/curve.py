"""Measured moduli, checked and sorted, and whether storage and loss modulus go together.

:class:`Curve` and :class:`Relaxation` are what a series is fitted to.  Both say what a mode adds to their columns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ...core.array_types import Floats
from ...core.checks import check_array
from ...core.errors import ParameterError

#: points that a curve must have
FEWEST_POINTS = 3
#: points above which the means of logarithmic bins are fitted in their place, and the number of bins: the least squares
#: take a time in proportion to the points, and 500 bins hold every detail that modes of one or two a decade can follow
MOST_POINTS, _BINS = 1000, 500
#: a slope is taken over a quarter of a decade on either side, and over five points at least
_WINDOW, _NEIGHBOURS = 0.25 * math.log(10.0), 5
#: of the columns of a curve
UNITS = {"omega": "rad s-1", "storage": "Pa", "loss": "Pa", "t": "s", "relaxation": "Pa"}
#: of ln omega, below which frequencies are one
_APART = 1e-12


class Curve(NamedTuple):
    """Storage and loss modulus over angular frequency, ascending, all positive."""

    omega: Floats
    storage: Floats
    loss: Floats

    @property
    def band(self) -> tuple[float, float]:
        """Lowest and highest angular frequency of the data, rad/s."""
        return float(self.omega[0]), float(self.omega[-1])

    @property
    def shortest(self) -> float:
        """Shortest time of a mode that the data can tell, s: of E'' any, since a mode's tail falls as omega only."""
        return 0.0

    @property
    def values(self) -> Floats:
        """The measured moduli, a row each, shape (2, n)."""
        return np.array([self.storage, self.loss])

    @property
    def constant(self) -> tuple[float, ...]:
        """What a long-time modulus of 1 adds to each row."""
        return 1.0, 0.0

    def responses(self, tau: Floats) -> Floats:
        """What modes of strength 1 and times tau, s, shape (modes,), add to each row: shape (2, n, modes).

        z^2/(1 + z^2) and z/(1 + z^2), z = omega tau.
        """
        z = self.omega[:, None] * tau
        loss = 1.0 / (z + 1.0 / z)
        return np.array([z * loss, loss])

    def slopes(self, tau: Floats, responses: Floats) -> Floats:
        """Derivatives of ``responses(tau)`` by ln tau."""
        storage, loss = responses
        return np.array([2.0 * loss * loss, loss * (1.0 - 2.0 * storage)])

    @property
    def fluid(self) -> ParameterError:
        """The error where no long-time modulus is left."""
        lowest = f"from {self.storage[0]:g} at omega = {self.omega[0]:g} on"
        return ParameterError(
            "storage", lowest, "a curve that levels off at low frequencies: here it is that of a fluid"
        )


class Relaxation(NamedTuple):
    """Relaxation modulus over time, ascending, all positive.  Properties and methods as of :class:`Curve`, one row."""

    t: Floats
    relaxation: Floats

    @property
    def band(self) -> tuple[float, float]:
        return float(1.0 / self.t[-1]), float(1.0 / self.t[0])

    @property
    def shortest(self) -> float:
        """Half of the first, s: of a mode of a tenth exp(-10) is left there, and noise alone would set its strength."""
        return 0.5 * float(self.t[0])

    @property
    def values(self) -> Floats:
        return self.relaxation[None]

    @property
    def constant(self) -> tuple[float, ...]:
        return (1.0,)

    def responses(self, tau: Floats) -> Floats:
        """exp(-t/tau)."""
        return np.exp(-self.t[:, None] / tau)[None]

    def slopes(self, tau: Floats, responses: Floats) -> Floats:
        return (self.t[:, None] / tau) * responses

    @property
    def fluid(self) -> ParameterError:
        last = f"down to {self.relaxation[-1]:g} at t = {self.t[-1]:g}"
        return ParameterError("relaxation", last, "a curve that levels off at long times: here it is that of a fluid")


_Data = TypeVar("_Data", Curve, Relaxation)


class KramersKronig(NamedTuple):
    """Measured loss modulus over the one that the slope of the storage modulus allows.

    omega : angular frequency, rad/s.
    ratio : E''/((pi/2) dE'/d ln omega); infinite where E' does not rise, NaN where there is no slope.
    median : of the ratios; near 1 where the spectrum is broad and the data are sound.
    """

    omega: Floats
    ratio: Floats
    median: float


def data_of(kind: type[_Data], columns: Mapping[str, Any], fewest: int = FEWEST_POINTS) -> _Data:
    """Columns as a curve, sorted by the first of them.

    Parameters
    ----------
    kind : :class:`Curve` or :class:`Relaxation`.
    columns : its fields by the names under which they were given, in their order.
    fewest : number of points that it must have.

    Raises
    ------
    ParameterError
        Values that are not positive or not finite, columns of other shapes, or fewer than ``fewest`` points.
    """
    values = [check_array(name, given, unit=UNITS[name], low=0.0, strict=True) for name, given in columns.items()]
    first = next(iter(columns))
    for name, column in zip(columns, values, strict=True):
        if column.ndim != 1 or column.shape != values[0].shape:
            raise ParameterError(name, f"of shape {column.shape}", f"one column, of the shape of {first}")
    if values[0].size < fewest:
        raise ParameterError(first, f"{values[0].size} points", f"at least {fewest} points")
    order = np.argsort(values[0], kind="stable")
    return kind(*(column[order] for column in values))


def curve_of(omega: ArrayLike, storage: ArrayLike, loss: ArrayLike, fewest: int = FEWEST_POINTS) -> Curve:
    """Storage and loss modulus as a curve; arguments and errors of :func:`data_of`."""
    return data_of(Curve, {"omega": omega, "storage": storage, "loss": loss}, fewest)


def thinned(data: _Data) -> _Data:
    """The means of logarithmic bins where there are more than :data:`MOST_POINTS`, else the data as they are.

    In a bin the frequency (time) is the geometric mean, a modulus the arithmetic one: an error of measurement that is 0
    on average stays so.
    """
    x = np.log(data[0])
    if x.size <= MOST_POINTS:
        return data
    place = (x - x[0]) * (_BINS / (x[-1] - x[0] or 1.0))
    which = np.minimum(place.astype(np.int64), _BINS - 1)
    count = np.bincount(which)
    full = count > 0
    first, *others = (np.bincount(which, column)[full] / count[full] for column in (x, *data[1:]))
    return type(data)(np.exp(first), *others)


def kramers_kronig(curve: Curve) -> KramersKronig:
    """The local form of the Kramers-Kronig relations, E'' = (pi/2) dE'/d ln omega.

    It is exact for a power law in the limit of small exponents, and good where E' bends little within a decade
    (H. C. Booij and G. P. J. M. Thoone, Rheologica Acta 21, 15-24, 1982, doi:10.1007/BF01520702).  The slope is
    that of a straight line in ln E' through the neighbours of a point.
    """
    x, y = np.log(curve.omega), np.log(curve.storage)
    ratio, nearest = np.empty_like(x), min(_NEIGHBOURS, x.size) - 1
    for n, at in enumerate(x):
        away = np.abs(x - at)
        near = away <= max(_WINDOW, np.partition(away, nearest)[nearest])
        slope, here = np.polyfit(x[near] - at, y[near], 1) if np.ptp(x[near]) > _APART else (math.nan, 0.0)
        allowed = 0.5 * math.pi * slope * math.exp(here)
        ratio[n] = curve.loss[n] / allowed if allowed > 0.0 else math.nan if math.isnan(slope) else math.inf
    known = ratio[~np.isnan(ratio)]
    return KramersKronig(curve.omega, ratio, float(np.median(known)) if known.size else math.nan)
