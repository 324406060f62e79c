"""Least squares of measured moduli by a discrete spectrum: strengths on given times, and times that move.

The residuals are the relative errors of every measured modulus (E' and E'', or E(t)), all points alike.  On given times
the strengths are those of non-negative least squares (as in M. Baumgaertel and H. H. Winter, Rheologica Acta 28,
511-519, 1989, doi:10.1007/BF01332922, few modes do once their times are free to move).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from .curve import Curve, Relaxation

#: modes whose part of the curve is smaller, relative to it, are left out
_NOTHING = 1e-12
#: the long-time modulus is at least this share of the lowest storage or relaxation modulus
FLOOR = 0.01

Data = Curve | Relaxation


class Spectrum(NamedTuple):
    """Long-time modulus, strengths and times of the modes, times descending; units of the curve."""

    E: float
    strength: Floats
    tau: Floats

    def modulus(self, data: Data) -> Floats:
        """The moduli at the places of the data, shape of ``data.values``."""
        return np.array(data.constant)[:, None] * self.E + data.responses(self.tau) @ self.strength


def _relative(data: Data, constant: float, modes: Floats) -> Floats:
    """Columns of a constant and of modes over the data: shape (rows n, 1 + modes).

    modes : what they add to each row, shape (rows, n, modes).
    """
    found = np.empty((*modes.shape[:2], 1 + modes.shape[2]))
    found[..., 0], found[..., 1:] = np.multiply(constant, data.constant)[:, None], modes
    found /= data.values[..., None]
    return found.reshape(-1, found.shape[2])


def _residuals(data: Data, values: Floats) -> Floats:
    """Relative errors, row behind row, by long-time modulus, strengths and times."""
    count = values.size // 2
    return _relative(data, 1.0, data.responses(values[1 + count :])) @ values[: 1 + count] - 1.0


def misfits(data: Data, spectrum: Spectrum) -> tuple[float, ...]:
    """Root mean square of the relative error of each row."""
    errors = _residuals(data, np.concatenate([[spectrum.E], *spectrum[1:]])).reshape(len(data.constant), -1)
    return tuple(np.sqrt(np.mean(errors * errors, axis=1)).tolist())


def on_times(data: Data, tau: Floats) -> Spectrum:
    """The least squares with non-negative strengths on given times; modes without strength are left out."""
    from scipy.optimize import nnls

    columns, floor = _relative(data, 1.0, data.responses(tau)), _floor(data)
    size = np.sqrt((columns * columns).sum(axis=0))
    found, _ = nnls(columns / size, 1.0 - floor * columns[:, 0], maxiter=100 * size.size)
    order = np.argsort(-tau, kind="stable")
    order = order[found[1:][order] > _NOTHING * np.sqrt(tau.size)]
    found = found / size
    return Spectrum(floor + float(found[0]), found[1:][order], tau[order])


def has_plateau(data: Data, spectrum: Spectrum) -> bool:
    """Whether the curve asks for a long-time modulus by itself."""
    return spectrum.E > 1.0001 * _floor(data)


def polished(data: Data, spectrum: Spectrum, ends: tuple[float, float], calls: int) -> Spectrum:
    """The spectrum with its times moved too, between ``ends``, in at most so many calls of the residuals."""
    count = spectrum.tau.size
    if not count:
        return spectrum
    start = np.log(np.concatenate([[spectrum.E], spectrum.strength, spectrum.tau]))
    low, high = start - _RANGE, start + _RANGE
    low[0], high[0] = np.log(_floor(data)), np.inf
    low[1 + count :], high[1 + count :] = np.log(ends)
    return on_times(data, np.exp(_descended(data, start, low, high, calls)[1 + count :]))


#: a strength may change by a factor of exp(_RANGE); and where the iteration stops
_RANGE, _STILL = 20.0, 1e-14
#: damping at first, and at least, over the diagonal of the normal equations
_DAMPING, _LEAST_DAMPING = 1e-3, 1e-12
#: multiplications of a product of matrices that BLAS does on one thread
_ALONE = 1 << 17


def _descended(data: Data, logs: Floats, low: Floats, high: Floats, calls: int) -> Floats:
    """Levenberg's and Marquardt's iteration between bounds.

    On the normal equations: a SVD of some hundred rows takes ten times as long on several threads as on one, and the
    MINPACK of SciPy 1.17 gives other last digits from call to call.
    """
    logs = np.clip(logs, low, high)
    errors, slopes = _residuals(data, np.exp(logs)), _slopes(logs, data)
    damping = _DAMPING
    for _ in range(calls - 1):
        downhill = -(slopes.T @ errors)
        free = ~((logs <= low) & (downhill < 0.0) | (logs >= high) & (downhill > 0.0))
        normal = _squared(slopes[:, free])
        np.fill_diagonal(normal, (1.0 + damping) * normal.diagonal() + np.finfo(float).tiny)
        way = np.zeros_like(logs)
        way[free] = np.linalg.solve(normal, downhill[free])
        way = np.clip(logs + way, low, high) - logs
        found = _residuals(data, np.exp(logs + way))
        before, gain = errors @ errors, errors @ errors - found @ found
        if gain > 0.0:
            damping, logs = max(damping / 3.0, _LEAST_DAMPING), logs + way
            errors, slopes = found, _slopes(logs, data)
        else:
            damping *= 4.0
        if abs(gain) <= _STILL * before:
            break
    return logs


def _squared(slopes: Floats) -> Floats:
    """slopes.T @ slopes, in products too small for BLAS to share among threads."""
    rows = max(1, _ALONE // slopes.shape[1] ** 2)
    parts = (slopes[n : n + rows] for n in range(0, slopes.shape[0], rows))
    return sum((part.T @ part for part in parts), np.zeros(2 * (slopes.shape[1],)))


def _slopes(logs: Floats, data: Data) -> Floats:
    """Of the residuals over the logarithms of long-time modulus, strengths and times."""
    values, count = np.exp(logs), logs.size // 2
    strength, tau = values[1 : 1 + count], values[1 + count :]
    responses = data.responses(tau)
    by_times = data.slopes(tau, responses) * strength
    return _relative(data, values[0], np.concatenate([responses * strength, by_times], axis=2))


def _floor(data: Data) -> float:
    """The least long-time modulus that is allowed: a share of the lowest modulus of the row that it adds to."""
    return FLOOR * float(data.values[0].min())
