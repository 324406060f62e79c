"""One state from the flow map of its scene: look-ups instead of integration.

In the frame mirrored so that omega > V, full slip keeps I = w - 2 mu T(V), which gives the
onset; behind it the boundary layer is a table over (V at onset, E), and what follows is the
slow manifold, found by its slow logarithm lambda.  The whole map is one vector: its parts then
cost no more to reach than a constant.
"""

from __future__ import annotations

import numpy as np

from ..compile.fma import fma
from ..compile.jit import kernel
from ..material.standard import GAUSS_W, GAUSS_X
from ..numerics.bins import bin_number, bin_offset
from . import layout
from .fit import bits_and_offset, polynomial
from .records import Entry

PLUS, MINUS, CROSS = range(3)
#: what a motion is asked for: V and omega, also distance and angle, also the energy lost in slip
SPEEDS, PATH, LOSS = range(3)
_N = layout.COEFFICIENTS
LOWEST, HIGHEST = 2.0**layout.LOW, 2.0 ** (layout.HIGH - 2)
#: stiff rate that stands for a layer that is over
_NO_LAYER = 1e30


def _stride(part: str) -> int:
    return getattr(layout.SHAPES, part)[1] * _N


def _origin(part: str, low: int) -> int:
    """Position of a part, less that of the bits of its first bin."""
    return getattr(layout.STARTS, part) - (1023 + low) * layout.BINS * _stride(part)


_SLIDE, _ONSET, _SLOW, _ENTRY = _stride("slide_up"), _stride("onset_up"), _stride("slow"), _stride("entry_plus")
_SLIDE_UP, _SLIDE_DOWN = _origin("slide_up", layout.LOW), _origin("slide_down", layout.LOW)
_TIME_UP, _TIME_DOWN = _origin("time_up", layout.LOW), _origin("time_down", layout.LOW)
_ONSET_UP, _ONSET_DOWN = _origin("onset_up", layout.LOW), _origin("onset_down", layout.LOW)
_SLOW_BY_V, _LATE, _EARLY = _origin("slow", layout.LOW), layout.STARTS.late, _origin("early", 0)
_ENTRY_PLUS, _ENTRY_MINUS = _origin("entry_plus", 0), _origin("entry_minus", 0)
_ENTRY_CROSS = _origin("entry_cross", -layout.CROSS_MARGIN)
LAYER_SKIP = layout.ENTRY_OCTAVES - layout.LAYER_OCTAVES
_BLOCK = layout.SPEED_COEFFICIENTS * layout.FAST_COEFFICIENTS


@kernel(inline=True)
def _column(table, at, column, t):
    """Column of the bin that starts at ``at``."""
    return polynomial(table, at + column * _N, t)


@kernel(inline=True)
def slide_to(V, need, flow):
    """(T, X) of sliding from rest to V in the mirrored frame, T with the sign of V."""
    _, kappa, mu, _ = flow.scene
    speed = abs(V)
    if kappa * speed < LOWEST:
        return V / mu, 0.5 * V * V / mu
    b, t = bits_and_offset(kappa * speed)
    at = b * _SLIDE + (_SLIDE_UP if V > 0.0 else _SLIDE_DOWN)
    T = _column(flow.table, at, layout.T, t)
    X = _column(flow.table, at, layout.X, t) if need >= PATH else 0.0
    return T if V > 0.0 else -T, X


@kernel(inline=True)
def slides(V, slip, flow):
    """Whether |slip| = |omega - V| is that of full slip at V."""
    _, kappa, mu, _ = flow.scene
    speed = abs(V)
    largest = 0.5 * mu * speed / kappa  # delta_star |V| as V -> 0; delta_star falls from there
    if V == 0.0 or slip > 1.0001 * largest:
        return True
    if kappa * speed < LOWEST:
        return slip >= largest
    b, t = bits_and_offset(kappa * speed)
    return slip >= _column(flow.table, b * _SLIDE + _SLIDE_UP, layout.L, t)


@kernel(inline=True)
def speed_after(T, flow):
    """V at T in full slip, in the mirrored frame."""
    _, kappa, mu, _ = flow.scene
    x = kappa * mu * abs(T)
    if x < LOWEST:
        return mu * T
    b, t = bits_and_offset(x)
    if T > 0.0:
        return polynomial(flow.table, b * _N + _TIME_UP, t)
    return -polynomial(flow.table, b * _N + _TIME_DOWN, t)


@kernel(inline=True)
def onset_of(I, need, flow):
    """(V, T, X) at stick onset in the mirrored frame; V = 0 where the tables do not reach."""
    x = flow.scene.kappa * abs(I) / (1.0 + flow.scene.j)
    if not LOWEST <= x < HIGHEST:
        return 0.0, 0.0, 0.0
    b, t = bits_and_offset(x)
    at = b * _ONSET + (_ONSET_UP if I < 0.0 else _ONSET_DOWN)
    V, T = _column(flow.table, at, layout.ONSET_V, t), _column(flow.table, at, layout.ONSET_T, t)
    X = _column(flow.table, at, layout.ONSET_X, t) if need >= PATH else 0.0
    return (V, T, X) if I < 0.0 else (-V, -T, X)


@kernel(inline=True)
def _manifold(lam):
    """(place in the table, t, factor) of lambda on the slow manifold; below the table all falls like exp(lambda)."""
    if lam >= layout.LATE_HIGH:
        b, t = bits_and_offset(1.0 + lam)
        return b * _SLOW + _EARLY, t, 1.0
    share = 1.0
    if lam < layout.LATE_LOW:
        share = np.exp(lam - layout.LATE_LOW)
        lam = layout.LATE_LOW
    place = (lam - layout.LATE_LOW) / layout.LATE_WIDTH
    b = np.int64(place)
    return b * _SLOW + _LATE, (place - b - 0.5) / layout.BINS, share


@kernel(inline=True)
def manifold_speeds(lam, table):
    """(V, delta) on the slow manifold at lambda."""
    at, t, share = _manifold(lam)
    return share * _column(table, at, layout.SPEED, t), share * _column(table, at, layout.DELTA, t)


@kernel
def manifold_path(start, end, rate, table):
    """(distance, angle) along the slow manifold between two lambda; ``rate`` = c/(1 + j).

    The difference of what is left to rest, or where that cancels the integral of V.
    """
    span = start - end
    if span > 0.25 * max(1.0 + end, 1.0):
        at, t, share = _manifold(start)
        x, angle = share * _column(table, at, layout.X_TO_GO, t), share * _column(table, at, layout.ANGLE_TO_GO, t)
        at, t, share = _manifold(end)
        x -= share * _column(table, at, layout.X_TO_GO, t)
        return x, angle - share * _column(table, at, layout.ANGLE_TO_GO, t)
    x = angle = 0.0
    for n in range(GAUSS_X.size):
        V, delta = manifold_speeds(end + span * GAUSS_X[n], table)
        x += GAUSS_W[n] * V
        angle += GAUSS_W[n] * V * (1.0 + delta)
    return x * span / rate, angle * span / rate


@kernel
def manifold_loss(lam, table):
    """Energy still to be lost in slip at lambda on the slow manifold; it falls like V^3 as V -> 0."""
    at, t, share = _manifold(lam)
    return share**3 * _column(table, at, layout.LOSS_TO_GO, t)


@kernel
def manifold_delta(v, table):
    """Delta on the slow manifold at v = kappa V."""
    b, t = bits_and_offset(v)
    return _column(table, b * _SLOW + _SLOW_BY_V, layout.DELTA, t)


@kernel
def manifold_entry(v, table):
    """Of a motion on the slow manifold at v = kappa V: no layer is left."""
    b, t = bits_and_offset(v)
    return Entry(_column(table, b * _SLOW + _SLOW_BY_V, layout.LAMBDA, t), _NO_LAYER, 0.0, 0.0, 0.0)


@kernel(inline=True)
def _entry(family, v, flow):
    """(place in the table, t) of the entry of a family at v = kappa V0."""
    b, t = bits_and_offset(v)
    b -= flow.first * layout.BINS
    return b * _ENTRY + (_ENTRY_PLUS if family == PLUS else _ENTRY_MINUS if family == MINUS else _ENTRY_CROSS), t


@kernel(inline=True)
def entry_state(family, v, need, flow):
    """The entry of a family into partial slip at v = kappa V0."""
    table = flow.table
    at, t = _entry(family, v, flow)
    x = angle = loss = 0.0
    if need >= PATH:
        x, angle = _column(table, at, layout.ENTRY_X, t), _column(table, at, layout.ENTRY_ANGLE, t)
    if need >= LOSS:
        loss = _column(table, at, layout.ENTRY_LOSS, t)
    return Entry(
        _column(table, at, layout.ENTRY_LAMBDA, t), _column(table, at, layout.RATE, t), x, angle, loss
    )  # fmt: skip


@kernel
def _fast_bin(E, low):
    """(bin, t) of 0 <= E < 2**E_HIGH in a layer whose first bin is [0, 2**low)."""
    if E < 2.0**low:
        return np.int64(0), E * 2.0**-low - 0.5
    octave = bin_number(E, 0) - 1023
    if octave < 0:
        return 1 + octave - low, bin_offset(E, 0)
    return 1 - low + bin_number(E, 1) - 2 * 1023, bin_offset(E, 1)


@kernel
def layer_place(family, v, E, flow):
    """(Place in the table, t, s) of the layer behind the entry of a family at v = kappa V0."""
    t = bin_offset(v, 0)
    octave = bin_number(v, 0) - (1023 + flow.first + LAYER_SKIP)
    low, bins, start = layout.E_LOW, layout.SHAPES.layer_plus[1], layout.STARTS.layer_plus
    if family == MINUS:
        start = layout.STARTS.layer_minus
    elif family == CROSS:
        low, bins, start = 0, layout.SHAPES.layer_cross[1], layout.STARTS.layer_cross
        octave += layout.CROSS_MARGIN
    b, s = _fast_bin(E, low)
    return start + (octave * bins + b) * layout.LAYER_COLUMNS * _BLOCK, t, s


@kernel
def layer_value(table, column, at, t, s):
    """Column of a layer: a polynomial in t (speed at onset) and s (stiff time)."""
    at += column * _BLOCK
    total = 0.0
    for k in range(layout.SPEED_COEFFICIENTS - 1, -1, -1):
        total = fma(t, total, polynomial(table, at + k * layout.FAST_COEFFICIENTS, s))
    return total


@kernel
def layer_state(stick, rate, elapsed, need, flow):
    """(V, delta; distance, angle, slip loss since the entry) within the boundary layer behind an entry."""
    family, v, E, table = stick.family, stick.v, elapsed * rate, flow.table
    x = angle = loss = 0.0
    at, t = _entry(family, v, flow)
    crossing = _column(table, at, layout.CROSSING, t)
    if E > crossing:
        if need >= PATH:
            x, angle = _column(table, at, layout.CROSSING_X, t), _column(table, at, layout.CROSSING_ANGLE, t)
        if need >= LOSS:
            loss = _column(table, at, layout.CROSSING_LOSS, t)
        v *= np.exp(_column(table, at, layout.CROSSING_SPEED, t))
        family = CROSS
        at, t = _entry(family, v, flow)
        cross_rate = _column(table, at, layout.RATE, t)
        E, rate = (E - crossing) / rate * cross_rate, cross_rate
    place = layer_place(family, v, E, flow)
    V0 = v / flow.scene.kappa
    scale = V0 / rate
    if need >= PATH:
        x += scale * (E + layer_value(table, layout.LAYER_X, *place))
        angle += scale * (E + layer_value(table, layout.LAYER_ANGLE, *place))
    if need >= LOSS:
        loss += layer_value(table, layout.LAYER_LOSS, *place) * V0 * V0
    V = V0 * np.exp(layer_value(table, layout.LAYER_LN_V, *place))
    return V, layer_value(table, layout.LAYER_CREEP, *place), x, angle, loss


@kernel
def has_layer(v, flow):
    """Whether the boundary layer behind an entry at v = kappa V is tabulated."""
    return 2.0 ** (flow.first + LAYER_SKIP) <= v < 2.0 ** (flow.first + layout.ENTRY_OCTAVES)


@kernel
def lambda_at_rest(rest, flow):
    """Lambda of the slow manifold where max(|V|, |omega|) falls to ``rest``."""
    kappa = flow.scene.kappa
    V = rest
    for _ in range(4):
        v = kappa * V
        V = rest / (1.0 + max(manifold_delta(v, flow.table) if v >= LOWEST else 0.0, 0.0))
    v = kappa * V
    if v >= LOWEST:
        return manifold_entry(v, flow.table).lam
    return manifold_entry(LOWEST, flow.table).lam + np.log(v / LOWEST)
