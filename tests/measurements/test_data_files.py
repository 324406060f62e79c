"""Data files of ``identify`` and columns of run files: the same separators, decimal marks and units as of moduli."""

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from experiments import FILE

import viscoroll as vr
from viscoroll.app.identification.measurements_toml import read_measurements
from viscoroll.io.runs.uncertain import read_column

V, M = np.geomspace(0.1, 10.0, 5), np.array([0.1, 0.3, 0.7, 0.5, 0.2])


def rows(*columns, sep=",", decimal="."):
    return "\n".join(sep.join(f"{x:.10g}".replace(".", decimal) for x in row) for row in zip(*columns, strict=True))


DRUMS = {
    "commas": "V [m/s],M [N m/m]\n" + rows(V, M),
    "no units": "V,M\n" + rows(V, M),
    "km/h": "V [km/h],M [N m/m]\n" + rows(3.6 * V, M),
    "units without brackets": "V km/h,M N m/m\n" + rows(3.6 * V, M),
    "semicolons, decimal commas": "V [m/s];M [N m/m]\n" + rows(V, M, sep=";", decimal=","),
    "tabs, decimal commas, units in a row": "V\tM\nm/s\tN m/m\n" + rows(V, M, sep="\t", decimal=","),
    "slashes": "V/(m/s);M/(Nm/m)\n" + rows(V, M, sep=";"),
    "a preamble": "Drum 3\nDate;25.11.2026\n\nV [m/s];M [N m/m]\n" + rows(V, M, sep=";"),
    "UTF-16": ("V [m/s];M [N m/m]\n" + rows(V, M, sep=";")).encode("utf-16"),
}


def drum(folder, text):
    (folder / "drum.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    (folder / "data.toml").write_text(FILE.replace('columns = { V = "speed", M = "moment" }\n', ""))
    return read_measurements(folder / "data.toml")["data"][0]


@pytest.mark.parametrize("name", DRUMS)
def test_a_drum_is_read(name, tmp_path):
    found = drum(tmp_path, DRUMS[name])
    assert close(found.V, V, tol.WRITTEN)
    assert close(found.M, M, tol.WRITTEN)


def test_columns_that_are_left_aside_are_told(tmp_path):
    with pytest.warns(vr.ModelWarning, match=r"drum.csv: unused columns: 'T \[°C\]'"):
        assert close(drum(tmp_path, "V,M,T [°C]\n" + rows(V, M, 20.0 + 0.0 * V)).M, M, tol.WRITTEN)


def test_per_cent_of_creep(tmp_path):
    (tmp_path / "drum.csv").write_text("V [m/s],delta [%],Q [N/m]\n" + rows(V, M, M))
    text = FILE.replace('columns = { V = "speed", M = "moment" }\n', "").replace("resistance", "traction")
    (tmp_path / "data.toml").write_text(text)
    assert close(read_measurements(tmp_path / "data.toml")["data"][0].delta, 0.01 * M, tol.WRITTEN)


@pytest.mark.parametrize("heading", ["V0 [km/h]", "V0/(km/h)", "V0 km/h"])
def test_a_column_of_a_run_file_is_converted(heading, tmp_path):
    """To the unit of the input; a number without dimension has none."""
    path = tmp_path / "starts.csv"
    path.write_text(f"{heading};mu\n" + rows(3.6 * V, M, sep=";", decimal=","))
    assert close(read_column(path, "V0", "m s-1"), V, tol.WRITTEN)
    assert close(read_column(path, heading, "m s-1"), V, tol.WRITTEN)
    with pytest.raises(vr.ParameterError, match="dimension of 1"):
        read_column(path, "V0", "1")
