"""What a scene does not need and what leaving it out saves: pairs of runs that differ in one thing."""

from __future__ import annotations

from typing import Any

import numpy as np

import viscoroll as vr

from ..timing import alternating


def skips(sizes: dict[str, Any]) -> dict[str, Any]:
    """For each: seconds with and without the work, and the ratio."""
    n, m = sizes["states"], sizes["motions"]
    rng = np.random.default_rng(sizes["seed"])
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    elastic = scene.replace(alpha=1.0)
    V, s = np.exp(rng.uniform(np.log(1e-3), np.log(2.0), n)), rng.uniform(0.0, 1.0, n)
    delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    delta_elastic = s * vr.contact(elastic, V, delta=0.0, fields="delta_star").delta_star
    sliding = np.full(n, 1.0)
    V0, omega0 = rng.uniform(-2.0, 2.0, (2, m))
    slow = np.full(m, 1e-9)
    t, early = np.linspace(0.0, 3e-3, 31)[1:], np.linspace(0.0, 1e-6, 31)[1:]

    def contact(which, creep, fields=("Q", "M")):
        return lambda: vr.contact(which, V, delta=creep, fields=fields)

    def ensemble(which=scene, V0=V0, omega0=omega0, t=t, fields=("V", "omega"), method="integrate", **options):
        return lambda: vr.ensemble(which, V0, omega0, t, fields=fields, threads=1, method=method, **options)

    pairs = {
        "alpha = 1: no Bessel ratio (contact)": (contact(scene, delta), contact(elastic, delta_elastic)),
        "alpha = 1: no Bessel ratio (motion)": (ensemble(), ensemble(elastic)),
        "full slip only: neither beta nor Q (contact)": (contact(scene, delta), contact(scene, sliding)),
        "full slip only (motion)": (ensemble(), ensemble(t=early)),
        "only lam asked for (contact)": (contact(scene, delta, None), contact(scene, delta, ("lam",))),
        "only M asked for (contact)": (contact(scene, delta, None), contact(scene, delta, ("M",))),
        "final state only (motion)": (ensemble(), ensemble(t=t[-1:])),
        "rest: outputs filled behind it": (ensemble(), ensemble(rest=1e-1)),
        "one scene: looked up, not integrated": (ensemble(), ensemble(method="flow")),
        "distance not asked for (flow map)": (
            ensemble(method="flow", fields=("V", "omega", "x")),
            ensemble(method="flow"),
        ),
        "all at rest": (ensemble(), ensemble(V0=0.0 * V0, omega0=0.0 * omega0)),
        "all below the rest threshold": (ensemble(V0=slow, omega0=slow), ensemble(V0=slow, omega0=slow, rest=1e-6)),
    }
    calls = {(name, side): call for name, both in pairs.items() for side, call in zip(("all", "skipped"), both)}
    for call in calls.values():
        call()
    seconds = alternating(calls, sizes["repeats"])
    return {
        name: {
            "all_s": seconds[name, "all"], "skipped_s": seconds[name, "skipped"],
            "ratio": seconds[name, "all"] / seconds[name, "skipped"],
        }
        for name in pairs
    }  # fmt: skip
