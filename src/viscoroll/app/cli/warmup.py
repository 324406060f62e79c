"""``viscoroll warmup``: compilation of all kernels into the cache."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Callable
from typing import Any

import viscoroll as vr

from .arguments import command


@command("warmup")
def warm_up(arguments: Namespace) -> None:
    """Compile all kernels into the cache by small calls, with a progress bar on standard error.

    A line with the number of calls, the folder of the cache and the time in s is printed at the end.  Kernels that the
    cache has are loaded only.  A cache that cannot be written causes a RuntimeWarning, and the line all the same.

    arguments: parsed command line, not used.
    Returns None, exit code 0.
    """
    from tqdm import tqdm

    from ...kernels.compile import notice
    from ...kernels.compile.folder import cache_root

    notice.announced = True  # the bar takes the place of the notice
    start = time.perf_counter()
    calls = _calls()
    bar = tqdm(calls.items(), leave=False)
    for name, call in bar:
        bar.set_description(name)
        call()
    print(f"{len(calls)} entry points are ready in {cache_root()}, {time.perf_counter() - start:.1f} s")


def _calls() -> dict[str, Callable[[], Any]]:
    """Return small calls that together use all kernels.

    Motions use the kernels of contacts, and all motions have one integrator.  Half-spaces, lists of alphas and of
    series, and layers have kernels of their own.

    Returns a dict, name for the progress bar -> function without arguments, whose result is not used; each makes its
    call when it is called, and nothing is written but the cache.
    """
    from ...motion import flow

    scene = vr.presets.PAPER_SECTION_5
    modes = vr.Prony([1.0, 2.0], [1.0, 0.1])
    series = vr.Scene(material=modes, kappa=2.91, mu=0.2, gamma=1.0)
    many = series.replace(material=vr.Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1]))
    covered = series.replace(material=vr.Cover(modes, nu=0.5, thickness=1.0))
    thick = covered.replace(material=vr.Cover(1.0, nu=0.5, thickness=[1.0, 1.5]))
    return {
        # build_map computes a map; ensemble might find one on disk
        "motions and flow maps": lambda: flow.build_map((scene.alpha, scene.kappa, scene.mu, scene.j), 1),
        "contact by root solves": lambda: vr.contact(scene, 0.5, delta=0.01, method="direct"),
        "contact with an array of alpha": lambda: vr.contact(vr.Scene([3.0, 4.0], 2.91, 0.2), 0.5, delta=0.01),
        "contact with an array of Prony series": lambda: vr.contact(many, 0.5, delta=0.01),
        "unsteady rolling": lambda: vr.contact(series, 0.5, delta=0.01, fields="N"),
        "bound law": lambda: vr.law(scene),
        "motions on a cover": lambda: vr.roll(covered, 0.5, 0.5, 0.1),
        "contact on a cover": lambda: vr.contact(covered, 0.5, delta=0.01),
        "steady rolling on a cover": lambda: vr.steady(covered, force=0.01),
        "bound law of a cover": lambda: vr.law(covered),
        "contact with an array of thicknesses": lambda: vr.contact(thick, 0.5, delta=0.01),
        "steady rolling": lambda: vr.steady(scene, force=0.01),
        "stress": lambda: vr.stress(scene, 0.5, 0.5, delta=0.01),
    }
