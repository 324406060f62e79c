"""The record of a law that every reader takes, places in its rows, and its functions there and in the fast limit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.bits import bits_of, from_bits
from ..compile.jit import kernel
from ..compile.rarely import rarely
from . import lanes

#: where the functions of a row begin: pairs over u = kappa |V|, then what is over v = 1/F(eta), and how long a row is
SPEED, LENGTHS, BODIES, PRESS, SHARE, WIDTH = 0, 48, 96, 144, 168, 192
#: row of a place behind the last
BEYOND = -1

#: exponents of 1/2 and of 4 as the bits of a double have them, and the bits of 3
_MIDDLE, _FOUR, _THREE = 1022, 1025, 0x4008 << 48


class Law(NamedTuple):
    """Rows of one material or pair; a reader takes of a row what it asks for and nothing else.

    rows : one after the other, each (L, M/V), (lam, epsilon), (M_half_space/V, M_cylinder/V), H/F^2, eta/F
    count, e0 : how many, and the exponent of the first
    alpha, low, W, C : instantaneous over long-time modulus and its root's inverse; of the fast limit, sum J_j/T_j and
    sum J_j/T_j (ln 2 T_j - 0.5772...), of all and of either body
    """

    rows: Any
    count: int
    e0: int
    alpha: float
    low: float
    W: float
    C: float
    W_half_space: float
    C_half_space: float
    W_cylinder: float
    C_cylinder: float


class Place(NamedTuple):
    """Where the numbers of a row begin, or :data:`BEYOND`; argument of its polynomials, and its slope over x."""

    start: int
    t: float
    per: float


@kernel(inline=True)
def octave(x, e0):
    """(row, t, dt/dx) of x >= 0."""
    row = (bits_of(x) >> 52) - _MIDDLE - e0
    # by arithmetic, not by a branch: that would be mispredicted on scattered speeds
    slow = (row - 1) >> 63
    row &= ~slow
    per = from_bits((_FOUR - e0 - row + 2 * slow) << 52)
    return row, x * per - from_bits(_THREE & ~slow), per


@kernel(inline=True)
def place(x, law):
    """Where x >= 0 lies."""
    row, t, per = octave(x, law.e0)
    return Place(row * WIDTH if row < law.count else BEYOND, t, per)


@kernel(inline=True)
def beyond(at):
    """Whether a place is in the fast limit."""
    return rarely(at.start < 0)


# --- over u = kappa |V| ---


@kernel(inline=True)
def _shift(z, W, C, law):
    """(alpha z/2) (C - W ln z)."""
    return 0.5 * law.alpha * z * (C - W * np.log(z))


@kernel(inline=True)
def speed(at, u, law):
    """(L, M/V over ``scale``, scale) at u: where the fast limit holds M/V may underflow, and z is taken out of it."""
    if beyond(at):
        z = 0.5 * law.low / u
        shift = _shift(z, law.W, law.C, law)
        return law.low * (1.0 + shift), shift + 0.125 * law.alpha * z * law.W, z
    L, m = lanes.pair(law.rows, at.start + SPEED, at.t)
    return L, m, 1.0


@kernel(inline=True)
def way_of(at, u, scale, state):
    """What M/V over its scale is to be multiplied by: V, or V z."""
    return np.copysign(scale * u / state.kappa, state.V) if beyond(at) else state.V


@kernel(inline=True)
def speed_slopes(at, u, law):
    """(L, dL/du, d(u M/V)/du) at u."""
    if beyond(at):
        z = 0.5 * law.low / u
        shift = _shift(z, law.W, law.C, law)
        return (
            law.low * (1.0 + shift),
            -law.low * (shift - 0.5 * law.alpha * z * law.W) / u,
            _fast_rise(z, shift, law.W, law),
        )
    L, m, dL, dm = lanes.pair_slopes(law.rows, at.start + SPEED, at.t)
    return L, dL * at.per, m + u * at.per * dm


@kernel(inline=True)
def _fast_rise(z, shift, W, law):
    """d(u m)/du of m = z (shift + alpha z W/8)."""
    return z * (0.375 * law.alpha * z * W - shift)


@kernel(inline=True)
def lengths(at, u, law):
    """(lam, epsilon) at u."""
    if beyond(at):
        return law.low, _shift(0.5 * law.low / u, law.W, law.C, law)
    return lanes.pair(law.rows, at.start + LENGTHS, at.t)


@kernel(inline=True)
def bodies(at, u, law):
    """Parts of M/V, over the scale of :func:`speed`, in the half-space and in the cylinder."""
    if beyond(at):
        z = 0.5 * law.low / u
        weight = 0.125 * law.alpha * z
        half_space = _shift(z, law.W_half_space, law.C_half_space, law) + weight * law.W_half_space
        return half_space, _shift(z, law.W_cylinder, law.C_cylinder, law) + weight * law.W_cylinder
    return lanes.pair(law.rows, at.start + BODIES, at.t)


@kernel(inline=True)
def body_slopes(at, u, law):
    """d(u M/V)/du of either body at u."""
    if beyond(at):
        z = 0.5 * law.low / u
        half_space = _shift(z, law.W_half_space, law.C_half_space, law)
        cylinder = _shift(z, law.W_cylinder, law.C_cylinder, law)
        return _fast_rise(z, half_space, law.W_half_space, law), _fast_rise(z, cylinder, law.W_cylinder, law)
    half_space, cylinder, d_half_space, d_cylinder = lanes.pair_slopes(law.rows, at.start + BODIES, at.t)
    per = u * at.per
    return half_space + per * d_half_space, cylinder + per * d_cylinder


# --- over v = 1/F(eta), y = 1/v ---


@kernel(inline=True)
def _fast_share(y, law):
    """(eta/F, its slope over -y) in the fast limit."""
    bracket = law.C - law.W * np.log(y) if y > 0.0 else 0.0
    return 1.0 - 0.5 * law.alpha * y * bracket, 0.5 * law.alpha * (bracket - law.W)


@kernel(inline=True)
def share(at, v, law):
    """eta/F at v."""
    if beyond(at):
        return _fast_share(1.0 / v, law)[0]
    return lanes.one(law.rows, at.start + SHARE, at.t)


@kernel(inline=True)
def press(at, v, law):
    """H/F^2 at v."""
    if beyond(at):
        eta, _ = _fast_share(1.0 / v, law)
        return law.alpha * eta * eta
    return lanes.one(law.rows, at.start + PRESS, at.t)


@kernel(inline=True)
def press_slopes(at, v, law):
    """(H/F^2, its slope) at v."""
    if beyond(at):
        y = 1.0 / v
        eta, d_eta = _fast_share(y, law)
        return law.alpha * eta * eta, 2.0 * law.alpha * eta * d_eta * y * y
    value, slope = lanes.one_slopes(law.rows, at.start + PRESS, at.t)
    return value, slope * at.per


@kernel(inline=True)
def press_secant(at, near, v, x, law):
    """(H/F^2 at v, its mean slope between v and v/(1 + x), whose place is ``near``), x >= 0: no digits cancel."""
    if beyond(at):
        rise, _ = _fast_secants(v, x, law)
        return press(at, v, law), rise
    if near.start == at.start:
        value, rise = lanes.secant(law.rows, at.start + PRESS, at.t, near.t)
        return value, rise * at.per
    value, here = lanes.secant(law.rows, at.start + PRESS, at.t, -1.0)
    _, there = lanes.secant(law.rows, near.start + PRESS, 1.0, near.t)
    part = _part(at, v, x)
    return value, part * here * at.per + (1.0 - part) * there * near.per


@kernel(inline=True)
def press_secants(at, near, v, x, law):
    """Mean slopes of H/F^2 and of its slope, likewise."""
    if beyond(at):
        return _fast_secants(v, x, law)
    per, other = at.per, near.per
    if near.start == at.start:
        _, rise, _, bend = lanes.secant_slopes(law.rows, at.start + PRESS, at.t, near.t)
        return rise * per, bend * per * per
    _, here, _, bend_here = lanes.secant_slopes(law.rows, at.start + PRESS, at.t, -1.0)
    _, there, _, bend_there = lanes.secant_slopes(law.rows, near.start + PRESS, 1.0, near.t)
    part = _part(at, v, x)
    bend = part * bend_here * per * per + (1.0 - part) * bend_there * other * other
    return part * here * per + (1.0 - part) * there * other, bend


@kernel(inline=True)
def _part(at, v, x):
    """What of the way from v/(1 + x) to v lies in the row of v."""
    part = (at.t + 1.0) * (1.0 + x) / (at.per * v * x)
    return part if part < 1.0 else 1.0


@kernel
def _fast_secants(v, x, law):
    """``press_secants`` in the fast limit."""
    y = 1.0 / v
    other = y * (1.0 + x)
    eta, d_eta = _fast_share(y, law)
    near, d_near = _fast_share(other, law)
    mean = law.W * (np.log1p(x) / x if x > 0.0 else 1.0)
    rise = y * other * (d_near + 0.5 * law.alpha * (law.W - mean))
    bend = other * (0.5 * law.alpha * other * other * mean - y * (y + other) * d_eta)
    return law.alpha * (eta + near) * rise, 2.0 * law.alpha * (eta * bend + d_near * other * other * rise)
