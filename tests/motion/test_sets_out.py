"""From rest, or from next to it: faint drives, what a start that counts for nothing does, where
friction is strong.
"""

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import ROLLER

import viscoroll as vr
from viscoroll.presets import PAPER_SECTION_5_ROUNDED as PAPER

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

T = np.linspace(0.0, 2.0, 9)


@pytest.mark.parametrize("faint", [1e-12, 1e-18, 1e-70])
def test_a_faint_drive_moves_as_much_less(faint):
    """At low speed the motion is linear in what drives it: by a push, a ramp, and a ramp that
    begins later.
    """
    for times, values in (([0.0], [1.0]), ([0.0, 2.0], [0.0, 1.0]), ([0.7, 2.0], [0.0, 1.0])):
        drives = (vr.Schedule(times, np.multiply(values, size)) for size in (faint, 1e-9))
        m, plain = (ROLLER.roll(0.0, 0.0, T, torque=torque) for torque in drives)
        assert m.success
        assert close(m.V / faint, plain.V / 1e-9, tol.FAINT)


@pytest.mark.parametrize("creep", [0.0, 1.0, -1.0])
@pytest.mark.parametrize(
    "drive",
    [
        {"force": 0.01},
        {"force": vr.Schedule([1e-3, 1e-3], [0.0, 0.01])},
        {"force": vr.Schedule([0.0, 1e-3], [0.0, 0.01])},
        {"torque": 1.0},
        {"force": 0.01, "brake": 0.1},
    ],
)
def test_a_start_of_next_to_nothing(drive, creep):
    """Under a push, a push to come, a ramp, wheel spin: as from rest.  It ended in steps that were
    too small.
    """
    t = np.array([1e-3, 2e-3, 1e-2])
    plain = PAPER.roll(0.0, 0.0, t, **drive)
    for V0 in (1e-80, 1e-95, 1e-300):
        m = PAPER.roll(V0, creep * V0, t, **drive)
        assert m.success
        fastest = np.abs([plain.V, plain.omega]).max()
        assert close(m.V, plain.V, 30e-8, scale=max(fastest, V0))


def test_to_and_fro_where_friction_is_strong():
    """Jumps of force and torque take V to 0 while d relaxes from nowhere: a tenth ended in steps
    too small.
    """
    scene = vr.Scene(11.0, 0.1, 0.9, 1.0, 0.8)
    draw = np.random.default_rng(5)
    times = np.repeat(np.arange(21.0), 2)[1:-1]
    t = np.linspace(0.0, 20.0, 61)
    sizes = scene.mu * draw.uniform(0.1, 1.3, (2, 60, 20)) * (-1.0) ** np.arange(20)
    force, torque = (vr.Schedule(times, each) for each in np.repeat(sizes, 2, axis=2))
    found, best = (
        scene.ensemble(0.0, 0.0, t, rtol=rtol, force=force, torque=torque) for rtol in (1e-6, 1e-10)
    )
    assert found.success.all()
    assert best.success.all()
    speeds, exact = (np.stack([e.V, e.omega]) for e in (found, best))
    so_far = np.maximum.accumulate(abs(exact).max(axis=0), axis=1)
    assert close(speeds, exact, 30e-6, scale=so_far)


#: mu/(2 kappa), force and slope of omega/gamma over mu: rolls off either way, or one way and slides
#: the other
TWO_WAYS = {
    "stick or stick": (3.778771810004847, -0.929673479743902, 0.09729379653225274),
    "stick or slip": (7.311503140787795, 1.0267483480663373, -0.45373546198415005),
}


@pytest.mark.parametrize("name", TWO_WAYS)
def test_two_ways_on_are_none(name):
    """Where the law lets V go either way it is said so; at mu <= 2 kappa there is one way on."""
    ratio, force, slope = TWO_WAYS[name]
    drive = {"force": force, "omega": vr.Schedule([0.0, 1.0], [0.0, slope])}
    with pytest.warns(RuntimeWarning, match="in either direction"):
        m = vr.Scene(11.0, 0.5 / ratio, 1.0, 1.0).roll(0.0, None, [0.0, 1.0], **drive)
    assert m.status == vr.MotionStatus.UNDECIDED
    assert m.V[0] == 0.0
    assert np.isnan(m.V[1])
    weaker = vr.Scene(11.0, 0.5, 1.0, 1.0).roll(0.0, None, [0.0, 1.0], **drive)
    assert weaker.success
