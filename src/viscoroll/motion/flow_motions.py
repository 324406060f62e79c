"""The motions that a flow map is made from and measured by: what rolls them is known here alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.blocks import flattened, run_blocks
from ..core.typed import Floats
from ..materials.law_table import law_table
from .driven import LOSSES, ROWS, STATES, undriven
from .rolling import integrate

#: as tight as the integrator goes; with alpha of 1e10 it takes tens of thousands of steps
_RTOL, _MOST_STEPS = 1e-12, 100_000
_BLOCK = 40
#: status, steps, switches, onset and rest time
_INFO = 5


def motions(
    parameters: tuple[Any, ...], starts: tuple[Floats, Floats], gamma: Floats, t: Floats, *, threads: int | None = 1
) -> tuple[Floats, Floats]:
    """(V, omega, x, angle, delta, regime, slip_loss, rolling_loss of motions at common times; status and the like).

    By the kernel that ``roll`` compiles: none is compiled for a map alone.

    Parameters
    ----------
    starts : V and omega.
    gamma : one a motion, which makes the common times what that counts in.
    """
    rows = np.array([ROWS.index(name) for name in STATES + LOSSES], np.int64)
    given, kappa, mu, j = parameters
    law, limits = law_table(given), (_RTOL, 0.0, _MOST_STEPS)
    arrays = [flattened(np.asarray(a, float), np.shape(a)) for a in (kappa, mu, gamma, j, *starts)]
    out, info = np.empty((len(rows), starts[0].size, t.size)), np.empty((starts[0].size, _INFO))

    def work(start: int, stop: int) -> None:
        own = (array[start:stop] if array.size > 1 else array for array in arrays)
        batch = law.record, law.unlike, *own
        out[:, start:stop], info[start:stop] = integrate(stop - start, batch, undriven(), t, limits, rows)

    run_blocks(work, starts[0].size, _BLOCK, threads=threads)
    return out, info
