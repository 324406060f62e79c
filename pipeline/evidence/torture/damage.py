"""What is done to files: processes that are killed, small disks, changed bytes; and what a table
then loads as.
"""

from __future__ import annotations

import hashlib
import os
import re
import resource
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from threading import RLock
from typing import Any

import numpy as np
from tqdm import tqdm

from viscoroll import tables
from viscoroll.core.errors import FileError

from ..timing import forked, peak_mb, processor_time

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
Change = Callable[[bytes, np.random.Generator], bytes]


def fingerprint(table: Any) -> str:
    """SHA-256 over all that a table holds."""
    return hashlib.sha256(repr(table.to_dict()).encode()).hexdigest()


def row(
    done: str, outcomes: Iterable[str], slowest: float | None = None, peak: float | None = None
) -> dict[str, Any]:
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


def unsealed(content: bytes) -> bytes:
    """A table as another program would have written it: without the seal."""
    return content[: content.rindex(b"\n", 0, -1)]


def flip(content: bytes, rng: np.random.Generator) -> bytes:
    """One bit; an empty file gets a byte."""
    changed = bytearray(content or b"\0")
    position = int(rng.integers(8 * len(changed)))
    changed[position // 8] ^= 1 << position % 8
    return bytes(changed)


def truncate(content: bytes, rng: np.random.Generator) -> bytes:
    return content[: int(rng.integers(max(len(content), 1)))]


def edit(content: bytes, rng: np.random.Generator) -> bytes:
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


def _told(*command: str | Path) -> None:
    subprocess.run(command, capture_output=True, check=True)


def ended(work: Callable[[], Any]) -> int:
    """Exit code of ``work`` in a process of its own: 2 for an error of a file, 1 for any other."""

    def run() -> None:
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
    rng: np.random.Generator,
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


def trials(done: str, count: int, trial: Callable[[], str]) -> dict[str, Any]:
    """A row of so many outcomes."""
    return row(done, [trial() for _ in tqdm(range(count), desc=done, delay=1.0, leave=False)])


def damaged(
    done: str, count: int, path: Path, content: bytes, change: Change, rng: np.random.Generator
) -> dict[str, Any]:
    """Change a table over and over, load it in processes with bounded memory, and see what comes
    out.
    """
    path.write_bytes(content)
    expected = fingerprint(tables.load(path))
    found: list[tuple[str, float, float]] = []
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
