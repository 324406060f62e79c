"""What a run will take, from a short trial of it: nothing is written."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace

import msgspec

from ...core.blocks import thread_count
from .evaluate import look_at_materials
from .records import Record, encoded
from .runfile import Run
from .store import made

#: motions of the trial, mapped and integrated: some tenths of a second
_TRIAL = {"flow": 1 << 17, "integrate": 1 << 12}
#: bytes that a process holds after it: libraries, machine code, the trial
_USUAL_RESIDENT = 4e8


@dataclass(frozen=True)
class Estimate:
    """Memory, time and bytes on disk of ``run``; ``trial`` motions were rolled to tell."""

    run: Run
    workers: int
    trial: int
    seconds: float
    memory: float
    stored: float

    def __str__(self) -> str:
        run = self.run
        return (
            f"{run.settings.n} motions in {run.blocks} blocks of {run.block}, method {run.method}\n"
            f"time    about {_duration(self.seconds)} on {self.workers} workers\n"
            f"memory  about {self.memory / 1e6:.0f} MB at a time\n"
            f"disk    about {self.stored / 1e6:.1f} MB\n"
            f"from a trial of {self.trial} motions; nothing was written"
        )


def estimate(run: Run, threads: int | None = None) -> Estimate:
    """Roll some motions of the first block and scale up.

    They are rolled twice, and the second time counts: what a process does once, as to compile, to import and to fill
    tables, would be scaled up with them.
    """
    workers = min(thread_count(threads), run.blocks)
    look_at_materials(run)
    trial = min(run.block, _TRIAL[run.method])
    few = replace(run, settings=msgspec.structs.replace(run.settings, block=trial))
    made(few, 0)
    begun = time.perf_counter()
    files, summary, _ = made(few, 0)
    record = len(encoded(Record("", {}, summary=summary)))
    seconds = time.perf_counter() - begun
    stored = sum(map(len, files.values())) * (run.settings.n / trial) + record * run.blocks
    memory = _most_resident() + (workers * run.block - trial) * run.bytes_a_motion
    motions_a_worker = min(-(-run.blocks // workers) * run.block, run.settings.n)
    return Estimate(run, workers, trial, seconds * motions_a_worker / trial, memory, stored)


def _most_resident() -> float:
    """Bytes that this process has held at most; where the system does not tell, what it takes on Linux."""
    try:
        import resource
    except ImportError:
        return _USUAL_RESIDENT
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def _duration(seconds: float) -> str:
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.2g} seconds"
