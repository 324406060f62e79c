"""The law of a grid at one alpha as a C function, like :mod:`..rows.c_function`: splines in ln |V| and delta.

``int law(double V, double omega, double out[8], void *grid)``; ``grid`` is its user data, a :data:`GRID`.
Below the slowest speed of the grid Q is that of the slowest at the same creep, and M is in proportion to V.  Beyond
both ends of delta |Q| is mu P, where the grid slips fully there.  The status of other states outside is not 0.
"""

from __future__ import annotations

import ctypes

import numpy as np
from numba import carray
from numba.core import types
from numpy.typing import NDArray

from ..compile.intrinsics import floats_at, function_address, record_at
from ..compile.jit import kernel
from ..rows import jitted_law
from ..rows.c_function import RESULTS
from .spline import HIGH, evaluate

#: Fields of the law, each a spline.
FIELDS = ("Q", "M_half_space", "M_cylinder")
#: User data: address of the function; whether slopes are asked for; of each spline its address and size; whether the
#: grid slips fully at both ends of delta; slowest V; last delta on either side; R, which turns omega into a speed.
GRID = np.dtype(
    [(name, np.int64) for name in ("function", "slopes", *FIELDS, *(f"{name}_size" for name in FIELDS), "slips")]
    + [(name, np.float64) for name in ("slowest", "low", "high", "R")]
)


@kernel(allocates=True)
def _loads(speed_of_axis, spin, to, grids):
    out, grid = carray(to, RESULTS), record_at(grids)
    Q = floats_at(grid.Q, grid.Q_size)
    turn, slip = (1.0 if speed_of_axis >= 0.0 else -1.0), spin * grid.R - speed_of_axis
    speed = abs(speed_of_axis)
    V, delta = max(speed, grid.slowest), turn * slip / speed if slip != 0.0 else 0.0
    traction = evaluate(Q, V, min(max(delta, grid.low), grid.high), 0.0)
    half = evaluate(floats_at(grid.M_half_space, grid.M_half_space_size), V, 0.0, 0.0)
    other = evaluate(floats_at(grid.M_cylinder, grid.M_cylinder_size), V, 0.0, 0.0)
    beyond = not grid.low <= delta <= grid.high
    if not (abs(slip) < np.inf and speed < np.inf and half.value == half.value) or (beyond and not grid.slips):
        for n in range(RESULTS):
            out[n] = np.nan
        return 1
    slow, part = speed < grid.slowest, speed / V
    dV, ddelta = (0.0 if slow or beyond else traction.dV), (0.0 if beyond else traction.ddelta)
    out[0] = turn * (np.copysign(Q[HIGH], delta) if beyond else traction.value)
    out[2], out[3] = turn * part * half.value, turn * part * other.value
    out[1] = out[2] + out[3]
    if grid.slopes:
        out[4] = out[5] = 0.0
        if ddelta != 0.0:  # at rest infinite, as those of the law
            out[4], out[5] = dV - ddelta * (1.0 + delta) / speed, ddelta * grid.R / speed
        out[6], out[7] = (half.value / V if slow else half.dV), (other.value / V if slow else other.dV)
    return 0


class JittedGrid(jitted_law.Jitted):
    """The law of a grid for jitted code: a :class:`Jitted` with the function and the user data of this module.

    splines : those of the :data:`FIELDS`, which it keeps.
    numbers : the other fields of :data:`GRID`.
    """

    def __init__(self, splines: dict[str, NDArray[np.float64]], **numbers: float) -> None:
        self._law, self._scenes = splines, np.zeros(2, GRID)  # type: ignore[assignment]
        kinds = types.int32, types.float64, types.float64, types.CPointer(types.float64)
        self.function_address = function_address(_loads, GRID, *kinds)
        numbers |= {"function": self.function_address} | {name: each.ctypes.data for name, each in splines.items()}
        for name, number in (numbers | {f"{name}_size": each.size for name, each in splines.items()}).items():
            self._scenes[name] = number
        self._scenes["slopes"] = 0, 1
        self.plain, self.address = (int(self._scenes[n:].ctypes.data) for n in (0, 1))
        self.function = ctypes.PYFUNCTYPE(*jitted_law._C[:3], ctypes.c_void_p, ctypes.c_void_p)(self.function_address)
