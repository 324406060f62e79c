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

    from ...kernels.compile import notice
    from ...kernels.compile.folder import cache_root

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
    """A small call of each kind that has kernels of its own.

    ``unsteady=True`` needs nothing more: it is the same engine.
    """

    from ... import Prony, Scene, contact, ensemble, law, roll, steady, stress
    from ...io import tables
    from ...kernels.printed import motion as printed
    from ...motion import flow
    from ...presets import PAPER_SECTION_5

    scene = PAPER_SECTION_5
    modes = Prony([1.0, 2.0], [1.0, 0.1])
    series = Scene(material=modes, kappa=2.91, mu=0.2, gamma=1.0)
    each = series.replace(material=Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1]))
    start: Any = {"V0": [1.0, 1.5], "omega0": [0.0, 0.5], "t": [0.0, 1e-3]}
    yield "contact", lambda: contact(scene, 0.5, delta=0.01)
    yield "contact of an alpha each", lambda: contact(Scene([3.0, 4.0], 2.91, 0.2), 0.5, delta=0.01)
    yield "slopes", lambda: contact(scene, 0.5, delta=0.01, slopes=True)
    yield "contact by root solves", lambda: contact(scene, 0.5, delta=0.01, method="direct")
    yield "contact of a series", lambda: contact(series, 0.5, delta=0.01)
    yield "bound law", lambda: law(scene)
    yield "contact of a series each", lambda: contact(each, 0.5, delta=0.01)
    yield "unsteady rolling of a series", lambda: contact(series, 0.5, delta=0.01, fields="N")
    yield "steady rolling", lambda: steady(scene, force=0.01)
    yield "validity", lambda: scene.validity(0.5)
    yield "stress", lambda: stress(scene, 0.5, 0.5, delta=0.01)
    yield "roll", lambda: roll(scene, 1.0, 0.0, 1e-3)
    yield "ensemble", lambda: ensemble(scene, **start, method="integrate")
    # not ``ensemble`` alone: it might find this map on disk
    yield "flow map", lambda: flow.build((scene.alpha, scene.kappa, scene.mu, scene.j), 1)
    yield "motions by a flow map", lambda: ensemble(scene, **start, method="flow", rest=1e-3)
    yield "law of a material as a file", lambda: tables.law(modes)
    numbers = (scene.alpha, scene.kappa, scene.mu, scene.gamma, scene.j)
    yield "printed law, in full slip", lambda: printed.direct_sliding(1.5, 1.0, *numbers)
    yield "printed law, in partial slip", lambda: printed.direct_sticking(0.1, 0.01, *numbers)
