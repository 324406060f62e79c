"""Method "direct" of contact(): as the table where ``validate`` compares them; its Bessel ratios,
limits and roots.
"""

import flint
import numpy as np
import tolerances as tol

from pipeline.evidence import truth
from pipeline.evidence.prove.states import points, ulps
from pipeline.validation import random_state_checks
from viscoroll.kernels.law.printed_law import (
    NOT_CONVERGED,
    direct_contact_length,
    ratio_i,
    ratio_k0k1,
)


def test_bessel_ratios():
    seams = [0.9999999999999999, 1.0, 24.999999999999996, 25.0]
    with flint.ctx.workprec(160):
        for ratio, exact in ((ratio_i, truth.ratio_r), (ratio_k0k1, truth.ratio_k)):
            for x in [*seams, *points(np.random.default_rng(20), 400)[-400:].tolist()]:
                assert ulps(ratio(x), exact(flint.arb(x))) <= tol.BESSEL_ULP, x


def test_as_the_table():
    assert [check for check in random_state_checks(1000, 3) if not check.passed] == []


def test_no_number_is_reported():
    """No iteration of the states above runs into its cap, which would be an error."""
    assert direct_contact_length(np.nan, 11.0)[3] == NOT_CONVERGED
