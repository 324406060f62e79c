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
_SCALES = np.geomspace(1e-7, 1.0, 200)
#: growth d ln J/d ln x of the compliance over distance x from the front edge from which on pressure gathers there; the
#: pressure of half-spaces grows like the distance to the power of 1/2 less it
_GROWTH = 0.4
#: points of Gauss's rule in an element
_GAUSS = 5
#: first, last and step of s, with half length times wave number ln(1 + e^s): the transform of the pressure, squared,
#: falls like the third power
_WAVES = -25.0, 80.0, 0.12


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


def transforms(nodes: Floats, values: Floats, k: Floats) -> Any:
    """Return the Fourier transform int f(x) exp(-i k x) dx of a function that is linear between nodes.

    nodes, values: (n,).  k: wave numbers, (m,).  Returns complex numbers (m,), by Gauss's rule in each element.
    """
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    lengths = np.diff(nodes)
    part = 0.5 * (1.0 + points)
    x = nodes[:-1, np.newaxis] + lengths[:, np.newaxis] * part
    f = values[:-1, np.newaxis] * (1.0 - part) + values[1:, np.newaxis] * part
    f = f * (0.5 * weights) * lengths[:, np.newaxis]
    return np.exp(-1j * np.multiply.outer(k, x.ravel())) @ f.ravel()


def layer_transforms(nu: float, u: Floats) -> Floats:
    """Return L, T and C of a bonded layer over those of a half-space, C as it is, at wave numbers times the thickness.

    nu: Poisson's ratio.  u: > 0, (n,).  Returns (3, n).
    """
    kap = 3.0 - 4.0 * nu
    decay = np.exp(-2.0 * u)
    denominator = kap * (1.0 + decay**2) + (4.0 * u**2 + 1.0 + kap**2) * decay
    mean = kap * (1.0 - decay**2)
    swing = 4.0 * u * decay
    C = (kap * (kap - 1.0) * (1.0 - decay) ** 2 - 8.0 * u**2 * decay) / ((kap + 1.0) * denominator)
    return np.array([(mean - swing) / denominator, (mean + swing) / denominator, C])


def depth(bodies: Any, u: float, profile: Any) -> float:
    """Return the approach of two bodies of which each is a layer on rigid ground or rigid, over l0^2/R.

    The mean of the displacement of both surfaces with the pressure as weight, by Parseval's theorem, and that of the
    cylinder's profile x^2/2.

    bodies: :class:`.coupled.CoupledBody` of each that deforms, all of finite thickness.
    u: kappa |V|.  profile: :class:`.coupled.CoupledProfile`.
    """
    half = 0.5 * (profile.nodes[-1] - profile.nodes[0])
    s = np.arange(*_WAVES)
    k = np.logaddexp(0.0, s) / half
    weights = (_WAVES[2] / half) / (1.0 + np.exp(-s))
    p = transforms(profile.nodes, profile.p, k)
    q = transforms(profile.nodes, profile.q, k)
    total = 0.0
    for body in bodies:
        compliance = np.full(k.size, complex(max(1.0 - math.fsum(body.J), 0.0)))
        for strength, time in zip(body.J, body.T, strict=True):
            with np.errstate(over="ignore", invalid="ignore"):
                compliance += strength / (1.0 - 1j * k * (time * u)) if math.isfinite(u) else 0.0
        L, _, C = layer_transforms(body.nu, k * body.thickness)
        side = 1.0 if body.side == "base" else -1.0
        work = compliance / k * (L * np.abs(p) ** 2 + 1j * side * C * q * np.conj(p))
        total += body.share * float(weights @ work.real) / np.pi
    middle = 0.5 * (profile.nodes[:-1] + profile.nodes[1:])
    lengths = np.diff(profile.nodes)
    ends = profile.p * (profile.nodes + profile.shift) ** 2
    centre = 0.5 * (profile.p[:-1] + profile.p[1:]) * (middle + profile.shift) ** 2
    square = float(lengths @ (ends[:-1] + 4.0 * centre + ends[1:])) / 6.0
    load = float(np.trapezoid(profile.p, profile.nodes))
    return (total + 0.5 * square) / load
