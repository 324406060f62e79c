"""Make layer.json: contact lengths on a layer that is bonded to something rigid.

    python -m data.reference.layer [-o FILE]        in seconds

A rigid cylinder presses an elastic layer of thickness h, plane strain, no friction.  Its surface
yields to a pressure p cos(k x) by 2 (1 - nu^2)/E p/k L(k h), and contact is where the pressure is
(I. I. Vorovich, V. M. Aleksandrov and V. A. Babeshko, Nonclassical mixed problems of elasticity,
1974):

    L(u) = (2 c sinh 2u - 4 u)/(2 c cosh 2u + 4 u^2 + 1 + c^2),   c = 3 - 4 nu,   L -> 1 of a half-space

With lengths in the half-width a, the slope of the surface in contact is that of the cylinder,

    integral over s of p(s) (1/(x - s) + r((x - s)/h)/h) = pi x,   r(y) = integral over u of (L(u) - 1) sin(u y)

with p = sqrt(1 - s^2) phi(s), phi = 1 on a half-space; collocation at Chebyshev's points converges
exponentially.  At one half-width the load is f(h) times that of Hertz, so that at one load the
half-widths are as 1/sqrt(f).
"""  # noqa: E501

from __future__ import annotations

import argparse
import json
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pipeline.evidence.results import rounded

TARGET = Path(__file__).with_suffix(".json")
RATIOS = (0.3, 0.4, 0.45, 0.49, 0.5)
#: Contact lengths of the half-space over the thickness.
LENGTHS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0)
#: Share by which the contact may be shorter.
ALLOWED = 0.05
#: h over the half-width between which a layer is looked for.
_THIN = 0.3
_THICK = 100.0
#: Upper end of the integral over u, where L - 1, which falls as exp(-2 u), is below the last digit.
_LAST = 20.0
#: Points of the integral over u.
_NODES = 1000
#: Points of collocation: seven digits down to the thinnest.
_POINTS = 31


def kernel(u: NDArray[np.float64], nu: float) -> NDArray[np.float64]:
    """L, by decaying exponentials."""
    c, once = 3.0 - 4.0 * nu, np.exp(-2.0 * u)
    rest = (4.0 * u * u + 1.0 + c * c) * once
    result: NDArray[np.float64] = (c * (1.0 - once * once) - 4.0 * u * once) / (
        c * (1.0 + once * once) + rest
    )
    return result


def load(h: float, nu: float, points: int = _POINTS) -> float:
    """Load over that of Hertz at the same half-width, 1."""
    n = points + 1
    s = np.cos(np.arange(1, n) * np.pi / n)
    x = np.cos((np.arange(n) + 0.5) * np.pi / n)
    weights = np.pi / n * (1.0 - s * s)
    apart = x[:, None] - s
    phi = np.linalg.lstsq(
        weights * (1.0 / apart + _regular(apart / h, nu) / h), np.pi * x, rcond=None
    )[0]
    return float(weights @ phi / (0.5 * np.pi))


def _regular(y: NDArray[np.float64], nu: float) -> NDArray[np.float64]:
    u, weights = _quadrature()
    part = (kernel(u, nu) - 1.0) * weights
    return np.array([np.sin(np.multiply.outer(row, u)) @ part for row in y])


@lru_cache
def _quadrature() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    at, weights = np.polynomial.legendre.leggauss(_NODES)
    return 0.5 * _LAST * (1.0 + at), 0.5 * _LAST * weights


def shorter(nu: float, length: float) -> float:
    """Contact length over that on a half-space, which is given over the thickness."""
    return 1.0 / np.sqrt(load(_thickness(nu, length), nu))


def longest(nu: float, by: float = ALLOWED) -> float:
    """Contact length on a half-space over the thickness, at which that on the layer is shorter by a
    share.
    """
    h = brentq(lambda h: np.sqrt(load(h, nu)) - 1.0 / (1.0 - by), _THIN, _THICK, rtol=1e-6)
    return float(2.0 * np.sqrt(load(h, nu)) / h)


def _thickness(nu: float, length: float) -> float:
    """h over the half-width on the layer, of a length on the half-space over h."""
    return float(
        brentq(lambda h: 2.0 * np.sqrt(load(h, nu)) / h - length, _THIN, _THICK, rtol=1e-6)
    )


def main() -> None:
    """Write contact lengths by nu, and where they are 5 % off."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    rows = [
        {
            "nu": nu,
            "limit": rounded(longest(nu)),
            "shorter": {f"{length:g}": rounded(shorter(nu, length)) for length in LENGTHS},
        }
        for nu in RATIOS
    ]
    text = json.dumps({"allowed": ALLOWED, "rows": rows}, indent=1)
    parser.parse_args().output.write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
