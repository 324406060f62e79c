"""What drives a motion, made ready for the kernels: :class:`Drive`, :func:`prepared`."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.checks import broadcast_shape, checked
from ..core.drive import Feedback, Schedule, over, slope_factor
from ..core.errors import ParameterError, one_of
from ..core.labels import Labels, unlabelled
from ..core.scale import Scale
from ..core.typed import Floats
from .checks import start_speeds
from .schedule import Curve, at_start, curve, pieces_of, slope_of

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


class Prepared(NamedTuple):
    """A drive for the kernel, in T_ref: pieces (m, k, columns), gains (4, m), which speed is prescribed; start speeds,
    and the largest difference between a callable and its fit."""

    pieces: Floats
    gains: Floats
    prescribed: int
    V0: Any
    omega0: Any
    error: float

    def for_kernel(self, chosen: Any = slice(None)) -> tuple[NDArray, NDArray, int]:
        """Pieces, of the ``chosen`` motions where each has its own, gains, and which speed is prescribed."""
        pieces = self.pieces[chosen] if self.pieces.shape[0] > 1 else self.pieces
        gains = self.gains[:, chosen] if self.gains.shape[1] > 1 else self.gains
        return np.ascontiguousarray(pieces), np.ascontiguousarray(gains), self.prescribed


@cache
def undriven() -> tuple[Floats, Floats, int]:
    """Pieces and gains of nothing that drives, and which speed is prescribed."""
    from ..kernels.motion.load import FIRST, FUNCTIONS
    from ..kernels.motion.records import NEITHER

    return np.zeros((1, 1, FIRST + FUNCTIONS)), np.zeros((4, 1)), NEITHER


def _added(one: Curve, more: Any) -> Curve:
    """A curve with a number, or one a motion, added."""
    flat = np.zeros((np.size(more), 1, one.terms.shape[-1]))
    flat[:, 0, 0] = more
    return one._replace(terms=one.terms + flat)


def prepared(drive: Drive, V0: Any, omega0: Any, end: float, rtol: float) -> Prepared:
    """A drive without dimension up to the time ``end``.

    Raises
    ------
    ParameterError
        What is no drive (:func:`viscoroll.roll`); V and omega both prescribed, with what is then found given as well;
        a start that is not the prescribed one.
    """
    from ..kernels.motion.records import NEITHER, OMEGA, SPEED

    if not drive.acts:
        return Prepared(*undriven(), *start_speeds(V0, omega0), 0.0)
    tangent = slope_factor(drive.slope)[0]
    if drive.V is not None and drive.omega is not None:
        raise one_of("V", "omega", both=True)
    for name, by, why in _BESIDE:
        if getattr(drive, by) is not None and (beside := getattr(drive, name)) is not None:
            raise ParameterError(name, beside, "left out", f"{name} is given beside {by}=: leave it out, {why}")
    force = _added(curve("force", drive.force, end, rtol), tangent)
    torque = curve("torque", drive.torque, end, rtol)
    brake = curve("brake", drive.brake, end, rtol, low=0.0)
    rate = speed = curve("rate", None, end, rtol)
    prescribed, error = NEITHER, 0.0
    starts = {"omega": omega0, "V": V0}
    for code, name in ((OMEGA, "omega"), (SPEED, "V")):
        given = getattr(drive, name)
        if given is not None:
            speed = curve(name, given, end, rtol)
            rate, prescribed, error = slope_of(name, speed), code, speed.error
            # of a callable itself: its fit is off by rounding, and may be of the other sign
            own = np.array([float(given(0.0))]) if callable(given) else at_start(speed.terms[:, 0])
            starts[name] = _prescribed_start(f"{name}0", starts[name], speed, own)
        if starts[name] is None:
            raise ParameterError(f"{name}0", None, "a number", f"{name}0 is not given, and no {name}= prescribes it")
    pieces = pieces_of((force, torque, rate, brake, speed), end)
    error = max(error, force.error, torque.error, brake.error)
    return Prepared(pieces, _gains(drive), prescribed, *start_speeds(starts["V"], starts["omega"]), error)


def _prescribed_start(name: str, given: Any, speed: Curve, start: Floats) -> Any:
    """The start that a schedule prescribes, a number where it is one for all, of as many motions as were given one."""
    scale = float(np.abs(speed.terms).sum(axis=-1).max(initial=0.0))
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
    if rest > 0.0 and (drives.prescribed or drives.gains.any() or drives.pieces[:, -1, 2:].any()):
        sentence = f"rest = {rest:g} is given, but something drives the motion to its end: leave it out"
        sentence += " (what a brake stops and holds is at rest in finite time: switches say when)"
        raise ParameterError("rest", rest, "None", sentence)
