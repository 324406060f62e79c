"""Contact states against boundary elements, which know neither Bessel functions nor the superposition of two contacts.

The state is the package's; the elements get its half lengths, and find load, offset, moment, creep and friction.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from tqdm import tqdm

import viscoroll as vr

from ..truth import boundary
from .claim import Claim, at

DOMAIN = "1 to 3 modes over up to 2 decades, kappa V in [0.03, 10], creep in [0.05, 0.95] of delta_star"
#: elements in either zone, and twice as many; what they leave of the largest field
COUNT, BOUND, BOUND_PARTS = 60, 1e-4, 1e-3
FIELDS = ("load", "epsilon", "M", "delta", "Q")


def random_pair(random: np.random.Generator) -> vr.Bodies:
    """Two bodies, of at most three modes together."""
    count = int(random.integers(1, 4))
    tau = 10.0 ** random.uniform(-2.0, 0.0, count)
    tau /= tau.max()
    E = 10.0 ** random.uniform(-0.5, 1.0, count)
    both = int(random.integers(0, count + 1))
    one, other = (vr.Prony(E[part], tau[part]) for part in (slice(None, both), slice(both, None)))
    return vr.Bodies(one, other, share=float(random.uniform(0.2, 0.8)))


def compared(bodies: vr.Bodies, V: float, creep: float) -> tuple[dict[str, float], float, float]:
    """(Relative deviations of the package, of M_half_space over M, what is least of the inequalities)."""
    scene = vr.Scene(alpha=None, kappa=1.0, mu=0.5, material=bodies)
    star = float(vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star)
    c = vr.contact(scene, V, delta=creep * star)
    z, series = float(c.zeta), bodies.total
    found = boundary.extrapolated(series, z, float(c.beta) * z, COUNT)
    ours = {
        "load": 1.0 / (2.0 * V) ** 2, "epsilon": float(c.epsilon), "M": float(c.M), "delta": creep * star,
        "Q": float(c.Q),
    }  # fmt: skip
    theirs = {"load": found.H, "epsilon": found.g / z, "M": V * found.m, "delta": scene.mu * V * found.d,
              "Q": scene.mu * found.Q}  # fmt: skip
    part = V * float(found.shares @ bodies.half_space_weights)
    off = {name: abs(theirs[name] / ours[name] - 1.0) for name in FIELDS}
    return off, abs(part - float(c.M_half_space)) / float(c.M), found.least


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """All rows."""
    random = np.random.default_rng(sizes["seed"] + 8)
    what = f"{COUNT} and {2 * COUNT} boundary elements a zone, extrapolated"
    claims = {name: Claim(f"{name} against {what}", DOMAIN, BOUND) for name in FIELDS}
    part = Claim(f"part of M in the half-space, over M, against {what}", DOMAIN, BOUND_PARTS)
    hurt = Claim("share of states in which p, p - q, q or the slip is negative somewhere", DOMAIN, 0.0)
    for _ in tqdm(range(sizes["boundary_states"]), desc="boundary elements", leave=False):
        bodies, V, creep = random_pair(random), 10.0 ** random.uniform(-1.5, 1.0), random.uniform(0.05, 0.95)
        off, of_part, least = compared(bodies, V, creep)
        where = at(V=V, creep=creep) + f", {bodies!r:.200}"
        for name, error in off.items():
            claims[name].add(error, where)
        part.add(of_part, where)
        hurt.add(float(not least > 0.0), where)
    return [claim.row for claim in (*claims.values(), part, hurt)]
