"""Motions that are checked and ready to be integrated: :class:`MotionProblem`, and those of a flow
map: :class:`FlowProblem`; and the calls of the kernel.

T_ref is the unit of time of dimensionless motions: T_epsilon of a material that is an alpha, the
``T_ref`` of any other material.  Speeds are divided by R/T_ref, angular velocities by 1/T_ref.
"""

import math
import sys
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics import (
    LARGEST_LOSS,
    FreeRolling,
    Parameters,
    Roller,
    contact,
    refuse_beyond,
    refuse_cover,
    resolve_model,
    warn_of_start,
)
from ..core import (
    Floats,
    Integers,
    MotionStatus,
    NDArray,
    ParameterError,
    Scale,
    check_array,
    check_bool,
    check_integer,
    check_number,
    make_dimensionless,
    run_blocks,
)
from ..laws import law_table
from .drive_functions import UNDRIVEN, DriveFunctions, KernelDrive, prepare_drive
from .motion_arguments import (
    LOSSES,
    ROWS,
    STATES,
    Drive,
    with_scales,
)

#: Smallest and largest rtol, dimensionless: below, rounding errors prevail; above, errors are no
#: longer proportional.
RTOL_RANGE = {"low": 1e-12, "high": 1e-2}
#: Largest step limit: a motion takes some hundreds of steps.
MOST_STEPS = 10_000_000
#: Indices of all rows of the kernel's output.
_ALL_ROWS = np.arange(len(ROWS))
#: Indices of the rows of free motions.
_FREE_ROWS = np.array([ROWS.index(name) for name in STATES + LOSSES], np.int64)
#: (rtol, threshold of rest, step limit) of the motions of a flow map: as accurate as the integrator
#: is, where alpha = 1e10 takes tens of thousands of steps.
_MAP_LIMITS = (1e-12, 0.0, 100_000)
#: Motions of a flow map in a block of work.
_BLOCK = 40
#: Empty arrays for the switches and for the ends of steps, where they are not kept.
NO_NOTES = np.empty((0, 2)), np.empty(0)


class SolverOptions(NamedTuple):
    """How motions are integrated: the arguments of :func:`viscoroll.roll` of these names, as the
    caller gave them.

    rtol : relative tolerance, in [1e-12, 1e-2].
    rest : rest threshold of max(|V|, R |omega|), in the unit of the roller; None: a motion does not
    end at rest.
    max_steps : largest number of steps of a motion.
    resolve : largest spacing of the samples of a callable load, in the roller's unit of time; None:
    a thousandth of the motion.
    unsteady : whether the added mass N acts, M(V) + N dV/dt in place of M.
    rested : whether the cylinder stood still for long before the start, or the time for which it
    did, in the roller's unit.
    """

    rtol: float
    rest: float | None
    max_steps: int
    resolve: float | None
    unsteady: bool
    rested: bool | float


class MotionProblem(NamedTuple):
    """Checked motions; dimensionless but for roller and drive.

    roller, scene : the roller (:class:`Scene` or :class:`Cylinder`) on its slope, in the units of
    the caller, and its dimensionless :class:`Parameters`.
    drive : :class:`Drive`, loads and prescribed speeds as given, in the units of the roller; a load
    that is 0 at all times is None.
    functions : the same as dimensionless functions of time, :class:`DriveFunctions`.
    V0, omega0 : start speeds, numbers or (n,), reduced by the speed that a start after a standstill
    costs.
    immobile : whether a motion is too slow to leave the indentation of a standstill: (n,), or one
    truth value for all.
    end : last time, in T_ref.
    limits : (rtol; threshold of rest, dimensionless, 0 for none; largest number of steps, the
    corners of the drive included).
    unsteady : whether the added mass N acts.
    driven : whether a load other than 0, or a prescribed speed, is given, or the added mass acts.
    """

    roller: Roller
    scene: Parameters
    drive: Drive
    functions: DriveFunctions
    V0: Any
    omega0: Any
    immobile: Any
    end: float
    limits: tuple[float, float, int]
    unsteady: bool
    driven: bool

    def warn_of_start(self, start: tuple[Any, Any]) -> None:
        """Warn of motions for which the model fails grossly, judged by their ``start``, V and omega
        as the caller gave them; None for a prescribed one.
        """
        warn_of_start(self.roller, self.scene, start, self.V0, self.omega0, self.driven)


def require_single(**arguments: Any) -> None:
    """Raise ParameterError for an array where ``roll`` takes one number.

    arguments: name of an argument of ``roll`` -> its value.  Numbers, arrays of shape () and None
    pass, and so does what is no array, which is checked elsewhere; a nested list of unequal lengths
    counts as a vector of lists.
    The error is that of the first argument with axes, also of shape (1,); without one None is
    returned.
    """
    for name, value in arguments.items():
        if type(value) is float:
            continue
        try:
            shape = tuple(np.shape(value if hasattr(value, "shape") else np.asarray(value, object)))
        except (TypeError, ValueError):
            shape = ()
        if shape:
            raise ParameterError(
                name,
                shape,
                "a single number",
                f"roll computes one motion, but {name} has shape {shape}: use ensemble",
            )


def make_problem(
    roller: Roller,
    start: tuple[Any, Any],
    drive: Drive,
    end: float,
    options: SolverOptions,
    *,
    single: bool = False,
) -> MotionProblem:
    """Check everything about motions before any is integrated, and convert it to dimensionless
    numbers.

    roller: :class:`Scene` or :class:`Cylinder`.
    start: V0 and omega0 in its units, plain numbers or arrays (n,); None where a speed is
    prescribed.
    drive: :class:`Drive`, loads and prescribed speeds in its units, without labels.
    end: last output time, in its unit.
    options: :class:`SolverOptions`, not yet checked.
    single: whether only one motion is allowed (``roll``); else an ensemble.
    Raises ParameterError for what :func:`viscoroll.roll` (``single``) or :func:`viscoroll.ensemble`
    refuses, apart from output times, units and labels, and of an ensemble arrays that do not
    broadcast, fields, method, ``speed``, threads and progress.  The message states units where it
    has dimensionless numbers (:func:`.motion_arguments.with_scales`).  Exceptions of a callable
    pass.
    Returns the :class:`MotionProblem`.  Its callables are fitted, loads that are 0 at all times are
    left out, the start speeds are reduced by the cost of a standstill, and the step limit is raised
    by the number of corners of the drive; nothing is integrated.
    """
    acts = drive.acts
    if single:
        require_single(V0=start[0], omega0=start[1], **(drive.numbers if acts else {}))
    drive = drive.without_zeros() if acts else drive
    rtol, rest, max_steps, resolve, unsteady, rested = options
    roller, scene, scale = resolve_model(
        roller, "roll" if single else "ensemble", moves=True, slope=drive.slope
    )
    if single and scene.shape:
        require_single(material=roller.material, **roller.numbers)
    # one threshold in m/s would be another dimensionless number for each motion
    if rest is not None and np.ndim(scale["V"]):
        raise ParameterError(
            "rest",
            rest,
            "None",
            f"rest = {rest!r:.60} is one speed in m/s for all motions, but R or the time T_ref "
            "of the material (T_epsilon) differs between them: leave rest out, or give all the "
            "same R and T_ref",
        )
    unsteady = unsteady is not False and _check_unsteady(unsteady, scene)
    if (last := float(end) / scale["t"]) == math.inf:
        longest = sys.float_info.max * min(scale["t"], 1.0)
        raise ParameterError("t", end, f"less than {longest:.3g}")
    rtol = check_number("rtol", rtol, **RTOL_RANGE)
    # 0.0: a motion does not end at rest
    threshold = (
        0.0 if rest is None else check_number("rest", rest, unit=scale, above=0.0) / scale["rest"]
    )
    max_steps = check_integer("max_steps", max_steps, 1, MOST_STEPS)
    if resolve is not None:
        if not any(map(callable, drive.values.values())):
            raise ParameterError(
                "resolve",
                resolve,
                "left out",
                f"resolve = {resolve!s:.60} is given, but no load or speed is given as a "
                "Python function of t: leave resolve out (a Schedule does not need it)",
            )
        resolve = check_number("resolve", resolve, unit=scale, above=0.0) / scale["t"]
    try:
        V0 = make_dimensionless("V0", start[0], scale)
        omega0 = make_dimensionless("omega0", start[1], scale)
        loads = drive
        if acts and scale.si:
            loads = Drive(*map(make_dimensionless, Drive._fields, drive, (scale,) * len(drive)))
        functions, V0, omega0 = prepare_drive(loads, V0, omega0, last, rtol, resolve=resolve)
        V0, omega0, immobile = _apply_standstill(
            V0, omega0, functions.prescribed, scene, rested, scale
        )
    except ParameterError as error:
        raise with_scales(error, scale) from error
    if rest is not None and functions.acts_at_end:
        why = (
            f"{functions.prescribed} is prescribed: leave rest out"
            if functions.prescribed
            else f"a load (given: {', '.join(drive.given)}) still acts at the end of the motion: "
            "leave rest out, or let the load end earlier (Motion.switches has the time at which a "
            "brake stops the cylinder)"
        )
        raise ParameterError("rest", rest, "None", f"rest = {rest!s:.60} is given, but {why}")
    if single and functions is not UNDRIVEN:
        many = {
            name: f.terms[:, 0, 0] for name, f in functions.functions.items() if len(f.terms) > 1
        }
        require_single(
            **many, **{"a gain, V or omega of a Feedback,": functions.gains[0].squeeze()}
        )
    return MotionProblem(
        roller=roller,
        scene=scene,
        drive=drive,
        functions=functions,
        V0=V0,
        omega0=omega0,
        immobile=immobile,
        end=last,
        # a step ends at every corner
        limits=(rtol, threshold, max_steps + functions.corners),
        unsteady=unsteady,
        driven=unsteady or functions is not UNDRIVEN,
    )


def _check_unsteady(unsteady: Any, scene: Parameters) -> bool:
    """Return whether the added mass N acts, a bool.

    unsteady: argument of the caller, whether M(V) + N dV/dt stands for M.
    scene: :class:`Parameters`, dimensionless, of the roller; its cover and whether its bodies are
    alike are read.
    Raises ParameterError for what is no truth value, and, if it is True, for covers, which have no
    N, and for bodies of different materials, whose motions with N are not computed.
    """
    if not check_bool("unsteady", unsteady):
        return False
    if scene.cover is None and not scene.like_bodies:
        raise ParameterError(
            "unsteady",
            True,
            "False where bodies differ",
            "unsteady = True: motions with the added mass N are computed for two bodies of "
            "one material only; leave unsteady=True out",
        )
    refuse_cover(scene, "leave unsteady=True out, as the added mass N is not computed")
    return True


def _apply_standstill(
    V0: Any, omega0: Any, prescribed: str, scene: Parameters, rested: Any, scale: Scale
) -> tuple[Any, Any, Any]:
    """Reduce the start speeds by the cost of leaving the indentation of a standstill.

    V0, omega0: start speeds, dimensionless, numbers or (n,).
    prescribed: name of the prescribed speed, "" for none.
    scene: :class:`Parameters`, dimensionless, of the roller, with gamma.
    rested: argument of the caller: False or 0 (no standstill), True (a long one), or its time, in
    the unit of the roller.
    scale: :class:`Scale` of the roller.
    Returns (V0; omega0; whether the cylinder is too slow to leave its indentation), dimensionless.
    Without a standstill the speeds are returned as they are, with False.  Else V0 and omega0 of
    each motion are multiplied by the same factor in [0, 1], and the third entry has the common
    shape of V0 and the scene's arrays.  It is True where this takes more than 45 % of V
    (:data:`LARGEST_LOSS`); the factor of such a motion has no meaning.
    Raises ParameterError for ``rested`` that is neither a truth value nor one finite number >= 0,
    and for one with a unit of another dimension; after a standstill if a speed is prescribed, any
    motion starts in full slip or from V0 = omega0 = 0, or the roller has a cover: the cost is then
    not known.
    """
    if isinstance(rested, bool | np.bool_):
        time: Any = math.inf if rested else 0.0
    else:
        time = check_array("rested", rested, unit=scale, low=0.0)
        if time.ndim:
            raise ParameterError("rested", rested, "one time >= 0, or True")
    if time == 0.0:
        return V0, omega0, False
    refuse_cover(
        scene, "leave rested out, as the loss of a start after a standstill is not computed"
    )
    V = np.asarray(V0, np.float64)
    limit = np.abs(V) * contact(scene, V, delta=0.0, fields="delta_star").delta_star
    why = (
        "a speed is prescribed"
        if prescribed
        else "the cylinder starts at V0 = omega0 = 0"
        if np.any((V == 0.0) & (omega0 == 0.0))
        else "R omega0 differs so much from V0 that the cylinder starts in full slip"
        * bool(np.any(np.abs(omega0 - V) > limit))
    )
    if why:
        raise ParameterError(
            "rested",
            rested,
            "left out",
            f"rested is given, but {why}: leave rested out, as the loss at this start is not known",
        )
    # part of V; V = 0 with omega0 = 0 was refused above, and without a limit any other omega0 slips
    lost = FreeRolling.of_scene(scene, V).start(time / scale["t"]).speed
    lost = lost / np.where(V == 0.0, 1.0, np.abs(V))
    return V * (1.0 - lost), omega0 * (1.0 - lost), lost > LARGEST_LOSS


def integrate(
    count: int,
    batch: tuple[Any, ...],
    drive: KernelDrive,
    times: Floats,
    limits: tuple[float, float, int],
    rows: Integers,
    notes: tuple[NDArray, ...] = NO_NOTES,
) -> tuple[Floats, Floats]:
    """Integrate motions in the kernel.

    count: number of motions, >= 0.
    batch: (law, the kernel's record of one material or of several; whether the two bodies take
    unequal parts of M; kappa, mu, gamma, j, V0, omega0, read-only vectors of one value or ``count``
    values), dimensionless.
    drive: drive of the motions as the kernels take it, :data:`.drive_functions.KernelDrive`.
    times: output times since the start, (times,), at least one, >= 0, ascending, in T_ref.
    limits: (rtol; threshold of rest, 0 for none; largest number of steps).
    rows: (rows,), int, indices into :data:`.motion_arguments.ROWS`: the quantities to compute.
    notes: (switches, (k, 2): time in T_ref and new regime, or -1 where V changes its sign; ends of
    steps, (l,), in T_ref). Both are written from the front in the order of time; what exceeds their
    length is left out, and entries that are not needed stay as they were.  Each motion overwrites
    those of the one before, so that they are of use for one motion.  Arrays of length 0 keep
    nothing.
    Returns (quantities, (rows, count, times), NaN at times that a motion did not reach; information
    on each motion, (count, 5), floats: code of :class:`MotionStatus`, number of steps, rejected
    ones included, number of changes of regime, onset time and rest time in T_ref, NaN where there
    is none).
    """
    from ..kernels.motion.driver import N_INFO_COLUMNS, motion_loop

    out = np.empty((len(rows), count, times.size))
    info = np.empty((count, N_INFO_COLUMNS))
    motion_loop(batch, drive, times, limits, rows, out, info, notes)
    return out, info


def integrate_single(
    problem: MotionProblem, times: Floats, *notes: NDArray
) -> tuple[Floats, list[float]]:
    """Integrate one motion.

    problem: :class:`MotionProblem` of one motion; scene, functions, V0, omega0, immobile, limits
    and unsteady are read.
    times: output times since the start, (times,), at least one, >= 0, ascending, in T_ref.
    notes: the two arrays (k, 2) and (l,) of :func:`integrate`, which receive the switches and the
    ends of steps; none: neither is kept.
    Returns (all quantities in the order of :data:`.motion_arguments.ROWS`, (rows, times),
    dimensionless, NaN at times that the motion did not reach; a list of five numbers: code of
    :class:`MotionStatus`, number of steps, number of changes of regime, onset time and rest time in
    T_ref, NaN where there
    is none; all of them floats).  A cylinder that stays in its indentation is not integrated: its
    quantities are NaN, the list is [MotionStatus.CAUGHT, 0, 0, NaN, NaN], with the member of the
    enum and two ints, and ``notes`` stay as they were.
    """
    scene = problem.scene
    if problem.immobile:
        return np.full((len(ROWS), times.size), np.nan), [
            MotionStatus.CAUGHT,
            0,
            0,
            np.nan,
            np.nan,
        ]
    law: Any = scene.rolling_law
    numbers = scene.kappa, scene.mu, scene.gamma, scene.j, problem.V0, problem.omega0
    arrays = np.array(numbers, float).reshape(-1, 1)
    arrays.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    batch = law.unsteady_record if problem.unsteady else law.record, law.unlike, *arrays
    out, info = integrate(
        1,
        batch,
        problem.functions.for_kernel(),
        times,
        problem.limits,
        _ALL_ROWS,
        notes,
    )
    if law.coupled is not None:
        refuse_beyond(law, scene.kappa * np.abs(np.nan_to_num(out[ROWS.index("V"), 0])))
    return out[:, 0], info[0].tolist()


def integrate_motions(
    parameters: tuple[Any, ...],
    starts: Any,
    gamma: Floats,
    t: Floats,
    *,
    threads: int | None = 1,
) -> tuple[Floats, Floats]:
    """Integrate free motions of one scene, from which a flow map (:mod:`.flow`) is built and by
    which it is tested.

    They are integrated at rtol 1e-12, and by the same call of the kernel as an ensemble, so that no
    kernel is compiled for them alone.

    parameters: (material, kappa, mu, j), numbers; the material is alpha, or a :class:`Prony` series
    in its own unit of time.
    starts: V0 and omega0, (n,) each, dimensionless.
    gamma: P T_ref^2/(m R), the ratio of load to inertia that sets the time scale, of each motion, >
    0, (n,) or (1,).
    t: output times since the start, (times,), >= 0, ascending, common to all, in the material's
    unit of time.
    threads: number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    Raises ParameterError for a number of threads that is no whole number >= 1.
    Returns (V, omega, x, angle, delta, regime, slip_loss, rolling_loss, (8, n, times),
    dimensionless, NaN at times that a motion did not reach; onset time of each motion, (n,), NaN
    where there is none).
    """
    material, kappa, mu, j = parameters
    law = law_table(material)
    count = starts[0].size
    arrays = np.array(np.broadcast_arrays(kappa, mu, gamma, j, *starts))
    arrays.flags.writeable = False
    out = np.empty((len(_FREE_ROWS), count, t.size))
    onset = np.empty(count)

    def work(start: int, stop: int) -> None:
        batch = law.record, law.unlike, *arrays[:, start:stop]
        out[:, start:stop], info = integrate(
            stop - start,
            batch,
            UNDRIVEN.for_kernel(),
            t,
            _MAP_LIMITS,
            _FREE_ROWS,
        )
        onset[start:stop] = info[:, 3]

    run_blocks(work, count, _BLOCK, threads=threads)
    return out, onset


# --- A scene for which a flow map is built ---

#: Reason: the rolling resistance exceeds the friction.
STOPS = "the sliding cylinder can reach a steady speed"
#: Reason: a motion of the slow manifold leaves partial slip.
FULL_SLIP_RETURNS = "full slip can return after partial slip"
#: Reason: a motion of a boundary layer leaves partial slip.
STICK_ENDS = "the cylinder can return from partial slip to full slip"
#: Reason: numbers that are not finite.
OUT_OF_RANGE = "speeds or times exceed the range of double precision"


class NoFlowMap(Exception):
    """The scene has no flow map; the message is the reason."""


class FlowProblem(NamedTuple):
    """A scene for which a map is made.

    material, kappa, mu, j : numbers; the material is alpha, or a :class:`Prony` series in its own
    unit of time.
    law : the kernels' record of the contact law of the material.
    slow_rate : rate at which ln V falls at low speeds, in units of gamma, > 0.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    """

    material: Any
    kappa: float
    mu: float
    j: float
    law: Any
    slow_rate: float
    threads: int | None

    def contact_states(self, V: Floats, delta: Any = 0.0) -> Floats:
        """Return critical creepage, moment, traction and its slope at speeds and creepages inside
        the stick zone.

        V, delta : speeds, > 0, and creepages, |delta| < delta_star, dimensionless, of one shape or
        one for all.
        Returns (4, ...), dimensionless, in this order, each in the shape of V: delta_star, M, Q
        with the sign of delta (0 at delta = 0), dQ/d delta at fixed V; :mod:`.flow_layout`
        names the indices.
        """
        from ..kernels.motion.flow_layout import states

        out = np.empty((4, V.size))
        delta = np.broadcast_to(delta, V.shape)
        states(V.ravel(), delta.ravel(), self.kappa, self.mu, self.law, out)
        return out.reshape(4, *V.shape)

    def integrate(
        self, V: Floats, delta: Floats, gamma: Floats, t: Floats, reason: str
    ) -> tuple[Floats, Floats]:
        """Integrate motions that start and stay in partial slip, or start just before its onset.

        V, delta : start speeds, > 0 (not checked), and creepages, (n,), n >= 1, dimensionless.
        gamma : ratio of the load to inertia, which sets the time scale, of each motion, > 0, (n,)
        or (1,).
        t : output times since the start, >= 0, ascending, (times,), common to all, dimensionless;
        the tables count the time gamma t, so that t is the time of the tables divided by the gamma
        of each motion.
        reason : message of :class:`NoFlowMap` if a motion is not in partial slip with V > 0 at an
        output time.
        Raises :class:`NoFlowMap` for this reason, which includes motions that could not be
        integrated to the end; and for OUT_OF_RANGE if V, delta, gamma, their product or t is not
        finite, or gamma is not positive.
        Returns (V, delta), each (n, times), dimensionless.
        """
        from ..kernels.records import PARTIAL_SLIP

        if not (
            np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()
        ):
            raise NoFlowMap(OUT_OF_RANGE)
        (V, _, _, _, delta, regime, *_), _ = integrate_motions(
            self[:4], (V, V * (1.0 + delta)), gamma, t, threads=self.threads
        )
        if not ((regime == PARTIAL_SLIP) & (V > 0.0)).all():
            raise NoFlowMap(reason)
        return V, delta
