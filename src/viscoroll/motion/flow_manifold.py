"""The slow manifold of a flow map: :func:`fill_manifold`.

The slow manifold is the curve in (V, delta) that all motions in partial slip approach, on which V decays to rest.  The
slow logarithm of V falls linearly in time along it, at ``FlowProblem.slow_rate``; it tends to ln V plus a constant as V
-> 0.  All is dimensionless, times are gamma t.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..core.array_types import Floats
from ..kernels.flow import layout
from ..kernels.flow.layout import FlowTables
from ..kernels.flow.states import MOMENT, TRACTION
from ..kernels.numerics.interpolation import gauss
from ..materials.law.pack import interleave_pairs
from .flow_problem import FULL_SLIP_RETURNS, OUT_OF_RANGE, SPEEDS, FlowProblem, NoFlowMap
from .flow_rows import NODES, Rows

#: 5-point Gauss-Legendre rule on [0, 1], (nodes, weights), as in :mod:`..kernels.flow.lookup`.
_GAUSS = gauss(5)
#: Edges of the rows over the slow logarithm, dimensionless.
_SLOW_LOG_EDGES = np.concatenate(
    [layout.SLOW_WIDTH * np.arange(-layout.SLOW_BINS, 0), np.ldexp(1.0, np.arange(layout.SLOW_OCTAVES + 1)) - 1.0]
)
#: Octaves of V above the tables at which the motion along the slow manifold starts, to approach the manifold.
_RUN_IN_OCTAVES = 3
#: kappa V, dimensionless: the slow logarithm is 0 at the first state of the slow motion that is at or below it.
_SLOW_LOG_ORIGIN = 0.25


class SlowManifold(NamedTuple):
    """The slow manifold: functions of the slow logarithm, and the slow logarithm as a function of kappa V.

    Each is given by coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers).

    rows : rows of the slow logarithm.
    speeds : coefficients of V and of delta.
    path : coefficients of the remaining distance and angle to rest.
    loss : coefficients of the remaining slip loss.
    slow_log : coefficients of the slow logarithm over the octaves of kappa V.
    """

    rows: Rows
    speeds: tuple[Floats, Floats]
    path: tuple[Floats, Floats]
    loss: Floats
    slow_log: Floats

    def path_between(self, start: Floats, span: Floats, rate: float) -> tuple[Floats, Floats]:
        """Return distance and angle of a motion along the slow manifold, while its slow logarithm decreases.

        They are differences of the remaining path to rest.  Over a short span, at most a quarter of max(1 + end, 1)
        with the slow logarithm at its end, these would cancel, and they are integrals of the speeds by a 5-point Gauss
        rule.

        start : slow logarithms at the beginning, of any shape.
        span : decreases of the slow logarithms, >= 0, in the shape of ``start``.
        rate : decrease of the slow logarithm in unit time gamma t, > 0.
        Returns (distance, angle), integrals over gamma t of V and omega, >= 0, of the shape of ``start``,
        dimensionless.
        """
        end, value = start - span, self.rows.value
        x, angle = (value(powers, start) - value(powers, end) for powers in self.path)
        V, delta = (value(powers, end[..., None] + span[..., None] * _GAUSS[0]) for powers in self.speeds)
        near = span <= 0.25 * np.maximum(1.0 + end, 1.0)
        direct = [(_GAUSS[1] * speed).sum(axis=-1) * span / rate for speed in (V, V * (1.0 + delta))]
        return np.where(near, direct[0], x), np.where(near, direct[1], angle)


def fill_manifold(problem: FlowProblem, parts: FlowTables) -> SlowManifold:
    """Fill the tables of the slow manifold.

    One motion from high to low speed gives V and delta at the nodes; remaining distance, angle and loss are integrals
    from V -> 0 upward.

    problem : the :class:`FlowProblem`.
    parts : :class:`FlowTables`, views of the tables, of which ``slow`` and ``manifold`` are written; rows of ``slow``
    above the highest speed of the tables stay as they are.
    Raises :class:`NoFlowMap` where that motion leaves partial slip or its numbers the range of doubles.
    Returns the :class:`SlowManifold`, the same functions as coefficients.
    """
    rows, V, delta = _integrate_manifold(problem)
    slopes = V, V * (1.0 + delta), V * delta * problem.contact_states(V, delta)[TRACTION]
    to_go = []
    for slope, n in zip(slopes, (1, 1, 3), strict=True):  # V falls like exp(lambda)
        below = slope[0, 0] * math.exp(n * (rows.edges[0] - rows.x[0, 0])) / n
        to_go.append(NODES.powers(NODES.integrals(slope, rows.half, below) / problem.slow_rate))
    speeds = NODES.powers(V), NODES.powers(delta)
    slow_log = rows.inverse(speeds[0], SPEEDS.x / problem.parameters[1])
    slow = SlowManifold(rows, speeds, (to_go[0], to_go[1]), to_go[2], NODES.powers(slow_log))
    parts.slow[: len(V)] = np.concatenate([interleave_pairs(*speeds), interleave_pairs(*slow.path), slow.loss], axis=-1)
    parts.manifold[:] = interleave_pairs(slow.slow_log, NODES.powers(rows.value(speeds[1], slow_log)))
    return slow


def _integrate_manifold(problem: FlowProblem) -> tuple[Rows, Floats, Floats]:
    """Integrate the motion along the slow manifold, from three octaves above the tables down to their lowest node.

    It is integrated in steps, each of about the time in which V halves, until kappa V is at most 1/4, and each step
    anew from the state before it: the remaining time to the last of these states then keeps its digits.  The slow
    logarithm is 0 at that state, and increases with the time that a state precedes it.

    problem : the :class:`FlowProblem`.
    Raises :class:`NoFlowMap` for FULL_SLIP_RETURNS where the motion leaves partial slip, and for OUT_OF_RANGE where its
    numbers are not finite or V does not fall.
    Returns (:class:`Rows` over the slow logarithm, those of :data:`_SLOW_LOG_EDGES` that end below its value at the
    first of these states; V; delta at their nodes, (rows, nodes) each, dimensionless).
    """
    kappa, j, rate = problem.parameters[1], problem.parameters[3], problem.slow_rate
    V, delta, gamma = np.array([2.0 ** (layout.HIGH + _RUN_IN_OCTAVES) / kappa]), np.zeros(1), np.ones(1)
    halves, steps = [], []
    while kappa * V[0] > _SLOW_LOG_ORIGIN:
        between = 0.75 * V
        step = math.log(2.0) * (1.0 + j) * between / problem.contact_states(between, np.zeros(1))[MOMENT]
        (V,), (delta,) = problem.integrate(V, delta, gamma, step, FULL_SLIP_RETURNS)
        if not V[0] < between[0]:
            raise NoFlowMap(OUT_OF_RANGE)
        halves.append((V, delta))
        steps.append(rate * step[0])
    starts = np.append(np.cumsum(steps[:0:-1])[::-1], 0.0)
    rows = Rows(_SLOW_LOG_EDGES[: np.searchsorted(_SLOW_LOG_EDGES, starts[0])])
    nodes = rows.x.ravel()[::-1]
    states = np.empty((2, nodes.size))
    for (V, delta), start, end in zip(halves, starts, [*starts[1:], -np.inf], strict=True):
        inside = np.flatnonzero((nodes <= start) & (nodes > end))
        if inside.size:
            (states[0, inside],), (states[1, inside],) = problem.integrate(
                V, delta, gamma, (start - nodes[inside]) / rate, FULL_SLIP_RETURNS
            )
    V, delta = states[:, ::-1].reshape(2, *rows.x.shape)
    return rows, V, delta
