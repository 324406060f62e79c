"""Polynomials of 24 coefficients, evaluated by vectors of four numbers.

One function is stored as its coefficients in their order: six vectors, which are the coefficients of four polynomials
in t^4, one in each lane: lane n has the coefficients n, n + 4, n + 8 ..., and is multiplied by t^n.  A pair of
functions a and b is stored as a0 a1 b0 b1, a2 a3 b2 b3, ...: twelve vectors, polynomials in t^2 of the even and odd
coefficients.  So a polynomial over an octave costs no more than one over an eighth of the octave with half as many
coefficients.

All kernels take ``table``, a vector; ``start``, where the coefficients begin in it; and the argument ``t``, in [-1, 1]
on the row of the table; outside the polynomial is extrapolated.  A NaN of t gives NaNs.
"""

from llvmlite import ir
from numba.core import types

from ..compile.intrinsics import fma, make_intrinsic
from ..compile.jit import inline_kernel
from ..numerics.simd4 import FOUR, LANES, VECTOR, broadcast_value, fma_vectors, load_vectors, shuffle, unpack

#: Coefficients of a polynomial: over an octave 24 leave the rounding of doubles.
TERMS = 24
#: Vectors of one function.
_ONE = TERMS // LANES


def _constant(numbers):
    """Return a constant vector of LLVM with four ``numbers``."""
    return ir.Constant(VECTOR, [float(x) for x in numbers])


def _make_sums(count: int, orders: int):
    """Return a kernel that evaluates a polynomial with vectors of four for coefficients, and its derivatives.

    count : int, number of coefficients, >= ``orders``.
    orders : int, number of values that the kernel returns: the polynomial, its first derivative, and so on.

    Returns the kernel, an intrinsic of numba, which takes (table, start, x): contiguous vector of doubles, or pointer;
    int, index in it at which the first coefficient begins, four numbers each; argument, a float.  It returns a tuple of
    ``orders`` vectors of four doubles.  They are derivatives over x by Estrin's scheme, without factorials divided out.
    """

    def lower(context, builder, signature, arguments):
        """Return the instructions of the kernel, by Estrin's scheme; numba calls this function for every call of the
        kernel.

        context, builder, signature, arguments : numba's context of code generation, builder of LLVM, signature of the
            call, and values of LLVM of its arguments (table, start, x).
        Returns a value of LLVM: the tuple of the kernel.
        """
        terms = load_vectors(context, builder, signature, arguments, count)
        sums = []
        for _ in range(orders):
            level = terms
            power = broadcast_value(builder, arguments[2])
            while len(level) > 1:  # by Estrin's scheme, whose parts do not wait for one another
                pairs = [level[n : n + 2] for n in range(0, len(level), 2)]
                level = [fma_vectors(builder, odd[0], power, even) if odd else even for even, *odd in pairs]
                power = builder.fmul(power, power)
            sums.append(level[0])
            terms = [builder.fmul(_constant([k] * LANES), term) for k, term in enumerate(terms)][1:]
        return context.make_tuple(builder, signature.return_type, sums)

    return make_intrinsic(lower, types.UniTuple(FOUR, orders), None, types.int64, types.float64)


def _lower_secants(context, builder, signature, arguments):
    """Return instructions of (table, start, x, z) -> p(x) and (p(x) - p(z))/(x - z), of one function and of its slope.

    Here p is the polynomial with six vectors for coefficients, and x and z are the fourth powers of two arguments t;
    the secant is formed without a difference, so that x = z gives dp/dx.

    context, builder, signature, arguments : numba's context of code generation, builder of LLVM, signature of the call,
        and values of LLVM of its arguments: vector or pointer, int, two doubles.
    Returns a value of LLVM, a tuple of four vectors of four: p and its secant of the function, then both of its slope
    in t.
    """
    terms = load_vectors(context, builder, signature, arguments, _ONE)
    sums = []
    x, z = (broadcast_value(builder, power) for power in arguments[2:])
    for _ in range(2):
        value = total = terms[-1]
        for term in terms[-2:0:-1]:
            value = fma_vectors(builder, x, value, term)
            total = fma_vectors(builder, z, total, value)
        sums += [fma_vectors(builder, x, value, terms[0]), total]
        # the coefficients of the slope: each moves down by one power
        following = zip(terms, [*terms[1:], _constant([0.0] * LANES)])
        moved = [shuffle(builder, *neighbours, range(1, LANES + 1)) for neighbours in following]
        terms = [builder.fmul(_constant(range(n, n + LANES)), term) for n, term in zip(range(1, TERMS, LANES), moved)]
    return context.make_tuple(builder, signature.return_type, sums)


_pair_sums = _make_sums(2 * _ONE, 3)
_one_sums = _make_sums(_ONE, 2)
_one_secants = make_intrinsic(_lower_secants, types.UniTuple(FOUR, 4), None, types.int64, types.float64, types.float64)


@inline_kernel
def evaluate_pair(table, start, t):
    """Return two functions that are stored as a pair, with their first and second derivatives in t.

    table : contiguous vector of doubles, or pointer to them, with 48 coefficients of the pair, interleaved by two.
    start : int, index in ``table`` at which they begin; it is not checked.
    t : float, argument, dimensionless.
    Returns (a, b, a', b', a'', b''), floats in the units of the coefficients; the compiler leaves out what a caller
    does not read.
    """
    twice = 2.0 * t
    square = t * t
    value, first_derivative, second_derivative = _pair_sums(table, start, square)
    # each function is E + t O, with polynomials E and O of t^2
    a_even, a_odd, b_even, b_odd = unpack(value)
    a_even_1, a_odd_1, b_even_1, b_odd_1 = unpack(first_derivative)
    a_even_2, a_odd_2, b_even_2, b_odd_2 = unpack(second_derivative)
    a_1 = fma(t, a_odd_1, a_even_1)
    b_1 = fma(t, b_odd_1, b_even_1)
    a_2 = 2.0 * fma(twice, a_odd_1 + fma(square, a_odd_2, t * a_even_2), a_1)
    b_2 = 2.0 * fma(twice, b_odd_1 + fma(square, b_odd_2, t * b_even_2), b_1)
    return fma(t, a_odd, a_even), fma(t, b_odd, b_even), fma(twice, a_1, a_odd), fma(twice, b_1, b_odd), a_2, b_2


@inline_kernel
def _join(sums, t, square):
    """Return a + b t + c t^2 + d t^3, the last step of Estrin's scheme for a polynomial in t.

    a, b, c and d are polynomials in t^4: that of the coefficients 0, 4, 8 ..., that of 1, 5, 9 ..., and so on.

    sums : vector of four, the values of a, b, c and d at t^4.
    t, square : floats, argument and t^2, dimensionless.
    Returns a float, in the unit of the coefficients.
    """
    a, b, c, d = unpack(sums)
    return fma(square, fma(t, d, c), fma(t, b, a))


@inline_kernel
def evaluate_single(table, start, t):
    """Return one function of the table and its slope in t.

    table : contiguous vector of doubles, or pointer to them, with the 24 coefficients of the function, the constant
        first.
    start : int, index in ``table`` at which they begin; it is not checked.
    t : float, argument, dimensionless.
    Returns (value, slope), floats in the unit of the coefficients.
    """
    square = t * t
    value, first_derivative = _one_sums(table, start, square * square)
    _, b, c, d = unpack(value)
    slope = fma(4.0 * t * square, _join(first_derivative, t, square), fma(t, fma(3.0 * t, d, 2.0 * c), b))
    return _join(value, t, square), slope


@inline_kernel
def _join_secant(sums, secants, t, s):
    """Return p(t) and its secant (p(t) - p(s))/(t - s) from the four polynomials in t^4 of which p consists.

    sums : vector of four, the values of the four polynomials at t^4: lane n is the factor of t^n.
    secants : vector of four, their secants between t^4 and s^4.
    t, s : floats, arguments, dimensionless.
    Returns (p(t), secant), floats; the secant is p'(t) at s = t, since nothing is divided by t - s.
    """
    square = t * t
    s_square = s * s
    # t^n a - s^n b = s^n (a - b) + a (t^n - s^n)
    _, first, second, third = unpack(sums)
    first = fma(fma(t, s, square + s_square), third, fma(t + s, second, first))
    return _join(sums, t, square), (t + s) * (square + s_square) * _join(secants, s, s_square) + first


@inline_kernel
def evaluate_secants(table, start, t, s):
    """Return p(t) and (p(t) - p(s))/(t - s) of one function p, and the same of its slope p', without cancellation.

    table : contiguous vector of doubles, or pointer to them, with the 24 coefficients of p, the constant first.
    start : int, index in ``table`` at which they begin; it is not checked.
    t, s : floats, arguments, dimensionless, in any order; in [-1, 1] on the row, outside p is extrapolated.

    Returns (p(t), secant of p, p'(t), secant of p'), floats in the unit of the coefficients; at s = t the secants are
    p'(t) and p''(t).  A NaN of s makes the two secants NaN, but not p(t) and p'(t).
    """
    square = t * t
    s_square = s * s
    sums, secants, slope_sums, slope_secants = _one_secants(table, start, square * square, s_square * s_square)
    value, first_derivative = _join_secant(sums, secants, t, s)
    return value, first_derivative, *_join_secant(slope_sums, slope_secants, t, s)
