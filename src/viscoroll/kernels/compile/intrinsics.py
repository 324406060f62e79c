"""Instructions of LLVM that kernels call like functions: a fused product and sum, bits of a double, calls by address.

**Fused product and sum.**  LLVM could fuse products and sums by itself (``fastmath={"contract"}``).  Its choice depends
on the functions that it sees, and so on whether they were compiled in the same process or came from the cache: the last
bits of a result would follow the history of the cache.  So only polynomials, where most of the time is spent, call
:func:`fma`.

**Calls by address.**  A kernel that is called by its address is compiled once, by itself, and not again with each
caller. Such a kernel takes a number and a record that contains addresses of arrays, and returns nothing.
"""

from collections.abc import Callable
from functools import cache
from inspect import Parameter, Signature

import numba
import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import cgutils, types
from numba.extending import intrinsic

from .jit import inline_kernel, kernel

#: a 64-bit integer of LLVM, which holds an address
_WORD = ir.IntType(64)
#: type of a kernel that is called by its address: (number, address of a record) -> nothing
_FUNCTION = ir.FunctionType(ir.VoidType(), [_WORD, _WORD])


def make_intrinsic(lower: Callable, returned, *kinds):
    """Return a function for kernels that is lowered to instructions of LLVM.

    lower : (context, builder, signature, arguments) -> value of LLVM; numba calls it with its context of code
        generation, the builder of LLVM, its signature of the call and the values of LLVM of the arguments.
    returned : a callable that gives numba's signature of the call from the types of the arguments: numba's type of the
        value, or a function.
    kinds : numba's types of the arguments, None for any type, in their number and order.  A type replaces that of the
        argument in the call, which numba converts; a literal integer is thus passed as an int64.
    Returns numba's intrinsic, which is called in kernels with these arguments, by position.
    """

    def give_signature(context, *arguments):
        return returned(*(kind or own for kind, own in zip(kinds, arguments, strict=True))), lower

    names = ["context", *(f"given_{n}" for n in range(len(kinds)))]
    give_signature.__signature__ = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in names])
    return intrinsic(give_signature)


def call_llvm(builder, name: str, arguments):
    """Return the call of an intrinsic of LLVM whose arguments and value have one type.

    builder : builder of LLVM, at whose position the call is emitted; the intrinsic is declared in ``builder.module`` if
        it is not yet.
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

    integers, floats : names of the fields of either kind, in their order, separated by blanks; no doubles by default.
    Returns a numpy dtype without padding, 8 bytes a field.
    """
    return np.dtype([(name, np.int64) for name in integers.split()] + [(name, np.float64) for name in floats.split()])


@cache
def function_address(function, record: np.dtype, returned=types.void, *first) -> int:
    """Return the address of the machine code of a kernel for calls from C or from other kernels, compiled for given
    types.

    function : the kernel, numba's dispatcher, whose last argument is a pointer to a record.
    record : dtype of that record.
    returned : numba's type of its value; by default nothing.
    first : numba's types of the arguments in front of the record; by default one 64-bit integer.
    Returns the address as an int, valid in this process.  The kernel is compiled in the first call with these types; a
    further call returns the same address.  Raises numba's error if the kernel cannot be compiled for these types.
    """
    kinds = *(first or (types.int64,)), types.CPointer(numba.from_dtype(record))
    function.compile(returned(*kinds))
    compiled = function.overloads[kinds]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))


@kernel(inline=True, allocates=True)
def floats_at(address, size):
    """Return the vector of ``size`` doubles at an address, an array of numpy that shares the memory.

    address : int, the address, which is not checked; the memory must exist as long as the vector is used.
    size : int, number of doubles, at least 0.
    """
    return carray(_to_doubles(address), size)


@kernel(inline=True, allocates=True)
def integers_at(address, size):
    """Return the vector of ``size`` 64-bit integers at an address, as :func:`floats_at` returns that of doubles."""
    return carray(_to_integers(address), size)


@kernel(inline=True, allocates=True)
def record_at(pointer):
    """Return the record to which a pointer points, numba's view of it; its fields are read by name from the memory."""
    return carray(pointer, 1)[0]


@inline_kernel
def septic(t, c):
    """Return the polynomial c[0] + c[1] t + ... + c[7] t^7, by Estrin's scheme, whose parts are independent of one
    another.

    t : argument, float.
    c : coefficients, the constant first, at least 8 floats, of which the first 8 are read; the length is not checked.
    Returns a float, NaN if ``t`` or a coefficient is NaN.
    """
    t2 = t * t
    low = fma(t2, fma(t, c[3], c[2]), fma(t, c[1], c[0]))
    high = fma(t2, fma(t, c[7], c[6]), fma(t, c[5], c[4]))
    return fma(t2 * t2, high, low)
