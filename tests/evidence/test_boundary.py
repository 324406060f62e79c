"""Boundary elements: how their errors fall, and the package against them."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from pipeline.evidence.truth import boundary
from pipeline.evidence.truth import series as raw

PAIR = vr.Bodies(cylinder=vr.Prony([2.0, 6.0], [1.0, 0.05]), half_space=vr.Prony([1.0], [0.3]), share=0.7)


def functions(p: vr.Prony, z: float, eta: float) -> tuple[float, ...]:
    """H, g, m, F(z) - F(eta), 1 - H(eta)/H(z) from the matching conditions."""
    with mp.workdps(40):
        known = raw.rates(mp, p.E.tolist(), p.tau.tolist())
        one, other = raw.functions(mp, known, z), raw.functions(mp, known, eta)
        H, H_eta = z * z + 2 * z * one.h, eta * eta + 2 * eta * other.h
        return tuple(float(value) for value in (H, one.g, one.m, z + one.g - eta - other.g, 1 - H_eta / H))


@pytest.mark.parametrize(("z", "eta"), [(0.05, 0.02), (0.7, 0.5), (5.0, 1.0)])
def test_errors_fall_with_the_third_power(z, eta):
    """To an eighth for twice the elements, and what is extrapolated from both is better again by ten at least."""
    p = vr.Prony([10.0], [1.0])
    truth = np.array(functions(p, z, eta))
    coarse, fine = (np.abs(np.array(boundary.contact(p, z, eta, n)[:5]) / truth - 1.0) for n in (50, 100))
    assert np.all(coarse / fine >= tol.ELEMENTS_FALL)
    assert np.all(fine <= tol.ELEMENTS)
    further = np.abs(np.array(boundary.extrapolated(p, z, eta, 50)[:5]) / truth - 1.0)
    assert np.all(further <= 0.1 * fine)


@pytest.mark.parametrize("V", [0.05, 0.5, 5.0])
def test_contact_of_a_pair_as_elements_find_it(V):
    """Load, offset, moment with its parts, creep and friction; pressure, friction and slip hurt no inequality."""
    scene = vr.Scene(alpha=None, kappa=1.0, mu=0.5, material=PAIR)
    star = float(vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star)
    for share in (0.1, 0.6, 0.95):
        c = vr.contact(scene, V, delta=share * star)
        z = float(c.zeta)
        found = boundary.extrapolated(PAIR.total, z, float(c.beta) * z, 50)
        assert found.least > 0.0
        assert close(found.H, 1.0 / (2.0 * V) ** 2, rel=tol.ELEMENTS_FURTHER)
        assert close(found.g / z, float(c.epsilon), rel=tol.ELEMENTS_FURTHER)
        assert close(V * found.m, float(c.M), rel=tol.ELEMENTS_FURTHER)
        assert close(scene.mu * V * found.d, share * star, rel=tol.ELEMENTS_FURTHER)
        assert close(scene.mu * found.Q, float(c.Q), rel=tol.ELEMENTS_FURTHER)
        half_space = V * float(found.shares @ PAIR.half_space_weights)
        assert close(half_space, float(c.M_half_space), rel=tol.ELEMENTS_PARTS, scale=float(c.M))


def test_a_material_without_creep_is_elastic():
    """p an ellipse, no offset, no moment; Carter's friction."""
    found = boundary.extrapolated(vr.Prony.elastic(), 1.0, 0.6, 50)
    assert close([found.H, found.d, found.Q], [1.0, 0.4, 1.0 - 0.36], rel=tol.ELEMENTS_FURTHER)
    assert close([found.g, found.m], [0.0, 0.0], rel=tol.ELEMENTS_FURTHER, scale=1.0)
