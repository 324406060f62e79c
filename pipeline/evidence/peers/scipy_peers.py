"""The paper's method as it would be written in Python: scipy's integrators and brentq on the printed equations.

Unknowns (V, omega); the regime is decided in each right-hand side (Fig. 4 of the paper).
"""

from __future__ import annotations

from math import copysign, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import cython_special

_i0, _i1, _k0, _k1 = (getattr(cython_special, name) for name in ("i0e", "i1e", "k0e", "k1e"))
_ROOT = {"xtol": 1e-15, "rtol": 1e-14}


class GaveUpError(Exception):
    """More right-hand sides than allowed."""


class PrintedLaw:
    """Right-hand side of Eq. (22) with Eqs. (6), (10) solved by Brent-Dekker, and a count of its calls."""

    def __init__(self, parameters: tuple[float, ...], most: int) -> None:
        self.alpha, self.kappa, self.mu, self.gamma, self.j = parameters
        self.most = most
        self.evaluations = 0

    def __call__(self, _: float, y: NDArray) -> tuple[float, float]:
        self.evaluations += 1
        if self.evaluations > self.most:
            raise GaveUpError
        Q, M = self.contact(float(y[0]), float(y[1]))
        return self.gamma * (Q - 0.5 * M), -self.gamma / self.j * (Q + 0.5 * M)

    def contact(self, V: float, omega: float) -> tuple[float, float]:
        """Q and M of Eqs. (17), (18)."""
        alpha, kappa, mu = self.alpha, self.kappa, self.mu
        slip, speed = omega - V, abs(V)
        Q = copysign(mu, slip) if slip else 0.0
        if speed == 0.0:
            return Q, 0.0

        def equation_6(lam: float) -> float:
            zeta = lam / (2.0 * kappa * speed)
            x = alpha * zeta
            i0, i1, k0, k1 = _i0(x), _i1(x), _k0(zeta), _k1(zeta)
            return (1.0 - lam * lam) * (i0 * k1 + k0 * i1) + 2.0 / zeta * (1.0 / alpha - 1.0) * lam * lam * i1 * k1

        lam = _root(equation_6, 1.0 / sqrt(alpha), 1.0) if alpha > 1.0 else 1.0
        zeta = lam / (2.0 * kappa * speed)
        epsilon = 0.5 * (lam**-2 - 1.0) * _k0(zeta) / _k1(zeta)
        M = copysign(lam / kappa * (0.5 * epsilon * (1.0 - lam * lam) + 0.5 / zeta * (lam * lam - 1.0 / alpha)), V)
        delta = abs(slip) / speed
        if delta >= mu * lam * (1.0 + epsilon) / (2.0 * kappa):
            return Q, M
        front, creep = 1.0 + epsilon, 2.0 * delta * kappa / (mu * lam)

        def equation_10(beta: float) -> float:
            """Over K1(beta zeta), which is infinite at beta = 0."""
            if beta == 0.0:
                return front - creep
            z = beta * zeta
            i0, i1, k = _i0(alpha * z), _i1(alpha * z), _k0(z) / _k1(z)
            return (front - beta - creep) * (i0 + i1 * k) + (1.0 / alpha - 1.0) / zeta * i1 * k

        beta = _root(equation_10, 0.0, 1.0)
        if beta > 0.0:
            ratio = _k1(beta * zeta) / _k0(beta * zeta)
            Q *= 1.0 - beta * beta * lam * lam - 2.0 * beta * lam * lam * (front - beta - creep) * ratio
        return Q, M


def _root(equation, low: float, high: float) -> float:
    """Root of a function that falls from >= 0 to <= 0; an end where rounding spoils the sign is it."""
    if equation(low) <= 0.0:
        return low
    if equation(high) >= 0.0:
        return high
    return brentq(equation, low, high, **_ROOT)


def roll(
    method: str, parameters: tuple[float, ...], start: tuple[float, float], t: NDArray, rtol: float, most: int
) -> tuple[NDArray, NDArray, int]:
    """One motion: V, omega at ``t`` (NaN where it gave up) and the number of right-hand sides.

    ``method`` is "LSODA" or "Radau" of :func:`scipy.integrate.solve_ivp`.
    """
    law = PrintedLaw(parameters, most)
    try:
        solution = solve_ivp(law, (0.0, t[-1]), start, method, t_eval=t, rtol=rtol, atol=1e-3 * rtol)
    except GaveUpError:
        return np.full(t.size, np.nan), np.full(t.size, np.nan), law.evaluations
    V, omega = np.full((2, t.size), np.nan)
    V[: solution.t.size], omega[: solution.t.size] = solution.y
    return V, omega, law.evaluations
