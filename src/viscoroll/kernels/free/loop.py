"""Motions, each with its own start and, where given, its own scene: what Python calls for one as for many."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import material_of
from ..numerics.arrays import copy, fill
from .integrate import integrate
from .output import OUTPUTS
from .records import Batch, Limits, Notes, Scene

#: columns of the per-motion information
INFO = ("status", "steps", "switches", "onset_time", "rest_time")
#: room for notes where none are asked for
NOTHING_NOTED = Notes(np.empty((0, 2)), np.empty(0))


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


@kernel(allocates=True)
def motion_loop(batch, t, limits, rows, out, info, notes, start, stop):
    """Motions start..stop; ``rows`` picks the output quantities of ``integrate`` into out[quantity, motion, time].

    ``batch``, ``limits`` and ``notes`` are plain tuples: it takes numba microseconds to tell the type of a record.
    The notes kept are those of the last motion.
    """
    motions, limits, notes = Batch(*batch), Limits(*limits), Notes(*notes)
    one = np.empty((OUTPUTS, t.size))
    for i in range(start, stop):
        for row in one:
            fill(np.nan, row)
        scene, gamma, V0, omega0 = motion_of(motions, i)
        result = integrate(scene, gamma, V0, omega0, t, limits, one, notes)
        keep(i, rows, one, result, out, info)
