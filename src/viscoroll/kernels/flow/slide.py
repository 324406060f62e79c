"""Flow map, full slip: V' = mu - M(V)/2 stands alone, so time, distance and onset are
functions of V; omega > V throughout, V of either sign.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..free.full_slip import sliding_rate, stick_limit
from . import layout
from .fit import BINS, HALF, N, bin_of, find, fit_column, integrate_bin, node, value, width

_LOW = layout.LOW
_T, _X, _I, _L = layout.T, layout.X, layout.I, layout.L


@kernel(allocates=True)
def slide_table(sign, scene, table):
    """Fill ``slide_up`` (sign = 1) or ``slide_down`` (-1); False where V' is not positive or I not monotone."""
    _, kappa, mu, j = scene
    V_low = 2.0**_LOW / kappa
    T, X, last_I = V_low / mu, 0.5 * V_low * V_low / mu, 0.0
    time, path, rows = np.empty(N), np.empty(N), np.empty((4, N))
    for b in range(table.shape[0]):
        if b == (layout.HIGH - 2 - layout.LOW) * BINS and not kappa * mu * T < 2.0 ** (layout.HIGH - 1):
            return False  # nearly held: ``time_up`` would end before the speeds that are served
        half = 0.5 * width(b, _LOW) / kappa
        for n in range(N):
            V = node(b, n, _LOW) / kappa
            acceleration = sliding_rate(sign * V, 1.0, scene)
            if not acceleration > 0.0:
                return False
            time[n] = half / acceleration
            path[n] = V * time[n]
        T, X = integrate_bin(time, T, rows[_T]), integrate_bin(path, X, rows[_X])
        for n in range(N):
            V = node(b, n, _LOW) / kappa
            rows[_L, n], _, _ = stick_limit(V, scene)
            rows[_I, n] = 2.0 * mu * rows[_T, n] - V * (1.0 - j) + sign * j * rows[_L, n]
            if not rows[_I, n] > last_I:
                return False
            last_I = rows[_I, n]
        for column in range(4):
            fit_column(table, b, column, rows[column])
    return True


@kernel(allocates=True)
def time_table(slide, scene, table):
    """Fill ``time_up`` or ``time_down``: V as a function of T."""
    _, kappa, mu, _ = scene
    values = np.empty(N)
    for b in range(table.shape[0]):
        for n in range(N):
            v, _ = find(slide, _T, node(b, n, _LOW) / (kappa * mu), _LOW)
            values[n] = v / kappa
        fit_column(table, b, 0, values)


@kernel(allocates=True)
def onset_table(slide, scene, table):
    """Fill ``onset_up`` or ``onset_down``: V, T and X at onset as functions of I."""
    _, kappa, mu, j = scene
    rows = np.empty((3, N))
    for b in range(table.shape[0]):
        for n in range(N):
            v, _ = find(slide, _I, node(b, n, _LOW) * (1.0 + j) / kappa, _LOW)
            rows[layout.ONSET_V, n] = v / kappa
            at, t = bin_of(v, _LOW)
            if at < 0:
                rows[layout.ONSET_T, n], rows[layout.ONSET_X, n] = v / (kappa * mu), 0.5 * v * v / (kappa**2 * mu)
                continue
            if at >= slide.shape[0]:
                at, t = slide.shape[0] - 1, HALF
            rows[layout.ONSET_T, n] = value(slide, at, _T, t)
            rows[layout.ONSET_X, n] = value(slide, at, _X, t)
        for column in range(3):
            fit_column(table, b, column, rows[column])
