"""The contact law over arrays of states, each at an alpha of its own."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import material_of
from . import lockstep
from .length import OK
from .state import FAR, NEAR, contact_state, contact_state_at
from .states import ROWS, creep_ratio, signed_slip, state_of
from .stick import slight


@kernel
def _slipping(first, count, states, block, some):
    """Collects states in partial slip that is not slight, with y = F(zeta) - d; returns how many."""
    found = 0
    for i in range(count):
        state = state_of(states, first + i)
        zeta, g = block[lockstep.ZETA + i], block[lockstep.G + i]
        slip, _, _ = signed_slip(state)
        d = abs(creep_ratio(state, slip)) / (state.mu * abs(state.V))
        y = (zeta + g) - d
        if y > 0.0 and not slight(d, zeta, g) and block[lockstep.ALPHA + i] > 1.0 and NEAR <= zeta <= FAR:
            block[lockstep.Y + i], some[found] = y, i
            found += 1
    return found


@kernel
def _solve(first, count, own, states, need, block, place, some):
    """Eqs. (6) and (10) for a block of states."""
    for i in range(count):
        n = first + i
        state = state_of(states, n)
        block[lockstep.ALPHA + i] = own.alpha[min(n, own.alpha.size - 1)]
        block[lockstep.KAPPA_V + i] = state.kappa * abs(state.V)
        block[lockstep.FOUND + i] = 0.0
    lockstep.solve_lengths(count, block, place)
    if need.stick:
        lockstep.solve_roots(_slipping(first, count, states, block, some), some, block, place)


@kernel(allocates=True)
def state_loop(own, states, need, rows, out, start, stop):
    """``contact_loop`` for fewer states than a block, one after another: the same bits, and less to compile."""
    state, worst = np.empty(len(ROWS)), OK
    for n in range(start, stop):
        worst = max(worst, contact_state(material_of(own, n), state_of(states, n), need, state))
        for m in range(rows.size):
            out[m, n] = state[rows[m]]
    return worst


@kernel(allocates=True)
def contact_loop(own, states, need, rows, out, start, stop):
    """States start..stop; ``rows`` picks the output."""
    state = np.empty(len(ROWS))
    block, place = np.empty(lockstep.SIZE), np.empty(lockstep.PLACES, np.int64)
    some = np.empty(lockstep.TOGETHER, np.int64)
    worst = OK
    for first in range(start, stop, lockstep.TOGETHER):
        count = min(stop - first, lockstep.TOGETHER)
        _solve(first, count, own, states, need, block, place, some)
        for i in range(count):
            n = first + i
            solved = (
                block[lockstep.LAM + i], block[lockstep.ZETA + i], block[lockstep.G + i], block[lockstep.H + i],
                block[lockstep.DG + i], int(block[lockstep.STATUS + i]),
            )  # fmt: skip
            found = block[lockstep.FOUND + i] == 1.0
            root = block[lockstep.ETA + i], block[lockstep.G_ETA + i], block[lockstep.H_ETA + i], found
            status = contact_state_at(solved, root, material_of(own, n), state_of(states, n), need, state)
            worst = max(worst, status)
            for m in range(rows.size):
                out[m, n] = state[rows[m]]
    return worst
