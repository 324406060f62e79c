"""Rates of a motion in unknowns in which the law is explicit and that pass V = 0; all slopes exact.

In full slip they are V and omega; in partial slip V and d = delta/delta_star, in a frame where V >= 0.  On rows of the
law (:mod:`..rows`), with k = mu/(2 kappa), u = kappa V, delta_star = k L(u), w = (1 - |d|) L, s = sign d,

    omega = V (1 + k L d)      Q = s mu [1 - w^2 press(2 u/w)]      V d' = [(omega' - V')/k - d (L + u L') V']/L

On a cover of finite thickness delta = delta_0(u) + k L d: delta_0 V is added to omega, and to V' in the last line its
slope (:mod:`..rows.cover`); half-spaces are compiled without it.

Both sides of the last stay finite as V -> 0, where d follows from the right one being 0.  For |d| > 1 the law is
continued by Q = s mu, for d beyond 0 by its own branch, in full slip for V < 0 as odd functions.

In partial slip a law may add N V' to M, half of it in either body: with n = gamma N the equations are

    (1 + n/2) V' = Q - M/2 + f      j omega' = -Q - M/2 - n V'/2 + q

and the integral of n over V goes into p, so that p' stays what it is.

p = per_omega V + per_V omega, as V + j omega, is collocated in place of V: p' holds no Q, and so d only by what feeds
speeds back.  dp/dd = per_V V k L is small: Newton's matrix falls into one of p and one of d (:mod:`solve`).  Where
friction is so strong that dp/dV may vanish, V stands for p.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compile.by_reference import by_value
from ..compile.intrinsics import unlikely
from ..compile.jit import kernel
from ..rows.added_mass import added_mass
from ..rows.cover import free_kinematics
from ..rows.evaluate import (
    H_over_F2,
    H_over_F2_secants,
    body_moments,
    free_creep_and_slopes,
    length_and_moment,
    limits_at_rest,
    locate_row,
)
from .load import acting

#: k over the least with which dp/dV may vanish at d = -1, from which on V is collocated
_STRONG = 0.8
#: d from which on Q, as the difference of 1 and what is left to stick, has digits enough
_SLIGHT = 1e-4


class Rates(NamedTuple):
    """What the equations say at a state.

    p, p_rate : what is collocated in place of V, V itself in full slip and under strong friction, and p'
    rate : ``weight`` times the slope of the second unknown
    further : slopes in V and in the second unknown
    """

    omega: float
    Q: float
    M_half_space: float
    M_cylinder: float
    V_rate: float
    p: float
    p_rate: float
    rate: float
    weight: float
    p_V: float
    p_second: float
    p_rate_V: float
    p_rate_second: float
    rate_V: float
    rate_second: float
    weight_V: float


@kernel(inline=True)
def moments_slopes(u, scene):
    """(L, L', L'', M/V of half-space and cylinder, d(u M/V)/du of these) at u = kappa |V|."""
    law = by_value(scene.law)
    at = locate_row(u, law)
    found = length_and_moment(at, u, law)
    m, rise = found.scale * found.m, found.d_um
    if not scene.unlike:
        return found.L, found.dL, found.ddL, 0.5 * m, 0.5 * m, 0.5 * rise, 0.5 * rise
    half_space, cylinder, half_space_rise, cylinder_rise = body_moments(at, u, law)
    share = m / (half_space + cylinder) if m > 0.0 else 1.0  # 1, or z in the fast limit
    return found.L, found.dL, found.ddL, share * half_space, share * cylinder, half_space_rise, cylinder_rise


@kernel
def last_pulls(case):
    """(Moments of half-space and cylinder, force and torque by gains), over V = omega -> 0."""
    _, _, _, half_space, cylinder, _, _ = moments_slopes(0.0, case.scene)
    gains = case.drive.gains
    free = limits_at_rest(case.scene.kappa, by_value(case.scene.law))[1]
    spin = 1.0 + free
    return half_space, cylinder, gains.force_V + gains.force_omega * spin, gains.torque_V + gains.torque_omega * spin


@kernel(inline=True)
def creep_limit(V, scene):
    """delta_star at V."""
    u, law = scene.kappa * abs(V), by_value(scene.law)
    return 0.5 * scene.mu / scene.kappa * length_and_moment(locate_row(u, law), u, law).L


@kernel(inline=True)
def creep_at(V, d, scene):
    """delta at V and d, |d| <= 1."""
    u, law = scene.kappa * abs(V), by_value(scene.law)
    delta = creep_limit(V, scene) * d
    return delta if law.cover_rows is None else delta + 0.5 / scene.kappa * free_creep_and_slopes(u, law)[0]


@kernel(inline=True)
def sliding(slip, V, scene):
    """The slip omega - V beyond that of free rolling."""
    law = by_value(scene.law)
    return (
        slip
        if law.cover_rows is None
        else slip - V * (0.5 / scene.kappa * free_creep_and_slopes(scene.kappa * abs(V), law)[0])
    )


@kernel(inline=True)
def inertia_at(V, scene):
    """(gamma N, its slope over V, its integral)."""
    return added_mass(by_value(scene.law), V, scene.kappa, scene.gamma)


@kernel(inline=True)
def speeds(state, frame, scene):
    """(omega, delta) of a state."""
    if not frame.slips:
        delta = creep_at(state.V, state.second, scene)
        return state.V * (1.0 + delta), delta
    slip = state.second - state.V
    return state.second, slip / state.V if state.V != 0.0 else np.copysign(np.inf, slip)


@kernel(inline=True)
def room(n, j):
    """Positive where the added mass is below 1 + j and leaves half of that, and of the 1 + n/2 of V; 1 without it."""
    return (1.0 - n / (1.0 + j)) * (1.0 + 2.0 * n / min(1.0 + j, 2.0))


@kernel(inline=True)
def edge(V, second, frame, scene):
    """Of the stick zone: positive within the regime."""
    if not frame.slips:
        n, _, _ = inertia_at(V, scene)
        return (1.0 - frame.sigma * second) * room(n, scene.j)
    return frame.sigma * sliding(second - V, V, scene) - creep_limit(V, scene) * abs(V)


@kernel(inline=True)
def strong(load, frame, scene):
    """Whether friction is so strong that V is collocated itself, with Q in its rate."""
    per_V, k = load.per_V, 0.5 * scene.mu / scene.kappa
    return not frame.slips and frame.sigma < 0.0 and k * per_V > _STRONG * (per_V + load.per_omega)


@kernel(inline=True)
def stick_rates(V, d, load, frame, scene):
    """Partial slip."""
    law, mu, sign, k = scene.law, scene.mu, frame.sigma, 0.5 * scene.mu / scene.kappa
    u, turn = scene.kappa * abs(V), scene.kappa if V >= 0.0 else -scene.kappa
    L, dL, ddL, m_half_space, m_cylinder, half_space_rise, cylinder_rise = moments_slopes(u, scene)
    left = max(1.0 - sign * d, 0.0)
    w = left * L
    Q, Q_V, Q_d = sign * mu, 0.0, 0.0
    if w > 0.0:
        v = 2.0 * u / w
        at = locate_row(v, law)
        value, slope = H_over_F2(at, v, law)
        A = value - 0.5 * v * slope
        Q *= 1.0 - w * w * value
        if unlikely(abs(d) < _SLIGHT):  # no digits cancel
            D = abs(d) * L
            value, _, rise, _ = H_over_F2_secants(at, locate_row(2.0 * u / L, law), v, D / w, law)
            Q = math.copysign(mu, d) * D * ((2.0 * L - D) * value - v * L * rise)
        Q_V, Q_d = -2.0 * sign * mu * w * (A * left * dL + slope) * turn, 2.0 * mu * w * L * A
    spread = L + u * dL
    free = free_kinematics(locate_row(u, law), u, scene.kappa, k, spread, law.cover_rows)
    tilt = d + free.aside
    omega, omega_V, omega_d = V * (1.0 + k * L * d + free.creep), 1.0 + k * tilt * spread, k * V * L
    force, _, torque = acting(V, omega, load, frame)
    M_half_space, M_cylinder, gains = V * m_half_space, V * m_cylinder, load.gains
    per_V, per_omega, per_both = load.per_V, load.per_omega, load.per_V * load.per_omega
    force_V, torque_V = gains.force_V + gains.force_omega * omega_V, gains.torque_V + gains.torque_omega * omega_V
    p, p_V, p_d, p_rate_d = per_omega * V + per_V * omega, per_omega + per_V * omega_V, per_V * omega_d, 0.0
    p_rate = per_both * (force + torque - M_half_space - M_cylinder) + per_omega * load.V_rate + per_V * load.omega_rate
    p_rate_V = per_both * (force_V + torque_V - half_space_rise - cylinder_rise)
    V_rate = per_V * (Q - M_half_space + force) + load.V_rate
    V_V, V_d = per_V * (Q_V - half_space_rise + force_V), per_V * (Q_d + gains.force_omega * omega_d)
    torque_d = gains.torque_omega * omega_d
    n, n_V, whole = inertia_at(V, scene)
    if n != 0.0:
        light = 1.0 / (1.0 + 0.5 * per_V * n)
        V_rate *= light
        V_V, V_d, drag = light * (V_V - 0.5 * per_V * n_V * V_rate), light * V_d, 0.5 * n * V_rate
        M_half_space, M_cylinder = M_half_space + drag, M_cylinder + drag
        torque_V, torque_d = torque_V - 0.5 * (n_V * V_rate + n * V_V), torque_d - 0.5 * n * V_d
        p, p_V = p + per_both * whole, p_V + per_both * n
    omega_rate = per_omega * (torque - Q - M_cylinder) + load.omega_rate
    rate = ((omega_rate - V_rate) / k - tilt * spread * V_rate) / L
    turn_V, turn_d = per_omega * (torque_V - Q_V - cylinder_rise), per_omega * (torque_d - Q_d)
    bend = turn * (((2.0 * dL + u * ddL) * d + free.bend) * V_rate + dL * rate)
    if unlikely(strong(load, frame, scene)):
        p, p_rate, p_V, p_d, p_rate_V, p_rate_d = V, V_rate, 1.0, 0.0, V_V, V_d
    return Rates(
        omega, Q, M_half_space, M_cylinder, V_rate, p, p_rate, rate, V, p_V, p_d, p_rate_V, p_rate_d,
        ((turn_V - V_V) / k - tilt * spread * V_V - bend) / L,
        ((turn_d - V_d) / k - spread * (V_rate + tilt * V_d)) / L, 1.0,
    )  # fmt: skip


@kernel(inline=True)
def slip_rates(V, omega, load, frame, scene):
    """Full slip."""
    u, Q = scene.kappa * abs(V), frame.sigma * scene.mu
    _, _, _, m_half_space, m_cylinder, half_space_rise, cylinder_rise = moments_slopes(u, scene)
    force, _, torque = acting(V, omega, load, frame)
    M_half_space, M_cylinder, gains = V * m_half_space, V * m_cylinder, load.gains
    V_rate = load.per_V * (Q - M_half_space + force) + load.V_rate
    omega_rate = load.per_omega * (torque - Q - M_cylinder) + load.omega_rate
    return Rates(
        omega, Q, M_half_space, M_cylinder, V_rate, V, V_rate, omega_rate, 1.0,
        1.0, 0.0, load.per_V * (gains.force_V - half_space_rise), load.per_V * gains.force_omega,
        load.per_omega * (gains.torque_V - cylinder_rise), load.per_omega * gains.torque_omega, 0.0,
    )  # fmt: skip


@kernel(inline=True)
def rates_at(V, second, load, frame, scene):
    """The equations of the regime."""
    if frame.slips:
        return slip_rates(V, second, load, frame, scene)
    return stick_rates(V, second, load, frame, scene)


@kernel
def rates_of(state, load, frame, scene):
    """The same where it is not the innermost loop: compiled once for all."""
    return rates_at(state.V, state.second, load, frame, by_value(scene))
