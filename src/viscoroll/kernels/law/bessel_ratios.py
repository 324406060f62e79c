"""Ratios of modified Bessel functions, from a table of coefficients, and their slopes.

    r(x) = I1(x)/I0(x)      k(z) = K0(z)/K1(z)      i2(x) = I2(x)/I0(x) = 1 - 2 r(x)/x

The whole contact law is computed from them.  Each is a piecewise polynomial, whose bin is found
from the bits of the argument without a logarithm.  Below the bins it is the power series, above
them the asymptotic series, economized to the same degree.  So one polynomial is evaluated for each
argument, selected without a branch, with two exceptions: k below 2^-30 is computed by a logarithm,
and i2 from 4 on from r.  The relative error is at most 2.4 ULP (``pipeline/evidence/prove/``), and
at most 2 ULP at the points of ``tests/kernels/bessel/test_ratios.py``, which are compared with 60
digits.  Slopes come from the Riccati equations

    r' = 1 - r/x - r^2      k' = k^2 + k/z - 1

and need no further Bessel function.

The layout of the coefficient table ``ratios.npy`` is shared by its builder and its reader.  Each
segment covers whole octaves ``[2**low, 2**high)`` of its argument.  An octave is cut into
:data:`BINS` equal bins of the mantissa m in [1, 2); in each bin the function is a polynomial of
degree :data:`DEGREE` in t = m - (centre of the bin), constant term first.  A bin spans 1/33 of the
distance to the nearest singularity of the function (the origin for k), so the truncation error
falls like 66**-(DEGREE + 1) = 4e-17.
"""

from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..numerics.interpolation import Interpolation, chebyshev, in_40_digits
from ..numerics.intrinsics import bin_number, bin_offset, fma, septic
from ..numerics.jit import inline_kernel, kernel

# --- Layout of the coefficient table ratios.npy, shared by its builder and its reader ---

#: Bins of an octave.
BINS = 16
#: Degree of a polynomial: the truncation error is below a quarter of the rounding of doubles.
DEGREE = 8
#: Coefficients of a polynomial.
COEFFICIENTS = DEGREE + 1


class Segment(NamedTuple):
    """Octaves [2**low, 2**high) of one tabulated function.

    function : str, formula of the function, in the symbols of the module.
    low, high : int, exponents of the ends.
    """

    function: str
    low: int
    high: int


#: Segments of the table, in their order.
SEGMENTS = (
    Segment("r(x)/x", -4, 1),
    Segment("x (1 - r(x))", 1, 6),
    Segment("k(z)/z", -30, 0),
    Segment("z (1 - k(z))", 0, 6),
    Segment("i2(x)/x^2", -4, 2),
)


def segment_start(index: int) -> int:
    """Return the position, an int, of the first coefficient of segment number ``index``, from 0, in
    the flat table; for ``index`` = number of segments it is the size of the table.
    """
    return sum((s.high - s.low) * BINS * COEFFICIENTS for s in SEGMENTS[:index])


# --- The three Bessel ratios and their slopes ---

#: Coefficients of the bins, as the module says.
TABLE = np.load(Path(__file__).with_name("ratios.npy"))

#: Leading bits of the mantissa that number a bin: log2(BINS).
_BIN_BITS = 4
#: One row of coefficients for each bin.
_BINS = TABLE.reshape(-1, COEFFICIENTS)


def _row_offset(index: int) -> int:
    """Return the offset of a segment: the int that, added to the number of a bin
    (:func:`.bin_number`, with 4 bits) in the segment, gives the row of the bin in the table.

    index : int, number of the segment in :data:`SEGMENTS`.
    """
    return segment_start(index) // COEFFICIENTS - ((1023 + SEGMENTS[index].low) << _BIN_BITS)


#: Offset of the rows of r(x)/x, x < 2, to be added to a bin number; so the offsets below.
_R_SMALL = _row_offset(0)
#: Offset of the rows of x (1 - r), x >= 2.
_R_LARGE = _row_offset(1)
#: Offset of the rows of k(z)/z, z < 1.
_K_SMALL = _row_offset(2)
#: Offset of the rows of z (1 - k), z >= 1.
_K_LARGE = _row_offset(3)
#: Offset of the rows of i2(x)/x^2, x < 4.
_I2 = _row_offset(4)
#: Argument below which r and i2 come from their power series.
_NEAR = 0.0625
#: Argument from which on r and k come from their asymptotic series.
_FAR = 64.0
#: Argument below which k/z is a logarithm, to rounding.
K_LEAST = 2.0**-30


def _r_power_series(terms: int) -> list[float]:
    """Return coefficients of the power series of r(x) = sum c_n x^(2n+1), from the Riccati
    equation.

    terms : int, number of coefficients, > 0.
    Returns [c_0 = 0.5, c_1, ...], ``terms`` floats.
    """
    c = [0.5]
    for n in range(1, terms):
        c.append(-sum(c[i] * c[n - 1 - i] for i in range(n)) / (2 * n + 2))
    return c


def asymptotic_series(sign: int) -> list[Decimal]:
    """Return the first 17 coefficients a_n of the asymptotic series sum a_n x^-n of r or k, by the
    Riccati equations.

    sign : int, -1 for r = I1/I0, 1 for k = K0/K1.
    Returns [a_0 = 1, a_1, ...], a list of 17 Decimals, with the digits of the current decimal
    context.
    """
    # Coefficients of x^-n in the Riccati equation: r^2 or k^2 has 2 a_0 a_n + ``products``, the
    # derivative -(n - 1) a_(n-1), r/x or k/z has a_(n-1).
    a = [Decimal(1)]
    for n in range(1, 17):
        products = sum(a[i] * a[n - i] for i in range(1, n))
        step = (n - 2) * a[-1] if sign < 0 else -n * a[-1]
        a.append((step - products) / 2)
    return a


@in_40_digits
def _tail(sign: int) -> np.ndarray:
    """Return the coefficients of a polynomial in 1/x for x (1 - r), or in 1/z for z (1 - k), for
    arguments above 64.

    The polynomial interpolates 16 terms of the asymptotic series of the function at Chebyshev nodes
    in [0, 1/64].

    sign : int, -1 for r, 1 for k.
    Returns the 9 coefficients (COEFFICIENTS) of ascending powers of 1/x or 1/z, the constant
    1/2 first, doubles.
    """
    series = [-a for a in asymptotic_series(sign)[1:]]
    nodes = [(1 + x) / (2 * Decimal(_FAR)) for x in chebyshev(COEFFICIENTS)]
    return Interpolation(nodes).coefficients(polyval(np.array(nodes), series))


#: Coefficients of the power series of r.
_POWERS = np.array(_r_power_series(COEFFICIENTS + 1))
#: All polynomials, of one degree: those of the bins, then r/x and i2/x^2 below the bins, in x^2,
#: and x (1 - r) and z (1 - k) above the bins, in 1/x and 1/z.
_ROWS = np.vstack([_BINS, _POWERS[:-1], -2.0 * _POWERS[1:], _tail(-1), _tail(+1)])
#: Row of r/x below the bins, a number of a row without an offset; so the rows below.
_R_NEAR = _BINS.shape[0]
#: Row of i2/x^2 below the bins.
_I2_NEAR = _R_NEAR + 1
#: Row of x (1 - r) above the bins.
_R_FAR = _R_NEAR + 2
#: Row of z (1 - k) above the bins.
_K_FAR = _R_NEAR + 3
#: Euler's constant.
_EULER_GAMMA = 0.57721566490153286061
#: ln 2.
_LN2 = 0.69314718055994530942


@kernel
def _polynomial(row, t):
    """Return the value at t, a float, of the polynomial in row ``row``, an int, of the table
    ``_ROWS``; a float.
    """
    c = _ROWS[row]
    return fma(t, septic(t, c[1:]), c[0])


@inline_kernel
def ratio_r(x):
    """Return the ratio r = I1/I0 of modified Bessel functions and 1 - r, both to full relative
    accuracy (2.4 ULP).

    x : argument, float >= 0, dimensionless; may be infinite.
    Returns (r, 1 - r), floats, dimensionless: (0, 1) at x = 0; (1, 0) at infinity; NaNs of a NaN.
    1 - r falls like 1/(2 x) and is computed without cancellation, so that it keeps its digits where
    r itself is rounded to 1.0, from x = 1e16 or so on.
    """
    inverse_x = 1.0 / x  # infinite at x = 0, where the product with it is not selected
    # selections, not branches: those would be mispredicted on scattered arguments
    near = x < _NEAR
    far = not x < _FAR  # also True of NaN, whose bits are no valid bin
    # in the bins the offset of the segment of x gives the row; outside of them the row is fixed
    row = bin_number(x, _BIN_BITS) + (_R_SMALL if x < 2.0 else _R_LARGE)
    row = _R_NEAR if near else _R_FAR if far else row
    # r/x below 2, x (1 - r) from there on; the argument is that of the row (_ROWS): x^2, 1/x or the
    # distance from the centre of the bin
    piece = _polynomial(row, x * x if near else inverse_x if far else bin_offset(x, _BIN_BITS))
    r = x * piece
    complement = piece * inverse_x
    # (r, 1 - r): below 2 ``piece`` gives r, from there on 1 - r; the other one is 1 minus it
    return r if x < 2.0 else 1.0 - complement, 1.0 - r if x < 2.0 else complement


@inline_kernel
def ratio_k(z):
    """Return the ratio k = K0/K1 of modified Bessel functions and 1 - k, both to full relative
    accuracy (2.4 ULP).

    z : argument, float >= 0, dimensionless; may be infinite.
    Returns (k, 1 - k), floats, dimensionless: (0, 1) at z = 0; (1, 0) at infinity; NaNs of a NaN.
    1 - k falls like 1/(2 z) and is computed without cancellation, so that it keeps its digits where
    k itself is rounded to 1.0, from z = 1e16 or so on.
    """
    if z < K_LEAST:
        # K0 = ln 2 - gamma - ln z and K1 = 1/z, to rounding; 0 ln 0 would be a NaN
        k = z * (_LN2 - _EULER_GAMMA - np.log(z)) if z > 0.0 else 0.0
        return k, 1.0 - k
    inverse_z = 1.0 / z
    inside = z < _FAR  # False for NaN, whose bits are no valid bin
    row = bin_number(z, _BIN_BITS) + (_K_SMALL if z < 1.0 else _K_LARGE)
    # k/z below 1, z (1 - k) from there on, in the argument of the row
    piece = _polynomial(
        row if inside else _K_FAR, bin_offset(z, _BIN_BITS) if inside else inverse_z
    )
    k = z * piece
    complement = piece * inverse_z
    # (k, 1 - k), as in ratio_r
    return k if z < 1.0 else 1.0 - complement, 1.0 - k if z < 1.0 else complement


@inline_kernel
def ratio_i2(x, r):
    """Return the ratio i2 = I2/I0 = 1 - 2 r/x of modified Bessel functions, to 2.4 ULP.

    x : argument, float >= 0, dimensionless; may be infinite.
    r : float, r(x) of :func:`ratio_r`, from which i2 is computed for x >= 4; not read for x < 4.
    Returns a float, dimensionless: less than 1 in exact numbers, but rounded to 1.0 from x = 4e16
    or so on; subnormal, with fewer digits, below x = 1e-153 or so, and 0 below 1e-162 and at x = 0;
    NaN of a NaN.
    """
    if not x < 4.0:  # also True of NaN; below 4 this difference would lose digits
        return 1.0 - 2.0 * r / x
    near = x < _NEAR
    row = _I2_NEAR if near else bin_number(x, _BIN_BITS) + _I2
    return x * x * _polynomial(row, x * x if near else bin_offset(x, _BIN_BITS))


@inline_kernel
def slope_r(x, r, complement):
    """Return the derivative r'(x) = (1 - r)(1 + r) - r/x of r = I1/I0.

    x : argument, float >= 0, dimensionless.
    r, complement : floats, r and 1 - r at x, from :func:`ratio_r`; not read below x = 1e-8.
    Returns a float, dimensionless, from 0.5 at x = 0 (and, to rounding, below 1e-8) down to 0 at
    infinity; NaN of a NaN.  At large x, where the slope falls like 1/(2 x^2), the two terms cancel:
    its relative error is x roundings or so, and from x = 2e15 or so on it may be 0.
    """
    if x < 1e-8:
        return 0.5
    return complement * (1.0 + r) - r / x


@inline_kernel
def slope_k(z, k, complement):
    """Return the derivative k'(z) = k/z - (1 - k)(1 + k) of k = K0/K1.

    z : argument, float > 0, dimensionless; 0, where the slope is infinite, gives NaN.
    k, complement : floats, k and 1 - k at z, from :func:`ratio_k`.
    Returns a float, dimensionless, > 0, which grows like -ln z as z -> 0; 0 at infinity; NaN of a
    NaN.  At large z, where the slope falls like 1/(2 z^2), the two terms cancel: its relative error
    is z roundings or so, and from z = 2e15 or so on it may be 0.
    """
    return k / z - complement * (1.0 + k)
