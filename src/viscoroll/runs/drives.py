"""What drives the motions of a run: section [drive], each number of which may be uncertain, but for times.

Inputs are named drive_force, or drive_force_2 where they are the second of the values over times.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ParameterError
from ..motion.schedule import curve
from .ranges import DRIVE
from .solids import median
from .units import are_si, load_of

if TYPE_CHECKING:
    from .inputs import Inputs
    from .ranges import Range
    from .sources import Reader

PREFIX = "drive_"
_CORNERS = ("times", "values")
_NAMES = {PREFIX + name for name in DRIVE}


@dataclass(frozen=True)
class Course:
    """Linear between times: these, and the names of the inputs that are its values."""

    times: tuple[float, ...]
    names: tuple[str, ...]

    def of(self, values: Mapping[str, Any], unit: Any) -> tuple[Any, Any]:
        """(times, values over ``unit``) of a block's inputs, values (k,) or (n, k)."""
        corners = np.stack(np.broadcast_arrays(*(values[name] for name in self.names)), axis=-1)
        return np.array(self.times), corners / np.asarray(unit)[..., np.newaxis]


def read_drive(reader: Reader, given: dict[str, Any], ranges: Mapping[str, Range]) -> None:
    """File the inputs of a section [drive]; raises ConfigError."""
    for name, value in given.items():
        if isinstance(value, dict) and name != "slope" and value.keys() & set(_CORNERS):
            reader.fixed[PREFIX + name] = _course(reader, name, value, ranges[name])
        else:
            reader.put(PREFIX + name, value, ranges[name], line=name)
        reader.line = ""


def _course(reader: Reader, name: str, given: dict[str, Any], allowed: Range) -> Course:
    reader.line = name
    if given.keys() != set(_CORNERS) or not all(isinstance(given[key], list) for key in _CORNERS):
        raise reader.fault(name, f"{name}: must be {{ times = [...], values = [...] }}")
    for time in given["times"]:
        if isinstance(time, bool) or not isinstance(time, (int, float)):
            raise reader.fault(name, f"{name}: times: {time!r:.40}: must be a plain number, the same for every motion")
    names = tuple(f"{PREFIX}{name}_{n}" for n in range(1, len(given["values"]) + 1))
    entries = zip(names, given["values"], strict=True)
    medians = [median(reader, key, entry, allowed, line=name) for key, entry in entries]
    try:
        curve(name, (given["times"], medians), 1.0, 1.0)
    except ParameterError as error:
        raise reader.fault(name, str(error)) from error
    return Course(tuple(map(float, given["times"])), names)


def is_driven(inputs: Inputs) -> bool:
    """Whether there is a section [drive] with something in it."""
    return any(name.startswith(PREFIX) for name in (*inputs.fixed, *inputs.uncertain))


def lasts(inputs: Inputs) -> bool:
    """Whether something may drive the motions to their end."""
    last = {name: value.names[-1] if isinstance(value, Course) else name for name, value in inputs.fixed.items()}
    fixed = [inputs.fixed.get(end, 1.0) != 0.0 for name, end in last.items() if name in _NAMES]
    return any(fixed) or bool(_NAMES & set(inputs.uncertain))


def drive_of(values: Mapping[str, Any]) -> dict[str, Any]:
    """What drives a block's motions, as keywords of ``ensemble``: over load and radius, times as they are given."""
    load, R = (load_of(values), values["R"]) if are_si(values) else (1.0, 1.0)
    units = {"force": load, "torque": load * R, "brake": load * R, "slope": 1.0}
    found = {name: (values[PREFIX + name], unit) for name, unit in units.items() if PREFIX + name in values}
    return {
        name: given.of(values, unit) if isinstance(given, Course) else given / unit
        for name, (given, unit) in found.items()
    }
