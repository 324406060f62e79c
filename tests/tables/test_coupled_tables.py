"""Tables of the coupled solution, and grids: beside the solver, as files, in laws, motions and
steady states.
"""

import ctypes
from functools import cache

import c_code
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from scipy.integrate import solve_ivp

import viscoroll as vr
from viscoroll.contact_mechanics.coupled_pair import CoupledPair
from viscoroll.contact_mechanics.coupled_tables import coupled_law, measure_errors
from viscoroll.laws.law_netcdf import law_as_dataset

ONE = vr.Prony([10.0], [1.0 / 11.0])
BELT = vr.Cover(ONE, nu=0.5, thickness=0.5, on="base")


#: where both ends of a contact slip
BOTH_SLIP = vr.Cover(vr.Prony([1.0, 3.0], [10.0, 0.1]), nu=0.3, thickness=0.5, on="cylinder")


@cache
def law_of(material, mu):
    """A table takes two seconds."""
    return coupled_law(vr.Scene(material=material, kappa=4.0, mu=mu))


@pytest.fixture(scope="module")
def law():
    return law_of(BELT, 0.3)


@pytest.fixture(scope="module")
def scene(law):
    return vr.Scene(material=law, kappa=4.0, mu=0.3, gamma=1.0)


@pytest.mark.parametrize(("material", "mu", "count"), [(BELT, 0.3, 40), (BOTH_SLIP, 0.2, 304)])
def test_table_holds_states_beside_its_nodes(material, mu, count):
    scene = vr.Scene(material=material, kappa=4.0, mu=mu)
    found = measure_errors(law_of(material, mu).coupled, CoupledPair.of_scene(scene), count, 7)
    assert found["Q_over_mu"] < tol.TABLE_Q
    assert found["M_half_space"] + found["M_cylinder"] < tol.TABLE_M
    assert found["epsilon"] < tol.TABLE_EPSILON


def test_file_keeps_every_bit_and_holds_for_one_friction(law, scene, tmp_path):
    vr.tables.save(law_as_dataset(law, {}), tmp_path / "belt.nc")
    read = vr.load_law(tmp_path / "belt.nc")
    states = {"V": np.geomspace(1e-4, 1e3, 50), "delta": np.linspace(-0.1, 0.1, 50)}
    first, again = (
        each.contact(**states, slopes=True) for each in (scene, scene.replace(material=read))
    )
    assert all(np.array_equal(first[name], again[name]) for name in first.keys())  # noqa: SIM118 - no dict
    with pytest.raises(vr.ParameterError, match=r"mu = 0\.2: must be 0\.3"):
        vr.Scene(material=read, kappa=4.0, mu=0.2)


def test_slopes_are_those_of_the_law(scene):
    law = vr.law(scene)
    for u in (1e-5, 1e-3, 0.35, 30.0, 300.0):
        for delta in (-0.0125, 0.0125, 0.03, 0.1):
            V = u / 4.0
            omega = u / 4.0 * (1.0 + delta)
            step = 1e-6 * u
            found = law(V, omega, slopes=True)
            over_V = (law(V + step, omega).Q - law(V - step, omega).Q) / (2.0 * step)
            over_omega = (law(V, omega + step).M - law(V, omega - step).M) / (2.0 * step)
            found = [found.dQ_dV, found.dM_half_space_domega]
            close(found, [over_V, over_omega], tol.TABLE_SLOPE, scale=1.0 + 1.0 / V)


def test_no_sign_of_zero_counts(scene):
    """At V = -0 a table has the sign of V > 0, as laws of rows have: also the law of other code."""
    for omega in (0.1, -0.1, 0.0):
        assert vr.law(scene)(-0.0, omega) == vr.law(scene)(0.0, omega)
        assert scene.contact(-0.0, omega=omega).Q == scene.contact(0.0, omega=omega).Q


def test_free_creepage_is_that_with_stick(scene):
    assert (
        abs(8.0 * scene.contact(1e-6, delta=0.0, fields="delta_0").delta_0 - 0.165) < tol.TABLE_FREE
    )


@pytest.mark.parametrize(
    "start",
    [
        {"V0": 1.0, "omega0": 1.0, "torque": -0.35},
        {"V0": 1.0, "omega0": 1.0, "force": -0.1},
        {"V0": 1.0, "omega0": 0.5},
    ],
    ids=["reversed", "braked", "sliding"],
)
@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
def test_motions_solve_the_equations_and_keep_energy(scene, start):
    law = vr.law(scene)
    force = start.get("force", 0.0)
    torque = start.get("torque", 0.0)

    def rates(t, y):
        loads = law(*y)
        return [loads.Q - loads.M_half_space + force, 2.0 * (torque - loads.Q - loads.M_cylinder)]

    exact = solve_ivp(
        rates, (0.0, 4.0), [start["V0"], start["omega0"]], method="Radau", rtol=1e-9, atol=1e-12
    ).y[:, -1]
    motion = scene.roll(t=np.linspace(0.0, 4.0, 41), **start)
    close(np.array([motion.V[-1], motion.omega[-1]]), exact, tol.TABLE_MOTION)
    losses = motion.slip_loss + motion.rolling_loss
    energy = 0.5 * motion.V**2 + 0.25 * motion.omega**2
    works = np.zeros(41) + force * motion.x + torque * motion.angle
    assert np.abs(energy - energy[0] - works + losses).max() < tol.TABLE_ENERGY * losses[-1]
    assert np.diff(motion.slip_loss).min() >= -tol.TABLE_LOSS * losses[-1]
    assert np.diff(motion.rolling_loss).min() >= 0.0


def test_steady_rolling_is_where_motions_end_and_rest_stays(scene):
    slow = scene.steady(torque=0.03).V[0]
    motion = scene.roll(V0=slow * 0.9, omega0=slow * 0.9, t=[0.0, 400.0], torque=0.03)
    close(motion.V[-1], slow, tol.TABLE_MOTION)
    assert scene.roll(V0=0.0, omega0=0.0, t=[0.0, 1.0], torque=0.0).V[-1] == 0.0
    assert scene.roll(V0=0.0, omega0=0.0, t=[0.0, 1.0], torque=0.1).V[-1] > 0.0


def test_losses_in_slip_of_free_rolling_are_not_below_zero(scene):
    """They are differences of much larger powers there; and V = -0.0 is 0."""
    state = vr.steady(scene, V=np.geomspace(1e-3, 1e3, 40), torque=0.0)
    loss = state.loss
    power = state.force * state.V
    assert (loss.slip >= -tol.BALANCE_OF_STEADY * power).all()
    assert (loss.half_space >= 0.0).all()
    assert close(loss.slip + loss.half_space + loss.cylinder, power, tol.BALANCE_OF_STEADY)
    assert scene.contact([-0.0, 0.0], omega=1e-3).Q.tolist() == [0.3, 0.3]


def test_grids_of_other_programs_roll(tmp_path):
    rows = vr.Scene(material=ONE, kappa=4.0, mu=0.3, gamma=1.0)
    V = vr.tables.spread(1e-4, 10.0, 200, "log")
    vr.tables.save(
        vr.tables.build(rows, V, delta=vr.tables.creep_nodes(rows, V, 401)), tmp_path / "grid.nc"
    )
    grid = vr.Scene(material=vr.load_law(tmp_path / "grid.nc"), kappa=4.0, mu=0.3, gamma=1.0)
    drive = {"V0": 1.0, "omega0": 1.0, "t": [0.0, 5.0, 10.0], "torque": -0.35}
    found = grid.roll(**drive)
    exact = rows.roll(**drive)
    close(np.stack([found.V, found.omega]), np.stack([exact.V, exact.omega]), tol.GRID_MOTION)
    with pytest.raises(vr.ParameterError, match="within the table"):
        grid.roll(V0=100.0, omega0=100.0, t=[0.0, 1.0])
    for V0, torque in ((100.0, 0.0), (9.0, 5.0)):
        with pytest.raises(vr.ParameterError, match="within the table"):
            vr.ensemble(grid, [1.0, V0], [1.0, V0], [0.0, 5.0], torque=torque, fields=["x"])
    with pytest.raises(vr.ParameterError, match="lam"):
        grid.contact(0.1, delta=0.0, fields="lam")
    assert "beta" not in grid.contact(0.1, delta=0.0).as_dict()
    with pytest.raises(vr.ParameterError, match=r"kappa = 12\.0: must be 4, for which the grid"):
        grid.replace(kappa=12.0)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize("omega_over_V", [1.0, 1.2, 0.0, -10.0])
def test_the_slowest_free_motions_are_all_alike(scene, omega_over_V):
    """Where nothing slips in free rolling at rest, the equations are linear at low speed: V/V0 does
    not depend on V0, whether it is found by steps (the first), by steps and the closed form of the
    decay, or by the latter alone (the last); the losses take what kinetic energy has gone.
    """
    t = [1e-3, 1.0, 3.0]
    speeds = (1e-14, 1e-20, 1e-149, 1e-250)
    slow = [scene.roll(V0, omega_over_V * V0, t, rtol=1e-12) for V0 in speeds]
    ratios = np.array(
        [[one.V / V0, one.omega / one.V] for one, V0 in zip(slow, speeds, strict=True)]
    )
    close(ratios, np.broadcast_to(ratios[0], ratios.shape), tol.TABLE_SLOW)
    late = slow[1]
    kinetic = 0.5 * (late.V**2 + scene.j * late.omega**2)
    gone = np.diff(kinetic) + np.diff(late.slip_loss + late.rolling_loss)
    close(gone / kinetic[0], np.zeros(2), tol.TABLE_SLOW, scale=1.0)


def test_a_cover_that_slips_in_free_rolling_stops_at_once_from_the_least_speeds():
    scene = vr.Scene(material=law_of(BOTH_SLIP, 0.2), kappa=4.0, mu=0.2, gamma=1.0)
    for V0 in (1e-20, 1e-200):
        late = scene.roll(V0, V0, [1.0])
        assert late.V[0] == late.omega[0] == 0.0
        assert late.status >= 0


def test_unlike_half_spaces_have_a_table():
    bodies = vr.Bodies(vr.Prony.elastic(), ONE, 0.05, (0.3, 0.3))
    exact = vr.Scene(material=bodies, kappa=4.0, mu=0.3)
    table = exact.replace(material=coupled_law(exact))
    states = {"V": np.array([-0.1, 0.01, 0.1, 1.0]), "delta": np.array([0.02, -0.01, 0.015, 0.0])}
    found = table.contact(**states)
    solved = exact.contact(**states, method="coupled")
    close(found.Q, solved.Q, tol.TABLE_Q, scale=0.3)
    close(4.0 * found.M, 4.0 * solved.M, tol.TABLE_M, scale=1.0)


def test_speeds_beyond_the_nodes_join_the_elastic_limits(law, scene):
    """The table is linear in u below its nodes, in 1/u beyond; both ends are those of elastic
    bodies.
    """
    rows = law.coupled
    for u, row in ((1e-9, 0), (1e12, -1)):
        _, low, high = rows.edges[row, :3]
        state = scene.contact(
            u / 4.0, delta=np.array([low, high]) / 8.0, fields=("Q", "M_half_space")
        )
        close(state.Q, [-0.3, 0.3], tol.TABLE_MOTION)
        close(4.0 * state.M_half_space, rows.fields[row, [0, -1], 1], tol.TABLE_MOTION)


def test_one_cover_takes_its_table_unless_asked_otherwise(law):
    roller = vr.Scene(material=BELT, kappa=4.0, mu=0.3)
    states = {"V": 0.1, "delta": np.linspace(-0.2, 0.2, 9)}
    by_default = roller.contact(**states)
    of_table = vr.Scene(material=law, kappa=4.0, mu=0.3).contact(**states)
    assert np.array_equal(by_default.Q, of_table.Q)
    assert np.abs(by_default.Q - roller.replace(coupled=False).contact(**states).Q).max() > 1e-3


@pytest.mark.parametrize(
    ("change", "tables"),
    [({"material": BELT.of_thickness([0.5, 0.6, 0.7])}, 3), ({"mu": np.array([0.2, 0.3])}, 2)],
)
def test_many_covers_in_one_call_say_what_their_tables_would_take(change, tables):
    many = vr.Scene(material=BELT, kappa=4.0, mu=0.3).replace(**change)
    with pytest.raises(vr.ParameterError, match=f"needs {tables} tables.*coupled=False"):
        many.contact(0.1, delta=0.0)


def test_a_search_that_changes_the_table_is_refused():
    rubber = vr.Material(E=4e6, nu=0.49, prony=ONE, thickness=6e-3)
    roller = vr.Cylinder(
        R=0.08, m=40.0, material=vr.Material.rigid(), base=rubber, mu=0.5, load=2e3
    )
    data = vr.Traction(V=1.0, delta=[-0.01, 0.01], Q=[-500.0, 500.0], sigma=1.0)
    with pytest.raises(vr.ParameterError, match=r"coupled.*mu.*must be False"):
        vr.identify(roller, {"mu": (0.1, 1.0)}, [data])


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


@c_code.needs_cc
def test_header_of_c_gives_the_states_of_the_table(law, scene, tmp_path):
    vr.tables.export(law_as_dataset(law, {}), tmp_path / "belt.h")
    states = c_code.compiled(tmp_path, "belt", C_TABLE).states
    V = np.array([-3.0, -1e-9, -0.0, 0.0, 1e-5, 1e-3, 0.1, 0.3, 7.0, 1e4, 0.2, 0.2])
    slip = V * np.array([0.01, 0.03, 1.0, 1.0, 0.02, -0.01, 0.0, 0.015, 0.5, 0.0, -0.03, 0.02])
    out = np.empty((V.size, 15))
    arrays = [ctypes.c_void_p(each.ctypes.data) for each in (V, slip, out)]
    states(ctypes.c_double(4.0), V.size, *arrays)
    names = ("Q", "M_half_space", "M_cylinder", "lam", "epsilon", "beta", "delta_0", "delta_star")
    found = scene.contact(V, omega=V + slip, fields=names)
    close(out[:, :8], np.stack([found[name] for name in names], axis=-1), tol.TABLE_HEADER)
    moving = V != 0.0
    names = ("dQ_dV", "dQ_domega", "dM_dV", "dM_half_space_dV", "dM_cylinder_dV")
    names += ("dM_half_space_domega", "dM_cylinder_domega")
    found = scene.contact(V[moving], omega=(V + slip)[moving], fields=names)
    for name, slope in zip(names, out[moving, 8:].T, strict=True):
        alone = scene.contact(V[moving], omega=(V + slip)[moving], fields=name)
        assert np.array_equal(alone[name], found[name])
        close(slope, found[name], tol.TABLE_HEADER_SLOPE, what=name)
