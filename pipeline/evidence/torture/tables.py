"""Tables under torture: killed builds, two writers at once, and damage to files that are there."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from viscoroll import ViscorollError, tables
from viscoroll.core.errors import FileError
from viscoroll.core.files import seal_holds
from viscoroll.presets import RUBBER_CYLINDER

from ...stage import ROOT
from .damage import damaged, edit, fingerprint, flip, row, truncate, unsealed

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
"""
#: seconds within which it is killed once a temporary file is there: what a write and its two fsyncs take
WRITE = 0.02


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """What was done to tables and what came of it."""
    rng = np.random.default_rng(sizes["seed"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables.save(grid(), folder / "table.nc")
        content = (folder / "table.nc").read_bytes()
        found = [
            *kills(sizes["kills"], folder / "kills", rng),
            writers("two processes save the same table at once", sizes["writers"], folder / "both.nc"),
        ]
        ways = {
            "one bit flipped": (sizes["flips"], content, flip),
            "truncated": (sizes["truncations"], content, truncate),
            "1-16 bytes of headers and B-trees replaced": (sizes["edits"], content, edit),
            "truncated, no seal": (sizes["unsealed"], unsealed(content), truncate),
        }
        if LAW.exists():
            ways["one bit of data/tables/rubber.nc flipped"] = sizes["large"], LAW.read_bytes(), flip
        for done, (count, whole, change) in ways.items():
            found.append(damaged(done, count, folder / "damaged.nc", whole, change, rng))
    return found


def grid(command: str | None = None) -> Any:
    """A table whose file is headers for the most part."""
    return tables.build(RUBBER_CYLINDER, V=[0.1, 0.3, 2.0], delta=[-0.01, 0.0, 0.03], command=command)


def kills(count: int, folder: Path, rng: np.random.Generator) -> list[dict[str, Any]]:
    """SIGKILL the command of `make tables`, at any moment and in its writes; the tables must be as they were, or new.

    A smaller configuration, so that a command takes seconds; as many at a time as there are cores.
    """
    folder.mkdir()
    whole = folder / "whole"
    start_tabulate(whole).wait()
    expected = {path.name: values_hash(path) for path in whole.glob("[!.]*.nc")}
    cores = os.cpu_count() or 1
    with ThreadPoolExecutor(cores) as pool:
        begin = time.perf_counter()
        list(pool.map(lambda n: start_tabulate(folder / f"timed-{n}").wait(), range(cores)))
        seconds = time.perf_counter() - begin

        def killed(seed: int, in_write: bool) -> str:
            own, draw = folder / str(seed), np.random.default_rng(seed)
            shutil.copytree(whole, own)
            while not kill_once(own, draw.choice(list(expected)) if in_write else None, seconds, draw):
                pass  # it had ended before
            outcome = "unharmed" if survived(own, expected) else "damaged"
            shutil.rmtree(own)
            return outcome

        ways = {"SIGKILL of `make tables`": False, "SIGKILL of `make tables` while it writes a table": True}
        result = []
        for done, in_write in ways.items():
            outcomes = pool.map(partial(killed, in_write=in_write), rng.integers(1 << 62, size=count).tolist())
            result.append(row(done, list(tqdm(outcomes, desc=done, total=count, delay=1.0, leave=False))))
    return result


def start_tabulate(folder: Path) -> subprocess.Popen:
    """What `make tables` starts, in a group of processes of its own."""
    folder.mkdir(exist_ok=True)
    config = folder / "run.toml"
    config.write_text(CONFIG, encoding="utf-8")
    command = [sys.executable, "-m", "pipeline.offline", "--config", config, "--tables", folder, "-o", folder]
    return subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )


def kill_once(folder: Path, written: str | None, seconds: float, rng: np.random.Generator) -> bool:
    """Kill a build within so many seconds from its start, or from when it begins to write that file."""
    process = start_tabulate(folder)
    while written is not None and process.poll() is None and not any(folder.glob(f".*.tmp-{written}")):
        time.sleep(2e-4)
    time.sleep(rng.uniform(0.0, seconds if written is None else WRITE))
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    return process.wait() == -signal.SIGKILL


def survived(folder: Path, expected: dict[str, str]) -> bool:
    try:
        return {path.name: values_hash(path) for path in folder.glob("[!.]*.nc")} == expected
    except ViscorollError:
        return False


def values_hash(path: Path) -> str:
    """Of a sealed table: names and values alone, as ``history`` tells when it was made."""
    if not seal_holds(path.read_bytes()):
        raise FileError(path, "has no seal that holds")
    return fingerprint(tables.load(path).drop_attrs())


def writers(done: str, count: int, path: Path) -> dict[str, Any]:
    """Two processes save one table over and over; every load between is one of theirs, whole."""
    made, expected = [grid(f"writer {n}") for n in range(2)], set()
    for table in made:
        tables.save(table, path)
        expected.add(fingerprint(tables.load(path)))

    def save_all(table: Any) -> None:
        while True:
            tables.save(table, path)

    processes = [get_context("fork").Process(target=save_all, args=(table,)) for table in made]
    for process in processes:
        process.start()
    try:
        outcomes = []
        for _ in range(count):
            whole = seal_holds(path.read_bytes()) and fingerprint(tables.load(path)) in expected
            outcomes.append("unharmed" if whole else "damaged")
        alive = all(process.is_alive() for process in processes)
    finally:
        for process in processes:
            process.kill()
            process.join()
    return row(done, outcomes if alive else ["a writer failed"])
