"""a b + c in one rounding, where it is asked for by name.

LLVM could be left to fuse what it likes (``fastmath={"contract"}``).  Its choice then depends
on what it sees of the functions called, and that on whether they were compiled in the same
process or came from the cache: the last bits of a result would follow the history of the cache.
Here nothing is fused but the polynomials, where most of the time goes and most of the gain is.
"""

from __future__ import annotations

import numba
from numba.core import types
from numba.extending import intrinsic

from .jit import kernel


@intrinsic
def _fused(typing_context, a, b, c):
    """LLVM's fma: an instruction where the processor has one, else a call of the C library's."""
    double = types.float64
    return double(double, double, double), lambda context, builder, signature, given: builder.fma(*given)


def _interpreted(a, b, c):
    return a * b + c


#: a b + c, rounded once; where numba is switched off, twice
fma = _interpreted if numba.config.DISABLE_JIT else _fused


@kernel(inline=True)
def septic(t, c):
    """c[0] + c[1] t + ... + c[7] t^7, by Estrin's scheme: its parts do not wait for one another."""
    t2 = t * t
    low = fma(t2, fma(t, c[3], c[2]), fma(t, c[1], c[0]))
    high = fma(t2, fma(t, c[7], c[6]), fma(t, c[5], c[4]))
    return fma(t2 * t2, high, low)
