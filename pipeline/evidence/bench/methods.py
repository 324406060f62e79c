"""The ways to roll motions that are compared: one row of METHODS each.

A new one needs a function that prepares it, a row here, and its tolerances in [bench.*.methods] of the
configuration; one that the configuration does not name is not run.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

import viscoroll as vr

from ..peers import lsoda_compiled, paper_method, scipy_peers
from . import baseline
from .problem import Method, Outcome, Problem

#: nodes along alpha, kappa V and s, and the ends of the first two
ATLAS: Any = ((48, 128, 128), (1.0, 100.0), (1e-3, 1e3))
#: right-hand sides after which a peer gives up: 15 s of the paper's method, 1 min of scipy's
_MOST_COMPILED, _MOST_PYTHON = 2_000_000, 300_000


Call = Callable[[], Outcome]


def _ensemble(problem: Problem, rtol: float, method: str) -> Call:
    """This package: :func:`viscoroll.ensemble` on one thread."""

    def call() -> Outcome:
        result = vr.ensemble(
            problem.scene, problem.V0, problem.omega0, problem.t,
            rtol=rtol, method=method, fields=("V", "omega"), threads=1,
        )  # fmt: skip
        return Outcome(result.V, result.omega)

    call()  # compiles, and builds what is built once
    return call


def _baseline(problem: Problem, rtol: float, which: int) -> Call:
    atlas = _atlas() if which == baseline.ATLAS else baseline.no_atlas()
    baseline.run(which, problem.take(slice(1)), 1e-2, atlas)
    return lambda: Outcome(*baseline.run(which, problem, rtol, atlas))


@cache
def _atlas() -> baseline.Atlas:
    return baseline.atlas_of(*ATLAS)


def _paper_method(problem: Problem, rtol: float, name: str) -> Call:
    program, starts = paper_method.build(Path(_build_folder().name)), np.column_stack([problem.V0, problem.omega0])
    given = (program, name, problem.parameters(), starts, problem.t, rtol, _MOST_COMPILED)
    return lambda: Outcome(*paper_method.run(*given))


@cache
def _build_folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="viscoroll-peers-")


def _scipy(problem: Problem, rtol: float, name: str) -> Call:
    columns = np.array(problem.parameters()).T.tolist()
    starts = list(zip(problem.V0.tolist(), problem.omega0.tolist()))

    def call() -> Outcome:
        rolled = [
            scipy_peers.roll(name, tuple(parameters), start, problem.t, rtol, _MOST_PYTHON)
            for parameters, start in zip(columns, starts)
        ]
        V, omega, evaluations = zip(*rolled)
        return Outcome(np.array(V), np.array(omega), evaluations=float(sum(evaluations)))

    return call


_stuck: dict[int, tuple[Problem, lsoda_compiled.Stuck]] = {}


def _lsoda(problem: Problem, rtol: float) -> Call:
    if id(problem) not in _stuck:
        stuck = lsoda_compiled.prepare(problem.scene, problem.V0, problem.omega0, problem.t)
        _stuck[id(problem)] = problem, stuck  # holding the problem keeps its id its own
    stuck = _stuck[id(problem)][1]
    lsoda_compiled.run(stuck, problem.t, 1e-2)
    return lambda: Outcome(*lsoda_compiled.run(stuck, problem.t, rtol))


METHODS = (
    Method(
        "flow", "viscoroll, flow map", partial(_ensemble, method="flow"),
        note="a fixed scene only; building the map is in setup_s; its error is the map's, whatever rtol",
    ),
    Method("table", "viscoroll, integrated", partial(_ensemble, method="integrate")),
    Method(
        "direct", "root solves + RODAS5P", partial(_baseline, which=baseline.DIRECT),
        note="printed equations by Brent-Dekker in numba, pipeline/evidence/bench/baseline.py",
    ),
    Method(
        "atlas", "3-D atlas spline + RODAS5P", partial(_baseline, which=baseline.ATLAS),
        note="ends at kappa V = 1e-3: below, its law is held, 1e-3 in M; pipeline/evidence/bench/baseline.py",
    ),
    Method(
        "lsoda", "LSODA, explicit right-hand side", _lsoda,
        note=f"by {lsoda_compiled.ENGINE}; full slip is given to it and not timed",
        most_motions=1_000_000_000 if lsoda_compiled.ENGINE == "numbalsoda" else 20,
    ),
    Method(
        "gsl-adams", "the paper's method (GSL Adams)", partial(_paper_method, name="adams"), paper_method.missing,
        note="Brent-Dekker in each right-hand side, C; time measured inside the program",
    ),
    Method(
        "gsl-bdf", "GSL BDF, root solves", partial(_paper_method, name="bdf"), paper_method.missing,
        note="Brent-Dekker in each right-hand side, C; time measured inside the program",
    ),
    Method("scipy-lsoda", "scipy LSODA, brentq", partial(_scipy, name="LSODA")),
    Method("scipy-radau", "scipy Radau, brentq", partial(_scipy, name="Radau")),
)  # fmt: skip
