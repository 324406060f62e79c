"""One motion as it is given back: :class:`Motion`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact_law.assumptions import Validity
from ..contact_law.contact import contact
from ..contact_law.judged import validity
from ..contact_law.steadiness import Steadiness
from ..core.array_types import Floats
from ..core.errors import MotionStatus, ParameterError
from ..core.results import SummaryRow, Values
from .checks import SPEED_RANGE, output_times
from .driven import ROWS
from .result import Rolled
from .rolling import NO_NOTES, Begun, rolled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: changes of regime that are kept
_SWITCHES_KEPT = 1000
#: times of a figure, beside the ends of steps, between which lines are straight
_DRAWN = 201
#: room for the ends of steps at first
_STEPS = 1000
REGIMES = ("full slip", "partial slip", "rest", "locked", "held")


class Switch(NamedTuple):
    """A change of regime: when, and what follows."""

    t: float
    regime: str


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Rolled):
    """One motion, in the units of what rolled: of a scene without dimension, of a cylinder in SI units per m of length.

    Attributes
    ----------
    roller : what rolled, on its slope: the :class:`Scene` or :class:`Cylinder`.
    drive : what was given to drive it.
    t, V, omega : output times and speeds; s, m/s, rad/s.
    x, angle : distance travelled, over R or in m, and angle turned in radians, both 0 at t = 0.
    delta : creep ratio (infinite where V = 0 while sliding).
    regime : 0 full slip, 1 partial slip, 2 rest, 3 locked by a brake (omega = 0, V not), 4 held by a brake, or by a
        prescribed speed of 0 (both 0); see ``REGIMES``.  Without ``rest`` nothing stops: a driven motion is told to be
        at rest where V has decayed to less than doubles hold.
    switches : every change of regime, located to rounding; under a drive to a small part of ``rtol``.
    reversals : times at which V changes its sign under a drive.
    force, torque : over P and P R, or N/m and N m/m: what acted, the pull of a slope with it, or what a prescribed
        speed needed; without the brake.
    work_force, work_torque : work of either since t = 0, over m (R/T_epsilon)^2 or in J/m.
    brake_loss, slip_loss, rolling_loss : energy lost since t = 0 in brake, slip and rolling, likewise.  The works
        are the change of (V^2 + j omega^2)/2 plus the three losses.
    power_force, power_torque : force V and torque omega, over P R/T_epsilon or in W/m.
    drive_error : the largest difference seen between a callable and the polynomials it was fitted by, dimensionless.
    onset_time : first change from full to partial slip; NaN if there is none.
    rest_time : when max(|V|, R |omega|) fell below ``rest``; NaN if it did not.
    success, status, message : whether the motion came to its end, and how it ended, and where it stood if that was not
        its end; outputs it did not reach are NaN.
    steps : integration steps taken, rejected ones included.
    """

    reversals: Floats
    _begun: Begun = field(repr=False)

    @property
    def message(self) -> str:
        """The status in words; of a motion that was given up also where it stood."""
        words = self.status.message
        if self.success or self.status == MotionStatus.CAUGHT:
            return words
        stood = self._stood
        at = (f"{name} = {float(stood[name][0]):.6g} {self._unit(name)}".rstrip() for name in ("t", "V", "omega"))
        t, V, omega = at
        return f"{words}; it stood at {t} in {REGIMES[stood.regime[0]]}, {V}, {omega}"

    @cached_property
    def _stood(self) -> Motion:
        """The motion up to where it was given up."""
        ends = np.full(self.steps + 1, np.nan)
        rolled(self._begun, np.array([self._begun.end]), NO_NOTES[0], ends)
        reached = float(np.nanmax(np.append(ends, 0.0)))
        # a last panel that is cut at this end may take more steps than one that was not
        limits = (*self._begun.limits[:2], 2 * self.steps + _STEPS)
        return integrated(self._begun._replace(end=reached, limits=limits), np.array([reached * self.scale["t"]]))

    @property
    def power_force(self) -> Floats:
        """Power of the force."""
        return self.force * self.V

    @property
    def power_torque(self) -> Floats:
        """Power of the torque."""
        return self.torque * self.omega

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
        slowest = -SPEED_RANGE[0] * self.scale["V"]
        V = np.where((V == 0.0) & np.signbit(V), slowest, V)  # -0: the limit from there
        found = contact(self.roller, V, delta=delta, fields=fields, **options)
        whole = {}
        for name, values in found.as_dict().items():
            whole[name] = np.full(reached.shape, False if values.dtype == bool else np.nan)
            whole[name][reached] = values
        return Values(whole, {"t": self.t}, si=self.scale.si, title="Contact along a motion")

    def validity(self) -> Validity:
        """Which assumptions of the model the motion strains, at each output time that it reached.

        See :func:`viscoroll.validity`; ``creep`` is that of the motion, and ``steady`` looks at its speeds so far.
        """
        reached = self.regime >= 0
        V = self.V[reached]
        found = validity(self.roller, V, omega=self.omega[reached])
        if not reached.any() or self.scene.cover is not None:
            return found
        free, rolls = self.scene.freely(V / self.scale["V"]).scaled(self.scale), self.regime[reached] > 0
        return found._replace(steady=Steadiness.along(free, rolls, self.x[reached], ends=False))

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        rows = [self._times()]
        rows += [SummaryRow(name, _course(self.t, self[name]), self._unit(name)) for name in ("V", "omega", "x")]
        for name, given in self.drive.given.items():
            called = f"prescribed {name}" if name in ("V", "omega") else name  # which have a row of their own above
            rows.append(
                SummaryRow(called, "a function of t" if callable(given) else f"{given!s:.60}", self._unit(name))
            )
        if not np.isnan(self.onset_time):
            rows.append(SummaryRow("onset of partial slip", f"t = {self.onset_time:.6g}", self._unit("t")))
        if self.switches:
            last = self.switches[-1]
            died = ": V fell to 0 in double precision" if last.regime == "rest" and np.isnan(self.rest_time) else ""
            when = f"t = {last.t:.6g} {self._unit('t')}".rstrip()
            rows.append(
                SummaryRow("changes of regime", f"{len(self.switches)}, the last to {last.regime} at {when}{died}")
            )
        if self.reversals.size:
            rows.append(SummaryRow("reversals of V", str(self.reversals.size)))
        return "Motion", [*rows, SummaryRow("ended", f"{self.message} ({self.steps} step{'s' * (self.steps != 1)})")]

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
        times = output_times(t, self.scale)
        end = self._begun.end * self.scale["t"]
        if times[-1] > end and float(times[-1]) / self.scale["t"] > self._begun.end:
            raise ParameterError("t", times[-1], f"within the motion, [0, {end:.6g}]")
        return integrated(self._begun, times)

    @cached_property
    def course(self) -> Motion:
        """The same motion at 0, at the ends of its steps, at places between them, and at its end."""
        ends, end, most = np.empty(0), self._begun.end, self._begun.limits[2]
        while ends.size < most and not np.isnan(ends).any():  # full: there may be more
            ends = np.full(min(max(4 * ends.size, _STEPS), most), np.nan)
            rolled(self._begun, np.array([end]), NO_NOTES[0], ends)
        return self.at(np.unique(np.concatenate(([0.0], ends[ends < end], [end]))) * self.scale["t"])

    def _figure(self) -> Figure:
        """All of it where it was asked for at one time."""
        if self.t.size > 1:
            return Rolled._figure(self)
        t = self.course.t
        return Rolled._figure(self.at(np.union1d(t, np.linspace(0.0, t[-1], _DRAWN))))

    def to_xarray(self) -> xr.Dataset:
        """Dataset over t with V, omega, x, angle, delta, regime and the scene as attributes."""
        from .export import motion_dataset

        return motion_dataset(self)


def integrated(begun: Begun, times: Floats) -> Motion:
    """The motion at ``times``, up to its end, in the units of what rolled."""
    scale, end = begun.roller.scale, begun.end
    T, at = scale["t"], np.minimum(times / scale["t"], end)
    asked = at if at[-1] == end else np.append(at, end)
    switches = np.empty((_SWITCHES_KEPT, 2))
    switches.fill(np.nan)
    out, (status, steps, _, onset_time, rest_time) = rolled(begun, asked, switches, NO_NOTES[1])
    rows = dict(zip(ROWS, out[:, : times.size], strict=True))
    whole = rows.pop("regime")
    if scale.si:
        rows = {name: row * scale[name] for name, row in rows.items()}
    regime = np.where(np.isnan(whole), -1, whole).astype(np.int8)
    noted = switches[~np.isnan(switches[:, 1])]
    changes = tuple(Switch(float(when) * T, REGIMES[int(what)]) for when, what in noted if what >= 0.0)
    return Motion(
        begun.roller, begun.drive, times, **rows, regime=regime, switches=changes, onset_time=onset_time * T,
        rest_time=rest_time * T, status=MotionStatus(int(status)), steps=int(steps),
        reversals=noted[noted[:, 1] < 0.0, 0] * T, drive_error=begun.ready.error, _begun=begun,
    )  # fmt: skip


def _course(t: NDArray, values: NDArray) -> str:
    """The first and the last value that was reached, and one between them that is larger in size with its time."""
    if np.isnan(values).all():
        return "not reached"
    reached, at = values[~np.isnan(values)], int(np.nanargmax(np.abs(values)))
    first, most, last = (f"{value:.6g}" for value in (reached[0], values[at], reached[-1]))
    if t.size == 1:
        return first
    peak = "" if most in (first, last) else f"largest {most} (at t = {t[at]:.6g}), "
    return f"first {first}, {peak}last {last}"
