"""What the law of a cover of finite thickness has beside its rows: the creep of free rolling and its own fast limit.

``cover_rows`` is None of half-spaces.  Then every function here returns what it was given, or 0, and numba compiles
nothing of a cover.  Of a cover it holds a head of :data:`COVER_FRONT_SIZE` numbers, and then for each row of the law 2
kappa delta_0 over u = kappa |V| (:mod:`simd_polynomial`), twice as a pair, which has the second derivative.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import NamedTuple

import numpy as np

from ..compile.jit import inline_kernel
from .simd_polynomial import TERMS, evaluate_pair

#: Index in the head: lam as u -> infinity; behind it the coefficient of 1/u.
_LAM = 0
#: Index in the head: 2 kappa delta_0 as u -> infinity; behind it the coefficient of 1/u.
_FREE = 2
#: Index in the head: epsilon u as u -> infinity.
_EPSILON = 4
#: Index in the head: 2 M u^2/(V L) as u -> infinity.
_MOMENT = 5
#: Index in the head: eta/F as v -> infinity; behind it the coefficient of 1/v.
_SHARE = 6
#: Numbers of the head.
COVER_FRONT_SIZE = 8
#: Numbers of a row.
COVER_ROW_SIZE = 2 * TERMS


class FreeCreep(NamedTuple):
    """What the creep of free rolling adds to the kinematics omega = V (1 + delta_0 + k L d), k = mu/(2 kappa).

    creep : delta_0.
    aside : d(V delta_0)/dV divided by k d(u L)/du, a shift of d.
    bend : d^2(u delta_0)/du^2 divided by k.
    """

    creep: float
    aside: float
    bend: float


@inline_kernel
def fast_moment(shift, u, cover_rows):
    """Return M/V, divided by its scale, behind the last row of the law, where the fast limit holds.

    shift : M/V of a half-space, dimensionless, which is the result if ``cover_rows`` is None.
    u : kappa |V|, dimensionless.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    """
    if cover_rows is None:
        return shift
    return cover_rows[_MOMENT] / u


@inline_kernel
def fast_lengths(lam, shift, u, cover_rows):
    """Return length and shift of the contact behind the last row of the law, where the fast limit holds.

    lam, shift : length divided by l0 and shift epsilon of a half-space, which are the result if ``cover_rows`` is None.
    u : kappa |V|, dimensionless.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    Returns (lam, epsilon), dimensionless.
    """
    if cover_rows is None:
        return lam, shift
    return cover_rows[_LAM] + cover_rows[_LAM + 1] / u, cover_rows[_EPSILON] / u


@inline_kernel
def fast_eta_over_F(eta_over_F, v, cover_rows):
    """Return eta/F behind the last row of the law, where the fast limit holds; dimensionless.

    eta_over_F : eta/F of a half-space, which is the result if ``cover_rows`` is None.
    v : 1/F(eta), dimensionless.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    """
    if cover_rows is None:
        return eta_over_F
    return cover_rows[_SHARE] + cover_rows[_SHARE + 1] / v


@inline_kernel
def free_creep_at(position, u, cover_rows):
    """Return 2 kappa delta_0, from the creepage delta_0 of free rolling, with its derivatives in u.

    position : :class:`.evaluate.RowPosition` of u in the rows of the law.
    u : kappa |V|, dimensionless.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    Returns (value, first derivative, second derivative), dimensionless; zeros for half-spaces.
    """
    if cover_rows is None:
        return 0.0, 0.0, 0.0
    if position.row < 0:
        change = cover_rows[_FREE + 1] / u
        return cover_rows[_FREE] + change, -change / u, 2.0 * change / (u * u)
    start = COVER_FRONT_SIZE + COVER_ROW_SIZE * position.row
    value, _, slope, _, second_derivative, _ = evaluate_pair(cover_rows, start, position.t)
    return value, slope * position.dt_dx, second_derivative * position.dt_dx * position.dt_dx


@inline_kernel
def sliding_creep(slip, delta, free_creep, state, cover_rows):
    """Return the part of slip and creepage that causes the traction: delta less that of free rolling.

    slip : a number with the sign of omega - V.
    delta : creepage (omega - V)/V; may be infinite at V = 0.
    free_creep : 2 kappa delta_0, with delta_0 the creepage of free rolling.
    state : :class:`.contact_states.State`, of which kappa and the sign of V are read.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    Returns (a number with the sign of the traction, creepage delta - delta_0); slip and delta for half-spaces.
    """
    if cover_rows is None:
        return slip, delta
    own = delta - 0.5 * free_creep / state.kappa
    return own * np.copysign(1.0, state.V), own


@inline_kernel
def slope_over_speed(dQ_dV, dQ_ddelta, free_slope, cover_rows):
    """Return dQ/dV at fixed creepage delta, dimensionless.

    dQ_dV : slope at fixed delta - delta_0, the creepage less that of free rolling.
    dQ_ddelta : slope with respect to the creepage.
    free_slope : slope of 2 kappa delta_0 with respect to u = kappa |V|.
    cover_rows : numbers that only a cover has, a vector as in the module; None, for half-spaces, leaves dQ_dV as it is.
    """
    if cover_rows is None:
        return dQ_dV
    return dQ_dV - 0.5 * dQ_ddelta * free_slope


@inline_kernel
def free_kinematics(position, u, kappa, k, uL_slope, cover_rows):
    """Return what the creepage of free rolling adds to the kinematics of partial slip at one speed.

    position : :class:`.evaluate.RowPosition` of u in the rows of the law.
    u : kappa |V|, dimensionless.
    kappa : slenderness R/l0.
    k : mu/(2 kappa), dimensionless.
    uL_slope : d(u L)/du, where L = 2 kappa delta_star/mu.
    cover_rows : numbers that only a cover has, a vector as in the module; None for half-spaces.
    Returns :class:`FreeCreep`; its parts are -0.0 for half-spaces, which a compiler leaves out of sums.
    """
    if cover_rows is None:
        return FreeCreep(-0.0, -0.0, -0.0)
    value, slope, second_derivative = free_creep_at(position, u, cover_rows)
    factor = 0.5 / kappa
    return FreeCreep(
        factor * value,
        factor * (value + u * slope) / (k * uL_slope),
        factor * (2.0 * slope + u * second_derivative) / k,
    )
