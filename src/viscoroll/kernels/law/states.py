"""States of the contact as the law is given them, and what it finds of them, by name."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel

#: Order of the rows of the kernel's output; the last four, of a pair alone.
ROWS = (
    "lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M",
    "dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV",
    "M_half_space", "M_cylinder", "dM_half_space_dV", "dM_cylinder_dV",
)  # fmt: skip
(
    LAM, ZETA, EPSILON, DELTA_STAR, DELTA, FULL_SLIP, BETA, Q, M, DQ_DV, DQ_DDELTA, DQ_DOMEGA, DM_DV,
    M_HALF_SPACE, M_CYLINDER, DM_HALF_SPACE_DV, DM_CYLINDER_DV,
) = range(len(ROWS))  # fmt: skip


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


@kernel(inline=True)
def _element(values, n):
    return values[np.uint64(n * (values.size > 1))]


@kernel(inline=True)
def state_of(states, n):
    """State number n."""
    return State(
        _element(states.kappa, n), _element(states.mu, n), _element(states.V, n), _element(states.creep, n),
        states.creep_is_omega,
    )  # fmt: skip


@kernel(inline=True)
def slip_and_creep(state):
    """(a number with the sign of omega - V, creep ratio); V = 0 counts as V -> 0+."""
    V, creep = state.V, state.creep
    if not state.creep_is_omega:
        return -creep if V < 0.0 else creep, creep
    slip = creep - V
    return slip, slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)
