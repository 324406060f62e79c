"""What one motion and many have in common as they are given back: :class:`Rolled`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..contact_law.parameters import Parameters, Rolls
from ..core.array_types import Floats
from ..core.errors import MotionStatus
from ..core.results import Result, SummaryRow, unit_of
from ..core.scale import Scale
from ..core.symbols import attributes
from .driven import Drive


@dataclass(frozen=True, eq=False, repr=False)
class Rolled(Result):
    """What was rolled, and its rows over the output times."""

    roller: Rolls
    drive: Drive
    t: Floats
    V: Floats
    omega: Floats
    x: Floats
    angle: Floats
    delta: Floats
    regime: Any
    force: Floats
    torque: Floats
    work_force: Floats
    work_torque: Floats
    brake_loss: Floats
    slip_loss: Floats
    rolling_loss: Floats
    onset_time: Any
    rest_time: Any
    status: Any
    steps: Any
    switches: Any
    drive_error: float

    @property
    def scene(self) -> Parameters:
        """The dimensionless scene, on its slope."""
        return self.roller.scene()

    @property
    def scale(self) -> Scale:
        """What 1 of each quantity is: in SI units of a cylinder."""
        return self.roller.scale

    @property
    def success(self) -> Any:
        """Whether it reached the last output time, or rest; of many, which did."""
        return self.status <= MotionStatus.RESTED

    def _unit(self, name: str) -> str:
        return unit_of(attributes(name, self.scale.si))

    def _times(self) -> SummaryRow:
        return SummaryRow("t", f"{self.t.size} times to " * (self.t.size > 1) + f"{self.t[-1]:.6g}", self._unit("t"))
