"""What a panel of time holds at its nodes: the unknowns, the integrands of the path, the functions whose zeros end a
regime, and the drive."""

from __future__ import annotations

from typing import NamedTuple

from ..compile.jit import kernel
from ..motion.collocation import INTEGRAL, NODES, SLOPES, N
from ..motion.path import grade
from .load import FUNCTIONS, load_of, needed, threshold, values_at
from .rates import rates_at
from .records import EDGE, EVENTS, FREED, KINK, SLOW, STOP, TURN

#: rows of the values at the nodes: unknowns, their rates, speed scale; what the path is made of; slope at which the
#: second unknown relaxes; s/V; integrands of the path; functions of events
S, SECOND, S_RATE, RATE, SPEED, OF_V, OF_OMEGA, OF_DELTA, OF_Q, OF_HALF_SPACE, OF_CYLINDER, SLOPE, PER_V = range(13)
PATH = 13
#: of the path: x, angle, work of force and of torque, losses in the brake, in slip and in rolling
PATHS = 7
EVENT = PATH + PATHS
#: the drive
DRIVE = EVENT + EVENTS
ROWS = DRIVE + FUNCTIONS
#: rows of the interpolants: of s, of the second unknown, of the path, of the function of an event
OF_S, OF_SECOND, OF_PATH, OF_EVENT = 0, 1, 2, 2 + PATHS
INTERPOLANTS = OF_EVENT + 1


class Panel(NamedTuple):
    """A stretch of time within a piece of the drive; it grows as (v/2)^power, v in [0, 2].

    free : whether the slope of the second unknown at the left end is known
    """

    tau: float
    length: float
    power: int
    piece: int
    free: bool


class Slopes(NamedTuple):
    """Of the rates at a node in the second unknown, and the weight of the slope of that."""

    s: float
    rate: float
    weight: float


@kernel
def put_drive(panel, case):
    """Fill the drive at all nodes."""
    nodes = case.work.nodes
    for i in range(N + 1):
        tau, _ = time_at(panel, i)
        values = values_at(tau, panel.piece, case.drive)
        nodes[DRIVE, i], nodes[DRIVE + 1, i], nodes[DRIVE + 2, i], nodes[DRIVE + 3, i] = values


@kernel(inline=True)
def load_there(i, frame, case):
    """The drive at node i."""
    nodes = case.work.nodes
    return load_of((nodes[DRIVE, i], nodes[DRIVE + 1, i], nodes[DRIVE + 2, i], nodes[DRIVE + 3, i]), frame, case)


@kernel(inline=True)
def put_node(i, weight, load, frame, case):
    """Fill node i from its unknowns, rates times ``weight``: their slopes, times that too."""
    nodes = case.work.nodes
    rates = rates_at(nodes[S, i], nodes[SECOND, i], load, frame, case.scene)
    nodes[S_RATE, i], nodes[RATE, i] = weight * rates.s_rate, weight * rates.rate
    nodes[SPEED, i] = max(abs(rates.V), abs(rates.omega))
    nodes[OF_V, i], nodes[OF_OMEGA, i], nodes[OF_DELTA, i] = rates.V, rates.omega, rates.delta
    nodes[OF_Q, i], nodes[OF_HALF_SPACE, i], nodes[OF_CYLINDER, i] = rates.Q, rates.M_half_space, rates.M_cylinder
    nodes[SLOPE, i], nodes[PER_V, i] = rates.rate_slope / rates.weight, abs(nodes[S, i] / rates.V)
    nodes[EVENT + EDGE, i] = rates.edge
    return Slopes(weight * rates.s_slope, weight * rates.rate_slope, rates.weight)


@kernel
def put_path(panel, frame, case):
    """Fill the integrands of the path and the functions of events at all nodes of a panel that is solved."""
    nodes, rest = case.work.nodes, threshold(panel.piece, case)
    for i in range(N + 1):
        _, weight = time_at(panel, i)
        V, omega, Q = nodes[OF_V, i], nodes[OF_OMEGA, i], nodes[OF_Q, i]
        M_half_space, M_cylinder = nodes[OF_HALF_SPACE, i], nodes[OF_CYLINDER, i]
        load = load_there(i, frame, case)
        force, torque, brake = needed((V, omega), (Q, M_half_space, M_cylinder), load, frame, case.scene.j)
        slip = omega - V if frame.slips else V * nodes[OF_DELTA, i]
        nodes[PATH, i], nodes[PATH + 1, i] = weight * V, weight * omega
        nodes[PATH + 2, i], nodes[PATH + 3, i] = weight * (force * V), weight * (torque * omega)
        nodes[PATH + 4, i], nodes[PATH + 5, i] = -weight * (brake * omega), weight * (slip * Q)
        nodes[PATH + 6, i] = weight * (V * M_half_space + omega * M_cylinder)
        nodes[EVENT + KINK, i] = 1.0 if frame.slips else frame.sigma * nodes[SECOND, i]
        nodes[EVENT + TURN, i] = nodes[S, i]
        nodes[EVENT + STOP, i] = frame.spin * omega if frame.spin != 0.0 and not frame.locked else 1.0
        nodes[EVENT + SLOW, i] = nodes[SPEED, i] - rest if rest > 0.0 else 1.0
        # of squares: smooth where what the brake takes changes its sign
        nodes[EVENT + FREED, i] = load.brake * load.brake - brake * brake if frame.locked else 1.0


@kernel(inline=True)
def time_at(panel, i):
    """(tau, weight of the rates) at node i."""
    share = 0.5 * (1.0 + NODES[i])
    return panel.tau + panel.length * share**panel.power, grade(share, panel.power)


@kernel(inline=True)
def slope_at(i, row, nodes):
    """Slope in t of the interpolant of a row at node i."""
    total = 0.0
    for k in range(N + 1):
        total += SLOPES[i - 1, k] * nodes[row, k]
    return total


@kernel
def risen(row, panel, nodes):
    """Integral of a row over the panel."""
    total = 0.0
    for i in range(N):
        total += INTEGRAL[i] * nodes[row, i + 1]
    return 0.5 * panel.length * total
