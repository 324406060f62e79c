"""One state from the flow map of its scene: look-ups instead of integration.

In the frame mirrored so that omega > V, full slip keeps I = V - j omega - 2 mu T(V), which gives the onset; behind it
the boundary layer is a table over (V at onset, E), and what follows is the slow manifold, found by its slow logarithm
lambda.  The whole map is one vector: its parts then cost no more to reach than a constant.
"""

from __future__ import annotations

import numpy as np

from ..compile.fma import fma
from ..compile.jit import kernel
from ..numerics.four import LANES, fused, loads, parts, spread
from ..numerics.nodes import gauss
from ..rows import lanes
from ..rows.law import octave
from . import layout
from .layout import LAYER_TERMS, SHAPES, STARTS
from .records import Entry

#: what a motion is asked for: V and omega, also distance and angle, also the energy lost in slip
SPEEDS, PATH, LOSS = range(3)
LOWEST, HIGHEST = 2.0**layout.LOW, 2.0 ** (layout.HIGH - 2)
#: part of the time from rest below which a difference of X cancels
_SHORT = 0.02
#: stiff rate that stands for a layer that is over
_NO_LAYER = 1e30
_LEAST_U = 2.0**layout.LAYER_LOW
_LEAST_LAMBDA = -layout.SLOW_BINS * layout.SLOW_WIDTH
_SLIDE, _ONSET, _AFTER = SHAPES.slide[2], SHAPES.onset[2], SHAPES.after[2]
_SLOW, _MANIFOLD, _ENTRY = SHAPES.slow[1], SHAPES.manifold[1], SHAPES.entry[2]
_ROWS, _ENTRIES, _LAYERS = layout.HIGH - layout.LOW, layout.OCTAVES, SHAPES.layer[2]
_LAYER = SHAPES.layer[3] * SHAPES.layer[4]
#: of t, in the coefficient of a power of s
_powers = loads(LAYER_TERMS // LANES)
#: 5-point Gauss-Legendre rule on [0, 1]
_GAUSS_X, _GAUSS_W = gauss(5)


@kernel(inline=True)
def slide_to(V, need, flow):
    """(T, X, delta_star |V|) of sliding from rest to V in the mirrored frame, T with the sign of V."""
    speed = abs(V)
    row, t, _ = octave(flow.kappa * speed, layout.LOW)
    if row == 0:
        return V / flow.mu, 0.5 * V * V / flow.mu, 0.5 * flow.mu / flow.kappa * speed
    at = STARTS.slide + (row - 1 + (0 if V > 0.0 else _ROWS)) * _SLIDE
    T, limit = lanes.pair(flow.table, at, t)[:2]
    X = lanes.one(flow.table, at + layout.SLIDE_X, t)[0] if need >= PATH else 0.0
    return T if V > 0.0 else -T, X, limit


@kernel(inline=True)
def speed_after(T, flow):
    """V at T in full slip, in the mirrored frame."""
    row, t, _ = octave(flow.kappa * flow.mu * abs(T), layout.LOW)
    if row == 0:
        return flow.mu * T
    V = lanes.one(flow.table, STARTS.after + (row - 1 + (0 if T > 0.0 else _ROWS)) * _AFTER, t)[0]
    return V if T > 0.0 else -V


@kernel
def slide_path(start, tau, flow):
    """Distance of sliding for the time tau from ``start``, T and X there.

    The difference of X, or where that cancels the integral of V.
    """
    T, X = start
    if tau > _SHORT * abs(T):
        return slide_to(speed_after(T + tau, flow), PATH, flow)[1] - X
    x = 0.0
    for n in range(_GAUSS_X.size):
        x += _GAUSS_W[n] * speed_after(T + tau * _GAUSS_X[n], flow)
    return x * tau


@kernel(inline=True)
def onset_of(I, need, flow):
    """(V, T, X) at stick onset in the mirrored frame; V = 0 where the tables do not reach."""
    x = flow.kappa * abs(I) / (1.0 + flow.j)
    if not LOWEST <= x < HIGHEST:
        return 0.0, 0.0, 0.0
    row, t, _ = octave(x, layout.LOW)
    at = STARTS.onset + (row - 1 + (0 if I < 0.0 else _ROWS)) * _ONSET
    V, T = lanes.pair(flow.table, at, t)[:2]
    X = lanes.one(flow.table, at + layout.ONSET_X, t)[0] if need >= PATH else 0.0
    return (V, T, X) if I < 0.0 else (-V, -T, X)


@kernel(inline=True)
def _on_manifold(lam):
    """(place in the table, t, factor) of lambda on the slow manifold; below the table all falls like exp(lambda)."""
    if lam >= 0.0:
        row, t, _ = octave(1.0 + lam, 0)
        return STARTS.slow + (layout.SLOW_BINS + row - 1) * _SLOW, t, 1.0
    share = 1.0
    if lam < _LEAST_LAMBDA:
        share, lam = np.exp(lam - _LEAST_LAMBDA), _LEAST_LAMBDA
    place = (lam - _LEAST_LAMBDA) * (1.0 / layout.SLOW_WIDTH)
    row = min(np.int64(place), layout.SLOW_BINS - 1)
    return STARTS.slow + row * _SLOW, 2.0 * (place - row) - 1.0, share


@kernel(inline=True)
def manifold_speeds(lam, table):
    """(V, delta) on the slow manifold at lambda."""
    at, t, share = _on_manifold(lam)
    V, delta = lanes.pair(table, at, t)[:2]
    return share * V, share * delta


@kernel(inline=True)
def _to_go(lam, table):
    """(distance, angle) left to rest on the slow manifold."""
    at, t, share = _on_manifold(lam)
    x, angle = lanes.pair(table, at + layout.SLOW_PATH, t)[:2]
    return share * x, share * angle


@kernel
def manifold_path(start, span, rate, table):
    """(distance, angle) along the slow manifold while lambda falls by ``span`` at this rate.

    The difference of what is left to rest, or where that cancels the integral of V.
    """
    end = start - span
    if span > 0.25 * max(1.0 + end, 1.0):
        x, angle = _to_go(start, table)
        x_left, angle_left = _to_go(end, table)
        return x - x_left, angle - angle_left
    x = angle = 0.0
    for n in range(_GAUSS_X.size):
        V, delta = manifold_speeds(end + span * _GAUSS_X[n], table)
        x += _GAUSS_W[n] * V
        angle += _GAUSS_W[n] * V * (1.0 + delta)
    return x * span / rate, angle * span / rate


@kernel
def manifold_loss(lam, table):
    """Energy still to be lost in slip at lambda on the slow manifold; it falls like V^3 as V -> 0."""
    at, t, share = _on_manifold(lam)
    return share**3 * lanes.one(table, at + layout.SLOW_LOSS, t)[0]


@kernel
def manifold_at(v, table):
    """(lambda, delta) on the slow manifold at v = kappa V, from LOWEST on."""
    row, t, _ = octave(v, layout.LOW)
    return lanes.pair(table, STARTS.manifold + (row - 1) * _MANIFOLD, t)[:2]


@kernel
def manifold_entry(lam):
    """Of a motion on the slow manifold: no layer is left."""
    return Entry(lam, _NO_LAYER, 1.0, 0.0, 0.0, 0.0)


@kernel(inline=True)
def entry_of(family, v, need, flow):
    """The entry of a family into partial slip at v = kappa V0."""
    table = flow.table
    row, t, _ = octave(v, flow.first)
    at = STARTS.entry + (row - 1 + family * _ENTRIES) * _ENTRY
    lam, rate = lanes.pair(table, at, t)[:2]
    x = angle = loss = 0.0
    if need >= PATH:
        x, angle = lanes.pair(table, at + layout.ENTRY_PATH, t)[:2]
    if need >= LOSS:
        loss = lanes.one(table, at + layout.ENTRY_LOSS, t)[0]
    return Entry(lam, rate, lanes.one(table, at + layout.ENTRY_SPLIT, t)[0], x, angle, loss)


@kernel(inline=True)
def layer_variable(E, split):
    """u at E."""
    return _LEAST_U + (1.0 - _LEAST_U) * E / split if E < split else 1.0 + E - split


@kernel(inline=True)
def layer_place(family, v, u, flow):
    """(Place in the table, t, s) of the layer behind the entry of a family at v = kappa V0."""
    row, t, _ = octave(v, flow.first)
    part, s, _ = octave(u, layout.LAYER_LOW)
    return STARTS.layer + (((row - 1 + family * _ENTRIES) * _LAYERS) + part - 1) * _LAYER, t, s


@kernel(inline=True)
def _over_t(p, t):
    """The polynomial whose twelve powers are three vectors."""
    square = t * t
    per = spread(square * square)
    a, b, c, d = parts(fused(fused(p[2], per, p[1]), per, p[0]))
    return fma(square, fma(t, d, c), fma(t, b, a))


@kernel(inline=True)
def layer_slopes(table, column, at, t, s):
    """Column of a layer, a polynomial in t (speed at onset) and s (stiff time), and its slopes over these."""
    at += column * layout.BLOCK
    per, value = spread(s), _powers(table, at + layout.BLOCK - LAYER_TERMS)
    rise = value
    for m in range(LAYER_TERMS - 2, 0, -1):
        value = fused(value, per, _powers(table, at + m * LAYER_TERMS))
        rise = fused(rise, per, value)
    value = fused(value, per, _powers(table, at))
    powers = (*parts(value[0]), *parts(value[1]), *parts(value[2]))
    slope = 11.0 * powers[11]
    for k in range(10, 0, -1):
        slope = fma(slope, t, k * powers[k])
    return _over_t(value, t), slope, _over_t(rise, t)


@kernel
def layer_value(table, column, at, t, s):
    """The same alone."""
    return layer_slopes(table, column, at, t, s)[0]


@kernel
def layer_state(stick, entry, elapsed, need, flow):
    """(V, delta; distance, angle, slip loss since the entry) within the boundary layer behind an entry."""
    table, E = flow.table, elapsed * entry.rate
    at, t, s = layer_place(stick.family, stick.v, layer_variable(E, entry.split), flow)
    V0 = stick.v / flow.kappa
    x = angle = loss = 0.0
    if need >= PATH:
        scale = V0 / entry.rate
        x = scale * (E + layer_value(table, layout.LAYER_X, at, t, s))
        angle = scale * (E + layer_value(table, layout.LAYER_ANGLE, at, t, s))
    if need >= LOSS:
        loss = layer_value(table, layout.LAYER_LOSS, at, t, s) * V0 * V0
    V = V0 * np.exp(layer_value(table, layout.LAYER_LN_V, at, t, s))
    return V, layer_value(table, layout.LAYER_CREEP, at, t, s), x, angle, loss


@kernel
def lambda_at_rest(rest, flow):
    """Lambda of the slow manifold where max(|V|, |omega|) falls to ``rest``; that of the highest speed beyond it."""
    rest = V = min(rest, 0.5 * HIGHEST / flow.kappa)
    for _ in range(4):
        v = flow.kappa * V
        V = rest / (1.0 + max(manifold_at(v, flow.table)[1] if v >= LOWEST else 0.0, 0.0))
    v = flow.kappa * V
    if v >= LOWEST:
        return manifold_at(v, flow.table)[0]
    return manifold_at(LOWEST, flow.table)[0] + np.log(v / LOWEST)
