"""The integrator of the benchmark: RODAS3 on any law that compiled code may call, and the law by
root solves for it.

RODAS3: A. Sandu and others, Atmospheric Environment 31 (1997), 3459-3472; order 3, L-stable, 4
stages.  State: V and the slip omega - V, which would drown in the rounding of omega and V.  Full
slip, partial slip and reversal are no events.
"""

from __future__ import annotations

import numba
import numpy as np
from numba import carray
from numba.core import types

import viscoroll as vr
from viscoroll.kernels.law.law_callables import RESULTS, LawType
from viscoroll.kernels.law.printed_law import (
    direct_contact_length,
    direct_delta_star,
    direct_moment,
    direct_stick,
    direct_traction,
)
from viscoroll.kernels.numerics.deferred_compilation import EntryPipeline
from viscoroll.kernels.numerics.intrinsics import function_address, record_at
from viscoroll.kernels.numerics.jit import kernel

#: Steps of a motion before it is given up: some hundred times what the paper's motions take at the
#: tightest tolerance.
MOST_STEPS = 100_000
#: Speeds below this part of the first count as this, in what the tolerance is of.
_FLOOR = 1e-10
#: Relative step of the differences that slopes of root solves are: it costs half of the digits.
_STEP = 1e-8
#: User data of the root solves: address of their function, and the scene.
_SCENE = np.dtype(
    [("function", np.int64), ("alpha", np.float64), ("kappa", np.float64), ("mu", np.float64)]
)


@numba.njit(error_model="numpy")
def _rates(f, gamma, j):
    """dV/dt and d(slip)/dt of Eq. (22) as one complex number, of a law's
    :class:`LoadsAndSlopes`.
    """
    return gamma * complex(f.Q - f.M_half_space, f.M_half_space - f.Q - (f.Q + f.M_cylinder) / j)


@numba.njit(error_model="numpy")
def _solve(k, matrix):
    """Solution of a system of two equations, (p, q; r, s), whose right side and unknowns are
    complex numbers.
    """
    p, q, r, s = matrix
    return complex(s * k.real - q * k.imag, p * k.imag - r * k.real) / (p * s - q * r)


@numba.njit(error_model="numpy")
def motions(law, gamma, j, mu_over_kappa, V0, omega0, t, rtol, out):
    """Integrate Eq. (22) from each start, and put V and omega at the times ``t`` into ``out``; NaN
    where it gives up.

    law : of ``vr.law(...).jitted``, or a :class:`RootSolves`.
    gamma, j, mu_over_kappa : of the scene.
    V0, omega0 : starts.
    out : (2, starts, times).
    """
    for m in range(V0.size):
        y = complex(V0[m], omega0[m] - V0[m])
        now = 0.0
        h = 1e-6 * t[-1]
        steps = 0
        floor = _FLOOR * (abs(y.real) + abs(y.imag))
        for n in range(t.size):
            while now < t[n] and steps < MOST_STEPS:
                steps += 1
                step = min(h, t[n] - now)
                f = law(y.real, y.real + y.imag)
                over_V = f.dQ_dV + f.dQ_domega
                over_slip = f.dQ_domega
                a = over_V - f.dM_half_space_dV
                b = over_V + f.dM_cylinder_dV
                matrix = (
                    2 / step - gamma * a,
                    -gamma * over_slip,
                    gamma * (a + b / j),
                    2 / step + gamma * (1 + 1 / j) * over_slip,
                )
                rates = _rates(f, gamma, j)
                k1 = _solve(rates, matrix)
                k2 = _solve(rates + 4 * k1 / step, matrix)
                z = y + 2 * k1
                rates = _rates(law(z.real, z.real + z.imag), gamma, j)
                k3 = _solve(rates + (k1 - k2) / step, matrix)
                z += k3
                rates = _rates(law(z.real, z.real + z.imag), gamma, j)
                k4 = _solve(rates + (k1 - k2 - 8 / 3 * k3) / step, matrix)
                z += k4
                size = max(abs(y.real), abs(z.real), floor)
                band = max(abs(y.imag), abs(z.imag), mu_over_kappa * size)
                error = max(abs(k4.real) / size, abs(k4.imag) / band) / rtol
                if error <= 1:
                    y = z
                    now = t[n] if step == t[n] - now else now + step
                grown = (
                    step * min(max(0.9 * error ** (-1 / 3), 0.2), 5.0) if error >= 0 else 0.2 * step
                )
                h = max(h, grown) if error <= 1 and step < h else grown
            done = now >= t[n]
            out[0, m, n], out[1, m, n] = (y.real, y.real + y.imag) if done else (np.nan, np.nan)


@kernel
def _loads(V, omega, scene):
    """(Q, M) by two root solves of the printed equations."""
    alpha = scene.alpha
    kappa = scene.kappa
    mu = scene.mu
    speed = abs(V)
    delta = abs((omega - V) / V)
    lam, zeta, epsilon, _ = direct_contact_length(kappa * speed, alpha)
    Q = mu
    if delta < direct_delta_star(kappa, mu, lam, epsilon):
        beta, _ = direct_stick(delta, kappa, mu, lam, epsilon, zeta, alpha)
        Q = direct_traction(beta, delta, kappa, mu, lam, epsilon, zeta)
    return np.copysign(Q, omega - V), np.copysign(
        direct_moment(kappa, lam, epsilon, zeta, alpha), V
    )


# as a kernel that Python calls, for kernels below it are compiled as parts of it; but not kept on
# disk
@numba.njit(pipeline_class=EntryPipeline, error_model="numpy")
def _root_solves(V, omega, to, scenes):
    out = carray(to, RESULTS)
    scene = record_at(scenes)
    h = _STEP * abs(V)
    Q, M = _loads(V, omega, scene)
    Q_V, M_V = _loads(V + h, omega, scene)
    Q_omega, _ = _loads(V, omega + h, scene)
    out[0] = Q
    out[1] = M
    out[2] = 0.5 * M
    out[3] = 0.5 * M
    out[4] = (Q_V - Q) / h
    out[5] = (Q_omega - Q) / h
    out[6] = out[7] = 0.5 * (M_V - M) / h
    return 0


class RootSolves:
    """The law of a scene by root solves at every call, slopes by differences, to stand for
    ``vr.law(scene).jitted``.
    """

    _numba_type_ = LawType()

    def __init__(self, scene: vr.Scene) -> None:
        kinds = types.int32, types.float64, types.float64, types.CPointer(types.float64)
        address = function_address(_root_solves, _SCENE, *kinds)
        self._scene = np.array([(address, scene.alpha, scene.kappa, scene.mu)], _SCENE)
        self.address = int(self._scene.ctypes.data)
