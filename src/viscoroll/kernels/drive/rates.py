"""Rates of a driven motion, in unknowns in which the law is explicit and that pass V = 0.

The unknowns are s = 1/zeta, with V = s lam/(2 kappa), and omega in full slip; in partial slip b = (zeta - eta)/zeta
with the sign of delta, in a frame where V >= 0.  With l = lam/(2 kappa) = V zeta, phi = (F(zeta) - F(eta))/zeta and
U = H'/(2 zeta) = 1 + h/zeta + h',

    s' = V'/(dV/ds)      dV/ds = l lam^2 U      delta = mu l phi sign(b)
    V b' = {(omega' - V')/(mu l) + sign(b) V' [(F'(zeta) - |eta/zeta| F'(eta))/(lam^2 U) - 2 phi]}/F'(eta)

Both sides of the last stay finite as V -> 0, where b follows from the right one being 0.  For |b| > 1 the law is
continued by F(eta) = eta, H(eta) = 0, for b beyond 0 by its own branch, in full slip for s < 0 as odd functions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..material.functions import at_rolling, generator_slopes
from ..motion.partial_slip import slip_differences
from .load import acting

#: 1/zeta that stands for V = 0
TINY = 1e-100


class Rates(NamedTuple):
    """What the equations say at a state.

    s_rate : s'; rate : ``weight`` times the slope of the second unknown
    s_slope, rate_slope : their slopes in the second unknown
    edge : of the stick zone: positive within the regime
    """

    V: float
    omega: float
    delta: float
    Q: float
    M_half_space: float
    M_cylinder: float
    s_rate: float
    rate: float
    weight: float
    s_slope: float
    rate_slope: float
    edge: float


@kernel(inline=True)
def stick_rates(s, b, load, frame, scene):
    """Partial slip."""
    material, kappa, mu, _ = scene
    sign, from_rest = frame.sigma, max(s, 0.0)
    s = max(s, TINY)
    zeta, size = 1.0 / s, sign * b
    g, h, dg, dh, m_half_space, m_cylinder = at_rolling(zeta, material)
    g_eta, h_eta, dg_eta, dh_eta = generator_slopes(zeta * (1.0 - size), material)
    rise_F, rise_H = slip_differences(zeta, size * zeta, g, h, g_eta, h_eta, material)
    phi, square, slope_F = rise_F * s, 1.0 + 2.0 * h * s, 1.0 + dg_eta
    length = 0.5 / (kappa * np.sqrt(square))
    spread = square / (1.0 + h * s + dh)  # 1/(lam^2 U)
    V, delta = from_rest * length, mu * length * sign * phi
    omega = V * (1.0 + delta)
    force, _, torque = acting(V, omega, load, frame)
    Q, M_half_space, M_cylinder = sign * mu * (rise_H * s) / square, V * m_half_space, V * m_cylinder
    V_rate = load.per_V * (Q - M_half_space + force) + load.V_rate
    omega_rate = load.per_omega * (torque - Q - M_cylinder) + load.omega_rate
    per_length = 1.0 / (mu * length)
    bracket = sign * ((1.0 + dg - (1.0 - size) * slope_F) * spread - 2.0 * phi)
    rate = ((omega_rate - V_rate) * per_length + V_rate * bracket) / slope_F
    # slopes in b, for Newton's iteration: F'(eta) is taken as constant
    rest = max(1.0 - size, 0.0)
    Q_b = 2.0 * mu * (rest + (h_eta + rest * zeta * dh_eta) * s) / square
    V_b = load.per_V * Q_b
    rate_b = (-(load.per_omega * Q_b + V_b) * per_length + V_b * bracket) / slope_F + V_rate * (spread - 2.0)
    per_s = spread / length
    return Rates(
        V, omega, delta, Q, M_half_space, M_cylinder, V_rate * per_s, rate, V, V_b * per_s, rate_b, 1.0 - size
    )  # fmt: skip


@kernel(inline=True)
def slip_rates(s, omega, load, frame, scene):
    """Full slip."""
    material, kappa, mu, _ = scene
    size = max(abs(s), TINY)
    g, h, _, dh, m_half_space, m_cylinder = at_rolling(1.0 / size, material)
    square = 1.0 + 2.0 * h * size
    length = 0.5 / (kappa * np.sqrt(square))
    V, Q = s * length, frame.sigma * mu
    force, _, torque = acting(V, omega, load, frame)
    V_rate = load.per_V * (Q - V * m_half_space + force) + load.V_rate
    omega_rate = load.per_omega * (torque - Q - V * m_cylinder) + load.omega_rate
    per_s = square / ((1.0 + h * size + dh) * length)
    slip = omega - V
    edge = frame.sigma * slip - mu * length * (1.0 + g * size) * abs(V)
    delta = slip / V if V != 0.0 else np.copysign(np.inf, slip)
    gains = load.gains
    return Rates(
        V, omega, delta, Q, V * m_half_space, V * m_cylinder, V_rate * per_s, omega_rate, 1.0,
        load.per_V * gains.force_omega * per_s, load.per_omega * gains.torque_omega, edge,
    )  # fmt: skip


@kernel
def rates_at(s, second, load, frame, scene):
    """The equations of the regime."""
    if frame.slips:
        return slip_rates(s, second, load, frame, scene)
    return stick_rates(s, second, load, frame, scene)
