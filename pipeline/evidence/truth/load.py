"""What drives a motion of :mod:`driven`, over pieces of time in which all of it is linear."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

from viscoroll.core.drive import Feedback, Schedule
from viscoroll.core.errors import one_of

Course = list[tuple[Any, Any]]


class Piece(NamedTuple):
    """What acts from ``start`` to ``end`` (tau), as (value at the start, slope over tau).

    rate : slope of the ``prescribed`` speed, "V" or "omega" ("" for none)
    gains : of force over V and omega, of torque over V and omega
    """

    start: Any
    end: Any
    force: tuple[Any, Any]
    torque: tuple[Any, Any]
    brake: tuple[Any, Any]
    rate: Any
    prescribed: str
    gains: tuple[Any, Any, Any, Any]

    @property
    def braked(self) -> bool:
        """Whether there is a brake."""
        return self.brake[0] > 0 or self.brake[1] != 0

    def at(self, tau: Any, V: Any, omega: Any) -> tuple[Any, Any, Any]:
        """(Force, torque, the most that the brake can take)."""
        force, torque, brake = (
            value + (tau - self.start) * slope for value, slope in (self.force, self.torque, self.brake)
        )
        per = self.gains
        return force + per[0] * V + per[1] * omega, torque + per[2] * V + per[3] * omega, brake


def course_of(arb: Any, given: Any, gamma: Any) -> Course:
    """Corners (tau, value) of a number or of a schedule, exact doubles as they are."""
    if isinstance(given, Feedback):
        given = given.value
    times, values = (given.times, given.values) if isinstance(given, Schedule) else ([0.0], [given])
    return [((gamma * arb(float(t))).mid(), arb(float(v))) for t, v in zip(times, values, strict=True)]


def pieces_of(drive: dict[str, Any], gamma: Any, tangent: Any, end: Any) -> list[Piece]:
    """Pieces up to the time ``end``; ``tangent`` of the slope is added to the force.

    Raises
    ------
    ParameterError
        Both speeds prescribed.
    """
    arb, prescribed = type(gamma), [name for name in ("V", "omega") if drive.get(name) is not None]
    if len(prescribed) > 1:
        raise one_of(prescribed[0], prescribed[1], both=True)
    names = ("force", "torque", "brake", *prescribed)
    courses = {name: course_of(arb, drive.get(name) or 0.0, gamma) for name in names}
    courses["force"] = [(tau, value + tangent) for tau, value in courses["force"]]
    corners = sorted({float(tau): tau for course in courses.values() for tau, _ in course if 0 < tau < end}.items())
    edges, pieces = [arb(0), *(tau for _, tau in corners), end], []
    given = [drive.get(name) for name in ("force", "torque")]
    gains = [arb(value) for one in given for value in ((one.V, one.omega) if isinstance(one, Feedback) else (0.0, 0.0))]
    for start, stop in pairwise(edges):
        linear = {name: _linear(course, start) for name, course in courses.items()}
        rate = linear[prescribed[0]][1] if prescribed else arb(0)
        pieces.append(
            Piece(
                start, stop, linear["force"], linear["torque"], linear["brake"], rate, "".join(prescribed), tuple(gains)
            )
        )
    return pieces


def _linear(course: Course, start: Any) -> tuple[Any, Any]:
    """(Value at the start of a piece, slope in it)."""
    for (first, low), (last, high) in pairwise(course):
        if first <= start < last:
            slope = ((high - low) / (last - first)).mid()
            return (low + (start - first) * slope).mid(), slope
    outside = course[0][1] if start < course[0][0] else course[-1][1]
    return outside, 0 * outside
