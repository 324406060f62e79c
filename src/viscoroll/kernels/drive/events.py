"""Where on a panel a regime ends first: found on the interpolants, then by panels that end there."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..motion.collocation import NODES, N, rise_at, rise_terms
from .records import EDGE, EVENTS, NO_EVENT, SLOW, STOP
from .solve import EVENT, OF_EVENT, SPEED, Panel, panel_error, slope_at, solve

#: panels solved at most until one ends on the event, and how closely, as shares of the tolerance
_CUTS, _ON, _NEWTON = 8, 1e-2, 1e-3
#: error over the tolerance from which on a panel is given up
_HOPELESS = 30.0
#: the least that rounding leaves, over what the function of an event is made of
_LEAST = 4e-15
#: halvings of a bracket of the interpolant
_HALVINGS = 60
#: an edge that a panel starts on, to rounding, is not met there
_ROUNDING = 1e-14


@kernel
def first_event(known, nodes):
    """(Event but the ``known`` one whose function first falls below 0 at a node, that node); NO_EVENT for none."""
    event, node = NO_EVENT, N + 1
    for row in range(EVENTS):
        if row == known:
            continue
        largest = 0.0
        for i in range(N + 1):
            largest = max(largest, nodes[EVENT + row, i])
        inside = nodes[EVENT + row, 0] > _ROUNDING * largest
        for i in range(1, N + 1):
            if i >= node:
                break
            value = nodes[EVENT + row, i]
            if value < 0.0 and inside:
                event, node = row, i
                break
            inside = inside or value > 0.0
    return event, node


@kernel
def _place(event, node, nodes, powers):
    """v in [0, 2] at which the interpolant of an event's function passes 0 before this node."""
    rise_terms(nodes[EVENT + event], powers, OF_EVENT)
    start = nodes[EVENT + event, 0]
    low, high = 1.0 + NODES[node - 1], 1.0 + NODES[node]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if start + rise_at(middle, powers, OF_EVENT) > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def _size(event, nodes):
    """What the function of an event is made of: speeds, or the unknown itself."""
    largest = 0.0
    for i in range(N + 1):
        of_speeds = nodes[SPEED, i] if event in (EDGE, STOP, SLOW) else 0.0
        largest = max(largest, abs(nodes[EVENT + event, i]), of_speeds)
    return largest


@kernel
def _end_slope(event, panel, nodes):
    """Slope of an event's function in the length of the panel."""
    return slope_at(N, EVENT + event, nodes) * 2.0 * panel.power / panel.length


@kernel
def length_until(event, node, panel, case):
    """Length until an event that shows at this node."""
    return panel.length * (0.5 * _place(event, node, case.work.nodes, case.work.powers)) ** panel.power


@kernel
def cut(event, length, longest, panel, slopes, frame, case):
    """(Event, panel that ends on it, error of that over its tolerance); the error is infinite where there is none.

    By solving panels, of this length first, then corrected by the slope at their ends, up to the ``longest``.  Another
    event that shows before takes its place.
    """
    nodes, near = case.work.nodes, max(_ON * case.limits.rtol, _LEAST)
    low, high, met = 0.0, longest, longest <= panel.length
    for _ in range(_CUTS):
        panel = Panel(panel.tau, length, panel.power, panel.piece, panel.free)
        if not (0.0 < length < np.inf and solve(_NEWTON, panel, slopes, frame, case)):
            break
        size = panel_error(panel, slopes, frame, case)
        if size > _HOPELESS:
            return event, panel, size
        earlier, node = first_event(event, nodes)
        if earlier != NO_EVENT and nodes[EVENT + earlier, node] < -near * _size(earlier, nodes):
            low, high, met = 0.0, length, True
            event, length = earlier, length_until(earlier, node, panel, case)
            continue
        off = nodes[EVENT + event, N]
        if abs(off) <= near * _size(event, nodes):
            return event, panel, size
        low, high, met = length if off > 0.0 else low, high if off > 0.0 else length, met or off <= 0.0
        length -= off / _end_slope(event, panel, nodes)
        if not low < length < high:
            if not met:
                break
            length = 0.5 * (low + high)
    return event, panel, np.inf
