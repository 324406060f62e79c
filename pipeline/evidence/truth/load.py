"""What drives a motion, over pieces of time in which all of it is linear."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

from flint import arb

from viscoroll.core.drive import Feedback, Schedule

NAMES = ("force", "torque", "brake", "V", "omega")


class Piece(NamedTuple):
    """What acts from ``start`` to ``end`` (tau).

    lines : names -> (value at the start, slope over tau)
    prescribed : the speed that is, "" for none
    gains : of force over V and omega, of torque over V and omega
    """

    start: Any
    end: Any
    lines: dict[str, tuple[Any, Any]]
    prescribed: str
    gains: list[Any]

    @property
    def braked(self) -> bool:
        """Whether there is a brake."""
        return any(part != 0 for part in self.lines["brake"])

    @property
    def rate(self) -> Any:
        """Slope of the prescribed speed."""
        return self.lines[self.prescribed][1]

    def at(self, tau: Any, V: Any, omega: Any) -> tuple[Any, Any, Any]:
        """(Force, torque, the most that the brake can take)."""
        values = (value + (tau - self.start) * slope for value, slope in self.lines.values())
        (force, torque, brake, *_), per = values, self.gains
        return force + per[0] * V + per[1] * omega, torque + per[2] * V + per[3] * omega, brake


def pieces_of(drive: dict[str, Any], gamma: Any, tangent: Any, end: Any) -> list[Piece]:
    """Pieces up to the time ``end``; ``tangent`` of the slope is added to the force."""
    courses, gains = {}, []
    for name in NAMES:
        given = drive.get(name) or 0.0
        if name in ("force", "torque"):
            gains += [arb(given.V), arb(given.omega)] if isinstance(given, Feedback) else [arb(0)] * 2
        given = given.value if isinstance(given, Feedback) else given
        times, values = (given.times, given.values) if isinstance(given, Schedule) else ([0.0], [given])
        more = tangent if name == "force" else 0
        pairs = zip(times, values, strict=True)
        courses[name] = [((gamma * arb(float(t))).mid(), arb(float(v)) + more) for t, v in pairs]
    prescribed = "".join(name for name in ("V", "omega") if drive.get(name) is not None)
    corners = {float(tau): tau for course in courses.values() for tau, _ in course if 0 < tau < end}
    edges = [arb(0), *(tau for _, tau in sorted(corners.items())), end]
    return [
        Piece(start, stop, {name: _linear(course, start) for name, course in courses.items()}, prescribed, gains)
        for start, stop in pairwise(edges)
    ]


def _linear(course: list[tuple[Any, Any]], start: Any) -> tuple[Any, Any]:
    """(Value at the start of a piece, slope in it)."""
    for (first, low), (last, high) in pairwise(course):
        if first <= start < last:
            slope = ((high - low) / (last - first)).mid()
            return (low + (start - first) * slope).mid(), slope
    return course[0 if start < course[0][0] else -1][1], arb(0)
