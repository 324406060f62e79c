"""Integrals over a panel in partial slip: y, time, distance, angle; and what they err by.

A node holds y and what is integrated over the panel for y, tau, X and angle - X, per unit of its length.
"""

from __future__ import annotations

from ..compile.jit import kernel
from .collocation import INTEGRAL, TO_START, N, integral_terms
from .control import path_error
from .records import State

#: rows of the values at the nodes; D, its rate and D/zeta where both unknowns are integrated
Y, D_Y, D_TAU, D_X, D_TURN, D, D_D, SHARE_D = range(8)
ROWS = 8
#: rows of the interpolants: tau, X and angle - X; y; D
TAU, X, TURN, RISE_Y, RISE_D = range(5)
#: a mismatch of the integrands at the left end overstates the error of their interpolants
OVERSTATED = 0.02


@kernel
def rise_and_mismatch(row, half, nodes):
    """(Rise over the panel, mismatch at its left end) of a row."""
    rise, off = 0.0, nodes[row, 0]
    for i in range(N):
        rise += INTEGRAL[i] * nodes[row, i + 1]
        off -= TO_START[i] * nodes[row, i + 1]
    return half * rise, 2.0 * half * off


@kernel
def path_mismatch(length, creep, state, nodes):
    """Error of the interpolants at a given time.

    An error of the time alone moves y, X and the angle with their rates at the end: it cancels.  What moves in
    proportion to the length is the creep ratio, of which ``creep`` is still to fall.
    """
    half = 0.5 * length
    _, late = rise_and_mismatch(D_TAU, half, nodes)
    late /= nodes[D_TAU, N]
    _, y_off = rise_and_mismatch(D_Y, half, nodes)
    X_rise, X_off = rise_and_mismatch(D_X, half, nodes)
    turn, turn_off = rise_and_mismatch(D_TURN, half, nodes)
    X_off, turn_off = abs(X_off - late * nodes[D_X, N]), abs(turn_off - late * nodes[D_TURN, N])
    error = path_error(X_rise, X_off, X_rise + turn, turn_off, state, OVERSTATED)
    return max(abs(y_off - late * nodes[D_Y, N]), abs(late) * creep, error)


@kernel
def grade(share, power):
    """Slope of share^power."""
    return power * share ** (power - 1)


@kernel
def time_terms(half, nodes, powers):
    """Interpolants of tau, X, angle - X."""
    integral_terms(nodes[D_TAU], half, powers, TAU)
    integral_terms(nodes[D_X], half, powers, X)
    integral_terms(nodes[D_TURN], half, powers, TURN)


@kernel
def next_start(power, nodes):
    """Put node 0 at the end of the panel."""
    nodes[Y, 0] = nodes[Y, N]
    for row in (D_Y, D_TAU, D_X, D_TURN):
        nodes[row, 0] = nodes[row, N] / power


@kernel
def moved(first, second, X_rise, angle_rise, state):
    """The state with these unknowns, and so much further on its way."""
    return State(
        first, second, state.X + X_rise, state.angle + angle_rise,
        state.way + abs(X_rise), state.turned + abs(angle_rise),
    )  # fmt: skip
