"""Full slip as quadratures: against closed forms and the printed equations; its end, and what it spares."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.validation.direct_motion import roll_direct

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

PAPER = vr.PAPER_SECTION_5_ROUNDED
#: rolling resistance widens the slip where it is at its largest, before friction closes it
WIDENING = PAPER.replace(mu=0.01)
SCENES = {
    "paper": (PAPER, 1.5, 0.5),
    "from V = 0": (PAPER, 0.0, 1.0),
    "reversal": (PAPER, 1.0, -3.5),
    "reversal with little friction": (PAPER.replace(mu=0.02), 1.0, -6.0),
    "rolling resistance holds V": (PAPER.replace(mu=0.005), 0.1, 1.0),
    "held from above": (PAPER.replace(mu=0.005), 0.3, 1.0),
    "too fast to be held": (PAPER.replace(mu=0.03), 3.0, 12.0),
    "strong relaxation": (PAPER.replace(alpha=1e3, kappa=30.0), 2.0, -5.0),
    "slip widens": (WIDENING, 2.0, 1.4),
}


def test_elastic_cylinder():
    """alpha = 1: V' = +-gamma mu, omega' = -+gamma mu/j until |omega - V| = mu/(2 kappa) |V|."""
    scene = PAPER.replace(alpha=1.0)
    for V0, omega0 in ((1.5, 0.5), (0.5, 1.5), (0.0, 1.0), (1.0, -3.0), (1.0, -1.5), (-2.0, 1.0)):
        push = scene.gamma * scene.mu * np.sign(omega0 - V0)
        end = abs(omega0 - V0) / (scene.gamma * scene.mu * (1.0 + 1.0 / scene.j))
        t = end * np.array([1e-9, 1e-4, 0.1, 0.5, 0.9])
        motion = vr.roll(scene, V0, omega0, [*t, 2.0 * end], rtol=1e-8)
        assert close(motion.V[:5], V0 + push * t, rel=tol.SLIDE, scale=1.0)
        assert close(motion.omega[:5], omega0 - push / scene.j * t, rel=tol.SLIDE, scale=1.0)
        assert close(motion.x[:5], V0 * t + 0.5 * push * t**2, rel=tol.SLIDE, scale=end)
        assert close(motion.angle[:5], omega0 * t - 0.5 * push / scene.j * t**2, rel=tol.SLIDE, scale=end)
        # V at the end of slip, of either sign
        V_end = V0 + push * motion.onset_time
        slip = abs(omega0 - V0) - abs(push) * (1.0 + 1.0 / scene.j) * motion.onset_time
        assert close(slip, 0.5 * scene.mu / scene.kappa * abs(V_end), rel=1e-8)


def test_the_first_instants():
    """Distance and angle to full relative accuracy, however early: from V = 0 and from omega = 0."""
    t = np.array([1e-12, 1e-9, 1e-7]) / PAPER.gamma
    rises = vr.roll(PAPER, 0.0, 1.0, [*t, 1e-4])
    assert close(rises.x[:3], 0.5 * PAPER.gamma * PAPER.mu * t**2, rel=1e-6)
    turns = vr.roll(PAPER, 1.0, 0.0, [*t, 1e-4])
    M = vr.contact(PAPER, 1.0, omega=0.0, fields="M").M
    assert close(turns.angle[:3], 0.5 * PAPER.gamma / PAPER.j * (PAPER.mu - 0.5 * M) * t**2, rel=1e-6)


@pytest.mark.parametrize("name", SCENES)
def test_against_the_printed_equations(name):
    """To the end of slip, which is where the creep ratio is at its limit; outputs do not move the motion."""
    scene, V0, omega0 = SCENES[name]
    exact_onset = vr.roll(scene, V0, omega0, [1.0], rtol=1e-12).onset_time
    t = exact_onset * np.array([1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999])
    exact = roll_direct(scene, V0, omega0, t)
    motion = vr.roll(scene, V0, omega0, t, rtol=1e-10)
    scale = np.maximum(abs(exact.V), abs(exact.omega))
    assert (abs(motion.V - exact.V) <= tol.DIRECT_MOTION * scale).all()
    assert (abs(motion.omega - exact.omega) <= tol.DIRECT_MOTION * scale).all()
    onset = vr.roll(scene, V0, omega0, [1.0], rtol=1e-8).onset_time
    before = vr.roll(scene, V0, omega0, [onset * (1.0 - 1e-12)], rtol=1e-8)
    star = vr.contact(scene, before.V[0], delta=0.0, fields="delta_star").delta_star
    assert close(abs(before.omega[0] / before.V[0] - 1.0), star, rel=1e-8, scale=1.0)
    for rtol in (1e-4, 1e-8):
        many = vr.roll(scene, V0, omega0, np.linspace(0.0, 1.5 * onset, 40), rtol=rtol)
        one = vr.roll(scene, V0, omega0, [1.5 * onset], rtol=rtol)
        assert (many.V[-1], many.x[-1], many.steps) == (one.V[0], one.x[0], one.steps), rtol


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_the_way_while_v_comes_to_stand(rtol):
    """Near M(V) = 2 mu the time depends on the last digits of V: what is integrated over it may not."""
    scene, V0, omega0 = PAPER.replace(mu=0.005), 0.3, 10.0
    t = vr.roll(scene, V0, omega0, [1.0], rtol=1e-9).onset_time * np.linspace(0.1, 0.99, 60)
    motion, exact = vr.roll(scene, V0, omega0, t, rtol=rtol), vr.roll(scene, V0, omega0, t, rtol=1e-9)
    assert close(motion.x, exact.x, rel=max(rtol, 1e-9))
    # the distance is the integral of V, which stands still from the middle on
    late = t > 0.5 * t[-1]
    assert close(np.diff(motion.x[late]), motion.V[late][1:] * np.diff(t[late]), rel=max(10 * rtol, 1e-7))


@pytest.mark.parametrize("spin", [1e1, 1e3, 1e6, 1e9])
def test_a_held_cylinder_takes_no_steps(spin):
    """M(V) = 2 mu: V stands still however long, then slip ends; the spin falls linearly."""
    scene = PAPER.replace(mu=0.005)
    motion = vr.roll(scene, 0.0, spin, [spin * scene.j / (4.0 * scene.gamma * scene.mu)], rtol=1e-8)
    assert motion.regime[0] == 0
    assert motion.steps <= 30
    M = vr.contact(scene, motion.V[0], omega=motion.omega[0], fields="M").M
    assert close(M, 2.0 * scene.mu, rel=1e-6 if spin < 1e2 else 1e-9)
    assert close(motion.omega[0], 0.5 * spin, rel=1e-1)


def test_a_usual_slide_is_one_or_two_panels():
    for start in vr.PAPER_STARTS.values():
        onset = vr.roll(PAPER, *start, [1e-2], rtol=1e-6).onset_time
        assert vr.roll(PAPER, *start, [0.999 * onset], rtol=1e-6).steps <= 2, start


def test_a_slip_that_nearly_ends_is_noticed():
    """Friction closes the slip, resistance widens it again: onset jumps where slip just touches its limit."""

    def early(omega0: float, rtol: float) -> bool:
        return vr.roll(WIDENING, 2.0, omega0, [1e-2], rtol=rtol).onset_time < 5e-3

    low, high = 2.0 - 0.55, 2.0 - 0.525
    for _ in range(16):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if early(middle, 1e-9) else (middle, high)
    for rtol in (1e-3, 1e-4, 1e-5):
        near = high + 2.0 * rtol
        assert early(near, rtol)
        assert not early(low - 2.0 * rtol, rtol)


def test_rest_while_sliding():
    """A threshold that both speeds pass during full slip is located there."""
    scene, start = PAPER.replace(mu=0.05), (1.0, -2.02)
    passed = vr.roll(scene, *start, [8e-4], rtol=1e-10)
    assert passed.regime[0] == 0
    threshold = max(abs(passed.V[0]), abs(passed.omega[0]))
    rested = vr.roll(scene, *start, [1.0], rtol=1e-10, rest=threshold)
    assert close(rested.rest_time, 8e-4, rel=1e-8)


def test_largest_rolling_resistance():
    """kappa M grows with alpha at every speed, to 0.30905 at most: with more friction nothing holds V."""
    V = np.geomspace(1e-4, 1e6, 4001)
    alphas = np.geomspace(1.0001, 1e12, 60)
    M = np.array([vr.contact(vr.Scene(alpha, 1.0, 1.0), V, delta=0.0, fields="M").M for alpha in alphas])
    assert np.diff(M, axis=0).min() > -tol.CONTACT * M.max()
    assert 0.3090 < M.max() < 0.3091


@pytest.mark.parametrize("rtol", [1e-3, 3e-4, 1e-4])
def test_slip_that_returns_for_a_moment(rtol):
    """Slip that closes again within a twentieth of a panel went stick, slip, stick, at one instant and for ever."""
    scene = vr.Scene(183.26278143994915, 0.9568722484878621, 0.02453309847747956, 1.0, 0.2541193764896803)
    for V0, omega0 in ((-0.13833785132889842, -0.5685100589509053), (-0.25199780617340695, -1.4371188714508967)):
        best = vr.roll(scene, V0, omega0, [6.30500104], rtol=1e-10)
        motion = vr.roll(scene, V0, omega0, [6.30500104], rtol=rtol, max_steps=1000)
        assert close(motion.V[0], best.V[0], rel=tol.MOTION_RTOL * rtol)
