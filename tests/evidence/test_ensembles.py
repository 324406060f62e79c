"""Runs on a cluster."""

import time

import pytest
from places import content
from processes import begun

import viscoroll as vr
from viscoroll.runs import read_run, run_ensemble


def test_a_cluster_gives_the_same_files(tmp_path):
    """Also where a worker is killed."""
    pytest.importorskip("distributed")
    import psutil

    text = vr.datasets.path("ensemble.toml").read_text().replace("20_000", "1_200\nblock = 100")
    process, store = begun(text, tmp_path, "--cluster", "local")
    while process.poll() is None and len(list(store.glob("records/0*"))) < 2:
        time.sleep(0.01)
    workers = [
        p
        for p in psutil.Process(process.pid).children(recursive=True)
        if "spawn_main" in " ".join(p.cmdline())
    ]
    workers[-1].kill()
    assert process.wait(timeout=120) == 0
    alone = tmp_path / "alone.zarr"
    run_ensemble(read_run(tmp_path / "run.toml"), alone)
    assert content(store) == content(alone)
