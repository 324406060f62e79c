"""Four numbers at once: one instruction of the processor adds, multiplies or divides them all, by ``+ - * /``.

Each of the four is rounded as it would be alone; of :func:`fused`, product and sum together.
"""

from __future__ import annotations

import operator
from typing import Any, Callable

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

#: how many
LANES = 4
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_INT = ir.IntType(32)


def spread_over(builder: Any, x: Any) -> Any:
    """Instructions that make a vector of one number, four times."""
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), x, _INT(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES))


def split(builder: Any, vector: Any) -> list:
    """Instructions that take a vector apart."""
    return [builder.extract_element(vector, _INT(n)) for n in range(LANES)]


class _FourType(types.Type):
    def __init__(self) -> None:
        super().__init__("four numbers")


_four = _FourType()


@register_model(_FourType)
class _FourModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


def _operator(function: Callable, instruction: str) -> None:
    """Have an operator of Python work on fours, and on a number and a four."""

    def typed(context: Any) -> Callable:
        return lambda a, b: _four if _four in (a, b) and {a, b} <= {_four, types.float64} else None

    def lower(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        each = zip(given, signature.args, strict=True)
        return getattr(builder, instruction)(*(x if kind is _four else spread_over(builder, x) for x, kind in each))

    type_callable(function)(typed)
    for kinds in ((_four, _four), (_four, types.float64), (types.float64, _four)):
        lower_builtin(function, *kinds)(lower)


for _name, _instruction in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _operator(getattr(operator, _name), _instruction)
    _operator(getattr(operator, f"i{_name}"), _instruction)


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
        whole = ir.Constant(VECTOR, ir.Undefined)
        for n, one in enumerate(given):
            whole = builder.insert_element(whole, one, _INT(n))
        return whole

    return _four(*[types.float64] * LANES), lower


def _parts(typing_context, four):
    def lower(context, builder, signature, given):
        return context.make_tuple(builder, signature.return_type, split(builder, given[0]))

    return types.UniTuple(types.float64, LANES)(four), lower


def _pointer(context, builder, kind, array, at):
    """Where the four numbers of an array or behind a pointer begin, the first of them number ``at``."""
    data = array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data
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
