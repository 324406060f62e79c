"""The three Bessel ratios that carry the whole contact law, and their slopes.

    r(x) = I1(x)/I0(x)      k(z) = K0(z)/K1(z)      i2(x) = I2(x)/I0(x) = 1 - 2 r(x)/x

Piecewise polynomials indexed by the bits of the argument (:mod:`ratio_layout`, no
logarithm), a power series below them and the asymptotic series above, so that every
positive double is served.  Relative error at most 2.4 ULP (``pipeline/prove.py``; on the
points of ``tests/test_ratios.py``, against 60 digits, 2).  Slopes come from the Riccati equations

    r' = 1 - r/x - r^2      k' = k^2 + k/z - 1

and cost no further Bessel function.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from . import ratio_layout as layout
from .jit import kernel

TABLE = np.load(Path(__file__).with_name("ratios.npy"))

_BIN_BITS = 4  # log2(BINS)
_SHIFT = 52 - _BIN_BITS
_MANTISSA = (1 << 52) - 1
_BIN_MASK = ((1 << _BIN_BITS) - 1) << _SHIFT
_ONE = 1023 << 52
_HALF_BIN = 1 << (_SHIFT - 1)
_ROWS = TABLE.reshape(-1, layout.COEFFICIENTS)


def _origin(index: int) -> int:
    """Row of a segment's first bin minus the number of that bin."""
    return layout.segment_start(index) // layout.COEFFICIENTS - ((1023 + layout.SEGMENTS[index].low) << _BIN_BITS)


_R_SMALL, _R_LARGE, _K_SMALL, _K_LARGE, _I2 = (_origin(i) for i in range(len(layout.SEGMENTS)))


def _r_power_series(terms: int) -> list[float]:
    """c_n of r(x) = sum c_n x^(2n+1), from the Riccati equation."""
    c = [0.5]
    for n in range(1, terms):
        c.append(-sum(c[i] * c[n - 1 - i] for i in range(n)) / (2 * n + 2))
    return c


def _asymptotic_series(sign: int, terms: int) -> list[float]:
    """a_n of r (sign = -1) or k (sign = +1) = sum a_n x^-n, from the Riccati equations."""
    a = [1.0]
    for n in range(1, terms):
        products = sum(a[i] * a[n - i] for i in range(1, n))
        step = (n - 2) * a[-1] if sign < 0 else -n * a[-1]
        a.append((step - products) / 2)
    return a


_SERIES = np.array(_r_power_series(9))
_R_TAIL = -np.array(_asymptotic_series(-1, 13))[1:]
_K_TAIL = -np.array(_asymptotic_series(+1, 13))[1:]
_EULER_GAMMA = 0.57721566490153286061
_LN2 = 0.69314718055994530942


@kernel
def bin_number(x):
    """Exponent and leading mantissa bits of x > 0: rises by one from bin to bin."""
    return np.float64(x).view(np.int64) >> _SHIFT


@kernel
def bin_offset(x):
    """Mantissa of x less that of the centre of its bin."""
    bits = np.float64(x).view(np.int64)
    centre = np.int64((bits & _BIN_MASK) | (_ONE + _HALF_BIN)).view(np.float64)
    return np.int64((bits & _MANTISSA) | _ONE).view(np.float64) - centre


@kernel
def polynomial(row, t):
    """Polynomial of degree 8 with the coefficients ``row``."""
    t2 = t * t
    low = (row[1] + t * row[2]) + t2 * (row[3] + t * row[4])
    high = (row[5] + t * row[6]) + t2 * (row[7] + t * row[8])
    return row[0] + t * (low + (t2 * t2) * high)


@kernel
def _piece(x, origin):
    """Polynomial of the bin that holds x in the segment with this origin."""
    return polynomial(_ROWS[origin + bin_number(x)], bin_offset(x))


@kernel
def _tail(x, coefficients):
    """sum coefficients[n] x^-n."""
    u = 1.0 / x
    total = coefficients[coefficients.size - 1]
    for n in range(coefficients.size - 2, -1, -1):
        total = coefficients[n] + u * total
    return total


@kernel(inline=True)
def ratio_r(x):
    """r = I1/I0 and 1 - r at x >= 0, both to full relative accuracy."""
    if x < 0.0625:
        x2 = x * x
        total = _SERIES[6]
        for n in range(5, -1, -1):
            total = _SERIES[n] + x2 * total
        r = x * total
        return r, 1.0 - r
    if not x < 64.0:  # a NaN too: it must not become the number of a bin
        complement = _tail(x, _R_TAIL) / x
        return 1.0 - complement, complement
    # both forms and a choice: a branch here would be mispredicted on scattered arguments
    small = x < 2.0
    piece = _piece(x, _R_SMALL if small else _R_LARGE)
    r, complement = x * piece, piece / x
    return r if small else 1.0 - complement, 1.0 - r if small else complement


@kernel(inline=True)
def small_k_over_z(z):
    """k/z for 0 < z < 2^-30."""
    return _LN2 - _EULER_GAMMA - np.log(z)


@kernel(inline=True)
def ratio_k(z):
    """k = K0/K1 and 1 - k at z >= 0, both to full relative accuracy."""
    if not z < 64.0:
        complement = _tail(z, _K_TAIL) / z
        return 1.0 - complement, complement
    if z < 2.0**-30:
        k = z * small_k_over_z(z) if z > 0.0 else 0.0
        return k, 1.0 - k
    small = z < 1.0
    piece = _piece(z, _K_SMALL if small else _K_LARGE)
    k, complement = z * piece, piece / z
    return k if small else 1.0 - complement, 1.0 - k if small else complement


@kernel(inline=True)
def ratio_i2(x, r):
    """i2 = I2/I0 at x >= 0, given r(x)."""
    if x < 0.0625:
        x2 = x * x
        total = _SERIES[7]
        for n in range(6, 0, -1):
            total = _SERIES[n] + x2 * total
        return -2.0 * x2 * total
    if x < 4.0:
        return x * x * _piece(x, _I2)
    return 1.0 - 2.0 * r / x


@kernel(inline=True)
def slope_r(x, r, complement):
    """r'(x) = (1 - r)(1 + r) - r/x."""
    if x < 1e-8:
        return 0.5
    return complement * (1.0 + r) - r / x


@kernel(inline=True)
def slope_k(z, k, complement):
    """k'(z) = k/z - (1 - k)(1 + k)."""
    return k / z - complement * (1.0 + k)
