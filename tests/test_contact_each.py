"""States that have an alpha or a material each: against 50 digits and the law of each alone, whatever their company."""

from __future__ import annotations

import weakref
from concurrent.futures import ThreadPoolExecutor

import mpmath as mp
import numba
import numpy as np
import precise
import pytest
import tolerances as tol
from closeness import close
from many import MATERIALS

import viscoroll as vr
from pipeline.evidence.truth import contact_enclosure
from viscoroll.contact_fields import FIELDS, SLOPES, SLOPES_OF_BODIES
from viscoroll.kernels.rows import law as read
from viscoroll.kernels.rows.record import hold
from viscoroll.materials import law_each
from viscoroll.materials.law_table import law_table

PARTS = ("M_half_space", "M_cylinder")


def states(count: int, seed: int) -> tuple[np.ndarray, ...]:
    """alpha from exactly 1 to 1e12, kappa, mu, V, and the share of delta_star, graded to both ends."""
    rng = np.random.default_rng(seed)
    alpha = 10.0 ** rng.uniform(0.0, 6.0, count)
    alpha[:6] = 1.0, 1.0 + 2.0**-52, 1.0 + 1e-9, 2.0, 2.0**20, 1e12
    kappa, mu = 10.0 ** rng.uniform(-0.3, 2.3, count), 10.0 ** rng.uniform(-2.0, 0.5, count)
    near, at_rest = 1.0 - 10.0 ** rng.uniform(-6.0, 0.0, count), 10.0 ** rng.uniform(-12.0, 0.0, count)
    s = np.choose(rng.integers(3, size=count), [at_rest, near, rng.random(count)])
    return alpha, kappa, mu, 10.0 ** rng.uniform(-7.0, 7.0, count) / kappa, s


def solved(alpha, kappa, mu, V, s, **options) -> tuple[vr.Values, np.ndarray]:
    scene = vr.Scene(alpha, kappa, mu)
    delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    return vr.contact(scene, V, delta=delta, **options), delta


# --- an alpha each ---


def test_an_alpha_each_against_50_digits():
    alpha, kappa, mu, V, s = states(40, 1)
    found, delta = solved(alpha, kappa, mu, V, s)
    for n in range(alpha.size):
        with mp.workdps(precise.DIGITS):
            exact = precise.state(alpha[n], kappa[n], mu[n], V[n], delta[n])
            for name in ("lam", "zeta", "epsilon", "delta_star", "Q", "M", "beta"):
                bound = tol.EACH_SHIFT if name == "epsilon" else tol.EACH_ALPHA
                bound /= float(1 - mp.mpf(delta[n]) / exact.delta_star) if name == "beta" else 1.0
                assert close(getattr(found, name)[n], float(getattr(exact, name)), rel=bound), (name, alpha[n], V[n])


def test_slopes_of_an_alpha_each_against_50_digits():
    alpha, kappa, mu, V, s = (array[3:] for array in states(11, 2))
    found, delta = solved(alpha, kappa, mu, V, s, slopes=True)
    for n in range(alpha.size):
        with mp.workdps(precise.DIGITS):
            by_V = precise.slope(alpha[n], kappa[n], mu[n], V[n], delta[n], "V")
            by_delta = precise.slope(alpha[n], kappa[n], mu[n], V[n], delta[n], "delta")
        rel, c = tol.SLOPE / (1.0 - s[n]), 1.0 - 1.0 / alpha[n]
        assert close(found.dQ_ddelta[n], float(by_delta["Q"]), rel=rel), n
        assert close(found.dQ_dV[n], float(by_V["Q"]), rel=rel, scale=mu[n] / V[n]), n
        assert close(found.dM_dV[n], float(by_V["M"]), rel=tol.SLOPE, scale=c), n


def test_at_one_the_closed_forms_hold_to_the_bit():
    V, delta = np.array([0.0, 1e-30, 0.3, -4.0, 1e200]), np.array([1e-3, 2e-3, -1e-2, 0.03, 0.5])
    found = vr.contact(vr.Scene([1.0, 1.0, 1.0, 1.0, 1.0], 2.91, 0.2), V, delta=delta, slopes=True)
    one = vr.contact(vr.Scene(1.0, 2.91, 0.2), V, delta=delta, slopes=True)
    for name, value in found.as_dict().items():
        assert np.array_equal(value, getattr(one, name)), name


def test_any_speed():
    """V = 0, the slow end and the fast limit, against ball arithmetic."""
    alpha, V = np.array([1.5, 11.0, 1e4, 11.0, 300.0, 1e6]), np.array([1e-300, -1e-200, 1e-20, 1e145, -1e290, 1e30])
    found = vr.contact(vr.Scene(alpha, 2.91, 0.2), V, delta=0.0, fields=("M", "delta_star"))
    for n in range(alpha.size):
        exact = contact_enclosure(alpha[n], 2.91, 0.2, abs(V[n]), 0.0)
        assert close(found.M[n], np.copysign(float(exact["M"]), V[n]), rel=tol.EACH_ALPHA)
        assert close(found.delta_star[n], float(exact["delta_star"]), rel=tol.EACH_ALPHA)
    rest = vr.contact(vr.Scene([2.0, 11.0], 2.91, 0.2), 0.0, omega=[0.0, 1.0])
    assert (rest.Q.tolist(), rest.M.tolist(), rest.lam.tolist()) == ([0.0, 0.2], [0.0, 0.0], [1.0, 1.0])


def test_the_axis_is_shared_by_threads(monkeypatch):
    """Octaves of alpha are made once, whoever meets them, and never written to again."""
    monkeypatch.setattr(law_each, "_octaves", {})
    monkeypatch.setattr(law_each, "_known", np.zeros_like(law_each._known))
    made = []
    monkeypatch.setattr(law_each, "_octave", lambda n, make=law_each._octave: made.append(n) or make(n))
    alpha = np.array([3.0, 200.0, 5.0, 3.5])
    with ThreadPoolExecutor(4) as pool:
        calls = [pool.submit(vr.contact, vr.Scene(alpha, 2.91, 0.2), 0.3, delta=1e-3) for _ in range(8)]
    assert all(np.array_equal(call.result().Q, calls[0].result().Q) for call in calls)
    assert sorted(made) == [1, 2, 7]
    assert not any(octave.flags.writeable for octave in law_each._octaves.values())


def test_a_law_keeps_alive_what_its_kernels_have_the_addresses_of():
    alpha = np.array([3.0, 200.0])
    held = weakref.ref(alpha)
    law = law_each.law_of_alphas(alpha)
    del alpha
    assert held() is not None
    del law
    assert held() is None


# --- what a motion asks for ---


def test_one_record_whatever_makes_the_rows():
    """One reader, by the same types: of a table, of an alpha each, of a series each, from motion to motion and back."""
    alpha = np.array([3.0, 1.0, 700.0])
    many = vr.Prony.creep(((alpha - 1.0) / alpha)[:, None], np.ones((3, 1)), alpha=alpha)
    each = law_each.law_of_materials(many, np.arange(3))
    laws = law_table(3.0).record, law_each.law_of_alphas(alpha), each
    assert len({tuple(map(numba.typeof, law)) for law in laws}) == 1
    for n in (0, 1, 2, 0):
        for u in (0.0, 1e-3, 0.7, 30.0, 1e9):
            exact = functions(law_table(alpha[n]).record, 0, u)
            scale = exact[[0, 0, 2, 3, 3, 5, 6, 7]] / np.array([1.0, max(u, 1.0), 1.0, 1.0, max(u, 1.0), 1.0, 1.0, 1.0])
            for law in laws[1:]:
                assert close(functions(law, n, u), exact, rel=tol.EACH_SLOPE, scale=scale)


@numba.njit(error_model="numpy")
def functions(law, n, u):
    hold(law, n)
    at = read.place(u, law)
    L, dL, rise = read.speed_slopes(at, u, law)
    press, slope = read.press_slopes(at, u, law)
    scale = read.speed(at, u, law)[2]
    half_space, cylinder = read.bodies(at, u, law)
    return np.array([L, dL, rise, press, slope, read.share(at, u, law), half_space * scale, cylinder * scale])


# --- a material each ---


@pytest.mark.parametrize("name", MATERIALS)
def test_a_material_each_is_that_material_alone(name):
    many = MATERIALS[name]()
    draw = np.random.default_rng(6)
    V = 10.0 ** draw.uniform(-9.0, 18.0, (40, len(many))) / 2.91
    V[:2] = [[0.0], [1e200]]
    s = np.choose(draw.integers(2, size=V.shape), [10.0 ** draw.uniform(-12.0, 0.0, V.shape), draw.random(V.shape)])
    scene = vr.Scene(material=many, kappa=2.91, mu=0.2)
    delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    two = isinstance(many, vr.Bodies)
    moments = ("dM_dV", *SLOPES_OF_BODIES) if two else ("dM_dV",)
    fields = (*FIELDS, *SLOPES, *(PARTS + SLOPES_OF_BODIES if two else ()))
    found = vr.contact(scene, V, delta=delta, fields=fields)
    for n, one in enumerate(many):
        own = vr.Scene(material=one, kappa=2.91, mu=0.2)
        alone = vr.contact(own, V[:, n], delta=delta[:, n], fields=fields)
        slope = vr.contact(own, 0.0, delta=0.0, fields="dM_dV").dM_dV
        near = np.maximum(1.0 - s[:, n], tol.EACH_MATERIAL)  # delta_star has the condition of beta and of slopes of Q
        scales = dict.fromkeys(PARTS, abs(alone.M)) | dict.fromkeys(moments, slope)
        scales["dQ_dV"] = 0.2 / np.maximum(V[:, n], 1e-9 / 2.91)
        for field in fields:
            rel = tol.EACH_SLOPE if field in SLOPES + SLOPES_OF_BODIES else tol.EACH_MATERIAL
            rel = rel / near if field == "beta" or field.startswith("dQ") else rel
            pair = getattr(found, field)[:, n], getattr(alone, field)
            assert close(*pair, rel=rel, scale=scales.get(field, 0.0), what=(field, n))
