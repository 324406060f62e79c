"""Kernels that are called by their address: compiled by themselves, once, and not again with each of their callers.

Such a kernel takes a number and a record that holds addresses of arrays, and returns nothing.
"""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import types
from numba.extending import intrinsic

from .jit import kernel

_WORD = ir.IntType(64)
_FUNCTION = ir.FunctionType(ir.VoidType(), [_WORD, _WORD])
#: kernels and their records, where numba compiles nothing: an address is a place in it, from 1 on
_plain: list[tuple[Callable, np.dtype]] = []


@cache
def address_of(function: Any, record: np.dtype) -> int:
    """Where the code of a kernel (number, pointer to a record) begins."""
    if numba.config.DISABLE_JIT:
        _plain.append((function, record))
        return len(_plain)
    kinds = types.int64, types.CPointer(numba.from_dtype(record))
    function.compile(types.void(*kinds))
    compiled = function.overloads[kinds]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))


def _call(typing_context, address, number, record):
    def lower(context, builder, signature, given):
        builder.call(builder.inttoptr(given[0], _FUNCTION.as_pointer()), given[1:])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), lower


def _pointer_to(kind, element):
    def typed(typing_context, address):
        def lower(context, builder, signature, given):
            return builder.inttoptr(given[0], element.as_pointer())

        return types.CPointer(kind)(types.int64), lower

    return intrinsic(typed)


_to_doubles, _to_integers = _pointer_to(types.float64, ir.DoubleType()), _pointer_to(types.int64, _WORD)


@kernel(inline=True, allocates=True)
def _doubles(address, size):
    return carray(_to_doubles(address), size)


@kernel(inline=True, allocates=True)
def _integers(address, size):
    return carray(_to_integers(address), size)


@kernel(inline=True, allocates=True)
def _record_at(pointer):
    return carray(pointer, 1)[0]


def _call_plain(address: int, number: int, record: int) -> None:
    function, kind = _plain[address - 1]
    pointer = np.frombuffer((ctypes.c_char * kind.itemsize).from_address(record), kind)
    function(number, pointer.view(np.recarray))


def _vector_of(kind: Any) -> Callable:
    return lambda address, size: np.ctypeslib.as_array((kind * int(size)).from_address(int(address)))


if numba.config.DISABLE_JIT:
    call, record_at = _call_plain, lambda pointer: pointer[0]
    doubles, integers = _vector_of(ctypes.c_double), _vector_of(ctypes.c_int64)
else:
    #: (address, number, address of a record): call that kernel
    call = intrinsic(_call)
    #: what a pointer to a record points to
    record_at = _record_at
    #: (address, size) -> the vector there
    doubles, integers = _doubles, _integers
