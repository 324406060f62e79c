"""The contact law as the paper prints it: Eqs. (6), (8)-(10), (15), (16) and two Brent-Dekker roots.

Independent of :mod:`..rows` in the Bessel ratios, in the algebra and in the root finder: the baseline that the explicit
law is timed against and checked against.  The one liberty taken is that Eqs. (6) and (10) are divided by I0 K1, so that
only r = I1/I0 and k = K0/K1 occur and nothing overflows.

The printed forms lose digits in corners where the explicit ones do not.  Differences from :mod:`..rows`, measured over
alpha = T_epsilon/T_sigma in [1, 1e4], kappa V in [1e-3, 1e3], s = delta/delta_star in [1e-6, 1 - 1e-6]: lam 7e-16
relative, delta_star 4e-16 relative, beta 3e-15, Q 1.1e-13 mu, M 2e-13/kappa; the docstrings say where relative digits
go.

Letters: kappa = R/l0, mu the coefficient of friction, alpha = T_epsilon/T_sigma; lam, length of the contact over l0,
epsilon, its shift in half contact lengths; zeta = lam/(2 kappa V), half the transit time in T_epsilon; beta, stick zone
over contact length; delta, creepage.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.jit import kernel
from .bessel import ratio_i, ratio_k0k1

#: Status of a root that was found.
OK = 0
#: Status of a root that was not found: a NaN, or more than _MAX_STEPS steps.
NOT_CONVERGED = 1
#: Number that selects the residual of Eq. (6).
_EQ_6 = 6
#: Number that selects the residual of Eq. (10).
_EQ_10 = 10
#: Steps after which a search ends: six times what was ever seen.
_MAX_STEPS = 60
#: Distance from 1 to the next double.
_EPS = 2.0**-52


@kernel
def _residual(equation, x, data):
    """Return the left side of Eq. (6) or (10), divided by I0 K1 of the arguments that occur in it; its root is sought.

    equation : int, 6 (_EQ_6) or 10 (_EQ_10, and any other number); numba cannot cache a caller that passes a function.
    x : float, lam in Eq. (6), > 0; beta in Eq. (10), in [0, 1].
    data : tuple of four floats, dimensionless: in Eq. (6) kappa V > 0, alpha and two that are not used; in Eq. (10)
        1 + epsilon, 2 |delta| kappa/(mu lam), zeta > 0 and alpha.
    Returns a float, dimensionless, that falls through 0 at the root.
    """
    if equation == _EQ_6:
        kappa_V, alpha, _, _ = data
        zeta = x / (2.0 * kappa_V)
        r = ratio_i(alpha * zeta)
        k = ratio_k0k1(zeta)
        return (1.0 - x * x) * (1.0 + k * r) + 2.0 / zeta * (1.0 / alpha - 1.0) * (x * x) * r
    front, creep, zeta, alpha = data
    r = ratio_i(alpha * x * zeta)
    k = ratio_k0k1(x * zeta)
    return (front - x - creep) * (1.0 + r * k) + 1.0 / zeta * (1.0 / alpha - 1.0) * r * k


@kernel
def brent(equation, data, low, high, floor):
    """Find the root x of _residual(equation, x, data) in [low, high] by the method of Brent and Dekker.

    equation, data : arguments of :func:`_residual`.
    low, high : floats, ends of the bracket, low <= high (equal for alpha = 1).
    floor : float, absolute tolerance, >= 0; the root is found to floor + 4e-16 |x|.
    Returns (root, status), a float and an int: OK (0); or NOT_CONVERGED (1), after 60 steps with the best value so far
    (NaN if the residual became NaN on the way), or with NaN for the root where the residual is NaN at an end.

    At most 10 steps were seen with kappa V in [1e-8, 1e8], alpha in [1, 1e4].  The residual falls from >= 0 at low to
    <= 0 at high.  An end where it is 0, or where rounding spoils that sign, is itself the root, to rounding: ``high``
    with a residual >= 0, else ``low`` with one <= 0, is returned as OK without a step, whatever the other end has.
    """
    a = low
    fa = _residual(equation, low, data)
    b = high
    fb = _residual(equation, high, data)
    if fb >= 0.0:
        return b, OK
    if fa <= 0.0:
        return a, OK
    if not fa > fb:  # a NaN
        return np.nan, NOT_CONVERGED
    # b: best so far; a: the one before; c: the far end of the bracket
    c = a
    fc = fa
    d = e = b - a
    for _ in range(_MAX_STEPS):
        if abs(fc) < abs(fb):
            a, b, c = b, c, b
            fa, fb, fc = fb, fc, fb
        tolerance = floor + 2.0 * _EPS * abs(b)
        half = 0.5 * (c - b)
        if abs(half) <= tolerance or fb == 0.0:
            return b, OK
        if abs(e) < tolerance or abs(fa) <= abs(fb):
            d = e = half
        else:
            s = fb / fa
            if a == c:
                p = 2.0 * half * s
                q = 1.0 - s
            else:
                q = fa / fc
                t = fb / fc
                p = s * (2.0 * half * q * (q - t) - (b - a) * (t - 1.0))
                q = (q - 1.0) * (t - 1.0) * (s - 1.0)
            if p > 0.0:
                q = -q
            p = abs(p)
            if 2.0 * p < min(3.0 * half * q - abs(tolerance * q), abs(e * q)):
                e = d
                d = p / q
            else:
                d = e = half
        a = b
        fa = fb
        b += d if abs(d) > tolerance else np.copysign(tolerance, half)
        fb = _residual(equation, b, data)
        if (fb > 0.0) == (fc > 0.0):
            c = a
            fc = fa
            d = e = b - a
    return b, NOT_CONVERGED


@kernel
def direct_contact_length(kappa_V, alpha):
    """Solve Eq. (6) for the length of the contact, with Eqs. (7) and (8) for its transit time and its shift.

    kappa_V : float, slenderness times |V|, > 0, dimensionless.
    alpha : float, T_epsilon/T_sigma, >= 1, dimensionless.
    Returns (lam, zeta, epsilon, status), three floats and an int: contact length divided by l0; half the transit time,
    divided by T_epsilon; shift in half contact lengths; OK (0), or NOT_CONVERGED (1) if lam was not found
    (:func:`brent`), and then all three are not to be used.  alpha = 1 gives lam = 1 and epsilon = 0, to rounding.

    With c = 1 - 1/alpha, r = I1/I0 at alpha zeta, k = K0/K1 at zeta, p = k r, and i2 = I2/I0 = 1 - 2 r/(alpha zeta),
    the residual is c (i2 + p) >= 0 at lam = alpha^(-1/2), and -2 c r/zeta <= 0 at lam = 1, each with the zeta of its
    lam: the two always enclose the root.  lam^-2 - 1 costs epsilon its relative digits where epsilon -> kappa V c is
    small (4e-9 at kappa V = 1e-8, alpha = 11), but 1 + epsilon, which is what Eqs. (9) and (10) need, none.
    """
    lam, status = brent(_EQ_6, (kappa_V, alpha, 0.0, 0.0), 1.0 / np.sqrt(alpha), 1.0, 0.0)
    zeta = lam / (2.0 * kappa_V)
    epsilon = 0.5 * (1.0 / (lam * lam) - 1.0) * ratio_k0k1(zeta)
    return lam, zeta, epsilon, status


@kernel
def direct_delta_star(kappa, mu, lam, epsilon):
    """Return the critical creepage delta_star by Eq. (9), at which full slip begins: mu lam (1 + epsilon)/(2 kappa).

    kappa : float, slenderness R/l0, dimensionless, > 0.
    mu : float, coefficient of friction, dimensionless, > 0.
    lam, epsilon : floats, length divided by l0, and shift in half contact lengths, of the contact, Eqs. (6), (8); 1 and
        0 at V = 0.
    Returns a float, dimensionless, > 0.
    """
    return mu * lam * (1.0 + epsilon) / (2.0 * kappa)


@kernel
def direct_stick(delta_abs, kappa, mu, lam, epsilon, zeta, alpha):
    """Solve Eq. (10) for beta, the length of the stick zone divided by that of the contact, in partial slip, V not 0.

    delta_abs : float, |delta|, dimensionless, 0 <= delta_abs < delta_star.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in [alpha^(-1/2), 1]; shift in half
        contact lengths, >= 0; half the transit time divided by T_epsilon, > 0 and finite
        (V = 0, where it is not, has beta = 1 - |delta|/delta_star).
    alpha : float, T_epsilon/T_sigma, dimensionless, >= 1.
    Returns (beta, status): a float in [0, 1], found to 1e-16 + 4e-16 beta, and an int, OK (0) or NOT_CONVERGED (1)
    (:func:`brent`).

    At beta = 0 the residual is 1 + epsilon - 2 delta kappa/(mu lam) > 0, at beta = 1 it is -2 delta kappa/(mu lam) (1 +
    p) <= 0 by Eq. (8), where p = k(zeta) r(alpha zeta).  So delta = 0 gives beta = 1, to rounding.
    """
    creep = 2.0 * delta_abs * kappa / (mu * lam)
    # 1 + epsilon - beta - creep leaves beta no better than that: asking for more would chase rounding
    return brent(_EQ_10, (1.0 + epsilon, creep, zeta, alpha), 0.0, 1.0, 0.5 * _EPS)


@kernel
def direct_traction(beta, delta_abs, kappa, mu, lam, epsilon, zeta):
    """Return the traction |Q| by Eq. (15), divided by the load, in partial slip, V not 0.

    beta : float, length of the stick zone divided by that of the contact, in [0, 1], of :func:`direct_stick`.
    delta_abs : float, |delta|, dimensionless, below delta_star.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in [alpha^(-1/2), 1]; shift in half
        contact lengths, >= 0; half the transit time divided by T_epsilon, > 0 and finite.
    Returns a float, dimensionless, in [0, mu] but for rounding, which may leave less than 0 at delta = 0; exactly mu
    where beta zeta is 0, in the limit of full slip.

    1 - Q/mu is formed, so slight creep leaves few digits: Q is off by 1e-10 relative at s = 1e-6 (1e-8 for kappa V =
    1e3, where K1/K0 magnifies the rounding of the bracket).  That magnification grows in proportion to V: 1e-13 mu at
    kappa V = 1e4, 2e-9 mu at 1e8.
    """
    k = ratio_k0k1(beta * zeta)
    if k == 0.0:
        return mu
    bracket = 1.0 + epsilon - beta - 2.0 * delta_abs * kappa / (mu * lam)
    return mu * (1.0 - beta * beta * lam * lam - 2.0 * beta * lam * lam * bracket / k)


@kernel
def direct_moment(kappa, lam, epsilon, zeta, alpha):
    """Return the modulus |M| of the rolling moment by Eq. (16), divided by load times radius, V not 0.

    kappa : float, slenderness R/l0, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in [alpha^(-1/2), 1]; shift in half
        contact lengths, >= 0; half the transit time divided by T_epsilon, > 0 and finite.
    alpha : float, T_epsilon/T_sigma, dimensionless, >= 1.
    Returns a float, dimensionless, > 0 in exact numbers; for alpha = 1 it is 0, where rounding may leave a small number
    of either sign.

    lam^2 - 1/alpha cancels at high speed and for alpha near 1: for alpha = 11, M is off by 9e-14 relative at kappa V =
    1e2, 1e-9 at 1e4, 10 % at 1e8; for alpha = 1.01 by 2e-9 and for alpha = 1 + 1e-6 by 9e-5 somewhere below kappa V =
    1e3.
    """
    return lam / kappa * (0.5 * epsilon * (1.0 - lam * lam) + 0.5 / zeta * (lam * lam - 1.0 / alpha))
