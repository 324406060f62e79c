"""Four numbers at once: one instruction of the processor adds, multiplies or divides them all.

Each of the four is rounded as it would be alone; of :func:`fused`, product and sum together.
"""

from __future__ import annotations

from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, models, register_model

#: how many
LANES = 4
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_INT = ir.IntType(32)


def spread_over(builder: Any, x: Any) -> Any:
    """Instructions that make a vector of one number, four times."""
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), x, _INT(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES))


def side_by_side(builder: Any, numbers: Any) -> Any:
    """Instructions that make a vector of four numbers."""
    whole = ir.Constant(VECTOR, ir.Undefined)
    for n, one in enumerate(numbers):
        whole = builder.insert_element(whole, one, _INT(n))
    return whole


class _FourType(types.Type):
    def __init__(self) -> None:
        super().__init__("four numbers")


_four = _FourType()


@register_model(_FourType)
class _FourModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


def _binary(instruction: str, interpreted: Callable) -> Any:
    """(a, b) -> a operation b of four numbers each."""

    def typed(typing_context, a, b):
        def lower(context, builder, signature, given):
            return getattr(builder, instruction)(*given)

        return _four(_four, _four), lower

    return interpreted if numba.config.DISABLE_JIT else intrinsic(typed)


add, subtract = _binary("fadd", np.add), _binary("fsub", np.subtract)
multiply, divide = _binary("fmul", np.multiply), _binary("fdiv", np.divide)


def _fused(typing_context, a, b, c):
    def lower(context, builder, signature, given):
        known = ir.FunctionType(VECTOR, [VECTOR] * 3)
        return builder.call(cgutils.get_or_insert_function(builder.module, known, "llvm.fma.v4f64"), given)

    return _four(_four, _four, _four), lower


def _slide(typing_context, a, b):
    def lower(context, builder, signature, given):
        order = [LANES - 1 + n for n in range(LANES)]
        return builder.shuffle_vector(given[0], given[1], ir.Constant(ir.VectorType(_INT, LANES), order))

    return _four(_four, _four), lower


def _spread(typing_context, x):
    def lower(context, builder, signature, given):
        return spread_over(builder, given[0])

    return _four(types.float64), lower


def _four_of(typing_context, a, b, c, d):
    def lower(context, builder, signature, given):
        return side_by_side(builder, given)

    return _four(*[types.float64] * LANES), lower


def _parts(typing_context, four):
    def lower(context, builder, signature, given):
        return context.make_tuple(builder, signature.return_type, split(builder, given[0]))

    return types.UniTuple(types.float64, LANES)(four), lower


def split(builder: Any, vector: Any) -> list:
    """Instructions that take a vector apart."""
    return [builder.extract_element(vector, _INT(n)) for n in range(LANES)]


def _pointer(context, builder, kind, array, at):
    """Where the four numbers of an array begin, the first of them number ``at``."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), VECTOR.as_pointer())


def _load(typing_context, array, at):
    def lower(context, builder, signature, given):
        return builder.load(_pointer(context, builder, signature.args[0], *given), align=8)

    return _four(array, types.int64), lower


def _store(typing_context, array, at, four):
    def lower(context, builder, signature, given):
        builder.store(given[2], _pointer(context, builder, signature.args[0], *given[:2]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.int64, _four), lower


def _put(array: Any, at: int, four: Any) -> None:
    array[at : at + LANES] = four


if numba.config.DISABLE_JIT:
    four = lambda *given: np.array(given)  # noqa: E731
    fused = lambda a, b, c: a * b + c  # noqa: E731
    slide = lambda a, b: np.concatenate([a[-1:], b[:-1]])  # noqa: E731
    spread = lambda x: np.full(LANES, x)  # noqa: E731
    load = lambda array, at: array[at : at + LANES].copy()  # noqa: E731
    store = _put
    parts = tuple
else:
    #: four numbers as one
    four = intrinsic(_four_of)
    #: and back
    parts = intrinsic(_parts)
    #: the last of one before the first three of another: a load across two stores would wait for both
    slide = intrinsic(_slide)
    #: a b + c
    fused = intrinsic(_fused)
    #: and back
    parts = intrinsic(_parts)
    #: a number, four times
    spread = intrinsic(_spread)
    #: (array, at) -> its numbers at, at + 1, ...; (array, at, four) puts them there.  Arrays are contiguous vectors
    load, store = intrinsic(_load), intrinsic(_store)
