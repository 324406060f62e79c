"""What is rolled, what comes back, and how wrong it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr

PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
#: outputs slower than this do not count as "moving": data/reference/section5.csv ends there too
LEAST_SPEED = 1e-3
REFERENCE_RTOL = 1e-12


@dataclass(frozen=True)
class Problem:
    """n motions from (V0, omega0) at common output times; fields of ``scene`` are numbers or arrays (n,)."""

    scene: vr.Scene
    V0: NDArray
    omega0: NDArray
    t: NDArray

    @property
    def fixed(self) -> bool:
        """Whether all motions share one scene."""
        return self.scene.shape == ()

    def parameters(self) -> list[NDArray]:
        """alpha, kappa, mu, gamma, j, each of shape (n,)."""
        return [np.broadcast_to(np.asarray(getattr(self.scene, name)), self.V0.shape) for name in PARAMETERS]

    def take(self, which: slice) -> Problem:
        """Some of the motions."""
        scene = self.scene
        if not self.fixed:
            scene = vr.Scene(*(column[which] for column in self.parameters()))
        return replace(self, scene=scene, V0=self.V0[which].copy(), omega0=self.omega0[which].copy())


@dataclass(frozen=True)
class Outcome:
    """V, omega of shape (n, times), NaN where a method gave up.

    ``seconds``: time of all motions where the method measured it itself.
    ``evaluations``: right-hand sides in all, where the method counts them.
    """

    V: NDArray
    omega: NDArray
    seconds: float | None = None
    evaluations: float | None = None


@dataclass(frozen=True)
class Method:
    """One way to roll motions.

    ``prepare(problem, rtol)`` does what is not timed (compilation, tables, a flow map; its time is
    recorded apart) and returns the call that is.  ``missing()`` says why it cannot run here, or None.
    ``note`` stands in the results.  ``most_motions``: what it can be asked for in a sensible time.
    """

    name: str
    label: str
    prepare: Callable[[Problem, float], Callable[[], Outcome]]
    missing: Callable[[], str | None] = lambda: None
    note: str = ""
    most_motions: int = 1_000_000_000


def output_times(end: float, count: int) -> NDArray[np.float64]:
    """``count`` equal steps to ``end``; 0 is not among them."""
    return np.linspace(0.0, end, count + 1)[1:]


def paper_problems(times: int, end: float) -> dict[str, Problem]:
    """IC1-IC3 of the paper, rounded parameters, each until ``end`` or the speed ``LEAST_SPEED``, if that is first."""
    scene, problems = vr.presets.PAPER_SECTION_5_ROUNDED, {}
    for name, start in vr.presets.PAPER_STARTS.items():
        rest = vr.roll(scene, *start, np.array([end]), rtol=REFERENCE_RTOL, rest=LEAST_SPEED).rest_time
        V0, omega0 = (np.array([value]) for value in start)
        problems[name] = Problem(scene, V0, omega0, output_times(np.fmin(rest, end), times))
    return problems


def copies(problem: Problem, count: int) -> Problem:
    """The first motion ``count`` times: a single one would time the call around it."""
    return replace(problem, V0=np.repeat(problem.V0[:1], count), omega0=np.repeat(problem.omega0[:1], count))


def random_problem(motions: int, times: int, end: float, seed: int) -> Problem:
    """Starts uniform in [-2, 2]^2, the paper's rounded parameters; IC1-IC3 come first."""
    first = np.array(list(vr.presets.PAPER_STARTS.values()))
    starts = np.random.default_rng(seed).uniform(-2.0, 2.0, (max(motions - len(first), 0), 2))
    V0, omega0 = np.concatenate([first, starts])[:motions].T.copy()
    return Problem(vr.presets.PAPER_SECTION_5_ROUNDED, V0, omega0, output_times(end, times))


def own_problem(motions: int, times: int, end: float, seed: int) -> Problem:
    """Every motion its own scene: alpha in [1.5, 100], kappa in [2, 30], gamma in [5e3, 2e4] log-uniform,
    mu in [0.1, 0.6], j in [0.3, 1] uniform; starts uniform in [-2, 2]^2.

    mu and kappa are such that full slip does not return, which LSODA without events could not follow.
    """
    rng = np.random.default_rng(seed)

    def log_uniform(low: float, high: float) -> NDArray:
        return np.exp(rng.uniform(np.log(low), np.log(high), motions))

    scene = vr.Scene(
        alpha=log_uniform(1.5, 100.0), kappa=log_uniform(2.0, 30.0), mu=rng.uniform(0.1, 0.6, motions),
        gamma=log_uniform(5e3, 2e4), j=rng.uniform(0.3, 1.0, motions),
    )  # fmt: skip
    V0, omega0 = rng.uniform(-2.0, 2.0, (2, motions))
    return Problem(scene, V0, omega0, output_times(end, times))


def reference(problem: Problem) -> Outcome:
    """The package at its tightest."""
    best = vr.ensemble(problem.scene, problem.V0, problem.omega0, problem.t, rtol=REFERENCE_RTOL, method="integrate")
    return Outcome(best.V, best.omega)


def reference_difference(problem: Problem, best: Outcome, motions: int) -> dict[str, Any]:
    """The reference against the printed equations by scipy's integrators, other unknowns, on the first motions."""
    from pipeline.validation.direct_motion import roll_direct

    few = problem.take(slice(motions))
    columns = np.array(few.parameters()).T
    V, omega = np.empty((2, *best.V[:motions].shape))
    for i, parameters in enumerate(columns):
        direct = roll_direct(vr.Scene(*map(float, parameters)), few.V0[i], few.omega0[i], few.t)
        V[i], omega[i] = direct.V, direct.omega
    difference = errors(Outcome(V, omega), Outcome(best.V[:motions], best.omega[:motions]))
    return {"motions": motions, "second_method": "root solves of the printed equations, DOP853 and LSODA"} | difference


def speed_error(tried: Any, best: Any) -> NDArray:
    """Difference of (V, omega) over the larger of the two."""
    off = np.maximum(np.abs(tried.V - best.V), np.abs(tried.omega - best.omega))
    return off / np.maximum(np.abs(best.V), np.abs(best.omega))


def errors(tried: Outcome, best: Outcome) -> dict[str, Any]:
    """Relative error of (V, omega), over the larger of the two, worst over time; over the motions that were finished.

    max, median, p99: all outputs; max_moving, p99_moving: outputs with a speed of at least ``LEAST_SPEED``.
    failed: motions that were given up.
    """
    n = len(tried.V)
    best = Outcome(best.V[:n], best.omega[:n])
    each, size = speed_error(tried, best), np.maximum(np.abs(best.V), np.abs(best.omega))
    done = np.isfinite(each).all(axis=1)
    if not done.any():
        return {"failed": n}
    worst = each[done].max(axis=1)
    moving = np.where(size >= LEAST_SPEED, each, 0.0)[done].max(axis=1)
    return {
        "max": float(worst.max()), "p99": float(np.quantile(worst, 0.99)), "median": float(np.median(worst)),
        "max_moving": float(moving.max()), "p99_moving": float(np.quantile(moving, 0.99)),
        "failed": int(n - done.sum()),
    }  # fmt: skip
