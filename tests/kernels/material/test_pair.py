"""Two bodies that deform unlike each other: what either takes of m, by table, by its modes, and at the ends."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.kernels.material import series as kernels
from viscoroll.kernels.material.functions import at_contact, at_rolling, generator_slopes
from viscoroll.kernels.material.pair import Pair
from viscoroll.kernels.material.standard import standard
from viscoroll.kernels.material.tabulated import tabulated
from viscoroll.materials.tables import record, series

SOFT, STIFF = vr.Prony([2.0, 5.0], [1.0, 1e-3]), vr.Prony([4.0, 1.0, 0.3], [0.2, 2e-4, 1e-7])
UNLIKE = vr.Bodies(SOFT, STIFF, 0.3)
#: past the table at either side, and as far as motions go
PLACES = [*np.geomspace(1e-18, 1e12, 200).tolist(), 1e-150, 1e-100, 1e-30, 1e30, 1e100, 1e150]


def random_bodies(seed: int) -> vr.Bodies:
    draw = np.random.default_rng(seed)
    one, other = (
        vr.Prony(10.0 ** draw.uniform(-2.0, 2.0, n), 10.0 ** draw.uniform(-8.0, 0.0, n)) for n in draw.integers(1, 9, 2)
    )
    return vr.Bodies(one, other, draw.uniform(0.0, 1.0))


def assert_generators(found: tuple[float, ...], exact: tuple[float, ...], z: float) -> None:
    """g, h and their slopes, the latter on the scale of those of F and H."""
    (g, h, dg, dh), (exact_g, exact_h, exact_dg, exact_dh) = found, exact
    assert close((g, h), (exact_g, exact_h), rel=tol.SHARES)
    assert abs(dg - exact_dg) <= tol.TABLE_SLOPE * (1.0 + exact_dg)
    assert abs(dh - exact_dh) <= tol.TABLE_SLOPE * (1.0 + exact_h / z + exact_dh)


def rolling(bodies: vr.Bodies, places: list[float]) -> np.ndarray:
    """``at_rolling``, a row a function."""
    pair = record(bodies)
    return np.array([at_rolling(z, pair) for z in places]).T


@pytest.mark.parametrize("seed", range(4))
def test_the_table_is_the_sum_over_the_modes(seed):
    """Beyond its ends too; both bodies together take all of m, and g and h are those of the sum."""
    bodies = random_bodies(seed)
    pair, whole = record(bodies), record(bodies.total)
    known = kernels.Parts(*series(bodies.total), bodies.half_space_weights)
    room = kernels.room(known)
    for z in PLACES:
        g, h, dg, dh, half_space, cylinder = at_rolling(z, pair)
        kernels.values((z, z, z, z), False, known, room)
        kernels.shares((z, z, z, z), known, room)
        exact = room.found[kernels.AT_HALF_SPACE : kernels.AT_ZEROS : kernels.LANES]
        m = at_contact(z, whole)[4]
        assert abs(half_space - exact[0]) <= tol.SHARES_OF_MODES * m
        assert abs(cylinder - exact[1]) <= tol.SHARES_OF_MODES * m
        assert close(half_space + cylinder, m, rel=tol.SHARES)
        assert_generators((g, h, dg, dh), generator_slopes(z, whole), z)
        assert np.array_equal(at_contact(z, pair), at_contact(z, whole))


def test_swapped_bodies_swap():
    here, there = rolling(UNLIKE, PLACES), rolling(vr.Bodies(STIFF, SOFT, 0.7), PLACES)
    for z, (*one, half_space, cylinder), (*other, second, first) in zip(PLACES, here.T, there.T, strict=True):
        assert_generators(tuple(one), tuple(other), z)
        assert close((half_space, cylinder), (first, second), rel=tol.BODIES)


def test_a_rigid_body_takes_nothing():
    rubber, rigid = SOFT, vr.Prony.elastic()
    m = np.array([at_contact(z, record(rubber))[4] for z in PLACES])
    for bodies, yielding, other in ((vr.Bodies(rubber, rigid, 1.0), 5, 4), (vr.Bodies(rigid, rubber, 0.0), 4, 5)):
        found = rolling(bodies, PLACES)
        assert close(found[yielding], m, rel=tol.BODIES)
        assert np.array_equal(found[other], np.zeros(len(PLACES)))


def test_limits_of_the_shares():
    """Slow: sum J_j T_j of the body; fast: (alpha z^2/2) sum J_j b_j [ln(2/(b_j z)) - gamma + 1/4] over its modes."""
    phi = 1.0 - UNLIKE.share
    z = 1e-20
    slow, fast = rolling(UNLIKE, [1e100, z]).T
    assert close(slow[4:], [phi * STIFF.T_mean, UNLIKE.share * SOFT.T_mean], rel=tol.SHARES)
    for found, body, weight in ((fast[4], STIFF, phi), (fast[5], SOFT, UNLIKE.share)):
        sum_of = (body.J / body.T * (np.log(2.0 * body.T / z) - np.euler_gamma + 0.25)).sum()
        assert close(found, 0.5 * UNLIKE.alpha * z * z * weight * sum_of, rel=tol.SHARES)


def test_bodies_alike_keep_the_plain_record():
    """Each takes half of m, of a series, of one alpha by table and by ratios."""
    assert isinstance(record(UNLIKE), Pair)
    assert record(vr.Bodies(SOFT, SOFT)) is record(SOFT)
    assert record(vr.Bodies(vr.Prony.elastic(), vr.Prony.elastic(), 0.2)).alpha == 1.0
    for material in (record(SOFT), tabulated(11.0), standard(11.0)):
        for z in PLACES:
            *generated, half_space, cylinder = at_rolling(z, material)
            contact = at_contact(z, material)
            assert_generators(tuple(generated), contact[:4], z)
            assert half_space == cylinder
            assert close(2.0 * half_space, contact[4], rel=tol.SHARES)


def test_own_time_of_a_pair():
    """Powers of two, as that of the sum."""
    slow = vr.Bodies(SOFT.slower(2.0**30), STIFF.slower(2.0**30), 0.3)
    (here, unit), (there, again) = slow.in_own_time(), UNLIKE.in_own_time()
    assert (unit, again) == (2.0**30 * again, UNLIKE.total.in_own_time()[1])
    assert slow.in_own_time()[0] is here  # made once, not at every call
    assert close(rolling(here, PLACES)[4:], rolling(there, PLACES)[4:], rel=tol.BODIES)
