"""Eq. (6) at speeds where lam is its least, alpha^(-1/2), to rounding."""

from __future__ import annotations

import numpy as np
import tolerances as tol

import viscoroll as vr
from viscoroll.kernels.law.length import contact_length
from viscoroll.kernels.material.functions import generators
from viscoroll.materials.tables import record


def test_length_at_high_speed():
    """lam^2 (1 + 2 h/zeta) = 1; a guess above the least that rounding puts the next step below has to arrive."""
    rng = np.random.default_rng(0)
    for _ in range(40):
        modes = int(rng.integers(2, 6))
        series, _ = vr.Prony(10.0 ** rng.uniform(-3, 4, modes), 10.0 ** rng.uniform(-8, 8, modes)).in_own_time()
        material = record(series)
        for kappa_V in 10.0 ** rng.uniform(6, 12, 60) / series.tau[-1]:
            lam, status = contact_length(kappa_V, material)
            zeta = 0.5 * lam / kappa_V
            assert status == 0
            assert abs(lam * np.sqrt(1.0 + 2.0 * generators(zeta, material)[1] / zeta) - 1.0) < tol.CONTACT
