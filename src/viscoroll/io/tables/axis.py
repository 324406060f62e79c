"""The law of every alpha of one relaxation time as a dataset, with errors measured against root solves."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...materials.law_axis import FUNCTIONS, LawAxis, law_axis
from ...materials.law_file import as_dataset
from ...materials.law_modes import by_modes

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

#: functions of kappa |V|; the others are of v = 1/F(eta)
_OF_SPEED = 4
#: places at which errors are measured, at random with this seed
PLACES, SEED = 20_000, 20250701
#: of ln z, some ten wide, to rounding
_HALVINGS = 60


def axis(low: float, high: float) -> xr.Dataset:
    """The dataset of :func:`viscoroll.io.tables.law` of alphas from ``low`` to ``high``."""
    made = law_axis(low, high)
    return as_dataset(made, measured_errors(made))


def measured_errors(axis: LawAxis, count: int = PLACES, seed: int = SEED) -> dict[str, float]:
    """Largest relative error of every function at random alpha and speed before its fast limit; N over its largest.

    Against the roots of Eqs. (6) and (10) by halving, with the Bessel functions of SciPy: no polynomial, and no kernel
    but that of N.

    Parameters
    ----------
    axis : a law.
    count : of places, even in ln alpha and ln x.
    seed : of the places.
    """
    random = np.random.default_rng(seed)
    octave = random.integers(len(axis.rows), size=count)
    alpha = np.exp2(axis.first + octave + random.random(count))
    x = np.exp2(axis.e0 - 4.0 + (np.array(axis.rows)[octave] + 3.0) * random.random(count))
    found, exact = _by_axis(axis, octave, alpha, x), _by_roots(alpha, x)
    scale = np.abs(exact)
    for n in np.unique(octave):
        scale[FUNCTIONS.index("N"), octave == n] = scale[FUNCTIONS.index("N"), octave == n].max()
    error = np.abs(found - exact) / scale
    return dict(zip(FUNCTIONS, error.max(axis=1).tolist(), strict=True))


def _by_axis(axis: LawAxis, octave: NDArray[np.int64], alpha: Floats, x: Floats) -> Floats:
    """(6, n): the functions at the places, those over c as they stand."""
    mantissa, exponent = np.frexp(x)
    row = np.maximum(exponent - axis.e0, 0)
    t = np.where(row == 0, np.ldexp(x, -axis.e0), 4.0 * mantissa - 3.0)
    s = 2.0 * np.log2(alpha / np.exp2(axis.first + octave)) - 1.0
    terms = np.cos(np.arange(axis.coefficients.shape[1])[:, None] * np.arccos(s))
    powers = t ** np.arange(axis.coefficients.shape[3])[:, None]
    found = np.empty((len(FUNCTIONS), x.size))
    for i, n in np.unique([octave, row], axis=1).T:
        here = (octave == i) & (row == n)
        sums = np.einsum("jn,jkf->kfn", terms[:, here], axis.coefficients[i, :, n])
        found[:, here] = (sums * powers[:, None, here]).sum(axis=0)
    return found


def _by_roots(alpha: Floats, x: Floats) -> Floats:
    """The same by root solves."""
    from scipy.special import i0e, i1e, ive, k0e, k1e

    c = (alpha - 1.0) / alpha

    def generators(z: Floats) -> tuple[Floats, Floats, Floats]:
        r = i1e(alpha * z) / i0e(alpha * z)
        p = r * k0e(z) / k1e(z)
        return c * p / (1.0 + p), c * r / (1.0 + p), p

    def speed(z: Floats) -> Floats:
        return 2.0 * np.sqrt(z * (z + 2.0 * generators(z)[1]))

    def stick(z: Floats) -> Floats:
        return z + generators(z)[0]

    z = _root(speed, 1.0 / x, 0.5 / (x * np.sqrt(alpha)), 0.5 / x)
    g, h, p = generators(z)
    lam2 = 1.0 / (1.0 + 2.0 * h / z)
    m = (lam2 * ive(2, alpha * z) / i0e(alpha * z) + p) / (1.0 + p)
    N = by_modes(alpha, z).N
    eta = _root(stick, 1.0 / x, 1.0 / (x * alpha), 1.0 / x)
    g_eta, h_eta, _ = generators(eta)
    share = 1.0 / (1.0 + g_eta / eta)
    return np.stack([np.sqrt(lam2), g / (z * c), m, N / c, share, (1.0 + 2.0 * h_eta / eta) * share**2])


def _root(rising: Callable[[Floats], Floats], target: Floats, low: Floats, high: Floats) -> Floats:
    """Where a rising function of z has the ``target``."""
    for _ in range(_HALVINGS):
        middle = np.sqrt(low) * np.sqrt(high)
        above = rising(middle) > target
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return 0.5 * (low + high)
