"""Polynomials in the bits of a float: nodes, fits, integrals, look-up, inverse.

The nodes of a bin are those of Radau's left rule: they interpolate well, and a stiff
equation collocated on them from the right end of a bin to the left is solved stably.
"""

from __future__ import annotations

from decimal import Decimal

from ..compile.fma import fma, septic
from ..compile.jit import kernel
from ..numerics.bins import bin_number, bin_offset
from ..numerics.nodes import Interpolation, radau
from . import layout

N = layout.COEFFICIENTS
BINS = layout.BINS
HALF = 0.5 / BINS

_NODES = Interpolation(radau(N, -1))
NODES = _NODES.nodes
#: values at the nodes to the coefficients of powers of t
FIT = _NODES.powers(HALF)
#: values at the nodes to the integrals from -1 to each node, and to 1
TO_NODES, TO_END = _NODES.integrals(_NODES.exact), _NODES.integrals([Decimal(1)])[0]


@kernel(inline=True)
def bits_and_offset(x):
    """(bits of octave and bin, t) of x > 0."""
    return bin_number(x, layout.BIN_BITS), bin_offset(x, layout.BIN_BITS)


@kernel
def bin_of(x, low):
    """(bin, t) of x > 0 in a table whose first octave is [2**low, 2**(low + 1))."""
    b, t = bits_and_offset(x)
    return b - (1023 + low) * BINS, t


@kernel
def node(b, n, low):
    """Index variable at node n of bin b."""
    octave, part = b // BINS, b % BINS
    return (1.0 + (part + 0.5 + 0.5 * NODES[n]) / BINS) * 2.0 ** (octave + low)


@kernel
def width(b, low):
    """Width of bin b in the index variable."""
    return 2.0 ** (b // BINS + low) / BINS


@kernel(inline=True)
def polynomial(coefficients, at, t):
    """Polynomial whose coefficients start at ``at``."""
    low = (coefficients[at], coefficients[at + 1], coefficients[at + 2], coefficients[at + 3])
    high = (coefficients[at + 4], coefficients[at + 5], coefficients[at + 6], coefficients[at + 7])
    return septic(t, low + high)


@kernel
def value(table, b, column, t):
    """Column of bin b at t."""
    return polynomial(table[b, column], 0, t)


@kernel
def slope(table, b, column, t):
    """Derivative of a column with respect to t."""
    p = table[b, column]
    total = 0.0
    for n in range(N - 1, 0, -1):
        total = fma(t, total, n * p[n])
    return total


@kernel
def fit_column(table, b, column, values):
    """Fit a column of bin b to its values at the nodes."""
    for k in range(N):
        total = 0.0
        for n in range(N):
            total += FIT[k, n] * values[n]
        table[b, column, k] = total


@kernel
def integrate_bin(slopes, start, values):
    """Integral of ``slopes``, over t in [-1, 1], from ``start``: ``values`` at the nodes, and that at the end."""
    end = start
    for n in range(N):
        end += TO_END[n] * slopes[n]
        values[n] = start
        for m in range(N):
            values[n] += TO_NODES[n, m] * slopes[m]
    return end


@kernel
def find(table, column, target, low):
    """(index variable, found) where an increasing column takes a value; below the table it is linear."""
    first, last = 0, table.shape[0] - 1
    bottom = value(table, 0, column, -HALF)
    if target < bottom and bottom > 0.0:
        return target / bottom * 2.0**low, True
    if not target <= value(table, last, column, HALF):
        return 2.0 ** (table.shape[0] // BINS + low), False
    while first < last:
        middle = (first + last + 1) // 2
        if value(table, middle, column, -HALF) <= target:
            first = middle
        else:
            last = middle - 1
    t = 0.0
    for _ in range(20):
        change = (target - value(table, first, column, t)) / slope(table, first, column, t)
        t = max(-HALF, min(HALF, t + change))
        if abs(change) < 1e-15:
            break
    octave, part = first // BINS, first % BINS
    return (1.0 + (part + 0.5) / BINS + t) * 2.0 ** (octave + low), True
