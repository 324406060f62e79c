"""Fixtures that tests of several folders share, and an environment of the suite's own."""

from __future__ import annotations

import os

# a thread of BLAS that waits for another spins: where cores are busy a fit of a master curve takes ten times longer
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import pytest
from memory import forget

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
