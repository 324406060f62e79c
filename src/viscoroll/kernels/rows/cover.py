"""What the law of a cover of finite thickness has beside its rows: the creep of free rolling, and its own fast limit.

``free`` is None of half-spaces: then every function here returns what it was given or 0, and nothing of a cover is
compiled.  Of a cover it holds numbers in front, then a row each of 2 kappa delta_0 over u = kappa |V|
(:mod:`simd_polynomial`):
by itself, and twice as a pair, which has the second slope.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.jit import kernel
from .simd_polynomial import TERMS, evaluate_one, evaluate_pair

#: numbers in front: lam and 2 kappa delta_0 as u -> infinity, each with its factor of 1/u; epsilon u; M u^2/V times 2
#: over L; eta/F as v -> infinity and its factor of 1/v
_LAM, _LAM_SLOPE, _FREE, _FREE_SLOPE, _EPSILON, _MOMENT, _SHARE, _SHARE_SLOPE = range(8)
#: how many these are, and how long a row is
COVER_FRONT_SIZE, COVER_ROW_SIZE = 8, 3 * TERMS


@kernel(inline=True)
def fast_moment(shift, u, free):
    """M/V over its scale behind the last row; ``shift``: that of a half-space."""
    if free is None:
        return shift
    return free[_MOMENT] / u


@kernel(inline=True)
def fast_lengths(lam, shift, u, free):
    """(lam, epsilon) behind the last row."""
    if free is None:
        return lam, shift
    return free[_LAM] + free[_LAM_SLOPE] / u, free[_EPSILON] / u


@kernel(inline=True)
def fast_share(share, v, free):
    """eta/F behind the last row."""
    if free is None:
        return share
    return free[_SHARE] + free[_SHARE_SLOPE] / v


@kernel(inline=True)
def free_creep_at(at, u, free):
    """(2 kappa delta_0 at u, its slope over u, and the slope of that)."""
    if free is None:
        return 0.0, 0.0, 0.0
    if at.row < 0:
        fall = free[_FREE_SLOPE] / u
        return free[_FREE] + fall, -fall / u, 2.0 * fall / (u * u)
    value, _, slope, _, bend, _ = evaluate_pair(free, COVER_FRONT_SIZE + COVER_ROW_SIZE * at.row + TERMS, at.t)
    return value, slope * at.dt_dx, bend * at.dt_dx * at.dt_dx


@kernel(inline=True)
def sliding_creep(slip, delta, shift, state, free):
    """(A number with the sign of the traction, the creep that makes it): delta less that of free rolling.

    ``slip``: a number with the sign of omega - V; ``shift``: 2 kappa delta_0.
    """
    if free is None:
        return slip, delta
    own = delta - 0.5 * shift / state.kappa
    return own * np.copysign(1.0, state.V), own


@kernel(inline=True)
def slope_over_speed(over_V, over_delta, rise, free):
    """dQ/dV at fixed creep of which ``over_V`` is that at fixed creep less that of free rolling; ``rise``: the slope of
    2 kappa delta_0 over u."""
    if free is None:
        return over_V
    return over_V - 0.5 * over_delta * rise


@kernel(inline=True)
def free_creep_value(at, u, free):
    """2 kappa delta_0 at u; 0 of half-spaces."""
    if free is None:
        return 0.0
    if at.row < 0:
        return free[_FREE] + free[_FREE_SLOPE] / u
    return evaluate_one(free, COVER_FRONT_SIZE + COVER_ROW_SIZE * at.row, at.t)[0]


class FreeCreep(NamedTuple):
    """What the creep of free rolling adds to the kinematics omega = V (1 + delta_0 + k L d), k = mu/(2 kappa).

    creep : delta_0.
    aside : d(V delta_0)/dV over k d(u L)/du, a shift of d.
    bend : d^2(u delta_0)/du^2 over k.
    """

    creep: float
    aside: float
    bend: float


@kernel(inline=True)
def free_kinematics(at, u, kappa, k, spread, free):
    """:class:`FreeCreep` at u; ``spread``: d(u L)/du.  Of half-spaces -0.0, which a compiler leaves out of sums."""
    if free is None:
        return FreeCreep(-0.0, -0.0, -0.0)
    value, slope, bend = free_creep_at(at, u, free)
    per = 0.5 / kappa
    return FreeCreep(per * value, per * (value + u * slope) / (k * spread), per * (2.0 * slope + u * bend) / k)


@kernel(inline=True)
def is_cover(free):
    """Whether the law is that of a cover."""
    return free is not None


@kernel(inline=True)
def keep_free(room, at, place, u, free):
    """Put 2 kappa delta_0 at u where ``room`` has its place."""
    if free is not None:
        room[3, at] = free_creep_value(place, u, free)


@kernel(inline=True)
def kept_free(room, at, free):
    """2 kappa delta_0 from there; 0 of half-spaces."""
    if free is None:
        return 0.0
    return room[3, at]
