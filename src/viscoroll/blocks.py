"""Cut array work into fixed blocks and run them on threads, with a progress bar.

The kernels release the GIL, so plain threads give the cores' full speed without a compiled
parallel region: no second compilation, no threading layer to clash with a host program's,
safe in forked processes and from several threads.  Blocks are fixed by the size of the
work alone, so results do not depend on the number of threads.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor


def thread_count(threads: int | None = None) -> int:
    """``threads``, else ``$VISCOROLL_THREADS``, else the cores this process may use."""
    if threads is None:
        threads = int(os.environ.get("VISCOROLL_THREADS", "0")) or len(os.sched_getaffinity(0))
    return max(1, threads)


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
    edges = [(start, min(start + block, count)) for start in range(0, count, block)]
    workers = min(thread_count(threads), len(edges))
    if workers <= 1 and progress is None:
        for start, stop in edges:
            work(start, stop)
        return
    with ThreadPoolExecutor(max(workers, 1)) as pool:
        futures = pool.map(lambda edge: work(*edge), edges)
        if progress is not None:
            from tqdm import tqdm

            futures = tqdm(futures, desc=progress, total=len(edges), delay=1.0, leave=False)
        for _ in futures:
            pass
