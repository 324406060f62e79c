"""Vectors of four doubles, and polynomials that they evaluate.

**Vectors.**  One instruction of the processor adds, multiplies or divides all four numbers of a
vector.  ``+ - * / +=`` work on two vectors, and on a vector and a number.  Each of the four results
is rounded as it would be alone; :func:`fma4` rounds product and sum together.  A function that
takes a ``builder``, of LLVM, runs while numba compiles a kernel: it emits its instructions at the
position of the builder and returns values of LLVM.

**Polynomials of 24 coefficients.**  One function is stored as its coefficients in their order: six
vectors, which are the coefficients of four polynomials in t^4, one in each lane: lane n has the
coefficients n, n + 4, n + 8 ..., and is multiplied by t^n.  A pair of functions a and b is stored
as a0 a1 b0 b1, a2 a3 b2 b3, ...: twelve vectors, polynomials in t^2 of the even and odd
coefficients.  So a polynomial over an octave costs no more than one over an eighth of the octave
with half as many coefficients.  The kernels that evaluate them take ``table``, a vector; ``start``,
where the coefficients begin in it; and the argument ``t``, in [-1, 1] on the row of the table;
outside the polynomial is extrapolated.  A NaN of t gives NaNs.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import lower_builtin, models, register_model, type_callable

from .intrinsics import call_llvm, fma, make_intrinsic
from .jit import inline_kernel

# --- Vectors of four doubles for kernels ---

#: Numbers of a vector: an AVX2 register holds four doubles.
LANES = 4
#: LLVM's type of a vector.
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
#: LLVM's type of an index in a vector.
_INT = ir.IntType(32)


class _FourType(types.Type):
    """numba's type of a vector."""

    #: vectors of a value of this type, as numba's type of a tuple has it
    count = 1

    def __init__(self):
        super().__init__("four numbers")


#: numba's type of a vector.
FOUR = _FourType()


@register_model(_FourType)
class _FourModel(models.PrimitiveModel):
    """A vector is represented by LLVM's vector itself."""

    def __init__(self, manager, kind) -> None:
        super().__init__(manager, kind, VECTOR)


def shuffle(builder, a, b, order):
    """Return instructions that take four of the eight numbers of the vectors ``a`` and ``b``,
    numbered by ``order``.
    """
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(_INT, LANES), list(order)))


def broadcast_value(builder, x, vector=VECTOR):
    """Return instructions that make a vector, of LLVM's type ``vector``, whose numbers are all
    ``x``.
    """
    empty = ir.Constant(vector, ir.Undefined)
    one = builder.insert_element(empty, x, _INT(0))
    return builder.shuffle_vector(one, empty, ir.Constant(ir.VectorType(_INT, vector.count), None))


def fma_vectors(builder, *vectors):
    """Return the instruction a b + c of three vectors."""
    return call_llvm(builder, f"llvm.fma.v{vectors[0].type.count}f64", vectors)


def vector_pointers(context, builder, kind, array, start, count, vector=VECTOR):
    """Return pointers to ``count`` vectors that follow each other in an array.

    context, builder : numba's context of code generation, and builder of LLVM.
    kind : numba's type of ``array``: a contiguous array of doubles, or a pointer to doubles.
    array : the array or pointer, a value of LLVM.
    start : index of the first number of the first vector, an integer value of LLVM; it is not
    checked.
    count : number of vectors, an int of Python.
    vector : LLVM's type of the vectors; four doubles by default.
    Returns a list of ``count`` pointers to vectors, values of LLVM, aligned to 8 bytes only.
    """
    data = (
        array
        if isinstance(kind, types.CPointer)
        else context.make_array(kind)(context, builder, array).data
    )
    # ``start`` counts numbers; from there on the pointer counts vectors
    first = builder.bitcast(builder.gep(data, [start]), vector.as_pointer())
    return [builder.gep(first, [_INT(n)]) for n in range(count)]


def load_vectors(context, builder, signature, arguments, count):
    """Return a list of ``count`` instructions that load vectors of four which follow each other in
    an array.

    context, builder, signature, arguments : of numba's lowering of a function (array, start, ...):
        context of code generation, builder of LLVM, signature and values of LLVM of the call, of
        which the first two are used: a contiguous array of doubles or a pointer to doubles, and the
        index of the first double, not checked.
    count : number of vectors, an int of Python.
    Returns values of LLVM, each of type :data:`VECTOR`.
    """
    pointers = vector_pointers(context, builder, signature.args[0], *arguments[:2], count)
    return [builder.load(pointer, align=8) for pointer in pointers]


def _define_operator(function, name):
    """Register with numba an operator of Python for two vectors, and for a number and a vector in
    either order.

    A number, a double, stands for four times itself; the operator returns a vector.

    function : the operator, a function (a, b) of the module ``operator``.
    name : method of LLVM's builder that makes its instruction: "fadd", "fsub", "fmul" or "fdiv".
    Returns None; kernels may use the operator from then on.
    """

    # a vector, if one of both is one and the other a vector or a double; None: not this operator's
    def give_type(context):
        return lambda a, b: FOUR if FOUR in (a, b) and {a, b} <= {FOUR, types.float64} else None

    def lower(context, builder, signature, arguments):
        operands = zip(arguments, signature.args, strict=True)
        return getattr(builder, name)(
            *(x if kind is FOUR else broadcast_value(builder, x) for x, kind in operands)
        )

    type_callable(function)(give_type)
    for kinds in ((FOUR, FOUR), (FOUR, types.float64), (types.float64, FOUR)):
        lower_builtin(function, *kinds)(lower)


_define_operator(operator.add, "fadd")
_define_operator(operator.iadd, "fadd")
_define_operator(operator.sub, "fsub")
_define_operator(operator.mul, "fmul")
_define_operator(operator.truediv, "fdiv")


def _vectors_of(builder, kind, x, count):
    """Return the vectors of a tuple ``x``, or ``count`` times the vector ``x``; ``kind`` is its
    type.
    """
    return [x] * count if kind is FOUR else cgutils.unpack_tuple(builder, x)


def _widest(*kinds):
    """Return numba's signature of :func:`fma4`: a tuple, if one of the arguments is a tuple, else a
    vector.
    """
    return max(kinds, key=operator.attrgetter("count"))(*kinds)


def _return_vectors(context, builder, kind, vectors):
    """Return one vector, or a tuple of vectors, as ``kind`` says."""
    return vectors[0] if kind is FOUR else context.make_tuple(builder, kind, vectors)


def _fma4(context, builder, signature, arguments):
    """Make the instructions of :func:`fma4`: a b + c of each vector of the arguments, of which a
    single vector stands for all of a tuple.

    context, builder, signature, arguments : of numba's lowering of (a, b, c), vectors or tuples.
    Returns a value of LLVM, a vector or a tuple of vectors.
    """
    # three columns of as many vectors as the result has
    kind = signature.return_type
    columns = (
        _vectors_of(builder, own, x, kind.count) for own, x in zip(signature.args, arguments)
    )
    return _return_vectors(
        context, builder, kind, [fma_vectors(builder, *abc) for abc in zip(*columns, strict=True)]
    )


def _shift_in(context, builder, signature, arguments):
    return shuffle(builder, *arguments, range(LANES - 1, 2 * LANES - 1))


def _broadcast(context, builder, signature, arguments):
    return broadcast_value(builder, *arguments)


def _pack(context, builder, signature, arguments):
    vector = ir.Constant(VECTOR, ir.Undefined)
    for n, number in enumerate(arguments):
        vector = builder.insert_element(vector, number, _INT(n))
    return vector


def _unpack(context, builder, signature, arguments):
    numbers = [builder.extract_element(arguments[0], _INT(n)) for n in range(LANES)]
    return context.make_tuple(builder, signature.return_type, numbers)


def _load(context, builder, signature, arguments):
    kind = signature.return_type
    vectors = load_vectors(context, builder, signature, arguments, kind.count)
    return _return_vectors(context, builder, kind, vectors)


def _store(context, builder, signature, arguments):
    """Make the instructions that store vectors; 8 bytes are all that the address of a double is
    aligned to.

    context, builder, signature, arguments : of numba's lowering of (array, start, vector or tuple
    of vectors).
    Returns numba's dummy value, as the function returns nothing.
    """
    vectors = _vectors_of(builder, signature.args[2], arguments[2], 1)
    pointers = vector_pointers(context, builder, signature.args[0], *arguments[:2], len(vectors))
    for pointer, vector in zip(pointers, vectors):
        builder.store(vector, pointer, align=8)
    return context.get_dummy_value()


#: (a, b, c, d) -> the vector of four numbers.
pack = make_intrinsic(_pack, FOUR, *[types.float64] * LANES)
#: vector -> its four numbers, a tuple.
unpack = make_intrinsic(_unpack, types.UniTuple(types.float64, LANES), FOUR)
#: (a, b) -> the last number of a, then the first three of b.  A load across two stores would wait
#: for both.
shift_in = make_intrinsic(_shift_in, FOUR, FOUR, FOUR)
#: (a, b, c) -> a b + c, rounded once, of vectors, or of tuples of vectors and vectors that stand
#: for all of a tuple.
fma4 = make_intrinsic(_fma4, _widest, None, None, None)
#: number -> the vector of four times that number.
broadcast = make_intrinsic(_broadcast, FOUR, types.float64)
#: (array, start) -> the vector of the numbers start to start + 3 of a contiguous array or at a
#: pointer.
load = make_intrinsic(_load, FOUR, None, types.int64)
#: (array, start, vector) stores a vector, or a tuple of vectors, at start.
store = make_intrinsic(_store, types.void, None, types.int64, None)


def make_load(count):
    """Return a function for kernels that loads vectors which follow each other.

    count : number of vectors, an int >= 1.
    Returns numba's intrinsic (array, start) -> tuple of ``count`` vectors: array, contiguous
    doubles or a pointer to doubles; start, int, index of the first number.
    """
    return make_intrinsic(_load, types.UniTuple(FOUR, count), None, types.int64)


# --- Polynomials of 24 coefficients, evaluated by vectors of four numbers ---

#: Coefficients of a polynomial: over an octave 24 leave the rounding of doubles.
TERMS = 24
#: Coefficients of what shear does on covers: their values have errors of 1e-10 by the solve, which
#: more coefficients would only amplify in slopes.
SHORT_TERMS = 16
#: Vectors of one function.
_ONE = TERMS // LANES


def _constant(numbers):
    """Return a constant vector of LLVM with four ``numbers``."""
    return ir.Constant(VECTOR, [float(x) for x in numbers])


def _make_sums(count: int, orders: int):
    """Return a kernel that evaluates a polynomial with vectors of four for coefficients, and its
    derivatives.

    count : int, number of coefficients, >= ``orders``.
    orders : int, number of values that the kernel returns: the polynomial, its first derivative,
    and so on.

    Returns the kernel, an intrinsic of numba, which takes (table, start, x): contiguous vector of
    doubles, or pointer; int, index in it at which the first coefficient begins, four numbers each;
    argument, a float.  It returns a tuple of ``orders`` vectors of four doubles.  They are
    derivatives over x by Estrin's scheme, without factorials divided out.
    """

    def lower(context, builder, signature, arguments):
        """Return the instructions of the kernel, by Estrin's scheme; numba calls this function for
        every call of the kernel.

        context, builder, signature, arguments : numba's context of code generation, builder of
            LLVM, signature of the call, and values of LLVM of its arguments (table, start, x).
        Returns a value of LLVM: the tuple of the kernel.
        """
        terms = load_vectors(context, builder, signature, arguments, count)
        sums = []
        for _ in range(orders):
            level = terms
            power = broadcast_value(builder, arguments[2])
            while len(level) > 1:  # by Estrin's scheme, whose parts do not wait for one another
                pairs = [level[n : n + 2] for n in range(0, len(level), 2)]
                level = [
                    fma_vectors(builder, odd[0], power, even) if odd else even
                    for even, *odd in pairs
                ]
                power = builder.fmul(power, power)
            sums.append(level[0])
            # the derivative: coefficient k times k, moved down by one power
            terms = [builder.fmul(_constant([k] * LANES), term) for k, term in enumerate(terms)][1:]
        return context.make_tuple(builder, signature.return_type, sums)

    return make_intrinsic(lower, types.UniTuple(FOUR, orders), None, types.int64, types.float64)


def _lower_secants(context, builder, signature, arguments):
    """Return instructions of (table, start, x, z) -> p(x) and (p(x) - p(z))/(x - z), of one
    function and of its slope.

    Here p is the polynomial with six vectors for coefficients, and x and z are the fourth powers of
    two arguments t; the secant is formed without a difference, so that x = z gives dp/dx.

    context, builder, signature, arguments : numba's context of code generation, builder of LLVM,
        signature of the call, and values of LLVM of its arguments: vector or pointer, int, two
        doubles.
    Returns a value of LLVM, a tuple of four vectors of four: p and its secant of the function, then
    both of its slope in t.
    """
    terms = load_vectors(context, builder, signature, arguments, _ONE)
    sums = []
    # Horner's scheme of p in x, ``value``; the partial sums are the coefficients of (p(x) -
    # p(z))/(x - z) as a polynomial in z, ``total``, by the same scheme (synthetic division).
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
        terms = [
            builder.fmul(_constant(range(n, n + LANES)), term)
            for n, term in zip(range(1, TERMS, LANES), moved)
        ]
    return context.make_tuple(builder, signature.return_type, sums)


_pair_sums = _make_sums(2 * _ONE, 3)
_short_pair_sums = _make_sums(2 * SHORT_TERMS // LANES, 3)
_one_sums = _make_sums(_ONE, 2)
_one_secants = make_intrinsic(
    _lower_secants, types.UniTuple(FOUR, 4), None, types.int64, types.float64, types.float64
)


@inline_kernel
def evaluate_pair(table, start, t):
    """Return two functions that are stored as a pair, with their first and second derivatives in t.

    table : contiguous vector of doubles, or pointer to them, with 48 coefficients of the pair,
    interleaved by two.
    start : int, index in ``table`` at which they begin; it is not checked.
    t : float, argument, dimensionless.
    Returns (a, b, a', b', a'', b''), floats in the units of the coefficients; the compiler leaves
    out what a caller does not read.
    """
    return _join_pair(_pair_sums(table, start, t * t), t)


@inline_kernel
def evaluate_short_pair(table, start, t):
    """Return what :func:`evaluate_pair` does, of functions with SHORT_TERMS coefficients each."""
    return _join_pair(_short_pair_sums(table, start, t * t), t)


@inline_kernel
def _join_pair(sums, t):
    """Return two functions with their first and second derivatives in t, as
    :func:`evaluate_pair` does.

    sums : three vectors (even part, odd part of the first function; both of the second) at t^2: of
        values and of two derivatives over t^2.
    t : float, argument, dimensionless.
    """
    twice = 2.0 * t
    square = t * t
    value, first_derivative, second_derivative = sums
    # Each function is E + t O, with polynomials E and O of t^2.  With ' over t^2 its derivatives in
    # t are O + 2 t (E' + t O') and 2 [E' + t O' + 2 t (O' + t E'' + t^2 O'')]; a_1 and b_1 are E' +
    # t O'.
    a_even, a_odd, b_even, b_odd = unpack(value)
    a_even_1, a_odd_1, b_even_1, b_odd_1 = unpack(first_derivative)
    a_even_2, a_odd_2, b_even_2, b_odd_2 = unpack(second_derivative)
    a_1 = fma(t, a_odd_1, a_even_1)
    b_1 = fma(t, b_odd_1, b_even_1)
    a_2 = 2.0 * fma(twice, a_odd_1 + fma(square, a_odd_2, t * a_even_2), a_1)
    b_2 = 2.0 * fma(twice, b_odd_1 + fma(square, b_odd_2, t * b_even_2), b_1)
    return (
        fma(t, a_odd, a_even),
        fma(t, b_odd, b_even),
        fma(twice, a_1, a_odd),
        fma(twice, b_1, b_odd),
        a_2,
        b_2,
    )


@inline_kernel
def join_lanes(sums, t, square):
    """Return a + b t + c t^2 + d t^3, the last step of Estrin's scheme for a polynomial in t.

    a, b, c and d are polynomials in t^4: that of the coefficients 0, 4, 8 ..., that of 1, 5, 9 ...,
    and so on.

    sums : vector of four, the values of a, b, c and d at t^4.
    t, square : floats, argument and t^2, dimensionless.
    Returns a float, in the unit of the coefficients.
    """
    a, b, c, d = unpack(sums)
    return fma(square, fma(t, d, c), fma(t, b, a))


@inline_kernel
def evaluate_single(table, start, t):
    """Return one function of the table and its slope in t.

    table : contiguous vector of doubles, or pointer to them, with the 24 coefficients of the
        function, the constant first.
    start : int, index in ``table`` at which they begin; it is not checked.
    t : float, argument, dimensionless.
    Returns (value, slope), floats in the unit of the coefficients.
    """
    square = t * t
    # The derivative of a + b t + c t^2 + d t^3 with a, b, c, d functions of t^4: their own slopes
    # are multiplied by 4 t^3.
    value, first_derivative = _one_sums(table, start, square * square)
    _, b, c, d = unpack(value)
    slope = join_lanes(first_derivative, t, square)
    slope = fma(4.0 * t * square, slope, fma(t, fma(3.0 * t, d, 2.0 * c), b))
    return join_lanes(value, t, square), slope


@inline_kernel
def _join_secant(sums, secants, t, s):
    """Return p(t) and its secant (p(t) - p(s))/(t - s) from the four polynomials in t^4 of which p
    consists.

    sums : vector of four, the values of the four polynomials at t^4: lane n is the factor of t^n.
    secants : vector of four, their secants between t^4 and s^4.
    t, s : floats, arguments, dimensionless.
    Returns (p(t), secant), floats; the secant is p'(t) at s = t, since nothing is divided by t - s.
    """
    square = t * t
    s_square = s * s
    # t^n a - s^n b = s^n (a - b) + a (t^n - s^n), divided by t - s: a - b is its secant times t^4 -
    # s^4 = (t - s) (t + s) (t^2 + s^2), and t^2 - s^2 and t^3 - s^3 have the factors t + s and t^2
    # + t s + s^2.
    _, first, second, third = unpack(sums)
    first = fma(fma(t, s, square + s_square), third, fma(t + s, second, first))
    return join_lanes(sums, t, square), (t + s) * (square + s_square) * join_lanes(
        secants, s, s_square
    ) + first


@inline_kernel
def evaluate_secants(table, start, t, s):
    """Return p(t) and (p(t) - p(s))/(t - s) of one function p, and the same of its slope p',
    without cancellation.

    table : contiguous vector of doubles, or pointer to them, with the 24 coefficients of p, the
    constant first.
    start : int, index in ``table`` at which they begin; it is not checked.
    t, s : floats, arguments, dimensionless, in any order; in [-1, 1] on the row, outside p is
    extrapolated.

    Returns (p(t), secant of p, p'(t), secant of p'), floats in the unit of the coefficients; at s =
    t the secants are p'(t) and p''(t).  A NaN of s makes the two secants NaN, but not p(t) and
    p'(t).
    """
    square = t * t
    s_square = s * s
    # four polynomials in t^4, of p and of p', with their secants between t^4 and s^4
    sums, secants, slope_sums, slope_secants = _one_secants(
        table, start, square * square, s_square * s_square
    )
    value, first_derivative = _join_secant(sums, secants, t, s)
    return value, first_derivative, *_join_secant(slope_sums, slope_secants, t, s)
