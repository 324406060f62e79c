"""What building any table needs: solves on threads, points off the nodes, errors in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..blocks import solve_blocks

#: Pairs of the two outer axes that a thread solves at a time.
_BLOCK = 128
#: Seed of the random half of the off-node sample: an error map can be had again.
SEED = 20260101
NODE_ERROR = "nodes are root solves, error below 1e-12 of the largest value of each field"


def run(solve: Callable[[int, int], int], count: int, threads: int | None, label: str | None) -> None:
    """Run ``solve(start, stop) -> status`` over all blocks."""
    problem = "tables: an iteration hit its cap near pair {} of the two outer axes"
    solve_blocks(solve, count, _BLOCK, problem, threads=threads, progress=label)


def off_nodes(nodes: NDArray, random: np.random.Generator, count: int = 1) -> NDArray:
    """Middle and ``count`` random points of every cell between ``nodes``, in order."""
    low, width = nodes[:-1], np.diff(nodes)
    offsets = np.sort(np.vstack([np.full(low.size, 0.5), random.uniform(0.02, 0.98, (count, low.size))]), axis=0)
    return (low + width * offsets).T.reshape(-1)


def tolerances(method: str, measured: dict[str, Any], allowed: dict[str, float]) -> str:
    """The errors of a table, measured by ``method``, in a sentence for its attributes."""
    parts = [
        f"{name} {error:.2g}" + (f" (allowed {allowed[name]:.2g})" if name in allowed else "")
        for name, error in measured.items()
    ]
    return f"{NODE_ERROR}; largest measured absolute error {method} off the nodes: " + ", ".join(parts)
