"""A bound scene for jitted code: a value that is called, with the function of :mod:`c_function` and the scene behind
it.

All scenes have one numba type, so that a user's function that is given a law is compiled once for all of them.
"""

from __future__ import annotations

import ctypes
import inspect
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NoReturn

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.imputils import lower_constant
from numba.core.typing import signature
from numba.extending import NativeValue, lower_builtin, models, register_model, unbox

from .c_function import RESULTS, law_address, pack_scenes
from .loads import LoadsAndSlopes
from .record import Law

#: room for what the function finds
ResultBuffer = ctypes.c_double * RESULTS
_C = ctypes.c_int, ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.c_void_p
_WORD, _DOUBLE = ir.IntType(64), ir.DoubleType()
_DOUBLES = _DOUBLE.as_pointer()
_FUNCTION = ir.FunctionType(ir.IntType(32), [_DOUBLE, _DOUBLE, _DOUBLES, _DOUBLES])
_CALL = inspect.signature(lambda V, omega: None)
#: laws that are constants of somebody's machine code, which nothing else keeps alive
_in_code: list[Any] = []


class LawType(types.Callable):
    """(V, omega) -> :class:`LoadsAndSlopes`, in jitted code."""

    def __init__(self) -> None:
        super().__init__("viscoroll.law")

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Its one signature, for two real numbers."""
        try:
            given = _CALL.bind(*args, **kws).args
        except TypeError:
            return None
        if not all(isinstance(types.unliteral(kind), types.Integer | types.Float) for kind in given):
            return None
        found = types.NamedUniTuple(types.float64, RESULTS, LoadsAndSlopes)
        return signature(found, types.float64, types.float64, recvr=self).replace(pysig=_CALL)

    def get_call_signatures(self) -> tuple[list[Any], bool]:
        """For numba's messages."""
        return [signature(types.float64, types.float64, types.float64)], False

    def get_impl_key(self, _: Any) -> type:
        """What it is lowered by."""
        return LawType


class Jitted:
    """The law of one scene, for jitted code: ``law.jitted(V, omega)``, NaN where the input is none of its business."""

    _numba_type_ = LawType()

    def __init__(self, law: Law, unlike: bool, kappa: float, mu: float, scale: Mapping[str, float]) -> None:
        self._law = law  # whose rows the scenes point to
        self._scenes = pack_scenes(law, unlike, kappa, mu, scale)
        self.plain, self.address = (int(self._scenes[n:].ctypes.data) for n in (0, 1))
        # with the GIL: to release it takes longer than the law
        self.function_address = law_address(law.cover_rows is not None)
        self.function = ctypes.PYFUNCTYPE(_C[0], *_C[1:3], ctypes.c_void_p, _C[4])(self.function_address)

    def __call__(self, V: float, omega: float) -> LoadsAndSlopes:
        out = ResultBuffer()
        self.function(V, omega, out, self.address)
        return LoadsAndSlopes(*out)

    def __reduce__(self) -> NoReturn:
        raise TypeError("law.jitted is machine code of this process: pickle the law, or its scene, and bind it there")

    @cached_property
    def ctypes(self) -> tuple[Any, ctypes.c_void_p]:
        """The C function and its user data."""
        called, scene = ctypes.CFUNCTYPE(*_C)(self.function_address), ctypes.c_void_p(self.address)
        called.law = scene.law = self  # type: ignore[attr-defined]
        return called, scene


@register_model(LawType)
class _Model(models.PrimitiveModel):
    """The address of the scene's numbers."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _WORD)


@unbox(LawType)
def _unbox(kind: Any, law: Any, c: Any) -> NativeValue:
    address = c.pyapi.object_getattr_string(law, "address")
    value = c.pyapi.long_as_ulonglong(address)
    c.pyapi.decref(address)
    return NativeValue(value, is_error=c.pyapi.c_api_error())


@lower_constant(LawType)
def _constant(context: Any, builder: Any, kind: Any, law: Any) -> Any:
    _in_code.append(law)
    # numba then keeps the code out of its cache: the next process has other addresses
    return builder.ptrtoint(context.add_dynamic_addr(builder, law.address, info="law"), _WORD)


@lower_builtin(LawType, LawType, types.float64, types.float64)
def _call(context: Any, builder: Any, kinds: Any, given: Any) -> Any:
    law, V, omega = given
    numbers = builder.inttoptr(law, _DOUBLES)
    law_address = builder.load(builder.bitcast(numbers, _FUNCTION.as_pointer().as_pointer()))
    out = cgutils.alloca_once(builder, _DOUBLE, size=_WORD(RESULTS))
    builder.call(law_address, [V, omega, out, numbers])
    found = [builder.load(builder.gep(out, [_WORD(n)])) for n in range(RESULTS)]
    return context.make_tuple(builder, kinds.return_type, found)
