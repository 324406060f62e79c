"""Full and partial slip of a driven motion for the integrator: equations of motion, ends, what acts.

Time is tau = gamma t.  The unknowns are s = 1/zeta with the sign of V, and omega in full slip; in partial slip s >= 0
and b = 1 - eta/zeta, with ``direction`` the sign of V and ``side`` that of delta.  With l = lam/(2 kappa)

    V = s l      omega - V = direction side mu V G      G = l s (F(zeta) - F(eta))

and the time derivative of the second, in which V b' stands alone, has no pole at V = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from viscoroll.core.errors import ConvergenceError

from .load import Piece
from .solid import Solid, Zone

#: of a bracket, to the last digit
_HALVINGS = 400
#: digits behind which 1/zeta is 0
_LEAST = 45
#: a stick zone of this share of the contact is none, as is a creep of this share of what is possible
_NOTHING = 1e-26
#: errors of b are measured by no less
_LEAST_B = 1e-8
#: share of the way to the end of a stick zone that one step may take, and first step into one
_APPROACH, _ENTRY = 0.9, 1e-12
#: first step over the time in which the unknowns change, and 1/zeta at the end of the first from V = 0
_FIRST, _OFF = 0.05, 1e-3
#: s at the end of a step, over that at its start, that is 0
_CLOSED = 1e-20


def sign(value: Any) -> int:
    """-1, 0 or 1."""
    return int(value > 0) - int(value < 0)


def root(rising: Any, low: Any, high: Any) -> Any:
    """Zero of a function that rises from below 0 at ``low``."""
    for _ in range(_HALVINGS):
        middle = ((low + high) / 2).mid()
        if not low < middle < high:
            break
        low, high = (low, middle) if rising(middle) > 0 else (middle, high)
    return ((low + high) / 2).mid()


class Law(NamedTuple):
    """A scene."""

    solid: Solid
    kappa: Any
    mu: Any
    j: Any

    def whole(self, s: Any) -> tuple[Zone, Any, Any, Any]:
        """(Zone of the contact, |s|, or what stands for 0: the contact of V = 0 is that of the least, l, dV/d|s|)."""
        size = max(abs(s), type(s)(10) ** -_LEAST)
        zone = self.solid.at(1 / size)
        pressed = 1 + 2 * zone.h * size
        length = 1 / (2 * self.kappa * pressed.sqrt())
        return zone, size, length, length * (pressed - zone.h * size + zone.dh) / pressed


class Contact(NamedTuple):
    """What a state is: speeds, friction, the parts of M, all with their signs."""

    V: Any
    omega: Any
    Q: Any
    M_half_space: Any
    M_cylinder: Any


@dataclass
class Phase:
    """What both regimes share; ``spin``: sign of omega that the brake acts against, ``locked``: it holds omega at 0.

    Each has unknowns(); contact(u), the state that they are; rates(u, tau): right sides, and what multiplies the slopes
    of the unknowns; sizes(values), what errors are measured by in a step; guess(after, tau) for Newton's iteration;
    first_step(tau), longest(tau); events(): functions that are positive before and the value that tells that they are
    not; moved(u, tau) after a step without an event, after(event, u, tau) behind one, None at V = omega = 0.
    """

    law: Law
    piece: Piece
    spin: int
    locked: bool

    def pushed(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(V', omega'), Eq. (22) with M/2 as each body's own part."""
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        d_V, d_omega = c.Q - c.M_half_space + force, (torque - self.spin * brake - c.Q - c.M_cylinder) / self.law.j
        if self.piece.prescribed == "V":
            d_V = self.piece.rate
        if self.piece.prescribed == "omega":
            d_omega = self.piece.rate
        return d_V, 0 * d_omega if self.locked else d_omega

    def paths(self, u: Any, tau: Any) -> list[Any]:
        """Rates of x, angle, work of force and torque, losses in brake and slip."""
        c = self.contact(u)
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        if self.piece.prescribed == "V":
            force = self.piece.rate - c.Q + c.M_half_space
        if self.piece.prescribed == "omega":
            torque = self.law.j * self.piece.rate + c.Q + c.M_cylinder
        lost = brake * abs(c.omega) * abs(self.spin)
        return [c.V, c.omega, force * c.V, torque * c.omega, lost, (c.omega - c.V) * c.Q]

    def excess(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(Torque that would turn a wheel that stands, the most that the brake can take of it)."""
        _, torque, brake = self.piece.at(tau, c.V, 0 * c.omega)
        return torque - c.Q - c.M_cylinder, brake


@dataclass
class Slipping(Phase):
    """Full slip; ``sigma`` the sign of omega - V, ``ahead`` that of V, or of V' where V = 0."""

    sigma: int
    ahead: int
    s: Any
    omega: Any

    regime = "full slip"

    def unknowns(self) -> list[Any]:
        return [self.s, self.omega]

    def _of(self, u: Any, zone: Zone, length: Any) -> Contact:
        V = u[0] * length
        return Contact(V, u[1], self.sigma * self.law.mu, V * zone.m_half_space, V * zone.m_cylinder)

    def contact(self, u: Any) -> Contact:
        zone, _, length, _ = self.law.whole(u[0])
        return self._of(u, zone, length)

    def rates(self, u: Any, tau: Any) -> tuple[list[Any], list[Any]]:
        zone, _, length, slope = self.law.whole(u[0])
        d_V, d_omega = self.pushed(self._of(u, zone, length), tau)
        return [d_V / slope, d_omega], [d_V * 0 + 1] * 2

    def sizes(self, values: Any) -> list[float]:
        """Largest speed, as s and as omega."""
        fastest = max(values, key=lambda u: abs(float(u[0])))[0]
        length = float(self.law.whole(fastest)[2])
        largest = max(abs(float(fastest)) * length, *(abs(float(u[1])) for u in values), 1e-200)
        return [largest / length, largest]

    def first_step(self, tau: Any) -> float:
        (d_s, d_omega), _ = self.rates(self.unknowns(), tau)
        if self.s == 0 and self.omega == 0:
            return _OFF / max(abs(float(d_s)), abs(float(d_omega)))
        size_s, size = self.sizes([self.unknowns()])
        return _FIRST / max(abs(float(d_s)) / size_s, abs(float(d_omega)) / size, 1e-300)

    def guess(self, after: list[Any], tau: Any) -> list[list[Any]]:
        """Both at their pace."""
        pace, _ = self.rates(self.unknowns(), tau)
        return [[(self.s + pace[0] * time).mid(), (self.omega + pace[1] * time).mid()] for time in after]

    def longest(self, _: Any) -> float:
        return float("inf")

    def events(self) -> dict[str, tuple[Any, float]]:
        found: dict[str, tuple[Any, float]] = {
            "reversal": (lambda u, _: self.ahead * u[0], 0.0),
            "edge": (self._edge, 0.0),
        }
        if self.locked:
            found["freed"] = (self._held, 0.0)
        elif self.spin:
            found["stop"] = (lambda u, _: self.spin * u[1], 0.0)
        return found

    def _edge(self, u: Any, _: Any) -> Any:
        """sigma (omega - V) - delta_star |V|, delta_star = mu V F(zeta)."""
        zone, size, length, _ = self.law.whole(u[0])
        V = u[0] * length
        return self.sigma * (u[1] - V) - self.law.mu * abs(V) * length * (1 + zone.g * size)

    def _held(self, u: Any, tau: Any) -> Any:
        excess, most = self.excess(self.contact(u), tau)
        return most - abs(excess)

    def moved(self, u: Any, _: Any) -> Phase:
        return replace(self, s=u[0], omega=u[1])

    def after(self, event: str, u: Any, tau: Any) -> Phase | None:
        """The phase behind an event; None at V = omega = 0."""
        s, omega = u
        if event == "edge" and abs(s) <= _CLOSED * abs(self.s):  # the stick band closes at V = 0: omega is 0 too
            return None
        if event == "edge":
            direction = sign(s)
            return Sticking(
                self.law, self.piece, self.spin, self.locked, direction, self.sigma * direction, abs(s), s * 0 + 1
            )
        if event == "reversal":
            s = 0 * s
            return None if self.locked else replace(self, s=s, omega=omega, ahead=-self.ahead)
        still = replace(self, s=s, omega=0 * omega, locked=False)
        excess, most = self.excess(still.contact(still.unknowns()), tau)
        if event == "stop" and abs(excess) <= most:
            return replace(still, locked=True)
        return replace(still, spin=sign(excess) if most > 0 else 0)


@dataclass
class Sticking(Phase):
    """Partial slip."""

    direction: int
    side: int
    s: Any
    b: Any

    regime = "partial slip"

    def unknowns(self) -> list[Any]:
        return [self.s, self.b]

    def _zones(self, u: Any) -> tuple[Any, ...]:
        """(Contact, stick zone, s, eta/zeta, l, dV/ds)."""
        contact, s, length, slope = self.law.whole(u[0])
        rest = 1 - u[1] if 1 - u[1] >= _NOTHING else 0 * s
        stick = self.law.solid.at(rest / s) if rest > 0 else Zone(*6 * [0 * s])
        return contact, stick, s, rest, length, slope

    def _of(self, zones: tuple[Any, ...]) -> tuple[Contact, Any]:
        """(Contact, G)."""
        zeta, eta, s, rest, length, _ = zones
        V = self.direction * s * length
        G = length * (1 - rest + s * (zeta.g - eta.g))
        pressed = 1 + 2 * zeta.h * s
        Q = self.direction * self.side * self.law.mu * (1 - (rest * rest + 2 * rest * s * eta.h) / pressed)
        omega = V + self.side * self.law.mu * V * G
        return Contact(V, omega, Q, V * zeta.m_half_space, V * zeta.m_cylinder), G

    def contact(self, u: Any) -> Contact:
        return self._of(self._zones(u))[0]

    def rates(self, u: Any, tau: Any) -> tuple[list[Any], list[Any]]:
        zones = self._zones(u)
        zeta, eta, s, rest, length, slope = zones
        c, G = self._of(zones)
        d_V, d_omega = (self.direction * rate for rate in self.pushed(c, tau))
        pressed = 1 + 2 * zeta.h * s
        # slopes in s at the same b
        d_length = -length * (zeta.h - zeta.dh / s) / pressed
        d_share = (zeta.g - zeta.dg / s) - (eta.g - rest * eta.dg / s)
        d_G = d_length * (G / length) + length * d_share
        right = self.side * (d_omega - d_V) / self.law.mu - d_V * (G + s * length * d_G / slope)
        return [d_V / slope, right / (length * (1 + eta.dg))], [0 * s + 1, s * length]

    def sizes(self, values: Any) -> list[float]:
        return [
            max(1e-300, *(abs(float(u[0])) for u in values)), max(_LEAST_B, *(abs(float(u[1])) for u in values)),
        ]  # fmt: skip

    def first_step(self, tau: Any) -> float:
        (d_s, right), (_, weight) = self.rates(self.unknowns(), tau)
        if not weight > 1e-30:
            return _OFF / float(abs(d_s)) if abs(d_s) > 1e-30 else _OFF
        if self.b == 1:
            return _ENTRY * float(weight / abs(right))
        step = type(right)(10) ** -15
        (_, beside), _ = self.rates([self.s, self.b + step], tau)
        pace = max(abs(float((beside - right) / step / weight)), abs(float(d_s / self.s)))
        return _FIRST / max(pace, 1e-300)

    def longest(self, tau: Any) -> float:
        """A share of the way to the end of the stick zone at the present rate."""
        (_, right), (_, weight) = self.rates(self.unknowns(), tau)
        if not weight > 0 or self.b == 1 or not right > 0:
            return float("inf")
        return _APPROACH * float((1 - self.b) * weight / right)

    def balance(self, tau: Any) -> tuple[Any, Any] | None:
        """(b with the sign of delta, V' along the direction) at V = 0; None where there is no balance.

        (omega' - V')/(mu l) = b V', F = z, H = z^2, l = 1/(2 kappa); the left side less the right one falls with b.
        """
        zero = 0 * tau

        def pulled(b: Any) -> tuple[Any, Any]:
            c = Contact(zero, zero, self.direction * self.law.mu * b * (2 - abs(b)), zero, zero)
            d_V, d_omega = (self.direction * rate for rate in self.pushed(c, tau))
            return b * d_V - (d_omega - d_V) * 2 * self.law.kappa / self.law.mu, d_V

        if not (pulled(zero - 1)[0] < 0 < pulled(zero + 1)[0]):
            return None
        b = root(lambda b: pulled(b)[0], zero - 1, zero + 1)
        return b, pulled(b)[1]

    def guess(self, after: list[Any], tau: Any) -> list[list[Any]]:
        """s at its pace, b as it is; from V = 0 on as the balance there has it."""
        if self.s > 0:
            pace = self.rates([self.s, self.b], tau)[0][0]
            return [[(self.s + pace * time).mid(), self.b] for time in after]
        found, at = [], self.balance(tau)
        for time in after:
            there = self.balance(tau + time) or at
            if at is None or there is None:
                raise ConvergenceError("roll_precise: no way out of rest was found")
            found.append([(self.law.kappa * (at[1] + there[1]) * time).mid(), abs(there[0])])
        return found

    def events(self) -> dict[str, tuple[Any, float]]:
        found: dict[str, tuple[Any, float]] = {
            "no creep": (lambda u, _: u[1], -_NOTHING),
            "rest": (lambda u, _: u[0], 0.0),
        }
        return found

    def moved(self, u: Any, tau: Any) -> Phase:
        """The state after a step; full slip where nothing sticks any more."""
        state = replace(self, s=u[0], b=u[1])
        if 1 - u[1] > _NOTHING or not self.rates(u, tau)[0][1] > 0:
            return state
        c = self.contact([u[0], 0 * u[1] + 1])
        ahead = self.direction
        return Slipping(
            self.law, self.piece, self.spin, self.locked, self.side * ahead, ahead, ahead * u[0], c.omega.mid()
        )

    def after(self, event: str, u: Any, _: Any) -> Phase | None:
        """Zero creep: the state after it; None at V = omega = 0."""
        return None if event == "rest" else replace(self, side=-self.side, s=u[0], b=0 * u[1])
