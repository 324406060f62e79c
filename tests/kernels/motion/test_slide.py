"""Full slip as quadratures: closed forms, its end, and what it spares."""

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

PAPER = vr.presets.PAPER_SECTION_5_ROUNDED


def test_elastic_cylinder():
    """alpha = 1: V' = +-gamma mu, omega' = -+gamma mu/j until |omega - V| = mu/(2 kappa) |V|."""
    scene = PAPER.replace(alpha=1.0)
    for V0, omega0 in ((0.5, 1.5), (0.0, 1.0), (1.0, -3.0), (-2.0, 1.0)):
        push = scene.gamma * scene.mu * np.sign(omega0 - V0)
        end = abs(omega0 - V0) / (scene.gamma * scene.mu * (1.0 + 1.0 / scene.j))
        t = end * np.array([1e-9, 1e-4, 0.1, 0.5, 0.9])
        m = vr.roll(scene, V0, omega0, t, rtol=1e-8)
        start = np.array([[V0], [omega0]])
        rate = push * np.array([[1.0], [-1.0 / scene.j]])
        assert close((m.V, m.omega), start + rate * t, tol.SLIDE, scale=1.0)
        assert close((m.x, m.angle), start * t + 0.5 * rate * t**2, tol.SLIDE, scale=end)
        # in the end it rolls at the speed that conserves V + j omega, for ever
        final = (V0 + scene.j * omega0) / (1.0 + scene.j)
        rolls = vr.roll(scene, V0, omega0, [1.0, 1e3], rtol=1e-8)
        found = [*rolls.V, *rolls.omega, np.diff(rolls.x)[0] / 999.0]
        assert close(found, final, 1e-7, scale=1.0)


def test_the_first_instants():
    """Distance and angle to full relative accuracy, however early: from V = 0 and from omega =
    0.
    """
    t = np.array([1e-12, 1e-9, 1e-7]) / PAPER.gamma
    rises = vr.roll(PAPER, 0.0, 1.0, [*t, 1e-4])
    assert close(rises.x[:3], 0.5 * PAPER.gamma * PAPER.mu * t**2, 1e-6)
    turns = vr.roll(PAPER, 1.0, 0.0, [*t, 1e-4])
    M = PAPER.contact(1.0, omega=0.0).M
    assert close(turns.angle[:3], 0.5 * PAPER.gamma / PAPER.j * (PAPER.mu - 0.5 * M) * t**2, 1e-6)


@pytest.mark.parametrize("spin", [1e1, 1e9])
def test_a_held_cylinder_takes_no_steps(spin):
    """M(V) = 2 mu: V stands still however long, then slip ends; the spin falls linearly."""
    scene = PAPER.replace(mu=0.005)
    motion = vr.roll(scene, 0.0, spin, [spin * scene.j / (4.0 * scene.gamma * scene.mu)], rtol=1e-8)
    assert motion.regime[0] == 0
    assert motion.steps <= 30
    M = vr.contact(scene, motion.V[0], omega=motion.omega[0], fields="M").M
    assert close(M, 2.0 * scene.mu, 1e-6 if spin < 1e2 else 1e-9)
    assert close(motion.omega[0], 0.5 * spin, 1e-1)
