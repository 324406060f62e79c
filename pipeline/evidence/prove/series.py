"""Materials of many relaxation times and pairs: the matching conditions at 60 digits, and Chebyshev polynomials.

The conditions stand in ``pipeline.evidence.truth.series`` as they were derived, without the system that the kernels
solve; the Chebyshev solver knows neither Bessel functions nor the relaxation form.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from tqdm import tqdm

import viscoroll as vr
from viscoroll.contact_fields import OF_BODIES
from viscoroll.kernels.rows.modes import modes_loop
from viscoroll.kernels.rows.series import FUNCTIONS, room_of
from viscoroll.materials.law_modes import series_of

from ..truth import series as raw
from ..truth import spectral
from .claim import Claim, at

MODES = (1, 3, 10, 30)
DIGITS, DECADES = 60, 14.0
#: e-folds beyond the shortest and the longest time
BELOW, ABOVE = 30.0, 28.0
CONDITIONS, CHEBYSHEV = 1e-13, 1e-11
#: slopes are differences, and M is small in fast rolling
DIGITS_OF_STATES = 90
#: fields of a state, as :func:`state_errors` measures them; for alpha from 20 to 35, 24 powers of
#: one octave leave 1.4e-14 of epsilon and 6.5e-15 of lam
STATES = {
    "delta_star, Q, M, relative": (5e-15, ("delta_star", "Q", "M")),
    # strengths of 1e4 beside 1: what a slow mode takes of M is then a difference
    "parts of M in the bodies, over M": (1e-12, OF_BODIES),
    "lam, relative, and beta, over its condition": (1.5e-14, ("lam", "beta")),
    "epsilon, relative": (3e-14, ("epsilon",)),
    "dQ_ddelta, relative, and dQ_dV, over mu/V, over the condition of beta": (1e-14, ("dQ_ddelta", "dQ_dV")),
    "dM_dV, over M/V": (5e-14, ("dM_dV",)),
}  # fmt: skip
#: of the Chebyshev solver: z over its shortest time, and terms that resolve the layers there
THICKEST, TERMS = 300.0, 220


def random_series(
    random: np.random.Generator, modes: int, decades: float = DECADES, strengths: tuple[float, float] = (-4.0, 6.0)
) -> vr.Prony:
    """Times even in their logarithm over some of the decades, strengths over two of those given; slow time near 1."""
    span, size = random.uniform(0.1, decades), random.uniform(strengths[0] + 2.0, strengths[1])
    E = 10.0 ** random.uniform(size - 2.0, size, modes)
    return vr.Prony(E, 10.0 ** random.uniform(-span, 0.0, modes)).in_own_time()[0]


def relative(found: float, truth: Any) -> float:
    """Relative error at the precision of the moment."""
    return float(abs(mpmath.mpf(float(found)) / truth - 1))


def of_z(p: vr.Prony, z: float, weights: Any = None) -> list[float]:
    """g, h and what of m is the half-space's and the cylinder's, by the modes."""
    series, found, place = series_of(p.modes, weights), np.empty((2 * FUNCTIONS + 1, 1)), np.array([z])
    place.flags.writeable = False
    modes_loop(series, np.empty(0), room_of(p.E.size), place, found)
    shift, rise, half_space, cylinder = found[:FUNCTIONS, 0].tolist()
    return [shift * z, rise * z, half_space, cylinder]


def functions(random: np.random.Generator, modes: int, count: int) -> Claim:
    """g, h and m, which rows are made of, over all z."""
    claim = Claim(
        f"g, h, m of {modes} mode{'s' * (modes > 1)}",
        f"times over up to {DECADES:g} decades, z from the least e^-{BELOW:g} to the longest e^{ABOVE:g}", CONDITIONS,
    )  # fmt: skip
    for n in tqdm(range(count), desc=claim.claim, leave=False):
        if n % 10 == 0:  # ten z a material
            p = random_series(random, modes)
            known = raw.rates(mpmath, p.E.tolist(), p.tau.tolist())
        z = float(np.exp(random.uniform(np.log(p.tau[-1]) - BELOW, np.log(p.T[0]) + ABOVE)))
        truth, (g, h, half_space, cylinder) = raw.functions(mpmath, known, z), of_z(p, z)
        pairs = zip((g, h, half_space + cylinder), (truth.g, truth.h, truth.m), strict=True)
        claim.add([relative(value, exact) for value, exact in pairs], at(z=z) + f", {p!r}")
    return claim


def state_errors(material: Any, known: raw.Rates, zeta: float, share: float) -> dict[str, float]:
    """Relative errors of a state by its rows: beta and the slopes of Q over the condition of beta.

    dQ_dV over mu/V where it is below, dM_dV and the parts of M in the bodies over M or M/V.
    """
    V, delta, exact, whole = raw.state(mpmath, known, zeta, share)
    scene = vr.Scene(kappa=1.0, mu=1.0, **{"alpha" if isinstance(material, float) else "material": material})
    found = vr.contact(scene, V, delta=delta, fields=(*exact, *OF_BODIES))
    condition = 1 / (1 - delta / exact["delta_star"])
    scales = {"dQ_dV": max(abs(exact["dQ_dV"]), 1 / V), "dM_dV": whole.m, **dict.fromkeys(OF_BODIES, exact["M"])}
    if isinstance(material, vr.Bodies):
        parts = raw.shares(mpmath, known, zeta, whole)
        half = sum(weight * part for weight, part in zip(material.half_space_weights.tolist(), parts, strict=True))
        half /= sum(parts)  # V and zeta differ by a rounding
    else:
        half = mpmath.mpf(0.5)
    exact |= dict(zip(OF_BODIES, (half * exact["M"], (1 - half) * exact["M"]), strict=True))
    errors = {name: abs(getattr(found, name) - truth) / scales.get(name, truth) for name, truth in exact.items()}
    for name in ("beta", "dQ_dV", "dQ_ddelta"):
        errors[name] /= condition
    return {name: float(error) for name, error in errors.items()}


def any_state(random: np.random.Generator, known: raw.Rates) -> tuple[float, float]:
    """zeta, from 14 decades below the fastest time to 14 above the slowest or near them, and 1 - beta, about."""
    near, far = (float(mpmath.log10(1 / rate)) for rate in (known.a[-1], known.b[0]))
    beyond = 14.0 if random.random() < 0.3 else 2.0
    share = (10.0 ** random.uniform(-14.0, 0.0), random.random(), 1.0 - 10.0 ** random.uniform(-7.0, 0.0))
    return 10.0 ** random.uniform(near - beyond, far + beyond), share[random.integers(3)]


def states(random: np.random.Generator, count: int) -> list[Claim]:
    """Every field of states by their rows, five a material."""
    kinds = "1.01 <= alpha <= 1e6, 1 to 10 and 30 modes, pairs of 1 to 5 modes a body"
    where = "kappa V from 1e-14 over the slowest time to 1e14 over the fastest, creep from 1e-14 delta_star to its end"
    claims = {group: Claim(f"{group}, by rows", f"{kinds}; {where}", bound) for group, (bound, _) in STATES.items()}
    materials = [make for make, share in _MATERIALS for _ in range(max(count // share, 1))]
    for make in tqdm(materials, desc="states", leave=False):
        material = make(random)
        known = raw.rates_of(mpmath, material)
        for _ in range(5):
            zeta, share = any_state(random, known)
            errors = state_errors(material, known, zeta, share)
            for group, (_, names) in STATES.items():
                claims[group].add([errors[name] for name in names], at(zeta=zeta, share=share) + f", {material!r}")
    return list(claims.values())


def _any_bodies(random: np.random.Generator) -> vr.Bodies:
    cylinder, half_space = (random_series(random, int(random.integers(1, 6))) for _ in range(2))
    return vr.Bodies(cylinder, half_space, random.uniform(0.05, 0.95))


#: materials, and of how many there is one
_MATERIALS: list[tuple[Callable[[np.random.Generator], Any], int]] = [
    (lambda random: float(10.0 ** random.uniform(np.log10(1.01), 6.0)), 1),
    (lambda random: float(random.uniform(20.0, 35.0)), 4),
    (lambda random: random_series(random, int(random.integers(1, 11))), 1),
    (lambda random: random_series(random, 30), 20),
    (_any_bodies, 1),
]


def chebyshev(random: np.random.Generator, count: int) -> Claim:
    """g, h, m and what of m is a body's by way of a solver that has nothing in common with the others."""
    claim = Claim(
        "g, h, m, shares against Chebyshev polynomials",
        f"1 to 4 modes of E in [0.1, 10] over up to 3 decades, z up to {THICKEST:g} of the shortest time", CHEBYSHEV,
    )  # fmt: skip
    for _ in tqdm(range(count), desc="Chebyshev", leave=False):
        p = random_series(random, int(random.integers(1, 5)), 3.0, (-1.0, 1.0))
        z = float(p.tau[-1] * 10.0 ** random.uniform(-2.0, np.log10(THICKEST)))
        other, weights = spectral.contact(p, z, TERMS), random.random(p.T.size)
        g, h, half_space, cylinder = of_z(p, z, weights)
        found = np.array([g, h, half_space + cylinder, half_space])
        claim.add(abs(found / [*other[:3], weights @ other.shares] - 1.0), at(z=z) + f", {p!r}")
    return claim


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """All rows."""
    random = np.random.default_rng(sizes["seed"] + 6)
    with mpmath.workdps(DIGITS):
        made = [functions(random, modes, max(sizes["series_states"] // modes, 10)) for modes in MODES]
    return [claim.row for claim in [*made, chebyshev(random, sizes["series_pairs"])]]


def rows_of_states(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """Rows of states."""
    with mpmath.workdps(DIGITS_OF_STATES):
        return [claim.row for claim in states(np.random.default_rng(sizes["seed"] + 11), sizes["state_materials"])]
