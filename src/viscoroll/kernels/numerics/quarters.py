"""Four functions of one variable at a time by polynomials on quarters of octaves: one instruction works on all four."""

from __future__ import annotations

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from ..compile.jit import kernel

BITS = 2
BINS = 1 << BITS
COEFFICIENTS = 12
_SHIFT = 52 - BITS
_MANTISSA = (1 << 52) - 1
_BIN_MASK = ((1 << BITS) - 1) << _SHIFT
_ONE = 1023 << 52
_HALF_BIN = 1 << (_SHIFT - 1)
_OCTAVE = 2047 << 52

N = COEFFICIENTS
_ANGLES = np.pi * (np.arange(N) + 0.5) / N
_NODES = np.cos(_ANGLES)
_TO_CHEBYSHEV = np.cos(np.outer(np.arange(N), _ANGLES)) * (2.0 / N)
_TO_CHEBYSHEV[0] *= 0.5
_TO_POWERS = np.zeros((N, N))
for _n in range(N):
    _TO_POWERS[: _n + 1, _n] = np.polynomial.chebyshev.cheb2poly(np.eye(N)[_n, : _n + 1])
_TO_POWERS /= (0.5 / BINS) ** np.arange(N)[:, None]


@kernel(inline=True)
def bin_number(x):
    return np.float64(x).view(np.int64) >> _SHIFT


@kernel(inline=True)
def bin_offset(x):
    bits = np.float64(x).view(np.int64)
    centre = np.int64((bits & _BIN_MASK) | (_ONE + _HALF_BIN)).view(np.float64)
    return np.int64((bits & _MANTISSA) | _ONE).view(np.float64) - centre


@kernel(inline=True)
def scale(x):
    """Slope of the offset: 2^-octave."""
    return np.int64((2046 << 52) - (np.float64(x).view(np.int64) & _OCTAVE)).view(np.float64)


@kernel
def node(number, n):
    octave = np.int64((number >> BITS) << 52).view(np.float64)
    return octave * (1.0 + ((number & (BINS - 1)) + 0.5 + 0.5 * _NODES[n]) / BINS)


@kernel(allocates=True)
def fit(pieces, at):
    middle, series = np.empty(4), np.zeros((N, 4))
    for f in range(4):
        middle[f] = pieces[at, N // 2, f]
    for k in range(N):
        for n in range(N):
            weight = _TO_CHEBYSHEV[k, n]
            for f in range(4):
                series[k, f] += weight * (pieces[at, n, f] - middle[f])
    for m in range(N):
        for f in range(4):
            pieces[at, m, f] = 0.0
        for k in range(m, N):
            weight = _TO_POWERS[m, k]
            for f in range(4):
                pieces[at, m, f] += weight * series[k, f]
    for f in range(4):
        pieces[at, 0, f] += middle[f]


_FOUR = ir.VectorType(ir.DoubleType(), 4)
_INT = ir.IntType(32)


def _evaluator(orders):
    @intrinsic
    def evaluated(typing_context, pieces, at, t):
        def lower(context, builder, signature, given):
            array = context.make_array(signature.args[0])(context, builder, given[0])
            fma = cgutils.get_or_insert_function(builder.module, ir.FunctionType(_FOUR, [_FOUR] * 3), "llvm.fma.v4f64")
            first = builder.bitcast(array.data, _FOUR.as_pointer())
            first = builder.gep(first, [builder.mul(given[1], ir.Constant(given[1].type, N))])

            def coefficient(k):
                loaded = builder.load(builder.gep(first, [ir.Constant(_INT, k)]))
                loaded.align = 8
                return loaded

            def splat(x):
                one = builder.insert_element(ir.Constant(_FOUR, ir.Undefined), x, ir.Constant(_INT, 0))
                return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(_INT, 4), [0] * 4))

            def value(terms, power):
                while len(terms) > 1:
                    pairs = [terms[n : n + 2] for n in range(0, len(terms), 2)]
                    terms = [builder.call(fma, [p[1], power, p[0]]) if len(p) > 1 else p[0] for p in pairs]
                    power = builder.fmul(power, power)
                return terms[0]

            terms, found, t = [coefficient(k) for k in range(N)], [], splat(given[2])
            for _ in range(orders):
                found.append(value(terms, t))
                terms = [builder.fmul(term, ir.Constant(_FOUR, [float(k)] * 4)) for k, term in enumerate(terms)][1:]
            parts = [builder.extract_element(each, ir.Constant(_INT, f)) for each in found for f in range(4)]
            return context.make_tuple(builder, signature.return_type, parts)

        return types.UniTuple(types.float64, 4 * orders)(pieces, at, t), lower

    return evaluated


values, slopes, second_slopes = _evaluator(1), _evaluator(2), _evaluator(3)
