"""Scene, Cylinder and the paper's presets."""

import dataclasses
import math

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
    assert scene == vr.presets.PAPER_SECTION_5 == PAPER_CYLINDER.scene()
    assert (f"{scene.alpha:.5}", f"{scene.kappa:.5}", f"{scene.gamma:.5}") == ("11.031", "2.921", "1.1231e+04")
    assert (scene.mu, scene.j) == (0.2, 0.5)


def test_eq_4_spelt_out():
    cylinder = vr.Cylinder(**SI)
    P = 35.5 * 9.81
    E_prime = math.pi * 2.3e5 / (1.0 - 0.49**2)
    found = cylinder.load, cylinder.E_prime, cylinder.l0
    assert close(found, (P, E_prime, math.sqrt(32.0 * 0.1 * P / E_prime)), tol.SCENE)
    scene = cylinder.scene()
    assert close(scene.alpha, 10.7 / 0.97, tol.SCENE)
    assert close(scene.kappa, math.sqrt(E_prime * 0.1 / (32.0 * P)), tol.SCENE)
    assert close(scene.gamma, P * 10.7**2 / (35.5 * 0.1), tol.SCENE)


def test_presets():
    """Figs. 2 and 3 use ten times the kappa of Sects. 4 and 5."""
    rounded = vr.presets.PAPER_SECTION_5_ROUNDED
    assert (rounded.alpha, rounded.kappa, rounded.mu, rounded.gamma, rounded.j) == (11.0, 2.91, 0.2, 1.1e4, 0.5)
    assert close(vr.presets.PAPER_FIGURES_2_3.kappa, 10.0 * rounded.kappa, tol.SCENE)
    assert set(PRESETS) == {"paper-section-5", "paper-section-5-rounded", "paper-figures-2-3", "rubber-roller"}
    assert PAPER_STARTS == {"IC1": (1.5, 0.5), "IC2": (-1.5, 0.5), "IC3": (-1.5, -2.0)}


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
    for name in ("alpha", "kappa", "mu", "gamma", "j"):
        assert getattr(scene, name) == getattr(paper, name)
    for name in ("E_prime", "l0", "load", "T_ref"):
        assert getattr(cylinder, name) == getattr(PAPER_CYLINDER, name)
    assert vr.Cylinder(**SI, base=own).scene() == paper  # a base alike changes nothing
    assert vr.Cylinder(*SI.values()) == vr.Cylinder(**SI)


def test_a_given_load():
    """kappa and gamma by P; the weight is made anew where another mass is given, a load is not."""
    pressed = vr.Cylinder(**SI, load=1e3)
    assert pressed.load == 1e3
    assert close(pressed.scene().kappa, math.sqrt(0.1 * pressed.E_prime / 32e3), tol.SCENE)
    assert close(pressed.scene().gamma, 1e3 * 10.7**2 / (35.5 * 0.1), tol.SCENE)
    assert vr.Cylinder(**SI, load=35.5 * 9.81).scene() == vr.presets.PAPER_SECTION_5
    assert dataclasses.replace(vr.Cylinder(**SI), m=1.0).load == 9.81
    assert dataclasses.replace(pressed, m=1.0).load == 1e3


def test_moduli_of_a_pair():
    """2/E' = 1/E'_1 + 1/E'_2, and the shares of the compliance: by hand and at the ends."""
    one, other = (math.pi * body.E / (1.0 - body.nu**2) for body in (RUBBER, STEEL))
    pair = vr.Cylinder(**ROLLER, material=RUBBER, base=STEEL)
    assert close(2.0 / pair.E_prime, 1.0 / one + 1.0 / other, tol.SCENE)
    assert close(pair.pair.share, (1.0 / one) / (1.0 / one + 1.0 / other), tol.SCENE)
    swapped = vr.Cylinder(**ROLLER, material=STEEL, base=RUBBER)
    assert swapped.E_prime == pair.E_prime
    assert close(swapped.pair.share + pair.pair.share, 1.0, tol.SCENE)
    rigid = vr.Material.rigid()
    for material, base, share in ((RUBBER, rigid, 1.0), (rigid, RUBBER, 0.0)):
        found = vr.Cylinder(**ROLLER, material=material, base=base)
        assert (found.E_prime, found.pair.share) == (2.0 * one, share)
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
        assert (cylinder.scale["t"], 1.0 / cylinder.scale["V"]) == (T, T / 0.1)


def test_scene_of_a_pair():
    cylinder = vr.Cylinder(**ROLLER, material=RUBBER, base=HARD)
    scene = cylinder.scene()
    assert scene.material == vr.Bodies(RUBBER.prony, HARD.prony.slower(2.0 / 0.3), cylinder.pair.share)
    assert close(scene.kappa, 0.1 / cylinder.l0, tol.SCENE)
    assert close(scene.gamma, cylinder.load * 0.3**2 / (35.5 * 0.1), tol.SCENE)
    rigid = vr.Cylinder(**ROLLER, material=vr.Material.rigid(), base=HARD).scene().material
    assert rigid == vr.Bodies(vr.Prony.elastic(), HARD.prony, 0.0)


def test_a_scene_is_a_value():
    alpha = np.array([2.0, 3.0])
    scene, rounded = vr.Scene(alpha, 2.0, 0.2), vr.Scene(11, 2.91, 0.2, 1.1e4)
    alpha[0] = 99.0  # what is given is copied
    assert scene == vr.Scene([2.0, 3.0], 2.0, 0.2) != rounded
    assert rounded == vr.presets.PAPER_SECTION_5_ROUNDED
    assert rounded.replace(mu=0.3).mu == 0.3 != rounded.mu
    assert scene != "scene"
    assert eval(repr(rounded), {"Scene": vr.Scene}) == rounded
    assert len(repr(scene.replace(mu=np.linspace(0.1, 0.3, 1000)[:, None]))) < 120
    assert type(rounded.alpha) is float
    for frozen in (scene, vr.Cylinder(**SI)):
        with pytest.raises(dataclasses.FrozenInstanceError):
            frozen.mu = 0.3
    with pytest.raises(ValueError, match="read-only"):
        scene.alpha[0] = 5.0
    assert vr.Scene([1.0, 2.0, 3.0], [[1.0], [2.0]], 0.2).shape == (2, 3)


def test_limits_that_are_allowed():
    assert close(vr.Cylinder(**(SI | {"nu": 0.5})).E_prime, math.pi * 2.3e5 / 0.75, tol.SCENE)
    assert close(vr.Cylinder(**SI, plane="stress").E_prime, math.pi * 2.3e5, tol.SCENE)
    assert vr.Cylinder(**(SI | {"T_epsilon": 0.97})).scene().alpha == 1.0
    assert vr.Scene(1.0, 1e-300, 1e-300).alpha == 1.0
