"""Right-hand side of a motion in unknowns in which the law is explicit and that pass V = 0.

The unknowns are V and omega in full slip, V and d = delta/delta_star in partial slip, there in a
direction with V >= 0.  On rows of the law (:mod:`.law_functions`), with k = mu/(2 kappa), u = kappa
V, delta_star = k L(u), L' = dL/du, w = (1 - |d|) L, s = sign d and H(v) the function
:func:`.law_functions.H_over_F2`, partial slip is

    omega = V (1 + k L d)      Q = s mu [1 - w^2 H(2 u/w)]
    V d' = [(omega' - V')/k - d (L + u L') V']/L

The last equation is the derivative of the first in tau, as d(V delta_star)/dV = k (L + u L').  Both
of its sides stay finite as V -> 0, where d is the root of its right side.  For |d| > 1 the law is
continued by Q = s mu, for d beyond 0 by its own branch, in full slip for V < 0 as odd functions.

On a cover of finite thickness delta = delta_0(u) + k L (d + c(u) d^2): delta_0 V is added to omega,
and the slopes of delta_0 and c to the factors of V' and d' in the last equation
(:mod:`.cover_law`); half-spaces are compiled without them.

In partial slip a law may add N V' to M, half of it in each body: with n = gamma N, the applied
force f and torque q, the equations of bodies of one material are

    (1 + n/2) V' = Q - M/2 + f      j omega' = -Q - M/2 - n V'/2 + q

and the integral of n over V is added to p, so that p' stays the same.

p = inverse_inertia V + inverse_mass omega (fields of the Load), proportional to V + j omega, is
collocated in place of V in partial slip: p' does not depend on Q, and on d only by feedback.  dp/dd
= inverse_mass V k L is small: Newton's matrix splits into one of p and one of d (:mod:`step`).
Where friction is so strong that dp/dV may vanish, and in full slip, p is V.

All derivatives are exact, except that of p' with respect to d in partial slip, which leaves out
the feedback of omega (:class:`Rates`).

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- A prime: slope in tau = gamma t, but for L'.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d in
  partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Load: the drive at one time in the direction of the Regime: force, torque, slopes of a prescribed
  V or omega, largest torque of the brake, inverse_mass (1, or 0 where V is prescribed),
  inverse_inertia (1/j, or 0 where omega is prescribed or held by the brake) and the gains of the
  feedback.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

import math
from typing import NamedTuple

from ..law.cover_law import creep_of, free_kinematics
from ..law.law_functions import H_over_F2, H_over_F2_secants, locate_row
from ..numerics.intrinsics import by_value, unlikely
from ..numerics.jit import inline_kernel, kernel
from .drive import current_load
from .motion_law import added_inertia, asymmetry, evaluate_moments, loaded_moments
from .table_law import Width, free_creep_of_table, table_state, width_at

#: k relative to the smallest k at which dp/dV may vanish at d = -1, above which V is collocated,
#: dimensionless: below it dp/dV at rest is at least a fifth of its value at d = 0.
_STRONG_FRICTION = 0.8
#: |d| below which Q is evaluated by mean slopes of the law: 1 - w^2 H, about 2 |d|, would have lost
#: four digits there.
_SMALL_D = 1e-4


class ReducedKinematics(NamedTuple):
    """Terms with d in the kinematics of partial slip at one speed, dimensionless; A = d(u L)/du.

    With S = L (d + c d^2), delta = delta_0 + k S, k = mu/(2 kappa).

    value : S/L.
    width : dS/dd.
    dwidth, turn : derivatives of dS/dd with respect to u and to d.
    total, total_dd : d(u S)/du divided by A, and its derivative with respect to d.
    bend : d^2(u S)/du^2.
    """

    value: float
    width: float
    dwidth: float
    turn: float
    total: float
    total_dd: float
    bend: float


@inline_kernel
def reduced_kinematics(d, u, L, dL, ddL, asymmetry, cover_rows):
    """Return the :class:`ReducedKinematics` of partial slip at d.

    d : float, of either sign, dimensionless.
    u : float, kappa |V|, dimensionless, >= 0.
    L, dL, ddL : floats, 2 kappa delta_star/mu, > 0, and its derivatives over u.
    asymmetry : :class:`OverSpeed` of c at u; not read for half-spaces.
    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None for
    half-spaces.
    """
    uL_slope = L + u * dL  # A
    uL_curvature = 2.0 * dL + u * ddL  # its derivative over u
    if cover_rows is None:  # S = L d
        return ReducedKinematics(d, L, dL, 0.0, d, 1.0, uL_curvature * d)
    c = asymmetry
    creep = creep_of(d, c.value, cover_rows)
    # d(u S)/du = A (d + c d^2) + u L c' d^2, divided by A; ``bend``, not divided, is its derivative
    # over u, A' (d + c d^2) + (2 A c' + u L c'') d^2.  d^2 is ``creep.bend``, 2 d ``bend_slope``.
    aside = u * c.slope * L / uL_slope
    return ReducedKinematics(
        value=creep.value,
        width=L * creep.slope,
        dwidth=dL * creep.slope + L * c.slope * creep.bend_slope,
        turn=L * creep.curvature,
        total=creep.value + aside * creep.bend,
        total_dd=creep.slope + aside * creep.bend_slope,
        bend=uL_curvature * creep.value
        + creep.bend * (2.0 * c.slope * uL_slope + u * c.curvature * L),
    )


@inline_kernel
def creep_turn(creep, rate, cover_rows):
    """Return the term -(d^2S/dd^2) V d', which the derivative of the equation of d with respect to
    d contains on covers.

    S is that of :class:`ReducedKinematics`.  The equation of d has the left side dS/dd V d', whose
    derivative with respect to d is d^2S/dd^2 V d' + dS/dd d(V d')/dd.  Solved for d(V d')/dd, the
    sum that is divided by dS/dd contains this term.

    creep : :class:`ReducedKinematics` at d, of which ``turn``, d^2S/dd^2, is read.
    rate : float, V d', which is ``weighted_rate`` of :class:`Rates`, dimensionless.
    cover_rows : vector of the numbers that only a cover has, as in :mod:`.cover_law`; None for
        half-spaces.
    Returns a float, dimensionless; -0.0 for half-spaces: adding it changes nothing, so that a
    compiler drops the addition.
    """
    return -0.0 if cover_rows is None else -creep.turn * rate


class Rates(NamedTuple):
    """The right-hand side at a state and its derivatives with respect to V (_dV) and to the second
    unknown (_dd), dimensionless.

    Derivatives are partial ones: those with respect to V at fixed omega or d, those with respect to
    the second unknown at fixed V.

    omega : angular velocity
    Q : traction, Eq. (17); signed, |Q| <= mu
    M_half_space, M_cylinder : the parts of the rolling moment, Eq. (18), that half-space and
        cylinder take; in partial slip each contains n V'/2 of the added mass
    V_rate : V'
    p : the collocated unknown; V in full slip and under strong friction
    p_rate : p'
    weighted_rate : ``weight`` times the derivative of the second unknown with respect to tau: V d'
        in partial slip, omega' in full slip
    weight : V in partial slip, 1 in full slip
    dp_dV, dp_dd : derivatives of p
    dp_rate_dV, dp_rate_dd : derivatives of p'; in partial slip without strong friction dp_rate_dd
        contains only the moments of a cover, which depend on Q, else it is 0: it leaves out the
        feedback of omega, which depends on d
    drate_dV, drate_dd : derivatives of ``weighted_rate``
    dweight_dV : derivative of ``weight``: 1 in partial slip, 0 in full slip
    """

    omega: float
    Q: float
    M_half_space: float
    M_cylinder: float
    V_rate: float
    p: float
    p_rate: float
    weighted_rate: float
    weight: float
    dp_dV: float
    dp_dd: float
    dp_rate_dV: float
    dp_rate_dd: float
    drate_dV: float
    drate_dd: float
    dweight_dV: float


@inline_kernel
def applied_forces(V, omega, load, regime):
    """Return the applied force and torques, feedback included, in the direction of the regime,
    dimensionless.

    V, omega: float, speeds in the direction of the regime, dimensionless.
    load: Load, the drive at the time; force, torque, brake and gains are read.
    regime: Regime, of which ``spin_sign`` is read, the sign of omega against which a brake acts; 0:
    no torque of the brake.
    Returns (force, torque of the motor, torque of motor and brake together), floats, signed.  Where
    a speed is prescribed or the brake holds omega at 0, these are not the force and torque that
    act: those are given by :func:`required_forces`.
    """
    gains = load.gains
    force = load.force + gains.force_V * V + gains.force_omega * omega
    torque = load.torque + gains.torque_V * V + gains.torque_omega * omega
    return force, torque, torque - load.brake * regime.spin_sign


@inline_kernel
def required_forces(V, omega, rates, load, regime, j):
    """Return the forces and torques that act: the applied ones, or those that Eq. (22) requires of
    a prescribed speed.

    Eq. (22) is V' = force + Q - M_half_space and j omega' = torque + brake - Q - M_cylinder, with
    ' = d/dtau.  Force and torque are the applied ones with their feedback, and the brake acts with
    its largest torque against omega, with three exceptions.  If the brake holds omega at 0 its
    torque is the one that makes omega' = 0.  Else, if omega is prescribed, the torque of the motor
    is the one that gives omega' its prescribed slope.  If V is prescribed, the force is the one
    that gives V' its prescribed slope.

    V, omega: float, speeds in the direction of the regime, dimensionless.
    rates: Rates, at these speeds; Q and the moments are read.
    load: Load, the drive at the time; inverse_mass = 0 tells that V is prescribed,
    inverse_inertia = 0 that omega is prescribed, unless the brake holds it.
    regime: Regime, at that state; ``locked`` and ``spin_sign`` are read.
    j: float, moment of inertia J/(m R^2), dimensionless, > 0.
    Returns (force, torque of the motor, torque of the brake), floats, signed, in the direction of
    the regime, dimensionless; the torque of the brake is 0 without one.
    """
    force, torque, _ = applied_forces(V, omega, load, regime)
    brake = -load.brake * regime.spin_sign
    # each from its line of Eq. (22), with omega' = 0, or with the prescribed V' or omega'
    if regime.locked:
        brake = rates.Q + rates.M_cylinder - torque
    elif load.inverse_inertia == 0.0:
        torque = j * load.prescribed_omega_rate + rates.Q + rates.M_cylinder - brake
    if load.inverse_mass == 0.0:
        force = load.prescribed_V_rate - rates.Q + rates.M_half_space
    return force, torque, brake


@inline_kernel
def has_strong_friction(load, regime, scene):
    """Return whether friction is so strong that V is collocated in place of p, a bool.  V', unlike
    p', contains Q.

    With k = mu/(2 kappa) the result is True where k inverse_mass > 0.8 (inverse_mass +
    inverse_inertia), in partial slip with sigma < 0: only there may dp/dV vanish.  0.8 is a
    fraction of the k at which dp/dV of half-spaces at rest is 0 at d = -1.  The result is False in
    full slip and where V is prescribed.

    load: Load, whose ``inverse_mass`` and ``inverse_inertia`` are read.
    regime: Regime, that of the state; ``full_slip`` and ``sigma`` are read.
    scene: Scene, of which mu and kappa > 0 are read.
    """
    inverse_mass = load.inverse_mass
    k = 0.5 * scene.mu / scene.kappa
    strong = k * inverse_mass > _STRONG_FRICTION * (inverse_mass + load.inverse_inertia)
    return strong and regime.sigma < 0.0 and not regime.full_slip


@inline_kernel
def partial_slip_rates(V, d, load, regime, scene):
    """Evaluate the right-hand side in partial slip, with its derivatives, by the equations of the
    module.

    Trial states of Newton's iteration may lie outside the regime: where sigma d >= 1, Q is sigma
    mu; where sigma d < 0, the branch of sigma is continued beyond d = 0; V may be below 0.  At V =
    0 all values are finite.

    Locals, in the symbols of the module: stick = 1 - |d|, w = (1 - |d|) L, v = 2 u/w, D = |d| L,
    dVdelta_star = d(V delta_star)/dV / k = L + u L', d_total: d with what a cover adds, rate = V
    d'; dx_dV and dx_dd: partial derivatives of x with respect to V at fixed d, and to d at fixed V.

    V: float, speed of the axis in the direction of the regime, dimensionless.
    d: float, dimensionless: delta/delta_star; on a cover d + c d^2 = (delta - delta_0)/delta_star.
    load: Load, the drive at the time; all fields are read.
    regime: Regime, of partial slip; sigma is the sign of the branch, spin_sign that of omega under
    a brake.
    scene: Scene, of which ``law``, moments_differ, kappa, mu > 0 and gamma are read.
    Returns Rates, dimensionless, with the derivatives of partial slip: the second unknown is d and
    the weight V.  Under strong friction (:func:`has_strong_friction`) p is V, with the derivatives
    of V'.
    """
    law = by_value(scene.law)
    mu = scene.mu
    sign = regime.sigma
    k = 0.5 * scene.mu / scene.kappa
    u = scene.kappa * abs(V)
    du_dV = scene.kappa if V >= 0.0 else -scene.kappa
    functions = evaluate_moments(u, scene)
    # L of the law; of a table it is replaced below by that of the side of d.  dL and ddL: its
    # derivatives with respect to u.
    L = functions.L
    dL = functions.dL
    ddL = functions.ddL
    stick = max(1.0 - sign * d, 0.0)  # 1 - |d| on the branch of sigma; above 1 beyond d = 0
    w = stick * L
    Q = sign * mu  # Q at w = 0, that is for sigma d >= 1, where its derivatives are 0
    dQ_dV = 0.0
    dQ_dd = 0.0
    if w > 0.0:
        v = 2.0 * u / w
        index = locate_row(v, law)
        value, slope = H_over_F2(index, v, law)  # H and dH/dv
        w_slope = value - 0.5 * v * slope  # d(w^2 H)/dw at fixed u, divided by 2 w, as v = 2 u/w
        Q *= 1.0 - w * w * value
        # As 1 = L^2 H(v_0) with v_0 = 2 u/L, 1 - w^2 H(v) = L^2 H(v_0) - (L - D)^2 H(v), with v -
        # v_0 = v D/L and H(v_0) = H(v) - secant v D/L: each term then has the factor D, so that
        # nothing cancels.
        if unlikely(abs(d) < _SMALL_D):
            D = abs(d) * L
            value, secant, _ = H_over_F2_secants(index, locate_row(2.0 * u / L, law), v, D / w, law)
            Q = math.copysign(mu, d) * D * ((2.0 * L - D) * value - v * L * secant)
        # Of Q = sign mu (1 - w^2 H(2 u/w)) with w = stick L(u) and dw/dd = -sign L.
        dQ_dV = -2.0 * sign * mu * w * (w_slope * stick * dL + slope) * du_dV
        dQ_dd = 2.0 * mu * w * L * w_slope
    width = width_at(
        u, sign, mu, Width(L=L, dL=dL, ddL=ddL, middle=0.0, dmiddle=0.0, ddmiddle=0.0), law.table
    )
    L = width.L
    dL = width.dL
    ddL = width.ddL
    dVdelta_star = L + u * dL
    cover = free_kinematics(functions.pairs, u, scene.kappa, k, dVdelta_star, law.cover_rows)
    cover = free_creep_of_table(width, u, scene.kappa, k, cover, law.table)
    c = asymmetry(functions.pairs, L, dL, ddL, scene)
    creep = reduced_kinematics(d, u, L, dL, ddL, c, law.cover_rows)
    d_total = creep.total + cover.aside
    omega = V * (1.0 + k * L * creep.value + cover.creep)
    domega_dV = 1.0 + k * d_total * dVdelta_star
    domega_dd = k * V * creep.width
    force, _, torque = applied_forces(V, omega, load, regime)
    gains = load.gains
    # Traction and moments by the rows of the law, or by the table of a law that has one.
    on_rows = loaded_moments(V, du_dV, Q, dQ_dV, dQ_dd, functions, scene)
    moments = table_state(V, d, sign, scene.kappa, mu, on_rows, law.table)
    Q = moments.Q
    dQ_dV = moments.Q_dV
    dQ_dd = moments.Q_dd
    M_half_space = moments.half_space
    M_cylinder = moments.cylinder
    inverse_mass = load.inverse_mass
    inverse_inertia = load.inverse_inertia
    inverse_product = inverse_mass * inverse_inertia
    dforce_dV = gains.force_V + gains.force_omega * domega_dV
    dtorque_dV = gains.torque_V + gains.torque_omega * domega_dV
    # p' = inverse_inertia V' + inverse_mass omega', in which Q cancels: it is written without Q, so
    # that its rounding does not enter.  A prescribed speed has inverse_product 0.
    p = inverse_inertia * V + inverse_mass * omega
    dp_dV = inverse_inertia + inverse_mass * domega_dV
    dp_dd = inverse_mass * domega_dd
    dp_rate_dd = -inverse_product * (moments.half_space_dd + moments.cylinder_dd)
    p_rate = inverse_product * (force + torque - M_half_space - M_cylinder)
    p_rate = (
        p_rate
        + inverse_inertia * load.prescribed_V_rate
        + inverse_mass * load.prescribed_omega_rate
    )
    dp_rate_dV = inverse_product * (
        dforce_dV + dtorque_dV - moments.half_space_dV - moments.cylinder_dV
    )
    V_rate = inverse_mass * (Q - M_half_space + force) + load.prescribed_V_rate
    dV_rate_dV = inverse_mass * (dQ_dV - moments.half_space_dV + dforce_dV)
    dV_rate_dd = inverse_mass * (dQ_dd - moments.half_space_dd + gains.force_omega * domega_dd)
    dtorque_dd = gains.torque_omega * domega_dd
    n, dn_dV, n_integral = added_inertia(V, scene)
    # Added mass: V' is divided by 1 + n/2, and both moments get n V'/2, which changes omega' only.
    if n != 0.0:
        mass_ratio = 1.0 / (1.0 + 0.5 * inverse_mass * n)
        V_rate *= mass_ratio
        dV_rate_dV = mass_ratio * (dV_rate_dV - 0.5 * inverse_mass * dn_dV * V_rate)
        dV_rate_dd = mass_ratio * dV_rate_dd
        drag = 0.5 * n * V_rate
        M_half_space = M_half_space + drag
        M_cylinder = M_cylinder + drag
        dtorque_dV = dtorque_dV - 0.5 * (dn_dV * V_rate + n * dV_rate_dV)
        dtorque_dd = dtorque_dd - 0.5 * n * dV_rate_dd
        p = p + inverse_product * n_integral
        dp_dV = dp_dV + inverse_product * n
    # after the added mass, of which half acts on the cylinder
    omega_rate = inverse_inertia * (torque - Q - M_cylinder) + load.prescribed_omega_rate
    # The equation of V d'; of a cover its divisor is d(L (d + c d^2))/dd in place of L.
    # Reciprocals are formed once: the processor takes longer for a division than for five products.
    inverse_k = 1.0 / k
    inverse_L = 1.0 / creep.width
    rate = inverse_L * (inverse_k * (omega_rate - V_rate) - d_total * dVdelta_star * V_rate)
    domega_rate_dV = inverse_inertia * (dtorque_dV - dQ_dV - moments.cylinder_dV)
    domega_rate_dd = inverse_inertia * (dtorque_dd - dQ_dd - moments.cylinder_dd)
    # Derivative with respect to V, at fixed V' and V d', of d_total dVdelta_star V' + creep.width
    # V d'.
    dL_term = du_dV * ((creep.bend + cover.bend) * V_rate + creep.dwidth * rate)
    if unlikely(has_strong_friction(load, regime, scene)):  # V is collocated in place of p.
        p = V
        p_rate = V_rate
        dp_dV = 1.0
        dp_dd = 0.0
        dp_rate_dV = dV_rate_dV
        dp_rate_dd = dV_rate_dd
    return Rates(
        omega=omega,
        Q=Q,
        M_half_space=M_half_space,
        M_cylinder=M_cylinder,
        V_rate=V_rate,
        p=p,
        p_rate=p_rate,
        weighted_rate=rate,
        weight=V,
        dp_dV=dp_dV,
        dp_dd=dp_dd,
        dp_rate_dV=dp_rate_dV,
        dp_rate_dd=dp_rate_dd,
        drate_dV=inverse_L
        * (
            inverse_k * (domega_rate_dV - dV_rate_dV)
            - d_total * dVdelta_star * dV_rate_dV
            - dL_term
        ),
        drate_dd=inverse_L
        * (
            inverse_k * (domega_rate_dd - dV_rate_dd)
            - dVdelta_star * (creep.total_dd * V_rate + d_total * dV_rate_dd)
            + creep_turn(creep, rate, law.cover_rows)
        ),
        dweight_dV=1.0,
    )


@inline_kernel
def full_slip_rates(V, omega, load, regime, scene):
    """Evaluate the right-hand side of the equations of motion, Eq. (22), in full slip, where Q =
    sigma mu, Eq. (17).

    V may have either sign, as the moments are odd in V.  The added mass of slow speed changes does
    not act in full slip.

    V, omega: float, the speeds in the direction of the regime, dimensionless.
    load: Load, the drive at the time; all fields are read.
    regime: Regime, of full slip; sigma is the sign of Q, spin_sign that of omega under a brake.
    scene: Scene, of which kappa, mu, moments_differ and ``law`` are read, the law of the pair of
    materials of this motion (:class:`.law_record.Law`).
    Returns Rates with all derivatives, dimensionless: the second unknown is omega, the weight is 1,
    p is V.  All are finite, at V = 0 too.
    """
    u = scene.kappa * abs(V)
    Q = regime.sigma * scene.mu
    functions = evaluate_moments(u, scene)
    force, _, torque = applied_forces(V, omega, load, regime)
    gains = load.gains
    du_dV = scene.kappa if V >= 0.0 else -scene.kappa
    # as the rows of the law give it; Q is constant, with derivatives of 0
    on_rows = loaded_moments(V, du_dV, Q, 0.0, 0.0, functions, scene)
    # Full slip is the edge d = sigma of a table; at V < 0 ``table_state`` reads the opposite edge,
    # at |V|, and changes the signs of Q and of the moments.
    table = by_value(scene.law).table
    moments = table_state(V, regime.sigma, regime.sigma, scene.kappa, scene.mu, on_rows, table)
    M_half_space = moments.half_space
    M_cylinder = moments.cylinder
    V_rate = load.inverse_mass * (Q - M_half_space + force) + load.prescribed_V_rate
    omega_rate = load.inverse_inertia * (torque - Q - M_cylinder) + load.prescribed_omega_rate
    return Rates(
        omega=omega,
        Q=Q,
        M_half_space=M_half_space,
        M_cylinder=M_cylinder,
        V_rate=V_rate,
        p=V,
        p_rate=V_rate,
        weighted_rate=omega_rate,
        weight=1.0,
        dp_dV=1.0,
        dp_dd=0.0,
        dp_rate_dV=load.inverse_mass * (gains.force_V - moments.half_space_dV),
        dp_rate_dd=load.inverse_mass * gains.force_omega,
        drate_dV=load.inverse_inertia * (gains.torque_V - moments.cylinder_dV),
        drate_dd=load.inverse_inertia * gains.torque_omega,
        dweight_dV=0.0,
    )


@inline_kernel
def evaluate_rhs_inline(V, omega_or_d, load, regime, scene):
    """Evaluate the right-hand side of the regime: :func:`full_slip_rates` or
    :func:`partial_slip_rates`.

    It is inlined in Newton's iteration and in the quadratures, so that the compiler leaves out what
    they do not read.

    V: float, speed of the axis in the direction of the regime, dimensionless.
    omega_or_d: float, second unknown, dimensionless: omega in full slip, d in partial slip.
    load: Load, the drive at the time; all fields are read.
    regime: Regime; ``full_slip`` selects the function, which also reads sigma and spin_sign.
    scene: Scene, of which the fields that either function names are read.  A caller that stores
    numbers in a loop passes a copy (:mod:`.intrinsics`).
    Returns Rates, dimensionless.  In full slip p is V, the second unknown omega, the weight of its
    equation 1.  In partial slip p is the unknown proportional to V + j omega (V itself under strong
    friction), the second unknown d, the weight V.  The derivatives with respect to V and to the
    second unknown are the fields dp_dV to dweight_dV of :class:`Rates`.
    """
    if regime.full_slip:
        return full_slip_rates(V, omega_or_d, load, regime, scene)
    return partial_slip_rates(V, omega_or_d, load, regime, scene)


@kernel
def evaluate_rhs(state, load, regime, scene):
    """Evaluate the right-hand side of the regime by a function that is compiled once and called.

    The values are those of :func:`evaluate_rhs_inline`, which Newton's iteration takes instead.

    state: State, the unknowns, in the direction of the regime.
    load: Load, the drive at the time; all fields are read.
    regime: Regime; ``full_slip``, ``sigma`` and ``spin_sign`` are read.
    scene: Scene, of which ``law``, moments_differ, kappa, mu and, in partial slip, gamma are read.
    Returns Rates, dimensionless, as :func:`full_slip_rates` or :func:`partial_slip_rates` returns
    them.
    """
    return evaluate_rhs_inline(state.V, state.omega_or_d, load, regime, scene)


@kernel
def current_rates(state, regime, step_state, work):
    """Return the right-hand side at a state and the time reached, :class:`Rates`, dimensionless.

    It is :func:`evaluate_rhs` with the Load evaluated at that time; nothing is stored in the
    workspace.

    state: State, the unknowns, in the direction of the regime.
    regime: Regime, the present one; ``full_slip`` tells what the second unknown is.
    step_state: StepState, with that time and its segment of the drive.
    work: Workspace, of the motion; its Scene and Drive are read.
    """
    return evaluate_rhs(state, current_load(regime, step_state, work), regime, work.scene)
