"""Results stores: the same files by any engine and after any end; damage is found, and put
right.
"""

import errno
import itertools
import os
import shutil
import signal
import subprocess
import time
from contextlib import contextmanager
from functools import partial

import pytest
from long_cases import long
from places import content
from processes import begun
from refusals import refused
from run_files import run_of

import viscoroll as vr
from viscoroll.core import files
from viscoroll.runs import export_netcdf, open_run, run_ensemble, verify
from viscoroll.runs.run_store import locked

refused_file = partial(refused, error=vr.FileError)
pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

RUN = """
preset = "paper-section-5"
[scene]
mu = { distribution = "uniform", loc = 0.1, scale = 0.2 }
[start]
V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
omega0 = 0.5
[run]
n = 1200
seed = 3
t = [1e-3, 3e-3]
rtol = 1e-6
rest = 1e-3
block = 100
keep = "all"
fields = ["V"]
summaries = ["V"]
"""

#: without it one flow map holds for all motions
MU = '[scene]\nmu = { distribution = "uniform", loc = 0.1, scale = 0.2 }\n'

#: an interrupt is answered within a second; a process that starves among others takes longer
INTERRUPT_SECONDS = 20.0


@pytest.fixture
def run(tmp_path):
    return run_of(RUN, tmp_path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A store that nothing happened to."""
    folder = tmp_path_factory.mktemp("whole")
    assert run_ensemble(run_of(RUN, folder), folder / "whole.zarr", threads=2) == 12
    return folder / "whole.zarr"


def test_damaged_motions_are_not_exported(tmp_path, whole):
    store = shutil.copytree(whole, tmp_path / "store.zarr")
    data = bytearray((store / "motions/V/7.0").read_bytes())
    data[-1] ^= 1
    (store / "motions/V/7.0").write_bytes(data)
    export = partial(export_netcdf, store, tmp_path / "all.nc")
    refused_file(export, ": 1 of 12", "or repair ")
    assert not (tmp_path / "all.nc").exists()
    (store / "V_mean/0").write_bytes(b"")
    refused_file(lambda: open_run(store), "V_mean/0")


#: a file of each kind of a store; each third is of values, of records, of metadata
PARTS = [
    "motions/V/7.0",
    "records/000000007",
    "records/start",
    "records/end",
    "V_mean/0",
    ".zmetadata",
    "motions/V/.zarray",
]


@pytest.mark.parametrize("change", ["flip", *long("truncate", "remove")])
def test_damage_is_found_and_put_right(run, tmp_path, whole, change):
    """At its own time, to each kind of file: values and records of a block, summaries, metadata."""
    store = shutil.copytree(whole, tmp_path / "store.zarr")
    exact = content(whole)
    for name in PARTS if change == "flip" else PARTS[::3]:
        data = bytearray((store / name).read_bytes())
        data[len(data) // 2] ^= 16
        if change == "remove":
            (store / name).unlink()
        else:
            (store / name).write_bytes(data if change == "flip" else data[: len(data) // 2])
        if name == "records/start":
            refused_file(lambda: verify(store), "records/start is missing or damaged")
        else:
            assert not verify(store).ok, name
        assert run_ensemble(run, store) == ("7" in name), name
        assert content(store) == exact, name


def written(paths):
    """When each of these files was."""
    return {path: path.stat().st_mtime_ns for path in paths}


@contextmanager
def disk_for(writes, monkeypatch):
    """A disk with space for so many writes of files; the block must end with an error that says
    so.
    """
    sync = files._sync
    calls = itertools.count()

    def limited(path):
        if next(calls) >= writes:
            raise OSError(errno.ENOSPC, "No space left on device")
        sync(path)

    with monkeypatch.context() as patch:
        patch.setattr(files, "_sync", limited)
        with pytest.raises(vr.FileError, match="No space left"):
            yield


def test_other_folders_are_refused(tmp_path, whole):
    run = run_of(RUN.replace("seed = 3", "seed = 4"), tmp_path)
    thesis = tmp_path / "thesis"
    thesis.mkdir()
    (thesis / "chapter.tex").write_text("dear")
    words = "another run file, or of this one before a change: give"
    refused_file(partial(run_ensemble, run, whole), words)
    words = "is no results store (it contains chapter.tex): give another folder"
    refused_file(partial(run_ensemble, run, thesis), words)
    refused_file(partial(verify, thesis), "not a results store")
    assert [path.name for path in thesis.iterdir()] == ["chapter.tex"]
    with locked(tmp_path / "store.zarr"):
        refused_file(partial(run_ensemble, run, tmp_path / "store.zarr"), "another process")


# --- more motions ---


@pytest.fixture
def smaller(tmp_path):
    """A store of 350 of the motions, the last block of which is a half."""
    run = run_of(RUN.replace("n = 1200", "n = 350"), tmp_path)
    assert run_ensemble(run, tmp_path / "store.zarr", threads=2) == 4
    return tmp_path / "store.zarr"


def test_a_run_grows(smaller, run, whole):
    """Its whole blocks stay as they are, and all files become those of the larger run."""
    kept = written(smaller.glob("records/00000000[012]"))
    assert len(kept) == 3
    assert run_ensemble(run, smaller, threads=2) == 9
    assert written(kept) == kept
    assert content(smaller) == content(whole)
    assert verify(smaller).ok
    assert len(open_run(smaller)) == 1200


@pytest.mark.long
def test_a_run_that_ended_while_it_grew_goes_on(smaller, run, whole, monkeypatch):
    """Until then it is the smaller store or one that is not finished, never one of fewer motions
    than it says.
    """
    for writes in (0, 20, 100):
        with disk_for(writes, monkeypatch):
            run_ensemble(run, smaller, threads=1)
        assert not verify(smaller).ok
        refused_file(lambda: open_run(smaller), "or repair it")
    run_ensemble(run, smaller)
    assert content(smaller) == content(whole)


@pytest.mark.parametrize(
    "before, now, words",
    [
        (
            "",
            "n = 300",
            "contains 350 motions of this run file, and n = 300 is smaller: set n >= 350",
        ),
        (
            'design = "latin"',
            "n = 1200",
            "a Latin hypercube, whose points depend on n: keep n = 350",
        ),
        ('design = "sobol"', "n = 1200", "and n = 1200 is no power of two: set n = 2048"),
        (
            "block = 1000",
            "n = 1200",
            "in blocks of 350 motions, not of 1000 as now: set block = 350",
        ),
        ("", "n = 5000", "by method 'integrate', not 'flow' as now: set method = 'integrate'"),
    ],
)
def test_a_run_that_cannot_grow_is_refused(tmp_path, before, now, words):
    """And the store stays as it was."""
    text = RUN.replace(MU, "") + f"{before}\n"
    if before.startswith("block"):
        text = text.replace("block = 100\n", "", 1)
    store = tmp_path / "store.zarr"
    run_ensemble(run_of(text.replace("n = 1200", "n = 350"), tmp_path), store, threads=2)
    was = content(store)
    larger = run_of(text.replace("n = 1200", now), tmp_path)
    refused_file(lambda: run_ensemble(larger, store), words, "give another folder")
    assert content(store) == was


@pytest.mark.long
def test_a_killed_run_goes_on(run, tmp_path, whole, monkeypatch):
    """SIGKILL of everything: what is done stays as it is, and at most one block a worker is made
    again.  The disk was full when it began.
    """
    with disk_for(1, monkeypatch):
        run_ensemble(run, tmp_path / "store.zarr")
    process, store = begun(RUN, tmp_path, start_new_session=True)
    while process.poll() is None and len(list(store.glob("records/0*"))) < 3:
        time.sleep(0.001)
    os.killpg(process.pid, signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    done = written(store.glob("records/0*"))
    assert 3 <= len(done) < 12
    assert run_ensemble(run, store) == 12 - len(done)
    assert written(done) == done
    assert content(store) == content(whole)


def _heeding():
    """Ctrl-C ends what a shell started in the background too, which is made to ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.long
def test_an_interrupt_answers_at_once(tmp_path):
    """Ctrl-C in the midst of long blocks: within seconds on a busy machine, what is kept and how to
    go on.
    """
    long = RUN.replace("n = 1200", "n = 400_000").replace("block = 100", "block = 100_000")
    long = long.replace('"all"', '"summaries"')
    # nothing else runs in this process
    process, store = begun(long, tmp_path, stderr=subprocess.PIPE, preexec_fn=_heeding)
    while not (store / "records/start").exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=INTERRUPT_SECONDS)
    assert process.returncode == 130
    kept = "interrupted: 0 of 400000 motions were added to store.zarr; to resume, repeat the run"
    assert told.splitlines()[-1] == f"viscoroll: {kept}"
