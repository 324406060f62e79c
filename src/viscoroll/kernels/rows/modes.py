"""What rows of one material are fitted to: the functions of :mod:`series` with slopes over ln(1/z), and N.

N of M = M(V) + N(V) V', the first-order term of unsteady rolling, is where speed changes slowly, in closed form: with
y = sum X_i i2(a_i z), theta = 2 H/H' and ' = d/dz,

    W = H g - 2 z (h - z h') g - z H g' + z^2 (y - z y')
    U = H g_s - g H_s + z^2 (y_s + T_mean g)
    N = -[(3/2) U - (theta/2) U' + (theta g' - g) W]/H

_s is the slope over s of a jet.  (Divided by 1 + T_mean s, which makes the long-time modulus 1 again, h and y gain
T_mean times themselves and g nothing: hence the last term of U.)  Unit of N: that of time squared.
"""

from __future__ import annotations

import numpy as np

from ..bessel.ratios import asymptotic_series, ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from ..compile.jit import kernel
from ..numerics.simd4 import LANES, pack, store, unpack
from .contact_states import element
from .series import FUNCTIONS, evaluate_functions, reciprocal

#: from here on r and k by their asymptotic series, whose slopes keep their digits
_FAR = 64.0
_SERIES_R, _SERIES_K = (np.array([float(a) for a in asymptotic_series(sign, 17)]) for sign in (-1, 1))
#: in longest and in shortest times, the z beyond which N is in its limits to rounding
_SLOW, _FAST = 1e17, 1e-9


@kernel
def _far(terms, x):
    """(value, slope, second derivative) of sum a_n x^-n."""
    w, value, slope, bend = 1.0 / x, 0.0, 0.0, 0.0
    for n in range(terms.size - 1, 0, -1):
        value = value * w + terms[n]
        slope = slope * w - n * terms[n]
        bend = bend * w + n * (n + 1) * terms[n]
    return 1.0 + value * w, slope * w * w, bend * w * w * w


@kernel(inline=True)
def _jet(rate, z, function):
    """Jet of a function of x = (rate - s) z from its value and derivatives over x."""
    value, slope, bend = function
    return pack(value, rate * slope, -z * slope, -slope - rate * z * bend)


@kernel
def _ratios(z, series, work):
    """Jets of the ratios of every mode."""
    for i in range(series.a.size):
        a, b = series.a[i], series.b[i]
        x = a * z
        r, complement = ratio_r(x)
        dr = slope_r(x, r, complement)
        ddr = (r / x - dr) / x - 2.0 * r * dr
        if x >= _FAR:
            r, dr, ddr = _far(_SERIES_R, x)
        i2 = ratio_i2(x, r)
        if x < 4.0:
            di2 = r - (2.0 / x + r) * i2
            ddi2 = dr - 2.0 * (di2 - i2 / x) / x - di2 * r - i2 * dr
        else:  # of 1 - 2 r/x
            di2 = 2.0 * (r / x - dr) / x
            ddi2 = (4.0 * (dr - r / x) / x - 2.0 * ddr) / x
        x = b * z
        k, complement = ratio_k(x)
        dk = slope_k(x, k, complement)
        ddk = 2.0 * k * dk + (dk - k / x) / x
        if x >= _FAR:
            k, dk, ddk = _far(_SERIES_K, x)
        store(work.per_r, LANES * i, reciprocal(True, _jet(a, z, (r, dr, ddr))))
        store(work.i2, LANES * i, _jet(a, z, (i2, di2, ddi2)))
        store(work.k, LANES * i, _jet(b, z, (k, dk, ddk)))


@kernel
def _unsteady(z, series, of_g, of_h, of_y):
    """N at z = zeta > 0: from -sum E_i tau_i^2 as V -> 0 to sum J_j/(4 H) in fast rolling, z^2 sum E_i/4."""
    T_mean = relaxed = strength = 0.0
    for i in range(series.a.size):
        square = series.e[i] * series.e[i]
        T_mean, relaxed, strength = T_mean + square, relaxed + square / series.a[i], strength + square * series.a[i]
    if not z * series.b[0] < _SLOW:
        return -relaxed
    if z * series.a[series.a.size - 1] < _FAST:
        return 0.25 * strength * z * z
    (g, dg, g_s, dg_s), (h, dh, h_s, dh_s), (y, dy, y_s, dy_s) = unpack(of_g), unpack(of_h), unpack(of_y)
    H, dH, H_s, dH_s = z * (z + 2.0 * h), 2.0 * (z + h + z * dh), 2.0 * z * h_s, 2.0 * (h_s + z * dh_s)
    y_s, dy_s = y_s + T_mean * g, dy_s + T_mean * dg
    W = H * g - 2.0 * z * (h - z * dh) * g - z * H * dg + z * z * (y - z * dy)
    U = H * g_s - g * H_s + z * z * y_s
    dU = (dH * g_s + H * dg_s) - (dg * H_s + g * dH_s) + z * (2.0 * y_s + z * dy_s)
    theta = 2.0 * H / dH
    return -(1.5 * U - 0.5 * theta * dU + (theta * dg - g) * W) / H


@kernel(inline=True)
def set_alpha_of_state(n, alpha, series):
    """Make a series of one mode that of state n; ``alpha``: none, or one, or one each."""
    if alpha.size > 0:
        own = element(alpha, n)
        series.a[0] = own
        series.e[0] = series.t[0] = np.sqrt((own - 1.0) / own)


@kernel
def modes_loop(series, alpha, work, z, out):
    """Values of the functions, a row each, at places z > 0, then their slopes, then N.

    ``alpha``: none, or one each, of which ``series`` is then the one mode.
    """
    for n in range(z.size):
        set_alpha_of_state(n, alpha, series)
        _ratios(z[n], series, work)
        g, h, y = evaluate_functions(True, pack(z[n], 1.0, 0.0, 0.0), series, work)
        for row in range(FUNCTIONS):
            out[row, n], out[FUNCTIONS + row, n] = work.found[LANES * row], -z[n] * work.found[LANES * row + 1]
        out[2 * FUNCTIONS, n] = _unsteady(z[n], series, g, h, y)
