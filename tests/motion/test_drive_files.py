"""Driven motions as datasets and at other times; schedules of many corners; and the threshold
``rest``, which counts once nothing drives any more.
"""

import tracemalloc
from functools import partial

import numpy as np
import tolerances as tol
from closeness import close
from drives import PAPER, ROLLER
from refusals import refused

import viscoroll as vr
from viscoroll.motion import drive_functions
from viscoroll.motion.motion_arguments import Drive

LATE = np.array([0.0, 0.5, 1.0, 5.0, 10.0, 20.0, 22.0, 25.0, 40.0, 80.0])
RAMP = vr.Schedule([0.0, 1.0, 1.0], [0.0, 0.2, 0.0])
ACTING = ("force", "torque", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss")
T = np.linspace(0.0, 4.0, 9)


def test_a_motion_carries_its_drive():
    """In its dataset, whatever kind it is: a number, times and values, a callable, gains; what was
    not given is not there.  Other times keep it.
    """
    drive = {"force": np.cos, "torque": vr.Feedback(RAMP, omega=-0.1), "slope": -0.5}
    m = ROLLER.roll(0.2, 0.0, T, **drive)
    same = ROLLER.roll(0.2, 0.0, 4.0, **drive).at(T)
    data = m.to_xarray()
    for name in ("V", "omega", *ACTING):
        assert np.array_equal(data[name], m[name])
        assert np.array_equal(same[name], m[name])
    assert data.attrs["drive_force"] == "a function of t"
    assert data.attrs["drive_error"] == m.drive_error > 0.0
    ramp = data.drive_torque, data.drive_torque_time
    assert np.array_equal(ramp, [RAMP.values, RAMP.times])
    assert data["drive_torque"].attrs["gain_omega"] == -0.1
    assert data["drive_slope"].item() == -0.5
    assert data.attrs["kappa"] == m.scene.kappa > ROLLER.kappa
    assert np.array_equal(data["reversals"], m.reversals)
    assert m.reversals.size > 0
    assert "drive_brake" not in data


def test_an_ensemble_carries_its_drives():
    steps = vr.Schedule(RAMP.times, [[0.0, 0.2, 0.0], [0.0, 0.1, 0.0]])
    e = ROLLER.ensemble(0.0, 0.0, T, torque=steps, slope=[0.01, 0.02], fields=ACTING)
    data = e.to_xarray()
    assert data["drive_torque"].dims == ("motion", "drive_torque_time")
    assert data["drive_slope"].values.tolist() == [0.01, 0.02]
    assert all(np.array_equal(data[name], e[name]) for name in ACTING)


# --- many corners ---


def test_memory_of_a_schedule_is_proportional_to_its_corners():
    times = np.arange(50_000) * 1e-3
    torque = vr.Schedule(times, 0.1 * np.sin(times))
    drive = Drive(torque=torque, force=vr.Schedule(times + 5e-4, 0.0 * times))
    prepare = partial(drive_functions.prepare_drive, drive, 0.1, 0.1, times[-1], 1e-8, None)
    assert prepare()[0].pieces.size  # imports take memory too
    tracemalloc.start()
    pieces = prepare()[0].pieces
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert pieces.shape[1] == 2 * times.size - 2
    assert peak <= tol.BYTES_A_CORNER * 2 * times.size


def test_a_jump_of_one_slow_motion_is_refused_beside_fast_ones():
    """A jump is judged by the speeds of its own motion: 1e-13 is one where the speed is 1e-13."""
    speeds = vr.Schedule(
        [[0.0, 1.0, 2.0], [0.0, 1.0, 1.0]], [[1.0, 2.0, 3.0], [1e-13, 1e-13, 3e-13]]
    )
    refused(lambda: ROLLER.ensemble(None, 0.2, 3.0, V=speeds), "V jumps at t = 1: must be")


# --- rest ---


def test_a_later_pulse_is_waited_for():
    """Pulses on [0, 1] and [20, 25]: between them V falls to a thousandth of the threshold."""
    push = 0.05 * np.array([0.0, 1.0, 1.0, 0.0])
    pulses = vr.Schedule(np.repeat([0.0, 1.0, 20.0, 25.0], 2), [*push, *push])
    m, whole = (PAPER.roll(0.0, 0.0, LATE, force=pulses, rest=rest) for rest in (1e-3, None))
    assert m.status == vr.MotionStatus.RESTED
    assert m.rest_time > 25.0
    before = m.rest_time > LATE
    assert close(m.V[before], whole.V[before], 30e-8)
    assert not m.V[~before].any()
    assert (20.0 * m.force).tolist() == [1, 1, 0, 0, 0, 1, 1, 0, 0, 0]


def test_force_after_rest_is_what_is_given():
    """A ramp that ends: what the threshold is above all the time ends the motion where the ramp
    does.
    """
    force = vr.Schedule([[0.0, 5.0], [0.0, 2.0]], [[0.004, 0.0], [0.002, 0.0]])
    e = PAPER.ensemble(0.05, 0.05, LATE, force=force, rest=0.045, fields=("V", "force"))
    assert np.array_equal(e.rest_time, [5.0, 2.0])
    assert close(e.force[0], np.interp(LATE, [0.0, 5.0], [0.004, 0.0]), 1e-15, scale=0.004)
    assert not e.V[1, LATE >= 2.0].any()
