"""Bins of a positive float: an octave [2^n, 2^(n+1)) is cut into 2^bits of them by the leading bits of its mantissa.

No logarithm is taken: the number of the bin is read off the bits of the float.  In a bin functions are polynomials of
the offset t of the mantissa from the centre of the bin.
"""

from ..compile.intrinsics import bits_to_float, float_to_bits
from ..compile.jit import inline_kernel

#: Mask of the mantissa of a double.
_MANTISSA = (1 << 52) - 1
#: Bits of the double 1.
_ONE = 1023 << 52


@inline_kernel
def bin_number(x, bits):
    """Return the number of the bin of ``x`` > 0, an int: its exponent and the leading ``bits`` bits of its mantissa.

    An octave has 2^bits bins.  The number grows by one from bin to bin; that of x = 1 is 1023 2^bits.
    """
    return float_to_bits(x) >> (52 - bits)


@inline_kernel
def bin_offset(x, bits):
    """Return the mantissa, in [1, 2), of ``x`` > 0 less that of the centre of its bin; an octave has 2^bits bins."""
    word = float_to_bits(x)
    half = 1 << (51 - bits)
    centre = bits_to_float((word & (_MANTISSA - (2 * half - 1))) | (_ONE + half))
    return bits_to_float((word & _MANTISSA) | _ONE) - centre
