"""Values from a flow map: polynomials instead of integration.

In full slip, mirrored so that omega > V, I = V - j omega - 2 mu T(V) is constant and determines the onset of partial
slip.  Behind the onset the boundary layer is a table over (V at onset, E); then the motion follows the slow
manifold, a function of the slow logarithm.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import inline_kernel, kernel
from ..numerics.interpolation import gauss
from ..numerics.simd4 import LANES, broadcast, fma4, make_load, unpack
from ..rows.evaluate import locate_octave
from ..rows.simd_polynomial import evaluate_pair, evaluate_single
from . import layout
from .layout import LAYER_TERMS, SHAPES, STARTS
from .records import Asymptote

#: output level: V and omega alone
SPEEDS = 0
#: output level: distance and angle too
PATH = 1
#: output level: slip loss too
LOSS = 2
#: lowest kappa V of the tables
LOWEST = 2.0**layout.LOW
#: highest kappa V of a start, two octaves below the end of the tables, so that quantities that grow with it stay inside
HIGHEST = 2.0 ** (layout.HIGH - 2)
#: ratio of the sliding time to T below which the difference of X cancels and V is integrated instead
_SHORT = 0.02
#: stiff rate of a motion on the slow manifold: its layer has length 0
_NO_LAYER = 1e30
_LOWEST_U = 2.0**layout.LAYER_LOW
_LOWEST_SLOW_LOG = -layout.SLOW_BINS * layout.SLOW_WIDTH
#: numbers of a row of the table of full slip
_SLIDE = SHAPES.slide[2]
#: numbers of a row of the table of onsets
_ONSET = SHAPES.onset[2]
#: numbers of a row of the table of speeds over sliding time
_AFTER = SHAPES.after[2]
#: numbers of a row of the slow manifold over its slow logarithm
_SLOW = SHAPES.slow[1]
#: numbers of a row of the slow manifold over kappa V
_MANIFOLD = SHAPES.manifold[1]
#: numbers of a row of the asymptotes
_ASYMPTOTE_SIZE = SHAPES.asymptote[2]
#: octaves of the tables over kappa V
_SPEED_OCTAVES = layout.HIGH - layout.LOW
#: octaves of kappa V at onset
_ONSET_OCTAVES = layout.OCTAVES
#: octaves of the layer coordinate u
_LAYER_OCTAVES = SHAPES.layer[2]
#: numbers of the polynomials of one octave of u
_LAYER = SHAPES.layer[3] * SHAPES.layer[4]
#: loads the twelve coefficients of the powers of t, that belong to one power of s, as three vectors of four
_powers = make_load(LAYER_TERMS // LANES)
#: nodes of the 5-point Gauss-Legendre rule on [0, 1], for short intervals
_GAUSS_X = gauss(5)[0]
#: weights of that rule
_GAUSS_W = gauss(5)[1]


@inline_kernel
def full_slip_integrals(V, level, flow):
    """Return time and distance of sliding from rest to V, and delta_star |V|, in the mirrored frame (omega > V).

    V : speed of the axis.
    level : SPEEDS, PATH (and distance) or LOSS (and slip loss).
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.

    Returns (T, X, limit): time gamma t with the sign of V; distance, computed from level PATH on, else 0; delta_star
    |V|.
    """
    speed = abs(V)
    row, t, _ = locate_octave(flow.kappa * speed, layout.LOW)
    if row == 0:
        return V / flow.mu, 0.5 * V * V / flow.mu, 0.5 * flow.mu / flow.kappa * speed
    at = STARTS.slide + (row - 1 + (0 if V > 0.0 else _SPEED_OCTAVES)) * _SLIDE
    T, limit = evaluate_pair(flow.table, at, t)[:2]
    X = evaluate_single(flow.table, at + layout.SLIDE_X, t)[0] if level >= PATH else 0.0
    return T if V > 0.0 else -T, X, limit


@inline_kernel
def speed_at_slide_time(T, flow):
    """V in full slip at the time T since (or before) rest, in the mirrored frame."""
    row, t, _ = locate_octave(flow.kappa * flow.mu * abs(T), layout.LOW)
    if row == 0:
        return flow.mu * T
    V = evaluate_single(flow.table, STARTS.after + (row - 1 + (0 if T > 0.0 else _SPEED_OCTAVES)) * _AFTER, t)[0]
    return V if T > 0.0 else -V


@kernel
def slide_distance(start, tau, flow):
    """Return the distance of sliding for the time tau from a given state of full slip.

    start : (T, X) at the beginning: integrals of time and distance of full slip from rest to the speed there.
    tau : time, > 0.
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.

    Returns the distance, dimensionless: the difference of X, or the integral of V where that difference cancels.
    """
    T, X = start
    if tau > _SHORT * abs(T):
        return full_slip_integrals(speed_at_slide_time(T + tau, flow), PATH, flow)[1] - X
    x = 0.0
    for n in range(_GAUSS_X.size):
        x += _GAUSS_W[n] * speed_at_slide_time(T + tau * _GAUSS_X[n], flow)
    return x * tau


@inline_kernel
def read_onset(I, level, flow):
    """Return the state at the onset of partial slip of a sliding motion, in the mirrored frame (omega > V).

    I : V - j omega - 2 mu T, constant while sliding, with T the time that the table gives for V.
    level : SPEEDS, PATH (and distance) or LOSS (and slip loss); X from PATH on.
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.

    Returns (V, T, X): speed at the onset, integrals of time and distance of full slip from rest to it; V = 0 where the
    onset is outside the tables.
    """
    x = flow.kappa * abs(I) / (1.0 + flow.j)
    if not LOWEST <= x < HIGHEST:
        return 0.0, 0.0, 0.0
    row, t, _ = locate_octave(x, layout.LOW)
    at = STARTS.onset + (row - 1 + (0 if I < 0.0 else _SPEED_OCTAVES)) * _ONSET
    V, T = evaluate_pair(flow.table, at, t)[:2]
    X = evaluate_single(flow.table, at + layout.ONSET_X, t)[0] if level >= PATH else 0.0
    return (V, T, X) if I < 0.0 else (-V, -T, X)


@inline_kernel
def _locate_on_manifold(slow_log):
    """Return the position of a slow logarithm in the table of the slow manifold.

    slow_log : slow logarithm of V, the coordinate along the slow manifold (:mod:`.layout`).

    Returns (position, t, factor): position of the row in the map's vector; argument in [-1, 1) of its polynomials;
    factor of the values, 1 inside the table.  Below the table all values fall as exp(slow_log).
    """
    if slow_log >= 0.0:
        row, t, _ = locate_octave(1.0 + slow_log, 0)
        return STARTS.slow + (layout.SLOW_BINS + row - 1) * _SLOW, t, 1.0
    share = 1.0
    if slow_log < _LOWEST_SLOW_LOG:
        share, slow_log = np.exp(slow_log - _LOWEST_SLOW_LOG), _LOWEST_SLOW_LOG
    place = (slow_log - _LOWEST_SLOW_LOG) * (1.0 / layout.SLOW_WIDTH)
    row = min(np.int64(place), layout.SLOW_BINS - 1)
    return STARTS.slow + row * _SLOW, 2.0 * (place - row) - 1.0, share


@inline_kernel
def manifold_speeds(slow_log, table):
    """(V, delta) on the slow manifold at a slow logarithm."""
    at, t, share = _locate_on_manifold(slow_log)
    V, delta = evaluate_pair(table, at, t)[:2]
    return share * V, share * delta


@inline_kernel
def _remaining_path(slow_log, table):
    """(distance, angle) that remain to rest on the slow manifold."""
    at, t, share = _locate_on_manifold(slow_log)
    x, angle = evaluate_pair(table, at + layout.SLOW_PATH, t)[:2]
    return share * x, share * angle


@kernel
def manifold_path(start, span, rate, table):
    """Return distance and angle along the slow manifold while the slow logarithm falls by ``span``.

    start : slow logarithm at the beginning.
    span : decrease of the slow logarithm.
    rate : decrease of the slow logarithm in unit time gamma t.
    table : vector with all tables of the map.

    Returns (distance, angle): the difference of the remaining path, or the integral of V where that difference
    cancels.
    """
    end = start - span
    if span > 0.25 * max(1.0 + end, 1.0):
        x, angle = _remaining_path(start, table)
        x_left, angle_left = _remaining_path(end, table)
        return x - x_left, angle - angle_left
    x = angle = 0.0
    for n in range(_GAUSS_X.size):
        V, delta = manifold_speeds(end + span * _GAUSS_X[n], table)
        x += _GAUSS_W[n] * V
        angle += _GAUSS_W[n] * V * (1.0 + delta)
    return x * span / rate, angle * span / rate


@kernel
def remaining_slip_loss(slow_log, table):
    """Slip loss that remains to rest at a slow logarithm on the slow manifold; it falls as V^3 as V -> 0."""
    at, t, share = _locate_on_manifold(slow_log)
    return share**3 * evaluate_single(table, at + layout.SLOW_LOSS, t)[0]


@kernel
def manifold_at_speed(v, table):
    """(slow logarithm, delta) on the slow manifold at v = kappa V >= LOWEST."""
    row, t, _ = locate_octave(v, layout.LOW)
    return evaluate_pair(table, STARTS.manifold + (row - 1) * _MANIFOLD, t)[:2]


@kernel
def asymptote_on_manifold(slow_log):
    """The asymptote of a motion that is on the slow manifold already."""
    return Asymptote(slow_log, _NO_LAYER, 1.0, 0.0, 0.0, 0.0)


@inline_kernel
def read_asymptote(family, v, level, flow):
    """Return the asymptote on the slow manifold of the motion that enters partial slip at v = kappa V.

    family : PLUS or MINUS.
    v : kappa V at onset.
    level : quantities to compute: SPEEDS, PATH (and distance) or LOSS (and slip loss).
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.

    Returns an :class:`Asymptote`; quantities beyond ``level`` are 0.
    """
    table = flow.table
    row, t, _ = locate_octave(v, flow.first)
    at = STARTS.asymptote + (row - 1 + family * _ONSET_OCTAVES) * _ASYMPTOTE_SIZE
    slow_log, rate = evaluate_pair(table, at, t)[:2]
    x = angle = loss = 0.0
    if level >= PATH:
        x, angle = evaluate_pair(table, at + layout.ASYMPTOTE_PATH, t)[:2]
    if level >= LOSS:
        loss = evaluate_single(table, at + layout.ASYMPTOTE_LOSS, t)[0]
    return Asymptote(slow_log, rate, evaluate_single(table, at + layout.ASYMPTOTE_SPLIT, t)[0], x, angle, loss)


@inline_kernel
def layer_coordinate(E, split):
    """Layer coordinate u at the stiff time E, where the layer is divided at ``split``."""
    return _LOWEST_U + (1.0 - _LOWEST_U) * E / split if E < split else 1.0 + E - split


@inline_kernel
def locate_in_layer(family, v, u, flow):
    """(position in the table, t, s) in the layer of a family at v = kappa V of the onset and at the layer coordinate
    u.
    """
    row, t, _ = locate_octave(v, flow.first)
    part, s, _ = locate_octave(u, layout.LAYER_LOW)
    return STARTS.layer + (((row - 1 + family * _ONSET_OCTAVES) * _LAYER_OCTAVES) + part - 1) * _LAYER, t, s


@inline_kernel
def _evaluate_in_t(p, t):
    """Value at t of a polynomial whose twelve coefficients are three vectors of four."""
    square = t * t
    per = broadcast(square * square)
    a, b, c, d = unpack(fma4(fma4(p[2], per, p[1]), per, p[0]))
    return fma(square, fma(t, d, c), fma(t, b, a))


@inline_kernel
def layer_value_and_slopes(table, column, at, t, s):
    """Return value and slopes of one quantity of the boundary layer behind the onset of partial slip.

    table : vector with all tables of the map.
    column : the quantity, LAYER_LN_V to LAYER_LOSS.
    at, t, s : position from :func:`locate_in_layer`.

    Returns (value, slope in t (speed at onset), slope in s (layer coordinate)).
    """
    at += column * layout.BLOCK
    per, value = broadcast(s), _powers(table, at + layout.BLOCK - LAYER_TERMS)
    rise = value
    for m in range(LAYER_TERMS - 2, 0, -1):
        value = fma4(value, per, _powers(table, at + m * LAYER_TERMS))
        rise = fma4(rise, per, value)
    value = fma4(value, per, _powers(table, at))
    powers = (*unpack(value[0]), *unpack(value[1]), *unpack(value[2]))
    slope = 11.0 * powers[11]
    for k in range(10, 0, -1):
        slope = fma(slope, t, k * powers[k])
    return _evaluate_in_t(value, t), slope, _evaluate_in_t(rise, t)


@kernel
def layer_value(table, column, at, t, s):
    """Value of one column of a layer, as in :func:`layer_value_and_slopes`."""
    return layer_value_and_slopes(table, column, at, t, s)[0]


@kernel
def layer_state(stick, asymptote, elapsed, level, flow):
    """Return the state of a motion within the boundary layer behind the onset of partial slip.

    stick : :class:`StickOnset`: speed, time and path at the onset.
    asymptote : :class:`Asymptote`: the motion on the slow manifold that it approaches.
    elapsed : time since the onset, gamma t.
    level : quantities to compute: SPEEDS, PATH (and distance) or LOSS (and slip loss).
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.

    Returns (V, delta, distance, angle, slip loss); the last three since the onset.
    """
    table, E = flow.table, elapsed * asymptote.rate
    at, t, s = locate_in_layer(stick.family, stick.v, layer_coordinate(E, asymptote.split), flow)
    V0 = stick.v / flow.kappa
    x = angle = loss = 0.0
    if level >= PATH:
        scale = V0 / asymptote.rate
        x = scale * (E + layer_value(table, layout.LAYER_X, at, t, s))
        angle = scale * (E + layer_value(table, layout.LAYER_ANGLE, at, t, s))
    if level >= LOSS:
        loss = layer_value(table, layout.LAYER_LOSS, at, t, s) * V0 * V0
    V = V0 * np.exp(layer_value(table, layout.LAYER_LN_V, at, t, s))
    return V, layer_value(table, layout.LAYER_CREEP, at, t, s), x, angle, loss


@kernel
def slow_log_at_rest(rest, flow):
    """Return the slow logarithm at which max(|V|, |omega|) on the slow manifold equals the rest threshold.

    rest : threshold, > 0; beyond the tables their highest speed counts.
    flow : :class:`.records.Flow`: tables of the map, kappa, mu, j.
    Returns the slow logarithm, the coordinate along the slow manifold, dimensionless.
    """
    rest = V = min(rest, 0.5 * HIGHEST / flow.kappa)
    for _ in range(4):
        v = flow.kappa * V
        V = rest / (1.0 + max(manifold_at_speed(v, flow.table)[1] if v >= LOWEST else 0.0, 0.0))
    v = flow.kappa * V
    if v >= LOWEST:
        return manifold_at_speed(v, flow.table)[0]
    return manifold_at_speed(LOWEST, flow.table)[0] + np.log(v / LOWEST)
