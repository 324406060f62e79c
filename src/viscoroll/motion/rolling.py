"""One motion by the kernel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import Parameters
from ..core.errors import MotionStatus, ParameterError
from .driven import ROWS, Drive, prepared, refuse_rest
from .unsteady import climbed

_ALL = np.arange(len(ROWS))


class Inputs(NamedTuple):
    """What a motion was rolled from, without dimension."""

    scene: Parameters
    V0: Any
    omega0: Any
    end: float
    #: rtol, rest, max_steps
    limits: tuple[float, float, int]
    drive: Drive
    unsteady: bool
    rested: float


def rolled(inputs: Inputs, times: NDArray, notes: tuple) -> tuple[float, NDArray, list[float]]:
    """(Error of the drive, rows of ``ROWS``, (status, steps, switches, onset time, rest time)) of one motion.

    ``notes``: room for the switches and for the ends of steps.
    """
    from ..kernels.motion.loop import INFO, motion_loop

    ready = prepared(inputs.drive, inputs.V0, inputs.omega0, inputs.end, inputs.limits[0])
    refuse_rest(inputs.limits[1], ready)
    if (many := max(ready.pieces.shape[0], ready.gains.shape[1])) > 1:
        raise ParameterError("drive", f"of {many} motions", "one motion's; for many use ensemble")
    ready, caught = climbed(ready, inputs.scene, inputs.rested)
    if caught:
        nothing = np.full((len(ROWS), times.size), np.nan)
        return ready.error, nothing, [MotionStatus.CAUGHT, 0, 0, np.nan, np.nan]
    scene, law = inputs.scene, inputs.scene.table
    assert law is not None
    one = np.array((scene.kappa, scene.mu, scene.gamma, scene.j, ready.V0, ready.omega0), float).reshape(-1, 1)
    one.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    out, info = np.empty((_ALL.size, 1, times.size)), np.empty((1, len(INFO)))
    batch = law.unsteady_record if inputs.unsteady else law.record, law.unlike, *one
    motion_loop(batch, ready.for_kernel(), times, inputs.limits, _ALL, out, info, notes)
    return ready.error, out[:, 0], info[0].tolist()
