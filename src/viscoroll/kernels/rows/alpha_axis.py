"""Rows for one alpha after another, by the axis of alpha: sums of Chebyshev polynomials, without root finding.

For alpha in [2^N, 2^(N+1)) every coefficient of a row is a sum over T_j(s), s = 2 log2(alpha/2^N) - 1, with T_epsilon
as unit of time, and with M/V and epsilon divided by c = (alpha - 1)/alpha.  Their limits as alpha -> 1 then need no
special case.  Sums stay in registers, 24 numbers side by side.
"""

import math

import numpy as np

from ..compile.intrinsics import bits_to_float, float_to_bits, floats_at, integers_at, record_at, record_type
from ..compile.jit import inline_kernel, kernel
from ..numerics.simd4 import LANES, load, pack, store
from .contact_states import element
from .newton_interpolation import sum_of_rows
from .record import (
    ALPHA,
    FAST_TOTAL,
    H_OVER_F2,
    LAM_FAST,
    MAKER_MARKS,
    MAKER_NUMBERS,
    PART_SIZE,
    PARTS_PER_ROW,
    ROW_COUNT,
    ROW_SIZE,
    VERSION,
)  # fmt: skip

#: Chebyshev polynomials of a sum: the 17th changes no digit of a double.
ALPHA_TERMS = 16
#: Numbers of a part of a row for all alphas of an octave.
_AXIS_SIZE = PART_SIZE * ALPHA_TERMS
#: Parts of a row on the axis: (L, M/V) and (lam, epsilon), two each, H/F^2, eta/F; moments of like bodies are halves.
ALPHA_PARTS = 6
#: Exponent of the first row, for all alphas.
ALPHA_E0 = -4
#: What these kernels read.  Addresses: rows and marks of the law; alpha; for each octave of alpha the address of its
#: axis and its number of rows.  state_count: length of alpha, 1 or one for each state.
SOURCE = record_type("rows marks alpha state_count octaves")
#: Index in the head of the rows where the values T_j(s) begin.
_CHEBYSHEV = MAKER_NUMBERS
#: Mark that is the address of the axis of the selected octave.
_AXIS = MAKER_MARKS
#: Bias of the exponent of a double.
_BIAS = 1023
#: Mask of the mantissa of a double.
_MANTISSA = (1 << 52) - 1
#: C divided by W of the fast limit, where the one creep time is the unit.
_FAST_RATIO = math.log(2.0) - float(np.euler_gamma)


@kernel(allocates=True)
def select_alpha(n, source):
    """Make the alpha of a state the selected one: write its data into the heads of rows and marks, and outdate all
    parts.

    n : number of the state.  source : pointer to a SOURCE record, with the addresses of alpha, rows and marks.

    Rows of the law are then computed when they are first read (:func:`make_part`).  Nothing is done if the alpha is
    selected already.
    """
    source = record_at(source)
    alpha = element(floats_at(source.alpha, source.state_count), n)
    rows = floats_at(source.rows, ROW_SIZE)
    if alpha != rows[ALPHA]:
        bits = float_to_bits(alpha)
        octave = (bits >> 52) - _BIAS
        marks = integers_at(source.marks, PARTS_PER_ROW)
        octaves = integers_at(source.octaves, 2 * octave + 2)
        s = 2.0 * np.log2(bits_to_float((bits & _MANTISSA) | (_BIAS << 52))) - 1.0
        rows[_CHEBYSHEV] = 1.0
        rows[_CHEBYSHEV + 1] = s
        for j in range(2, ALPHA_TERMS):
            at = _CHEBYSHEV + j
            rows[at] = 2.0 * rows[at - j // 2] * rows[at - j + j // 2] - rows[at - j + j % 2]
        c = (alpha - 1.0) / alpha
        rows[ALPHA] = alpha
        rows[LAM_FAST] = 1.0 / np.sqrt(alpha)
        rows[FAST_TOTAL] = c
        rows[FAST_TOTAL + 1] = c * _FAST_RATIO
        marks[VERSION] += 1
        marks[_AXIS] = octaves[2 * octave]
        marks[ROW_COUNT] = octaves[2 * octave + 1] if alpha > 1.0 else 1


@kernel(allocates=True)
def make_part(start, source):
    """Compute a part of a row of the selected alpha, except the moments of the bodies, and write it into the rows.

    start : position of the part in the rows.
    source : pointer to a SOURCE record, with the addresses of alpha, rows and marks.

    The moments of like bodies are halves of M.  At alpha = 1, where a sum would round, the closed form is written.
    """
    source = record_at(source)
    rows = floats_at(source.rows, start + 2 * PART_SIZE)
    marks = integers_at(source.marks, start // PART_SIZE + 1)
    part = start % ROW_SIZE
    c = rows[FAST_TOTAL]
    axis_part = part // PART_SIZE - (2 if part >= H_OVER_F2 else 0)
    address = marks[_AXIS] + ((start // ROW_SIZE - 1) * ALPHA_PARTS + axis_part) * _AXIS_SIZE * 8
    axis = floats_at(address, 2 * _AXIS_SIZE)
    terms = ALPHA_TERMS if c > 0.0 else 0
    _sum_axis(axis, 0, terms, c if part < H_OVER_F2 else 1.0, rows, start)
    if part < H_OVER_F2:
        _sum_axis(axis, _AXIS_SIZE, terms, c, rows, start + PART_SIZE)
    if c == 0.0:
        rows[start] = 1.0
    marks[start // PART_SIZE] = marks[VERSION]


@inline_kernel
def _sum_axis(axis, first, terms, c, rows, to):
    """Write 24 coefficients of a row: sums over the Chebyshev polynomials T_j(s) of alpha.

    axis : Chebyshev coefficients of the octave of alpha, a vector.
    first : position in ``axis`` where those of the part begin.
    terms : number of polynomials T_j.
    c : factor of every third and fourth coefficient, (alpha - 1)/alpha.
    rows : read (values T_j(s)) and written.
    to : position in ``rows`` of the first coefficient that is written.
    """
    sum_of_rows(axis, first, terms, _CHEBYSHEV, to, rows)
    for k in range(0, PART_SIZE, LANES):
        store(rows, to + k, pack(1.0, 1.0, c, c) * load(rows, to + k))
