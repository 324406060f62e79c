"""Cut array work into fixed blocks, gather their elements, and run them on threads, with a progress bar.

The kernels release the GIL, so plain threads give the cores' full speed without a compiled
parallel region: no second compilation, no threading layer to clash with a host program's,
safe in forked processes and from several threads.  Blocks are fixed by the size of the
work alone, so results do not depend on the number of threads.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .array_types import Floats
from .checks import check_integer
from .errors import ParameterError

#: blocks in hand, a worker
_WAITING = 8


def block_reader(array: Floats, shape: tuple[int, ...]) -> Callable[[int, int], Floats]:
    """(start, stop) -> those elements of ``array`` broadcast to ``shape``, as a vector; a single value stays one.

    A view where they lie so in memory, else a copy of these elements alone.  Read-only whatever was
    given: a kernel is compiled anew for every kind of array that it sees.
    """
    if array.size == 1 or (array.shape == shape and array.flags.c_contiguous):
        vector = array.reshape(-1).view()
        vector.flags.writeable = False
        return (lambda start, stop: vector) if array.size == 1 else (lambda start, stop: vector[start:stop])
    whole = np.broadcast_to(array, shape)

    def gathered(start: int, stop: int) -> Floats:
        iterator: Any = np.nditer  # its stubs do not know "contig"
        flags = ["external_loop", "buffered", "ranged"]
        chunks = iterator(whole, flags, [["readonly", "contig"]], order="C", buffersize=stop - start)
        chunks.iterrange = start, stop
        vector = np.concatenate([chunk.copy() for chunk in chunks])  # each is overwritten by the next
        vector.flags.writeable = False
        return vector

    return gathered


def broadcast_vector(array: NDArray, shape: tuple[int, ...]) -> NDArray:
    """One value, or one for each element of ``shape``, as a contiguous vector.

    Read-only whatever was given: a kernel is compiled anew for every kind of array that it sees.
    """
    whole = array if array.size == 1 else np.ascontiguousarray(np.broadcast_to(array, shape))
    vector = whole.reshape(-1).view()
    vector.flags.writeable = False
    return vector


def thread_count(threads: int | None = None) -> int:
    """``threads``, else ``$VISCOROLL_THREADS``, else the cores this process may use.

    Raises
    ------
    ParameterError
        Where either is no whole number >= 1.
    """
    return (
        check_integer("threads", threads, 1) if threads is not None else _threads_of_environment() or available_cores()
    )


def _threads_of_environment() -> int | None:
    """``$VISCOROLL_THREADS``, None where it is not set; raises ParameterError where it is no whole number >= 1."""
    if not (given := os.environ.get("VISCOROLL_THREADS")):
        return None
    with suppress(ValueError):
        if (count := int(given)) >= 1:
            return count
    raise ParameterError("VISCOROLL_THREADS", repr(given), "a whole number >= 1, or not set")


def available_cores() -> int:
    """Cores that this process may use, as far as the system tells."""
    if hasattr(os, "process_cpu_count"):  # Python 3.13
        return os.process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


_heeded = threading.local()


def cancel_with(event: threading.Event) -> None:
    """From now on :func:`run_blocks` of this thread ends with CancelledError where the event is set."""
    _heeded.event = event


def run_blocks(
    work: Callable[[int, int], None],
    count: int,
    block: int,
    *,
    threads: int | None = None,
    progress: str | None = None,
) -> None:
    """Call ``work(start, stop)`` for consecutive blocks of ``range(count)``.

    ``progress`` names a progress bar, drawn on standard error after the first second.
    """
    edges: Iterable[tuple[int, int]] = ((start, min(start + block, count)) for start in range(0, count, block))
    blocks = -(-count // block)
    workers = blocks
    if blocks > 1 or threads is not None:
        workers = min(thread_count(threads), blocks)
    elif count > 1:
        _threads_of_environment()  # refuses what is wrong for small work too
    if workers <= 1 and progress is None:
        ended = getattr(_heeded, "event", None)
        for start, stop in edges:
            if ended is not None and ended.is_set():
                raise CancelledError
            work(start, stop)
        return
    if progress is not None:
        from tqdm import tqdm

        edges = tqdm(edges, desc=progress, total=blocks, delay=1.0, leave=False)
    with ThreadPoolExecutor(max(workers, 1)) as pool:
        _run(pool, work, edges, workers)


def _run(pool: Executor, work: Callable[[int, int], None], edges: Iterable[tuple[int, int]], workers: int) -> None:
    """Keep the workers busy with no more than a few blocks waiting: a future for each would take a kilobyte a block."""
    waiting: deque[Future[None]] = deque()
    try:
        for edge in edges:
            waiting.append(pool.submit(work, *edge))
            if len(waiting) > _WAITING * workers:
                waiting.popleft().result()
        while waiting:
            waiting.popleft().result()
    finally:  # after an error the others need not start
        for future in waiting:
            future.cancel()
