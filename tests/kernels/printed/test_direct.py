"""Method "direct" of contact(): as the table where ``validate`` compares them; its Bessel ratios,
limits and roots.
"""

import flint
import numpy as np
import tolerances as tol

import viscoroll as vr
from pipeline.evidence import truth
from pipeline.evidence.prove.states import points, ulps
from pipeline.validation import random_state_checks
from viscoroll.kernels.law.printed_law import (
    NOT_CONVERGED,
    direct_contact_length,
    ratio_i,
    ratio_k0k1,
)

KAPPA = 2.91
MU = 0.2
#: along three axes: alpha, kappa V, |delta|/delta_star
ALPHAS = np.array([1.0, 1.0 + 1e-10, 1.0 + 1e-6, 1.01, 1.5, 2.0, 11.0, 100.0, 1e3, 1e4])[
    :, None, None
]
KAPPA_VS = 10.0 ** np.arange(-8, 9)[:, None]
CREEPS = np.array([1e-9, 1e-6, 1e-3, 0.05, 0.3, 0.7, 0.95, 0.999, 1.0 - 1e-6, 1.0 - 1e-9])


def test_bessel_ratios():
    seams = [0.9999999999999999, 1.0, 24.999999999999996, 25.0]
    with flint.ctx.workprec(160):
        for ratio, exact in ((ratio_i, truth.ratio_r), (ratio_k0k1, truth.ratio_k)):
            for x in [*seams, *points(np.random.default_rng(20), 400)[-400:].tolist()]:
                assert ulps(ratio(x), exact(flint.arb(x))) <= tol.BESSEL_ULP, x


def test_as_the_table():
    assert [check for check in random_state_checks(2000, 3) if not check.passed] == []


def test_roots_are_found_far_around():
    """No iteration runs into its cap, which would be an error; one of NaN is reported."""
    scene = vr.Scene(ALPHAS, KAPPA, MU)
    star = vr.contact(scene, KAPPA_VS / KAPPA, delta=0.0, fields="delta_star").delta_star
    state = vr.contact(
        scene, KAPPA_VS / KAPPA, delta=CREEPS * star, fields=("lam", "beta"), method="direct"
    )
    assert np.all((state.beta > 0.0) & (state.beta < 1.0))
    assert direct_contact_length(np.nan, 11.0)[3] == NOT_CONVERGED
