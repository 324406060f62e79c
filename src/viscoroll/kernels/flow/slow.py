"""Flow map, slow manifold: the one motion in partial slip that all others come to follow.

It is solved for from high to low V as for a single motion (:mod:`motion.slow`), on a panel a bin where that
converges: the boundary layer of an inexact start is gone within a few bins, so the motion found is the
manifold.  Time, distance and angle along it are integrals.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..free.collocation import INNER_POWERS, SLOPES
from ..free.collocation import N as PANEL_N
from ..free.partial_slip import branch_rates
from ..free.slow import NODE_D, slow_go_on, slow_solve, slow_start, workspace
from ..law.length import contact_length
from . import layout
from .fit import BINS, HALF, NODES, N, bin_of, find, fit_column, integrate_bin, node, value, width
from .layout import ANGLE_TO_GO, DELTA, LAMBDA, LOSS_TO_GO, SPEED, X_TO_GO

_LOW = layout.LOW
#: extra octaves above the table in which the start is forgotten; remaining error of a panel, and the shortest
_EXTRA, _CONVERGED, _SHORTEST = 2, 1e-12, 1e-3


@kernel
def _ln_zeta(v, material):
    """y at v = kappa V."""
    return np.log(contact_length(v, material)[0] / (2.0 * v))


@kernel(allocates=True)
def slow_table(scene, table):
    """Fill ``slow``; False where there is no such motion within the stick zone."""
    bins = table.shape[0]
    work, powers = workspace(), np.empty(PANEL_N)
    columns = np.empty((bins, DELTA + 1, N))
    last = bins + _EXTRA * BINS
    y = _ln_zeta(2.0 ** (last // BINS + _LOW), scene.material)
    slow_start(y, 0.0, work.values, scene)
    for b in range(last - 1, -1, -1):
        end, n = _ln_zeta(node(b, 0, _LOW), scene.material), N - 1
        while y < end:
            length = end - y
            while not slow_solve(y, length, _CONVERGED, SLOPES, scene, work):
                length *= 0.5
                if not length > _SHORTEST:
                    return False
            _D_powers(work.values, powers)
            y_after = y + length if y + length < end else end
            while b < bins and n >= 0 and _ln_zeta(node(b, n, _LOW), scene.material) <= y_after:
                if not _slow_node(b, n, y, length, powers, scene, columns[b]):
                    return False
                n -= 1
            slow_go_on(work.values)
            y = y_after
    _integrate(columns, table)
    return True


@kernel
def _D_powers(values, powers):
    """Coefficients of D over a panel."""
    for k in range(PANEL_N):
        powers[k] = 0.0
        for i in range(PANEL_N):
            powers[k] += INNER_POWERS[k, i] * values[i + 1, NODE_D]


@kernel
def _slow_node(b, n, y, length, powers, scene, columns):
    """Delta at a node of a bin, and the slopes of the other columns; whether V falls and the stick zone lasts."""
    v = node(b, n, _LOW)
    y_there, D = _ln_zeta(v, scene.material), 0.0
    t = 2.0 * (y_there - y) / length - 1.0
    for k in range(PANEL_N - 1, -1, -1):
        D = powers[k] + t * D
    _, _, V, delta, rate, _, _, _, q_over_V = branch_rates(y_there, D, np.sign(D), scene)
    pace = -0.5 * width(b, _LOW) / (v * rate)
    columns[LAMBDA, n], columns[DELTA, n] = scene.material.T_mean / (1.0 + scene.j) * pace, delta
    columns[X_TO_GO, n], columns[ANGLE_TO_GO, n] = V * pace, V * (1.0 + delta) * pace
    columns[LOSS_TO_GO, n] = V * delta * V * q_over_V * pace
    return rate < 0.0 and abs(D) < np.exp(y_there)


@kernel(allocates=True)
def _integrate(columns, table):
    """Lambda, distance, angle and slip loss to go by integration upward from V -> 0, where V falls like exp(lambda)."""
    zero = BINS * (-2 - _LOW)  # the bin that starts at kappa V = 1/4
    rows, ends = np.empty((DELTA + 1, N)), np.zeros(DELTA)
    for column in range(DELTA):
        ends[column] = columns[0, column, 0] / columns[0, LAMBDA, 0]
    ends[LAMBDA] = 0.0
    ends[LOSS_TO_GO] /= 3.0
    start = 0.0
    for b in range(table.shape[0]):
        if b == zero:
            start = ends[LAMBDA]
        for column in range(DELTA):
            ends[column] = integrate_bin(columns[b, column], ends[column], rows[column])
            fit_column(table, b, column, rows[column])
        fit_column(table, b, DELTA, columns[b, DELTA])
    for b in range(table.shape[0]):
        table[b, LAMBDA, 0] -= start


@kernel
def _by_lambda(slow, lam, kappa, n, rows):
    """V, delta, distance, angle and slip loss to go at lambda into rows[:, n]."""
    bottom = value(slow, 0, LAMBDA, -HALF)
    at, t, share = 0, -HALF, 1.0
    if lam < bottom:
        share = np.exp(lam - bottom)
        v = share * 2.0**_LOW
    else:
        v, _ = find(slow, LAMBDA, lam, _LOW)
        at, t = bin_of(v, _LOW)
        if at >= slow.shape[0]:
            at, t = slow.shape[0] - 1, HALF
    for column in range(DELTA + 1):
        rows[column, n] = share * value(slow, at, column, t)
    rows[SPEED, n] = v / kappa
    rows[LOSS_TO_GO, n] *= share * share


@kernel(allocates=True)
def lambda_table(slow, kappa, late, table):
    """Fill ``late`` or ``early``."""
    rows = np.empty((DELTA + 1, N))
    for b in range(table.shape[0]):
        for n in range(N):
            lam = layout.LATE_LOW + (b + 0.5 + 0.5 * NODES[n]) * layout.LATE_WIDTH if late else node(b, n, 0) - 1.0
            _by_lambda(slow, lam, kappa, n, rows)
        for column in range(DELTA + 1):
            fit_column(table, b, column, rows[column])
