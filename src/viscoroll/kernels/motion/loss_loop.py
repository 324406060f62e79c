"""Many motions as in :mod:`loop`, with the energy that they lose; apart from it, so that none compiles both."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import fill
from .integrate import integrate
from .loop import keep, motion_of
from .losses import ROWS, SLIP_LOSS, add_losses, loss_points
from .output import OUTPUTS
from .records import Batch, Limits, Notes

#: room for the ends of steps at first
_ENDS = 1000


@kernel(allocates=True, seconds=15)
def loss_loop(batch, t, limits, rows, out, info, start, stop):
    """Motions start..stop; as ``motion_loop``, but ``rows`` may name those of :mod:`losses` too."""
    motions, limits = Batch(*batch), Limits(*limits)
    one, switches, step_ends = np.empty((ROWS, t.size)), np.empty((0, 2)), np.zeros(_ENDS)
    for i in range(start, stop):
        scene, gamma, V0, omega0 = motion_of(motions, i)
        while True:
            for row in one:
                fill(np.nan, row)
            result = integrate(scene, gamma, V0, omega0, t, limits, one, Notes(switches, step_ends))
            if step_ends[step_ends.size - 1] == 0.0:
                break
            step_ends = np.zeros(4 * step_ends.size)
        if rows.max() >= SLIP_LOSS:
            edges, times = loss_points(step_ends, t)
            points = np.empty((OUTPUTS, times.size))
            for row in points:
                fill(np.nan, row)
            integrate(scene, gamma, V0, omega0, times, limits, points, Notes(switches, step_ends[:0]))
            add_losses(scene, gamma, V0, omega0, t, edges, points, one)
        keep(i, rows, one, result, out, info)
