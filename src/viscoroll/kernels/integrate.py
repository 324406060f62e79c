"""One motion from start to end: regimes as state, step-size control, switches, output.

The regime changes only at a located event (:mod:`events`); nothing re-tests it between.
"""

from __future__ import annotations

import numpy as np

from .events import AT_REST, NO_EVENT, REVERSAL, SLIP, STICK, first_event, speeds
from .full_slip import onset, onset_slope, sliding_scale, stick_limit
from .jit import kernel
from .law import OK, generator_slopes, stick_length
from .motion_output import coast, fill, put, write_outputs
from .partial_slip import partial_rhs, signed_D, slow_D
from .stepper import FULL, PARTIAL, REST, dense_terms, jacobian, step

DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, NOT_CONVERGED = range(5)

#: step control: local error per step is kept at this share of rtol
_SHARE = 0.15
_D_SHARE = 0.04
_GROW, _SHRINK, _SAFETY = 6.0, 0.1, 0.9
_MOST_REJECTIONS = 60
#: kappa V below which M(V) is smooth on the scale of V
_BEND = 0.05
#: speeds below this count as 0 beside others, and as already rolling among themselves
_TINY = 1e-150
#: beyond this zeta (kappa V < 1e-17) the slow motion is exponential to rounding
_COAST = 1e17


@kernel
def start(V, omega, par, u):
    """Put (V, omega) into the unknowns of its regime: (regime, direction, sigma, status)."""
    alpha, c, kappa, mu, j = par
    u[:] = 0.0
    if max(abs(V), abs(omega)) < _TINY:
        # sliding ends within a time of that order: V + j omega is kept
        V = omega = (V + j * omega) / (1.0 + j)
    elif abs(V) < _TINY:
        V = 0.0
    if V == 0.0 and omega == 0.0:
        return REST, 1.0, 0.0, OK
    direction = np.sign(V) if V != 0.0 else np.sign(omega)
    V, omega = direction * V, direction * omega
    slip = omega - V
    sigma = 1.0 if slip >= 0.0 else -1.0
    limit, zeta = stick_limit(V, par)
    if V == 0.0 or abs(slip) >= limit:
        u[0], u[1] = V, V - j * omega
        return FULL, direction, sigma, OK
    if zeta > _COAST:
        # the fast transient lasts a time of order V: it is over, V + j omega is kept
        u[0] = -np.log(2.0 * kappa * (V + j * omega) / (1.0 + j))
        u[1] = 0.0
        return PARTIAL, direction, sigma, OK
    g, _, _, _ = generator_slopes(zeta, alpha, c)
    _, D, status = stick_length(zeta, zeta + g, abs(slip) / V / (mu * V), alpha, c)
    u[0] = np.log(zeta)
    u[1] = sigma * D - slow_D(u[0], par)[0]
    return PARTIAL, direction, sigma, status


@kernel
def error_norm(regime, u, new, stick_end, K, travelled, rtol, par):
    """Largest local error over its weight; <= 1 is acceptable.  ``stick_end``: |D|/zeta at ``new``."""
    D_error = abs(K[7, 1])
    if regime == FULL:
        worst = abs(K[7, 0]) / sliding_scale(new[0], new[1], par)
    else:
        # D matters through omega - V = mu V^2 d, a small part of omega, and through V',
        # whose error y carries: it is held more loosely, relative to itself and, near its
        # zero, to a small part of the contact; but not where it decides on the end of stick
        weight = max(_D_SHARE, stick_end * stick_end) / (stick_end + 1e-4)
        worst = max(abs(K[7, 0]), weight * D_error * np.exp(-new[0]))
    for m in range(2):
        span = travelled[m] + abs(new[2 + m] - u[2 + m])
        error = abs(K[7, 2 + m])
        if error > 0.0:
            worst = max(worst, error / span)
    return worst / (_SHARE * rtol)


@kernel
def first_length(regime, u, J, rtol, par):
    """Length of the first step in a regime."""
    if regime == FULL:
        _, _, kappa, mu, j = par
        slip = abs((u[0] - u[1]) / j - u[0])
        length = 0.5 * slip / (mu * (1.0 + 1.0 / j)) + 1e-300
        # M(V) bends at kappa V of order 1: from rest, step first to where that begins
        return length if kappa * abs(u[0]) > _BEND else min(length, _BEND / (kappa * mu))
    # where the stick zone is small the law bends on the scale eta ~ 1/alpha, however large zeta
    _, drift, _, _ = partial_rhs(u[0], u[1], par)
    eta = np.exp(u[0]) - abs(signed_D(u[0], u[1], par))
    scale = max(eta, 0.0) + max(1.0 / par[0], 1e-9 * np.exp(u[0]))
    bend = abs(drift) / scale if par[1] > 0.0 else 0.0
    return 2.0 * rtol ** (1.0 / 5.0) / (abs(J[3]) + abs(J[0]) + bend + 1e-300)


@kernel
def switch(event, regime, direction, sigma, u, par, offset):
    """Enter the regime behind an event: (regime, direction, sigma).  ``offset`` keeps x and angle."""
    for m in range(2):
        offset[m] += direction * u[2 + m]
        u[2 + m] = 0.0
    j = par[4]
    if event == STICK:
        _, zeta = stick_limit(u[0], par)
        u[0] = np.log(zeta)
        u[1] = sigma * zeta - slow_D(u[0], par)[0]
        return PARTIAL, direction, sigma
    if event == SLIP:
        sigma = np.sign(signed_D(u[0], u[1], par))
        V, omega, _ = speeds(PARTIAL, u[0], u[1], par)
        u[0], u[1] = V, V - j * omega
        return FULL, direction, sigma
    # REVERSAL: V = 0; look from the other side, where V rises
    u[0], u[1] = 0.0, -u[1]
    return FULL, -direction, -sigma


@kernel
def leap(u, new, par):
    """Share of a step in full slip that may be kept: V may not fall to under 1/8 in one step
    before it is below the bend of M(V), which the error estimate would not see."""
    if par[1] == 0.0 or par[2] * u[0] < _BEND or new[0] > 0.125 * u[0]:
        return 1.0
    return (u[0] - 0.15 * u[0]) / (u[0] - new[0])


@kernel
def sticks_at_once(u, sigma, par):
    """Whether full slip starts on the edge of the stick band and moves into it."""
    return onset(u[0], u[1], sigma, par) <= 0.0 and onset_slope(u[0], u[1], sigma, par) < 0.0


@kernel
def next_length(length, error):
    """Step length that should meet the tolerance, after one with this error."""
    if not error < 1e300:
        return length * _SHRINK
    return length * max(_SHRINK, min(_GROW, _SAFETY * (error + 1e-30) ** (-1.0 / 5.0)))


@kernel
def finish_coasting(at, tau_out, tau, u, direction, par, gamma, offset, rest, out):
    """Outputs of the closed form from here on; (status, rest time)."""
    at, crossing = coast(tau_out, at, tau, u, direction, par, gamma, offset, rest, out)
    if crossing > tau_out[tau_out.size - 1]:
        return DONE, np.nan
    V, _, _ = speeds(PARTIAL, u[0], u[1], par)
    length = direction * (V - rest) * (1.0 + par[4]) / par[1]
    fill(out, at, offset[0] + direction * u[2] + length, offset[1] + direction * u[3] + length, gamma)
    return RESTED, crossing / gamma


@kernel
def integrate(alpha, kappa, mu, gamma, j, V0, omega0, t_out, rtol, rest, max_steps, out, switches, step_ends):
    """Roll one motion from t = 0 to t_out[-1]; t_out ascending, out of shape (OUTPUTS, n).

    ``switches`` (k, 2) receives (t, regime behind) of the regime changes, ``step_ends`` the
    time behind each accepted step (rejected ones leave their entry as it was); what does not
    fit is counted but not kept.  Returns (status, steps, switches, onset time, rest time).
    """
    par = (alpha, (alpha - 1.0) / alpha, kappa, mu, j)
    tau_out = t_out * gamma
    tau_end = tau_out[tau_out.size - 1]
    u, new, K, terms = np.zeros(4), np.zeros(4), np.empty((8, 4)), np.zeros((3, 4))
    offset, travelled = np.zeros(2), np.zeros(2)
    steps = turns = at = rejected = 0
    onset_time = rest_time = np.nan
    regime, direction, sigma, start_status = start(V0, omega0, par, u)
    if start_status != OK:
        return NOT_CONVERGED, steps, turns, onset_time, rest_time
    if regime == REST or max(abs(V0), abs(omega0)) < rest:
        fill(out, 0, 0.0, 0.0, gamma)
        return (RESTED if rest > 0.0 else DONE), steps, turns, onset_time, 0.0
    while at < tau_out.size and tau_out[at] == 0.0:
        _, _, delta = speeds(regime, u[0], u[1], par)
        put(out, at, 1.0, regime, V0, omega0, delta, 0.0, 0.0, gamma)
        at += 1
    status, tau, just_stuck = DONE, 0.0, False
    J = jacobian(regime, u[0], u[1], par)
    h = first_length(regime, u, J, rtol, par)
    while at < tau_out.size:
        if steps >= max_steps or rejected > _MOST_REJECTIONS:
            status = STEP_LIMIT if steps >= max_steps else STEP_TOO_SMALL
            break
        if regime == PARTIAL and u[0] > np.log(_COAST):
            status, rest_time = finish_coasting(at, tau_out, tau, u, direction, par, gamma, offset, rest, out)
            break
        last = h >= tau_end - tau
        length = tau_end - tau if last else h
        event = NO_EVENT
        if regime == FULL and not just_stuck and sticks_at_once(u, sigma, par):
            event, length, last = STICK, 0.0, False
            new[:] = u
        elif length > 0.0:
            step(regime, u, length, J, sigma, par, K, new)
            stick_end = abs(signed_D(new[0], new[1], par)) * np.exp(-new[0]) if regime == PARTIAL else 0.0
            error = error_norm(regime, u, new, stick_end, K, travelled, rtol, par)
            steps += 1
            if not error <= 1.0:
                rejected += 1
                h = next_length(length, error)
                continue
            kept = leap(u, new, par) if regime == FULL else 1.0
            if kept < 1.0:
                h = kept * length
                continue
            event, reached = first_event(regime, u, length, J, sigma, par, rest, stick_end, K, new)
            if reached < 0.0:
                h = 0.5 * length
                continue
            rejected = 0
            h = next_length(length, error)
            length, last = reached, last and event == NO_EVENT
            if last or tau_out[at] < tau + length:
                dense_terms(K, terms)
        at = write_outputs(tau_out, at, tau, length, last, regime, direction, u, new, terms, par, gamma, offset, out)
        for m in range(2):
            travelled[m] += abs(new[2 + m] - u[2 + m])
        u[:] = new
        tau += length
        if 0 < steps <= step_ends.size:
            step_ends[steps - 1] = tau / gamma
        if event == AT_REST:
            fill(out, at, offset[0] + direction * u[2], offset[1] + direction * u[3], gamma)
            status, rest_time = RESTED, tau / gamma
            break
        just_stuck = event == STICK and length == 0.0
        if event != NO_EVENT:
            regime, direction, sigma = switch(event, regime, direction, sigma, u, par, offset)
            new[:] = u
        J = jacobian(regime, u[0], u[1], par)
        if event == REVERSAL:
            h = min(h, first_length(regime, u, J, rtol, par))
        if event == STICK or event == SLIP:
            if turns < switches.shape[0]:
                switches[turns, 0], switches[turns, 1] = tau / gamma, regime
            turns += 1
            if event == STICK and np.isnan(onset_time):
                onset_time = tau / gamma
            h = first_length(regime, u, J, rtol, par)
    return status, steps, turns, onset_time, rest_time
