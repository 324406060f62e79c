"""The law of a grid at one alpha as a C function, like :mod:`..rows.c_function`: splines in ln |V| and delta.

``int law(double V, double omega, double out[8], void *grid)``; ``grid`` is its user data, a :data:`GRID`.

Below the slowest speed of the grid Q is that of the slowest at the same creepage, and M is in proportion to V, so that
it is 0 at V = 0.  Beyond both ends of delta |Q| is mu P, if the grid slips fully there.  In all other states outside of
the grid the status is not 0.  The creepage is delta = (omega R - V)/V, infinite for V = 0 with omega not 0.
"""

import numpy as np
from numba import carray
from numpy.typing import NDArray

from ..compile.intrinsics import floats_at, record_at, record_type
from ..compile.jit import kernel
from ..rows.c_function import RESULTS, c_function_address, refuse
from ..rows.jitted_law import Jitted
from .spline import HIGH, evaluate

#: User data.  function: address of the C function.  slopes: whether slopes are asked for.  Of each spline its address
#: and size.  slips: whether the grid slips fully at both ends of delta.  slowest: least V.  low, high: ends of delta.
#: R: radius, which turns omega into a speed.
GRID = record_type(
    "function slopes Q M_half_space M_cylinder Q_size M_half_space_size M_cylinder_size slips", "slowest low high R"
)


@kernel(allocates=True)
def _grid_law(V, omega, pointer, grids):
    """Evaluate the splines of a grid at one state and write the results; it is the C function of the grid.

    V, omega : speed of the axis and angular velocity in the units of the grid, of any sign.
    pointer : address of RESULTS numbers, of which the first four are written: Q, M, M_half_space, M_cylinder; then,
        if ``grid.slopes``, dQ/dV at fixed omega, dQ/domega at fixed V, dM_half_space/dV, dM_cylinder/dV and 0, 0 (M does not
        depend on omega), else these stay; all in the units of the grid.
    grids : pointer to a GRID record: addresses of the splines and the bounds of the grid.

    Both slopes of Q are 0 where Q does not depend on the creepage: beyond the ends of delta, and where it is clipped to
    +-mu P.  At rest (V = omega = 0) they are infinite.  V = 0 counts as rolling in the direction V > 0.

    Returns the status, an int: 0; or 1, and all results are NaN, where |V| is above the grid, V or omega is not
    finite, or delta is outside a grid that does not slip fully at its ends.
    """
    out = carray(pointer, RESULTS)
    grid = record_at(grids)
    Q = floats_at(grid.Q, grid.Q_size)
    sign = 1.0 if V >= 0.0 else -1.0
    slip = omega * grid.R - V
    speed = abs(V)
    grid_V = max(speed, grid.slowest)
    delta = sign * slip / speed if slip != 0.0 else 0.0
    traction = evaluate(Q, grid_V, min(max(delta, grid.low), grid.high), 0.0)
    half_space = evaluate(floats_at(grid.M_half_space, grid.M_half_space_size), grid_V, 0.0, 0.0)
    cylinder = evaluate(floats_at(grid.M_cylinder, grid.M_cylinder_size), grid_V, 0.0, 0.0)
    beyond = not grid.low <= delta <= grid.high
    defined = abs(slip) < np.inf and speed < np.inf and half_space.value == half_space.value
    if not defined or (beyond and not grid.slips):
        return refuse(out)
    slow = speed < grid.slowest
    part = speed / grid_V
    ddelta = 0.0 if beyond else traction.ddelta
    out[0] = sign * (np.copysign(Q[HIGH], delta) if beyond else traction.value)
    out[2] = sign * part * half_space.value
    out[3] = sign * part * cylinder.value
    out[1] = out[2] + out[3]
    if grid.slopes:
        out[4] = out[5] = out[8] = out[9] = 0.0
        if ddelta != 0.0:  # at rest infinite, like those of the law
            out[4] = (0.0 if slow else traction.dV) - ddelta * (1.0 + delta) / speed
            out[5] = ddelta * grid.R / speed
        out[6] = half_space.value / grid_V if slow else half_space.dV
        out[7] = cylinder.value / grid_V if slow else cylinder.dV
    return 0


def jitted_grid(splines: dict[str, NDArray[np.float64]], **numbers: float) -> Jitted:
    """Return the law of a grid, tables of Q and M over V and delta, as a function for jitted code.

    splines : "Q", "M_half_space" and "M_cylinder" -> vector of a spline (:mod:`.spline`), doubles, (numbers,), which
        the law keeps alive.
    numbers : fields of :data:`GRID` by name, in the units of the grid: slips (1 if the grid slips fully at both ends of
        delta, else 0), slowest (least V), low and high (ends of delta), R (radius, which turns omega into a speed).

    Returns the :class:`Jitted` law: (V, omega) -> :class:`LoadsAndSlopes`, ten floats in the units of the grid: Q, M,
    M_half_space, M_cylinder and the slopes of :func:`_grid_law`; all NaN where the law of the grid is not defined.
    Raises ValueError of numpy if a name is no field of GRID; that all are given is not checked.
    """
    grids = np.zeros(2, GRID)
    grids["slopes"] = 0, 1
    grids["function"] = c_function_address(_grid_law, GRID)
    for name, spline in splines.items():
        grids[name] = spline.ctypes.data
        grids[f"{name}_size"] = spline.size
    for name, number in numbers.items():
        grids[name] = number
    return Jitted(grids, splines)
