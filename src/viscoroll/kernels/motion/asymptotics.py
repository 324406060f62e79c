"""Closed-form ends of a motion: steady rolling under a constant drive, and exponential decay at low speed.

With P = p' and B = V d' of :mod:`rhs`, partial slip is

    V' = (P - p_d B/V)/p_V      d' = B/V

An equilibrium is stable where the Jacobian of (V', d') has a negative trace and a positive determinant.  A motion
within a small fraction of the tolerance of a stable equilibrium stays there as long as the drive is constant.  In
full slip V has equilibria of its own, while omega is constant or linear in time.  Steps could not follow either for
long: the rounding of P, times the length of a step, exceeds the tolerance.
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from ..rows.cover import is_cover
from ..rows.evaluate import limits_at_rest
from .collocation import NODE_FRACTIONS, N
from .drive import current_load, is_unloaded, rest_threshold, store_drive
from .output import accept_step, write_column, write_quadrature
from .rhs import added_inertia, current_rates, low_speed_limits
from .step_control import moderate_speed
from .workspace import (
    AT_REST,
    CAME_TO_REST,
    COMPLETED,
    N_QUADRATURES,
    PARTIAL_SLIP,
    REST_TIME,
    ROW_DENSE_OMEGA_OR_D,
    ROW_DENSE_V,
    ROW_OMEGA_OR_D,
    ROW_P,
    ROW_P_DIAGONAL,
    ROW_P_RATE,
    ROW_V,
    State,
    Step,
    StepState,
    count_step,
)

#: relative distance from an equilibrium at which a motion has reached it, divided by rtol: the distance adds nothing to
#: the errors of the steps before
_NEAR_EQUILIBRIUM = 1e-3
#: smallest such distance that rounding allows
_NEAR_ROUNDING = 1e-14
#: distance from an equilibrium of V, in units of that above, below which the equilibrium is evaluated
_EQUILIBRIUM_CHECK = 2.0
#: V below which it decays exponentially, in units of rtol times the moderate speed
_COASTING_SPEED = 1e-4
#: |d| below which V decays exponentially, divided by rtol
_COASTING_D = 1e-2


@kernel(inline=True)
def equilibrium_tolerance(rtol):
    """Return the relative distance of V from its equilibrium at which a motion has reached it."""
    return max(_NEAR_EQUILIBRIUM * rtol, _NEAR_ROUNDING)


@kernel(inline=True)
def may_be_at_equilibrium(noise, work):
    """Return whether V at node 0 may be at its equilibrium, by the derivative of p' in V alone.

    noise: rounding error of p'.  p is about dp/dV times V.
    """
    nodes, tolerance = work.nodes, equilibrium_tolerance(work.options.rtol)
    return abs(nodes[ROW_P_RATE]) - noise <= -_EQUILIBRIUM_CHECK * tolerance * nodes[ROW_P_DIAGONAL] * abs(nodes[ROW_P])


@kernel
def _equilibrium_full_slip(state, rates, regime, noise, tolerance):
    """Return (whether V has reached its equilibrium in full slip, State there).

    state, rates: State and Rates at the present time; regime: Regime; noise: rounding error of p'; tolerance:
    relative distance of V at which it has reached its equilibrium. Only where omega does not approach V, nor 0 under
    a brake, and no feedback of omega acts; else (False, state).
    """
    if rates.dp_rate_dd != 0.0 or rates.drate_dd != 0.0 or not rates.dp_rate_dV < 0.0:
        return False, state
    if regime.sigma * rates.weighted_rate < 0.0 or regime.spin_sign * rates.weighted_rate < 0.0:
        return False, state
    V_off = rates.p_rate / rates.dp_rate_dV
    return abs(V_off) <= tolerance * state.V - noise / rates.dp_rate_dV, State(state.V - V_off, state.omega_or_d)


@kernel
def find_equilibrium(state, regime, noise, step_state, work):
    """Return the stable equilibrium of the present drive, if a motion has reached it.

    Parameters
    ----------
    state, regime, step_state, work : State, Regime, StepState, Workspace
        The motion, with V > 0.
    noise : float
        Rounding error of p' where that is 0, dimensionless.

    Returns
    -------
    (bool, State)
        Whether Newton's step to an equilibrium is below :func:`equilibrium_tolerance`, of V relative to itself and
        of d, or below rounding, and the equilibrium is stable; the state after that step.  False in partial slip
        with a speed prescribed.
    """
    load, rates = current_load(regime, step_state, work), current_rates(state, regime, step_state, work)
    V, tolerance = state.V, equilibrium_tolerance(work.options.rtol)
    if regime.full_slip:
        return _equilibrium_full_slip(state, rates, regime, noise, tolerance)
    if (
        load.inverse_mass == 0.0 or load.inverse_inertia == 0.0
    ):  # one speed is prescribed: p' does not depend on the other
        return False, state
    gains, p_d = load.gains, rates.dp_dd
    # p' depends on d by the feedback of omega; Newton's matrix of a step neglects this
    p_rate_d = rates.dp_rate_dd + load.inverse_inertia * (gains.force_omega + gains.torque_omega) * p_d
    d_rate, d_V, d_d = rates.weighted_rate / V, rates.drate_dV / V, rates.drate_dd / V
    V_rate = (rates.p_rate - p_d * d_rate) / rates.dp_dV
    V_V, V_d = (rates.dp_rate_dV - p_d * d_V) / rates.dp_dV, (p_rate_d - p_d * d_d) / rates.dp_dV
    determinant = V_V * d_d - V_d * d_V
    if not (V_V + d_d < 0.0 < determinant):
        return False, state
    V_off, d_off = (V_rate * d_d - d_rate * V_d) / determinant, (d_rate * V_V - V_rate * d_V) / determinant
    rounding = abs(noise / (rates.dp_dV * determinant))
    steady = abs(V_off) <= tolerance * V + rounding * abs(d_d) and abs(d_off) <= tolerance + rounding * abs(d_V)
    # where force and torque cancel, V = 0 but for rounding
    return steady, State(max(V - V_off, 0.0), state.omega_or_d - d_off)


@kernel
def continue_at_equilibrium(end, noise, state, regime, step_state, work):
    """Write the outputs up to the end of a segment if a motion has reached its equilibrium; omega is linear in full
    slip.

    Parameters
    ----------
    end : float
        tau at the end of the segment.
    noise : float
        As in :func:`find_equilibrium`.
    state, regime, step_state, work : State, Regime, StepState, Workspace
        The motion, with V > 0.

    Returns
    -------
    (bool, State, StepState)
        Whether it has; state and step state at the end of the segment, one step later, or unchanged.
    """
    steady, state_there = find_equilibrium(state, regime, noise, step_state, work)
    if not steady:
        return False, state, step_state
    state = state_there
    rates = current_rates(state, regime, step_state, work)
    omega_change = rates.weighted_rate * (end - step_state.tau) if regime.full_slip else 0.0
    nodes, step = work.nodes, Step(step_state.tau, end - step_state.tau, step_state.segment, True, False)
    for i in range(N + 1):
        nodes[ROW_V + i], nodes[ROW_OMEGA_OR_D + i] = state.V, state.omega_or_d + omega_change * NODE_FRACTIONS[i]
        nodes[ROW_DENSE_V + i] = nodes[ROW_DENSE_OMEGA_OR_D + i] = 0.0
    nodes[ROW_DENSE_OMEGA_OR_D] = 0.5 * omega_change  # linear in v = 0 ... 2
    store_drive(step, work)
    step_state = count_step(0.0, step_state)
    return True, State(state.V, state.omega_or_d + omega_change), accept_step(end, 2.0, step, regime, step_state, work)


@kernel(inline=True)
def is_coasting(state, regime, step_state, work):
    """Return whether at most feedback drives any more and V decays exponentially up to a fraction of the tolerance.

    state, regime, step_state: State, Regime and StepState at the present time; work: Workspace.
    """
    rtol = work.options.rtol
    if regime.full_slip or not 0.0 < state.V < _COASTING_SPEED * rtol * moderate_speed(work.scene):
        return False
    half_space, cylinder, force, torque = low_speed_limits(work)
    decays = half_space + cylinder > force + torque and abs(state.omega_or_d) < _COASTING_D * rtol
    return decays and is_unloaded(step_state.segment, work.drive)


@kernel
def coast_to_end(state, regime, step_state, work):
    """Write the outputs of the exponential decay (1 + j + gamma N) V' = -rate V with delta/V constant.

    state, regime, step_state: State in partial slip, Regime and StepState at the present time; work: Workspace.
    Returns (status COMPLETED or CAME_TO_REST, StepState at the last output).
    """
    scene, direction = work.scene, regime.direction
    half_space, cylinder, force, torque = low_speed_limits(work)
    L, delta_0 = limits_at_rest(scene.kappa, by_value(scene.law))
    omega_over_V = 1.0 + delta_0
    inertia = 1.0 + scene.j * omega_over_V + added_inertia(0.0, scene)[0]
    # V and omega decay together: Q = 4 kappa (delta - delta_0)/L balances the difference of the moments
    rate, stiffness = (half_space + cylinder - force - torque) / inertia, 4.0 * scene.kappa * inertia
    torque_difference = scene.j * omega_over_V * (half_space - force) - cylinder + torque
    creep = state.V * torque_difference / stiffness * L
    largest_speed = max(state.V, abs(state.V * (omega_over_V + creep)))
    tau, rest_speed, end = work.output_tau, rest_threshold(step_state.segment, work), np.inf
    if rest_speed > 0.0:
        end = step_state.tau + max(np.log(largest_speed / rest_speed) / rate, 0.0)
    force_work, torque_work = force / rate, torque / rate
    energies = 0.0, 0.0, 0.0, 1.0 + scene.j + force_work + torque_work, force_work, torque_work, 0.0
    if is_cover(by_value(scene.law).cover_rows):
        rolling = (half_space + cylinder * omega_over_V) / rate
        slipping = delta_0 * torque_difference / (inertia * rate)
        energies = 0.0, 0.0, slipping, rolling, force_work, torque_work * omega_over_V, 0.0
    for column in range(step_state.next_output, tau.size):
        moves = tau[column] <= end
        expm1_decay = np.expm1(-rate * (min(tau[column], end) - step_state.tau))
        decay = 1.0 + expm1_decay if expm1_decay > -0.5 else np.exp(-rate * (tau[column] - step_state.tau))
        V, delta = (state.V * decay, creep * decay) if moves else (0.0, 0.0)
        speeds = direction * V, direction * (V * (omega_over_V + delta)), delta + delta_0
        code = PARTIAL_SLIP if moves else AT_REST
        write_column(column, speeds, code, (force * direction * V, torque * direction * V), work)
        distance = -direction * state.V * expm1_decay / (rate * scene.gamma)
        energy = 0.5 * state.V * state.V * (-expm1_decay * (1.0 + decay) if moves else 1.0)
        for n in range(N_QUADRATURES):
            path = distance * (omega_over_V if n == 1 else 1.0)
            write_quadrature(column, n, path if n < 2 else energies[n] * energy, work)
    last = tau[tau.size - 1]
    step_state = StepState(last, tau.size, step_state.segment, step_state.n_steps, step_state.n_ended, 0.0)
    if end <= last:
        work.nodes[REST_TIME] = end / scene.gamma
    return CAME_TO_REST if end <= last else COMPLETED, step_state
