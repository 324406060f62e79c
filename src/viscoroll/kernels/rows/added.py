"""N of M = M(V) + N V', and the added mass gamma N of a law that has one; 0 of one of steady rolling."""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import kernel
from . import lanes
from .law import octave
from .record import ALPHA, COUNT, E0
from .states import element

#: gamma N at V = 0 from which on it is out of reach
_HEAVY = -4.0


@kernel(inline=True)
def _unsteady(u, law):
    """(Row, N, its integral from where the row begins, the slope of N over u) at u = kappa |V|."""
    row, t, per = octave(u, law.marks[E0])
    count, alpha = law.marks[COUNT], law.rows[ALPHA]
    if row < count:
        N, whole, slope, _, _, _ = lanes.pair(law.added, row * 2 * lanes.TERMS, t)
        return row, N, whole, slope * per
    whole = -(alpha - 1.0) / (16.0 * alpha * u)
    return count, -whole / u, whole, 2.0 * whole / (u * u)


@kernel
def _added(law, V, kappa, gamma):
    """(gamma N, its slope over V, its integral) of a law that has them."""
    count, (row, N, whole, slope) = law.marks[COUNT], _unsteady(kappa * abs(V), law)
    # where V = 0 is in reach no digits may cancel there, else none at high speeds
    start = count * 2 * lanes.TERMS + (count + 1 if gamma * law.added[0] > _HEAVY else 0)
    whole += law.added[start + row]
    if V < 0.0:  # on from V = 0
        whole = 2.0 * law.added[start] - whole
    return gamma * N, gamma * np.copysign(kappa, V) * slope, gamma * whole / kappa


@kernel(inline=True)
def added_mass(law, V, kappa, gamma):
    """(gamma N, its slope over V, its integral)."""
    return _added(law, V, kappa, gamma) if unlikely(law.added.size > 0) else (0.0, 0.0, 0.0)


@kernel
def unsteady_loop(law, kappa, V, out):
    """N of states, one value of kappa and V, or one each."""
    for n in range(out.size):
        _, out[n], _, _ = _unsteady(element(kappa, n) * abs(element(V, n)), law)
