"""The contact law as the paper prints it, by root solves, to which tables are compared.

Eqs. (6), (8)-(10), (15), (16) and two Brent-Dekker roots, over arrays of states; rows and signs as
in :mod:`.law_record`.  It is independent of :mod:`.law_functions` in the Bessel ratios, in the
algebra and in the root finder: the baseline that the explicit law is timed against and checked
against.  The one liberty taken is that Eqs. (6) and (10) are divided by I0 K1, so that only r =
I1/I0 and k = K0/K1 occur and nothing overflows.

The two Bessel ratios are evaluated once more, by textbook methods that share nothing with
``ratios.npy``, an independent check of :mod:`.bessel_ratios`:

    ratio_i(x) = I1(x)/I0(x)        ratio_k0k1(z) = K0(z)/K1(z)

Each step count is fixed by the argument before the loop starts, so there is no convergence test to
fail.  Against 40 digits on 4800 arguments from 5e-324 to 1.8e308: at most 2.7 ULP (``ratio_i``,
near 25) and 3.6 ULP (``ratio_k0k1``, below 1), in 20 to 200 ns.

The printed forms lose digits in corners where the explicit ones do not.  Differences from
:mod:`.law_functions`, measured over alpha in [1, 1e4], kappa V in [1e-3, 1e3], s = delta/delta_star
in [1e-6, 1 - 1e-6]: lam 7e-16 relative, delta_star 4e-16 relative, beta 3e-15, Q 1.1e-13 mu, M
2e-13/kappa; the docstrings say where relative digits go.

Letters: kappa = R/l0, mu the coefficient of friction, alpha = T_epsilon/T_sigma; lam, length of the
contact over l0, epsilon, its shift in half contact lengths; zeta = lam/(2 kappa V), half the
transit time in T_epsilon; beta, stick zone over contact length; delta, creepage.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

import math

import numpy as np

from ..numerics.jit import kernel
from .law_record import element, read_state, slip_and_creepage, write_field

# --- The two Bessel ratios once more ---

#: Euler's constant.
_EULER_GAMMA = 0.57721566490153286061
#: ln 2.
_LN2 = 0.69314718055994530942
#: Argument from which on Hankel's expansion is used: its 20th term is below 4e-18 there.
_HANKEL_FROM = 25.0


def _hankel(order: int, sign: int) -> list[float]:
    """Return the coefficients of Hankel's expansion of a Bessel function in 1/x.

    order : int, 0 or 1, of the Bessel function.
    sign : int, -1 for sqrt(2 pi x) e^-x I(x), 1 for sqrt(2 x/pi) e^x K(x).
    Returns the 21 coefficients of ascending powers of 1/x, the first 1, a list of floats.
    """
    a = [1.0]
    for n in range(1, 21):
        a.append(sign * a[-1] * (4 * order**2 - (2 * n - 1) ** 2) / (8 * n))
    return a


def _temme_k0() -> list[list[float]]:
    """Return the first coefficients of q^n, q = z^2/4, of the two series of which K0(z) consists.

    Returns [coefficients of I0, coefficients of K0 + (ln(z/2) + gamma) I0], lists of ten floats, n
    = 0 first; gamma is Euler's constant.
    """
    plain = [1 / math.factorial(n) ** 2 for n in range(10)]
    return [plain, [sum(1 / i for i in range(1, n + 1)) * p for n, p in enumerate(plain)]]


def _temme_k1() -> list[list[float]]:
    """Return the first coefficients of q^n, q = z^2/4, of the two series of which z K1(z) consists.

    z K1 = 1 + sum_(n > 0) q^n/n!^2 (1 - 2 n f_n) with f_n = -(ln(z/2) + gamma) + 1 + 1/2 + ... +
    1/n.

    Returns [coefficients of z I1, coefficients of z K1 - 1 - (ln(z/2) + gamma) z I1], lists of ten
    floats, n = 0 first; gamma is Euler's constant.
    """
    # z I1 = sum 2 n q^n/n!^2, by which the logarithm of f_n is multiplied; the rest is 1/n!^2 less
    # 2 n/n!^2 times the harmonic sum, from n = 1 on
    i0, k0 = _temme_k0()
    return [
        [2 * n * i0[n] for n in range(10)],
        [0.0] + [i0[n] - 2 * n * k0[n] for n in range(1, 10)],
    ]


#: Hankel's expansion of I0.
_I0_TAIL = np.array(_hankel(0, -1))
#: Hankel's expansion of I1.
_I1_TAIL = np.array(_hankel(1, -1))
#: Hankel's expansion of K0.
_K0_TAIL = np.array(_hankel(0, +1))
#: Hankel's expansion of K1.
_K1_TAIL = np.array(_hankel(1, +1))
#: Temme's series of K0: what the logarithm is multiplied by, and the rest.
_K0 = np.array(_temme_k0())
#: Temme's series of z K1, likewise.
_K1 = np.array(_temme_k1())


@kernel
def _horner(t, coefficients):
    """Return the value at ``t`` of a polynomial with ``coefficients``, (n,), n > 0, the constant
    first, by Horner's scheme.
    """
    total = coefficients[coefficients.size - 1]
    for n in range(coefficients.size - 2, -1, -1):
        total = coefficients[n] + t * total
    return total


@kernel
def ratio_i(x):
    """Return r = I1/I0 by Gauss's continued fraction, evaluated from its tail; by Hankel's
    expansion from x = 25 on.

    x : argument, float >= 0, dimensionless; may be infinite, but not a NaN.
    Returns r, a float, dimensionless: 0 at x = 0, and below 1 in exact numbers; it is rounded to
    1.0 from x = 1e16 or so on, and is 1.0 at infinity.
    """
    if x >= _HANKEL_FROM:
        u = 1.0 / x
        return _horner(u, _I1_TAIL) / _horner(u, _I0_TAIL)
    # I_(n+1)/I_n = x/(2 n + 2 + x I_(n+2)/I_(n+1)): each step damps the error of the start by
    # (I_(n+1)/I_n)^2
    n = 12 + int(x)  # enough steps for rounding at every x < 25, as the module measured
    # the start: x/(n + 1/2 + sqrt((n + 3/2)^2 + x^2)), close to I_(n+1)/I_n
    tail = x / (n + 0.5 + np.sqrt((n + 1.5) * (n + 1.5) + x * x))
    for m in range(n, 0, -1):
        tail = x / (2.0 * m + x * tail)
    return tail


@kernel
def ratio_k0k1(z):
    """Return k = K0/K1 by Temme's series below 1, Steed's CF2 from its tail above, Hankel's
    expansion from 25 on.

    z : argument, float >= 0, dimensionless; may be infinite, but not a NaN.
    Returns k, a float, dimensionless: 0 at z = 0, and below 1 in exact numbers; it is rounded to
    1.0 from z = 1e16 or so on, and is 1.0 at infinity.
    """
    if z >= _HANKEL_FROM:
        u = 1.0 / z
        return _horner(u, _K0_TAIL) / _horner(u, _K1_TAIL)
    if z < 1.0:
        if z == 0.0:
            return 0.0
        # ln 2 - ln z and not -ln(z/2): half the smallest double is zero
        # ``f`` is -(ln(z/2) + gamma), which multiplies I0 in K0 and, with minus, z I1 in z K1
        f = (_LN2 - np.log(z)) - _EULER_GAMMA
        q = 0.25 * z * z
        k0 = f * _horner(q, _K0[0]) + _horner(q, _K0[1])
        z_k1 = 1.0 + (_horner(q, _K1[1]) - f * _horner(q, _K1[0]))
        return z * (k0 / z_k1)
    # K1/K0 = (z + 1/2 - h)/z with h = (1/4)/(2 (z + 1) - (9/4)/(2 (z + 2) - ...)); error exp(-4
    # sqrt(2 n z)), which is 5e-17 at n z = 44
    n = 5 + int(44.0 / z)
    tail = 0.0
    for m in range(n, 0, -1):
        tail = (m - 0.5) * (m - 0.5) / (2.0 * (z + m) - tail)
    return z / (z + (0.5 - tail))


# --- The contact law as the paper prints it ---

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
    """Return the left side of Eq. (6) or (10), divided by I0 K1 of the arguments that occur in it;
    its root is sought.

    equation : int, 6 (_EQ_6) or 10 (_EQ_10, and any other number); numba cannot cache a caller that
    passes a function.
    x : float, lam in Eq. (6), > 0; beta in Eq. (10), in [0, 1].
    data : tuple of four floats, dimensionless: in Eq. (6) kappa V > 0, alpha and two that are not
        used; in Eq. (10) 1 + epsilon, 2 |delta| kappa/(mu lam), zeta > 0 and alpha.
    Returns a float, dimensionless, that falls through 0 at the root.
    """
    if equation == _EQ_6:
        kappa_V, alpha, _, _ = data
        zeta = x / (2.0 * kappa_V)  # Eq. (7)
        r = ratio_i(alpha * zeta)
        k = ratio_k0k1(zeta)
        return (1.0 - x * x) * (1.0 + k * r) + 2.0 / zeta * (1.0 / alpha - 1.0) * (x * x) * r
    front, creep, zeta, alpha = data
    r = ratio_i(alpha * x * zeta)
    k = ratio_k0k1(x * zeta)
    return (front - x - creep) * (1.0 + r * k) + 1.0 / zeta * (1.0 / alpha - 1.0) * r * k


@kernel
def brent(equation, data, low, floor):
    """Find the root x of _residual(equation, x, data) in [low, 1] by the method of Brent and
    Dekker.

    equation, data : arguments of :func:`_residual`.
    low : float, begin of the bracket, at most its end 1 (equal for alpha = 1).
    floor : float, absolute tolerance, >= 0; the root is found to floor + 4e-16 |x|.
    Returns (root, status), a float and an int: OK (0); or NOT_CONVERGED (1), after 60 steps with
    the best value so far (NaN if the residual became NaN on the way), or with NaN for the root
    where the residual is NaN at an end.

    At most 10 steps were seen with kappa V in [1e-8, 1e8], alpha in [1, 1e4].  The residual falls
    from >= 0 at low to <= 0 at 1.  An end where it is 0, or where rounding spoils that sign, is
    itself the root, to rounding: 1 with a residual >= 0, else ``low`` with one <= 0, is
    returned as OK without a step, whatever the other end has.
    """
    a = low
    fa = _residual(equation, low, data)
    b = 1.0
    fb = _residual(equation, b, data)
    if fb >= 0.0:
        return b, OK
    if fa <= 0.0:
        return a, OK
    if not fa > fb:  # a NaN
        return np.nan, NOT_CONVERGED
    # b: best so far; a: the one before; c: the far end of the bracket; d: last step, e: the one
    # before it; fa, fb, fc: residuals
    c = a
    fc = fa
    d = e = b - a
    for _ in range(_MAX_STEPS):
        if abs(fc) < abs(fb):  # the far end is the better one: they change places
            a, b, c = b, c, b
            fa, fb, fc = fb, fc, fb
        tolerance = floor + 2.0 * _EPS * abs(b)
        half_interval = 0.5 * (c - b)
        if abs(half_interval) <= tolerance or fb == 0.0:
            return b, OK
        if abs(e) < tolerance or abs(fa) <= abs(fb):  # bisection
            d = e = half_interval
        else:  # step p/q: secant of two points, or inverse quadratic interpolation of three
            s = fb / fa
            if a == c:
                p = 2.0 * half_interval * s
                q = 1.0 - s
            else:
                q = fa / fc
                t = fb / fc
                p = s * (2.0 * half_interval * q * (q - t) - (b - a) * (t - 1.0))
                q = (q - 1.0) * (t - 1.0) * (s - 1.0)
            # p >= 0 with the sign of the step in q, for the comparisons below
            if p > 0.0:
                q = -q
            p = abs(p)
            # The step is taken if it stays well inside the bracket and is below half of the step
            # before the last one.
            if 2.0 * p < min(3.0 * half_interval * q - abs(tolerance * q), abs(e * q)):
                e = d
                d = p / q
            else:
                d = e = half_interval
        a = b
        fa = fb
        # at least by the tolerance, towards c, so that the root is soon enclosed within it
        b += d if abs(d) > tolerance else np.copysign(tolerance, half_interval)
        fb = _residual(equation, b, data)
        # the root is between b and the point before it, which becomes the far end
        if (fb > 0.0) == (fc > 0.0):
            c = a
            fc = fa
            d = e = b - a
    return b, NOT_CONVERGED


@kernel
def direct_contact_length(kappa_V, alpha):
    """Solve Eq. (6) for the length of the contact, with Eqs. (7) and (8) for its transit time and
    its shift.

    kappa_V : float, slenderness times |V|, > 0, dimensionless.
    alpha : float, T_epsilon/T_sigma, >= 1, dimensionless.
    Returns (lam, zeta, epsilon, status), three floats and an int: contact length divided by l0;
    half the transit time, divided by T_epsilon; shift in half contact lengths; OK (0), or
    NOT_CONVERGED (1) if lam was not found (:func:`brent`), and then all three are not to be used.
    alpha = 1 gives lam = 1 and epsilon = 0, to rounding.

    With c = 1 - 1/alpha, r = I1/I0 at alpha zeta, k = K0/K1 at zeta, p = k r, and i2 = I2/I0 = 1 -
    2 r/(alpha zeta), the residual is c (i2 + p) >= 0 at lam = alpha^(-1/2), and -2 c r/zeta <= 0 at
    lam = 1, each with the zeta of its lam: the two always enclose the root.  lam^-2 - 1 costs
    epsilon its relative digits where epsilon -> kappa V c is small (4e-9 at kappa V = 1e-8, alpha =
    11), but 1 + epsilon, which is what Eqs. (9) and (10) need, none.
    """
    lam, status = brent(_EQ_6, (kappa_V, alpha, 0.0, 0.0), 1.0 / np.sqrt(alpha), 0.0)
    zeta = lam / (2.0 * kappa_V)
    epsilon = 0.5 * (1.0 / (lam * lam) - 1.0) * ratio_k0k1(zeta)
    return lam, zeta, epsilon, status


@kernel
def direct_delta_star(kappa, mu, lam, epsilon):
    """Return the critical creepage delta_star by Eq. (9), at which full slip begins: mu lam (1 +
    epsilon)/(2 kappa).

    kappa : float, slenderness R/l0, dimensionless, > 0.
    mu : float, coefficient of friction, dimensionless, > 0.
    lam, epsilon : floats, length divided by l0, and shift in half contact lengths, of the contact,
        Eqs. (6), (8); 1 and 0 at V = 0.
    Returns a float, dimensionless, > 0.
    """
    return mu * lam * (1.0 + epsilon) / (2.0 * kappa)


@kernel
def direct_stick(delta_abs, kappa, mu, lam, epsilon, zeta, alpha):
    """Solve Eq. (10) for beta, the length of the stick zone divided by that of the contact, in
    partial slip, V not 0.

    delta_abs : float, |delta|, dimensionless, 0 <= delta_abs < delta_star.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in
        [alpha^(-1/2), 1]; shift in half contact lengths, >= 0; half the transit time divided by
        T_epsilon, > 0 and finite (V = 0, where it is not, has beta = 1 - |delta|/delta_star).
    alpha : float, T_epsilon/T_sigma, dimensionless, >= 1.
    Returns (beta, status): a float in [0, 1], found to 1e-16 + 4e-16 beta, and an int, OK (0) or
    NOT_CONVERGED (1) (:func:`brent`).

    At beta = 0 the residual is 1 + epsilon - 2 delta kappa/(mu lam) > 0, at beta = 1 it is -2 delta
    kappa/(mu lam) (1 + p) <= 0 by Eq. (8), where p = k(zeta) r(alpha zeta).  So delta = 0 gives
    beta = 1, to rounding.
    """
    creep = 2.0 * delta_abs * kappa / (mu * lam)
    # 1 + epsilon - beta - creep leaves beta no better than that: asking for more would chase
    # rounding
    return brent(_EQ_10, (1.0 + epsilon, creep, zeta, alpha), 0.0, 0.5 * _EPS)


@kernel
def direct_traction(beta, delta_abs, kappa, mu, lam, epsilon, zeta):
    """Return the traction |Q| by Eq. (15), divided by the load, in partial slip, V not 0.

    beta : float, length of the stick zone divided by that of the contact, in [0, 1], of
    :func:`direct_stick`.
    delta_abs : float, |delta|, dimensionless, below delta_star.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in
        [alpha^(-1/2), 1]; shift in half contact lengths, >= 0; half the transit time divided by
        T_epsilon, > 0 and finite.
    Returns a float, dimensionless, in [0, mu] but for rounding, which may leave less than 0 at
    delta = 0; exactly mu where beta zeta is 0, in the limit of full slip.

    1 - Q/mu is formed, so slight creep leaves few digits: Q is off by 1e-10 relative at s = 1e-6
    (1e-8 for kappa V = 1e3, where K1/K0 magnifies the rounding of the bracket).  That magnification
    grows in proportion to V: 1e-13 mu at kappa V = 1e4, 2e-9 mu at 1e8.
    """
    k = ratio_k0k1(beta * zeta)
    if k == 0.0:  # beta zeta = 0: the last term of Eq. (15), bracket/k, would be 0/0 or infinite
        return mu
    bracket = 1.0 + epsilon - beta - 2.0 * delta_abs * kappa / (mu * lam)
    return mu * (1.0 - beta * beta * lam * lam - 2.0 * beta * lam * lam * bracket / k)


@kernel
def direct_moment(kappa, lam, epsilon, zeta, alpha):
    """Return the modulus |M| of the rolling moment by Eq. (16), divided by load times radius, V not
    0.

    kappa : float, slenderness R/l0, dimensionless, > 0.
    lam, epsilon, zeta : floats of the contact, Eqs. (6)-(8): length divided by l0, in
        [alpha^(-1/2), 1]; shift in half contact lengths, >= 0; half the transit time divided by
        T_epsilon, > 0 and finite.
    alpha : float, T_epsilon/T_sigma, dimensionless, >= 1.
    Returns a float, dimensionless, > 0 in exact numbers; for alpha = 1 it is 0, where rounding may
    leave a small number of either sign.

    lam^2 - 1/alpha cancels at high speed and for alpha near 1: for alpha = 11, M is off by 9e-14
    relative at kappa V = 1e2, 1e-9 at 1e4, 10 % at 1e8; for alpha = 1.01 by 2e-9 and for alpha =
    1 + 1e-6 by 9e-5 somewhere below kappa V = 1e3.
    """
    return (
        lam / kappa * (0.5 * epsilon * (1.0 - lam * lam) + 0.5 / zeta * (lam * lam - 1.0 / alpha))
    )


# --- The contact law as printed, over arrays of states ---


@kernel
def direct_loop(alpha, request, count):
    """Evaluate by the equations as printed what is requested of ``count`` states; V = 0 is the
    limit V -> 0+ of Sect. 3.4.

    alpha : T_epsilon/T_sigma, >= 1, dimensionless, (1,), or (count,) with one for each state.
    request : :class:`.law_record.Request`: states (V finite), and for each quantity its
        row of ``out``, -1 if it is not requested.  Of lam, zeta, epsilon, delta_star, delta,
        full_slip (1.0 or 0.0), beta, Q and M those that are requested are written for state n into
        column n + ``first``, dimensionless; other quantities never are.  The states are evaluated
        in their own order: ``order`` is not read.
    count : int, number of states; 0 writes nothing.

    Returns the status, an int: OK (0), or NOT_CONVERGED (1) if lam or beta of at least one state
    was not found; all states are evaluated and written in that case too, and the quantities of that
    state are not to be used.

    At V = 0: lam = 1, zeta = inf, epsilon = M = 0, beta = 1 - s and |Q| = mu s (2 - s), with
    s = |delta|/delta_star; delta, if omega is given, is 0 for omega = 0 and else infinite.  In full
    slip, |delta| >= delta_star: beta = 0 and |Q| = mu.  M has the sign of V, Q that of omega - V; 0
    where that is 0.
    """
    to = request.to
    status = stick_status = worst = OK
    for n in range(count):
        own_alpha = element(alpha, n)
        state = read_state(request.states, n)
        kappa = state.kappa
        mu = state.mu
        speed = abs(state.V)
        slip, delta = slip_and_creepage(state)
        lam = 1.0
        zeta = np.inf
        epsilon = M = 0.0
        if speed > 0.0:
            lam, zeta, epsilon, status = direct_contact_length(kappa * speed, own_alpha)
            M = np.sign(state.V) * direct_moment(kappa, lam, epsilon, zeta, own_alpha)
        delta_star = direct_delta_star(kappa, mu, lam, epsilon)
        full_slip = abs(delta) >= delta_star
        # of full slip, also for an infinite delta at V = 0
        beta = 0.0
        Q = mu
        # at V = 0 zeta is infinite, which Eqs. (10) and (15) cannot take: their limit
        if not full_slip and speed == 0.0:
            s = abs(delta) / delta_star
            beta = 1.0 - s
            Q = mu * s * (2.0 - s)
        elif not full_slip:
            beta, stick_status = direct_stick(abs(delta), kappa, mu, lam, epsilon, zeta, own_alpha)
            Q = direct_traction(beta, abs(delta), kappa, mu, lam, epsilon, zeta)
        write_field(to.lam, lam, n, request)
        write_field(to.zeta, zeta, n, request)
        write_field(to.epsilon, epsilon, n, request)
        write_field(to.delta_star, delta_star, n, request)
        write_field(to.delta, delta, n, request)
        write_field(to.full_slip, 1.0 if full_slip else 0.0, n, request)
        write_field(to.beta, beta, n, request)
        write_field(to.Q, np.sign(slip) * Q, n, request)
        write_field(to.M, M, n, request)
        worst |= status | stick_status
    return worst
