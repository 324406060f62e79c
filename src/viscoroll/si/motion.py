"""Motions of a cylinder in SI units: :class:`MotionSI` and :class:`EnsembleSI`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..checks import number
from ..errors import MotionStatus, ParameterError
from ..motion.batch import ensemble
from ..motion.checks import output_times, refuse_many
from ..motion.driven import Drive, bare
from ..motion.many import Ensemble
from ..motion.many import card_of as ensemble_card
from ..motion.one import Motion, Switch, card_of, message_of
from ..motion.single import roll
from ..motion.warned import say
from ..results import Row, Shown, Values
from ..scale import Scale
from ..scene import Scene
from ..symbols import attributes
from ..typed import Numbers
from ..validity import WAVE_LIMIT, Validity
from .contact import in_si as contact_in_si
from .units import Cylinder, in_words, over, units_of
from .validity import steadily
from .warned import look_at_motion

if TYPE_CHECKING:
    import xarray as xr

#: of a motion, what has a unit; in an ensemble that and more
_ROWS = ("V", "omega", "x", "angle", "force", "torque", "work_force", "work_torque", "brake_loss")
_SCALED = {*_ROWS, "slip_loss", "rolling_loss", "V0", "omega0", "onset_time", "rest_time"}


@dataclass(frozen=True, eq=False, repr=False)
class MotionSI(Shown):
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
        return message_of(self.motion, self._units)

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
        return self._units.of("slip_loss", self.motion.slip_loss)

    @property
    def rolling_loss(self) -> NDArray[np.float64]:
        """Energy lost in rolling since t = 0, J/m."""
        return self._units.of("rolling_loss", self.motion.rolling_loss)

    @property
    def power_force(self) -> NDArray[np.float64]:
        """Power of the force, W/m."""
        return self.force * self.V

    @property
    def power_torque(self) -> NDArray[np.float64]:
        """Power of the torque, W/m."""
        return self.torque * self.omega

    @property
    def _units(self) -> Scale:
        return units_of(self.cylinder, self.drive.slope)

    def contact(self, fields: Iterable[str] | None = None, **options: Any) -> Values:
        """Contact state along the motion as of :meth:`Motion.contact`, in SI units: Q in N/m, M in N m/m."""
        return contact_in_si(self.motion.contact(fields, **options).as_dict(), self._units, {"t": self.t})

    def validity(self) -> Validity:
        """Which assumptions of the model the motion strains, at each output time, as :meth:`Motion.validity`."""
        found = self.cylinder.validity(self.V[self.regime >= 0], omega=self.omega[self.regime >= 0])
        return found._replace(steady=steadily(self.cylinder, self.motion.validity().steady))

    def at(self, t: Numbers) -> MotionSI:
        """The same motion at other times within [0, end], s, as :meth:`Motion.at`."""
        times = output_times(t)
        return in_si(self.cylinder, self.drive, self.motion.at(times / self.cylinder.T_ref), times)

    def _card(self) -> tuple[str, list[Row]]:
        return card_of(self, partial(attributes, si=True))

    def to_xarray(self) -> xr.Dataset:
        """Dataset over t as of :meth:`Motion.to_xarray`, in SI units; cylinder and scene are attributes."""
        from ..motion.export import motion_dataset

        return motion_dataset(self, partial(attributes, si=True)).assign_attrs(_about(self.cylinder))


@dataclass(frozen=True, eq=False, repr=False)
class EnsembleSI(Shown):
    """Motions of cylinders in SI units; as :class:`viscoroll.motion.Ensemble`, with its names.

    Attributes
    ----------
    cylinder, drive : what rolled, and what was given to drive it.
    ensemble : the dimensionless :class:`Ensemble` that this one shows.
    t : s.
    """

    cylinder: Cylinder
    drive: Drive
    ensemble: Ensemble
    t: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.ensemble)

    def __getattr__(self, name: str) -> Any:
        """V, omega, x, onset_time and the others of an ensemble, in SI units: m/s, rad/s, m, s, N/m, J/m."""
        if name.startswith("_") or name not in Ensemble.__dataclass_fields__:
            raise AttributeError(f"an ensemble has no {name!r}")
        value = getattr(self.ensemble, name)
        if value is None or name not in _SCALED:
            return value
        # over (n, times), where units may be (n,)
        return units_of(self.cylinder, self.drive.slope).of(name, value.T).T

    def __dir__(self) -> Iterable[str]:
        return sorted({*super().__dir__(), *Ensemble.__dataclass_fields__})

    def validity(self) -> Validity:
        """Which assumptions of the model the motions strain, as :meth:`Ensemble.validity`.

        With the speed of waves where a density is known, and the bodies, as :meth:`Cylinder.validity`.
        """
        found = self.ensemble.validity()
        some, V, omega = self.ensemble.judged()
        cylinders, T = self.cylinder._some(some, len(self)), self.cylinder.T_ref
        own = cylinders.validity(V * cylinders.R / T, omega=omega / T)
        names = ("quasistatic", "bodies", "measured", "thick", "plane")
        others = {name: getattr(own, name) for name in names}
        return found._replace(**others, steady=steadily(cylinders, found.steady))

    def messages(self) -> dict[str, int]:
        """How many motions ended in which way, in words."""
        return self.ensemble.messages()

    def summary(self, quantiles: Iterable[float] = (0.05, 0.25, 0.5, 0.75, 0.95)) -> xr.Dataset:
        """Mean, standard deviation and quantiles over the motions, as :meth:`Ensemble.summary`, in SI units."""
        from ..motion.export import summary_dataset

        return summary_dataset(self, tuple(quantiles), partial(attributes, si=True))

    def _card(self) -> tuple[str, list[Row]]:
        return ensemble_card(self, partial(attributes, si=True))

    def to_xarray(self) -> xr.Dataset:
        """Dataset over (motion, t) as of :meth:`Ensemble.to_xarray`, in SI units."""
        from ..motion.export import ensemble_dataset

        return ensemble_dataset(self, partial(attributes, si=True)).assign_attrs(_about(self.cylinder))


def _about(cylinder: Cylinder) -> dict[str, Any]:
    """The cylinder's numbers as attributes of a dataset."""
    return {name: getattr(cylinder, name) for name in ("R", "m", "j", "g", "load", "T_ref")}


def _asked(cylinder: Cylinder, t: Numbers, drive: Drive) -> tuple[Scene, Scale, NDArray[np.float64], dict[str, Any]]:
    """(scene, units, output times in s, the drive's arguments without dimension)."""
    one = units_of(cylinder, drive.slope)
    times = output_times(t) if np.ndim(t) else np.array([number("t", t, low=0.0)])
    given = {name: over(name, value, one) for name, value in drive._asdict().items() if name != "slope"}
    return cylinder.scene(), one, times, given | {"slope": drive.slope}


def roll_of(
    cylinder: Cylinder, start: tuple[float | None, float | None], t: Numbers, drive: Drive, rest: float | None,
    rested: bool | float, **options: Any,
) -> MotionSI:  # fmt: skip
    """``Cylinder.roll``."""
    for name in ("R", "m", "E", "nu", "T_epsilon", "T_sigma", "mu", "j", "g", "load"):
        refuse_many(name, np.shape(getattr(cylinder, name)))
    drive = drive._replace(slope=None if drive.slope is None else number("slope", drive.slope))
    scene, one, times, given = _asked(cylinder, t, drive)
    V0, omega0 = (
        None if speed is None else from_si(number(name, speed))
        for name, speed, from_si in zip(
            ("V0", "omega0"), start, (cylinder.V_from_si, cylinder.omega_from_si), strict=True
        )
    )
    rest = None if rest is None else over("V", number("rest", rest, low=0.0, strict=True), one)
    _look_at_waves(cylinder, start)
    try:
        motion = roll(
            scene, V0, omega0, (times if np.ndim(t) else times[0]) / one["t"], rest=rest, rested=_over_t(rested, one),
            **given, **options,
        )  # fmt: skip
    except ParameterError as error:
        raise in_words(error, one) from error
    look_at_motion(cylinder, start[0], motion.V, one["V"])
    return in_si(cylinder, drive, motion, times if np.ndim(t) else np.append(motion.t[:-1] * one["t"], times))


def _over_t(rested: bool | float, one: Scale) -> bool | float:
    """A rest without dimension."""
    return rested if isinstance(rested, bool) else number("rested", rested, low=0.0) / one["t"]


def _look_at_waves(cylinder: Cylinder, start: tuple[Any, Any]) -> None:
    """Warn of starts beyond the speed of shear waves where a density is known."""
    wave = cylinder._wave_speed
    if wave is None:
        return
    V, omega = (0.0 if speed is None else speed for speed in start)
    if type(V) is type(omega) is type(cylinder.R) is float:
        fastest = max(abs(V), abs(omega) * cylinder.R)
    else:
        fastest = float(np.max(np.maximum(np.abs(V), np.abs(omega) * cylinder.R), initial=0.0))
    if fastest > wave:
        say([f"speeds are beyond those of shear waves (up to {WAVE_LIMIT:g} of them counts as slow)"])


def in_si(cylinder: Cylinder, drive: Drive, motion: Motion, times: NDArray[np.float64]) -> MotionSI:
    """A dimensionless motion of a cylinder in SI units, at ``times`` in s."""
    one = units_of(cylinder, drive.slope)
    rows = {name: one.of(name, getattr(motion, name)) for name in _ROWS}
    T = one["t"]
    return MotionSI(
        cylinder, drive, motion, times, **rows, switches=tuple(Switch(s.t * T, s.regime) for s in motion.switches),
        reversals=motion.reversals * T, onset_time=motion.onset_time * T, rest_time=motion.rest_time * T,
    )  # fmt: skip


def ensemble_of(
    cylinder: Cylinder, start: tuple[Any, Any], t: Numbers, drive: Drive, rest: float | None, rested: bool | float,
    **options: Any,
) -> EnsembleSI:  # fmt: skip
    """``Cylinder.ensemble``."""
    start, drive, labels = bare(start, drive)
    scene, one, times, given = _asked(cylinder, t, drive)
    V0, omega0 = (over(name, speed, one) for name, speed in zip(("V0", "omega0"), start, strict=True))
    if rest is not None and np.ndim(one["V"]):
        raise ParameterError("rest", rest, "None", "rest needs the same R and T_ref for all motions")
    rest = None if rest is None else over("V", number("rest", rest, low=0.0, strict=True), one)
    _look_at_waves(cylinder, start)
    if options.get("speed") is not None:
        options["speed"] = over("V", number("speed", options["speed"], low=0.0, strict=True), one)
    try:
        found = ensemble(
            scene, V0, omega0, times / one["t"], rest=rest, rested=_over_t(rested, one), **given, **options
        )
    except ParameterError as error:
        raise in_words(error, one) from error
    look_at_motion(cylinder, start[0], found.V, one["V"])
    return EnsembleSI(cylinder, drive, replace(found, labels=labels), times)
