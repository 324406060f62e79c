"""The contact law as printed, over arrays of states; rows and signs as in :mod:`..law.states`."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.states import (
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
    slip_and_creep,
    state_of,
)
from .law import OK, direct_contact_length, direct_delta_star, direct_moment, direct_stick, direct_traction


@kernel
def direct_state(alpha, state, out):
    """All rows of one state into ``out``; V = 0 is the limit of Sect. 3.4."""
    kappa, mu, speed = state.kappa, state.mu, abs(state.V)
    slip, delta = slip_and_creep(state)
    sign = np.sign(slip)
    status = OK
    lam, zeta, epsilon = 1.0, np.inf, 0.0
    out[M] = 0.0
    if speed > 0.0:
        lam, zeta, epsilon, status = direct_contact_length(kappa * speed, alpha)
        out[M] = np.sign(state.V) * direct_moment(kappa, lam, epsilon, zeta, alpha)
    delta_star = direct_delta_star(kappa, mu, lam, epsilon)
    full_slip = abs(delta) >= delta_star
    out[LAM], out[ZETA], out[EPSILON] = lam, zeta, epsilon
    out[DELTA_STAR], out[DELTA], out[FULL_SLIP] = delta_star, delta, 1.0 if full_slip else 0.0
    if full_slip:
        out[BETA], out[Q] = 0.0, mu * sign
        return status
    if speed == 0.0:
        s = abs(delta) / delta_star
        out[BETA], out[Q] = 1.0 - s, mu * sign * s * (2.0 - s)
        return status
    beta, stick_status = direct_stick(abs(delta), kappa, mu, lam, epsilon, zeta, alpha)
    out[BETA] = beta
    out[Q] = sign * direct_traction(beta, abs(delta), kappa, mu, lam, epsilon, zeta)
    return max(status, stick_status)


@kernel(allocates=True)
def direct_loop(alpha, states, rows, out, start, stop):
    """States start..stop; ``rows`` picks the output."""
    state = np.empty(len(ROWS))
    worst = OK
    for i in range(start, stop):
        status = direct_state(alpha[min(i, alpha.size - 1)], state_of(states, i), state)
        worst = max(worst, status)
        for n in range(rows.size):
            out[n, i] = state[rows[n]]
    return worst
