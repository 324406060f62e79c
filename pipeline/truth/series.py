"""A material of several relaxation times in arbitrary precision, from the matching conditions as they stand.

Inside the contact the pressure is that of Hertz and one exponential a relaxation mode, of amplitude X_i; each creep
mode's memory must be continuous at the front edge:

    sum_i X_i a_i (1 + r_i k_j)/(a_i - b_j) = 1/b_j     r_i = I1/I0(a_i z)     k_j = K0/K1(b_j z)
    g = T_mean - sum X_i      h = sum X_i r_i      m = g + (z^2/H) sum X_i I2/I0(a_i z)      H = z^2 + 2 z h

Goryacheva's way.  It loses digits (its condition number reaches 1e5, and g is a difference), which the precision
makes up for; the kernels solve another system.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .precise import ratio_k, ratio_r


class Rates(NamedTuple):
    """Both forms of a material: rates ascending, 1 + sum E, sum J T."""

    a: list[Any]
    b: list[Any]
    alpha: Any
    T_mean: Any


def rates(mp: Any, E: list[float], tau: list[float]) -> Rates:
    """Creep from relaxation: the zeros of -1/s + sum E_i/(a_i - s), bisected in the distance from the nearer pole."""
    modes = sorted(zip(tau, E, strict=True), reverse=True)
    a, strengths = [1 / mp.mpf(at) for at, _ in modes], [mp.mpf(value) for _, value in modes]

    def rising(s: Any) -> Any:
        return -1 / s + sum(value / (at - s) for value, at in zip(strengths, a, strict=True))

    b = [_zero(mp, rising, low, high) for low, high in zip([mp.mpf(0), *a[:-1]], a, strict=True)]
    T_mean = sum(value / at for value, at in zip(strengths, a, strict=True))
    return Rates(a, b, 1 + sum(strengths), T_mean)


def rates_of_creep(mp: Any, J: list[float], T: list[float], alpha: float) -> Rates:
    """Relaxation from creep: the zeros of 1/alpha + sum J_j b_j/(b_j - s), one right of each b_j."""
    modes = sorted(zip(T, J, strict=True), reverse=True)
    b, weights = [1 / mp.mpf(at) for at, _ in modes], [mp.mpf(value) / mp.mpf(at) for at, value in modes]

    def rising(s: Any) -> Any:
        return 1 / mp.mpf(alpha) + sum(value / (at - s) for value, at in zip(weights, b, strict=True))

    highest = b[-1] + 2 * sum(weights) * mp.mpf(alpha)
    a = [_zero(mp, rising, low, high) for low, high in zip(b, [*b[1:], highest], strict=True)]
    return Rates(a, b, mp.mpf(alpha), sum(mp.mpf(value) * mp.mpf(at) for at, value in modes))


def _zero(mp: Any, rising: Any, low: Any, high: Any) -> Any:
    half = (high - low) / 2
    from_low = rising(low + half) >= 0
    near, far = half * mp.mpf(10) ** -80, half
    for _ in range(2000):
        middle = mp.sqrt(near * far)
        beyond = rising(low + middle) > 0 if from_low else rising(high - middle) < 0
        near, far = (near, middle) if beyond else (middle, far)
        if far - near < far * 64 * mp.eps:
            break
    return low + near if from_low else high - near


class Functions(NamedTuple):
    """g, h, m at z, and the amplitudes X."""

    g: Any
    h: Any
    m: Any
    X: list[Any]


def functions(mp: Any, known: Rates, z: Any) -> Functions:
    """g, h and m at z."""
    z, count = mp.mpf(z), len(known.a)
    r, k = [ratio_r(mp, at * z) for at in known.a], [ratio_k(mp, at * z) for at in known.b]
    matrix, right = mp.matrix(count, count), mp.matrix(count, 1)
    for j in range(count):
        right[j] = 1 / known.b[j]
        for i in range(count):
            matrix[j, i] = known.a[i] * (1 + r[i] * k[j]) / (known.a[i] - known.b[j])
    X = list(mp.lu_solve(matrix, right))
    g, h = known.T_mean - sum(X), sum(amplitude * ratio for amplitude, ratio in zip(X, r, strict=True))
    pressed = sum(
        amplitude * mp.besseli(2, at * z) / mp.besseli(0, at * z) for amplitude, at in zip(X, known.a, strict=True)
    )
    return Functions(g, h, g + pressed / (1 + 2 * h / z), X)


def shares(mp: Any, known: Rates, z: Any, found: Functions) -> list[Any]:
    """Shares of the creep modes in m, slowest first: what their memory does to the pressure, from the amplitudes.

    m_j = J_j sum_i X_i a_i/(a_i - b_j) (r_i k_j + (z^2/H) u_i)
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)
    """
    z, a, X = mp.mpf(z), known.a, found.X
    r, i2 = [ratio_r(mp, at * z) for at in a], [mp.besseli(2, at * z) / mp.besseli(0, at * z) for at in a]
    u = [at + sum(X[n] * a[i] * a[n] / (a[i] + a[n]) * (at - i2[n]) for n in range(len(a))) for i, at in enumerate(i2)]
    lam2 = 1 / (1 + 2 * found.h / z)
    return [
        strength * sum(X[i] * a[i] / (a[i] - b) * (r[i] * ratio_k(mp, b * z) + lam2 * u[i]) for i in range(len(a)))
        for strength, b in zip(creep_strengths(mp, known), known.b, strict=True)
    ]


def creep_strengths(mp: Any, known: Rates) -> list[Any]:
    """J_j = prod_i (a_i - b_j)/prod_{i != j} (b_i - b_j)/(alpha b_j), signs dropped."""
    strengths = []
    for j, b in enumerate(known.b):
        top = mp.fprod(abs(at - b) for at in known.a)
        strengths.append(top / mp.fprod(abs(at - b) for i, at in enumerate(known.b) if i != j) / known.alpha / b)
    return strengths
