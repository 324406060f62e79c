"""The contact law as printed, over arrays of states; rows and signs as in :mod:`..rows.contact_states`.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.jit import kernel
from ..rows.contact_states import element, read_state, slip_and_creepage, write_field
from .law import OK, direct_contact_length, direct_delta_star, direct_moment, direct_stick, direct_traction


@kernel
def direct_state(alpha, n, request):
    """Evaluate by the equations as printed what is requested of one state; V = 0 is the limit V -> 0+ of Sect. 3.4.

    alpha : float, T_epsilon/T_sigma of the material, >= 1, dimensionless.
    n : int, index of the state, >= 0; not checked.
    request : :class:`..rows.contact_states.Request`: states (V finite), and for each quantity its row of ``out``, -1 if
        it is not requested.  Of lam, zeta, epsilon, delta_star, delta, full_slip (1.0 or 0.0), beta, Q and M those that
        are requested are written into column n + ``first``, dimensionless; other quantities never are.

    Returns the status, an int: OK (0), or NOT_CONVERGED (1) if lam or beta was not found.  The quantities are written
    in that case too, and are not to be used.

    At V = 0: lam = 1, zeta = inf, epsilon = M = 0, beta = 1 - s and |Q| = mu s (2 - s), with s = |delta|/delta_star;
    delta, if omega is given, is 0 for omega = 0 and else infinite.  In full slip, |delta| >= delta_star: beta = 0 and
    |Q| = mu.  M has the sign of V, Q that of omega - V; 0 where that is 0.
    """
    to = request.to
    state = read_state(request.states, n)
    kappa = state.kappa
    mu = state.mu
    speed = abs(state.V)
    slip, delta = slip_and_creepage(state)
    status = stick_status = OK
    lam = 1.0
    zeta = np.inf
    epsilon = M = 0.0
    if speed > 0.0:
        lam, zeta, epsilon, status = direct_contact_length(kappa * speed, alpha)
        M = np.sign(state.V) * direct_moment(kappa, lam, epsilon, zeta, alpha)
    delta_star = direct_delta_star(kappa, mu, lam, epsilon)
    full_slip = abs(delta) >= delta_star
    beta = 0.0
    Q = mu
    if not full_slip and speed == 0.0:
        s = abs(delta) / delta_star
        beta = 1.0 - s
        Q = mu * s * (2.0 - s)
    elif not full_slip:
        beta, stick_status = direct_stick(abs(delta), kappa, mu, lam, epsilon, zeta, alpha)
        Q = direct_traction(beta, abs(delta), kappa, mu, lam, epsilon, zeta)
    write_field(to.lam, lam, n, request)
    write_field(to.zeta, zeta, n, request)
    write_field(to.epsilon, epsilon, n, request)
    write_field(to.delta_star, delta_star, n, request)
    write_field(to.delta, delta, n, request)
    write_field(to.full_slip, 1.0 if full_slip else 0.0, n, request)
    write_field(to.beta, beta, n, request)
    write_field(to.Q, np.sign(slip) * Q, n, request)
    write_field(to.M, M, n, request)
    return max(status, stick_status)


@kernel
def direct_loop(alpha, request, count):
    """Evaluate what is requested of ``count`` states by the equations as printed.

    alpha : T_epsilon/T_sigma, >= 1, dimensionless, (1,), or (count,) with one for each state.
    request : :class:`..rows.contact_states.Request`, as of :func:`direct_state`; column n + ``first`` of ``out`` is
        written for state n.  The states are evaluated in their own order: ``order`` is not read.
    count : int, number of states; 0 writes nothing.

    Returns the status, an int: OK (0), or NOT_CONVERGED (1) if lam or beta of at least one state was not found; all
    states are evaluated and written in that case too.
    """
    worst = OK
    for n in range(count):
        worst = max(worst, direct_state(element(alpha, n), n, request))
    return worst
