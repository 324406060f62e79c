"""A measured master curve, checked and sorted, and whether its storage and loss modulus go together."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.checks import checked
from ...core.errors import ParameterError
from ...core.typed import Floats

#: points that a curve must have
FEWEST_POINTS = 3
#: a slope is taken over a quarter of a decade on either side, and over five points at least
_WINDOW, _NEIGHBOURS = 0.25 * math.log(10.0), 5
#: of the columns of a curve
UNITS = {"omega": "rad s-1", "storage": "Pa", "loss": "Pa"}
#: of ln omega, below which frequencies are one
_APART = 1e-12


class Curve(NamedTuple):
    """Storage and loss modulus over angular frequency, ascending, all positive."""

    omega: Floats
    storage: Floats
    loss: Floats


class KramersKronig(NamedTuple):
    """Measured loss modulus over the one that the slope of the storage modulus allows.

    omega : angular frequency, rad/s.
    ratio : E''/((pi/2) dE'/d ln omega); infinite where E' does not rise, NaN where there is no slope.
    median : of the ratios; near 1 where the spectrum is broad and the data are sound.
    """

    omega: Floats
    ratio: Floats
    median: float


def curve_of(omega: ArrayLike, storage: ArrayLike, loss: ArrayLike, fewest: int = FEWEST_POINTS) -> Curve:
    """The three columns as a curve, sorted by frequency.

    Raises
    ------
    ParameterError
        Values that are not positive or not finite, columns of other shapes, or fewer than ``fewest`` points.
    """
    given = zip(Curve._fields, (omega, storage, loss), strict=True)
    columns = Curve(*(checked(name, values, unit=UNITS[name], low=0.0, strict=True) for name, values in given))
    for name, values in columns._asdict().items():
        if values.ndim != 1 or values.shape != columns.omega.shape:
            raise ParameterError(name, f"of shape {values.shape}", "one column, of the shape of omega")
    if columns.omega.size < fewest:
        raise ParameterError("omega", f"{columns.omega.size} points", f"at least {fewest} points")
    order = np.argsort(columns.omega, kind="stable")
    return Curve(*(values[order] for values in columns))


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
