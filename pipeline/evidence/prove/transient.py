"""Rolling that is not steady: a transient solver of the normal contact, of any Prony series.

Two like bodies in two dimensions, quasistatic, constant load, rolling without slip.  Lengths in half the contact length
at rest, times in T_ref, the load pi/2, the speed u = kappa V.  With Phi = G p, G the logarithmic kernel, and the creep
form of the series, J(t) = 1 - sum J_k exp(-t/T_k),

    w = Phi/alpha + sum J_k m_k,   T_k m_k' = Phi - m_k   at every point of the surface
    w = D - (X - Xc)^2/2 and p >= 0 in contact, the gap >= 0 outside, the integral of p is the load
    u' = -g kM,   Xc' = 2 u,   kM = kappa M = (mean X of the pressure - Xc)/2,   g = gamma/(1 + j)

A fine grid is fixed in the material, in a window that goes with the contact.  Ahead of it, where slow modes remember
the load from afar, coarse nodes carry the memory of a point load and its second moment.  Nothing of viscoroll enters.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg import toeplitz
from scipy.special import exp1

Array = NDArray[np.float64]

#: of the window behind and ahead of the axis, of the way of a run-in, and of the coarse nodes
BEHIND, AHEAD, RUN_IN, COARSE = 3.0, 6.0, 18.0, 0.5
#: half width of the contact that there is room for
_WIDEST = 1.2
#: steps of the contact's own swing
_SWING = 0.1


def kernel(h: float, count: int) -> Array:
    """Displacement by hats of pressure of width h, at distances 0, h, ...; a constant is free."""
    x = np.abs(np.arange(-1, count + 1) * h)
    twice = 0.5 * x * x * np.log(np.where(x == 0.0, 1.0, x)) - 0.75 * x * x
    second: Array = np.diff(twice, 2)
    return -second / (h * np.pi)


class Grid(NamedTuple):
    """The kernel at distances 0, h, ...; the inverse of its matrix over 1, 2, ... nodes; sums of the rows of these."""

    h: float
    g: Array
    inverses: Array
    rows: Array


def grid(h: float) -> Grid:
    """That of cells h."""
    g, most = kernel(h, round((BEHIND + AHEAD) / h)), round(2.0 * _WIDEST / h)
    inverses = np.zeros((most + 1, most, most))
    for n in range(1, most + 1):
        inverses[n, :n, :n] = np.linalg.inv(toeplitz(g[:n]))
    return Grid(h, g, inverses, inverses.sum(axis=2))


class Memory(NamedTuple):
    """Of the nodes of the window p, Phi and m_k, and of the coarse nodes, from ``start`` on, Phi and m_k."""

    p: Array
    phi: Array
    m: Array
    start: float
    far_phi: Array
    far_m: Array


@njit(cache=True)
def _pressure(grid, x0, compliance, history, low, high, p):
    """p on the nodes in contact, which are found from those of last time; x0: place of node 0 from the axis."""
    h, g, load = grid.h, grid.g, 0.5 * np.pi / grid.h
    r = np.empty(grid.rows.shape[1])
    for _ in range(1000):
        n, total = high - low, 0.0
        inverse, rows = grid.inverses[n], grid.rows[n]
        for i in range(n):
            r[i] = 0.0
            for k in range(n):
                x = x0 + (low + k) * h
                r[i] += inverse[i, k] * (0.5 * x * x + history[low + k])
            total += r[i]
        D = (compliance * load + total) / rows[:n].sum()
        for i in range(n):
            p[low + i] = (D * rows[i] - r[i]) / compliance
        if p[low] < 0.0 or p[high - 1] < 0.0:
            while p[low] < 0.0:
                p[low] = 0.0
                low += 1
            while p[high - 1] < 0.0:
                p[high - 1] = 0.0
                high -= 1
            continue
        behind = ahead = 0.0
        for k in range(low, high):
            behind += g[k - low + 1] * p[k]
            ahead += g[high - k] * p[k]
        xb, xa = x0 + (low - 1) * h, x0 + high * h
        behind = 0.5 * xb * xb + history[low - 1] + compliance * behind - D
        ahead = 0.5 * xa * xa + history[high] + compliance * ahead - D
        if behind >= 0.0 and ahead >= 0.0:
            return low, high
        low, high = low - (behind < 0.0), high + (ahead < 0.0)
    return -1, -1


@njit(cache=True, fastmath=True)
def _displacement(g, p, low, high, phi):
    for i in range(phi.size):
        total = 0.0
        for k in range(low, high):
            total += g[abs(i - k)] * p[k]
        phi[i] = total


@njit(cache=True)
def _centre(h, x0, p, low, high):
    """Mean place of the pressure from the axis, and its variance."""
    total = first = second = 0.0
    for k in range(low, high):
        x = x0 + k * h
        total += p[k]
        first += p[k] * x
        second += p[k] * x * x
    mean = first / total
    return mean, second / total - mean * mean


@njit(cache=True)
def _next_node(grid, memory, low, high, first):
    """Move the window by a cell: what enters lags as far as the coarse nodes do."""
    p, phi, m, W = memory.p, memory.phi, memory.m, memory.p.size
    p[:-1], phi[:-1] = p[1:].copy(), phi[1:].copy()
    p[-1] = phi[-1] = 0.0
    for k in range(low - 1, high - 1):
        phi[-1] += grid.g[W - 1 - k] * p[k]
    place = ((first + W) * grid.h - memory.start) / COARSE
    i = int(place)
    t = place - i
    for k in range(m.shape[0]):
        m[k, :-1] = m[k, 1:].copy()
        f = memory.far_m[k, i - 1 : i + 3] - memory.far_phi[i - 1 : i + 3]
        lag = -t * (t - 1.0) * (t - 2.0) / 6.0 * f[0] + (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 * f[1]
        m[k, -1] = phi[-1] + lag - (t + 1.0) * t * (t - 2.0) / 2.0 * f[2] + (t + 1.0) * t * (t - 1.0) / 6.0 * f[3]


@njit(cache=True)
def _remember(memory, weights, low, centre, variance):
    """The coarse nodes from ``low`` on, over a step."""
    kept, old, new = weights
    for i in range(low, memory.far_phi.size):
        D = max(memory.start + i * COARSE - centre, 1.0)
        phi = -0.5 * np.log(D) + 0.25 * variance / (D * D)
        for k in range(kept.size):
            memory.far_m[k, i] = kept[k] * memory.far_m[k, i] + old[k] * memory.far_phi[i] + new[k] * phi
        memory.far_phi[i] = phi


@njit(cache=True)
def _weights(dt, T):
    """Of m, of Phi before and of Phi after a step over which Phi is linear."""
    d = dt / T
    kept, mean = np.exp(-d), -np.expm1(-d) / d
    new = np.where(d > 1e-4, 1.0 - mean, 0.5 * d - d * d / 6.0)
    return kept, 1.0 - kept - new, new


@njit(cache=True)
def _rolled(grid, series, memory, where, u, g, ends, out):
    """Steps until u <= 0 and t >= the end of time, or to an end of the way; (steps, low, high, first, Xc, u)."""
    J, T, alpha = series
    first, low, high, Xc = where
    h, W, p, phi, m, t = grid.h, memory.p.size, memory.p, memory.phi, memory.m, 0.0
    t_end, X_end = ends
    history = np.empty(W)
    mean, variance = _centre(h, first * h - Xc, p, low, high)
    for step in range(out.shape[0]):
        out[step, 0], out[step, 1], out[step, 2] = t, Xc, u
        if t >= t_end or Xc >= X_end or low < 4:
            return step + 1, low, high, first, Xc, u
        pull, a = -0.5 * g * mean, 0.5 * (high - low) * h
        dt = min(_SWING / np.sqrt(g * max(alpha * a * a - 1.0, 0.05 * (alpha - 1.0))) if g > 0.0 else 1e30, t_end)
        v, faster = abs(u), pull if u >= 0.0 else -pull
        if 2.0 * v * dt + faster * dt * dt > h:
            dt = h / (v + np.sqrt(max(v * v + faster * h, 0.0)))
        Xc += 2.0 * u * dt + pull * dt * dt
        if round(Xc / h) - first - round(BEHIND / h) > 0:
            _next_node(grid, memory, low, high, first)
            first, low, high = first + 1, low - 1, high - 1
        weights = _weights(dt, T)
        kept, old, new = weights
        history[:] = 0.0
        for k in range(T.size):
            m[k] = kept[k] * m[k] + old[k] * phi
            history += J[k] * m[k]
        p[low:high] = 0.0
        x0 = first * h - Xc
        low, high = _pressure(grid, x0, 1.0 / alpha + (J * new).sum(), history, low, high, p)
        _displacement(grid.g, p, low, high, phi)
        for k in range(T.size):
            m[k] += new[k] * phi
        mean, variance = _centre(h, x0, p, low, high)
        u += 0.5 * dt * (pull - 0.5 * g * mean)
        t += dt
        _remember(memory, weights, int(((first + W) * h - memory.start) / COARSE) - 2, Xc + mean, variance)
    return out.shape[0], low, high, first, Xc, u


class Contact:
    """A contact and the memory of the surface, relaxed at rest, or (``u``, ``lam``) run in at a constant speed.

    series : J, T, alpha.  path : half lengths that it will roll.
    """

    def __init__(self, series: tuple[Array, Array, float], cells: Grid, path: float, u: float = 0.0, lam: float = 1.0):
        self.series, self.grid, self.u = (np.array(series[0]), np.array(series[1]), float(series[2])), cells, u
        h, back, W = cells.h, round(BEHIND / cells.h), cells.g.size
        half, start = round(0.6 / h), AHEAD - 4.0 * COARSE
        X = start + COARSE * np.arange(round((path + RUN_IN + 60.0) / COARSE))
        x, variance = (np.arange(W) - back) * h, 0.25 * lam * lam
        p, T = np.zeros(W), self.series[1]
        self.where = -back, back - half, back + half + 1, 0.0
        near = np.sqrt(x * x + 0.3)  # near the contact to begin with
        if u:
            m, far_m = (
                np.array([_remembered(D, 2.0 * u * each, s) for each in T]) for D, s in ((near, 0.0), (X, variance))
            )
            low, high = _pressure(cells, -back * h, 1.0 / series[2], self.series[0] @ m, *self.where[1:3], p)
            phi = -0.5 * np.log(near)
        else:
            low, high = _pressure(cells, -back * h, 1.0, np.zeros(W), *self.where[1:3], p)
            phi = np.zeros(W)
            _displacement(cells.g, p, low, high, phi)
            m, far_m = np.tile(phi, (T.size, 1)), np.tile(-0.5 * np.log(X) + 0.0625 / X**2, (T.size, 1))
        self.where = -back, low, high, 0.0
        self.memory = Memory(p, phi, m, start, -0.5 * np.log(X) + 0.25 * variance / X**2, far_m)
        if u:
            self.roll(0.0, X_end=RUN_IN)

    @property
    def kM(self) -> float:
        """kappa M."""
        first, low, high, Xc = self.where
        return 0.5 * float(_centre(self.grid.h, first * self.grid.h - Xc, self.memory.p, low, high)[0])

    def roll(self, g: float, *, t_end: float = 1e300, X_end: float = 1e300, steps: int = 2_000_000) -> Array:
        """Rows t, X and u of a motion from now."""
        out = np.empty((steps, 3))
        ends = t_end, X_end + self.where[3]
        count, low, high, first, Xc, u = _rolled(self.grid, self.series, self.memory, self.where, self.u, g, ends, out)
        rows: Any = out[:count] - [0.0, self.where[3], 0.0]
        self.where, self.u = (first, low, high, Xc), u
        return np.array(rows)


def _remembered(D: Array, L: float, variance: float) -> Array:
    """m at distances D ahead of a steady load that fades over the length L."""
    z = D / L
    E = np.where(z < 200.0, np.exp(np.minimum(z, 200.0)) * exp1(np.minimum(z, 200.0)), 1.0 / z - 1.0 / z**2)
    second = np.where(z < 200.0, (1.0 / D - E / L) / L, 1.0 / D**2)
    found: Array = -0.5 * (np.log(D) + E) + 0.25 * variance * second
    return found
