"""What the rows of one material are fitted to: the functions of :mod:`series` with slopes over ln(1/z), and N.

N of M = M(V) + N(V) V', the first-order term of unsteady rolling where speed changes slowly, has a closed form: with y
= sum X_i i2(a_i z), theta = 2 H/H' and ' = d/dz,

    W = H g - 2 z (h - z h') g - z H g' + z^2 (y - z y')
    U = H g_s - g H_s + z^2 (y_s + T_mean g)
    N = -[(3/2) U - (theta/2) U' + (theta g' - g) W]/H

z is half the transit time of the contact, a_i = 1/tau_i and b_j = 1/T_j are the rates of the modes, E_i the strengths
of relaxation, g, h and X_i functions of z (:mod:`.series`), H = z^2 + 2 z h, and T_mean = sum E_i tau_i.  _s is the
derivative in s at s = 0, where s is subtracted from all rates a_i and b_j (:mod:`.series`).  (Divided by 1 + T_mean s,
which makes the long-time modulus 1 again, h and y gain T_mean times themselves and g nothing: hence the last term of
U.)  Unit of N: that of time squared.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..bessel.ratios import asymptotic_series, ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from ..compile.jit import inline_kernel, kernel
from ..numerics.interpolation import to_doubles
from ..numerics.simd4 import LANES, pack, store, unpack
from .contact_states import element
from .series import FUNCTIONS, evaluate_functions, reciprocal

#: From this argument on r and k come from their asymptotic series, whose derivatives keep their digits.
_ASYMPTOTIC = 64.0
#: Coefficients of the asymptotic series of r.
_SERIES_R = to_doubles(asymptotic_series(-1, 17))
#: Coefficients of the asymptotic series of k.
_SERIES_K = to_doubles(asymptotic_series(1, 17))
#: From this multiple of the longest creep time on N has its limit V -> 0, to rounding.
_SLOW = 1e17
#: Below this multiple of the shortest relaxation time N has its limit of fast rolling, to rounding.
_FAST = 1e-9


@kernel
def _evaluate_asymptotic(terms, x):
    """Evaluate the asymptotic series sum a_n x^-n of r or k, with its first two derivatives.

    Of large x the Riccati equations would give derivatives as differences that have lost their digits.

    terms : coefficients a_0, a_1, ..., of which a_0 = 1 is not read, (terms,), floats.
    x : float, argument a_i z or b_j z, 64 or more, dimensionless; it may be infinite.
    Returns (value, first derivative, second derivative) over x, floats, dimensionless; (1, 0, 0) at infinity.
    """
    w = 1.0 / x
    value = slope = second_derivative = 0.0
    for n in range(terms.size - 1, 0, -1):
        value = value * w + terms[n]
        slope = slope * w - n * terms[n]
        second_derivative = second_derivative * w + n * (n + 1) * terms[n]
    return 1.0 + value * w, slope * w * w, second_derivative * w * w * w


@inline_kernel
def _jet(rate, z, function):
    """Return the jet of a function of x = (rate - s) z at s = 0: a vector of four, value, d/dz, d/ds, d2/dz ds.

    It turns derivatives over x, which the ratios of Bessel functions have, into those over z and s (:mod:`.series`).

    rate : float, a_i or b_j, rate of the mode, > 0.
    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the rate.
    function : (value f, first derivative f', second derivative f'') over x, floats, at x = rate z.
    Returns the vector (f, rate f', -z f', -f' - rate z f'').
    """
    value, slope, second_derivative = function
    return pack(value, rate * slope, -z * slope, -slope - rate * z * second_derivative)


@kernel
def _write_ratio_jets(z, series, work):
    """Write value, d/dz, d/ds and d2/dz ds of 1/r, k and i2 of every mode; s is subtracted from the rates, s = 0.

    r = I1/I0 and i2 = I2/I0 are ratios of Bessel functions at a_i z, k = K0/K1 at b_i z.

    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the series; at infinity values are 1
        and derivatives over s are NaN.
    series : :class:`Series`, of which the rates a and b are read.
    work : :class:`Workspace` of the series, whose ``inverse_r``, ``k`` and ``i2`` are written, four numbers a mode, as
        of :func:`_jet`.  Returns nothing.
    """
    for i in range(series.a.size):
        a = series.a[i]
        b = series.b[i]
        x = a * z
        r, complement = ratio_r(x)
        dr = slope_r(x, r, complement)
        ddr = (r / x - dr) / x - 2.0 * r * dr
        if x >= _ASYMPTOTIC:
            r, dr, ddr = _evaluate_asymptotic(_SERIES_R, x)
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
        if x >= _ASYMPTOTIC:
            k, dk, ddk = _evaluate_asymptotic(_SERIES_K, x)
        store(work.inverse_r, LANES * i, reciprocal(True, _jet(a, z, (r, dr, ddr))))
        store(work.i2, LANES * i, _jet(a, z, (i2, di2, ddi2)))
        store(work.k, LANES * i, _jet(b, z, (k, dk, ddk)))


@kernel
def _evaluate_N(z, series, of_g, of_h, of_y):
    """Return N, the factor of dV/dt in M = M(V) + N dV/dt, at z = zeta > 0, by the closed form of the module docstring.

    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the series; infinite for V = 0.
    series : :class:`Series` of at least one mode, with ascending rates a and b, which are read, and the strengths e.
    of_g, of_h, of_y : jets of g, h and sum X_i i2_i at z (:mod:`.series`), vectors of four: value, d/dz, d/ds, d2/dz
        ds; not read where a limit is returned.

    Returns a float, in the unit of time of the series, squared.  From z = 1e17 times the longest creep time on it is
    the limit V -> 0, -sum E_i tau_i^2; below z = 1e-9 times the shortest relaxation time it is that of fast rolling,
    z^2 sum E_i/4.  It is 0 for alpha = 1.
    """
    T_mean = relaxed = strength = 0.0
    for i in range(series.a.size):
        square = series.e[i] * series.e[i]
        T_mean += square
        relaxed += square / series.a[i]
        strength += square * series.a[i]
    if not z * series.b[0] < _SLOW:
        return -relaxed
    if z * series.a[series.a.size - 1] < _FAST:
        return 0.25 * strength * z * z
    g, dg, g_s, dg_s = unpack(of_g)
    h, dh, h_s, dh_s = unpack(of_h)
    y, dy, y_s, dy_s = unpack(of_y)
    H = z * (z + 2.0 * h)
    dH = 2.0 * (z + h + z * dh)
    H_s = 2.0 * z * h_s
    dH_s = 2.0 * (h_s + z * dh_s)
    y_s = y_s + T_mean * g
    dy_s = dy_s + T_mean * dg
    W = H * g - 2.0 * z * (h - z * dh) * g - z * H * dg + z * z * (y - z * dy)
    U = H * g_s - g * H_s + z * z * y_s
    dU = (dH * g_s + H * dg_s) - (dg * H_s + g * dH_s) + z * (2.0 * y_s + z * dy_s)
    theta = 2.0 * H / dH
    return -(1.5 * U - 0.5 * theta * dU + (theta * dg - g) * W) / H


@inline_kernel
def set_alpha_of_state(n, alpha, series):
    """Write the alpha of state ``n`` into a series of one mode, whose creep time is the unit of time.

    Loops over states whose alphas differ call it before each state, and so reuse one series and one workspace.

    n : int, index of the state, from 0 to the number of states - 1; not checked.
    alpha : instantaneous divided by long-time stiffness, >= 1, (1,) for all states or (states,); empty: the series is
        complete and nothing is written.
    series : :class:`Series` of one mode with b = 1 and Q = 1, of which a[0] = alpha and e[0] = t[0] = sqrt((alpha -
        1)/alpha) are written; any series if ``alpha`` is empty.  Returns nothing.
    """
    if alpha.size > 0:
        one_alpha = element(alpha, n)
        series.a[0] = one_alpha
        series.e[0] = series.t[0] = np.sqrt((one_alpha - 1.0) / one_alpha)


@kernel
def modes_loop(series, alpha, work, z, out):
    """Evaluate the functions of a series, their slopes and N at many z.

    series : :class:`Series` of at least one mode: rates and strengths; of one mode, and overwritten, if ``alpha`` is
        not empty.
    alpha : instantaneous divided by long-time stiffness, >= 1, of a series of one mode, (1,) for all z or (n,); empty:
        the series is complete.
    work : the :class:`Workspace` of the series, scratch.
    z : values of zeta > 0, (n,), in the unit of time of the series.  Where z is infinite, values and N are the limits
        at rest, and slopes are NaN.
    out : (9, n), written.  Rows 0 to 3: g/z, h/z, m of the half-space, m of the cylinder (m = M/V, in the unit of
        time); rows 4 to 7: their slopes over ln(1/z); row 8: N of M = M(V) + N dV/dt, in the unit of time squared.
        For alpha = 1 all are 0, but for those NaNs.  Returns nothing.
    """
    for n in range(z.size):
        set_alpha_of_state(n, alpha, series)
        _write_ratio_jets(z[n], series, work)
        g, h, y = evaluate_functions(True, pack(z[n], 1.0, 0.0, 0.0), series, work)
        for row in range(FUNCTIONS):
            out[row, n] = work.functions[LANES * row]
            out[FUNCTIONS + row, n] = -z[n] * work.functions[LANES * row + 1]
        out[2 * FUNCTIONS, n] = _evaluate_N(z[n], series, g, h, y)
