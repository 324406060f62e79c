"""Tables under torture: killed builds, two writers at once, and damage to files that are there."""

from __future__ import annotations

import tempfile
import time
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from viscoroll import ViscorollError, tables
from viscoroll.core.errors import FileError
from viscoroll.core.files import seal_matches
from viscoroll.presets import RUBBER_CYLINDER

from ... import offline
from ...stage import ROOT
from .damage import damaged, edit, ended, fingerprint, flip, killed, trials, truncate, unsealed

LAW = ROOT / "data/tables/rubber.nc"
#: what `make tables` builds while it is killed
CONFIG = """
[tables]
allowed = 1e-12
allowed_N = 1e-12
alpha = [8, 16]
[tables.laws.paper]
material = { E = 2.3e5, nu = 0.49, T_epsilon = 10.7, T_sigma = 0.97 }
[tables.laws.rubber]
material = { E = 3e6, nu = 0.5, prony = { E = [0.3, 0.6, 1.5], tau = [2e-2, 1e-3, 1e-5] } }
[tables.grid]
preset = "paper-section-5-rounded"
V = [0.1, 2.0, 5]
delta = 5
alpha = [8.0, 11.0, 13.0, 16.0]
allowed = 1e-12
"""
#: seconds within which it is killed once a temporary file is there: what a write and its two fsyncs
#: take
WRITE = 0.02


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """What was done to tables and what came of it."""
    rng = np.random.default_rng(sizes["seed"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables.save(grid(), folder / "table.nc")
        content = (folder / "table.nc").read_bytes()
        found = [
            *kills(sizes["kills"], folder, rng),
            writers(
                "two processes save the same table at once", sizes["writers"], folder / "both.nc"
            ),
        ]
        ways = {
            "one bit flipped": (sizes["flips"], content, flip),
            "truncated": (sizes["truncations"], content, truncate),
            "1-16 bytes of headers and B-trees replaced": (sizes["edits"], content, edit),
            "truncated, no seal": (sizes["unsealed"], unsealed(content), truncate),
        }
        if LAW.exists():
            ways["one bit of data/tables/rubber.nc flipped"] = (
                sizes["large"],
                LAW.read_bytes(),
                flip,
            )
        for done, (count, whole, change) in ways.items():
            found.append(damaged(done, count, folder / "damaged.nc", whole, change, rng))
    return found


def grid(command: str | None = None) -> Any:
    """A table whose file is headers for the most part."""
    return tables.build(
        RUBBER_CYLINDER, V=[0.1, 0.3, 2.0], delta=[-0.01, 0.0, 0.03], command=command
    )


def kills(count: int, folder: Path, rng: np.random.Generator) -> list[dict[str, Any]]:
    """SIGKILL what `make tables` does, at any moment and in its writes; the tables must be as they
    were, or new.
    """
    config = folder / "run.toml"
    built = folder / "tables"
    config.write_text(CONFIG, encoding="utf-8")
    build = partial(offline.build_all, config, built)
    build()  # compiles
    expected = hashes(built)
    begun = time.perf_counter()
    ended(build)
    seconds = time.perf_counter() - begun

    def kill(in_write: bool) -> str:
        written = f".*.tmp-{rng.choice([*expected])}" if in_write else "*"
        done = False
        while not done:  # it may end before
            for left in built.glob(".*"):
                left.unlink()
            done = killed(
                build, WRITE if in_write else seconds, rng, lambda: any(built.glob(written))
            )
        return "unharmed" if hashes(built) == expected else "damaged"

    ways = {
        "SIGKILL of `make tables`": False,
        "SIGKILL of `make tables` while it writes a table": True,
    }
    return [trials(done, count, partial(kill, in_write)) for done, in_write in ways.items()]


def hashes(folder: Path) -> dict[str, str] | None:
    """Of sealed tables: names and values alone, as ``history`` tells when it was made; None where
    one is not whole.
    """
    try:
        return {
            path.name: fingerprint(whole(path).drop_attrs()) for path in folder.glob("[!.]*.nc")
        }
    except ViscorollError:
        return None


def whole(path: Path) -> Any:
    """A table whose seal holds."""
    if not seal_matches(path.read_bytes()):
        raise FileError(path, "has no seal that holds")
    return tables.load(path)


def writers(done: str, count: int, path: Path) -> dict[str, Any]:
    """Two processes save one table over and over; every load between is one of theirs, whole."""
    made = [grid(f"writer {n}") for n in range(2)]
    expected = set()
    for table in made:
        tables.save(table, path)
        expected.add(fingerprint(tables.load(path)))

    def save_all(table: Any) -> None:
        while True:
            tables.save(table, path)

    def load() -> str:
        if not all(process.is_alive() for process in processes):
            return "a writer failed"
        return "unharmed" if fingerprint(whole(path)) in expected else "damaged"

    processes = [get_context("fork").Process(target=save_all, args=(table,)) for table in made]
    for process in processes:
        process.start()
    try:
        return trials(done, count, load)
    finally:
        for process in processes:
            process.kill()
            process.join()
