"""All zeros of a smooth function of one variable on an interval: :func:`zeros`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...core.typed import Floats

_HALVINGS = 62
#: where a function comes near 0 and turns back, it is looked at this often with so many points
_ZOOMS, _ZOOMED = 4, 33

Function = Callable[[Floats], Floats]


def zeros(function: Function, nodes: Floats, noise: Floats | float = 0.0) -> NDArray:
    """Zeros of a vectorised ``function`` between ascending ``nodes``, pairs closer than the nodes among them.

    A pair is found where |function| has a minimum at a node.  Nodes where it is not above ``noise`` have no sign.
    Zeros are bisected to rounding of the nodes.
    """
    values = function(nodes)
    known = np.abs(values) > noise
    nodes, values = nodes[known], values[known]
    parts = [(nodes, values), *_zoomed(function, nodes, values)]
    brackets = [_changes(*part) for part in parts]
    low, high, rising = (np.concatenate(each) for each in zip(*brackets, strict=True))
    for _ in range(_HALVINGS if low.size else 0):
        middle = 0.5 * (low + high)
        before = (function(middle) > 0.0) != rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.sort(0.5 * (low + high))


def _changes(x: NDArray, y: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """(low, high, whether it rises) of the intervals in which the sign changes."""
    at = np.flatnonzero(np.sign(y[1:]) * np.sign(y[:-1]) < 0.0)
    return x[at], x[at + 1], y[at + 1] > 0.0


def _zoomed(function: Function, x: NDArray, y: NDArray) -> list[tuple[NDArray, NDArray]]:
    """Points and values around two zeros between two neighbours of a node."""
    size, sign = np.abs(y), np.sign(y)
    near = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (sign[1:-1] == sign[:-2]) & (sign[1:-1] == sign[2:])
    # a parabola through three nodes reaches 0 between them where it is bent by more than that; rounding is not
    near &= size[1:-1] < size[:-2] - 2.0 * size[1:-1] + size[2:]
    found = []
    for n in np.flatnonzero(near) + 1:
        low, high = x[n - 1], x[n + 1]
        for _ in range(_ZOOMS):
            points = np.linspace(low, high, _ZOOMED)
            values = function(points)
            least = int(np.clip(np.argmin(values * sign[n]), 1, _ZOOMED - 2))
            if values[least] * sign[n] < 0.0:
                found.append((points, values))
                break
            low, high = points[least - 1], points[least + 1]
    return found
