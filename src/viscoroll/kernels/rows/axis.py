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
from ..numerics.four import LANES, four, load, store
from .newton import product
from .record import ALPHA, COUNT, LOW, OWN, OWN_MARKS, PART, PARTS, PRESS, STAMP, WHOLE, WIDTH
from .states import element

#: terms of a sum; numbers of a part of a row for all alphas of an octave
TERMS_OF_ALPHA = 16
_PIECE = PART * TERMS_OF_ALPHA
#: parts of a row of the axis: (L, M/V) and (lam, epsilon), two each, H/F^2, eta/F
PIECES = 6
#: exponent of the first row, for all alphas
E0_OF_ALPHA = -4
#: what these kernels know: addresses of the record's arrays, of alpha, how many (one, or one a state), and for every
#: octave of alpha the address of its numbers and how many rows it has
SOURCE = np.dtype([(name, np.int64) for name in ("rows", "marks", "alpha", "count", "octaves")])
#: where T_j begin among the numbers in front of the rows; the mark that is the address of the octave that is held
_WEIGHTS, _OCTAVE = OWN, OWN_MARKS
_EXPONENT, _MANTISSA, _ONE = 1023, (1 << 52) - 1, 1023 << 52
#: the two numbers of the fast limit are c and this times c
_FAST = math.log(2.0) - float(np.euler_gamma)


@kernel(allocates=True)
def hold(n, source):
    """:func:`record.hold`."""
    given = record_at(source)
    alpha, rows = element(floats_at(given.alpha, given.count), n), floats_at(given.rows, WIDTH)
    if alpha != rows[ALPHA]:
        word = float_to_bits(alpha)
        octave = (word >> 52) - _EXPONENT
        marks, octaves = integers_at(given.marks, PARTS), integers_at(given.octaves, 2 * octave + 2)
        s = 2.0 * np.log2(bits_to_float((word & _MANTISSA) | _ONE)) - 1.0
        rows[_WEIGHTS], rows[_WEIGHTS + 1] = 1.0, s
        for j in range(2, TERMS_OF_ALPHA):
            at = _WEIGHTS + j
            rows[at] = 2.0 * rows[at - j // 2] * rows[at - j + j // 2] - rows[at - j + j % 2]
        c = (alpha - 1.0) / alpha
        rows[ALPHA], rows[LOW], rows[WHOLE], rows[WHOLE + 1] = alpha, 1.0 / np.sqrt(alpha), c, c * _FAST
        marks[STAMP] += 1
        marks[_OCTAVE], marks[COUNT] = octaves[2 * octave], octaves[2 * octave + 1] if alpha > 1.0 else 1


@kernel(allocates=True)
def make(start, source):
    """A part of a row, but those of bodies, which are alike; at alpha = 1, where a sum would round, its closed form."""
    given = record_at(source)
    rows, marks = floats_at(given.rows, start + 2 * PART), integers_at(given.marks, start // PART + 1)
    part, c = start % WIDTH, rows[WHOLE]
    piece = part // PART - (2 if part >= PRESS else 0)
    axis = floats_at(marks[_OCTAVE] + ((start // WIDTH - 1) * PIECES + piece) * _PIECE * 8, 2 * _PIECE)
    terms = TERMS_OF_ALPHA if c > 0.0 else 0
    _sum(axis, 0, terms, c if part < PRESS else 1.0, rows, start)
    if part < PRESS:
        _sum(axis, _PIECE, terms, c, rows, start + PART)
    if c == 0.0:
        rows[start] = 1.0
    marks[start // PART] = marks[STAMP]


@kernel(inline=True)
def _sum(axis, at, terms, c, rows, to):
    """Twenty-four numbers of a row, every third and fourth times c."""
    product(axis, at, terms, _WEIGHTS, to, rows)
    for k in range(0, PART, LANES):
        store(rows, to + k, four(1.0, 1.0, c, c) * load(rows, to + k))
