"""r, k, i2 and the slopes of r and k against their enclosures, over all positive doubles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import flint
import numpy as np
from flint import arb

from viscoroll.kernels.law import bessel_ratios
from viscoroll.kernels.law import bessel_ratios as kernels

from ..truth import enclosures
from .claim import Found, Proof

#: a polynomial or series to a unit, a product and a logarithm
RATIO_ULP = 4.0
#: of the larger of the two terms of a Riccati equation; 1 - r carries up to 3 units just below x =
#: 2
SLOPE_ULP = 8.0
_BITS = 120


def points(random: np.random.Generator, count: int) -> np.ndarray:
    """Every bin edge and its neighbours; and at random: half over the tables, half over all binary
    exponents.
    """
    octaves = 2.0 ** np.arange(-31, 8)[:, None]
    edges = (octaves * (1.0 + np.arange(bessel_ratios.BINS) / bessel_ratios.BINS)).ravel()
    ends = np.array([5e-324, 1e-320, 2.2250738585072014e-308, 1e-8, 1.7976931348623157e308])
    common = 10.0 ** random.uniform(-4, 3, count // 2)
    bits = random.integers(1, np.float64(np.finfo(float).max).view(np.int64), count - count // 2)
    fixed = [edges, np.nextafter(edges, 0.0), np.nextafter(edges, np.inf), ends]
    return np.concatenate([*fixed, common, bits.view(np.float64)])


def ulps(value: float, exact: Any, *terms: Any) -> float:
    """|value - exact| in units in the last place of the exact value, or of the largest of some
    terms.
    """
    unit = np.spacing(max(abs(float(each)) for each in (exact, *terms)))
    return float((abs(arb(value) - exact) / arb(float(unit))).upper())


def compared(x: float) -> Iterator[tuple[str, float]]:
    """Errors at x: of r, k, i2 in ULP; of r' and k' in ULP of the larger Riccati term."""
    X = arb(x)
    (r, rc) = kernels.ratio_r(x)
    (k, kc) = kernels.ratio_k(x)
    exact_r = enclosures.ratio_r(X)
    exact_k = enclosures.ratio_k(X)
    yield "r", ulps(r, exact_r)
    yield "k", ulps(k, exact_k)
    yield "i2", ulps(kernels.ratio_i2(x, r), enclosures.ratio_i2(X))
    if x >= np.finfo(float).tiny:  # below, k itself has lost its digits, and k/x with it
        yield (
            "slope of r",
            ulps(kernels.slope_r(x, r, rc), 1 - exact_r / X - exact_r**2, exact_r / X),
        )
        yield (
            "slope of k",
            ulps(kernels.slope_k(x, k, kc), exact_k**2 + exact_k / X - 1, exact_k / X),
        )


def found(random: np.random.Generator, count: int) -> Found:
    for x in points(random, count).tolist():
        # the terms of the slopes, 1/x, cancel to 1/x^2
        with flint.ctx.workprec(_BITS + 2 * max(math.frexp(x)[1], 0)):
            yield f"x = {x!r}", dict(compared(x))


_SLOPE = "{}, ULP of the larger term of its Riccati equation"
PROOFS = [
    Proof(
        "ratios",
        "ratio_points",
        "all positive doubles, of slopes all normal ones",
        {name: (f"{name}, ULP", RATIO_ULP) for name in ("r", "k", "i2")}
        | {name: (_SLOPE.format(name), SLOPE_ULP) for name in ("slope of r", "slope of k")},
        found,
    ),
]
