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

from viscoroll import Bodies

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

    b = [_zero(mp, rising, low, high) for low, high in zip([mp.mpf(0), *a][: len(a)], a, strict=True)]
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


def rates_of(mp: Any, material: Any) -> Rates:
    """Of an alpha, whose unit of time is T_epsilon, of a series, or of both bodies of a pair."""
    if isinstance(material, float):
        alpha = mp.mpf(material)
        return Rates([alpha], [mp.mpf(1)], alpha, 1 - 1 / alpha)
    if isinstance(material, Bodies) and material.cylinder != material.base:
        share = mp.mpf(material.share)
        bodies = [(share, rates_of(mp, material.cylinder)), (1 - share, rates_of(mp, material.base))]
        J = [part * strength for part, known in bodies for strength in creep_strengths(mp, known)]
        T = [1 / b for _, known in bodies for b in known.b]
        return rates_of_creep(mp, J, T, 1 / sum(part / known.alpha for part, known in bodies))
    total = material.total if isinstance(material, Bodies) else material
    if not total.by_creep:
        return rates(mp, total.E.tolist(), total.tau.tolist())
    alpha = 1 / (1 - sum(map(mp.mpf, total.J.tolist())))  # to all digits: at high speed all but its last cancel
    return rates_of_creep(mp, total.J.tolist(), total.T.tolist(), alpha)


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


def state(mp: Any, known: Rates, zeta: Any, share: Any) -> tuple[float, float, dict[str, Any], Functions]:
    """V and delta as doubles, and the state and its slopes there at kappa = mu = 1, where beta is near 1 - ``share``.

    The contact's length and its stick zone's are given, so nothing is solved; what V and delta are rounded by is made
    good to first order.
    """

    def of(z: Any, found: Functions) -> tuple[Any, Any, Any]:
        return z + found.g, z * z + 2 * z * found.h, found.m

    def slopes(z: Any) -> list[Any]:
        step = z * mp.mpf(10) ** -20
        ends = [of(at, functions(mp, known, at)) for at in (z + step, z - step)]
        return [(above - below) / (2 * step) for above, below in zip(*ends, strict=True)]

    zeta, eta = mp.mpf(zeta), mp.mpf(zeta) * (1 - mp.mpf(share))
    whole = functions(mp, known, zeta)
    (F, H, m), (F_eta, H_eta, _) = of(zeta, whole), of(eta, functions(mp, known, eta))
    (dF, dH, dm), (dF_eta, dH_eta, _) = slopes(zeta), slopes(eta)
    V = 1 / (2 * mp.sqrt(H))
    delta, dzeta = (F - F_eta) * V, -2 * H / dH / V
    deta, by_delta = (dF * dzeta + (F - F_eta) / V) / dF_eta, -1 / (V * dF_eta)
    dQ_dV, dQ_ddelta = (H_eta * dH * dzeta / H - dH_eta * deta) / H, -dH_eta * by_delta / H
    near_V, near_delta = float(V), float(delta)
    off, off_delta = near_V - V, near_delta - delta
    exact = {
        "lam": 2 * zeta * V + off * 2 * (dzeta * V + zeta),
        "epsilon": whole.g / zeta + off * dzeta * (dF * zeta - F) / zeta**2,
        "delta_star": V * F + off * (F + V * dF * dzeta),
        "beta": eta / zeta + (off * (deta - eta * dzeta / zeta) + off_delta * by_delta) / zeta,
        "Q": 1 - H_eta / H + off * dQ_dV + off_delta * dQ_ddelta,
        "M": V * m + off * (m + V * dm * dzeta),
        "dQ_dV": dQ_dV, "dQ_ddelta": dQ_ddelta, "dM_dV": m + V * dm * dzeta,
    }  # fmt: skip
    return near_V, near_delta, exact, whole
