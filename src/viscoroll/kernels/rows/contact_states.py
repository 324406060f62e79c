"""Records of contact states: what the law is given, and which quantities are written where."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import inline_kernel


class Fields(NamedTuple):
    """The row of the output that each quantity is written to; -1 for a quantity that is not requested."""

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
    """One state of the contact, dimensionless.

    kappa : R/l0, slenderness.  mu : coefficient of friction.  V : speed of the axis.
    creep : creepage delta, or angular velocity omega.  creep_is_omega : whether ``creep`` is omega.
    """

    kappa: float
    mu: float
    V: float
    creep: float
    creep_is_omega: bool


class States(NamedTuple):
    """Arrays of the fields of :class:`State`, each of length 1, for all states, or with one value a state."""

    kappa: Any
    mu: Any
    V: Any
    creep: Any
    creep_is_omega: bool


class Request(NamedTuple):
    """States, and the quantities of them that are requested.

    states : :class:`States`.  order : numbers of the states in the order of evaluation; empty: in their own order.
    to : :class:`Fields`.  out : (quantities, states), written.  first : column of ``out`` for state 0.
    """

    states: Any
    order: Any
    to: Any
    out: Any
    first: int


@inline_kernel
def element(values, n):
    """Return element ``n`` of an array that has one value for all or one each."""
    return values[np.uint64(n * (values.size > 1))]


@inline_kernel
def read_state(states, n):
    """Return the :class:`State` with number ``n`` of :class:`States`."""
    return State(
        element(states.kappa, n), element(states.mu, n), element(states.V, n), element(states.creep, n),
        states.creep_is_omega,
    )  # fmt: skip


@inline_kernel
def write_field(row, value, n, request):
    """Write a quantity of a state, if it is requested.

    row : row of the output, a field of :class:`Fields`.  value : the quantity.  n : number of the state.
    request : the :class:`Request`.
    """
    if row >= 0:
        request.out[np.uint64(row), np.uint64(n + request.first)] = value


@inline_kernel
def slip_and_creepage(state):
    """Return (slip, delta) of a :class:`State`.

    slip : a number with the sign of omega - V.  delta : the creepage (omega - V)/V; V = 0 counts as V -> 0+.
    """
    V = state.V
    creep = state.creep
    if not state.creep_is_omega:
        return -creep if V < 0.0 else creep, creep
    slip = creep - V
    return slip, slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)
