"""The public interface, and light imports (layers: `make check`)."""

import ast
import pkgutil
import re
import sys
from pathlib import Path

import pytest
from processes import printed

import viscoroll as vr

PACKAGE = Path(vr.__file__).parent
HEAVY = {
    "numba",
    "xarray",
    "matplotlib",
    "scipy",
    "dask",
    "h5py",
    "pandas",
    "pint",
    "msgspec",
    "tqdm",
}


# --- the public interface ---


def test_every_public_name_loads():
    assert dir(vr) == sorted(vr.__all__)
    for name in vr.__all__:
        assert getattr(vr, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'contacts'"):
        _ = vr.contacts
    assert all(status.message for status in vr.MotionStatus)


def test_the_reference_names_what_is_there():
    module = ""
    for line in (
        (Path(__file__).parents[1] / "docs/api.rst").read_text(encoding="utf-8").splitlines()
    ):
        if line.startswith(".. currentmodule:: "):
            module = line.removeprefix(".. currentmodule:: ")
        elif re.fullmatch(r"   [\w.]+", line):
            assert pkgutil.resolve_name(f"{module}.{line.strip()}") is not None


def test_every_error_is_a_viscoroll_error():
    errors = [getattr(vr, name) for name in vr.__all__ if name.endswith("Error")]
    assert len(errors) >= 5
    assert all(issubclass(error, vr.ViscorollError) for error in errors)


def test_the_table_of_coefficients_ships_small():
    assert (PACKAGE / "kernels/law/ratios.npy").stat().st_size < 300_000
    assert (PACKAGE / "py.typed").exists()


# --- imports ---


@pytest.mark.parametrize(
    "code",
    [
        "import viscoroll",
        "import viscoroll as vr; vr.presets.PAPER_SECTION_5; vr.Scene(2, 2, 0.2); dir(vr); vr.law; "
        "vr.ParameterError",
    ],
)
def test_import_is_light(code):
    loaded = printed(f"{code}\nimport sys\nprint(*{{name.split('.')[0] for name in sys.modules}})")
    assert not HEAVY & set(loaded.split())


def test_a_contact_imports_no_motions_and_no_heat():
    call = "vr.Scene(2, 2, 0.2).contact(1, delta=0); print(*sys.modules)"
    loaded = printed(f"import sys, viscoroll as vr; {call}")
    assert not re.search(r"viscoroll\.(motion|heat|tables|runs)", loaded)


def test_kernels_import_numpy_and_numba_only():
    """And for the cache of their machine code filelock."""
    for path in (PACKAGE / "kernels").rglob("*.py"):
        names = set()
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.split(".")[0])
        assert names <= {"numpy", "numba", "llvmlite", "filelock"} | set(sys.stdlib_module_names), (
            path.name
        )
