"""The Bessel ratios r, k, i2 and their complements against enclosures; the table against a refit of
it.

Slopes, and points over all doubles, are claims of ``test_claims.py``.
"""

import flint
import numpy as np
import tolerances as tol

from pipeline.evidence import truth
from pipeline.evidence.prove.states import points, ulps
from pipeline.evidence.truth import ratio_table
from viscoroll.kernels.law import bessel_ratios
from viscoroll.kernels.law.bessel_ratios import TABLE, ratio_i2, ratio_k, ratio_r


def test_within_two_ulp_of_enclosures():
    """At every power of two in reach of a table or a series, in the middle between, at their
    neighbours; and scattered over all doubles.
    """
    for x in points(np.random.default_rng(7), 4000)[::8].tolist():
        r, r_complement = ratio_r(x)
        k, k_complement = ratio_k(x)
        with flint.ctx.workprec(1200 if x > 1e20 else 160):
            exact_r, exact_k, exact_i2 = (
                of(flint.arb(x)) for of in (truth.ratio_r, truth.ratio_k, truth.ratio_i2)
            )
            for value, exact in ((r, exact_r), (k, exact_k), (ratio_i2(x, r), exact_i2)):
                assert ulps(value, exact) <= tol.RATIO_ULP, (x, value)
            for value, exact in ((r_complement, 1 - exact_r), (k_complement, 1 - exact_k)):
                assert ulps(value, exact) <= tol.RATIO_COMPLEMENT_ULP, (x, value)


# --- the table ---


def test_every_coefficient_is_the_rounded_fit():
    """All of them, bit for bit: a change of one, however small and of whatever order, shows."""
    assert TABLE.shape == (bessel_ratios.segment_start(len(bessel_ratios.SEGMENTS)),)
    assert np.array_equal(TABLE, ratio_table())
