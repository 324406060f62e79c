"""Motions by hand, and what results of them show."""

import math
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
from viscoroll.presets import PAPER_CYLINDER

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


def test_times_of_a_motion():
    """One is the state there, as of an ensemble; those asked for, the steps taken, and others
    later.
    """
    end = vr.roll(PAPER, 1.5, 0.5, 2e-3)
    assert ((end.t.tolist(), vr.ensemble(PAPER, 1.5, 0.5, 2e-3).t.tolist())) == ([2e-3], [2e-3])
    whole = end.course
    assert (whole.t[0], whole.t[-1], whole.V[-1]) == (0.0, 2e-3, end.V[0])
    assert whole.onset_time in whole.t
    assert np.array_equal(
        vr.roll(PAPER, 1.5, 0.5, [0.0, 1e-3, 1e-3, 2e-3]).V,
        np.array([1.5, *[vr.roll(PAPER, 1.5, 0.5, [0.0, 1e-3, 2e-3]).V[1]] * 2, end.V[0]]),
    )
    assert close(
        end.course.at(np.linspace(0.0, 2e-3, 50)).V,
        vr.roll(PAPER, 1.5, 0.5, np.linspace(0.0, 2e-3, 50), rtol=1e-12).V,
        tol.MOTION_DEFAULT,
    )


def test_shapes_fields_regimes_and_messages_of_ensembles():
    """Ensembles: shapes, fields, regimes, messages."""
    V0 = np.linspace(-2.0, 2.0, 5)
    e = vr.ensemble(PAPER, V0, 0.5, [0.001, 0.003])
    assert (
        e.V.shape,
        e.omega.shape,
        e.x.shape,
        e.onset_time.size,
        len(e),
        e.angle,
        e.delta,
        e.regime,
    ) == ((5, 2), (5, 2), (5, 2), 5, 5, None, None, None)
    e = vr.ensemble(PAPER, V0, 0.5, [0.001, 0.003], fields="angle")
    assert (e.V, e.angle.shape) == (None, (5, 2))
    # a regime that was not reached is no full slip
    assert vr.ensemble(
        PAPER, 1.5, 0.5, [0.0, 3e-3], fields="regime", max_steps=8
    ).to_xarray().regime.values.tolist() == [[0, -1]]
    regime = vr.ensemble(PAPER, 1.5, 0.5, 0.003, fields="regime").to_xarray().regime
    assert dict(zip(regime.flag_values.tolist(), regime.flag_meanings.split())) == {
        -1: "not_reached",
        0: "full_slip",
        1: "partial_slip",
        2: "rest",
        3: "locked",
        4: "held",
    }
    e = vr.ensemble(PAPER, [0.0, 1.0, 1.5], [0.0, 0.5, 0.5], 0.003, max_steps=8)
    assert (e.messages()[vr.MotionStatus.STEP_LIMIT.message], np.isnan(e.V[:, -1]).sum()) == (2, 2)
    e = vr.ensemble(PAPER, [0.0, 1.0, 1.5], [0.0, 0.5, 0.5], 0.01, rest=0.001)
    assert (e.messages(), e.V.any()) == ({vr.MotionStatus.RESTED.message: 3}, False)


def test_drives_that_do_nothing_rest_brake_drag():
    """Zeros, however they are written, leave the bits of free motions; arrays of them count
    motions.
    """
    free = vr.roll(DRIVEN, 1.5, 0.5, T)
    t = np.linspace(0.0, 10.0, 41)
    ramp = vr.Schedule([0.0, 10.0], [0.0, 0.2])
    assert [
        (lambda m: (m.V.tolist(), m.steps, any(m.drive.given)))(
            vr.roll(DRIVEN, 1.5, 0.5, T, **nothing)
        )
        for nothing in (
            {"slope": 0.0},
            {"force": np.float32(0.0)},
            {"torque": np.array(0.0)},
            {"brake": 0},
        )
    ] == [(free.V.tolist(), free.steps, False)] * 4
    assert not vr.ensemble(DRIVEN, [0.1, 0.2], 0.1, T, fields="force").force.any()
    assert [
        (lambda e: (len(e), e.V[2].tolist()))(vr.ensemble(DRIVEN, 1.5, 0.5, T, **nothing))
        for nothing in ({"force": np.zeros(3)}, {"slope": [0.0, 0.0, 0.0]}, {"brake": np.zeros(3)})
    ] == [(3, free.V.tolist())] * 3
    # rest stays while nothing acts, and ends where a ramp begins; a push against friction below
    # its limit moves
    m = vr.roll(DRIVEN, 0.0, 0.0, T, torque=vr.Schedule([0.0, 4.0, 4.0, 8.0], [0.0, 0.0, 0.0, 0.1]))
    assert (m.V[T <= 4.0].any(), (m.V[T > 4.0] > 0.0).all(), set(m.regime[T < 4.0])) == (
        False,
        True,
        {2},
    )
    assert (vr.roll(DRIVEN, 0.0, 0.0, T, force=1e-6).V[1:] > 0.0).all()
    m = vr.roll(DRIVEN, 0.0, 0.0, T, force=-0.1, torque=0.1)
    assert (m.V.any(), set(m.regime)) == (False, {2})
    # a brake holds at rest while |f| <= mu and |f + q| <= B, and lets go where the force is more
    assert close(vr.roll(DRIVEN, 0.0, 0.0, t, force=ramp, brake=0.1).switches[0].t, 5.0, 1e-6)
    m = vr.roll(DRIVEN, 0.0, 0.0, t, force=ramp, brake=0.1)
    assert (m.V[m.t < 5.0].any(), m.V[-1] > 0.0) == (False, True)
    # a callable that starts at rest does: its polynomials begin with rounding of either sign, a
    # start in full slip the wrong way
    m = vr.roll(DRIVEN, None, 0.0, [0.0, 0.5, 1.0], V=lambda t: 0.1 * np.sin(t))
    assert (m.V[0], m.omega[0], m.switches, m.reversals.size) == (0.0, 0.0, (), 0)
    m = vr.roll(DRIVEN, 0.0, None, [0.0, 0.5, 1.0], omega=lambda t: 0.1 * np.sin(t))
    assert (m.V[0], m.omega[0], m.switches, m.reversals.size) == (0.0, 0.0, (), 0)
    # traction at rest has the sign of what follows: V = -0 at the start of a motion backward
    assert [
        vr.roll(DRIVEN, 0.0, 0.0, [0.0, 1e-9, 1.0], torque=torque).contact("Q").Q.tolist()
        for torque in (0.1, 0.8)
    ] == [
        (-vr.roll(DRIVEN, 0.0, 0.0, [0.0, 1e-9, 1.0], torque=-torque).contact("Q").Q).tolist()
        for torque in (0.1, 0.8)
    ]
    assert [
        vr.roll(DRIVEN, 0.0, 0.0, [0.0, 1e-9, 1.0], torque=torque).contact("Q").Q[0] > 0.0
        for torque in (0.1, 0.8)
    ] == [True, True]
    # contact along a motion
    m = vr.roll(PAPER, 1.5, 0.5, [0.0, 0.0001, 0.0002, 0.001])
    assert (m.contact().full_slip.tolist(), m.contact().Q[0], (m.regime == 0).tolist()) == (
        [True, True, False, False],
        -0.2,
        [True, True, False, False],
    )
    m = vr.roll(PAPER, 0.0, 1.0, [0.0, 1e-05])
    assert (m.delta[0], m.contact().Q[0]) == (inf, 0.2)


def test_what_results_show():
    """What results show."""
    states = ROLLER.contact(V=[0.1, 1.0], delta=0.0)
    assert [
        len(ROLLER.roll(2.0, 20.0, np.linspace(0.0, 4.0, 5), **drive).plot().axes)
        for drive in ({"brake": 5.0}, {"torque": 0.5})
    ] == [3, 4]
    assert close(states.C_rr, states.M / (ROLLER.load * ROLLER.R), tol.SI_MOTION)
    # without a threshold nothing stops: V decays to less than doubles hold, and rolls on until
    # there
    m = vr.roll(PAPER, 1.5, 0.5, 1.0, force=vr.Schedule([0.0, 0.001, 0.001], [0.1, 0.1, 0.0]))
    assert (m.V[-1], m.switches[-1].regime, math.isnan(m.rest_time), "to rest" in repr(m)) == (
        0.0,
        "partial slip",
        True,
        False,
    )
    # with a threshold far below the speed at which V decays exponentially, the change to rest is
    # a switch too; delta is 0 there, of a cover too
    assert [
        (m.switches[-1].regime, m.switches[-1].t == m.rest_time, m.delta[-1])
        for m in (vr.roll(s, 1.0, 1.05, [1e5], rest=1e-20) for s in (PAPER, COVERED))
    ] == [("rest", True, 0.0)] * 2
    # the stick zone of a locked wheel forms where delta_star(V) has grown to 1: an onset, though
    # the regime stays "locked"
    s = vr.Scene(11.0, 0.13, 0.3, gamma=1.0)
    assert close(
        s.contact(
            s.roll(10.0, 0.0, [s.roll(10.0, 0.0, [30.0], brake=100.0).onset_time], brake=100.0).V[
                0
            ],
            delta=0.0,
        ).delta_star,
        1.0,
        tol.MOTION_DEFAULT,
    )
    # tables of pandas: units in the names of columns, a row each
    assert (
        ROLLER.roll(1.0, 0.0, [0.0, 1.0]).to_pandas().to_csv().splitlines()[0]
        == "t [s],V [m s-1],omega [rad s-1],x [m],angle [rad],delta,regime"
    )
    table = ROLLER.ensemble(
        [1.0, 2.0], 0.0, [0.1, 0.2], torque=vr.Schedule([0.0, 1.0], [0.0, 3.0])
    ).to_pandas()
    assert (table.index.names, len(table)) == (["motion", "t [s]"], 4)
    # datasets in SI units
    assert [
        PAPER_CYLINDER.roll(0.02, 0.1, 1.0, torque=2.0, brake=vr.Schedule([1.0, 1.0], [0.0, 3.0]))
        .to_xarray()[name]
        .attrs["units"]
        for name in ("t", "V", "force", "slip_loss", "drive_brake_time")
    ] == ["s", "m s-1", "N m-1", "J m-1", "s"]


def test_histograms():
    """Quantiles of those at rest are zero; of nothing there are none."""
    none = Histogram.of(np.array([nan]))
    assert (
        Histogram.of(np.array([0.0] * 8 + [-1.0, 0.5, 2.0]))
        .quantiles((0.1, 0.2, 0.5, 0.8))
        .tolist()
        == [0.0] * 4
    )
    assert none.count == 0
    assert np.array_equal(none.quantiles((0.5,)), np.array([nan]), equal_nan=True)


def test_what_is_pickled_is_what_it_was():
    """Scenes, materials, and results of calls of them."""
    assert [
        pickle.loads(pickle.dumps(thing)) == thing
        for thing in (PAPER, vr.presets.RUBBER_ROLLER, MANY, vr.Bodies(MANY, SERIES), ROLLER)
    ] == [True] * 5
    assert [
        pickle.loads(pickle.dumps(result)).to_xarray().identical(result.to_xarray())
        for result in (
            vr.contact(PAPER, [0.3, 1.0], delta=1e-3),
            vr.roll(PAPER, 1.5, 0.5, [1e-5, 1.0]),
            vr.ensemble(PAPER, [1.0, 2.0], 0.5, [1e-5, 1.0]),
        )
    ] == [True] * 3
