"""One block of a run: its random inputs and its motions."""

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

#: Number of motions whose starts are compared with the bands of the materials: the standard error of a share of 1 % is
#: then a third of it.
_STARTS = 1000


def block_inputs(run: Run, block: int, most: int | None = None) -> dict[str, Floats]:
    """Return the inputs of the motions of a block: name -> values, (motions,), in the units of the run file.

    run: :class:`Run`, the run.
    block: number of the block, from 0.
    most: number of motions at most, the first of the block; None: all of it.
    """
    start, stop = run.edges(block)
    settings, dimensions = run.settings, len(run.inputs.dimensions)
    stop = stop if most is None else min(stop, start + most)
    return run.inputs.values(points(settings.design, settings.seed, settings.n, dimensions, start, stop, block))


def roll_inputs(run: Run, values: Mapping[str, Any], count: int = 1, threads: int | None = 1) -> Ensemble:
    """Roll motions of a run from given inputs, in the units of its file.

    Parameters
    ----------
    run : a run of :func:`read_run`.
    values : name of each uncertain input -> a number or (n,), in the units of the file.
    count : number of motions; n where an input is an array (n,).
    threads : number of threads; None: all cores available.

    Returns
    -------
    Ensemble
        The motions, with the fields that the run needs.

    Raises
    ------
    ParameterError
        Inputs that a motion does not allow.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> vr.runs.roll_inputs(run, run.inputs.medians).V.shape
    (1, 2)
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
    """Draw the inputs of a block, and compute its motions.

    run: :class:`Run`, the run.
    block: number of the block, from 0.
    Returns (name of an input -> values, (motions,), in the units of the run file; the motions, an :class:`Ensemble`
    with the fields that the run needs).
    Raises ParameterError for inputs that a motion does not allow.
    """
    start, stop = run.edges(block)
    values = block_inputs(run, block)
    return values, roll_inputs(run, values, stop - start)


def warn_of_materials(run: Run) -> None:
    """Warn of motions of a run outside the measured bands of its materials, judged by their starts and by their median.

    The band of a material is the range of frequencies at which it was measured.  The starts of a run in SI units with a
    start speed are compared with the bands.  In any case the motion of the median inputs is computed, which may warn
    too.

    run: :class:`Run`, the run.
    Returns nothing; warnings are those of :func:`viscoroll.ensemble`.
    """
    medians = run.inputs.medians
    content = run.inputs.filled(medians)
    if "V0" in content["start"]:
        bands = measured_bands(run.path, content)
        if not (bands and warn_of_unmeasured_starts(_fraction_outside(run), bands)):
            warn_of_contact(roller_of(run.path, content), run.inputs.largest("V0"))
    settings = msgspec.structs.replace(run.settings, summaries=("V",), keep="summaries", method="integrate")
    roll_inputs(replace(run, settings=settings), medians)


def _fraction_outside(run: Run) -> float:
    """Return the fraction of motions whose transit frequency at the start is outside a measured band of a material.

    The transit frequency is |V| divided by the contact length.  A start at rest is inside: M is 0 there.

    run: a run in SI units, whose first motions, at most 1000, are examined.
    Returns the fraction, 0 to 1.
    """
    content = run.inputs.filled(block_inputs(run, 0, _STARTS))
    roller: Any = roller_of(run.path, content)
    V0 = np.abs(content["start"]["V0"])
    scene = roller.scene()
    lam = contact(scene, V0 / roller.scale["V"], delta=0.0, fields="lam").lam
    frequency = transit_frequency(V0, lam * roller.R / scene.kappa)
    outside: Any = False
    for low, high in measured_bands(run.path, content).values():
        outside = outside | (frequency < low) | (frequency > high)
    return float(np.mean(outside & (V0 > 0.0)))
