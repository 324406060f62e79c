"""The standard linear solid, one relaxation time, as peers integrate it: g, h, m and b of z, by Bessel ratios.

With p(z) = r(alpha z) k(z), c = (alpha - 1)/alpha, F = z + g, H = z^2 + 2 z h and M = V m,

    g = c p/(1 + p)      h = c r(alpha z)/(1 + p)      m = c (lam^2 i2(alpha z) + p)/(1 + p)      b = 2 z m/(lam H')
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from viscoroll.kernels.bessel.ratios import (
    K_LEAST,
    k_from,
    piece_of,
    place_k,
    place_r,
    r_from,
    ratio_i2,
    ratio_k,
    ratio_r,
    small_k,
)
from viscoroll.kernels.compile.jit import kernel
from viscoroll.kernels.numerics.nodes import gauss

#: 5-point Gauss-Legendre rule on [0, 1]
_GAUSS_X, _GAUSS_W = gauss(5)
#: below this (zeta - eta)/zeta differences of g and h are integrals of their slopes
_CLOSE = 0.1


class Standard(NamedTuple):
    """T_epsilon/T_sigma, and c, the limit of m at low speed."""

    alpha: float
    T_mean: float


@kernel(inline=True)
def standard(alpha):
    """The material of this alpha."""
    return Standard(alpha, (alpha - 1.0) / alpha)


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
def ratios_and_slopes(z, alpha):
    """(x = alpha z, r(x), k(z), r', k', 1/x, 1/z) for z > 0, by one division."""
    x = alpha * z
    per_x = 1.0 / x
    per_z = alpha * per_x
    row, t = place_r(x, per_x)
    piece = piece_of(row, t)
    r, r_complement = r_from(piece, x, piece * per_x)
    if z < K_LEAST:
        k, k_complement = small_k(z)
    else:
        row, t = place_k(z, per_z)
        piece = piece_of(row, t)
        k, k_complement = k_from(piece, z, piece * per_z)
    # by the Riccati equations
    s, dk = r_complement * (1.0 + r) - r * per_x, k * per_z - k_complement * (1.0 + k)
    return x, r, k, s, dk, per_x, per_z


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
def at_contact(z, material):
    """(g, h, g', h', m, b, b') at z = zeta from one pair of ratios; M = V m."""
    alpha, c = material.alpha, material.T_mean
    if c == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x, r, k, s, dk, per_x, per_z = ratios_and_slopes(z, alpha)
    dr, p = alpha * s, r * k
    ddr = alpha * alpha * ((r * per_x - s) * per_x - 2.0 * r * s)
    dp, whole = dr * k + r * dk, 1.0 / (1.0 + p)
    rise, share = dr - r * r * dk, c * whole
    g, h, dg, dh = share * p, share * r, share * whole * dp, share * whole * rise
    ddh = (
        share
        * whole
        * (ddr - 2.0 * r * dr * dk - r * r * (2.0 * k * dk + (dk - k * per_z) * per_z) - 2.0 * whole * dp * rise)
    )
    i2, lam2, bend = ratio_i2(x, r), 1.0 / (1.0 + 2.0 * h * per_z), (dh - h * per_z) * per_z
    m = c * (lam2 * i2 + p) * whole
    dm = whole * (c * (lam2 * alpha * 2.0 * (r * r - i2) * per_x - 2.0 * lam2 * lam2 * bend * i2 + dp) - m * dp)
    per_U = 1.0 / (1.0 + h * per_z + dh)  # U = H'/(2 z)
    per_lam_U = per_U / np.sqrt(lam2)
    return g, h, dg, dh, m, per_lam_U * m, per_lam_U * (dm - m * ((bend + ddh) * per_U - bend * lam2))


@kernel
def differences(zeta, eta, D, material):
    """(F(zeta) - F(eta), (H(zeta) - H(eta))/zeta) with D = zeta - eta, to full relative accuracy."""
    ratio = eta / zeta
    if material.T_mean == 0.0:
        return D, (1.0 + ratio) * D
    if D > _CLOSE * zeta:
        g, h = generators(zeta, material)
        g_eta, h_eta = generators(eta, material)
        return D + (g - g_eta), (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta)
    slope_g = slope_zh = 0.0
    for n in range(5):
        z = zeta - D * _GAUSS_X[n]
        _, h, dg, dh = generator_slopes(z, material)
        slope_g += _GAUSS_W[n] * dg
        slope_zh += _GAUSS_W[n] * (h + z * dh)
    return D * (1.0 + slope_g), D * (1.0 + ratio + 2.0 * slope_zh / zeta)
