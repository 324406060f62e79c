"""Ensembles from a run file: uncertain inputs, blocks of motions, and a results store.

A TOML file enters :func:`read_run` (:mod:`.runfile`, :mod:`.uncertain_inputs`,
:mod:`.run_rollers`).  :func:`run_ensemble` evaluates its blocks (:mod:`.run_store`) and writes them
to a store (:mod:`.run_store`, :mod:`.run_records`).  Results leave through :func:`open_run`,
:func:`export_netcdf` (:mod:`.run_results`) and Sobol indices (:mod:`.sensitivity`).

This file has the execution of a run, on threads of this process or on a dask cluster.  One task is
one block.  No more tasks are submitted than keep the workers busy, so that neither this process nor
a scheduler holds more than a few, however many blocks there are.  A repeated call completes the
store.  :func:`estimate` states the time, memory and disk space that a run takes, by a short trial
of it.
"""

import dataclasses
import logging
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent import futures
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any, Literal

import numpy as np

from ..core import (
    FileError,
    FilePath,
    Interrupted,
    ParameterError,
    ViscorollError,
    as_path,
    cancel_with,
    check_bool,
    describe_value,
    import_extra,
    thread_count,
)
from .run_records import Record, encoded
from .run_results import RunResults, export_netcdf, open_run, verify
from .run_rollers import roller_of
from .run_store import Store, block_content, block_inputs, locked, roll_inputs, warn_of_materials
from .runfile import Run, read_run

__all__ = [
    "Run",
    "RunResults",
    "estimate",
    "export_netcdf",
    "open_run",
    "read_run",
    "roll_inputs",
    "run_ensemble",
    "verify",
]

# --- Evaluation of the blocks of a run ---

#: Function that gives the task of a block, by its number, to an executor, and returns its future.
Submit = Callable[[int], Any]

#: Seconds between lines of progress where there is no terminal.
LINE_EVERY = 30.0
#: A cluster: "local", or the address of a dask scheduler, tcp://host:port, or the same with tls.
_CLUSTER = r"local|(tcp|tls)://([^/:[\]]+|\[[^/[\]]+\]):\d+"
#: Settings of local dask workers.  By default a worker returns each freed array to the system,
#: which takes as long as a block, and samples itself a hundred times a second.  glibc accepts no
#: larger second threshold.
_DASK_SETTINGS = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 2**30,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 2**25,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "500ms",
}


def run_ensemble(
    run: Run,
    path: FilePath,
    *,
    cluster: str | None = None,
    threads: int | None = None,
    progress: bool | Literal["lines"] = False,
) -> int:
    """Evaluate all blocks that the store does not hold yet, then write the summaries.

    After an interruption of any kind (a kill, a full disk, a damaged file) the same call completes
    the store: blocks on disk are read and compared with their SHA-256, the others are evaluated
    again.  A call with a larger ``n`` in a run that is otherwise the same ("random"; "sobol" to
    powers of two) extends the store to that of the larger run, byte for byte.

    Parameters
    ----------
    run : a run of :func:`runs.read_run`.
    path : folder of the results; it is created if it does not exist, and blocks, records and
        summaries are written there.
    cluster : None: threads of this process.  "local": processes of this machine.
        "tcp://host:port": a running dask scheduler, whose workers see ``path`` on a shared disk.
    threads : threads or local processes; default ``$VISCOROLL_THREADS`` or the number of cores
        available.  Ignored with the address of a scheduler, which has workers of its own.
    progress : True: draw a progress bar on standard error.  "lines": write a line of progress there
        every half minute, for a log.  False: neither.

    Returns
    -------
    int
        Number of blocks that this call evaluated; 0 if the store held all of them.  The summaries
        are complete then.

    Raises
    ------
    FileError
        The folder holds something else or cannot be written, another process writes to it, the
        cluster is lost, or a material does not allow its inputs.
    ParameterError
        An unknown cluster, ``threads`` that is no whole number >= 1, another ``progress``, or
        inputs that a motion does not allow.
    MissingDependencyError
        If zarr, or dask for a cluster, is not installed.
    Interrupted
        At Ctrl-C (a KeyboardInterrupt) while blocks are evaluated, within a second: finished blocks
        are kept, and the message states the number of their motions.

    Warns
    -----
    ModelWarning
        Of motions beyond the model or the measured bands of the materials
        (:func:`.run_store.warn_of_materials`).

    Notes
    -----
    The files are the same, byte for byte, for any number of threads or workers and after any number
    of kills (``tests/runs/test_run_store.py``); a motion is as accurate as
    :func:`viscoroll.ensemble` makes it.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> vr.runs.run_ensemble(run, "results.zarr", threads=1)
    1
    >>> vr.runs.run_ensemble(run, "results.zarr", threads=1)  # the block is there
    0
    """
    if str(progress) != "lines":
        progress = check_bool("progress", progress)
    _require_run(run)
    store = Store(as_path(path).absolute(), run)
    import_extra("zarr", "runs")
    store.refuse_other()
    # an unknown cluster is refused first
    with _executor(store, cluster, threads) as (submit, workers):
        warn_of_materials(run)
        with locked(store.root), _progress_bar(run, progress) as advance:
            store.start()
            evaluated = added = 0
            try:
                for motions in _evaluate_missing(store, submit, workers, advance):
                    evaluated += 1
                    added += motions
                    advance(motions)
            except KeyboardInterrupt:
                kept = f"{added} of {run.settings.n} motions were added to {path}"
                raise Interrupted(f"interrupted: {kept}; to resume, repeat the run") from None
            store.finish()
    return evaluated


def _evaluate_missing(
    store: Store, submit: Submit, workers: int, advance: Callable[..., Any]
) -> Iterator[int]:
    """Evaluate the missing blocks on an executor, and report each one that is finished and stored.

    At most two blocks for each worker are submitted at a time; the next ones follow as blocks
    finish.

    store: :class:`Store`, the store of the run.
    submit: function (number of a block) -> future of its number of motions.
    workers: number of workers that evaluate blocks.
    advance: function (number of motions, on_disk=True) of the progress bar, whose result is
        ignored.  It is called here for motions that were on disk before; for those that are yielded
        the caller calls it.
    Yields the number of motions of each evaluated block, in the order in which they finish.
    Raises what the evaluation of a block raises; blocks that are not running yet are then
    cancelled, as they are if the caller stops the iteration.
    """
    running = set()
    checked = 0  # motions before the block at hand
    try:
        for block in store.missing():
            start, stop = store.run.edges(block)
            advance(start - checked, on_disk=True)
            checked = stop
            running.add(submit(block))
            if len(running) >= 2 * workers:  # the task that each works on, and the next
                done, running = futures.wait(running, return_when=futures.FIRST_COMPLETED)
                yield from (future.result() for future in done)
        advance(store.run.settings.n - checked, on_disk=True)
        yield from (future.result() for future in futures.as_completed(running))
    finally:
        for future in running:
            future.cancel()


def _require_run(run: Any) -> None:
    """Raise ParameterError for what is no :class:`.runfile.Run`, as the path of its file."""
    if not isinstance(run, Run):
        raise ParameterError("run", describe_value(run), "a Run, as runs.read_run(path) returns it")


@contextmanager
def _executor(
    store: Store, cluster: str | None, threads: int | None
) -> Iterator[tuple[Submit, int]]:
    """Open the executor of the tasks; a context manager.

    On threads, an error or Ctrl-C in the body of the ``with`` makes running blocks stop before
    their next part, and the threads are not awaited; else the executor is closed when its tasks are
    done.

    store: :class:`Store`, store of the run.
    cluster: None (threads of this process), "local" (dask processes of this machine) or the address
        of a dask scheduler, "tcp://host:port" or "tls://host:port".
    threads: number of threads or local processes, >= 1; None: ``$VISCOROLL_THREADS``, else all
        cores available; ignored with an address.
    Yields (function (number of a block) -> :class:`concurrent.futures.Future` of its evaluation;
    number of workers, on a cluster that of all their threads, >= 1).
    Raises ParameterError for an unknown cluster or a wrong ``threads``, FileError for a scheduler
    that does not answer, has no workers or is lost while blocks run (on a cluster any OSError of
    the body of the ``with`` counts as that), MissingDependencyError without dask.
    """
    if cluster is None:
        interrupted = threading.Event()
        workers = thread_count(threads)
        pool: Any = futures.ThreadPoolExecutor(
            workers, initializer=cancel_with, initargs=(interrupted,)
        )
        try:
            yield partial(pool.submit, store.evaluate), workers
        except BaseException:
            interrupted.set()  # running blocks stop
            raise
        finally:
            pool.shutdown(wait=not interrupted.is_set(), cancel_futures=True)
        return
    if not re.fullmatch(_CLUSTER, str(cluster)):
        raise ParameterError(
            "cluster", repr(cluster), "'local', or 'tcp://host:port' of a dask scheduler"
        )
    distributed = import_extra("distributed", "cluster")
    failed = (
        "no connection to this cluster ({}): if it is an address, start a scheduler there first"
    )
    try:
        with ExitStack() as stack:
            for name in ("distributed", "distributed.client"):
                logger = logging.getLogger(name)
                stack.callback(logger.setLevel, logger.level)
                logger.setLevel(logging.CRITICAL)  # an error is raised, not logged
            client = stack.enter_context(_client(distributed, cluster, threads))
            failed = "the cluster or a worker was lost ({}): repeat the call or command to resume"
            workers = sum(client.nthreads().values())
            if not workers:
                raise FileError(
                    cluster, f"this cluster has no workers: start some by `dask worker {cluster}`"
                )
            # not pure: equal calls are evaluated again, since a block may have been lost on disk;
            # a task is given to other workers three times after its worker died
            with client.get_executor(pure=False, retries=3) as pool:
                shared = client.scatter(store, broadcast=True)  # which workers resolve to the store
                yield partial(pool.submit, Store.evaluate, shared), workers
    except ViscorollError:
        raise
    except (
        OSError,
        TimeoutError,
        futures.CancelledError,
        distributed.scheduler.KilledWorker,
    ) as error:
        text = " ".join((str(error) or type(error).__name__).split())
        raise FileError(cluster, failed.format(f"{text:.200}")) from error


def _client(distributed: Any, cluster: str, threads: int | None) -> Any:
    """Return a ``distributed.Client``: of a running scheduler, or of workers that are started on
    this machine.

    distributed: the module ``distributed``.
    cluster: "local" or the address of a scheduler.
    threads: number of local processes, of one thread each; None: ``$VISCOROLL_THREADS``, else all
        cores available.  Ignored for a running scheduler, which has workers of its own.
    Raises OSError or TimeoutError if no scheduler answers within 10 s, ParameterError for
    ``threads`` or ``$VISCOROLL_THREADS`` that is no whole number >= 1.  Local workers end when the
    client is closed.
    """
    if cluster != "local":
        return distributed.Client(cluster, timeout=10)
    import dask

    with dask.config.set(_DASK_SETTINGS):
        return distributed.Client(
            n_workers=thread_count(threads),
            threads_per_worker=1,
            dashboard_address=":0",  # any free port: a fixed one may be taken
            silence_logs=logging.CRITICAL,
        )


@contextmanager
def _progress_bar(run: Run, progress: bool | Literal["lines"]) -> Iterator[Callable[..., Any]]:
    """Draw the progress of a run on standard error; a context manager.

    run: :class:`runs.Run`, whose motions are counted.
    progress: False (nothing is drawn), True (a bar) or "lines" (a line every half minute, the first
        one after that time).
    Yields a function (number of motions, on_disk=False) -> None that advances it; motions that were
    on disk do not count in the rate, from which the time left is estimated.
    """
    from tqdm import tqdm

    settings = {"unit": " motions", "unit_scale": True, "smoothing": 0.05}
    if progress == "lines":
        line = "viscoroll: {n_fmt} of {total_fmt} motions, {percentage:.0f} %, {remaining} left\n"
        settings |= {"delay": LINE_EVERY, "mininterval": LINE_EVERY, "bar_format": line}
    with tqdm(total=run.settings.n, disable=not progress, **settings) as bar:

        def advance(motions: int, on_disk: bool = False) -> None:
            """Advance the bar.

            motions: number of motions to add to those that the bar counts, >= 0.
            on_disk: whether they were on disk before this call, so that they do not count in the
                rate.
            """
            if on_disk and progress:  # a disabled bar has no attribute initial
                bar.initial += motions
            bar.update(motions)

        yield advance


# --- Time, memory and disk space that a run takes, from a short trial of it ---

#: Motions of the trial by method; they take some tenths of a second.
_TRIAL = {"flow": 1 << 17, "integrate": 1 << 12}


@dataclasses.dataclass(frozen=True)
class Estimate:
    """Time, memory and disk space that a run takes.

    Attributes
    ----------
    run : the :class:`runs.Run`.
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
    law_seconds: float

    def __str__(self) -> str:
        """Return the estimate in words, five lines.

        They are: motions, blocks and method; time in a fitting unit, and how much of it the laws of
        covers take unless that is 0; memory in MB; disk space in MB; size of the trial.
        """
        run = self.run
        laws = f", of which {_duration(self.law_seconds)} for the contact laws of the covers"
        laws *= self.law_seconds > 0.0
        blocks = f"{run.blocks} block{'s' * (run.blocks != 1)}"
        return (
            f"{run.settings.n} motions in {blocks} of {run.block} motions, method {run.method}\n"
            f"time    about {_duration(self.seconds)} on {self.workers} thread(s){laws}\n"
            f"memory  about {self.memory / 1e6:.0f} MB at most\n"
            f"disk    about {self.stored / 1e6:.1f} MB\n"
            f"estimated from a trial of {self.trial} motion(s); nothing was written"
        )


def estimate(run: Run, threads: int | None = None) -> Estimate:
    """Roll some motions of the first block and scale their time, memory and size up to the run.

    They are rolled twice, and the second time counts: the first one contains work that a process
    does once, such as imports, compilation, laws and a flow map, which the estimate leaves out.
    The time of the laws of covers, which may be long, is measured by itself and added once.

    Parameters
    ----------
    run : a run of :func:`runs.read_run`.
    threads : number of threads that the run will have; None: ``$VISCOROLL_THREADS``, else all cores
        available.

    Returns
    -------
    Estimate
        Time in s, memory and size of the store in bytes; printed, it states them in words.  Nothing
        is written.  Memory is the largest that this process has had so far, plus the motions of the
        blocks that the workers roll at the same time; the size leaves out the summaries.

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
        Of motions beyond the model or the measured bands of the materials
        (:func:`.run_store.warn_of_materials`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.runs.estimate(vr.runs.read_run(vr.datasets.path("run.toml")), threads=1)
    >>> found.trial, found.workers, found.seconds > 0.0
    (16, 1, True)
    """
    _require_run(run)
    workers = min(thread_count(threads), run.blocks)
    warn_of_materials(run)
    trial = min(run.block, _TRIAL[run.method])
    short = run._with_settings(block=trial)
    block_content(short, 0)
    law_seconds = _time_of_laws(short)
    start = time.perf_counter()
    files, summary = block_content(short, 0)
    record = len(encoded(Record("", {}, summary=summary)))
    seconds = time.perf_counter() - start
    stored = sum(map(len, files.values())) * (run.settings.n / trial) + record * run.blocks
    # the peak contains the motions of the trial already
    memory = _peak_memory() + (workers * run.block - trial) * run.bytes_a_motion
    # blocks of the worker that has most of them, rounded up
    motions_a_worker = min(-(-run.blocks // workers) * run.block, run.settings.n)
    seconds = seconds * motions_a_worker / trial + law_seconds
    return Estimate(
        run=run,
        workers=workers,
        trial=trial,
        seconds=seconds,
        memory=memory,
        stored=stored,
        law_seconds=law_seconds,
    )


def _time_of_laws(run: Run) -> float:
    """Return the seconds that the laws of the covers of the first block take; 0.0 of half-spaces.

    A cover is a layer of finite thickness.  A run with one cover needs one law; covers that differ
    have laws at nodes of thickness (and of Poisson's ratio nu, if that differs), between which they
    are interpolated.  One law, that of the largest thickness and the largest nu, is computed here,
    and its time is multiplied by the number of laws.  A table of the coupled solution is made here.

    run: :class:`runs.Run`, of half-spaces or of covers.
    Raises ParameterError for inputs of the first block that no cylinder allows or a layer too thin
    for its law, FileError for those that no material allows.
    """
    from ..laws import count_laws
    from ..laws.cover_rows import cover_rows

    scene = roller_of(run.path, run.inputs.filled(block_inputs(run, 0))).scene()
    start = time.perf_counter()
    if scene.tabulated:
        scene.rolling_law  # noqa: B018  # makes the table, or finds it
        return time.perf_counter() - start
    cover = scene.cover
    if cover is None:
        return 0.0
    cover_rows(cover.of_thickness(np.max(cover.thickness), np.max(cover.nu)))
    return count_laws(cover) * (time.perf_counter() - start)


def _peak_memory() -> float:
    """Return the largest resident memory of this process so far, in bytes, as the system counts it.

    On Windows, where Python does not tell it, the result is that of a process after the trial
    (libraries, compiled kernels, the trial itself) on Linux, 4e8 bytes.
    """
    try:
        import resource
    except ImportError:
        return 4e8
    # macOS counts bytes, other systems KiB
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (
        1 if sys.platform == "darwin" else 1024
    )


def _duration(seconds: float) -> str:
    """Return a duration as a text, in the largest unit of days, hours, minutes, seconds of which it
    has at least two.

    seconds: the duration, s, >= 0.
    Returns a text as "2.5 hours", with one decimal; in seconds, also below two, with two digits, as
    "0.013 seconds".
    """
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.2g} seconds"
