"""Ensembles under torture: killed runs, a full disk, damaged files of a store.

After each the same call goes on; a row's "unharmed" are those whose store then equals an
uninterrupted one bit for bit, with every block that was whole left as it was.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from viscoroll import ViscorollError
from viscoroll.runs import read_run, run_ensemble, verify

from .damage import Change, ended, enlarge, flip, killed, small_disk, trials, truncate

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


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """What was done to stores and what came of it."""
    with tempfile.TemporaryDirectory() as name:
        store = Store(Path(name), np.random.default_rng(sizes["seed"]))
        return [
            trials("SIGKILL of an ensemble", sizes["ensembles"], store.kill),
            trials("ensemble on a full disk", sizes["full_ensembles"], store.fill_disk),
            trials(
                "one bit of a file of a store flipped", sizes["stores"], partial(store.damage, flip)
            ),
            trials("a file of a store truncated", sizes["stores"], partial(store.damage, truncate)),
        ]


class Store:
    """A run, the files that it should leave, and ways to disturb it, each of which says what came
    of it.
    """

    def __init__(self, folder: Path, rng: np.random.Generator) -> None:
        self.rng = rng
        self.path = folder / "store.zarr"
        (folder / "run.toml").write_text(RUN, encoding="utf-8")
        self.run = partial(run_ensemble, read_run(folder / "run.toml"), self.path, threads=2)
        self.run()  # compiles: children take over what is loaded here
        self.expected = self.content()
        self.clear()
        begun = time.perf_counter()
        ended(self.run)
        self.seconds = time.perf_counter() - begun

    def clear(self) -> None:
        shutil.rmtree(self.path, ignore_errors=True)

    def content(self) -> dict[str, bytes]:
        """Every file."""
        return {
            str(path.relative_to(self.path)): path.read_bytes()
            for path in self.path.rglob("*")
            if path.is_file()
        }

    def outcome(self) -> str:
        """Go on in a process of its own, and compare."""
        whole = {path: path.stat().st_mtime_ns for path in self.path.glob("records/0*")}
        if ended(self.run):
            return "does not go on"
        if {path: path.stat().st_mtime_ns for path in whole} != whole:
            return "blocks that were whole are made again"
        return "unharmed" if self.content() == self.expected else "other files"

    def kill(self) -> str:
        """At any moment."""
        self.clear()
        while not killed(self.run, self.seconds, self.rng):
            self.clear()
        return self.outcome()

    def fill_disk(self) -> str:
        """On a tmpfs of any size."""
        self.clear()
        self.path.mkdir()
        with small_disk(
            self.path, int(self.rng.uniform(0.05, 0.9) * sum(map(len, self.expected.values())))
        ):
            if (code := ended(self.run)) != 2:
                return f"exit code {code}"
            enlarge(self.path)
            return self.outcome()

    def damage(self, change: Change) -> str:
        """Of any file that is not empty, as the lock is: it must be found, and the same call must
        put it right.
        """
        if self.content() != self.expected:
            self.clear()
            self.run()
        path = self.path / self.rng.choice(
            sorted(name for name, data in self.expected.items() if data)
        )
        path.write_bytes(change(path.read_bytes(), self.rng))
        try:
            if verify(self.path).ok:
                return "not found"
        except ViscorollError:
            pass
        self.run()
        return "unharmed" if self.content() == self.expected else "other files"
