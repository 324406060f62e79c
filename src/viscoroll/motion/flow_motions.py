"""The motions that a flow map is made from and measured by: what rolls them is known here alone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..blocks import flattened, run_blocks
from ..materials.law_table import law_table
from .driven import LOSSES, ROWS, STATES, undriven
from .rolling import NO_UNIT

Floats = NDArray[np.float64]

#: steps with the last tolerance of several, and with others
_MOST_STEPS, _FEW_STEPS = 100_000, 2_000
_BLOCK = 40


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
    losses : whether these are asked for too.
    """
    from ..kernels.motion.loop import INFO, motion_loop

    names = STATES + LOSSES if losses else STATES
    rows = np.array([ROWS.index(name) for name in names], np.int64)
    given, kappa, mu, j = parameters
    law = law_table(given)
    arrays = [flattened(np.asarray(a, float), np.shape(a)) for a in (kappa, mu, gamma, j, *starts)]
    out, info = np.full((len(rows), starts[0].size, t.size), np.nan), np.empty((starts[0].size, len(INFO)))

    def work(start: int, stop: int) -> None:
        left, notes = np.arange(start, stop), (np.empty((0, 2)), np.empty(0))
        for rtol in rtols:
            limits = rtol, 0.0, _MOST_STEPS if rtol == rtols[-1] else _FEW_STEPS
            own = (flattened(a[left], left.shape) if a.size > 1 else a for a in arrays)
            found, how = np.empty((len(rows), left.size, t.size)), np.empty((left.size, len(INFO)))
            batch = law.record, NO_UNIT, law.unlike, *own
            motion_loop(batch, undriven(), t, limits, rows, found, how, notes)
            out[:, left], info[left] = found, how
            left = left[how[:, 0] != 0]
            if not left.size:
                break

    run_blocks(work, starts[0].size, _BLOCK, threads=threads)
    return out, info
