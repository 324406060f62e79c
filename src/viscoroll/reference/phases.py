"""Full and partial slip, Eq. (22), for the integrator of :mod:`motion`: what changes, how fast, what ends it.

Time is tau = gamma t.  Sliding: Q = sigma mu, V - j omega is linear in time, V is the one unknown; zeta
by a root solve of Eq. (6) at every V.  Sticking, seen with V > 0 and with sign(omega - V) fixed: unknowns
ln zeta and D = zeta - eta, in which Eqs. (6), (10), (15), (16) need no root.  Formulas go on smoothly
beyond the end of a phase, so that a step may pass it and be cut back.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from .enclosures import stick_length
from .zones import IMAGINARY, Law, Zone, beside, contact_zone, ratios, sign, speed_and_moment, zone

#: D beyond zero by this share of min(1, zeta) has changed its sign, and is no end of a decay
_NO_CREEP = 1e-24
#: errors of D are measured by no less than this share of min(1, zeta)
_LEAST_D = 1e-8
#: a stick zone of this share of the contact is none
_NO_STICK = 1e-24
#: share of the way to the end of a stick zone that one step may take, and first step into one: F bends there
#: like eta^2 ln eta
_APPROACH, _ENTRY = 0.9, 1e-10

#: name -> function of (unknowns, time after the start), positive before the event, and the value that tells it
Events = dict[str, tuple[Callable[[Sequence[Any], Any], Any], float]]


@dataclass
class Sliding:
    """Full slip from (V, omega), with ``sigma`` the sign of omega - V."""

    law: Law
    sigma: int
    V: Any
    omega: Any
    _near: Any = field(default=None, repr=False)

    regime = "full slip"

    def unknowns(self) -> list[Any]:
        return [self.V]

    def _contact(self, V: Any) -> Zone:
        found = contact_zone(abs(V), self.law, self._near)
        self._near = found.z
        return found

    def rates(self, u: Sequence[Any]) -> tuple[list[Any], NDArray]:
        push, V = self.sigma * self.law.mu, u[0]
        if V == 0 or self.law.c == 0:
            return [push], np.array([[-0.5 * float(self.law.c)]])
        contact, few = self._contact(V), self.law.doubles()
        _, M = speed_and_moment(contact, self.law)
        near = beside(contact.z, *ratios(contact.z, self.law), few, float(contact.z))
        dV, dM = (value.imag for value in speed_and_moment(near, few))
        return [push - sign(V) * M / 2], np.array([[-0.5 * dM / dV]])

    def slopes(self, _: Any) -> list[Any]:
        """Rates at the start."""
        return self.rates(self.unknowns())[0]

    def speeds(self, u: Sequence[Any], tau: Any) -> tuple[Any, Any]:
        """(V, omega) after the time tau."""
        return u[0], self.omega + (u[0] - self.V - 2 * self.sigma * self.law.mu * tau) / self.law.j

    def sizes(self, values: Sequence[Sequence[Any]], taus: Sequence[Any]) -> list[float]:
        """What errors of the unknowns are measured by."""
        return [min(max(abs(float(s)) for s in self.speeds(u, tau)) for u, tau in zip(values, taus, strict=True))]

    def first_step(self) -> float:
        size = float(max(abs(self.V), abs(self.omega)))
        return 0.01 * size / (float(self.law.mu) + size)

    def longest(self) -> float:
        return np.inf

    def events(self) -> Events:
        return {"reversal": (self._reversal, 0.0), "onset": (self._onset, 0.0)}

    def _reversal(self, u: Sequence[Any], _: Any) -> Any:
        return (sign(self.V) or self.sigma) * u[0]

    def _onset(self, u: Sequence[Any], tau: Any) -> Any:
        """sigma (omega - V) - delta_star |V|; Eq. (9): delta_star = mu V F(zeta)."""
        V, omega = self.speeds(u, tau)
        limit = self.law.mu * V * V * self._contact(V).F if V != 0 else 0
        return self.sigma * (omega - V) - limit

    def moved(self, u: Sequence[Any], tau: Any) -> Sliding:
        V, omega = self.speeds(u, tau)
        return Sliding(self.law, self.sigma, V, omega.mid(), self._near)

    def after(self, event: str, u: Sequence[Any], tau: Any) -> Sliding | Sticking:
        V, omega = self.speeds(u, tau)
        if event == "reversal":
            return Sliding(self.law, self.sigma, 0 * V, omega.mid())
        zeta = self._contact(V).z
        return Sticking(self.law, sign(V), self.sigma * sign(V), zeta.log().mid(), zeta)


@dataclass
class Sticking:
    """Partial slip, with ``direction`` the sign of V and ``side`` that of the creep delta."""

    law: Law
    direction: int
    side: int
    y: Any
    D: Any

    regime = "partial slip"

    def unknowns(self) -> list[Any]:
        return [self.y, self.D]

    def _change(self, zones: tuple[Zone, Zone], law: Law) -> tuple[Any, Any, Any]:
        """Rates of ln zeta, zeta - eta and eta."""
        contact, stick = zones
        V, M = speed_and_moment(contact, law)
        Q = self.side * law.mu * (1 - stick.H / contact.H)
        dV, d_omega = Q - M / 2, -(Q + M / 2) / law.j
        d_zeta = -2 * contact.H * dV / (V * contact.dH)
        # of omega - V = side mu V^2 (F(zeta) - F(eta))
        d_gap = (self.side * (d_omega - dV) / law.mu - 2 * V * dV * (contact.F - stick.F)) / (V * V)
        d_eta = (contact.dF * d_zeta - d_gap) / stick.dF
        return d_zeta / contact.z, d_zeta - d_eta, d_eta

    def _zones(self, u: Sequence[Any]) -> tuple[Zone, Zone]:
        """Contact and stick zone; raises ConvergenceError where an iteration has left what is possible."""
        zeta = u[0].exp().mid()
        eta = (zeta - u[1]).mid()
        if abs(eta) < _NO_STICK * zeta:
            eta = 0 * eta
        if not (zeta.is_finite() and eta >= 0):
            raise ConvergenceError("roll_precise: a stick zone of negative length")
        return zone(zeta, *ratios(zeta, self.law), self.law), zone(eta, *ratios(eta, self.law), self.law)

    def rates(self, u: Sequence[Any]) -> tuple[list[Any], NDArray]:
        zones = self._zones(u)
        few, matrix = self.law.doubles(), np.empty((2, 2))
        zeta = float(zones[0].z)
        for m, steps in enumerate(((zeta, zeta), (0.0, -1.0))):
            near = [beside(z.z, z.r, z.p / z.r if z.r else z.r, few, step) for z, step in zip(zones, steps)]
            matrix[:, m] = [rate.imag / IMAGINARY for rate in self._change((near[0], near[1]), few)[:2]]
        return list(self._change(zones, self.law)[:2]), matrix

    def slopes(self, h: Any) -> list[Any]:
        """Rates at the start, for a first guess of a step of length h: none of D where that stands still soon."""
        (d_y, d_D), matrix = self.rates(self.unknowns())
        return [d_y, 0 * d_D if float(h) * np.abs(matrix).max() > 1.0 else d_D]

    def speeds(self, u: Sequence[Any], _: Any) -> tuple[Any, Any]:
        contact, stick = self._zones(u)
        V, _ = speed_and_moment(contact, self.law)
        omega = V + self.side * self.law.mu * V * V * (contact.F - stick.F)
        return (self.direction * V).mid(), (self.direction * omega).mid()

    def sizes(self, values: Sequence[Sequence[Any]], _: Any) -> list[float]:
        zeta = float(values[-1][0].exp())
        return [1.0, max(_LEAST_D * min(1.0, zeta), *(abs(float(u[1])) for u in values))]

    def first_step(self) -> float:
        zones = self._zones(self.unknowns())
        if zones[1].z == 0:
            return _ENTRY * float(zones[0].z / abs(self._change(zones, self.law)[2]))
        return 0.1 / float(np.abs(self.rates(self.unknowns())[1]).max())

    def longest(self) -> float:
        """A share of the way to the end of the stick zone at the present rate."""
        zones = self._zones(self.unknowns())
        eta, fall = zones[1].z, -self._change(zones, self.law)[2]
        return _APPROACH * float(eta / fall) if eta > 0 and fall > 0 else np.inf

    def events(self) -> Events:
        return {"no creep": (self._creep, -_NO_CREEP)}

    def _creep(self, u: Sequence[Any], _: Any) -> Any:
        """D over min(1, zeta)."""
        return u[1] if u[0] > 0 else u[1] / u[0].exp()

    def moved(self, u: Sequence[Any], tau: Any) -> Sliding | Sticking:
        """The state after the time tau; full slip where nothing sticks any more."""
        zones = self._zones(u)
        if zones[1].z > 0 or self._change(zones, self.law)[2] > 0:
            return Sticking(self.law, self.direction, self.side, *u)
        return Sliding(self.law, self.side * self.direction, *self.speeds(u, tau))

    def after(self, _: str, u: Sequence[Any], __: Any) -> Sticking:
        """Zero creep: the state after it."""
        return Sticking(self.law, self.direction, -self.side, u[0], 0 * u[1])


def begin(law: Law, V: Any, omega: Any) -> Sliding | Sticking:
    """The phase that a motion begins with."""
    slip = omega - V
    if V == 0:
        return Sliding(law, sign(slip), V, omega)
    contact = contact_zone(abs(V), law)
    rear = (contact.F - abs(slip) / (law.mu * V * V)).mid()
    if not rear > 0:
        return Sliding(law, sign(slip), V, omega)
    # without creep, V (omega - V)' = M V (j - 1)/(2 j)
    side = sign(slip) * sign(V) or sign(law.j - 1) or 1
    eta = contact.z if slip == 0 else stick_length(rear, law.alpha)
    if eta is None:
        raise ConvergenceError("roll_precise: no stick zone found for the start")
    return Sticking(law, sign(V), side, contact.z.log().mid(), (contact.z - eta).mid())
