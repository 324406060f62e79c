"""Evaluation of the blocks of a run, on threads of this process or on a dask cluster: :func:`run_ensemble`.

One task is one block.  No more tasks are submitted than keep the workers busy, so that neither this process nor a
scheduler holds more than a few, however many blocks there are.
"""

from __future__ import annotations

import logging
import re
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from ...core.blocks import cancel_with, thread_count
from ...core.checks import check_bool
from ...core.errors import FileError, Interrupted, ParameterError, ViscorollError
from ...core.extras import import_extra
from .evaluate import warn_of_materials
from .runfile import Run
from .store import Store, locked

#: Tasks submitted for each worker: the one that it works on and the next.
_TASKS_PER_WORKER = 2
#: Number of times that dask gives a task to another worker after its worker died.
_RETRIES = 3
#: Seconds between lines of progress where there is no terminal.
LINE_EVERY = 30.0
#: Address of a dask scheduler: tcp://host:port, or the same with tls.
_ADDRESS = re.compile(r"(tcp|tls)://([^/:[\]]+|\[[^/[\]]+\]):\d+")
#: Settings of local dask workers.  By default a worker returns each freed array to the system, which takes as long as
#: a block, and samples itself a hundred times a second.  glibc accepts no larger second threshold.
_DASK_SETTINGS = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 2**30,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 2**25,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "500ms",
}


def run_ensemble(
    run: Run, path: str | PathLike[str], *, cluster: str | None = None, threads: int | None = None,
    progress: bool | Literal["lines"] = False,
) -> int:  # fmt: skip
    """Evaluate all blocks that the store does not hold yet, then write the summaries.

    After an interruption of any kind (a kill, a full disk, a damaged file) the same call completes the store: blocks
    on disk are read and compared with their SHA-256, the others are evaluated again.  A call with a larger ``n`` in a
    run that is otherwise the same ("random"; "sobol" to powers of two) extends the store to that of the larger run,
    byte for byte.

    Parameters
    ----------
    run : a run of :func:`read_run`.
    path : folder of the results; it is created if it does not exist, and blocks, records and summaries are written
        there.
    cluster : None: threads of this process.  "local": processes of this machine.  "tcp://host:port": a running dask
        scheduler, whose workers see ``path`` on a shared disk.
    threads : threads or local processes; default ``$VISCOROLL_THREADS`` or the number of cores available.  Ignored with
        the address of a scheduler, which has workers of its own.
    progress : True: draw a progress bar on standard error.  "lines": write a line of progress there every half minute,
        for a log.  False: neither.

    Returns
    -------
    int
        Number of blocks that this call evaluated; 0 if the store held all of them.  The summaries are complete then.

    Raises
    ------
    FileError
        The folder holds something else or cannot be written, another process writes to it, the cluster is lost, or a
        material does not allow its inputs.
    ParameterError
        An unknown cluster, ``threads`` that is no whole number >= 1, another ``progress``, or inputs that a motion does
        not allow.
    MissingDependencyError
        If zarr, or dask for a cluster, is not installed.
    Interrupted
        At Ctrl-C (a KeyboardInterrupt) while blocks are evaluated, within a second: finished blocks are kept, and the
        message states their number.

    Warns
    -----
    ModelWarning
        Of motions beyond the model or the measured bands of the materials (:func:`.evaluate.warn_of_materials`).

    Notes
    -----
    The files are the same, byte for byte, for any number of threads or workers and after any number
    of kills (``tests/runs/test_run_store.py``); a motion is as accurate as :func:`viscoroll.ensemble` makes it.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> vr.runs.run_ensemble(run, "results.zarr", threads=1)
    1
    >>> vr.runs.run_ensemble(run, "results.zarr", threads=1)  # the block is there
    0
    """
    if progress != "lines":
        progress = check_bool("progress", progress)
    store = Store(Path(path).absolute(), run)
    import_extra("zarr", "runs")
    store.refuse_other()
    with _executor(store, cluster, threads) as (pool, workers, shared):  # an unknown cluster is refused first
        warn_of_materials(run)
        with locked(store.root), _progress_bar(run, progress) as advance:
            store.start()
            evaluated = 0
            try:
                for motions in _evaluate_missing(store, shared, pool, workers, advance):
                    evaluated += 1
                    advance(motions)
            except KeyboardInterrupt:
                kept = f"{evaluated} of {run.blocks} blocks are complete and are kept in {path}"
                raise Interrupted(f"interrupted: {kept}; the same call resumes the run") from None
            store.finish()
    return evaluated


def _evaluate_missing(
    store: Store, shared: Any, pool: Executor, workers: int, advance: Callable[..., Any]
) -> Iterator[int]:
    """Evaluate the missing blocks on an executor, and report each one that is finished and stored.

    At most two blocks for each worker are submitted at a time; the next ones follow as blocks finish.

    store: :class:`Store`, the store of the run.
    shared: the same store, or, on a cluster, dask's reference to it (a Future), which workers resolve to the store.
    pool: :class:`concurrent.futures.Executor`, on which the blocks are evaluated.
    workers: its number of workers.
    advance: function (number of motions, on_disk=True) of the progress bar, whose result is ignored.  It is called here
        for motions that were on disk before; for those that are yielded the caller calls it.
    Yields the number of motions of each evaluated block, in the order in which they finish.
    Raises what the evaluation of a block raises; blocks that are not running yet are then cancelled, as they are if the
    caller stops the iteration.
    """
    running: set[Future[int]] = set()
    checked = 0  # motions before the block at hand
    try:
        for block in store.missing():
            start, stop = store.run.edges(block)
            advance(start - checked, on_disk=True)
            checked = stop
            running.add(pool.submit(Store.evaluate, shared, block))
            if len(running) >= _TASKS_PER_WORKER * workers:
                done, running = wait(running, return_when=FIRST_COMPLETED)
                yield from (future.result() for future in done)
        advance(store.run.settings.n - checked, on_disk=True)
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            yield from (future.result() for future in done)
    finally:
        for future in running:
            future.cancel()


@contextmanager
def _executor(store: Store, cluster: str | None, threads: int | None) -> Iterator[tuple[Executor, int, Any]]:
    """Open the executor of the tasks; a context manager.

    On threads, an error or Ctrl-C in the body of the ``with`` makes running blocks stop before their next part, and the
    threads are not awaited; else the executor is closed when its tasks are done.

    store: :class:`Store`, store of the run.
    cluster: None (threads of this process), "local" (dask processes of this machine) or the address of a dask
        scheduler, "tcp://host:port" or "tls://host:port".
    threads: number of threads or local processes, >= 1; None: ``$VISCOROLL_THREADS``, else all cores available; ignored
        with an address.
    Yields (a :class:`concurrent.futures.Executor`; its number of workers, on a cluster that of all their threads, >= 1;
    the first argument of its tasks: the store itself for threads, else dask's reference to it).
    Raises ParameterError for an unknown cluster or a wrong ``threads``, FileError for a scheduler that does not answer,
    has no workers or is lost while blocks run (on a cluster any OSError of the body of the ``with`` counts as that),
    MissingDependencyError without dask.
    """
    if cluster is None:
        interrupted = threading.Event()
        workers = thread_count(threads)
        pool = ThreadPoolExecutor(workers, initializer=cancel_with, initargs=(interrupted,))
        try:
            yield pool, workers, store
        except BaseException:
            interrupted.set()  # running blocks stop
            raise
        finally:
            pool.shutdown(wait=not interrupted.is_set(), cancel_futures=True)
        return
    if cluster != "local" and not _ADDRESS.fullmatch(cluster):
        raise ParameterError("cluster", repr(cluster), "'local' or 'tcp://host:port'")
    distributed = import_extra("distributed", "cluster")
    try:
        with ExitStack() as stack:
            for name in ("distributed", "distributed.client"):
                logger = logging.getLogger(name)
                stack.callback(logger.setLevel, logger.level)
                logger.setLevel(logging.CRITICAL)  # an error is raised, not logged
            client = stack.enter_context(_client(distributed, cluster, threads))
            workers = sum(client.nthreads().values())
            if not workers:
                raise FileError(cluster, "this cluster has no workers")
            with client.get_executor(pure=False, retries=_RETRIES) as pool:
                yield pool, workers, client.scatter(store, broadcast=True)
    except ViscorollError:
        raise
    except (OSError, TimeoutError, CancelledError, distributed.scheduler.KilledWorker) as error:
        text = " ".join((str(error) or type(error).__name__).split())
        raise FileError(
            cluster, f"the connection to the cluster was lost ({text:.200}): the same command resumes the run"
        ) from error


def _client(distributed: Any, cluster: str, threads: int | None) -> Any:
    """Return a ``distributed.Client``: of a running scheduler, or of workers that are started on this machine.

    distributed: the module ``distributed``.
    cluster: "local" or the address of a scheduler.
    threads: number of local processes, of one thread each; None: ``$VISCOROLL_THREADS``, else all cores available.
        Ignored for a running scheduler, which has workers of its own.
    Raises OSError or TimeoutError if no scheduler answers within 10 s, ParameterError for ``threads`` or
    ``$VISCOROLL_THREADS`` that is no whole number >= 1.  Local workers end when the client is closed.
    """
    if cluster != "local":
        return distributed.Client(cluster, timeout=10)
    import dask

    with dask.config.set(_DASK_SETTINGS):
        return distributed.Client(
            n_workers=thread_count(threads), threads_per_worker=1, dashboard_address=":0", silence_logs=logging.CRITICAL
        )


@contextmanager
def _progress_bar(run: Run, progress: bool | Literal["lines"]) -> Iterator[Callable[..., Any]]:
    """Draw the progress of a run on standard error; a context manager.

    run: :class:`Run`, whose motions are counted.
    progress: False (nothing is drawn), True (a bar) or "lines" (a line every half minute, the first one after that
        time).
    Yields a function (number of motions, on_disk=False) -> None that advances it; motions that were on disk do not
    count in the rate, from which the time left is estimated.
    """
    from tqdm import tqdm

    lines: dict[str, Any] = {}
    if progress == "lines":
        line = "viscoroll: {n_fmt} of {total_fmt} motions, {percentage:.0f} %, {remaining} left\n"
        lines = {"delay": LINE_EVERY, "mininterval": LINE_EVERY, "bar_format": line}
    settings = {"unit": " motions", "unit_scale": True, "smoothing": 0.05} | lines
    with tqdm(total=run.settings.n, disable=not progress, **settings) as bar:

        def advance(motions: int, on_disk: bool = False) -> None:
            """Advance the bar.

            motions: number of motions to add to those that the bar counts, >= 0.
            on_disk: whether they were on disk before this call, so that they do not count in the rate.
            """
            if on_disk and progress:  # a disabled bar has no attribute initial
                bar.initial += motions
            bar.update(motions)

        yield advance
