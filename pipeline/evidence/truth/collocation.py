"""Radau IIA collocation of any order for small stiff systems, in the digits that Arb is asked for.

A step (:mod:`step`) solves u' = f(u) at the nodes for the polynomial of degree n through the start.  (E. Hairer, G.
Wanner, Solving Ordinary Differential Equations II, Springer 1996, Sect. IV.5.)
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viscoroll.core.extras import imported


@dataclass(frozen=True)
class Radau:
    """Nodes on (0, 1], the last of them 1, and what goes with them; made by :func:`radau`.

    ``slopes``: derivatives at the nodes from values at 0 and the nodes; ``weights``: of the integral;
    ``bary``: barycentric weights of 0 and the nodes; ``tail``: last Legendre coefficients of the
    polynomials through all points and through the nodes alone.
    """

    nodes: list[Any]
    slopes: Any
    weights: list[Any]
    bary: list[Any]
    tail: tuple[list[Any], list[Any]]
    matrix: NDArray

    def at(self, start: Sequence[Any], values: list[list[Any]], theta: Any) -> list[Any]:
        """The polynomial at the share ``theta`` of the step, not at a node."""
        shares = [w / (theta - c) for w, c in zip(self.bary, [0, *self.nodes], strict=True)]
        whole = sum(shares)
        points = [start, *values]
        return [
            (sum(share * point[m] for share, point in zip(shares, points, strict=True)) / whole).mid()
            for m in range(len(start))
        ]

    def tails(self, start: Sequence[Any], values: list[list[Any]]) -> list[float]:
        """For every unknown what the polynomial leaves out: the larger of two last Legendre coefficients."""
        both = ((self.tail[0], [start, *values]), (self.tail[1], values))
        return [
            max(abs(float(sum(w * point[m] for w, point in zip(row, points, strict=True)))) for row, points in both)
            for m in range(len(start))
        ]

    def integral(self, rates: list[Any]) -> Any:
        """Over [0, 1], of what has these values at the nodes."""
        return sum(w * rate for w, rate in zip(self.weights, rates, strict=True)).mid()


@functools.cache
def radau(count: int, bits: int) -> Radau:
    """The method with ``count`` nodes, order 2 count - 1."""
    flint = imported("flint", "python-flint", "dev")
    with flint.ctx.workprec(4 * bits + 20 * count):
        nodes = _nodes(flint, count)
        points = [flint.arb(0), *nodes]
        bary = _barycentric(points)
        slopes = flint.arb_mat(count, count + 1)
        for i in range(1, count + 1):
            others = [m for m in range(count + 1) if m != i]
            for m in others:
                slopes[i - 1, m] = bary[m] / bary[i] / (points[i] - points[m])
            slopes[i - 1, i] = -sum(slopes[i - 1, m] for m in others)
        tail = _last_coefficient(bary), _last_coefficient(_barycentric(nodes))
        weights = [_integral_of_node(flint, nodes, i) for i in range(count)]
        matrix = np.array([[float(slopes[i, m]) for m in range(1, count + 1)] for i in range(count)])
    return Radau(nodes, slopes, weights, bary, tail, matrix)


def _barycentric(points: list[Any]) -> list[Any]:
    return [1 / math.prod(p - q for m, q in enumerate(points) if m != i) for i, p in enumerate(points)]


def _last_coefficient(bary: list[Any]) -> list[Any]:
    """Weights of the values in the last Legendre coefficient of their polynomial."""
    degree = len(bary) - 1
    return [w / math.comb(2 * degree, degree) for w in bary]


def _nodes(flint: Any, count: int) -> list[Any]:
    """Roots of P_n - P_(n-1), shifted to (0, 1]."""
    x = flint.fmpq_poly([-1, 2])
    lower, upper = flint.fmpq_poly([1]), x
    for n in range(1, count):
        lower, upper = upper, ((2 * n + 1) * x * upper - n * lower) / (n + 1)
    difference = upper - lower
    roots = flint.fmpz_poly([int(c * difference.denom()) for c in difference.coeffs()]).complex_roots()
    return sorted((root.real for root, _ in roots), key=float)


def _integral_of_node(flint: Any, nodes: list[Any], i: int) -> Any:
    """Of the Lagrange polynomial that is 1 at node ``i``."""
    poly = flint.arb_poly([1])
    for m, node in enumerate(nodes):
        if m != i:
            poly *= flint.arb_poly([-node, 1]) * (1 / (nodes[i] - node))
    return poly.integral()(flint.arb(1))
