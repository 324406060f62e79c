"""Motions by hand, and what results of them show."""

import pickle
from math import inf, nan

import numpy as np
import pytest
import tolerances as tol
from calls import COVERED, MANY, PAPER, ROLLER, SERIES, T
from closeness import close
from drives import ROLLER as DRIVEN

import viscoroll as vr
from viscoroll.motion.summaries import Histogram

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


def test_times_of_a_motion():
    """One is the state there, as of an ensemble; those asked for, the steps taken, and others
    later.
    """
    end = PAPER.roll(1.5, 0.5, 2e-3)
    whole = end.course
    assert end.t.tolist() == [2e-3]
    assert (whole.t[0], whole.t[-1], whole.V[-1]) == (0.0, 2e-3, end.V[0])
    assert whole.onset_time in whole.t
    repeated = PAPER.roll(1.5, 0.5, [0.0, 1e-3, 1e-3, 2e-3]).V
    assert (repeated[0], repeated[1], repeated[3]) == (1.5, repeated[2], end.V[0])
    t = np.linspace(0.0, 2e-3, 50)
    assert close(whole.at(t).V, PAPER.roll(1.5, 0.5, t, rtol=1e-12).V, tol.MOTION_DEFAULT)


def test_fields_regimes_and_messages_of_ensembles():
    """Those asked for alone; a regime that was not reached is no full slip."""
    e = PAPER.ensemble(np.linspace(-2.0, 2.0, 5), 0.5, [1e-3, 3e-3], fields="x")
    assert (e.x.shape, len(e), e.V, e.regime) == ((5, 2), 5, None, None)
    cut = PAPER.ensemble([0.0, 1.0, 1.5], 0.5, [0.0, 3e-3], max_steps=8, fields=("V", "regime"))
    assert cut.messages()[vr.MotionStatus.STEP_LIMIT.message] == np.isnan(cut.V[:, -1]).sum() > 0
    regime = cut.to_xarray().regime
    assert regime.values[-1].tolist() == [0, -1]
    assert regime.flag_meanings.split()[0] == "not_reached"
    e = PAPER.ensemble([0.0, 1.0, 1.5], [0.0, 0.5, 0.5], 0.01, rest=0.001)
    assert (e.messages(), e.V.any()) == ({vr.MotionStatus.RESTED.message: 3}, False)


@pytest.mark.parametrize("name", ["slope", "force", "torque", "brake"])
def test_drives_that_do_nothing(name):
    """Zeros, however they are written, leave the bits of free motions; arrays of them count
    motions.
    """
    free = DRIVEN.roll(1.5, 0.5, T)
    for nothing in (0, np.array(0.0)):
        m = DRIVEN.roll(1.5, 0.5, T, **{name: nothing})
        assert (m.V.tolist(), m.steps, any(m.drive.given)) == (free.V.tolist(), free.steps, False)
    e = DRIVEN.ensemble(1.5, 0.5, T, fields=("V", "force"), **{name: [0.0, 0.0]})
    assert (len(e), e.V[1].tolist(), e.force.any()) == (2, free.V.tolist(), False)


def test_what_rests_and_what_sets_out():
    """Rest stays while nothing acts, and ends where a ramp begins; loads of opposite sense that
    friction can carry hold each other.
    """
    m = DRIVEN.roll(0.0, 0.0, T, torque=vr.Schedule([0.0, 4.0, 8.0], [0.0, 0.0, 0.1]))
    assert np.array_equal(m.V > 0.0, T > 4.0)
    assert set(m.regime[T < 4.0]) == {2}
    m = DRIVEN.roll(0.0, 0.0, T, force=-0.1, torque=0.1)
    assert (m.V.any(), set(m.regime)) == (False, {2})
    # a callable that starts at rest does: its polynomials begin with rounding of either sign, a
    # start in full slip the wrong way
    for name, start in (("V", (None, 0.0)), ("omega", (0.0, None))):
        m = DRIVEN.roll(*start, [0.0, 0.5, 1.0], **{name: lambda t: 0.1 * np.sin(t)})
        assert (m.V[0], m.omega[0], m.switches, m.reversals.size) == (0.0, 0.0, (), 0)
    # traction at rest has the sign of what follows: V = -0 at the start of a motion backward
    for torque in (0.1, 0.8):
        on, back = (
            DRIVEN.roll(0.0, 0.0, [0.0, 1e-9, 1.0], torque=each).contact("Q").Q
            for each in (torque, -torque)
        )
        assert on[0] > 0.0
        assert np.array_equal(on, -back)


def test_the_contact_along_a_motion():
    m = PAPER.roll(0.0, 1.0, [0.0, 1e-5, 1e-4, 2e-4, 1e-3])
    assert set(m.regime) == {0, 1}
    assert np.array_equal(m.contact().full_slip, m.regime == 0)
    assert (m.delta[0], m.contact().Q[0]) == (inf, 0.2)


def test_what_results_show():
    # without a threshold nothing stops: V decays to less than doubles hold, and rolls on until
    # there
    m = PAPER.roll(1.5, 0.5, 1.0, force=vr.Schedule([0.0, 0.001, 0.001], [0.1, 0.1, 0.0]))
    assert (m.V[-1], m.switches[-1].regime) == (0.0, "partial slip")
    assert np.isnan(m.rest_time)
    # with a threshold far below the speed at which V decays exponentially, the change to rest is
    # a switch too; delta is 0 there, of a cover too
    for scene in (PAPER, COVERED):
        m = scene.roll(1.0, 1.05, [1e5], rest=1e-20)
        assert (m.switches[-1], m.delta[-1]) == ((m.rest_time, "rest"), 0.0)
    # the stick zone of a locked wheel forms where delta_star(V) has grown to 1: an onset, though
    # the regime stays "locked"
    s = vr.Scene(11.0, 0.13, 0.3, gamma=1.0)
    onset = s.roll(10.0, 0.0, [30.0], brake=100.0).onset_time
    V = s.roll(10.0, 0.0, [onset], brake=100.0).V[0]
    assert close(s.contact(V, delta=0.0).delta_star, 1.0, tol.MOTION_DEFAULT)
    brake = vr.Schedule([0.0, 1.0], [0.0, 3.0])
    assert ROLLER.roll(0.02, 0.1, 1.0, brake=brake).to_xarray().drive_brake_time.units == "s"
    # quantiles of those at rest are zero; of nothing there are none
    many = Histogram.of(np.array([0.0] * 8 + [-1.0, 0.5, 2.0]))
    assert not many.quantiles((0.1, 0.2, 0.5, 0.8)).any()
    assert np.isnan(Histogram.of(np.array([nan])).quantiles((0.5,)))


def test_what_is_pickled_is_what_it_was():
    """Scenes, materials, and results of calls of them."""
    for thing in (PAPER, MANY, vr.Bodies(MANY, SERIES), ROLLER):
        assert pickle.loads(pickle.dumps(thing)) == thing
    for result in (
        PAPER.contact([0.3, 1.0], delta=1e-3),
        PAPER.roll(1.5, 0.5, [1e-5, 1.0]),
        PAPER.ensemble([1.0, 2.0], 0.5, [1e-5, 1.0]),
    ):
        assert pickle.loads(pickle.dumps(result)).to_xarray().identical(result.to_xarray())
