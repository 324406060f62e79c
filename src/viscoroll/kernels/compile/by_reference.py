"""Records by reference: calls pass the address of a record, one number, where numba passes every field of a tuple.

A field is loaded when it is read; a record in a record is passed by reference too.  The record exists as long as the
kernel that made the reference runs.  Its arrays belong to the caller of that kernel.
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


class _ReferenceType(types.Type):
    def __init__(self, record: Any) -> None:
        super().__init__(f"reference to {record}")
        self.record = record


@register_model(_ReferenceType)
class _ReferenceModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, manager[kind.record].get_value_type().as_pointer())


def _read(kind: Any) -> Any:
    """Type of a field of this kind as it is read from a reference."""
    return _ReferenceType(kind) if isinstance(kind, types.NamedTuple) else kind


@infer_getattr
class _Attributes(AttributeTemplate):
    key = _ReferenceType

    def generic_resolve(self, reference: Any, name: str) -> Any:
        kind = dict(zip(reference.record.fields, reference.record.types, strict=True)).get(name)
        return kind if kind is None else _read(kind)


@lower_getattr_generic(_ReferenceType)
def _attribute(context: Any, builder: Any, kind: Any, reference: Any, name: str) -> Any:
    at = cgutils.gep_inbounds(builder, reference, 0, kind.record.fields.index(name))
    return at if isinstance(kind.record[kind.record.fields.index(name)], types.NamedTuple) else builder.load(at)


def _by_reference(typing_context, record):
    def lower(context, builder, signature, given):
        return cgutils.alloca_once_value(builder, given[0])

    return _ReferenceType(record)(record), lower


def _load(context: Any, builder: Any, kind: Any, at: Any) -> Any:
    """The value of type ``kind`` at the address ``at``, field by field; LLVM removes the fields that are not used."""
    if not isinstance(kind, (types.NamedTuple, types.Array)):
        return builder.load(at)
    whole = context.get_constant_undef(kind)
    for n in range(len(whole.type.elements)):
        field = cgutils.gep_inbounds(builder, at, 0, n)
        one = _load(context, builder, kind[n], field) if isinstance(kind, types.NamedTuple) else builder.load(field)
        whole = builder.insert_value(whole, one, n)
    return whole


def _by_value(typing_context, record):
    def lower(context, builder, signature, given):
        return _load(context, builder, record.record, given[0]) if isinstance(record, _ReferenceType) else given[0]

    return (record.record if isinstance(record, _ReferenceType) else record)(record), lower


def _data_pointer(typing_context, array):
    def lower(context, builder, signature, given):
        return context.make_array(array)(context, builder, given[0]).data

    return types.CPointer(array.dtype)(array), lower


#: a record -> a reference to it
by_reference = intrinsic(_by_reference)
#: a reference -> the record as a value, for loops that store: after each store LLVM would read a reference again
by_value = intrinsic(_by_value)
#: a contiguous vector -> pointer to its numbers, valid while the vector exists; read and written by index
data_pointer = intrinsic(_data_pointer)
