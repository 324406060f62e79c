"""Outputs of a motion: V, omega, delta and the regime; force and torque; quadratures (distance,
angle, energies).

Rows of the outputs, with their units (T_epsilon is the unit of time of the law):

- V 0 in R/T_epsilon, omega 1 in 1/T_epsilon, x 2 in R, angle 3 in rad;
- delta 4, dimensionless, and the code of the regime 5 (:mod:`.records`);
- force 6 in P, torque 7 in P R;
- work of the force 8 and of the torque 9, losses in the brake 10, in slip 11 and in rolling 12, in
  m (R/T_epsilon)^2.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

import numpy as np

from ..numerics.intrinsics import by_reference, by_value
from ..numerics.jit import inline_kernel, kernel
from ..records import (
    DIRECTION_REVERSED,
    N_FREE_QUADRATURES,
    N_QUADRATURES,
    REGIME_AT_REST,
    StepState,
)
from .collocation import (
    INTEGRAL_MATRIX,
    N_RECORDED,
    N_SWITCHES,
    QUADRATURE_TOTALS,
    QUADRATURE_WEIGHTS,
    ROW_DENSE_QUADRATURES,
    ROW_INTEGRANDS,
    ROW_LENGTH,
    ROW_OMEGA_OR_D,
    ROW_V,
    N,
    dense_position,
    dense_state,
    evaluate_dense_output,
    last_output_tau,
    multiply_matrix,
)
from .drive import evaluate_load, load_at_node
from .motion_law import omega_and_delta, slip_power
from .regimes import regime_code
from .rhs import evaluate_rhs, evaluate_rhs_inline, required_forces

#: Number of output quantities.
N_OUTPUTS = 13
#: Output row of x; that of the angle follows.
OUT_X = 2
#: Output row of the force; that of the torque follows.
OUT_FORCE = 6
#: Output row of the first energy; four others follow.
OUT_WORK = 8
#: Output row of each quadrature.
_OUT_QUADRATURES = np.array(
    [OUT_X, OUT_X + 1, OUT_WORK + 3, OUT_WORK + 4, OUT_WORK, OUT_WORK + 1, OUT_WORK + 2]
)


@kernel
def requested_groups(rows):
    """Return which groups of outputs are requested, as each costs time.

    rows: (k,) int, the requested output rows, numbered as in the module; it may be empty.
    Returns (quadratures, forces), two bools: whether a row of x, angle, works or losses is among
    them; whether force or torque is.
    """
    quadratures = forces = False
    # rows of quadratures are those of x and angle, and from OUT_WORK on; of forces those between
    for row in rows:
        quadratures = quadratures or OUT_X <= row < OUT_X + 2 or row >= OUT_WORK
        forces = forces or OUT_FORCE <= row < OUT_WORK
    return quadratures, forces


@kernel
def write_column(column, speeds, code, forces, work):
    """Write V, omega, delta, regime, force and torque to one output column, of a step, at rest or
    in closed form.

    column: int, index of the output time.
    speeds: (V, omega, delta), dimensionless; V and omega in fixed directions, not in those of the
    regime.
    code: int, regime in the outputs: FULL_SLIP 0, PARTIAL_SLIP 1, AT_REST 2, OMEGA_LOCKED 3 or
    HELD_AT_REST 4.
    forces: (force, torque), dimensionless, in fixed directions too.
    work: Workspace, of whose ``outputs`` rows 0, 1, 4, 5, 6 and 7 are written at ``column``.
    Returns nothing.
    """
    # rows 2 and 3, x and angle, and those from OUT_WORK on are quadratures, written elsewhere
    out = work.outputs
    (V, omega, delta) = speeds
    (force, torque) = forces
    out[0, column] = V
    out[1, column] = omega
    out[4, column] = delta
    out[5, column] = code
    out[OUT_FORCE, column] = force
    out[OUT_FORCE + 1, column] = torque


@kernel
def write_quadrature(column, n, increase, work):
    """Write one quadrature to one output column: its total up to the last accepted step plus an
    increase.

    column: int, index of the output time.
    n: int, the quadrature: 0 distance x, 1 angle, 2 loss in slip, 3 loss in rolling, 4 work of the
    force, 5 work of the torque, 6 loss in the brake; they are written to rows 2, 3, 11, 12, 8, 9
    and 10 of the outputs.
    increase: float, since the last accepted step, dimensionless.
    work: Workspace, with the totals; one number of its ``outputs`` is written.  Returns nothing.
    """
    work.outputs[_OUT_QUADRATURES[n], column] = work.nodes[QUADRATURE_TOTALS + n] + increase


@kernel
def _write_totals(column, work):
    """Write the totals of all quadratures to one output column, as at rest and at the end of the
    last accepted step.

    column: int, its index.
    work: Workspace, with these totals; rows 2, 3 and 8 ... 12 of its ``outputs`` are written.
    Returns nothing.
    """
    for n in range(N_QUADRATURES):
        write_quadrature(column, n, 0.0, work)


@kernel
def record_switch(code, step_state, work):
    """Record a change of regime, or of the sign of V, at the time reached.

    code: int, regime after it in the outputs (:mod:`.records`), or DIRECTION_REVERSED.
    step_state: StepState, with that time.
    work: Workspace: t = tau/gamma and ``code`` are written to the next row of ``switches`` if it
    has one.  The number of entries, N_RECORDED in ``nodes``, grows by 1 in any case; the number of
    regime changes, N_SWITCHES, grows by 1 unless the code is DIRECTION_REVERSED.  Returns nothing.
    """
    nodes = work.nodes
    switches = work.switches
    n = np.int64(nodes[N_RECORDED])  # a count that is stored as a double, beside the other numbers
    if n < switches.shape[0]:
        switches[n, 0] = step_state.tau / work.scene.gamma
        switches[n, 1] = code
    nodes[N_RECORDED] += 1.0
    nodes[N_SWITCHES] += 0.0 if code == DIRECTION_REVERSED else 1.0


@kernel
def write_outputs_at_rest(end, inclusive, code, step_state, work):
    """Write the outputs of a cylinder at rest up to a time: V, omega and delta are 0, quadratures
    keep their totals.

    Force and torque, requested or not, are those of the drive at the outputs, not those that hold a
    prescribed speed.

    end: float, that time in tau, not before the present one.
    inclusive: bool, whether an output at ``end`` itself is written too.
    code: int, regime in the outputs, AT_REST or HELD_AT_REST.
    step_state: StepState, at the present time; its segment is that of all these outputs.
    work: Workspace, of the motion; all rows of its outputs are written, at the columns from
    ``next_output`` on.
    Returns the StepState at ``end``, with ``next_output`` after these outputs, one trial step more
    and the length of the next step not chosen (0); the segment and the number of accepted steps
    stay.
    """
    column = step_state.next_output
    tau = work.output_tau
    while column < tau.size and (tau[column] < end or (inclusive and tau[column] == end)):
        # direction 1 of REGIME_AT_REST: forces in fixed directions
        load = evaluate_load(tau[column], step_state.segment, REGIME_AT_REST, work)
        write_column(column, (0.0, 0.0, 0.0), code, (load.force, load.torque), work)
        _write_totals(column, work)
        column += 1
    return StepState(
        tau=end,
        next_output=column,
        segment=step_state.segment,
        n_steps=step_state.n_steps + 1,
        n_accepted=step_state.n_accepted,
        h=0.0,
    )


@kernel
def _write_state(column, state, segment, regime, work):
    """Write speeds, regime and forces at one output time; the quadratures are written elsewhere.

    Force and torque are those that act (:func:`required_forces`) if a force or torque is requested,
    else 0.

    column: int, index of the output time.
    state: State, at that time, in the direction of the regime; it is written in fixed directions.
    segment: int, index of the segment of the drive at that time.
    regime: Regime, at that time; all fields are read.
    work: Workspace, of the motion; rows 0, 1, 4, 5, 6 and 7 of its outputs are written at
    ``column``.  Returns nothing.
    """
    direction = regime.direction
    force = 0.0
    torque = 0.0
    omega, delta = omega_and_delta(state, regime, work.scene)
    if work.with_forces:  # An evaluation of the right-hand side, which is left out otherwise.
        load = evaluate_load(work.output_tau[column], segment, regime, work)
        rates = evaluate_rhs(state, load, regime, work.scene)
        force, torque, _ = required_forces(state.V, omega, rates, load, regime, work.scene.j)
    speeds = (direction * state.V, direction * omega, delta)
    forces = (direction * force, direction * torque)
    write_column(column, speeds, regime_code(regime), forces, work)


@kernel
def write_due_outputs(state, regime, step_state, work):
    """Write the outputs at times up to (1 + rtol) times the time reached, by the state reached.

    They are those at the end of the last step, which :func:`accept_step` leaves to the next one.
    The factor matters where the added mass ends the motion early: it takes in an output that this
    end misses by no more than rtol.  The quadratures keep their totals.

    state: State, at the time reached.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with that time, its segment and the next output.
    work: Workspace, of the motion; all rows of its outputs are written at these times, if there are
    any.
    Returns the StepState with ``next_output`` after these outputs and h = 0, which means that the
    length of the next step is not chosen, also where none was due; all else stays.
    """
    column = step_state.next_output
    while column < work.output_tau.size and work.output_tau[column] <= step_state.tau * (
        1.0 + work.options.rtol
    ):
        _write_state(column, state, step_state.segment, regime, work)
        _write_totals(column, work)
        column += 1
    return StepState(
        tau=step_state.tau,
        next_output=column,
        segment=step_state.segment,
        n_steps=step_state.n_steps,
        n_accepted=step_state.n_accepted,
        h=0.0,
    )


@inline_kernel
def _quadrature_at(n, v, step, nodes):
    """Return the increase of a quadrature from the left end of a step to a position, a float,
    dimensionless; accurate relative to itself as v -> 0.

    With t in [-1, 1] on the step and v = 1 + t the integral over t from the left end is

        v (value at node 0 + v (c_0 + c_1 t + ... + c_(N-1) t^(N-1)))

    n: int, index of the quadrature, as of :func:`write_quadrature`.
    v: float, position in [0, 2]; at 0 the result is 0.
    step: Step, the accepted one, whose length is read.
    nodes: Workspace.nodes, with the integrand at node 0 and the coefficients c of its integral, the
    product of INTEGRAL_MATRIX and the integrand.
    """
    first = nodes[ROW_INTEGRANDS + ROW_LENGTH * n]
    inner = evaluate_dense_output(v, nodes, ROW_DENSE_QUADRATURES + ROW_LENGTH * n)
    return 0.5 * step.h * (v * (first + inner))


@inline_kernel
def _evaluate_integrands(regime, work):
    """Store the integrands of the quadratures at all nodes of an accepted step
    (docs/theory_motion.md, Energy).

    In the order of :func:`write_quadrature`, with the traction Q, the moments and the forces that
    act (:func:`required_forces`): V/gamma and omega/gamma in fixed directions; (omega - V) Q; V
    M_half_space + omega M_cylinder, both of a cover as of :func:`.motion_law.slip_power`; force V;
    torque omega; -(torque of the brake) omega.  All are integrated over tau: distance and angle
    thus become integrals over t.

    regime: Regime, that of the step; all fields are read.
    work: Workspace, with unknowns and drive at nodes 0 ... N; there N_QUADRATURES rows from
    ROW_INTEGRANDS on are written, also those that are 0 as nothing drives.  Returns nothing.
    """
    nodes = work.nodes
    # a copy, as LLVM would read ``work`` itself again after each number that is stored
    values = by_reference(by_value(work))
    direction_over_gamma = regime.direction / values.scene.gamma
    for i in range(N + 1):
        load = load_at_node(i, regime, values)
        V = nodes[ROW_V + i]
        # The right-hand side is inlined: the compiler leaves out its derivatives, half of the work.
        rates = evaluate_rhs_inline(V, nodes[ROW_OMEGA_OR_D + i], load, regime, values.scene)
        omega = rates.omega
        force, torque, brake = required_forces(V, omega, rates, load, regime, values.scene.j)
        slip, rolling = slip_power(
            V, omega, rates.Q, rates.M_half_space, rates.M_cylinder, values.scene
        )
        integrands = (
            direction_over_gamma * V,
            direction_over_gamma * omega,
            slip,
            rolling,
            force * V,
            torque * omega,
            -brake * omega,
        )
        for n in range(N_QUADRATURES):
            nodes[ROW_INTEGRANDS + ROW_LENGTH * n + i] = integrands[n]


@kernel
def accept_step(end, v, step, regime, step_state, work):
    """Accept a step up to a position on it: write the outputs before its end and add up the
    quadratures.

    An output at the end itself is written with the next step, as the drive may jump there.  If the
    end is the last output time, all outputs that are left are written now.

    Quadratures are evaluated only if one is requested.  If nothing drives they are distance, angle
    and the losses in slip and in rolling; works and the loss in the brake keep their totals.

    end: float, tau at that position.
    v: float, the position in [0, 2]; 2: the whole step.
    step: Step, the solved one; ``tau``, ``h``, ``segment`` and ``undriven`` are read.
    regime: Regime, that of the step; all fields are read.
    step_state: StepState, at its left end.
    work: Workspace, with the solution and its dense output; outputs, totals, integrands, the
    coefficients of their integrals and the next entry of ``step_ends``, t = ``end``/gamma, if it
    has one, are written.
    Returns the StepState at ``end``, with ``next_output`` after the outputs written and one
    accepted step more; the number of trial steps, the segment and the length of the next step stay.
    """
    tau = work.output_tau
    nodes = work.nodes
    column = step_state.next_output
    is_last = end == last_output_tau(work)
    # Whether an output is written now; only then, or at an end inside the step, are integrals
    # needed at a position: the coefficients of their interpolants are fitted.
    due = column < tau.size and (tau[column] < end or is_last)
    n_quadratures = N_FREE_QUADRATURES if step.undriven else N_QUADRATURES
    n_quadratures = n_quadratures if work.with_quadratures else 0
    if n_quadratures > 0:
        _evaluate_integrands(regime, work)
    if due or v < 2.0:
        for n in range(n_quadratures):
            row = ROW_INTEGRANDS + ROW_LENGTH * n
            dense = ROW_DENSE_QUADRATURES + ROW_LENGTH * n
            multiply_matrix(INTEGRAL_MATRIX, row, nodes[row], nodes, dense, nodes)
    while column < tau.size and (tau[column] < end or is_last):
        v_output = min(dense_position(tau[column], step), 2.0)  # 2 may be passed by rounding.
        _write_state(column, dense_state(v_output, nodes), step.segment, regime, work)
        # those that are not computed, as nothing drives, keep their totals
        for n in range(N_QUADRATURES if work.with_quadratures else 0):
            increase = _quadrature_at(n, v_output, step, nodes) if n < n_quadratures else 0.0
            write_quadrature(column, n, increase, work)
        column += 1
    if step_state.n_accepted < work.step_ends.size:
        work.step_ends[step_state.n_accepted] = end / work.scene.gamma
    # up to v by the interpolant; along the whole step by Radau's rule, which is of higher order
    for n in range(n_quadratures):
        if v < 2.0:
            nodes[QUADRATURE_TOTALS + n] += _quadrature_at(n, v, step, nodes)
        else:  # Radau quadrature of a whole step, which needs no interpolant.
            total = 0.0
            for i in range(N):
                total += QUADRATURE_WEIGHTS[i] * nodes[ROW_INTEGRANDS + ROW_LENGTH * n + i + 1]
            nodes[QUADRATURE_TOTALS + n] += 0.5 * step.h * total
    return StepState(
        tau=end,
        next_output=column,
        segment=step_state.segment,
        n_steps=step_state.n_steps,
        n_accepted=step_state.n_accepted + 1,
        h=step_state.h,
    )
