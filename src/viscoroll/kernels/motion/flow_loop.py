"""Many motions of one scene, looked up in its flow map.

Of a start in partial slip the onset of partial slip that it would have come from is searched
first.  The map is explained in docs/internals_motion.md, Flow map.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.

Terms of this file:

- Flow: the flow map of one scene: ``table``, the vector of all its tables; kappa, mu, j; ``first``,
  the exponent from which kappa V at onset is tabulated; ``slow_rate``.
- Slow manifold: the creepage delta as a function of V that all motions in partial slip approach and
  then keep; the slow logarithm is a coordinate along it that falls linearly in tau.
- Boundary layer: the time after the onset of partial slip in which delta approaches the manifold.
  E = k0 (tau - tau_onset) is its stiff time, k0 the relaxation rate at onset.
- Layer coordinate u: a function of E, 2^LAYER_LOW at the onset; u = 1 at the split, an E near the
  place where motions of the family pass delta = 0, or 1 where they do not.
- Family: PLUS (0) if omega > V at the onset, MINUS (1) if omega < V; V > 0.
- Times are tau = gamma t.  Distances and angles are integrals over tau, gamma times x and gamma
  times the angle, until :func:`look_up_motions` divides them by gamma.
- Level: SPEEDS (0): V and omega alone; PATH (1): distance and angle too; LOSS (2): slip loss too.
- out: one motion, (ROWS, times): V 0, omega 1, distance 2, angle 3, delta 4, regime 5 (FULL_SLIP 0,
  PARTIAL_SLIP 1, AT_REST 2), slip loss 6, rolling loss 7; losses are divided by m (R/T)^2, with the
  unit of time T.
- Mirrored frame: the signs of V and omega are changed (frame -1) or not (frame 1), so that omega >=
  V in full slip and V > 0 in partial slip.
- StickOnset: the onset of partial slip: frame, family (PLUS if omega > V there, MINUS if omega <
  V), v = kappa V, tau, distance, angle and slip loss.
- Asymptote: the motion on the slow manifold that a motion approaches after its onset: slow
  logarithm at the onset, relaxation rate k0, split of the boundary layer, excess of distance, angle
  and slip loss.
"""

import numpy as np

from ..law.law_functions import locate_octave
from ..law.law_record import element
from ..numerics.intrinsics import bits_to_float
from ..numerics.jit import inline_kernel, kernel
from ..records import (
    CAME_TO_REST,
    COMPLETED,
    FULL_SLIP,
    PARTIAL_SLIP,
    Asymptote,
    FullSlipStart,
    Output,
    Request,
    StickOnset,
)
from .flow_layout import (
    LAYER_CREEP,
    LAYER_END,
    LAYER_HIGH,
    LAYER_LN_V,
    MINUS,
    OCTAVES,
    OUT_ANGLE,
    OUT_OMEGA,
    OUT_V,
    OUT_X,
    PLUS,
    ROLLING_LOSS,
    ROWS,
    SLIP_LOSS,
    write_rest,
)
from .flow_lookup import (
    HIGHEST,
    LOSS,
    LOWEST,
    LOWEST_U,
    PATH,
    SPEEDS,
    full_slip_integrals,
    initial_u,
    layer_state,
    layer_value_and_slopes,
    locate_in_layer,
    manifold_at_speed,
    manifold_pair,
    manifold_path,
    read_asymptote,
    read_onset,
    remaining_slip_loss,
    slide_distance,
    speed_at_slide_time,
)

# --- Flow map, starts in partial slip ---

#: a creepage closer to that of the slow manifold lies on it; the error of omega/V is as small
_ON_MANIFOLD = 1e-10
#: creepage difference below which the polynomials of the layer cannot separate a state from the
#: slow manifold
_INDISTINGUISHABLE = 1e-9
#: largest relative residual in V of a solution; motions with a larger one are left to the
#: integrator
_RESIDUAL = 1e-10
#: largest number of steps of Newton's iteration
_MAX_ITERATIONS = 12
#: step after which the iteration ends: the error that remains is about its square
_CONVERGED = 1e-7
#: stiff rate of a motion on the slow manifold: its layer has length 0
_NO_LAYER = 1e30
#: upper end of the layer coordinate u, one rounding below the table's edge
_HIGHEST_U = 2.0**LAYER_HIGH * (1.0 - 2.0**-50)


@kernel
def find_onset(V, delta, edge, flow):
    """Find the onset of partial slip from which a state in partial slip would have come.

    V : float, speed of the axis, > 0.
    delta : float, creepage, |delta| < delta_star.
    edge : float, delta_star at V, > 0; it serves the first guess only.
    flow : Flow, of the scene; ``table``, ``first`` and kappa are read.

    Returns (family, kappa V at that onset, E, whether the map covers the state): int, float, float,
    bool.  family is PLUS or MINUS; E is the stiff time since that onset, in [0, LAYER_END].  A
    state on the slow manifold has family PLUS, kappa V of the state itself, and an infinite E.  The
    tests are made in this order:

    1. kappa V below LOWEST, or at least the smaller of HIGHEST and 2^(first + OCTAVES), or NaN: not
       covered.
    2. delta within 1e-10 of the manifold: covered, on the manifold.
    3. kappa V below 2^(first + 1) or above 2^(first + OCTAVES - 1), an octave inside of the
       tabulated onsets: not covered.
    4. An onset is found, with E at most LAYER_END: covered.
    5. Else, an E above LAYER_END included: covered, on the manifold, if delta is within 1e-9 of it;
       otherwise not.

    Where the state is not covered, a NaN of delta included, the first three have no meaning.

    Method: Newton's iteration in ln V at onset and in u, of at most 12 steps, applied to the
        logarithm of the distance from the manifold, which decreases nearly linearly in E; a
        solution counts if V (relative) and delta (absolute) are met to 1e-10.
    """
    v = flow.kappa * V
    lowest = bits_to_float((flow.first + 1023) << 52)  # 2^first: 1023 is the exponent's bias
    highest = lowest * 2.0**OCTAVES
    if not LOWEST <= v < min(highest, HIGHEST):
        return PLUS, v, 0.0, False
    _, slow = manifold_at_speed(v, flow.table)
    gap = delta - slow
    if abs(gap) < _ON_MANIFOLD:
        return PLUS, v, np.inf, True
    if not 2.0 * lowest <= v <= 0.5 * highest:
        return PLUS, v, 0.0, False
    family, sign = (PLUS, 1.0) if gap > 0.0 else (MINUS, -1.0)
    turns = read_asymptote(family, v, SPEEDS, flow).split != 1.0
    u = initial_u(sign * delta / edge, sign * slow / edge, turns)
    # Iterates: v0 = kappa V at the onset, ln_v0 = ln(v0/v), and u.
    v0 = v
    ln_v0 = 0.0
    change = np.inf
    # the test of convergence follows the evaluation, so that ln_V and creep belong to the last v0
    # and u
    for _ in range(_MAX_ITERATIONS):
        u = min(max(LOWEST_U, u), _HIGHEST_U)  # LOWEST_U if it is NaN
        place = locate_in_layer(family, v0, u, flow)
        ln_V, ln_t, ln_s = layer_value_and_slopes(flow.table, LAYER_LN_V, place)
        creep, creep_t, creep_s = layer_value_and_slopes(flow.table, LAYER_CREEP, place)
        if change < _CONVERGED:
            break
        # Distance from the manifold over that of the state, whose logarithm is to be 0.  Where the
        # table has passed the manifold (or NaN) u is brought nearer to the onset.
        away = (creep - slow) / gap
        if not away > 0.0:
            u = 0.5 * (u + LOWEST_U)  # ``change`` stays: the iteration has not converged
            continue
        # Slopes in ln v0 and u: s and t are 4 m - 3 with the mantissa m of v0 and of u.
        _, t, s = place
        per_v = t + 3.0
        per_u = (s + 3.0) / u
        inverse_difference = 1.0 / (creep - slow)
        # The two residuals, ln of V over that of the state and ln of ``away``, and the matrix
        # (a b, c d) of their slopes in ln v0 and u.
        first = ln_v0 + ln_V
        second = np.log(away)
        a = 1.0 + ln_t * per_v
        b = ln_s * per_u
        c = creep_t * per_v * inverse_difference
        d = creep_s * per_u * inverse_difference
        determinant = a * d - b * c
        # Newton's step by Cramer's rule; v0 stays inside of the tabulated onsets, whose end is not
        # among them
        shift = (first * d - b * second) / determinant
        step = (a * second - c * first) / determinant
        v0 = min(max(lowest, v * np.exp(ln_v0 - shift)), 0.99 * highest)
        ln_v0 = ln_v0 - shift
        u = u - step
        # The errors that are left are about the squares of these: of delta gap second^2.
        change = abs(shift) + abs(second) * np.sqrt(abs(gap))
    split = read_asymptote(family, v0, SPEEDS, flow).split
    # E of u: the inverse of flow_lookup.layer_coordinate
    E = (u - LOWEST_U) / (1.0 - LOWEST_U) * split if u < 1.0 else u - 1.0 + split
    found = abs(v0 * np.exp(ln_V) - v) <= _RESIDUAL * v and abs(creep - delta) <= _RESIDUAL
    if found and E <= LAYER_END:
        return family, v0, E, True
    return PLUS, v, np.inf, abs(gap) < _INDISTINGUISHABLE


# --- Look up many motions of one scene in its flow map ---

#: status of a motion that the map does not contain
NOT_COVERED = -1
#: largest ratio of initial speed to speed at onset: V at onset is a difference whose error is 2e-14
#: of the initial one
_MAX_SPEED_RATIO = 4096.0


@inline_kernel
def _start_in_full_slip(frame, V, omega, start, level, flow):
    """Locate the onset of partial slip of a motion that starts in full slip.

    frame : float, 1, or -1 where the motion is mirrored.
    V, omega : float, initial speeds in the mirrored frame, omega >= V.
    start : (T, X), time tau and distance times gamma of sliding between rest and V, from the table
        of full slip.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; all fields but ``slow_rate`` are read.

    Returns (:class:`FullSlipStart`; :class:`StickOnset` at a time tau >= 0, in the frame in which V
    > 0 at the onset; whether the map covers the motion: its V at onset is tabulated and |V|
    and |omega| at the start are at most 4096 times that).  Below level PATH distance, angle and
    slip loss of the onset have no meaning, and where the map does not cover the motion its whole
    onset has none.
    """
    mu = flow.mu
    T, X = start
    # V - j omega = w + 2 mu tau while sliding, and its integral is x - j angle = tau (w + mu tau).
    w = V - flow.j * omega
    V_on, T_on, X_on = read_onset(w - 2.0 * mu * T, level, flow)
    v = flow.kappa * abs(V_on)
    # V at onset is tabulated in the rows 1 to OCTAVES
    covered = 0 < locate_octave(v, flow.first)[0] <= OCTAVES
    covered = covered and flow.kappa * max(abs(V), abs(omega)) <= _MAX_SPEED_RATIO * v
    # the map counts both from V = 0: differences; rounding may leave a start just after its onset
    tau = max(T_on - T, 0.0)
    x = X_on - X
    angle = (x - tau * (w + mu * tau)) / flow.j
    # omega > V in the mirrored frame; where V < 0 at the onset it is mirrored once more, so that V
    # > 0, and omega is below it
    family, frame_on = (PLUS, frame) if V_on > 0.0 else (MINUS, -frame)
    stick = StickOnset(
        frame=frame_on,
        family=family,
        v=v,
        tau=tau,
        x=frame * x,
        angle=frame * angle,
        loss=mu * (angle - x),
    )
    return FullSlipStart(frame, w, T, X), stick, covered


@kernel
def _start_in_partial_slip(V0, omega0, edge, level, flow):
    """Locate the onset of partial slip, at a time before the start, of a motion that starts in
    partial slip.

    The motion from that onset on passes through the start, so that the tables, which begin at an
    onset, hold for it.

    V0, omega0 : float, initial speeds, not mirrored; V0 != 0, and |omega0 - V0| < edge |V0|.
    edge : float, delta_star at V0, dimensionless.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; ``table``, ``first`` and kappa are read.

    Returns (:class:`StickOnset` at a time tau <= 0; its :class:`.records.Asymptote`; whether the
    map covers the motion, without which the other two have no meaning).  Distance, angle and slip
    loss of the onset are minus those from there to the start, not mirrored; below level PATH all
    are 0, below LOSS the loss.  A start on the slow manifold has its onset at practically tau = 0
    and no boundary layer.
    """
    frame = 1.0 if V0 > 0.0 else -1.0
    family, v, E, covered = find_onset(abs(V0), (omega0 - V0) / V0, edge, flow)
    x = angle = loss = 0.0
    if E > LAYER_END or not covered:
        # E is at the end of a layer of practically no length: tau is close to 0, the start
        E = LAYER_END
        asymptote = Asymptote(
            slow_log=manifold_at_speed(v, flow.table)[0] if covered else 0.0,
            rate=_NO_LAYER,
            split=1.0,
            x=0.0,
            angle=0.0,
            loss=0.0,
        )
    else:
        asymptote = read_asymptote(family, v, level, flow)
        if E != 0.0 and level >= PATH:
            elapsed = E / asymptote.rate
            _, _, x, angle, loss = layer_state(family, v, asymptote, elapsed, level, flow)
    stick = StickOnset(
        frame=frame,
        family=family,
        v=v,
        tau=-E / asymptote.rate,
        x=-frame * x,
        angle=-frame * angle,
        loss=-loss,
    )
    return stick, asymptote, covered


@inline_kernel
def _full_slip_state(tau, slide, level, flow):
    """Return the output before the onset of partial slip, in the frame of the caller.

    tau : float, time gamma t, > 0, before the onset.
    slide : :class:`FullSlipStart`: frame; w = V - j omega at the start, in the mirrored frame; T
        and X, time tau and gamma times the distance of sliding between rest and the V of the start.
    level : SPEEDS, PATH or LOSS: distance, angle and slip loss are computed from PATH on, and are 0
        below it.
    flow : Flow, of the scene; ``table``, kappa, mu and j are read.
    Returns an :class:`Output` of floats; delta is +inf where V = 0.
    """
    mu = flow.mu
    per_j = 1.0 / flow.j
    frame, w, T0, X0 = slide
    V = speed_at_slide_time(T0 + tau, flow)  # T counts from V = 0, and is T0 at the start
    # From V - j omega = w + 2 mu tau and its integral over tau.
    omega = (V - (w + 2.0 * mu * tau)) * per_j
    x = angle = 0.0
    if level >= PATH:
        x = slide_distance((T0, X0), tau, flow)
        angle = (x - tau * (w + mu * tau)) * per_j
    return Output(
        V=frame * V,
        omega=frame * omega,
        x=frame * x,
        angle=frame * angle,
        delta=(omega - V) / V if V != 0.0 else np.inf,
        regime=float(FULL_SLIP),
        loss=mu * (angle - x),
    )


@inline_kernel
def _partial_slip_state(tau, stick, asymptote, total_loss, level, flow):
    """Return the output in partial slip, in the boundary layer or on the slow manifold, in the
    frame of the caller.

    tau : float, time gamma t, > 0, from the onset on.
    stick : :class:`StickOnset`: frame, speed, time and path at the onset.
    asymptote : :class:`.records.Asymptote`: the motion on the slow manifold that it approaches.
    total_loss : float, slip loss from the onset to rest; read at level LOSS.
    level : SPEEDS, PATH or LOSS: quantities beyond it are those of ``stick`` at all times, which
        have no meaning then.
    flow : Flow, of the scene; ``table``, ``first``, kappa and ``slow_rate`` are read.
    Returns an :class:`Output` of floats.
    """
    frame = stick.frame
    elapsed = tau - stick.tau
    x = angle = loss = 0.0
    if tau < stick.tau + LAYER_END / asymptote.rate:
        V, delta, x, angle, loss = layer_state(
            stick.family, stick.v, asymptote, elapsed, level, flow
        )
    else:
        span = flow.slow_rate * elapsed
        now = asymptote.slow_log - span
        V, delta = manifold_pair(now, 0, flow.table)
        if level >= PATH:
            x, angle = manifold_path(asymptote.slow_log, span, flow.slow_rate, flow.table)
            x += asymptote.x
            angle += asymptote.angle
        if level >= LOSS:
            loss = total_loss - remaining_slip_loss(now, flow.table)
    return Output(
        V=frame * V,
        omega=frame * V * (1.0 + delta),
        x=stick.x + frame * x,
        angle=stick.angle + frame * angle,
        delta=delta,
        regime=float(PARTIAL_SLIP),
        loss=stick.loss + loss,
    )


@inline_kernel
def look_up_motion(V0, omega0, tau_out, request, flow, out):
    """Look up one motion and write its outputs.

    V0, omega0 : float, initial speeds, of any sign.
    tau_out : output times tau = gamma t, ascending, >= 0, (times,), at least one.
    request : :class:`.records.Request`: level; rest threshold, 0 for none; slow logarithm at that
        threshold.
    flow : Flow, of the scene.
    out : outputs (ROWS, times), written in the frame of the caller but for the row ROLLING_LOSS;
        not whole if the status is NOT_COVERED.  Below level PATH the rows of distance and angle
        have no meaning, below LOSS that of slip loss.  delta is +inf where V = 0 in full slip, and
        0 at rest.

    Returns (status, time of the onset of partial slip, time of coming to rest).  The status is
    COMPLETED (0), CAME_TO_REST (1) or NOT_COVERED (-1).  Times are tau.  The onset is NaN for a
    start in partial slip, for a motion that is still in full slip at the last output time, and for
    a start with both |V0| and |omega0| below the rest threshold, which is at rest from tau = 0 on:
    its time of rest is 0, and its outputs are 0 with the regime AT_REST.  The time of rest is NaN
    unless the status is CAME_TO_REST.  With NOT_COVERED the times have no meaning.

    The map does not cover a motion if kappa |V0| is at least HIGHEST, if a start speed is NaN, if
    the onset of partial slip is not tabulated or more than 4096 times slower than the start, if a
    start in partial slip is no state of a tabulated motion (:func:`find_onset`), if V at the onset
    is below twice the rest threshold, or if the motion comes to rest within the boundary layer or
    before the start.  A start with V0 = omega0 = 0 is not covered without a rest threshold.
    """
    kappa = flow.kappa
    level = request.level
    if abs(V0) < request.rest and abs(omega0) < request.rest:
        write_rest(0, 0.0, 0.0, 0.0, out)
        return CAME_TO_REST, np.nan, 0.0
    if not kappa * abs(V0) < HIGHEST:  # True for NaN too.
        return NOT_COVERED, np.nan, np.nan
    frame = 1.0 if omega0 >= V0 else -1.0
    V = frame * V0
    omega = frame * omega0
    T, X, limit = full_slip_integrals(V, level, flow)
    starts_in_full_slip = omega - V >= limit  # limit: delta_star |V|
    if starts_in_full_slip:
        slide, stick, covered = _start_in_full_slip(frame, V, omega, (T, X), level, flow)
    else:
        stick, asymptote, covered = _start_in_partial_slip(V0, omega0, limit / abs(V), level, flow)
    if not covered or stick.v < 2.0 * kappa * request.rest:
        return NOT_COVERED, np.nan, np.nan
    end = tau_out[-1]
    onset = np.nan
    rest_time = np.inf
    total_loss = 0.0
    if stick.tau <= end:
        if starts_in_full_slip:
            onset = stick.tau
            asymptote = read_asymptote(stick.family, stick.v, level, flow)
        if request.rest > 0.0:
            # the slow logarithm falls linearly from that of the asymptote at the onset; the formula
            # holds on the slow manifold alone, after the layer
            rest_time = stick.tau + (asymptote.slow_log - request.rest_slow_log) / flow.slow_rate
            if rest_time < max(stick.tau + LAYER_END / asymptote.rate, 0.0):
                return NOT_COVERED, np.nan, np.nan
        # slip loss from the onset to rest: that of the asymptote, and the excess over it; the loss
        # so far is this less what remains
        if level >= LOSS:
            total_loss = remaining_slip_loss(asymptote.slow_log, flow.table) + asymptote.loss
    at = 0
    while at < tau_out.size and tau_out[at] <= rest_time:
        tau = tau_out[at]
        if tau == 0.0:
            state = Output(
                V=V0,
                omega=omega0,
                x=0.0,
                angle=0.0,
                delta=(omega0 - V0) / V0 if V0 != 0.0 else np.inf,
                regime=float(FULL_SLIP if starts_in_full_slip else PARTIAL_SLIP),
                loss=0.0,
            )
        elif tau < stick.tau:
            state = _full_slip_state(tau, slide, level, flow)
        else:
            state = _partial_slip_state(tau, stick, asymptote, total_loss, level, flow)
        for row in range(len(state)):
            out[row, at] = state[row]
        at += 1
    if end <= rest_time:
        return COMPLETED, onset, np.nan
    x, angle = manifold_path(
        asymptote.slow_log, asymptote.slow_log - request.rest_slow_log, flow.slow_rate, flow.table
    )
    x = stick.x + stick.frame * (x + asymptote.x)
    angle = stick.angle + stick.frame * (angle + asymptote.angle)
    loss = total_loss - remaining_slip_loss(request.rest_slow_log, flow.table)
    write_rest(at, x, angle, stick.loss + loss, out)
    return CAME_TO_REST, onset, rest_time


@kernel(allocates=True)
def look_up_motions(flow, motions, result, start, stop):
    """Look up some motions in the flow map and write their outputs; motions outside the map get the
    status NOT_COVERED.

    flow : Flow, of the scene.
    motions : :class:`.records.Motions` of all n motions: gamma; rest threshold, 0 for none; initial
        speeds V0, omega0, of length 1 or n; output times t, ascending, >= 0, (times,), at least
        one; requested rows of an output, int, (q,).
    result : arrays of :class:`viscoroll.motion.flow.FlowResult`, of which the entries of these
        motions are written: out, (q, n, times); status, (n,), COMPLETED (0), CAME_TO_REST (1) or
        NOT_COVERED (-1); onset and rest, (n,), times t of the onset of partial slip and of coming
        to rest, NaN where there is none up to the last output time; switches, (n,), number of
        changes of regime: the onset, and coming to rest unless V0 = omega0 = 0.
    start, stop : int, index of the first motion and of the one after the last.

    Distance and angle are written as x and angle, divided by gamma.  The rolling loss is the loss
    of kinetic energy since the start less the slip loss.  Entries of a motion that is not covered
    have no meaning, apart from its status.
    Returns nothing.
    """
    gamma, rest, V0, omega0, t, rows = motions
    one = np.empty((ROWS, t.size))  # outputs of one motion, of which the requested rows are copied
    tau = t * gamma
    level = SPEEDS
    # the highest level that a requested row needs; the rolling loss needs the slip loss
    for row in rows:
        if row >= SLIP_LOSS:
            level = LOSS
        elif level == SPEEDS and (row == OUT_X or row == OUT_ANGLE):
            level = PATH
    # The slow logarithm at which max(|V|, |omega|) on the slow manifold equals the rest threshold;
    # of one above half the highest V of a start, that half.
    rest_slow_log = 0.0
    if rest > 0.0:
        highest = min(rest, 0.5 * HIGHEST / flow.kappa)
        v = flow.kappa * highest
        # the fixed point of V = rest/(1 + max(delta(V), 0)): a negative delta counts as 0, as |V|
        # then is the larger speed, and below the tables delta counts as 0
        for _ in range(4):
            delta = manifold_at_speed(v, flow.table)[1] if v >= LOWEST else 0.0
            v = flow.kappa * (highest / (1.0 + max(delta, 0.0)))
        # below the tables that of their lowest V plus the logarithm of the ratio of the speeds
        rest_slow_log = manifold_at_speed(max(v, LOWEST), flow.table)[0]
        rest_slow_log += np.log(min(v, LOWEST) / LOWEST)
    request = Request(level, rest, rest_slow_log)
    for i in range(start, stop):
        V = element(V0, i)
        omega = element(omega0, i)
        result.status[i], onset, rest_time = look_up_motion(V, omega, tau, request, flow, one)
        if level >= LOSS:
            # Kinetic energy (V^2 + j omega^2)/2 lost since the start, as products of differences.
            for m in range(t.size):
                V_now = one[OUT_V, m]
                omega_now = one[OUT_OMEGA, m]
                lost = 0.5 * (
                    (V - V_now) * (V + V_now) + flow.j * (omega - omega_now) * (omega + omega_now)
                )
                one[ROLLING_LOSS, m] = lost - one[SLIP_LOSS, m]
        result.onset[i] = onset / gamma
        result.rest[i] = rest_time / gamma
        # the onset, which may be NaN, and coming to rest, but not of what stands from the start
        rests = result.status[i] == CAME_TO_REST and (V != 0.0 or omega != 0.0)
        result.switches[i] = np.int64(onset >= 0.0) + np.int64(rests)
        for n in range(rows.size):
            row = rows[n]
            scale = 1.0 / gamma if row == OUT_X or row == OUT_ANGLE else 1.0
            for m in range(t.size):
                result.out[n, i, m] = one[row, m] * scale
