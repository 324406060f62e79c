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
from refusals import refused

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
    assert vr.roll(PAPER, 1.5, 0.5, [0.0, 0.0]).omega.tolist() == [0.5, 0.5]
    whole = vr.roll(PAPER, 1.5, 0.5, 0.002).course
    assert np.array_equal(whole.at(whole.t).V, whole.V)
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
    assert np.array_equal(
        vr.ensemble(PAPER, [1.0, 2.0], 0.5, 3e-3, fields="angle").angle,
        vr.ensemble(
            PAPER, [1.0, 2.0], 0.5, 3e-3, fields=("V", "omega", "x", "angle", "delta", "regime")
        ).angle,
    )
    assert np.array_equal(
        vr.ensemble(PAPER, [1.0, 2.0], 0.5, 3e-3).V[:, 0],
        vr.ensemble(PAPER, [1.0, 2.0], 0.5, [0.0, 1e-3, 3e-3]).V[:, -1],
    )
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
    assert vr.Prony.creep([[0.5]], [[1.0]]).slower([1.0, 2.0]).T.tolist() == [[1.0], [2.0]]


def test_drives_that_do_nothing_rest_brake_drag():
    """Zeros, however they are written, leave the bits of free motions; arrays of them count
    motions.
    """
    free = vr.roll(DRIVEN, 1.5, 0.5, T)
    t = np.linspace(0.0, 10.0, 41)
    ramp = vr.Schedule([0.0, 10.0], [0.0, 0.2])
    rubber = vr.presets.RUBBER_ROLLER
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
    # start speeds of n motions are n motions, also of the speed that is prescribed for all of
    # them
    assert np.array_equal(
        vr.ensemble(DRIVEN, np.ones(3), 0.5, T, V=1.0).V,
        np.stack([vr.roll(DRIVEN, 1.0, 0.5, T, V=1.0).V] * 3),
    )
    assert np.array_equal(
        vr.ensemble(DRIVEN, 0.5, np.ones(3), T, omega=1.0).V,
        np.stack([vr.roll(DRIVEN, 0.5, 1.0, T, omega=1.0).V] * 3),
    )
    assert (
        vr.ensemble(DRIVEN, np.ones(3), 0.5, T, V=1.0).V0.shape,
        vr.ensemble(DRIVEN, 0.5, np.ones(3), T, omega=1.0).omega0.shape,
    ) == ((3,), (3,))
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
    # a drag is a torque that grows with omega: the bits of feedback, of a scene, of a cylinder in
    # its units, of each of many
    assert np.array_equal(
        vr.roll(rubber, 2.0, 0.5, [1.0, 5.0], torque=0.01, drag=3e-4).omega,
        vr.roll(rubber, 2.0, 0.5, [1.0, 5.0], torque=vr.Feedback(0.01, omega=-3e-4)).omega,
    )
    coast = ROLLER.roll(2.0, 20.0, 3.0, drag=0.05)
    assert close(coast.torque[-1] / coast.omega[-1], -0.05, tol.SCENE)
    assert np.array_equal(
        vr.ensemble(rubber, 2.0, 0.5, [1.0, 5.0], torque=0.01, drag=[0.0, 3e-4]).V[1],
        vr.roll(rubber, 2.0, 0.5, [1.0, 5.0], torque=0.01, drag=3e-4).V,
    )
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
    # corners do not use up the step limit: 300 of them, at each of which a step ends, and a limit
    # of 100 steps
    m = vr.roll(
        DRIVEN,
        0.1,
        0.1,
        2.99,
        torque=vr.Schedule(np.arange(300) * 0.01, 0.01 * np.sin(np.arange(300) * 0.01)),
        rtol=0.0001,
        max_steps=100,
    )
    assert (m.success, m.steps >= 299) == (True, True)
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
    scene = vr.Scene(material=MANY, kappa=2.91, mu=0.2, gamma=700.0)
    assert [
        len(ROLLER.roll(2.0, 20.0, np.linspace(0.0, 4.0, 5), **drive).plot().axes)
        for drive in ({"brake": 5.0}, {"torque": 0.5})
    ] == [3, 4]
    # speeds that rise by factors have a logarithmic axis
    assert [
        {axes.get_xscale() for axes in ROLLER.contact(V=V, delta=0.0).plot().axes}
        for V in ([1.0, 2.0, 5.0, 10.0], np.linspace(1e-3, 1.0, 50))
    ] == [{"log"}, {"linear"}]
    assert close(states.C_rr, states.M / (ROLLER.load * ROLLER.R), tol.SI_MOTION)
    assert ROLLER.contact(V=1.0, delta=0.0, fields="C_rr").as_dict().keys() == {"C_rr"}
    assert any("coefficient of rolling" in axes.get_ylabel() for axes in states.plot().axes)
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
    # a threshold in m/s is of V and R omega; a speed that is prescribed is no second course of V
    assert (
        refused(lambda: PAPER_CYLINDER.roll(0.0, 0.0, 1.0, brake=-1.0)),
        refused(lambda: PAPER_CYLINDER.roll(0.0, 0.0, 1.0, rtol=1.0)),
    ) == ("brake = -1.0: must be finite and >= 0", "rtol = 1.0: must be a number in [1e-12, 0.01]")
    assert "|V| and R |omega| fell below the rest threshold (" in repr(
        ROLLER.roll(1.0, 0.0, [0.0, 1e4], rest=0.1)
    )
    assert [
        line.split("  ")[1]
        for line in repr(ROLLER.roll(None, 1.0, [0.0, 1.0], V=1.0)).splitlines()[1:]
        if "V  " in line
    ] == ["V", "prescribed V"]
    assert repr(vr.roll(PAPER, 0.0, 0.0, 1e-4)).endswith("(1 step)")
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
    assert [
        PAPER_CYLINDER.roll(0.02, 0.1, 1.0).to_xarray().attrs[name]
        for name in ("R", "load", "T_ref")
    ] == [PAPER_CYLINDER.R, PAPER_CYLINDER.load, PAPER_CYLINDER.T_ref]
    e = PAPER_CYLINDER.replace(mu=[0.2, 0.3]).ensemble(0.02, 0.1, 1.0)
    assert (e.to_xarray()["V"].attrs["units"], e.summary().V_mean.attrs["units"]) == (
        "m s-1",
        "m s-1",
    )
    # and of a material each
    assert np.array_equal(
        vr.ensemble(scene, 1.0, 0.0, 1e-3).to_xarray().relaxation_times.values, MANY.tau
    )
    data = vr.ensemble(
        vr.Scene(material=vr.Bodies(MANY, SERIES, 0.6), kappa=2.91, mu=0.2, gamma=700.0),
        1.0,
        0.0,
        0.001,
    ).to_xarray()
    assert (data.cylinder_relaxation_times.dims, data.share.values.tolist()) == (
        ("motion", "cylinder_mode"),
        [0.6, 0.6],
    )


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


def test_attributes_of_SI_datasets_have_SI_words():
    """Attributes of SI datasets have SI words."""
    assert (
        vr.tables.build(PAPER_CYLINDER, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]).Q.attrs[
            "range"
        ]
        == "[-mu P, mu P]"
    )
    assert (
        PAPER_CYLINDER.contact([0.1, 0.2], delta=0.0).to_xarray().delta.attrs["long_name"]
        == "creepage (omega R - V)/V"
    )
