"""The law and the stresses of states that have a material each, as :mod:`rolling_contact` asks for them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .blocks import flattened
from .materials.bodies import Bodies
from .materials.prony_array import MaterialArray
from .materials.tables import records, series


def states_each(materials: MaterialArray, per_speed: set[str]) -> Callable:
    """``state_loop`` of states with a material each, each in its own time; it takes their numbers for the material."""
    from .kernels.law.contact_loop import state_loop
    from .kernels.law.states import ROWS

    def loop(numbers: NDArray, states: Any, need: Any, rows: NDArray, out: NDArray, start: int, stop: int) -> Any:
        record, unit = records(materials, numbers.astype(np.int64))
        states = states._replace(V=_times(states.V, unit))
        if states.creep_is_omega:
            states = states._replace(creep=_times(states.creep, unit))
        status = state_loop(record, states, need, rows, out, start, stop)
        for n, row in enumerate(rows):
            if ROWS[row] in per_speed:
                out[n] *= unit
        return status

    return loop


def _times(values: NDArray, unit: NDArray) -> NDArray:
    return flattened(values * unit, np.broadcast_shapes(values.shape, unit.shape))


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
