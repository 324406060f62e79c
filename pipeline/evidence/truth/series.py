"""A material of several relaxation times in arbitrary precision, from the matching conditions as they stand.

Inside the contact the pressure is that of Hertz and one exponential a relaxation mode, of amplitude X_i; each creep
mode's memory must be continuous at the front edge:

    sum_i X_i a_i (1 + r_i k_j)/(a_i - b_j) = 1/b_j     r_i = I1/I0(a_i z)     k_j = K0/K1(b_j z)
    g = T_mean - sum X_i      h = sum X_i r_i      m = g + (z^2/H) sum X_i I2/I0(a_i z)      H = z^2 + 2 z h

Goryacheva's way.  It loses digits (its condition number reaches 1e5, and g is a difference), which the precision
makes up for; the kernels solve another system.  ``mp`` is mpmath; Bessel functions are Arb's.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from viscoroll import Bodies
from viscoroll.core.extras import imported

from .enclosures import ratio_i2, ratio_k, ratio_r


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
        T, J, _ = (list(column) for column in zip(*creep_of(mp, material), strict=True))
        alphas = ((part, rates_of(mp, body).alpha) for part, body, _ in _bodies(mp, material))
        return rates_of_creep(mp, J, T, 1 / sum(part / alpha for part, alpha in alphas))
    total = material.total if isinstance(material, Bodies) else material
    if not total.by_creep:
        return rates(mp, total.E.tolist(), total.tau.tolist())
    alpha = 1 / (1 - sum(map(mp.mpf, total.J.tolist())))  # to all digits: at high speed all but its last cancel
    return rates_of_creep(mp, total.J.tolist(), total.T.tolist(), alpha)


def _bodies(mp: Any, bodies: Bodies) -> list[tuple[Any, Any, int]]:
    """(Share, material, whether it is the half-space) of both."""
    share = mp.mpf(bodies.share)
    return [(share, bodies.cylinder, 0), (1 - share, bodies.base, 1)]


def creep_of(mp: Any, bodies: Bodies) -> list[tuple[Any, Any, int]]:
    """(Time, strength, whether it is the half-space's) of each creep mode, slowest first; no two share a time."""
    both = [(part, rates_of(mp, body), which) for part, body, which in _bodies(mp, bodies)]
    modes = [
        (1 / b, part * J, which)
        for part, known, which in both for b, J in zip(known.b, creep_strengths(mp, known)) if part
    ]  # fmt: skip
    return sorted(modes, key=lambda mode: mode[0], reverse=True)


class Numbers(NamedTuple):
    """What is asked of numbers of a kind: I1/I0, K0/K1, I2/I0, and the solution of a linear system."""

    r: Callable[[Any], Any]
    k: Callable[[Any], Any]
    i2: Callable[[Any], Any]
    solved: Callable[[list[list[Any]], list[Any]], list[Any]]


def of_mpmath(mp: Any) -> Numbers:
    """At its working precision."""
    flint = imported("flint", "python-flint", "dev")

    def of(ratio: Callable[[Any], Any], x: Any) -> Any:
        with flint.ctx.workprec(mp.mp.prec + 20):
            return mp.mpf(ratio(flint.arb(x)).mid())

    ratios = (lambda x, ratio=ratio: of(ratio, x) for ratio in (ratio_r, ratio_k, ratio_i2))
    return Numbers(*ratios, lambda matrix, right: list(mp.lu_solve(mp.matrix(matrix), mp.matrix(right))))


class Functions(NamedTuple):
    """g, h, m at z; the amplitudes X, ratios of the modes, a_i/(a_i - b_j), and the matrix of the conditions."""

    g: Any
    h: Any
    m: Any
    X: list[Any]
    r: list[Any]
    k: list[Any]
    i2: list[Any]
    per: list[list[Any]]
    matrix: list[list[Any]]

    def shares(self, known: Any, z: Any, J: list[Any]) -> list[Any]:
        """Shares of the creep modes in m, slowest first: what their memory does to the pressure.

        m_j = J_j sum_i X_i a_i/(a_i - b_j) (r_i k_j + (z^2/H) u_i)
        u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)
        """
        a, X, modes, square = known.a, self.X, range(len(known.a)), 1 / (1 + 2 * self.h / z)
        between = [[a[i] * a[n] / (a[i] + a[n]) * (self.i2[i] - self.i2[n]) for n in modes] for i in modes]
        u = [self.i2[i] + sum(X[n] * between[i][n] for n in modes) for i in modes]
        return [
            J[n] * sum(X[i] * self.per[n][i] * (self.r[i] * self.k[n] + square * u[i]) for i in modes) for n in modes
        ]


def functions(mp: Any, known: Rates, z: Any) -> Functions:
    """g, h and m at z."""
    return conditions(of_mpmath(mp), known, mp.mpf(z))


def conditions(of: Numbers, known: Any, z: Any) -> Functions:
    """The same of numbers of any kind; of ``known``: a, b, T_mean."""
    a, b, modes = known.a, known.b, range(len(known.a))
    r, k, i2 = [of.r(at * z) for at in a], [of.k(at * z) for at in b], [of.i2(at * z) for at in a]
    per = [[a[i] / (a[i] - b[n]) for i in modes] for n in modes]
    matrix = [[per[n][i] * (1 + r[i] * k[n]) for i in modes] for n in modes]
    X = of.solved(matrix, [1 / at for at in b])
    g, h = known.T_mean - sum(X), sum(X[i] * r[i] for i in modes)
    return Functions(g, h, g + sum(X[i] * i2[i] for i in modes) / (1 + 2 * h / z), X, r, k, i2, per, matrix)


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
