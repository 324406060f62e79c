"""The strain of a contact, beside that of the data of its materials: :func:`assess_strain`.

Under an elliptic pressure p_0 sqrt(1 - (x/a)^2) on a half-space the largest shear stress at the
axis is 0.300 p_0, at the depth 0.786 a (K. L. Johnson, Contact Mechanics, 1985, Sect. 4.2), with
p_0 = E* a/(2 R).  In a layer it follows from the field of the layer under such a pressure of the
same load.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ..core.checks import Floats
from .assumptions import Assumption, largest

#: Largest shear stress at the axis of a half-space over p_0: the maximum of s - s^2/sqrt(1 + s^2)
#: over the depth s.
SHEAR = math.sqrt(0.5 * (5.0 * math.sqrt(5.0) - 11.0))
#: Largest ratio of the strain of the contact to that of the data, and its inverse the least: filled
#: rubbers soften by up to a factor of 5 between 0.1 and 10 %, so that a factor 3 of strain changes
#: the moduli by up to 1.5.
STRAIN_RATIO = 3.0
#: Half contact lengths over the thickness at which the field of a layer is computed, and
#: interpolated between.
_THETA = np.geomspace(1e-2, 8.0, 60)
#: Nodes of wavenumber and depth of that field: the error is below 1e-3.
_WAVES = 4000
_DEPTHS = 81


def assess_strain(data: Any, V: Any, length: Any, load: Any) -> Assumption:
    """Compare the amplitude of engineering shear strain at the axis with that of the data of the
    bodies.

    data: the bodies, a :class:`.body_data.BodyData`.
    V, length: speed, m/s, and contact length, m, arrays of one shape; load: N/m, which broadcasts
    with them.
    Returns the assumption ``strain``, whose value is the strain of the softest body, dimensionless;
    it holds where that of each body with data is between a third and three times the strain of its
    data, and is undecided without such.
    """
    strains = _strains(data, V, length, load)
    value: Any = np.max(np.broadcast_arrays(*strains.values()), axis=0)
    sentence = f"the strain of the contact is up to {100.0 * largest(value):.2g} %"
    known = {
        name: record.strain for name, record in data.records.items() if record.strain is not None
    }
    if not known:
        return Assumption(
            None,
            value,
            f"{sentence}; that of the data is not known: give the Material measured.strain",
        )
    holds: Any = True
    for name, strain in known.items():
        own = strains[name] / strain
        holds = holds & (own <= STRAIN_RATIO) & ((own >= 1.0 / STRAIN_RATIO) | (V == 0.0))
        sentence += f"; {name} was measured at {100.0 * strain:.2g} %"
    return Assumption(holds, value, f"{sentence}: between a third and three times that is allowed")


def _strains(data: Any, V: Any, length: Any, load: Any) -> dict[str, Any]:
    """Return name of a deformable body -> amplitude of its shear strain, in the shape of V;
    arguments as there.
    """
    pair = data.pair
    slenderness = 0.25 * length / data.R
    if pair is None:  # both of the paper's material
        return {
            "the material": 0.5 * SHEAR * slenderness * _modulus_over_shear(data.nu, data.plane)
        }
    bodies = {"the material": pair.cylinder}
    if not pair.like:
        bodies = {"the cylinder": pair.cylinder, "the base": pair.half_space}
    rate = np.abs(V) / length
    soft = {
        name: 1.0
        / (body.storage(rate) * _modulus_over_shear(body.nu, data.plane) / (2.0 * (1.0 + body.nu)))
        for name, body in bodies.items()
    }
    whole = (2.0 if pair.like else 1.0) * sum(soft.values())
    found = {}
    for name, body in bodies.items():
        if body.is_rigid:
            continue
        found[name] = (
            SHEAR * slenderness * _modulus_over_shear(body.nu, data.plane) * soft[name] / whole
        )
        if body.thickness is not None:
            G = body.storage(rate) / (2.0 * (1.0 + body.nu))
            table = _layer_shear(body.nu)
            part = np.interp(0.5 * length / body.thickness, _THETA, table)
            found[name] = part * 4.0 * load / (math.pi * length * G)
    return found


def _modulus_over_shear(nu: Any, plane: str) -> Any:
    """Return E*/G of a body beside a rigid one: 2/(1 - nu) in plane strain, 2 (1 + nu) in plane
    stress.
    """
    return 2.0 / (1.0 - nu) if plane == "strain" else 2.0 * (1.0 + nu)


@lru_cache(maxsize=8)
def _layer_shear(nu: float) -> Floats:
    """Return the largest shear stress at the axis of a bonded layer over p_0, at the ratios
    :data:`_THETA`.

    The stress function of the wavenumber k is f(z) cos(kx) with f = (A + B kz) cosh kz + (C + D kz)
    sinh kz; at z = 0 the pressure is given and the shear stress 0, at z = h both displacements are
    0.
    nu: Poisson's ratio of the layer.
    """
    from scipy.special import j1

    found = np.empty(_THETA.size)
    for n, a in enumerate(_THETA.tolist()):  # of the thickness 1
        k = np.geomspace(1e-4, 60.0 / min(a, 1.0), _WAVES)
        z = np.linspace(0.0, min(2.5 * a, 1.0), _DEPTHS)[:, np.newaxis]
        s = np.minimum(k, 25.0)
        kz = np.minimum(k, 25.0) * z
        B, D = _layer_terms(s, nu)
        cosh = np.cosh(kz)
        sinh = np.sinh(kz)
        # f and f''/k^2 for A = 1, C = -B
        f = (1.0 + B * kz) * cosh + (D * kz - B) * sinh
        bend = (1.0 + B * kz + 2.0 * D) * cosh + (D * kz + B) * sinh
        deep = k > s  # a half-space to rounding
        difference = np.where(deep, 2.0 * k * z * np.exp(-k * z), f + bend)
        shear = 0.5 * difference @ j1(k * a) * np.log(k[1] / k[0])
        found[n] = np.abs(shear).max()
    return found


def _layer_terms(s: Floats, nu: float) -> tuple[Floats, Floats]:
    """Return B and D of :func:`_layer_shear` for A = 1 at s = k h, (n,) each."""
    cosh = np.cosh(s)
    sinh = np.sinh(s)
    # (1 - nu) f'' + nu k^2 f = 0 and (1 - nu) f''' = (2 - nu) k^2 f' at z = h, rows over B and D
    u_B = s * cosh + (1.0 - 2.0 * nu) * sinh
    u_D = s * sinh + 2.0 * (1.0 - nu) * cosh
    w_B = (1.0 - nu) * (2.0 * cosh + s * sinh) - (2.0 - nu) * s * sinh
    w_D = (1.0 - nu) * (3.0 * sinh + s * cosh) - (2.0 - nu) * (sinh + s * cosh)
    u_A = cosh
    w_A = (1.0 - nu) * sinh - (2.0 - nu) * sinh
    det = u_B * w_D - u_D * w_B
    return (-u_A * w_D + u_D * w_A) / det, (-u_B * w_A + u_A * w_B) / det
