"""Measure what README.md and docs/ state -> data/results/measured.json (kept in git).

    python -m pipeline.evidence.measure [--config FILE] [--quick] [-o FILE]

Errors of the contact law against 50 digits, of the stresses by their closures, of the motion
against the tightest tolerance; times of everything a user waits for.  Sizes and seeds are in
[measure] of the configuration, those of --quick in [measure.quick].  Times are of this machine, at
this moment: run it with nothing else running.  pipeline/evidence/document/ puts the numbers into the text.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr
from pipeline.validation.states import differences
from pipeline.validation.stresses import closures

from ..bench.cold_start import cold_start
from ..bench.problem import speed_error
from ..results import run
from ..timing import alternating
from ..truth import contact_precise

FIELDS = ("lam", "epsilon", "delta_star", "beta", "Q", "M")
DIGITS = 50
#: rtol of the motions that the others are held against: the tightest that roll accepts
REFERENCE_RTOL = 1e-12
#: a motion is followed until its speed has fallen to this share of its start
LEAST_SPEED = 1e-6 / 1.5


def measure(sizes: dict[str, Any]) -> dict[str, Any]:
    """Everything that measured.json holds beside the machine."""
    os.environ["VISCOROLL_THREADS"] = "1"  # every time is that of one core
    return {
        "contact_error": contact_errors(sizes),
        "table_against_direct": table_against_direct(sizes),
        "stress_closure": stress_closures(sizes),
        "motion_error": motion_errors(sizes),
        "time": call_times(sizes) | process_times(sizes),
        "sizes": sizes,
    }


def random_states(
    count: int, seed: int, kappa_V: tuple[float, float], s_edge: tuple[float, float]
) -> tuple[vr.Scene, NDArray, NDArray]:
    """Scenes, V and delta: everything log-uniform, half of s = |delta|/delta_star toward 0, half toward 1."""
    rng = np.random.default_rng(seed)

    def log_uniform(low: float, high: float) -> NDArray:
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    scene = vr.Scene(log_uniform(1.0, 1e4), log_uniform(1.0, 100.0), log_uniform(0.01, 1.0))
    V = log_uniform(*kappa_V) / scene.kappa
    toward_0, toward_1 = log_uniform(s_edge[0], 0.5), 1.0 - log_uniform(s_edge[1], 0.5)
    s = np.where(rng.random(count) < 0.5, toward_0, toward_1)
    return scene, V, s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star


def contact_errors(sizes: dict[str, Any]) -> dict[str, Any]:
    """Relative error of each field against 50 digits; beta's is times 1 - s, over its condition number."""
    scene, V, delta = random_states(sizes["states"], sizes["seed"], (1e-7, 1e5), (1e-8, 1e-6))
    table = vr.contact(scene, V, delta=delta, fields=FIELDS)
    errors = np.empty((len(FIELDS), V.size))
    for i in tqdm(range(V.size), desc="contact against 50 digits", delay=1.0, leave=False):
        exact = contact_precise(scene.alpha[i], scene.kappa[i], scene.mu[i], V[i], delta[i], DIGITS)
        for row, name in zip(errors, FIELDS, strict=True):
            # the difference is formed with all digits: a double converts exactly
            error = abs((exact[name] - float(getattr(table, name)[i])) / exact[name])
            row[i] = error * (1 - float(delta[i]) / exact["delta_star"]) if name == "beta" else error
    return {
        name: {"worst": float(row.max()), "median": float(np.median(row))}
        for name, row in zip(FIELDS, errors, strict=True)
    }


def table_against_direct(sizes: dict[str, Any]) -> dict[str, float]:
    """Worst difference between the methods; lam, delta_star relative, the others absolute in the units named."""
    scene, V, delta = random_states(sizes["direct_states"], sizes["seed"] + 1, (1e-3, 1e3), (1e-6, 1e-6))
    table, direct = (vr.contact(scene, V, delta=delta, fields=FIELDS, method=method) for method in ("table", "direct"))
    return differences(table, direct, scene)


def stress_closures(sizes: dict[str, Any]) -> dict[str, float]:
    """Int p dx, Int tau dx and Int x p dx against load, Q and M; relative to the load."""
    scene, V, delta = random_states(sizes["stress_states"], sizes["seed"] + 2, (1e-3, 1e3), (1e-6, 1e-6))
    found = [
        closures(vr.Scene(scene.alpha[i], scene.kappa[i], scene.mu[i]), float(V[i]), float(delta[i]))
        for i in range(V.size)
    ]
    names = {"load": "load", "traction": "Q", "moment": "M"}
    return {name: float(np.max([abs(one[key]) for one in found])) for name, key in names.items()}


def motions(sizes: dict[str, Any]) -> dict[str, list[tuple[vr.Scene, float, float]]]:
    """IC1-IC3 with the rounded parameters, and random scenes with random starts."""
    rng = np.random.default_rng(sizes["seed"] + 3)
    paper = [(vr.presets.PAPER_SECTION_5_ROUNDED, *start) for start in vr.presets.PAPER_STARTS.values()]
    random = []
    for _ in range(sizes["scenes"]):
        alpha, kappa, mu = (
            float(np.exp(rng.uniform(np.log(a), np.log(b)))) for a, b in ((1.1, 1e3), (1, 100), (0.02, 1))
        )
        scene = vr.Scene(alpha, kappa, mu, gamma=1e4, j=rng.uniform(0.3, 1.0))
        random.append((scene, *map(float, rng.uniform(-2.0, 2.0, 2))))
    return {"paper": paper, "random": random}


def motion_errors(sizes: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """rtol -> largest errors over time and motions (see motion_difference), and the median of the steps."""
    results: dict[str, dict[str, Any]] = {}
    for group, cases in motions(sizes).items():
        references = []
        for scene, V0, omega0 in cases:
            rest = LEAST_SPEED * max(abs(V0), abs(omega0))
            end = vr.roll(scene, V0, omega0, np.array([1e6]), rtol=REFERENCE_RTOL, rest=rest).rest_time
            references.append(
                vr.roll(scene, V0, omega0, np.geomspace(1e-6 * end, end, sizes["times"]), rtol=REFERENCE_RTOL)
            )
        results[group] = {}
        for rtol in tqdm(sizes["rtol"], desc=f"motions ({group})", delay=1.0, leave=False):
            tried = [vr.roll(*case, best.t, rtol=rtol) for case, best in zip(cases, references, strict=True)]
            pairs = [motion_difference(m, best) for m, best in zip(tried, references, strict=True)]
            worst = {name: max(pair[name] for pair in pairs) for name in pairs[0]}
            results[group][f"{rtol:.0e}"] = worst | {"steps": float(np.median([m.steps for m in tried]))}
    return results


def motion_difference(motion: Any, best: Any) -> dict[str, float]:
    """Largest relative errors over time.

    speed: of V and omega, over the larger of the two.  speed_over_condition: that over
    max(1, t |V'|/|V|): a motion that is later by the share 1e-9 of t is off by that many times 1e-9
    in V, however well it is computed.  x: over the longest way so far.  onset: over itself.
    """
    size = np.maximum(np.abs(best.V), np.abs(best.omega))
    speed = speed_error(motion, best)
    state, scene = best.contact(("Q", "M")), best.scene
    rate = scene.gamma * np.maximum(np.abs(state.Q - 0.5 * state.M), np.abs(state.Q + 0.5 * state.M) / scene.j)
    errors = {
        "speed": np.max(speed),
        "speed_over_condition": np.max(speed / np.maximum(best.t * rate / size, 1.0)),
        "x": np.max(np.abs(motion.x - best.x) / np.maximum.accumulate(np.abs(best.x))),
        "onset": 0.0,
    }
    if np.isfinite(best.onset_time) or np.isfinite(motion.onset_time):
        errors["onset"] = abs(motion.onset_time / best.onset_time - 1.0)
    return {name: float(error) if np.isfinite(error) else np.inf for name, error in errors.items()}


def call_times(sizes: dict[str, Any]) -> dict[str, float]:
    """Median times on one core: of a state or motion in arrays, and of single calls; motions end at t = 3e-3."""
    n, m = sizes["timed_states"], sizes["timed_motions"]
    rng = np.random.default_rng(sizes["seed"] + 4)
    scene, end = vr.presets.PAPER_SECTION_5, np.array([3e-3])
    each = scene.replace(alpha=np.exp(rng.uniform(0.0, np.log(100.0), n)))
    V, s = np.exp(rng.uniform(np.log(1e-3), np.log(2.0), n)), rng.uniform(0.0, 1.2, n)
    starts = np.random.default_rng(sizes["seed"] + 5).uniform(-2.0, 2.0, (2, 51 * m))
    #: name -> (what its time is over, call)
    calls: dict[str, tuple[float, Callable[[], Any]]] = {}

    def contact(name: str, which: vr.Scene, count: int, **options: Any) -> None:
        delta = s[:count] * vr.contact(which, V[:count], delta=0.0, fields="delta_star").delta_star
        calls[name] = (
            1e-9 * count, lambda: vr.contact(which, V[:count], delta=delta, fields=("Q", "M"), **options)
        )  # fmt: skip

    def motions(name: str, V0: NDArray, omega0: NDArray, **options: Any) -> None:
        calls[name] = 1e-6 * V0.size, lambda: vr.ensemble(scene, V0, omega0, end, **options)

    contact("contact_one_alpha_ns", scene, n)
    contact("contact_an_alpha_each_ns", each, n)
    contact("contact_direct_ns", scene, max(n // 20, 1), method="direct")
    calls["contact_single_us"] = 1e-6, lambda: vr.contact(scene, 0.5, delta=-0.01)
    for rtol in (1e-6, 1e-8):
        calls[f"roll_{rtol:.0e}_us"] = 1e-6, lambda rtol=rtol: vr.roll(scene, 1.5, 0.5, end, rtol=rtol)
        motions(f"ensemble_{rtol:.0e}_us", *starts[:, :m], rtol=rtol, method="integrate")
    motions("flow_us", *starts[:, m:], method="flow")
    for _, call in calls.values():
        call()  # compiles, and builds the map
    seconds = alternating({name: call for name, (_, call) in calls.items()}, sizes["repeats"])
    return {name: seconds[name] / over for name, (over, _) in calls.items()}


def process_times(sizes: dict[str, Any]) -> dict[str, float]:
    """Whole processes: import over a bare python, and the program rolling IC1; kernels cached."""
    processes = {"processes": ["bare_python", "import", "cli_roll"], "repeats": sizes["processes"]}
    found = cold_start(processes)
    return {
        "bare_python_s": found["bare_python"]["s"], "import_s": found["import"]["over_bare_s"],
        "cli_roll_s": found["cli_roll"]["s"],
    }  # fmt: skip


if __name__ == "__main__":
    sys.exit(run("measure", measure, __doc__, "measured.json"))
