"""Look up many motions of one scene in its flow map.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.

Terms of this file (records in :mod:`.records`):

- Flow: the flow map of one scene: ``table``, the vector of all its tables; kappa, mu, j; ``first``, the exponent from
  which kappa V at onset is tabulated; ``slow_rate``.
- Times are tau = gamma t.  Distances and angles are integrals over tau, gamma times x and gamma times the angle, until
  :func:`look_up_motions` divides them by gamma.
- Level: SPEEDS (0): V and omega alone; PATH (1): distance and angle too; LOSS (2): slip loss too.
- out: one motion, (ROWS, times): V 0, omega 1, distance 2, angle 3, delta 4, regime 5 (FULL_SLIP 0, PARTIAL_SLIP 1,
  AT_REST 2), slip loss 6, rolling loss 7; losses are divided by m (R/T)^2, with the unit of time T.
- Mirrored frame: the signs of V and omega are changed (frame -1) or not (frame 1), so that omega >= V in full slip and
  V > 0 in partial slip.
- Slow manifold: the creepage delta as a function of V that all motions in partial slip approach and then keep; the slow
  logarithm is a coordinate along it that falls linearly in tau.
- StickOnset: the onset of partial slip: frame, family (PLUS if omega > V there, MINUS if omega < V), v = kappa V, tau,
  distance, angle and slip loss.
- Asymptote: the motion on the slow manifold that a motion approaches after its onset: slow logarithm at the onset,
  relaxation rate k0, split of the boundary layer, excess of distance, angle and slip loss.
"""

import numpy as np

from ..compile.jit import inline_kernel, kernel
from ..motion.records import AT_REST, CAME_TO_REST, COMPLETED, FULL_SLIP, PARTIAL_SLIP
from ..rows.contact_states import element
from .layout import LAYER_END, MINUS, OCTAVES, PLUS
from .lookup import (
    HIGHEST,
    LOSS,
    PATH,
    SPEEDS,
    asymptote_on_manifold,
    full_slip_integrals,
    layer_state,
    manifold_at_speed,
    manifold_path,
    manifold_speeds,
    read_asymptote,
    read_onset,
    remaining_slip_loss,
    slide_distance,
    slow_log_at_rest,
    speed_at_slide_time,
)
from .onset_search import find_onset
from .records import FullSlipStart, Output, Request, StickOnset

#: status of a motion that the map does not contain
NOT_COVERED = -1
#: largest ratio of initial speed to speed at onset: V at onset is a difference whose error is 2e-14 of the initial one
_MAX_SPEED_RATIO = 4096.0
# Rows of the array of outputs.
#: speed of the axis
_V = 0
#: angular velocity
_OMEGA = 1
#: distance
_X = 2
#: angle
_ANGLE = 3
#: creepage
_DELTA = 4
#: regime
_REGIME = 5
#: energy lost by slip
SLIP_LOSS = 6
#: energy lost by rolling resistance
ROLLING_LOSS = 7
#: number of these rows
ROWS = 8


@inline_kernel
def _write_output(out, column, state):
    """Write one output state, of any part of a motion, into the rows of the module.

    out : outputs (ROWS, times), of which one column is written, all rows but ROLLING_LOSS.
    column : int, index of the output time.
    state : :class:`.records.Output`: V, omega, distance and angle (times gamma), delta, regime (a code of
        :mod:`..motion.records`) and loss by slip, dimensionless, with the signs of the motion, not mirrored.
    Returns nothing.
    """
    out[_V, column], out[_OMEGA, column], out[_X, column] = state.V, state.omega, state.x
    out[_ANGLE, column], out[_DELTA, column], out[_REGIME, column] = state.angle, state.delta, state.regime
    out[SLIP_LOSS, column] = state.loss


@inline_kernel
def _write_rest(at, x, angle, loss, out):
    """Write outputs at rest, V = omega = delta = 0 and regime AT_REST, from a column to the last.

    at : int, first column to write; nothing is written if it is the number of columns.
    x, angle : float, distance and angle, times gamma, of all of them, in the frame of the caller.
    loss : float, slip loss of all of them.
    out : outputs (ROWS, times), written but for the row ROLLING_LOSS.  Returns nothing.
    """
    for column in range(at, out.shape[1]):
        _write_output(out, column, Output(0.0, 0.0, x, angle, 0.0, AT_REST, loss))


@inline_kernel
def _start_in_full_slip(frame, V, omega, start, level, flow):
    """Locate the onset of partial slip of a motion that starts in full slip.

    frame : float, 1, or -1 where the motion is mirrored.
    V, omega : float, initial speeds in the mirrored frame, omega >= V.
    start : (T, X), time tau and distance times gamma of sliding between rest and V, from the table of full slip.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; all fields but ``slow_rate`` are read.

    Returns (:class:`FullSlipStart`; :class:`StickOnset` at a time tau >= 0, in the frame in which V > 0 at the onset;
    whether the map covers the motion: its V at onset is tabulated and |V| and |omega| at the start are at most 4096
    times that).  Below level PATH distance, angle and slip loss of the onset have no meaning, and where the map does
    not cover the motion its whole onset has none.
    """
    mu, (T, X) = flow.mu, start
    w = V - flow.j * omega
    V_on, T_on, X_on = read_onset(w - 2.0 * mu * T, level, flow)
    v = flow.kappa * abs(V_on)
    covered = 2.0**flow.first <= v < 2.0 ** (flow.first + OCTAVES)
    covered = covered and flow.kappa * max(abs(V), abs(omega)) <= _MAX_SPEED_RATIO * v
    tau, x = max(T_on - T, 0.0), X_on - X
    angle = (x - tau * (w + mu * tau)) / flow.j
    family, frame_on = (PLUS, frame) if V_on > 0.0 else (MINUS, -frame)
    stick = StickOnset(frame_on, family, v, tau, frame * x, frame * angle, mu * (angle - x))
    return FullSlipStart(frame, w, T, X), stick, covered


@kernel
def _start_in_partial_slip(V0, omega0, edge, level, flow):
    """Locate the onset of partial slip, at a time before the start, of a motion that starts in partial slip.

    The motion from that onset on passes through the start, so that the tables, which begin at an onset, hold for it.

    V0, omega0 : float, initial speeds, not mirrored; V0 != 0, and |omega0 - V0| < edge |V0|.
    edge : float, delta_star at V0, dimensionless.
    level : SPEEDS, PATH or LOSS: quantities to compute.
    flow : Flow, of the scene; ``table``, ``first`` and kappa are read.

    Returns (:class:`StickOnset` at a time tau <= 0; its :class:`Asymptote`; whether the map covers the motion, without
    which the other two have no meaning).  Distance, angle and slip loss of the onset are minus those from there to the
    start, not mirrored; below level PATH all are 0, below LOSS the loss.  A start on the slow manifold has its
    onset at practically tau = 0 and no boundary layer.
    """
    frame = 1.0 if V0 > 0.0 else -1.0
    family, v, E, covered = find_onset(abs(V0), (omega0 - V0) / V0, edge, flow)
    if E > LAYER_END or not covered:
        asymptote = asymptote_on_manifold(manifold_at_speed(v, flow.table)[0] if covered else 0.0)
        return StickOnset(frame, family, v, -LAYER_END / asymptote.rate, 0.0, 0.0, 0.0), asymptote, covered
    asymptote = read_asymptote(family, v, level, flow)
    stick = StickOnset(frame, family, v, -E / asymptote.rate, 0.0, 0.0, 0.0)
    if E == 0.0 or level < PATH:
        return stick, asymptote, covered
    _, _, x, angle, loss = layer_state(stick, asymptote, -stick.tau, level, flow)
    return StickOnset(frame, family, v, stick.tau, -frame * x, -frame * angle, -loss), asymptote, True


@inline_kernel
def _write_full_slip(at, tau_out, until, slide, level, flow, out):
    """Write the outputs before the onset of partial slip.

    at : int, first column to write.
    tau_out : output times tau = gamma t, ascending, > 0 from column ``at`` on, (times,).
    until : float, time tau of the onset; an output at that time is not written.
    slide : :class:`FullSlipStart`: frame; w = V - j omega at the start, in the mirrored frame; T and X, time tau and
        gamma times the distance of sliding between rest and the V of the start.
    level : SPEEDS, PATH or LOSS: distance, angle and slip loss are written from PATH on, and 0 below it.
    flow : Flow, of the scene; ``table``, kappa, mu and j are read.
    out : outputs (ROWS, times), written but for the row ROLLING_LOSS, in the frame of the caller; delta is +inf where V
        = 0.  Columns with ``tau_out`` >= ``until`` stay.
    Returns the index of the next column to write, int; it is the number of times where no output is left.
    """
    mu, per_j = flow.mu, 1.0 / flow.j
    frame, w, T0, X0 = slide
    while at < tau_out.size and tau_out[at] < until:
        tau = tau_out[at]
        V = speed_at_slide_time(T0 + tau, flow)
        omega = (V - (w + 2.0 * mu * tau)) * per_j
        x = angle = 0.0
        if level >= PATH:
            x = slide_distance((T0, X0), tau, flow)
            angle = (x - tau * (w + mu * tau)) * per_j
        delta = (omega - V) / V if V != 0.0 else np.inf
        _write_output(
            out, at, Output(frame * V, frame * omega, frame * x, frame * angle, delta, FULL_SLIP, mu * (angle - x))
        )
        at += 1
    return at


@inline_kernel
def _write_partial_slip(at, tau_out, until, stick, asymptote, level, flow, out):
    """Write the outputs in partial slip up to a time, in the boundary layer and then on the slow manifold.

    at : int, first column to write.
    tau_out : output times tau = gamma t, ascending, (times,).
    until : float, last time tau; an output at that time is written.
    stick : :class:`StickOnset`: frame, speed, time and path at the onset.
    asymptote : :class:`Asymptote`: the motion on the slow manifold that it approaches.
    level : SPEEDS, PATH or LOSS: quantities beyond it are those of ``stick`` at all times, which have no meaning then.
    flow : Flow, of the scene; ``table``, ``first``, kappa and ``slow_rate`` are read.
    out : outputs (ROWS, times), written but for the row ROLLING_LOSS, in the frame of the caller: of the times from
        column ``at`` to ``until``; the others stay.
    Returns the index of the next column to write, int; it is the number of times where no output is left.
    """
    frame = stick.frame
    total_loss = remaining_slip_loss(asymptote.slow_log, flow.table) + asymptote.loss if level >= LOSS else 0.0
    layer_end = stick.tau + LAYER_END / asymptote.rate
    while at < tau_out.size and tau_out[at] <= until:
        elapsed = tau_out[at] - stick.tau
        x = angle = loss = 0.0
        if tau_out[at] < layer_end:
            V, delta, x, angle, loss = layer_state(stick, asymptote, elapsed, level, flow)
        else:
            span = flow.slow_rate * elapsed
            now = asymptote.slow_log - span
            V, delta = manifold_speeds(now, flow.table)
            if level >= PATH:
                x, angle = manifold_path(asymptote.slow_log, span, flow.slow_rate, flow.table)
                x, angle = x + asymptote.x, angle + asymptote.angle
            if level >= LOSS:
                loss = total_loss - remaining_slip_loss(now, flow.table)
        x, angle = stick.x + frame * x, stick.angle + frame * angle
        _write_output(
            out, at, Output(frame * V, frame * V * (1.0 + delta), x, angle, delta, PARTIAL_SLIP, stick.loss + loss)
        )
        at += 1
    return at


@inline_kernel
def _follow_partial_slip(at, tau_out, stick, asymptote, request, flow, out):
    """Write all outputs from the onset of partial slip to the last output time, those after coming to rest included.

    at : int, first column to write; nothing is written if it is the number of columns.
    tau_out : output times tau = gamma t, ascending, (times,), at least one.
    stick : :class:`StickOnset`: frame, speed, time and path at the onset.
    asymptote : :class:`Asymptote`: the motion on the slow manifold that it approaches.
    request : :class:`.records.Request`: level; rest, the value of max(|V|, |omega|) below which a motion is at rest, 0
        for none; rest_slow_log, the slow logarithm at that value.
    flow : Flow, of the scene; ``table``, ``first``, kappa and ``slow_rate`` are read.
    out : outputs (ROWS, times), written but for the row ROLLING_LOSS, in the frame of the caller; rows beyond the level
        have no meaning.

    Returns (status, time tau at which the motion comes to rest).  The status is COMPLETED (0), with the time NaN, where
    the motion does not come to rest before the last output time; CAME_TO_REST (1) where it does; NOT_COVERED (-1), with
    the time NaN and nothing written, where it would come to rest within the boundary layer or before the start.
    """
    layer_end = stick.tau + LAYER_END / asymptote.rate
    rest_time, end = np.inf, tau_out[tau_out.size - 1]
    if request.rest > 0.0:
        rest_time = stick.tau + (asymptote.slow_log - request.rest_slow_log) / flow.slow_rate
        if rest_time < max(layer_end, 0.0):
            return NOT_COVERED, np.nan
    at = _write_partial_slip(at, tau_out, min(rest_time, end), stick, asymptote, request.level, flow, out)
    if end <= rest_time:
        return COMPLETED, np.nan
    x, angle = manifold_path(asymptote.slow_log, asymptote.slow_log - request.rest_slow_log, flow.slow_rate, flow.table)
    loss = (
        asymptote.loss
        + remaining_slip_loss(asymptote.slow_log, flow.table)
        - remaining_slip_loss(request.rest_slow_log, flow.table)
    )
    x, angle = stick.x + stick.frame * (x + asymptote.x), stick.angle + stick.frame * (angle + asymptote.angle)
    _write_rest(at, x, angle, stick.loss + loss, out)
    return CAME_TO_REST, rest_time


@inline_kernel
def look_up_motion(V0, omega0, tau_out, request, flow, out):
    """Look up one motion and write its outputs.

    V0, omega0 : float, initial speeds, of any sign.
    tau_out : output times tau = gamma t, ascending, >= 0, (times,), at least one.
    request : :class:`.records.Request`: level; rest threshold, 0 for none; slow logarithm at that threshold.
    flow : Flow, of the scene.
    out : outputs (ROWS, times), written in the frame of the caller but for the row ROLLING_LOSS; not whole if the
        status is NOT_COVERED.  Below level PATH the rows of distance and angle have no meaning, below LOSS that of slip
        loss.  delta is +inf where V = 0 in full slip, and 0 at rest.

    Returns (status, time of the onset of partial slip, time of coming to rest).  The status is COMPLETED (0),
    CAME_TO_REST (1) or NOT_COVERED (-1).  Times are tau.  The onset is NaN for a start in partial slip, for a motion
    that is still in full slip at the last output time, and for a start with both |V0| and |omega0| below the rest
    threshold, which is at rest from tau = 0 on: its time of rest is 0, and its outputs are 0 with the regime AT_REST.
    The time of rest is NaN unless the status is CAME_TO_REST.  With NOT_COVERED the times have no meaning.

    The map does not cover a motion if kappa |V0| is at least HIGHEST, if a start speed is NaN, if the onset of partial
    slip is not tabulated or more than 4096 times slower than the start, if a start in partial slip is no state of a
    tabulated motion (:func:`find_onset`), if V at the onset is below twice the rest threshold, or if the motion comes
    to rest within the boundary layer or before the start.  A start with V0 = omega0 = 0 is not covered without a rest
    threshold.
    """
    kappa, level = flow.kappa, request.level
    if abs(V0) < request.rest and abs(omega0) < request.rest:
        _write_rest(0, 0.0, 0.0, 0.0, out)
        return CAME_TO_REST, np.nan, 0.0
    if not kappa * abs(V0) < HIGHEST:
        return NOT_COVERED, np.nan, np.nan
    frame = 1.0 if omega0 >= V0 else -1.0
    V, omega = frame * V0, frame * omega0
    at, first = 0, FULL_SLIP
    T, X, limit = full_slip_integrals(V, level, flow)
    starts_in_full_slip = omega - V >= limit
    if starts_in_full_slip:
        slide, stick, covered = _start_in_full_slip(frame, V, omega, (T, X), level, flow)
    else:
        stick, asymptote, covered = _start_in_partial_slip(V0, omega0, limit / abs(V), level, flow)
        first = PARTIAL_SLIP
    if not covered or stick.v < 2.0 * kappa * request.rest:
        return NOT_COVERED, np.nan, np.nan
    while at < tau_out.size and tau_out[at] == 0.0:
        _write_output(out, at, Output(V0, omega0, 0.0, 0.0, (omega0 - V0) / V0 if V0 != 0.0 else np.inf, first, 0.0))
        at += 1
    onset = np.nan
    if starts_in_full_slip:
        at = _write_full_slip(at, tau_out, stick.tau, slide, level, flow, out)
        if tau_out[tau_out.size - 1] < stick.tau:
            return COMPLETED, np.nan, np.nan
        onset = stick.tau
        asymptote = read_asymptote(stick.family, stick.v, level, flow)
    status, rest_time = _follow_partial_slip(at, tau_out, stick, asymptote, request, flow, out)
    return status, onset, rest_time


@kernel(allocates=True)
def look_up_motions(flow, motions, result, start, stop):
    """Look up some motions in the flow map and write their outputs; motions outside the map get the status NOT_COVERED.

    flow : Flow, of the scene.
    motions : :class:`.records.Motions` of all n motions: gamma; rest threshold, 0 for none; initial speeds V0, omega0,
        of length 1 or n; output times t, ascending, >= 0, (times,), at least one; requested rows of an output, int,
        (q,).
    result : arrays of :class:`viscoroll.motion.flow.FlowResult`, of which the entries of these motions are written:
        out, (q, n, times); status, (n,), COMPLETED (0), CAME_TO_REST (1) or NOT_COVERED (-1); onset and rest, (n,),
        times t of the onset of partial slip and of coming to rest, NaN where there is none up to the last output time;
        switches, (n,), 1 with an onset, else 0.
    start, stop : int, index of the first motion and of the one after the last.

    Distance and angle are written as x and angle, divided by gamma.  The rolling loss is the loss of kinetic energy
    since the start less the slip loss.  Entries of a motion that is not covered have no meaning, apart from its status.
    Returns nothing.
    """
    gamma, rest, V0, omega0, t, rows = motions
    one, tau, j = np.empty((ROWS, t.size)), t * gamma, flow.j
    level = SPEEDS
    for n in range(rows.size):
        level = max(level, PATH if rows[n] == _X or rows[n] == _ANGLE else LOSS if rows[n] >= SLIP_LOSS else SPEEDS)
    request = Request(level, rest, slow_log_at_rest(rest, flow) if rest > 0.0 else 0.0)
    for i in range(start, stop):
        V, omega = element(V0, i), element(omega0, i)
        result.status[i], onset, rest_time = look_up_motion(V, omega, tau, request, flow, one)
        if level >= LOSS:
            for m in range(t.size):
                V_now, omega_now = one[_V, m], one[_OMEGA, m]
                lost = 0.5 * ((V - V_now) * (V + V_now) + j * (omega - omega_now) * (omega + omega_now))
                one[ROLLING_LOSS, m] = lost - one[SLIP_LOSS, m]
        result.onset[i], result.rest[i] = onset / gamma, rest_time / gamma
        result.switches[i] = 1 if onset >= 0.0 else 0
        for n in range(rows.size):
            row = rows[n]
            scale = 1.0 / gamma if row == _X or row == _ANGLE else 1.0
            for m in range(t.size):
                result.out[n, i, m] = one[row, m] * scale
