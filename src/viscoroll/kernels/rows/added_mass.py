"""Added mass: N of M = M(V) + N V', the rolling moment while the speed changes slowly, and the factor gamma N.

Moments are divided by P R, speeds by R/T_epsilon, times by T_epsilon: N is in units of P T_epsilon^2.  A law of steady
rolling has no N; its added mass is 0.  A law with N has it as polynomials over octaves of u = kappa |V|
(``Law.N_rows``: for each row N and its integral over u, a pair; after the rows the constants of the integral).
That of a cover has NaN in its place.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.intrinsics import unlikely
from ..compile.jit import inline_kernel, kernel
from .contact_states import element
from .evaluate import locate_octave
from .record import ALPHA, E0, ROW_COUNT
from .simd_polynomial import TERMS, evaluate_pair

#: Added mass gamma N at V = 0, in units of the mass, at or below which V = 0 is not reached: a motion in partial slip
#: ends where gamma N falls to -1, if not before (``added_mass_margin`` of the kernels of motion), far from -4.
_HEAVY = -4.0


@inline_kernel
def _evaluate_N(u, law):
    """Return N of M = M(V) + N V' at u, its integral and its slope, with the row in which they were evaluated.

    u : float, kappa |V|, dimensionless, >= 0, finite.
    law : :class:`Law` of the material, with polynomials of N; those of a cover are NaN.  Read are ``N_rows``, e0 and
        the number of rows in ``marks``, and alpha in ``rows``.

    Returns (row, N, integral, slope).  row: int, index of the row from 0, or the number of rows where u lies beyond the
    last one and N has its fast limit (alpha - 1)/(16 alpha u^2).  N: float, in units of P T_epsilon^2.  integral:
    float, its integral over u from the place where the argument t of that row is 0 (beyond the last row: from
    infinity).  slope: float, dN/du.  Of a cover the last three are NaN in its rows; beyond the last row they are finite
    and mean nothing.
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

    The integral begins at V = 0 or, where a motion cannot reach V = 0 (gamma N <= -4 there), at infinity.

    law : :class:`Law` of the material, with polynomials of N; those of a cover are NaN.
    V : float, speed of the axis, of either sign, finite, dimensionless; N is even in V.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    gamma : float, P T_epsilon^2/(m R), Eq. (4), dimensionless.
    Returns (gamma N, its slope over V, its integral over V), floats, dimensionless.  The slope is odd in V; at V = 0.0
    it is that of V > 0.  The integral is continuous at V = 0, and odd in V where it begins there.  Of a cover all three
    are NaN in its rows; beyond the last row they mean nothing.
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
    """Return the factor gamma N of the added mass, with its slope and its integral; zeros for a law of steady rolling.

    It is :func:`_evaluate_added_mass` behind a test, which is inlined so that steady rolling costs nothing else.
    The integral begins at V = 0 or, where a motion cannot reach V = 0 (gamma N <= -4 there), at infinity.

    law : :class:`Law` of the material: polynomials of each octave; ``N_rows`` is empty for steady rolling, where
        nothing else is read.
    V : float, speed of the axis, of either sign, finite, dimensionless; N is even in V.
    kappa : float, slenderness R/l0, dimensionless, > 0.
    gamma : float, P T_epsilon^2/(m R), Eq. (4), dimensionless.
    Returns (gamma N, its slope over V, its integral over V), floats, dimensionless; (0.0, 0.0, 0.0) for steady rolling.
    The slope is odd in V; at V = 0.0 it is that of V > 0.  The integral is continuous at V = 0, and odd in V where it
    begins there.  Of a cover that has ``N_rows`` all three are NaN in its rows; beyond the last row they mean nothing.
    """
    return _evaluate_added_mass(law, V, kappa, gamma) if unlikely(law.N_rows.size > 0) else (0.0, 0.0, 0.0)


@kernel
def unsteady_loop(law, kappa, V, out):
    """Write N of n states into an array.

    law : :class:`Law` that has N (``N_rows`` is not empty); marks, rows and ``N_rows`` are read.
    kappa, V : slenderness, > 0, and speed, of either sign, finite, dimensionless, of length 1 or n.
    out : (n,) floats, written: N in units of P T_epsilon^2.  Of a cover it is NaN in the rows of the law, and without
        meaning beyond the last row.  Returns nothing.
    """
    for n in range(out.size):
        _, out[n], _, _ = _evaluate_N(element(kappa, n) * abs(element(V, n)), law)
