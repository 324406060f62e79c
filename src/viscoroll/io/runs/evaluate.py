"""One block of a run: draw its inputs, roll its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from ...core.typed import Floats
from ...motion.batch import ensemble
from ...motion.many import Ensemble
from ..sampling import points
from .rollers import drive_of, roller_of
from .runfile import START, Run


def block_inputs(run: Run, block: int) -> dict[str, Floats]:
    """Inputs of the motions of a block, by name."""
    start, stop = run.edges(block)
    settings, dimensions = run.settings, len(run.inputs.dimensions)
    return run.inputs.values(points(settings.design, settings.seed, settings.n, dimensions, start, stop, block))


def roll_inputs(run: Run, values: Mapping[str, Any], count: int = 1, threads: int | None = 1) -> Ensemble:
    """Motions of a run from given inputs, in the units of its file.

    Parameters
    ----------
    run : see :func:`read_run`.
    values : of every uncertain input by name, a number or (n,).
    count : motions, where all inputs are numbers.
    threads : as of :func:`viscoroll.ensemble`.

    Returns
    -------
    Ensemble

    Raises
    ------
    ParameterError
        Inputs that a motion does not allow.
    """
    content, settings = run.inputs.filled(values), run.settings
    start = content["start"]
    V0, omega0 = (np.broadcast_to(start[name], count) if name in start else None for name in START)
    return ensemble(
        roller_of(run.path, content), V0, omega0, run.t, **drive_of(content),
        method=run.method, rtol=settings.rtol, rest=settings.rest, unsteady=settings.unsteady, rested=settings.rested,
        fields=run.fields, speed=run.fastest or None if run.method == "flow" else None, threads=threads,
    )  # fmt: skip


def roll_block(run: Run, block: int) -> tuple[dict[str, Floats], Ensemble]:
    """(inputs, motions) of a block."""
    start, stop = run.edges(block)
    values = block_inputs(run, block)
    return values, roll_inputs(run, values, stop - start)


def look_at_materials(run: Run) -> None:
    """Warn where the fastest start, or the motion of medians, asks materials for what was not measured."""
    medians = run.inputs.medians
    content = run.inputs.filled(medians)
    if "V0" in content["start"]:
        roller_of(run.path, content).look(run.inputs.largest("V0"))
    settings = msgspec.structs.replace(run.settings, summaries=("V",), keep="summaries", method="integrate")
    roll_inputs(replace(run, settings=settings), medians)
