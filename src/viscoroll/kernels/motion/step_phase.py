"""Partial slip by steps: where the boundary layer is not followed, and the slow manifold not reached yet."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy
from .control import (
    SHARE,
    creep_weight,
    crossing,
    error_norm,
    first_length,
    halving,
    next_length,
    shorter,
    slip_share,
)  # fmt: skip
from .events import EXPLICIT, NO_EVENT, SLIP, STIFF, advance, first_event
from .explicit import slope_at
from .output import write_outputs

#: rejected steps in a row
_MOST_REJECTIONS = 60
#: share of a step below which slip returns at once, and how often that is looked at closer
_AT_ONCE, _MOST_RETRIES = 1e-3, 6
#: step times relaxation rate beyond which the implicit method is cheaper
_STIFF_FROM = 4.0
#: the pace of steps, kept where the slow manifold is tried in vain: method, length of the next (0 at first), what it
#: may be at least, length and error of the last
METHOD, LENGTH, WISH, LENGTH_BEFORE, ERROR_BEFORE = range(5)
PACE = 5


@kernel
def settled(u, slope, share, relaxation, rtol):
    """Whether the boundary layer seems to be over, so that following the slow manifold may be tried."""
    if slope[0] <= 0.0 or relaxation <= 20.0 * slope[0]:
        return False
    if abs(slope[1]) <= 5.0 * slope[0] * abs(u[1]):
        return True
    return abs(slope[1]) * creep_weight(share) * np.exp(-u[0]) <= 10.0 * SHARE * rtol * relaxation


@kernel
def judged(method, u, slope, share, share_new, length, rtol, travelled, new, error, K):
    """(Error over tolerance, shares of the step to try: up to delta = 0, and for the stick zone's sake)."""
    size = error_norm(u, new, share_new, error, travelled, rtol)
    if method != EXPLICIT:
        return size, 1.0, 1.0
    part = crossing(u, length * slope[1], share, new, length * K[12, 1], share_new, rtol)
    return size, part, halving(share, share_new, length, new, K, rtol)


@kernel
def step_phase(u, tau, tau_out, at, direction, scene, gamma, offset, travelled, rtol, rest, far, try_at, max_steps,
               steps, out, step_ends, ends, pace, slope, buffers):  # fmt: skip
    """Step from u to an event, until outputs end, to zeta = exp(far), or from ``try_at`` on near the slow manifold.

    Returns (event, whether the slow manifold seems near, tau, next column, steps, ends noted).
    """
    new, error, K, terms = buffers
    tau_end = tau_out[tau_out.size - 1]
    relaxation, share, rejected = slope_at(u, scene, slope), slip_share(u, scene), 0
    method = EXPLICIT if pace[METHOD] == EXPLICIT else STIFF
    if pace[LENGTH] == 0.0:
        pace[LENGTH] = first_length(u, rtol, scene)
    while (
        at < tau_out.size and steps < max_steps and u[0] < far and rejected <= _MOST_REJECTIONS and pace[LENGTH] > 0.0
    ):
        if rejected == 0 and tau >= try_at and settled(u, slope, share, relaxation, rtol):
            return NO_EVENT, True, tau, at, steps, ends
        last, length = pace[LENGTH] >= tau_end - tau, min(pace[LENGTH], tau_end - tau)
        relaxation_new = advance(method, u, slope, length, scene, K, new, error)
        share_new = slip_share(new, scene)
        size, part, half = judged(method, u, slope, share, share_new, length, rtol, travelled, new, error, K)
        steps += 1
        rejected += 1
        if not size <= 1.0 or part < 1.0 or half < 1.0:
            pace[WISH] = length if size <= 1.0 and part < 1.0 else 0.0
            shortened = min(part, half) * length
            pace[LENGTH] = min(shortened, shorter(length, size, method)) if half == 1.0 else shortened
            continue
        event, reached = first_event(method, u, slope, length, scene, rest, share_new, K, new, error, terms)
        if event == SLIP:
            if reached < _AT_ONCE * length and rejected <= _MOST_RETRIES:
                # |D| = zeta at the start may be taken for the end of a stick zone that is shorter than the step
                pace[LENGTH] = 0.1 * length
                continue
            # the step that was accepted went beyond eta = 0, where the law bends: this one ends there
            share_new = np.sign(share_new)
            size, _, half = judged(method, u, slope, share, share_new, reached, rtol, travelled, new, error, K)
            if not size <= 1.0 or half < 1.0:
                pace[LENGTH] = half * reached if half < 1.0 else shorter(reached, size, method)
                continue
        rejected = 0
        ahead = next_length(length, size, pace[LENGTH_BEFORE], pace[ERROR_BEFORE], method)
        pace[LENGTH], pace[WISH] = max(pace[WISH], ahead), 0.0
        pace[LENGTH_BEFORE], pace[ERROR_BEFORE] = length, max(size, 1e-20)
        at = write_outputs(
            tau_out, at, tau, reached, last and event == NO_EVENT, method, direction, u, new, slope, K, terms, scene,
            gamma, offset, out,
        )  # fmt: skip
        for m in range(2):
            travelled[m] += abs(new[2 + m] - u[2 + m])
        copy(new, u)
        tau += reached
        if ends < step_ends.size:
            step_ends[ends] = tau / gamma
            ends += 1
        if event != NO_EVENT:
            return event, False, tau, at, steps, ends
        copy(K[12], slope)
        relaxation, share = relaxation_new, share_new
        method = STIFF if pace[LENGTH] * relaxation > (_STIFF_FROM if method == EXPLICIT else 1.0) else EXPLICIT
        pace[METHOD] = method
    return NO_EVENT, False, tau, at, steps, ends
