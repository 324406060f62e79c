"""One motion by the kernels: that of free motions, or that of driven ones and of bodies that differ."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..materials.tables import record
from ..scene import Scene
from .driven import LOSSES, ROWS, Drive, prepared, refuse_rest
from .each import to_unit


class Inputs(NamedTuple):
    """What a motion was rolled from."""

    scene: Scene
    V0: Any
    omega0: Any
    end: float
    rtol: float
    rest: float
    max_steps: int
    drive: Drive


def rolled(inputs: Inputs, times: NDArray, notes: tuple) -> tuple[Scene, float, NDArray, list[float]]:
    """(Scene, error of the drive, rows of ``ROWS``, (status, steps, switches, onset time, rest time)) of one motion.

    ``notes``: room for the switches and for the ends of steps.  Without a drive, and of like bodies, by the kernel of
    free motions, which leaves the losses NaN.  Kernels count time in the material's own unit.
    """
    scene, drive = inputs.scene, inputs.drive
    driven = drive.acts or not scene.like_bodies
    ready, V0, omega0 = None, inputs.V0, inputs.omega0
    if driven:
        ready = prepared(drive, scene, V0, omega0, inputs.end, inputs.rtol)
        refuse_rest(inputs.rest, ready)
        if (many := max(ready.pieces.shape[0], ready.gains.shape[1])) > 1:
            raise ParameterError("drive", f"of {many} motions", "one motion's; for many use ensemble")
        scene, V0, omega0 = ready.scene, ready.V0, ready.omega0
    material, unit = scene.in_own_time()
    one = np.array((scene.kappa, scene.mu, scene.gamma * unit * unit, scene.j, V0 * unit, omega0 * unit)).reshape(-1, 1)
    one.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    limits = inputs.rtol, inputs.rest * unit, inputs.max_steps
    if ready is None:
        out, info = _free((record(material), *one), times / unit, limits, notes)
    else:
        out, info = _driven((record(scene.kernel_material), *one), ready.in_unit(unit), times / unit, limits, notes)
    if unit != 1.0:
        switches, ends = notes
        to_unit(out, ROWS, unit)
        info[3:] *= unit
        switches[:, 0] *= unit
        ends *= unit
    return scene, 0.0 if ready is None else ready.error, out, info.tolist()


def _free(given: tuple, times: NDArray, limits: tuple, notes: tuple) -> tuple[NDArray, NDArray]:
    """A motion without a drive: nothing acts, and what is lost is not known."""
    from ..kernels.motion.loop import INFO, motion_loop
    from ..kernels.motion.output import OUTPUTS

    out, info = np.zeros((len(ROWS), 1, times.size)), np.empty((1, len(INFO)))
    motion_loop(given, times, limits, np.arange(OUTPUTS), out[:OUTPUTS], info, notes, 0, 1)
    out[OUTPUTS:] = np.where(np.isnan(out[0]), np.nan, 0.0)
    out[-len(LOSSES) :] = np.nan
    return out[:, 0], info[0]


def _driven(given: tuple, drives: tuple, times: NDArray, limits: tuple, notes: tuple) -> tuple[NDArray, NDArray]:
    """A motion under a drive, or of bodies that differ."""
    from ..kernels.drive.loop import drive_loop
    from ..kernels.motion.loop import INFO

    out, info = np.empty((len(ROWS), 1, times.size)), np.empty((1, len(INFO)))
    drive_loop(given, drives, times, limits, np.arange(len(ROWS)), out, info, notes)
    return out[:, 0], info[0]
