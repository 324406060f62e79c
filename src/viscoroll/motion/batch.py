"""Solution of many motions, by the flow map of their scene or by integration: :func:`solve_batch`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import Parameters
from ..core.array_types import Booleans, Floats, Integers
from ..core.blocks import broadcast_vector, run_blocks
from ..core.checks import extent
from ..core.errors import MotionStatus, ParameterError, dimensionless_error
from ..core.scale import TIME_POWERS
from ..kernels.flow.records import Motions
from ..materials.bodies import Bodies
from ..materials.law.per_element import record_of_alphas, record_of_materials
from ..materials.law.table import law_table
from .checks import SPEED_RANGE
from .drive import LOSSES, ROWS, STATES
from .flow import FlowResult, flow_map, look_up_ensemble
from .problem import MotionProblem, integrate

#: Motions in a block of work where all are integrated: some hundredths of a second.
_BLOCK = 256
#: Motions in a block of work where most come from a flow map.
_MAPPED_BLOCK = 1 << 14
#: Motions from which on method "auto" uses the flow map: building one takes as long as integrating three to five
#: thousand (docs/benchmark.md, "One scene").
FLOW_PAYS = 4096


class Batch(NamedTuple):
    """Motions to be solved; dimensionless.

    problem : the checked motions.
    inputs : name -> vector of one or n values, in the order alpha, kappa, mu, gamma, j, V0, omega0.
    immobile : whether a motion is too slow to leave the indentation of a standstill, (n,).
    times : output times, (times,), ascending, in T_ref.
    rows : names, out of :data:`.drive.ROWS`, of the quantities to compute.
    threads : number of threads.
    progress : title of a progress bar, None for none.
    """

    problem: MotionProblem
    inputs: dict[str, NDArray]
    immobile: Booleans
    times: Floats
    rows: tuple[str, ...]
    threads: int | None
    progress: str | None


class Solution(NamedTuple):
    """Solved motions, dimensionless, and their source.

    motions : quantities (rows, n, times), status, onset and rest times, number of switches.
    about : "steps" and "flow" (whether from the flow map), (n,); "flow_error", the stated error of the map, NaN without
    one; "flow_problem", why a map that was tried could not be used, or "".
    """

    motions: FlowResult
    about: dict[str, Any]


def solve_batch(batch: Batch, method: str, speed: float | None) -> Solution:
    """Solve motions: look up those that the flow map of their scene contains, and integrate all others.

    A flow map is a table of all motions of one scene (:mod:`.flow`).

    batch: the motions.
    method: "auto" (a map from :data:`FLOW_PAYS` motions on), "flow" or "integrate", as of :func:`viscoroll.ensemble`.
    speed: highest speed of the flow map, dimensionless; None: the largest of the starts.
    Raises ParameterError for method "flow" where no map applies: different scenes, driven or unsteady motions, bodies
    that differ; and for a ``speed`` above the largest start speed allowed.
    Returns the :class:`Solution`.
    """
    scene = batch.problem.scene
    free = not batch.problem.driven and scene.like_bodies
    if method == "flow" and (scene.shape or not free):
        which = "motions have different scenes" if free else "motions are driven or unsteady, or bodies differ"
        raise ParameterError("method", "'flow'", f"'auto' or 'integrate' where {which}")
    found = None
    about: dict[str, Any] = {"flow_error": np.nan, "flow_problem": ""}
    mapped = method == "flow" or (method == "auto" and batch.immobile.size >= FLOW_PAYS)
    if free and not scene.shape and mapped:
        found = _solve_by_flow_map(batch, speed, about)
    if found is None:
        found = FlowResult.empty(len(batch.rows), batch.immobile.size, batch.times.size)
    about["flow"] = found.status >= 0
    if (immobile := batch.immobile).any():
        found.out[:, immobile] = found.onset[immobile] = found.rest[immobile] = np.nan
        found.status[immobile] = MotionStatus.CAUGHT
    about["steps"] = _integrate_others(found, batch)
    return Solution(found, about)


def _solve_by_flow_map(batch: Batch, speed: float | None, about: dict[str, Any]) -> FlowResult | None:
    """Look motions up in the flow map of their scene, which is built if there is none yet.

    The map counts time in the material's own unit, to which the motions are converted and from which their results are.

    batch: motions of one scene.
    speed: highest speed of the flow map, dimensionless; None: the largest of the starts.
    about: dict that receives "flow_error" and "flow_problem" of the map.
    Raises ParameterError for a ``speed`` above the largest start speed allowed.
    Returns the result, in which motions outside the map have a status below 0; None, with nothing looked up, where all
    motions are at rest, or the stated error exceeds rtol.
    """
    scene, rows = batch.problem.scene, batch.rows
    rtol, threshold, _ = batch.problem.limits
    unit = scene.in_own_time()[1]
    V0, omega0 = (batch.inputs[name] if unit == 1.0 else batch.inputs[name] * unit for name in ("V0", "omega0"))
    if speed is None:
        speed = max((abs(end) for array in (V0, omega0) if array.size for end in extent(array)), default=0.0)
    elif (speed := speed * unit) > SPEED_RANGE[1]:
        raise dimensionless_error("speed", speed, f"in (0, {SPEED_RANGE[1]:g}]")
    if not speed > 0.0:
        return None
    chosen = flow_map(scene, speed, threads=batch.threads)
    error = chosen.stated_error(path=not {"x", "angle"}.isdisjoint(rows), loss=not set(LOSSES).isdisjoint(rows))
    about |= {"flow_error": error, "flow_problem": chosen.problem}
    if not error <= rtol:
        return None
    wanted = tuple((STATES + LOSSES).index(name) for name in rows)
    motions = Motions(scene.gamma * unit * unit, threshold * unit, V0, omega0, batch.times / unit, wanted)
    found = look_up_ensemble(chosen, motions, threads=batch.threads, progress=batch.progress)
    if unit == 1.0:
        return found
    for n, name in enumerate(rows):
        found.out[n] *= unit ** TIME_POWERS.get(name, 0)
    return found._replace(onset=found.onset * unit, rest=found.rest * unit)


def _integrate_others(found: FlowResult, batch: Batch) -> Integers:
    """Integrate the motions that have no result yet, status < 0.

    found: results, into which theirs are written: quantities, status, switches, onset and rest times.
    batch: all motions.
    Returns the number of integration steps of each motion, (n,); 0 for those that had a result.
    """
    problem = batch.problem
    law, rows = _law_of(problem.scene, problem.unsteady), np.array([ROWS.index(name) for name in batch.rows], np.int64)
    steps = np.zeros(batch.immobile.size, dtype=np.int64)

    def work(start: int, stop: int) -> None:
        """Integrate those motions of a block that have no result, and write their results.

        start, stop: index of the first motion of the block, and of the one behind the last.
        """
        left = start + np.flatnonzero(found.status[start:stop] < 0)
        if not left.size:
            return
        inputs = batch.inputs.values()
        alpha, *others = (broadcast_vector(array[left], left.shape) if array.size > 1 else array for array in inputs)
        arguments = (*law(alpha, left), *others), problem.kernel_drive(left), batch.times, problem.limits, rows
        found.out[:, left], info = integrate(left.size, *arguments)
        found.status[left], steps[left], found.switches[left], found.onset[left], found.rest[left] = info.T

    mapped = found.status.max(initial=-1) >= 0
    block = _MAPPED_BLOCK if mapped else 1 if problem.unsteady and np.ndim(problem.scene.alpha) else _BLOCK
    if problem.functions is not None:
        block = problem.functions.block(block)
    run_blocks(work, steps.size, block, threads=batch.threads, progress=batch.progress)
    return steps


def _law_of(scene: Parameters, unsteady: bool) -> Callable[[NDArray, Integers], tuple[Any, bool]]:
    """Return the function that gives the kernel's law of some motions.

    scene: parameters of the motions, of one material or of several.
    unsteady: whether the added mass acts; then several materials are requested for one motion at a time.
    Returns a function (alphas of the motions, (k,); their indices, (k,)) -> (record of the law or laws as the kernels
    take it; whether the two bodies take unequal parts of M).
    """
    several: Any = scene.material_array
    if several is None and not np.ndim(scene.alpha):
        table: Any = scene.table
        law = (table.unsteady_record if unsteady else table.record), table.unlike
        return lambda alpha, index: law

    def make(alpha: NDArray, index: Integers) -> tuple[Any, bool]:
        """Return the law of some motions as the kernel takes it.

        alpha: alphas of the motions, (k,).
        index: indices of the motions, (k,).
        Returns (record of the law or laws, whether the bodies differ).
        """
        if several is not None:
            index = np.minimum(index, len(several) - 1)
        if unsteady:
            material: Any = alpha if several is None else scene.material[index.item()]  # type: ignore[index]
            return law_table(material.item() if several is None else material).unsteady_record, False
        if several is None:
            return record_of_alphas(alpha), False
        return record_of_materials(several, index), isinstance(several, Bodies)

    return make
