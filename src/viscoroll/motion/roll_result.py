"""Common data of one motion and of an ensemble: :class:`RollResult`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..contact_mechanics.assumptions import Validity
from ..contact_mechanics.free_rolling import FreeRolling
from ..contact_mechanics.parameters import Parameters, Roller
from ..contact_mechanics.validity import Steadiness
from ..core.checks import Floats
from ..core.errors import MotionStatus
from ..core.results import Result, SummaryRow, unit_of
from ..core.scale import Scale, attributes
from .motion_arguments import Drive


@dataclass(frozen=True, eq=False, repr=False)
class RollResult(Result):
    """The data that :class:`Motion` and :class:`Ensemble` have in common: the roller, its drive,
    and the rows over the output times.

    The two classes describe the fields.
    """

    roller: Roller
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
        """1 of each dimensionless quantity: in SI units for a cylinder."""
        return self.roller.scale

    @property
    def success(self) -> Any:
        """Whether the motion reached the last output time, or rest; of an ensemble for each
        motion.
        """
        return self.status <= MotionStatus.RESTED

    def _add_steadiness(
        self, report: Validity, roller: Roller, V: Floats, rolls: Any, x: Any, *, ends: bool
    ) -> Validity:
        """Add to a report whether the law of steady rolling may drive the motions, as its entry
        ``steady``.

        report: :class:`Validity` of the states of the motions.
        roller: :class:`Scene` or :class:`Cylinder` of the motions, with gamma; not one with a
            cover, for which ParameterError is raised.  Its ``scene()`` and ``scale`` are read.
        V: speeds in its unit, (times, ...).
        rolls: mask, True where the motions are not in full slip, (times, ...).
        x: distances travelled, in the unit of the roller, (times, ...); NaN where they are not
        known.
        ends: whether the unsteadiness is that of each motion as a whole, (...); else it is the
        largest so far at each time, (times, ...).
        Returns a new report with that entry.
        """
        free = FreeRolling.of_scene(roller.scene(), V / roller.scale["V"]).scaled(roller.scale)
        return report._replace(steady=Steadiness.along(free, rolls, x, ends=ends))

    def _unit(self, name: str) -> str:
        """Return the unit of the quantity ``name`` for a printed report, as "m s-1"; "" of a
        dimensionless one.
        """
        return unit_of(attributes(name, self.scale.si))

    def _row_of_times(self) -> SummaryRow:
        """Return the row of a printed report on the output times: their number, if above 1, and the
        last one.
        """
        return SummaryRow(
            "t",
            f"{self.t.size} times to " * (self.t.size > 1) + f"{self.t[-1]:.6g}",
            self._unit("t"),
        )
