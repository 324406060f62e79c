"""The motions that a flow map is made from and measured by: what rolls them is known here alone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..blocks import flattened, run_blocks
from ..scene import kernel_scene

Floats = NDArray[np.float64]

#: steps with the last tolerance of several, and with others
_MOST_STEPS, _FEW_STEPS = 100_000, 2_000
_BLOCK, _ENDS = 40, 100_000


def motions(
    parameters: tuple[Any, ...], starts: tuple[Floats, Floats], gamma: Floats, t: Floats, rtols: tuple[float, ...],
    *, losses: bool = False, threads: int | None = 1,
) -> tuple[Floats, Floats]:  # fmt: skip
    """(V, omega, x, angle, delta, regime, slip_loss, rolling_loss of motions at common times; status and the like).

    By the kernel that ``roll`` compiles: none is compiled for a map alone.

    Parameters
    ----------
    starts : V and omega.
    gamma : one a motion, which makes the common times what that counts in.
    rtols : the first with which a motion comes to its end: with alpha of 1e10 rounding shows.
    losses : of one motion.
    """
    from ..kernels.motion.loop import INFO, motion_loop
    from ..kernels.motion.losses import ROWS, add_losses, loss_points
    from ..kernels.motion.output import OUTPUTS

    scene = kernel_scene(*parameters)
    _, kappa, mu, j = parameters
    arrays = [flattened(np.asarray(a, float), np.shape(a)) for a in (kappa, mu, gamma, j, *starts)]
    out, info = np.full((ROWS, starts[0].size, t.size), np.nan), np.empty((starts[0].size, len(INFO)))

    def rolled(which: NDArray, times: Floats, limits: tuple, ends: Floats) -> tuple[Floats, Floats]:
        given = (flattened(a[which], which.shape) if a.size > 1 else a for a in arrays)
        found, how = np.full((OUTPUTS, which.size, times.size), np.nan), np.empty((which.size, len(INFO)))
        own = kernel_scene(*parameters).material  # of this thread
        notes = np.empty((0, 2)), ends
        motion_loop((own, *given), times, limits, np.arange(OUTPUTS), found, how, notes, 0, which.size)
        return found, how

    def work(start: int, stop: int) -> None:
        left, ends = np.arange(start, stop), np.zeros(_ENDS if losses else 0)
        for rtol in rtols:
            limits = rtol, 0.0, _MOST_STEPS if rtol == rtols[-1] else _FEW_STEPS
            out[:OUTPUTS, left], info[left] = rolled(left, t, limits, ends)
            if losses:
                edges, points_at = loss_points(ends, t)
                points, _ = rolled(left, points_at, limits, ends[:0])
                V0, omega0 = (float(speed[0]) for speed in starts)
                add_losses(scene, float(gamma[0]), V0, omega0, t, edges, points[:, 0], out[:, 0])
            left = left[info[left, 0] != 0]
            if not left.size:
                break

    run_blocks(work, starts[0].size, _BLOCK, threads=threads)
    return out, info
