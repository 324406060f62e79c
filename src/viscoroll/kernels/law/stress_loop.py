"""Stress over arrays of points."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..material.functions import Own, standard
from ..material.series import Series, Solved, room
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


@kernel(inline=True)
def _at(array, i):
    return array[min(i, array.size - 1)]


@kernel(allocates=True)  # what it returns holds a reference to an array
def _as_given(given):
    return given


@kernel(allocates=True)
def _with_room(given):
    return Solved(given, room(given))


@kernel(inline=True)
def _own(given, i):
    return standard(_at(given.alpha, i))


@kernel(inline=True, allocates=True)  # what it returns holds references to arrays
def _shared(given, i):
    return given


#: what a block of points is computed from, and the material of point i
_prepared = by_record(0, (Own, _as_given), (Series, _with_room))
_material_of = by_record(0, (Own, _own), (Solved, _shared))


@kernel(allocates=True)
def stress_loop(given, points, p, tau, start, stop):
    """p/E' and |tau|/E' at points start..stop; ``given``: an alpha each, or the modes of one material."""
    prepared = _prepared(given)
    for i in range(start, stop):
        p[i], tau[i] = stress_at(
            _at(points.x, i), _at(points.kappa, i), _at(points.mu, i), _at(points.lam, i),
            _at(points.epsilon, i), _at(points.beta, i), _at(points.zeta, i), _material_of(prepared, i),
        )  # fmt: skip
