"""Traction, stick zone and slopes of one state of the contact, from the rows of its law.

The traction is |Q|/mu = 1 - w^2 (H/F^2)(2 u/w) with w = L - D (letters below;
docs/internals_law.md, Rows).  At small creepage it is a small difference, as 1 = L^2 (H/F^2)(2
u/L).  With v1 = 2 u/L, v2 = 2 u/w, v2 - v1 = v2 D/L and the mean slope S of H/F^2 between them, 1 =
L^2 [(H/F^2)(v2) - S v2 D/L], so that nothing cancels in

    |Q|/mu = D [(2 L - D) (H/F^2)(v2) - v2 L S]

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.

Terms of this file and of :mod:`.contact_kernel`:

- Law: polynomials of the functions of one material, a row for each octave of u or v
  (:mod:`.law_record`); of many materials a part of a row is computed, and written into the law,
  when it is first read (:mod:`.law_functions`).  Beyond the last row the head of the rows, with the
  numbers of the fast limit, is read in place of a polynomial.
- RowPosition: where u or v lies in them: number of the row, argument t of its polynomials, slope
  dt/dx.
- u = kappa |V|: dimensionless speed.  L = 2 kappa delta_star/mu: critical creepage, a function of
  u.
- D = L |d|, of half-spaces 2 kappa |delta|/mu; of a cover d follows from the creepage less delta_0,
  that of free rolling, and from the asymmetry c of the onsets of full slip (:mod:`.cover_law`).
  D < L in partial slip, and infinite stands for full slip.
- v = 2 u/(L - D) = 1/F(eta), with eta half the transit time of the stick zone; H and F are
  functions of the material (:mod:`.law_functions`), of which only H/F^2 and eta/F occur, as
  functions of v. A NaN of u or v where L and D are finite has no meaning and is not checked.
- State: kappa, mu, V, and ``creep``, which is delta, or omega where ``creep_is_omega``.
"""

import numpy as np

from ..numerics.jit import inline_kernel
from .cover_law import MomentChange, moment_change, reduced_creep, shear_reaction, slopes_of_cover
from .law_functions import (
    H_over_F2,
    H_over_F2_secants,
    eta_over_F,
    locate_row,
)
from .law_record import slip_and_creepage

#: Fraction of L below which D is small: |Q|/mu as a difference would lose three bits and more.  A
#: larger one would send states with creep of 0.1 delta_star to the mean slopes, which take half as
#: long again.
SMALL_CREEP = 0.0625


@inline_kernel
def stick_argument(u, L, D):
    """Return v = 2 u/(L - D), the argument of the functions of the stick zone.

    u : float, kappa |V|, dimensionless, >= 0.
    L : float, 2 kappa delta_star/mu, dimensionless, > 0.
    D : float, L |d|, dimensionless, >= 0; infinite in full slip.
    Returns a float, dimensionless, >= 0 in partial slip, and 0 at u = 0.  In full slip it is -0.0,
    which has no meaning but may be located in the rows like any other v.  Where rounding makes D
    equal to L it is infinite (NaN at u = 0), and where rounding makes D larger it is negative:
    neither has a meaning.
    """
    return 2.0 * u / (L - D)


@inline_kernel
def _cancels(traction, D, L):
    """Return whether 1 - w^2 H/F^2 has lost so many digits that the form with the mean slope must
    be used instead.

    That is so where the difference is below 0.1 and D is below L/2.  From D = L/2 on the arguments
    2 u/L and v may be more than one row apart, for which the mean slope is not made, and the
    difference is used in spite of its rounding.

    traction : float, the difference 1 - w^2 H/F^2, which is |Q|/mu with rounding, dimensionless.
    D : float, L |d|, dimensionless, >= 0, finite.
    L : float, 2 kappa delta_star/mu, dimensionless, > 0.
    Returns a bool.
    """
    return traction < 0.1 and D < 0.5 * L


@inline_kernel
def friction_reserve(position, v, L, D, law):
    """Return the friction reserve 1 - |Q|/mu, which keeps all its digits where it is small.

    position : :class:`.law_functions.RowPosition` of v; like v it is not read in full slip.
    v : float, argument of the stick zone, of :func:`stick_argument`, dimensionless.
    L : float, 2 kappa delta_star/mu, dimensionless, > 0.
    D : float, L |d|, dimensionless, >= 0; infinite in full slip.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 are read.
    Returns a float in [0, 1], dimensionless: (L - D)^2 (H/F^2)(v), which is 1 to rounding at D = 0;
    0.0 in full slip (L <= D), and where L or D is NaN.
    """
    w = L - D
    # 1 at D = 0, where L^2 H/F^2 = 1 but for rounding, which may leave more; 0 for a NaN too
    reserve = w * w * H_over_F2(position, v, law)[0] if w > 0.0 else 0.0
    return 1.0 if reserve > 1.0 else reserve


@inline_kernel
def stick_fraction(position, v, lam, L, D, law):
    """Return beta, the length of the stick zone divided by the contact length.

    position : :class:`.law_functions.RowPosition` of v; like v it is not read in full slip and at D
        = 0.
    v : float, argument of the stick zone, of :func:`stick_argument`, dimensionless.
    lam : float, length of the contact divided by l0, dimensionless, > 0; not read in full slip and
    at D = 0.
    L : float, 2 kappa delta_star/mu, dimensionless, > 0.
    D : float, L |d|, dimensionless, >= 0; infinite in full slip.
    law : :class:`.law_record.Law` of the material, of which the polynomials of eta/F are read.
    Returns a float in [0, 1], dimensionless: exactly 1.0 at D = 0, else (eta/F)(v) (L - D)/lam; 0.0
    in full slip (L <= D), and where L or D is NaN.
    """
    w = L - D
    if not w > 0.0:  # full slip, or NaN
        return 0.0
    # beta = eta/zeta with eta = (eta/F)/v, v = 2 u/w and zeta = lam/(2 u): u cancels, so that it
    # holds at u = 0 too.  At D = 0 the whole contact sticks, exactly.
    beta = eta_over_F(position, v, law) * w / lam if D > 0.0 else 1.0
    return 1.0 if beta > 1.0 else beta


@inline_kernel
def traction_slopes(u, L, dL, D, law):
    """Return the slopes of |Q|/mu: over u at fixed D, and over D at fixed u.

    u : float, kappa |V|, dimensionless, >= 0.
    L, dL : floats, 2 kappa delta_star/mu, > 0, and its slope dL/du, dimensionless; dL is read only
        where the plain formula below is used: neither with the mean slopes nor in full slip.
    D : float, L |d|, dimensionless, >= 0; infinite in full slip.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 are read.
    Returns (slope over u, slope over D), floats, dimensionless; (0.0, 0.0) in full slip (L <= D),
    and where L or D is NaN.  With w = L - D, v = 2 u/w and A = H/F^2 - (v/2) d(H/F^2)/dv they
    are -2 w (A dL + d(H/F^2)/dv) and 2 w A.

    As in :func:`signed_traction`, mean slopes of H/F^2 and of its slope are used where D is below
    L/16 or a difference would lose digits.  With them the slope over u is 0 at D = 0 and at u = 0;
    from D = L/16 on the plain formula holds at u = 0 too, unless a difference would lose digits.
    """
    w = L - D
    if not w > 0.0:  # full slip, or NaN
        return 0.0, 0.0
    v = 2.0 * u / w
    position = locate_row(v, law)
    value, slope = H_over_F2(position, v, law)
    w_slope = value - 0.5 * v * slope  # A
    if D < SMALL_CREEP * L or _cancels(1.0 - w * w * value, D, L):
        x = D / w  # v/v1 - 1
        v1 = 2.0 * u / L
        _, secant, slope_secant = H_over_F2_secants(position, locate_row(v1, law), v, x, law)
        # With f = H/F^2: from L^2 f(2 u/L) = 1 follows dL/du = -f'/A at v1, so that A dL + f' of
        # the plain formula is a difference of values at v and v1, which is formed by mean slopes.
        step = v1 * x  # v - v1
        # f' and A at v1, from the values at v and the mean slopes between
        slope_1 = slope - slope_secant * step
        A_1 = value - secant * step - 0.5 * v1 * slope_1
        over_u = step * (
            (secant - 0.5 * (v * slope_secant + slope_1)) * slope_1 / A_1 - slope_secant
        )
    else:
        over_u = -(w_slope * dL + slope)
    return 2.0 * w * over_u, 2.0 * w * w_slope


@inline_kernel
def signed_creep(L, free_creep, asymmetry, state, cover_rows):
    """Return D = L |d| with the sign of the traction, and infinite in full slip.

    The state is in full slip where |d| >= 1, which includes omega other than 0 at V = 0 if omega is
    given.

    L : float, 2 kappa delta_star/mu at the speed of the state, dimensionless, > 0.
    free_creep, asymmetry : floats, 2 kappa delta_0, with delta_0 the creepage without creep force,
        and the asymmetry c, dimensionless; not read for half-spaces.
    state : :class:`.law_record.State` of numbers: V, kappa, mu, and delta or omega, dimensionless.
    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`), of which none is
        read; None for half-spaces.
    Returns a float, dimensionless: its sign is that of omega - V for half-spaces, that of (delta -
    delta_0) V for a cover, where V = 0.0 counts as V > 0; free rolling gives 0.0 or -0.0; full slip
    gives inf or -inf; NaN where the creepage is NaN, or ``free_creep`` of a cover.
    """
    slip, delta = slip_and_creepage(state)
    kappa = state.kappa
    mu = state.mu
    # A creepage that equals the field delta_star slips fully, exactly, and one that equals delta_0
    # gives exactly 0: both are formed by the operations of the fields, in their order.
    if cover_rows is None:
        full_slip = abs(delta) >= 0.5 * mu / kappa * L
        return np.copysign(np.inf if full_slip else 2.0 * kappa / mu * abs(delta), slip)
    beyond = delta - 0.5 * free_creep / kappa
    d = reduced_creep(2.0 * kappa * (1.0 / (mu * L)) * beyond, asymmetry)
    return np.copysign(np.inf if abs(d) >= 1.0 else L * abs(d), -d if state.V < 0.0 else d)


@inline_kernel
def signed_traction(position, v, u, L, signed_D, mu, law):
    """Return the traction Q, Eq. (15), divided by the load P; it keeps its digits at small creepage
    too.

    position : :class:`.law_functions.RowPosition` of v; like v it is not read in full slip.
    v : float, argument of the stick zone, of :func:`stick_argument`, dimensionless.
    u : float, kappa |V|, dimensionless, >= 0; read where the form with the mean slope is used.
    L : float, 2 kappa delta_star/mu, dimensionless, > 0.
    signed_D : float, L |d| with the sign of the traction, of :func:`signed_creep`, dimensionless;
        inf or -inf in full slip.
    mu : float, coefficient of friction, dimensionless, > 0.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 are read.

    Returns a float in [-mu, mu], dimensionless, with the sign of D, which may be that of -0.0; mu
    or -mu in full slip, where |D| is rounded to L or above, and where L or D is NaN.  With D for
    |D|, from D = L/16 on |Q|/mu is 1 - w^2 (H/F^2)(v) with w = L - D, unless that difference is
    small (:func:`_cancels`); else it is D [(2 L - D) (H/F^2)(v) - v L S] with the mean slope S of
    H/F^2 between 2 u/L and v.
    """
    D = abs(signed_D)
    w = L - D
    traction = 1.0  # |Q|/mu in full slip, also where w is 0 by rounding
    if w > 0.0:
        traction = 0.0  # of small creepage, which counts as cancelled
        if D >= SMALL_CREEP * L:
            value, _ = H_over_F2(position, v, law)
            traction = 1.0 - w * w * value
            traction = 1.0 if traction > 1.0 else traction
        if _cancels(traction, D, L):
            # The other end of the interval is 2 u/L = v/(1 + x), with x = L/w - 1 = D/w.
            near = locate_row(2.0 * u / L, law)
            value, secant, _ = H_over_F2_secants(position, near, v, D / w, law)
            traction = D * ((2.0 * L - D) * value - v * L * secant)
    return np.copysign(mu * traction, signed_D)


@inline_kernel
def Q_slopes(u, functions, pairs, D, state, law):
    """Return the slopes of the traction Q, divided by the load P, over speed, creepage and angular
    velocity.

    u : float, kappa |V|, dimensionless, >= 0.
    functions : :class:`.law_functions.LengthAndMoment` at the speed, of which L and dL are read.
    pairs : :class:`.cover_law.Pairs` at the speed (:func:`.cover_law.pairs_at`), zeros of
        half-spaces.
    D : float, L |d| with the sign of the traction, of :func:`signed_creep`,
        dimensionless; inf or -inf in full slip, where nothing else is read.
    state : :class:`.law_record.State` of numbers: V, kappa, mu, and delta or omega, dimensionless.
    law : :class:`.law_record.Law` of the material, of which the polynomials of H/F^2 are read.

    Returns (dQ/dV, dQ/ddelta, dQ/domega), floats, dimensionless.  The first is taken at fixed delta
    or at fixed omega, whichever ``state`` has, the others at fixed V.  All are 0 in full slip,
    where |D| >= L; a state of partial slip whose D is rounded to L counts as one of full slip.  In
    partial slip at V = 0 the last is infinite, since omega = V (1 + delta) then changes delta
    without bound, and so is the first if omega is given.
    """
    if abs(D) >= functions.L:
        return 0.0, 0.0, 0.0
    over_u, over_D = traction_slopes(u, functions.L, functions.dL, abs(D), law)
    over_u, over_D = slopes_of_cover(over_u, over_D, D, functions, pairs, state, law.cover_rows)
    # Q = +-mu |Q|/mu with D = 2 kappa |delta|/mu and u = kappa |V|; delta = omega/V - 1 at fixed V.
    # ``over_delta`` is the slope for V > 0; for V < 0 Q has the sign of -delta, and the slope the
    # opposite sign: dQ/domega = (dQ/ddelta)/V is over_delta/|V| for both.
    over_delta = 2.0 * state.kappa * over_D
    over_omega = over_delta / abs(state.V)
    # The sign of Q, which is that of D, times that of du/dV.
    over_V = np.sign(-D if state.V < 0.0 else D) * state.mu * state.kappa * over_u
    # From fixed delta - delta_0 to fixed delta: delta_0 of a cover changes with the speed, by
    # d delta_0/dV = (du/dV)/(2 kappa) d(2 kappa delta_0)/du, with du/dV = kappa for V > 0.
    over_V -= 0.5 * over_delta * pairs.total.first.slope
    if state.creep_is_omega:  # d delta/dV = -omega/V^2 = -(1 + delta)/V at fixed omega
        over_V -= over_omega * (1.0 + slip_and_creepage(state)[1])
    return over_V, -over_delta if state.V < 0.0 else over_delta, over_omega


@inline_kernel
def traction_on_moments(pairs, functions, Q, state, cover_rows):
    """Return what the traction changes in the rolling moments of a state, as
    :class:`.cover_law.MomentChange`.

    pairs : :class:`.cover_law.Pairs` at the speed (:func:`.cover_law.pairs_at`); not read for
        half-spaces.
    functions : :class:`.law_functions.LengthAndMoment` at that speed, of which L and dL are read.
    Q : float, traction of the state, dimensionless.
    state : :class:`.law_record.State` of numbers, of which kappa and mu are read.
    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None for
    half-spaces: all changes are 0.
    """
    if cover_rows is None:  # -0.0, as a sum with it keeps the sign of a zero
        return MomentChange(-0.0, -0.0, 0.0, 0.0, 0.0, 0.0)
    reaction = shear_reaction(pairs, state.kappa, state.mu, functions.L, functions.dL, cover_rows)
    return moment_change(Q, state.mu, reaction)


@inline_kernel
def moment_slope(change_dQ, slope):
    """Return the slope of a moment over creepage or omega at fixed speed, dimensionless; 0 where it
    does not depend on Q.

    change_dQ : float, derivative of :class:`.cover_law.MomentChange` in Q; 0 of half-spaces.
    slope : float, slope of Q over the same variable; it may be infinite at rest.
    """
    # without the test the 0 of half-spaces times an infinite slope would be NaN
    return change_dQ * slope if change_dQ != 0.0 else 0.0


@inline_kernel
def moment_slope_over_V(change_du, change_dQ, dQ_dV, state):
    """Return what the traction adds to dM/dV of a body, or of both, a float, dimensionless.

    change_du, change_dQ : floats, derivatives of :class:`.cover_law.MomentChange` of the body over
    u and in Q.
    dQ_dV : float, slope of the traction, at fixed creepage or omega.
    state : :class:`.law_record.State` of numbers, of which kappa and the sign of V are read.
    """
    # du/dV = kappa with the sign of V, at fixed Q; then Q changes with V at fixed u
    return np.copysign(state.kappa, state.V) * change_du + moment_slope(change_dQ, dQ_dV)
