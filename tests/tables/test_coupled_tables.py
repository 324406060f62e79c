"""Tables of the coupled solution, and grids: beside the solver, as files, in laws, motions and
steady states.
"""

import ctypes
from functools import cache, partial

import c_code
import numpy as np
import pytest
import tolerances as tol
from calls import RUBBER_COVER, pair
from closeness import close
from drives import solved
from refusals import refused

import viscoroll as vr
from viscoroll import tables
from viscoroll.contact_mechanics.coupled_pair import pair_of_scene
from viscoroll.contact_mechanics.coupled_tables import measure_errors
from viscoroll.laws.law_netcdf import law_as_dataset

ONE = vr.Prony([10.0], [1.0 / 11.0])
BELT = vr.Cover(ONE, nu=0.5, thickness=0.5, on="base")
unwarned = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")

#: where both ends of a contact slip
BOTH_SLIP = vr.Cover(vr.Prony([3.0], [0.1]), nu=0.3, thickness=0.5, on="cylinder")


def scene_of(material, mu=0.3, **more):
    return vr.Scene(material=material, kappa=4.0, mu=mu, gamma=1.0, **more)


@cache
def law_of(material, mu):
    """The table that a scene has unless asked otherwise, which takes two seconds."""
    return scene_of(material, mu).rolling_law


@pytest.fixture(scope="module")
def scene():
    return scene_of(law_of(BELT, 0.3))


@pytest.mark.parametrize("material, mu, count", [(BELT, 0.3, 40), (BOTH_SLIP, 0.2, 80)])
def test_table_holds_states_beside_its_nodes(material, mu, count):
    pair = pair_of_scene(scene_of(material, mu))
    found = measure_errors(law_of(material, mu).coupled, pair, count, 7)
    assert found["Q_over_mu"] < tol.TABLE_Q
    assert found["M_half_space"] + found["M_cylinder"] < tol.TABLE_M
    assert found["epsilon"] < tol.TABLE_EPSILON


def test_file_keeps_every_bit_and_holds_for_one_friction(scene, tmp_path):
    tables.save(law_as_dataset(scene.rolling_law, {}), tmp_path / "belt.nc")
    read = vr.load_law(tmp_path / "belt.nc")
    states = {"V": np.geomspace(1e-4, 1e3, 50), "delta": np.linspace(-0.1, 0.1, 50)}
    first, again = (
        each.contact(**states, slopes=True) for each in (scene, scene.replace(material=read))
    )
    np.testing.assert_equal(first.as_dict(), again.as_dict())
    refused(lambda: scene.replace(material=read, mu=0.2), "mu = 0.2: must be 0.3")


def test_slopes_are_those_of_the_law(scene):
    law = scene.law()
    V = np.array([[1e-5], [1e-3], [0.35], [30.0], [300.0]]) / 4.0
    omega = V * (1.0 + np.array([-0.0125, 0.0125, 0.03, 0.1]))
    step = 4e-6 * V
    found = law(V, omega, slopes=True)
    over_V = (law(V + step, omega).Q - law(V - step, omega).Q) / (2.0 * step)
    over_omega = (law(V, omega + step).M - law(V, omega - step).M) / (2.0 * step)
    alone = scene.contact(V, omega=omega, fields="dM_half_space_domega").dM_half_space_domega
    for slope, exact in (
        (found.dQ_dV, over_V),
        (found.dM_half_space_domega, over_omega),
        (alone, over_omega),
    ):
        assert close(slope, exact, tol.TABLE_SLOPE, scale=1.0 + 1.0 / V)


def test_no_sign_of_zero_counts(scene):
    """At V = -0 a table has the sign of V > 0, as laws of rows have: also the law of other code."""
    law = scene.law()
    for omega in (0.1, -0.1, 0.0):
        assert law(-0.0, omega) == law(0.0, omega)
        assert scene.contact(-0.0, omega=omega).Q == law(0.0, omega).Q


def test_free_creepage_is_that_with_stick(scene):
    slow = scene.contact(1e-6, delta=0.0, fields="delta_0")
    assert abs(8.0 * slow.delta_0 - 0.165) < tol.TABLE_FREE


@pytest.mark.parametrize(
    "omega0, force, torque", [(1.0, 0.0, -0.35), (1.0, -0.1, 0.0), (0.5, 0.0, 0.0)]
)
@unwarned
def test_motions_solve_the_equations_and_keep_energy(scene, omega0, force, torque):
    exact = solved(scene, 1.0, omega0, [4.0], force, torque)
    m = scene.roll(1.0, omega0, np.linspace(0.0, 4.0, 41), force=force, torque=torque)
    assert close((m.V[-1:], m.omega[-1:]), exact, tol.TABLE_MOTION)
    lost = m.slip_loss + m.rolling_loss
    left = 0.5 * m.V**2 + 0.25 * m.omega**2 - force * m.x - torque * m.angle
    assert abs(left - left[0] + lost).max() < tol.TABLE_ENERGY * lost[-1]
    assert np.diff(m.slip_loss).min() >= -tol.TABLE_LOSS * lost[-1]
    assert np.diff(m.rolling_loss).min() >= 0.0


@unwarned
def test_loss_in_slip_up_to_the_onset_of_partial_slip_is_that_of_the_states(scene):
    """By Gauss's rule over states without a table.  The step of a motion passes the onset, and ends
    there.
    """
    onset = scene.roll(2.0, 3.0, 4.0).onset_time
    x, weights = np.polynomial.legendre.leggauss(8)
    m = scene.roll(2.0, 3.0, [*(0.5 * onset * (1.0 + x)), onset, 4.0])
    states = {"V": m.V[:8], "omega": m.omega[:8], "method": "coupled"}
    power = scene_of(BELT).contact(**states, fields="loss_slip").loss_slip
    assert close(m.slip_loss[8], 0.5 * onset * (weights @ power), tol.TABLE_SLIP_LOSS)


def test_steady_rolling_is_where_motions_end_and_rest_stays(scene):
    slow = scene.steady(torque=0.03).V[0]
    motion = scene.roll(slow * 0.9, slow * 0.9, [400.0], torque=0.03)
    assert close(motion.V[-1], slow, tol.TABLE_MOTION)
    rest, starts = (scene.roll(0.0, 0.0, 1.0, torque=torque).V[0] for torque in (0.0, 0.1))
    assert rest == 0.0 < starts


def test_losses_in_slip_of_free_rolling_are_not_below_zero(scene):
    """They are differences of much larger powers there."""
    state = scene.steady(V=np.geomspace(1e-3, 1e3, 40), torque=0.0)
    loss = state.loss
    power = state.force * state.V
    assert (loss.slip >= -tol.BALANCE_OF_STEADY * power).all()
    assert (loss.half_space >= 0.0).all()
    assert close(loss.slip + loss.half_space + loss.cylinder, power, tol.BALANCE_OF_STEADY)


@pytest.mark.long
def test_grids_of_other_programs_roll(tmp_path):
    rows = scene_of(ONE)
    V = tables.spread(1e-4, 10.0, 200, "log")
    made = tables.build(rows, V, delta=[-0.5, *tables.creep_nodes(rows, V, 401)])
    tables.save(made, tmp_path / "grid.nc")
    grid = rows.replace(material=vr.load_law(tmp_path / "grid.nc"))
    found, exact = (each.roll(1.0, 1.0, [0.0, 5.0, 10.0], torque=-0.35) for each in (grid, rows))
    assert close((found.V, found.omega), (exact.V, exact.omega), tol.GRID_MOTION)
    for beyond in (
        lambda: grid.roll(100.0, 100.0, [0.0, 1.0]),
        lambda: grid.ensemble([1.0, 100.0], 1.0, 5.0),
        lambda: grid.ensemble([1.0, 9.0], 9.0, 5.0, torque=5.0),
        lambda: grid.steady(V=100.0, torque=0.0),
    ):
        refused(beyond, "within the table")
    refused(lambda: grid.contact(0.1, delta=0.0, method="coupled"), "material is a grid of Q and M")
    refused(lambda: grid.contact(0.1, delta=0.0, method="direct"), "a material or grid is given")
    most, known = (vr.resistance_extrema(each).M for each in (grid, rows))
    assert close(most, known, tol.GRID_MOTION)
    ends, known = (each.steady(torque=0.05).V for each in (grid, rows))
    assert close(ends, known, tol.GRID_MOTION)
    assert not grid.steady(torque=vr.Feedback(5.0, V=-0.1)).V.size  # 50 is beyond the grid
    assert abs(grid.contact(0.1, delta=0.0).delta_0) < tol.GRID_MOTION
    refused(lambda: grid.replace(kappa=12.0), "kappa = 12.0: must be 4, the R/l0 of the grid")
    refused(lambda: grid.validity(0.1), "the law of this roller is the table or grid given")


@unwarned
@pytest.mark.parametrize("coupled", [True, False])
@pytest.mark.parametrize("omega_over_V", [1.0, 1.2, 0.0, -10.0])
def test_the_slowest_free_motions_are_all_alike(coupled, omega_over_V):
    """Where nothing slips in free rolling at rest, the equations are linear at low speed: V/V0 does
    not depend on V0, whether it is found by steps (the first), by steps and the closed form of the
    decay, or by the latter alone (the last); the losses take what kinetic energy has gone.
    """
    scene = scene_of(BELT, coupled=coupled)
    t = [1e-3, 1.0, 3.0]
    speeds = (1e-14, 1e-20, 1e-149, 1e-250)
    slow = [scene.roll(V0, omega_over_V * V0, t, rtol=1e-12) for V0 in speeds]
    first, *others = ((one.V / V0, one.omega / one.V) for one, V0 in zip(slow, speeds))
    assert all(close(other, first, tol.TABLE_SLOW) for other in others)
    late = slow[1]
    kinetic = 0.5 * (late.V**2 + scene.j * late.omega**2)
    total = kinetic + late.slip_loss + late.rolling_loss
    assert abs(np.diff(total)).max() <= tol.TABLE_SLOW * kinetic[0]


def test_a_cover_that_slips_in_free_rolling_stops_at_once_from_the_least_speeds():
    scene = scene_of(law_of(BOTH_SLIP, 0.2), 0.2)
    for V0 in (1e-20, 1e-200):
        late = scene.roll(V0, V0, [1.0])
        assert late.V[0] == late.omega[0] == 0.0
        assert late.status >= 0


def test_unlike_half_spaces_have_a_table():
    scene = scene_of(vr.Bodies(vr.Prony.elastic(), vr.Prony([1.0], [0.5]), 0.05, (0.3, 0.3)))
    states = {"V": [-0.1, 0.01, 0.1, 1.0], "delta": [0.02, -0.01, 0.015, 0.0]}
    found, truth = (scene.contact(**states, method=way) for way in ("table", "coupled"))
    assert close(found.Q, truth.Q, tol.TABLE_Q, scale=0.3)
    assert close(4.0 * found.M, 4.0 * truth.M, tol.TABLE_M, scale=1.0)
    given = scene.replace(material=scene.rolling_law)
    assert str(given.validity(0.1)) == str(scene.validity(0.1))
    pressure, own = (one.stress(0.0, 0.1, delta=0.02).as_dict() for one in (given, scene))
    assert pressure == own == {"p": own["p"]}
    V, delta = [0.1, 1.0], [-0.02, 0.0, 0.02]
    grid = tables.build(scene, V, delta=delta)
    found = scene.contact(np.transpose([V]), delta=delta)
    assert np.array_equal(grid.M, found.M)
    assert np.array_equal(grid.delta_0, found.delta_0[:, 0])


def test_speeds_beyond_the_nodes_join_the_elastic_limits(scene):
    """The table is linear in u below its nodes, in 1/u beyond; both ends are those of elastic
    bodies.
    """
    rows = scene.rolling_law.coupled
    for u, row in ((1e-9, 0), (1e12, -1)):
        _, low, high = rows.edges[row, :3]
        state = scene.contact(
            u / 4.0, delta=np.array([low, high]) / 8.0, fields=("Q", "M_half_space")
        )
        assert close(state.Q, [-0.3, 0.3], tol.TABLE_MOTION)
        assert close(4.0 * state.M_half_space, rows.fields[row, [0, -1], 1], tol.TABLE_MOTION)


def test_one_cover_takes_its_table_unless_asked_otherwise(scene):
    own = scene.replace(material=BELT)
    states = {"V": 0.1, "delta": np.linspace(-0.2, 0.2, 9)}
    assert np.array_equal(own.contact(**states).Q, scene.contact(**states).Q)
    fast, loaded = (one.replace(coupled=False) for one in (own, scene))
    assert abs(own.contact(**states).Q - fast.contact(**states).Q).max() > 1e-3
    assert np.array_equal(loaded.contact(**states).Q, fast.contact(**states).Q)
    slow = scene.replace(material=fast.rolling_law, coupled=True)
    assert np.array_equal(slow.contact(**states).Q, own.contact(**states).Q)
    assert str(own.validity(0.1)) == str(scene.validity(0.1))


def test_delta_star_is_half_the_distance_of_the_onsets(scene):
    """On either side of free rolling, as the solver has it; their distances from it differ."""
    names = "delta_star", "delta_minus", "delta_plus", "delta_0"
    found = scene.contact(0.1, delta=[-0.03, 0.03], fields=names)
    assert np.array_equal(found.delta_star, 0.5 * (found.delta_plus - found.delta_minus))
    assert abs(found.delta_star - (found.delta_plus - found.delta_0)).max() > 1e-3
    refused(lambda: scene.contact(0.1, delta=0.0, fields="N"), "the added mass N is not known")


def test_many_covers_in_one_call_say_what_their_tables_would_take():
    one = scene_of(BELT)
    covers = one.replace(material=BELT.of_thickness([0.5, 0.6, 0.7]))
    for many, words in (
        (covers, "material (of a layer also R or load)"),
        (one.replace(mu=[0.2, 0.3]), "mu has several values"),
    ):
        refused(partial(many.contact, 0.1, delta=0.0), words, "coupled=False")


def test_a_search_that_changes_the_table_is_refused():
    roller = pair(RUBBER_COVER, vr.Material.rigid())
    data = vr.Traction(V=1.0, delta=[-0.01, 0.01], Q=[-500.0, 500.0], sigma=1.0)
    refused(lambda: vr.identify(roller, {"mu": (0.1, 1.0)}, [data]), "mu", "must be False")


#: evaluates the header of a table at states
C_TABLE = """#include "belt.h"
void states(double kappa, int count, const double *V, const double *slip, double *out) {
  for (int n = 0; n < count; n++) {
    vr_state s = vr_table_contact(&belt, kappa, V[n], slip[n]);
    vr_slopes d = vr_table_slopes(&belt, kappa, V[n], slip[n]);
    double all[] = {s.Q, s.M_half_space, s.M_cylinder, s.lam, s.epsilon, s.beta, s.delta_0,
                    s.delta_star, d.dQ_dV, d.dQ_domega, d.dM_dV, d.dM_half_space_dV,
                    d.dM_cylinder_dV, d.dM_half_space_domega, d.dM_cylinder_domega};
    for (int k = 0; k < 15; k++) out[15 * n + k] = all[k];
  }
}
"""
#: what it writes, in this order
C_FIELDS = "Q M_half_space M_cylinder lam epsilon beta delta_0 delta_star"
C_SLOPES = (
    "dQ_dV dQ_domega dM_dV dM_half_space_dV dM_cylinder_dV dM_half_space_domega dM_cylinder_domega"
)


@c_code.needs_cc
def test_header_of_c_gives_the_states_of_the_table(scene, tmp_path):
    tables.export(law_as_dataset(scene.rolling_law, {}), tmp_path / "belt.h")
    states = c_code.compiled(tmp_path, "belt", C_TABLE).states
    V = np.array([-3.0, -1e-9, -0.0, 0.0, 1e-5, 0.1, 0.3, 7.0, 1e4, 0.2])
    slip = V * np.array([0.01, 0.03, 1.0, 1.0, 0.02, 0.0, 0.015, 0.5, 0.0, -0.03])
    out = np.empty((V.size, 15))
    arrays = [ctypes.c_void_p(each.ctypes.data) for each in (V, slip, out)]
    states(ctypes.c_double(4.0), V.size, *arrays)
    moving = V != 0.0
    for names, some, values, rel in (
        (C_FIELDS, V == V, out[:, :8], tol.TABLE_HEADER),
        (C_SLOPES, moving, out[moving, 8:], tol.TABLE_HEADER_SLOPE),
    ):
        fields = names.split()
        found = scene.contact(V[some], omega=(V + slip)[some], fields=fields)
        for name, value in zip(fields, values.T, strict=True):
            assert close(value, found[name], rel, what=name)
