"""Discrete spectra of measured moduli: least squares, number of modes, accuracy.

**Least squares**: strengths on fixed times, and times that are refined.  The residuals are the
relative errors of every measured modulus (E' and E'', or E(t)), all points alike.  On fixed times
the strengths are those of non-negative least squares (as in M. Baumgaertel and H. H. Winter,
Rheologica Acta 28, 511-519, 1989, doi:10.1007/BF01332922); few modes suffice once their times are
free.

**Fewest modes for a misfit** (:func:`fewest_modes`): from a grid of times that reaches the misfit
modes are left out or merged one by one.  A row of the data is one measured modulus: a
:class:`.dynamic_moduli.Curve` has two, storage and loss, a :class:`.dynamic_moduli.Relaxation`
one.  The misfit of a row is the root mean square of its relative errors, dimensionless.

**Accuracy of a fit** (:func:`admissible_spectra`): data over a limited band do not determine a
spectrum.  For each speed the non-negative spectra are sought by which M is smallest and largest,
among those that meet the data as well as the fit does; the true spectrum is one of them, but for
noise.  How far M is off for rubbers that are known is measured by
``pipeline/evidence/measure/fits.py``.

Speeds, moments and kappa are those of a :class:`viscoroll.Scene`: V in units of R/T_ref, M divided
by P R.
"""

import itertools
import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..contact_mechanics import contact, transit_speeds
from ..core import Floats, described_error
from ..materials import LARGEST_TIME_RATIO, MOST_MODES, Measured, Prony
from ..rollers import Scene
from .dynamic_moduli import UNITS, Data, Spectrum, misfits, relative_columns, residuals

# --- Least squares of measured moduli by a discrete spectrum ---

#: part of the curve, relative to it, below which a mode is left out: rounding of the strengths
_NOTHING = 1e-12
#: least ratio of the long-time modulus to the lowest storage or relaxation modulus: a fluid has
#: none
FLOOR = 0.01
#: shortest and longest time that modes may have, s
Ends: TypeAlias = tuple[float, float]


class LeastSquares:
    """Least squares of the relative errors of data by non-negative strengths on fixed times.

    The unknowns are the excess of the long-time modulus over the least one that is allowed,
    :data:`FLOOR` of the lowest storage or relaxation modulus, and the strengths, each times the
    norm of its column: (1 + modes,), dimensionless.

    tau : times of the modes, s, (modes,).
    floor : least long-time modulus, in the unit of the data.
    size : norm of the column of each unknown, in the inverse of that unit, (1 + modes,).
    left, right : matrix, (residuals, 1 + modes), and right-hand side, (residuals,), dimensionless.
    """

    def __init__(self, data: Data, tau: Floats) -> None:
        """Compute the matrix of the least squares.

        data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
        tau : times of the modes, s, > 0, (modes,).
        """
        columns = relative_columns(data, 1.0, data.responses(tau))
        self.tau = tau
        self.floor = _least_modulus(data)
        self.size = np.linalg.norm(columns, axis=0)
        self.left = columns / self.size
        # relative moduli are to be 1; the least long-time modulus gives a part of each already
        self.right = 1.0 - self.floor * columns[:, 0]

    def solve(self, *row: Floats, value: Any = ()) -> Floats:
        """Return the unknowns, (1 + modes,), with the least sum of squares, of all rows and perhaps
        one more.

        row, value : coefficients, (1 + modes,), and right-hand side of a further residual, if any.
        Raises RuntimeError, from SciPy, where the iteration does not end in 100 (1 + modes) steps.
        """
        from scipy import optimize

        left = np.vstack([self.left, *row])
        return optimize.nnls(left, np.append(self.right, value), maxiter=100 * self.size.size)[0]

    def cost(self, unknowns: Floats) -> float:
        """Return the sum of the squared residuals, dimensionless, without that of a further row."""
        errors = self.left @ unknowns - self.right
        return float(errors @ errors)

    def spectrum(self, unknowns: Floats) -> Spectrum:
        """Return the :class:`Spectrum` of unknowns, (1 + modes,): of its modes those with a
        strength, times descending; the weakest ones beyond :data:`MOST_MODES` are left out.
        """
        # an unknown is the norm of the relative moduli that a mode gives: by it modes are weak
        order = np.argsort(-self.tau, kind="stable")
        part = unknowns[1:][order]
        order = order[
            (part > _NOTHING * np.sqrt(self.tau.size))
            & (part >= np.sort(part)[-MOST_MODES:].min(initial=np.inf))
        ]
        found = unknowns / self.size
        return Spectrum(self.floor + float(found[0]), found[1:][order], self.tau[order])


def on_times(data: Data, tau: Floats) -> Spectrum:
    """Solve the least squares with non-negative strengths on fixed times; modes without strength
    are left out.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    tau : times of modes, s, > 0, in any order, shape (modes,), which may be empty.
    Returns the :class:`Spectrum`, its times descending, all strengths > 0, with as many modes as
    ``tau`` or fewer, down to 0; its long-time modulus is at least :data:`FLOOR`, 1 %, of the lowest
    storage or relaxation modulus.
    Raises RuntimeError as :meth:`LeastSquares.solve`.
    """
    problem = LeastSquares(data, tau)
    return problem.spectrum(problem.solve())


def has_plateau(data: Data, E: float) -> bool:
    """Return whether the data determine the long-time modulus of a fit, which is then above the
    least that is allowed, 1 % of the lowest storage or relaxation modulus, by more than 1e-4 of it.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    E : long-time modulus of a fit of the data, in their unit, as in :func:`on_times`.
    """
    return E > 1.0001 * _least_modulus(data)


def refined(data: Data, spectrum: Spectrum, ends: Ends, calls: int) -> Spectrum:
    """Refine a spectrum by varying its times too, then fit the strengths on the times found.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum` from which the search starts, with all strengths and its E > 0.
    ends : (shortest, longest) time that is allowed, s; times outside are moved to the ends.
    calls : largest number of evaluations of the residuals, >= 1, after which the best times so far
        are taken.
    Returns the refined :class:`Spectrum`, from which modes without strength are left out;
    ``spectrum`` itself if it has no modes.
    Raises RuntimeError as :func:`on_times` does.
    """
    count = spectrum.tau.size
    if not count:
        return spectrum
    # unknowns: logarithms of E, of count strengths, of count times
    start = np.log(np.hstack(spectrum))
    low = start - _RANGE
    high = start + _RANGE
    low[0] = np.log(_least_modulus(data))
    high[0] = np.inf
    low[-count:], high[-count:] = np.log(ends)
    # only the times are kept: strengths on given times have one best fit, which may leave modes out
    found = _minimize(data, start, low, high, calls)
    return on_times(data, np.exp(found[-count:]))


#: range of the logarithm of a strength about its start
_RANGE = 20.0
#: relative decrease of the sum of squares at which the iteration stops
_CONVERGED = 1e-14
#: damping of the first step, in units of the diagonal of the normal equations
_DAMPING = 1e-3
#: least damping, in the same unit
_LEAST_DAMPING = 1e-12
#: number of multiplications of a product of matrices up to which BLAS takes one thread
_ONE_THREAD = 1 << 17


def _minimize(data: Data, logs: Floats, low: Floats, high: Floats, calls: int) -> Floats:
    """Minimise the sum of squared residuals within bounds by the method of Levenberg and Marquardt.

    The method solves the normal equations: an SVD of some hundred rows takes ten times as long on
    several threads as on one, and the MINPACK of SciPy 1.17 gives other last digits from call to
    call.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    logs : start, logarithms of [long-time modulus, strengths, times], in the unit of the data and
        s; (1 + 2 modes,).
    low, high : their bounds, perhaps infinite; a start outside is moved to the bound.
    calls : largest number of evaluations of the residuals, >= 1; with 1 the start is returned.
    The iteration ends where the relative change of the sum in a step is at most 1e-14, and where
    each logarithm is at a bound beyond which the sum would decrease.
    Returns the logarithms at the minimum, or the best ones found when the calls are used up, (1 + 2
    modes,), within the bounds.
    """
    logs = np.clip(logs, low, high)
    errors = residuals(data, np.exp(logs))
    slopes = _slopes(logs, data)
    damping = _DAMPING
    for _ in range(calls - 1):
        downhill = -(slopes.T @ errors)
        # not those at a bound that the step would cross
        free = ~((logs <= low) & (downhill < 0.0) | (logs >= high) & (downhill > 0.0))
        if not free.any():
            break
        normal = _normal_matrix(slopes[:, free])
        # tiny: the diagonal of a mode that has no effect is 0, and the matrix would be singular
        np.fill_diagonal(normal, (1.0 + damping) * normal.diagonal() + np.finfo(float).tiny)
        step = np.zeros_like(logs)
        step[free] = np.linalg.solve(normal, downhill[free])
        step = np.clip(logs + step, low, high) - logs
        found = residuals(data, np.exp(logs + step))
        before = errors @ errors
        gain = before - found @ found
        if gain > 0.0:
            damping = max(damping / 3.0, _LEAST_DAMPING)
            logs += step
            errors = found
            slopes = _slopes(logs, data)
        else:
            damping *= 4.0
        if abs(gain) <= _CONVERGED * before:
            break
    return logs


def _normal_matrix(slopes: Floats) -> Floats:
    """Return slopes.T @ slopes, in products that are too small for BLAS to share among threads,
    whose start would take longer.

    slopes : derivatives of the residuals, dimensionless, shape (residuals, unknowns >= 1).
    Returns the product, dimensionless, shape (unknowns, unknowns), a new array.
    """
    rows = max(1, _ONE_THREAD // slopes.shape[1] ** 2)
    parts = (slopes[n : n + rows] for n in range(0, slopes.shape[0], rows))
    return sum((part.T @ part for part in parts), np.zeros(()))


def _slopes(logs: Floats, data: Data) -> Floats:
    """Return the derivatives of the residuals by the logarithms of long-time modulus, strengths and
    times.

    logs : logarithms of [long-time modulus, strengths, times], in the unit of the data and s; (1 +
    2 modes,).
    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`, ``rows`` of them at n points.
    Returns shape (rows n, 1 + 2 modes), dimensionless, in the order of :func:`.residuals` and of
    ``logs``.
    """
    values = np.exp(logs)
    strength, tau = np.split(values[1:], 2)
    responses = data.responses(tau)
    by_times = data.slopes(tau, responses) * strength
    modes = np.concatenate([responses * strength, by_times], axis=2)
    return relative_columns(data, values[0], modes)


def _least_modulus(data: Data) -> float:
    """Return the least long-time modulus allowed: :data:`FLOOR` of the lowest one of the data."""
    return FLOOR * float(data[1].min())


# --- Fewest modes for a misfit ---

#: decades that the grid of times reaches beyond the data, in the order in which they are tried
MARGINS = (0.5, 1.0)
#: modes a decade of the grid, in the order in which they are tried
DENSITIES = (1.0, 2.0)
#: margin of the slow end in decades, down to which it goes by quarters while no long-time modulus
#: is left
_LEAST_MARGIN = -0.5
#: ratio of a misfit to the best one up to which it counts as the best
_NEAR_BEST = 1.05
#: calls of the residuals of each refinement while modes are left out
_CALLS = 40
#: calls of the residuals of the last refinement
_LAST_CALLS = 400
#: number of spectra with one mode less that are refined
_CANDIDATES = 3


def fewest_modes(data: Data, target: float, modes: int | None) -> tuple[Spectrum, Ends, bool]:
    """Find a spectrum of few modes that reaches a misfit, or comes within 5 % of the best one where
    none reaches it.

    Spectra on grids of times are the starts.  From the first that is good enough modes are left out
    one by one, as long as the spectrum stays good enough, and times are refined.  Where no grid
    reaches the target, good enough is a root of the sum of the squared misfits within 5 % of the
    least among the grids.

    data : measured moduli, a :class:`.dynamic_moduli.Curve` or :class:`.dynamic_moduli.Relaxation`.
    target : largest misfit of each row, a root mean square of relative errors, dimensionless, > 0.
    modes : number of modes to fit, an int >= 1; the target then decides the returned flag alone.
        The spectrum has fewer where no grid has as many modes with a strength > 0, or where one is
        lost as another is left out.  None: as few as the target needs.
    Returns (the :class:`Spectrum`, times descending, which may have no mode; (shortest, longest
    time) of its grid, s, within which its times lie; whether every row has a misfit <= target).
    Raises ParameterError if no grid of times leaves a long-time modulus, as of a fluid, and
    RuntimeError as :func:`on_times`.
    """
    starts = _fit_wider_grids(data, None if modes else target)
    if not starts:
        x, name, *_ = data._fields
        side, n = ("long times", -1) if x == "t" else ("low frequencies", 0)
        raise described_error(
            name,
            f"has no plateau at {side} ({data[1][n]:g} at {x} = {data[0][n]:g} {UNITS[x]})",
            "the modulus of a solid, which tends to a constant > 0; add or correct data there",
        )
    limit = _NEAR_BEST * min(_size(data, spectrum) for spectrum, _ in starts)
    reached = any(_reaches_target(data, spectrum, target) for spectrum, _ in starts)

    def good(tried: Spectrum) -> bool:
        """Return whether a spectrum has the number of modes or, without that number, reaches the
        target or, where no grid does, is within 5 % of the best one.
        """
        if modes is not None:
            return tried.tau.size >= modes
        return _reaches_target(data, tried, target) if reached else _size(data, tried) <= limit

    spectrum, ends = next((start for start in starts if good(start[0])), starts[-1])
    while spectrum.tau.size > (modes or 1):
        fewer = _leave_out_mode(data, spectrum, ends, good if modes is None else None)
        if fewer is None:
            break
        spectrum = fewer
    last = refined(data, spectrum, ends, _LAST_CALLS)
    spectrum = last if modes is not None or good(last) else spectrum
    return spectrum, ends, _reaches_target(data, spectrum, target)


def _fit_wider_grids(data: Data, target: float | None) -> list[tuple[Spectrum, Ends]]:
    """Fit spectra on up to four grids of times until one reaches the target.

    The grids reach half a decade, then a whole one beyond the data on either side, each with one,
    then two times a decade; of a :class:`Relaxation` no time is below half the first one of the
    data.  The slow end of a grid is shortened by quarters of a decade, down to half a decade inside
    the data, until the fit has a long-time modulus; a grid that never has one is left out.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    target : largest misfit of each row, dimensionless; None: all grids are fitted.
    Returns a list of at most four pairs (:class:`Spectrum`, refined; (shortest, longest time of its
    grid, s)), in the order of the grids.  If a grid reaches the target it is the last; the list is
    empty where no grid leaves a long-time modulus.
    Raises RuntimeError as :func:`on_times` does.
    """
    starts = []
    low, high = data.band
    for margin, density in itertools.product(MARGINS, DENSITIES):
        # - 0.1: the least margin is the last one tried
        for slow in np.arange(margin, _LEAST_MARGIN - 0.1, -0.25):
            ends = max(10.0**-margin / high, data.shortest), 10.0**slow / low
            if ends[1] > ends[0] and has_plateau(
                data, (found := on_times(data, grid_of_times(ends, density))).E
            ):
                starts.append((refined(data, found, ends, _CALLS), ends))
                break
        if target is not None and starts and _reaches_target(data, starts[-1][0], target):
            break
    return starts


def grid_of_times(ends: Ends, density: float) -> Floats:
    """Return times of modes between two ends, from the longest down, both ends among them.

    ends : (shortest, longest) time, s, > 0.
    density : number of times in a decade, > 0; of all they are 1 + decades ``density``, rounded.
    Returns times in equal ratios, descending, s, shape (times,).
    """
    fast, slow = ends
    decades = math.log10(slow / fast)
    return np.geomspace(slow, fast, max(2, 1 + round(decades * density)))


def _reaches_target(data: Data, spectrum: Spectrum, target: float) -> bool:
    """Return whether no row of the ``data`` has a misfit above the ``target``, dimensionless."""
    return max(misfits(data, spectrum)) <= target


def _size(data: Data, spectrum: Spectrum) -> float:
    """Return the root of the sum of the squared misfits of all rows, by which fits are compared."""
    return math.hypot(*misfits(data, spectrum))


def _leave_out_mode(
    data: Data, spectrum: Spectrum, ends: Ends, good: Callable[[Spectrum], bool] | None
) -> Spectrum | None:
    """Return a spectrum with one mode less, with a mode left out or two neighbours merged, or None.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum` of the data, of at least one mode, all strengths > 0.
    ends : (shortest, longest) time that is allowed, s.
    good : function of a spectrum that returns whether it is acceptable; None: any is.
    Returns the candidate with the least misfit as it is, its times not refined, if it is
    acceptable; else the first of the three with the least misfits, in this order, that is
    acceptable after its times are refined; None if none of them is.  With ``good`` None it is the
    one with the least misfit, refined.  Misfits are compared by :func:`_size`.  Modes without
    strength are left out too, so that more than one may be missing.
    Raises RuntimeError as :func:`on_times` does.
    """
    tried = sorted(
        (on_times(data, tau) for tau in _times_without_a_mode(spectrum)),
        key=lambda fit: _size(data, fit),
    )
    if good is not None and good(tried[0]):
        return tried[0]
    for candidate in tried[:_CANDIDATES]:
        moved = refined(data, candidate, ends, _CALLS)
        if good is None or good(moved):
            return moved
    return None


def _times_without_a_mode(spectrum: Spectrum) -> list[Floats]:
    """Return the candidates for one mode less: times with one left out, or with two neighbours
    replaced by their mean.

    spectrum : :class:`Spectrum` of n modes, n >= 1, with strengths > 0, by which the means of the
        logarithms of its times are weighted.
    Returns a list of 2 n - 1 arrays of times, s, descending, shape (n - 1,) each: first those with
    one left out, then those with a mean, both from the longest time on.
    """
    _, strength, tau = spectrum
    without = [np.delete(tau, n) for n in range(tau.size)]
    for n in range(tau.size - 1):
        merged = without[n].copy()
        merged[n] = np.exp(np.average(np.log(tau[n : n + 2]), weights=strength[n : n + 2]))
        without.append(merged)
    return without


# --- Accuracy of a fit ---

#: factor beyond the data on either side up to which times are allowed: slower and faster modes act
#: as a constant and as a dashpot there
_REACH = 100.0
#: times a decade: on three a spectrum of any modes meets exact data to 0.1 %
_TIMES = 3.0
#: speeds a decade
_SPEEDS = 2
#: rise of the sum of squares, in variances of a residual, within which spectra count as equally
#: good: two standard deviations
_RISE = 4.0
#: halvings of the weight of the pull on M
_HALVINGS = 9
#: decades of the weight, about the fourth root of the sum of squares that is allowed
_WEIGHTS = -3.0, 3.0
#: half the contact length times the wavenumber, at which the loss of a contact is summed: beyond
#: lie 3 % of it
_WAVES = np.geomspace(0.02, 12.0, 80)


class AdmissibleSpectra(NamedTuple):
    """Spectra that meet the data of a fit as well as the fit: those with the smallest and the
    largest M at each speed.

    rate : transit frequencies of the contact, 1/s, (n,): those of the speeds, from the first to the
        last within :attr:`viscoroll.Measured.transit_band` of the data; n is 0 where that is empty,
        or where nothing relaxes.
    V, M : kappa V, V in R/T_ref, and kappa M of the fit at these speeds, both with the kappa of the
        fit, dimensionless, (n,).
    M_changes : M by each spectrum divided by M of the fit, at the same load, minus 1, (2 n, n).
    E : long-time modulus of each spectrum, in the unit of the data, (2 n,).
    alpha : instantaneous modulus of each spectrum divided by its long-time modulus, (2 n,).
    """

    rate: Floats
    V: Floats
    M: Floats
    M_changes: Floats
    E: Floats
    alpha: Floats

    @property
    def error(self) -> Floats:
        """Largest relative change of M at each speed, (n,), dimensionless: its accuracy as +-."""
        return np.abs(self.M_changes).max(axis=0, initial=0.0)


def admissible_spectra(data: Data, fit: Spectrum) -> AdmissibleSpectra:
    """Find the spectra with the smallest and the largest rolling moment at each of some speeds.

    A spectrum is admissible if its times are within two decades of the data (of a
    :class:`.dynamic_moduli.Relaxation` not below half the first time), its strengths are not
    negative, and the sum of the squared relative errors is at most that of the fit, or four
    variances of a residual above the least one, if that is more.

    data : measured moduli, a :class:`.dynamic_moduli.Curve` or :class:`.dynamic_moduli.Relaxation`.
    fit : :class:`Spectrum`, the fit, whose times are allowed too.
    Returns the :class:`AdmissibleSpectra`.
    Raises RuntimeError as :func:`on_times` does.
    """
    low, high = data.band
    slow, fast = Measured(*data.band, 0.0).transit_band
    n = 2 + int(_SPEEDS * math.log10(fast / slow)) if fit.tau.size and slow < fast else 0
    rate = np.geomspace(slow, fast, n)
    T_ref = float(fit.tau.max(initial=0.0)) or 1.0  # 1 without modes
    prony = Prony(fit.strength / fit.E, fit.tau / T_ref)
    V = transit_speeds(prony, rate * T_ref)
    M = _moments(prony, 1.0, V)
    # shorter where the times would span more than a series may
    reach = min(_REACH, math.sqrt(LARGEST_TIME_RATIO * low / high))
    times = grid_of_times((max(1.0 / (high * reach), data.shortest), reach / low), _TIMES)
    problem = LeastSquares(data, np.concatenate([times, fit.tau]))
    best = problem.solve()
    freedom = max(1, problem.right.size - int(np.count_nonzero(best)))
    # the sum of squares of the fit, from the mean squares of its rows
    own = data[0].size * sum(misfit * misfit for misfit in misfits(data, fit))
    allowed = max(own, problem.cost(best) * (1.0 + _RISE / freedom))
    found = []
    for at in rate.tolist():
        pull = _slopes_of_moment(problem, best, at)
        for sign in (-1.0, 1.0):
            pulled = _pulled(problem, best, sign * pull, allowed)
            E, strength, tau = problem.spectrum(pulled)
            series = Prony(strength / E, tau / T_ref)
            # at the same load kappa = R/l0 is proportional to the root of the long-time modulus
            change = _moments(series, math.sqrt(E / fit.E), V) / M - 1.0
            found.append([E, series.alpha, *change])
    spectra = np.reshape(found, (2 * n, 2 + n))
    return AdmissibleSpectra(
        rate=rate, V=V, M=M, M_changes=spectra[:, 2:], E=spectra[:, 0], alpha=spectra[:, 1]
    )


def _slopes_of_moment(problem: LeastSquares, best: Floats, rate: float) -> Floats:
    """Return the derivatives of ln M by the unknowns, of a contact with the pressure of Hertz.

    Its loss is the integral of the loss compliance at omega = 2 rate u, times (J_1(u)/u)^2 du,
    since the transform of the pressure is proportional to J_1(u)/u at the wavenumber u over half
    the contact length.

    problem : :class:`LeastSquares`, n unknowns.
    best : values of the unknowns at which the derivatives are taken, (n,).
    rate : transit frequency, 1/s.
    Returns them in the inverse of the unit of the unknowns, (n,).
    """
    from scipy import special

    z = 2.0j * rate * _WAVES[:, None] * problem.tau
    parts = np.concatenate([np.ones((_WAVES.size, 1)), z / (1.0 + z)], axis=1) / problem.size
    modulus = problem.floor + parts @ best
    weight = special.j1(_WAVES) ** 2 / _WAVES  # in equal steps of ln u
    # M is proportional to the sum of -Im(1/modulus), of which an unknown changes Im(part/modulus^2)
    return weight @ (parts / modulus[:, None] ** 2).imag / -(weight @ (1.0 / modulus).imag)


def _pulled(problem: LeastSquares, best: Floats, pull: Floats, allowed: float) -> Floats:
    """Return the unknowns at which a linear form is largest among those whose sum of squares is
    allowed.

    A further residual, the form less its value at ``best`` less 1, pulls the form.  The
    largest weight of that residual with which the sum of squares is still allowed is found by
    halving the interval of its logarithm.

    problem : :class:`LeastSquares`, n unknowns.
    best : values of the unknowns with the least sum of squares, (n,).
    pull : coefficients of the form, (n,).
    allowed : largest sum of squares, dimensionless.
    """
    low, high = _WEIGHTS
    found = best
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        # counted in fourth roots of the sum, so that one range of the logarithm serves all data
        weight = 10.0**middle * allowed**0.25
        tried = problem.solve(weight * pull, value=weight * (pull @ best + 1.0))
        if problem.cost(tried) <= allowed:
            low = middle
            found = tried
        else:
            high = middle
    return found


def _moments(prony: Prony, kappa: float, V: Floats) -> Any:
    """Compute the rolling moment in free rolling, delta = 0, at mu = 1.

    prony : :class:`Prony`, series of cylinder and half-space.
    kappa : slenderness R/l0, > 0, dimensionless: 1, or relative to that of another fit.
    V : speeds in units of R/T_ref, dimensionless, (n,); n may be 0.
    Returns M divided by P R, (n,).
    """
    return contact(Scene(material=prony, kappa=kappa, mu=1.0), V, delta=0.0, fields="M").M
