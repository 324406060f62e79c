"""Work on the blocks of a run: on threads of this process, or on a dask cluster.

One task is one block.  As many tasks are given out as keep the workers busy, so neither this process
nor a scheduler holds more than a few, however many blocks there are.
"""

from __future__ import annotations

import logging
import re
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from ...core.blocks import cancel_with, thread_count
from ...core.checks import check_bool
from ...core.errors import FileError, Interrupted, ParameterError, ViscorollError
from ...core.extras import import_extra
from .evaluate import look_at_materials
from .runfile import Run
from .store import Store, locked

#: tasks given out, a worker: one to work on and one to go on with
_AHEAD = 2
#: how often dask gives a task to another worker when one dies
_RETRIES = 3
#: seconds between lines of progress where there is no terminal
LINE_EVERY = 30.0
#: tcp://host:port, or the same with tls
_ADDRESS = re.compile(r"(tcp|tls)://([^/:[\]]+|\[[^/[\]]+\]):\d+")
#: dask's workers give every freed array back to the system, which costs a block time, and watch
#: themselves a hundred times a second; glibc takes no larger second value
_CALM = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 2**30,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 2**25,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "500ms",
}


def run_ensemble(
    run: Run, path: str | PathLike[str], *, cluster: str | None = None, threads: int | None = None,
    progress: bool | Literal["lines"] = False,
) -> int:  # fmt: skip
    """Work on all blocks that the store does not hold yet, then write the summaries.

    After an end of any kind (a kill, a full disk, a damaged file) the same call goes on: blocks
    that are there are read and compared with their SHA-256, the others are made again.  So does a call with a larger
    ``n`` in a run that is otherwise the same ("random"; "sobol" to powers of two): the store becomes that of the larger
    run, byte for byte.

    Parameters
    ----------
    run : see :func:`read_run`.
    path : folder of the results, made if there is none.
    cluster : None: threads of this process.  "local": processes of this machine, or
        "tcp://host:port": a running dask scheduler, whose workers see ``path`` on a shared disk.
    threads : threads or local processes; default ``$VISCOROLL_THREADS`` or the cores available.
    progress : draw a bar with rate and time left; "lines": say so in a line every half minute, for a log.

    Returns
    -------
    int
        How many blocks were made; 0 where the store held all of them.

    Raises
    ------
    FileError
        The folder holds something else or cannot be written, another process writes to it, or
        the cluster went away.
    ParameterError
        An unknown cluster, or inputs that a motion does not allow.
    MissingDependencyError
        If zarr, or dask for a cluster, is not installed.
    Interrupted
        At Ctrl-C (a KeyboardInterrupt), within a second: the blocks that are done stay, and the message says how many
        they are.

    Notes
    -----
    The files are the same, byte for byte, for any number of threads or workers and after any number
    of kills (``tests/runs/test_run_store.py``); a motion is as exact as :func:`viscoroll.ensemble` makes it.
    """
    if progress != "lines":
        progress = check_bool("progress", progress)
    store = Store(Path(path).absolute(), run)
    import_extra("zarr", "zarr", "runs")
    store.refuse_other()
    with _executor(store, cluster, threads) as (pool, workers, shared):  # a cluster that is not there is refused first
        look_at_materials(run)
        with locked(store.root), _bar(run, progress) as advance:
            store.begin()
            made = 0
            try:
                for motions in _results(store, shared, pool, workers, advance):
                    made += 1
                    advance(motions)
            except KeyboardInterrupt:
                kept = f"{made} of {run.blocks} blocks were made and are kept in {path}"
                raise Interrupted(f"interrupted: {kept}; the same call goes on") from None
            store.end()
    return made


def _results(store: Store, shared: Any, pool: Executor, workers: int, advance: Callable[..., Any]) -> Iterator[int]:
    """Give out the missing blocks, and yield the motions of each that is done."""
    running: set[Future[int]] = set()
    known = 0
    try:
        for block in store.missing():
            start = store.run.edges(block)[0]
            advance(start - known, old=True)
            known = store.run.edges(block)[1]
            running.add(pool.submit(Store.work, shared, block))
            if len(running) >= _AHEAD * workers:
                done, running = wait(running, return_when=FIRST_COMPLETED)
                yield from (future.result() for future in done)
        advance(store.run.settings.n - known, old=True)
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            yield from (future.result() for future in done)
    finally:
        for future in running:
            future.cancel()


@contextmanager
def _executor(store: Store, cluster: str | None, threads: int | None) -> Iterator[tuple[Executor, int, Any]]:
    """(executor, workers, the store as tasks are handed it)."""
    if cluster is None:
        ended = threading.Event()
        pool = ThreadPoolExecutor(thread_count(threads), initializer=cancel_with, initargs=(ended,))
        try:
            yield pool, thread_count(threads), store
        except BaseException:
            ended.set()  # blocks that are being made are given up
            raise
        finally:
            pool.shutdown(wait=not ended.is_set(), cancel_futures=True)
        return
    if cluster != "local" and not _ADDRESS.fullmatch(cluster):
        raise ParameterError("cluster", repr(cluster), "'local' or 'tcp://host:port'")
    distributed = import_extra("distributed", "distributed", "cluster")
    try:
        with _silent("distributed", "distributed.client"), _client(distributed, cluster, threads) as client:
            workers = sum(client.nthreads().values())
            if not workers:
                raise FileError(cluster, "this cluster has no workers")
            with client.get_executor(pure=False, retries=_RETRIES) as pool:
                yield pool, workers, client.scatter(store, broadcast=True)
    except ViscorollError:
        raise
    except (OSError, TimeoutError, CancelledError, distributed.scheduler.KilledWorker) as error:
        text = " ".join((str(error) or type(error).__name__).split())
        raise FileError(cluster, f"the cluster went away ({text:.200}): the same command goes on") from error


def _client(distributed: Any, cluster: str, threads: int | None) -> Any:
    if cluster != "local":
        return distributed.Client(cluster, timeout=10)
    import dask

    with dask.config.set(_CALM):
        return distributed.Client(
            n_workers=thread_count(threads), threads_per_worker=1, dashboard_address=":0", silence_logs=logging.CRITICAL
        )


@contextmanager
def _silent(*names: str) -> Iterator[None]:
    """No log lines and tracebacks of these: what went wrong is raised."""
    loggers = [logging.getLogger(name) for name in names]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


@contextmanager
def _bar(run: Run, progress: bool | Literal["lines"]) -> Iterator[Callable[..., Any]]:
    """A function to call with numbers of motions; those found done (``old``) do not count in the rate."""
    from tqdm import tqdm

    lines: dict[str, Any] = {}
    if progress == "lines":
        told = "viscoroll: {n_fmt} of {total_fmt} motions, {percentage:.0f} %, {remaining} left\n"
        lines = {"delay": LINE_EVERY, "mininterval": LINE_EVERY, "bar_format": told}
    settings = {"unit": " motions", "unit_scale": True, "smoothing": 0.05} | lines
    with tqdm(total=run.settings.n, disable=not progress, **settings) as bar:

        def advance(motions: int, old: bool = False) -> None:
            if old and progress:  # a bar that is not drawn has no start
                bar.initial += motions
            bar.update(motions)

        yield advance
