"""States of the contact as the law is given them, and what it finds of them, by name."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel


class Fields(NamedTuple):
    """The row that each quantity goes to, -1 for none."""

    lam: int = -1
    zeta: int = -1
    epsilon: int = -1
    delta_star: int = -1
    delta: int = -1
    full_slip: int = -1
    beta: int = -1
    grip: int = -1
    Q: int = -1
    M: int = -1
    dQ_dV: int = -1
    dQ_ddelta: int = -1
    dQ_domega: int = -1
    dM_dV: int = -1
    M_half_space: int = -1
    M_cylinder: int = -1
    dM_half_space_dV: int = -1
    dM_cylinder_dV: int = -1
    delta_0: int = -1


class State(NamedTuple):
    """kappa, mu, V, and the creep as delta or as omega."""

    kappa: float
    mu: float
    V: float
    creep: float
    creep_is_omega: bool


class States(NamedTuple):
    """Arrays of what a :class:`State` holds: one value, or one a state."""

    kappa: Any
    mu: Any
    V: Any
    creep: Any
    creep_is_omega: bool


class Request(NamedTuple):
    """States, in an order or, where that is empty, in theirs, and what is asked of them: its rows in ``out``.

    first : the column of state 0
    """

    states: Any
    order: Any
    to: Any
    out: Any
    first: int


@kernel(inline=True)
def element(values, n):
    """Number n of an array of one value, or of one each."""
    return values[np.uint64(n * (values.size > 1))]


@kernel(inline=True)
def read_state(states, n):
    """State number n."""
    return State(
        element(states.kappa, n), element(states.mu, n), element(states.V, n), element(states.creep, n),
        states.creep_is_omega,
    )  # fmt: skip


@kernel(inline=True)
def write_field(row, value, n, asked):
    """A quantity of state n into its row, if it has one."""
    if row >= 0:
        asked.out[np.uint64(row), np.uint64(n + asked.first)] = value


@kernel(inline=True)
def slip_and_creepage(state):
    """(a number with the sign of omega - V, creep ratio); V = 0 counts as V -> 0+."""
    V, creep = state.V, state.creep
    if not state.creep_is_omega:
        return -creep if V < 0.0 else creep, creep
    slip = creep - V
    return slip, slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)
