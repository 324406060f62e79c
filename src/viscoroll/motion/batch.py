"""Many motions at once: :func:`ensemble`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..blocks import flattened, run_blocks
from ..checks import broadcast_shape, extent, number
from ..drive import Feedback
from ..errors import ParameterError, unknown
from ..materials.prony_array import MaterialArray
from ..materials.tables import record
from ..scene import PARAMETERS, Scene, checked_scene
from ..typed import Driving, Numbers
from .checks import SPEED_RANGE, controls, output_times, start_speeds
from .driven import ACTING, LOSSES, ROWS, STATES, Drive, Prepared, bare, prepared, refuse_rest
from .each import roll_each, to_unit
from .flow import Answer, FlowMap, ask, flow_map
from .many import Ensemble
from .warned import look

FIELDS = STATES + LOSSES + ACTING
#: motions a block: where all are integrated, have a material each that is converted, and where most come from a map
_BLOCK, _BLOCK_EACH, _MAPPED_BLOCK = 64, 128, 1 << 14
#: motions from which on method "auto" takes the flow map: building one takes as long as integrating three to five
#: thousand (docs/benchmark.md, "One scene")
FLOW_PAYS = 4096


def ensemble(
    scene: Scene,
    V0: Numbers | None,
    omega0: Numbers | None,
    t: Numbers,
    *,
    force: Driving | Feedback = 0.0,
    torque: Driving | Feedback = 0.0,
    slope: Numbers | None = None,
    brake: Driving | None = None,
    omega: Driving | None = None,
    V: Driving | None = None,
    method: Literal["auto", "flow", "integrate"] = "auto",
    rtol: float = 1e-8,
    rest: float | None = None,
    fields: Iterable[str] = ("V", "omega", "x"),
    max_steps: int = 100_000,
    speed: float | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> Ensemble:
    """Roll n motions; the result is the same bits for any number of threads.

    Parameters
    ----------
    scene : its fields may be arrays of n too: every motion can have a scene of its own.
    V0, omega0 : start speeds, scalars or arrays (n,); labels of xarray and pandas come back in ``to_xarray``.
    t : output times, ascending, common to all; one number: the final state only.
    force, torque, slope, brake, omega, V : what drives the motions, as for :func:`roll`; numbers may be arrays of n,
        times and values of (times, values) of shape (n, k).
    method : "integrate": each motion as :func:`roll` would, bit for bit at one alpha, to the
        error of ``rtol`` at an alpha each.  "flow": look the
        motions up in the flow map of their one scene, which is built if it is not on disk
        yet.  "auto": "flow" for 4096 motions or more of one scene.  The map stands in only
        where its stated error is at most ``rtol``, and only for the motions that it holds;
        all others are integrated.  The result says which, and the map's error.  Driven motions, and
        those of bodies that differ, are integrated: "flow" is refused.
    rtol, rest, max_steps : as for :func:`roll`.
    fields : out of ``V omega x angle delta regime slip_loss rolling_loss``, and ``force torque work_force
        work_torque brake_loss``; only these are kept in memory.  Without a drive a loss takes an
        integrated motion a second pass, to some rtol of the energy.
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
    motions (``tests/test_hostile.py``).
    """
    checked_scene(scene, "ensemble", moves=True)
    times, names = output_times(t), _names(fields)
    if method not in ("auto", "flow", "integrate"):
        raise ParameterError("method", repr(method), "'auto', 'flow' or 'integrate'")
    rtol, threshold, max_steps = controls(rtol, rest, max_steps)
    (V0, omega0), drive, labels = bare((V0, omega0), Drive(force, torque, slope, brake, omega, V))
    ready = None
    if drive.acts or not scene.like_bodies:
        ready = prepared(drive, scene, V0, omega0, float(times[-1]), rtol)
        refuse_rest(threshold, ready)
        scene, V0, omega0 = ready.scene, ready.V0, ready.omega0
    if method == "flow" and (scene.shape or ready):
        what = "motions are driven, or bodies differ" if ready else "motions have scenes of their own"
        raise ParameterError("method", "'flow'", f"'auto' or 'integrate' where {what}")
    arrays, count = _inputs(scene, (V0, omega0), drive, ready)
    look(scene, arrays["V0"], arrays["omega0"], driven=drive.acts)
    material, unit = scene.in_own_time()
    own_time = {} if unit == 1.0 else {"gamma": unit * unit, "V0": unit, "omega0": unit}
    scaled = (array * own_time[name] if name in own_time else array for name, array in arrays.items())
    flat = [flattened(array, (count,)) for array in scaled]
    # without a drive nothing acts
    found = names if ready else tuple(name for name in names if name not in ACTING)
    rows = tuple((ROWS if ready else FIELDS).index(name) for name in found)
    bar = "motions" if progress else None
    answer, chosen, error = None, None, np.nan
    if not ready and (method == "flow" or (method == "auto" and not scene.shape and count >= FLOW_PAYS)):
        chosen = _map_of(scene, flat[5], flat[6], speed and speed * unit, threads)
    if chosen is not None:
        error = chosen.stated_error(path=_among(names, "x", "angle"), loss=_among(names, *LOSSES))
        if error <= rtol:
            given = float(flat[3][0]), threshold * unit, flat[5], flat[6], times / unit
            answer = ask(chosen, *given, rows, threads=threads, progress=bar)
    if answer is None:
        answer = Answer.empty(len(rows), count, times.size)
    flow = answer.status >= 0
    shared = None if scene.material is None and np.ndim(scene.alpha) else scene.kernel_material if ready else material
    limits = rtol, threshold * unit, max_steps
    steps = _integrate_others(answer, flat, (shared, unit, ready), times / unit, limits, found, threads, bar)
    if unit != 1.0:
        to_unit(answer.out, found, unit)
        answer = answer._replace(onset=answer.onset * unit, rest=answer.rest * unit)
    kept: dict[str, Any] = dict.fromkeys(FIELDS) | {name: np.zeros((count, times.size)) for name in names}
    kept |= dict(zip(found, answer.out, strict=True))
    return Ensemble(
        scene, np.broadcast_to(arrays["V0"], (count,)), np.broadcast_to(arrays["omega0"], (count,)), times, **kept,
        onset_time=answer.onset, rest_time=answer.rest, status=answer.status, switches=answer.switches,
        steps=steps, flow=flow, flow_error=error, flow_problem="" if chosen is None else chosen.problem,
        drive_error=ready.error if ready else 0.0, drive=drive, labels=labels,
    )  # fmt: skip


def _names(fields: Iterable[str]) -> tuple[str, ...]:
    names = (fields,) if isinstance(fields, str) else tuple(fields)
    for name in names:
        if name not in FIELDS:
            raise unknown("fields", name, FIELDS, "a field")
    return names


def _inputs(scene: Scene, starts: Any, drive: Drive, ready: Prepared | None) -> tuple[dict[str, NDArray], int]:
    """(Parameters and start speeds, how many motions they make)."""
    arrays: dict[str, NDArray] = {name: np.asarray(getattr(scene, name)) for name in PARAMETERS}
    arrays |= dict(zip(("V0", "omega0"), start_speeds(*starts), strict=True))
    counts = {"drive": ready.pieces.shape[0], "gains": ready.gains.shape[1]} if ready else {}
    drives = drive.numbers | {name: np.zeros(count) for name, count in counts.items() if count > 1}
    shape = broadcast_shape(**arrays, **{name: each for name, each in drives.items() if name not in arrays})
    if len(shape) > 1:
        raise ParameterError("V0, omega0", f"arrays of shape {shape}", "scalars or vectors (n,)")
    return arrays, shape[0] if shape else 1


def _map_of(scene: Scene, V0: NDArray, omega0: NDArray, speed: float | None, threads: int | None) -> FlowMap | None:
    """The flow map for these starts; None where all are at rest."""
    if speed is None:
        speed = max((abs(end) for array in (V0, omega0) if array.size for end in extent(array)), default=0.0)
    elif not 0.0 < number("speed", speed) <= SPEED_RANGE[1]:
        raise ParameterError("speed", speed, f"in (0, {SPEED_RANGE[1]:g}]")
    return flow_map(scene, speed, threads=threads) if speed > 0.0 else None


def _integrate_others(
    answer: Answer, flat: list[NDArray], by: tuple[Any, float, Prepared | None], times: NDArray,
    limits: tuple[float, float, int], names: tuple[str, ...], threads: int | None, bar: str | None,
) -> NDArray[np.int64]:  # fmt: skip
    """Integrate the motions without an answer; returns the steps of each.

    ``by`` : the material that they share, those that they have each, or None where each has an alpha of its own; what
    times are counted in; what drives them.
    """
    material, unit, ready = by
    steps = np.zeros(answer.status.size, dtype=np.int64)

    def work(start: int, stop: int) -> None:
        from ..kernels.material.functions import Own
        from ..kernels.motion.loop import INFO

        left = start + np.flatnonzero(answer.status[start:stop] < 0)
        if not left.size:
            return
        alpha, *inputs = (flattened(array[left], left.shape) if array.size > 1 else array for array in flat)
        kernel = _kernel(names, ready)
        if isinstance(material, MaterialArray):
            which = np.minimum(left, len(material) - 1)
            out, info = roll_each(
                material, which, inputs, times, limits, names,
                lambda given, limits, out, info, own: kernel(*given, limits, out, info, left[own[0]], own[1]),
            )  # fmt: skip
        else:
            one = Own(alpha) if material is None else record(material)
            out, info = np.empty((len(names), left.size, times.size)), np.empty((left.size, len(INFO)))
            kernel((one, *inputs), times, limits, out, info, left, unit)
        answer.out[:, left] = out
        answer.status[left], steps[left], answer.switches[left], answer.onset[left], answer.rest[left] = info.T

    mapped = answer.status.max(initial=-1) >= 0
    block = _MAPPED_BLOCK if mapped else _BLOCK_EACH if isinstance(material, MaterialArray) else _BLOCK
    run_blocks(work, steps.size, block, threads=threads, progress=bar)
    return steps


def _among(names: tuple[str, ...], *some: str) -> bool:
    return not set(names).isdisjoint(some)


def _kernel(names: tuple[str, ...], ready: Prepared | None) -> Callable[..., None]:
    """What integrates motions: (batch, times, limits, out, info, their numbers, what times are counted in) -> None."""
    rows = np.array([(ROWS if ready else FIELDS).index(name) for name in names], np.int64)

    def driven(given: tuple, times: NDArray, limits: tuple, out: Any, info: NDArray, which: Any, unit: float) -> None:
        from ..kernels.drive.loop import drive_loop

        assert ready
        drives, unnoted = ready.in_unit(unit, which), (np.empty((0, 2)), np.empty(0))
        drive_loop(given, drives, times, limits, rows, out, info, unnoted)

    def free(given: tuple, times: NDArray, limits: tuple, out: NDArray, info: NDArray, *_: Any) -> None:
        from ..kernels.motion.loop import NOTHING_NOTED, motion_loop

        motion_loop(given, times, limits, rows, out, info, tuple(NOTHING_NOTED), 0, len(info))

    def with_losses(given: tuple, times: NDArray, limits: tuple, out: NDArray, info: NDArray, *_: Any) -> None:
        from ..kernels.motion.losses import loss_loop

        loss_loop(given, times, limits, rows, out, info, 0, len(info))

    return driven if ready else with_losses if _among(names, *LOSSES) else free
