"""Eq. (22) without drive by RODAS on a law of numba: what an integrator of one's own takes.

Hairer and Wanner's method of order 4, L-stable, with the law's slopes for its Jacobian, as in ``vr_roll.h``.  The state
is V and the slip omega - V; sliding and sticking are no events, for the slope of Q is continuous where stick ends.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

_A5 = (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950)
_A = (
    (), (1.544,), (0.9466785280815826, 0.2557011698983284),
    (3.314825187068521, 2.896124015972201, 0.9986419139977817), _A5, (*_A5, 1.0),
)  # fmt: skip
_C = (
    (), (-5.6688,), (-2.430093356833875, -0.2063599157091915),
    (-0.1073529058151375, -9.594562251023355, -20.47028614809616),
    (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160),
    (8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054),
)  # fmt: skip
A, C = (np.array([(*row, *[0.0] * (6 - len(row))) for row in rows]) for rows in (_A, _C))


@numba.njit
def rates(law: Any, gamma: float, j: float, V: float, slip: float) -> Any:
    """Of V and slip, and their slopes."""
    f = law(V, V + slip)
    a, b, grip = 1.0 + 1.0 / j, 1.0 / j, f.dQ_dV + f.dQ_domega
    return (
        gamma * (f.Q - f.M_half_space), gamma * (-a * f.Q - b * f.M_cylinder + f.M_half_space),
        gamma * (grip - f.dM_half_space_dV), gamma * f.dQ_domega,
        gamma * (-a * grip - b * f.dM_cylinder_dV + f.dM_half_space_dV), -gamma * a * f.dQ_domega,
    )  # fmt: skip


@numba.njit
def rolled(
    law: Any, gamma: float, j: float, star: float, start: tuple[float, float], t: NDArray, rtol: float
) -> NDArray:
    """V and omega at the times t, NaN from where it stops; errors of slip count as at the creep ``star`` below that."""
    y, z, k = np.array([start[0], start[1] - start[0]]), np.empty(2), np.zeros((6, 2))
    found, now, h = np.full((2, t.size), np.nan), t[0], 1e-3 * (t[-1] - t[0])
    for n in range(t.size):
        while now < t[n]:
            last = now + h >= t[n]
            step = t[n] - now if last else h
            f0, f1, J00, J01, J10, J11 = rates(law, gamma, j, y[0], y[1])
            d = 4.0 / step
            a, e = d - J00, d - J11
            whole = a * e - J01 * J10
            for i in range(6):
                z[:] = y
                p = q = 0.0
                for m in range(i):
                    z += A[i, m] * k[m]
                    p, q = p + C[i, m] * k[m, 0], q + C[i, m] * k[m, 1]
                if i:
                    f0, f1, _, _, _, _ = rates(law, gamma, j, z[0], z[1])
                p, q = f0 + p / step, f1 + q / step
                k[i] = (e * p + J01 * q) / whole, (a * q + J10 * p) / whole
            z += k[5]
            size = max(abs(y[0]), abs(z[0]))
            error = max(abs(k[5, 0]) / size, abs(k[5, 1]) / max(abs(y[1]), abs(z[1]), star * size)) / rtol
            grown = step * min(max(0.9 * max(error, 1e-9) ** -0.25, 0.2), 5.0)
            if error <= 1.0:
                now, h = (t[n], max(h, grown)) if last else (now + step, grown)
                y[:] = z
            else:
                h = grown
                if not h > 1e-14 * t[-1]:
                    return found
        found[0, n], found[1, n] = y[0], y[0] + y[1]
    return found
