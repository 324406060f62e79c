"""Closed-form ends of a motion: steady rolling under a constant drive, and exponential decay at low
speed.

With P = p' and B = V d' of :mod:`rhs`, and p_V and p_d the derivatives of p in V and d, partial
slip is

    V' = (P - p_d B/V)/p_V      d' = B/V

An equilibrium is stable where the Jacobian of (V', d') has a negative trace and a positive
determinant.  A motion within a small fraction of the tolerance of a stable equilibrium stays there
as long as the drive is constant.  In full slip V has equilibria of its own, while omega is constant
or linear in time.  Steps could not follow either for long: the rounding of P, times the length of a
step, exceeds the tolerance.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Rates: the right-hand side at a State and its derivatives (:mod:`rhs`).
- p: the unknown collocated in place of V, proportional to V + j omega in partial slip; V itself in
  full slip (:mod:`rhs`).  p' is its slope in tau.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.intrinsics import by_value
from ..numerics.jit import inline_kernel, kernel
from ..records import (
    AT_REST,
    CAME_TO_REST,
    COMPLETED,
    N_QUADRATURES,
    PARTIAL_SLIP,
    State,
    Step,
    StepState,
)
from .collocation import (
    NODE_FRACTIONS,
    REST_TIME,
    ROW_DENSE_OMEGA_OR_D,
    ROW_DENSE_V,
    ROW_OMEGA_OR_D,
    ROW_P,
    ROW_P_DIAGONAL,
    ROW_P_RATE,
    ROW_V,
    N,
    last_output_tau,
    set_step_length,
)
from .drive import current_load, is_unloaded, rest_threshold, store_drive
from .motion_law import added_inertia, evaluate_moments, reaction_at_rest, rest_limits
from .output import accept_step, record_switch, write_column, write_quadrature
from .rhs import current_rates
from .step_control import moderate_speed
from .table_law import SlowLaw, slow_law_of_table, sticks_at_rest

#: A motion has reached an equilibrium at this relative distance of V divided by rtol: the distance
#: adds nothing that counts to the errors of the steps before.
_NEAR_EQUILIBRIUM = 1e-3
#: Smallest such distance that rounding leaves, dimensionless.
_NEAR_ROUNDING = 1e-14
#: The equilibrium is evaluated only where V is within this multiple of that distance by p' and p at
#: node 0, which are stored; p is only about dp/dV times V.
_EQUILIBRIUM_CHECK = 2.0
#: V divided by rtol and by the moderate speed, below which V decays exponentially: M/V then differs
#: from its limit at V = 0 by about 1e-4 rtol, as M is linear in V up to terms of the order kappa V.
_COASTING_SPEED = 1e-4
#: |d| divided by rtol, below which V decays exponentially: the part j k L d V of p is then below
#: rtol V for j k up to 100.
_COASTING_D = 1e-2


@inline_kernel
def may_be_at_equilibrium(noise, work):
    """Return whether p at node 0 may be near its equilibrium, a bool: a check that costs no
    evaluation of the law.

    p is estimated to be p'/(dp'/dp) away from the equilibrium, and the noise may explain a part of
    p'; this distance is compared with twice the tolerance of an equilibrium times |p|.  Where
    dp'/dp >= 0 there is no stable equilibrium, and the result is True only for a p' within the
    noise.  If True, :func:`find_equilibrium` decides.

    noise: float, rounding error of p', at least 0, dimensionless.
    work: Workspace, with p, p' and dp'/dp at node 0 (ROW_P, ROW_P_RATE, ROW_P_DIAGONAL); rtol is
    read too.
    Returns True also at equality, False if one of these is NaN.
    """
    nodes = work.nodes
    tolerance = max(_NEAR_EQUILIBRIUM * work.options.rtol, _NEAR_ROUNDING)
    # |p'|/|dp'/dp| <= 2 tolerance |p|, multiplied by -dp'/dp, which is above 0 where it is stable
    return abs(nodes[ROW_P_RATE]) - noise <= -_EQUILIBRIUM_CHECK * tolerance * nodes[
        ROW_P_DIAGONAL
    ] * abs(nodes[ROW_P])


@kernel
def find_equilibrium(state, regime, noise, step_state, work):
    """Return the stable equilibrium under the present drive and whether the motion has reached it.

    The motion has reached it if the Newton step to it is at most the tolerance, max(0.001 rtol,
    1e-14), of V relative to itself and of d in absolute terms, plus the step that ``noise``
    explains.  The Jacobian of the present state decides whether the equilibrium is stable.  In full
    slip the equilibrium is that of V alone, and omega is unchanged; there V has none where omega
    approaches V, or 0 under a brake, where feedback of omega acts on either speed, or where V' does
    not decrease with V.

    state: State, the present one, with V > 0 in partial slip.
    regime: Regime, at that state; all fields are read.
    noise: float, rounding error of p' at the equilibrium, dimensionless.
    step_state: StepState, with the time and its segment.
    work: Workspace, of which Scene, Drive and rtol are read.
    Returns (reached, State): a bool, and the State after the Newton step, reached or not, with V at
    least 0 in partial slip; nothing limits its d.  (False, state) where the equilibrium is not
    stable, in full slip where V has none, and in partial slip where a speed is prescribed or the
    brake holds omega.
    """
    load = current_load(regime, step_state, work)
    rates = current_rates(state, regime, step_state, work)
    V = state.V
    tolerance = max(_NEAR_EQUILIBRIUM * work.options.rtol, _NEAR_ROUNDING)
    if regime.full_slip:
        # Feedback of omega on V' or on omega', or a V' that does not decrease with V (or is NaN);
        # or omega approaches V, or 0 under a brake: the regime will end.
        if (
            rates.dp_rate_dd != 0.0
            or rates.drate_dd != 0.0
            or not rates.dp_rate_dV < 0.0
            or regime.sigma * rates.weighted_rate < 0.0
            or regime.spin_sign * rates.weighted_rate < 0.0
        ):
            return False, state
        V_off = rates.p_rate / rates.dp_rate_dV  # distance of V from its equilibrium; p is V here
        # -noise/(dp'/dV) is above 0: the distance that an error ``noise`` of p' explains
        steady = abs(V_off) <= tolerance * V - noise / rates.dp_rate_dV
        return steady, State(V - V_off, state.omega_or_d)
    # Where one speed is prescribed, p' does not depend on the other.
    if load.inverse_mass == 0.0 or load.inverse_inertia == 0.0:
        return False, state
    gains = load.gains
    p_d = rates.dp_dd
    # p' depends on d by the feedback of omega, which Newton's matrix of a step neglects.
    p_rate_d = (
        rates.dp_rate_dd + load.inverse_inertia * (gains.force_omega + gains.torque_omega) * p_d
    )
    # V' and d' of the module with their derivatives, the elements of the Jacobian: x_y is dx'/dy.
    # Terms with the rates themselves are left out, as these vanish at the equilibrium.
    d_rate = rates.weighted_rate / V
    d_V = rates.drate_dV / V
    d_d = rates.drate_dd / V
    V_rate = (rates.p_rate - p_d * d_rate) / rates.dp_dV
    V_V = (rates.dp_rate_dV - p_d * d_V) / rates.dp_dV
    V_d = (p_rate_d - p_d * d_d) / rates.dp_dV
    determinant = V_V * d_d - V_d * d_V
    if not (V_V + d_d < 0.0 < determinant):
        return False, state
    # Newton's step, by Cramer's rule: the distances of V and d from the equilibrium, and what an
    # error ``noise`` of p', noise/p_V of V', changes in them (times d_d and d_V below).
    V_off = (V_rate * d_d - d_rate * V_d) / determinant
    d_off = (d_rate * V_V - V_rate * d_V) / determinant
    rounding = abs(noise / (rates.dp_dV * determinant))
    steady = abs(V_off) <= tolerance * V + rounding * abs(d_d) and abs(
        d_off
    ) <= tolerance + rounding * abs(d_V)
    # Where force and torque cancel, V is 0 but for rounding.
    return steady, State(max(V - V_off, 0.0), state.omega_or_d - d_off)


@kernel
def continue_at_equilibrium(end, noise, state, regime, step_state, work):
    """Write the outputs up to the end of a segment if a motion has reached its equilibrium.

    V is constant there, and d in partial slip; omega is linear in time in full slip.

    end: float, tau at the end of the segment.
    noise: float, rounding error of p', dimensionless.
    state: State, the present one, with V > 0 in partial slip.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with the time and its segment.
    work: Workspace, of the motion; where the equilibrium is reached, nodes, dense output, drive at
    the nodes, outputs and quadratures are written.
    Returns (reached, State, StepState): whether the motion has reached it, a bool; if so the State
    at the equilibrium, of V alone in full slip, with omega of the end of the segment, and the
    StepState there, with one trial step and one accepted step more and the length of the next step
    not chosen; else both unchanged.
    """
    steady, equilibrium = find_equilibrium(state, regime, noise, step_state, work)
    if not steady:
        return False, state, step_state
    state = equilibrium
    nodes = work.nodes
    # One step to the end of the segment, whose nodes and dense output are written here, so that
    # outputs and quadratures are those of any step.
    step = Step(
        tau=step_state.tau,
        h=end - step_state.tau,
        segment=step_state.segment,
        initial_slope_known=True,
        undriven=False,
    )
    omega_change = 0.0
    if regime.full_slip:
        omega_change = step.h * current_rates(state, regime, step_state, work).weighted_rate
    for i in range(N + 1):
        nodes[ROW_V + i] = state.V
        nodes[ROW_OMEGA_OR_D + i] = state.omega_or_d + omega_change * NODE_FRACTIONS[i]
        nodes[ROW_DENSE_V + i] = nodes[ROW_DENSE_OMEGA_OR_D + i] = 0.0
    nodes[ROW_DENSE_OMEGA_OR_D] = 0.5 * omega_change  # The change is linear in v = 0 ... 2.
    store_drive(step, work)
    step_state = set_step_length(0.0, 1, step_state)
    return (
        True,
        State(state.V, state.omega_or_d + omega_change),
        accept_step(end, 2.0, step, regime, step_state, work),
    )


class FreeDecay(NamedTuple):
    """Exponential decay of V in slow free rolling, V' = -rate V, dimensionless.

    rate : its rate per unit of tau, below 0 where the feedback drives.
    creep : creepage less delta_0, divided by V.
    delta_0 : creepage without creep force in the limit V -> 0, so that omega = V (1 + delta_0).
    force, torque : those of the feedback divided by V, positive where they drive; 0 without one.
    """

    rate: float
    creep: float
    delta_0: float
    force: float
    torque: float


@kernel
def free_decay(work):
    """Return the decay of V where nothing but resistance and feedback acts, as :class:`FreeDecay`,
    in the limit V -> 0.

    With a_b and a_c, the factors of Q by which shear acts back on M
    (:class:`.cover_law.Reaction`), 0 of half-spaces, and delta_0 the creepage without creep force,
    V' = (1 + a_b) Q - M_half_space + f and j (1 + delta_0) V' = q - (1 - a_c) Q - M_cylinder, with
    moments without traction and feedback f and q in proportion to V.  Q is eliminated: with a = 1 +
    a_b, b = 1 - a_c and J = j (1 + delta_0)

        (b + a J) V' = -b (M_half_space - f) - a (M_cylinder - q)
        (b + a J) Q = J (M_half_space - f) - M_cylinder + q

    Added mass of half-spaces, half of n V' in either moment, adds n to the factor of V', and n/2 to
    J and to the factor 1 of M_cylinder - q in the second line.  A law by a table has slopes over d
    on each side of d = 0; those of the side on which d lies are taken.

    work: Workspace, of the motion; its Scene and the gains of its feedback are read.
    """
    scene = work.scene
    functions = evaluate_moments(0.0, scene)
    reaction = reaction_at_rest(scene)
    L, delta_0 = rest_limits(scene, 1.0)
    # Q_V = 0, as on rows Q is 0 at d = 0; creep_V = 0, as the change of delta_0 with V is left out
    rows = SlowLaw(
        half_space=functions.half_space,
        cylinder=functions.cylinder,
        reaction_half_space=reaction.half_space,
        reaction_cylinder=reaction.cylinder,
        creep_V=0.0,
        creep_Q=L / (4.0 * scene.kappa),  # Q = 2 mu d for small d
        Q_V=0.0,
    )
    gains = work.drive.gains
    omega_over_V = 1.0 + delta_0
    force = gains.force_V + gains.force_omega * omega_over_V
    torque = gains.torque_V + gains.torque_omega * omega_over_V
    spin_inertia = scene.j * omega_over_V
    n = added_inertia(0.0, scene)[0]  # 0 of covers
    for sigma in (1.0, -1.0):
        slow = slow_law_of_table(sigma, scene.kappa, scene.mu, rows, by_value(scene.law).table)
        on_axis = 1.0 + slow.reaction_half_space
        on_spin = 1.0 - slow.reaction_cylinder
        inertia = on_spin + spin_inertia * on_axis + n
        axis_loss = slow.half_space - force
        spin_loss = slow.cylinder - torque
        if on_axis == 1.0 and on_spin == 1.0:  # half-spaces: the same sum, in another order
            rate = (slow.half_space + slow.cylinder - force - torque) / inertia
        else:
            rate = (on_spin * axis_loss + on_axis * spin_loss) / inertia
        Q = (spin_inertia + 0.5 * n) * axis_loss
        Q = (Q - (1.0 + 0.5 * n) * spin_loss) / inertia
        # Q_V is Q/V at d = 0, so that Q above it means d > 0; at equality both sides serve
        if sigma * (Q - slow.Q_V) >= 0.0:
            break
    creep = slow.creep_V + slow.creep_Q * Q
    return FreeDecay(rate=rate, creep=creep, delta_0=delta_0, force=force, torque=torque)


@inline_kernel
def is_coasting(state, regime, step_state, work):
    """Return whether V decays exponentially from here on, to a fraction of the tolerance; a bool.

    It does in partial slip at 0 < V < 1e-4 rtol times the moderate speed with |d| < 0.01 rtol, if
    the rolling resistance exceeds the feedback and no force, torque, brake or prescribed speed acts
    from this segment on.  Where alpha = 1 there is no rolling resistance, and V decays only under a
    feedback that brakes.

    state: State, the present one.
    regime: Regime, at that state; ``full_slip`` is read.
    step_state: StepState, of which the segment is read.
    work: Workspace, of which Scene, Drive and rtol are read.
    Returns False in full slip, at V = 0 and where resistance and feedback are equal;
    :func:`coast_to_end` is for True.
    """
    rtol = work.options.rtol
    if regime.full_slip or not 0.0 < state.V < _COASTING_SPEED * rtol * moderate_speed(work.scene):
        return False
    scene = work.scene
    # the cheapest test first: most states do not reach the others
    return (
        abs(state.omega_or_d) < _COASTING_D * rtol
        and sticks_at_rest(scene.kappa, scene.mu, by_value(scene.law).table)
        and free_decay(work).rate > 0.0
        and is_unloaded(step_state.segment, work.drive)
    )


@kernel
def coast_to_end(state, regime, step_state, work):
    """Write the remaining outputs by the closed form of slow rolling, V' = -rate V with delta -
    delta_0 proportional to V.

    Of half-spaces the rate is (M - f - q)/(V inertia) with M, f and q, the rolling moment and the
    feedback, in the limit V -> 0 and inertia = 1 + j + gamma N, with gamma N the added mass;
    :func:`free_decay` has it for covers too.  delta_0 is the creepage without creep
    force for V -> 0, 0 for half-spaces.

    With a rest threshold the motion ends when the larger speed has fallen to it; an output at that
    very time still moves.  From then on V = omega = delta = 0, forces of 0 and the code AT_REST are
    written, the kinetic energy that is left counts as lost, and works and losses are those of the
    whole decay to V = 0.

    state: State, one for which :func:`is_coasting` holds; V, the start of the decay, is read.
    regime: Regime, at that state; ``direction`` is read.
    step_state: StepState, with the time and its segment.
    work: Workspace, of the motion; all outputs from ``next_output`` on are written, and where the
    motion comes to rest REST_TIME, t = tau/gamma, and the change of regime to AT_REST, among the
    switches.
    Returns (status, StepState): CAME_TO_REST if the threshold is reached at or before the last
    output time, else COMPLETED; the StepState at the last output time or, if earlier, at the time
    of coming to rest, with the numbers of steps unchanged.
    """
    scene = work.scene
    V0 = regime.direction * state.V
    free = free_decay(work)
    rate = free.rate
    omega_over_V = 1.0 + free.delta_0
    creep = state.V * free.creep  # delta - delta_0
    largest_speed = max(state.V, abs(V0 * (omega_over_V + creep)))
    tau = work.output_tau
    rest_speed = rest_threshold(step_state.segment, work)
    end = np.inf
    if rest_speed > 0.0:
        # exp(-rate time) is the ratio of the speeds; now, where the speed is below already
        end = step_state.tau + max(np.log(largest_speed / rest_speed) / rate, 0.0)
    # Quadratures 2 ... 6 of the whole decay, divided by V^2/2 at the start.  The integral of V^2
    # over tau is V^2/(2 rate): a power of c V^2 takes c/rate times V^2/2.  The loss in slip is of
    # higher order and counts as 0: the loss in rolling is the kinetic energy plus the works of the
    # feedback, negative where it brakes.
    force_work = free.force / rate
    torque_work = free.torque / rate * omega_over_V
    kinetic = 1.0 + scene.j * omega_over_V * omega_over_V
    energies = (0.0, kinetic + force_work + torque_work, force_work, torque_work, 0.0)
    for column in range(step_state.next_output, tau.size):
        moves = tau[column] <= end
        # exp(-rate time) - 1 without cancellation for short times; ``decay`` is the exponential,
        # which for long times, where the sum would cancel, is computed itself.
        exponent = -rate * (min(tau[column], end) - step_state.tau)
        expm1_decay = np.expm1(exponent)
        decay = 1.0 + expm1_decay if expm1_decay > -0.5 else np.exp(exponent)
        # Integral of V over t = tau/gamma, and V^2/2 lost so far, V_0^2 (1 - decay^2)/2.
        distance = -V0 * expm1_decay / (rate * scene.gamma)
        energy = 0.5 * V0 * V0 * (-expm1_decay * (1.0 + decay) if moves else 1.0)
        V = V0 * (decay if moves else 0.0)
        delta = creep * decay
        speeds = V, V * (omega_over_V + delta), delta + free.delta_0 if moves else 0.0
        code = PARTIAL_SLIP if moves else AT_REST
        write_column(column, speeds, code, (free.force * V, free.torque * V), work)
        write_quadrature(column, 0, distance, work)
        # without the creepage beyond delta_0, which is of the order of V: its angle is negligible
        write_quadrature(column, 1, distance * omega_over_V, work)
        for n in range(2, N_QUADRATURES):
            write_quadrature(column, n, energies[n - 2] * energy, work)
    stop = min(end, last_output_tau(work))
    step_state = StepState(
        tau=stop,
        next_output=tau.size,
        segment=step_state.segment,
        n_steps=step_state.n_steps,
        n_accepted=step_state.n_accepted,
        h=0.0,
    )
    if end > stop:
        return COMPLETED, step_state
    record_switch(AT_REST, step_state, work)
    work.nodes[REST_TIME] = end / scene.gamma
    return CAME_TO_REST, step_state
