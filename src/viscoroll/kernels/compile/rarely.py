"""A hint to LLVM: ``if rarely(condition)`` keeps what the branch needs out of the way that is taken nearly always."""

from __future__ import annotations

from llvmlite import ir
from numba.core import types

from .instruction import called, instruction


def _expect(context, builder, signature, given):
    return called(builder, "llvm.expect.i1", [*given, ir.IntType(1)(0)])


rarely = instruction(_expect, types.boolean, types.boolean)
