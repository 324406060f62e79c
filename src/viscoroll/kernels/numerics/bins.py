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
    """Return the number of the bin of a number: its exponent and the leading bits of its mantissa.

    x : float, > 0.
    bits : int, 0 ... 51; an octave has 2^bits bins.
    Returns an int, which grows by one from bin to bin; that of x = 1 is 1023 2^bits.
    """
    return float_to_bits(x) >> (52 - bits)


@inline_kernel
def bin_offset(x, bits):
    """Return the mantissa of a number less that of the centre of its bin.

    x : float, > 0, not so small (below 2.3e-308) that it has lost digits.
    bits : int, 0 ... 51; an octave has 2^bits bins.
    Returns a float in [-2^-(bits + 1), 2^-(bits + 1)); mantissas are in [1, 2).
    """
    word = float_to_bits(x)
    half = 1 << (51 - bits)
    centre = bits_to_float((word & (_MANTISSA - (2 * half - 1))) | (_ONE + half))
    return bits_to_float((word & _MANTISSA) | _ONE) - centre
