"""The paper's equations as printed (direct.py) and their Bessel ratios (bessel.py)."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol

from viscoroll.kernels.bessel.ratios import ratio_k, ratio_r
from viscoroll.kernels.law.length import contact_length
from viscoroll.kernels.law.material import Material, generators, moment_factor
from viscoroll.kernels.law.stick import stick_length
from viscoroll.kernels.printed import law as direct
from viscoroll.kernels.printed.bessel import ratio_i, ratio_k0k1

KAPPA, MU = 2.91, 0.2
ALPHAS = (1.0, 1.0 + 1e-10, 1.0 + 1e-6, 1.01, 1.5, 2.0, 11.0, 100.0, 1e3, 1e4)
KAPPA_VS = tuple(10.0 ** np.arange(-3, 3.01, 0.5))
CREEPS = (1e-6, 1e-3, 0.05, 0.3, 0.7, 0.95, 0.999, 1.0 - 1e-6)

TINY = [5e-324, 1e-320, 1e-308, 1e-300]
SEAMS = [0.9999999999999999, 1.0, 24.999999999999996, 25.0]
HUGE = [1e9, 1e300, 1.7976931348623157e308]


def samples() -> list[float]:
    rng = np.random.default_rng(20)
    return [
        *TINY,
        *SEAMS,
        *HUGE,
        *(10 ** rng.uniform(-8, 6, 150)),
        *rng.uniform(0, 1.2, 150),
        *rng.uniform(1, 30, 150),
        *(10 ** rng.uniform(-320, 300, 50)),
    ]


def hankel_ratio(x: float, sign: int) -> mp.mpf:
    """I1/I0 (sign -1) or K0/K1 (+1) of a large argument; mpmath's own functions would need exp(x)."""

    def expansion(order: int) -> mp.mpf:
        total = term = mp.mpf(1)
        for n in range(1, 25):
            term *= sign * (4 * order**2 - (2 * n - 1) ** 2) / (8 * n * mp.mpf(x))
            total += term
        return total

    return expansion(1) / expansion(0) if sign < 0 else expansion(0) / expansion(1)


def exact_i(x: float) -> mp.mpf:
    return hankel_ratio(x, -1) if x > 1e5 else mp.besseli(1, x) / mp.besseli(0, x)


def exact_k(x: float) -> mp.mpf:
    return hankel_ratio(x, +1) if x > 1e5 else mp.besselk(0, x) / mp.besselk(1, x)


@pytest.mark.parametrize(("ratio", "exact"), [(ratio_i, exact_i), (ratio_k0k1, exact_k)])
def test_bessel_ratios_against_40_digits(ratio, exact):
    with mp.workdps(40):
        for x in map(float, samples()):
            value = exact(x)
            ulps = abs(mp.mpf(ratio(x)) - value) / mp.mpf(float(np.spacing(float(value))))
            assert ulps <= tol.BESSEL_ULP, (x, float(ulps))


def test_bessel_ratios_at_the_ends():
    assert ratio_i(0.0) == 0.0
    assert ratio_k0k1(0.0) == 0.0
    assert ratio_i(np.inf) == 1.0
    assert ratio_k0k1(np.inf) == 1.0


def test_textbook_and_tabulated_ratios_agree():
    for x in map(float, samples()):
        assert abs(ratio_i(x) - ratio_r(x)[0]) <= 6 * np.spacing(ratio_r(x)[0])
        assert abs(ratio_k0k1(x) - ratio_k(x)[0]) <= 6 * np.spacing(ratio_k(x)[0])


@pytest.mark.parametrize("alpha", ALPHAS)
def test_contact_length_shift_and_moment_against_the_explicit_law(alpha):
    material = Material(alpha, (alpha - 1.0) / alpha)
    for kappa_V in KAPPA_VS:
        lam, zeta, epsilon, status = direct.direct_contact_length(kappa_V, alpha)
        lam_0, status_0 = contact_length(kappa_V, material)
        assert status == status_0 == direct.OK
        zeta_0 = lam_0 / (2.0 * kappa_V)
        epsilon_0 = generators(zeta_0, material)[0] / zeta_0
        assert lam == pytest.approx(lam_0, rel=tol.DIRECT_LENGTH, abs=0.0)
        assert zeta == pytest.approx(zeta_0, rel=tol.DIRECT_LENGTH, abs=0.0)
        assert abs(epsilon - epsilon_0) <= tol.DIRECT_SHIFT * max(1.0, epsilon_0)
        moment = direct.direct_moment(KAPPA, lam, epsilon, zeta, alpha)
        moment_0 = kappa_V / KAPPA * moment_factor(zeta_0, lam_0, material)
        assert abs(moment - moment_0) * KAPPA <= tol.DIRECT_MOMENT


@pytest.mark.parametrize("alpha", ALPHAS)
def test_stick_and_traction_against_the_explicit_law(alpha):
    material = Material(alpha, (alpha - 1.0) / alpha)
    for kappa_V in KAPPA_VS:
        lam, zeta, epsilon, _ = direct.direct_contact_length(kappa_V, alpha)
        lam_0, _ = contact_length(kappa_V, material)
        zeta_0 = lam_0 / (2.0 * kappa_V)
        F = zeta_0 + generators(zeta_0, material)[0]
        delta_star = MU * kappa_V / KAPPA * F
        assert direct.direct_delta_star(KAPPA, MU, lam, epsilon) == pytest.approx(
            delta_star, rel=tol.DIRECT_LENGTH, abs=0.0
        )
        for s in CREEPS:
            eta, D, status_0 = stick_length(zeta_0, s * F, material)
            beta, status = direct.direct_stick(s * delta_star, KAPPA, MU, lam, epsilon, zeta, alpha)
            assert status == status_0 == direct.OK
            assert abs(beta - eta / zeta_0) <= tol.DIRECT_STICK
            Q = direct.direct_traction(beta, s * delta_star, KAPPA, MU, lam, epsilon, zeta)
            # 1 - H(eta)/H(zeta) in mpmath: independent of how the explicit law forms the difference
            with mp.workdps(40):
                h, h_eta = (mp.mpf(generators(z, material)[1]) for z in (zeta_0, eta))
                fall = (mp.mpf(zeta_0) + eta) * D + 2 * (zeta_0 * h - eta * h_eta)
                share = float(fall / (mp.mpf(zeta_0) ** 2 + 2 * zeta_0 * h))
            assert abs(Q / MU - share) <= tol.DIRECT_TRACTION


@pytest.mark.parametrize("kappa_V", KAPPA_VS)
def test_carter(kappa_V):
    lam, zeta, epsilon, status = direct.direct_contact_length(kappa_V, 1.0)
    assert (lam, epsilon, status) == (1.0, 0.0, direct.OK)
    assert direct.direct_moment(KAPPA, lam, epsilon, zeta, 1.0) == 0.0
    delta_star = direct.direct_delta_star(KAPPA, MU, lam, epsilon)
    assert delta_star == pytest.approx(MU / (2 * KAPPA), rel=1e-15)
    for s in (0.0, *CREEPS):
        beta, status = direct.direct_stick(s * delta_star, KAPPA, MU, lam, epsilon, zeta, 1.0)
        assert status == direct.OK
        assert abs(beta - (1.0 - s)) <= tol.DIRECT_CARTER
        Q = direct.direct_traction(beta, s * delta_star, KAPPA, MU, lam, epsilon, zeta)
        assert abs(Q - 4 * KAPPA * s * delta_star * (1 - s * delta_star * KAPPA / MU)) <= tol.DIRECT_CARTER * MU


def test_no_creep_sticks_throughout_and_no_stick_gives_mu():
    for alpha in ALPHAS:
        lam, zeta, epsilon, _ = direct.direct_contact_length(0.5, alpha)
        beta, status = direct.direct_stick(0.0, KAPPA, MU, lam, epsilon, zeta, alpha)
        assert status == direct.OK
        assert 1.0 - tol.DIRECT_STICK <= beta <= 1.0
        assert direct.direct_traction(0.0, 1e-3, KAPPA, MU, lam, epsilon, zeta) == MU


@pytest.mark.parametrize("kappa_V", [5e-324, 1e-300, 1e-12, 1e12, 1e300])
@pytest.mark.parametrize("alpha", [1.0, 11.0, 1e4])
def test_extreme_speeds(kappa_V, alpha):
    lam, _, epsilon, status = direct.direct_contact_length(kappa_V, alpha)
    assert status == direct.OK
    assert lam == pytest.approx(1.0 if kappa_V < 1.0 else alpha**-0.5, rel=tol.DIRECT_EXTREME)
    assert abs(epsilon) < tol.DIRECT_EXTREME


def test_nan_is_reported_not_iterated():
    assert direct.direct_contact_length(np.nan, 11.0)[3] == direct.NOT_CONVERGED
    assert direct.direct_stick(1e-3, KAPPA, MU, 0.5, np.nan, 1.0, 11.0)[1] == direct.NOT_CONVERGED


def _contact_root(kappa_V: float, alpha: float):
    python = getattr(direct.brent, "py_func", direct.brent)
    return python(6, (kappa_V, alpha, 0.0, 0.0), alpha**-0.5, 1.0, 0.0)


def _stick_root(kappa_V: float, alpha: float, s: float):
    python = getattr(direct.brent, "py_func", direct.brent)
    _, zeta, epsilon, _ = direct.direct_contact_length(kappa_V, alpha)
    front = 1.0 + epsilon
    return python(10, (front, s * front, zeta, alpha), 0.0, 1.0, 0.5 * direct._EPS)


def test_the_iteration_cap_is_reported(monkeypatch):
    monkeypatch.setattr(direct, "_MAX_BRENT", 3)
    assert _contact_root(0.5, 11.0)[1] == direct.NOT_CONVERGED


def test_the_iteration_cap_is_far_away(monkeypatch):
    monkeypatch.setattr(direct, "_MAX_BRENT", direct._MAX_BRENT // 3)
    for alpha in (1.0 + 1e-10, 1.5, 11.0, 1e4):
        for kappa_V in 10.0 ** np.arange(-8, 9):
            assert _contact_root(float(kappa_V), alpha)[1] == direct.OK
            for s in (*CREEPS, 1e-9, 1.0 - 1e-9):
                assert _stick_root(float(kappa_V), alpha, s)[1] == direct.OK
