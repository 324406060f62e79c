"""One motion from start to end: regimes, located switches, step-size control, output.

The regime is state: it changes only at a located event.  Events are located by repeating
the step with other lengths until its own end lies on the event, so that the located state
is as accurate as any other step and not an interpolation.
"""

from __future__ import annotations

import numpy as np

from .full_slip import onset, onset_slope, sliding_scale, stick_limit
from .jit import kernel
from .law import OK, contact_length, generator_slopes, stick_length
from .partial_slip import partial_speeds
from .stepper import FULL, PARTIAL, REST, dense, dense_terms, jacobian, step

DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, NOT_CONVERGED = range(5)
NO_EVENT, STICK, SLIP, REVERSAL, AT_REST = range(5)

#: rows of the output: V, omega, x, angle, delta, regime
OUTPUTS = 6
#: step control: local error per step is kept at this share of rtol
_SHARE = 0.1
_D_SHARE = 0.04
_GROW, _SHRINK, _SAFETY = 6.0, 0.1, 0.9
#: beyond this zeta (kappa V < 1e-17) the slow motion is exponential to rounding
_COAST = 1e17
_LOCATE_CAP = 80


@kernel
def start(V, omega, par, u):
    """Put (V, omega) into the unknowns of its regime: (regime, direction, sigma, status)."""
    alpha, c, kappa, mu, j = par
    u[:] = 0.0
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
    delta = abs(slip) / V
    if zeta > _COAST:
        D, status = zeta * (delta / (0.5 * mu / kappa)), OK
    else:
        g, _, _, _ = generator_slopes(zeta, alpha, c)
        _, D, status = stick_length(zeta, zeta + g, delta / (mu * V), alpha, c)
    u[0], u[1] = np.log(zeta), sigma * D
    return PARTIAL, direction, sigma, status


@kernel
def speeds(regime, u0, u1, par):
    """(V, omega, delta) in the frame of the unknowns."""
    if regime == PARTIAL:
        V, delta = partial_speeds(u0, u1, par)
        return V, V * (1.0 + delta), delta
    if regime == REST:
        return 0.0, 0.0, 0.0
    omega = (u0 - u1) / par[4]
    slip = omega - u0
    if u0 == 0.0:
        return u0, omega, np.copysign(np.inf, slip)
    return u0, omega, slip / u0


@kernel
def event_value(event, regime, u, sigma, par, rest):
    """Positive before the event, negative after it."""
    if event == REVERSAL:
        return u[0]
    if event == STICK:
        return onset(u[0], u[1], sigma, par)
    if event == SLIP:
        return 1.0 - abs(u[1]) * np.exp(-u[0])
    V, omega, _ = speeds(regime, u[0], u[1], par)
    return max(abs(V), abs(omega)) - rest


@kernel
def locate(event, regime, u, h, J, sigma, par, rest, K, new):
    """Length of the step whose end lies on the event, by the Illinois method; fills ``new``."""
    low, high = 0.0, h
    at_low = event_value(event, regime, u, sigma, par, rest)
    at_high = event_value(event, regime, new, sigma, par, rest)
    side = 0
    for _ in range(_LOCATE_CAP):
        if high - low <= 4e-16 * high or at_high == 0.0:
            break
        middle = (at_low * high - at_high * low) / (at_low - at_high)
        if not (low < middle < high):
            middle = 0.5 * (low + high)
            if not (low < middle < high):
                break
        step(regime, u, middle, J, sigma, par, K, new)
        value = event_value(event, regime, new, sigma, par, rest)
        if value > 0.0:
            low, at_low = middle, value
            if side == 1:
                at_high *= 0.5
            side = 1
        else:
            high, at_high = middle, value
            if side == -1:
                at_low *= 0.5
            side = -1
    step(regime, u, high, J, sigma, par, K, new)
    return high


@kernel
def first_event(regime, u, h, J, sigma, par, rest, K, new):
    """(event, length): the first event within the step, if any, with ``new`` on it."""
    event = NO_EVENT
    if regime == FULL:
        if new[0] < 0.0:
            h = locate(REVERSAL, regime, u, h, J, sigma, par, rest, K, new)
            event = REVERSAL
            new[0] = 0.0
        if onset(new[0], new[1], sigma, par) < 0.0:
            h = locate(STICK, regime, u, h, J, sigma, par, rest, K, new)
            event = STICK
        elif event == NO_EVENT and dips(u, new, h, sigma, par):
            return STICK, -1.0
    elif abs(new[1]) >= np.exp(new[0]):
        h = locate(SLIP, regime, u, h, J, sigma, par, rest, K, new)
        event = SLIP
    if rest > 0.0 and event_value(AT_REST, regime, new, sigma, par, rest) < 0.0:
        h = locate(AT_REST, regime, u, h, J, sigma, par, rest, K, new)
        event = AT_REST
    return event, h


@kernel
def dips(u, new, h, sigma, par):
    """Whether the onset function may have gone below zero and back within the step."""
    before = onset_slope(u[0], u[1], sigma, par)
    after = onset_slope(new[0], new[1], sigma, par)
    if not (before < 0.0 < after):
        return False
    lowest = onset(u[0], u[1], sigma, par) + 0.5 * before * h * before / (before - after)
    return lowest < 0.0


@kernel
def error_norm(regime, u, new, K, travelled, rtol, par):
    """Largest local error over its weight; <= 1 is acceptable."""
    D_error = abs(K[7, 1])
    if regime == FULL:
        worst = abs(K[7, 0]) / sliding_scale(new[0], new[1], par)
    else:
        # D matters through omega - V = mu V^2 d, a small part of omega, and through V',
        # whose error y carries: it is held more loosely, relative to itself and, near its
        # zero, to a small part of the contact
        floor = 1e-4 * np.exp(new[0])
        worst = max(abs(K[7, 0]), _D_SHARE * D_error / (max(abs(new[1]), abs(u[1])) + floor))
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
        mu, j = par[3], par[4]
        slip = abs((u[0] - u[1]) / j - u[0])
        return 0.5 * slip / (mu * (1.0 + 1.0 / j)) + 1e-300
    return 2.0 * rtol ** (1.0 / 5.0) / (abs(J[3]) + abs(J[0]) + 1e-300)


@kernel
def put(out, column, direction, regime, V, omega, delta, X, angle, gamma):
    """One output column, back in the frame and units of the caller."""
    out[0, column], out[1, column] = direction * V, direction * omega
    out[2, column], out[3, column] = X / gamma, angle / gamma
    out[4, column], out[5, column] = delta, regime


@kernel
def write_outputs(tau_out, at, tau, h, last, regime, direction, old, new, terms, par, gamma, offset, out):
    """Outputs that fall within the step (or, if ``last``, on its end); returns the next column."""
    while at < tau_out.size and (last or tau_out[at] < tau + h):
        theta = min((tau_out[at] - tau) / h, 1.0) if h > 0.0 else 1.0
        V, omega, delta = speeds(regime, dense(theta, old, new, terms, 0), dense(theta, old, new, terms, 1), par)
        X = offset[0] + direction * dense(theta, old, new, terms, 2)
        angle = offset[1] + direction * dense(theta, old, new, terms, 3)
        put(out, at, direction, regime, V, omega, delta, X, angle, gamma)
        at += 1
    return at


@kernel
def switch(event, regime, direction, sigma, u, par, offset):
    """Enter the regime behind an event: (regime, direction, sigma).  ``offset`` keeps x and angle."""
    for m in range(2):
        offset[m] += direction * u[2 + m]
        u[2 + m] = 0.0
    j = par[4]
    if event == STICK:
        _, zeta = stick_limit(u[0], par)
        u[0], u[1] = np.log(zeta), sigma * zeta
        return PARTIAL, direction, sigma
    if event == SLIP:
        sigma = np.sign(u[1])
        V, omega, _ = speeds(PARTIAL, u[0], u[1], par)
        u[0], u[1] = V, V - j * omega
        return FULL, direction, sigma
    # REVERSAL: V = 0; look from the other side, where V rises
    u[0], u[1] = 0.0, -u[1]
    return FULL, -direction, -sigma


@kernel
def coast(tau_out, at, tau, u, direction, par, gamma, offset, rest, out):
    """Slow motion at vanishing speed, in closed form: V' = -c V/(1 + j), delta/V constant.

    Relative corrections are of the order of kappa V < 1e-17.  Returns (next column, time
    at which the rest threshold is crossed or infinity).
    """
    _, c, _, _, j = par
    rate = c / (1.0 + j)
    V, omega, delta = speeds(PARTIAL, u[0], u[1], par)
    crossing = np.inf
    if rest > 0.0 and rate > 0.0:
        crossing = tau + np.log(max(abs(V), abs(omega)) / rest) / rate
    while at < tau_out.size and tau_out[at] <= crossing:
        decay = np.exp(-rate * (tau_out[at] - tau))
        length = V * (tau_out[at] - tau) if rate == 0.0 else -V * np.expm1(-rate * (tau_out[at] - tau)) / rate
        put(out, at, direction, PARTIAL, V * decay, omega * decay, delta * decay,
            offset[0] + direction * (u[2] + length), offset[1] + direction * (u[3] + length), gamma)  # fmt: skip
        at += 1
    return at, crossing


@kernel
def fill(out, at, x, angle, gamma):
    """Outputs after rest: V = omega = 0 at the place where the threshold was crossed."""
    for column in range(at, out.shape[1]):
        put(out, column, 1.0, REST, 0.0, 0.0, 0.0, x, angle, gamma)


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
    u, new = np.empty(4), np.empty(4)
    K, terms = np.empty((8, 4)), np.zeros((3, 4))
    offset, travelled = np.zeros(2), np.zeros(2)
    regime, direction, sigma, status = start(V0, omega0, par, u)
    steps = turns = at = 0
    onset_time = rest_time = np.nan
    if status != OK:
        return NOT_CONVERGED, steps, turns, onset_time, rest_time
    new[:] = u
    tau = 0.0
    if regime == REST or max(abs(V0), abs(omega0)) < rest:
        fill(out, 0, 0.0, 0.0, gamma)
        return (RESTED if rest > 0.0 else DONE), steps, turns, onset_time, 0.0
    J = jacobian(regime, u[0], u[1], par)
    h = first_length(regime, u, J, rtol, par)
    rejected, stuck = 0, False
    while tau < tau_end or at < tau_out.size:
        if steps >= max_steps:
            return STEP_LIMIT, steps, turns, onset_time, rest_time
        if regime == PARTIAL and u[0] > np.log(_COAST):
            at, crossing = coast(tau_out, at, tau, u, direction, par, gamma, offset, rest, out)
            if at < tau_out.size or crossing <= tau_end:
                rest_time = crossing / gamma
                V, _, _ = speeds(PARTIAL, u[0], u[1], par)
                rate = par[1] / (1.0 + j)
                length = direction * (V - rest) / rate
                fill(out, at, offset[0] + direction * u[2] + length, offset[1] + direction * u[3] + length, gamma)
                return RESTED, steps, turns, onset_time, rest_time
            return DONE, steps, turns, onset_time, rest_time
        event = NO_EVENT
        last = h >= tau_end - tau
        length = tau_end - tau if last else h
        if regime == FULL and not stuck and onset(u[0], u[1], sigma, par) <= 0.0:
            if onset_slope(u[0], u[1], sigma, par) < 0.0:
                event, length = STICK, 0.0
                new[:] = u
        if event == NO_EVENT and length > 0.0:
            step(regime, u, length, J, sigma, par, K, new)
            error = error_norm(regime, u, new, K, travelled, rtol, par)
            steps += 1
            if not error <= 1.0:
                rejected += 1
                if rejected > 60:
                    return STEP_TOO_SMALL, steps, turns, onset_time, rest_time
                h = length * (max(_SHRINK, _SAFETY * error ** (-1.0 / 5.0)) if error < 1e300 else _SHRINK)
                continue
            rejected = 0
            event, length_to = first_event(regime, u, length, J, sigma, par, rest, K, new)
            if length_to < 0.0:
                h = 0.5 * length
                continue
            if event == NO_EVENT:
                h = length * min(_GROW, _SAFETY * (error + 1e-30) ** (-1.0 / 5.0))
            last = last and event == NO_EVENT
            length = length_to
            if at < tau_out.size and (last or tau_out[at] < tau + length):
                dense_terms(K, terms)
        at = write_outputs(
            tau_out, at, tau, length, last, regime, direction, u, new, terms, par, gamma, offset, out
        )
        for m in range(2):
            travelled[m] += abs(new[2 + m] - u[2 + m])
        stuck = event == STICK and length == 0.0
        u[:] = new
        tau = tau_end if last else tau + length
        if steps > 0 and steps <= step_ends.size:
            step_ends[steps - 1] = tau / gamma
        if event == AT_REST:
            for m in range(2):
                offset[m] += direction * u[2 + m]
            fill(out, at, offset[0], offset[1], gamma)
            return RESTED, steps, turns, onset_time, tau / gamma
        if event != NO_EVENT:
            regime, direction, sigma = switch(event, regime, direction, sigma, u, par, offset)
            if event != REVERSAL:
                if turns < switches.shape[0]:
                    switches[turns, 0], switches[turns, 1] = tau / gamma, regime
                turns += 1
                if event == STICK and np.isnan(onset_time):
                    onset_time = tau / gamma
        J = jacobian(regime, u[0], u[1], par)
        if event == STICK or event == SLIP:
            h = first_length(regime, u, J, rtol, par)
        if last:
            break
    return DONE, steps, turns, onset_time, rest_time
