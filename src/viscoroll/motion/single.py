"""One motion: :func:`roll` and its result."""

from __future__ import annotations

import warnings
from collections.abc import Callable

from ..contact_law.parameters import Rolls
from ..core.array_types import Numbers
from ..core.drive import Feedback, Schedule
from ..core.labels import UNLABELLED_TYPES
from ..core.scale import DIMENSIONLESS
from .checks import output_times
from .driven import Drive, bare
from .one import Motion, integrated
from .rolling import Asked, begin
from .warned import look

#: a function of time
Course = float | Schedule | Callable[[float], float]
Acting = Course | Feedback


def roll(
    roller: Rolls,
    V0: float | None,
    omega0: float | None,
    t: Numbers,
    *,
    rtol: float = 1e-8,
    force: Acting | None = None,
    torque: Acting | None = None,
    slope: float | None = None,
    brake: Course | None = None,
    drag: float | None = None,
    omega: Course | None = None,
    V: Course | None = None,
    rest: float | None = None,
    unsteady: bool = False,
    rested: bool | float = False,
    max_steps: int = 100_000,
    resolve: float | None = None,
) -> Motion:
    """Motion of the cylinder from (V0, omega0), Eq. (22), through all regimes.

    Parameters
    ----------
    roller : a :class:`Scene`; or a :class:`Cylinder`, in SI units per m of its length: s, m/s, rad/s, m, N, N m, J.
        One, no arrays.
    V0, omega0 : start speeds, any sign; the larger of the two 0, or in [1e-300, 1e100] R/T_ref.
    t : output times, ascending; one number: the final state only, and ``course`` of the result is the whole motion.
    rtol : tolerance in [1e-12, 1e-2]; the global relative error of x and the switch times is
        proportional to it, that of V and omega too, times t |V'|/|V|, by which a late
        speed magnifies any earlier error: mostly below rtol, at most 30 rtol on the scenes
        of ``tests/motion/test_motion.py``; rare motions elsewhere may exceed that a little.
    force, torque : over P along V, and over P R along omega, what pushes the axis and turns the cylinder:

        - a number;
        - ``vr.Schedule(times, values)``: linear between, constant outside, a time given twice is a jump;
        - a callable of t, smooth but for jumps and corners, fitted by polynomials to a tenth of ``rtol`` of its largest
          value so far, and of 1e-9 of its largest of all, below which it begins at 0 (``drive_error`` says how well).
          It is sampled in a thousand places first, between which a pulse can be missed: ``resolve`` sets how many;
        - ``vr.Feedback(value, V=gain, omega=gain)``: any of these and more with the speeds.
    slope : angle in radians, > 0 pushes along +V: P sin(slope) is added to ``force``.  The load is P cos(slope)
        then, over which of a scene force, torque, Q and M are; ``scene`` of the result has kappa and gamma of it.
    brake : the most torque over P R that a brake takes, >= 0, as for ``force``.  It acts against omega, and holds
        omega = 0 while |Q + M_cylinder - torque| is no more.
    drag : torque over P R against omega, for each unit of omega, as a bearing has it, >= 0; part of ``torque`` of the
        result.  It drives to the end: speeds decay by it too.
    omega : prescribed speed of the motor, in place of ``torque``; ``omega0`` is None or what it starts at.
    V : prescribed speed of the axis, in place of ``force``; ``V0`` likewise.  A prescribed speed must not jump.
    rest : end the motion where max(|V|, R |omega|) falls below this once nothing drives any more; refused where
        something drives to the end.  Nothing stops in finite time: at small V the speed decays like
        exp(-gamma c t/(1 + j)) with c = (alpha - 1)/alpha, and an elastic cylinder (alpha = 1) rolls for ever.
        From there on V = omega = 0 and x, angle stay; the distance so left out is close to (1 + j) V/(gamma c).
    unsteady : in partial slip take M(V) + N(V) V' for M: N adds to the mass, (1 + j + gamma N) V' = -gamma M where
        creep is slow.  Errors of V that the law of steady rolling makes become some five times smaller
        (docs/validity.md).  The motion ends where gamma N is 1 + j or -(1 + j)/2, at least -1: below that speed the
        contact comes to stand in its own imprint.  A drive may jump; V' does too then, which the contact in truth
        follows late.  Refused where bodies differ.
    rested : whether the contact had rested long before it starts to roll, or the time that it had.
        Leaving its imprint takes energy (``validity(V0).steady.start``): V0 and omega0 become what is left of them; a
        motion that would lose seven tenths is caught there.  It tells of free rolling: with a force it is near.
    max_steps : step limit, at most 10^7; every corner of a schedule, at which a step ends, adds one to it.
    resolve : largest spacing, a time, of the samples of a callable that drives; a pulse that lasts longer is seen.
        Default, and at most: a thousandth of the motion.  Refused where it makes more than 5 10^5 samples, and where
        nothing is a callable.

    Returns
    -------
    Motion

    Raises
    ------
    ParameterError
        NaN, infinite or oversized input, unsorted times, an array where one number belongs; both speeds prescribed,
        a prescribed speed that jumps or does not match its start, a callable that
        no polynomials follow; ``unsteady`` with bodies that differ; ``rested`` below 0, with a prescribed speed, or at
        a start in full slip.

    Notes
    -----
    Under a drive, and with bodies that differ, V and omega are off by at most 30 ``rtol`` of the largest speed so far,
    mostly below 3 (``tests/motion/test_drive.py``), near a saddle (``vr.steady``) times what neighbours part by.

    Examples
    --------
    Push, drive and brake: a slope of 2 degrees, a torque that rises for a second and ends, a brake.

    >>> import numpy as np, viscoroll as vr
    >>> scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3, gamma=0.5, j=0.5)
    >>> down = vr.roll(scene, 0.0, 0.0, 60.0, slope=np.radians(2.0))
    >>> start = vr.roll(scene, 0.0, 0.0, 4.0, torque=vr.Schedule([0.0, 1.0, 1.0], [0.0, 0.2, 0.0]))
    >>> stop = vr.roll(scene, 0.5, 0.5, 10.0, brake=0.1)

    Warns
    -----
    RuntimeWarning
        Where the motion could not be rolled to the end; ``status`` and ``message`` say why.
    """
    units = roller.scale if isinstance(roller, Rolls) else DIMENSIONLESS  # begin() refuses what is no roller
    times, given = output_times(t, units), Drive(force, torque, slope, brake, drag, omega, V)
    if not UNLABELLED_TYPES.issuperset(map(type, (V0, omega0, *given))):
        (V0, omega0), given, _ = bare((V0, omega0), given, units)
    asked = Asked(rtol, rest, max_steps, resolve)
    begun = begin(roller, (V0, omega0), given, times[-1], asked, unsteady=unsteady, rested=rested, one=True)
    begun.roller.look_at_starts(V0, omega0)
    look(begun)
    motion = integrated(begun, times)
    begun.roller.look_at_motion(V0, motion.V)
    if not motion.success:
        words = f"roll: {motion.status.message}; outputs not reached are NaN, and `message` says where it stood"
        warnings.warn(words, RuntimeWarning, stacklevel=2)
    return motion
