"""One block of a run: draw its inputs, roll its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from ...contact_law.contact import contact
from ...contact_law.validity.assumptions import transit_frequency
from ...contact_law.validity.model_warnings import warn_of_contact, warn_of_unmeasured_starts
from ...core.array_types import Floats
from ...motion.ensemble import ensemble
from ...motion.ensemble_result import Ensemble
from ..sampling import points
from .rollers import drive_of, measured_bands, roller_of
from .runfile import START, Run

#: motions whose starts are looked at: a share of 1 % is told to a third of it
_DRAWS = 1000


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
    """Warn of the share of motions that start where materials were not measured; and as the motion of medians does."""
    medians = run.inputs.medians
    content = run.inputs.filled(medians)
    if "V0" in content["start"]:
        bands = measured_bands(run.path, content)
        if not (bands and warn_of_unmeasured_starts(_share_outside(run), bands)):
            warn_of_contact(roller_of(run.path, content), run.inputs.largest("V0"))
    settings = msgspec.structs.replace(run.settings, summaries=("V",), keep="summaries", method="integrate")
    roll_inputs(replace(run, settings=settings), medians)


def _share_outside(run: Run) -> float:
    """Share of the first draws whose contact at the start is passed at a rate that a body's data do not hold.

    Rest is passed over: M is 0 there.
    """
    settings, stop = run.settings, min(run.edges(0)[1], _DRAWS)
    drawn = points(settings.design, settings.seed, settings.n, len(run.inputs.dimensions), 0, stop, 0)
    content = run.inputs.filled(run.inputs.values(drawn))
    roller: Any = roller_of(run.path, content)
    V0 = np.abs(content["start"]["V0"])
    scene = roller.scene()
    lam = contact(scene, V0 / roller.scale["V"], delta=0.0, fields="lam").lam
    rate = transit_frequency(V0, lam * getattr(roller, "like", roller).R / scene.kappa)
    bands = measured_bands(run.path, content).values()
    outside = [(rate < low) | (rate > high) for low, high in bands]
    return float(np.mean(np.logical_or.reduce(np.broadcast_arrays(*outside)) & (V0 > 0.0)))
