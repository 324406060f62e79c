"""Kernels of the boundary elements at one speed: second antiderivatives of the slopes that a point load causes.

Lengths are divided by l0 and compliances by the summed long-time one; a relaxation time T is the length u T at the
speed u = kappa |V|.  With J* the complex compliance at wave number k, a body has the transforms of
:mod:`..materials.law.cover_solve`: pressure -> slope -i sgn(k) L J*, shear -> strain -i sgn(k) T J*, coupling C J*.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy.special import exp1, expi

from ..core.array_types import Floats
from ..kernels.coupled.elements import BINS, DEGREE, LOWEST, WIDTH
from ..materials.law.cover_solve import layer_nodes

#: smallest argument of the asymptotic series of the exponential integral, to rounding with its number of terms
_FAR, _FAR_TERMS = 50.0, 30
#: terms of the power series of the entire exponential integral up to 1
_NEAR_TERMS = 22
#: k |x| below which the transforms of second antiderivatives are taken from two terms of their series
_SMALL_PHASE = 0.02
#: scales, over l0, at which the growth of the compliance is looked at; a part of the load of the root of a scale lies
#: within it at most
_SCALES = np.geomspace(1e-8, 1.0, 200)
#: growth d ln J/d ln x of the compliance over distance x from the front edge from which on pressure gathers there; the
#: pressure of half-spaces grows like the distance to the power of 1/2 less it
_GROWTH = 0.4


@cache
def _fit() -> tuple[Floats, Floats]:
    """Return (|x| of all bins, ascending in each, (BINS (DEGREE + 1),); values -> coefficients in [-1, 1])."""
    nodes = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    logs = LOWEST + WIDTH * (np.arange(BINS)[:, np.newaxis] + 0.5 * (1.0 + nodes))
    return np.exp(logs).ravel(), np.linalg.inv(np.vander(nodes, DEGREE + 1, increasing=True))


def _memory(X: Floats) -> Floats:
    """Return f(X) + ln|X| + gamma, with f the principal value of int_0^inf exp(-s)/(X + s) ds.

    X: of any sign, not 0.  Returns an array of its shape, good to rounding relative to 1.
    """
    size = np.abs(X)
    found = np.log(size) + np.euler_gamma
    near = size < 1.0
    far = size > _FAR
    x = X[near]
    entire = np.zeros_like(x)
    term = np.ones_like(x)
    for k in range(1, _NEAR_TERMS):
        term = -term * x / k
        entire -= term / k
    found[near] = np.exp(x) * entire - np.expm1(x) * found[near]
    middle = ~(near | far)
    x = X[middle]
    integral = np.where(x > 0.0, exp1(np.abs(x)), -expi(np.abs(x)))
    found[middle] += np.exp(x) * integral
    inverse = 1.0 / X[far]
    term = inverse
    tail = term.copy()
    for k in range(1, _FAR_TERMS):
        term = -term * k * inverse
        tail += term
    found[far] += tail
    return found


def _half_space(instant: float, modes: list[tuple[float, float]], x: Floats) -> tuple[Floats, Floats]:
    """Return (normal kernel less x ln|x|/pi of the instantaneous compliance; coupling of a unit local constant).

    instant: instantaneous compliance.  modes: (strength, length u T) of each.  x: of one sign, (n,).
    """
    normal = -instant * x / np.pi
    ramp = np.maximum(x, 0.0)
    coupling = instant * ramp
    for strength, length in modes:
        X = x / length
        normal += strength * length / np.pi * (_memory(X) + X * np.log(np.abs(X)) - X)
        coupling += strength * (length * np.expm1(np.minimum(X, 0.0)) + ramp)
    return normal, coupling


def _layer(nu: float, thickness: float, instant: float, modes: list[tuple[float, float]], size: Floats) -> Floats:
    """Return what a bonded layer adds to the kernels of a half-space.

    nu, thickness: of the layer.  instant, modes: as of :func:`_half_space`.  size: |x|, (n,).
    Returns (2 signs of x, 3 kernels, n); what is linear in x is left out.
    """
    nodes = layer_nodes(nu)
    k = nodes.u / thickness
    compliance = np.full(k.size, complex(instant))
    for strength, length in modes:
        compliance += strength / (1.0 - 1j * k * length)
    phase = size[:, np.newaxis] * k
    small = phase < _SMALL_PHASE
    safe = np.where(small, 1.0, phase)
    even = np.where(small, 0.5 - phase**2 / 24.0, 2.0 * (np.sin(0.5 * safe) / safe) ** 2)
    odd = np.where(small, phase / 6.0 - phase**3 / 120.0, (safe - np.sin(safe)) / safe**2)
    excess = np.array([nodes.L, nodes.L + nodes.shear, nodes.C]) * nodes.u
    weights = (excess * compliance / (np.pi * thickness)).T
    e_real, e_imag = even @ weights.real, even @ weights.imag
    o_real, o_imag = odd @ weights.real, odd @ weights.imag
    found = np.empty((2, 3, size.size))
    for row, sign in enumerate((1.0, -1.0)):
        found[row, :2] = (e_imag[:, :2] + sign * o_real[:, :2]).T
        found[row, 2] = e_real[:, 2] - sign * o_imag[:, 2]
    return found * size**2


class BodyKernels(NamedTuple):
    """Kernels of one body at one speed, times its share of the compliance, the coupling with the sign of the body.

    table : second antiderivatives as polynomials, (BINS, 2 signs, 3 kernels, DEGREE + 1).
    instant : instantaneous compliance.
    local : (modes + 1, 2): strength and length of each part of the local coupling.
    """

    table: Floats
    instant: float
    local: Floats


def body_kernels(body: Any, u: float) -> BodyKernels:
    """Return the kernels of one body at one speed.

    body: :class:`.coupled.CoupledBody`.
    u: kappa |V|, >= 0 or infinite: elastic at rest, and with the instantaneous compliance.
    """
    size, fit = _fit()
    instant = 1.0 if u == 0.0 else max(1.0 - math.fsum(body.J), 0.0)
    modes = [] if u == 0.0 or math.isinf(u) else [(J, T * u) for J, T in zip(body.J, body.T, strict=True)]
    local = (1.0 - 2.0 * body.nu) / (2.0 - 2.0 * body.nu)
    values = np.zeros((2, 3, size.size))
    for row, sign in enumerate((1.0, -1.0)):
        normal, coupling = _half_space(instant, modes, sign * size)
        values[row, 0] = values[row, 1] = normal
        values[row, 2] = local * coupling
    if math.isfinite(body.thickness):
        values += _layer(body.nu, body.thickness, instant, modes, size)
    values[:, 2] *= 1.0 if body.side == "base" else -1.0
    table = values.reshape(2, 3, BINS, DEGREE + 1) @ fit.T
    sign = body.share if body.side == "base" else -body.share
    parts = [(sign * local * strength, length) for strength, length in [(instant, 0.0), *modes]]
    return BodyKernels(body.share * table.transpose(2, 0, 1, 3), body.share * instant, np.array(parts))


def edge_layer(bodies: Any, u: float) -> float:
    """Return the length of the layer at the front edge in which the material is stiff, over l0; infinite without one.

    bodies: :class:`.coupled.CoupledBody` of each.  u: kappa |V|.
    It is the least distance at which the compliance, of the time of the passage, grows faster than like its root.
    """
    if u == 0.0 or math.isinf(u):
        return math.inf
    compliance = np.zeros_like(_SCALES)
    growth = np.zeros_like(_SCALES)
    for body in bodies:
        compliance += body.share * max(1.0 - math.fsum(body.J), 0.0)
        for strength, time in zip(body.J, body.T, strict=True):
            x = _SCALES / (time * u)
            compliance -= body.share * strength * np.expm1(-x)
            growth += body.share * strength * x * np.exp(-x)
    steep = _SCALES[growth > _GROWTH * compliance]
    return float(steep[0]) if steep.size else math.inf
