"""States of the contact from the rows of their law: no root, no iteration, and nothing that is not requested.

With D = 2 kappa |delta|/mu and w = L - D, |Q|/mu = 1 - w^2 (H/F^2)(2 u/w), where 1 = L^2 (H/F^2)(2 u/L) is close to it
at small creepage.  There their difference is exact with the mean slope S of H/F^2 between v1 = 2 u/L and v2 = 2 u/w:

    |Q|/mu = D [(2 L - D) (H/F^2)(v2) - v2 L S]

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.jit import inline_kernel, kernel
from .contact_states import read_state, slip_and_creepage, write_field
from .cover import free_creep_at, sliding_creep, slope_over_speed
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
)  # fmt: skip
from .record import select_material

#: Fraction of L below which D is small: |Q|/mu as a difference would lose three bits and more.  A larger one would
#: send states with creep of 0.1 delta_star to the mean slopes, which take half as long again.
SMALL_CREEP = 0.0625


@inline_kernel
def traction_over_mu(u, L, D, law):
    """Return |Q|/mu, the fraction of the friction that is used, in [0, 1].

    u : kappa |V|, dimensionless speed.
    L : 2 kappa delta_star/mu.
    D : 2 kappa |delta|/mu; infinite in full slip.
    law : :class:`Law` of the material: polynomials of each octave.
    """
    w = L - D
    if not w > 0.0:  # also where rounding puts delta_star above D
        return 1.0
    v = 2.0 * u / w
    position = locate_row(v, law)
    if D >= SMALL_CREEP * L:
        value, _ = H_over_F2(position, v, law)
        traction = 1.0 - w * w * value
        if not _cancels(traction, D, L):
            return min(traction, 1.0)
    value, _, secant, _ = H_over_F2_secants(position, locate_row(2.0 * u / L, law), v, D / w, law)
    return D * ((2.0 * L - D) * value - v * L * secant)


@inline_kernel
def _cancels(traction, D, L):
    """Return whether 1 - w^2 H/F^2 has lost digits, so that the mean slope must be used.

    Beyond D = L/2 the two arguments v1 and v2 may be more than one row apart, and the difference stays.

    traction : |Q|/mu as that difference.
    D : 2 kappa |delta|/mu.
    L : 2 kappa delta_star/mu.
    """
    return traction < 0.1 and D < 0.5 * L


@inline_kernel
def friction_reserve(u, L, D, law):
    """Return the friction reserve 1 - |Q|/mu, in [0, 1], with all its digits where it is small.

    u : kappa |V|, dimensionless speed.
    L : 2 kappa delta_star/mu.
    D : 2 kappa |delta|/mu; infinite in full slip.
    law : :class:`Law` of the material: polynomials of each octave.
    """
    w = L - D
    if not w > 0.0:
        return 0.0
    v = 2.0 * u / w
    return min(w * w * H_over_F2(locate_row(v, law), v, law)[0], 1.0)


@inline_kernel
def stick_fraction(u, lam, L, D, law):
    """Return beta, the length of the stick zone divided by the contact length, in [0, 1].

    u : kappa |V|, dimensionless speed.
    lam : length of the contact divided by l0.
    L : 2 kappa delta_star/mu.
    D : 2 kappa |delta|/mu; infinite in full slip.
    law : :class:`Law` of the material: polynomials of each octave.
    """
    w = L - D
    if not w > 0.0:
        return 0.0
    v = 2.0 * u / w
    return min(eta_over_F(locate_row(v, law), v, law) * w / lam, 1.0) if D > 0.0 else 1.0


@inline_kernel
def traction_slopes(u, L, dL, D, law):
    """Return the slopes of |Q|/mu in partial slip with respect to u at fixed delta, and to D.

    u : kappa |V|, dimensionless speed.
    L, dL : 2 kappa delta_star/mu and its slope with respect to u.
    D : 2 kappa |delta|/mu; infinite in full slip.
    law : :class:`Law` of the material: polynomials of each octave.
    Returns (slope in u, slope in D), dimensionless; (0, 0) in full slip.
    """
    w = L - D
    if not w > 0.0:
        return 0.0, 0.0
    v = 2.0 * u / w
    position = locate_row(v, law)
    value, slope = H_over_F2(position, v, law)
    A = value - 0.5 * v * slope
    if D < SMALL_CREEP * L or _cancels(1.0 - w * w * value, D, L):
        x = D / w
        v1 = 2.0 * u / L
        _, _, secant, slope_secant = H_over_F2_secants(position, locate_row(v1, law), v, x, law)
        # with f = H/F^2 and A = f - v f'/2, dL/du = -f'/A at v1, and the two terms below are close
        step = v1 * x
        slope_1 = slope - slope_secant * step
        A_1 = value - secant * step - 0.5 * v1 * slope_1
        over_u = step * ((secant - 0.5 * (v * slope_secant + slope_1)) * slope_1 / A_1 - slope_secant)
    else:
        over_u = -(A * dL + slope)
    return 2.0 * w * over_u, 2.0 * w * A


@inline_kernel
def _split_creep(L, free_creep, state, law):
    """Split the creepage into that of free rolling and the rest, which causes the traction Q.

    L : 2 kappa delta_star/mu.
    free_creep : 2 kappa delta_0, from the creepage of free rolling.
    state : :class:`State`: V, kappa, mu, and delta or omega.
    law : :class:`Law` of the material: polynomials of each octave.

    Returns (slip, creepage, D): a number with the sign of Q; delta - delta_0; 2 kappa |delta - delta_0|/mu, or
    infinity in full slip.
    """
    slip, delta = slip_and_creepage(state)
    slip, delta = sliding_creep(slip, delta, free_creep, state, law.cover_rows)
    full_slip = abs(delta) >= 0.5 * state.mu / state.kappa * L
    return slip, delta, np.inf if full_slip else 2.0 * state.kappa / state.mu * abs(delta)


@inline_kernel
def signed_traction(u, L, free_creep, state, law):
    """Return the traction Q, Eq. (15), divided by the load, with the sign of delta - delta_0.

    u : kappa |V|.
    L : 2 kappa delta_star/mu.
    free_creep : 2 kappa delta_0, from the creepage of free rolling.
    state : :class:`State`: V, kappa, mu, and delta or omega.
    law : :class:`Law` of the material: polynomials of each octave.
    """
    slip, _, D = _split_creep(L, free_creep, state, law)
    return np.copysign(state.mu * traction_over_mu(u, L, D, law), slip)


@inline_kernel
def Q_slopes(u, L, dL, free_creep, state, law):
    """Return the slopes of the traction Q.

    u : kappa |V|.
    L, dL : 2 kappa delta_star/mu and its slope with respect to u.
    free_creep : 2 kappa delta_0, from the creepage of free rolling.
    state : :class:`State`: V, kappa, mu, and delta or omega.
    law : :class:`Law` of the material: polynomials of each octave.
    Returns (dQ/dV, dQ/ddelta, dQ/domega), dimensionless; the first at fixed delta or omega, whichever ``state`` has.
    """
    _, delta, D = _split_creep(L, free_creep, state, law)
    if D == np.inf:
        return 0.0, 0.0, 0.0
    over_u, over_D = traction_slopes(u, L, dL, D, law)
    over_delta = 2.0 * state.kappa * over_D
    over_omega = over_delta / abs(state.V)
    over_V = np.sign(delta) * state.mu * state.kappa * over_u
    over_V = slope_over_speed(over_V, over_delta, free_creep_and_slopes(u, law)[1], law.cover_rows)
    if state.creep_is_omega:
        over_V -= over_omega * (1.0 + slip_and_creepage(state)[1])
    return over_V, -over_delta if state.V < 0.0 else over_delta, over_omega


@inline_kernel
def _next_state(k, request):
    """Return the state at a place in the order of evaluation, with its index and its dimensionless speed.

    k : int, place in that order.
    request : :class:`Request` of states and quantities, with the output array.
    Returns (state, n, u): the :class:`State`; its index, hence its column of the output; kappa |V|, dimensionless.
    """
    n = request.order[np.uint64(k)] if request.order.size > 0 else k
    state = read_state(request.states, n)
    return state, n, state.kappa * abs(state.V)


@inline_kernel
def _requests_Q_slopes(to):
    """Return whether slopes of Q are among the :class:`Fields` ``to``."""
    return max(to.dQ_dV, to.dQ_ddelta, to.dQ_domega) >= 0


@inline_kernel
def _write_functions_of_speed(k, column, buffer, law, request):
    """Write the requested quantities that depend on the speed alone: M, its parts and slopes, lam, zeta, epsilon.

    k : position of the state in the order of ``request``.
    column : column of ``buffer`` for this state.
    buffer : (4, states), in whose column L, lam, dL/du and 2 kappa delta_0 are kept for
        :func:`_write_functions_of_creep`.
    law : :class:`Law` of the material: polynomials of each octave.
    request : :class:`Request` of states and quantities, with the output array, written.
    """
    to = request.to
    state, n, u = _next_state(k, request)
    position = locate_row(u, law)
    functions = length_and_moment(position, u, law)
    factor = moment_factor(position, u, functions.scale, state)
    buffer[0, column] = functions.L
    buffer[3, column] = free_creep_at(position, u, law.cover_rows)[0]
    write_field(to.M, factor * functions.m, n, request)
    if to.dM_dV >= 0 or _requests_Q_slopes(to):
        # evaluated again: otherwise the compiler would compute slopes that are not requested
        slopes = length_and_moment(position, u, law)
        buffer[2, column] = slopes.dL
        write_field(to.dM_dV, slopes.d_um, n, request)
    if max(to.lam, to.zeta, to.epsilon, to.beta) >= 0:
        lam, epsilon = lam_and_epsilon(position, u, law)
        buffer[1, column] = lam
        write_field(to.lam, lam, n, request)
        write_field(to.zeta, 0.5 * lam / u, n, request)
        write_field(to.epsilon, epsilon, n, request)
    if max(to.M_half_space, to.M_cylinder, to.dM_half_space_dV, to.dM_cylinder_dV) >= 0:
        half_space, cylinder, half_space_slope, cylinder_slope = body_moments(position, u, law)
        write_field(to.M_half_space, factor * half_space, n, request)
        write_field(to.M_cylinder, factor * cylinder, n, request)
        write_field(to.dM_half_space_dV, half_space_slope, n, request)
        write_field(to.dM_cylinder_dV, cylinder_slope, n, request)


@inline_kernel
def _write_functions_of_creep(k, column, buffer, law, request):
    """Write the requested quantities that depend on the creepage: Q and its slopes, beta, grip, delta_star and
    others.

    k : position of the state in the order of ``request``.
    column : column of ``buffer`` for this state.
    buffer : (4, states), whose column holds L, lam, dL/du and 2 kappa delta_0 at the speed of this state.
    law : :class:`Law` of the material: polynomials of each octave.
    request : :class:`Request` of states and quantities, with the output array, written.
    """
    to = request.to
    state, n, u = _next_state(k, request)
    L = buffer[0, column]
    free_creep = buffer[3, column]
    _, _, D = _split_creep(L, free_creep, state, law)
    if to.Q >= 0:
        write_field(to.Q, signed_traction(u, L, free_creep, state, law), n, request)
    if to.beta >= 0:
        write_field(to.beta, stick_fraction(u, buffer[1, column], L, D, law), n, request)
    if to.grip >= 0:
        write_field(to.grip, friction_reserve(u, L, D, law), n, request)
    write_field(to.delta_star, 0.5 * state.mu / state.kappa * L, n, request)
    write_field(to.delta, slip_and_creepage(state)[1], n, request)
    write_field(to.delta_0, 0.5 * free_creep / state.kappa, n, request)
    write_field(to.full_slip, 1.0 if D == np.inf else 0.0, n, request)
    if _requests_Q_slopes(to):
        over_V, over_delta, over_omega = Q_slopes(u, L, buffer[2, column], free_creep, state, law)
        write_field(to.dQ_dV, over_V, n, request)
        write_field(to.dQ_ddelta, over_delta, n, request)
        write_field(to.dQ_domega, over_omega, n, request)


@kernel
def contact_loop(law, request, buffer, count):
    """Evaluate the law at ``count`` states and write what is requested.

    law : :class:`Law` of the material: polynomials of each octave.
    request : :class:`Request` of states and quantities, with the output array, written.
    buffer : (4, states), scratch.  Some states are evaluated together, so that the processor works on several at once.
        (4, 1) where each state has a law of its own, of which one is selected at a time.
    count : int, number of states.
    """
    for begin in range(0, count, buffer.shape[1]):
        end = min(begin + buffer.shape[1], count)
        select_material(law, _next_state(begin, request)[1])
        for k in range(begin, end):
            _write_functions_of_speed(k, np.uint64(k - begin), buffer, law, request)
        for k in range(begin, end):
            _write_functions_of_creep(k, np.uint64(k - begin), buffer, law, request)
