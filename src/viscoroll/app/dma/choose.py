"""As few modes as a misfit needs: a grid of times that reaches it, then modes are left out or merged one by one."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product

import numpy as np

from ...core.array_types import Floats
from .spectrum import Data, Spectrum, has_plateau, misfits, on_times, polished

#: decades that the grid of times reaches beyond the data, and modes a decade, as they are tried
MARGINS, DENSITIES = (0.5, 1.0), (1.0, 2.0)
#: where no long-time modulus is left the slow end of the grid is drawn in by quarters of a decade to this
_DRAWN_IN = -0.5
#: a misfit this much above the best one counts as the best
_NEAR_BEST = 1.05
#: calls of the residuals while modes are left out, and at the end; ways to leave one out that are tried
_CALLS, _LAST_CALLS, _WAYS = 40, 400, 3


def chosen(data: Data, target: float, modes: int | None) -> tuple[Spectrum, tuple[float, float], bool]:
    """The spectrum of fewest modes that reaches the target, or the best; of at most ``modes`` if that is given.

    Behind it the ends of its grid of times, and whether the target is reached.

    Raises
    ------
    ParameterError
        If no grid of times leaves a long-time modulus.
    """
    starts = _starts(data, None if modes else target)
    if not starts:
        raise data.fluid
    limit = _NEAR_BEST * min(_size(data, spectrum) for spectrum, _ in starts)
    reached = any(_reaches(data, spectrum, target) for spectrum, _ in starts)

    def good(tried: Spectrum) -> bool:
        return _reaches(data, tried, target) if reached else _size(data, tried) <= limit

    fewest = modes or 1
    enough = (start for start in starts if (good(start[0]) if modes is None else start[0].tau.size >= modes))
    spectrum, ends = next(enough, starts[-1])
    for _ in range(spectrum.tau.size - fewest):
        fewer = _with_one_less(data, spectrum, ends, good if modes is None else None)
        if fewer is None or spectrum.tau.size <= fewest:  # one step may leave out several
            break
        spectrum = fewer
    last = polished(data, spectrum, ends, _LAST_CALLS)
    spectrum = last if modes is not None or good(last) else spectrum
    return spectrum, ends, _reaches(data, spectrum, target)


def _starts(data: Data, target: float | None) -> list[tuple[Spectrum, tuple[float, float]]]:
    """Spectra on grids further and further, denser and denser, until one reaches the target, and their ends.

    The slow end of a grid is drawn in until there is a long-time modulus.
    """
    starts: list[tuple[Spectrum, tuple[float, float]]] = []
    low, high = data.band
    for margin, density in product(MARGINS, DENSITIES):
        for slow in np.arange(margin, _DRAWN_IN - 0.1, -0.25):
            ends = max(10.0**-margin / high, data.shortest), 10.0**slow / low
            if ends[1] > ends[0] and has_plateau(data, found := on_times(data, grid_of_times(ends, density))):
                starts.append((polished(data, found, ends, _CALLS), ends))
                break
        if target is not None and starts and _reaches(data, starts[-1][0], target):
            break
    return starts


def grid_of_times(ends: tuple[float, float], density: float) -> Floats:
    """Times from the longest down, so many a decade, both ends among them."""
    decades = math.log10(ends[1] / ends[0])
    return np.geomspace(ends[1], ends[0], max(2, 1 + round(decades * density)))


def _reaches(data: Data, spectrum: Spectrum, target: float) -> bool:
    return max(misfits(data, spectrum)) <= target


def _size(data: Data, spectrum: Spectrum) -> float:
    return math.hypot(*misfits(data, spectrum))


def _with_one_less(
    data: Data, spectrum: Spectrum, ends: tuple[float, float], good: Callable[[Spectrum], bool] | None
) -> Spectrum | None:
    """One mode less by the best of the ways to do so that is good, or by the best way; None if none is."""
    tried = sorted((on_times(data, tau) for tau in _one_less(spectrum)), key=lambda one: _size(data, one))
    if good is not None and good(tried[0]):
        return tried[0]
    for one in tried[:_WAYS]:
        moved = polished(data, one, ends, _CALLS)
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
