"""The three Bessel ratios that carry the whole contact law, and their slopes.

    r(x) = I1(x)/I0(x)      k(z) = K0(z)/K1(z)      i2(x) = I2(x)/I0(x) = 1 - 2 r(x)/x

Piecewise polynomials indexed by the bits of the argument (:mod:`layout`, no
logarithm), the power series below them and the asymptotic series above, economized to the
same degree: every positive double is served by one polynomial, chosen without a branch.
Relative error at most 2.4 ULP (``pipeline/evidence/prove/``; on the points of
``tests/kernels/bessel/test_ratios.py``, against 60 digits, 2).  Slopes come from the Riccati equations

    r' = 1 - r/x - r^2      k' = k^2 + k/z - 1

and cost no further Bessel function.
"""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path

import numpy as np

from ..compile.intrinsics import fma, septic
from ..compile.jit import kernel
from ..numerics.bins import bin_number, bin_offset
from ..numerics.interpolation import Interpolation, chebyshev, horner, in_40_digits
from . import layout

TABLE = np.load(Path(__file__).with_name("ratios.npy"))

_BIN_BITS = 4  # log2(BINS)
_BINS = TABLE.reshape(-1, layout.COEFFICIENTS)


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


def asymptotic_series(sign: int, terms: int) -> list[Decimal]:
    """a_n of r (sign = -1) or k (sign = +1) = sum a_n x^-n, from the Riccati equations."""
    a = [Decimal(1)]
    for n in range(1, terms):
        products = sum(a[i] * a[n - i] for i in range(1, n))
        step = (n - 2) * a[-1] if sign < 0 else -n * a[-1]
        a.append((step - products) / 2)
    return a


_NEAR, _FAR = 0.0625, 64.0
#: below, k/z goes like a logarithm
K_LEAST = 2.0**-30


@in_40_digits
def _tail(sign: int) -> np.ndarray:
    """x (1 - r) or z (1 - k) above 64 as a polynomial in the inverse: the asymptotic series at Chebyshev's nodes."""
    series = [-a for a in asymptotic_series(sign, 17)[1:]]
    nodes = [(1 + x) / (2 * Decimal(_FAR)) for x in chebyshev(layout.COEFFICIENTS)]
    return Interpolation(nodes).coefficients([horner(series, w) for w in nodes])


_POWERS = np.array(_r_power_series(layout.COEFFICIENTS + 1))
#: every polynomial, all of one degree: the bins, then r/x and i2/x^2 in x^2 below them, and the tails above
_ROWS = np.vstack([_BINS, _POWERS[:-1], -2.0 * _POWERS[1:], _tail(-1), _tail(+1)])
_R_NEAR, _I2_NEAR, _R_FAR, _K_FAR = range(_BINS.shape[0], _ROWS.shape[0])
_EULER_GAMMA = 0.57721566490153286061
_LN2 = 0.69314718055994530942


@kernel
def _polynomial(row, t):
    """Polynomial number ``row`` at t."""
    c = _ROWS[row]
    return fma(t, septic(t, c[1:]), c[0])


@kernel(inline=True)
def ratio_r(x):
    """r = I1/I0 and 1 - r at x >= 0, both to full relative accuracy."""
    per_x = 1.0 / x
    # choices, not branches: those would be mispredicted on scattered arguments
    near, far = x < _NEAR, not x < _FAR  # a NaN is far: it must not become the number of a bin
    row = bin_number(x, _BIN_BITS) + (_R_SMALL if x < 2.0 else _R_LARGE)
    row = _R_NEAR if near else _R_FAR if far else row
    piece = _polynomial(row, x * x if near else per_x if far else bin_offset(x, _BIN_BITS))
    r, complement = x * piece, piece * per_x
    return r if x < 2.0 else 1.0 - complement, 1.0 - r if x < 2.0 else complement


@kernel(inline=True)
def ratio_k(z):
    """k = K0/K1 and 1 - k at z >= 0, both to full relative accuracy."""
    if z < K_LEAST:
        k = z * (_LN2 - _EULER_GAMMA - np.log(z)) if z > 0.0 else 0.0
        return k, 1.0 - k
    per_z, inside = 1.0 / z, z < _FAR
    row = bin_number(z, _BIN_BITS) + (_K_SMALL if z < 1.0 else _K_LARGE)
    piece = _polynomial(row if inside else _K_FAR, bin_offset(z, _BIN_BITS) if inside else per_z)
    k, complement = z * piece, piece * per_z
    return k if z < 1.0 else 1.0 - complement, 1.0 - k if z < 1.0 else complement


@kernel(inline=True)
def ratio_i2(x, r):
    """i2 = I2/I0 at x >= 0, given r(x)."""
    if not x < 4.0:  # or a NaN
        return 1.0 - 2.0 * r / x
    near = x < _NEAR
    row = _I2_NEAR if near else bin_number(x, _BIN_BITS) + _I2
    return x * x * _polynomial(row, x * x if near else bin_offset(x, _BIN_BITS))


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
