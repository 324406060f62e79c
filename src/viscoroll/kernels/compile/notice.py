"""One line on standard error for the user who waits while kernels are compiled."""

import multiprocessing
import os
import sys

#: Whether this process has printed the line.
announced = False


def announce_compiling() -> None:
    """Print a line on standard error that kernels are being compiled, at most once in a process.

    The number of kernels is not known at that time, so that the line names none.
    Returns None.  Nothing is printed where :func:`is_quiet` is True; a later call may then still print the line.
    """
    global announced
    if announced or is_quiet():
        return
    announced = True
    print(
        "viscoroll: compiling kernels, up to half a minute for each new kind of call, once for this machine; "
        "`viscoroll warmup` does it ahead",
        file=sys.stderr,
        flush=True,
    )


def is_quiet() -> bool:
    """Return whether nobody waits who could read the line.

    Returns True if the environment variable VISCOROLL_QUIET is "1" (no other value counts), if there is no standard
    error, or if the process is a worker (:func:`is_worker`).
    """
    return os.environ.get("VISCOROLL_QUIET") == "1" or sys.stderr is None or is_worker()


def is_worker() -> bool:
    """Return whether this process works for another one, which prints and warns instead.

    Returns True in a process that multiprocessing has started, and within a task of dask.distributed; else False.
    """
    if multiprocessing.parent_process() is not None:
        return True
    distributed = sys.modules.get("distributed")
    try:
        return distributed is not None and distributed.get_worker() is not None
    except ValueError:  # not within a task
        return False
