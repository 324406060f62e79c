"""One motion: :func:`roll` and its result."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..drive import Feedback
from ..errors import MOTION_STATUS, MotionStatus, ParameterError
from ..results import Row, Shown, Values, unit_of
from ..rolling_contact import contact
from ..scene import Scene, checked_scene
from ..symbols import attributes
from ..typed import Numbers
from ..validity import Validity
from .checks import SPEED_RANGE, controls, output_times, start_speeds
from .driven import LOSSES, ROWS, Drive
from .rolling import Inputs, rolled
from .warned import look

if TYPE_CHECKING:
    import xarray as xr

REGIMES = ("full slip", "partial slip", "rest", "locked", "held")
_SWITCHES_KEPT = 1000
#: room for the ends of steps at first
_STEPS = 1000
_NO_SWITCHES = np.empty((0, 2))
#: a function of time
Schedule = float | tuple[Numbers, Numbers] | Callable[[float], float]
Acting = Schedule | Feedback


class Switch(NamedTuple):
    """A change of regime: when, and what follows."""

    t: float
    regime: str


@dataclass(frozen=True, repr=False)
class Motion(Shown):
    """One motion of the cylinder; everything dimensionless.

    Attributes
    ----------
    t, V, omega : output times and speeds.
    x, angle : distance travelled over R, and angle turned in radians, both 0 at t = 0.
    delta : creep ratio (infinite where V = 0 while sliding).
    regime : 0 full slip, 1 partial slip, 2 rest, 3 locked by a brake (omega = 0, V not), 4 held by a brake, or by a
        prescribed speed of 0 (both 0); see ``REGIMES``.
    switches : every change of regime, located to rounding; under a drive to a small part of ``rtol``.
    reversals : times at which V changes its sign under a drive.
    force, torque : over P and P R: what acted, or what a prescribed speed needed; without the brake.
    work_force, work_torque : work of either since t = 0, over m (R/T_epsilon)^2.
    brake_loss, slip_loss, rolling_loss : energy lost since t = 0 in brake, slip and rolling, likewise.  The works
        are the change of (V^2 + j omega^2)/2 plus the three losses.
    drive_error : the largest difference seen between a callable and the polynomials it was fitted by.
    onset_time : first change from full to partial slip; NaN if there is none.
    rest_time : when max(|V|, |omega|) fell below ``rest``; NaN if it did not.
    status, message : how the motion ended; outputs it did not reach are NaN.
    steps : integration steps taken, rejected ones included.
    """

    scene: Scene
    t: NDArray[np.float64]
    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    x: NDArray[np.float64]
    angle: NDArray[np.float64]
    delta: NDArray[np.float64]
    regime: NDArray[np.int8]
    switches: tuple[Switch, ...]
    onset_time: float
    rest_time: float
    status: MotionStatus
    steps: int
    reversals: NDArray[np.float64]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    work_force: NDArray[np.float64]
    work_torque: NDArray[np.float64]
    brake_loss: NDArray[np.float64]
    drive_error: float
    _inputs: Inputs = field(repr=False)
    _losses: NDArray[np.float64] | None = field(repr=False)

    @property
    def slip_loss(self) -> NDArray[np.float64]:
        """Energy lost in slip since t = 0, over m (R/T_epsilon)^2."""
        return self._lost[0]

    @property
    def rolling_loss(self) -> NDArray[np.float64]:
        """Energy lost in rolling since t = 0, over m (R/T_epsilon)^2."""
        return self._lost[1]

    @cached_property
    def _lost(self) -> NDArray[np.float64]:
        """Losses in slip and in rolling; those of a free motion are found when they are asked for."""
        if self._losses is not None:
            return self._losses
        from .batch import ensemble

        given = self._inputs
        found = ensemble(
            given.scene, given.V0, given.omega0, self.t, method="integrate", rtol=given.rtol, rest=given.rest or None,
            max_steps=given.max_steps, fields=LOSSES,
        )  # fmt: skip
        return np.stack([getattr(found, name)[0] for name in LOSSES])

    @property
    def drive(self) -> Drive:
        """What was given to drive it."""
        return self._inputs.drive

    @property
    def message(self) -> str:
        """The status in words."""
        return MOTION_STATUS[self.status]

    def contact(self, fields: Iterable[str] | None = None, **options: Any) -> Values:
        """Contact state (:func:`viscoroll.contact`) along the motion.

        At rest, and where V passes through zero while sliding, the limits V -> 0 stand.  At times that the
        motion did not reach everything is NaN, and ``full_slip`` False.

        Parameters
        ----------
        fields, **options : as for :func:`viscoroll.contact`.

        Returns
        -------
        Values
            Each field over t.  The law is exact to rounding: errors are those of V and delta, which beta
            and Q magnify near full slip (``tests/motion/test_motion.py``).

        Raises
        ------
        ParameterError
            Unknown fields or options out of range.
        """
        reached = self.regime >= 0
        V, delta = self.V[reached], self.delta[reached]
        delta = np.where(np.isfinite(delta), delta, np.copysign(1e300, delta))
        V = np.where((V == 0.0) & np.signbit(V), -SPEED_RANGE[0], V)  # -0: the limit from there
        found = contact(self.scene, V, delta=delta, fields=fields, **options)
        whole = {name: _with_gaps(values, reached) for name, values in found.as_dict().items()}
        return Values(whole, {"t": self.t}, title="Contact along a motion")

    def validity(self) -> Validity:
        """Which assumptions of the model the motion strains, at each output time that it reached.

        See :meth:`Scene.validity`; ``creep`` is that of the motion, ``steady`` takes in all speeds from 0 to V.
        """
        reached = self.regime >= 0
        return self.scene.validity(self.V[reached], omega=self.omega[reached])

    def _card(self) -> tuple[str, list[Row]]:
        return card_of(self, attributes)

    def at(self, t: ArrayLike) -> Motion:
        """The same motion at other times within [0, end]; by the continuous output of the methods.

        Parameters
        ----------
        t : times, ascending.

        Returns
        -------
        Motion
            As exact between the steps as at their ends (``tests/motion/test_motion.py``).

        Raises
        ------
        ParameterError
            Times that are not ascending or lie beyond the end of the motion.
        """
        times = output_times(t)
        end = self._inputs.end
        if times[-1] > end:
            raise ParameterError("t", times[-1], f"within the motion, [0, {end:.6g}]")
        return _integrate(self._inputs, times)

    def to_xarray(self) -> xr.Dataset:
        """Dataset over t with V, omega, x, angle, delta, regime and the scene as attributes."""
        from .export import motion_dataset

        return motion_dataset(self)


def card_of(motion: Any, described: Callable[[str], dict[str, Any]]) -> tuple[str, list[Row]]:
    """What a motion says of itself, in either units; ``described``: attributes of a quantity."""

    def unit(name: str) -> str:
        return unit_of(described(name))

    rows = [Row("t", f"{motion.t.size} times to {motion.t[-1]:.6g}", unit("t"))]
    for name in ("V", "omega", "x"):
        values = getattr(motion, name)
        rows.append(Row(name, f"{values[0]:.6g} to {values[-1]:.6g}", unit(name)))
    for name, given in motion.drive.given.items():
        rows.append(Row(name, "a function of t" if callable(given) else f"{given!s:.60}", unit(name)))
    if not np.isnan(motion.onset_time):
        rows.append(Row("onset of partial slip", f"t = {motion.onset_time:.6g}", unit("t")))
    if motion.switches:
        last = motion.switches[-1]
        rows.append(Row("changes of regime", f"{len(motion.switches)}, the last to {last.regime} at t = {last.t:.6g}"))
    if motion.reversals.size:
        rows.append(Row("reversals of V", str(motion.reversals.size)))
    return "Motion", [*rows, Row("ended", f"{motion.message} ({motion.steps} steps)")]


def _with_gaps(values: NDArray, reached: NDArray[np.bool_]) -> NDArray:
    """``values`` where ``reached``, and between them NaN, or False among booleans."""
    whole = np.full(reached.shape, False if values.dtype == bool else np.nan)
    whole[reached] = values
    return whole


def roll(
    scene: Scene,
    V0: float | None,
    omega0: float | None,
    t: Numbers,
    rtol: float = 1e-8,
    *,
    force: Acting = 0.0,
    torque: Acting = 0.0,
    slope: float | None = None,
    brake: Schedule | None = None,
    omega: Schedule | None = None,
    V: Schedule | None = None,
    rest: float | None = None,
    max_steps: int = 100_000,
) -> Motion:
    """Motion of the cylinder from (V0, omega0), Eq. (22), through all regimes.

    Parameters
    ----------
    scene : one scene (no arrays).
    V0, omega0 : start speeds, any sign; the larger of the two 0, or in [1e-300, 1e100] in size.
    t : output times, ascending, or one end time: then output falls on the steps taken.
    rtol : tolerance in [1e-12, 1e-2]; the global relative error of x and the switch times is
        proportional to it, that of V and omega too, times t |V'|/|V|, by which a late
        speed magnifies any earlier error: mostly below rtol, at most 30 rtol on the scenes
        of ``tests/motion/test_motion.py``; rare motions elsewhere may exceed that a little.
    force, torque : over P along V, and over P R along omega, what pushes the axis and turns the cylinder:

        - a number;
        - (times, values): linear between, constant outside, a time given twice is a jump;
        - a callable of t, smooth, fitted by polynomials to a tenth of ``rtol`` (``drive_error`` says how well);
        - ``vr.Feedback(value, V=gain, omega=gain)``: any of these and more with the speeds.
    slope : angle in radians, > 0 pushes along +V: tan(slope) is added to ``force``.  The load is P cos(slope) then,
        over which force, torque, Q and M are; ``scene`` of the result has kappa and gamma of that load.
    brake : the most torque over P R that a brake takes, >= 0, as for ``force``.  It acts against omega, and holds
        omega = 0 while |Q + M_cylinder - torque| is no more.
    omega : prescribed speed of the motor, in place of ``torque``; ``omega0`` is None or what it starts at.
    V : prescribed speed of the axis, in place of ``force``; ``V0`` likewise.  A prescribed speed must not jump.
    rest : end the motion where max(|V|, |omega|) falls below this; not while something drives to the end.
        Nothing stops in
        finite time: at small V the speed decays like exp(-gamma c t/(1 + j)) with
        c = (alpha - 1)/alpha, and an elastic cylinder (alpha = 1) rolls for ever.  From
        there on V = omega = 0 and x, angle stay; the distance so left out is close to
        (1 + j) V/(gamma c).
    max_steps : step limit, at most 10^7.

    Returns
    -------
    Motion

    Raises
    ------
    ParameterError
        NaN, infinite or oversized input, unsorted times, an array where one number belongs; both speeds prescribed,
        a prescribed speed that jumps or does not match its start, a callable that jumps.

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
    >>> start = vr.roll(scene, 0.0, 0.0, 4.0, torque=([0.0, 1.0, 1.0], [0.0, 0.2, 0.0]))
    >>> stop = vr.roll(scene, 0.5, 0.5, 10.0, brake=0.1)

    Warns
    -----
    RuntimeWarning
        Where the motion could not be rolled to the end; ``status`` and ``message`` say why.
    """
    checked_scene(scene, "roll", moves=True)
    times = output_times(t)
    drive = Drive(force, torque, slope, brake, omega, V)
    look(scene, V0, omega0)
    given = [0.0 if value is None else value for value in (V0, omega0)] if drive.prescribes else [V0, omega0]
    speeds = start_speeds(*given)
    tilt = np.asarray(0.0 if slope is None else slope)
    for name, value in (("scene", scene), ("V0", speeds[0]), ("omega0", speeds[1]), ("slope", tilt)):
        if value.shape != ():
            raise ParameterError(name, f"array of shape {value.shape}", "one motion's; for many use ensemble")
    rtol, threshold, max_steps = controls(rtol, rest, max_steps)
    V0, omega0 = (None if value is None else float(value) for value in (V0, omega0))
    inputs = Inputs(scene, V0, omega0, float(times[-1]), rtol, threshold, max_steps, drive)
    if np.ndim(t) == 0:
        times = _step_times(inputs)
    motion = _integrate(inputs, times)
    if motion.status > MotionStatus.RESTED:
        warnings.warn(f"roll: {motion.message}; outputs not reached are NaN", RuntimeWarning, stacklevel=2)
    return motion


def _step_times(inputs: Inputs) -> NDArray:
    """0, the ends of the steps and places between them, and the end time."""
    ends, end = np.empty(0), inputs.end
    while ends.size < inputs.max_steps and not np.isnan(ends).any():  # full: there may be more
        ends = np.full(min(max(4 * ends.size, _STEPS), inputs.max_steps), np.nan)
        rolled(inputs, np.array([end]), (_NO_SWITCHES, ends))
    return np.unique(np.concatenate(([0.0], ends[ends < end], [end])))


def _integrate(inputs: Inputs, times: NDArray) -> Motion:
    asked = times if times[-1] == inputs.end else np.append(times, inputs.end)
    switches = np.full((_SWITCHES_KEPT, 2), np.nan)
    scene, error, out, (status, steps, _, onset_time, rest_time) = rolled(inputs, asked, (switches, np.empty(0)))
    rows = dict(zip(ROWS, out[:, : times.size], strict=True))
    losses = np.stack([rows.pop(name) for name in LOSSES])
    whole = rows.pop("regime")
    regime = np.where(np.isnan(whole), -1, whole).astype(np.int8)
    noted = switches[~np.isnan(switches[:, 1])]
    changes = tuple(Switch(float(when), REGIMES[int(what)]) for when, what in noted if what >= 0.0)
    return Motion(
        scene, times, **rows, regime=regime, switches=changes, onset_time=onset_time, rest_time=rest_time,
        status=MotionStatus(int(status)), steps=int(steps), reversals=noted[noted[:, 1] < 0.0, 0],
        drive_error=error, _inputs=inputs, _losses=None if np.isnan(losses).all() else losses,
    )  # fmt: skip
