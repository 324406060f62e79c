"""Assignments to arrays, element by element: numba's own would prepare for shapes that differ, and compile longer."""

from ..compile.jit import kernel


@kernel
def copy(source, target):
    """Copy ``source`` into ``target``: both have one axis and the same length, not checked here; returns nothing."""
    for i in range(source.size):
        target[i] = source[i]


@kernel
def fill(value, target):
    """Write ``value``, a number, into every element of ``target``, which has one axis.  Returns nothing."""
    for i in range(target.size):
        target[i] = value
