"""One block of a run: draw its inputs, roll its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..cylinder import Cylinder
from ..drive import Schedule
from ..materials.pair import Pair
from ..motion import ensemble
from ..motion.many import Ensemble
from ..scaling import scene_from_si, scene_of_law, scene_of_pair
from ..scene import Scene
from . import draws
from .inputs.drives import drive_of
from .inputs.ranges import CYLINDER, SCENE, SOLID, START
from .inputs.solids import Modes, Solids
from .inputs.units import are_si, dimensionless, scales, unit_of_time
from .runfile import Run


def block_inputs(run: Run, block: int) -> dict[str, Any]:
    """Inputs of the motions of a block: a number, or an array, for each name."""
    start, stop = run.edges(block)
    return run.inputs.values(
        draws.points(
            run.settings.design, run.settings.seed, run.settings.n, len(run.inputs.dimensions), start, stop, block
        )
    )


def scene_of(values: Mapping[str, Any]) -> Scene:
    """The scene, or the scenes, of inputs; raises ParameterError where one is out of range."""
    if are_si(values):
        given = {name: values[name] for name in (*CYLINDER, "plane") if name in values}
        if "T_ref" not in values:
            return scene_from_si(**given)
        others = {name: value for name, value in given.items() if name not in (*SOLID, "plane")}
        if "pair" in values:
            return scene_of_pair(**others, pair=values["pair"])
        law, E_prime = values["solids"].law(values, values["plane"])
        return scene_of_law(**others, E_prime=E_prime, T_ref=values["T_ref"], law=law)
    series = values.get("series")
    material = series.of(values) if isinstance(series, Modes) else series
    return Scene(**{name: values[name] for name in SCENE if name in values}, material=material)


def roll_inputs(run: Run, values: Mapping[str, Any], threads: int | None = 1) -> Ensemble:
    """Dimensionless motions from inputs, over seconds where these are in SI units; one where all are numbers."""
    motion_count = max((np.size(value) for value in values.values()), default=1)
    scene, T, drive, settings = scene_of(values), 1.0, drive_of(values), run.settings
    if are_si(values) and (settings.unsteady or settings.rested):
        # gamma does more than scale time then
        T = unit_of_time(values)
        drive = {
            name: Schedule(each.times / T, each.values) if isinstance(each, Schedule) else each
            for name, each in drive.items()
        }
    elif are_si(values):
        scene = scene.replace(gamma=scene.gamma / unit_of_time(values))
    V0, omega0 = (_column(dimensionless(values, name), motion_count) if name in values else None for name in START)
    found = ensemble(
        scene, V0, omega0, run.t / T,
        method=run.method, rtol=settings.rtol, rest=run.rest, unsteady=settings.unsteady,
        rested=settings.rested if isinstance(settings.rested, bool) else settings.rested / T, fields=run.fields,
        speed=run.fastest or None if run.method == "flow" else None, threads=threads, **drive,
    )  # fmt: skip
    if T == 1.0:
        return found
    over_time = {name: getattr(found, name) for name in ("x", "angle", "onset_time", "rest_time")}
    return replace(found, t=run.t, **{name: each * T for name, each in over_time.items() if each is not None})


def roll_block(run: Run, block: int) -> tuple[dict[str, Any], Ensemble]:
    """(inputs, motions) of a block."""
    values = block_inputs(run, block)
    if run.inputs.dimensions:
        return values, roll_inputs(run, values)
    start, stop = run.edges(block)  # nothing is uncertain: the same motion stop - start times
    free = next(name for name in START if name in values)
    return values, roll_inputs(run, values | {free: np.full(stop - start, values[free])})


def look_at_materials(run: Run) -> None:
    """Warn where the fastest start, or the motion of medians, asks materials for what was not measured."""
    values = run.inputs.values(np.full((len(run.inputs.dimensions), 1), 0.5))
    solids: Solids | None = values.get("solids")
    pair: Pair | None = values.get("pair") if solids is None else solids.typical(values["plane"])
    if pair is None or (pair.cylinder.measured is None and pair.half_space.measured is None):
        return
    given = {name: values[name] for name in (*CYLINDER, "plane") if name in values and name not in SOLID}
    cylinder = Cylinder(**given, material=pair.cylinder, base=pair.base)
    settings = msgspec.structs.replace(run.settings, summaries=("V",), keep="summaries")
    motion = roll_inputs(replace(run, settings=settings), values)
    V0 = run.inputs.largest("V0") if "V0" in values else None
    cylinder.look(V0)
    cylinder.look(motion.V * scales(values)["V"])


def _column(value: Any, count: int) -> NDArray[np.float64]:
    return np.broadcast_to(np.asarray(value, np.float64), (count,))
