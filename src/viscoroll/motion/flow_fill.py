"""The tables of a flow map, from the row of M and from motions of the scene (:func:`.rolling.motions`).

Motions give V and delta at nodes; distance, angle and loss are integrals of what these are fitted by.
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
from ..kernels.motion.records import PARTIAL
from ..kernels.numerics.nodes import gauss
from ..materials.law_build import paired
from ..materials.law_table import law_table
from .flow_rows import NODES, Nodes, Rows, octaves
from .flow_store import FlowMap
from .rolling import motions

_HELD = "rolling resistance can hold the sliding cylinder at a speed"
_SLIPS = "full slip returns"
_ENDS = "the stick zone does not always last"
_BEYOND = "its speeds or times leave the range of doubles"

_SPEEDS = octaves(layout.LOW, layout.HIGH)
_GAUSS_X, _GAUSS_W = gauss(5)
#: edges of rows over lambda
_LAMBDA = np.concatenate(
    [layout.SLOW_WIDTH * np.arange(-layout.SLOW_BINS, 0), np.ldexp(1.0, np.arange(layout.SLOW_OCTAVES + 1)) - 1.0]
)
#: octaves above the tables in which the start of the slow motion is forgotten; kappa V below which lambda is 0
_EXTRA, _ORIGIN = 3, 0.25
_COARSE = Nodes(layout.LAYER_TERMS)
_LAYER = octaves(layout.LAYER_LOW, layout.LAYER_HIGH)
_BEFORE, _LEAST_U = -layout.LAYER_LOW, 2.0**layout.LAYER_LOW
#: E behind the split at which a motion is joined to the slow manifold
_JOINED = 2.0**layout.LAYER_HIGH - 1.0
#: a motion starts in full slip so shortly before its entry, over the time to the split
_BEFOREHAND = 1e-6
#: E where delta = 0 is looked for (behind, the bend of the law is below rounding), and powers that fit it in an octave
_CROSSINGS, _SPLIT = np.linspace(0.0, 14.0, 71)[1:], Nodes(6)


class Unserved(Exception):
    """What stands against a map, in words."""


class Case(NamedTuple):
    """A scene: its parameters, the law's record, the rate at which lambda falls, threads."""

    parameters: tuple[Any, ...]
    law: Any
    slow_rate: float
    threads: int | None

    def at(self, V: Floats, delta: Floats) -> Floats:
        """Rows of :mod:`..kernels.flow.states`, in the shape of V."""
        _, kappa, mu, _ = self.parameters
        out = np.empty((4, V.size))
        states(np.ascontiguousarray(V).ravel(), np.ascontiguousarray(delta).ravel(), kappa, mu, self.law, out)
        return out.reshape(4, *V.shape)

    def rolled(self, V: Floats, delta: Floats, gamma: Floats, t: Floats, problem: str) -> tuple[Floats, Floats]:
        """(V, delta) of motions at common times."""
        if not (np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()):
            raise Unserved(_BEYOND)
        starts = V, V * (1.0 + delta)
        (V, _, _, _, delta, regime, *_), _ = motions(self.parameters, starts, gamma, t, threads=self.threads)
        if not ((regime == PARTIAL) & (V > 0.0)).all():
            raise Unserved(problem)
        return V, delta


def fill(made: FlowMap, threads: int | None) -> str:
    """Fill the tables of a map; what stands against it, or nothing."""
    if made.slow_rate == 0.0:
        return "an elastic cylinder never slows down"
    parts, first = layout.views(made.table), made.first
    case = Case(made.parameters, law_table(made.parameters[0]).record, made.slow_rate, threads)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused
            _fill_slides(case, parts)
            slow = _fill_slow(case, parts)
            for family, sign in ((layout.PLUS, 1.0), (layout.MINUS, -1.0)):
                _fill_layers(case, sign, first, slow, parts.entry[family], parts.layer[family])
    except Unserved as problem:
        return str(problem)
    return ""


def _fill_slides(case: Case, parts: FlowTables) -> None:
    """Full slip, V > 0 and V < 0: V' = +-mu - M/2 stands alone."""
    _, kappa, mu, j = case.parameters
    V, least = _SPEEDS.x / kappa, 2.0**layout.LOW / kappa
    found = case.at(V, np.zeros(V.shape))
    limit = found[DELTA_STAR] * V
    for n, sign in enumerate((1.0, -1.0)):
        rate = mu - sign * 0.5 * found[MOMENT]
        if not np.isfinite(limit / rate).all():
            raise Unserved(_BEYOND)
        if not (rate > 0.0).all():
            raise Unserved(_HELD)
        half = _SPEEDS.half / kappa
        T = NODES.integrals(1.0 / rate, half, least / mu)
        X = NODES.integrals(V / rate, half, 0.5 * least * least / mu)
        kept = 2.0 * mu * T - V * (1.0 - j) + sign * j * limit
        if not (np.diff(kept.ravel(), prepend=0.0) > 0.0).all():
            raise Unserved(_HELD)
        time, path, onset = NODES.powers(T), NODES.powers(X), NODES.powers(kept)
        parts.slide[n] = np.concatenate([paired(time, NODES.powers(limit)), path], axis=-1)
        # nearly held: the inverse would end before the speeds that are served
        if not kappa * mu * time[-3].sum() < 2.0 ** (layout.HIGH - 1):
            raise Unserved(_HELD)
        parts.after[n] = NODES.powers(_SPEEDS.inverse(time, _SPEEDS.x / (kappa * mu)) / kappa)
        u = _SPEEDS.inverse(onset, _SPEEDS.x * (1.0 + j) / kappa)
        at = [NODES.powers(value) for value in (u / kappa, _SPEEDS.value(time, u), _SPEEDS.value(path, u))]
        parts.onset[n] = np.concatenate([paired(*at[:2]), at[2]], axis=-1)


class Slow(NamedTuple):
    """The slow manifold: powers over lambda, and of lambda over kappa V.

    speeds, path, loss : V and delta; what is left to rest of distance and angle; of the energy lost in slip.
    """

    rows: Rows
    speeds: tuple[Floats, Floats]
    path: tuple[Floats, Floats]
    loss: Floats
    lam: Floats

    def travelled(self, start: Floats, span: Floats, rate: float) -> tuple[Floats, Floats]:
        """As ``manifold_path`` of :mod:`..kernels.flow.read`."""
        end, value = start - span, self.rows.value
        x, angle = (value(one, start) - value(one, end) for one in self.path)
        V, delta = (value(one, end[..., None] + span[..., None] * _GAUSS_X) for one in self.speeds)
        near = span <= 0.25 * np.maximum(1.0 + end, 1.0)
        direct = [(_GAUSS_W * speed).sum(axis=-1) * span / rate for speed in (V, V * (1.0 + delta))]
        return np.where(near, direct[0], x), np.where(near, direct[1], angle)


def _fill_slow(case: Case, parts: FlowTables) -> Slow:
    """The slow manifold: one motion from above, read at nodes; what is left to rest by integrals from V -> 0 upward."""
    rows, V, delta = _slow_motion(case)
    slopes = V, V * (1.0 + delta), V * delta * case.at(V, delta)[TRACTION]
    to_go = []
    for slope, n in zip(slopes, (1, 1, 3), strict=True):  # V falls like exp(lambda)
        below = slope[0, 0] * math.exp(n * (rows.edges[0] - rows.x[0, 0])) / n
        to_go.append(NODES.powers(NODES.integrals(slope, rows.half, below) / case.slow_rate))
    speeds = NODES.powers(V), NODES.powers(delta)
    lam = rows.inverse(speeds[0], _SPEEDS.x / case.parameters[1])
    slow = Slow(rows, speeds, (to_go[0], to_go[1]), to_go[2], NODES.powers(lam))
    parts.slow[: len(V)] = np.concatenate([paired(*speeds), paired(*slow.path), slow.loss], axis=-1)
    parts.manifold[:] = paired(slow.lam, NODES.powers(rows.value(speeds[1], lam)))
    return slow


def _slow_motion(case: Case) -> tuple[Rows, Floats, Floats]:
    """(Rows over lambda, V, delta at their nodes).

    A motion from one state to the next of half its speed, so that the time left to the last one is not lost in that
    passed; lambda is 0 there.
    """
    kappa, j, rate = case.parameters[1], case.parameters[3], case.slow_rate
    V, delta, one = np.array([2.0 ** (layout.HIGH + _EXTRA) / kappa]), np.zeros(1), np.ones(1)
    halves, steps = [], []
    while kappa * V[0] > _ORIGIN:
        between = 0.75 * V
        step = math.log(2.0) * (1.0 + j) * between / case.at(between, np.zeros(1))[MOMENT]
        (V,), (delta,) = case.rolled(V, delta, one, step, _SLIPS)
        if not V[0] < between[0]:
            raise Unserved(_BEYOND)
        halves.append((V, delta))
        steps.append(rate * step[0])
    starts = np.append(np.cumsum(steps[:0:-1])[::-1], 0.0)
    rows = Rows(_LAMBDA[: np.searchsorted(_LAMBDA, starts[0])])
    nodes = rows.x.ravel()[::-1]
    found = np.empty((2, nodes.size))
    for (V, delta), start, end in zip(halves, starts, [*starts[1:], -np.inf], strict=True):
        some = np.flatnonzero((nodes <= start) & (nodes > end))
        if some.size:
            (found[0, some],), (found[1, some],) = case.rolled(V, delta, one, (start - nodes[some]) / rate, _SLIPS)
    V, delta = found[:, ::-1].reshape(2, *rows.x.shape)
    return rows, V, delta


def _fill_layers(case: Case, sign: float, first: int, slow: Slow, entry: Floats, layer: Floats) -> None:
    """The motions that enter the stick zone with omega - V of this sign."""
    kappa, onsets = case.parameters[1], octaves(first, first + layout.OCTAVES)
    V0 = onsets.at(_COARSE) / kappa
    k0 = _stiff_rate(case, V0)
    split_powers = _splits(case, sign, onsets)
    split = np.asarray(polyval(_COARSE.t, split_powers.T), np.float64)
    V, delta, V_end = _layer_motions(case, sign, V0, k0, split)
    # over (octave, V, octave of u, u)
    per = np.where(np.arange(_LAYER.half.size) < _BEFORE, split[..., None] / (1.0 - _LEAST_U), 1.0)
    half, share = per * _LAYER.half, V / V0[..., None, None]
    loss = delta * share * case.at(V, delta)[TRACTION] / (V0 * k0)[..., None, None]
    slopes = share - 1.0, share * (1.0 + delta) - 1.0, loss
    columns = [np.log(share), delta, *(_COARSE.integrals(slope, half) for slope in slopes)]
    for column, values in enumerate(columns):
        powers = _COARSE.powers(np.moveaxis(_COARSE.powers(values), 1, -1))
        layer[:, :, column] = powers.reshape(*layer.shape[:2], -1)
    # what they have in common with the slow manifold, which they have come to
    E = split + _JOINED
    x, angle, lost = (_COARSE.end(slope, half) for slope in slopes)
    end = _SPEEDS.value(slow.lam, kappa * V_end)
    span = case.slow_rate * E / k0
    lam = end + span
    slow_x, slow_angle = slow.travelled(lam, span, case.slow_rate)
    x, angle = V0 / k0 * (E + x) - slow_x, V0 / k0 * (E + angle) - slow_angle
    lost = V0 * V0 * lost - (slow.rows.value(slow.loss, lam) - slow.rows.value(slow.loss, end))
    known = slow.lam[first - layout.LOW :][: layout.OCTAVES]
    above = _COARSE.powers(lam - _SPEEDS.value(slow.lam, kappa * V0))
    rates = NODES.powers(_stiff_rate(case, onsets.x / kappa))
    gained = [_padded(_COARSE.powers(value)) for value in (x, angle, lost)]
    entry[:] = np.concatenate(
        [paired(known + _padded(above), rates), _padded(split_powers), paired(*gained[:2]), gained[2]], axis=-1
    )


def _stiff_rate(case: Case, V: Floats) -> Floats:
    """k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes."""
    return (1.0 + 1.0 / case.parameters[3]) * case.at(V, np.zeros(V.shape))[STIFFNESS] / V


def _entering(case: Case, sign: float, V: Floats, gamma: Floats) -> tuple[Floats, Floats]:
    """(V, delta) so shortly before an entry at V that t = :data:`_BEFOREHAND` passes until then."""
    _, _, mu, j = case.parameters
    found = case.at(V, np.zeros(V.shape))
    push, half_moment, tau = sign * mu, 0.5 * found[MOMENT], _BEFOREHAND * gamma
    before = V - tau * (push - half_moment)
    return before, (V * (1.0 + sign * found[DELTA_STAR]) + tau * (push + half_moment) / j) / before - 1.0


def _layer_motions(case: Case, sign: float, V0: Floats, k0: Floats, split: Floats) -> tuple[Floats, Floats, Floats]:
    """V, delta over (octave, V, octave of u, u), and V where motions are joined."""
    u, gamma = _LAYER.at(_COARSE), (split / k0).ravel()
    starts = _entering(case, sign, V0.ravel(), gamma)
    before = _BEFOREHAND + np.append((u[:_BEFORE] - _LEAST_U) / (1.0 - _LEAST_U), 1.0)
    V, delta = case.rolled(*starts, gamma, before, _ENDS)
    V_on, delta_on = case.rolled(V[:, -1], delta[:, -1], 1.0 / k0.ravel(), np.append(u[_BEFORE:] - 1.0, _JOINED), _ENDS)
    shape = (*V0.shape, _LAYER.half.size, _COARSE.t.size)
    V_whole, delta_whole = (
        np.concatenate([a[:, :-1], b[:, :-1]], axis=1).reshape(shape) for a, b in ((V, V_on), (delta, delta_on))
    )
    return V_whole, delta_whole, V_on[:, -1].reshape(V0.shape)


def _splits(case: Case, sign: float, onsets: Rows) -> Floats:
    """Powers, an octave of kappa V at onset each, of E near which delta passes 0; 1 where it does not."""
    found = np.zeros((onsets.half.size, _SPLIT.t.size))
    found[:, 0] = 1.0
    if sign != np.sign(1.0 - case.parameters[3]):
        return found
    V = (onsets.at(_SPLIT) / case.parameters[1]).ravel()
    gamma = 1.0 / _stiff_rate(case, V)
    _, delta = case.rolled(*_entering(case, sign, V, gamma), gamma, _BEFOREHAND + _CROSSINGS, _ENDS)
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
    found[turns] = _SPLIT.powers(split[turns])
    return found


def _padded(powers: Floats) -> Floats:
    """With as many powers as those over one variable have."""
    return np.pad(powers, [(0, 0), (0, NODES.t.size - powers.shape[-1])])
