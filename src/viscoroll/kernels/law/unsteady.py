"""The first-order term of unsteady rolling: M = M(V) + N(V) V' where speed changes slowly, in closed form.

With g, h, H, m, X and the ratios of a series (:mod:`..rows.series`) at z = zeta, y = sum X_i i2(a_i z),
theta = 2 H/H' and ' = d/dz,

    W = H g - 2 z (h - z h') g - z H g' + z^2 (y - z y')
    U = H g_s - g H_s + z^2 y_s + T_mean (H g - z^2 y)
    N = -[(3/2) U - (theta/2) U' + (theta g' - g) W]/H

_s is the slope at s = 0 of a material with the rates a_i - s, b_j - s, the same J_j b_j, E_i a_i and Q, divided by
1 + T_mean s, which makes its long-time modulus 1 again.  Every number therefore comes as a jet: value, d/dz, d/ds and
d2/dz ds.  The system is that of :mod:`..rows.series` in y = r nu, nu = x/sqrt(r),

    (1/r + Q^T k Q) y = e      h = sum e_i y_i      g = sum t_j k_j (Q y)_j      sum X_i i2_i = sum e_i y_i i2_i/r_i

differentiated: four right sides, one matrix, no Bessel function but r, k and i2.  Unit of N: that of time squared.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import asymptotic_series, ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from ..compile.jit import kernel
from ..numerics.linear import factorize, substitute

#: from here on r and k by their asymptotic series, whose slopes keep their digits
_FAR = 64.0
_SERIES_R, _SERIES_K = (np.array([float(a) for a in asymptotic_series(sign, 17)]) for sign in (-1, 1))


#: in longest and in shortest times, the z beyond which N is in its limits to rounding
_SLOW, _FAST = 1e17, 1e-9


class Room(NamedTuple):
    """Jets of one evaluation, (4, modes) each: 1/r, i2/r, k, y and Q y; a right side and the matrix."""

    per_r: Any
    pressed: Any
    k: Any
    y: Any
    f: Any
    right: Any
    matrix: Any


@kernel(allocates=True)
def room(series):
    """Room for the evaluations of a series."""
    count = series.a.size
    return Room(
        np.empty((4, count)), np.empty((4, count)), np.empty((4, count)), np.empty((4, count)), np.empty((4, count)),
        np.empty(count), np.empty((count, count)),
    )  # fmt: skip


@kernel(inline=True)
def _product(p, q):
    """Of two jets."""
    return (
        p[0] * q[0],
        p[1] * q[0] + p[0] * q[1],
        p[2] * q[0] + p[0] * q[2],
        p[3] * q[0] + p[1] * q[2] + p[2] * q[1] + p[0] * q[3],
    )


@kernel(inline=True)
def _sum(p, q):
    """Of two jets."""
    return p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3]


@kernel(inline=True)
def _jet(rate, z, value, slope, bend):
    """Jet of a function of x = (rate - s) z from its value and derivatives over x."""
    return value, rate * slope, -z * slope, -slope - rate * z * bend


@kernel(inline=True)
def _inverse(p):
    """1/p."""
    value = 1.0 / p[0]
    square = value * value
    return value, -square * p[1], -square * p[2], square * (2.0 * value * p[1] * p[2] - p[3])


@kernel
def _far(terms, x):
    """(value, slope, second derivative) of sum a_n x^-n."""
    w, value, slope, bend = 1.0 / x, 0.0, 0.0, 0.0
    for n in range(terms.size - 1, 0, -1):
        value = value * w + terms[n]
        slope = slope * w - n * terms[n]
        bend = bend * w + n * (n + 1) * terms[n]
    return 1.0 + value * w, slope * w * w, bend * w * w * w


@kernel
def _r_and_i2(x):
    """r and i2 at x > 0 with their first two derivatives each."""
    if x < _FAR:
        r, complement = ratio_r(x)
        dr = slope_r(x, r, complement)
        ddr = (r / x - dr) / x - 2.0 * r * dr
    else:
        r, dr, ddr = _far(_SERIES_R, x)
    i2 = ratio_i2(x, r)
    if x < 4.0:
        di2 = r - (2.0 / x + r) * i2
        ddi2 = dr - 2.0 * (di2 - i2 / x) / x - di2 * r - i2 * dr
    else:  # of 1 - 2 r/x
        di2 = 2.0 * (r / x - dr) / x
        ddi2 = (4.0 * (dr - r / x) / x - 2.0 * ddr) / x
    return r, dr, ddr, i2, di2, ddi2


@kernel
def _k(x):
    """k at x > 0 with its first two derivatives."""
    if x >= _FAR:
        return _far(_SERIES_K, x)
    k, complement = ratio_k(x)
    dk = slope_k(x, k, complement)
    return k, dk, 2.0 * k * dk + (dk - k / x) / x


@kernel(inline=True)
def _put(jets, i, jet):
    jets[0, i], jets[1, i], jets[2, i], jets[3, i] = jet


@kernel(inline=True)
def _at(jets, i):
    return jets[0, i], jets[1, i], jets[2, i], jets[3, i]


@kernel
def _ratios(z, series, work):
    """Jets of the ratios of every mode."""
    for i in range(series.a.size):
        a, b = series.a[i], series.b[i]
        r, dr, ddr, i2, di2, ddi2 = _r_and_i2(a * z)
        per_r = _inverse(_jet(a, z, r, dr, ddr))
        _put(work.per_r, i, per_r)
        _put(work.pressed, i, _product(_jet(a, z, i2, di2, ddi2), per_r))
        k, dk, ddk = _k(b * z)
        _put(work.k, i, _jet(b, z, k, dk, ddk))


@kernel(inline=True)
def _e(i, T_mean, series):
    """Jet of e_i."""
    return series.e[i], 0.0, series.e[i] * (1.0 / series.a[i] + 0.5 * T_mean), 0.0


@kernel(inline=True)
def _t(j, T_mean, series):
    """Jet of t_j."""
    return series.t[j], 0.0, series.t[j] * (1.0 / series.b[j] - 0.5 * T_mean), 0.0


@kernel
def _subtract(m, n, series, work):
    """Take part m of the jet of the matrix, applied to part n of y, from the right side."""
    count = series.a.size
    for i in range(count):
        total = work.per_r[m, i] * work.y[n, i]
        for j in range(count):
            total += series.Q[j, i] * work.k[m, j] * work.f[n, j]
        work.right[i] -= total


@kernel
def _substitute(n, series, work):
    """Part n of y and of Q y from the right side."""
    count = series.a.size
    substitute(work.matrix, work.right, count)
    for i in range(count):
        work.y[n, i] = work.right[i]
    for j in range(count):
        total = 0.0
        for i in range(count):
            total += series.Q[j, i] * work.y[n, i]
        work.f[n, j] = total


@kernel
def system(per_r, k, series, matrix):
    """The factors of 1/r + Q^T k Q."""
    count = series.a.size
    for i in range(count):
        for n in range(i + 1):
            total = 0.0
            for j in range(count):
                total += series.Q[j, i] * k[j] * series.Q[j, n]
            matrix[i, n], matrix[n, i] = total, total
        matrix[i, i] += per_r[i]
    factorize(matrix, count)


@kernel
def _solve(z, T_mean, series, work):
    """Jets of y and Q y, part by part."""
    _ratios(z, series, work)
    system(work.per_r[0], work.k[0], series, work.matrix)
    for part in range(4):
        for i in range(series.a.size):
            work.right[i] = _e(i, T_mean, series)[part]
        if part == 3:
            _subtract(1, 2, series, work)
            _subtract(2, 1, series, work)
        if part > 0:
            _subtract(part, 0, series, work)
        _substitute(part, series, work)


@kernel
def _sums(z, T_mean, series, work):
    """Jets of g, h and y = sum X_i i2_i."""
    _solve(z, T_mean, series, work)
    g = h = pressed = (0.0, 0.0, 0.0, 0.0)
    for i in range(series.a.size):
        weighted = _product(_e(i, T_mean, series), _at(work.y, i))
        h = _sum(h, weighted)
        pressed = _sum(pressed, _product(weighted, _at(work.pressed, i)))
        g = _sum(g, _product(_product(_t(i, T_mean, series), _at(work.k, i)), _at(work.f, i)))
    return g, h, pressed


@kernel
def _between(z, T_mean, series, work):
    """N from its formula."""
    (g, dg, g_s, dg_s), (h, dh, h_s, dh_s), (y, dy, y_s, dy_s) = _sums(z, T_mean, series, work)
    H, dH, H_s, dH_s = z * (z + 2.0 * h), 2.0 * (z + h + z * dh), 2.0 * z * h_s, 2.0 * (h_s + z * dh_s)
    square = z * z
    W = H * g - 2.0 * z * (h - z * dh) * g - z * H * dg + square * (y - z * dy)
    U = H * g_s - g * H_s + square * y_s + T_mean * (H * g - square * y)
    dU = (dH * g_s + H * dg_s) - (dg * H_s + g * dH_s) + z * (2.0 * y_s + z * dy_s)
    dU += T_mean * ((dH * g + H * dg) - z * (2.0 * y + z * dy))
    theta = 2.0 * H / dH
    return -(1.5 * U - 0.5 * theta * dU + (theta * dg - g) * W) / H


@kernel
def unsteady(z, series, work):
    """N at z = zeta > 0: from -sum E_i tau_i^2 as V -> 0 to sum J_j/(4 H) in fast rolling, z^2 sum E_i/4."""
    T_mean = relaxed = rise = 0.0
    for i in range(series.a.size):
        square = series.e[i] * series.e[i]
        T_mean += square
        relaxed += square / series.a[i]
        rise += square * series.a[i]
    if not z * series.b[0] < _SLOW:
        return -relaxed
    if z * series.a[series.a.size - 1] < _FAST:
        return 0.25 * rise * z * z
    return _between(z, T_mean, series, work)


@kernel(inline=True)
def set_alpha(n, alpha, series):
    """Make a series of one mode that of state n; ``alpha``: none, or one, or one each."""
    if alpha.size == 0:
        return
    own = alpha[min(n, alpha.size - 1)]
    series.a[0] = own
    series.e[0] = series.t[0] = np.sqrt((own - 1.0) / own)


@kernel(allocates=True)
def unsteady_loop(series, alpha, zeta, out, start, stop):
    """N at an array of zeta; ``alpha``: none, or one each, of which ``series`` is then the one mode."""
    work = room(series)
    for n in range(start, stop):
        set_alpha(n, alpha, series)
        out[n] = unsteady(zeta[n], series, work) if series.e[0] > 0.0 else 0.0
