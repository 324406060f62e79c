"""Time and memory: alternating runs and their medians, processes of their own."""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from typing import Any

import numpy as np

#: calls quicker than this, s, are repeated for as long; 0 where times are of no interest: a call is made once, as it is
shortest = 0.1


def seconds_of(call: Callable[[], Any], *, collect: bool = True) -> tuple[float, Any]:
    """Wall time of one call, and its result; garbage is collected before, which takes longer than many quick calls."""
    if collect and shortest:
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
    if seconds < shortest:
        number = int(shortest / seconds) + 1
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


#: what a program of :func:`printed` begins with; ru_maxrss would be inherited from the parent
_BEGIN = """
import json, sys, time
import numpy as np
import viscoroll as vr
def memory(name):  # bytes of this process alone
    with open("/proc/self/status") as status:
        return 1024 * next(int(line.split()[1]) for line in status if line.startswith(name))
given = json.loads(sys.argv[1])
"""


def printed(program: str, *given: Any, **environment: str) -> Any:
    """What a program prints as JSON that finds its arguments in the list ``given``, in a process of its own."""
    command = [sys.executable, "-c", _BEGIN + program, json.dumps(given)]
    done = subprocess.run(command, env=os.environ | environment, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def usages() -> list[Any]:
    """Of this process and of those that it has waited for; POSIX only."""
    import resource

    return [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]


def processor_time() -> float:
    """Seconds that do not depend on what else the machine does."""
    return sum(usage.ru_utime + usage.ru_stime for usage in usages())


def peak_mb() -> float:
    """Largest memory so far."""
    return max(usage.ru_maxrss for usage in usages()) * 1.024e-3


def forked(work: Callable[..., Iterator[Any]], *arguments: Any) -> Iterator[Any]:
    """What ``work`` yields in a forked process; after a crash of it, the exit code in words."""
    receiver, sender = get_context("fork").Pipe(duplex=False)

    def run() -> None:
        for item in work(*arguments):
            sender.send(item)

    process = get_context("fork").Process(target=run)
    process.start()
    sender.close()  # so that a child that fails ends the wait
    try:
        while True:
            yield receiver.recv()
    except EOFError:
        process.join()
    if process.exitcode:
        yield f"crashed with exit code {process.exitcode}"
