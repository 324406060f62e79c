"""The contact law: enclosures, an alpha or a material each, closed forms, signs, V = 0, slopes,
fields.

Accuracy over the whole domain is claimed in ``test_claims.py``.
"""

import math
import weakref

import flint
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from many import MATERIALS, states
from scipy.optimize import brentq

import viscoroll as vr
from pipeline.evidence.truth import INPUTS, contact_enclosure, slopes
from viscoroll.contact_mechanics.contact_table import FIELDS, SLOPES, SLOPES_OF_BODIES
from viscoroll.laws import laws_per_element

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
KAPPA = SCENE.kappa
MU = SCENE.mu
PARTS = ("M_half_space", "M_cylinder")


def delta_star(scene, V):
    return scene.contact(V, delta=0.0).delta_star


ALPHA, KAPPAS, MUS, V, S = states(60, 1)
EACH = vr.Scene(ALPHA, KAPPAS, MUS)
one_and_each = pytest.mark.parametrize("scene", [SCENE, EACH])


# --- an alpha each, a material each ---


@pytest.mark.parametrize("octave", range(-4, 5))
def test_small_creep_between_two_rows(octave):
    """Q against enclosures where mu V/(delta_star - delta), the argument of H/F^2, passes 2^n
    between delta = 0 and 0.03 delta_star: its mean slope is then put together from those in two
    rows.
    """
    s = 0.03
    V = brentq(lambda V: MU * V / delta_star(SCENE, V) - (1.0 - 0.5 * s) * 2.0**octave, 1e-6, 1e3)
    delta = s * delta_star(SCENE, V)
    with flint.ctx.workprec(200):
        exact = contact_enclosure(SCENE.alpha, KAPPA, MU, V, delta)
    assert close(SCENE.contact(V, delta=delta).Q, float(exact["Q"]), tol.BETWEEN_ROWS)


@pytest.mark.parametrize("name", MATERIALS)
def test_a_material_each_is_that_material_alone(name):
    many = MATERIALS[name]()
    draw = np.random.default_rng(6)
    V = 10.0 ** draw.uniform(-9.0, 18.0, (40, len(many))) / KAPPA
    V[:2] = [[0.0], [1e200]]
    s = np.choose(
        draw.integers(2, size=V.shape),
        [10.0 ** draw.uniform(-12.0, 0.0, V.shape), draw.random(V.shape)],
    )
    scene = vr.Scene(material=many, kappa=KAPPA, mu=MU)
    delta = s * delta_star(scene, V)
    fields = FIELDS + SLOPES + (PARTS + SLOPES_OF_BODIES) * isinstance(many, vr.Bodies)
    found = scene.contact(V, delta=delta, fields=fields)
    for n, one in enumerate(many):
        own = scene.replace(material=one)
        alone = own.contact(V[:, n], delta=delta[:, n], fields=fields)
        slope = own.contact(0.0, delta=0.0, fields="dM_dV").dM_dV
        near = np.maximum(
            1.0 - s[:, n], tol.EACH_MATERIAL
        )  # delta_star has the condition of beta and of slopes of Q
        scales = dict.fromkeys(PARTS, abs(alone.M)) | dict.fromkeys(
            ("dM_dV", *SLOPES_OF_BODIES), slope
        )
        scales["dQ_dV"] = MU / np.maximum(V[:, n], 1e-9 / KAPPA)
        for field in fields:
            rel = tol.EACH_SLOPE if field in SLOPES + SLOPES_OF_BODIES else tol.EACH_MATERIAL
            rel = rel / near if field == "beta" or field.startswith("dQ") else rel
            pair = found[field][:, n], alone[field]
            assert close(*pair, rel, scale=scales.get(field, 0.0), what=(field, n))


def test_a_law_keeps_alive_what_its_kernels_have_the_addresses_of():
    alpha = np.array([3.0, 200.0])
    held = weakref.ref(alpha)
    law = laws_per_element.record_of_alphas(alpha)
    del alpha
    assert held() is not None
    del law
    assert held() is None


# --- closed forms, edges ---


def test_carter():
    """Sect. 3.4, alpha = 1: closed forms, with neither a Bessel function nor V; the same bits among
    other alphas.
    """
    scene = vr.Scene(1.0, KAPPA, MU)
    star = MU / (2.0 * KAPPA)
    delta = np.concatenate([S, -S]) * star
    V_twice = np.tile(V, 2)
    asked = {"delta": delta, "fields": (*FIELDS, *SLOPES, "grip")}
    state = scene.contact(V_twice, **asked)
    for name, exact in (("lam", 1.0), ("epsilon", 0.0), ("M", 0.0), ("delta_star", star)):
        assert (state[name] == exact).all(), name
    assert close(state.beta, 1.0 - abs(delta) / star, tol.CARTER, scale=1.0)
    assert close(state.Q, 4 * KAPPA * delta * (1 - abs(delta) * KAPPA / MU), tol.CARTER)
    assert close(state.grip, (1.0 - abs(delta) / star) ** 2, tol.CARTER, scale=1.0)
    among = scene.replace(alpha=np.ones(120)).contact(V_twice, **asked)
    assert all(np.array_equal(value, state[name]) for name, value in among.as_dict().items())


def test_a_stick_zone_that_rounds_to_nothing():
    """One rounding below delta_star, where L - D may round to 0: slip is not full, and there is no
    beta below 0.
    """
    draw = np.random.default_rng(6)
    mu = 10.0 ** draw.uniform(-2, 5, 300)
    V = 10.0 ** draw.uniform(-22, 22, 300)
    for alpha in (117726.85190886419, 1.0 + 10.0 ** draw.uniform(-8, 6, 300)):
        scene = vr.Scene(alpha, 10.0 ** draw.uniform(-2, 6, 300), mu)
        state = scene.contact(V, delta=np.nextafter(delta_star(scene, V), 0.0))
        assert not state.full_slip.any()
        assert ((state.beta >= 0.0) & (state.beta < tol.CONTACT)).all()
        assert close(state.Q, mu, tol.CONTACT)


# --- signs and V = 0 ---


@one_and_each
def test_all_four_signs_of_V_and_delta(scene):
    """Eqs. (17), (18), to the bit: V alone carries M, omega - V carries Q; slopes by V and omega
    are even, but for the sign of Q at one V."""
    delta = 1.5 * S * delta_star(scene, V)
    base = scene.contact(V, delta=delta, slopes=True)
    assert (base.Q > 0.0).all()
    assert np.array_equal(base.M > 0.0, np.broadcast_to(np.asarray(scene.alpha) > 1.0, V.shape))
    for sign_V in (1.0, -1.0):
        for sign_delta in (1.0, -1.0):
            state = scene.contact(sign_V * V, delta=sign_delta * delta, slopes=True)
            signs = {
                "delta": sign_delta,
                "Q": sign_V * sign_delta,
                "M": sign_V,
                "dQ_dV": sign_delta,
                "dQ_ddelta": sign_V,
            }
            for name, values in state.as_dict().items():
                assert np.array_equal(values, signs.get(name, 1.0) * base[name]), name


@one_and_each
def test_delta_and_omega_are_the_same_question(scene):
    """The slope by V is another: at the same omega the creep changes too."""
    delta = 0.9 * delta_star(scene, V)
    omega = V * (1.0 + delta)
    delta = (omega - V) / V
    by_delta, by_omega = (
        scene.contact(V, **given, slopes=True) for given in ({"delta": delta}, {"omega": omega})
    )
    for name in ("delta", "Q", "M", "beta", "dQ_domega"):
        assert close(by_omega[name], by_delta[name], 1e-12, what=name)
    whole = by_delta.dQ_dV - (1.0 + delta) / V * by_delta.dQ_ddelta
    assert close(by_omega.dQ_dV, whole, 1e-12, scale=scene.mu / V)


@pytest.mark.parametrize("method", ["table", "direct"])
@pytest.mark.parametrize("alpha", [1.0, 11.0, [2.0, 11.0]])
def test_at_rest(alpha, method):
    """V = 0: no division by V; lam = 1, M = 0; given delta, the limit V -> 0+."""
    scene = vr.Scene(alpha, KAPPA, MU)
    star = MU / (2.0 * KAPPA)
    for given, Q, delta, beta in (
        ({"omega": 0.0}, 0.0, 0.0, 1.0),
        ({"omega": 1e-300}, MU, math.inf, 0.0),
        ({"omega": -2.0}, -MU, -math.inf, 0.0),
        ({"delta": -2.0 * star}, -MU, -2.0 * star, 0.0),
    ):
        expected = {
            "lam": 1.0,
            "zeta": math.inf,
            "epsilon": 0.0,
            "delta_star": star,
            "delta": delta,
            "full_slip": beta == 0.0,
            "beta": beta,
            "Q": Q,
            "M": 0.0,
        }
        state = scene.contact(0.0, **given, method=method)
        assert all(np.all(state[name] == value) for name, value in expected.items()), given
    limit = scene.contact(0.0, delta=np.full(2, 0.25 * star), method=method)
    assert close(limit.beta, 0.75, tol.SPEED_LIMIT)
    assert close(limit.Q, MU * (1.0 - 0.75**2), tol.SPEED_LIMIT)


# --- slopes ---


def test_slope_by_V_at_slight_creep():
    """dQ_dV at fixed delta relative to itself."""
    for s in (1e-5, 1e-7):
        delta = s * delta_star(SCENE, 0.3)
        slope = SCENE.contact(0.3, delta=delta, fields="dQ_dV").dQ_dV
        given = map(float, (SCENE.alpha, KAPPA, MU, 0.3, delta))
        exact = slopes(dict(zip(INPUTS, map(flint.arb, given))))["dQ_dV"]
        assert close(slope, float(exact), tol.SLOPE_SLIGHT, what=s)


# --- the interface ---


def test_a_field_that_was_not_computed_is_told():
    with pytest.raises(AttributeError, match="'beta' is not in this result: it contains Q, M"):
        _ = SCENE.contact(1.0, delta=0.01, fields=("Q", "M")).beta
