"""Rows for one alpha after another, by the axis of alpha: polynomials in ln alpha, without root
finding.

For alpha in [2^N, 2^(N+1)) every coefficient of a row is a sum of T_4g(s) (c_0 + c_1 s + c_2 s^2 +
c_3 s^3) for g = 0, 1, 2, 3, with Chebyshev polynomials of s = 2 log2(alpha/2^N) - 1, with T_epsilon
as unit of time, and with M/V and epsilon divided by c = (alpha - 1)/alpha.  Their limits as
alpha -> 1 then need no special case.  Powers of s alone would lose digits near alpha = 2^N, and a
T_j for every coefficient would take a third more loads.  The higher a power of t, the fewer groups
change a digit.  So of the blocks of eight coefficients only the first ones have all four groups in
most rows.

Here alpha = T_epsilon/T_sigma is the instantaneous divided by the long-time modulus.  Heads, rows,
their parts, marks and versions are those of :mod:`law_record`; the functions and the fast limit
beyond the last row are those of :mod:`law_functions`.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

import math

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types

from ..numerics.intrinsics import (
    bits_to_float,
    float_to_bits,
    floats_at,
    fma,
    integers_at,
    make_intrinsic,
    record_at,
    record_type,
)
from ..numerics.jit import kernel
from ..numerics.simd import broadcast_value, fma_vectors, vector_pointers
from .law_record import (
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
    element,
)

#: Largest number of Chebyshev polynomials of s: the 17th changes no digit of a double.
ALPHA_TERMS = 16
#: Numbers of a block, a vector: with more of them fewer terms in s are negligible, with less the
#: ends of sums count.  Processors without vectors of eight numbers take two of four.
BLOCK_SIZE = 8
#: Blocks of a part, the coefficients of one polynomial.
PART_BLOCKS = PART_SIZE // BLOCK_SIZE
#: Terms of a group, a cubic polynomial in s.
GROUP = 4
#: Groups of the blocks of (L, M/V), (lam, epsilon), H/F^2 and eta/F in most rows; bodies are alike
#: and not on the axis.
SHORT = (4, 4, 2, 2, 1, 1), (4, 4, 2, 2, 1, 1), (4, 3, 2), (4, 3, 2)
#: Functions of a row, or pairs of them, on the axis.
ALPHA_FUNCTIONS = len(SHORT)
#: Groups of a block in the other rows.
FULL = ALPHA_TERMS // GROUP
#: Exponent of the first row, for all alphas.
ALPHA_E0 = -4
#: What these kernels read.  Addresses: rows and marks of the law; alpha; for each octave of alpha
#: the addresses of its axis and of where functions begin in it, and its number of rows.
#: state_count: length of alpha, 1 or one for each state.
SOURCE = record_type("rows marks alpha state_count octaves")
#: Integers of an octave in SOURCE.
OCTAVE_SIZE = 3
#: Index in the head of the rows of s, T_4(s), T_8(s) and T_12(s).
_S = MAKER_NUMBERS
#: Mark that is the address of the axis of the selected octave; after it that of where functions
#: begin, in groups.
_AXIS = MAKER_MARKS
#: Binary logarithm of the parts of a row.
_PARTS_EXPONENT = PARTS_PER_ROW.bit_length() - 1
#: Bias of the exponent of a double.
_BIAS = 1023
#: Mask of the mantissa of a double.
_MANTISSA = (1 << 52) - 1
#: C divided by W of the fast limit, where the one creep time is the unit.
_FAST_RATIO = math.log(2.0) - float(np.euler_gamma)
#: LLVM's type of a block.
_BLOCK = ir.VectorType(ir.DoubleType(), BLOCK_SIZE)


def _make_sum(lengths):
    """Return a kernel that writes one part of a row, or two: in each block the sum of cubic
    polynomials times T_4g(s).

    lengths : tuple of ints, the number of groups g of each block, 1 to 4; loops of a length that
        varies cost more than they save.

    Returns the kernel, an intrinsic of numba, which takes (axis, first, s, c, rows, to) and returns
    nothing:

    - axis, first: vector of coefficients, and int, index in it where those of the part begin; of
      each block the group of the highest degree first, of each group the coefficients of s^0 to
      s^3, eight numbers each.
    - s: tuple of the four floats s, T_4(s), T_8(s) and T_12(s).
    - c: float, factor of the second function of a pair, (alpha - 1)/alpha, which multiplies the
      numbers at the indices 2, 3, 6 and 7 of each block; 1 of a single function.
    - rows, to: vector that is written, and int, index of the first number written, BLOCK_SIZE for
      each block.
    """

    def lower(context, builder, signature, arguments):
        """Return the instructions of the kernel; numba calls this function for every call of the
        kernel.

        context, builder, signature, arguments : numba's context of code generation, builder of
            LLVM, signature of the call, and values of LLVM of its arguments (axis, first, s, c,
            rows, to).
        Returns numba's dummy value: the kernel returns nothing.
        """
        axis, first, numbers, c, rows, to = arguments
        one, zero = (ir.Constant(_BLOCK, [x] * BLOCK_SIZE) for x in (1.0, 0.0))
        power, *chebyshev = (
            broadcast_value(builder, x, _BLOCK) for x in cgutils.unpack_tuple(builder, numbers)
        )
        square = builder.fmul(power, power)
        factor = one
        for n in (2, 3, 6, 7):
            factor = builder.insert_element(factor, c, ir.IntType(32)(n))
        count = GROUP * sum(lengths)
        pointers = vector_pointers(context, builder, signature.args[0], axis, first, count, _BLOCK)
        # one load after the other: what is loaded before the store of another block has to be kept
        # in registers
        terms = (builder.load(pointer, align=8) for pointer in pointers)
        targets = vector_pointers(
            context, builder, signature.args[4], rows, to, len(lengths), _BLOCK
        )
        for length, target in zip(lengths, targets):
            total = zero
            # from the highest T_4g down, as the groups are stored; a cubic as two linear parts in
            # s, which do not wait for one another
            for T in reversed([one, *chebyshev][:length]):
                low, linear, high, cubic = (next(terms) for _ in range(GROUP))
                low = fma_vectors(builder, linear, power, low)
                high = fma_vectors(builder, cubic, power, high)
                total = fma_vectors(builder, fma_vectors(builder, high, square, low), T, total)
            builder.store(builder.fmul(total, factor), target, align=8)
        return context.get_dummy_value()

    numbers = types.UniTuple(types.float64, FULL)
    return make_intrinsic(
        lower, types.void, None, types.int64, numbers, types.float64, None, types.int64
    )


_sum_short_pair = _make_sum(SHORT[0])
_sum_full_pair = _make_sum([FULL] * 2 * PART_BLOCKS)
_sum_short = _make_sum(SHORT[2])
_sum_full = _make_sum([FULL] * PART_BLOCKS)


@kernel(allocates=True)
def select_alpha(n, source):
    """Make the alpha of a state the selected one: write its data into the heads of rows and marks,
    and outdate all parts.

    n : int, index of the state, >= 0, of those for which the law was made; not checked.
    source : pointer to a SOURCE record, with the addresses of alpha (1 to 1e12, of length 1 or one
        for each state, in octaves whose axes are made, which is not checked), octaves, rows and
        marks.  If that alpha is selected already, nothing is written.  Else into the head of rows
        are written alpha, its lam, W and C in the fast limit (of both bodies together only) and the
        Chebyshev polynomials of s, into that of marks a new version, the addresses of the axis of
        its octave, and the number of rows: that of its octave, for alpha = 1 only 1.

    Rows of the law are then computed when they are first read (:func:`make_part`).  Returns
    nothing.
    """
    source = record_at(source)
    alpha = element(floats_at(source.alpha, source.state_count), n)
    rows = floats_at(source.rows, ROW_SIZE)
    # rows[ALPHA] is 0 before the first call, which no alpha equals
    if alpha != rows[ALPHA]:
        bits = float_to_bits(alpha)
        octave = (bits >> 52) - _BIAS  # exponent N of alpha, >= 0, from its bits: no sign to mask
        marks = integers_at(source.marks, PARTS_PER_ROW)
        first = OCTAVE_SIZE * octave
        octaves = integers_at(source.octaves, first + OCTAVE_SIZE)
        # The mantissa of alpha in [1, 2) is alpha/2^N.
        s = 2.0 * np.log2(bits_to_float((bits & _MANTISSA) | (_BIAS << 52))) - 1.0
        # T_2; then T_4 = 2 T_2^2 - 1, T_8 = 2 T_4^2 - 1 and T_12 = T_4 (2 T_8 - 1), each difference
        # rounded once.
        second = fma(2.0 * s, s, -1.0)
        rows[_S] = s
        rows[_S + 1] = fma(2.0 * second, second, -1.0)
        rows[_S + 2] = fma(2.0 * rows[_S + 1], rows[_S + 1], -1.0)
        rows[_S + 3] = rows[_S + 1] * fma(2.0, rows[_S + 2], -1.0)
        # The fast limit of one creep mode, J_1 = c and T_1 = 1: W = c, C = c (ln 2 - 0.5772).
        c = (alpha - 1.0) / alpha
        rows[ALPHA] = alpha
        rows[LAM_FAST] = 1.0 / np.sqrt(alpha)
        rows[FAST_TOTAL] = c
        rows[FAST_TOTAL + 1] = c * _FAST_RATIO
        marks[VERSION] += 1  # all parts that were made before are outdated
        marks[_AXIS] = octaves[first]
        marks[_AXIS + 1] = octaves[first + 1]
        # alpha = 1: beyond row 0 the fast limit with W = C = 0 is exact, and needs no rows
        marks[ROW_COUNT] = octaves[first + 2] if alpha > 1.0 else 1


@kernel(allocates=True)
def make_part(number, source):
    """Compute a part of a row of the selected alpha, and write it into the rows of the law.

    number : int, index of the part among the marks: (row + 1) PARTS_PER_ROW + offset of the part in
        the row/PART_SIZE.  The part may not be BODY_MOMENTS, the moments of the bodies, which are
        not on the axis: of like bodies they are halves of M.
    source : pointer to a SOURCE record, with the addresses of rows and marks.  The 24 coefficients
        of a function, or 48 of a pair, interleaved (:mod:`.simd`), are written, and as
        mark ``number`` the version of alpha.

    At alpha = 1, where a sum would round, the closed form is written: L, lam, H/F^2 and eta/F are
    1, M/V and epsilon are 0.  Returns nothing.
    """
    source = record_at(source)
    start = PART_SIZE * number
    rows = floats_at(source.rows, start + 2 * PART_SIZE)
    marks = integers_at(source.marks, number + 1)
    # by shifts: a division would delay the loads by as long as the sums take
    part = number & (PARTS_PER_ROW - 1)
    row = (number >> _PARTS_EXPONENT) - 1
    c = rows[FAST_TOTAL]  # (alpha - 1)/alpha
    pair = part < H_OVER_F2 // PART_SIZE
    # Parts 0 and 2 are the pairs, functions 0 and 1 of a row on the axis; parts 6 and 7 the single
    # functions, 2 and 3.  ``begins`` counts groups of four vectors of eight numbers.
    function = row * ALPHA_FUNCTIONS + (part >> 1 if pair else part - ALPHA_FUNCTIONS)
    begins = integers_at(marks[_AXIS + 1], function + 2)
    size = BLOCK_SIZE * GROUP
    first = size * begins[function]
    stop = size * begins[function + 1]
    axis = floats_at(marks[_AXIS], stop)
    # read once: stores to rows could change them for all that the compiler knows
    s = rows[_S], rows[_S + 1], rows[_S + 2], rows[_S + 3]
    if c == 0.0:  # alpha = 1: the constant of the first function is 1, all other numbers are 0
        for k in range(start, start + (2 * PART_SIZE if pair else PART_SIZE)):
            rows[k] = 0.0
        rows[start] = 1.0
    elif pair:  # A part with fewer coefficients than all groups have is one of the short ones.
        if stop - first < 2 * PART_SIZE * ALPHA_TERMS:
            _sum_short_pair(axis, first, s, c, rows, start)
        else:
            _sum_full_pair(axis, first, s, c, rows, start)
    elif stop - first < PART_SIZE * ALPHA_TERMS:
        _sum_short(axis, first, s, 1.0, rows, start)
    else:
        _sum_full(axis, first, s, 1.0, rows, start)
    marks[number] = marks[VERSION]
