"""Functions of kernels that become single instructions of LLVM, or are passed by address.

**Fused product and sum.**  LLVM could fuse products and sums by itself (``fastmath={"contract"}``).
Its choice depends on the functions that it sees, and so on whether they were compiled in the same
process or came from the cache: the last bits of a result would follow the history of the cache.  So
only polynomials, where most of the time is spent, call :func:`fma`.

**Calls by address.**  A kernel that is called by its address is compiled once, by itself, and not
again with each caller.  Such a kernel takes a number and a record that contains addresses of
arrays, and returns nothing.

**Records by reference.**  Calls pass the address of a record, one number, where numba passes every
field of a tuple.  A field is loaded when it is read; a record in a record is passed by reference
too.  The record exists as long as the kernel that made the reference runs.  Its arrays belong to
the caller of that kernel.  After each number that a loop stores LLVM would read the fields again:
such a loop takes a reference to a copy of its own, ``by_reference(by_value(record))``, which no
store can change and LLVM keeps in registers.

**Assignments to arrays**, element by element: numba's own would prepare for shapes that differ, and
compile longer.

**Bins of a positive float.**  An octave [2^n, 2^(n+1)) is cut into 2^bits of them by the leading
bits of its mantissa.  No logarithm is taken: the number of the bin is read off the bits of the
float.  In a bin functions are polynomials of the offset t of the mantissa from the centre of the
bin.
"""

from collections.abc import Callable
from functools import cache
from inspect import Parameter, Signature

import numba
import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import cgutils, types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, intrinsic, lower_getattr_generic, models, register_model

from .jit import inline_kernel, kernel

# --- Instructions of LLVM that kernels call like functions ---

#: a 64-bit integer of LLVM, which holds an address
_WORD = ir.IntType(64)
#: type of a kernel that is called by its address: (number, address of a record) -> nothing
_FUNCTION = ir.FunctionType(ir.VoidType(), [_WORD, _WORD])


def make_intrinsic(lower: Callable, returned, *kinds):
    """Return a function for kernels that is lowered to instructions of LLVM.

    lower : (context, builder, signature, arguments) -> value of LLVM; numba calls it with its
        context of code generation, the builder of LLVM, its signature of the call and the values of
        LLVM of the arguments.
    returned : a callable that gives numba's signature of the call from the types of the arguments:
        numba's type of the value, or a function.
    kinds : numba's types of the arguments, None for any type, in their number and order.  A type
        replaces that of the argument in the call, which numba converts; a literal integer is thus
        passed as an int64.
    Returns numba's intrinsic, which is called in kernels with these arguments, by position.
    """

    # numba passes the types of the arguments: a kind given replaces that of the argument
    def give_signature(context, *arguments):
        return returned(*(kind or own for kind, own in zip(kinds, arguments, strict=True))), lower

    # the signature that numba reads has a name for each argument, not ``*arguments``
    names = ["context", *(f"given_{n}" for n in range(len(kinds)))]
    give_signature.__signature__ = Signature(
        [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in names]
    )
    return intrinsic(give_signature)


def call_llvm(builder, name: str, arguments):
    """Return the call of an intrinsic of LLVM whose arguments and value have one type.

    builder : builder of LLVM, at whose position the call is emitted; the intrinsic is declared in
        ``builder.module`` if it is not yet.
    name : name of the intrinsic with its type, such as "llvm.fma.v4f64".
    arguments : values of LLVM, at least one, all of the type of the first.
    Returns the value of LLVM of the call, of that type.
    """
    kind = arguments[0].type
    function = ir.FunctionType(kind, [kind] * len(arguments))
    return builder.call(cgutils.get_or_insert_function(builder.module, function, name), arguments)


def _bitcast(context, builder, signature, arguments):
    return builder.bitcast(arguments[0], context.get_value_type(signature.return_type))


def _fma(context, builder, signature, arguments):
    """An instruction if the processor has one, else a call of the C library."""
    return builder.fma(*arguments)


def _expect(context, builder, signature, arguments):
    return call_llvm(builder, "llvm.expect.i1", [*arguments, ir.IntType(1)(0)])


def _call(context, builder, signature, arguments):
    builder.call(builder.inttoptr(arguments[0], _FUNCTION.as_pointer()), arguments[1:])
    return context.get_dummy_value()


def _pointer(context, builder, signature, arguments):
    return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))


#: the bits of a double as an integer; numba would compile ``view`` in each kernel, in 0.1 s
float_to_bits = make_intrinsic(_bitcast, types.int64, types.float64)
#: the double with these bits
bits_to_float = make_intrinsic(_bitcast, types.float64, types.int64)
#: a b + c, rounded once
fma = make_intrinsic(_fma, *[types.float64] * 4)
#: ``if unlikely(condition)`` tells LLVM that the branch is rarely taken
unlikely = make_intrinsic(_expect, types.boolean, types.boolean)
#: call the kernel at an address: (address, number, address of a record)
call_address = make_intrinsic(_call, types.void, *[types.int64] * 3)
#: an address as a pointer to doubles
_to_doubles = make_intrinsic(_pointer, types.CPointer(types.float64), types.int64)
#: an address as a pointer to 64-bit integers
_to_integers = make_intrinsic(_pointer, types.CPointer(types.int64), types.int64)


def record_type(integers: str, floats: str = "") -> np.dtype:
    """Return the dtype of a record of 64-bit integers, among them addresses, followed by doubles.

    integers, floats : names of the fields of either kind, in their order, separated by blanks; no
    doubles by default.
    Returns a numpy dtype without padding, 8 bytes a field.
    """
    return np.dtype(
        [(name, np.int64) for name in integers.split()]
        + [(name, np.float64) for name in floats.split()]
    )


@cache
def function_address(function, record: np.dtype, returned=types.void, *first) -> int:
    """Return the address of the machine code of a kernel for calls from C or from other kernels,
    compiled for given types.

    function : the kernel, numba's dispatcher, whose last argument is a pointer to a record.
    record : dtype of that record.
    returned : numba's type of its value; by default nothing.
    first : numba's types of the arguments in front of the record; by default one 64-bit integer.
    Returns the address as an int, valid in this process.  The kernel is compiled in the first call
    with these types; a further call returns the same address.  Raises numba's error if the kernel
    cannot be compiled for these types.
    """
    kinds = *(first or (types.int64,)), types.CPointer(numba.from_dtype(record))
    function.compile(returned(*kinds))
    compiled = function.overloads[kinds]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))


@kernel(inline=True, allocates=True)
def floats_at(address, size):
    """Return the vector of ``size`` doubles at an address, an array of numpy that shares the
    memory.

    address : int, the address, which is not checked; the memory must exist as long as the vector is
    used.
    size : int, number of doubles, at least 0.
    """
    return carray(_to_doubles(address), size)


@kernel(inline=True, allocates=True)
def integers_at(address, size):
    """Return the vector of ``size`` 64-bit integers at an address, as :func:`floats_at` returns
    that of doubles.
    """
    return carray(_to_integers(address), size)


@kernel(inline=True, allocates=True)
def record_at(pointer):
    """Return the record to which a pointer points, numba's view of it; its fields are read by name
    from the memory.
    """
    return carray(pointer, 1)[0]


@inline_kernel
def septic(t, c):
    """Return the polynomial c[0] + c[1] t + ... + c[7] t^7, by Estrin's scheme, whose parts are
    independent of one another.

    t : argument, float.
    c : coefficients, the constant first, at least 8 floats, of which the first 8 are read; the
    length is not checked.
    Returns a float, NaN if ``t`` or a coefficient is NaN.
    """
    t2 = t * t
    # pairs, then pairs of pairs: three levels in place of seven steps of Horner's scheme
    low = fma(t2, fma(t, c[3], c[2]), fma(t, c[1], c[0]))
    high = fma(t2, fma(t, c[7], c[6]), fma(t, c[5], c[4]))
    return fma(t2 * t2, high, low)


# --- Records by reference ---


class _ReferenceType(types.Type):
    """numba's type of a reference to a record; ``record``: numba's type of that."""

    def __init__(self, record):
        super().__init__(f"reference to {record}")
        self.record = record


@register_model(_ReferenceType)
class _ReferenceModel(models.PrimitiveModel):
    """A reference is represented by a pointer to the record."""

    def __init__(self, manager, kind):
        super().__init__(manager, kind, manager[kind.record].get_value_type().as_pointer())


@infer_getattr
class _Attributes(AttributeTemplate):
    """Types of the fields of a reference, for numba: a record in a record is a reference too, other
    fields have their own type, and a name that is no field has None, which numba reports as an
    error of type.
    """

    key = _ReferenceType

    def generic_resolve(self, reference, name):
        kind = dict(zip(reference.record.fields, reference.record.types, strict=True)).get(name)
        return _ReferenceType(kind) if isinstance(kind, types.NamedTuple) else kind


@lower_getattr_generic(_ReferenceType)
def _attribute(context, builder, kind, reference, name):
    """Return instructions that read a field of a reference to a record: its value, or, of a record
    in it, its address.

    context, builder : numba's context of code generation, and builder of LLVM.
    kind : numba's type of the reference.
    reference : the pointer to the record, a value of LLVM.
    name : name of a field of the record; numba has refused other names before, when it typed the
    kernel.
    Returns a value of LLVM: the loaded field, or the pointer to a field that is a record (a
    NamedTuple) itself.
    """
    index = kind.record.fields.index(name)
    at = cgutils.gep_inbounds(builder, reference, 0, index)
    return at if isinstance(kind.record[index], types.NamedTuple) else builder.load(at)


def _load(context, builder, kind, at):
    """Return instructions that load the value of a type from an address, field by field.

    context, builder : numba's context of code generation, and builder of LLVM.
    kind : numba's type of the value.  The fields of a record (NamedTuple), of records in it, and of
        the descriptor of an array are loaded one by one, so that LLVM removes the loads of fields
        that are not used; a value of another type is loaded at once.
    at : its address, a value of LLVM.
    Returns a value of LLVM, of the type that represents ``kind``.
    """
    if not isinstance(kind, (types.NamedTuple, types.Array)):
        return builder.load(at)
    whole = context.get_constant_undef(kind)  # every field of which is set below
    for n in range(len(whole.type.elements)):
        field = cgutils.gep_inbounds(builder, at, 0, n)
        one = (
            _load(context, builder, kind[n], field)
            if isinstance(kind, types.NamedTuple)
            else builder.load(field)
        )
        whole = builder.insert_value(whole, one, n)
    return whole


def _lower_reference(context, builder, signature, arguments):
    """Return instructions that store a record on the stack of the kernel; the value of LLVM is its
    address.
    """
    return cgutils.alloca_once_value(builder, arguments[0])


def _lower_value(context, builder, signature, arguments):
    """Return instructions that load a record from its reference.

    context, builder, signature, arguments : of numba's lowering of (reference).
    """
    return _load(context, builder, signature.return_type, arguments[0])


def _lower_pointer(context, builder, signature, arguments):
    """Return the pointer to the numbers of an array, a value of LLVM."""
    return context.make_array(signature.args[0])(context, builder, arguments[0]).data


#: record -> a reference to it.
by_reference = make_intrinsic(_lower_reference, lambda record: _ReferenceType(record)(record), None)
#: reference -> the record as a value.
by_value = make_intrinsic(_lower_value, lambda reference: reference.record(reference), None)
#: contiguous vector -> pointer to its numbers, valid while the vector exists; read and written by
#: index.
data_pointer = make_intrinsic(
    _lower_pointer, lambda array: types.CPointer(array.dtype)(array), None
)


# --- Assignments to arrays, element by element ---


@kernel
def copy(source, target):
    """Copy ``source`` into ``target``: both have one axis and the same length, not checked here;
    returns nothing.
    """
    for i in range(source.size):
        target[i] = source[i]


@kernel
def fill(value, target):
    """Write ``value``, a number, into every element of ``target``, which has one axis.  Returns
    nothing.
    """
    for i in range(target.size):
        target[i] = value


# --- Bins of a positive float ---

#: Mask of the mantissa of a double.
_MANTISSA = (1 << 52) - 1
#: Bits of the double 1.
_ONE = 1023 << 52


@inline_kernel
def bin_number(x, bits):
    """Return the number of the bin of a number: its exponent and the leading bits of its mantissa.

    x : float, > 0.
    bits : int, 0 ... 51; an octave has 2^bits bins.
    Returns an int, which grows by one from bin to bin; that of x = 1 is 1023 2^bits.
    """
    return float_to_bits(x) >> (52 - bits)


@inline_kernel
def bin_offset(x, bits):
    """Return the mantissa of a number less that of the centre of its bin.

    x : float, > 0, not so small (below 2.3e-308) that it has lost digits.
    bits : int, 0 ... 51; an octave has 2^bits bins.
    Returns a float in [-2^-(bits + 1), 2^-(bits + 1)); mantissas are in [1, 2).
    """
    word = float_to_bits(x)
    # The centre has the leading bits of the mantissa, and then a half bin; both numbers get the
    # exponent of 1.  2 half_bin - 1 masks the bits of the mantissa behind the leading ones.
    half_bin = 1 << (51 - bits)
    centre = bits_to_float((word & (_MANTISSA - (2 * half_bin - 1))) | (_ONE + half_bin))
    return bits_to_float((word & _MANTISSA) | _ONE) - centre
