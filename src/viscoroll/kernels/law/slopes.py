"""Slopes of M and of Q, by the Riccati equations alone."""

from __future__ import annotations

from ..bessel.ratios import ratio_i2, ratios_and_slopes
from ..compile.jit import kernel
from .law import GAUSS_W, GAUSS_X, assemble, generator_slopes, second_slopes


@kernel(inline=True)
def at_contact(z, alpha, c):
    """(g, h, g', h', g'', h'', m, m') at z = zeta from one pair of ratios; M = V m."""
    if c == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x, r, k, s, dk, per_x, per_z = ratios_and_slopes(z, alpha)
    g, h, dg, dh, ddg, ddh = assemble(per_z, per_x, r, k, s, dk, alpha, c)
    i2 = ratio_i2(x, r)
    lam2 = 1.0 / (1.0 + 2.0 * h * per_z)
    whole = 1.0 / (1.0 + r * k)
    d_lam2 = -2.0 * lam2 * lam2 * (dh - h * per_z) * per_z
    d_i2 = alpha * 2.0 * (r * r - i2) * per_x
    m = c * (lam2 * i2 + r * k) * whole
    dp = alpha * s * k + r * dk
    return g, h, dg, dh, ddg, ddh, m, whole * (c * (d_lam2 * i2 + lam2 * d_i2 + dp) - m * dp)


@kernel
def slope_ratio(z, alpha, c):
    """A = H'/F' at z."""
    _, h, dg, dh = generator_slopes(z, alpha, c)
    return 2.0 * (z + h + z * dh) / (1.0 + dg)


@kernel
def slope_ratio_rise(z, D, alpha, c):
    """A(z) - A(z - D) for small D, as the integral of A': no digits cancel."""
    total = 0.0
    for n in range(5):
        x = z - D * GAUSS_X[n]
        _, h, dg, dh, ddg, ddh = second_slopes(x, alpha, c)
        dH, ddH = 2.0 * (x + h + x * dh), 2.0 + 4.0 * dh + 2.0 * x * ddh
        dF = 1.0 + dg
        total += GAUSS_W[n] * (ddH * dF - dH * ddg) / (dF * dF)
    return D * total
