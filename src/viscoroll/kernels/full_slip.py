"""Right-hand side, Jacobian and onset function of Eq. (22) in full slip.

With sigma = sign(omega - V) fixed, Q = sigma mu, so w = V - j omega is exactly linear in
tau = gamma t and V' = sigma mu - M(V)/2 stands alone.  The onset function is the signed
sigma (omega - V) - delta_star |V|: positive in full slip, through zero where stick begins;
|omega - V| alone could step over the narrow stick band without a change of sign.
"""

from __future__ import annotations

from .jit import kernel
from .law import contact_length, generator_slopes, moment_factor
from .slopes import at_contact


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
def full_jacobian(V, w, par):
    """d(V', w', V, omega)/d(V, w), row by row."""
    alpha, c, kappa, _, j = par
    slope = c
    kappa_V = kappa * abs(V)
    if c > 0.0 and kappa_V >= 1e-17:
        lam, _ = contact_length(kappa_V, alpha, c)
        zeta = lam / (2.0 * kappa_V)
        _, h, _, dh, _, _, m, dm = at_contact(zeta, alpha, c)
        slope = m - zeta * dm / (lam * lam * (1.0 + h / zeta + dh))
    return -0.5 * slope, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0 / j, -1.0 / j


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
def onset(V, w, sigma, par):
    """sigma (omega - V) - delta_star |V|."""
    limit, _ = stick_limit(V, par)
    return sigma * ((V - w) / par[4] - V) - limit


@kernel
def onset_slope(V, w, sigma, par):
    """Rate of change of the onset function in time tau, for V > 0."""
    alpha, c, kappa, mu, j = par
    dV, dw, _, _ = full_rhs(V, w, sigma, par)
    kappa_V = kappa * V
    lam, _ = contact_length(kappa_V, alpha, c)
    slope = 0.5 * mu / kappa
    if c > 0.0 and kappa_V >= 1e-17:
        zeta = lam / (2.0 * kappa_V)
        g, h, dg, dh = generator_slopes(zeta, alpha, c)
        # d(mu V^2 F)/dV = 2 mu V (F - H F'/H')
        slope = 2.0 * mu * V * (zeta + g - 0.5 * zeta * (1.0 + dg) / (lam * lam * (1.0 + h / zeta + dh)))
    return sigma * ((dV - dw) / j - dV) - slope * dV


@kernel
def sliding_scale(V, w, par):
    """Speed that errors of V are measured by: the speed expected at onset, within bounds.

    Sliding alone would keep V + j omega, so onset lies near V = (V + j omega)/(1 + j).
    """
    j = par[4]
    omega = (V - w) / j
    largest = max(abs(V), abs(omega))
    return max(1e-3 * largest, min(largest, abs(V + j * omega) / (1.0 + j)))
