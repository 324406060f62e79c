"""Damage files as a bad night does, and count what goes unnoticed -> data/results/torture.json
(kept in git).

    python -m pipeline.evidence.torture [--config FILE] [--quick] [--only PART ...] [-o FILE]

Each part holds its sizes, the machine, and rows: what was done, how often, and how often the file
was refused, was unharmed, or was wrong: other values without a word, an error that is not the
package's own, a crash.  Sizes and seeds are in [torture] of the configuration, those of --quick in
[torture.quick].  Exit code 1 if anything was wrong.  pipeline/evidence/document/ puts the table
into docs/torture.md.
"""

import hashlib
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from threading import RLock
from typing import Any

import numpy as np
from numpy.random import Generator
from tqdm import tqdm

from viscoroll import ViscorollError, tables
from viscoroll.core.errors import FileError
from viscoroll.core.files import seal_matches
from viscoroll.presets import RUBBER_CYLINDER
from viscoroll.runs import read_run, run_ensemble, verify

from .. import offline
from ..stage import ROOT, Row
from .results import run_parts
from .timing import forked, peak_mb, processor_time

# --- what is done to files, and what a table then loads as ---

#: marks of the parts of an HDF5 file that lead to others: B-trees, heaps, symbol tables, object
#: headers
MARKS = re.compile(rb"TREE|HEAP|SNOD|GCOL|OHDR|OCHK|FRHP|BTHD|FHDB|FADB|FAHD|EAHD")
#: loads in one process, with so many bytes over what it has at the start
BATCH = 100
MEMORY = 1 << 30
# processes are forked and killed here: no thread beside this one, and no lock that a killed one may
# hold for ever
tqdm.monitor_interval = 0
tqdm.set_lock(RLock())
_FORK = get_context("fork")
Change = Callable[[bytes, Generator], bytes]


def fingerprint(table) -> str:
    """SHA-256 over all that a table holds."""
    return hashlib.sha256(repr(table.to_dict()).encode()).hexdigest()


def row(
    done: str, outcomes: Iterable[str], slowest: float | None = None, peak: float | None = None
) -> Row:
    """How often each outcome was met; whatever is neither "refused" nor "unharmed" is wrong."""
    count = Counter(outcomes)
    good = {name: count.pop(name, 0) for name in ("refused", "unharmed")}
    return {
        "done": done,
        "tried": sum(good.values()) + count.total(),
        **good,
        "wrong": count.total(),
        "how": [text[:200] for text, _ in count.most_common(5)],
        "slowest_s": slowest,
        "peak_mb": peak,
    }


def flip(content, rng):
    """One bit; an empty file gets a byte."""
    changed = bytearray(content or b"\0")
    position = int(rng.integers(8 * len(changed)))
    changed[position // 8] ^= 1 << position % 8
    return bytes(changed)


def truncate(content, rng):
    return content[: int(rng.integers(max(len(content), 1)))]


def edit(content, rng):
    """Random bytes into the first 4 kB, or behind the mark of a header or B-tree."""
    starts = [match.start() for match in MARKS.finditer(content)]
    first, size = (0, 4096) if rng.random() < 0.5 or not starts else (int(rng.choice(starts)), 128)
    changed = bytearray(content)
    for position in first + rng.integers(size, size=rng.integers(1, 17)):
        changed[min(int(position), len(content) - 1)] = int(rng.integers(256))
    return bytes(changed)


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[None]:
    """``folder`` as a tmpfs of that size; raises CalledProcessError where none can be had."""
    _told("mount", "-t", "tmpfs", "-o", f"size={max(size // 4096, 4) * 4096}", "tmpfs", folder)
    try:
        yield
    finally:
        _told("umount", folder)


def enlarge(disk: Path) -> None:
    _told("mount", "-o", "remount,size=64m", disk)


def _told(*command):
    subprocess.run(command, capture_output=True, check=True)


def ended(work: Callable[[], Any]) -> int:
    """Exit code of ``work`` in a process of its own: 2 for an error of a file, 1 for any other."""

    def run():
        try:
            work()
        except FileError:
            os._exit(2)

    process = _FORK.Process(target=run)
    process.start()
    process.join()
    return process.exitcode or 0


def killed(
    work: Callable[[], Any],
    seconds: float,
    rng: Generator,
    begun: Callable[[], bool] = lambda: True,
) -> bool:
    """Whether ``work`` was killed, within ``seconds`` after it had ``begun``; False where it had
    ended before.
    """
    process = _FORK.Process(target=work)
    process.start()
    while process.is_alive() and not begun():
        time.sleep(2e-4)
    time.sleep(rng.uniform(0.0, seconds))
    process.kill()
    process.join()
    return process.exitcode == -signal.SIGKILL


def trials(done: str, count: int, trial: Callable[[], str]) -> Row:
    """A row of so many outcomes."""
    return row(done, [trial() for _ in tqdm(range(count), desc=done, delay=1.0, leave=False)])


def damaged(
    done: str, count: int, path: Path, content: bytes, change: Change, rng: Generator
) -> Row:
    """Change a table over and over, load it in processes with bounded memory, and see what comes
    out.
    """
    path.write_bytes(content)
    expected = fingerprint(tables.load(path))
    found = []
    with tqdm(total=count, desc=done, delay=1.0, leave=False) as progress:
        while len(found) < count:
            seeds = rng.integers(1 << 62, size=min(BATCH, count - len(found))).tolist()
            for one in forked(loads, path, content, change, seeds, expected):
                found.append((one, 0.0, 0.0) if isinstance(one, str) else one)
                progress.update()
    outcomes, seconds, megabytes = zip(*found, strict=True)
    return row(done, outcomes, max(seconds), max(megabytes))


def loads(
    path: Path, content: bytes, change: Change, seeds: list[int], expected: str
) -> Iterator[tuple]:
    """(outcome, seconds of the processor, peak MB) of each seed."""
    present = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (present + MEMORY, present + MEMORY))
    for seed in seeds:
        path.write_bytes(change(content, np.random.default_rng(seed)))
        begin = processor_time()
        outcome = outcome_of(path, expected)
        yield outcome, processor_time() - begin, peak_mb()


def outcome_of(path: Path, expected: str) -> str:
    """What a user meets who loads the file."""
    try:
        found = fingerprint(tables.load(path))
    except FileError as error:
        return "refused" if "\n" not in str(error) else f"more than a line: {error}"
    except BaseException as error:
        return f"not the package's own error: {error!r}"
    return "unharmed" if found == expected else "other values without a word"


# --- tables: killed builds, two writers at once, damaged files ---

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


def of_tables(sizes):
    """What was done to tables and what came of it."""
    rng = np.random.default_rng(sizes["seed"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables.save(grid(), folder / "table.nc")
        content = (folder / "table.nc").read_bytes()
        found = [
            *kills(sizes["kills"], folder, rng),
            writers(sizes["writers"], folder / "both.nc"),
        ]
        ways = {
            "one bit flipped": (sizes["flips"], content, flip),
            "truncated": (sizes["truncations"], content, truncate),
            "1-16 bytes of headers and B-trees replaced": (sizes["edits"], content, edit),
            # as another program would have written it
            "truncated, no seal": (
                sizes["unsealed"],
                content[: content.rindex(b"\n", 0, -1)],
                truncate,
            ),
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


def grid(command: str | None = None):
    """A table whose file is headers for the most part."""
    return tables.build(
        RUBBER_CYLINDER, V=[0.1, 0.3, 2.0], delta=[-0.01, 0.0, 0.03], command=command
    )


def kills(count: int, folder: Path, rng: Generator) -> list[Row]:
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

    def kill(in_write):
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


def whole(path: Path):
    """A table whose seal holds."""
    if not seal_matches(path.read_bytes()):
        raise FileError(path, "has no seal that holds")
    return tables.load(path)


def writers(count: int, path: Path) -> Row:
    """Two processes save one table over and over; every load between is one of theirs, whole."""
    made = [grid(f"writer {n}") for n in range(2)]
    expected = set()
    for table in made:
        tables.save(table, path)
        expected.add(fingerprint(tables.load(path)))

    def save_all(table):
        while True:
            tables.save(table, path)

    def load():
        if not all(process.is_alive() for process in processes):
            return "a writer failed"
        return "unharmed" if fingerprint(whole(path)) in expected else "damaged"

    processes = [_FORK.Process(target=save_all, args=(table,)) for table in made]
    for process in processes:
        process.start()
    try:
        return trials("two processes save the same table at once", count, load)
    finally:
        for process in processes:
            process.kill()
            process.join()


# --- ensembles: killed runs, a full disk, damaged files; after each the same call goes on ---

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


def of_ensembles(sizes):
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

    def __init__(self, folder: Path, rng: Generator) -> None:
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


#: name -> function of the sizes that returns rows of done, tried, refused, unharmed, wrong,
#: slowest_s, peak_mb
PARTS = {"tables": of_tables, "ensembles": of_ensembles}


def harm(row: Row) -> str | None:
    """What is to be said of a row in which something went wrong."""
    return (
        f"{row['done']}: {row['wrong']} of {row['tried']} wrong: {row['how']}"
        if row["wrong"]
        else None
    )


if __name__ == "__main__":
    sys.exit(run_parts("torture", PARTS, __doc__, "torture.json", harm))
