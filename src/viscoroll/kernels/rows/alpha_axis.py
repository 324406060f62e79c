"""Rows of an alpha each, by the axis of alpha: sums of Chebyshev's polynomials, with no root.

For alpha in [2^N, 2^(N+1)) every power of every function of a row is a sum over T_j(s), s = 2 log2(alpha/2^N) - 1, with
T_epsilon for the unit of time and M/V and epsilon over c = (alpha - 1)/alpha: their limits as alpha -> 1 are nothing
special.  Sums stay in registers, 24 numbers side by side.
"""

from __future__ import annotations

import math

import numpy as np

from ..compile.intrinsics import bits_to_float, float_to_bits, floats_at, integers_at, record_at
from ..compile.jit import kernel
from ..numerics.simd4 import LANES, load, pack, store
from .contact_states import element
from .newton_interpolation import matrix_vector_product
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
)

#: terms of a sum; numbers of a part of a row for all alphas of an octave
ALPHA_TERMS = 16
_PIECE = PART_SIZE * ALPHA_TERMS
#: parts of a row of the axis: (L, M/V) and (lam, epsilon), two each, H/F^2, eta/F
ALPHA_PARTS = 6
#: exponent of the first row, for all alphas
ALPHA_E0 = -4
#: what these kernels know: addresses of the record's arrays, of alpha, how many (one, or one a state), and for every
#: octave of alpha the address of its numbers and how many rows it has
SOURCE = np.dtype([(name, np.int64) for name in ("rows", "marks", "alpha", "state_count", "octaves")])
#: where T_j begin among the numbers in front of the rows; the mark that is the address of the octave that is held
_WEIGHTS, _OCTAVE = MAKER_NUMBERS, MAKER_MARKS
_EXPONENT, _MANTISSA, _ONE = 1023, (1 << 52) - 1, 1023 << 52
#: the two numbers of the fast limit are c and this times c
_FAST = math.log(2.0) - float(np.euler_gamma)


@kernel(allocates=True)
def select_alpha(n, source):
    """:func:`record.hold`."""
    given = record_at(source)
    alpha, rows = element(floats_at(given.alpha, given.state_count), n), floats_at(given.rows, ROW_SIZE)
    if alpha != rows[ALPHA]:
        word = float_to_bits(alpha)
        octave = (word >> 52) - _EXPONENT
        marks, octaves = integers_at(given.marks, PARTS_PER_ROW), integers_at(given.octaves, 2 * octave + 2)
        s = 2.0 * np.log2(bits_to_float((word & _MANTISSA) | _ONE)) - 1.0
        rows[_WEIGHTS], rows[_WEIGHTS + 1] = 1.0, s
        for j in range(2, ALPHA_TERMS):
            at = _WEIGHTS + j
            rows[at] = 2.0 * rows[at - j // 2] * rows[at - j + j // 2] - rows[at - j + j % 2]
        c = (alpha - 1.0) / alpha
        rows[ALPHA], rows[LAM_FAST], rows[FAST_TOTAL], rows[FAST_TOTAL + 1] = alpha, 1.0 / np.sqrt(alpha), c, c * _FAST
        marks[VERSION] += 1
        marks[_OCTAVE], marks[ROW_COUNT] = octaves[2 * octave], octaves[2 * octave + 1] if alpha > 1.0 else 1


@kernel(allocates=True)
def make_part(start, source):
    """A part of a row, but those of bodies, which are alike; at alpha = 1, where a sum would round, its closed form."""
    given = record_at(source)
    rows, marks = floats_at(given.rows, start + 2 * PART_SIZE), integers_at(given.marks, start // PART_SIZE + 1)
    part, c = start % ROW_SIZE, rows[FAST_TOTAL]
    piece = part // PART_SIZE - (2 if part >= H_OVER_F2 else 0)
    axis = floats_at(marks[_OCTAVE] + ((start // ROW_SIZE - 1) * ALPHA_PARTS + piece) * _PIECE * 8, 2 * _PIECE)
    terms = ALPHA_TERMS if c > 0.0 else 0
    _sum(axis, 0, terms, c if part < H_OVER_F2 else 1.0, rows, start)
    if part < H_OVER_F2:
        _sum(axis, _PIECE, terms, c, rows, start + PART_SIZE)
    if c == 0.0:
        rows[start] = 1.0
    marks[start // PART_SIZE] = marks[VERSION]


@kernel(inline=True)
def _sum(axis, at, terms, c, rows, to):
    """Twenty-four numbers of a row, every third and fourth times c."""
    matrix_vector_product(axis, at, terms, _WEIGHTS, to, rows)
    for k in range(0, PART_SIZE, LANES):
        store(rows, to + k, pack(1.0, 1.0, c, c) * load(rows, to + k))
