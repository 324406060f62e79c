"""Shape of the law: Q rises and beta falls with delta, lam falls with V, |Q| <= mu, |tau| <= mu p;
slopes do not jump.

At random pairs over the whole domain, and at neighbouring doubles across every edge of a piece of a
table: of the Bessel ratios, and of the rows of one alpha.  Falls of what must rise are counted in
units in the last place of mu, 1 and lam.  Two values that differ by less than their errors may come
out in either order: the bounds are twice the errors that one value has.
"""

from functools import partial
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.law import bessel_ratios

from .cases import EDGE_ALPHAS, Proof, generators

#: the two ways that contact() takes, and the largest fall allowed: see above
WAYS = ("different alphas", "one alpha")
FALL = 6.0
#: the same of lam by the axis of alpha, which is off by up to 6.5 ULP (the proof of its states)
FALL_OF_AXIS = 13.0
#: and the largest step of these, over their scales
SLOPES = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")
STEP = 1e-10
#: neighbouring doubles at an edge: so many on either side of it
_NEIGHBOURS = np.arange(-4, 5)
_CHUNK = 1_000_000
_EDGES = (
    2.0 ** np.arange(-31, 8)[:, None] * (1.0 + np.arange(bessel_ratios.BINS) / bessel_ratios.BINS)
).ravel()


def octaves(random: Generator) -> NDArray:
    """Every edge of a row of any alpha up to 1e6, and as many in the slow row, each some times."""
    return 2.0 ** random.permutation(np.repeat(np.arange(-12, 64), 40))


def neighbours(x: NDArray) -> NDArray:
    """x and the doubles beside it, rising along a new last axis."""
    return (x.view(np.int64)[..., None] + _NEIGHBOURS).view(np.float64)


def contact(way, alpha, kappa, mu, V, delta, fields):
    """contact() that way."""
    if way != "one alpha":
        alpha = np.broadcast_to(alpha, np.broadcast_shapes(np.shape(V), np.shape(delta)))
    return vr.contact(vr.Scene(alpha, kappa, mu), V, delta=delta, fields=fields)


def falls(way, alpha, kappa, mu, V, delta) -> dict[str, NDArray]:
    """Falls in ULP along the last axis, on which delta rises, or V where delta is 0; what rises is
    negative.
    """
    if np.ndim(delta) == 0:
        lam = contact(way, alpha, kappa, mu, V, delta, ("lam",)).lam
        return {"lam": np.diff(lam) / np.spacing(lam[..., 1:])}
    state = contact(way, alpha, kappa, mu, V, delta, ("Q", "beta"))
    mu = np.broadcast_to(mu, state.Q.shape)
    return {
        "Q": -np.diff(state.Q) / np.spacing(mu[..., 1:]),
        "beta": np.diff(state.beta) / np.spacing(1.0),
        "most": (np.abs(state.Q) - mu) / np.spacing(mu),
    }


def log_uniform(random: Generator, low: float, high: float, *shape: int) -> NDArray:
    return 10.0 ** random.uniform(np.log10(low), np.log10(high), shape)


def random_pairs(random, count, way):
    """Pairs of delta at one V, s toward 0 and toward 1; pairs of V."""
    for first in range(0, count, _CHUNK):
        n = min(count - first, _CHUNK)
        draw = partial(log_uniform, random)
        alpha = draw(1.0, 1e6) if way == "one alpha" else draw(1.0, 1e6, n, 1)
        kappa = draw(1e-6, 1e6, n, 1)
        mu = draw(1e-6, 1e6, n, 1)
        far = random.random((n, 1)) < 0.25
        V = np.where(far, draw(1e-300, 1e300, n, 1), draw(1e-8, 1e8, n, 1)) / kappa
        s = np.sort(
            np.where(
                random.random((n, 2)) < 0.5, draw(1e-16, 1.0, n, 2), 1.0 - draw(1e-16, 1.0, n, 2)
            )
        )
        star = contact(way, alpha, kappa, mu, V, np.zeros((n, 1)), ("delta_star",)).delta_star
        yield way, falls(way, alpha, kappa, mu, V, s * star)
        slower = V / np.array([1.0 + 10.0 ** random.uniform(-16, 1), 1.0])
        yield way, falls(way, alpha, kappa, mu, slower, np.float64(0.0))


def at_edges(random: Generator, way: str, alpha: float):
    """(kappa, mu, V, delta) of neighbouring doubles: V where zeta or kappa V is on an edge, delta
    where eta or F is.
    """
    kappa = 2.91
    mu = 0.2
    if way == "one alpha":

        def lengths(V):
            """lam (1 + epsilon) at kappa = 1."""
            return (
                2.0
                / mu
                * contact(way, alpha, 1.0, mu, V, np.zeros(V.size), ("delta_star",)).delta_star
            )

        yield 1.0, mu, neighbours(octaves(random)), np.float64(0.0)  # kappa V itself
        V = octaves(random) * random.uniform(0.5, 2.0, 3040)
        v = octaves(random)
        v[::2] = 2.0 ** np.ceil(np.log2(2.0 * V[::2] / lengths(V[::2])))  # near the whole contact's
        L = lengths(V)
        inside = (2.0 * V < 0.999 * L * v) & (2.0 * V > 1e-6 * L * v)
        yield 1.0, mu, V[inside][:, None], neighbours((0.5 * mu * (L - 2.0 * V / v))[inside])
        return

    z = np.sort(np.concatenate([_EDGES, _EDGES / alpha]))
    g, h = generators(z, alpha)
    yield kappa, mu, neighbours(0.5 / kappa / np.sqrt(z * z + 2.0 * z * h)), np.float64(0.0)
    for _ in range(4):  # from a zeta somewhat above, eta on the edge
        zeta = z * (1.0 + log_uniform(random, 1e-3, 1e3, z.size))
        g_zeta, h_zeta = generators(zeta, alpha)
        V = 0.5 / kappa / np.sqrt(zeta * zeta + 2.0 * zeta * h_zeta)
        yield kappa, mu, V[:, None], neighbours(mu * V * (zeta - z + (g_zeta - g)))


def falls_at_edges(random, _, way):
    for alpha in (*EDGE_ALPHAS[1:], 1.5, 11.0, 24.0, 28.0, 81.5, 1e3):
        for case in at_edges(random, way, alpha):
            yield f"alpha = {alpha!r}", falls(way, alpha, *case)


def slope_scales(mu: float, V, alpha: float, star) -> dict[str, Any]:
    """What a slope may be measured by: a change of Q by mu as V or delta changes by all of itself;
    c for M.
    """
    c = (alpha - 1.0) / alpha
    return {"dQ_dV": mu / V, "dQ_ddelta": mu / star, "dQ_domega": mu / (V * star), "dM_dV": c}


def jumps(random, _):
    """Steps of slopes, over their scales."""
    for alpha in (1.0001, 1.5, 11.0, 1e3, 1e6):
        for way in WAYS:
            for kappa, mu, V, delta in at_edges(random, way, alpha):
                state = contact(way, alpha, kappa, mu, V, delta, (*SLOPES, "delta_star"))
                scales = slope_scales(mu, V, alpha, state.delta_star)
                yield (
                    f"alpha = {alpha!r}, {way}",
                    {
                        name: np.abs(np.diff(getattr(state, name)))
                        / np.broadcast_to(scales[name], np.shape(getattr(state, name)))[..., 1:]
                        for name in SLOPES
                    },
                )


def friction_excess(random, count):
    """(|tau| - mu p)/(mu p) in ULP of 1, at random points across the contact, edges included; p and
    tau >= 0.
    """
    for first in range(0, count, 10 * _CHUNK):
        n = max(min(count - first, 10 * _CHUNK) // 10, 1)
        draw = partial(log_uniform, random)
        kappa = draw(1e-6, 1e6, n)
        mu = draw(1e-6, 1e6, n)
        scene = vr.Scene(draw(1.0, 1e6, n), kappa, mu)
        V = draw(1e-8, 1e8, n) / kappa
        star = vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        delta = star * np.where(random.random(n) < 0.5, random.random(n), 1.0 - draw(1e-16, 1.0, n))
        state = vr.contact(scene, V, delta=delta, fields=("lam", "epsilon", "beta"))
        edge = draw(1e-16, 1.0, n)
        place = np.choose(
            random.integers(4, size=n), (edge, -edge, 2.0 - edge, 2.0 - 2.0 * state.beta + edge)
        )
        stress = vr.stress(scene, 0.5 * state.lam * (state.epsilon - 1.0 + place), V, delta=delta)
        inside = stress.p > 0.0
        excess = (stress.tau[inside] / (mu * stress.p)[inside] - 1.0) / np.finfo(float).eps
        yield (
            "",
            {
                "tau": np.concatenate(
                    [excess, np.where((stress.p < 0.0) | (stress.tau < 0.0), np.inf, 0.0)]
                )
            },
        )


def _shape(way, domain, found):
    fall = {"Q": "Q rises with delta", "beta": "beta falls with delta", "lam": "lam falls with V"}
    bounds = dict.fromkeys(fall, FALL) | (
        {"lam": FALL_OF_AXIS} if way == "different alphas" else {}
    )
    claims = {
        name: (f"{claim} ({way}): violation, ULP", bounds[name]) for name, claim in fall.items()
    }
    most = {"most": (f"|Q| <= mu ({way}): violation, ULP", 0.0)}
    return Proof(
        "shape", "shape_pairs", domain, claims | most, partial(found, way=way), f"{way}, {domain}"
    )


PROOFS = [
    *(_shape(way, "random pairs", random_pairs) for way in WAYS),
    *(_shape(way, "neighbouring doubles at every cell edge", falls_at_edges) for way in WAYS),
    Proof(
        "shape",
        "shape_pairs",
        "alpha in [1, 1e6], kappa V in [1e-8, 1e8], x at edges, stick point and between",
        {"tau": ("|tau| <= mu p: violation, ULP", 0.0)},
        friction_excess,
    ),
    Proof(
        "slopes",
        "shape_pairs",
        "every cell edge",
        {
            name: (f"{name}: step between neighbouring doubles, divided by its scale", STEP)
            for name in SLOPES
        },
        jumps,
    ),
]
