"""Tables over (V, delta) of one material, or of a pair: their grid, and the law at their nodes."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..checks import number
from ..errors import ParameterError
from ..materials.file import as_toml, materials_of
from ..materials.material import Material
from ..materials.pair import Pair
from ..rolling_contact import contact, refuse_overflow
from ..scene import Scene
from .grid import increasing, refuse_large

if TYPE_CHECKING:
    import xarray as xr

PLANE = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star")
VOLUME = ("beta", "Q")


@dataclass(frozen=True, eq=False)
class MaterialGrid:
    """Axes of a table over (V, delta) of one material, or of a pair, in plane strain.

    Parameters
    ----------
    material : that of the cylinder.
    kappa : R/l0 with the long-time moduli, > 0.
    mu : coefficient of friction, > 0.
    V : speeds of the axis times T_ref/R, > 0, strictly increasing; T_ref is that of the pair
        (:attr:`viscoroll.Cylinder.T_ref`).
    delta : creep ratios, any sign, strictly increasing.
    base : the material of the half-space; default: that of the cylinder.

    Raises
    ------
    ParameterError
        Where a value is out of range or an axis does not increase, or both bodies are rigid.
    """

    material: Material
    kappa: float
    mu: float
    V: Any
    delta: Any
    base: Material | None = None

    def __post_init__(self) -> None:
        for name in ("kappa", "mu"):
            object.__setattr__(self, name, number(name, getattr(self, name), low=0.0, strict=True))
        for name, bound in (("V", {"low": 0.0, "strict": True}), ("delta", {})):
            object.__setattr__(self, name, increasing(name, getattr(self, name), **bound))
        if self.pair.law.alpha == 1.0:
            raise ParameterError("material", "elastic", "one that relaxes; for alpha = 1 there is LiteralGrid")
        self.scene()
        refuse_overflow(np.asarray(self.kappa), self.V)
        refuse_large(V=self.V, delta=self.delta)

    @property
    def pair(self) -> Pair:
        """Both materials."""
        return Pair(self.material, self.base)

    def scene(self) -> Scene:
        """What the table is of."""
        return Scene(kappa=self.kappa, mu=self.mu, material=self.pair.law)

    def axes(self) -> dict[str, NDArray[np.float64]]:
        """Nodes of V and delta."""
        return {"V": self.V, "delta": self.delta}

    def described(self) -> str:
        """The materials as sections of a TOML file, which reads back to the bit."""
        text = as_toml(self.material)
        return text if self.base is None else f"{text}\n{as_toml(self.base, 'base')}"


def solve(scene: Scene, axes: dict[str, NDArray]) -> dict[str, NDArray[np.float64]]:
    """Fields on the tensor product of ``axes`` (V, delta)."""
    plane = contact(scene, axes["V"], delta=0.0, fields=PLANE)
    volume = contact(scene, axes["V"][:, None], delta=axes["delta"], fields=VOLUME)
    return plane.as_dict() | volume.as_dict()


def scene_of(table: xr.Dataset) -> Scene:
    """What a table is of, from its attribute ``material``."""
    materials = materials_of("table", tomllib.loads(table.attrs["material"]))
    law = Pair(materials["material"], materials.get("base")).law
    return Scene(kappa=table["kappa"].item(), mu=table["mu"].item(), material=law)


def state_of(table: xr.Dataset, points: dict[str, NDArray], method: str) -> dict[str, NDArray]:
    """Fields at points of (V, delta); by "direct" from the root solves of single states, by "table" as ``contact``."""
    found = contact(
        scene_of(table), points["V"], delta=points["delta"], fields=PLANE + VOLUME, slopes=method == "direct"
    )
    return {name: getattr(found, name) for name in PLANE + VOLUME}
