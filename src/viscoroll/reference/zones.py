"""The law explicit in the lengths of contact and stick zone, for :mod:`phases`: as balls, and beside them as doubles.

F, H, V of Eq. (6) and M of Eq. (16) at zeta; F, H at eta.  Derivatives in double precision, which
Newton's iteration for a motion needs, are those of the same formulas along an imaginary step.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..errors import ConvergenceError
from .enclosures import ratio_k, ratio_r

#: size of that step: its square is nothing beside any value
IMAGINARY = 1e-100
_MOST_STEPS = 60
#: relative error of zeta: Newton's iteration squares what is left by the last step
_LAST_STEP = 1e-24


class Law(NamedTuple):
    """Parameters and c = (alpha - 1)/alpha, as balls or as doubles."""

    alpha: Any
    c: Any
    kappa: Any
    mu: Any
    j: Any

    def doubles(self) -> Law:
        return Law(*map(float, self))


class Zone(NamedTuple):
    """F, H, their slopes, r(alpha z) and r k, at z = zeta (contact) or eta (stick zone)."""

    z: Any
    F: Any
    H: Any
    dF: Any
    dH: Any
    r: Any
    p: Any


def zone(z: Any, r: Any, k: Any, law: Law) -> Zone:
    """F = z + g and H = z^2 + 2 z h; slopes of r and k by their Riccati equations."""
    if law.c == 0 or z == 0:
        return Zone(z, z, z * z, 1 + 0 * z, 2 * z, 0 * z, 0 * z)
    p = r * k
    dr, dk = law.alpha * (1 - r / (law.alpha * z) - r * r), k * k + k / z - 1
    share = law.c / (1 + p)
    h, rise = share * r, (r * dk + k * dr) / (1 + p)
    return Zone(z, z + share * p, z * (z + 2 * h), 1 + share * rise, 2 * (z + h + z * share * (dr - r * rise)), r, p)


def ratios(z: Any, law: Law) -> tuple[Any, Any]:
    """r(alpha z) and k(z), where they are needed."""
    if law.c == 0 or z == 0:
        return 0 * z, 0 * z
    return ratio_r(law.alpha * z).mid(), ratio_k(z).mid()


def beside(z: Any, r: Any, k: Any, law: Law, step: float) -> Zone:
    """The zone at z moved by an imaginary step, in doubles; ``law`` in doubles too."""
    z, r, k = float(z), float(r), float(k)
    moved = z + step * IMAGINARY * 1j
    if law.c == 0.0 or z == 0.0:
        return zone(moved, 0.0, 0.0, law)
    dr, dk = law.alpha * (1.0 - r / (law.alpha * z) - r * r), k * k + k / z - 1.0
    return zone(moved, r + dr * (moved - z), k + dk * (moved - z), law)


def speed_and_moment(contact: Zone, law: Law) -> tuple[Any, Any]:
    """V of Eq. (6) and M of Eq. (16)."""
    V = 1 / (2 * law.kappa * contact.H**0.5)
    if law.c == 0:
        return V, 0 * V
    share = contact.z * contact.z / contact.H * (1 - 2 * contact.r / (law.alpha * contact.z))
    return V, V * law.c * (share + contact.p) / (1 + contact.p)


def contact_zone(V: Any, law: Law, near: Any = None) -> Zone:
    """The contact at V > 0: Eq. (6) by Newton's iteration on ln H over ln zeta, of slope 1 to 2.

    Raises
    ------
    ConvergenceError
        After 60 steps.
    """
    target = 1 / (2 * law.kappa * V) ** 2
    zeta = target.sqrt() if near is None else near
    for _ in range(_MOST_STEPS):
        contact = zone(zeta, *ratios(zeta, law), law)
        step = ((contact.H / target).log() * contact.H / (zeta * contact.dH)).mid()
        if abs(step) < _LAST_STEP:
            return contact
        zeta = (zeta * (-step).exp()).mid()
    raise ConvergenceError(f"roll_precise: no zeta at V = {V.str(10)}")


def sign(value: Any) -> int:
    """-1, 0 or 1."""
    return int(value > 0) - int(value < 0)
