"""The contact law as the paper prints it: Eqs. (6), (8)-(10), (15), (16) and two Brent-Dekker roots.

Independent of :mod:`law` in the Bessel ratios, in the algebra and in the root finder: the
baseline that the explicit law is timed against and checked against.  The one liberty taken
is that Eqs. (6) and (10) are divided by I0 K1, so that only r = I1/I0 and k = K0/K1 occur
and nothing overflows.
"""

from __future__ import annotations

import numpy as np

from .bessel import ratio_i, ratio_k0k1
from .jit import kernel
from .law import NOT_CONVERGED, OK

_MAX_BRENT = 100
_EPS = 2.0**-52


@kernel
def _residual_6(lam, parameters):
    """Left side of Eq. (6) over I0(alpha zeta) K1(zeta); parameters (kappa V, alpha)."""
    kappa_V, alpha = parameters
    zeta = lam / (2.0 * kappa_V)
    r = ratio_i(alpha * zeta)
    k = ratio_k0k1(zeta)
    return (1.0 - lam * lam) * (1.0 + k * r) + 2.0 / zeta * (1.0 / alpha - 1.0) * (lam * lam) * r


@kernel
def _residual_10(beta, parameters):
    """Left side of Eq. (10) over I0(alpha beta zeta) K1(beta zeta); parameters (1 + epsilon, 2 delta kappa/(mu lam), ...)."""
    front, creep, zeta, alpha = parameters
    r = ratio_i(alpha * beta * zeta)
    k = ratio_k0k1(beta * zeta)
    return (front - beta - creep) * (1.0 + r * k) + 1.0 / zeta * (1.0 / alpha - 1.0) * r * k


@kernel
def brent(residual, parameters, low, high):
    """Root of residual(x, parameters) in [low, high] by Brent-Dekker, and a status.

    The residual falls from >= 0 at low to <= 0 at high.  An end where rounding spoils that
    sign is itself the root, to rounding.
    """
    a, fa = low, residual(low, parameters)
    b, fb = high, residual(high, parameters)
    if fb >= 0.0:
        return b, OK
    if fa <= 0.0:
        return a, OK
    # b: best so far; a: the one before; c: the far end of the bracket
    c, fc = a, fa
    d = e = b - a
    for _ in range(_MAX_BRENT):
        if abs(fc) < abs(fb):
            a, b, c = b, c, b
            fa, fb, fc = fb, fc, fb
        tolerance = 2.0 * _EPS * abs(b)
        half = 0.5 * (c - b)
        if abs(half) <= tolerance or fb == 0.0:
            return b, OK
        if abs(e) < tolerance or abs(fa) <= abs(fb):
            d = e = half
        else:
            s = fb / fa
            if a == c:
                p, q = 2.0 * half * s, 1.0 - s
            else:
                q, t = fa / fc, fb / fc
                p = s * (2.0 * half * q * (q - t) - (b - a) * (t - 1.0))
                q = (q - 1.0) * (t - 1.0) * (s - 1.0)
            if p > 0.0:
                q = -q
            p = abs(p)
            if 2.0 * p < min(3.0 * half * q - abs(tolerance * q), abs(e * q)):
                e, d = d, p / q
            else:
                d = e = half
        a, fa = b, fb
        b += d if abs(d) > tolerance else np.copysign(tolerance, half)
        fb = residual(b, parameters)
        if (fb > 0.0) == (fc > 0.0):
            c, fc = a, fa
            d = e = b - a
    return b, NOT_CONVERGED


@kernel
def direct_contact_length(kappa_V, alpha):
    """Eqs. (6)-(8) at kappa V > 0: (lam, zeta, epsilon, status).

    At lam = alpha^(-1/2) the residual is c (i2(alpha zeta) + p) >= 0, at lam = 1 it is
    -2 c r/zeta <= 0: the two always enclose the root.
    """
    lam, status = brent(_residual_6, (kappa_V, alpha), 1.0 / np.sqrt(alpha), 1.0)
    zeta = lam / (2.0 * kappa_V)
    epsilon = 0.5 * (1.0 / (lam * lam) - 1.0) * ratio_k0k1(zeta)
    return lam, zeta, epsilon, status


@kernel
def direct_delta_star(kappa, mu, lam, epsilon):
    """Eq. (9): the creep at which stick ends."""
    return mu * lam * (1.0 + epsilon) / (2.0 * kappa)


@kernel
def direct_stick(delta_abs, kappa, mu, lam, epsilon, zeta, alpha):
    """Eq. (10) for 0 <= delta_abs < delta_star: (beta, status).

    At beta = 0 the residual is 1 + epsilon - 2 delta kappa/(mu lam) > 0, at beta = 1 it is
    -2 delta kappa/(mu lam) (1 + p) <= 0 by Eq. (8).
    """
    creep = 2.0 * delta_abs * kappa / (mu * lam)
    return brent(_residual_10, (1.0 + epsilon, creep, zeta, alpha), 0.0, 1.0)


@kernel
def direct_traction(beta, delta_abs, kappa, mu, lam, epsilon, zeta):
    """Eq. (15): Q."""
    k = ratio_k0k1(beta * zeta)
    if k == 0.0:
        return mu
    bracket = 1.0 + epsilon - beta - 2.0 * delta_abs * kappa / (mu * lam)
    return mu * (1.0 - beta * beta * lam * lam - 2.0 * beta * lam * lam * bracket / k)


@kernel
def direct_moment(kappa, lam, epsilon, zeta, alpha):
    """Eq. (16): M."""
    return lam / kappa * (0.5 * epsilon * (1.0 - lam * lam) + 0.5 / zeta * (lam * lam - 1.0 / alpha))
