"""Many motions at once: :func:`ensemble`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import Roller, scale_of
from ..contact_law.validity.model_warnings import warn_of_speeds, warn_of_start
from ..core.array_types import Numbers
from ..core.blocks import broadcast_vector, thread_count
from ..core.checks import broadcast_shape, check_bool, check_choice, check_number
from ..core.drive import Feedback, Schedule, make_dimensionless
from ..core.errors import ParameterError, check_names, shape_error
from .batch import Batch, Solution, solve_batch
from .checks import output_times, with_scales
from .drive import ACTING, ROWS, Drive, strip_units
from .ensemble_result import Ensemble
from .problem import MotionProblem, SolverOptions, make_problem

#: A function of time of each motion.
Function = Numbers | Schedule | Callable[[float], float]
#: Fields that an ensemble may keep.
FIELDS = ROWS


def ensemble(
    roller: Roller,
    V0: Numbers | None,
    omega0: Numbers | None,
    t: Numbers,
    *,
    force: Function | Feedback | None = None,
    torque: Function | Feedback | None = None,
    slope: Numbers | None = None,
    brake: Function | None = None,
    drag: Numbers | None = None,
    omega: Function | None = None,
    V: Function | None = None,
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
    """Compute the motions of n cylinders or n starts; the result has the same bits for any number of threads.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` in SI units; its numbers may be arrays of n too: every motion can
        have a scene of its own.  The unit of time T_ref of a scene is T_epsilon of an ``alpha``, else that of its
        material.
    V0, omega0 : start speeds, numbers or arrays (n,), divided by R/T_ref and 1/T_ref, or in m/s and rad/s; None where
        they are prescribed.  Labels of xarray and pandas come back in ``to_xarray``.
    t : output times, (times,), >= 0, ascending, common to all, divided by T_ref or in s; one number: the final state
        only.
    force, torque, slope, brake, drag, omega, V : loads and prescribed speeds, as for :func:`roll`; numbers may be
        arrays (n,), times and values of a :class:`Schedule` of shape (n, k).
    method : "integrate": each motion as :func:`roll` would, bit for bit at one alpha, to the
        error of ``rtol`` at an alpha each.  "flow": look the
        motions up in the flow map of their one scene, which is built if it is not on disk
        yet.  "auto": "flow" for 4096 motions or more of one scene.  The map is used only
        where its stated error is at most ``rtol``, and only for the motions that it contains;
        all others are integrated, with "flow" too.  The result says which, and the map's error.  Driven and unsteady
        motions, and those of bodies that differ, are integrated: "flow" is refused.
    rtol, rest, unsteady, rested, max_steps, resolve : as for :func:`roll`; ``V0`` and ``omega0`` of the result are
        those after the cost of a standstill.  With a material each an unsteady motion takes some milliseconds more,
        for its N.
    fields : names of the quantities to compute, out of ``V omega x angle delta regime slip_loss rolling_loss``, and
        ``force torque work_force work_torque brake_loss``; only these are kept in memory.  Works and losses are good to
        some rtol of the energy that moves.
    speed : highest speed, > 0, in the unit of V0, that the flow map is made for; default the largest of the starts.
        Where a large ensemble is computed in several calls, one number for all makes the
        bits independent of how it is divided.  Ignored where no flow map is used.
    threads : threads to use, >= 1; None: ``$VISCOROLL_THREADS``, or where that is not set the cores available.
    progress : draw a progress bar on standard error if the call takes longer than a second.

    Returns
    -------
    Ensemble
        Its ``fields``, (n, times) each, in the units of the roller; the others are None.

    Raises
    ------
    ParameterError
        NaN or infinite input, unsorted times, shapes that do not broadcast to (n,),
        unknown fields or method; method "flow" with parameters that differ between motions, with a drive, with
        ``unsteady`` or with bodies that differ; arrays with labels beside arrays without, or with other labels; a
        number of threads that is no whole number >= 1; what :func:`roll` refuses.
    Exception
        What a callable raises.

    Warns
    -----
    ModelWarning
        Where starts or speeds violate assumptions of the model grossly.
    RuntimeWarning
        Where a flow map on disk is damaged; it is built again.

    Examples
    --------
    >>> import numpy as np, viscoroll as vr
    >>> V0 = np.linspace(1.0, 2.0, 5)
    >>> result = vr.ensemble(vr.presets.RUBBER_CYLINDER, V0, V0 / 0.1, [0.5, 1.0])
    >>> result.V.shape
    (5, 2)

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
    start, drive, labels = strip_units((V0, omega0), Drive(force, torque, slope, brake, drag, omega, V), units)
    progress = check_bool("progress", progress)
    if speed is not None:
        speed = check_number("speed", speed, unit=units, above=0.0)
    options = SolverOptions(rtol, rest, max_steps, resolve, unsteady, rested)
    problem = make_problem(roller, start, drive, times[-1], options)
    inputs, count = _broadcast_inputs(problem, drive.numbers)
    warn_of_start(problem.roller, problem.scene, start, problem.V0, problem.omega0, problem.driven)
    scale = problem.roller.scale
    batch = Batch(
        problem, inputs, np.broadcast_to(problem.immobile, (count,)), times / scale["t"],
        names if problem.drive.acts else tuple(name for name in names if name not in ACTING),
        thread_count(threads), "motions" if progress else None,
    )  # fmt: skip
    try:
        solution = solve_batch(batch, method, make_dimensionless("speed", speed, scale))
    except ParameterError as error:
        raise with_scales(error, scale) from error
    columns: dict[str, Any] = dict.fromkeys(FIELDS) | {name: np.zeros((count, times.size)) for name in names}
    columns |= _in_units(batch, solution)
    result = Ensemble(roller=problem.roller, t=times, drive=problem.drive, labels=labels, **columns)
    warn_of_speeds(problem.roller, start[0], result.V)
    return result


def _broadcast_inputs(problem: MotionProblem, drives: dict[str, NDArray]) -> tuple[dict[str, NDArray], int]:
    """Broadcast the parameters and start speeds of an ensemble to the number of its motions.

    problem: :class:`MotionProblem`, checked motions of the ensemble; scene, V0, omega0 and functions are read.
    drives: name -> loads or prescribed speeds that are numbers or arrays, as the caller gave them; only their shapes
    matter.
    Returns (name -> read-only vector, (1,) where one value holds for all motions, else (n,): alpha, kappa, mu, gamma,
    j, V0, omega0, dimensionless; n, which is 1 if all are numbers).
    Raises ParameterError where they, the functions of the drive included, do not broadcast to (n,).
    """
    arrays = {name: np.asarray(value) for name, value in problem.scene.numbers.items()}
    arrays |= {"V0": np.asarray(problem.V0), "omega0": np.asarray(problem.omega0)}
    counts = (1, 1) if problem.functions is None else problem.functions.counts
    own = {name: np.zeros(n) for name, n in zip(("drive", "gains"), counts, strict=True) if n > 1}
    shape = broadcast_shape(**arrays, **drives, **own)
    if len(shape) > 1:
        raise shape_error("V0 or omega0", shape, "a number or a vector (n,)")
    count = shape[0] if shape else 1
    return {name: broadcast_vector(array, (count,)) for name, array in arrays.items()}, count


def _in_units(batch: Batch, solution: Solution) -> dict[str, Any]:
    """Convert the solution of an ensemble to the fields of :class:`Ensemble`, in the units of its roller.

    batch: :class:`Batch`, motions of the ensemble, of which problem, inputs, rows and the size of immobile are read.
    solution: :class:`Solution`, dimensionless; of a cylinder its quantities are overwritten by those in SI units.
    Returns name -> field: quantities (n, times) by their names in :attr:`Batch.rows`, which are views of those of
    ``solution``, NaN at times that a motion did not reach; onset_time, rest_time (NaN where there is none), V0 and
    omega0, read-only, status (codes of :class:`MotionStatus`), switches, steps, flow, (n,); drive_error, which stays
    dimensionless, flow_error, floats; flow_problem, a text.
    """
    found, scale, shape = solution.motions, batch.problem.roller.scale, (batch.immobile.size,)
    rows: dict[str, Any] = dict(zip(batch.rows, found.out, strict=True))
    times = {
        "onset_time": found.onset,
        "rest_time": found.rest,
        "V0": batch.inputs["V0"],
        "omega0": batch.inputs["omega0"],
    }
    if scale.si:
        for name, row in rows.items():
            np.multiply(row, np.reshape(scale[name], (-1, 1)), out=row)
        times = {name: value * scale[name] for name, value in times.items()}
    times = {name: np.broadcast_to(value, shape) for name, value in times.items()}
    notes = {"status": found.status, "switches": found.switches, "drive_error": batch.problem.drive_error}
    return rows | times | notes | solution.about
