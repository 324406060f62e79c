"""Where a driven motion begins, and how it leaves V = omega = 0, for :mod:`driven`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from viscoroll.core.errors import ConvergenceError

from .load import Piece
from .phases import Contact, Law, Phase, Slipping, Sticking, root, sign

#: share of a piece behind which it is looked at where it begins with what moves nothing, and parts of it looked at
_SOON, _PARTS = 1e-6, 64


def begun(law: Law, piece: Piece, V: Any, omega: Any) -> Phase | None:
    """The phase of a start; None at rest."""
    if V == 0 and omega == 0:
        return None
    zero, slip = 0 * V, omega - V
    spin = sign(omega) if piece.braked else 0
    slipping = Slipping(law, piece, spin, False, sign(slip) or 1, sign(V), zero, omega)
    if V == 0:
        d_V, _ = slipping.pushed(slipping.contact([zero, omega]), piece.start)
        slipping.ahead = sign(d_V) or 1
        return slipping
    s = root(lambda s: abs(slipping.contact([s, omega]).V) - abs(V), zero, 4 * law.kappa * abs(V) * _stiffness(law))
    slipping.s = s * sign(V)
    if not slipping.events()["edge"][0](slipping.unknowns(), zero) < 0:
        return slipping
    sticking = Sticking(law, piece, spin, False, sign(V), sign(slip) * sign(V) or 1, s, zero)
    if slip != 0:
        sticking.b = root(lambda b: abs(_slip_of(sticking, s, b)) - abs(slip), zero, zero + 1)
    elif sticking.rates([s, zero], piece.start)[0][1] < 0:
        sticking.side = -sticking.side
    return sticking


def _stiffness(law: Law) -> Any:
    """alpha: lam is at least 1/sqrt(alpha)."""
    product = law.kappa / law.kappa
    for a, b in zip(law.solid.a, law.solid.b, strict=True):
        product *= a / b
    return product


def _slip_of(sticking: Sticking, s: Any, b: Any) -> Any:
    c = sticking.contact([s, b])
    return c.omega - c.V


def _held(piece: Piece, law: Law, tau: Any) -> Any:
    """How much more it would take to move the cylinder from V = omega = 0; negative where it moves."""
    zero = 0 * tau
    force, torque, brake = piece.at(tau, zero, zero)
    if piece.prescribed:
        needs = -force if piece.prescribed == "omega" else torque
        return law.mu - abs(needs) if piece.rate == 0 else zero - 1
    return min(law.mu - abs(force), brake - abs(force + torque))


def leaving(piece: Piece, law: Law, tau: Any) -> Any:
    """When a cylinder at rest is first moved, at most the end of the piece."""
    low, length = tau, piece.end - tau
    for n in range(_PARTS + 1):
        high = (tau + length * (n / _PARTS if n else _SOON)).mid()
        if _held(piece, law, high) < 0:
            return root(lambda at: -_held(piece, law, at), low, high) if n else tau
        low = high
    return piece.end


def departed(piece: Piece, law: Law, tau: Any) -> Phase:
    """The phase that leaves rest at tau."""
    soon, braked = (tau + (piece.end - tau) * _SOON).mid(), piece.braked
    for direction in (1, -1):
        state = Sticking(law, piece, direction * braked, False, direction, 1, 0 * tau, 0 * tau)
        there, now = state.balance(soon), state.balance(tau)
        if there is not None and now is not None and there[1] > 0:
            side = sign(there[0]) or 1
            return replace(state, side=side, b=max(side * now[0], 0 * tau))
    for sigma in (1, -1):
        zero = 0 * tau
        c = Contact(zero, zero, sigma * law.mu, zero, zero)
        still = Slipping(law, piece, 0, False, sigma, 1, 0 * tau, 0 * tau)
        excess, most = still.excess(c, soon)
        spin = sign(excess) if braked and abs(excess) > most else 0
        slipping = Slipping(law, piece, spin, braked and spin == 0, sigma, 1, 0 * tau, 0 * tau)
        d_V, d_omega = slipping.pushed(c, soon)
        if sigma * (d_omega - d_V) > 0:
            slipping.ahead = sign(d_V) or 1
            return slipping
    raise ConvergenceError("roll_precise: no way out of rest was found")
