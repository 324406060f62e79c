"""Pressure and shear along the contact, Eqs. (11)-(14), in a form where nothing cancels.

As printed the integrals start at the rear edge and lose a factor exp(2 alpha zeta).  Here, with Y measured from the
middle of the contact, p(z) = r(alpha z) k(z), B = c/(1 + p), cos phi = Y/z,

    S(Y; z) = sqrt(z^2 - Y^2) + alpha z B Int_0^phi (r(alpha z) + cos t) exp(-alpha (z cos t - Y)) dt
    p/E'    = V/(4 pi) S(Y; zeta)
    |tau|/E' = mu V/(4 pi) [S(Y; zeta) - S(Y - (zeta - eta); eta)]      second term in the stick zone

Inside, lengths are in half contacts: u = 1 - Y/z from the front edge, w = 1 + Y/z from the rear edge (each passed on
its own: 2 - u would spoil a small w), S/z instead of S.  V zeta = lam/(2 kappa) then removes the speed from the
formulas, and V = 0 is zeta = inf: Hertz.

With D(t) = cos t - cos phi the integrand is (w - (1 - r) + D) exp(-a D), a = alpha z.  Only the part of [0, phi] with a
D <= 38 counts; one Gauss-Legendre rule on it serves every a.  Against 40 digits S is within 3e-15 of its peak and 2e-14
of itself for a from 1e-8 to 1e8, alpha from 1.01 to 1e4 (28 nodes; 24 leave about 1e-11 of the peak).  Of several modes
the second term is a sum over the modes, with the weight a_i X_i (:mod:`series`) in place of alpha B.

Here c = 1 - 1/alpha, r = I1/I0 and k = K0/K1; V > 0, lam = 2 kappa V zeta is the contact length divided by l0, and eta
= beta zeta belongs to the stick zone.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import ratio_r
from ..compile.jit import kernel
from ..numerics.interpolation import gauss
from ..numerics.simd4 import LANES, broadcast
from .contact_states import element
from .modes import set_alpha_of_state
from .series import evaluate_functions, evaluate_ratios, new_workspace

#: Nodes of the Gauss-Legendre rule on [0, 1]: 24 nodes leave 1e-11 of the peak, 28 leave rounding.
_NODES = gauss(28)[0]
#: Weights of that rule.
_WEIGHTS = gauss(28)[1]
#: Exponent beyond which the integrand is nothing: exp(-38) = 3e-17.
_DEEP = 38.0


class MemoryWeights(NamedTuple):
    """The strengths of the modes at one z, which all points of a contact have in common; filled by :func:`unit_shape`.

    weight : a_i X_i of each mode, dimensionless, (modes,).
    complement : 1 - r(a_i z) of each mode, in [0, 1], (modes,).
    z : the z to which they belong, (1,); NaN if they belong to none yet.
    work : :class:`.series.Workspace` of the series, scratch.
    """

    weight: Any
    complement: Any
    z: Any
    work: Any


class Points(NamedTuple):
    """Arrays of length 1, for all points, or with one value for each point; all dimensionless.

    x : position in l0 from the foot of the axis, positive in the direction of V.
    kappa, mu : of the scene, > 0.
    lam, epsilon, beta, zeta : state of the contact; zeta, in the unit of time of the series, is inf at V = 0.
    """

    x: Any
    kappa: Any
    mu: Any
    lam: Any
    epsilon: Any
    beta: Any
    zeta: Any


@kernel
def _memory_integral(u, w, a, r_complement):
    """Return the memory integral of one relaxation mode at a point of the contact.

    u, w : floats, distances from the front and the rear edge, divided by half the contact length, > 0; u + w = 2.
    a : float, a_i z (of one mode alpha z): half transit time z times the rate of the mode, dimensionless, > 0, finite.
    r_complement : float, 1 - r(a), r the ratio I1/I0, in (0, 1].

    Returns Int_0^phi (r + cos t) exp(-a (cos t - cos phi)) dt with cos phi = 1 - u = w - 1, a float, dimensionless,
    found to rounding by 28 Gauss-Legendre nodes.  The integral over [0, pi] is zero.  Near the rear edge, where w < 1
    and a w < 1, it is therefore taken over the small rest [phi, pi], with the other sign, where a (cos phi - cos t) <=
    a w < 1.  Elsewhere, if a u > 38, the part of [0, phi] where a (cos t - cos phi) exceeds 38 is left out.
    """
    rear = w < 1.0 and a * w < 1.0
    sine = np.sqrt(u * w)
    edge = w if rear else u
    angle = 2.0 * np.arctan2(np.sqrt(edge), np.sqrt(u if rear else w))
    span = angle
    if not rear and a * u > _DEEP:
        # a D = _DEEP at t = deep: D = 2 sin((phi + deep)/2) sin((phi - deep)/2)
        depth = _DEEP / a
        deep = 2.0 * np.arctan2(np.sqrt(u - depth), np.sqrt(w + depth))
        span = 2.0 * np.arcsin(min(0.5 * depth / np.sin(0.5 * (angle + deep)), 1.0))
    half = 0.5 * span
    sign = -1.0 if rear else 1.0
    offset = w - r_complement
    total = 0.0
    for n in range(_NODES.size):
        # t = phi - v (or phi + v): D = +-2 sin(v/2) sin(phi -+ v/2)
        s = np.sin(half * _NODES[n])
        D = sign * 2.0 * s * (sine * np.sqrt(1.0 - s * s) - (1.0 - edge) * s)
        total += _WEIGHTS[n] * (offset + D) * np.exp(-a * D)
    return sign * span * total


def new_memory_weights(series) -> MemoryWeights:
    """Return :class:`MemoryWeights` for ``series``, a :class:`Series`, whose number of modes is read; they belong to no
    z yet: z is NaN, and the other arrays are not initialized.
    """
    n = series.a.size
    return MemoryWeights(np.empty(n), np.empty(n), np.full(1, np.nan), new_workspace(n))


@kernel
def unit_shape(u, w, z, series, weights):
    """Return S/z, the shape of the pressure of Eqs. (11)-(14), at one point.

    u, w : floats, distances from the front and the rear edge, divided by half the contact length; u + w = 2.  One of
        them is <= 0 outside the contact.
    z : float, half transit time of the contact, or of the stick zone, > 0, in the unit of time of the series; inf is
        the elastic limit V = 0.
    series : :class:`Series`: rates and strengths of the modes; it may have none.
    weights : :class:`MemoryWeights`, the strengths of the modes at z.  If they belong to another z, they are computed
        and written here; a caller that changes ``series`` has to set their z to NaN.

    Returns a float, dimensionless, >= 0: exactly 0.0 at the edges and outside the contact, where ``weights`` stays;
    sqrt(u w) for z = inf and for elastic bodies; else the sum of sqrt(u w) and the memory integrals of the modes, each
    times a_i X_i.  Modes with weight 0 or an infinite a_i z count as none.
    """
    if u <= 0.0 or w <= 0.0:
        return 0.0
    shape = np.sqrt(u * w)
    if z == np.inf:
        return shape
    if weights.z[0] != z:
        weights.z[0] = z
        places = broadcast(z)
        evaluate_ratios(places, series, weights.work)
        evaluate_functions(False, places, series, weights.work)
        for i in range(series.a.size):
            weights.weight[i] = series.a[i] * weights.work.y[LANES * i]
            _, weights.complement[i] = ratio_r(series.a[i] * z)
    for i in range(series.a.size):
        a = series.a[i] * z
        if weights.weight[i] > 0.0 and a < np.inf:
            shape += weights.weight[i] * _memory_integral(u, w, a, weights.complement[i])
    return shape


@kernel
def stress_loop(series, alpha, whole, stick, points, p, tau):
    """Compute pressure and shear stress at n points of the contact.

    series : :class:`Series`: rates and strengths of the modes; of one mode, and overwritten, if ``alpha`` is not empty.
    alpha : instantaneous divided by long-time stiffness, >= 1, of a series of one mode, (1,) or (n,); empty: the series
        is complete.
    whole, stick : :class:`MemoryWeights` of the series for the contact and for the stick zone, scratch; they belong to
        no z at the begin (:func:`new_memory_weights`).
    points : :class:`Points`: position x/l0, kappa, mu and the contact state of each point, arrays of length 1 or n.
    p, tau : (n,) floats, written: pressure p/E' and modulus |tau|/E' of the shear stress at every point, dimensionless,
        >= 0, where E' = pi E/(1 - nu^2).  Both are 0 at the edges and outside the contact; in the slip zone, which is
        all of the contact for beta = 0, tau is mu p; for beta = 1 it is 0 but for rounding.  Returns nothing.
    """
    for i in range(p.size):
        if alpha.size > 1 and i > 0 and alpha[i] != alpha[i - 1]:
            whole.z[0] = stick.z[0] = np.nan
        set_alpha_of_state(i, alpha, series)
        lam = element(points.lam, i)
        epsilon = element(points.epsilon, i)
        beta = element(points.beta, i)
        zeta = element(points.zeta, i)
        y = 2.0 * element(points.x, i) / lam
        u = (1.0 - y) + epsilon
        w = (1.0 + y) - epsilon
        scale = lam / (8.0 * np.pi * element(points.kappa, i))
        p[i] = scale * unit_shape(u, w, zeta, series, whole)
        stuck = 0.0
        if not u >= 2.0 * beta:
            stuck = beta * unit_shape(u / beta, 2.0 - u / beta, beta * zeta, series, stick)
        # at beta = 1 the difference is zero to rounding, of either sign
        tau[i] = element(points.mu, i) * max(p[i] - scale * stuck, 0.0)
