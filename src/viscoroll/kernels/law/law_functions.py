"""Functions of one speed, from the rows of the law, and the speeds at which they equal a load.

The functions are polynomials in the rows of the law and, beyond the last row, the fast limit:

    law_record.select_material(law, n)      ``law`` is now that of motion or state n
    position = locate_row(x, law)           row of x = u, or of x = v
    length_and_moment(position, u, law)     L and M/V with their slopes
    H_over_F2(position, v, law)             H/F^2 and its slope over v

Terms of this file:

- u = kappa |V|: dimensionless speed, >= 0.  L = lam (1 + epsilon) = 2 kappa delta_star/mu.
- D = 2 kappa |delta|/mu: creepage, of a cover less that of free rolling; D < L in partial slip.
- zeta, eta: half the transit time of the contact and of its stick zone, divided by the unit of time
  of the law, which is T_epsilon of one relaxation time and T_ref of a series.  F(z) = z + g(z) and
  H(z) = z^2 + 2 z h(z) with functions g and h of the material (:mod:`.material_series`): Eq. (10)
  is F(eta) = (L - D)/(2 u), and v = 1/F(eta), >= 0.
- Fast limit: the expansion of the functions for large u or v, used beyond the last row.  Its
  numbers in the head of the rows: alpha, lam_fast = alpha^(-1/2), W = sum J_j/T_j, C = sum J_j/T_j
  (ln 2 T_j - 0.5772), with the strengths J_j and times T_j of the creep modes.  A cover has 1/L^2,
  L, 0 and a number for C in their place, with L in its limit u -> infinity, so that the same
  formulas hold.
- M: rolling moment divided by P R, the normal load times the radius of the cylinder; kappa = R/l0.
- Load curve: kappa (M - gain V) as a function of u, with ``gain`` the slope over V of a force plus
  torque that rises or falls with the speed.  A load is kappa times a force plus torque that does
  not depend on the speed: kappa (M - gain V) = load is one equation between two nodes between
  which its left side is monotone, as kappa M is a function of u alone.

``law`` is a :class:`.law_record.Law` whatever made its rows, so that its readers are compiled once.
The law of one material (``LawTable.record``) has all its rows, and all threads share it.  The law
of one alpha for each state (:func:`.laws_per_element.record_of_alphas`) or one material for each
(:func:`.laws_per_element.record_of_materials`) belongs to one thread, which makes it for a block of
states or motions.

Such a law has one material selected at a time.  ``select_material`` gives a new material the next
version number and writes its head; nothing else is touched.  A part of a row bears the version that
it was made for.  A reader that finds another one calls the maker by its address.  So nothing is
cleared from motion to motion, and a motion pays only for the parts that it reads.  A part depends
on its material alone, not on what was read before.  Select the material before the first
``locate_row``: positions of another material mean nothing.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numerics.intrinsics import bits_to_float, float_to_bits, unlikely
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import evaluate_pair, evaluate_secants, evaluate_single
from .cover_law import (
    EPSILON_LIMIT,
    ETA_OVER_F_LIMIT,
    LAM_LIMIT,
    MOMENT_LIMIT,
    fast_quotient,
    fast_value,
    pairs_at,
)
from .law_record import (
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
)

# --- The functions of the law, evaluated from its rows and, beyond the last row ---

#: Row of a position beyond the last row, where the fast limit holds.
FAST_LIMIT = -1
#: Biased exponent of 1/2 in the bits of a double.
_EXPONENT_OF_HALF = 1022
#: Biased exponent of 4 in the bits of a double.
_EXPONENT_OF_4 = 1025
#: Bits of the double 3.
_BITS_OF_3 = 0x4008 << 48


class RowPosition(NamedTuple):
    """Position of a variable x = u or v in the rows.

    row : int, number of the row, or :data:`FAST_LIMIT` = -1 beyond the last one.
    t : argument of its polynomials, in [-1, 1), of row 0 in [0, 1); not to be read with FAST_LIMIT.
    dt_dx : slope of t over x; not to be read with FAST_LIMIT.
    """

    row: int
    t: float
    dt_dx: float


class LengthAndMoment(NamedTuple):
    """L = 2 kappa delta_star/mu and M/V at one speed, dimensionless.

    L, dL, ddL : L and its first two derivatives over u.
    m : M/V divided by ``scale``.
    scale : 1; in the fast limit z = lam_fast/(2 u), since M/V itself may underflow there.
    d_um : d(u M/V)/du = dM/dV, not divided by ``scale``.
    """

    L: float
    dL: float
    ddL: float
    m: float
    scale: float
    d_um: float


@inline_kernel
def locate_octave(x, e0):
    """Return the position of x in rows that span one octave each.

    x : float, >= 0, dimensionless.
    e0 : int, binary exponent; row 0 spans [0, 2^e0), row n > 0 spans [2^(e0 + n - 1), 2^(e0 + n)).

    Returns (row, t, dt/dx).  row: int, number of the row, without upper bound, as the number of
    rows of a law is not known here.  t: float, argument of its polynomials: x 2^-e0, in [0, 1), in
    row 0, else in [-1, 1).  dt/dx: float, slope of t, constant in a row.  -0.0 is in row 0, an
    infinite x is beyond the rows of every law; a NaN is in row 0 or beyond all rows, by its sign
    bit; t of both is NaN.
    """
    # The biased exponent of x in its bits: x = m 2^(e0 + row) with m in [1/2, 1).
    row = (float_to_bits(x) >> 52) - _EXPONENT_OF_HALF - e0
    # -1 in row 0, else 0: by arithmetic, since a branch would be mispredicted on scattered speeds;
    # the shift leaves the sign bit of row - 1 in all bits, so that ~slow masks out what is of row 0
    slow = (row - 1) >> 63
    row &= ~slow
    # 2^(2 - e0 - row), of row 0 2^-e0; t = 4 m - 3, of row 0 x 2^-e0: the bits of 3 become those of
    # 0 there.
    dt_dx = bits_to_float((_EXPONENT_OF_4 - e0 - row + 2 * slow) << 52)
    return row, x * dt_dx - bits_to_float(_BITS_OF_3 & ~slow), dt_dx


@inline_kernel
def locate_row(x, law):
    """Return the :class:`RowPosition` of u or v in the rows of a law.

    x : float, u or v, dimensionless, >= 0.
    law : :class:`.law_record.Law`, with its material selected, of whose ``marks`` e0 and the number
    of rows are read.
    Returns the position; its row is :data:`FAST_LIMIT` = -1 beyond the last row, also for infinity.
    A NaN has t NaN, in row 0 or in FAST_LIMIT by its sign bit.
    """
    row, t, dt_dx = locate_octave(x, law.marks[E0])
    # one number, -1, for all rows beyond the last, which have no memory; in_fast_limit reads it
    return RowPosition(row if row < law.marks[ROW_COUNT] else FAST_LIMIT, t, dt_dx)


@inline_kernel
def in_fast_limit(position):
    """Return whether a :class:`RowPosition` lies beyond the last row, in the fast limit, a bool;
    LLVM is told that this is rare.
    """
    return unlikely(position.row < 0)


# --- functions of u = kappa |V| ---


@inline_kernel
def _fast_terms(u, body, law):
    """Return the terms of which the fast limit, the expansion of the functions for u beyond the
    last row, consists.

    u : float, kappa |V|, dimensionless, > 0 and finite.
    body : int, index in the head of the rows: FAST_TOTAL for both bodies, FAST_HALF_SPACE or
        FAST_CYLINDER for one.  W of it is at this index, C at the next one.
    law : :class:`.law_record.Law` of the material, of which the head of ``rows`` is read.

    Returns (z, shift, part), floats, dimensionless: z = lam_fast/(2 u), which is zeta in the limit;
    shift = (alpha z/2) (C - W ln z); part = alpha z W/8.  With W and C of both bodies shift is
    epsilon of a half-space, and of a cover the relative change of L; with those of one body shift +
    part is its M/V divided by z.  Of a cover part is 0; of elastic bodies both are 0.
    """
    alpha = law.rows[ALPHA]
    W = law.rows[body]
    C = law.rows[body + 1]
    # zeta = lam/(2 u) with lam in the limit: this expansion has no term of lam that is linear in z
    z = 0.5 * law.rows[LAM_FAST] / u
    return z, 0.5 * alpha * z * (C - W * np.log(z)), 0.125 * alpha * z * W


@inline_kernel
def length_and_moment(position, u, law):
    """Return L = 2 kappa delta_star/mu, dL/du, d2L/du2, M/V and d(u M/V)/du, as
    :class:`LengthAndMoment`.

    position : :class:`RowPosition` of u, in which the polynomials are evaluated.
    u : float, kappa |V|, dimensionless, >= 0 and finite; in the rows it is read for ``d_um`` alone.
    law : :class:`.law_record.Law` of the material, of which the polynomials of L and M/V or, beyond
        the last row, the head are read.

    Returns floats.  ``m`` is M/V itself in the rows, with ``scale`` 1; beyond the last row it is
    M/V divided by z = lam_fast/(2 u), with ``scale`` z.  ``d_um``, d(u M/V)/du, is not divided by
    ``scale``.  At u = 0 L of half-spaces is 1 and M/V has its finite limit; of elastic bodies M/V
    is 0.  The compiler leaves out the fields that a caller does not read.
    """
    if in_fast_limit(position):
        lam = law.rows[LAM_FAST]
        z, shift, part = _fast_terms(u, FAST_TOTAL, law)
        # As z falls like 1/u, u d(shift)/du = -(shift - 4 part) and u d(part)/du = -part.
        decrease = shift - 4.0 * part
        # L = lam (1 + shift); u d(decrease)/du = -(decrease - 4 part), again by these two slopes
        dL = -(lam / u) * decrease
        ddL = lam / u * (2.0 * decrease - 4.0 * part) / u
        moment = fast_quotient(MOMENT_LIMIT, u, shift, law.cover_rows)
        # d(u z m)/du with u z constant: z u dm/du.  m is moment + part with u d(moment)/du =
        # 4 part - moment: of half-spaces moment is shift, of a cover it is in 1/u and part is 0.
        return LengthAndMoment(
            L=lam * (1.0 + shift),
            dL=dL,
            ddL=ddL,
            m=moment + part,
            scale=z,
            d_um=z * (3.0 * part - moment),
        )
    dt = position.dt_dx
    L, m, dL, dm, ddL, _ = evaluate_pair(
        law.rows, ensure_part(LENGTH_MOMENT, position.row, law), position.t
    )
    return LengthAndMoment(L=L, dL=dL * dt, ddL=ddL * dt * dt, m=m, scale=1.0, d_um=m + u * dt * dm)


@inline_kernel
def moment_factor(position, u, scale, state):
    """Return the factor by which m, which is M/V divided by ``scale``, becomes M: V, or V z in the
    fast limit.

    position : :class:`RowPosition` of u, which tells whether u is beyond the last row.
    u : float, kappa |V|, dimensionless, >= 0; not read in the rows.
    scale : float, ``scale`` of the :class:`LengthAndMoment` at u: 1, or z in the fast limit; not
    read in the rows.
    state : :class:`.law_record.State`, of which V (with its sign) and, beyond the last row, kappa
        are read.
    Returns a float with the sign of V, dimensionless: V itself in the rows, 0 at V = 0.
    """
    # z |V| from u = kappa |V|, which has no sign
    return np.copysign(scale * u / state.kappa, state.V) if in_fast_limit(position) else state.V


@inline_kernel
def lam_and_epsilon(position, u, law):
    """Return length and shift of the contact at u, Eqs. (6) and (8).

    position : :class:`RowPosition` of u, in which the polynomials are evaluated.
    u : float, kappa |V|, dimensionless, >= 0 and finite; in the rows it is not read.
    law : :class:`.law_record.Law` of the material, of which the polynomials of lam and epsilon or,
        beyond the last row, the head are read.
    Returns (lam, epsilon), floats, dimensionless: length divided by l0, from 1 down to alpha^(-1/2)
    for half-spaces; shift in half contact lengths, 0 at u = 0 and for elastic half-spaces, and -> 0
    for u -> infinity.
    """
    if in_fast_limit(position):
        _, shift, _ = _fast_terms(u, FAST_TOTAL, law)
        lam = fast_value(LAM_LIMIT, u, law.rows[LAM_FAST], law.cover_rows)
        return lam, fast_quotient(EPSILON_LIMIT, u, shift, law.cover_rows)
    return evaluate_pair(law.rows, ensure_part(LAM_EPSILON, position.row, law), position.t)[:2]


@inline_kernel
def body_moments(position, u, law):
    """Return the parts of M/V that half-space and cylinder take, and their slopes d(u M/V)/du =
    dM/dV.

    position : :class:`RowPosition` of u, in which the polynomials are evaluated.
    u : float, kappa |V|, dimensionless, >= 0 and finite.
    law : :class:`.law_record.Law` of the material, not one of the axis of alpha
        (:mod:`.alpha_axis`), which has no rows of these parts: there each is half of M/V.

    Returns (m_half_space, m_cylinder, slope of the half-space, slope of the cylinder), floats,
    dimensionless; the first two are divided by ``scale`` of the :class:`LengthAndMoment` at u,
    which is 1 in the rows and z = lam_fast/(2 u) in the fast limit; the slopes are not.  Of a cover
    all of M counts as that of the body with the layer, and the other body has 0; where both relax,
    these parts have no meaning.
    """
    if in_fast_limit(position):
        z, half_space, part = _fast_terms(u, FAST_HALF_SPACE, law)
        _, cylinder, other = _fast_terms(u, FAST_CYLINDER, law)
        # slopes as in length_and_moment, with W and C of one body
        return (
            half_space + part,
            cylinder + other,
            z * (3.0 * part - half_space),
            z * (3.0 * other - cylinder),
        )
    start = ensure_part(BODY_MOMENTS, position.row, law)
    half_space, cylinder, d_half_space, d_cylinder, _, _ = evaluate_pair(
        law.rows, start, position.t
    )
    factor = u * position.dt_dx  # d(u m)/du = m + u dm/du, with the slope of m in t
    return half_space, cylinder, half_space + factor * d_half_space, cylinder + factor * d_cylinder


@inline_kernel
def free_creep_and_slopes(u, law):
    """Return 2 kappa delta_0, from the creepage without creep force, with its first two derivatives
    over u.

    u : float, kappa |V|, dimensionless, >= 0.
    law : :class:`.law_record.Law` of the material, of which marks and ``cover_rows`` are read.
    Returns :class:`.cover_law.OverSpeed`, dimensionless, of either sign; a cover on the cylinder
    has the other sign than the same on the base; 0.0 each of half-spaces, at no cost.
    """
    return pairs_at(locate_row(u, law), u, law.cover_rows).total.first


@inline_kernel
def limits_at_rest(kappa, law):
    """Return L = 2 kappa delta_star/mu and the creepage without creep force in the limit V -> 0.

    The departure from rest and the exponential decay of a motion are decided with them.

    kappa : float, slenderness R/l0, dimensionless, > 0; not read for half-spaces.
    law : :class:`.law_record.Law` of the material, of which, if it is a cover, L and delta_0 in row
        0 are read.
    Returns (L, delta_0), floats, dimensionless: L > 0, delta_0 of either sign; for half-spaces
    (1.0, -0.0), of which a compiler leaves the second out of sums.
    """
    if law.cover_rows is None:
        return 1.0, -0.0
    position = locate_row(0.0, law)  # row 0, t = 0: limits are the constants of its polynomials
    free_creep = pairs_at(position, 0.0, law.cover_rows).total.first.value
    return length_and_moment(position, 0.0, law).L, 0.5 * free_creep / kappa


# --- functions of v = 1/F(eta), y = 1/v ---


@inline_kernel
def _half_space_eta_over_F(y, law):
    """Return eta/F of a half-space in the fast limit, 1 - (alpha y/2) (C - W ln y), and minus its
    slope over y.

    y : float, F(eta) = 1/v, dimensionless, >= 0.
    law : :class:`.law_record.Law` of the material, of whose head alpha, W and C of both bodies are
        read.

    Returns (eta/F, -d(eta/F)/dy), floats, dimensionless.  At y = 0 the first is 1; the second
    is -alpha W/2 there, which is a placeholder, as the slope is infinite for W > 0.  Its users
    multiply it by a power of y, which is 0.
    """
    half_alpha = 0.5 * law.rows[ALPHA]
    W = law.rows[FAST_TOTAL]
    # at y = 0, v infinite, the logarithm would make y times the bracket a NaN; the product is 0
    bracket = law.rows[FAST_TOTAL + 1] - W * np.log(y) if y > 0.0 else 0.0
    return 1.0 - half_alpha * y * bracket, half_alpha * (bracket - W)


@inline_kernel
def eta_over_F(position, v, law):
    """Return eta/F, from which the stick zone follows; unlike eta it is bounded for every v.

    eta = beta zeta is half the transit time of the stick zone, Eq. (10), and F = 1/v, so that
    beta = (eta/F)/(v zeta).  A law whose rows are made when they are needed computes the row, if it
    is missing, and stores it in ``law``.

    position : :class:`RowPosition` of v, in which the polynomial is evaluated.
    v : float, 1/F(eta), dimensionless, >= 0, which may be infinite; in the rows it is not read.
    law : :class:`.law_record.Law` of the material, of which the polynomials of eta/F or, beyond the
        last row, the head and ``cover_rows`` are read.
    Returns a float, dimensionless: for half-spaces it is in (0, 1], and 1 at v = 0 and at infinity;
    for a cover it is lam/L of the speed at which v = 2 u/L.
    """
    if in_fast_limit(position):
        half_space, _ = _half_space_eta_over_F(1.0 / v, law)
        return fast_value(ETA_OVER_F_LIMIT, v, half_space, law.cover_rows)
    return evaluate_single(law.rows, ensure_part(ETA_OVER_F, position.row, law), position.t)[0]


@inline_kernel
def H_over_F2(position, v, law):
    """Return the function H/F^2 of v, which gives the traction, and its slope over v.

    position : :class:`RowPosition` of v, in which the polynomial is evaluated.
    v : float, 1/F(eta), dimensionless, >= 0, which may be infinite; in the rows it is not read.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 or, beyond the
    last row, the head are read.

    The traction is |Q|/mu = 1 - w^2 H/F^2 at v = 2 u/w, with w = 2 kappa (delta_star - |delta -
    delta_0|)/mu.
    Returns (value, slope), floats, dimensionless, value > 0.  For half-spaces the value goes from 1
    at v = 0 to alpha at infinity, where the slope is 0; it is 1/L^2 at v = 2 u/L for every
    material.
    """
    if in_fast_limit(position):
        alpha = law.rows[ALPHA]
        y = 1.0 / v
        # H/F^2 = alpha (eta/F)^2; d_eta is minus the slope over y, and dy/dv = -y^2
        eta, d_eta = _half_space_eta_over_F(y, law)
        return alpha * eta * eta, 2.0 * alpha * eta * d_eta * y * y
    value, slope = evaluate_single(law.rows, ensure_part(H_OVER_F2, position.row, law), position.t)
    return value, slope * position.dt_dx


@inline_kernel
def H_over_F2_secants(position, near, v, x, law):
    """Return H/F^2 at v, and the mean slopes of it and of its slope between v/(1 + x) and v,
    without cancellation.

    position : :class:`RowPosition` of v.
    near : :class:`RowPosition` of v/(1 + x), in the same row or in the one before; not read where v
        is beyond the last row, as the fast limit then serves the whole interval.
    v : float, 1/F(eta), dimensionless, >= 0.
    x : float, ratio of v to the other argument, less 1, dimensionless, in [0, 1]; 0 gives the
    slopes at v.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 or, beyond the
    last row, the head are read.

    Returns (value, mean slope of the value, mean slope of the slope), floats, all over v,
    dimensionless.  At x = 0, where both ends are v, the mean slopes are the slope and the second
    derivative.  Where the ends are in two rows, a mean slope is the sum of those in either row,
    weighted by their shares of the interval.
    """
    if in_fast_limit(position):
        return H_over_F2(position, v, law)[0], *_fast_secants(v, x, law)
    dt = position.dt_dx
    end = near.t if near.row == position.row else -1.0  # -1: the begin of the row of v
    value, secant, _, slope_secant = evaluate_secants(
        law.rows, ensure_part(H_OVER_F2, position.row, law), position.t, end
    )
    # from t to v: a slope has the factor dt/dv, the secant of the slope has it twice
    secant *= dt
    slope_secant *= dt * dt
    if near.row != position.row:
        near_dt = near.dt_dx
        start = ensure_part(H_OVER_F2, near.row, law)
        # the part of the interval in the row before, up to its end, t = 1
        _, near_secant, _, near_slope_secant = evaluate_secants(law.rows, start, 1.0, near.t)
        # Fraction of the interval, of length v x/(1 + x), that lies in the row of v, which begins
        # (t + 1)/dt before v; rounding may leave more than 1.
        part = (position.t + 1.0) * (1.0 + x) / (dt * v * x)
        part = 1.0 if part > 1.0 else part
        secant = part * secant + (1.0 - part) * near_secant * near_dt
        slope_secant = part * slope_secant + (1.0 - part) * near_slope_secant * near_dt * near_dt
    return value, secant, slope_secant


@kernel
def _fast_secants(v, x, law):
    """Return the mean slopes of H/F^2 and of its slope between v/(1 + x) and v in the fast limit,
    without cancellation.

    v : float, 1/F(eta), dimensionless, > 0, which may be infinite.
    x : float, ratio of v to the other argument, less 1, dimensionless, >= 0; 0 gives the slopes at
    v.
    law : :class:`.law_record.Law` of the material, of whose head alpha, W and C of both bodies are
        read.
    Returns (mean slope of H/F^2, mean slope of d(H/F^2)/dv), floats, over v, dimensionless; at x =
    0 they are the slope and the second derivative at v; both are 0 for elastic bodies and at v =
    infinity.
    """
    alpha = law.rows[ALPHA]
    W = law.rows[FAST_TOTAL]
    y = 1.0 / v
    near_y = y * (1.0 + x)
    eta, d_eta = _half_space_eta_over_F(y, law)
    near_eta, near_d_eta = _half_space_eta_over_F(near_y, law)
    # H/F^2 = alpha e^2 with e = eta/F, and de/dv = y^2 d_eta.  ``secant`` and ``slope_secant`` are
    # the mean slopes over v of e and of de/dv.  Between near_y = y (1 + x) and y, 1/y - 1/near_y =
    # x/near_y, ln near_y - ln y = ln(1 + x), and the mean slope of y ln y is ln near_y + ln(1 +
    # x)/x.
    mean = W * (np.log1p(x) / x if x > 0.0 else 1.0)
    secant = y * near_y * (near_d_eta + 0.5 * alpha * (W - mean))
    slope_secant = near_y * (0.5 * alpha * near_y * near_y * mean - y * (y + near_y) * d_eta)
    # Mean slopes of a product: those of its factors, each times the value of the other at one end.
    return alpha * (eta + near_eta) * secant, 2.0 * alpha * (
        eta * slope_secant + near_d_eta * near_y * near_y * secant
    )


# --- The speeds at which kappa (M(V) - gain V) equals a load, over arrays ---

#: A load this close to an extremum, relative, is taken to be at it: some ulp of kappa M.
EXTREMUM_RTOL = 1e-15
#: Newton steps after which an iteration ends; with bisection in its bracket it needs fewer.
_MAX_STEPS = 40
#: A Newton step of this size in ln u, divided by the distance from an extremum, leaves its square,
#: which is rounding.
_LAST_STEP = 1e-8


class LoadCurve(NamedTuple):
    """Nodes of kappa (M - gain V) by rising speed; all dimensionless.

    u : kappa V, > 0, (n,).
    value : kappa (M - gain V), (n,), monotone between two nodes.
    is_extremum : bool, whether a node is an extremum of the curve, (n,).
    gain : slope of force plus torque over V, of either sign.
    """

    u: Any
    value: Any
    is_extremum: Any
    gain: float


@kernel
def _find_crossing(load, n, curve, law):
    """Return u between the nodes ``n`` and n + 1 where the curve equals ``load``: Newton's
    iteration in a bracket.

    load : float, value of kappa (M - gain V), between those of the two nodes, dimensionless; not
    checked.
    n : int, index of the lower node, from 0 to the number of nodes - 2.
    curve : :class:`LoadCurve`: nodes u, kappa (M - gain V) there, whether it is an extremum, gain.
    law : :class:`.law_record.Law` of the material, of which the polynomials of M/V or, beyond the
    last row, the head are read.
    Returns u = kappa V, a float, > 0, dimensionless, from u of node n to that of node n + 1.  Where
    the load equals an extremum at the node n + 1 to rounding (EXTREMUM_RTOL), it is that node;
    where it equals one at the node n to rounding, it is that node to about the square root of
    rounding, 5e-8 relative.

    The iteration, in ln u, starts from interpolation between the nodes, and takes the middle of the
    bracket where a step would leave it.  It ends when a step is so small that the next one would be
    rounding, at the latest after 40 steps.  Beside an extremum steps may end in rounding, above the
    bound.  The last one is then as near as others: 4e-15 of the load, measured.
    """
    low = curve.u[n]
    high = curve.u[n + 1]
    rise = curve.value[n + 1] - curve.value[n]
    if curve.is_extremum[n + 1] and abs(load - curve.value[n + 1]) <= EXTREMUM_RTOL * abs(load):
        return high
    # First guess: fraction of the interval in ln u.  ``top`` is the u of an extremum at a node; 0
    # without one: the bound of the last step, at the end of the loop, is then _LAST_STEP itself.
    part = (load - curve.value[n]) / rise
    top = 0.0
    if curve.is_extremum[n]:  # beside an extremum the curve is a parabola
        part = np.sqrt(part)
        top = low
    elif curve.is_extremum[n + 1]:
        part = 1.0 - np.sqrt(1.0 - part)
        top = high
    u = low * (high / low) ** part
    for _ in range(_MAX_STEPS):
        functions = length_and_moment(locate_row(u, law), u, law)
        value = u * functions.scale * functions.m - u * curve.gain
        slope = u * (functions.d_um - curve.gain)  # over ln u
        # the crossing is above u where a rising curve is below the load, or a falling one above it
        if (value <= load) == (rise > 0.0):
            low = u
        else:
            high = u
        step = (load - value) / slope
        new = u * np.exp(step)
        if not low <= new <= high:  # Outside the bracket, or NaN: its middle in ln u, and go on.
            new = np.sqrt(low) * np.sqrt(high)  # the product of both may overflow or underflow
            step = 1.0  # not small, so that the iteration goes on
        old = u
        u = new
        if abs(step) <= _LAST_STEP * min(1.0, abs(old - top) / old):
            break
    return u


@kernel
def crossing_loop(law, curve, load, node, out, start, stop):
    """Find u = kappa V where kappa (M(V) - gain V) equals each load.

    law : :class:`.law_record.Law` of the material, of which the polynomials of M/V or, beyond the
    last row, the head are read.
    curve : :class:`LoadCurve`: nodes u, kappa (M - gain V) there, whether it is an extremum, gain.
    load : values of kappa (M - gain V), (n,), dimensionless, each between the values at its two
    nodes; not checked.
    node : for each load the index of the node below the crossing, from 0 to the number of nodes -
    2, int, (n,).
    out : (n,) floats, of which the numbers ``start`` to ``stop`` - 1 are written: u > 0,
        dimensionless, between the two nodes of the load.
    start, stop : int, index of the first load and of the one after the last.  Returns nothing.
    """
    for n in range(start, stop):
        out[n] = _find_crossing(load[n], node[n], curve, law)
