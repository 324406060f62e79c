"""A root between two ends, by the Illinois method: secants, halving the value at an end that stays twice.

M. Dowell, P. Jarratt, A modified regula falsi method for computing the root of an equation, BIT 11:168 (1971).
The function is positive at ``low``, negative at ``high``; what it is, callers know, and so the loop is theirs.
"""

from __future__ import annotations

from ..compile.jit import kernel


@kernel
def secant(low, high, at_low, at_high):
    """Where the straight line through both ends is zero."""
    return low + (high - low) * at_low / (at_low - at_high)


@kernel
def narrowed(low, high, at_low, at_high, side, middle, value):
    """(low, high, at_low, at_high, side) with ``middle`` as an end: low if ``side`` is +1, high if -1; 0 at first."""
    if value > 0.0:
        return middle, high, value, at_high * (0.5 if side == 1 else 1.0), 1
    return low, middle, at_low * (0.5 if side == -1 else 1.0), value, -1
