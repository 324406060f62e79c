"""The public interface, light imports, one-way layers, and the cache of compiled kernels."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import os
import shutil
import subprocess
import sys
import tomllib
import warnings
import zipfile
from pathlib import Path

import numba
import pytest
from ordinary_user import as_ordinary_user, let_in
from places import ROOT

import viscoroll as vr
from viscoroll.kernels.compile import jit

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


# --- the cache of compiled kernels ---

FACTOR = 3.0


def scaled(x):
    return FACTOR * x


@pytest.fixture
def cache(tmp_path, monkeypatch) -> Path:
    """A cache folder of its own that holds ``scaled`` for one signature."""
    if numba.config.DISABLE_JIT:
        pytest.skip("compilation is off")
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", str(tmp_path))
    assert fresh() == 0
    return tmp_path / f"kernels-{jit.sources_digest()}"


def fresh() -> int:
    """Use the kernel as a new process would: the value is right; returns the number of cache hits."""
    function = jit.kernel(scaled)
    assert function(2.0) == 6.0
    return sum(function.stats.cache_hits.values())


def files(folder: Path, kind: str) -> list[Path]:
    found = sorted(folder.glob(f"*{kind}"))
    assert found
    return found


def test_second_use_is_from_the_cache(cache):
    assert fresh() == 1
    assert len(files(cache, ".nbc")) == len(files(cache, ".nbi")) == 1


def flipped(content: bytes, share: float, mask: int) -> bytes:
    """``content`` with the bits of ``mask`` flipped in one byte."""
    spoilt = bytearray(content)
    spoilt[int(share * len(content))] ^= mask
    return bytes(spoilt)


DAMAGE = {
    "flipped early": lambda content: flipped(content, 0.05, 255),
    "flipped middle": lambda content: flipped(content, 0.5, 1),
    "flipped late": lambda content: flipped(content, 0.97, 16),
    "truncated": lambda content: content[: len(content) // 2],
    "one byte short": lambda content: content[:-1],
    "empty": lambda content: b"",
    "zeros": lambda content: bytes(len(content)),
    "text": lambda content: b"not a cache file\n",
}


@pytest.mark.parametrize("kind", [".nbc", ".nbi"])
@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_file_is_replaced(cache, kind, damage):
    """The value is right, and the time after that it comes from the cache again."""
    for path in files(cache, kind):
        path.write_bytes(damage(path.read_bytes()))
    jit._note_cache_trouble.cache_clear()
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        fresh()
    # an index may also have become one of another version of numba, which is no damage
    assert kind == ".nbi" or "cache of compiled kernels is damaged" in str(notes[0].message)
    fresh()
    assert fresh() == 1


@pytest.mark.parametrize("kind", [".nbc", ".nbi"])
def test_a_missing_file_is_replaced(cache, kind):
    for path in files(cache, kind):
        path.unlink()
    assert fresh() == 0
    assert fresh() == 1


def used_from_the_cache() -> None:
    assert fresh() == 1


def test_a_read_only_cache_is_used(cache):
    let_in(cache.parent)
    for path in (*cache.iterdir(), cache):
        path.chmod(0o555)
    assert as_ordinary_user(used_from_the_cache) == ""
    cache.chmod(0o755)


def compiled_with_a_note() -> None:
    jit._note_cache_trouble.cache_clear()
    with pytest.warns(RuntimeWarning, match=r"compiled kernels are not cached \(.*Permission denied"):
        assert fresh() == 0


def test_an_empty_read_only_folder_only_warns(cache):
    let_in(cache.parent)
    for path in cache.iterdir():
        path.unlink()
    cache.chmod(0o555)
    assert as_ordinary_user(compiled_with_a_note) == ""


def test_an_unwritable_folder_only_warns(tmp_path, monkeypatch):
    """A file where the folder should be: stops even the superuser."""
    if numba.config.DISABLE_JIT:
        pytest.skip("compilation is off")
    obstacle = tmp_path / "file"
    obstacle.write_text("in the way")
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", str(obstacle))
    jit._note_cache_trouble.cache_clear()
    with pytest.warns(RuntimeWarning, match="compiled kernels are not cached"):
        assert fresh() == 0
    assert fresh() == 0  # once is enough
    jit._note_cache_trouble.cache_clear()


def test_a_process_with_a_damaged_cache(tmp_path):
    """The real thing, end to end: a kernel that calls others, every file of its cache spoilt."""
    code = """
from viscoroll.kernels.bessel.ratios import ratio_r
print(ratio_r(1.0)[0], sum(ratio_r.stats.cache_hits.values()))
"""
    first = run(code, VISCOROLL_CACHE_DIR=str(tmp_path))
    assert first.stdout == "0.4463899658965345 0\n", first.stderr
    for path in tmp_path.rglob("*.nb?"):
        content = bytearray(path.read_bytes())
        content[len(content) // 3] ^= 255
        path.write_bytes(content)
    for hits in (0, 1):
        again = run(code, VISCOROLL_CACHE_DIR=str(tmp_path))
        assert again.stdout == f"0.4463899658965345 {hits}\n", again.stderr
        assert again.stderr.count("RuntimeWarning: the cache of compiled kernels is damaged") == 1 - hits


def test_a_process_without_a_cache_folder(tmp_path):
    obstacle = tmp_path / "file"
    obstacle.write_text("in the way")
    code = "from viscoroll.kernels.bessel.ratios import ratio_r\nprint(ratio_r(1.0)[0])"
    done = run(code, VISCOROLL_CACHE_DIR=str(obstacle))
    assert done.stdout == "0.4463899658965345\n", done.stderr
    assert done.stderr.count("RuntimeWarning: compiled kernels are not cached") == 1


@pytest.mark.parametrize("name", ["law/law.py", "bessel/ratios.npy", "compile/jit.py"])
def test_any_change_of_a_source_renames_the_cache_folder(tmp_path, monkeypatch, name):
    """numba's own cache would not notice a change in a function called from another module."""
    copy = tmp_path / "kernels"
    shutil.copytree(jit.HERE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    digest = jit.sources_digest.__wrapped__
    before = digest()
    monkeypatch.setattr(jit, "HERE", copy)
    assert digest() == before
    with (copy / name).open("ab") as file:
        file.write(b" ")
    assert digest() != before


def test_bits_cannot_follow_the_history_of_the_cache():
    """No kernel is granted numerical freedom: what LLVM makes of that depends on what is compiled together."""
    if numba.config.DISABLE_JIT:
        pytest.skip("compilation is off")
    kernels = [
        each
        for path in jit.HERE.glob("*/[!_]*.py")
        for each in vars(importlib.import_module(f"viscoroll.kernels.{path.parent.name}.{path.stem}")).values()
        if hasattr(each, "targetoptions")
    ]
    assert len(kernels) > 100
    assert not any(kernel.targetoptions.get("fastmath") for kernel in kernels)


def test_cache_folder_follows_the_environment(monkeypatch):
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", "/somewhere/else")
    assert jit.cache_root() == Path("/somewhere/else")
    monkeypatch.delenv("VISCOROLL_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", "/xdg")
    assert jit.cache_root() == Path("/xdg/viscoroll")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert jit.cache_root() == Path.home() / ".cache" / "viscoroll"


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
