"""What a process keeps of earlier calls, in one place for the tests that need it gone; and what a
call takes.
"""

import tracemalloc

import numpy as np

from viscoroll.laws import law_tables
from viscoroll.motion import flow


def forget():
    """Neither a table nor a flow map is at hand; those on disk and compiled kernels stay."""
    flow._map.cache_clear()
    law_tables._made.cache_clear()


def taken_beside(call):
    """Bytes that a call takes at most, beside those of its result."""
    tracemalloc.start()
    result = call()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak - sum(
        value.nbytes for value in vars(result).values() if isinstance(value, np.ndarray)
    )
