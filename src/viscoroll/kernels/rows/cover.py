"""What the law of a cover of finite thickness has besides its rows: the creep of free rolling and its own fast limit.

``cover_rows`` is None of half-spaces.  Then every function here returns what it was given, or 0, and numba compiles
nothing of a cover.  Of a cover it holds a head of :data:`COVER_FRONT_SIZE` numbers, and then for each row of the law 2
kappa delta_0 over u = kappa |V| (:mod:`simd_polynomial`), twice as a pair, which has the second derivative.  The fast
limit holds beyond the last row of the law.

Letters: kappa = R/l0, mu the coefficient of friction; L = 2 kappa delta_star/mu; lam, length of the contact divided by
l0, and epsilon, its shift in half contact lengths, functions of u; eta, half the transit time of the stick zone, and
eta/F, a function of v = 1/F(eta) (:mod:`.rows`).

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import NamedTuple

import numpy as np

from ..compile.jit import inline_kernel
from .simd_polynomial import TERMS, evaluate_pair

#: Index in the head: lam as u -> infinity; after it the coefficient of 1/u.
_LAM = 0
#: Index in the head: 2 kappa delta_0 as u -> infinity; after it the coefficient of 1/u.
_FREE = 2
#: Index in the head: epsilon u as u -> infinity.
_EPSILON = 4
#: Index in the head: 2 M u^2/(V L) as u -> infinity.
_MOMENT = 5
#: Index in the head: eta/F as v -> infinity; after it the coefficient of 1/v.
_SHARE = 6
#: Numbers of the head.
COVER_FRONT_SIZE = 8
#: Numbers of a row.
COVER_ROW_SIZE = 2 * TERMS


class FreeCreep(NamedTuple):
    """Parts that the creepage of free rolling, delta_0, adds to the kinematics omega = V (1 + delta_0 + k L d).

    Here k = mu/(2 kappa) and L = 2 kappa delta_star/mu; d is (delta - delta_0)/delta_star.  All parts are
    dimensionless.

    creep : delta_0.
    aside : d(V delta_0)/dV divided by k d(u L)/du, by which d is shifted.
    bend : d^2(u delta_0)/du^2 divided by k, with u = kappa |V|.
    """

    creep: float
    aside: float
    bend: float


@inline_kernel
def fast_moment(shift, u, cover_rows):
    """Return M/V divided by z, without the term alpha z W/8 of :func:`.evaluate._fast_terms`, in the fast limit.

    The fast limit holds beyond the last row of the law, and z = lam_fast/(2 u) is the ``scale`` of M/V there.

    shift : float, this part of a half-space, dimensionless, which is the result if ``cover_rows`` is None; else not
        read.
    u : float, kappa |V|, dimensionless, > 0; read of a cover alone.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces.
    Returns a float, dimensionless, which -> 0 for u -> infinity: of a cover as 1/u, of half-spaces as (ln u)/u.
    """
    if cover_rows is None:
        return shift
    return cover_rows[_MOMENT] / u


@inline_kernel
def fast_lengths(lam, shift, u, cover_rows):
    """Return length and shift of the contact beyond the last row of the law, where the fast limit holds.

    lam, shift : floats, length divided by l0 and shift epsilon of a half-space, dimensionless, which are the result if
        ``cover_rows`` is None; else not read.
    u : float, kappa |V|, dimensionless, > 0; read of a cover alone.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces.
    Returns (lam, epsilon), floats, dimensionless; epsilon is in half contact lengths.
    """
    if cover_rows is None:
        return lam, shift
    return cover_rows[_LAM] + cover_rows[_LAM + 1] / u, cover_rows[_EPSILON] / u


@inline_kernel
def fast_eta_over_F(eta_over_F, v, cover_rows):
    """Return eta/F beyond the last row of the law, where the fast limit holds.

    eta_over_F : float, eta/F of a half-space, dimensionless, which is the result if ``cover_rows`` is None; else not
        read.
    v : float, 1/F(eta), dimensionless, > 0, which may be infinite; read of a cover alone.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces.
    Returns a float, dimensionless; of a cover its limit lam/L for v -> infinity and a term in 1/v.
    """
    if cover_rows is None:
        return eta_over_F
    return cover_rows[_SHARE] + cover_rows[_SHARE + 1] / v


@inline_kernel
def free_creep_at(position, u, cover_rows):
    """Return 2 kappa delta_0, from the creepage delta_0 of free rolling, with its derivatives over u.

    position : :class:`.evaluate.RowPosition` of u in the rows of the law; beyond the last row the value is a limit and
        a term in 1/u.
    u : float, kappa |V|, dimensionless, >= 0; read beyond the last row alone.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces.
    Returns (value, first derivative, second derivative), floats, dimensionless, of either sign; a cover on the cylinder
    has the other sign than the same on the base; all are 0.0 for half-spaces.
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
    """Return slip and creepage that cause the traction: for a cover without those of free rolling.

    slip : float, a number with the sign of omega - V, of :func:`.contact_states.slip_and_creepage`; not read for a
        cover.
    delta : float, creepage (omega - V)/V, dimensionless; infinite at V = 0 if omega is given and not 0.
    free_creep : float, 2 kappa delta_0, with delta_0 the creepage of free rolling, dimensionless; read of a cover
        alone.
    state : :class:`.contact_states.State`, of which kappa and the sign of V are read, of a cover alone.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces.
    Returns (a float with the sign of the traction, delta - delta_0), dimensionless.  Of a cover the first is delta -
    delta_0 with the sign of V, where V = 0.0 counts as V > 0; of half-spaces the two are ``slip`` and ``delta`` as
    given.
    """
    if cover_rows is None:
        return slip, delta
    own = delta - 0.5 * free_creep / state.kappa
    return own * np.copysign(1.0, state.V), own


@inline_kernel
def slope_over_speed(dQ_dV, dQ_ddelta, free_slope, cover_rows):
    """Return dQ/dV at fixed creepage delta, from that at fixed delta - delta_0, the creepage less that of free rolling.

    A cover's delta_0 changes with the speed, so that the traction changes too while delta stays.  Q is in units of P.

    dQ_dV : float, slope at fixed delta - delta_0, dimensionless.
    dQ_ddelta : float, slope over the creepage for motion with V > 0, dimensionless, >= 0.
    free_slope : float, slope of 2 kappa delta_0 over u = kappa |V|, dimensionless.
    cover_rows : vector of the numbers that only a cover has, as in the module; None, for half-spaces, leaves dQ_dV as
        it is.
    Returns a float, dimensionless.
    """
    if cover_rows is None:
        return dQ_dV
    return dQ_dV - 0.5 * dQ_ddelta * free_slope


@inline_kernel
def free_kinematics(position, u, kappa, k, uL_slope, cover_rows):
    """Return what the creepage of free rolling adds to the kinematics of partial slip at one speed.

    position : :class:`.evaluate.RowPosition` of u in the rows of the law.
    u : float, kappa |V|, dimensionless, >= 0.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    k : float, mu/(2 kappa), dimensionless, > 0.
    uL_slope : float, d(u L)/du, where L = 2 kappa delta_star/mu, dimensionless, > 0.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for half-spaces, of which no other
        argument is read.
    Returns :class:`FreeCreep` of floats, dimensionless: delta_0; d(V delta_0)/dV divided by k d(u L)/du, which is added
    to d = (delta - delta_0)/delta_star in the kinematics; d^2(u delta_0)/du^2 divided by k.  All are -0.0 for
    half-spaces, which a compiler leaves out of sums.
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
