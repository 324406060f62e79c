"""Error against time per motion, for every method and tolerance of the configuration.

A new method needs a function that prepares it, a row of METHODS, and its tolerances in
[bench.*.methods] of the configuration; one that the configuration does not name is not run.
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Callable
from functools import cache, partial
from importlib.metadata import version
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from tqdm import tqdm

import viscoroll as vr

from ..peers import lsoda, paper_method
from ..timing import seconds_of, steady_seconds
from .problem import (
    Outcome,
    Problem,
    driven_problems,
    errors,
    own_problem,
    paper_problems,
    reference,
    reference_difference,
)

#: right-hand sides after which the paper's method gives up: 15 s
_MOST = 2_000_000
Call = Callable[[], Outcome]


def _ensemble(problem: Problem, rtol: float, method: str) -> Call:
    """This package: :func:`viscoroll.ensemble` on one thread."""
    call = partial(problem.rolled, rtol=rtol, method=method, fields=("V", "omega"), threads=1)
    call()  # compiles, and builds what is built once
    return call


def _paper_method(problem: Problem, rtol: float, name: str) -> Call:
    program = paper_method.build(Path(_build_folder().name))
    starts = np.column_stack([problem.V0, problem.omega0])
    given = (program, name, problem.parameters(), starts, problem.t, rtol, _MOST)
    return lambda: Outcome(*paper_method.run(*given))


@cache
def _build_folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="viscoroll-peers-")


def _lsoda(problem: Problem, rtol: float) -> Call:
    drive = np.zeros((problem.V0.size, 2)) if problem.drive is None else problem.drive
    parameters = problem.parameters().tolist()
    scenes = np.array(
        [lsoda.given(vr.Scene(*each), *by) for each, by in zip(parameters, drive.tolist())]
    )
    starts = np.column_stack([problem.V0, problem.omega0])
    t = np.concatenate([[0.0], problem.t])
    lsoda.roll(scenes[:1], starts[:1], t, 1e-2)  # compiles
    return lambda: Outcome(*lsoda.roll(scenes, starts, t, rtol)[:, 1:].transpose(2, 0, 1))


class Method(NamedTuple):
    """One way to roll motions: ``prepare(problem, rtol)`` does what is not timed and returns the
    call that is.

    ``missing()`` says why it cannot run here, or None.
    """

    label: str
    prepare: Callable[[Problem, float], Call]
    missing: Callable[[], str | None] = lambda: None


METHODS = {
    # of a fixed scene only; its error is the map's, whatever rtol
    "flow": Method("viscoroll, flow map", partial(_ensemble, method="flow")),
    "table": Method("viscoroll, integrated", partial(_ensemble, method="integrate")),
    "lsoda": Method("LSODA on the law, compiled", _lsoda, lsoda.missing),
    "gsl-adams": Method(
        "the paper's method (GSL Adams)", partial(_paper_method, name="adams"), paper_method.missing
    ),
    "gsl-bdf": Method(
        "GSL BDF, root solves", partial(_paper_method, name="bdf"), paper_method.missing
    ),
}


def work_precision(sizes: dict[str, Any]) -> dict[str, Any]:
    """Groups IC1, IC2, IC3 (one motion each) and ``random`` (the same starts for all methods)."""
    return compare(paper_problems(sizes), sizes)


def own_parameters(sizes: dict[str, Any]) -> dict[str, Any]:
    """Every motion its own scene."""
    return compare(own_problem(sizes), sizes)


def driven(sizes: dict[str, Any]) -> dict[str, Any]:
    """Under a force and a torque."""
    return compare(driven_problems(sizes), sizes)


def compare(problems: dict[str, Problem], sizes: dict[str, Any]) -> dict[str, Any]:
    """Every method on every problem at each of its tolerances: rows, and what could not run in
    ``skipped``.
    """
    best = {name: reference(problem) for name, problem in problems.items()}
    skipped = {name: reason for name in sizes["methods"] if (reason := METHODS[name].missing())}
    for name, reason in skipped.items():
        print(f"benchmark: {name} skipped: {reason}")
    entries = []
    for (name, settings), (group, problem) in product(sizes["methods"].items(), problems.items()):
        count = settings["motions"] if problem.V0.size > 1 else settings.get("copies", 1)
        if name in skipped or not count:
            continue
        for rtol in settings["rtol"]:
            setup, call = seconds_of(partial(METHODS[name].prepare, problem.take(count), rtol))
            row = {"method": name, "group": group, "rtol": rtol, "motions": count, "setup_s": setup}
            entries.append((row, call, settings.get("repeats", sizes["repeats"])))
    for turn in tqdm(
        range(max(repeats for *_, repeats in entries)), desc="rounds", leave=False, disable=None
    ):
        for row, call, repeats in entries:
            if turn < repeats:
                took, outcome = steady_seconds(call)
                row.setdefault("us", []).append(
                    1e6 * (getattr(outcome, "seconds", None) or took) / row["motions"]
                )
                row.update(
                    errors(outcome, best[row["group"]], problems[row["group"]].drive is not None)
                )
    return {
        "reference": {
            name: reference_difference(problem, best[name], sizes["reference_motions"])
            for name, problem in problems.items()
            if problem.drive is None
        },
        "methods": {name: METHODS[name].label for name in sizes["methods"]},
        "rows": [
            row | {"us": float(np.median(row["us"])), "least_us": min(row["us"])}
            for row, *_ in entries
        ],
        "skipped": skipped,
        "tools": tools(),
    }


def tools() -> dict[str, str]:
    """Versions of what the peers are built with; those that are not there are left out."""
    found = {"numbalsoda": version("numbalsoda")} if find_spec("numbalsoda") else {}
    for name, command in {
        "cc": "cc -dumpfullversion",
        "gsl": "pkg-config --modversion gsl",
    }.items():
        done = subprocess.run(command, shell=True, check=False, capture_output=True, text=True)
        found |= {} if done.returncode else {name: done.stdout.strip()}
    return found
