"""Flow map, boundary layer: the motion behind stick onset, by its speed there and the stiff time.

Three families of motions: those that enter the stick zone with omega > V or omega < V, and
those that start from delta = 0, where the law bends (Q has a corner in its second slope).
Within a family the law keeps the sign of delta, so its motions are smooth in both variables;
one that reaches delta = 0 changes families there.  Each is integrated once, by the explicit
method of order 8 of Dormand and Prince (Hairer, Norsett, Wanner, Solving Ordinary
Differential Equations I, 2nd ed., Sect. II.5), in steps that end on the nodes of the table;
stiffness does not hurt where the stiff time itself is resolved.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import contact_length
from ..law.material import generator_slopes
from ..motion import dop853
from ..motion.partial_slip import branch_rates
from ..numerics.arrays import copy, fill
from ..numerics.bracket import narrowed, secant
from ..numerics.nodes import Interpolation, chebyshev
from . import layout
from .fit import BINS, N, bin_of, node, put, value
from .read import slow_entry, slow_loss, slow_path

_LONGEST = 0.5
_SPEED_N, _FAST_N = layout.SPEED_COEFFICIENTS, layout.FAST_COEFFICIENTS
_SPEED, _FAST = Interpolation(chebyshev(_SPEED_N)), Interpolation(chebyshev(_FAST_N))
_SPEED_NODES, _FAST_NODES = _SPEED.nodes, _FAST.nodes
_SPEED_FIT, _FAST_FIT_OCTAVE, _FAST_FIT_HALF = _SPEED.powers(0.5), _FAST.powers(0.5), _FAST.powers(0.25)
#: columns of a layer's table
LN_V, SLIP, X_EXCESS, ANGLE_EXCESS, LOSS = range(layout.LAYER_COLUMNS)
_WHOLE = layout.ENTRY_COLUMNS - 1


@kernel
def _fast_node(b, n, low):
    """E at node n of bin b."""
    x = _FAST_NODES[n]
    if b == 0:
        return (0.5 + 0.5 * x) * 2.0**low
    if b < 1 - low:
        return (1.5 + 0.5 * x) * 2.0 ** (low + b - 1)
    part = b - (1 - low)
    return (1.25 + 0.5 * (part % 2) + 0.25 * x) * 2.0 ** (part // 2)


@kernel
def stiff_rate(V, scene):
    """k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes."""
    material, kappa, _, j = scene
    lam, _ = contact_length(kappa * V, material)
    zeta = lam / (2.0 * kappa * V)
    _, h, dg, dh = generator_slopes(zeta, material)
    return (1.0 + 1.0 / j) * 4.0 * kappa * lam * (1.0 + h / zeta + dh) / ((1.0 + dg) * V)


@kernel
def _advance(u, h, sign, V0, per_E, scene, K, new):
    """One step of length h in E of (y, D, x excess, angle excess, slip loss over V0^2)."""
    for i in range(dop853.STAGES):
        y, D = u[0], u[1]
        for n in range(i):
            y += h * dop853.A[i, n] * K[n, 0]
            D += h * dop853.A[i, n] * K[n, 1]
        dy, dD, V, delta, q_over_V = branch_rates(y, D, sign, scene)
        K[i, 0], K[i, 1] = dy * per_E, dD * per_E
        K[i, 2], K[i, 3] = V / V0 - 1.0, V * (1.0 + delta) / V0 - 1.0
        K[i, 4] = delta * V * V * q_over_V * per_E / (V0 * V0)
    for m in range(5):
        new[m] = u[m]
        for n in range(dop853.STAGES):
            new[m] += h * dop853.B[n] * K[n, m]


@kernel
def _crossing(u, h, sign, V0, per_E, scene, K, new):
    """Length of the step from u, before delta = 0, that ends there (Illinois); fills ``new``."""
    low, high, at_low, at_high, side = 0.0, h, sign * u[1], sign * new[1], 0
    for _ in range(60):
        if high - low <= 1e-15 * high or at_high == 0.0:
            break
        middle = secant(low, high, at_low, at_high)
        _advance(u, middle, sign, V0, per_E, scene, K, new)
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, middle, sign * new[1])
    _advance(u, high, sign, V0, per_E, scene, K, new)
    return high


@kernel(allocates=True)
def _roll(V0, entering, sign, low, scene, values, crossing):
    """One motion from V0: ``values[bin, column, node]``, state at the end, and at delta = 0.

    ``entering``: from the edge of the stick zone, else from delta = 0.  ``crossing`` receives
    (E, ln V/V0, x excess, angle excess, slip loss over V0^2) at delta = 0, E = -1 if it is not
    reached.  Returns (E, V, x excess, angle excess, slip loss over V0^2) at the end, V = -1 on failure.
    """
    rate = stiff_rate(V0, scene)
    lam, _ = contact_length(scene.kappa * V0, scene.material)
    zeta = lam / (2.0 * scene.kappa * V0)
    u, new, trial, K = np.zeros(5), np.zeros(5), np.zeros(5), np.empty((dop853.STAGES, 5))
    u[0], u[1] = np.log(zeta), sign * zeta if entering else 0.0
    crossing[0], E = -1.0, 0.0
    bend = 0.25 / (scene.material.alpha * zeta)  # the law bends where the stick zone is as small as eta = 1/alpha
    for b in range(values.shape[0]):
        for n in range(_FAST_N):
            target = _fast_node(b, n, low)
            while E < target:
                h = min(target - E, _LONGEST, max(E, bend) if entering else _LONGEST)
                _advance(u, h, sign, V0, 1.0 / rate, scene, K, new)
                if entering and crossing[0] < 0.0 and sign * new[1] <= 0.0:
                    copy(new, trial)
                    crossing[0] = E + _crossing(u, h, sign, V0, 1.0 / rate, scene, K, trial)
                    crossing[1] = np.log(branch_rates(trial[0], 0.0, sign, scene)[2] / V0)
                    copy(trial[2:], crossing[2:])
                copy(new, u)
                E = target if h == target - E else E + h
            _, _, V, delta, _ = branch_rates(u[0], u[1], sign, scene)
            if not np.exp(u[0]) > sign * u[1]:
                return E, -1.0, u[2], u[3], u[4]
            values[b, LN_V, n], values[b, SLIP, n] = np.log(V / V0), delta
            values[b, X_EXCESS, n], values[b, ANGLE_EXCESS, n], values[b, LOSS, n] = u[2], u[3], u[4]
    return E, V, u[2], u[3], u[4]


@kernel(allocates=True)
def layer_octave(top, octave, entering, sign, crosses, cross, scene, table, layer, entry):
    """Fill one octave of an ``entry`` table and of its layer's; False if it cannot be served.

    ``top``: kappa V < 2**top in the table.  ``crosses``: the motions pass delta = 0 and go on
    as those of the entry table ``cross``, whose first octave lies CROSS_MARGIN lower.
    """
    low = 0 if not entering else layout.E_LOW
    first = top - entry.shape[0] // BINS
    values = np.empty((_SPEED_N, layer.shape[1], layout.LAYER_COLUMNS, _FAST_N))
    whole, crossing = np.empty((_WHOLE, _SPEED_N)), np.empty(5)
    for i in range(_SPEED_N):
        v = (1.5 + 0.5 * _SPEED_NODES[i]) * 2.0 ** (first + octave)
        E, V, x, angle, loss = _roll(v / scene.kappa, entering, sign, low, scene, values[i], crossing)
        if not V > 0.0:
            return False
        if crosses:
            served = _join_crossing(v, crossing, first, cross, scene, table, whole[:, i])
        else:
            served = not 0.0 <= crossing[0] < layout.LAYER_END
            _join_slow(v, E, V, x, angle, loss, scene, table, whole[:, i])
        if not served:
            return False
    lowest = entry.shape[0] // BINS - layer.shape[0]
    if octave >= lowest:
        _fit_layer(values, low, layer[octave - lowest])
    _fit_entry(whole, first, octave, crosses, scene, table, entry)
    return True


@kernel(allocates=True)
def _join_slow(v, E, V, x, angle, loss, scene, table, whole):
    """What a motion that ends on the slow manifold has in common with it, into ``whole``."""
    rate, slow_rate = stiff_rate(v / scene.kappa, scene), scene.material.c / (1.0 + scene.j)
    lam_end = slow_entry(scene.kappa * V, table)[0]
    lam = lam_end + slow_rate * E / rate
    slow_x, slow_angle = slow_path(lam, lam_end, slow_rate, table)
    V0 = v / scene.kappa
    scale = V0 / rate
    whole[0] = lam - slow_entry(v, table)[0]
    whole[1], whole[2] = scale * (E + x) - slow_x, scale * (E + angle) - slow_angle
    whole[3] = V0 * V0 * loss - (slow_loss(lam, table) - slow_loss(lam_end, table))
    fill(0.0, whole[4:])


@kernel
def _join_crossing(v, crossing, first, cross, scene, table, whole):
    """The same for one that goes on as a motion from delta = 0; False where that is not tabulated."""
    rate, slow_rate = stiff_rate(v / scene.kappa, scene), scene.material.c / (1.0 + scene.j)
    E, ratio, x, angle, loss = crossing
    at, t = bin_of(v * np.exp(ratio), first - layout.CROSS_MARGIN)
    if not (E > 0.0 and 0 <= at < cross.shape[0]):
        return False
    lam_there = value(cross, at, layout.ENTRY_LAMBDA, t)
    lam = lam_there + slow_rate * E / rate
    slow_x, slow_angle = slow_path(lam, lam_there, slow_rate, table)
    V0 = v / scene.kappa
    scale = V0 / rate
    whole[0] = lam - slow_entry(v, table)[0]
    whole[4], whole[5] = E, ratio
    whole[6], whole[7], whole[8] = scale * (E + x), scale * (E + angle), V0 * V0 * loss
    whole[1] = whole[6] + value(cross, at, layout.ENTRY_X, t) - slow_x
    whole[2] = whole[7] + value(cross, at, layout.ENTRY_ANGLE, t) - slow_angle
    gone = slow_loss(lam, table) - slow_loss(lam_there, table)
    whole[3] = whole[8] + value(cross, at, layout.ENTRY_LOSS, t) - gone
    return True


@kernel(allocates=True)
def _fit_layer(values, low, table):
    """Coefficients table[bin, column, speed, E] from values[speed, bin, column, E]."""
    half = np.empty((_SPEED_N, _FAST_N))
    for b in range(values.shape[1]):
        fit = _FAST_FIT_OCTAVE if b < 1 - low else _FAST_FIT_HALF
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
def _fit_entry(whole, first, octave, crosses, scene, table, entry):
    """Entry columns on the finer bins, and what they are known to be differences from."""
    rows, fine = np.empty((layout.ENTRY_COLUMNS, N)), np.empty(_WHOLE)
    for part in range(BINS):
        b = octave * BINS + part
        for n in range(N):
            v = node(b, n, first)
            t = v * 2.0 ** -(first + octave) - 1.5
            for row in range(_WHOLE):
                fine[row] = 0.0
                for k in range(_SPEED_N - 1, -1, -1):
                    coefficient = 0.0
                    for i in range(_SPEED_N):
                        coefficient += _SPEED_FIT[k, i] * whole[row, i]
                    fine[row] = coefficient + t * fine[row]
            rows[layout.ENTRY_LAMBDA, n] = fine[0] + slow_entry(v, table)[0]
            rows[layout.ENTRY_X, n], rows[layout.ENTRY_ANGLE, n], rows[layout.ENTRY_LOSS, n] = fine[1], fine[2], fine[3]
            rows[layout.RATE, n] = stiff_rate(v / scene.kappa, scene)
            copy(fine[4:], rows[layout.CROSSING :, n])
        for column in range(layout.ENTRY_COLUMNS):
            put(entry, b, column, rows[column])
        if not crosses:
            for column in range(layout.CROSSING, layout.ENTRY_COLUMNS):
                fill(0.0, entry[b, column])
            entry[b, layout.CROSSING, 0] = np.inf
