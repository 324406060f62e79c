"""One motion by the kernel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import MotionStatus, ParameterError
from ..materials.law_table import LawTable, law_table
from ..parameters import Parameters
from .driven import ROWS, Drive, prepared, refuse_rest
from .unsteady import climbed


class Inputs(NamedTuple):
    """What a motion was rolled from, without dimension."""

    scene: Parameters
    V0: Any
    omega0: Any
    end: float
    rtol: float
    rest: float
    max_steps: int
    drive: Drive
    unsteady: bool
    rested: float


def law_of(scene: Parameters) -> LawTable:
    """The law of a scene of one material."""
    if scene.table is not None:
        return scene.table
    material: Any = scene.material
    return law_table(float(np.asarray(scene.alpha).item()) if material is None else material)


def rolled(inputs: Inputs, times: NDArray, notes: tuple) -> tuple[float, NDArray, list[float]]:
    """(Error of the drive, rows of ``ROWS``, (status, steps, switches, onset time, rest time)) of one motion.

    ``notes``: room for the switches and for the ends of steps.
    """
    from ..kernels.motion.loop import INFO, motion_loop

    ready = prepared(inputs.drive, inputs.V0, inputs.omega0, inputs.end, inputs.rtol)
    refuse_rest(inputs.rest, ready)
    if (many := max(ready.pieces.shape[0], ready.gains.shape[1])) > 1:
        raise ParameterError("drive", f"of {many} motions", "one motion's; for many use ensemble")
    ready, caught = climbed(ready, inputs.scene, inputs.rested)
    if caught:
        nothing = np.full((len(ROWS), times.size), np.nan)
        return ready.error, nothing, [MotionStatus.CAUGHT, 0, 0, np.nan, np.nan]
    scene, law = inputs.scene, law_of(inputs.scene)
    one = np.array((scene.kappa, scene.mu, scene.gamma, scene.j, ready.V0, ready.omega0), float).reshape(-1, 1)
    one.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    limits = inputs.rtol, inputs.rest, inputs.max_steps
    out, info = np.empty((len(ROWS), 1, times.size)), np.empty((1, len(INFO)))
    batch = law.unsteady_record if inputs.unsteady else law.record, law.unlike, *one
    motion_loop(batch, ready.for_kernel(), times, limits, np.arange(len(ROWS)), out, info, notes)
    return ready.error, out[:, 0], info[0].tolist()
