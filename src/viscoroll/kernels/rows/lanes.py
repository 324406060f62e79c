"""Polynomials of 24 powers by vectors of four: the powers of two functions, even and odd, or of one, modulo four.

A polynomial of ``one`` function is its powers in their order, six vectors in t^4; of a ``pair`` of functions a and b it
is a0 a1 b0 b1, a2 a3 b2 b3, ..., twelve vectors in t^2.  So a row costs no more than an eighth of its octave with half
as many powers would.
"""

from __future__ import annotations

from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from ..numerics.four import LANES, VECTOR, split, spread_over

TERMS = 24
_INT, _PLACE = ir.IntType(64), ir.IntType(32)
#: of one function and of a pair: which of two neighbouring vectors' eight numbers, and by what they rise, make the next
#: power's slope
_ONE, _PAIR = ([1, 2, 3, 4], [1, 2, 3, 4], 4), ([1, 4, 3, 6], [1, 2, 1, 2], 2)


class _Row:
    """Builds the instructions that work on the vectors of a row."""

    def __init__(self, context: Any, builder: Any, kind: Any, table: Any, at: Any, layout: tuple, count: int) -> None:
        self.builder, self.layout = builder, layout
        data = context.make_array(kind)(context, builder, table).data
        start = builder.bitcast(builder.gep(data, [at]), VECTOR.as_pointer())
        self.terms = [builder.load(builder.gep(start, [_INT(k)]), align=8) for k in range(count)]
        known = ir.FunctionType(VECTOR, [VECTOR] * 3)
        self._fma = cgutils.get_or_insert_function(builder.module, known, "llvm.fma.v4f64")

    def fma(self, a: Any, b: Any, c: Any) -> Any:
        return self.builder.call(self._fma, [a, b, c])

    def derived(self, terms: list) -> list:
        """The vectors of the slope over t."""
        order, rise, step = self.layout
        mask, found = ir.Constant(ir.VectorType(_PLACE, LANES), order), []
        for k, (low, high) in enumerate(zip(terms, [*terms[1:], ir.Constant(VECTOR, [0.0] * LANES)])):
            powers = ir.Constant(VECTOR, [float(step * k + n) for n in rise])
            found.append(self.builder.fmul(self.builder.shuffle_vector(low, high, mask), powers))
        return found

    def orders(self, count: int) -> list:
        """The vectors, those of the slope, and of its slope: so many of these."""
        found = [self.terms]
        while len(found) < count:
            found.append(self.derived(found[-1]))
        return found

    def sums(self, terms: list, power: Any) -> list:
        """By Estrin's scheme: its parts do not wait for one another.  Four numbers."""
        power = spread_over(self.builder, power)
        while len(terms) > 1:
            pairs = [terms[n : n + 2] for n in range(0, len(terms), 2)]
            terms = [self.fma(pair[1], power, pair[0]) if len(pair) > 1 else pair[0] for pair in pairs]
            power = self.builder.fmul(power, power)
        return split(self.builder, terms[0])

    def secants(self, terms: list, power: Any, other: Any) -> tuple[list, list]:
        """Values at ``power``, and their differences from those at ``other`` over that of the two."""
        power, other = spread_over(self.builder, power), spread_over(self.builder, other)
        value = total = terms[-1]
        for term in terms[-2:0:-1]:
            value = self.fma(power, value, term)
            total = self.fma(other, total, value)
        return split(self.builder, self.fma(power, value, terms[0])), split(self.builder, total)


def _pair(orders: int) -> Callable:
    """(table, at, t) -> values of two functions; their slopes where ``orders`` is 2, and slopes of these where 3."""

    def instructions(row: _Row, t: Any) -> list:
        square, found = row.builder.fmul(t, t), []
        for terms in row.orders(orders):
            a_even, a_odd, b_even, b_odd = row.sums(terms, square)
            found += [row.builder.fma(t, a_odd, a_even), row.builder.fma(t, b_odd, b_even)]
        return found

    return _intrinsic(instructions, _PAIR, orders, 2)


def _one(orders: int) -> Callable:
    """(table, at, t) -> value of one function, and its slope where ``orders`` is 2."""

    def instructions(row: _Row, t: Any) -> list:
        square = row.builder.fmul(t, t)
        fourth = row.builder.fmul(square, square)
        return [_joined(row, row.sums(terms, fourth), t, square) for terms in row.orders(orders)]

    return _intrinsic(instructions, _ONE, orders)


def _secants() -> Callable:
    """(table, at, t, s) -> p(t) and (p(t) - p(s))/(t - s) of one function, then of its slope."""

    def instructions(row: _Row, t: Any, s: Any) -> list:
        fma, add, multiply = row.builder.fma, row.builder.fadd, row.builder.fmul
        both, square, other = add(t, s), multiply(t, t), multiply(s, s)
        squares, found = add(square, other), []
        for terms in row.orders(2):
            values, rises = row.secants(terms, multiply(square, square), multiply(other, other))
            # t^n a - s^n b = s^n (a - b) + a (t^n - s^n)
            rise = multiply(multiply(both, squares), _joined(row, rises, s, other))
            _, first, second, third = values
            first = fma(fma(t, s, squares), third, fma(both, second, first))
            found += [_joined(row, values, t, square), add(rise, first)]
        return found

    return _intrinsic(instructions, _ONE, 2, 2, secants=True)


def _joined(row: _Row, parts: list, t: Any, square: Any) -> Any:
    """One number from the sums of its powers modulo four."""
    fma = row.builder.fma
    return fma(square, fma(t, parts[3], parts[2]), fma(t, parts[1], parts[0]))


def _interpreted(function: Any, t: float, *other: float) -> list:
    """The value of a polynomial, and the mean slope from another place on."""
    rises = [c * sum(t**m * s ** (k - 1 - m) for m in range(k)) for s in other for k, c in enumerate(function)]
    return [np.polynomial.polynomial.polyval(t, function), *([sum(rises)] if other else [])]


def _intrinsic(instructions: Callable, layout: tuple, orders: int, each: int = 1, secants: bool = False) -> Callable:
    """What kernels call with (table, where the row begins, places); where numba is switched off, the same in Python.

    each : results of an order.
    """
    count, results = TERMS // layout[2], orders * each

    def plain(table: Any, at: int, *places: float) -> Any:
        numbers = table.ravel()[at : at + LANES * count]
        functions = [numbers] if layout is _ONE else numbers.reshape(-1, 2, 2).swapaxes(0, 1).reshape(2, -1)
        slopes = [np.polynomial.polynomial.polyder(f, order) for order in range(orders) for f in functions]
        found = [one for f in slopes for one in _interpreted(f, *places)]
        return found[0] if results == 1 else tuple(found)

    def lower(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        row = _Row(context, builder, signature.args[0], given[0], given[1], layout, count)
        found = instructions(row, *given[2:])
        return found[0] if results == 1 else context.make_tuple(builder, signature.return_type, found)

    returned = types.float64 if results == 1 else types.UniTuple(types.float64, results)

    def at_one(typing_context, table, at, t):
        return returned(table, types.int64, types.float64), lower

    def at_two(typing_context, table, at, t, s):
        return returned(table, types.int64, types.float64, types.float64), lower

    return plain if numba.config.DISABLE_JIT else intrinsic(at_two if secants else at_one)


pair, pair_slopes, pair_seconds = _pair(1), _pair(2), _pair(3)
one, one_slopes, secants = _one(1), _one(2), _secants()
