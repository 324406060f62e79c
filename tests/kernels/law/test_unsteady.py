"""N of M = M(V) + N V': against its definition in many digits, its limits, and what is known of its shape."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr
from pipeline.evidence.truth import series as raw
from viscoroll.kernels.law.unsteady import room, unsteady
from viscoroll.materials.law_modes import series_of

DIGITS = 50
#: about the largest |N|, over S_J
LARGEST = 0.05
#: N of one mode over kappa V, to the digits printed, from a program of others' making
SPEEDS = (0.0, 0.02, 0.05, 0.1, 0.15, 0.3, 0.5, 0.684, 1.0, 1.5, 2.5, 4.37, 8.0, 20.0)
PRINTED = {
    1.5: "-0.22222 -0.20139 -0.17013 -0.11958 -0.07395 0.007163 0.02680 0.02327 0.01501 0.007936 0.003151 0.001073 "
    "3.243e-4 5.208e-5",
    3.0: "-0.22222 -0.20712 -0.18367 -0.14363 -0.10406 -0.003927 0.05243 0.05298 0.03537 0.01816 0.006848 0.002239 "
    "6.608e-4 1.047e-4",
    11.0: "-0.08264 -0.07837 -0.07079 -0.05596 -0.03960 0.009232 0.05460 0.06950 0.05742 0.03015 0.01062 0.003254 "
    "9.253e-4 1.436e-4",
    30.0: "-0.03222 -0.03047 -0.02664 -0.01790 -0.007362 0.02629 0.05817 0.06817 0.05930 0.03451 0.01222 0.003610 "
    "0.001001 1.533e-4",
    300.0: "-0.00332 -0.002811 -8.245e-4 0.004890 0.01253 0.03846 0.06294 0.06900 0.05785 0.03430 0.01314 0.003980 "
    "0.001071 1.594e-4",
}


def random_series(seed: int) -> vr.Prony:
    draw = np.random.default_rng(seed)
    modes = int(draw.integers(1, 6))
    return vr.Prony(10.0 ** draw.uniform(-1.5, 1.5, modes), 10.0 ** draw.uniform(-4.0, 0.0, modes))


def N(material: vr.Prony, kappa_V: Any) -> Any:
    return vr.contact(vr.Scene(material=material, kappa=10.0, mu=0.3), 0.1 * kappa_V, delta=0.0, fields="N").N


def exact(known: raw.Rates, z: Any) -> Any:
    """N by derivatives of H and H m of a material that is shifted, K(s + sigma), or stretched, K(s + sigma s)."""

    def state(z: Any, shift: Any, stretch: Any) -> tuple[Any, Any, Any]:
        a, b = ([(rate - shift) / (1 + stretch) for rate in rates] for rates in (known.a, known.b))
        found = raw.functions(mp, raw.Rates(a, b, None, sum(1 / at for at in b) - sum(1 / at for at in a)), z)
        compliance = mp.mpf(1)  # of long times
        for own_a, own_b in zip(known.a, known.b, strict=True):
            compliance *= (1 - shift / own_a) / (1 - shift / own_b)
        H = (z * z + 2 * z * found.h) / compliance
        return H, H * found.m, found.g

    def form(z: Any, shift: int) -> Any:
        """d(H m) - 2 g dH."""
        moved = [mp.diff(lambda s, n=n: state(z, shift * s, (1 - shift) * s)[n], 0) for n in (0, 1)]
        return moved[1] - 2 * state(z, 0, 0)[2] * moved[0]

    H, _, g = state(z, 0, 0)
    theta = 2 * H / mp.diff(lambda at: state(at, 0, 0)[0], z)
    dg, dU = mp.diff(lambda at: state(at, 0, 0)[2], z), mp.diff(lambda at: form(at, 1), z)
    return -(mp.mpf(1.5) * form(z, 1) - theta / 2 * dU + (theta * dg - g) * form(z, 0)) / H


@pytest.mark.parametrize("seed", range(4))
def test_against_its_definition(seed):
    p = random_series(seed)
    known = series_of(p.modes)
    work = room(known)
    largest = p.second_moments[0]
    with mp.workdps(DIGITS):
        rates = raw.rates(mp, p.E.tolist(), p.tau.tolist())
        for z in 10.0 ** np.random.default_rng(seed).uniform(np.log10(p.tau[-1]) - 2.0, 2.5, 4):
            truth, found = exact(rates, mp.mpf(z)), unsteady(z, known, work)
            assert abs(found - truth) <= tol.UNSTEADY * (abs(truth) + tol.UNSTEADY_ZERO * largest), z


@pytest.mark.parametrize("material", [1.5, 28.0, 1e4, random_series(0)])
def test_rows_against_its_definition(material):
    """Over its largest size: N has a zero."""
    with mp.workdps(DIGITS):
        known = raw.rates_of(mp, material)
        slow, fast = (float(1 / rates[end]) for rates, end in ((known.b, 0), (known.a, -1)))
        found, truth = [], []
        for z in 10.0 ** np.random.default_rng(4).uniform(np.log10(fast) - 2.0, np.log10(slow) + 3.0, 6):
            u = 1 / (2 * mp.sqrt(z * z + 2 * z * raw.functions(mp, known, z).h))
            scene = vr.Scene(kappa=1.0, mu=0.1, **{"alpha" if isinstance(material, float) else "material": material})
            found.append(vr.contact(scene, float(u), delta=0.0, fields="N").N)
            truth.append(float(exact(known, mp.mpf(z))))
        S_J = sum(J / b**2 for J, b in zip(raw.creep_strengths(mp, known), known.b, strict=True))
    assert close(found, truth, rel=tol.AXIS_UNSTEADY, scale=LARGEST * float(S_J))


@pytest.mark.parametrize("alpha", PRINTED)
def test_numbers_printed_elsewhere(alpha):
    """By an array of alphas, by one alpha, by the series of one mode, alone and in company: N of one mode."""
    material = vr.Prony.creep([(alpha - 1.0) / alpha], [1.0], alpha=alpha)
    for kappa_V, printed in zip(SPEEDS, PRINTED[alpha].split(), strict=True):
        found = vr.contact(vr.Scene([alpha, 1.0], kappa=1.0, mu=0.1), kappa_V, delta=0.0, fields="N").N
        last = 10.0 ** (int(f"{float(printed):e}"[-3:]) - len(printed.split("e")[0].lstrip("-0.").replace(".", "")) + 1)
        assert abs(found[0] - float(printed)) <= 0.51 * last, kappa_V
        assert found[1] == 0.0
        one = vr.contact(vr.Scene(alpha, kappa=1.0, mu=0.1), kappa_V, delta=0.0, fields="N").N
        assert close(one, found[0], rel=tol.AXIS_UNSTEADY, scale=LARGEST)
        assert close(N(material, kappa_V), found[0], rel=tol.UNSTEADY_SERIES, scale=1.0)


@pytest.mark.parametrize("seed", range(8))
def test_limits(seed):
    """Slow: -S_E + kappa V (w_3 - 2 w_1 w_2), w_n = (n - 1)! (sum T^n - sum tau^n); fast: sum J/(4 kappa V)^2."""
    p = random_series(seed)
    w = [factor * ((p.T**n).sum() - (p.tau**n).sum()) for n, factor in ((1, 1.0), (2, 1.0), (3, 2.0))]
    S_E = p.second_moments[0]
    slow = 1e-4 / p.T[0]
    assert close(N(p, 0.0), -S_E, rel=tol.UNSTEADY_SERIES)
    rise = (N(p, slow) - N(p, 0.0)) / slow
    assert close(rise, w[2] - 2.0 * w[0] * w[1], rel=tol.UNSTEADY_SLOW)
    for fast in (1e4 / p.tau[-1], 1e9 / p.tau[-1], 1e40):
        assert close(N(p, fast), p.J.sum() / (4.0 * fast) ** 2, rel=tol.UNSTEADY_FAST)


def test_shape():
    """Found on many series: N is least at V = 0, -S_E, and below 0.084 S_J; the same for both signs of V."""
    for seed in range(12):
        p = random_series(seed)
        kappa_V = np.geomspace(1e-3 / p.T[0], 1e3 / p.tau[-1], 300)
        found = N(p, kappa_V)
        S_E, S_J = p.second_moments
        assert (found >= -S_E * (1.0 + tol.UNSTEADY_SERIES)).all()
        assert found.max() < 0.084 * S_J
        assert np.array_equal(N(p, -kappa_V), found)


def test_unit_of_time_and_two_bodies():
    p = random_series(3)
    kappa_V = np.geomspace(1e-2, 1e3, 40)
    assert close(N(p.slower(3.7e5), kappa_V / 3.7e5) / 3.7e5**2, N(p, kappa_V), rel=tol.UNSTEADY_UNIT)
    pair = vr.Bodies(random_series(1), random_series(2), 0.3)
    both = vr.contact(vr.Scene(material=pair, kappa=10.0, mu=0.3), 0.1 * kappa_V, delta=0.0, fields=("N", "M_cylinder"))
    assert close(both.N, N(pair.total, kappa_V), rel=tol.UNSTEADY_UNIT)


def test_refused_by_the_printed_equations():
    scene = vr.Scene(11.0, kappa=1.0, mu=0.1)
    refused(lambda: vr.contact(scene, 1.0, delta=0.0, fields="N", method="direct"), "fields", "'N'", "table")
