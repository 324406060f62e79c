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


@kernel(allocates=True)
def motion_loop(material, kappa, mu, gamma, j, V0, omega0, t, rtol, rest, max_steps, rows, out, info, start, stop):
    """Motions start..stop; parameters hold one value or one a motion.

    ``rows`` picks the output quantities of ``integrate`` into out[quantity, motion, time].
    """
    one = np.empty((OUTPUTS, t.size))
    switches, step_ends = np.empty((0, 2)), np.empty(0)
    for i in range(start, stop):
        scene = Scene(
            material_of(material, i), kappa[min(i, kappa.size - 1)], mu[min(i, mu.size - 1)],
            j[min(i, j.size - 1)],
        )  # fmt: skip
        for row in one:
            fill(np.nan, row)
        result = integrate(
            scene, gamma[min(i, gamma.size - 1)],
            V0[min(i, V0.size - 1)], omega0[min(i, omega0.size - 1)],
            t, rtol, rest, max_steps, one, switches, step_ends,
        )  # fmt: skip
        for n in range(rows.size):
            copy(one[rows[n]], out[n, i])
        info[i, 0], info[i, 1], info[i, 2] = result[0], result[1], result[2]
        info[i, 3], info[i, 4] = result[3], result[4]
