"""Flow map, slow manifold: the one motion in partial slip that all others come to follow.

The second unknown of :mod:`motion.partial_slip` is solved for on it by collocation (Radau's rule,
from high to low V, bin by bin): the boundary layer of an inexact start is gone within a
bin, so the motion found is the manifold.  Time, distance and angle along it are integrals.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import contact_length
from ..law.material import at_contact
from ..motion.partial_slip import partial_jacobian, partial_rhs, partial_speeds
from ..numerics.arrays import fill
from ..numerics.linear import eliminate
from . import layout
from .fit import BINS, DERIVATIVE, HALF, NODES, TO_END, TO_NODES, N, bin_of, find, node, put, value, width

_LOW = layout.LOW
#: Newton iterations of a bin; extra octaves above the table in which the start is forgotten
_ITERATIONS, EXTRA = 12, 2


@kernel
def _relative_rate(y, dy, scene):
    """V'/V from y' at y = ln zeta: y' = -2 H/(zeta H') V'/V."""
    zeta = np.exp(y)
    _, h, _, dh, _, _, _, _ = at_contact(zeta, scene.material)
    return -dy * (1.0 + h / zeta + dh) / (1.0 + 2.0 * h / zeta)


@kernel(allocates=True)
def _collocate(v, y, half, offset_end, offset, scene):
    """Solve for ``offset`` at the nodes v of a bin, given its value at the right end; False if it fails."""
    f, slope = np.empty(N), np.empty(N)
    matrix, residual = np.empty((N, N)), np.empty(N)
    fill(offset_end, offset)
    last = np.inf
    for _ in range(_ITERATIONS):
        for n in range(N):
            dy, doffset, _, _ = partial_rhs(y[n], offset[n], scene)
            J = partial_jacobian(y[n], offset[n], scene)
            pace = half / (v[n] * _relative_rate(y[n], dy, scene))
            f[n] = doffset * pace
            slope[n] = (J[3] - doffset * J[1] / dy) * pace
            if not abs(f[n]) + abs(slope[n]) < 1e300:
                return False
        for n in range(N):
            # divided by the size of the stiff term: the rows are then of order 1 in offset
            scale = 1.0 / (abs(slope[n]) + 1.0)
            total = DERIVATIVE[n, 0] * offset_end
            for m in range(N):
                total += DERIVATIVE[n, m + 1] * offset[m]
                matrix[n, m] = DERIVATIVE[n, m + 1] * scale
            matrix[n, n] -= slope[n] * scale
            residual[n] = (f[n] - total) * scale
        eliminate(matrix, residual)
        worst = 0.0
        for n in range(N):
            offset[n] += residual[n]
            worst = max(worst, abs(residual[n]) * np.exp(-y[n]))
        if not worst < 1e300:
            return False
        if worst < 1e-14 or (worst < 1e-11 and worst > 0.5 * last):
            return True
        last = worst
    return False


@kernel(allocates=True)
def slow_table(scene, table):
    """Fill ``slow``; False where there is no such motion within the stick zone."""
    material, _, _, j = scene
    c = material.c
    rate = c / (1.0 + j)
    bins = table.shape[0]
    v, y, offset, V = np.empty(N), np.empty(N), np.empty(N), np.empty((bins, N))
    pace, delta, power = np.empty((bins, N)), np.empty((bins, N)), np.empty((bins, N))
    end = 0.0
    for b in range(bins + EXTRA * BINS - 1, -1, -1):
        for n in range(N):
            v[n] = node(b, n, _LOW)
            y[n] = np.log(contact_length(v[n], scene.material)[0] / (2.0 * v[n]))
        half = 0.5 * width(b, _LOW)
        if not _collocate(v, y, half, end, offset, scene):
            return False
        end = offset[0]
        if b >= bins:
            continue
        for n in range(N):
            dy, _, _, _ = partial_rhs(y[n], offset[n], scene)
            fall = -_relative_rate(y[n], dy, scene)
            V[b, n], delta[b, n] = partial_speeds(y[n], offset[n], scene)
            if not (fall > 0.0 and abs(delta[b, n]) < _stick_bound(y[n], scene)):
                return False
            pace[b, n] = half / (v[n] * fall)
            # Q = V' + M/2
            m = at_contact(np.exp(y[n]), scene.material)[6]
            power[b, n] = V[b, n] * delta[b, n] * V[b, n] * (0.5 * m - fall)
    _integrals(rate, V, delta, power, pace, table)
    return True


@kernel
def _stick_bound(y, scene):
    """delta_star at y = ln zeta."""
    zeta = np.exp(y)
    g, h, _, _, _, _, _, _ = at_contact(zeta, scene.material)
    V = 1.0 / (np.sqrt(1.0 + 2.0 * h / zeta) * 2.0 * scene.kappa * zeta)
    return scene.mu * V * (zeta + g)


@kernel(allocates=True)
def _integrals(rate, V, delta, power, pace, table):
    """Lambda, distance, angle and slip loss to go by integration of dtau = pace dv upward from V -> 0."""
    zero = BINS * (-2 - _LOW)  # the bin that starts at kappa V = 1/4
    lowest = V[0, 0]
    ends = np.array([0.0, lowest / rate, lowest * (1.0 + delta[0, 0]) / rate, power[0, 0] / (3.0 * rate)])
    rows = np.empty((5, N))
    start = 0.0
    for b in range(table.shape[0]):
        if b == zero:
            start = ends[0]
        for n in range(N):
            rows[layout.DELTA, n] = delta[b, n]
            rows[layout.LAMBDA, n] = ends[0]
            rows[layout.X_TO_GO, n], rows[layout.ANGLE_TO_GO, n] = ends[1], ends[2]
            rows[layout.LOSS_TO_GO, n] = ends[3]
            for m in range(N):
                weight = TO_NODES[n, m] * pace[b, m]
                rows[layout.LAMBDA, n] += weight * rate
                rows[layout.X_TO_GO, n] += weight * V[b, m]
                rows[layout.ANGLE_TO_GO, n] += weight * V[b, m] * (1.0 + delta[b, m])
                rows[layout.LOSS_TO_GO, n] += weight * power[b, m]
        for m in range(N):
            weight = TO_END[m] * pace[b, m]
            ends[0] += weight * rate
            ends[1] += weight * V[b, m]
            ends[2] += weight * V[b, m] * (1.0 + delta[b, m])
            ends[3] += weight * power[b, m]
        for column in range(5):
            put(table, b, column, rows[column])
    for b in range(table.shape[0]):
        table[b, layout.LAMBDA, 0] -= start


@kernel
def _by_lambda(slow, lam, kappa, n, rows):
    """V, delta, distance, angle and slip loss to go at lambda into rows[:, n]."""
    bottom = value(slow, 0, layout.LAMBDA, -HALF)
    at, t, share = 0, -HALF, 1.0
    if lam < bottom:
        share = np.exp(lam - bottom)
        v = share * 2.0**_LOW
    else:
        v, _ = find(slow, layout.LAMBDA, lam, _LOW)
        at, t = bin_of(v, _LOW)
        if at >= slow.shape[0]:
            at, t = slow.shape[0] - 1, HALF
    rows[layout.SPEED, n] = v / kappa
    for column in range(1, 4):
        rows[column, n] = share * value(slow, at, column, t)
    rows[layout.LOSS_TO_GO, n] = share**3 * value(slow, at, layout.LOSS_TO_GO, t)


@kernel(allocates=True)
def late_table(slow, kappa, table):
    """Fill ``late``."""
    rows = np.empty((5, N))
    for b in range(table.shape[0]):
        for n in range(N):
            _by_lambda(slow, layout.LATE_LOW + (b + 0.5 + 0.5 * NODES[n]) * layout.LATE_WIDTH, kappa, n, rows)
        for column in range(5):
            put(table, b, column, rows[column])


@kernel(allocates=True)
def early_table(slow, kappa, table):
    """Fill ``early``."""
    rows = np.empty((5, N))
    for b in range(table.shape[0]):
        for n in range(N):
            _by_lambda(slow, node(b, n, 0) - 1.0, kappa, n, rows)
        for column in range(5):
            put(table, b, column, rows[column])
