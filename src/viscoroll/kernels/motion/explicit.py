"""One step of the explicit method DOP853 (:mod:`dop853`) on the four unknowns of a motion.

It serves a boundary layer that :mod:`layer_phase` gives up, which has to be resolved in any case.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .dop853 import E3, E5, EXTENDED, STAGES, A, B, D
from .partial_slip import partial_rates, partial_rhs

#: columns 1 and 2 of the weights are empty from this row on
_DENSE_FROM, _SECOND = 5, 3


@kernel
def slope_at(u, scene, slope):
    """Fill ``slope`` with the right-hand side at u; the rate at which the offset relaxes there."""
    dy, d_offset, V, delta, _, _, relaxation, _, _ = partial_rates(u[0], u[1], scene)
    slope[0], slope[1], slope[2], slope[3] = dy, d_offset, V, V * (1.0 + delta)
    return -relaxation


@kernel
def _stage(i, u, h, scene, K):
    """Slope number i from those before it."""
    s0, s1 = A[i, 0] * K[0, 0], A[i, 0] * K[0, 1]
    for n in range(_SECOND if i >= _DENSE_FROM else 1, i):
        s0 += A[i, n] * K[n, 0]
        s1 += A[i, n] * K[n, 1]
    K[i, 0], K[i, 1], K[i, 2], K[i, 3] = partial_rhs(u[0] + h * s0, u[1] + h * s1, scene)


@kernel
def explicit_step(u, h, scene, K, new, error):
    """Advance u by h into ``new``, local errors into ``error``; K[0] holds the slope at u."""
    # rows ahead hold the sums that their stages start from: no sum waits for its own last term
    first, second = K[0, 0], K[0, 1]
    for row in range(1, STAGES):
        K[row, 0], K[row, 1] = A[row, 0] * first, A[row, 0] * second
    for i in range(1, STAGES):
        first, second, third, fourth = partial_rhs(u[0] + h * K[i, 0], u[1] + h * K[i, 1], scene)
        K[i, 0], K[i, 1], K[i, 2], K[i, 3] = first, second, third, fourth
        for row in range(i + 1, STAGES):
            K[row, 0] += A[row, i] * first
            K[row, 1] += A[row, i] * second
    for m in range(4):
        total, five, three = B[0] * K[0, m], E5[0] * K[0, m], E3[0] * K[0, m]
        for n in range(5, STAGES):
            total += B[n] * K[n, m]
            five += E5[n] * K[n, m]
            three += E3[n] * K[n, m]
        new[m] = u[m] + h * total
        whole = np.sqrt(five * five + 0.01 * three * three)
        error[m] = h * five * (five / whole) if whole > 0.0 else whole


@kernel
def explicit_dense_terms(u, new, h, scene, K, terms):
    """Coefficients of the dense output of the step whose slopes are in K, with that at ``new`` in K[12]."""
    for i in range(STAGES + 1, EXTENDED):
        _stage(i, u, h, scene, K)
    for m in range(4):
        rise = new[m] - u[m]
        terms[0, m] = h * K[0, m] - rise
        terms[1, m] = 2.0 * rise - h * (K[12, m] + K[0, m])
        for row in range(4):
            total = 0.0
            for n in range(EXTENDED):
                total += D[row, n] * K[n, m]
            terms[2 + row, m] = h * total
