"""A record that stays where it is: calls hand on its place, one number, where numba hands on every number of a tuple.

What is read of it is loaded there; a record in it is a place too.  It lives as long as the kernel that holds it runs,
and its arrays are its caller's: such a kernel makes none.
"""

from __future__ import annotations

from typing import Any

from numba.core import cgutils, types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    models,
    register_model,
)


class _HeldType(types.Type):
    def __init__(self, record: Any) -> None:
        super().__init__(f"held {record}")
        self.record = record


@register_model(_HeldType)
class _HeldModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, manager[kind.record].get_value_type().as_pointer())


def _read(kind: Any) -> Any:
    """What is read where a record holds this."""
    return _HeldType(kind) if isinstance(kind, types.NamedTuple) else kind


@infer_getattr
class _Attributes(AttributeTemplate):
    key = _HeldType

    def generic_resolve(self, held: Any, name: str) -> Any:
        kind = dict(zip(held.record.fields, held.record.types, strict=True)).get(name)
        return kind if kind is None else _read(kind)


@lower_getattr_generic(_HeldType)
def _attribute(context: Any, builder: Any, kind: Any, held: Any, name: str) -> Any:
    at = cgutils.gep_inbounds(builder, held, 0, kind.record.fields.index(name))
    return at if isinstance(kind.record[kind.record.fields.index(name)], types.NamedTuple) else builder.load(at)


def _held(typing_context, record):
    def lower(context, builder, signature, given):
        return cgutils.alloca_once_value(builder, given[0])

    return _HeldType(record)(record), lower


def _load(context: Any, builder: Any, kind: Any, at: Any) -> Any:
    """All that is there, number by number: what is not asked for is left out."""
    if not isinstance(kind, (types.NamedTuple, types.Array)):
        return builder.load(at)
    whole = context.get_constant_undef(kind)
    for n in range(len(whole.type.elements)):
        place = cgutils.gep_inbounds(builder, at, 0, n)
        one = _load(context, builder, kind[n], place) if isinstance(kind, types.NamedTuple) else builder.load(place)
        whole = builder.insert_value(whole, one, n)
    return whole


def _loaded(typing_context, record):
    def lower(context, builder, signature, given):
        return _load(context, builder, record.record, given[0]) if isinstance(record, _HeldType) else given[0]

    return (record.record if isinstance(record, _HeldType) else record)(record), lower


def _pointer(typing_context, array):
    def lower(context, builder, signature, given):
        return context.make_array(array)(context, builder, given[0]).data

    return types.CPointer(array.dtype)(array), lower


#: a record -> the same, held
held = intrinsic(_held)
#: and back, for a loop that stores: behind each store all that is held is read anew
loaded = intrinsic(_loaded)
#: a contiguous vector -> where its numbers begin; read and written by indices from 0 on, while its maker keeps it
pointer = intrinsic(_pointer)
