"""The contact law over arrays of states at one material: polynomials for Q and M, no root.

With u = kappa |V|, L(u) = 2 u F(zeta) = 2 kappa delta_star/mu and D = 2 kappa |delta|/mu, Eq. (10)
reads y = F(eta) = w/(2 u) with w = L - D, and Eq. (15)

    Q = mu (1 - w^2 H(eta)/y^2)        or, where D is a small part of L and this would cancel,
    Q = mu Int_0^D 2 w A(w/(2 u)) dD,  A = H'(eta)/(2 y F'(eta)).

A state at the ends of the doubles, or closer to delta_star than :data:`EDGE`, takes the way of :mod:`state`.
"""

from __future__ import annotations

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from .inverses import (
    SLIGHTEST,
    Inverses,
    InversesOfPair,
    at_speed,
    at_stick,
    moments_at_speed,
    slight_traction,
    slightest_traction,
)
from .length import OK
from .state import (
    BETA,
    DELTA,
    DELTA_STAR,
    EPSILON,
    FULL_SLIP,
    LAM,
    M_CYLINDER,
    M_HALF_SPACE,
    ROWS,
    ZETA,
    M,
    Q,
    contact_state,
    creep_ratio,
    signed_slip,
    state_of,
)  # fmt: skip
from .stick import CLOSE

#: kappa |V| that the tables serve: products of the functions stay within the doubles
_SLOWEST, _FASTEST = 1e-100, 1e100
#: least F(eta)/F(zeta) served; below, beta is the small difference of L and D over them
EDGE = 2.0**-20


@kernel(inline=True)
def _put(at, row, value, out, n):
    """A quantity into its row, if it has one."""
    if at[row] >= 0:
        out[at[row], n] = value


@kernel(inline=True)
def _traction(inverses, u, lam, L, D, need, far):
    """(beta, |Q|/mu, status) in partial slip."""
    w, status, beta, part = L - D, OK, 0.0, 0.0
    if far or need.beta:
        share, press, _, status = at_stick(0.5 * w / u, inverses)
        part = 1.0 - w * w * press
        if need.beta:
            beta = min(share * w / lam, 1.0)
    if not far:
        if D <= SLIGHTEST * L:
            part, slight_status = slightest_traction(u, L, D, inverses)
        else:
            part, slight_status = slight_traction(u, L, D, inverses)
        status = max(status, slight_status)
    return beta, min(part, 1.0), status


@kernel(inline=True)
def _from_tables(inverses, state, per, need, at, out, n):
    """(status, whether the tables serve this state): its rows into column n of ``out``.

    ``per`` = (mu/(2 kappa), 2 kappa/mu); ``at``: which row each quantity goes to, -1 for none.
    """
    u = state.kappa * abs(state.V)
    if not _SLOWEST <= u <= _FASTEST:
        return OK, False
    lam, epsilon, L, m, status = at_speed(u, inverses)
    slip, sign, _ = signed_slip(state)
    delta = creep_ratio(state, slip)
    delta_star, D = per[0] * L, per[1] * abs(delta)
    full_slip = abs(delta) >= delta_star
    if need.stick:
        beta, part, stick_status = 0.0, 1.0, OK
        if not full_slip:
            if not L - D >= EDGE * L:
                return OK, False
            beta, part, stick_status = _traction(inverses, u, lam, L, D, need, D > CLOSE * L)
        status = max(status, stick_status)
        _put(at, BETA, beta, out, n)
        _put(at, Q, sign * state.mu * part, out, n)
    _put(at, LAM, lam, out, n)
    if at[ZETA] >= 0:
        out[at[ZETA], n] = 0.5 * lam / u
    _put(at, EPSILON, epsilon, out, n)
    _put(at, DELTA_STAR, delta_star, out, n)
    _put(at, DELTA, delta, out, n)
    _put(at, FULL_SLIP, 1.0 if full_slip else 0.0, out, n)
    _put(at, M, state.V * m, out, n)
    return max(status, _put_parts(u, state.V, inverses, at, out, n)), True


@kernel(inline=True)
def _no_parts(u, V, inverses, at, out, n):
    """Bodies that are alike take half of M each."""
    return OK


@kernel(inline=True)
def _parts_of_pair(u, V, inverses, at, out, n):
    """What either body has in M; returns a status."""
    half_space, cylinder, status = moments_at_speed(u, inverses)
    _put(at, M_HALF_SPACE, V * half_space, out, n)
    _put(at, M_CYLINDER, V * cylinder, out, n)
    return status


_put_parts = by_record(2, (Inverses, _no_parts), (InversesOfPair, _parts_of_pair))


@kernel(allocates=True)
def inverse_loop(inverses, states, need, rows, out, start, stop):
    """``contact_loop`` at one material; no slopes."""
    state, at, worst = np.empty(len(ROWS)), np.full(len(ROWS), -1), OK
    for m in range(rows.size):
        at[rows[m]] = m
    alike, per = states.kappa.size == 1 and states.mu.size == 1, (0.0, 0.0)
    for n in range(start, stop):
        here = state_of(states, n)
        if n == start or not alike:
            per = 0.5 * here.mu / here.kappa, 2.0 * here.kappa / here.mu
        status, served = _from_tables(inverses, here, per, need, at, out, n)
        if not served:
            status = contact_state(inverses.material, here, need, state)
            for m in range(rows.size):
                out[m, n] = state[rows[m]]
        worst = max(worst, status)
    return worst
