"""N of M = M(V) + N V', and the added mass gamma N of a law that has one; 0 of one of steady rolling."""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import kernel
from .contact_states import element
from .evaluate import locate_octave
from .record import ALPHA, E0, ROW_COUNT
from .simd_polynomial import TERMS, evaluate_pair

#: gamma N at V = 0 from which on it is out of reach
_HEAVY = -4.0


@kernel(inline=True)
def _evaluate_N(u, law):
    """(Row, N, its integral from where the row begins, the slope of N over u) at u = kappa |V|."""
    row, t, per = locate_octave(u, law.marks[E0])
    count, alpha = law.marks[ROW_COUNT], law.rows[ALPHA]
    if row < count:
        N, whole, slope, _, _, _ = evaluate_pair(law.N_rows, row * 2 * TERMS, t)
        return row, N, whole, slope * per
    whole = -(alpha - 1.0) / (16.0 * alpha * u)
    return count, -whole / u, whole, 2.0 * whole / (u * u)


@kernel
def _added(law, V, kappa, gamma):
    """(gamma N, its slope over V, its integral) of a law that has them."""
    count, (row, N, whole, slope) = law.marks[ROW_COUNT], _evaluate_N(kappa * abs(V), law)
    # where V = 0 is in reach no digits may cancel there, else none at high speeds
    start = count * 2 * TERMS + (count + 1 if gamma * law.N_rows[0] > _HEAVY else 0)
    whole += law.N_rows[start + row]
    if V < 0.0:  # on from V = 0
        whole = 2.0 * law.N_rows[start] - whole
    return gamma * N, gamma * np.copysign(kappa, V) * slope, gamma * whole / kappa


@kernel(inline=True)
def added_mass(law, V, kappa, gamma):
    """(gamma N, its slope over V, its integral)."""
    return _added(law, V, kappa, gamma) if unlikely(law.N_rows.size > 0) else (0.0, 0.0, 0.0)


@kernel
def unsteady_loop(law, kappa, V, out):
    """N of states, one value of kappa and V, or one each."""
    for n in range(out.size):
        _, out[n], _, _ = _evaluate_N(element(kappa, n) * abs(element(V, n)), law)
