"""Measured schedules: time and memory in proportion to their corners; many motions with corners of
their own.
"""

import tracemalloc

import numpy as np
import pytest
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


@pytest.mark.parametrize("name", ["torque", "V"])
def test_motions_with_corners_of_their_own_have_the_bits_of_each_alone(monkeypatch, name):
    """Whatever the number of motions whose pieces are made at a time."""
    random = np.random.default_rng(2)
    times = np.sort(random.uniform(0.0, 9.0, (12, 7)), axis=1)
    values = random.uniform(-0.1, 0.3, (12, 7))
    times[:, 0] = 0.0
    start = (None, 0.2) if name == "V" else (0.3, 0.2)
    alone = [
        vr.roll(ROLLER, *start, [2.0, 8.0], **{name: vr.Schedule(*each)})
        for each in zip(times, values, strict=True)
    ]
    for size in (1, 2_000, drive_functions._BLOCK_BYTES):
        monkeypatch.setattr(drive_functions, "_BLOCK_BYTES", size)
        many = vr.ensemble(ROLLER, *start, [2.0, 8.0], **{name: vr.Schedule(times, values)})
        for field in ("V", "omega", "x"):
            assert np.array_equal(many[field], [one[field] for one in alone]), (size, field)


def test_a_jump_of_one_slow_motion_is_refused_beside_fast_ones():
    """A jump is judged by the speeds of its own motion: 1e-13 is one where the speed is 1e-13."""
    speeds = vr.Schedule(
        [[0.0, 1.0, 2.0], [0.0, 1.0, 1.0]], [[1.0, 2.0, 3.0], [1e-13, 1e-13, 3e-13]]
    )
    refused(lambda: vr.ensemble(ROLLER, None, 0.2, 3.0, V=speeds), "V jumps at t = 1: must be")
