"""TOML files (io/config.py): what is read, and what is refused in which words."""

from dataclasses import replace

import pytest

import viscoroll as vr
from viscoroll.io.config import read_law_source, read_roller
from viscoroll.materials.material_toml import read_materials

CYLINDER = "[cylinder]\nR = 0.1\nm = 35.5\nE = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\nmu = 0.2\n"
SCENE = "[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\n"


@pytest.fixture
def toml(tmp_path):
    """Writes a file and returns its path."""

    def write(content):
        path = tmp_path / "file.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_scene(toml):
    for content, scene in (
        (SCENE, vr.Scene(11.0, 2.91, 0.2)),
        (SCENE + "gamma = 1.1e4\nj = 0.5", vr.presets.PAPER_SECTION_5_ROUNDED),
        (CYLINDER, vr.presets.PAPER_SECTION_5),
        (CYLINDER + 'plane = "stress"\nj = 1', replace(vr.presets.PAPER_CYLINDER, plane="stress", j=1.0).scene()),
        ('preset = "paper-figures-2-3"', vr.presets.PAPER_FIGURES_2_3),
        ('preset = "paper-figures-2-3"\n[scene]\nmu = 0.3', vr.presets.PAPER_FIGURES_2_3.replace(mu=0.3)),
    ):
        assert read_roller(toml(content)).scene() == scene


ROLLER = "[cylinder]\nR = 0.1\nm = 35.5\nmu = 0.2\n"
RUBBER = "[material]\nE = 2.3e5\nnu = 0.5\nprony = { E = [2.0, 6], tau = [1.0, 1e-4] }\nT_ref = 0.3\n"
SERIES = vr.Prony([2.0, 6.0], [1.0, 1e-4])


def test_scene_of_a_series(toml):
    prony = SCENE.replace("alpha = 11", "prony = { E = [2.0, 6.0], tau = [1.0, 1e-4] }")
    assert read_roller(toml(prony)) == vr.Scene(kappa=2.91, mu=0.2, material=SERIES)
    rubber = vr.Material(2.3e5, 0.5, SERIES, T_ref=0.3)
    cylinder = vr.Cylinder(R=0.1, m=35.5, mu=0.2, material=rubber, load=500.0)
    assert read_roller(toml(ROLLER + "load = 500\n" + RUBBER)) == cylinder
    creep = SCENE.replace("alpha = 11", "creep = { J = [0.5], T = [1.0], alpha = 2.0 }")
    assert read_roller(toml(creep)) == vr.Scene(kappa=2.91, mu=0.2, material=vr.Prony.creep([0.5], [1.0]))


def test_materials(toml):
    rubber = vr.Material(2.3e5, 0.5, SERIES, T_ref=0.3)
    more = 'name = "tread"\ndensity = 1100\n'
    warm = "wlf = { T0 = 20.0 }\ntemperature = 30.0\n"
    thermal = warm.replace("wlf = {", "arrhenius = { energy = 8e4,")
    solid, creep = "T_epsilon = 10.7\nT_sigma = 0.97", "creep = { J = [0.5], T = [1.0] }"
    for content, material in (
        (RUBBER, rubber),
        (RUBBER + more, replace(rubber, name="tread", density=1100.0)),
        (RUBBER + warm, rubber.at(30.0, vr.WLF(T0=20.0))),
        (
            RUBBER + "reference = 20.0\n" + warm.replace("20.0", "-10.0"),
            replace(rubber, temperature=20.0).at(30.0, vr.WLF(T0=-10.0)),
        ),
        (RUBBER + thermal, rubber.at(30.0, vr.Arrhenius(energy=8e4, T0=20.0))),
        ("[material]\nE = inf\nnu = 0.5", vr.Material.rigid()),
        ("[material]\nE = 2e11\nnu = 0.3", vr.Material.elastic(2e11, 0.3)),
        (f"[material]\nE = 2.3e5\nnu = 0.49\n{solid}", vr.Material.sls(2.3e5, 0.49, 10.7, 0.97)),
        (f"[material]\nE = 1e5\nnu = 0.4\n{creep}", vr.Material(1e5, 0.4, vr.Prony.creep([0.5], [1.0]))),
    ):
        assert read_materials(toml(content)) == {"material": material}
    both = read_materials(toml(RUBBER + "[base]\nE = 2e11\nnu = 0.3\n[other]\nanything = 1"))
    assert both == {"material": rubber, "base": vr.Material.elastic(2e11, 0.3)}


def test_bodies_of_a_file(toml):
    """What has a law: materials, else a scene or a cylinder."""
    assert read_law_source(toml(RUBBER)).base is None
    assert read_law_source(toml(RUBBER + "[base]\nE = 2e11\nnu = 0.3\n")).base.E == 2e11
    assert read_law_source(toml(ROLLER + RUBBER)) == read_law_source(toml(RUBBER))
    assert read_law_source(toml(CYLINDER)).cylinder == vr.Material.sls(2.3e5, 0.49, 10.7, 0.97)
    assert read_law_source(toml("[scene]\nalpha = 11\nkappa = 3\nmu = 0.2")) == 11.0
    series = "[scene]\nprony = { E = [1.0], tau = [0.1] }\nkappa = 3\nmu = 0.2"
    assert read_law_source(toml(series)) == vr.Prony([1.0], [0.1])
