"""What peers integrate: rates of Eq. (22) in partial slip, in unknowns that stay good as V -> 0.

Unknowns: y = ln zeta, and D = zeta - eta with the sign of delta; in a frame where V > 0.  The
law is explicit in (zeta, eta), so no equation is solved.  With V -> 0, y grows linearly in time
and D tends to a constant, while omega - V would drown in rounding.  On the slow manifold D is
counted from D0(y), its value there to leading order, beside which it hardly moves.  Time is
tau = gamma t; with a = V'/V = Q/V - M/(2V), d = sign(D) (F(zeta) - F(eta)) = delta/(mu V):

    y' = -2 H/(zeta H') a
    D' = (d' - sign(D) (F'(zeta) - F'(eta)) zeta y')/F'(eta)
    d' = -((1 + 1/j) Q/V + (1/j - 1) M/(2V))/(mu V) - 2 d a
    (D - D0)' = D' - D0'(y) y'

and the distance and the angle turned (times gamma) follow V and omega = V + mu V^2 d.

For eta < 0 the law is continued by F(eta) = eta, H(eta) = 0: then Q = +-mu and d still
measures the slip, so the equations go over into those of full slip without a jump.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscoroll.kernels.compile.jit import kernel

from .standard import at_contact, differences, generator_slopes, generators

#: differences of g and h, which are at most min(zeta, 1/2), lose digits where D is a small
#: part of that: there they are integrated instead
_NEAR = 1e-3


class Scene(NamedTuple):
    """What Eq. (22) asks of a scene."""

    material: Any
    kappa: float
    mu: float
    j: float


@kernel(inline=True)
def leading_order(zeta, b, db, scene):
    """(D0, dD0/d ln zeta): the slow manifold to leading order, linear in D, from b and its slope.

    Q = -M (1 - j)/(2 (1 + j)) with Q = mu D H'/H.
    """
    _, kappa, mu, j = scene
    factor = -(1.0 - j) / (8.0 * (1.0 + j) * kappa * mu)
    return factor * b, factor * (zeta * db)


@kernel
def slow_D(y, scene):
    """(D0, dD0/dy) at y = ln zeta."""
    zeta = np.exp(y)
    _, _, _, _, _, _, b, db = at_contact(zeta, scene.material)
    return leading_order(zeta, b, db, scene)


@kernel(inline=True)
def slip_differences(zeta, D, g, h, g_eta, h_eta, material):
    """(F(zeta) - F(eta), (H(zeta) - H(eta))/zeta) from the generators already at hand."""
    eta = zeta - D
    if eta <= 0.0:
        return zeta + g - eta, zeta + 2.0 * h
    if D < _NEAR * min(zeta, 1.0):
        return differences(zeta, eta, D, material)
    ratio = eta / zeta
    return D + (g - g_eta), (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta)


@kernel(inline=True)
def partial_rates(y, offset, scene):
    """(y', offset', V, delta, d(y', offset', delta)/d offset, D; d offset' to leading order in V)."""
    zeta = np.exp(y)
    contact = at_contact(zeta, scene.material)
    D0, D0_y = leading_order(zeta, contact[6], contact[7], scene)
    D = D0 + offset
    dy, dD, V, delta, _, dy_D, dD_D, delta_D, _ = _rates(zeta, D, np.sign(D), contact, scene)
    return dy, dD - D0_y * dy, V, delta, dy_D, dD_D - D0_y * dy_D, delta_D, D


@kernel(inline=True)
def branch_rates(y, D, sign, scene):
    """:func:`_rates` on the branch of the law with this sign of delta, which goes on through D = 0."""
    zeta = np.exp(y)
    return _rates(zeta, D, sign, at_contact(zeta, scene.material), scene)


@kernel
def stiff_rates(y, D, sign, scene):
    """(y', D', V, delta, d(y', D')/dD) on the branch with this sign of delta, where calls are few; d D' to leading
    order in V."""
    dy, dD, V, delta, _, dy_D, dD_D, _, _ = branch_rates(y, D, sign, scene)
    return dy, dD, V, delta, dy_D, dD_D


@kernel(inline=True)
def _rates(zeta, D, sign, contact, scene):
    """(y', D', V, delta, V'/V, d(y', D', delta)/dD, Q/V); that of D' to leading order in V."""
    material, kappa, mu, j = scene
    g, h, dg, dh, m, _, _, _ = contact
    size = sign * D
    g_eta, h_eta, dg_eta, dh_eta = generator_slopes(zeta - size, material)
    rise_F, rise_H = slip_differences(zeta, size, g, h, g_eta, h_eta, material)
    per = 1.0 / zeta
    square = 1.0 + 2.0 * h * per  # 1/lam^2
    U = 1.0 + h * per + dh  # H'/(2 zeta)
    lam2, per_V = 1.0 / square, 2.0 * kappa * zeta * np.sqrt(square)
    V = 1.0 / per_V
    scale = mu * lam2 * per * per_V
    q_over_V = sign * rise_H * scale
    rate = q_over_V - 0.5 * m
    per_rise = -square / U
    dy = rate * per_rise
    d = sign * rise_F
    dd = -((1.0 + 1.0 / j) * q_over_V + (1.0 / j - 1.0) * 0.5 * m) * (per_V / mu) - 2.0 * d * rate
    slope_F = 1.0 + dg_eta
    per_F = 1.0 / slope_F
    dD = (dd - sign * (dg - dg_eta) * zeta * dy) * per_F
    # dQ/dD = mu H'(eta)/H(zeta)
    eta = max(zeta - size, 0.0)
    stiffness = 2.0 * scale * per * (eta + h_eta + eta * dh_eta)
    dD_D = -(1.0 + 1.0 / j) * stiffness * (per_V / mu) * per_F
    return dy, dD, V, mu * V * d, rate, stiffness * per_rise, dD_D, mu * V * slope_F, q_over_V


@kernel
def creep_speeds(y, D, scene):
    """(V, delta) at y = ln zeta and D."""
    material, kappa, mu, _ = scene
    zeta = np.exp(y)
    g, h = generators(zeta, material)
    g_eta, h_eta = generators(zeta - abs(D), material)
    rise_F, _ = slip_differences(zeta, abs(D), g, h, g_eta, h_eta, material)
    V = 1.0 / (np.sqrt(1.0 + 2.0 * h / zeta) * 2.0 * kappa * zeta)
    return V, np.sign(D) * mu * V * rise_F
