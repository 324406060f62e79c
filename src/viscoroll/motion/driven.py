"""What drives a motion, made ready for the kernels: :class:`Drive`, :func:`prepared`."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..core.checks import broadcast_shape, checked
from ..core.drive import Feedback, Schedule, over, slope_factor
from ..core.errors import ParameterError, one_of
from ..core.labels import Labels, unlabelled
from ..core.scale import Scale
from ..core.typed import Floats
from ..kernels.motion.records import NEITHER, OMEGA, SPEED
from .checks import start_speeds
from .fitted import TERMS
from .schedule import Corners, Course, Curve, at_start, course, curve, motions_of, of_some, pieces_of, slope_of

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
#: by which name a speed is prescribed
_SPEEDS = {OMEGA: "omega", SPEED: "V"}
#: bytes of pieces that are made at a time where motions have their own: little beside the schedules, and yet many
#: motions at once where these are short
_BLOCK_BYTES = 1 << 18
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
        gone = {name: None for name, each in self.given.items() if name not in ("omega", "V") and _still(each)}
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


def _still(given: Any) -> bool:
    """Whether it is 0 at all times."""
    if isinstance(given, Feedback):
        return not (np.any(given.V) or np.any(given.omega)) and _still(given.value)
    return not (callable(given) or np.any(given.values if isinstance(given, Schedule) else given))


def bare(start: tuple[Any, Any], drive: Drive) -> tuple[tuple[Any, Any], Drive, Labels | None]:
    """Start speeds and drive of many motions without labels of xarray and pandas, and these."""
    plain, labels = unlabelled({"V0": start[0], "omega0": start[1], **drive._asdict()})
    return (plain.pop("V0"), plain.pop("omega0")), Drive(**plain), labels


class Courses(NamedTuple):
    """What acts over time, checked and without dimension, each the same for all motions or one a motion.

    tangent : of the slope, which adds to the force.
    speed : the prescribed one, of V or omega as ``prescribed`` says; None without.
    """

    force: Course
    torque: Course
    brake: Course
    tangent: Floats
    speed: Course | None
    prescribed: int

    @property
    def each(self) -> dict[str, Course]:
        """Those that there are, by the name of their argument."""
        names = "force", "torque", "brake", "slope", _SPEEDS.get(self.prescribed)
        return {name: one for name, one in zip(names, self[:-1], strict=True) if name and one is not None}

    @property
    def motions(self) -> int:
        """Number of motions that have courses of their own; 1 if all are alike.

        Raises
        ------
        ParameterError
            Where two courses are of different numbers of motions.
        """
        counts = {name: motions_of(one) for name, one in self.each.items()}
        shape = broadcast_shape(**{name: np.empty(count) for name, count in counts.items() if count != 1})
        return shape[0] if shape else 1

    @property
    def corners(self) -> int:
        """Number of corners of a motion's schedules, and of pieces of its callables."""
        return sum(one[0].shape[-1] for one in self.each.values() if isinstance(one, Corners | Curve))

    def some(self, chosen: Any) -> Courses:
        """Those of the ``chosen`` motions, an index of numpy."""
        force, torque, brake = (of_some(one, chosen) for one in self[:3])
        tangent = self.tangent[chosen] if self.tangent.size > 1 else self.tangent
        speed = None if self.speed is None else of_some(self.speed, chosen)
        return Courses(force, torque, brake, tangent, speed, self.prescribed)

    def block(self, most: int) -> int:
        """Number of motions, at most ``most``, whose pieces take some :data:`_BLOCK_BYTES`."""
        if self.motions == 1:
            return most
        columns = 2 + 4 * (TERMS if any(isinstance(one, Curve) for one in self.each.values()) else 2)
        return min(max(_BLOCK_BYTES // (8 * columns * (self.corners + 1)), 1), most)

    def starts(self) -> tuple[Floats, Floats]:
        """(Value at t = 0, largest size) of the prescribed speed, of every motion that has its own.

        Raises
        ------
        ParameterError
            Where it jumps.
        """
        assert self.speed is not None
        firsts, sizes, count = [], [], motions_of(self.speed)
        step = self.block(max(count, 1))
        for first in range(0, max(count, 1), step):
            one = curve(of_some(self.speed, slice(first, first + step)))
            slope_of(_SPEEDS[self.prescribed], one)
            firsts.append(at_start(one.terms[:, 0]))
            sizes.append(np.abs(one.terms).sum(axis=-1).max(axis=1, initial=0.0))
        return np.concatenate(firsts), np.concatenate(sizes)

    def pieces(self, end: float) -> Floats:
        """All of them over common pieces up to ``end``, (1 or m, k, columns), as the kernel takes them."""
        force = _added(curve(self.force), self.tangent)
        rate = curve(np.zeros(())) if self.speed is None else slope_of(_SPEEDS[self.prescribed], curve(self.speed))
        return pieces_of((force, curve(self.torque), rate, curve(self.brake)), end)


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
    from ..kernels.motion.load import FIRST, FUNCTIONS

    return np.zeros((1, 1, FIRST + FUNCTIONS)), np.zeros((4, 1)), NEITHER


def _added(one: Curve, more: Any) -> Curve:
    """A curve with a number, or one a motion, added."""
    flat = np.zeros((np.size(more), 1, one.terms.shape[-1]))
    flat[:, 0, 0] = more
    return one._replace(terms=one.terms + flat)


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
    prescribed = next((code for code, name in _SPEEDS.items() if getattr(drive, name) is not None), NEITHER)
    speed = checked_course(_SPEEDS[prescribed]) if prescribed else None
    courses = Courses(force, torque, brake, np.asarray(tangent), speed, prescribed)
    starts = {"omega": omega0, "V": V0}
    if prescribed:
        name = _SPEEDS[prescribed]
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
