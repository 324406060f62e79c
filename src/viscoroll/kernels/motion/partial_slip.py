"""Right-hand side and Jacobian of Eq. (22) in partial slip, in unknowns that stay good as V -> 0.

Unknowns: y = ln zeta, and D = zeta - eta with the sign of delta, counted from D0(y), its
value on the slow manifold to leading order; in a frame where V > 0.  The law is explicit in
(zeta, eta), so no equation is solved.  With V -> 0, y grows linearly in time and D tends to
a constant, while omega - V would drown in rounding.  Counted from D0 the stiff unknown
hardly moves once the boundary layer is over, which spares an integrator most of the order
reduction that following a curved manifold costs.  Time is tau = gamma t; with a = V'/V =
Q/V - M/(2V), d = sign(D) (F(zeta) - F(eta)) = delta/(mu V):

    y' = -2 H/(zeta H') a
    D' = (d' - sign(D) (F'(zeta) - F'(eta)) zeta y')/F'(eta)
    d' = -((1 + 1/j) Q/V + (1/j - 1) M/(2V))/(mu V) - 2 d a
    (D - D0)' = D' - D0'(y) y'

and the distance and the angle turned (times gamma) follow V and omega = V + mu V^2 d.

For eta < 0 the law is continued by F(eta) = eta, H(eta) = 0: then Q = +-mu and d still
measures the slip, so the equations go over into those of full slip without a jump.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.material import at_contact, generator_slopes, generators, second_slopes
from ..law.stick import differences

#: differences of g and h, which are at most min(zeta, 1/2), lose digits where D is a small
#: part of that: there they are integrated instead
_NEAR = 1e-3
#: step in y of the one difference quotient, D0'' of the Jacobian
_STEP = 1e-6


@kernel(inline=True)
def leading_order(zeta, h, dh, ddh, m, dm, scene):
    """(D0, dD0/d ln zeta): the slow manifold to leading order, linear in D.

    Q = -M (1 - j)/(2 (1 + j)) with Q = mu D H'/H.
    """
    _, kappa, mu, j = scene
    per = 1.0 / zeta
    share = h * per
    square = 1.0 + 2.0 * share  # 1/lam^2
    U = 1.0 + share + dh  # H'/(2 zeta)
    per_U = 1.0 / U
    bend = (dh - share) * per
    factor = -(1.0 - j) / (8.0 * (1.0 + j) * kappa * mu) * np.sqrt(square) * per_U
    return factor * m, factor * zeta * (dm - m * ((bend + ddh) * per_U - bend / square))


@kernel
def slow_D(y, scene):
    """(D0, dD0/dy) at y = ln zeta."""
    zeta = np.exp(y)
    _, h, _, dh, _, ddh, m, dm = at_contact(zeta, scene.material)
    return leading_order(zeta, h, dh, ddh, m, dm, scene)


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
def partial_rhs(y, offset, scene):
    """(y', offset', V, omega) at y = ln zeta and offset = D - D0(y)."""
    dy, d_offset, V, delta, _, _, _, _, _ = partial_rates(y, offset, scene)
    return dy, d_offset, V, V * (1.0 + delta)


@kernel(inline=True)
def partial_rates(y, offset, scene):
    """(y', offset', V, delta, V'/V, d(y', offset', delta)/d offset, D; d offset' to leading order in V)."""
    zeta = np.exp(y)
    contact = at_contact(zeta, scene.material)
    _, h, _, dh, _, ddh, m, dm = contact
    D0, D0_y = leading_order(zeta, h, dh, ddh, m, dm, scene)
    D = D0 + offset
    dy, dD, V, delta, rate, dy_D, dD_D, delta_D, _ = _rates(zeta, D, np.sign(D), contact, scene)
    return dy, dD - D0_y * dy, V, delta, rate, dy_D, dD_D - D0_y * dy_D, delta_D, D


@kernel(inline=True)
def creep_rates(y, D, scene):
    """(y', D', V, delta) at y = ln zeta and D."""
    dy, dD, V, delta, _, _, _, _, _ = branch_rates(y, D, np.sign(D), scene)
    return dy, dD, V, delta


@kernel(inline=True)
def branch_rates(y, D, sign, scene):
    """:func:`_rates` on the branch of the law with this sign of delta, which goes on through D = 0."""
    zeta = np.exp(y)
    return _rates(zeta, D, sign, at_contact(zeta, scene.material), scene)


@kernel(inline=True)
def linear_rates(y, D, sign, scene):
    """(y', D', V, delta, d(y', delta)/dD) on the branch with this sign of delta."""
    zeta = np.exp(y)
    dy, dD, V, delta, _, dy_D, _, delta_D, _ = _rates(zeta, D, sign, at_contact(zeta, scene.material), scene)
    return dy, dD, V, delta, dy_D, delta_D


@kernel
def stiff_rates(y, D, sign, scene):
    """(y', D', V, delta, d(y', D')/dD) on the branch with this sign of delta; d D' to leading order in V."""
    zeta = np.exp(y)
    dy, dD, V, delta, _, dy_D, dD_D, _, _ = _rates(zeta, D, sign, at_contact(zeta, scene.material), scene)
    return dy, dD, V, delta, dy_D, dD_D


@kernel(inline=True)
def _rates(zeta, D, sign, contact, scene):
    """(y', D', V, delta, V'/V, d(y', D', delta)/dD, Q/V); that of D' to leading order in V."""
    material, kappa, mu, j = scene
    g, h, dg, dh, _, _, m, _ = contact
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
def partial_jacobian(y, offset, scene):
    """d(y', offset', V, omega)/d(y, offset), row by row."""
    material, kappa, mu, j = scene
    zeta = np.exp(y)
    g, h, dg, dh, ddg, ddh, m, dm = at_contact(zeta, material)
    D0, D0_y = leading_order(zeta, h, dh, ddh, m, dm, scene)
    _, after = slow_D(y + _STEP, scene)
    D0_yy = (after - D0_y) / _STEP
    D = D0 + offset
    size = abs(D)
    sign = 1.0 if D >= 0.0 else -1.0
    g_eta, h_eta, dg_eta, dh_eta, ddg_eta, _ = second_slopes(zeta - size, material)
    eta = max(zeta - size, 0.0)
    rise_F, rise_H = slip_differences(zeta, size, g, h, g_eta, h_eta, material)
    lam2 = 1.0 / (1.0 + 2.0 * h / zeta)
    V = np.sqrt(lam2) / (2.0 * kappa * zeta)
    # U = H'/(2 zeta), W = H'(eta)/(2 zeta); H = zeta^2/lam2
    U = 1.0 + h / zeta + dh
    dU = (dh - h / zeta) / zeta + ddh
    W = (eta + h_eta + eta * dh_eta) / zeta if eta > 0.0 else 0.0
    U_less_W = (size * (1.0 + dh_eta) + (h - h_eta) + zeta * (dh - dh_eta)) / zeta if eta > 0.0 else U
    share = rise_H * lam2 / zeta
    share_z = 2.0 * lam2 * (U_less_W - share * U) / zeta
    share_E = 2.0 * lam2 * W / zeta
    inv_V_z = lam2 * U / zeta / V  # d(1/V)/d zeta
    G = sign * mu * share / V
    G_z = sign * mu * (share_z / V + share * inv_V_z)
    G_E = sign * mu * share_E / V
    a = G - 0.5 * m
    a_z = G_z - 0.5 * dm
    dy = -a / (lam2 * U)
    lam2_z = -2.0 * lam2 * lam2 * (dh - h / zeta) / zeta
    dy_z = -a_z / (lam2 * U) - dy * (lam2_z / lam2 + dU / U)
    dy_E = -G_E / (lam2 * U)
    d = sign * rise_F
    d_z = sign * (dg - dg_eta)
    d_E = sign * (1.0 + dg_eta)
    B = (1.0 + 1.0 / j) * G + (1.0 / j - 1.0) * 0.5 * m
    B_z = (1.0 + 1.0 / j) * G_z + (1.0 / j - 1.0) * 0.5 * dm
    B_E = (1.0 + 1.0 / j) * G_E
    N = -B / (mu * V) - 2.0 * d * a - d_z * zeta * dy
    N_z = (
        -(B_z / V + B * inv_V_z) / mu - 2.0 * (d_z * a + d * a_z)
        - sign * (ddg - ddg_eta) * zeta * dy - d_z * (dy + zeta * dy_z)
    )  # fmt: skip
    N_E = -B_E / (mu * V) - 2.0 * (d_E * a + d * G_E) - sign * ddg_eta * zeta * dy - d_z * zeta * dy_E
    slope = 1.0 + dg_eta
    D_z = (N_z - N * ddg_eta / slope) / slope
    D_E = (N_E + N * ddg_eta / slope) / slope
    V_z = -V * V * inv_V_z
    slip_z = mu * V * (2.0 * V_z * d + V * d_z)
    y_y, y_D, D_y, D_D = dy_z * zeta, dy_E * sign, D_z * zeta, D_E * sign
    V_y, w_y, w_D = V_z * zeta, (V_z + slip_z) * zeta, mu * V * V * d_E * sign
    # from D at fixed y to D = D0(y) + offset
    y_y, D_y, w_y = y_y + y_D * D0_y, D_y + D_D * D0_y, w_y + w_D * D0_y
    return y_y, y_D, D_y - D0_yy * dy - D0_y * y_y, D_D - D0_y * y_D, V_y, 0.0, w_y, w_D


@kernel
def signed_D(y, offset, scene):
    """D = sign(delta) (zeta - eta)."""
    D0, _ = slow_D(y, scene)
    return D0 + offset


@kernel
def partial_speeds(y, offset, scene):
    """(V, delta) at y = ln zeta and offset = D - D0(y)."""
    return creep_speeds(y, signed_D(y, offset, scene), scene)


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
