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
from collections.abc import Callable, Iterator
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
    """The bits of motions rolled with an empty cache by one process, and with caches of other histories."""
    rng, works = np.random.default_rng(sizes["seed"]), list(_WORK)
    with tempfile.TemporaryDirectory() as name:
        first, cache = Path(name) / "first", Path(name) / "cache"

        def begin(works: list[str], cache: Path) -> subprocess.Popen:
            """A process that does these works."""
            code = "\n".join([_START.format(motions=sizes["motions"]), *(_WORK[name] for name in works), _END])
            environment = os.environ | {"VISCOROLL_CACHE_DIR": str(cache)}
            return subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True)

        def in_turn() -> None:
            """One program after the other, in any order, each with what the others left in the cache."""
            for work in rng.permutation(works):
                finish(begin([work], cache))

        def at_once() -> None:
            for process in [begin([work], cache) for work in works]:
                finish(process)

        def removed() -> None:
            """A part of the functions, at random: they are compiled again, against those that are left."""
            shutil.copytree(first, cache)
            gap(cache, rng)

        def outcomes(count: int, fill: Callable[[], None]) -> Iterator[str]:
            for _ in tqdm(range(count), desc=fill.__name__, delay=1.0, leave=False):
                fill()
                printed = finish(begin(works, cache))
                shutil.rmtree(cache)
                yield "unharmed" if printed == expected else "other bits" if printed else "an error"

        expected = finish(begin(works, first))
        if not expected:
            raise subprocess.CalledProcessError(1, "motions on an empty cache")
        return [
            row(f"compiled kernels: {done}", outcomes(sizes[fill.__name__], fill)) for done, fill in (
                ("other programs filled the cache", in_turn), ("several processes fill the cache at once", at_once),
                ("files of the cache removed", removed),
            )
        ]  # fmt: skip


def finish(process: subprocess.Popen) -> str:
    """What it printed; nothing if it failed."""
    printed, _ = process.communicate()
    return printed if process.returncode == 0 else ""


def gap(cache: Path, rng: np.random.Generator) -> None:
    """Remove a part of a cache's files; raises FileNotFoundError where there is none."""
    files = sorted(cache.rglob("*.nbc"))
    if not files:
        raise FileNotFoundError(f"no compiled kernels in {cache}")
    for path in rng.choice(files, math.ceil(_REMOVED * len(files)), replace=False):
        path.unlink()
