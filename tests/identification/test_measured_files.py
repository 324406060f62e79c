"""Measurements from a TOML file and its CSV files, and ``viscoroll identify``."""

import json
from pathlib import Path

import pytest
from calls import data
from experiments import FILE, measurements

import viscoroll as vr
from viscoroll import cli
from viscoroll.measurements.identify import read_measurements


@pytest.fixture
def folder(tmp_path):
    measurements(tmp_path)
    return tmp_path


def test_the_program_reports(folder, capsys):
    out = [str(folder / name) for name in ("fit.json", "fit.png", "fit.nc", "fit.JSON", "fit.NC")]
    given = ["identify", str(folder / "data.toml"), "--starts", "1"]
    assert cli.main([*given, "-o", out[0], "--plot", out[1]]) == 0
    report = capsys.readouterr().out
    assert report.startswith("2 unknowns, 40 points; chi2 ")
    found = json.loads((folder / "fit.json").read_text())
    assert found["unknowns"]["T_ref"]["interval"][0] < 1e-3
    assert found["does_not_act"] == []
    assert (folder / "fit.png").exists()
    assert cli.main([*given, "-o", out[2]]) == 0
    assert (folder / "fit.nc").exists()
    for name, same in zip(
        out[3:], (out[0], out[2]), strict=True
    ):  # the case of the suffix does not matter
        assert cli.main([*given, "-o", name]) == 0
        assert Path(name).read_bytes()[:4] == Path(same).read_bytes()[:4]


def test_a_files_temperature_is_where_its_shift_is_one(folder):
    path = folder / "data.toml"
    path.write_text(FILE.replace("temperature = 20.0\nwlf", "temperature = 60.0\nwlf"))
    shift = read_measurements(path)["shift"]["material"]
    assert shift(60.0) == 1.0
    assert shift(20.0) == 1.0 / vr.WLF(T0=20.0)(60.0)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_columns_that_are_left_aside_are_told(here):
    with pytest.warns(vr.ModelWarning, match=r"drum.csv: unused columns: 'T \[°C\]'"):
        data("V [m/s],M [N m/m],T [°C]\n0.1,0.2,20\n0.2,0.3,20\n")
