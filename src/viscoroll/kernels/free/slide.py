"""Full slip as quadratures over s.

While sigma = sign(omega - V) stays, s' depends on s alone, so that s serves as the independent
variable.  With I, what rolling resistance has taken of V, and Z, its integral,

    I' = M/2       Z' = I       V = V_a + sigma mu tau - I       X = V_a tau + sigma mu tau^2/2 - Z
    omega = omega_a - (sigma mu tau + I)/j             angle = omega_a tau - (sigma mu tau^2/2 + Z)/j

only I and Z are to be found, small beside the rest.  On a panel s - pole rises or falls exponentially
over ``length``.  The law is singular near s = -1, and with small kappa mu V' = 0 lies behind a
nearer one: that is the pole.  Where M = 2 mu is ahead, the pole is there, and never reached.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import INTEGRALS, NODES, TO_START, N, integral_terms, polynomial, rise_at, rise_terms
from .full_slip import edge_of_stick, sliding, sliding_speed
from .records import SLIDE, Panel

#: rows of the values at the nodes: tau' and I' (over the length), the slope and the mean over time of what V gains
#: beside the traction (all that it gains, where V comes to stand: there that is a small difference), V, slip less
#: stick limit, the larger speed
D_TAU, D_I, D_WAY, SPEED_V, SLIP, FASTEST, MEAN_GAIN = range(7)
SLIDE_ROWS = 7
#: rows of the interpolants: tau, I, the mean gain (its integral would lose digits early), the function of an event
TAU, LOST, MEAN, EVENT = range(4)
#: beyond this length V has changed by so much that its change is good for the time
_LONG = 0.5
#: iterations to find an event, and a step after which none is needed: the slope is that of the interpolant
_MOST_ITERATIONS, _LAST = 100, 1e-12
#: rounding of an extrapolation to the left end
_ROUNDING = 1e-14
#: how much beyond the place that is expected for its end a panel goes
BEYOND = 1.05
#: a parabola that falls below this share of the lowest node is looked into
_DIP = 0.5


@kernel
def s_at(v, panel):
    """s at v = 1 + t."""
    rise = (panel.first - panel.pole) * np.expm1(0.5 * panel.length * v)
    # abs: rounded downward, 0 - 0 is -0
    return panel.end if v == 2.0 else abs(max(panel.first + rise, 0.0))


@kernel
def slide_rates(panel, sigma, scene, nodes):
    """Fill tau', I', V and the stick limit; whether V' keeps its sign."""
    length, from_pole = panel.length, panel.first - panel.pole
    for i in range(N + 1):
        speed, rate, per_s, half_M, limit = sliding(s_at(1.0 + NODES[i], panel), sigma, scene)
        per = from_pole * np.exp(0.5 * length * (1.0 + NODES[i])) * per_s / rate
        if not per * length > 0.0:
            return False
        nodes[D_TAU, i], nodes[D_I, i], nodes[SPEED_V, i], nodes[SLIP, i] = per, half_M * per, speed, limit
    return True


@kernel
def standing_rates(rise, panel, sigma, scene, nodes):
    """As :func:`slide_rates` where M = 2 mu, for a time: s stays."""
    speed, _, _, _, limit = sliding(panel.first, sigma, scene)
    for i in range(N + 1):
        nodes[D_TAU, i], nodes[D_I, i], nodes[SPEED_V, i], nodes[SLIP, i] = rise, scene.mu * rise, speed, limit


@kernel
def _slip(tau, I, panel, sigma, scene):
    """sigma (omega - V)."""
    _, _, mu, j = scene
    return sigma * (panel.omega - panel.V) - (1.0 + 1.0 / j) * mu * tau - sigma * (1.0 / j - 1.0) * I


@kernel
def _fastest(speed, tau, I, panel, sigma, scene):
    """max(V, |omega|)."""
    return max(speed, abs(panel.omega - (sigma * scene.mu * tau + I) / scene.j))


@kernel
def _time(speed, I, tau, panel, sigma, scene):
    """tau from the change of V; or, where that is a small difference, as it was found."""
    return (sigma * (speed - panel.V) + sigma * I) / scene.mu if abs(panel.length) > _LONG else tau


@kernel
def slide_sums(panel, sigma, scene, nodes):
    """Fill the other rows; the rise of tau."""
    half, tau = 0.5 * panel.length, 0.0
    nodes[D_WAY, 0] = 0.0
    nodes[SLIP, 0] = _slip(0.0, 0.0, panel, sigma, scene) - nodes[SLIP, 0]
    nodes[FASTEST, 0] = _fastest(nodes[SPEED_V, 0], 0.0, 0.0, panel, sigma, scene)
    for i in range(1, N + 1):
        tau = I = 0.0
        for n in range(N):
            tau += INTEGRALS[i - 1, n] * nodes[D_TAU, n + 1]
            I += INTEGRALS[i - 1, n] * nodes[D_I, n + 1]
        I *= half
        tau = _time(nodes[SPEED_V, i], I, half * tau, panel, sigma, scene)
        nodes[D_WAY, i] = ((sigma * scene.mu * tau if panel.pole > 0.0 else 0.0) - I) * nodes[D_TAU, i]
        nodes[SLIP, i] = _slip(tau, I, panel, sigma, scene) - nodes[SLIP, i]
        nodes[FASTEST, i] = _fastest(nodes[SPEED_V, i], tau, I, panel, sigma, scene)
        nodes[MEAN_GAIN, i] = half / tau if tau > 0.0 else 0.0
    nodes[MEAN_GAIN, 0] = 0.0
    for i in range(1, N + 1):
        way = 0.0
        for n in range(N):
            way += INTEGRALS[i - 1, n] * nodes[D_WAY, n + 1]
        nodes[MEAN_GAIN, i] *= way
    return tau


@kernel
def slide_error(length, nodes):
    """Mismatch at the left end of I for a given time, beyond rounding.

    An error of the time alone moves I by M/2 times as much, and so cancels where V stands almost still.
    """
    first, last = nodes[D_I, 0] / nodes[D_TAU, 0], nodes[D_I, N] / nodes[D_TAU, N]
    tau_off, I_off, largest = nodes[D_TAU, 0], nodes[D_I, 0], abs(nodes[D_I, 0])
    for i in range(1, N + 1):
        tau_off -= TO_START[i - 1] * nodes[D_TAU, i]
        I_off -= TO_START[i - 1] * nodes[D_I, i]
        largest = max(largest, abs(nodes[D_I, i]))
    off = max(abs(I_off - first * tau_off), abs(I_off - last * tau_off))
    return abs(length) * max(off - _ROUNDING * largest, 0.0)


@kernel
def slide_terms(length, nodes, powers):
    """Coefficients for ``rise_at`` of tau, I and the mean gain."""
    integral_terms(nodes[D_TAU], 0.5 * length, powers, TAU)
    integral_terms(nodes[D_I], 0.5 * length, powers, LOST)
    rise_terms(nodes[MEAN_GAIN], powers, MEAN)


@kernel
def slide_rise(v, panel, sigma, scene, powers):
    """(V, delta_star V, tau, I) at v."""
    speed, limit = edge_of_stick(s_at(v, panel), scene)
    I = rise_at(v, powers, LOST)
    return speed, limit, _time(speed, I, rise_at(v, powers, TAU), panel, sigma, scene), I


@kernel
def slide_state(v, tau, panel, sigma, scene, powers):
    """(V, omega, X, angle) at v and at the time tau from the left end."""
    _, _, mu, j = scene
    push = sigma * mu * tau
    gain = push - rise_at(v, powers, LOST)
    mean = (0.5 * push if panel.pole <= 0.0 else 0.0) + rise_at(v, powers, MEAN)
    if panel.first == panel.pole:  # V stands still
        gain = mean = 0.0
    V, omega = panel.V, panel.omega
    return V + gain, omega - (2.0 * push - gain) / j, (V + mean) * tau, (omega - (push - mean) / j) * tau


@kernel
def slip_at(v, panel, sigma, scene, powers):
    """sigma (omega - V) less its limit: positive before the stick zone forms, negative behind."""
    _, limit, tau, I = slide_rise(v, panel, sigma, scene, powers)
    return _slip(tau, I, panel, sigma, scene) - limit


@kernel
def locate_slide(low, high, panel, sigma, scene, work):
    """v in [low, high] at which the stick zone forms, by Newton's iteration with the slope of the interpolant."""
    powers = work.powers
    rise_terms(work.nodes[SLIP], powers, EVENT)
    start = work.nodes[SLIP, 0]
    v, exact = 0.5 * (low + high), False
    for _ in range(_MOST_ITERATIONS):
        if exact:
            value = slip_at(v, panel, sigma, scene, powers)
            low, high = v if value > 0.0 else low, high if value > 0.0 else v
        else:
            value = start + rise_at(v, powers, EVENT)
        new = v - value / _slope(v, powers)
        inside = low <= new <= high
        new = new if inside else 0.5 * (low + high)
        near = abs(new - v) <= _LAST * v
        v = new
        if near and exact:
            break
        exact = exact or near or not inside
    return v


@kernel
def _slope(v, powers):
    """Slope in v of the interpolant in the row of an event."""
    total = 0.0
    for k in range(powers.shape[1] - 1, 0, -1):
        total = k * powers[EVENT, k] + (v - 1.0) * total
    return polynomial(v - 1.0, powers, EVENT) + v * total


@kernel
def dip(nodes, powers):
    """v near which the slip is lowest, where it may dip under the stick limit between nodes; NaN if it does not."""
    i = 0
    for n in range(1, N + 1):
        i = n if nodes[SLIP, n] < nodes[SLIP, i] else i
    if i == N:
        return np.nan
    rise_terms(nodes[SLIP], powers, EVENT)
    v = 1.0 + NODES[i]
    slope = _slope(v, powers)
    # the parabola through this node with this slope, and the node that it falls to
    other = i - 1 if slope > 0.0 and i > 0 else i + 1
    if i == 0 and slope >= 0.0:
        return np.nan
    away = NODES[other] - NODES[i]
    bend = (nodes[SLIP, other] - nodes[SLIP, i] - slope * away) / (away * away)
    shift = -0.5 * slope / bend
    return v + shift if nodes[SLIP, i] + 0.5 * slope * shift < _DIP * nodes[SLIP, i] else np.nan


@kernel
def standing_panel(state, s, left, sigma, scene, nodes):
    """The panel on which V stands still at s until the slip has gone, or for the time ``left``, with its rates."""
    _, _, mu, j = scene
    # the spin may fall by any factor yet, so V is that where it stands
    V = sliding_speed(s, scene)
    omega = (V - state.second) / j
    panel = Panel(SLIDE, s, state.second, 1.0, 1, s, s, V, omega)
    standing_rates(min(BEYOND * left, 0.5 * j * sigma * (omega - V) / mu), panel, sigma, scene, nodes)
    return panel
