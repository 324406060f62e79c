"""Departure from rest: at V = omega = 0 the cylinder stays, rolls off in partial slip, or slides
off in full slip.

In rolling off, in the direction with V' > 0, d = delta/delta_star is the root of the right side of
the equation of d of :mod:`rhs` in the limit V -> 0, where L = 1 and H(v) = 1.  With the traction Q

    2 kappa (omega' - V')/mu = d V'      Q = mu sign(d) (2 |d| - d^2)

(of a cover with L (d + c d^2) + 2 kappa delta_0/mu in place of d on the right, with the asymmetry c
of :mod:`.cover_law`).  V' and omega' follow from Q by Eq. (22), where the rolling moment is 0.

Where V' > 0, as in every departure, the left side less the right side decreases with d from d = -2
kappa/mu on, and a root at that d has omega' = 0.  Where mu <= 2 kappa these are all |d| < 1: there
is at most one root with V' > 0, and if there is none, slip is full from the start.  Where mu > 2
kappa it may increase below that d, and under a force close to the limit of friction the departure
may be not unique.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- L = 2 kappa delta_star/mu and delta_0, the creepage without creep force, in the limit V -> 0: 1
  and 0 for half-spaces.
- d of a cover: d + c d^2 = (delta - delta_0)/delta_star.
- tau: time gamma t.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Load: the drive at one time in the direction of the Regime: force, torque, slopes of a prescribed
  V or omega, largest torque of the brake, inverse_mass (1, or 0 where V is prescribed),
  inverse_inertia (1/j, or 0 where omega is prescribed or held by the brake) and the gains of the
  feedback.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

import numpy as np

from ..law.cover_law import reduced_creep
from ..numerics.intrinsics import by_value
from ..numerics.jit import inline_kernel, kernel
from ..records import REGIME_AT_REST, Load, Regime
from .collocation import change_slip
from .drive import evaluate_load, has_brake, is_constant, segment_end
from .motion_law import (
    added_inertia,
    asymmetry_at_speed,
    creep_over_L,
    pull_at_rest,
    reaction_at_rest,
    rest_limits,
)
from .regimes import change_brake
from .table_law import balance_of_table

#: Code of a departure: the cylinder stays at rest for a time.
STAYS_AT_REST = 0
#: Code of a departure: the cylinder departs in partial slip.
ROLLS_OFF = 1
#: Code of a departure: the cylinder departs in full slip.
SLIDES_OFF = 2
#: Code of a departure: two motions satisfy the equations, the departure is not unique.
AMBIGUOUS = 3
#: Code of a departure: with the added mass no motion satisfies the equations.
NO_DEPARTURE = 4
#: Largest number of Newton iterations for d: a step outside the bracket bisects it, and 200
#: bisections of [-1, 1] reach |d| = 1e-60.
_MAX_ITERATIONS = 200
#: Newton's iteration for d ends at this relative change, below the unit of rounding: d changes no
#: more.
_D_TOLERANCE = 1e-16
#: The drive is evaluated later by this fraction of the time to the end of its segment, if nothing
#: moves the cylinder at the start of the segment: its slope then decides.
_LOOKAHEAD = 1e-6
#: Rounding error of the forces at rest, divided by the limits of friction and brake: some units of
#: rounding.  A force that equals its limit to within it is held, and a brake that rises from 0
#: takes hold.
_HOLDING_ROUNDING = 4e-15
#: Number of intervals of a segment in which the holding margin, which consists of polynomials of up
#: to 14 terms, is searched for a sign change; two sign changes in one interval are not found.
_SCAN_INTERVALS = 64
#: Force plus torque that counts as 0, dimensionless: speeds under it would underflow in the first
#: steps.
_NEGLIGIBLE_FORCE = 1e-75


@inline_kernel
def _residual_of_d(d, load, scene):
    """Evaluate the equation of d at V = 0, of the module: its left side less its right side,
    divided by L.

    d: float, delta/delta_star, in [-1, 1]; of a cover that of the excess over free rolling.
    load: Load, at V = 0, with brake and added mass in it (:func:`_effective_load`).
    scene: Scene, of which kappa, mu > 0 and ``law`` are read.
    Returns (residual, its slope in d, V'), floats, dimensionless; V' is in the direction of
    ``load``, of either sign.
    """
    # Eq. (22) at V = 0: friction pulls the axis by ``axis`` and takes the torque ``spin``
    axis, spin, axis_dd, spin_dd = pull_at_rest(d, scene)
    V_rate = load.inverse_mass * (axis + load.force) + load.prescribed_V_rate
    omega_rate = load.inverse_inertia * (load.torque - spin) + load.prescribed_omega_rate
    L, delta_0 = rest_limits(scene, np.copysign(1.0, d))
    inverse_k = 2.0 * scene.kappa / scene.mu / L  # 1/(k L) of rhs
    creep = creep_over_L(0.0, d, scene)
    d_total = creep.value + delta_0 * inverse_k  # right side of the equation, divided by L V'
    # Derivative of the residual in d: of the term with omega' - V', then of that with d_total V'.
    slope = -(load.inverse_inertia * spin_dd + load.inverse_mass * axis_dd) * inverse_k
    slope = slope - creep.slope * V_rate - d_total * load.inverse_mass * axis_dd
    return (omega_rate - V_rate) * inverse_k - d_total * V_rate, slope, V_rate


@inline_kernel
def _d_at_zero_omega(scene):
    """Return the d at which omega stays 0 as V grows from 0, that of delta = -1; a float below 0,
    dimensionless.

    It is above -1, so that omega can stay 0 in partial slip, only where mu L (1 - c) > 2 kappa (1 +
    delta_0); of half-spaces, where L = 1 and delta_0 = 0 at rest, that is mu > 2 kappa.

    scene: Scene, of which kappa, mu > 0 and ``law`` are read.
    """
    L, delta_0 = rest_limits(scene, -1.0)  # on the side d < 0
    # (delta - delta_0)/delta_star at delta = -1, with delta_star = mu L/(2 kappa)
    creep = -2.0 * scene.kappa / scene.mu / L * (1.0 + delta_0)
    return reduced_creep(creep, asymmetry_at_speed(0.0, scene))


@kernel
def _regime_under_brake(load, regime, scene):
    """Return the Regime with the state of a brake while V grows from 0: the sign with which omega
    grows, and whether it stays 0.

    The brake can hold omega in partial slip only where friction is so strong that d at omega = 0 is
    above -1 (:func:`_d_at_zero_omega`); it holds it where the torque that the traction there leaves
    is at most its own.

    load: Load, at V = 0, of a segment with a brake, whose torque may be 0 at the time.
    regime: Regime of partial slip, in whose direction ``load`` is.
    scene: Scene, of which kappa, mu > 0, ``law`` and, for the added mass (n > -1 at V = 0), gamma
    are read.
    Returns ``regime`` with ``spin_sign``, the sign of omega: 1.0 where d at omega = 0 is at most
    -1, as omega then grows with V, else that of the torque that is left, 0.0 for none; and
    ``locked``, whether the brake holds omega at 0 (also where both torques are equal), in which
    case the sign is 0.0.
    """
    d_zero = _d_at_zero_omega(scene)
    load = _effective_load(load, 0.0, scene)  # without the brake, whose torque is compared below
    if d_zero <= -1.0:
        return change_brake(regime, 1.0, False)
    # torque that is left at omega = 0: that of the motor less what the traction there takes
    torque = load.torque - pull_at_rest(d_zero, scene)[1]
    locked = abs(torque) <= load.brake
    return change_brake(regime, 0.0 if locked else np.sign(torque), locked)


@kernel
def _effective_load(load, spin_sign, scene):
    """Return the Load that contains the torque of the brake and the effect of the added mass on V'
    and omega'.

    With the result V' = inverse_mass (Q + force) + V_rate and omega' = inverse_inertia (torque -
    Q) + omega_rate hold at V = 0, where M is 0, although the moment n V' of the added mass acts,
    half of it on V and half on omega; V_rate and omega_rate are the prescribed slopes.

    load: Load, at V = 0.
    spin_sign: float, sign of omega against which the brake acts; 0 for none.
    scene: Scene, of which ``law``, kappa and gamma are read, for the factor n = gamma N of the
    added mass at V = 0; n > -1 where V is free, else the result is not finite or has no meaning.
    Returns ``load`` with other ``torque``, ``inverse_mass`` and ``inverse_inertia``; without brake
    and added mass they stay too.  The field ``brake`` stays although its torque is in ``torque``.
    """
    force, torque, V_rate, omega_rate, brake, inverse_mass, inverse_inertia, gains = load
    # With n/2 = half_n, V' = inverse_mass (Q + force - n V'/2) + V_rate is solved for V'; where V
    # is prescribed, inverse_mass = 0, nothing changes.  In omega' = inverse_inertia (torque - Q -
    # n V'/2) + omega_rate this V' is inserted, and the factor of Q, inertia_ratio, is taken out.
    half_n = 0.5 * added_inertia(0.0, scene)[0]
    mass_ratio = 1.0 / (1.0 + half_n * inverse_mass)
    inertia_ratio = 1.0 + half_n * mass_ratio * inverse_mass
    torque = (
        torque - spin_sign * brake - half_n * (mass_ratio * inverse_mass * force + V_rate)
    ) / inertia_ratio
    inverse_mass = inverse_mass * mass_ratio
    inverse_inertia = inverse_inertia * inertia_ratio
    return Load(
        force=force,
        torque=torque,
        prescribed_V_rate=V_rate,
        prescribed_omega_rate=omega_rate,
        brake=brake,
        inverse_mass=inverse_mass,
        inverse_inertia=inverse_inertia,
        gains=gains,
    )


@kernel
def solve_d_at_departure(load, spin_sign, scene):
    """Solve the equation of d at V = 0, of the module, by a bracketed Newton iteration.

    Where friction is strong (mu > 2 kappa for half-spaces) the residual need not decrease
    everywhere: a root above the d of omega = 0 is taken if the residual is positive there, else one
    between that d and the local maximum below it.  If omega is held at 0, d is that of omega = 0.

    The residual is a cubic in d < 0: with Q = mu (2 d + d^2), k = mu L/(2 kappa) and W =
    inverse_inertia + (1 + delta_0) inverse_mass the terms with d are

        -[2 mu W/k + C] d - mu [W/k + 2 inverse_mass] d^2 - mu inverse_mass d^3

    where C = inverse_mass f + V_rate, with the force f and the prescribed slope V_rate of V, so
    that the larger zero of the slope is the maximum.  Where V is prescribed, inverse_mass = 0, the
    residual is quadratic, with one maximum.  The moments of a cover by its traction and c are left
    out of the cubic, as its maximum bounds a search.

    load: Load, at V = 0.
    spin_sign: float, sign of omega against which a brake acts; 0 without one, or where it holds
    omega.
    scene: Scene, of which kappa, mu > 0, ``law`` and, for the added mass, gamma are read.
    Returns (can_roll, d): whether the cylinder can roll off in partial slip, a bool, that is there
    is a root with |d| < 1 and V' > 0 there; d of the root, also where V' <= 0, a float,
    dimensionless, to rounding; a root at 0 comes out as a |d| of about 1e-60, not as 0.0.  (False,
    0.0) where there is no root with |d| < 1.
    """
    load = _effective_load(load, spin_sign, scene)
    low = -1.0
    high = 1.0
    d_zero = _d_at_zero_omega(scene)  # The residual decreases above this d.
    if d_zero > -1.0:
        residual, _, V_rate = _residual_of_d(d_zero, load, scene)
        # omega is held at 0: by the brake, or prescribed to stay 0.
        if load.inverse_inertia == 0.0 and load.prescribed_omega_rate == 0.0:
            return V_rate > 0.0, d_zero
        if residual > 0.0:
            low = d_zero
        else:  # The residual may have a maximum below this d.
            L, delta_0 = rest_limits(scene, 1.0)
            stiffness = load.inverse_inertia + load.inverse_mass * (1.0 + delta_0)
            stiffness = stiffness * 2.0 * scene.kappa / L
            first = -2.0 * stiffness - load.inverse_mass * load.force - load.prescribed_V_rate
            second = -stiffness - 2.0 * scene.mu * load.inverse_mass
            # The maximum is the larger root of first + 2 second d - 3 mu inverse_mass d^2, with
            # second < 0; first/(sqrt(discriminant) - second) is that root without cancellation, and
            # for inverse_mass = 0 too.  Without a root the cubic decreases for all d.
            discriminant = second * second + 3.0 * scene.mu * load.inverse_mass * first
            if discriminant > 0.0:
                low = max(low, first / (np.sqrt(discriminant) - second))
            low = min(low, d_zero)
            high = d_zero
    if _residual_of_d(low, load, scene)[0] <= 0.0 or _residual_of_d(high, load, scene)[0] >= 0.0:
        return False, 0.0
    d = 0.5 * (low + high)
    V_rate = 0.0
    for _ in range(_MAX_ITERATIONS):
        residual, slope, V_rate = _residual_of_d(d, load, scene)
        # the residual falls through 0 in the bracket: the root is above d where it is positive
        low, high = (d, high) if residual > 0.0 else (low, d)
        d_next = d - residual / slope
        if not low < d_next < high:  # Outside the bracket, or NaN.
            d_next = 0.5 * (low + high)
        if abs(d_next - d) <= _D_TOLERANCE * abs(d):
            break
        d = d_next
    return V_rate > 0.0, d


@inline_kernel
def _traction_at_rest(load, factor, excess):
    """Return |Q| of a traction that balances a load at rest, a float, dimensionless.

    It is the root of Q (factor + excess Q) = load that is load/factor for a small excess; exactly
    ``load`` for the factor 1 and the excess 0 of half-spaces.  Where no Q balances the load the
    square root counts as 0: Q is then at least that of the largest load that is balanced.

    load: float, modulus of the force or torque, dimensionless.
    factor, excess: floats, of which the part of Q that acts on the load is made.
    """
    return 2.0 * load / (factor + np.sqrt(max(factor * factor + 4.0 * excess * load, 0.0)))


@kernel
def holding_margin(tau, segment, work):
    """Return the margin by which friction and brake hold the cylinder at V = omega = 0; below 0
    where it moves.

    Both limits are taken 4e-15 of themselves larger, so that equality holds the cylinder however
    its terms were rounded, and a cylinder that the margin moves departs.  A traction within +-mu
    must leave V constant, and omega too, which a brake may help with.  Of half-spaces:

    - no speed prescribed: the smaller of mu - |force| and of the torque of the brake less |force +
      torque|, which counts as 0 up to 1e-75, of a cover up to 4e-15 of either.  Without a brake the
      margin is at most 0, and 0 only where this modulus counts as 0;
    - V prescribed to stay 0: mu plus the torque of the brake, less the modulus of the torque of the
      motor;
    - omega prescribed to stay 0: mu - |force|.

    Of a cover the traction is that which balances the force with the moment that it makes,
    M = -delta_0 Q and more, so that rest without a brake needs force + (1 + delta_0) torque = 0 for
    a cover on the base: |Q| (1 + a_b + e_b |Q|/mu) = |force|, and the torque is |Q| (1 - a_c - e_c
    |Q|/mu), with the factors a and excesses e of the base and the cylinder
    (:class:`.cover_law.Reaction`), 0 of half-spaces.

    tau: float, the time.
    segment: int, index of the segment of the drive that contains the time.
    work: Workspace, of the motion, whose Scene and Drive are read.
    Returns the margin as a force or torque, a float, dimensionless, at most mu + brake; 0 holds.
    It is -1.0 where a prescribed speed has a slope other than 0.
    """
    scene = work.scene
    law = by_value(scene.law)
    # direction 1, and no brake that holds omega, as inverse_inertia = 0 stands for a prescribed one
    load = evaluate_load(tau, segment, REGIME_AT_REST, work)
    if load.prescribed_V_rate != 0.0 or load.prescribed_omega_rate != 0.0:
        return -1.0
    mu = scene.mu * (1.0 + _HOLDING_ROUNDING)
    brake = load.brake * (1.0 + _HOLDING_ROUNDING)
    reaction = reaction_at_rest(scene)
    if load.inverse_mass == 0.0:  # V is prescribed to stay 0
        if law.cover_rows is None:
            return mu + brake - abs(load.torque)
        torque = max(abs(load.torque) - brake, 0.0)
        excess = -reaction.cylinder_excess / scene.mu
        return mu - _traction_at_rest(torque, 1.0 - reaction.cylinder, excess)
    excess = reaction.half_space_excess / scene.mu
    Q = _traction_at_rest(abs(load.force), 1.0 + reaction.half_space, excess)
    if load.inverse_inertia == 0.0:  # omega is prescribed to stay 0
        return mu - Q
    torque = Q * (1.0 - (reaction.cylinder + reaction.cylinder_excess * Q / scene.mu))
    # Modulus of the torque that is left for the brake.
    rest = abs(np.copysign(torque, load.force) + load.torque)
    # Of half-spaces loads in balance cancel to exactly 0; of a cover to rounding.
    noise = 0.0 if law.cover_rows is None else _HOLDING_ROUNDING * torque
    # A smaller ``rest`` counts as 0: without a brake the margin is then 0, which holds.
    margin = min(mu - Q, brake - (rest if rest > _NEGLIGIBLE_FORCE + noise else 0.0))
    return balance_of_table(load, scene.kappa, mu, margin, law.table)


@kernel
def find_departure_time(tau, segment, work):
    """Return the first tau at which the drive moves a cylinder at rest; the end of the segment if
    it does not.

    If the drive is constant its margin at ``tau`` decides between ``tau`` and the end; a margin of
    0 holds.  Else a sign change of the holding margin is searched in _SCAN_INTERVALS intervals of
    the rest of the segment, then bisected to rounding; two sign changes in one interval are not
    found.  The margin at ``tau`` itself is then not evaluated.

    tau: float, time from which the search starts, at which the cylinder stays.
    segment: int, index of the segment that contains it.
    work: Workspace, of which mu, Drive and output times are read.
    Returns a float in [tau, end of the segment or of the motion]; the margin is negative there,
    unless it is the end.
    """
    end = segment_end(segment, work)
    if is_constant(segment, work.drive):
        return end if holding_margin(tau, segment, work) >= 0.0 else tau
    low = tau
    # the cylinder stays at ``low`` and moves at ``high``; the bisection ends where no time is
    # between
    for n in range(1, _SCAN_INTERVALS + 1):
        high = tau + (end - tau) * n / _SCAN_INTERVALS
        if holding_margin(high, segment, work) < 0.0:
            middle = 0.5 * (low + high)
            while low < middle < high:
                if holding_margin(middle, segment, work) < 0.0:
                    high = middle
                else:
                    low = middle
                middle = 0.5 * (low + high)
            return high
        low = high
    return end


@kernel
def _slide_from_rest(tau, segment, braked, stick_zone_slip, work):
    """Decide whether the cylinder departs in full slip: under full slip its accelerations must
    increase the slip.

    The sign sigma = 1 of the slip is tried first, then -1; the first is returned for which sigma
    (omega' - V' (1 + delta_0)) exceeds ``stick_zone_slip`` times L (1 + sigma c) |V'|.  Neither
    feedback nor added mass acts, as V = omega = 0 and slip is full.

    tau: float, time at which the drive is evaluated.
    segment: int, index of the segment of the drive that contains the time.
    braked: bool, whether a brake acts on the segment.
    stick_zone_slip: float, limit of the excess slip divided by L V, dimensionless: mu/(2 kappa), or
    0 where no departure in partial slip was found.
    work: Workspace, of which Scene and Drive are read.
    Returns (kind, Regime, 0.0) in the form of :func:`depart_from_rest`: SLIDES_OFF with the Regime
    of full slip, in the direction in which V grows (1.0 where V' is 0), with the sign of the slip
    in that direction as ``sigma`` and the ``spin_sign`` and ``locked`` that the brake causes; or
    STAYS_AT_REST with REGIME_AT_REST if neither sign passes.  The third entry, 0.0, is omega.
    """
    scene = work.scene
    load = evaluate_load(tau, segment, REGIME_AT_REST, work)  # in direction 1
    for sigma in (1.0, -1.0):
        L, free_creep = rest_limits(scene, sigma)
        axis, spin, _, _ = pull_at_rest(sigma, scene)
        V_rate = load.inverse_mass * (axis + load.force) + load.prescribed_V_rate
        torque = load.torque - spin
        # The brake acts against the spin that the torque causes, or holds omega at 0.
        spin_sign = np.sign(torque) if braked and abs(torque) > load.brake else 0.0
        locked = braked and spin_sign == 0.0
        omega_rate = (
            load.inverse_inertia * (torque - spin_sign * load.brake) + load.prescribed_omega_rate
        )
        if locked:
            omega_rate = 0.0
        # |d + c d^2| at d = sigma is 1 + sigma c, 1 of half-spaces
        onset = stick_zone_slip * L * abs(creep_over_L(0.0, sigma, scene).value)
        if sigma * (omega_rate - V_rate * (1.0 + free_creep)) > onset * abs(V_rate):
            # signs so far are those of direction 1: mirrored where V falls below 0
            direction = 1.0 if V_rate >= 0.0 else -1.0
            return (
                SLIDES_OFF,
                Regime(
                    full_slip=True,
                    direction=direction,
                    sigma=direction * sigma,
                    spin_sign=direction * spin_sign,
                    locked=locked,
                ),
                0.0,
            )
    return STAYS_AT_REST, REGIME_AT_REST, 0.0


@kernel
def depart_from_rest(tau, segment, work):
    """Decide whether and how a cylinder departs from V = omega = 0.

    Where the drive of a varying segment does not move the cylinder at ``tau``, its values a
    millionth of the rest of the segment later decide.  A departure in partial slip is sought in
    both directions, then one in full slip.  Where mu <= 2 kappa the first departure in partial slip
    is the only one; where friction is stronger, two possible departures are ambiguous.

    tau: float, the time.
    segment: int, index of the segment of the drive that contains the time.
    work: Workspace, of which Scene, Drive and output times are read.
    Returns (kind, Regime, d):

    - STAYS_AT_REST: friction and brake hold the cylinder, or no departure satisfies the equations;
      REGIME_AT_REST, 0;
    - ROLLS_OFF: the Regime of partial slip with direction, sigma and brake; d = delta/delta_star at
      ``tau``, dimensionless;
    - SLIDES_OFF: the Regime of full slip; 0, which is omega;
    - AMBIGUOUS: the cylinder may roll off in both directions, or may roll off as well as slide;
      REGIME_AT_REST, 0;
    - NO_DEPARTURE: of a law with added mass, where the drive moves the cylinder but no departure
      satisfies the equations; REGIME_AT_REST, 0.
    """
    scene = work.scene
    tau_drive = tau
    brake = evaluate_load(tau, segment, REGIME_AT_REST, work).brake
    rounding = _HOLDING_ROUNDING * (scene.mu + brake)
    margin = holding_margin(tau, segment, work)
    if margin >= -rounding and not is_constant(segment, work.drive):
        # A drive that holds the cylinder at ``tau``, or is in balance with it to rounding: its
        # values a little later decide whether it moves the cylinder.
        tau_drive = tau + _LOOKAHEAD * (segment_end(segment, work) - tau)
        margin = holding_margin(tau_drive, segment, work)
    departure = STAYS_AT_REST, REGIME_AT_REST, 0.0
    if margin >= 0.0:
        return departure
    braked = has_brake(segment, work.drive)
    for direction in (1.0, -1.0):
        regime = Regime(
            full_slip=False, direction=direction, sigma=1.0, spin_sign=0.0, locked=False
        )
        load = evaluate_load(tau_drive, segment, regime, work)
        if braked:
            regime = _regime_under_brake(load, regime, scene)
            # the load of a locked cylinder has an inverse_inertia of 0
            load = evaluate_load(tau_drive, segment, regime, work)
        can_roll, d = solve_d_at_departure(load, regime.spin_sign, scene)
        if can_roll and departure[0] == ROLLS_OFF:
            return AMBIGUOUS, REGIME_AT_REST, 0.0
        if can_roll:
            # The motion departs from d at the present time, where it may be 0: sigma is the sign
            # that d has a little later.
            load = evaluate_load(tau, segment, regime, work)
            d_start = solve_d_at_departure(load, regime.spin_sign, scene)[1]
            departure = ROLLS_OFF, change_slip(regime, False, 1.0 if d >= 0.0 else -1.0), d_start
            if scene.mu <= 2.0 * scene.kappa:  # The residual decreases: there is no other root.
                return departure
    # Where the cylinder may roll off, sliding is a second motion only if its slip exceeds that of
    # the onset of full slip; else any slip in the direction of sigma will do.
    stays = departure[0] == STAYS_AT_REST
    stick_zone_slip = 0.0 if stays else 0.5 * scene.mu / scene.kappa
    slides = _slide_from_rest(tau_drive, segment, braked, stick_zone_slip, work)
    if stays:
        # The added mass acts in partial slip only: it may leave neither regime.
        none = slides[0] == STAYS_AT_REST and added_inertia(0.0, scene)[0] != 0.0
        return (NO_DEPARTURE, REGIME_AT_REST, 0.0) if none else slides
    return (AMBIGUOUS, REGIME_AT_REST, 0.0) if slides[0] == SLIDES_OFF else departure
