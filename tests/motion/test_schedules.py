"""Measured schedules: time and memory in proportion to their corners; many motions with corners of
their own.
"""

import tracemalloc

import numpy as np
import tolerances as tol
from drives import ROLLER
from refusals import refused

import viscoroll as vr
from viscoroll.motion import drive_functions
from viscoroll.motion.motion_arguments import Drive


def pieces_of(drive, end):
    """The pieces of a drive of one motion."""
    functions = drive_functions.prepare_drive(drive, 0.1, 0.1, end, 1e-8).functions
    assert functions is not None
    return functions.pieces


def test_memory_of_a_schedule_is_proportional_to_its_corners():
    count = 50_000
    times = np.arange(count) * 1e-3
    drive = Drive(
        torque=vr.Schedule(times, 0.1 * np.sin(times)), force=vr.Schedule(times + 5e-4, 0.0 * times)
    )
    assert pieces_of(Drive(torque=0.1), 1.0).size  # imports take memory too
    tracemalloc.start()
    pieces = pieces_of(drive, times[-1])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert pieces.shape[1] == 2 * count - 2
    assert peak <= tol.BYTES_A_CORNER * 2 * count


def test_a_jump_of_one_slow_motion_is_refused_beside_fast_ones():
    """A jump is judged by the speeds of its own motion: 1e-13 is one where the speed is 1e-13."""
    speeds = vr.Schedule(
        [[0.0, 1.0, 2.0], [0.0, 1.0, 1.0]], [[1.0, 2.0, 3.0], [1e-13, 1e-13, 3e-13]]
    )
    refused(lambda: vr.ensemble(ROLLER, None, 0.2, 3.0, V=speeds), "V jumps at t = 1: must be")
