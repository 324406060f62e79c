"""States of the contact from the rows of their law: no root, no iteration, and nothing that is not asked for.

With D = 2 kappa |delta|/mu and w = L - D, |Q|/mu = 1 - w^2 press(2 u/w), where 1 = L^2 press(2 u/L) is its neighbour
at slight creep.  There their difference is exact with the mean slope S of press between v1 = 2 u/L and v2 = 2 u/w:

    |Q|/mu = D [(2 L - D) press(v2) - v2 L S]
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..compile.rarely import rarely
from ..law.states import (
    BETA,
    DELTA,
    DELTA_STAR,
    DM_CYLINDER_DV,
    DM_DV,
    DM_HALF_SPACE_DV,
    DQ_DDELTA,
    DQ_DOMEGA,
    DQ_DV,
    EPSILON,
    FULL_SLIP,
    LAM,
    M_CYLINDER,
    M_HALF_SPACE,
    ZETA,
    M,
    Q,
    slip_and_creep,
    state_of,
)  # fmt: skip
from . import lanes
from .law import (
    bodies,
    body_slopes,
    lengths,
    octave,
    place,
    press,
    press_secant,
    press_secants,
    press_slopes,
    share,
    speed,
    speed_slopes,
    way_of,
)
from .record import ALPHA, COUNT, E0, LOW, hold

#: share of L below which D is slight
SLIGHT = 0.125


@kernel(inline=True)
def _at_most_one(x):
    return x if x < 1.0 else 1.0


@kernel(inline=True)
def traction(u, L, D, law):
    """|Q|/mu in partial slip."""
    w = L - D
    if not w > 0.0:  # delta_star is further than D by a rounding
        return 1.0
    v = 2.0 * u / w
    at = place(v, law)
    if D >= SLIGHT * L:
        part = 1.0 - w * w * press(at, v, law)
        if not _cancels(part, D, L):
            return _at_most_one(part)
    value, rise = press_secant(at, place(2.0 * u / L, law), v, D / w, law)
    return D * ((2.0 * L - D) * value - v * L * rise)


@kernel(inline=True)
def _cancels(part, D, L):
    """Whether |Q|/mu has lost digits by now; up to L/2 v1 and v2 lie in one row or in neighbours."""
    return part < 0.2 and D < 0.5 * L


@kernel(inline=True)
def stick_share(u, lam, L, D, law):
    """beta in partial slip."""
    w = L - D
    if not w > 0.0:
        return 0.0
    v = 2.0 * u / w
    return _at_most_one(share(place(v, law), v, law) * w / lam) if D > 0.0 else 1.0


@kernel(inline=True)
def traction_slopes(u, L, dL, D, law):
    """Slopes of |Q|/mu in partial slip: over u at fixed delta, and over D; ``dL``: dL/du."""
    w = L - D
    if not w > 0.0:
        return 0.0, 0.0
    v = 2.0 * u / w
    at = place(v, law)
    value, slope = press_slopes(at, v, law)
    A = value - 0.5 * v * slope
    if D < SLIGHT * L or _cancels(1.0 - w * w * value, D, L):
        x, v1 = D / w, 2.0 * u / L
        rise, bend = press_secants(at, place(v1, law), v, x, law)
        # with A = press - v press'/2, dL/du = -press'/A at v1, and the two terms below are neighbours
        step = v1 * x
        slope_1 = slope - bend * step
        A_1 = value - rise * step - 0.5 * v1 * slope_1
        over_u = step * ((rise - 0.5 * (v * bend + slope_1)) * slope_1 / A_1 - bend)
    else:
        over_u = -(A * dL + slope)
    return 2.0 * w * over_u, 2.0 * w * A


@kernel(inline=True)
def traction_of(u, L, state, law):
    """Q."""
    slip, delta = slip_and_creep(state)
    D, part = 2.0 * state.kappa / state.mu * abs(delta), 1.0
    if not abs(delta) >= 0.5 * state.mu / state.kappa * L:
        part = traction(u, L, D, law)
    return np.copysign(state.mu * part, slip)


@kernel(inline=True)
def slopes_of_Q(u, L, dL, state, law):
    """Slopes of Q: over V at fixed delta or omega, whichever is given; over delta and over omega."""
    _, delta = slip_and_creep(state)
    if abs(delta) >= 0.5 * state.mu / state.kappa * L:
        return 0.0, 0.0, 0.0
    over_u, over_D = traction_slopes(u, L, dL, 2.0 * state.kappa / state.mu * abs(delta), law)
    over_delta = 2.0 * state.kappa * over_D
    over_V, over_omega = np.sign(delta) * state.mu * state.kappa * over_u, over_delta / abs(state.V)
    if state.creep_is_omega:
        over_V -= over_omega * (1.0 + delta)
    return over_V, -over_delta if state.V < 0.0 else over_delta, over_omega


class Asked(NamedTuple):
    """States, in an order or, where that is empty, in theirs; which row of ``out`` each quantity goes to, -1 for none.

    first : the column of state 0
    """

    states: Any
    order: Any
    to: Any
    out: Any
    first: int


@kernel(inline=True)
def _turn(k, asked):
    """The state whose turn it is."""
    return asked.order[np.uint64(k)] if asked.order.size > 0 else k


@kernel(inline=True)
def _at(k, asked):
    """(Its column, the state, kappa |V|)."""
    n = _turn(k, asked)
    state = state_of(asked.states, n)
    return np.uint64(n + asked.first), state, state.kappa * abs(state.V)


@kernel(inline=True)
def _put(row, value, n, asked):
    """A quantity into its row, if it has one."""
    if row >= 0:
        asked.out[np.uint64(row), n] = value


@kernel(inline=True)
def _speeds(law, asked, found, begin, end):
    """What depends on the speed alone of states begin..end; L and lam into ``found``."""
    to = asked.to
    to_lam, to_zeta, to_epsilon, to_M = to[LAM], to[ZETA], to[EPSILON], to[M]
    to_half_space, to_cylinder = to[M_HALF_SPACE], to[M_CYLINDER]
    measured = to_lam >= 0 or to_zeta >= 0 or to_epsilon >= 0 or to[BETA] >= 0
    for k in range(begin, end):
        i = np.uint64(k - begin)
        n, state, u = _at(k, asked)
        here = place(u, law)
        L, m, scale = speed(here, u, law)
        way = way_of(here, u, scale, state)
        found[0, i] = L
        _put(to_M, way * m, n, asked)
        if measured:
            lam, epsilon = lengths(here, u, law)
            found[1, i] = lam
            _put(to_lam, lam, n, asked)
            _put(to_zeta, 0.5 * lam / u, n, asked)
            _put(to_epsilon, epsilon, n, asked)
        if to_half_space >= 0 or to_cylinder >= 0:
            half_space, cylinder = bodies(here, u, law)
            _put(to_half_space, way * half_space, n, asked)
            _put(to_cylinder, way * cylinder, n, asked)


@kernel(inline=True)
def _creeps(law, asked, found, begin, end):
    """What depends on the creep too."""
    to, states = asked.to, asked.states
    to_Q, to_beta, to_star, to_delta, to_full_slip = to[Q], to[BETA], to[DELTA_STAR], to[DELTA], to[FULL_SLIP]
    alike = states.kappa.size == 1 and states.mu.size == 1
    per, inverse = 0.5 * states.mu[0] / states.kappa[0], 2.0 * states.kappa[0] / states.mu[0]
    for k in range(begin, end):
        i = np.uint64(k - begin)
        n, state, u = _at(k, asked)
        if rarely(not alike):
            per, inverse = 0.5 * state.mu / state.kappa, 2.0 * state.kappa / state.mu
        L = found[0, i]
        slip, delta = slip_and_creep(state)
        delta_star, D = per * L, inverse * abs(delta)
        full_slip = abs(delta) >= delta_star
        if to_Q >= 0:
            part = 1.0 if full_slip else traction(u, L, D, law)
            _put(to_Q, np.copysign(state.mu * part, slip), n, asked)
        if to_beta >= 0:
            _put(to_beta, 0.0 if full_slip else stick_share(u, found[1, i], L, D, law), n, asked)
        _put(to_star, delta_star, n, asked)
        _put(to_delta, delta, n, asked)
        _put(to_full_slip, 1.0 if full_slip else 0.0, n, asked)


@kernel
def table_loop(law, asked, found, count):
    """Values of ``count`` states.

    ``found``: room for two lengths of some states, which wait there: so the processor works on several at once; of one
    state where each has a law of its own, of which one is held at a time.
    """
    to = asked.to
    crept = to[Q] >= 0 or to[BETA] >= 0 or to[DELTA_STAR] >= 0 or to[DELTA] >= 0 or to[FULL_SLIP] >= 0
    for begin in range(0, count, found.shape[1]):
        end = min(begin + found.shape[1], count)
        hold(law, _turn(begin, asked))
        _speeds(law, asked, found, begin, end)
        if crept:
            _creeps(law, asked, found, begin, end)


@kernel
def slopes_loop(law, asked, count):
    """Slopes, likewise."""
    to = asked.to
    to_V, to_creep, to_omega, to_M = to[DQ_DV], to[DQ_DDELTA], to[DQ_DOMEGA], to[DM_DV]
    to_half_space, to_cylinder = to[DM_HALF_SPACE_DV], to[DM_CYLINDER_DV]
    for k in range(count):
        hold(law, _turn(k, asked))
        n, state, u = _at(k, asked)
        here = place(u, law)
        L, dL, rise = speed_slopes(here, u, law)
        _put(to_M, rise, n, asked)
        if to_half_space >= 0 or to_cylinder >= 0:
            half_space, cylinder = body_slopes(here, u, law)
            _put(to_half_space, half_space, n, asked)
            _put(to_cylinder, cylinder, n, asked)
        if to_V >= 0 or to_creep >= 0 or to_omega >= 0:
            over_V, over_delta, over_omega = slopes_of_Q(u, L, dL, state, law)
            _put(to_V, over_V, n, asked)
            _put(to_creep, over_delta, n, asked)
            _put(to_omega, over_omega, n, asked)


@kernel
def unsteady_loop(law, powers, states, out, first, stop):
    """N into elements first..stop of ``out``; ``powers``: its polynomials, one row after another."""
    for n in range(first, stop):
        state = state_of(states, n - first)
        u = state.kappa * abs(state.V)
        row, t, _ = octave(u, law.marks[E0])
        if row < law.marks[COUNT]:
            out[n] = lanes.one(powers, row * lanes.TERMS, t)
        else:
            z = 0.5 * law.rows[LOW] / u
            out[n] = 0.25 * (law.rows[ALPHA] - 1.0) * z * z
