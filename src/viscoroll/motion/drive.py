"""What drives motions, as the caller gives it: :class:`Drive`; the loads and speeds of a result by name."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Floats
from ..core.checks import check_array
from ..core.drive import Feedback, Schedule, make_dimensionless
from ..core.labels import Labels, strip_labels
from ..core.scale import HasUnits, Scale

#: Rows of the kernel's output that describe the state.
STATES = ("V", "omega", "x", "angle", "delta", "regime")
#: Rows of energies lost in the contact.
LOSSES = ("slip_loss", "rolling_loss")
#: Rows that are 0 without a drive.
ACTING = ("force", "torque", "work_force", "work_torque", "brake_loss")
#: Rows of the kernel's output.
ROWS = STATES + ACTING + LOSSES


class Drive(NamedTuple):
    """Loads and prescribed speeds of one motion or many, as the caller gave them; None where nothing is given.

    force, torque, brake, omega, V : a number, an array (n,), a Schedule or a callable of t; force and torque also a
    Feedback of one of these.
    slope, drag : numbers or arrays (n,).
    Meaning, signs and units are those of :func:`viscoroll.roll`; :meth:`over` gives the dimensionless ones.
    """

    force: Any = None
    torque: Any = None
    slope: Any = None
    brake: Any = None
    drag: Any = None
    omega: Any = None
    V: Any = None

    @property
    def given(self) -> dict[str, Any]:
        """What is given, name of the field -> value as the caller gave it, a new dict without what is None."""
        return {name: value for name, value in self._asdict().items() if value is not None}

    @property
    def numbers(self) -> dict[str, Floats]:
        """Return name -> array, () or (n,), of each load or speed that is given as a number or as one for each motion.

        Arrays are float64, and other shapes are not refused here.  The angle of a slope and the drag are among them.
        Schedules, callables and feedbacks are left out.  Raises ParameterError for what is not numeric or not finite.
        """
        others = Feedback | Schedule
        return {n: check_array(n, x) for n, x in self.given.items() if not (callable(x) or isinstance(x, others))}

    @property
    def has_callable(self) -> bool:
        """Whether one of them is a function of t, by itself or in a feedback."""
        return any(callable(x.value if isinstance(x, Feedback) else x) for x in self.given.values())

    @property
    def acts(self) -> bool:
        """Whether anything is given."""
        return not (self.force is self.torque is self.slope is self.brake is self.drag is self.omega is self.V is None)

    def without_zeros(self) -> Drive:
        """Return the same without a force, torque, slope, brake or drag that is 0 at all times; prescribed speeds of 0
        stay.

        Returns a new :class:`Drive`; an empty array and one of zeros are left out, a callable never is.
        Raises ParameterError for a load that is no number and no function of time, or not finite.
        """
        loads = {name: value for name, value in self.given.items() if name not in ("omega", "V")}
        return self._replace(**{name: None for name, value in loads.items() if _is_zero(name, value)})

    def over(self, scale: Scale) -> Drive:
        """Return the same drive made dimensionless; for a scene, and where nothing is given, it is this drive itself.

        scale: :class:`Scale` of the roller: the SI values of 1 of each quantity.  Callables of the result take the time
        in T_ref, the unit of time of that scale.
        Raises ParameterError for what is not numeric or not finite, a brake or a drag below 0, a callable for many
        cylinders or one that cannot be called with a time alone, and an array whose length is not the number of
        cylinders.
        """
        return (
            Drive(*map(make_dimensionless, self._fields, self, (scale,) * len(self)))
            if scale.si and self.acts
            else self
        )


def _is_zero(name: str, value: Any) -> bool:
    """Return whether a load is 0 at all times; a callable never counts as 0.

    name: name of the argument, for refusals.
    value: what the caller gave: a number, an array, of which all must be 0, a Schedule, of which all values must be, a
    callable or a Feedback, whose gains must be 0 too.  An empty array counts as 0.
    Raises ParameterError for what is no number and no function of time, and for numbers that are not finite.
    """
    if isinstance(value, Feedback):
        return not (np.any(value.V) or np.any(value.omega)) and _is_zero(name, value.value)
    return not (callable(value) or np.any(value.values if isinstance(value, Schedule) else check_array(name, value)))


class PlainArguments(NamedTuple):
    """Start speeds and drive as plain numbers, without the units and labels that they carried, and these labels.

    start : V0 and omega0 in the units of the roller.
    drive : loads and prescribed speeds in the units of the roller.
    labels : labels of arrays of xarray and pandas, by which results are labelled again; None without.
    """

    start: tuple[Any, Any]
    drive: Drive
    labels: Labels | None


def strip_units(start: tuple[Any, Any], drive: Drive, units: HasUnits) -> PlainArguments:
    """Return start speeds and drive in the units of a roller, as plain numbers, and the labels that they had.

    start: V0 and omega0, as the caller gave them; None where a speed is prescribed.
    drive: :class:`Drive`, loads and prescribed speeds, as the caller gave them.
    units: units of the roller, an object with a method ``unit`` as :class:`Scale` has it.
    Raises ParameterError for a unit of another dimension, for arrays with labels beside arrays without, or with other
    labels, and, where any argument has a unit or labels, for a Feedback that is neither force nor torque.
    Returns :class:`PlainArguments`; what had neither a unit nor labels is unchanged, and callables are.  Numbers are
    not checked otherwise.
    """
    plain, labels = strip_labels({"V0": start[0], "omega0": start[1], **drive._asdict()}, units)
    return PlainArguments((plain.pop("V0"), plain.pop("omega0")), Drive(**plain), labels)
