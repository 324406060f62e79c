"""A file that nothing vouches for is read once in a process of its own, within bounds of time and memory.

The HDF5 library is written in C and has been crashed and hung by damaged files.  In the rehearsal that harms
nobody; what it has survived is then read by the same code from the same bytes.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from contextlib import suppress
from os import PathLike

from ..errors import TableError
from .content import read
from .survey import most_bytes, one_line

_CHILD = "from viscoroll.tables.rehearsal import main; main()"
_REFUSED = 3
#: Processor time: so many seconds, imports with them, and one more for so many bytes; an atlas of 9 MB takes 1 s.
_SECONDS, _BYTES_A_SECOND = 3.0, 5e6
#: Seconds on the clock over those of the processor: the machine may be busy.
_PATIENCE = 20.0
#: Memory of libraries that are yet to be imported, beside the arrays, which are held twice or three times on the way.
_MEMORY = 1 << 28


def rehearse(content: bytes, path: str | PathLike[str], verify: bool) -> None:
    """Read ``content`` in a process of its own; ``path`` is where it came from.

    Raises
    ------
    TableError
        What ``content.read`` raised there, or that it took too long, too much memory, or crashed.
    """
    command = [sys.executable, "-P", "-c", _CHILD, os.fspath(path), "verify" if verify else ""]
    places = os.pathsep.join(place or os.getcwd() for place in sys.path)
    try:
        done = subprocess.run(
            command, input=content, capture_output=True, timeout=_PATIENCE * _seconds(content), check=False,
            env=os.environ | {"PYTHONPATH": places, "OPENBLAS_NUM_THREADS": "1"},
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise TableError(path, "takes too long to read: it is damaged, or not a viscoroll table") from error
    except OSError as error:
        raise TableError(path, f"cannot be tried in a process of its own ({error.strerror})") from error
    if done.returncode == _REFUSED:
        raise TableError(path, done.stdout.decode(errors="replace"))
    if done.returncode:
        # past its time, past its memory, or a crash
        raise TableError(path, f"cannot be read within bounds (exit code {done.returncode}): rebuild it")


def _seconds(content: bytes) -> float:
    return _SECONDS + len(content) / _BYTES_A_SECOND


def main() -> None:
    """The other process: content on standard input, exit code and a line on standard output."""
    content, path, verify = sys.stdin.buffer.read(), sys.argv[1], bool(sys.argv[2])
    _limit(content)
    try:
        read(content, path, verify)
    except TableError as error:
        sys.stdout.buffer.write(error.problem.encode())
        sys.exit(_REFUSED)
    except Exception as error:
        sys.stdout.buffer.write(f"is damaged ({one_line(error)}): rebuild it".encode())
        sys.exit(_REFUSED)


def _limit(content: bytes) -> None:
    """Bound the processor time and, where the system can, the memory from here on."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        seconds = math.ceil(time.process_time() + _seconds(content))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        with open("/proc/self/statm", encoding="ascii") as file:
            present = int(file.read().split()[0]) * resource.getpagesize()
        most = present + _MEMORY + 4 * most_bytes(content)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
