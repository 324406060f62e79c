"""Shape of the law: Q rises and beta falls with delta, lam falls with V, |Q| <= mu, |tau| <= mu p.

At random pairs over the whole domain, and at neighbouring doubles across every edge of a piece of a
table: of the Bessel ratios, and of the rows of one alpha.  Falls of what must rise are counted in units
in the last place of mu, 1 and lam.  Two values that differ by less than their errors may come out in
either order: the bounds are twice the errors stated for one value.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr
from viscoroll.kernels.bessel import layout as layout

from ..peers.standard import generators, standard
from ..truth.check_values import EDGE_ALPHAS
from .claim import Claim

#: the two ways that contact() takes, and the largest fall allowed: see above
WAYS = {"an alpha each": 6.0, "one alpha": 6.0}
CLAIMS = {
    "Q": "Q rises with delta", "beta": "beta falls with delta", "lam": "lam falls with V", "|Q| <= mu": "|Q| <= mu",
}  # fmt: skip
#: neighbouring doubles at an edge: so many on either side of it
_NEIGHBOURS = 4
_CHUNK = 1_000_000


def edges() -> NDArray:
    """Every edge of a bin in reach of a table or a series."""
    return (2.0 ** np.arange(-31, 8)[:, None] * (1.0 + np.arange(layout.BINS) / layout.BINS)).ravel()


def octaves(rng: np.random.Generator) -> NDArray:
    """Every edge of a row of any alpha up to 1e6, and as many in the slow row, each some times."""
    return 2.0 ** rng.permutation(np.repeat(np.arange(-12, 64), 40))


def neighbours(x: NDArray) -> NDArray:
    """x and the doubles beside it, rising along a new last axis."""
    return (x.view(np.int64)[..., None] + np.arange(-_NEIGHBOURS, _NEIGHBOURS + 1)).view(np.float64)


def contact(way: str, alpha: Any, kappa: Any, mu: Any, V: NDArray, delta: NDArray, fields: tuple[str, ...]) -> Any:
    """contact() that way."""
    shape = np.broadcast_shapes(np.shape(V), np.shape(delta))
    if way == "one alpha":
        return vr.contact(vr.Scene(alpha, kappa, mu), V, delta=delta, fields=fields)
    return vr.contact(vr.Scene(np.broadcast_to(alpha, shape), kappa, mu), V, delta=delta, fields=fields)


def falls(way: str, alpha: Any, kappa: Any, mu: Any, V: NDArray, delta: NDArray) -> dict[str, NDArray]:
    """Falls in ULP along the last axis, on which delta rises, or V where delta is 0; what rises is negative."""
    if np.ndim(delta) == 0:
        lam = contact(way, alpha, kappa, mu, V, delta, ("lam",)).lam
        return {"lam": np.diff(lam) / np.spacing(lam[..., 1:])}
    state = contact(way, alpha, kappa, mu, V, delta, ("Q", "beta"))
    mu = np.broadcast_to(mu, state.Q.shape)
    return {
        "Q": -np.diff(state.Q) / np.spacing(mu[..., 1:]),
        "beta": np.diff(state.beta) / np.spacing(1.0),
        "|Q| <= mu": (np.abs(state.Q) - mu) / np.spacing(mu),
    }


def log_uniform(rng: np.random.Generator, low: float, high: float, *shape: int) -> NDArray:
    return 10.0 ** rng.uniform(np.log10(low), np.log10(high), shape)


def random_pairs(way: str, count: int, rng: np.random.Generator) -> Iterator[dict[str, NDArray]]:
    """Pairs of delta at one V, s toward 0 and toward 1; pairs of V."""
    while count > 0:
        n = min(count, _CHUNK)
        count -= n
        alpha = log_uniform(rng, 1.0, 1e6) if way == "one alpha" else log_uniform(rng, 1.0, 1e6, n, 1)
        kappa, mu = log_uniform(rng, 1e-6, 1e6, n, 1), log_uniform(rng, 1e-6, 1e6, n, 1)
        far = rng.random((n, 1)) < 0.25
        V = np.where(far, log_uniform(rng, 1e-300, 1e300, n, 1), log_uniform(rng, 1e-8, 1e8, n, 1)) / kappa
        small, gap = log_uniform(rng, 1e-16, 1.0, n, 2), log_uniform(rng, 1e-16, 1.0, n, 2)
        s = np.sort(np.where(rng.random((n, 2)) < 0.5, small, 1.0 - gap))
        star = contact(way, alpha, kappa, mu, V, np.zeros((n, 1)), ("delta_star",)).delta_star
        yield falls(way, alpha, kappa, mu, V, s * star)
        yield falls(way, alpha, kappa, mu, V / np.array([1.0 + 10.0 ** rng.uniform(-16, 1), 1.0]), np.float64(0.0))


def lengths(way: str, alpha: float, mu: float, V: NDArray) -> NDArray:
    """lam (1 + epsilon) at kappa = 1."""
    star: NDArray = contact(way, alpha, 1.0, mu, V, np.zeros(V.size), ("delta_star",)).delta_star
    return 2.0 / mu * star


def at_edges(way: str, alpha: float, rng: np.random.Generator) -> Iterator[tuple[Any, ...]]:
    """(kappa, mu, V, delta) of neighbouring doubles: V where zeta or kappa V is on an edge, delta where eta or F is."""
    kappa, mu = 2.91, 0.2
    z = np.sort(np.concatenate([edges(), edges() / alpha]))
    if way == "one alpha":
        yield 1.0, mu, neighbours(octaves(rng)), np.float64(0.0)  # kappa V itself
        V, v = octaves(rng) * rng.uniform(0.5, 2.0, 3040), octaves(rng)
        v[::2] = 2.0 ** np.ceil(np.log2(2.0 * V[::2] / lengths(way, alpha, mu, V[::2])))  # near the whole contact's
        L = lengths(way, alpha, mu, V)
        inside = (2.0 * V < 0.999 * L * v) & (2.0 * V > 1e-6 * L * v)
        yield 1.0, mu, V[inside][:, None], neighbours((0.5 * mu * (L - 2.0 * V / v))[inside])
        return
    g, h = np.array([generators(at, standard(alpha)) for at in z.tolist()]).T
    yield kappa, mu, neighbours(0.5 / kappa / np.sqrt(z * z + 2.0 * z * h)), np.float64(0.0)
    for _ in range(4):  # from a zeta somewhat above, eta on the edge
        zeta = z * (1.0 + log_uniform(rng, 1e-3, 1e3, z.size))
        g_zeta, h_zeta = np.array([generators(at, standard(alpha)) for at in zeta.tolist()]).T
        V = 0.5 / kappa / np.sqrt(zeta * zeta + 2.0 * zeta * h_zeta)
        yield kappa, mu, V[:, None], neighbours(mu * V * (zeta - z + (g_zeta - g)))


def falls_at_edges(way: str, rng: np.random.Generator) -> Iterator[dict[str, NDArray]]:
    for alpha in (*EDGE_ALPHAS[1:], 1.5, 11.0, 24.0, 28.0, 81.5, 1e3):
        for case in at_edges(way, alpha, rng):
            yield falls(way, alpha, *case)


def friction_excess(count: int, rng: np.random.Generator) -> NDArray:
    """(|tau| - mu p)/(mu p) in ULP of 1, at random points across the contact, edges included."""
    kappa, mu = log_uniform(rng, 1e-6, 1e6, count), log_uniform(rng, 1e-6, 1e6, count)
    scene = vr.Scene(log_uniform(rng, 1.0, 1e6, count), kappa, mu)
    V = log_uniform(rng, 1e-8, 1e8, count) / kappa
    star = vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    delta = star * np.where(rng.random(count) < 0.5, rng.random(count), 1.0 - log_uniform(rng, 1e-16, 1.0, count))
    state = vr.contact(scene, V, delta=delta, fields=("lam", "epsilon", "beta"))
    edge = log_uniform(rng, 1e-16, 1.0, count)
    place = np.choose(rng.integers(4, size=count), (edge, -edge, 2.0 - edge, 2.0 - 2.0 * state.beta + edge))
    x = 0.5 * state.lam * (state.epsilon - 1.0 + place)
    stress = vr.stress(scene, x, V, delta=delta)
    inside = stress.p > 0.0
    assert np.all(stress.p >= 0.0)
    assert np.all(stress.tau >= 0.0)
    return (stress.tau[inside] / (mu * stress.p)[inside] - 1.0) / np.finfo(float).eps


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    rng = np.random.default_rng(sizes["seed"] + 2)
    result = []
    for way, bound in WAYS.items():
        for where, cases in (
            ("random pairs", random_pairs(way, sizes["shape_pairs"], rng)),
            ("neighbouring doubles at every cell edge", falls_at_edges(way, rng)),
        ):
            claims = {
                name: Claim(f"{claim} ({way}): violation, ULP", where, bound if name in ("Q", "beta", "lam") else 0.0)
                for name, claim in CLAIMS.items()
            }
            for found in tqdm(cases, desc=f"shape, {where}", delay=1.0, leave=False):
                for name, errors in found.items():
                    claims[name].add(errors)
            result += [claim.row for claim in claims.values()]
    domain = "alpha in [1, 1e6], kappa V in [1e-8, 1e8], x at edges, stick point and between"
    friction = Claim("|tau| <= mu p: violation, ULP", domain, 0.0)
    for _ in range(max(sizes["shape_pairs"] // 10 // _CHUNK, 1)):
        friction.add(friction_excess(min(sizes["shape_pairs"] // 10, _CHUNK), rng))
    return [*result, friction.row]
