"""One motion: :func:`roll` and its result."""

from __future__ import annotations

import warnings
from collections.abc import Callable

from ..contact_mechanics.model_warnings import warn_of_speeds, warn_of_start
from ..contact_mechanics.parameters import Roller, scale_of
from ..core.checks import Numbers
from ..core.drive_arguments import Feedback, Schedule
from ..core.labels import UNLABELLED_TYPES
from .motion_arguments import Drive, output_times, strip_units
from .motion_problem import SolverOptions, make_problem
from .motion_result import Motion, integrate_motion

#: A function of time.
Function = float | Schedule | Callable[[float], float]
#: A load, which may follow the speeds too.
Load = Function | Feedback


def roll(
    roller: Roller,
    V0: float | None,
    omega0: float | None,
    t: Numbers,
    *,
    rtol: float = 1e-8,
    force: Load | None = None,
    torque: Load | None = None,
    slope: float | None = None,
    brake: Function | None = None,
    drag: float | None = None,
    omega: Function | None = None,
    V: Function | None = None,
    rest: float | None = None,
    unsteady: bool = False,
    rested: bool | float = False,
    max_steps: int = 100_000,
    resolve: float | None = None,
) -> Motion:
    """Integrate the motion of the cylinder from (V0, omega0), Eq. (22), through all regimes.

    Parameters
    ----------
    roller : a :class:`Scene`; or a :class:`Cylinder`, in SI units per m of its length: s, m/s,
        rad/s, m, N, N m, J.  One, no arrays.  Below, "divided by" is the unit of a scene, whose
        unit of time is T_ref (T_epsilon of an ``alpha``); with a cylinder the SI unit takes its
        place.
    V0 : initial speed of the axis, divided by R/T_ref or in m/s, of any sign; left out (None) with
        ``V``.  The larger of |V0| and R |omega0| is 0, or in [1e-300, 1e100] R/T_ref.
    omega0 : initial angular velocity, divided by 1/T_ref or in rad/s, of any sign; left out (None)
        with ``omega``.  Limits as for V0.
    t : output times, (times,), >= 0, ascending, divided by T_ref or in s; one number: the final
        state only, and ``course`` of the result is the whole motion.
    rtol : relative tolerance in [1e-12, 1e-2].  The global relative error of x and of the switch
        times is proportional to it; that of V and omega too, multiplied by t |V'|/|V|, by which a
        late
        speed magnifies any earlier error.  Errors are mostly below rtol, at most 30 rtol for the
        scenes of ``tests/motion/test_motion.py``; rare motions elsewhere may exceed that a little.
    force : force on the axis along V, divided by P; kinds as for ``torque``.
    torque : torque on the cylinder along omega, divided by P R: a number or a function of time.

        - a number;
        - ``vr.Schedule(times, values)``: linear between the times, constant outside; a time given
          twice is a jump;
        - a callable of t, smooth but for jumps and corners.  It is fitted by polynomials to a tenth
          of ``rtol`` of its largest value so far; below 1e-9 of its largest value of all it starts
          at 0 (``drive_error`` is the error of the fit).  A thousand samples are taken first,
          between which a pulse can be missed: see ``resolve``;
        - ``vr.Feedback(value, V=gain, omega=gain)``: any of these plus gains times the speeds.
    slope : angle in radians, > 0 if +V points downhill: P sin(slope) is added to ``force``.  The
        load is then P cos(slope), by which force, torque, Q and M of a scene are divided; ``scene``
        of the result has the kappa and gamma of that load.
    brake : largest torque of a brake, divided by P R, >= 0: a number, a Schedule or a callable, as
        for ``force``, but no Feedback.  It acts against omega, and keeps omega = 0 while |Q +
        M_cylinder - torque| does not exceed it.
    drag : torque of a bearing against omega, for each unit of omega, >= 0, a number, divided by P R
        T_ref or in N m s/m.  It is part of ``torque`` of the result.
    omega : prescribed angular velocity, in place of ``torque``: a number, a Schedule or a callable
        of t, continuous; ``omega0`` is then left out (None) or its value at t = 0.
    V : prescribed speed of the axis, in place of ``force``: kinds as for ``omega``, continuous;
        ``V0`` is then left out (None) or its value at t = 0.
    rest : a speed, divided by R/T_ref or in m/s; None: none.  End the motion where max(|V|,
        R |omega|) falls below this once nothing drives any more; refused where something drives to
        the end.  Nothing stops in finite time: at small V the speed decays like exp(-gamma c t/(1 +
        j)) with c = (alpha - 1)/alpha, and an elastic cylinder (alpha
        = 1) rolls for ever.  From there on V = omega = 0, and x and angle stay; the omitted
        distance is close to (1 + j) V/(gamma c).
    unsteady : in partial slip use M(V) + N(V) V' for M: N adds to the mass, (1 + j + gamma N)
        V' = -gamma M where creepage is small.  The errors of V by the law of steady rolling become
        some five times smaller (docs/validity.md).  The motion ends where gamma N has risen to 1 +
        j or fallen to -(1 + j)/2, or to -1 if that comes first: below that speed the cylinder stays
        in its own indentation.  A drive may jump; V' then jumps too, which the real contact follows
        with a delay.  Refused where the bodies differ.
    rested : whether the cylinder stood still for long before the start, or the time for which it
        did, divided by T_ref or in s.  Leaving its indentation costs energy
        (``validity(V0).steady.start``), by which V0 and omega0 are reduced.  A motion that would
        lose seven tenths of its energy stays there: its outputs are NaN, its status is CAUGHT.  The
        cost is that of free rolling: with a force it is an approximation.
    max_steps : step limit, at most 10^7; every corner of a schedule, at which a step ends, adds one
        to it.
    resolve : largest spacing of the samples of a callable, divided by T_ref or in s; a pulse that
        lasts longer is seen.  Default, and at most: a thousandth of the motion.  Refused where it
        requires more than 5 10^5 samples, and where nothing is a callable.

    Returns
    -------
    Motion
        Speeds, path, creepage, regime, loads and energies at the output times, (times,) each, in
        the units of the roller; NaN, and regime -1, at times that the motion did not reach.

    Raises
    ------
    ParameterError
        NaN, infinite or oversized input, unsorted times, an array where one number belongs; both
        speeds prescribed, a prescribed speed that jumps or does not match its start, a callable
        that
        polynomials do not follow; ``rest`` where something drives to the end; ``unsteady`` with
        bodies that differ or with a cover; ``rested`` below 0, with a prescribed speed, with a
        cover, or at a start in full slip or from V0 = omega0 = 0; a scene without gamma, a layer
        too thin for its law; a unit of another dimension.
    Exception
        What a callable raises.

    Notes
    -----
    Under a drive, and with bodies that differ, the errors of V and omega are at most 30 ``rtol`` of
    the largest speed so far, mostly below 3 (``tests/motion/test_drive.py``); near a saddle
    (``vr.steady``) multiplied by the ratio at which neighbouring motions diverge.

    Examples
    --------
    Push, drive and brake: a slope of 2 degrees, a torque that rises for a second and ends, a brake.

    >>> import numpy as np, viscoroll as vr
    >>> scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3, gamma=0.5, j=0.5)
    >>> down = vr.roll(scene, 0.0, 0.0, 60.0, slope=np.radians(2.0))
    >>> start = vr.roll(
    ...     scene, 0.0, 0.0, 4.0, torque=vr.Schedule([0.0, 1.0, 1.0], [0.0, 0.2, 0.0])
    ... )
    >>> stop = vr.roll(scene, 0.5, 0.5, 10.0, brake=0.1)

    Warns
    -----
    RuntimeWarning
        Where the motion could not be integrated to the end; ``status`` and ``message`` say why.
    ModelWarning
        Where the start or the speeds violate assumptions of the model grossly.
    """
    units = scale_of(roller)
    times = output_times(t, units)
    drive = Drive(force=force, torque=torque, slope=slope, brake=brake, drag=drag, omega=omega, V=V)
    if not UNLABELLED_TYPES.issuperset(map(type, (V0, omega0, *drive))):
        (V0, omega0), drive, _ = strip_units((V0, omega0), drive, units)
    options = SolverOptions(
        rtol=rtol, rest=rest, max_steps=max_steps, resolve=resolve, unsteady=unsteady, rested=rested
    )
    problem = make_problem(roller, (V0, omega0), drive, times[-1], options, single=True)
    warn_of_start(
        problem.roller, problem.scene, (V0, omega0), problem.V0, problem.omega0, problem.driven
    )
    motion = integrate_motion(problem, times)
    warn_of_speeds(problem.roller, V0, motion.V)
    if not motion.success:
        text = (
            f"roll: {motion.status.message}; outputs not reached are NaN, and `message` gives "
            "the last state"
        )
        warnings.warn(text, RuntimeWarning, stacklevel=2)
    return motion
