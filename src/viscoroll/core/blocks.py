"""Work on arrays in fixed blocks: the elements of a block, threads, progress bar.

The kernels release the GIL, so that plain threads use all cores without a parallel region of numba:
no second compilation, no threading layer that could clash with that of a host program, safe in
forked processes and from several threads.  Blocks follow from the size of the work alone, so that
results do not depend on the number of threads.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Collection, Iterable
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from typing import Any

import numpy as np

from .checks import Floats, NDArray, check_integer
from .errors import ParameterError

#: Blocks submitted for each worker and not yet awaited.  A future takes a kilobyte, so that not all
#: are submitted.
_BLOCKS_IN_QUEUE = 8


def block_reader(array: Floats, shape: tuple[int, ...]) -> Callable[[int, int], Floats]:
    """Return a function that reads blocks of a broadcast array, so that the whole of it is never in
    memory.

    array: numbers that broadcast to ``shape``.
    shape: shape to which all arrays of the work broadcast.
    Returns a function (start, stop) -> the elements ``start`` to ``stop`` - 1 of the broadcast and
    flattened array, in C order, a vector (stop - start,), for 0 <= start < stop <= its size.  If
    ``array`` has a single element the vector is always (1,), that element.  Vectors are views if
    ``array`` is contiguous and of that shape, else copies.  All are contiguous and read-only,
    because numba compiles a kernel again for each kind of array.
    Raises ValueError where ``array`` has more than one element and does not broadcast to ``shape``.
    """
    # a single element stays one, which kernels read for every state
    if array.size == 1 or (array.shape == shape and array.flags.c_contiguous):
        vector = broadcast_vector(array, array.shape)
        return (
            (lambda start, stop: vector)
            if array.size == 1
            else (lambda start, stop: vector[start:stop])
        )
    whole = np.broadcast_to(array, shape)

    def read_block(start: int, stop: int) -> Floats:
        """Return a read-only copy of elements of the flattened array, a contiguous vector (stop -
        start,).

        start, stop: index of the first element, and of the one after the last, 0 <= start < stop <=
        its size.
        """
        # chunks of one axis, copied to a buffer where memory is not in order, within a range that
        # is set below
        iterator: Any = np.nditer  # the stubs of numpy lack the flag "contig"
        flags = ["external_loop", "buffered", "ranged"]
        chunks = iterator(
            whole, flags, [["readonly", "contig"]], order="C", buffersize=stop - start
        )
        chunks.iterrange = start, stop
        # The iterator overwrites each chunk by the next one.
        vector = np.concatenate([chunk.copy() for chunk in chunks])
        vector.flags.writeable = False
        return vector

    return read_block


def broadcast_rows(arrays: Collection[Any], shape: tuple[int, ...]) -> Floats:
    """Return arrays and numbers as the rows of one array, each broadcast to a shape and flattened.

    arrays: doubles, each a number or an array that broadcasts to ``shape``.
    shape: shape of the states; () of a single state.
    Returns a new array (rows, states), in the order of ``arrays``.
    """
    rows = np.empty((len(arrays), *(shape or (1,))))
    for row, array in zip(rows, arrays, strict=True):
        row[...] = array
    return rows.reshape(len(arrays), -1)


def broadcast_vector(array: NDArray, shape: tuple[int, ...]) -> NDArray:
    """Return an array, broadcast to a shape and flattened, as a contiguous read-only vector.

    array: numbers that broadcast to ``shape``.
    shape: shape of the result before it is flattened.
    Returns a vector with as many elements as ``shape`` has, in C order, a view where possible, else
    a copy; if ``array`` has a single element it is (1,), for any shape.
    Raises ValueError where ``array`` has more than one element and does not broadcast.
    """
    whole = array if array.size == 1 else np.ascontiguousarray(np.broadcast_to(array, shape))
    # a view of its own, so that the caller's array stays writable
    vector = whole.reshape(-1).view()
    vector.flags.writeable = False
    return vector


def thread_count(threads: int | None = None) -> int:
    """Return the number of threads: ``threads``, else ``$VISCOROLL_THREADS``, else that of the
    available cores.

    threads: a whole number >= 1; None: the environment variable, if it is set and not empty, else
        all cores that this process may use.
    Returns an int >= 1.

    Raises
    ------
    ParameterError
        If the one that is used, ``threads`` or the variable, is not a whole number >= 1.
    """
    return (
        check_integer("threads", threads, 1)
        if threads is not None
        else _environment_threads() or available_cores()
    )


def _environment_threads() -> int | None:
    """Return ``$VISCOROLL_THREADS`` as an int >= 1; None where it is not set, or empty.

    :func:`run_blocks` also calls it for work of a single block, to check the variable alone.
    Raises ParameterError for any other text, as "0".
    """
    if not (given := os.environ.get("VISCOROLL_THREADS")):
        return None
    with suppress(ValueError):
        if (count := int(given)) >= 1:
            return count
    raise ParameterError("VISCOROLL_THREADS", repr(given), "a whole number >= 1, or not set")


def available_cores() -> int:
    """Return the number of cores that this process may use, or of the machine where the system does
    not tell; >= 1.
    """
    if hasattr(os, "process_cpu_count"):  # Python 3.13
        return os.process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


_cancellation = threading.local()


def cancel_with(event: threading.Event) -> None:
    """Let :func:`run_blocks` of this thread raise CancelledError before its next block once
    ``event`` is set.

    It has no effect on calls with several workers or a progress bar.
    """
    _cancellation.event = event


def run_blocks(
    work: Callable[[int, int], None],
    count: int,
    block: int,
    *,
    threads: int | None = None,
    progress: str | None = None,
) -> None:
    """Call a function for consecutive blocks of ``range(count)``, on several threads, and return
    when all are done.

    Parameters
    ----------
    work : function (start, stop) -> None, which computes the elements ``start`` to ``stop`` - 1 of
        a block and writes them where they belong.  Several threads call it at the same time.  Its
        exceptions are raised here, of several that of the first block; then some of the blocks
        after it have not been computed.
    count : number of elements, >= 0; ``work`` is not called for 0.
    block : number of elements of a block, >= 1, not checked; the last block may have fewer.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, else that of the available cores.  No
        more are used than there are blocks; one worker without a progress bar is the calling thread
        itself.
    progress : title of a progress bar on standard error, which appears after one second; None: no
    bar.

    Raises
    ------
    CancelledError
        If the event of :func:`cancel_with` is set and the blocks run one after another on this
        thread.
    ParameterError
        If ``threads`` is not a whole number >= 1; without it, and for two elements and more, if
        ``$VISCOROLL_THREADS`` is not.
    """
    edges = ((start, min(start + block, count)) for start in range(0, count, block))
    workers = blocks = -(-count // block)  # rounded up
    if blocks > 1 or threads is not None:
        workers = min(thread_count(threads), blocks)
    elif count > 1:
        _environment_threads()  # a wrong value is an error of small work too
    if workers <= 1 and progress is None:
        event = getattr(_cancellation, "event", None)
        for start, stop in edges:
            if event is not None and event.is_set():
                raise CancelledError
            work(start, stop)
        return
    if progress is not None:
        from tqdm import tqdm

        edges = tqdm(edges, desc=progress, total=blocks, delay=1.0, leave=False)
    # with a bar and no blocks the pool still needs one worker
    with ThreadPoolExecutor(max(workers, 1)) as pool:
        _submit_all(pool, work, edges, _BLOCKS_IN_QUEUE * workers)


def _submit_all(
    pool: Executor, work: Callable[[int, int], None], edges: Iterable[tuple[int, int]], most: int
) -> None:
    """Run all blocks on a pool, await them in order, and return when all are done.

    If a block fails, its exception is raised when it is awaited; of several that of the first
    block.  Then no further blocks are submitted, those that have not begun are cancelled, and those
    that run are not awaited.

    pool: :class:`concurrent.futures.Executor`, of threads.
    work: function (start, stop) -> None.
    edges: (start, stop) of each block, an iterable that is consumed as blocks are submitted.
    most: largest number of blocks that are submitted and not yet awaited, >= 1; it bounds the
    memory of the futures.
    """
    waiting: deque[Future[None]] = deque()
    try:
        for edge in edges:
            waiting.append(pool.submit(work, *edge))
            if len(waiting) > most:
                waiting.popleft().result()
        while waiting:
            waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
