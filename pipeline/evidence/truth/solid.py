"""Material of a driven motion in Arb's digits: g, h, m and their slopes from the matching conditions as they stand.

The same conditions as :mod:`series`, with the slopes of their solution; one relaxation time is one mode.
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
        flint = imported("flint", "python-flint", "dev")
        if not self.a:
            return Zone(*6 * [0 * z])
        z, modes = min(z, z / z / _LEAST), range(len(self.a))
        r, k = [ratio_r(a * z).mid() for a in self.a], [ratio_k(b * z).mid() for b in self.b]
        dr = [a * (1 - x / (a * z) - x * x) for a, x in zip(self.a, r, strict=True)]
        dk = [b * (x * x + x / (b * z) - 1) for b, x in zip(self.b, k, strict=True)]
        per = [[self.a[i] / (self.a[i] - self.b[n]) for i in modes] for n in modes]
        matrix = flint.arb_mat([[per[n][i] * (1 + r[i] * k[n]) for i in modes] for n in modes])
        X = _solved(matrix, [1 / b for b in self.b])
        dX = _solved(matrix, [-sum(per[n][i] * (dr[i] * k[n] + r[i] * dk[n]) * X[i] for i in modes) for n in modes])
        h = sum(X[i] * r[i] for i in modes)
        dh = sum(dX[i] * r[i] + X[i] * dr[i] for i in modes)
        i2 = [ratio_i2(a * z).mid() for a in self.a]
        u = [i2[i] + sum(X[n] * _pair(self.a[i], self.a[n]) * (i2[i] - i2[n]) for n in modes) for i in modes]
        square = 1 / (1 + 2 * h / z)
        parts = [self.J[n] * sum(X[i] * per[n][i] * (r[i] * k[n] + square * u[i]) for i in modes) for n in modes]
        half_space = sum(part * weight for part, weight in zip(parts, self.weights, strict=True))
        found = (self.T_mean - sum(X), h, -sum(dX), dh, half_space, sum(parts) - half_space)
        return Zone(*(value.mid() for value in found))


def _pair(a: Any, other: Any) -> Any:
    return a * other / (a + other)


def _solved(matrix: Any, right: list[Any]) -> list[Any]:
    """The solution of a linear system, without its radius."""
    mat = type(matrix)
    return [value.mid() for value in matrix.solve(mat([[x] for x in right])).entries()]


def solid_of(scene: Scene) -> Solid:
    """The material of a scene; of two bodies that differ the sum of their compliances."""
    flint, mp = imported("flint", "python-flint", "dev"), imported("mpmath", "mpmath", "dev")

    def exact(values: list[Any]) -> list[Any]:
        return [flint.arb(mp.nstr(mp.mpf(value), _DIGITS)) for value in values]

    with mp.workdps(_DIGITS + 10):
        half = mp.mpf(1) / 2
        if scene.material is None:
            alpha = mp.mpf(float(scene.alpha))
            if alpha == 1:
                return Solid([], [], [], [], flint.arb(0))
            known, weights = series.rates_of_creep(mp, [(alpha - 1) / alpha], [1], alpha), [half]
        elif isinstance(scene.material, Bodies) and not scene.like_bodies:
            known, weights = _sum(mp, scene.material)
        else:
            one = scene.material.cylinder if isinstance(scene.material, Bodies) else scene.material
            if not isinstance(one, Prony):
                raise ParameterError("material", repr(one), "one material, as material[i]")
            if not one.E.size:
                return Solid([], [], [], [], flint.arb(0))
            known = series.rates(mp, one.E.tolist(), one.tau.tolist())
            weights = [half] * len(known.b)
        J = series.creep_strengths(mp, known)
        return Solid(exact(known.a), exact(known.b), exact(J), exact(weights), exact([known.T_mean])[0])


def _sum(mp: Any, bodies: Bodies) -> tuple[series.Rates, list[Any]]:
    """Both bodies as one series, and what of each creep mode is the half-space's: bodies share no creep time."""
    share, modes, compliance = mp.mpf(bodies.share), [], mp.mpf(0)
    for body, part, weight in ((bodies.cylinder, share, 0), (bodies.base, 1 - share, 1)):
        if not body.E.size:
            compliance += part
            continue
        known = series.rates(mp, body.E.tolist(), body.tau.tolist())
        strengths = series.creep_strengths(mp, known)
        modes += [(1 / b, part * J, weight) for b, J in zip(known.b, strengths, strict=True) if part * J]
        compliance += part / known.alpha
    modes.sort(key=lambda mode: mode[0], reverse=True)
    times, strengths, weights = (list(column) for column in zip(*modes, strict=True))
    return series.rates_of_creep(mp, strengths, times, 1 / compliance), weights
