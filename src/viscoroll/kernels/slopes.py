"""Second derivatives of the generators and the slope of M, by the Riccati equations alone."""

from __future__ import annotations

from .jit import kernel
from .law import GAUSS_W, GAUSS_X, generator_slopes
from .ratios import ratio_i2, ratio_k, ratio_r, slope_k, slope_r


@kernel
def second_slopes(z, alpha, c):
    """(g, h, g', h', g'', h'') at z, by differentiating the Riccati equations."""
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x = alpha * z
    r, rc = ratio_r(x)
    k, kc = ratio_k(z)
    return _assemble(z, x, r, k, slope_r(x, r, rc), slope_k(z, k, kc), alpha, c)


@kernel
def _assemble(z, x, r, k, s, dk, alpha, c):
    """(g, h, g', h', g'', h'') from the ratios and their slopes s = r', dk = k'."""
    dr = alpha * s
    ddr = alpha * alpha * ((r / x - s) / x - 2.0 * r * s)
    ddk = 2.0 * k * dk + (dk - k / z) / z
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
def at_contact(z, alpha, c):
    """(g, h, g', h', g'', h'', m, m') at z = zeta from one pair of ratios; M = V m."""
    if c == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x = alpha * z
    r, rc = ratio_r(x)
    k, kc = ratio_k(z)
    s = slope_r(x, r, rc)
    dk = slope_k(z, k, kc)
    g, h, dg, dh, ddg, ddh = _assemble(z, x, r, k, s, dk, alpha, c)
    i2 = ratio_i2(x, r)
    lam2 = 1.0 / (1.0 + 2.0 * h / z)
    whole = 1.0 / (1.0 + r * k)
    d_lam2 = -2.0 * lam2 * lam2 * (dh - h / z) / z
    d_i2 = alpha * 2.0 * (r * r - i2) / x
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
