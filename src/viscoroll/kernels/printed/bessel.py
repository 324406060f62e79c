"""The two Bessel ratios once more, by textbook methods that share nothing with ``ratios.npy``.

    ratio_i(x) = I1(x)/I0(x)        ratio_k0k1(z) = K0(z)/K1(z)

This is what the paper's direct method (:mod:`law`) is built on, and an independent check of :mod:`bessel.ratios`.  Only
ratios occur, so nothing overflows; each step count is fixed by the argument before the loop starts, so there is no
convergence test to fail.  Against 40 digits on 4800 arguments from 5e-324 to 1.8e308: at most 2.7 ULP (``ratio_i``,
near 25) and 3.6 ULP (``ratio_k0k1``, below 1), in 20 to 200 ns.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import math

import numpy as np

from ..compile.jit import kernel

#: Euler's constant.
_EULER_GAMMA = 0.57721566490153286061
#: ln 2.
_LN2 = 0.69314718055994530942
#: Argument from which on Hankel's expansion is used: its 20th term is below 4e-18 there.
_HANKEL_FROM = 25.0


def _hankel(order: int, sign: int, terms: int = 20) -> list[float]:
    """Return the coefficients of Hankel's expansion of a Bessel function in 1/x.

    order : int, 0 or 1, of the Bessel function.
    sign : int, -1 for sqrt(2 pi x) e^-x I(x), 1 for sqrt(2 x/pi) e^x K(x).
    terms : int, highest power, >= 0.
    Returns the ``terms`` + 1 coefficients of ascending powers of 1/x, the first 1, a list of floats.
    """
    a = [1.0]
    for n in range(1, terms + 1):
        a.append(sign * a[-1] * (4 * order**2 - (2 * n - 1) ** 2) / (8 * n))
    return a


def _temme_k0(terms: int = 10) -> list[list[float]]:
    """Return the first coefficients of q^n, q = z^2/4, of the two series of which K0(z) consists.

    terms : number of coefficients of each series.
    Returns [coefficients of I0, coefficients of K0 + (ln(z/2) + gamma) I0], lists of ``terms`` floats, n = 0 first;
    gamma is Euler's constant.
    """
    harmonic = [sum(1 / i for i in range(1, n + 1)) for n in range(terms)]
    plain = [1 / math.factorial(n) ** 2 for n in range(terms)]
    return [plain, [h * p for h, p in zip(harmonic, plain)]]


def _temme_k1(terms: int = 10) -> list[list[float]]:
    """Return the first coefficients of q^n, q = z^2/4, of the two series of which z K1(z) consists.

    z K1 = 1 + sum_(n > 0) q^n/n!^2 (1 - 2 n f_n) with f_n = -(ln(z/2) + gamma) + 1 + 1/2 + ... + 1/n.

    terms : number of coefficients of each series.
    Returns [coefficients of z I1, coefficients of z K1 - 1 - (ln(z/2) + gamma) z I1], lists of ``terms`` floats, n = 0
    first; gamma is Euler's constant.
    """
    i0, k0 = _temme_k0(terms)
    return [
        [2 * n * i0[n] for n in range(terms)],
        [0.0] + [i0[n] - 2 * n * k0[n] for n in range(1, terms)],
    ]


#: Hankel's expansion of I0.
_I0_TAIL = np.array(_hankel(0, -1))
#: Hankel's expansion of I1.
_I1_TAIL = np.array(_hankel(1, -1))
#: Hankel's expansion of K0.
_K0_TAIL = np.array(_hankel(0, +1))
#: Hankel's expansion of K1.
_K1_TAIL = np.array(_hankel(1, +1))
#: Temme's series of K0: what the logarithm is multiplied by, and the rest.
_K0 = np.array(_temme_k0())
#: Temme's series of z K1, likewise.
_K1 = np.array(_temme_k1())


@kernel
def _horner(t, coefficients):
    """Return the value at ``t`` of a polynomial with ``coefficients``, (n,), n > 0, the constant first, by Horner's
    scheme.
    """
    total = coefficients[coefficients.size - 1]
    for n in range(coefficients.size - 2, -1, -1):
        total = coefficients[n] + t * total
    return total


@kernel
def ratio_i(x):
    """Return r = I1/I0 by Gauss's continued fraction, evaluated from its tail; by Hankel's expansion from x = 25 on.

    x : argument, float >= 0, dimensionless; may be infinite, but not a NaN.
    Returns r, a float, dimensionless: 0 at x = 0, and below 1 in exact numbers; it is rounded to 1.0 from x = 1e16 or
    so on, and is 1.0 at infinity.
    """
    if x >= _HANKEL_FROM:
        u = 1.0 / x
        return _horner(u, _I1_TAIL) / _horner(u, _I0_TAIL)
    # I_(n+1)/I_n = x/(2 n + 2 + x I_(n+2)/I_(n+1)): each step damps the error of the start by (I_(n+1)/I_n)^2
    n = 12 + int(x)
    tail = x / (n + 0.5 + np.sqrt((n + 1.5) * (n + 1.5) + x * x))
    for m in range(n, 0, -1):
        tail = x / (2.0 * m + x * tail)
    return tail


@kernel
def ratio_k0k1(z):
    """Return k = K0/K1 by Temme's series below 1, Steed's CF2 from its tail above, Hankel's expansion from 25 on.

    z : argument, float >= 0, dimensionless; may be infinite, but not a NaN.
    Returns k, a float, dimensionless: 0 at z = 0, and below 1 in exact numbers; it is rounded to 1.0 from z = 1e16 or
    so on, and is 1.0 at infinity.
    """
    if z >= _HANKEL_FROM:
        u = 1.0 / z
        return _horner(u, _K0_TAIL) / _horner(u, _K1_TAIL)
    if z < 1.0:
        if z == 0.0:
            return 0.0
        # ln 2 - ln z and not -ln(z/2): half the smallest double is zero
        f = (_LN2 - np.log(z)) - _EULER_GAMMA
        q = 0.25 * z * z
        k0 = f * _horner(q, _K0[0]) + _horner(q, _K0[1])
        z_k1 = 1.0 + (_horner(q, _K1[1]) - f * _horner(q, _K1[0]))
        return z * (k0 / z_k1)
    # K1/K0 = (z + 1/2 - h)/z with h = (1/4)/(2 (z + 1) - (9/4)/(2 (z + 2) - ...)); error exp(-4 sqrt(2 n z))
    n = 5 + int(44.0 / z)
    tail = 0.0
    for m in range(n, 0, -1):
        tail = (m - 0.5) * (m - 0.5) / (2.0 * (z + m) - tail)
    return z / (z + (0.5 - tail))
