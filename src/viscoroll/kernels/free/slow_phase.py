"""The slow manifold as far as it carries: interval control."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .collocation import SLOPES, N
from .control import SHARE, creep_weight, next_length
from .panel import pass_path
from .partial_slip import slow_D
from .path import path_mismatch
from .records import NO_EVENT, SLOW, Clock, Panel
from .slow import (
    DELTA_D,
    DRIFT_D,
    NODE_D,
    RATE,
    REACHED,
    project,
    slow_go_on,
    slow_path,
    slow_solve,
    slow_start,
    sticks_throughout,
)  # fmt: skip

#: beyond this y (kappa V < 1e-17) the slow motion is exponential to rounding
FAR = 17.0 * np.log(10.0)
#: first, longest and shortest interval in ln zeta
_FIRST, _LONGEST, _SHORTEST = 0.5, 2.5, 0.02
#: relaxation over an interval, in e-folds, below which it is no business of this module
_STIFF = 20.0
#: Newton stops at this share of the tolerance of an interval
NEWTON = 0.05
#: a mismatch of the integrands at the left end overstates the error of their interpolants
_OVERSTATED = 0.05


@kernel(inline=True)
def attempt(length, state, case):
    """One interval: errors of its interpolants, and of the offset at its left end, over their tolerances.

    They are infinite where it failed.
    """
    y, work, tolerance = state.first, case.work, SHARE * case.limits.rtol
    values = work.values
    solved = slow_solve(y, length, NEWTON * tolerance, SLOPES, case.scene, work)
    if not (solved and sticks_throughout(y, length, values)):
        return np.inf, np.inf
    per = np.exp(-y)
    weight = creep_weight(values[REACHED, NODE_D] * per) * per
    rest = abs(project(values)) * max(weight, values[0, DELTA_D])
    slow_path(values, work.nodes)
    return _OVERSTATED * path_mismatch(length, 0.0, state, work.nodes) / tolerance, rest / tolerance


@kernel
def _behind(tau, wait):
    """tau + wait, at least one digit later: else steps and manifold hand the motion to each other for ever."""
    return max(tau + wait, np.nextafter(tau, np.inf))


@kernel
def slow_phase(state, frame, clock, case):
    """Follow the slow manifold until outputs end, y exceeds FAR, or an interval fails.

    Returns (event, state, clock, time to try again).
    """
    limits, sink, work = case.limits, case.sink, case.work
    values = work.values
    tau_end = sink.tau[sink.tau.size - 1]
    length, entering, before = _FIRST, True, np.inf
    slow_start(state.first, state.second - slow_D(state.first, case.scene)[0], values, case.scene)
    while clock.at < sink.tau.size and state.first < FAR and clock.steps < limits.max_steps:
        relaxation = -values[REACHED, DRIFT_D]
        length = min(length, _LONGEST, max(1.1 * (tau_end - clock.tau) * values[REACHED, RATE], 0.05))
        size, offset_size = attempt(length, state, case)
        clock = Clock(clock.tau, clock.at, clock.steps + 1, clock.ends)
        # what is left of the layer stays as the interval is shortened; what the interval does not resolve falls
        if size <= 1.0 < offset_size and entering and offset_size > 0.5 * before:
            return NO_EVENT, state, clock, _behind(clock.tau, max(np.log(offset_size), 1.0) / relaxation)
        size, before = max(size, offset_size), offset_size
        ahead = next_length(length, size, 1)
        if not size <= 1.0:
            length = ahead
            if length < _SHORTEST or relaxation * length < _STIFF * values[REACHED, RATE]:
                return NO_EVENT, state, clock, _behind(clock.tau, _STIFF / relaxation)
            continue
        entering = False
        panel = Panel(SLOW, state.first, state.second, length, 1, 0.0, 0.0, 0.0, 0.0)
        event, state, clock = pass_path(state.first + length, values[N, NODE_D], panel, state, frame, clock, case)
        if event != NO_EVENT:
            return event, state, clock, clock.tau
        slow_go_on(values)
        length = ahead
    return NO_EVENT, state, clock, clock.tau
