"""Four numbers at once: one instruction of the processor adds, multiplies or divides them all, by ``+ - * /``.

Each of the four is rounded as it would be alone; of :func:`fma4`, product and sum together.
"""

from __future__ import annotations

import operator
from typing import Any, Callable

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import lower_builtin, models, register_model, type_callable

from ..compile.intrinsics import call_llvm, make_intrinsic

#: how many
LANES = 4
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_INT = ir.IntType(32)


class _FourType(types.Type):
    def __init__(self) -> None:
        super().__init__("four numbers")


FOUR = _FourType()


@register_model(_FourType)
class _FourModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


def shuffle(builder: Any, a: Any, b: Any, order: Any) -> Any:
    """Instructions that take four of the eight numbers of two vectors."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(_INT, LANES), list(order)))


def broadcast_value(builder: Any, x: Any) -> Any:
    """Instructions that make a vector of one number, four times."""
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), x, _INT(0))
    return shuffle(builder, one, one, [0] * LANES)


def fma_vectors(builder: Any, *given: Any) -> Any:
    """The instruction of :func:`fma4`."""
    return call_llvm(builder, "llvm.fma.v4f64", given)


def vector_pointers(context: Any, builder: Any, kind: Any, array: Any, at: Any, count: int) -> list:
    """Where vectors of an array or behind a pointer stand, the first of their numbers being number ``at``."""
    data = array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data
    first = builder.bitcast(builder.gep(data, [at]), VECTOR.as_pointer())
    return [builder.gep(first, [_INT(n)]) for n in range(count)]


def _operator(function: Callable, name: str) -> None:
    """Have an operator of Python work on fours, and on a number and a four."""

    def typed(context: Any) -> Callable:
        return lambda a, b: FOUR if FOUR in (a, b) and {a, b} <= {FOUR, types.float64} else None

    def lower(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        each = zip(given, signature.args, strict=True)
        return getattr(builder, name)(*(x if kind is FOUR else broadcast_value(builder, x) for x, kind in each))

    type_callable(function)(typed)
    for kinds in ((FOUR, FOUR), (FOUR, types.float64), (types.float64, FOUR)):
        lower_builtin(function, *kinds)(lower)


for _name, _instruction in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _operator(getattr(operator, _name), _instruction)
    _operator(getattr(operator, f"i{_name}"), _instruction)


def _every(builder: Any, kind: Any, x: Any, count: int) -> list:
    """The fours of a tuple, or one for each of another's."""
    return cgutils.unpack_tuple(builder, x) if isinstance(kind, types.UniTuple) else [x] * count


def _widest(*kinds):
    return next((kind for kind in kinds if isinstance(kind, types.UniTuple)), FOUR)(*kinds)


def _whole(context, builder, kind, found):
    return found[0] if kind is FOUR else context.make_tuple(builder, kind, found)


def _fused(context, builder, signature, given):
    kind = signature.return_type
    columns = (_every(builder, own, x, getattr(kind, "count", 1)) for own, x in zip(signature.args, given))
    return _whole(context, builder, kind, [fma_vectors(builder, *each) for each in zip(*columns, strict=True)])


def _slide(context, builder, signature, given):
    return shuffle(builder, *given, range(LANES - 1, 2 * LANES - 1))


def _spread(context, builder, signature, given):
    return broadcast_value(builder, *given)


def _four(context, builder, signature, given):
    whole = ir.Constant(VECTOR, ir.Undefined)
    for n, one in enumerate(given):
        whole = builder.insert_element(whole, one, _INT(n))
    return whole


def _parts(context, builder, signature, given):
    found = [builder.extract_element(given[0], _INT(n)) for n in range(LANES)]
    return context.make_tuple(builder, signature.return_type, found)


def _load(context, builder, signature, given):
    kind = signature.return_type
    places = vector_pointers(context, builder, signature.args[0], *given, getattr(kind, "count", 1))
    return _whole(context, builder, kind, [builder.load(place, align=8) for place in places])


def _store(context, builder, signature, given):
    numbers = _every(builder, signature.args[2], given[2], 1)
    for place, each in zip(vector_pointers(context, builder, signature.args[0], *given[:2], len(numbers)), numbers):
        builder.store(each, place, align=8)
    return context.get_dummy_value()


#: four numbers as one
pack = make_intrinsic(_four, FOUR, *[types.float64] * LANES)
#: the last of one before the first three of another: a load across two stores would wait for both
shift_in = make_intrinsic(_slide, FOUR, FOUR, FOUR)
#: a b + c of fours, or of tuples of them and what all of these have in common
fma4 = make_intrinsic(_fused, _widest, None, None, None)
#: and back
unpack = make_intrinsic(_parts, types.UniTuple(types.float64, LANES), FOUR)
#: a number, four times
broadcast = make_intrinsic(_spread, FOUR, types.float64)
#: (array, at) -> its numbers at, at + 1, ...; (array, at, four) puts them there.  Arrays are contiguous vectors
load, store = (
    make_intrinsic(_load, FOUR, None, types.int64),
    make_intrinsic(_store, types.void, None, types.int64, None),
)


def make_load(count: int) -> Any:
    """A :func:`load` of so many fours, as a tuple."""
    return make_intrinsic(_load, types.UniTuple(FOUR, count), None, types.int64)
