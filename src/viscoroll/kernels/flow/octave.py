"""Flow map, boundary layer: an octave of V at entry, from motions at Chebyshev's nodes.

Each is rolled once through its layer (:mod:`layer`).  Where it ends, or where it passes delta = 0 and goes
on as a motion that started there, it has a lambda: that gives what it has in common with the slow manifold.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.nodes import Interpolation, chebyshev
from . import layout
from .fit import BINS, N, fit_column, node
from .layer import FAST, Onset, layer_motion, stiff_rate
from .read import CROSS, LOSS, MINUS, entry_state, manifold_entry, manifold_loss, manifold_path

_SPEED_N, _FAST_N = layout.SPEED_COEFFICIENTS, layout.FAST_COEFFICIENTS
_SPEED = Interpolation(chebyshev(_SPEED_N))
_SPEED_NODES, _SPEED_FIT = _SPEED.nodes, _SPEED.powers(0.5)
_FAST_FIT_OCTAVE, _FAST_FIT_HALF = FAST.powers(0.5), FAST.powers(0.25)
#: columns of an entry that motions give; the stiff rate is a function of V alone
_WHOLE = layout.RATE


@kernel(allocates=True)
def layer_octave(family, octave, flow, layer, entry):
    """Fill one octave of the entries of a family and of their layer; False if it cannot be served."""
    lowest = flow.first - layout.CROSS_MARGIN if family == CROSS else flow.first
    far = np.sign(1.0 - flow.scene.j)  # the sign of the creep that turns on its way to the slow manifold
    sign = -far if family == CROSS else -1.0 if family == MINUS else 1.0
    turns = family != CROSS and sign == far
    values, whole = np.empty((_SPEED_N, layer.shape[1], layout.LAYER_COLUMNS, _FAST_N)), np.zeros((_WHOLE, _SPEED_N))
    for i in range(_SPEED_N):
        V = (1.5 + 0.5 * _SPEED_NODES[i]) * 2.0 ** (lowest + octave) / flow.scene.kappa
        onset = Onset(V, family != CROSS, sign, stiff_rate(V, flow.scene), flow.scene)
        if not _served(onset, turns, flow, values[i], whole[:, i]):
            return False
    skipped = entry.shape[0] // BINS - layer.shape[0]
    if octave >= skipped:
        _fit_layer(values, family, layer[octave - skipped])
    _fit_entry(whole, lowest + octave, flow, entry[octave * BINS : (octave + 1) * BINS])
    if not turns:
        for b in range(octave * BINS, (octave + 1) * BINS):
            entry[b, layout.CROSSING, 0] = np.inf
    return True


@kernel
def _served(onset, turns, flow, values, whole):
    """Roll one motion, which ``turns`` where it passes delta = 0, and join it to the slow manifold."""
    v = flow.scene.kappa * onset.V
    lasts, crossing, end = layer_motion(onset, values)
    if not lasts:
        return False
    if not turns:
        _join(onset, end, manifold_entry(v * np.exp(end.ln_V), flow.table), flow.table, whole)
        # with j = 1 the slow manifold is delta = 0, which a motion passes by rounding alone
        return onset.scene.j == 1.0 or not 0.0 <= crossing.E < layout.LAYER_END
    lowest, octaves = 2.0 ** (flow.first - layout.CROSS_MARGIN), layout.ENTRY_OCTAVES + 2 * layout.CROSS_MARGIN
    there = v * np.exp(crossing.ln_V)
    if not (crossing.E > 0.0 and lowest <= there < lowest * 2.0**octaves):
        return False
    _join(onset, crossing, entry_state(CROSS, there, LOSS, flow), flow.table, whole)
    whole[layout.CROSSING], whole[layout.CROSSING_SPEED] = crossing.E, crossing.ln_V
    whole[layout.CROSSING_X], whole[layout.CROSSING_ANGLE], whole[layout.CROSSING_LOSS] = _gained(onset, crossing)
    return True


@kernel
def _gained(onset, reached):
    """(Distance, angle, slip loss) since the entry."""
    scale = onset.V / onset.rate
    return scale * (reached.E + reached.x), scale * (reached.E + reached.angle), onset.V * onset.V * reached.loss


@kernel
def _join(onset, reached, there, table, whole):
    """What a motion has in common with the slow manifold, from ``there``, the same where it goes on."""
    slow_rate = onset.scene.material.T_mean / (1.0 + onset.scene.j)
    lam = there.lam + slow_rate * reached.E / onset.rate
    x, angle, loss = _gained(onset, reached)
    slow_x, slow_angle = manifold_path(lam, there.lam, slow_rate, table)
    whole[layout.ENTRY_LAMBDA] = lam - manifold_entry(onset.scene.kappa * onset.V, table).lam
    whole[layout.ENTRY_X], whole[layout.ENTRY_ANGLE] = x + there.x - slow_x, angle + there.angle - slow_angle
    whole[layout.ENTRY_LOSS] = loss + there.loss - (manifold_loss(lam, table) - manifold_loss(there.lam, table))


@kernel(allocates=True)
def _fit_layer(values, family, table):
    """Coefficients table[bin, column, speed, E] from values[speed, bin, column, E]."""
    halves = 1 if family == CROSS else 1 - layout.E_LOW  # the first bin of half an octave
    half = np.empty((_SPEED_N, _FAST_N))
    for b in range(values.shape[1]):
        fit = _FAST_FIT_OCTAVE if b < halves else _FAST_FIT_HALF
        for column in range(layout.LAYER_COLUMNS):
            for i in range(_SPEED_N):
                for m in range(_FAST_N):
                    half[i, m] = 0.0
                    for n in range(_FAST_N):
                        half[i, m] += fit[m, n] * values[i, b, column, n]
            for k in range(_SPEED_N):
                for m in range(_FAST_N):
                    total = 0.0
                    for i in range(_SPEED_N):
                        total += _SPEED_FIT[k, i] * half[i, m]
                    table[b, column, k, m] = total


@kernel(allocates=True)
def _fit_entry(whole, octave, flow, entry):
    """Entries on the finer bins of an octave, and what they are known to be differences from."""
    terms, rows = np.zeros((_WHOLE, _SPEED_N)), np.empty((layout.ENTRY_COLUMNS, N))
    for row in range(_WHOLE):
        for k in range(_SPEED_N):
            for i in range(_SPEED_N):
                terms[row, k] += _SPEED_FIT[k, i] * whole[row, i]
    for b in range(BINS):
        for n in range(N):
            v = node(b, n, octave)
            t = v * 2.0**-octave - 1.5
            for row in range(_WHOLE):
                rows[row, n] = 0.0
                for k in range(_SPEED_N - 1, -1, -1):
                    rows[row, n] = terms[row, k] + t * rows[row, n]
            rows[layout.ENTRY_LAMBDA, n] += manifold_entry(v, flow.table).lam
            rows[layout.RATE, n] = stiff_rate(v / flow.scene.kappa, flow.scene)
        for column in range(layout.ENTRY_COLUMNS):
            fit_column(entry, b, column, rows[column])
