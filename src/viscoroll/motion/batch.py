"""Many motions at once: :func:`ensemble`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import Parameters, Rolls, scale_of
from ..core.array_types import Booleans, Floats, Integers, Numbers
from ..core.blocks import broadcast_vector, run_blocks, thread_count
from ..core.checks import broadcast_shape, check_bool, check_choice, check_number, extent
from ..core.drive import Feedback, Schedule, make_dimensionless
from ..core.errors import MotionStatus, ParameterError, check_names
from ..core.scale import TIME_POWERS
from ..materials.bodies import Bodies
from ..materials.law.per_element import record_of_alphas, record_of_materials
from ..materials.law.table import law_table
from .checks import SPEED_RANGE, in_words, output_times
from .driven import ACTING, LOSSES, ROWS, STATES, Drive, bare
from .flow import FlowMap, FlowResult, flow_map, look_up_ensemble
from .many import Ensemble
from .rolling import Asked, Begun, begin, integrate
from .warned import look

#: a function of time of each motion
Course = Numbers | Schedule | Callable[[float], float]
FIELDS = ROWS
#: motions a block: where all are integrated, and where most come from a map
_BLOCK, _MAPPED_BLOCK = 256, 1 << 14
#: motions from which on method "auto" takes the flow map: building one takes as long as integrating three to five
#: thousand (docs/benchmark.md, "One scene")
FLOW_PAYS = 4096


def ensemble(
    roller: Rolls,
    V0: Numbers | None,
    omega0: Numbers | None,
    t: Numbers,
    *,
    force: Course | Feedback | None = None,
    torque: Course | Feedback | None = None,
    slope: Numbers | None = None,
    brake: Course | None = None,
    drag: Numbers | None = None,
    omega: Course | None = None,
    V: Course | None = None,
    method: Literal["auto", "flow", "integrate"] = "auto",
    rtol: float = 1e-8,
    rest: float | None = None,
    unsteady: bool = False,
    rested: bool | float = False,
    fields: Iterable[str] = ("V", "omega", "x"),
    max_steps: int = 100_000,
    resolve: float | None = None,
    speed: float | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> Ensemble:
    """Roll n motions; the result is the same bits for any number of threads.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` in SI units; its numbers may be arrays of n too: every motion can
        have a scene of its own.
    V0, omega0 : start speeds, scalars or arrays (n,); labels of xarray and pandas come back in ``to_xarray``.
    t : output times, ascending, common to all; one number: the final state only.
    force, torque, slope, brake, drag, omega, V : what drives the motions, as for :func:`roll`; numbers may be arrays
        of n, times and values of a :class:`Schedule` of shape (n, k).
    method : "integrate": each motion as :func:`roll` would, bit for bit at one alpha, to the
        error of ``rtol`` at an alpha each.  "flow": look the
        motions up in the flow map of their one scene, which is built if it is not on disk
        yet.  "auto": "flow" for 4096 motions or more of one scene.  The map stands in only
        where its stated error is at most ``rtol``, and only for the motions that it holds;
        all others are integrated.  The result says which, and the map's error.  Driven motions, and
        those of bodies that differ, are integrated: "flow" is refused.
    rtol, rest, unsteady, rested, max_steps, resolve : as for :func:`roll`; ``V0`` and ``omega0`` of the result are
        what a rest left of them.  With a material each an unsteady motion takes some milliseconds more, for its N.
    fields : out of ``V omega x angle delta regime slip_loss rolling_loss``, and ``force torque work_force
        work_torque brake_loss``; only these are kept in memory.  Works and losses are good to
        some rtol of the energy that moves.
    speed : highest speed that the flow map is made for; default the largest of the starts.
        Where a large ensemble is rolled in several calls, one number for all makes the
        bits independent of how it is cut.
    threads : threads to use; default ``$VISCOROLL_THREADS`` or the cores available.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Ensemble

    Raises
    ------
    ParameterError
        NaN or infinite input, unsorted times, shapes that do not broadcast to (n,),
        unknown fields or method; method "flow" with parameters that differ between motions.

    Notes
    -----
    The flow map has no entry for scenes in which full slip returns or rolling resistance can
    hold the sliding cylinder (mu below about M/2), for alpha = 1, and for motions that stick
    at speeds 10^6 times below the highest (``tests/motion/test_flow.py``).

    Nothing is raised where a motion cannot be rolled to the end: its ``status`` says so, its outputs from
    there on are NaN, and :meth:`Ensemble.messages` counts such motions.

    Beside float64 input and its result a call takes a few megabytes, whatever the number of
    motions (``tests/test_invariance.py``).
    """
    units = scale_of(roller)
    times, names = output_times(t, units), check_names("fields", fields, FIELDS, "a field")
    check_choice("method", method, "auto", "flow", "integrate")
    starts, given, labels = bare((V0, omega0), Drive(force, torque, slope, brake, drag, omega, V), units)
    progress = check_bool("progress", progress)
    if speed is not None:
        speed = check_number("speed", speed, unit=units, low=0.0, strict=True)
    asked = Asked(rtol, rest, max_steps, resolve)
    begun = begin(roller, starts, given, times[-1], asked, unsteady=unsteady, rested=rested)
    begun.roller.look_at_starts(*starts)
    inputs, count = _inputs(begun, given.numbers)
    look(begun)
    scale = begun.roller.scale
    many = _Many(
        begun, inputs, np.broadcast_to(begun.caught, (count,)), times / scale["t"],
        names if begun.drive.acts else tuple(name for name in names if name not in ACTING),
        thread_count(threads), "motions" if progress else None,
    )  # fmt: skip
    try:
        answer, found = _answer(many, method, make_dimensionless("speed", speed, scale))
    except ParameterError as error:
        raise in_words(error, scale) from error
    rows: dict[str, Any] = {name: np.zeros((count, times.size)) for name in names}
    rows |= dict(zip(many.rows, answer.out, strict=True))
    notes: dict[str, Any] = {
        "onset_time": answer.onset,
        "rest_time": answer.rest,
        "V0": inputs["V0"],
        "omega0": inputs["omega0"],
    }
    if scale.si:
        for name, row in rows.items():
            np.multiply(row, np.reshape(scale[name], (-1, 1)), out=row)
        notes = {name: each * scale[name] for name, each in notes.items()}
    notes = {name: np.broadcast_to(each, (count,)) for name, each in notes.items()}
    notes |= {"status": answer.status, "switches": answer.switches, "drive_error": begun.ready.error} | found
    kept: dict[str, Any] = dict.fromkeys(FIELDS) | rows | notes
    result = Ensemble(roller=begun.roller, t=times, drive=begun.drive, labels=labels, **kept)
    begun.roller.look_at_motion(starts[0], result.V)
    return result


class _Many(NamedTuple):
    """Motions to be rolled.

    inputs : parameters and start speeds, one for all or one a motion.  caught : those that a rest keeps.
    times : without dimension.  rows : what is computed; without a drive nothing acts.
    """

    begun: Begun
    inputs: dict[str, NDArray]
    caught: Booleans
    times: Floats
    rows: tuple[str, ...]
    threads: int | None
    bar: str | None


def _answer(many: _Many, method: str, speed: float | None) -> tuple[FlowResult, dict[str, Any]]:
    """The motions, and by what they were found."""
    begun, rows, times, count = many.begun, many.rows, many.times, many.caught.size
    scene, (rtol, threshold, _) = begun.scene, begun.limits
    alike = not (begun.drive.acts or begun.unsteady) and scene.like_bodies
    if method == "flow" and (scene.shape or not alike):
        what = "motions have scenes of their own" if alike else "motions are driven or unsteady, or bodies differ"
        raise ParameterError("method", "'flow'", f"'auto' or 'integrate' where {what}")
    answer, chosen, error = None, None, np.nan
    if alike and not scene.shape and (method == "flow" or (method == "auto" and count >= FLOW_PAYS)):
        unit = scene.in_own_time()[1]
        V0, omega0 = (many.inputs[name] if unit == 1.0 else many.inputs[name] * unit for name in ("V0", "omega0"))
        chosen = _map_of(scene, V0, omega0, speed and speed * unit, many.threads)
        if chosen is not None:
            error = chosen.stated_error(path=_among(rows, "x", "angle"), loss=_among(rows, *LOSSES))
        if chosen is not None and error <= rtol:
            of = tuple((STATES + LOSSES).index(name) for name in rows)
            given = scene.gamma * unit * unit, threshold * unit, V0, omega0, times / unit
            answer = look_up_ensemble(chosen, *given, of, threads=many.threads, progress=many.bar)
            if unit != 1.0:
                for n, name in enumerate(rows):
                    answer.out[n] *= unit ** TIME_POWERS.get(name, 0)
                answer = answer._replace(onset=answer.onset * unit, rest=answer.rest * unit)
    if answer is None:
        answer = FlowResult.empty(len(rows), count, times.size)
    flow = answer.status >= 0
    if (caught := many.caught).any():  # motions that never leave the imprint of their rest
        answer.out[:, caught] = answer.onset[caught] = answer.rest[caught] = np.nan
        answer.status[caught] = MotionStatus.CAUGHT
    steps = _integrate_others(answer, many)
    problem = "" if chosen is None else chosen.problem
    return answer, {"steps": steps, "flow": flow, "flow_error": error, "flow_problem": problem}


def _inputs(begun: Begun, drives: dict[str, NDArray]) -> tuple[dict[str, NDArray], int]:
    """(Parameters and start speeds, how many motions they and the ``drives`` make)."""
    ready = begun.ready
    arrays = {name: np.asarray(value) for name, value in begun.scene.numbers.items()}
    arrays |= {"V0": np.asarray(ready.V0), "omega0": np.asarray(ready.omega0)}
    own = 1 if ready.courses is None else ready.courses.motions
    counts = {"pieces": own, "gains": ready.gains.shape[1]}
    shape = broadcast_shape(**arrays, **drives, **{name: np.zeros(n) for name, n in counts.items() if n > 1})
    if len(shape) > 1:
        raise ParameterError("V0, omega0", f"arrays of shape {shape}", "scalars or vectors (n,)")
    count = shape[0] if shape else 1
    return {name: broadcast_vector(array, (count,)) for name, array in arrays.items()}, count


def _map_of(
    scene: Parameters, V0: NDArray, omega0: NDArray, speed: float | None, threads: int | None
) -> FlowMap | None:
    """The flow map for these starts; None where all are at rest."""
    if speed is None:
        speed = max((abs(end) for array in (V0, omega0) if array.size for end in extent(array)), default=0.0)
    elif speed > SPEED_RANGE[1]:
        raise ParameterError("speed", speed, f"in (0, {SPEED_RANGE[1]:g}]")
    return flow_map(scene, speed, threads=threads) if speed > 0.0 else None


def _integrate_others(answer: FlowResult, many: _Many) -> Integers:
    """Integrate the motions without an answer; returns the steps of each."""
    begun, inputs = many.begun, many.inputs.values()
    law, rows = _law_of(begun.scene, begun.unsteady), np.array([ROWS.index(name) for name in many.rows], np.int64)
    steps = np.zeros(answer.status.size, dtype=np.int64)

    def work(start: int, stop: int) -> None:
        left = start + np.flatnonzero(answer.status[start:stop] < 0)
        if not left.size:
            return
        alpha, *own = (broadcast_vector(array[left], left.shape) if array.size > 1 else array for array in inputs)
        batch, drive = (*law(alpha, left), *own), begun.ready.for_kernel(left)
        answer.out[:, left], info = integrate(left.size, batch, drive, many.times, begun.limits, rows)
        answer.status[left], steps[left], answer.switches[left], answer.onset[left], answer.rest[left] = info.T

    mapped = answer.status.max(initial=-1) >= 0
    block = _MAPPED_BLOCK if mapped else 1 if begun.unsteady and np.ndim(begun.scene.alpha) else _BLOCK
    run_blocks(work, steps.size, begun.ready.block(block), threads=many.threads, progress=many.bar)
    return steps


def _law_of(scene: Parameters, unsteady: bool) -> Callable[[NDArray, Integers], tuple[Any, bool]]:
    """(alphas of motions, which they are) -> the law that they share, or that of each in turn; whether bodies
    differ.  ``unsteady``: of one motion, with N."""
    each: Any = scene.each
    if each is None and not np.ndim(scene.alpha):
        one: Any = scene.table
        law = (one.unsteady_record if unsteady else one.record), one.unlike
        return lambda alpha, which: law

    def made(alpha: NDArray, which: Integers) -> tuple[Any, bool]:
        if each is None:
            return law_table(alpha.item()).unsteady_record if unsteady else record_of_alphas(alpha), False
        which = np.minimum(which, len(each) - 1)
        if unsteady:
            given: Any = scene.material
            return law_table(given[which.item()]).unsteady_record, False
        return record_of_materials(each, which), isinstance(each, Bodies)

    return made


def _among(names: tuple[str, ...], *some: str) -> bool:
    return not set(names).isdisjoint(some)
