"""One motion from start to end: regimes as state, step-size control, switches, output.

The regime changes only at a located event (:mod:`events`); nothing re-tests it between.
Full slip is :mod:`slide_phase`.  Partial slip is entered through its boundary layer (:mod:`layer_phase`)
and left for the slow manifold (:mod:`slow_phase`); steps are for where one of these two gives up.
"""

from __future__ import annotations

import numpy as np

from .arrays import copy, fill
from .collocation import N
from .control import (
    SHARE,
    creep_weight,
    crossing,
    error_norm,
    first_length,
    halving,
    next_length,
    shorter,
    slip_share,
)  # fmt: skip
from .dop853 import EXTENDED
from .events import AT_REST, EXPLICIT, NO_EVENT, SLIP, STICK, STIFF, advance, first_event, speeds
from .explicit import slope_at
from .full_slip import stick_limit
from .jit import kernel
from .law import OK, generator_slopes, stick_length
from .layer import ROWS
from .layer_phase import layer_phase
from .motion_output import at_rest, coast, put, write_outputs
from .partial_slip import signed_D, slow_D
from .slide import SLIDE_ROWS
from .slide_phase import slide_phase
from .slow import COLUMNS
from .slow_phase import SLOW_REST, slow_phase
from .stepper import FULL, PARTIAL, REST

DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, NOT_CONVERGED = range(5)

#: rejected steps in a row
_MOST_REJECTIONS = 60
#: share of a step below which slip returns at once, and how often that is looked at closer
_AT_ONCE, _MOST_RETRIES = 1e-3, 6
#: step times relaxation rate beyond which the implicit method is cheaper
_STIFF_FROM = 4.0
#: speeds below this count as 0 beside others, and as already rolling among themselves
_TINY = 1e-150
#: least 1/zeta at which stick begins
_LEAST = 1e-300
#: beyond this zeta (kappa V < 1e-17) the slow motion is exponential to rounding
_COAST = 1e17


@kernel
def start(V, omega, par, u):
    """Put (V, omega) into the unknowns of its regime: (regime, direction, sigma, status)."""
    alpha, c, kappa, mu, j = par
    fill(0.0, u)
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
        u[0], u[1] = 1.0 / zeta if V > 0.0 else 0.0, V - j * omega
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
def switch(event, regime, direction, sigma, u, par, offset):
    """Enter the regime behind an event: (regime, direction, sigma).  ``offset`` keeps x and angle."""
    for m in range(2):
        offset[m] += direction * u[2 + m]
        u[2 + m] = 0.0
    j = par[4]
    if event == STICK:
        # both speeds may end at once, to rounding
        u[0] = -np.log(max(u[0], _LEAST))
        u[1] = sigma * np.exp(u[0]) - slow_D(u[0], par)[0]
        return PARTIAL, direction, sigma
    if event == SLIP:
        sigma = np.sign(signed_D(u[0], u[1], par))
        V, omega, _ = speeds(PARTIAL, u[0], u[1], par)
        u[0], u[1] = np.exp(-u[0]), V - j * omega
        return FULL, direction, sigma
    # REVERSAL: V = 0; look from the other side, where V rises
    u[0], u[1] = 0.0, -u[1]
    return FULL, -direction, -sigma


@kernel
def settled(u, slope, share, relaxation, rtol):
    """Whether the boundary layer seems to be over, so that following the slow manifold may be tried."""
    if slope[0] <= 0.0 or relaxation <= 20.0 * slope[0]:
        return False
    if abs(slope[1]) <= 5.0 * slope[0] * abs(u[1]):
        return True
    return abs(slope[1]) * creep_weight(share) * np.exp(-u[0]) <= 10.0 * SHARE * rtol * relaxation


@kernel
def finish_coasting(at, tau_out, tau, u, direction, par, gamma, offset, rest, out):
    """Outputs of the closed form from here on; (status, rest time)."""
    at, crossing = coast(tau_out, at, tau, u, direction, par, gamma, offset, rest, out)
    if crossing > tau_out[tau_out.size - 1]:
        return DONE, np.nan
    V, _, _ = speeds(PARTIAL, u[0], u[1], par)
    length = direction * (V - rest) * (1.0 + par[4]) / par[1]
    at_rest(out, at, offset[0] + direction * u[2] + length, offset[1] + direction * u[3] + length, gamma)
    return RESTED, crossing / gamma


@kernel(allocates=True)
def integrate(alpha, kappa, mu, gamma, j, V0, omega0, t_out, rtol, rest, max_steps, out, switches, step_ends):
    """Roll one motion from t = 0 to t_out[-1]; t_out ascending, out of shape (OUTPUTS, n).

    ``switches`` (k, 2) receives (t, regime behind) of the regime changes, ``step_ends`` the
    times behind the steps and at the nodes of the layer and the slow manifold; what does not fit is not kept.
    Returns (status, steps, switches, onset time, rest time).
    """
    par = (alpha, (alpha - 1.0) / alpha, kappa, mu, j)
    tau_out = t_out * gamma
    tau_end = tau_out[tau_out.size - 1]
    u, new, error, K, terms = np.zeros(4), np.zeros(4), np.zeros(4), np.zeros((EXTENDED, 4)), np.zeros((6, 4))
    slope, offset, travelled = np.zeros(4), np.zeros(2), np.zeros(2)
    work = np.empty((N + 2, COLUMNS)), np.empty((N, N)), np.empty(N), np.empty((5, N + 2))
    nodes, slow = np.empty((max(ROWS, SLIDE_ROWS), N + 1)), np.empty(N + 2)
    steps = turns = at = rejected = ends = 0
    onset_time = rest_time = np.nan
    if max(abs(V0), abs(omega0)) < rest:
        at_rest(out, 0, 0.0, 0.0, gamma)
        return RESTED, steps, turns, onset_time, 0.0
    regime, direction, sigma, start_status = start(V0, omega0, par, u)
    if start_status != OK:
        return NOT_CONVERGED, steps, turns, onset_time, rest_time
    if regime == REST:
        at_rest(out, 0, 0.0, 0.0, gamma)
        return DONE, steps, turns, onset_time, 0.0
    while at < tau_out.size and tau_out[at] == 0.0:
        _, _, delta = speeds(regime, u[0], u[1], par)
        put(out, at, 1.0, regime, V0, omega0, delta, 0.0, 0.0, gamma)
        at += 1
    status, tau, method = DONE, 0.0, EXPLICIT
    wish = length_before = size_before = h = share = relaxation = 0.0
    # alpha = 1: nothing moves on the slow manifold, which both phases need
    layer_ahead, over, try_at = par[1] > 0.0, False, 0.0 if par[1] > 0.0 else np.inf
    if regime == PARTIAL:
        relaxation, share, h = slope_at(u, par, slope), slip_share(u, par), first_length(u, rtol, par)
    while at < tau_out.size:
        if steps >= max_steps or rejected > _MOST_REJECTIONS:
            status = STEP_LIMIT if steps >= max_steps else STEP_TOO_SMALL
            break
        if regime == PARTIAL and u[0] > np.log(_COAST):
            status, rest_time = finish_coasting(at, tau_out, tau, u, direction, par, gamma, offset, rest, out)
            break
        if regime == PARTIAL and layer_ahead:
            layer_ahead = False
            over, tau, at, steps, ends = layer_phase(
                u, tau, tau_out, at, direction, par, gamma, offset, travelled, rtol, rest, max_steps, steps, out,
                step_ends, ends, work, nodes, slow,
            )  # fmt: skip
            relaxation = slope_at(u, par, slope)
            share = slip_share(u, par)
            h = max(h, 0.5 / relaxation) if over else h
            continue
        if regime == PARTIAL and (over or (tau >= try_at and settled(u, slope, share, relaxation, rtol))):
            over = False
            outcome, tau, at, steps, ends, try_at = slow_phase(
                u, tau, tau_out, at, direction, par, gamma, offset, travelled, rtol, rest, np.log(_COAST),
                max_steps, steps, out, step_ends, ends, work,
            )  # fmt: skip
            if outcome == SLOW_REST:
                at_rest(out, at, offset[0] + direction * u[2], offset[1] + direction * u[3], gamma)
                status, rest_time = RESTED, tau / gamma
                break
            relaxation = slope_at(u, par, slope)
            share = slip_share(u, par)
            continue
        event = NO_EVENT
        if regime == FULL:
            event, tau, at, steps, ends = slide_phase(
                u, tau, tau_out, at, direction, sigma, par, gamma, offset, travelled, rtol, rest, max_steps, steps,
                out, step_ends, ends, work[3], nodes,
            )  # fmt: skip
            if event == NO_EVENT:
                rejected = _MOST_REJECTIONS + 1
                continue
        else:
            if not h > 0.0:
                status = STEP_TOO_SMALL
                break
            last, length = h >= tau_end - tau, min(h, tau_end - tau)
            part = half = 1.0
            relaxation_new = advance(method, u, slope, length, par, K, new, error)
            share_new = slip_share(new, par)
            if method == EXPLICIT:
                part = crossing(u, length * slope[1], share, new, length * K[12, 1], share_new, rtol)
                half = halving(share, share_new, length, new, K, rtol)
            size = error_norm(u, new, share_new, error, travelled, rtol)
            steps += 1
            if not size <= 1.0 or part < 1.0 or half < 1.0:
                rejected += 1
                wish = length if size <= 1.0 and part < 1.0 else 0.0
                h = min(part, half) * length
                if half == 1.0:
                    h = min(h, shorter(length, size, method))
                continue
            event, reached = first_event(method, u, slope, length, par, rest, share_new, K, new, error, terms)
            if event == SLIP and reached < _AT_ONCE * length and rejected < _MOST_RETRIES:
                # |D| = zeta at the start may be taken for the end of a stick zone that is shorter than the step
                rejected += 1
                h = 0.1 * length
                continue
            if event == SLIP:
                # the step that was accepted went beyond eta = 0, where the law bends: this one ends there
                share_new = np.sign(share_new)
                size = error_norm(u, new, share_new, error, travelled, rtol)
                half = halving(share, share_new, reached, new, K, rtol) if method == EXPLICIT else 1.0
                if not size <= 1.0 or half < 1.0:
                    rejected += 1
                    h = half * reached if half < 1.0 else shorter(reached, size, method)
                    continue
            rejected = 0
            h = max(wish, next_length(length, size, length_before, size_before, method))
            wish, length_before, size_before = 0.0, length, max(size, 1e-20)
            length = reached
            at = write_outputs(
                tau_out, at, tau, length, last and event == NO_EVENT, method, direction, u, new, slope, K, terms,
                par, gamma, offset, out,
            )  # fmt: skip
            for m in range(2):
                travelled[m] += abs(new[2 + m] - u[2 + m])
            copy(new, u)
            tau += length
            if ends < step_ends.size:
                step_ends[ends] = tau / gamma
                ends += 1
            if event == NO_EVENT:
                copy(K[12], slope)
                relaxation, share = relaxation_new, share_new
                method = STIFF if h * relaxation > (_STIFF_FROM if method == EXPLICIT else 1.0) else EXPLICIT
                continue
        if event == AT_REST:
            at_rest(out, at, offset[0] + direction * u[2], offset[1] + direction * u[3], gamma)
            status, rest_time = RESTED, tau / gamma
            break
        regime, direction, sigma = switch(event, regime, direction, sigma, u, par, offset)
        if event == STICK or event == SLIP:
            if turns < switches.shape[0]:
                switches[turns, 0], switches[turns, 1] = tau / gamma, regime
            turns += 1
        if event == STICK:
            if np.isnan(onset_time):
                onset_time = tau / gamma
            layer_ahead, method, wish, length_before = par[1] > 0.0, EXPLICIT, 0.0, 0.0
            relaxation, share, h = slope_at(u, par, slope), slip_share(u, par), first_length(u, rtol, par)
    return status, steps, turns, onset_time, rest_time
