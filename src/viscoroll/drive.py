"""What pushes and turns the cylinder: :class:`Feedback`, and the slope that it stands on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import checked
from .errors import ParameterError


@dataclass(frozen=True, eq=False)
class Feedback:
    """A force or torque that follows the speeds: value + V * speed of the axis + omega * angular velocity.

    Parameters
    ----------
    value : what acts at rest, over P for a force, over P R for a torque: a number or an array; for motions also
        (times, values) or a callable of t, see :func:`roll`.
    V, omega : gains, numbers, for motions of an ensemble also (n,); < 0 brakes what is too fast, as an engine's torque
        falls with its speed.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, gains that are neither numbers nor vectors.
    """

    value: Any
    V: Any = 0.0
    omega: Any = 0.0

    def __post_init__(self) -> None:
        if not (callable(self.value) or isinstance(self.value, tuple)):  # those are checked with their motion
            object.__setattr__(self, "value", _own("value", self.value))
        for name in ("V", "omega"):
            object.__setattr__(self, name, gain := _own(name, getattr(self, name)))
            if np.ndim(gain) > 1:
                raise ParameterError(name, f"of shape {np.shape(gain)}", "a number, or one a motion, (n,)")

    @property
    def shape(self) -> tuple[int, ...]:
        """Of its gains."""
        return np.broadcast_shapes(np.shape(self.V), np.shape(self.omega))


def _own(name: str, given: Any) -> Any:
    """A number, or an array that nobody else writes to."""
    value = checked(name, given)
    if not value.ndim:
        return float(value)
    value = value.copy()
    value.flags.writeable = False
    return value


def refuse_more_than_t(name: str, function: Callable[..., Any]) -> None:
    """Raise ParameterError for a function that cannot be called with a time alone."""
    try:
        takes = signature(function)
    except ValueError:  # compiled code may not tell
        return
    try:
        takes.bind(0.0)
    except TypeError:
        sentence = (
            f"{name} is called with t alone, this function takes {takes}: for gains on the speeds give Feedback, "
        )
        sentence += "any other controller goes with vr.law into an integrator of your own"
        raise ParameterError(name, function, "a function of t", sentence) from None


def slope_factor(slope: ArrayLike | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(tan(theta), cos(theta)) of a slope in rad; (0, 1) without.

    Raises
    ------
    ParameterError
        A slope that is not in (-pi/2, pi/2).
    """
    theta = checked("slope", 0.0 if slope is None else slope)
    steep = np.abs(theta) >= 0.5 * np.pi
    if steep.any():
        allowed = "an angle below pi/2 in size: radians in (-pi/2, pi/2), as np.radians(degrees) gives"
        raise ParameterError("slope", f"{theta[steep].flat[0]:g}", allowed)
    return np.tan(theta), np.cos(theta)
