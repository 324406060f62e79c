"""Measurements from a TOML file and its CSV files, and ``viscoroll identify``."""

from __future__ import annotations

import json

import pytest
from experiments import SLOW, resistance
from places import ROOT

import viscoroll as vr
from viscoroll import cli
from viscoroll.identification.file import read_measurements

EXAMPLE = ROOT / "docs/examples/measured.toml"
FILE = """
[cylinder]
R = 0.1
m = 35.5
mu = 0.3

[material]
E = 3e6
nu = 0.5
prony = { E = [9.0], tau = [1.0] }
T_ref = 1e-3
temperature = 20.0
wlf = { T0 = 20.0 }

[unknown]
E = [3e5, 3e7]
T_ref = [1e-4, 1e-2]

[[data]]
kind = "resistance"
file = "drum.csv"
columns = { V = "speed", M = "moment" }
sigma = 0.01
temperature = 20.0
"""


@pytest.fixture
def folder(tmp_path):
    data = resistance(SLOW, seed=1)
    rows = [f"{V!r},{M!r}" for V, M in zip(data.V.tolist(), data.M.tolist(), strict=True)]
    (tmp_path / "drum.csv").write_text("\n".join(["speed [m/s],moment [N m/m]", "# a remark", *rows]), encoding="utf-8")
    (tmp_path / "data.toml").write_text(FILE, encoding="utf-8")
    return tmp_path


def test_the_example_is_what_it_says():
    given = read_measurements(EXAMPLE)
    assert given["unknown"].keys() == {"mu", "E", "E_1", "T_ref", "brake", "drag"}
    drum, throw = given["data"]
    assert (drum.name, throw.name) == ("drum", "throw")
    assert drum.M.size == 40
    assert throw.V.size == 200
    assert (throw.V0, throw.omega0) == (None, 0.0)
    fit = vr.identify(given["cylinder"], given["unknown"], given["data"], starts=1)
    truth = {"mu": 0.3, "E": 3e6, "E_1": 9.0, "T_ref": 1e-3, "brake": 0.05, "drag": 0.003}
    for name, value in truth.items():
        assert abs(fit.values[name] - value) < 3.0 * fit.stderr[name], name
    assert not fit.misfit


def test_the_program_reports(folder, capsys):
    out = [str(folder / name) for name in ("fit.json", "fit.png", "fit.nc")]
    given = ["identify", str(folder / "data.toml"), "--starts", "1"]
    assert cli.main([*given, "-o", out[0], "--plot", out[1]]) == 0
    report = capsys.readouterr().out
    assert report.startswith("2 unknowns, 40 points; chi2 ")
    found = json.loads((folder / "fit.json").read_text(encoding="utf-8"))
    assert found["unknowns"]["T_ref"]["interval"][0] < 1e-3
    assert found["does_not_act"] == []
    assert (folder / "fit.png").exists()
    assert cli.main([*given, "-o", out[2], "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out) == found
    assert (folder / "fit.nc").exists()


WRONG = {
    "a misspelt key": (("sigma", "sigmma"), "unknown key 'sigmma'", "did you mean 'sigma'", "line 23"),
    "another unit": (("speed [m/s]", "speed [km/h]"), "V = in km/h", "in m s-1"),
    "a column that is not there": (('M = "moment"', 'M = "torque"'), "has no column 'torque', but speed, moment"),
    "what no record has": (('M = "moment"', 'M = "moment", Q = "moment"'), "[data.columns] unknown key 'Q'", "V, M, F"),
    "a word among numbers": (("# a remark", "0.1,much"), "'much'", "row 0, column 2"),
    "NaN": (("# a remark", "0.1,nan"), "[[data]] drum.csv: resistance: M = nan at row 0"),
    "a key of another kind": (('sigma = 0.01', "sigma = 0.01\nV0 = 3.0"), "unknown key 'V0'", "line 24"),
    "another kind": (('"resistance"', '"drum"'), "[[data]] kind: must be one of resistance, traction, coastdown"),
    "no file": (('"drum.csv"', '"no.csv"'), "no.csv", "cannot be read"),
    "a range of one number": (("E = [3e5, 3e7]", "E = 3e6"), "unknown E = 3000000.0", "(low, high)"),
    "no unknowns": (("[unknown]\nE = [3e5, 3e7]\nT_ref = [1e-4, 1e-2]", ""), "section [unknown] is missing"),
    "no cylinder": (("[cylinder]", "[scene]"), "unknown key 'material'"),
    "a section that is none": (("[[data]]", "[more]\n[[data]]"), "unknown key 'more'"),
    "sigma of 0": (("sigma = 0.01", "sigma = 0.0"), "sigma of M = 0.0", "> 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_bad_files_are_refused_in_one_line(case, folder, capsys):
    (old, new), *words = WRONG[case]
    for path in folder.iterdir():
        path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    assert cli.main(["identify", str(folder / "data.toml")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    for word in words:
        assert word in said, said


def test_a_files_temperature_is_where_its_shift_is_one(folder):
    path = folder / "data.toml"
    path.write_text(FILE.replace("temperature = 20.0\nwlf", "temperature = 60.0\nwlf"), encoding="utf-8")
    shift = read_measurements(path)["shift"]["material"]
    assert shift(60.0) == 1.0
    assert shift(20.0) == 1.0 / vr.WLF(T0=20.0)(60.0)
