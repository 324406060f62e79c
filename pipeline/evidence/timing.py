"""Time and memory: rounds of calls and their medians, processes of their own."""

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

#: calls quicker than this, s, are repeated for as long; 0 where times are of no interest: a call is
#: made once, as it is
shortest = 0.1


def seconds_of(call: Callable[[], Any], number: int = 1) -> tuple[float, Any]:
    """Wall time of one call out of a number of them, and the result of the last."""
    if shortest:
        gc.collect()
    start = time.perf_counter()
    for _ in range(number):
        result = call()
    return (time.perf_counter() - start) / number, result


def steady_seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """As :func:`seconds_of`; a quick call is repeated, so that cold caches and new memory do not
    count.
    """
    seconds, result = seconds_of(call)
    return (
        (seconds, result) if seconds >= shortest else seconds_of(call, int(shortest / seconds) + 1)
    )


def timed(
    calls: dict[Any, tuple[float, Callable[[], Any]]], repeats: int
) -> dict[Any, dict[str, float]]:
    """Name -> (count, call) -> nanoseconds that one of ``count`` takes: median and least, as on an
    idle machine.

    The first calls compile; then come rounds of all of them, so that a slow minute hits all alike.
    """
    for _, call in calls.values():
        call()
    ns = {name: [] for name in calls}
    for _ in range(repeats):
        for name, (count, call) in calls.items():
            ns[name].append(1e9 * steady_seconds(call)[0] / count)
    return {
        name: {"ns": float(np.median(each)), "least_ns": min(each)} for name, each in ns.items()
    }


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


def printed(program: str, *given, **environment: str):
    """What a program prints as JSON that finds its arguments in the list ``given``, in a process of
    its own.
    """
    command = [sys.executable, "-c", _BEGIN + program, json.dumps(given)]
    done = subprocess.run(
        command, env=os.environ | environment, check=True, capture_output=True, text=True
    )
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


def forked(work: Callable[..., Iterator[Any]], *arguments) -> Iterator[Any]:
    """What ``work`` yields in a forked process; after a crash of it, the exit code in words."""
    receiver, sender = get_context("fork").Pipe(duplex=False)

    def run():
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
