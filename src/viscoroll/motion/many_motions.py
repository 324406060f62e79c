"""Solution of many motions, by the flow map of their scene or by integration: :func:`solve_batch`.

All is dimensionless.  T_ref is the unit of time of the motions: T_epsilon of a material that is an
alpha, the ``T_ref`` of any other material.  Speeds are divided by R/T_ref.  gamma = P T_ref^2/(m
R).
"""

from typing import Any, NamedTuple

import numpy as np

from ..core import (
    TIME_POWERS,
    Booleans,
    Floats,
    Integers,
    MotionStatus,
    NDArray,
    ParameterError,
    broadcast_vector,
    extent,
    run_blocks,
)
from ..kernels.records import Motions
from ..laws import law_table, record_of_alphas, record_of_materials
from ..materials import Bodies
from .flow import FlowResult, flow_map, look_up_ensemble
from .motion_arguments import LOSSES, ROWS, SPEED_RANGE, STATES, dimensionless_error
from .motion_problem import MotionProblem, integrate

#: Motions in a block of work where all are integrated: some hundredths of a second.
_BLOCK = 256
#: Motions in a block of work where most come from a flow map.
_MAPPED_BLOCK = 1 << 14
#: Motions from which on method "auto" uses the flow map: building one takes as long as integrating
#: three to five thousand (docs/benchmark.md, "One scene").
FLOW_PAYS = 4096


class Batch(NamedTuple):
    """Motions to be solved; dimensionless.

    problem : :class:`MotionProblem`, the checked motions.
    inputs : name -> vector, (1,) where one value holds for all motions, else (n,), in the order
    alpha, kappa, mu, gamma, j, V0, omega0.
    immobile : whether a motion is too slow to leave the indentation of a standstill, (n,); its size
    is the number of motions.
    times : output times since the start, (times,), >= 0, ascending, in T_ref.
    rows : names, out of :data:`.motion_arguments.ROWS`, of the quantities to compute.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    progress : title of a progress bar, None for none.
    """

    problem: MotionProblem
    inputs: dict[str, NDArray]
    immobile: Booleans
    times: Floats
    rows: tuple[str, ...]
    threads: int | None
    progress: str | None


def _reason_against_map(problem: MotionProblem) -> str:
    """Return why no flow map contains the motions of a problem, in words of a message; "" if one
    may.
    """
    scene = problem.scene
    if problem.unsteady:
        return "unsteady=True is given"
    if problem.driven:
        return "a force, torque, slope, brake, drag or prescribed speed is given"
    if scene.tabulated or not scene.like_bodies:
        return "the law is not that of two half-spaces of one material"
    if scene.shape:
        return "numbers of the roller are arrays, so that motions differ in more than V0 and omega0"
    return ""


def solve_batch(
    batch: Batch, method: str, speed: float | None
) -> tuple[FlowResult, dict[str, Any]]:
    """Solve motions: look up those that the flow map of their scene contains, and integrate all
    others.

    A flow map is a table of all free motions of one scene (:mod:`.flow`).  It is tried only for
    free motions (no drive, no added mass) of one scene whose bodies are alike.  Where its stated
    error exceeds rtol, as the infinite one of a scene without a map does, the map is not used, and
    all motions are integrated; "flow_error" and "flow_problem" of the result say so.  All are
    integrated too where all start at rest and ``speed`` is None.  Nothing is raised in these cases,
    with method "flow" neither.  A damaged map on disk is built again, with a RuntimeWarning.

    Motions that stay in the indentation of a standstill (``immobile``) are not integrated: they
    have status CAUGHT and NaN in all quantities, onset and rest times, no switches, and ``flow`` is
    False.

    batch: :class:`Batch`, the motions.
    method: "auto" (a map is tried from :data:`FLOW_PAYS` motions on), "flow" (for any number) or
    "integrate" (never), as in :func:`viscoroll.ensemble`.
    speed: highest speed, > 0, for which the flow map is made, dimensionless; None: the largest |V0|
    or |omega0|.  It is ignored, and not checked, where no map is tried.
    Raises ParameterError for method "flow" with parameters that are arrays, with driven or unsteady
    motions, or with bodies that differ (covers and grids included); where a map is tried, also for
    a ``speed`` above 1e100; for a number of threads that is no whole number >= 1.
    Returns (the motions, a :class:`.flow.FlowResult`, times in T_ref; name -> value of
    "flow_error", the stated error of the flow map, NaN where none was tried, "flow_problem", why
    the scene has none, "flow", whether each motion is from the map, (n,), and "steps", steps of
    integration, (n,)).  A motion that could not be integrated to its end has a status above RESTED,
    and NaN at the times that it did not reach.
    """
    immobile = batch.immobile
    reason = _reason_against_map(batch.problem)
    if method == "flow" and reason:
        raise ParameterError("method", "'flow'", f"'auto' or 'integrate', as {reason}")
    found = None
    about: dict[str, Any] = {"flow_error": np.nan, "flow_problem": ""}
    if not reason and (method == "flow" or (method == "auto" and immobile.size >= FLOW_PAYS)):
        found = _solve_by_flow_map(batch, speed, about)
    if found is None:
        found = FlowResult.empty(len(batch.rows), immobile.size, batch.times.size)
    about["flow"] = found.status >= 0
    if immobile.any():
        about["flow"] &= ~immobile
        found.out[:, immobile] = found.onset[immobile] = found.rest[immobile] = np.nan
        found.status[immobile] = MotionStatus.CAUGHT
        found.switches[immobile] = 0
    about["steps"] = _integrate_others(found, batch)
    return found, about


def _solve_by_flow_map(
    batch: Batch, speed: float | None, about: dict[str, Any]
) -> FlowResult | None:
    """Look motions up in the flow map of their scene, which is built if there is none yet.

    The map counts time in the material's own unit.  Speeds and times are converted to that unit for
    the look-up, and the results are converted back to T_ref.

    batch: :class:`Batch`, free motions of one scene; all but ``immobile`` is read.
    speed: highest speed for which the flow map is made, > 0, dimensionless; None: the largest |V0|
    or |omega0|.
    about: dict that receives "flow_error" and "flow_problem" of the map; it stays as it is where
    all motions are at rest and ``speed`` is None.
    Raises ParameterError for a ``speed`` that, in the material's own unit of time, is above 1e100.
    Returns the :class:`.flow.FlowResult` of all n motions; those that the map does not contain have
    a status below 0, and their other entries are undefined.  Returns None, with nothing looked up,
    where all motions are at rest and ``speed`` is None, or where the stated error of the map
    exceeds rtol, as the infinite one of a scene without a map does.
    """
    scene = batch.problem.scene
    rows = batch.rows
    rtol, threshold, _ = batch.problem.limits
    unit = scene.in_own_time()[1]
    # many numbers: no copies where the unit of time is that of the scene
    V0, omega0 = (
        batch.inputs[name] if unit == 1.0 else batch.inputs[name] * unit
        for name in ("V0", "omega0")
    )
    if speed is None:
        speed = max(
            (abs(end) for array in (V0, omega0) if array.size for end in extent(array)), default=0.0
        )
    elif (speed := speed * unit) > SPEED_RANGE[1]:
        raise dimensionless_error(
            "speed", "speed = {}: must be at most {}", "V", speed / unit, SPEED_RANGE[1] / unit
        )
    if not speed > 0.0:
        return None
    chosen = flow_map(scene, speed, threads=batch.threads)
    speeds, path, losses = chosen.errors
    error = max(
        speeds,
        path if {"x", "angle"} & {*rows} else 0.0,
        losses if {*LOSSES} & {*rows} else 0.0,
    )
    problem = chosen.problem and f"no flow map, so motions are integrated: {chosen.problem}"
    about |= {"flow_error": error, "flow_problem": problem}
    if not error <= rtol:  # true of NaN too
        return None
    motions = Motions(
        gamma=scene.gamma * unit * unit,  # an acceleration times a time squared
        rest=threshold * unit,
        V0=V0,
        omega0=omega0,
        t=batch.times / unit,
        rows=tuple((STATES + LOSSES).index(name) for name in rows),
    )
    found = look_up_ensemble(chosen, motions, threads=batch.threads, progress=batch.progress)
    if unit == 1.0:
        return found
    for n, name in enumerate(rows):
        found.out[n] *= unit ** TIME_POWERS.get(name, 0)
    return found._replace(onset=found.onset * unit, rest=found.rest * unit)


def _integrate_others(found: FlowResult, batch: Batch) -> Integers:
    """Integrate the motions that have no result yet, those with status < 0, in blocks on the
    threads of the batch.

    found: :class:`.flow.FlowResult`, into which quantities, status, number of switches, onset and
    rest times of these motions are written, dimensionless, times in T_ref; entries of the other
    motions stay.
    batch: :class:`Batch`, all n motions.
    Returns the number of integration steps of each motion, (n,), int; 0 for those that had a
    result.
    """
    problem = batch.problem
    rows = np.array([ROWS.index(name) for name in batch.rows], np.int64)
    steps = np.zeros(batch.immobile.size, dtype=np.int64)

    def work(start: int, stop: int) -> None:
        """Integrate those motions of a block that have no result, and write their results into
        ``found`` and ``steps``.

        start, stop: index of the first motion of the block, and of the one after the last.
        """
        # a status below 0: not looked up
        left = start + np.flatnonzero(found.status[start:stop] < 0)
        if not left.size:
            return
        alpha, *others = (
            broadcast_vector(array[left], left.shape) if array.size > 1 else array
            for array in batch.inputs.values()
        )
        found.out[:, left], info = integrate(
            left.size,
            (*_law_of(problem, alpha, left), *others),
            problem.functions.for_kernel(left),
            batch.times,
            problem.limits,
            rows,
        )
        (
            found.status[left],
            steps[left],
            found.switches[left],
            found.onset[left],
            found.rest[left],
        ) = info.T

    block = _MAPPED_BLOCK if found.status.max(initial=-1) >= 0 else _BLOCK
    # with the added mass and a material each the law is that of one motion
    if problem.unsteady and np.ndim(problem.scene.alpha):
        block = 1
    run_blocks(
        work,
        steps.size,
        problem.functions.block(block),
        threads=batch.threads,
        progress=batch.progress,
    )
    return steps


def _law_of(problem: MotionProblem, alpha: NDArray, index: Integers) -> tuple[Any, bool]:
    """Return the law of some motions as the kernel takes it.

    problem: :class:`MotionProblem` of all motions, of one material or of several, of which the
    scene and ``unsteady`` are read.
    alpha: alphas of the motions, (k,); (1,) if all have the same.  Read only where each motion has
    its own alpha in place of a material.
    index: indices of the motions, (k,), from which their materials are taken; k = 1 with the added
    mass if the materials differ, since the law with N belongs to one material.
    Returns (record of the law or laws; whether half-space and cylinder may take unequal parts of M,
    which is True for any list of two bodies).
    """
    scene = problem.scene
    if (table := scene.rolling_law) is not None:
        return (table.unsteady_record if problem.unsteady else table.record), table.unlike
    several: Any = scene.material_array
    # one material for all motions is index 0
    index = index if several is None else np.minimum(index, len(several) - 1)
    if problem.unsteady:
        one: Any = alpha.item() if several is None else scene.material[index.item()]  # type: ignore[index]
        return law_table(one).unsteady_record, False
    if several is None:
        return record_of_alphas(alpha), False
    return record_of_materials(several, index), isinstance(several, Bodies)
