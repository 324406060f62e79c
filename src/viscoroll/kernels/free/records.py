"""What the kernels of a motion hand to one another: regimes, events, and records."""

from __future__ import annotations

from typing import Any, NamedTuple

#: regimes, as outputs give them
FULL, PARTIAL, REST = 0, 1, 2
#: what ends a phase: the stick zone forms, or is lost; V passes 0 in full slip; both speeds fall below a threshold; no
#: panel is short enough
NO_EVENT, STICK, SLIP, REVERSAL, AT_REST, STUCK = range(6)
#: what a panel is a function of: s in full slip; e-folds of the boundary layer, y on the slow manifold, or time
SLIDE, LAYER, SLOW, TIME = range(4)


class Scene(NamedTuple):
    """What Eq. (22) asks of a scene beside gamma, which only scales time."""

    material: Any
    kappa: float
    mu: float
    j: float


class Frame(NamedTuple):
    """From where a motion is seen: V >= 0 once multiplied by ``direction``; sigma = sign(omega - V) in full slip."""

    regime: int
    direction: float
    sigma: float


class State(NamedTuple):
    """Unknowns in their frame: (s, w) = (1/zeta, V - j omega) in full slip, (y, D) = (ln zeta, D) in partial slip.

    X and angle are gamma times the distance and the angle, ``way`` and ``turned`` what either has added up to.
    """

    first: float
    second: float
    X: float
    angle: float
    way: float
    turned: float


class Clock(NamedTuple):
    """tau = gamma t, the next output column, steps taken, ends of steps noted."""

    tau: float
    at: int
    steps: int
    ends: int


class Limits(NamedTuple):
    """Tolerance, threshold of rest (0: none), and how many steps are allowed."""

    rtol: float
    rest: float
    max_steps: int


class Notes(NamedTuple):
    """Room for what is noted on the way: (t, regime behind) of the switches, (k, 2), and the ends of steps."""

    switches: Any
    step_ends: Any


class Sink(NamedTuple):
    """Where outputs go: times, columns, and room for the ends of steps."""

    tau: Any
    out: Any
    step_ends: Any
    gamma: float


class Panel(NamedTuple):
    """A stretch of a motion, from its left end; interpolants are functions of v in [0, 2].

    kind : SLIDE, LAYER, SLOW or TIME
    first, second : unknowns at the left end; of a layer the second is the distance from the manifold
    length : of the independent variable, which grows as (v/2)^power
    pole, end, V, omega : of a slide: see :mod:`slide`
    """

    kind: int
    first: float
    second: float
    length: float
    power: int
    pole: float
    end: float
    V: float
    omega: float


class Workspace(NamedTuple):
    """Arrays that panels are computed in.

    nodes : values at the nodes; powers : their interpolants
    values : those on the slow manifold; slow : that manifold around a layer
    matrix, right : a linear system
    """

    nodes: Any
    powers: Any
    values: Any
    slow: Any
    matrix: Any
    right: Any


class Case(NamedTuple):
    """All that stays the same from start to end of a motion."""

    scene: Scene
    limits: Limits
    sink: Sink
    work: Workspace


class Batch(NamedTuple):
    """Parameters and starts of many motions: arrays of one value, or of one a motion.

    material : one for all (``Tabulated``), an alpha each (``Own``), or a series each (``Each``)
    """

    material: Any
    kappa: Any
    mu: Any
    gamma: Any
    j: Any
    V0: Any
    omega0: Any
