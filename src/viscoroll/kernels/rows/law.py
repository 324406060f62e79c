"""The law as kernels read it: places in its rows, and its functions there and in the fast limit.

    record.hold(law, n)                  the law is now that of motion or state n
    at = place(x, law)                   of x = u = kappa |V|, or x = v = 1/F(eta) = 2 u/(L - D)
    speed, speed_slopes(at, u, law)      (L, M/V over a scale, the scale); (L, dL/du, d(u M/V)/du)
    press, press_slopes(at, v, law)      H/F^2; (H/F^2, its slope)
    lengths, bodies, body_slopes, share, press_secant, press_secants likewise

``law`` is one record (:class:`record.Law`) of two arrays and three numbers, whatever made its rows, so that what reads
it is compiled once: ``LawTable.record`` of one material, whose rows all stand and which all threads share; that of an
alpha each (``materials.law_each.law_of_alphas``) or of a series or pair each (``law_of_materials``), which is one
thread's own, made once for a block of motions.

Such a law holds one material at a time.  ``hold`` gives a new material the next stamp and puts its numbers in front of
the rows; nothing else is touched.  A part of a row bears the stamp that it was made for: a reader that finds another
has the maker write it, by its address, once a motion.  So nothing is cleared from motion to motion, a motion pays for
the parts that it meets, and one whose material is held finds them there.  A part depends on its material alone, not on
what was met before.  Hold what a motion needs before its first ``place``; places of another material mean nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.bits import bits_of, from_bits
from ..compile.jit import kernel
from ..compile.rarely import rarely
from . import lanes
from .record import (
    ALPHA,
    BODIES,
    COUNT,
    CYLINDER,
    E0,
    HALF_SPACE,
    LENGTHS,
    LOW,
    PRESS,
    SHARE,
    SPEED,
    WHOLE,
    ready,
)  # fmt: skip

#: row of a place behind the last
BEYOND = -1

#: exponents of 1/2 and of 4 as the bits of a double have them, and the bits of 3
_MIDDLE, _FOUR, _THREE = 1022, 1025, 0x4008 << 48


class Place(NamedTuple):
    """A row, or :data:`BEYOND`; argument of its polynomials, and its slope over x."""

    row: int
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
    row, t, per = octave(x, law.marks[E0])
    return Place(row if row < law.marks[COUNT] else BEYOND, t, per)


@kernel(inline=True)
def beyond(at):
    """Whether a place is in the fast limit."""
    return rarely(at.row < 0)


# --- over u = kappa |V| ---


@kernel(inline=True)
def _fast(u, body, law):
    """(z, (alpha z/2) (C - W ln z), alpha z W/8) of the whole or a body, by the fast limit."""
    alpha, W, C = law.rows[ALPHA], law.rows[body], law.rows[body + 1]
    z = 0.5 * law.rows[LOW] / u
    return z, 0.5 * alpha * z * (C - W * np.log(z)), 0.125 * alpha * z * W


@kernel(inline=True)
def speed(at, u, law):
    """(L, M/V over ``scale``, scale) at u: where the fast limit holds M/V may underflow, and z is taken out of it."""
    if beyond(at):
        z, shift, part = _fast(u, WHOLE, law)
        return law.rows[LOW] * (1.0 + shift), shift + part, z
    L, m = lanes.pair(law.rows, ready(SPEED, at.row, law), at.t)
    return L, m, 1.0


@kernel(inline=True)
def way_of(at, u, scale, state):
    """What M/V over its scale is to be multiplied by: V, or V z."""
    return np.copysign(scale * u / state.kappa, state.V) if beyond(at) else state.V


@kernel(inline=True)
def speed_slopes(at, u, law):
    """(L, dL/du, d(u M/V)/du) at u."""
    if beyond(at):
        z, shift, part = _fast(u, WHOLE, law)
        low = law.rows[LOW]
        return low * (1.0 + shift), -low * (shift - 4.0 * part) / u, z * (3.0 * part - shift)
    L, m, dL, dm = lanes.pair_slopes(law.rows, ready(SPEED, at.row, law), at.t)
    return L, dL * at.per, m + u * at.per * dm


@kernel(inline=True)
def lengths(at, u, law):
    """(lam, epsilon) at u."""
    if beyond(at):
        _, shift, _ = _fast(u, WHOLE, law)
        return law.rows[LOW], shift
    return lanes.pair(law.rows, ready(LENGTHS, at.row, law), at.t)


@kernel(inline=True)
def bodies(at, u, law):
    """Parts of M/V, over the scale of :func:`speed`, in the half-space and in the cylinder."""
    if beyond(at):
        _, half_space, part = _fast(u, HALF_SPACE, law)
        _, cylinder, other = _fast(u, CYLINDER, law)
        return half_space + part, cylinder + other
    return lanes.pair(law.rows, ready(BODIES, at.row, law), at.t)


@kernel(inline=True)
def body_slopes(at, u, law):
    """d(u M/V)/du of either body at u."""
    if beyond(at):
        z, half_space, part = _fast(u, HALF_SPACE, law)
        _, cylinder, other = _fast(u, CYLINDER, law)
        return z * (3.0 * part - half_space), z * (3.0 * other - cylinder)
    half_space, cylinder, d_half_space, d_cylinder = lanes.pair_slopes(law.rows, ready(BODIES, at.row, law), at.t)
    per = u * at.per
    return half_space + per * d_half_space, cylinder + per * d_cylinder


# --- over v = 1/F(eta), y = 1/v ---


@kernel(inline=True)
def _fast_share(y, law):
    """(eta/F, its slope over -y) in the fast limit."""
    half, W, C = 0.5 * law.rows[ALPHA], law.rows[WHOLE], law.rows[WHOLE + 1]
    bracket = C - W * np.log(y) if y > 0.0 else 0.0
    return 1.0 - half * y * bracket, half * (bracket - W)


@kernel(inline=True)
def share(at, v, law):
    """eta/F at v."""
    if beyond(at):
        return _fast_share(1.0 / v, law)[0]
    return lanes.one(law.rows, ready(SHARE, at.row, law), at.t)


@kernel(inline=True)
def press(at, v, law):
    """H/F^2 at v."""
    if beyond(at):
        eta, _ = _fast_share(1.0 / v, law)
        return law.rows[ALPHA] * eta * eta
    return lanes.one(law.rows, ready(PRESS, at.row, law), at.t)


@kernel(inline=True)
def press_slopes(at, v, law):
    """(H/F^2, its slope) at v."""
    if beyond(at):
        y = 1.0 / v
        eta, d_eta = _fast_share(y, law)
        return law.rows[ALPHA] * eta * eta, 2.0 * law.rows[ALPHA] * eta * d_eta * y * y
    value, slope = lanes.one_slopes(law.rows, ready(PRESS, at.row, law), at.t)
    return value, slope * at.per


@kernel(inline=True)
def press_secant(at, near, v, x, law):
    """(H/F^2 at v, its mean slope between v and v/(1 + x), whose place is ``near``), x >= 0: no digits cancel."""
    if beyond(at):
        rise, _ = _fast_secants(v, x, law)
        return press(at, v, law), rise
    if near.row == at.row:
        value, rise = lanes.secant(law.rows, ready(PRESS, at.row, law), at.t, near.t)
        return value, rise * at.per
    value, here = lanes.secant(law.rows, ready(PRESS, at.row, law), at.t, -1.0)
    _, there = lanes.secant(law.rows, ready(PRESS, near.row, law), 1.0, near.t)
    part = _part(at, v, x)
    return value, part * here * at.per + (1.0 - part) * there * near.per


@kernel(inline=True)
def press_secants(at, near, v, x, law):
    """Mean slopes of H/F^2 and of its slope, likewise."""
    if beyond(at):
        return _fast_secants(v, x, law)
    per, other = at.per, near.per
    if near.row == at.row:
        _, rise, _, bend = lanes.secant_slopes(law.rows, ready(PRESS, at.row, law), at.t, near.t)
        return rise * per, bend * per * per
    _, here, _, bend_here = lanes.secant_slopes(law.rows, ready(PRESS, at.row, law), at.t, -1.0)
    _, there, _, bend_there = lanes.secant_slopes(law.rows, ready(PRESS, near.row, law), 1.0, near.t)
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
    alpha, W = law.rows[ALPHA], law.rows[WHOLE]
    y = 1.0 / v
    other = y * (1.0 + x)
    eta, d_eta = _fast_share(y, law)
    near, d_near = _fast_share(other, law)
    mean = W * (np.log1p(x) / x if x > 0.0 else 1.0)
    rise = y * other * (d_near + 0.5 * alpha * (W - mean))
    bend = other * (0.5 * alpha * other * other * mean - y * (y + other) * d_eta)
    return alpha * (eta + near) * rise, 2.0 * alpha * (eta * bend + d_near * other * other * rise)
