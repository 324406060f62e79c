"""Measurements from a TOML file and its CSV files, and ``viscoroll identify``."""

import json
import math
import re
from functools import partial
from pathlib import Path

import pytest
import tolerances as tol
from calls import data
from closeness import close
from experiments import measurements
from refusals import each, refusals, refused

import viscoroll as vr
from viscoroll import cli
from viscoroll.measurements.identify import read_measurements
from viscoroll.measurements.unknowns import cylinder_of

pytestmark = pytest.mark.usefixtures("here")


@pytest.mark.long
def test_the_program_reports(here, capsys):
    """The case of the suffix does not matter."""
    measurements(here)
    line = ["identify", "data.toml", "--starts", "1", "-o"]
    assert cli.main([*line, "fit.JSON", "--plot", "fit.png"]) == 0
    assert capsys.readouterr().out.startswith("2 unknowns in SI units, 40 points; chi2, ")
    found = json.loads(Path("fit.JSON").read_text())
    assert found["unknowns"]["T_ref"]["interval"][0] < 1e-3
    assert found["does_not_act"] == []
    assert Path("fit.png").exists()
    assert cli.main([*line, "fit.NC"]) == 0
    assert Path("fit.NC").read_bytes().startswith(b"\x89HDF")


def test_a_record_is_at_its_temperature_by_the_shift_of_the_material(here):
    """Also by one in the file that [material] names."""
    vr.Material.sls(3e6, 0.5, 0.01, 0.001, shift=vr.WLF(T0=20.0)).to_netcdf("rubber.nc")
    path = measurements(here, "temperature = 20.0\nwlf", "temperature = 60.0\nwlf")
    text = path.read_text()
    other = re.sub("(?s)E = 3e6.*?\n\n", 'file = "rubber.nc"\n', text)
    for content, T_ref in ((text, 1e-3), (other, 0.01)):
        path.write_text(content)
        read = read_measurements(path)
        found = cylinder_of(read["cylinder"], {}, *read["data"])
        assert close(found.material.T_ref, T_ref, tol.DMA_DIGITS)


@pytest.mark.parametrize(
    "heading",
    ["V x10^3 [m/s]", "V*1000 [m/s]", "1000 V [m/s]", "V / 1e3 m/s", "V in 1000 m/s", "log3(V)"],
)
def test_a_factor_in_a_heading_is_no_unit(heading):
    """Which side it multiplies cannot be told; the advice, followed, gives the unit."""
    text = f"{heading};M [N m/m]\n72;0.2\n720;0.3\n"
    more = f'columns = {{ V = "{heading}" }}\n'
    words = "V has the unit ", "units = { V = 'UNIT' }"
    refused(partial(data, text, more=more), *words, error=vr.FileError)
    found = data(text, more=more + 'units = { V = "mm/s" }\n')
    if not heading.startswith("log"):
        assert close(found.V, [0.072, 0.72], tol.DMA_DIGITS)


def test_columns_that_are_left_aside_are_told():
    with pytest.warns(vr.ModelWarning, match=r"drum.csv: unused columns: 'T \[°C\]'"):
        data("V [m/s],M [N m/m],T [°C]\n0.1,0.2,20\n0.2,0.3,20\n")


@pytest.mark.parametrize(
    "headings, kind, name, value",
    [
        ("Speed [km/h];Rolling torque [N m/m]", "resistance", "V", 7.2 / 3.6),
        ("Geschwindigkeit (m/min);Kraft [kN/m]", "resistance", "F", 2e3),
        ("Zeit/s;Drehzahl [U/min]", "coastdown", "omega", math.pi / 15.0),
        ("temps [ms];vitesse [m/s]", "coastdown", "t", 7.2e-3),
        ("t [s];omega [rev/s]", "coastdown", "omega", 4.0 * math.pi),
        ("Tiempo [s];Velocidad angular [rad/s]", "coastdown", "omega", 2.0),
        ("時間(s);速度(m/s)", "coastdown", "V", 2.0),
    ],
)
def test_words_say_what_a_column_is(headings, kind, name, value):
    record = data(f"{headings}\n7,2;2,0\n8,1;2,5\n", kind)
    assert close(getattr(record, name)[0], value, tol.UNIT_CONVERTED)


ASKED = each(
    partial(data, kind="coastdown"),
    {
        "may be turns": [
            "t [s],omega [1/min]\n0,2\n0,2",
            "t [s],Drehzahl [1/s]\n0,2\n0,2",
            "t [s],rpm\n0,2\n0,2",
        ],
        "may both be V: name one": "time [s],velocity [m/s],speed [km/h]\n0,2,3\n0,2,3",
        "no column V or omega or x, but 'u [m/s]', whose meaning is not known: if one is V": (
            "t [s],u [m/s]\n0,2\n0,2"
        ),
    },
    vr.FileError,
)
test_what_a_column_may_be_is_asked = refusals(ASKED)
