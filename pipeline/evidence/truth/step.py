"""A step of a driven motion in extended precision: collocation, and the event that it ends on (:mod:`driven`)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from viscoroll.core.extras import imported

from .collocation import Radau
from .phases import Phase

#: iterations of a step, of which the first take a new matrix, and steps that look for an event
_MOST_ITERATIONS, _MATRICES, _CUTS = 14, 3, 12
#: by which an event is found between two nodes before steps are cut
_HALVINGS = 24
#: a correction below this share of the unknowns leaves nothing to be corrected
_LAST_CORRECTION = 1e-24
#: an event is met to this share of its function's largest value, and its slope taken over this share of a step
_MET, _BESIDE = 1e-28, 1e-8


def solved(phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau) -> list[list[Any]] | None:
    """Values at the nodes of one step; None where the iteration does not converge."""
    arb_mat = imported("flint", "python-flint", "dev").arb_mat
    n, start, length = len(method.nodes), phase.unknowns(), float(h)
    whole: NDArray[np.float64] = np.empty(0)
    for iteration in range(_MOST_ITERATIONS):
        defect = method.slopes * arb_mat([start, *values])
        residual, scale = np.empty(2 * n), np.tile(phase.sizes(values), n)
        whole = np.zeros((2 * n, 2 * n)) if iteration < _MATRICES else whole
        for i, u in enumerate(values):
            when = tau + h * method.nodes[i]
            rates, weights = phase.rates(u, when)
            here = slice(2 * i, 2 * i + 2)
            residual[here] = [float(weights[m] * defect[i, m] - h * rates[m]) for m in range(2)]
            if iteration >= _MATRICES:
                continue
            for m in range(2):
                whole[2 * i + m, m::2] = float(weights[m]) * method.matrix[i]
            for m in range(2):
                step = abs(u[m]) * type(h)(10) ** -14 + type(h)(10) ** -22 * (m or 1e-10)
                beside = list(u)
                beside[m] = u[m] + (step if u[m] >= 0 else -step)
                by = beside[m] - u[m]
                moved, heavier = phase.rates(beside, when)
                for k in range(2):
                    slope = float((moved[k] - rates[k]) / by)
                    weight = float((heavier[k] - weights[k]) / by * defect[i, k])
                    whole[2 * i + k, 2 * i + m] += weight - length * slope
        matrix = whole * scale
        rows = np.abs(matrix).max(axis=1)
        if not (np.isfinite(matrix).all() and np.isfinite(residual).all() and (rows > 0.0).all()):
            return None
        change = np.linalg.solve(matrix / rows[:, None], residual / rows)
        values = [
            [(u - float(d)).mid() for u, d in zip(value, by, strict=True)]
            for value, by in zip(values, (change * scale).reshape(n, 2), strict=True)
        ]
        if not np.isfinite(change).all() or np.abs(change).max() > 1e6:
            return None
        if np.abs(change).max() < _LAST_CORRECTION:
            return values
    return None


def met(
    phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau
) -> tuple[str | None, Any, list[list[Any]] | None]:
    """(Event, length, values) of a step that ends at the first event in it; no values where none was found."""
    start, events = phase.unknowns(), phase.events()
    event, share = _first(None, phase, tau, h, values, method)
    if event is None:
        return None, h, values
    length = (h * share).mid()
    for _ in range(_CUTS):
        guess = [method.at(start, values, length / h * c) for c in method.nodes]
        found = solved(phase, tau, length, guess, method)
        if found is None:
            break
        values, h = found, length
        earlier, share = _first(event, phase, tau, h, values, method)
        if earlier is not None:
            event, length = earlier, (h * share).mid()
            continue
        along = events[event][0]
        sizes = [abs(along(u, tau + h * c)) for u, c in zip(values, method.nodes, strict=True)]
        at_end = along(values[-1], tau + h)
        if abs(at_end) <= _MET * max(sizes):
            return event, h, values
        near = along(method.at(start, values, type(h)(1 - _BESIDE)), tau + h * (1 - _BESIDE))
        length = (h - at_end * _BESIDE * h / (at_end - near)).mid()
        if not 0 < length < 2 * h:
            break
    return None, h, None


def _first(
    known: str | None, phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau
) -> tuple[str | None, Any]:
    """(Event but the ``known`` one whose function first falls below what tells it, share of the step), or (None, 1)."""
    start = phase.unknowns()
    soonest: str | None = None
    least: Any = 1
    for event, (function, told) in phase.events().items():
        at_nodes = [function(u, tau + h * c) for u, c in zip(values, method.nodes, strict=True)]
        beyond = next((i for i, value in enumerate(at_nodes) if value < told), None)
        if event == known or beyond is None:
            continue

        def along(theta: Any, function: Any = function) -> Any:
            return function(method.at(start, values, theta), tau + h * theta)

        low, high = method.nodes[beyond - 1] if beyond else 0 * h, method.nodes[beyond]
        for _ in range(_HALVINGS):
            middle = ((low + high) / 2).mid()
            low, high = (middle, high) if along(middle) > 0 else (low, middle)
        if middle < least:
            soonest, least = event, middle
    return soonest, least
