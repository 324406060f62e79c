"""Motions in extended precision: the integrator, and the check motions made again by it."""

from __future__ import annotations

import math

import flint
import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from truth.test_driven import MOTIONS as DRIVEN
from truth.test_driven import inputs as driven_inputs
from truth.test_motions import check_motions, inputs

import viscoroll as vr
from pipeline.evidence.truth import roll_precise
from pipeline.evidence.truth.load import pieces_of
from pipeline.evidence.truth.motion import PATHS
from pipeline.evidence.truth.phase import Law
from pipeline.evidence.truth.precise import printed_state
from pipeline.evidence.truth.rest import begun
from pipeline.evidence.truth.solid import solid_of

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

OUTPUTS = ("V", "omega", "x", "angle")


# --- the integrator ---


def test_rates_are_those_of_the_printed_law():
    """Speeds along the rates of the unknowns: V' = Q - M/2, j omega' = -(Q + M/2), Q and M as printed."""
    scene = vr.Scene(11.0, 2.91, 0.2, gamma=1.0, j=0.5)
    for V, omega in ((0.7, 0.69), (-0.7, -0.71), (1e-5, 1e-5), (0.5, 0.8), (-0.9, 0.4)):
        with flint.ctx.workprec(200):
            kappa, mu, j, zero = map(flint.arb, (scene.kappa, scene.mu, scene.j, 0))
            (free,) = pieces_of({}, zero + 1, zero, zero + 1)
            phase = begun(Law(solid_of(scene), kappa, mu, j), free, flint.arb(V), flint.arb(omega))
            u, (rates, weights), h = phase.unknowns(), phase.rates(phase.unknowns(), zero), flint.arb(10) ** -20
            change = [rate / weight for rate, weight in zip(rates, weights, strict=True)]
            ends = [phase.contact([a + d * h * b for a, b in zip(u, change, strict=True)]) for d in (1, -1)]
            found = [(up - down) / (2 * h) for up, down in zip(ends[0][:2], ends[1][:2], strict=True)]
        with mp.workdps(60):
            creep = abs((mp.mpf(omega) - V) / mp.mpf(V))
            alpha, kappa, mu = map(mp.mpf, (scene.alpha, scene.kappa, scene.mu))
            state = printed_state(mp, alpha, kappa, mu, abs(mp.mpf(V)), creep)
            Q, M = state["Q"] * mp.sign(omega - V), state["M"] * mp.sign(V)
            for ours, printed in zip(found, (Q - M / 2, -(Q + M / 2) / mp.mpf(scene.j)), strict=True):
                assert abs(mp.mpf(ours.mid().str(50, radius=False)) / printed - 1) < tol.PRECISE_RATE, (V, omega)


# --- the check motions ---


@pytest.mark.parametrize("number", [0, 9, 10, 37])
def test_check_motions_are_found_again(number):
    """The same doubles as by an integrator in other unknowns, which made them: IC1, two of large alpha, one of 1."""
    rows = check_motions()[number]
    motion = roll_precise(*inputs(rows), nodes=18, tolerance=1e-19)
    for name in OUTPUTS:
        assert [float(value) for value in getattr(motion, name)] == [row[name] for row in rows]
    assert np.array_equal(float(motion.onset_time or math.nan), rows[0]["onset_time"], equal_nan=True)
    assert len(motion.switches) == rows[0]["switches"]


@pytest.mark.parametrize("name", ["pushed from rest", "slid off rest by a torque", "a jump there and back"])
def test_driven_ones_are_found_again(name):
    """The same doubles by fewer nodes and a larger tolerance."""
    row = next(row for row in DRIVEN if row["name"] == name)
    case, drive = driven_inputs(row)
    found = roll_precise(*case, **drive, nodes=18, tolerance=1e-19)
    for field in ("V", "omega", *PATHS):
        assert [float(value) for value in getattr(found, field)] == row[field], field
