"""One block of a run: its inputs, its motions, and the columns that describe them.

One block of a run, a range of its motions: their random inputs, and the motions themselves.

Long names and units of the columns of a store: uncertain inputs, and fields of the motions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from ..contact_mechanics import transit_frequency, warn_of_contact, warn_of_unmeasured_starts
from ..contact_mechanics.contact import contact
from ..core import SYMBOLS, Floats, shape_error
from ..motion import Ensemble, column_attributes
from ..motion.ensemble import ensemble
from ..roller_toml import CylinderSection
from ..rollers import UNITS
from ..sampling import points
from .run_rollers import drive_of, measured_bands, roller_of
from .runfile import START, Run
from .uncertain_inputs import PREFIXES

# --- One block of a run, a range of its motions ---

#: Number of motions whose starts are compared with the bands of the materials: the standard error
#: of a share of 1 % is then a third of it.
_STARTS = 1000


def block_inputs(run: Run, block: int, most: int | None = None) -> dict[str, Floats]:
    """Draw the inputs of the motions of a block: the same run, block and ``most`` give the same
    bits, whatever blocks were drawn before.

    run: :class:`runs.Run`, of which the inputs, the block size, and seed, design and n of the
    settings are read.
    block: number of the block, from 0 to ``run.blocks - 1``, which is not checked.
    most: number of motions at most, >= 1; None: all of the block.  The inputs of a smaller number
        are a sample of the same distributions, but only with "sobol" are they surely the first ones
        of the whole block.
    Returns name of each uncertain input -> values, float64, (motions,), in the units of the run
    file, where motions is their number in the block, or ``most`` if that is smaller; {} without
    uncertain inputs.  A draw may be infinite where its distribution overflows, which a motion
    refuses.
    """
    start, stop = run.edges(block)
    settings = run.settings
    dimensions = len(run.inputs.dimensions)
    stop = stop if most is None else min(stop, start + most)
    return run.inputs.values(
        points(settings.design, settings.seed, settings.n, dimensions, start, stop, block)
    )


def roll_inputs(
    run: Run, values: Mapping[str, Any], count: int = 1, threads: int | None = 1
) -> Ensemble:
    """Roll motions of a run from given inputs, in the units of its file.

    Parameters
    ----------
    run : a run of :func:`runs.read_run`.
    values : name of each uncertain input -> a number, (1,) or (count,), in the units of the file;
        other names have no effect.
    count : number of motions, >= 1.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, else all cores available.

    Returns
    -------
    Ensemble
        The motions, ``count`` of them, at the output times of the run, in the units of its file,
        with the fields that the run keeps or summarises (``run.fields``); the other fields are
        None.  A motion that cannot be rolled to its end raises nothing: its ``status`` says so, and
        its outputs from there on are NaN.

    Raises
    ------
    ParameterError
        Inputs that a motion does not allow or that are arrays of another length than ``count``, or
        ``threads`` that is no whole number >= 1.
    FileError
        A material that these inputs do not allow.
    KeyError
        An uncertain input that ``values`` does not have.

    Warns
    -----
    ModelWarning
        As :func:`viscoroll.ensemble`, of motions beyond the model or the measured band of their
        material.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> vr.runs.roll_inputs(run, run.inputs.medians).V.shape
    (1, 2)
    """
    for name in run.inputs.uncertain:
        if np.shape(values[name]) not in ((), (1,), (count,)):
            raise shape_error(
                name, np.shape(values[name]), f"a number or one for each motion, count = {count}"
            )
    content = run.inputs.filled(values)
    settings = run.settings
    start = content["start"]
    V0, omega0 = (np.broadcast_to(start[name], count) if name in start else None for name in START)
    return ensemble(
        roller_of(run.path, content),
        V0,
        omega0,
        run.t,
        **drive_of(content),
        method=run.method,
        rtol=settings.rtol,
        rest=settings.rest,
        unsteady=settings.unsteady,
        rested=settings.rested,
        fields=run.fields,
        speed=run.fastest or None if run.method == "flow" else None,
        threads=threads,
    )


def roll_block(run: Run, block: int) -> tuple[dict[str, Floats], Ensemble]:
    """Draw the inputs of a block, and compute its motions, on one thread, as several blocks are
    rolled at a time.

    run: :class:`runs.Run`, with its inputs, settings and output times.
    block: number of the block, from 0 to ``run.blocks - 1``.
    Returns (name of an uncertain input -> values, (motions,), in the units of the run file, as in
    :func:`block_inputs`; the motions, an :class:`Ensemble` with ``run.fields``, as in
    :func:`runs.roll_inputs`).
    Raises ParameterError for inputs that a motion does not allow, FileError for inputs that a
    material does not allow, CancelledError if the run was interrupted
    (:func:`.blocks.cancel_with`).
    """
    start, stop = run.edges(block)
    values = block_inputs(run, block)
    return values, roll_inputs(run, values, stop - start)


def warn_of_materials(run: Run) -> None:
    """Warn of motions of a run outside the measured bands of its materials, judged by their starts
    and by their median.

    The band of a material is the range of angular frequencies in which it was measured.  If [start]
    gives V0 and a material has such a band, the transit frequencies of the first 1000 starts are
    compared with the bands.  If that gives no warning, also without bands, the contact of the
    median roller at the largest start speed is examined.  In any case the motion of the median
    inputs is integrated, which may warn too.

    run: :class:`runs.Run`, with its inputs, settings and output times.
    Returns None; each warning is a :class:`ModelWarning`, that of a band once for each material in
    a process.
    Raises ParameterError for medians that a motion does not allow, also for one of the first 1000
    draws; FileError for those that a material does not allow.
    """
    medians = run.inputs.medians
    content = run.inputs.filled(medians)
    if "V0" in content["start"]:
        bands = measured_bands(run.path, content)
        if not (bands and warn_of_unmeasured_starts(_fraction_outside(run), bands)):
            warn_of_contact(roller_of(run.path, content), run.inputs.largest("V0"))
    settings = msgspec.structs.replace(
        run.settings, summaries=("V",), keep="summaries", method="integrate"
    )
    roll_inputs(replace(run, settings=settings), medians)


def _fraction_outside(run: Run) -> float:
    """Return the fraction of motions whose transit frequency at the start is outside a measured
    band of a material.

    The transit frequency is |V0| divided by the contact length in free rolling at that speed, in
    1/s; it is compared with angular frequencies in rad/s.  The ends of a band are inside, as is a
    start at rest, because the rolling moment M is 0 there.

    run: :class:`runs.Run` in SI units that gives V0; its first motions, at most 1000 of the first
    block, are examined.
    Returns the fraction of these motions that are outside the band of at least one material, a
    float in [0, 1]; 0.0 without bands.
    Raises ParameterError for inputs of these motions that a cylinder does not allow, FileError for
    a material.
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


# --- Long names and units of the columns of a store ---

#: Letter of a Prony series in the name of an input, as in tau_2 -> meaning of the number, with its
#: index.
_SERIES = {
    "E": "strength {} of relaxation, divided by the long-time modulus",
    "tau": "relaxation time {} divided by T_ref",
    "J": "strength {} of creep, divided by the long-time compliance",
    "T": "retardation time {} divided by T_ref",
}


def attributes(name: str, si: bool) -> dict[str, Any]:
    """Return the attributes of a column of a store, of types that JSON has.

    name: name of an input (as base_E, tau_2, drive_torque_time_1), of a field or an end of a motion
        (as V, rest_time, status), or "t".
    si: whether the run is in SI units, else dimensionless.
    Returns a dict with long_name and units ("1" of a dimensionless quantity); of a quantity in the
    table of symbols also symbol and equation, unless it has a dimension and the run is in SI units;
    of the codes regime, status and flow no units, but the list flag_values and the text
    flag_meanings, a word for each code.  The long_name is "" of a name that is none of these.
    """
    if name.startswith(PREFIXES["drive"]):
        load, _, corner = name.removeprefix(PREFIXES["drive"]).partition("_")
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {load}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        about = attributes(load, si)
        return about | {
            "long_name": f"given: {about['long_name']}" + f", value {corner}" * bool(corner)
        }
    if name.startswith(PREFIXES["base"]):
        about = attributes(name.removeprefix(PREFIXES["base"]), si)
        return about | {"long_name": f"base: {about['long_name'].removesuffix(' of the cylinder')}"}
    letter, _, index = name.partition("_")
    if letter in _SERIES and index.isdecimal():
        return {"long_name": _SERIES[letter].format(index), "units": "1"}
    if name in CylinderSection.__struct_fields__ and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": UNITS.get(name, "1")}
    about = column_attributes(name, si)
    return {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in about.items()
    }
