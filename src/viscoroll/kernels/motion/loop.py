"""Many motions, each with its own start and, where given, its own scene."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.material import material_of
from ..numerics.arrays import copy, fill
from .integrate import integrate
from .output import OUTPUTS
from .records import Scene

#: columns of the per-motion information
INFO = ("status", "steps", "switches", "onset_time", "rest_time")


@kernel
def _own(array, i):
    """The value of motion i."""
    return array[min(i, array.size - 1)]


@kernel(allocates=True)  # the scene holds a reference to its material's table
def motion_of(batch, i):
    """(scene, gamma, V0, omega0) of motion i."""
    scene = Scene(material_of(batch.material, i), _own(batch.kappa, i), _own(batch.mu, i), _own(batch.j, i))
    return scene, _own(batch.gamma, i), _own(batch.V0, i), _own(batch.omega0, i)


@kernel
def keep(i, rows, one, result, out, info):
    """Put the chosen rows of a motion, and what ``integrate`` returned, where those of all lie."""
    for n in range(rows.size):
        copy(one[rows[n]], out[n, i])
    info[i, 0], info[i, 1], info[i, 2], info[i, 3], info[i, 4] = result


@kernel(allocates=True, seconds=12)
def motion_loop(batch, t, limits, rows, out, info, start, stop):
    """Motions start..stop; ``rows`` picks the output quantities of ``integrate`` into out[quantity, motion, time]."""
    one = np.empty((OUTPUTS, t.size))
    switches, step_ends = np.empty((0, 2)), np.empty(0)
    for i in range(start, stop):
        for row in one:
            fill(np.nan, row)
        scene, gamma, V0, omega0 = motion_of(batch, i)
        result = integrate(scene, gamma, V0, omega0, t, limits, one, switches, step_ends)
        keep(i, rows, one, result, out, info)
