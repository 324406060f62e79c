"""Where regimes of driven motions end: two events at nearly one time, soon behind the start, at
bends of the law.
"""

import numpy as np
import pytest
from closeness import close
from drives import ROLLER

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

#: errors over rtol: of V and omega over the largest speed so far, and of times of events
BOUND = 30.0
RTOL = 1e-8
ELASTIC = vr.Scene(1.0, 10.0, 0.2, 1.0)


@pytest.mark.parametrize("share", [1e-6, 1e-9, 1e-12])
def test_a_faint_push_the_other_way(share):
    """A ramp that begins on the other side, by a share of what it reaches: V turns at twice the
    time of its zero.
    """
    t = np.linspace(0.0, 8.0, 33)
    plain, m = (
        ROLLER.roll(0.0, 0.0, t, rtol=1e-10, torque=vr.Schedule([0.0, 8.0], [first, 0.2]))
        for first in (0.0, -0.2 * share)
    )
    assert m.success
    assert m.steps <= 3 * plain.steps
    assert close(m.reversals, [16.0 * share], 1e-3)
    assert close(m.V[1:], plain.V[1:], 100.0 * share + BOUND * 1e-10)


def locks_and_holds(m, times, V, omega, bound):
    """The brake locks, then holds, at these times; speeds are those of the closed form."""
    assert [s.regime for s in m.switches] == ["locked", "held"]
    assert close([s.t for s in m.switches], times, BOUND * RTOL)
    assert close(m.V, V, bound, scale=1.0)
    assert close(m.omega, omega, bound, scale=1.0)


@pytest.mark.parametrize("early", [0.02, 0.1, 0.3])
def test_a_brake_locks_just_before_v_is_zero(early):
    """Sliding at V > 0 > omega: omega comes to 0 first, and only then do V and with it the slip
    vanish.

    On one panel both the stop and, beyond it, the end of slip lie between the same two nodes.  An
    elastic cylinder: V' is the force less mu until then, V a parabola; then the brake holds it.
    """
    end = (np.sqrt(0.06) - 0.2) / 0.01  # of V = 1 - 0.2 t - 0.005 t^2
    stop = end - early  # omega' is (mu + brake)/j = 1
    t = np.concatenate(
        [np.linspace(0.0, stop, 9), stop + early * np.array([0.2, 0.5, 0.8]), [end + 1.0]]
    )
    m = ELASTIC.roll(
        1.0, -stop, t, rtol=RTOL, brake=0.3, force=vr.Schedule([0.0, 10.0], [0.0, -0.1])
    )
    V = np.where(t < end, 1.0 - 0.2 * t - 0.005 * t**2, 0.0)
    locks_and_holds(m, [stop, end], V, np.minimum(t - stop, 0.0), BOUND * RTOL * stop)


@pytest.mark.parametrize("pull", [-0.001, 0.001])
def test_a_locked_cylinder_skids_to_rest(pull):
    """Under a force that changes: at alpha = 1 the edge of slip was sought across V = 0, where |V|
    has a kink, and the cylinder crept on with its brake locked."""
    draw = np.random.default_rng(7)
    mu = 0.2
    V0, kappa = 10.0 ** draw.uniform([[-2.0], [-1.0]], [[1.0], [2.0]], (2, 500))
    scene = ELASTIC.replace(kappa=kappa)
    t = np.geomspace(0.01, 100.0, 50)
    force = vr.Schedule([0.0, t[-1]], [0.0, pull * t[-1]])
    e = scene.ensemble(V0, 0.0, t, rtol=RTOL, brake=10.0, force=force, fields=("V", "regime"))
    # of V = V0 - mu t + pull t^2/2
    end = 2.0 * V0 / mu / (1.0 + np.sqrt(1.0 - 2.0 * pull * V0 / mu**2))
    skids = t < end[:, None]
    V = np.where(skids, V0[:, None] - mu * t + 0.5 * pull * t**2, 0.0)
    assert (abs(e.V - V).max(axis=1) <= BOUND * RTOL * V0).all()
    assert (e.regime == np.where(skids, 3, 4)).all()


def test_a_brake_that_begins_at_0():
    """It takes hold as it rises, though it takes nothing where its piece of the drive begins.

    An elastic cylinder that slides at V > 0 > omega: V' is -mu and omega' (mu + brake)/j until the
    brake locks, then V goes on to 0.
    """
    t = np.linspace(0.0, 6.0, 25)
    m = ELASTIC.roll(1.0, -1.0, t, rtol=RTOL, brake=vr.Schedule([0.0, 6.0], [0.0, 1.8]))
    # of omega = -1 + 0.4 t + 0.3 t^2, where the brake takes more than mu
    stop = (np.sqrt(0.34) - 0.2) / 0.3
    omega = np.where(t < stop, -1.0 + 0.4 * t + 0.3 * t**2, 0.0)
    locks_and_holds(m, [stop, 5.0], np.maximum(1.0 - 0.2 * t, 0.0), omega, BOUND * RTOL)


@pytest.mark.parametrize("most", [0.0859, 0.0333, 0.1])
def test_a_brake_gives_way_to_a_ramp(most):
    """What is left of the torque rises from 0: the motion is that of a ramp from 0 without a
    brake.
    """
    scene = vr.Scene(1.0, 15.0, 0.05, 12.0, 0.66)
    ramp = vr.Schedule([0.0, 1.0], [0.0, -0.3])
    since = np.linspace(0.0, 0.6, 13)
    t = most / 0.3 + since
    t[0] *= 0.5  # the brake holds
    m = scene.roll(0.0, 0.0, t, rtol=RTOL, brake=most, torque=ramp)
    plain = scene.roll(0.0, 0.0, since, rtol=RTOL, torque=ramp)
    assert m.success
    assert close((m.V, m.omega), (plain.V, plain.omega), BOUND * RTOL)


def test_a_brake_lets_go_after_what_it_takes_turned():
    """What it takes of the torque changes its sign on the panel on which it lets go: its size has a
    kink there.

    An elastic cylinder skids with omega = 0: the brake takes q + mu = 0.4 t - 0.1 of up to 0.15 -
    0.05 t.
    """
    torque, brake = (vr.Schedule([0.0, 2.0], ends) for ends in ([-0.3, 0.5], [0.15, 0.05]))
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10):
        m = ELASTIC.roll(1.0, 0.0, 2.0, rtol=rtol, torque=torque, brake=brake)
        assert m.switches[0].regime == "full slip"
        assert close(m.switches[0].t, 0.25 / 0.45, BOUND * rtol)


@pytest.mark.parametrize("rtol", [1e-3, 1e-8, 1e-12])
@pytest.mark.parametrize(
    "values, turns", [([1, 0, -1], [1.0]), ([1, 0, 0, -1], [2.0]), ([1, 0, 0, 1], [])]
)
def test_a_prescribed_speed_that_comes_to_0(values, turns, rtol):
    """What its integration leaves of it is 0: the other speed comes to rest too; V turns where it
    leaves 0 the other way, not where it comes to 0 with a piece of the drive.
    """
    scene = vr.Scene(11.0, 10.0, 0.05, 1.0)
    V = vr.Schedule(np.arange(len(values)), values)
    t = np.linspace(0.0, V.times[-1], 17)
    m = scene.roll(None, -2.0, t, rtol=rtol, V=V, torque=-0.051)
    assert m.reversals.tolist() == turns
    assert close(m.V, np.interp(t, V.times, V.values), BOUND * rtol, scale=1.0)
    # sliding at V = 0 it spins down by 0.1 a unit of time
    stands = vr.Schedule([0.0, 1.0, 3.0, 4.0], [1.0, 0.0, 0.0, values[-1]])
    still = scene.roll(None, -0.1, [2.6, 2.9, 4.0], rtol=rtol, V=stands)
    assert (still.success, *still.omega[:2]) == (True, 0.0, 0.0)


def test_a_brake_that_just_holds_a_slope():
    """Both sides of the equality are rounded, each in its way: equality is rest."""
    roller = vr.presets.RUBBER_CYLINDER
    slope = np.linspace(0.002, 0.28, 40)
    brake = roller.load * np.sin(slope) * roller.R
    held = roller.ensemble(0.0, 0.0, 1.0, slope=slope, brake=brake, fields=("V", "regime"))
    assert not held.V.any()
    assert (held.regime == 4).all()


@pytest.mark.parametrize("share", [0.3, 1.0, 1.7])
def test_a_force_or_torque_above_the_brake_by_rounding_is_held_and_beyond_it_creeps(share):
    scene = vr.Scene(material=vr.Prony([2.0, 6.0], [1.0, 0.01]), kappa=10.0, mu=0.3, gamma=0.5)
    brake = 0.15
    for ulps in (-1, 0, 1, 2, 100, 1e6):
        pull = brake * (1.0 + ulps * 2.0**-52)
        moved = scene.roll(
            0.0, 0.0, [1.0], force=share * brake, torque=pull - share * brake, brake=brake
        )
        assert moved.status == 0
        assert moved.V[0] == 0.0 if ulps < 10 else 0.0 < moved.V[0] < 2.0 * ulps * 2.0**-52
