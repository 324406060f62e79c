"""Stress over arrays of points."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.jit import kernel
from .material import standard
from .stress import stress_at


class Points(NamedTuple):
    """Arrays of what :func:`stress_at` asks for: one value, or one a point; x points ahead of the axis."""

    x: Any
    kappa: Any
    mu: Any
    lam: Any
    epsilon: Any
    beta: Any
    zeta: Any
    alpha: Any


@kernel(inline=True)
def _own(array, i):
    return array[min(i, array.size - 1)]


@kernel
def stress_loop(points, p, tau, start, stop):
    """p/E' and |tau|/E' at points start..stop."""
    for i in range(start, stop):
        p[i], tau[i] = stress_at(
            _own(points.x, i), _own(points.kappa, i), _own(points.mu, i), _own(points.lam, i),
            _own(points.epsilon, i), _own(points.beta, i), _own(points.zeta, i), standard(_own(points.alpha, i)),
        )  # fmt: skip
