"""Material of a driven motion in Arb's digits: g, h, m and their slopes from the matching conditions as they stand.

The conditions of :mod:`series`, with the slopes of their solution; one relaxation time is one mode.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from viscoroll.core.errors import ParameterError
from viscoroll.core.extras import imported
from viscoroll.materials.bodies import Bodies
from viscoroll.materials.prony import Prony
from viscoroll.scene import Scene

from . import series
from .enclosures import ratio_i2, ratio_k, ratio_r

#: digits of the conversion between both forms
_DIGITS = 90
#: 1/z below this is 0
_LEAST = 1e-40


class Zone(NamedTuple):
    """g, h, their slopes, and the parts of m that the half-space and the cylinder take, at one z."""

    g: Any
    h: Any
    dg: Any
    dh: Any
    m_half_space: Any
    m_cylinder: Any


class Solid(NamedTuple):
    """Rates and strengths of the modes as ``arb``; ``weights``: what of each creep mode is the half-space's."""

    a: list[Any]
    b: list[Any]
    J: list[Any]
    weights: list[Any]
    T_mean: Any

    def at(self, z: Any) -> Zone:
        """Functions at z > 0."""
        if not self.a:
            return Zone(*6 * [0 * z])
        z, modes = min(z, z / z / _LEAST), range(len(self.a))
        found = series.conditions(ARB, self, z)
        r, k, X, per = found.r, found.k, found.X, found.per
        dr = [a * (1 - x / (a * z) - x * x) for a, x in zip(self.a, r, strict=True)]
        dk = [b * (x * x + x / (b * z) - 1) for b, x in zip(self.b, k, strict=True)]
        right = [-sum(per[n][i] * (dr[i] * k[n] + r[i] * dk[n]) * X[i] for i in modes) for n in modes]
        dX = _solved(found.matrix, right)
        dh = sum(dX[i] * r[i] + X[i] * dr[i] for i in modes)
        parts = found.shares(self, z, self.J)
        half_space = sum(part * weight for part, weight in zip(parts, self.weights, strict=True))
        values = found.g, found.h, -sum(dX), dh, half_space, sum(parts) - half_space
        return Zone(*(value.mid() for value in values))


def _solved(matrix: list[list[Any]], right: list[Any]) -> list[Any]:
    """The solution of a linear system, without its radius."""
    mat = imported("flint", "python-flint", "dev").arb_mat
    return [value.mid() for value in mat(matrix).solve(mat([[x] for x in right])).entries()]


#: midpoints of Arb's
ARB = series.Numbers(*(lambda x, of=of: of(x).mid() for of in (ratio_r, ratio_k, ratio_i2)), _solved)


def solid_of(scene: Scene) -> Solid:
    """The material of a scene; of two bodies that differ the sum of their compliances."""
    flint, mp = imported("flint", "python-flint", "dev"), imported("mpmath", "mpmath", "dev")

    def exact(values: list[Any]) -> list[Any]:
        return [flint.arb(mp.nstr(mp.mpf(value), _DIGITS)) for value in values]

    material = scene.material
    if isinstance(material, Bodies) and scene.like_bodies:
        material = material.cylinder
    if not isinstance(material, (Prony, Bodies, type(None))):
        raise ParameterError("material", repr(material), "one material, as material[i]")
    with mp.workdps(_DIGITS + 10):
        if (material is None and scene.alpha == 1.0) or (isinstance(material, Prony) and not material.E.size):
            return Solid([], [], [], [], flint.arb(0))
        known = series.rates_of(mp, float(scene.alpha) if material is None else material)
        weights = [mp.mpf(1) / 2] * len(known.b)
        if isinstance(material, Bodies):
            weights = [which for _, _, which in series.creep_of(mp, material)]
        J = series.creep_strengths(mp, known)
        return Solid(exact(known.a), exact(known.b), exact(J), exact(weights), exact([known.T_mean])[0])
