"""N of M = M(V) + N V', and the added mass gamma N of a law that has it; 0 of a law of steady rolling.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import inline_kernel, kernel
from .contact_states import element
from .evaluate import locate_octave
from .record import ALPHA, E0, ROW_COUNT
from .simd_polynomial import TERMS, evaluate_pair

#: Added mass gamma N at V = 0, in units of the mass, below which V = 0 is not reached.
_HEAVY = -4.0


@inline_kernel
def _evaluate_N(u, law):
    """Return N, its integral and its slope at u, with the row in which they were evaluated.

    u : kappa |V|, dimensionless.
    law : :class:`Law` of the material, with polynomials of N.

    Returns (row, N, integral, slope): number of the row, or the number of rows where u lies behind the last one; N;
    its integral with respect to u from the place where the argument t of that row is 0; its slope with respect to u.
    """
    row, t, dt_dx = locate_octave(u, law.marks[E0])
    count = law.marks[ROW_COUNT]
    alpha = law.rows[ALPHA]
    if row < count:
        N, integral, slope, _, _, _ = evaluate_pair(law.N_rows, row * 2 * TERMS, t)
        return row, N, integral, slope * dt_dx
    integral = -(alpha - 1.0) / (16.0 * alpha * u)
    return count, -integral / u, integral, 2.0 * integral / (u * u)


@kernel
def _evaluate_added_mass(law, V, kappa, gamma):
    """Return the factor gamma N of the added mass, with its slope and its integral, for a law that has N.

    The integral begins at V = 0 or, where V = 0 is out of reach, at infinity.

    law : :class:`Law` of the material, with polynomials of N.
    V : speed of the axis.
    kappa : slenderness R/l0.
    gamma : mass parameter, Eq. (4), dimensionless.
    Returns (gamma N, its slope with respect to V, its integral with respect to V), dimensionless.
    """
    count = law.marks[ROW_COUNT]
    row, N, integral, slope = _evaluate_N(kappa * abs(V), law)
    # the integral starts at V = 0 if that is reached, where no digits may cancel; else at infinity
    start = count * 2 * TERMS + (count + 1 if gamma * law.N_rows[0] > _HEAVY else 0)
    integral += law.N_rows[start + row]
    if V < 0.0:  # continued from V = 0
        integral = 2.0 * law.N_rows[start] - integral
    return gamma * N, gamma * np.copysign(kappa, V) * slope, gamma * integral / kappa


@inline_kernel
def added_mass(law, V, kappa, gamma):
    """Return the factor gamma N of the added mass, with its slope and its integral.

    The integral begins at V = 0 or, where V = 0 is out of reach, at infinity.

    law : :class:`Law` of the material: polynomials of each octave.
    V : speed.
    kappa : slenderness R/l0.
    gamma : mass parameter, Eq. (4), dimensionless.
    Returns (gamma N, its slope with respect to V, its integral with respect to V), dimensionless; zeros for a law of
    steady rolling.
    """
    return _evaluate_added_mass(law, V, kappa, gamma) if unlikely(law.N_rows.size > 0) else (0.0, 0.0, 0.0)


@kernel
def unsteady_loop(law, kappa, V, out):
    """Write N of states into ``out``; ``kappa`` and ``V`` have one value or one for each state; ``law`` has N."""
    for n in range(out.size):
        _, out[n], _, _ = _evaluate_N(element(kappa, n) * abs(element(V, n)), law)
