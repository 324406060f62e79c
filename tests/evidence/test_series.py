"""References of materials of many times: matching conditions from either form, and Chebyshev polynomials."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from pipeline.evidence.prove.series import of_z
from pipeline.evidence.truth import series as raw
from pipeline.evidence.truth import spectral

TWO = vr.Prony([2.0, 6.0], [1.0, 1e-2])
#: close times, where elimination with pivots loses ten digits
CLOSE = vr.Prony(E=[46.453746089844394, 12.654763734957816], tau=[0.023031229542030594, 0.021604563834440614])


def test_rates_from_either_form():
    with mp.workdps(40):
        one = raw.rates(mp, TWO.E.tolist(), TWO.tau.tolist())
        other = raw.rates_of_creep(mp, TWO.J.tolist(), TWO.T.tolist(), TWO.alpha)
        for name in ("a", "b"):
            for x, y in zip(getattr(one, name), getattr(other, name), strict=True):
                assert abs(x / y - 1) <= tol.SERIES_FORMS


@pytest.mark.parametrize(("p", "z"), [(TWO, 0.003), (TWO, 0.7), (CLOSE, 0.02), (CLOSE, 6.421246641356969)])
def test_chebyshev_against_the_conditions_and_the_kernels(p, z):
    found = spectral.contact(p, z, 220)
    with mp.workdps(60):
        rates = raw.rates(mp, p.E.tolist(), p.tau.tolist())
        truth = raw.functions(mp, rates, z)
        shares = [float(share) for share in raw.shares(mp, rates, z, truth)]
    assert close(found[:3], [float(value) for value in truth[:3]], rel=tol.CHEBYSHEV)
    assert close(found.shares, shares, rel=tol.CHEBYSHEV)
    assert close(sum(shares), float(truth.m), rel=tol.SERIES_FORMS)
    for j in range(p.T.size):
        _, _, part, rest = of_z(p, z, np.eye(p.T.size)[j])
        assert close(part, shares[j], rel=tol.SERIES_FUNCTIONS)
        assert close(part + rest, float(truth.m), rel=tol.SERIES_FORMS)


def test_too_few_terms_show():
    """The layer at the front edge wants 6.5 sqrt(a z) terms."""
    few, enough = (spectral.contact(CLOSE, 6.4, terms).g for terms in (40, 220))
    assert abs(few / enough - 1.0) > 1e-6
