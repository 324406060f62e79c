"""The added mass gamma N of a law that has one; 0, and nothing to compute, of one of steady rolling."""

from __future__ import annotations

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from . import lanes
from .law import octave
from .record import ALPHA, COUNT, E0, Law, UnsteadyLaw

#: gamma N at V = 0 from which on it is out of reach
_HEAVY = -4.0


@kernel(inline=True)
def _nothing(law, V, kappa, gamma):
    return 0.0, 0.0, 0.0


@kernel(inline=True)
def _added(law, V, kappa, gamma):
    u, alpha = kappa * abs(V), law.rows[ALPHA]
    row, t, per = octave(u, law.marks[E0])
    count = law.marks[COUNT]
    # where V = 0 is in reach no digits may cancel there, else none at high speeds
    start = count * 2 * lanes.TERMS + (count + 1 if gamma * law.added[0] > _HEAVY else 0)
    if row < count:
        N, whole, slope, _ = lanes.pair_slopes(law.added, row * 2 * lanes.TERMS, t)
        slope *= per
    else:
        row, whole = count, -(alpha - 1.0) / (16.0 * alpha * u)
        N, slope = -whole / u, 2.0 * whole / (u * u)
    whole += law.added[start + row]
    if V < 0.0:  # on from V = 0
        whole = 2.0 * law.added[start] - whole
    return gamma * N, gamma * np.copysign(kappa, V) * slope, gamma * whole / kappa


#: (law, V, kappa, gamma) -> (gamma N, its slope over V, its integral)
added_mass = by_record(0, (Law, _nothing), (UnsteadyLaw, _added))
