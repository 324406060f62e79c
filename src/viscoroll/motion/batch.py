"""Many motions at once: :func:`ensemble`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import PARAMETERS, Parameters, Rolls, framed
from ..core.blocks import flattened, run_blocks, thread_count
from ..core.checks import broadcast_shape, extent, number
from ..core.drive import Feedback, Schedule, over
from ..core.errors import MotionStatus, ParameterError, unknown
from ..core.scale import OF_TIME
from ..core.typed import Numbers
from ..materials.bodies import Bodies
from ..materials.law_each import law_of_alphas, law_of_materials
from ..materials.law_table import law_table
from .checks import SPEED_RANGE, controls, in_words, output_times, start_speeds
from .driven import ACTING, LOSSES, ROWS, STATES, Drive, Prepared, bare, prepared, refuse_rest
from .flow import Answer, FlowMap, ask, flow_map
from .many import Ensemble
from .unsteady import climbed, refuse_unlike, time_of_rest
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
    rtol, rest, unsteady, rested, max_steps : as for :func:`roll`; ``V0`` and ``omega0`` of the result are what a rest
        left of them.  With a material each an unsteady motion takes some milliseconds more, for its N.
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
    times, names = output_times(t), _names(fields)
    if method not in ("auto", "flow", "integrate"):
        raise ParameterError("method", repr(method), "'auto', 'flow' or 'integrate'")
    starts, given, labels = bare((V0, omega0), Drive(force, torque, slope, brake, drag, omega, V))
    begun = begin(roller, starts, given, times[-1], (rtol, rest, max_steps), unsteady=unsteady, rested=rested)
    roller, inputs, count = begun.roller, begun.inputs, begun.caught.size
    scene, scale, ready, drive = roller.scene(), roller.scale, begun.ready, given.acting
    roller.look_at_starts(*starts)
    many = _Many(
        scene, inputs, begun.caught, ready, drive.acts, unsteady, times / scale["t"], begun.limits, names,
        thread_count(threads), "motions" if progress else None,
    )  # fmt: skip
    try:
        answer, found = _answer(many, method, over("speed", speed, scale))
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
    notes |= {"status": answer.status, "switches": answer.switches, "drive_error": ready.error} | found
    kept: dict[str, Any] = dict.fromkeys(FIELDS) | rows | notes
    result = Ensemble(roller=roller, t=times, drive=drive, labels=labels, **kept)
    roller.look(result.V)
    return result


class Begun(NamedTuple):
    """Motions that may be rolled, without dimension but for what rolls, on its slope.

    inputs : parameters and start speeds, one for all or one a motion.  caught : those that a rest keeps.
    limits : rtol, the threshold of rest and max_steps.
    """

    roller: Rolls
    inputs: dict[str, NDArray]
    ready: Prepared
    caught: NDArray[np.bool_]
    limits: tuple[float, float, int]


def begin(
    roller: Rolls, starts: tuple[Any, Any], given: Drive, end: float, asked: tuple[float, float | None, int],
    *, unsteady: bool, rested: bool | float,
) -> Begun:  # fmt: skip
    """All that is refused of motions up to a time before any is rolled; ``asked``: rtol, rest and max_steps.

    Raises ParameterError.
    """
    drive, (rtol, rest, max_steps) = given.acting, asked
    roller, scene, scale = framed(roller, "ensemble", moves=True, slope=drive.slope)
    if rest is not None and np.ndim(scale["V"]):
        raise ParameterError("rest", rest, "None", "rest needs the same R and T_ref for all motions")
    try:
        limits = controls(rtol, over("rest", rest, scale), max_steps)
        own = over("V0", starts[0], scale), over("omega0", starts[1], scale)
        ready = prepared(drive.over(scale), *own, float(end / scale["t"]), rtol)
        refuse_rest(limits[1], ready)
        if unsteady:
            refuse_unlike(scene)
        ready, caught = climbed(ready, scene, time_of_rest(rested) / scale["t"])
        inputs, count = _inputs(scene, given.numbers, ready)
    except ParameterError as error:
        raise in_words(error, scale) from error
    return Begun(roller, inputs, ready, np.broadcast_to(caught, (count,)), limits)


class _Many(NamedTuple):
    """Motions to be rolled, without dimension.

    inputs : parameters and start speeds, one for all or one a motion.  caught : those that a rest keeps.
    """

    scene: Parameters
    inputs: dict[str, NDArray]
    caught: NDArray[np.bool_]
    ready: Prepared
    driven: bool
    unsteady: bool
    times: NDArray[np.float64]
    limits: tuple[float, float, int]
    names: tuple[str, ...]
    threads: int | None
    bar: str | None

    @property
    def rows(self) -> tuple[str, ...]:
        """What is computed: without a drive nothing acts."""
        return self.names if self.driven else tuple(name for name in self.names if name not in ACTING)


def _answer(many: _Many, method: str, speed: float | None) -> tuple[Answer, dict[str, Any]]:
    """The motions, and by what they were found."""
    scene, rows, (rtol, threshold, _), times = many.scene, many.rows, many.limits, many.times
    mapped = not (many.driven or scene.shape or many.unsteady) and scene.like_bodies
    if method == "flow" and not mapped:
        alike = many.driven or many.unsteady or not scene.like_bodies
        what = "motions are driven or unsteady, or bodies differ" if alike else "motions have scenes of their own"
        raise ParameterError("method", "'flow'", f"'auto' or 'integrate' where {what}")
    look(scene, many.inputs["V0"], many.inputs["omega0"], driven=many.driven or many.unsteady)
    flat, count = [*many.inputs.values()], many.caught.size
    answer, chosen, error = None, None, np.nan
    unit = scene.in_own_time()[1] if mapped else 1.0
    own = flat if unit == 1.0 else [*flat[:5], flat[5] * unit, flat[6] * unit]  # no copy of 10^8 for nothing
    if mapped and (method == "flow" or (method == "auto" and count >= FLOW_PAYS)):
        chosen = _map_of(scene, own[5], own[6], speed and speed * unit, many.threads)
    if chosen is not None:
        error = chosen.stated_error(path=_among(rows, "x", "angle"), loss=_among(rows, *LOSSES))
        if error <= rtol:
            of = tuple((STATES + LOSSES).index(name) for name in rows)
            given = float(flat[3][0]) * unit * unit, threshold * unit, own[5], own[6], times / unit
            answer = ask(chosen, *given, of, threads=many.threads, progress=many.bar)
            if unit != 1.0:
                for n, name in enumerate(rows):
                    answer.out[n] *= unit ** OF_TIME.get(name, 0)
                answer = answer._replace(onset=answer.onset * unit, rest=answer.rest * unit)
    if answer is None:
        answer = Answer.empty(len(rows), count, times.size)
    flow = answer.status >= 0
    if many.caught.any():
        _keep_caught(answer, many.caught)
    steps = _integrate_others(answer, many)
    problem = "" if chosen is None else chosen.problem
    return answer, {"steps": steps, "flow": flow, "flow_error": error, "flow_problem": problem}


def _keep_caught(answer: Answer, caught: NDArray[np.bool_]) -> None:
    """Motions that never leave the imprint of their rest."""
    answer.out[:, caught] = answer.onset[caught] = answer.rest[caught] = np.nan
    answer.status[caught] = MotionStatus.CAUGHT


def _names(fields: Iterable[str]) -> tuple[str, ...]:
    names = (fields,) if isinstance(fields, str) else tuple(fields)
    for name in names:
        if name not in FIELDS:
            raise unknown("fields", name, FIELDS, "a field")
    return names


def _inputs(scene: Parameters, drives: dict[str, NDArray], ready: Prepared) -> tuple[dict[str, NDArray], int]:
    """(Parameters and start speeds, how many motions they and the ``drives`` make)."""
    arrays: dict[str, NDArray] = {name: np.asarray(getattr(scene, name)) for name in PARAMETERS}
    arrays |= zip(("V0", "omega0"), map(np.asarray, start_speeds(ready.V0, ready.omega0)), strict=True)
    counts = {"pieces": ready.pieces.shape[0], "gains": ready.gains.shape[1]}
    shape = broadcast_shape(**arrays, **drives, **{name: np.zeros(n) for name, n in counts.items() if n > 1})
    if len(shape) > 1:
        raise ParameterError("V0, omega0", f"arrays of shape {shape}", "scalars or vectors (n,)")
    count = shape[0] if shape else 1
    return {name: flattened(array, (count,)) for name, array in arrays.items()}, count


def _map_of(
    scene: Parameters, V0: NDArray, omega0: NDArray, speed: float | None, threads: int | None
) -> FlowMap | None:
    """The flow map for these starts; None where all are at rest."""
    if speed is None:
        speed = max((abs(end) for array in (V0, omega0) if array.size for end in extent(array)), default=0.0)
    elif not 0.0 < number("speed", speed) <= SPEED_RANGE[1]:
        raise ParameterError("speed", speed, f"in (0, {SPEED_RANGE[1]:g}]")
    return flow_map(scene, speed, threads=threads) if speed > 0.0 else None


def _integrate_others(answer: Answer, many: _Many) -> NDArray[np.int64]:
    """Integrate the motions without an answer; returns the steps of each."""
    law, names, times = _law_of(many.scene, many.unsteady), many.rows, many.times
    steps, rows = np.zeros(answer.status.size, dtype=np.int64), np.array([ROWS.index(name) for name in names], np.int64)

    def work(start: int, stop: int) -> None:
        from ..kernels.motion.loop import INFO, motion_loop

        left = start + np.flatnonzero(answer.status[start:stop] < 0)
        if not left.size:
            return
        parts = many.inputs.values()
        alpha, *inputs = (flattened(array[left], left.shape) if array.size > 1 else array for array in parts)
        out, info = np.empty((len(names), left.size, times.size)), np.empty((left.size, len(INFO)))
        batch, notes = (*law(alpha, left), *inputs), (np.empty((0, 2)), np.empty(0))
        motion_loop(batch, many.ready.for_kernel(left), times, many.limits, rows, out, info, notes)
        answer.out[:, left] = out
        answer.status[left], steps[left], answer.switches[left], answer.onset[left], answer.rest[left] = info.T

    mapped = answer.status.max(initial=-1) >= 0
    block = _MAPPED_BLOCK if mapped else 1 if many.unsteady and _many_materials(many.scene) else _BLOCK
    run_blocks(work, steps.size, block, threads=many.threads, progress=many.bar)
    return steps


def _many_materials(scene: Parameters) -> bool:
    return np.ndim(scene.alpha) > 0


def _law_of(scene: Parameters, unsteady: bool) -> Callable[[NDArray, NDArray[np.int64]], tuple[Any, bool]]:
    """(alphas of motions, which they are) -> the law that they share, or that of each in turn; whether bodies
    differ.  ``unsteady``: of one motion, with N."""
    material: Any = scene.each

    def each(alpha: NDArray, which: NDArray[np.int64]) -> tuple[Any, bool]:
        found = law_of_materials(material, np.minimum(which, len(material) - 1))
        return found, isinstance(material, Bodies)

    def own(alpha: NDArray, which: NDArray[np.int64]) -> tuple[Any, bool]:
        given: Any = scene.material
        one = law_table(alpha.item() if given is None else given[min(which.item(), len(given) - 1)])
        return one.unsteady_record, False

    if unsteady and _many_materials(scene):
        return own
    if material is not None:
        return each
    if scene.material is None and np.ndim(scene.alpha):
        return lambda alpha, which: (law_of_alphas(alpha), False)
    one: Any = scene.table
    return lambda alpha, which: (one.unsteady_record if unsteady else one.record, one.unlike)


def _among(names: tuple[str, ...], *some: str) -> bool:
    return not set(names).isdisjoint(some)
