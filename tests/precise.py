"""Truth for the tests: Eqs. (6), (8)-(10), (15), (16) as printed, in arbitrary precision.

Shares nothing with the package: Bessel functions from their power series and from the
trapezoidal rule, roots from mpmath.  Precision is mpmath's working precision; the tests use
:data:`DIGITS`.
"""

from __future__ import annotations

from typing import NamedTuple

import mpmath as mp

DIGITS = 50


def bessel_i(x: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """(I0, I1)."""
    return mp.besseli(0, x), mp.besseli(1, x)


def bessel_k(x: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """(K0, K1) times exp(x)."""
    return _k_series(x) if x < 2 else _k_integral(x)


def _k_series(x: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """K0 from its power series (DLMF 10.31.2), K1 from the Wronskian I0 K1 + I1 K0 = 1/x."""
    quarter = x * x / 4
    term, harmonic, n = mp.mpf(1), mp.mpf(0), 0
    i0, i1, rest = mp.mpf(1), x / 2, mp.mpf(0)
    while term > mp.eps**2:
        n += 1
        term *= quarter / (n * n)
        harmonic += mp.mpf(1) / n
        i0 += term
        i1 += x / 2 * term / (n + 1)
        rest += term * harmonic
    k0 = rest - (mp.log(x / 2) + mp.euler) * i0
    scale = mp.exp(x)
    return k0 * scale, (1 / x - i1 * k0) / i0 * scale


def _k_integral(x: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Int_0^oo exp(-x (cosh t - 1)) {1, cosh t} dt (DLMF 10.32.9) by the trapezoidal rule.

    The integrand is entire: with this step the rule's error is below the working precision.
    """
    digits = mp.mp.dps * mp.log(10) + 10
    h = min(mp.pi**2 / digits, mp.sqrt(2 * mp.pi**2 / (digits * x)))
    grow = mp.exp(h)
    up = mp.mpf(1)
    k0, k1 = mp.mpf(1) / 2, mp.mpf(1) / 2
    while True:
        up *= grow
        # cosh t - 1 without cancellation
        rise = (up - 1) ** 2 / (2 * up)
        if x * rise > digits:
            return h * k0, h * k1
        weight = mp.exp(-x * rise)
        k0 += weight
        k1 += weight * (1 + rise)


def ratio_r(x: mp.mpf) -> mp.mpf:
    """I1/I0."""
    i0, i1 = bessel_i(x)
    return i1 / i0


def ratio_k(x: mp.mpf) -> mp.mpf:
    """K0/K1."""
    k0, k1 = bessel_k(x)
    return k0 / k1


def ratio_i2(x: mp.mpf) -> mp.mpf:
    """I2/I0."""
    return mp.besseli(2, x) / mp.besseli(0, x)


class State(NamedTuple):
    """One state of the contact, V > 0, delta >= 0."""

    lam: mp.mpf
    zeta: mp.mpf
    epsilon: mp.mpf
    delta_star: mp.mpf
    beta: mp.mpf
    Q: mp.mpf
    M: mp.mpf


def root(equation, low, high, seed=None) -> mp.mpf:
    """The root between low and high: by the Illinois method with few digits, then by secants.

    ``seed``: a nearby root, instead of the bracketing.
    """
    if seed is None:
        with mp.workdps(20):
            seed = bracketed(equation, mp.mpf(low), mp.mpf(high))
    old, new = seed * (1 - mp.mpf(10) ** -14), seed
    f_old = equation(old)
    for _ in range(12):
        f_new = equation(new)
        if f_new == f_old:
            break
        step = f_new * (new - old) / (f_new - f_old)
        old, f_old, new = new, f_new, new - step
        if abs(step) < abs(new) * mp.eps * 100:
            break
    return new


def bracketed(equation, low: mp.mpf, high: mp.mpf) -> mp.mpf:
    """The root to about 16 digits."""
    at_low, at_high = equation(low), equation(high)
    if at_low * at_high >= 0:  # rounding has spoilt a sign: the root is that end
        return low if abs(at_low) < abs(at_high) else high
    while abs(high - low) > mp.mpf(10) ** -15 * abs(high):
        middle = (at_low * high - at_high * low) / (at_low - at_high)
        value = equation(middle)
        if value == 0:
            return middle
        if value * at_high < 0:
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, value
    return high


def contact_length(kappa_V: mp.mpf, alpha: mp.mpf, seed: mp.mpf | None = None) -> mp.mpf:
    """lam of Eq. (6), which appears times exp(zeta)."""
    if alpha == 1:
        return mp.mpf(1)  # Sect. 3.4

    def eq_6(lam):
        zeta = lam / (2 * kappa_V)
        i0, i1 = bessel_i(alpha * zeta)
        k0, k1 = bessel_k(zeta)
        return ((1 - lam**2) * (i0 * k1 + k0 * i1) + 2 / zeta * (1 / alpha - 1) * lam**2 * i1 * k1) / (i0 * k1)

    return root(eq_6, 1 / mp.sqrt(alpha), 1, seed)


def stick_share(front: mp.mpf, creep: mp.mpf, zeta: mp.mpf, alpha: mp.mpf, seed: mp.mpf | None = None) -> mp.mpf:
    """beta of Eq. (10) with front = 1 + epsilon and creep = 2 delta kappa/(mu lam)."""
    if creep == 0:
        return mp.mpf(1)
    if alpha == 1:
        return 1 - creep  # Sect. 3.4

    def eq_10(beta):
        i0, i1 = bessel_i(alpha * beta * zeta)
        k0, k1 = bessel_k(beta * zeta)
        bracket = front - beta - creep
        return (bracket * (i0 * k1 + i1 * k0) + (1 / alpha - 1) / zeta * i1 * k0) / (i0 * k1)

    # the last term is negative, so the bracket is positive at the root: beta < front - creep
    return root(eq_10, mp.mpf(10) ** -18, min(mp.mpf(1), front - creep), seed)


def state(alpha: float, kappa: float, mu: float, V: float, delta: float, seed: State | None = None) -> State:
    """The printed law; every argument is taken as the exact double it is."""
    alpha, kappa, mu, V, delta = (mp.mpf(value) for value in (alpha, kappa, mu, V, delta))
    lam = contact_length(kappa * V, alpha, seed and seed.lam)
    zeta = lam / (2 * kappa * V)
    epsilon = (lam**-2 - 1) / 2 * ratio_k(zeta)
    delta_star = mu * lam * (1 + epsilon) / (2 * kappa)
    if delta < delta_star:
        creep = 2 * delta * kappa / (mu * lam)
        beta = stick_share(1 + epsilon, creep, zeta, alpha, seed and seed.beta)
        Q = mu * (1 - beta**2 * lam**2 - 2 * beta * lam**2 * (1 + epsilon - beta - creep) / ratio_k(beta * zeta))
    else:
        beta, Q = mp.mpf(0), mu
    M = lam / kappa * (epsilon / 2 * (1 - lam**2) + (lam**2 - 1 / alpha) / (2 * zeta))
    return State(lam, zeta, epsilon, delta_star, beta, Q, M)


def slope(alpha: float, kappa: float, mu: float, V: float, delta: float, by: str) -> dict[str, mp.mpf]:
    """Derivatives of Q and M by "V" (fixed delta), "delta" (fixed V): central differences.

    With 50 digits a step of 1e-15 leaves an error near 1e-30.
    """
    base = {"V": mp.mpf(V), "delta": mp.mpf(delta)}
    h = base[by] * mp.mpf(10) ** -15
    middle = state(alpha, kappa, mu, base["V"], base["delta"])
    up, down = (state(alpha, kappa, mu, **(base | {by: base[by] + sign * h}), seed=middle) for sign in (1, -1))
    return {name: (getattr(up, name) - getattr(down, name)) / (2 * h) for name in ("Q", "M")}


def ulps(value: float, exact: mp.mpf) -> float:
    """Distance in units in the last place of the exact value."""
    spacing = mp.mpf(2) ** max(int(mp.floor(mp.log(abs(exact), 2))) - 52, -1074)
    return float(abs(mp.mpf(float(value)) - exact) / spacing)
