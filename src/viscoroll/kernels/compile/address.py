"""Kernels that are called by their address: compiled by themselves, once, and not again with each of their callers.

Such a kernel takes a number and a record that holds addresses of arrays, and returns nothing.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import types

from .instruction import instruction
from .jit import kernel

_WORD = ir.IntType(64)
_FUNCTION = ir.FunctionType(ir.VoidType(), [_WORD, _WORD])


@cache
def address_of(function: Any, record: np.dtype, returned: Any = types.void, *first: Any) -> int:
    """Where the code of a kernel of a number, or of what comes ``first``, and a pointer to a record begins."""
    kinds = *(first or (types.int64,)), types.CPointer(numba.from_dtype(record))
    function.compile(returned(*kinds))
    compiled = function.overloads[kinds]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))


def _call(context, builder, signature, given):
    builder.call(builder.inttoptr(given[0], _FUNCTION.as_pointer()), given[1:])
    return context.get_dummy_value()


def _pointer(context, builder, signature, given):
    return builder.inttoptr(given[0], context.get_value_type(signature.return_type))


_to_doubles, _to_integers = (
    instruction(_pointer, types.CPointer(kind), types.int64) for kind in (types.float64, types.int64)
)
#: (address, number, address of a record): call that kernel
call = instruction(_call, types.void, *[types.int64] * 3)


@kernel(inline=True, allocates=True)
def doubles(address, size):
    """The vector there."""
    return carray(_to_doubles(address), size)


@kernel(inline=True, allocates=True)
def integers(address, size):
    """Likewise."""
    return carray(_to_integers(address), size)


@kernel(inline=True, allocates=True)
def record_at(pointer):
    """What a pointer to a record points to."""
    return carray(pointer, 1)[0]
