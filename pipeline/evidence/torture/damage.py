"""Damage a table file that is there, load it in processes with bounded memory, and see what comes out."""

from __future__ import annotations

import hashlib
import re
import resource
import subprocess
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import Any

import numpy as np
from tqdm import tqdm

from viscoroll import tables
from viscoroll.core.errors import FileError

from ..timing import forked, peak_mb, processor_time

#: marks of the parts of an HDF5 file that lead to others: B-trees, heaps, symbol tables, object headers
MARKS = re.compile(rb"TREE|HEAP|SNOD|GCOL|OHDR|OCHK|FRHP|BTHD|FHDB|FADB|FAHD|EAHD")
#: loads in one process, with so many bytes over what it has at the start
BATCH, MEMORY = 100, 1 << 30
# processes are forked and killed here: no thread beside this one, and no lock that a killed one may hold for ever
tqdm.monitor_interval = 0
tqdm.set_lock(RLock())
Change = Callable[[bytes, np.random.Generator], bytes]


def fingerprint(table: Any) -> str:
    """SHA-256 over all that a table holds."""
    return hashlib.sha256(repr(table.to_dict()).encode()).hexdigest()


def row(done: str, outcomes: Iterable[str], slowest: float | None = None, peak: float | None = None) -> dict[str, Any]:
    """How often each outcome was met; whatever is neither "refused" nor "unharmed" is wrong."""
    count = Counter(outcomes)
    good = {name: count.pop(name, 0) for name in ("refused", "unharmed")}
    return {
        "done": done, "tried": sum(good.values()) + count.total(), **good, "wrong": count.total(),
        "how": [text[:200] for text, _ in count.most_common(5)], "slowest_s": slowest, "peak_mb": peak,
    }  # fmt: skip


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
def small_disk(folder: Path, size: int) -> Iterator[bool]:
    """``folder`` as a tmpfs of that size; False where none can be had."""
    options = ["-t", "tmpfs", "-o", f"size={max(size // 4096, 4) * 4096}", "tmpfs", str(folder)]
    try:
        mounted = subprocess.run(["mount", *options], capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        mounted = False
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", str(folder)], check=True)


def enlarge(disk: Path) -> None:
    subprocess.run(["mount", "-o", "remount,size=64m", str(disk)], check=True)


def damaged(
    done: str, count: int, path: Path, content: bytes, change: Change, rng: np.random.Generator
) -> dict[str, Any]:
    """Change a table over and over, load it in processes with bounded memory, and see what comes out."""
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


def loads(path: Path, content: bytes, change: Change, seeds: list[int], expected: str) -> Iterator[tuple]:
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
