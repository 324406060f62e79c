"""Least squares of measured moduli by a discrete spectrum: strengths on fixed times, and times that are refined.

The residuals are the relative errors of every measured modulus (E' and E'', or E(t)), all points alike.  On fixed
times the strengths are those of non-negative least squares (as in M. Baumgaertel and H. H. Winter, Rheologica Acta
28, 511-519, 1989, doi:10.1007/BF01332922); few modes suffice once their times are free.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from ...materials.prony import Prony
from .curve import Curve, Relaxation

#: part of the curve, relative to it, below which a mode is left out: rounding of the strengths
_NOTHING = 1e-12
#: least ratio of the long-time modulus to the lowest storage or relaxation modulus: a fluid has none
FLOOR = 0.01

Data = Curve | Relaxation


class Spectrum(NamedTuple):
    """A discrete spectrum in the units of the data: long-time modulus and modes of a generalised Maxwell solid.

    E : long-time modulus, in the unit of the data.
    strength : strength of each mode, in the unit of E, shape (modes,).
    tau : time of each mode, s, descending, shape (modes,); modes may be 0.
    """

    E: float
    strength: Floats
    tau: Floats

    def modulus(self, data: Data) -> Floats:
        """Return the moduli of the spectrum at the frequencies or times of the data, in the unit of E.

        data : measured moduli, a :class:`Curve` or a :class:`Relaxation` at n points; only their frequencies or times
            are used.
        Returns shape (2, n), storage and loss, of a :class:`.curve.Curve`; (1, n) of relaxation.
        """
        return np.array(data.constant)[:, None] * self.E + data.responses(self.tau) @ self.strength


def spectrum_of(prony: Prony, E: float, T_ref: float) -> Spectrum:
    """Return the spectrum, in the units of the data, of a dimensionless series.

    prony : :class:`Prony`, strengths divided by the long-time modulus, times over T_ref.
    E : long-time modulus, in the unit of the data.
    T_ref : unit of the times of the series, s.
    Returns the :class:`Spectrum`, strengths in the unit of E and times in s, in the order of the series.
    """
    return Spectrum(E, prony.E * E, prony.tau * T_ref)


def _relative_columns(data: Data, constant: float, modes: Floats) -> Floats:
    """Return the matrix of the least squares: responses of a constant and of modes, divided by the measured moduli.

    data : measured moduli, a :class:`Curve` (rows = 2, storage and loss) or a :class:`Relaxation` (rows = 1), at n
        points.
    constant : long-time modulus whose response is the first column, in the unit of the data; 1.0 for a unit response.
    modes : responses of the modes, in the unit of the data, shape (rows, n, modes).
    Returns shape (rows n, 1 + modes), dimensionless; the column of the constant is the first.
    """
    found = np.empty((*modes.shape[:2], 1 + modes.shape[2]))
    found[..., 0], found[..., 1:] = np.multiply(constant, data.constant)[:, None], modes
    found /= np.array(data[1:])[..., None]
    return found.reshape(-1, found.shape[2])


def _residuals(data: Data, values: Floats) -> Floats:
    """Return the relative errors of all moduli, one row after the other.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`, ``rows`` of them at n points.
    values : [long-time modulus, strengths, times], the first two in the unit of the data, times in s; (1 + 2 modes,).
    Returns fitted divided by measured moduli - 1, dimensionless, shape (rows n,).
    """
    count = values.size // 2
    return _relative_columns(data, 1.0, data.responses(values[1 + count :])) @ values[: 1 + count] - 1.0


def misfits(data: Data, spectrum: Spectrum) -> tuple[float, ...]:
    """Return the misfit of each row of the data: the root mean square of its relative errors.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, the fit.
    Returns dimensionless numbers: (storage, loss) of a :class:`.curve.Curve`, (relaxation,) of relaxation.
    """
    errors = _residuals(data, np.concatenate([[spectrum.E], *spectrum[1:]])).reshape(len(data.constant), -1)
    return tuple(np.sqrt(np.mean(errors * errors, axis=1)).tolist())


class LeastSquares:
    """Least squares of the relative errors of data by non-negative strengths on fixed times.

    The unknowns are the excess of the long-time modulus over the least one that is allowed, :data:`FLOOR` of the lowest
    storage or relaxation modulus, and the strengths, each times the norm of its column: (1 + modes,), dimensionless.

    tau : times of the modes, s, (modes,), in the order given.
    floor : least long-time modulus, in the unit of the data.
    size : norm of the column of each unknown, in the inverse of that unit, (1 + modes,).
    left, right : matrix, (residuals, 1 + modes), and right-hand side, (residuals,), dimensionless.
    """

    def __init__(self, data: Data, tau: Floats) -> None:
        """Compute the matrix for ``data``, a :class:`Curve` or a :class:`Relaxation`, and times ``tau`` > 0, s."""
        columns = _relative_columns(data, 1.0, data.responses(tau))
        self.tau, self.floor = tau, _least_modulus(data)
        self.size = np.sqrt((columns * columns).sum(axis=0))
        self.left, self.right = columns / self.size, 1.0 - self.floor * columns[:, 0]

    def solve(self, row: Floats | None = None, value: float = 0.0) -> Floats:
        """Return the unknowns, (1 + modes,), with the least sum of squares, of all rows and perhaps one more.

        row, value : coefficients, (1 + modes,), and right-hand side of a further residual; None: there is none.
        Raises RuntimeError, from SciPy, where the iteration does not end in 100 (1 + modes) steps.
        """
        from scipy.optimize import nnls

        left, right = self.left, self.right
        if row is not None:
            left, right = np.vstack([left, row]), np.append(right, value)
        found: Floats = nnls(left, right, maxiter=100 * self.size.size)[0]
        return found

    def cost(self, unknowns: Floats) -> float:
        """Return the sum of the squared residuals, dimensionless, without that of a further row."""
        errors = self.left @ unknowns - self.right
        return float(errors @ errors)

    def spectrum(self, unknowns: Floats, most: int) -> Spectrum:
        """Return the :class:`Spectrum` of unknowns, (1 + modes,): of its modes those with a strength, times descending.

        most : largest number of modes; the weakest ones beyond are left out.
        """
        order = np.argsort(-self.tau, kind="stable")
        part = unknowns[1:][order]
        order = order[
            (part > _NOTHING * np.sqrt(self.tau.size)) & (part >= np.sort(part)[::-1][:most].min(initial=np.inf))
        ]
        found = unknowns / self.size
        return Spectrum(self.floor + float(found[0]), found[1:][order], self.tau[order])


def on_times(data: Data, tau: Floats) -> Spectrum:
    """Solve the least squares with non-negative strengths on fixed times; modes without strength are left out.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    tau : times of modes, s, > 0, in any order, shape (modes,), which may be empty.
    Returns the :class:`Spectrum`, its times descending, all strengths > 0; its long-time modulus is at least
    :data:`FLOOR`, 1 %, of the lowest storage or relaxation modulus, and its number of modes may be smaller than that of
    ``tau``, down to 0.
    Raises RuntimeError, from SciPy, where the non-negative least squares do not end in 100 (1 + modes) iterations.
    """
    problem = LeastSquares(data, tau)
    return problem.spectrum(problem.solve(), tau.size)


def has_plateau(data: Data, E: float) -> bool:
    """Return whether the data determine the long-time modulus of a fit, which is then above the least that is allowed.

    The least is 1 % of the lowest storage or relaxation modulus; above it means by more than 1e-4 of it.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    E : long-time modulus of a fit of the data, in their unit, as of :func:`on_times`.
    """
    return E > 1.0001 * _least_modulus(data)


def refined(data: Data, spectrum: Spectrum, ends: tuple[float, float], calls: int) -> Spectrum:
    """Refine a spectrum by varying its times too, then fit the strengths on the times found.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, spectrum from which the search starts, with all strengths and its E > 0.
    ends : (shortest, longest) time that is allowed, s; times outside are moved to the ends.
    calls : largest number of evaluations of the residuals, >= 1; when they are used up the best times so far are taken.
    Returns the refined :class:`Spectrum`, from which modes without strength are left out; ``spectrum`` itself if it has
    no modes.
    Raises RuntimeError as :func:`on_times` does.
    """
    count = spectrum.tau.size
    if not count:
        return spectrum
    start = np.log(np.concatenate([[spectrum.E], spectrum.strength, spectrum.tau]))
    low, high = start - _RANGE, start + _RANGE
    low[0], high[0] = np.log(_least_modulus(data)), np.inf
    low[1 + count :], high[1 + count :] = np.log(ends)
    return on_times(data, np.exp(_minimize(data, start, low, high, calls)[1 + count :]))


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

    The method solves the normal equations: an SVD of some hundred rows takes ten times as long on several threads as
    on one, and the MINPACK of SciPy 1.17 gives other last digits from call to call.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    logs : start, logarithms of [long-time modulus, strengths, times], in the unit of the data and s; (1 + 2 modes,).
    low, high : bounds of the logarithms, of the same shape, perhaps infinite; a start outside is moved to the bound.
    calls : largest number of evaluations of the residuals, >= 1; with 1 the start is returned.
    The iteration ends where the relative change of the sum in a step is at most 1e-14, and where each logarithm is at a
    bound beyond which the sum would decrease.
    Returns the logarithms at the minimum, or the best ones found when the calls are used up, (1 + 2 modes,), within the
    bounds.
    """
    logs = np.clip(logs, low, high)
    errors, slopes = _residuals(data, np.exp(logs)), _slopes(logs, data)
    damping = _DAMPING
    for _ in range(calls - 1):
        downhill = -(slopes.T @ errors)
        free = ~((logs <= low) & (downhill < 0.0) | (logs >= high) & (downhill > 0.0))
        if not free.any():
            break
        normal = _normal_matrix(slopes[:, free])
        np.fill_diagonal(normal, (1.0 + damping) * normal.diagonal() + np.finfo(float).tiny)
        step = np.zeros_like(logs)
        step[free] = np.linalg.solve(normal, downhill[free])
        step = np.clip(logs + step, low, high) - logs
        found = _residuals(data, np.exp(logs + step))
        before, gain = errors @ errors, errors @ errors - found @ found
        if gain > 0.0:
            damping, logs = max(damping / 3.0, _LEAST_DAMPING), logs + step
            errors, slopes = found, _slopes(logs, data)
        else:
            damping *= 4.0
        if abs(gain) <= _CONVERGED * before:
            break
    return logs


def _normal_matrix(slopes: Floats) -> Floats:
    """Return slopes.T @ slopes, in products that are too small for BLAS to share among threads.

    It keeps BLAS from starting threads, which would take longer than the product.

    slopes : derivatives of the residuals, dimensionless, shape (residuals, unknowns); at least one unknown.
    Returns the product, dimensionless, shape (unknowns, unknowns), a new array.
    """
    rows = max(1, _ONE_THREAD // slopes.shape[1] ** 2)
    parts = (slopes[n : n + rows] for n in range(0, slopes.shape[0], rows))
    return sum((part.T @ part for part in parts), np.zeros(2 * (slopes.shape[1],)))


def _slopes(logs: Floats, data: Data) -> Floats:
    """Return the derivatives of the residuals by the logarithms of long-time modulus, strengths and times.

    logs : logarithms of [long-time modulus, strengths, times], in the unit of the data and s; (1 + 2 modes,).
    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`, ``rows`` of them at n points.
    Returns shape (rows n, 1 + 2 modes), dimensionless, in the order of :func:`_residuals` and of ``logs``.
    """
    values, count = np.exp(logs), logs.size // 2
    strength, tau = values[1 : 1 + count], values[1 + count :]
    responses = data.responses(tau)
    by_times = data.slopes(tau, responses) * strength
    return _relative_columns(data, values[0], np.concatenate([responses * strength, by_times], axis=2))


def _least_modulus(data: Data) -> float:
    """Return the least long-time modulus that is allowed, in the unit of the data.

    It is :data:`FLOOR` of the lowest storage or relaxation modulus of the ``data``.
    """
    return FLOOR * float(data[1].min())
