"""Caches of compiled kernels of every history: motions must be the same bits, whatever was compiled when and by whom.

Compiled code that follows from more than its source would show here: what a compiler makes of a
call depends on whether it sees the function called, and a function out of the cache it does not see.
"""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from .damage import row

_START = """
import hashlib
import numpy as np
import viscoroll as vr

rng = np.random.default_rng(20501)
V0, omega0 = rng.uniform(-2.0, 2.0, (2, {motions}))
mu = np.clip(0.2 * np.exp(0.3 * rng.normal(size={motions})), 0.05, 0.6)
scene = vr.presets.PAPER_SECTION_5
uncertain = scene.replace(mu=mu, j=0.4)
results = []
"""
#: a program each that fills the cache with kernels of one kind; all of them together give the hash
_WORK = {
    "contact": "results += vr.contact(uncertain, V0, omega=omega0, fields=('Q', 'M', 'beta')).as_dict().values()",
    "motions": "e = vr.ensemble(uncertain, V0, omega0, [1e-3, 3e-3], rtol=1e-6); results += [e.V, e.omega, e.steps]",
    "losses": "e = vr.ensemble(uncertain, V0, omega0, [3e-3], rtol=1e-6, fields=['V', 'x', 'slip_loss']); "
    "results += [e.V, e.x, e.slip_loss]",
    "flow map": "e = vr.ensemble(scene, V0, omega0, [1e-3, 3e-3], method='flow'); results += [e.V, e.omega]",
}
_END = "print(hashlib.sha256(b''.join(np.ascontiguousarray(each).tobytes() for each in results)).hexdigest())"
#: share of a cache's files that is removed
_REMOVED = 0.3


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """What was done to caches and what came of it."""
    rng = np.random.default_rng(sizes["seed"])
    with tempfile.TemporaryDirectory() as name:
        caches = Caches(Path(name), sizes["motions"], rng)
        return [
            row("compiled kernels: other programs filled the cache", caches.in_turn(sizes["in_turn"])),
            row("compiled kernels: several processes fill the cache at once", caches.at_once(sizes["at_once"])),
            row("compiled kernels: files of the cache removed", caches.removed(sizes["removed"])),
        ]


class Caches:
    """The bits of motions rolled with an empty cache by one process, and other caches to roll them with."""

    def __init__(self, folder: Path, motions: int, rng: np.random.Generator) -> None:
        self.folder, self.rng, self.start = folder, rng, _START.format(motions=motions)
        self.expected = self.finish(self.begin(list(_WORK), folder / "first"))
        if not self.expected:
            raise subprocess.CalledProcessError(1, "motions on an empty cache")

    def begin(self, works: list[str], cache: Path) -> subprocess.Popen:
        """A process that does these works."""
        code = "\n".join([self.start, *(_WORK[name] for name in works), _END])
        environment = os.environ | {"VISCOROLL_CACHE_DIR": str(cache)}
        return subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True)

    @staticmethod
    def finish(process: subprocess.Popen) -> str:
        """What it printed; nothing if it failed."""
        printed, _ = process.communicate()
        return printed if process.returncode == 0 else ""

    def outcome(self, cache: Path) -> str:
        printed = self.finish(self.begin(list(_WORK), cache))
        shutil.rmtree(cache)
        return "unharmed" if printed == self.expected else "other bits" if printed else "an error"

    def in_turn(self, count: int) -> Iterator[str]:
        """One program after the other, in any order, each with what the others left in the cache."""
        for _ in tqdm(range(count), desc="caches in turn", delay=1.0, leave=False):
            for name in self.rng.permutation(list(_WORK)):
                self.finish(self.begin([name], self.folder / "turn"))
            yield self.outcome(self.folder / "turn")

    def at_once(self, count: int) -> Iterator[str]:
        for _ in tqdm(range(count), desc="caches at once", delay=1.0, leave=False):
            for process in [self.begin([name], self.folder / "once") for name in _WORK]:
                self.finish(process)
            yield self.outcome(self.folder / "once")

    def removed(self, count: int) -> Iterator[str]:
        """A part of the functions, at random: they are compiled again, against those that are left."""
        for _ in tqdm(range(count), desc="caches with gaps", delay=1.0, leave=False):
            cache = self.folder / "gaps"
            shutil.copytree(self.folder / "first", cache)
            gap(cache, self.rng)
            yield self.outcome(cache)


def gap(cache: Path, rng: np.random.Generator) -> None:
    """Remove a part of a cache's files; raises FileNotFoundError where there is none."""
    files = sorted(cache.rglob("*.nbc"))
    if not files:
        raise FileNotFoundError(f"no compiled kernels in {cache}")
    for path in rng.choice(files, math.ceil(_REMOVED * len(files)), replace=False):
        path.unlink()
