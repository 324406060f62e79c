"""What is not there everywhere: packages of an extra, a newer Python."""

import sys
from functools import partial

import pytest
from processes import python
from run_files import run_of

import viscoroll as vr
from viscoroll.runs import export_netcdf, open_run, run_ensemble

RUN = """
preset = "paper-section-5"
[start]
V0 = { distribution = "uniform", loc = 0.5, scale = 1.0 }
omega0 = 0.5
[run]
n = 20
t = [1e-4]
rtol = 1e-6
"""
MISSING = "zarr", "distributed", "pyarrow"


@pytest.fixture
def bare(monkeypatch):
    """As after `pip install viscoroll`: no extra."""
    before = set(sys.modules)
    for name in MISSING:
        for loaded in [each for each in sys.modules if each.partition(".")[0] == name]:
            monkeypatch.delitem(sys.modules, loaded)
        monkeypatch.setitem(sys.modules, name, None)
    yield
    for name in (
        set(sys.modules) - before
    ):  # parts without their package would serve its next import
        if name.partition(".")[0] in MISSING:
            del sys.modules[name]


# --- extras ---


def test_a_missing_extra_is_named(bare, here):
    run = run_of(RUN)
    store = here / "store.zarr"
    for call in (
        partial(run_ensemble, run, store),
        partial(open_run, store),
        partial(export_netcdf, store, "x"),
    ):
        with pytest.raises(
            vr.MissingDependencyError, match=r"zarr is not .*pip install 'viscoroll\[runs\]'"
        ):
            call()
    assert not store.exists()


def test_cluster_and_parquet_are_extras_too(bare, here, monkeypatch):
    monkeypatch.delitem(sys.modules, "zarr")
    with pytest.raises(vr.MissingDependencyError, match=r"viscoroll\[cluster\]"):
        run_ensemble(run_of(RUN), "store.zarr", cluster="local")
    (here / "a.parquet").touch()
    text = RUN.replace("omega0 = 0.5", 'omega0 = { file = "a.parquet", column = "a" }')
    with pytest.raises(vr.MissingDependencyError, match=r"viscoroll\[parquet\]"):
        run_of(text)


# --- Pythons ---


def test_an_older_python_is_told_in_one_line():
    code = "import sys; sys.version_info = (3, 10, 13); import viscoroll"
    assert (
        python("-c", code)
        .stderr.splitlines()[-1]
        .startswith("ImportError: viscoroll needs Python 3.11 or newer, this is 3.")
    )
