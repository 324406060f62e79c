"""Right-hand side and onset function of Eq. (22) in full slip.

With sigma = sign(omega - V) fixed, Q = sigma mu, so w = V - j omega is exactly linear in
tau = gamma t and V' = sigma mu - M(V)/2 stands alone.  The unknown in place of V is
s = 1/zeta with the sign of V, in which the law is explicit: V = s lam/(2 kappa).  The onset
function is the signed sigma (omega - V) - delta_star |V|: positive in full slip, through zero
where stick begins; |omega - V| alone could step over the narrow stick band without a change of sign.
"""

from __future__ import annotations

import numpy as np

from .jit import kernel
from .law import contact_length, generator_slopes, generators, moment_factor
from .ratios import ratio_i2, ratio_k, ratio_r, slope_k, slope_r

#: slip, over the change of slip in a unit of time, from which on it is asked whether V is held; share of rtol by which
#: V may still be off; steps of Newton's iteration, its difference quotient, and its last step
_LONG, _HELD, _NEWTON, _DIFFERENCE, _FOUND = 100.0, 0.1, 30, 1e-5, 1e-13


@kernel
def _moment(V, par):
    """M(V), odd in V, without its slope."""
    alpha, c, kappa, _, _ = par
    if c == 0.0:
        return 0.0
    kappa_V = kappa * abs(V)
    lam, _ = contact_length(kappa_V, alpha, c)
    if kappa_V < 1e-17:
        return c * V
    return V * moment_factor(lam / (2.0 * kappa_V), lam, alpha, c)


@kernel
def full_rhs(V, w, sigma, par):
    """(V', w', V, omega) with w = V - j omega."""
    mu, j = par[3], par[4]
    return sigma * mu - 0.5 * _moment(V, par), 2.0 * sigma * mu, V, (V - w) / j


@kernel
def sliding_rhs(s, w, sigma, par):
    """(s', w', V, omega) with w = V - j omega."""
    alpha, c, kappa, mu, j = par
    if c == 0.0:
        V = s / (2.0 * kappa)
        return 2.0 * kappa * sigma * mu, 2.0 * sigma * mu, V, (V - w) / j
    size = abs(s)
    zeta = 1.0 / size
    x = alpha * zeta
    r, rc = ratio_r(x)
    k, kc = ratio_k(zeta)
    dk = slope_k(zeta, k, kc)
    p = r * k
    whole = 1.0 / (1.0 + p)
    h = c * whole * r
    dh = c * whole * whole * (alpha * slope_r(x, r, rc) - r * r * dk)
    square = 1.0 + 2.0 * h * size  # 1/lam^2
    root = np.sqrt(square)
    V = 0.5 * s / (kappa * root)
    rate = sigma * mu - 0.5 * V * c * whole * (ratio_i2(x, r) / square + p)
    # dV/ds = lam^3 U/(2 kappa), U = H'/(2 zeta)
    return rate * (2.0 * kappa * square * root / (1.0 + h * size + dh)), 2.0 * sigma * mu, V, (V - w) / j


@kernel
def sliding_speed(s, par):
    """V at s."""
    alpha, c, kappa, _, _ = par
    size = abs(s)
    _, h = generators(1.0 / size, alpha, c)
    return 0.5 * s / (kappa * np.sqrt(1.0 + 2.0 * h * size))


@kernel
def stick_limit(V, par):
    """(delta_star |V|, zeta) at V; the stick band is |omega - V| < delta_star |V|."""
    alpha, c, kappa, mu, _ = par
    speed = abs(V)
    kappa_V = kappa * speed
    lam, _ = contact_length(kappa_V, alpha, c)
    zeta = lam / (2.0 * kappa_V)
    g, _, _, _ = generator_slopes(zeta, alpha, c)
    return 0.5 * mu * lam * (1.0 + g / zeta) / kappa * speed, zeta


@kernel
def onset(s, w, sigma, par):
    """sigma (omega - V) - delta_star |V|."""
    alpha, c, kappa, mu, j = par
    size = abs(s)
    g, h = generators(1.0 / size, alpha, c)
    lam = 1.0 / np.sqrt(1.0 + 2.0 * h * size)
    V = 0.5 * s * lam / kappa
    return sigma * ((V - w) / j - V) - 0.5 * mu * lam * (1.0 + g * size) / kappa * abs(V)


@kernel
def onset_slope(s, ds, sigma, par):
    """Rate of change of the onset function in time tau, for V > 0, given s'."""
    alpha, c, kappa, mu, j = par
    g, h, dg, dh = generator_slopes(1.0 / s, alpha, c)
    lam2 = 1.0 / (1.0 + 2.0 * h * s)
    lam = np.sqrt(lam2)
    U = 1.0 + h * s + dh
    dV = 0.5 * lam2 * lam * U * ds / kappa
    # d(mu V^2 F)/dV = 2 mu V (F - H F'/H')
    limit_slope = mu * lam * (1.0 + g * s - 0.5 * (1.0 + dg) / (lam2 * U)) / kappa
    return sigma * ((dV - 2.0 * sigma * mu) / j - dV) - limit_slope * dV


@kernel
def sliding_scale(V, w, par):
    """Speed that errors of V are measured by: the speed expected at onset, within bounds.

    Sliding alone would keep V + j omega, so onset lies near V = (V + j omega)/(1 + j).
    """
    j = par[4]
    omega = (V - w) / j
    largest = max(abs(V), abs(omega))
    return max(1e-3 * largest, min(largest, abs(V + j * omega) / (1.0 + j)))


@kernel
def held(u, slope, sigma, rtol, par):
    """Whether rolling resistance holds V against the traction, M(V) = 2 mu; u and its slope are then put there.

    From a fast spin V comes near that speed in a few relaxation times and stays until the spin is spent.
    """
    _, c, kappa, mu, j = par
    V, omega = slope[2], slope[3]
    if not (sigma > 0.0 and omega - V > _LONG * mu * (1.0 + 1.0 / j)):
        return False
    # M(V) <= c V bends down: Newton's iteration comes from below, or meets no speed at all
    s, change = 4.0 * kappa * mu / c, np.inf
    for _ in range(_NEWTON):
        rise, _, reached, _ = sliding_rhs(s, u[1], sigma, par)
        further, _, _, _ = sliding_rhs(s * (1.0 + _DIFFERENCE), u[1], sigma, par)
        change = rise * _DIFFERENCE * s / (rise - further)
        if not (further < rise and change < s):
            return False
        s += change
        if abs(change) <= _FOUND * s:
            break
    if not abs(change) <= _FOUND * s or abs(V - reached) > _HELD * rtol * sliding_scale(V, u[1], par):
        return False
    u[0] = s
    _, slope[1], slope[2], slope[3] = sliding_rhs(s, u[1], sigma, par)
    slope[0] = 0.0
    return True


@kernel
def held_step(u, h, par, slope, new, error):
    """Full slip at constant V: w is linear in time, the angle quadratic."""
    new[0], new[1], new[2] = u[0], u[1] + h * slope[1], u[2] + h * slope[2]
    new[3] = u[3] + h * (slope[3] - 0.5 * h * slope[1] / par[4])
    for m in range(4):
        error[m] = 0.0


@kernel
def held_terms(u, new, h, K, terms):
    """Coefficients of the dense output of :func:`held_step`: the parabola."""
    for m in range(4):
        terms[0, m] = h * K[0, m] - (new[m] - u[m])
        for row in range(1, 6):
            terms[row, m] = 0.0
