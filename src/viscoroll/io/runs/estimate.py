"""Time, memory and disk space that a run takes, from a short trial of it: :func:`estimate`."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace

import msgspec
import numpy as np

from ...core.blocks import thread_count
from .evaluate import block_inputs, warn_of_materials
from .records import Record, encoded
from .rollers import roller_of
from .runfile import Run
from .store import block_content

#: Motions of the trial by method; they take some tenths of a second.
_TRIAL = {"flow": 1 << 17, "integrate": 1 << 12}
#: Resident bytes of a process after the trial (libraries, compiled kernels, the trial itself), measured on Linux; used
#: where the system does not tell.
_USUAL_RESIDENT = 4e8


@dataclass(frozen=True)
class Estimate:
    """Time, memory and disk space that a run takes.

    Attributes
    ----------
    run : the :class:`Run`.
    workers : threads that the time is for, at most one for each block.
    trial : number of motions that were rolled to measure it.
    seconds : wall-clock time, s.
    memory : largest resident memory, bytes.
    stored : size of the store, bytes.
    law_seconds : part of ``seconds`` that the laws of covers take, once; 0.0 of half-spaces.
    """

    run: Run
    workers: int
    trial: int
    seconds: float
    memory: float
    stored: float
    law_seconds: float = 0.0

    def __str__(self) -> str:
        """Return the estimate in words, five lines.

        They are: motions, blocks and method; time in a fitting unit, and how much of it the laws of covers take unless
        that is 0; memory in MB; disk space in MB; size of the trial.
        """
        run = self.run
        laws = f", {_duration(self.law_seconds)} of it once for the laws of covers" if self.law_seconds else ""
        blocks = f"{run.blocks} block" + "s" * (run.blocks != 1)
        return (
            f"{run.settings.n} motions in {blocks} of {run.block}, method {run.method}\n"
            f"time    about {_duration(self.seconds)} on {self.workers} workers{laws}\n"
            f"memory  about {self.memory / 1e6:.0f} MB at a time\n"
            f"disk    about {self.stored / 1e6:.1f} MB\n"
            f"from a trial of {self.trial} motions; nothing was written"
        )


def estimate(run: Run, threads: int | None = None) -> Estimate:
    """Roll some motions of the first block and scale their time, memory and size up to the run.

    They are rolled twice, and the second time counts: the first one contains work that a process does once, such as
    imports, compilation, laws and a flow map, which the estimate leaves out.  The time of the laws of covers, which may
    be long, is measured by itself and added once.

    Parameters
    ----------
    run : a run of :func:`read_run`.
    threads : number of threads that the run will have; None: ``$VISCOROLL_THREADS``, else all cores available.

    Returns
    -------
    Estimate
        Time in s, memory and size of the store in bytes; printed, it states them in words.  Nothing is written.
        Memory is the largest that this process has had so far, plus the motions of the blocks that the workers roll at
        the same time; the size leaves out the summaries.

    Raises
    ------
    ParameterError
        ``threads`` that is no whole number >= 1, or inputs that a motion does not allow.
    FileError
        Inputs that a material does not allow.
    MissingDependencyError
        If the run keeps every motion and zarr is not installed.

    Warns
    -----
    ModelWarning
        Of motions beyond the model or the measured bands of the materials (:func:`.evaluate.warn_of_materials`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.runs.estimate(vr.runs.read_run(vr.datasets.path("run.toml")), threads=1)
    >>> found.trial, found.workers, found.seconds > 0.0
    (16, 1, True)
    """
    workers = min(thread_count(threads), run.blocks)
    warn_of_materials(run)
    trial = min(run.block, _TRIAL[run.method])
    short = replace(run, settings=msgspec.structs.replace(run.settings, block=trial))
    block_content(short, 0)
    law_seconds = _time_of_laws(short)
    start = time.perf_counter()
    files, summary, _ = block_content(short, 0)
    record = len(encoded(Record("", {}, summary=summary)))
    seconds = time.perf_counter() - start
    stored = sum(map(len, files.values())) * (run.settings.n / trial) + record * run.blocks
    memory = _peak_memory() + (workers * run.block - trial) * run.bytes_a_motion
    motions_a_worker = min(-(-run.blocks // workers) * run.block, run.settings.n)
    seconds = seconds * motions_a_worker / trial + law_seconds
    return Estimate(run, workers, trial, seconds, memory, stored, law_seconds)


def _time_of_laws(run: Run) -> float:
    """Return the seconds that the laws of the covers of the first block take; 0.0 of half-spaces.

    A cover is a layer of finite thickness.  A run with one cover needs one law; covers that differ have laws at nodes
    of thickness (and of Poisson's ratio nu, if that differs), between which they are interpolated.  One law, that of
    the largest thickness and the largest nu, is computed here, and its time is multiplied by the number of laws.

    run: :class:`Run`, of half-spaces or of covers.
    Raises ParameterError for inputs of the first block that no cylinder allows or a layer too thin for its law,
    FileError for those that no material allows.
    """
    from ...materials.law.cover_rows import cover_rows
    from ...materials.law.per_element import count_laws

    cover = roller_of(run.path, run.inputs.filled(block_inputs(run, 0))).scene().cover
    if cover is None:
        return 0.0
    start = time.perf_counter()
    cover_rows(cover.of_thickness(np.max(cover.thickness), np.max(cover.nu)))
    return count_laws(cover) * (time.perf_counter() - start)


def _peak_memory() -> float:
    """Return the largest resident memory of this process so far, in bytes, as the system counts it.

    On Windows, where Python does not tell it, :data:`_USUAL_RESIDENT` is returned, 4e8 bytes.
    """
    try:
        import resource
    except ImportError:
        return _USUAL_RESIDENT
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def _duration(seconds: float) -> str:
    """Return a duration as a text, in the largest unit of days, hours, minutes, seconds of which it has at least two.

    seconds: the duration, s, >= 0.
    Returns a text as "2.5 hours", with one decimal; in seconds, also below two, with two digits, as "0.013 seconds".
    """
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.2g} seconds"
