"""Least squares of a master curve by a discrete spectrum: strengths on given times, and times that move.

The residuals are the relative errors of E' and of E'', all points alike.  On given times the strengths are those of
non-negative least squares (as in M. Baumgaertel and H. H. Winter, Rheologica Acta 28, 511-519, 1989,
doi:10.1007/BF01332922, few modes do once their times are free to move).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...core.typed import Floats
from .curve import Curve

#: modes whose part of the curve is smaller, relative to it, are left out
_NOTHING = 1e-12
#: the long-time modulus is at least this share of the lowest storage modulus
FLOOR = 0.01


class Spectrum(NamedTuple):
    """Long-time modulus, strengths and times of the modes, times descending; units of the curve."""

    E: float
    strength: Floats
    tau: Floats

    def modulus(self, omega: Floats) -> tuple[Floats, Floats]:
        """Storage and loss modulus."""
        storage, loss = responses(omega, self.tau)
        return self.E + storage @ self.strength, loss @ self.strength


def responses(omega: Floats, tau: Floats) -> tuple[Floats, Floats]:
    """Storage and loss modulus of modes of strength 1, a column each: z^2/(1 + z^2), z/(1 + z^2), z = omega tau."""
    z = omega[:, None] * tau
    loss = 1.0 / (z + 1.0 / z)
    return z * loss, loss


def _relative(curve: Curve, constant: float, storage: Floats, loss: Floats) -> Floats:
    """Columns of a constant and of modes: parts of E' and, below, of E'', over those of the curve."""
    found = np.zeros((2, curve.omega.size, 1 + storage.shape[1]))
    found[0, :, 0], found[0, :, 1:], found[1, :, 1:] = constant, storage, loss
    found /= np.array(curve[1:])[..., None]
    return found.reshape(2 * curve.omega.size, -1)


def _residuals(curve: Curve, values: Floats) -> Floats:
    """Relative errors of E' and, behind them, of E'', by long-time modulus, strengths and times."""
    count = values.size // 2
    return _relative(curve, 1.0, *responses(curve.omega, values[1 + count :])) @ values[: 1 + count] - 1.0


def misfits(curve: Curve, spectrum: Spectrum) -> tuple[float, float]:
    """Root mean square of the relative error of E' and of E''."""
    errors = _residuals(curve, np.concatenate([[spectrum.E], *spectrum[1:]])).reshape(2, -1)
    storage, loss = np.sqrt(np.mean(errors * errors, axis=1)).tolist()
    return storage, loss


def on_times(curve: Curve, tau: Floats) -> Spectrum:
    """The least squares with non-negative strengths on given times; modes without strength are left out."""
    from scipy.optimize import nnls

    columns, floor = _relative(curve, 1.0, *responses(curve.omega, tau)), _floor(curve)
    size = np.sqrt((columns * columns).sum(axis=0))
    found, _ = nnls(columns / size, 1.0 - floor * columns[:, 0], maxiter=100 * size.size)
    order = np.argsort(-tau, kind="stable")
    order = order[found[1:][order] > _NOTHING * np.sqrt(tau.size)]
    found = found / size
    return Spectrum(floor + float(found[0]), found[1:][order], tau[order])


def has_plateau(curve: Curve, spectrum: Spectrum) -> bool:
    """Whether the curve asks for a long-time modulus by itself."""
    return spectrum.E > 1.0001 * _floor(curve)


def polished(curve: Curve, spectrum: Spectrum, ends: tuple[float, float], calls: int) -> Spectrum:
    """The spectrum with its times moved too, between ``ends``, in at most so many calls of the residuals."""
    count = spectrum.tau.size
    if not count:
        return spectrum
    start = np.log(np.concatenate([[spectrum.E], spectrum.strength, spectrum.tau]))
    low, high = start - _RANGE, start + _RANGE
    low[0], high[0] = np.log(_floor(curve)), np.inf
    low[1 + count :], high[1 + count :] = np.log(ends)
    return on_times(curve, np.exp(_descended(curve, start, low, high, calls)[1 + count :]))


#: a strength may change by a factor of exp(_RANGE); and where the iteration stops
_RANGE, _STILL = 20.0, 1e-14
#: damping at first, and at least, over the diagonal of the normal equations
_DAMPING, _LEAST_DAMPING = 1e-3, 1e-12
#: multiplications of a product of matrices that BLAS does on one thread
_ALONE = 1 << 17


def _descended(curve: Curve, logs: Floats, low: Floats, high: Floats, calls: int) -> Floats:
    """Levenberg's and Marquardt's iteration between bounds.

    On the normal equations: a SVD of some hundred rows takes ten times as long on several threads as on one, and the
    MINPACK of SciPy 1.17 gives other last digits from call to call.
    """
    logs = np.clip(logs, low, high)
    errors, slopes = _residuals(curve, np.exp(logs)), _slopes(logs, curve)
    damping = _DAMPING
    for _ in range(calls - 1):
        downhill = -(slopes.T @ errors)
        free = ~((logs <= low) & (downhill < 0.0) | (logs >= high) & (downhill > 0.0))
        normal = _squared(slopes[:, free])
        np.fill_diagonal(normal, (1.0 + damping) * normal.diagonal() + np.finfo(float).tiny)
        way = np.zeros_like(logs)
        way[free] = np.linalg.solve(normal, downhill[free])
        way = np.clip(logs + way, low, high) - logs
        found = _residuals(curve, np.exp(logs + way))
        before, gain = errors @ errors, errors @ errors - found @ found
        if gain > 0.0:
            damping, logs = max(damping / 3.0, _LEAST_DAMPING), logs + way
            errors, slopes = found, _slopes(logs, curve)
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


def _slopes(logs: Floats, curve: Curve) -> Floats:
    """Of the residuals over the logarithms of long-time modulus, strengths and times."""
    values, count = np.exp(logs), logs.size // 2
    strength = values[1 : 1 + count]
    storage, loss = responses(curve.omega, values[1 + count :])
    of_times = 2.0 * loss * loss * strength, loss * (1.0 - 2.0 * storage) * strength
    upper, lower = (np.hstack([each * strength, by]) for each, by in zip((storage, loss), of_times, strict=True))
    return _relative(curve, values[0], upper, lower)


def _floor(curve: Curve) -> float:
    return FLOOR * float(curve.storage.min())
