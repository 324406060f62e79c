"""Outputs of a motion: V, omega, delta and the regime; force and torque; quadratures (distance, angle, energies).

Row of outputs: V 0, omega 1, x 2, angle 3, delta 4, regime 5, force 6, torque 7, work of force 8 and of torque 9,
losses in the brake 10, in slip 11, in rolling 12.
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from .collocation import QUADRATURE_WEIGHTS, ROW_LENGTH, N, evaluate_integral, fit_integral
from .drive import evaluate_load, load_at_node, required_forces
from .regimes import regime_code
from .rhs import evaluate_rhs, evaluate_rhs_inline, omega_and_delta
from .workspace import (
    DIRECTION_REVERSED,
    N_FREE_QUADRATURES,
    N_QUADRATURES,
    N_RECORDED,
    N_SWITCHES,
    QUADRATURE_TOTALS,
    REGIME_AT_REST,
    ROW_DENSE_QUADRATURES,
    ROW_INTEGRANDS,
    ROW_OMEGA_OR_D,
    ROW_V,
    StepState,
    dense_position,
    dense_state,
    last_output_tau,
)

#: number of output quantities
N_OUTPUTS = 13
#: output row of x; that of the angle follows
OUT_X = 2
#: output row of the force; that of the torque follows
OUT_FORCE = 6
#: output row of the first energy; four others follow
OUT_WORK = 8
#: output row of each quadrature
_OUT_QUADRATURES = np.array([OUT_X, OUT_X + 1, OUT_WORK + 3, OUT_WORK + 4, OUT_WORK, OUT_WORK + 1, OUT_WORK + 2])


@kernel
def requested_groups(rows):
    """Return (whether a quadrature is among the requested output rows, whether force or torque is)."""
    quadratures = forces = False
    for row in rows:
        quadratures = quadratures or OUT_X <= row < OUT_X + 2 or row >= OUT_WORK
        forces = forces or OUT_FORCE <= row < OUT_WORK
    return quadratures, forces


@kernel
def write_column(column, speeds, code, forces, work):
    """Write (V, omega, delta), the code of the regime, and (force, torque) to one output column."""
    out, (V, omega, delta), (force, torque) = work.outputs, speeds, forces
    out[0, column], out[1, column], out[4, column], out[5, column] = V, omega, delta, code
    out[OUT_FORCE, column], out[OUT_FORCE + 1, column] = force, torque


@kernel
def write_quadrature(column, n, increase, work):
    """Write quadrature ``n``, its total so far plus ``increase``, to one output column."""
    work.outputs[_OUT_QUADRATURES[n], column] = work.nodes[QUADRATURE_TOTALS + n] + increase


@kernel
def _write_totals(column, work):
    """Write the totals of all quadratures to one output column."""
    for n in range(N_QUADRATURES):
        write_quadrature(column, n, 0.0, work)


@kernel
def record_switch(code, step_state, work):
    """Record a change of regime, or of the sign of V, at the time of the step state.

    code: regime behind it, or DIRECTION_REVERSED; step_state: StepState; work: Workspace.
    """
    nodes, switches = work.nodes, work.switches
    n = int(nodes[N_RECORDED])
    if n < switches.shape[0]:
        switches[n, 0], switches[n, 1] = step_state.tau / work.scene.gamma, code
    nodes[N_RECORDED] += 1.0
    nodes[N_SWITCHES] += 0.0 if code == DIRECTION_REVERSED else 1.0


@kernel
def write_outputs_at_rest(end, inclusive, code, step_state, work):
    """Write the outputs before a time of a cylinder at rest; return the StepState then.

    end: tau of that time; inclusive: whether an output at ``end`` itself is written too; code: regime in the
    outputs; step_state: StepState at the present time; work: Workspace.
    """
    column, tau = step_state.next_output, work.output_tau
    while column < tau.size and (tau[column] < end or (inclusive and tau[column] == end)):
        load = evaluate_load(tau[column], step_state.segment, REGIME_AT_REST, work)
        write_column(column, (0.0, 0.0, 0.0), code, (load.force, load.torque), work)
        _write_totals(column, work)
        column += 1
    return StepState(end, column, step_state.segment, step_state.n_steps + 1, step_state.n_ended, 0.0)


@kernel
def _write_state(column, state, segment, regime, work):
    """Write one output column but for the quadratures.

    column: index of the output time; state: State then; segment: index of the segment of the drive; regime: Regime;
    work: Workspace.
    """
    direction, force, torque = regime.direction, 0.0, 0.0
    omega, delta = omega_and_delta(state, regime, work.scene)
    if work.with_forces:
        load = evaluate_load(work.output_tau[column], segment, regime, work)
        rates = evaluate_rhs(state, load, regime, work.scene)
        force, torque, _ = required_forces(state.V, omega, rates, load, regime, work.scene.j)
    speeds, forces = (direction * state.V, direction * omega, delta), (direction * force, direction * torque)
    write_column(column, speeds, regime_code(regime), forces, work)


@kernel
def write_due_outputs(state, regime, step_state, work):
    """Write the outputs due at the present time, to the tolerance; return the StepState.

    state, regime, step_state: State, Regime and StepState at the present time; work: Workspace.
    """
    column = step_state.next_output
    while column < work.output_tau.size and work.output_tau[column] <= step_state.tau * (1.0 + work.options.rtol):
        _write_state(column, state, step_state.segment, regime, work)
        _write_totals(column, work)
        column += 1
    return StepState(step_state.tau, column, step_state.segment, step_state.n_steps, step_state.n_ended, 0.0)


@kernel(inline=True)
def _quadrature_at(n, v, step, nodes):
    """Return the increase of quadrature ``n`` from the left end of a step to v."""
    first = nodes[ROW_INTEGRANDS + ROW_LENGTH * n]
    return 0.5 * step.h * evaluate_integral(v, first, nodes, ROW_DENSE_QUADRATURES + ROW_LENGTH * n)


@kernel(inline=True)
def _evaluate_integrands(regime, work):
    """Store the integrands of the quadratures at all nodes of an accepted step.

    regime: Regime; work: Workspace with the unknowns at the nodes.
    Distance and angle are integrals over t, the energies over tau.
    """
    nodes, values = work.nodes, by_value(work)
    direction_over_gamma = regime.direction / values.scene.gamma
    for i in range(N + 1):
        load, V = load_at_node(i, regime, values), nodes[ROW_V + i]
        # inlined: the compiler leaves out the derivatives, half of the work of a right-hand side
        rates = evaluate_rhs_inline(V, nodes[ROW_OMEGA_OR_D + i], load, regime, values.scene)
        omega = rates.omega
        force, torque, brake = required_forces(V, omega, rates, load, regime, values.scene.j)
        integrands = (
            direction_over_gamma * V, direction_over_gamma * omega,
            (omega - V) * rates.Q, V * rates.M_half_space + omega * rates.M_cylinder,
            force * V, torque * omega, -brake * omega,
        )  # fmt: skip
        for n in range(N_QUADRATURES):
            nodes[ROW_INTEGRANDS + ROW_LENGTH * n + i] = integrands[n]


@kernel
def _integral_over_step(row, step, nodes):
    """Return the integral over tau of a row along a whole step."""
    total = 0.0
    for i in range(N):
        total += QUADRATURE_WEIGHTS[i] * nodes[row + i + 1]
    return 0.5 * step.h * total


@kernel(inline=True)
def accept_step(end, v, step, regime, step_state, work):
    """Accept a step up to the position v: write the outputs before its end and add up the quadratures.

    end: tau at v; step: Step; regime: Regime; step_state: StepState at its left end; work: Workspace with the solved
    step.
    Returns the StepState at ``end``.  An output at ``end`` itself is written with the next step, as the drive
    may jump there, but for the last one.
    """
    tau, column = work.output_tau, step_state.next_output
    is_last = end == last_output_tau(work)
    due = column < tau.size and (tau[column] < end or is_last)
    n_quadratures = N_FREE_QUADRATURES if step.undriven else N_QUADRATURES
    n_quadratures = n_quadratures if work.with_quadratures else 0
    if n_quadratures > 0:
        _evaluate_integrands(regime, work)
    if due or v < 2.0:
        for n in range(n_quadratures):
            fit_integral(ROW_INTEGRANDS + ROW_LENGTH * n, ROW_DENSE_QUADRATURES + ROW_LENGTH * n, work.nodes)
    while column < tau.size and (tau[column] < end or is_last):
        v_output = min(dense_position(tau[column], step), 2.0)
        _write_state(column, dense_state(v_output, work.nodes), step.segment, regime, work)
        for n in range(N_QUADRATURES if work.with_quadratures else 0):
            increase = _quadrature_at(n, v_output, step, work.nodes) if n < n_quadratures else 0.0
            write_quadrature(column, n, increase, work)
        column += 1
    if step_state.n_ended < work.step_ends.size:
        work.step_ends[step_state.n_ended] = end / work.scene.gamma
    for n in range(n_quadratures):
        if v < 2.0:
            work.nodes[QUADRATURE_TOTALS + n] += _quadrature_at(n, v, step, work.nodes)
        else:
            row = ROW_INTEGRANDS + ROW_LENGTH * n
            work.nodes[QUADRATURE_TOTALS + n] += _integral_over_step(row, step, work.nodes)
    return StepState(end, column, step_state.segment, step_state.n_steps, step_state.n_ended + 1, step_state.h)
