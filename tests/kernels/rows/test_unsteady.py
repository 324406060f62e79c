"""N of M = M(V) + N V': against its definition in many digits, its limits, and what is known of its
shape.
"""

import math

import flint
import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from pipeline.evidence.truth import Material, material_of, zone_of

#: about the largest |N|, over S_J
LARGEST = 0.05


def random_series(seed):
    draw = np.random.default_rng(seed)
    modes = int(draw.integers(1, 6))
    return vr.Prony(10.0 ** draw.uniform(-1.5, 1.5, modes), 10.0 ** draw.uniform(-4.0, 0.0, modes))


def N(material, kappa_V):
    scene = vr.Scene(material=material, kappa=1.0, mu=0.3)
    return scene.contact(kappa_V, delta=0.0, fields="N").N


def exact(known, z):
    """N by derivatives of H and H m of a material that is shifted, K(s + sigma), or stretched,
    K(s + sigma s).
    """

    def state(z, shift, stretch):
        z, shift, stretch = map(flint.arb, (z, shift, stretch))
        moved = Material.of_rates(
            *([(rate - shift) / (1 + stretch) for rate in rates] for rates in (known.a, known.b))
        )
        found = zone_of(moved, z)
        compliance = flint.arb(1)  # of long times
        for own_a, own_b in zip(known.a, known.b):
            compliance *= (1 - shift / own_a) / (1 - shift / own_b)
        H = z * (z + 2 * found.h) / compliance
        return tuple(mp.mpf(value.mid()) for value in (H, H * found.m, found.g))

    def form(z, shift):
        """d(H m) - 2 g dH."""
        moved = [mp.diff(lambda s, n=n: state(z, shift * s, (1 - shift) * s)[n], 0) for n in (0, 1)]
        return moved[1] - 2 * state(z, 0, 0)[2] * moved[0]

    H, _, g = state(z, 0, 0)
    theta = 2 * H / mp.diff(lambda at: state(at, 0, 0)[0], z)
    dg = mp.diff(lambda at: state(at, 0, 0)[2], z)
    dU = mp.diff(lambda at: form(at, 1), z)
    return -(mp.mpf(1.5) * form(z, 1) - theta / 2 * dU + (theta * dg - g) * form(z, 0)) / H


@pytest.mark.parametrize("material", [1.5, 1e4, random_series(1)])
def test_rows_against_its_definition(material):
    """Over its largest size: N has a zero."""
    with mp.workdps(50), flint.ctx.workprec(1000):
        known = material_of(material)
        low, high = (math.log10(1 / float(rate)) for rate in (known.a[-1], known.b[0]))
        z = (10.0 ** np.random.default_rng(4).uniform(low - 2.0, high + 3.0, 4)).tolist()
        h = [zone_of(known, flint.arb(each)).h for each in z]
        truth = [float(exact(known, mp.mpf(each))) for each in z]
        S_J = float(sum(J / b**2 for J, b in zip(known.J, known.b)))
    u = [0.5 / math.sqrt(each * (each + 2.0 * float(own))) for each, own in zip(z, h)]
    kind = "alpha" if isinstance(material, float) else "material"
    scene = vr.Scene(kappa=1.0, mu=0.1, **{kind: material})
    found = scene.contact(u, delta=0.0, fields="N").N
    assert close(found, truth, tol.AXIS_UNSTEADY, scale=LARGEST * S_J)
    if kind == "alpha":  # among others it is read from another place
        many = scene.replace(alpha=[[material], [1.0]]).contact(u, delta=0.0, fields="N").N
        assert close(many, [found, 0.0 * found], tol.AXIS_UNSTEADY, scale=LARGEST)


@pytest.mark.parametrize("seed", range(4))
def test_limits(seed):
    """At rest -sum E tau^2; fast sum J/(4 kappa V)^2."""
    p = random_series(seed)
    assert close(N(p, 0.0), -(p.E * p.tau**2).sum(), tol.UNSTEADY_SERIES)
    for fast in (1e4 / p.tau[-1], 1e9 / p.tau[-1], 1e40):
        assert close(N(p, fast), p.J.sum() / (4.0 * fast) ** 2, tol.UNSTEADY_FAST)


def test_two_bodies():
    kappa_V = np.geomspace(1e-2, 1e3, 40)
    pair = vr.Bodies(random_series(1), random_series(2), 0.3)
    assert close(N(pair, kappa_V), N(pair.total, kappa_V), tol.UNSTEADY_UNIT)
