"""Many motions of one scene from its flow map."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.integrate import DONE, RESTED
from ..motion.losses import ROLLING_LOSS, ROWS, SLIP_LOSS, kinetic_energy_lost
from ..motion.records import FULL, PARTIAL, REST
from . import layout
from .inside import earlier_entry
from .read import (
    HIGHEST,
    LOSS,
    MINUS,
    PATH,
    PLUS,
    SPEEDS,
    entry_state,
    layer_speeds,
    onset_of,
    served_by_layer,
    slide,
    slides,
    slow_entry,
    slow_loss,
    slow_path,
    slow_state,
    speed_after,
)

NOT_SERVED = -1
#: a start this many times faster than the onset of stick is left to the integrator: V there is a small difference, with
#: an error of 2e-14 of the start
_MOST_LOST = 4096.0
_X, _ANGLE = 2, 3  # rows of the output, as in :mod:`motion.output`


@kernel(inline=True)
def _put(out, column, V, omega, x, angle, delta, regime, loss):
    out[0, column], out[1, column], out[_X, column] = V, omega, x
    out[_ANGLE, column], out[4, column], out[5, column] = angle, delta, regime
    out[SLIP_LOSS, column] = loss


@kernel(inline=True)
def _stick_onset(T, X, w, frame, first, need, table, scene):
    """(frame, family, kappa V, tau, X so far, served) of the stick onset of a motion that slides.

    ``frame`` mirrors so that omega > V while sliding, and afterwards so that V > 0.
    """
    V_on, T_on, X_on = onset_of(w - 2.0 * scene.mu * T, need, table, scene)
    v = scene.kappa * abs(V_on)
    served = 2.0**first <= v < 2.0 ** (first + layout.ENTRY_OCTAVES)
    if V_on > 0.0:
        return frame, PLUS, v, max(T_on - T, 0.0), X_on - X, served
    return -frame, MINUS, v, max(T_on - T, 0.0), X_on - X, served


@kernel(inline=True)
def _slide_outputs(at, tau_out, onset, T0, X0, w, frame, need, table, scene, out):
    """Outputs before stick onset; returns the next column."""
    mu, per_j = scene.mu, 1.0 / scene.j
    while at < tau_out.size and tau_out[at] < onset:
        tau = tau_out[at]
        V = speed_after(T0 + tau, table, scene)
        omega = (V - (w + 2.0 * mu * tau)) * per_j
        x = angle = 0.0
        if need >= PATH:
            x = slide(V, PATH, table, scene)[1] - X0
            angle = (x - tau * (w + mu * tau)) * per_j
        delta = (omega - V) / V if V != 0.0 else np.inf
        _put(out, at, frame * V, frame * omega, frame * x, frame * angle, delta, FULL, mu * (angle - x))
        at += 1
    return at


@kernel(inline=True)
def _stick_outputs(at, tau_out, until, onset, family, v, entry, origin, first, need, table, scene, out):
    """Outputs in partial slip up to ``until``; returns the next column.

    ``origin`` = (frame; distance, angle and slip loss at the entry).
    """
    frame, x0, angle0, loss0 = origin
    lam, rate, x_gained, angle_gained, loss_gained = entry
    to_lose = slow_loss(lam, table) + loss_gained if need >= LOSS else 0.0
    slow_rate = scene.material.c / (1.0 + scene.j)
    layer_end = onset + layout.LAYER_END / rate
    while at < tau_out.size and tau_out[at] <= until:
        elapsed = tau_out[at] - onset
        x = angle = loss = 0.0
        if tau_out[at] < layer_end:
            V, delta, x, angle, loss = layer_speeds(family, v, rate, elapsed, first, need, table, scene.kappa)
        else:
            now = lam - slow_rate * elapsed
            V, delta = slow_state(now, table)
            if need >= PATH:
                x, angle = slow_path(lam, now, slow_rate, table)
                x, angle = x + x_gained, angle + angle_gained
            if need >= LOSS:
                loss = to_lose - slow_loss(now, table)
        _put(
            out, at, frame * V, frame * V * (1.0 + delta), x0 + frame * x, angle0 + frame * angle, delta, PARTIAL,
            loss0 + loss,
        )  # fmt: skip
        at += 1
    return at


@kernel
def _rest_outputs(at, tau_out, entry, origin, rest_lambda, table, scene, out):
    """Outputs at rest, where the threshold was crossed."""
    frame, x0, angle0, loss0 = origin
    lam, _, x_gained, angle_gained, loss_gained = entry
    x, angle = slow_path(lam, rest_lambda, scene.material.c / (1.0 + scene.j), table)
    x, angle = x0 + frame * (x + x_gained), angle0 + frame * (angle + angle_gained)
    loss = loss0 + loss_gained + slow_loss(lam, table) - slow_loss(rest_lambda, table)
    for column in range(at, tau_out.size):
        _put(out, column, 0.0, 0.0, x, angle, 0.0, REST, loss)


@kernel(inline=True)
def flow_motion(V0, omega0, tau_out, rest, rest_lambda, first, need, table, scene, out):
    """One motion in tau = gamma t: (status, onset, rest time); a time is NaN where there is none.

    ``rest_lambda``: lambda of the slow manifold at the rest threshold.
    """
    kappa, mu, j = scene.kappa, scene.mu, scene.j
    nowhere = (NOT_SERVED, np.nan, np.nan)
    end = tau_out[tau_out.size - 1]
    if max(abs(V0), abs(omega0)) < rest:
        for column in range(tau_out.size):
            _put(out, column, 0.0, 0.0, 0.0, 0.0, 0.0, REST, 0.0)
        return RESTED, np.nan, 0.0
    if not kappa * abs(V0) < HIGHEST:
        return nowhere
    frame = 1.0 if omega0 >= V0 else -1.0
    V, omega = frame * V0, frame * omega0
    sliding = slides(V, omega - V, table, scene)
    at, x0, angle0, loss0, w, E, T, X, onset = 0, 0.0, 0.0, 0.0, V - j * omega, 0.0, 0.0, 0.0, 0.0
    if sliding:
        T, X = slide(V, need, table, scene)
        frame_on, family, v, onset, x0, served = _stick_onset(T, X, w, frame, first, need, table, scene)
    else:
        frame_on = 1.0 if V0 > 0.0 else -1.0
        family, v, E, served = earlier_entry(abs(V0), (omega0 - V0) / V0, first, table, scene)
    if not served or v < 2.0 * kappa * rest or (sliding and kappa * max(abs(V0), abs(omega0)) > _MOST_LOST * v):
        return nowhere
    while at < tau_out.size and tau_out[at] == 0.0:
        delta = (omega0 - V0) / V0 if V0 != 0.0 else np.inf
        _put(out, at, V0, omega0, 0.0, 0.0, delta, FULL if sliding else PARTIAL, 0.0)
        at += 1
    if sliding:
        at = _slide_outputs(at, tau_out, onset, T, X, w, frame, need, table, scene, out)
        if end < onset:
            return DONE, np.nan, np.nan
        angle0 = (x0 - onset * (w + mu * onset)) / j
        loss0 = mu * (angle0 - x0)
        x0, angle0 = frame * x0, frame * angle0
    on_manifold = E > layout.LAYER_END
    entry = slow_entry(v, table) if on_manifold else entry_state(family, v, first, need, table)
    if not sliding:
        onset = -min(E, 1.1 * layout.LAYER_END) / entry[1]
    layer_end = onset + layout.LAYER_END / entry[1]
    in_layer = (at < tau_out.size and tau_out[at] < layer_end) or (need >= PATH and E > 0.0 and not on_manifold)
    if in_layer and not served_by_layer(v, first):
        return nowhere
    resting = np.inf
    if rest > 0.0:
        resting = onset + (entry[0] - rest_lambda) * (1.0 + j) / scene.material.c
        if resting < max(layer_end, 0.0):
            return nowhere
    if need >= PATH and E > 0.0 and not on_manifold:
        _, _, x, angle, loss = layer_speeds(family, v, entry[1], -onset, first, need, table, kappa)
        x0, angle0, loss0 = -frame_on * x, -frame_on * angle, -loss
    origin = (frame_on, x0, angle0, loss0)
    until = min(resting, end)
    at = _stick_outputs(at, tau_out, until, onset, family, v, entry, origin, first, need, table, scene, out)
    onset_time = onset if sliding else np.nan
    if end <= resting:
        return DONE, onset_time, np.nan
    _rest_outputs(at, tau_out, entry, origin, rest_lambda, table, scene, out)
    return RESTED, onset_time, resting


@kernel(allocates=True, seconds=3)
def flow_loop(
    scene, gamma, first, rest, rest_lambda, table, V0, omega0, t, rows,
    out, status, onset, resting, switches, start, stop,
):  # fmt: skip
    """Motions start..stop; those that are not served get the status NOT_SERVED and no output.

    ``rows`` picks the output quantities, as in :mod:`motion.loss_loop`; distance and angle, and the
    energy lost, are found only if they are among them.
    """
    one, tau = np.empty((ROWS, t.size)), t * gamma
    need = SPEEDS
    for n in range(rows.size):
        need = max(need, PATH if rows[n] == _X or rows[n] == _ANGLE else LOSS if rows[n] >= SLIP_LOSS else SPEEDS)
    for i in range(start, stop):
        V, omega = V0[min(i, V0.size - 1)], omega0[min(i, omega0.size - 1)]
        status[i], onset[i], resting[i] = flow_motion(V, omega, tau, rest, rest_lambda, first, need, table, scene, one)
        if need >= LOSS:
            for m in range(t.size):
                one[ROLLING_LOSS, m] = kinetic_energy_lost(V, omega, one[0, m], one[1, m], scene.j) - one[SLIP_LOSS, m]
        onset[i] /= gamma
        resting[i] /= gamma
        switches[i] = 1 if onset[i] >= 0.0 else 0
        for n in range(rows.size):
            row = rows[n]
            scale = 1.0 / gamma if row == _X or row == _ANGLE else 1.0
            for m in range(t.size):
                out[n, i, m] = one[row, m] * scale
