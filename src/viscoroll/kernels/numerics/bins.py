"""Bins of a positive float: an octave [2^n, 2^(n+1)) is cut into 2^bits of them by the leading bits of its mantissa.

No logarithm is taken: number and place are read off the bits of the float.  In a bin functions are
polynomials of the offset t of the mantissa from the centre of the bin.
"""

from __future__ import annotations

from ..compile.intrinsics import bits_to_float, float_to_bits
from ..compile.jit import kernel

_MANTISSA = (1 << 52) - 1
_ONE = 1023 << 52


@kernel(inline=True)
def bin_number(x, bits):
    """Exponent and leading mantissa bits of x > 0: rises by one from bin to bin."""
    return float_to_bits(x) >> (52 - bits)


@kernel(inline=True)
def bin_offset(x, bits):
    """Mantissa of x less that of the centre of its bin."""
    word, half = float_to_bits(x), 1 << (51 - bits)
    centre = bits_to_float((word & (_MANTISSA - (2 * half - 1))) | (_ONE + half))
    return bits_to_float((word & _MANTISSA) | _ONE) - centre
