"""The threshold ``rest`` under drives: it counts once nothing drives any more."""

import numpy as np
from closeness import close

import viscoroll as vr

SCENE = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.0, j=0.5)
T = np.array([0.0, 0.5, 1.0, 5.0, 10.0, 20.0, 22.0, 25.0, 40.0, 80.0])


def test_a_later_pulse_is_waited_for():
    """Pulses on [0, 1] and [20, 25]: between them V falls to a thousandth of the threshold."""
    pulses = vr.Schedule(
        [0.0, 0.0, 1.0, 1.0, 20.0, 20.0, 25.0, 25.0], [0.0, 0.05, 0.05, 0.0, 0.0, 0.05, 0.05, 0.0]
    )
    m, whole = (vr.roll(SCENE, 0.0, 0.0, T, force=pulses, rest=rest) for rest in (1e-3, None))
    assert m.status == vr.MotionStatus.RESTED
    assert m.rest_time > 25.0
    before = m.rest_time > T
    assert close(m.V[before], whole.V[before], 30e-8)
    assert not m.V[~before].any()
    assert np.array_equal(m.force, np.where((T < 1.0) | ((T >= 20.0) & (T < 25.0)), 0.05, 0.0))
    assert m.switches[-1] == (m.rest_time, "rest")


def test_force_after_rest_is_what_is_given():
    """A ramp that ends: what the threshold is above all the time ends the motion where the ramp
    does.
    """
    ramp = vr.Schedule([0.0, 5.0], [0.004, 0.0])
    m = vr.roll(SCENE, 0.05, 0.05, T, force=ramp, rest=0.045)
    assert m.rest_time == 5.0
    assert close(m.force, np.interp(T, ramp.times, ramp.values), 1e-15, scale=0.004)
    force = vr.Schedule([[0.0, 5.0], [0.0, 2.0]], [[0.004, 0.0], [0.002, 0.0]])
    e = vr.ensemble(SCENE, 0.05, 0.05, T, force=force, rest=0.045, fields=("V", "force"))
    assert np.array_equal(e.rest_time, [5.0, 2.0])
    assert np.array_equal(e.force[0], m.force)
    assert not e.V[1, T >= 2.0].any()
