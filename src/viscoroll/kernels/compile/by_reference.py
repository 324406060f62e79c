"""Records by reference: calls pass the address of a record, one number, where numba passes every field of a tuple.

A field is loaded when it is read; a record in a record is passed by reference too.  The record exists as long as the
kernel that made the reference runs.  Its arrays belong to the caller of that kernel.
"""

from numba.core import cgutils, types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, lower_getattr_generic, models, register_model

from .intrinsics import make_intrinsic


class _ReferenceType(types.Type):
    """numba's type of a reference to a record; ``record``: numba's type of that."""

    def __init__(self, record):
        super().__init__(f"reference to {record}")
        self.record = record


@register_model(_ReferenceType)
class _ReferenceModel(models.PrimitiveModel):
    """A reference is represented by a pointer to the record."""

    def __init__(self, manager, kind):
        super().__init__(manager, kind, manager[kind.record].get_value_type().as_pointer())


@infer_getattr
class _Attributes(AttributeTemplate):
    """Types of the fields of a reference, for numba: a record in a record is a reference too, other fields have their
    own type, and a name that is no field has None, which numba reports as an error of type.
    """

    key = _ReferenceType

    def generic_resolve(self, reference, name):
        kind = dict(zip(reference.record.fields, reference.record.types, strict=True)).get(name)
        return _ReferenceType(kind) if isinstance(kind, types.NamedTuple) else kind


@lower_getattr_generic(_ReferenceType)
def _attribute(context, builder, kind, reference, name):
    """Return instructions that read a field of a reference to a record: its value, or, of a record in it, its address.

    context, builder : numba's context of code generation, and builder of LLVM.
    kind : numba's type of the reference.
    reference : the pointer to the record, a value of LLVM.
    name : name of a field of the record; numba has refused other names before, when it typed the kernel.
    Returns a value of LLVM: the loaded field, or the pointer to a field that is a record (a NamedTuple) itself.
    """
    index = kind.record.fields.index(name)
    at = cgutils.gep_inbounds(builder, reference, 0, index)
    return at if isinstance(kind.record[index], types.NamedTuple) else builder.load(at)


def _load(context, builder, kind, at):
    """Return instructions that load the value of a type from an address, field by field.

    context, builder : numba's context of code generation, and builder of LLVM.
    kind : numba's type of the value.  The fields of a record (NamedTuple), of records in it, and of the descriptor of
        an array are loaded one by one, so that LLVM removes the loads of fields that are not used; a value of another
        type is loaded at once.
    at : its address, a value of LLVM.
    Returns a value of LLVM, of the type that represents ``kind``.
    """
    if not isinstance(kind, (types.NamedTuple, types.Array)):
        return builder.load(at)
    whole = context.get_constant_undef(kind)
    for n in range(len(whole.type.elements)):
        field = cgutils.gep_inbounds(builder, at, 0, n)
        one = _load(context, builder, kind[n], field) if isinstance(kind, types.NamedTuple) else builder.load(field)
        whole = builder.insert_value(whole, one, n)
    return whole


def _lower_reference(context, builder, signature, arguments):
    """Return instructions that store a record on the stack of the kernel; the value of LLVM is its address."""
    return cgutils.alloca_once_value(builder, arguments[0])


def _lower_value(context, builder, signature, arguments):
    """Return instructions that load a record from its reference; a record that is a value already stays."""
    kind = signature.args[0]
    return _load(context, builder, kind.record, arguments[0]) if isinstance(kind, _ReferenceType) else arguments[0]


def _lower_pointer(context, builder, signature, arguments):
    """Return the pointer to the numbers of an array, a value of LLVM."""
    return context.make_array(signature.args[0])(context, builder, arguments[0]).data


def _value_signature(kind):
    """Return numba's signature of :func:`by_value` for a reference or a record, whose type is ``kind``."""
    return (kind.record if isinstance(kind, _ReferenceType) else kind)(kind)


#: record -> a reference to it.
by_reference = make_intrinsic(_lower_reference, lambda record: _ReferenceType(record)(record), None)
#: reference -> the record as a value, for loops that store: after each store LLVM would read a reference again.
by_value = make_intrinsic(_lower_value, _value_signature, None)
#: contiguous vector -> pointer to its numbers, valid while the vector exists; read and written by index.
data_pointer = make_intrinsic(_lower_pointer, lambda array: types.CPointer(array.dtype)(array), None)
