"""One motion: :func:`roll`, and its result, :class:`Motion`."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any

import numpy as np

from ..contact_mechanics import (
    Roller,
    Validity,
    assess_heat,
    contact,
    scale_of,
    validity,
    warn_of_speeds,
)
from ..core import (
    ArrayLike,
    Dataset,
    Feedback,
    Figure,
    Floats,
    MotionStatus,
    Numbers,
    ParameterError,
    Schedule,
    SummaryRow,
    Values,
    check_number,
    described_error,
    digits_beside,
)
from .motion_arguments import ROWS, SPEED_RANGE, Drive, output_times, strip_units
from .motion_datasets import RollResult, Switch, describe_load, describe_values, motion_dataset
from .motion_problem import NO_NOTES, MotionProblem, SolverOptions, integrate_single, make_problem

#: Changes of regime that are kept.
_SWITCHES_KEPT = 1000
#: Times of a figure, beside the ends of steps: lines between them are straight.
_DRAWN = 201
#: Steps, beside twice those of the motion, for which the ends are kept and which a repeated
#: integration may take.
_MORE_STEPS = 1000
#: Names of the regimes by their codes.
REGIMES = ("full slip", "partial slip", "rest", "locked", "held")


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Motion(RollResult):
    """One motion, in the units of its roller: dimensionless for a scene, for a cylinder SI units
    per m of length.

    Attributes
    ----------
    roller : the :class:`Scene` or :class:`Cylinder`, on its slope.
    drive : loads and prescribed speeds as they were given.
    t, V, omega : output times and speeds; s, m/s, rad/s.
    x, angle : distance travelled, divided by R or in m, and angle turned in radians, both 0 at t =
        0.
    delta : creepage (infinite where V = 0 while sliding).
    regime : 0 full slip, 1 partial slip, 2 rest, 3 locked by a brake (omega = 0, V not), 4 held by
        a brake, or by a prescribed speed of 0 (both 0); see ``REGIMES``.  Without ``rest`` nothing
        stops: a driven motion counts as at rest where V has decayed below the smallest double.
    switches : changes of regime, a tuple of (t, regime), located to rounding; under a drive to a
        small part of ``rtol``.  Only the first 1000 changes and reversals, counted together, are
        kept.
    reversals : times at which V changes its sign, (reversals,).
    force, torque : divided by P and P R, or N/m and N m/m: the loads with the pull of a slope, or
        the loads that a prescribed speed required; without the brake.
    work_force, work_torque : work of either since t = 0, divided by m (R/T_ref)^2 or in J/m.
    brake_loss, slip_loss, rolling_loss : energy lost since t = 0 in brake, slip and rolling,
        likewise.  The works are the change of (V^2 + j omega^2)/2 plus the three losses.
    power_force, power_torque : force V and torque omega, divided by P R/T_ref or in W/m.
    drive_error : largest difference seen of a callable from its fitted polynomials, dimensionless.
    onset_time : time of the first change from full to partial slip; NaN if there is none.
    rest_time : when max(|V|, R |omega|) fell below ``rest``; NaN if it did not.
    success, status, message : whether the motion reached its last output time or rest; how it
        ended, a :class:`MotionStatus`; the same in words, with the last state of a motion that was
        given up.  Outputs that it did not reach are NaN.
    steps : integration steps taken, rejected ones included.

    Examples
    --------
    >>> import viscoroll as vr
    >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
    >>> motion.success, motion.V.shape
    (True, (2,))
    """

    reversals: Floats
    _problem: MotionProblem

    @property
    def message(self) -> str:
        """How the motion ended, in words.

        For one that was given up, but not one that stays in the indentation of a standstill, also
        the state that it had reached, for which it is integrated anew.
        """
        text: str = self.status.message
        if self.success or self.status == MotionStatus.CAUGHT:
            return text
        last = self._last_reached
        t, V, omega = (
            f"{x} = {float(last[x][0]):.6g} {self._unit(x)}".rstrip() for x in ("t", "V", "omega")
        )
        return f"{text}; the last state was {t} (regime {REGIMES[last.regime[0]]}), {V}, {omega}"

    @cached_property
    def _step_ends(self) -> Floats:
        """Ends of the accepted integration steps, ascending, in T_ref, the dimensionless unit of
        time, (accepted steps,).

        The motion is integrated anew for them, with its last output time alone.  Empty for one that
        stays in the indentation of a standstill.
        """
        ends = np.full(2 * self.steps + _MORE_STEPS, np.nan)
        integrate_single(self._problem, np.array([self._problem.end]), NO_NOTES[0], ends)
        return ends[~np.isnan(ends)]

    @cached_property
    def _last_reached(self) -> Motion:
        """Return the motion at the end of its last step alone, for one that was given up before its
        last output time.

        It is integrated anew to that time.  If the last step, which is cut there, is given up
        before it, the last output time that was reached or the end of an earlier step is taken.

        Returns a :class:`Motion` with one output time, (1,), at which its speeds are finite; at t =
        0 if no step was accepted.
        """
        reached_times = self.t[self.regime >= 0] / self.scale["t"]
        times = np.union1d(np.append(self._step_ends, 0.0), reached_times)
        # A last step that is cut at this end may take more steps than one that was not.
        limits = (*self._problem.limits[:2], 2 * self.steps + _MORE_STEPS)
        for reached in times[::-1].tolist():
            last = integrate_motion(
                self._problem._replace(end=reached, limits=limits),
                np.array([reached * self.scale["t"]]),
            )
            if np.isfinite(last.V[0]):
                break
        return last

    @property
    def power_force(self) -> Floats:
        """Power of the force."""
        return self.force * self.V

    @property
    def power_torque(self) -> Floats:
        """Power of the torque."""
        return self.torque * self.omega

    def contact(self, fields: Iterable[str] | None = None, **options: Any) -> Values:
        """Return the contact state (:func:`viscoroll.contact`) along the motion.

        At rest, and where V passes through zero while sliding, the fields have their limits for
        V -> 0; where V is -0 that from below.  At times that the motion did not reach all numbers
        are NaN, and ``full_slip`` is False.

        Parameters
        ----------
        fields : names of fields of the contact state; None: the default of
            :func:`viscoroll.contact`.
        **options : its other keywords, apart from creepage and angular velocity, which are those of
            the motion.

        Returns
        -------
        Values
            Each field over t, (times,), in the units of the roller.  The law is exact to rounding:
            errors are those of V and delta, which beta and Q magnify near full slip
            (``tests/motion/test_motion.py``).

        Raises
        ------
        ParameterError
            Unknown fields or options out of range; ``omega`` as an option.
        TypeError
            An option that :func:`viscoroll.contact` does not have, or ``delta``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
        >>> motion.contact(["Q", "beta"]).beta.shape
        (2,)
        """
        reached = self.regime >= 0
        V = self.V[reached]
        # a finite creepage far beyond every onset of full slip, as contact() refuses infinity
        delta = np.clip(self.delta[reached], -1e300, 1e300)
        # -0: the limit from below
        V = np.where((V == 0.0) & np.signbit(V), -SPEED_RANGE[0] * self.scale["V"], V)
        found = contact(self.roller, V, delta=delta, fields=fields, **options)
        at_all_times = {}
        for name, values in found.as_dict().items():
            at_all_times[name] = np.full(reached.shape, False if values.dtype == bool else np.nan)
            at_all_times[name][reached] = values
        return Values(at_all_times, {"t": self.t}, si=self.scale.si, title="Contact along a motion")

    def validity(self, capacity: float | None = None) -> Validity:
        """Report which assumptions of the model the motion violates, at the ends of its steps and
        at its output times.

        See :func:`viscoroll.validity`; ``creep`` is that of the motion, and ``steady`` examines its
        speeds so far, but is undecided on a cover.  States at rest count as the last state before
        them, as the model has nothing to compute at rest.

        Parameters
        ----------
        capacity : heat that a body stores per kelvin, J/(m K), > 0, of a Cylinder; default: the
            heat of the motion is not examined.

        Returns
        -------
        Validity
            The report, with arrays over the output times that were reached; empty arrays where none
            was.  Each entry has, for the interval since the previous output time (for the first
            one, since t = 0), the value at its first violation or, if there is none, at its end;
            ``steady`` instead has the largest value since t = 0.  Which assumptions fail depends
            little on the output times (``tests/test_steadiness.py``).

        Raises
        ------
        ParameterError
            A capacity that is not one number > 0, or that is given for a Scene.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
        >>> motion.validity().steady.holds.shape
        (2,)
        """
        reached_times = self.t[self.regime >= 0]
        states = self.at(np.union1d(self.course.t, reached_times)) if reached_times.size else self
        reached = states.regime >= 0
        V = states.V[reached]
        omega = states.omega[reached]
        # for each state the index of the last state up to it that moves
        moving = np.maximum.accumulate(np.where((V != 0.0) | (omega != 0.0), np.arange(V.size), 0))
        report = validity(self.roller, V[moving], omega=omega[moving])
        if capacity is not None:
            if not self.scale.si:
                raise described_error(
                    "capacity", "is given for a Scene", "left out, as a Scene has no temperature"
                )
            capacity = check_number("capacity", capacity, unit=self.scale, above=0.0)
            report = report._replace(
                heat=assess_heat((states.slip_loss + states.rolling_loss)[reached], capacity)
            )
        if not reached_times.size:
            return report
        if self.scene.cover is None:
            not_full_slip = states.regime[reached] > 0  # regime 0 is full slip
            report = self._add_steadiness(
                report, self.roller, V, not_full_slip, states.x[reached], ends=False
            )
        # each output time ends a part of the states, and an entry gets one value for each part;
        # entries that no speed decides have one value
        last = np.searchsorted(states.t[reached], reached_times)
        return Validity(
            *(entry.worst_of_parts(last) if np.ndim(entry.holds) else entry for entry in report)
        )

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report, a list of :class:`SummaryRow`.

        The rows are: output times; V, omega and x; the drive as it was given; the onset of partial
        slip, if there is one; number of changes of regime and of reversals of V, if there are any,
        and the last change; how the motion ended.
        """
        rows = [self._row_of_times()]
        rows += [
            SummaryRow(name, describe_values(self.t, self[name], self._unit("t")), self._unit(name))
            for name in ("V", "omega", "x")
        ]
        for name, given in self.drive.given.items():
            # V and omega have rows of their own above
            title = f"prescribed {name}" if name in ("V", "omega") else name
            rows.append(SummaryRow(title, describe_load(given, self._unit(name))))
        if not np.isnan(self.onset_time):
            rows.append(
                SummaryRow("onset of partial slip", f"t = {self.onset_time:.6g}", self._unit("t"))
            )
        if self.switches:
            last = self.switches[-1]
            when = f"t = {last.t:.6g} {self._unit('t')}".rstrip()
            changes = f"{len(self.switches)}, the last to {last.regime} at {when}"
            if last.regime == "rest" and np.isnan(self.rest_time):
                changes += ": V fell below the smallest number of double precision"
            rows.append(SummaryRow("changes of regime", changes))
        if self.reversals.size:
            rows.append(SummaryRow("reversals of V", str(self.reversals.size)))
        steps = f"{self.steps} step{'s' * (self.steps != 1)}"
        return "Motion", [*rows, SummaryRow("ended", f"{self.message} ({steps})")]

    def at(self, t: ArrayLike) -> Motion:
        """Return the same motion at other times within [0, end], by the dense output of the steps.

        Parameters
        ----------
        t : times, a number or (times,), ascending, in the unit of the motion's own times.

        Returns
        -------
        Motion
            With these output times; it is integrated anew.  As accurate between the steps as at
            their ends (``tests/motion/test_motion.py``).  NaN at times that a motion which was
            given up did not reach.

        Raises
        ------
        ParameterError
            No times, times of several axes, in a unit of another dimension, negative, not finite or
            not ascending, or that lie beyond the end of the motion.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, 2.0)
        >>> motion.at([0.5, 1.5]).V.shape
        (2,)
        """
        times = output_times(t, self.scale)
        end = self._problem.end * self.scale["t"]
        if times[-1] > end and float(times[-1]) / self.scale["t"] > self._problem.end:
            within = f"within the motion, [0, {digits_beside(end, times[-1])}] {self._unit('t')}"
            raise ParameterError("t", times[-1], within.rstrip())
        return integrate_motion(self._problem, times)

    @cached_property
    def course(self) -> Motion:
        """The same motion at 0, at the ends of its steps and at the last output time, each time
        once, ascending.

        One that was given up before is NaN there, and at the end of its last step, where outputs
        are written by the step after it.
        """
        ends = self._step_ends
        end = self._problem.end
        return self.at(np.union1d(ends[ends < end], [0.0, end]) * self.scale["t"])

    def _figure(self) -> Figure:
        """Return the figure of the motion at its output times; where only one was requested, at the
        ends of its steps and at 201 times evenly spread over the whole motion, for which it is
        integrated anew.
        """
        if self.t.size > 1:
            return RollResult._figure(self)
        t = self.course.t
        return RollResult._figure(self.at(np.union1d(t, np.linspace(0.0, t[-1], _DRAWN))))

    def to_xarray(self) -> Dataset:
        """Return the dataset over t with V, omega, x, angle, delta and regime, and the scene as
        attributes.

        Returns
        -------
        xarray.Dataset
            In the units of the roller; regime is int8, -1 where it was not reached.  The dataset of
            a motion with a drive also has force, torque, work_force, work_torque, brake_loss,
            slip_loss and rolling_loss over t, what was given as ``drive_force`` and so on (of a
            function of time a text among the attributes), and ``reversals``, the times at which V
            changes its sign.  Attributes are those of :func:`.motion_datasets.motion_dataset`.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
        >>> motion.to_xarray()["V"].attrs["units"]
        'm s-1'
        """
        return motion_dataset(self)


def integrate_motion(problem: MotionProblem, times: Floats) -> Motion:
    """Integrate one motion.

    problem: :class:`MotionProblem` of one motion, which the result keeps, to be integrated anew at
    other times.
    times: output times, (times,), at least one, ascending, in the unit of its roller; a time beyond
    the end of the motion counts as its end.  The motion is integrated to its end in any case, so
    that steps and status do not depend on them.
    Returns the :class:`Motion`, in the units of its roller; where it did not reach an output time,
    quantities are NaN and ``regime`` is -1.  It keeps the first 1000 changes of regime and
    reversals of V, counted together.  The status of a motion that stays in the indentation of a
    standstill is CAUGHT, and it reaches no output time.
    """
    scale = problem.roller.scale
    end = problem.end
    T = scale["t"]
    t = np.minimum(times / T, end)
    if t[-1] != end:
        t = np.append(t, end)
    noted = np.full((_SWITCHES_KEPT, 2), np.nan)
    out, (status, steps, _, onset_time, rest_time) = integrate_single(
        problem, t, noted, NO_NOTES[1]
    )
    rows = dict(zip(ROWS, out[:, : times.size], strict=True))
    codes = rows.pop("regime")
    if scale.si:
        rows = {name: row * scale[name] for name, row in rows.items()}
    codes[np.isnan(codes)] = -1.0
    # rows (time, new regime), or (time, -1) for a reversal of V; NaN where fewer were noted
    noted = noted[~np.isnan(noted[:, 1])]
    switches = tuple(
        Switch(float(when) * T, REGIMES[int(code)]) for when, code in noted if code >= 0.0
    )
    return Motion(
        problem.roller,
        problem.drive,
        times,
        **rows,
        regime=codes.astype(np.int8),
        switches=switches,
        onset_time=onset_time * T,
        rest_time=rest_time * T,
        status=MotionStatus(int(status)),
        steps=int(steps),
        reversals=noted[noted[:, 1] < 0.0, 0] * T,
        drive_error=problem.functions.error,
        _problem=problem,
    )


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
        late speed magnifies any earlier error.  Errors are mostly below rtol, at most 30 rtol for
        the scenes of ``tests/motion/test_motion.py``; rare motions may exceed that a little.
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
        R |omega|) falls below this once no force, torque, slope, brake, drag or prescribed speed
        acts any more; refused where one of these acts to the end.  In partial slip a usual roller
        (mu <= 2 kappa) does not stop in finite time: at small V the speed decays like
        exp(-gamma c t/(1 + j)) with c = (alpha - 1)/alpha, and an elastic cylinder (alpha = 1)
        rolls for ever.  Below this speed V = omega = 0 is taken, and x and angle stay; the omitted
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
        that polynomials do not follow; ``rest`` where a load acts to the end; ``unsteady``
        with bodies that differ or with a cover; ``rested`` below 0, with a prescribed speed, with a
        cover, or at a start in full slip or from V0 = omega0 = 0; a scene without gamma, a layer
        too thin for its law; a unit of another dimension.
    Exception
        What a callable raises.

    Notes
    -----
    Under a drive, and with bodies that differ, the errors of V and omega are at most 30 ``rtol`` of
    the largest speed so far, mostly below 3 (``tests/test_claims.py``); near a saddle
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
    start, drive, _ = strip_units(
        (V0, omega0),
        Drive(force=force, torque=torque, slope=slope, brake=brake, drag=drag, omega=omega, V=V),
        units,
    )
    problem = make_problem(
        roller,
        start,
        drive,
        times[-1],
        SolverOptions(
            rtol=rtol,
            rest=rest,
            max_steps=max_steps,
            resolve=resolve,
            unsteady=unsteady,
            rested=rested,
        ),
        single=True,
    )
    problem.warn_of_start(start)
    motion = integrate_motion(problem, times)
    warn_of_speeds(problem.roller, start[0], motion.V)
    if not motion.success:
        warnings.warn(
            f"roll: {motion.status.message}.  Outputs at later times are NaN; the last state, "
            "if any, is in the attribute message of the motion",
            RuntimeWarning,
            stacklevel=2,
        )
    return motion
