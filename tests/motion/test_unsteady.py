"""Motions with the added mass, ``unsteady=True``, and from a contact that rested, ``rested=``."""

from functools import partial

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import DMA, RUBBER, solved
from drives import ON_DMA as ROLLER
from refusals import refused

import viscoroll as vr
from pipeline.evidence.prove.motion import balance

#: nowhere more unsteady than 0.22: it may pass V = 0
GENTLE = vr.Scene(3.0, 5.0, 0.5, 1.5, 0.8)
T = np.linspace(0.0, 8.0, 17)
told_too_slow = partial(pytest.warns, RuntimeWarning, match="became too slow for unsteady=True")


@pytest.mark.parametrize(
    "scene, start, t, drive",
    [
        (ROLLER, (30.0, 29.9), T, {}),
        (RUBBER, (1.0, 0.999), T, {"force": 0.004, "torque": 0.01}),
        (GENTLE, (0.3, 0.3), 0.1 * T, {"force": -0.05}),
    ],
)
def test_beside_a_second_method(scene, start, t, drive):
    exact = solved(scene, *start, t, unsteady=True, **drive)
    for rtol in (1e-6, 1e-9):
        m = scene.roll(*start, t, rtol=rtol, unsteady=True, **drive)
        assert close((m.V, m.omega), exact, tol.MOTION_RTOL * rtol, scale=max(start))
    steady = scene.roll(*start, t, **drive)
    assert abs(steady.V / m.V - 1.0).max() > 3e-4  # N is what this is about


def test_works_and_losses_add_up():
    """What N takes and gives back of the energy counts as lost in rolling."""
    m = GENTLE.roll(0.2, 0.1, T, force=-0.05, torque=0.01, unsteady=True)
    assert m.V[-1] < 0.0 < m.V[0]
    assert balance(m) <= tol.ENERGY


def test_from_rest_and_to_it():
    """At V = 0 the mass is 1 + j + gamma N(0), but for creep: from there on, and at the end of a
    decay.
    """
    mass = 1.0 + GENTLE.j + GENTLE.gamma * GENTLE.contact(0.0, delta=0.0, fields="N").N
    early = GENTLE.roll(0.0, 0.0, [1e-6], force=0.02, unsteady=True)
    assert close(early.V[0], 1e-6 * GENTLE.gamma * 0.02 / mass, 1e-3)
    late = GENTLE.roll(1e-9, 1e-9, [10.0, 20.0], unsteady=True)
    rate = GENTLE.gamma * (2.0 / 3.0) / mass
    assert close(np.log(late.V[0] / late.V[1]), 10.0 * rate, 1e-6)
    held = GENTLE.roll(None, 0.1, T[:5], V=vr.Schedule([0.0, 4.0], [0.1, 0.3]), unsteady=True)
    at = GENTLE.contact(held.V, omega=held.omega, fields=("Q", "M", "N"))
    force = 0.05 / GENTLE.gamma - at.Q + 0.5 * (at.M + 0.05 * at.N)
    assert close(held.force, force, 1e-6, scale=0.01)


@pytest.mark.parametrize(
    "scene, V0, level",
    [(RUBBER, 1.0, -0.5), (RUBBER.replace(j=4.0), 1.0, -0.2), (ROLLER, 30.0, 1.0)],
)
def test_it_ends_where_the_added_mass_is_too_much(scene, V0, level):
    with told_too_slow():
        m = scene.roll(V0, V0, 100.0, unsteady=True).course
    assert m.status == vr.MotionStatus.UNSTEADY
    assert (m.regime >= 0).tolist() == [True] * (m.t.size - 1) + [False]
    N = scene.contact(m.V[-2], delta=0.0, fields="N").N
    assert close(scene.gamma * N / (1.0 + scene.j), level, 1e-6)
    with told_too_slow():
        slower = scene.roll(0.9 * m.V[-2], 0.9 * m.V[-2], T, unsteady=True)
    assert (slower.status, *slower.regime[:2]) == (vr.MotionStatus.UNSTEADY, 1, -1)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # kappa below 1
@pytest.mark.parametrize(
    "scene, start, until, force, torque, last",
    [
        ((2.6, 15.2, 0.34, 30.6, 2.0), (-0.01996, -0.01995), 0.13, 0.114, -0.723, 1),
        ((8.1, 1.84, 0.053, 5.9, 0.23), (-0.1476, -0.1464), 0.0484, 0.496, 0.115, 1),
        ((11.0, 21.4, 0.0181, 7.69, 0.354), (1.74e-3, 1.59e-3), 1.9, -8.9e-4, 0.0212, 1),
        ((10.2, 8.2, 0.07, 27.0, 1.6), (0.0, 0.0), 8.0, 0.0, 0.023, 2),
        ((11.9, 0.51, 0.0106, 10.0, 1.2), (0.0, 0.0), 8.0, 0.0194, 1.85e-4, 2),
    ],
)
def test_it_ends_where_no_regime_can_follow(scene, start, until, force, torque, last):
    """With N the creepage rises above delta_star, without it falls below: once it went on in
    partial slip, up to 190 delta_star.  From rest there is no departure: once every step was used.
    """
    scene = vr.Scene(*scene)
    with told_too_slow():
        m = scene.roll(*start, until, force=force, torque=torque, unsteady=True).course
    assert m.status == vr.MotionStatus.UNSTEADY
    assert m.steps < 200
    assert m.regime[-2:].tolist() == [last, -1]
    limit = scene.contact(m.V[:-1], delta=0.0, fields="delta_star").delta_star
    stuck = m.regime[:-1] == 1
    assert (abs(m.delta[:-1]) <= 1.0001 * limit)[stuck].all()


def test_the_last_state_is_told_where_the_last_step_cannot_be_repeated():
    """Cut at its end, the last step of this start from a standstill is given up earlier."""
    material = vr.Material(3e6, 0.49, DMA, 3.0)
    roller = vr.Cylinder(R=0.05, m=9.0, material=material, mu=0.6)
    with told_too_slow():
        m = roller.roll(0.05, 1.0, np.linspace(0.0, 20.0, 201), unsteady=True, rested=True)
    last = np.flatnonzero(m.regime >= 0)[-1]
    assert (
        f"the last state was t = {m.t[last]:.6g} s (regime partial slip), V = {m.V[last]:.6g} m"
        in m.message
    )


def test_it_ends_there_at_any_tolerance():
    """The end of the range of N is told from that of the stick zone, however closely either is
    met.
    """
    scene = vr.Scene(7.0, 8.819364017569045, 0.035796649013264355, gamma=4660.73125, j=0.6964318)
    V0 = -1.625636130638283
    for rtol in (1e-6, 1e-11):
        e = scene.ensemble(V0, V0, np.linspace(0.0, 0.08, 81), rtol=rtol, unsteady=True)
        assert e.status[0] == vr.MotionStatus.UNSTEADY
        assert np.isfinite(e.V).sum() == 38


def test_a_rest_costs_speed():
    """V0 and omega0 less what leaving the imprint takes; a rest of no time nothing, a longer one
    more.
    """
    left = 30.0 - ROLLER.validity(30.0).steady.start.speed
    none, brief, *longer, long = (
        ROLLER.roll(30.0, 29.99, T, rested=rested, unsteady=True)
        for rested in (0.0, 1e-9, 0.1, 1.0, 1e3, True)
    )
    assert none.V[0] == brief.V[0] == 30.0
    assert (np.diff([brief.V[0], *(m.V[0] for m in longer)]) < 0.0).all()
    assert close(longer[-1].V[0], left, 1e-6)
    assert close(long.V[0], left, 1e-14)
    assert close(long.delta[0], none.delta[0], 1e-6)


@pytest.mark.parametrize("t_w", [0.5, 3.0])
def test_a_short_rest_costs_less(t_w):
    """W of docs/validity.md after a time t_w, of one mode, whose way is short of nothing."""
    scene = vr.Scene(11.0, 10.0, 0.2, 1.0)
    V0 = 0.5
    J = 10.0 / 11.0
    L = 2.0 * 10.0 * V0
    fresh = np.exp(-t_w)
    climbed = 0.25 * J * np.log(1.0 + (0.681 * L) ** 2) - np.log(11.0) / 88.0
    W = (1.0 - fresh) * climbed - 0.5 * J * fresh * L / (L + 2.0)
    found = scene.roll(V0, V0, 1e-12, unsteady=True, rested=t_w).V[0]
    assert close(found, np.sqrt(V0**2 - max(W, 0.0) / 300.0), 1e-9)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the look-up of a motion so slow
def test_caught_in_the_imprint():
    """V = 1.3 is 4.3 cm/s, of which validity says it too."""
    with pytest.warns(RuntimeWarning, match="too slow at the start to leave the indentation"):
        m = ROLLER.roll(1.3, 1.3, T[:3], rested=True, unsteady=True)
    V0 = np.array([1.3, 30.0, -1.3])
    e = ROLLER.ensemble(V0, V0, T[:3], rested=True, unsteady=True)
    by_flow = ROLLER.ensemble(V0, V0, T[:3], rested=True, method="flow")
    caught = [vr.MotionStatus.CAUGHT, vr.MotionStatus.DONE, vr.MotionStatus.CAUGHT]
    assert e.status.tolist() == by_flow.status.tolist() == caught
    assert (by_flow.flow.tolist(), by_flow.switches[0]) == ([False, True, False], 0)
    assert np.isnan(e.onset_time[::2]).all()
    assert m.status == vr.MotionStatus.CAUGHT
    assert np.isnan([m.V, *e.V[::2]]).all()


@pytest.mark.parametrize("V0", [0.0, -0.0])
def test_a_standstill_is_refused_where_it_would_have_no_effect(V0):
    """From V0 = omega0 = 0 the drive must first break the cylinder away, which is not known; other
    starts act.
    """
    words = "starts at V0 = omega0 = 0"
    refused(lambda: ROLLER.roll(V0, 0.0, T, force=0.01, rested=3600.0), words)
    refused(lambda: ROLLER.ensemble([1.3, V0], [1.3, 0.0], T, force=0.01, rested=True), words)
