"""Which of the events on a panel is the first."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

from viscoroll.kernels.motion.events import first_event, place_of
from viscoroll.kernels.motion.nodes import EVENT, INTERPOLANTS, ROWS
from viscoroll.kernels.motion.records import EVENTS, NO_EVENT, Work
from viscoroll.kernels.free.collocation import NODES, N


def work_of(zeros: dict[int, float]) -> Work:
    """A panel on which functions of events fall along straight lines to 0 at these v, those of the others stay."""
    nodes, empty = np.ones((ROWS, N + 1)), np.empty(0)
    for event, v in zeros.items():
        nodes[EVENT + event] = v - 1.0 - NODES
    return Work(nodes, np.empty((INTERPOLANTS, N + 2)), np.empty((0, 0)), empty, empty)


def test_none():
    assert first_event(work_of({})) == (NO_EVENT, 2.0)


@pytest.mark.parametrize("shares", [(0.3, 0.7), (0.499, 0.501)])
def test_the_earlier_of_two_between_the_same_nodes(shares):
    """Whatever the order of their rows."""
    low, high = 1.0 + NODES[4], 1.0 + NODES[5]
    early, late = (low + share * (high - low) for share in shares)
    for first, second in permutations(range(EVENTS), 2):
        event, v = first_event(work_of({first: early, second: late}))
        assert event == first
        assert close(v, early, rel=tol.EVENT_PLACE)


@pytest.mark.parametrize("share", np.linspace(0.05, 0.95, 7))
def test_the_place_of_an_event(share):
    for node in range(1, N + 1):
        v = 1.0 + NODES[node - 1] + share * (NODES[node] - NODES[node - 1])
        assert close(place_of(0, node, work_of({0: v})), v, rel=tol.EVENT_PLACE, scale=1.0)


def test_the_earlier_of_two_between_other_nodes():
    for first, second in permutations(range(EVENTS), 2):
        assert first_event(work_of({first: 1.0 + NODES[3] + 0.01, second: 1.0 + NODES[6] + 0.01}))[0] == first
