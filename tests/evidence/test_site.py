"""The site: built without a warning, with every public name and every picture."""

import importlib.util
import shutil
import subprocess
import sys
from types import ModuleType

import pytest
from places import ROOT

import viscoroll as vr

SITE = ROOT / "docs/_build/html"
NEEDED = """fmpy myst_parser numpydoc pydata_sphinx_theme sphinx sphinx_copybutton sphinx_design
sphinx_gallery"""
BUILD = "-W --keep-going -n -E -q -b html docs docs/_build/html"


def test_the_site_has_every_public_name_and_a_picture_on_each_page_of_the_gallery():
    """As `make docs` builds it: any warning is an error."""
    missing = [name for name in NEEDED.split() if importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"not installed (make docs): {', '.join(missing)}")
    for made in ("_build", "api", "gallery", "tutorial"):  # of examples and names that may be gone
        shutil.rmtree(ROOT / "docs" / made, ignore_errors=True)
    command = [sys.executable, "-m", "sphinx", *BUILD.split()]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    from sphinx.util.inventory import InventoryFile

    held = InventoryFile.loads((SITE / "objects.inv").read_bytes(), uri="").data
    names = {name for kind, entries in held.items() if kind.startswith("py:") for name in entries}
    for name in set(vr.__all__) - {"__version__"}:
        value = getattr(vr, name)
        if isinstance(value, ModuleType):  # what it offers has
            assert {f"{value.__name__}.{own}" for own in value.__all__} - names == set()
        else:
            assert {f"viscoroll.{name}", f"{value.__module__}.{name}"} & names, name
    written = sorted((ROOT / "docs/examples/gallery").rglob("*.py"))
    assert written
    for path in written:
        name = path.relative_to(ROOT / "docs/examples").with_suffix(".html")
        text = (SITE / name).read_text()
        assert "_images/sphx_glr_" in text, name
        assert "Traceback" not in text, name
