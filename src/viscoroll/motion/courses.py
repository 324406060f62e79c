"""What acts on motions over time, as pieces for the kernels, some motions at a time: :class:`Courses`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..core.checks import broadcast_shape
from ..core.typed import Floats
from ..kernels.motion.records import PRESCRIBED_OMEGA, PRESCRIBED_V
from .fitted import TERMS
from .schedule import Corners, Course, Curve, at_start, curve, motions_of, of_some, pieces_of, slope_of

#: by which name a speed is prescribed
SPEEDS = {PRESCRIBED_OMEGA: "omega", PRESCRIBED_V: "V"}
#: bytes of pieces that are made at a time where motions have their own: little beside the schedules, and yet many
#: motions at once where these are short
_BLOCK_BYTES = 1 << 18


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
        names = "force", "torque", "brake", "slope", SPEEDS.get(self.prescribed)
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
        columns = 2 + 5 * (TERMS if any(isinstance(one, Curve) for one in self.each.values()) else 2)
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
            slope_of(SPEEDS[self.prescribed], one)
            firsts.append(at_start(one.terms[:, 0]))
            sizes.append(np.abs(one.terms).sum(axis=-1).max(axis=1, initial=0.0))
        return np.concatenate(firsts), np.concatenate(sizes)

    def pieces(self, end: float) -> Floats:
        """All of them over common pieces up to ``end``, (1 or m, k, columns), as the kernel takes them."""
        force = _added(curve(self.force), self.tangent)
        speed = rate = curve(np.zeros(()) if self.speed is None else self.speed)
        if self.speed is not None:
            rate = slope_of(SPEEDS[self.prescribed], speed)
        return pieces_of((force, curve(self.torque), rate, curve(self.brake), speed), end)


def _added(one: Curve, more: Any) -> Curve:
    """A curve with a number, or one a motion, added."""
    flat = np.zeros((np.size(more), 1, one.terms.shape[-1]))
    flat[:, 0, 0] = more
    return one._replace(terms=one.terms + flat)
