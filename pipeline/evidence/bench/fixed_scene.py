"""Many motions of one scene by its flow map: build, load, time a motion, and agreement with the integrator."""

from __future__ import annotations

from typing import Any

import numpy as np
from tqdm import tqdm

import viscoroll as vr
from viscoroll.motion import flow

from ..timing import nanoseconds, rounds, seconds_of
from .problem import Outcome, speed_error

#: error of the integrator that is allowed for, in rtol: see the docstring of viscoroll.roll
_INTEGRATOR = 30


def fixed_scene(sizes: dict[str, Any]) -> dict[str, Any]:
    """Rows of fields and output times -> ns a motion; the map's own figures."""
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    request = flow.asked(scene, 2.0)
    V0, omega0 = np.random.default_rng(sizes["seed"]).uniform(-2.0, 2.0, (2, sizes["motions"]))
    flow.build(*request, 1)  # compiles
    builds = [seconds_of(lambda: flow.build(*request, 1))[0] for _ in range(sizes["repeats"])]
    made = flow.flow_map(scene, 2.0)

    def load() -> None:
        flow._recent.clear()
        flow.flow_map(scene, 2.0)

    t = np.linspace(0.0, sizes["end"], sizes["times"] + 1)[1:]
    kinds = {
        "final V, omega": (t[-1:], ("V", "omega")), "final V, omega, x": (t[-1:], ("V", "omega", "x")),
        f"V, omega at {t.size} times": (t, ("V", "omega")), f"V, omega, x at {t.size} times": (t, ("V", "omega", "x")),
    }  # fmt: skip

    def roll(times: np.ndarray, fields: tuple[str, ...]) -> vr.Ensemble:
        return vr.ensemble(scene, V0, omega0, times, method="flow", fields=fields, threads=1)

    calls = {name: (lambda given=given: roll(*given)) for name, given in kinds.items()}
    answered = {name: float(call().flow.mean()) for name, call in calls.items()}
    seconds = rounds(calls | {"load": load}, sizes["repeats"])
    few = slice(sizes["exact"])
    best = vr.ensemble(scene, V0[few], omega0[few], t, method="integrate", rtol=1e-11, fields=("V", "omega"))
    found = roll(t, ("V", "omega"))
    by_map, off = found.flow[few], speed_error(Outcome(found.V[few], found.omega[few]), best)
    return {
        "rows": {
            name: nanoseconds(seconds[name], V0.size) | {"answered": answered[name]} for name in kinds
        },
        "error": {
            "final": float(off[by_map, -1].max()), "all_times": float(off[by_map].max()),
            "with_integrated": float(off.max()),
        },
        "compared": by_map.size, "not_in_map": int((~by_map).sum()),
        "stated_error": made.error, "stated_path_error": made.path_error,
        "build_s": float(np.median(builds)), "load_s": float(np.median(seconds["load"])),
        "bytes": int(made.table.nbytes),
    }  # fmt: skip


def agreement(sizes: dict[str, Any]) -> dict[str, Any]:
    """Flow and integrator on the same random starts of random scenes: how much of the stated error is used."""
    rng = np.random.default_rng(sizes["seed"])
    rows = []
    for _ in tqdm(range(sizes["scenes"]), desc="scenes", leave=False, disable=None):
        scene = _random_scene(rng)
        V0, omega0 = rng.uniform(-2.0, 2.0, (2, sizes["starts"]))
        t = np.geomspace(1e-3, 5.0, sizes["times"]) * (1.0 + scene.j) * scene.alpha / (scene.alpha - 1.0)
        given = {"fields": ("V", "omega"), "threads": sizes["threads"]}
        quick = vr.ensemble(scene, V0, omega0, t, method="flow", rtol=1e-3, **given)
        slow = vr.ensemble(scene, V0, omega0, t, method="integrate", rtol=sizes["rtol"], **given)
        off = speed_error(quick, slow)[quick.flow]
        rows.append(
            {name: getattr(scene, name) for name in ("alpha", "kappa", "mu", "j")}
            | {"by_map": float(quick.flow.mean()), "why_not": quick.flow_problem, "stated": quick.flow_error}
            | {"worst": float(off.max(initial=0.0)), "failed": int((quick.status > 1).sum())}
        )
    mapped = [row for row in rows if row["by_map"] > 0.0]
    return {
        "rows": rows,
        "starts": sizes["starts"] * len(rows),
        "scenes_with_map": len(mapped),
        "within_stated": sum(row["worst"] <= row["stated"] + _INTEGRATOR * sizes["rtol"] for row in mapped),
        "worst_share": max((row["worst"] / (row["stated"] + _INTEGRATOR * sizes["rtol"]) for row in mapped), default=0),
    }


def _random_scene(rng: np.random.Generator) -> vr.Scene:
    def log_uniform(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    return vr.Scene(
        log_uniform(1.001, 1e4), log_uniform(0.5, 200.0), log_uniform(0.01, 3.0), 1.0, rng.uniform(0.1, 2.0)
    )
