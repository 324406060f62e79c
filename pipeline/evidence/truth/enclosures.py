"""The contact law in ball arithmetic: every value comes with a proven bound on its error.

The reduced form of the law, H(zeta) = 1/(2 kappa V)^2 and F(eta) = F(zeta) - delta/(mu V), with
the Bessel functions and the error bounds of Arb (python-flint).  A root is a ball at whose ends
the enclosed function, which rises strictly, lies certainly below and certainly above.  Digits
that cancel show as a wide ball, and the whole is done again with more.

``tests/truth/test_enclosures.py`` puts the balls into the equations as printed.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from viscoroll.core.errors import ConvergenceError
from viscoroll.core.extras import imported

INPUTS = ("alpha", "kappa", "mu", "V", "delta")
_MOST_BITS = 1 << 14
_MOST_STEPS = 100
#: log2 of the relative step of the differences in :func:`condition_numbers` and :func:`slopes`
_STEP_BITS = 180


def contact_enclosure(alpha: float, kappa: float, mu: float, V: float, delta: float, bits: int = 100) -> dict[str, Any]:
    """State of the contact, Eqs. (6), (8)-(10), (15)-(18), each value an ``arb`` that contains it.

    Parameters
    ----------
    alpha : >= 1.
    kappa, mu : > 0.
    V : velocity of the axis, any sign, not 0.
    delta : creep ratio, any sign.
    bits : relative accuracy of every ball.

    Returns
    -------
    dict
        lam, zeta, epsilon, delta_star, beta, Q, M as ``flint.arb``; full_slip as bool.

    Notes
    -----
    Inputs are taken as the doubles they are.  Every ball contains the exact value, and its radius is at
    most 2^-``bits`` of it (``tests/truth/test_enclosures.py``).
    """
    flint = _flint()
    given = (alpha, kappa, mu, abs(V), abs(delta))
    state = enclosed({name: flint.arb(float(value)) for name, value in zip(INPUTS, given, strict=True)}, bits)
    with flint.ctx.workprec(_MOST_BITS):  # a change of sign shall not round
        if V < 0.0:
            state["M"] = -state["M"]
        if delta != 0.0 and (V < 0.0) != (delta < 0.0):
            state["Q"] = -state["Q"]
    return state


def enclosed(given: dict[str, Any], bits: int) -> dict[str, Any]:
    """``contact_enclosure`` of exact balls with V > 0 and delta >= 0."""
    flint, working = _flint(), bits + 60
    while working <= _MOST_BITS:
        with flint.ctx.workprec(working):
            state = _state(**given)
        if state is not None and all(state[name].rel_accuracy_bits() >= bits for name in state if name != "full_slip"):
            return state
        working += working // 2
    raise ConvergenceError(f"contact_enclosure: {_MOST_BITS} bits do not suffice")


def condition_numbers(given: dict[str, Any], bits: int = 40) -> dict[str, float]:
    """Sum over the inputs of |d ln f/d ln input| for every f: the relative error of f for one in each input.

    By differences with a relative step of 2^-180, far above the balls and far below anything that bends; alpha moves
    up, away from 1, and delta down, away from delta_star.
    """
    flint, bits = _flint(), bits + _STEP_BITS
    base = enclosed(given, bits)
    del base["full_slip"]
    total = dict.fromkeys(base, 0.0)
    with flint.ctx.workprec(2 * bits):
        step = flint.arb(2) ** -_STEP_BITS
        for name in INPUTS:
            moved = enclosed(given | {name: given[name] * (1 - step if name == "delta" else 1 + step)}, bits)
            for field, value in base.items():
                if value != 0:
                    total[field] += float(abs((moved[field] / value - 1) / step).mid())
    return total


def slopes(given: dict[str, Any], bits: int = 100) -> dict[str, Any]:
    """dQ_dV and dM_dV at fixed delta, dQ_ddelta at fixed V, by central differences that know no formula.

    V > 0 and 0 < delta < delta_star.  Their own error is of the order of the step squared, 2^-360.
    """
    flint = _flint()
    bits += _STEP_BITS
    found = {}
    with flint.ctx.workprec(4 * bits):
        step = flint.arb(2) ** -_STEP_BITS
        for by in ("V", "delta"):
            up, down = (enclosed(given | {by: given[by] * (1 + sign * step)}, bits) for sign in (1, -1))
            for name in ("Q", "M") if by == "V" else ("Q",):
                found[f"d{name}_d{by}"] = (up[name] - down[name]) / (2 * step * given[by])
    return found


def shape_enclosure(Y: Any, z: Any, alpha: Any) -> Any:
    """S(Y; z) of the stresses, Eqs. (11)-(14), 0 where |Y| >= z; at the working precision.

    p/E' = V/(4 pi) S(X - g(zeta); zeta), X = x/(l0 kappa V), and the shear is mu times the difference of
    two such; the integral is Arb's, with its proven bound.
    """
    flint = _flint()
    arb, acb = flint.arb, flint.acb
    if abs(Y) >= z:
        return arb(0)
    ellipse = ((z - Y) * (z + Y)).sqrt()
    if alpha == 1:
        return ellipse
    r, k = ratio_r(alpha * z), ratio_k(z)
    angle = (Y / z).acos()

    def memory(u: Any, _: bool) -> Any:
        cosine = (u * angle).cos()
        return (r + cosine) * (alpha * (Y - z * cosine)).exp()

    integral = acb.integral(memory, 0, 1, rel_tol=arb(2) ** -100, abs_tol=arb(2) ** -300)
    return ellipse + (alpha - 1) * z / (1 + r * k) * angle * integral.real


def ratio_r(x: Any) -> Any:
    """I1/I0 at x > 0."""
    return x.bessel_i(1, scaled=True) / x.bessel_i(0, scaled=True)


def ratio_i2(x: Any) -> Any:
    """I2/I0 at x > 0."""
    return x.bessel_i(2, scaled=True) / x.bessel_i(0, scaled=True)


def ratio_k(z: Any) -> Any:
    """K0/K1 at z > 0: Arb's asymptotic expansion, where that has the digits, else the power series.

    (Arb's own way at middling z takes seconds at integer order.)  The series is taken at the middle of
    the ball, where it may cancel; 0 < k' < k/z < k/z at the lower end carries the radius over.
    """
    flint = _flint()
    if 5 * z > 3 * flint.ctx.prec:  # exp(-2 z) is far below the last digit
        return z.bessel_k(0, scaled=True) / z.bessel_k(1, scaled=True)
    middle = z.mid()
    with flint.ctx.extraprec(64 * (int(3 * float(z.upper())) // 64 + 2)):  # K0 I0 cancels from I0^2, e^(2 z) larger
        k0, i0, i1 = _k0_series(middle)
        k = k0 * i0 / (1 / middle - i1 * k0)
    return k + flint.arb(0, (z.rad() * k / z.lower()).abs_upper())


def _k0_series(z: Any) -> tuple[Any, Any, Any]:
    """K0 by DLMF 10.31.2, and I0, I1.

    sum q^n/n!^2 (1 + ... + 1/n), q = z^2/4: once n > z a term is less than half of the one before,
    so that the rest of the sum is less than the last term taken.
    """
    flint = _flint()
    q, count = z * z / 4, 32
    least = flint.arb(2) ** -flint.ctx.prec
    while True:
        series = _harmonic_series(count, flint.ctx.prec)
        last = series[count] * q**count
        if count > z and last < least:
            break
        count += count // 2
    total = series(q) + flint.arb(0, last.abs_upper())
    i0, i1 = z.bessel_i(0), z.bessel_i(1)
    return total - ((z / 2).log() + flint.arb.const_euler()) * i0, i0, i1


@functools.lru_cache(maxsize=256)
def _harmonic_series(count: int, bits: int) -> Any:
    """(1 + ... + 1/n)/n!^2 for n up to ``count``, as a polynomial."""
    flint = _flint()
    with flint.ctx.workprec(bits):
        harmonic, factorial, terms = flint.arb(0), flint.arb(1), [flint.arb(0)]
        for n in range(1, count + 1):
            harmonic += flint.arb(1) / n
            factorial *= n
            terms.append(harmonic / (factorial * factorial))
        return flint.arb_poly(terms)


def _state(alpha: Any, kappa: Any, mu: Any, V: Any, delta: Any) -> dict[str, Any] | None:
    """The law at the working precision; None where that does not decide a sign."""
    arb = _flint().arb
    w, c = 2 * kappa * V, (alpha - 1) / alpha
    if c == 0:  # so that a creep of exactly delta_star is seen as such
        zeta, lam = 1 / w, arb(1)
    else:
        zeta = _root(lambda z: _H(z, alpha, c), 1 / w**2, 1 / w)
        if zeta is None:
            return None
        lam = w * zeta
    r, k, i2 = ratio_r(alpha * zeta), ratio_k(zeta), ratio_i2(alpha * zeta)
    whole = 1 + r * k
    epsilon = c * r * k / (whole * zeta)
    delta_star = mu * lam * (1 + epsilon) / (2 * kappa)
    state = {"lam": lam, "zeta": zeta, "epsilon": epsilon, "delta_star": delta_star}
    state["M"] = V * c * (lam**2 * i2 + r * k) / whole
    over = 2 * kappa * delta - mu * lam * (1 + epsilon)
    if over >= 0:
        return state | {"full_slip": True, "beta": arb(0), "Q": mu}
    if not over < 0:
        return None
    eta = zeta if delta == 0 else stick_length(zeta * (1 + epsilon) - delta / (mu * V), alpha)
    if eta is None:
        return None
    share = 1 - _H(eta, alpha, c)[0] * w**2 if delta != 0 else arb(0)
    return state | {"full_slip": False, "beta": eta / zeta if delta != 0 else arb(1), "Q": mu * share}


def stick_length(y: Any, alpha: Any) -> Any:
    """eta > 0 of Eq. (10), F(eta) = y; None without the digits for it."""
    c = (alpha - 1) / alpha
    return y if c == 0 else _root(lambda z: _F(z, alpha, c), y, y.mid())


def _F(z: Any, alpha: Any, c: Any) -> tuple[Any, Any]:
    """F = z + g and its slope."""
    g, _, dg, _ = _generators(z, alpha, c)
    return z + g, 1 + dg


def _H(z: Any, alpha: Any, c: Any) -> tuple[Any, Any]:
    """H = z^2 + 2 z h and its slope."""
    _, h, _, dh = _generators(z, alpha, c)
    return z * (z + 2 * h), 2 * (z + h + z * dh)


def _generators(z: Any, alpha: Any, c: Any) -> tuple[Any, Any, Any, Any]:
    """(g, h, g', h'): g = c r k/(1 + r k), h = c r/(1 + r k)."""
    r, k = ratio_r(alpha * z), ratio_k(z)
    dr, dk = alpha * (1 - r / (alpha * z) - r * r), k * k + k / z - 1
    whole = 1 + r * k
    share, rise = c / whole, (r * dk + k * dr) / whole
    return share * r * k, share * r, share * rise, share * (dr - r * rise)


def _root(function: Callable[[Any], tuple[Any, Any]], y: Any, guess: Any) -> Any:
    """A ball that holds the z > 0 at which a strictly rising function is y; None without the digits for it.

    Newton's iteration in logarithms, on midpoints; then ever wider balls until the ends lie on either side.
    """
    flint = _flint()
    arb, z = flint.arb, guess.mid()
    if not y > 0:
        return None
    fine = arb(2) ** -(flint.ctx.prec // 2)
    for _ in range(_MOST_STEPS):
        value, slope = function(z)
        step = ((value / y).log() * value / (z * slope)).mid()
        z = (z * (-step).exp()).mid()
        if not z.is_finite():  # Arb found no digits
            return None
        if abs(step) < fine:
            break
    else:
        return None
    radius = z * arb(2) ** -flint.ctx.prec
    while 512 * radius < z:
        radius *= 256
        low, high = (z - radius).lower(), (z + radius).upper()
        if function(low)[0] < y and function(high)[0] > y:
            return low.union(high)
    return None


def _flint() -> Any:
    return imported("flint", "python-flint", "dev")
