"""What drives the motions of a run: section [drive], each number of which may be uncertain.

Inputs are named drive_force, or drive_force_2 where they are the second of the values over times, drive_force_time_2
the second of the times.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...drive import Schedule
from ...errors import ParameterError
from ...motion.schedule import curve
from .ranges import DRIVE, TIME
from .solids import median, spread
from .units import scale_of

if TYPE_CHECKING:
    from .ranges import Range
    from .reader import Reader
    from .record import Inputs

PREFIX = "drive_"
#: in place of a time: that before once more, so that the value jumps
SAME = "same"
#: prescribed speeds -> the start that they are in place of, and what is found and may not be given
PRESCRIBED = {"V": ("V0", ("force",)), "omega": ("omega0", ("torque", "brake"))}
_CORNERS = ("times", "values")
_NAMES = {PREFIX + name for name in DRIVE}


@dataclass(frozen=True)
class Course:
    """Linear between times, which are numbers or names of inputs; the values are inputs of these names."""

    times: tuple[float | str, ...]
    names: tuple[str, ...]

    def of(self, values: Mapping[str, Any], unit: Any) -> Schedule:
        """Over times, values over ``unit``, of a block's inputs, each (k,) or (n, k)."""
        times = [values[time] if isinstance(time, str) else time for time in self.times]
        corners = _together([values[name] for name in self.names])
        return Schedule(_together(times), corners / np.asarray(unit)[..., np.newaxis])


def _together(columns: list[Any]) -> Any:
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


def read_drive(reader: Reader, given: dict[str, Any], ranges: Mapping[str, Range]) -> None:
    """File the inputs of a section [drive]; raises ConfigError."""
    for name, (_, found) in PRESCRIBED.items():
        wrong = [other for other in (*found, *PRESCRIBED) if other != name and other in given and name in given]
        if wrong:
            raise reader.fault(wrong[0], f"{wrong[0]}: must be left out with a prescribed {name}")
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
    times = _times(reader, name, given["times"])
    names = tuple(f"{PREFIX}{name}_{n}" for n in range(1, len(given["values"]) + 1))
    entries = zip(names, given["values"], strict=True)
    medians = [median(reader, key, entry, allowed, line=name) for key, entry in entries]
    middle = [
        float(np.median(spread(reader, time, np.array([0.5])))) if isinstance(time, str) else time for time in times
    ]
    try:
        curve(name, Schedule(middle, medians), 1.0, 1.0)
    except ParameterError as error:
        raise reader.fault(name, str(error)) from error
    return Course(times, names)


def _times(reader: Reader, name: str, given: list[Any]) -> tuple[float | str, ...]:
    """Times of a course, each a number or the name of an input; none may fall, whatever is drawn."""
    found: list[float | str] = []
    latest = 0.0
    for n, entry in enumerate(given, 1):
        if entry == SAME and found:
            found.append(found[-1])
            continue
        if isinstance(entry, (int, float)) and not isinstance(entry, bool):
            if entry < latest and any(isinstance(time, str) for time in found):
                raise reader.fault(
                    name, f"{name}: time {n} = {entry:g}, before {latest:g}, which may be the one before"
                )
            found.append(float(entry))
            latest = max(latest, float(entry))
            continue
        if isinstance(entry, str) or not isinstance(entry, dict):
            problem = f"times: {entry!r:.40}: must be a number, a distribution, a column, or {SAME!r} as the one before"
            raise reader.fault(name, f"{name}: {problem}")
        key = f"{PREFIX}{name}_time_{n}"
        reader.put(key, entry, TIME, line=name)
        reader.line = name
        ends = spread(reader, key, np.array([0.0, 1.0]))
        if not ends.min() >= latest:
            problem = f"may be {ends.min():g}, before {latest:g}: truncate = [low, high] so that times never fall"
            raise reader.fault(name, f"{name}: time {n} {problem}")
        latest = float(ends.max())
        found.append(key)
    return tuple(found)


def prescribed_start(reader: Reader, name: str, given: dict[str, Any], drive: dict[str, Any]) -> bool:
    """Whether this start is that of a prescribed speed; raises ConfigError where it is given too."""
    speed = next((speed for speed, (start, _) in PRESCRIBED.items() if start == name and speed in drive), None)
    if speed is not None and name in given:
        raise reader.fault(name, f"{name}: must be left out: [drive] prescribes {speed}")
    return speed is not None


def is_driven(inputs: Inputs) -> bool:
    """Whether there is a section [drive] with something in it."""
    return any(name.startswith(PREFIX) for name in (*inputs.fixed, *inputs.uncertain))


def lasts(inputs: Inputs) -> bool:
    """Whether something may drive the motions to their end."""
    if any(PREFIX + name in (*inputs.fixed, *inputs.uncertain) for name in PRESCRIBED):
        return True
    last = {name: value.names[-1] if isinstance(value, Course) else name for name, value in inputs.fixed.items()}
    fixed = [inputs.fixed.get(end, 1.0) != 0.0 for name, end in last.items() if name in _NAMES]
    return any(fixed) or bool(_NAMES & set(inputs.uncertain))


def drive_of(values: Mapping[str, Any]) -> dict[str, Any]:
    """What drives a block's motions, as keywords of ``ensemble``: over load and radius, times as they are given."""
    scale = scale_of(values)
    found = {name: (values[PREFIX + name], scale[name]) for name in DRIVE if PREFIX + name in values}
    return {
        name: given.of(values, unit) if isinstance(given, Course) else given / unit
        for name, (given, unit) in found.items()
    }
