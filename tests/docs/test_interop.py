"""The examples of docs/loading in their own programs: as the check values say, and loud where they are not."""

from __future__ import annotations

import csv
import json
import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from places import ROOT
from scipy import io

import viscoroll as vr
from viscoroll.config import read_grids

LOADING = ROOT / "docs/loading"
CONFIG = ROOT / "pipeline/config/production.toml"
#: Example -> the command before its two folders, and a command that succeeds where all it needs is there.
EXAMPLES = {
    "read_tables.sh": (["sh", "read_tables.sh"], "command -v ncdump"),
    "read_tables.c": (["./read_tables"], "command -v cc && pkg-config --exists netcdf"),
    "read_tables.m": (["octave-cli", "read_tables.m"], "command -v octave-cli"),
    "with_package.m": (["octave-cli", "with_package.m"], "octave-cli --eval 'pkg load netcdf'"),
    "read_tables.R": (["Rscript", "read_tables.R"], "Rscript -e 'library(ncdf4)'"),
    "read_tables_h5py.py": ([sys.executable, "read_tables_h5py.py"], "true"),
    "read_tables_xarray.py": ([sys.executable, "read_tables_xarray.py"], "true"),
    "read_tables.mjs": (["node", "read_tables.mjs"], f"command -v node && test -d '{ROOT}/node_modules/h5wasm'"),
}
#: A wrong Q is enough for these.
SLOW = ("read_tables.sh", "read_tables_xarray.py")


def need(command: str) -> None:
    """Skip where a command fails: what it asks for is not installed."""
    if subprocess.run(command, shell=True, capture_output=True, check=False).returncode:
        pytest.skip(f"not installed (make interop): {command}")


@pytest.fixture(scope="module")
def tables(tmp_path_factory) -> Path:
    """Folder of atlas.nc and paper.nc as `make tables` builds them."""
    if all((ROOT / f"data/tables/{name}.nc").exists() for name in ("atlas", "paper")):
        return ROOT / "data/tables"
    folder = tmp_path_factory.mktemp("tables")
    for name, grid in read_grids(CONFIG).items():
        vr.tables.save(vr.tables.build(grid), folder / f"{name}.nc")
    return folder


@pytest.fixture
def run_example(tables, tmp_path):
    """Runs an example on the tables and a folder of check values."""

    def run(name: str, checks: Path) -> subprocess.CompletedProcess:
        command, needed = EXAMPLES[name]
        need(needed)
        for path in LOADING.iterdir():
            shutil.copy(path, tmp_path)
        if name == "with_package.m":
            (tmp_path / name).write_text("pkg load netcdf\nsource('read_tables.m')\n")
        if name == "read_tables.c":
            line = next(line for line in readme() if line.startswith("cc "))
            subprocess.run(line.partition(" && ")[0].replace("docs/loading/", ""), shell=True, cwd=tmp_path, check=True)
        if name == "read_tables.mjs":
            (tmp_path / "node_modules").symlink_to(ROOT / "node_modules")
        return subprocess.run([*command, tables, checks], cwd=tmp_path, capture_output=True, text=True, check=False)

    return run


def readme() -> list[str]:
    return (LOADING / "README.md").read_text(encoding="utf-8").splitlines()


def rows_of(path: Path) -> list[dict[str, float]]:
    with path.open(newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def state_lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith(("atlas ", "paper "))]


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_agrees_with_the_check_values(run_example, name):
    done = run_example(name, LOADING)
    assert done.returncode == 0, done.stdout + done.stderr
    lines = state_lines(done.stdout)
    expected = sum(len(rows_of(LOADING / f"check_{table}.csv")) for table in ("atlas", "paper"))
    assert len(lines) == (2 if name == "read_tables.sh" else expected)
    assert all(line.endswith(" ok") for line in lines)


@pytest.mark.parametrize(
    ("name", "field"),
    [(name, field) for name in EXAMPLES for field in ("beta", "Q", "M") if field == "Q" or name not in SLOW],
)
def test_example_finds_a_wrong_value(run_example, tmp_path, name, field):
    checks = tmp_path / "wrong"
    checks.mkdir()
    for table in ("atlas", "paper"):
        rows = rows_of(LOADING / f"check_{table}.csv")
        if table == "paper":  # its last row is a node, at which every example looks
            rows[-1][field] += tol.INTEROP_WRONG * rows[-1][f"allowed_{field}"]
        with (checks / f"check_{table}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    done = run_example(name, checks)
    assert done.returncode == 1, done.stdout + done.stderr
    lines = state_lines(done.stdout)
    assert lines[-1].endswith(" WRONG")
    assert not any(line.endswith("WRONG") for line in lines[:-1])


def test_check_values_are_those_of_the_package_and_the_tables(tables):
    paper = vr.tables.load(tables / "paper.nc")
    for table in ("atlas", "paper"):
        rows = {name: np.array(values) for name, values in _columns(LOADING / f"check_{table}.csv").items()}
        scene = vr.Scene(rows["alpha"], rows["kappa"], rows["mu"])
        exact = vr.contact(scene, rows["V"], delta=rows["delta"])
        for field in ("beta", "Q", "M"):
            assert close(rows[field], getattr(exact, field), rel=tol.PROVEN, scale=1.0)
            if table == "paper":
                stated = paper[field].attrs["interpolation_error"]
                assert (rows[f"allowed_{field}"] >= stated).all()
                assert (rows[f"allowed_{field}"] <= stated * tol.INTEROP_ROUNDED).all()


def _columns(path: Path) -> dict[str, list[float]]:
    rows = rows_of(path)
    return {name: [row[name] for row in rows] for name in rows[0]}


def test_stage_makes_the_check_values_again(tables, tmp_path, monkeypatch):
    folders = [
        f"{option}={path}"
        for option, path in {
            "--tables": tables,
            "--folder": tmp_path,
            "--results": tmp_path,
            "--output": tmp_path,
        }.items()
    ]
    monkeypatch.setattr(sys, "argv", ["loading.py", *folders, f"--config={_few_points(tmp_path)}"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("pipeline.measure.loading", run_name="__main__", alter_sys=True)
    assert ended.value.code == 0
    assert (tmp_path / "check_paper.csv").read_text() == (LOADING / "check_paper.csv").read_text()
    made, kept = (rows_of(folder / "check_atlas.csv") for folder in (tmp_path, LOADING))
    errors = [
        json.loads((folder / "loading.json").read_text())["errors"] for folder in (tmp_path, ROOT / "data/results")
    ]
    for way in ("spline", "six_points"):
        assert all(errors[0][way][field] <= errors[1][way][field] * tol.EXPORT_SAMPLES for field in ("beta", "Q", "M"))
    for one, other in zip(made, kept, strict=True):
        assert {name: value for name, value in one.items() if not name.startswith("allowed")} == {
            name: value for name, value in other.items() if not name.startswith("allowed")
        }


def _few_points(folder: Path) -> Path:
    path = folder / "few.toml"
    text = CONFIG.read_text(encoding="utf-8")
    path.write_text(text.replace("points = 400_000\nseed = 20500", "points = 2000\nseed = 20501"), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", ["atlas", "paper"])
def test_cf_checker_finds_nothing(tables, tmp_path, name):
    checker = Path(sys.executable).with_name("compliance-checker")
    need(f"test -x '{checker}'")
    report = tmp_path / "report.json"
    command = [checker, "--test", "cf:1.11", "--criteria", "strict", "-f", "json", "-o", report, tables / f"{name}.nc"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env=os.environ | {"HOME": str(tmp_path)}
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (result,) = [part for key, part in json.loads(report.read_text()).items() if key.startswith("cf")]
    complaints = [
        message
        for priority in ("high_priorities", "medium_priorities", "low_priorities")
        for part in result[priority]
        for message in part["msgs"]
    ]
    assert not complaints
    assert result["scored_points"] == result["possible_points"] > 0


def test_netcdf3_export_by_ncdump(tables, tmp_path):
    need("command -v ncdump")
    vr.tables.export(vr.tables.load(tables / "paper.nc"), tmp_path / "t.nc", "netcdf3", alpha=11.0)
    kind = subprocess.run(["ncdump", "-k", tmp_path / "t.nc"], capture_output=True, text=True, check=True)
    assert kind.stdout == "64-bit offset\n"
    shown = subprocess.run(
        ["ncdump", "-p", "9,17", "-v", "M", tmp_path / "t.nc"], capture_output=True, text=True, check=True
    )
    values = shown.stdout.partition(" M =")[2].replace(";", "").replace("}", "").replace(",", " ").split()
    assert np.array_equal(np.array(values, dtype=float), vr.tables.load(tables / "paper.nc")["M"].values[:, 6])


def test_matlab_export_by_octave(tables, tmp_path):
    need("command -v octave-cli")
    vr.tables.export(vr.tables.load(tables / "paper.nc"), tmp_path / "t.mat", "matlab", alpha=11.0)
    look_up = "interpn(t.V, t.delta, t.Q, 0.5, -0.01, 'linear')"
    code = f"t = load('t.mat').viscoroll; printf('%.17g %.17g', {look_up}, t.linear_error.Q)"
    shown = subprocess.run(["octave-cli", "--eval", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    value, stated = map(float, shown.stdout.split())
    exact = vr.contact(vr.Scene(11.0, 2.91, 0.2), 0.5, delta=-0.01).Q
    assert 0.0 < abs(value - exact) <= stated
    assert stated == io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]["linear_error"]["Q"]
