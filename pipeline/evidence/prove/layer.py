"""What the half-space law and, for thin layers, a foundation of springs get wrong of rolling on a
viscoelastic cover.

The cover has one relaxation time, and its contact is that of the package (:mod:`.cover` proves it).
How thick an elastic layer has to be to pass for a half-space stands in data/reference/layer.json,
made by :func:`load`: a rigid cylinder presses an elastic layer of thickness h that is bonded to
something rigid, plane strain, no friction.  Its surface yields to a pressure p cos(k x) by
2 (1 - nu^2)/E p/k L(k h), and contact is where the pressure is (I. I. Vorovich, V. M. Aleksandrov
and V. A. Babeshko, Nonclassical mixed problems of elasticity, 1974).  With lengths in the
half-width a, the slope of the surface in contact is that of the cylinder,

    integral over s of p(s) (1/(x - s) + r((x - s)/h)/h) = pi x
    r(y) = integral over u of (L(u) - 1) sin(u y)

with p = sqrt(1 - s^2) phi(s), phi = 1 on a half-space; collocation at Chebyshev's points converges
exponentially.  At one half-width the load is f(h) times that of Hertz, so that at one load the
half-widths are as 1/sqrt(f).

python -m pipeline.evidence.prove.layer [-o FILE]: data/results/layer.json, in seconds.
"""

import math
import sys
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

import viscoroll as vr

from ...stage import Row
from ..results import run

#: Thickness over l0, and Poisson's ratios of the covers.
THICKNESS = (10.0, 5.0, 2.0, 1.0, 0.5, 0.3, 0.2)
COVER_RATIOS = (0.3, 0.45, 0.5)
#: Material of the covers.
MATERIAL = vr.Prony([10.0], [1.0 / 11.0])
#: kappa V between which M is largest.
_SPEEDS = (0.01, 10.0)
#: Upper end of the integral over u, where L - 1, which falls as exp(-2 u), is below the last digit.
_LAST = 20.0
#: Points of the integral over u.
_NODES = 1000
#: Points of collocation: seven digits down to a thickness of 0.3 half-widths.
_POINTS = 31


def kernel(u: NDArray, nu: float) -> NDArray:
    """Return L of an elastic layer, by decaying exponentials:

    L(u) = (2 c sinh 2u - 4 u)/(2 c cosh 2u + 4 u^2 + 1 + c^2),   c = 3 - 4 nu,   1 of a half-space

    u: wave number times thickness.
    nu: Poisson's ratio.
    """
    c = 3.0 - 4.0 * nu
    once = np.exp(-2.0 * u)
    rest = (4.0 * u * u + 1.0 + c * c) * once
    return (c * (1.0 - once * once) - 4.0 * u * once) / (c * (1.0 + once * once) + rest)


def load(h: float, nu: float) -> float:
    """Return the load of an elastic layer over that of Hertz at the same half-width.

    h: thickness over the half-width.
    nu: Poisson's ratio.
    """
    n = _POINTS + 1
    s = np.cos(np.arange(1, n) * np.pi / n)
    x = np.cos((np.arange(n) + 0.5) * np.pi / n)
    weights = np.pi / n * (1.0 - s * s)
    apart = x[:, None] - s
    regular = _regular(apart / h, nu) / h
    phi = np.linalg.lstsq(weights * (1.0 / apart + regular), np.pi * x, rcond=None)[0]
    return weights @ phi / (0.5 * np.pi)


def _regular(y, nu):
    u, weights = _quadrature()
    part = (kernel(u, nu) - 1.0) * weights
    return np.array([np.sin(np.multiply.outer(row, u)) @ part for row in y])


@lru_cache
def _quadrature():
    at, weights = np.polynomial.legendre.leggauss(_NODES)
    return 0.5 * _LAST * (1.0 + at), 0.5 * _LAST * weights


def springs(p: vr.Prony, z: float, h: float, nu: float) -> NDArray:
    """(H, g, m) of a foundation of springs K E * w, w = (b^2 - x^2)/2: a thin compressible layer.

    E * w is the response of the relaxation modes to the deflection from the front edge x = b on; at
    b - 2 z it has fallen to 0.  Lengths over V T_ref.
    """
    K = 2.0 * (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) / h
    a = 1.0 / p.tau

    def pressure(x, b):
        s = (b - x)[..., None]
        f = -np.expm1(-s * a) / a
        return K * (0.5 * (b * b - x * x) + (f * x[..., None] + f / a - s * (1.0 / a - f)) @ p.E)

    b = brentq(lambda b: float(pressure(np.array(b - 2.0 * z), b)), z, 2.0 * z)
    t, w = np.polynomial.legendre.leggauss(100)
    x = b - z + z * t
    weights = w * z
    load = weights @ pressure(x, b)
    return np.array([2.0 / np.pi * load, b - z, weights @ (x * pressure(x, b)) / load])


def springs_moment(u: float, h: float, nu: float) -> float:
    """kappa M of the foundation at kappa V = u, for a thickness over l0."""
    z = brentq(
        lambda z: springs(MATERIAL, z, h / u, nu)[0] * 4.0 * u * u - 1.0,
        1e-3 / u,
        2.0 / u,
        xtol=1e-12,
    )
    return u * springs(MATERIAL, z, h / u, nu)[2]


def compared(nu: float, thickness: float) -> Row:
    """Half-space over cover: contact length at rest, largest M; speed of the largest M of the cover
    over that of the half-space; largest M of the foundation over that of the cover."""
    half = vr.Scene(
        material=vr.Bodies(MATERIAL, vr.Prony.elastic(), 1.0), kappa=1.0, mu=1.0, coupled=False
    )
    cover = half.replace(material=vr.Cover(MATERIAL, nu=nu, thickness=thickness))
    top, own = (vr.resistance_extrema(scene) for scene in (half, cover))
    rest = vr.contact(cover, 0.0, delta=0.0, fields="lam").lam
    row = {
        "nu": nu,
        "thickness": thickness,
        "length": 1.0 / rest - 1.0,
        "M": top.M[0] / own.M[0] - 1.0,
        "speed": own.V[0] / top.V[0],
        "springs": None,
    }
    if nu < 0.5 and thickness <= 1.0:
        found = minimize_scalar(
            lambda log_u: -springs_moment(math.exp(log_u), thickness, nu),
            bounds=np.log(_SPEEDS),
            method="bounded",
        )
        row["springs"] = -found.fun / own.M[0] - 1.0
    return row


def found() -> Row:
    """Return half-spaces and foundations in place of covers, a row for each ratio and thickness."""
    return {"covers": [compared(nu, thickness) for nu in COVER_RATIOS for thickness in THICKNESS]}


if __name__ == "__main__":
    sys.exit(run("prove.layer", found, __doc__, "layer.json", sizes=False))
