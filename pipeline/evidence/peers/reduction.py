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
    factor = -(1.0 - scene.j) / (8.0 * (1.0 + scene.j) * scene.kappa * scene.mu)
    return factor * b, factor * (zeta * db)


@kernel
def slow_D(y, scene):
    """(D0, dD0/dy) at y = ln zeta."""
    zeta = np.exp(y)
    _, _, _, _, _, b, db = at_contact(zeta, scene.material)
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
    """(y', (D - D0)')."""
    material, kappa, mu, j = scene
    zeta = np.exp(y)
    g, h, dg, dh, m, b, db = at_contact(zeta, material)
    D0, D0_y = leading_order(zeta, b, db, scene)
    D = D0 + offset
    sign, size = np.sign(D), abs(D)
    g_eta, h_eta, dg_eta, _ = generator_slopes(zeta - size, material)
    rise_F, rise_H = slip_differences(zeta, size, g, h, g_eta, h_eta, material)
    square = 1.0 + 2.0 * h / zeta  # 1/lam^2
    per_V = 2.0 * kappa * zeta * np.sqrt(square)
    q_over_V = sign * rise_H * mu / square / zeta * per_V
    rate = q_over_V - 0.5 * m
    dy = -rate * square / (1.0 + h / zeta + dh)  # H'/(2 zeta)
    dd = -((1.0 + 1.0 / j) * q_over_V + (1.0 / j - 1.0) * 0.5 * m) * (per_V / mu) - 2.0 * sign * rise_F * rate
    return dy, (dd - sign * (dg - dg_eta) * zeta * dy) / (1.0 + dg_eta) - D0_y * dy


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
