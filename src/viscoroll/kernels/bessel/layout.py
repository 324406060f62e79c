"""Layout of the coefficient table ``ratios.npy``, shared by its builder and its reader.

Each segment covers whole octaves ``[2**low, 2**high)`` of its argument.  An octave is cut
into :data:`BINS` equal bins of the mantissa m in [1, 2); in each bin the function is a
polynomial of degree :data:`DEGREE` in t = m - (centre of the bin), constant term first.
A bin spans 1/33 of the distance to the nearest singularity of the function (the origin for
k), so the truncation error falls like 66**-(DEGREE + 1) = 4e-17.
"""

from typing import NamedTuple

#: Bins of an octave.
BINS = 16
#: Degree of a polynomial: the truncation error is below a quarter of the rounding of doubles.
DEGREE = 8
#: Coefficients of a polynomial.
COEFFICIENTS = DEGREE + 1


class Segment(NamedTuple):
    """Octaves [2**low, 2**high) of one tabulated function.

    function : str, its formula, in the words of the paper.
    low, high : int, exponents of the ends.
    """

    function: str
    low: int
    high: int


#: Segments of the table, in their order.
SEGMENTS = (
    Segment("r(x)/x", -4, 1),
    Segment("x (1 - r(x))", 1, 6),
    Segment("k(z)/z", -30, 0),
    Segment("z (1 - k(z))", 0, 6),
    Segment("i2(x)/x^2", -4, 2),
)


def segment_start(index: int) -> int:
    """Return the position, an int, of the first coefficient of segment number ``index``, from 0, in the flat table; of
    ``index`` = the number of segments the size of the table.
    """
    return sum((s.high - s.low) * BINS * COEFFICIENTS for s in SEGMENTS[:index])


#: Numbers of the table.
TABLE_SIZE = segment_start(len(SEGMENTS))
