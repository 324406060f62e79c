"""Headings as other programs and laboratories write them are read rightly, or refused."""

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr

#: rad/s, storage and loss modulus, Pa, of which the files are
ROWS = [(0.1, 1.1e6, 8e4), (1.0, 1.3e6, 1.6e5), (10.0, 1.7e6, 3.4e5)]


def written(path: Path, headings: str, row) -> Path:
    """Write a table with a row of ``row(omega, storage, loss)`` for each of ROWS; return path."""
    lines = [";".join(map(repr, row(*point))) for point in ROWS]
    path.write_text("\n".join([headings, *lines]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("heading", "function"),
    [("log2 {}", math.log2), ("loge({})", math.log), ("{} (log2)", math.log2)],
)
def test_logarithms_of_other_bases_become_numbers(tmp_path, heading, function):
    """A base that stands beside "log" is that of the numbers, not 10."""
    names = [heading.format(name) for name in ("E'", "E''")]
    path = written(
        tmp_path / "a.csv",
        ";".join(["w [rad/s]", *names]),
        lambda w, s, l: (w, function(s / 1e3), function(l / 1e3)),
    )
    record = vr.read_dma(path, units={"storage": "kPa", "loss": "kPa"})
    assert close([*record], np.transpose(ROWS), tol.UNIT_CONVERTED)


@pytest.mark.parametrize("name", ["F{} kN", "M{}_Nm", "S{} *E6 Pa", "log1000 E{}", "U{} mV"])
def test_units_of_named_columns_are_not_dropped(tmp_path, name):
    """A unit without brackets that is none of a modulus is refused, also of a named column."""
    storage, loss = (name.format(n) for n in (1, 2))
    path = written(tmp_path / "a.csv", f"w [rad/s];{storage};{loss}", lambda *row: row)
    with pytest.raises(vr.FileError, match="is not a unit of storage: give units="):
        vr.read_dma(path, columns={"storage": storage, "loss": loss})


def test_words_and_symbols_of_one_heading_may_touch(tmp_path):
    """Japanese words may stand before a Latin symbol without a blank."""
    path = written(
        tmp_path / "a.csv",
        "角周波数ω rad/s;貯蔵弾性率E' Pa;損失弾性率E'' Pa",
        lambda *row: row,
    )
    np.testing.assert_array_equal([*vr.read_dma(path)], np.transpose(ROWS))


@pytest.mark.parametrize("heading", ["theta_C", "Grad C", "ϑ2", "Probe (°C)"])
@pytest.mark.parametrize(("read", "columns"), [(vr.read_dma, "{};w [rad/s];E' [Pa];E'' [Pa]"),
                                           (vr.read_relaxation, "{};t [s];E(t) [Pa]")])  # fmt: skip
def test_temperatures_under_other_headings_are_not_merged(tmp_path, heading, read, columns):
    """Two temperatures under a heading that is not understood are asked about, of every test."""
    names = columns.format(heading)
    lines = [
        ";".join(map(repr, [T, *row][: names.count(";") + 1])) for T in (20.0, 60.0) for row in ROWS
    ]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([names, *lines]), encoding="utf-8")
    with pytest.raises(vr.FileError, match=r"looks like temperatures.*columns={'temperature'"):
        read(path)


def test_rows_of_one_frequency_that_differ_are_said(tmp_path):
    """Two sweeps that nothing tells apart, 15 % apart, give a warning; repeats within 5 % none."""
    for factor, count in ((0.85, 1), (0.95, 0)):
        path = tmp_path / f"{factor}.csv"
        rows = [f"7;{w};{k * s};{k * l}" for k in (1, factor) for w, s, l in ROWS]
        path.write_text("\n".join(["part;w [rad/s];E' [Pa];E'' [Pa]", *rows]))
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            vr.read_dma(path)
        assert len(said) == count
