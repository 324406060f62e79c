"""Materials of many relaxation times: contact, motions and tables for 1 to 30 modes, a pair, and one of either each."""

from __future__ import annotations

from typing import Any

import numpy as np

import viscoroll as vr
from viscoroll.materials.law_table import made

from ..timing import nanoseconds, rounds, seconds_of

MODES = (1, 3, 10, 30)
#: what a material each has
EACH = (1, 3, 10)
#: times of a series over their longest: a third of a decade apart, as a fit has them
_STEP = 3.0


def rubber(modes: int, strength: float = 10.0) -> vr.Prony:
    """Equal strengths that sum up to ``strength``."""
    return vr.Prony(np.full(modes, strength / modes), _STEP ** -np.arange(float(modes)))


def series(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """A row a material: nanoseconds a state, microseconds a motion, and milliseconds of its table."""
    random = np.random.default_rng(sizes["seed"])
    V, s = np.exp(random.uniform(np.log(1e-3), np.log(2.0), sizes["states"])), random.uniform(size=sizes["states"])
    start, t = random.uniform(-2.0, 2.0, (2, sizes["motions"])), np.linspace(0.0, sizes["end"], sizes["times"])
    paper = vr.presets.PAPER_SECTION_5_ROUNDED
    scenes = {"alpha = 11": paper} | {f"{n} modes": paper.replace(material=rubber(n)) for n in MODES}
    scenes["pair of 10 and 3 modes"] = paper.replace(material=vr.Bodies(rubber(10), rubber(3, 2.0), 0.4))
    calls: dict[Any, Any] = {}
    for name, scene in scenes.items():
        delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        fields = ("Q", "M") if scene.like_bodies else ("Q", "M", "M_half_space")
        calls[name, "contact"] = lambda scene=scene, delta=delta, fields=fields: vr.contact(
            scene, V, delta=delta, fields=fields
        )
    scenes |= {f"{n} modes, a material each": paper.replace(material=spread(random, n, start.shape[1])) for n in EACH}
    both = (spread(random, 3, start.shape[1]) for _ in range(2))
    scenes["3 and 3 modes, a pair each"] = paper.replace(material=vr.Bodies(*both, 0.4))
    for name, scene in scenes.items():
        calls[name, "motion"] = lambda scene=scene: vr.ensemble(
            scene, *start, t, rtol=sizes["rtol"], fields=("V", "omega", "x"), method="integrate", threads=1
        )
    for call in calls.values():
        call()
    found = rounds(calls, sizes["repeats"])
    counts = {"contact": sizes["states"], "motion": sizes["motions"]}
    return [
        {"material": name, "table_ms": built(scene)}
        | {kind: nanoseconds(found[name, kind], counts[kind]) for kind in counts if (name, kind) in found}
        for name, scene in scenes.items()
    ]


def spread(random: np.random.Generator, modes: int, count: int) -> Any:
    """Materials whose strengths and times are off by some 10 and 30 %."""
    mean = rubber(modes)
    off = random.standard_normal((2, count, modes))
    return vr.Prony(mean.E * np.exp(0.1 * off[0]), mean.tau * np.exp(0.3 * off[1]))


def built(scene: vr.Scene) -> float | None:
    """Milliseconds that the rows of a series or a pair take; None of an alpha."""
    material = scene.material
    return 1e3 * seconds_of(lambda: made(material))[0] if isinstance(material, vr.Prony | vr.Bodies) else None
