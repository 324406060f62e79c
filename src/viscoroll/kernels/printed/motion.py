"""Eq. (22) on the printed contact law (:mod:`law`): right-hand sides for an independent integrator.

They share neither the law nor the unknowns with :mod:`motion.rates`;
they serve to check motions, not to compute them.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .law import direct_contact_length, direct_delta_star, direct_moment, direct_stick, direct_traction


@kernel
def direct_sliding(V, sigma, alpha, kappa, mu, gamma, j):
    """(V', omega', delta_star |V|) in full slip, sigma the sign of omega - V; any V."""
    speed = abs(V)
    if speed == 0.0:
        return gamma * sigma * mu, -gamma * sigma * mu / j, 0.0
    lam, zeta, epsilon, _ = direct_contact_length(kappa * speed, alpha)
    M = np.sign(V) * direct_moment(kappa, lam, epsilon, zeta, alpha)
    limit = direct_delta_star(kappa, mu, lam, epsilon) * speed
    return gamma * (sigma * mu - 0.5 * M), -gamma / j * (sigma * mu + 0.5 * M), limit


@kernel
def direct_sticking(log_V, delta, alpha, kappa, mu, gamma, j):
    """((ln V)', delta', |delta| - delta_star) in partial slip, V > 0.

    Where |delta| >= delta_star the law of full slip stands: it joins without a jump.
    """
    V = np.exp(log_V)
    size = abs(delta)
    lam, zeta, epsilon, _ = direct_contact_length(kappa * V, alpha)
    M = direct_moment(kappa, lam, epsilon, zeta, alpha)
    delta_star = direct_delta_star(kappa, mu, lam, epsilon)
    Q = mu
    if size < delta_star:
        beta, _ = direct_stick(size, kappa, mu, lam, epsilon, zeta, alpha)
        Q = direct_traction(beta, size, kappa, mu, lam, epsilon, zeta)
    Q = np.copysign(Q, delta) if delta != 0.0 else 0.0
    rate = gamma * (Q - 0.5 * M) / V
    return rate, -gamma * (Q + 0.5 * M) / (j * V) - (1.0 + delta) * rate, size - delta_star
