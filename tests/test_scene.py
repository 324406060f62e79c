"""Scene, Cylinder and the paper's presets."""

from __future__ import annotations

import dataclasses
import math
import pickle

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.presets import PAPER_CYLINDER, PAPER_STARTS, PRESETS

SI = {"R": 0.1, "m": 35.5, "E": 2.3e5, "nu": 0.49, "T_epsilon": 10.7, "T_sigma": 0.97, "mu": 0.2}


def test_the_papers_dimensional_list_gives_its_numbers():
    """Sect. 3.1 and Eq. (4): alpha = 11.031, kappa = 2.9210, gamma = 11231."""
    scene = vr.Cylinder(**SI).scene()
    assert scene == vr.presets.PAPER_SECTION_5
    assert close(scene.alpha, 11.031, rel=5e-4 / 11.0)
    assert close(scene.kappa, 2.9210, rel=5e-5 / 2.9)
    assert close(scene.gamma, 11231.0, rel=0.5 / 11231.0)
    assert (scene.mu, scene.j) == (0.2, 0.5)


def test_eq_4_spelt_out():
    cylinder = vr.Cylinder(**SI)
    P = 35.5 * 9.81
    E_prime = math.pi * 2.3e5 / (1.0 - 0.49**2)
    assert close(cylinder.load, P, rel=tol.SCENE)
    assert close(cylinder.E_prime, E_prime, rel=tol.SCENE)
    assert close(cylinder.l0, math.sqrt(32.0 * 0.1 * P / E_prime), rel=tol.SCENE)
    scene = cylinder.scene()
    assert close(scene.alpha, 10.7 / 0.97, rel=tol.SCENE)
    assert close(scene.kappa, math.sqrt(E_prime * 0.1 / (32.0 * P)), rel=tol.SCENE)
    assert close(scene.gamma, P * 10.7**2 / (35.5 * 0.1), rel=tol.SCENE)


def test_plane_stress():
    """E' = pi E: the factor 1/(1 - nu^2) goes."""
    strain, stress = vr.Cylinder(**SI), vr.Cylinder(**SI, plane="stress")
    assert close(stress.E_prime, math.pi * 2.3e5, rel=tol.SCENE)
    assert close(stress.scene().kappa, strain.scene().kappa * math.sqrt(1.0 - 0.49**2), rel=tol.SCENE)
    assert stress.scene().gamma == strain.scene().gamma


def test_presets():
    """Figs. 2 and 3 use ten times the kappa of Sects. 4 and 5."""
    rounded = vr.presets.PAPER_SECTION_5_ROUNDED
    assert (rounded.alpha, rounded.kappa, rounded.mu, rounded.gamma, rounded.j) == (11.0, 2.91, 0.2, 1.1e4, 0.5)
    assert close(vr.presets.PAPER_FIGURES_2_3.kappa, 10.0 * rounded.kappa, rel=tol.SCENE)
    assert PAPER_CYLINDER.scene() == vr.presets.PAPER_SECTION_5
    assert set(PRESETS) == {"paper-section-5", "paper-section-5-rounded", "paper-figures-2-3", "rubber-roller"}
    assert PAPER_STARTS == {"IC1": (1.5, 0.5), "IC2": (-1.5, 0.5), "IC3": (-1.5, -2.0)}


def test_force_and_torque():
    """Eqs. (20), (21): F = P (Q - M/2), moment P R (Q + M/2); with Eq. (22) they are Newton's law."""
    cylinder = vr.Cylinder(**SI)
    scene, found = cylinder.scene(), cylinder.contact(0.01, omega=0.0995)
    Q, M = found.Q / cylinder.load, found.M / (cylinder.load * cylinder.R)
    # (V - j omega)' = 2 gamma Q, (V + j omega)' = -gamma M per unit of T_epsilon
    acceleration = scene.gamma * (Q - 0.5 * M) * cylinder.R / cylinder.T_epsilon**2
    spin = scene.gamma * (-Q - 0.5 * M) / scene.j / cylinder.T_epsilon**2
    assert close(found.Q - found.M_half_space / cylinder.R, cylinder.m * acceleration, rel=tol.SCENE)
    inertia = scene.j * cylinder.m * cylinder.R**2
    assert close(found.Q * cylinder.R + found.M_cylinder, -inertia * spin, rel=tol.SCENE)


RUBBER = vr.Material(E=2.3e5, nu=0.5, prony=vr.Prony(E=[2.0, 6.0], tau=[1.0, 1e-4]), T_ref=0.3)
HARD = vr.Material(E=1e6, nu=0.5, prony=vr.Prony(E=[4.0, 1.0], tau=[1.0, 1e-2]), T_ref=2.0)
STEEL = vr.Material.elastic(2e11, 0.3)
ROLLER = {"R": 0.1, "m": 35.5, "mu": 0.2}


# --- materials and pairs ---


def test_a_material_in_place_of_the_four_parameters():
    """Of the paper's own the same kappa and gamma to the bit, and its creep; alpha is that of the series."""
    own = vr.Material.sls(*(SI[name] for name in ("E", "nu", "T_epsilon", "T_sigma")))
    cylinder = vr.Cylinder(**ROLLER, material=own)
    scene, paper = cylinder.scene(), vr.presets.PAPER_SECTION_5
    assert scene.material is own.prony
    assert (scene.alpha, scene.kappa, scene.mu, scene.gamma, scene.j) == (
        paper.alpha, paper.kappa, paper.mu, paper.gamma, paper.j,
    )  # fmt: skip
    for name in ("E_prime", "l0", "load", "T_ref"):
        assert getattr(cylinder, name) == getattr(vr.Cylinder(**SI), name)
    assert cylinder.scale["V"] == vr.Cylinder(**SI).scale["V"]
    assert vr.Cylinder(**SI, base=own).scene() == paper  # a base alike changes nothing
    assert vr.Cylinder(*SI.values()) == vr.Cylinder(**SI)


def test_a_given_load():
    """kappa and gamma by P; the weight is made anew where another mass is given, a load is not."""
    pressed = vr.Cylinder(**SI, load=1e3)
    assert pressed.load == 1e3
    assert close(pressed.l0, math.sqrt(32.0 * 0.1 * 1e3 / pressed.E_prime), rel=tol.SCENE)
    assert close(pressed.scene().kappa, 0.1 / pressed.l0, rel=tol.SCENE)
    assert close(pressed.scene().gamma, 1e3 * 10.7**2 / (35.5 * 0.1), rel=tol.SCENE)
    assert vr.Cylinder(**SI, load=35.5 * 9.81).scene() == vr.presets.PAPER_SECTION_5
    assert dataclasses.replace(vr.Cylinder(**SI), m=1.0).load == 9.81
    assert dataclasses.replace(pressed, m=1.0).load == 1e3
    assert dataclasses.replace(pressed, load=5.0).load == 5.0
    assert pickle.loads(pickle.dumps(pressed)) == pressed


def test_moduli_of_a_pair():
    """2/E' = 1/E'_1 + 1/E'_2, and the shares of the compliance: by hand and at the ends."""
    one, other = (math.pi * body.E / (1.0 - body.nu**2) for body in (RUBBER, STEEL))
    pair = vr.Cylinder(**ROLLER, material=RUBBER, base=STEEL)
    assert close(2.0 / pair.E_prime, 1.0 / one + 1.0 / other, rel=tol.SCENE)
    assert close(pair.pair.share, (1.0 / one) / (1.0 / one + 1.0 / other), rel=tol.SCENE)
    swapped = vr.Cylinder(**ROLLER, material=STEEL, base=RUBBER)
    assert swapped.E_prime == pair.E_prime
    assert close(swapped.pair.share + pair.pair.share, 1.0, rel=tol.SCENE)
    on_rigid = vr.Cylinder(**ROLLER, material=RUBBER, base=vr.Material.rigid())
    assert (on_rigid.E_prime, on_rigid.pair.share) == (2.0 * one, 1.0)
    rigid = vr.Cylinder(**ROLLER, material=vr.Material.rigid(), base=RUBBER)
    assert (rigid.E_prime, rigid.pair.share) == (2.0 * one, 0.0)
    for base in (None, RUBBER, dataclasses.replace(RUBBER, name="the same")):
        like = vr.Cylinder(**ROLLER, material=RUBBER, base=base)
        assert (like.E_prime, like.scene().material) == (one, RUBBER.prony)


def test_time_of_a_pair():
    """The cylinder's, or the base's where the cylinder does not relax."""
    for material, base, T in (
        (RUBBER, HARD, 0.3), (HARD, RUBBER, 2.0), (RUBBER, STEEL, 0.3), (STEEL, RUBBER, 0.3),
        (vr.Material.rigid(), HARD, 2.0), (HARD, vr.Material.rigid(), 2.0),
    ):  # fmt: skip
        cylinder = vr.Cylinder(**ROLLER, material=material, base=base)
        assert cylinder.T_ref == T
        assert 1.0 * cylinder.scale["t"] == T
        assert 1.0 / cylinder.scale["V"] == T / 0.1


def test_scene_of_a_pair():
    cylinder = vr.Cylinder(**ROLLER, material=RUBBER, base=HARD)
    scene = cylinder.scene()
    assert scene.material == vr.Bodies(RUBBER.prony, HARD.prony.slower(2.0 / 0.3), cylinder.pair.share)
    assert close(scene.kappa, 0.1 / cylinder.l0, rel=tol.SCENE)
    assert close(scene.gamma, cylinder.load * 0.3**2 / (35.5 * 0.1), rel=tol.SCENE)
    rigid = vr.Cylinder(**ROLLER, material=vr.Material.rigid(), base=HARD).scene().material
    assert rigid == vr.Bodies(vr.Prony.elastic(), HARD.prony, 0.0)


def test_frozen():
    scene = vr.Scene(alpha=[2.0, 3.0], kappa=2.0, mu=0.2)
    with pytest.raises(dataclasses.FrozenInstanceError):
        scene.mu = 0.3
    with pytest.raises(ValueError, match="read-only"):
        scene.alpha[0] = 5.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        vr.Cylinder(**SI).R = 0.2


def test_an_array_given_is_copied():
    alpha = np.array([2.0, 3.0])
    scene = vr.Scene(alpha, 2.0, 0.2)
    alpha[0] = 99.0
    assert scene.alpha[0] == 2.0


def test_equality_and_replace():
    scene = vr.Scene(11, 2.91, 0.2, 1.1e4)
    assert scene == vr.presets.PAPER_SECTION_5_ROUNDED
    assert scene != scene.replace(mu=0.3)
    assert scene.replace(mu=0.3).mu == 0.3
    assert scene != "scene"
    assert vr.Scene([2.0, 3.0], 2.0, 0.2) == vr.Scene(np.array([2.0, 3.0]), 2.0, 0.2)
    assert vr.Scene([2.0, 3.0], 2.0, 0.2) != scene
    assert type(scene.alpha) is float


def test_shape():
    assert vr.presets.PAPER_SECTION_5.shape == ()
    assert vr.Scene([1.0, 2.0, 3.0], [[1.0], [2.0]], 0.2).shape == (2, 3)


def test_limits_that_are_allowed():
    assert close(vr.Cylinder(**(SI | {"nu": 0.5})).E_prime, math.pi * 2.3e5 / 0.75, rel=tol.SCENE)
    assert vr.Cylinder(**(SI | {"T_epsilon": 0.97})).scene().alpha == 1.0
    assert vr.Scene(1.0, 1e-300, 1e-300).alpha == 1.0


def test_the_rubber_roller_is_inside_the_limits_of_steady_rolling():
    """As the paper's cylinder is not."""
    V = np.geomspace(1e-2, 1e3, 20)
    found = vr.presets.RUBBER_ROLLER.validity(V)
    assert found.steady.holds.all()
    assert found.small_contact.holds.all()
    assert not vr.presets.PAPER_SECTION_5.validity(0.5).steady.holds
