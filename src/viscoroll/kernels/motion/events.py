"""Events: their functions, whose zeros end a regime, and their location on the dense output of a
step.

Terms of this file, dimensionless (fields of the records in :mod:`.records`):

- State: V, the speed of the axis, and ``omega_or_d``, the second unknown: omega in full slip, d =
  delta/delta_star in partial slip; both in the direction of the Regime, in which V is at least 0.
- Regime: full or partial slip; direction of V, 1 or -1; sigma, the sign of the slip; sign of omega
  under a brake; whether the brake holds omega at 0.
- Step: one collocation step: tau at its left end, its length h in tau, its segment of the drive.
- v: position on a step, 0 at its left end and 2 at its right end.
- Event: int, its code, which is also the index in ``nodes`` of the row with the values of its
  function: STICK_EDGE, DELTA_ZERO, V_ZERO, OMEGA_ZERO, BELOW_REST_SPEED or BRAKE_RELEASE
  (:mod:`collocation`).
- Workspace: Scene, Drive and options of one motion, its output arrays, and ``nodes``: row ROW_X
  holds x at node i of a step in ``nodes[ROW_X + i]``; node 0 is the left end, nodes 1 ... N are the
  Radau nodes.
"""

from ..numerics.intrinsics import by_reference, by_value
from ..numerics.jit import inline_kernel, kernel
from ..records import DRIVE_BRAKE, PRESCRIBED_V, State
from .collocation import (
    BELOW_REST_SPEED,
    BRAKE_RELEASE,
    DELTA_ZERO,
    NO_EVENT,
    NODES,
    OMEGA_ZERO,
    ROW_DENSE_EVENT,
    ROW_DRIVE,
    ROW_LENGTH,
    ROW_OMEGA_OR_D,
    ROW_SPEED,
    ROW_V,
    STICK_EDGE,
    V_ZERO,
    N,
    dense_state,
    evaluate_dense_output,
    fit_dense_output,
    row_range,
)
from .drive import load_at_node
from .motion_law import creepage, omega_and_delta, stick_edge_function
from .rhs import evaluate_rhs, required_forces

#: A step ends at an event where the function of the event is below this times rtol, relative to the
#: scale of the function: a hundredth of the tolerance.
_EVENT_TOLERANCE = 1e-2
#: Smallest such tolerance that rounding allows, relative to the scale of the function: some units
#: of rounding.
_EVENT_ROUNDING = 4e-15
#: Largest number of evaluations of an interpolant in search of its zero: 8 to 10 are usual.
_ZERO_SEARCH_STEPS = 60
#: Width in v of a bracket that is a zero to rounding.
_ZERO_WIDTH = 1e-15
#: Number of steps of the ternary search for the minimum of an interpolant: 40 leave 1e-7 of the
#: interval, at which the value differs from the minimum by 1e-14 of its variation.
_TERNARY_STEPS = 40
#: Value of an event function at the left end of a step, divided by its largest value on the step,
#: up to which it counts as 0: the step begins on the event.
_START_ROUNDING = 1e-14
#: Rounding error of the function of the stick edge, relative to the speeds of which it is the
#: difference: without it steps under slight friction could not end.
_EDGE_ROUNDING = 1e-13
#: Position v up to which an interpolant is extrapolated beyond the step in search of a zero: half a
#: step beyond its end.
EXTRAPOLATION_END = 3.0
#: Position v from which on no zero was found on the extrapolation, whose search then ends at 3.
NOT_FOUND = 2.99
#: Offset in v of the difference quotient by which a zero is refined; the function itself is
#: evaluated there, as it is no polynomial of the unknowns.
_SECANT_OFFSET = 1e-3
#: Number of refinements with the same difference quotient, which converge linearly.
_SECANT_STEPS = 5
#: Largest correction of v in a refinement; a larger one ends the refinement.
_MAX_SECANT_MOVE = 0.1
#: |d| up to which either branch of the law serves, as they differ by d^2: the branch ends this far
#: beyond d = 0.  Without it rounding makes endless events on the slow manifold, where d falls like
#: V.
BRANCH_OVERLAP = 1e-8
#: The same of a table, whose branches have different slopes, by the errors of its splines: they
#: change the rate of free decay by up to 2e-3, and |d| falls below 1e-8 where V does.
TABLE_BRANCH_OVERLAP = 1e-14


@inline_kernel
def is_event_active(event, step, regime, work):
    """Return whether an event may end the regime on a step, a bool.

    STICK_EDGE and V_ZERO may always; DELTA_ZERO in partial slip; OMEGA_ZERO where a brake acts
    against omega; BRAKE_RELEASE where the brake holds omega at 0; BELOW_REST_SPEED where nothing
    drives and a rest threshold above 0 is given.

    event: int, code of the event.
    step: Step, the trial step; ``undriven`` is read.
    regime: Regime, that of the step; ``full_slip``, ``spin_sign`` and ``locked`` are read.
    work: Workspace, of the motion; the rest threshold in ``options`` is read.
    """
    if event == DELTA_ZERO:
        return not regime.full_slip
    if event == OMEGA_ZERO:
        return regime.spin_sign != 0.0 and not regime.locked
    if event == BRAKE_RELEASE:
        return regime.locked
    return event != BELOW_REST_SPEED or (step.undriven and work.options.rest_speed > 0.0)


@inline_kernel
def evaluate_event_functions(step, regime, work):
    """Store the event functions at nodes 0 ... N of a solved step: positive within the regime, 0 at
    its end.

    - V_ZERO: V.
    - STICK_EDGE: :func:`stick_edge_function`.
    - DELTA_ZERO: sigma d + 1e-8, of a table + 1e-14, in partial slip only.
    - OMEGA_ZERO: spin_sign omega in full slip; spin_sign (1 + delta) in partial slip, where omega =
      V (1 + delta) is 0 at V = 0 too, which is another event; spin_sign where V is not above 0
      there.
    - BELOW_REST_SPEED: the larger of |V| and |omega| less the rest threshold.
    - BRAKE_RELEASE: square of the brake's largest torque less square of the torque that holds omega
      at 0, if it is held.

    A row whose event is not active (:func:`is_event_active`) may keep the values of an earlier
    step.

    step: Step, the solved one; ``undriven`` is read.
    regime: Regime, that of the step; all fields are read.
    work: Workspace, with the unknowns and the drive at the nodes; rows STICK_EDGE ... BRAKE_RELEASE
    are written as above.  The values are dimensionless: speeds for V_ZERO and BELOW_REST_SPEED, in
    full slip also for STICK_EDGE and OMEGA_ZERO; a squared torque for BRAKE_RELEASE; ratios for all
    others.  Returns nothing.
    """
    nodes = work.nodes
    # a copy, as LLVM would read ``work`` itself again after each number that is stored
    scene = by_reference(by_value(work.scene))
    rest = work.options.rest_speed
    overlap = BRANCH_OVERLAP if by_value(scene.law).table is None else TABLE_BRANCH_OVERLAP
    for i in range(N + 1):
        V = nodes[ROW_V + i]
        omega_or_d = nodes[ROW_OMEGA_OR_D + i]
        nodes[V_ZERO + i] = V
        nodes[STICK_EDGE + i] = stick_edge_function(V, omega_or_d, regime, scene)
        if not regime.full_slip:
            nodes[DELTA_ZERO + i] = regime.sigma * omega_or_d + overlap
        if regime.spin_sign != 0.0 or (step.undriven and rest > 0.0):
            omega, delta = omega_and_delta(State(V, omega_or_d), regime, scene)
            # In partial slip omega = V (1 + delta): V = 0 is another event, delta = -1 is this one.
            spin_function = omega if regime.full_slip else 1.0 + delta if V > 0.0 else 1.0
            nodes[OMEGA_ZERO + i] = regime.spin_sign * spin_function
            nodes[BELOW_REST_SPEED + i] = max(abs(V), abs(omega)) - rest
        if regime.locked:  # Squares are smooth where the torque of the brake changes its sign.
            load = load_at_node(i, regime, work)
            rates = evaluate_rhs(State(V, omega_or_d), load, regime, work.scene)
            torque = required_forces(V, rates.omega, rates, load, regime, scene.j)[2]
            nodes[BRAKE_RELEASE + i] = load.brake * load.brake - torque * torque


@kernel
def _first_negative_node(event, last, nodes):
    """Return the first node at which an event function has fallen below 0, having been positive
    before; 0 for none.

    At node 0 the function counts as positive only above 1e-14 of its largest value on the step: a
    step that begins on the event does not end there.  The stick edge counts as negative only
    below -1e-13 of its scale (:func:`_event_scale`).

    event: int, code of the event.
    last: int, the last node that is considered, 1 ... N.
    nodes: Workspace.nodes, with the event functions; for STICK_EDGE also with ROW_SPEED.
    Returns an int, 1 ... ``last``, or 0.  A value of exactly 0 is neither positive nor negative,
    and a NaN is passed over; one at node 0 makes the result 0.
    """
    smallest, largest = row_range(event, nodes)  # both are NaN if node 0 is
    if not smallest < 0.0:  # The usual case, and a NaN at node 0.
        return 0
    # Whether the function has been positive at a node so far.
    positive = nodes[event] > _START_ROUNDING * max(largest, 0.0)
    for i in range(1, last + 1):
        value = nodes[event + i]
        if (
            value < 0.0
            and positive
            and (event != STICK_EDGE or value < -_EDGE_ROUNDING * _event_scale(event, nodes))
        ):
            return i
        positive = positive or value > 0.0
    return 0


@kernel
def locate_zero(event, low, high, nodes):
    """Return the position v at which the interpolant of an event function falls through 0, by false
    position.

    The weights of Anderson and Bjorck (BIT 13, 1973) move both ends of the bracket: that needs a
    sixth of the evaluations of a bisection.

    event: int, code of the event and index in ``nodes`` of the row of its function.
    low, high: float, ends of the bracket in v; the function should be positive at ``low`` and
    negative at ``high``.
    nodes: Workspace.nodes, with the event functions; the row ROW_DENSE_EVENT is written.
    Returns a float in [low, high]: ``low`` if the function is 0, negative or NaN there, else
    ``high`` if it is positive there; else the end of the last bracket with the smaller modulus of
    the function, as the weights have reduced it, and ``high`` of two equal ones: a zero to
    rounding.
    """
    fit_dense_output(event, ROW_DENSE_EVENT, nodes)
    start = nodes[event]  # the value at v = 0, which the interpolant leaves out
    f_low = start + evaluate_dense_output(low, nodes, ROW_DENSE_EVENT)
    f_high = start + evaluate_dense_output(high, nodes, ROW_DENSE_EVENT)
    if not f_low > 0.0:  # True for NaN too.
        return low
    if f_high > 0.0:
        return high
    for _ in range(_ZERO_SEARCH_STEPS):
        v = high - f_high * ((high - low) / (f_high - f_low))
        if not low < v < high or high - low < _ZERO_WIDTH:
            break
        f = start + evaluate_dense_output(v, nodes, ROW_DENSE_EVENT)
        if f > 0.0:
            # The end that stays counts less, so that it moves too: by 1 less the ratio of the last
            # two values of the other end, or by half where that ratio is 1 or more.
            f_high *= 1.0 - f / f_low if f < f_low else 0.5
            low = v
            f_low = f
        else:
            f_low *= 1.0 - f / f_high if f > f_high else 0.5
            high = v
            f_high = f
    return low if f_low < -f_high else high


@kernel
def _locate_double_crossing(nodes):
    """Return the v at which the function of STICK_EDGE falls through 0 between nodes at which it is
    positive; 0.0 for none.

    At each of nodes 1 ... N - 1 at which the function is positive and smaller than at both
    neighbours, the minimum of the interpolant between these is located by a ternary search.  The
    first minimum below 0 counts, with the zero before it.

    nodes: Workspace.nodes, with the event functions; the row ROW_DENSE_EVENT is written if there is
    such a node.
    Returns a float: a v between nodes i - 1 and i + 1, or 0.0.  A minimum between two nodes of
    equal value is not found.
    """
    for i in range(1, N):
        value = nodes[STICK_EDGE + i]
        if 0.0 < value < min(nodes[STICK_EDGE + i - 1], nodes[STICK_EDGE + i + 1]):
            fit_dense_output(STICK_EDGE, ROW_DENSE_EVENT, nodes)
            start = 1.0 + NODES[i - 1]  # where the function is still positive
            low = 1.0 + NODES[i - 1]
            high = 1.0 + NODES[i + 1]
            # the constant of the interpolant has no effect on the comparison
            for _ in range(_TERNARY_STEPS):
                third = (high - low) / 3.0
                if evaluate_dense_output(
                    low + third, nodes, ROW_DENSE_EVENT
                ) < evaluate_dense_output(high - third, nodes, ROW_DENSE_EVENT):
                    high -= third
                else:
                    low += third
            if nodes[STICK_EDGE] + evaluate_dense_output(low, nodes, ROW_DENSE_EVENT) < 0.0:
                return locate_zero(STICK_EDGE, start, low, nodes)
    return 0.0


@inline_kernel
def find_first_event(step, regime, work):
    """Return the event whose function falls below 0 first on a solved step, and its position by the
    interpolant.

    Only active events count (:func:`is_event_active`).  Between the same two nodes the zeros of the
    interpolants decide which event is first; at equal zeros it is the one with the smaller code.
    If no function is negative at a node, in full slip the stick edge is also searched between the
    nodes (:func:`_locate_double_crossing`).

    step: Step, the solved one; ``undriven`` is read.
    regime: Regime, that of the step; ``full_slip``, ``spin_sign`` and ``locked`` are read.
    work: Workspace, with the event functions, ROW_SPEED and the rest threshold; the row
    ROW_DENSE_EVENT is written.
    Returns (event, v in [0, 2]), an int and a float; (NO_EVENT, 2.0) for none.
    """
    event = NO_EVENT
    last = N  # node after the zero of the first event so far: a later one cannot be first
    v = 2.0
    nodes = work.nodes
    # codes of events are indices of rows, which lie between these two, one row apart
    for candidate in range(STICK_EDGE, ROW_DRIVE, ROW_LENGTH):
        node = (
            _first_negative_node(candidate, last, nodes)
            if is_event_active(candidate, step, regime, work)
            else 0
        )
        if node == 0:
            continue
        # v = 1 + t of the nodes
        v_zero = locate_zero(candidate, 1.0 + NODES[node - 1], 1.0 + NODES[node], nodes)
        # node is at most ``last``: before it, or between the same nodes as the first event so far
        if event == NO_EVENT or node < last or v_zero < v:
            event = candidate
            last = node
            v = v_zero
    if event == NO_EVENT and regime.full_slip:
        v_zero = _locate_double_crossing(nodes)
        if v_zero > 0.0:
            return STICK_EDGE, v_zero
    return event, v


@inline_kernel
def find_missed_event(step, regime, work):
    """Return the event whose function is 0 at the left end of the step and negative from there on;
    NO_EVENT for none.

    The regime has then ended before the first node.  The function must exceed 1e-14 of its scale at
    no node and be below 0 by more than the tolerance of events at the last one.  The scale of V = 0
    contains the larger speed too, unless V is prescribed.  BELOW_REST_SPEED is left out, and in
    partial slip STICK_EDGE, as the equations of partial slip continue into full slip.

    step: Step, the solved one; ``undriven`` is read.
    regime: Regime, that of the step; ``full_slip``, ``spin_sign`` and ``locked`` are read.
    work: Workspace, with the event functions, ROW_SPEED and the drive at the nodes, and rtol, rest
    threshold and Drive.
    Returns an int, the first such event in the order of the codes, or NO_EVENT.
    """
    nodes = work.nodes
    tolerance = max(_EVENT_TOLERANCE * work.options.rtol, _EVENT_ROUNDING)
    for candidate in range(STICK_EDGE, ROW_DRIVE, ROW_LENGTH):
        # The rest threshold is asked for where a regime begins.  The equations of partial slip
        # continue into full slip: a missed edge does no harm there.
        excluded = candidate == BELOW_REST_SPEED or (
            candidate == STICK_EDGE and not regime.full_slip
        )
        if (
            excluded
            or not nodes[candidate + N] < 0.0
            or not is_event_active(candidate, step, regime, work)
        ):
            continue
        (_, largest) = row_range(candidate, nodes)
        scale = _event_scale(candidate, nodes)
        # V = 0 is accurate relative to omega; a prescribed V is accurate relative to itself.
        if candidate == V_ZERO and work.drive.prescribed != PRESCRIBED_V:
            scale = max(scale, nodes[ROW_SPEED + N])
        if largest <= _START_ROUNDING * scale and nodes[candidate + N] < -tolerance * scale:
            return candidate
    return NO_EVENT


@kernel
def _event_function(event, v, regime, work):
    """Return an event function at a position of a step, by the dense output of the unknowns; a
    float, dimensionless.

    :func:`refine_event` iterates on it, for functions that are no polynomial of the unknowns:
    between the nodes it is more accurate than the interpolant of its values there.  At the nodes it
    has the values of :func:`evaluate_event_functions`, to rounding, but for OMEGA_ZERO where V is
    not above 0: there these are spin_sign.

    event: int, STICK_EDGE; BELOW_REST_SPEED, in full slip only; or OMEGA_ZERO, in partial slip
    only.
    v: float, position on the step, in [0, 2] or a little outside.
    regime: Regime, that of the step; ``full_slip``, ``sigma`` and ``spin_sign`` are read.
    work: Workspace, with the dense output, the unknowns at node 0, Scene and the rest threshold.
    It is :func:`stick_edge_function` for STICK_EDGE, max(|V|, |omega|) less the rest threshold for
    BELOW_REST_SPEED and spin_sign (1 + delta) for OMEGA_ZERO; positive within the regime.
    """
    V, omega_or_d = dense_state(v, work.nodes)
    if event == BELOW_REST_SPEED:  # in full slip, where the second unknown is omega
        return max(abs(V), abs(omega_or_d)) - work.options.rest_speed
    if event == OMEGA_ZERO:
        return regime.spin_sign * (1.0 + creepage(V, omega_or_d, work.scene))
    return stick_edge_function(V, omega_or_d, regime, work.scene)


@kernel
def refine_event(event, v, regime, work):
    """Refine the position of an event whose function is no polynomial of the unknowns, by the
    function itself.

    Such functions are the stick edge and the larger speed in full slip, and 1 + delta, whose zero
    is that of omega, in partial slip.  The iteration is Newton's, with one difference quotient in
    place of the slope.  It ends after 5 corrections, or before one of 0.1 or more in modulus or one
    that is NaN.

    event: int, code of the event.
    v: float, position of the event by the interpolant, in [0, 2].
    regime: Regime, that of the step; ``full_slip``, ``sigma`` and ``spin_sign`` are read.
    work: Workspace, with the dense output, V and the second unknown at node 0, Scene and the rest
    threshold.
    Returns the position v, a float in [0, 2]; for all other events ``v`` unchanged.
    """
    refined = event == OMEGA_ZERO
    if regime.full_slip:
        refined = event == STICK_EDGE or event == BELOW_REST_SPEED
    if not refined:
        return v
    # the difference quotient is ``difference`` over 2 _SECANT_OFFSET
    difference = _event_function(event, v + _SECANT_OFFSET, regime, work)
    difference -= _event_function(event, v - _SECANT_OFFSET, regime, work)
    for _ in range(_SECANT_STEPS):
        correction = _event_function(event, v, regime, work) * (2.0 * _SECANT_OFFSET) / difference
        if not abs(correction) < _MAX_SECANT_MOVE:  # True for NaN too.
            break
        v = min(max(v - correction, 0.0), 2.0)
    return v


@kernel
def _event_scale(event, nodes):
    """Return the scale of an event function on a step, in the unit of the function.

    It is the largest modulus of the function at the nodes, or that of the quantities of which the
    function is a difference if it is larger: the largest of |V| and |omega| at the nodes for
    STICK_EDGE, OMEGA_ZERO and BELOW_REST_SPEED, in partial slip too; the square of the brake's
    largest torque at the nodes for BRAKE_RELEASE.

    event: int, code of the event and index in ``nodes`` of the row of its function.
    nodes: Workspace.nodes, with event functions, ROW_SPEED and drive.
    Returns a float, at least 0; 0 only where all of these are 0.
    """
    smallest, largest = row_range(event, nodes)
    largest = max(largest, -smallest)
    # ``in`` would compile a function of numba's
    if event == STICK_EDGE or event == OMEGA_ZERO or event == BELOW_REST_SPEED:
        return max(largest, row_range(ROW_SPEED, nodes)[1])
    if event == BRAKE_RELEASE:
        brake = row_range(ROW_DRIVE + ROW_LENGTH * DRIVE_BRAKE, nodes)[1]
        return max(largest, brake * brake)
    return largest


@kernel
def ends_at_event(event, nodes, rtol):
    """Return whether a step ends at an event: its function has fallen to 0 at the right end; a
    bool.

    At the right end its modulus is at most max(0.01 rtol, 4e-15) times its scale
    (:func:`_event_scale`) and the function is smaller than at another node.  Its largest value must
    exceed 1e-13 of the scale, so that a step along which it is 0 but for rounding does not end at
    it.  The result is False for a NaN at the right end.

    event: int, code of the event and index in ``nodes`` of the row of its function.
    nodes: Workspace.nodes, with the event functions, ROW_SPEED and the drive.
    rtol: float, relative tolerance of the motion, dimensionless, > 0.
    """
    scale = _event_scale(event, nodes)
    last = nodes[event + N]
    (_, largest) = row_range(event, nodes)
    # it has fallen, it was above rounding, and it is 0 to the tolerance; False for NaN
    return (
        last < largest
        and largest > _EDGE_ROUNDING * scale
        and abs(last) <= max(_EVENT_TOLERANCE * rtol, _EVENT_ROUNDING) * scale
    )
