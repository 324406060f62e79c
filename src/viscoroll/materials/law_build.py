"""Offline: the rows of one material or pair, polynomials of 24 powers.

The modes' formulas are evaluated once, at 24 nodes an octave of w = 1/z.  Polynomials of these are turned over: for the
functions of u, w = 2 u (1 + 2 h/z)^(1/2), for those of v, w = v (1 + g/z).

Slopes are fitted and integrated, and one constant is added: value, slope and secant of a polynomial are then all good
to rounding, where one fitted to values has lost three digits in its slopes.  Powers come by way of the rapidly falling
Chebyshev coefficients, which keeps rounding out of them.  No library of linear algebra takes part: its last digits
differ from machine to machine.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..core.array_types import Floats
from ..kernels.numerics.interpolation import chebyshev, powers_of_chebyshev, to_chebyshev, to_doubles
from .law_modes import AtPlaces

TERMS = 24
#: functions of a table in their order: the first five are of kappa |V|, the others of 1/F(eta)
FUNCTIONS = ("lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press")
#: in the slow row what follows a coefficient below this share of the largest is rounding, which would grow by 5.8^n
_ROUNDING, _ROUNDING_OF_N = 1e-16, 3e-15
#: of Newton's iteration from a thousandth: then 1e-13 is left, whose square is rounding
_STEPS = 2
#: octaves from that of the slowest rate of creep down to the first row
_SLOW = 5

_NODES = to_doubles(chebyshev(TERMS))
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T)


#: of T_n(t), and in the slow row of T_n(2 t - 1)
_POWERS, _SLOW_POWERS = powers_of_chebyshev(TERMS, 0.0, 1.0), powers_of_chebyshev(TERMS, 1.0, 2.0)


@dataclass(frozen=True)
class Rows:
    """The rows of a table: row 0 holds [0, 2^e0), each of the others an octave."""

    e0: int
    count: int

    @cached_property
    def t(self) -> Floats:
        """Arguments of the polynomials at their nodes, [row, node]."""
        found = np.tile(_NODES, (self.count, 1))
        found[0] = 0.5 + 0.5 * _NODES
        return found

    @cached_property
    def x(self) -> Floats:
        """The nodes."""
        found = np.ldexp(0.25 * (self.t + 3.0), self.e0 + np.arange(self.count)[:, None])
        found[0] = np.ldexp(self.t[0], self.e0)
        return found

    @cached_property
    def per(self) -> Floats:
        """dln x/dt there."""
        found = 1.0 / (self.t + 3.0)
        found[0] = 1.0 / self.t[0]
        return found

    def read(self, powers: Floats, x: Floats) -> tuple[Floats, Floats]:
        """Values and slopes over ln x of the polynomials [function, row, power], [function, place]."""
        mantissa, exponent = np.frexp(x)
        row = np.maximum(exponent - self.e0, 0)
        slow = row == 0
        t = np.where(slow, np.ldexp(x, -self.e0), 4.0 * mantissa - 3.0)
        by_power = np.take(np.ascontiguousarray(np.moveaxis(powers, -1, 0)), row, axis=-1)
        value, slope = by_power[TERMS - 1], np.zeros((len(powers), x.size))
        for k in range(TERMS - 2, -1, -1):
            slope *= t
            slope += value
            value *= t
            value += by_power[k]
        return value, slope * np.where(slow, t, t + 3.0)

    def fit(self, values: Floats, terms: int = TERMS, rounding: float = _ROUNDING) -> Floats:
        """[..., row, power] of polynomials with these values at the nodes, of so many Chebyshev coefficients."""
        fitted = _added(values, _TO_CHEBYSHEV)
        fitted[..., terms:] = 0.0
        slow = fitted[..., 0, :]
        small = np.abs(slow) < rounding * np.abs(slow).max(axis=-1, keepdims=True)
        slow[np.logical_or.accumulate(small, axis=-1)] = 0.0
        powers = _added(fitted, _POWERS)
        powers[..., 0, :] = _added(slow, _SLOW_POWERS)
        return powers

    def fit_slopes(self, values: Floats, slopes: Floats) -> Floats:
        """Likewise with these slopes over ln x, and in the mean these values."""
        fitted = self.fit(slopes * self.per, TERMS - 1)
        found = np.zeros_like(fitted)
        found[..., 1:] = fitted[..., :-1] / np.arange(1, TERMS)
        total = np.zeros_like(values)
        for k in range(TERMS - 1, -1, -1):
            total = total * self.t + found[..., k, None]
        rest = values - total
        # near each other: their sum alone would round in the last digits of the mean
        first = rest[..., :1]
        found[..., 0] = (first + _added(rest - first, np.full((TERMS, 1), 1.0 / TERMS)))[..., 0]
        return found


def _added(values: Floats, matrix: Floats) -> Floats:
    """``values @ matrix``, one term after another."""
    found = values[..., :1] * matrix[0]
    for k in range(1, len(matrix)):
        found += values[..., k, None] * matrix[k]
    return found


@dataclass(frozen=True)
class Fine:
    """Polynomials over w = 1/z of g/z, h/z and the parts of m."""

    rows: Rows
    powers: Floats
    values: Floats  # at its nodes

    def speed(self, u: Floats) -> tuple[Floats, Floats]:
        """lam, epsilon and the parts of M/V at u, and their slopes over ln u."""
        (shift, rise, *parts), (d_shift, d_rise, *d_parts) = self._turned(u, 1, lambda rise: 2.0 * np.sqrt(rise))
        lam = 1.0 / np.sqrt(1.0 + 2.0 * rise)
        return np.stack([lam, shift, *parts]), np.stack([-(lam**3) * d_rise, d_shift, *d_parts])

    def stick(self, v: Floats) -> tuple[Floats, Floats]:
        """eta/F and H/F^2 at v, and their slopes over ln v."""
        (shift, rise, *_), (d_shift, d_rise, *_) = self._turned(v, 0, lambda shift: shift)
        share = 1.0 / (1.0 + shift)
        press, fall = (1.0 + 2.0 * rise) * share**2, share * d_shift
        return np.stack([share, press]), np.stack([-share * fall, 2.0 * (d_rise * share**2 - press * fall)])

    def _turned(self, x: Floats, which: int, factor: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
        """Values, and slopes over ln x, where w = x factor(1 + g/z) or, ``which`` 1, x factor(1 + 2 h/z)."""
        w = self._near(x, 1.0 / factor(1.0 + (1 + which) * self.values[which]))
        for _ in range(_STEPS):
            (value,), (slope,) = self.rows.read(self.powers[[which]], w)
            whole = 1.0 + (1 + which) * value
            w += (x * factor(whole) - w) / (1.0 - slope / whole)
        values, slopes = self.rows.read(self.powers, w)
        whole = 1.0 + (1 + which) * values[which]
        turn = 1.0 / (1.0 - slopes[which] / whole)
        return values + slopes * ((x * factor(whole) / w - 1.0) * turn), slopes * turn

    def _near(self, x: Floats, per: Floats) -> Floats:
        """w to a thousandth where w per = x, from the nodes."""
        w = self.rows.x.ravel()
        return np.exp(np.interp(np.log(x), np.log(w * per), np.log(w)))


def octaves(slowest: Any, fastest: Any) -> tuple[Any, Any]:
    """(e0, rows) of a table, or of each, from the slowest rate of creep and the fastest of relaxation.

    So far behind the shortest time the fast limit is good to rounding.
    """
    from ..kernels.rows.z_grid import FAST_LIMIT_OCTAVES

    e0 = np.frexp(slowest)[1] - _SLOW
    return e0, np.frexp(fastest)[1] + FAST_LIMIT_OCTAVES - e0 + 1


def build(evaluate: Callable[[Floats], AtPlaces], rows: Rows, alpha: float, means: Floats) -> Floats:
    """The table (rows, 24 powers, 7 functions) with NaN for N.

    ``evaluate``: at places of z; ``means``: sums J_j T_j of half-space and cylinder.
    """
    e0, mean = rows.e0, float(means.sum())
    finer = Rows(e0, rows.count + 2 + math.ceil(0.5 * math.log2(alpha)))
    found = evaluate(1.0 / finer.x.ravel())
    powers = finer.fit_slopes(*(each.reshape(-1, *finer.x.shape) for each in (found.values, found.slopes)))
    powers[:2, 0, :2], powers[2:, 0, 0] = [0.0, math.ldexp(0.5 * mean, e0)], means
    fine = Fine(finer, powers, found.values)
    (speed, d_speed), (stick, d_stick) = fine.speed(rows.x.ravel()), fine.stick(rows.x.ravel())
    values, slopes = (np.concatenate(both).reshape(-1, *rows.x.shape) for both in ((speed, stick), (d_speed, d_stick)))
    powers = rows.fit_slopes(values, slopes)
    powers[[0, 4, 5], 0, 0], powers[1, 0, :2], powers[2:4, 0, 0] = 1.0, [0.0, math.ldexp(mean, e0)], means
    table = np.full((rows.count, TERMS, len(FUNCTIONS)), np.nan)
    table[:, :, [0, 1, 2, 3, 5, 6]] = np.moveaxis(powers, 0, -1)
    return table


def with_unsteady(table: Floats, e0: int, evaluate: Callable[[Floats], Floats]) -> Floats:
    """The table with N; ``evaluate``: N at places of z."""
    rows, whole = Rows(e0, len(table)), table.copy()
    (lam,), _ = rows.read(table[None, :, :, 0], rows.x.ravel())
    *N, slowest = evaluate(np.append(0.5 * lam / rows.x.ravel(), np.inf))
    fitted = rows.fit(np.reshape(N, rows.x.shape), rounding=_ROUNDING_OF_N)
    fitted[0, 0] = slowest
    whole[:, :, FUNCTIONS.index("N")] = fitted
    return whole


def added(N: Floats, e0: int, alpha: float) -> Floats:
    """What kernels read of N; ``N``: its powers, [row, power].

    Rows of N and of its integral over u from where t is 0; then that until there from infinity down, of every row and
    beyond, and likewise from u = 0 up.
    """
    step, whole = np.ldexp(0.25, e0 + np.arange(len(N))), np.zeros_like(N)
    step[0] = math.ldexp(1.0, e0)  # of u over t
    whole[:, 1:] = step[:, None] * N[:, :-1] / np.arange(1.0, TERMS)
    up, down = whole.sum(axis=1), whole @ (-1.0) ** np.arange(TERMS)
    down[0] = 0.0  # there the first row begins
    beyond = (alpha - 1.0) / (16.0 * alpha * math.ldexp(1.0, e0 + len(N) - 1))
    parts = np.append(up - down, beyond)
    from_top, from_rest = -np.cumsum(parts[::-1])[::-1] - np.append(down, 0.0), np.append(0.0, np.cumsum(parts))
    from_top[-1], from_rest[:-2] = 0.0, from_rest[:-2] - down
    pairs = np.stack([N, whole], axis=1).reshape(len(N), 2, -1, 2).swapaxes(1, 2)
    return np.concatenate([pairs.ravel(), from_top, np.delete(from_rest, -2)])


def arranged(table: Floats, e0: int, alpha: float, fast: Floats, given: Floats | None = None) -> Floats:
    """The rows that kernels read (:mod:`..kernels.rows.evaluate`): functions side by side, and L = lam (1 + epsilon),
    or the rows ``given`` of L = 2 kappa delta_star/mu.

    ``fast``: W and C of the fast limit.  L^2 press(2 u/L) = 1, which Q loses digits by, holds to rounding.
    """
    rows = Rows(e0, len(table))
    lam, epsilon, half_space, cylinder, _, share, press = np.moveaxis(table, -1, 0)
    (one, shift), _ = rows.read(np.stack([lam, epsilon]), rows.x.ravel())
    L, u = one * (1.0 + shift), rows.x.ravel()
    if given is not None:
        L = rows.read(given[None], u)[0][0]
    for _ in range(2):
        v = 2.0 * u / L
        value, slope = _press(rows, press, v, alpha, fast)
        A = value - 0.5 * slope
        L, dL = L - 0.5 * (L * value - 1.0 / L) / A, -0.5 * L * slope / A
    lengths = rows.fit_slopes(L.reshape(rows.x.shape), dL.reshape(rows.x.shape))
    lengths[0, 0] = 1.0 if given is None else given[0, 0]
    pairs = [paired(*both) for both in ((lengths, half_space + cylinder), (lam, epsilon), (half_space, cylinder))]
    return np.concatenate([*pairs, press, share], axis=1)


def _press(rows: Rows, press: Floats, v: Floats, alpha: float, fast: Floats) -> tuple[Floats, Floats]:
    """H/F^2 and its slope over ln v, by the rows and in the fast limit behind them."""
    inside = np.minimum(v, math.nextafter(math.ldexp(1.0, rows.e0 + rows.count - 1), 0.0))
    (value,), (slope,) = rows.read(press[None], inside)
    bracket = fast[1] + fast[0] * np.log(v)
    share, bend = 1.0 - 0.5 * alpha * bracket / v, alpha**2 * (bracket - fast[0]) / v
    far = v > inside
    return np.where(far, alpha * share**2, value), np.where(far, bend * share, slope)


def paired(a: Floats, b: Floats) -> Floats:
    """a0 a1 b0 b1, a2 a3 b2 b3, ... of every row."""
    both = np.stack([a.reshape(len(a), -1, 2), b.reshape(len(b), -1, 2)], axis=2)
    return both.reshape(len(a), -1)
