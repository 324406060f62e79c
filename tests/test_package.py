"""The public interface, light imports, one-way layers, and the wheel."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from places import ROOT

import viscoroll as vr

PACKAGE = Path(vr.__file__).parent
HEAVY = {"numba", "xarray", "matplotlib", "scipy", "dask", "h5py", "pandas", "msgspec", "tqdm"}


def run(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", code]
    return subprocess.run(
        command, env=os.environ | environment, capture_output=True, text=True, timeout=120, check=False
    )


# --- the public interface ---


def parameters(function) -> list[str]:
    return list(inspect.signature(function).parameters)


def test_documented_names():
    """The spellings that the documentation promises."""
    assert parameters(vr.contact)[:4] == ["scene", "V", "delta", "omega"]
    assert {"fields", "slopes", "method"} <= set(parameters(vr.contact))
    assert parameters(vr.stress)[:4] == ["scene", "x", "V", "delta"]
    assert parameters(vr.roll)[:5] == ["scene", "V0", "omega0", "t", "rtol"]
    assert {"rest", "max_steps"} <= set(parameters(vr.roll))
    assert inspect.signature(vr.roll).parameters["rtol"].default == 1e-8
    assert parameters(vr.ensemble)[:4] == ["scene", "V0", "omega0", "t"]
    assert [f.name for f in dataclasses.fields(vr.Scene)] == ["alpha", "kappa", "mu", "gamma", "j"]
    assert [f.name for f in dataclasses.fields(vr.Cylinder)] == [
        "R", "m", "E", "nu", "T_epsilon", "T_sigma", "mu", "j", "g", "plane",
    ]  # fmt: skip
    for preset in (vr.PAPER_SECTION_5, vr.PAPER_SECTION_5_ROUNDED, vr.PAPER_FIGURES_2_3):
        assert isinstance(preset, vr.Scene)
    for name in ("build", "save", "load", "interpolate"):
        assert callable(getattr(vr.tables, name))
    assert issubclass(vr.ParameterError, vr.ViscorollError)


def test_documented_results():
    state = vr.contact(vr.PAPER_SECTION_5, 0.3, delta=0.001, slopes=True)
    for name in ("lam", "epsilon", "delta_star", "beta", "Q", "M", "zeta", "full_slip"):
        assert hasattr(state, name)
    for name in ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV"):
        assert hasattr(state, name)
    motion = vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, 1e-4)
    for name in ("t", "V", "omega", "x", "angle", "delta", "regime", "switches", "onset_time", "status", "message"):
        assert hasattr(motion, name)
    for name in ("contact", "at", "to_xarray"):
        assert callable(getattr(motion, name))
    many = vr.ensemble(vr.PAPER_SECTION_5, [1.5], [0.5], [1e-4])
    for name in ("V", "omega", "x", "onset_time", "status"):
        assert hasattr(many, name)


def test_every_public_name_loads():
    assert dir(vr) == sorted(vr.__all__)
    for name in vr.__all__:
        assert getattr(vr, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'contacts'"):
        _ = vr.contacts
    assert all(status in vr.MOTION_STATUS for status in vr.MotionStatus)


def test_every_error_is_a_viscoroll_error():
    errors = [getattr(vr, name) for name in vr.__all__ if name.endswith("Error")]
    assert len(errors) >= 7
    assert all(issubclass(error, vr.ViscorollError) for error in errors)


def test_the_table_of_coefficients_ships_small():
    assert (PACKAGE / "kernels/bessel/ratios.npy").stat().st_size < 300_000
    assert (PACKAGE / "py.typed").exists()


# --- imports ---


@pytest.mark.parametrize(
    "code",
    ["import viscoroll", "import viscoroll as vr; vr.PAPER_SECTION_5; vr.Scene(2, 2, 0.2); dir(vr); vr.ParameterError"],
)
def test_import_is_light(code):
    done = run(f"{code}\nimport sys\nprint(*{{name.split('.')[0] for name in sys.modules}})")
    assert done.returncode == 0, done.stderr
    assert not HEAVY & set(done.stdout.split())


def imports_of(path: Path) -> set[str]:
    """First components, within the package, of everything the module imports, inside functions too."""
    inside = path.relative_to(PACKAGE).parts[:-1]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name.split(".")[1] for alias in node.names if alias.name.startswith("viscoroll.")}
        elif isinstance(node, ast.ImportFrom) and node.level:
            base = inside[: len(inside) - node.level + 1]
            whole = (*base, *(node.module.split(".") if node.module else ()))
            found |= {whole[0]} if whole else {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("viscoroll."):
            found.add(node.module.split(".")[1])
    return found - {"__version__"}


def test_layers_point_one_way():
    """The contract of pyproject.toml, by a reader of its own: highest layer first, | between those of one layer."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (contract,) = project["tool"]["importlinter"]["contracts"]
    level = {
        name.strip().removeprefix("viscoroll."): -n
        for n, names in enumerate(contract["layers"])
        for name in names.split("|")
    }
    for path in PACKAGE.rglob("*.py"):
        home = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if home == "__init__":
            continue
        assert home in level, f"{home} has no layer"
        for name in imports_of(path) - {home}:
            assert level[name] < level[home], f"{path.name} in {home} imports {name}"


def test_kernels_import_numpy_and_numba_only():
    for path in (PACKAGE / "kernels").rglob("*.py"):
        names = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.split(".")[0])
        assert names <= {"numpy", "numba"} | set(sys.stdlib_module_names), path.name


# --- the wheel ---


def test_a_wheel_alone_answers(tmp_path):
    """Small, with its coefficient table inside; contact() needs nothing built."""
    source = tmp_path / "source"
    shutil.copytree(ROOT / "src", source / "src", ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "-o", str(tmp_path), str(source)]
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    assert wheel.stat().st_size < 400_000
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    code = "import viscoroll as vr; print(vr.__file__); print(vr.contact(vr.PAPER_SECTION_5, 0.5, delta=1e-3).Q)"
    answer = run(code, PYTHONPATH=str(tmp_path / "site"))
    assert answer.returncode == 0, answer.stderr
    where, Q = answer.stdout.split()
    assert where.startswith(str(tmp_path))
    assert float(Q) == vr.contact(vr.PAPER_SECTION_5, 0.5, delta=1e-3).Q
