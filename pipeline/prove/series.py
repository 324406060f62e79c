"""Materials of many relaxation times and pairs: the matching conditions at 60 digits, and Chebyshev polynomials.

The conditions stand in ``pipeline.truth.series`` as they were derived, without the system that the kernels
solve; the Chebyshev solver knows neither Bessel functions nor the relaxation form.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
from tqdm import tqdm

import viscoroll as vr
from viscoroll.kernels.material.functions import at_contact, generators
from viscoroll.kernels.material.series import AT_HALF_SPACE, Parts, room, values
from viscoroll.kernels.material.series import shares as parts_of
from viscoroll.materials.tables import record, series

from ..truth import series as raw
from ..truth import spectral
from .claim import Claim, at

MODES = (1, 3, 10, 30)
DIGITS, DECADES = 60, 14.0
#: e-folds beyond the shortest and the longest time
BELOW, ABOVE = 30.0, 28.0
CONDITIONS, PARTS, CHEBYSHEV = 1e-13, 1e-12, 1e-11
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


def functions(random: np.random.Generator, modes: int, count: int) -> Claim:
    """g, h and m, as contact and motion read them, over all z."""
    claim = Claim(
        f"g, h, m of {modes} mode{'s' * (modes > 1)}",
        f"times over up to {DECADES:g} decades, z from the least e^-{BELOW:g} to the longest e^{ABOVE:g}", CONDITIONS,
    )  # fmt: skip
    for n in tqdm(range(count), desc=claim.claim, leave=False):
        if n % 10 == 0:  # ten z a material
            p = random_series(random, modes)
            table = record(p)
            known = raw.rates(mpmath, p.E.tolist(), p.tau.tolist())
        z = float(np.exp(random.uniform(np.log(table.tau) - BELOW, np.log(p.T[0]) + ABOVE)))
        truth = raw.functions(mpmath, known, z)
        found = (*generators(z, table), at_contact(z, table)[4])
        pairs = zip(found, (truth.g, truth.h, truth.m), strict=True)
        claim.add([relative(value, exact) for value, exact in pairs], at(z=z) + f", {p!r}")
    return claim


def shares(random: np.random.Generator, count: int) -> Claim:
    """M_half_space and M_cylinder of pairs of up to five modes each, at the zeta that the call reports.

    Over M: the share of a slow mode beside much faster ones, which is small, has lost digits of its own.
    """
    claim = Claim(
        "parts of M in the bodies of a pair, over M",
        "1 to 5 modes a body, over up to 14 decades; kappa V in [1e-6, 1e8]", PARTS,
    )  # fmt: skip
    for _ in tqdm(range(count), desc="pairs", leave=False):
        cylinder, half_space = (random_series(random, int(random.integers(1, 6))) for _ in range(2))
        pair = vr.Bodies(cylinder, half_space, random.uniform(0.05, 0.95))
        found = vr.contact(
            vr.Scene(material=pair, kappa=1.0, mu=0.1), 10.0 ** random.uniform(-6.0, 8.0), delta=0.0,
            fields=("M", "M_half_space", "M_cylinder", "zeta"),
        )  # fmt: skip
        total, weights = pair.total, pair.half_space_weights
        known = raw.rates_of_creep(mpmath, total.J.tolist(), total.T.tolist(), total.alpha)
        truth = raw.functions(mpmath, known, found.zeta)
        parts = raw.shares(mpmath, known, found.zeta, truth)
        # sum J is 1 - 1/alpha but for rounding, which g = T_mean - sum X of the conditions feels, and no part
        half = sum(weight * part for weight, part in zip(weights, parts, strict=True)) / sum(parts)
        pairs = zip((found.M_half_space, found.M_cylinder), (half, 1 - half), strict=True)
        claim.add(
            [float(abs(mpmath.mpf(part) / found.M - exact)) for part, exact in pairs],
            at(zeta=found.zeta) + f", {pair!r}",
        )
    return claim


def chebyshev(random: np.random.Generator, count: int) -> Claim:
    """g, h, m and what of m is a body's by way of a solver that has nothing in common with the others."""
    claim = Claim(
        "g, h, m, shares against Chebyshev polynomials",
        f"1 to 4 modes of E in [0.1, 10] over up to 3 decades, z up to {THICKEST:g} of the shortest time", CHEBYSHEV,
    )  # fmt: skip
    for _ in tqdm(range(count), desc="Chebyshev", leave=False):
        p = random_series(random, int(random.integers(1, 5)), 3.0, (-1.0, 1.0))
        table = record(p)
        z = float(p.tau[-1] * 10.0 ** random.uniform(-2.0, np.log10(THICKEST)))
        other, weights = spectral.contact(p, z, TERMS), random.random(p.T.size)
        known, places = Parts(**series(p)._asdict(), weights=weights), (z, z, z, z)
        work = room(known)
        values(places, False, known, work)
        parts_of(places, known, work)
        half_space = work.found[AT_HALF_SPACE]
        found = np.array([*generators(z, table), at_contact(z, table)[4], half_space])
        claim.add(abs(found / [*other[:3], weights @ other.shares] - 1.0), at(z=z) + f", {p!r}")
    return claim


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """All rows."""
    random = np.random.default_rng(sizes["seed"] + 6)
    with mpmath.workdps(DIGITS):
        made = [functions(random, modes, max(sizes["series_states"] // modes, 10)) for modes in MODES]
        made.append(shares(random, sizes["series_pairs"]))
    return [claim.row for claim in [*made, chebyshev(random, sizes["series_pairs"])]]
