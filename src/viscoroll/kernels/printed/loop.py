"""The contact law as printed, over arrays of states; rows and signs as in :mod:`..rows.contact_states`."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..rows.contact_states import element, read_state, slip_and_creepage, write_field
from .law import OK, direct_contact_length, direct_delta_star, direct_moment, direct_stick, direct_traction


@kernel
def direct_state(alpha, n, asked):
    """What is asked for of state n; V = 0 is the limit of Sect. 3.4."""
    state, to = read_state(asked.states, n), asked.to
    kappa, mu, speed = state.kappa, state.mu, abs(state.V)
    slip, delta = slip_and_creepage(state)
    status = stick_status = OK
    lam, zeta, epsilon, M = 1.0, np.inf, 0.0, 0.0
    if speed > 0.0:
        lam, zeta, epsilon, status = direct_contact_length(kappa * speed, alpha)
        M = np.sign(state.V) * direct_moment(kappa, lam, epsilon, zeta, alpha)
    delta_star = direct_delta_star(kappa, mu, lam, epsilon)
    full_slip, beta, Q = abs(delta) >= delta_star, 0.0, mu
    if not full_slip and speed == 0.0:
        s = abs(delta) / delta_star
        beta, Q = 1.0 - s, mu * s * (2.0 - s)
    elif not full_slip:
        beta, stick_status = direct_stick(abs(delta), kappa, mu, lam, epsilon, zeta, alpha)
        Q = direct_traction(beta, abs(delta), kappa, mu, lam, epsilon, zeta)
    write_field(to.lam, lam, n, asked)
    write_field(to.zeta, zeta, n, asked)
    write_field(to.epsilon, epsilon, n, asked)
    write_field(to.delta_star, delta_star, n, asked)
    write_field(to.delta, delta, n, asked)
    write_field(to.full_slip, 1.0 if full_slip else 0.0, n, asked)
    write_field(to.beta, beta, n, asked)
    write_field(to.Q, np.sign(slip) * Q, n, asked)
    write_field(to.M, M, n, asked)
    return max(status, stick_status)


@kernel
def direct_loop(alpha, asked, count):
    """What is asked for of ``count`` states."""
    worst = OK
    for n in range(count):
        worst = max(worst, direct_state(element(alpha, n), n, asked))
    return worst
