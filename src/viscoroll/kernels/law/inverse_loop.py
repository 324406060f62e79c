"""The contact law over arrays of states at one material: polynomials for Q and M, no root.

With u = kappa |V|, L(u) = 2 u F(zeta) = 2 kappa delta_star/mu and D = 2 kappa |delta|/mu, Eq. (10)
reads y = F(eta) = w/(2 u) with w = L - D, and Eq. (15)

    Q = mu (1 - w^2 H(eta)/y^2)        or, where D is a small part of L and this would cancel,
    Q = mu Int_0^D 2 w A(w/(2 u)) dD,  A = H'(eta)/(2 y F'(eta)).

Slopes, and states at the ends of the doubles, take the way of :mod:`state`.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .inverses import at_speed, at_stick, slight_traction
from .length import OK
from .state import (
    BETA,
    DELTA,
    DELTA_STAR,
    EPSILON,
    FULL_SLIP,
    LAM,
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
#: least F(eta)/F(zeta) served
_EDGE = 2.0**-20


@kernel(inline=True)
def _from_tables(inverses, state, need, out):
    """(status, whether the tables serve this state): its rows into ``out``."""
    u = state.kappa * abs(state.V)
    if not _SLOWEST <= u <= _FASTEST:
        return OK, False
    lam, epsilon, L, m, status = at_speed(u, inverses)
    slip, sign, _ = signed_slip(state)
    delta = creep_ratio(state, slip)
    delta_star = (0.5 * state.mu / state.kappa) * L
    full_slip = abs(delta) >= delta_star
    out[LAM], out[ZETA], out[EPSILON], out[M] = lam, 0.5 * lam / u, epsilon, state.V * m
    out[DELTA_STAR], out[DELTA], out[FULL_SLIP] = delta_star, delta, 1.0 if full_slip else 0.0
    if full_slip or not need.stick:
        out[BETA], out[Q] = 0.0, state.mu * sign
        return status, True
    D = (2.0 * state.kappa / state.mu) * abs(delta)
    w = L - D
    if not w >= _EDGE * L:
        return OK, False
    share, press, _, stick_status = at_stick(0.5 * w / u, inverses)
    out[BETA] = min(share * w / lam, 1.0)
    if D > CLOSE * L:
        part = 1.0 - w * w * press
    else:
        part, stick_status = slight_traction(u, L, D, inverses)
    out[Q] = sign * state.mu * min(part, 1.0)
    return max(status, stick_status), True


@kernel(allocates=True)
def inverse_loop(inverses, states, need, rows, out, start, stop):
    """``contact_loop`` at one material."""
    state, worst = np.empty(len(ROWS)), OK
    for n in range(start, stop):
        here, status, served = state_of(states, n), OK, False
        if not need.slopes:
            status, served = _from_tables(inverses, here, need, state)
        if not served:
            status = contact_state(inverses.material, here, need, state)
        worst = max(worst, status)
        for m in range(rows.size):
            out[m, n] = state[rows[m]]
    return worst
