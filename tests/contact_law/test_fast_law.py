"""The law of a cover without the coupled solve: energy of any state, both names of a nip, rest, and
stated errors.
"""

import re

import numpy as np
import pytest
import tolerances as tol
from calls import COVERED
from closeness import close
from drives import solved
from long_cases import long

import viscoroll as vr
from pipeline.evidence.measure import covers

_, ONE, THREE = covers.MATERIALS.values()


def losses_of(s):
    return np.stack([s.loss.slip, s.loss.half_space, s.loss.cylinder])


@pytest.mark.parametrize("index", [0, 7, *long(15, 20)])
def test_no_state_makes_energy(index):
    _, scene, _ = covers.scenes()[index]
    V = np.logspace(-4.0, 1.0, 6)[:, None]
    s = scene.steady(V=V, torque=scene.mu * np.linspace(-0.99, 0.99, 23))
    parts = losses_of(s)
    assert np.nanmin(parts) >= -tol.COVER_ENERGY
    power = s.force * s.V + s.torque * s.omega
    assert close(parts.sum(axis=0), power, tol.COVER_ENERGY, scale=1.0)
    assert np.nanmax(s.loss.efficiency) <= 1.0


@pytest.mark.parametrize("index", [0, *long(5, 15, 20)])
def test_onsets_lie_unlike_far_from_free_rolling(index):
    """As in the coupled solution, and full slip begins there, of motions of either direction."""
    _, scene, u = covers.scenes()[index]
    V = u / covers.KAPPA
    found = scene.contact(V, delta=0.0, fields=("delta_minus", "delta_plus", "delta_star"))
    true = covers.CoupledRow(covers.pair_of_scene(scene), u, float(scene.mu)).onsets()
    onsets = np.array([found.delta_minus, found.delta_plus])
    exact = 0.5 * np.array(true) / covers.KAPPA
    assert close(onsets, exact, tol.COVER_ONSETS, scale=found.delta_star)
    ends = np.array([-1.0, 1.0])
    beside = onsets + found.delta_star * 1e-6 * np.outer([1.0, -1.0], ends)
    for sign in ends:
        slips = scene.contact(sign * V, delta=beside)
        assert slips.full_slip.tolist() == [[True, True], [False, False]]
        assert close(slips.Q, [sign * scene.mu * ends] * 2, tol.COVER_ENDS)


@pytest.mark.long
def test_the_same_nip_has_the_same_losses():
    """Named from the other side V and omega change places; speeds of both names differ by creepage,
    here 1e-6.
    """
    layer = {"nu": 0.45, "thickness": 0.5, "other": ONE, "other_nu": 0.3, "part": 0.6}
    nips = (vr.Cover(THREE, on=on, **layer) for on in ("base", "cylinder"))
    one, two = (vr.Scene(material=nip, kappa=1e6, mu=0.3, coupled=False) for nip in nips)
    V = np.array([[1e-8], [1e-7], [1e-6]])
    s = one.steady(V=V, torque=0.3 * np.linspace(-0.9, 0.9, 7))
    turned = two.steady(V=s.omega[..., 0], torque=s.force[..., 0])
    mine = losses_of(s)
    other = losses_of(turned)[[0, 2, 1]]
    assert close(mine / V[..., None], other / V[..., None], tol.COVER_NAMES, scale=1e-6)


def test_the_line_of_rest():
    """f + (1 + delta_0 + ...) q = 0, by the moment that Q has at rest; beside it the roller departs
    along the force.
    """
    scene = COVERED.replace(kappa=4.0, mu=0.3, gamma=0.5)
    limit = scene.contact(0.0, delta=0.0)
    state = scene.contact(
        0.0, delta=limit.delta_0 + limit.delta_star * np.array([-0.6, -0.01, 0.01, 0.5])
    )
    lever = state.M_half_space / -state.Q
    assert close(lever[1:3], limit.delta_0, tol.COVER_REST_LEVER, scale=1.0)
    force = state.M_half_space - state.Q
    assert close(force + (1.0 + lever) * state.Q, 0.0, tol.COVER_ENERGY, scale=1.0)
    for push in (-0.01, 0.0, 0.01):
        moved = scene.ensemble(0.0, 0.0, 5.0, force=force + push, torque=state.Q)
        assert (np.sign([moved.V, moved.omega]) == np.sign(push)).all()


@pytest.mark.parametrize("index", [7, *long(4, 10, 13)])
def test_the_stated_errors_bound_those_beside_the_coupled_solution(index):
    """Where they are largest; where both ends slip, the other method is named."""
    _, scene, u = covers.scenes()[index]
    found = covers.compared(scene, u, 7)
    told = scene.validity(u / covers.KAPPA).traction
    Q, M = re.search(r"Q is up to (\S+) % .* M up to (\S+) P l0", told.sentence).groups()
    assert found.Q <= 0.01 * float(Q)
    assert found.kM <= float(M)
    assert told.holds == (found.value <= 1.0)
    assert ("slips at both ends" in told.sentence) == (index == 13)


def test_motions_solve_the_equations_by_the_law():
    """Both onsets lie unlike far, and change with the speed."""
    scene = COVERED.replace(kappa=4.0, mu=0.3)
    exact = solved(scene, 1.0, 1.0, [4.0], torque=-0.1)
    motion = scene.roll(1.0, 1.0, [4.0], torque=-0.1, rtol=1e-10)
    assert close((motion.V, motion.omega), exact, tol.COVER_MOTION)
