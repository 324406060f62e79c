"""Two bodies that deform unlike each other: what either takes of m, by the modes, and its limits."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.materials.law_table import by_modes

SOFT, STIFF = vr.Prony([2.0, 5.0], [1.0, 1e-3]), vr.Prony([4.0, 1.0, 0.3], [0.2, 2e-4, 1e-7])
UNLIKE = vr.Bodies(SOFT, STIFF, 0.3)
PLACES = np.concatenate([np.geomspace(1e-18, 1e12, 200), [1e-150, 1e-100, 1e-30, 1e30, 1e100, 1e150]])
HALF_SPACE, CYLINDER = 2, 3


def random_bodies(seed: int) -> vr.Bodies:
    draw = np.random.default_rng(seed)
    one, other = (
        vr.Prony(10.0 ** draw.uniform(-2.0, 2.0, n), 10.0 ** draw.uniform(-8.0, 0.0, n)) for n in draw.integers(1, 9, 2)
    )
    return vr.Bodies(one, other, draw.uniform(0.0, 1.0))


@pytest.mark.parametrize("seed", range(4))
def test_both_take_all_of_m(seed):
    """g and h are those of the sum."""
    bodies = random_bodies(seed)
    pair, whole = by_modes(bodies, PLACES), by_modes(bodies.total, PLACES)
    assert np.array_equal(pair[:2], whole[:2])
    assert close(pair[2] + pair[3], 2.0 * whole[2], rel=tol.SHARES)


def test_swapped_bodies_swap():
    here, there = by_modes(UNLIKE, PLACES), by_modes(vr.Bodies(STIFF, SOFT, 0.7), PLACES)
    assert close(here, there[[0, 1, CYLINDER, HALF_SPACE]], rel=tol.BODIES)


def test_a_rigid_body_takes_nothing():
    rubber, rigid = SOFT, vr.Prony.elastic()
    m = 2.0 * by_modes(rubber, PLACES)[HALF_SPACE]
    cases = (vr.Bodies(rubber, rigid, 1.0), CYLINDER, HALF_SPACE), (vr.Bodies(rigid, rubber, 0.0), HALF_SPACE, CYLINDER)
    for bodies, yielding, other in cases:
        found = by_modes(bodies, PLACES)
        assert close(found[yielding], m, rel=tol.BODIES)
        assert np.array_equal(found[other], np.zeros(PLACES.size))


def test_limits_of_the_shares():
    """Slow: sum J_j T_j of the body; fast: (alpha z^2/2) sum J_j b_j [ln(2/(b_j z)) - gamma + 1/4] over its modes."""
    phi = 1.0 - UNLIKE.share
    z = 1e-20
    slow, fast = by_modes(UNLIKE, np.array([1e100, z])).T
    assert close(slow[2:], [phi * STIFF.T_mean, UNLIKE.share * SOFT.T_mean], rel=tol.SHARES)
    for found, body, weight in ((fast[HALF_SPACE], STIFF, phi), (fast[CYLINDER], SOFT, UNLIKE.share)):
        sum_of = (body.J / body.T * (np.log(2.0 * body.T / z) - np.euler_gamma + 0.25)).sum()
        assert close(found, 0.5 * UNLIKE.alpha * z * z * weight * sum_of, rel=tol.SHARES)
