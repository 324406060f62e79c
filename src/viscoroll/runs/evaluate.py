"""One block of a run: draw its inputs, roll its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from ..material import Material
from ..motion import ensemble
from ..motion.many import Ensemble
from ..pair import Pair
from ..scene import Scene
from ..si.scaling import scene_from_si, scene_of_pair, scene_of_series
from . import draws
from .drives import drive_of
from .ranges import CYLINDER, SCENE, START
from .runfile import Run
from .solids import Modes
from .units import are_si, dimensionless, unit_of_time


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
        if "pair" in values:
            del given["plane"]
            return scene_of_pair(**given, pair=values["pair"])
        if "base" in values:
            return _scene_on_base(values, given)
        if "series" in values:
            return scene_of_series(**given, T_ref=values["T_ref"], series=_series(values))
        return scene_from_si(**given)
    series = _series(values) if "series" in values else None
    return Scene(**{name: values[name] for name in SCENE if name in values}, material=series)


def _scene_on_base(values: Mapping[str, Any], given: dict[str, Any]) -> Scene:
    """The scene of one motion, whose own material rolls on another."""
    E, nu, plane = (given.pop(name) for name in ("E", "nu", "plane"))
    T_ref = values["T_ref"]
    material = Material(E=float(E), nu=float(nu), prony=_series(values), T_ref=T_ref)
    pair = Pair(material, values["base"], plane)
    if pair.T_ref != T_ref:
        raise ParameterError(
            "material", "elastic in a draw", "one that relaxes in every draw, as its T_ref counts time"
        )
    return scene_of_pair(**given, pair=pair)


def _series(values: Mapping[str, Any]) -> Any:
    """The series of a block, or one for each motion."""
    series = values["series"]
    return series.of(values) if isinstance(series, Modes) else series


def roll_inputs(run: Run, values: Mapping[str, Any], threads: int | None = 1) -> Ensemble:
    """Dimensionless motions from inputs, over seconds where these are in SI units; one where all are numbers."""
    if "base" in values and any(np.ndim(value) for value in values.values()):
        return _one_by_one(run, values)
    motion_count = max((np.size(value) for value in values.values()), default=1)
    scene = scene_of(values)
    if are_si(values):
        scene = scene.replace(gamma=scene.gamma / unit_of_time(values))
    V0, omega0 = (_column(dimensionless(values, name), motion_count) if name in values else None for name in START)
    return ensemble(
        scene, V0, omega0, run.t,
        method=run.method, rtol=run.settings.rtol, rest=run.rest, fields=run.fields,
        speed=run.fastest or None if run.method == "flow" else None, threads=threads, **drive_of(values),
    )  # fmt: skip


def _one_by_one(run: Run, values: Mapping[str, Any]) -> Ensemble:
    """Motions of two bodies of their own each, one after another: ``scene`` is that of the first, with every j."""
    count = max(np.size(value) for value in values.values())
    motions = [roll_inputs(run, {name: _of_motion(value, n) for name, value in values.items()}) for n in range(count)]
    first = motions[0]
    found: dict[str, Any] = {}
    for name in (field.name for field in fields(first)):
        if isinstance(getattr(first, name), np.ndarray) and name != "t":
            found[name] = np.concatenate([getattr(motion, name) for motion in motions])
    scene = first.scene.replace(j=_column(values["j"], count))
    return replace(first, scene=scene, **found)


def _of_motion(value: Any, n: int) -> Any:
    return value[n] if isinstance(value, np.ndarray) and value.ndim else value


def roll_block(run: Run, block: int) -> tuple[dict[str, Any], Ensemble]:
    """(inputs, motions) of a block."""
    values = block_inputs(run, block)
    if run.inputs.dimensions:
        return values, roll_inputs(run, values)
    start, stop = run.edges(block)  # nothing is uncertain: the same motion stop - start times
    free = next(name for name in START if name in values)
    return values, roll_inputs(run, values | {free: np.full(stop - start, values[free])})


def _column(value: Any, count: int) -> NDArray[np.float64]:
    return np.broadcast_to(np.asarray(value, np.float64), (count,))
