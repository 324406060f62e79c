"""What the kernels of a motion hand to one another."""

from __future__ import annotations

from typing import Any, NamedTuple

#: regimes, as outputs give them: slip, stick and rest, omega = 0 while V is not, and V = omega = 0 by a brake
FULL, PARTIAL, REST, LOCKED, HELD = range(5)
#: stands among the changes of regime for a change of the sign of V
REVERSED = -1
#: what ends a phase: the edge of the stick zone, delta = 0, V = 0, omega = 0 under a brake, both speeds below a
#: threshold, the brake lets go; in the order of the rows of event functions; and no panel that is short enough
EDGE, KINK, TURN, STOP, SLOW, FREED, NO_EVENT, STUCK = range(8)
EVENTS = 6
#: which speed is prescribed
NEITHER, OMEGA, SPEED = range(3)
#: how a motion ends
DONE, RESTED, STEP_LIMIT, STEP_TOO_SMALL, UNDECIDED, UNSTEADY = range(6)


class Scene(NamedTuple):
    """What Eq. (22) asks of a scene.

    law : its rows (:mod:`..rows.evaluate`); gamma : scales time, and what N adds to the mass
    unlike : whether half-space and cylinder do not take half of M each
    """

    law: Any
    unlike: bool
    kappa: float
    mu: float
    gamma: float
    j: float


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
    """(V, omega) in full slip, (V, d) in partial slip, d = delta/delta_star."""

    V: float
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


class Limits(NamedTuple):
    """Tolerance, threshold of rest (0: none), and how many steps are allowed."""

    rtol: float
    rest: float
    max_steps: int


class Case(NamedTuple):
    """All that stays the same from start to end of a motion; times in tau = gamma t.

    tau, out : times of the outputs, and room for these
    paths, acting : which are asked for beside V, omega, delta and the regime: all that adds up along the way; what acts
    switches, ends : room for (t, regime behind) of switches, REVERSED among them, (k, 2), and for the ends of panels
    nodes, matrix, second_matrix : where the numbers of a panel begin (:mod:`nodes`), and Newton's matrices of p and of
        the second unknown
    """

    scene: Scene
    drive: Drive
    limits: Limits
    tau: Any
    out: Any
    paths: bool
    acting: bool
    switches: Any
    ends: Any
    nodes: Any
    matrix: Any
    second_matrix: Any


class Batch(NamedTuple):
    """Parameters and starts of many motions: arrays of one value, or of one a motion.

    law : of one material for all, or of that of each in turn (:mod:`..rows.record`)
    unlike : as in ``Scene``
    """

    law: Any
    unlike: bool
    kappa: Any
    mu: Any
    gamma: Any
    j: Any
    V0: Any
    omega0: Any
