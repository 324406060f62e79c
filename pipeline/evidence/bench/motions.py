"""Error against time per motion, for every method and tolerance of the configuration.

A new method needs a function that prepares it, a row of METHODS, and its tolerances in [bench.*.methods] of the
configuration; one that the configuration does not name is not run.
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial
from importlib.metadata import version
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from tqdm import tqdm

import viscoroll as vr

from ...runtime import rolled
from ..peers import lsoda, paper_method
from ..timing import seconds_of, steady_seconds
from . import implicit
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

#: right-hand sides after which a peer gives up: 15 s of the paper's method
_MOST_COMPILED, _MOST_PYTHON = 2_000_000, 300_000
Call = Callable[[], Outcome]


def _ensemble(problem: Problem, rtol: float, method: str) -> Call:
    """This package: :func:`viscoroll.ensemble` on one thread."""
    call = partial(problem.rolled, rtol=rtol, method=method, fields=("V", "omega"), threads=1)
    call()  # compiles, and builds what is built once
    return call


def _implicit(problem: Problem, rtol: float, law: Any) -> Call:
    """The Rosenbrock method of pipeline/runtime.py on another law of one scene."""
    alpha, kappa, mu, gamma, j = problem.parameters()[0].tolist()
    state = implicit.differenced(law(alpha, kappa, mu), mu / kappa)
    one, t = partial(rolled, state, gamma, j, 0.5 * mu / kappa), np.concatenate([[0.0], problem.t])

    def call(count: int | None = None) -> Outcome:
        found = [one(start, t, rtol) for start in list(zip(problem.V0, problem.omega0))[:count]]
        return Outcome(*np.array(found)[:, :, 1:].transpose(1, 0, 2))

    call(1)  # compiles
    return call


def _paper_method(problem: Problem, rtol: float, name: str) -> Call:
    program, starts = paper_method.build(Path(_build_folder().name)), np.column_stack([problem.V0, problem.omega0])
    given = (program, name, problem.parameters(), starts, problem.t, rtol, _MOST_COMPILED)
    return lambda: Outcome(*paper_method.run(*given))


@cache
def _build_folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="viscoroll-peers-")


def _scipy(problem: Problem, rtol: float, name: str) -> Call:
    """SciPy's ``solve_ivp`` in (V, omega) on the printed equations, which are solved in compiled code."""
    motions = list(zip(problem.parameters().tolist(), zip(problem.V0.tolist(), problem.omega0.tolist())))
    t = problem.t

    def one(parameters: list[float], start: tuple[float, float]) -> NDArray:
        alpha, kappa, mu, gamma, j = parameters
        loads, left = implicit.loaded(implicit.by_roots(alpha, kappa, mu)), iter(range(_MOST_PYTHON))

        def rates(_: float, y: NDArray) -> tuple[float, float]:
            next(left)
            Q, half = loads(y[0], y[1])
            return gamma * (Q - half), -gamma / j * (Q + half)

        found = np.full((2, t.size), np.nan)
        with suppress(StopIteration):  # more than it may ask for
            done = solve_ivp(rates, (0.0, t[-1]), start, name, t, rtol=rtol, atol=1e-3 * rtol)
            found[:, : done.t.size] = done.y
        return found

    one(*motions[0])  # compiles
    return lambda: Outcome(*np.array([one(*motion) for motion in motions]).transpose(1, 0, 2))


def _lsoda(problem: Problem, rtol: float) -> Call:
    drive = np.zeros((problem.V0.size, 2)) if problem.drive is None else problem.drive
    parameters = problem.parameters().tolist()
    scenes = np.array([lsoda.given(vr.Scene(*each), *by) for each, by in zip(parameters, drive.tolist())])
    starts, t = np.column_stack([problem.V0, problem.omega0]), np.concatenate([[0.0], problem.t])
    lsoda.roll(scenes[:1], starts[:1], t, 1e-2)  # compiles
    return lambda: Outcome(*lsoda.roll(scenes, starts, t, rtol)[:, 1:].transpose(2, 0, 1))


class Method(NamedTuple):
    """One way to roll motions: ``prepare(problem, rtol)`` does what is not timed and returns the call that is.

    ``missing()`` says why it cannot run here, or None.
    """

    label: str
    prepare: Callable[[Problem, float], Call]
    missing: Callable[[], str | None] = lambda: None


METHODS = {
    # of a fixed scene only; its error is the map's, whatever rtol
    "flow": Method("viscoroll, flow map", partial(_ensemble, method="flow")),
    "table": Method("viscoroll, integrated", partial(_ensemble, method="integrate")),
    "direct": Method("root solves + Rosenbrock", partial(_implicit, law=implicit.by_roots)),
    # ends at kappa V = 1e-3: below, its law is held, 1e-3 in M
    "atlas": Method("3-D atlas spline + Rosenbrock", partial(_implicit, law=implicit.by_atlas)),
    "lsoda": Method("LSODA on the law, compiled", _lsoda, lsoda.missing),
    "gsl-adams": Method("the paper's method (GSL Adams)", partial(_paper_method, name="adams"), paper_method.missing),
    "gsl-bdf": Method("GSL BDF, root solves", partial(_paper_method, name="bdf"), paper_method.missing),
    "scipy-lsoda": Method("SciPy's LSODA, root solves", partial(_scipy, name="LSODA")),
    "scipy-radau": Method("SciPy's Radau, root solves", partial(_scipy, name="Radau")),
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
    """Every method on every problem at each of its tolerances: rows, and what could not run in ``skipped``."""
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
    for turn in tqdm(range(max(repeats for *_, repeats in entries)), desc="rounds", leave=False, disable=None):
        for row, call, repeats in entries:
            if turn < repeats:
                took, outcome = steady_seconds(call)
                row.setdefault("us", []).append(1e6 * (getattr(outcome, "seconds", None) or took) / row["motions"])
                row.update(errors(outcome, best[row["group"]], problems[row["group"]].drive is not None))
    return {
        "reference": {
            name: reference_difference(problem, best[name], sizes["reference_motions"])
            for name, problem in problems.items()
            if problem.drive is None
        },
        "methods": {name: METHODS[name].label for name in sizes["methods"]},
        "rows": [row | {"us": float(np.median(row["us"])), "least_us": min(row["us"])} for row, *_ in entries],
        "skipped": skipped, "tools": tools(),
    }  # fmt: skip


def tools() -> dict[str, str]:
    """Versions of what the peers are built with; those that are not there are left out."""
    found = {name: version(name) for name in ("scipy", "numbalsoda") if find_spec(name)}
    for name, command in {"cc": "cc -dumpfullversion", "gsl": "pkg-config --modversion gsl"}.items():
        done = subprocess.run(command, shell=True, check=False, capture_output=True, text=True)
        found |= {} if done.returncode else {name: done.stdout.strip()}
    return found
