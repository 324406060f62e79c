"""Newton's polynomial through scattered points, read at the 24 nodes of a row and turned into powers of t."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.interpolation import chebyshev, powers_of_chebyshev, to_chebyshev, to_doubles
from ..numerics.simd4 import LANES, broadcast, fma4, load, make_load, shift_in, store
from .simd_polynomial import TERMS

#: points of a polynomial
POINT_COUNT = 36
#: where scratch is in ``numbers``, four that are no points in front of each: arguments of the points, then values and
#: differences of one function, and those of another; values at the nodes of a row; Chebyshev coefficients; its end
_ROOM = LANES + POINT_COUNT
FUNCTION_STRIDE = 2 * _ROOM
ARGUMENTS, VALUES, NODE_VALUES, _C, SCRATCH_SIZE = (
    LANES,
    LANES + _ROOM,
    5 * _ROOM,
    5 * _ROOM + TERMS,
    5 * _ROOM + 2 * TERMS,
)
#: the 24 numbers of a row
load_row = make_load(TERMS // LANES)
NODES = to_doubles(chebyshev(TERMS))
#: in the slow row a Chebyshev coefficient below this share of the function is rounding
_ROUNDING = 4e-16
#: a row a node: what its value adds to the coefficients
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T).ravel()
_POWERS, _SLOW_POWERS = (powers_of_chebyshev(TERMS, shift, 1.0 + shift).ravel() for shift in (0.0, 1.0))


@kernel
def divided_differences(count, numbers):
    """Newton's divided differences, four at a time, from the last point down: behind the values of every function.

    What lies below an order's first difference is spoilt, and not asked for any more.
    """
    for which in range(count):
        at = VALUES + FUNCTION_STRIDE * which
        numbers[at + _ROOM] = numbers[at]
    for order in range(1, POINT_COUNT):
        first = POINT_COUNT - LANES
        while first > order - LANES:
            here = ARGUMENTS + first
            per = 1.0 / (load(numbers, here) - load(numbers, here - order))
            for which in range(count):
                at = VALUES + FUNCTION_STRIDE * which + first
                known = load(numbers, at)
                store(numbers, at, (known - shift_in(load(numbers, at - LANES), known)) * per)
            first -= LANES
        for which in range(count):
            at = VALUES + FUNCTION_STRIDE * which + order
            numbers[at + _ROOM] = numbers[at]


@kernel
def evaluate_at_nodes(nodes, which, numbers):
    """Values of a function's polynomial at the nodes of a row."""
    at = VALUES + FUNCTION_STRIDE * which + _ROOM
    x, last = load_row(nodes, 0), broadcast(numbers[at + POINT_COUNT - 1])
    value = last, last, last, last, last, last
    for n in range(POINT_COUNT - 2, -1, -1):
        away = fma4(x, broadcast(1.0), broadcast(-numbers[ARGUMENTS + n]))
        value = fma4(away, value, broadcast(numbers[at + n]))
    store(numbers, NODE_VALUES, value)


@kernel(inline=True)
def matrix_vector_product(matrix, first, terms, given, to, numbers):
    """Of so many numbers and a matrix whose rows of 24 stand one after another from ``first`` on."""
    zero = broadcast(0.0)
    total = zero, zero, zero, zero, zero, zero
    for n in range(terms):
        total = fma4(load_row(matrix, first + TERMS * n), broadcast(numbers[given + n]), total)
    store(numbers, to, total)


@kernel
def to_powers(slow, limit, numbers):
    """From values at the nodes to powers of t; in the slow row, of values less ``limit``, without rounding."""
    if not slow:
        limit = numbers[NODE_VALUES + TERMS // 2]
        for k in range(TERMS):
            numbers[NODE_VALUES + k] -= limit
    matrix_vector_product(_TO_CHEBYSHEV, 0, TERMS, NODE_VALUES, _C, numbers)
    if slow:
        least = limit
        for k in range(TERMS):
            least = max(least, abs(numbers[_C + k]))
        for k in range(TERMS):
            if k == TERMS - 1 or abs(numbers[_C + k]) < _ROUNDING * least:
                numbers[_C + k] = 0.0
    matrix_vector_product(_SLOW_POWERS if slow else _POWERS, 0, TERMS, _C, NODE_VALUES, numbers)
    numbers[NODE_VALUES] += limit
