"""Bins of a positive float: an octave [2^n, 2^(n+1)) is cut into 2^bits of them by the leading bits of its mantissa.

No logarithm is taken: number and place are read off the bits of the float.  In a bin functions are
polynomials of the offset t of the mantissa from the centre of the bin.
"""

from __future__ import annotations

from ..compile.bits import bits_of, from_bits
from ..compile.jit import kernel

_MANTISSA = (1 << 52) - 1
_ONE = 1023 << 52


@kernel(inline=True)
def bin_number(x, bits):
    """Exponent and leading mantissa bits of x > 0: rises by one from bin to bin."""
    return bits_of(x) >> (52 - bits)


@kernel(inline=True)
def bin_offset(x, bits):
    """Mantissa of x less that of the centre of its bin."""
    word, half = bits_of(x), 1 << (51 - bits)
    centre = from_bits((word & (_MANTISSA - (2 * half - 1))) | (_ONE + half))
    return from_bits((word & _MANTISSA) | _ONE) - centre
