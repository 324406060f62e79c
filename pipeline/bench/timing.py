"""Alternating runs and their medians."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import Any

import numpy as np

#: calls quicker than this, s, are repeated for as long
_QUICK = 0.1


def seconds_of(call: Callable[[], Any]) -> tuple[float, Any]:
    """Wall time of one call, and its result."""
    gc.collect()
    start = time.perf_counter()
    result = call()
    return time.perf_counter() - start, result


def _repeat(call: Callable[[], Any], number: int) -> None:
    for _ in range(number):
        call()


def steady_seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """As :func:`seconds_of`; a quick call is repeated, so that cold caches and new memory do not count."""
    seconds, result = seconds_of(call)
    if seconds < _QUICK:
        number = int(_QUICK / seconds) + 1
        seconds = seconds_of(lambda: _repeat(call, number))[0] / number
    return seconds, result


def rounds(calls: dict[Any, Callable[[], Any]], repeats: int) -> dict[Any, list[float]]:
    """Seconds of each call: rounds of all of them, so that a slow minute hits all alike."""
    seconds: dict[Any, list[float]] = {name: [] for name in calls}
    for _ in range(repeats):
        for name, call in calls.items():
            seconds[name].append(steady_seconds(call)[0])
    return seconds


def alternating(calls: dict[Any, Callable[[], Any]], repeats: int) -> dict[Any, float]:
    """Median seconds of each call in :func:`rounds`."""
    return {name: float(np.median(values)) for name, values in rounds(calls, repeats).items()}


def nanoseconds(seconds: list[float], count: int) -> dict[str, float]:
    """Median and least of what one of ``count`` took: the least is nearest to an idle machine's."""
    return {"ns": 1e9 * float(np.median(seconds)) / count, "least_ns": 1e9 * min(seconds) / count}
