"""Records of the flow map's kernels.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import Any, NamedTuple


class Flow(NamedTuple):
    """The flow map of a scene.

    table : all tables of :mod:`layout` in one vector of layout.SIZE doubles.
    first : int; onsets are tabulated for kappa V from 2**first to 2**(first + layout.OCTAVES).
    kappa, mu, j : slenderness R/l0, coefficient of friction and moment of inertia J/(m R^2) of the scene.
    slow_rate : rate at which the slow logarithm falls along the slow manifold in unit time tau = gamma t, > 0.
    """

    table: Any
    first: int
    kappa: float
    mu: float
    j: float
    slow_rate: float


class Motions(NamedTuple):
    """Motions to be looked up, dimensionless.

    gamma : P T^2/(m R), the ratio of load to inertia, with the unit of time T of the law: tau = gamma t.
    rest : rest threshold of max(|V|, |omega|), 0 for none.
    V0, omega0 : initial speeds, vectors of one or n numbers.
    t : output times, (times,), ascending.
    rows : output quantities, indices of rows of an output, int, (q,), or a tuple before the kernel is called; distance,
        angle and slip loss are computed only if they are among them.
    """

    gamma: Any
    rest: Any
    V0: Any
    omega0: Any
    t: Any
    rows: Any


class Request(NamedTuple):
    """Requested outputs of a motion.

    level : SPEEDS, PATH or LOSS.
    rest : rest threshold, 0 for none.
    rest_slow_log : slow logarithm at that threshold.
    """

    level: Any
    rest: Any
    rest_slow_log: Any


class FullSlipStart(NamedTuple):
    """Start of a motion in full slip, mirrored so that omega > V.

    frame : +1, or -1 if mirrored.
    w : V - j omega.
    T, X : integrals of the table of full slip at V.
    """

    frame: Any
    w: Any
    T: Any
    X: Any


class StickOnset(NamedTuple):
    """Onset of partial slip, mirrored so that V > 0.

    frame : +1, or -1 if mirrored.
    family : PLUS or MINUS.
    v : kappa V.
    tau : time, gamma t.
    x, angle, loss : distance, angle and slip loss there, from the start of the motion, distance and angle in the frame
        of the caller.  The onset of a start in partial slip lies before the start: tau <= 0, and the three are minus
        those from the onset to the start.
    """

    frame: Any
    family: Any
    v: Any
    tau: Any
    x: Any
    angle: Any
    loss: Any


class Asymptote(NamedTuple):
    """The motion on the slow manifold that a motion in partial slip approaches.

    slow_log : its slow logarithm at the onset.
    rate : relaxation rate k0 of omega - V at onset.
    split : see :class:`.layout.FlowTables`.
    x, angle, loss : excess of distance, angle and slip loss over that motion.
    """

    slow_log: Any
    rate: Any
    split: Any
    x: Any
    angle: Any
    loss: Any


class Output(NamedTuple):
    """One output state in the frame of the caller; distance x and angle are multiplied by gamma.

    regime is a code of :mod:`..motion.records`, loss the slip loss since the start.
    """

    V: Any
    omega: Any
    x: Any
    angle: Any
    delta: Any
    regime: Any
    loss: Any
