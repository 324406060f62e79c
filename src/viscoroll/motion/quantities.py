"""What can be summarised of motions: values over (motion, t), or one a motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .export import column_attributes


class Quantity(NamedTuple):
    """``values(motions, k)`` at output time k, or for all times if not ``over_time``.

    They are those of the column ``like``, or the ``share`` of the kinetic energy at the start.
    """

    fields: tuple[str, ...]
    values: Callable[[Any, int], NDArray]
    like: str = ""
    share: str = ""
    over_time: bool = True

    def about(self, si: bool) -> dict[str, Any]:
        """long_name and units."""
        if self.share:
            return {"long_name": f"share of the initial kinetic energy {self.share}", "units": "1"}
        return column_attributes(self.like, si)


def _over(motions: Any, name: str, k: int) -> NDArray:
    """A field without dimension."""
    return getattr(motions, name)[:, k] / motions.scale[name]


def _translation(motions: Any, k: int) -> NDArray:
    return _over(motions, "V", k) ** 2 / _start_energy(motions)


def _rotation(motions: Any, k: int) -> NDArray:
    return motions.scene.j * _over(motions, "omega", k) ** 2 / _start_energy(motions)


def _start_energy(motions: Any) -> NDArray:
    """Twice the kinetic energy at the start; NaN for those at rest, which have no shares."""
    V, omega = (getattr(motions, name) / motions.scale[name] for name in ("V0", "omega0"))
    energy = V**2 + motions.scene.j * omega**2
    return np.where(energy > 0.0, energy, np.nan)


def _field(name: str) -> Quantity:
    return Quantity((name,), lambda motions, k: getattr(motions, name)[:, k], name)


def _loss(name: str, where: str) -> Quantity:
    """Losses are over m (R/T_epsilon)^2, of which the kinetic energy has a half."""
    return Quantity(
        (name,), lambda motions, k: 2.0 * _over(motions, name, k) / _start_energy(motions), share=f"lost in {where}"
    )


def _each(name: str) -> Quantity:
    return Quantity((), lambda motions, k: getattr(motions, name), name, over_time=False)


QUANTITIES = {
    **{name: _field(name) for name in ("V", "omega", "x", "angle", "delta", "force", "torque")},
    **{name: _field(name) for name in ("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss")},
    "distance": Quantity(("x",), lambda motions, k: np.abs(motions.x[:, k]), "x"),
    "translation": Quantity(("V",), _translation, share="in translation"),
    "rotation": Quantity(("omega",), _rotation, share="in rotation"),
    "lost": Quantity(
        ("V", "omega"), lambda motions, k: 1.0 - _translation(motions, k) - _rotation(motions, k),
        share="lost to slip and rolling resistance",
    ),
    "lost_to_slip": _loss("slip_loss", "slip"),
    "lost_to_rolling": _loss("rolling_loss", "rolling"),
    "onset_time": _each("onset_time"),
    "rest_time": _each("rest_time"),
}  # fmt: skip
