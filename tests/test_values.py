"""Numbers by hand and labels of states: contact, steady rolling, validity."""

import math
import pickle
from math import inf

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
import xarray as xr
from calls import BOTH, FRAME, HEAVY, LABELLED, ONE, PAPER, ROLLER, RUBBER, SOFT, STEEL, pair
from closeness import close
from drives import ON_DMA as DMA_ROLLER

import viscoroll as vr
from viscoroll.contact_mechanics.assumptions import REACH_LIMIT, WAVE_LIMIT, assess_coupling
from viscoroll.contact_mechanics.contact_table import FIELDS, SLOPES
from viscoroll.presets import PAPER_CYLINDER

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


def test_waves():
    """A fifth of sqrt(G/density) in SI; the circumference counts."""
    wave = math.sqrt(2.3e5 / 2.98 / 1130.0)
    assert PAPER_CYLINDER.validity(
        np.array([0.99, 1.01, -1.01]) * WAVE_LIMIT * wave, density=1130.0
    ).quasistatic.holds.tolist() == [True, False, False]
    found = PAPER_CYLINDER.validity(
        0.1 * math.sqrt(230000.0 / 2.98 / 1130.0),
        omega=5.0 * math.sqrt(230000.0 / 2.98 / 1130.0),
        density=1130.0,
    )
    assert close((found.quasistatic.value, found.creep.value), (0.5, 4.0), tol.PAIR)
    assert not PAPER_CYLINDER.validity(0.1, omega=5.0, density=1130.0).creep.holds


def test_validity():
    """Lengths, bodies and waves by hand."""
    rigid = vr.Material.rigid()
    elastic = vr.Material.elastic(1e6, 0.3)
    on_steel = pair(SOFT, STEEL)
    # a parabola is 1 % off the circle where the contact is said to be no longer small
    assert [
        vr.presets.PAPER_SECTION_5.replace(kappa=kappa).validity(V).small_contact.holds
        for kappa, V in ((2.921, 0.0), (2.0, 0.0), (2.0, 30.0))
    ] == [True, False, True]
    assert close((1.0 - math.sqrt(1.0 - REACH_LIMIT**2)) / (0.5 * REACH_LIMIT**2) - 1.0, 0.01, 0.05)
    # 0.5 (G_1 (1 - 2 nu_2) - G_2 (1 - 2 nu_1))/(G_1 (1 - nu_2) + G_2 (1 - nu_1)), of long times
    # and at once
    assert close(
        on_steel.pair.dundurs[0],
        0.5 * (SOFT.G * 0.4 - STEEL.G * 0.02) / (SOFT.G * 0.7 + STEEL.G * 0.51),
        tol.PAIR,
    )
    assert close(
        on_steel.pair.dundurs[1],
        0.5 * (9.0 * SOFT.G * 0.4 - STEEL.G * 0.02) / (9.0 * SOFT.G * 0.7 + STEEL.G * 0.51),
        tol.PAIR,
    )
    assert close(pair(STEEL, SOFT).pair.dundurs, -np.array(on_steel.pair.dundurs), tol.PAIR)
    # its ends: 0 of like bodies, of two incompressible ones, of one on a rigid base; else -(1 - 2
    # nu)/(2 (1 - nu)) there
    assert pair(RUBBER, rigid).pair.dundurs == (0.0, 0.0)
    assert pair(rigid, RUBBER).pair.dundurs == (0.0, 0.0)
    assert pair(RUBBER, vr.Material.elastic(3e7, 0.5)).pair.dundurs == (0.0, 0.0)
    assert pair(SOFT, None).pair.dundurs == (0.0, 0.0)
    assert close(pair(elastic, rigid).pair.dundurs, 2 * (-0.4 / 1.4,), tol.PAIR)
    # plane stress, k = (3 - nu)/(1 + nu): even an incompressible disc on a rigid base is coupled,
    # by -(1 - nu)/2
    assert close(
        pair(vr.Material.elastic(1e6, 0.5), rigid, plane="stress").pair.dundurs,
        (-0.25, -0.25),
        tol.PAIR,
    )
    assert (
        assess_coupling(*pair(elastic, STEEL).pair.dundurs, like=False).value
        == pair(elastic, STEEL).pair.dundurs[0]
    )
    assert not pair(elastic, STEEL, coupled=False).validity(1.0).bodies.holds
    assert PAPER_CYLINDER.validity(1.0).bodies == assess_coupling(0.0, 0.0, like=True)
    # waves: the slowest of those that are known
    assert close(
        [
            pair(*bodies).validity(1.0).quasistatic.value
            for bodies in ((SOFT, None), (SOFT, HEAVY), (HEAVY, SOFT), (SOFT, rigid))
        ],
        np.full(4, 1.0 / math.sqrt(SOFT.G / 1100.0)),
        tol.PAIR,
    )
    assert PAPER_CYLINDER.validity(1.0).quasistatic.holds is None


def test_how_unsteady():
    """Too slow at all, with the speed from which on it is not; at rest."""
    slow = DMA_ROLLER.validity(1.0).steady
    assert (slow.holds, slow.ten_percent.distance, slow.ten_percent.time, slow.share) == (
        False,
        0.0,
        0.0,
        1.0,
    )
    assert close(
        DMA_ROLLER.validity(1.0).steady.ten_percent.speed,
        DMA_ROLLER.validity(30.0).steady.ten_percent.speed,
        tol.STEADINESS,
    )
    assert close(
        PAPER_CYLINDER.validity([1e-4, 8.5e-4, 8.7e-4, 2e-3]).steady.ten_percent.speed,
        [PAPER_CYLINDER.validity(0.3).steady.ten_percent.speed] * 4,
        tol.STEADINESS,
    )  # N passes 0 at 8.6e-4 m/s
    assert (
        DMA_ROLLER.validity([0.0, 0.0]).steady[:2],
        DMA_ROLLER.validity([0.0, 30.0]).steady.value[0],
    ) == ((None, None), 0.0)


def test_labels_of_xarray_and_pandas():
    """What comes in with them goes out with them."""
    for b in BOTH:
        many = b.ensemble(FRAME["V"], FRAME["V"], [0.001, 0.002])
        plain = b.steady(slope=0.0001 * LABELLED.values)
        steady = b.steady(slope=0.0001 * LABELLED)
        of_labels = b.contact(LABELLED, delta=xr.DataArray([0.0, 0.01], dims="creep"))
        of_frame = b.contact(FRAME["V"], delta=FRAME["delta"])
        assert of_labels.M.dims == ("run", "creep")
        assert of_labels.to_xarray()["M"].dims == ("run", "creep")
        assert np.array_equal(of_labels.M.sel(run="b"), b.contact(0.2, delta=[0.0, 0.01]).M)
        assert of_frame.M["y"] == b.contact(0.2, delta=0.01).M
        assert of_frame.to_pandas().index.name == "roller"
        # equilibria
        assert steady.V.dims == ("run", "equilibrium")
        assert np.array_equal(steady.V.sel(run="b"), plain.V[1])
        assert steady.eigenvalues.dims == ("run", "equilibrium", "rate")
        assert steady.loss.slip.dims == ("run", "equilibrium")
        assert b.steady(slope=3.5 * LABELLED).count.sel(run="b").item() == 0
        assert b.steady(slope=0.0001 * FRAME["V"]).V.loc["y", 0] == plain.V[1, 0]
        # ensembles
        assert np.array_equal(many.V, b.ensemble([0.1, 0.2], [0.1, 0.2], [0.001, 0.002]).V)
        assert many.to_xarray().V.sel(motion="y", t=0.002).item() == many.V[1, 1]
        assert many.to_xarray()["motion"].attrs["long_name"] == "roller"
        assert list(
            b.ensemble(
                LABELLED,
                0.0,
                [0.001],
                slope=0.01 * LABELLED,
                force=vr.Schedule([0.0, 1.0], [0.0, 0.0]),
            ).to_xarray()["motion"]
        ) == ["a", "b"]
    assert [
        b.contact(FRAME["V"], delta=FRAME["delta"]).to_pandas()[name]["y"]
        for b, name in zip(BOTH, ("M", "M [N m m-1]"))
    ] == [b.contact(0.2, delta=0.01).M for b in BOTH]
    assert [
        b.ensemble(FRAME["V"], 0.0, 2e-3).to_pandas().loc[("y", 2e-3), name]
        for b, name in zip(BOTH, ("V", "V [m s-1]"))
    ] == [b.ensemble(FRAME["V"], 0.0, 2e-3).V[1, 0] for b in BOTH]


def test_labels_of_arguments_and_results():
    """Labels of arguments and results."""
    # a label with the name of a field or of another axis is renamed; one that repeats an argument
    # is its coordinate
    found = vr.contact(
        ROLLER, pd.Series([0.5, 0.7], index=pd.Index([10, 20], name="Q")), delta=0.01
    ).to_xarray()
    assert (
        (found.Q.values == vr.contact(ROLLER, [0.5, 0.7], delta=0.01).Q).all()
        and [*found.given_Q.values]
    ) == [10, 20]
    found = vr.contact(
        ROLLER, xr.DataArray([0.5, 0.7], dims="r", coords={"V": ("r", [1, 2])}), delta=0.01
    ).to_xarray()
    assert [found.V.values.tolist(), found.given_V.values.tolist()] == [[0.5, 0.7], [1, 2]]
    assert sorted(
        vr.ensemble(
            ROLLER,
            xr.DataArray(
                [0.5, 0.7],
                dims="run",
                coords={"V": ("run", [1, 2]), "t": ("run", [3, 4]), "run": ["a", "b"]},
            ),
            1.0,
            [1.0, 2.0],
        )
        .to_xarray()
        .coords
    ) == ["given_V", "given_t", "motion", "t"]
    # arrays of the roller add axes in front of those with labels
    assert [
        each.dims
        for each in (lambda found: (found.Q, found.to_xarray().Q))(
            vr.contact(ROLLER.replace(mu=[[0.3], [0.4]]), LABELLED, delta=0.1)
        )
    ] == [("state_0", "run")] * 2
    assert [
        each.dims
        for each in (lambda found: (found.V, found.to_xarray().V))(
            vr.steady(ONE.replace(mu=[[0.3], [0.4]]), force=LABELLED / 100.0)
        )
    ] == [("state_0", "run", "equilibrium")] * 2
    # units in the titles of columns
    frame = pd.DataFrame({"t [min]": [0.0, 1.0], "F [N/m]": [1.0, 2.0]})
    assert vr.Schedule(frame["t [min]"], frame["F [N/m]"]).units == {
        "times": "min",
        "values": "N/m",
    }
    assert vr.Feedback(xr.DataArray([1.0, 2.0], name="F [kN/m]")).units == {"value": "kN/m"}
    assert np.array_equal(
        vr.Resistance(
            pd.Series([3.6, 7.2], name="V [km/h]"), pd.Series([1.0, 2.0], name="M [N]")
        ).V,
        np.array([1.0, 2.0]),
    )
    # what has the shape (1,) is that of all motions
    assert {
        name: vr.ensemble(ROLLER, [1.0, 2.0], 10.0, 0.1, **{name: [0.1]})
        .to_xarray()[f"drive_{name}"]
        .shape
        for name in ("force", "torque", "slope", "brake", "drag")
    } == dict.fromkeys(("force", "torque", "slope", "brake", "drag"), ())
    assert [
        vr.ensemble(ROLLER, [1.0, 2.0], 10.0, 0.1, force=load).to_xarray().drive_force.shape
        for load in (
            vr.Feedback([1.0], V=-1.0),
            vr.Schedule([[0.0, 1.0]], [1.0, 2.0]),
            vr.Schedule([0.0], [[1.0]]),
        )
    ] == [(), (2,), (1,)]
    # results with labels can be pickled
    assert [
        pickle.loads(pickle.dumps(vr.contact(ROLLER, each, delta=0.0))).M.equals(
            vr.contact(ROLLER, each, delta=0.0).M
        )
        for each in (FRAME["V"], LABELLED)
    ] == [True, True]


def test_slopes_and_states_at_rest():
    """V = 0: slopes, and a slow rate, (1 + j) V' = -M' V at last, M' = 1 - 1/alpha."""
    at_rest = vr.contact(PAPER, 0.0, delta=0.0, slopes=True)
    held = vr.steady(PAPER, force=-0.2, torque=vr.Feedback(0.5, omega=-1.0))
    elastic = vr.Scene(1.0, 2.91, 0.2)
    assert close((at_rest.dQ_ddelta, at_rest.dM_dV), (4.0 * 2.91, 10.0 / 11.0), 1e-15)
    assert vr.contact(PAPER, 0.0, omega=0.0, slopes=True).dQ_domega == inf
    # one ULP below delta_star, where D is rounded to that of full slip: neither 0/0 nor a slope
    # of partial slip
    s = vr.Scene(8.69, 3.768, 0.052)
    assert (
        vr.contact(
            s, 0.0, delta=np.nextafter(s.contact(0.0, delta=0.0).delta_star, 0.0), slopes=True
        ).dQ_domega
        == 0.0
    )
    assert vr.contact(PAPER, [1.0, -1.0], delta=1.0, slopes=True).dQ_ddelta.tolist() == [0.0, 0.0]
    assert close(vr.steady(PAPER, force=1e-100).V[0], 1.1e-100, tol.STEADY)
    s = vr.steady(PAPER)
    assert (s.V.tolist(), s.omega.tolist(), s.stable.tolist()) == ([0.0], [0.0], [True])
    assert close(vr.steady(PAPER).eigenvalues[0].real, [-inf, -(10.0 / 11.0) / 1.5], tol.STEADY)
    # held by a force of mu, a motor spins at the speed at which its torque is mu; its gain over
    # j, and -M_half_space'
    s = held
    assert (s.V.tolist(), s.Q.tolist(), s.grip.tolist(), s.stable.tolist()) == (
        [0.0],
        [0.2],
        [0.0],
        [True],
    )
    s = held
    assert close(
        (s.omega[0], s.loss.slip[0], *s.eigenvalues[0].real),
        (0.3, 0.06, -1.0 / 0.5, -0.5 * (10.0 / 11.0)),
        tol.STEADY,
    )
    # an elastic cylinder: a motor, a prescribed speed, no humps
    assert close(vr.steady(elastic, torque=vr.Feedback(0.3, omega=-1.0)).V, [0.3], tol.STEADY)
    assert close(vr.steady(elastic, V=1.0, torque=0.1).force, [-0.1], tol.STEADY)
    assert vr.resistance_extrema(elastic).V.size == 0


def test_a_prescribed_speed_finds_the_other_load():
    """Steady: a prescribed speed finds the other load."""
    V = [-0.5, -0.1, 0.0, 0.1, 0.5]
    rolling = vr.steady(PAPER, V=V, torque=0.0)
    pushed = vr.steady(PAPER, V=V, force=0.01)
    down = vr.steady(PAPER, V=0.1, slope=-0.02)
    assert rolling.V[:, 0].tolist() == V
    assert close(rolling.force, rolling.M, tol.STEADY, scale=1.0)
    assert close(rolling.Q, -0.5 * rolling.M, tol.STEADY, scale=1.0)
    assert close(pushed.torque, pushed.M - 0.01, tol.STEADY)
    assert close(down.torque[0], down.M[0] + math.tan(0.02), tol.STEADY)
    assert vr.steady(PAPER, V=0.1, torque=-0.3).count == 0
    # a gain that unsettles rest: M < c V, c = 1 - 1/alpha; the gain alone holds a speed where it
    # is below c
    assert [
        (lambda s: (s.V[0], s.stable[0], s.count))(
            vr.steady(
                PAPER,
                force=vr.Feedback(0.0, V=0.6 * share * 10.0 / 11.0),
                torque=vr.Feedback(0.0, V=0.4 * share * 10.0 / 11.0),
            )
        )
        for share in (0.99, 1.01)
    ] == [(0.0, True, 3), (0.0, False, 1)]


def test_a_cylinder_that_spins_at_rest():
    """A cylinder that spins at rest: force = mu P, and the torque vanishes at omega = -2."""
    assert vr.steady(PAPER, force=0.2, torque=vr.Feedback(-0.1, omega=0.05)).delta.tolist() == [
        vr.contact(PAPER, 0.0, omega=-2.0).delta
    ]
    # loads with labels beside an array of scenes: an axis more, so that no labels are kept
    assert dict(
        vr.steady(
            PAPER.replace(mu=np.array([[0.2], [0.3]])),
            force=xr.DataArray([0.01, 0.02], dims="load"),
        )
        .to_xarray()
        .sizes
    ) == {"state_0": 2, "load": 2, "equilibrium": 2}


def test_fields_that_are_asked_for_and_no_others():
    """Fields that are asked for and no others; broadcasting."""
    many = vr.contact(
        vr.Scene(alpha=[1.0, 2.0, 11.0], kappa=[[2.91], [29.1]], mu=0.2), 0.7, delta=0.001
    ).Q
    two = vr.contact(PAPER, 1.0, delta=0.01, fields=("Q", "M"))
    assert (list(two.as_dict()), {"M", "Q", "plot"} < set(dir(two))) == (["Q", "M"], True)
    assert {
        name: type(value) for name, value in vr.contact(PAPER, 1.0, delta=0.01).as_dict().items()
    } == dict.fromkeys(FIELDS, float) | {"full_slip": bool}
    assert set(vr.contact(PAPER, 1.0, delta=0.01, fields=(), slopes=True).as_dict()) == set(SLOPES)
    assert vr.contact(PAPER, np.array(1.0), delta=np.array([0.01])).full_slip.tolist() == [False]
    assert many.shape == (2, 3)
    assert many[1, 2] == vr.contact(vr.Scene([11.0, 2.0], 29.1, 0.2), 0.7, delta=0.001).Q[0]
