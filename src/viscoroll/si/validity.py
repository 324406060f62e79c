"""Which assumptions a cylinder strains, in SI units; what its bodies know of themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import checked, number
from ..materials.material import Material
from ..steadiness import Steadiness
from ..typed import Numbers
from ..validity import Assumption, Validity, coupling, inertia, measurement, passage, thickness
from .units import Cylinder

#: of the compliance, a part below which a body may be as thin and as little known as it likes
_LEAST_PART = 0.01


def validity_of(cylinder: Cylinder, V: Numbers, density: float | None, omega: Numbers | None) -> Validity:
    """``Cylinder.validity``."""
    if density is not None:
        density = number("density", density, low=0.0, strict=True)
    speed, spin = checked("V", V), None if omega is None else checked("omega", omega)
    fastest = np.abs(speed) if spin is None else np.maximum(np.abs(speed), np.abs(spin) * cylinder.R)
    constants = (0.0, 0.0) if cylinder._papers else cylinder.pair.dundurs
    found, strained = cylinder.scene()._validity(
        speed * (cylinder.T_ref / cylinder.R), None if spin is None else spin * cylinder.T_ref
    )
    length = strained.lam * cylinder.l0
    long = "a long cylinder, or one held between walls (plane strain)"
    return found._replace(
        steady=steadily(cylinder, found.steady),
        quasistatic=inertia(*slowness(cylinder, fastest, density)),
        bodies=coupling(*constants, like=cylinder._papers or cylinder.pair.like),
        measured=measurement(passage(speed, length), cylinder._measured),
        thick=thickness(length, {name: body.thickness for name, body in deforming(cylinder).items()}),
        plane=Assumption(None, None, long if cylinder.plane == "strain" else "a thin disc (plane stress)"),
    )


def steadily(cylinder: Cylinder, found: Assumption) -> Assumption:
    """The steadiness of a cylinder's scene in SI units."""
    if not isinstance(found, Steadiness):
        return found
    return found.scaled(cylinder.R / cylinder.T_ref, cylinder.T_ref, cylinder.R, ("m/s", "s", "m"))


def deforming(cylinder: Cylinder) -> dict[str, Material]:
    """The different bodies whose part of the compliance counts; none of a cylinder by the paper's own parameters."""
    if cylinder._papers:
        return {}
    pair = cylinder.pair
    if pair.like:
        return {"the material": pair.half_space}
    bodies = {"the cylinder": (pair.cylinder, pair.share), "the base": (pair.half_space, 1.0 - pair.share)}
    return {name: body for name, (body, part) in bodies.items() if part >= _LEAST_PART}


def slowness(cylinder: Cylinder, speed: NDArray[np.float64], density: float | None) -> tuple[Any, list[str]]:
    """(Speed over that of the slowest shear wave, or None; bodies whose density is not known)."""
    ratios, unknown = [], []
    for name, G, weight in _weighed(cylinder, density):
        if weight is None:
            unknown.append(name)
        else:  # in this order V = 0 gives 0 at any density
            with np.errstate(over="ignore"):
                ratios.append(speed * np.sqrt(1.0 / G) * math.sqrt(weight))
    return (np.max(np.broadcast_arrays(*ratios), axis=0) if ratios else None), unknown


def _weighed(cylinder: Cylinder, density: float | None) -> list[tuple[str, Any, float | None]]:
    """The different bodies that deform, their shear moduli and densities."""
    if cylinder._papers:
        return [("the material", cylinder.E / (2.0 * (1.0 + cylinder.nu)), density)]
    first, second = cylinder.pair.cylinder, cylinder.pair.half_space
    own = first.density if density is None else density
    if cylinder.pair.like:
        return [("the material", first.G, second.density if own is None else own)]
    bodies = [("the cylinder", first, own), ("the base", second, second.density)]
    return [(name, body.G, weight) for name, body, weight in bodies if weight is not None or not body.is_rigid]
