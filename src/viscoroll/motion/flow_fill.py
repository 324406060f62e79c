"""The tables of a flow map, made from the rows of the law and from integrated motions (:func:`.rolling.motions`).

Motions give V and delta at interpolation nodes; distance, angle and loss are integrals of their polynomials.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..core.typed import Floats
from ..kernels.flow import layout
from ..kernels.flow.layout import FlowTables
from ..kernels.flow.states import DELTA_STAR, MOMENT, STIFFNESS, TRACTION, states
from ..kernels.motion.records import PARTIAL_SLIP
from ..kernels.numerics.interpolation import gauss
from ..materials.law_build import paired
from ..materials.law_table import law_table
from .flow_rows import NODES, Nodes, Rows, octaves
from .flow_store import FlowMap
from .rolling import motions

#: reasons why a scene has no map
_STOPS = "rolling resistance can hold the sliding cylinder at a speed"
_FULL_SLIP_RETURNS = "full slip returns"
_STICK_ENDS = "the stick zone does not always last"
_OUT_OF_RANGE = "its speeds or times leave the range of doubles"

#: octaves of the tables over kappa V
_SPEEDS = octaves(layout.LOW, layout.HIGH)
#: nodes and weights of the 5-point Gauss-Legendre rule on [0, 1], as in :mod:`..kernels.flow.lookup`
_GAUSS_X, _GAUSS_W = gauss(5)
#: edges of the rows over the slow logarithm
_SLOW_LOG_EDGES = np.concatenate(
    [layout.SLOW_WIDTH * np.arange(-layout.SLOW_BINS, 0), np.ldexp(1.0, np.arange(layout.SLOW_OCTAVES + 1)) - 1.0]
)
#: octaves of V above the tables at which the motion along the slow manifold starts, to approach the manifold
_RUN_IN_OCTAVES = 3
#: the slow logarithm is 0 at the first step of the slow motion below this kappa V
_SLOW_LOG_ORIGIN = 0.25
_COARSE = Nodes(layout.LAYER_TERMS)
_LAYER = octaves(layout.LAYER_LOW, layout.LAYER_HIGH)
#: octaves of the layer coordinate before the split
_OCTAVES_BEFORE_SPLIT = -layout.LAYER_LOW
#: lower end of the layer coordinate
_LOWEST_U = 2.0**layout.LAYER_LOW
#: E behind the split at which a motion has reached the slow manifold
_JOIN_E = 2.0**layout.LAYER_HIGH - 1.0
#: time before the onset of partial slip at which a motion of the layer starts, divided by the time to the split
_LEAD = 1e-6
#: values of E between which a zero of delta is searched; beyond them the kink of the law is below rounding
_CROSSINGS = np.linspace(0.0, 14.0, 71)[1:]
#: nodes of an octave of kappa V at onset for the polynomial of the split, which is smooth
_SPLIT_NODES = Nodes(6)


class NoFlowMap(Exception):
    """The scene has no flow map; the message is the reason."""


class FlowProblem(NamedTuple):
    """A scene for which a map is made.

    parameters : (material, kappa, mu, j).  law : record of the law's rows.  slow_rate : rate at which the slow
    logarithm
    falls.  threads : of the work.
    """

    parameters: tuple[Any, ...]
    law: Any
    slow_rate: float
    threads: int | None

    def at(self, V: Floats, delta: Floats) -> Floats:
        """Contact states at V and delta: rows of :mod:`..kernels.flow.states`, in the shape of V."""
        _, kappa, mu, _ = self.parameters
        out = np.empty((4, V.size))
        states(np.ascontiguousarray(V).ravel(), np.ascontiguousarray(delta).ravel(), kappa, mu, self.law, out)
        return out.reshape(4, *V.shape)

    def integrate(self, V: Floats, delta: Floats, gamma: Floats, t: Floats, reason: str) -> tuple[Floats, Floats]:
        """Integrate motions in partial slip.

        V, delta : initial speeds and creepages, (n,).  gamma : time scale of each motion, (n,).  t : common output
        times.
        reason : message of :class:`NoFlowMap` if a motion leaves partial slip.

        Returns (V, delta), each (n, times).
        """
        if not (np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()):
            raise NoFlowMap(_OUT_OF_RANGE)
        starts = V, V * (1.0 + delta)
        (V, _, _, _, delta, regime, *_), _ = motions(self.parameters, starts, gamma, t, threads=self.threads)
        if not ((regime == PARTIAL_SLIP) & (V > 0.0)).all():
            raise NoFlowMap(reason)
        return V, delta


def fill_tables(new_map: FlowMap, threads: int | None) -> str:
    """Fill the tables of a new map.

    new_map : the map, whose table is written.  threads : of the work.

    Returns the reason why the scene has no map, or "".
    """
    if new_map.slow_rate == 0.0:
        return "an elastic cylinder never slows down"
    parts, first = layout.views(new_map.table), new_map.first
    problem = FlowProblem(new_map.parameters, law_table(new_map.parameters[0]).record, new_map.slow_rate, threads)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused
            _fill_full_slip(problem, parts)
            slow = _fill_manifold(problem, parts)
            for family, sign in ((layout.PLUS, 1.0), (layout.MINUS, -1.0)):
                _fill_layers(problem, sign, first, slow, parts.asymptote[family], parts.layer[family])
    except NoFlowMap as reason:
        return str(reason)
    return ""


def _fill_full_slip(problem: FlowProblem, parts: FlowTables) -> None:
    """Fill the tables of full slip, V > 0 and V < 0, from the equation V' = +-mu - M/2.

    problem : the scene.  parts : views of the tables.  Raises :class:`NoFlowMap`.
    """
    _, kappa, mu, j = problem.parameters
    V, least = _SPEEDS.x / kappa, 2.0**layout.LOW / kappa
    found = problem.at(V, np.zeros(V.shape))
    limit = found[DELTA_STAR] * V
    for n, sign in enumerate((1.0, -1.0)):
        rate = mu - sign * 0.5 * found[MOMENT]
        if not np.isfinite(limit / rate).all():
            raise NoFlowMap(_OUT_OF_RANGE)
        if not (rate > 0.0).all():
            raise NoFlowMap(_STOPS)
        half = _SPEEDS.half / kappa
        T = NODES.integrals(1.0 / rate, half, least / mu)
        X = NODES.integrals(V / rate, half, 0.5 * least * least / mu)
        kept = 2.0 * mu * T - V * (1.0 - j) + sign * j * limit
        if not (np.diff(kept.ravel(), prepend=0.0) > 0.0).all():
            raise NoFlowMap(_STOPS)
        time, path, onset = NODES.powers(T), NODES.powers(X), NODES.powers(kept)
        parts.slide[n] = np.concatenate([paired(time, NODES.powers(limit)), path], axis=-1)
        # nearly held: the inverse would end before the speeds that are served
        if not kappa * mu * time[-3].sum() < 2.0 ** (layout.HIGH - 1):
            raise NoFlowMap(_STOPS)
        parts.after[n] = NODES.powers(_SPEEDS.inverse(time, _SPEEDS.x / (kappa * mu)) / kappa)
        u = _SPEEDS.inverse(onset, _SPEEDS.x * (1.0 + j) / kappa)
        at = [NODES.powers(value) for value in (u / kappa, _SPEEDS.value(time, u), _SPEEDS.value(path, u))]
        parts.onset[n] = np.concatenate([paired(*at[:2]), at[2]], axis=-1)


class SlowManifold(NamedTuple):
    """The slow manifold: coefficients over the slow logarithm, and of the slow logarithm over kappa V.

    rows : octaves of the slow logarithm.  speeds : V and delta.  path : remaining distance and angle to rest.
    loss : remaining slip loss.  slow_log : slow logarithm over kappa V.
    """

    rows: Rows
    speeds: tuple[Floats, Floats]
    path: tuple[Floats, Floats]
    loss: Floats
    slow_log: Floats

    def path_between(self, start: Floats, span: Floats, rate: float) -> tuple[Floats, Floats]:
        """Distance and angle along the manifold, as ``manifold_path`` of :mod:`..kernels.flow.lookup`.

        start : slow logarithms at the beginning.  span : their decrease.  rate : decrease in unit time.
        """
        end, value = start - span, self.rows.value
        x, angle = (value(one, start) - value(one, end) for one in self.path)
        V, delta = (value(one, end[..., None] + span[..., None] * _GAUSS_X) for one in self.speeds)
        near = span <= 0.25 * np.maximum(1.0 + end, 1.0)
        direct = [(_GAUSS_W * speed).sum(axis=-1) * span / rate for speed in (V, V * (1.0 + delta))]
        return np.where(near, direct[0], x), np.where(near, direct[1], angle)


def _fill_manifold(problem: FlowProblem, parts: FlowTables) -> SlowManifold:
    """Fill the tables of the slow manifold, and return it.

    problem : the scene.  parts : views of the tables.

    One motion from high to low speed gives V and delta at the nodes; remaining distance, angle and loss are
    integrals from V -> 0 upward.
    """
    rows, V, delta = _integrate_manifold(problem)
    slopes = V, V * (1.0 + delta), V * delta * problem.at(V, delta)[TRACTION]
    to_go = []
    for slope, n in zip(slopes, (1, 1, 3), strict=True):  # V falls like exp(lambda)
        below = slope[0, 0] * math.exp(n * (rows.edges[0] - rows.x[0, 0])) / n
        to_go.append(NODES.powers(NODES.integrals(slope, rows.half, below) / problem.slow_rate))
    speeds = NODES.powers(V), NODES.powers(delta)
    slow_log = rows.inverse(speeds[0], _SPEEDS.x / problem.parameters[1])
    slow = SlowManifold(rows, speeds, (to_go[0], to_go[1]), to_go[2], NODES.powers(slow_log))
    parts.slow[: len(V)] = np.concatenate([paired(*speeds), paired(*slow.path), slow.loss], axis=-1)
    parts.manifold[:] = paired(slow.slow_log, NODES.powers(rows.value(speeds[1], slow_log)))
    return slow


def _integrate_manifold(problem: FlowProblem) -> tuple[Rows, Floats, Floats]:
    """Integrate the motion along the slow manifold of ``problem``.

    Returns (rows over the slow logarithm, V and delta at their nodes).  The motion is integrated from one state to
    the next of half its speed: the remaining time to the last state then keeps its digits.  The slow logarithm is 0
    at the last state.
    """
    kappa, j, rate = problem.parameters[1], problem.parameters[3], problem.slow_rate
    V, delta, one = np.array([2.0 ** (layout.HIGH + _RUN_IN_OCTAVES) / kappa]), np.zeros(1), np.ones(1)
    halves, steps = [], []
    while kappa * V[0] > _SLOW_LOG_ORIGIN:
        between = 0.75 * V
        step = math.log(2.0) * (1.0 + j) * between / problem.at(between, np.zeros(1))[MOMENT]
        (V,), (delta,) = problem.integrate(V, delta, one, step, _FULL_SLIP_RETURNS)
        if not V[0] < between[0]:
            raise NoFlowMap(_OUT_OF_RANGE)
        halves.append((V, delta))
        steps.append(rate * step[0])
    starts = np.append(np.cumsum(steps[:0:-1])[::-1], 0.0)
    rows = Rows(_SLOW_LOG_EDGES[: np.searchsorted(_SLOW_LOG_EDGES, starts[0])])
    nodes = rows.x.ravel()[::-1]
    found = np.empty((2, nodes.size))
    for (V, delta), start, end in zip(halves, starts, [*starts[1:], -np.inf], strict=True):
        some = np.flatnonzero((nodes <= start) & (nodes > end))
        if some.size:
            (found[0, some],), (found[1, some],) = problem.integrate(
                V, delta, one, (start - nodes[some]) / rate, _FULL_SLIP_RETURNS
            )
    V, delta = found[:, ::-1].reshape(2, *rows.x.shape)
    return rows, V, delta


def _fill_layers(
    problem: FlowProblem, sign: float, first: int, slow: SlowManifold, asymptote: Floats, layer: Floats
) -> None:
    """Fill the tables of the boundary layers and asymptotes of one family.

    problem : the scene.  sign : sign of omega - V at onset.  first : lowest octave of kappa V at onset.
    slow : the slow manifold.  asymptote, layer : views of the tables, written.
    """
    kappa, onsets = problem.parameters[1], octaves(first, first + layout.OCTAVES)
    V0 = onsets.at(_COARSE) / kappa
    k0 = _stiff_rate(problem, V0)
    split_powers = _split_powers(problem, sign, onsets)
    split = np.asarray(polyval(_COARSE.t, split_powers.T), np.float64)
    V, delta, V_end = _layer_motions(problem, sign, V0, k0, split)
    # over (octave, V, octave of u, u)
    per = np.where(np.arange(_LAYER.half.size) < _OCTAVES_BEFORE_SPLIT, split[..., None] / (1.0 - _LOWEST_U), 1.0)
    half, share = per * _LAYER.half, V / V0[..., None, None]
    loss = delta * share * problem.at(V, delta)[TRACTION] / (V0 * k0)[..., None, None]
    slopes = share - 1.0, share * (1.0 + delta) - 1.0, loss
    columns = [np.log(share), delta, *(_COARSE.integrals(slope, half) for slope in slopes)]
    for column, values in enumerate(columns):
        powers = _COARSE.powers(np.moveaxis(_COARSE.powers(values), 1, -1))
        layer[:, :, column] = powers.reshape(*layer.shape[:2], -1)
    # what they have in common with the slow manifold, which they have come to
    E = split + _JOIN_E
    x, angle, lost = (_COARSE.end(slope, half) for slope in slopes)
    end = _SPEEDS.value(slow.slow_log, kappa * V_end)
    span = problem.slow_rate * E / k0
    slow_log = end + span
    slow_x, slow_angle = slow.path_between(slow_log, span, problem.slow_rate)
    x, angle = V0 / k0 * (E + x) - slow_x, V0 / k0 * (E + angle) - slow_angle
    lost = V0 * V0 * lost - (slow.rows.value(slow.loss, slow_log) - slow.rows.value(slow.loss, end))
    known = slow.slow_log[first - layout.LOW :][: layout.OCTAVES]
    above = _COARSE.powers(slow_log - _SPEEDS.value(slow.slow_log, kappa * V0))
    rates = NODES.powers(_stiff_rate(problem, onsets.x / kappa))
    gained = [_padded(_COARSE.powers(value)) for value in (x, angle, lost)]
    asymptote[:] = np.concatenate(
        [paired(known + _padded(above), rates), _padded(split_powers), paired(*gained[:2]), gained[2]], axis=-1
    )


def _stiff_rate(problem: FlowProblem, V: Floats) -> Floats:
    """k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes."""
    return (1.0 + 1.0 / problem.parameters[3]) * problem.at(V, np.zeros(V.shape))[STIFFNESS] / V


def _state_before_onset(problem: FlowProblem, sign: float, V: Floats, gamma: Floats) -> tuple[Floats, Floats]:
    """(V, delta) in full slip a short time, :data:`_LEAD` gamma, before the onset of partial slip at V."""
    _, _, mu, j = problem.parameters
    found = problem.at(V, np.zeros(V.shape))
    push, half_moment, tau = sign * mu, 0.5 * found[MOMENT], _LEAD * gamma
    before = V - tau * (push - half_moment)
    return before, (V * (1.0 + sign * found[DELTA_STAR]) + tau * (push + half_moment) / j) / before - 1.0


def _layer_motions(
    problem: FlowProblem, sign: float, V0: Floats, k0: Floats, split: Floats
) -> tuple[Floats, Floats, Floats]:
    """Motions of a boundary layer at the nodes of its tables.

    problem : the scene.  sign : sign of omega - V at onset.  V0 : speeds at onset, (octaves, nodes).
    k0 : relaxation rates there.  split : splits there.

    Returns V and delta, (octave, node of V, octave of u, node of u), and V at the end of the layer, (octave, node of
    V).
    """
    u, gamma = _LAYER.at(_COARSE), (split / k0).ravel()
    starts = _state_before_onset(problem, sign, V0.ravel(), gamma)
    before = _LEAD + np.append((u[:_OCTAVES_BEFORE_SPLIT] - _LOWEST_U) / (1.0 - _LOWEST_U), 1.0)
    V, delta = problem.integrate(*starts, gamma, before, _STICK_ENDS)
    V_on, delta_on = problem.integrate(
        V[:, -1], delta[:, -1], 1.0 / k0.ravel(), np.append(u[_OCTAVES_BEFORE_SPLIT:] - 1.0, _JOIN_E), _STICK_ENDS
    )
    shape = (*V0.shape, _LAYER.half.size, _COARSE.t.size)
    V_whole, delta_whole = (
        np.concatenate([a[:, :-1], b[:, :-1]], axis=1).reshape(shape) for a, b in ((V, V_on), (delta, delta_on))
    )
    return V_whole, delta_whole, V_on[:, -1].reshape(V0.shape)


def _split_powers(problem: FlowProblem, sign: float, onsets: Rows) -> Floats:
    """Coefficients, over kappa V at onset, of the value of E near which delta passes 0; 1 where it does not.

    problem : the scene.  sign : sign of omega - V at onset.  onsets : octaves of kappa V at onset.

    Returns (octaves, powers).
    """
    found = np.zeros((onsets.half.size, _SPLIT_NODES.t.size))
    found[:, 0] = 1.0
    if sign != np.sign(1.0 - problem.parameters[3]):
        return found
    V = (onsets.at(_SPLIT_NODES) / problem.parameters[1]).ravel()
    gamma = 1.0 / _stiff_rate(problem, V)
    _, delta = problem.integrate(*_state_before_onset(problem, sign, V, gamma), gamma, _LEAD + _CROSSINGS, _STICK_ENDS)
    passed = sign * delta < 0.0
    at = np.clip(passed.argmax(axis=1), 2, _CROSSINGS.size - 2)[:, None] + np.arange(-2, 2)
    E, delta = _CROSSINGS[at], np.take_along_axis(delta, at, axis=1)
    # the inverse of a cubic
    split = np.zeros(V.size)
    for n in range(4):
        others = [delta[:, m] / (delta[:, m] - delta[:, n]) for m in range(4) if m != n]
        split += E[:, n] * np.prod(others, axis=0)
    split = split.reshape(found.shape)
    turns = np.all(passed.any(axis=1).reshape(found.shape), axis=1)
    found[turns] = _SPLIT_NODES.powers(split[turns])
    return found


def _padded(powers: Floats) -> Floats:
    """Coefficients, padded with zeros to the number of powers of functions of one variable."""
    return np.pad(powers, [(0, 0), (0, NODES.t.size - powers.shape[-1])])
