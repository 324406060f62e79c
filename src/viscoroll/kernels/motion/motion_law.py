"""The contact law at a state of a motion: rolling moments, creepage, slip, added mass.

All is read off the rows of the law (:mod:`.law_functions`) at u = kappa |V|; nothing here depends
on the drive.  An argument of which no shape is stated is a number.

Added mass: N of M = M(V) + N V', the rolling moment M while the speed V changes slowly, with V' in
t (docs/theory_materials.md, Slowly changing speed).  M is divided by P R, V by R/T_epsilon, t by
T_epsilon, so that N is in units of P T_epsilon^2.  With V' in tau the factor is n = gamma N.  A law
of steady rolling has no N; its added mass is 0.  A law with N has it as polynomials over octaves of
u, in ``N_rows`` of :class:`.law_record.Law`: for each row N and its integral over u from the place
where the argument t of the row is 0; then, for each row and the range beyond the last one, the
integral from infinity to that place; then the same from u = 0 (:func:`.row_layout.pack_unsteady`).
That of a cover is NaN.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Scene: the law of the materials, kappa = R/l0, mu, gamma and j = J/(m R^2) of one motion; a
  reference, of which :func:`.intrinsics.by_value` loads the law as a tuple.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

from typing import NamedTuple

import numpy as np

from ..law.cover_law import (
    MomentChange,
    asymmetry_at,
    creep_of,
    moment_change,
    pairs_at,
    reduced_creep,
    shear_reaction,
)
from ..law.law_functions import (
    body_moments,
    free_creep_and_slopes,
    length_and_moment,
    limits_at_rest,
    locate_octave,
    locate_row,
)
from ..law.law_record import ALPHA, E0, ROW_COUNT, element
from ..numerics.intrinsics import by_value, unlikely
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import TERMS, evaluate_pair
from .table_law import (
    Loads,
    Width,
    asymmetry_of_table,
    friction_by_shear,
    pull_of_table,
    width_at,
)

# --- Added mass ---

#: Added mass gamma N at V = 0, in units of the mass, at or below which V = 0 is not reached: a
#: motion in partial slip ends where gamma N falls to -1, if not before
#: (:func:`added_mass_margin`), far from -4.
_HEAVY = -4.0


@inline_kernel
def _evaluate_N(u, law):
    """Return N of M = M(V) + N V' at u, its integral and its slope, with the row in which they were
    evaluated.

    u : float, kappa |V|, dimensionless, >= 0, finite.
    law : :class:`.law_record.Law` of the material, with polynomials of N; those of a cover are NaN.
         Read are ``N_rows``, e0 and the number of rows in ``marks``, and alpha in ``rows``.

    Returns (row, N, integral, slope).  row: int, index of the row from 0, or the number of rows
    where u lies beyond the last one and N has its fast limit (alpha - 1)/(16 alpha u^2).  N: float,
    in units of P T_epsilon^2.  integral: float, its integral over u from the place where the
    argument t of that row is 0 (beyond the last row: from infinity).  slope: float, dN/du.  Of a
    cover the last three are NaN in its rows; beyond the last row they are finite and mean nothing.
    """
    row, t, dt_dx = locate_octave(u, law.marks[E0])
    count = law.marks[ROW_COUNT]
    alpha = law.rows[ALPHA]
    if row < count:  # a row of N_rows is a pair, N and its integral, and has no head in front
        N, integral, slope, _, _, _ = evaluate_pair(law.N_rows, row * 2 * TERMS, t)
        return row, N, integral, slope * dt_dx
    # N = (alpha - 1)/(16 alpha u^2): its integral from infinity is -N u, its slope -2 N/u.
    integral = -(alpha - 1.0) / (16.0 * alpha * u)
    return count, -integral / u, integral, 2.0 * integral / (u * u)


@kernel
def _evaluate_added_mass(law, V, kappa, gamma):
    """Return the factor gamma N of the added mass, with its slope and its integral, for a law that
    has N.

    The integral begins at V = 0 or, where a motion cannot reach V = 0 (gamma N <= -4 there), at
    infinity.

    law : :class:`.law_record.Law` of the material, with polynomials of N; those of a cover are NaN.
    V : float, speed of the axis, of either sign, finite, dimensionless; N is even in V.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    gamma : float, P T_epsilon^2/(m R), Eq. (4), dimensionless.
    Returns (gamma N, its slope over V, its integral over V), floats, dimensionless.  The slope is
    odd in V; at V = 0.0 it is that of V > 0.  The integral is continuous at V = 0, and odd in V
    where it begins there.  Of a cover all three are NaN in its rows; beyond the last row they mean
    nothing.
    """
    count = law.marks[ROW_COUNT]
    row, N, integral, slope = _evaluate_N(kappa * abs(V), law)
    # The integral starts at V = 0 if that is reached, where no digits may cancel; else at infinity.
    # N_rows[0] is N at u = 0, the first coefficient of row 0; ``start`` is the index of the first
    # constant of the integral, of those from infinity or of those from u = 0.
    start = count * 2 * TERMS + (count + 1 if gamma * law.N_rows[0] > _HEAVY else 0)
    integral += law.N_rows[start + row]
    if V < 0.0:  # N is even: the integral less its value at V = 0, N_rows[start], is odd.
        integral = 2.0 * law.N_rows[start] - integral
    return gamma * N, gamma * np.copysign(kappa, V) * slope, gamma * integral / kappa


@kernel
def unsteady_loop(law, kappa, V, out):
    """Write N of n states into an array.

    law : :class:`.law_record.Law` that has N (``N_rows`` is not empty); marks, rows and ``N_rows``
        are read.
    kappa, V : slenderness, > 0, and speed, of either sign, finite, dimensionless, of length 1 or n.
    out : (n,) floats, written: N in units of P T_epsilon^2.  Of a cover it is NaN in the rows of
        the law, and without meaning beyond the last row.  Returns nothing.
    """
    for n in range(out.size):
        _, out[n], _, _ = _evaluate_N(element(kappa, n) * abs(element(V, n)), law)


# --- The contact law at a state of a motion ---


class SpeedFunctions(NamedTuple):
    """What the law gives at one speed, dimensionless and finite, also at u = kappa |V| = 0.

    L, dL, ddL : 2 kappa delta_star/mu, Eq. (9), and its derivatives in u.
    half_space, cylinder : moments of the bodies without traction, Eq. (18), divided by V.
    half_space_slope, cylinder_slope : slopes of these moments in V.
    pairs : what a cover has besides, of :func:`.cover_law.pairs_at`.
    """

    L: float
    dL: float
    ddL: float
    half_space: float
    cylinder: float
    half_space_slope: float
    cylinder_slope: float
    pairs: tuple


@inline_kernel
def evaluate_moments(u, scene):
    """Evaluate what the law gives at one speed: critical creepage, Eq. (9), and rolling moments,
    Eq. (18).

    The added mass is not in the moments.  The moments are 0 where both bodies are elastic
    (alpha = 1).

    u: float, kappa |V|, dimensionless, at least 0 and finite.
    scene: Scene, of which ``law`` and ``moments_differ`` are read; with ``moments_differ`` False
    each body takes half of the moment.
    Returns :class:`SpeedFunctions`.  Quotients and slopes are even in V, so that the moment of
    either body at a V of any sign is V times its quotient.
    """
    law = by_value(scene.law)
    index = locate_row(u, law)  # position of u in the rows
    law_at_u = length_and_moment(index, u, law)
    m = law_at_u.scale * law_at_u.m  # M/V of both bodies together
    half_space = cylinder = 0.5 * m
    half_space_slope = cylinder_slope = 0.5 * law_at_u.d_um
    if scene.moments_differ:
        half_space, cylinder, half_space_slope, cylinder_slope = body_moments(index, u, law)
        # The parts are divided by the scale of M/V, as m of the law is, and their sum differs from
        # it by rounding: they are scaled to the sum m.  Of elastic bodies m is 0.
        scale = m / (half_space + cylinder) if m > 0.0 else 1.0
        half_space *= scale
        cylinder *= scale
    return SpeedFunctions(
        L=law_at_u.L,
        dL=law_at_u.dL,
        ddL=law_at_u.ddL,
        half_space=half_space,
        cylinder=cylinder,
        half_space_slope=half_space_slope,
        cylinder_slope=cylinder_slope,
        pairs=pairs_at(index, u, law.cover_rows),
    )


@inline_kernel
def _lengths_and_pairs(u, scene):
    """Return (:class:`.law_functions.LengthAndMoment`, ``pairs`` of :class:`SpeedFunctions`) at
    one speed, for callers that do not read the moments of the bodies.

    u: float, kappa |V|, dimensionless, at least 0 and finite.
    scene: Scene, of which ``law`` is read.
    """
    law = by_value(scene.law)
    position = locate_row(u, law)
    return length_and_moment(position, u, law), pairs_at(position, u, law.cover_rows)


@inline_kernel
def _change_of(Q, pairs, L, dL, scene):
    """Return what the traction changes in the moments at one speed, as
    :class:`.cover_law.MomentChange`.

    Q: float, traction, dimensionless.
    pairs, L, dL: fields of :class:`SpeedFunctions`.
    scene: Scene, of which ``law`` and, of a cover, kappa and mu are read; of half-spaces all is 0.
    """
    cover_rows = by_value(scene.law).cover_rows
    if cover_rows is None:
        return MomentChange(
            half_space=0.0,
            cylinder=0.0,
            half_space_dQ=0.0,
            cylinder_dQ=0.0,
            half_space_du=0.0,
            cylinder_du=0.0,
        )
    reaction = shear_reaction(pairs, scene.kappa, scene.mu, L, dL, cover_rows)
    return moment_change(Q, scene.mu, reaction)


@inline_kernel
def loaded_moments(V, du_dV, Q, dQ_dV, dQ_dd, functions, scene):
    """Return traction and the rolling moments under it with their derivatives, as
    :class:`.table_law.Loads`.

    V: float, speed of the axis, dimensionless.
    du_dV: float, derivative of u = kappa |V| in V, kappa with the sign of V.
    Q, dQ_dV, dQ_dd: floats, traction and its derivatives in V and in d; of full slip the
    derivatives are 0.
    functions: :class:`SpeedFunctions` at u.
    scene: Scene, of which kappa and mu are read, of a cover alone.
    """
    change = _change_of(Q, functions.pairs, functions.L, functions.dL, scene)
    # M = V m(u) + change(Q, u): slopes of the first are given in V; the second depends on V by u
    # and by Q, on d by Q alone
    return Loads(
        Q=Q,
        Q_dV=dQ_dV,
        Q_dd=dQ_dd,
        half_space=V * functions.half_space + change.half_space,
        half_space_dV=functions.half_space_slope
        + du_dV * change.half_space_du
        + change.half_space_dQ * dQ_dV,
        half_space_dd=change.half_space_dQ * dQ_dd,
        cylinder=V * functions.cylinder + change.cylinder,
        cylinder_dV=functions.cylinder_slope
        + du_dV * change.cylinder_du
        + change.cylinder_dQ * dQ_dV,
        cylinder_dd=change.cylinder_dQ * dQ_dd,
    )


@inline_kernel
def slip_power(V, omega, Q, M_half_space, M_cylinder, scene):
    """Return the power that friction takes, and that which the bodies take, at a state.

    Their sum, V M_half_space + omega M_cylinder + (omega - V) Q, is the loss of kinetic energy per
    unit of tau without a drive, by V V' + j omega omega' of Eq. (22).  The bodies take V and omega
    times the moments without traction.  Friction takes (omega - V) Q and, on a cover, V and omega
    times what the traction changes in the moments (:func:`_change_of`).

    V, omega, Q, M_half_space, M_cylinder: floats, the state, dimensionless, with the moments under
    traction.
    scene: Scene, of which ``law``, moments_differ, kappa and mu are read, of a cover alone.
    Returns (slip, rolling), floats, dimensionless, per unit of tau.
    """
    functions, pairs = _lengths_and_pairs(scene.kappa * abs(V), scene)
    change = _change_of(Q, pairs, functions.L, functions.dL, scene)
    by_shear = V * change.half_space + omega * change.cylinder
    table = by_value(scene.law).table
    by_shear = friction_by_shear(V, omega, Q, scene.kappa, scene.mu, by_shear, table)
    # what friction takes beside (omega - V) Q, the bodies do not take: the sum stays
    return (omega - V) * Q + by_shear, V * M_half_space + omega * M_cylinder - by_shear


@inline_kernel
def reaction_at_rest(scene):
    """Return how shear acts back on the moments in the limit V -> 0, as
    :class:`.cover_law.Reaction`.

    scene: Scene, of which ``law`` and, of a cover, kappa and mu are read; all is 0 of half-spaces.
    """
    functions, pairs = _lengths_and_pairs(0.0, scene)
    cover_rows = by_value(scene.law).cover_rows
    return shear_reaction(pairs, scene.kappa, scene.mu, functions.L, functions.dL, cover_rows)


@inline_kernel
def asymmetry(pairs, L, dL, ddL, scene):
    """Return the asymmetry c of the onsets of full slip at one speed, as
    :class:`.cover_law.OverSpeed`; 0 of half-spaces and of tables.

    pairs: field of :class:`SpeedFunctions`.
    L, dL, ddL: floats, 2 kappa delta_star/mu of the rows and its derivatives over u.
    scene: Scene, of which ``law`` and, of a cover, mu are read.
    """
    law = by_value(scene.law)
    rows = asymmetry_at(pairs, scene.mu, L, dL, ddL, law.cover_rows)
    return asymmetry_of_table(rows, law.table)


@inline_kernel
def asymmetry_at_speed(V, scene):
    """Return the asymmetry c at a speed V of either sign, a float; V = 0: the limit."""
    functions, pairs = _lengths_and_pairs(scene.kappa * abs(V), scene)
    return asymmetry(pairs, functions.L, functions.dL, functions.ddL, scene).value


@inline_kernel
def rest_limits(scene, sigma=1.0):
    """Return (L, creepage delta_0 of free rolling) in the limit V -> 0, dimensionless; 1 and 0 for
    half-spaces.

    L = 2 kappa delta_star/mu is above 0; delta_0 of a cover has either sign.  Departure from rest
    and exponential decay are decided with these limits; :func:`.law_functions.limits_at_rest` gives
    them for a law.

    scene: Scene, of which kappa and ``law`` are read, and mu of a table.
    sigma: float, side of d, 1.0 or -1.0, on which L of a table depends; its delta_0 is the creepage
    of d = 0.
    """
    law = by_value(scene.law)
    L, delta_0 = limits_at_rest(scene.kappa, law)
    # the middle creep 2 kappa delta_0 stands for delta_0, which a table replaces by its own
    rows = Width(
        L=L, dL=0.0, ddL=0.0, middle=2.0 * scene.kappa * delta_0, dmiddle=0.0, ddmiddle=0.0
    )
    width = width_at(0.0, sigma, scene.mu, rows, law.table)
    return width.L, 0.5 / scene.kappa * width.middle


@inline_kernel
def pull_at_rest(d, scene):
    """Return what friction does at V = 0: force on the axis, torque against the spin, and their
    derivatives in d.

    With the factors a and excesses e of base and cylinder (:class:`.cover_law.Reaction`), 0 of
    half-spaces, V' contains Q (1 + a_b + e_b |Q|/mu), and j omega' contains -Q (1 - a_c - e_c
    |Q|/mu): the moments that the traction makes are included.

    d: float, in [-1, 1].
    scene: Scene, of which mu and ``law`` and, of a cover, kappa are read.
    Returns (force, torque, derivative of the force, derivative of the torque), floats,
    dimensionless: Q and Q of half-spaces; of a cover Q times these factors; of a table Q -
    M_half_space and Q + M_cylinder.
    """
    used = abs(d) * (2.0 - abs(d))  # |Q|/mu
    Q = scene.mu * d * (2.0 - abs(d))
    dQ_dd = 2.0 * scene.mu * (1.0 - abs(d))
    reaction = reaction_at_rest(scene)
    on_axis = 1.0 + reaction.half_space + reaction.half_space_excess * used
    on_spin = 1.0 - reaction.cylinder - reaction.cylinder_excess * used
    # Q (a + e |Q|/mu) has the derivative a + 2 e |Q|/mu in Q: once more the term of the excess
    axis_dQ = on_axis + reaction.half_space_excess * used
    spin_dQ = on_spin - reaction.cylinder_excess * used
    rows = Q * on_axis, Q * on_spin, axis_dQ * dQ_dd, spin_dQ * dQ_dd
    return pull_of_table(d, scene.kappa, scene.mu, rows, by_value(scene.law).table)


@inline_kernel
def _width(V, sigma, scene):
    """Return the :class:`.table_law.Width` at a speed V of either sign on the side sigma, of which
    only L and ``middle`` are to be read.

    Its derivatives are 0 of a law of rows, where they are not evaluated, and those of the table of
    a law with one.

    V: float, dimensionless.
    sigma: float, side of d, 1.0 or -1.0, on which L of a table depends.
    scene: Scene, of which ``law``, kappa and mu are read.
    """
    u = scene.kappa * abs(V)
    law = by_value(scene.law)
    L = length_and_moment(locate_row(u, law), u, law).L
    rows = Width(
        L=L, dL=0.0, ddL=0.0, middle=free_creep_and_slopes(u, law)[0], dmiddle=0.0, ddmiddle=0.0
    )
    return width_at(u, sigma, scene.mu, rows, law.table)


@inline_kernel
def critical_creepage(V, sigma, scene):
    """Return the critical creepage delta_star, Eq. (9), at which the whole contact slips,
    dimensionless.

    On a cover it is the excess over the creepage without creep force, delta_star (1 + sigma c).  It
    is above 0, even in V, and of half-spaces mu L/(2 kappa) with L of :func:`rest_limits` at V = 0.

    V: float, speed of the axis of either sign, finite, dimensionless.
    sigma: float, sign of the slip, 1.0 or -1.0, on which that of a cover depends.
    scene: Scene, of which kappa, mu and ``law`` are read.
    """
    onset = creep_over_L(V, sigma, scene).value
    return 0.5 * scene.mu / scene.kappa * _width(V, sigma, scene).L * abs(onset)


@inline_kernel
def creep_over_L(V, d, scene):
    """Return the :class:`.cover_law.CreepCurve` at a speed V and d, both of either sign; V = 0: the
    limit.

    Its value is (delta - delta_0)/delta_star; d of half-spaces.

    scene: Scene, of which ``law`` and, of a cover, kappa and mu are read.
    """
    return creep_of(d, asymmetry_at_speed(V, scene), by_value(scene.law).cover_rows)


@inline_kernel
def reduced_slip(slip, limit, V, sigma, scene):
    """Return d of an excess slip in partial slip.

    slip: float, :func:`excess_slip`, dimensionless, of sign sigma.
    limit: float, its modulus where full slip begins, |V| times :func:`critical_creepage`, > 0.
    V, sigma: floats, speed of the axis, and 1.0 or -1.0.
    scene: Scene, of which kappa, mu and ``law`` are read.
    """
    # limit is delta_star |V| (1 + sigma c): from here on the excess is divided by delta_star |V|
    c = asymmetry_at_speed(V, scene)
    return reduced_creep(slip / limit * (1.0 + sigma * c), c)


@inline_kernel
def creepage(V, d, scene):
    """Return the creepage delta, Eq. (5), in partial slip: d delta_star, and on a cover delta_0 +
    delta_star (d + c d^2).

    V: float, speed of the axis of either sign, dimensionless; V = 0: the limit.
    d: float, |d| <= 1 in partial slip, beyond it the result is linear in d.
    scene: Scene, of which kappa, mu and ``law`` are read.
    Returns a float, dimensionless; omega = V (1 + delta) follows from it.
    """
    # the side of d, which L of a table depends on; d = -0.0 is on the side -1, where the term is 0
    width = _width(V, np.copysign(1.0, d), scene)
    creep = creep_over_L(V, d, scene).value
    return 0.5 * scene.mu / scene.kappa * width.L * creep + 0.5 / scene.kappa * width.middle


@inline_kernel
def excess_slip(slip, V, scene):
    """Return the slip less that of free rolling, omega - V - delta_0 V; delta_0 = 0 for
    half-spaces.

    slip: float, omega - V, signed, dimensionless.
    V: float, speed of the axis of either sign, dimensionless.
    scene: Scene, of which ``law`` is read, and kappa of a cover.
    Returns a float, signed, dimensionless; full slip begins where its modulus is
    :func:`critical_creepage` times |V|.
    At V = 0 it is ``slip``.
    """
    return slip - V * (0.5 / scene.kappa * _width(V, 1.0, scene).middle)


@inline_kernel
def added_inertia(V, scene):
    """Return the factor n = gamma N of the added mass N V', with its derivative and its integral.

    The equations are in docs/theory_materials.md, Slowly changing speed.

    V: float, speed of the axis of either sign, dimensionless.
    scene: Scene, of which ``law``, kappa and gamma are read; motions of a cover have none.
    Returns (n, its derivative in V, its integral over V), floats, dimensionless; all are 0 for a
    law without added mass.  n is even and its derivative odd in V; at V = 0 the derivative is that
    of V > 0.  The integral begins at V = 0, but at infinity where n <= -4 at V = 0, as V = 0 is not
    reached then.
    """
    law = by_value(scene.law)
    # behind this test, which is inlined, so that steady rolling costs nothing else
    if unlikely(law.N_rows.size > 0):
        return _evaluate_added_mass(law, V, scene.kappa, scene.gamma)
    return 0.0, 0.0, 0.0


@inline_kernel
def omega_and_delta(state, regime, scene):
    """Return angular velocity and creepage, Eq. (5), of a state.

    state: State, the unknowns.
    regime: Regime, whose ``full_slip`` tells what the second unknown is.
    scene: Scene, of which kappa, mu and ``law`` are read, in partial slip only.
    Returns (omega, delta), floats, dimensionless, omega in the direction of the regime.  On a cover
    delta contains the creepage without creep force.  At V = 0 in partial slip omega is 0 and delta
    is its limit; in full slip delta is then infinite with the sign of omega, +inf where omega is 0
    too (-inf for omega = -0.0).
    """
    if not regime.full_slip:
        delta = creepage(state.V, state.omega_or_d, scene)
        return state.V * (1.0 + delta), delta
    slip = state.omega_or_d - state.V
    # at V = 0 infinite, also for omega = 0, where law_record.slip_and_creepage has 0
    return state.omega_or_d, slip / state.V if state.V != 0.0 else np.copysign(np.inf, slip)


@inline_kernel
def added_mass_margin(n, j):
    """Return the margin of the added mass, above 0 while the equations are regular, dimensionless.

    The factor of V' vanishes at n = 1 + j, where the equations are singular.  A motion also ends
    where n has fallen to -min(1 + j, 2)/2: there the added mass takes half of the inertia 1 + j, or
    half of the factor 1 + n/2 of V', and the correction by N is no longer small.  The margin is 1
    without added mass, 0 at these two n, negative beyond them.

    n: float, gamma N, signed, dimensionless.
    j: float, moment of inertia J/(m R^2), above 0, dimensionless.
    Returns a float, above 0 for n between the two zeros, 0 at them, below 0 elsewhere; NaN for a
    NaN.
    """
    return (1.0 - n / (1.0 + j)) * (1.0 + 2.0 * n / min(1.0 + j, 2.0))


@inline_kernel
def stick_edge_function(V, omega_or_d, regime, scene):
    """Return the event function of the edge of the stick zone: positive within the regime, 0 at its
    end.

    In full slip it is sigma times the slip omega - V, on a cover less the slip delta_0 V of free
    rolling, minus the limit delta_star |V|, Eq. (9): it is 0 where a stick zone forms, and negative
    too where the slip has the sign opposite to sigma.  In partial slip it is the product of 1 -
    sigma d and the margin of the added mass, :func:`added_mass_margin`: it is 0 where the stick
    zone vanishes, d = sigma, or where the margin is 0.  Without added mass the margin is 1.

    V: float, speed of the axis, dimensionless.
    omega_or_d: float, second unknown, dimensionless: omega in full slip, d in partial slip.
    regime: Regime, the present one; ``full_slip`` and ``sigma`` are read.
    scene: Scene, of which ``law`` and kappa are read, in full slip also mu, in partial slip gamma
    and j.
    Returns a float, dimensionless: in full slip a speed, in partial slip a part of the critical
    creepage.
    """
    if not regime.full_slip:  # one function for both ends; added_mass_exhausted tells which it was
        n, _, _ = added_inertia(V, scene)
        return (1.0 - regime.sigma * omega_or_d) * added_mass_margin(n, scene.j)
    return regime.sigma * excess_slip(omega_or_d - V, V, scene) - critical_creepage(
        V, regime.sigma, scene
    ) * abs(V)
