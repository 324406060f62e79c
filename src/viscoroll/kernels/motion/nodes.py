"""What a panel of time holds at its nodes: the unknowns, the integrands of the path, the functions whose zeros end a
regime, and the drive."""

from __future__ import annotations

from typing import NamedTuple

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from .collocation import INTEGRAL, SHARES, WIDE, N
from .load import AT_NODES, constant, load_of, needed, values_at
from .rates import edge, rates_of, speeds
from .records import EDGE, EVENTS, FREED, KINK, SLOW, STOP, TURN, State

#: rows of the values at the nodes: unknowns; rates of p and of the second, and of V at node 0; speed scale; p, its
#: inverse slope in V, its slope in the second unknown, what a change of p adds to the equation of that; slope at which
#: the second unknown relaxes
V, SECOND, P_RATE, RATE, V_RATE, SPEED, P, PER_P, P_SECOND, COUPLED, SLOPE = (WIDE * n for n in range(11))
#: of Newton's iteration: slopes of the interpolants of p and of the second unknown, right sides and changes of either;
#: weights of its equation; what both diagonals are less than those of the slopes; what a change of d adds to V'
P_SLOPE, SECOND_SLOPE, RIGHT, SECOND_RIGHT, CHANGE, SECOND_CHANGE = (WIDE * n for n in range(11, 17))
ONES, WEIGHTS, DIAGONAL, SECOND_DIAGONAL, FED = (WIDE * n for n in range(17, 22))
#: integrands of the path: x, angle, work of force and of torque, losses in the brake, in slip and in rolling
PATH, PATHS = WIDE * 22, 7
#: functions of events, and the drive
EVENT = PATH + WIDE * PATHS
DRIVE = EVENT + WIDE * EVENTS
#: the interpolants: of V, of the second unknown, of the path, of the function of an event; what has added up
OF_V = DRIVE + WIDE * AT_NODES
OF_SECOND, OF_PATH = OF_V + WIDE, OF_V + WIDE * 2
OF_EVENT = OF_PATH + WIDE * PATHS
TOTALS = OF_EVENT + WIDE
#: of a motion: changes of regime, what was noted, when stick first formed and when rest was reached
TURNS, NOTED, ONSET, REST_TIME = range(TOTALS + PATHS, TOTALS + PATHS + 4)
NUMBERS = REST_TIME + 1
#: |d| up to which either branch of the law serves: they differ by its square
FAINT = 1e-8


class Panel(NamedTuple):
    """A stretch of time within a piece of the drive.

    known : whether the slope of the second unknown at the left end is
    alone : whether nothing drives from there on: V is measured by its own size, and may come below the threshold of
        rest
    """

    tau: float
    length: float
    piece: int
    known: bool
    alone: bool


@kernel(inline=True)
def cut(panel, length):
    """The panel, of this length."""
    return Panel(panel.tau, length, panel.piece, panel.known, panel.alone)


@kernel(inline=True)
def time_at(panel, i):
    """tau at node i."""
    return panel.tau + panel.length * SHARES[i]


@kernel(inline=True)
def along(tau, panel):
    """v at a time, at the earliest its beginning."""
    return 2.0 * (max(tau - panel.tau, 0.0) / panel.length)


@kernel
def put_drive(panel, case):
    """Fill the drive at all nodes."""
    nodes = case.nodes
    values = values_at(panel.tau, panel.piece, case.drive)
    changes = not constant(panel.piece, case.drive.pieces)
    for i in range(N + 1):
        if changes:
            values = values_at(time_at(panel, i), panel.piece, case.drive)
        nodes[DRIVE + i], nodes[DRIVE + WIDE + i], nodes[DRIVE + WIDE * 2 + i], nodes[DRIVE + WIDE * 3 + i] = values


@kernel(inline=True)
def load_there(i, frame, case):
    """The drive at node i."""
    nodes = case.nodes
    values = nodes[DRIVE + i], nodes[DRIVE + WIDE + i], nodes[DRIVE + WIDE * 2 + i], nodes[DRIVE + WIDE * 3 + i]
    return load_of(values, frame, case)


@kernel(inline=True)
def put_node(i, rates, nodes):
    """Keep what the equations say at node i."""
    nodes[P_RATE + i], nodes[RATE + i] = rates.p_rate, rates.rate
    nodes[P + i], nodes[SPEED + i] = rates.p, max(abs(nodes[V + i]), abs(rates.omega))


@kernel(inline=True)
def may_end(event, panel, frame, case):
    """Whether an event may end this regime here."""
    if event == KINK:
        return not frame.slips
    if event == STOP:
        return frame.spin != 0.0 and not frame.locked
    return frame.locked if event == FREED else event != SLOW or (panel.alone and case.limits.rest > 0.0)


@kernel
def acting_at(i, frame, case):
    """(The equations at node i, by its unknowns as they are now; force, torque, brake)."""
    state, load = State(case.nodes[V + i], case.nodes[SECOND + i]), load_there(i, frame, case)
    rates = rates_of(state, load, frame, case.scene)
    moments = rates.Q, rates.M_half_space, rates.M_cylinder
    return rates, needed((state.V, rates.omega), moments, load, frame, case.scene.j)


@kernel(inline=True)
def put_events(panel, frame, case):
    """Fill the functions of events at all nodes of a panel that is solved."""
    nodes, scene, rest = case.nodes, by_value(case.scene), case.limits.rest
    for i in range(N + 1):
        speed, second = nodes[V + i], nodes[SECOND + i]
        nodes[EVENT + WIDE * TURN + i] = speed
        nodes[EVENT + WIDE * EDGE + i] = edge(speed, second, frame, scene)
        if not frame.slips:
            nodes[EVENT + WIDE * KINK + i] = frame.sigma * second + FAINT
        if frame.spin != 0.0 or (panel.alone and rest > 0.0):
            omega, delta = speeds(State(speed, second), frame, scene)
            # in partial slip omega vanishes with V, which is another event, and by its own
            stops = omega if frame.slips else 1.0 + delta if speed > 0.0 else 1.0
            nodes[EVENT + WIDE * STOP + i] = frame.spin * stops
            nodes[EVENT + WIDE * SLOW + i] = max(abs(speed), abs(omega)) - rest
        if frame.locked:  # of squares: smooth where what the brake takes changes its sign
            most, brake = load_there(i, frame, case).brake, acting_at(i, frame, case)[1][2]
            nodes[EVENT + WIDE * FREED + i] = most * most - brake * brake


@kernel(inline=True)
def put_path(frame, case):
    """Fill the integrands of the path at all nodes: distance and angle are integrals over t, the rest are energies."""
    nodes, pace = case.nodes, frame.direction / case.scene.gamma
    for i in range(N + 1):
        rates, (force, torque, brake) = acting_at(i, frame, case)
        speed, omega = nodes[V + i], rates.omega
        nodes[PATH + i], nodes[PATH + WIDE + i] = pace * speed, pace * omega
        nodes[PATH + WIDE * 2 + i], nodes[PATH + WIDE * 3 + i] = force * speed, torque * omega
        nodes[PATH + WIDE * 4 + i] = -brake * omega
        nodes[PATH + WIDE * 5 + i] = (omega - speed) * rates.Q
        nodes[PATH + WIDE * 6 + i] = speed * rates.M_half_space + omega * rates.M_cylinder


@kernel
def extremes(row, nodes):
    """Least and most of a row."""
    least = most = nodes[row]
    for i in range(1, N + 1):
        least, most = min(least, nodes[row + i]), max(most, nodes[row + i])
    return least, most


@kernel
def risen(row, panel, nodes):
    """Integral of a row over the panel."""
    total = 0.0
    for i in range(N):
        total += INTEGRAL[i] * nodes[row + i + 1]
    return 0.5 * panel.length * total
