"""Polynomials of 24 powers by vectors of four: the powers of two functions, even and odd, or of one, modulo four.

A polynomial of ``evaluate_one`` function is its powers in their order, six vectors in t^4; of a ``evaluate_pair`` of
functions a and b it is a0 a1 b0 b1, a2 a3 b2 b3, ..., twelve vectors in t^2.  So a row costs no more than an eighth
of its octave with half as many powers would.  All take (table, where the row begins, t).
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types

from ..compile.intrinsics import fma, make_intrinsic
from ..compile.jit import kernel
from ..numerics.simd4 import FOUR, LANES, VECTOR, broadcast_value, fma_vectors, shuffle, unpack, vector_pointers

TERMS = 24
_ONE, _PAIR = TERMS // LANES, 2 * TERMS // LANES


def _row(context: Any, builder: Any, signature: Any, given: Any, count: int) -> list:
    places = vector_pointers(context, builder, signature.args[0], *given[:2], count)
    return [builder.load(place, align=8) for place in places]


def _constant(numbers: Any) -> Any:
    return ir.Constant(VECTOR, [float(x) for x in numbers])


def _sums(count: int, orders: int) -> Any:
    """(table, at, power) -> the sum of so many vectors times powers, its slope over the power, and that of this."""

    def lower(context, builder, signature, given):
        terms, found = _row(context, builder, signature, given, count), []
        for _ in range(orders):
            level, power = terms, broadcast_value(builder, given[2])
            while len(level) > 1:  # by Estrin's scheme: its parts do not wait for one another
                pairs = [level[n : n + 2] for n in range(0, len(level), 2)]
                level = [
                    fma_vectors(builder, evaluate_pair[1], power, evaluate_pair[0])
                    if len(evaluate_pair) > 1
                    else evaluate_pair[0]
                    for evaluate_pair in pairs
                ]
                power = builder.fmul(power, power)
            found.append(level[0])
            terms = [builder.fmul(_constant([k] * LANES), term) for k, term in enumerate(terms)][1:]
        return context.make_tuple(builder, signature.return_type, found)

    return make_intrinsic(lower, types.UniTuple(FOUR, orders), None, types.int64, types.float64)


def _secants(context, builder, signature, given):
    """Of one function and of its slope: sums at a power, and their differences from those at another over that."""
    terms, found = _row(context, builder, signature, given, _ONE), []
    power, other = (broadcast_value(builder, x) for x in given[2:])
    for _ in range(2):
        value = total = terms[-1]
        for term in terms[-2:0:-1]:
            value = fma_vectors(builder, power, value, term)
            total = fma_vectors(builder, other, total, value)
        found += [fma_vectors(builder, power, value, terms[0]), total]
        following = zip(terms, [*terms[1:], _constant([0.0] * LANES)])
        terms = [shuffle(builder, a, b, range(1, LANES + 1)) for a, b in following]
        powers = [range(LANES * k + 1, LANES * (k + 1) + 1) for k in range(_ONE)]
        terms = [builder.fmul(_constant(each), term) for each, term in zip(powers, terms, strict=True)]
    return context.make_tuple(builder, signature.return_type, found)


_pair_sums, _one_sums = _sums(_PAIR, 3), _sums(_ONE, 2)
_one_secants = make_intrinsic(_secants, types.UniTuple(FOUR, 4), None, types.int64, types.float64, types.float64)


@kernel(inline=True)
def evaluate_pair(table, at, t):
    """Values of two functions, their slopes, and the slopes of these: what is not taken is not computed."""
    twice, square = 2.0 * t, t * t
    value, rise, bend = _pair_sums(table, at, square)
    a_even, a_odd, b_even, b_odd = unpack(value)
    # f = E + t O of t^2
    a_even_1, a_odd_1, b_even_1, b_odd_1 = unpack(rise)
    a_even_2, a_odd_2, b_even_2, b_odd_2 = unpack(bend)
    a_1, b_1 = fma(t, a_odd_1, a_even_1), fma(t, b_odd_1, b_even_1)
    a_2 = 2.0 * fma(twice, a_odd_1 + fma(square, a_odd_2, t * a_even_2), a_1)
    b_2 = 2.0 * fma(twice, b_odd_1 + fma(square, b_odd_2, t * b_even_2), b_1)
    values = fma(t, a_odd, a_even), fma(t, b_odd, b_even)
    return *values, fma(twice, a_1, a_odd), fma(twice, b_1, b_odd), a_2, b_2


@kernel(inline=True)
def _joined(sums, t, square):
    """One number from the sums of its powers modulo four."""
    a, b, c, d = unpack(sums)
    return fma(square, fma(t, d, c), fma(t, b, a))


@kernel(inline=True)
def evaluate_one(table, at, t):
    """Value of one function, and its slope."""
    square = t * t
    value, rise = _one_sums(table, at, square * square)
    _, b, c, d = unpack(value)
    slope = fma(4.0 * t * square, _joined(rise, t, square), fma(t, fma(3.0 * t, d, 2.0 * c), b))
    return _joined(value, t, square), slope


@kernel(inline=True)
def _secant(sums, rises, t, s):
    square, other = t * t, s * s
    # t^n a - s^n b = s^n (a - b) + a (t^n - s^n)
    _, first, second, third = unpack(sums)
    first = fma(fma(t, s, square + other), third, fma(t + s, second, first))
    return _joined(sums, t, square), (t + s) * (square + other) * _joined(rises, s, other) + first


@kernel(inline=True)
def evaluate_secants(table, at, t, s):
    """p(t) and (p(t) - p(s))/(t - s) of one function, then of its slope."""
    square, other = t * t, s * s
    sums, rises, slope_sums, slope_rises = _one_secants(table, at, square * square, other * other)
    value, rise = _secant(sums, rises, t, s)
    return value, rise, *_secant(slope_sums, slope_rises, t, s)
