"""The contact law over arrays of states at one alpha: three polynomials for Q and M, no Bessel ratio, no root.

With u = kappa |V|, L(u) = 2 u F(zeta) = 2 kappa delta_star/mu and D = 2 kappa |delta|/mu, Eq. (10)
reads y = F(eta) = w/(2 u) with w = L - D, and Eq. (15)

    Q = mu (1 - w^2 H(eta)/y^2)        or, where D is a small part of L and this would cancel,
    Q = mu Int_0^D 2 w A(w/(2 u)) dD,  A = H'(eta)/(2 y F'(eta)).

A state outside the slice, or closer to delta_star than :data:`EDGE`, takes the way of
:mod:`contact_loop`.
"""

from __future__ import annotations

import numpy as np

from ..bessel.ratios import bin_number, bin_offset
from ..compile.fma import fma, septic
from ..compile.jit import kernel
from .contact_loop import (
    BETA,
    DELTA,
    DELTA_STAR,
    EPSILON,
    FULL_SLIP,
    LAM,
    ROWS,
    ZETA,
    M,
    Q,
    contact_state,
    creep_ratio,
    signed_slip,
)
from .length import OK
from .standard import standard
from .slice_fit import CREEP, LENGTH, MOMENT, PRESS, RISE, SHARE, SHIFT
from .stick import CLOSE, GAUSS_W, GAUSS_X

#: least F(eta)/F(zeta) served; below, beta is too near 0 for its bin to be in every slice
EDGE = 2.0**-20


@kernel(inline=True)
def polynomial_of(table, at, f, t):
    """Function ``f`` in bin ``at`` (indexed in full: a view of a row would cost more than the polynomial)."""
    low = (table[at, f, 1], table[at, f, 2], table[at, f, 3], table[at, f, 4])
    high = (table[at, f, 5], table[at, f, 6], table[at, f, 7], table[at, f, 8])
    return fma(t, septic(t, *low, *high), table[at, f, 0])


@kernel(inline=True)
def at_y(table, first, f, y):
    """Function ``f`` of y = F(eta)."""
    return polynomial_of(table, bin_number(y) - first, f, bin_offset(y))


@kernel(inline=True)
def traction_near_rest(u, L, D, stick, first):
    """|Q|/mu as the integral of its slope, for small D."""
    total = 0.0
    for n in range(5):
        w = L - D * GAUSS_X[n]
        total += GAUSS_W[n] * w * at_y(stick, first, RISE, 0.5 * w / u)
    return 2.0 * D * total


@kernel(allocates=True)
def slice_loop(
    alpha, kappa, mu, V, creep, creep_is_omega, need, rows,
    speed, first_speed, stick, first_stick, out, start, stop,
):  # fmt: skip
    """``contact_loop`` at one alpha, by its slice; no slopes.

    One long body: a call with a table among its arguments costs more than a polynomial.
    """
    _, need_stick, _, _ = need
    state = np.empty(len(ROWS))
    row = np.full(len(ROWS), -1)
    for n in range(rows.size):
        row[rows[n]] = n
    need_length = max(row[LAM], row[ZETA], row[BETA]) >= 0
    worst = OK
    a = b = to_creep = of_creep = 1.0
    for i in range(start, stop):
        if i == start or kappa.size > 1 or mu.size > 1:
            a, b = kappa[min(i, kappa.size - 1)], mu[min(i, mu.size - 1)]
            to_creep, of_creep = 0.5 * b / a, 2.0 * a / b
        v, x = V[min(i, V.size - 1)], creep[min(i, creep.size - 1)]
        u = a * abs(v)
        at = bin_number(u) - first_speed
        served = 0 <= at < speed.shape[0]
        if served:
            t = bin_offset(u)
            L = polynomial_of(speed, at, CREEP, t)
            slip, sign, _ = signed_slip(v, x, creep_is_omega)
            delta = creep_ratio(v, x, slip, creep_is_omega)
            delta_star = to_creep * L
            full_slip = abs(delta) >= delta_star
            D = of_creep * abs(delta)
            w = L - D
            served = full_slip or w >= EDGE * L or not need_stick
        if not served:
            worst = max(worst, contact_state(standard(alpha[0]), a, b, v, x, creep_is_omega, need, state))
            for n in range(rows.size):
                out[n, i] = state[rows[n]]
            continue
        if row[DELTA_STAR] >= 0:
            out[row[DELTA_STAR], i] = delta_star
        if row[DELTA] >= 0:
            out[row[DELTA], i] = delta
        if row[FULL_SLIP] >= 0:
            out[row[FULL_SLIP], i] = 1.0 if full_slip else 0.0
        if row[EPSILON] >= 0:
            out[row[EPSILON], i] = polynomial_of(speed, at, SHIFT, t)
        if row[M] >= 0:
            out[row[M], i] = v * polynomial_of(speed, at, MOMENT, t)
        y = 0.5 * w / u
        if need_length:
            lam = polynomial_of(speed, at, LENGTH, t)
            if row[LAM] >= 0:
                out[row[LAM], i] = lam
            if row[ZETA] >= 0:
                out[row[ZETA], i] = 0.5 * lam / u
            if row[BETA] >= 0:
                out[row[BETA], i] = 0.0 if full_slip else min(at_y(stick, first_stick, SHARE, y) * w / lam, 1.0)
        if row[Q] >= 0:
            share = 1.0
            if not full_slip:
                if D > CLOSE * L:
                    share = 1.0 - w * w * at_y(stick, first_stick, PRESS, y)
                else:
                    share = traction_near_rest(u, L, D, stick, first_stick)
            out[row[Q], i] = sign * b * min(share, 1.0)
    return worst


@kernel
def speed_range(kappa, V, low, high):
    """Least and largest kappa |V| within [low, high); least > largest if there is none.

    Compared as integers, which order positive doubles alike and which LLVM compares by the vector.
    """
    bottom, top = np.float64(low).view(np.int64), np.float64(high).view(np.int64)
    least, largest = top, np.int64(0)
    for i in range(V.size):
        bits = np.float64(kappa * abs(V[i])).view(np.int64)
        within = bottom <= bits < top
        least = min(least, bits if within else top)
        largest = max(largest, bits if within else np.int64(0))
    return np.int64(least).view(np.float64), np.int64(largest).view(np.float64)
