"""The contact law, explicit in (zeta, eta), and its two inverses.

With p(z) = r(alpha z) k(z), c = (alpha - 1)/alpha and

    g = c p/(1 + p)      h = c r(alpha z)/(1 + p)      F = z + g      H = z^2 + 2 z h

Eqs. (6), (8)-(10), (15), (16) of the paper read, for V > 0 and delta >= 0,

    H(zeta) = 1/(2 kappa V)^2               lam = 2 kappa V zeta        epsilon = g(zeta)/zeta
    delta_star = mu V F(zeta)               F(zeta) - F(eta) = delta/(mu V)      beta = eta/zeta
    Q = mu (1 - H(eta)/H(zeta))             M = V c (lam^2 i2(alpha zeta) + p)/(1 + p)

Nothing here divides by V or squares zeta where that could overflow: the contact length is
solved for lam in [alpha^(-1/2), 1], and H enters as H/z^2 = 1 + 2 h/z = 1/lam^2.
"""

from __future__ import annotations

import numpy as np

from .jit import kernel
from .ratios import ratio_i2, ratio_k, ratio_r, slope_k, slope_r

OK, NOT_CONVERGED = 0, 1
_MAX_NEWTON = 60
#: 5-point Gauss-Legendre rule on [0, 1]
GAUSS_X = np.array([0.046910077030668004, 0.23076534494715845, 0.5, 0.7692346550528415, 0.953089922969332])
GAUSS_W = np.array(
    [0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454]
)
#: below this (zeta - eta)/zeta differences of g and h are integrals of their slopes
CLOSE = 0.1


@kernel
def generators(z, alpha, c):
    """(g, h) at z: epsilon zeta = g, H = z^2 + 2 z h; 0 for z <= 0 (no stick zone)."""
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0
    r, _ = ratio_r(alpha * z)
    k, _ = ratio_k(z)
    p = r * k
    share = c / (1.0 + p)
    return share * p, share * r


@kernel
def generator_slopes(z, alpha, c):
    """(g, h, g', h') at z, all 0 for z <= 0."""
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    x = alpha * z
    r, rc = ratio_r(x)
    k, kc = ratio_k(z)
    dr = alpha * slope_r(x, r, rc)
    dk = slope_k(z, k, kc)
    p = r * k
    dp = dr * k + r * dk
    whole = 1.0 / (1.0 + p)
    share = c * whole
    return share * p, share * r, share * whole * dp, share * whole * (dr - r * r * dk)


@kernel
def contact_length(kappa_V, alpha, c):
    """Eq. (6): lam at kappa |V| >= 0, and a status.

    Root of H(zeta) (2 kappa V)^2 = 1 in lam = 2 kappa V zeta, by Newton on the square root
    of the left side, which is nearly linear in lam, kept inside [alpha^(-1/2), 1].
    """
    if c == 0.0 or kappa_V == 0.0:
        return 1.0, OK
    w = 2.0 * kappa_V
    low, high = 1.0 / np.sqrt(alpha), 1.0
    # lam^2 + 2 w lam h = 1 with h between its limits c alpha zeta/2 and c/2
    start = c * 0.5 * w
    lam = 1.0 / (np.sqrt(1.0 + start * start) + start)
    lam = max(lam, low)
    for _ in range(_MAX_NEWTON):
        z = lam / w
        _, h, _, dh = generator_slopes(z, alpha, c)
        square = lam * (lam + 2.0 * w * h)
        root = np.sqrt(square)
        if square > 1.0:
            high = lam
        else:
            low = lam
        step = (root - 1.0) * root / (lam + w * h + lam * dh)
        new = lam - step
        if not (low <= new <= high):
            new = 0.5 * (low + high)
        if abs(new - lam) <= 4e-9 * lam:
            # quadratic convergence: the step just taken leaves an error near 1e-17
            return new, OK
        lam = new
    return lam, NOT_CONVERGED


@kernel
def differences(zeta, eta, D, alpha, c):
    """(F(zeta) - F(eta), (H(zeta) - H(eta))/zeta) with D = zeta - eta, to full relative accuracy.

    For neighbouring arguments both are integrals of the slopes: no digits cancel.  H comes
    divided by zeta so that nothing underflows at the highest speeds.
    """
    ratio = eta / zeta
    if c == 0.0:
        return D, (1.0 + ratio) * D
    if D > CLOSE * zeta:
        g, h = generators(zeta, alpha, c)
        g_eta, h_eta = generators(eta, alpha, c)
        return D + (g - g_eta), (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta)
    slope_g, slope_zh = 0.0, 0.0
    for n in range(5):
        z = zeta - D * GAUSS_X[n]
        _, h, dg, dh = generator_slopes(z, alpha, c)
        slope_g += GAUSS_W[n] * dg
        slope_zh += GAUSS_W[n] * (h + z * dh)
    return D * (1.0 + slope_g), D * (1.0 + ratio + 2.0 * slope_zh / zeta)


@kernel
def stick_length(zeta, F_zeta, d, alpha, c):
    """Eq. (10): (eta, D = zeta - eta, status) with F(zeta) - F(eta) = d, 0 <= d < F(zeta).

    Solved for D where slip is slight (eta/zeta near 1 keeps its digits in D) and for eta
    where stick is slight.
    """
    if c == 0.0:
        return zeta - d, d, OK
    if d > 0.5 * F_zeta:
        return _eta_of_F(F_zeta - d, zeta, alpha, c)
    return _D_of_d(d, zeta, alpha, c)


@kernel
def _eta_of_F(y, zeta, alpha, c):
    """F(eta) = y by Newton: y - c/2 <= eta <= y."""
    low, high = max(y - 0.5 * c, 0.0), y
    eta = y
    for _ in range(_MAX_NEWTON):
        g, _, dg, _ = generator_slopes(eta, alpha, c)
        excess = (eta - y) + g
        if excess > 0.0:
            high = eta
        else:
            low = eta
        new = eta - excess / (1.0 + dg)
        if not (low <= new <= high):
            new = 0.5 * (low + high)
        if abs(new - eta) <= 4e-9 * new or high <= low:
            return new, zeta - new, OK
        eta = new
    return eta, zeta - eta, NOT_CONVERGED


@kernel
def _D_of_d(d, zeta, alpha, c):
    """D + g(zeta) - g(zeta - D) = d by Newton: d - c/2 <= D <= d."""
    low, high = max(d - 0.5 * c, 0.0), d
    _, _, dg, _ = generator_slopes(zeta, alpha, c)
    D = d / (1.0 + dg)
    for _ in range(_MAX_NEWTON):
        rise, _ = differences(zeta, zeta - D, D, alpha, c)
        if rise > d:
            high = D
        else:
            low = D
        _, _, dg, _ = generator_slopes(zeta - D, alpha, c)
        new = D - (rise - d) / (1.0 + dg)
        if not (low <= new <= high):
            new = 0.5 * (low + high)
        if abs(new - D) <= 4e-9 * new or high <= low:
            return zeta - new, new, OK
        D = new
    return zeta - D, D, NOT_CONVERGED


@kernel
def moment_factor(zeta, lam, alpha, c):
    """M/V of Eq. (16); c as V -> 0.  Every term is positive: nothing cancels."""
    if c == 0.0:
        return 0.0
    x = alpha * zeta
    r, _ = ratio_r(x)
    k, _ = ratio_k(zeta)
    p = r * k
    return c * (lam * lam * ratio_i2(x, r) + p) / (1.0 + p)
