"""What the half-space law and, for thin layers, a foundation of springs get wrong of rolling on a
viscoelastic cover.

The cover has one relaxation time, and its contact is that of the package (:mod:`.cover` proves it).
How thick an elastic layer has to be to pass for a half-space stands in data/reference/layer.json.

python -m pipeline.evidence.prove.layer [-o FILE]: data/results/layer.json, in seconds.
"""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

import viscoroll as vr

from ..results import run

#: Thickness over l0, and Poisson's ratios of the covers.
THICKNESS = (10.0, 5.0, 2.0, 1.0, 0.5, 0.3, 0.2)
COVER_RATIOS = (0.3, 0.45, 0.5)
#: Material of the covers.
MATERIAL = vr.Prony([10.0], [1.0 / 11.0])
#: kappa V between which M is largest.
_SPEEDS = (0.01, 10.0)


def springs(p: vr.Prony, z: float, h: float, nu: float) -> NDArray[np.float64]:
    """(H, g, m) of a foundation of springs K E * w, w = (b^2 - x^2)/2: a thin compressible layer.

    E * w is the response of the relaxation modes to the deflection from the front edge x = b on; at
    b - 2 z it has fallen to 0.  Lengths over V T_ref.
    """
    K = 2.0 * (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) / h
    a = 1.0 / p.tau

    def pressure(x: NDArray[np.float64], b: float) -> NDArray[np.float64]:
        s = (b - x)[..., None]
        f = -np.expm1(-s * a) / a
        result: NDArray[np.float64] = K * (
            0.5 * (b * b - x * x) + (f * x[..., None] + f / a - s * (1.0 / a - f)) @ p.E
        )
        return result

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
    return float(u * springs(MATERIAL, z, h / u, nu)[2])


def compared(nu: float, thickness: float) -> dict[str, Any]:
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
        "length": float(1.0 / rest - 1.0),
        "M": float(top.M[0] / own.M[0] - 1.0),
        "speed": float(own.V[0] / top.V[0]),
        "springs": None,
    }
    if nu < 0.5 and thickness <= 1.0:
        found = minimize_scalar(
            lambda log_u: -springs_moment(math.exp(log_u), thickness, nu),
            bounds=np.log(_SPEEDS),
            method="bounded",
        )
        row["springs"] = -found.fun / float(own.M[0]) - 1.0
    return row


def found() -> dict[str, Any]:
    """Return half-spaces and foundations in place of covers, a row for each ratio and thickness."""
    return {"covers": [compared(nu, thickness) for nu in COVER_RATIOS for thickness in THICKNESS]}


if __name__ == "__main__":
    sys.exit(run("prove.layer", found, __doc__, "layer.json", sizes=False))
