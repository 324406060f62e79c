"""Radau IIA collocation of any order, in the digits that Arb is asked for: a polynomial through a start and nodes.

(E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, Sect. IV.5.)
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from flint import arb
from numpy.typing import NDArray


@dataclass(frozen=True)
class Radau:
    """Nodes on (0, 1], the last of them 1, and what goes with them; made by :func:`radau`.

    ``slopes``: derivatives at the nodes from values at 0 and the nodes, ``matrix`` the latter part in doubles;
    ``weights``: of the integral; ``bary``: barycentric weights of the nodes; ``tail``: weights of the values at 0 and
    the nodes in the last Legendre coefficient.
    """

    nodes: list[Any]
    slopes: Any
    weights: list[Any]
    bary: list[Any]
    tail: list[Any]
    matrix: NDArray

    def at(self, values: list[list[Any]], theta: Any) -> list[Any]:
        """The polynomial through the nodes at the share ``theta`` of the step, not at a node."""
        shares = [w / (theta - c) for w, c in zip(self.bary, self.nodes, strict=True)]
        return [weighted(shares, column) / sum(shares) for column in zip(*values, strict=True)]


def weighted(weights: Sequence[Any], values: Sequence[Any]) -> Any:
    """Their sum."""
    return sum(w * value for w, value in zip(weights, values, strict=True)).mid()


@functools.cache
def radau(count: int, bits: int) -> Radau:
    """The method with ``count`` nodes, order 2 count - 1."""
    with flint.ctx.workprec(4 * bits + 20 * count):
        x = flint.fmpq_poly([-1, 2])
        lower, upper = flint.fmpq_poly([1]), x
        for n in range(1, count):
            lower, upper = upper, ((2 * n + 1) * x * upper - n * lower) / (n + 1)
        difference = (upper - lower) * (upper - lower).denom()
        roots = flint.fmpz_poly([int(c) for c in difference.coeffs()]).complex_roots()
        nodes = sorted((root.real for root, _ in roots), key=float)
        points = [arb(0), *nodes]
        bary, slopes = _barycentric(points), flint.arb_mat(count, count + 1)
        for i in range(1, count + 1):
            others = [m for m in range(count + 1) if m != i]
            for m in others:
                slopes[i - 1, m] = bary[m] / bary[i] / (points[i] - points[m])
            slopes[i - 1, i] = -sum(slopes[i - 1, m] for m in others)
        square = flint.arb_mat([[slopes[i, m] for m in range(1, count + 1)] for i in range(count)])
        weights = square.inv().entries()[-count:]
        tail = [w / math.comb(2 * count, count) for w in bary]
        matrix = np.array([float(value) for value in square.entries()]).reshape(count, count)
    return Radau(nodes, slopes, weights, _barycentric(nodes), tail, matrix)


def _barycentric(points: list[Any]) -> list[Any]:
    return [1 / math.prod(p - q for m, q in enumerate(points) if m != i) for i, p in enumerate(points)]
