"""Contact, stresses, ensembles, equilibria and validity of a cylinder in SI units, against the dimensionless calls."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

ROLLER = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
RUBBER = vr.Material(3e6, 0.49, vr.Prony([0.3, 0.6], [2e-2, 1e-3]), name="rubber", density=1130.0)
ON_STEEL = vr.Cylinder(R=0.05, m=9.0, material=RUBBER, base=vr.Material.elastic(2e11, 0.3), mu=0.6, load=2000.0)


@pytest.mark.parametrize("cylinder", [ROLLER, ON_STEEL], ids=["like bodies", "on steel"])
def test_the_state_in_other_units(cylinder):
    """Q over P, moments over P R, speeds over R/T, and ratios as they are; Eqs. (20) and (21)."""
    R, T, P = cylinder.R, cylinder.T_ref, cylinder.load
    V, omega = np.array([-0.2, 0.05, 0.3]), np.array([-2.05 * 0.97, 0.5, 3.1])
    found = cylinder.contact(V, omega=omega, slopes=True)
    bare = vr.contact(cylinder.scene(), V * T / R, omega=omega * T, slopes=True)
    units = {"zeta": T, "Q": P, "M": P * R, "dQ_domega": P * T, "dQ_dV": P * T / R, "dQ_ddelta": P, "dM_dV": P * T}
    for name, value in bare.as_dict().items():
        if not name.endswith("_dV") or name in units:
            expected = value * units.get(name, P * R if name.startswith("M_") else 1.0)
            assert close(getattr(found, name), expected, rel=tol.SI_MOTION, what=name)
    assert close(found.length, bare.lam * cylinder.l0, rel=tol.SI_MOTION)
    assert close(found.M_half_space + found.M_cylinder, found.M, rel=tol.SI_MOTION)


def test_slopes_are_those_of_the_si_law():
    """Central differences in m/s and rad/s."""
    V, omega, h = 0.01, 0.099, 1e-7
    found = ROLLER.contact(V, omega=omega, slopes=True)
    for name, at in (("dQ_dV", (h, 0.0)), ("dQ_domega", (0.0, h))):
        ahead, behind = (ROLLER.contact(V + s * at[0], omega=omega + s * at[1], fields="Q").Q for s in (1.0, -1.0))
        assert close(getattr(found, name), (ahead - behind) / (2.0 * h), rel=tol.SI_SLOPE)
    unsteady = ROLLER.contact(V, omega=omega, fields="N").N
    scene = ROLLER.scene()
    bare = vr.contact(scene, V * ROLLER.T_ref / ROLLER.R, omega=omega * ROLLER.T_ref, fields="N").N
    assert close(unsteady, bare * ROLLER.load * ROLLER.T_ref**2, rel=tol.SI_MOTION)


def test_stresses_hold_load_and_traction():
    """The integrals of p and tau over the contact are P and the traction Q, N per m."""
    state = ON_STEEL.contact(0.3, delta=0.002)
    x = np.linspace(-state.length, state.length, 20001)
    found = ON_STEEL.stress(x, 0.3, delta=0.002)
    assert close(np.trapezoid(found.p, x), ON_STEEL.load, rel=tol.SI_INTEGRAL)
    assert close(np.trapezoid(found.tau, x), state.Q, rel=tol.SI_INTEGRAL)


def test_an_ensemble_in_other_units():
    """Each motion is that of roll; arrays of a cylinder's numbers are a cylinder each."""
    t, mu, load = [0.05, 0.2], np.array([0.2, 0.3, 0.4]), np.array([300.0, 340.0, 380.0])
    many = ROLLER.replace(mu=mu, load=load)
    e = many.ensemble(0.02, 0.1, t, torque=0.5, fields=("V", "omega", "x", "torque", "rolling_loss"))
    for n in range(3):
        m = ROLLER.replace(mu=mu[n], load=load[n]).roll(0.02, 0.1, t, torque=0.5)
        for name in ("V", "omega", "x", "torque", "rolling_loss"):
            assert close(getattr(e, name)[n], getattr(m, name), rel=tol.SI_ENSEMBLE, what=name)
    found = e.to_xarray()
    assert found["V"].attrs["units"] == "m s-1"
    assert e.summary().V_mean.attrs["units"] == "m s-1"
    assert close(e.summary().V_mean.values, e.V.mean(axis=0), rel=tol.MOMENT)
    assert (len(e), e.messages()) == (3, {"reached the last output time": 3})


def test_a_free_ensemble_is_that_of_the_scene():
    e = ROLLER.ensemble([0.01, 0.02], 0.1, 0.5, rest=1e-6)
    bare = vr.ensemble(ROLLER.scene(), np.array([0.01, 0.02]) * 107.0, 1.07, 0.5 / 10.7, rest=1e-6 * 107.0)
    assert close(e.V, bare.V / 107.0, rel=tol.SI_ENSEMBLE)
    assert close(e.onset_time, bare.onset_time * 10.7, rel=tol.SI_ENSEMBLE)


def test_equilibria_balance_in_newtons():
    """On a slope P sin(slope) holds against the moment: force R = M; and arrays of cylinders keep their places."""
    slope = np.radians(0.5)
    s = ON_STEEL.steady(slope=slope)
    assert s.count == 2
    pull = ON_STEEL.load * np.sin(slope)
    assert close(s.force, pull, rel=tol.SI_MOTION)
    assert close(s.M_half_space / ON_STEEL.R - s.Q, pull, rel=tol.SI_TERMINAL)
    assert close(s.Q, -s.M_cylinder / ON_STEEL.R, rel=tol.SI_TERMINAL)
    many = ON_STEEL.replace(mu=np.array([0.5, 0.6])).steady(slope=slope)
    assert close(many.V[1], s.V, rel=tol.SI_MOTION)


def test_speeds_of_validity_are_metres_a_second():
    """Waves: sqrt(G/density); the circumference counts where omega is given."""
    wave = np.sqrt(RUBBER.G / RUBBER.density)
    assert close(ON_STEEL.validity(0.1 * wave).quasistatic.value, 0.1, rel=tol.PAIR)
    fast = ON_STEEL.validity(0.1 * wave, omega=0.5 * wave / ON_STEEL.R)
    assert close(fast.quasistatic.value, 0.5, rel=tol.PAIR)
    assert close(fast.creep.value, 4.0, rel=tol.PAIR)
    assert not fast.creep.holds


def test_arrays_replace_and_refusals():
    radii = np.array([0.05, 0.1])
    many = ROLLER.replace(R=radii)
    for n, R in enumerate(radii):
        one = ROLLER.replace(R=R).contact(0.01, delta=-0.02)
        assert close(many.contact(0.01, delta=-0.02).Q[n], one.Q, rel=tol.SI_MOTION)
    assert many == ROLLER.replace(R=radii.copy())
    assert hash(many) == hash(ROLLER.replace(R=radii.copy()))
    assert ROLLER.replace(nu=0.0) == ROLLER.replace(nu=-0.0)
    assert hash(ROLLER.replace(nu=0.0)) == hash(ROLLER.replace(nu=-0.0))
    assert close(ROLLER.replace(m=70.0).load, 70.0 * 9.81, rel=tol.SCENE)
    assert ROLLER.replace(load=500.0).replace(m=70.0).load == 500.0
    assert ROLLER.replace(material=RUBBER).E is None
    assert ON_STEEL.replace(E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97).material is None


def test_functions_are_the_methods():
    """Of scene and cylinder, with one signature; what is neither is refused by name."""
    for name in ("contact", "stress", "steady", "humps", "law", "roll", "ensemble", "validity"):
        function = getattr(vr, name)
        assert function is getattr(vr.Scene, name) is getattr(vr.Cylinder, name)
        arguments = {"stress": (0.0, 0.1), "steady": (), "humps": (), "law": (), "roll": (0.1, 0.1, 1.0)}
        arguments["ensemble"] = arguments["roll"]
        said = refused(partial(function, "a roller", *arguments.get(name, (0.1,))))
        assert said == f"{name} takes a Scene or a Cylinder, not 'a roller'"
    assert close(ROLLER.humps().V, vr.humps(ROLLER.scene()).V * ROLLER.scale["V"], rel=tol.SI_MOTION)
    law, state = ROLLER.law()(0.01, 0.099, slopes=True), ROLLER.contact(0.01, omega=0.099, slopes=True)
    for name in ("Q", "M", "M_half_space", "dQ_dV", "dQ_domega"):
        assert close(getattr(law, name), state[name], rel=tol.SI_MOTION, what=name)
    assert close(2.0 * law.dM_cylinder_dV, state.dM_dV, rel=tol.SI_MOTION)
