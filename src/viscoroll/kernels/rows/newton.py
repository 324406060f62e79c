"""Newton's polynomial through scattered points, read at the 24 nodes of a row and turned into powers of t."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.four import LANES, fused, load, slide, spread, store
from ..numerics.nodes import chebyshev, powers_of_chebyshev, rounded, to_chebyshev
from .lanes import TERMS

#: points of a polynomial
POINTS = 36
#: where scratch is in ``numbers``, four that are no points in front of each: arguments of the points, then values and
#: differences of one function, and those of another; values at the nodes of a row; Chebyshev coefficients; its end
_ROOM = LANES + POINTS
OTHER = 2 * _ROOM
X, VALUES, Y, _C, SCRATCH = LANES, LANES + _ROOM, 5 * _ROOM, 5 * _ROOM + TERMS, 5 * _ROOM + 2 * TERMS
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


@kernel(inline=True)
def _put_row(a, to, numbers):
    """Twenty-four numbers."""
    a0, a1, a2, a3, a4, a5 = a
    store(numbers, to, a0)
    store(numbers, to + LANES, a1)
    store(numbers, to + 2 * LANES, a2)
    store(numbers, to + 3 * LANES, a3)
    store(numbers, to + 4 * LANES, a4)
    store(numbers, to + 5 * LANES, a5)


@kernel(inline=True)
def _row(values, at):
    """Likewise."""
    low = load(values, at), load(values, at + LANES), load(values, at + 2 * LANES)
    return *low, load(values, at + 3 * LANES), load(values, at + 4 * LANES), load(values, at + 5 * LANES)


@kernel
def read(nodes, which, numbers):
    """Values of a function's polynomial at the nodes of a row."""
    at = VALUES + OTHER * which + _ROOM
    x0, x1, x2, x3, x4, x5 = _row(nodes, 0)
    a0 = a1 = a2 = a3 = a4 = a5 = spread(numbers[at + POINTS - 1])
    for n in range(POINTS - 2, -1, -1):
        x, d = spread(numbers[X + n]), spread(numbers[at + n])
        a0, a1, a2 = fused(x0 - x, a0, d), fused(x1 - x, a1, d), fused(x2 - x, a2, d)
        a3, a4, a5 = fused(x3 - x, a3, d), fused(x4 - x, a4, d), fused(x5 - x, a5, d)
    _put_row((a0, a1, a2, a3, a4, a5), Y, numbers)


@kernel(inline=True)
def product(matrix, first, terms, given, to, numbers):
    """Of so many numbers and a matrix whose rows of 24 stand one after another from ``first`` on."""
    a0 = a1 = a2 = a3 = a4 = a5 = spread(0.0)
    for n in range(terms):
        x, (m0, m1, m2, m3, m4, m5) = spread(numbers[given + n]), _row(matrix, first + TERMS * n)
        a0, a1, a2 = fused(m0, x, a0), fused(m1, x, a1), fused(m2, x, a2)
        a3, a4, a5 = fused(m3, x, a3), fused(m4, x, a4), fused(m5, x, a5)
    _put_row((a0, a1, a2, a3, a4, a5), to, numbers)


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
