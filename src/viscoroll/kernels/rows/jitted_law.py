"""The law of one scene for jitted code: a value that is called, the address of the user data of a C function.

All such laws have one numba type, so that a user's function that is given a law is compiled once for all of them.
The functions with a decorator of numba's are called by numba when it compiles such a function.
"""

import ctypes
import inspect
from functools import cached_property
from typing import Any, NoReturn

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.imputils import lower_constant
from numba.core.typing import signature
from numba.extending import NativeValue, lower_builtin, models, register_model, unbox
from numpy.typing import NDArray

from .c_function import RESULTS
from .loads import LoadsAndSlopes

#: Array of the results of the C function.
ResultBuffer = ctypes.c_double * RESULTS
#: Types of the C function for ctypes: its status, then its arguments.
_C_TYPES = ctypes.c_int, ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.c_void_p
#: LLVM's 64-bit integer, which holds an address.
_WORD = ir.IntType(64)
#: LLVM's double.
_DOUBLE = ir.DoubleType()
#: LLVM's pointer to doubles.
_POINTER = _DOUBLE.as_pointer()
#: LLVM's type of the C function.
_FUNCTION = ir.FunctionType(ir.IntType(32), [_DOUBLE, _DOUBLE, _POINTER, _POINTER])
#: Signature of a law in jitted code.
_SIGNATURE = inspect.signature(lambda V, omega: None)
#: Laws that are constants of somebody's machine code, which nothing else keeps alive.
_constants: list[Any] = []


class LawType(types.Callable):
    """numba's type of a law, a function (V, omega) -> :class:`LoadsAndSlopes` of two floats; all laws have this one
    type.
    """

    def __init__(self):
        super().__init__("viscoroll.law")

    def get_call_type(self, context, args, kws):
        """Return numba's signature of a call law(V, omega) -> :class:`LoadsAndSlopes` with two real numbers.

        context : numba's typing context, not used.
        args, kws : tuple and dict of numba's types of the positional and of the named arguments; a type of integers,
            floats or literal integers is allowed, and converted to double.
        Returns the signature, (double, double) -> named tuple of eight doubles; None for arguments of another number,
        name or type, which numba reports as an error of type.
        """
        try:
            kinds = _SIGNATURE.bind(*args, **kws).args
        except TypeError:
            return None
        if not all(isinstance(types.unliteral(kind), types.Integer | types.Float) for kind in kinds):
            return None
        returned = types.NamedUniTuple(types.float64, RESULTS, LoadsAndSlopes)
        return signature(returned, types.float64, types.float64, recvr=self).replace(pysig=_SIGNATURE)

    def get_call_signatures(self):
        """Return the list of signatures that numba names in messages of errors, one, (double, double) -> double, and
        False, as there are no type parameters.
        """
        return [signature(types.float64, types.float64, types.float64)], False

    def get_impl_key(self, _):
        """Return the key under which numba finds :func:`_lower_call`, the class itself: one for all laws."""
        return LawType


class Jitted:
    """A law for jitted code: ``law.jitted(V, omega)`` -> :class:`LoadsAndSlopes`, all NaN where the law is not defined.

    The units of V, omega and the results are those of the scene's user data.  Python may call it too.  It cannot be
    pickled: that raises TypeError.

    Parameters
    ----------
    scenes : two records of user data (:func:`.c_function.pack_scenes`), without slopes and with, whose first field is
        the address of the C function.
    owner : any object that owns the memory to which addresses in ``scenes`` point; it is kept.

    Attributes
    ----------
    plain, address : int, addresses of the user data without slopes and with.
    function : the C function for calls from Python, with the GIL: to release it takes longer than the law.
    function_address : int, its address.
    """

    _numba_type_ = LawType()

    def __init__(self, scenes: NDArray[Any], owner):
        self._scenes = scenes
        self._owner = owner
        self.plain, self.address = (int(scenes[n:].ctypes.data) for n in (0, 1))
        self.function_address = int(scenes["function"][0])
        self.function = ctypes.PYFUNCTYPE(*_C_TYPES[:3], ctypes.c_void_p, ctypes.c_void_p)(self.function_address)

    def __call__(self, V: float, omega: float) -> LoadsAndSlopes:
        out = ResultBuffer()
        self.function(V, omega, out, self.address)
        return LoadsAndSlopes(*out)

    def __reduce__(self) -> NoReturn:
        raise TypeError("law.jitted is machine code of this process: pickle the law, or its scene, and bind it there")

    @cached_property
    def ctypes(self) -> tuple[Any, ctypes.c_void_p]:
        """The C function and its user data, for ctypes; each keeps this law alive.

        Returns a tuple: a function of ctypes (V, omega, pointer to eight doubles that it writes, address of the user
        data) -> status, which releases the GIL; a ``c_void_p`` of the user data with slopes.  The status is 0, or
        another int where the law is not defined and all eight doubles are NaN.
        """
        function = ctypes.CFUNCTYPE(*_C_TYPES)(self.function_address)
        scene = ctypes.c_void_p(self.address)
        function.law = scene.law = self  # type: ignore[attr-defined]
        return function, scene


@register_model(LawType)
class _LawModel(models.PrimitiveModel):
    """A law is represented by the address of its user data."""

    def __init__(self, manager, kind):
        super().__init__(manager, kind, _WORD)


@unbox(LawType)
def _unbox(kind, law, c):
    """Return instructions that read the address of the user data of a law that Python passes to jitted code.

    kind, c : numba's type of the law, not used, and its context of unboxing.
    law : the Python object, a :class:`Jitted`, as a value of LLVM.
    Returns numba's ``NativeValue``: the address, a 64-bit integer of LLVM, and a bit that is set if Python raised an
    error on the way.
    """
    address = c.pyapi.object_getattr_string(law, "address")
    value = c.pyapi.long_as_ulonglong(address)
    c.pyapi.decref(address)
    return NativeValue(value, is_error=c.pyapi.c_api_error())


@lower_constant(LawType)
def _lower_constant(context, builder, kind, law):
    """Return instructions for the address of a law that is a constant of the code, such as a global variable of a
    function.

    context, builder, kind : numba's context of code generation, builder of LLVM and type of the law.
    law : the :class:`Jitted`, which is appended to a list of this module and so kept alive until the process ends.
    Returns a value of LLVM: the address of the user data as a 64-bit integer.

    numba does not put code with such an address into its cache: the next process has other addresses.
    """
    _constants.append(law)
    return builder.ptrtoint(context.add_dynamic_addr(builder, law.address, info="law"), _WORD)


@lower_builtin(LawType, LawType, types.float64, types.float64)
def _lower_call(context, builder, signature, arguments):
    """Return instructions that call the C function of a law; numba calls this function to compile law(V, omega).

    The address of the C function is the first word of the law's user data, ``function`` of a SCENE.

    context, builder, signature : numba's context of code generation, builder of LLVM, signature of the call.
    arguments : values of LLVM: the law, which is the address of its user data, and the doubles V and omega, in the
        units of the user data.
    Returns a value of LLVM: the eight results as a :class:`LoadsAndSlopes`, in the units of the user data.  The status
    of the C function is not read: a state at which the law is not defined has NaN in all eight.
    """
    law, V, omega = arguments
    scene = builder.inttoptr(law, _POINTER)
    function = builder.load(builder.bitcast(scene, _FUNCTION.as_pointer().as_pointer()))
    out = cgutils.alloca_once(builder, _DOUBLE, size=_WORD(RESULTS))
    builder.call(function, [V, omega, out, scene])
    numbers = [builder.load(builder.gep(out, [_WORD(n)])) for n in range(RESULTS)]
    return context.make_tuple(builder, signature.return_type, numbers)
