"""States of the contact from the rows of their law: no root, no iteration, and nothing that is not asked for.

With D = 2 kappa |delta|/mu and w = L - D, |Q|/mu = 1 - w^2 press(2 u/w), where 1 = L^2 press(2 u/L) is its neighbour
at slight creep.  There their difference is exact with the mean slope S of press between v1 = 2 u/L and v2 = 2 u/w:

    |Q|/mu = D [(2 L - D) press(v2) - v2 L S]
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .contact_states import read_state, slip_and_creepage, write_field
from .cover import keep_free, kept_free, sliding_creep, slope_over_speed
from .evaluate import (
    H_over_F2,
    H_over_F2_secants,
    body_moments,
    eta_over_F,
    free_creep_and_slopes,
    lam_and_epsilon,
    length_and_moment,
    locate_row,
    moment_factor,
)
from .record import select_material

#: share of L below which D is slight
SMALL_CREEP = 0.125


@kernel(inline=True)
def traction_over_mu(u, L, D, law):
    """|Q|/mu; in full slip D is infinite."""
    w = L - D
    if not w > 0.0:  # or delta_star is further than D by a rounding
        return 1.0
    v = 2.0 * u / w
    at = locate_row(v, law)
    if D >= SMALL_CREEP * L:
        value, _ = H_over_F2(at, v, law)
        part = 1.0 - w * w * value
        if not _cancels(part, D, L):
            return min(part, 1.0)
    value, _, rise, _ = H_over_F2_secants(at, locate_row(2.0 * u / L, law), v, D / w, law)
    return D * ((2.0 * L - D) * value - v * L * rise)


@kernel(inline=True)
def _cancels(part, D, L):
    """Whether |Q|/mu has lost digits by now; up to L/2 v1 and v2 lie in one row or in neighbours."""
    return part < 0.2 and D < 0.5 * L


@kernel(inline=True)
def friction_reserve(u, L, D, law):
    """1 - |Q|/mu, with all its digits where little is left."""
    w = L - D
    if not w > 0.0:
        return 0.0
    v = 2.0 * u / w
    return min(w * w * H_over_F2(locate_row(v, law), v, law)[0], 1.0)


@kernel(inline=True)
def stick_fraction(u, lam, L, D, law):
    """beta."""
    w = L - D
    if not w > 0.0:
        return 0.0
    v = 2.0 * u / w
    return min(eta_over_F(locate_row(v, law), v, law) * w / lam, 1.0) if D > 0.0 else 1.0


@kernel(inline=True)
def traction_slopes(u, L, dL, D, law):
    """Slopes of |Q|/mu in partial slip: over u at fixed delta, and over D; ``dL``: dL/du."""
    w = L - D
    if not w > 0.0:
        return 0.0, 0.0
    v = 2.0 * u / w
    at = locate_row(v, law)
    value, slope = H_over_F2(at, v, law)
    A = value - 0.5 * v * slope
    if D < SMALL_CREEP * L or _cancels(1.0 - w * w * value, D, L):
        x, v1 = D / w, 2.0 * u / L
        _, _, rise, bend = H_over_F2_secants(at, locate_row(v1, law), v, x, law)
        # with A = press - v press'/2, dL/du = -press'/A at v1, and the two terms below are neighbours
        step = v1 * x
        slope_1 = slope - bend * step
        A_1 = value - rise * step - 0.5 * v1 * slope_1
        over_u = step * ((rise - 0.5 * (v * bend + slope_1)) * slope_1 / A_1 - bend)
    else:
        over_u = -(A * dL + slope)
    return 2.0 * w * over_u, 2.0 * w * A


@kernel(inline=True)
def _creep(L, free, state, law):
    """(A number with the sign of Q, the creep that makes Q, D or, in full slip, infinity).

    ``free``: 2 kappa delta_0.
    """
    slip, delta = slip_and_creepage(state)
    slip, delta = sliding_creep(slip, delta, free, state, law.cover_rows)
    full = abs(delta) >= 0.5 * state.mu / state.kappa * L
    return slip, delta, np.inf if full else 2.0 * state.kappa / state.mu * abs(delta)


@kernel(inline=True)
def signed_traction(u, L, free, state, law):
    """Q; ``free``: 2 kappa delta_0."""
    slip, _, D = _creep(L, free, state, law)
    return np.copysign(state.mu * traction_over_mu(u, L, D, law), slip)


@kernel(inline=True)
def Q_slopes(u, L, dL, free, state, law):
    """Slopes of Q: over V at fixed delta or omega, whichever is given; over delta and over omega."""
    _, delta, D = _creep(L, free, state, law)
    if D == np.inf:
        return 0.0, 0.0, 0.0
    over_u, over_D = traction_slopes(u, L, dL, D, law)
    over_delta = 2.0 * state.kappa * over_D
    over_V, over_omega = np.sign(delta) * state.mu * state.kappa * over_u, over_delta / abs(state.V)
    over_V = slope_over_speed(over_V, over_delta, free_creep_and_slopes(u, law)[1], law.cover_rows)
    if state.creep_is_omega:
        over_V -= over_omega * (1.0 + slip_and_creepage(state)[1])
    return over_V, -over_delta if state.V < 0.0 else over_delta, over_omega


@kernel(inline=True)
def _turn(k, asked):
    """(The state whose turn it is, its number, kappa |V|)."""
    n = asked.order[np.uint64(k)] if asked.order.size > 0 else k
    state = read_state(asked.states, n)
    return state, n, state.kappa * abs(state.V)


@kernel(inline=True)
def _of_Q(to):
    """Whether its slopes are asked for."""
    return to.dQ_dV >= 0 or to.dQ_ddelta >= 0 or to.dQ_domega >= 0


@kernel(inline=True)
def _at_speed(k, at, room, law, asked):
    """What depends on the speed alone; L, lam and the slope of L into ``room``."""
    to, (state, n, u) = asked.to, _turn(k, asked)
    here = locate_row(u, law)
    found = length_and_moment(here, u, law)
    way = moment_factor(here, u, found.scale, state)
    room[0, at] = found.L
    keep_free(room, at, here, u, law.cover_rows)
    write_field(to.M, way * found.m, n, asked)
    if to.dM_dV >= 0 or _of_Q(to):  # read again: slopes at hand would be computed though not asked for
        slopes = length_and_moment(here, u, law)
        room[2, at] = slopes.dL
        write_field(to.dM_dV, slopes.d_um, n, asked)
    if to.lam >= 0 or to.zeta >= 0 or to.epsilon >= 0 or to.beta >= 0:
        lam, epsilon = lam_and_epsilon(here, u, law)
        room[1, at] = lam
        write_field(to.lam, lam, n, asked)
        write_field(to.zeta, 0.5 * lam / u, n, asked)
        write_field(to.epsilon, epsilon, n, asked)
    if to.M_half_space >= 0 or to.M_cylinder >= 0 or to.dM_half_space_dV >= 0 or to.dM_cylinder_dV >= 0:
        half_space, cylinder, half_space_rise, cylinder_rise = body_moments(here, u, law)
        write_field(to.M_half_space, way * half_space, n, asked)
        write_field(to.M_cylinder, way * cylinder, n, asked)
        write_field(to.dM_half_space_dV, half_space_rise, n, asked)
        write_field(to.dM_cylinder_dV, cylinder_rise, n, asked)


@kernel(inline=True)
def _at_creep(k, at, room, law, asked):
    """What depends on the creep too."""
    to, (state, n, u) = asked.to, _turn(k, asked)
    L, free = room[0, at], kept_free(room, at, law.cover_rows)
    _, _, D = _creep(L, free, state, law)
    if to.Q >= 0:
        write_field(to.Q, signed_traction(u, L, free, state, law), n, asked)
    if to.beta >= 0:
        write_field(to.beta, stick_fraction(u, room[1, at], L, D, law), n, asked)
    if to.grip >= 0:
        write_field(to.grip, friction_reserve(u, L, D, law), n, asked)
    write_field(to.delta_star, 0.5 * state.mu / state.kappa * L, n, asked)
    write_field(to.delta, slip_and_creepage(state)[1], n, asked)
    write_field(to.delta_0, 0.5 * free / state.kappa, n, asked)
    write_field(to.full_slip, 1.0 if D == np.inf else 0.0, n, asked)
    if _of_Q(to):
        over_V, over_delta, over_omega = Q_slopes(u, L, room[2, at], free, state, law)
        write_field(to.dQ_dV, over_V, n, asked)
        write_field(to.dQ_ddelta, over_delta, n, asked)
        write_field(to.dQ_domega, over_omega, n, asked)


@kernel
def contact_loop(law, asked, room, count):
    """What is asked for of ``count`` states.

    ``room``: for three numbers of some states, four of covers, which wait there: so the processor works on several at
    once; of one state where each has a law of its own, of which one is held at a time.
    """
    for begin in range(0, count, room.shape[1]):
        end = min(begin + room.shape[1], count)
        select_material(law, _turn(begin, asked)[1])
        for k in range(begin, end):
            _at_speed(k, np.uint64(k - begin), room, law, asked)
        for k in range(begin, end):
            _at_creep(k, np.uint64(k - begin), room, law, asked)
