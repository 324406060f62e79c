"""Numbers by hand and labels of states: contact, steady rolling, validity."""

import math
from math import inf

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from calls import BOTH, FRAME, HEAVY, LABELLED, PAPER, RUBBER, SOFT, STEEL, pair
from closeness import close

import viscoroll as vr
from viscoroll.contact_mechanics.assumptions import REACH_LIMIT, WAVE_LIMIT
from viscoroll.presets import PAPER_CYLINDER

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


def test_waves():
    """A fifth of sqrt(G/density) in SI; the circumference counts."""
    wave = math.sqrt(2.3e5 / 2.98 / 1130.0)
    beside = np.array([0.99, 1.01, -1.01]) * WAVE_LIMIT * wave
    found = PAPER_CYLINDER.validity(beside, density=1130.0)
    assert found.quasistatic.holds.tolist() == [True, False, False]
    found = PAPER_CYLINDER.validity(0.1 * wave, omega=5.0 * wave, density=1130.0)
    assert close((found.quasistatic.value, found.creep.value), (0.5, 4.0), tol.PAIR)
    assert not found.creep.holds


def test_validity():
    """Lengths, bodies and waves by hand."""
    rigid = vr.Material.rigid()
    elastic = vr.Material.elastic(1e6, 0.3)
    on_steel = pair(SOFT, STEEL)
    # a parabola is 1 % off the circle where the contact is said to be no longer small
    for kappa, V, holds in ((2.921, 0.0, True), (2.0, 0.0, False), (2.0, 30.0, True)):
        found = vr.presets.PAPER_SECTION_5.replace(kappa=kappa).validity(V)
        assert found.small_contact.holds == holds
    assert close((1.0 - math.sqrt(1.0 - REACH_LIMIT**2)) / (0.5 * REACH_LIMIT**2) - 1.0, 0.01, 0.05)
    # 0.5 (G_1 (1 - 2 nu_2) - G_2 (1 - 2 nu_1))/(G_1 (1 - nu_2) + G_2 (1 - nu_1)), of long times
    # and at once
    G = SOFT.G * np.array([1.0, 9.0])
    known = 0.5 * (G * 0.4 - STEEL.G * 0.02) / (G * 0.7 + STEEL.G * 0.51)
    assert close(on_steel.pair.dundurs, known, tol.PAIR)
    assert close(pair(STEEL, SOFT).pair.dundurs, -known, tol.PAIR)
    # of one on a rigid base
    assert pair(RUBBER, rigid).pair.dundurs == (0.0, 0.0)
    assert close(pair(elastic, rigid).pair.dundurs, 2 * (-0.4 / 1.4,), tol.PAIR)
    # plane stress, k = (3 - nu)/(1 + nu): even an incompressible disc on a rigid base is coupled,
    # by -(1 - nu)/2
    disc = pair(vr.Material.elastic(1e6, 0.5), rigid, plane="stress")
    assert close(disc.pair.dundurs, (-0.25, -0.25), tol.PAIR)
    # waves: the slowest of those that are known
    for bodies in ((SOFT, None), (SOFT, HEAVY), (HEAVY, SOFT), (SOFT, rigid)):
        slowest = pair(*bodies).validity(1.0).quasistatic.value
        assert close(slowest, 1.0 / math.sqrt(SOFT.G / 1100.0), tol.PAIR)


def test_labels_of_xarray_and_pandas():
    """What comes in with them goes out with them."""
    for b in BOTH:
        plain = b.steady(slope=0.0001 * LABELLED.values)
        steady = b.steady(slope=0.0001 * LABELLED)
        of_labels = b.contact(LABELLED, delta=xr.DataArray([0.0, 0.01], dims="creep"))
        of_frame = b.contact(FRAME["V"], delta=FRAME["delta"])
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
        force = vr.Schedule([0.0, 1.0], [0.0, 0.0])
        motions = b.ensemble(LABELLED, 0.0, [0.001], slope=0.01 * LABELLED, force=force)
        assert [*motions.to_xarray()["motion"]] == ["a", "b"]


def test_slopes_and_states_at_rest():
    """V = 0: slopes, and a slow rate, (1 + j) V' = -M' V at last, M' = 1 - 1/alpha."""
    at_rest = PAPER.contact(0.0, delta=0.0, slopes=True)
    elastic = vr.Scene(1.0, 2.91, 0.2)
    assert close((at_rest.dQ_ddelta, at_rest.dM_dV), (4.0 * 2.91, 10.0 / 11.0), 1e-15)
    assert PAPER.contact(0.0, omega=0.0, slopes=True).dQ_domega == inf
    # one ULP below delta_star, where D is rounded to that of full slip: neither 0/0 nor a slope
    # of partial slip
    s = vr.Scene(8.69, 3.768, 0.052)
    below = np.nextafter(s.contact(0.0, delta=0.0).delta_star, 0.0)
    assert s.contact(0.0, delta=below, slopes=True).dQ_domega == 0.0
    assert PAPER.contact([1.0, -1.0], delta=1.0, slopes=True).dQ_ddelta.tolist() == [0.0, 0.0]
    assert close(PAPER.steady(force=1e-100).V[0], 1.1e-100, tol.STEADY)
    s = PAPER.steady()
    assert [*s.V, *s.omega, *s.stable] == [0.0, 0.0, True]
    assert close(s.eigenvalues[0].real, [-inf, -(10.0 / 11.0) / 1.5], tol.STEADY)
    # held by a force of mu, a motor spins at the speed at which its torque is mu; its gain over
    # j, and -M_half_space'
    s = PAPER.steady(force=-0.2, torque=vr.Feedback(0.5, omega=-1.0))
    assert [*s.V, *s.Q, *s.grip, *s.stable] == [0.0, 0.2, 0.0, True]
    assert close(
        (s.omega[0], s.loss.slip[0], *s.eigenvalues[0].real),
        (0.3, 0.06, -1.0 / 0.5, -0.5 * (10.0 / 11.0)),
        tol.STEADY,
    )
    # an elastic cylinder: a motor, a prescribed speed, no humps
    assert close(elastic.steady(torque=vr.Feedback(0.3, omega=-1.0)).V, [0.3], tol.STEADY)
    assert close(elastic.steady(V=1.0, torque=0.1).force, [-0.1], tol.STEADY)
    assert elastic.resistance_extrema().V.size == 0


def test_a_prescribed_speed_finds_the_other_load():
    """Steady: a prescribed speed finds the other load."""
    V = [-0.5, -0.1, 0.0, 0.1, 0.5]
    rolling = PAPER.steady(V=V, torque=0.0)
    pushed = PAPER.steady(V=V, force=0.01)
    down = PAPER.steady(V=0.1, slope=-0.02)
    assert rolling.V[:, 0].tolist() == V
    assert close(rolling.force, rolling.M, tol.STEADY, scale=1.0)
    assert close(rolling.Q, -0.5 * rolling.M, tol.STEADY, scale=1.0)
    assert close(pushed.torque, pushed.M - 0.01, tol.STEADY)
    assert close(down.torque[0], down.M[0] + math.tan(0.02), tol.STEADY)
    assert PAPER.steady(V=0.1, torque=-0.3).count == 0
    # a gain that unsettles rest: M < c V, c = 1 - 1/alpha; the gain alone holds a speed where it
    # is below c
    for share, stable, count in ((0.99, True, 3), (1.01, False, 1)):
        force, torque = (vr.Feedback(0.0, V=part * share / 1.1) for part in (0.6, 0.4))
        s = PAPER.steady(force=force, torque=torque)
        assert (s.V[0], s.stable[0], s.count) == (0.0, stable, count)
