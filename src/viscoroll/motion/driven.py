"""What drives a motion, made ready for the kernels: :class:`Drive`, :func:`prepared`."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..core.checks import broadcast_shape, checked
from ..core.drive import Feedback, Schedule, over, slope_factor
from ..core.errors import ParameterError, one_of
from ..core.labels import Labels, unlabelled
from ..core.scale import HasUnits, Scale
from ..core.typed import Floats
from ..kernels.motion.records import COL_COEFFICIENTS, N_DRIVE_FUNCTIONS, NOT_PRESCRIBED
from .checks import start_speeds
from .courses import SPEEDS, Courses
from .schedule import Course, Curve, course

STATES, LOSSES = ("V", "omega", "x", "angle", "delta", "regime"), ("slip_loss", "rolling_loss")
ACTING = ("force", "torque", "work_force", "work_torque", "brake_loss")
#: rows of the kernel's output
ROWS = STATES + ACTING + LOSSES
#: a prescribed start may be off by this share of the largest prescribed speed
_START = 1e-9
#: what is not given beside a prescribed speed, and why
_BESIDE = (
    ("torque", "omega", "it is what the prescribed omega needs"), ("force", "V", "it is what the prescribed V needs"),
    ("brake", "omega", "omega is prescribed"), ("drag", "omega", "omega is prescribed"),
)  # fmt: skip
#: gains in the order of the kernel's
_GAINS = ("gain of force on V", "gain of force on omega", "gain of torque on V", "gain of torque on omega")


class Drive(NamedTuple):
    """What a caller gave to drive a motion or many; None is nothing."""

    force: Any = None
    torque: Any = None
    slope: Any = None
    brake: Any = None
    drag: Any = None
    omega: Any = None
    V: Any = None

    @property
    def acting(self) -> Drive:
        """The same without a force, torque, slope, brake or drag of 0."""
        gone = {name: None for name, each in self.given.items() if name not in ("omega", "V") and _still(name, each)}
        return self._replace(**gone)

    @property
    def given(self) -> dict[str, Any]:
        """What there is, by name."""
        return {name: each for name, each in zip(self._fields, self, strict=True) if each is not None}

    @property
    def numbers(self) -> dict[str, Floats]:
        """What is given as a number, or as one a motion, by name."""
        return {name: checked(name, each) for name, each in self.given.items() if _is_number(each)}

    def over(self, scale: Scale) -> Drive:
        """The same without dimension."""
        return Drive(*map(over, self._fields, self, (scale,) * len(self))) if scale.si and self.acts else self

    @property
    def has_callable(self) -> bool:
        """Whether one of them is a function of t, by itself or in a feedback."""
        return any(callable(each.value if isinstance(each, Feedback) else each) for each in self.given.values())

    @property
    def acts(self) -> bool:
        """Whether anything does."""
        return not (self.force is self.torque is self.slope is self.brake is self.drag is self.omega is self.V is None)


def _is_number(given: Any) -> bool:
    return not (callable(given) or isinstance(given, Feedback | Schedule))


def _still(name: str, given: Any) -> bool:
    """Whether it is 0 at all times; raises ParameterError for what is no number and no function of time."""
    if isinstance(given, Feedback):
        return not (np.any(given.V) or np.any(given.omega)) and _still(name, given.value)
    return not (callable(given) or np.any(given.values if isinstance(given, Schedule) else checked(name, given)))


def bare(start: tuple[Any, Any], drive: Drive, units: HasUnits) -> tuple[tuple[Any, Any], Drive, Labels | None]:
    """Start speeds and drive without units and labels of xarray and pandas, and these labels; raises ParameterError."""
    plain, labels = unlabelled({"V0": start[0], "omega0": start[1], **drive._asdict()}, units)
    return (plain.pop("V0"), plain.pop("omega0")), Drive(**plain), labels


class Prepared(NamedTuple):
    """A drive for the kernel, in T_ref.

    pieces : (1, k, columns) where all motions are driven alike; else None, and :meth:`for_kernel` makes those of some
    motions at a time, so that measured schedules take little memory beside themselves.
    gains : (4, 1 or m).  prescribed : which speed is.  V0, omega0 : start speeds.
    error : the largest difference between a callable and its fit.
    courses, end : what acts, and up to when; None without a drive.
    """

    pieces: Floats | None
    gains: Floats
    prescribed: int
    V0: Any
    omega0: Any
    error: float = 0.0
    courses: Courses | None = None
    end: float = 0.0

    @property
    def motions(self) -> int:
        """Number of motions that are driven each in its own way, by gains or over time; 1 if all are driven alike."""
        return max(1 if self.courses is None else self.courses.motions, self.gains.shape[1])

    def block(self, most: int) -> int:
        """Number of motions, at most ``most``, that the kernel is to roll at a time."""
        return most if self.courses is None else self.courses.block(most)

    def for_kernel(self, chosen: Any = slice(None)) -> tuple[Floats, Floats, int]:
        """Pieces, of the ``chosen`` motions where each has its own, gains, and which speed is prescribed."""
        pieces = self.pieces
        if pieces is None:
            assert self.courses is not None
            pieces = self.courses.some(chosen).pieces(self.end)
        gains = self.gains[:, chosen] if self.gains.shape[1] > 1 else self.gains
        return np.ascontiguousarray(pieces), np.ascontiguousarray(gains), self.prescribed

    @property
    def drives_to_the_end(self) -> bool:
        """Whether anything still acts at the end, on any motion."""
        if self.prescribed or self.gains.any():
            return True
        if self.courses is None:
            return False
        count = self.courses.motions
        step = self.block(max(count, 1))
        blocks = (self.for_kernel(slice(first, first + step))[0] for first in range(0, count, step))
        return any(block[:, -1, 2:].any() for block in blocks)


@cache
def undriven() -> tuple[Floats, Floats, int]:
    """Pieces and gains of nothing that drives, and which speed is prescribed."""
    return np.zeros((1, 1, COL_COEFFICIENTS + N_DRIVE_FUNCTIONS)), np.zeros((4, 1)), NOT_PRESCRIBED


def prepared(drive: Drive, V0: Any, omega0: Any, end: float, rtol: float, resolve: float | None = None) -> Prepared:
    """A drive without dimension up to the time ``end``.

    Parameters
    ----------
    drive : what was given, over its units.
    V0, omega0 : start speeds; None where they are prescribed.
    end : the last time.
    rtol, resolve : as of :func:`viscoroll.roll`.

    Raises
    ------
    ParameterError
        What is no drive (:func:`viscoroll.roll`); V and omega both prescribed, with what is then found given as well;
        a start that is not the prescribed one; ``resolve`` without a callable.
    """
    if resolve is not None and not drive.has_callable:
        sentence = f"resolve = {resolve!s:.60} is given, but nothing that drives is a function of t: leave it out"
        raise ParameterError("resolve", resolve, "left out", sentence)
    if not drive.acts:
        return Prepared(*undriven(), *start_speeds(V0, omega0))
    tangent = slope_factor(drive.slope)[0]
    if drive.V is not None and drive.omega is not None:
        raise one_of("V", "omega", both=True)
    for name, by, why in _BESIDE:
        if getattr(drive, by) is not None and (beside := getattr(drive, name)) is not None:
            raise ParameterError(name, beside, "left out", f"{name} is given beside {by}=: leave it out, {why}")

    def checked_course(name: str, low: float = -np.inf) -> Course:
        return course(name, getattr(drive, name), end, rtol, low=low, resolve=resolve)

    force, torque, brake = checked_course("force"), checked_course("torque"), checked_course("brake", low=0.0)
    prescribed = next((code for code, name in SPEEDS.items() if getattr(drive, name) is not None), NOT_PRESCRIBED)
    speed = checked_course(SPEEDS[prescribed]) if prescribed else None
    if isinstance(speed, np.ndarray) and not speed.size:
        raise ParameterError(SPEEDS[prescribed], "an empty array", "a number, one a motion, or a function of t")
    courses = Courses(force, torque, brake, np.asarray(tangent), speed, prescribed)
    starts = {"omega": omega0, "V": V0}
    if prescribed:
        name = SPEEDS[prescribed]
        starts[name] = _prescribed_start(f"{name}0", starts[name], courses, getattr(drive, name))
    for name, start in starts.items():
        if start is None:
            raise ParameterError(f"{name}0", None, "a number", f"{name}0 is not given, and no {name}= prescribes it")
    pieces = courses.pieces(end) if courses.motions == 1 else None
    error = max((one.error for one in courses.each.values() if isinstance(one, Curve)), default=0.0)
    speeds = start_speeds(starts["V"], starts["omega"])
    return Prepared(pieces, _gains(drive), prescribed, *speeds, error, courses, end)


def _prescribed_start(name: str, given: Any, courses: Courses, speed: Any) -> Any:
    """The start that is prescribed, a number where it is one for all, of as many motions as were given one.

    Parameters
    ----------
    name : "V0" or "omega0".
    given : the start that the caller gave; None without.
    courses : what acts.
    speed : the prescribed speed as the caller gave it.

    Raises
    ------
    ParameterError
        Where ``given`` is another start, or where the speed jumps.
    """
    start, scale = courses.starts()
    if callable(speed):  # its fit is off by rounding, and may be of the other sign
        start = np.array([float(speed(0.0))])
    if given is not None and not (np.abs(checked(name, given) - start) <= _START * scale).all():
        raise ParameterError(name, given, f"None, or {float(start[0]):.12g} as prescribed")
    if start.size > 1:
        return start
    return float(start[0]) if np.ndim(given) == 0 else np.full(np.shape(given), start[0])


def _gains(drive: Drive) -> Floats:
    """Of force over V, force over omega, torque over V, torque over omega."""
    pairs = [(each.V, each.omega) if isinstance(each, Feedback) else (0.0, 0.0) for each in (drive.force, drive.torque)]
    rows = [np.atleast_1d(gain) for pair in pairs for gain in pair]
    rows[3] = rows[3] - checked("drag", 0.0 if drive.drag is None else drive.drag, low=0.0)
    count = broadcast_shape(**dict(zip(_GAINS, rows, strict=True)))
    return np.array([np.broadcast_to(row, count) for row in rows])


def refuse_rest(rest: float, drives: Prepared) -> None:
    """Raise ParameterError where a motion is to end at rest while something drives it to the end.

    Where nothing does, speeds below the threshold stay there.
    """
    if rest > 0.0 and drives.drives_to_the_end:
        sentence = f"rest = {rest:g} is given, but something drives the motion to its end: leave it out"
        sentence += " (what a brake stops and holds is at rest in finite time: switches say when)"
        raise ParameterError("rest", rest, "None", sentence)
