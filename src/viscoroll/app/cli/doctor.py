"""``viscoroll doctor``: what a report of a problem should hold."""

from __future__ import annotations

import os
import platform
import re
import sys
import time
import warnings
from argparse import Namespace
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

import viscoroll as vr

from .arguments import command

#: extra -> what it brings
_EXTRAS = {"runs": "zarr", "cluster": "distributed"}


@command("doctor")
def doctor(given: Namespace) -> int:
    """Versions, cache, threads, what is compiled and what is missing.

    What a report of a problem should hold; exit code 1 if something that is needed is missing.

    example:
      viscoroll doctor
    """
    required = (_version("viscoroll") and metadata.requires("viscoroll")) or ()
    names = [re.split(r"[^\w-]", each)[0] for each in required if "extra ==" not in each]
    versions = {name: _version(name) for name in (*names, "llvmlite")}
    for name, value in _lines():
        print(f"{name:<12} {value}")
    print("packages    ", ", ".join(f"{name} {version or 'MISSING'}" for name, version in versions.items()))
    return None in versions.values()


def _lines() -> Iterator[tuple[str, str]]:
    from ...core.blocks import thread_count
    from ...kernels.compile.cache import sources_digest
    from ...kernels.compile.folder import cache_root

    yield "viscoroll", f"{vr.__version__}, in {Path(__file__).parents[2]}"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    for extra, name in _EXTRAS.items():
        found = _version(name)
        yield f"[{extra}]", f"{name} {found}" if found else f"no {name}: pip install 'viscoroll[{extra}]'"
    given = os.environ.get("VISCOROLL_THREADS")
    yield "threads", f"{thread_count(None)} ({'VISCOROLL_THREADS' if given else 'the cores available'})"
    folder = cache_root() / f"kernels-{sources_digest()}"
    kept = [path.stat().st_size for path in folder.glob("*") if path.is_file()]
    state = f"{len(kept)} compiled functions, {sum(kept) / 1e6:.1f} MB" if kept else "nothing yet: viscoroll warmup"
    yield "cache", f"{folder}: {state}{_trouble_of(folder)}"
    yield "check", _check()


def _check() -> str:
    """A contact state, its time, and what is warned of meanwhile."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        began = time.perf_counter()
        Q = vr.contact(vr.presets.PAPER_SECTION_5, 0.5, delta=-0.01, fields="Q").Q
        seconds = time.perf_counter() - began
    trouble = "".join(f"; {each.message}" for each in told)
    return f"contact of paper-section-5 at V = 0.5, delta = -0.01: Q = {Q:.12g}, {seconds:.1f} s{trouble}"


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _trouble_of(folder: Path) -> str:
    """Why the cache is not used, or cannot be written."""
    from ...kernels.compile.folder import refuse_writable_by_others

    try:
        refuse_writable_by_others(folder)
    except PermissionError as error:
        return f"; it is NOT USED: {error.strerror}"
    there = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    return "" if os.access(there, os.W_OK) else "; it CANNOT be written"
