"""The standard linear solid, one relaxation time: g, h, m and their slopes by Bessel ratios.

With p(z) = r(alpha z) k(z), c = (alpha - 1)/alpha,

    g = c p/(1 + p)      h = c r(alpha z)/(1 + p)      m = c (lam^2 i2(alpha z) + p)/(1 + p)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..bessel.ratios import ratio_i2, ratio_k, ratio_r, ratios_and_slopes, small_k_over_z
from ..compile.jit import kernel
from ..numerics.nodes import gauss

#: 5-point Gauss-Legendre rule on [0, 1]
GAUSS_X, GAUSS_W = gauss(5)


class Standard(NamedTuple):
    """One relaxation time.

    alpha : instantaneous over long-time modulus, T_epsilon/T_sigma; lam falls to alpha^(-1/2) at high speed
    T_mean : c, the limit of m at low speed: V' = -T_mean V/(1 + j) at last; g < T_mean/2; 0 in an elastic material
    tau : T_sigma, the least relaxation time: on this scale the law bends where eta leaves 0
    """

    alpha: float
    T_mean: float
    tau: float


@kernel(inline=True)
def standard(alpha):
    """The material of this alpha."""
    return Standard(alpha, (alpha - 1.0) / alpha, 1.0 / alpha)


@kernel(inline=True)
def generators(z, material):
    """(g, h) at z: epsilon zeta = g, H = z^2 + 2 z h; 0 for z <= 0 (no stick zone)."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0
    r, _ = ratio_r(alpha * z)
    k, _ = ratio_k(z)
    p = r * k
    share = c / (1.0 + p)
    return share * p, share * r


@kernel(inline=True)
def generator_slopes(z, material):
    """(g, h, g', h') at z, all 0 for z <= 0."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    _, r, k, s, dk, _, _ = ratios_and_slopes(z, alpha)
    dr = alpha * s
    p = r * k
    dp = dr * k + r * dk
    whole = 1.0 / (1.0 + p)
    share = c * whole
    return share * p, share * r, share * whole * dp, share * whole * (dr - r * r * dk)


@kernel(inline=True)
def second_slopes(z, material):
    """(g, h, g', h', g'', h'') at z, by differentiating the Riccati equations."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    _, r, k, s, dk, per_x, per_z = ratios_and_slopes(z, alpha)
    return assemble(per_z, per_x, r, k, s, dk, material)


@kernel(inline=True)
def assemble(per_z, per_x, r, k, s, dk, material):
    """(g, h, g', h', g'', h'') from the ratios and their slopes s = r', dk = k'; per_z = 1/z, per_x = 1/(alpha z)."""
    alpha, c = material.alpha, material.T_mean
    dr = alpha * s
    ddr = alpha * alpha * ((r * per_x - s) * per_x - 2.0 * r * s)
    ddk = 2.0 * k * dk + (dk - k * per_z) * per_z
    p = r * k
    dp = dr * k + r * dk
    ddp = ddr * k + 2.0 * dr * dk + r * ddk
    whole = 1.0 / (1.0 + p)
    share = c * whole
    dg = share * whole * dp
    dh_top = dr - r * r * dk
    ddh_top = ddr - 2.0 * r * dr * dk - r * r * ddk
    ddg = whole * (share * ddp - 2.0 * dg * dp)
    ddh = share * whole * (ddh_top - 2.0 * whole * dp * dh_top)
    return share * p, share * r, dg, share * whole * dh_top, ddg, ddh


@kernel
def moment_of(zeta, lam, g, h, material):
    """``moment_factor`` from g and h at zeta: p = g/(c - g), r = h/(c - g).  Every term is positive."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0:
        return 0.0
    rest = c - g  # c/(1 + p) >= c/2
    return lam * lam * ratio_i2(alpha * zeta, h / rest) * rest + g


@kernel(inline=True)
def fast_limit(z, h, material):
    """(g/z, m/z) at a z that is so small that its square may underflow: lam^2 = 1/alpha, i2 = (alpha z)^2/8."""
    g = h * small_k_over_z(z)
    return g, 0.125 * material.T_mean * material.alpha * z + g


@kernel(inline=True)
def at_contact(z, material):
    """(g, h, g', h', m, m', b, b') at z = zeta from one pair of ratios; M = V m."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x, r, k, s, dk, per_x, per_z = ratios_and_slopes(z, alpha)
    g, h, dg, dh, _, ddh = assemble(per_z, per_x, r, k, s, dk, material)
    i2 = ratio_i2(x, r)
    lam2 = 1.0 / (1.0 + 2.0 * h * per_z)
    whole = 1.0 / (1.0 + r * k)
    bend = (dh - h * per_z) * per_z
    d_lam2 = -2.0 * lam2 * lam2 * bend
    d_i2 = alpha * 2.0 * (r * r - i2) * per_x
    m = c * (lam2 * i2 + r * k) * whole
    dp = alpha * s * k + r * dk
    dm = whole * (c * (d_lam2 * i2 + lam2 * d_i2 + dp) - m * dp)
    per_U = 1.0 / (1.0 + h * per_z + dh)  # U = H'/(2 z)
    per_lam_U = np.sqrt(1.0 + 2.0 * h * per_z) * per_U
    return g, h, dg, dh, m, dm, per_lam_U * m, per_lam_U * (dm - m * ((bend + ddh) * per_U - bend * lam2))


@kernel(inline=True)
def _steady(z, material):
    """(g, h, g', h', m) at z > 0."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    x, r, k, s, dk, _, per_z = ratios_and_slopes(z, alpha)
    p = r * k
    whole = 1.0 / (1.0 + p)
    share = c * whole
    h = share * r
    lam2 = 1.0 / (1.0 + 2.0 * h * per_z)
    m = share * (lam2 * ratio_i2(x, r) + p)
    return share * p, h, share * whole * (alpha * s * k + r * dk), share * whole * (alpha * s - r * r * dk), m


@kernel(inline=True)
def at_slide(z, material):
    """(g, h, h', m) at z > 0."""
    g, h, _, dh, m = _steady(z, material)
    return g, h, dh, m


@kernel(inline=True)
def at_rolling(z, material):
    """(g, h, g', h', m of the half-space, m of the cylinder) at z > 0."""
    g, h, dg, dh, m = _steady(z, material)
    return g, h, dg, dh, 0.5 * m, 0.5 * m


@kernel(inline=True)
def mean_slopes(zeta, D, material):
    """Means of g' and of (z h)' over [zeta - D, zeta]."""
    slope_g, slope_zh = 0.0, 0.0
    for n in range(5):
        z = zeta - D * GAUSS_X[n]
        _, h, dg, dh = generator_slopes(z, material)
        slope_g += GAUSS_W[n] * dg
        slope_zh += GAUSS_W[n] * (h + z * dh)
    return slope_g, slope_zh
