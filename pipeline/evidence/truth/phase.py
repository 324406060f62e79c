"""What both regimes of :mod:`phases` share: the scene, the equations of motion, what acts."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from .load import Piece
from .solid import Solid, Zone

#: of a bracket, to the last digit
_HALVINGS = 400
#: digits behind which 1/zeta is 0
_LEAST = 45

Events = dict[str, tuple[Callable[[Sequence[Any], Any], Any], float]]


def sign(value: Any) -> int:
    """-1, 0 or 1."""
    return int(value > 0) - int(value < 0)


class Law(NamedTuple):
    """A scene."""

    solid: Solid
    kappa: Any
    mu: Any
    j: Any


class Contact(NamedTuple):
    """What a state is: speeds, friction, the parts of M, all with their signs."""

    V: Any
    omega: Any
    Q: Any
    M_half_space: Any
    M_cylinder: Any


@dataclass
class Phase(ABC):
    """What both regimes share; ``spin``: sign of omega that the brake acts against, ``locked``: it holds omega at 0."""

    law: Law
    piece: Piece
    spin: int
    locked: bool

    regime: ClassVar[str]

    @abstractmethod
    def unknowns(self) -> list[Any]:
        """The two of them."""

    @abstractmethod
    def contact(self, u: Sequence[Any]) -> Contact:
        """The state that they are."""

    @abstractmethod
    def rates(self, u: Sequence[Any], tau: Any) -> tuple[list[Any], list[Any]]:
        """(Right sides, what multiplies the slopes of the unknowns)."""

    @abstractmethod
    def sizes(self, values: Sequence[Sequence[Any]]) -> list[float]:
        """What errors of the unknowns are measured by in a step with these values."""

    @abstractmethod
    def guess(self, after: list[Any], tau: Any) -> list[list[Any]]:
        """Unknowns for Newton's iteration, at these times after tau."""

    @abstractmethod
    def first_step(self, tau: Any) -> float:
        """Length to try first."""

    @abstractmethod
    def longest(self, tau: Any) -> float:
        """Most that a step may be long."""

    @abstractmethod
    def events(self) -> Events:
        """What ends the phase: functions that are positive before, and the value that tells that they are not."""

    @abstractmethod
    def moved(self, u: Sequence[Any], tau: Any) -> Phase:
        """The state after a step without an event."""

    @abstractmethod
    def after(self, event: str, u: Sequence[Any], tau: Any) -> Phase | None:
        """The phase behind an event; None at V = omega = 0."""

    def pushed(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(V', omega'), Eq. (22) with M/2 as each body's own part."""
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        d_V, d_omega = c.Q - c.M_half_space + force, (torque - self.spin * brake - c.Q - c.M_cylinder) / self.law.j
        if self.piece.prescribed == "V":
            d_V = self.piece.rate
        if self.piece.prescribed == "omega":
            d_omega = self.piece.rate
        return d_V, 0 * d_omega if self.locked else d_omega

    def paths(self, u: Sequence[Any], tau: Any) -> list[Any]:
        """Rates of x, angle, work of force and torque, losses in brake and slip."""
        c = self.contact(u)
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        if self.piece.prescribed == "V":
            force = self.piece.rate - c.Q + c.M_half_space
        if self.piece.prescribed == "omega":
            torque = self.law.j * self.piece.rate + c.Q + c.M_cylinder
        return [
            c.V,
            c.omega,
            force * c.V,
            torque * c.omega,
            brake * abs(c.omega) * abs(self.spin),
            (c.omega - c.V) * c.Q,
        ]

    def excess(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(Torque that would turn a wheel that stands, the most that the brake can take of it)."""
        _, torque, brake = self.piece.at(tau, c.V, 0 * c.omega)
        return torque - c.Q - c.M_cylinder, brake


def root(rising: Any, low: Any, high: Any) -> Any:
    """Zero of a function that rises from below 0 at ``low``."""
    for _ in range(_HALVINGS):
        middle = ((low + high) / 2).mid()
        if not low < middle < high:
            break
        low, high = (low, middle) if rising(middle) > 0 else (middle, high)
    return ((low + high) / 2).mid()


def positive(s: Any) -> Any:
    """1/zeta, or what stands for 0: the contact of V = 0 is that of the least."""
    least = type(s)(10) ** -_LEAST
    return s if s > least else least


def slope_of_V(zone: Zone, s: Any, length: Any) -> Any:
    """dV/ds of V = s l."""
    return length * (1 + zone.h * s + zone.dh) / (1 + 2 * zone.h * s)
