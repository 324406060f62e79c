"""Records of contact states: what the law is given, and which quantities are written where."""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import inline_kernel

#: The row of the output that each quantity is written to; -1 for a quantity that is not requested.  The names are those
#: of the fields of ``contact``.
Fields = namedtuple(
    "Fields",
    "lam zeta epsilon delta_star delta full_slip beta grip Q M dQ_dV dQ_ddelta dQ_domega dM_dV "
    "M_half_space M_cylinder dM_half_space_dV dM_cylinder_dV delta_0 "
    "dM_ddelta dM_domega dM_half_space_domega dM_cylinder_domega",
    defaults=[-1] * 23,
)

#: States that pass through the stages of the evaluation together: enough that a loop over them costs little for each,
#: and few enough that their scratch stays in the first cache.
TOGETHER = 64
#: Numbers of the scratch of :func:`.contact.contact_loop`.
SCRATCH_SIZE = 16 * TOGETHER


class State(NamedTuple):
    """One state of the contact, dimensionless; or arrays of states, each of length 1 or with one value for each.

    kappa : R/l0, slenderness.
    mu : coefficient of friction.
    V : speed of the axis, of any sign.
    creep : creepage delta = (omega - V)/V, or angular velocity omega, of any sign.
    creep_is_omega : whether ``creep`` is omega; one bool for all states.
    """

    kappa: Any
    mu: Any
    V: Any
    creep: Any
    creep_is_omega: bool


class Request(NamedTuple):
    """States, and the quantities of them that are requested.

    states : a :class:`State` of arrays, each of length 1 or with one number for each state.
    order : numbers of the states in the order of evaluation, int; empty: in their own order.
    to : :class:`Fields`, for each quantity its row of ``out``, -1 if it is not requested.
    out : (requested quantities, columns), dimensionless, written; state n has column ``first`` + n.
    first : int, column of ``out`` for state 0.
    """

    states: Any
    order: Any
    to: Any
    out: Any
    first: int


@inline_kernel
def element(values, n):
    """Return an element of an array that has one value for all states, or one for each.

    values : array of one axis, not empty.
    n : int, index of the state, >= 0; not checked.
    Returns ``values[n]``; of an array of length 1 its only element, whatever n is.
    """
    return values[np.uint64(n * (values.size > 1))]


@inline_kernel
def read_state(states, n):
    """Return one state of arrays of states.

    states : :class:`State` of arrays, each of length 1, for all states, or with one number for each.
    n : int, index of the state, >= 0; not checked.
    Returns a :class:`State` of numbers, dimensionless, with the ``creep_is_omega`` of ``states``.
    """
    return State(
        element(states.kappa, n), element(states.mu, n), element(states.V, n), element(states.creep, n),
        states.creep_is_omega,
    )  # fmt: skip


@inline_kernel
def write_field(row, value, n, request):
    """Write a quantity of a state into the output, if it is requested.

    row : int, row of ``request.out``: a field of the :class:`Fields` of ``request``; if it is below 0, nothing is
        written.
    value : float, the quantity, dimensionless.
    n : int, index of the state; its column is n + ``request.first``.
    request : :class:`Request` of states and quantities, of whose ``out`` one number is written.  Returns nothing.
    """
    if row >= 0:
        request.out[np.uint64(row), np.uint64(n + request.first)] = value


@inline_kernel
def slip_and_creepage(state):
    """Return the direction of slip and the creepage of a state, whichever of creepage and omega it has.

    state : :class:`State` of numbers, of which V, ``creep`` (delta or omega, dimensionless) and ``creep_is_omega`` are
        read.

    Returns (slip, delta), floats, dimensionless.  If omega is given, slip is omega - V; if delta is given, it is delta,
    or -delta for V < 0, which has the sign of omega - V but not its size.  delta is the creepage (omega - V)/V.  V = 0
    counts as V -> 0+: if omega is given, delta is 0 for omega = 0 and else infinite with the sign of omega.
    """
    V = state.V
    creep = state.creep
    if not state.creep_is_omega:
        return -creep if V < 0.0 else creep, creep
    slip = creep - V
    return slip, slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)
