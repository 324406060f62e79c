"""Many motions, each with its own start and, where given, its own scene and drive: the entry from Python.

Terms of this file, dimensionless (fields of the records in :mod:`records`):

- tau: time gamma t.
- Drive: force, torque, brake and prescribed speed, polynomials of tau on each segment; gains of the feedback.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X holds x at node i of a
  step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the Radau nodes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.by_reference import data_pointer
from ..compile.jit import kernel
from ..numerics.arrays import copy, fill
from ..rows.record import select_material
from .collocation import ROW_LENGTH
from .drive import n_coefficients
from .driver import integrate_motion
from .output import N_OUTPUTS, requested_groups
from .records import COL_COEFFICIENTS, COL_SCALE, COL_START, DRIVE_RATE, Batch, Drive, Gains, Options, Scene, Workspace
from .workspace import ROW_ONES, WORKSPACE_SIZE

#: Columns of the information on each motion.
INFO_COLUMNS = ("status", "steps", "switches", "onset_time", "rest_time")
#: Number of these columns.
N_INFO_COLUMNS = len(INFO_COLUMNS)


class Drives(NamedTuple):
    """Drives of many motions.

    segments : (m, k, columns) over t, m = 1 for all motions or one for each; columns as COL_* of :mod:`records`, with
        times and slopes in t, not in tau
    gains : (4, 1) or (4, n), dimensionless, in the order of :class:`Gains`
    prescribed : NOT_PRESCRIBED, PRESCRIBED_OMEGA or PRESCRIBED_V, the same for all
    """

    segments: Any
    gains: Any
    prescribed: int


@kernel
def _value_of_motion(array, i):
    """Return the value of a motion: ``array[i]``, or the last value where ``array`` is shorter.

    array: (1,) or (n,), one value for all motions, or one for each; not empty.
    i: int, index of the motion, 0 ... n - 1.
    Returns a value of the type of the array.
    """
    return array[min(i, array.size - 1)]


@kernel
def _drive_of_motion(drives, gamma, i, segments):
    """Write the segments of one motion as functions of tau = gamma t.

    Start, scale of time and the slope of the prescribed speed are converted from t to tau; forces, torques and the
    prescribed speed are copied.

    drives: Drives, over t; one for all motions, or one for each.
    gamma: float, tau = gamma t, dimensionless, above 0.
    i: int, index of the motion.
    segments: (k, columns), written: k segments over tau, columns as COL_* of :mod:`records`, k and columns as in
    ``drives.segments``.
    Returns the Gains of the motion, those of the last one given if there are fewer; they are not converted.
    """
    source = drives.segments[min(i, drives.segments.shape[0] - 1)]
    for k in range(segments.shape[0]):
        copy(source[k], segments[k])
        segments[k, COL_START] *= gamma
        segments[k, COL_SCALE] /= gamma
        n_terms = n_coefficients(segments[k])
        for n in range(DRIVE_RATE * n_terms, (DRIVE_RATE + 1) * n_terms):
            segments[k, COL_COEFFICIENTS + n] *= 1.0 / gamma
    n, gains = min(i, drives.gains.shape[1] - 1), drives.gains
    return Gains(gains[0, n], gains[1, n], gains[2, n], gains[3, n])


@kernel(allocates=True)
def motion_loop(batch, drives, t, options, rows, out, info, notes):
    """Integrate all motions of a batch.

    Batch, Drives and Options come as plain tuples: numba needs microseconds to find the type of a record.

    batch: fields of a :class:`Batch`: law, moments_differ, and kappa, mu, gamma, j, V0 and omega0, arrays (1,) or (n,),
    of n motions; n is the length of the second axis of ``out``.
    drives: fields of :class:`Drives`, over t: segments, gains, prescribed.
    t: (k,), output times, dimensionless, increasing, k >= 1, the first at least 0.
    options: fields of :class:`Options`: rtol, rest_speed (0: no rest threshold), max_steps of a motion.
    rows: (q,) int, requested output rows, unchecked: V 0, omega 1, x 2, angle 3, delta 4, regime 5, force 6, torque 7,
    work of force 8 and of torque 9, losses in the brake 10, in slip 11, in rolling 12.
    out: (q, n, k), [quantity, motion, time], filled; NaN at times that a motion did not reach.
    info: (n, 5), [motion, INFO_COLUMNS], filled: status (COMPLETED 0, CAME_TO_REST 1, STEP_LIMIT 2, STEP_TOO_SMALL 3,
    NOT_UNIQUE 4, ADDED_MASS_EXHAUSTED 5), trial steps, regime changes, and t of the onset of stick and of coming to
    rest, NaN where they do not occur.  A motion that fails has its status here; the others are not affected.
    notes: (switches, step_ends), arrays (m, 2) and (l,).  Each motion writes its regime changes, t and code (FULL_SLIP
    0, PARTIAL_SLIP 1, AT_REST 2, OMEGA_LOCKED 3, HELD_AT_REST 4; DIRECTION_REVERSED -1), and the ends t of its steps
    from their starts on, as far as they have room: they are meant for a single motion, as entries that a motion does
    not write are left as they were.  Returns nothing.
    """
    motions, drives, options = Batch(*batch), Drives(*drives), Options(*options)
    (with_quadratures, with_forces), (switches, step_ends) = requested_groups(rows), notes
    tau, quantities, segments = np.empty(t.size), np.empty((N_OUTPUTS, t.size)), np.empty(drives.segments.shape[1:])
    nodes = np.empty(WORKSPACE_SIZE)
    p_matrix, d_matrix = np.empty(ROW_LENGTH * ROW_LENGTH), np.empty(ROW_LENGTH * ROW_LENGTH)
    for i in range(out.shape[1]):
        for row in quantities:
            fill(np.nan, row)
        for array in (nodes, p_matrix, d_matrix):
            fill(0.0, array)
        fill(1.0, nodes[ROW_ONES : ROW_ONES + ROW_LENGTH])
        select_material(motions.law, i)
        kappa, mu = _value_of_motion(motions.kappa, i), _value_of_motion(motions.mu, i)
        gamma, j = _value_of_motion(motions.gamma, i), _value_of_motion(motions.j, i)
        for k in range(t.size):
            tau[k] = t[k] * gamma
        scene = Scene(motions.law, motions.moments_differ, kappa, mu, gamma, j)
        drive = Drive(segments, _drive_of_motion(drives, gamma, i, segments), drives.prescribed)
        V0, omega0 = _value_of_motion(motions.V0, i), _value_of_motion(motions.omega0, i)
        work = Workspace(
            scene, drive, options, tau, quantities, with_quadratures, with_forces, switches, step_ends,
            data_pointer(nodes), data_pointer(p_matrix), data_pointer(d_matrix),
        )  # fmt: skip
        result = integrate_motion(V0, omega0, work)
        for n in range(rows.size):
            copy(quantities[rows[n]], out[n, i])
        info[i, 0], info[i, 1], info[i, 2], info[i, 3], info[i, 4] = result
