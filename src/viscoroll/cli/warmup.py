"""``viscoroll warmup``."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Callable, Iterator
from typing import Any


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "warmup",
        help="compile what the first calls would otherwise wait for",
        description="Compile the kernels of every public entry point into the cache, once for a machine and a version\n"
        "of the package; quick where they are there.",
        epilog="example:\n  viscoroll warmup",
    )
    parser.set_defaults(run=_warm_up)


def _warm_up(arguments: Namespace) -> int:
    from tqdm import tqdm

    from ..kernels.compile import notice
    from ..kernels.compile.folder import cache_root

    notice.told = True  # by the bar
    began = time.perf_counter()
    calls = dict(_calls())
    with tqdm(total=len(calls), leave=False) as bar:
        for name, call in calls.items():
            bar.set_description(name)
            call()
            bar.update()
    print(f"{len(calls)} entry points are ready in {cache_root()}, {time.perf_counter() - began:.1f} s")
    return 0


def _calls() -> Iterator[tuple[str, Callable[[], Any]]]:
    """A small call of each kind that has kernels of its own."""
    import numpy as np

    from .. import PAPER_SECTION_5, Bodies, Feedback, Prony, Scene, contact, ensemble, law, roll, steady, stress, tables
    from ..motion import flow
    from ..validation.direct_motion import roll_direct

    scene = PAPER_SECTION_5
    modes = Prony([1.0, 2.0], [1.0, 0.1])
    series = Scene(material=modes, kappa=2.91, mu=0.2, gamma=1.0)
    two = Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1])
    each = series.replace(material=two)
    pair = series.replace(material=Bodies(modes, Prony.elastic(), 0.5))
    pairs = series.replace(material=Bodies(two, modes, 0.5))
    start: Any = {"V0": [1.0, 1.5], "omega0": [0.0, 0.5], "t": [0.0, 1e-3]}
    yield "contact", lambda: contact(scene, 0.5, delta=0.01)
    yield "contact of an alpha each", lambda: contact(Scene([3.0, 4.0], 2.91, 0.2), 0.5, delta=0.01)
    yield "many of them", lambda: contact(Scene(np.linspace(1.0, 2.0, 99), 2.91, 0.2), 0.5, delta=0.01)
    yield "slopes", lambda: contact(scene, 0.5, delta=0.01, slopes=True)
    yield "contact by root solves", lambda: contact(scene, 0.5, delta=0.01, method="direct")
    yield "contact of a series", lambda: contact(series, 0.5, delta=0.01)
    yield "bound law", lambda: law(scene)
    yield "stress of a series", lambda: stress(series, 0.5, 0.5, delta=0.01)
    yield "contact of a series each", lambda: contact(each, 0.5, delta=0.01)
    yield "motions of a series each", lambda: ensemble(each, **start)
    yield "their energy lost", lambda: ensemble(each, **start, fields=("slip_loss",))
    yield "contact of a pair each", lambda: contact(pairs, 0.5, delta=0.01)
    yield "motions of a pair each", lambda: ensemble(pairs, **start)
    yield "two bodies", lambda: contact(pair, 0.5, delta=0.01)
    yield "unsteady rolling of a series", lambda: contact(series, 0.5, delta=0.01, fields="N")
    yield "steady rolling", lambda: steady(scene, force=0.01)
    yield "steady rolling of two bodies", lambda: steady(pair, force=0.01)
    yield "steady rolling with feedback", lambda: steady(scene, torque=Feedback(0.01, omega=-0.1))
    yield "steady rolling at a speed", lambda: steady(scene, V=0.1, torque=0.0)
    yield "validity", lambda: scene.validity(0.5)
    yield "validity of a series", lambda: series.validity(0.5)
    yield "stress", lambda: stress(scene, 0.5, 0.5, delta=0.01)
    yield "roll", lambda: roll(scene, 1.0, 0.0, 1e-3)
    yield "driven motion", lambda: roll(scene, 0.0, 0.0, 1e-3, force=0.01)
    yield "driven motions of an alpha each", lambda: ensemble(Scene([3.0, 4.0], 2.91, 0.2, 1.0), **start, force=0.01)
    yield "driven motions of a series each", lambda: ensemble(each, **start, force=0.01)
    yield "motion of two bodies", lambda: roll(pair, 1.0, 0.0, 1e-3)
    yield "ensemble", lambda: ensemble(scene, **start, method="integrate")
    yield "energy lost", lambda: ensemble(scene, **start, method="integrate", fields=("slip_loss",))
    # not ``ensemble`` alone: it might find this map on disk
    yield "flow map", lambda: flow.build((scene.alpha, scene.kappa, scene.mu, scene.j), 1)
    yield "motions by a flow map", lambda: ensemble(scene, **start, method="flow", rest=1e-3)
    yield "law of a material as a file", lambda: tables.law(modes)
    yield "check of motions", lambda: roll_direct(scene, 1.5, 0.5, np.array([0.0, 3e-3]))
