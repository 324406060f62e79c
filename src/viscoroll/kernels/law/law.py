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

from ..bessel.ratios import ratio_i2, ratio_k, ratio_r, ratios_and_slopes
from ..compile.jit import kernel
from ..numerics.nodes import gauss

OK, NOT_CONVERGED = 0, 1
_MAX_STEPS = 60
#: below this 2 c kappa V the length is that at rest, below this alpha zeta that at high speed, to rounding
_SLOW, _FAST = 1e-17, 1e-9
#: a step of Halley's iteration of this relative size leaves an error of its cube
_CUBED = 3e-6
#: 5-point Gauss-Legendre rule on [0, 1]
GAUSS_X, GAUSS_W = gauss(5)
#: below this (zeta - eta)/zeta differences of g and h are integrals of their slopes
CLOSE = 0.1
#: below this d/F(zeta) zeta - eta starts from the slopes at zeta
_SLIGHT = 1e-4


@kernel(inline=True)
def generators(z, alpha, c):
    """(g, h) at z: epsilon zeta = g, H = z^2 + 2 z h; 0 for z <= 0 (no stick zone)."""
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0
    r, _ = ratio_r(alpha * z)
    k, _ = ratio_k(z)
    p = r * k
    share = c / (1.0 + p)
    return share * p, share * r


@kernel(inline=True)
def generator_slopes(z, alpha, c):
    """(g, h, g', h') at z, all 0 for z <= 0."""
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
def second_slopes(z, alpha, c):
    """(g, h, g', h', g'', h'') at z, by differentiating the Riccati equations."""
    if c == 0.0 or z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    _, r, k, s, dk, per_x, per_z = ratios_and_slopes(z, alpha)
    return assemble(per_z, per_x, r, k, s, dk, alpha, c)


@kernel(inline=True)
def assemble(per_z, per_x, r, k, s, dk, alpha, c):
    """(g, h, g', h', g'', h'') from the ratios and their slopes s = r', dk = k'; per_z = 1/z, per_x = 1/(alpha z)."""
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


@kernel(inline=True)
def near_length(kappa_V, alpha, c, low):
    """lam to some per cent: a step of Newton's iteration with r(x) near x/(rho + x) and k(z) near z/(z + 0.35).

    ``low`` = alpha^(-1/2), the least that it can be.
    """
    w = 2.0 * kappa_V
    # lam^2 + 2 w lam h = 1 with h between its limits c alpha zeta/2 and c/2
    start = c * 0.5 * w
    lam = max(1.0 / (np.sqrt(1.0 + start * start) + start), low)
    z = lam / w
    x = alpha * z
    rho = 0.5 + np.sqrt(x * x + 2.25) - x
    rise = x + x * z / (z + 0.35)
    total = rise + rho
    square = 1.0 + 2.0 * c * alpha / total
    bend = 1.0 - c * alpha * rise / (square * total * total)
    return min(max(lam + (1.0 / np.sqrt(square) - lam) / bend, low), 1.0)


@kernel(inline=True)
def at_an_end(w, low, alpha, c):
    """Whether the length is that at rest, or that at high speed, to rounding."""
    return c * w < _SLOW or alpha * low < _FAST * w


@kernel(inline=True)
def length_step(lam, z, w, per_w, slopes, low, high):
    """One step of Halley's iteration for Eq. (6): (new lam, zeta, g, h, g' there, low, high).

    From ``second_slopes`` at z = lam/w, w = 2 kappa V.  On the square root of
    lam^2 + 2 w lam h(lam/w) = 1, which is nearly linear in lam, kept inside the bracket
    [low, high].  g and h are carried along: they are good where the step was small.
    """
    g, h, dg, dh, ddg, ddh = slopes
    root = np.sqrt(lam * (lam + 2.0 * w * h))
    excess = root - 1.0
    low, high = lam if excess <= 0.0 else low, lam if excess > 0.0 else high
    # slope and second derivative of the square of the root, halved; 1/root to first order in the excess
    slope = lam + w * h + lam * dh
    bend = (1.0 + 2.0 * dh + z * ddh) * root - slope * slope * (1.0 - excess)
    new = lam - 2.0 * excess * slope * root / (2.0 * slope * slope - excess * bend)
    new = new if low <= new <= high else 0.5 * (low + high)
    zeta = new * per_w
    dz = zeta - z
    return new, zeta, g + dz * (dg + 0.5 * dz * ddg), h + dz * (dh + 0.5 * dz * ddh), dg + dz * ddg, low, high


@kernel(inline=True)
def small_step(old, new):
    """Whether a step of Halley's iteration was small enough to be the last."""
    return abs(new - old) <= _CUBED * old


@kernel(inline=True)
def contact_solution(guess, kappa_V, alpha, c):
    """Eq. (6): (lam, zeta, g, h, g', status) at kappa |V| >= 0, from a guess of lam; g' to about 1e-10."""
    w = 2.0 * kappa_V
    low, high = 1.0 / np.sqrt(alpha), 1.0
    if at_an_end(w, low, alpha, c):
        lam = high if c * w < _SLOW else low
        g, h, dg, _ = generator_slopes(lam / w, alpha, c)
        return lam, lam / w, g, h, dg, OK
    lam, per_w = guess, 1.0 / w
    for _ in range(_MAX_STEPS):
        old, z = lam, lam * per_w
        lam, zeta, g, h, dg, low, high = length_step(old, z, w, per_w, second_slopes(z, alpha, c), low, high)
        if small_step(old, lam):
            return lam, zeta, g, h, dg, OK
    return lam, zeta, g, h, dg, NOT_CONVERGED


@kernel
def contact_length(kappa_V, alpha, c):
    """Eq. (6): lam at kappa |V| >= 0, and a status."""
    lam, _, _, _, _, status = contact_solution(near_length(kappa_V, alpha, c, 1.0 / np.sqrt(alpha)), kappa_V, alpha, c)
    return lam, status


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
def stick_length(zeta, d, alpha, c):
    """Eq. (10): (eta, D = zeta - eta, status) with F(zeta) - F(eta) = d, 0 <= d < F(zeta)."""
    g, h, dg, _ = generator_slopes(zeta, alpha, c)
    eta, D, _, status = stick_solution(zeta, g, h, dg, d, alpha, c)
    return eta, D, status


@kernel
def stick_solution(zeta, g, h, dg, d, alpha, c):
    """Eq. (10): (eta, D, (H(zeta) - H(eta))/zeta, status); D = zeta - eta, F(zeta) - F(eta) = d.

    Given are g, h and g' at zeta.  Solved for eta; where slip is slight, so that differences
    cancel, D comes from that, or from the slopes at zeta, by a step of Newton's iteration.
    """
    if c == 0.0:
        return zeta - d, d, (2.0 - d / zeta) * d, OK
    if slight(d, zeta, g):
        _, _, dg, _, ddg, _ = second_slopes(zeta, alpha, c)
        D = d / (1.0 + dg)
        return _sharper(zeta, D * (1.0 + 0.5 * D * ddg / (1.0 + dg)), d, alpha, c)
    y = (zeta + g) - d
    eta, g_eta, h_eta, status = root_of_F(y, near_eta(y, zeta, g, dg), alpha, c)
    eta, D, rise_H = stick_from_root(eta, g_eta, h_eta, zeta, g, h, d, alpha, c)
    return eta, D, rise_H, status


@kernel(inline=True)
def slight(d, zeta, g):
    """Whether slip is so slight that zeta - eta starts from the slopes at zeta."""
    return d <= _SLIGHT * (zeta + g)


@kernel(inline=True)
def stick_from_root(eta, g_eta, h_eta, zeta, g, h, d, alpha, c):
    """``stick_solution`` without its status from the root of F(eta) = F(zeta) - d and g, h there."""
    D = d - (g - g_eta)
    if d <= CLOSE * (zeta + g):
        eta, D, rise_H, _ = _sharper(zeta, D, d, alpha, c)
        return eta, D, rise_H
    ratio = eta / zeta
    return eta, D, (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta)


@kernel
def _sharper(zeta, D, d, alpha, c):
    """``stick_solution`` from D with an error of 1e-7 of D at most."""
    eta = zeta - D
    rise, rise_H = differences(zeta, eta, D, alpha, c)
    _, h, dg, dh = generator_slopes(eta, alpha, c)
    more = (d - rise) / (1.0 + dg)
    return eta - more, D + more, rise_H + 2.0 * more * (eta + h + eta * dh) / zeta, OK


@kernel(inline=True)
def near_eta(y, zeta, g, dg):
    """F^-1(y) with g(z) near A z/(B + z), which has the given value and slope at zeta."""
    curve = g - zeta * dg
    if curve <= 0.0:
        return zeta * (y / (zeta + g))
    B = zeta * zeta * dg / curve
    half = 0.5 * (y - B - g * (zeta + B) / zeta)
    root = np.sqrt(half * half + y * B)
    return half + root if half > 0.0 else y * B / (root - half)


@kernel(inline=True)
def root_bracket(y, c):
    """Bounds of F^-1(y)."""
    low, high = max(y - 0.5 * c, 0.0), y
    return low, high


@kernel(inline=True)
def root_step(eta, y, slopes, low, high):
    """One step of Halley's iteration for F(eta) = y from ``second_slopes``: (new eta, g, h there, low, high)."""
    g, h, dg, dh, ddg, ddh = slopes
    excess = (eta - y) + g
    low, high = eta if excess <= 0.0 else low, eta if excess > 0.0 else high
    slope = 1.0 + dg
    new = eta - 2.0 * excess * slope / (2.0 * slope * slope - excess * ddg)
    new = new if low <= new <= high else 0.5 * (low + high)
    dz = new - eta
    return new, g + dz * (dg + 0.5 * dz * ddg), h + dz * (dh + 0.5 * dz * ddh), low, high


@kernel
def root_of_F(y, guess, alpha, c):
    """F(eta) = y by Halley's iteration: (eta, g, h, status); y - c/2 <= eta <= y, and 0 where y rounds to below it."""
    if y <= 0.0:
        return 0.0, 0.0, 0.0, OK
    low, high = root_bracket(y, c)
    eta = guess
    g, h = 0.0, 0.0
    for _ in range(_MAX_STEPS):
        old = eta
        eta, g, h, low, high = root_step(old, y, second_slopes(old, alpha, c), low, high)
        if small_step(old, eta) or high <= low:
            return eta, g, h, OK
    return eta, g, h, NOT_CONVERGED


@kernel
def moment_factor(zeta, lam, alpha, c):
    """M/V of Eq. (16); c as V -> 0."""
    g, h = generators(zeta, alpha, c)
    return moment_of(zeta, lam, g, h, alpha, c)


@kernel
def moment_of(zeta, lam, g, h, alpha, c):
    """``moment_factor`` from g and h at zeta: p = g/(c - g), r = h/(c - g).  Every term is positive."""
    if c == 0.0:
        return 0.0
    rest = c - g  # c/(1 + p) >= c/2
    return lam * lam * ratio_i2(alpha * zeta, h / rest) * rest + g
