"""Four functions of one variable by polynomials, in bins that are made where they are met and kept.

A bin is an eighth of an octave (:mod:`bins`), and a polynomial is of degree 10: where the functions are analytic for
Re x > 0 its error falls like 34^-11.  A table keeps a bin in the row of the last bits of its number, which the
row begins with; a row that holds another bin is made anew.  So any x is served, and what a bin holds depends on nothing
but its number.  The four functions lie side by side: one instruction of the processor works on all.

A table belongs to one thread.
"""

from __future__ import annotations

from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from ..compile.bits import bits_of, from_bits
from ..compile.fma import fma
from ..compile.jit import kernel
from .bins import bin_number, bin_offset, bin_place
from .four import VECTOR, side_by_side, spread_over
from .nodes import chebyshev, rounded, to_chebyshev

BITS, TERMS = 3, 11
_BINS = 1 << BITS
#: bins that a table keeps unless told, 64 octaves; rows behind them: for a bin that is not kept, and to compute in
KEPT, SPARE = 512, 2
#: a row: number of the bin (its bits), and from here on the coefficients, those of one power together
FIRST = 4
WIDTH = FIRST + 4 * TERMS

_FRACTIONS = 0.5 + 0.5 * rounded(chebyshev(TERMS))
_TO_CHEBYSHEV = to_chebyshev(TERMS)
#: from coefficients of Chebyshev's polynomials to those of powers of the offset
_TO_POWERS = np.zeros((TERMS, TERMS))
for _n in range(TERMS):
    _TO_POWERS[: _n + 1, _n] = np.polynomial.chebyshev.cheb2poly(np.eye(TERMS)[_n, : _n + 1])
_TO_POWERS /= (0.5 / _BINS) ** np.arange(TERMS)[:, None]


def empty_table(kept: int = KEPT) -> NDArray[np.float64]:
    """A table without bins, with room for ``kept``, a power of two."""
    table = np.empty((kept + SPARE, WIDTH))
    table[:, 0] = np.nan
    return table


@kernel
def clear(table):
    """Take all bins out of a table."""
    for row in range(table.shape[0]):
        table[row, 0] = np.nan


@kernel(inline=True)
def row_of(x, table):
    """(row, whether it holds the bin of x)."""
    number = bin_number(x, BITS)
    row = number & (table.shape[0] - (SPARE + 1))
    return row, bits_of(table[np.uint64(row), np.uint64(0)]) == number


@kernel(inline=True)
def same_bin(x, y):
    """Whether one polynomial serves both."""
    return bin_number(x, BITS) == bin_number(y, BITS)


@kernel(inline=True)
def offset(x):
    """Offset of x from the centre of its bin."""
    return bin_offset(x, BITS)


@kernel(inline=True)
def spare_row(table):
    """The row for a bin that is not kept."""
    return table.shape[0] - SPARE


@kernel
def node(x, n):
    """Argument of node ``n`` of the bin of x."""
    return bin_place(bin_number(x, BITS), BITS, _FRACTIONS[n])


@kernel(inline=True)
def begin(table, row):
    """Take the bin out of a row: it holds none until :func:`finish`, which may never come."""
    table[row, 0] = np.nan


@kernel(inline=True)
def put(table, row, n, a, b, c, d):
    """Values of the functions at node ``n``."""
    at = FIRST + 4 * n
    table[row, at], table[row, at + 1], table[row, at + 2], table[row, at + 3] = a, b, c, d


@kernel(inline=True)
def _combine(table, source, start, weights, target, n):
    """Sum of the quadruples of a row from ``start`` on, each times its weight, into number ``n`` of another."""
    s0 = s1 = s2 = s3 = 0.0
    for k in range(start, TERMS):
        weight, at = weights[k], FIRST + 4 * k
        s0 = fma(weight, table[source, at], s0)
        s1 = fma(weight, table[source, at + 1], s1)
        s2 = fma(weight, table[source, at + 2], s2)
        s3 = fma(weight, table[source, at + 3], s3)
    put(table, target, n, s0, s1, s2, s3)


@kernel
def finish(table, row, x):
    """Turn the values at the nodes into the polynomials of the bin of x.

    Only the differences from one of the values are fitted, and by way of the rapidly falling
    Chebyshev coefficients: both keep rounding out of the powers.
    """
    scratch = table.shape[0] - 1
    centre = FIRST + 4 * (TERMS // 2)
    c0, c1, c2, c3 = table[row, centre], table[row, centre + 1], table[row, centre + 2], table[row, centre + 3]
    for n in range(TERMS):
        at = FIRST + 4 * n
        put(
            table,
            row,
            n,
            table[row, at] - c0,
            table[row, at + 1] - c1,
            table[row, at + 2] - c2,
            table[row, at + 3] - c3,
        )
    for k in range(TERMS):
        _combine(table, row, 0, _TO_CHEBYSHEV[k], scratch, k)
    for m in range(TERMS):
        _combine(table, scratch, m, _TO_POWERS[m], row, m)
    at = FIRST
    put(table, row, 0, table[row, at] + c0, table[row, at + 1] + c1, table[row, at + 2] + c2, table[row, at + 3] + c3)
    table[row, 0] = from_bits(bin_number(x, BITS))


_INT = ir.IntType(64)


class _Row:
    """Builds the instructions that work on a row of a table, by vectors of four."""

    def __init__(self, context: Any, builder: Any, table_type: Any, table: Any, row: Any) -> None:
        self.builder = builder
        data = context.make_array(table_type)(context, builder, table).data
        first = builder.add(builder.mul(row, _INT(WIDTH)), _INT(FIRST))
        start = builder.bitcast(builder.gep(data, [first]), VECTOR.as_pointer())
        self.terms = [builder.load(builder.gep(start, [_INT(k)]), align=8) for k in range(TERMS)]
        kind = ir.FunctionType(VECTOR, [VECTOR] * 3)
        self._fma = cgutils.get_or_insert_function(builder.module, kind, "llvm.fma.v4f64")

    def fma(self, a: Any, b: Any, c: Any) -> Any:
        return self.builder.call(self._fma, [a, b, c])

    def one_function(self, f: int) -> list:
        """Coefficients of one of the functions, each four times."""
        same = ir.Constant(ir.VectorType(ir.IntType(32), 4), [f] * 4)
        return [self.builder.shuffle_vector(term, term, same) for term in self.terms]

    def sum(self, terms: list, power: Any) -> Any:
        """By Estrin's scheme: its parts do not wait for one another."""
        while len(terms) > 1:
            pairs = [terms[n : n + 2] for n in range(0, len(terms), 2)]
            terms = [self.fma(pair[1], power, pair[0]) if len(pair) > 1 else pair[0] for pair in pairs]
            power = self.builder.fmul(power, power)
        return terms[0]

    def derived(self, terms: list) -> list:
        return [self.builder.fmul(term, ir.Constant(VECTOR, [float(k)] * 4)) for k, term in enumerate(terms)][1:]


def _derivatives(orders: int) -> Callable:
    """(table, row, t) -> values, and slopes in t up to an order, of the four functions one after the other."""

    def instructions(row: _Row, t: Any) -> list:
        terms, power, found = row.terms, spread_over(row.builder, t), []
        for _ in range(orders):
            found.append(row.sum(terms, power))
            terms = row.derived(terms)
        return found

    def interpreted(terms: NDArray, t: float) -> list:
        found = []
        for _ in range(orders):
            found.append(sum(term * t**k for k, term in enumerate(terms)))
            terms = np.array([k * term for k, term in enumerate(terms)])[1:]
        return found

    return _intrinsic(instructions, interpreted, 1, 4 * orders)


def _secants() -> Callable:
    """(table, row, t, s) -> (p(t) - p(s))/(t - s) of the four functions, without cancellation."""

    def instructions(row: _Row, t: Any, s: Any) -> list:
        t, s, last = spread_over(row.builder, t), spread_over(row.builder, s), row.terms[-1]
        total = last
        for term in row.terms[-2:0:-1]:
            last = row.fma(t, last, term)
            total = row.fma(s, total, last)
        return [total]

    def interpreted(terms: NDArray, t: float, s: float) -> list:
        return [sum(term * sum(t**m * s ** (k - 1 - m) for m in range(k)) for k, term in enumerate(terms))]

    return _intrinsic(instructions, interpreted, 2, 4)


def _at_four(f: int) -> Callable:
    """(table, row, four offsets) -> one of the functions at four places of a bin."""

    def instructions(row: _Row, *offsets: Any) -> list:
        return [row.sum(row.one_function(f), side_by_side(row.builder, offsets))]

    def interpreted(terms: NDArray, *offsets: float) -> list:
        return [np.array([sum(term[f] * t**k for k, term in enumerate(terms)) for t in offsets])]

    return _intrinsic(instructions, interpreted, 4, 4)


def _intrinsic(instructions: Callable, interpreted: Callable, arguments: int, results: int) -> Callable:
    """What kernels call with (table, row, offsets); where numba is switched off, the same in Python."""

    def plain(table: NDArray, row: int, *offsets: float) -> tuple:
        return tuple(np.concatenate(interpreted(table[row, FIRST:].reshape(TERMS, 4), *offsets)))

    def lower(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        row = _Row(context, builder, signature.args[0], given[0], given[1])
        found = instructions(row, *given[2:])
        parts = [builder.extract_element(each, _INT(f)) for each in found for f in range(4)]
        return context.make_tuple(builder, signature.return_type, parts)

    returned = types.UniTuple(types.float64, results)

    def one(typing_context, table, row, t):
        return returned(table, types.int64, types.float64), lower

    def two(typing_context, table, row, t, s):
        return returned(table, types.int64, types.float64, types.float64), lower

    def four(typing_context, table, row, t, s, u, v):
        return returned(table, types.int64, *[types.float64] * 4), lower

    return plain if numba.config.DISABLE_JIT else intrinsic({1: one, 2: two, 4: four}[arguments])


values, slopes, second_slopes, secants = _derivatives(1), _derivatives(2), _derivatives(3), _secants()
third_at_four = _at_four(2)
