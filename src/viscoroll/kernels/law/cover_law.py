"""The law of covers of finite thickness: its parts besides the rows of every law.

``cover_rows`` is None for half-spaces.  Functions that are passed None return the values of
half-spaces, which are arguments or constants, and numba compiles no code of covers for them.  For a
cover ``cover_rows`` holds a head of :data:`COVER_FRONT_SIZE` numbers, the limits of fast rolling
and which body has a layer, and then for each row of the law three pairs of functions of u = kappa
|V| (:mod:`.simd`).  The limits hold beyond the last row of the law.  The functions are explained
below: the first pair is the sums over both bodies, f = f_b + f_c and g = g_b + g_c; the second pair
is f_c and g_c, which are read only where each body has a layer; the third is lam_Q and epsilon_Q.

Letters: kappa = R/l0, mu the coefficient of friction; Q the traction, |Q| <= mu; L = 2 kappa
delta_star/mu with the critical creepage delta_star; lam, length of the contact divided by l0, and
epsilon, its shift in half contact lengths, functions of u (lam_0 and epsilon_0 without traction);
eta, half the transit time of the stick zone, and eta/F, a function of v = 1/F(eta)
(:mod:`.law_functions`); delta_0, the creepage without creep force.  b stands for the base, the body
called half-space, c for the cylinder.

With delta_0 = (f_b + f_c)/(2 kappa),

    M_half_space = V m_half_space - Q [f_b + g_b |Q|/mu]/(2 kappa)
    M_cylinder = V m_cylinder - Q [f_c + g_c |Q|/mu]/(2 kappa + f_b + f_c)
    lam = lam_0 + lam_Q Q        epsilon = epsilon_0 + epsilon_Q Q

f_b and f_c are what the stretched surface of the base and of the cylinder adds to 2 kappa delta_0;
g_b and g_c, m_b and m_c of docs/theory_covers.md, Shear acts back, change the moment of full slip
to that of the mirrored strain.  A body without a layer has f = g = 0.  |g_b + g_c| is limited to
mu L/2 by a smooth function, so that the loss in slip is never below 0.

Full slip begins at creepages that lie unlike far from delta_0 where shear acts back:

    delta = delta_0 + delta_star (d + c d^2)
    c = -r/(1 + (2 r)^6)        r = 2 (g_b + g_c)/(mu L)

where d in [-1, 1] is the creepage of a half-space over its delta_star, from which Q follows, and c,
|c| < 0.32, the asymmetry.  r is the excess in units of what it is limited to; where it is above 1
both ends slip, and no law of this form holds.  Losses in slip stay above 0 for every r.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel
from ..numerics.simd import SHORT_TERMS, evaluate_short_pair

#: Index in the head: lam as u -> infinity; after it the coefficient of 1/u, as after each of the
#: next six.
LAM_LIMIT = 0
#: Index in the head: f_b, the part of 2 kappa delta_0 by the base, as u -> infinity.
FREE_HALF_SPACE_LIMIT = 2
#: Index in the head: f_c, the part of 2 kappa delta_0 by the cylinder, as u -> infinity.
FREE_CYLINDER_LIMIT = 4
#: Index in the head: g_b as u -> infinity.
EXCESS_HALF_SPACE_LIMIT = 6
#: Index in the head: g_c as u -> infinity.
EXCESS_CYLINDER_LIMIT = 8
#: Index in the head: lam_Q as u -> infinity.
LAM_SLOPE_LIMIT = 10
#: Index in the head: epsilon_Q as u -> infinity.
EPSILON_SLOPE_LIMIT = 12
#: Index in the head: eta/F as v -> infinity; after it the coefficient of 1/v.
ETA_OVER_F_LIMIT = 14
#: Index in the head: epsilon u as u -> infinity.
EPSILON_LIMIT = 16
#: Index in the head: 2 M u^2/(V L) as u -> infinity, of both bodies together.
MOMENT_LIMIT = 17
#: Index in the head, after the limits: part of f and g that the cylinder has: 0.0 where the base
#: alone has a layer, 1.0 where the cylinder alone has one, -1.0 where each body has one.
CYLINDER_PART = 18
#: Numbers of the head, of which the last five are 0: rows begin at a line of the cache, 8 numbers.
COVER_FRONT_SIZE = 24
#: Numbers of a pair of functions in a row.
_PAIR_SIZE = 2 * SHORT_TERMS
#: Offset in a row of f and g, interleaved.
TOTAL = 0
#: Offset in a row of f_c and g_c, interleaved.
CYLINDER = _PAIR_SIZE
#: Offset in a row of lam_Q and epsilon_Q, interleaved.
TILT = 2 * _PAIR_SIZE
#: Numbers of a row.
COVER_ROW_SIZE = 3 * _PAIR_SIZE


class FreeCreep(NamedTuple):
    """Parts that the creepage without creep force, delta_0, adds to the kinematics omega = V (1 +
    delta_0 + k L d).

    Here k = mu/(2 kappa) and L = 2 kappa delta_star/mu; d stands for (delta - delta_0)/delta_star.
    All parts are dimensionless.

    creep : delta_0.
    aside : d(V delta_0)/dV divided by k d(u L)/du, by which d is shifted.
    bend : d^2(u delta_0)/du^2 divided by k, with u = kappa |V|.
    """

    creep: float
    aside: float
    bend: float


@inline_kernel
def fast_value(index, x, half_space, cover_rows):
    """Return lam or eta/F at a speed beyond the last row of the law, by its expansion for fast
    rolling.

    For a cover the expansion is limit + coefficient/x, with both numbers from the head of
    ``cover_rows``; for half-spaces the caller has evaluated it.

    index : int, index in ``cover_rows`` of the limit: LAM_LIMIT or ETA_OVER_F_LIMIT; the
        coefficient is the number after it.
    x : float, > 0, dimensionless; for lam: u = kappa |V|; for eta/F: v = 1/F(eta), which may be
        infinite.  It is not read for half-spaces.
    half_space : float, lam or eta/F of half-spaces, dimensionless, which is the result if
        ``cover_rows`` is None; else not read.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces.
    Returns a float, dimensionless.
    """
    if cover_rows is None:
        return half_space
    return _limit_at(index, x, cover_rows).value


@inline_kernel
def fast_quotient(index, u, half_space, cover_rows):
    """Return epsilon, or the moment term M/(V z), at a speed beyond the last row of the law.

    For half-spaces the result is ``half_space``, for a cover a coefficient of the head divided by
    u.  M is the moment without traction, and z = L/(2 u) with L in its limit for u -> infinity.  In
    this limit L of half-spaces is lam, since epsilon -> 0; L of a cover is not.  The moment term of
    half-spaces is without the term alpha z W/8 of :func:`.law_functions._fast_terms`, which the
    caller adds; for covers that term is 0.

    index : int, index in ``cover_rows`` of the limit of (value times u): EPSILON_LIMIT or
        MOMENT_LIMIT.
    u : float, kappa |V|, dimensionless, > 0; not read for half-spaces.
    half_space : float, the value for half-spaces, dimensionless, which is the result if
        ``cover_rows`` is None; else not read.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces.
    Returns a float, dimensionless, which tends to 0 for u -> infinity: for a cover as 1/u, for
    half-spaces as (ln u)/u.
    """
    if cover_rows is None:
        return half_space
    return cover_rows[index] / u


class OverSpeed(NamedTuple):
    """Value of a function of u = kappa |V| at one speed, with its first and second derivative with
    respect to u, dimensionless.
    """

    value: float
    slope: float
    curvature: float


class PairOverSpeed(NamedTuple):
    """Values of two functions of u = kappa |V| at one speed, with their derivatives."""

    first: OverSpeed
    second: OverSpeed


@inline_kernel
def _pair_at(offset, position, cover_rows):
    """Return the values of two functions of a cover at one speed, with their derivatives, as
    :class:`PairOverSpeed`.

    offset : int, offset of the pair in a row: TOTAL, CYLINDER or TILT.
    position : :class:`.law_functions.RowPosition` of u in the rows of the law, not beyond the last.
    cover_rows : vector of the numbers that only a cover has, as in the module; not None.
    """
    # cover rows have a head shorter than a row: row 0 is directly behind it
    start = COVER_FRONT_SIZE + COVER_ROW_SIZE * position.row + offset
    first, second, d_first, d_second, dd_first, dd_second = evaluate_short_pair(
        cover_rows, start, position.t
    )
    slope = position.dt_dx
    curvature = slope * slope
    return PairOverSpeed(
        OverSpeed(first, d_first * slope, dd_first * curvature),
        OverSpeed(second, d_second * slope, dd_second * curvature),
    )


@inline_kernel
def _limit_at(index, u, cover_rows):
    """Return the value limit + coefficient/u of a function beyond the last row of the law, with its
    derivatives, as :class:`OverSpeed`.

    index : int, index in ``cover_rows`` of the limit for u -> infinity; the coefficient follows it.
    u : float, kappa |V|, dimensionless, > 0; for eta/F it is v = 1/F(eta), which may be infinite.
    cover_rows : vector of the numbers that only a cover has, as in the module; not None.
    """
    change = cover_rows[index + 1] / u
    # of a + b/u: slope -b/u^2, curvature 2 b/u^3
    return OverSpeed(cover_rows[index] + change, -change / u, 2.0 * change / (u * u))


@inline_kernel
def _weighted_sum(a, weight, b):
    """Return a + weight b of two :class:`OverSpeed`; ``weight``: float."""
    return OverSpeed(
        a.value + weight * b.value,
        a.slope + weight * b.slope,
        a.curvature + weight * b.curvature,
    )


@inline_kernel
def _relative_excess(total, mu, L, dL, ddL):
    """Return r = 2 g/(mu L), as :class:`OverSpeed`.

    total : :class:`PairOverSpeed` of f and g.
    mu : float, coefficient of friction, > 0.
    L, dL, ddL : floats, 2 kappa delta_star/mu, > 0, and its derivatives over u, dimensionless.
    """
    # r = 2 g/(mu L); from r L = 2 g/mu, r' L + r L' = 2 g'/mu, and likewise the second derivative.
    excess = total.second
    bound = 2.0 * (1.0 / (mu * L))
    value = bound * excess.value
    slope = bound * excess.slope - value * dL / L
    curvature = bound * excess.curvature
    return OverSpeed(value, slope, curvature - (2.0 * slope * dL + value * ddL) / L)


@inline_kernel
def asymmetry_at(pairs, mu, L, dL, ddL, cover_rows):
    """Return the asymmetry c of the onsets of full slip, as :class:`OverSpeed`; for half-spaces it
    is 0.

    pairs : :class:`Pairs` at that speed, of which ``total`` is read.
    mu : float, coefficient of friction, > 0.
    L, dL, ddL : floats, 2 kappa delta_star/mu, > 0, and its derivatives over u, dimensionless; with
        dL = ddL = 0 only the value of the result has a meaning.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
    half-spaces.
    """
    if cover_rows is None:
        return OverSpeed(0.0, 0.0, 0.0)
    r = _relative_excess(pairs.total, mu, L, dL, ddL)
    # c = -r share with share = 1/(1 + (2 r)^6); over_r and twice_over_r are the first and second
    # derivative of c in r; ``power`` is (2 r)^6.
    square = 4.0 * r.value * r.value
    power = square * square * square
    share = 1.0 / (1.0 + power)
    over_r = -(1.0 - 5.0 * power) * share * share
    twice_over_r = 24.0 * square * square * r.value * (7.0 - 5.0 * power) * share * share * share
    return OverSpeed(
        value=-r.value * share,
        slope=over_r * r.slope,
        curvature=over_r * r.curvature + twice_over_r * r.slope * r.slope,
    )


class Pairs(NamedTuple):
    """Functions of a cover at one speed, each a :class:`PairOverSpeed`.

    total : f and g of both bodies together.  cylinder : f_c and g_c.
    """

    total: PairOverSpeed
    cylinder: PairOverSpeed


@inline_kernel
def pairs_at(position, u, cover_rows):
    """Return the :class:`Pairs` of a cover at one speed; for half-spaces all its numbers are 0.

    position : :class:`.law_functions.RowPosition` of u in the rows of the law.
    u : float, kappa |V|, dimensionless, >= 0; read only beyond the last row.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces.
    """
    if cover_rows is None:
        zero = OverSpeed(0.0, 0.0, 0.0)
        none = PairOverSpeed(zero, zero)
        return Pairs(none, none)
    # 0, 1 or -1; interpolated over the thickness it has rounding, so that it is compared with
    # +-0.5.
    part = cover_rows[CYLINDER_PART]
    # rows have the sums and the parts of the cylinder, the head the parts of both bodies
    if position.row < 0:
        free = _limit_at(FREE_CYLINDER_LIMIT, u, cover_rows)
        excess = _limit_at(EXCESS_CYLINDER_LIMIT, u, cover_rows)
        cylinder = PairOverSpeed(free, excess)
        total = PairOverSpeed(
            _weighted_sum(_limit_at(FREE_HALF_SPACE_LIMIT, u, cover_rows), 1.0, free),
            _weighted_sum(_limit_at(EXCESS_HALF_SPACE_LIMIT, u, cover_rows), 1.0, excess),
        )
    else:
        total = _pair_at(TOTAL, position, cover_rows)
        cylinder = _pair_at(CYLINDER, position, cover_rows) if part < -0.5 else total
    if part > -0.5:  # Only one body has a layer: f_c and g_c are f and g, or 0.
        zero = OverSpeed(0.0, 0.0, 0.0)
        weight = 1.0 if part > 0.5 else 0.0
        cylinder = PairOverSpeed(
            _weighted_sum(zero, weight, total.first), _weighted_sum(zero, weight, total.second)
        )
    return Pairs(total, cylinder)


@inline_kernel
def reduced_creep(creep, asymmetry):
    """Return d for a given creep d + c d^2; in full slip return the creep less c instead.

    In partial slip it is the inverse of :func:`creep_of`, whose continuation has another slope.

    creep : float, (delta - delta_0)/delta_star, dimensionless, which may be infinite or NaN.
    asymmetry : float, c, |c| < 1/2.
    Returns a float: at least 1 in modulus where the whole contact slips, 1 at its onset.
    """
    # The root of c d^2 + d = creep that is creep for c = 0, in the form without cancellation.  Both
    # cases are computed, so that a loop becomes vector instructions.
    # Far in full slip the root has no real value: 0 keeps NaN away, as ``within`` is not read.
    within = 2.0 * creep / (1.0 + np.sqrt(max(1.0 + 4.0 * asymmetry * creep, 0.0)))
    # the onsets, d = 1 and -1, have the creeps c + 1 and c - 1; creep - c continues d from there
    full_slip = abs(creep) >= abs(asymmetry + np.copysign(1.0, creep))
    return creep - asymmetry if full_slip else within


class CreepCurve(NamedTuple):
    """The creep (delta - delta_0)/delta_star over d, dimensionless, with a linear continuation
    beyond |d| = 1.

    value, slope, curvature : d + c d^2 and its derivatives with respect to d.
    bend : derivative of d + c d^2 with respect to c; bend_slope : derivative of ``bend`` with
        respect to d.
    """

    value: float
    slope: float
    curvature: float
    bend: float
    bend_slope: float


@inline_kernel
def creep_of(d, asymmetry, cover_rows):
    """Return the creep d + c d^2 of a cover, that is (delta - delta_0)/delta_star, and its
    derivatives; the creep of half-spaces is d.

    d : float, of either sign, dimensionless, the creepage of half-spaces divided by their
        delta_star; beyond |d| = 1 the parabola is continued by its tangent.
    asymmetry : float, c; not read for half-spaces.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces.
    Returns a :class:`CreepCurve`; for half-spaces its value is d, its slope 1 and the rest 0.
    """
    if cover_rows is None:
        return CreepCurve(d, 1.0, 0.0, 0.0, 0.0)
    # Beyond |d| = 1 d^2 is continued by its tangent there, 2 d within - within^2.
    within = min(max(d, -1.0), 1.0)
    bend = within * (2.0 * d - within)
    return CreepCurve(
        value=d + asymmetry * bend,
        slope=1.0 + 2.0 * asymmetry * within,
        curvature=2.0 * asymmetry if within == d else 0.0,
        bend=bend,
        bend_slope=2.0 * within,
    )


class Reaction(NamedTuple):
    """How shear acts back on the rolling moments at one speed: the traction Q reduces M of a body
    by

        Q (factor + excess |Q|/mu)

    half_space, cylinder : the factors, dimensionless, of either sign.
    half_space_excess, cylinder_excess : the excesses, dimensionless, of either sign.
    half_space_slope, cylinder_slope, half_space_excess_slope, cylinder_excess_slope : derivatives
        of these four with respect to u.
    """

    half_space: float
    cylinder: float
    half_space_excess: float
    cylinder_excess: float
    half_space_slope: float
    cylinder_slope: float
    half_space_excess_slope: float
    cylinder_excess_slope: float


@inline_kernel
def shear_reaction(pairs, kappa, mu, L, dL, cover_rows):
    """Return how shear acts back on the rolling moments at one speed, as :class:`Reaction`, by the
    module's equations.

    The excess g is limited by g/(1 + (g/s)^4)^(1/4) with s = mu L/2, both parts in proportion.

    pairs : :class:`Pairs` at that speed.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    mu : float, coefficient of friction, > 0.
    L, dL : floats, 2 kappa delta_star/mu, > 0, and its slope over u, dimensionless.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
    half-spaces: all is 0.
    """
    if cover_rows is None:
        return Reaction(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    total, cylinder = pairs
    f_c, g_c = cylinder
    f_b = _weighted_sum(total.first, -1.0, f_c)
    g_b = _weighted_sum(total.second, -1.0, g_c)
    # Divisors of the module's equations, 2 kappa and 2 kappa + f_b + f_c, inverted.
    on_base = 0.5 / kappa
    on_cylinder = 1.0 / (2.0 * kappa + total.first.value)
    on_cylinder_slope = -on_cylinder * on_cylinder * total.first.slope
    # g/s is r of the module: the limiter is (1 + r^4)^(-1/4), with the slope -r^3 r' (1 + r^4)^-1
    # times itself; callers that read no slopes of the result pass 0 as the slope of L.
    ratio = _relative_excess(total, mu, L, dL, 0.0)
    cube = ratio.value * ratio.value * ratio.value
    rest = 1.0 / (1.0 + cube * ratio.value)
    limiter = np.sqrt(np.sqrt(rest))
    limiter_slope = -limiter * rest * cube * ratio.slope
    excess_slope = limiter * g_c.slope + limiter_slope * g_c.value
    return Reaction(
        half_space=on_base * f_b.value,
        cylinder=on_cylinder * f_c.value,
        half_space_excess=on_base * limiter * g_b.value,
        cylinder_excess=on_cylinder * limiter * g_c.value,
        half_space_slope=on_base * f_b.slope,
        cylinder_slope=on_cylinder * f_c.slope + on_cylinder_slope * f_c.value,
        half_space_excess_slope=on_base * (limiter * g_b.slope + limiter_slope * g_b.value),
        cylinder_excess_slope=on_cylinder * excess_slope + on_cylinder_slope * limiter * g_c.value,
    )


class MomentChange(NamedTuple):
    """Changes of the rolling moments by the traction, dimensionless; they are added to the moments
    without traction.

    half_space, cylinder : the changes of M_half_space and M_cylinder.
    half_space_dQ, cylinder_dQ : their derivatives with respect to Q at fixed speed.
    half_space_du, cylinder_du : their derivatives with respect to u = kappa |V| at fixed Q.
    """

    half_space: float
    cylinder: float
    half_space_dQ: float
    cylinder_dQ: float
    half_space_du: float
    cylinder_du: float


@inline_kernel
def moment_change(Q, mu, reaction):
    """Return the changes of the rolling moments by the traction, as :class:`MomentChange`.

    Q : float, traction, dimensionless, |Q| <= mu.
    mu : float, coefficient of friction, > 0.
    reaction : :class:`Reaction` at the speed.
    """
    used = abs(Q) / mu  # Q (a + e |Q|/mu) has the derivative a + 2 e |Q|/mu in Q
    return MomentChange(
        half_space=-Q * (reaction.half_space + reaction.half_space_excess * used),
        cylinder=-Q * (reaction.cylinder + reaction.cylinder_excess * used),
        half_space_dQ=-(reaction.half_space + 2.0 * reaction.half_space_excess * used),
        cylinder_dQ=-(reaction.cylinder + 2.0 * reaction.cylinder_excess * used),
        half_space_du=-Q * (reaction.half_space_slope + reaction.half_space_excess_slope * used),
        cylinder_du=-Q * (reaction.cylinder_slope + reaction.cylinder_excess_slope * used),
    )


@inline_kernel
def length_change(Q, position, u, cover_rows):
    """Return the changes of length and shift of the contact by the traction, to first order.

    Q : float, traction in the direction of V, dimensionless, |Q| <= mu.
    position : :class:`.law_functions.RowPosition` of u in the rows of the law.
    u : float, kappa |V|, dimensionless, >= 0; read only beyond the last row.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces.
    Returns (change of lam, change of epsilon), floats, dimensionless; for half-spaces both are 0.0.
    """
    if cover_rows is None:
        return 0.0, 0.0
    if position.row < 0:
        tilt = PairOverSpeed(
            _limit_at(LAM_SLOPE_LIMIT, u, cover_rows), _limit_at(EPSILON_SLOPE_LIMIT, u, cover_rows)
        )
    else:
        tilt = _pair_at(TILT, position, cover_rows)
    return Q * tilt.first.value, Q * tilt.second.value


@inline_kernel
def slopes_of_cover(over_u, over_D, D, functions, pairs, state, cover_rows):
    """Return the derivatives of |Q|/mu with the variables u and creepage less that of free rolling,
    from those with the variables u and D.

    over_u, over_D : floats, derivatives with respect to u at fixed D and to D at fixed u,
        dimensionless.
    D : float, 2 kappa |d| delta_star/mu with the sign of the traction, finite.
    functions : :class:`.law_functions.LengthAndMoment` at the speed, of which L and dL are read.
    pairs : :class:`Pairs` at the speed, of which ``total`` is read.
    state : :class:`.law_record.State`, of which mu and the sign of V are read.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces: then ``over_u`` and ``over_D`` are returned.
    Returns (derivative with respect to u, derivative with respect to 2 kappa |delta - delta_0|/mu),
    floats, each with the other variable fixed.
    """
    if cover_rows is None:
        return over_u, over_D
    # With D = L |d|, s = sign d and E = 2 kappa |delta - delta_0|/mu = D + s c D^2/L:
    # dE/dD = 1 + 2 c d at fixed u, and at fixed E dD/du = s d^2 (c L' - c' L)/(1 + 2 c d).
    L = functions.L
    dL = functions.dL
    c = asymmetry_at(pairs, state.mu, L, dL, 0.0, cover_rows)
    d = (-D if state.V < 0.0 else D) / L
    over_creep = over_D / (1.0 + 2.0 * c.value * d)
    return over_u + np.sign(d) * over_creep * d * d * (c.value * dL - c.slope * L), over_creep


@inline_kernel
def free_kinematics(pairs, u, kappa, k, uL_slope, cover_rows):
    """Return the parts that the creepage without creep force, delta_0, adds to the kinematics of
    partial slip at one speed.

    pairs : :class:`Pairs` at that speed, of which f of ``total``, with its derivatives, is read.
    u : float, kappa |V|, dimensionless, >= 0.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    k : float, mu/(2 kappa), dimensionless, > 0.
    uL_slope : float, d(u L)/du, where L = 2 kappa delta_star/mu, dimensionless, > 0.
    cover_rows : vector of the numbers that only a cover has, as in the module; None for
        half-spaces, of which no other argument is read.
    Returns :class:`FreeCreep` of floats, dimensionless: delta_0; d(V delta_0)/dV divided by k d(u
    L)/du, which is added to d = (delta - delta_0)/delta_star in the kinematics; d^2(u delta_0)/du^2
    divided by k.  All are -0.0 for half-spaces, which a compiler leaves out of sums.
    """
    if cover_rows is None:
        return FreeCreep(-0.0, -0.0, -0.0)
    value, slope, curvature = pairs.total.first
    # with u delta_0 = u f/(2 kappa): its derivatives over u are (f + u f')/(2 kappa) and
    # (2 f' + u f'')/(2 kappa); d(V delta_0)/dV is the first of them
    factor = 0.5 / kappa
    return FreeCreep(
        factor * value,
        factor * (value + u * slope) / (k * uL_slope),
        factor * (2.0 * slope + u * curvature) / k,
    )
