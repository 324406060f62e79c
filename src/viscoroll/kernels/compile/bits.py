"""The bits of a double as an integer, and back: numba compiles ``view`` in each kernel that takes it, in 0.1 s."""

from __future__ import annotations

from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic


def _cast(given: Any, found: Any, kind: Any, interpreted: Callable) -> Callable:
    def typed(typing_context, x):
        return found(given), lambda context, builder, signature, args: builder.bitcast(args[0], kind)

    return interpreted if numba.config.DISABLE_JIT else intrinsic(typed)


bits_of = _cast(types.float64, types.int64, ir.IntType(64), lambda x: np.float64(x).view(np.int64))
from_bits = _cast(types.int64, types.float64, ir.DoubleType(), lambda n: np.int64(n).view(np.float64))
