"""How thick a layer has to be to pass for a half-space: contact lengths on one that is bonded to something rigid.

A rigid cylinder presses an elastic layer of thickness h, plane strain, no friction.  Its surface yields to a pressure
p cos(k x) by 2 (1 - nu^2)/E p/k L(k h), and contact is where the pressure is (I. I. Vorovich, V. M. Aleksandrov and
V. A. Babeshko, Nonclassical mixed problems of elasticity, 1974):

    L(u) = (2 c sinh 2u - 4 u)/(2 c cosh 2u + 4 u^2 + 1 + c^2),   c = 3 - 4 nu,   L -> 1 of a half-space

With lengths in the half-width a, the slope of the surface in contact is that of the cylinder,

    integral over s of p(s) (1/(x - s) + r((x - s)/h)/h) = pi x,   r(y) = integral over u of (L(u) - 1) sin(u y)

with p = sqrt(1 - s^2) phi(s), phi = 1 on a half-space; collocation at Chebyshev's points converges exponentially.
At one half-width the load is f(h) times that of Hertz, so that at one load the half-widths are as 1/sqrt(f).

Beside it what the half-space law and, for thin layers, a foundation of springs get wrong of rolling on a viscoelastic
cover of one relaxation time, whose contact is that of the package (:mod:`.cover` proves it).

python -m pipeline.evidence.prove.layer [-o FILE]: data/results/layer.json, in seconds.
"""

from __future__ import annotations

import math
import sys
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

import viscoroll as vr

from ..results import run

RATIOS = (0.3, 0.4, 0.45, 0.49, 0.5)
#: contact lengths of the half-space over the thickness
LENGTHS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0)
#: by which the contact may be shorter
ALLOWED = 0.05
#: h over the half-width between which a layer is looked for
_THIN, _THICK = 0.3, 100.0
#: L - 1 falls as exp(-2 u)
_LAST, _NODES = 20.0, 1000
#: thickness over l0 and Poisson's ratios of the covers that the half-space law is compared with
THICKNESS, COVER_RATIOS = (10.0, 5.0, 2.0, 1.0, 0.5, 0.3, 0.2), (0.3, 0.45, 0.5)
#: material of the covers, and the speeds between which M is largest
MATERIAL, _SPEEDS = vr.Prony([10.0], [1.0 / 11.0]), (0.01, 10.0)
#: points of collocation: seven digits down to the thinnest
_POINTS = 31


def kernel(u: NDArray[np.float64], nu: float) -> NDArray[np.float64]:
    """L, by decaying exponentials."""
    c, once = 3.0 - 4.0 * nu, np.exp(-2.0 * u)
    rest = (4.0 * u * u + 1.0 + c * c) * once
    result: NDArray[np.float64] = (c * (1.0 - once * once) - 4.0 * u * once) / (c * (1.0 + once * once) + rest)
    return result


def load(h: float, nu: float, points: int = _POINTS) -> float:
    """Load over that of Hertz at the same half-width, 1."""
    n = points + 1
    s = np.cos(np.arange(1, n) * np.pi / n)
    x = np.cos((np.arange(n) + 0.5) * np.pi / n)
    weights = np.pi / n * (1.0 - s * s)
    apart = x[:, None] - s
    phi = np.linalg.lstsq(weights * (1.0 / apart + _regular(apart / h, nu) / h), np.pi * x, rcond=None)[0]
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
    """Contact length on a half-space over the thickness, at which that on the layer is shorter by a share."""
    h = brentq(lambda h: np.sqrt(load(h, nu)) - 1.0 / (1.0 - by), _THIN, _THICK, rtol=1e-6)
    return float(2.0 * np.sqrt(load(h, nu)) / h)


def _thickness(nu: float, length: float) -> float:
    """h over the half-width on the layer, of a length on the half-space over h."""
    return float(brentq(lambda h: 2.0 * np.sqrt(load(h, nu)) / h - length, _THIN, _THICK, rtol=1e-6))


def springs(p: vr.Prony, z: float, h: float, nu: float) -> NDArray[np.float64]:
    """(H, g, m) of a foundation of springs K E * w, w = (b^2 - x^2)/2: a thin compressible layer.

    E * w is the response of the relaxation modes to the deflection from the front edge x = b on; at b - 2 z it has
    fallen to 0.  Lengths over V T_ref.
    """
    K, a = 2.0 * (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) / h, 1.0 / p.tau

    def pressure(x: NDArray[np.float64], b: float) -> NDArray[np.float64]:
        s = (b - x)[..., None]
        f = -np.expm1(-s * a) / a
        result: NDArray[np.float64] = K * (0.5 * (b * b - x * x) + (f * x[..., None] + f / a - s * (1.0 / a - f)) @ p.E)
        return result

    b = brentq(lambda b: float(pressure(np.array(b - 2.0 * z), b)), z, 2.0 * z)
    t, w = np.polynomial.legendre.leggauss(100)
    x, weights = b - z + z * t, w * z
    load = weights @ pressure(x, b)
    return np.array([2.0 / np.pi * load, b - z, weights @ (x * pressure(x, b)) / load])


def _springs_moment(u: float, h: float, nu: float) -> float:
    """kappa M of the foundation at kappa V = u, for a thickness over l0."""
    z = brentq(lambda z: springs(MATERIAL, z, h / u, nu)[0] * 4.0 * u * u - 1.0, 1e-3 / u, 2.0 / u, xtol=1e-12)
    return float(u * springs(MATERIAL, z, h / u, nu)[2])


def compared(nu: float, thickness: float) -> dict[str, Any]:
    """Half-space over cover: contact length at rest, largest M; speed of the largest M of the cover over that of the
    half-space; largest M of the foundation over that of the cover."""
    half = vr.Scene(material=vr.Bodies(MATERIAL, vr.Prony.elastic(), 1.0), kappa=1.0, mu=1.0)
    cover = half.replace(material=vr.Cover(MATERIAL, nu=nu, thickness=thickness))
    top, own = (vr.resistance_extrema(scene) for scene in (half, cover))
    rest = vr.contact(cover, 0.0, delta=0.0, fields="lam").lam
    row = {
        "nu": nu, "thickness": thickness, "length": float(1.0 / rest - 1.0),
        "M": float(top.M[0] / own.M[0] - 1.0), "speed": float(own.V[0] / top.V[0]), "springs": None,
    }  # fmt: skip
    if nu < 0.5 and thickness <= 1.0:
        found = minimize_scalar(
            lambda log_u: -_springs_moment(math.exp(log_u), thickness, nu), bounds=np.log(_SPEEDS), method="bounded"
        )
        row["springs"] = -found.fun / float(own.M[0]) - 1.0
    return row


def found() -> dict[str, Any]:
    """Contact lengths by nu, and where they are 5 % off; half-spaces and foundations in place of covers."""
    rows = [
        {"nu": nu, "limit": longest(nu), "shorter": {f"{length:g}": shorter(nu, length) for length in LENGTHS}}
        for nu in RATIOS
    ]
    covers = [compared(nu, thickness) for nu in COVER_RATIOS for thickness in THICKNESS]
    return {"rows": rows, "allowed": ALLOWED, "covers": covers}


if __name__ == "__main__":
    sys.exit(run("prove.layer", found, __doc__, "layer.json", sizes=False))
