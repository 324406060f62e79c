"""The contact law over arrays of states at one material: polynomials for Q and M, no root.

With u = kappa |V|, L(u) = 2 u F(zeta) = 2 kappa delta_star/mu and D = 2 kappa |delta|/mu, Eq. (10)
reads y = F(eta) = w/(2 u) with w = L - D, and Eq. (15)

    Q = mu (1 - w^2 H(eta)/y^2)        or, where D is a small part of L and this would cancel,
    Q = mu Int_0^D 2 w A(w/(2 u)) dD,  A = H'(eta)/(2 y F'(eta)).

Slopes, and states at the ends of the doubles, take the way of :mod:`state`.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .inverses import at_speed, at_stick, slight_traction
from .length import OK
from .state import (
    BETA,
    DELTA,
    DELTA_STAR,
    EPSILON,
    FULL_SLIP,
    LAM,
    ROWS,
    ZETA,
    M,
    Q,
    contact_state,
    creep_ratio,
    signed_slip,
    state_of,
)  # fmt: skip
from .stick import CLOSE

#: kappa |V| that the tables serve: products of the functions stay within the doubles
_SLOWEST, _FASTEST = 1e-100, 1e100
#: least F(eta)/F(zeta) served
_EDGE = 2.0**-20


#: states of a block: the tables over kappa |V| are read for all, then those over F(eta), so that no look-up waits for
#: the one before it
_TOGETHER = 64
#: rows of a block: kappa |V|, what it gives, y = F(eta), D, and whether the tables serve the state
_U, _LAM, _EPSILON, _L, _M, _DELTA, _Y, _D, _SERVED = range(9)


@kernel
def _read_speeds(inverses, states, first, count, block):
    """Fill the rows of a block up to ``_M``; returns a status."""
    worst = OK
    for i in range(count):
        state = state_of(states, first + i)
        u = state.kappa * abs(state.V)
        block[_U, i], block[_SERVED, i] = u, 1.0 if _SLOWEST <= u <= _FASTEST else 0.0
        at = u if _SLOWEST <= u <= _FASTEST else 1.0
        block[_LAM, i], block[_EPSILON, i], block[_L, i], block[_M, i], status = at_speed(at, inverses)
        worst = max(worst, status)
    return worst


@kernel
def _read_creeps(states, first, count, need, block):
    """Fill the other rows of a block."""
    alike, per = states.kappa.size == 1 and states.mu.size == 1, 0.0
    for i in range(count):
        state = state_of(states, first + i)
        if i == 0 or not alike:
            per = 2.0 * state.kappa / state.mu
        slip, _, _ = signed_slip(state)
        delta = creep_ratio(state, slip)
        L, D = block[_L, i], per * abs(delta)
        w = L - D
        block[_DELTA, i], block[_D, i], block[_Y, i] = delta, D, 0.5 * w / block[_U, i]
        if need.stick and 0.0 < w < _EDGE * L:
            block[_SERVED, i] = 0.0


@kernel
def _put_traction(inverses, states, first, count, at, block, out):
    """beta and Q of a block; returns a status."""
    worst = OK
    for i in range(count):
        state = state_of(states, first + i)
        _, sign, _ = signed_slip(state)
        L, D, y = block[_L, i], block[_D, i], block[_Y, i]
        beta, part, w = 0.0, 1.0, L - D
        if w > 0.0 and block[_SERVED, i] == 1.0:
            slight = D <= CLOSE * L
            if not slight or at[BETA] >= 0:
                share, press, _, status = at_stick(y, inverses)
                worst = max(worst, status)
                beta, part = min(share * w / block[_LAM, i], 1.0), 1.0 - w * w * press
            if slight:
                part, status = slight_traction(block[_U, i], L, D, inverses)
                worst = max(worst, status)
        if at[BETA] >= 0:
            out[at[BETA], first + i] = beta
        if at[Q] >= 0:
            out[at[Q], first + i] = sign * state.mu * min(part, 1.0)
    return worst


@kernel
def _put_others(states, first, count, at, block, out):
    """All but beta and Q of a block."""
    for i in range(count):
        n, state = first + i, state_of(states, first + i)
        if at[LAM] >= 0:
            out[at[LAM], n] = block[_LAM, i]
        if at[ZETA] >= 0:
            out[at[ZETA], n] = 0.5 * block[_LAM, i] / block[_U, i]
        if at[EPSILON] >= 0:
            out[at[EPSILON], n] = block[_EPSILON, i]
        if at[DELTA_STAR] >= 0:
            out[at[DELTA_STAR], n] = (0.5 * state.mu / state.kappa) * block[_L, i]
        if at[DELTA] >= 0:
            out[at[DELTA], n] = block[_DELTA, i]
        if at[FULL_SLIP] >= 0:
            out[at[FULL_SLIP], n] = 1.0 if block[_D, i] >= block[_L, i] else 0.0
        if at[M] >= 0:
            out[at[M], n] = state.V * block[_M, i]


@kernel(allocates=True)
def inverse_loop(inverses, states, need, rows, out, start, stop):
    """``contact_loop`` at one material."""
    state, at, block = np.empty(len(ROWS)), np.full(len(ROWS), -1), np.zeros((_SERVED + 1, _TOGETHER))
    worst = OK
    for m in range(rows.size):
        at[rows[m]] = m
    for first in range(start, stop, _TOGETHER):
        count = min(stop - first, _TOGETHER)
        if not need.slopes:
            worst = max(worst, _read_speeds(inverses, states, first, count, block))
            _read_creeps(states, first, count, need, block)
            _put_others(states, first, count, at, block, out)
            if need.stick:
                worst = max(worst, _put_traction(inverses, states, first, count, at, block, out))
        for i in range(count):
            if need.slopes or block[_SERVED, i] == 0.0:
                worst = max(worst, contact_state(inverses.material, state_of(states, first + i), need, state))
                for m in range(rows.size):
                    out[m, first + i] = state[rows[m]]
    return worst
