"""The law from the modes of a material: functions that rows are fitted to, N, and stresses.

Letters (docs/theory_materials.md): z is half the transit time of the contact or of its stick zone,
zeta or eta; a_i = 1/tau_i and b_j = 1/T_j are the rates of relaxation and of creep, E_i the
strengths of relaxation, alpha the instantaneous divided by the long-time modulus; g, h and X_i are
functions of z, r = I1/I0, k = K0/K1 and i2 = I2/I0 ratios of Bessel functions
(:mod:`.material_series`, :mod:`.bessel_ratios`).  V > 0, kappa = R/l0; lam = 2 kappa V zeta is the
contact length divided by l0, beta = eta/zeta.

**What rows are fitted to** are the functions of :mod:`.material_series` with slopes over ln(1/z),
and N.

N of M = M(V) + N(V) V', the first-order term of unsteady rolling where speed changes slowly, has a
closed form (docs/theory_materials.md, Slowly changing speed): with y = sum X_i i2(a_i z), H = z^2 +
2 z h, theta = 2 H/H', T_mean = sum E_i tau_i and ' = d/dz,

    W = H g - 2 z (h - z h') g - z H g' + z^2 (y - z y')
    U = H g_s - g H_s + z^2 (y_s + T_mean g)
    N = -[(3/2) U - (theta/2) U' + (theta g' - g) W]/H

An index s is the derivative in s at s = 0, where s is subtracted from all rates a_i and b_j
(:mod:`.material_series`).  (Divided by 1 + T_mean s, which makes the long-time modulus 1 again, h
and y gain T_mean times themselves and g nothing: hence the last term of U.)  Unit of N: that of
time squared.

**Pressure and shear** along the contact, Eqs. (11)-(14), in a form where nothing cancels.  As
printed the integrals start at the rear edge and lose a factor exp(2 alpha zeta).  Here, with Y
measured from the middle of the contact as a time, p(z) = r(alpha z) k(z), c = 1 - 1/alpha, B =
c/(1 + p), cos phi = Y/z,

    S(Y; z) = sqrt(z^2 - Y^2)
              + alpha z B Int_0^phi (r(alpha z) + cos t) exp(-alpha (z cos t - Y)) dt
    p/E'    = V/(4 pi) S(Y; zeta)
    |tau|/E' = mu V/(4 pi) [S(Y; zeta) - S(Y - (zeta - eta); eta)]    (second term: stick zone)

Inside, lengths are in half contacts: u = 1 - Y/z from the front edge, w = 1 + Y/z from the rear
edge (each passed on its own: 2 - u would spoil a small w), S/z instead of S.  V zeta = lam/(2
kappa) then removes the speed from the formulas, and V = 0 is zeta = inf: Hertz.

With D(t) = cos t - cos phi and a = alpha z the integrand is (w - (1 - r) + D) exp(-a D).  Only the
part of [0, phi] with a D <= 38 counts; one Gauss-Legendre rule on it serves every a.  Against 40
digits S is within 3e-15 of its peak and 2e-14 of itself for a from 1e-8 to 1e8, alpha from 1.01 to
1e4 (28 nodes; 24 leave about 1e-11 of the peak).  Of several modes the second term of S is a sum
over the modes, with the weight a_i X_i in place of alpha B and a_i in place of alpha elsewhere.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numerics.interpolation import gauss, to_doubles
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import LANES, broadcast, pack, store, unpack
from .bessel_ratios import asymptotic_series, ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from .law_record import element
from .material_series import (
    FUNCTIONS,
    evaluate_functions,
    evaluate_ratios,
    new_workspace,
    reciprocal,
)

# --- What the rows of one material are fitted to ---

#: From this argument on r and k come from their asymptotic series, whose derivatives keep their
#: digits.
_ASYMPTOTIC = 64.0
#: Coefficients of the asymptotic series of r.
_SERIES_R = to_doubles(asymptotic_series(-1))
#: Coefficients of the asymptotic series of k.
_SERIES_K = to_doubles(asymptotic_series(1))
#: From this multiple of the longest creep time on N has its limit V -> 0, to rounding.
_SLOW = 1e17
#: Below this multiple of the shortest relaxation time N has its limit of fast rolling, to rounding.
_FAST = 1e-9


@kernel
def _evaluate_asymptotic(terms, x):
    """Evaluate the asymptotic series sum a_n x^-n of r or k, with its first two derivatives.

    Of large x the Riccati equations would give derivatives as differences that have lost their
    digits.

    terms : coefficients a_0, a_1, ..., of which a_0 = 1 is not read, (terms,), floats.
    x : float, argument a_i z or b_j z, 64 or more, dimensionless; it may be infinite.
    Returns (value, first derivative, second derivative) over x, floats, dimensionless; (1, 0, 0) at
    infinity.
    """
    w = 1.0 / x
    # Sums of a_n x^-n, -n a_n x^-(n + 1) and n (n + 1) a_n x^-(n + 2), by Horner's scheme in 1/x
    # from n = 1 on, without the last powers of w, which the returned values have.
    value = slope = second_derivative = 0.0
    for n in range(terms.size - 1, 0, -1):
        value = value * w + terms[n]
        slope = slope * w - n * terms[n]
        second_derivative = second_derivative * w + n * (n + 1) * terms[n]
    return 1.0 + value * w, slope * w * w, second_derivative * w * w * w


@inline_kernel
def _jet(rate, z, function):
    """Return the jet of a function of x = (rate - s) z at s = 0: a vector of four, value, d/dz,
    d/ds, d2/dz ds.

    It turns derivatives over x, which the ratios of Bessel functions have, into those over z and s
    (:mod:`.material_series`).

    rate : float, a_i or b_j, rate of the mode, > 0.
    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the rate.
    function : (value f, first derivative f', second derivative f'') over x, floats, at x = rate z.
    Returns the vector (f, rate f', -z f', -f' - rate z f'').
    """
    value, slope, second_derivative = function
    return pack(value, rate * slope, -z * slope, -slope - rate * z * second_derivative)


@kernel
def _write_ratio_jets(z, series, work):
    """Write value, d/dz, d/ds and d2/dz ds of 1/r, k and i2 of every mode; s is subtracted from the
    rates, s = 0.

    r = I1/I0 and i2 = I2/I0 are ratios of Bessel functions at a_i z, k = K0/K1 at b_i z.

    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the series; at
        infinity values are 1 and derivatives over s are NaN.
    series : :class:`.material_series.Series`, of which the rates a and b are read.
    work : :class:`.material_series.Workspace` of the series, whose ``inverse_r``, ``k`` and ``i2``
        are written, four numbers a mode, as of :func:`_jet`.  Returns nothing.
    """
    for i in range(series.a.size):
        a = series.a[i]
        b = series.b[i]
        x = a * z
        r, complement = ratio_r(x)
        dr = slope_r(x, r, complement)
        ddr = (r / x - dr) / x - 2.0 * r * dr  # derivative of r' = 1 - r/x - r^2
        if x >= _ASYMPTOTIC:
            r, dr, ddr = _evaluate_asymptotic(_SERIES_R, x)
        i2 = ratio_i2(x, r)
        # Below 4 i2 is not a difference (ratio_i2), and its derivatives follow from it; from 4 on
        # they are those of the difference 1 - 2 r/x.
        if x < 4.0:  # i2' = r - (2/x + r) i2, by I2' = I1 - 2 I2/x and I0' = I1
            di2 = r - (2.0 / x + r) * i2
            ddi2 = dr - 2.0 * (di2 - i2 / x) / x - di2 * r - i2 * dr
        else:
            di2 = 2.0 * (r / x - dr) / x
            ddi2 = (4.0 * (dr - r / x) / x - 2.0 * ddr) / x
        x = b * z
        k, complement = ratio_k(x)
        dk = slope_k(x, k, complement)
        ddk = 2.0 * k * dk + (dk - k / x) / x  # derivative of k' = k^2 + k/x - 1
        if x >= _ASYMPTOTIC:
            k, dk, ddk = _evaluate_asymptotic(_SERIES_K, x)
        store(work.inverse_r, LANES * i, reciprocal(True, _jet(a, z, (r, dr, ddr))))
        store(work.i2, LANES * i, _jet(a, z, (i2, di2, ddi2)))
        store(work.k, LANES * i, _jet(b, z, (k, dk, ddk)))


@kernel
def _evaluate_N(z, series, of_g, of_h, of_y):
    """Return N, the factor of dV/dt in M = M(V) + N dV/dt, at z = zeta > 0, by the closed form of
    the module docstring.

    z : float, zeta, half transit time of the contact, > 0, in the unit of time of the series;
        infinite for V = 0.
    series : :class:`.material_series.Series` of at least one mode, with ascending rates a and b,
        which are read, and the strengths e.
    of_g, of_h, of_y : jets of g, h and sum X_i i2_i at z (:mod:`.material_series`), vectors of
        four: value, d/dz, d/ds, d2/dz ds; not read where a limit is returned.

    Returns a float, in the unit of time of the series, squared.  From z = 1e17 times the longest
    creep time on it is the limit V -> 0, -sum E_i tau_i^2; below z = 1e-9 times the shortest
    relaxation time it is that of fast rolling, z^2 sum E_i/4.  It is 0 for alpha = 1.
    """
    T_mean = relaxed = strength = 0.0  # sums of E_i tau_i, E_i tau_i^2 and E_i
    for i in range(series.a.size):
        square = series.e[i] * series.e[i]
        T_mean += square
        relaxed += square / series.a[i]
        strength += square * series.a[i]
    if not z * series.b[0] < _SLOW:  # true of z = inf too
        return -relaxed
    if z * series.a[series.a.size - 1] < _FAST:
        return 0.25 * strength * z * z
    g, dg, g_s, dg_s = unpack(of_g)
    h, dh, h_s, dh_s = unpack(of_h)
    y, dy, y_s, dy_s = unpack(of_y)
    H = z * (z + 2.0 * h)
    dH = 2.0 * (z + h + z * dh)
    H_s = 2.0 * z * h_s
    dH_s = 2.0 * (h_s + z * dh_s)
    # y_s + T_mean g stands in the last term of U, here with its slope; d in front is d/dz
    y_s = y_s + T_mean * g
    dy_s = dy_s + T_mean * dg
    W = H * g - 2.0 * z * (h - z * dh) * g - z * H * dg + z * z * (y - z * dy)
    U = H * g_s - g * H_s + z * z * y_s
    dU = (dH * g_s + H * dg_s) - (dg * H_s + g * dH_s) + z * (2.0 * y_s + z * dy_s)
    theta = 2.0 * H / dH
    return -(1.5 * U - 0.5 * theta * dU + (theta * dg - g) * W) / H


@inline_kernel
def set_alpha_of_state(n, alpha, series):
    """Write the alpha of state ``n`` into a series of one mode, whose creep time is the unit of
    time.

    Loops over states whose alphas differ call it before each state, and so reuse one series and one
    workspace.

    n : int, index of the state, from 0 to the number of states - 1; not checked.
    alpha : instantaneous divided by long-time stiffness, >= 1, (1,) for all states or (states,);
        empty: the series is complete and nothing is written.
    series : :class:`.material_series.Series` of one mode with b = 1 and Q = 1, of which a[0] =
        alpha and e[0] = t[0] = sqrt((alpha - 1)/alpha) are written; any series if ``alpha`` is
        empty.  Returns nothing.
    """
    if alpha.size > 0:
        one_alpha = element(alpha, n)
        # one mode with the creep time 1: tau = 1/alpha, E_1 = alpha - 1 and J_1 = (alpha - 1)/alpha
        series.a[0] = one_alpha
        series.e[0] = series.t[0] = np.sqrt((one_alpha - 1.0) / one_alpha)


@kernel
def modes_loop(series, alpha, work, z, out):
    """Evaluate the functions of a series, their slopes and N at many z.

    series : :class:`.material_series.Series` of at least one mode: rates and strengths; of one
        mode, and overwritten, if ``alpha`` is not empty.
    alpha : instantaneous divided by long-time stiffness, >= 1, of a series of one mode, (1,) for
        all z or (n,); empty: the series is complete.
    work : the :class:`.material_series.Workspace` of the series, scratch.
    z : values of zeta > 0, (n,), in the unit of time of the series.  Where z is infinite, values
        and N are the limits at rest, and slopes are NaN.
    out : (9, n), written.  Rows 0 to 3: g/z, h/z, m of the half-space, m of the cylinder (m = M/V,
        in the unit of time); rows 4 to 7: their slopes over ln(1/z); row 8: N of M = M(V) + N
        dV/dt, in the unit of time squared.  For alpha = 1 all are 0, but for those NaNs.  Returns
        nothing.
    """
    for n in range(z.size):
        set_alpha_of_state(n, alpha, series)
        _write_ratio_jets(z[n], series, work)
        g, h, y = evaluate_functions(True, pack(z[n], 1.0, 0.0, 0.0), series, work)
        # a function is a jet, of which value and d/dz are read; d/d ln(1/z) = -z d/dz
        for row in range(FUNCTIONS):
            out[row, n] = work.functions[LANES * row]
            out[FUNCTIONS + row, n] = -z[n] * work.functions[LANES * row + 1]
        out[2 * FUNCTIONS, n] = _evaluate_N(z[n], series, g, h, y)


# --- Pressure and shear along the contact, Eqs ---

#: Nodes of the Gauss-Legendre rule on [0, 1]: 24 nodes leave 1e-11 of the peak, 28 leave rounding.
_NODES = gauss(28)[0]
#: Weights of that rule.
_WEIGHTS = gauss(28)[1]
#: Exponent beyond which the integrand is nothing: exp(-38) = 3e-17.
_DEEP = 38.0


class MemoryWeights(NamedTuple):
    """The strengths of the modes at one z, which all points of a contact have in common; filled by
    :func:`unit_shape`.

    complement : 1 - r(a_i z) of each mode, in [0, 1], (modes,).
    z : the z to which they belong, (1,); NaN if they belong to none yet.
    work : :class:`.material_series.Workspace` of the series, whose ``y`` holds the X_i.
    """

    complement: Any
    z: Any
    work: Any


class Points(NamedTuple):
    """Arrays of length 1, for all points, or with one value for each point; all dimensionless.

    x : position in l0 from the foot of the axis, positive in the direction of V.
    kappa, mu : of the scene, > 0.
    lam, epsilon, beta, zeta : state of the contact; zeta, in the unit of time of the series, is inf
        at V = 0.
    """

    x: Any
    kappa: Any
    mu: Any
    lam: Any
    epsilon: Any
    beta: Any
    zeta: Any


@kernel
def _memory_integral(u, w, a, r_complement):
    """Return the memory integral of one relaxation mode at a point of the contact.

    u, w : floats, distances from the front and the rear edge, divided by half the contact length, >
        0; u + w = 2.
    a : float, a_i z (of one mode alpha z): half transit time z times the rate of the mode,
        dimensionless, > 0, finite.
    r_complement : float, 1 - r(a), r the ratio I1/I0, in (0, 1].

    Returns Int_0^phi (r + cos t) exp(-a (cos t - cos phi)) dt with cos phi = 1 - u = w - 1, a
    float, dimensionless, found to rounding by 28 Gauss-Legendre nodes.  The integral over [0, pi]
    is zero.  Near the rear edge, where w < 1 and a w < 1, it is therefore taken over the small rest
    [phi, pi], with the other sign, where a (cos phi - cos t) <= a w < 1.  Elsewhere, if a u > 38,
    the part of [0, phi] where a (cos t - cos phi) exceeds 38 is left out.
    """
    # Of u and w the smaller one is used where it matters: cos phi itself would lose the digits of a
    # small u or w.
    rear = w < 1.0 and a * w < 1.0
    sine = np.sqrt(u * w)  # sin phi, as cos phi = 1 - u = w - 1
    edge = w if rear else u  # from the rear edge near it, else from the front edge
    # phi, or pi - phi near the rear edge, by tan(phi/2) = sqrt(u/w); ``span`` is the length of the
    # interval of integration.
    angle = 2.0 * np.arctan2(np.sqrt(edge), np.sqrt(u if rear else w))
    span = angle
    if not rear and a * u > _DEEP:
        # a D = _DEEP at t = deep: D = 2 sin((phi + deep)/2) sin((phi - deep)/2)
        depth = _DEEP / a
        deep = 2.0 * np.arctan2(np.sqrt(u - depth), np.sqrt(w + depth))
        span = 2.0 * np.arcsin(min(0.5 * depth / np.sin(0.5 * (angle + deep)), 1.0))
    half_span = 0.5 * span
    sign = -1.0 if rear else 1.0
    offset = w - r_complement  # r + cos phi: the factor of the exponential is this plus D
    total = 0.0
    for n in range(_NODES.size):
        # t = phi - v (or phi + v): D = +-2 sin(v/2) sin(phi -+ v/2), with v/2 = half_span times the
        # node; 1 - edge is cos phi, near the rear edge -cos phi
        s = np.sin(half_span * _NODES[n])
        D = sign * 2.0 * s * (sine * np.sqrt(1.0 - s * s) - (1.0 - edge) * s)
        total += _WEIGHTS[n] * (offset + D) * np.exp(-a * D)
    return sign * span * total


def new_memory_weights(series) -> MemoryWeights:
    """Return :class:`MemoryWeights` for ``series``, a :class:`.material_series.Series`, whose
    number of modes is read; they belong to no z yet: z is NaN, and the other arrays are not
    initialized.
    """
    n = series.a.size
    return MemoryWeights(np.empty(n), np.full(1, np.nan), new_workspace(n))


@kernel
def unit_shape(u, w, z, series, weights):
    """Return S/z, the shape of the pressure of Eqs. (11)-(14), at one point.

    u, w : floats, distances from the front and the rear edge, divided by half the contact length;
        u + w = 2.  One of them is <= 0 outside the contact.
    z : float, half transit time of the contact, or of the stick zone, > 0, in the unit of time of
        the series; inf is the elastic limit V = 0.
    series : :class:`.material_series.Series`: rates and strengths of the modes; it may have none.
    weights : :class:`MemoryWeights`, the strengths of the modes at z.  If they belong to another z,
        they are computed and written here; a caller that changes ``series`` has to set their z to
        NaN.

    Returns a float, dimensionless, >= 0: exactly 0.0 at the edges and outside the contact, where
    ``weights`` stays; sqrt(u w) for z = inf and for elastic bodies; else the sum of sqrt(u w) and
    the memory integrals of the modes, each times a_i X_i.  Modes with weight 0 or an infinite a_i z
    count as none.
    """
    if u <= 0.0 or w <= 0.0:
        return 0.0
    shape = np.sqrt(u * w)
    if z == np.inf:
        return shape
    if weights.z[0] != z:
        weights.z[0] = z
        places = broadcast(z)
        evaluate_ratios(places, series, weights.work)
        evaluate_functions(False, places, series, weights.work)
        for i in range(series.a.size):
            _, weights.complement[i] = ratio_r(series.a[i] * z)
    for i in range(series.a.size):
        a = series.a[i] * z
        weight = series.a[i] * weights.work.y[LANES * i]  # a_i X_i
        # an infinite a would leave an interval of length 0 and an exponent inf times 0, a NaN
        if weight > 0.0 and a < np.inf:
            shape += weight * _memory_integral(u, w, a, weights.complement[i])
    return shape


@kernel
def stress_loop(series, alpha, whole, stick, points, p, tau):
    """Compute pressure and shear stress at n points of the contact.

    series : :class:`.material_series.Series`: rates and strengths of the modes; of one mode, and
        overwritten, if ``alpha`` is not empty.
    alpha : instantaneous divided by long-time stiffness, >= 1, of a series of one mode, (1,) or
        (n,); empty: the series is complete.
    whole, stick : :class:`MemoryWeights` of the series for the contact and for the stick zone,
        scratch; they belong to no z at the begin (:func:`new_memory_weights`).
    points : :class:`Points`: position x/l0, kappa, mu and the contact state of each point, arrays
        of length 1 or n.
    p, tau : (n,) floats, written: pressure p/E' and modulus |tau|/E' of the shear stress at every
        point, dimensionless, >= 0, where E' = pi E/(1 - nu^2).  Both are 0 at the edges and outside
        the contact; in the slip zone, which is all of the contact for beta = 0, tau is mu p; for
        beta = 1 it is 0 but for rounding.  Returns nothing.
    """
    for i in range(p.size):
        # The series changes with alpha: the strengths of the modes at the last z no longer hold.
        if alpha.size > 1 and i > 0 and alpha[i] != alpha[i - 1]:
            whole.z[0] = stick.z[0] = np.nan
        set_alpha_of_state(i, alpha, series)
        lam = element(points.lam, i)
        epsilon = element(points.epsilon, i)
        beta = element(points.beta, i)
        zeta = element(points.zeta, i)
        # The middle of the contact is epsilon half lengths, epsilon lam/2, ahead of the axis: with
        # y = 2 x/lam, Y/zeta = y - epsilon, u = 1 - Y/zeta and w = 1 + Y/zeta.
        y = 2.0 * element(points.x, i) / lam
        u = (1.0 - y) + epsilon
        w = (1.0 + y) - epsilon
        # p/E' = V zeta/(4 pi) (S/zeta) with V zeta = lam/(2 kappa).
        scale = lam / (8.0 * np.pi * element(points.kappa, i))
        p[i] = scale * unit_shape(u, w, zeta, series, whole)
        # The second term of |tau|, (V eta/(4 pi)) (S/eta) with eta = beta zeta: the stick zone has
        # the same front edge, and half length beta, so that its u is u/beta.  Behind it, and for
        # beta = 0, the term is 0; a NaN of u passes on.
        stuck = 0.0
        if not u >= 2.0 * beta:
            stuck = beta * unit_shape(u / beta, 2.0 - u / beta, beta * zeta, series, stick)
        # at beta = 1 the difference is zero to rounding, of either sign
        tau[i] = element(points.mu, i) * max(p[i] - scale * stuck, 0.0)
