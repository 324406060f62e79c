"""What can be summarised of motions: values over (motion, t), or one a motion; in SI units where the run is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion.many import Ensemble
from ..scale import si_unit


class Quantity(NamedTuple):
    """``values(motions, k)`` at output time k, or for all times if not ``over_time``.

    They are in the unit of the column ``like``, or mere numbers; a run of a scene has them over ``over``.
    """

    name: str
    fields: tuple[str, ...]
    values: Callable[[Ensemble, int], NDArray]
    like: str = ""
    over: str = ""
    over_time: bool = True

    def long_name(self, si: bool) -> str:
        """What it is."""
        return self.name if si else f"{self.name} {self.over}".rstrip()

    def units(self, si: bool) -> str:
        """Its unit."""
        return si_unit(self.like) if si and self.like else "1"


def _field(name: str) -> Callable[[Ensemble, int], NDArray]:
    return lambda motions, k: getattr(motions, name)[:, k]


def _translation(motions: Ensemble, k: int) -> NDArray:
    return motions.V[:, k] ** 2 / _start_energy(motions)  # type: ignore[index]


def _rotation(motions: Ensemble, k: int) -> NDArray:
    return motions.scene.j * motions.omega[:, k] ** 2 / _start_energy(motions)  # type: ignore[index]


def _loss(name: str) -> Callable[[Ensemble, int], NDArray]:
    """Losses are over m (R/T_epsilon)^2, of which the kinetic energy has a half."""
    return lambda motions, k: 2.0 * getattr(motions, name)[:, k] / _start_energy(motions)


def _start_energy(motions: Ensemble) -> NDArray:
    """Twice the kinetic energy at the start; NaN for those at rest, which have no shares."""
    energy = motions.V0**2 + motions.scene.j * motions.omega0**2
    return np.where(energy > 0.0, energy, np.nan)


_ENERGY = "over m (R/T_epsilon)^2"
QUANTITIES = {
    "V": Quantity("velocity of the axis", ("V",), _field("V"), "V", "times T_epsilon/R"),
    "omega": Quantity("angular velocity", ("omega",), _field("omega"), "omega", "times T_epsilon"),
    "x": Quantity("displacement of the axis", ("x",), _field("x"), "x", "over R"),
    "distance": Quantity("distance from the start", ("x",), lambda motions, k: np.abs(motions.x[:, k]), "x", "over R"),  # type: ignore[index]
    "angle": Quantity("angle turned, radians", ("angle",), _field("angle"), "angle"),
    "delta": Quantity("creep ratio (omega - V)/V", ("delta",), _field("delta")),
    "translation": Quantity("share of the initial kinetic energy in translation", ("V",), _translation),
    "rotation": Quantity("share of the initial kinetic energy in rotation", ("omega",), _rotation),
    "lost": Quantity(
        "share of the initial kinetic energy lost to slip and rolling resistance", ("V", "omega"),
        lambda motions, k: 1.0 - _translation(motions, k) - _rotation(motions, k),
    ),
    "slip_loss": Quantity("share of the initial kinetic energy lost in slip", ("slip_loss",), _loss("slip_loss")),
    "rolling_loss": Quantity(
        "share of the initial kinetic energy lost in rolling", ("rolling_loss",), _loss("rolling_loss")
    ),
    "force": Quantity("force along V", ("force",), _field("force"), "force", "over load"),
    "torque": Quantity("torque along omega", ("torque",), _field("torque"), "torque", "over load times radius"),
    "work_force": Quantity(
        "work of the force since t = 0", ("work_force",), _field("work_force"), "work_force", _ENERGY
    ),
    "work_torque": Quantity(
        "work of the torque since t = 0", ("work_torque",), _field("work_torque"), "work_torque", _ENERGY
    ),
    "brake_loss": Quantity(
        "energy lost in the brake since t = 0", ("brake_loss",), _field("brake_loss"), "brake_loss", _ENERGY
    ),
    "slip_energy": Quantity(
        "energy lost in slip since t = 0", ("slip_loss",), _field("slip_loss"), "slip_loss", _ENERGY
    ),
    "rolling_energy": Quantity(
        "energy lost in rolling since t = 0", ("rolling_loss",), _field("rolling_loss"), "rolling_loss", _ENERGY
    ),
    "onset_time": Quantity(
        "time of the first change from full to partial slip", (), lambda motions, k: motions.onset_time, "t",
        over_time=False,
    ),
    "rest_time": Quantity(
        "time at which the rest threshold was crossed", (), lambda motions, k: motions.rest_time, "t",
        over_time=False,
    ),
}  # fmt: skip


def valued(name: str, motions: Ensemble, k: int, scales: Mapping[str, Any]) -> NDArray[np.float64]:
    """A quantity at output time k, in the units that ``scales`` of :mod:`units` lead to."""
    quantity = QUANTITIES[name]
    values = np.asarray(quantity.values(motions, k))
    return values * scales[quantity.like] if quantity.like in scales else values
