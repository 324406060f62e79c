"""The contact law of any material in ball arithmetic: every value comes with a bound on its error.

The reduced form of the law, H(zeta) = 1/(2 kappa V)^2 and F(eta) = F(zeta) - delta/(mu V), with
the Bessel functions and the error bounds of Arb (python-flint).  A root is a ball at whose ends
the enclosed function, which rises strictly, lies certainly below and certainly above.  Digits
that cancel show as a wide ball, and the whole is done again with more.

Of several relaxation times (:class:`Material`, rates without a radius) by the matching conditions
as they stand, Goryacheva's way; the kernels solve another system.  Inside the contact the pressure
is that of Hertz and one exponential a relaxation mode, of amplitude X_i; each creep mode's memory
must be continuous at the front edge:

    sum_i X_i a_i (1 + r_i k_j)/(a_i - b_j) = 1/b_j     r_i = I1/I0(a_i z)     k_j = K0/K1(b_j z)

``tests/truth/test_enclosures.py`` puts the balls into the equations as printed.

    python -m pipeline.evidence.truth [-o FILE]

fits the Bessel ratios -> src/viscoroll/kernels/law/ratios.npy (kept in git): r = I1/I0, k = K0/K1
and i2 = I2/I0 with 60 digits at the Chebyshev points of every bin, interpolated there, and rounded
to double once, as monomials about the centre of the bin.

Nothing here is installed with the package: python-flint comes with ``viscoroll[dev]``.
"""

import math
from contextlib import suppress
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import flint
import numpy as np
from flint import acb, arb
from tqdm import tqdm

from viscoroll import Bodies, Prony
from viscoroll.core.errors import ConvergenceError
from viscoroll.core.files import replace_file
from viscoroll.kernels.law import bessel_ratios

from ..stage import Row, said

# --- materials of any number of relaxation times: both forms, midpoints without a radius ---

#: by which conversions carry more than is asked, and a zero is no nearer to a pole, over their
#: distance
_MORE_BITS = 200
_NEAREST = 280


class Material(NamedTuple):
    """Rates of relaxation and of creep, ascending, strengths of creep, and what of these is the
    half-space's.
    """

    a: list[Any]
    b: list[Any]
    J: list[Any]
    weights: list[Any]

    @classmethod
    def of_rates(cls, a: list[Any], b: list[Any], weights: list[Any] | None = None):
        """J_j = prod_i (a_i - b_j)/prod_{i != j} (b_i - b_j)/(alpha b_j), signs dropped, alpha =
        prod a/b.
        """
        J = []
        alpha = math.prod((own / at for own, at in zip(a, b, strict=True)), start=arb(1))
        for j, rate in enumerate(b):
            top = math.prod(abs(at - rate) for at in a)
            J.append(
                top
                / math.prod(
                    (abs(at - rate) for i, at in enumerate(b) if i != j), start=rate * alpha
                )
            )
        return cls(a, b, J, weights or [arb(0.5)] * len(b))


def material_of(given) -> Material:
    """Of a stiffness ratio alpha (a float or a ball; times over T_epsilon), a series, or a pair
    that shares no time.

    At the working precision.
    """
    if isinstance(given, (Prony, Bodies)):
        return _converted(given, flint.ctx.prec)
    alpha = arb(given)
    return (
        Material([], [], [], [])
        if alpha == 1
        else Material([alpha], [arb(1)], [(alpha - 1) / alpha], [arb(0.5)])
    )


@lru_cache(maxsize=64)
def _converted(given, bits):
    with flint.ctx.workprec(bits + _MORE_BITS):
        if isinstance(given, Prony):
            return Material.of_rates(*_of_series(given))
        share = arb(float(given.share))
        bodies = (share, given.cylinder, arb(0)), (1 - share, given.base, arb(1))
        if given.cylinder == given.base:
            like = material_of(given.cylinder)
            return like._replace(weights=[1 - share] * len(like.b))
        modes = []
        rest = arb(0)
        for part, body, which in bodies:
            own = material_of(body)
            rest += part * (1 - sum(own.J))
            modes += [
                (rate, part * J, which) for rate, J in zip(own.b, own.J, strict=True) if part > 0
            ]
        b, J, weights = (
            list(column)
            for column in zip(*sorted(modes, key=lambda mode: float(mode[0])), strict=True)
        )
        return Material(_relaxing(b, J, rest), b, J, weights)


def _of_series(given):
    """Rates of relaxation and of creep."""

    def numbers(times, strengths):
        modes = sorted(zip(times.tolist(), strengths.tolist(), strict=True), reverse=True)
        return [1 / arb(time) for time, _ in modes], [arb(strength) for _, strength in modes]

    if given.by_creep:
        b, J = numbers(given.T, given.J)
        return _relaxing(b, J, 1 - sum(J)), b
    a, E = numbers(given.tau, given.E)
    return a, _zeros([arb(0), *a], [arb(1), *E], arb(0))


def _relaxing(b, J, rest):
    """Rates of relaxation from creep, ``rest`` 1/alpha."""
    return _zeros(b, [strength * rate for strength, rate in zip(J, b, strict=True)], rest)


def _zeros(poles, weights, constant):
    """Zeros of constant + sum w/(pole - s), right of each pole; of the last one where the constant
    is not 0.
    """

    def rising(s):
        return constant + sum(
            weight / (pole - s) for weight, pole in zip(weights, poles, strict=True)
        )

    ends = [*poles, poles[-1] + 2 * sum(weights) / constant] if constant > 0 else poles
    return [_zero(rising, low.mid(), high.mid()) for low, high in pairwise(ends)]


def _zero(rising, low, high):
    half = ((high - low) / 2).mid()
    from_low = rising(low + half) >= 0
    near = half * arb(2) ** -_NEAREST
    far = half
    while far - near > far * arb(2) ** (8 - flint.ctx.prec):
        middle = (near * far).sqrt().mid()
        beyond = rising(low + middle) > 0 if from_low else rising(high - middle) < 0
        near, far = (near, middle) if beyond else (middle, far)
    return (low + near if from_low else high - near).mid()


# --- the contact law ---

INPUTS = ("alpha", "kappa", "mu", "V", "delta")
_MOST_BITS = 1 << 14
_MOST_STEPS = 100
#: log2 of the relative step of the differences in :func:`condition_numbers` and :func:`slopes`
_STEP_BITS = 180


def contact_enclosure(
    alpha: float, kappa: float, mu: float, V: float, delta: float, bits: int = 100
) -> Row:
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
        lam, zeta, epsilon, delta_star, beta, Q, M as ``arb``; full_slip as bool.

    Notes
    -----
    Inputs are taken as the doubles they are.  Every ball contains the exact value, and its radius
    is at most 2^-``bits`` of it (``tests/truth/test_enclosures.py``).
    """
    given = (alpha, kappa, mu, abs(V), abs(delta))
    state = enclosed(
        {name: arb(float(value)) for name, value in zip(INPUTS, given, strict=True)}, bits
    )
    with flint.ctx.workprec(_MOST_BITS):  # a change of sign shall not round
        if V < 0.0:
            state["M"] = -state["M"]
        if delta != 0.0 and (V < 0.0) != (delta < 0.0):
            state["Q"] = -state["Q"]
    return state


def enclosed(given: Row, bits: int, near: Row | None = None) -> Row:
    """``contact_enclosure`` of exact balls with V > 0 and delta >= 0; alpha: a ball, a series or a
    pair of bodies.

    And the parts of M.  ``near``: a state of nearly the same inputs, at whose lengths the search
    for the lengths starts; no ball rests on it.
    """
    working = bits + 60
    state = None
    while working <= _MOST_BITS:
        with flint.ctx.workprec(working), suppress(ZeroDivisionError):
            state = _state(**given, near=near or {})
        if state is not None and all(
            state[name].rel_accuracy_bits() >= bits for name in state if name != "full_slip"
        ):
            return state
        working += working // 2
    raise ConvergenceError(f"contact_enclosure: {_MOST_BITS} bits do not suffice")


def condition_numbers(given: Row) -> dict[str, float]:
    """Sum over the inputs of |d ln f/d ln input| for every f: the relative error of f for one in
    each input.

    By differences with a relative step of 2^-180, far above the balls and far below anything that
    bends; alpha moves up, away from 1, and delta down, away from delta_star.
    """
    bits = 40 + _STEP_BITS
    base = enclosed(given, bits)
    del base["full_slip"]
    total = dict.fromkeys(base, 0.0)
    with flint.ctx.workprec(2 * bits):
        step = arb(2) ** -_STEP_BITS
        for name in INPUTS:
            moved = enclosed(
                given | {name: given[name] * (1 - step if name == "delta" else 1 + step)},
                bits,
                base,
            )
            for field, value in base.items():
                if value != 0:
                    total[field] += float(abs((moved[field] / value - 1) / step).mid())
    return total


def slopes(given: Row) -> Row:
    """dQ_dV and dM_dV at fixed delta, dQ_ddelta at fixed V, by central differences that know no
    formula.

    V > 0 and 0 < delta < delta_star.  Their own error is of the order of the step squared, 2^-360.
    """
    bits = 100 + _STEP_BITS
    near = enclosed(given, bits)
    found = {}
    with flint.ctx.workprec(4 * bits):
        step = arb(2) ** -_STEP_BITS
        for by in ("V", "delta"):
            up, down = (
                enclosed(given | {by: given[by] * (1 + sign * step)}, bits, near)
                for sign in (1, -1)
            )
            for name in ("Q", "M") if by == "V" else ("Q",):
                found[f"d{name}_d{by}"] = (up[name] - down[name]) / (2 * step * given[by])
    return found


def shape_enclosure(Y, z, alpha):
    """S(Y; z) of the stresses, Eqs. (11)-(14), 0 where |Y| >= z; at the working precision.

    p/E' = V/(4 pi) S(X - g(zeta); zeta), X = x/(l0 kappa V), and the shear is mu times the
    difference of two such; the integral is Arb's, with its proven bound.
    """
    if abs(Y) >= z:
        return arb(0)
    ellipse = ((z - Y) * (z + Y)).sqrt()
    if alpha == 1:
        return ellipse
    r = ratio_r(alpha * z)
    k = ratio_k(z)
    angle = (Y / z).acos()

    def memory(u, _):
        cosine = (u * angle).cos()
        return (r + cosine) * (alpha * (Y - z * cosine)).exp()

    integral = acb.integral(memory, 0, 1, rel_tol=arb(2) ** -100, abs_tol=arb(2) ** -300)
    return ellipse + (alpha - 1) * z / (1 + r * k) * angle * integral.real


def ratio_r(x):
    """I1/I0 at x > 0."""
    return x.bessel_i(1, scaled=True) / x.bessel_i(0, scaled=True)


def ratio_i2(x):
    """I2/I0 at x > 0."""
    return x.bessel_i(2, scaled=True) / x.bessel_i(0, scaled=True)


def ratio_k(z):
    """K0/K1 at z > 0, by the asymptotic expansion where that has the digits, else by the power
    series.

    Arb takes seconds for few digits where it is near to choose either: 8 z bits more, of which 3 z
    cancel, leave no choice.  The series is taken at the middle of the ball; 0 < k' < k/z < k/z at
    the lower end carries the radius over.  K1, whose series takes as long as that of K0, follows
    from I0 K1 + I1 K0 = 1/z.
    """
    if 5 * z > 3 * flint.ctx.prec:  # exp(-2 z) is far below the last digit
        return z.bessel_k(0, scaled=True) / z.bessel_k(1, scaled=True)
    middle = z.mid()
    with flint.ctx.extraprec(8 * int(float(z.upper())) + 64):
        K0 = middle.bessel_k(0, scaled=True)
        I0 = middle.bessel_i(0, scaled=True)
        K1 = (1 / middle - middle.bessel_i(1, scaled=True) * K0) / I0
        k = K0 / K1
    return k + arb(0, (z.rad() * k / z.lower()).abs_upper())


class Zone(NamedTuple):
    """g, h and m at z; ``parts`` of m, of the half-space and the cylinder; the amplitudes X and
    I2/I0 of the modes.
    """

    g: Any
    h: Any
    m: Any
    parts: tuple[Any, Any]
    X: list[Any]
    i2: list[Any]


def zone_of(of: Material, z) -> Zone:
    """The functions of a contact, or a stick zone, of half length z > 0 over V T_ref.

    h = sum X_i r_i, and of creep mode j in g and in m, as its memory does it to the pressure, with
    H = z^2 + 2 z h

    J_j sum_i X_i a_i/(a_i - b_j) r_i k_j     J_j sum_i X_i a_i/(a_i - b_j) (r_i k_j + (z^2/H) u_i)
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)     i2_i = I2/I0(a_i z)

    Raises
    ------
    ZeroDivisionError
        Where the precision does not tell the matrix from a singular one.
    """
    a = of.a
    modes = range(len(a))
    if not a:
        return Zone(*3 * [0 * z], (0 * z, 0 * z), [], [])
    r = [ratio_r(at * z) for at in a]
    k = [ratio_k(at * z) for at in of.b]
    i2 = [ratio_i2(at * z) for at in a]
    per = [[at / (at - b) for at in a] for b in of.b]
    matrix = flint.arb_mat([[per[n][i] * (1 + r[i] * k[n]) for i in modes] for n in modes])
    X = matrix.solve(flint.arb_mat([[1 / b] for b in of.b])).entries()
    h = sum(X[i] * r[i] for i in modes)
    square = 1 / (1 + 2 * h / z)
    between = [[a[i] * a[n] / (a[i] + a[n]) * (i2[i] - i2[n]) for n in modes] for i in modes]
    u = [i2[i] + sum(X[n] * between[i][n] for n in modes) for i in modes]
    shift = [of.J[n] * sum(X[i] * per[n][i] * r[i] * k[n] for i in modes) for n in modes]
    m = [shift[n] + of.J[n] * square * sum(X[i] * per[n][i] * u[i] for i in modes) for n in modes]
    half_space = sum(part * weight for part, weight in zip(m, of.weights, strict=True))
    cylinder = sum(part * (1 - weight) for part, weight in zip(m, of.weights, strict=True))
    return Zone(sum(shift), h, sum(m), (half_space, cylinder), X, i2)


def _state(alpha, kappa, mu, V, delta, near):
    """The law at the working precision; None where that does not decide a sign."""
    of = material_of(alpha)
    w = 2 * kappa * V
    zeta = _root(of, _H, 1 / w**2, 1 / w, near.get("zeta"))
    if zeta is None:
        return None
    # so that a creep of exactly delta_star is seen as such
    whole = zone_of(of, zeta)
    lam = w * zeta if of.a else arb(1)
    epsilon = whole.g / zeta
    delta_star = mu * lam * (1 + epsilon) / (2 * kappa)
    half_space, cylinder = whole.parts
    state = {
        "lam": lam,
        "zeta": zeta,
        "epsilon": epsilon,
        "delta_star": delta_star,
        "M": V * whole.m,
        "M_half_space": V * half_space,
        "M_cylinder": V * cylinder,
    }
    over = 2 * kappa * delta - mu * lam * (1 + epsilon)
    if over >= 0:
        return state | {"full_slip": True, "beta": arb(0), "Q": mu}
    if not over < 0:
        return None
    if delta == 0:
        return state | {"full_slip": False, "beta": arb(1), "Q": arb(0)}
    y = zeta + whole.g - delta / (mu * V)
    start = near["beta"] * near["zeta"] if near.get("beta", 0) != 0 else None
    eta = _root(of, _F, y, y, start)
    if eta is None:
        return None
    return state | {"full_slip": False, "beta": eta / zeta, "Q": mu * (1 - _H(of, eta) * w**2)}


def _F(of, z):
    return z + zone_of(of, z).g


def _H(of, z):
    return z * (z + 2 * zone_of(of, z).h)


def _root(of, function, y, guess, near):
    """A ball that holds the z > 0 at which F or H, which rise strictly, is y; None without the
    digits for it.

    Newton's iteration in logarithms, on midpoints, slopes by differences; then ever wider balls
    until the ends lie on either side.  Without modes what is asked is the guess itself; with
    modes ``near``, if there is one, is nearer.
    """
    z = (guess if near is None else near).mid()
    if not y > 0:
        return None
    if not of.a:
        return guess
    fine = arb(2) ** -(flint.ctx.prec // 2)
    for _ in range(_MOST_STEPS):
        value = function(of, z)
        slope = (function(of, z * (1 + fine)) / value).log() / fine
        step = ((y / value).log() / slope).mid()
        z = (z * step.exp()).mid()
        if not z.is_finite():  # Arb found no digits
            return None
        if abs(step) < fine:
            break
    else:
        return None
    radius = z * arb(2) ** -flint.ctx.prec
    while 512 * radius < z:
        radius *= 256
        low = (z - radius).lower()
        high = (z + radius).upper()
        if function(of, low) < y and function(of, high) > y:
            return low.union(high)
    return None


# --- the table of the Bessel ratios ---

TARGET = Path(__file__).parents[2] / "src/viscoroll/kernels/law/ratios.npy"
NODES = bessel_ratios.COEFFICIENTS + 1

#: 60 digits: the highest orders are 1e-26 of the values
BITS = 200
EVALUATE = {
    "r(x)/x": lambda x: ratio_r(x) / x,
    "x (1 - r(x))": lambda x: x * (1 - ratio_r(x)),
    "k(z)/z": lambda z: ratio_k(z) / z,
    "z (1 - k(z))": lambda z: z * (1 - ratio_k(z)),
    "i2(x)/x^2": lambda x: ratio_i2(x) / x**2,
}


def chebyshev_fit(values: list[arb], half_width: arb) -> list[arb]:
    """Monomial coefficients in t of the truncated Chebyshev series on |t| <= half_width."""
    angles = [(2 * i + 1) * arb.pi() / (2 * len(values)) for i in range(len(values))]
    whole = flint.arb_poly([0])
    t = flint.arb_poly([0, 1 / half_width])
    polynomials = [flint.arb_poly([1]), t]
    for n in range(bessel_ratios.COEFFICIENTS):
        coefficient = sum(v * (n * a).cos() for v, a in zip(values, angles, strict=True)) / len(
            values
        )
        whole += polynomials[n] * (coefficient * (1 + (n > 0)))
        polynomials.append(2 * t * polynomials[-1] - polynomials[-2])
    return whole.coeffs()


def ratio_table() -> list[float]:
    """Coefficients of every bin of every segment, in ratio_table order."""
    found = []
    with flint.ctx.workprec(BITS):
        half_width = arb(1) / (2 * bessel_ratios.BINS)
        points = [half_width * ((2 * i + 1) * arb.pi() / (2 * NODES)).cos() for i in range(NODES)]
        octaves = [
            (each.function, n)
            for each in bessel_ratios.SEGMENTS
            for n in range(each.low, each.high)
        ]
        for function, octave in tqdm(octaves, "octaves", leave=False):
            for index in range(bessel_ratios.BINS):
                centre = 1 + (2 * index + 1) * half_width
                values = [
                    EVALUATE[function](((centre + t) * arb(2) ** octave).mid()) for t in points
                ]
                found += map(float, chebyshev_fit(values, half_width))
    return found


def main():
    parser = said(__doc__)
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    output = parser.parse_args().output
    with replace_file(output) as temporary:
        np.save(temporary, np.array(ratio_table()))


if __name__ == "__main__":
    main()
