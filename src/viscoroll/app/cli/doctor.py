"""``viscoroll doctor``."""

from __future__ import annotations

import os
import platform
import sys
import time
import warnings
from argparse import Namespace
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

from ... import __version__

_BASE = (
    "numpy", "scipy", "numba", "llvmlite", "h5py", "h5netcdf", "xarray", "matplotlib", "msgspec", "tqdm", "filelock",
)  # fmt: skip
#: extra -> what it brings
_EXTRAS = {"runs": ("zarr",), "cluster": ("distributed",)}


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "doctor",
        help="versions, cache, threads, what is compiled and what is missing",
        description="What a report of a problem should hold; exit code 1 if something that is needed is missing.",
        epilog="example:\n  viscoroll doctor",
    )
    parser.set_defaults(run=_doctor)


def _doctor(arguments: Namespace) -> int:
    missing = [name for name in _BASE if _version(name) is None]
    for name, value in _lines():
        print(f"{name:<12} {value}")
    if missing:
        print(f"missing      {', '.join(missing)}: pip install viscoroll brings them")
    return int(bool(missing))


def _lines() -> Iterator[tuple[str, str]]:
    from ...core.blocks import thread_count
    from ...kernels.compile.cache import sources_digest
    from ...kernels.compile.folder import cache_root

    yield "viscoroll", f"{__version__}, in {os.path.dirname(os.path.dirname(__file__))}"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    yield "packages", ", ".join(f"{name} {_version(name) or 'MISSING'}" for name in _BASE)
    for extra, names in _EXTRAS.items():
        absent = [name for name in names if _version(name) is None]
        what = ", ".join(f"{name} {_version(name)}" for name in names if name not in absent)
        yield f"[{extra}]", what if not absent else f"{', '.join(absent)} not there: pip install 'viscoroll[{extra}]'"
    given = os.environ.get("VISCOROLL_THREADS")
    yield "threads", f"{thread_count(None)} ({'VISCOROLL_THREADS' if given else 'the cores available'})"
    folder = cache_root() / f"kernels-{sources_digest()}"
    kept = [path for path in folder.glob("*") if path.is_file()] if folder.is_dir() else []
    size = sum(path.stat().st_size for path in kept) / 1e6
    state = f"{len(kept)} compiled functions, {size:.1f} MB" if kept else "nothing is compiled yet: viscoroll warmup"
    yield "cache", f"{folder}: {state}{_trouble_of(folder)}"
    yield "check", _check()


def _check() -> str:
    """A contact state, its time, and what is warned of meanwhile."""
    from ...contact_law.contact import contact
    from ...presets import PAPER_SECTION_5

    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        began = time.perf_counter()
        Q = contact(PAPER_SECTION_5, 0.5, delta=-0.01, fields="Q").Q
        seconds = time.perf_counter() - began
    trouble = "; ".join(str(each.message) for each in told)
    return (
        f"contact of paper-section-5 at V = 0.5, delta = -0.01: Q = {Q:.12g}, {seconds:.1f} s"
        + f" ({trouble})" * bool(told)
    )


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _trouble_of(folder: Path) -> str:
    """Why the cache is not used, or cannot be written."""
    from ...kernels.compile.folder import refuse_shared

    try:
        refuse_shared(folder)
    except PermissionError as error:
        return f"; it is NOT USED: {error.strerror}"
    there = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    return "" if os.access(there, os.W_OK) else "; it CANNOT be written"
