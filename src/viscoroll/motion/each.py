"""Motions that have a material each: a block makes their records one after the other and drops them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..blocks import flattened
from ..materials.prony_array import MaterialArray
from ..materials.tables import records

#: how often the unit of time divides a field
_PER_TIME = {"V": 1, "omega": 1} | dict.fromkeys(
    ("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"), 2
)


def to_unit(out: NDArray, fields: tuple[str, ...], unit: float) -> None:
    """Divide each of the fields by what its unit of time asks for, in place."""
    for n, name in enumerate(fields):
        out[n] /= unit ** _PER_TIME.get(name, 0)


def roll_each(
    materials: MaterialArray, which: NDArray[np.int64], inputs: list[NDArray], times: NDArray,
    limits: tuple[float, float, int], fields: tuple[str, ...],
    roll: Callable[[tuple, tuple, NDArray, NDArray, tuple], Any],
) -> tuple[NDArray, NDArray]:  # fmt: skip
    """(outputs, information) of motions by the kernel ``roll``, each in the own time of its material.

    The last that ``roll`` takes: which of the motions these are, and what their times are counted in.
    ``inputs`` : kappa, mu, gamma, j, V0, omega0, vectors of one value or one a motion.
    """
    from ..kernels.free.loop import INFO

    rtol, rest, most = limits
    record, unit = records(materials, which)
    out, info = np.empty((len(fields), which.size, times.size)), np.empty((which.size, len(INFO)))
    for one in np.unique(unit):  # powers of two, few of them
        some = np.flatnonzero(unit == one)
        kappa, mu, gamma, j, V0, omega0 = (array[some] if array.size > 1 else array for array in inputs)
        scaled = (kappa, mu, gamma * (one * one), j, V0 * one, omega0 * one)
        given = record._replace(of=record.of[some]), *(flattened(array, array.shape) for array in scaled)
        part, told = np.empty((len(fields), some.size, times.size)), np.empty((some.size, len(INFO)))
        roll((given, times / one), (rtol, rest * one, most), part, told, (some, one))
        to_unit(part, fields, one)
        told[:, 3:] *= one
        out[:, some], info[some] = part, told
    return out, info
