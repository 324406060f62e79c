"""The paper's equations as printed, method "direct" of contact(), and the Bessel ratios by textbook series."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import precise
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.kernels.printed.bessel import ratio_i, ratio_k0k1
from viscoroll.kernels.printed.law import NOT_CONVERGED, direct_contact_length

KAPPA, MU = 2.91, 0.2
#: along three axes: alpha, kappa V, |delta|/delta_star
ALPHAS = np.array([1.0, 1.0 + 1e-10, 1.0 + 1e-6, 1.01, 1.5, 2.0, 11.0, 100.0, 1e3, 1e4])[:, None, None]
KAPPA_VS = 10.0 ** np.arange(-3, 3.01, 0.5)[:, None]
CREEPS = np.array([1e-6, 1e-3, 0.05, 0.3, 0.7, 0.95, 0.999, 1.0 - 1e-6])

ENDS = [5e-324, 1e-320, 1e-308, 1e-300, 1e9, 1e300, 1.7976931348623157e308]
SEAMS = [0.9999999999999999, 1.0, 24.999999999999996, 25.0]


def samples() -> list[float]:
    rng = np.random.default_rng(20)
    common = [*(10 ** rng.uniform(-8, 6, 150)), *rng.uniform(0, 1.2, 150), *rng.uniform(1, 30, 150)]
    return [*ENDS, *SEAMS, *common, *(10 ** rng.uniform(-320, 300, 50))]


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


def test_bessel_ratios_against_40_digits():
    with mp.workdps(40):
        for ratio, exact in ((ratio_i, exact_i), (ratio_k0k1, exact_k)):
            for x in map(float, samples()):
                assert precise.ulps(ratio(x), exact(x)) <= tol.BESSEL_ULP, x


def assert_methods_agree(alpha, kappa, mu, kappa_V, s) -> None:
    """Method "direct" against "table"; absolute where the printed forms cancel."""
    scene, V = vr.Scene(alpha, kappa, mu), kappa_V / kappa
    delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    table, direct = (vr.contact(scene, V, delta=delta, method=method) for method in ("table", "direct"))
    for name, scale, bound in (
        ("lam", table.lam, tol.CONTACT_LENGTH),
        ("zeta", table.zeta, tol.CONTACT_LENGTH),
        ("delta_star", table.delta_star, tol.DIRECT_LENGTH),
        ("epsilon", np.maximum(1.0, table.epsilon), tol.CONTACT_SHIFT),
        ("beta", 1.0, tol.DIRECT_STICK),
        ("Q", mu, tol.DIRECT_TRACTION),
        ("M", 1.0 / kappa, tol.DIRECT_MOMENT),
    ):
        off = abs(getattr(table, name) - getattr(direct, name)) / scale
        assert off.max() <= bound, (name, np.unravel_index(off.argmax(), off.shape))


def test_against_the_law_by_tables():
    assert_methods_agree(ALPHAS, KAPPA, MU, KAPPA_VS, CREEPS)
    rng = np.random.default_rng(6)
    alpha, kappa, mu, kappa_V = 10.0 ** rng.uniform([[0], [-0.3], [-2], [-3]], [[4], [2.3], [0.5], [3]], (4, 120))
    alpha[::4] = 1.0 + 10.0 ** rng.uniform(-12, 0, 30)
    graded = np.where(rng.random(120) < 0.5, 10.0 ** rng.uniform(-8, 0, 120), 1.0 - 10.0 ** rng.uniform(-6, 0, 120))
    assert_methods_agree(alpha, kappa, mu, kappa_V, graded)


def test_carter():
    """alpha = 1 by the printed equations, which do not know of it."""
    star, s = MU / (2 * KAPPA), np.array([0.0, *CREEPS])
    state = vr.contact(vr.Scene(1.0, KAPPA, MU), KAPPA_VS / KAPPA, delta=s * star, method="direct")
    assert np.all(state.lam == 1.0)
    assert not np.any([state.epsilon, state.M])
    assert close(state.delta_star, star, rel=1e-15)
    assert close(state.beta, np.broadcast_to(1.0 - s, state.beta.shape), rel=tol.DIRECT_CARTER, scale=1.0)
    Q = 4 * KAPPA * s * star * (1 - s * star * KAPPA / MU)
    assert close(state.Q, np.broadcast_to(Q, state.Q.shape), rel=tol.DIRECT_CARTER, scale=MU)


def test_extreme_speeds():
    slow, fast, alpha = np.array([5e-324, 1e-300, 1e-12]), np.array([1e12, 1e300]), np.array([1.0, 11.0, 1e4])[:, None]
    for kappa_V, limit in ((slow, np.ones_like(alpha)), (fast, alpha**-0.5)):
        state = vr.contact(vr.Scene(alpha, 1.0, MU), kappa_V, delta=0.0, fields=("lam", "epsilon"), method="direct")
        assert close(state.lam, np.broadcast_to(limit, state.lam.shape), rel=tol.DIRECT_EXTREME)
        assert np.all(abs(state.epsilon) < tol.DIRECT_EXTREME)


def test_roots_are_found_far_around():
    """No iteration runs into its cap, which would be an error."""
    kappa_V, s = 10.0 ** np.arange(-8, 9)[:, None], np.array([1e-9, *CREEPS, 1.0 - 1e-9])
    scene = vr.Scene(ALPHAS, KAPPA, MU)
    star = vr.contact(scene, kappa_V / KAPPA, delta=0.0, fields="delta_star").delta_star
    state = vr.contact(scene, kappa_V / KAPPA, delta=s * star, fields=("lam", "beta"), method="direct")
    assert np.all((state.beta > 0.0) & (state.beta < 1.0))


def test_nan_is_reported_not_iterated():
    assert direct_contact_length(np.nan, 11.0)[3] == NOT_CONVERGED
