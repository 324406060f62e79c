"""The stresses of points that have a material each."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .blocks import flattened
from .materials.bodies import Bodies
from .materials.prony_array import MaterialArray
from .materials.tables import series


def stresses_each(materials: MaterialArray) -> Callable:
    """``stress_loop`` over points with a material each, which lie together where they share one."""
    from .kernels.law.stress_loop import stress_loop
    from .kernels.material.functions import Own

    def loop(numbers: NDArray, points: Any, p: NDArray, tau: NDArray, start: int, stop: int) -> None:
        for first, last in pairwise([start, *(1 + np.flatnonzero(np.diff(numbers))), stop]):
            own, unit = materials[int(numbers[min(first, numbers.size - 1)])].in_own_time()
            own = own.total if isinstance(own, Bodies) else own
            some = points._make(part[first:last] if part.size > 1 else part for part in points)
            some = some._replace(zeta=flattened(some.zeta / unit, some.zeta.shape))
            given = series(own) if own.E.size else Own(flattened(np.ones(1), (1,)))
            stress_loop(given, some, p[first:last], tau[first:last], 0, last - first)

    return loop
