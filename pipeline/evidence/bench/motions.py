"""Motions, by every method and tolerance of the configuration: error against time.

A new method needs a function that prepares it, a row of METHODS, and its tolerances in
[bench.*.methods] of the configuration; one that the configuration does not name is not run.
"""

import subprocess
import tempfile
from collections.abc import Callable
from functools import cache, partial
from importlib.metadata import version
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr

from ...stage import Row, Sizes
from ...validation import roll_direct
from ..timing import seconds_of, steady_seconds
from . import peers

# --- what is rolled, what comes back, and how wrong it is ---

PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
#: outputs slower than this do not count as "moving": data/reference/section5.csv ends there too
LEAST_SPEED = 1e-3
REFERENCE_RTOL = 1e-12


class Problem(NamedTuple):
    """n motions from (V0, omega0) at common output times; fields of ``scene`` are numbers or arrays
    (n,).

    ``drive`` : force and torque of each, (n, 2).
    """

    scene: vr.Scene
    V0: NDArray
    omega0: NDArray
    t: NDArray
    drive: NDArray | None = None

    def parameters(self) -> NDArray:
        """alpha, kappa, mu, gamma, j of each motion, a row each."""
        columns = (np.broadcast_to(getattr(self.scene, name), self.V0.shape) for name in PARAMETERS)
        return np.array([*columns]).T

    def take(self, count: int):
        """The first motions, over and over where there are fewer: a single one would time the call
        around it.
        """
        scene = self.scene if self.scene.shape == () else vr.Scene(*self.parameters()[:count].T)
        V0, omega0 = (np.resize(each, count) for each in (self.V0, self.omega0))
        return Problem(
            scene, V0, omega0, self.t, None if self.drive is None else self.drive[:count]
        )

    def rolled(self, **how):
        """By the package."""
        driven = {} if self.drive is None else dict(zip(("force", "torque"), self.drive.T))
        return vr.ensemble(self.scene, self.V0, self.omega0, self.t, **driven, **how)


class Outcome(NamedTuple):
    """V, omega of shape (n, times), NaN where a method gave up; time of all motions where it
    measured that itself.
    """

    V: NDArray
    omega: NDArray
    seconds: float | None = None


def _times(sizes, end):
    return np.linspace(0.0, end, sizes["times"] + 1)[1:]


def paper_problems(sizes):
    """IC1-IC3 of the paper, rounded parameters, to the end or the speed ``LEAST_SPEED``, if that is
    first; and random starts in [-2, 2]^2, the paper's first.
    """
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    end = sizes["end"]
    problems = {}
    for name, start in vr.presets.PAPER_STARTS.items():
        rest = vr.roll(scene, *start, [end], rtol=REFERENCE_RTOL, rest=LEAST_SPEED).rest_time
        problems[name] = Problem(
            scene, *np.array(start)[:, None], _times(sizes, np.fmin(rest, end))
        )
    random = np.random.default_rng(sizes["seed"]).uniform(-2.0, 2.0, (sizes["motions"], 2))
    starts = np.concatenate([list(vr.presets.PAPER_STARTS.values()), random])[: sizes["motions"]]
    return problems | {"random": Problem(scene, *starts.T.copy(), _times(sizes, end))}


def own_problem(sizes):
    """Every motion its own scene."""
    random = np.random.default_rng(sizes["seed"])
    n = sizes["motions"]
    alpha, kappa, gamma = np.exp(
        random.uniform(*np.log([[1.5, 2.0, 5e3], [100.0, 30.0, 2e4]]), (n, 3))
    ).T
    scene = vr.Scene(alpha, kappa, random.uniform(0.1, 0.6, n), gamma, random.uniform(0.3, 1.0, n))
    return {"own": Problem(scene, *random.uniform(-2.0, 2.0, (2, n)), _times(sizes, sizes["end"]))}


def driven_problems(sizes):
    """Random scenes under a force and a torque that stay, from any start and from rest."""
    random = np.random.default_rng(sizes["seed"])
    n = sizes["motions"]
    alpha, kappa, mu = 10.0 ** random.uniform([0.0, 0.4, -1.5], [1.5, 1.7, 0.0], (n, 3)).T
    scene = vr.Scene(1.0 + alpha, kappa, mu, 1.0, random.uniform(0.3, 1.0, n))
    starts = random.normal(size=(2, n))
    drive = 0.5 * mu[:, None] * random.normal(size=(n, 2))
    t = _times(sizes, sizes["end"])
    return {
        "any start": Problem(scene, *starts, t, drive),
        "rest": Problem(scene, *(0.0 * starts), t, drive),
    }


def reference(problem: Problem) -> Outcome:
    """The package at its tightest."""
    best = problem.rolled(rtol=REFERENCE_RTOL, method="integrate")
    return Outcome(best.V, best.omega)


def reference_difference(problem: Problem, best: Outcome, motions: int) -> Row:
    """The reference against the printed equations by scipy's integrators, other unknowns, on the
    first motions.
    """
    few = zip(problem.parameters()[:motions].tolist(), problem.V0, problem.omega0)
    direct = [roll_direct(vr.Scene(*parameters), *start, problem.t) for parameters, *start in few]
    found = Outcome(
        *(np.array([getattr(each, name) for each in direct]) for name in ("V", "omega"))
    )
    method = "root solves of the printed equations, DOP853 and LSODA"
    return {"motions": len(direct), "second_method": method} | errors(found, best)


def speed_error(tried, best) -> NDArray:
    """Difference of (V, omega) over the larger of the two."""
    off = np.maximum(np.abs(tried.V - best.V), np.abs(tried.omega - best.omega))
    return off / np.maximum(np.abs(best.V), np.abs(best.omega))


def errors(tried, best: Outcome, driven: bool = False) -> Row:
    """Relative error of (V, omega), over the larger of the two, if ``driven`` over the largest so
    far, as speeds pass through 0: of outputs with a speed of at least ``LEAST_SPEED``, worst over
    time.

    max, p99: over the motions that were finished; failed: motions that were given up.
    """
    best = Outcome(*(np.resize(each, tried.V.shape) for each in best[:2]))
    off = speed_error(tried, best)
    size = np.maximum(np.abs(best.V), np.abs(best.omega))
    if driven:
        off *= size / np.maximum.accumulate(size, axis=1)
    done = np.isfinite(off).all(axis=1)
    worst = np.where(size >= LEAST_SPEED, off, 0.0)[done].max(axis=1)
    found = {"max": worst.max(), "p99": np.quantile(worst, 0.99)} if worst.size else {}
    return found | {"failed": int((~done).sum())}


# --- methods ---

#: right-hand sides after which the paper's method gives up: 15 s
_MOST = 2_000_000
Call = Callable[[], Outcome]


def _ensemble(problem, rtol, method):
    """This package: :func:`viscoroll.ensemble` on one thread."""
    call = partial(problem.rolled, rtol=rtol, method=method, fields=("V", "omega"), threads=1)
    call()  # compiles, and builds what is built once
    return call


def _paper_method(problem, rtol, name):
    program = peers.paper_program(Path(_build_folder().name))
    starts = np.column_stack([problem.V0, problem.omega0])
    given = (program, name, problem.parameters(), starts, problem.t, rtol, _MOST)
    return lambda: Outcome(*peers.paper_roll(*given))


@cache
def _build_folder():
    return tempfile.TemporaryDirectory(prefix="viscoroll-peers-")


def _lsoda(problem, rtol):
    drive = np.zeros((problem.V0.size, 2)) if problem.drive is None else problem.drive
    parameters = problem.parameters().tolist()
    scenes = np.array(
        [peers.lsoda_given(vr.Scene(*each), *by) for each, by in zip(parameters, drive.tolist())]
    )
    starts = np.column_stack([problem.V0, problem.omega0])
    t = np.concatenate([[0.0], problem.t])
    peers.lsoda_roll(scenes[:1], starts[:1], t, 1e-2)  # compiles
    return lambda: Outcome(*peers.lsoda_roll(scenes, starts, t, rtol)[:, 1:].transpose(2, 0, 1))


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
    "lsoda": Method("LSODA on the law, compiled", _lsoda, peers.lsoda_missing),
    "gsl-adams": Method(
        "the paper's method (GSL Adams)", partial(_paper_method, name="adams"), peers.paper_missing
    ),
    "gsl-bdf": Method(
        "GSL BDF, root solves", partial(_paper_method, name="bdf"), peers.paper_missing
    ),
}


def work_precision(sizes):
    """Groups IC1, IC2, IC3 (one motion each) and ``random`` (the same starts for all methods)."""
    return compare(paper_problems(sizes), sizes)


def own_parameters(sizes):
    """Every motion its own scene."""
    return compare(own_problem(sizes), sizes)


def driven(sizes):
    """Under a force and a torque."""
    return compare(driven_problems(sizes), sizes)


def compare(problems: dict[str, Problem], sizes: Sizes) -> Row:
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
            row | {"us": np.median(row["us"]), "least_us": min(row["us"])} for row, *_ in entries
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
