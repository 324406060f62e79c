"""Motions under force, torque, slope, brake and prescribed speeds; motions of bodies that
differ.
"""

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import PAPER, ROLLER

import viscoroll as vr
from pipeline.evidence.prove.motion import balance

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model


@pytest.mark.parametrize("share", [0.7, 1.3])
def test_brake_locks_backspin_if_it_is_stronger_than_friction(share):
    """A cylinder thrown with backspin slides, Q = -mu; where omega has come to 0, mu - M/2 would
    turn it on.
    """
    t = np.linspace(0.0, 2.0, 41)
    m = ROLLER.roll(2.0, -0.1, t, brake=share * ROLLER.mu)
    omega = m.omega[t >= 0.25]  # it comes to 0 at 0.20, and at 0.15
    assert (omega > 0.0).all() if share < 1.0 else not omega.any()
    assert [s.regime for s in m.switches] == ([] if share < 1.0 else ["locked"])
    assert balance(m) <= 1e-7


def test_the_end_of_a_motion_of_bodies_that_differ():
    """V decays by a closed form, as of like bodies: steps went on to the smallest number, 430 of
    them.
    """
    modes = vr.Prony([3.0] * 10, 10.0 ** np.arange(-9, 1))
    on_steel = vr.Bodies(modes, vr.Prony.elastic(), 1.0)
    scene = vr.Scene(material=on_steel, kappa=2.91, mu=0.2, gamma=100.0)
    m = scene.roll(1.0, 0.0, [0.3, 0.5, 1.0, 2.0, 10.0])
    like = scene.replace(material=modes).roll(1.0, 0.0, m.t)
    assert m.steps <= 1.5 * like.steps
    fell = np.diff(np.log(m.V[1:4]))  # in 0.5 and 1
    assert close(fell[1], 2.0 * fell[0], 1e-9)
    assert m.V[-1] == 0.0


@pytest.mark.parametrize("V", [0.05, 0.5, 2.0])
def test_traction_of_the_smallest_creep(V):
    """The force that a prescribed V asks for is M/2 - Q, and Q what the contact says of creep that
    is nearly none.
    """
    edge = PAPER.contact(V, delta=0.0).delta_star
    for share in (-9e-5, 3e-5, 9e-5):
        omega = V * (1.0 + share * edge)
        state = PAPER.contact(V, omega=omega)
        held = PAPER.roll(None, omega, [0.0, 1e-9], V=V)
        assert close(0.5 * state.M - held.force[0], state.Q, tol.SMALL_TRACTION)
