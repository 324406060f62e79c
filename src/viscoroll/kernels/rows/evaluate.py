"""The law as kernels read it: places in its rows, and its functions there and in the fast limit.

    record.hold(law, n)                  the law is now that of motion or state n
    at = place(x, law)                   of x = u = kappa |V|, or x = v = 1/F(eta) = 2 u/(L - D)
    speed(at, u, law)                    L, M/V and their slopes
    press(at, v, law)                    H/F^2 and its slope
    lengths, bodies, share, press_secants likewise

``law`` is one record (:class:`record.Law`) of three arrays and three numbers, whatever made its rows, so that its
readers are compiled once: ``LawTable.record`` of one material, whose rows all stand and which all threads share; that
of an alpha each (``materials.law_each.law_of_alphas``) or of a series or pair each (``law_of_materials``), which is one
thread's own, made once for a block of motions.

Such a law holds one material at a time.  ``hold`` gives a new material the next stamp and puts its numbers in front of
the rows; nothing else is touched.  A part of a row bears the stamp that it was made for: a reader that finds another
has the maker write it, by its address, once a motion.  So nothing is cleared from motion to motion, a motion pays for
the parts that it meets, and one whose material is held finds them there.  A part depends on its material alone, not on
what was met before.  Hold what a motion needs before its first ``locate_row``; places of another material mean nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.intrinsics import bits_to_float, float_to_bits, unlikely
from ..compile.jit import kernel
from .cover import fast_lengths, fast_moment, fast_share, free_creep_at
from .record import (
    ALPHA,
    BODY_MOMENTS,
    E0,
    ETA_OVER_F,
    FAST_CYLINDER,
    FAST_HALF_SPACE,
    FAST_TOTAL,
    H_OVER_F2,
    LAM_EPSILON,
    LAM_FAST,
    LENGTH_MOMENT,
    ROW_COUNT,
    ensure_part,
)  # fmt: skip
from .simd_polynomial import evaluate_one, evaluate_pair, evaluate_secants

#: row of a place behind the last
FAST_LIMIT = -1

#: exponents of 1/2 and of 4 as the bits of a double have them, and the bits of 3
_MIDDLE, _FOUR, _THREE = 1022, 1025, 0x4008 << 48


class RowPosition(NamedTuple):
    """A row, or :data:`FAST_LIMIT`; argument of its polynomials, and its slope over x."""

    row: int
    t: float
    dt_dx: float


@kernel(inline=True)
def locate_octave(x, e0):
    """(row, t, dt/dx) of x >= 0."""
    row = (float_to_bits(x) >> 52) - _MIDDLE - e0
    # by arithmetic, not by a branch: that would be mispredicted on scattered speeds
    slow = (row - 1) >> 63
    row &= ~slow
    per = bits_to_float((_FOUR - e0 - row + 2 * slow) << 52)
    return row, x * per - bits_to_float(_THREE & ~slow), per


@kernel(inline=True)
def locate_row(x, law):
    """Where x >= 0 lies."""
    row, t, per = locate_octave(x, law.marks[E0])
    return RowPosition(row if row < law.marks[ROW_COUNT] else FAST_LIMIT, t, per)


@kernel(inline=True)
def in_fast_limit(at):
    """Whether a place is in the fast limit."""
    return unlikely(at.row < 0)


# --- over u = kappa |V| ---


class LengthAndMoment(NamedTuple):
    """L, its slope over u and the slope of that; M/V over ``scale``; d(u M/V)/du.

    Where the fast limit holds M/V may underflow: z is taken out of it, the scale.
    """

    L: float
    dL: float
    ddL: float
    m: float
    scale: float
    d_um: float


@kernel(inline=True)
def _fast(u, body, law):
    """(z, (alpha z/2) (C - W ln z), alpha z W/8) of the whole or a body, by the fast limit."""
    alpha, W, C = law.rows[ALPHA], law.rows[body], law.rows[body + 1]
    z = 0.5 * law.rows[LAM_FAST] / u
    return z, 0.5 * alpha * z * (C - W * np.log(z)), 0.125 * alpha * z * W


@kernel(inline=True)
def length_and_moment(at, u, law):
    """What depends on the speed alone at u: what a caller does not take is not computed."""
    if in_fast_limit(at):
        z, free_creep_and_slopes, part = _fast(u, FAST_TOTAL, law)
        per, fall = law.rows[LAM_FAST] / u, free_creep_and_slopes - 4.0 * part
        bend = per * (2.0 * fall - 4.0 * part) / u
        own = fast_moment(free_creep_and_slopes, u, law.cover_rows)
        return LengthAndMoment(
            law.rows[LAM_FAST] * (1.0 + free_creep_and_slopes), -per * fall, bend, own + part, z, z * (3.0 * part - own)
        )
    L, m, dL, dm, ddL, _ = evaluate_pair(law.rows, ensure_part(LENGTH_MOMENT, at.row, law), at.t)
    return LengthAndMoment(L, dL * at.dt_dx, ddL * at.dt_dx * at.dt_dx, m, 1.0, m + u * at.dt_dx * dm)


@kernel(inline=True)
def moment_factor(at, u, scale, state):
    """What M/V over its scale is to be multiplied by: V, or V z."""
    return np.copysign(scale * u / state.kappa, state.V) if in_fast_limit(at) else state.V


@kernel(inline=True)
def lam_and_epsilon(at, u, law):
    """(lam, epsilon) at u."""
    if in_fast_limit(at):
        _, free_creep_and_slopes, _ = _fast(u, FAST_TOTAL, law)
        return fast_lengths(law.rows[LAM_FAST], free_creep_and_slopes, u, law.cover_rows)
    return evaluate_pair(law.rows, ensure_part(LAM_EPSILON, at.row, law), at.t)[:2]


@kernel(inline=True)
def body_moments(at, u, law):
    """Parts of M/V, over the scale of :func:`length_and_moment`, in the half-space and in the cylinder; d(u M/V)/du
    of either.
    """
    if in_fast_limit(at):
        z, half_space, part = _fast(u, FAST_HALF_SPACE, law)
        _, cylinder, other = _fast(u, FAST_CYLINDER, law)
        per_half_space, per_cylinder = z * (3.0 * part - half_space), z * (3.0 * other - cylinder)
        return half_space + part, cylinder + other, per_half_space, per_cylinder
    found = evaluate_pair(law.rows, ensure_part(BODY_MOMENTS, at.row, law), at.t)
    half_space, cylinder, d_half_space, d_cylinder, _, _ = found
    per = u * at.dt_dx
    return half_space, cylinder, half_space + per * d_half_space, cylinder + per * d_cylinder


@kernel(inline=True)
def free_creep_and_slopes(u, law):
    """(2 kappa delta_0 at u, its slope over u, and the slope of that); 0 of half-spaces, without looking."""
    if law.cover_rows is None:
        return 0.0, 0.0, 0.0
    return free_creep_at(locate_row(u, law), u, law.cover_rows)


@kernel(inline=True)
def limits_at_rest(kappa, law):
    """(L, delta_0) as V -> 0: 1 and -0.0 of half-spaces."""
    if law.cover_rows is None:
        return 1.0, -0.0
    at = locate_row(0.0, law)
    return length_and_moment(at, 0.0, law).L, 0.5 * free_creep_at(at, 0.0, law.cover_rows)[0] / kappa


# --- over v = 1/F(eta), y = 1/v ---


@kernel(inline=True)
def _fast_share(y, law):
    """(eta/F, its slope over -y) in the fast limit."""
    half, W, C = 0.5 * law.rows[ALPHA], law.rows[FAST_TOTAL], law.rows[FAST_TOTAL + 1]
    bracket = C - W * np.log(y) if y > 0.0 else 0.0
    return 1.0 - half * y * bracket, half * (bracket - W)


@kernel(inline=True)
def eta_over_F(at, v, law):
    """eta/F at v."""
    if in_fast_limit(at):
        return fast_share(_fast_share(1.0 / v, law)[0], v, law.cover_rows)
    return evaluate_one(law.rows, ensure_part(ETA_OVER_F, at.row, law), at.t)[0]


@kernel(inline=True)
def H_over_F2(at, v, law):
    """(H/F^2, its slope) at v."""
    if in_fast_limit(at):
        y = 1.0 / v
        eta, d_eta = _fast_share(y, law)
        return law.rows[ALPHA] * eta * eta, 2.0 * law.rows[ALPHA] * eta * d_eta * y * y
    value, slope = evaluate_one(law.rows, ensure_part(H_OVER_F2, at.row, law), at.t)
    return value, slope * at.dt_dx


@kernel(inline=True)
def H_over_F2_secants(at, near, v, x, law):
    """(H/F^2 and its slope at v, mean slopes of either between v and v/(1 + x), whose place is ``near``), x >= 0.

    No digits cancel.
    """
    per, other = at.dt_dx, near.dt_dx
    if in_fast_limit(at):
        value, slope = H_over_F2(at, v, law)
        rise, bend = _fast_secants(v, x, law)
        return value, slope, rise, bend
    end = near.t if near.row == at.row else -1.0
    value, rise, slope, bend = evaluate_secants(law.rows, ensure_part(H_OVER_F2, at.row, law), at.t, end)
    rise, bend = rise * per, bend * per * per
    if near.row != at.row:
        _, there, _, bend_there = evaluate_secants(law.rows, ensure_part(H_OVER_F2, near.row, law), 1.0, near.t)
        # of the way that lies in the row of v
        part = min((at.t + 1.0) * (1.0 + x) / (per * v * x), 1.0)
        rise = part * rise + (1.0 - part) * there * other
        bend = part * bend + (1.0 - part) * bend_there * other * other
    return value, slope * per, rise, bend


@kernel
def _fast_secants(v, x, law):
    """Mean slopes of :func:`H_over_F2_secants` in the fast limit."""
    alpha, W = law.rows[ALPHA], law.rows[FAST_TOTAL]
    y = 1.0 / v
    other = y * (1.0 + x)
    eta, d_eta = _fast_share(y, law)
    near, d_near = _fast_share(other, law)
    mean = W * (np.log1p(x) / x if x > 0.0 else 1.0)
    rise = y * other * (d_near + 0.5 * alpha * (W - mean))
    bend = other * (0.5 * alpha * other * other * mean - y * (y + other) * d_eta)
    return alpha * (eta + near) * rise, 2.0 * alpha * (eta * bend + d_near * other * other * rise)
