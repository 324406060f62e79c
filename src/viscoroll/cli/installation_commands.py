"""Commands of the installation.

- ``viscoroll samples`` copies the sample files of the documentation into a folder of the user.
- ``viscoroll warmup`` compiles all kernels into the cache.
- ``viscoroll doctor`` prints the contents of a problem report.
"""

from __future__ import annotations

import os
import platform
import re
import sys
import time
import warnings
from argparse import Namespace
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

import viscoroll as vr

from .arguments import command, option

# --- viscoroll samples ---


@command(
    "samples",
    option(
        "folder",
        metavar="FOLDER",
        nargs="?",
        default="samples",
        help="folder for the files (default: samples)",
    ),
)
def samples(arguments: Namespace) -> None:
    """Copy the sample files of the documentation into a folder, and print their paths.

    arguments: parsed command line with folder, path of the folder, which is made if it does not
        exist; "samples" if not given.
    Returns None; a path is printed on each line, in the order of their names, also of files that
    were there already.
    Raises FileError for a file there of the same name with other content, before any is written,
    and where the folder cannot be written to.
    """
    for file in vr.datasets.copy_files(arguments.folder):
        print(file)


# --- viscoroll warmup ---


@command("warmup")
def warm_up(arguments: Namespace) -> None:
    """Compile all kernels into the cache by small calls, with a progress bar on a terminal.

    A line with the number of calls, the folder of the cache and the time in s is printed at the
    end.  Kernels that the cache has are loaded only.  A cache that cannot be written causes a
    RuntimeWarning, and the line all the same.

    arguments: parsed command line, not used.
    Returns None, exit code 0.
    """
    from tqdm import tqdm

    from ..kernels.numerics import cache_folder
    from ..kernels.numerics.cache_folder import cache_root

    cache_folder.announced = True  # the bar takes the place of the notice
    start = time.perf_counter()
    calls = _calls()
    bar = tqdm(calls.items(), leave=False, disable=None)  # drawn on a terminal alone
    for name, call in bar:
        bar.set_description(name)
        call()
    print(
        f"{len(calls)} entry points are ready in {cache_root()}, {time.perf_counter() - start:.1f} "
        "s"
    )


def _calls() -> dict[str, Callable[[], Any]]:
    """Return small calls that together use all kernels.

    Motions use the kernels of contacts, and all motions have one integrator.  Half-spaces, lists of
    alphas and of series, and layers have kernels of their own.

    Returns a dict, name for the progress bar -> function without arguments, whose result is not
    used; each makes its call when it is called, and nothing is written but the cache.
    """
    from ..contact_mechanics.coupled_tables import coupled_law
    from ..motion import flow

    scene = vr.presets.PAPER_SECTION_5
    modes = vr.Prony([1.0, 2.0], [1.0, 0.1])
    series = vr.Scene(material=modes, kappa=2.91, mu=0.2, gamma=1.0)
    many = series.replace(material=vr.Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1]))
    covered = series.replace(material=vr.Cover(modes, nu=0.5, thickness=1.0))
    fast = covered.replace(coupled=False)
    thick = fast.replace(material=vr.Cover(1.0, nu=0.5, thickness=[1.0, 1.5]))
    return {
        # build_map computes a map; ensemble might find one on disk
        "motions and flow maps": lambda: flow.build_map(
            (scene.alpha, scene.kappa, scene.mu, scene.j), 1
        ),
        "contact by root solves": lambda: vr.contact(scene, 0.5, delta=0.01, method="direct"),
        "contact with an array of alpha": lambda: vr.contact(
            vr.Scene([3.0, 4.0], 2.91, 0.2), 0.5, delta=0.01
        ),
        "contact with an array of Prony series": lambda: vr.contact(many, 0.5, delta=0.01),
        "unsteady rolling": lambda: vr.contact(series, 0.5, delta=0.01, fields="N"),
        "bound law": lambda: vr.law(scene),
        # a table of few nodes, also where that of the scene is on disk
        "table of the coupled solution": lambda: coupled_law(covered, nodes=(4, 9)),
        "contact on a cover": lambda: vr.contact(covered, 0.5, delta=0.01),
        "motions on a cover": lambda: vr.roll(covered, 0.5, 0.5, 0.1),
        "steady rolling on a cover": lambda: vr.steady(covered, force=0.01),
        "bound law of a cover": lambda: vr.law(covered),
        "fast law of a cover": lambda: vr.contact(fast, 0.5, delta=0.01),
        "motions by the fast law": lambda: vr.roll(fast, 0.5, 0.5, 0.1),
        "contact with an array of thicknesses": lambda: vr.contact(thick, 0.5, delta=0.01),
        "steady rolling": lambda: vr.steady(scene, force=0.01),
        "stress": lambda: vr.stress(scene, 0.5, 0.5, delta=0.01),
    }


# --- viscoroll doctor ---

#: Extra of the package -> the library that it installs.
_EXTRAS = {"runs": "zarr", "cluster": "distributed"}


@command("doctor")
def doctor(arguments: Namespace) -> int:
    """Print the lines of a problem report: versions, cache, threads, a check of the law, packages.

    arguments: parsed command line, not used.
    Returns True, exit code 1, if a required package or llvmlite is missing, else False, exit code
    0; a faulty cache and missing optional libraries are only printed.  Of a viscoroll that is not
    installed as a package, whose requirements are not known, llvmlite alone is examined.
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """
    required = (_version("viscoroll") and metadata.requires("viscoroll")) or ()
    names = [
        # the name before the version, as of "numpy>=2.0"
        re.split(r"[^\w-]", requirement)[0]
        for requirement in required
        if "extra ==" not in requirement
    ]
    versions = {name: _version(name) for name in (*names, "llvmlite")}
    for name, value in _lines():
        print(f"{name:<12} {value}")
    print(
        "packages    ",
        ", ".join(f"{name} {version or 'MISSING'}" for name, version in versions.items()),
    )
    return None in versions.values()


def _lines() -> Iterator[tuple[str, str]]:
    """Yield (name, text) of each line of the problem report but the last, which :func:`doctor`
    prints.

    They are: "viscoroll", version and folder of the package; "python", version and program;
    "system"; "[runs]" and "[cluster]", version of the optional library, or how it is installed;
    "threads", their number and where it is from; "cache", folder of compiled functions, their
    number and size in MB, and its faults (:func:`_fault_of_cache`); "check", a call
    (:func:`_check`).
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """
    from ..core.arrays import thread_count
    from ..kernels.numerics.cache_folder import cache_root
    from ..kernels.numerics.jit import sources_digest

    yield "viscoroll", f"{vr.__version__}, in {Path(__file__).parents[2]}"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    for extra, name in _EXTRAS.items():
        version = _version(name)
        yield (
            f"[{extra}]",
            f"{name} {version}"
            if version
            else f"{name} is not installed: pip install 'viscoroll[{extra}]'",
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

    The time is mostly that of compiling or loading the kernels, where they have not been used
    before.

    Returns a line of text: Q of the state, dimensionless, the time that the call took in s, and the
    warnings that it gave.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        start = time.perf_counter()
        Q = vr.contact(vr.presets.PAPER_SECTION_5, 0.5, delta=-0.01, fields="Q").Q
        seconds = time.perf_counter() - start
    texts = "".join(f"; {warning.message}" for warning in caught)
    return (
        f"contact of paper-section-5 at V = 0.5, delta = -0.01: Q = {Q:.12g}, {seconds:.1f} "
        f"s{texts}"
    )


def _version(name: str) -> str | None:
    """Return the version of a package; None if it is not installed.

    name: name of the package.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _fault_of_cache(folder: Path) -> str:
    """Return why the cache of compiled functions is not used or cannot be written, as the end of a
    line of the report.

    It is not used where others could write into it, or a folder is another user's.  It cannot be
    written where the folder, or if it does not exist the nearest folder above it that does, is not
    writable.

    folder: folder of the compiled functions, which need not exist.
    Returns a text that begins with ";", or "" if the cache is in order.
    """
    from ..kernels.numerics.cache_folder import refuse_writable_by_others

    try:
        refuse_writable_by_others(folder)
    except PermissionError as error:
        return f"; it is NOT USED: {error.strerror}"
    # a folder that is missing would be made in the nearest one above it
    existing = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    return "" if os.access(existing, os.W_OK) else "; it CANNOT be written"
