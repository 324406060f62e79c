"""Vectors of four doubles for kernels: one instruction of the processor adds, multiplies or divides all four.

``+ - * /`` work on two vectors, and on a vector and a number.  Each of the four results is rounded as it would be
alone; :func:`fma4` rounds product and sum together.

A function that takes a ``builder``, of LLVM, runs while numba compiles a kernel: it emits its instructions at the
position of the builder and returns values of LLVM.
"""

import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import lower_builtin, models, register_model, type_callable

from ..compile.intrinsics import call_llvm, make_intrinsic

#: Numbers of a vector: an AVX2 register holds four doubles.
LANES = 4
#: LLVM's type of a vector.
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
#: LLVM's type of an index in a vector.
_INT = ir.IntType(32)


class _FourType(types.Type):
    """numba's type of a vector."""

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
    """Return instructions that take four of the eight numbers of the vectors ``a`` and ``b``, numbered by ``order``."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(_INT, LANES), list(order)))


def broadcast_value(builder, x, vector=VECTOR):
    """Return instructions that make a vector, of LLVM's type ``vector``, whose numbers are all ``x``."""
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
    start : index of the first number of the first vector, an integer value of LLVM; it is not checked.
    count : number of vectors, an int of Python.
    vector : LLVM's type of the vectors; four doubles by default.
    Returns a list of ``count`` pointers to vectors, values of LLVM, aligned to 8 bytes only.
    """
    data = array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data
    first = builder.bitcast(builder.gep(data, [start]), vector.as_pointer())
    return [builder.gep(first, [_INT(n)]) for n in range(count)]


def load_vectors(context, builder, signature, arguments, count):
    """Return a list of ``count`` instructions that load vectors of four which follow each other in an array.

    context, builder, signature, arguments : of numba's lowering of a function (array, start, ...): context of code
        generation, builder of LLVM, signature and values of LLVM of the call, of which the first two are used: a
        contiguous array of doubles or a pointer to doubles, and the index of the first double, not checked.
    count : number of vectors, an int of Python.
    Returns values of LLVM, each of type :data:`VECTOR`.
    """
    pointers = vector_pointers(context, builder, signature.args[0], *arguments[:2], count)
    return [builder.load(pointer, align=8) for pointer in pointers]


def _define_operator(function, name):
    """Register with numba an operator of Python for two vectors, and for a number and a vector in either order.

    A number, a double, stands for four times itself; the operator returns a vector.

    function : the operator, a function (a, b) of the module ``operator``.
    name : method of LLVM's builder that makes its instruction: "fadd", "fsub", "fmul" or "fdiv".
    Returns None; kernels may use the operator from then on.
    """

    def give_type(context):
        return lambda a, b: FOUR if FOUR in (a, b) and {a, b} <= {FOUR, types.float64} else None

    def lower(context, builder, signature, arguments):
        operands = zip(arguments, signature.args, strict=True)
        return getattr(builder, name)(*(x if kind is FOUR else broadcast_value(builder, x) for x, kind in operands))

    type_callable(function)(give_type)
    for kinds in ((FOUR, FOUR), (FOUR, types.float64), (types.float64, FOUR)):
        lower_builtin(function, *kinds)(lower)


for _name, _instruction in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _define_operator(getattr(operator, _name), _instruction)
    _define_operator(getattr(operator, f"i{_name}"), _instruction)


def _vectors_of(builder, kind, x, count):
    """Return the vectors of a tuple ``x``, or ``count`` times the vector ``x``; ``kind`` is its type."""
    return cgutils.unpack_tuple(builder, x) if isinstance(kind, types.UniTuple) else [x] * count


def _widest(*kinds):
    """Return numba's signature of :func:`fma4`: a tuple, if one of the arguments is a tuple, else a vector."""
    return next((kind for kind in kinds if isinstance(kind, types.UniTuple)), FOUR)(*kinds)


def _return_vectors(context, builder, kind, vectors):
    """Return one vector, or a tuple of vectors, as ``kind`` says."""
    return vectors[0] if kind is FOUR else context.make_tuple(builder, kind, vectors)


def _fma4(context, builder, signature, arguments):
    kind = signature.return_type
    columns = (_vectors_of(builder, own, x, getattr(kind, "count", 1)) for own, x in zip(signature.args, arguments))
    return _return_vectors(context, builder, kind, [fma_vectors(builder, *abc) for abc in zip(*columns, strict=True)])


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
    vectors = load_vectors(context, builder, signature, arguments, getattr(kind, "count", 1))
    return _return_vectors(context, builder, kind, vectors)


def _store(context, builder, signature, arguments):
    """Make the instructions that store vectors; 8 bytes are all that the address of a double is aligned to.

    context, builder, signature, arguments : of numba's lowering of (array, start, vector or tuple of vectors).
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
#: (a, b) -> the last number of a, then the first three of b.  A load across two stores would wait for both.
shift_in = make_intrinsic(_shift_in, FOUR, FOUR, FOUR)
#: (a, b, c) -> a b + c, rounded once, of vectors, or of tuples of vectors and vectors that stand for all of a tuple.
fma4 = make_intrinsic(_fma4, _widest, None, None, None)
#: number -> the vector of four times that number.
broadcast = make_intrinsic(_broadcast, FOUR, types.float64)
#: (array, start) -> the vector of the numbers start to start + 3 of a contiguous array or at a pointer.
load = make_intrinsic(_load, FOUR, None, types.int64)
#: (array, start, vector) stores a vector, or a tuple of vectors, at start.
store = make_intrinsic(_store, types.void, None, types.int64, None)


def make_load(count):
    """Return a function for kernels that loads vectors which follow each other.

    count : number of vectors, an int >= 1.
    Returns numba's intrinsic (array, start) -> tuple of ``count`` vectors: array, contiguous doubles or a pointer to
    doubles; start, int, index of the first number.
    """
    return make_intrinsic(_load, types.UniTuple(FOUR, count), None, types.int64)
