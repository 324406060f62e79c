"""Motions, each with its own start and, where given, its own scene and drive: what Python calls."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.by_reference import data_pointer
from ..compile.jit import kernel
from ..numerics.arrays import copy, fill
from ..rows.record import select_material
from .collocation import WIDE
from .integrate import integrate
from .load import FIRST, RATE, SCALE, START, terms_of
from .nodes import NUMBERS, ONES
from .output import OUTPUTS, asked_by
from .records import Batch, Case, Drive, Gains, Limits, Scene

#: columns of the per-motion information
INFO = ("status", "steps", "switches", "onset_time", "rest_time")


class Drives(NamedTuple):
    """Pieces, (m, k, columns) over t with m one for all or one a motion; gains, (4, 1) or (4, n)."""

    pieces: Any
    gains: Any
    prescribed: int


@kernel
def _own(array, i):
    """The value of motion i."""
    return array[min(i, array.size - 1)]


@kernel
def _drive_of(drives, gamma, i, pieces):
    """The gains of motion i, and its drive in ``pieces``: over tau = gamma t."""
    source = drives.pieces[min(i, drives.pieces.shape[0] - 1)]
    for k in range(pieces.shape[0]):
        copy(source[k], pieces[k])
        pieces[k, START] *= gamma
        pieces[k, SCALE] /= gamma
        terms = terms_of(pieces[k])
        for n in range(RATE * terms, (RATE + 1) * terms):
            pieces[k, FIRST + n] *= 1.0 / gamma
    n, gains = min(i, drives.gains.shape[1] - 1), drives.gains
    return Gains(gains[0, n], gains[1, n], gains[2, n], gains[3, n])


@kernel(allocates=True)
def motion_loop(batch, drives, t, limits, rows, out, info, notes):
    """All motions of a batch; ``rows`` picks output quantities into out[quantity, motion, time].

    Records come as plain tuples: it takes numba microseconds to tell the type of a record.
    """
    motions, drives, limits = Batch(*batch), Drives(*drives), Limits(*limits)
    (paths, acting), (switches, ends) = asked_by(rows), notes
    tau, one, pieces = np.empty(t.size), np.empty((OUTPUTS, t.size)), np.empty(drives.pieces.shape[1:])
    nodes, matrix, second_matrix = np.empty(NUMBERS), np.empty(WIDE * WIDE), np.empty(WIDE * WIDE)
    for i in range(out.shape[1]):
        for row in one:
            fill(np.nan, row)
        for array in (nodes, matrix, second_matrix):
            fill(0.0, array)
        fill(1.0, nodes[ONES : ONES + WIDE])
        select_material(motions.law, i)
        kappa, mu = _own(motions.kappa, i), _own(motions.mu, i)
        gamma, j = _own(motions.gamma, i), _own(motions.j, i)
        for k in range(t.size):
            tau[k] = t[k] * gamma
        scene = Scene(motions.law, motions.unlike, kappa, mu, gamma, j)
        drive = Drive(pieces, _drive_of(drives, gamma, i, pieces), drives.prescribed)
        V0, omega0 = _own(motions.V0, i), _own(motions.omega0, i)
        case = Case(
            scene, drive, limits, tau, one, paths, acting, switches, ends,
            data_pointer(nodes), data_pointer(matrix), data_pointer(second_matrix),
        )  # fmt: skip
        result = integrate(V0, omega0, case)
        for n in range(rows.size):
            copy(one[rows[n]], out[n, i])
        info[i, 0], info[i, 1], info[i, 2], info[i, 3], info[i, 4] = result
