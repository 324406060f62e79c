"""r, k, i2 and the slopes of r and k against their enclosures, over all positive doubles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import flint
import numpy as np
from flint import arb
from tqdm import tqdm

from viscoroll.kernels.bessel import layout as layout
from viscoroll.kernels.bessel import ratios as kernels

from ..truth import enclosures
from .claim import Claim

#: a polynomial or series to a unit, a product and a logarithm
RATIO_ULP = 4.0
#: of the larger of the two terms of a Riccati equation; 1 - r carries up to 3 units just below x = 2
SLOPE_ULP = 8.0
_BITS = 120


def points(count: int, seed: int) -> np.ndarray:
    """Every bin edge and its neighbours; and at random: half over the tables, half over all binary exponents."""
    rng = np.random.default_rng(seed)
    octaves = 2.0 ** np.arange(-31, 8)[:, None]
    edges = (octaves * (1.0 + np.arange(layout.BINS) / layout.BINS)).ravel()
    ends = np.array([5e-324, 1e-320, 2.2250738585072014e-308, 1e-8, 1.7976931348623157e308])
    common = 10.0 ** rng.uniform(-4, 3, count // 2)
    bits = rng.integers(1, np.float64(np.finfo(float).max).view(np.int64), count - count // 2)
    fixed = [edges, np.nextafter(edges, 0.0), np.nextafter(edges, np.inf), ends]
    return np.concatenate([*fixed, common, bits.view(np.float64)])


def ulps(value: float, exact: Any) -> float:
    """|value - exact| in units in the last place of the exact value."""
    unit = np.spacing(abs(float(exact)))
    return float((abs(arb(value) - exact) / arb(float(unit))).upper())


def compared(x: float) -> Iterator[tuple[str, float]]:
    """Errors at x: of r, k, i2 in ULP; of r' and k' in ULP of the larger Riccati term."""
    r, rc = kernels.ratio_r(x)
    k, kc = kernels.ratio_k(x)
    X = arb(x)
    exact_r, exact_k, exact_i2 = enclosures.ratio_r(X), enclosures.ratio_k(X), enclosures.ratio_i2(X)
    yield "r", ulps(r, exact_r)
    yield "k", ulps(k, exact_k)
    yield "i2", ulps(kernels.ratio_i2(x, r), exact_i2)
    if x < np.finfo(float).tiny:  # k itself has lost its digits, and k/x with it
        return
    for name, slope, exact, term in (
        ("slope of r", kernels.slope_r(x, r, rc), 1 - exact_r / X - exact_r**2, exact_r / X),
        ("slope of k", kernels.slope_k(x, k, kc), exact_k**2 + exact_k / X - 1, exact_k / X),
    ):
        unit = np.spacing(max(abs(float(exact)), abs(float(term))))
        yield name, float((abs(arb(slope) - exact) / arb(float(unit))).upper())


def claim_of(name: str) -> Claim:
    if "slope" in name:
        return Claim(f"{name}, ULP of the larger term of its Riccati equation", "all normal doubles", SLOPE_ULP)
    return Claim(f"{name}, ULP", "all positive doubles", RATIO_ULP)


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    claims: dict[str, Claim] = {}
    for at in tqdm(points(sizes["ratio_points"], sizes["seed"]).tolist(), desc="Bessel ratios", delay=1.0, leave=False):
        # the terms of the slopes, 1/x, cancel to 1/x^2
        with flint.ctx.workprec(_BITS + 2 * max(math.frexp(at)[1], 0)):
            for name, error in compared(at):
                claims.setdefault(name, claim_of(name)).add(error, f"x = {at!r}")
    return [claim.row for claim in claims.values()]
