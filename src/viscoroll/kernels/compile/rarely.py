"""A hint to LLVM: ``if rarely(condition)`` keeps what the branch needs out of the way that is taken nearly always."""

from __future__ import annotations

import numba
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic


@intrinsic
def _rarely(typing_context, condition):
    bit = ir.IntType(1)

    def lower(context, builder, signature, given):
        expect = cgutils.get_or_insert_function(builder.module, ir.FunctionType(bit, [bit, bit]), "llvm.expect.i1")
        return builder.call(expect, [given[0], bit(0)])

    return types.boolean(types.boolean), lower


rarely = bool if numba.config.DISABLE_JIT else _rarely
