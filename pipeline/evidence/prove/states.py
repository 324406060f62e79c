"""Bessel ratios, contact states and stresses against certified enclosures; states and covers of
finite thickness against the boundary elements of data/reference/check_elements.json.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import flint
import numpy as np
from flint import arb
from numpy.random import Generator

import viscoroll as vr
from pipeline.validation import FIELDS, closures, random_states
from viscoroll.contact_mechanics.model_validity import stated_error
from viscoroll.kernels.law import bessel_ratios

from ...stage import Row
from ..truth import (
    INPUTS,
    condition_numbers,
    contact_enclosure,
    ratio_i2,
    ratio_k,
    ratio_r,
    shape_enclosure,
)
from .cases import STATES, Proof, at, chosen_alpha, chosen_state, generators, powers, read_elements

# --- r, k, i2 and the slopes of r and k, over all positive doubles ---

#: a polynomial or series to a unit, a product and a logarithm
RATIO_ULP = 4.0
#: of the larger of the two terms of a Riccati equation; 1 - r carries up to 3 units just below x =
#: 2
SLOPE_ULP = 8.0
_BITS = 120


def points(random: Generator, count: int) -> np.ndarray:
    """Every bin edge and its neighbours; and at random: half over the tables, half over all binary
    exponents.
    """
    octaves = 2.0 ** np.arange(-31, 8)[:, None]
    edges = (octaves * (1.0 + np.arange(bessel_ratios.BINS) / bessel_ratios.BINS)).ravel()
    ends = np.array([5e-324, 1e-320, 2.2250738585072014e-308, 1e-8, 1.7976931348623157e308])
    common = 10.0 ** random.uniform(-4, 3, count // 2)
    bits = random.integers(1, np.float64(np.finfo(float).max).view(np.int64), count - count // 2)
    fixed = [edges, np.nextafter(edges, 0.0), np.nextafter(edges, np.inf), ends]
    return np.concatenate([*fixed, common, bits.view(np.float64)])


def ulps(value: float, exact, *terms) -> float:
    """|value - exact| in units in the last place of the exact value, or of the largest of some
    terms.
    """
    unit = np.spacing(max(abs(float(each)) for each in (exact, *terms)))
    return float((abs(arb(value) - exact) / arb(float(unit))).upper())


def ratio_errors(x: float) -> Iterator[tuple[str, float]]:
    """Errors at x: of r, k, i2 in ULP; of r' and k' in ULP of the larger Riccati term."""
    X = arb(x)
    r, rc = bessel_ratios.ratio_r(x)
    k, kc = bessel_ratios.ratio_k(x)
    exact_r = ratio_r(X)
    exact_k = ratio_k(X)
    yield "r", ulps(r, exact_r)
    yield "k", ulps(k, exact_k)
    yield "i2", ulps(bessel_ratios.ratio_i2(x, r), ratio_i2(X))
    if x >= np.finfo(float).tiny:  # far below, k has fewer digits, and k/x with it
        yield (
            "slope of r",
            ulps(bessel_ratios.slope_r(x, r, rc), 1 - exact_r / X - exact_r**2, exact_r / X),
        )
        yield (
            "slope of k",
            ulps(bessel_ratios.slope_k(x, k, kc), exact_k**2 + exact_k / X - 1, exact_k / X),
        )


def of_ratios(random, count):
    for x in points(random, count).tolist():
        # the terms of the slopes, 1/x, cancel to 1/x^2
        with flint.ctx.workprec(_BITS + 2 * max(math.frexp(x)[1], 0)):
            yield f"x = {x!r}", dict(ratio_errors(x))


_SLOPE = "{}, ULP of the larger term of its Riccati equation"
RATIO_PROOFS = [
    Proof(
        "ratios",
        "ratio_points",
        "all positive doubles, of slopes all normal ones",
        {name: (f"{name}, ULP", RATIO_ULP) for name in ("r", "k", "i2")}
        | {name: (_SLOPE.format(name), SLOPE_ULP) for name in ("slope of r", "slope of k")},
        of_ratios,
    )
]


# --- contact states and stress ---

#: relative error where the condition number leaves it, else that many roundings of the inputs
WELL = 1e-13
ROUNDINGS = 4.0
UNIT = 2.0**-53
#: the two bounds meet here
WELL_CONDITIONED = WELL / (ROUNDINGS * UNIT)
CLOSURE = 1e-11
#: the last subnormals have no relative accuracy: their spacing, some times over
_LEAST = 8 * 5e-324
#: relative errors that rows are allowed: of 24 powers of one octave of kappa V at alpha from 20 to
#: 35
LAM = 1.5e-14
EPSILON = 3e-14
#: states of a call
_TOGETHER = 150


def found_of(states: list[tuple[float, ...]], each: bool) -> Row:
    """States with an alpha each, or by the rows of one alpha."""
    alpha, kappa, mu, V, delta = np.array(states).T
    scene = vr.Scene(alpha if each else float(alpha[0]), kappa, mu)
    return vr.contact(scene, V, delta=delta, fields=(*FIELDS, "full_slip")).as_dict()


def relative_error(value: float, exact) -> float:
    """|value - exact|/|exact|, less what the last subnormals cannot hold."""
    with flint.ctx.workprec(200):
        off = abs(arb(value) - exact)
        if off <= _LEAST:
            return 0.0
        return math.inf if exact.contains(0) else float((off / abs(exact)).upper())


def contact(random, count, each):
    """full_slip, then each field over its bound."""
    for first in range(0, count, _TOGETHER):
        one = None if each else chosen_alpha(random)
        states = [
            chosen_state(random, one or chosen_alpha(random))
            for _ in range(min(_TOGETHER, count - first))
        ]
        values = found_of(states, each)
        for i, state in enumerate(states):
            exact = contact_enclosure(*state)
            where = at(**dict(zip(INPUTS, state)))
            if values["full_slip"][i] != exact["full_slip"]:
                star = exact["delta_star"]
                off = abs(arb(abs(state[4])) - star) / arb(float(np.spacing(float(star))))
                yield where, {"full_slip": float(off.upper())}
                continue
            yield where, {"full_slip": 0.0}
            # the doubles as they are, without their signs
            factors = condition_numbers(
                {name: arb(abs(value)) for name, value in zip(INPUTS, state)}
            )
            for name in FIELDS:
                error = relative_error(values[name][i], exact[name])
                factor = factors[name]
                well = factor <= WELL_CONDITIONED
                yield where, {(name, well): error if well else error / (factor * UNIT)}


def enclosed_stress(exact: Row, alpha, kappa, mu, V, x) -> tuple[Any, Any]:
    """p/E' and tau/E' at x."""
    zeta = exact["zeta"]
    eta = exact["beta"] * zeta
    Y = x / (kappa * V) - zeta * exact["epsilon"]
    scale = V / (4 * arb.pi())
    whole = shape_enclosure(Y, zeta, alpha)
    stuck = shape_enclosure(Y - (zeta - eta), eta, alpha) if eta > 0 else arb(0)
    return scale * whole, mu * scale * (whole - stuck)


def of_stress(random, count):
    """At x in l0 within 1e-16 to 1 of either edge and of the stick point, on both sides, and
    between.

    Edges, where stresses rise as a square root, lie where lam and epsilon have them.
    """
    for _ in range(count):
        alpha, a, kappa, mu, small = powers(random, (0, 4), (-8, 8), (0, 2), (-2, 0), (-8, 0))
        zeta = a / alpha
        V = 0.5 / kappa / math.sqrt(zeta * zeta + 2.0 * zeta * generators(zeta, alpha)[1])
        s = (small, 1.0 - small, float(random.random()), 1.2)[random.integers(4)]
        scene = vr.Scene(alpha, kappa, mu)
        delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        state = vr.contact(scene, V, delta=delta)
        half = 0.5 * state.lam
        middle = half * state.epsilon
        rear = middle - half
        front = middle + half
        stick = front - state.lam * state.beta
        near = half * 10.0 ** random.uniform(-16, 0, 3)
        between = random.uniform(rear, front, 3)
        x = np.concatenate(
            [rear + near, front - near, [stick], stick + near[:2], stick - near[:2], between]
        )
        found = vr.stress(scene, x, V, delta=delta)
        peak = vr.stress(scene, middle + half * np.linspace(-1, 1, 401), V, delta=delta).p.max()
        exact = contact_enclosure(alpha, kappa, mu, V, delta, 200)
        for i, place in enumerate(x.tolist()):
            shift = LAM * max(abs(place), front) + EPSILON * middle
            where = at(alpha=alpha, kappa=kappa, mu=mu, V=V, s=s, x=place)
            with flint.ctx.workprec(260):
                inputs = map(arb, (alpha, kappa, mu, V))
                of_x = partial(enclosed_stress, exact, *inputs)
                here, *moved = (of_x(arb(place) + move) for move in (0, shift, -shift))
                for n, (name, scale) in enumerate((("p", peak), ("tau", peak * mu))):
                    off = float(abs(arb(float(getattr(found, name)[i])) - here[n]).upper())
                    allowed = max(float(abs(other[n] - here[n]).mid()) for other in moved)
                    yield where, {name: (off - allowed) / scale}


def of_closures(random, count):
    scene, V, delta = random_states(count, int(random.integers(1 << 31)))
    for i in range(count):
        one = vr.Scene(scene.alpha[i], scene.kappa[i], scene.mu[i])
        found = closures(one, float(V[i]), float(delta[i]))
        yield (
            f"{one!r}, V = {V[i]!r}, delta = {delta[i]!r}",
            {name: abs(error) for name, error in found.items()},
        )


def by_elements(_, count):
    """Yield errors of states of bodies against load, offset, moments, creep and friction of
    boundary elements.

    count: how many states of the file, the first ones.
    """
    for state in read_elements("bodies")[:count]:
        one, other = (vr.Prony(**body) for body in state["bodies"])
        bodies = vr.Bodies(one, other, share=state["share"])
        V = state["V"]
        z = state["z"]
        c = vr.contact(vr.Scene(kappa=1.0, mu=0.5, material=bodies), V, delta=state["delta"])
        theirs = {
            "load": state["H"],
            "epsilon": state["g"] / z,
            "M": V * state["m"],
            "M_half_space": V * float(bodies.half_space_weights @ state["shares"]),
            "delta": 0.5 * V * state["d"],
            "Q": 0.5 * state["Q"],
        }
        # the load of the elements is that of their own half length
        ours = c.as_dict() | {"load": (z / float(c.zeta) / (2.0 * V)) ** 2, "delta": state["delta"]}
        scales = ours | {"M_half_space": ours["M"]}
        errors = {
            name: abs(value - float(ours[name])) / float(scales[name])
            for name, value in theirs.items()
        }
        yield (
            at(V=V, delta=state["delta"]) + f", {bodies!r:.200}",
            errors | {"hurt": not state["least"] > 0.0},
        )


def _contact(way, size, each):
    ill = f"divided by condition × 1.1e-16, condition above {WELL_CONDITIONED:.0f} ({way})"
    claims = {
        (name, True): (f"{name}, relative, condition below {WELL_CONDITIONED:.0f} ({way})", WELL)
        for name in FIELDS
    }
    claims |= {(name, False): (f"{name}, {ill}", ROUNDINGS) for name in FIELDS}
    slip = {"full_slip": (f"full_slip: distance from delta_star where misjudged, ULP ({way})", 2.0)}
    return Proof("contact", size, STATES, claims | slip, partial(contact, each=each))


_BY_ELEMENTS = "against 60 and 120 boundary elements a zone, extrapolated"
PROOFS = [
    _contact("different alphas", "states", True),
    _contact("one alpha", "slice_states", False),
    Proof(
        "slopes",
        "stress_states",
        "alpha zeta in [1e-8, 1e8], alpha in [1, 1e4], s over its range, x at edges, stick point "
        "and between",
        {
            name: (
                f"{name} beyond a shift of x by the allowed errors of lam and epsilon, divided by "
                "its peak",
                CLOSURE,
            )
            for name in ("p", "tau")
        },
        of_stress,
    ),
    Proof(
        "slopes",
        "closures",
        "alpha in [1, 1e4], kappa V in [1e-3, 1e3]",
        {
            "load": ("Int p dx = P, divided by the load", CLOSURE),
            "Q": ("Int tau dx = Q, divided by the load", CLOSURE),
            "M": ("Int x p dx = M, divided by the load", CLOSURE),
        },
        of_closures,
    ),
    Proof(
        "boundary",
        "boundary_states",
        "1 to 4 modes over up to 2 decades, kappa V in [0.03, 10], creep in [0.05, 0.95] of "
        "delta_star",
        {
            name: (f"{name} {_BY_ELEMENTS}", 1e-4)
            for name in ("load", "epsilon", "M", "M_half_space", "delta", "Q")
        }
        | {"hurt": ("share of states in which p, p - q, q or the slip is negative somewhere", 0.0)},
        by_elements,
    ),
]


# --- covers ---

_KAPPA = 10.0
_MU = 0.5
#: Friction, and creepage of full slip, far above all others.
_MUCH = 1e3
_FAR = 1e6


def placed(truth: Row) -> tuple[vr.Scene, Any, str]:
    """Return the scene of a state of the file, its contact in free rolling, and where it is, in
    words.

    truth: series, cover, V, half lengths, and what the elements find.
    """
    cover = vr.Cover(vr.Prony(**truth["series"]), **truth["cover"])
    scene = vr.Scene(material=cover, kappa=_KAPPA, mu=_MU, coupled=False)
    free = vr.contact(scene, truth["V"], delta=0.0, fields="delta_0").delta_0
    fields = ("lam", "epsilon", "M", "delta_star", "delta_0", "delta_minus", "delta_plus")
    return (
        scene,
        vr.contact(scene, truth["V"], delta=free, fields=fields),
        at(V=truth["V"], eta=truth["eta"]) + f", {cover!r}",
    )


def cover_states(_, count):
    """Yield errors of lam, epsilon, M, delta_star and Q.

    count: how many states of the file, the first ones.
    """
    for truth in read_elements("covers")[:count]:
        scene, state, where = placed(truth)
        V = truth["V"]
        z = truth["z"]
        # the onsets of the law lie unlike far from free rolling, those without coupling do not
        shift = 0.5 * (state.delta_plus + state.delta_minus) - state.delta_0
        share = _MU * V * truth["d"] / state.delta_star
        delta = state.delta_0 + state.delta_star * share + shift * min(share**2, 1.0)
        Q = vr.contact(scene, V, delta=delta, fields="Q").Q
        yield (
            where,
            {
                # of a contact of the elements' half length, which is the law's when it was solved
                "lam": abs(state.lam / z * np.sqrt(truth["H"]) - 1.0),
                "epsilon": abs(truth["g"] / z - state.epsilon),
                "M": abs(V * truth["m"] / state.M - 1.0),
                "delta_star": abs(_MU * V * truth["star"] / state.delta_star - 1.0),
                "Q": abs(Q / _MU - truth["Q"]) / stated_error(truth["cover"]["thickness"]),
            },
        )


def free_creep(_, count):
    """Yield errors of delta_0 and delta_0* where nu = 1/2: all strain by the pressure comes of the
    finite thickness.

    count: how many states of the file, the first ones.
    """
    for truth in read_elements("free_creep")[:count]:
        scene, state, where = placed(truth)
        V = truth["V"]
        # in full slip, with so much friction that the law does not limit delta_0* - delta_0
        forth, back = (
            vr.contact(scene.replace(mu=_MUCH), V, delta=each).M_half_space
            for each in (_FAR, -_FAR)
        )
        yield (
            where,
            {
                "free": abs(V * truth["free"] / state.delta_0 - 1.0),
                "mirrored": abs(V * truth["mirrored"] / (0.5 * (back - forth) / _MUCH) - 1.0),
            },
        )


_COVER_BOUND = 2e-6
COVER_PROOFS = [
    Proof(
        "covers",
        "cover_states",
        "one and three modes, against rigid and elastic bodies, ν 0 to 0.5, h/l0 0.2 to 20, κV "
        "0.05 to 4",
        {
            "lam": ("λ of a cover against boundary elements, relative", _COVER_BOUND),
            "epsilon": ("ε of a cover against boundary elements", _COVER_BOUND),
            "M": ("M of a cover against boundary elements, relative", _COVER_BOUND),
            "delta_star": ("δ* of a cover against boundary elements, relative", _COVER_BOUND),
            "Q": (
                "Q of a cover against the solution without coupling, divided by the error that "
                "validity states",
                1.0,
            ),
        },
        cover_states,
    ),
    Proof(
        "covers",
        "cover_states",
        "one and three modes, ν = 0.5, h/l0 0.2 to 20, κV 0.05 to 4",
        {
            "free": (
                "δ0 of a cover, free rolling with stick, against boundary elements, relative",
                _COVER_BOUND,
            ),
            "mirrored": (
                "δ0* of a cover, the mirrored strain, against boundary elements, relative",
                _COVER_BOUND,
            ),
        },
        free_creep,
        "free creep",
    ),
]
