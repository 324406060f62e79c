"""The normal contact of a creep series by Chebyshev polynomials: no Bessel function, no second form of the material.

On a contact of half length 1 (x ahead; z half length over V T_ref) pressure and its Hilbert transform are

    p = sqrt(1 - x^2) sum c_n U_n(x)      Hp = sum c_n T_(n+1)(x)      ahead: sum c_n (x - sqrt(x^2 - 1))^(n+1)

and the surface follows the parabola: J(0) Hp + sum J_j y_j = x + epsilon, where the memory of a creep mode is
y_j - (T_j/z) y_j' = Hp, from its value at the front edge.  Boundary layers there want some 6.5 sqrt(z/T_N) terms.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viscoroll.materials.prony import Prony

#: panels of Gauss-Legendre's rule ahead of the contact, each twice as long as the one before, and its points
_PANELS, _POINTS = 23, 24
#: exp(-45) is below rounding
_FAR = 45.0


class Contact(NamedTuple):
    """g, h and m at z, and the share of each creep mode in m, slowest first."""

    g: float
    h: float
    m: float
    shares: NDArray[np.float64]


def contact(series: Prony, z: float, terms: int) -> Contact:
    """The contact of half length z by so many terms of the pressure."""
    second = _second_kind(terms + 1)
    system = np.zeros((terms + 1, terms + 1))  # coefficients of T_0 ... T_terms of the slope; of c and epsilon
    system[1:, :terms] = np.eye(terms) / series.alpha
    system[0, terms] = -1.0
    memories = [_memory(T / z, terms, second) for T in series.T]
    for J, memory in zip(series.J, memories, strict=True):
        system[:, :terms] += J * memory
    right = np.zeros(terms + 1)
    right[1] = 1.0
    *c, epsilon = _solved(system, right)
    load, moment = 0.5 * np.pi * c[0], 0.25 * np.pi * c[1]
    work = np.array([_work(np.array(c), memory) for memory in memories])
    return Contact(
        z * epsilon, 0.5 * z * (c[0] - 1.0), z * (epsilon + moment / load), z * series.J * work / load,
    )  # fmt: skip


def _second_kind(count: int) -> NDArray[np.float64]:
    """Coefficients of T_0 ... as coefficients of U_0 ...: T_n = (U_n - U_(n-2))/2."""
    matrix = 0.5 * (np.eye(count) - np.eye(count, k=2))
    matrix[0, 0] = 1.0
    return matrix


def _memory(w: float, terms: int, second: NDArray) -> NDArray[np.float64]:
    """y of y - w y' = Hp for each term of p: coefficients of T_0 ... T_terms, a column a term."""
    derivative = np.diag(np.arange(1.0, terms + 1.0), 1)  # T_n' = n U_(n-1)
    system = np.vstack([np.ones(terms + 1), (second - w * derivative)[:-1]])
    right = np.vstack([_at_front(w, terms), second[:-1, 1:]])
    return _solved(system, right)


def _solved(system: NDArray, right: NDArray) -> NDArray[np.float64]:
    """The solution of a linear system by orthogonal factors: pivots grow here by ten orders of magnitude and more."""
    q, r = np.linalg.qr(system)
    return np.linalg.solve(r, q.T @ right)


def _at_front(w: float, terms: int) -> NDArray[np.float64]:
    """int_1^inf exp(-(s - 1)/w) (s - sqrt(s^2 - 1))^n ds/w for n = 1 ... terms, by parts and with s = cosh u."""
    edges = np.concatenate([[0.0], np.arccosh(1.0 + _FAR * w) * 2.0 ** np.arange(1.0 - _PANELS, 1.0)])
    x, weight = np.polynomial.legendre.leggauss(_POINTS)
    half = 0.5 * np.diff(edges)[:, None]
    u = (edges[:-1, None] + half * (1.0 + x)).ravel()
    decay = np.exp(-2.0 * np.sinh(0.5 * u) ** 2 / w) * (half * weight).ravel()
    n = np.arange(1.0, terms + 1.0)
    return 1.0 - n * (np.exp(-np.outer(n, u)) @ decay)


def _work(c: NDArray, memory: NDArray) -> float:
    """int p y dx of a creep mode."""
    y = memory @ c
    own = y[:-1].copy()
    own[0] *= 2.0
    own[: own.size - 1] -= y[2:]
    return 0.25 * np.pi * float(c @ own)
