"""One material: states by its rows and motions by its table, against Bessel ratios and 50 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import precise
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.contact_fields import FIELDS

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

SCENE = vr.PAPER_SECTION_5_ROUNDED
KAPPA, MU = SCENE.kappa, SCENE.mu
ALPHAS = (1.0001, 1.5, 11.0, 100.0, 1e4)
MANY = 4096


def states(scene: vr.Scene, count: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """V, delta and s over the whole stated domain, s graded to both ends."""
    rng = np.random.default_rng(seed)
    V = 10.0 ** rng.uniform(-7, 5, count) / scene.kappa
    s = np.where(rng.random(count) < 0.5, 10.0 ** rng.uniform(-12, 0, count), 1.0 - 10.0 ** rng.uniform(-9, 0, count))
    return V, s * by_ratios(scene, V, np.zeros(count)).delta_star, s


def by_ratios(scene: vr.Scene, V: np.ndarray, delta: np.ndarray) -> vr.Values:
    """The same by Bessel ratios and roots, as of states with an alpha each."""
    return vr.contact(scene.replace(alpha=np.full(V.size, scene.alpha)), V, delta=delta)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_against_50_digits(alpha):
    scene = vr.Scene(alpha, KAPPA, MU)
    V, delta, _ = states(scene, MANY, seed=11)
    state = vr.contact(scene, V, delta=delta)
    for i in range(14):
        with mp.workdps(precise.DIGITS):
            exact = precise.state(alpha, KAPPA, MU, V[i], delta[i])
            for name in ("lam", "zeta", "epsilon", "delta_star", "Q", "M"):
                error = abs(mp.mpf(float(getattr(state, name)[i])) / getattr(exact, name) - 1)
                assert error <= tol.SLICE, (name, V[i], delta[i])
            conditioned = tol.SLICE / (1 - mp.mpf(float(delta[i])) / exact.delta_star)
            assert abs(mp.mpf(float(state.beta[i])) / exact.beta - 1) <= conditioned, (V[i], delta[i])


@pytest.mark.parametrize("alpha", [*ALPHAS, 1.0 + 1e-12, 3.7, 1e6])
def test_against_the_law_by_ratios(alpha):
    scene = vr.Scene(alpha, KAPPA, MU)
    V, delta, s = states(scene, 3 * MANY, seed=12)
    many, single = vr.contact(scene, V, delta=delta), by_ratios(scene, V, delta)
    assert np.array_equal(many.full_slip, single.full_slip)
    for name in ("lam", "zeta", "epsilon", "delta_star", "Q", "M", "beta"):
        error = abs(getattr(many, name) / getattr(single, name) - 1.0)
        assert (error * ((1.0 - s) if name == "beta" else 1.0)).max() <= tol.SLICE, name


@pytest.mark.parametrize("alpha", ALPHAS)
def test_motions_of_one_material_are_those_of_an_alpha_each(alpha):
    """Table and ratios: to the stated error of a motion.  The kind follows from the scene, not from the number."""
    one = SCENE.replace(alpha=alpha)
    V0, omega0 = np.random.default_rng(22).uniform(-2.0, 2.0, (2, 20))
    t = np.linspace(0.0, 3.0 / SCENE.gamma * 1.5 * alpha / (alpha - 1.0), 7)
    options = {"method": "integrate", "rtol": 1e-9}
    tabled = vr.ensemble(one, V0, omega0, t, **options)
    rationed = vr.ensemble(one.replace(alpha=np.full(20, alpha)), V0, omega0, t, **options)
    for field in ("V", "omega", "x"):
        assert close(getattr(tabled, field), getattr(rationed, field), rel=tol.KINDS)
    for n in (0, 7):
        alone = vr.roll(one, V0[n], omega0[n], t, rtol=1e-9)
        part = vr.ensemble(one, V0[n : n + 2], omega0[n : n + 2], t, threads=1, **options)
        assert np.array_equal(alone.V, tabled.V[n])
        assert np.array_equal(part.V, tabled.V[n : n + 2])


def test_extreme_speeds_and_the_last_of_the_stick_zone():
    """kappa |V| from 0 to near the ends of the doubles, and the last millionth before delta_star, against ratios."""
    V = np.array([0.0, 1e-300, 1e-120, -1e-110, 1e110, -1e200, 0.5])
    star = by_ratios(SCENE, V, np.zeros(V.size)).delta_star
    delta = np.where(V == 0.5, star * (1.0 - 1e-7), 0.4 * star)
    found, exact = vr.contact(SCENE, V, delta=delta), by_ratios(SCENE, V, delta)
    for name in FIELDS:
        bound = tol.SLICE / 1e-7 if name == "beta" else tol.SLICE
        assert close(getattr(found, name), getattr(exact, name), rel=bound), name


@pytest.mark.parametrize("alpha", ALPHAS)
def test_full_slip_begins_at_delta_star(alpha):
    """At the delta_star that the call itself reports, and at no other's beyond a few units in the last place."""
    scene = vr.Scene(alpha, KAPPA, MU)
    V = 10.0 ** np.random.default_rng(17).uniform(-7, 5, MANY) / KAPPA
    star = vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    at = vr.contact(scene, V, delta=-star)
    assert at.full_slip.all()
    assert np.all(at.Q == -MU)
    assert np.all(at.beta == 0.0)
    single = by_ratios(scene, V, np.zeros(MANY)).delta_star
    for ulps in (-tol.SLICE_STAR_ULP, tol.SLICE_STAR_ULP):
        near = vr.contact(scene, V, delta=single + ulps * np.spacing(single))
        assert np.all(near.full_slip == (ulps > 0))
        assert np.array_equal(near.full_slip, abs(near.delta) >= near.delta_star)
        assert np.all(abs(near.Q) <= MU)
