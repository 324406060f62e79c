"""A step of a motion in extended precision: collocation of V and omega - V, and the event that it ends on."""

from __future__ import annotations

from typing import Any

import flint
import numpy as np
from flint import arb
from numpy.typing import NDArray

from .collocation import Radau, weighted
from .phases import NOTHING, Phase, root

#: iterations of a step, of which the first take a new matrix, and steps that look for an event
_MOST_ITERATIONS, _MATRICES, _CUTS = 14, 3, 12
#: a correction below this share of the unknowns leaves nothing to be corrected
_LAST_CORRECTION = 1e-26
#: an event is met to this share of a step, and looked for beyond its end by that one
_MET, _BEYOND = 1e-28, arb("1.001")
#: errors of omega - V are measured by no less than this part of its limit
_LEAST_SLIP = 1e-8


def solved(phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau) -> list[list[Any]] | None:
    """States at the nodes of one step, from a guess; None where the iteration does not converge."""
    n, start, length = len(method.nodes), list(phase.contact()[:2]), float(h)
    whole: NDArray[np.float64] = np.empty(0)
    scale = np.empty(0)
    for iteration in range(_MOST_ITERATIONS):
        rates = [_rates(phase, u, tau + h * c) for u, c in zip(values, method.nodes, strict=True)]
        defect = method.slopes * flint.arb_mat([start, *(state for state, _ in rates)])
        residual = np.array([float(defect[i, k] - h * rates[i][1][k]) for i in range(n) for k in range(2)])
        if iteration < _MATRICES:
            size = np.abs(np.array([[float(part) for part in u] for u in values])).max(axis=0)
            fastest = max(abs(float(state[0])) for state, _ in rates)
            scale = np.tile(np.maximum(size, [1e-200, 1e-8 if phase.sticks else 1e-8 * fastest + 1e-200]), n)
            whole = np.zeros((2 * n, 2 * n))
            for i, u in enumerate(values):
                for m in range(2):
                    by = -(arb(10) ** -14) * abs(u[m]) - arb(10) ** -22 * (1e-10 if m == 0 else 1)
                    beside = [part + by * (k == m) for k, part in enumerate(u)]
                    moved = _rates(phase, beside, tau + h * method.nodes[i])
                    slopes = [
                        [float((a - b) / by) for a, b in zip(*pair)] for pair in zip(moved, rates[i], strict=True)
                    ]
                    for k in range(2):
                        whole[k::2, 2 * i + m] = method.matrix[:, i] * slopes[0][k]
                        whole[2 * i + k, 2 * i + m] -= length * slopes[1][k]
        matrix = whole * scale
        rows = np.abs(matrix).max(axis=1)
        if not (np.isfinite(matrix).all() and np.isfinite(residual).all() and (rows > 0.0).all()):
            return None
        change = np.linalg.solve(matrix / rows[:, None], residual / rows)
        by_node = (change * scale).reshape(n, 2)
        values = [
            [(u - float(d)).mid() for u, d in zip(*pair, strict=True)] for pair in zip(values, by_node, strict=True)
        ]
        beyond = phase.sticks and any(u[1] > 1 + NOTHING for u in values)
        if beyond or not np.isfinite(change).all() or np.abs(change).max() > 1e6:
            return None
        if np.abs(change).max() < _LAST_CORRECTION:
            return values
    return None


def _rates(phase: Phase, u: list[Any], tau: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """V and omega - V of a state, and their rates."""
    c = phase.contact(u)
    return (c.V, c.slip), phase.pushed(c, tau)


def met(phase: Phase, tau: Any, h: Any, method: Radau) -> tuple[str | None, Any, list[list[Any]] | None]:
    """(Event, length, states at the nodes) of a step up to h that ends at the first event; None where none is found."""
    values = solved(phase, tau, h, phase.guess([h * c for c in method.nodes], tau), method)
    event = None
    for _ in range(_CUTS):
        if values is None:
            break
        event, share = _first(event, phase, tau, h, values, method)
        if event is None or abs(share - 1) < _MET:
            return event, h, values
        guess = [method.at(values, share * c) for c in method.nodes]
        h = (h * share).mid()
        values = solved(phase, tau, h, guess, method)
    return None, h, None


def _first(
    known: str | None, phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau
) -> tuple[str | None, Any]:
    """(Event whose function first falls below 0, share of the step), that of the ``known`` one maybe beyond its end."""
    soonest, least = None, _BEYOND
    for event, function in phase.events().items():

        def along(theta: Any, function: Any = function) -> Any:
            return function(method.at(values, theta), tau + h * theta)

        nodes = [arb(0), *method.nodes, _BEYOND]
        told = [function(u, tau + h * c) for u, c in zip(values, method.nodes, strict=True)]
        told += [along(_BEYOND)] if event == known else []
        beyond = next((i for i, value in enumerate(told) if value < -NOTHING * (event == "no creep")), None)
        if beyond is None:
            continue
        share = root(lambda theta: -along(theta), nodes[beyond], nodes[beyond + 1])
        if share < least:
            soonest, least = event, share
    return soonest, least


def left_out(phase: Phase, values: list[list[Any]], method: Radau) -> float:
    """The last Legendre coefficients of V and omega - V, over the largest of them in the step."""
    states = [phase.contact(), *map(phase.contact, values)]
    fastest = max(max(abs(float(c.V)), abs(float(c.omega))) for c in states)
    slip = max(max(abs(float(c.slip)), _LEAST_SLIP * float(c.limit)) for c in states) if phase.sticks else fastest
    sizes = max(fastest, 1e-200), max(slip, 1e-200)
    return max(abs(float(weighted(method.tail, [c[k] for c in states]))) / sizes[k] for k in range(2))
