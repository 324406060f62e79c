"""Rolling resistance over speed: the humps of M(V), and between them the branches on which it can be inverted.

kappa M is one function of kappa V for a material, and zeta, which falls as the speed rises, gives both
(:mod:`..kernels.law.steady_loop`).  A gain G on the speed turns M(V) = load into M(V) - G V = load, which is the same
with another curve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..materials.bodies import Bodies
from ..materials.prony import Prony
from ..materials.tables import record
from ..scene import Scene, checked_scene
from .zeros import zeros

#: zeta in the material's own time that is looked at, and of it octaves beyond the shortest and the longest time that
#: are looked at closely: farther out the curve has one simple extremum at most
_LEAST, _MOST = -432, 432
_MARGIN = 14
#: nodes an octave, close and far; an extremum keeps others away by this part of zeta
_CLOSE, _FAR, _APART = 16, 2, 1e-6
#: kappa times a load, and a gain over the own time, that the nodes reach
LEAST_LOAD, MOST_LOAD = 1e-120, 1e80
_GAINS = (1e-40, 1e8)


class Humps(NamedTuple):
    """Every local maximum and minimum of M(V), V > 0, by rising V: a maximum comes first and last.

    V : speeds.  M : moments there.  top : whether it is a maximum.
    """

    V: NDArray[np.float64]
    M: NDArray[np.float64]
    top: NDArray[np.bool_]


@dataclass(frozen=True)
class Law:
    """The material of a scene in its own time.

    material : an alpha or a series, of both bodies together.  bodies : the same, or both where they are not alike.
    unit : the own time over T_ref.
    """

    material: float | Prony
    bodies: float | Prony | Bodies
    unit: float

    @classmethod
    def of(cls, scene: Scene) -> Law:
        """That of a scene."""
        material, unit = scene.in_own_time()
        return cls(material, scene.kernel_material, unit)

    @property
    def elastic(self) -> bool:
        """Whether nothing relaxes."""
        return self.material == 1.0

    @property
    def T_mean(self) -> float:
        """M/V of slow rolling, over T_ref."""
        own = self.material.T_mean if isinstance(self.material, Prony) else (self.material - 1.0) / self.material
        return own * self.unit


@dataclass(frozen=True)
class Branches:
    """kappa (M - G V) over the speed: nodes by rising speed, and those between which it is monotone."""

    zeta: NDArray[np.float64]
    speed: NDArray[np.float64]
    rise: NDArray[np.float64]
    flat: NDArray[np.bool_]
    gain: float
    first: NDArray[np.int64]
    last: NDArray[np.int64]

    @property
    def curve(self) -> Any:
        """The nodes as kernels take them."""
        from ..kernels.law.steady_loop import Curve

        return Curve(self.zeta, self.rise, self.flat, self.gain)

    def crossed(self, branch: int, load: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which loads meet this branch; an extremum, and loads next to it, belong to the branch that ends in it."""
        from ..kernels.law.steady_loop import SNAP

        first, last = self.rise[self.first[branch]], self.rise[self.last[branch]]
        inside = (load > min(first, last)) & (load < max(first, last))
        if self.flat[self.first[branch]]:
            inside &= np.abs(load - first) > SNAP * np.abs(load)
        return inside | (np.abs(load - last) <= SNAP * np.abs(load)) if self.flat[self.last[branch]] else inside


def humps(scene: Scene) -> Humps:
    """Every local maximum and minimum of the rolling resistance M over the speed.

    A rubber of widely spread relaxation times has several, one of one relaxation time a single maximum.

    Parameters
    ----------
    scene : alpha or material, and kappa are used; numbers.

    Returns
    -------
    Humps
        ``V``, ``M`` and ``top`` as arrays of one length, dimensionless; empty for an elastic material.

    Raises
    ------
    ParameterError
        Arrays in the scene.

    Notes
    -----
    M is good to 1e-14, V to 1e-11 (``tests/test_steady.py``).
    """
    checked_scene(scene, "humps")
    for name in ("alpha", "kappa"):
        if np.ndim(getattr(scene, name)):
            raise ParameterError(name, f"an array of shape {np.shape(getattr(scene, name))}", "a single number")
    law = Law.of(scene)
    if law.elastic:
        return Humps(np.empty(0), np.empty(0), np.empty(0, dtype=bool))
    found = branches(law.material, 0.0)
    V, M = found.speed[found.flat] / (scene.kappa * law.unit), found.rise[found.flat] / scene.kappa
    return Humps(V, M, np.arange(V.size) % 2 == 0)


@lru_cache(maxsize=16)
def branches(material: float | Prony, gain: float) -> Branches:
    """The curve of a material in its own time, and a gain in that.

    Raises
    ------
    ParameterError
        A gain that the nodes do not reach.
    """
    if gain and not _GAINS[0] <= abs(gain) <= _GAINS[1]:
        raise ParameterError("gain on V", f"{gain:g}", f"0, or of a size in [{_GAINS[0]:g}, {_GAINS[1]:g}]")
    nodes = grid(material)
    flat = np.exp2(zeros(lambda x: _rows(material, gain, np.exp2(x))[2], nodes))
    zeta = np.exp2(nodes)
    for at in flat:
        zeta = zeta[np.abs(zeta - at) > _APART * at]
    whole = np.concatenate([zeta, flat])
    order = np.argsort(-whole)
    zeta, is_flat = whole[order], order >= zeta.size
    speed, rise, _ = _rows(material, gain, zeta)
    ends = np.concatenate([[0], np.flatnonzero(is_flat), [zeta.size - 1]])
    return Branches(zeta, speed, rise, is_flat, gain, ends[:-1].copy(), ends[1:].copy())


def grid(material: float | Prony) -> NDArray[np.float64]:
    """Nodes of log2(zeta), ascending: close where the material relaxes."""
    if isinstance(material, Prony):
        shortest, longest = 1.0 / material.modes.a[-1], 1.0 / material.modes.b[0]
    else:
        shortest, longest = 1.0 / material, 1.0
    low, high = math.floor(math.log2(shortest)) - _MARGIN, math.ceil(math.log2(longest)) + _MARGIN
    parts = (_LEAST, low, _FAR), (low, high, _CLOSE), (high, _MOST, _FAR)
    steps = [np.linspace(start, stop, (stop - start) * per, endpoint=False) for start, stop, per in parts]
    return np.concatenate([*steps, [_MOST]])


def _rows(material: float | Prony, gain: float, zeta: NDArray[np.float64]) -> NDArray[np.float64]:
    """kappa V, kappa (M - gain V) and its slope at zeta."""
    from ..kernels.law.steady_loop import curve_loop

    out = np.empty((3, zeta.size))
    curve_loop(record(material), gain, np.ascontiguousarray(zeta), out)
    return out
