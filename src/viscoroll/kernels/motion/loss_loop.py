"""Many motions as in :mod:`loop`, with the energy that they lose; apart from it, so that none compiles both."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.material import material_of
from ..numerics.arrays import copy, fill
from .integrate import integrate
from .losses import SLIP_LOSS, add_losses
from .output import OUTPUTS
from .records import Scene

#: room for the ends of steps at first
_ENDS = 1000


@kernel(allocates=True)
def loss_loop(material, kappa, mu, gamma, j, V0, omega0, t, rtol, rest, max_steps, rows, out, info, start, stop):
    """Motions start..stop; as ``motion_loop``, but ``rows`` may name those of :mod:`losses` too."""
    one, losses = np.empty((OUTPUTS, t.size)), np.empty((2, t.size))
    wanted = rows.max() >= SLIP_LOSS
    switches, step_ends = np.empty((0, 2)), np.zeros(_ENDS)
    for i in range(start, stop):
        scene = Scene(
            material_of(material, i), kappa[min(i, kappa.size - 1)], mu[min(i, mu.size - 1)],
            j[min(i, j.size - 1)],
        )  # fmt: skip
        scale = gamma[min(i, gamma.size - 1)]
        V, omega = V0[min(i, V0.size - 1)], omega0[min(i, omega0.size - 1)]
        while True:
            for row in one:
                fill(np.nan, row)
            result = integrate(
                scene, scale, V, omega, t, rtol, rest, max_steps,
                one, switches, step_ends,
            )  # fmt: skip
            if step_ends[step_ends.size - 1] == 0.0:
                break
            step_ends = np.zeros(4 * step_ends.size)
        if wanted:
            add_losses(scene, scale, V, omega, t, rtol, rest, max_steps, one, step_ends, losses)
        for n in range(rows.size):
            row = rows[n]
            if row < SLIP_LOSS:
                copy(one[row], out[n, i])
            else:
                copy(losses[row - SLIP_LOSS], out[n, i])
        info[i, 0], info[i, 1], info[i, 2] = result[0], result[1], result[2]
        info[i, 3], info[i, 4] = result[3], result[4]
