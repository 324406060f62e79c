"""The Bessel ratios r, k, i2 and their slopes against 40 digits; the table against a refit of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import mpmath as mp
import numpy as np
import precise
import pytest
import tolerances as tol

from viscoroll.kernels.bessel import layout
from viscoroll.kernels.bessel.ratios import TABLE, ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from viscoroll.kernels.compile.fma import septic

DIGITS = 40
EXACT: dict[str, Callable] = {
    "r(x)/x": lambda x: precise.ratio_r(x) / x,
    "x (1 - r(x))": lambda x: x * (1 - precise.ratio_r(x)),
    "k(z)/z": lambda z: precise.ratio_k(z) / z,
    "z (1 - k(z))": lambda z: z * (1 - precise.ratio_k(z)),
    "i2(x)/x^2": lambda x: precise.ratio_i2(x) / x**2,
}
HALF_BIN = 0.5 / layout.BINS


def seams() -> list[float]:
    """Every power of two in reach of a table or a series, and every bin edge near the ends; neighbours too."""
    powers = [2.0**n for n in range(-34, 9)]
    edges = [2.0**n * (1.0 + b / layout.BINS) for n in (-30, -4, -1, 0, 1, 5) for b in range(layout.BINS)]
    middle = np.array([*powers, *edges, 1e-8])
    return [*middle, *np.nextafter(middle, 0.0), *np.nextafter(middle, np.inf)]


def scattered() -> list[float]:
    rng = np.random.default_rng(7)
    ends = [5e-324, 1e-320, 2.3e-308, 1e-100, 1e17, 1e100, 1e300, 1.7976931348623157e308]
    common = [*(10.0 ** rng.uniform(-10, 4, 300)), *rng.uniform(0.0, 70.0, 300)]
    return [*ends, *common, *(10.0 ** rng.uniform(-320, 300, 60))]


def far_series(x: mp.mpf, order: int, sign: int) -> mp.mpf:
    """Hankel's expansion (DLMF 10.40.1, 10.40.2) without its common factor; sign -1: I, +1: K."""
    total = term = mp.mpf(1)
    for n in range(1, 12):
        term *= sign * (4 * order**2 - (2 * n - 1) ** 2) / (8 * n * x)
        total += term
    return total


def exact_r(x: float) -> mp.mpf:
    x = mp.mpf(x)
    return far_series(x, 1, -1) / far_series(x, 0, -1) if x > 1e6 else precise.ratio_r(x)


def exact_k(z: float) -> mp.mpf:
    z = mp.mpf(z)
    return far_series(z, 0, +1) / far_series(z, 1, +1) if z > 1e6 else precise.ratio_k(z)


def exact_i2(x: float) -> mp.mpf:
    x = mp.mpf(x)
    return far_series(x, 2, -1) / far_series(x, 0, -1) if x > 1e6 else precise.ratio_i2(x)


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(DIGITS):
        yield


def check_point(x: float) -> None:
    """r, k, i2 and the complements 1 - r, 1 - k at one x."""
    r, r_complement = ratio_r(x)
    k, k_complement = ratio_k(x)
    values = {"r": (r, exact_r(x)), "k": (k, exact_k(x)), "i2": (ratio_i2(x, r), exact_i2(x))}
    with mp.workdps(DIGITS + 330 if x > 1e20 else DIGITS):
        values["1 - r"] = (r_complement, 1 - exact_r(x))
        values["1 - k"] = (k_complement, 1 - exact_k(x))
    for name, (value, exact) in values.items():
        bound = tol.RATIO_COMPLEMENT_ULP if name.startswith("1") else tol.RATIO_ULP
        assert precise.ulps(value, exact) <= bound, (name, x, value)


def test_within_two_ulp_of_40_digits():
    for x in [*seams(), *scattered()]:
        check_point(float(x))


def test_ends():
    assert ratio_r(0.0) == (0.0, 1.0)
    assert ratio_k(0.0) == (0.0, 1.0)
    assert ratio_i2(0.0, 0.0) == 0.0
    assert ratio_r(np.inf) == (1.0, 0.0)
    assert ratio_k(np.inf) == (1.0, 0.0)
    assert ratio_i2(np.inf, 1.0) == 1.0


def test_slopes_against_differences():
    """r' and k' against central differences with 40 digits, which know nothing of the Riccati equations."""
    for x in (10.0 ** np.linspace(-9, 4, 60)).tolist():
        h = mp.mpf(x) * mp.mpf(10) ** -13
        for ratio, slope, exact in ((ratio_r, slope_r, precise.ratio_r), (ratio_k, slope_k, precise.ratio_k)):
            difference = (exact(mp.mpf(x) + h) - exact(mp.mpf(x) - h)) / (2 * h)
            error = abs(mp.mpf(slope(x, *ratio(x))) - difference)
            # the two terms of a Riccati equation cancel at large x: r' and k' fall like x^-2, its terms like 1/x
            assert error <= tol.RATIO_SLOPE * (abs(difference) + 1 / (1 + mp.mpf(x))), (x, ratio)


def test_monotone():
    """Never falls by more than rounding, from any double to its neighbour and across every seam."""
    x = np.sort(np.concatenate([seams(), scattered(), np.geomspace(1e-12, 1e12, 4000)]))
    values = np.array([(r := ratio_r(at)[0], ratio_k(at)[0], ratio_i2(at, r)) for at in x])
    assert np.all(np.diff(values, axis=0) >= -tol.RATIO_ULP * np.spacing(values[1:]))


# --- the table ---


def bins() -> Iterator[tuple[str, Callable[[mp.mpf], mp.mpf]]]:
    """In the order of the table: the function of every bin, and the argument at t in [-1/32, 1/32]."""
    for segment in layout.SEGMENTS:
        for octave in range(segment.low, segment.high):
            for index in range(layout.BINS):
                centre = 1 + (2 * index + 1) * mp.mpf(HALF_BIN)
                yield segment.function, lambda t, c=centre, o=octave: (c + mp.mpf(t)) * mp.mpf(2) ** o


def refit() -> np.ndarray:
    """The whole table once more: the pipeline's interpolation, but the Bessel functions of ``precise``."""
    from pipeline.evidence.truth.ratios import NODES, chebyshev_fit

    points = [mp.mpf(HALF_BIN) * mp.cos(mp.pi * (2 * i + 1) / (2 * NODES)) for i in range(NODES)]
    values = ([EXACT[function](at(t)) for t in points] for function, at in bins())
    return np.array([float(m) for each in values for m in chebyshev_fit(each, mp.mpf(HALF_BIN))])


def test_every_coefficient_is_the_rounded_fit():
    """All of them, bit for bit: a change of one, however small and of whatever order, shows."""
    assert TABLE.shape == (layout.TABLE_SIZE,)
    with mp.workdps(60):  # the highest orders are 1e-26 of the values
        again = refit()
    assert np.flatnonzero(TABLE != again).size == 0


def test_every_bin_at_its_ends_and_middle():
    """Truncation shows at the ends of a bin, where |t| = 1/32."""
    for (function, at), row in zip(bins(), TABLE.reshape(-1, layout.COEFFICIENTS), strict=True):
        for t in (-HALF_BIN, 0.4 * HALF_BIN):
            value, exact = np.polynomial.polynomial.polyval(t, row), EXACT[function](at(t))
            assert precise.ulps(value, exact) <= tol.RATIO_BIN_ULP, (function, at(t))


def test_a_nan_stays_one():
    """It must not be taken for the number of a bin: that reads beyond the table."""
    nan = float("nan")
    assert np.isnan([*ratio_r(nan), *ratio_k(nan), ratio_i2(nan, nan)]).all()


def test_polynomials_are_summed_with_one_rounding_a_term():
    """(1 + u)^2 - 1 - 2 u = u^2, which two roundings would lose; and powers of two, which no rounding touches."""
    t, u = 1.0 + 2.0**-30, 2.0**-30
    assert septic(t, (-1.0 - 2.0**-29, t, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)) == u * u
    powers = 2.0 ** np.arange(8)
    assert septic(2.0, tuple(powers)) == np.sum(powers * 2.0 ** np.arange(8))
