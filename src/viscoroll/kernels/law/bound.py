"""The law of one scene as a C function: ``int law(double V, double omega, double out[8], void *scene)``.

One function a kind of material, compiled once for all scenes; a scene is a vector of numbers that it is given the
address of.  ``out``: Q, M, its parts in half-space and cylinder, then dQ/dV at fixed omega, dQ/domega and the slopes
of the parts; all NaN where the status is not 0.  Nothing is written but ``out``: any number of threads may call.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from llvmlite import ir
from numba import carray
from numba.core import cgutils, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..material.pair import Body, Pair
from ..material.standard import Standard
from ..material.tabulated import Ends, Tabulated, make_own
from ..numerics import quartet
from ..numerics.bins import bin_number, bin_place
from .length import OK
from .state import (
    DM_CYLINDER_DV,
    DM_DV,
    DM_HALF_SPACE_DV,
    DQ_DOMEGA,
    DQ_DV,
    M_CYLINDER,
    M_HALF_SPACE,
    ROWS,
    M,
    Need,
    Q,
    State,
    contact_state,
)

#: status of input that is not finite, or of kappa |V| beyond :data:`FASTEST`
OUT_OF_RANGE = 2
FASTEST = 1e300
OUT = 8
#: bins of all doubles
_ALL = 1 << (11 + quartet.BITS)
#: numbers of a scene: its function; kappa, mu, the time in which its material counts; the material (:func:`_flat`)
_FUNCTION, _KAPPA, _MU, _UNIT, _MATERIAL = range(5)
_TABLE, _ENDS, _PARTS, _HALF_SPACE, _CYLINDER, _SIZE = (_MATERIAL + n for n in (3, 5, 10, 12, 18, 24))
_DOUBLES = types.CPointer(types.float64)
_SIGNATURE = types.int32(types.float64, types.float64, _DOUBLES, _DOUBLES)


@intrinsic
def _scratch(typing_context):
    """Room on the stack for the rows of one state."""

    def lower(context, builder, signature, given):
        return cgutils.alloca_once(builder, ir.DoubleType(), size=ir.Constant(ir.IntType(64), len(ROWS)))

    return _DOUBLES(), lower


@intrinsic
def _doubles_at(typing_context, address):
    """The doubles at an address that is kept as the bits of a double."""

    def lower(context, builder, signature, given):
        return builder.inttoptr(builder.bitcast(given[0], ir.IntType(64)), ir.DoubleType().as_pointer())

    return _DOUBLES(types.float64), lower


@kernel(inline=True, allocates=True)
def _table(scene, at):
    """The table whose address and number of rows stand there."""
    return carray(_doubles_at(scene[at]), (int(scene[at + 1]), quartet.WIDTH))


@kernel(inline=True)
def _ends(scene, at):
    return Ends(True, scene[at + 1], scene[at + 2], scene[at + 3], scene[at + 4])


@kernel(inline=True)
def _body(scene, at):
    return Body(scene[at], _ends(scene, at + 1))


@kernel(inline=True)
def _no_parts(state, material, out):
    """Bodies that are alike take half of M each."""
    out[2] = out[3] = 0.5 * state[M]
    out[6] = out[7] = 0.5 * state[DM_DV]


@kernel(inline=True)
def _parts_of_pair(state, material, out):
    out[2], out[3] = state[M_HALF_SPACE], state[M_CYLINDER]
    out[6], out[7] = state[DM_HALF_SPACE_DV], state[DM_CYLINDER_DV]


_put_parts = by_record(1, (Pair, _parts_of_pair), otherwise=_no_parts)


@kernel(inline=True, allocates=True)
def _law(V, omega, to, scene, material):
    """A status; the eight numbers into ``to``."""
    out, kappa, unit, status = carray(to, OUT), scene[_KAPPA], scene[_UNIT], OUT_OF_RANGE
    if kappa * abs(V) <= FASTEST and abs(V) < np.inf and abs(omega) < np.inf:
        rows = carray(_scratch(), len(ROWS))
        state = State(kappa, scene[_MU], V * unit, omega * unit, True)
        status = contact_state(material, state, Need(True, True, True, True, True), rows)
        _put_parts(rows, material, out)
        out[0], out[1], out[4], out[5] = rows[Q], rows[M], rows[DQ_DV], rows[DQ_DOMEGA]
        for n in range(4, OUT):
            out[n] *= unit
    if status != OK:
        for n in range(OUT):
            out[n] = np.nan
    return status


@kernel(inline=True)
def _three(scene):
    """alpha, T_mean and tau."""
    return scene[_MATERIAL], scene[_MATERIAL + 1], scene[_MATERIAL + 2]


@kernel(allocates=True)
def _law_standard(V, omega, out, numbers):
    scene = carray(numbers, _SIZE)
    alpha, T_mean, tau = _three(scene)
    return _law(V, omega, out, scene, Standard(alpha, T_mean, tau))


@kernel(allocates=True)
def _law_tabulated(V, omega, out, numbers):
    scene = carray(numbers, _SIZE)
    alpha, T_mean, tau = _three(scene)
    material = Tabulated(alpha, T_mean, tau, _table(scene, _TABLE), _ends(scene, _ENDS))
    return _law(V, omega, out, scene, material)


@kernel(allocates=True)
def _law_pair(V, omega, out, numbers):
    scene = carray(numbers, _SIZE)
    alpha, T_mean, tau = _three(scene)
    table, parts = _table(scene, _TABLE), _table(scene, _PARTS)
    half_space, cylinder = _body(scene, _HALF_SPACE), _body(scene, _CYLINDER)
    material = Pair(alpha, T_mean, tau, table, _ends(scene, _ENDS), parts, half_space, cylinder)
    return _law(V, omega, out, scene, material)


@kernel
def _make_all(material):
    """Make the bins that are not there, in a table that has a row for each."""
    table = material.table
    for number in range(_ALL):
        middle = bin_place(number, quartet.BITS, 0.5)
        row, there = quartet.row_of(middle, table)
        if not there and bin_number(middle, quartet.BITS) == number:
            made = make_own(row, middle, material)
            for n in range(quartet.WIDTH):
                table[row, n] = table[made, n]


_KINDS = {Standard: _law_standard, Tabulated: _law_tabulated, Pair: _law_pair}


def with_every_bin(material: Any) -> Any:
    """The record of a series or a pair with a table that lacks no bin, so that nobody writes to it."""
    table = np.empty((_ALL + quartet.SPARE, quartet.WIDTH))
    table[:] = np.nan
    numbers = np.ascontiguousarray(material.table[: -quartet.SPARE, 0]).view(np.int64)
    held = (numbers >= 0) & (numbers < _ALL)  # nothing else is the bits of NaN
    table[numbers[held]] = material.table[: -quartet.SPARE][held]
    full = material._replace(table=table)
    _make_all(full)
    table.flags.writeable = False
    return full


def bind(material: Any, kappa: float, mu: float, unit: float) -> NDArray[np.float64]:
    """The numbers of a scene; the tables of the material are to outlive them."""
    scene = np.zeros(_SIZE)
    values = [kappa, mu, unit, *_flat(material)]
    scene[_KAPPA : _KAPPA + len(values)] = values
    scene[_FUNCTION] = _bits(_function(type(material)))
    return scene


def _flat(record: Any) -> list[float]:
    """The numbers of a record one after the other; of an array, its address and its length."""
    found: list[float] = []
    for value in record:
        if isinstance(value, tuple):
            found += _flat(value)
        elif isinstance(value, np.ndarray):
            found += [_bits(value.ctypes.data), float(len(value))]
        else:
            found.append(float(value))
    return found


def function_of(scene: NDArray[np.float64]) -> int:
    """Address of the function that takes this scene."""
    return int(scene[:1].view(np.int64)[0])


def _bits(address: int) -> float:
    return float(np.array(address).view(np.float64))


@cache
def _function(kind: type) -> int:
    """Address of the law of this kind of material."""
    function = _KINDS[kind]
    function.compile(_SIGNATURE)
    compiled = function.overloads[_SIGNATURE.args]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name))
