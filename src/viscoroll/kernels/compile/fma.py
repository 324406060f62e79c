"""a b + c in one rounding, where it is asked for by name.

LLVM could be left to fuse what it likes (``fastmath={"contract"}``).  Its choice then depends
on what it sees of the functions called, and that on whether they were compiled in the same
process or came from the cache: the last bits of a result would follow the history of the cache.
Here nothing is fused but the polynomials, where most of the time goes and most of the gain is.
"""

from __future__ import annotations

from numba.core import types

from .instruction import instruction
from .jit import kernel


def _fma(context, builder, signature, given):
    """An instruction where the processor has one, else a call of the C library's."""
    return builder.fma(*given)


#: a b + c, rounded once
fma = instruction(_fma, *[types.float64] * 4)


@kernel(inline=True)
def septic(t, c):
    """c[0] + c[1] t + ... + c[7] t^7, by Estrin's scheme: its parts do not wait for one another."""
    t2 = t * t
    low = fma(t2, fma(t, c[3], c[2]), fma(t, c[1], c[0]))
    high = fma(t2, fma(t, c[7], c[6]), fma(t, c[5], c[4]))
    return fma(t2 * t2, high, low)
