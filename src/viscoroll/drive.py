"""What pushes and turns the cylinder: :class:`Feedback`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .checks import checked, number


@dataclass(frozen=True, eq=False)
class Feedback:
    """A force or torque that follows the speeds: value + V * speed of the axis + omega * angular velocity.

    Parameters
    ----------
    value : what acts at rest, over P for a force, over P R for a torque: a number or an array; for motions also
        (times, values) or a callable of t, see :func:`roll`.
    V, omega : gains, numbers; < 0 brakes what is too fast, as an engine's torque falls with its speed.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, gains that are no single numbers.
    """

    value: Any
    V: float = 0.0
    omega: float = 0.0

    def __post_init__(self) -> None:
        if not (callable(self.value) or isinstance(self.value, tuple)):  # those are checked with their motion
            value = checked("value", self.value)
            if value.ndim:
                value = value.copy()
                value.flags.writeable = False
            object.__setattr__(self, "value", value if value.ndim else float(value))
        for name in ("V", "omega"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
