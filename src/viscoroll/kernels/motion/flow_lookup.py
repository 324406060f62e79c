"""Values from a flow map: polynomials instead of integration.

In full slip, mirrored so that omega > V, I = V - j omega - 2 mu T(V) is constant and determines the
onset of partial slip.  After the onset the boundary layer is a table over (V at onset, E); then the
motion follows the slow manifold, a function of the slow logarithm.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.

Terms of this file:

- Flow: record of the flow map of one scene: ``table``, the vector of all its tables, of
  flow_layout.SIZE numbers; kappa, mu, j; ``first``, the exponent from which kappa V at onset is
  tabulated; ``slow_rate``.
- Times are tau = gamma t.  Distances and angles are integrals over tau: gamma times x and gamma
  times the angle.
- Level: SPEEDS (0): V and delta or omega alone; PATH (1): distance and angle too; LOSS (2): slip
  loss too.
- Mirrored frame: the signs of V and omega are changed where needed, so that omega > V in full slip
  and V > 0 in partial slip.
- T: time of full slip from V = 0 to V, with the sign of V; X: distance of full slip between rest
  and V, >= 0.
- Slow manifold: the creepage delta as a function of V that all motions in partial slip approach and
  then keep.
- Slow logarithm: coordinate along it, which falls linearly in tau; close to ln V plus a constant at
  low speed.
- Boundary layer: the time after the onset of partial slip in which delta approaches the manifold.
  E = k0 (tau - tau_onset) is its stiff time, k0 the relaxation rate at onset, u the layer
  coordinate (:func:`layer_coordinate`).
- Family: PLUS (0) if omega > V at the onset of partial slip, MINUS (1) if omega < V.
"""

import numpy as np

from ..law.law_functions import locate_octave
from ..numerics.interpolation import gauss
from ..numerics.intrinsics import fma
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import (
    LANES,
    broadcast,
    evaluate_pair,
    evaluate_single,
    fma4,
    join_lanes,
    make_load,
    unpack,
)
from ..records import Asymptote
from .flow_layout import (
    ASYMPTOTE_LOSS,
    ASYMPTOTE_PATH,
    ASYMPTOTE_SPLIT,
    BLOCK,
    HIGH,
    LAYER_ANGLE,
    LAYER_CREEP,
    LAYER_LN_V,
    LAYER_LOSS,
    LAYER_LOW,
    LAYER_TERMS,
    LAYER_X,
    LOW,
    OCTAVES,
    ONSET_X,
    ROW_SIZES,
    SHAPES,
    SLIDE_X,
    SLOW_BINS,
    SLOW_LOSS,
    SLOW_PATH,
    SLOW_WIDTH,
    STARTS,
)

#: output level: V and omega alone
SPEEDS = 0
#: output level: distance and angle too
PATH = 1
#: output level: slip loss too
LOSS = 2
#: lowest kappa V of the tables
LOWEST = 2.0**LOW
#: highest kappa V of a start, two octaves below the end of the tables, so that quantities that grow
#: with it stay inside
HIGHEST = 2.0 ** (HIGH - 2)
#: ratio of the sliding time to T below which the difference of X cancels and V is integrated
#: instead
_SHORT = 0.02
#: lower end of the layer coordinate u
LOWEST_U = 2.0**LAYER_LOW
_LOWEST_SLOW_LOG = -SLOW_BINS * SLOW_WIDTH
#: octaves of the tables over kappa V
_SPEED_OCTAVES = HIGH - LOW
#: numbers of the polynomials of one octave of u
_LAYER = SHAPES.layer[3] * SHAPES.layer[4]
#: loads the twelve coefficients of the powers of t, that belong to one power of s, as three vectors
#: of four
_powers = make_load(LAYER_TERMS // LANES)
#: nodes and weights of the 5-point Gauss-Legendre rule on [0, 1], for short intervals
_GAUSS_X, _GAUSS_W = gauss(5)


@inline_kernel
def full_slip_integrals(V, level, flow):
    """Return time and distance of sliding between rest and the speed V, and the limit of full slip,
    from the map.

    V : float, speed of the axis in the mirrored frame (omega > V), of either sign or 0, kappa |V| <
        2^HIGH, which is not checked.
    level : SPEEDS, PATH or LOSS: the distance is read from the table from PATH on.
    flow : Flow, of the scene; ``table``, kappa and mu are read.

    Returns (T, X, limit): time tau from V = 0 to V, with the sign of V; distance times gamma
    between rest and V, >= 0; delta_star |V|, the least omega - V of full slip, >= 0.  For kappa |V|
    < 2^LOW, below the table, they are their limits as V -> 0, (V/mu, V^2/(2 mu), mu
    |V|/(2 kappa)), at every level.  In the table X is 0 at level SPEEDS.
    """
    speed = abs(V)
    row, t, _ = locate_octave(flow.kappa * speed, LOW)
    if row == 0:
        return V / flow.mu, 0.5 * V * V / flow.mu, 0.5 * flow.mu / flow.kappa * speed
    # row 0 of locate_octave is below the tables, which begin with row 1: first all octaves of V >
    # 0, then as many of V < 0
    at = STARTS.slide + (row - 1 + (0 if V > 0.0 else _SPEED_OCTAVES)) * ROW_SIZES.slide
    T, limit = evaluate_pair(flow.table, at, t)[:2]
    X = evaluate_single(flow.table, at + SLIDE_X, t)[0] if level >= PATH else 0.0
    return T if V > 0.0 else -T, X, limit


@inline_kernel
def speed_at_slide_time(T, flow):
    """Return V in full slip, in the mirrored frame, at a time before or after V = 0.

    T : float, time gamma t since V = 0, negative before it; kappa mu |T| < 2^HIGH,
    which is not checked.
    flow : Flow, of the scene; ``table``, kappa and mu are read.

    Returns V, a float, with the sign of T; for kappa mu |T| < 2^LOW, below the table,
    its limit mu T for small T.
    """
    row, t, _ = locate_octave(flow.kappa * flow.mu * abs(T), LOW)
    if row == 0:
        return flow.mu * T
    # |V| over kappa mu |T|: first all octaves of T > 0, then as many of T < 0
    at = STARTS.after + (row - 1 + (0 if T > 0.0 else _SPEED_OCTAVES)) * ROW_SIZES.after
    V = evaluate_single(flow.table, at, t)[0]
    return V if T > 0.0 else -V


@kernel
def slide_distance(start, tau, flow):
    """Return the distance of sliding during a time from a given state of full slip.

    start : (T, X) at the beginning, the first two values of :func:`full_slip_integrals` at level
        PATH: time and distance between rest and the speed there, in the mirrored frame.
    tau : float, time gamma t of sliding, > 0; T + tau is within the tables.
    flow : Flow, of the scene; ``table``, kappa and mu are read.

    Returns a float, gamma times the displacement of the axis in the mirrored frame, signed (of
    opposite motions before and after V = 0 the sum): the difference of X; or, for tau up to
    0.02 |T|, where that difference cancels, the integral of V by a five-point Gauss rule.
    """
    T, X = start
    if tau > _SHORT * abs(T):  # X of the speed reached less X of the start
        return full_slip_integrals(speed_at_slide_time(T + tau, flow), PATH, flow)[1] - X
    x = 0.0
    for n in range(_GAUSS_X.size):
        x += _GAUSS_W[n] * speed_at_slide_time(T + tau * _GAUSS_X[n], flow)
    return x * tau


@inline_kernel
def read_onset(I, level, flow):
    """Return the state at the onset of partial slip of a sliding motion, in the mirrored frame
    (omega > V).

    I : float, V - j omega - 2 mu T, which is constant while sliding, with T the time that
        :func:`full_slip_integrals` gives for V.
    level : SPEEDS, PATH or LOSS: X is computed from PATH on.
    flow : Flow, of the scene; ``table``, kappa and j are read.

    Returns (V, T, X): speed at the onset, with the sign opposite to that of I; time tau of full
    slip between rest and that speed, with the sign of V; distance times gamma between rest and that
    speed, >= 0, but 0 at level SPEEDS.  All three are 0 where the onset is outside the tables, for
    I = 0 and for an I that is NaN too.
    """
    # By Eq. (22), (V - j omega)' = 2 Q = 2 mu in tau, and T' = 1: I is constant.  At the onset
    # omega - V = delta_star |V|, so that I = (1 - j) V - j delta_star |V| - 2 mu T(V) is a function
    # of V there.  As T -> V/mu for V -> 0 and delta_star is small, it is close to -(1 + j) V at low
    # speed: x is then close to kappa |V|, and V has the sign opposite to that of I.
    x = flow.kappa * abs(I) / (1.0 + flow.j)
    if not LOWEST <= x < HIGHEST:  # True for NaN too.
        return 0.0, 0.0, 0.0
    row, t, _ = locate_octave(x, LOW)
    # row - 1, as the tables begin with the octave above LOW; those of V > 0 at the onset are first
    at = STARTS.onset + (row - 1 + (0 if I < 0.0 else _SPEED_OCTAVES)) * ROW_SIZES.onset
    V, T = evaluate_pair(flow.table, at, t)[:2]
    X = evaluate_single(flow.table, at + ONSET_X, t)[0] if level >= PATH else 0.0
    return (V, T, X) if I < 0.0 else (-V, -T, X)


@inline_kernel
def _locate_on_manifold(slow_log):
    """Return the position of a slow logarithm in the table of the slow manifold.

    slow_log : float, slow logarithm of V, the coordinate along the slow manifold; any number below
        2^SLOW_OCTAVES - 1, the end of the table, which is not checked; not a NaN.

    Returns (position, t, factor): index in the map's vector at which the row begins, int; argument
    in [-1, 1] of its polynomials, a float; factor of V, delta and the remaining path, a float.
    Inside the table the factor is 1.  Below it the position is that of the lowest slow logarithm,
    and the factor is exp(slow_log - lowest), by which these quantities fall; it may underflow to 0.
    """
    if slow_log >= 0.0:  # Octaves of 1 + slow_log; below 0 bins of one width.
        # 1 is the begin of row 1 for e0 = 0; the octaves follow the bins in the table
        row, t, _ = locate_octave(1.0 + slow_log, 0)
        return STARTS.slow + (SLOW_BINS + row - 1) * ROW_SIZES.slow, t, 1.0
    share = 1.0  # the factor
    if slow_log < _LOWEST_SLOW_LOG:
        share = np.exp(slow_log - _LOWEST_SLOW_LOG)
        slow_log = _LOWEST_SLOW_LOG
    place = (slow_log - _LOWEST_SLOW_LOG) * (1.0 / SLOW_WIDTH)
    row = np.int64(min(place, SLOW_BINS - 1.0))  # rounding may leave the end of the bins
    return STARTS.slow + row * ROW_SIZES.slow, 2.0 * (place - row) - 1.0, share


@inline_kernel
def manifold_pair(slow_log, offset, table):
    """Return two quantities on the slow manifold, which below the table fall as exp(slow_log).

    slow_log : float, slow logarithm, not a NaN, below 2^SLOW_OCTAVES - 1, the end of the table; not
    checked.
    offset : int, offset of the pair in a row of the table: 0 or SLOW_PATH.
    table : vector of all tables, ``table`` of Flow.
    Returns two floats.  At 0 (V, delta): speed, > 0 until it underflows to 0, and creepage, of
    either sign.  At SLOW_PATH the path that remains to rest, of which :func:`manifold_path` forms
    differences: (distance, angle), each times gamma, >= 0 for the V > 0 of the mirrored frame.
    """
    at, t, share = _locate_on_manifold(slow_log)
    a, b = evaluate_pair(table, at + offset, t)[:2]
    return share * a, share * b


@kernel
def manifold_path(start, span, rate, table):
    """Return distance and angle along the slow manifold while the slow logarithm falls by ``span``.

    start : float, slow logarithm at the beginning, below 2^SLOW_OCTAVES - 1; not checked.
    span : float, decrease of the slow logarithm, >= 0.
    rate : float, decrease of the slow logarithm in unit time tau = gamma t, > 0: ``slow_rate`` of
    Flow.
    table : vector of all tables, ``table`` of Flow.

    Returns (distance, angle), floats, each times gamma and >= 0 for V > 0, (0.0, 0.0) of the span
    0: the difference of the remaining path; or, for a span up to a quarter of max(1 + end, 1) with
    the slow logarithm at its end, where that difference cancels, the integrals of V and omega by a
    five-point Gauss rule.
    """
    end = start - span
    if span > 0.25 * max(1.0 + end, 1.0):
        x, angle = manifold_pair(start, SLOW_PATH, table)
        x_left, angle_left = manifold_pair(end, SLOW_PATH, table)
        return x - x_left, angle - angle_left
    # dx = V dtau with dtau = -d(slow logarithm)/rate
    x = angle = 0.0
    for n in range(_GAUSS_X.size):
        V, delta = manifold_pair(end + span * _GAUSS_X[n], 0, table)
        x += _GAUSS_W[n] * V
        angle += _GAUSS_W[n] * V * (1.0 + delta)
    return x * span / rate, angle * span / rate


@kernel
def remaining_slip_loss(slow_log, table):
    """Return the slip loss that remains to rest on the slow manifold, a float >= 0, divided by m
    (R/T_epsilon)^2.

    slow_log : float, slow logarithm, not a NaN, below 2^SLOW_OCTAVES - 1, the end of the table; not
        checked.  Below the table the loss falls as V^3.
    table : vector of all tables, ``table`` of Flow.
    """
    at, t, share = _locate_on_manifold(slow_log)
    return share**3 * evaluate_single(table, at + SLOW_LOSS, t)[0]


@kernel
def manifold_at_speed(v, table):
    """Return (slow logarithm, delta) on the slow manifold at a speed, floats, each of either sign.

    v : float, kappa V, from LOWEST to below 2^HIGH; it is not checked.
    table : vector of all tables, ``table`` of Flow.
    """
    row, t, _ = locate_octave(v, LOW)
    return evaluate_pair(table, STARTS.manifold + (row - 1) * ROW_SIZES.manifold, t)[:2]


@inline_kernel
def read_asymptote(family, v, level, flow):
    """Return the motion on the slow manifold that a motion approaches after the onset of partial
    slip: its asymptote.

    family : PLUS if omega > V at the onset, MINUS if omega < V, with V > 0.
    v : float, kappa V at the onset, from 2^first to below 2^(first + OCTAVES); it is
    not checked.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; ``table`` and ``first`` are read.

    Returns an :class:`.records.Asymptote` of floats: slow_log, that of the asymptote at the time of
    the onset; rate, the k0 of the stiff time E, > 0; split, the E that divides the layer, exactly 1
    in octaves of v where motions of the family do not pass delta = 0; x, angle (both times gamma; 0
    below level PATH) and loss (0 below level LOSS), by which the motion exceeds the asymptote from
    the onset to rest, of either sign.
    """
    table = flow.table
    # onsets are tabulated from 2^first on, which is the begin of row 1; PLUS first, then MINUS
    row, t, _ = locate_octave(v, flow.first)
    at = STARTS.asymptote + (row - 1 + family * OCTAVES) * ROW_SIZES.asymptote
    slow_log, rate = evaluate_pair(table, at, t)[:2]
    x = angle = loss = 0.0
    if level >= PATH:
        x, angle = evaluate_pair(table, at + ASYMPTOTE_PATH, t)[:2]
    if level >= LOSS:
        loss = evaluate_single(table, at + ASYMPTOTE_LOSS, t)[0]
    return Asymptote(
        slow_log=slow_log,
        rate=rate,
        split=evaluate_single(table, at + ASYMPTOTE_SPLIT, t)[0],
        x=x,
        angle=angle,
        loss=loss,
    )


@inline_kernel
def layer_coordinate(E, split):
    """Return the layer coordinate u, which grows with the stiff time, linearly on either side of
    the split.

    E : float, stiff time since the onset, >= 0.
    split : float, the E at which the layer is divided, > 0.
    Returns u, a float: 2^LAYER_LOW at the onset, 1 at the split, 1 + E - split after it.
    """
    return LOWEST_U + (1.0 - LOWEST_U) * E / split if E < split else 1.0 + E - split


@kernel
def initial_u(size, slow, turns):
    """Return the first guess of the layer coordinate u at which delta has fallen to a given value,
    by Carter's law.

    size : float, delta/delta_star of the start, in [-1, 1], times 1 for PLUS and -1 for MINUS:
        negative beyond delta = 0.
    slow : float, delta/delta_star on the slow manifold at the speed of the start, times the same
        sign; less than ``size``, in (-1, 1).
    turns : bool, whether motions of this family pass delta = 0 (then the layer has a split there).

    Returns u, a float from 2^LAYER_LOW on, below 1 before the split of the layer; it may lie beyond
    the end of the layer, to which the caller limits it.

    Carter's law is that of elastic bodies: with r = 1 - |delta|/delta_star the traction is 1 - r^2,
    so that dr/dE = (a^2 - r^2)/2 where a^2 is 1 minus the traction on the slow manifold.
    """
    traction = np.copysign(1.0 - (1.0 - abs(slow)) ** 2, slow)  # on the slow manifold, over mu
    a = np.sqrt(1.0 - traction)
    # From r = 0 at the onset, E = ln((a + r)/(a - r))/a; r = 1 at the split.  1e-14 keeps the
    # logarithms finite where the start is on the manifold.
    if size > 0.0:
        r = 1.0 - size
        E = np.log((a + r) / max(a - r, 1e-14)) / a
        split = np.log((a + 1.0) / max(a - 1.0, 1e-14)) / a if turns else 1.0
        return layer_coordinate(E, split)
    # Beyond delta = 0 the traction is r^2 - 1, and r falls from 1 to b, its value on the manifold:
    # dr/dE = -(r^2 - b^2)/2.
    r = 1.0 + size
    b = max(1.0 + slow, 1e-3)  # not 0, by which is divided; it is a first guess
    # u = 1 at r = 1, where delta = 0; u then grows as E
    return 1.0 + np.log((1.0 - b) / (1.0 + b) * (r + b) / max(r - b, 1e-14)) / b


@inline_kernel
def locate_in_layer(family, v, u, flow):
    """Return the position of a motion in the table of the boundary layer.

    family : PLUS or MINUS.
    v : float, kappa V at the onset, from 2^first to below 2^(first + OCTAVES).
    u : float, layer coordinate, from 2^LAYER_LOW to below 2^LAYER_HIGH.
    flow : Flow, of the scene; ``first`` is read.

    Returns (position, t, s): index in the map's vector at which the polynomials of column 0 begin,
    int; their arguments in [-1, 1), floats, t over v and s over u, each linear within an octave.
    That v and u are inside of the table is not checked.
    """
    row, t, _ = locate_octave(v, flow.first)
    part, s, _ = locate_octave(u, LAYER_LOW)
    # the layout of FlowTables.layer: family, octave of v, octave of u; rows count from 1 in both
    return (
        STARTS.layer + ((row - 1 + family * OCTAVES) * SHAPES.layer[2] + part - 1) * _LAYER,
        t,
        s,
    )


@inline_kernel
def _evaluate_in_t(p, t):
    """Return the value of a polynomial of 12 coefficients, a float.

    p : the coefficients in ascending order, as three vectors of four.
    t : float, argument.
    """
    square = t * t
    per = broadcast(square * square)  # t^4, the ratio of the powers of successive vectors
    # lanes: sums of the coefficients of the powers 4 n, 4 n + 1, 4 n + 2 and 4 n + 3, times t^4n
    return join_lanes(fma4(fma4(p[2], per, p[1]), per, p[0]), t, square)


@inline_kernel
def layer_value_and_slopes(table, column, place):
    """Return value and slopes of one quantity of the boundary layer after the onset of partial
    slip.

    table : vector of all tables, ``table`` of Flow.
    column : int, the quantity: LAYER_LN_V ln(V/V0), LAYER_CREEP delta, LAYER_X and LAYER_ANGLE
        (distance and angle beyond those at constant V0, in units of V0/k0), LAYER_LOSS (slip loss
        divided by V0^2); V0 is V at the onset.
    place : (position, t, s) from :func:`locate_in_layer`: int, and the arguments over V at onset
        and over u, in [-1, 1].

    Returns (value, derivative in t at fixed s, derivative in s at fixed t), floats, dimensionless.
    """
    at, t, s = place
    at += column * BLOCK
    per = broadcast(s)
    # Horner's scheme in s, of vectors of the coefficients in t: ``value`` of the polynomial,
    # ``rise`` of its derivative in s.
    value = _powers(table, at + BLOCK - LAYER_TERMS)
    rise = value
    for m in range(LAYER_TERMS - 2, 0, -1):
        value = fma4(value, per, _powers(table, at + m * LAYER_TERMS))
        rise = fma4(rise, per, value)
    value = fma4(value, per, _powers(table, at))
    # Derivative in t, by Horner's scheme of numbers.
    powers = (*unpack(value[0]), *unpack(value[1]), *unpack(value[2]))
    slope = 11.0 * powers[11]
    for k in range(10, 0, -1):
        slope = fma(slope, t, k * powers[k])
    return _evaluate_in_t(value, t), slope, _evaluate_in_t(rise, t)


@kernel
def layer_value(table, column, place):
    """Return the value alone of one quantity of the boundary layer; the search for an onset needs
    slopes too.

    table : vector of all tables, ``table`` of Flow.
    column : int, the quantity, LAYER_LN_V ... LAYER_LOSS, as of :func:`layer_value_and_slopes`.
    place : (position, t, s) from :func:`locate_in_layer`, as of the same.
    Returns a float, dimensionless.
    """
    return layer_value_and_slopes(table, column, place)[0]


@kernel
def layer_state(family, v, asymptote, elapsed, level, flow):
    """Return the state of a motion within the boundary layer after the onset of partial slip,
    mirrored so that V > 0.

    family, v : fields of :class:`.records.StickOnset`: kind of the onset, and kappa V there.
    asymptote : :class:`.records.Asymptote` of the motion, of which rate k0 and split are read.
    elapsed : float, time tau = gamma t since the onset, >= 0 and at most LAYER_END/k0.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; ``table``, ``first`` and kappa are read.

    Returns (V, delta, distance, angle, slip loss), floats: speed > 0; creepage, of either sign;
    distance and angle since the onset, times gamma, 0 below level PATH; slip loss since the onset,
    divided by m (R/T_epsilon)^2, 0 below level LOSS.
    """
    table = flow.table
    E = elapsed * asymptote.rate
    place = locate_in_layer(family, v, layer_coordinate(E, asymptote.split), flow)
    V0 = v / flow.kappa
    x = angle = loss = 0.0
    # the table has what exceeds constant V0, in units of V0/k0: E is the path at constant V0
    if level >= PATH:
        scale = V0 / asymptote.rate
        x = scale * (E + layer_value(table, LAYER_X, place))
        angle = scale * (E + layer_value(table, LAYER_ANGLE, place))
    if level >= LOSS:
        loss = layer_value(table, LAYER_LOSS, place) * V0 * V0
    V = V0 * np.exp(layer_value(table, LAYER_LN_V, place))
    return V, layer_value(table, LAYER_CREEP, place), x, angle, loss
