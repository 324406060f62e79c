"""TOML files (config.py): what is read, and what is refused in which words."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from places import PIPELINE
from refusals import refused

import viscoroll as vr
from viscoroll.config import read_grids, read_scene

PRODUCTION = PIPELINE / "config/production.toml"
CYLINDER = "[cylinder]\nR = 0.1\nm = 35.5\nE = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\nmu = 0.2\n"
SCENE = "[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\n"


@pytest.fixture
def toml(tmp_path):
    """Writes a file and returns its path."""

    def write(content: str | bytes) -> Path:
        path = tmp_path / "file.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_scene(toml):
    for content, scene in (
        (SCENE, vr.Scene(11.0, 2.91, 0.2)),
        (SCENE + "gamma = 1.1e4\nj = 0.5", vr.PAPER_SECTION_5_ROUNDED),
        (CYLINDER, vr.PAPER_SECTION_5),
        (CYLINDER + 'plane = "stress"\nj = 1', replace(vr.PAPER_CYLINDER, plane="stress", j=1.0).scene()),
        ('preset = "paper-figures-2-3"', vr.PAPER_FIGURES_2_3),
    ):
        assert read_scene(toml(content)) == scene


NO_SCENE = [
    (SCENE.replace("alpha", "alhpa"), ["[scene]", "'alhpa'", "did you mean 'alpha'?"]),
    (SCENE.replace("[scene]", "[scnee]"), ["'scnee'", "preset, scene, cylinder", "did you mean 'scene'?"]),
    (CYLINDER + "Tsigma = 1", ["[cylinder]", "'Tsigma'", "did you mean 'T_sigma'?"]),
    (CYLINDER + "zzz = 1", ["[cylinder]", "'zzz'", "must be one of R, m, E"]),
    (SCENE.replace("mu = 0.2", ""), ["[scene]", "missing", "`mu`"]),
    (CYLINDER.replace("R = 0.1", ""), ["[cylinder]", "missing", "`R`"]),
    (CYLINDER.replace("0.1", '"0.1 m"'), ["[cylinder]", "`float`", "`str`", "R"]),
    (SCENE.replace("11", "true"), ["[scene]", "`float`", "`bool`", "alpha"]),
    (SCENE.replace("11", "[1.0, 2.0]"), ["[scene]", "`float`", "`array`", "alpha"]),
    (SCENE.replace("11", "nan"), ["alpha = nan", "finite and >= 1"]),
    (SCENE.replace("11", "0.5"), ["alpha = 0.5", "finite and >= 1"]),
    (SCENE.replace("11", "1" + "0" * 400), ["alpha"]),
    (CYLINDER.replace("0.49", "0.7"), ["nu = 0.7", "(-1, 0.5]"]),
    (CYLINDER + 'plane = "sideways"', ["[cylinder]", "'sideways'", "plane"]),
    ('preset = "paper"', ["preset = 'paper'", "paper-section-5"]),
    ("preset = [1]", ["preset = [1]", "paper-section-5"]),
    ("scene = 3", ["scene = 3", "section [scene]"]),
    ("", ["exactly one of preset, [scene] and [cylinder]", "none"]),
    (SCENE + CYLINDER, ["exactly one", "scene and cylinder"]),
    ("[scene\nalpha = 1", ["not TOML", "line 1"]),
    (SCENE + "alpha = 12", ["not TOML", "overwrite"]),
    (SCENE.replace("11", "1" * 5000), ["not TOML", "digits"]),
    ("a = " + "[" * 100_000, ["not TOML", "recursion"]),
    (b"\xff\xfe", ["not TOML", "byte 0"]),
]


def test_refused_scene(toml):
    for content, words in NO_SCENE:
        refused(partial(read_scene, toml(content)), "file.toml", *words, error=vr.ConfigError)


def test_unreadable(tmp_path):
    for name in ("missing.toml", "."):
        for read in (read_scene, read_grids):
            refused(partial(read, tmp_path / name), "cannot be read", error=vr.ConfigError)


def test_grids_are_those_of_production():
    built_in, production = read_grids(), read_grids(PRODUCTION)
    assert built_in["atlas"] == production["atlas"]
    for name in ("kappa", "mu", "V", "delta", "alpha"):
        assert np.array_equal(getattr(built_in["paper"], name), getattr(production["paper"], name))


def test_grids_of_a_file(toml):
    content = "[tables.atlas]\nnodes = [8, 9, 10]\n[tables.paper]\nV = [0.1, 0.2]\n[other]\nanything = 1\n"
    grids = read_grids(toml(content))
    assert grids["atlas"].nodes == (8, 9, 10)
    assert grids["paper"].V.tolist() == [0.1, 0.2]
    assert grids["paper"].delta.size == read_grids()["paper"].delta.size


NO_GRIDS = [
    ("[table.atlas]\nnodes = [8, 8, 8]", ["[tables] is missing", "did you mean 'table'?"]),
    ("tables = 3", ["section [tables]"]),
    ("[tables]\npaper = 3", ["section [tables.paper]"]),
    ("[tables.altas]", ["[tables]", "'altas'", "did you mean 'atlas'?"]),
    ("[tables.atlas]\nnode = [8, 8, 8]", ["[tables.atlas]", "'node'", "did you mean 'nodes'?"]),
    ("[tables.atlas]\nnodes = [8, 8]", ["[tables.atlas]", "nodes"]),
    ("[tables.atlas]\nnodes = [8, 8, 3]", ["nodes = (8, 8, 3)", ">= 4"]),
    ("[tables.atlas]\nalpha = [0.5, 2.0]", ["alpha = 0.5", ">= 1"]),
    ("[tables.paper]\nkapa = 2", ["[tables.paper]", "'kapa'", "did you mean 'kappa'?"]),
    ("[tables.paper]\nV = 1.0", ["[tables.paper]", "V"]),
    ("[tables.paper]\nV = { low = 1, hihg = 2, count = 3 }", ["[tables.paper.V]", "did you mean 'high'?"]),
    ("[tables.paper]\nV = { low = 1, high = 2 }", ["[tables.paper.V]", "missing", "`count`"]),
    ("[tables.paper]\nV = { low = 0, high = 2, count = 3, spacing = 'log' }", ["[tables.paper]", "low = 0"]),
    ("[tables.paper]\ndelta = [0.1, 0.0]", ["[tables.paper]", "delta", "increasing"]),
    ("[tables.paper]\nkappa = 1e200\nmu = 1e-200", ["[tables.paper]", "mu/kappa"]),
    ("[tables.paper]\nkappa = 1e308\nmu = 1e200", ["[tables.paper]", "kappa |V| = inf", "at most 1e+300"]),
]


def test_refused_grids(toml):
    for content, words in NO_GRIDS:
        refused(partial(read_grids, toml(content)), "file.toml", *words, error=vr.ConfigError)
