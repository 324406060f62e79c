"""``viscoroll doctor``: the contents of a problem report."""

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

#: Extra of the package -> the library that it installs.
_EXTRAS = {"runs": "zarr", "cluster": "distributed"}


@command("doctor")
def doctor(arguments: Namespace) -> int:
    """Print the lines of a problem report: versions, cache, threads, a check of the law, packages.

    arguments: parsed command line, not used.
    Returns True, exit code 1, if a required package or llvmlite is missing, else False, exit code 0; a faulty cache and
    missing optional libraries are only printed.  Of a viscoroll that is not installed as a package, whose requirements
    are not known, llvmlite alone is examined.
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """
    required = (_version("viscoroll") and metadata.requires("viscoroll")) or ()
    names = [re.split(r"[^\w-]", requirement)[0] for requirement in required if "extra ==" not in requirement]
    versions = {name: _version(name) for name in (*names, "llvmlite")}
    for name, value in _lines():
        print(f"{name:<12} {value}")
    print("packages    ", ", ".join(f"{name} {version or 'MISSING'}" for name, version in versions.items()))
    return None in versions.values()


def _lines() -> Iterator[tuple[str, str]]:
    """Yield (name, text) of each line of the problem report but the last, which :func:`doctor` prints.

    They are: "viscoroll", version and folder of the package; "python", version and program; "system"; "[runs]" and
    "[cluster]", version of the optional library, or how it is installed; "threads", their number and where it is from;
    "cache", folder of compiled functions, their number and size in MB, and its faults (:func:`_fault_of_cache`);
    "check", a call (:func:`_check`).
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """
    from ...core.blocks import thread_count
    from ...kernels.compile.cache import sources_digest
    from ...kernels.compile.folder import cache_root

    yield "viscoroll", f"{vr.__version__}, in {Path(__file__).parents[2]}"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    for extra, name in _EXTRAS.items():
        version = _version(name)
        yield (
            f"[{extra}]",
            f"{name} {version}" if version else f"{name} is not installed: pip install 'viscoroll[{extra}]'",
        )
    source = "VISCOROLL_THREADS" if os.environ.get("VISCOROLL_THREADS") else "the cores available"
    yield "threads", f"{thread_count(None)} ({source})"
    folder = cache_root() / f"kernels-{sources_digest()}"
    sizes = [path.stat().st_size for path in folder.glob("*") if path.is_file()]
    state = (
        f"{len(sizes)} compiled functions, {sum(sizes) / 1e6:.1f} MB"
        if sizes
        else "no compiled functions; `viscoroll warmup` compiles them"
    )
    yield "cache", f"{folder}: {state}{_fault_of_cache(folder)}"
    yield "check", _check()


def _check() -> str:
    """Evaluate one state of the contact, as a check that the package works.

    The time is mostly that of compiling or loading the kernels, where they have not been used before.

    Returns a line of text: Q of the state, dimensionless, the time that the call took in s, and the warnings that it
    gave.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        start = time.perf_counter()
        Q = vr.contact(vr.presets.PAPER_SECTION_5, 0.5, delta=-0.01, fields="Q").Q
        seconds = time.perf_counter() - start
    texts = "".join(f"; {warning.message}" for warning in caught)
    return f"contact of paper-section-5 at V = 0.5, delta = -0.01: Q = {Q:.12g}, {seconds:.1f} s{texts}"


def _version(name: str) -> str | None:
    """Return the version of a package; None if it is not installed.

    name: name of the package.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _fault_of_cache(folder: Path) -> str:
    """Return why the cache of compiled functions is not used or cannot be written, as the end of a line of the report.

    It is not used where others could write into it, or a folder is another user's.  It cannot be written where the
    folder, or if it does not exist the nearest folder above it that does, is not writable.

    folder: folder of the compiled functions, which need not exist.
    Returns a text that begins with ";", or "" if the cache is in order.
    """
    from ...kernels.compile.folder import refuse_writable_by_others

    try:
        refuse_writable_by_others(folder)
    except PermissionError as error:
        return f"; it is NOT USED: {error.strerror}"
    existing = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    return "" if os.access(existing, os.W_OK) else "; it CANNOT be written"
