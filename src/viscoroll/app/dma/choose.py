"""As few modes as a misfit needs: a grid of times that reaches it, then modes are left out or merged one by one."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product

import numpy as np

from ...core.errors import ParameterError
from ...core.typed import Floats
from .curve import Curve
from .spectrum import Spectrum, has_plateau, misfits, on_times, polished

#: decades that the grid of times reaches beyond the data, and modes a decade, as they are tried
MARGINS, DENSITIES = (0.5, 1.0), (1.0, 2.0)
#: where no long-time modulus is left the slow end of the grid is drawn in by quarters of a decade to this
_DRAWN_IN = -0.5
#: a misfit this much above the best one counts as the best
_NEAR_BEST = 1.05
#: calls of the residuals while modes are left out, and at the end; ways to leave one out that are tried
_CALLS, _LAST_CALLS, _WAYS = 40, 400, 3


def chosen(curve: Curve, target: float, modes: int | None) -> tuple[Spectrum, tuple[float, float], bool]:
    """The spectrum of fewest modes that reaches the target, or the best; of at most ``modes`` if that is given.

    Behind it the ends of its grid of times, and whether the target is reached.

    Raises
    ------
    ParameterError
        If no grid of times leaves a long-time modulus.
    """
    starts = _starts(curve, None if modes else target)
    if not starts:
        lowest = f"from {curve.storage[0]:g} at omega = {curve.omega[0]:g} on"
        allowed = "a curve that levels off at low frequencies: here it is that of a fluid"
        raise ParameterError("storage", lowest, allowed)
    limit = _NEAR_BEST * min(_size(curve, spectrum) for spectrum, _ in starts)
    reached = any(_reaches(curve, spectrum, target) for spectrum, _ in starts)

    def good(tried: Spectrum) -> bool:
        return _reaches(curve, tried, target) if reached else _size(curve, tried) <= limit

    fewest = modes or 1
    enough = (start for start in starts if (good(start[0]) if modes is None else start[0].tau.size >= modes))
    spectrum, ends = next(enough, starts[-1])
    for _ in range(spectrum.tau.size - fewest):
        fewer = _with_one_less(curve, spectrum, ends, good if modes is None else None)
        if fewer is None or spectrum.tau.size <= fewest:  # one step may leave out several
            break
        spectrum = fewer
    last = polished(curve, spectrum, ends, _LAST_CALLS)
    spectrum = last if modes is not None or good(last) else spectrum
    return spectrum, ends, _reaches(curve, spectrum, target)


def _starts(curve: Curve, target: float | None) -> list[tuple[Spectrum, tuple[float, float]]]:
    """Spectra on grids further and further, denser and denser, until one reaches the target, and their ends.

    The slow end of a grid is drawn in until there is a long-time modulus.
    """
    starts: list[tuple[Spectrum, tuple[float, float]]] = []
    for margin, density in product(MARGINS, DENSITIES):
        for slow in np.arange(margin, _DRAWN_IN - 0.1, -0.25):
            ends = 10.0**-margin / float(curve.omega[-1]), 10.0**slow / float(curve.omega[0])
            if ends[1] > ends[0] and has_plateau(curve, found := on_times(curve, grid_of_times(ends, density))):
                starts.append((polished(curve, found, ends, _CALLS), ends))
                break
        if target is not None and starts and _reaches(curve, starts[-1][0], target):
            break
    return starts


def grid_of_times(ends: tuple[float, float], density: float) -> Floats:
    """Times from the longest down, so many a decade, both ends among them."""
    decades = math.log10(ends[1] / ends[0])
    return np.geomspace(ends[1], ends[0], max(2, 1 + round(decades * density)))


def _reaches(curve: Curve, spectrum: Spectrum, target: float) -> bool:
    return max(misfits(curve, spectrum)) <= target


def _size(curve: Curve, spectrum: Spectrum) -> float:
    return math.hypot(*misfits(curve, spectrum))


def _with_one_less(
    curve: Curve, spectrum: Spectrum, ends: tuple[float, float], good: Callable[[Spectrum], bool] | None
) -> Spectrum | None:
    """One mode less by the best of the ways to do so that is good, or by the best way; None if none is."""
    tried = sorted((on_times(curve, tau) for tau in _one_less(spectrum)), key=lambda one: _size(curve, one))
    if good is not None and good(tried[0]):
        return tried[0]
    for one in tried[:_WAYS]:
        moved = polished(curve, one, ends, _CALLS)
        if good is None or good(moved):
            return moved
    return None


def _one_less(spectrum: Spectrum) -> list[Floats]:
    """Times with one left out, and with two neighbours at their mean time, weighted by strength."""
    tau, strength = spectrum.tau, spectrum.strength
    without = [np.delete(tau, n) for n in range(tau.size)]
    for n in range(tau.size - 1):
        mean = np.exp(np.average(np.log(tau[n : n + 2]), weights=strength[n : n + 2]))
        without.append(np.concatenate([tau[:n], [mean], tau[n + 2 :]]))
    return without
