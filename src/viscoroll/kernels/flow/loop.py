"""Many motions of one scene from its flow map."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.records import DONE, FULL, PARTIAL, REST, RESTED
from ..rows.states import element
from .inside import earlier_entry
from .layout import LAYER_END, MINUS, OCTAVES, PLUS
from .read import (
    HIGHEST,
    LOSS,
    PATH,
    SPEEDS,
    entry_of,
    lambda_at_rest,
    layer_state,
    manifold_at,
    manifold_entry,
    manifold_loss,
    manifold_path,
    manifold_speeds,
    onset_of,
    slide_path,
    slide_to,
    speed_after,
)
from .records import Output, Request, Slide, Stick

NOT_SERVED = -1
#: a start this many times faster than the onset of stick is left to the integrator: V there is a small difference, with
#: an error of 2e-14 of the start
_MOST_LOST = 4096.0
#: rows of the outputs
_V, _OMEGA, _X, _ANGLE, _DELTA, _REGIME, SLIP_LOSS, ROLLING_LOSS, ROWS = range(9)


@kernel(inline=True)
def _write(out, column, state):
    out[_V, column], out[_OMEGA, column], out[_X, column] = state.V, state.omega, state.x
    out[_ANGLE, column], out[_DELTA, column], out[_REGIME, column] = state.angle, state.delta, state.regime
    out[SLIP_LOSS, column] = state.loss


@kernel(inline=True)
def _rest(at, x, angle, loss, out):
    """Outputs at rest from column ``at`` on."""
    for column in range(at, out.shape[1]):
        _write(out, column, Output(0.0, 0.0, x, angle, 0.0, REST, loss))


@kernel(inline=True)
def _sliding(frame, V, omega, start, need, flow):
    """(Its record, its entry into partial slip, whether served) of a motion that slides from V, omega on.

    ``start``: T and X there.
    """
    mu, (T, X) = flow.mu, start
    w = V - flow.j * omega
    V_on, T_on, X_on = onset_of(w - 2.0 * mu * T, need, flow)
    v = flow.kappa * abs(V_on)
    served = 2.0**flow.first <= v < 2.0 ** (flow.first + OCTAVES)
    served = served and flow.kappa * max(abs(V), abs(omega)) <= _MOST_LOST * v
    tau, x = max(T_on - T, 0.0), X_on - X
    angle = (x - tau * (w + mu * tau)) / flow.j
    family, frame_on = (PLUS, frame) if V_on > 0.0 else (MINUS, -frame)
    stick = Stick(frame_on, family, v, tau, frame * x, frame * angle, mu * (angle - x))
    return Slide(frame, w, T, X), stick, served


@kernel
def _inside(V0, omega0, edge, need, flow):
    """(Earlier entry into partial slip, what the map holds of it, whether served) of a start inside the stick zone."""
    frame = 1.0 if V0 > 0.0 else -1.0
    family, v, E, served = earlier_entry(abs(V0), (omega0 - V0) / V0, edge, flow)
    if E > LAYER_END or not served:
        entry = manifold_entry(manifold_at(v, flow.table)[0] if served else 0.0)
        return Stick(frame, family, v, -LAYER_END / entry.rate, 0.0, 0.0, 0.0), entry, served
    entry = entry_of(family, v, need, flow)
    stick = Stick(frame, family, v, -E / entry.rate, 0.0, 0.0, 0.0)
    if E == 0.0 or need < PATH:
        return stick, entry, served
    _, _, x, angle, loss = layer_state(stick, entry, -stick.tau, need, flow)
    return Stick(frame, family, v, stick.tau, -frame * x, -frame * angle, -loss), entry, True


@kernel(inline=True)
def _slide_outputs(at, tau_out, until, slide, need, flow, out):
    """Outputs before stick onset; returns the next column."""
    mu, per_j = flow.mu, 1.0 / flow.j
    frame, w, T0, X0 = slide
    while at < tau_out.size and tau_out[at] < until:
        tau = tau_out[at]
        V = speed_after(T0 + tau, flow)
        omega = (V - (w + 2.0 * mu * tau)) * per_j
        x = angle = 0.0
        if need >= PATH:
            x = slide_path((T0, X0), tau, flow)
            angle = (x - tau * (w + mu * tau)) * per_j
        delta = (omega - V) / V if V != 0.0 else np.inf
        _write(out, at, Output(frame * V, frame * omega, frame * x, frame * angle, delta, FULL, mu * (angle - x)))
        at += 1
    return at


@kernel(inline=True)
def _stick_outputs(at, tau_out, until, stick, entry, need, flow, out):
    """Outputs in partial slip up to ``until``; returns the next column."""
    frame = stick.frame
    to_lose = manifold_loss(entry.lam, flow.table) + entry.loss if need >= LOSS else 0.0
    layer_end = stick.tau + LAYER_END / entry.rate
    while at < tau_out.size and tau_out[at] <= until:
        elapsed = tau_out[at] - stick.tau
        x = angle = loss = 0.0
        if tau_out[at] < layer_end:
            V, delta, x, angle, loss = layer_state(stick, entry, elapsed, need, flow)
        else:
            span = flow.slow_rate * elapsed
            now = entry.lam - span
            V, delta = manifold_speeds(now, flow.table)
            if need >= PATH:
                x, angle = manifold_path(entry.lam, span, flow.slow_rate, flow.table)
                x, angle = x + entry.x, angle + entry.angle
            if need >= LOSS:
                loss = to_lose - manifold_loss(now, flow.table)
        x, angle = stick.x + frame * x, stick.angle + frame * angle
        _write(out, at, Output(frame * V, frame * V * (1.0 + delta), x, angle, delta, PARTIAL, stick.loss + loss))
        at += 1
    return at


@kernel(inline=True)
def _stick(at, tau_out, stick, entry, request, flow, out):
    """(Status, rest time) of a motion from its entry into partial slip to the end."""
    layer_end = stick.tau + LAYER_END / entry.rate
    resting, end = np.inf, tau_out[tau_out.size - 1]
    if request.rest > 0.0:
        resting = stick.tau + (entry.lam - request.rest_lambda) / flow.slow_rate
        if resting < max(layer_end, 0.0):
            return NOT_SERVED, np.nan
    at = _stick_outputs(at, tau_out, min(resting, end), stick, entry, request.need, flow, out)
    if end <= resting:
        return DONE, np.nan
    x, angle = manifold_path(entry.lam, entry.lam - request.rest_lambda, flow.slow_rate, flow.table)
    loss = entry.loss + manifold_loss(entry.lam, flow.table) - manifold_loss(request.rest_lambda, flow.table)
    x, angle = stick.x + stick.frame * (x + entry.x), stick.angle + stick.frame * (angle + entry.angle)
    _rest(at, x, angle, stick.loss + loss, out)
    return RESTED, resting


@kernel(inline=True)
def flow_motion(V0, omega0, tau_out, request, flow, out):
    """One motion in tau = gamma t: (status, onset, rest time); a time is NaN where there is none."""
    kappa, need = flow.kappa, request.need
    if max(abs(V0), abs(omega0)) < request.rest:
        _rest(0, 0.0, 0.0, 0.0, out)
        return RESTED, np.nan, 0.0
    if not kappa * abs(V0) < HIGHEST:
        return NOT_SERVED, np.nan, np.nan
    frame = 1.0 if omega0 >= V0 else -1.0
    V, omega = frame * V0, frame * omega0
    at, first = 0, FULL
    T, X, limit = slide_to(V, need, flow)
    slides_first = omega - V >= limit
    if slides_first:
        slide, stick, served = _sliding(frame, V, omega, (T, X), need, flow)
    else:
        stick, entry, served = _inside(V0, omega0, limit / abs(V), need, flow)
        first = PARTIAL
    if not served or stick.v < 2.0 * kappa * request.rest:
        return NOT_SERVED, np.nan, np.nan
    while at < tau_out.size and tau_out[at] == 0.0:
        _write(out, at, Output(V0, omega0, 0.0, 0.0, (omega0 - V0) / V0 if V0 != 0.0 else np.inf, first, 0.0))
        at += 1
    onset = np.nan
    if slides_first:
        at = _slide_outputs(at, tau_out, stick.tau, slide, need, flow, out)
        if tau_out[tau_out.size - 1] < stick.tau:
            return DONE, np.nan, np.nan
        onset = stick.tau
        entry = entry_of(stick.family, stick.v, need, flow)
    status, resting = _stick(at, tau_out, stick, entry, request, flow, out)
    return status, onset, resting


@kernel(allocates=True)
def flow_loop(flow, gamma, rest, V0, omega0, t, rows, answer, start, stop):
    """Motions start..stop into ``answer``; those that are not served get the status NOT_SERVED and no output.

    ``rows`` picks the output quantities; distance and angle, and the
    energy lost, are found only if they are among them.
    """
    one, tau, j = np.empty((ROWS, t.size)), t * gamma, flow.j
    need = SPEEDS
    for n in range(rows.size):
        need = max(need, PATH if rows[n] == _X or rows[n] == _ANGLE else LOSS if rows[n] >= SLIP_LOSS else SPEEDS)
    request = Request(need, rest, lambda_at_rest(rest, flow) if rest > 0.0 else 0.0)
    for i in range(start, stop):
        V, omega = element(V0, i), element(omega0, i)
        answer.status[i], onset, resting = flow_motion(V, omega, tau, request, flow, one)
        if need >= LOSS:
            for m in range(t.size):
                V_now, omega_now = one[_V, m], one[_OMEGA, m]
                lost = 0.5 * ((V - V_now) * (V + V_now) + j * (omega - omega_now) * (omega + omega_now))
                one[ROLLING_LOSS, m] = lost - one[SLIP_LOSS, m]
        answer.onset[i], answer.rest[i] = onset / gamma, resting / gamma
        answer.switches[i] = 1 if onset >= 0.0 else 0
        for n in range(rows.size):
            row = rows[n]
            scale = 1.0 / gamma if row == _X or row == _ANGLE else 1.0
            for m in range(t.size):
                answer.out[n, i, m] = one[row, m] * scale
