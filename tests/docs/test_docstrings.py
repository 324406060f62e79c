"""The examples in docstrings run."""

import doctest
from importlib import import_module

import pytest
from places import ROOT

import viscoroll as vr

SOURCE = ROOT / "src"
MODULES = [
    ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")
    for path in sorted(SOURCE.rglob("*.py")) if ">>> " in path.read_text(encoding="utf-8")
]  # fmt: skip


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
@pytest.mark.parametrize("name", MODULES)
def test_examples_of_docstrings(name, tmp_path, monkeypatch):
    """Every line of every Examples section, with its output; files go to a temporary folder."""
    monkeypatch.chdir(tmp_path)
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    tried = doctest.testmod(import_module(name), extraglobs={"vr": vr}, optionflags=options)
    assert tried.attempted
    assert not tried.failed
