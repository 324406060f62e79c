"""Which of the events on a panel is the first."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

from viscoroll.kernels.motion.collocation import NODES, WIDE, N
from viscoroll.kernels.motion.events import first_event, place_of
from viscoroll.kernels.motion.nodes import EVENT, INTERPOLANTS, NUMBERS, Panel
from viscoroll.kernels.motion.records import EVENTS, NO_EVENT, Frame, Work

#: a phase that each of the events may end, as far as they are looked for: stick that a brake works on
PANEL, FRAME = Panel(0.0, 1.0, 1, 0, True, False, 1e-9), Frame(False, 1.0, 1.0, 1.0, False)
#: all but what ends where a brake holds
MAY_END = EVENTS - 1


def work_of(zeros: dict[int, float]) -> Work:
    """A panel on which functions of events fall along straight lines to 0 at these v, those of the others stay."""
    nodes, empty = np.ones(NUMBERS), np.empty(0)
    for event, v in zeros.items():
        nodes[EVENT + WIDE * event : EVENT + WIDE * (event + 1)] = v - 1.0 - NODES
    return Work(nodes, np.empty(INTERPOLANTS), empty, empty, empty)


def first(work: Work) -> tuple[int, float]:
    return first_event(PANEL, FRAME, work)


def test_none():
    assert first(work_of({})) == (NO_EVENT, 2.0)


@pytest.mark.parametrize("shares", [(0.3, 0.7), (0.499, 0.501)])
def test_the_earlier_of_two_between_the_same_nodes(shares):
    """Whatever the order of their rows."""
    low, high = 1.0 + NODES[4], 1.0 + NODES[5]
    early, late = (low + share * (high - low) for share in shares)
    for one, other in permutations(range(MAY_END), 2):
        event, v = first(work_of({one: early, other: late}))
        assert event == one
        assert close(v, early, rel=tol.EVENT_PLACE)


@pytest.mark.parametrize("share", np.linspace(0.05, 0.95, 7))
def test_the_place_of_an_event(share):
    for node in range(1, N + 1):
        v = 1.0 + NODES[node - 1] + share * (NODES[node] - NODES[node - 1])
        assert close(place_of(0, node, work_of({0: v})), v, rel=tol.EVENT_PLACE, scale=1.0)


def test_the_earlier_of_two_between_other_nodes():
    for one, other in permutations(range(MAY_END), 2):
        assert first(work_of({one: 1.0 + NODES[3] + 0.01, other: 1.0 + NODES[6] + 0.01}))[0] == one
