"""Full and partial slip of a motion in extended precision: what a state is, what acts on it, what ends it.

Time is tau = gamma t.  A state is s = 1/zeta along ``ahead``, and omega - V in full slip, b = 1 - eta/zeta in partial
slip.  With l = lam/(2 kappa)

    V = s l      omega - V = mu s l G      G = l s (F(zeta) - F(eta))
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from flint import arb

from .enclosures import zone_of
from .load import Piece
from .material import Material

#: of a bracket, to the last digit
_HALVINGS = 400
#: 1/zeta below which it is 0, and the share of the contact below which a stick zone is none
_LEAST, NOTHING = arb("1e-40").mid(), 1e-26
#: s at the end of a step, over that at its start, that is 0
_CLOSED = 1e-20
#: share of a piece behind which it is looked at where it begins with what moves nothing
_SOON = 1e-6


def sign(value: Any) -> int:
    """-1, 0 or 1."""
    return int(value > 0) - int(value < 0)


def root(rising: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Zero of a function that rises from below 0 at ``low``."""
    for _ in range(_HALVINGS):
        middle = ((low + high) / 2).mid()
        if not low < middle < high:
            break
        low, high = (low, middle) if rising(middle) > 0 else (middle, high)
    return ((low + high) / 2).mid()


class Law(NamedTuple):
    """A scene."""

    material: Material
    kappa: Any
    mu: Any
    j: Any


class Contact(NamedTuple):
    """What a state is: V, omega - V, friction, the parts of M, with their signs; the least omega - V of full slip."""

    V: Any
    slip: Any
    Q: Any
    M_half_space: Any
    M_cylinder: Any
    limit: Any

    @property
    def omega(self) -> Any:
        return self.V + self.slip


@dataclass
class Phase:
    """A regime and the state in it.

    spin : sign of omega that the brake acts against; ``locked`` : it holds omega at 0
    sticks : whether a part of the contact does
    ahead : sign of V, or of V' where V = 0; ``sigma`` : sign of omega - V
    u : the state
    """

    law: Law
    piece: Piece
    spin: int
    locked: bool
    sticks: bool
    ahead: int
    sigma: int
    u: list[Any]

    @property
    def regime(self) -> str:
        return "locked" if self.locked else "partial slip" if self.sticks else "full slip"

    def contact(self, u: list[Any] | None = None) -> Contact:
        """What a state is, its own if none is given."""
        s, other = u or self.u
        _, kappa, mu, _ = self.law
        size = max(abs(s), _LEAST)
        whole = zone_of(self.law.material, 1 / size)
        pressed = 1 + 2 * whole.h * size
        length = 1 / (2 * kappa * pressed.sqrt())
        V, slip, Q = self.ahead * s * length, other, self.sigma * mu
        if self.sticks:
            rest, g, h = 1 - other, 0, 0
            if rest >= NOTHING:
                stick = zone_of(self.law.material, (rest / size).mid())
                g, h = stick.g, stick.h
            slip = self.sigma * mu * s * length**2 * (other + size * (whole.g - g))
            Q *= 1 - (rest * rest + 2 * rest * size * h) / pressed
        limit = mu * abs(V) * length * (1 + whole.g * size)
        return Contact(*(value.mid() for value in (V, slip, Q, V * whole.parts[0], V * whole.parts[1], limit)))

    def pushed(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(V', omega' - V'), Eq. (22) with M/2 as each body's own part."""
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        d_V, d_omega = c.Q - c.M_half_space + force, (torque - self.spin * brake - c.Q - c.M_cylinder) / self.law.j
        if self.piece.prescribed == "V":
            d_V = self.piece.rate
        if self.piece.prescribed == "omega":
            d_omega = self.piece.rate
        return d_V, (0 if self.locked else d_omega) - d_V

    def paths(self, u: list[Any], tau: Any) -> list[Any]:
        """Rates of x, angle, work of force and torque, losses in brake and slip."""
        c = self.contact(u)
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        if self.piece.prescribed == "V":
            force = self.piece.rate - c.Q + c.M_half_space
        if self.piece.prescribed == "omega":
            torque = self.law.j * self.piece.rate + c.Q + c.M_cylinder
        lost = brake * abs(c.omega) * abs(self.spin)
        return [c.V, c.omega, force * c.V, torque * c.omega, lost, c.slip * c.Q]

    def _held(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(Torque that would turn a wheel that stands, what the brake can take beyond it)."""
        _, torque, brake = self.piece.at(tau, c.V, 0)
        excess = torque - c.Q - c.M_cylinder
        return excess, brake - abs(excess)

    def events(self) -> dict[str, Callable[[list[Any], Any], Any]]:
        """Functions that are positive, or 0 at first, before."""
        if self.sticks:
            return {"no creep": lambda u, _: u[1], "rest": lambda u, _: u[0]}

        def edge(u: list[Any], _: Any) -> Any:
            c = self.contact(u)
            return self.sigma * c.slip - c.limit

        found = {"reversal": lambda u, _: u[0], "edge": edge}
        if self.locked:
            found["freed"] = lambda u, tau: self._held(self.contact(u), tau)[1]
        elif self.spin:
            found["stop"] = lambda u, _: self.spin * self.contact(u).omega
        return found

    def after(self, event: str | None, u: list[Any], tau: Any) -> Phase | None:
        """The phase behind a step, which ends on an event or none; None at V = omega = 0."""
        s, other = u
        if event is None:
            if self.sticks and 1 - other <= NOTHING and other > self.u[1]:
                return replace(self, sticks=False, u=[s, self.contact([s, arb(1)]).slip])
            return replace(self, u=u)
        if event == "no creep":
            return replace(self, sigma=-self.sigma, u=[s, arb(0)])
        if event == "edge" and s > _CLOSED * abs(self.u[0]):
            return replace(self, sticks=True, u=[s, arb(1)])
        if event in ("rest", "edge"):  # the stick band closes at V = 0: omega is 0 too
            return None
        if event == "reversal":
            return None if self.locked else replace(self, u=[arb(0), other], ahead=-self.ahead)
        still = replace(self, u=[s, -self.contact(u).V], locked=False)
        excess, beyond = still._held(still.contact(), tau)
        if event == "stop" and beyond >= 0:
            return replace(still, locked=True)
        return replace(still, spin=sign(excess) if self.piece.braked else 0)

    def under(self, piece: Piece, tau: Any) -> Phase:
        """The same under the next piece of the drive."""
        moved = replace(self, piece=piece)
        c = moved.contact()
        excess, beyond = moved._held(c, tau)
        if self.locked and beyond < 0:
            return replace(moved, locked=False, spin=sign(excess) if piece.braked else 0)
        return moved if self.locked else replace(moved, spin=sign(c.omega) if piece.braked else 0)

    def balance(self, tau: Any) -> tuple[Any, Any] | None:
        """(b with the sign of delta, V' along ``ahead``) at V = 0; None where there is no balance.

        (omega' - V')/(mu l) = b V', F = z, H = z^2, l = 1/(2 kappa); the left side less the right one falls with b.
        """

        def pulled(b: Any) -> tuple[Any, Any]:
            c = Contact(0, 0, self.ahead * self.law.mu * b * (2 - abs(b)), 0, 0, 0)
            d_V, d_slip = (self.ahead * rate for rate in self.pushed(c, tau))
            return b * d_V - d_slip * 2 * self.law.kappa / self.law.mu, d_V

        if not (pulled(arb(-1))[0] < 0 < pulled(arb(1))[0]):
            return None
        b = root(lambda b: pulled(b)[0], arb(-1), arb(1))
        return b, pulled(b)[1]

    def guess(self, times: list[Any], tau: Any) -> list[list[Any]]:
        """States some times later: in partial slip as now, from V = 0 as the balance has it; else at their pace."""
        kappa = self.law.kappa
        if not self.sticks:
            d_V, d_slip = self.pushed(self.contact(), tau)
            pace = 2 * kappa * self.ahead * d_V, d_slip
            return [[(part + rate * time).mid() for part, rate in zip(self.u, pace, strict=True)] for time in times]
        at = self.balance(tau) if self.u[0] == 0 else None
        if at is None:
            return [self.u for _ in times]
        there = [self.balance(tau + time) or at for time in times]
        return [[(kappa * (at[1] + a) * time).mid(), abs(b)] for (b, a), time in zip(there, times, strict=True)]


def begun(law: Law, piece: Piece, V: Any, omega: Any) -> Phase | None:
    """The phase of a start; None at rest."""
    if V == 0 and omega == 0:
        return None
    slip, none = omega - V, arb(0)
    phase = Phase(law, piece, sign(omega) if piece.braked else 0, False, False, sign(V), sign(slip) or 1, [none, slip])
    if V == 0:
        return replace(phase, ahead=sign(phase.pushed(phase.contact(), none)[0]) or 1)
    most = 4 * law.kappa * abs(V)
    for a, b in zip(law.material.a, law.material.b, strict=True):  # lam is at least 1/sqrt(alpha)
        most *= a / b
    s = root(lambda s: abs(phase.contact([s, slip]).V) - abs(V), none, most)
    phase.u = [s, slip]
    if abs(slip) >= phase.contact().limit:
        return phase
    phase = replace(phase, sticks=True, u=[s, none])
    if slip == 0:
        return replace(phase, sigma=sign(phase.pushed(phase.contact(), none)[1]) or 1)
    return replace(phase, u=[s, root(lambda b: abs(phase.contact([s, b]).slip) - abs(slip), none, arb(1))])


def leaving(piece: Piece, law: Law, tau: Any) -> Any:
    """When a cylinder at rest is first moved, at most the end of the piece."""

    def moves(at: Any) -> Any:
        """Positive where it does; convex in time."""
        force, torque, brake = piece.at(at, 0, 0)
        if piece.prescribed:
            needs = -force if piece.prescribed == "omega" else torque
            return abs(needs) - law.mu if piece.rate == 0 else arb(1)
        return -min(law.mu - abs(force), brake - abs(force + torque))

    soon = (tau + (piece.end - tau) * _SOON).mid()
    if moves(soon) > 0:
        return tau
    return root(moves, soon, piece.end) if moves(piece.end) > 0 else piece.end


def departed(piece: Piece, law: Law, tau: Any) -> Phase:
    """The phase that leaves rest at tau."""
    soon, braked = (tau + (piece.end - tau) * _SOON).mid(), piece.braked
    for ahead in (1, -1):
        phase = Phase(law, piece, ahead * braked, False, True, ahead, ahead, [arb(0), arb(0)])
        there, now = phase.balance(soon), phase.balance(tau)
        if there is not None and now is not None and there[1] > 0:
            side = sign(there[0]) or 1
            return replace(phase, sigma=side * ahead, u=[arb(0), max(side * now[0], arb(0))])
    for sigma in (1, -1):
        phase = Phase(law, piece, 0, False, False, 1, sigma, [arb(0), arb(0)])
        c = phase.contact()
        excess, beyond = phase._held(c, soon)
        spin = sign(excess) if braked and beyond < 0 else 0
        phase = replace(phase, spin=spin, locked=braked and spin == 0)
        d_V, d_slip = phase.pushed(c, soon)
        if sigma * d_slip > 0:
            return replace(phase, ahead=sign(d_V) or 1)
    raise AssertionError("no way out of rest")
