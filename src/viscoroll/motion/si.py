"""Motions of a cylinder in SI units: :class:`MotionSI`, and the units of what a motion has."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import checked, number
from ..drive import Feedback, slope_factor
from ..errors import MotionStatus, ParameterError
from ..rolling_contact import Values
from ..scene import Scene
from .checks import output_times
from .driven import Drive
from .single import Motion, Switch, roll

if TYPE_CHECKING:
    import xarray as xr

#: of ``viscoroll.cylinder``, which stands above this module
Cylinder = Any


class Unit(NamedTuple):
    """What a quantity is in SI units."""

    long_name: str
    units: str


SI = {
    "t": Unit("time", "s"),
    "V0": Unit("initial velocity of the axis", "m s-1"),
    "omega0": Unit("initial angular velocity", "rad s-1"),
    "V": Unit("velocity of the axis", "m s-1"),
    "omega": Unit("angular velocity", "rad s-1"),
    "x": Unit("distance travelled", "m"),
    "angle": Unit("angle turned", "rad"),
    "force": Unit("force along V, per length of the cylinder", "N m-1"),
    "torque": Unit("torque along omega, per length of the cylinder", "N m m-1"),
    "slope": Unit("angle of the slope", "rad"),
    "brake": Unit("most torque that a brake takes, per length of the cylinder", "N m m-1"),
    "work_force": Unit("work of the force since t = 0, per length of the cylinder", "J m-1"),
    "work_torque": Unit("work of the torque since t = 0, per length of the cylinder", "J m-1"),
    "brake_loss": Unit("energy lost in the brake since t = 0, per length of the cylinder", "J m-1"),
    "slip_loss": Unit("energy lost in slip since t = 0, per length of the cylinder", "J m-1"),
    "rolling_loss": Unit("energy lost in rolling since t = 0, per length of the cylinder", "J m-1"),
    "onset_time": Unit("time of the first change from full to partial slip", "s"),
    "rest_time": Unit("time at which the rest threshold was crossed", "s"),
}


@dataclass(frozen=True)
class MotionSI:
    """One motion of a cylinder in SI units, per m of its length.

    Attributes
    ----------
    cylinder, drive : what rolled, and what was given to drive it.
    motion : the dimensionless :class:`Motion` that this one shows.
    t, V, omega, x, angle : s, m/s, rad/s, m, rad.
    switches, reversals, onset_time, rest_time : as of :class:`Motion`, in s.
    force, torque : N and N m per m; the force holds the pull of the slope, P sin(slope).
    work_force, work_torque, brake_loss : J/m.
    """

    cylinder: Cylinder
    drive: Drive
    motion: Motion
    t: NDArray[np.float64]
    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    x: NDArray[np.float64]
    angle: NDArray[np.float64]
    switches: tuple[Switch, ...]
    reversals: NDArray[np.float64]
    onset_time: float
    rest_time: float
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    work_force: NDArray[np.float64]
    work_torque: NDArray[np.float64]
    brake_loss: NDArray[np.float64]

    @property
    def scene(self) -> Scene:
        """The dimensionless scene, on its slope."""
        return self.motion.scene

    @property
    def delta(self) -> NDArray[np.float64]:
        """Creep ratio (omega R - V)/V."""
        return self.motion.delta

    @property
    def regime(self) -> NDArray[np.int8]:
        """As of :class:`Motion`."""
        return self.motion.regime

    @property
    def status(self) -> MotionStatus:
        """How the motion ended."""
        return self.motion.status

    @property
    def message(self) -> str:
        """The status in words."""
        return self.motion.message

    @property
    def steps(self) -> int:
        """Integration steps taken."""
        return self.motion.steps

    @property
    def drive_error(self) -> float:
        """As of :class:`Motion`, dimensionless."""
        return self.motion.drive_error

    @property
    def slip_loss(self) -> NDArray[np.float64]:
        """Energy lost in slip since t = 0, J/m."""
        return self.motion.slip_loss * _energy(self.cylinder)

    @property
    def rolling_loss(self) -> NDArray[np.float64]:
        """Energy lost in rolling since t = 0, J/m."""
        return self.motion.rolling_loss * _energy(self.cylinder)

    @property
    def power_force(self) -> NDArray[np.float64]:
        """Power of the force, W/m."""
        return self.force * self.V

    @property
    def power_torque(self) -> NDArray[np.float64]:
        """Power of the torque, W/m."""
        return self.torque * self.omega

    def contact(self, fields: Iterable[str] | None = None, **options: Any) -> Values:
        """Contact state as of :meth:`Motion.contact`: dimensionless, Q and M over the load P cos(slope), and P R."""
        return self.motion.contact(fields, **options)

    def at(self, t: ArrayLike) -> MotionSI:
        """The same motion at other times within [0, end], s, as :meth:`Motion.at`."""
        times = output_times(t)
        return in_si(self.cylinder, self.drive, self.motion.at(self.cylinder.t_from_si(times)), times)

    def to_xarray(self) -> xr.Dataset:
        """Dataset over t as of :meth:`Motion.to_xarray`, in SI units; cylinder and scene are attributes."""
        from .export import attributes, motion_dataset

        data = motion_dataset(self, lambda name: SI[name]._asdict() if name in SI else attributes(name))
        known = ("R", "m", "j", "g", "load", "T_ref")
        return data.assign_attrs({name: getattr(self.cylinder, name) for name in known})


def _energy(cylinder: Cylinder) -> float:
    """m (R/T_ref)^2, J/m."""
    return cylinder.m * (cylinder.R / cylinder.T_ref) ** 2


def _load(cylinder: Cylinder, slope: float | None) -> float:
    return cylinder.load * math.cos(slope or 0.0)


def roll_of(
    cylinder: Cylinder, start: tuple[float | None, float | None], t: ArrayLike, drive: Drive, rtol: float,
    rest: float | None, max_steps: int,
) -> MotionSI:  # fmt: skip
    """``Cylinder.roll``."""
    slope = None if drive.slope is None else number("slope", drive.slope)
    scene = cylinder.scene()
    slope_factor(slope)  # refuses one that is too steep
    drive = drive._replace(slope=slope)
    V0, omega0 = (
        None if speed is None else number(name, speed) for name, speed in zip(("V0", "omega0"), start, strict=True)
    )
    rest = None if rest is None else number("rest", rest, low=0.0, strict=True)
    times = output_times(t) if np.ndim(t) else np.array([number("t", t, low=0.0)])
    R, T, load = cylinder.R, cylinder.T_ref, _load(cylinder, slope)
    units = {"force": load, "torque": load * R, "brake": load * R, "omega": 1.0 / T, "V": R / T}
    given = {name: _over(name, getattr(drive, name), unit, cylinder) for name, unit in units.items()}
    try:
        motion = roll(
            scene, None if V0 is None else cylinder.V_from_si(V0),
            None if omega0 is None else cylinder.omega_from_si(omega0),
            cylinder.t_from_si(times if np.ndim(t) else times[0]), rtol, slope=slope,
            rest=None if rest is None else cylinder.V_from_si(rest), max_steps=max_steps, **given,
        )  # fmt: skip
    except ParameterError as error:
        over = f"(dimensionless: times over {T:.6g} s, speeds over {R / T:.6g} m/s, forces over {load:.6g} N/m)"
        raise ParameterError(error.name, error.value, f"{error.allowed} {over}") from error
    return in_si(cylinder, drive, motion, times if np.ndim(t) else np.append(motion.t[:-1] * T, times))


def in_si(cylinder: Cylinder, drive: Drive, motion: Motion, times: NDArray[np.float64]) -> MotionSI:
    """A dimensionless motion of a cylinder in SI units, at ``times`` in s."""
    T, load, energy = cylinder.T_ref, _load(cylinder, drive.slope), _energy(cylinder)
    return MotionSI(
        cylinder, drive, motion, times, cylinder.V_to_si(motion.V), cylinder.omega_to_si(motion.omega),
        cylinder.x_to_si(motion.x), motion.angle, tuple(Switch(s.t * T, s.regime) for s in motion.switches),
        motion.reversals * T, motion.onset_time * T, motion.rest_time * T,
        motion.force * load, motion.torque * (load * cylinder.R),
        motion.work_force * energy, motion.work_torque * energy, motion.brake_loss * energy,
    )  # fmt: skip


def _over(name: str, given: Any, unit: float, cylinder: Cylinder) -> Any:
    """A force, torque, brake or speed over time, over its unit and T_ref.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, a brake or a time below 0.
    """
    if given is None:
        return None
    low = 0.0 if name == "brake" else -np.inf
    if isinstance(given, Feedback):
        gains = cylinder.V_to_si(given.V) / unit, cylinder.omega_to_si(given.omega) / unit
        return Feedback(_over(name, given.value, unit, cylinder), *map(float, gains))
    if callable(given):
        return lambda t: checked(f"{name}(t)", given(t * cylinder.T_ref), low=low) / unit
    if isinstance(given, tuple) and len(given) == 2:
        times, values = checked(f"times of {name}", given[0], low=0.0), checked(f"values of {name}", given[1], low=low)
        return cylinder.t_from_si(times), values / unit
    value = checked(name, given, low=low) / unit
    return value if value.ndim else float(value)
