"""Newton's polynomial through scattered points, read at the 24 nodes of a row and turned into powers of t."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.four import LANES, fused, load, loads, slide, spread, store
from ..numerics.nodes import chebyshev, powers_of_chebyshev, rounded, to_chebyshev
from .lanes import TERMS

#: points of a polynomial
POINTS = 36
#: where scratch is in ``numbers``, four that are no points in front of each: arguments of the points, then values and
#: differences of one function, and those of another; values at the nodes of a row; Chebyshev coefficients; its end
_ROOM = LANES + POINTS
OTHER = 2 * _ROOM
X, VALUES, Y, _C, SCRATCH = LANES, LANES + _ROOM, 5 * _ROOM, 5 * _ROOM + TERMS, 5 * _ROOM + 2 * TERMS
#: the 24 numbers of a row
row = loads(TERMS // LANES)
NODES = rounded(chebyshev(TERMS))
#: in the slow row a Chebyshev coefficient below this share of the function is rounding
_ROUNDING = 4e-16
#: a row a node: what its value adds to the coefficients
_TO_CHEBYSHEV = np.ascontiguousarray(to_chebyshev(TERMS).T).ravel()
_POWERS, _SLOW_POWERS = (powers_of_chebyshev(TERMS, shift, 1.0 + shift).ravel() for shift in (0.0, 1.0))


@kernel
def differences(count, numbers):
    """Newton's divided differences, four at a time, from the last point down: behind the values of every function.

    What lies below an order's first difference is spoilt, and not asked for any more.
    """
    for which in range(count):
        at = VALUES + OTHER * which
        numbers[at + _ROOM] = numbers[at]
    for order in range(1, POINTS):
        first = POINTS - LANES
        while first > order - LANES:
            here = X + first
            per = 1.0 / (load(numbers, here) - load(numbers, here - order))
            for which in range(count):
                at = VALUES + OTHER * which + first
                known = load(numbers, at)
                store(numbers, at, (known - slide(load(numbers, at - LANES), known)) * per)
            first -= LANES
        for which in range(count):
            at = VALUES + OTHER * which + order
            numbers[at + _ROOM] = numbers[at]


@kernel
def read(nodes, which, numbers):
    """Values of a function's polynomial at the nodes of a row."""
    at = VALUES + OTHER * which + _ROOM
    x, last = row(nodes, 0), spread(numbers[at + POINTS - 1])
    value = last, last, last, last, last, last
    for n in range(POINTS - 2, -1, -1):
        away = fused(x, spread(1.0), spread(-numbers[X + n]))
        value = fused(away, value, spread(numbers[at + n]))
    store(numbers, Y, value)


@kernel(inline=True)
def product(matrix, first, terms, given, to, numbers):
    """Of so many numbers and a matrix whose rows of 24 stand one after another from ``first`` on."""
    zero = spread(0.0)
    total = zero, zero, zero, zero, zero, zero
    for n in range(terms):
        total = fused(row(matrix, first + TERMS * n), spread(numbers[given + n]), total)
    store(numbers, to, total)


@kernel
def turn(slow, limit, numbers):
    """From values at the nodes to powers of t; in the slow row, of values less ``limit``, without rounding."""
    if not slow:
        limit = numbers[Y + TERMS // 2]
        for k in range(TERMS):
            numbers[Y + k] -= limit
    product(_TO_CHEBYSHEV, 0, TERMS, Y, _C, numbers)
    if slow:
        least = limit
        for k in range(TERMS):
            least = max(least, abs(numbers[_C + k]))
        for k in range(TERMS):
            if k == TERMS - 1 or abs(numbers[_C + k]) < _ROUNDING * least:
                numbers[_C + k] = 0.0
    product(_SLOW_POWERS if slow else _POWERS, 0, TERMS, _C, Y, numbers)
    numbers[Y] += limit
