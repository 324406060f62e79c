"""The law bound to one scene beside contact(): a state from Python, from jitted code and from C, and arrays."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

import viscoroll as vr

from ..timing import nanoseconds, rounds, seconds_of
from .jit import compiled
from .series import rubber

FIELDS = ("Q", "M", "M_half_space", "M_cylinder")


@compiled
def jitted_states(law, V, omega):
    """Sum over states, so that none is left out."""
    total = 0.0
    for i in range(V.size):
        state = law(V[i], omega[i])
        total += state.Q + state.M + state.dQ_dV + state.dQ_domega + state.dM_cylinder_dV
    return total


def bound_law(sizes: dict[str, Any]) -> dict[str, Any]:
    """A row for each material and way to call: nanoseconds a state, and those of contact() called alike.

    The states are those of one motion: creep from 0 to delta_star, speeds within a factor of 2.
    """
    random = np.random.default_rng(sizes["seed"])
    V, share = random.uniform(0.2, 0.4, sizes["states"]), random.uniform(size=sizes["states"])
    some = slice(0, sizes["numbers"])
    paper, series = vr.presets.PAPER_SECTION_5_ROUNDED, rubber(3)
    scenes = {
        "one alpha": paper,
        "3 modes": paper.replace(material=series),
        "3 modes on an elastic base": paper.replace(material=vr.Bodies(series, vr.Prony.elastic(), 0.8)),
    }
    calls: dict[Any, Any] = {}
    bound: dict[str, float] = {}
    for name, scene in scenes.items():
        omega = V * (1.0 + share * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star)
        vr.law(scene)  # compiled
        bound[name], law = seconds_of(lambda scene=scene: vr.law(scene.replace(mu=0.3)))
        law = vr.law(scene)
        numbers = list(zip(V[some].tolist(), omega[some].tolist(), strict=True))
        for slopes in (False, True):
            calls[name, "numbers", slopes] = lambda law=law, numbers=numbers, slopes=slopes: [
                law(*state, slopes=slopes) for state in numbers
            ]
            calls[name, "numbers, contact", slopes] = lambda scene=scene, numbers=numbers, slopes=slopes: [
                vr.contact(scene, v, omega=w, fields=FIELDS, slopes=slopes) for v, w in numbers
            ]
            calls[name, "array", slopes] = lambda law=law, omega=omega, slopes=slopes: law(V, omega, slopes=slopes)
            calls[name, "array, contact", slopes] = lambda scene=scene, omega=omega, slopes=slopes: vr.contact(
                scene, V, omega=omega, fields=FIELDS, slopes=slopes
            )
        calls[name, "jitted", True] = lambda law=law, omega=omega: jitted_states(law.jitted, V, omega)
        (function, data), out = law.ctypes, (ctypes.c_double * 8)()
        calls[name, "C by ctypes", True] = lambda function=function, data=data, out=out, numbers=numbers: [
            function(*state, out, data) for state in numbers
        ]
    for call in calls.values():
        call()
    found = rounds(calls, sizes["repeats"])
    counts = {"array": sizes["states"], "jitted": sizes["states"]}

    def row(name: str, way: str, slopes: bool) -> dict[str, Any]:
        count = counts.get(way.removesuffix(", contact"), sizes["numbers"])
        return nanoseconds(found[name, way, slopes], count)

    rows = [
        {"material": name, "way": way, "slopes": slopes} | row(name, way, slopes)
        | {"contact": row(name, ("array" if way == "array" else "numbers") + ", contact", slopes)}
        for name, way, slopes in calls if not way.endswith(", contact")
    ]  # fmt: skip
    return {"rows": rows, "bind_ms": {name: 1e3 * seconds for name, seconds in bound.items()}}
