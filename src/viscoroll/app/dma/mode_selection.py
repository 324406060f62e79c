"""Fewest modes for a misfit: a grid of times that reaches it, from which modes are left out or merged one by one.

A row of the data is one measured modulus: a :class:`.curve.Curve` has two, storage and loss, a
:class:`.curve.Relaxation` one.  The misfit of a row is the root mean square of its relative errors, dimensionless.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product

import numpy as np

from ...core.array_types import Floats
from ...core.errors import described_error
from .spectrum import Data, Spectrum, has_plateau, misfits, on_times, refined

#: decades that the grid of times reaches beyond the data, in the order in which they are tried
MARGINS = (0.5, 1.0)
#: modes a decade of the grid, in the order in which they are tried
DENSITIES = (1.0, 2.0)
#: margin of the slow end in decades, down to which it goes by quarters while no long-time modulus is left
_LEAST_MARGIN = -0.5
#: ratio of a misfit to the best one up to which it counts as the best
_NEAR_BEST = 1.05
#: calls of the residuals of each refinement while modes are left out
_CALLS = 40
#: calls of the residuals of the last refinement
_LAST_CALLS = 400
#: number of spectra with one mode less that are refined
_CANDIDATES = 3


def fewest_modes(data: Data, target: float, modes: int | None) -> tuple[Spectrum, tuple[float, float], bool]:
    """Find a spectrum of few modes that reaches a misfit, or comes within 5 % of the best one where none reaches it.

    Spectra on grids of times are the starts.  From the first that is good enough modes are left out one by one, as long
    as the spectrum stays good enough, and times are refined.  Where no grid reaches the target, good enough is a root
    of the sum of the squared misfits within 5 % of the least among the grids.

    data : measured moduli, a :class:`.curve.Curve` or a :class:`.curve.Relaxation`.
    target : largest misfit of each row of the data, a root mean square of relative errors, dimensionless, > 0.
    modes : number of modes to fit, an int >= 1; the target then decides the returned flag alone.  The spectrum has
        fewer where no grid has as many modes with a strength > 0, or where one is lost as another is left out.  None:
        as few as the target needs.
    Returns (the :class:`Spectrum`, times descending, which may have no mode; (shortest, longest time) of its grid, s,
    within which its times lie; whether every row has a misfit <= target).

    Raises
    ------
    ParameterError
        If no grid of times leaves a long-time modulus: the data are of a fluid.
    RuntimeError
        As of :func:`.spectrum.on_times`, where SciPy's non-negative least squares do not end.
    """
    starts = _fit_wider_grids(data, None if modes else target)
    if not starts:
        x, name, *_ = data._fields
        side, n = ("long times", -1) if x == "t" else ("low frequencies", 0)
        found = f"has no plateau at {side} ({data[1][n]:g} at {x} = {data[0][n]:g})"
        raise described_error(name, found, "that of a solid, whose long-time modulus is positive")
    limit = _NEAR_BEST * min(_size(data, spectrum) for spectrum, _ in starts)
    reached = any(_reaches_target(data, spectrum, target) for spectrum, _ in starts)

    def good(tried: Spectrum) -> bool:
        """Return whether a spectrum reaches the target or, where no grid does, is within 5 % of the best one."""
        return _reaches_target(data, tried, target) if reached else _size(data, tried) <= limit

    fewest = modes or 1
    enough = (start for start in starts if (good(start[0]) if modes is None else start[0].tau.size >= modes))
    spectrum, ends = next(enough, starts[-1])
    for _ in range(spectrum.tau.size - fewest):
        fewer = _leave_out_mode(data, spectrum, ends, good if modes is None else None)
        if fewer is None or spectrum.tau.size <= fewest:  # one step may leave out several
            break
        spectrum = fewer
    last = refined(data, spectrum, ends, _LAST_CALLS)
    spectrum = last if modes is not None or good(last) else spectrum
    return spectrum, ends, _reaches_target(data, spectrum, target)


def _fit_wider_grids(data: Data, target: float | None) -> list[tuple[Spectrum, tuple[float, float]]]:
    """Fit spectra on up to four grids of times until one reaches the target.

    The grids reach half a decade, then a whole one beyond the data on either side, each with one, then two times a
    decade; of a :class:`Relaxation` no time is below half the first one of the data.  The slow end of a grid is
    shortened by quarters of a decade, down to half a decade inside the data, until the fit has a long-time modulus; a
    grid that never has one is left out.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    target : largest misfit of each row, dimensionless; None: all grids are fitted.
    Returns a list of at most four pairs (:class:`Spectrum`, refined; (shortest, longest time of its grid, s)), in the
    order of the grids.  If a grid reaches the target it is the last; the list is empty where no grid leaves a long-time
    modulus.
    Raises RuntimeError as :func:`.spectrum.on_times` does.
    """
    starts: list[tuple[Spectrum, tuple[float, float]]] = []
    low, high = data.band
    for margin, density in product(MARGINS, DENSITIES):
        for slow in np.arange(margin, _LEAST_MARGIN - 0.1, -0.25):
            ends = max(10.0**-margin / high, data.shortest), 10.0**slow / low
            if ends[1] > ends[0] and has_plateau(data, (found := on_times(data, grid_of_times(ends, density))).E):
                starts.append((refined(data, found, ends, _CALLS), ends))
                break
        if target is not None and starts and _reaches_target(data, starts[-1][0], target):
            break
    return starts


def grid_of_times(ends: tuple[float, float], density: float) -> Floats:
    """Return times of modes between two ends, from the longest down, both ends among them.

    ends : (shortest, longest) time, s, > 0.
    density : number of times in a decade, > 0; the number of all, 1 + decades ``density``, is rounded, at least 2.
    Returns times in equal ratios, descending, s, shape (times,).
    """
    decades = math.log10(ends[1] / ends[0])
    return np.geomspace(ends[1], ends[0], max(2, 1 + round(decades * density)))


def _reaches_target(data: Data, spectrum: Spectrum, target: float) -> bool:
    """Return whether no row of the data has a misfit above the target: each is at most the target.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, the fit.
    target : largest misfit of each row, a root mean square of relative errors, dimensionless.
    """
    return max(misfits(data, spectrum)) <= target


def _size(data: Data, spectrum: Spectrum) -> float:
    """Return the root of the sum of the squared misfits of all rows, by which fits are compared.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, the fit.
    Returns a dimensionless number.
    """
    return math.hypot(*misfits(data, spectrum))


def _leave_out_mode(
    data: Data, spectrum: Spectrum, ends: tuple[float, float], good: Callable[[Spectrum], bool] | None
) -> Spectrum | None:
    """Return a spectrum with one mode less, with a mode left out or two neighbours merged, or None.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, spectrum of the data from which a mode is left out, of at least one mode, all
        strengths > 0, as of :func:`.spectrum.on_times`.
    ends : (shortest, longest) time that is allowed, s.
    good : function of a spectrum that returns whether it is acceptable; None: any is.
    Returns the candidate with the least misfit as it is, its times not refined, if it is acceptable; else the first of
    the three with the least misfits, in this order, that is acceptable after its times are refined; None if none of
    them is.  With ``good`` None it is the one with the least misfit, refined.  Misfits are compared by :func:`_size`.
    Modes without strength are left out too, so that more than one may be missing.
    Raises RuntimeError as :func:`.spectrum.on_times` does.
    """
    tried = sorted((on_times(data, tau) for tau in _times_without_a_mode(spectrum)), key=lambda fit: _size(data, fit))
    if good is not None and good(tried[0]):
        return tried[0]
    for candidate in tried[:_CANDIDATES]:
        moved = refined(data, candidate, ends, _CALLS)
        if good is None or good(moved):
            return moved
    return None


def _times_without_a_mode(spectrum: Spectrum) -> list[Floats]:
    """Return the candidates for one mode less: times with one left out, or with two neighbours replaced by their mean.

    spectrum : :class:`Spectrum`, the spectrum, of n modes, n >= 1, with strengths > 0, as those of
        :func:`.spectrum.on_times`; means are of the logarithms of its times, weighted by strength.
    Returns a list of 2 n - 1 arrays of times, s, descending, shape (n - 1,) each: first those with one left out, then
    those with a mean, both from the longest time on.
    """
    tau, strength = spectrum.tau, spectrum.strength
    without = [np.delete(tau, n) for n in range(tau.size)]
    for n in range(tau.size - 1):
        mean = np.exp(np.average(np.log(tau[n : n + 2]), weights=strength[n : n + 2]))
        without.append(np.concatenate([tau[:n], [mean], tau[n + 2 :]]))
    return without
