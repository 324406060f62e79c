"""Newton's polynomial through scattered points, as the powers of t in a row of a law.

The polynomial through :data:`POINT_COUNT` points is evaluated at the 24 nodes of a row and turned
into powers of t, by way of Chebyshev coefficients.  The kernels are called in this order:
:func:`divided_differences`, of up to two functions at once; then for each of them
:func:`evaluate_at_nodes` and :func:`to_powers`.

All of it works on one vector ``scratch``: the arguments of the points; for each of up to two
functions their values, and after them the leading divided differences; values at the nodes;
Chebyshev coefficients.  In front of arguments and values four numbers are kept free, so that
vectors of four (:mod:`.simd`) may reach below the first point.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

import numpy as np

from .interpolation import chebyshev, powers_of_chebyshev, to_chebyshev, to_doubles
from .jit import inline_kernel, kernel
from .simd import LANES, TERMS, broadcast, fma4, load, make_load, shift_in, store

#: Points of a polynomial; with 10 points an octave the error then is that of rounding.
POINT_COUNT = 36
#: Numbers of one vector over the points, with the four in front.
_BLOCK = LANES + POINT_COUNT
#: Position in ``scratch`` of the arguments of the points.
ARGUMENTS = LANES
#: Position of the values of the first function; its divided differences are one block further.
VALUES = LANES + _BLOCK
#: Distance from the values of the first function to those of the second.
FUNCTION_STRIDE = 2 * _BLOCK
#: Position of the values at the nodes of a row, and later of the powers of t.
NODE_VALUES = 5 * _BLOCK
#: Position of the Chebyshev coefficients.
_COEFFICIENTS = NODE_VALUES + TERMS
#: Numbers of ``scratch``.
SCRATCH_SIZE = _COEFFICIENTS + TERMS
#: (array, start) -> 24 numbers, as six vectors of four.
load_row = make_load(TERMS // LANES)
#: Nodes of a row: the zeros of T_24 on [-1, 1].
NODES = to_doubles(chebyshev(TERMS))
#: In the slow row a Chebyshev coefficient below this fraction of the function is rounding and is
#: set to zero.
_ROUNDING = 4e-16
#: From values at the nodes to Chebyshev coefficients: for each node, 24 numbers.
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T).ravel()
#: From Chebyshev coefficients to powers of t in [-1, 1]: for each coefficient, 24 numbers.
_POWERS = powers_of_chebyshev(TERMS, 0.0, 1.0).ravel()
#: The same for t in [0, 1], in the slow row.
_SLOW_POWERS = powers_of_chebyshev(TERMS, 1.0, 2.0).ravel()


@kernel
def divided_differences(count, scratch):
    """Compute the leading divided differences of ``count`` functions from arguments and values in
    ``scratch``.

    They are the coefficients of Newton's polynomial through the points.  Each order is computed in
    place, four at a time, from the last point down.  The entries below the first difference of an
    order are overwritten and are not read again.

    count : int, number of functions, 1 or 2.
    scratch : vector of SCRATCH_SIZE numbers with POINT_COUNT arguments, all different, from
        ARGUMENTS on, and as many values from VALUES on, those of the second function
        FUNCTION_STRIDE further.  POINT_COUNT differences of each function, those of order 0 first,
        are written one block (40 numbers) after the begin of its values, and the values are
        overwritten.  Returns nothing.
    """
    for order in range(POINT_COUNT):
        # From the last four points down to those that contain number ``order``: difference k of an
        # order is (d_k - d_(k - 1))/(x_k - x_(k - order)) with those of the order before.
        # Order 0 is the values.  A vector that reaches below number ``order`` overwrites numbers
        # that are not read again; below point 0 lie the four numbers that are kept free.
        first = POINT_COUNT - LANES
        while order > 0 and first > order - LANES:
            x = ARGUMENTS + first
            inverse = 1.0 / (load(scratch, x) - load(scratch, x - order))
            for which in range(count):
                start = VALUES + FUNCTION_STRIDE * which + first
                upper = load(scratch, start)
                store(
                    scratch,
                    start,
                    (upper - shift_in(load(scratch, start - LANES), upper)) * inverse,
                )
            first -= LANES
        # the leading difference, that of the points 0 to ``order``, to where it is kept
        for which in range(count):
            start = VALUES + FUNCTION_STRIDE * which + order
            scratch[start + _BLOCK] = scratch[start]


@kernel
def evaluate_at_nodes(nodes, which, scratch):
    """Evaluate Newton's polynomial of one function at the 24 nodes of a row, and write the values
    into ``scratch``.

    nodes : (24,) contiguous floats, the nodes in the variable of the arguments in ``scratch``.
    which : int, 0 or 1, index of the function.
    scratch : vector of this module with arguments and with the divided differences of that
        function; 24 values are written from NODE_VALUES on, in the order of ``nodes``, over those
        of another function.  Returns nothing.
    """
    start = VALUES + FUNCTION_STRIDE * which + _BLOCK  # of the divided differences
    x = load_row(nodes, 0)
    last = broadcast(scratch[start + POINT_COUNT - 1])
    # Horner's scheme of Newton's form, at 24 nodes at once: six vectors; fma4 takes tuples, so that
    # x - x_n is written as x 1 + (-x_n)
    value = last, last, last, last, last, last
    for n in range(POINT_COUNT - 2, -1, -1):
        distance = fma4(x, broadcast(1.0), broadcast(-scratch[ARGUMENTS + n]))
        value = fma4(distance, value, broadcast(scratch[start + n]))
    store(scratch, NODE_VALUES, value)


@inline_kernel
def sum_of_rows(matrix, factors, to, numbers):
    """Write the sum of 24 rows of 24 numbers, each times a factor: the product of a matrix and a
    vector.

    matrix : contiguous vector of doubles in which the rows follow each other.
    factors, to : int, indices in ``numbers`` at which the factors begin, and the sum.
    numbers : contiguous vector with the factors; the sum, 24 numbers, is written after all factors
        have been read, so that the two may overlap.  Returns nothing.
    """
    # six vectors, the 24 numbers of a row, which stay in registers until all rows are added
    zero = broadcast(0.0)
    total = zero, zero, zero, zero, zero, zero
    for n in range(TERMS):
        total = fma4(load_row(matrix, TERMS * n), broadcast(numbers[factors + n]), total)
    store(numbers, to, total)


@kernel
def to_powers(slow, limit, scratch):
    """Replace the values of a function at the 24 nodes of a row by its coefficients of the powers
    of t.

    The way is by Chebyshev coefficients, of the values less a reference value, which keeps rounding
    errors small.

    slow : bool, whether this is the slow row, where t is in [0, 1]; there the last Chebyshev
        coefficient, and those below 4e-16 of the largest one and of ``limit``, are set to zero.
        The other rows have t in [-1, 1].
    limit : float; in the slow row the value at t = 0, which has been subtracted from the values at
        the nodes and is added to the constant coefficient.  In the other rows it is not read: the
        value at a middle node takes its place.
    scratch : vector of this module; 24 values from NODE_VALUES on are read, and the 24
        coefficients, the constant first, are written in their place.  Chebyshev coefficients are
        left after them.  Returns nothing.
    """
    if not slow:  # The value at a middle node is the reference value.
        limit = scratch[NODE_VALUES + TERMS // 2]
        for k in range(TERMS):
            scratch[NODE_VALUES + k] -= limit
    sum_of_rows(_TO_CHEBYSHEV, NODE_VALUES, _COEFFICIENTS, scratch)
    if slow:  # Coefficients that are rounding are set to 0.
        largest = limit
        for k in range(TERMS):
            largest = max(largest, abs(scratch[_COEFFICIENTS + k]))
        for k in range(TERMS):
            if k == TERMS - 1 or abs(scratch[_COEFFICIENTS + k]) < _ROUNDING * largest:
                scratch[_COEFFICIENTS + k] = 0.0
    sum_of_rows(_SLOW_POWERS if slow else _POWERS, _COEFFICIENTS, NODE_VALUES, scratch)
    scratch[NODE_VALUES] += limit  # the reference value back to the constant
