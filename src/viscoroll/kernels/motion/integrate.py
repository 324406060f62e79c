"""One motion from start to end: one phase after the other, and the switches between full and partial slip.

The regime changes only at a located event (:mod:`events`); nothing re-tests it between.
Full slip is :mod:`slide_phase`.  Partial slip is entered through its boundary layer (:mod:`layer_phase`)
and left for the slow manifold (:mod:`slow_phase`), then for the closed form of the last decay; :mod:`step_phase` is for
where the two give up.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import OK
from ..law.stick import stick_length
from ..numerics.arrays import fill
from .collocation import N
from .dop853 import EXTENDED
from .events import AT_REST, NO_EVENT, SLIP, STICK, speeds
from .full_slip import stick_limit
from .layer import ROWS
from .layer_phase import layer_phase
from .output import at_rest, coast, put
from .partial_slip import signed_D, slow_D
from .slide import SLIDE_ROWS
from .slide_phase import slide_phase
from .slow import COLUMNS
from .slow_phase import slow_phase
from .step_phase import PACE, step_phase
from .stepper import FULL, PARTIAL, REST

DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, NOT_CONVERGED = range(5)

#: speeds below this count as 0 beside others, and as already rolling among themselves
_TINY = 1e-150
#: least 1/zeta at which stick begins
_LEAST = 1e-300
#: beyond this zeta (kappa V < 1e-17) the slow motion is exponential to rounding
_COAST = 1e17


@kernel
def start(V, omega, scene, u):
    """Put (V, omega) into the unknowns of its regime: (regime, direction, sigma, status)."""
    material, kappa, mu, j = scene
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
    limit, zeta = stick_limit(V, scene)
    if V == 0.0 or abs(slip) >= limit:
        u[0], u[1] = 1.0 / zeta if V > 0.0 else 0.0, V - j * omega
        return FULL, direction, sigma, OK
    if zeta > _COAST:
        # the fast transient lasts a time of order V: it is over, V + j omega is kept
        u[0] = -np.log(2.0 * kappa * (V + j * omega) / (1.0 + j))
        u[1] = 0.0
        return PARTIAL, direction, sigma, OK
    _, D, status = stick_length(zeta, abs(slip) / V / (mu * V), material)
    u[0] = np.log(zeta)
    u[1] = sigma * D - slow_D(u[0], scene)[0]
    return PARTIAL, direction, sigma, status


@kernel
def switch(event, direction, sigma, u, scene, offset):
    """Enter the regime behind an event: (regime, direction, sigma).  ``offset`` keeps x and angle."""
    for m in range(2):
        offset[m] += direction * u[2 + m]
        u[2 + m] = 0.0
    j = scene.j
    if event == STICK:
        # both speeds may end at once, to rounding
        u[0] = -np.log(max(u[0], _LEAST))
        u[1] = sigma * np.exp(u[0]) - slow_D(u[0], scene)[0]
        return PARTIAL, direction, sigma
    if event == SLIP:
        sigma = np.sign(signed_D(u[0], u[1], scene))
        V, omega, _ = speeds(PARTIAL, u[0], u[1], scene)
        u[0], u[1] = np.exp(-u[0]), V - j * omega
        return FULL, direction, sigma
    # REVERSAL: V = 0; look from the other side, where V rises
    u[0], u[1] = 0.0, -u[1]
    return FULL, -direction, -sigma


@kernel
def finish_coasting(at, tau_out, tau, u, direction, scene, gamma, offset, rest, out):
    """Outputs of the closed form from here on; (status, rest time)."""
    at, crossing = coast(tau_out, at, tau, u, direction, scene, gamma, offset, rest, out)
    if crossing > tau_out[tau_out.size - 1]:
        return DONE, np.nan
    V, _, _ = speeds(PARTIAL, u[0], u[1], scene)
    length = direction * (V - rest) * (1.0 + scene.j) / scene.material.c
    at_rest(out, at, offset[0] + direction * u[2] + length, offset[1] + direction * u[3] + length, gamma)
    return RESTED, crossing / gamma


@kernel(allocates=True)
def integrate(scene, gamma, V0, omega0, t_out, rtol, rest, max_steps, out, switches, step_ends):
    """Roll one motion from t = 0 to t_out[-1]; t_out ascending, out of shape (OUTPUTS, n).

    ``switches`` (k, 2) receives (t, regime behind) of the regime changes, ``step_ends`` the
    times behind the steps and at the nodes of the layer and the slow manifold; what does not fit is not kept.
    Returns (status, steps, switches, onset time, rest time).
    """
    tau_out = t_out * gamma
    u, slope, offset, travelled, pace = np.zeros(4), np.zeros(4), np.zeros(2), np.zeros(2), np.zeros(PACE)
    buffers = np.zeros(4), np.zeros(4), np.zeros((EXTENDED, 4)), np.zeros((6, 4))
    work = np.empty((N + 2, COLUMNS)), np.empty((N, N)), np.empty(N), np.empty((5, N + 2))
    nodes, slow = np.empty((max(ROWS, SLIDE_ROWS), N + 1)), np.empty(N + 2)
    steps = turns = at = ends = 0
    onset_time = rest_time = np.nan
    if max(abs(V0), abs(omega0)) < rest:
        at_rest(out, 0, 0.0, 0.0, gamma)
        return RESTED, steps, turns, onset_time, 0.0
    regime, direction, sigma, start_status = start(V0, omega0, scene, u)
    if start_status != OK:
        return NOT_CONVERGED, steps, turns, onset_time, rest_time
    if regime == REST:
        at_rest(out, 0, 0.0, 0.0, gamma)
        return DONE, steps, turns, onset_time, rest_time
    while at < tau_out.size and tau_out[at] == 0.0:
        _, _, delta = speeds(regime, u[0], u[1], scene)
        put(out, at, 1.0, regime, V0, omega0, delta, 0.0, 0.0, gamma)
        at += 1
    status, tau, far, slipped = DONE, 0.0, np.log(_COAST), False
    # alpha = 1: nothing moves on the slow manifold, which both phases need
    layer_ahead, try_at = scene.material.c > 0.0, 0.0 if scene.material.c > 0.0 else np.inf
    while at < tau_out.size:
        event, ready, stuck = NO_EVENT, False, False
        if regime == FULL:
            event, tau, at, steps, ends = slide_phase(
                u, tau, slipped, tau_out, at, direction, sigma, scene, gamma, offset, travelled, rtol, rest, max_steps,
                steps, out, step_ends, ends, work[3], nodes,
            )  # fmt: skip
            stuck = event == NO_EVENT
        elif u[0] >= far:
            status, rest_time = finish_coasting(at, tau_out, tau, u, direction, scene, gamma, offset, rest, out)
            break
        elif layer_ahead:
            layer_ahead = False
            ready, tau, at, steps, ends = layer_phase(
                u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, max_steps, steps, out,
                step_ends, ends, work, nodes, slow,
            )  # fmt: skip
        else:
            event, ready, tau, at, steps, ends = step_phase(
                u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, far, try_at, max_steps,
                steps, out, step_ends, ends, pace, slope, buffers,
            )  # fmt: skip
            stuck = event == NO_EVENT and not ready and u[0] < far
        if ready:
            event, tau, at, steps, ends, try_at = slow_phase(
                u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, far, max_steps, steps,
                out, step_ends, ends, work,
            )  # fmt: skip
        if event == NO_EVENT:
            if at < tau_out.size and (steps >= max_steps or stuck):
                status = STEP_LIMIT if steps >= max_steps else STEP_TOO_SMALL
                break
            continue
        if event == AT_REST:
            at_rest(out, at, offset[0] + direction * u[2], offset[1] + direction * u[3], gamma)
            status, rest_time = RESTED, tau / gamma
            break
        regime, direction, sigma = switch(event, direction, sigma, u, scene, offset)
        slipped = event == SLIP
        if event == STICK or event == SLIP:
            if turns < switches.shape[0]:
                switches[turns, 0], switches[turns, 1] = tau / gamma, regime
            turns += 1
        if event == STICK:
            layer_ahead = scene.material.c > 0.0
            fill(0.0, pace)
            if np.isnan(onset_time):
                onset_time = tau / gamma
    return status, steps, turns, onset_time, rest_time
