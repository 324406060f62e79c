"""Regimes: the regime of a start, and the one that follows an event or begins with a segment of the
drive.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- tau: time gamma t.
- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- StepState: progress of the integration: tau reached, index of the next output, segment, numbers of
  steps, length of the next step.
- Drive: force, torque, brake and prescribed speed, polynomials of tau on each segment; gains of the
  feedback.
- Event: int, its code, which is also the index in ``nodes`` of the row with the values of its
  function: STICK_EDGE, DELTA_ZERO, V_ZERO, OMEGA_ZERO, BELOW_REST_SPEED or BRAKE_RELEASE
  (:mod:`collocation`).
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

import numpy as np

from ..law.cover_law import creep_of, reduced_creep
from ..numerics.intrinsics import by_value
from ..numerics.jit import kernel
from ..records import (
    AT_REST,
    FULL_SLIP,
    HELD_AT_REST,
    NOT_PRESCRIBED,
    OMEGA_LOCKED,
    PARTIAL_SLIP,
    PRESCRIBED_OMEGA,
    Regime,
    State,
)
from .collocation import DELTA_ZERO, OMEGA_ZERO, ROW_V, STICK_EDGE, V_ZERO, change_slip, row_range
from .drive import current_load, has_brake, is_undriven, prescribed_speed
from .motion_law import (
    asymmetry_at_speed,
    critical_creepage,
    excess_slip,
    pull_at_rest,
    reduced_slip,
    rest_limits,
)
from .rhs import applied_forces, current_rates

#: V at the event divided by V at the left end of the step, below which V is 0, as rounding leaves
#: it: the stick zone closes at rest.
_STICK_ZONE_CLOSED = 1e-14
#: omega/V in partial slip above which V follows a prescribed omega at fixed d; below it, under
#: strong friction, V stays.
_OMEGA_FOLLOWED = 0.5
#: Error of V at an event divided by rtol times the largest V of the step: with omega = 0, slip ends
#: at V = 0 within it.
_EVENT_ERROR = 10.0
#: V divided by the larger speed, below which it counts as 0 at the start: its square is near the
#: smallest double.
ZERO_V_RATIO = 1e-150
#: Distance of a start from the edge of the stick zone, relative to the speeds, that is rounding:
#: about a hundred units.
_START_ON_EDGE = 2e-14
#: Rule of Gauss and Legendre on [0, 1]: places and weights of four points, exact to degree 7.
_GAUSS = (
    (0.06943184420297371, 0.17392742256872679),
    (0.33000947820757187, 0.3260725774312732),
    (0.6699905217924281, 0.3260725774312732),
    (0.9305681557970262, 0.17392742256872679),
)


@kernel
def change_brake(regime, spin_sign, locked):
    """Return the Regime with another state of its brake; full_slip, direction and sigma stay.

    regime: Regime, the present one.
    spin_sign: float, 1 or -1, sign of omega where a brake acts, or of the torque where omega is 0;
    0 where none acts.
    locked: bool, whether the brake holds omega at 0; spin_sign has no effect on the rates then.
    """
    return Regime(
        full_slip=regime.full_slip,
        direction=regime.direction,
        sigma=regime.sigma,
        spin_sign=spin_sign,
        locked=locked,
    )


@kernel
def brake_at_zero_omega(may_hold, state, regime, step_state, work):
    """Return the Regime at omega = 0 in which the brake holds omega, or lets it go.

    The torque that would accelerate the cylinder at omega = 0 is that of the motor with its
    feedback, less Q and M_cylinder; in partial slip M_cylinder contains n V'/2 of the added mass,
    with V' of ``regime``.  The brake can hold omega if the modulus of this torque is at most the
    largest torque of the brake; without a brake, only if it is exactly 0.

    may_hold: bool, whether the brake may hold omega; False: it lets go in any case.
    state: State, with omega = 0.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with the time and its segment.
    work: Workspace, of which Scene and Drive are read.
    Returns ``regime`` with another state of its brake: ``locked`` True where the brake holds omega;
    else False, with the sign of the torque as ``spin_sign`` (1, -1, or 0 for no torque) where the
    segment has a brake anywhere on it, and with 0 where it has none.
    """
    load = current_load(regime, step_state, work)
    rates = current_rates(state, regime, step_state, work)
    torque = applied_forces(state.V, 0.0, load, regime)[1] - rates.Q - rates.M_cylinder
    # equal torques hold: without a brake, whose limit is 0, a torque of exactly 0 does
    if may_hold and abs(torque) <= load.brake:
        return change_brake(regime, regime.spin_sign, True)
    spin_sign = np.sign(torque) if has_brake(step_state.segment, work.drive) else 0.0
    return change_brake(regime, spin_sign, False)


@kernel
def reverse_direction(regime):
    """Return the Regime with the opposite direction, in which the signs of slip and omega are
    opposite too.

    ``direction``, ``sigma`` and ``spin_sign`` change their signs, ``full_slip`` and ``locked``
    stay.  The caller changes the signs of V and omega; d of partial slip would keep its sign, but
    only full slip is reversed.

    regime: Regime, the present one, of full slip.
    """
    return Regime(
        full_slip=regime.full_slip,
        direction=-regime.direction,
        sigma=-regime.sigma,
        spin_sign=-regime.spin_sign,
        locked=regime.locked,
    )


@kernel
def impose_prescribed_speed(state, regime, step_state, work):
    """Return state and regime with the prescribed speed at its given value, where a segment begins
    or the stick zone forms.

    The error of the integration so far is small relative to the speeds so far, but may be large
    relative to the speed prescribed from here on.  With s the prescribed speed in the direction of
    the regime:

    - no speed prescribed: both are returned unchanged;
    - omega in full slip: omega becomes s;
    - omega in partial slip: V is multiplied by max(s/omega, 0) at fixed d; both are unchanged where
      omega is at most V/2, as under strong friction omega may be far below V;
    - V in full slip: V becomes s; where s < 0, V becomes -s, omega changes its sign, and the
      direction is reversed;
    - V in partial slip: V becomes max(s, 0) at fixed d.

    state: State, as integrated, with V >= 0.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with the time and its segment, whose prescribed speed is taken.
    work: Workspace, of which Scene and Drive are read.
    Returns (State, Regime), with V >= 0; ``locked`` and, but for a reversal, all of the Regime
    stay.
    """
    drive = work.drive
    full_slip = regime.full_slip
    if drive.prescribed == NOT_PRESCRIBED:
        return state, regime
    speed = regime.direction * prescribed_speed(step_state.tau, step_state.segment, drive)
    if drive.prescribed == PRESCRIBED_OMEGA and full_slip:
        return State(state.V, speed), regime
    if drive.prescribed == PRESCRIBED_OMEGA:
        omega = current_rates(state, regime, step_state, work).omega
        # At fixed d omega is nearly proportional to V, unless it is far below V.
        factor = max(speed / omega, 0.0) if omega > _OMEGA_FOLLOWED * state.V else 1.0
        return State(state.V * factor, state.omega_or_d), regime
    if full_slip and speed < 0.0:  # V has to be >= 0 in the direction of the regime
        return State(-speed, -state.omega_or_d), reverse_direction(regime)
    return State(speed if full_slip else max(speed, 0.0), state.omega_or_d), regime


@kernel
def apply_event(event, state, regime, step_state, work):
    """Return state and regime after an event, in the unknowns of the new regime.

    - STICK_EDGE in full slip: the cylinder comes to rest if V is 0, so that omega is 0 too, or
      partial slip begins with d = sigma; a prescribed omega is then imposed
      (:func:`impose_prescribed_speed`) where V changes at least as fast as omega.  V counts as 0 up
      to 1e-14 times V at the left end of the step, as rounding leaves it.  Where omega is 0, as the
      brake holds it or it is prescribed to be 0 at this time, V counts as 0 up to max(1e-14, 10
      rtol) times the largest V at the nodes of the step, as the event is located with the error of
      the step.
    - STICK_EDGE in partial slip: full slip begins with the same sigma and with the omega of the
      state.
    - DELTA_ZERO: sigma changes its sign, d stays.
    - V_ZERO: the cylinder comes to rest in partial slip, or if omega is 0; else V becomes exactly
      0, omega changes its sign, and the direction is reversed.
    - OMEGA_ZERO: omega is set to 0 in full slip, V and d stay in partial slip; then the brake holds
      omega, ``locked`` is True, or ``spin_sign`` becomes the sign of the torque that accelerates it
      (:func:`brake_at_zero_omega`).
    - BRAKE_RELEASE: the brake lets go, :func:`brake_at_zero_omega`.

    BELOW_REST_SPEED does not occur here: it ends the motion.

    event: int, its code, STICK_EDGE ... BRAKE_RELEASE of :mod:`collocation`.
    state: State, at the event.
    regime: Regime, the one that ends; all fields are read.
    step_state: StepState, at the event.
    work: Workspace, with V at the nodes of the step that ends there; Scene, Drive and rtol are read
    too.
    Returns (whether the cylinder moves, State, Regime): it does not move where it comes to rest, or
    where V is 0 in the partial slip that begins; where it comes to rest State and Regime are those
    that were passed.
    """
    full_slip = regime.full_slip
    sigma = regime.sigma
    if event == STICK_EDGE and full_slip:
        least = _STICK_ZONE_CLOSED * work.nodes[ROW_V]
        # An omega prescribed to be 0 at this time acts like a brake that holds it.
        if regime.locked or (
            work.drive.prescribed == PRESCRIBED_OMEGA
            and prescribed_speed(step_state.tau, step_state.segment, work.drive) == 0.0
        ):
            # With omega = 0 slip ends at V = 0, to the tolerance of the step.
            least = max(_STICK_ZONE_CLOSED, _EVENT_ERROR * work.options.rtol)
            least *= row_range(ROW_V, work.nodes)[1]
        if state.V <= least:
            return False, state, regime
        rates = current_rates(state, regime, step_state, work)
        state = State(state.V, sigma)
        regime = change_slip(regime, False, sigma)
        if work.drive.prescribed == PRESCRIBED_OMEGA and abs(rates.V_rate) >= abs(
            rates.weighted_rate
        ):
            # The time of the event has an error, so that the speed that changes more slowly is more
            # accurate.
            state, regime = impose_prescribed_speed(state, regime, step_state, work)
        return state.V > 0.0, state, regime
    if event == STICK_EDGE:
        omega = current_rates(state, regime, step_state, work).omega
        return True, State(state.V, omega), change_slip(regime, True, sigma)
    if event == DELTA_ZERO:
        return True, state, change_slip(regime, False, -sigma)
    if event == V_ZERO:
        # In partial slip omega = V (1 + delta) is 0 too: what follows is a departure from rest.
        if not full_slip or state.omega_or_d == 0.0:
            return False, state, regime
        return True, State(0.0, -state.omega_or_d), reverse_direction(regime)
    if event == OMEGA_ZERO and full_slip:
        # exactly 0, which the located event is to rounding; in partial slip omega is no unknown
        state = State(state.V, 0.0)
    may_hold = event == OMEGA_ZERO  # else BRAKE_RELEASE
    return True, state, brake_at_zero_omega(may_hold, state, regime, step_state, work)


@kernel
def enter_segment(state, regime, step_state, work):
    """Return state and regime at the start of a segment of the drive, where a brake may take hold
    or let go and V may reverse.

    In this order: a prescribed speed is imposed (:func:`impose_prescribed_speed`), except at the
    start of the motion, whose given speeds stay; full slip at V = 0 with V' < 0 gets the opposite
    direction, so that V grows in it; the state of the brake is set.  On a segment with a brake it
    holds omega if omega is 0 and the brake is strong enough; else it acts against the sign of omega
    or, where omega is 0, against the torque that accelerates the cylinder.  On a segment without a
    brake ``spin_sign`` is 0 and ``locked`` False.

    state: State, at the end of the segment before, or the start of the motion.
    regime: Regime, at that state; all fields are read.
    step_state: StepState, with the time and the index of the new segment.
    work: Workspace, of which Scene and Drive are read.
    Returns (State, Regime): V is at least 0; where the brake takes hold, ``locked`` is True and
    ``spin_sign`` stays.
    """
    if step_state.segment > 0:  # A start keeps its given speeds.
        state, regime = impose_prescribed_speed(state, regime, step_state, work)
    # V would fall below 0 at once: in the opposite direction it grows, as a regime has V >= 0
    if (
        regime.full_slip
        and state.V == 0.0
        and current_rates(state, regime, step_state, work).V_rate < 0.0
    ):
        state = State(0.0, -state.omega_or_d)
        regime = reverse_direction(regime)
    braked = has_brake(step_state.segment, work.drive)
    omega = current_rates(state, regime, step_state, work).omega
    # a locked omega is 0 but for rounding in partial slip, where it follows from V and d
    if regime.locked or omega == 0.0:
        return state, brake_at_zero_omega(braked, state, regime, step_state, work)
    return state, change_brake(regime, np.sign(omega) if braked else 0.0, False)


@kernel
def speeds_after_sliding(V, omega, scene):
    """Return V and omega of the free rolling in which undriven sliding at the least speeds ends,
    dimensionless.

    It ends within a time of the order of the speeds, in which nothing but the traction acts: a Q on
    the axis and b Q on the cylinder, functions of d (:func:`pull_at_rest`), Q and Q of half-spaces.
    In full slip, |d| = 1, V b + j omega a is constant.  From |d| = 1 to 0, d(ln V)/dy = -a/(b/j + a
    y) with y = omega/V, a function of d, which has the rule of Gauss with four points.

    V, omega : floats, of either sign, not both 0.
    scene : Scene, of which ``law``, kappa, mu and j are read; of a table one with
        :func:`.table_law.sticks_at_rest`.
    """
    law = by_value(scene.law)
    free = 1.0 + rest_limits(scene, 1.0)[1]  # omega/V of free rolling
    j = scene.j
    if law.cover_rows is None and law.table is None:
        V = (V + j * omega) / (1.0 + j * free)
        return V, V * free
    c = asymmetry_at_speed(0.0, scene)
    # Sign of the creepage less delta_0; a product of the two least speeds would underflow to 0.
    side = 1.0 if (omega >= free * V) == (V >= 0.0) else -1.0
    # |delta - delta_0| at d = side without c d^2
    limit = 0.5 * rest_limits(scene, side)[0] * scene.mu / scene.kappa
    left = np.inf  # |d| at which the integral over d begins; above 1 in full slip
    if V != 0.0:
        left = abs(reduced_creep(side * abs(omega - free * V) / (limit * abs(V)), c))
    if left == 0.0:
        return V, omega
    if left > 1.0:  # Full slip: V b + j omega a is kept until omega/V is that of |d| = 1.
        left = 1.0
        on_axis, on_spin, _, _ = pull_at_rest(side, scene)
        # what is kept, with the signs of Q on the axis and on the cylinder, which are those of
        # ``side`` in pull_at_rest
        kept = side * (V * on_spin + j * omega * on_axis)
        # the side in the end: ``kept`` has the sign of V there, omega - free V keeps its own
        turned = 1.0 if (omega >= free * V) == (kept >= 0.0) else -1.0
        # V passes through 0, from where on a and b are those of the other side.  There j omega a is
        # all of what is kept: it changes with a, as omega stays.
        if turned != side:
            kept /= abs(on_axis)
            on_axis, on_spin, _, _ = pull_at_rest(turned, scene)
            kept *= abs(on_axis)
            side = turned
            limit = 0.5 * rest_limits(scene, side)[0] * scene.mu / scene.kappa
        # V b + j omega a with omega/V at |d| = 1, where d + c d^2 = side + c
        V = kept / (abs(on_spin) + j * abs(on_axis) * (free + limit * (side + c)))
    for place, weight in _GAUSS:
        d = side * left * place
        on_axis, on_spin, _, _ = pull_at_rest(d, scene)
        creep = creep_of(d, c, law.cover_rows)
        y = free + limit * creep.value
        dy = side * limit * creep.slope  # slope of y over |d|
        # |d| falls from ``left`` to 0, which turns the sign of -a/(b/j + a y).
        V *= np.exp(left * weight * dy * on_axis / (on_spin / j + on_axis * y))
    return V, V * free


@kernel
def initial_regime(V, omega, step_state, work):
    """Return state and regime at the start of a motion from V or omega other than 0; a brake is
    considered later.

    It is partial slip where the excess slip (:func:`.motion_law.excess_slip`; omega - V for
    half-spaces) is below delta_star |V| in modulus, Eq. (9), full slip where it is above.  Where
    both differ by rounding, up to 2e-14 of the larger speed, it is partial slip with d = +-1 if |d|
    would fall from there, else full slip.  From V = 0 it is full slip.

    If nothing drives and both speeds are below 1e-150, they are replaced first by those of the free
    rolling in which sliding ends (:func:`speeds_after_sliding`).

    V, omega: float, initial speeds of either sign, dimensionless.
    step_state: StepState, at the start.
    work: Workspace, of which Scene and Drive are read.
    Returns (State, Regime, stick_formed): the State in the direction of the Regime, which is that
    of V, or of omega where V is 0, with omega in full slip and d in partial slip; the Regime with
    the sign of the excess slip as ``sigma`` (1 for 0) and without a brake; ``stick_formed``, a
    bool, True only for a start in partial slip with d = +-1.
    """
    if is_undriven(0, work.drive) and max(abs(V), abs(omega)) < ZERO_V_RATIO:
        V, omega = speeds_after_sliding(V, omega, work.scene)
    direction = 1.0 if V > 0.0 or (V == 0.0 and omega >= 0.0) else -1.0
    V = direction * V
    omega = direction * omega
    slip = excess_slip(omega - V, V, work.scene)
    sigma = 1.0 if slip >= 0.0 else -1.0
    limit = critical_creepage(V, sigma, work.scene) * V  # excess slip at which full slip begins
    state = State(V, omega)
    regime = Regime(full_slip=True, direction=direction, sigma=sigma, spin_sign=0.0, locked=False)
    if V == 0.0:  # the creepage is infinite
        return state, regime, False
    on_edge = abs(abs(slip) - limit) <= _START_ON_EDGE * max(V, abs(omega))
    stick_state = State(V, sigma if on_edge else reduced_slip(slip, limit, V, sigma, work.scene))
    stick_regime = change_slip(regime, False, sigma)
    if on_edge:  # The stick zone grows if |d| falls: the sign of V d' decides.
        on_edge = (
            sigma * current_rates(stick_state, stick_regime, step_state, work).weighted_rate < 0.0
        )
    elif abs(slip) < limit:
        return stick_state, stick_regime, False
    return (stick_state, stick_regime, True) if on_edge else (state, regime, False)


@kernel
def regime_code(regime):
    """Return the code of a moving cylinder's regime in the outputs, an int.

    It is OMEGA_LOCKED (3), FULL_SLIP (0) or PARTIAL_SLIP (1); :func:`rest_code` gives that of a
    cylinder at rest.

    regime: Regime, the present one; ``locked`` comes first, then ``full_slip``.
    """
    return OMEGA_LOCKED if regime.locked else FULL_SLIP if regime.full_slip else PARTIAL_SLIP


@kernel
def rest_code(step_state, work):
    """Return the code of V = omega = 0 in the outputs, an int.

    It is HELD_AT_REST (4) if the segment has a brake anywhere on it, or if a speed is prescribed in
    the motion; else AT_REST (2).

    step_state: StepState, of which the segment is read.
    work: Workspace, of which the Drive is read.
    """
    braked = has_brake(step_state.segment, work.drive)
    return HELD_AT_REST if braked or work.drive.prescribed != NOT_PRESCRIBED else AT_REST
