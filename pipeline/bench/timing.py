"""Alternating runs and their medians."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import Any

import numpy as np


def seconds_of(call: Callable[[], Any]) -> tuple[float, Any]:
    """Wall time of one call, and its result."""
    gc.collect()
    start = time.perf_counter()
    result = call()
    return time.perf_counter() - start, result


def alternating(calls: dict[Any, Callable[[], Any]], repeats: int) -> dict[Any, float]:
    """Median seconds of each call: rounds of all of them, so that a slow minute hits all alike."""
    seconds: dict[Any, list[float]] = {name: [] for name in calls}
    for _ in range(repeats):
        for name, call in calls.items():
            seconds[name].append(seconds_of(call)[0])
    return {name: float(np.median(values)) for name, values in seconds.items()}
