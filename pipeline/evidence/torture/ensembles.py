"""Ensembles under torture: killed runs, a full disk, damaged files of a store.

After each the same call goes on; a row's "unharmed" are those whose store then equals an
uninterrupted one bit for bit, with every block that was whole left as it was.
"""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
import time
from collections.abc import Iterator
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from viscoroll import ViscorollError
from viscoroll.core.errors import FileError
from viscoroll.io.runs import Run, read_run, run_ensemble, verify

from .damage import enlarge, flip, row, small_disk, truncate

RUN = """
preset = "paper-section-5"
[scene]
mu = { distribution = "uniform", loc = 0.1, scale = 0.2 }
[start]
V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
omega0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
[run]
n = 6400
seed = 20
t = [1e-3, 2e-3, 3e-3]
rtol = 1e-6
block = 400
keep = "all"
"""
THREADS = 2
NO_TMPFS = "no tmpfs can be had"


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """What was done to stores and what came of it."""
    rng = np.random.default_rng(sizes["seed"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "run.toml").write_text(RUN, encoding="utf-8")
        run = read_run(folder / "run.toml")
        run_ensemble(run, folder / "whole.zarr", threads=THREADS)  # compiles: children take over what is loaded here
        shutil.rmtree(folder / "whole.zarr")
        begun = time.perf_counter()
        child(run, folder / "whole.zarr")
        seconds = time.perf_counter() - begun
        ensemble = Ensemble(run, content(folder / "whole.zarr"), folder, rng)
        return [
            row("SIGKILL of an ensemble", ensemble.kills(sizes["ensembles"], seconds)),
            row("ensemble on a full disk", ensemble.full_disks(sizes["full_ensembles"])),
            row("one bit of a file of a store flipped", ensemble.damage(sizes["stores"], flip)),
            row("a file of a store truncated", ensemble.damage(sizes["stores"], truncate)),
        ]


class Ensemble:
    """A run, the files that it should leave, and ways to disturb it."""

    def __init__(self, run: Run, expected: dict[str, bytes], folder: Path, rng: np.random.Generator) -> None:
        self.run, self.expected, self.folder, self.rng = run, expected, folder, rng
        self.store = folder / "store.zarr"

    def outcome(self) -> str:
        """Go on in a process of its own, and compare."""
        whole = {path: path.stat().st_mtime_ns for path in self.store.glob("records/0*")}
        if child(self.run, self.store):
            return "does not go on"
        if {path: path.stat().st_mtime_ns for path in whole} != whole:
            return "blocks that were whole are made again"
        return "unharmed" if content(self.store) == self.expected else "other files"

    def kills(self, count: int, seconds: float) -> Iterator[str]:
        """At any moment."""
        for _ in tqdm(range(count), desc="kills", delay=1.0, leave=False):
            code = 0
            while code != -signal.SIGKILL:
                shutil.rmtree(self.store, ignore_errors=True)
                process = get_context("fork").Process(target=run_ensemble, args=(self.run, self.store))
                process.start()
                time.sleep(self.rng.uniform(0.0, seconds))
                process.kill()
                process.join()
                code = process.exitcode or 0
            yield self.outcome()

    def full_disks(self, count: int) -> Iterator[str]:
        """On a tmpfs of any size; where none can be had, that is the outcome, and counts as wrong."""
        size = sum(map(len, self.expected.values()))
        for _ in tqdm(range(count), desc="full disks", delay=1.0, leave=False):
            shutil.rmtree(self.store, ignore_errors=True)
            self.store.mkdir()
            room = int(self.rng.uniform(0.05, 0.9) * size)
            with small_disk(self.store, room) as mounted:
                outcome = self.on_full_disk() if mounted else NO_TMPFS
            yield outcome

    def on_full_disk(self) -> str:
        code = child(self.run, self.store)
        if code == 2:
            enlarge(self.store)
        return self.outcome() if code == 2 else f"exit code {code}"

    def damage(self, count: int, change: Any) -> Iterator[str]:
        """Of any file that is not empty, as the lock is: it must be found, and the same command must put it right."""
        names = sorted(name for name, data in self.expected.items() if data)
        restore(self.store, self.expected)
        for _ in tqdm(range(count), desc="damage", delay=1.0, leave=False):
            path = self.store / names[int(self.rng.integers(len(names)))]
            path.write_bytes(change(path.read_bytes(), self.rng))
            yield self.found_and_mended()
            restore(self.store, self.expected)

    def found_and_mended(self) -> str:
        try:
            if verify(self.store).ok:
                return "not found"
        except ViscorollError:
            pass
        run_ensemble(self.run, self.store)
        return "unharmed" if content(self.store) == self.expected else "other files"


def child(run: Run, store: Path) -> int:
    """Exit code of a run in a process of its own: 2 for an error of the package, 1 for any other."""

    def work() -> None:
        try:
            run_ensemble(run, store, threads=THREADS)
        except FileError:
            os._exit(2)

    process = get_context("fork").Process(target=work)
    process.start()
    process.join()
    return process.exitcode or 0


def content(store: Path) -> dict[str, bytes]:
    """Every file of a store."""
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


def restore(store: Path, files: dict[str, bytes]) -> None:
    """Put every file as it was."""
    for name, data in files.items():
        path = store / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_bytes() != data:
            path.write_bytes(data)
