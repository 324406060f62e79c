"""Fixtures that tests of several folders share, and an environment of the suite's own."""

from __future__ import annotations

import os

# a thread of BLAS that waits for another spins: where cores are busy a fit of a master curve takes ten times longer
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import pytest
import xarray as xr
from memory import forget

import viscoroll as vr
from viscoroll.motion import flow_store

# what a user chose for other work does not reach the tests
os.environ.pop("VISCOROLL_THREADS", None)
# standard error is compared, and which test compiles depends on the state of the cache
os.environ["VISCOROLL_QUIET"] = "1"


@pytest.fixture
def own_maps(tmp_path, monkeypatch):
    """Flow maps of a test are its own; compiled kernels stay where they are."""
    monkeypatch.setattr(flow_store, "folder", lambda: tmp_path / "maps")
    forget()
    yield
    forget()


@pytest.fixture(scope="module")
def maps_of_this_file(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("maps")
        patch.setattr(flow_store, "folder", lambda: folder)
        forget()
        yield
    forget()


@pytest.fixture(scope="session")
def small_atlas() -> xr.Dataset:
    """Quick to build; a test that changes it changes a copy."""
    return vr.tables.build(
        vr.tables.AtlasGrid(alpha=(1.0, 20.0), kappa_V=(0.1, 10.0), nodes=(8, 12, 12), allowed=(1e-2, 1e-2))
    )
