"""Runs on a cluster."""

import subprocess
import sys
import time

import pytest

import viscoroll as vr
from viscoroll.runs import read_run, run_ensemble


def test_a_cluster_gives_the_same_files(tmp_path):
    """Also where a worker is killed."""
    pytest.importorskip("distributed")
    import psutil

    text = vr.datasets.path("ensemble.toml").read_text().replace("20_000", "1_200\nblock = 100")
    (tmp_path / "run.toml").write_text(text)
    alone = tmp_path / "alone.zarr"
    store = tmp_path / "store.zarr"
    run_ensemble(read_run(tmp_path / "run.toml"), alone)
    command = "-m viscoroll ensemble run.toml -o store.zarr --cluster local --threads 2"
    process = subprocess.Popen(
        [sys.executable, *command.split()],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    while process.poll() is None and len(list(store.glob("records/0*"))) < 2:
        time.sleep(0.01)
    workers = [
        p
        for p in psutil.Process(process.pid).children(recursive=True)
        if "spawn_main" in " ".join(p.cmdline())
    ]
    workers[-1].kill()
    assert process.wait(timeout=120) == 0
    files = {path.relative_to(alone) for path in alone.rglob("*") if path.is_file()}
    assert files == {path.relative_to(store) for path in store.rglob("*") if path.is_file()}
    assert all((store / file).read_bytes() == (alone / file).read_bytes() for file in files)
