"""The contact law as printed, in arbitrary precision: Eqs. (6), (8)-(10), (15)-(18), no reduction.

Truth for tests and for the measured errors that the documentation states.  Shares nothing
with the kernels: I0 and I1 from mpmath, K0 and K1 from their power series or from the
trapezoidal rule (mpmath's own K is slow at integer order), roots by bracketing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from viscoroll.core.checks import checked
from viscoroll.core.errors import ConvergenceError, ParameterError
from viscoroll.core.extras import imported
from viscoroll.scene import Scene

#: Digits that the printed forms may lose: lam^-2 - 1 as V -> 0, lam^2 - 1/alpha as V grows
#: and as alpha -> 1, 1 - H(eta)/H(zeta) as delta -> 0.
_GUARD = 30
_LEAST_DIGITS = 15
_MOST_STEPS = 1000


def contact_precise(alpha: float, kappa: float, mu: float, V: float, delta: float, digits: int = 50) -> dict[str, Any]:
    """State of the contact from the printed equations, Eqs. (6), (8)-(10), (15)-(18).

    Everything is dimensionless; every argument is taken as the exact double it is.

    Parameters
    ----------
    alpha : >= 1.
    kappa, mu : > 0.
    V : velocity of the axis, any sign, not 0 (zeta is infinite there).
    delta : creep ratio, any sign.
    digits : correct digits of the result, >= 15.

    Returns
    -------
    dict of mpmath.mpf
        lam, zeta, epsilon, delta_star, beta, Q, M.

    Raises
    ------
    ParameterError
        A value out of its range, NaN or infinite, or not a single number.
    MissingDependencyError
        If mpmath is not installed.
    ConvergenceError
        If a root is not found within 1000 bracketing steps; 90 is the most that was seen.

    Notes
    -----
    Each value to ``digits`` relative digits for alpha - 1 >= 1e-8, kappa V in [1e-8, 1e8] and
    |delta|/delta_star in [1e-8, 1 - 1e-8] (``tests/docs/test_readme.py`` compares 20 with 50 digits).
    """
    given, sign_V, sign_delta = single_numbers("contact_precise", alpha, kappa, mu, V, delta)
    if digits < _LEAST_DIGITS:
        raise ParameterError("digits", digits, f">= {_LEAST_DIGITS}")
    mp = imported("mpmath", "mpmath", "dev")
    with mp.workdps(digits + _GUARD):
        state = printed_state(mp, *map(mp.mpf, given))
        # Eqs. (17), (18): omega - V = delta V
        state["Q"] *= sign_delta * sign_V
        state["M"] *= sign_V
    return state


def single_numbers(caller: str, alpha: Any, kappa: Any, mu: Any, V: Any, delta: Any) -> tuple[list[float], int, int]:
    """(alpha, kappa, mu, |V| and |delta| as floats, signs of V and of delta), of one state with V other than 0."""
    scene = Scene(alpha=alpha, kappa=kappa, mu=mu)
    speed, creep = checked("V", V), checked("delta", delta)
    if scene.shape or speed.ndim or creep.ndim:
        raise ParameterError(caller, "arrays", "called with single numbers")
    if speed == 0.0:
        raise ParameterError("V", 0.0, "different from 0")
    given = [float(value) for value in (scene.alpha, scene.kappa, scene.mu, abs(speed), abs(creep))]
    return given, int(np.sign(speed)), int(np.sign(creep))


def printed_state(mp: Any, alpha: Any, kappa: Any, mu: Any, V: Any, delta: Any) -> dict[str, Any]:
    """The law for V > 0 and delta >= 0, from mpf and at mpmath's working precision."""

    def eq_6(lam: Any) -> Any:
        """Left side over I0 K1."""
        zeta = lam / (2 * kappa * V)
        r, k = ratio_r(mp, alpha * zeta), ratio_k(mp, zeta)
        return (1 - lam**2) * (1 + k * r) + 2 / zeta * (1 / alpha - 1) * lam**2 * r

    lam = bracketed_root(mp, eq_6, 1 / mp.sqrt(alpha), mp.mpf(1))
    zeta = lam / (2 * kappa * V)
    epsilon = (lam**-2 - 1) / 2 * ratio_k(mp, zeta)
    delta_star = mu * lam * (1 + epsilon) / (2 * kappa)
    creep = 2 * delta * kappa / (mu * lam)

    def eq_10(beta: Any) -> Any:
        """Left side over I0 K1; its limit at beta = 0."""
        r, k = (ratio_r(mp, alpha * beta * zeta), ratio_k(mp, beta * zeta)) if beta else (0, 0)
        return (1 + epsilon - beta - creep) * (1 + r * k) + (1 / alpha - 1) / zeta * r * k

    beta, Q = mp.mpf(0), mu
    if delta < delta_star:
        beta = bracketed_root(mp, eq_10, mp.mpf(0), mp.mpf(1))
        bracket = 1 + epsilon - beta - creep
        Q = mu * (1 - beta**2 * lam**2 - 2 * beta * lam**2 * bracket / ratio_k(mp, beta * zeta))
    M = lam / kappa * (epsilon / 2 * (1 - lam**2) + (lam**2 - 1 / alpha) / (2 * zeta))
    return {"lam": lam, "zeta": zeta, "epsilon": epsilon, "delta_star": delta_star, "beta": beta, "Q": Q, "M": M}


def bracketed_root(mp: Any, equation: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Root of an equation that falls from >= 0 at ``low`` to <= 0 at ``high`` (Chandrupatla).

    Inverse quadratic interpolation where it is safe, bisection where it is not: the bracket
    shrinks at every step.  An end where rounding spoils the sign is the root, to rounding.

    Raises
    ------
    ConvergenceError
        After 1000 steps.
    """
    a, b = high, low
    fa, fb = equation(a), equation(b)
    if fa >= 0:
        return a
    if fb <= 0:
        return b
    c, fc = a, fa
    share = mp.mpf(1) / 2
    for _ in range(_MOST_STEPS):
        x = a + share * (b - a)
        fx = equation(x)
        if (fx > 0) == (fa > 0):
            c, fc = a, fa
        else:
            c, b, fc, fb = b, a, fb, fa
        a, fa = x, fx
        best = a if abs(fa) < abs(fb) else b
        least = 2 * mp.eps * abs(best) / abs(b - a) if a != b else mp.mpf(1)
        if least >= 0.5 or fa == 0:
            return best
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        share = mp.mpf(1) / 2
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:
            share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        share = min(max(share, least), 1 - least)
    raise ConvergenceError(f"contact_precise: no root within {_MOST_STEPS} steps")


def ratio_r(mp: Any, x: Any) -> Any:
    """I1/I0 at x > 0."""
    return mp.besseli(1, x) / mp.besseli(0, x)


def ratio_k(mp: Any, z: Any) -> Any:
    """K0/K1 at z > 0."""
    return _k_series(mp, z) if z < 2 else _k_integral(mp, z)


def _k_series(mp: Any, z: Any) -> Any:
    """K0 from its power series (DLMF 10.31.2), K1 from the Wronskian I0 K1 + I1 K0 = 1/z."""
    quarter = z * z / 4
    term, harmonic, n = mp.mpf(1), mp.mpf(0), 0
    i0, i1, rest = mp.mpf(1), z / 2, mp.mpf(0)
    while term > mp.eps**2:
        n += 1
        term *= quarter / (n * n)
        harmonic += mp.mpf(1) / n
        i0 += term
        i1 += z / 2 * term / (n + 1)
        rest += term * harmonic
    k0 = rest - (mp.log(z / 2) + mp.euler) * i0
    return k0 * i0 / (1 / z - i1 * k0)


def _k_integral(mp: Any, z: Any) -> Any:
    """From Int_0^oo exp(-z (cosh t - 1)) {1, cosh t} dt (DLMF 10.32.9) by the trapezoidal rule.

    The integrand is entire: with this step the rule's error is below the working precision.
    """
    deep = mp.mp.dps * mp.log(10) + 10
    h = min(mp.pi**2 / deep, mp.sqrt(2 * mp.pi**2 / (deep * z)))
    grow, up = mp.exp(h), mp.mpf(1)
    k0 = k1 = mp.mpf(1) / 2
    while True:
        up *= grow
        rise = (up - 1) ** 2 / (2 * up)  # cosh t - 1 without cancellation
        if z * rise > deep:
            return k0 / k1
        weight = mp.exp(-z * rise)
        k0 += weight
        k1 += weight * (1 + rise)
