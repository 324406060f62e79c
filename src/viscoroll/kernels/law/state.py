"""One state of the contact by root solves, as motions that are not on rows read it."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import fast_limit, generator_slopes, moment_of
from .length import OK, contact_solution, near_length
from .slopes import slope_ratio, slope_ratio_rise
from .states import creep_ratio, signed_slip
from .stick import CLOSE, stick_solution

#: above this zeta, g <= 1/2 is below rounding beside zeta and the law is Carter's
FAR = 1e17
#: below this zeta, products of r and k underflow, and the law is its limit at high speed to rounding
NEAR = 1e-140
#: below this s = |delta|/delta_star, Q is linear in s to rounding, while zeta - eta may underflow
_LINEAR = 1e-17


@kernel
def stick(speed, delta, mu, solved, delta_star, material):
    """(eta, zeta - eta, beta, |Q|/mu, status) of partial slip at |V| and |delta|; Eqs. (10), (15).

    ``solved``: as of ``contact_solution``.
    """
    lam, zeta, g, h, dg, _ = solved
    s = delta / delta_star
    if material.T_mean == 0.0 or not NEAR <= zeta <= FAR:
        return zeta * (1.0 - s), zeta * s, 1.0 - s, s * (2.0 - s), OK
    if s < _LINEAR:
        _, _, dg, dh = generator_slopes(zeta, material)
        share = s * (1.0 + g / zeta) / (1.0 + dg)  # (zeta - eta)/zeta
        return zeta, share * zeta, 1.0, share * 2.0 * lam * lam * (1.0 + (h + zeta * dh) / zeta), OK
    d = delta / (mu * speed)
    eta, D, dH, status = stick_solution(zeta, g, h, dg, d, material)
    return eta, D, eta / zeta, min(dH * (lam / zeta) * lam, 1.0), status


@kernel
def traction_slopes(delta, state, solved, stuck, material):
    """(d|Q|/d|V| at fixed delta, d|Q|/d|delta|) in partial slip, from what ``stick`` found."""
    lam, zeta, _, _, _, _ = solved
    eta, D, beta, share, _ = stuck
    speed = abs(state.V)
    if material.T_mean == 0.0 or not NEAR <= zeta <= FAR:
        return 0.0, 4.0 * state.kappa * beta / lam
    # A = H'/F' is the slope of H over F; H and A stand here over zeta^2 and zeta
    A, A_eta = slope_ratio(zeta, material) / zeta, slope_ratio(eta, material) / zeta
    H = 1.0 / (lam * lam)
    d = delta / (state.mu * speed * zeta)
    fall = A - A_eta if D > CLOSE * zeta else slope_ratio_rise(zeta, D, material) / zeta
    bracket = -share * H + H * fall / A + 0.5 * A_eta * d
    dQ_dV = -state.mu * 2.0 * lam * lam * bracket / speed
    return dQ_dV, 2.0 * state.kappa * lam * A_eta


@kernel
def loads(material, state):
    """Q and M of one state."""
    kappa, mu, V = state.kappa, state.mu, state.V
    kappa_V = kappa * abs(V)
    solved = contact_solution(near_length(kappa_V, material, 1.0 / np.sqrt(material.alpha)), kappa_V, material)
    lam, zeta, g, h, _, _ = solved
    epsilon, m = g / zeta, material.T_mean
    if zeta < NEAR:
        epsilon, per_zeta = fast_limit(zeta, h, material)
        m = 0.5 * lam / kappa_V * per_zeta
    elif zeta <= FAR:
        m = moment_of(zeta, lam, g, h, material)
    delta_star = 0.5 * mu * lam * (1.0 + epsilon) / kappa
    slip, sign, _ = signed_slip(state)
    delta, share = abs(creep_ratio(state, slip)), 1.0
    if delta < delta_star and not (V == 0.0 and slip != 0.0):
        _, _, _, share, _ = stick(abs(V), delta, mu, solved, delta_star, material)
    return sign * mu * share, m * V
