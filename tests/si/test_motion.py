"""Driven motions of a cylinder in SI units."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from refusals import refused

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

ROLLER = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
R, T, P = ROLLER.R, ROLLER.T_ref, ROLLER.load
TIMES = np.linspace(0.0, 2.0, 9)
WORKS = ("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss")


def agree(m, free, load, rel=tol.SI_MOTION):
    """A motion in SI units with a dimensionless one."""
    energy = ROLLER.m * (R / T) ** 2
    units = {"V": R / T, "omega": 1.0 / T, "x": R, "angle": 1.0, "delta": 1.0, "force": load, "torque": load * R}
    units |= dict.fromkeys(WORKS, energy)
    for name, unit in units.items():
        expected = getattr(free, name) * unit
        finite = np.isfinite(expected)
        largest = np.abs(expected[finite]).max(initial=0.0)
        assert close(getattr(m, name)[finite], expected[finite], rel=rel, scale=largest, what=name)
    events, expected = ([*of.t, *of.reversals, *(s.t for s in of.switches)] for of in (m, free))
    assert close(events, np.array(expected) * T, rel=rel)
    assert [s.regime for s in m.switches] == [s.regime for s in free.switches]
    assert np.array_equal(m.regime, free.regime)


def test_a_drag_acts_on_each_of_many_cylinders():
    """Gains over m/s and rad/s, cylinders of their own units: as each rolls alone."""
    loads, drags = np.array([50.0, 200.0, 900.0]), np.array([0.002, 0.0, 0.03])
    rollers = vr.RUBBER_CYLINDER.replace(load=loads, R=np.array([0.05, 0.1, 0.2]))
    drag = vr.Feedback(0.01, V=-0.001, omega=-drags)
    fields = {"V": 0.5, "omega": 5.0, "torque": 0.1}
    e = rollers.ensemble(0.5, 3.0, TIMES, torque=drag, fields=fields)
    for n in range(3):
        alone = vr.RUBBER_CYLINDER.replace(load=loads[n], R=rollers.R[n])
        m = alone.roll(0.5, 3.0, TIMES, torque=vr.Feedback(0.01, V=-0.001, omega=-drags[n]))
        for name, scale in fields.items():
            assert close(getattr(e, name)[n], getattr(m, name), rel=tol.SI_MOTION, scale=scale), (n, name)
    refused(lambda: vr.RUBBER_CYLINDER.roll(0.5, 3.0, TIMES, torque=drag), "drive = of 3 motions", "ensemble")


def test_the_dimensionless_motion_in_other_units():
    """Numbers, schedules, callables, feedback, slope, brake: each over its unit, by hand."""
    down, scene = -0.05, ROLLER.scene()
    load = P * np.cos(down)
    m = ROLLER.roll(
        0.02, 0.1, TIMES, force=vr.Feedback(np.sin, V=-3.0, omega=0.2),
        torque=vr.Schedule([0.5, 1.0, 1.0], [0.0, 4.0, 1.0]), slope=down, brake=vr.Schedule([1.5, 1.5], [0.0, 6.0]),
    )  # fmt: skip
    free = vr.roll(
        scene, 0.02 * T / R, 0.1 * T, TIMES / T, slope=down,
        force=vr.Feedback(lambda t: np.sin(t * T) / load, V=-3.0 * (R / T) / load, omega=0.2 / (T * load)),
        torque=vr.Schedule([0.5 / T, 1.0 / T, 1.0 / T], np.array([0.0, 4.0, 1.0]) / (load * R)),
        brake=vr.Schedule([1.5 / T, 1.5 / T], [0.0, 6.0 / (load * R)]),
    )  # fmt: skip
    agree(m, free, load, tol.SI_TILTED)
    assert np.array_equal(m.t, TIMES)
    assert close(m.scene.kappa, free.scene.kappa, rel=tol.SI_MOTION)
    assert close(m.power_force, m.force * m.V, rel=tol.SI_MOTION)
    assert close(m.contact("Q").Q, free.contact("Q").Q * load, rel=tol.SI_MOTION)


def test_prescribed_speeds_in_other_units():
    m = ROLLER.roll(0.0, None, TIMES, omega=vr.Schedule([0.0, 1.0], [0.0, 0.5]))
    agree(m, vr.roll(ROLLER.scene(), 0.0, None, TIMES / T, omega=vr.Schedule([0.0, 1.0 / T], [0.0, 0.5 * T])), P)
    corners, speeds = np.array([0.0, 1.0, 2.0]), np.array([0.01, 0.03, -0.01])
    m = ROLLER.roll(None, 0.0, TIMES, V=vr.Schedule(corners, speeds), torque=0.5)
    free = vr.roll(
        ROLLER.scene(), None, 0.0, TIMES / T, V=vr.Schedule(corners / T, speeds * T / R), torque=0.5 / (P * R)
    )
    agree(m, free, P)


def test_work_is_energy_and_losses():
    m = ROLLER.roll(0.02, 0.1, TIMES, force=20.0, torque=-2.0, slope=0.02, brake=0.3)
    kinetic = 0.5 * ROLLER.m * (m.V**2 + ROLLER.j * (R * m.omega) ** 2)
    works = m.work_force + m.work_torque
    gained = kinetic - kinetic[0] + m.slip_loss + m.rolling_loss + m.brake_loss
    assert close(works, gained, rel=tol.SI_ENERGY, scale=np.abs(works).max())


def test_the_terminal_speed_is_that_of_steady():
    """A roller that is pressed with more than its weight, and of another material than the base."""
    tread = vr.Material(3e5, 0.49, vr.Prony([0.5, 1.0], [1.0, 0.1]), T_ref=2.0)
    pressed = vr.Cylinder(R=0.1, m=5.0, mu=0.4, material=tread, base=vr.Material.rigid(), load=500.0)
    m = pressed.roll(0.0, 0.0, [50.0], slope=np.radians(1.0))
    slow = pressed.steady(slope=np.radians(1.0))
    assert close(m.V[-1], slow.V[slow.stable][0], rel=tol.SI_TERMINAL)
    assert close(m.force[-1], 500.0 * np.sin(np.radians(1.0)), rel=tol.SI_MOTION)


def test_end_time_and_other_times():
    m = ROLLER.roll(0.02, 0.1, 1.9, torque=1.0)
    assert (m.t[0], m.t[-1]) == (0.0, 1.9)
    again = m.at(m.t)
    assert close(again.V, m.V, rel=tol.SI_MOTION)
    assert np.array_equal(again.torque, m.torque)
    assert (m.message, m.steps > 0, m.drive_error) == ("reached the last output time", True, 0.0)


def test_dataset_in_si(tmp_path):
    brake = vr.Schedule([1.0, 1.0], [0.0, 3.0])
    m = ROLLER.roll(0.02, 0.1, TIMES, torque=2.0, force=np.sin, brake=brake)
    m.to_xarray().to_netcdf(tmp_path / "m.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "m.nc", engine="h5netcdf", decode_times=False) as data:
        for name in ("V", "omega", "x", "angle", "delta", "force", "torque", *WORKS):
            assert np.array_equal(data[name].values, getattr(m, name))
        assert {name: data[name].attrs["units"] for name in ("t", "V", "force", "slip_loss")} == {
            "t": "s", "V": "m s-1", "force": "N m-1", "slip_loss": "J m-1",
        }  # fmt: skip
        assert data["drive_torque"].item() == 2.0
        assert data["drive_brake_time"].values.tolist() == [1.0, 1.0]
        assert data["drive_brake_time"].attrs["units"] == "s"
        assert data["drive_brake"].values.tolist() == [0.0, 3.0]
        assert data.attrs["drive_force"] == "a function of t"
        assert (data.attrs["R"], data.attrs["load"], data.attrs["T_ref"]) == (R, P, T)


def test_a_free_motion_in_si():
    m, free = ROLLER.roll(0.02, 0.1, TIMES), vr.roll(ROLLER.scene(), 0.02 * T / R, 0.1 * T, TIMES / T)
    agree(m, free, P)
    assert "force" not in m.to_xarray()
    rested = ROLLER.roll(0.02, 0.1, 100.0, rest=1e-5)
    assert close(
        rested.rest_time,
        vr.roll(ROLLER.scene(), 0.02 * T / R, 0.1 * T, 100.0 / T, rest=1e-5 * T / R).rest_time * T,
        rel=tol.SI_MOTION,
    )


def test_validity_of_many_compares_with_waves():
    """As of each cylinder at its highest speeds; of many motions over some of them."""
    rubber = vr.Material(E=3e6, nu=0.5, prony=vr.Prony(E=[0.3], tau=[1e-3]), density=1130.0)
    mu, load = np.array([0.2, 0.3]), np.array([300.0, 400.0])
    rollers = vr.Cylinder(R=0.1, m=35.5, material=rubber, mu=mu, load=load)
    found = rollers.ensemble([1.0, 2.0], 0.0, [0.1, 0.2]).validity()
    assert close(found.quasistatic.value, np.array([1.0, 2.0]) / np.sqrt(rubber.G / 1130.0), rel=tol.PAIR)
    for n in range(2):
        one = rollers.replace(mu=mu[n], load=load[n])
        alone = one.validity(1.0 + n, omega=0.0)
        assert close(found.small_contact.value[n], alone.small_contact.value, rel=tol.PAIR)
    assert found.bodies == alone.bodies
    assert found.plane == alone.plane
    many = vr.RUBBER_CYLINDER.replace(mu=np.linspace(0.2, 0.3, 300)).ensemble(1.0, 0.0, 0.1).validity()
    assert many.quasistatic.value.shape == (256,)
    assert many.steady.value.shape == (256,)


def test_retardation_times_of_each():
    """Cylinders of a T_epsilon each are what they are alone."""
    slow, fast = np.array([1e-3, 1e-2, 2e-2]), np.array([1e-3, 1e-3, 5e-3])
    solid = {"R": 0.1, "m": 35.5, "E": 2.3e6, "nu": 0.49, "mu": 0.3}
    many = vr.Cylinder(**solid, T_epsilon=slow, T_sigma=fast)
    assert many.T_ref == 2e-2
    state, e = many.contact(1.0, delta=0.01), many.ensemble(1.0, 0.0, [0.1, 1.0], slope=1e-3)
    for n, (T_epsilon, T_sigma) in enumerate(zip(slow, fast, strict=True)):
        one = vr.Cylinder(**solid, T_epsilon=T_epsilon, T_sigma=T_sigma)
        alone = one.contact(1.0, delta=0.01)
        for name in ("M", "Q", "length", "beta"):
            assert close(getattr(state, name)[n], getattr(alone, name), rel=tol.SI_MOTION, what=name)
        m = one.roll(1.0, 0.0, [0.1, 1.0], slope=1e-3)
        assert close(e.V[n], m.V, rel=tol.SI_ENSEMBLE)
        assert close(e.onset_time[n], m.onset_time, rel=tol.SI_ENSEMBLE)
    assert many == many.replace(T_epsilon=slow.copy())
    refused(lambda: many.replace(T_sigma=5e-3), "T_epsilon = 0.001: must be >= T_sigma = 0.005")
    refused(lambda: many.roll(1.0, 0.0, 1.0), "roll computes one motion, but T_epsilon has shape (3,): use ensemble")
    refused(lambda: many.replace(T_epsilon=slow[:, np.newaxis]), "T_epsilon", "a vector (n,)")
    refused(lambda: many.replace(base=vr.Material.rigid()).scene(), "T_epsilon", "single number")
