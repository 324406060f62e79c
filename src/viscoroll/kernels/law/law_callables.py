"""The law of one scene as a function of C and of jitted code.

The function of C, ``int law(double V, double omega, double out[10], void *scene)``, is compiled
once; ``scene`` is its user data, a :data:`SCENE`.  It writes into ``out`` Q, M and the parts of M
that half-space and cylinder take; then, if the scene requests slopes, dQ/dV at fixed omega,
dQ/domega at fixed V and the derivatives of the parts of M with respect to V and to omega.  It
returns 0, or another number with NaN in ``out``.  It writes nothing else: any number of threads may
call it.

In jitted code a law is a value that can be called: the address of the user data of its C function.
All such laws have one numba type, so that a user's function with a law as an argument is compiled
once for all of them.  The functions with a decorator of numba are called by numba when it compiles
such a function.
"""

import ctypes
import inspect
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NoReturn

import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import cgutils, types
from numba.core.imputils import lower_constant
from numba.core.typing import signature
from numba.extending import NativeValue, lower_builtin, models, register_model, unbox
from numpy.typing import NDArray

from ..numerics.intrinsics import floats_at, function_address, integers_at, record_at, record_type
from ..numerics.jit import inline_kernel, kernel
from ..records import LoadsAndSlopes
from .cover_law import COVER_FRONT_SIZE, COVER_ROW_SIZE, asymmetry_at, pairs_at
from .law_functions import body_moments, length_and_moment, locate_row, moment_factor
from .law_record import PARTS_PER_ROW, ROW_SIZE, Law, State
from .traction_functions import (
    Q_slopes,
    moment_slope,
    moment_slope_over_V,
    signed_creep,
    signed_traction,
    stick_argument,
    traction_on_moments,
)

# --- The law of one scene as a C function ---

#: Largest kappa |V|: above it zeta is 0 in doubles, or nearly 0, and the status is not 0.
MAX_U = 1e300
#: Numbers that the function writes.
RESULTS = 10
#: User data.  function: address of the C function.  slopes: whether slopes are requested.  unlike:
#: whether the bodies differ.  rows, marks: addresses of the arrays of the law.  row_count: number
#: of rows, with the head counted as one.  cover_rows: address of the numbers that only a cover has.
#: kappa, mu: those of the scene.  V, omega, Q, M: the dimensionless value 1 of each in the units of
#: the caller.
SCENE = record_type(
    "function slopes unlike rows marks row_count cover_rows", "kappa mu V omega Q M"
)


@inline_kernel
def refuse(out):
    """Fill ``out``, the RESULTS numbers of a C function, with NaN, and return 1, the int that is
    the status of a state at which the law is not defined.
    """
    for n in range(RESULTS):
        out[n] = np.nan
    return 1


@kernel(allocates=True)
def _half_space_law(V, omega, out, scenes):
    """Evaluate the law of half-spaces at one state: the C function, which calls :func:`_evaluate`
    without a cover.

    V, omega : floats, speed and angular velocity in the units of the caller, of any sign.
    out, scenes : pointers to RESULTS = 10 doubles, written in the units of the caller as by
        :func:`_evaluate` (without slopes numbers 4 and 5 keep their values and those after them
        have no meaning), and to a SCENE record.
    Returns the status, an int: 0; or 1, with all results NaN, if the dimensionless V or omega is
    not finite or kappa |V| exceeds MAX_U.
    """
    return _evaluate(V, omega, out, record_at(scenes), None)


@kernel(allocates=True)
def _cover_law(V, omega, out, scenes):
    """Evaluate the law of a cover, a layer of finite thickness on one body, at one state: the C
    function, which calls :func:`_evaluate` with the numbers that only a cover has.

    V, omega : floats, speed and angular velocity in the units of the caller, of any sign.
    out, scenes : pointers to RESULTS = 10 doubles, written in the units of the caller as by
        :func:`_evaluate` (without slopes numbers 4 and 5 keep their values and those after them
        have no meaning), and to a SCENE record, whose ``cover_rows`` is the address of
        COVER_FRONT_SIZE + COVER_ROW_SIZE (row_count - 1) doubles that exist during the call.
    Returns the status, an int: 0; or 1, with all results NaN, if the dimensionless V or omega is
    not finite or kappa |V| exceeds MAX_U.
    """
    scene = record_at(scenes)
    # row_count counts the head of the rows as a row; cover rows have a head of their own
    cover_rows = floats_at(
        scene.cover_rows, COVER_FRONT_SIZE + COVER_ROW_SIZE * (scene.row_count - 1)
    )
    return _evaluate(V, omega, out, scene, cover_rows)


@kernel(inline=True, allocates=True)
def _evaluate(caller_V, caller_omega, pointer, scene, cover_rows):
    """Evaluate the law at one state and write the results in the units of the caller.

    caller_V, caller_omega : floats, speed and angular velocity in the units of the caller, of any
        sign.
    pointer : address of RESULTS doubles, written: Q, M, M_half_space, M_cylinder; then, if
        ``scene.slopes``, dQ/dV at fixed omega, dQ/domega at fixed V, dM_half_space/dV,
        dM_cylinder/dV, dM_half_space/domega, dM_cylinder/domega.  Without slopes numbers 4 and 5
        stay as they were, and the others are overwritten by numbers without meaning.
    scene : a SCENE record, of which all fields but ``function`` and ``cover_rows`` are read: rows
        and marks of the law, kappa, mu > 0 and the units of the caller.
    cover_rows : vector of the numbers that only a cover has, as in :class:`Law`; None of
        half-spaces.

    Returns the status, an int: 0; or 1, and all results are NaN, if the dimensionless V or omega is
    not finite or kappa |V| exceeds MAX_U.

    If ``scene.unlike`` is 0, each body takes half of M and of its slope.  At V = 0 M is 0, except
    for the part that traction causes on a cover; full slip holds there for every omega other than
    0, and the slopes of Q are 0.  At V = omega = 0 dQ/domega and dQ/dV are infinite, but 0 in full
    slip (a cover).
    """
    out = carray(pointer, RESULTS)
    rows = floats_at(scene.rows, scene.row_count * ROW_SIZE)
    law = Law(
        rows=rows,
        marks=integers_at(scene.marks, scene.row_count * PARTS_PER_ROW),
        N_rows=rows[:0],
        selector=0,
        maker=0,
        source=0,
        cover_rows=cover_rows,
    )
    V = caller_V / scene.V
    omega = caller_omega / scene.omega
    u = scene.kappa * abs(V)
    if not (u <= MAX_U and abs(omega) < np.inf):  # False for NaN too
        return refuse(out)
    state = State(kappa=scene.kappa, mu=scene.mu, V=V, creep=omega, creep_is_omega=True)
    position = locate_row(u, law)
    functions = length_and_moment(position, u, law)
    factor = moment_factor(position, u, functions.scale, state)
    pairs = pairs_at(position, u, cover_rows)  # for half-spaces these and delta_0, c are 0
    free_creep = pairs.total.first.value
    c = asymmetry_at(pairs, state.mu, functions.L, 0.0, 0.0, cover_rows).value
    D = signed_creep(functions.L, free_creep, c, state, cover_rows)
    v = stick_argument(u, functions.L, abs(D))
    out[0] = signed_traction(locate_row(v, law), v, u, functions.L, D, state.mu, law)
    # Changes of the moments by the traction.  For half-spaces they are -0.0, which changes no bit
    # of a sum.
    change = traction_on_moments(pairs, functions, out[0], state, cover_rows)
    out[1] = factor * functions.m + (change.half_space + change.cylinder)
    # like bodies: each takes half of M and of its slope; M of half-spaces does not depend on omega
    out[2] = out[3] = 0.5 * out[1]
    out[6] = out[7] = 0.5 * functions.d_um
    out[8] = out[9] = 0.0
    if scene.unlike:
        half_space, cylinder, out[6], out[7] = body_moments(position, u, law)
        out[2] = factor * half_space + change.half_space
        out[3] = factor * cylinder + change.cylinder
    # Slopes in the units of the caller: a dimensionless slope is multiplied by the unit of the load
    # and divided by that of V or omega.  ``out[0]`` is still dimensionless.
    if scene.slopes:
        out[4], _, out[5] = Q_slopes(u, functions, pairs, D, state, law)
        if cover_rows is not None:
            out[6] += moment_slope_over_V(change.half_space_du, change.half_space_dQ, out[4], state)
            out[7] += moment_slope_over_V(change.cylinder_du, change.cylinder_dQ, out[4], state)
            out[8] = moment_slope(change.half_space_dQ, out[5]) * scene.M / scene.omega
            out[9] = moment_slope(change.cylinder_dQ, out[5]) * scene.M / scene.omega
        out[4] = out[4] * scene.Q / scene.V
        out[5] = out[5] * scene.Q / scene.omega
        for n in range(6, 8):
            out[n] = out[n] * scene.M / scene.V
    # Loads in the units of the caller; the slopes are already in these units.
    out[0] *= scene.Q
    for n in range(1, 4):
        out[n] *= scene.M
    return 0


def pack_scenes(
    law: Law, unlike: bool, kappa: float, mu: float, scale: Mapping[str, float]
) -> NDArray[Any]:
    """Return the user data for the C function of a law: two SCENE records, without slopes and with
    slopes.

    A record also holds the address of the C function, of half-spaces or of a cover, which is
    compiled here if it is not yet.

    law : :class:`Law` of one material, with all rows complete; rows, marks and cover_rows are read.
        Its arrays must outlive the records, which hold their addresses.
    unlike : bool, whether the two bodies differ, so that they take unequal parts of M.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    scale : "V", "omega", "Q" and "M" -> the unit of this dimensionless quantity in the units of the
        caller, a float: a dimensionless number times it is the caller's.
    Returns an array of shape (2,) and dtype SCENE.  Raises KeyError if ``scale`` lacks a name.
    """
    cover_rows = law.cover_rows
    function, address = (
        (_half_space_law, 0) if cover_rows is None else (_cover_law, cover_rows.ctypes.data)
    )
    # row_count, the third of the arrays, includes the head
    arrays = law.rows.ctypes.data, law.marks.ctypes.data, law.rows.size // ROW_SIZE, address
    return pack_records(function, SCENE, (unlike, *arrays), kappa, mu, scale)


def pack_records(
    function, record: np.dtype, arrays: tuple, kappa: float, mu: float, scale: Mapping[str, float]
) -> NDArray[Any]:
    """Return the user data for a C function: two records, without slopes and with slopes.

    function : the kernel (V, omega, pointer to results, pointer to a record) -> status, numba's
        dispatcher, which is compiled here if it is not yet.
    record : numpy dtype of the record: address of the C function, valid in this process; whether
        slopes are requested; the fields of ``arrays``; kappa, mu; and V, omega, Q and M of
        ``scale``.
    arrays : addresses and sizes of arrays, ints.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    scale : as of :func:`pack_scenes`.
    Returns an array of shape (2,) and dtype ``record``.  Raises KeyError if ``scale`` lacks a name,
    numba's error if the kernel cannot be compiled for these types.
    """
    results = types.CPointer(types.float64)
    address = function_address(function, record, types.int32, types.float64, types.float64, results)
    numbers = *arrays, kappa, mu, *(scale[name] for name in ("V", "omega", "Q", "M"))
    return np.array([(address, slopes, *numbers) for slopes in (0, 1)], record)


# --- The law of one scene for jitted code ---

#: Array of the results of the C function.
ResultBuffer = ctypes.c_double * RESULTS
#: Types of the C function for ctypes: its status, then its arguments.
_C_TYPES = (
    ctypes.c_int,
    ctypes.c_double,
    ctypes.c_double,
    ctypes.POINTER(ctypes.c_double),
    ctypes.c_void_p,
)
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
#: Laws that are constants of compiled functions: this list keeps them alive.
_constants: list[Any] = []


class LawType(types.Callable):
    """numba's type of a law, a function (V, omega) -> :class:`LoadsAndSlopes` of two floats; all
    laws have this one type.
    """

    def __init__(self):
        super().__init__("viscoroll.law")

    def get_call_type(self, context, args, kws):
        """Return the signature that numba is to use for a call law(V, omega) with arguments of the
        given types.

        context : numba's typing context, not used.
        args, kws : tuple and dict of numba's types of the positional and of the named arguments;
            types of integers and floats are allowed, and literal integers: they are converted to
            double.
        Returns the signature (double, double) -> :class:`LoadsAndSlopes` of RESULTS doubles; None
        if the number, the names or the types of the arguments are wrong: numba then raises
        numba.core.errors.TypingError.
        """
        try:
            kinds = _SIGNATURE.bind(*args, **kws).args
        except TypeError:
            return None
        if not all(
            isinstance(types.unliteral(kind), types.Integer | types.Float) for kind in kinds
        ):
            return None
        returned = types.NamedUniTuple(types.float64, RESULTS, LoadsAndSlopes)
        # recvr: the law itself, which numba passes to _lower_call as the first argument; pysig: the
        # names of the arguments, by which numba assigns named ones
        return signature(returned, types.float64, types.float64, recvr=self).replace(
            pysig=_SIGNATURE
        )

    def get_call_signatures(self):
        """Return the signatures that numba names in its error messages, a list with (double,
        double) -> double alone, and False, since there are no type parameters.
        """
        return [signature(types.float64, types.float64, types.float64)], False

    def get_impl_key(self, _):
        """Return the key under which numba finds :func:`_lower_call`, the class itself: one for all
        laws.
        """
        return LawType


class Jitted:
    """A law for jitted code: ``law.jitted(V, omega)`` -> :class:`LoadsAndSlopes`, all NaN where the
    law is not defined.

    The units of V, omega and the results are those of the scene's user data.  Python may call it
    too.  It cannot be pickled: that raises TypeError.

    Parameters
    ----------
    scenes : two records of user data (:func:`pack_scenes`), without slopes and with slopes, whose
        first field is the address of the C function.
    owner : any object that owns the memory to which addresses in ``scenes`` point; it is kept.

    Attributes
    ----------
    plain, address : int, addresses of the user data without slopes and with slopes.
    function : the C function for calls from Python, which keeps the GIL: to release the GIL would
        take longer than to evaluate the law.
    function_address : int, its address.
    """

    _numba_type_ = LawType()

    def __init__(self, scenes: NDArray[Any], owner):
        self._scenes = scenes
        self._owner = owner
        # record 0 is without slopes, record 1 with slopes; both have the same C function.  Its
        # pointers are declared as void pointers, since ``out`` and an address are passed.
        self.plain, self.address = (int(scenes[n:].ctypes.data) for n in (0, 1))
        self.function_address = int(scenes["function"][0])
        self.function = ctypes.PYFUNCTYPE(*_C_TYPES[:3], ctypes.c_void_p, ctypes.c_void_p)(
            self.function_address
        )

    def __call__(self, V: float, omega: float) -> LoadsAndSlopes:
        out = ResultBuffer()
        self.function(V, omega, out, self.address)
        return LoadsAndSlopes(*out)

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "law.jitted is machine code of this process: pickle the law, or its scene, and bind it "
            "there"
        )

    @cached_property
    def ctypes(self) -> tuple[Any, ctypes.c_void_p]:
        """The C function and its user data, for ctypes; each keeps this law alive.

        Returns a tuple: a function of ctypes (V, omega, pointer to RESULTS doubles that it writes,
        address of the user data) -> status, which releases the GIL; a ``c_void_p`` of the user data
        with slopes.  The status is 0, or another int where the law is not defined and all these
        doubles are NaN.
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
    """Return instructions that read the address of the user data of a law that Python passes to
    jitted code.

    kind, c : numba's type of the law, not used, and its context of unboxing.
    law : the Python object, a :class:`Jitted`, as a value of LLVM.
    Returns numba's ``NativeValue``: the address, a 64-bit integer of LLVM, and a bit that is set if
    Python raised an error on the way.
    """
    address = c.pyapi.object_getattr_string(law, "address")
    value = c.pyapi.long_as_ulonglong(address)
    c.pyapi.decref(address)
    return NativeValue(value, is_error=c.pyapi.c_api_error())


@lower_constant(LawType)
def _lower_constant(context, builder, kind, law):
    """Return instructions for the address of a law that is a constant of the code, such as a global
    variable of a function.

    context, builder, kind : numba's context of code generation, builder of LLVM and type of the
    law.
    law : the :class:`Jitted`, which is appended to a list of this module and so kept alive until
    the process ends.
    Returns a value of LLVM: the address of the user data as a 64-bit integer.

    numba does not put code with such an address into its cache: the next process has other
    addresses.
    """
    _constants.append(law)
    return builder.ptrtoint(context.add_dynamic_addr(builder, law.address, info="law"), _WORD)


@lower_builtin(LawType, LawType, types.float64, types.float64)
def _lower_call(context, builder, signature, arguments):
    """Return instructions that call the C function of a law; numba calls this function to compile
    law(V, omega).

    The address of the C function is the first word of the law's user data, ``function`` of a SCENE.

    context, builder, signature : numba's context of code generation, builder of LLVM, signature of
    the call.
    arguments : values of LLVM: the law, which is the address of its user data, and the doubles V
        and omega, in the units of the user data.
    Returns a value of LLVM: the RESULTS results as a :class:`LoadsAndSlopes`, in the units of the
    user data.  The status of the C function is not read: a state at which the law is not defined
    has NaN in all of them.
    """
    # The record as doubles, and its first word as the address of a function; the results are
    # written to the stack of the caller.
    law, V, omega = arguments
    scene = builder.inttoptr(law, _POINTER)
    function = builder.load(builder.bitcast(scene, _FUNCTION.as_pointer().as_pointer()))
    out = cgutils.alloca_once(builder, _DOUBLE, size=_WORD(RESULTS))
    builder.call(function, [V, omega, out, scene])
    numbers = [builder.load(builder.gep(out, [_WORD(n)])) for n in range(RESULTS)]
    return context.make_tuple(builder, signature.return_type, numbers)
