"""What the kernels of a driven motion hand to one another."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..motion.records import REST

#: regimes beside those of a free motion: omega = 0 while V is not, and V = omega = 0 by a brake
LOCKED, HELD = REST + 1, REST + 2
#: stands among the changes of regime for a change of the sign of V
REVERSED = -1
#: what ends a phase: the edge of the stick zone, delta = 0, V = 0, omega = 0 under a brake, both speeds below a
#: threshold, the brake lets go; in the order of the rows of event functions; and no panel that is short enough
EDGE, KINK, TURN, STOP, SLOW, FREED, NO_EVENT, STUCK = range(8)
EVENTS = 6
#: which speed is prescribed
NEITHER, OMEGA, SPEED = range(3)


class Gains(NamedTuple):
    """Feedback: force and torque per speed."""

    force_V: float
    force_omega: float
    torque_V: float
    torque_omega: float


class Drive(NamedTuple):
    """What drives a motion.

    pieces : a row a piece of time, columns as in :mod:`load`
    prescribed : NEITHER, OMEGA or SPEED
    """

    pieces: Any
    gains: Gains
    prescribed: int


class Load(NamedTuple):
    """The drive at one time, in the frame of the motion: V' = per_V (Q - M_half_space + force) + V_rate, and
    omega' = per_omega (-Q - M_cylinder + torque) + omega_rate."""

    force: float
    torque: float
    V_rate: float
    omega_rate: float
    brake: float
    per_V: float
    per_omega: float
    gains: Gains


class Frame(NamedTuple):
    """From where a motion is seen: V >= 0 once multiplied by ``direction``.

    slips : whether slip is full
    sigma : sign of omega - V in full slip, of the branch of the law in partial slip
    spin : sign of omega, where a brake takes hold of it
    locked : whether a brake holds omega at 0
    """

    slips: bool
    direction: float
    sigma: float
    spin: float
    locked: bool


class State(NamedTuple):
    """(s, omega) in full slip, (s, b) in partial slip: s = 1/zeta, b = (1 - beta) with the sign of delta."""

    s: float
    second: float


class Clock(NamedTuple):
    """tau = gamma t, the next output column, the piece of the drive, steps taken, ends of panels noted, length of a
    panel to try (0: not known)."""

    tau: float
    at: int
    piece: int
    steps: int
    ends: int
    length: float


class Work(NamedTuple):
    """Arrays of a panel: values at the nodes, interpolants, Newton's matrix and right side, what has added up."""

    nodes: Any
    powers: Any
    matrix: Any
    right: Any
    totals: Any


class Notes(NamedTuple):
    """Room for what is noted on the way: (t, regime behind) of the switches, REVERSED among them, (k, 2), and the ends
    of panels."""

    switches: Any
    ends: Any


class Case(NamedTuple):
    """All that stays the same from start to end of a motion; times in tau.

    paths : how many of what adds up along the way are asked for: all, or none
    """

    scene: Any
    drive: Drive
    limits: Any
    tau: Any
    out: Any
    gamma: float
    paths: int
    notes: Notes
    work: Work
