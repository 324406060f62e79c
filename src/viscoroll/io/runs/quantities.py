"""What can be summarised of motions: values over (motion, t), or one a motion; and what columns are, in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.symbols import SYMBOLS
from ...cylinder import UNITS
from ...motion.export import column_attributes
from ...motion.many import Ensemble
from ..config import CylinderSection
from .uncertain import PREFIXES


class Quantity(NamedTuple):
    """``values(motions, k)`` at output time k, or for all times if not ``over_time``.

    They are those of the column ``like``, or the ``share`` of the kinetic energy at the start.
    """

    fields: tuple[str, ...]
    values: Callable[[Ensemble, int], NDArray]
    like: str = ""
    share: str = ""
    over_time: bool = True

    def about(self, si: bool) -> dict[str, Any]:
        """long_name and units."""
        if self.share:
            return {"long_name": f"share of the initial kinetic energy {self.share}", "units": "1"}
        return column_attributes(self.like, si)


def _over(motions: Ensemble, name: str, k: int) -> NDArray:
    """A field without dimension."""
    return getattr(motions, name)[:, k] / motions.scale[name]


def _translation(motions: Ensemble, k: int) -> NDArray:
    return _over(motions, "V", k) ** 2 / _start_energy(motions)


def _rotation(motions: Ensemble, k: int) -> NDArray:
    return motions.scene.j * _over(motions, "omega", k) ** 2 / _start_energy(motions)


def _start_energy(motions: Ensemble) -> NDArray:
    """Twice the kinetic energy at the start; NaN for those at rest, which have no shares."""
    V, omega = (getattr(motions, name) / motions.scale[name] for name in ("V0", "omega0"))
    energy = V**2 + motions.scene.j * omega**2
    return np.where(energy > 0.0, energy, np.nan)


def _field(name: str, like: str = "") -> Quantity:
    return Quantity((name,), lambda motions, k: getattr(motions, name)[:, k], like or name)


def _loss(name: str, where: str) -> Quantity:
    """Losses are over m (R/T_epsilon)^2, of which the kinetic energy has a half."""
    return Quantity(
        (name,), lambda motions, k: 2.0 * _over(motions, name, k) / _start_energy(motions), share=f"lost in {where}"
    )


def _each(name: str) -> Quantity:
    return Quantity((), lambda motions, k: getattr(motions, name), name, over_time=False)


QUANTITIES = {
    **{name: _field(name) for name in ("V", "omega", "x", "angle", "delta", "force", "torque")},
    **{name: _field(name) for name in ("work_force", "work_torque", "brake_loss")},
    "distance": Quantity(("x",), lambda motions, k: np.abs(motions.x[:, k]), "x"),
    "translation": Quantity(("V",), _translation, share="in translation"),
    "rotation": Quantity(("omega",), _rotation, share="in rotation"),
    "lost": Quantity(
        ("V", "omega"), lambda motions, k: 1.0 - _translation(motions, k) - _rotation(motions, k),
        share="lost to slip and rolling resistance",
    ),
    "slip_loss": _loss("slip_loss", "slip"),
    "rolling_loss": _loss("rolling_loss", "rolling"),
    "slip_energy": _field("slip_loss"),
    "rolling_energy": _field("rolling_loss"),
    "onset_time": _each("onset_time"),
    "rest_time": _each("rest_time"),
}  # fmt: skip
_MODES = {
    "E": "strength {} of relaxation over the long-time modulus", "tau": "relaxation time {} over T_ref",
    "J": "strength {} of creep over the long-time compliance", "T": "retardation time {} over T_ref",
}  # fmt: skip


def attributes(name: str, si: bool) -> dict[str, Any]:
    """long_name, units and more of a column, as JSON takes them."""
    if name.startswith(PREFIXES["drive"]):
        what, _, corner = name.removeprefix(PREFIXES["drive"]).partition("_")
        about = attributes(what, si)
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {what}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        return about | {"long_name": f"given: {about['long_name']}" + f", value {corner}" * bool(corner)}
    if name.startswith(PREFIXES["base"]):
        about = attributes(name.removeprefix(PREFIXES["base"]), si)
        return about | {"long_name": f"base: {about['long_name']}"}
    kind, _, number = name.partition("_")
    if kind in _MODES and number.isdecimal():
        return {"long_name": _MODES[kind].format(number), "units": "1"}
    if name in CylinderSection.__struct_fields__ and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": UNITS.get(name, "1")}
    return {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in column_attributes(name, si).items()
    }
