"""Where on a panel a regime ends first, as its interpolants show."""

from __future__ import annotations

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from .collocation import NODES, WIDE, N, rise_at, rise_terms
from .load import BRAKE
from .nodes import DRIVE, EVENT, OF_EVENT, OF_SECOND, OF_V, SECOND, SPEED, V, extremes, may_end
from .rates import creep_at, edge
from .records import EDGE, EVENTS, FREED, NO_EVENT, SLOW, STOP, TURN
from .records import SPEED as PRESCRIBED_V

#: how closely a panel ends on an event, as a share of the tolerance, and the least that rounding leaves, over what the
#: function of the event is made of
_ON, _LEAST = 1e-2, 4e-15
#: halvings of a bracket of the interpolant
_HALVINGS = 60
#: parts of a bracket in which its lowest point is looked for
_THIRDS = 40
#: an edge that a panel starts on, to rounding, is not met there
_ROUNDING = 1e-14
#: what rounding makes of slip that lies on its edge, over the speeds that it is made of
_NOISE = 1e-13
#: v up to which the interpolant is followed beyond the panel, and from which on nothing was found there
_BEYOND = 3.0
NOWHERE = 2.99
#: step of the slope by which a place is found closer, how often, and how far it may move
_ASIDE, _STEPS, _NEAR_BY = 1e-3, 5, 0.1


@kernel
def _node_of(event, last, nodes):
    """Node up to the ``last`` at which an event's function first has fallen below 0; 0 for none."""
    _, most = extremes(EVENT + WIDE * event, nodes)
    inside = nodes[EVENT + WIDE * event] > _ROUNDING * max(most, 0.0)
    for i in range(1, last + 1):
        value = nodes[EVENT + WIDE * event + i]
        if value < 0.0 and inside and (event != EDGE or value < -_NOISE * _scale(event, nodes)):
            return i
        inside = inside or value > 0.0
    return 0


@kernel(inline=True)
def first_event(panel, frame, case):
    """(Event whose function falls below 0 first, v there); NO_EVENT for none.

    Between the same two nodes the interpolants tell which comes first: behind V = 0 no other counts.
    """
    event, last, v, nodes = NO_EVENT, N, 2.0, case.nodes
    for row in range(EVENTS):
        node = _node_of(row, last, nodes) if may_end(row, panel, frame, case) else 0
        if node == 0:
            continue
        here = place_of(row, node, nodes)
        if event == NO_EVENT or node < last or here < v:
            event, last, v = row, node, here
    if event == NO_EVENT and frame.slips:
        here = _dip(EDGE, nodes)
        if here > 0.0:
            return EDGE, here
    return event, v


@kernel(inline=True)
def passed_over(panel, frame, case):
    """Event whose function begins at 0 and is negative at all nodes: if the regime lasts at all it has ended before
    the first of them; NO_EVENT for none."""
    nodes = case.nodes
    for row in range(EVENTS):
        # full slip is a case of the equations of partial slip
        if row == SLOW or (row == EDGE and not frame.slips) or not may_end(row, panel, frame, case):
            continue
        (_, most), scale = extremes(EVENT + WIDE * row, nodes), _scale(row, nodes)
        # V passes 0 beside omega, but for one that is prescribed: that is known beside itself
        if row == TURN and case.drive.prescribed != PRESCRIBED_V:
            scale = max(scale, nodes[SPEED + N])
        if most <= _ROUNDING * scale and nodes[EVENT + WIDE * row + N] < -_near(case.limits.rtol) * scale:
            return row
    return NO_EVENT


@kernel
def place_of(event, node, nodes):
    """v at which the interpolant of an event's function passes 0, before this node or, where that is 0, beyond the
    panel."""
    rise_terms(EVENT + WIDE * event, OF_EVENT, nodes)
    low, high = (1.0 + NODES[node - 1], 1.0 + NODES[node]) if node > 0 else (2.0, _BEYOND)
    return _zero(nodes[EVENT + WIDE * event], low, high, nodes)


@kernel
def _zero(start, low, high, nodes):
    """v where the interpolant there falls through 0."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if start + rise_at(middle, nodes, OF_EVENT) > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def _dip(event, nodes):
    """v where an event's function falls through 0 between nodes at all of which it is positive; 0 for nowhere."""
    at = EVENT + WIDE * event
    for i in range(1, N):
        if 0.0 < nodes[at + i] < min(nodes[at + i - 1], nodes[at + i + 1]):
            rise_terms(at, OF_EVENT, nodes)
            start, low, high = 1.0 + NODES[i - 1], 1.0 + NODES[i - 1], 1.0 + NODES[i + 1]
            for _ in range(_THIRDS):
                third = (high - low) / 3.0
                if rise_at(low + third, nodes, OF_EVENT) < rise_at(high - third, nodes, OF_EVENT):
                    high -= third
                else:
                    low += third
            if nodes[at] + rise_at(low, nodes, OF_EVENT) < 0.0:
                return _zero(nodes[at], start, low, nodes)
    return 0.0


@kernel
def _itself(event, v, frame, case):
    """An event's function at v by the unknowns there."""
    nodes = case.nodes
    speed, second = nodes[V] + rise_at(v, nodes, OF_V), nodes[SECOND] + rise_at(v, nodes, OF_SECOND)
    if event == SLOW:
        return max(abs(speed), abs(second)) - case.limits.rest
    if event == STOP:
        return frame.spin * (1.0 + creep_at(speed, second, case.scene))
    return edge(speed, second, frame, by_value(case.scene))


@kernel
def located(event, v, frame, case):
    """The same place by the function itself where that is no polynomial of the unknowns: the edge and the faster of
    both speeds in full slip, and omega in partial slip."""
    if not (((event == EDGE or event == SLOW) and frame.slips) or (event == STOP and not frame.slips)):
        return v
    rise = _itself(event, v + _ASIDE, frame, case) - _itself(event, v - _ASIDE, frame, case)
    for _ in range(_STEPS):
        move = _itself(event, v, frame, case) * (2.0 * _ASIDE) / rise
        if not abs(move) < _NEAR_BY:
            break
        v = min(max(v - move, 0.0), 2.0)
    return v


@kernel
def _scale(event, nodes):
    """What the function of an event is made of."""
    least, most = extremes(EVENT + WIDE * event, nodes)
    most = max(most, -least)
    if event in (EDGE, STOP, SLOW):
        return max(most, extremes(SPEED, nodes)[1])
    return max(most, extremes(DRIVE + WIDE * BRAKE, nodes)[1] ** 2) if event == FREED else most


@kernel(inline=True)
def _near(rtol):
    """Share of that up to which the function counts as 0."""
    return max(_ON * rtol, _LEAST)


@kernel
def ends_on(event, nodes, rtol):
    """Whether a panel ends on an event: its function has fallen to 0, and does not only set out from there."""
    row, scale = EVENT + WIDE * event, _scale(event, nodes)
    last, (_, most) = nodes[row + N], extremes(row, nodes)
    return last < most and most > _NOISE * scale and abs(last) <= _near(rtol) * scale
